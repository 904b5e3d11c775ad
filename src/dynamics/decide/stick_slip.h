/* Coulomb's law itself, for the event-located drivers: which contacts stick at an instant, and which way the others slide.
 *
 * What counts is the law just after that instant, and the least change there may decide: contacts of equal limits reach them
 * together and let go one after another, each by a higher power of time. No finite number of derivatives decides that. So
 * what rounding hides is left undecided here, and such a contact holds; but the whole motion until the next event is looked over
 * (first_zero.h), and what goes beyond the law by more than is allowed for is an event of its own, at which the forces tell. */
#ifndef TRIBO_STICK_SLIP_H
#define TRIBO_STICK_SLIP_H

#include "dynamics/driver.h"
#include "breakaway.h"
#include "planar_slip.h"

/* Forces may go beyond their limits by so many times their noise, before that is an event: by then it is no noise. */
#define TRIBO_ALLOWED 8.0

struct stick_slip {
    tribo_context *box;  /* a clone of the system's context, for problems with bounds */
    tribo_context *hold; /* another one, that finds the forces of the contacts that hold, and only theirs, as f_eq for v = 0; NULL
                            where R couples nobody */
    void *memory;        /* of all arrays, but for those of breakaway and plane */
    size_t contacts;
    int uncoupled;   /* R is diagonal */
    int independent; /* the contacts at rest hold, whoever they are: none depends on others */
    int base_moves;
    double doubt;   /* 1, or by how much more than rounding may be in doubt, where events make no headway */
    size_t reached; /* the contact whose force has just met its limit, whatever rounding says of it; ncontact if there is none */
    double horizon; /* a time short beside the fastest motion: so far decisions look ahead */
    signed char *slip;     /* [ncontact] TRIBO_SLIP_... */
    unsigned char *holds;  /* [ncontact] 1: at rest, and needed to keep the contacts at rest where they are; the other ones rest
                              by themselves, and keep their forces */
    signed char *loose;    /* [ncontact] 1: it does not hold */
    signed char *key;      /* [ncontact] 1: at rest, 2: and holds; and zeros after it, up to whole words of 8 */
    int dependents;        /* how many rest by themselves */
    int steady;            /* limits are those that update_limits has seen */
    unsigned char *rested; /* [ncontact] 1: was at rest when last decided about: its velocity starts from zero */
    double *limit, *limit_rate; /* [ncontact] by which contacts slide, and its rate */
    double *stick, *stick_rate; /* [ncontact] by which those at rest hold: these, unless there are static limits */
    double *swing;              /* [ncontact] by how much harmonics change the limit at most */
    struct breakaway breakaway; /* of static limits */
    int again;                  /* some were lost in this round of a decision */
    struct planar_slip *plane;  /* of planar contacts; NULL if there are none */
    double abstol, reltol;      /* of the driver */
    double *force;              /* [ncontact] after tribo_stick_slip_decide: friction, */
    double *found;              /* [founds] what a decision finds out where that is needed, and else is 0: */
    size_t founds;
    double *gain;               /* [ncontact] what accelerations of contacts may be rounding, */
    double *allowance;          /* [ncontact] by how much forces may exceed their limits before that counts, */
    double *excess;             /* [ncontact] by how much they do where this begins, */
    double *size;               /* [ndof] and how large the parts of q'' are */
    double *parting;            /* [ncontact] by how much the velocity of one that rests by itself may differ from zero */
    double *base, *noise;       /* [ncontact] b(t); what of v may be rounding, of those that slide, and where gain is known */
    double *seen;               /* [ncontact] size of all that v was the sum of in the phase before, if known, else 0 */
    double *diagonal, *inertia; /* [ncontact] R_ii, and one over it, or 0 */
    double *v, *own_a;          /* [ncontact] relative velocity; room for the next one */
    const double *a;            /* [ncontact] acceleration without friction */
    double *lo, *hi, *f;        /* [ncontact] workspace: bounds, forces */
    double *free, *acceleration, *rate; /* [ndof] q'' without friction; workspace: with it, its rate */
    double *base_size, *base_rate_size; /* [ncontact] how large b, and its rate, ever are */
    double *load_size;                  /* [ndof] how large accelerations by harmonic loads ever are */
    signed char *tied;                  /* [ncontact] at rest just at its limit: 1 and staying there, 2 going back inside */
    signed char *pulled; /* [ncontact] workspace: the way a contact at its limit goes a moment later, if it breaks away */
    signed char *before; /* [ncontact] who was tied when find_holds looked last, if contacts depend on each other */
    int fresh;           /* some slip has changed since then, or all may have: who holds has to be found anew */
    int hold_differs;    /* hold has not been told who holds */
    double *spring, *spring_rate, *slack; /* [ncontact] elastic contacts: their force, its rate, and its allowance */
    signed char *slid;                    /* [ncontact] slip as decided last */
    double *still;                        /* [ncontact] zeros */
    const size_t *asked;                  /* [asks] the contacts that a decision still asks about: all if R couples them */
    size_t asks, *all;                    /* the latter is [ncontact] */
    size_t *close, closes;                /* [closes] of those asked about: such as may be at their limits by the forces found */
    size_t only;                          /* contact whose force alone was searched for last, R coupling it; else ncontact, */
    double pull;                          /* and its acceleration without that force */
    unsigned char *elastic, *can_hold;    /* [ncontact] 1: an elastic contact; one that holds something, if it rests */
    struct snap *snap;                    /* [snaps] of all contacts where their order is one for all, else of those that hold, */
    size_t snaps;
    int simple;          /* which are no more than these; */
    int unlisted;        /* or who holds has changed since they were listed */
    size_t *at;          /* [ncontact] workspace of find_holds, */
    unsigned char *last; /* [ncontact] and this */
};

/* stick_slip_create.c: TRIBO_OK or a failure with its message on the system's context. tribo_stick_slip_free takes what failed
 * too. */
int tribo_stick_slip_create(struct stick_slip *m, tribo_system *sys);
void tribo_stick_slip_free(struct stick_slip *m);

/* 1 for a slip along the contact's direction, forth or back. */
static inline int tribo_slides(signed char slip)
{
    return slip == TRIBO_SLIP_FORTH || slip == TRIBO_SLIP_BACK;
}

/* Whether contact i is at rest, and nothing that it holds keeps it there. */
static inline int tribo_stick_slip_depends(const struct stick_slip *m, size_t i)
{
    return m->slip[i] == TRIBO_SLIP_STUCK && !m->holds[i];
}

/* Contact i does this from here on. Nobody else writes slip: who holds follows from it, at once where contacts do not depend on
 * each other. */
static inline void tribo_stick_slip_set(struct stick_slip *m, size_t i, signed char slip)
{
    if (slip == m->slip[i]) {
        return;
    }
    const int rested = m->slip[i] == TRIBO_SLIP_STUCK, rests = slip == TRIBO_SLIP_STUCK;
    m->slip[i] = slip;
    if (!m->independent) {
        m->fresh = 1;
        return;
    }
    m->holds[i] = (unsigned char)(rests & m->can_hold[i]);
    m->loose[i] = (signed char)(!m->holds[i] || m->elastic[i]);
    m->key[i] = (signed char)(rests + m->holds[i]);
    m->dependents += m->can_hold[i] ? 0 : rests - rested;
    m->hold_differs = m->unlisted = 1;
}

/* stick_slip_instant.c: takes limits from the system, and, unless it continues, from the state who is at rest:
 * contacts whose velocity is zero to rounding. A decision must follow. */
void tribo_stick_slip_start(struct stick_slip *m, tribo_system *sys, double t, double *y, int continues);

/* scalar_slip.c: decides about the contacts at rest, one of which may have reached its limit (see above), and takes rounding out
 * of their velocities in y. Sets slip, holds, force and allowance. */
int tribo_stick_slip_decide(struct stick_slip *m, tribo_system *sys, double t, double *y);

/* stick_slip_instant.c: a decision begins at time t, with the base there. Limits, and with them which contacts are open, are
 * brought up to that time. Then whoever has no velocity, or none in the direction of its slip any more, is at rest; a status. */
void tribo_stick_slip_begin_decision(struct stick_slip *m, tribo_system *sys, double t, double *y);
void tribo_stick_slip_update_limits(struct stick_slip *m, const tribo_system *sys, const double *y);
int tribo_stick_slip_find_resting(struct stick_slip *m, const tribo_system *sys, double *y);

/* Forces at rest that are not unique go on from those found last, but for this. */
void tribo_stick_slip_forget_shares(struct stick_slip *m);

/* How large b, its rate, and accelerations by loads ever are, and how far decisions look ahead. */
void tribo_stick_slip_find_scales(struct stick_slip *m, const tribo_system *sys);

/* What accelerations of contacts may be rounding, and how far forces may go: forgotten, and found anew of one contact, or all. */
void tribo_stick_slip_forget_gains(struct stick_slip *m);
void tribo_stick_slip_find_gain(struct stick_slip *m, const tribo_system *sys, const double *y, size_t i);
void tribo_stick_slip_find_gains(struct stick_slip *m, const tribo_system *sys, const double *y);

/* How large the parts of q'' are, at most. */
double tribo_stick_slip_acceleration_size(struct stick_slip *m, const tribo_system *sys, const double *y);

/* Whether contact i moves by less than rounding of what its accelerations make of it: several contacts that hold a body together
 * leave so much. */
int tribo_stick_slip_is_faint(struct stick_slip *m, const tribo_system *sys, const double *y, size_t i);

/* The free motion at (t, y): m->free, and m->a. */
void tribo_stick_slip_find_free(struct stick_slip *m, tribo_system *sys, double t, const double *y);

/* q'' [ndof] with the forces found, also after a decision; its rate while the forces of contacts at rest are what they are; and
 * to [ncontact] = J acceleration - order-th derivative of b. */
const double *tribo_stick_slip_find_acceleration(struct stick_slip *m, const tribo_system *sys);
void tribo_stick_slip_find_rate(struct stick_slip *m, const tribo_system *sys, const double *y);
void tribo_stick_slip_contact_accelerations(const tribo_system *sys, const double *acceleration, int order, double *to);

/* Whether contact i is at rest by a force that is to be found; that of elastic ones is known. */
static inline int tribo_stick_slip_searches(const struct stick_slip *m, size_t i)
{
    return m->slip[i] == TRIBO_SLIP_STUCK && !m->elastic[i];
}

/* A force this close to the limit might be taken beyond it by rounding, or, by what other contacts do, in a moment. */
#define TRIBO_CLOSE 0.1

/* Whether contact i is the only one whose force was searched for, of those that it is coupled with. */
static inline int tribo_stick_slip_alone(const struct stick_slip *m, size_t i)
{
    return m->uncoupled || m->only == i;
}

/* stick_slip_forces.c, of the contacts that are asked about: f [ncontact] = the forces within lo and hi, where accelerations
 * without them are a; the forces, with contacts at rest as they are marked, and who is close to its limit by them; both return a
 * status. v [ncontact] = a + R f, the accelerations that forces f leave; v may be a. */
int tribo_stick_slip_solve(struct stick_slip *m, const tribo_system *sys, const double *a, double *f);
int tribo_stick_slip_find_forces(struct stick_slip *m, tribo_system *sys);
void tribo_stick_slip_accelerate(struct stick_slip *m, const tribo_system *sys, const double *a, const double *f, double *v);

/* Contact i, which cannot hold, slides; but if it held by a static limit, it is decided about once more by the other one. */
static inline void tribo_stick_slip_let_go(struct stick_slip *m, size_t i, signed char direction)
{
    const int again = m->breakaway.some && tribo_breakaway_lets_go(&m->breakaway, i);
    tribo_stick_slip_set(m, i, again ? TRIBO_SLIP_STUCK : direction);
    m->tied[i] = 0;
    m->again |= again;
}

/* Whether contact i would lose a static limit, and the forces at rest are not unique. */
static inline int tribo_stick_slip_must_be_sure(const struct stick_slip *m, size_t i)
{
    return m->dependents && tribo_breakaway_is_sudden(&m->breakaway, i);
}

/* stick_slip_relieve.c: where a contact must be sure, or accelerations are nothing but rounding, the forces tell that it takes to
 * hold all that are at rest: these are the forces, or contacts are let go; a status. */
int tribo_stick_slip_relieve(struct stick_slip *m, tribo_system *sys, size_t *changes);

/* stick_slip_elastic.c: elastic contacts, whose forces the state knows. The first finds these, and what of them may be rounding:
 * spring, slack. For the decision, in this order: velocities that they would slide with; forces, slip, and places without mass;
 * velocities of those that hold; what the next decision remembers. The start takes what is beyond limits out of y, and dissipates
 * it. */
void tribo_elastic_find(struct stick_slip *m, const tribo_system *sys, const double *y);
void tribo_elastic_start(struct stick_slip *m, const tribo_system *sys, double *y);
void tribo_elastic_release(const tribo_system *sys, double *y);
void tribo_elastic_place(struct stick_slip *m, const tribo_system *sys, double *y);
void tribo_elastic_hold(struct stick_slip *m, const tribo_system *sys, double *y);
void tribo_elastic_finish(struct stick_slip *m, const tribo_system *sys);

/* holds.c: finds out which of the contacts at rest hold, as they are marked; a status. */
int tribo_stick_slip_find_holds(struct stick_slip *m, const tribo_system *sys);

/* Whether nothing is left to find out of that. */
static inline int tribo_stick_slip_knows_holds(const struct stick_slip *m)
{
    return m->independent && !m->fresh;
}

/* stick_slip_instant.c: q'' [ndof] in a state, and all forces [ncontact], while contacts do what they did when last decided
 * about. Returns a status. */
int tribo_stick_slip_acceleration(struct stick_slip *m, tribo_system *sys, double t, const double *y, double *acceleration,
                                  double *force);

/* The force by which contact i, coupled with no other one, holds; 0 if it does not. */
static inline double tribo_stick_slip_balance_alone(const struct stick_slip *m, size_t i, double a)
{
    return m->loose[i] ? 0.0 : -a / m->diagonal[i];
}

/* holds.c: f of the contacts that hold, R_II f_I = -a_I; zero for the others. */
int tribo_stick_slip_balance(struct stick_slip *m, const double *a, double *f);

/* holds.c: makes J x = base for the contacts that hold by impulses of theirs. Returns a status. */
int tribo_stick_slip_project(struct stick_slip *m, const tribo_system *sys, const double *base, double *x);

/* The same where J x - base is rounding: takes that out of x [ndof]. Returns a status. */
int tribo_stick_slip_hold(struct stick_slip *m, const tribo_system *sys, const double *base, double *x);

/* What takes the last bits out of the contacts that hold. */
void tribo_stick_slip_list_snaps(struct stick_slip *m, const tribo_system *sys);

/* How many times its limit to slide the force of contact i is from here on: +1 or -1, at rest these times the ratio of static
 * limits, or 0 if it does not follow it. */
double tribo_stick_slip_follows(const struct stick_slip *m, size_t i);

/* 1 if contact i rests by itself on a base that moves: then its velocity has to be looked after. */
static inline int tribo_stick_slip_may_part(const struct stick_slip *m, size_t i)
{
    return m->base_moves && m->slip[i] == TRIBO_SLIP_STUCK && !m->holds[i];
}

/* By how much more than its limit contact i may be pulled and hold: where it would let go of much, what may be rounding does not
 * count. */
double tribo_stick_slip_slack(const struct stick_slip *m, size_t i);

/* Velocities are known to this part of what they are the sum of. */
#define TRIBO_VELOCITY_NOISE 2e-14

/* What of the velocity of contact i may be rounding, where the sizes of its terms come to this. */
static inline double tribo_stick_slip_velocity_noise(const struct stick_slip *m, size_t i, double size)
{
    return TRIBO_VELOCITY_NOISE * greater(m->base_size[i] + size, m->seen[i]);
}

/* v_i in a state, at the time that was last decided for; and the same, with its noise found. */
static inline double tribo_stick_slip_velocity(const struct stick_slip *m, const tribo_system *sys, size_t i, const double *y)
{
    const struct matrix *j = &sys->direction;
    const double *u = y + sys->ndof;
    double v = -m->base[i];
    for (size_t k = j->first[i], end = j->first[i + 1]; k < end; k++) {
        v += j->val[k] * u[j->col[k]];
    }
    return v;
}

static inline double tribo_stick_slip_find_velocity(struct stick_slip *m, const tribo_system *sys, size_t i, const double *y)
{
    const struct matrix *j = &sys->direction;
    const double *u = y + sys->ndof;
    double v = -m->base[i], size = 0.0;
    for (size_t k = j->first[i], end = j->first[i + 1]; k < end; k++) {
        const double part = j->val[k] * u[j->col[k]];
        v += part;
        size += fabs(part);
    }
    m->noise[i] = tribo_stick_slip_velocity_noise(m, i, size);
    return v;
}

#endif
