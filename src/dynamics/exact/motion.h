/* SPDX-License-Identifier: BSD-3-Clause */
/* Motion of a structure with contacts held, from a state on, in closed form: a phase of method "exact". */
#ifndef TRIBO_MODAL_MOTION_H
#define TRIBO_MODAL_MOTION_H

#include "modal.h"
#include "dynamics/events/events.h"

/* An output in a phase. */
struct course {
    const struct output *output;
    double start, ramp, square, cube; /* the polynomial part is start + ramp tau + square tau^2 + cube tau^3 */
    double size, bend;                /* bounds of |output| and of the sixth derivative */
    double tau;                       /* time of the last look */
    double *power;                    /* [TRIBO_POWERS] coefficients of the powers of time, of the output; without modes */
    struct sample at;                 /* output at tau, with two derivatives */
};

/* TRIBO_TERMS terms side by side, with two derivatives. */
struct lot {
    double re[3][TRIBO_TERMS], im[3][TRIBO_TERMS];
};

/* [terms] real and imaginary parts, room of struct exact apart. */
struct parts {
    double *re, *im;
};

/* Number of powers of time of a motion without modes, and |lambda| tau up to which they give it to rounding: 1/20! = 4e-19. */
enum { TRIBO_POWERS = 20 };
#define TRIBO_POWERS_REACH 1.0

/* Number of lists of structures. */
enum { TRIBO_HELD_LISTS = 64 };

/* The structures so far. */
struct held {
    struct modal *last[TRIBO_HELD_LISTS]; /* by their keys, in order of last use */
    const struct modal *like;             /* the last one without modes, and without rigid contacts that hold; NULL: none */
    size_t bytes;                         /* of all structures */
    size_t revision, structure;           /* of the system: when the forced structures were created; when the others were */
    size_t run;                           /* number of runs so far */
    signed char *room;                    /* [ncontact] for keys, and zeros */
    const struct modal *powers;           /* coordinates of the last phase of the run; NULL: modes, or no phase */
    size_t phases;                        /* number of phases in a row that powers had before the last one */
};

/* Tables in a phase, linear in time. Without tables nothing is set. */
struct slopes {
    double *rate;         /* [terms] of forcings by a table: rate of the table, of a limit times side; others are not set */
    double *lead, *bend;  /* [modes] constant eta' and eta'' by the ramps, of modes with a stiffness */
    double *rest;         /* [modes] by ramps that no stiffness takes: eta'' of a mode with damping, else the rate of eta'' */
    double *limit, *rise; /* [ncontact] part of the limit by functions of time at t0, and its rate; set if there is one */
};

/* The driver's own data, and a phase from t0. A mode: eta = constant + vel tau + acc tau^2/2 + jerk tau^3/6 + harmonics + (Re(r
 * z), or eta' tau if the mode drifts). A shape by bases: eta = harmonics, or tau, or value tau + rate tau^2/2 of a table; by
 * another table: rate tau. Terms: exponents, then harmonics; harmonics of limits times
 * side. */
struct exact {
    tribo_system *sys;
    struct events events;
    struct held held;
    const struct forced *h;
    double t0, tau, longest;      /* tau: time after t0 of w; longest: the bounds hold until t0 + longest */
    int runs;                     /* 1: some shape has drift or acc not 0 */
    size_t room;                  /* number of terms, and of shapes, that the arrays have room for */
    struct lot *lot;              /* [terms/TRIBO_TERMS] w, the terms at tau; owns the memory of all arrays */
    struct parts z;               /* terms at t0 */
    double far;                   /* time after t0 of the last look with e^{lambda tau} computed in full */
    struct parts far_e;           /* e^{lambda far} */
    struct parts move, rate_move; /* w - z; w', or w' - z' if brief: tau is short for all terms */
    double *growth, *growth6;     /* [terms] bounds of |w| and of the sixth derivative; without modes [TRIBO_POWERS] powers of
                                     longest and their sixth derivatives */
    double *vel, *acc, *jerk;     /* [shapes] */
    struct slopes slopes;
    double *drift;           /* [shapes] vel, and of modes that drift also eta' at t0 */
    double *place, *rate;    /* [shapes] eta - eta(t0) at tau; eta' at tau, or eta' - eta'(t0) if brief */
    double *work;            /* [room + 2 ndof] workspace */
    double *way;             /* [ncontact] workspace */
    double *steady;          /* [ncontact] force of a sliding contact without harmonics of the limit */
    struct course *course;   /* [2 ncontact] courses of the outputs of h */
    struct signal factor[2]; /* workspace: velocity and limit */
    double *power;           /* coefficients [TRIBO_POWERS][modes] of eta, eta'; [][TRIBO_POWERS] of outputs, eta, eta' */
};

/* Starts a phase at (t, y) with structure x->h, for a time of at most *longest; sets *longest to the time for which the bounds
 * hold. Returns 1, or 0 if out of memory. */
int tribo_modal_motion_start(struct exact *x, double t, const double *y, double *longest);

/* Goes to t0 + tau: sets w, w' and w'' of all terms. */
void tribo_modal_motion_go(struct exact *x, double tau);

/* limit: returns the part of limit i by functions of time, or the whole limit that follows the motion, with two derivatives, at
 * x->tau; limits vary. limit_course: its course, or that of its N, times *mu; NULL: it does not vary. */
struct sample tribo_modal_motion_limit(struct exact *x, size_t i);
struct course *tribo_modal_limit_course(const struct exact *x, size_t i, double *mu);

/* Returns the energy dissipated by all contacts until t0 + tau, x and x->place being there. */
double tribo_modal_motion_dissipated(struct exact *x, double tau);

/* Sets growth and growth6 for times from tau to longest. */
void tribo_modal_motion_bound(struct exact *x, double tau);

/* Of columns of eta and eta' [modes][columns]. settle: force [modes][columns], constant, has the response constant + vel tau +
 * acc tau^2/2; subtracts it at tau = 0 from eta and eta'. split: z = a eta + b eta' [exponents][columns]. join: eta += that of
 * z. */
void tribo_modal_settle(const struct modal *h, size_t columns, const double *force, double *eta, double *rate, double *vel,
                        double *acc);
void tribo_modal_split(const struct modal *h, size_t columns, const double *eta, const double *rate, double *zr, double *zi);
void tribo_modal_join(const struct modal *h, size_t columns, const double *zr, const double *zi, double *eta);

/* follow.c. key: key [ncontact] = the keys, KEY_, of the contacts; returns key. forces: force [modes] = F with eta'' + C~ eta' +
 * K~ eta = F + ramp tau + harmonics, from eta and eta' at t0 in place and rate. settle: as tribo_modal_settle; vel is 0. drift:
 * subtracts from drift [modes][columns] of modes that drift eta' by z. pull [modes][columns] = constant forces on eta by
 * perturbations v, of which eta are those of eta, and f [ncontact][columns] those of springs; work [ndof + 2
 * ncontact][columns]. */
const signed char *tribo_follow_key(const struct stick_slip *m, signed char *key);
void tribo_follow_forces(struct exact *x, const double *y, double *force);
void tribo_follow_settle(const struct modal *h, size_t columns, const double *force, double *eta, double *vel, double *acc);
void tribo_follow_drift(const struct modal *h, size_t columns, const double *zr, const double *zi, double *drift);
void tribo_follow_pull(const struct modal *h, const tribo_system *sys, size_t columns, const double *v, double *f,
                       const double *eta, double *pull, double *work);

/* powers.c, without modes. start: from place = eta and rate = eta' at t0, and the constant forces [modes]. move: sets place to
 * the change of eta until tau, and rate to eta' at tau, or with changes = 1 to the change of eta'. carry: tribo_modal_transition
 * of eta and rate [modes][columns], by pull, and a source with coefficients [TRIBO_POWERS][modes][columns] of the powers of time,
 * or NULL; eta becomes its change; work [3 modes + 1][columns]. */
void tribo_powers_start(struct exact *x, const double *force);
void tribo_powers_move(struct exact *x, double tau, int changes);
void tribo_powers_carry(const struct modal *h, double tau, size_t columns, const double *pull, double *eta, double *rate,
                        double *work, const double *source);

/* Functions of struct motion. The state of a signal is [q, q', f], f: forces of compliant contacts. The data of a phase is
 * its structure, with one user more. */
void tribo_modal_motion_state(void *own, double tau, const double *from, double *to);
double tribo_modal_motion_work(void *own, size_t i, double tau);
int tribo_modal_motion_signal(void *own, const double *c, double tau, const double *end, struct signal *to);
void *tribo_modal_phase_keep(void *own, double tau);
void tribo_modal_phase_release(void *phase);
int tribo_modal_transition(void *own, const void *phase, double tau, size_t columns, double *v, const struct source *source);

/* source.c: eta, rate [modes][columns] += the response at tau to the source of the phase that ends, without its force. Returns a
 * status, its message on the system's context. */
int tribo_modal_source(const struct exact *x, double tau, size_t columns, const struct source *source, double *eta, double *rate);

/* terms.c. rest: sets w to z [n], with derivatives, and e to 1; imaginary parts stand n numbers after real parts of lambda,
 * `next` after those of e and z. go: sets w for t0 + tau, without resonances. tribo_exp_1 returns (e^z - 1)/z, the integral of
 * e^{z s} over s from 0 to 1, without loss of digits for small z. */
void tribo_modal_terms_rest(size_t n, size_t next, const double *lambda, double *e, const double *z, struct lot *lot);
void tribo_modal_terms_go(struct exact *x, double tau);
double complex tribo_exp_1(double complex z);

/* terms.c. begin: starts the course of output o, value at t0; x is at t0. look: sets c->at for x->tau. bound: sets c->size and
 * c->bend from growth and growth6. */
void tribo_course_begin(struct exact *x, size_t o, double value);
void tribo_course_look(const struct exact *x, struct course *c);
void tribo_course_bound(const struct exact *x, struct course *c);

/* Return term p at t0, or an array like it; the lot of term p; w of term p, or its derivative, at tau. */
static inline double complex tribo_part(const struct parts *z, size_t p)
{
    return z->re[p] + z->im[p] * I;
}

static inline struct lot *tribo_lot(const struct exact *x, size_t p)
{
    return &x->lot[p / TRIBO_TERMS];
}

static inline double complex tribo_now(const struct exact *x, size_t p, size_t order)
{
    const struct lot *lot = tribo_lot(x, p);
    return lot->re[order][p % TRIBO_TERMS] + lot->im[order][p % TRIBO_TERMS] * I;
}

#endif
