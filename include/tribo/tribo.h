/* tribo: dry friction in structural dynamics.
 *
 *     tribo_create(&c, n);                        n contacts
 *     tribo_set_limit(c, limit);                  mu times normal load; again whenever that changes
 *     tribo_set_operator_diagonal(c, r);          R, here of contacts that share no body: 1/mass
 *     tribo_set_epsilon_step(c, dt, 0.4);         how fast a contact comes to rest
 *     tribo_balance(c, v, a, NULL, f);            for each evaluation of accelerations; bodies get J' f
 *
 * With small fixed steps tribo_step_force gives the force over a step, and needs no epsilon.
 *
 * Quantities. A contact has a relative velocity v = dz/dt and a friction force f along +z. Its limit is mu times the
 * normal load, limit >= 0, so that sliding means f = -limit * sgn(v). The velocities of contacts are v = J u, those of the bodies
 * being u; so bodies get the forces J' f: a contact with z = x_1 - x_2 puts f on body 1 and -f on body 2. Contact accelerations
 * are z'' = R f + a, where R = J M^-1 J' (the Delassus operator, symmetric and positive semidefinite) and a is everything but
 * friction. f_eq is the friction force that makes a contact's z'' zero. Any consistent set of units will do: forces like limit,
 * velocities like epsilon, and R in velocity per time and force.
 *
 * Arrays hold one double a contact, contiguous, unless said otherwise; contacts are counted from 0. Outputs come last (but for
 * the handle that a context is created in, which comes first), must not overlap inputs, and are untouched on error (but for
 * TRIBO_ERR_INCONSISTENT); an output marked "or NULL" is then not computed.
 *
 * Status. Every call that can fail returns one of TRIBO_OK (0) and TRIBO_ERR_...; tribo_message names the
 * argument, the contact and the value. Nothing prints, exits, aborts or keeps global state.
 *
 * Numbers. Any finite ones. Forces beyond 1e300, and what makes accelerations beyond that, are cut to it. Short of that no call
 * raises the floating-point exceptions invalid, divide-by-zero or overflow, at which some programs stop.
 *
 * Threads. Several threads may call functions of a const context on one context. Everything else wants one context a thread:
 * tribo_clone. From compilers other than GCC and Clang copies of one context are made, given another operator, and destroyed by
 * one thread at a time. Memory is allocated by tribo_create, tribo_clone, tribo_copy_settings, tribo_set_planar and
 * tribo_set_operator_... only.
 *
 * Source: D. D. Quinn, "A New Regularization of Coulomb Friction", J. Vib. Acoust. 126 (2004) 391-397,
 * doi:10.1115/1.1760564, "the paper" below. All functions: since 1.0, unless said otherwise.
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
    TRIBO_ERR_CALLBACK = 62, /* a function of the caller's failed */
    TRIBO_ERR_CHATTER = 63   /* too many events in too short a time: "central/fixed" and "moreau/fixed" step over them */
};

/* 10000 major + 100 minor + patch of the library that is running; TRIBO_VERSION is that of this header. */
TRIBO_API int tribo_version(void);
TRIBO_API const char *tribo_version_string(void);

/* Text for a status; any int gets one. */
TRIBO_API const char *tribo_strerror(int status);

/* ---------------------------------------------------------------------------------------------------------- laws */

/* Friction laws.
 *   COULOMB           v != 0: -limit sgn v;  v = 0: clamp(f_eq, -limit, limit). The paper, Eq. 1 and 2.
 *   VELOCITY_LIMITED  clamp(-limit v/epsilon, -limit, limit). Martins and Oden (1987), the paper's Eq. 3.
 *   SMOOTH            -limit tanh(v/epsilon).
 *   KARNOPP           |v| <= epsilon: clamp(f_eq, -limit, limit), else -limit sgn v; the caller holds v at 0 inside.
 *   QUINN             clamp(clamp(f_eq, -limit, limit) - (2 limit/epsilon) v, -limit, limit). The paper, Eq. 4.
 *   QUINN_REVERSAL    Quinn's law, with a second-order form for contacts that are driven through v = 0 without stick;
 *                     it remembers which those are, see tribo_accept. */
enum {
    TRIBO_COULOMB = 0,
    TRIBO_VELOCITY_LIMITED = 1,
    TRIBO_SMOOTH = 2,
    TRIBO_KARNOPP = 3,
    TRIBO_QUINN = 4,
    TRIBO_QUINN_REVERSAL = 5
};

/* Number of laws; their numbers are 0 to tribo_law_count() - 1. */
TRIBO_API int tribo_law_count(void);

/* Name of a law ("coulomb", "velocity-limited", "smooth", "karnopp", "quinn", "quinn-reversal") and the place in the
 * literature that it comes from. NULL if there is no such law. */
TRIBO_API const char *tribo_law_name(int law);
TRIBO_API const char *tribo_law_reference(int law);

/* Number of the law called name, in upper or lower case. Returns TRIBO_ERR_NULL, TRIBO_ERR_NAME. */
TRIBO_API int tribo_law_find(const char *name, int *law);

/* One contact, no context: the force and its derivatives.
 * v         in   relative velocity
 * feq       in   balancing force; read only where |v| <= epsilon and the law asks for it
 * limit     in   mu times normal load, >= 0
 * epsilon   in   velocity scale, > 0
 * f         out  friction force, |f| <= limit
 * df_dv, df_dfeq, df_dlimit   out, each or NULL; one-sided at a kink, df_dv = 0 at a jump
 * QUINN_REVERSAL: as for a contact that comes in sliding (memory bit set).
 * Returns TRIBO_ERR_RANGE (law), TRIBO_ERR_NULL (f), TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_NOT_POSITIVE. */
TRIBO_API int tribo_law_eval(int law, double v, double feq, double limit, double epsilon, double *f, double *df_dv,
                             double *df_dfeq, double *df_dlimit);

/* n elastic contacts, no context: each a spring in series with a Coulomb slider (Jenkins, Masing).
 * Computes f = clamp(f - stiffness dz, -limit, limit) after a displacement dz; f is the whole state of an element.
 * dz         [n] in      relative displacement dz since the last call: z = J x; bodies get J' f
 * stiffness  [n] in      of the spring, >= 0
 * limit      [n] in      mu times normal load, >= 0
 * f          [n] in/out  friction force; 0 to begin with
 * df_dz      [n] out, or NULL   -stiffness; 0 where the element slides
 * Thread-safe. Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE (n), TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE (stiffness, limit). */
TRIBO_API int tribo_elastic_force(size_t n, const double *dz, const double *stiffness, const double *limit, double *f,
                                  double *df_dz);

/* The same in the plane, |f| <= limit: f = p, or limit p/|p| where |p| > limit, with p = f - stiffness dz.
 * dz, f [n][2]; stiffness, limit [n]; df_dz [n][2][2], symmetric. Returns the same. */
TRIBO_API int tribo_elastic_force_planar(size_t n, const double *dz, const double *stiffness, const double *limit, double *f,
                                         double *df_dz);

/* -------------------------------------------------------------------------------------------------------- contexts */

/* A set of contacts with their law, limits, epsilon, operator R, solver memory and workspace. */
typedef struct tribo_context tribo_context;

/* A context for ncontact contacts (0 is fine): Quinn's law, limit 0, epsilon 1e-6, consistent coupling, and no operator: that
 * must be set before tribo_balance, tribo_balance_tangent, tribo_step_force, tribo_solve_box, or TRIBO_REAL_MAX_RATE and
 * MAX_STEP, which return TRIBO_ERR_STATE otherwise. No contacts need none. Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE,
 * TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_create(tribo_context **ctx, size_t ncontact);

/* A copy with the same settings and memory. Neither sees what becomes of the other; the operator, which no call changes, takes
 * its memory once for both. Returns TRIBO_ERR_NULL, TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_clone(const tribo_context *ctx, tribo_context **copy);

/* Releases a context; NULL is fine. */
TRIBO_API void tribo_destroy(tribo_context *ctx);

/* Text of the last failure of a call that may change ctx: argument, contact (counted from 0) and value; "" before any. Belongs to
 * ctx. Calls on a const ctx leave no message, on any compiler: threads may share it. Their status says all. ctx may be NULL. */
TRIBO_API const char *tribo_message(const tribo_context *ctx);

/* Gives ctx the settings of another context with as many contacts: law, limits, epsilon, static limits, coupling, sharing and
 * planar contacts. Operator, forces, counts and memory stay; another law clears the reversal memory.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE (numbers of contacts differ), and what tribo_set_planar returns. */
TRIBO_API int tribo_copy_settings(tribo_context *ctx, const tribo_context *from);

/* Number of contacts. Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_get_ncontact(const tribo_context *ctx, size_t *ncontact);

/* Law of all contacts; clears the reversal memory. Returns TRIBO_ERR_RANGE for a number that is no law, TRIBO_ERR_UNSUPPORTED for
 * one that knows no stick where limits drop at once (tribo_set_static). */
TRIBO_API int tribo_set_law(tribo_context *ctx, int law);
TRIBO_API int tribo_get_law(const tribo_context *ctx, int *law);

/* Limits mu*N. limit [n] in, finite and >= 0; 0 means an open contact, which carries no force and costs nothing.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE; on error all limits stay as they were. */
TRIBO_API int tribo_set_limit(tribo_context *ctx, const double *limit);
TRIBO_API int tribo_set_limit_all(tribo_context *ctx, double limit);
TRIBO_API int tribo_get_limit(const tribo_context *ctx, double *limit);

/* The limits that normal loads give: limit = mu max(load, 0). mu [n] in, finite and >= 0; load [n] in, finite: where it is 0 or
 * negative the contact has lifted off, and is open. Returns as tribo_set_limit; limits beyond 1e300 are cut to it. */
TRIBO_API int tribo_set_normal_load(tribo_context *ctx, const double *mu, const double *load);

/* Static friction above kinetic: a contact at rest holds up to ratio*limit; once it slides, its limit is
 *     limit                                                         without velocities: it drops at once;
 *     N(|v|) = limit (1 + (ratio - 1) exp(-|v|/velocity))           with them (Stribeck): it falls with the speed.
 * ratio     [n] in, or NULL   static limit over limit, finite and >= 1; NULL, or all 1: rest makes no difference
 * velocity  [n] in, or NULL   > 0
 *
 * A limit that drops at once. Contacts near stick (|v| <= epsilon; COULOMB: v = 0) go by ratio*limit in the place of limit, and
 * the others by limit. tribo_balance finds the forces, and those near stick whose |f_eq| is above ratio*limit break away: they go
 * by limit from there on, all of them at the same time, and the forces are found again, until none breaks away. So contacts only
 * leave, their order does not matter, and where several answers are possible this is the one. Redundant contacts at rest hold as
 * long as any forces within ratio*limit hold all of them. What has broken away may yet be held by the others, with |f| <= limit.
 * A contact whose load just reaches its static limit holds; it counts as sliding in tribo_get_slip. In the partition coupling
 * nothing is found again: each contact goes by its own f_eq, and so it does in tribo_force. Forces jump at |v| = epsilon, so that
 * integrators are of first order there. VELOCITY_LIMITED and SMOOTH know no stick, and need velocities.
 *
 * Planar contacts go by the same rule, in their plane: near stick within the ellipse of ratio*limit; a contact whose f_eq is
 * outside that goes by the ellipse of limit from there on, and slides the way in which it was held. |v| is then the length of v.
 * Both directions of one have the same ratio and velocity.
 *
 * A limit that falls with the speed. N(|v|) takes the place of limit in every law and coupling; forces are as continuous in v as
 * they were.
 *
 * TRIBO_REAL_MAX_RATE is that of static limits, and so is the epsilon of tribo_set_epsilon_step. TRIBO_COUNT_SOLVES counts each
 * time that forces of an island are found. tribo_solve_box knows no limits, and so no static ones.
 * Returns TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (a ratio below 1; ratios or velocities of one planar contact that differ, for
 * which tribo_set_planar returns it too), TRIBO_ERR_NOT_POSITIVE (velocity), TRIBO_ERR_UNSUPPORTED (a law without stick needs
 * velocities; tribo_set_law returns it too); on error all stays as it was. */
TRIBO_API int tribo_set_static(tribo_context *ctx, const double *ratio, const double *velocity);

/* ratio, velocity [n] out, each or NULL: 1 where nothing was set, and velocity 0 where there is none.
 * Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_get_static(const tribo_context *ctx, double *ratio, double *velocity);

/* Velocity scale of the regularized laws. epsilon [n] in, > 0, in units of v.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE; on error all stays as it was. */
TRIBO_API int tribo_set_epsilon(tribo_context *ctx, const double *epsilon);
TRIBO_API int tribo_set_epsilon_all(tribo_context *ctx, double epsilon);

/* Fixes the rate at which stuck contacts relax, lambda = 2 limit R_ii/epsilon, to lambda_dt/dt, whatever limits and
 * operator are or become: epsilon_i = 2 limit_i R_ii dt/lambda_dt follows them. Contacts that share bodies relax up to a few
 * times as fast in the partition coupling, see TRIBO_REAL_MAX_RATE. Before there is an operator there is no epsilon either, and
 * tribo_get_epsilon, tribo_force, tribo_force_tangent, tribo_force_tangent_planar and, with QUINN_REVERSAL, tribo_accept return
 * TRIBO_ERR_STATE.
 * dt         in  time step of the caller's integrator, > 0
 * lambda_dt  in  > 0; the paper takes 1 for the oscillator and 0.4 for the chain; rk4 is stable to 2.785
 * Returns what tribo_set_epsilon does. tribo_get_epsilon: epsilon [n] out. */
TRIBO_API int tribo_set_epsilon_step(tribo_context *ctx, double dt, double lambda_dt);
TRIBO_API int tribo_get_epsilon(const tribo_context *ctx, double *epsilon);

/* Planar contacts: directions first[k] and first[k] + 1, 0 <= k < count, are the two tangential ones of one contact, and friction
 * is one force in their plane. All other contacts stay scalar, and R couples them as before; all arrays keep one entry for each
 * direction. count 0: there are none. (A "contact" is a direction wherever n is their number.)
 *   limit     the semi-axes of the ellipse that holds f; equal: a disc. Both 0: open. One 0: a scalar contact along the other
 *   sliding   f = -limit^2 v/|limit v|, by direction, which is -limit v/|v| for a disc: the most that friction can dissipate
 *   epsilon   the contact slides where |limit v| >= the larger limit epsilon of its two directions. After tribo_set_epsilon_step
 *             both have the epsilon that the largest eigenvalue of their own 2x2 block of R asks for in the place of R_ii
 *   laws      those of one direction, along the direction of motion. QUINN and QUINN_REVERSAL (which remembers nothing of
 *             planar contacts) take the f that minimizes 1/2 f'Rf + (a + R_d kappa)'f, R_d being the blocks on the diagonal and
 *             kappa = 2 limit^2 v/(the larger limit epsilon), by direction, which is (2 limit/epsilon) v for a disc, over the
 *             lens: f and f + kappa are both within the limits. On a line that is the scalar law; which tangential directions
 *             are taken does not matter; and at v = 0 it is Coulomb's law, also where R_d or limits differ by direction.
 *   sharing   as tribo_set_sharing says, but least norms are found to about 1e-8 of the limits only, where limits and the
 *             eigenvalues of R that are not 0 are alike; far from that f is one of the solutions, with R f right. It takes a
 *             few solutions in the place of one
 * Groups with planar contacts (contacts of any kind that R or a planar contact joins) are solved in ordinary digits, and their R
 * is kept as a matrix: TRIBO_ERR_UNSUPPORTED for more than 2048 directions in one, and for bodies of tribo_set_operator_mass that
 * need more digits than that (shares that differ by more than 1e10), from here or from tribo_set_operator_....
 * first [count] in. Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE (also: static limits that differ, tribo_set_static),
 * TRIBO_ERR_DUPLICATE (a direction of two contacts), TRIBO_ERR_UNSUPPORTED (also: not in the partition coupling),
 * TRIBO_ERR_MEMORY; on error all stays as it was. */
TRIBO_API int tribo_set_planar(tribo_context *ctx, size_t count, const size_t *first);

/* The operator R of z'' = R f + a. On error the old one stays. TRIBO_ERR_UNSUPPORTED if it is fixed (tribo_fix_operator), as that
 * of the context of a tribo_system is. All return TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_MEMORY, with planar contacts what
 * tribo_set_planar tells of them, and what stands below.
 * A contact with R_ii = 0 (driven from both sides: friction cannot move it) is taken as the limit R_ii -> +0: at rest
 * it carries -limit sgn(a_i), and nothing if a_i = 0; its f_eq is then reported as -sgn(a_i) times a huge number, and its
 * derivative by a as 0. */

/* R = diag(r): contacts that share no body. r [n] in, >= 0. Never enters a solver.
 * Returns also TRIBO_ERR_NEGATIVE. */
TRIBO_API int tribo_set_operator_diagonal(tribo_context *ctx, const double *r);

/* r [n][n] in, symmetric to rounding (it is made exactly so), positive semidefinite, redundant contacts welcome.
 * Returns also TRIBO_ERR_NOT_SYMMETRIC, TRIBO_ERR_INDEFINITE. */
TRIBO_API int tribo_set_operator_dense(tribo_context *ctx, const double *r);

/* The same in compressed rows, both triangles: the entries of row i are val[k] at column col[k], k = rowptr[i] to
 * rowptr[i+1] - 1, in any order, each at most once. rowptr [n+1], col and val [rowptr[n]].
 * Returns also TRIBO_ERR_NOT_SYMMETRIC, TRIBO_ERR_INDEFINITE, TRIBO_ERR_RANGE (col), TRIBO_ERR_SIZE (rowptr does not begin with
 * 0, or decreases), TRIBO_ERR_DUPLICATE. */
TRIBO_API int tribo_set_operator_csr(tribo_context *ctx, const size_t *rowptr, const size_t *col, const double *val);

/* R = J diag(inverse_mass) J', J [n][ndof] in compressed rows: row i is how the velocities of the degrees of freedom
 * make v_i. inverse_mass [ndof] in, >= 0 (0: a degree of freedom whose motion is prescribed).
 * A light body between heavy ones hides them in R as numbers; groups in which it does are solved with twice as many digits here,
 * for shares J_ik^2 inverse_mass_k of one contact that differ by up to 1e18, in groups of up to 256 contacts (1e10 in larger
 * ones; beyond: TRIBO_ERR_UNSUPPORTED). Of the other forms of input, the caller must know what rounding leaves.
 * Returns also TRIBO_ERR_NEGATIVE (inverse_mass), TRIBO_ERR_RANGE, TRIBO_ERR_SIZE, TRIBO_ERR_DUPLICATE. */
TRIBO_API int tribo_set_operator_mass(tribo_context *ctx, size_t ndof, const double *inverse_mass, const size_t *rowptr,
                                      const size_t *col, const double *val);

/* R = J M^-1 J' for a mass matrix that only the caller can solve with; J as above. R is found column by column, and where
 * contacts do not feel each other its entries (those below 1e-17 of the diagonal too) are not kept.
 * apply  in  called once a contact: acceleration [ndof] out = M^-1 force [ndof] in, to 1e-11; it must not change ctx. Answers
 *            0, or anything else to end it: then this returns TRIBO_ERR_CALLBACK. data is handed to it.
 * Returns also what tribo_set_operator_csr does: not symmetric or indefinite is then what apply makes of J. */
TRIBO_API int tribo_set_operator_callback(tribo_context *ctx, size_t ndof,
                                          int (*apply)(size_t ndof, const double *force, double *acceleration, void *data),
                                          void *data, const size_t *rowptr, const size_t *col, const double *val);

/* Fixes the operator: from here on tribo_set_operator_... return TRIBO_ERR_UNSUPPORTED. That of a clone can be changed.
 * Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_fix_operator(tribo_context *ctx);

/* How f_eq of contacts that share bodies is found.
 *   CONSISTENT  f_eq of each contact balances the forces that the others really carry. Continuous, has a solution for every
 *               a, and at v = 0 it is Coulomb's law exactly. Beyond the paper.
 *   PARTITION   with S the contacts with |v| <= epsilon: R_SS f_eq = -(a_S + R_SL f_L). The paper, Eq. 8 to 10.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE, TRIBO_ERR_UNSUPPORTED (PARTITION with planar contacts). */
enum { TRIBO_CONSISTENT = 0, TRIBO_PARTITION = 1 };
TRIBO_API int tribo_set_coupling(tribo_context *ctx, int coupling);
TRIBO_API int tribo_get_coupling(const tribo_context *ctx, int *coupling);

/* How redundant contacts share: R f is unique, but where R is singular f is not. (In the partition f_eq is always the one of
 * least norm.)
 *   LEAST_NORM  the f of least norm, sum of f_i^2: depends neither on the order of the contacts nor on earlier calls. (Groups of
 *               more than 2048 contacts that are kept sparse: while not more than 64 are redundant; beyond that, one of the
 *               solutions.)
 *   PREVIOUS    one that is found from the forces of the last call, and follows slow changes without jumps. For event-driven
 *               codes, where a contact that has reached its limit should stay there while others take over.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE. */
enum { TRIBO_SHARE_LEAST_NORM = 0, TRIBO_SHARE_PREVIOUS = 1 };
TRIBO_API int tribo_set_sharing(tribo_context *ctx, int sharing);
TRIBO_API int tribo_get_sharing(const tribo_context *ctx, int *sharing);

/* ---------------------------------------------------------------------------------------------------------- forces */

/* Friction force of every contact from its law, f_eq being known.
 * v    [n] in   relative velocity
 * feq  [n] in   balancing force; read only where |v| <= epsilon
 * f    [n] out  friction force, |f| <= limit; of a planar contact the point of its lens that is nearest to f_eq - kappa, as R_d
 *               measures it (f'R_d f; the identity before there is an operator)
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_STATE (tribo_set_epsilon_step, and no operator). The paper, Eq. 4. */
TRIBO_API int tribo_force(const tribo_context *ctx, const double *v, const double *feq, double *f);

/* The same with derivatives. f, df_dv, df_dfeq, df_dlimit [n] out, each or NULL. Where epsilon follows the limit
 * (tribo_set_epsilon_step), df_dlimit takes that into account. Derivatives are those of scalar contacts: TRIBO_ERR_UNSUPPORTED
 * if one is planar, see tribo_force_tangent_planar. Returns otherwise what tribo_force does. */
TRIBO_API int tribo_force_tangent(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv,
                                  double *df_dfeq, double *df_dlimit);

/* The same where contacts may be planar, which have blocks of derivatives.
 * f                        [n] out, or NULL
 * df_dv, df_dfeq, df_dlimit   [n][2] out, each or NULL; the rows of the two directions of a planar contact are its 2x2 block: how
 *                          this component of f follows the first one and the second one. Of a scalar contact: its derivative, 0
 * One-sided at a kink, also where the limits of both directions are equal and change differently. Where the band of a planar
 * contact ends they grow from inside, see tribo_balance_tangent. Returns what tribo_force does, and TRIBO_ERR_NO_CONVERGENCE. */
TRIBO_API int tribo_force_tangent_planar(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv,
                                         double *df_dfeq, double *df_dlimit);

/* f_eq and f of coupled contacts, z'' = R f + a.
 * v    [n] in   relative velocity
 * a    [n] in   relative acceleration without friction (minus the contact's driven acceleration)
 * feq  [n] out  or NULL; 0 for open contacts
 * f    [n] out  or NULL; |f| <= limit
 * Consistent coupling: f = law(v, feq) and R_ii feq_i = -(a_i + sum of R_ij f_j over j != i), to rounding (R_d, and the other
 * contacts' j, for planar ones). Where contacts are redundant R f is unique and f one of the solutions, see tribo_set_sharing.
 * QUINN_REVERSAL: f_eq of contacts near stick balances Quinn's forces.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_STATE (no operator), TRIBO_ERR_NO_CONVERGENCE,
 * TRIBO_ERR_INCONSISTENT. */
TRIBO_API int tribo_balance(tribo_context *ctx, const double *v, const double *a, double *feq, double *f);

/* The same, and how f follows v and a: what Newton's method of an implicit integrator asks for.
 * df_dv, df_da  [n][n] out, each or NULL; row i is the derivative of f_i. One-sided at a kink: of a planar contact that is pulled
 * beyond its limits at v = 0, towards where it is about to slide. Of redundant contacts only R times it is unique: it is then the
 * least in norm (with planar contacts: in parts of limits). Where the band of a planar contact ends they grow beyond all bounds
 * from inside, like 1/sqrt(1 - |v|/epsilon); there and outside they are those of sliding. On
 * TRIBO_ERR_INCONSISTENT they are not written. Returns what tribo_balance does. */
TRIBO_API int tribo_balance_tangent(tribo_context *ctx, const double *v, const double *a, double *feq, double *f, double *df_dv,
                                    double *df_da);

/* Product of these derivatives with a change of v and a, for solvers that need no matrix: df = df_dv dv + df_da da at the point
 * of the last tribo_balance_tangent, whose matrices may be NULL. In O(s^2) for s coupled contacts near stick.
 * dv, da  [n] in   each or NULL for none
 * df      [n] out
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, and TRIBO_ERR_STATE if there has been no tribo_balance_tangent, or another
 * balance or setting since. */
TRIBO_API int tribo_tangent_product(tribo_context *ctx, const double *dv, const double *da, double *df);

/* The same for a change of limits, for hosts whose normal loads follow the motion: df = df_dlimit dlimit, with all that the other
 * contacts make of it; where epsilon follows the limit (tribo_set_epsilon_step), that takes part. One-sided at a kink, also where
 * the limits of the two directions of a planar contact are equal and change differently. Directions with limit 0 are open and
 * stay so: their dlimit counts as 0.
 * dlimit  [n] in
 * df      [n] out
 * Returns what tribo_tangent_product returns, and TRIBO_ERR_UNSUPPORTED with static limits (tribo_set_static). */
TRIBO_API int tribo_limit_product(tribo_context *ctx, const double *dlimit, double *df);

/* Coulomb's law over one time step, for integrators with fixed steps; needs no epsilon. The force, constant over the step,
 * that leaves the contacts in Coulomb's law at its end: v_end = vfree + dt R f, and v_end_i = 0 or f_i = -limit_i sgn v_end_i.
 * With static limits (tribo_set_static) a contact sticks if it can: v_end is found with |f| <= ratio*limit; contacts that slide
 * then go by limit, or by N(|v_end|), all of them at the same time, and v_end is found again, until all others stick. Of first
 * order in dt, since contacts break away, and their limits fall, from the beginning of a step on. vfree alone does not tell who
 * slides already: a contact at rest that shares a body with one that slides may break away by the static limit of that one, which
 * it has lost. So with static limits take tribo_step_force_mean, which is given v.
 * dt     in       step, > 0
 * vfree  [n] in   relative velocity that the step would end with without friction
 * f      [n] out  friction force, |f| <= limit; of a planar contact f = -limit^2 v_end/|limit v_end|, or v_end = 0
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE (dt), TRIBO_ERR_STATE (no operator),
 * TRIBO_ERR_NO_CONVERGENCE. Moreau (1988); Jean and Moreau (1992). */
TRIBO_API int tribo_step_force(tribo_context *ctx, double dt, const double *vfree, double *f);

/* The same to second order also where sliding turns or reverses within the step, which tribo_step_force is not.
 *   planar contacts  that tribo_step_force leaves at v_end = 0 stick; the others slide along their mean velocity, f = -limit^2
 *                    w/|limit w| with w = v + v_end, unless they turn back by more than a right angle
 *   scalar ones      that come in sliding and are driven through v = 0, against more than their limit, carry it one way until
 *                    then and the other way after: f is the mean of that, and tribo_get_slip tells the direction of the end
 * All others are as there. It costs up to two solutions. With static limits (tribo_set_static) all are as there, of first order,
 * except that contacts which come in sliding, |v| > 1e-4 dt R_ii ratio limit, go by limit, or N(|v|), unless they come to a stop
 * within the step, where they stick if they can.
 * v  [n] in  relative velocity at the start of the step
 * Returns what tribo_step_force does. */
TRIBO_API int tribo_step_force_mean(tribo_context *ctx, double dt, const double *v, const double *vfree, double *f);

/* The box-constrained problem behind it all, min 1/2 f'Rf + a'f with lower <= f <= upper, for laws of the caller's own. Neither
 * limits nor law nor epsilon matter, nor which contacts are planar.
 * a, lower, upper  [n] in   finite, lower <= upper
 * f                [n] out
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (lower above upper), TRIBO_ERR_STATE (no operator),
 * TRIBO_ERR_NO_CONVERGENCE. */
TRIBO_API int tribo_solve_box(tribo_context *ctx, const double *a, const double *lower, const double *upper, double *f);

/* Tells that the integrator accepted a step that ended at v, feq (feq is read only where |v| <= epsilon). Advances the
 * memory of QUINN_REVERSAL: a contact is marked when |v| > epsilon, and unmarked when |v| <= epsilon and |feq| <= limit.
 * Does nothing for other laws. v, feq [n] in.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, and with QUINN_REVERSAL what tribo_force returns. */
TRIBO_API int tribo_accept(tribo_context *ctx, const double *v, const double *feq);

/* ----------------------------------------------------------------------------------------------------------- queries */

/* What a contact does: slides towards -z (f = limit), sticks, slides towards +z (f = -limit), carries nothing since its limit
 * is 0, slides in the plane. */
enum {
    TRIBO_SLIP_BACK = -1,
    TRIBO_SLIP_STUCK = 0,
    TRIBO_SLIP_FORTH = 1,
    TRIBO_SLIP_OPEN = 2,
    TRIBO_SLIP_PLANE = 3 /* both directions of a planar contact */
};

/* What each contact did in the last tribo_balance or tribo_step_force, by the limits of that call.
 * slip  [n] out  TRIBO_SLIP_...
 * Returns TRIBO_ERR_NULL, and TRIBO_ERR_STATE if there has been none that found forces, or a tribo_solve_box or
 * tribo_set_operator_... since. */
TRIBO_API int tribo_get_slip(const tribo_context *ctx, signed char *slip);

/* Counts. STUCK and RANK are those of the last tribo_balance, tribo_step_force or tribo_solve_box; ISLANDS is that of the
 * operator; the others add up since tribo_create. */
enum {
    TRIBO_COUNT_STUCK = 0,          /* contacts with slip 0; 0 where tribo_get_slip has none */
    TRIBO_COUNT_RANK = 1,           /* sum of the ranks of the matrices that the last call solved with */
    TRIBO_COUNT_ISLANDS = 2,        /* groups of coupled contacts in the operator, and single contacts */
    TRIBO_COUNT_SOLVES = 3,         /* islands that had to be solved */
    TRIBO_COUNT_SKIPPED = 4,        /* islands that needed no solver: a single contact, or none near stick */
    TRIBO_COUNT_FACTORIZATIONS = 5, /* matrices factorized */
    TRIBO_COUNT_UPDATES = 6,        /* contacts that entered or left a stick set */
    TRIBO_COUNT_REVERSALS = 7,      /* reversal marks that tribo_accept has set or cleared */
    TRIBO_COUNT_REUSED = 8,         /* of the solves: those that ended with the stick set and the factor they began with */
    TRIBO_COUNT_PLANAR = 9,         /* planar contacts */
    TRIBO_COUNT_SETTINGS = 10       /* grows with each call that changes a setting or the operator */
};
/* Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE (which). */
TRIBO_API int tribo_get_count(const tribo_context *ctx, int which, size_t *value);

/* Real quantities.
 *   RESIDUAL  of the last tribo_balance or step: the largest part of its limit by which a contact near stick misses its balance,
 *             beyond rounding of the forces. Calls that couple contacts return TRIBO_ERR_NO_CONVERGENCE where it is above 1e-6
 *   MAX_RATE  lambda, 1/time: stuck contacts relax no faster
 *   MAX_STEP  2.785/lambda, up to which rk4 is stable; HUGE_VAL if lambda = 0
 * lambda is the largest 2 limit R_ii/epsilon in the consistent coupling, and for contacts that share no body. In the partition
 * coupling it is that times the largest eigenvalue of D^-1 R, D being the diagonal of R, and half as much for the laws that are
 * dampers near v = 0 (VELOCITY_LIMITED, SMOOTH). An upper bound stands in for the eigenvalue: exact for two contacts, within 2%
 * for contacts in a row, farther away where every contact feels every other one.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE (which), TRIBO_ERR_STATE (MAX_RATE, MAX_STEP: no operator). */
enum { TRIBO_REAL_RESIDUAL = 0, TRIBO_REAL_MAX_RATE = 1, TRIBO_REAL_MAX_STEP = 2 };
TRIBO_API int tribo_get_real(const tribo_context *ctx, int which, double *value);

#ifdef __cplusplus
}
#endif

#endif
