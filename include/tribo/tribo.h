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

/* n contact elements, no context: two tangential springs that end in a slider, and a normal spring that lifts off (Yang and
 * Menq 1998).
 * Pressed, depth > 0: load = normal depth, limit = mu load, both at the end of the step, f = (f_t, -load) with f_t as in
 * tribo_elastic_force_planar. Open: f = 0, the slider goes along. A step that begins open takes all of dz as if pressed.
 * dz [n][2]            in      tangential displacement since f, the force of the last accepted state
 * depth [n]            in      penetration at the end of the step, positive presses
 * tangential, normal   [n] in  stiffness, >= 0
 * mu [n]               in      coefficient of friction, >= 0
 * f [n][3]             in/out  force: two tangential directions, normal direction; 0 to begin with
 * df [n][3][3]         out, or NULL   derivative of f by (dz, depth); where an element slides it is not symmetric
 * Bodies get J' f; the third row of J gives depth. Thread-safe. Returns what tribo_elastic_force returns. */
TRIBO_API int tribo_contact_force(size_t n, const double *dz, const double *depth, const double *tangential, const double *normal,
                                  const double *mu, double *f, double *df);

/* -------------------------------------------------------------------------------------------------------- contexts */

/* A set of contacts with their law, limits, epsilon, operator R, solver memory and workspace. */
typedef struct tribo_context tribo_context;

/* A context for ncontact contacts (0 is fine): Quinn's law, limit 0, epsilon 1e-6, consistent coupling, and no operator. Calls
 * that need one return TRIBO_ERR_STATE before it is set. Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE, TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_create(tribo_context **ctx, size_t ncontact);

/* A copy with the same settings, operator and memory; both share the storage of the operator. Thread-safe.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_MEMORY. */
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

/* Law of all contacts; clears the reversal memory. Returns TRIBO_ERR_RANGE (no such law), TRIBO_ERR_UNSUPPORTED (VELOCITY_LIMITED
 * and SMOOTH with static limits that drop at once). */
TRIBO_API int tribo_set_law(tribo_context *ctx, int law);
TRIBO_API int tribo_get_law(const tribo_context *ctx, int *law);

/* Limits mu*N. limit [n] in, finite and >= 0; 0: the contact is open, carries no force and costs nothing.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE; on error all limits stay as they were. */
TRIBO_API int tribo_set_limit(tribo_context *ctx, const double *limit);
TRIBO_API int tribo_set_limit_all(tribo_context *ctx, double limit);
TRIBO_API int tribo_get_limit(const tribo_context *ctx, double *limit);

/* The limits that normal loads give: limit = mu max(load, 0). mu [n] in, finite and >= 0; load [n] in, finite: where it is 0 or
 * negative the contact has lifted off, and is open. Returns as tribo_set_limit; limits beyond 1e300 are cut to it. */
TRIBO_API int tribo_set_normal_load(tribo_context *ctx, const double *mu, const double *load);

/* Static friction above kinetic. Contacts at rest hold up to ratio*limit; contacts that slide carry limit, or, with velocities
 * (Stribeck), N(|v|) = limit (1 + (ratio - 1) exp(-|v|/velocity)). The manual has the rule by which coupled contacts break away.
 * ratio     [n] in, or NULL   static limit over limit, finite and >= 1; NULL: no static friction
 * velocity  [n] in, or NULL   > 0; NULL: the limit drops at once
 * Both directions of a planar contact need the same ratio and velocity.
 * Returns TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (a ratio below 1; directions of a planar contact differ), TRIBO_ERR_NOT_POSITIVE
 * (velocity), TRIBO_ERR_UNSUPPORTED (VELOCITY_LIMITED and SMOOTH need velocities); on error all stays as it was. */
TRIBO_API int tribo_set_static(tribo_context *ctx, const double *ratio, const double *velocity);

/* ratio, velocity [n] out, each or NULL: 1 and 0 where nothing was set. Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_get_static(const tribo_context *ctx, double *ratio, double *velocity);

/* Velocity scale of the regularized laws. epsilon [n] in, > 0, in units of v.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE; on error all stays as it was. */
TRIBO_API int tribo_set_epsilon(tribo_context *ctx, const double *epsilon);
TRIBO_API int tribo_set_epsilon_all(tribo_context *ctx, double epsilon);

/* Sets epsilon by the rate lambda = lambda_dt/dt at which stuck contacts relax: epsilon_i = 2 limit_i R_ii dt/lambda_dt, which
 * follows limits and operator.
 * dt         in  time step of the caller's integrator, > 0
 * lambda_dt  in  > 0; 0.1 to 1 is best, rk4 is stable to 2.785
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE. tribo_get_epsilon: epsilon [n] out; TRIBO_ERR_STATE as
 * long as epsilon follows an operator that is not set. */
TRIBO_API int tribo_set_epsilon_step(tribo_context *ctx, double dt, double lambda_dt);
TRIBO_API int tribo_get_epsilon(const tribo_context *ctx, double *epsilon);

/* Planar contacts: directions first[k] and first[k] + 1 are the two tangential directions of one contact; their force lies in the
 * ellipse with the semi-axes limit and, sliding, is f = -limit^2 v/|limit v| by direction. All other contacts stay scalar; arrays
 * keep one entry a direction. The manual says what laws, epsilon and sharing mean in the plane.
 * first  [count] in   count 0: there are none
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE (first; static limits that differ), TRIBO_ERR_DUPLICATE (a direction of two contacts),
 * TRIBO_ERR_UNSUPPORTED (partition coupling; more than 2048 coupled directions; masses that need more digits),
 * TRIBO_ERR_MEMORY; on error all stays as it was. */
TRIBO_API int tribo_set_planar(tribo_context *ctx, size_t count, const size_t *first);

/* The operator R of z'' = R f + a, in one of five forms; on error the old one stays. All return TRIBO_ERR_NULL,
 * TRIBO_ERR_NOT_FINITE, TRIBO_ERR_MEMORY, TRIBO_ERR_UNSUPPORTED (a fixed operator; planar contacts, see tribo_set_planar), and
 * what stands below. R_ii = 0: friction cannot move contact i, which carries -limit sgn(a_i) at rest. */

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

/* R = J diag(inverse_mass) J', v = J u. Bodies of very different masses are told apart to more digits than in the other forms.
 * inverse_mass      [ndof] in   >= 0; 0: the motion is prescribed
 * rowptr, col, val  in   J [n][ndof] in compressed rows
 * Returns also TRIBO_ERR_NEGATIVE (inverse_mass), TRIBO_ERR_RANGE (col), TRIBO_ERR_SIZE, TRIBO_ERR_DUPLICATE,
 * TRIBO_ERR_UNSUPPORTED (masses that differ by more than the solver resolves: 1e18, 1e10 in groups of more than 256 contacts). */
TRIBO_API int tribo_set_operator_mass(tribo_context *ctx, size_t ndof, const double *inverse_mass, const size_t *rowptr,
                                      const size_t *col, const double *val);

/* R = J M^-1 J' for a mass matrix that only the caller can solve with; J [n][ndof] in compressed rows. Entries of R below 1e-17
 * of the diagonal are dropped.
 * apply  in  called once a contact: acceleration [ndof] out = M^-1 force [ndof] in, to 1e-11, data being handed on; must not
 *            change ctx; answers 0, or another value to end the call (TRIBO_ERR_CALLBACK)
 * Returns also what tribo_set_operator_csr returns, of J and of the R that apply makes. */
TRIBO_API int tribo_set_operator_callback(tribo_context *ctx, size_t ndof,
                                          int (*apply)(size_t ndof, const double *force, double *acceleration, void *data),
                                          void *data, const size_t *rowptr, const size_t *col, const double *val);

/* Fixes the operator: from here on tribo_set_operator_... return TRIBO_ERR_UNSUPPORTED. That of a clone can be changed.
 * Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_fix_operator(tribo_context *ctx);

/* How f_eq of contacts that share bodies is found.
 *   CONSISTENT  balances the forces that the other contacts carry: f = law(v, f_eq). Coulomb's law at v = 0. Beyond the paper.
 *   PARTITION   R_SS f_eq = -(a_S + R_SL f_L), S: contacts with |v| <= epsilon, L: the others. The paper, Eq. 8 to 10.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE, TRIBO_ERR_UNSUPPORTED (PARTITION with planar contacts). */
enum { TRIBO_CONSISTENT = 0, TRIBO_PARTITION = 1 };
TRIBO_API int tribo_set_coupling(tribo_context *ctx, int coupling);
TRIBO_API int tribo_get_coupling(const tribo_context *ctx, int *coupling);

/* Which forces redundant contacts get: where R is singular, R f is unique and f is not.
 *   LEAST_NORM  least sum of f_i^2; depends neither on the order of the contacts nor on earlier calls
 *   PREVIOUS    near the forces of the last call; follows slow changes without jumps
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE. */
enum { TRIBO_SHARE_LEAST_NORM = 0, TRIBO_SHARE_PREVIOUS = 1 };
TRIBO_API int tribo_set_sharing(tribo_context *ctx, int sharing);
TRIBO_API int tribo_get_sharing(const tribo_context *ctx, int *sharing);

/* ---------------------------------------------------------------------------------------------------------- forces */

/* Friction force of every contact from its law, f_eq being known. The paper, Eq. 4.
 * v    [n] in   relative velocity
 * feq  [n] in   balancing force; read only where |v| <= epsilon
 * f    [n] out  friction force, |f| <= limit
 * Thread-safe. Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_STATE (tribo_set_epsilon_step, and no operator),
 * TRIBO_ERR_NO_CONVERGENCE (planar contacts). */
TRIBO_API int tribo_force(const tribo_context *ctx, const double *v, const double *feq, double *f);

/* The same with derivatives of scalar contacts; one-sided at a kink. df_dlimit includes an epsilon that follows the limit.
 * f, df_dv, df_dfeq, df_dlimit  [n] out, each or NULL
 * Thread-safe. Returns what tribo_force returns, and TRIBO_ERR_UNSUPPORTED (planar contacts: tribo_force_tangent_planar). */
TRIBO_API int tribo_force_tangent(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv,
                                  double *df_dfeq, double *df_dlimit);

/* The same where contacts may be planar, with 2x2 blocks of derivatives.
 * f                           [n] out, or NULL
 * df_dv, df_dfeq, df_dlimit   [n][2] out, each or NULL; planar contact: row i is the derivative of f_i by the first and
 *                             the second direction; scalar contact: its derivative, 0
 * Thread-safe. Returns what tribo_force returns. */
TRIBO_API int tribo_force_tangent_planar(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv,
                                         double *df_dfeq, double *df_dlimit);

/* f_eq and f of coupled contacts, z'' = R f + a.
 * v    [n] in   relative velocity
 * a    [n] in   relative acceleration without friction (minus the contact's driven acceleration)
 * feq  [n] out  or NULL; 0 for open contacts
 * f    [n] out  or NULL; |f| <= limit
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_STATE (no operator), TRIBO_ERR_NO_CONVERGENCE,
 * TRIBO_ERR_INCONSISTENT. */
TRIBO_API int tribo_balance(tribo_context *ctx, const double *v, const double *a, double *feq, double *f);

/* The same, and the derivatives of f by v and a, for Newton's method of an implicit integrator; one-sided at a kink.
 * df_dv, df_da  [n][n] out, each or NULL; row i is the derivative of f_i; not written on TRIBO_ERR_INCONSISTENT
 * Returns what tribo_balance returns. */
TRIBO_API int tribo_balance_tangent(tribo_context *ctx, const double *v, const double *a, double *feq, double *f, double *df_dv,
                                    double *df_da);

/* Product of these derivatives with a change of v and a, df = df_dv dv + df_da da, at the point of the last
 * tribo_balance_tangent, whose matrices may be NULL. In O(s^2) for s coupled contacts near stick.
 * dv, da  [n] in   each or NULL for none
 * df      [n] out
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_STATE (no tribo_balance_tangent, or another balance or setting
 * since). */
TRIBO_API int tribo_tangent_product(tribo_context *ctx, const double *dv, const double *da, double *df);

/* The same for a change of limits, df = df_dlimit dlimit, in which an epsilon that follows the limit takes part.
 * dlimit  [n] in   counts as 0 where limit is 0
 * df      [n] out
 * Returns what tribo_tangent_product returns, and TRIBO_ERR_UNSUPPORTED with static limits (tribo_set_static). */
TRIBO_API int tribo_limit_product(tribo_context *ctx, const double *dlimit, double *df);

/* Coulomb's law over one time step, without epsilon: the constant force f that leaves every contact at rest or sliding against f
 * at the end of the step, v_end = vfree + dt R f. Moreau (1988); Jean and Moreau (1992). First order; with static limits prefer
 * tribo_step_force_mean.
 * dt     in       step, > 0
 * vfree  [n] in   relative velocity at the end of the step without friction
 * f      [n] out  friction force, |f| <= limit
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE (dt), TRIBO_ERR_STATE (no operator),
 * TRIBO_ERR_NO_CONVERGENCE. */
TRIBO_API int tribo_step_force(tribo_context *ctx, double dt, const double *vfree, double *f);

/* The same to second order also where sliding turns or reverses within the step, in up to two solutions: planar contacts slide
 * along v + v_end, scalar ones carry their limit one way until v = 0 and the other way after. First order with static limits,
 * which contacts that come in sliding have lost.
 * v  [n] in  relative velocity at the start of the step
 * Returns what tribo_step_force returns. */
TRIBO_API int tribo_step_force_mean(tribo_context *ctx, double dt, const double *v, const double *vfree, double *f);

/* min 1/2 f'Rf + a'f with lower <= f <= upper, for laws of the caller's own. Settings other than the operator do not matter.
 * a, lower, upper  [n] in   finite, lower <= upper
 * f                [n] out
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (lower above upper), TRIBO_ERR_STATE (no operator),
 * TRIBO_ERR_NO_CONVERGENCE. */
TRIBO_API int tribo_solve_box(tribo_context *ctx, const double *a, const double *lower, const double *upper, double *f);

/* Advances the memory of QUINN_REVERSAL after an accepted step that ended at v, feq: a contact is marked where |v| > epsilon, and
 * unmarked where |v| <= epsilon and |feq| <= limit. Other laws have no memory.
 * v, feq  [n] in   feq is read only where |v| <= epsilon
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
 *   RESIDUAL  of the last tribo_balance or step: largest error of a contact's balance over its limit, beyond rounding
 *   MAX_RATE  lambda, 1/time: the rate at which stuck contacts relax, or a bound of it in the partition coupling
 *   MAX_STEP  2.785/lambda, up to which rk4 is stable; HUGE_VAL if lambda = 0
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE (which), TRIBO_ERR_STATE (MAX_RATE, MAX_STEP: no operator). */
enum { TRIBO_REAL_RESIDUAL = 0, TRIBO_REAL_MAX_RATE = 1, TRIBO_REAL_MAX_STEP = 2 };
TRIBO_API int tribo_get_real(const tribo_context *ctx, int which, double *value);

#ifdef __cplusplus
}
#endif

#endif
