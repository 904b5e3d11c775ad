/* SPDX-License-Identifier: BSD-3-Clause */
/* Coulomb's law for methods with events: the decision, at an instant, which contacts stick, and in which direction others slide.
 *
 * The decision is about the motion just after the instant. Contacts of equal limits may reach them together and let go one after
 * another, each by a higher power of time, which no finite number of derivatives decides. So a contact whose slip rounding hides
 * holds; the search over the motion until the next event (first_zero.h) finds a force or velocity beyond the law by more than its
 * allowance, which is an event of its own. */
#ifndef TRIBO_STICK_SLIP_H
#define TRIBO_STICK_SLIP_H

#include "dynamics/driver.h"
#include "common/real.h"

/* Excess of a force over its limit that is an event, in units of its noise. */
#define TRIBO_ALLOWED 8.0

/* Constant during an advance. contacts, above: ncontact of the system. */
struct slip_constant {
    tribo_system *sys;
    size_t contacts;
    tribo_context *box;  /* clone of the system's context; solves min 1/2 f'R f + a'f, lo <= f <= hi; or NULL */
    tribo_context *hold; /* solves R_HH f_H = -a_H over the holding contacts H, as f_eq for v = 0; NULL if R is diagonal */
    void *memory;        /* all arrays of the four parts */
    int uncoupled;       /* 1: R is diagonal */
    int independent;     /* 1: the rows of J are linearly independent, so that every contact at rest holds */
    int base_moves;      /* 1: b(t) is not zero throughout */
    double abstol;       /* tolerances of the driver */
    double reltol;
    double horizon;         /* time that decisions look ahead, short compared with the fastest motion */
    double *diagonal;       /* [ncontact] R_ii */
    double *inertia;        /* [ncontact] 1/R_ii; 0 if R_ii = 0 */
    double *still;          /* [ncontact] zeros */
    double *swing;          /* [ncontact] largest change of the limit by harmonics */
    double *base_size;      /* [ncontact] bound of |b_i|, with the rounding of t */
    double *base_rate_size; /* [ncontact] bound of |b_i'| */
    double *load_size;      /* [ndof] bound of accelerations by harmonic loads */
    unsigned char *elastic; /* [ncontact] 1: elastic contact */
    size_t pairs;           /* number of elastic contacts in a plane */
    unsigned char *pair;    /* [ncontact] PAIR_..., of these contacts */
};

/* What contacts do from the last decision on. */
struct slip_state {
    signed char *slip;     /* [ncontact] TRIBO_SLIP_...; written by tribo_stick_slip_set */
    unsigned char *rested; /* [ncontact] 1: at rest at the last decision, so that v_i = 0 there */
    signed char *slid;     /* [ncontact] slip by the last decision; elastic contacts */
    int fresh;             /* 1: slip changed since the last choice of H: the members from holds to simple are of that choice. If
                              all contacts at rest hold (constant.independent) H changes with slip */
    unsigned char *holds;  /* [ncontact] 1: at rest, in the independent set H that keeps all contacts at rest where they are; the
                              other contacts at rest keep their forces */
    signed char *loose;    /* [ncontact] 0: rigid and holds */
    signed char *key;      /* [ncontact, and zeros up to whole words of 8] 1: at rest; 2: at rest and holds */
    size_t dependents;     /* number of contacts at rest that do not hold */
    signed char *before;   /* [ncontact] tied as of the last choice of H; contacts that depend on each other */
    int hold_differs;      /* 1: H changed since constant.hold took it */
    int snaps_differ;      /* 1: H changed since snap was listed for it */
    struct snap *snap;     /* [snaps] corrections that make J x = base exact: of all contacts if sys->snaps.in_order, else of H */
    size_t snaps;
    int simple;                 /* 1: snap has a correction for every contact of H */
    signed char *tied;          /* [ncontact] at rest and at the limit: 1: stays there; 2: goes back inside */
    size_t reached;             /* contact with |f| = limit at the event, or normal with N = 0; ncontact: none */
    double *limit;              /* [ncontact] limit while sliding */
    double *limit_rate;         /* [ncontact] its rate */
    double *stick;              /* [ncontact] limit at rest */
    double *stick_rate;         /* [ncontact] its rate */
    double *force;              /* [ncontact] friction force f */
    double *spring;             /* [ncontact] force of an elastic contact by the state */
    double *spring_rate;        /* [ncontact] its rate */
    double *glide;              /* [ncontact] velocity of an elastic contact that slides */
    double *base;               /* [ncontact] b(t) */
    unsigned char *pressed;     /* [normals] 1: pressed by the last decision */
    unsigned char *was_pressed; /* [normals] 1: pressed before this decision */
    unsigned char *rests;       /* [normals] 1: depth and speed are 0 */
};

/* Bounds of rounding. */
struct slip_noise {
    double factor;          /* 1; larger where events make no headway */
    double *velocity;       /* [ncontact] of v_i; of sliding contacts, and where acceleration[i] > 0 */
    double *velocity_scale; /* [ncontact] size of the terms of v_i in the phase before; 0: unknown */
    double *spring;         /* [ncontact] of the force of an elastic contact */
    double *parting;        /* [ncontact] of v_i of a contact at rest that does not hold, on a base that moves */
    size_t founds;          /* doubles of the four arrays below, one after the other; zeroed as a decision begins */
    double *acceleration;   /* [ncontact] of v_i' */
    double *allowance;      /* [ncontact] excess of |f_i| over the limit that is no event */
    double *excess;         /* [ncontact] excess of |f_i| over the limit at the beginning of the phase */
    double *size;           /* [ndof] size of the terms of q'' */
};

/* Workspace of a decision. */
struct slip_work {
    int limit_lost;       /* 1: a static limit was lost in this round */
    double *a;            /* [ncontact] J q'' - b' without friction */
    double *v;            /* [ncontact] velocities or accelerations */
    double *lo;           /* [ncontact] lower bounds of forces */
    double *hi;           /* [ncontact] upper bounds of forces */
    double *f;            /* [ncontact] forces */
    double *free;         /* [ndof] q'' without friction */
    double *acceleration; /* [ndof] q'' with friction */
    double *rate;         /* [ndof] rate of q'' */
    signed char *pulled;  /* [ncontact] direction in which a contact at its static limit slides a moment later; 0: none */
    size_t *at;           /* [ncontact] contacts at rest, as H is chosen */
    unsigned char *last;  /* [ncontact] order of choice of these */
    size_t *doubt;        /* [doubts] contacts that others or their own limits may change in this decision */
    size_t doubts;
};

/* Limits at rest that differ from those to slide: limits.c. */
struct slip_limits {
    int differ;           /* 1: some ratio is above 1 */
    int falls;            /* 1: limits fall with the speed */
    double *ratio;        /* [ncontact] limit at rest over the limit at high speed */
    double *velocity;     /* [ncontact] by which limits fall */
    double *kinetic;      /* [ncontact] limit at high speed */
    double *kinetic_rate; /* [ncontact] its rate */
    double steepest;      /* bound of the growth rate of perturbations by limits that fall */
};

/* How a planar contact slides: with a velocity; without one, by its acceleration; or by its force alone, which is about to
 * reach beyond the limit. The value is the power of time with which the velocity begins. */
enum { SLIDES_ON = 0, BY_ACCELERATION = 1, BY_FORCE = 2 };

/* Of a scalar contact only at, size and limit[0] count. */
struct planar_contact {
    size_t at;           /* index of its first direction; the second one is at + 1 */
    size_t size;         /* number of directions */
    double limit[2];     /* at this decision */
    double weight[2];    /* the force is along weight v; limit, or 1 if that varies */
    int varies;          /* 1: the limit varies, and is the same in both directions */
    double half;         /* the guard at rest is half (ratio^2 limit^2 - |f|^2), each over weight */
    double blunt;        /* > 0: the guard at rest is (limit^2 - |f|^2)/2 over this, and limits may be less */
    size_t lag;          /* the power of time with which the limit begins: 0, 1, or 2 for all higher ones */
    double brake;        /* the largest of weight R_ii */
    double most;         /* the largest speed so far */
    double now;          /* speed at this decision; 0 where it begins to slide */
    double before;       /* speed at the decision before */
    double stop;         /* time in which friction would stop it, at this decision */
    int begins;          /* SLIDES_ON, BY_ACCELERATION or BY_FORCE */
    double direction[2]; /* if not SLIDES_ON: direction of weight v, against that of force/weight; length 1 */
    double way[2];       /* the last direction of weight v that is not lost in the rounding of v */
    double settled[2];   /* the last one at SETTLED times that speed (planar_slip.c) */
};

struct planar_slip {
    tribo_context *disc;            /* forces of contacts at rest, as f_eq by Coulomb's law for v = 0 */
    size_t count;                   /* number of planar contacts */
    size_t all;                     /* number of contacts */
    struct planar_contact *contact; /* [all] planar contacts, then scalar ones */
    size_t stopped;                 /* a contact that the last decision brought to rest; ncontact if none */
    unsigned char *in_plane;        /* [ncontact] PAIR_... of a planar contact; of a scalar one PAIR_NONE */
    double *error;                  /* [ncontact] errors that velocities may have in a step */
    double *rate;                   /* [ncontact] workspace: rates of sliding forces */
    double *ahead;                  /* [ncontact] workspace: accelerations a moment later */
};

struct stick_slip {
    struct slip_constant constant;
    struct slip_state state;
    struct slip_noise noise;
    struct slip_work work;
    struct slip_limits limits;
    struct planar_slip *plane; /* NULL if there are no planar contacts */
};

/* stick_slip.c: create returns a status, its message on the system's context. start begins an advance: reads the
 * limits; continues = 0: contacts with velocities of rounding size are at rest. Call the decision next. Returns a status, too. */
int tribo_stick_slip_create(struct stick_slip *m, tribo_system *sys);
void tribo_stick_slip_free(struct stick_slip *m);
int tribo_stick_slip_start(struct stick_slip *m, tribo_system *sys, double t, double *y, int continues);

/* The decision at (t, y); sets slip, holds, force and allowance, and removes rounding of velocities at rest from y. Returns a
 * status. */
int tribo_stick_slip_decide(struct stick_slip *m, tribo_system *sys, double t, double *y);

/* Finds q'' [ndof] and all forces [ncontact] at (t, y) for the slip of the last decision. Returns a status. */
int tribo_stick_slip_acceleration(struct stick_slip *m, tribo_system *sys, double t, const double *y, double *acceleration,
                                  double *force);

/* Sets the normals that are pressed to those of the last decision: what evaluates the system in between, as an observer may, sets
 * them by its own states. */
void tribo_stick_slip_press(const struct stick_slip *m, tribo_system *sys);

/* Redundant forces start from those found last; this makes them start from zero. */
void tribo_stick_slip_forget_shares(struct stick_slip *m);

/* holds.c: sets what follows from slip[i] and from holds, 1 if contact i is at rest and in H. */
void tribo_stick_slip_set_hold(struct stick_slip *m, size_t i, int holds);

/* 1 if the force of contact i is a part of the state, as behind a spring: it has no jumps. */
static inline int tribo_force_is_state(const struct stick_slip *m, size_t i)
{
    return m->constant.elastic[i];
}

/* 1 if contact i has R_ii > 0, or is elastic. */
static inline int tribo_can_hold(const struct stick_slip *m, size_t i)
{
    return m->constant.diagonal[i] > 0.0 || m->constant.elastic[i];
}

/* Sets the slip of contact i; the only function that writes slip. H follows at once or, if contacts at rest may depend on each
 * other, by find_holds. */
static inline void tribo_stick_slip_set(struct stick_slip *m, size_t i, signed char slip)
{
    if (m->state.slip[i] != slip) {
        m->state.slip[i] = slip;
        m->state.fresh = 1;
        if (m->constant.independent) {
            tribo_stick_slip_set_hold(m, i, slip == TRIBO_SLIP_STUCK && tribo_can_hold(m, i));
        }
    }
}

/* 1 for a slip along the contact's direction, forth or back. */
static inline int tribo_slides(signed char slip)
{
    return slip == TRIBO_SLIP_FORTH || slip == TRIBO_SLIP_BACK;
}

/* The displacement by a unit force of the spring before the slider of contact i. */
double tribo_spring_of(const struct stick_slip *m, size_t i);

/* 1 if planar contact p slides. */
static inline int tribo_slides_in_plane(const struct stick_slip *m, const struct planar_contact *p)
{
    return m->state.slip[p->at] == TRIBO_SLIP_PLANE;
}

/* 1 if contact i is rigid and at rest: its force is unknown. */
static inline int tribo_stick_slip_searches(const struct stick_slip *m, size_t i)
{
    return m->state.slip[i] == TRIBO_SLIP_STUCK && !m->constant.elastic[i];
}

/* 1 if contact i is at rest, does not hold, and a base moves: its velocity needs guards. */
static inline int tribo_stick_slip_may_part(const struct stick_slip *m, size_t i)
{
    return m->constant.base_moves && m->state.slip[i] == TRIBO_SLIP_STUCK && !m->state.holds[i];
}

/* ------------------------------------------------------------------------------------------------ the steps of a decision */

/* Brings contacts to rest that have no velocity in the direction of their slip. Returns a status. */
int tribo_stick_slip_find_resting(struct stick_slip *m, const tribo_system *sys, double *y);

/* scalar_slip.c: lets contacts at rest slide by the forces; sets slip, tied, force and allowance. Returns a status. */
int tribo_scalar_slip_settle(struct stick_slip *m, const tribo_system *sys, const double *y);

/* noise.acceleration and allowance: found of contact i, unless known; found of all. */
void tribo_stick_slip_find_gain(struct stick_slip *m, const tribo_system *sys, const double *y, size_t i);
void tribo_stick_slip_find_gains(struct stick_slip *m, const tribo_system *sys, const double *y);

/* The largest of noise.size. */
double tribo_stick_slip_acceleration_size(struct stick_slip *m, const tribo_system *sys, const double *y);

/* Sets work.rate = the rate of q'' at constant forces; sets to [ncontact] = J acceleration - the order-th derivative of b; sets
 * v [ncontact] = a + R f, where v may be a. */
void tribo_stick_slip_find_rate(struct stick_slip *m, const tribo_system *sys, const double *y);
void tribo_stick_slip_contact_accelerations(const tribo_system *sys, const double *acceleration, int order, double *to);
void tribo_stick_slip_accelerate(struct stick_slip *m, const tribo_system *sys, const double *a, const double *f, double *v);

/* elastic_slip.c: elastic contacts; the state contains their forces. find sets state.spring and noise.spring; start
 * sets forces in y that exceed limits to these limits, and counts the lost energy as dissipated. A decision calls place (sets
 * slip, and forces, also in y) and move (sets rates of forces, and velocities of contacts that slide). */
void tribo_elastic_find(struct stick_slip *m, const tribo_system *sys, const double *y);
void tribo_elastic_start(struct stick_slip *m, const tribo_system *sys, double *y);

/* Returns 1 if the force of the contact in a plane with first direction i turns with its velocity v [2] at once: its limit is 0,
 * or so small that the time c limit/|v| in which the force turns does not count, and changes slowly in this time. */
int tribo_follows_velocity(const struct stick_slip *m, size_t i, const double *v);

/* Sets pair; returns a status, its message on the system's context. */
int tribo_elastic_pair(struct stick_slip *m, const tribo_system *sys);
void tribo_elastic_place(struct stick_slip *m, const tribo_system *sys, double *y);
void tribo_elastic_move(struct stick_slip *m, const tribo_system *sys, const double *y);

/* holds.c: chooses H among the contacts at rest, if slip or, of contacts that depend on each other, tied has changed. Returns a
 * status. */
int tribo_stick_slip_find_holds(struct stick_slip *m, const tribo_system *sys);

/* holds.c: solves R_HH f_H = -a_H; other f are 0. Returns a status, with a message in the system. */
int tribo_stick_slip_balance(struct stick_slip *m, const double *a, double *f);

/* x += B_H f, f [ncontact] = -R_HH^-1 (J_H x - base), which makes J_H x = base. Returns a status. */
static inline int tribo_stick_slip_pull(struct stick_slip *m, const tribo_system *sys, const double *base, double *x, double *f)
{
    double *a = m->work.lo;
    for (size_t i = 0; i < m->constant.contacts; i++) {
        a[i] = -base[i];
    }
    tribo_matrix_multiply_add(&sys->direction, 1.0, x, a);
    const int status = tribo_stick_slip_balance(m, a, f);
    if (!status) {
        tribo_matrix_multiply_add(&sys->response, 1.0, f, x);
    }
    return status;
}

/* holds.c: the same twice. Returns a status. */
int tribo_stick_slip_project(struct stick_slip *m, const tribo_system *sys, const double *base, double *x);

/* The same for J x - base that is rounding: by snaps, then by project if they are not enough. Returns a status. */
int tribo_stick_slip_hold(struct stick_slip *m, const tribo_system *sys, const double *base, double *x);

/* Force of contact i over its limit at high speed, if it follows the limit: -slip if it slides; + or - ratio if it is tied and
 * does not hold; else 0. */
double tribo_stick_slip_follows(const struct stick_slip *m, size_t i);

/* limits.c. start, at the beginning of an advance, reads ratios and velocities. take: state.limit and its rate are of the system;
 * sets limits at rest. fall: sets limits that fall at the velocities of y; accelerations a [ncontact], or NULL, add to their
 * rates. set_stick sets a limit at rest to ratio times that at high speed. */
void tribo_limits_start(struct stick_slip *m, tribo_system *sys);
void tribo_limits_take(struct stick_slip *m);
void tribo_limits_fall(struct stick_slip *m, const tribo_system *sys, const double *y, const double *a);
void tribo_limits_set_stick(struct stick_slip *m, size_t i, double ratio);

/* 1 if the limit of contact i drops as it begins to slide, which must be certain then. */
static inline int tribo_drops(const struct stick_slip *m, size_t i)
{
    return m->state.stick[i] > m->limits.kinetic[i];
}

/* ---------------------------------------------------------------------------------------- planar_slip.c: planar contacts */

void tribo_planar_slip_free(struct planar_slip *p); /* NULL is fine */

/* Takes the planar contacts from the system, unless it continues. Returns a status, its message on the system's context. */
int tribo_planar_slip_start(struct stick_slip *m, const tribo_system *sys, int continues);

/* In the place of tribo_stick_slip_find_resting and tribo_scalar_slip_settle where there are planar contacts. */
int tribo_planar_slip_find_resting(struct stick_slip *m, const tribo_system *sys, double *y);
int tribo_planar_slip_settle(struct stick_slip *m, const tribo_system *sys, const double *y);

/* Returns the first direction of a planar contact that is about to stop in a direction that still turns; ncontact if there is
 * none. */
size_t tribo_stick_slip_uncertain(const struct stick_slip *m);

/* The excess of a force over its limit in a phase in which the guard of contact i at rest falls to -lowest. */
double tribo_stick_slip_excess(const struct stick_slip *m, size_t i, double lowest);

/* Of the guard of contact i at rest, if it is planar: sets the derivatives by forces, entries i and i + 1 of by_force, and by the
 * limit to slide; force [ncontact]: the forces. */
void tribo_stick_slip_hold_by_forces(const struct stick_slip *m, size_t i, const double *force, double *by_force,
                                     double *by_limit);

/* row [ndof] += derivatives, by the velocities of the structure, of times'f, f [ncontact]: forces of planar contacts that slide
 * at y, which turn. */
void tribo_stick_slip_turn(const struct stick_slip *m, const tribo_system *sys, const double *y, const double *times,
                           double *row);

/* Sets the entries of force [ncontact] of planar contacts that slide, by their velocities in y. */
void tribo_planar_slip_forces(const struct stick_slip *m, const tribo_system *sys, const double *y, double *force);

/* ---------------------------------------------------------------------------------------------------------- velocities */

/* Rounding of a velocity, in parts of the sum of the sizes of its terms. */
#define TRIBO_VELOCITY_NOISE 2e-14

/* Bound of the rounding of v_i, size being the sum of the sizes of J_ik u_k. */
static inline double tribo_stick_slip_velocity_noise(const struct stick_slip *m, size_t i, double size)
{
    return TRIBO_VELOCITY_NOISE * greater(m->constant.base_size[i] + size, m->noise.velocity_scale[i]);
}

/* v_i in y, with b at the time of the last decision; find_velocity also sets noise.velocity[i]. */
static inline double tribo_stick_slip_velocity(const struct stick_slip *m, const tribo_system *sys, size_t i, const double *y)
{
    return tribo_matrix_row_dot(&sys->direction, i, y + sys->ndof) - m->state.base[i];
}

static inline double tribo_stick_slip_find_velocity(struct stick_slip *m, const tribo_system *sys, size_t i, const double *y)
{
    const double size = tribo_matrix_row_size(&sys->direction, i, y + sys->ndof);
    m->noise.velocity[i] = tribo_stick_slip_velocity_noise(m, i, size);
    return tribo_stick_slip_velocity(m, sys, i, y);
}

/* The velocity of contact i as the motion after the decision at y begins. */
static inline double tribo_stick_slip_first_velocity(const struct stick_slip *m, const tribo_system *sys, size_t i,
                                                     const double *y)
{
    const double v = m->constant.elastic[i] ? m->state.glide[i] : tribo_stick_slip_velocity(m, sys, i, y);
    return m->state.rested[i] ? 0.0 : v;
}

#endif
