/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_LINEAR_H
#define DAMPER_LINEAR_H

#include "contact.h"

/* A linear structure in its modes, of modal mass 1: without friction, or with all contacts stuck. The modal loads are
 * cosine cos(omega t) + sine sin(omega t). */
struct linear {
    size_t count;          /* of modes */
    double *omega;         /* [count] natural frequencies, rad/time; of stuck contacts ascending */
    double *damping;       /* [count][count] */
    int coupled;           /* 1: damping has entries off the diagonal */
    double *cosine, *sine; /* [count] */
    double *measured;      /* [count] the modes at the place where amplitudes are measured */
};

struct linear create_linear(size_t count);
void free_linear(struct linear *l);

/* Sets l->coupled. */
void find_coupling(struct linear *l);

/* The modes of `open` with all contacts stuck; none if the contacts leave no freedom.
 * shape  [contacts][open->count] in   the modes at the contacts */
struct linear stick(const struct linear *open, const struct contact *contact, size_t contacts, const double *shape);

/* The motion under loads of frequency omega, rad/time: amplitude at the measured place, NaN if it has no finite one; a bound of
 * the power of the loads, and the energy norm of the modes' displacements and velocities at their largest. Results below NOTHING
 * of these are rounding. */
struct scale {
    double amplitude, power, norm;
};
struct scale scale_of(const struct linear *l, double omega);
#define NOTHING 1e-13

/* A frequency below this part of the last one of omega is rounding of 0: no stiffness holds such a mode. */
#define LOOSE 1e-6

double dot(const double *a, const double *b, size_t n);

/* |a - b| by the larger of both; 0 between zeros. */
double relative_difference(double a, double b);

#endif
