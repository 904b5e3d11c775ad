/* tribo's dynamics: mechanical systems with friction, and their motion in time.
 *
 * A system is M q'' + C q' + K q = p(t) + J' f,  v = J q' - b(t),  with p and b sums of harmonics and tables; f are the friction
 * forces of its contacts, by the settings of tribo_system_context, and v their relative velocities. Its state is
 *     y = q [ndof], q' [ndof], displacements of the sliders of contacts with compliance, energy dissipated by friction since t = 0.
 *
 * Conventions, units and threads as in tribo.h; a system and its drivers belong to one thread.
 * All functions: since 1.0, unless said otherwise.
 */
#ifndef TRIBO_TRIBO_DYNAMICS_H
#define TRIBO_TRIBO_DYNAMICS_H

#include "tribo/tribo.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --------------------------------------------------------------------------------------------------------- models */

/* A linear structure as given, in the caller's units: mass, damping, stiffness, the directions of its contacts. A model copies its
 * arguments, is looked at as a whole when a system is made of it, may make several systems, and may be destroyed then. */
typedef struct tribo_model tribo_model;

/* A model of ndof degrees of freedom and ncontact contacts. Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE (none, or above 2^24),
 * TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_model_create(tribo_model **model, size_t ndof, size_t ncontact);
TRIBO_API void tribo_model_destroy(tribo_model *model);

/* What the last call that failed on the model found, also one that made no system of it. A NULL model gets a text, too. */
TRIBO_API const char *tribo_model_message(const tribo_model *model);

/* The matrices of the model, each in one of three forms; a new one replaces the last one.
 * m, c, k           [ndof][ndof] in, or _diagonal [ndof] in
 * rowptr, col, val  [ndof + 1], [rowptr[ndof]] in   compressed rows, counted from 0, columns in any order; no entry twice
 * Mass symmetric and positive definite (diagonal is fastest; a degree of freedom may be massless if the stiffness holds it),
 * stiffness symmetric. No damping is set: there is none.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_SIZE (rowptr), TRIBO_ERR_RANGE (col), TRIBO_ERR_DUPLICATE,
 * TRIBO_ERR_MEMORY; on error the matrix stays as it was. */
TRIBO_API int tribo_model_set_mass(tribo_model *model, const double *m);
TRIBO_API int tribo_model_set_mass_diagonal(tribo_model *model, const double *m);
TRIBO_API int tribo_model_set_mass_csr(tribo_model *model, const size_t *rowptr, const size_t *col, const double *val);
TRIBO_API int tribo_model_set_damping(tribo_model *model, const double *c);
TRIBO_API int tribo_model_set_damping_diagonal(tribo_model *model, const double *c);
TRIBO_API int tribo_model_set_damping_csr(tribo_model *model, const size_t *rowptr, const size_t *col, const double *val);
TRIBO_API int tribo_model_set_stiffness(tribo_model *model, const double *k);
TRIBO_API int tribo_model_set_stiffness_diagonal(tribo_model *model, const double *k);
TRIBO_API int tribo_model_set_stiffness_csr(tribo_model *model, const size_t *rowptr, const size_t *col, const double *val);

/* J: row i is how the velocities of the degrees of freedom make that of contact i.
 * j                 [ncontact][ndof] in
 * rowptr, col, val  [ncontact + 1], [rowptr[ncontact]] in   compressed rows
 * Returns as above. */
TRIBO_API int tribo_model_set_direction(tribo_model *model, const double *j);
TRIBO_API int tribo_model_set_direction_csr(tribo_model *model, const size_t *rowptr, const size_t *col, const double *val);

/* Springs before the sliders of contacts (Jenkins, Masing): v = J q' + c f'.
 * c  [ncontact] in   1/stiffness of the spring, >= 0; 0: a rigid contact
 * In systems each adds a degree of freedom without mass, the displacement of its slider, behind those of the model.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_RANGE (1/c overflows), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_model_set_compliance(tribo_model *model, const double *c);

/* Sizes; 0 for NULL. */
TRIBO_API size_t tribo_model_ndof(const tribo_model *model);
TRIBO_API size_t tribo_model_ncontact(const tribo_model *model);

/* Makes message that of the model and returns status: for readers of files and other forms of matrices on top of these calls. */
TRIBO_API int tribo_model_refuse(tribo_model *model, int status, const char *message);

/* 1 if this build has the feature, else 0, also for numbers that are none. Thread-safe. */
enum {
    TRIBO_FEATURE_CHOLMOD = 0 /* sparse factors: systems of many degrees of freedom whose mass matrix is not diagonal */
};
TRIBO_API int tribo_dynamics_has(int feature);

/* --------------------------------------------------------------------------------------------------------- systems */

typedef struct tribo_system tribo_system;

/* The system of all degrees of freedom of the model, dense or sparse as given. Its context starts with Quinn's law, limit 0 (all
 * contacts open) and R = J M^-1 J'. No load, no motion yet. Returns TRIBO_ERR_NULL, TRIBO_ERR_STATE (a matrix is not set),
 * TRIBO_ERR_SIZE, TRIBO_ERR_NOT_SYMMETRIC, TRIBO_ERR_INDEFINITE, TRIBO_ERR_UNSUPPORTED, TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_create(tribo_system **sys, tribo_model *model);

/* What stands for the displacements by steady forces at contacts, beside the modes of a reduced system. */
enum { TRIBO_STATICS_NONE = 0, TRIBO_STATICS_MASS = 1, TRIBO_STATICS_COMPLIANCE = 2 };

/* The system of the nmode lowest modes of the model, nmode > 0, with modal mass 1 (the first of the largest displacements of a mode
 * is positive). The damping matrix, if there is one, is projected on these motions; tribo_system_set_damping_ratio replaces it.
 * static_contacts:
 *   TRIBO_STATICS_NONE        nothing beside the modes
 *   TRIBO_STATICS_MASS        and motions, orthonormal in M and orthogonal in K: ndof is nmode and at most one more a contact. The
 *                             response to a load is had in the same way, from a row of J whose limit stays 0
 *   TRIBO_STATICS_COMPLIANCE  and the flexibility that the modes leave to contacts, as compliance that contacts share; no damping matrix
 * Returns what tribo_system_create does, and TRIBO_ERR_RANGE (static_contacts), TRIBO_ERR_NO_CONVERGENCE. */
TRIBO_API int tribo_system_reduce(tribo_system **sys, tribo_model *model, size_t nmode, int static_contacts);

/* The same with as many modes as the answer needs: the error of tribo_system_get_truncation at omega is at most tolerance.
 * omega      in   >= 0, rad/time   the highest frequency that matters: of the load, times the highest harmonic
 * tolerance  in   > 0
 * Returns what tribo_system_reduce does, and TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE (omega), TRIBO_ERR_NOT_POSITIVE (tolerance),
 * TRIBO_ERR_UNSUPPORTED (all modes are not enough). */
TRIBO_API int tribo_system_reduce_to(tribo_system **sys, tribo_model *model, double omega, double tolerance, int static_contacts);

/* Quinn's three reference systems (Quinn 2004, doi:10.1115/1.1760564), nondimensional. limits >= 0, everything finite.
 * All return TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_SIZE, TRIBO_ERR_MEMORY. */

/* x'' + x = f + alpha sin(omega t). Eq. 5. */
TRIBO_API int tribo_system_oscillator(tribo_system **sys, double limit, double alpha, double omega);

/* n >= 2 blocks on a frictional surface, pulled by alpha sin(omega t) at the first one. Fig. 8 and the equations beside it.
 * limit is the paper's mu N_i. Blocks have the mass 1/n, springs the stiffness n, contacts the limit mu N_i/n; the last block
 * has 3/4 of that mass and of that limit, since the last of the paper's equations is 4/3 of one that makes the stiffness
 * symmetric. R is n, and 4 n/3 for the last. The last entry of the state is the paper's D, (1/n) times the sum of the integrals
 * of -f_i u_i', f_i being n times the force of contact i, 4 n/3 times for the last. */
TRIBO_API int tribo_system_chain(tribo_system **sys, size_t n, double limit, double alpha, double omega);

/* Two blocks, the upper on the lower, the lower on a belt that moves with speed * sin(omega t): contact 0 is between belt and
 * lower block (limit1), contact 1 between the blocks (limit2); kappa is the stiffness of the upper spring. Eq. 7, Fig. 10. */
TRIBO_API int tribo_system_belt(tribo_system **sys, double kappa, double limit1, double limit2, double speed, double omega);

TRIBO_API void tribo_system_destroy(tribo_system *sys);

/* A copy that shares nothing, with loads, motions, tables, and the context and its settings; e.g. one a thread.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_clone(const tribo_system *sys, tribo_system **copy);

/* Adds a harmonic to the load, p(t) += cosine cos(omega t) + sine sin(omega t).
 * omega         in   angular frequency, rad/time
 * cosine, sine  [ndof of the matrices given] in, each or NULL; forces, also for a reduced system
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_UNSUPPORTED (a load on what has no mass), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_add_load(tribo_system *sys, double omega, const double *cosine, const double *sine);

/* Takes all loads away, harmonics and tables, those that a system came with, too. Motions of the bases and limits stay.
 * Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_system_clear_loads(tribo_system *sys);

/* Adds a harmonic to the driven velocities of the contacts, b(t) += cosine cos(omega t) + sine sin(omega t), e.g. of a belt.
 * cosine, sine  [ncontact] in, each or NULL; velocities
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_add_base_motion(tribo_system *sys, double omega, const double *cosine, const double *sine);

/* Adds a load that follows a table, p(t) += pattern * value(t), with value linear between its knots and constant outside.
 * time     [knots] in   ascending
 * value    [knots] in
 * pattern  [ndof of the matrices given] in
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE (no knots), TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (time does not ascend),
 * TRIBO_ERR_UNSUPPORTED (a load on what has no mass), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_add_load_table(tribo_system *sys, size_t knots, const double *time, const double *value,
                                          const double *pattern);

/* Adds driven velocities that follow a table, b(t) += pattern * value(t), with value as above: e.g. of the ground in an earthquake.
 * time, value  [knots] in   time ascends
 * pattern      [ncontact] in
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE (no knots), TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (time does not ascend),
 * TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_add_base_table(tribo_system *sys, size_t knots, const double *time, const double *value,
                                          const double *pattern);

/* Takes all base motions away, harmonics and tables. Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_system_clear_base_motion(tribo_system *sys);

/* Adds a harmonic to the limits, limit(t) = max(0, limit + cosine cos(omega t) + sine sin(omega t) + ...): mu times a normal load
 * that changes. limit is that of tribo_system_context, or of the table. Where the sum is <= 0 the contact has lifted off: it
 * carries no force, and forgets what it did; it touches down sliding, or sticks if its velocity is 0.
 * omega         in   angular frequency, rad/time
 * cosine, sine  [ncontact] in, each or NULL; forces
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (limits beyond 1e300), TRIBO_ERR_UNSUPPORTED (an elastic
 * contact), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_add_limit(tribo_system *sys, double omega, const double *cosine, const double *sine);

/* Lets the limits follow a table in the place of tribo_system_context's, linear between its knots and constant outside.
 * time   [knots] in   ascending
 * limit  [knots][ncontact] in   >= 0; 0: lifted off
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE (no knots), TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_RANGE (time does not
 * ascend), TRIBO_ERR_UNSUPPORTED (an elastic contact), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_set_limit_table(tribo_system *sys, size_t knots, const double *time, const double *limit);

/* Takes the table and all harmonics of the limits away: limits are those of tribo_system_context. Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_system_clear_limits(tribo_system *sys);

/* limit [ncontact] out: the limits at time t, with harmonics or table. Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE. */
TRIBO_API int tribo_system_get_limit(tribo_system *sys, double t, double *limit);

/* Reduced systems: damping ratio of every mode, C = diag(2 zeta omega_k). zeta >= 0.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_UNSUPPORTED (not reduced), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_set_damping_ratio(tribo_system *sys, double zeta);

/* Reduced systems: natural frequencies omega_k [ndof] out, ascending, rad/time, infinite without mass (contacts reduced with
 * TRIBO_STATICS_COMPLIANCE, whose displacements are degrees of freedom); and the displacements of
 * the whole structure, full [ndof of the matrices given] out, that belong to modal ones, reduced [ndof] in.
 * Return TRIBO_ERR_NULL, TRIBO_ERR_UNSUPPORTED (not reduced). */
TRIBO_API int tribo_system_get_frequencies(const tribo_system *sys, double *omega);
TRIBO_API int tribo_system_expand(const tribo_system *sys, const double *reduced, double *full);

/* Reduced systems: a bound on what the motions left out would do.
 * omega  in   the highest frequency that matters: of the load, and of those of its harmonics that matter
 * error  out  harmonic forces at the contacts, up to that frequency and in any proportion to each other, make displacements
 *             there of which at most this part is missing, in terms of the work that the same forces do on the whole elastic
 *             structure while they are steady. With static contacts it is x^2/(1 - x) and less, with compliance x/(1 - x), x
 *             being (omega/omega_next)^2 and omega_next the first frequency left out, or a bound below it: not less than the last
 *             of the nmode kept. HUGE_VAL if modes that slow may be left out. The places where loads act count if they are
 *             contacts, too
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_UNSUPPORTED (not reduced). */
TRIBO_API int tribo_system_get_truncation(const tribo_system *sys, double omega, double *error);

/* Sizes; 0 for NULL. A state y has dimension values: 2 ndof, one for each contact with compliance in the order of contacts, and 1. */
TRIBO_API size_t tribo_system_ndof(const tribo_system *sys);
TRIBO_API size_t tribo_system_ncontact(const tribo_system *sys);
TRIBO_API size_t tribo_system_dimension(const tribo_system *sys);

/* The settings of the system's contacts, borrowed: set law, limits, epsilon, coupling, static limits, planar contacts here, at any
 * time between calls. The system reads this context and never writes into it: tribo_get_limit answers what was set, also where
 * limits vary; forces, slips and counts of the system are not in it (tribo_system_get_slip, tribo_system_get_count). Its
 * operator is the system's, and fixed. NULL: sys is NULL, or out of memory in the first call. */
TRIBO_API tribo_context *tribo_system_context(tribo_system *sys);

/* Text of the last failure of a call on sys, or of a tribo_driver_create for it; "" before any. Belongs to sys, which may be
 * NULL. Failures of a driver: tribo_driver_message. */
TRIBO_API const char *tribo_system_message(const tribo_system *sys);

/* What the contacts do in a state.
 * y    [dimension] in
 * v, feq, f   [ncontact] out, each or NULL, as in tribo_balance; of elastic contacts both forces are what the state says
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_UNSUPPORTED (no accelerations), and what tribo_balance
 * returns. */
TRIBO_API int tribo_system_contacts(tribo_system *sys, double t, const double *y, double *v, double *feq, double *f);

/* slip [ncontact] out, TRIBO_SLIP_...: what the contacts did where the system last found forces by the law: tribo_system_contacts,
 * and steps of central/fixed, rk4/fixed and adaptive methods. Returns TRIBO_ERR_NULL, TRIBO_ERR_STATE (none were found yet). */
TRIBO_API int tribo_system_get_slip(const tribo_system *sys, signed char *slip);

/* TRIBO_COUNT_... of tribo.h, of the same calls. Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE (which). */
TRIBO_API int tribo_system_get_count(const tribo_system *sys, int which, size_t *value);

/* tribo_accept for the state (t, y): to be called after each accepted step by integrators other than tribo_driver.
 * Returns what tribo_system_contacts does. */
TRIBO_API int tribo_system_accept(tribo_system *sys, double t, const double *y);

/* --------------------------------------------------------------------------------------------------------- drivers */

/* For integrators of your own. The state y [dimension] need not be finite: if the derivative is not, TRIBO_ERR_NOT_FINITE.
 * dydt   [dimension] out
 * dfdy   [dimension][dimension] out   derivative of dydt[i] by y[j] in row i
 * dfdt   [dimension] out   partial derivative by t, or NULL
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_UNSUPPORTED (no mass, or no accelerations), TRIBO_ERR_MEMORY
 * (Jacobian), and what tribo_balance returns. */
TRIBO_API int tribo_system_derivative(tribo_system *sys, double t, const double *y, double *dydt);
TRIBO_API int tribo_system_jacobian(tribo_system *sys, double t, const double *y, double *dfdy, double *dfdt);

/* Forces of the contacts in the last derivative; tribo_system_get_slip has their slip values.
 * f   [ncontact] out
 * Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_system_get_force(const tribo_system *sys, double *f);

/* Keeps text as the system's message, and returns status: for integrators of your own. */
TRIBO_API int tribo_system_set_message(tribo_system *sys, int status, const char *text);

/* Hangs data on a system: destroy (or NULL) gets the data when the system is destroyed. Clones have none.
 * key   in   an address of your own; each may be used once for a system
 * tribo_system_attach returns TRIBO_ERR_NULL (sys, key), TRIBO_ERR_STATE (key is in use), TRIBO_ERR_MEMORY;
 * tribo_system_attached NULL if nothing is there. */
TRIBO_API int tribo_system_attach(tribo_system *sys, const void *key, void *data, void (*destroy)(void *data));
TRIBO_API void *tribo_system_attached(const tribo_system *sys, const void *key);

typedef struct tribo_driver tribo_driver;

/* A driver advances the state of sys by a method: the manual says what each method solves, and where its limits are.
 * sys      in/out   borrowed; must live longer than the driver
 * method   in       a name in any case of letters. Coulomb's law: "exact", "event", "auto" (exact where it can do the system,
 *                   else event); "central/fixed", "moreau/fixed" (fixed steps). The law of the context: "rk4/fixed"
 * Methods with fixed steps need tribo_driver_set_step; for all other settings there are defaults.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NAME, TRIBO_ERR_MEMORY, TRIBO_ERR_UNSUPPORTED (the method cannot do the system); the message
 * is that of sys. */
TRIBO_API int tribo_driver_create(tribo_driver **drv, tribo_system *sys, const char *method);

/* A step from (t, y) over h for a stepper to try. */
typedef struct {
    size_t size;             /* sizeof(tribo_trial) of the library: later versions may add members at the end */
    double t, h;             /* h > 0 */
    const double *y, *slope; /* [dimension] state, and its derivative if the stepper takes that */
    const double *tolerance; /* [dimension] largest error of the step */
    const double *rate;      /* [ncontact] rate at which a contact relaxes at rest; 0: its force jumps */
    double *to, *error;      /* [dimension] out: state at t + h, and an estimate of its error */
} tribo_trial;

/* A method that tries single steps; the driver chooses their lengths by the errors. */
typedef struct {
    size_t size;      /* sizeof(tribo_stepper) */
    const char *name; /* for messages; must live as long as the driver */
    double stable;    /* largest h rate of a contact at rest for which an explicit method is stable; 0: implicit */
    int takes_slope;  /* 1: step reads slope */
    /* Tries a step. Returns 0; TRIBO_ERR_STEP, TRIBO_ERR_NO_CONVERGENCE or TRIBO_ERR_NOT_FINITE: the driver tries a shorter one; any
     * other status ends the advance. A step from the t of the last one replaces it, else that was accepted. */
    int (*step)(const tribo_trial *trial, void *data);
    double (*order)(void *data); /* error of the step to come goes with the power order + 1 of h */
    void (*restart)(void *data); /* forgets the steps before; or NULL */
    void (*destroy)(void *data); /* frees data when the driver is destroyed; or NULL */
} tribo_stepper;

/* A driver with adaptive steps by a stepper of your own, see tribo_driver_create.
 * stepper   in   copied
 * data      in   passed to the stepper's functions; the driver's from success on, yours after an error
 * Returns what tribo_driver_create returns, and TRIBO_ERR_SIZE (stepper->size). */
TRIBO_API int tribo_driver_create_stepper(tribo_driver **drv, tribo_system *sys, const tribo_stepper *stepper, void *data);

/* Name of the method; for "auto" that of the method at work, which each advance chooses anew. NULL for NULL. */
TRIBO_API const char *tribo_driver_method(const tribo_driver *drv);

/* Names of the methods, method 0 to tribo_method_count() - 1; NULL outside. */
TRIBO_API int tribo_method_count(void);
TRIBO_API const char *tribo_method_name(int method);

/* Settings may be changed between advances; the motion then goes on from y. Each returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE,
 * TRIBO_ERR_NOT_POSITIVE, TRIBO_ERR_NEGATIVE (reltol), TRIBO_ERR_UNSUPPORTED (the method does not take it). */

/* The step dt > 0 of a method with fixed steps; of an adaptive method the first step (default: a thousandth of the shortest time
 * 1/omega of structure and loads). A method with fixed steps ends an advance with a shorter step where t1 asks for it. */
TRIBO_API int tribo_driver_set_step(tribo_driver *drv, double dt);

/* The error of a step of event, auto or an adaptive method: below abstol + reltol times the largest displacement, the largest
 * velocity, or the energy, each for its own part of y.
 * abstol   in   > 0, in the units of y. Default: event 1e-12 of what moves within the shortest time 1/omega; adaptive 1e-12
 * reltol   in   >= 0. Default: adaptive 1e-8 */
TRIBO_API int tribo_driver_set_tolerance(tribo_driver *drv, double abstol, double reltol);

/* exact, event, auto: the observer also sees the motion every dt > 0 from the start of an advance on. Default: not. */
TRIBO_API int tribo_driver_set_output(tribo_driver *drv, double dt);

/* The largest step of an adaptive method, h > 0; HUGE_VAL: none. Default: 0.1 times the shortest time 1/omega of structure and
 * loads. Events within a step may be missed while all contacts rest, so a longer one is for implicit methods on structures with
 * frequencies that do not matter. Steps also end at the knots of tables. */
TRIBO_API int tribo_driver_set_max_step(tribo_driver *drv, double h);

/* Integrates from *t to t1 >= *t.
 * t  in/out   time
 * y  [dimension] in/out   state; may be changed between calls, and so may the system, its loads and its context's settings
 * On error t and y hold the last good step, always finite (central/fixed without an observer: velocities and energy half a step
 * before). Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE (also where the motion grows without bound), TRIBO_ERR_RANGE (t1 < t),
 * TRIBO_ERR_STATE (no step was set), TRIBO_ERR_STOPPED, TRIBO_ERR_STEP (a step below what time resolves, or an unstable dt),
 * TRIBO_ERR_CHATTER, TRIBO_ERR_UNSUPPORTED (the method cannot do the system as it is, or knows no closed form to two digits),
 * TRIBO_ERR_INDEFINITE (matrix of a step of moreau/fixed, or of exact), TRIBO_ERR_MEMORY, and what tribo_balance returns. */
TRIBO_API int tribo_driver_advance(tribo_driver *drv, double *t, double t1, double *y);

/* A moment of the motion, as an observer sees it. Valid during the call. */
typedef struct {
    size_t size;     /* sizeof(tribo_moment) of the library: later versions may add members at the end */
    double t;        /* time */
    const double *y; /* [dimension] state */
    int kind;        /* TRIBO_MOMENT_... */
    size_t contact;  /* the contact that changes; SIZE_MAX for TRIBO_MOMENT_STEP */
} tribo_moment;

enum {
    TRIBO_MOMENT_STEP = 0,    /* end of a step, output, end of an advance, or an event at which no contact changes */
    TRIBO_MOMENT_STICK = 1,   /* a contact comes to rest */
    TRIBO_MOMENT_SLIP = 2,    /* a contact breaks away */
    TRIBO_MOMENT_REVERSE = 3, /* the direction of sliding turns without rest */
    TRIBO_MOMENT_LIFT = 4,    /* the limit falls to 0 */
    TRIBO_MOMENT_TOUCH = 5    /* the limit rises from 0 */
};

/* Calls seen at every moment. exact, event and auto: a call for each contact that changes at an event, in ascending order, with
 * the same t and y, a planar contact by its first direction; a step at the end of the advance, and as tribo_driver_set_output
 * says. Other methods: a step after each step.
 * seen   in   answers 0 to go on; else the advance ends with TRIBO_ERR_STOPPED, and the next advance goes on with the next
 *             moment. Must not change the system. NULL: no observer
 * data   in   passed to seen
 * Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_driver_set_observer(tribo_driver *drv, int (*seen)(const tribo_moment *moment, void *data), void *data);

/* Finds a state at t to which the motion comes back after a period: the steady response without the transient. Methods exact,
 * event, auto. The manual says which of several motions is found, and how accurately. The observer sees nothing of the search.
 * t        in       time at which the period begins
 * period   in       > 0; that of the loads, or a multiple of it
 * y        [dimension] in/out   a guess, zeros will do; the state found, its energy 0; untouched on error
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE, TRIBO_ERR_STEP (a period below what time resolves),
 * TRIBO_ERR_RANGE (a load or base that is not periodic in it), TRIBO_ERR_UNSUPPORTED (other methods; tables; static limits beside
 * elastic contacts; planar contacts), TRIBO_ERR_NO_CONVERGENCE, and what tribo_driver_advance returns. */
TRIBO_API int tribo_driver_find_periodic(tribo_driver *drv, double t, double period, double *y);

/* Floquet multipliers re + i im of the last periodic motion found, the largest first; of a complex pair the one with im > 0.
 * re, im   [dimension - 1] out
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_MEMORY, TRIBO_ERR_NO_CONVERGENCE, TRIBO_ERR_STATE (the last search found none, or there was
 * none), TRIBO_ERR_UNSUPPORTED (contacts that act on each other stop or break away at one instant: the motion nearby is not
 * linear). */
TRIBO_API int tribo_driver_get_multipliers(const tribo_driver *drv, double *re, double *im);

/* The dimension of the family that the last periodic motion found belongs to: contacts that never slip keep any place within
 * their limits. 0: the motion stands alone. Returns TRIBO_ERR_NULL, TRIBO_ERR_STATE (as above), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_driver_get_freedom(const tribo_driver *drv, size_t *freedom);

/* Quantities of the last periodic motion found, in closed form from event to event. The system must be as it was then.
 * c                    [2 ndof] in   a combination of displacements and velocities, c'[q, q']
 * least, most          out           its extremes
 * at_least, at_most    out, or NULL  times of these in the period from t on
 * k                    in            a harmonic, cosine cos(k 2 pi t/period) + sine sin(k 2 pi t/period); 0: cosine is the mean
 * cosine, sine         out
 * energy, share        [ncontact] out   dissipated in a period; the part of it for which the contact is at rest
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE (c), TRIBO_ERR_STATE (no motion found, or the system changed), TRIBO_ERR_MEMORY,
 * TRIBO_ERR_UNSUPPORTED (extremes, harmonic by exact: a load in resonance with a mode that has next to no damping). */
TRIBO_API int tribo_driver_period_extremes(tribo_driver *drv, const double *c, double *least, double *most, double *at_least,
                                           double *at_most);
TRIBO_API int tribo_driver_period_harmonic(tribo_driver *drv, const double *c, size_t k, double *cosine, double *sine);
TRIBO_API int tribo_driver_period_dissipation(tribo_driver *drv, double *energy);
TRIBO_API int tribo_driver_period_stick(tribo_driver *drv, double *share);

/* Counts since creation. tribo_driver_count returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE. */
enum {
    TRIBO_COUNT_STEPS = 100,       /* accepted steps */
    TRIBO_COUNT_REJECTED = 101,    /* steps tried and undone */
    TRIBO_COUNT_EVALUATIONS = 102, /* evaluations of the right-hand side */
    TRIBO_COUNT_JACOBIANS = 103,   /* evaluations of its Jacobian */
    TRIBO_COUNT_EVENTS = 104,      /* events located */
    TRIBO_COUNT_PERIODS = 105,     /* periods integrated by tribo_driver_find_periodic, of each search rounded up */
    TRIBO_COUNT_NEWTON = 106,      /* steps of Newton's method of these searches */
    TRIBO_COUNT_RESTED = 107       /* degrees of freedom that steps left out since nothing moved there */
};
TRIBO_API int tribo_driver_count(const tribo_driver *drv, int which, size_t *value);

/* Bounds on how far the motion strayed from Coulomb's law since creation: exact, event and auto, over all of the motion. */
enum {
    TRIBO_REAL_EXCESS = 100,  /* the largest force of a contact at rest beyond its limit */
    TRIBO_REAL_BACKSLIP = 101 /* the largest velocity of a sliding contact against its direction of sliding */
};
/* Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE, TRIBO_ERR_UNSUPPORTED (other methods). */
TRIBO_API int tribo_driver_real(const tribo_driver *drv, int which, double *value);

/* What the last failing call found; "" before any. */
TRIBO_API const char *tribo_driver_message(const tribo_driver *drv);

TRIBO_API void tribo_driver_destroy(tribo_driver *drv);

#ifdef __cplusplus
}
#endif

#endif
