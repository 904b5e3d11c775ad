/* SPDX-License-Identifier: BSD-3-Clause */
/* A mechanical system with friction, with accelerations solved for:
 *     q'' = load(t) - AK q - AC q' + B f,   v = J q' + G f' - b(t),   AK = M^-1 K, AC = M^-1 C, B = M^-1 J'.
 * `response` holds the columns of B of rigid contacts, compliance.pull the columns of compliant contacts. */
#ifndef TRIBO_SYSTEM_H
#define TRIBO_SYSTEM_H

#include "tribo/tribo_dynamics.h"

#include "numerics/linalg.h"
#include "compliance.h"
#include "normals.h"
#include "common/text.h"

/* The function of time to which a harmonic or table adds: load, base velocity b(t), or limits. */
enum drives { DRIVES_LOAD, DRIVES_BASE, DRIVES_LIMIT };

/* A function of time: cosine[e] cos(omega t) + sine[e] sin(omega t) is added to element index[e]. Or, if it has knots, a table,
 * linear between knots, constant outside: cosine[e] value(t) is added; a table of limits has a column for each contact, and
 * stands in the place of given_limit. */
struct harmonic {
    enum drives drives;
    int by_load;               /* 1: base motion that a load causes (tribo_system_add_load), removed with the loads */
    double omega;              /* tables: 0 */
    double cos_t, sin_t;       /* cos(omega t), sin(omega t) at the set time t; of a table, cos_t: value of column 0 */
    size_t knots, columns, at; /* at: last knot at or before the set time, or 0; knots, columns 0: a harmonic */
    size_t count;              /* entries: limits have all contacts; else those with cosine or sine not 0 */
    size_t *index;             /* [count] degree of freedom, or contact */
    double *cosine, *sine;     /* [count] accelerations, velocities or limits; tables: 1 for limits; 0 */
    double *knot, *value;      /* [knots] times, [knots][columns] */
};

/* Error bound of a reduced system at omega: missing x^order/(1 - x), x = omega^2/above. Left-out modes have omega^2 >= above, and
 * at most the part `missing` of the work of steady contact forces on the elastic structure. */
struct truncation {
    double above, missing;
    double order; /* 0, 1, 2 with TRIBO_STATICS_NONE, _COMPLIANCE, _MASS: the static displacements included reduce the error */
};

/* The caller's x: with k = place[d], x_d = q_k if k < ndof, else w_(k - ndof), without mass, w = follow q + give f. */
struct expansion {
    size_t dofs, sliders;       /* sliders: the last of dofs; the caller's state has no velocities of sliders */
    size_t *place;              /* [dofs]; NULL: x = q, dofs = ndof, and all other members are empty */
    struct matrix follow, give; /* [dofs - ndof][ndof], [dofs - ndof][ncontact] */
    struct matrix touch;        /* [ncontact][dofs - ndof] J_w: f = G^-1 J_w (w - follow q) */
    double *terms;              /* [ndof] sum of the sizes of the terms of K_ii; NULL if reduced */
};

/* The functions of time, and the time that is set. */
struct loads {
    size_t harmonics;          /* number of functions */
    struct harmonic *harmonic; /* [harmonics] */
    size_t bases, limits;      /* numbers of functions of b(t); of limits */
    size_t tables;             /* number of tables */
    size_t limit_tables;       /* number of tables of limits, at most 1 */
    double *given_limit;       /* [ncontact] limits set by the caller, without harmonics and motion */
    double time;               /* the set time; NaN: none, the next one is computed anew */
    double low;                /* the part of time below its last digit (tribo_system_set_low) */
};

/* A reduced system. The modes convert loads to accelerations. */
struct reduction {
    double *modes; /* [given][dofs]; NULL if not reduced */
    struct truncation truncation;
    size_t given; /* length of the caller's loads; of accelerations, if not reduced */
};

/* A correction of the velocity of one contact: x[to] = (base[contact] - other x[from])/value. If other = 0, x[from] is not
 * read. */
struct snap {
    size_t contact, to, from;
    double value, other;
};

struct snaps {
    int in_order;      /* 1: any set of resting contacts can be corrected in the order of contacts */
    size_t count;      /* corrections in list: of all rigid contacts if in_order, else of the last tribo_system_snap */
    struct snap *list; /* [ncontact] */
};

/* Workspace. */
struct workspace {
    double *v, *a, *f, *feq, *dv_dt; /* [ncontact] */
    double *put_limit;               /* [ncontact] limits at the set time */
    double *acceleration;            /* [ndof] */
    double *motion;                  /* [tribo_system_size + dofs - ndof + 2 ncontact]; NULL without an expansion */
};

/* copied: TRIBO_COUNT_SETTINGS of the context that is lent, at the last copy; changes: number of copies. */
struct settings {
    size_t copied, changes;
};

struct tribo_system {
    size_t ndof, ncontact;                                 /* ndof: number of degrees of freedom with mass */
    struct matrix stiffness, damping, direction, response; /* AK, AC, J, B */
    tribo_context *contacts; /* computes forces, with the settings of `lent` and the limits at the set time */
    tribo_context *lent;     /* the caller's context of tribo_system_context; NULL before the first call */
    struct settings settings;
    char *message; /* [TRIBO_MESSAGE] also written for a const system */
    struct loads loads;
    size_t revision, structure; /* number of changes of loads, tables and damping; of damping */

    struct matrix mass, k, c; /* M, K, C; of reduced systems, M = 1 */
    double circulation;       /* bound of |M^-1 (K - K')/2|; 0: K is symmetric */
    struct cholesky factor;   /* Cholesky factor of M, if accelerations are solved for */

    /* 1: accelerations are not solved for, M q'' = load - K q - C q' + J' f: stiffness and damping have no rows, response is J',
     * and loads are forces. */
    int unsolved;

    struct compliance compliance;
    struct normals normals;
    struct expansion expansion;
    struct reduction reduced;
    struct attached *attached; /* list of the data of tribo_system_attach */
    size_t evaluations, jacobians;
    int status;    /* status of the last evaluation */
    double *tally; /* [ncontact] weight of f_i v_i in the energy of y: 1; 4/3 at a chain's last contact */
    struct snaps snaps;
    struct workspace work;
};

/* Return the normal at row i of J, or NULL; the follower at contact i, or NULL. */
static inline const struct normal *tribo_normals_at(const tribo_system *sys, size_t i)
{
    const struct normals *s = &sys->normals;
    return s->count && s->at[i] ? &s->normal[s->at[i] - 1] : NULL;
}

static inline const struct follower *tribo_normals_follower(const tribo_system *sys, size_t i)
{
    const struct normals *s = &sys->normals;
    return s->count && s->by[i] ? &s->follower[s->by[i] - 1] : NULL;
}

/* Creates a system. The caller then sets contacts, M, K and J, and C and AC if there is damping: rows = 0 means no damping.
 * Returns a status. */
int tribo_system_build(tribo_system **sys, size_t ndof, size_t ncontact);

/* Takes C and AC = M^-1 C in the place of those of sys. */
void tribo_system_put_damping(tribo_system *sys, const struct matrix *c, const struct matrix *rates);

enum { TRIBO_MESSAGE = 240 };

/* Copies the settings of sys->lent to sys->contacts if they have changed. Call at the start of public functions. Returns a
 * status. */
int tribo_system_take_settings(tribo_system *sys);

/* Returns the number of the caller's changes of loads, tables, damping, and of settings (as copied to the contacts). */
size_t tribo_system_revision(const tribo_system *sys);

/* Returns status, of a call on sys->contacts. After an error copies the message of the contacts to the system. */
int tribo_system_explain(const tribo_system *sys, int status);

/* Returns the number of planar contacts. */
size_t tribo_system_planar(const tribo_system *sys);

/* Returns the first contact with a static limit above its limit, falls = 1: that falls with speed; ncontact if there is none.
 * tribo_system_falls returns 1 if a limit falls with speed. */
size_t tribo_system_first_dropping(const tribo_system *sys, int falls);
int tribo_system_falls(const tribo_system *sys);

/* Returns 1 if all contacts are scalar and none has a static limit above its limit. */
int tribo_system_is_plain(const tribo_system *sys);

/* limit [ncontact] = limits at rest, at the set time. */
void tribo_system_rest_limits(const tribo_system *sys, double *limit);

/* ---- loads.c */

void tribo_loads_free(tribo_system *sys);

/* Copies loads, base motions and tables from `from` to sys, which has none. Returns 1, or 0 if out of memory. */
int tribo_loads_copy(tribo_system *sys, const tribo_system *from);

/* Copies harmonics as tribo_loads_copy to sys, which has the first degrees of freedom and contacts of `from` only, and leaves out
 * the others. Returns 1, or 0 if out of memory. */
int tribo_loads_copy_first(tribo_system *sys, const tribo_system *from);

/* Leaves of all harmonics those of omega = 0. */
void tribo_loads_keep_constant(tribo_system *sys);

/* Sets the harmonics of sys, a clone of `like`, to those of `like` with amplitudes times size[drives], of loads and bases that
 * change in time also times swing, and frequencies times pace; these bases keep their displacements. */
void tribo_loads_scale(tribo_system *sys, const tribo_system *like, const double *size, double swing, double pace);

/* Sets time t. If limits vary, sets the limits of the contacts at t. turn_to: also where t is the set time. */
void tribo_system_turn_to(tribo_system *sys, double t);

static inline void tribo_system_set_time(tribo_system *sys, double t)
{
    if (t != sys->loads.time) {
        tribo_system_turn_to(sys, t);
    }
}

/* Sets the part of the time below its last digit: all times t mean t + low. An event can lie between two adjacent doubles t. */
void tribo_system_set_low(tribo_system *sys, double low);

/* to += factor times the order-th derivative, at the set time, of the accelerations by the load [ndof], of b(t) [ncontact], or of
 * what the limits [ncontact] have beside given_limit. */
void tribo_system_loads(const tribo_system *sys, enum drives drives, int order, double factor, double *to);

/* Returns 1 if a base moves. */
static inline int tribo_system_bases_move(const tribo_system *sys)
{
    return sys->loads.bases > 0;
}

/* 1 if a function of time moves the limits of contacts i and j differently; i = j: if one moves that limit. */
int tribo_system_varies_limit(const tribo_system *sys, size_t i, size_t j);

/* pair [ncontact] = PAIR_FIRST and PAIR_SECOND at the directions of planar contacts, found by a balance in which all contacts
 * slide; else PAIR_NONE. Returns a status, its message on the system. */
enum { PAIR_NONE, PAIR_FIRST, PAIR_SECOND };
int tribo_system_find_pairs(const tribo_system *sys, unsigned char *pair);

/* Returns 1 if limits change, by a table or harmonics, or with the motion. */
static inline int tribo_system_limits_vary(const tribo_system *sys)
{
    return sys->loads.limits > 0 || sys->normals.count > 0;
}

/* Returns the part of limit i that does not vary: 0 with a table. */
static inline double tribo_system_steady_limit(const tribo_system *sys, size_t i)
{
    return sys->loads.limit_tables ? 0.0 : sys->loads.given_limit[i];
}

/* limit, rate [ncontact] = limits and derivatives at the set time, and motion (tribo_normals_move). With harmonics, and where
 * limits follow the motion, limit < 0 where a contact has lifted off. */
void tribo_system_limits(const tribo_system *sys, double *limit, double *rate);

/* Sets the limits of the contacts to limit + later rate at the set time, at least 0. */
void tribo_system_put_limits(tribo_system *sys, double later);

/* Returns the sum of the amplitudes of the harmonics of limit i, a bound of their change; 0 without harmonics. */
double tribo_system_swing(const tribo_system *sys, size_t i);

/* most [ncontact] = upper bounds of the limits over all times. */
void tribo_system_most_limits(const tribo_system *sys, double *most);

/* Rounding error of a limit, relative to the sum of the sizes of its terms. */
#define TRIBO_LIMIT_NOISE 4e-14

/* Returns 1 if the limit of contact i is positive just after the set time: the lowest derivative (order 0 to 8) larger than
 * TRIBO_LIMIT_NOISE doubt times its terms is positive. */
int tribo_system_presses(const tribo_system *sys, size_t i, double doubt);

/* Returns the largest |omega| of harmonics. */
double tribo_system_load_frequency(const tribo_system *sys);

/* Returns the value of column i of table k at the set time; *slope = its rate from there on. */
double tribo_system_table(const tribo_system *sys, size_t k, size_t i, double *slope);

/* Returns the next time after t of a kink of a load or limit; HUGE_VAL if there is none. */
double tribo_system_next_kink(const tribo_system *sys, double t);

/* ---- system.c */

/* Returns a bound of all frequencies: of |exponents| of the structure, with any contacts held, and of loads. */
double tribo_system_fastest(const tribo_system *sys);

/* Returns R_ij. */
double tribo_system_delassus(const tribo_system *sys, size_t i, size_t j);

/* way [ncontact][columns] = J q + G f of perturbations v [tribo_system_energy][columns]; f [ncontact][columns] = their forces. */
void tribo_system_find_ways(const tribo_system *sys, size_t columns, const double *v, double *f, double *way);

/* f [ncontact][columns] += forces of the springs of contacts at rest, slip 0, by which J q + G f takes the values that `stretch`
 * [ncontact][columns] has less J q; f in: forces of the contacts that slide. Overwrites stretch. */
void tribo_springs_hold(const tribo_system *sys, const signed char *slip, size_t columns, double *stretch, double *f);

/* y [tribo_system_size] = the state q [ndof], q' = 0, with the forces f [ncontact] and energy 0. */
void tribo_system_put_steady(const tribo_system *sys, const double *q, const double *f, double *y);

/* to [ndof] = scale times the order-th derivative of the load at the set time, - AK q - AC u + M^-1 J' f over the compliant
 * contacts, and the forces of pressed normals, of which the gap counts in order 0; f [ncontact]. u is not read without damping, f
 * not without compliant contacts. */
void tribo_system_smooth(const tribo_system *sys, int order, double scale, const double *q, const double *u, const double *f,
                         double *to);

/* acceleration [ndof] = q'' without the forces of rigid contacts, at t and y. */
void tribo_system_free_acceleration(tribo_system *sys, double t, const double *y, double *acceleration);

/* Sets the motion y of the normals. acceleration [ndof] = q'' without the forces of rigid contacts; v, a [ncontact] = J q' - b
 * and J q'' - b'. */
void tribo_system_free_motion(tribo_system *sys, double t, const double *y, double *acceleration, double *v, double *a);

/* acceleration [ndof] = q'' with friction; power = power dissipated by friction. accepted = 1: (t, y) is an accepted state,
 * which updates the memory of the reversal law. Returns a status. */
int tribo_system_rates(tribo_system *sys, double t, const double *y, int accepted, double *acceleration, double *power);

/* x [ndof] = M^-1 x; unchanged in unsolved systems. */
void tribo_system_solve_mass(const tribo_system *sys, double *x);

/* to [ndof] = M^-1 force [given]; way [ncontact] += displacements of compliant contacts by forces on w. */
void tribo_system_accelerate(const tribo_system *sys, const double *force, double *to, double *way);

/* ---- snap.c */

/* Removes the rounding error from J_i x = base_i for contacts with loose 0 and a row J_i of one entry, or of two of equal size.
 * Overwrites sys->work.acceleration. */
void tribo_system_snap(tribo_system *sys, const signed char *loose, const double *base, double *x);

/* Sets snaps.in_order, and the corrections of all rigid contacts. Call before the other functions. */
void tribo_system_order_snaps(tribo_system *sys);

/* Applies those of count corrections that are of contacts with loose 0. */
static inline void tribo_snap_all(const struct snap *list, size_t count, const signed char *loose, const double *base, double *x)
{
    for (size_t k = 0; k < count; k++) {
        const struct snap *s = list + k;
        if (!loose[s->contact]) {
            x[s->to] = (base[s->contact] - (s->other != 0.0 ? s->other * x[s->from] : 0.0)) / s->value;
        }
    }
}

/* list [ncontact] = corrections of tribo_system_snap in their order; no correction undoes another. Returns their number. */
size_t tribo_system_list_snaps(const tribo_system *sys, const signed char *loose, struct snap *list);

/* Writes message [TRIBO_MESSAGE] of a model, system or driver, unless it is NULL, and returns status. */
int tribo_error(char *message, int status, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* What a number must be, beside finite. */
enum range { FINITE, NOT_NEGATIVE, POSITIVE };

/* Returns TRIBO_OK if x is finite and in range; else TRIBO_ERR_NOT_FINITE, _NEGATIVE or _NOT_POSITIVE. The message is the subject,
 * formatted, and "is not finite", "is negative" or "is not positive". */
int tribo_check_number(char *message, enum range range, double x, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 4, 5)))
#endif
    ;

/* Returns TRIBO_OK if all x [n] are finite and in range, or x is NULL, else an error with the name of x. */
int tribo_check_array(char *message, enum range range, const char *name, const double *x, size_t n);

/* Returns TRIBO_OK if the numbers x [n] and their sum are finite; else TRIBO_ERR_NOT_FINITE, with the name of the first number
 * that is not, or of the largest. */
int tribo_check_numbers(char *message, size_t n, const char *const *name, const double *x);

/* Returns TRIBO_OK if all degrees of freedom have mass; else TRIBO_ERR_UNSUPPORTED, with a message that names `who`. */
int tribo_system_check_mass(const tribo_system *sys, const char *who);

/* Returns TRIBO_OK, or TRIBO_ERR_UNSUPPORTED for an unsolved system, with a message that names `what`. */
int tribo_system_check_solved(const tribo_system *sys, const char *what);

/* Begins a call that computes rates of states: takes the settings, makes both checks, and refuses y or `to`, called name, NULL.
 * Sets sys->status, and returns it. */
int tribo_system_begin_rates(tribo_system *sys, const char *what, const double *y, const char *name, const double *to);

/* Returns TRIBO_ERR_UNSUPPORTED for planar contacts if scalar = 1, or scalar = 0 and the system has massless degrees of freedom,
 * and for static limits of elastic contacts. */
int tribo_system_check_contacts(const tribo_system *sys, const char *method, int scalar);

/* Returns TRIBO_OK if neither sys nor its argument of this name is NULL, else TRIBO_ERR_NULL. */
int tribo_system_check_given(const tribo_system *sys, const void *argument, const char *name);

/* Returns TRIBO_OK if t and the caller's state y are finite, else an error. */
int tribo_system_check_state(const tribo_system *sys, double t, const double *y);

/* ---- state.c. The caller's state y: x and x' without sliders, displacements of sliders, energy. The methods' state: q, q', f of
 * compliant contacts, energy. */

/* Returns the index of the energy in the methods' state; a perturbation has as many values. */
static inline size_t tribo_system_energy(const tribo_system *sys)
{
    return 2 * sys->ndof + sys->compliance.count;
}

static inline size_t tribo_system_size(const tribo_system *sys)
{
    return tribo_system_energy(sys) + 1;
}

/* Takes x as the expansion of a system that has its compliance, and appends a displacement w for each contact i with slides[i]
 * > 0 (NULL: none): with row i of J in follow, row i of G in give. x->place has room for these. Returns 1, or 0 if out of
 * memory. */
int tribo_expansion_create(tribo_system *sys, struct expansion *x, const double *slides);
int tribo_expansion_copy(tribo_system *to, const tribo_system *from);
void tribo_expansion_free(struct expansion *x);

/* With an expansion, read: to [tribo_system_size] = y; write: sets time t, and y [tribo_system_dimension] = from. */
void tribo_system_read_state(const tribo_system *sys, const double *y, double *to);
void tribo_system_write_state(tribo_system *sys, double t, const double *from, double *y);

/* v [ncontact] += J_w (w' - follow q') of the caller's state y. Call after tribo_system_read_state for y. */
void tribo_system_add_velocities(const tribo_system *sys, const double *y, double *v);

/* For x_d = q_k adds part to q[k]; for x_d = w_k row k of follow and give, times part, to q [ndof] and f [ncontact]. */
void tribo_system_add_part(const tribo_system *sys, size_t d, double part, double *q, double *f);

/* to [2 ndof + 2 count] = coefficients of q, q', f, f' in the combination c [2 tribo_system_ndof] of x, x'. */
void tribo_system_read_combination(const tribo_system *sys, const double *c, double *to);

#endif
