/* SPDX-License-Identifier: BSD-3-Clause */
/* What people do today for steady motion with friction, to compare with: harmonic balance by the alternating frequency-time
 * scheme with a regularized law, f = -limit tanh(v/epsilon) (Cameron and Griffin 1989; Krack and Gross 2019). Free of this
 * library. The structure is linear between its contacts, so that only their velocities are unknown. */
#ifndef TRIBO_BENCH_HARMONIC_BALANCE_H
#define TRIBO_BENCH_HARMONIC_BALANCE_H

#include "systems.h"

/* A steady motion: half of how far the load's place moves in all, times the load's amplitude (work); power is what friction
 * dissipates, a mean over the period. */
struct steady {
    double amplitude, power;
};

struct harmonic_balance;

/* For the model of a beam, loaded by sin(omega t), with harmonics 1, 3, 5, ... highest of omega. Ends the program if there is no
 * memory. */
struct harmonic_balance *balance_create(const struct model *m, size_t highest);
void balance_free(struct harmonic_balance *b);

/* The steady motion at frequency omega, beginning from the last one found, at any frequency or limit. epsilon is in terms of the
 * largest velocity that a contact has without friction. Returns Newton's steps, or 0 if they did not converge. */
size_t balance_solve(struct harmonic_balance *b, double omega, double limit, double epsilon, struct steady *steady);

#endif
