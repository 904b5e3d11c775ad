/* SPDX-License-Identifier: BSD-3-Clause */
/* Elements with a state, moved to and fro, 16 steps a half cycle. */
#ifndef TRIBO_BENCH_ELEMENTS_H
#define TRIBO_BENCH_ELEMENTS_H

#include <stddef.h>

enum element_law { DAHL, LUGRE, BOUC_WEN, IWAN, ELEMENT_LAWS };
extern const char *const element_name[ELEMENT_LAWS];

struct elements {
    enum element_law law;
    size_t n, steps;
    double *dz, *parameter, *state, *f, *df_dz;
};

/* Parameters differ from element to element. */
void elements_create(struct elements *e, enum element_law law, size_t n);
void elements_destroy(struct elements *e);

/* A step of all elements, with derivatives. */
void elements_step(void *elements);

#endif
