/* SPDX-License-Identifier: BSD-3-Clause */
/* Exponents lambda of the free motion of the modes. */
#include "parts.h"
#include "common/real.h"
#include "numerics/lapack.h"
#include "numerics/linalg.h"

#include <complex.h>
#include <math.h>
#include <string.h>

/* |omega^2 - (damping/2)^2|, relative, below which the difference of the two exponents is known to fewer than 12 digits. */
#define CRITICAL 1e-8

/* Smallest pivot of the matrix of eigenvectors, of length 1: below ALIKE two eigenvectors count as equal. */
#define ALIKE 1e-6

/* Largest |A x - lambda x|/|lambda|, |x| = 1, of an exponent that is accepted. */
#define KNOWN 1e-8

static int exponents_unsupported(const struct modal_build *b, const char *why)
{
    return tribo_system_fail(b->shared->sys, TRIBO_ERR_UNSUPPORTED, "method exact: %s; method event can do it", why);
}

static int exponents_decoupled(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t m = h->modes;
    double **const kept[] = {&h->lr, &h->li, &h->ar, &h->ai, &h->br, &h->bi};
    const size_t count[] = {2 * m, 2 * m, 2 * m, 2 * m, 2 * m, 2 * m};
    h->owner = tribo_modal_keep_indices(b, 2 * m);
    if (!tribo_modal_keep_all(b, sizeof kept / sizeof *kept, kept, count) || !h->owner) {
        return TRIBO_ERR_MEMORY;
    }
    size_t p = 0;
    for (size_t k = 0; k < m; k++) {
        const double half = 0.5 * h->damping[k], square = h->omega2[k] - half * half, root = sqrt(fabs(square));
        if (h->drifts[k]) {
            continue;
        }
        if (fabs(square) < CRITICAL * greater(fabs(h->omega2[k]), half * half)) {
            return exponents_unsupported(b, "a mode is critically damped");
        }
        if (square > 0.0) {
            h->lr[p] = -half;
            h->li[p] = root;
            h->ar[p] = 1.0;
            h->ai[p] = -half / root;
            h->bi[p] = -1.0 / root;
            h->owner[p++] = k;
            continue;
        }
        const double far = half > 0.0 ? -half - root : -half + root, near = h->omega2[k] / far;
        for (int which = 0; which < 2; which++) {
            h->lr[p] = which ? far : near;
            h->br[p] = which ? 1.0 / (far - near) : 1.0 / (near - far);
            h->ar[p] = -h->br[p] * (which ? near : far);
            h->owner[p++] = k;
        }
    }
    h->exponents = p;
    return TRIBO_OK;
}

/* Returns 1 if |A x - lambda x| < KNOWN |lambda| for all eigenvectors x, |x| = 1, see linalg.h. */
static int all_known(const struct modal *h, const double *s, const double *re, const double *im, const double *x)
{
    const size_t m = h->modes, size = 2 * m;
    for (size_t i = 0; i < size; i++) {
        const int parts = im[i] != 0.0 ? 2 : 1;
        double square = 0.0;
        for (int part = 0; part < parts && !(im[i] < 0.0); part++) {
            const double *own = x + (i + (size_t)part) * size, *other = parts > 1 ? x + (i + 1 - (size_t)part) * size : own;
            const double turn = part ? im[i] : -im[i];
            for (size_t k = 0; k < m; k++) {
                const double up = s[k] * own[m + k] - re[i] * own[k] - turn * other[k];
                const double down =
                    -s[k] * own[k] - tribo_dot(h->coupling + k * m, own + m, m) - re[i] * own[m + k] - turn * other[m + k];
                square += up * up + down * down;
            }
        }
        if (!(sqrt(square) < KNOWN * hypot(re[i], im[i]))) {
            return 0;
        }
    }
    return 1;
}

/* Sets lr, li, b (eta' to z) and r (z to eta) from eigenvectors x (see linalg.h) and inverse, of the matrix with eigenvectors as
 * columns. Returns a status. */
static int keep_exponents(struct modal_build *b, const double *s, const double *re, const double *im, const double *x,
                          const double *inverse)
{
    struct modal *h = b->h;
    const size_t m = h->modes, size = 2 * m;
    for (size_t i = 0; i < size; i++) {
        h->exponents += !(im[i] < 0.0);
    }
    const size_t e = h->exponents;
    double **const kept[] = {&h->lr, &h->li, &h->br, &h->bi, &h->rr, &h->ri};
    const size_t count[] = {e, e, e * m, e * m, e * m, e * m};
    const int done = tribo_modal_keep_all(b, sizeof kept / sizeof *kept, kept, count);
    for (size_t i = 0, p = 0; done && i < size; i++) {
        if (im[i] < 0.0) {
            continue;
        }
        const int pair = im[i] > 0.0;
        const double half = pair ? 0.5 : 1.0, twice = pair ? 2.0 : 1.0;
        h->lr[p] = re[i];
        h->li[p] = im[i];
        for (size_t k = 0; k < m; k++) {
            /* x = (v + i w) z + conjugate = 2 (v Re z - w Im z) */
            h->br[k * e + p] = half * inverse[i * size + m + k];
            h->rr[p * m + k] = twice * x[i * size + k] / s[k];
            if (pair) {
                h->bi[k * e + p] = -half * inverse[(i + 1) * size + m + k];
                h->ri[p * m + k] = twice * x[(i + 1) * size + k] / s[k];
            }
        }
        p++;
    }
    return done ? TRIBO_OK : TRIBO_ERR_MEMORY;
}

/* inverse, zero before, = inverse of the matrix with the vectors x as columns. Returns a status. */
static int invert(const struct modal_build *b, const double *x, double *lu, int *pivot, double *inverse)
{
    const size_t size = 2 * b->h->modes;
    for (size_t i = 0; i < size; i++) {
        for (size_t j = 0; j < size; j++) {
            lu[i * size + j] = x[j * size + i];
        }
        inverse[i * size + i] = 1.0;
    }
    if (!(tribo_lu_create(lu, size, pivot) >= ALIKE)) {
        return exponents_unsupported(b, "two modes have nearly the same exponent and shape");
    }
    tribo_lu_solve(lu, size, pivot, inverse, size);
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------- weakly coupled modes
 * (lambda^2 + lambda C~ + diag(omega^2)) u = 0 with a symmetric C~ and all modes far from critical damping: u = e_k + coupling,
 * |lambda| = omega_k. One step for u_k = 1 is Newton's over the modes near k, and Jacobi's over the others; the error of the
 * near modes falls by its square, that of the others by about the sum of NEAR. By symmetry left eigenvectors are u, too, and
 * eta(t) of eta'(0) is 2 Re sum_k u_k u_k'eta'(0)/d_k e^{lambda_k t}, d = u'(2 lambda + C~) u. */

/* Mode j is near mode k if |lambda_k| C~_jj exceeds this part of |lambda_k^2 + lambda_k C~_jj + omega_j^2|. */
#define NEAR 0.03

/* Most near modes, and most steps; beyond them QR is as fast. */
enum { NEAR_MOST = 24, STEPS = 40 };

/* Largest C~_kk/(2 omega_k). */
#define WEAK 0.25

/* Change of u, and of lambda relative to lambda, at which an eigenvector is final; and where a change no longer falls. */
#define FINAL 4e-15
#define STILL 1e-12

/* Largest relative asymmetry of C~, by rounding. */
#define ASYMMETRY 1e-12

/* Smallest |d|/(2 |lambda| |u|^2), above which an eigenvector is far from any other of the same exponent. */
#define APART 0.1

/* Largest error of the sums over all modes, sum 2 Re lambda u u'w/d = w and sum 2 Re u u'w/d = 0. */
#define COMPLETE 1e-11

/* Eigenvectors in work: rows 2 i and 2 i + 1 of u and cu are u and C~ u of mode[i], real and imaginary part. */
struct weak {
    const struct modal *h;
    size_t *mode;           /* [modes] those that are not final first */
    double complex *lambda; /* [modes] by mode */
    double *change;         /* [modes] by mode */
    double *u, *cu;         /* [2 modes][modes] */
    double complex *near;   /* [NEAR_MOST][NEAR_MOST] columns, and the right-hand side [NEAR_MOST] */
};

/* Sets lambda of modes without coupling. Returns 0 if a mode is not weakly damped, or C~ is not symmetric. */
static int weak_begin(struct weak *x)
{
    const struct modal *h = x->h;
    const size_t m = h->modes;
    for (size_t k = 0; k < m; k++) {
        const double half = 0.5 * h->coupling[k * m + k], square = h->omega2[k] - half * half;
        if (!(fabs(half) < WEAK * sqrt(h->omega2[k]))) {
            return 0;
        }
        for (size_t l = 0; l < k; l++) {
            const double there = h->coupling[k * m + l], back = h->coupling[l * m + k];
            if (!(fabs(there - back) <= ASYMMETRY * sqrt(fabs(half * h->coupling[l * m + l])))) {
                return 0;
            }
        }
        x->mode[k] = k;
        x->lambda[k] = -half + (double complex)_Complex_I * sqrt(square);
        x->change[k] = HUGE_VAL;
        x->u[2 * k * m + k] = 1.0;
    }
    return 1;
}

/* Solves the step of the near modes, at[count], column `own` for the exponent. Returns 0 if there is none. */
static int weak_solve_near(struct weak *x, size_t i, size_t count, const size_t *at, size_t own)
{
    const struct modal *h = x->h;
    const size_t m = h->modes;
    const double *re = x->u + 2 * i * m, *im = re + m, *cr = x->cu + 2 * i * m, *ci = cr + m;
    const double complex lambda = x->lambda[x->mode[i]];
    double complex *right = x->near + NEAR_MOST * NEAR_MOST;
    for (size_t a = 0; a < count; a++) {
        const size_t j = at[a];
        const double complex u = re[j] + im[j] * (double complex)_Complex_I, cu = cr[j] + ci[j] * (double complex)_Complex_I;
        right[a] = -((lambda * lambda + h->omega2[j]) * u + lambda * cu);
        for (size_t b = 0; b < count; b++) {
            x->near[b * count + a] = b == own
                                         ? 2.0 * lambda * u + cu
                                         : lambda * h->coupling[j * m + at[b]] + (a == b ? lambda * lambda + h->omega2[j] : 0.0);
        }
    }
    int rows = (int)count, one = 1, pivot[NEAR_MOST], info = 0;
    zgesv_(&rows, &one, x->near, &rows, pivot, right, &rows, &info);
    return info == 0;
}

/* One step of the eigenvector in rows 2 i and 2 i + 1. Sets change. Returns 0 on failure. */
static int weak_step(struct weak *x, size_t i)
{
    const struct modal *h = x->h;
    const size_t m = h->modes, k = x->mode[i];
    double *re = x->u + 2 * i * m, *im = re + m;
    const double *cr = x->cu + 2 * i * m, *ci = cr + m;
    const double complex lambda = x->lambda[k], square = lambda * lambda;
    const double size = cabs(lambda);
    size_t at[NEAR_MOST], count = 0, own = 0;
    double most = 0.0;
    for (size_t j = 0; j < m; j++) {
        const double c = h->coupling[j * m + j];
        const double complex stiff = square + h->omega2[j], divisor = stiff + lambda * c;
        if (j == k || size * fabs(c) > NEAR * (fabs(creal(divisor)) + fabs(cimag(divisor)))) {
            if (count == NEAR_MOST) {
                return 0;
            }
            own = j == k ? count : own;
            at[count++] = j;
            continue;
        }
        const double complex u = re[j] + im[j] * (double complex)_Complex_I;
        const double complex by = (stiff * u + lambda * (cr[j] + ci[j] * (double complex)_Complex_I)) / divisor;
        re[j] -= creal(by);
        im[j] -= cimag(by);
        most = greater(most, fabs(creal(by)) + fabs(cimag(by)));
    }
    if (!weak_solve_near(x, i, count, at, own)) {
        return 0;
    }
    const double complex *by = x->near + NEAR_MOST * NEAR_MOST;
    for (size_t a = 0; a < count; a++) {
        if (a == own) {
            x->lambda[k] += by[a];
            most = greater(most, cabs(by[a]) / size);
        } else {
            re[at[a]] += creal(by[a]);
            im[at[a]] += cimag(by[a]);
            most = greater(most, cabs(by[a]));
        }
    }
    const double before = x->change[k];
    x->change[k] = most <= FINAL || (most <= STILL && most >= 0.5 * before) ? 0.0 : most;
    return most < 1e3;
}

/* Exchanges eigenvectors i and j, in mode, u and cu. */
static void weak_exchange(struct weak *x, size_t i, size_t j)
{
    const size_t m = x->h->modes, mode = x->mode[i];
    x->mode[i] = x->mode[j];
    x->mode[j] = mode;
    for (size_t e = 0; e < 2 * m; e++) {
        const double u = x->u[2 * i * m + e], cu = x->cu[2 * i * m + e];
        x->u[2 * i * m + e] = x->u[2 * j * m + e];
        x->cu[2 * i * m + e] = x->cu[2 * j * m + e];
        x->u[2 * j * m + e] = u;
        x->cu[2 * j * m + e] = cu;
    }
}

/* Sets lambda, u and cu. Returns 0 if an eigenvector does not converge. */
static int weak_find(struct weak *x)
{
    const size_t m = x->h->modes;
    size_t open = m;
    for (int step = 0; step < STEPS && open > 0; step++) {
        memset(x->cu, 0, 2 * open * m * sizeof *x->cu);
        tribo_multiply_add(2 * open, m, m, 1.0, x->u, x->h->coupling, x->cu);
        for (size_t i = open; i-- > 0;) {
            if (!weak_step(x, i)) {
                return 0;
            }
            if (x->change[x->mode[i]] == 0.0) {
                weak_exchange(x, i, --open);
            }
        }
    }
    return open == 0;
}

/* Returns x'y, x = re + i im, of y = yr + i yi, without conjugate; yi NULL: 0. */
static double complex weak_dot(size_t n, const double *re, const double *yr, const double *yi)
{
    const double *im = re + n;
    const double real = tribo_dot(re, yr, n) - (yi ? tribo_dot(im, yi, n) : 0.0);
    return real + (double complex)_Complex_I * (tribo_dot(im, yr, n) + (yi ? tribo_dot(re, yi, n) : 0.0));
}

/* Sets the kept arrays from lambda and u. Returns 0 if an eigenvector is close to another one, or one is missing: the sums of
 * COMPLETE then lack a part of a w without zeros. sum [3 modes] is workspace. */
static int weak_keep(struct weak *x, struct modal *h, double *sum)
{
    const size_t m = h->modes;
    double *w = sum + 2 * m, most = 0.0;
    memset(sum, 0, 2 * m * sizeof *sum);
    for (size_t k = 0; k < m; k++) {
        w[k] = 1.0 + cos((double)((k + 1) * (k + 1)));
    }
    for (size_t i = 0; i < m; i++) {
        const size_t p = x->mode[i];
        const double *re = x->u + 2 * i * m, *im = re + m;
        const double complex lambda = x->lambda[p], twice = 2.0 * lambda;
        const double square = tribo_dot(re, re, m) + tribo_dot(im, im, m);
        const double complex d = twice * weak_dot(m, re, re, im) + weak_dot(m, re, x->cu + 2 * i * m, x->cu + (2 * i + 1) * m);
        const double complex part = weak_dot(m, re, w, NULL) / d;
        if (!(cabs(d) >= APART * cabs(twice) * square) || !(cimag(lambda) > 0.0)) {
            return 0;
        }
        h->lr[p] = creal(lambda);
        h->li[p] = cimag(lambda);
        for (size_t k = 0; k < m; k++) {
            const double complex u = re[k] + im[k] * (double complex)_Complex_I, b = u / d;
            h->br[k * m + p] = creal(b);
            h->bi[k * m + p] = cimag(b);
            h->rr[p * m + k] = 2.0 * re[k];
            h->ri[p * m + k] = 2.0 * im[k];
            sum[k] += 2.0 * creal(u * part);
            sum[m + k] += 2.0 * creal(lambda * u * part);
        }
    }
    for (size_t k = 0; k < m; k++) {
        most = greater(most, greater(fabs(sum[k]) * sqrt(h->omega2[k]), fabs(sum[m + k] - w[k])));
    }
    return most <= COMPLETE * (double)m;
}

/* Sets the exponents of weakly coupled modes; *found = 0 if the modes are not. Returns a status. */
static int exponents_weak(struct modal_build *b, int *found)
{
    struct modal *h = b->h;
    const size_t m = h->modes;
    struct weak x = {.h = h};
    x.mode = tribo_modal_scratch_indices(b, m);
    x.lambda = (double complex *)tribo_modal_scratch(b, 2 * (m + (NEAR_MOST + 1) * NEAR_MOST));
    x.change = tribo_modal_scratch(b, 4 * m);
    x.u = tribo_modal_scratch(b, 2 * m * m);
    x.cu = tribo_modal_scratch(b, 2 * m * m);
    double **const kept[] = {&h->lr, &h->li, &h->br, &h->bi, &h->rr, &h->ri};
    const size_t count[] = {m, m, m * m, m * m, m * m, m * m};
    if (!x.mode || !x.lambda || !x.change || !x.u || !x.cu) {
        return TRIBO_ERR_MEMORY;
    }
    x.near = x.lambda + m;
    *found = weak_begin(&x) && weak_find(&x);
    if (*found) {
        if (!tribo_modal_keep_all(b, sizeof kept / sizeof *kept, kept, count)) {
            return TRIBO_ERR_MEMORY;
        }
        *found = weak_keep(&x, h, x.change + m);
        h->exponents = *found ? m : 0;
    }
    return TRIBO_OK;
}

static int exponents_coupled(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t m = h->modes, size = 2 * m;
    double *a = tribo_modal_scratch(b, size * size), *s = tribo_modal_scratch(b, m), *re = tribo_modal_scratch(b, size);
    double *im = tribo_modal_scratch(b, size), *x = tribo_modal_scratch(b, size * size);
    double *inverse = tribo_modal_scratch(b, size * size);
    int *pivot = (int *)tribo_modal_scratch_indices(b, size);
    if (!a || !s || !re || !im || !x || !inverse || !pivot) {
        return TRIBO_ERR_MEMORY;
    }
    for (size_t k = 0; k < m; k++) {
        if (!(h->omega2[k] > 0.0)) {
            return exponents_unsupported(b, "coupled damping, and a mode without stiffness");
        }
        s[k] = sqrt(h->omega2[k]);
        /* a = A of x' = A x, x = (s eta, eta'), s = omega */
        a[k * size + m + k] = s[k];
        a[(m + k) * size + k] = -s[k];
        for (size_t l = 0; l < m; l++) {
            a[(m + k) * size + m + l] = -h->coupling[k * m + l];
        }
    }
    int status = tribo_eigen(a, size, re, im, x);
    if (status == TRIBO_ERR_NO_CONVERGENCE || status == TRIBO_ERR_NOT_FINITE) {
        return tribo_system_fail(b->shared->sys, status, "method exact: exponents of %zu mode%s that damping couples: %s", m,
                                 plural(m), tribo_strerror(status));
    }
    status = status ? status : invert(b, x, a, pivot, inverse);
    if (!status && !all_known(h, s, re, im, x)) {
        return exponents_unsupported(b, "damping couples modes of too different frequencies");
    }
    return status ? status : keep_exponents(b, s, re, im, x, inverse);
}

int tribo_modal_exponents(struct modal_build *b)
{
    if (!b->h->coupling) {
        return exponents_decoupled(b);
    }
    int found = 0;
    const int status = exponents_weak(b, &found);
    return status || found ? status : exponents_coupled(b);
}
