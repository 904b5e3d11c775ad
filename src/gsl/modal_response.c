/* Harmonics: what they do to the modes, and the response to that. */
#include "modal_build.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

/* Closer than this, relative, the response to a harmonic is computed without the closed form's small divisor. */
#define RESONANCE 1e-3

/* A response larger than one over this would leave too few digits. */
#define UNDAMPED 1e-9

/* y [ndof] = velocities from the b of the contacts that hold: B_I R_II^-1 b_I. x [rest] has b_I. */
static void belt_velocities(const struct build *b, double *x, double *y)
{
    tribo_modal_solve_rest(b, x);
    for (size_t d = 0; d < b->n; d++) {
        double sum = 0.0;
        for (size_t p = 0; p < b->h->rest; p++) {
            sum += tribo_matrix_get(&b->sys->response, d, b->rest[p]) * x[p];
        }
        y[d] = sum;
    }
}

/* One part (0 cosine, 1 minus sine: harmonics are Re((c - i s) e^{i Omega t})) of a harmonic of b_I. */
void tribo_modal_base_part(const struct build *b, const struct harmonic *w, int part, double *x)
{
    for (size_t p = 0; p < b->h->rest; p++) {
        x[p] = 0.0;
        for (size_t i = 0; i < w->count; i++) {
            if (w->index[i] == b->rest[p]) {
                x[p] = part ? -w->sine[i] : w->cosine[i];
            }
        }
    }
}

/* Forcing of eta by each harmonic, and what the held contacts are moved by. */
int tribo_modal_forcing(struct build *b)
{
    struct modal *h = b->h;
    const size_t n = b->n, m = h->modes, count = b->sys->harmonics;
    h->harmonics = count;
    h->gr = tribo_modal_keep(b, count * m);
    h->gi = tribo_modal_keep(b, count * m);
    h->ramp = tribo_modal_keep(b, m);
    b->yr = tribo_modal_scratch(b, count * n);
    b->yi = tribo_modal_scratch(b, count * n);
    b->y0 = tribo_modal_scratch(b, n);
    double *x = tribo_modal_scratch(b, h->rest), *pull = tribo_modal_scratch(b, n), *drag = tribo_modal_scratch(b, n);
    if (!h->gr || !h->gi || !h->ramp || !b->yr || !b->yi || !b->y0 || !x || !pull || !drag) {
        return 0;
    }
    for (size_t w = 0; w < count; w++) {
        const struct harmonic *wave = &b->sys->harmonic[w];
        double *g[] = {h->gr + w * m, h->gi + w * m}, *y[] = {b->yr + w * n, b->yi + w * n};
        for (int part = 0; !wave->moves_base && part < 2; part++) {
            for (size_t k = 0; k < m; k++) {
                for (size_t i = 0; i < wave->count; i++) {
                    g[part][k] += (part ? -wave->sine[i] : wave->cosine[i]) * b->psi[k * n + wave->index[i]];
                }
            }
        }
        for (int part = 0; wave->moves_base && part < 2; part++) {
            tribo_modal_base_part(b, wave, part, x);
            belt_velocities(b, x, y[part]);
        }
        for (int part = 0; wave->moves_base && part < 2; part++) {
            if (wave->omega == 0.0) {
                if (part == 0) {
                    add(b->y0, 1.0, y[0], n);
                }
                memset(y[part], 0, n * sizeof **y);
                continue;
            }
            /* -AK y/(i Omega) - AC y; 1/i turns the real part into minus the imaginary one */
            memset(pull, 0, n * sizeof *pull);
            memset(drag, 0, n * sizeof *drag);
            tribo_matrix_multiply_add(&b->sys->stiffness, (part ? -1.0 : 1.0) / wave->omega, y[part], pull);
            if (b->sys->damping.rows) {
                tribo_matrix_multiply_add(&b->sys->damping, -1.0, y[part], drag);
            }
            for (size_t k = 0; k < m; k++) {
                g[1 - part][k] += dot(b->psi + k * n, pull, n);
                g[part][k] += dot(b->psi + k * n, drag, n);
            }
        }
    }
    memset(pull, 0, n * sizeof *pull);
    tribo_matrix_multiply_add(&b->sys->stiffness, -1.0, b->y0, pull);
    for (size_t k = 0; k < m; k++) {
        h->ramp[k] = dot(b->psi + k * n, pull, n);
    }
    return 1;
}

/* Response of eta to the harmonics, (diag(omega^2) - Omega^2 + i Omega C~) x = g. */
int tribo_modal_response(struct build *b)
{
    struct modal *h = b->h;
    const size_t m = h->modes, count = h->harmonics;
    h->xr = tribo_modal_keep(b, count * m);
    h->xi = tribo_modal_keep(b, count * m);
    h->resonant = tribo_modal_keep_bytes(b, count * m);
    double *a = tribo_modal_scratch(b, 2 * m * m), *x = tribo_modal_scratch(b, 2 * m);
    size_t *order = tribo_modal_scratch_indices(b, m);
    if (!h->xr || !h->xi || !h->resonant || !a || !x || !order) {
        return 0;
    }
    for (size_t w = 0; w < count; w++) {
        const double omega = b->sys->harmonic[w].omega;
        const double *gr = h->gr + w * m, *gi = h->gi + w * m;
        for (size_t k = 0; omega != 0.0 && !h->coupling && k < m; k++) {
            const double re = h->omega2[k] - omega * omega, im = omega * h->damping[k], square = re * re + im * im;
            h->resonant[w * m + k] = sqrt(square) < RESONANCE * fabs(h->omega2[k]) && (gr[k] != 0.0 || gi[k] != 0.0);
            h->any_resonant |= h->resonant[w * m + k];
            if (!h->resonant[w * m + k] && (gr[k] != 0.0 || gi[k] != 0.0)) {
                h->xr[w * m + k] = (gr[k] * re + gi[k] * im) / square;
                h->xi[w * m + k] = (gi[k] * re - gr[k] * im) / square;
            }
        }
        if (omega == 0.0 || !h->coupling || m == 0) {
            continue;
        }
        for (size_t k = 0; k < m; k++) {
            for (size_t l = 0; l < m; l++) {
                a[2 * (k * m + l)] = k == l ? h->omega2[k] - omega * omega : 0.0;
                a[2 * (k * m + l) + 1] = omega * h->coupling[k * m + l];
            }
            x[2 * k] = gr[k];
            x[2 * k + 1] = gi[k];
        }
        gsl_matrix_complex_view av = gsl_matrix_complex_view_array(a, m, m);
        gsl_vector_complex_view xv = gsl_vector_complex_view_array(x, m);
        gsl_permutation p = {m, order};
        int sign;
        gsl_linalg_complex_LU_decomp(&av.matrix, &p, &sign);
        for (size_t k = 0; k < m; k++) {
            if (hypot(a[2 * (k * m + k)], a[2 * (k * m + k) + 1]) <= UNDAMPED * omega * omega) {
                b->status =
                    tribo_system_fail(b->sys, TRIBO_ERR_UNSUPPORTED,
                                      "the harmonic of omega = %g is in resonance with an undamped mode, while damping couples "
                                      "others: take method event",
                                      omega);
                return 0;
            }
        }
        gsl_linalg_complex_LU_svx(&av.matrix, &p, &xv.vector);
        for (size_t k = 0; k < m; k++) {
            h->xr[w * m + k] = x[2 * k];
            h->xi[w * m + k] = x[2 * k + 1];
        }
    }
    return 1;
}
