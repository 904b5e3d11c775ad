/* The third to fifth derivative of an output, where the terms are. */
#include "modal_motion.h"
#include "../common/simd.h"

enum { T = TRIBO_TERMS, FURTHER = 3 };

/* Re(c lambda w), Re(c lambda^2 w), Re(c lambda^3 w) into sum [FURTHER][T], w being the second derivatives. */
TRIBO_SIMD_OF_FOUR static void add_further(const double *restrict lr, const double *restrict li, const double *restrict cr,
                                           const double *restrict ci, const double *restrict wr, const double *restrict wi,
                                           double *restrict sum)
{
    for (size_t k = 0; k < T; k++) {
        const double r3 = lr[k] * wr[k] - li[k] * wi[k], i3 = lr[k] * wi[k] + li[k] * wr[k];
        const double r4 = lr[k] * r3 - li[k] * i3, i4 = lr[k] * i3 + li[k] * r3;
        const double r5 = lr[k] * r4 - li[k] * i4, i5 = lr[k] * i4 + li[k] * r4;
        sum[k] += cr[k] * r3 - ci[k] * i3;
        sum[T + k] += cr[k] * r4 - ci[k] * i4;
        sum[2 * T + k] += cr[k] * r5 - ci[k] * i5;
    }
}

int tribo_modal_motion_further(const struct modal_motion *x, const struct output *c, double *to)
{
    const struct modal *h = x->h;
    double sum[FURTHER * T] = {0.0};
    if (h->any_resonant) {
        return 0;
    }
    for (size_t p = 0; p < h->terms; p += T) {
        add_further(h->lr + p, h->li + p, c->cr + p, c->ci + p, x->w2r + p, x->w2i + p, sum);
    }
    for (size_t k = 0; k < FURTHER; k++) {
        to[k] = (sum[k * T] + sum[k * T + 2]) + (sum[k * T + 1] + sum[k * T + 3]);
    }
    return 1;
}
