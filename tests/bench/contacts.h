/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes of contacts whose forces are known, called over and over. */
#ifndef TRIBO_BENCH_CONTACTS_H
#define TRIBO_BENCH_CONTACTS_H

#include "tribo/tribo.h"

/* How contacts are coupled. In a dense group or an island every contact feels all others, in a chain two, on a carpet four. */
enum coupled { ALONE, ISLANDS, DENSE, CHAIN, CARPET };
enum { ISLAND = 8 };

/* What is different from call to call, besides a: nothing; one contact slides off or comes to rest; half of them do; some do; or
 * the operator is set anew. */
enum change { SAME, ONE, HALF, SOME, ANEW };

struct contacts {
    size_t n;
    tribo_context *ctx;
    size_t *first, *col; /* R in compressed rows, and dense if that is what the scene is for */
    double *val, *dense;
    size_t awake, *place;           /* contacts near stick, and which they are */
    double *v[2], *a[2], *stuck[2]; /* those of even calls and of odd ones; f, unless one contact moves */
    double *f;
    enum change change;
    size_t calls, mover;
};

/* Every stride-th island is awake, or none if stride is 0; the others slide, fast. A carpet is as nearly square as n lets it be.
 */
void contacts_create(struct contacts *s, enum coupled coupled, size_t n, size_t stride, enum change change);
void contacts_destroy(struct contacts *s);

/* A call of tribo_balance; to struct contacts, for jobs. */
void contacts_call(void *contacts);

/* How far the forces of the last call are from a fixed point, by R itself: largest |z''| of contacts at rest inside their limits,
 * in terms of the sum that it is, and largest excess over the limit, 1. */
double contacts_error(const struct contacts *s);

/* Work of so many calls, of each. */
struct counts {
    double skipped, solves, reused, factorizations, updates;
};
struct counts contacts_count(struct contacts *s, size_t calls);

#endif
