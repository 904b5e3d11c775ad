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

/* Largest product of the lengths of the left and right eigenvectors of an exponent, of product 1: the condition of the exponent,
 * and the factor by which rounding of the motion grows. */
#define CONDITION 1e4

static int exponents_unsupported(const struct modal_build *b, const char *why)
{
    return tribo_error(b->sys->message, TRIBO_ERR_UNSUPPORTED, "method exact: %s; method event can do it", why);
}

/* Makes room for e exponents, a, b and r of `modes` modes each. Returns 0 if out of memory. */
static int reserve_exponents(struct modal *h, size_t e, size_t modes)
{
    double **const part[] = {&h->left.ar, &h->left.ai, &h->left.br, &h->left.bi, &h->rr, &h->ri};
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
            h->left.ar[p] = 1.0;
            h->left.ai[p] = -half / root;
            h->left.bi[p] = -1.0 / root;
            h->owner[p++] = k;
            continue;
        }
        const double far = half > 0.0 ? -half - root : -half + root, near = h->omega2[k] / far;
        for (int which = 0; which < 2; which++) {
            h->lr[p] = which ? far : near;
            h->left.br[p] = which ? 1.0 / (far - near) : 1.0 / (near - far);
            h->left.ar[p] = -h->left.br[p] * (which ? near : far);
            h->owner[p++] = k;
        }
    }
    h->exponents = p;
    return TRIBO_OK;
}

/* Sets exponent p, with a, b and r of mode k; coupled. */
static void keep_coupled(struct modal *h, size_t p, size_t k, double complex lambda, double complex a, double complex b,
                         double complex r)
{
    const size_t at = k * h->exponents + p;
    h->lr[p] = creal(lambda);
    h->li[p] = cimag(lambda);
    h->left.ar[at] = creal(a);
    h->left.ai[at] = cimag(a);
    h->left.br[at] = creal(b);
    h->left.bi[at] = cimag(b);
    h->rr[p * h->modes + k] = creal(r);
    h->ri[p * h->modes + k] = -cimag(r);
}

/* Returns |A x - lambda x|/|lambda| of the eigenvector x = v + i w, |x| = 1, of a = A [size][size]. */
static double eigen_error(const double *a, size_t size, double complex lambda, const double *v, const double *w)
{
    double square = 0.0;
    for (size_t i = 0; i < size; i++) {
        const double complex x = v[i] + w[i] * I;
        const double complex off = tribo_dot(a + i * size, v, size) + tribo_dot(a + i * size, w, size) * I - lambda * x;
        square += creal(off * conj(off));
    }
    return sqrt(square) / cabs(lambda);
}

/* Sets s = omega and a = A of x' = A x, x = (s eta, eta'), of the modes at [count]. */
static void fill_first_order(const struct modal *h, size_t count, const size_t *at, double *s, double *a)
{
    const size_t size = 2 * count;
    for (size_t i = 0; i < count; i++) {
        s[i] = sqrt(fabs(h->omega2[at[i]]));
        a[i * size + count + i] = s[i];
    }
    for (size_t i = 0; i < count; i++) {
        double *down = a + (count + i) * size;
        down[i] = h->stiff ? 0.0 : -s[i];
        for (size_t j = 0; j < count; j++) {
            const size_t kl = at[i] * h->modes + at[j];
            down[j] -= h->stiff ? h->stiff[kl] / s[j] : 0.0;
            down[count + j] = -h->coupling[kl];
        }
    }
}

/* Eigenvalues re + i im [2 count] of `first`, A of x' = A x, x = (s eta, eta'), of the modes at [count]; right eigenvectors, and
 * the inverse of their matrix, in rows. */
struct coupled {
    size_t count;
    const size_t *at;
    const double *s, *first, *re, *im, *zero, *x, *inverse;
};

/* Keeps eigenvalue i as exponent p, with r of right eigenvector v + i w, x = (v + i w) z + conjugate, and a and b of left
 * eigenvector half (y - i z); a = -b omega^2/lambda where K~ is diagonal. Modes d that drift follow: lambda^2 r_d = -sum over k of
 * (K~_dk + lambda C~_dk) r_k. Returns a status. */
static int keep_eigenvalue(struct modal_build *b, const struct coupled *c, size_t i, size_t p)
{
    struct modal *h = b->h;
    const size_t m = h->modes, count = c->count, size = 2 * count;
    const double complex lambda = c->re[i] + c->im[i] * I;
    const int pair = c->im[i] > 0.0;
    const double half = pair ? 0.5 : 1.0, *v = c->x + i * size, *w = pair ? v + size : c->zero;
    const double *y = c->inverse + i * size, *z = pair ? y + size : c->zero;
    double *rr = h->rr + p * m, *ri = h->ri + p * m;
    if (!(eigen_error(c->first, size, lambda, v, w) < KNOWN)) {
        return exponents_unsupported(b, "damping couples modes of too different frequencies");
    }
    if (h->stiff && half * sqrt(tribo_dot(y, y, size) + tribo_dot(z, z, size)) > CONDITION) {
        return exponents_unsupported(b, "two modes have nearly the same exponent and shape, as at the border of flutter");
    }
    for (size_t l = 0; l < count; l++) {
        const double s = half * c->s[l];
        const double complex left = half * (y[count + l] - z[count + l] * I), place = s * (y[l] - z[l] * I);
        keep_coupled(h, p, c->at[l], lambda, h->stiff ? place : -h->omega2[l] * left / lambda, left, (v[l] + w[l] * I) / s);
    }
    for (size_t d = 0; h->stiff && d < m; d++) {
        const double *k = h->stiff + d * m, *drag = h->coupling + d * m;
        if (h->omega2[d] == 0.0) {
            const double complex pull =
                (tribo_dot(k, rr, m) - tribo_dot(k, ri, m) * I) + lambda * (tribo_dot(drag, rr, m) - tribo_dot(drag, ri, m) * I);
            const double complex r = -pull / (lambda * lambda);
            rr[d] = creal(r);
            ri[d] = -cimag(r);
        }
    }
    return TRIBO_OK;
}

/* All eigenvectors by QR, the left ones as the inverse of the right ones. */
static int exponents_coupled(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t m = h->modes;
    size_t *at = tribo_modal_take(&b->scratch, m, sizeof *at), count = 0, exponents = 0;
    for (size_t k = 0; at && k < m; k++) {
        at[count] = k;
        count += !h->stiff || h->omega2[k] != 0.0;
        if (!h->stiff && !(h->omega2[k] > 0.0)) {
            return exponents_unsupported(b, "coupled damping, and a mode without stiffness");
        }
    }
    const size_t size = 2 * count;
    double *first = tribo_modal_take(&b->scratch, 4 * size * size + 7 * m, sizeof *first);
    int *pivot = tribo_modal_take(&b->scratch, size, sizeof *pivot);
    if (!at || !first || !pivot) {
        return TRIBO_ERR_MEMORY;
    }
    double *a = first + size * size, *x = a + size * size, *inverse = x + size * size, *s = inverse + size * size, *re = s + m,
           *im = re + size;
    const double *zero = im + size;
    fill_first_order(h, count, at, s, first);
    memcpy(a, first, size * size * sizeof *a);
    int status = tribo_eigen(a, size, re, im, x);
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
    if (size > 0 && !(tribo_lu_create(a, size, pivot) >= ALIKE)) {
        return exponents_unsupported(b, "two modes have nearly the same exponent and shape");
    }
    tribo_lu_solve(a, size, pivot, inverse, size);
    const struct coupled found = {count, at, s, first, re, im, zero, x, inverse};
    for (size_t i = 0, p = 0; !status && i < size; i++) {
        status = im[i] < 0.0 ? TRIBO_OK : keep_eigenvalue(b, &found, i, p++);
    }
    return status;
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
        keep_coupled(h, k, j, x->lambda, -h->omega2[j] / x->lambda * u / d, u / d, 2.0 * u);
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
    const int status = !b->h->stiff && is_weak(b->h) ? exponents_weak(b, &found) : TRIBO_OK;
    return status || found ? status : exponents_coupled(b);
}
