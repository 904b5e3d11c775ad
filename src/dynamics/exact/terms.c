/* SPDX-License-Identifier: BSD-3-Clause */
/* Terms of a motion, sums over terms, and sums over shapes. Terms are computed TRIBO_TERMS at a time: in a single sum each
 * addition waits for the one before. */
#include "motion.h"
#include "common/real.h"
#include "common/simd.h"
#include "dynamics/system/cos_sin.h"

#include <math.h>

enum { T = TRIBO_TERMS };

/* |lambda delta| up to which the series up to (lambda delta)^4 gives e^{lambda delta} to rounding. */
#define CLOSE 1e-3

/* re + i im = a b of four terms. Callers' arrays are restrict, or compilers would not compute several terms at once. */
static inline void multiply(const double *ar, const double *ai, const double *br, const double *bi, double *re, double *im)
{
    for (size_t k = 0; k < T; k++) {
        re[k] = ar[k] * br[k] - ai[k] * bi[k];
        im[k] = ar[k] * bi[k] + ai[k] * br[k];
    }
}

/* Sets w' = lambda w and w'' = lambda w'; lambda = re + i im. */
static inline void derive(const double *re, const double *im, struct lot *lot)
{
    multiply(re, im, lot->re[0], lot->im[0], lot->re[1], lot->im[1]);
    multiply(re, im, lot->re[1], lot->im[1], lot->re[2], lot->im[2]);
}

/* Sets w = e z, with derivatives. Imaginary parts stand n numbers after real parts of lambda, `next` after those of e and z. */
TRIBO_SIMD_OF_FOUR static void turn_terms(size_t n, size_t next, const double *restrict lambda, const double *restrict e,
                                          const double *restrict z, struct lot *restrict lot)
{
    for (size_t p = 0; p < n; p += T, lot++) {
        multiply(e + p, e + next + p, z + p, z + next + p, lot->re[0], lot->im[0]);
        derive(lambda + p, lambda + n + p, lot);
    }
}

TRIBO_SIMD_OF_FOUR void tribo_modal_terms_rest(size_t n, size_t next, const double *restrict lambda, double *restrict e,
                                               const double *restrict z, struct lot *restrict lot)
{
    for (size_t p = 0; p < n; p += T, lot++) {
        for (size_t k = 0; k < T; k++) {
            e[p + k] = 1.0;
            e[next + p + k] = 0.0;
            lot->re[0][k] = z[p + k];
            lot->im[0][k] = z[next + p + k];
        }
        derive(lambda + p, lambda + n + p, lot);
    }
}

/* re + i im = e^{lambda delta} of four terms, for small lambda delta. */
static inline void grow_little(const double *restrict lr, const double *restrict li, double delta, double *restrict re,
                               double *restrict im)
{
    for (size_t k = 0; k < T; k++) {
        const double x = lr[k] * delta, y = li[k] * delta, x2 = x * x - y * y, y2 = 2.0 * x * y;
        const double r = 0.5 + (x * (1 / 6.) + x2 * (1 / 24.)), i = y * (1 / 6.) + y2 * (1 / 24.);
        re[k] = 1.0 + (x + (x2 * r - y2 * i));
        im[k] = y + (x2 * i + y2 * r);
    }
}

/* Sets w = e^{lambda delta} e z, with derivatives. */
TRIBO_SIMD_OF_FOUR static void turn_little(size_t n, size_t next, double delta, const double *restrict lambda,
                                           const double *restrict e, const double *restrict z, struct lot *restrict lot)
{
    for (size_t p = 0; p < n; p += T, lot++) {
        double re[T], im[T], er[T], ei[T];
        grow_little(lambda + p, lambda + n + p, delta, re, im);
        multiply(re, im, e + p, e + next + p, er, ei);
        multiply(er, ei, z + p, z + next + p, lot->re[0], lot->im[0]);
        derive(lambda + p, lambda + n + p, lot);
    }
}

/* Below SMALL a series of SERIES terms gives (e^z - 1)/z to rounding; below LITTLE, of FEWER. */
#define SMALL 0.5
#define LITTLE 0.1
enum { SERIES = 18, FEWER = 12 };

double complex tribo_exp_1(double complex z)
{
    const double x = creal(z), y = cimag(z), size = fabs(x) + fabs(y);
    if (size >= SMALL) {
        return (cexp(z) - 1.0) / z;
    }
    double re = 1.0, im = 0.0;
    for (int k = (size < LITTLE ? FEWER : SERIES) - 1; k > 1; k--) { /* sum = 1 + sum z/k */
        const double old = re;
        re = 1.0 + (x * old - y * im) / k;
        im = (x * im + y * old) / k;
    }
    return re + im * I;
}

/* w = e^{lambda tau} z. e^{lambda tau} is computed from tau, or from e^{lambda far} if tau is close to far. Other looks do not
 * start at far: the rounding of w at late times must not vary from look to look. */
void tribo_modal_terms_go(struct exact *x, double tau)
{
    const struct forced *h = x->h;
    if (fabs(tau - x->far) * h->quickest < CLOSE) {
        turn_little(h->terms, x->room, tau - x->far, h->lr, x->far_e.re, x->z.re, x->lot);
        return;
    }
    x->far = tau;
    tribo_cos_sin_all(tau, h->terms, h->li, x->far_e.re, x->far_e.im);
    for (size_t p = 0; (h->decay > 0.0 || h->growth > 0.0) && p < h->modal->exponents; p++) {
        if (h->lr[p] != 0.0) {
            const double size = exp(h->lr[p] * tau);
            x->far_e.re[p] *= size;
            x->far_e.im[p] *= size;
        }
    }
    turn_terms(h->terms, x->room, h->lr, x->far_e.re, x->z.re, x->lot);
}

/* ------------------------------------------------------------------------------------------------------- outputs in a phase */

/* to = from + Re(a b) of four terms. */
static inline void add_real_parts(const double *from, const double *restrict ar, const double *restrict ai,
                                  const double *restrict br, const double *restrict bi, double *to)
{
    for (size_t k = 0; k < T; k++) {
        to[k] = from[k] + (ar[k] * br[k] - ai[k] * bi[k]);
    }
}

/* to = from + a b of four terms. */
static inline void add_products(const double *from, const double *restrict a, const double *restrict b, double *to)
{
    for (size_t k = 0; k < T; k++) {
        to[k] = from[k] + a[k] * b[k];
    }
}

static const double nothing[T];

/* sum [3][T] = sums of Re(c w), Re(c w'), Re(c w''), c [2][n]. sum is an array of the caller: with a local array compilers take
 * several fours at once, and reorder them first. */
TRIBO_SIMD_OF_FOUR static void sum_terms(size_t n, const double *c, const struct lot *lot, double *restrict sum)
{
    add_real_parts(nothing, c, c + n, lot->re[0], lot->im[0], sum);
    add_real_parts(nothing, c, c + n, lot->re[1], lot->im[1], sum + T);
    add_real_parts(nothing, c, c + n, lot->re[2], lot->im[2], sum + 2 * T);
    for (size_t p = T; p < n; p += T) {
        lot++;
        add_real_parts(sum, c + p, c + n + p, lot->re[0], lot->im[0], sum);
        add_real_parts(sum + T, c + p, c + n + p, lot->re[1], lot->im[1], sum + T);
        add_real_parts(sum + 2 * T, c + p, c + n + p, lot->re[2], lot->im[2], sum + 2 * T);
    }
}

/* sum [2][T] = sums of |c| growth and |c| growth6: bounds of the output and of the sixth derivative. */
TRIBO_SIMD_OF_FOUR static void sum_bounds(size_t n, const double *size, const double *growth, const double *growth6,
                                          double *restrict sum)
{
    add_products(nothing, size, growth, sum);
    add_products(nothing, size, growth6, sum + T);
    for (size_t p = T; p < n; p += T) {
        add_products(sum, size + p, growth + p, sum);
        add_products(sum + T, size + p, growth6 + p, sum + T);
    }
}

static double total(const double *sum)
{
    return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

void tribo_course_look(const struct exact *x, struct course *c)
{
    double sum[3 * T];
    if (x->h->modal->powers) {
        const struct curve curve = {.term = c->power, .terms = x->tau > 0.0 ? TRIBO_POWERS : 3, .stride = 1};
        c->tau = x->tau;
        c->at = (struct sample){0.0, 0.0, 0.0};
        tribo_curve_add(&curve, x->tau, 1.0, &c->at);
        return;
    }
    sum_terms(x->h->terms, c->output->cr, x->lot, sum);
    c->tau = x->tau;
    struct sample line = {c->start, 0.0, 0.0};
    if (x->runs) {
        line.g += (c->ramp + (c->square + c->cube * x->tau) * x->tau) * x->tau;
        line.d = c->ramp + (2.0 * c->square + 3.0 * c->cube * x->tau) * x->tau;
        line.e = 2.0 * c->square + 6.0 * c->cube * x->tau;
    }
    c->at = (struct sample){total(sum) + line.g, total(sum + T) + line.d, total(sum + 2 * T) + line.e};
}

void tribo_course_bound(const struct exact *x, struct course *c)
{
    double sum[2 * T];
    if (x->h->modal->powers) {
        c->size = tribo_size_of_eight(TRIBO_POWERS, x->growth, c->power);
        c->bend = tribo_size_of_eight(TRIBO_POWERS, x->growth6, c->power);
        return;
    }
    sum_bounds(x->h->terms, c->output->size, x->growth, x->growth6, sum);
    c->size = total(sum) + fabs(c->start);
    if (x->runs) {
        /* a limit by a table, over a time of the structure's: its rounding must not depend on where the next knot is */
        const int of_table = x->sys->loads.limit_tables && c->output >= x->h->output + x->h->limits;
        const double time = of_table ? greater(x->longest, 1.0 / x->events.fastest) : x->longest;
        c->size += (fabs(c->ramp) + (fabs(c->square) + fabs(c->cube) * time) * time) * time;
    }
    c->bend = total(sum + T);
}

void tribo_course_begin(struct exact *x, size_t o, double value)
{
    const struct output *w = &x->h->output[o];
    struct course *c = &x->course[o];
    const int of_velocity = o < x->h->sliding, of_normal = o >= x->h->holding;
    c->output = w;
    c->start = 0.0;
    c->ramp = c->square = c->cube = 0.0;
    if (x->runs && w->on_rate) {
        c->ramp = tribo_dot(w->on_rate, of_velocity ? x->acc : of_normal ? x->drift : x->vel, x->h->shapes);
        c->square = of_normal ? 0.5 * tribo_dot(w->on_rate, x->acc, x->h->shapes) : 0.0;
    }
    if (x->sys->loads.tables && w->on_rate) {
        const double jerk = tribo_dot(w->on_rate, x->jerk, x->h->shapes);
        const double *by_u = !of_velocity && !of_normal && x->h->by_u ? x->h->by_u + w->contact * x->h->shapes : NULL;
        c->ramp += by_u ? tribo_dot(by_u, x->acc, x->h->shapes) : 0.0;
        c->square += of_velocity ? 0.5 * jerk : of_normal ? 0.0 : 0.5 * tribo_dot(w->on_rate, x->acc, x->h->shapes);
        c->cube = of_normal ? jerk / 6.0 : 0.0;
    }
    tribo_course_look(x, c);
    if (x->h->modal->powers) {
        c->power[0] = value;
    }
    c->start = value - c->at.g;
    c->at.g = value;
    if (x->sys->loads.limit_tables && o >= x->h->limits) {
        c->ramp = x->slopes.rise[w->contact] - c->at.d;
        c->at.d += c->ramp;
    }
    tribo_course_bound(x, c);
}
