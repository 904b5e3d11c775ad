/* The motion of a structure with contacts held, from a state on, in closed form: a phase of method "exact". */
#ifndef TRIBO_MODAL_MOTION_H
#define TRIBO_MODAL_MOTION_H

#include "modal.h"
#include "dynamics/events/quintic.h"
#include "dynamics/decide/stick_slip.h"
#include "dynamics/events/signal.h"

/* What of an output is linear in time. */
struct line {
    double start, ramp;
};

/* An output in a phase. */
struct course {
    const struct output *output;
    struct line line;
    double size, bend; /* bounds of it, and of its sixth derivative */
    double tau;        /* when it was looked at last, */
    struct sample at;  /* and what it was, with two derivatives */
};

/* It began at t0; amplitudes eta = constant + vel t + acc t^2/2 (of modes that drift, from their state) + harmonics + Re(r z). */
struct modal_motion {
    tribo_system *sys;
    const struct stick_slip *contacts; /* the caller's */
    const struct modal *h;
    double t0, tau;             /* tau: where w is */
    double *vel, *acc;          /* [modes] */
    int runs;                   /* any mode drifts, or has a vel or acc */
    double *drift, *drift_rate; /* [modes] of those that drift: what harmonics do not explain, at t0 */
    size_t room;                /* of terms */
    struct lot *lot;            /* the terms, of which harmonics are the last ones; of contacts times */
    int looked;                 /* since t0; */
    double far;                 /* the time of the last look that was far from another one, */
    double *far_r, *far_i;      /* [terms] and e^{lambda far} */
    double *er, *ei;            /* [terms] workspace: by how much they have moved */
    double *growth, *growth6;   /* [terms] bounds of |z| and of its sixth derivative */
    double *side;               /* [harmonics] how many times their force follows the limit; others 1 */
    double *push;               /* [outputs] by which an output pushes modes */
    double *dq, *du;            /* [ndof] by how much q has changed at tau; q' there, or by how much that has changed */
    double *df, *way;           /* [ncontact] by how much forces of compliant contacts have; workspace */
    double *work;               /* [10 ndof] workspace */
    const double *steady;       /* [ncontact] force of a sliding contact, without harmonics of its limit; */
    struct line *line;          /* [ncontact] while limits have any: its velocity, as far as it is linear in time */
    double *room_for_steady;    /* [ncontact] where steady stands if limits have any */
    double longest;             /* so long do bounds hold */
};

/* 1, or 0 if out of memory. tribo_modal_motion_free takes what failed too. */
int tribo_modal_motion_create(struct modal_motion *x, tribo_system *sys, const struct stick_slip *contacts);
void tribo_modal_motion_free(struct modal_motion *x);

/* Makes room for this many terms; 1, or 0 if out of memory. */
int tribo_modal_motion_reserve(struct modal_motion *x, size_t terms);

/* Starts at (t, y) with h held, for a time of longest. Returns for how long its bounds can hold. */
double tribo_modal_motion_start(struct modal_motion *x, const struct modal *h, double t, const double *y, double longest);

/* Goes to t0 + tau: z and its derivatives, and the harmonics. */
void tribo_modal_motion_go(struct modal_motion *x, double tau);

/* What harmonics add to the limit of contact i there, with two derivatives; and a bound of the sixth derivative of that. */
struct sample tribo_modal_motion_limit(const struct modal_motion *x, size_t i);
double tribo_modal_motion_limit_bend(const struct modal_motion *x, size_t i);

/* Energy dissipated by contact i, which slides, until t0 + tau, where dq is, if its force is counted once; and by all. */
double tribo_modal_motion_work(struct modal_motion *x, size_t i, double tau);
double tribo_modal_motion_dissipated(struct modal_motion *x, double tau);

/* Goes to t0 + tau: the state there. from is the state at t0; to may be the same. */
void tribo_modal_motion_state(struct modal_motion *x, double tau, const double *from, double *to);

/* Bounds of the terms from tau on. */
void tribo_modal_motion_bound(struct modal_motion *x, double tau);

/* c'y, c [2 ndof], in the phase that lasts tau and ends with the state end. Returns a status. */
int tribo_modal_motion_signal(const struct modal_motion *x, const double *c, double tau, const double *end, struct signal *to);

/* modal_course.c: the course of c->output, a velocity or not, which is value at t0, where the motion still is; and where go()
 * was; and its bounds, from those of terms. */
void tribo_course_begin(const struct modal_motion *x, struct course *c, int of_velocity, double value);
void tribo_course_look(const struct modal_motion *x, struct course *c);
void tribo_course_bound(const struct modal_motion *x, struct course *c);

/* Its third to fifth derivative where go() was, into to [3]; 1, or 0 if they are not known: where loads resonate. */
int tribo_course_look_further(const struct modal_motion *x, const struct course *c, double *to);

#endif
