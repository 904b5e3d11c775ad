#include "linear.h"

#include <math.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_sort_vector.h>

#include "output.h"

double relative_difference(double a, double b)
{
    return a == b ? 0.0 : fabs(a - b) / fmax(fabs(a), fabs(b));
}

/* What a mode answers to a harmonic force on it is that force by this. */
static gsl_complex dynamic_stiffness(const struct damper *d, size_t k, double omega)
{
    return gsl_complex_rect(d->omega[k] * d->omega[k] - omega * omega, 2.0 * d->damping * d->omega[k] * omega);
}

double free_amplitude(const struct damper *d, double omega)
{
    gsl_complex sum = GSL_COMPLEX_ZERO;
    for (size_t k = 0; k < d->modes; k++) {
        const gsl_complex force = gsl_complex_rect(d->force * d->load_shape[k] * d->load_shape[k], 0.0);
        sum = gsl_complex_add(sum, gsl_complex_div(force, dynamic_stiffness(d, k, omega)));
    }
    return gsl_complex_abs(sum);
}

struct scale free_scale(const struct damper *d, double omega)
{
    struct scale s = {.amplitude = free_amplitude(d, omega)};
    for (size_t k = 0; k < d->modes; k++) {
        const double q = d->force * fabs(d->load_shape[k]) / gsl_complex_abs(dynamic_stiffness(d, k, omega));
        s.norm = hypot(s.norm, hypot(d->omega[k], omega) * q);
    }
    s.power = 0.5 * d->force * omega * s.amplitude;
    return s;
}

/* Orthonormal motions of the modes that move no rigid contact, as the last columns of *basis [modes][modes]; returns how many. */
static size_t held_motions(const struct damper *d, gsl_matrix **basis)
{
    const size_t n = d->modes, m = d->contacts, least = n < m ? n : m;
    gsl_matrix *shapes = gsl_matrix_alloc(n, m), *q = gsl_matrix_alloc(n, n), *r = gsl_matrix_alloc(n, m);
    gsl_vector *tau = gsl_vector_alloc(least), *norm = gsl_vector_alloc(m);
    gsl_permutation *p = gsl_permutation_alloc(m);
    int sign;
    if (!shapes || !q || !r || !tau || !norm || !p) {
        die("out of memory for %zu contacts", m);
    }
    for (size_t c = 0; c < m; c++) {
        for (size_t k = 0; k < n; k++) {
            gsl_matrix_set(shapes, k, c, d->stiffness[c] > 0.0 ? 0.0 : d->contact_shape[c * n + k]);
        }
    }
    gsl_linalg_QRPT_decomp2(shapes, q, r, tau, p, &sign, norm); /* fails for sizes that do not fit only */
    size_t rank = 0;
    while (rank < least && fabs(gsl_matrix_get(r, rank, rank)) > 1e-10 * fabs(gsl_matrix_get(r, 0, 0))) {
        rank++;
    }
    gsl_matrix_free(shapes);
    gsl_matrix_free(r);
    gsl_vector_free(tau);
    gsl_vector_free(norm);
    gsl_permutation_free(p);
    *basis = q;
    return n - rank;
}

/* The spring of contact c, which holds, in those motions: its root, as what a unit of each stretches it by. 0 if it has none. */
static int held_spring(const struct damper *d, size_t c, const gsl_matrix *basis, double *root, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        root[i] = 0.0;
        for (size_t k = 0; k < d->modes; k++) {
            root[i] += sqrt(d->stiffness[c]) * d->contact_shape[c * d->modes + k] * gsl_matrix_get(basis, k, d->modes - n + i);
        }
    }
    return d->stiffness[c] > 0.0;
}

static void add_held_springs(const struct damper *d, const gsl_matrix *basis, gsl_matrix_complex *h)
{
    const size_t n = h->size1;
    double *root = need_memory(n, sizeof *root);
    for (size_t c = 0; c < d->contacts; c++) {
        const int springs = held_spring(d, c, basis, root, n);
        for (size_t i = 0; springs && i < n * n; i++) {
            gsl_complex *at = gsl_matrix_complex_ptr(h, i / n, i % n);
            *at = gsl_complex_add_real(*at, root[i / n] * root[i % n]);
        }
    }
    free(root);
}

/* The dynamic stiffness and the load's shape in those motions. */
static void reduce(const struct damper *d, double omega, const gsl_matrix *basis, gsl_matrix_complex *h, gsl_vector_complex *b)
{
    const size_t first = d->modes - b->size;
    for (size_t k = 0; k < d->modes; k++) {
        for (size_t i = 0; i < b->size; i++) {
            const double mode = gsl_matrix_get(basis, k, first + i);
            gsl_complex *at = gsl_vector_complex_ptr(b, i);
            *at = gsl_complex_add_real(*at, mode * d->load_shape[k]);
            for (size_t j = 0; j < b->size; j++) {
                at = gsl_matrix_complex_ptr(h, i, j);
                *at = gsl_complex_add(
                    *at, gsl_complex_mul_real(dynamic_stiffness(d, k, omega), mode * gsl_matrix_get(basis, k, first + j)));
            }
        }
    }
}

double stuck_amplitude(const struct damper *d, double omega)
{
    gsl_matrix *basis;
    const size_t n = held_motions(d, &basis);
    double amplitude = 0.0;
    if (n > 0) {
        gsl_matrix_complex *h = gsl_matrix_complex_calloc(n, n);
        gsl_vector_complex *b = gsl_vector_complex_calloc(n), *s = gsl_vector_complex_calloc(n);
        gsl_permutation *p = gsl_permutation_alloc(n);
        gsl_complex x;
        int sign;
        if (!h || !b || !s || !p) {
            die("out of memory for %zu modes", d->modes);
        }
        reduce(d, omega, basis, h, b);
        add_held_springs(d, basis, h);
        const int failed = gsl_linalg_complex_LU_decomp(h, p, &sign) || gsl_linalg_complex_LU_solve(h, p, b, s);
        gsl_blas_zdotu(b, s, &x);
        amplitude = failed ? (double)NAN : d->force * gsl_complex_abs(x);
        gsl_matrix_complex_free(h);
        gsl_vector_complex_free(b);
        gsl_vector_complex_free(s);
        gsl_permutation_free(p);
    }
    gsl_matrix_free(basis);
    return amplitude;
}

size_t stuck_frequencies(const struct damper *d, double *omega)
{
    gsl_matrix *basis;
    const size_t n = held_motions(d, &basis);
    if (n > 0) {
        gsl_matrix *k = gsl_matrix_calloc(n, n);
        gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(n);
        if (!k || !work) {
            die("out of memory for %zu modes", d->modes);
        }
        for (size_t m = 0; m < d->modes; m++) {
            gsl_vector_view held = gsl_matrix_row(basis, m);
            gsl_vector_view shape = gsl_vector_subvector(&held.vector, d->modes - n, n);
            gsl_blas_dsyr(CblasLower, d->omega[m] * d->omega[m], &shape.vector, k);
        }
        for (size_t c = 0; c < d->contacts; c++) {
            gsl_vector_view root = gsl_vector_view_array(omega, n);
            if (held_spring(d, c, basis, omega, n)) {
                gsl_blas_dsyr(CblasLower, 1.0, &root.vector, k);
            }
        }
        gsl_vector_view values = gsl_vector_view_array(omega, n);
        need(gsl_eigen_symm(k, &values.vector, work), "modes with all contacts stuck");
        gsl_sort_vector(&values.vector);
        for (size_t i = 0; i < n; i++) {
            omega[i] = sqrt(fmax(omega[i], 0.0));
        }
        gsl_matrix_free(k);
        gsl_eigen_symm_free(work);
    }
    gsl_matrix_free(basis);
    return n;
}

/* Whether all contacts are rigid, along one axis, and have the limit that varies. */
static int one_limit(const struct damper *d)
{
    int one = d->planar == 0;
    for (size_t c = 0; c < d->contacts; c++) {
        one = one && isnan(d->limit[c]) && d->mu[c] == 1.0 && d->stiffness[c] == 0.0;
    }
    return one;
}

struct optimum harmonic_balance(const struct damper *d, double drive)
{
    const double pi = acos(-1.0), none = (double)NAN;
    size_t driven = 0;
    double sum = 0.0;
    for (size_t k = 1; k < d->modes; k++) {
        driven = fabs(d->omega[k] - drive) < fabs(d->omega[driven] - drive) ? k : driven;
    }
    if (!one_limit(d) || fabs(d->omega[driven] / drive - 1.0) > 0.1 * d->damping) {
        return (struct optimum){none, none, none};
    }
    for (size_t i = 0; i < d->contacts; i++) {
        sum += fabs(d->contact_shape[i * d->modes + driven]);
    }
    const double shape = fabs(d->load_shape[driven]), load = d->force * shape, omega = d->omega[driven];
    const double modal = load / (4.0 * d->damping * omega * omega);
    return (struct optimum){pi * load / (8.0 * sum), 0.25 * drive * load * modal, shape * modal};
}
