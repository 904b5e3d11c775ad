/* SPDX-License-Identifier: BSD-3-Clause */
/* tribo: dry friction in structural dynamics.
 *
 *     tribo_create(&c, n);                        n contacts
 *     tribo_set_limit(c, limit);                  mu times normal load; call again when the load changes
 *     tribo_set_operator_diagonal(c, r);          R, here of contacts that share no body: 1/mass
 *     tribo_set_epsilon_step(c, dt, 0.4);         how fast a contact comes to rest
 *     tribo_balance(c, v, a, NULL, f);            for each evaluation of accelerations; the bodies get J' f
 *
 * With small fixed steps tribo_step_force gives the force over a step, and needs no epsilon.
 *
 * Quantities. A contact has a relative velocity v = dz/dt and a friction force f along +z. The limit is mu times the normal load,
 * limit >= 0; a sliding contact has f = -limit * sgn(v). The matrix J of contact directions gives v = J u from the velocities u
 * of the bodies, and the forces J' f on the bodies: a contact with z = x_1 - x_2 puts f on body 1 and -f on body 2. Contact
 * accelerations are z'' = R f + a. R = J M^-1 J' is the Delassus operator, symmetric and positive semidefinite; a is the
 * relative acceleration without friction. f_eq is the friction force that makes z'' zero.
 *
 * Units. Any consistent set: forces in the unit of limit, velocities in the unit of epsilon, R in velocity per time and force.
 *
 * Arrays hold one double per contact, contiguous, unless stated otherwise; contacts are counted from 0. Outputs are the last
 * arguments, except a handle to create, which is the first. Outputs must not overlap inputs. On error outputs are unchanged,
 * except on TRIBO_ERR_INCONSISTENT, and where tribo_set_user_law says so. For an output marked "or NULL", NULL skips the
 * computation.
 *
 * Status. Every call that can fail returns TRIBO_OK (0) or one of TRIBO_ERR_...; tribo_message names the argument, the contact
 * and the value. No call prints, exits, aborts or keeps global state.
 *
 * Numbers. All finite values are accepted. Forces beyond 1e300, and inputs that make accelerations beyond 1e300, are cut to
 * 1e300. Below that, no call raises the floating-point exceptions invalid, divide-by-zero or overflow.
 *
 * Threads. Several threads may call functions of a const context on one context. For all other functions each thread needs a
 * context of its own (tribo_clone). With compilers other than GCC and Clang, only one thread at a time may clone a context,
 * change the operator of a clone, or destroy a clone. Only tribo_create, tribo_clone, tribo_copy_settings, tribo_set_planar and
 * tribo_set_operator_..., and at first tribo_update_operator, allocate memory.
 *
 * Source: D. D. Quinn, "A New Regularization of Coulomb Friction", J. Vib. Acoust. 126 (2004) 391-397,
 * doi:10.1115/1.1760564, "the paper" below. All functions: since 1.0, unless stated otherwise.
 */
#ifndef TRIBO_TRIBO_H
#define TRIBO_TRIBO_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TRIBO_VERSION_MAJOR 1
#define TRIBO_VERSION_MINOR 0
#define TRIBO_VERSION_PATCH 0
#define TRIBO_VERSION (10000 * TRIBO_VERSION_MAJOR + 100 * TRIBO_VERSION_MINOR + TRIBO_VERSION_PATCH)

#ifndef TRIBO_API
#if defined(__GNUC__)
#define TRIBO_API __attribute__((visibility("default")))
#else
#define TRIBO_API
#endif
#endif

/* Status codes. Numbers are never reused. */
enum {
    TRIBO_OK = 0,
    /* arguments */
    TRIBO_ERR_NULL = 1,         /* a required pointer is NULL */
    TRIBO_ERR_NOT_FINITE = 2,   /* NaN or infinity */
    TRIBO_ERR_NEGATIVE = 3,     /* a value must be >= 0 */
    TRIBO_ERR_NOT_POSITIVE = 4, /* a value must be > 0 */
    TRIBO_ERR_RANGE = 5,        /* an index or a choice is out of range */
    TRIBO_ERR_SIZE = 6,         /* sizes do not fit each other, or are too large */
    TRIBO_ERR_NAME = 7,         /* no law or method has this name */
    TRIBO_ERR_STATE = 8,        /* another call must come first */
    TRIBO_ERR_UNSUPPORTED = 9,  /* not available for this system, law or build */
    TRIBO_ERR_MEMORY = 10,
    /* operators and matrices */
    TRIBO_ERR_NOT_SYMMETRIC = 20,
    TRIBO_ERR_INDEFINITE = 21, /* not positive semidefinite, or a mass matrix that is not positive definite */
    TRIBO_ERR_DUPLICATE = 22,  /* an entry is given twice */
    /* solvers */
    TRIBO_ERR_INCONSISTENT = 40, /* partition coupling: no f_eq balances this a; the outputs hold the least-squares one */
    TRIBO_ERR_NO_CONVERGENCE = 41,
    /* drivers */
    TRIBO_ERR_STOPPED = 60,  /* the observer ended the run */
    TRIBO_ERR_STEP = 61,     /* the step size fell below what time resolves */
    TRIBO_ERR_CALLBACK = 62, /* a function of the caller failed */
    TRIBO_ERR_CHATTER = 63   /* too many events in too short a time: "central/fixed" and "moreau/fixed" step over them */
};

/* Version of the loaded library: 10000 major + 100 minor + patch. TRIBO_VERSION is the version of this header. */
TRIBO_API int tribo_version(void);
TRIBO_API const char *tribo_version_string(void);

/* Text for a status; any int is accepted. */
TRIBO_API const char *tribo_strerror(int status);

/* ---------------------------------------------------------------------------------------------------------- laws */

/* Friction laws.
 *   COULOMB           v != 0: -limit sgn v;  v = 0: clamp(f_eq, -limit, limit). The paper, Eq. 1 and 2.
 *   VELOCITY_LIMITED  clamp(-limit v/epsilon, -limit, limit). Martins and Oden (1987), the paper's Eq. 3.
 *   SMOOTH            -limit tanh(v/epsilon).
 *   KARNOPP           |v| <= epsilon: clamp(f_eq, -limit, limit), else -limit sgn v; the caller sets v = 0 where |v| <= epsilon.
 *   QUINN             clamp(clamp(f_eq, -limit, limit) - (2 limit/epsilon) v, -limit, limit). The paper, Eq. 4.
 *   QUINN_REVERSAL    Quinn's law, with a second-order form for contacts that pass v = 0 without sticking; the context
 *                     remembers these contacts, see tribo_accept. */
enum {
    TRIBO_COULOMB = 0,
    TRIBO_VELOCITY_LIMITED = 1,
    TRIBO_SMOOTH = 2,
    TRIBO_KARNOPP = 3,
    TRIBO_QUINN = 4,
    TRIBO_QUINN_REVERSAL = 5,
    TRIBO_USER_LAW = -1 /* a function of the caller, see tribo_set_user_law; for tribo_get_law only */
};

/* Number of laws; their numbers are 0 to tribo_law_count() - 1. */
TRIBO_API int tribo_law_count(void);

/* Name of a law ("coulomb", "velocity-limited", "smooth", "karnopp", "quinn", "quinn-reversal"), and the source of the law in the
 * literature. NULL if law is not a law's number. */
TRIBO_API const char *tribo_law_name(int law);
TRIBO_API const char *tribo_law_reference(int law);

/* Number of the law with this name, in upper or lower case. Returns TRIBO_ERR_NULL, TRIBO_ERR_NAME. */
TRIBO_API int tribo_law_find(const char *name, int *law);

/* One contact, no context: the force and its derivatives.
 * v         in   relative velocity
 * feq       in   balancing force; read only if |v| <= epsilon and the law depends on f_eq
 * limit     in   mu times normal load, >= 0
 * epsilon   in   velocity scale, > 0
 * f         out  friction force, |f| <= limit
 * df_dv, df_dfeq, df_dlimit   out, each or NULL; one-sided at a kink, df_dv = 0 at a jump
 * QUINN_REVERSAL: the force of a contact that slid before (marked, see tribo_accept).
 * Returns TRIBO_ERR_RANGE (law), TRIBO_ERR_NULL (f), TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_NOT_POSITIVE. */
TRIBO_API int tribo_law_eval(int law, double v, double feq, double limit, double epsilon, double *f, double *df_dv,
                             double *df_dfeq, double *df_dlimit);

/* n elastic contacts, no context: each a spring in series with a Coulomb slider (Jenkins, Masing).
 * Computes f = clamp(f - stiffness dz, -limit, limit) after a displacement dz; f is the whole state of a contact.
 * dz         [n] in      relative displacement since the last call: z = J x; the bodies get J' f
 * stiffness  [n] in      stiffness of the spring, >= 0
 * limit      [n] in      mu times normal load, >= 0
 * f          [n] in/out  friction force; 0 at the start
 * df_dz      [n] out, or NULL   -stiffness; 0 where the contact slides
 * Thread-safe. Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE (n), TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE (stiffness, limit). */
TRIBO_API int tribo_elastic_force(size_t n, const double *dz, const double *stiffness, const double *limit, double *f,
                                  double *df_dz);

/* The same in the plane, |f| <= limit: f = p, or limit p/|p| where |p| > limit, with p = f - stiffness dz.
 * dz, f [n][2]; stiffness, limit [n]; df_dz [n][2][2], symmetric. Returns what tribo_elastic_force returns. */
TRIBO_API int tribo_elastic_force_planar(size_t n, const double *dz, const double *stiffness, const double *limit, double *f,
                                         double *df_dz);

/* n contact elements, no context: two tangential springs that end in a slider, and a normal spring that lifts off (Yang and
 * Menq 1998).
 * Pressed, depth > 0: load = normal depth, limit = mu load, both at the end of the step, f = (f_t, -load) with f_t as in
 * tribo_elastic_force_planar. Open: f = 0. At touch-down the slider begins where the body was at the start of the step.
 * dz [n][2]            in      tangential displacement since f, the force of the last accepted state
 * depth [n]            in      penetration at the end of the step, positive presses
 * tangential, normal   [n] in  stiffness, >= 0
 * mu [n]               in      coefficient of friction, >= 0
 * f [n][3]             in/out  force: two tangential directions, normal direction; 0 to begin with
 * df [n][3][3]         out, or NULL   derivative of f by (dz, depth); where an element slides it is not symmetric
 * Bodies get J' f; the third row of J gives depth. Thread-safe. Returns what tribo_elastic_force returns. */
TRIBO_API int tribo_contact_force(size_t n, const double *dz, const double *depth, const double *tangential, const double *normal,
                                  const double *mu, double *f, double *df);

/* Friction laws with a state of their own, as elements without a context. Each is integrated in closed form over a step in which
 * the velocity is constant: n steps of dz/n give what one step of dz gives. The bodies get J' f. Numbers other than 0 must lie
 * between 1e-30 and 1e30 in size. Thread-safe.
 * dz      [n] in      relative displacement since the last call, z = J x
 * f       [n] out     friction force (of Dahl's law in/out: the force is the state)
 * df_dz   [n] out, or NULL   derivative of f by dz; at dz = 0 the mean of both sides
 * All return TRIBO_ERR_NULL, TRIBO_ERR_SIZE (n), TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_NOT_POSITIVE,
 * TRIBO_ERR_RANGE; on error outputs are unchanged. */

/* Dahl (1968): df/dz = -stiffness (1 + f sgn(dz)/limit). stiffness, limit [n] in, >= 0. */
TRIBO_API int tribo_dahl_force(size_t n, const double *dz, const double *stiffness, const double *limit, double *f,
                               double *df_dz);

/* LuGre (Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE Trans. Autom. Control 40 (1995) 419, doi:10.1109/9.376053):
 * f = -(s0 z + s1 z' + s2 v), z' = v - s0 |v| z/g, g = fc + (fs - fc) exp(-(v/vs)^2), v = dz/dt.
 * dt         in   length of the step, > 0
 * parameter  [n][6] in   s0 > 0, s1, s2, fc, fs >= 0, vs > 0
 * z          [n] in/out  deflection of the bristles, at most max(fc, fs)/s0 in size; 0 at the start */
TRIBO_API int tribo_lugre_force(size_t n, double dt, const double *dz, const double *parameter, double *z, double *f,
                                double *df_dz);

/* Bouc (1967), Wen (1976): f = -stiffness z, dz/dx = a - |z|^m (gamma + beta sgn(z dx)).
 * parameter  [n][5] in   stiffness >= 0, a > 0, beta >= 0, gamma >= -beta, m = 1 or 2
 * z          [n] in/out  state, at most (a/(beta + gamma))^(1/m) in size; 0 at the start */
TRIBO_API int tribo_bouc_wen_force(size_t n, const double *dz, const double *parameter, double *z, double *f, double *df_dz);

/* Iwan's parallel sliders in the four-parameter form of Segalman (J. Appl. Mech. 72 (2005) 752, doi:10.1115/1.1989354), with
 * Masing's rule for all turns of the motion.
 * room       in   turns that a state can hold: of loops that have not closed, two in a steady motion, one for each half cycle in
 *                 which a motion dies away; at most 1e6
 * parameter  [n][4] in   kt > 0 tangential stiffness, fs >= 0 limit, chi > -1, beta >= 0
 * state      [n][3 + 2 room] in/out   displacement from the middle, number of turns, direction, turns; 0 at the start
 * Returns TRIBO_ERR_SIZE also where a turn finds no room. */
TRIBO_API int tribo_iwan_force(size_t n, size_t room, const double *dz, const double *parameter, double *state, double *f,
                               double *df_dz);

/* -------------------------------------------------------------------------------------------------------- contexts */

/* A set of contacts with their law, limits, epsilon, operator R, solver memory and workspace. */
typedef struct tribo_context tribo_context;

/* Creates a context of ncontact >= 0 contacts: Quinn's law, limit 0, epsilon 1e-6, consistent coupling, no operator. Calls that
 * need an operator return TRIBO_ERR_STATE until an operator is set.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE, TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_create(tribo_context **ctx, size_t ncontact);

/* Creates a copy with the same settings, operator and memory. Both contexts share the storage of the operator. Thread-safe.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_clone(const tribo_context *ctx, tribo_context **copy);

/* Frees a context; ctx may be NULL. */
TRIBO_API void tribo_destroy(tribo_context *ctx);

/* Text of the last failure of a call that may change ctx: argument, contact (counted from 0) and value; "" before any failure.
 * The text belongs to ctx, which may be NULL. Calls on a const ctx store no message, since threads may share ctx. */
TRIBO_API const char *tribo_message(const tribo_context *ctx);

/* Copies law, limits, epsilon, static limits, coupling, sharing and planar contacts from a context with the same number of
 * contacts. Operator, forces, counts and memory of ctx stay; a change of the law clears the reversal memory.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE (numbers of contacts differ), and what tribo_set_planar returns. */
TRIBO_API int tribo_copy_settings(tribo_context *ctx, const tribo_context *from);

/* Number of contacts. Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_get_ncontact(const tribo_context *ctx, size_t *ncontact);

/* Law of all contacts; clears the reversal memory. Returns TRIBO_ERR_RANGE (no such law), TRIBO_ERR_UNSUPPORTED (VELOCITY_LIMITED
 * and SMOOTH with static limits that drop at once). */
TRIBO_API int tribo_set_law(tribo_context *ctx, int law);
TRIBO_API int tribo_get_law(const tribo_context *ctx, int *law);

/* Laws of the caller: f = clamp(f_eq - shift, lower, upper), where the box and shift follow from v, limit, epsilon and what law
 * knows of a contact. All laws above but QUINN_REVERSAL have this form, see the manual. tribo_force, tribo_balance, their
 * tangents and products, "rk4/fixed" and GSL's steppers use the law; tribo_step_force and the other methods keep Coulomb's.
 * Calls return TRIBO_ERR_CALLBACK if law fails or breaks a condition; tribo_message names contact and value, but not after
 * calls on a const ctx. Outputs are undefined then, but for those of tribo_balance. tribo_get_slip: stuck inside the box. Threads
 * that share ctx, and clones, call law with the same data at the same time; law must not use ctx. */

/* Law of all contacts by a function, with -limit <= lower <= upper <= limit; lower = upper where |v| > epsilon; |shift| <= 4e307.
 * law   in  called any number of times for n contacts, the first of which is first; returns 0, or another value to fail:
 *           v, limit, epsilon [n] in;  derivatives in   1: box is [9][n], 0: [3][n]
 *           box  out   rows lower, upper, shift; their derivatives by v; by limit, including that of an epsilon that follows the
 *                      limit (rows by limit may stay unset: calls for df_dlimit fail then)
 * data  in  passed to law; stays in use with ctx, its clones, and contexts that take its settings
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_UNSUPPORTED (planar contacts, static limits, which later calls refuse, too). */
TRIBO_API int tribo_set_user_law(tribo_context *ctx,
                                 int (*law)(size_t first, size_t n, int derivatives, const double *v, const double *limit,
                                            const double *epsilon, double *box, void *data),
                                 void *data);

/* Limits mu*N. limit [n] in, finite and >= 0; 0: the contact is open, carries no force and costs no time.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE; on error all limits are unchanged. */
TRIBO_API int tribo_set_limit(tribo_context *ctx, const double *limit);
TRIBO_API int tribo_set_limit_all(tribo_context *ctx, double limit);
TRIBO_API int tribo_get_limit(const tribo_context *ctx, double *limit);

/* Sets limits from normal loads, limit = mu max(load, 0), at most 1e300. mu [n] in, finite and >= 0; load [n] in, finite;
 * load <= 0: the contact has lifted off and is open. Returns what tribo_set_limit returns. */
TRIBO_API int tribo_set_normal_load(tribo_context *ctx, const double *mu, const double *load);

/* Static friction above kinetic. Contacts at rest hold up to ratio*limit. Sliding contacts carry limit or, with velocities
 * (Stribeck), limit (1 + (ratio - 1) exp(-|v|/velocity)). The manual states the rule by which coupled contacts break away.
 * ratio     [n] in, or NULL   static limit over limit, finite and >= 1; NULL: no static friction
 * velocity  [n] in, or NULL   > 0; NULL: the limit drops at once
 * Both directions of a planar contact need the same ratio and velocity.
 * Returns TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (a ratio below 1; directions of a planar contact differ), TRIBO_ERR_NOT_POSITIVE
 * (velocity), TRIBO_ERR_UNSUPPORTED (VELOCITY_LIMITED and SMOOTH need velocities); on error all settings are unchanged. */
TRIBO_API int tribo_set_static(tribo_context *ctx, const double *ratio, const double *velocity);

/* ratio, velocity [n] out, each or NULL; 1 and 0 if not set. Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_get_static(const tribo_context *ctx, double *ratio, double *velocity);

/* Velocity scale of the regularized laws. epsilon [n] in, > 0, in units of v.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE; on error epsilon is unchanged. */
TRIBO_API int tribo_set_epsilon(tribo_context *ctx, const double *epsilon);
TRIBO_API int tribo_set_epsilon_all(tribo_context *ctx, double epsilon);

/* Sets epsilon_i = 2 limit_i R_ii dt/lambda_dt: stuck contacts relax at the rate lambda = lambda_dt/dt. epsilon follows later
 * changes of limits and operator.
 * dt         in  time step of the caller's integrator, > 0
 * lambda_dt  in  > 0; 0.1 to 1 is best, rk4 is stable to 2.785
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE. */
TRIBO_API int tribo_set_epsilon_step(tribo_context *ctx, double dt, double lambda_dt);

/* epsilon [n] out. Returns TRIBO_ERR_NULL, TRIBO_ERR_STATE (tribo_set_epsilon_step was called, and no operator is set). */
TRIBO_API int tribo_get_epsilon(const tribo_context *ctx, double *epsilon);

/* Planar contacts: indices first[k] and first[k] + 1 become the two tangential directions of one contact. The force lies in the
 * ellipse with the semi-axes limit; if the contact slides, f = -limit^2 v/|limit v| in each direction. All other contacts are
 * scalar; arrays keep one entry per direction. The manual explains laws, epsilon and sharing in the plane.
 * first  [count] in   count 0: no planar contacts
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE (first; static limits that differ), TRIBO_ERR_DUPLICATE (a direction of two contacts),
 * TRIBO_ERR_UNSUPPORTED (partition coupling; an operator set by masses that differ too much), TRIBO_ERR_MEMORY; on error the
 * planar contacts are unchanged. */
TRIBO_API int tribo_set_planar(tribo_context *ctx, size_t count, const size_t *first);

/* The operator R of z'' = R f + a, in one of five forms; on error the old operator stays. R_ii = 0: friction cannot move
 * contact i, and the contact carries -limit sgn(a_i) at rest. All five return TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE,
 * TRIBO_ERR_MEMORY, TRIBO_ERR_UNSUPPORTED (a fixed operator; planar contacts, see tribo_set_planar), and the codes below. */

/* R = diag(r): contacts that share no body. r [n] in, >= 0. Returns also TRIBO_ERR_NEGATIVE. */
TRIBO_API int tribo_set_operator_diagonal(tribo_context *ctx, const double *r);

/* R as a full matrix. r [n][n] in, symmetric to rounding, positive semidefinite; may be singular (redundant contacts).
 * Returns also TRIBO_ERR_NOT_SYMMETRIC, TRIBO_ERR_INDEFINITE. */
TRIBO_API int tribo_set_operator_dense(tribo_context *ctx, const double *r);

/* R in compressed rows, both triangles: entries of row i are val[k] at column col[k], rowptr[i] <= k < rowptr[i + 1], in any
 * order, each at most once. rowptr [n + 1], col and val [rowptr[n]] in.
 * Returns also TRIBO_ERR_NOT_SYMMETRIC, TRIBO_ERR_INDEFINITE, TRIBO_ERR_RANGE (col), TRIBO_ERR_SIZE (rowptr does not begin with
 * 0, or decreases), TRIBO_ERR_DUPLICATE. */
TRIBO_API int tribo_set_operator_csr(tribo_context *ctx, const size_t *rowptr, const size_t *col, const double *val);

/* R = J diag(inverse_mass) J', v = J u. Bodies of very different masses are resolved to more digits than by the other forms.
 * inverse_mass      [ndof] in   >= 0; 0: the motion is prescribed
 * rowptr, col, val  in   J [n][ndof] in compressed rows
 * Returns also TRIBO_ERR_NEGATIVE (inverse_mass), TRIBO_ERR_RANGE (col), TRIBO_ERR_SIZE, TRIBO_ERR_DUPLICATE,
 * TRIBO_ERR_UNSUPPORTED (masses that differ by more than the solver resolves: 1e18, 1e10 in groups of more than 256 contacts). */
TRIBO_API int tribo_set_operator_mass(tribo_context *ctx, size_t ndof, const double *inverse_mass, const size_t *rowptr,
                                      const size_t *col, const double *val);

/* R = J M^-1 J' by a function of the caller that solves with M; J [n][ndof] in compressed rows. Entries of R below 1e-17 of the
 * diagonal are dropped.
 * apply  in  computes acceleration [ndof] out = M^-1 force [ndof] in, to 1e-11; called once per contact; must not change ctx.
 *            Returns 0, or another value to end the call (TRIBO_ERR_CALLBACK)
 * data   in  passed to apply
 * Returns also what tribo_set_operator_csr returns, for J and for the resulting R. */
TRIBO_API int tribo_set_operator_callback(tribo_context *ctx, size_t ndof,
                                          int (*apply)(size_t ndof, const double *force, double *acceleration, void *data),
                                          void *data, const size_t *rowptr, const size_t *col, const double *val);

/* New values of the operator, in the form that was set: for contacts that move over a body, or bodies that turn. Forces are
 * those of a context with the new operator set, to the last bit, unless sharing is PREVIOUS. Epsilon follows the operator;
 * settings, planar contacts, counts and the reversal memory stay. On error the old values stay.
 * val  in   tribo_set_operator_diagonal: r [n]; _dense: r [n][n]; _csr: val [rowptr[n]] at the rowptr and col that were set;
 *           _mass: val [rowptr[n]] of J likewise; inverse_mass stays. A value of 0 may change, others may become 0
 * Allocates memory in the first two calls after tribo_set_operator_..., tribo_set_planar, or tribo_clone of or to ctx; later only
 * where R couples more contacts than before, or in groups of more than 128 contacts other ones.
 * Returns what the call that set the operator returns, and TRIBO_ERR_STATE (no operator), TRIBO_ERR_UNSUPPORTED (the operator is
 * fixed, or was set by tribo_set_operator_callback). */
TRIBO_API int tribo_update_operator(tribo_context *ctx, const double *val);

/* Fixes the operator: later tribo_set_operator_... and tribo_update_operator on ctx return TRIBO_ERR_UNSUPPORTED. The operator of
 * a clone is not fixed.
 * Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_fix_operator(tribo_context *ctx);

/* Definition of f_eq for contacts that share bodies.
 *   CONSISTENT  f_eq of a contact balances a and the forces f = law(v, f_eq) of the other contacts; fulfils Coulomb's law at
 *               v = 0. Not in the paper.
 *   PARTITION   R_SS f_eq = -(a_S + R_SL f_L), S: contacts with |v| <= epsilon, L: the others. The paper, Eq. 8 to 10.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE, TRIBO_ERR_UNSUPPORTED (PARTITION with planar contacts). */
enum { TRIBO_CONSISTENT = 0, TRIBO_PARTITION = 1 };
TRIBO_API int tribo_set_coupling(tribo_context *ctx, int coupling);
TRIBO_API int tribo_get_coupling(const tribo_context *ctx, int *coupling);

/* Choice of the forces of redundant contacts: if R is singular, R f is unique and f is not.
 *   LEAST_NORM  the least sum of f_i^2; depends neither on the order of the contacts nor on earlier calls
 *   PREVIOUS    close to the forces of the last call; follows slow changes without jumps
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE. */
enum { TRIBO_SHARE_LEAST_NORM = 0, TRIBO_SHARE_PREVIOUS = 1 };
TRIBO_API int tribo_set_sharing(tribo_context *ctx, int sharing);
TRIBO_API int tribo_get_sharing(const tribo_context *ctx, int *sharing);

/* ---------------------------------------------------------------------------------------------------------- forces */

/* Friction force of every contact by the law, for a given f_eq. The paper, Eq. 4.
 * v    [n] in   relative velocity
 * feq  [n] in   balancing force; read only where |v| <= epsilon
 * f    [n] out  friction force, |f| <= limit
 * Thread-safe. Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_STATE (as tribo_get_epsilon),
 * TRIBO_ERR_NO_CONVERGENCE (planar contacts). */
TRIBO_API int tribo_force(const tribo_context *ctx, const double *v, const double *feq, double *f);

/* As tribo_force, with derivatives of scalar contacts; one-sided at a kink. df_dlimit includes the change of an epsilon that
 * follows the limit (tribo_set_epsilon_step).
 * f, df_dv, df_dfeq, df_dlimit  [n] out, each or NULL
 * Thread-safe. Returns what tribo_force returns, and TRIBO_ERR_UNSUPPORTED (planar contacts: tribo_force_tangent_planar). */
TRIBO_API int tribo_force_tangent(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv,
                                  double *df_dfeq, double *df_dlimit);

/* As tribo_force_tangent, also for planar contacts.
 * f                           [n] out, or NULL
 * df_dv, df_dfeq, df_dlimit   [n][2] out, each or NULL; planar contact: row i is the derivative of f_i by the first and
 *                             the second direction; scalar contact: row i is the derivative and 0
 * Thread-safe. Returns what tribo_force returns. */
TRIBO_API int tribo_force_tangent_planar(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv,
                                         double *df_dfeq, double *df_dlimit);

/* f_eq and f of coupled contacts, z'' = R f + a.
 * v    [n] in   relative velocity
 * a    [n] in   relative acceleration without friction (minus the driven acceleration of the contact)
 * feq  [n] out  or NULL; 0 for open contacts
 * f    [n] out  or NULL; |f| <= limit
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_STATE (no operator), TRIBO_ERR_NO_CONVERGENCE,
 * TRIBO_ERR_INCONSISTENT. */
TRIBO_API int tribo_balance(tribo_context *ctx, const double *v, const double *a, double *feq, double *f);

/* As tribo_balance, with the derivatives of f by v and a for Newton's method of an implicit integrator; one-sided at a kink.
 * df_dv, df_da  [n][n] out, each or NULL; row i is the derivative of f_i; not written on TRIBO_ERR_INCONSISTENT
 * Returns what tribo_balance returns. */
TRIBO_API int tribo_balance_tangent(tribo_context *ctx, const double *v, const double *a, double *feq, double *f, double *df_dv,
                                    double *df_da);

/* Product of the derivatives with changes of v and a, df = df_dv dv + df_da da, at the point of the last tribo_balance_tangent
 * (its df_dv and df_da may have been NULL). Takes O(s^2) operations for s coupled contacts near stick.
 * dv, da  [n] in   each or NULL for 0
 * df      [n] out
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_STATE (no tribo_balance_tangent, or another balance or a changed
 * setting since). */
TRIBO_API int tribo_tangent_product(tribo_context *ctx, const double *dv, const double *da, double *df);

/* As tribo_tangent_product, for a change of limits: df = df_dlimit dlimit, including the change of an epsilon that follows the
 * limit.
 * dlimit  [n] in   ignored where limit is 0
 * df      [n] out
 * Returns what tribo_tangent_product returns, and TRIBO_ERR_UNSUPPORTED with static limits (tribo_set_static). */
TRIBO_API int tribo_limit_product(tribo_context *ctx, const double *dlimit, double *df);

/* Coulomb's law over one time step, without epsilon: the constant force f with v_end = vfree + dt R f such that every contact is
 * at rest or slides against f at the end of the step. Moreau (1988); Jean and Moreau (1992). First order; with static limits use
 * tribo_step_force_mean.
 * dt     in       step, > 0
 * vfree  [n] in   relative velocity at the end of the step without friction
 * f      [n] out  friction force, |f| <= limit
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE (dt), TRIBO_ERR_STATE (no operator),
 * TRIBO_ERR_NO_CONVERGENCE. */
TRIBO_API int tribo_step_force(tribo_context *ctx, double dt, const double *vfree, double *f);

/* As tribo_step_force, with second order also if sliding turns or reverses within the step; solves up to twice. Planar contacts
 * slide along v + v_end; scalar contacts reverse their force where v = 0. First order with static limits: a contact that slides
 * at the start of the step has the kinetic limit until it stops.
 * v  [n] in  relative velocity at the start of the step
 * Returns what tribo_step_force returns. */
TRIBO_API int tribo_step_force_mean(tribo_context *ctx, double dt, const double *v, const double *vfree, double *f);

/* Minimizes 1/2 f'Rf + a'f over lower <= f <= upper, for friction laws of the caller. Reads the operator only.
 * a, lower, upper  [n] in   finite, lower <= upper
 * f                [n] out
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (lower above upper), TRIBO_ERR_STATE (no operator),
 * TRIBO_ERR_NO_CONVERGENCE. */
TRIBO_API int tribo_solve_box(tribo_context *ctx, const double *a, const double *lower, const double *upper, double *f);

/* Advances the memory of QUINN_REVERSAL after an accepted step that ended at v, feq: marks a contact if |v| > epsilon, and
 * unmarks a contact if |v| <= epsilon and |feq| <= limit. Other laws have no memory.
 * v, feq  [n] in   feq is read only where |v| <= epsilon
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, and with QUINN_REVERSAL what tribo_force returns. */
TRIBO_API int tribo_accept(tribo_context *ctx, const double *v, const double *feq);

/* ----------------------------------------------------------------------------------------------------------- queries */

/* Slip states of a contact. */
enum {
    TRIBO_SLIP_BACK = -1, /* slides towards -z, f = limit */
    TRIBO_SLIP_STUCK = 0,
    TRIBO_SLIP_FORTH = 1, /* slides towards +z, f = -limit */
    TRIBO_SLIP_OPEN = 2,  /* limit 0, f = 0 */
    TRIBO_SLIP_PLANE = 3  /* slides in the plane; stands at both directions of a planar contact */
};

/* Slip state of each contact in the last tribo_balance, tribo_step_force or tribo_step_force_mean, by the limits of that call.
 * slip  [n] out  TRIBO_SLIP_...
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_STATE (no such call succeeded yet, or tribo_solve_box or tribo_set_operator_... was called
 * since). */
TRIBO_API int tribo_get_slip(const tribo_context *ctx, signed char *slip);

/* Counts. STUCK and RANK belong to the last tribo_balance, tribo_step_force or tribo_solve_box, ISLANDS and PLANAR to the current
 * operator and settings; all others are sums since tribo_create. */
enum {
    TRIBO_COUNT_STUCK = 0,          /* contacts with slip 0; 0 if tribo_get_slip fails */
    TRIBO_COUNT_RANK = 1,           /* sum of the ranks of the matrices that the last call solved with */
    TRIBO_COUNT_ISLANDS = 2,        /* groups of coupled contacts in the operator, and single contacts */
    TRIBO_COUNT_SOLVES = 3,         /* islands solved by the solver */
    TRIBO_COUNT_SKIPPED = 4,        /* islands that need no solver: a single contact, or no contact near stick */
    TRIBO_COUNT_FACTORIZATIONS = 5, /* matrices factorized */
    TRIBO_COUNT_UPDATES = 6,        /* contacts that entered or left a stick set */
    TRIBO_COUNT_REVERSALS = 7,      /* reversal marks set or cleared by tribo_accept */
    TRIBO_COUNT_REUSED = 8,         /* solves that kept the stick set and the factor of the solve before */
    TRIBO_COUNT_PLANAR = 9,         /* planar contacts */
    TRIBO_COUNT_SETTINGS = 10,      /* calls that changed a setting or the operator */
    TRIBO_COUNT_VALUES = 11         /* values that tribo_update_operator reads; 0 if it cannot be called */
};
/* Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE (which). */
TRIBO_API int tribo_get_count(const tribo_context *ctx, int which, size_t *value);

/* Real quantities.
 *   RESIDUAL  of the last tribo_balance or tribo_step_force: largest error of a contact's balance beyond rounding, over the limit
 *   MAX_RATE  lambda, 1/time: largest rate at which contacts near v = 0 relax. With partition coupling, VELOCITY_LIMITED and
 *             SMOOTH: an upper bound of that rate
 *   MAX_STEP  2.785/lambda, the largest stable step of rk4; HUGE_VAL if lambda = 0
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE (which), TRIBO_ERR_STATE (MAX_RATE, MAX_STEP: no operator). */
enum { TRIBO_REAL_RESIDUAL = 0, TRIBO_REAL_MAX_RATE = 1, TRIBO_REAL_MAX_STEP = 2 };
TRIBO_API int tribo_get_real(const tribo_context *ctx, int which, double *value);

#ifdef __cplusplus
}
#endif

#endif
