/* SPDX-License-Identifier: BSD-3-Clause */
/* The box problem min 1/2 x'Rx + q'x, lo <= x <= hi, of at most SMALL variables, R far from singular: x follows from sets of free
 * variables and the inverse of R over these. The functions are inline: a caller with a constant n gets straight code. */
#ifndef TRIBO_SMALL_H
#define TRIBO_SMALL_H

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "box_qp.h"

enum { SMALL = 4 };

/* Inputs of a problem are at most this: products with R and its inverse are numbers. */
#define TRIBO_SMALL_MOST 1e100

/* A problem of n <= SMALL variables. Arrays are [n] unless stated. */
struct small {
    const double *r;            /* [n][n] */
    double *inverse;            /* [n][n] of R over the variables in *inverse_of; 0 elsewhere */
    unsigned *inverse_of;       /* bit i: variable i is in the set */
    const double *part, *least; /* rounding error bound of gradient_i: part_i (sizes of its terms + least_i) */
    const double *q, *lo, *hi;
    signed char *at;      /* AT_LOWER, ...; AWAY: x_i is given */
    double *x, *gradient; /* the solution, R x + q */
};

/* inverse [n][n] = R^-1 over set, 0 elsewhere, by bordering. */
static inline void tribo_small_invert(size_t n, const double *r, unsigned set, double *inverse)
{
    memset(inverse, 0, n * n * sizeof *inverse);
    for (size_t i = 0; i < n; i++) {
        double z[SMALL] = {0.0}, pivot = 0.0;
        z[i] = 1.0;
        for (size_t k = 0; k < i; k++) {
            for (size_t l = 0; l < i; l++) {
                z[k] -= inverse[k * n + l] * r[l * n + i];
            }
        }
        for (size_t k = 0; k <= i; k++) {
            pivot += r[i * n + k] * z[k];
        }
        for (size_t k = 0; (set >> i & 1u) && k <= i; k++) {
            for (size_t l = 0; l <= i; l++) {
                inverse[k * n + l] += z[k] * z[l] / pivot;
            }
        }
    }
}

/* 1 if R_ii are plain numbers and 1/(R^-1)_ii >= 0.01 R_ii, so that inverses over all sets are good to rounding. inverse [n][n]
 * is zero on return. */
static inline int tribo_small_fits(size_t n, const double *r, double *inverse)
{
    const double least_pivot = 0.01;
    int fits = n <= SMALL;
    for (size_t i = 0; fits && i < n; i++) {
        fits = r[i * (n + 1)] >= 1.0 / TRIBO_SMALL_MOST && r[i * (n + 1)] <= TRIBO_SMALL_MOST;
    }
    if (fits) {
        tribo_small_invert(n, r, (1u << n) - 1, inverse);
    }
    for (size_t i = 0; fits && i < n; i++) {
        fits = inverse[i * (n + 1)] > 0.0 && least_pivot * inverse[i * (n + 1)] * r[i * (n + 1)] < 1.0;
    }
    memset(inverse, 0, n * n * sizeof *inverse);
    return fits;
}

/* Returns the rounding error bound of gradient_i. */
static inline double tribo_small_noise(size_t n, const struct small *s, size_t i)
{
    double size = fabs(s->q[i]);
    for (size_t j = 0; j < n; j++) {
        size += fabs(s->r[i * n + j] * s->x[j]);
    }
    return s->part[i] * (size + s->least[i]);
}

/* Sets gradient = R x + q. Returns 1 if the gradients of free variables are noise, of which a part of q is the cheapest bound. */
static inline int tribo_small_gradients(size_t n, const struct small *s)
{
    double sum[SMALL] = {0.0};
    int settled = 1;
    for (size_t j = 0; j < n; j++) {
        for (size_t i = 0; i < n; i++) {
            sum[i] += s->r[j * n + i] * s->x[j];
        }
    }
    for (size_t i = 0; i < n; i++) {
        const double size = fabs(sum[i] + s->q[i]);
        s->gradient[i] = sum[i] + s->q[i];
        settled &= s->at[i] != FREE || size <= s->part[i] * fabs(s->q[i]) || size <= tribo_small_noise(n, s, i);
    }
    return settled;
}

/* x -= R^-1 gradient over the free variables. */
static inline void tribo_small_step(size_t n, const struct small *s, const double *gradient)
{
    double step[SMALL] = {0.0};
    for (size_t j = 0; j < n; j++) {
        for (size_t i = 0; i < n; i++) {
            step[i] += s->inverse[j * n + i] * gradient[j];
        }
    }
    for (size_t i = 0; i < n; i++) {
        s->x[i] -= step[i];
    }
}

/* Finds x for the sets in at. Returns 1 if the gradients of free variables are noise, after three steps of Newton's at most. */
static inline int tribo_small_find(size_t n, const struct small *s)
{
    unsigned set = 0;
    double gradient[SMALL];
    for (size_t i = 0; i < n; i++) {
        const signed char at = s->at[i];
        set |= (unsigned)(at == FREE) << i;
        s->x[i] = at == AT_LOWER ? s->lo[i] : at == AT_UPPER ? s->hi[i] : at == FREE ? 0.0 : s->x[i];
        gradient[i] = s->q[i];
    }
    if (set != *s->inverse_of) {
        tribo_small_invert(n, s->r, set, s->inverse);
        *s->inverse_of = set;
    }
    for (size_t j = 0; set && j < n; j++) {
        for (size_t i = 0; i < n; i++) {
            gradient[i] += s->r[j * n + i] * s->x[j];
        }
    }
    if (set) {
        tribo_small_step(n, s, gradient);
    }
    for (int pass = 0; pass < 3; pass++) {
        if (tribo_small_gradients(n, s)) {
            return 1;
        }
        tribo_small_step(n, s, s->gradient);
    }
    return 0;
}

/* Solves the problem, beginning with the sets in at[]: frees variable i at a bound if minus its gradient, beyond noise, points
 * into the box, and sets free variables outside the box to the bound. Returns 0 if at[] changes in each of 2 n + 2 rounds, or if
 * tribo_small_find fails. */
static inline int tribo_small_solve(size_t n, const struct small *s)
{
    for (size_t round = 0; round < 2 * n + 2 && tribo_small_find(n, s); round++) {
        int changed = 0;
        for (size_t i = 0; i < n; i++) {
            const signed char at = s->at[i];
            if (at == FREE) {
                s->at[i] = (signed char)((s->x[i] > s->hi[i]) - (s->x[i] < s->lo[i]));
            } else if (at != AWAY && at * s->gradient[i] > 0.0 && s->lo[i] < s->hi[i] &&
                       at * s->gradient[i] > tribo_small_noise(n, s, i)) {
                s->at[i] = FREE;
            }
            changed |= s->at[i] != at;
        }
        if (!changed) {
            return 1;
        }
    }
    return 0;
}

#endif
