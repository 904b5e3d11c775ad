/* A mechanical system with friction as the drivers see it: accelerations solved for,
 *     q'' = load(t) - AK q - AC q' + B f,   v = J q' + G f' - b(t),   AK = M^-1 K, AC = M^-1 C, B = M^-1 J',
 * where response has the columns of B of rigid contacts, and compliance.pull those of compliant ones. */
#ifndef TRIBO_SYSTEM_H
#define TRIBO_SYSTEM_H

#include "tribo/tribo_dynamics.h"

#include "numerics/linalg.h"
#include "compliance.h"
#include "common/plural.h"

/* What a harmonic adds to: the load, b(t) of the contacts, or their limits. */
enum drives { DRIVES_LOAD, DRIVES_BASE, DRIVES_LIMIT };

/* cosine cos(omega t) + sine sin(omega t) at the entries index. */
struct harmonic {
    double omega;
    double time, cos_t, sin_t; /* cos(omega time), sin(omega time); time NaN: not known */
    size_t turns;              /* successive values of cos_t, sin_t that tribo_harmonic_take set */
    enum drives drives;
    int by_load;           /* 1: a motion of the base that belongs to a load, see tribo_system_add_load */
    size_t count;          /* entries: those with cosine or sine not 0; of limits all */
    size_t *index;         /* [count] degree of freedom, or contact */
    double *cosine, *sine; /* [count] */
};

/* A function of time, linear between knots and constant outside: times pattern it adds to the load or to b(t), or, with a row of
 * limits to each knot, it is the limits of the contacts. */
struct table {
    enum drives drives;
    size_t knots, at; /* at: the knot at or before sys->time */
    double *time;
    double *value;   /* [knots], or [knots][ncontact] */
    double *pattern; /* [ndof] accelerations, [ncontact] velocities, or NULL */
};

/* What a reduced system does not have of the whole structure's motion. Modes left out have omega^2 + shift of `above` or more;
 * of the work that steady forces at the contacts do on the elastic structure they take up to the part `missing`. */
struct truncation {
    double above, shift, missing;
    double order; /* but only this power of omega^2/above of it, as the displacements by steady forces are there */
};

/* A caller's degrees of freedom: x_d = q_k for k = place[d] < ndof, else w_(k - ndof), without mass, w = follow q + give f. */
struct expansion {
    size_t dofs, sliders; /* sliders: the last of dofs; a caller's state has no velocities of them */
    size_t *place;        /* [dofs]; NULL: x = q, and all other members are empty */
    struct matrix follow, give; /* [dofs - ndof][ndof], [dofs - ndof][ncontact] */
    struct matrix touch;        /* [ncontact][dofs - ndof] J_w: forces are f = G^-1 J_w (w - follow q) */
    double *terms;              /* [ndof] sizes of the terms of which K_ii is the sum; NULL if reduced */
};

struct tribo_system {
    size_t ndof, ncontact; /* ndof: degrees of freedom with mass */
    struct matrix stiffness, damping, direction, response; /* AK, AC, J, B */
    tribo_context *contacts; /* finds the forces; its settings are those of lent, its limits those of the time set */
    tribo_context *lent;     /* what tribo_system_context gives the caller to set; NULL: nothing is lent yet */
    size_t copied, changes;  /* count of settings of lent when they were copied last; how often they were */
    char *message;           /* [TRIBO_MESSAGE] a const system keeps it, too */

    size_t harmonics, base_harmonics, limit_harmonics; /* the latter are those of b(t) and of limits */
    struct harmonic *harmonic;
    size_t tables, base_tables; /* the latter are those of b(t) */
    struct table *table;
    struct table limits;         /* knots 0: the limits are those that the caller set, and harmonics on top */
    double *given_limit;         /* [ncontact] while limits vary: those that the caller set */
    double *put_limit;           /* [ncontact] workspace: limits of the time set */
    size_t revision, structure;  /* count changes of loads, tables and damping; of damping */
    double time, low;            /* that is set (NaN: none yet), and what rounding left of it (below) */

    /* K and C, where the mass matrix is not diagonal: M^-1 K has lost the low modes to rounding. Else no rows: M AK and M AC are
     * K and C to rounding of every entry. */
    struct matrix k, c;

    /* 1: the equations are M q'' = load - K q - C q' + J' f: stiffness, damping and response are K, C and J', loads are forces; no
     * accelerations are solved for. */
    int unsolved;

    struct matrix mass;     /* no rows: the identity, of reduced systems */
    struct cholesky factor; /* of it */
    struct compliance compliance;
    struct expansion expansion;

    /* Forces on the given degrees of freedom become accelerations by the modes, or by the mass matrix. */
    size_t given;
    double *modes, *omega; /* [given][dofs], [dofs] of a caller's degrees of freedom; NULL if not reduced */
    struct truncation truncation;

    struct attached *attached; /* what tribo_system_attach has hung on the system */
    size_t evaluations, jacobians;
    int status;                      /* what the last evaluation returned */
    double *tally;                   /* [ncontact] how often y's energy counts what a contact dissipates: 1, but see chains */
    double *v, *a, *f, *feq, *dv_dt; /* [ncontact] workspace */
    double *acceleration;            /* [ndof] workspace */
    double *motion;                  /* [tribo_system_size] and more: workspace with an expansion, else NULL */
    int snaps_in_order;              /* contacts at rest, whichever they are, can be snapped one after the other */
    double *dense;                   /* workspace of the Jacobian, allocated when it is first asked for */
};

/* A system of ndof degrees of freedom whose matrices (which it takes, also on failure) and M = identity are these. damping may be
 * all zeros: no rows. */
int tribo_system_build(tribo_system **sys, size_t ndof, size_t ncontact, struct matrix *stiffness, struct matrix *damping,
                       struct matrix *direction, struct matrix *response);

enum { TRIBO_MESSAGE = 240 };

/* Copies the settings of the lent context, if there are others, to the contacts: to be called where a caller's call begins.
 * Returns a tribo status. */
int tribo_system_take_settings(tribo_system *sys);

/* Counts all changes that a caller can make: of loads, tables and damping, and of settings, as taken. */
size_t tribo_system_revision(const tribo_system *sys);

/* Counts changes of the contacts' settings, and of limits with time. */
size_t tribo_system_settings(const tribo_system *sys);

/* Status of a call on the contacts, which keeps its message on the system if it failed. */
int tribo_system_explain(const tribo_system *sys, int status);

/* How many planar contacts there are. */
size_t tribo_system_planar(const tribo_system *sys);

/* The first contact whose limit falls with the speed (a velocity of tribo_set_static), or ncontact; 1 if there is such a
 * contact. */
size_t tribo_system_first_falling(const tribo_system *sys);
int tribo_system_falls(const tribo_system *sys);

/* ---- loads.c */

void tribo_loads_free(tribo_system *sys);

/* The loads, motions and tables of from for sys, which has none; 1, or 0 if out of memory. */
int tribo_loads_copy(tribo_system *sys, const tribo_system *from);

/* Prepares the loads for time t, and sets the limits of the contacts if they vary. */
void tribo_system_set_time(tribo_system *sys, double t);

/* Forgets the time that is set, and cosines and sines of all harmonics. */
void tribo_system_forget_time(tribo_system *sys);

/* Sets cos_t and sin_t of h to those of the time set. */
void tribo_harmonic_turn(const tribo_system *sys, struct harmonic *h);

/* The same, if h->time is another time. Called before cos_t and sin_t are read. */
static inline void tribo_system_turn_to(const tribo_system *sys, struct harmonic *h)
{
    if (h->time != sys->time) {
        tribo_harmonic_turn(sys, h);
    }
}

static inline void tribo_system_turn(const tribo_system *sys, size_t k)
{
    tribo_system_turn_to(sys, &sys->harmonic[k]);
}

/* Sets cos_t and sin_t of a load to c and s, which a motion has found for the time set; at most 16 times in a row, since
 * each adds its rounding. */
void tribo_harmonic_take(const tribo_system *sys, struct harmonic *h, double c, double s);

/* From here on every time means t + low, at which events happen between two numbers t. */
void tribo_system_set_low(tribo_system *sys, double low);

/* Adds factor times the order-th derivative of b(t), of the accelerations that the load makes, or of what harmonics add to the
 * limits, to `to`, at the time set. */
void tribo_system_loads(const tribo_system *sys, enum drives drives, int order, double factor, double *to);

/* The part of the load's or b's that comes from tables, of the degrees of freedom or contacts from begin to end. */
void tribo_system_tables(const tribo_system *sys, enum drives drives, int order, double factor, size_t begin, size_t end,
                         double *to);

/* to [ncontact] += factor b(t), whatever time is set. */
void tribo_system_add_base_at(const tribo_system *sys, double t, double factor, double *to);

/* Whether bases move. */
static inline int tribo_system_bases_move(const tribo_system *sys)
{
    return sys->base_harmonics || sys->base_tables;
}

/* Whether limits change with time, by a table or harmonics. */
static inline int tribo_system_limits_vary(const tribo_system *sys)
{
    return sys->limits.knots || sys->limit_harmonics;
}

/* Whether setting time t would change nothing. */
static inline int tribo_system_is_at(const tribo_system *sys, double t)
{
    return t == sys->time && !tribo_system_limits_vary(sys);
}

/* limit, and its derivative, each [ncontact], at the time set. Harmonics take it below 0 where the contact has lifted off. */
void tribo_system_limits(const tribo_system *sys, double *limit, double *rate);

/* Sets the limits of the contacts to those of the time set, plus their rates times later. */
void tribo_system_put_limits(tribo_system *sys, double later);

/* By how much harmonics change the limit of contact i at most; 0 for one that they leave alone. */
double tribo_system_swing(const tribo_system *sys, size_t i);

/* The largest limits that contacts ever have, most [ncontact]. */
void tribo_system_most_limits(const tribo_system *sys, double *most);

/* Limits are known to this part of what they are the sum of. */
#define TRIBO_LIMIT_NOISE 4e-14

/* Whether contact i is pressed from the time set on, by the first derivative of its limit that is more than rounding, or more
 * than so many times that. */
int tribo_system_presses(const tribo_system *sys, size_t i, double doubt);

/* The next time after t at which a load or limit has a kink; HUGE_VAL if there is none. */
double tribo_system_next_kink(const tribo_system *sys, double t);

/* ---- system.c */

/* A bound on the frequencies: neither an exponent of the structure, held or not, nor a load is faster. */
double tribo_system_fastest(const tribo_system *sys);

/* R_ij. */
double tribo_system_delassus(const tribo_system *sys, size_t i, size_t j);

/* q'' without friction of rigid contacts, [ndof]. */
void tribo_system_free_acceleration(tribo_system *sys, double t, const double *y, double *acceleration);

/* acceleration [ndof] += that by the forces of compliant contacts in y. */
void tribo_system_add_springs(const tribo_system *sys, const double *y, double *acceleration);

/* q'' without friction, and v and a of the contacts. Outputs v, a [ncontact], acceleration [ndof]. */
void tribo_system_free_motion(tribo_system *sys, double t, const double *y, double *acceleration, double *v, double *a);

/* q'' with friction, [ndof], and the power that friction dissipates. Returns a tribo status. */
int tribo_system_rates(tribo_system *sys, double t, const double *y, double *acceleration, double *power);

/* The same, and dydt, with the reversal memory brought up to date first: (t, y) is an accepted state. Returns a tribo status. */
int tribo_system_begin_rates(tribo_system *sys, double t, const double *y, double *acceleration, double *power);
int tribo_system_begin_step(tribo_system *sys, double t, const double *y, double *dydt);

/* to [ndof] += factor M x. */
void tribo_system_add_mass(const tribo_system *sys, double factor, const double *x, double *to);

/* x [ndof] = M^-1 x; unsolved systems leave it. */
void tribo_system_solve_mass(const tribo_system *sys, double *x);

/* to [ndof] = M^-1 force, force [given]; way [ncontact] += displacements of compliant contacts by what acts on w. */
void tribo_system_accelerate(const tribo_system *sys, const double *force, double *to, double *way);

/* ---- snap.c */

/* Takes the last bits of rounding out of J_i x = base_i for contacts that are not loose (0), and have one degree of freedom or
 * the difference of two. Uses the workspace of accelerations. */
void tribo_system_snap(const tribo_system *sys, const signed char *loose, const double *base, double *x);

/* Sets snaps_in_order. To be called before tribo_system_snap and tribo_system_list_snaps. */
void tribo_system_order_snaps(tribo_system *sys);

/* What that does with a contact: x[to] = (base - other x[from])/value, where other may be 0, and x[from] anything. */
struct snap {
    size_t contact, to, from;
    double value, other;
};

static inline void tribo_snap(const struct snap *s, const double *base, double *x)
{
    const double moved = s->other != 0.0 ? s->other * x[s->from] : 0.0;
    x[s->to] = (base[s->contact] - moved) / s->value;
}

/* All that it does, in its order: none undoes another. list [ncontact] out; returns how many. */
size_t tribo_system_list_snaps(const tribo_system *sys, const signed char *loose, struct snap *list);

/* attached.c */
void tribo_system_detach(tribo_system *sys);

/* Keeps the message on the system and returns status. */
int tribo_system_fail(const tribo_system *sys, int status, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* TRIBO_ERR_UNSUPPORTED, and what it says: `who` takes only systems with mass everywhere. TRIBO_OK if this is one. */
int tribo_system_check_mass(const tribo_system *sys, const char *who);

/* TRIBO_ERR_UNSUPPORTED for an unsolved system, to which `what` cannot be done. */
int tribo_system_check_solved(const tribo_system *sys, const char *what);

/* Either of them: what makes rates of states takes neither kind. */
int tribo_system_check_rates(const tribo_system *sys, const char *what);

/* Checks that t and the caller's state y are finite. */
int tribo_system_check_state(const tribo_system *sys, double t, const double *y);

/* ---- state.c: a caller's state y = x, x' without those of sliders, displacements of sliders, energy; the state of the methods,
 * q, q', f of compliant contacts, energy. */

/* The index of the energy in the state of the methods: as many values have perturbations. */
static inline size_t tribo_system_energy(const tribo_system *sys)
{
    return 2 * sys->ndof + sys->compliance.count;
}

static inline size_t tribo_system_size(const tribo_system *sys)
{
    return tribo_system_energy(sys) + 1;
}

/* The expansion of a system that has its compliance; takes the matrices, copies terms [ndof] (NULL: reduced). 0 if out of memory. */
int tribo_expansion_create(tribo_system *sys, size_t sliders, const size_t *place, const double *terms, struct matrix *follow,
                           struct matrix *give, struct matrix *touch);
int tribo_expansion_copy(tribo_system *to, const tribo_system *from);
void tribo_expansion_free(struct expansion *x);

/* With an expansion: to [tribo_system_size] = y; y [tribo_system_dimension] = from, at time t. */
void tribo_system_read_state(const tribo_system *sys, const double *y, double *to);
void tribo_system_write_state(const tribo_system *sys, double t, const double *from, double *y);

/* v [ncontact] += J_w (w' - follow q') of the caller's state y, which was read last. */
void tribo_system_add_velocities(const tribo_system *sys, const double *y, double *v);

/* The index in a caller's state of value i of the methods' state; of a force that of a degree of freedom without mass. */
size_t tribo_system_state_index(const tribo_system *sys, size_t i);

/* to [2 ndof + 2 count], of q, q', f, f' = a combination c [2 tribo_system_ndof] of a caller's x, x'. */
void tribo_system_read_combination(const tribo_system *sys, const double *c, double *to);

#endif
