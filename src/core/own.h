/* SPDX-License-Identifier: BSD-3-Clause */
/* The law of the caller (tribo_set_user_law): for a velocity, f = clamp(f_eq - shift, lower, upper). */
#ifndef TRIBO_OWN_H
#define TRIBO_OWN_H

#include "context.h"

static inline int tribo_is_own(const tribo_context *ctx)
{
    return ctx->set.law == &tribo_law_own;
}

/* Rows of what the law gives: a box, its derivatives by v, by the limit. */
enum { LOWER, UPPER, SHIFT, BOX_ROWS, BY_V_ROWS = BOX_ROWS, BY_LIMIT_ROWS = 2 * BOX_ROWS, ALL_ROWS = 3 * BOX_ROWS };

/* box [BOX_ROWS][n], or if derivatives = 1 [ALL_ROWS][n], and f [n] of n <= TRIBO_CHUNK contacts at v and feq [n]. Returns 1, or
 * 0 where the law fails or its boxes are none: box and f are HUGE_VAL then. */
int tribo_own_boxes(const struct contacts *c, size_t n, int derivatives, const double *v, const double *feq, double *box,
                    double *f);

/* Where balances keep, unless tribo_all_alone, the box [BOX_ROWS][n] of the chunk of contact i between their parts: in the place of
 * the derivatives dv, dfeq and dlimit, which are one array, and are found after the box. */
static inline double *tribo_own_box(const tribo_context *ctx, size_t i)
{
    return ctx->last.tangent.dv + BOX_ROWS * (i - i % TRIBO_CHUNK);
}

/* The number of contact i in this row. */
static inline double tribo_own_at(const tribo_context *ctx, int row, size_t i)
{
    const size_t k = i % TRIBO_CHUNK;
    return tribo_own_box(ctx, i)[(size_t)row * tribo_chunk_size(ctx, i - k) + k];
}

/* The slip of a contact by its force f, within [lower, upper]. */
static inline signed char tribo_own_slip(double v, double f, double limit, double lower, double upper)
{
    const double to = v != 0.0 ? v : -f, forth = to > 0.0 ? TRIBO_SLIP_FORTH : 0.0, back = to < 0.0 ? 1.0 : 0.0;
    const double under = f < upper ? 0.0 : forth - back, slides = f > lower ? under : forth - back;
    return (signed char)(int)(limit > 0.0 ? slides : TRIBO_SLIP_OPEN); /* as slip_by_force in queries.c */
}

/* 1 if tribo_own_boxes returned 0 for a chunk of f [ctx->n], or of derivatives by v or f_eq. */
int tribo_own_failed(const tribo_context *ctx, const double *f);

/* The failure of the law at v [ctx->n], derivatives as in tribo_own_boxes; TRIBO_ERR_CALLBACK. */
int tribo_own_fail(tribo_context *ctx, int derivatives, const double *v);

/* last.slip of the chunk of contact i at v [n], from last.f and box [BOX_ROWS][n]. */
void tribo_own_slips(tribo_context *ctx, size_t i, const double *v, const double *box);

/* last.feq of contacts near stick = any f_eq for which the law is on the side of its box on which the balance left it. */
void tribo_own_sides(tribo_context *ctx);

/* *rate = the largest R_ii times slope of a law at v = 0; TRIBO_ERR_CALLBACK if it fails. */
int tribo_own_rate(const tribo_context *ctx, double *rate);

#endif
