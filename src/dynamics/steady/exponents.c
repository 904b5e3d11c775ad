/* SPDX-License-Identifier: BSD-3-Clause */
/* Exponents of small motions about an equilibrium, and the equilibrium for callers. */
#include "equilibrium.h"
#include "common/imaginary.h"
#include "common/layout.h"
#include "common/real.h"
#include "numerics/linalg.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest imaginary part of a square, relative to the square, that may be rounding of two equal ones. */
#define ROUNDING 1e-7

/* Appends lambda = re + i im. */
static void exponents_append(struct exponents *x, double re, double im)
{
    size_t at = x->count++;
    for (; at > 0 && (x->re[at - 1] < re || (x->re[at - 1] == re && x->im[at - 1] < im)); at--) {
        x->re[at] = x->re[at - 1];
        x->im[at] = x->im[at - 1];
    }
    x->re[at] = re;
    x->im[at] = im;
}

int tribo_equilibrium_exponents(const struct equilibrium *e, struct exponents *x)
{
    const size_t m = e->modes, all = 2 * m;
    double *stiffness, *damping, *a, *re, *im;
    *x = (struct exponents){0};
    if (!ALLOCATE(ARRAY(x->re, all), ARRAY(x->im, all), ARRAY(x->square, all), ARRAY(stiffness, m * m), ARRAY(damping, m * m),
                  ARRAY(a, all * all), ARRAY(re, all), ARRAY(im, all))) {
        return tribo_error(e->message, TRIBO_ERR_MEMORY, "out of memory for exponents of %zu mode%s", m, plural(m));
    }
    const int even = tribo_equilibrium_stiffness(e, stiffness);
    int status;
    x->undamped = !tribo_equilibrium_damping(e, damping);
    if (x->undamped && even) {
        tribo_even_out(m, stiffness);
        status = tribo_symmetric_eigen(stiffness, m, x->square);
    } else if (x->undamped) {
        status = tribo_eigen(stiffness, m, x->square, x->square + m, NULL);
    } else {
        for (size_t at = 0; at < m * m; at++) {
            const size_t k = at / m, l = at % m;
            a[k * all + m + l] = k == l;
            a[(m + k) * all + l] = -stiffness[at];
            a[(m + k) * all + m + l] = -damping[at];
        }
        status = tribo_eigen(a, all, re, im, NULL);
    }
    for (size_t k = 0; !status && x->undamped && k < m; k++) { /* lambda = i sqrt(square), - i sqrt(square) */
        double *rest = &x->square[m + k];
        *rest = fabs(*rest) > ROUNDING * fabs(x->square[k]) ? *rest : 0.0;
        const double half = 0.5 * atan2(*rest, x->square[k]), size = sqrt(hypot(x->square[k], *rest));
        if (*rest == 0.0) {
            exponents_append(x, x->square[k] < 0.0 ? size : 0.0, x->square[k] < 0.0 ? 0.0 : size);
        }
        if (*rest > 0.0) {
            exponents_append(x, size * sin(half), size * cos(half));
        }
        if (*rest > 0.0 || x->square[k] < 0.0) {
            exponents_append(x, -size * sin(half), *rest > 0.0 ? size * cos(half) : 0.0);
        }
    }
    for (size_t k = 0; !status && !x->undamped && k < all; k++) {
        if (im[k] >= 0.0) {
            exponents_append(x, re[k], im[k]);
        }
    }
    return status ? tribo_error(e->message, status, "exponents of %zu mode%s: %s", m, plural(m), tribo_strerror(status))
                  : TRIBO_OK;
}

int tribo_system_equilibrium(tribo_system *sys, const signed char *given, double *y, signed char *slip, size_t *count, double *re,
                             double *im)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (!y || !count != !re || !re != !im) {
        return tribo_error(sys->message, TRIBO_ERR_NULL, "%s is NULL", !y ? "y" : "one of count, re and im");
    }
    struct equilibrium e;
    struct exponents x = {0};
    int status = tribo_equilibrium_create(&e, sys, given, y);
    status = status ? status : tribo_equilibrium_find(&e);
    status = status || !count ? status : tribo_equilibrium_exponents(&e, &x);
    if (!status && sys->expansion.place) {
        tribo_system_put_steady(sys, e.q, e.f, e.y);
        tribo_system_write_state(e.sys, 0.0, e.y, y);
    } else if (!status) {
        tribo_system_put_steady(sys, e.q, e.f, y);
    }
    if (!status && slip) {
        memcpy(slip, e.slip, sys->ncontact);
    }
    if (!status && count) {
        size_t at = 0;
        for (size_t k = 0; k < x.count; k++) {
            for (int pair = 0; pair <= (x.im[k] > 0.0); pair++, at++) {
                re[at] = x.re[k];
                im[at] = pair ? -x.im[k] : x.im[k];
            }
        }
        *count = at;
    }
    free(x.re);
    tribo_equilibrium_free(&e);
    return status;
}
