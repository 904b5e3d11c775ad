/* Coulomb's law for methods with events: the decision, at an instant, which contacts stick, and in which direction others slide.
 *
 * The decision is about the motion just after the instant. Contacts of equal limits may reach them together and let go one after
 * another, each by a higher power of time, which no finite number of derivatives decides. So a contact whose slip rounding hides
 * holds; the search over the motion until the next event (first_zero.h) finds a force or velocity beyond the law by more than its
 * allowance, which is an event of its own. */
#ifndef TRIBO_STICK_SLIP_H
#define TRIBO_STICK_SLIP_H

#include "dynamics/driver.h"
#include "breakaway.h"
#include "planar_slip.h"

/* Excess of a force over its limit that is an event, in units of its noise. */
#define TRIBO_ALLOWED 8.0

/* Constant during an advance. contacts, above: ncontact of the system. */
struct slip_constant {
    size_t contacts;
    tribo_context *box;  /* clone of the system's context; solves min 1/2 f'R f + a'f, lo <= f <= hi */
    tribo_context *hold; /* solves R_HH f_H = -a_H over the holding contacts H, as f_eq for v = 0; NULL if R is diagonal */
    void *memory;        /* all arrays of the four parts */
    int uncoupled;       /* 1: R is diagonal */
    int independent;     /* 1: the rows of J are linearly independent, so that every contact at rest holds */
    int base_moves;      /* 1: b(t) is not zero throughout */
    double abstol;       /* tolerances of the driver */
    double reltol;
    double horizon;          /* time that decisions look ahead, short compared with the fastest motion */
    double *diagonal;        /* [ncontact] R_ii */
    double *inertia;         /* [ncontact] 1/R_ii; 0 if R_ii = 0 */
    double *still;           /* [ncontact] zeros */
    double *swing;           /* [ncontact] largest change of the limit by harmonics */
    double *base_size;       /* [ncontact] bound of |b_i|, with the rounding of t */
    double *base_rate_size;  /* [ncontact] bound of |b_i'| */
    double *load_size;       /* [ndof] bound of accelerations by harmonic loads */
    unsigned char *elastic;  /* [ncontact] 1: elastic contact */
    unsigned char *can_hold; /* [ncontact] 1: R_ii > 0, or elastic */
    size_t *all;             /* [ncontact] 0, 1, 2, ... */
};

/* What contacts do from the last decision on. */
struct slip_state {
    signed char *slip;     /* [ncontact] TRIBO_SLIP_...; written by tribo_stick_slip_set */
    unsigned char *rested; /* [ncontact] 1: at rest at the last decision, so that v_i = 0 there */
    signed char *slid;     /* [ncontact] slip by the last decision; elastic contacts */
    unsigned char *holds;  /* [ncontact] 1: at rest, in the independent set H that keeps all contacts at rest where they are; the
                              other contacts at rest keep their forces */
    signed char *loose;    /* [ncontact] 0: rigid and holds */
    signed char *key;      /* [ncontact, and zeros up to whole words of 8] 1: at rest; 2: at rest and holds */
    int dependents;        /* number of contacts at rest that do not hold */
    signed char *tied;     /* [ncontact] at rest and at the limit: 1: stays there; 2: goes back inside */
    signed char *before;   /* [ncontact] tied as of the last choice of H; contacts that depend on each other */
    int fresh;             /* 1: slip changed since the last choice of H */
    int hold_differs;      /* 1: H changed since constant.hold took it */
    struct snap *snap;     /* [snaps] corrections that make J x = base exact: of all contacts if sys->snaps_in_order, else of H */
    size_t snaps;
    int simple;          /* 1: snap has a correction for every contact of H */
    int unlisted;        /* 1: H changed since snap was listed */
    int steady;          /* 1: limits do not change after those that update_limits took */
    size_t reached;      /* the contact whose force just met its limit, by the event; ncontact if none */
    double *limit;       /* [ncontact] limit while sliding */
    double *limit_rate;  /* [ncontact] its rate */
    double *stick;       /* [ncontact] limit at rest: limit, or the static limit */
    double *stick_rate;  /* [ncontact] its rate */
    double *force;       /* [ncontact] friction force f */
    double *spring;      /* [ncontact] force of an elastic contact by the state */
    double *spring_rate; /* [ncontact] its rate */
    double *glide;       /* [ncontact] velocity of an elastic contact that slides */
    double *base;        /* [ncontact] b(t) */
};

/* Bounds of rounding. */
struct slip_noise {
    double factor;          /* 1; larger where events make no headway */
    double *velocity;       /* [ncontact] of v_i; of sliding contacts, and where acceleration[i] > 0 */
    double *velocity_scale; /* [ncontact] size of the terms of v_i in the phase before; 0: unknown */
    double *spring;         /* [ncontact] of the force of an elastic contact */
    double *parting;        /* [ncontact] of v_i of a contact at rest that does not hold, on a base that moves */
    double *found;          /* [founds] the four arrays below, one after the other; zeroed as a decision begins */
    size_t founds;
    double *acceleration; /* [ncontact] of v_i' */
    double *allowance;    /* [ncontact] excess of |f_i| over the limit that is no event */
    double *excess;       /* [ncontact] excess of |f_i| over the limit at the beginning of the phase */
    double *size;         /* [ndof] size of the terms of q'' */
};

/* Workspace of a decision. */
struct slip_work {
    const size_t *undecided; /* [undecided_count] contacts that the round decides about */
    size_t undecided_count;
    size_t *close; /* [close_count] contacts of undecided that may be at their limits */
    size_t close_count;
    size_t single;        /* the only contact of a coupled system whose force is unknown; ncontact if there are more */
    double single_a;      /* its acceleration without its own force */
    int limit_lost;       /* 1: a static limit was lost in this round */
    const double *a;      /* [ncontact] J q'' - b' without friction: own_a, or free if J = 1 */
    double *own_a;        /* [ncontact] */
    double *v;            /* [ncontact] velocities or accelerations */
    double *lo;           /* [ncontact] lower bounds of forces */
    double *hi;           /* [ncontact] upper bounds of forces */
    double *f;            /* [ncontact] forces */
    double *free;         /* [ndof] q'' without friction */
    double *acceleration; /* [ndof] q'' with friction */
    double *rate;         /* [ndof] rate of q'' */
    signed char *pulled;  /* [ncontact] direction in which a contact at its static limit slides a moment later; 0: none */
    size_t *at;           /* [ncontact] contacts at rest, of tribo_stick_slip_find_holds */
    unsigned char *last;  /* [ncontact] order of choice of these */
};

struct stick_slip {
    struct slip_constant constant;
    struct slip_state state;
    struct slip_noise noise;
    struct slip_work work;
    struct breakaway breakaway; /* static limits */
    struct planar_slip *plane;  /* planar contacts; NULL if there are none */
};

/* stick_slip_create.c: returns a status, its message on the system's context. */
int tribo_stick_slip_create(struct stick_slip *m, tribo_system *sys);
void tribo_stick_slip_free(struct stick_slip *m);

/* 1 for a slip along the contact's direction, forth or back. */
static inline int tribo_slides(signed char slip)
{
    return slip == TRIBO_SLIP_FORTH || slip == TRIBO_SLIP_BACK;
}

/* 1 if contact i is at rest and does not hold. */
static inline int tribo_stick_slip_depends(const struct stick_slip *m, size_t i)
{
    return m->state.slip[i] == TRIBO_SLIP_STUCK && !m->state.holds[i];
}

/* Sets the slip of contact i; the only function that writes slip. H follows: at once if independent, else by find_holds. */
static inline void tribo_stick_slip_set(struct stick_slip *m, size_t i, signed char slip)
{
    if (slip == m->state.slip[i]) {
        return;
    }
    const int rested = m->state.slip[i] == TRIBO_SLIP_STUCK, rests = slip == TRIBO_SLIP_STUCK;
    m->state.slip[i] = slip;
    if (!m->constant.independent) {
        m->state.fresh = 1;
        return;
    }
    m->state.holds[i] = (unsigned char)(rests & m->constant.can_hold[i]);
    m->state.loose[i] = (signed char)(!m->state.holds[i] || m->constant.elastic[i]);
    m->state.key[i] = (signed char)(rests + m->state.holds[i]);
    m->state.dependents += m->constant.can_hold[i] ? 0 : rests - rested;
    m->state.hold_differs = m->state.unlisted = 1;
}

/* stick_slip_instant.c: begins an advance: takes limits; unless it continues, contacts whose velocity is rounding are at rest.
 * A decision must follow. */
void tribo_stick_slip_start(struct stick_slip *m, tribo_system *sys, double t, double *y, int continues);

/* scalar_slip.c: the decision at (t, y); sets slip, holds, force and allowance, and removes rounding of velocities at rest
 * from y. Returns a status. */
int tribo_stick_slip_decide(struct stick_slip *m, tribo_system *sys, double t, double *y);

/* stick_slip_instant.c, the steps of a decision. Sets the time and bases; updates limits, and opens and closes contacts by
 * them; brings contacts to rest that have no velocity in the direction of their slip. The last one returns a status. */
void tribo_stick_slip_begin_decision(struct stick_slip *m, tribo_system *sys, double t);
void tribo_stick_slip_update_limits(struct stick_slip *m, const tribo_system *sys, const double *y);
int tribo_stick_slip_find_resting(struct stick_slip *m, const tribo_system *sys, double *y);

/* Redundant forces start from those found last; this makes them start from zero. */
void tribo_stick_slip_forget_shares(struct stick_slip *m);

/* Sets horizon, base_size, base_rate_size and load_size. */
void tribo_stick_slip_find_scales(struct stick_slip *m, const tribo_system *sys);

/* noise.acceleration and allowance: zeroed; found of contact i, unless known; found of all. */
void tribo_stick_slip_forget_gains(struct stick_slip *m);
void tribo_stick_slip_find_gain(struct stick_slip *m, const tribo_system *sys, const double *y, size_t i);
void tribo_stick_slip_find_gains(struct stick_slip *m, const tribo_system *sys, const double *y);

/* The largest of noise.size. */
double tribo_stick_slip_acceleration_size(struct stick_slip *m, const tribo_system *sys, const double *y);

/* 1 if v_i is below what rounding of accelerations makes of it, which several contacts that hold a body together leave. */
int tribo_stick_slip_is_faint(struct stick_slip *m, const tribo_system *sys, const double *y, size_t i);

/* Sets work.free and work.a at (t, y). */
void tribo_stick_slip_find_free(struct stick_slip *m, tribo_system *sys, double t, const double *y);

/* Returns q'' [ndof] with state.force, also after a decision; sets work.rate = its rate at constant forces; sets to [ncontact]
 * = J acceleration - the order-th derivative of b. */
const double *tribo_stick_slip_find_acceleration(struct stick_slip *m, const tribo_system *sys);
void tribo_stick_slip_find_rate(struct stick_slip *m, const tribo_system *sys, const double *y);
void tribo_stick_slip_contact_accelerations(const tribo_system *sys, const double *acceleration, int order, double *to);

/* 1 if contact i is rigid and at rest: its force is unknown. */
static inline int tribo_stick_slip_searches(const struct stick_slip *m, size_t i)
{
    return m->state.slip[i] == TRIBO_SLIP_STUCK && !m->constant.elastic[i];
}

/* A force this close to its limit, in parts of it, may exceed it by rounding, or in a moment as other contacts begin to
 * slide. */
#define TRIBO_CLOSE 0.1

/* 1 if the force of contact i was found alone. */
static inline int tribo_stick_slip_alone(const struct stick_slip *m, size_t i)
{
    return m->constant.uncoupled || m->work.single == i;
}

/* stick_slip_forces.c, for contacts of work.undecided. Finds f [ncontact] within work.lo and hi at accelerations a without f;
 * finds state.force, and work.close by it. Both return a status. Sets v [ncontact] = a + R f; v may be a. */
int tribo_stick_slip_solve(struct stick_slip *m, const tribo_system *sys, const double *a, double *f);
int tribo_stick_slip_find_forces(struct stick_slip *m, tribo_system *sys);
void tribo_stick_slip_accelerate(struct stick_slip *m, const tribo_system *sys, const double *a, const double *f, double *v);

/* Lets contact i slide; if it held by a static limit, lowers that instead, and the next round decides about it. */
static inline void tribo_stick_slip_let_go(struct stick_slip *m, size_t i, signed char direction)
{
    const int again = m->breakaway.some && tribo_breakaway_lets_go(&m->breakaway, i);
    tribo_stick_slip_set(m, i, again ? TRIBO_SLIP_STUCK : direction);
    m->state.tied[i] = 0;
    m->work.limit_lost |= again;
}

/* 1 if contact i would lose a static limit and forces at rest are not unique. */
static inline int tribo_stick_slip_must_be_sure(const struct stick_slip *m, size_t i)
{
    return m->state.dependents && tribo_breakaway_is_sudden(&m->breakaway, i);
}

/* stick_slip_relieve.c: decides about contacts whose accelerations are rounding, and those that must be sure, by the forces
 * that hold all contacts at rest: takes these, or lets contacts slide and sets *changes = 1. Returns a status. */
int tribo_stick_slip_relieve(struct stick_slip *m, tribo_system *sys, size_t *changes);

/* stick_slip_elastic.c: elastic contacts, whose forces are part of the state. find sets state.spring and noise.spring; start
 * takes forces beyond limits back in y, and dissipates their energy. A decision calls place (sets slip, and forces, also in y),
 * move (sets rates of forces, and velocities of those that slide), and finish (keeps slip for the next decision). */
void tribo_elastic_find(struct stick_slip *m, const tribo_system *sys, const double *y);
void tribo_elastic_start(struct stick_slip *m, const tribo_system *sys, double *y);
void tribo_elastic_place(struct stick_slip *m, const tribo_system *sys, double *y);
void tribo_elastic_move(struct stick_slip *m, const tribo_system *sys, const double *y);
void tribo_elastic_finish(struct stick_slip *m, const tribo_system *sys);

/* holds.c: chooses H among the contacts at rest; sets holds, loose, key and dependents. Returns a status. */
int tribo_stick_slip_find_holds(struct stick_slip *m, const tribo_system *sys);

/* 1 if holds[] is up to date. */
static inline int tribo_stick_slip_knows_holds(const struct stick_slip *m)
{
    return m->constant.independent && !m->state.fresh;
}

/* stick_slip_instant.c: finds q'' [ndof] and all forces [ncontact] at (t, y) for the slip of the last decision. Returns a
 * status. */
int tribo_stick_slip_acceleration(struct stick_slip *m, tribo_system *sys, double t, const double *y, double *acceleration,
                                  double *force);

/* R diagonal: the force of contact i if it holds, else 0. */
static inline double tribo_stick_slip_balance_alone(const struct stick_slip *m, size_t i, double a)
{
    return m->state.loose[i] ? 0.0 : -a / m->constant.diagonal[i];
}

/* holds.c: solves R_HH f_H = -a_H; other f are 0. Returns a status. */
int tribo_stick_slip_balance(struct stick_slip *m, const double *a, double *f);

/* holds.c: x -= B_H R_HH^-1 (J_H x - base), which makes J_H x = base. Returns a status. */
int tribo_stick_slip_project(struct stick_slip *m, const tribo_system *sys, const double *base, double *x);

/* The same for J x - base that is rounding: by snaps, then by project if they are not enough. Returns a status. */
int tribo_stick_slip_hold(struct stick_slip *m, const tribo_system *sys, const double *base, double *x);

/* Lists the corrections that make J x = base exact for contacts that are not loose. */
void tribo_stick_slip_list_snaps(struct stick_slip *m, const tribo_system *sys);

/* Force of contact i over its limit at high speed, if it follows the limit: -slip if it slides; + or - ratio if it is tied and
 * does not hold; else 0. */
double tribo_stick_slip_follows(const struct stick_slip *m, size_t i);

/* 1 if contact i is at rest, does not hold, and a base moves: its velocity needs guards. */
static inline int tribo_stick_slip_may_part(const struct stick_slip *m, size_t i)
{
    return m->constant.base_moves && m->state.slip[i] == TRIBO_SLIP_STUCK && !m->state.holds[i];
}

/* Force beyond its limit with which contact i holds: the allowance, if its limit drops as it breaks away. */
double tribo_stick_slip_margin(const struct stick_slip *m, size_t i);

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
    const struct matrix *j = &sys->direction;
    const double *u = y + sys->ndof;
    double v = -m->state.base[i];
    for (size_t k = j->first[i], end = j->first[i + 1]; k < end; k++) {
        v += j->val[k] * u[j->col[k]];
    }
    return v;
}

/* The velocity of contact i as the motion after the decision at y begins. */
static inline double tribo_stick_slip_first_velocity(const struct stick_slip *m, const tribo_system *sys, size_t i,
                                                     const double *y)
{
    const double v = m->constant.elastic[i] ? m->state.glide[i] : tribo_stick_slip_velocity(m, sys, i, y);
    return m->state.rested[i] ? 0.0 : v;
}

static inline double tribo_stick_slip_find_velocity(struct stick_slip *m, const tribo_system *sys, size_t i, const double *y)
{
    const struct matrix *j = &sys->direction;
    const double *u = y + sys->ndof;
    double v = -m->state.base[i], size = 0.0;
    for (size_t k = j->first[i], end = j->first[i + 1]; k < end; k++) {
        const double part = j->val[k] * u[j->col[k]];
        v += part;
        size += fabs(part);
    }
    m->noise.velocity[i] = tribo_stick_slip_velocity_noise(m, i, size);
    return v;
}

#endif
