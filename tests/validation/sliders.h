/* SPDX-License-Identifier: BSD-3-Clause */
/* Structures with sliders without mass on springs. */
#ifndef TRIBO_TESTS_SLIDERS_H
#define TRIBO_TESTS_SLIDERS_H

#include "make.h"
#include "run.h"

/* dense_system, whose failure ends the test. */
tribo_system *linear(size_t n, size_t c, const double *mass, const double *damping, const double *stiffness,
                     const double *direction);

/* x'' + 0.1 x' + x + f = cos 1.1 t, f that of so many equal elements in parallel, of k = 1 and this limit all together. */
tribo_system *element(double limit, size_t elements);

/* An observer: most, a double, becomes the largest q_0 that it sees. */
int see_most(const tribo_moment *moment, void *most);

/* Masses 1, 2, 1.5 on springs, loads, and a rigid contact on mass 2; sliders: on mass 0 to the ground, between masses 0 and 1,
 * and on mass 1 to a moving base. */
#define MASSES 3
#define SLIDERS 3
#define DOFS (MASSES + SLIDERS)
extern const double masses[MASSES], springs[SLIDERS], limits[SLIDERS], grounded[MASSES][MASSES];
extern const double base_speed, base_omega, load_omega, rigid_limit;

/* Springs of this stiffness between slider 0, 1 and 2. Its limits are still to be set: [SLIDERS + 1], the last that of the rigid
 * contact. */
tribo_system *structure(double between);

#endif
