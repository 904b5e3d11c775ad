/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts that share no body, and the calls whose cost a contact is looked at. */
#ifndef TRIBO_BENCH_KERNEL_SCENE_H
#define TRIBO_BENCH_KERNEL_SCENE_H

#include "tribo/tribo.h"

enum kernel { FORCE, FORCE_SLIDE, FORCE_TANGENT, BALANCE, BALANCE_STUCK, BALANCE_SLIDE, STEP, STEP_STUCK, SET_LIMIT, KERNELS };
extern const char *const kernel_name[KERNELS];

/* What contacts have in common. */
enum likeness { NOTHING, ONE_EPSILON, ALL, LIKENESSES };

struct kernel_scene {
    enum kernel kernel;
    size_t n;
    tribo_context *ctx;
    double *limit, *v, *a; /* [n]; a is f_eq where that is given */
    double *out[4];
};

/* Velocities are within two epsilons, or of BALANCE_STUCK within one, of kernels that slide beyond; a step stops none, or of
 * STEP_STUCK all. */
void kernel_scene_create(struct kernel_scene *s, enum kernel kernel, size_t n, enum likeness like);
void kernel_scene_destroy(struct kernel_scene *s);

void kernel_call(struct kernel_scene *s);

#endif
