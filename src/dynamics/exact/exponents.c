/* Exponents lambda of the free motion of the modes. */
#include "parts.h"
#include "common/real.h"
#include "numerics/linalg.h"

#include <math.h>

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

/* a [2 modes][2 modes], zero before, = A of x' = A x, x = (s eta, eta'), s = omega. */
static void first_order(const struct modal *h, const double *s, double *a)
{
    const size_t m = h->modes, size = 2 * m;
    for (size_t k = 0; k < m; k++) {
        a[k * size + m + k] = s[k];
        a[(m + k) * size + k] = -s[k];
        for (size_t l = 0; l < m; l++) {
            a[(m + k) * size + m + l] -= h->coupling[k * m + l];
        }
    }
}

/* Returns |A x - lambda x|/|lambda|, lambda = re + i im, |x| = 1: real part x[0], imaginary part x[1] if im != 0. */
static double exponents_residual(const struct modal *h, const double *s, double re, double im, const double *const *x)
{
    const size_t m = h->modes, parts = im != 0.0 ? 2 : 1;
    double square = 0.0;
    for (size_t part = 0; part < parts; part++) {
        const double *own = x[part], *other = parts > 1 ? x[1 - part] : own, turn = parts == 1 ? 0.0 : part ? im : -im;
        for (size_t k = 0; k < m; k++) {
            const double up = s[k] * own[m + k] - re * own[k] - turn * other[k];
            const double down =
                -s[k] * own[k] - tribo_dot(h->coupling + k * m, own + m, m) - re * own[m + k] - turn * other[m + k];
            square += up * up + down * down;
        }
    }
    return sqrt(square) / hypot(re, im);
}

/* Returns 1 if the residuals of all exponents are at most KNOWN. */
static int all_known(const struct modal *h, const double *s, const double *re, const double *im, const double *x)
{
    const size_t size = 2 * h->modes;
    for (size_t i = 0; i < size; i++) {
        const double *const parts[] = {x + i * size, im[i] > 0.0 ? x + (i + 1) * size : NULL};
        if (!(im[i] < 0.0) && !(exponents_residual(h, s, re[i], im[i], parts) <= KNOWN)) {
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
    }
    first_order(h, s, a);
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
    return b->h->coupling ? exponents_coupled(b) : exponents_decoupled(b);
}
