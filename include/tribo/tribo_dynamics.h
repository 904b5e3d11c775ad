/* tribo's dynamics: mechanical systems with friction, and their motion in time.
 *
 * A system is M q'' + C q' + K q = p(t) + J' f,  v = J q' - b(t),  with p and b sums of harmonics; f are the friction forces of
 * its contacts, found by the tribo_context that it owns, and v their relative velocities. Its state is
 *     y = q [ndof], q' [ndof], energy dissipated by friction since t = 0        2 ndof + 1 values.
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

/* --------------------------------------------------------------------------------------------------------- systems */

typedef struct tribo_system tribo_system;

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

/* Any linear structure, from its matrices in the caller's units.
 * mass       [ndof][ndof] in  symmetric, positive definite, but see below; diagonal is fastest
 * damping    [ndof][ndof] in, or NULL for none
 * stiffness  [ndof][ndof] in  symmetric
 * direction  [ncontact][ndof] in  J: row i is how the velocities of the degrees of freedom make that of contact i
 * nmode      in   0, or: keep only the motion in the nmode lowest modes of (K, M); q then holds their amplitudes (modes have
 *                 modal mass 1, and the first of their largest displacements is positive), ndof of the system is nmode, and
 *                 damping must be NULL (see tribo_system_set_damping_ratio)
 * message    [size] out, or NULL: on error, the text that says what is wrong and where
 * The context starts with Quinn's law and limit 0 (all contacts open), and with R = J M^-1 J'. No load, no motion yet.
 * Modes are found to the accuracy of the stiffness's own entries, however soft beside the stiffest, and omega of rigid-body
 * motions is 0; one of which rounding of the entries leaves less than two digits is refused (TRIBO_ERR_UNSUPPORTED). So are
 * bodies that contacts join, if the mass matrix is not diagonal and one weighs so little that R hides the other.
 *
 * Elastic contacts. With nmode = 0 degrees of freedom w may be massless: their rows of mass are zero, and of damping, and the
 * stiffness holds them, K_ww definite. They follow statically, K_ww w = J_w'f - K_wq q. A contact on one is elastic, a spring in
 * series with a slider (Jenkins, Masing): with a row [k -k; -k k] of stiffness between a mass and w, and a contact on w, it holds
 * with the stiffness k, and slides at its limit. Its force follows from the state; one that starts beyond the limit goes back to
 * it at once, and dissipates limit times the way of the slider. Contacts may share compliance: J_w K_ww^-1 J_w' must be positive
 * definite over elastic contacts.
 * Methods "exact" and "event" (and "auto", by them) take such systems, and "moreau/fixed", to second order. What else needs mass
 * says so, TRIBO_ERR_UNSUPPORTED: other methods, loads on what has none, limits of elastic contacts that change with time, or
 * static ones (tribo_set_static), planar contacts, tribo_system_contacts where elastic contacts touch mass themselves,
 * tribo_system_accept, and the GSL system's functions. Multipliers of periodic motions have 0 for velocities of what has no mass.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_SIZE, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_SYMMETRIC, TRIBO_ERR_INDEFINITE,
 * TRIBO_ERR_UNSUPPORTED, TRIBO_ERR_NO_CONVERGENCE (modes), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_linear(tribo_system **sys, size_t ndof, size_t ncontact, const double *mass, const double *damping,
                                  const double *stiffness, const double *direction, size_t nmode, char *message, size_t size);

/* What stands for the displacements by steady forces at contacts, beside the modes of a reduced system. */
enum { TRIBO_STATICS_NONE = 0, TRIBO_STATICS_MASS = 1, TRIBO_STATICS_COMPLIANCE = 2 };

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

/* Adds a harmonic to the limits, limit(t) = max(0, limit + cosine cos(omega t) + sine sin(omega t) + ...), e.g. of a normal load
 * that changes: mu times it. Where the sum is not above 0 the contact has lifted off: it has no force, and no memory; it touches
 * down sliding, or, without velocity, sticks if it can. tribo_system_set_limit_table with knots = 0 takes these harmonics away.
 * cosine, sine  [ncontact] in, each or NULL; forces
 * The limit that they are added to is what is set in the context, before or after, or the table's. The context's limits follow
 * the time that was last looked at: tribo_get_limit answers limit(t) of then, and to set just that again changes nothing.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_RANGE (limits beyond 1e300), TRIBO_ERR_UNSUPPORTED (an elastic
 * contact), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_add_limit(tribo_system *sys, double omega, const double *cosine, const double *sine);

/* Lets the limits follow a table, linear between its knots and constant outside, instead of what the context says.
 * time   [knots] in   ascending; knots = 0 ends it, and harmonics: limits are again those that the context had before
 * limit  [knots][ncontact] in   >= 0; 0: lifted off
 * Limits that are set in the context meanwhile have no effect.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_RANGE (time does not ascend),
 * TRIBO_ERR_UNSUPPORTED (an elastic contact), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_set_limit_table(tribo_system *sys, size_t knots, const double *time, const double *limit);

/* Reduced systems: damping ratio of every mode, C = diag(2 zeta omega_k). zeta >= 0.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_UNSUPPORTED (not reduced), TRIBO_ERR_MEMORY. */
TRIBO_API int tribo_system_set_damping_ratio(tribo_system *sys, double zeta);

/* Reduced systems: natural frequencies omega_k [ndof] out, ascending, rad/time, infinite without mass; and the displacements of
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

/* Sizes; 0 for NULL. dimension is 2 ndof + 1. */
TRIBO_API size_t tribo_system_ndof(const tribo_system *sys);
TRIBO_API size_t tribo_system_ncontact(const tribo_system *sys);
TRIBO_API size_t tribo_system_dimension(const tribo_system *sys);

/* The context of the system's contacts, borrowed: set law, limits, epsilon and coupling here. Its operator is the system's, and
 * stays (that of a copy, tribo_clone, may be changed). Calls on the system that fail leave their message on it. NULL for NULL. */
TRIBO_API tribo_context *tribo_system_context(tribo_system *sys);

/* What the contacts do in a state.
 * y    [dimension] in
 * v, feq, f   [ncontact] out, each or NULL, as in tribo_balance; of elastic contacts both forces are what the state says
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_UNSUPPORTED (see tribo_system_linear), and what tribo_balance
 * returns. */
TRIBO_API int tribo_system_contacts(tribo_system *sys, double t, const double *y, double *v, double *feq, double *f);

/* tribo_accept for the state (t, y): to be called after each accepted step by integrators other than tribo_driver.
 * Returns what tribo_system_contacts does. */
TRIBO_API int tribo_system_accept(tribo_system *sys, double t, const double *y);

/* --------------------------------------------------------------------------------------------------------- drivers */

typedef struct tribo_driver tribo_driver;

/* An integrator for a system, which it borrows and which must live longer.
 * method   in   in any case of letters. Coulomb's law itself, epsilon -> 0:
 *               "exact": the motion in closed form between events, to 12 digits; linear systems with harmonic loads and limits
 *               "event": high-order steps between events, with the tolerances; any system
 *               "central/fixed", "moreau/fixed": fixed steps of dt in the step form, by central differences (explicit; a dt that
 *               is not stable is refused: above 2/omega_max, or less with damping) and by the implicit midpoint rule (Moreau and
 *               Jean; a dt with which its matrix is not positive definite, since stiffness or damping is negative, is refused).
 *               Second order; but for scalar contacts that reverse without sticking, and central with damping: there first order.
 *               With planar contacts, and with static limits, by tribo_step_force_mean, else by tribo_step_force. Where no two
 *               contacts share a body, central leaves out bodies that rest among others at rest, and TRIBO_COUNT_RESTED counts
 *               them, but in systems of up to 4 degrees of freedom
 *               "auto": exact where it can do the system, of up to 200 degrees of freedom, else event; see tribo_driver_method
 *               exact and event look over all of the motion for what goes beyond Coulomb's law, see tribo_driver_real.
 *               Planar contacts: event, and not exact. Limits must not change then, nor be static ones, and contacts at rest
 *               must not be redundant (TRIBO_ERR_UNSUPPORTED, where that happens). Where a planar one creeps, much slower than
 *               friction would stop it, event takes steps as long as loads and structure allow, while up to 128 slide and once
 *               its direction has settled; otherwise steps of that short time, and where too many of these lead nowhere
 *               (TRIBO_ERR_STEP) moreau/fixed is the one to take
 *               With static limits (tribo_set_static) contacts at rest hold by these; event, and exact where limits drop at
 *               once (else TRIBO_ERR_UNSUPPORTED), locate where they break away, and it takes a force that is beyond them by
 *               more than rounding. Redundant contacts at rest hold as long as any forces within their limits hold all of them;
 *               when none do any more, those that move all the same under the forces that come nearest break away together.
 *               Where contacts that tie each other come to rest on bases that part in the same instant, which of them keeps its
 *               limit is not unique if limits drop at once, and event and exact refuse to choose (TRIBO_ERR_UNSUPPORTED); where
 *               bases part by their accelerations only, they choose a motion that the rule allows, which need not be that of
 *               methods with steps, and which may go with rounding. All methods with steps are of first order with static limits.
 *               The law, coupling and epsilon of the context:
 *               "rk4/fixed": the classical Runge-Kutta method in steps of dt, as in the paper, 4 evaluations a step
 *               "rk2", "rk4", "rkf45", "rkck", "rk8pd", "rk1imp", "rk2imp", "rk4imp", "bsimp", "msadams", "msbdf": the GSL
 *               stepper of that name tries the steps, and the driver decides how long they are. Those of the explicit ones
 *               (rk2 to rk8pd, msadams) follow the stiffness of contacts at rest; the others solve with dense matrices of the
 *               whole state. For small epsilon: msbdf, or rk4imp
 * dt       in   step, or first step; > 0. A fixed-step method ends an advance with a shorter step where t1 asks for it.
 *               exact: how often an observer sees the motion between events
 * abstol   in   >= 0; > 0 for adaptive methods and event (and auto, where it takes event)
 * reltol   in   >= 0
 *               Adaptive: the estimated error of a step is below abstol + reltol times the largest displacement, of velocities
 *               below abstol + reltol times the largest velocity, and of the energy below abstol + reltol |energy|, in the
 *               units of y. Velocities that make contact i's are found to limit_max/limit_i epsilon_i/1000 at least: a
 *               tolerance beside which epsilon is small gives Coulomb's law nevertheless. Errors of steps add up: the energy
 *               is off, relative, by less than 1e-2 at tolerance 1e-4, and at 1e-8 by less than 1e-6 (msbdf 2e-6, rk2imp
 *               5e-6, rk1imp 4e-4), for oscillator and belt, epsilon 1e-2 to 1e-4. Contacts with Coulomb's law itself chatter
 *               about v = 0 in very short steps.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NAME, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_MEMORY,
 * TRIBO_ERR_UNSUPPORTED (planar contacts, static limits, tables, degrees of freedom without mass, or no accelerations, where the
 * method cannot do such systems); the message is on the system's context. */
TRIBO_API int tribo_driver_create(tribo_driver **drv, tribo_system *sys, const char *method, double dt, double abstol,
                                  double reltol);

/* Name of the method; for "auto", of the one at work: the choice is made anew with each advance. NULL for NULL. */
TRIBO_API const char *tribo_driver_method(const tribo_driver *drv);

/* Names of the methods, method 0 to tribo_method_count() - 1; NULL outside. */
TRIBO_API int tribo_method_count(void);
TRIBO_API const char *tribo_method_name(int method);

/* Integrates from *t to t1 >= *t.
 * t  in/out   time
 * y  [dimension] in/out   state; may be changed between calls, and so may the system, its loads and its context's settings
 * On error t and y hold the last good step, always finite. (central/fixed without an observer: velocities and energy half a step
 * before.) Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE (also where the motion grows without bound), TRIBO_ERR_RANGE (t1 < t),
 * TRIBO_ERR_STOPPED, TRIBO_ERR_STEP (a step below what time resolves, or a dt that is not stable), TRIBO_ERR_CHATTER,
 * TRIBO_ERR_UNSUPPORTED (loads and contacts that the method does not take, see tribo_driver_create), TRIBO_ERR_UNSUPPORTED and
 * TRIBO_ERR_INDEFINITE (exact: a structure with contacts held whose motion has no closed form, or is not known to two digits),
 * TRIBO_ERR_INDEFINITE (moreau/fixed: the matrix of a step of dt), TRIBO_ERR_MEMORY, and what tribo_balance returns. */
TRIBO_API int tribo_driver_advance(tribo_driver *drv, double *t, double t1, double *y);

/* Finds a motion that comes back after a period: the steady response, without the way there. Methods exact, event, and auto by
 * one of the two; others return TRIBO_ERR_UNSUPPORTED. Without negative damping or stiffness motions never part from each other
 * (in energy), and there is such a motion, as symmetric as its loads, wherever motions are bounded. With it, or with static
 * limits, there may be none, or several, or none is found. Of several it is one near the guess, as a rule, stable or not (see
 * tribo_driver_get_multipliers). Before the search gives up, it follows the motion from the guess for a while, and begins anew
 * there. With static limits that fall with the speed take event or auto: exact cannot be created for them, and refuses such that
 * are set later.
 * t       in       time at which the period begins
 * period  in       > 0; that of the loads, or a multiple of it
 * y       [dimension] in/out   a guess, zeros will do; out: the state at t to which the motion comes back, its energy 0
 * event follows the motion in steps of an error of 1e-13, whatever the tolerances, which are for advance.
 * The state comes back to 1e-10 of the largest state on the way (as a rule to 1e-12), in the energy norm: the root of
 * q^T K q + q'^T M q', where modes below 0.1 (2 pi/period) count with that frequency. The size of a motion is taken to be 1e-4 of
 * what the loads would do against stiffness or inertia alone, at least. That it comes back is seen by following it through the
 * period; if it does not, y is untouched and the message tells how near it came.
 * Where all loads and motions of bases are odd harmonics of the period, the motion is one whose second half is minus the first.
 * Where there is a family of motions (contacts that never slip keep any place within their limits), it is one near the guess; of
 * such that may be odd, the odd one, unless the guess is clearly another one of the family. TRIBO_COUNT_FREEDOM counts its
 * dimensions, when it is asked for.
 * The observer sees nothing of the search: advance over the period to look. The next advance begins anew.
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_POSITIVE, TRIBO_ERR_STEP (a period below what time resolves),
 * TRIBO_ERR_RANGE (a load or base that is not periodic in it), TRIBO_ERR_UNSUPPORTED (tables; static limits beside elastic
 * contacts; planar contacts), TRIBO_ERR_NO_CONVERGENCE, and what tribo_driver_advance returns. */
TRIBO_API int tribo_driver_find_periodic(tribo_driver *drv, double t, double period, double *y);

/* Floquet multipliers of the last periodic motion found, the largest first; of a complex pair the one with the positive imaginary
 * part. Motions next to it, in which contacts that rest do so too, come closer by these factors a period. Contacts at rest
 * forget: multipliers of 0. They are found when they are asked for, in a time of the third power of ndof.
 * re, im  [2 ndof] out
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_MEMORY, TRIBO_ERR_NO_CONVERGENCE, TRIBO_ERR_STATE (none was found, or the last search found
 * none), TRIBO_ERR_UNSUPPORTED (contacts that bear upon each other stop, or reach their static limits, at one instant: what
 * motions next to it do is not linear; or one reaches its static limit at an instant at which another one stops). */
TRIBO_API int tribo_driver_get_multipliers(const tribo_driver *drv, double *re, double *im);

/* What the last periodic motion found holds, in closed form from event to event: nothing is sampled. Each call follows the motion
 * through its period once. The system must be as it was when the motion was found.
 * c             [2 ndof] in   a combination of displacements and velocities, c'[q, q']
 * least, most          out   its extremes
 * at_least, at_most    out   a time in the period from t on at which it has them; where it stays there for long, any of that
 * k             in            a harmonic: cosine cos(k 2 pi t/period) + sine sin(k 2 pi t/period); 0: cosine is the mean
 * cosine, sine         out
 * energy        [ncontact] out   what each contact dissipates in a period
 * share         [ncontact] out   the share of the period for which it is at rest
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE (c), TRIBO_ERR_STATE (no motion found, or the system changed), TRIBO_ERR_MEMORY,
 * TRIBO_ERR_UNSUPPORTED (extremes, harmonic by exact: a load in resonance with a mode that has next to no damping). */
TRIBO_API int tribo_driver_period_extremes(tribo_driver *drv, const double *c, double *least, double *most);
TRIBO_API int tribo_driver_period_extremes_at(tribo_driver *drv, const double *c, double *least, double *most, double *at_least,
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
    TRIBO_COUNT_PERIODS = 105,     /* periods that tribo_driver_find_periodic integrated, of each search rounded up */
    TRIBO_COUNT_NEWTON = 106,      /* steps of Newton's method that it took */
    TRIBO_COUNT_FREEDOM = 107,     /* no count: the dimension of the family that the last periodic motion found belongs to */
    TRIBO_COUNT_RESTED = 108       /* degrees of freedom that steps left out since nothing moved there */
};
TRIBO_API int tribo_driver_count(const tribo_driver *drv, int which, size_t *value);

/* How far the motion has strayed from Coulomb's law since creation, "exact", "event" and "auto": bounds, over all of the motion
 * and not only where it was looked at. What a contact is off, the motion is off by no more than the impulse of that. */
enum {
    TRIBO_REAL_EXCESS = 100,  /* the largest force of a contact at rest beyond its limit */
    TRIBO_REAL_BACKSLIP = 101 /* the largest velocity of a contact against the direction in which its force takes it to slide */
};
/* Returns TRIBO_ERR_NULL, TRIBO_ERR_RANGE, TRIBO_ERR_UNSUPPORTED (other methods). */
TRIBO_API int tribo_driver_real(const tribo_driver *drv, int which, double *value);

/* Has seen called after every accepted step (event 0) and at events (event 1: a contact sticks, breaks away or reverses). What
 * it answers ends the run unless 0: the advance then returns TRIBO_ERR_STOPPED. It must not change the system. NULL: no
 * observer. Returns TRIBO_ERR_NULL. */
TRIBO_API int tribo_driver_set_observer(tribo_driver *drv, int (*seen)(double t, const double *y, int event, void *data),
                                        void *data);

/* The largest step of an adaptive method, h > 0 in; HUGE_VAL: none. By default it is 0.1 over the highest frequency of structure
 * and loads. While all contacts rest nothing moves, whatever the loads are about to do, and no estimate sees how long a step is:
 * what happens within one may be overlooked, a slip as short as a third of the step and so weak that it dissipates about
 * limit^2/stiffness times the fourth power of h times that frequency (at 0.1: 1e-6, seen at worst). Larger ones are for implicit
 * methods on structures with frequencies that do not matter. Steps also end where tables have knots. Returns TRIBO_ERR_NULL,
 * TRIBO_ERR_NOT_FINITE (NaN), TRIBO_ERR_NOT_POSITIVE, TRIBO_ERR_UNSUPPORTED (other methods). */
TRIBO_API int tribo_driver_set_max_step(tribo_driver *drv, double h);

/* What the last failing call found; "" before any. */
TRIBO_API const char *tribo_driver_message(const tribo_driver *drv);

TRIBO_API void tribo_driver_destroy(tribo_driver *drv);

#ifdef __cplusplus
}
#endif

#endif
