/* What the motion in the modes means for contacts. */
#include "modal_build.h"

#include <math.h>
#include <string.h>

/* Adds what a contact gets from position (eta) and velocity (eta') amplitudes of mode k. */
static void output_mode(const struct build *b, struct output *w, size_t k, double position, double velocity)
{
    const struct modal *h = b->h;
    const size_t m = h->modes;
    for (size_t p = 0; p < h->exponents; p++) {
        if (h->owner && h->owner[p] != k) {
            continue;
        }
        const double rr = h->owner ? 1.0 : h->rr[k * h->exponents + p], ri = h->owner ? 0.0 : h->ri[k * h->exponents + p];
        const double fr = position + velocity * h->lr[p], fi = velocity * h->li[p];
        w->cr[p] += fr * rr - fi * ri;
        w->ci[p] += fr * ri + fi * rr;
    }
    for (size_t s = 0; s < h->harmonics; s++) {
        const double omega = b->sys->harmonic[s].omega, xr = h->xr[s * m + k], xi = h->xi[s * m + k];
        w->rr[s] += position * xr - velocity * omega * xi;
        w->ri[s] += position * xi + velocity * omega * xr;
    }
}

static int create_output(struct build *b, struct output *w, size_t contact)
{
    const size_t p = b->h->exponents, s = b->h->harmonics, m = b->h->modes;
    double *x = tribo_modal_keep(b, 4 * p + 4 * s + m);
    if (!x) {
        return 0;
    }
    double *y = x + 4 * p;
    *w = (struct output){contact, x, x + p, x + 2 * p, x + 3 * p, y, y + s, y + 2 * s, y + 3 * s, y + 4 * s, 0.0};
    return 1;
}

static double sixth_power(double x)
{
    return x * x * x * x * x * x;
}

static void finish_output(const struct build *b, struct output *w)
{
    for (size_t p = 0; p < b->h->exponents; p++) {
        w->size[p] = hypot(w->cr[p], w->ci[p]);
        w->bend[p] = w->size[p] * sixth_power(b->h->size[p]);
    }
    for (size_t s = 0; s < b->h->harmonics; s++) {
        w->wave[s] = hypot(w->rr[s], w->ri[s]);
        w->wave_bend[s] = w->wave[s] * sixth_power(b->sys->harmonic[s].omega);
    }
}

/* v_i = J_i q' - b_i. */
static int output_sliding(struct build *b, struct output *w, size_t i)
{
    if (!create_output(b, w, i)) {
        return 0;
    }
    const struct matrix *j = &b->sys->direction;
    for (size_t k = 0; k < b->h->modes; k++) {
        double shape = 0.0;
        for (size_t e = j->first[i]; e < j->first[i + 1]; e++) {
            shape += j->val[e] * b->phi[k * b->n + j->col[e]];
        }
        w->on_rate[k] = shape;
        output_mode(b, w, k, 0.0, shape);
    }
    for (size_t s = 0; s < b->h->harmonics; s++) {
        const struct harmonic *wave = &b->sys->harmonic[s];
        for (size_t e = j->first[i]; e < j->first[i + 1]; e++) {
            w->rr[s] += j->val[e] * b->yr[s * b->n + j->col[e]];
            w->ri[s] += j->val[e] * b->yi[s * b->n + j->col[e]];
        }
        for (size_t e = 0; wave->moves_base && wave->omega != 0.0 && e < wave->count; e++) {
            w->rr[s] -= wave->index[e] == i ? wave->cosine[e] : 0.0;
            w->ri[s] += wave->index[e] == i ? wave->sine[e] : 0.0;
        }
    }
    finish_output(b, w);
    return 1;
}

/* f_I = R_II^-1 (J_I AK q + J_I AC q' - J_I load + b_I'), for all that hold, by modes and by harmonics; only those that change at
 * all are outputs. */
static int output_held(struct build *b, struct output *all, size_t *used)
{
    struct modal *h = b->h;
    const size_t n = b->n, m = h->modes, s = h->rest;
    double *by_q = tribo_modal_scratch(b, m * s), *by_u = tribo_modal_scratch(b, m * s),
           *wave_r = tribo_modal_scratch(b, h->harmonics * s);
    double *wave_i = tribo_modal_scratch(b, h->harmonics * s), *ramp = tribo_modal_scratch(b, s),
           *load = tribo_modal_scratch(b, n), *x = tribo_modal_scratch(b, s);
    if (!by_q || !by_u || !wave_r || !wave_i || !ramp || !load || !x) {
        return 0;
    }
    for (size_t k = 0; k < m; k++) {
        tribo_modal_at_rest(b, 1.0, b->ak_phi + k * n, 0.0, by_q + k * s);
        tribo_modal_at_rest(b, 1.0, b->ac_phi + k * n, 0.0, by_u + k * s);
        tribo_modal_solve_rest(b, by_q + k * s);
        tribo_modal_solve_rest(b, by_u + k * s);
    }
    for (size_t w = 0; w < h->harmonics; w++) {
        const struct harmonic *wave = &b->sys->harmonic[w];
        double *f[] = {wave_r + w * s, wave_i + w * s}, *y[] = {b->yr + w * n, b->yi + w * n};
        for (int part = 0; wave->omega != 0.0 && part < 2; part++) {
            memset(load, 0, n * sizeof *load);
            for (size_t e = 0; !wave->moves_base && e < wave->count; e++) {
                load[wave->index[e]] = part ? wave->sine[e] : -wave->cosine[e];
            }
            if (b->sys->damping.rows) {
                tribo_matrix_multiply_add(&b->sys->damping, 1.0, y[part], load);
            }
            tribo_modal_at_rest(b, 1.0, load, 1.0, f[part]);
            memset(load, 0, n * sizeof *load);
            tribo_matrix_multiply_add(&b->sys->stiffness, (part ? 1.0 : -1.0) / wave->omega, y[part], load);
            tribo_modal_at_rest(b, 1.0, load, 1.0, f[1 - part]);
            if (wave->moves_base) {
                tribo_modal_base_part(b, wave, part, x);
                add(f[1 - part], part ? -wave->omega : wave->omega, x, s);
            }
        }
        tribo_modal_solve_rest(b, f[0]);
        tribo_modal_solve_rest(b, f[1]);
    }
    memset(load, 0, n * sizeof *load);
    tribo_matrix_multiply_add(&b->sys->stiffness, 1.0, b->y0, load);
    tribo_modal_at_rest(b, 1.0, load, 0.0, ramp);
    tribo_modal_solve_rest(b, ramp);

    for (size_t p = 0; p < s; p++) {
        int changes = ramp[p] != 0.0;
        for (size_t k = 0; k < m; k++) {
            changes |= by_q[k * s + p] != 0.0 || by_u[k * s + p] != 0.0;
        }
        for (size_t w = 0; w < h->harmonics; w++) {
            changes |= wave_r[w * s + p] != 0.0 || wave_i[w * s + p] != 0.0;
        }
        if (!changes) {
            continue;
        }
        struct output *output = &all[(*used)++];
        if (!create_output(b, output, b->rest[p])) {
            return 0;
        }
        output->ramp = ramp[p];
        for (size_t k = 0; k < m; k++) {
            output->on_rate[k] = by_q[k * s + p];
            output_mode(b, output, k, by_q[k * s + p], by_u[k * s + p]);
        }
        for (size_t w = 0; w < h->harmonics; w++) {
            output->rr[w] += wave_r[w * s + p];
            output->ri[w] += wave_i[w * s + p];
        }
        finish_output(b, output);
    }
    return 1;
}

int tribo_modal_outputs(struct build *b)
{
    struct modal *h = b->h;
    const size_t c = b->sys->ncontact;
    h->output = tribo_modal_keep_outputs(b, c);
    if (!h->output) {
        return 0;
    }
    for (size_t i = 0; i < c; i++) {
        if (!h->key[i] && !output_sliding(b, &h->output[h->outputs++], i)) {
            return 0;
        }
    }
    h->sliding = h->outputs;
    return output_held(b, h->output, &h->outputs);
}
