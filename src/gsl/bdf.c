/* Backward differentiation formulas of order 1 to 5 in steps of equal length, whose backward differences are interpolated where
 * the step changes: the method "msbdf". Shampine and Reichelt, The MATLAB ODE suite, SIAM J. Sci. Comput. 18 (1997) 1, with
 * kappa = 0.
 *
 * With d_0 = y, d_j the j-th backward difference, and gamma_j = 1 + 1/2 + ... + 1/j, a step of order q ends where
 *     h f(t + h, p + c) = gamma_q (c + psi),  p = sum of d_j to q,  gamma_q psi = sum of gamma_j d_j,
 * and c is its (q+1)-th difference, 1/(q+1) of which is the error. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "newton.h"
#include "stepper.h"
#include "../common/real.h"

enum { ORDERS = 5, DIFFERENCES = ORDERS + 3 };

static const double harmonic_sum[] = {0.0, 1.0, 3.0 / 2, 11.0 / 6, 25.0 / 12, 137.0 / 60};

struct bdf {
    size_t n, order, equal; /* steps of this length in a row */
    double h;               /* 0: no differences yet */
    double *d;              /* [DIFFERENCES][n] */
    double *c, *k, *base;   /* [n] */
    struct newton newton;
};

static void destroy(void *own)
{
    struct bdf *w = own;
    if (w) {
        tribo_newton_free(&w->newton);
        free(w->d);
        free(w);
    }
}

static void *create(const struct stepper *kind, size_t dimension)
{
    struct bdf *w = calloc(1, sizeof *w);
    (void)kind;
    if (!w) {
        return NULL;
    }
    w->n = dimension;
    w->d = malloc((DIFFERENCES + 3) * dimension * sizeof *w->d);
    if (!w->d || !tribo_newton_create(&w->newton, dimension, 1)) {
        destroy(w);
        return NULL;
    }
    w->c = w->d + DIFFERENCES * dimension;
    w->k = w->c + dimension;
    w->base = w->k + dimension;
    return w;
}

static void restart(void *own)
{
    struct bdf *w = own;
    w->h = w->newton.h = 0.0;
}

static void begin(struct bdf *w, const struct step *s)
{
    memset(w->d, 0, DIFFERENCES * w->n * sizeof *w->d);
    memcpy(w->d, s->y, w->n * sizeof *w->d);
    for (size_t m = 0; m < w->n; m++) {
        w->d[w->n + m] = s->h * s->slope[m];
    }
    w->h = s->h;
    w->order = 1;
    w->equal = 0;
}

/* Differences over steps that are factor times as long from those over unit steps: a polynomial through y_0, y_-1, ... */
static void find_factors(double factor, size_t order, double r[ORDERS + 1][ORDERS + 1])
{
    for (size_t j = 0; j <= order; j++) {
        r[0][j] = 1.0;
        for (size_t i = 1; i <= order; i++) {
            r[i][j] = r[i - 1][j] * ((double)i - 1.0 - factor * (double)j) / (double)i;
        }
    }
}

static void change_step(struct bdf *w, double h)
{
    double stretch[ORDERS + 1][ORDERS + 1], unit[ORDERS + 1][ORDERS + 1], both[ORDERS + 1][ORDERS + 1] = {{0.0}};
    find_factors(h / w->h, w->order, stretch);
    find_factors(1.0, w->order, unit);
    for (size_t i = 0; i <= w->order; i++) {
        for (size_t j = 0; j <= w->order; j++) {
            for (size_t k = 0; k <= w->order; k++) {
                both[i][j] += stretch[i][k] * unit[k][j];
            }
        }
    }
    for (size_t m = 0; m < w->n; m++) {
        double d[ORDERS + 1] = {0.0};
        for (size_t j = 0; j <= w->order; j++) {
            for (size_t i = 0; i <= w->order; i++) {
                d[j] += both[i][j] * w->d[i * w->n + m];
            }
        }
        for (size_t j = 0; j <= w->order; j++) {
            w->d[j * w->n + m] = d[j];
        }
    }
    w->h = h;
    w->equal = 0;
}

static int attempt(void *own, tribo_system *sys, struct step *s)
{
    static const double one = 1.0;
    struct bdf *w = own;
    const size_t n = w->n;
    if (w->h == 0.0) {
        begin(w, s);
    } else if (w->h != s->h) {
        change_step(w, s->h);
    }
    const double gamma = harmonic_sum[w->order], part = s->h / gamma, end = s->t + s->h;
    for (size_t m = 0; m < n; m++) {
        double p = 0.0, psi = 0.0;
        for (size_t j = w->order + 1; j-- > 0;) {
            p += w->d[j * n + m];
            psi += harmonic_sum[j] / gamma * w->d[j * n + m];
        }
        w->c[m] = psi;
        w->k[m] = psi / part;
        w->base[m] = p - psi;
    }
    const int status = tribo_newton_solve(&w->newton, sys, &end, part, &one, w->base, s->tolerance, w->k);
    for (size_t m = 0; !status && m < n; m++) {
        w->c[m] = part * w->k[m] - w->c[m];
        s->to[m] = w->base[m] + part * w->k[m];
        s->error[m] = w->c[m] / (double)(w->order + 1);
    }
    return status;
}

static double size_of(const double *x, double factor, const double *tolerance, size_t n)
{
    double most = 0.0;
    for (size_t m = 0; m < n; m++) {
        most = greater(most, factor * fabs(x[m]) / tolerance[m]);
    }
    return most;
}

static double reject(void *own, double size)
{
    const struct bdf *w = own;
    return tribo_stepper_growth(size, (double)(w->order + 1));
}

/* After order + 1 equal steps the differences also tell what orders beside this one would do. */
static double accept(void *own, const struct step *s, double size)
{
    struct bdf *w = own;
    const size_t n = w->n, q = w->order;
    for (size_t m = 0; m < n; m++) {
        w->d[(q + 2) * n + m] = w->c[m] - w->d[(q + 1) * n + m];
        w->d[(q + 1) * n + m] = w->c[m];
        for (size_t j = q + 1; j-- > 0;) {
            w->d[j * n + m] += w->d[(j + 1) * n + m];
        }
    }
    if (++w->equal <= q) {
        return 1.0;
    }
    double best = reject(own, size);
    for (size_t order = q - 1; order <= q + 1; order += 2) {
        if (order >= 1 && order <= ORDERS) {
            const double at = size_of(w->d + (order + 1) * n, 1.0 / (double)(order + 1), s->tolerance, n);
            const double growth = tribo_stepper_growth(at, (double)(order + 1));
            w->order = growth > best ? order : w->order;
            best = greater(best, growth);
        }
    }
    w->equal = 0;
    return best;
}

const struct stepper tribo_stepper_msbdf = {create, destroy, restart, attempt, accept, reject, HUGE_VAL, NULL};
