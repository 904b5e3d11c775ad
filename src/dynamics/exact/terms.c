/* SPDX-License-Identifier: BSD-3-Clause */
/* Terms are computed TRIBO_TERMS at a time: in a single sum each addition waits for the one before. Arrays are restrict, or
 * compilers would not compute several terms at once. */
#include "terms.h"
#include "dynamics/system/cos_sin.h"
#include "common/simd.h"

#include <math.h>

enum { T = TRIBO_TERMS };

/* |lambda delta| up to which the series up to (lambda delta)^4 gives e^{lambda delta} to rounding. */
#define CLOSE 1e-3

/* re + i im = a b */
static inline void multiply(const double *restrict ar, const double *restrict ai, const double *restrict br,
                            const double *restrict bi, double *restrict re, double *restrict im)
{
    for (size_t k = 0; k < T; k++) {
        re[k] = ar[k] * br[k] - ai[k] * bi[k];
        im[k] = ar[k] * bi[k] + ai[k] * br[k];
    }
}

/* Sets w = e z, w' = lambda w and w'' = lambda w' of a lot. */
static inline void terms_turn(struct lot *lot, const double *lr, const double *li, const double *er, const double *ei)
{
    multiply(er, ei, lot->zr, lot->zi, lot->wr, lot->wi);
    multiply(lr, li, lot->wr, lot->wi, lot->w1r, lot->w1i);
    multiply(lr, li, lot->w1r, lot->w1i, lot->w2r, lot->w2i);
}

/* re + i im = e^{lambda delta}, for small lambda delta. */
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

/* Set w, w', w'' of all lots. move_nowhere: at t0. move_far: w = e z, e = e^{lambda far}. move_little: at far + delta. */
TRIBO_SIMD_OF_FOUR static void move_nowhere(size_t n, const double *lr, const double *li, struct lot *lot)
{
    static const double one[T] = {1.0, 1.0, 1.0, 1.0}, nothing[T];
    for (size_t p = 0; p < n; p += T) {
        terms_turn(lot++, lr + p, li + p, one, nothing);
    }
}

TRIBO_SIMD_OF_FOUR static void move_far(size_t n, const double *lr, const double *li, const double *er, const double *ei,
                                        struct lot *lot)
{
    for (size_t p = 0; p < n; p += T) {
        terms_turn(lot++, lr + p, li + p, er + p, ei + p);
    }
}

TRIBO_SIMD_OF_FOUR static void move_little(const struct modal_motion *x, double delta)
{
    const size_t n = x->h->terms;
    const double *lr = x->h->lr, *li = x->h->li;
    struct lot *lot = x->lot;
    for (size_t p = 0; p < n; p += T) {
        double re[T], im[T], er[T], ei[T];
        grow_little(lr + p, li + p, delta, re, im);
        multiply(re, im, x->far_r + p, x->far_i + p, er, ei);
        terms_turn(lot++, lr + p, li + p, er, ei);
    }
}

/* Below SMALL a series of SERIES terms gives (e^z - 1)/z to rounding. */
#define SMALL 0.5
#define SERIES 18

double complex tribo_exp_1(double complex z)
{
    if (cabs(z) >= SMALL) {
        return (cexp(z) - 1.0) / z;
    }
    const double x = creal(z), y = cimag(z);
    double re = 1.0, im = 0.0;
    for (int k = SERIES - 1; k > 1; k--) { /* sum = 1 + sum z/k */
        const double old = re;
        re = 1.0 + (x * old - y * im) / k;
        im = (x * im + y * old) / k;
    }
    return re + im * I;
}

static inline void clear(double *re, double *im)
{
    for (size_t k = 0; k < T; k++) {
        re[k] = im[k] = 0.0;
    }
}

void tribo_modal_terms_clear(struct modal_motion *x)
{
    const size_t last = x->h->terms - T;
    clear(x->lot[last / T].zr, x->lot[last / T].zi);
    clear(x->growth + last, x->growth6 + last);
}

void tribo_modal_terms_rest(struct modal_motion *x)
{
    x->looked = 0;
    x->tau = 0.0;
    move_nowhere(x->h->terms, x->h->lr, x->h->li, x->lot);
}

/* w = e^{lambda tau} z. e^{lambda tau} is computed from tau, or from e^{lambda far} if tau is close to far. Other looks do not
 * start at far: the rounding of w at late times must not vary from look to look. */
void tribo_modal_terms_go(struct modal_motion *x, double tau)
{
    const struct forced *h = x->h;
    x->tau = tau;
    if (x->looked && fabs(tau - x->far) * h->quickest < CLOSE) {
        move_little(x, tau - x->far);
    } else {
        x->looked = 1;
        x->far = tau;
        /* re + i im = e^{lambda tau} of all terms */
        double *re = x->far_r;
        double *im = x->far_i;
        tribo_cos_sin_all(tau, h->terms, h->li, re, im);
        for (size_t p = 0; (h->decay > 0.0 || h->growth > 0.0) && p < h->exponents; p++) {
            if (h->lr[p] != 0.0) {
                const double size = exp(h->lr[p] * tau);
                re[p] *= size;
                im[p] *= size;
            }
        }
        move_far(h->terms, h->lr, h->li, x->far_r, x->far_i, x->lot);
    }
}
