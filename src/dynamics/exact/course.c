/* SPDX-License-Identifier: BSD-3-Clause */
/* An output in a phase: sums over terms, TRIBO_TERMS at a time as in terms.c, plus a line. */
#include "terms.h"
#include "common/simd.h"

#include <math.h>

enum { T = TRIBO_TERMS };

/* to = Re(a b) */
static inline void real_parts(const double *restrict ar, const double *restrict ai, const double *restrict br,
                              const double *restrict bi, double *restrict to)
{
    for (size_t k = 0; k < T; k++) {
        to[k] = ar[k] * br[k] - ai[k] * bi[k];
    }
}

/* to += Re(a b) */
static inline void add_real_parts(const double *restrict ar, const double *restrict ai, const double *restrict br,
                                  const double *restrict bi, double *restrict to)
{
    for (size_t k = 0; k < T; k++) {
        to[k] += ar[k] * br[k] - ai[k] * bi[k];
    }
}

/* to = a b */
static inline void products(const double *restrict a, const double *restrict b, double *restrict to)
{
    for (size_t k = 0; k < T; k++) {
        to[k] = a[k] * b[k];
    }
}

/* to += a b */
static inline void add_products(const double *restrict a, const double *restrict b, double *restrict to)
{
    for (size_t k = 0; k < T; k++) {
        to[k] += a[k] * b[k];
    }
}

/* sum [3][T] = sums of Re(c w), Re(c w'), Re(c w'') over lots. sum is an array of the caller: with a local array compilers take
 * several lots at once, and reorder the lots first. */
TRIBO_SIMD_OF_FOUR static void sum_terms(const struct modal_motion *x, const struct output *c, double *restrict sum)
{
    const size_t n = x->h->terms;
    const struct lot *lot = x->lot;
    real_parts(c->cr, c->ci, lot->wr, lot->wi, sum);
    real_parts(c->cr, c->ci, lot->w1r, lot->w1i, sum + T);
    real_parts(c->cr, c->ci, lot->w2r, lot->w2i, sum + 2 * T);
    for (size_t p = T; p < n; p += T) {
        lot++;
        add_real_parts(c->cr + p, c->ci + p, lot->wr, lot->wi, sum);
        add_real_parts(c->cr + p, c->ci + p, lot->w1r, lot->w1i, sum + T);
        add_real_parts(c->cr + p, c->ci + p, lot->w2r, lot->w2i, sum + 2 * T);
    }
}

/* sum [2][T] = sums of |c| growth and |c| growth6 over lots: bounds of the output and of the sixth derivative. */
TRIBO_SIMD_OF_FOUR static void sum_bounds(const struct modal_motion *x, const struct output *c, double *restrict sum)
{
    const size_t n = x->h->terms;
    products(c->size, x->growth, sum);
    products(c->size, x->growth6, sum + T);
    for (size_t p = T; p < n; p += T) {
        add_products(c->size + p, x->growth + p, sum);
        add_products(c->size + p, x->growth6 + p, sum + T);
    }
}

static double total(const double *sum)
{
    return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

void tribo_course_look(const struct modal_motion *x, struct course *c)
{
    double sum[3 * T];
    sum_terms(x, c->output, sum);
    c->tau = x->tau;
    c->at.g = total(sum) + (c->line.start + c->line.ramp * x->tau);
    c->at.d = total(sum + T) + c->line.ramp;
    c->at.e = total(sum + 2 * T);
}

void tribo_course_bound(const struct modal_motion *x, struct course *c)
{
    double sum[2 * T];
    sum_bounds(x, c->output, sum);
    c->size = total(sum) + fabs(c->line.start) + fabs(c->line.ramp) * x->longest;
    c->bend = total(sum + T);
}

void tribo_course_begin(const struct modal_motion *x, struct course *c, int of_velocity, double value)
{
    const struct output *w = c->output;
    c->line.start = 0.0;
    c->line.ramp = x->runs ? tribo_dot(w->on_rate, of_velocity ? x->acc : x->vel, x->h->shapes) : 0.0;
    tribo_course_look(x, c);
    c->line.start = value - c->at.g;
    c->at.g = value;
    tribo_course_bound(x, c);
}
