/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs of the library's systems. */
#ifndef TRIBO_TESTS_RUN_H
#define TRIBO_TESTS_RUN_H

#include "support.h"
#include "tribo/tribo_gsl.h"

#include <stdint.h>

/* A model of dense matrices, damping NULL: none; compliances and normals may follow. finish_model: its system, and the end of the
 * model. What fails ends the test. */
tribo_model *dense_model(size_t ndof, size_t ncontact, const double *mass, const double *damping, const double *stiffness,
                         const double *direction);
tribo_system *finish_model(tribo_model *model);

/* A text to report, and the end of the test: what failed says the driver. */
tribo_driver *driver_create(tribo_system *sys, const char *method, double dt, double tolerance);
void driver_advance(tribo_driver *drv, double *t, double t1, double *y);
size_t driver_count(const tribo_driver *drv, int which);
size_t driver_freedom(const tribo_driver *drv);

/* Advances y from 0 to t1 with a driver of its own. */
void run(tribo_system *sys, const char *method, double dt, double tolerance, double t1, double *y);

/* Returns a random number, from <= number < to, and changes the seed. */
double between(uint64_t *seed, double from, double to);

/* The largest |x_i - y_i| of n. */
double largest_difference(const double *x, const double *y, size_t n);

/* The sum of the n <= 16 multipliers of the periodic motion (t, y) that drv has found, and that of their squares, differ by less
 * than error from the traces of the map over the period and of its square, by differences of motions from y_j - h and y_j + h. */
void assert_traces(tribo_driver *drv, size_t n, double t, double period, const double *y, double h, double error);

tribo_system *oscillator(int law, double alpha, double omega);

/* Dissipation of the last of so many cycles, starting from q_0 = x0 and rest, in fixed steps of at most dt that divide the cycle,
 * with epsilon = width steps. Destroys sys. */
double dissipation(tribo_system *sys, double omega, int cycles, double x0, double dt, double width);

/* Slope of log(error) over log(dt), between the first and the last. */
double order_of(const double *dt, const double *error, size_t n);

#endif
