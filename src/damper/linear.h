#ifndef DAMPER_LINEAR_H
#define DAMPER_LINEAR_H

#include "damper.h"

/* What is known without integrating, to check against and to measure by. omega is that of the load, rad/time. */

/* Amplitude where the load acts, without friction. */
double free_amplitude(const struct damper *d, double omega);

/* Amplitude where the load acts, with all contacts stuck for ever. */
double stuck_amplitude(const struct damper *d, double omega);

/* Natural frequencies, rad/time, with all contacts stuck for ever, ascending: omega [modes] out; returns their number. */
size_t stuck_frequencies(const struct damper *d, double *omega);

/* None between zeros. */
double relative_difference(double a, double b);

/* The motion without friction: amplitude, the most power that the load could put into it, and energy norm of its modes'
 * displacements and velocities at their largest. So much of it is nothing: less is rounding. */
struct scale {
    double amplitude, power, norm;
};
struct scale free_scale(const struct damper *d, double omega);
#define NOTHING 1e-13

/* The best damper by harmonic balance of one mode that is driven at its resonance. All contacts slide in phase, so that the work
 * of a period is  pi F phi_L Q = 4 N S Q + 2 pi zeta omega^2 Q^2  with S the sum of |phi_i|: friction dissipates most where it
 * takes half of what the load puts in, 4 N S = pi F phi_L/2. NaN if the load is not at a natural frequency, or the limits
 * of contacts are not all the same. */
struct optimum {
    double limit, power, amplitude; /* amplitude where the load acts: half of the one without friction */
};
struct optimum harmonic_balance(const struct damper *d, double drive);

#endif
