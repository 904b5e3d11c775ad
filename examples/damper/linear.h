#ifndef EXAMPLES_LINEAR_H
#define EXAMPLES_LINEAR_H

#include "response.h"

/* What is known without integrating, to check against. */

/* Amplitude where the load acts, without friction. */
double free_amplitude(const struct damper *d);

/* The same motion's size: energy norm of its modes' displacements and velocities, at their largest. */
double free_norm(const struct damper *d);

/* Amplitude where the load acts, with all contacts stuck for ever. */
double stuck_amplitude(const struct damper *d);

/* The best damper by harmonic balance of one mode that is driven at its resonance. All contacts slide in phase, so that the work
 * of a period is  pi F phi_L Q = 4 N S Q + 2 pi zeta omega^2 Q^2  with S the sum of |phi_i|: friction dissipates most where it
 * takes half of what the load puts in, 4 N S = pi F phi_L/2. NaN if the load is not at a natural frequency. */
struct optimum {
    double limit, power, amplitude; /* amplitude where the load acts: half of the one without friction */
};
struct optimum harmonic_balance(const struct damper *d);

#endif
