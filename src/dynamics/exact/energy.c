/* The energy that friction dissipates in a phase, in closed form. A steady force dissipates its size times the distance slid.
 * What harmonics add to it is a sum of e^{i Omega t}, and so, with other exponents, is the velocity: integrals of their products
 * are divided differences of the exponential function (divided.h). */
#include "divided.h"
#include "terms.h"

#include <math.h>

/* A harmonic of a limit from t0 on, Re(a e^{i Omega t}), as it goes until tau: turn = i Omega tau. */
struct tide {
    double complex a, turn;
    double tau;
};

static double complex complex_of(struct number z)
{
    return z.re + z.im * I;
}

/* What the mean over [0, tau] of the tide times Re(c e^{z t/tau}) is the real part of, for c = 1. */
static double complex mean(const struct tide *w, double complex z)
{
    return 0.5 * (w->a * tribo_exp_1(z + w->turn) + conj(w->a) * tribo_exp_1(z - w->turn));
}

/* The same for (e^{y t/tau} - e^{z t/tau})/(y - z). */
static double complex mean_2(const struct tide *w, double complex y, double complex z)
{
    return 0.5 * (w->a * tribo_exp_2(y + w->turn, z + w->turn) + conj(w->a) * tribo_exp_2(y - w->turn, z - w->turn));
}

/* For what a resonant harmonic does to exponent p, which add_resonance of modal_motion.c has. */
static double complex mean_resonance(const struct modal_motion *x, const struct tide *w, size_t p, size_t s)
{
    const struct modal *h = x->h;
    const size_t at = s * h->modes + h->owner[p];
    const double complex g = 0.5 * (h->gr[at] + h->gi[at] * I) * complex_of(tribo_harmonic_at_start(x, s));
    const double complex z = w->tau * (h->lr[p] + h->li[p] * I), y = w->tau * h->forcing[s].omega * I;
    return -I / h->li[p] * w->tau * (g * mean_2(w, y, z) + conj(g) * mean_2(w, -y, z));
}

/* For all that is in exponent p. */
static double complex mean_exponent(const struct modal_motion *x, const struct tide *w, size_t p)
{
    const struct modal *h = x->h;
    double complex sum = complex_of(tribo_term_at_start(x, p)) * mean(w, w->tau * (h->lr[p] + h->li[p] * I));
    for (size_t s = 0; s < h->harmonics && h->any_resonant; s++) {
        if (h->resonant[s * h->modes + h->owner[p]]) {
            sum += mean_resonance(x, w, p, s);
        }
    }
    return sum;
}

/* The integral of the tide times the velocity of contact i, whose output is v. */
static double integral(const struct modal_motion *x, const struct tide *w, size_t i, const struct output *v)
{
    const struct modal *h = x->h;
    double sum = creal(x->line[i].start * mean(w, 0.0) + x->line[i].ramp * w->tau * mean_2(w, 0.0, 0.0));
    for (size_t p = 0; p < h->exponents; p++) {
        if (v->size[p] > 0.0) {
            sum += creal((v->cr[p] + v->ci[p] * I) * mean_exponent(x, w, p));
        }
    }
    for (size_t s = 0; s < h->harmonics; s++) {
        if (v->wave[s] > 0.0) {
            const double complex r = (v->rr[s] + v->ri[s] * I) * complex_of(tribo_harmonic_at_start(x, s));
            sum += creal(r * mean(w, w->tau * h->forcing[s].omega * I));
        }
    }
    return w->tau * sum;
}

/* The work of what harmonics add to the limit of contact i against its velocity. */
static double limit_work(const struct modal_motion *x, size_t i, const struct output *v, double tau)
{
    double sum = 0.0;
    for (size_t s = 0; s < x->h->given; s++) {
        const struct harmonic *limit = &x->sys->harmonic[s];
        if (limit->drives == DRIVES_LIMIT && limit->omega != 0.0 && (limit->cosine[i] != 0.0 || limit->sine[i] != 0.0)) {
            const struct tide w = {(limit->cosine[i] - limit->sine[i] * I) * complex_of(tribo_harmonic_at_start(x, s)),
                                   limit->omega * tau * I, tau};
            sum += integral(x, &w, i, v);
        }
    }
    return sum;
}

/* The work of steady forces: their size times the distance slid, J dq, */
static double steady_work(const struct modal_motion *x, size_t i)
{
    return x->sys->tally[i] * x->steady[i] * tribo_matrix_row_dot(&x->sys->direction, i, x->dq);
}

/* minus the way of the belts. */
static double belt_work(const struct modal_motion *x, const struct harmonic *w, size_t s, double tau)
{
    const struct number now = tribo_harmonic(x, s), then = tribo_harmonic_at_start(x, s);
    double work = 0.0;
    for (size_t e = 0; e < w->count; e++) {
        const size_t i = w->index[e];
        const double c = w->cosine[e], d = w->sine[e];
        const double way = w->omega == 0.0 ? c * tau : (c * (now.im - then.im) - d * (now.re - then.re)) / w->omega;
        work += x->contacts->slip[i] ? x->sys->tally[i] * x->steady[i] * way : 0.0;
    }
    return work;
}

double tribo_modal_motion_dissipated(const struct modal_motion *x, double tau)
{
    const signed char *slip = x->contacts->slip;
    double energy = 0.0;
    for (size_t o = 0; o < x->h->sliding; o++) {
        const struct output *v = &x->h->output[o];
        energy -= slip[v->contact] ? steady_work(x, v->contact) : 0.0;
        if (x->sys->limit_harmonics && (slip[v->contact] == 1 || slip[v->contact] == -1)) {
            energy += x->sys->tally[v->contact] * slip[v->contact] * limit_work(x, v->contact, v, tau);
        }
    }
    for (size_t s = 0; x->sys->base_harmonics && s < x->h->given; s++) {
        const struct harmonic *w = &x->sys->harmonic[s];
        energy += w->drives == DRIVES_BASE ? belt_work(x, w, s, tau) : 0.0;
    }
    return energy;
}
