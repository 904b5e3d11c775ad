/* Outputs: velocities and forces of contacts by the modes and by bases. */
#include "parts.h"

#include <math.h>
#include <string.h>

#include "common/real.h"

/* Relative difference of the velocities of bases up to which the difference is rounding. */
#define NO_MOTION 1e-14

/* Adds position eta_k + velocity eta_k' of mode k to an output: exponents and harmonics. */
static void output_mode(const struct modal_build *b, struct output *w, size_t k, double position, double velocity)
{
    const struct modal *h = b->h;
    const size_t m = h->modes;
    for (size_t p = 0; p < h->exponents; p++) {
        if (h->owner && h->owner[p] != k) {
            continue;
        }
        const double rr = h->owner ? 1.0 : h->rr[p * m + k], ri = h->owner ? 0.0 : h->ri[p * m + k];
        const double fr = position + velocity * h->lr[p], fi = velocity * h->li[p];
        w->cr[p] += fr * rr - fi * ri;
        w->ci[p] += fr * ri + fi * rr;
    }
    for (size_t s = 0; s < h->harmonics; s++) {
        const double omega = h->forcing[s].omega, xr = h->xr[s * m + k], xi = h->xi[s * m + k];
        w->rr[s] += position * xr - velocity * omega * xi;
        w->ri[s] += position * xi + velocity * omega * xr;
    }
}

static int create_output(struct modal_build *b, struct output *w, size_t contact)
{
    const size_t terms = b->h->terms, p = b->h->exponents;
    double *x = tribo_modal_keep(b, 3 * terms + b->h->modes);
    if (!x) {
        return 0;
    }
    double *cr = x, *ci = x + terms, *size = x + 2 * terms;
    *w = (struct output){contact, cr, ci, size, cr + p, ci + p, size + p, x + 3 * terms, 0.0};
    return 1;
}

static void finish_output(const struct modal *h, struct output *w)
{
    for (size_t p = 0; p < h->exponents + h->harmonics; p++) {
        w->size[p] = tribo_modal_magnitude(w->cr[p], w->ci[p]);
    }
}

/* Returns the largest |x_i| + |y_i|. */
static double largest(const double *x, const double *y, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        most = greater(most, fabs(x[i]) + fabs(y[i]));
    }
    return most;
}

/* Adds to rr and ri the part of v_i = J_i q' + (G f')_i - b_i by harmonics of bases, except parts that are only rounding. Returns
 * 1 if any part was added. */
static int output_belts(const struct modal_build *b, struct output *w, size_t i)
{
    const tribo_system *sys = b->shared->sys;
    const struct matrix *j = &sys->direction;
    int any = 0;
    for (size_t s = 0; s < b->h->given; s++) {
        const struct harmonic *wave = &b->shared->sys->harmonic[s];
        const double *yr = b->yr + s * b->n, *yi = b->yi + s * b->n, most = largest(yr, yi, b->n);
        double re = 0.0, im = 0.0, size = 0.0;
        for (size_t e = j->first[i]; e < j->first[i + 1]; e++) {
            re += j->val[e] * yr[j->col[e]];
            im += j->val[e] * yi[j->col[e]];
            size += fabs(j->val[e]) * most;
        }
        for (size_t e = 0; wave->drives == DRIVES_BASE && wave->omega != 0.0 && e < wave->count; e++) {
            re -= wave->index[e] == i ? wave->cosine[e] : 0.0;
            im += wave->index[e] == i ? wave->sine[e] : 0.0;
        }
        for (size_t p = b->rests; tribo_is_compliant(&sys->compliance, i) && p < b->rests + b->springs; p++) {
            const double entry = tribo_compliance_entry(&sys->compliance, sys->ncontact, i, b->rest[p]);
            re += entry * b->rate_r[s * b->rates + b->rest[p]];
            im += entry * b->rate_i[s * b->rates + b->rest[p]];
        }
        if (fabs(re) + fabs(im) > NO_MOTION * size) {
            w->rr[s] += re;
            w->ri[s] += im;
            any = 1;
        }
    }
    return any;
}

/* Output v_i = J_i q' + (G f')_i - b_i of a sliding contact, f' of compliant contacts at rest. Returns 0 if out of memory. */
static int output_sliding(struct modal_build *b, struct output *w, size_t i)
{
    if (!create_output(b, w, i)) {
        return 0;
    }
    for (size_t k = 0; k < b->h->modes; k++) {
        const double shape = tribo_modal_shape(b, i, k);
        w->on_rate[k] = shape;
        output_mode(b, w, k, 0.0, shape);
    }
    output_belts(b, w, i);
    finish_output(b->h, w);
    return 1;
}

/* Output v_i of a contact at rest that does not hold: not moved by modes, but by bases that part; dropped if v_i is 0. */
static int output_parting(struct modal_build *b, struct output *all, size_t *used, size_t i)
{
    struct output *w = &all[*used];
    if (!create_output(b, w, i)) {
        return 0;
    }
    *used += output_belts(b, w, i) != 0;
    finish_output(b->h, w);
    return 1;
}

/* Forces f of the rigid contacts that hold, J_I'f = K q + C q' + M q'' - M load: by harmonics, and rates by constant speeds. */
struct holding {
    double *wave_r, *wave_i; /* [harmonics][rests] f by harmonics */
    double *ramp;            /* [rests] f' by bases of constant speed */
    double *force[2], *load; /* [ndof] workspace */
};

/* Sets by_q, J_I'f = (stiffness - omega_k^2 M) phi_k, compliant f = -G_AA^-1 J_A phi_k; by_u, J_I'f = C phi_k - M Phi C~_k. */
int tribo_modal_hold(struct modal_build *b)
{
    struct modal *h = b->h;
    const tribo_system *sys = b->shared->sys;
    const size_t n = b->n, m = h->modes, s = b->rests + b->springs, c = sys->ncontact;
    double **const kept[] = {&h->held.by_q, &h->held.by_u};
    const size_t count[] = {m * s, m * s};
    double *load = tribo_modal_scratch(b, m * n + 2 * c), *v = load ? load + m * n : NULL;
    if (!load || !tribo_modal_keep_all(b, 2, kept, count)) {
        return 0;
    }
    if (b->shared->damping && h->coupling) {
        tribo_multiply_transposed_add(m, m, n, h->coupling, b->psi, load);
    }
    for (size_t k = 0; b->rests > 0 && k < m; k++) {
        const double *psi = b->psi + k * n;
        double *force = load + k * n;
        for (size_t d = 0; b->shared->damping && d < n; d++) {
            force[d] = b->c_phi[k * n + d] - (h->coupling ? force[d] : h->damping[k] * psi[d]);
        }
        if (b->shared->damping) {
            tribo_constraints_react(&b->ties, force, h->held.by_u + k * s);
        }
        memcpy(force, b->k_phi + k * n, n * sizeof *force);
        tribo_add(force, -h->omega2[k], psi, n);
        tribo_constraints_react(&b->ties, force, h->held.by_q + k * s);
    }
    for (size_t k = 0; b->springs > 0 && k < m; k++) {
        tribo_matrix_multiply(&sys->direction, b->phi + k * n, v);
        tribo_compliance_rates(sys, b->slip, v, v + c);
        for (size_t p = b->rests; p < s; p++) {
            h->held.by_q[k * s + p] = v[c + b->rest[p]];
        }
    }
    return 1;
}

static void hold_harmonic(const struct modal_build *b, struct holding *f, size_t w)
{
    const struct forcing *forcing = &b->h->forcing[w];
    const struct harmonic *wave = &b->shared->sys->harmonic[forcing->harmonic];
    const size_t n = b->n, s = b->rests;
    memset(f->force[0], 0, n * sizeof **f->force);
    memset(f->force[1], 0, n * sizeof **f->force);
    if (forcing->contact < b->shared->sys->ncontact) {
        /* Force f = limit of contact i, which does not hold, by a harmonic of the limit. */
        const size_t i = forcing->contact;
        const struct matrix *j = &b->shared->sys->direction;
        for (size_t e = j->first[i]; e < j->first[i + 1]; e++) {
            f->force[0][j->col[e]] = -j->val[e] * wave->cosine[i];
            f->force[1][j->col[e]] = j->val[e] * wave->sine[i];
        }
    } else if (wave->drives == DRIVES_BASE) {
        /* Bases with velocities y [2][ndof], displacements y/(i Omega), accelerations i Omega y. */
        const double omega = wave->omega;
        const double *const *y = (const double *const[]){b->yr + w * n, b->yi + w * n};
        for (int part = 0; part < 2; part++) {
            const double turn = part ? 1.0 : -1.0;
            if (b->shared->damping) {
                tribo_matrix_multiply_add(b->shared->damping, 1.0, y[part], f->force[part]);
            }
            tribo_matrix_multiply_add(b->shared->stiffness, turn / omega, y[part], f->force[1 - part]);
            tribo_modal_add_springs(b, -turn / omega, (part ? b->rate_i : b->rate_r) + w * b->rates, f->force[1 - part]);
            tribo_system_add_mass(b->shared->sys, -turn * omega, y[part], f->force[1 - part]);
        }
    } else if (wave->drives == DRIVES_LOAD) {
        /* A harmonic load. */
        for (int part = 0; part < 2; part++) {
            memset(f->load, 0, b->n * sizeof *f->load);
            for (size_t e = 0; e < wave->count; e++) {
                f->load[wave->index[e]] = part ? wave->sine[e] : -wave->cosine[e];
            }
            tribo_system_add_mass(b->shared->sys, 1.0, f->load, f->force[part]);
        }
    }
    tribo_modal_react(b, f->force[0], f->wave_r + w * s);
    tribo_modal_react(b, f->force[1], f->wave_i + w * s);
}

static int find_holding(struct modal_build *b, struct holding *f)
{
    const struct modal *h = b->h;
    const size_t n = b->n, s = b->rests;
    double **const all[] = {&f->wave_r, &f->wave_i, &f->ramp, &f->force[0], &f->force[1], &f->load};
    const size_t count[] = {h->harmonics * s, h->harmonics * s, s, n, n, n};
    double *work = tribo_modal_scratch(b, (2 * h->harmonics + 1) * s + 3 * n);
    if (!work) {
        return 0;
    }
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        *all[k] = work;
        work += count[k];
    }
    for (size_t w = 0; w < h->harmonics; w++) {
        if (h->forcing[w].omega != 0.0) {
            hold_harmonic(b, f, w);
        }
    }
    if (b->steady) {
        memset(f->load, 0, n * sizeof *f->load);
        tribo_matrix_multiply_add(b->shared->stiffness, 1.0, b->y0, f->load);
        tribo_modal_add_springs(b, -1.0, b->rate_0, f->load);
        tribo_modal_react(b, f->load, f->ramp);
    }
    return 1;
}

/* Returns 1 if the force or the limit of contact rest[p] varies. */
static int changes(const struct modal_build *b, const struct holding *f, size_t p)
{
    const struct modal *h = b->h;
    const size_t held = b->rests + b->springs;
    int found = f->ramp[p] != 0.0 || tribo_system_swing(b->shared->sys, b->rest[p]) > 0.0;
    for (size_t k = 0; k < h->modes; k++) {
        found |= h->held.by_q[k * held + p] != 0.0 || h->held.by_u[k * held + p] != 0.0;
    }
    for (size_t w = 0; w < h->harmonics; w++) {
        found |= f->wave_r[w * b->rests + p] != 0.0 || f->wave_i[w * b->rests + p] != 0.0;
    }
    return found;
}

/* Appends an output of contact rest[p] and adds the part by modes. Returns NULL if out of memory. */
static struct output *output_by_modes(struct modal_build *b, struct output *all, size_t *used, size_t p)
{
    const struct modal *h = b->h;
    const size_t held = b->rests + b->springs;
    struct output *output = &all[(*used)++];
    if (!create_output(b, output, b->rest[p])) {
        return NULL;
    }
    for (size_t k = 0; k < h->modes; k++) {
        output->on_rate[k] = h->held.by_q[k * held + p];
        output_mode(b, output, k, h->held.by_q[k * held + p], h->held.by_u[k * held + p]);
    }
    return output;
}

/* Appends the outputs of rigid contacts that hold and have a varying force or limit. Returns 0 if out of memory. */
static int output_held(struct modal_build *b, struct output *all, size_t *used)
{
    struct modal *h = b->h;
    struct holding f;
    if (b->rests > 0 && !find_holding(b, &f)) {
        return 0;
    }
    for (size_t p = 0; p < b->rests; p++) {
        struct output *output = changes(b, &f, p) ? output_by_modes(b, all, used, p) : NULL;
        if (!output && changes(b, &f, p)) {
            return 0;
        }
        for (size_t w = 0; output && w < h->harmonics; w++) {
            output->rr[w] += f.wave_r[w * b->rests + p];
            output->ri[w] += f.wave_i[w * b->rests + p];
        }
        if (output) {
            output->ramp = f.ramp[p];
            finish_output(h, output);
        }
    }
    return 1;
}

/* Appends the outputs f = f'/(i Omega) of the compliant contacts at rest; sets held.fr, fi, f0. Returns 0 if out of memory. */
static int output_springs(struct modal_build *b, struct output *all, size_t *used)
{
    struct modal *h = b->h;
    const size_t s = b->springs;
    double **const kept[] = {&h->held.fr, &h->held.fi, &h->held.f0};
    const size_t count[] = {h->given * s, h->given * s, s};
    if (s > 0 && !tribo_modal_keep_all(b, sizeof kept / sizeof *kept, kept, count)) {
        return 0;
    }
    h->held.springs = s;
    for (size_t p = 0; p < s; p++) {
        const size_t i = b->rest[b->rests + p];
        struct output *output = output_by_modes(b, all, used, b->rests + p);
        if (!output) {
            return 0;
        }
        for (size_t w = 0; w < h->given; w++) {
            const double omega = h->forcing[w].omega, by = omega != 0.0 ? 1.0 / omega : 0.0;
            h->held.fr[w * s + p] = b->rate_r[w * b->rates + i];
            h->held.fi[w * s + p] = b->rate_i[w * b->rates + i];
            output->rr[w] += by * h->held.fi[w * s + p];
            output->ri[w] -= by * h->held.fr[w * s + p];
        }
        output->ramp = h->held.f0[p] = b->rate_0[i];
        finish_output(h, output);
    }
    return 1;
}

static double sixth_power(double x)
{
    return x * x * x * x * x * x;
}

static int find_terms(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t p = h->exponents;
    const size_t count = p + h->harmonics > 0 ? p + h->harmonics : 1;
    h->terms = (count + TRIBO_TERMS - 1) / TRIBO_TERMS * TRIBO_TERMS;
    double *x = tribo_modal_keep(b, 4 * h->terms);
    if (!x) {
        return 0;
    }
    memcpy(x, h->lr, p * sizeof *x);
    memcpy(x + h->terms, h->li, p * sizeof *x);
    h->lr = x;
    h->li = x + h->terms;
    h->size = x + 2 * h->terms;
    h->sixth = x + 3 * h->terms;
    for (size_t s = 0; s < h->harmonics; s++) {
        h->li[p + s] = h->forcing[s].omega;
    }
    for (size_t k = 0; k < h->terms; k++) {
        h->size[k] = tribo_modal_magnitude(h->lr[k], h->li[k]);
        h->sixth[k] = sixth_power(h->size[k]);
        h->fastest = greater(h->fastest, k < p ? h->size[k] : 0.0);
        h->quickest = greater(h->quickest, h->size[k]);
        h->decay = greater(h->decay, -h->lr[k]);
        h->growth = greater(h->growth, h->lr[k]);
    }
    return 1;
}

int tribo_modal_outputs(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t c = b->shared->sys->ncontact;
    h->output = tribo_modal_keep_outputs(b, c);
    if (!h->output || !find_terms(b)) {
        return 0;
    }
    for (size_t i = 0; i < c; i++) {
        const int done = b->h->key[i] == 0   ? output_sliding(b, &h->output[h->outputs++], i)
                         : b->h->key[i] == 1 ? output_parting(b, h->output, &h->outputs, i)
                                             : 1;
        if (!done) {
            return 0;
        }
    }
    h->sliding = h->outputs;
    return output_held(b, h->output, &h->outputs) && output_springs(b, h->output, &h->outputs);
}
