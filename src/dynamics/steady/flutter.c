/* SPDX-License-Identifier: BSD-3-Clause */
/* The factor of friction, or of base velocities, at which steady sliding ceases to be stable.
 *
 *     the first of the factors tried that is unstable, and bisection between it and the one before
 *     the zero of a quantity that is smooth in the factor there:
 *         damped: the largest Re lambda
 *         undamped, two squares merge: (square_1 - square_2)^2, of which they are the square root
 *         undamped, a square falls below 0: the square */
#include "equilibrium.h"
#include "common/imaginary.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* FACTORS: factors tried. HALVINGS: of the distance of two of them. STEPS: most steps to the zero. */
enum { FACTORS = 128, HALVINGS = 14, STEPS = 100 };

/* Re lambda, relative to the largest |lambda|, up to which a damped motion counts as stable. */
#define NOISE 1e-13

/* Distance of exponents, relative, of one motion at both ends of the bisection. */
#define NEAR 0.05

/* Weight of the distance of two squares, against that of their mean from the mean wanted. */
#define CLOSE 1e-2

/* What ceases to be stable. */
enum kind { GROWS, MERGE, FALLS };

struct onset {
    struct equilibrium *e;
    int parameter;
    enum kind kind;
    double complex at; /* lambda; of MERGE the mean of the squares */
    double omega;      /* frequency of the motion, by the last quantity */
    size_t border; /* GROWS: number of motions of about this frequency with Re lambda >= 0, to rounding, by the last quantity */
    size_t still;  /* GROWS: border at the stable end: motions without damping, beside the one that grows */
};

/* Finds the exponents at a factor. Returns a status. */
static int flutter_exponents(struct onset *o, double factor, struct exponents *x)
{
    *(o->parameter == TRIBO_FLUTTER_FRICTION ? &o->e->friction : &o->e->speed) = factor;
    *x = (struct exponents){0};
    const int status = tribo_equilibrium_find(o->e);
    return status ? status : tribo_equilibrium_exponents(o->e, x);
}

/* Sets *value = the quantity that is zero at the onset, > 0 beyond. GROWS: the largest Re lambda; if that is 0, the largest one
 * below those of `still` motions. Returns a status. */
static int flutter_quantity(struct onset *o, double factor, double *value)
{
    struct exponents x;
    const int status = flutter_exponents(o, factor, &x);
    const size_t m = o->e->modes;
    const double noise = NOISE * cabs(o->at);
    double best = HUGE_VAL;
    size_t found = 0;
    *value = o->kind == GROWS ? -cabs(o->at) : 0.0; /* without such a motion, as where a normal is apart */
    o->border = 0;
    for (size_t k = 0; !status && o->kind == GROWS && k < x.count; k++) {
        const double off = fabs(x.im[k] - cimag(o->at));
        if (off <= NEAR * cabs(o->at)) {
            *value = found == 0 || (found <= o->still && *value <= noise) ? x.re[k] : *value;
            o->omega = off < best ? x.im[k] : o->omega;
            best = lesser(best, off);
            o->border += x.re[k] >= -noise;
            found++;
        }
    }
    for (size_t k = 0; !status && o->kind == FALLS && k < m; k++) {
        *value = k == 0 ? -x.square[k] : greater(*value, -x.square[k]);
    }
    for (size_t at = 0; !status && o->kind == MERGE && at < m * m; at++) {
        const size_t k = at / m, l = at % m;
        const double complex one = x.square[k] + x.square[m + k] * I, other = x.square[l] + x.square[m + l] * I;
        const double cost = cabs(0.5 * (one + other) - o->at) + CLOSE * cabs(one - other);
        if (k < l && cost < best) {
            best = cost;
            *value = -creal((one - other) * (one - other));
            o->omega = sqrt(fabs(0.5 * creal(one + other)));
        }
    }
    free(x.re);
    return status;
}

/* Sets *unstable = factor, and what happens there by the exponent of the largest growth, or *stable = factor. Returns a
 * status. */
static int flutter_try(struct onset *o, double factor, double *stable, double *unstable)
{
    struct exponents x;
    const int status = flutter_exponents(o, factor, &x);
    double most = 0.0;
    for (size_t k = 0; k < x.count; k++) {
        most = greater(most, hypot(x.re[k], x.im[k]));
    }
    if (!status && x.count > 0 && x.re[0] > (x.undamped ? 0.0 : NOISE * most)) {
        const double complex lambda = x.re[0] + x.im[0] * I;
        *unstable = factor;
        o->kind = !x.undamped ? GROWS : x.im[0] > 0.0 ? MERGE : FALLS;
        o->at = o->kind == MERGE ? -creal(lambda * lambda) : lambda;
    } else if (!status) {
        *stable = factor;
    }
    free(x.re);
    return status;
}

/* Sets *critical = the factor at which the quantity is 0, between two factors near to each other (Dowell and Jarratt 1971).
 * Returns a status. */
static int flutter_zero(struct onset *o, double stable, double unstable, double *critical)
{
    double a = stable, b = unstable, fa, fb, f = 0.0, x = b;
    int status = flutter_quantity(o, a, &fa), side = 0;
    if (!status && o->border > 0) {
        o->still = o->border;
        status = flutter_quantity(o, a, &fa);
    }
    status = status ? status : flutter_quantity(o, b, &fb);
    if (!status && !(fb > 0.0)) {
        return tribo_error(o->e->message, TRIBO_ERR_NO_CONVERGENCE, "no single motion loses its stability at the factor %g", b);
    }
    x = fa < 0.0 ? b : a;
    for (int step = 0; !status && fa < 0.0 && step < STEPS && fabs(b - a) > 2.0 * DBL_EPSILON * fabs(b); step++) {
        x = b - fb * (b - a) / (fb - fa);
        status = flutter_quantity(o, x, &f);
        if (f == 0.0) {
            break;
        }
        if (f > 0.0) {
            b = x;
            fb = f;
            fa *= side > 0 ? 0.5 : 1.0;
            side = 1;
        } else {
            a = x;
            fa = f;
            fb *= side < 0 ? 0.5 : 1.0;
            side = -1;
        }
    }
    /* where a normal touches there are no exponents, and they may jump: the frequency is that of the unstable end */
    status = !status || status == TRIBO_ERR_UNSUPPORTED ? flutter_quantity(o, status ? b : x, &f) : status;
    *critical = x;
    return status;
}

int tribo_system_find_flutter(tribo_system *sys, int parameter, const signed char *given, const double *y, double from, double to,
                              double *critical, double *omega)
{
    int status = tribo_system_check_given(sys, critical, "critical");
    if (!status && parameter != TRIBO_FLUTTER_FRICTION && parameter != TRIBO_FLUTTER_SPEED) {
        return tribo_error(sys->message, TRIBO_ERR_RANGE, "parameter = %d is no TRIBO_FLUTTER_...", parameter);
    }
    static const char *const names[] = {"from", "to"};
    status = status ? status : tribo_check_numbers(sys->message, 2, names, (const double[]){from, to});
    status = status ? status : tribo_check_number(sys->message, NOT_NEGATIVE, from, "from = %g", from);
    status = status ? status : tribo_check_number(sys->message, NOT_NEGATIVE, to, "to = %g", to);
    if (status) {
        return status;
    }
    struct equilibrium e;
    struct onset o = {.e = &e, .parameter = parameter};
    double stable = from, unstable = HUGE_VAL, found = HUGE_VAL;
    status = tribo_equilibrium_create(&e, sys, given, y);
    for (int k = 0; !status && unstable == HUGE_VAL && k <= FACTORS; k++) {
        status = flutter_try(&o, from + (to - from) * (k / (double)FACTORS), &stable, &unstable);
    }
    if (!status && unstable == from) {
        status = tribo_error(sys->message, TRIBO_ERR_RANGE, "steady sliding is not stable at the factor from = %g", from);
    }
    for (int k = 0; !status && unstable < HUGE_VAL && k < HALVINGS; k++) {
        status = flutter_try(&o, 0.5 * (stable + unstable), &stable, &unstable);
    }
    status = status || unstable == HUGE_VAL ? status : flutter_zero(&o, stable, unstable, &found);
    if (!status) {
        *critical = found;
    }
    if (!status && omega) {
        *omega = o.omega;
    }
    tribo_equilibrium_free(&e);
    return status;
}
