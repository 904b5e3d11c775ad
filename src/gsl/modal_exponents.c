/* Exponents of the free motion in the modes. */
#include "modal_build.h"
#include "../real.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>

/* A mode this close to critical damping has no two exponents that could be told apart to 12 digits. */
#define CRITICAL 1e-8

static int unsupported(const struct build *b, const char *why)
{
    return tribo_system_fail(b->sys, TRIBO_ERR_UNSUPPORTED, "method exact: %s; method event can do it", why);
}

static int exponents_decoupled(struct build *b)
{
    struct modal *h = b->h;
    const size_t m = h->modes;
    h->lr = tribo_modal_keep(b, 2 * m);
    h->li = tribo_modal_keep(b, 2 * m);
    h->ar = tribo_modal_keep(b, 2 * m);
    h->ai = tribo_modal_keep(b, 2 * m);
    h->br = tribo_modal_keep(b, 2 * m);
    h->bi = tribo_modal_keep(b, 2 * m);
    h->owner = tribo_modal_keep_indices(b, 2 * m);
    if (!h->lr || !h->li || !h->ar || !h->ai || !h->br || !h->bi || !h->owner) {
        return TRIBO_ERR_MEMORY;
    }
    size_t p = 0;
    for (size_t k = 0; k < m; k++) {
        const double half = 0.5 * h->damping[k], square = h->omega2[k] - half * half, root = sqrt(fabs(square));
        if (h->drifts[k]) {
            continue;
        }
        if (fabs(square) < CRITICAL * greater(fabs(h->omega2[k]), half * half)) {
            return unsupported(b, "a mode is critically damped");
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

/* Eigenvalues of the first-order form x' = A x, x = (s eta, eta'), with s so chosen that A is well scaled. */
static int exponents_coupled(struct build *b)
{
    struct modal *h = b->h;
    const size_t m = h->modes, size = 2 * m;
    double *a = tribo_modal_scratch(b, size * size), *s = tribo_modal_scratch(b, m), *values = tribo_modal_scratch(b, 2 * size),
           *vectors = tribo_modal_scratch(b, 2 * size * size);
    double *lu = tribo_modal_scratch(b, 2 * size * size), *inverse = tribo_modal_scratch(b, 2 * size * size);
    size_t *order = tribo_modal_scratch_indices(b, size);
    gsl_eigen_nonsymmv_workspace *work = gsl_eigen_nonsymmv_alloc(size);
    if (!a || !s || !values || !vectors || !lu || !inverse || !order || !work) {
        gsl_eigen_nonsymmv_free(work);
        return TRIBO_ERR_MEMORY;
    }
    for (size_t k = 0; k < m; k++) {
        if (!(h->omega2[k] > 0.0)) {
            gsl_eigen_nonsymmv_free(work);
            return unsupported(b, "coupled damping, and a mode without stiffness");
        }
        s[k] = sqrt(h->omega2[k]);
        a[k * size + m + k] = s[k];
        a[(m + k) * size + k] = -s[k];
        for (size_t l = 0; l < m; l++) {
            a[(m + k) * size + m + l] -= h->coupling[k * m + l];
        }
    }
    gsl_matrix_view av = gsl_matrix_view_array(a, size, size);
    gsl_vector_complex_view ev = gsl_vector_complex_view_array(values, size);
    gsl_matrix_complex_view vv = gsl_matrix_complex_view_array(vectors, size, size);
    gsl_matrix_complex_view fv = gsl_matrix_complex_view_array(lu, size, size),
                            iv = gsl_matrix_complex_view_array(inverse, size, size);
    gsl_eigen_nonsymmv(&av.matrix, &ev.vector, &vv.matrix, work);
    gsl_eigen_nonsymmv_free(work);
    memcpy(lu, vectors, 2 * size * size * sizeof *lu);
    gsl_permutation p = {size, order};
    int sign;
    gsl_linalg_complex_LU_decomp(&fv.matrix, &p, &sign);
    for (size_t i = 0; i < size; i++) {
        if (hypot(lu[2 * (i * size + i)], lu[2 * (i * size + i) + 1]) < 1e-6) {
            return unsupported(b, "two modes have nearly the same exponent and shape");
        }
    }
    gsl_linalg_complex_LU_invert(&fv.matrix, &p, &iv.matrix);

    h->lr = tribo_modal_keep(b, size);
    h->li = tribo_modal_keep(b, size);
    h->ar = tribo_modal_keep(b, size * m);
    h->ai = tribo_modal_keep(b, size * m);
    h->br = tribo_modal_keep(b, size * m);
    h->bi = tribo_modal_keep(b, size * m);
    h->rr = tribo_modal_keep(b, size * m);
    h->ri = tribo_modal_keep(b, size * m);
    if (!h->lr || !h->li || !h->ar || !h->ai || !h->br || !h->bi || !h->rr || !h->ri) {
        return TRIBO_ERR_MEMORY;
    }
    size_t e = 0;
    for (size_t i = 0; i < size; i++) {
        const double nu = values[2 * i + 1], twice = nu > 0.0 ? 2.0 : 1.0;
        if (nu < 0.0) {
            continue;
        }
        h->lr[e] = values[2 * i];
        h->li[e] = nu;
        for (size_t k = 0; k < m; k++) {
            h->ar[e * m + k] = s[k] * inverse[2 * (i * size + k)];
            h->ai[e * m + k] = s[k] * inverse[2 * (i * size + k) + 1];
            h->br[e * m + k] = inverse[2 * (i * size + m + k)];
            h->bi[e * m + k] = inverse[2 * (i * size + m + k) + 1];
            h->rr[k * size + e] = twice * vectors[2 * (k * size + i)] / s[k];
            h->ri[k * size + e] = twice * vectors[2 * (k * size + i) + 1] / s[k];
        }
        e++;
    }
    h->exponents = e;
    for (size_t k = 0; k < m; k++) {
        memmove(h->rr + k * e, h->rr + k * size, e * sizeof *h->rr);
        memmove(h->ri + k * e, h->ri + k * size, e * sizeof *h->ri);
    }
    return TRIBO_OK;
}
int tribo_modal_exponents(struct build *b)
{
    return b->h->coupling ? exponents_coupled(b) : exponents_decoupled(b);
}
