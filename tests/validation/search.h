/* SPDX-License-Identifier: BSD-3-Clause */
/* Systems and drivers that look for periodic motions. */
#ifndef TRIBO_TESTS_SEARCH_H
#define TRIBO_TESTS_SEARCH_H

#include "run.h"

#define MOST_DOFS 4
#define MOST_STATES (2 * MOST_DOFS + 1)

/* A structure of so many degrees of freedom, and a driver that looks for its motion of the load's period. */
struct search {
    tribo_system *sys;
    tribo_driver *drv;
    size_t ndof;
    double omega, period;
};

struct search search_create(const char *method, size_t ndof, size_t contacts, const double *mass, const double *damping,
                            const double *stiffness, const double *direction, double omega, const double *cosine);

/* x'' + damping x' + x = force cos(omega t) + f, |f| <= limit. */
struct search oscillator_search(const char *method, double damping, double limit, double force, double omega);
void search_free(struct search *s);

void find(const struct search *s, double t, double *y);

/* The largest displacement of a degree of freedom; the motion is odd, so that the least is minus that. */
double amplitude(const struct search *s, size_t dof);

/* What a period from y on dissipates; y goes along. */
double dissipated(const struct search *s, double *y);

#endif
