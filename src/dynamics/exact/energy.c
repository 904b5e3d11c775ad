/* The energy that friction dissipates in a phase, in closed form. A steady force dissipates |force| times the distance slid. The
 * part of a force by harmonics of the limit is a sum of e^{i Omega t}; the velocity is a sum of exponentials, too: the integrals
 * of products are divided differences of the exponential function (divided.h). If a large limit swings through zero, these parts
 * cancel each other: then the power, of one sign, is integrated by samples. */
#include "divided.h"
#include "terms.h"

#include <math.h>

/* A harmonic of a limit in the phase, Re(a e^{i Omega t}), t from 0 (at t0) to tau; turn = i Omega tau. */
struct tide {
    double complex a, turn;
    double tau;
};

static double complex complex_of(struct number z)
{
    return z.re + z.im * I;
}

/* Returns m: the mean of Re(a e^{i Omega t}) Re(c e^{z t/tau}) over [0, tau] is Re(c m). */
static double complex mean(const struct tide *w, double complex z)
{
    return 0.5 * (w->a * tribo_exp_1(z + w->turn) + conj(w->a) * tribo_exp_1(z - w->turn));
}

/* Returns m: the mean of Re(a e^{i Omega t}) Re(c (e^{y t/tau} - e^{z t/tau})/(y - z)) over [0, tau] is Re(c m). */
static double complex mean_2(const struct tide *w, double complex y, double complex z)
{
    return 0.5 * (w->a * tribo_exp_2(y + w->turn, z + w->turn) + conj(w->a) * tribo_exp_2(y - w->turn, z - w->turn));
}

/* Returns m for the part of exponent p by the resonant harmonic s, see add_resonance in motion.c. */
static double complex mean_resonance(const struct modal_motion *x, const struct tide *w, size_t p, size_t s)
{
    const struct modal *h = x->h;
    const size_t at = s * h->modes + h->owner[p];
    const double complex g = 0.5 * (h->gr[at] + h->gi[at] * I) * complex_of(tribo_harmonic_at_start(x, s));
    const double complex z = w->tau * (h->lr[p] + h->li[p] * I), y = w->tau * h->forcing[s].omega * I;
    return -I / h->li[p] * w->tau * (g * mean_2(w, y, z) + conj(g) * mean_2(w, -y, z));
}

/* Returns m for exponent p with all resonances. */
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

/* Returns the integral over [0, tau] of the harmonic w of a limit times the velocity of contact i, with output v. */
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

/* Returns the integral over [0, tau] of the part of the limit of contact i by harmonics times the velocity. */
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

#define ALL ((size_t)-1)

/* Returns the work of the steady force of contact i: tally steady (J dq + G df)_i, without the displacement of the base. */
static double steady_work(const struct modal_motion *x, size_t i)
{
    const struct compliance *g = &x->sys->compliance;
    double way = tribo_matrix_row_dot(&x->sys->direction, i, x->dq);
    for (size_t k = 0; tribo_is_compliant(g, i) && k < g->count; k++) {
        way += tribo_compliance_entry(g, x->sys->ncontact, i, g->contact[k]) * x->df[g->contact[k]];
    }
    return x->sys->tally[i] * x->steady[i] * way;
}

/* Returns the sum of tally steady (displacement of the base) over contacts with slip != 0: all if one = ALL, else contact one. */
static double belt_work(const struct modal_motion *x, double tau, size_t one)
{
    double work = 0.0;
    for (size_t s = 0; x->sys->base_harmonics && s < x->h->given; s++) {
        const struct harmonic *w = &x->sys->harmonic[s];
        const struct number now = tribo_harmonic(x, s), then = tribo_harmonic_at_start(x, s);
        for (size_t e = 0; w->drives == DRIVES_BASE && e < w->count; e++) {
            const size_t i = w->index[e];
            const double c = w->cosine[e], d = w->sine[e];
            const double way = w->omega == 0.0 ? c * tau : (c * (now.im - then.im) - d * (now.re - then.re)) / w->omega;
            work += x->contacts->state.slip[i] && (i == one || one == ALL) ? x->sys->tally[i] * x->steady[i] * way : 0.0;
        }
    }
    return work;
}

/* Smallest |sum|/(size of the parts) at which the sum keeps enough digits. */
#define CANCELS 1e-4

/* Largest number of samples in a phase. */
#define MOST_SAMPLES 32768.0

/* Returns an estimate of the size of the parts of the work of contact i; *fastest = largest |lambda| or Omega of the terms. */
static double size_of_parts(const struct modal_motion *x, size_t i, const struct output *v, double tau, double *fastest)
{
    const struct modal *h = x->h;
    double size = fabs(x->line[i].start) + fabs(x->line[i].ramp) * tau, limits = fabs(x->steady[i]);
    *fastest = 0.0;
    for (size_t p = 0; p < h->exponents; p++) {
        const struct number z = tribo_term_at_start(x, p);
        size += v->size[p] * (fabs(z.re) + fabs(z.im));
        *fastest = v->size[p] > 0.0 ? greater(*fastest, hypot(h->lr[p], h->li[p])) : *fastest;
    }
    for (size_t s = 0; s < h->harmonics; s++) {
        const struct harmonic *w = &x->sys->harmonic[s];
        size += v->wave[s];
        limits += s < h->given && w->drives == DRIVES_LIMIT ? fabs(w->cosine[i]) + fabs(w->sine[i]) : 0.0;
        *fastest = greater(*fastest, fabs(h->forcing[s].omega));
    }
    return tau * limits * size;
}

/* Returns the work of contact i by Gauss's rule with 8 points in each interval. The caller chooses intervals in which no term
 * turns by more than 1 rad. Goes through the phase and back to tau. */
static double sampled_work(struct modal_motion *x, size_t i, const struct output *v, double tau, size_t intervals)
{
    static const double at[] = {0.18343464249564980, 0.52553240991632899, 0.79666647741362674, 0.96028985649753623},
                        weight[] = {0.36268378337836198, 0.31370664587788729, 0.22238103445337447, 0.10122853629037626};
    const double half = 0.5 * tau / (double)intervals;
    struct course c = {.output = v, .line = x->line[i]};
    double work = 0.0;
    for (size_t k = 0; k < 8 * intervals; k++) {
        const size_t point = k % 8;
        tribo_modal_motion_go(x, half * ((double)(2 * (k / 8) + 1) + (point % 2 ? at[point / 2] : -at[point / 2])));
        tribo_course_look(x, &c);
        const double limit = x->sys->given_limit[i] + tribo_modal_motion_limit(x, i).g;
        work += weight[point / 2] * greater(limit, 0.0) * greater(x->contacts->state.slip[i] * c.at.g, 0.0);
    }
    tribo_modal_motion_go(x, tau);
    return half * work;
}

/* Returns the energy dissipated by contact i, which follows harmonics of the limit, minus belt_work of contact i. */
static double swinging_work(struct modal_motion *x, size_t i, const struct output *v, double tau)
{
    const double closed = x->contacts->state.slip[i] * limit_work(x, i, v, tau), own = x->sys->tally[i];
    const double belt = belt_work(x, tau, i), whole = own * closed - steady_work(x, i) + belt;
    double fastest;
    const double size = own * size_of_parts(x, i, v, tau, &fastest), intervals = ceil(fastest * tau) + 1.0;
    if (fabs(whole) >= CANCELS * size || !(8.0 * intervals <= MOST_SAMPLES)) {
        return whole - belt;
    }
    return own * sampled_work(x, i, v, tau, (size_t)intervals) - belt;
}

double tribo_modal_motion_work(struct modal_motion *x, size_t i, double tau)
{
    const struct output *v = x->h->output;
    while (v->contact != i) {
        v++;
    }
    const double own = x->sys->limit_harmonics ? swinging_work(x, i, v, tau) : -steady_work(x, i);
    return (own + belt_work(x, tau, i)) / x->sys->tally[i];
}

double tribo_modal_motion_dissipated(struct modal_motion *x, double tau)
{
    const signed char *slip = x->contacts->state.slip;
    double energy = 0.0;
    for (size_t o = 0; o < x->h->sliding; o++) {
        const struct output *v = &x->h->output[o];
        const size_t i = v->contact;
        if (x->sys->limit_harmonics && tribo_slides(slip[i])) {
            energy += swinging_work(x, i, v, tau);
        } else {
            energy -= slip[i] ? steady_work(x, i) : 0.0;
        }
    }
    return energy + belt_work(x, tau, ALL);
}
