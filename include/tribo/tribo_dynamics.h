/* SPDX-License-Identifier: BSD-3-Clause */
/* tribo's dynamics: mechanical systems with friction, and their motion in time.
 *
 * A system is M q'' + C q' + K q = p(t) + J' f,  v = J q' - b(t),  with p and b sums of harmonics and tables; f are the friction
 * forces of its contacts, by the settings of tribo_system_context, and v their relative velocities. Its state is
 *     y = q [ndof], q' [ndof], displacements of the sliders of contacts with compliance, energy dissipated by friction since t =
 *     0.
 *
 * Conventions, units and threads as in tribo.h; a system and its drivers are used by one thread at a time.
 * All functions: since 1.0, unless stated otherwise.
 */
#ifndef TRIBO_TRIBO_DYNAMICS_H
#define TRIBO_TRIBO_DYNAMICS_H

#include "tribo/tribo.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --------------------------------------------------------------------------------------------------------- models */

/* A linear structure in the units of the caller: mass, damping, stiffness, contact directions. A model copies its arguments.
 * tribo_system_create and tribo_system_reduce check the whole model; afterwards the model may be used again or destroyed. */
typedef struct tribo_model tribo_model;

/* Creates a model of ndof degrees of freedom and ncontact contacts. Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE (0, or above 2^24),
 * TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_model_create(tribo_model **model, size_t ndof, size_t ncontact);
TRIBO_API void tribo_model_destroy(tribo_model *model);

/* Text of the last failure of a call on the model, including tribo_system_create and tribo_system_reduce. model may be NULL. */
TRIBO_API const char *tribo_model_message(const tribo_model *model);

/* Set the matrices of the model, each in one of three forms; a later call for the same matrix replaces the matrix.
 * m, c, k           [ndof][ndof] in, or _diagonal [ndof] in
 * rowptr, col, val  [ndof + 1], [rowptr[ndof]] in   compressed rows, counted from 0, columns in any order; no entry twice
 * The mass must be symmetric and positive definite; a diagonal mass is fastest. A degree of freedom without mass is allowed if
 * the stiffness holds the degree of freedom. The damping is 0 if not set. Damping and stiffness need not be symmetric (gyroscopic
 * forces; loads that follow the structure); the manual lists what refuses a stiffness that is not symmetric.
 * Return TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_SIZE (rowptr), TRIBO_ERR_RANGE (col), TRIBO_ERR_DUPLICATE,
 * TRIBO_ERR_MEMORY; on error the matrix is unchanged. */
TRIBO_API int tribo_model_set_mass(tribo_model *model, const double *m);
TRIBO_API int tribo_model_set_mass_diagonal(tribo_model *model, const double *m);
TRIBO_API int tribo_model_set_mass_csr(tribo_model *model, const size_t *rowptr, const size_t *col, const double *val);
TRIBO_API int tribo_model_set_damping(tribo_model *model, const double *c);
TRIBO_API int tribo_model_set_damping_diagonal(tribo_model *model, const double *c);
TRIBO_API int tribo_model_set_damping_csr(tribo_model *model, const size_t *rowptr, const size_t *col, const double *val);
TRIBO_API int tribo_model_set_stiffness(tribo_model *model, const double *k);
TRIBO_API int tribo_model_set_stiffness_diagonal(tribo_model *model, const double *k);
TRIBO_API int tribo_model_set_stiffness_csr(tribo_model *model, const size_t *rowptr, const size_t *col, const double *val);

/* Set the contact directions J: the relative velocity of contact i is row i of J times q'.
 * j                 [ncontact][ndof] in
 * rowptr, col, val  [ncontact + 1], [rowptr[ncontact]] in   compressed rows
 * Return what tribo_model_set_mass_csr returns. */
TRIBO_API int tribo_model_set_direction(tribo_model *model, const double *j);
TRIBO_API int tribo_model_set_direction_csr(tribo_model *model, const size_t *rowptr, const size_t *col, const double *val);

/* Springs in series with the sliders of contacts (Jenkins, Masing): v = J q' + c f'.
 * c  [ncontact] in   1/stiffness of the spring, >= 0; 0: a rigid contact
 * Each c > 0 adds the displacement of the slider to the state of the system. Methods exact, event, auto, moreau/fixed. In the
 * plane (tribo_set_planar): event, auto; both directions of each planar contact have the same c > 0 and limit, constant or by
 * tribo_model_set_normal; anything else returns TRIBO_ERR_UNSUPPORTED as a motion begins.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_RANGE (1/c overflows), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_model_set_compliance(tribo_model *model, const double *c);

/* Sets the limit of a contact to mu N, N the force of a spring in the normal direction n = normal, which lifts off:
 *     N = stiffness max(0, J_n q - gap),   the bodies get -J_n' N.
 * contact    in   the contact; of a planar one (tribo_set_planar) its first direction
 * normal     in   another row of J, the normal direction, positive where the bodies press on each other. Its row in forces of
 *                 contacts is -N, without friction and compliance. Contacts that share a normal have equal stiffness and gap
 * mu         in   >= 0   coefficient of friction
 * stiffness  in   >= 0, force/displacement   normal stiffness of the contact
 * gap        in   displacement; < 0: a preload
 * Another call for the contact replaces its normal. In tribo_system_context the limits of contact and normal stay 0. An open
 * contact, N = 0, has no force; the slider of an elastic contact moves with the body, and begins at the body at touch-down.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_RANGE (no such row; normal of itself; a row that is
 * both; stiffness or gap of a shared normal differ), TRIBO_ERR_MEMORY. Yang and Menq (1998). */
TRIBO_API int tribo_model_set_normal(tribo_model *model, size_t contact, size_t normal, double mu, double stiffness, double gap);

/* Sizes; 0 for NULL. */
TRIBO_API size_t tribo_model_ndof(const tribo_model *model);
TRIBO_API size_t tribo_model_ncontact(const tribo_model *model);

/* Stores message as the model's message and returns status. For code of the caller that reads files or other matrix formats. */
TRIBO_API int tribo_model_refuse(tribo_model *model, int status, const char *message);

/* Features of a build. */
enum {
    TRIBO_FEATURE_CHOLMOD = 0 /* sparse factors: systems of many degrees of freedom with a mass matrix that is not diagonal */
};

/* Returns 1 if this build has the feature, else 0; 0 for any other int. Thread-safe. */
TRIBO_API int tribo_dynamics_has(int feature);

/* Sets matrices, springs and normals to those of a ring of equal sectors, see tribo_driver_set_ring: sector by sector, each
 * joined to the next one, the last to the first.
 * model     in/out   of sectors times m degrees of freedom and sectors times the contacts of the sector
 * sector    in       m to 2 m degrees of freedom, copied: those from m on are the first ones of the next sector, to which the
 *                    matrices are added. Damping may be missing
 * sectors   in       > 0
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE, TRIBO_ERR_STATE (a matrix of the sector is not set), TRIBO_ERR_MEMORY, and what
 * tribo_model_set_normal returns. */
TRIBO_API int tribo_model_set_ring(tribo_model *model, tribo_model *sector, size_t sectors);

/* --------------------------------------------------------------------------------------------------------- systems */

typedef struct tribo_system tribo_system;

/* Creates the system of all degrees of freedom of the model, dense or sparse as the matrices are. The context starts with Quinn's
 * law, limit 0 (all contacts open) and R = J M^-1 J'. No load and no base motion are set. Returns TRIBO_ERR_NULL,
 * TRIBO_ERR_STATE (a matrix is not set), TRIBO_ERR_SIZE, TRIBO_ERR_NOT_SYMMETRIC, TRIBO_ERR_INDEFINITE, TRIBO_ERR_UNSUPPORTED,
 * TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_create(tribo_system **sys, tribo_model *model);

/* How a reduced system represents the static displacements by contact forces that its modes do not contain. */
enum { TRIBO_STATICS_NONE = 0, TRIBO_STATICS_MASS = 1, TRIBO_STATICS_COMPLIANCE = 2 };

/* Creates the system of the nmode > 0 lowest modes of the model, with modal mass 1. The largest displacement of a mode, of
 * several equal ones the first, is positive. The damping matrix is projected on the modes; tribo_system_set_damping_ratio
 * replaces the damping. static_contacts:
 *   TRIBO_STATICS_NONE        modes only
 *   TRIBO_STATICS_MASS        adds static responses to contact forces, orthonormal in M and orthogonal in K: ndof is nmode plus
 *                             at most 1 per contact. To add the static response to a load, add a row of J with limit 0
 *   TRIBO_STATICS_COMPLIANCE  adds the static flexibility that the modes lack, as a compliance matrix of the contacts; refuses a
 *                             damping matrix
 * Returns what tribo_system_create returns, and TRIBO_ERR_RANGE (static_contacts), TRIBO_ERR_NO_CONVERGENCE. */
TRIBO_API int tribo_system_reduce(tribo_system **sys, tribo_model *model, size_t nmode, int static_contacts);

/* As tribo_system_reduce, with nmode chosen such that the error by tribo_system_get_truncation at omega is at most
 * tolerance.
 * omega      in   >= 0, rad/time   the highest frequency of interest: of the load, times the highest harmonic
 * tolerance  in   > 0
 * Returns what tribo_system_reduce returns, and TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE (omega), TRIBO_ERR_NOT_POSITIVE
 * (tolerance), TRIBO_ERR_UNSUPPORTED (the error of all modes is above tolerance). */
TRIBO_API int tribo_system_reduce_to(tribo_system **sys, tribo_model *model, double omega, double tolerance, int static_contacts);

/* Quinn's three reference systems (Quinn 2004, doi:10.1115/1.1760564), nondimensional. limits >= 0, everything finite.
 * All return TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_SIZE, TRIBO_ERR_MEMORY. */

/* x'' + x = f + alpha sin(omega t). Eq. 5. */
TRIBO_API int tribo_system_oscillator(tribo_system **sys, double limit, double alpha, double omega);

/* n >= 2 blocks on a frictional surface; the load alpha sin(omega t) acts on the first block. Fig. 8 and its equations.
 * limit is the paper's mu N_i. Mass of a block: 1/n, of the last block 3/(4 n). Limit of a contact: limit/n, of the last contact
 * 3 limit/(4 n). Stiffness of a spring: n. (The last equation of the paper, times 3/4, makes the stiffness symmetric.)
 * R_ii = n, for the last contact 4 n/3. The last entry of the state is the paper's D = (1/n) sum of the integrals of -f_i u_i',
 * where f_i is R_ii times the force of contact i. */
TRIBO_API int tribo_system_chain(tribo_system **sys, size_t n, double limit, double alpha, double omega);

/* Two blocks, the upper on the lower, the lower on a belt that moves with speed * sin(omega t): contact 0 is between belt and
 * lower block (limit1), contact 1 between the blocks (limit2); kappa is the stiffness of the upper spring. Eq. 7, Fig. 10. */
TRIBO_API int tribo_system_belt(tribo_system **sys, double kappa, double limit1, double limit2, double speed, double omega);

TRIBO_API void tribo_system_destroy(tribo_system *sys);

/* Creates an independent copy with loads, base motions, tables, and the context with its settings; e.g. one for each thread.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_clone(const tribo_system *sys, tribo_system **copy);

/* Adds a harmonic to the load, p(t) += cosine cos(omega t) + sine sin(omega t).
 * omega         in   angular frequency, rad/time
 * cosine, sine  [ndof of the matrices given] in, each or NULL; forces, also for a reduced system
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_UNSUPPORTED (a load on a degree of freedom without mass),
 * TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_add_load(tribo_system *sys, double omega, const double *cosine, const double *sine);

/* Removes all loads, harmonics and tables, also the loads of the reference systems. Base motions and limits stay.
 * Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_system_clear_loads(tribo_system *sys);

/* Adds a harmonic to the driven velocities of the contacts, b(t) += cosine cos(omega t) + sine sin(omega t), e.g. of a belt.
 * cosine, sine  [ncontact] in, each or NULL; velocities
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_add_base_motion(tribo_system *sys, double omega, const double *cosine, const double *sine);

/* Adds a load by a table, p(t) += pattern * value(t); value is linear between the knots and constant outside.
 * time     [knots] in   ascending
 * value    [knots] in
 * pattern  [ndof of the matrices given] in
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE (no knots), TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (time does not ascend),
 * TRIBO_ERR_UNSUPPORTED (a load on a degree of freedom without mass), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_add_load_table(tribo_system *sys, size_t knots, const double *time, const double *value,
                                          const double *pattern);

/* Adds base velocities by a table, b(t) += pattern * value(t), e.g. of the ground in an earthquake; value is linear between the
 * knots and constant outside.
 * time, value  [knots] in   time ascends
 * pattern      [ncontact] in
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE (no knots), TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (time does not ascend),
 * TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_add_base_table(tribo_system *sys, size_t knots, const double *time, const double *value,
                                          const double *pattern);

/* Removes all base motions, harmonics and tables. Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_system_clear_base_motion(tribo_system *sys);

/* Adds a harmonic to the limits, limit(t) = max(0, limit + cosine cos(omega t) + sine sin(omega t) + ...): mu times a varying
 * normal load. limit is set in tribo_system_context, or by tribo_system_set_limit_table. While the sum is <= 0 the contact is
 * lifted off and carries no force. At touchdown the contact slides, or sticks if its velocity is 0.
 * omega         in   angular frequency, rad/time
 * cosine, sine  [ncontact] in, each or NULL; forces
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (limits beyond 1e300), TRIBO_ERR_UNSUPPORTED (an elastic
 * contact, or one of tribo_model_set_normal), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_add_limit(tribo_system *sys, double omega, const double *cosine, const double *sine);

/* Sets the limits by a table, which replaces the limits of tribo_system_context; linear between the knots and constant outside.
 * time   [knots] in   ascending
 * limit  [knots][ncontact] in   >= 0; 0: lifted off
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE (no knots), TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_RANGE (time does not
 * ascend), TRIBO_ERR_UNSUPPORTED (an elastic contact, or one of tribo_model_set_normal), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_set_limit_table(tribo_system *sys, size_t knots, const double *time, const double *limit);

/* Removes the table and all harmonics of the limits; the limits of tribo_system_context apply again. Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_system_clear_limits(tribo_system *sys);

/* limit [ncontact] out: the limits at time t, with table and harmonics. Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE,
 * TRIBO_ERR_UNSUPPORTED (limits that follow the motion). */
TRIBO_API int tribo_system_get_limit(tribo_system *sys, double t, double *limit);

/* Reduced systems: damping ratio of every mode, C = diag(2 zeta omega_k). zeta >= 0.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_UNSUPPORTED (not reduced), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_set_damping_ratio(tribo_system *sys, double zeta);

/* Reduced systems: natural frequencies.
 * omega  [ndof] out   ascending, rad/time; infinite for the displacements without mass of TRIBO_STATICS_COMPLIANCE
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_UNSUPPORTED (not reduced). */
TRIBO_API int tribo_system_get_frequencies(const tribo_system *sys, double *omega);

/* Reduced systems: displacements of the whole structure from modal displacements.
 * reduced  [ndof] in
 * full     [ndof of the matrices given] out
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_UNSUPPORTED (not reduced). */
TRIBO_API int tribo_system_expand(const tribo_system *sys, const double *reduced, double *full);

/* Reduced systems: a bound on the error at the contacts by the modes left out.
 * omega  in   the highest frequency of interest, rad/time: of the load and its harmonics
 * error  out  for any harmonic contact forces up to omega, the part of the contact displacements that is missing, at most;
 *             relative to the work of the same forces, if steady, on the whole elastic structure. HUGE_VAL: modes with
 *             frequencies up to omega may be left out. With omega_next the first frequency left out, or a lower bound of it that
 *             is at least the last frequency kept, and x = (omega/omega_next)^2: at most x^2/(1 - x) with TRIBO_STATICS_MASS,
 *             x/(1 - x) with TRIBO_STATICS_COMPLIANCE. Loads are included only if they act at contacts
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_UNSUPPORTED (not reduced). */
TRIBO_API int tribo_system_get_truncation(const tribo_system *sys, double omega, double *error);

/* Sizes; 0 for NULL. dimension: 2 ndof + number of contacts with compliance + 1. */
TRIBO_API size_t tribo_system_ndof(const tribo_system *sys);
TRIBO_API size_t tribo_system_ncontact(const tribo_system *sys);
TRIBO_API size_t tribo_system_dimension(const tribo_system *sys);

/* The settings of the system's contacts; owned by sys. Set law, limits, epsilon, coupling, static limits and planar contacts on
 * this context, at any time between calls. The system reads the context and never writes to it: tribo_get_limit returns the
 * limits that the caller set, also if limits vary. Forces, slips and counts: tribo_system_get_force, tribo_system_get_slip,
 * tribo_system_get_count. The operator is R of the system, and fixed. Returns NULL if sys is NULL, or if the first call finds no
 * memory. */
TRIBO_API tribo_context *tribo_system_context(tribo_system *sys);

/* Text of the last failure of a call on sys, including tribo_driver_create; "" before any failure. The text belongs to sys, which
 * may be NULL. Failures of a driver: tribo_driver_message. */
TRIBO_API const char *tribo_system_message(const tribo_system *sys);

/* Relative velocities and forces of the contacts in the state y at time t.
 * y    [dimension] in
 * v, feq, f   [ncontact] out, each or NULL, as in tribo_balance; elastic contacts: feq = f = force of the spring,
 *             v = velocity of the slider, 0 while the spring holds
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_UNSUPPORTED (no accelerations), and what tribo_balance
 * returns. */
TRIBO_API int tribo_system_contacts(tribo_system *sys, double t, const double *y, double *v, double *feq, double *f);

/* Slip states at the last tribo_system_contacts, or step of central/fixed, rk4/fixed or an adaptive method. After a step of
 * another method, and in an observer, call tribo_system_contacts first.
 * slip  [ncontact] out   TRIBO_SLIP_...
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_STATE (no such call yet). */
TRIBO_API int tribo_system_get_slip(const tribo_system *sys, signed char *slip);

/* TRIBO_COUNT_... of tribo.h, for the same calls. Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE (which). */
TRIBO_API int tribo_system_get_count(const tribo_system *sys, int which, size_t *value);

/* tribo_accept for the state (t, y). Integrators other than tribo_driver call it after each accepted step.
 * Returns what tribo_system_contacts returns. */
TRIBO_API int tribo_system_accept(tribo_system *sys, double t, const double *y);

/* --------------------------------------------------------------------------------------------------------- steady sliding */

/* Finds the equilibrium of steady sliding under constant loads and bases of constant velocities (belts), and the exponents re + i
 * im of small motions about it. The manual says what rests, slides and is refused.
 * given   [ncontact] in, or NULL  TRIBO_SLIP_FORTH, _BACK: slides at its limit, also on a base at rest; _OPEN: no friction;
 *                                 0: rests, or slides on a base that moves
 * y       [dimension] in/out      in: where contacts rest, e.g. zeros; out: the equilibrium, with velocities and energy 0
 * slip    [ncontact] out, or NULL  TRIBO_SLIP_...; _OPEN also of normals
 * count   out, or NULL            number of exponents, at most 2 tribo_system_ndof; NULL: none are found
 * re, im  [count] out, or NULL    1/time, rad/time; largest re first; in a complex pair im > 0 is first
 * On error outputs are unchanged. Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (given), TRIBO_ERR_UNSUPPORTED,
 * TRIBO_ERR_INDEFINITE (nothing holds the structure), TRIBO_ERR_NO_CONVERGENCE (there is none: a contact at rest reaches its
 * limit), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_equilibrium(tribo_system *sys, const signed char *given, double *y, signed char *slip, size_t *count,
                                       double *re, double *im);

/* The parameter that a factor multiplies. */
enum {
    TRIBO_FLUTTER_FRICTION = 0, /* limits, and coefficients of friction of tribo_model_set_normal */
    TRIBO_FLUTTER_SPEED = 1     /* velocities of bases */
};

/* Finds the first factor, of 128 between from and to, at which steady sliding is not stable, and the onset before it to rounding:
 * mode coupling (Hoffmann and others 2002), limits that fall with the speed, or a loss of stiffness; to 1e-9 where a normal
 * begins to press or lifts off, and exponents jump.
 * parameter  in                     TRIBO_FLUTTER_...
 * given, y   in, each or NULL       as in tribo_system_equilibrium; y NULL: zeros
 * from, to   in                     >= 0; to may be below from; at from sliding is stable
 * critical   out                    the factor at the onset; HUGE_VAL: stable at all factors tried
 * omega      out, or NULL           frequency at the onset, rad/time; 0: no onset, or a loss of stiffness
 * Returns what tribo_system_equilibrium returns at any factor tried, TRIBO_ERR_RANGE (parameter; not stable at from),
 * TRIBO_ERR_NEGATIVE, TRIBO_ERR_NO_CONVERGENCE (no single motion is at the onset). */
TRIBO_API int tribo_system_find_flutter(tribo_system *sys, int parameter, const signed char *given, const double *y, double from,
                                        double to, double *critical, double *omega);

/* --------------------------------------------------------------------------------------------------------- drivers */

/* Derivative and Jacobian of the state, for integrators of the caller. y [dimension] in need not be finite; a derivative that is
 * not finite returns TRIBO_ERR_NOT_FINITE.
 * dydt   [dimension] out
 * dfdy   [dimension][dimension] out   derivative of dydt[i] by y[j] in row i
 * dfdt   [dimension] out   partial derivative by t, or NULL
 * Return TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_UNSUPPORTED (no mass, or no accelerations; Jacobian: static
 * limits beside limits that follow the motion), TRIBO_ERR_MEMORY (Jacobian), and what tribo_balance returns. */
TRIBO_API int tribo_system_derivative(tribo_system *sys, double t, const double *y, double *dydt);
TRIBO_API int tribo_system_jacobian(tribo_system *sys, double t, const double *y, double *dfdy, double *dfdt);

/* Forces of the contacts in the last tribo_system_derivative.
 * f   [ncontact] out
 * Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_system_get_force(const tribo_system *sys, double *f);

/* Stores text as the system's message and returns status. For integrators of the caller. */
TRIBO_API int tribo_system_set_message(tribo_system *sys, int status, const char *text);

/* Attaches data to a system. Clones do not copy attached data.
 * key      in   an address that belongs to the caller; one use per system
 * destroy  in   called with data when the system is destroyed; or NULL
 * Returns TRIBO_ERR_NULL (sys, key), TRIBO_ERR_STATE (key is in use), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_attach(tribo_system *sys, const void *key, void *data, void (*destroy)(void *data));

/* The data attached with key; NULL if there is none. */
TRIBO_API void *tribo_system_attached(const tribo_system *sys, const void *key);

typedef struct tribo_driver tribo_driver;

/* Creates a driver, which advances the state of sys by a method. The manual describes the methods and their limits.
 * sys      in/out   must live longer than the driver
 * method   in       a name, upper or lower case. With Coulomb's law: "exact", "event", "auto" (exact if possible for the system,
 *                   else event); with fixed steps "central/fixed", "moreau/fixed". With the law of the context: "rk4/fixed"
 * Methods with fixed steps need tribo_driver_set_step; all other settings have defaults.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NAME, TRIBO_ERR_MEMORY, TRIBO_ERR_UNSUPPORTED (the method cannot integrate the system);
 * details by tribo_system_message. */
TRIBO_API int tribo_driver_create(tribo_driver **drv, tribo_system *sys, const char *method);

/* Input and output of a stepper that tries a step from (t, y) to t + h. */
typedef struct {
    size_t size;             /* sizeof(tribo_trial) of the library: later versions may add members at the end */
    double t, h;             /* h > 0 */
    const double *y, *slope; /* [dimension] state, and its derivative if takes_slope = 1 */
    const double *tolerance; /* [dimension] largest error of the step */
    const double *rate;      /* [ncontact] rate, 1/time, at which a contact at rest relaxes; 0: the force jumps */
    double *to, *error;      /* [dimension] out: state at t + h, and an estimate of the error of that state */
} tribo_trial;

/* A method that tries single steps; the driver chooses h from the errors. */
typedef struct {
    size_t size;      /* sizeof(tribo_stepper) */
    const char *name; /* for messages; must live as long as the driver */
    double stable;    /* explicit method: largest h rate of a contact at rest for which the method is stable; 0: implicit */
    int takes_slope;  /* 1: step reads slope */
    /* Tries a step. Returns 0 on success. After TRIBO_ERR_STEP, TRIBO_ERR_NO_CONVERGENCE or TRIBO_ERR_NOT_FINITE the driver tries
     * a shorter step; any other status ends the advance. A trial at the t of the last trial replaces the last trial; a trial at
     * another t means that the last trial was accepted. */
    int (*step)(const tribo_trial *trial, void *data);
    double (*order)(void *data); /* the error of the next step is proportional to h^(order + 1) */
    void (*restart)(void *data); /* discards the history of steps; or NULL */
    void (*destroy)(void *data); /* frees data when the driver is destroyed; or NULL */
} tribo_stepper;

/* Creates a driver with adaptive steps by a stepper of the caller, see tribo_driver_create.
 * stepper   in   copied
 * data      in   passed to the functions of the stepper; owned by the driver after success, by the caller after an error
 * Returns what tribo_driver_create returns, and TRIBO_ERR_SIZE (stepper->size). */
TRIBO_API int tribo_driver_create_stepper(tribo_driver **drv, tribo_system *sys, const tribo_stepper *stepper, void *data);

/* Name of the method; for "auto" the name of the method in use, which each advance chooses again. NULL if drv is NULL. */
TRIBO_API const char *tribo_driver_method(const tribo_driver *drv);

/* Names of the methods, method 0 to tribo_method_count() - 1; NULL outside. */
TRIBO_API int tribo_method_count(void);
TRIBO_API const char *tribo_method_name(int method);

/* Settings may be changed between advances; the motion continues from y. All four functions return TRIBO_ERR_NULL,
 * TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE, TRIBO_ERR_NEGATIVE (reltol), TRIBO_ERR_UNSUPPORTED (the method has no such
 * setting). */

/* dt > 0: the step of a method with fixed steps; the last step of an advance is shorter if needed. Adaptive methods: the first
 * step (default: 0.001 times the shortest 1/omega of structure and loads). */
TRIBO_API int tribo_driver_set_step(tribo_driver *drv, double dt);

/* Largest error of a step of event, auto or an adaptive method: abstol + reltol * scale, with scale the largest displacement for
 * displacements, the largest velocity for velocities, the energy for the energy.
 * abstol   in   > 0, in the units of y. Default: event 1e-12 times the motion within the shortest 1/omega; adaptive 1e-12
 * reltol   in   >= 0. Default: adaptive 1e-8 */
TRIBO_API int tribo_driver_set_tolerance(tribo_driver *drv, double abstol, double reltol);

/* exact, event, auto: calls the observer also every dt > 0 from the start of an advance. Default: no such calls. */
TRIBO_API int tribo_driver_set_output(tribo_driver *drv, double dt);

/* The largest step of an adaptive method, h > 0; HUGE_VAL: no bound. Default: 0.1 times the shortest 1/omega of structure and
 * loads. While all contacts rest, a step may miss events; use a longer h only with implicit methods, on structures with high
 * frequencies of no interest. Steps also end at the knots of tables. */
TRIBO_API int tribo_driver_set_max_step(tribo_driver *drv, double h);

/* Integrates from *t to t1 >= *t. Between calls y, the system, its loads and its context may be changed.
 * t  in/out   time
 * y  [dimension] in/out   state
 * On error t and y hold the last good step, always finite (central/fixed without an observer: velocities and energy half a step
 * before t). Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE (also if the motion grows without bound), TRIBO_ERR_RANGE (t1 < t),
 * TRIBO_ERR_STATE (no step was set), TRIBO_ERR_STOPPED, TRIBO_ERR_STEP (a step below the resolution of t, or an unstable dt),
 * TRIBO_ERR_CHATTER, TRIBO_ERR_UNSUPPORTED (the method cannot integrate the system, or the closed form has less than two digits),
 * TRIBO_ERR_INDEFINITE (matrix of a step of moreau/fixed, or of exact), TRIBO_ERR_MEMORY, and what tribo_balance returns. */
TRIBO_API int tribo_driver_advance(tribo_driver *drv, double *t, double t1, double *y);

/* A moment of the motion, passed to an observer. Valid during the call. */
typedef struct {
    size_t size;     /* sizeof(tribo_moment) of the library: later versions may add members at the end */
    double t;        /* time */
    const double *y; /* [dimension] state */
    int kind;        /* TRIBO_MOMENT_... */
    size_t contact;  /* index of the contact that changes; SIZE_MAX for TRIBO_MOMENT_STEP */
} tribo_moment;

enum {
    TRIBO_MOMENT_STEP = 0,    /* end of a step, output, end of an advance, or an event without a change of a contact */
    TRIBO_MOMENT_STICK = 1,   /* a contact comes to rest */
    TRIBO_MOMENT_SLIP = 2,    /* a contact breaks away */
    TRIBO_MOMENT_REVERSE = 3, /* the direction of sliding turns without rest */
    TRIBO_MOMENT_LIFT = 4,    /* the limit falls to 0 */
    TRIBO_MOMENT_TOUCH = 5    /* the limit rises from 0 */
};

/* Sets the observer: seen is called at every moment. exact, event and auto: at an event one call per contact that changes, in
 * ascending order, with the same t and y (a planar contact by its first direction); TRIBO_MOMENT_STEP at the end of the advance
 * and every dt of tribo_driver_set_output. Other methods: TRIBO_MOMENT_STEP after each step.
 * seen   in   returns 0 to continue. Any other value ends the advance with TRIBO_ERR_STOPPED; the next advance continues with
 *             the next moment. Must not change the system; may call tribo_system_contacts. NULL: no observer
 * data   in   passed to seen
 * Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_driver_set_observer(tribo_driver *drv, int (*seen)(const tribo_moment *moment, void *data), void *data);

/* Finds a state at t to which the motion returns after a period: the steady response without the transient. Methods exact,
 * event, auto. The manual describes the accuracy, and which of several motions is found. The search does not call the observer.
 * t        in       time at which the period begins
 * period   in       > 0; the period of the loads to 12 digits (2 pi/omega in double precision), or a multiple
 * y        [dimension] in/out   in: a guess, e.g. zeros; out: the state, with energy 0; unchanged on error
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE, TRIBO_ERR_STEP (a period below the resolution of t),
 * TRIBO_ERR_RANGE (a load or base motion without this period), TRIBO_ERR_UNSUPPORTED (other methods; tables; static limits
 * together with degrees of freedom without mass), TRIBO_ERR_NO_CONVERGENCE, and what tribo_driver_advance returns. */
TRIBO_API int tribo_driver_find_periodic(tribo_driver *drv, double t, double period, double *y);

/* Declares a ring of equal sectors under loads that travel, as of a bladed disk: tribo_driver_find_periodic then finds the motion
 * with x_j+1(t) = x_j(t - order period/sectors), x_j: degrees of freedom of sector j, by a part of the period and of the sectors,
 * in a sixth to a thirtieth of the time (Petrov 2004). What is asked about the motion, also the multipliers, is that of the whole
 * ring. Degrees of freedom and contacts are numbered sector by sector, in each in the same order.
 * sectors   in   a divisor of ndof and ncontact; 0 or 1: no ring
 * order     in   engine order: turns of the load around the ring in a period
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE, TRIBO_ERR_UNSUPPORTED (other methods), TRIBO_ERR_MEMORY. tribo_driver_find_periodic
 * then returns TRIBO_ERR_RANGE also if limits differ between sectors, matrices do by 1e-12 of the largest entry, or a load, base
 * motion or limit does not travel, to 1e-11; TRIBO_ERR_UNSUPPORTED for reduced systems, degrees of freedom without mass, limits
 * that follow the motion, static limits and planar contacts. */
TRIBO_API int tribo_driver_set_ring(tribo_driver *drv, size_t sectors, size_t order);

/* Finds a cycle: a periodic motion, and its period, of a system in which no load, base motion or limit depends on time (constant
 * ones may act), as stick-slip and squeal, stable or not. Methods exact, event, auto. The search does not call the observer. One
 * multiplier of a cycle is 1, of the motion along it: the others say whether it is stable. Its freedom is at least 1.
 * t        in       time at which the period begins
 * period   in/out   in: >= 0; a guess, or a multiple up to 16 times, or 0: none; out: the smallest period; unchanged on error
 * y        [dimension] in/out   in: a guess, no equilibrium; out: the state, with energy 0, as the contact of lowest index
 *                   that breaks away does so, after its longest rest; or, if none does, any; unchanged on error
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE (period < 0, or 0 of a structure without stiffness),
 * TRIBO_ERR_STEP (a period below the resolution of t), TRIBO_ERR_UNSUPPORTED (what depends on time, named; and as
 * tribo_driver_find_periodic), TRIBO_ERR_NO_CONVERGENCE (also where the motion comes to rest), and what tribo_driver_advance
 * returns. */
TRIBO_API int tribo_driver_find_cycle(tribo_driver *drv, double t, double *period, double *y);

/* Finds a nonlinear mode: a periodic motion without loads, of an amplitude, in which a change of the damping from C to C - 2
 * delta M makes up for what friction and damping dissipate (extended periodic motion concept, Krack 2015). Loads and base motions
 * that depend on time do not act, constant ones do. omega and zeta = delta/omega over the amplitude are what vibration tests
 * measure of a joint. Methods exact, event, auto. The questions about periodic motions are about the mode then. The period begins
 * at t = 0. Near another branch of modes the search may end at that; tribo_driver_follow_curve stays on one.
 * c          [2 ndof] in      coefficients of a signal c'[q, q'], of degrees of freedom with mass
 * amplitude  in               > 0; of the signal at the beginning of the period, where its rate is 0
 * omega      in/out           in: >= 0, a guess, or 0 for the lowest mode; out: 2 pi/period; unchanged on error, as zeta and y
 * zeta       in/out           in: a guess; out: the damping ratio, < 0 of a structure that vibrates by itself
 * y          [dimension] in/out   in: the state of a guess, or zeros: from the linear mode nearest to omega; out: the state
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE, TRIBO_ERR_RANGE (c), TRIBO_ERR_UNSUPPORTED (limits in
 * time; tables; as tribo_driver_find_periodic), TRIBO_ERR_NO_CONVERGENCE, and what tribo_driver_advance returns. */
TRIBO_API int tribo_driver_find_mode(tribo_driver *drv, const double *c, double amplitude, double *omega, double *zeta,
                                     double *y);

/* Floquet multipliers re + i im of the last periodic motion found, largest modulus first; in a complex pair im > 0 is first.
 * re, im   [dimension - 1] out
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_MEMORY, TRIBO_ERR_NO_CONVERGENCE, TRIBO_ERR_STATE (no search yet, or the last search failed;
 * with elastic contacts, or of a ring: the system has changed since), TRIBO_ERR_UNSUPPORTED (contacts that act on each other stop
 * or break away at one instant, a normal rests at depth 0, or the force of an elastic contact only touches its limit: the motion
 * nearby is not linear; the message names the contact). */
TRIBO_API int tribo_driver_get_multipliers(const tribo_driver *drv, double *re, double *im);

/* The dimension of the family of periodic motions around the last periodic motion found: a contact that never slips can rest at
 * any displacement within its limit. 0: the motion is isolated.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_STATE (as tribo_driver_get_multipliers), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_driver_get_freedom(const tribo_driver *drv, size_t *freedom);

/* Quantities of the last periodic motion found, in closed form from event to event. The system must be unchanged since.
 * c                    [2 ndof] in      coefficients of a signal c'[q, q']
 * least, most          out              extremes of the signal
 * at_least, at_most    out, or NULL     times of the extremes in the period from t
 * k                    in               harmonic cosine cos(k 2 pi t/period) + sine sin(k 2 pi t/period); 0: cosine is the mean
 * cosine, sine         out
 * energy               [ncontact] out   energy dissipated in a period; of planar contacts along each direction
 * share                [ncontact] out   part of the period, 0 to 1, in which the contact is at rest
 * Return TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE (c), TRIBO_ERR_STATE (no motion found, or the system changed), TRIBO_ERR_MEMORY,
 * TRIBO_ERR_STEP (extremes: a motion too fast to be followed), TRIBO_ERR_UNSUPPORTED (extremes, harmonic by exact: a load in
 * resonance with a mode of almost no damping). */
TRIBO_API int tribo_driver_period_extremes(tribo_driver *drv, const double *c, double *least, double *most, double *at_least,
                                           double *at_most);
TRIBO_API int tribo_driver_period_harmonic(tribo_driver *drv, const double *c, size_t k, double *cosine, double *sine);
TRIBO_API int tribo_driver_period_dissipation(tribo_driver *drv, double *energy);
TRIBO_API int tribo_driver_period_stick(tribo_driver *drv, double *share);

/* A parameter of the system. */
enum {
    TRIBO_PARAMETER_LIMIT = 0,     /* the limit of contact `index` */
    TRIBO_PARAMETER_LOADS = 1,     /* a factor of all loads and base motions, at 1 */
    TRIBO_PARAMETER_FREQUENCY = 2, /* a factor of all frequencies, at 1; base motions keep their displacements */
    TRIBO_PARAMETER_DAMPING = 3,   /* a factor of the damping matrix, at 1 */
    TRIBO_PARAMETER_LIMITS = 4,    /* curves: a factor of all limits, at 1; none may follow a normal load */
    TRIBO_PARAMETER_AMPLITUDE = 5, /* curves: the amplitude of a nonlinear mode */
    TRIBO_PARAMETER_SWING = 6,     /* curves: a factor of the loads and base motions that change in time, at 1 */
    TRIBO_PARAMETER_BASES = 7      /* curves: a factor of all base motions, at 1 */
};

/* Derivatives of the last periodic motion found by parameters, in closed form along its events. The system must be unchanged
 * since.
 * kind         [count] in                  TRIBO_PARAMETER_...; those of curves are refused
 * index        [count] in                  contacts of TRIBO_PARAMETER_LIMIT; not read for other kinds
 * c            [2 ndof] in, or NULL        as in tribo_driver_period_extremes; read for extremes
 * extremes     [count][2] out, or NULL     derivatives of least and most of tribo_driver_period_extremes
 * energy       [count][ncontact] out, or NULL   derivatives of the energies of tribo_driver_period_dissipation
 * y            [count][dimension] out, or NULL  derivatives of the state at the start; by the frequency at constant t/period
 * Returns what tribo_driver_period_extremes returns, TRIBO_ERR_SIZE (count 0), TRIBO_ERR_RANGE (kind, index),
 * TRIBO_ERR_NO_CONVERGENCE (the motion is not isolated), TRIBO_ERR_UNSUPPORTED: see the manual. */
TRIBO_API int tribo_driver_period_derivatives(tribo_driver *drv, size_t count, const int *kind, const size_t *index,
                                              const double *c, double *extremes, double *energy, double *y);

/* Derivatives of a multiplier of the last periodic motion found by parameters, in closed form along its events. The system must
 * be unchanged since.
 * which        in               the multiplier, in the order of tribo_driver_get_multipliers
 * kind         [count] in       TRIBO_PARAMETER_...; those of curves are refused
 * index        [count] in       contacts of TRIBO_PARAMETER_LIMIT; not read for other kinds
 * re, im       [count] out      derivatives of the real and the imaginary part
 * Returns what tribo_driver_period_derivatives returns, TRIBO_ERR_RANGE (which), TRIBO_ERR_UNSUPPORTED also for multipliers that
 * are repeated or 0 within rounding, limits that change, and bases that move. */
TRIBO_API int tribo_driver_multiplier_derivatives(tribo_driver *drv, size_t which, size_t count, const int *kind,
                                                  const size_t *index, double *re, double *im);

/* The motions of a curve. */
enum {
    TRIBO_MOTION_PERIODIC = 0, /* of tribo_driver_find_periodic */
    TRIBO_MOTION_CYCLE = 1,    /* of tribo_driver_find_cycle */
    TRIBO_MOTION_MODE = 2      /* of tribo_driver_find_mode */
};

/* Points of a curve. Changes are named along the curve. */
enum {
    TRIBO_POINT_REGULAR = 0,
    TRIBO_POINT_FOLD = 1,   /* the curve turns back: a multiplier 1, or a change of the sequence of events of `contact` */
    TRIBO_POINT_FLIP = 2,   /* a multiplier -1: motions of twice the period begin */
    TRIBO_POINT_TORUS = 3,  /* a complex pair of multipliers of modulus 1 (Neimark-Sacker) */
    TRIBO_POINT_BRANCH = 4, /* a multiplier 1, and the curve goes on: another curve crosses, as where symmetry is lost */
    TRIBO_POINT_STICK = 5,  /* `contact` begins to stick, once more a period */
    TRIBO_POINT_SLIDE = 6,  /* `contact` ceases to stick, once more a period */
    TRIBO_POINT_GRAZE = 7,  /* `contact` begins or ceases to touch, to lift off or to reverse */
    TRIBO_POINT_ORDER = 8,  /* events of several contacts change their order */
    TRIBO_POINT_REST = 9    /* a cycle shrinks to a state of rest (Hopf); the curve ends there */
};

/* A curve of periodic motions over a parameter, followed around its turns by pseudo-arc-length (Keller 1977); steps become
 * shorter where the curve bends. Methods exact, event, auto. The curve begins with the motion of the system as it is: there the
 * parameter is 1, or the limit, or the amplitude. Special points are located to 1e-8 of the parameter. The system stays
 * unchanged. Within the observer the questions about periodic motions are about the point; searches and advances are not allowed
 * there. Base motions of constant speed are part of TRIBO_PARAMETER_LOADS, and unchanged by TRIBO_PARAMETER_FREQUENCY. */
typedef struct {
    size_t size;        /* sizeof(tribo_curve) */
    int motion;         /* TRIBO_MOTION_... */
    int parameter;      /* TRIBO_PARAMETER_... */
    size_t index;       /* the contact of TRIBO_PARAMETER_LIMIT */
    double least, most; /* the curve ends where the parameter leaves [least, most] */
    double step;        /* largest step of the parameter between points; < 0: the curve begins downwards */
    size_t points;      /* the curve ends with the step in which this number of points is seen; 0: 10000 */
    int coarse;         /* 1: changes of the sequence of events are passed, not located, unless the curve turns there */
    double amplitude;   /* modes: of the first motion */
    const double *c;    /* modes: [2 ndof] coefficients of the signal of tribo_driver_find_mode; else NULL */
} tribo_curve;

/* A point of a curve, passed to an observer. Valid during the call. */
typedef struct {
    size_t size;      /* sizeof(tribo_curve_point) of the library: later versions may add members at the end */
    double parameter; /* value of the parameter */
    double t, period; /* start of the period, and its length */
    double zeta;      /* modes: damping ratio; else 0 */
    const double *y;  /* [dimension] state at t, with energy 0 */
    int kind;         /* TRIBO_POINT_... */
    size_t contact;   /* contact, or row of a normal, of which the sequence of events changes; SIZE_MAX: no single one changes */
    int stable;       /* 1: no multiplier outside of the unit circle; 0: unstable; -1: not known, as of modes */
} tribo_curve_point;

/* Follows a curve.
 * t        in       time at which the first period begins; by the frequency t/period stays constant; modes: not read
 * period   in/out   in: as in tribo_driver_find_periodic, tribo_driver_find_cycle; modes: a guess or 0; out: of the last point
 * y        [dimension] in/out   in: a guess; out: the state of the last point. Of cycles the period begins between events
 * seen     in       called at each point; returns 0 to continue, another value to end with TRIBO_ERR_STOPPED; NULL: none
 * data     in       passed to seen
 * On error period and y hold the last point seen, or are unchanged.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE (curve->size), TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (motion, parameter, index; the
 * first value is outside of the range), TRIBO_ERR_NOT_POSITIVE (step 0, least), TRIBO_ERR_UNSUPPORTED (parameter of another
 * motion, or limits that follow normal loads), TRIBO_ERR_STOPPED, TRIBO_ERR_NO_CONVERGENCE (no first motion; or the curve ends,
 * as where motions jump), and what the searches return. */
TRIBO_API int tribo_driver_follow_curve(tribo_driver *drv, const tribo_curve *curve, double t, double *period, double *y,
                                        int (*seen)(const tribo_curve_point *point, void *data), void *data);

/* Counts since creation. tribo_driver_count returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE. */
enum {
    TRIBO_COUNT_STEPS = 100,       /* accepted steps */
    TRIBO_COUNT_REJECTED = 101,    /* rejected steps */
    TRIBO_COUNT_EVALUATIONS = 102, /* evaluations of the right-hand side */
    TRIBO_COUNT_JACOBIANS = 103,   /* evaluations of the Jacobian of the right-hand side */
    TRIBO_COUNT_EVENTS = 104,      /* events located */
    TRIBO_COUNT_PERIODS = 105,     /* periods integrated by tribo_driver_find_periodic, rounded up for each search */
    TRIBO_COUNT_NEWTON = 106,      /* Newton steps of tribo_driver_find_periodic */
    TRIBO_COUNT_RESTED = 107       /* degrees of freedom at rest that steps skipped */
};
TRIBO_API int tribo_driver_count(const tribo_driver *drv, int which, size_t *value);

/* exact, event and auto: bounds on the violation of Coulomb's law over the whole motion since creation. */
enum {
    TRIBO_REAL_EXCESS = 100,  /* the largest force of a contact at rest beyond its limit */
    TRIBO_REAL_BACKSLIP = 101 /* the largest velocity of a sliding contact against its direction of sliding */
};
/* Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE, TRIBO_ERR_UNSUPPORTED (other methods). */
TRIBO_API int tribo_driver_real(const tribo_driver *drv, int which, double *value);

/* Text of the last failure of a call on drv; "" before any failure. */
TRIBO_API const char *tribo_driver_message(const tribo_driver *drv);

TRIBO_API void tribo_driver_destroy(tribo_driver *drv);

#ifdef __cplusplus
}
#endif

#endif
