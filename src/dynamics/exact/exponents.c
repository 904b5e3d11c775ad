/* SPDX-License-Identifier: BSD-3-Clause */
/* Exponents lambda of the free motion of the modes. */
#include "parts.h"
#include "common/real.h"
#include "numerics/lapack.h"
#include "numerics/linalg.h"

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
    return tribo_error(b->sys->message, TRIBO_ERR_UNSUPPORTED, "method exact: %s; method event can do it", why);
}

/* Makes room for e exponents, a, b and r of `modes` modes each. Returns 0 if out of memory. */
static int reserve_exponents(struct modal *h, size_t e, size_t modes)
{
    double **const part[] = {&h->ar, &h->ai, &h->br, &h->bi, &h->rr, &h->ri};
    h->exponents = e;
    h->lr = tribo_modal_take(&h->store, e * (2 + 6 * modes), sizeof *h->lr);
    h->li = h->lr ? h->lr + e : NULL;
    for (size_t k = 0; h->lr && k < 6; k++) {
        *part[k] = h->lr + e * (2 + k * modes);
    }
    return h->lr != NULL;
}

static int exponents_decoupled(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t m = h->modes;
    h->owner = tribo_modal_take(&h->store, 2 * m, sizeof *h->owner);
    if (!h->owner || !reserve_exponents(h, 2 * m, 1)) {
        return TRIBO_ERR_MEMORY;
    }
    size_t p = 0;
    for (size_t k = 0; k < m; k++) {
        const double half = 0.5 * h->damping[k], square = h->omega2[k] - half * half, root = sqrt(fabs(square));
        if (tribo_modal_drifts(h, k)) {
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

/* Sets exponent p, with b and r of mode k, and a = -b omega^2/lambda, since b is a left eigenvector. */
static void keep_coupled(struct modal *h, size_t p, size_t k, double complex lambda, double complex b, double complex r)
{
    const size_t at = k * h->exponents + p;
    const double complex a = -h->omega2[k] * b / lambda;
    h->lr[p] = creal(lambda);
    h->li[p] = cimag(lambda);
    h->ar[at] = creal(a);
    h->ai[at] = cimag(a);
    h->br[at] = creal(b);
    h->bi[at] = cimag(b);
    h->rr[p * h->modes + k] = creal(r);
    h->ri[p * h->modes + k] = -cimag(r);
}

/* Returns 1 if |A x - lambda x| < KNOWN |lambda| for the eigenvector x = v + i w, |x| = 1, of exponents_coupled. */
static int is_known(const struct modal *h, const double *s, double complex lambda, const double *v, const double *w)
{
    const size_t m = h->modes;
    double square = 0.0;
    for (size_t k = 0; k < m; k++) {
        const double *c = h->coupling + k * m;
        const double complex place = v[k] + w[k] * I, rate = v[m + k] + w[m + k] * I;
        const double complex up = s[k] * rate - lambda * place;
        const double complex down = s[k] * place + tribo_dot(c, v + m, m) + tribo_dot(c, w + m, m) * I + lambda * rate;
        square += creal(up * conj(up) + down * conj(down));
    }
    return sqrt(square) < KNOWN * cabs(lambda);
}

/* All eigenvectors by QR, the left ones as the inverse of the right ones. */
static int exponents_coupled(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t m = h->modes, size = 2 * m;
    double *a = tribo_modal_take(&b->scratch, 3 * size * size + 7 * m, sizeof *a);
    int *pivot = tribo_modal_take(&b->scratch, size, sizeof *pivot);
    if (!a || !pivot) {
        return TRIBO_ERR_MEMORY;
    }
    double *x = a + size * size, *inverse = x + size * size, *s = inverse + size * size, *re = s + m, *im = re + size;
    const double *zero = im + size;
    size_t exponents = 0;
    for (size_t k = 0; k < m; k++) {
        if (!(h->omega2[k] > 0.0)) {
            return exponents_unsupported(b, "coupled damping, and a mode without stiffness");
        }
        s[k] = sqrt(h->omega2[k]);
        /* a = A of x' = A x, x = (s eta, eta'), s = omega */
        a[k * size + m + k] = s[k];
        a[(m + k) * size + k] = -s[k];
        tribo_add(a + (m + k) * size + m, -1.0, h->coupling + k * m, m);
    }
    const int status = tribo_eigen(a, size, re, im, x);
    if (status == TRIBO_ERR_NO_CONVERGENCE || status == TRIBO_ERR_NOT_FINITE) {
        return tribo_error(b->sys->message, status, "method exact: exponents of %zu mode%s that damping couples: %s", m,
                           plural(m), tribo_strerror(status));
    }
    tribo_transpose(size, size, x, a);
    for (size_t i = 0; !status && i < size; i++) {
        inverse[i * (size + 1)] = 1.0;
        exponents += !(im[i] < 0.0);
    }
    if (status || !reserve_exponents(h, exponents, m)) {
        return TRIBO_ERR_MEMORY;
    }
    if (!(tribo_lu_create(a, size, pivot) >= ALIKE)) {
        return exponents_unsupported(b, "two modes have nearly the same exponent and shape");
    }
    tribo_lu_solve(a, size, pivot, inverse, size);
    for (size_t i = 0, p = 0; i < size; i++) {
        const double complex lambda = re[i] + im[i] * I;
        const double half = im[i] > 0.0 ? 0.5 : 1.0, *v = x + i * size, *w = im[i] > 0.0 ? v + size : zero;
        const double *y = inverse + i * size, *z = im[i] > 0.0 ? y + size : zero;
        if (!(im[i] < 0.0) && !is_known(h, s, lambda, v, w)) {
            return exponents_unsupported(b, "damping couples modes of too different frequencies");
        }
        /* x = (v + i w) z + conjugate = 2 (v Re z - w Im z) */
        for (size_t k = 0; !(im[i] < 0.0) && k < m; k++) {
            keep_coupled(h, p, k, lambda, half * (y[m + k] - z[m + k] * I), (v[k] + w[k] * I) / (half * s[k]));
        }
        p += !(im[i] < 0.0);
    }
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

/* The eigenvector of mode k. */
struct weak {
    struct modal *h;
    size_t k;
    double complex lambda;
    double *u, *cu;       /* [2][modes] u and C~ u, real and imaginary part */
    double complex *near; /* [NEAR_MOST][NEAR_MOST] columns, and the right-hand side [NEAR_MOST] */
    double *sum, *w;      /* [2][modes] the sums of COMPLETE; [modes] w without zeros */
};

/* Returns 1 if all modes are weakly damped, and C~ is symmetric. */
static int is_weak(const struct modal *h)
{
    const size_t m = h->modes;
    for (size_t k = 0; k < m; k++) {
        const double own = h->coupling[k * m + k];
        if (!(fabs(0.5 * own) < WEAK * sqrt(h->omega2[k]))) {
            return 0;
        }
        for (size_t l = 0; l < k; l++) {
            const double there = h->coupling[k * m + l], back = h->coupling[l * m + k];
            if (!(fabs(there - back) <= ASYMMETRY * sqrt(fabs(0.5 * own * h->coupling[l * m + l])))) {
                return 0;
            }
        }
    }
    return 1;
}

/* One step of lambda and u, with C~ u in cu. Returns the size of the change, HUGE_VAL on failure. */
static double weak_step(struct weak *x)
{
    const struct modal *h = x->h;
    const size_t m = h->modes;
    double *re = x->u, *im = re + m;
    const double *cr = x->cu, *ci = cr + m;
    const double complex lambda = x->lambda, square = lambda * lambda;
    double complex *right = x->near + NEAR_MOST * NEAR_MOST;
    size_t at[NEAR_MOST], count = 0, own = 0;
    const double size = cabs(lambda);
    double most = 0.0;
    for (size_t j = 0; j < m; j++) {
        const double c = h->coupling[j * m + j];
        const double complex stiff = square + h->omega2[j], divisor = stiff + lambda * c;
        const double complex rest = stiff * (re[j] + im[j] * I) + lambda * (cr[j] + ci[j] * I), by = rest / divisor;
        if (j != x->k && size * fabs(c) <= NEAR * (fabs(creal(divisor)) + fabs(cimag(divisor)))) {
            re[j] -= creal(by);
            im[j] -= cimag(by);
            most = greater(most, fabs(creal(by)) + fabs(cimag(by)));
            continue;
        }
        if (count == NEAR_MOST) {
            return HUGE_VAL;
        }
        own = j == x->k ? count : own;
        right[count] = -rest;
        at[count++] = j;
    }
    for (size_t a = 0; a < count; a++) {
        const size_t j = at[a];
        for (size_t b = 0; b < count; b++) {
            x->near[b * count + a] = b == own ? 2.0 * lambda * (re[j] + im[j] * I) + (cr[j] + ci[j] * I)
                                              : lambda * h->coupling[j * m + at[b]] + (a == b ? square + h->omega2[j] : 0.0);
        }
    }
    int rows = (int)count, one = 1, pivot[NEAR_MOST], info = 0;
    zgesv_(&rows, &one, x->near, &rows, pivot, right, &rows, &info);
    for (size_t a = 0; a < count; a++) {
        re[at[a]] += a == own ? 0.0 : creal(right[a]);
        im[at[a]] += a == own ? 0.0 : cimag(right[a]);
        most = greater(most, cabs(right[a]) / (a == own ? size : 1.0));
    }
    x->lambda += right[own];
    return info == 0 && most < 1e3 ? most : HUGE_VAL;
}

/* Finds the eigenvector of mode k, keeps it, and adds to the sums. Returns 0 if it does not converge, or is close to another. */
static int weak_find(struct weak *x, size_t k)
{
    struct modal *h = x->h;
    const size_t m = h->modes;
    const double half = 0.5 * h->coupling[k * m + k], *re = x->u, *im = re + m, *cr = x->cu, *ci = cr + m;
    double before, change = HUGE_VAL, size = 0.0;
    double complex d = 0.0, part = 0.0;
    int step = 0;
    memset(x->u, 0, 2 * m * sizeof *x->u);
    x->u[k] = 1.0;
    x->k = k;
    x->lambda = -half + sqrt(h->omega2[k] - half * half) * I;
    do {
        before = change;
        memset(x->cu, 0, 2 * m * sizeof *x->cu);
        tribo_multiply_add(2, m, m, 1.0, x->u, h->coupling, x->cu);
        change = weak_step(x);
    } while (change > FINAL && !(change <= STILL && change >= 0.5 * before) && change < HUGE_VAL && ++step < STEPS);
    for (size_t j = 0; j < m; j++) {
        const double complex u = re[j] + im[j] * I;
        size += re[j] * re[j] + im[j] * im[j];
        d += u * (2.0 * x->lambda * u + (cr[j] + ci[j] * I));
        part += u * x->w[j];
    }
    if (!(change < HUGE_VAL) || step == STEPS || !(cabs(d) >= APART * cabs(2.0 * x->lambda) * size) ||
        !(cimag(x->lambda) > 0.0)) {
        return 0;
    }
    for (size_t j = 0; j < m; j++) {
        const double complex u = re[j] + im[j] * I, sum = 2.0 * u * part / d;
        keep_coupled(h, k, j, x->lambda, u / d, 2.0 * u);
        x->sum[j] += creal(sum);
        x->sum[m + j] += creal(x->lambda * sum);
    }
    return 1;
}

/* Sets the exponents of weakly coupled modes; *found = 0 if the modes are not. Returns a status. */
static int exponents_weak(struct modal_build *b, int *found)
{
    struct modal *h = b->h;
    const size_t m = h->modes;
    struct weak x = {.h = h, .u = tribo_modal_take(&b->scratch, 7 * m, sizeof *x.u)};
    x.near = tribo_modal_take(&b->scratch, (NEAR_MOST + 1) * NEAR_MOST, sizeof *x.near);
    if (!x.u || !x.near || !reserve_exponents(h, m, m)) {
        return TRIBO_ERR_MEMORY;
    }
    x.cu = x.u + 2 * m;
    x.sum = x.cu + 2 * m;
    x.w = x.sum + 2 * m;
    for (size_t k = 0; k < m; k++) {
        x.w[k] = 1.0 + cos((double)((k + 1) * (k + 1)));
    }
    *found = 1;
    for (size_t k = 0; *found && k < m; k++) {
        *found = weak_find(&x, k);
    }
    for (size_t k = 0; *found && k < m; k++) {
        /* One eigenvector twice, and another one missing: the sums lack a part of w. */
        *found = greater(fabs(x.sum[k]) * sqrt(h->omega2[k]), fabs(x.sum[m + k] - x.w[k])) <= COMPLETE * (double)m;
    }
    return TRIBO_OK;
}

int tribo_modal_exponents(struct modal_build *b)
{
    if (!b->h->coupling) {
        return exponents_decoupled(b);
    }
    int found = 0;
    const int status = is_weak(b->h) ? exponents_weak(b, &found) : TRIBO_OK;
    return status || found ? status : exponents_coupled(b);
}
