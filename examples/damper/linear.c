#include "linear.h"

#include <math.h>

#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_linalg.h>

#include "../common/output.h"

/* Displacement along a per unit of a harmonic force along b. */
static gsl_complex receptance(const struct damper *d, const double *a, const double *b)
{
    gsl_complex sum = GSL_COMPLEX_ZERO;
    for (size_t k = 0; k < d->modes; k++) {
        const gsl_complex dynamic =
            gsl_complex_rect(d->omega[k] * d->omega[k] - d->drive * d->drive, 2.0 * d->damping * d->omega[k] * d->drive);
        sum = gsl_complex_add(sum, gsl_complex_div(gsl_complex_rect(a[k] * b[k], 0.0), dynamic));
    }
    return sum;
}

double free_amplitude(const struct damper *d)
{
    return d->force * gsl_complex_abs(receptance(d, d->load_shape, d->load_shape));
}

/* The contacts' forces g, per unit of load, hold them: H_cc g + H_cL = 0. */
double stuck_amplitude(const struct damper *d)
{
    const size_t n = d->contacts;
    gsl_matrix_complex *h = gsl_matrix_complex_alloc(n, n);
    gsl_vector_complex *b = gsl_vector_complex_alloc(n), *g = gsl_vector_complex_alloc(n);
    gsl_permutation *p = gsl_permutation_alloc(n);
    int sign;
    if (!h || !b || !g || !p) {
        die("out of memory for %zu contacts", n);
    }
    for (size_t i = 0; i < n; i++) {
        const double *shape = d->contact_shape + i * d->modes;
        gsl_vector_complex_set(b, i, gsl_complex_negative(receptance(d, shape, d->load_shape)));
        for (size_t j = 0; j < n; j++) {
            gsl_matrix_complex_set(h, i, j, receptance(d, shape, d->contact_shape + j * d->modes));
        }
    }
    const int failed = gsl_linalg_complex_LU_decomp(h, p, &sign) || gsl_linalg_complex_LU_solve(h, p, b, g);
    gsl_complex x = receptance(d, d->load_shape, d->load_shape);
    for (size_t i = 0; i < n; i++) {
        const gsl_complex at_load = receptance(d, d->load_shape, d->contact_shape + i * d->modes);
        x = gsl_complex_add(x, gsl_complex_mul(at_load, gsl_vector_complex_get(g, i)));
    }
    gsl_matrix_complex_free(h);
    gsl_vector_complex_free(b);
    gsl_vector_complex_free(g);
    gsl_permutation_free(p);
    return failed ? (double)NAN : d->force * gsl_complex_abs(x);
}

struct optimum harmonic_balance(const struct damper *d)
{
    const double pi = acos(-1.0), none = (double)NAN;
    size_t driven = 0;
    double sum = 0.0;
    for (size_t k = 1; k < d->modes; k++) {
        driven = fabs(d->omega[k] - d->drive) < fabs(d->omega[driven] - d->drive) ? k : driven;
    }
    if (fabs(d->omega[driven] / d->drive - 1.0) > 0.1 * d->damping) {
        return (struct optimum){none, none, none};
    }
    for (size_t i = 0; i < d->contacts; i++) {
        sum += fabs(d->contact_shape[i * d->modes + driven]);
    }
    const double shape = fabs(d->load_shape[driven]), load = d->force * shape, omega = d->omega[driven];
    const double modal = load / (4.0 * d->damping * omega * omega);
    return (struct optimum){pi * load / (8.0 * sum), 0.5 * pi * load * modal / d->period, shape * modal};
}
