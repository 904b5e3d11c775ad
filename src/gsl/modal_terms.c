/* Terms are done TRIBO_TERMS at a time, since one sum would wait for itself; and in places that are known apart, or compilers
 * would not do so. */
#include "modal_terms.h"
#include "cos_sin.h"
#include "../common/simd.h"

#include <math.h>

enum { T = TRIBO_TERMS };

/* Over a time this short, in terms of the fastest term, four terms of a series are all of it. */
#define CLOSE 1e-3

/* Products a b. */
static inline void multiply(const double *restrict ar, const double *restrict ai, const double *restrict br,
                            const double *restrict bi, double *restrict re, double *restrict im)
{
    for (size_t k = 0; k < T; k++) {
        re[k] = ar[k] * br[k] - ai[k] * bi[k];
        im[k] = ar[k] * bi[k] + ai[k] * br[k];
    }
}

/* w = e z, w' and w'' of n terms, each [2] a distance apart. */
TRIBO_SIMD_OF_FOUR static void move(size_t n, const double *restrict lr, const double *restrict li, const double *restrict e,
                                    const double *restrict z, double *restrict w, size_t apart)
{
    for (size_t p = 0; p < n; p += T) {
        double *w1 = w + 2 * apart, *w2 = w + 4 * apart;
        multiply(e + p, e + apart + p, z + p, z + apart + p, w + p, w + apart + p);
        multiply(lr + p, li + p, w + p, w + apart + p, w1 + p, w1 + apart + p);
        multiply(lr + p, li + p, w1 + p, w1 + apart + p, w2 + p, w2 + apart + p);
    }
}

/* e = far e^{lambda delta}, lambda delta being small. */
TRIBO_SIMD_OF_FOUR static void grow_little(size_t n, const double *restrict lr, const double *restrict li, double delta,
                                           const double *restrict far, double *restrict e, size_t apart)
{
    for (size_t p = 0; p < n; p += T) {
        double re[T], im[T];
        for (size_t k = 0; k < T; k++) {
            const double x = lr[p + k] * delta, y = li[p + k] * delta;
            double r = 1.0 + 0.25 * x, i = 0.25 * y;
            const double r3 = 1.0 + (x * r - y * i) * (1 / 3.), i3 = (x * i + y * r) * (1 / 3.);
            r = 1.0 + 0.5 * (x * r3 - y * i3);
            i = 0.5 * (x * i3 + y * r3);
            re[k] = 1.0 + (x * r - y * i);
            im[k] = x * i + y * r;
        }
        multiply(re, im, far + p, far + apart + p, e + p, e + apart + p);
    }
}

/* e^{lambda tau} of all terms. */
static void grow(const struct modal *h, double tau, double *re, double *im)
{
    if (fabs(tau) * h->quickest <= COS_SIN_NEAR) {
        tribo_cos_sin_near(tau, h->terms, h->li, re, im);
    } else {
        tribo_cos_sin_all(tau, h->terms, h->li, re, im);
    }
    for (size_t p = 0; !h->swings && p < h->exponents; p++) {
        if (h->lr[p] != 0.0) {
            const double size = exp(h->lr[p] * tau);
            re[p] *= size;
            im[p] *= size;
        }
    }
}

/* Sets the terms from begin to end, of which re and im are the parts, or those of a derivative, to a real number. */
static inline void fill(size_t begin, size_t end, double real, double *restrict re, double *restrict im)
{
    for (size_t p = begin; p < end; p += T) {
        for (size_t k = 0; k < T; k++) {
            re[p + k] = real;
            im[p + k] = 0.0;
        }
    }
}

void tribo_modal_terms_clear(struct modal_motion *x)
{
    const size_t n = x->h->terms;
    fill(n - T, n, 0.0, x->zr, x->zi);
    fill(n - T, n, 0.0, x->growth, x->growth6);
}

void tribo_modal_terms_rest(struct modal_motion *x)
{
    const struct modal *h = x->h;
    fill(0, h->terms, 1.0, x->far_r, x->far_i);
    x->far = x->tau = 0.0;
    move(h->terms, h->lr, h->li, x->far_r, x->zr, x->wr, x->room);
}

/* From t0, or, if that is close, from where it was. Far ones from t0, since what rounding leaves of a late time must not tremble
 * within a phase. */
void tribo_modal_terms_go(struct modal_motion *x, double tau)
{
    const struct modal *h = x->h;
    const double *e = x->far_r;
    x->tau = tau;
    if (fabs(tau - x->far) * h->quickest < CLOSE) {
        grow_little(h->terms, h->lr, h->li, tau - x->far, x->far_r, x->er, x->room);
        e = x->er;
    } else {
        x->far = tau;
        grow(h, tau, x->far_r, x->far_i);
    }
    move(h->terms, h->lr, h->li, e, x->zr, x->wr, x->room);
}
