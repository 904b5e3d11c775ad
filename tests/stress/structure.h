/* SPDX-License-Identifier: BSD-3-Clause */
/* Random linear structures with friction, of every kind that dense_system takes. */
#ifndef TRIBO_TESTS_STRUCTURE_H
#define TRIBO_TESTS_STRUCTURE_H

#include "make.h"
#include "../validation/run.h"

#define MOST_DOFS 12
#define MOST_CONTACTS 8
#define MOST_STATES (2 * MOST_DOFS + 1)

/* cosine cos(omega t) + sine sin(omega t). */
struct wave {
    double omega, cosine[MOST_DOFS], sine[MOST_DOFS];
};

/* Matrices row-major, as wide as ndof; two harmonics each of loads and motions. */
struct structure {
    size_t ndof, ncontact;
    int damped;
    double mass[MOST_DOFS * MOST_DOFS], damping[MOST_DOFS * MOST_DOFS], stiffness[MOST_DOFS * MOST_DOFS];
    double direction[MOST_CONTACTS * MOST_DOFS], limit[MOST_CONTACTS];
    size_t springs; /* in front of contacts */
    int falls;      /* limits fall from so many times that with the speed, over these velocities */
    double ratio[MOST_CONTACTS], velocity[MOST_CONTACTS];
    struct wave load[2], motion[2];
    double begin, start[MOST_STATES]; /* time and state */
    char name[120];                   /* what kind it is, for messages */
};

/* 1 to 12 degrees of freedom, 1 to 8 contacts, frequencies of the order of 1. */
struct structure structure_create(int seed);

/* The same of small whole numbers, so that everything that may coincide does. */
struct structure structure_even(int seed);

/* The first with limits that fall with the speed, from up to twice what they are; and with a spring in front of some contacts, as
 * many as there are degrees of freedom left for their far ends. */
struct structure structure_falling(int seed);
struct structure structure_elastic(int seed);

/* Its system, with the limits set. */
tribo_system *structure_system(const struct structure *s);

/* Runs it for so long from its start, y [2 ndof + 1] out. Returns the driver's status; text [200] gets its message. */
int structure_run(const struct structure *s, const char *method, double dt, double tolerance, double duration, double *y,
                  char *text);

/* Mechanical energy of a state. */
double structure_energy(const struct structure *s, const double *y);

/* Largest |x - y| of the first n. */
double distance(const double *x, const double *y, size_t n);

/* The size that errors of a state y are compared with. */
double size_of(const double *y, size_t n);

#endif
