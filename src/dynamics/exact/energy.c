/* SPDX-License-Identifier: BSD-3-Clause */
/* The energy that friction dissipates in a phase, in closed form. A steady force dissipates |force| times the distance slid. The
 * part of a force by harmonics of the limit is integrated with the velocity, a sum of exponentials (signal.h), and so is a limit
 * that follows a normal load. If a large limit swings through zero, these parts cancel each other. Samples integrate the power,
 * of one sign, then, if a load resonates, of limits by tables, and in a phase so short that samples are fewer than terms. */
#include "motion.h"
#include "common/real.h"

#include <math.h>

/* Smallest |sum|/(size of the parts) at which the sum keeps enough digits. */
#define CANCELS 1e-4

/* Number of samples of an interval; largest number of samples of a phase without resonance. */
enum { SAMPLES = 8, MOST_SAMPLES = 32768 };

/* Returns the work of the contact by Gauss's rule with SAMPLES points in each interval. The caller chooses intervals in which no
 * term turns by more than 1 rad. Goes through the phase and back to tau. */
static double sampled_work(struct exact *x, const struct course *course, double tau, size_t intervals)
{
    static const double at[] = {0.18343464249564980, 0.52553240991632899, 0.79666647741362674, 0.96028985649753623},
                        weight[] = {0.36268378337836198, 0.31370664587788729, 0.22238103445337447, 0.10122853629037626};
    const double half = 0.5 * tau / (double)intervals;
    const size_t i = course->output->contact;
    const int follows = tribo_normals_follower(x->sys, i) != NULL;
    struct course c = *course;
    double work = 0.0;
    for (size_t k = 0; k < SAMPLES * intervals; k++) {
        const size_t point = k % SAMPLES;
        tribo_modal_motion_go(x, half * ((double)(2 * (k / SAMPLES) + 1) + (point % 2 ? at[point / 2] : -at[point / 2])));
        tribo_course_look(x, &c);
        const double limit = (follows ? 0.0 : tribo_system_steady_limit(x->sys, i)) + tribo_modal_motion_limit(x, i).g;
        work += weight[point / 2] * greater(limit, 0.0) * greater(x->events.stick_slip.state.slip[i] * c.at.g, 0.0);
    }
    tribo_modal_motion_go(x, tau);
    return half * work;
}

/* Sets *s = the output of course c over [0, tau]. Returns a bound of its size. */
static double set_signal(const struct exact *x, const struct course *c, double tau, struct signal *s)
{
    const struct forced *h = x->h;
    const size_t terms = h->modal->exponents + h->harmonics;
    double size = fabs(c->start) + (fabs(c->ramp) + (fabs(c->square) + fabs(c->cube) * tau) * tau) * tau;
    tribo_signal_reserve(s, terms, 3); /* cannot fail: tribo_modal_motion_start has made room */
    s->tau = tau;
    s->a[0] = c->start;
    s->a[1] = c->ramp;
    s->a[2] = c->square;
    s->a[3] = c->cube;
    for (size_t p = 0; p < terms; p++) {
        const double complex z = tribo_part(&x->z, p);
        if (c->output->size[p] > 0.0) {
            tribo_signal_add(s, (c->output->cr[p] + c->output->ci[p] * I) * z, h->lr[p] + h->li[p] * I);
        }
        size += c->output->size[p] * (fabs(creal(z)) + fabs(cimag(z)));
    }
    return size;
}

/* Returns the energy that the sliding contact of course c dissipates until tau. The limit is mu times the output of `load`; a
 * table with load = NULL. Closed, as the integral of limit times velocity; by samples with a table, with resonance, in a short
 * phase, or where parts cancel. */
static double following_work(struct exact *x, const struct course *c, double tau, double mu, const struct course *load)
{
    const double intervals = ceil(x->h->quickest * tau) + 1.0;
    if (load && !x->h->resonant && SAMPLES * intervals > (double)x->h->terms) {
        const double size = set_signal(x, c, tau, &x->factor[0]) * set_signal(x, load, tau, &x->factor[1]);
        const double work = x->events.stick_slip.state.slip[c->output->contact] * tribo_signal_product(x->factor);
        if (work >= CANCELS * tau * size) {
            return mu * work;
        }
    }
    return sampled_work(x, c, tau, (size_t)intervals);
}

/* Returns the energy that the sliding contact of course c dissipates until tau: `steady`, by the steady force, plus the integral
 * of the part of the limit by harmonics times the velocity, closed; or by samples with resonance or where both cancel. */
static double varying_work(struct exact *x, const struct course *c, double tau, double steady)
{
    const struct forced *h = x->h;
    const struct output *v = c->output;
    const size_t i = v->contact, e = h->modal->exponents;
    const double velocity = set_signal(x, c, tau, &x->factor[0]);
    double limits = fabs(x->steady[i]), fastest = 0.0, work = 0.0;
    for (size_t p = 0; p < e + h->harmonics; p++) {
        fastest = greater(fastest, v->size[p] > 0.0 || p >= e ? h->size[p] : 0.0);
    }
    for (size_t s = 0; s < x->sys->loads.harmonics; s++) {
        const struct harmonic *w = &x->sys->loads.harmonic[s];
        const double cosine = x->z.re[e + s], sine = x->z.im[e + s];
        double re = 0.0, im = 0.0;
        limits += w->drives == DRIVES_LIMIT ? fabs(w->cosine[i]) + fabs(w->sine[i]) : 0.0;
        if (w->drives == DRIVES_LIMIT && w->omega != 0.0 && (w->cosine[i] != 0.0 || w->sine[i] != 0.0)) {
            tribo_signal_integrate(&x->factor[0], -w->omega, &re, &im);
            work += w->cosine[i] * (cosine * re - sine * im) + w->sine[i] * (sine * re + cosine * im);
        }
    }
    work = steady + x->events.stick_slip.state.slip[i] * work;
    const double intervals = ceil(fastest * tau) + 1.0;
    const int cancels = fabs(work) < CANCELS * tau * limits * velocity && SAMPLES * intervals <= MOST_SAMPLES;
    return x->h->resonant || cancels ? sampled_work(x, c, tau, (size_t)intervals) : work;
}

/* Returns the energy that the contact of course c, which slides, dissipates until tau, its force counted once. */
static inline double work_of(struct exact *x, const struct course *c, double tau)
{
    const size_t i = c->output->contact;
    const double steady = -x->steady[i] * tribo_dot(c->output->on_rate, x->place, x->h->shapes);
    const int slides = tribo_slides(x->events.stick_slip.state.slip[i]), varies = x->sys->loads.limits && slides;
    if (tribo_normals_follower(x->sys, i) || (varies && x->sys->loads.limit_tables)) {
        double mu;
        const struct course *load = tribo_modal_limit_course(x, i, &mu);
        return slides ? following_work(x, c, tau, mu, load) : 0.0;
    }
    return varies ? varying_work(x, c, tau, steady) : steady;
}

double tribo_modal_motion_work(void *own, size_t i, double tau)
{
    struct exact *x = own;
    const struct course *c = x->course;
    while (c->output->contact != i) {
        c++;
    }
    return work_of(x, c, tau);
}

double tribo_modal_motion_dissipated(struct exact *x, double tau)
{
    double energy = 0.0;
    for (size_t o = 0; o < x->h->sliding; o++) {
        const size_t i = x->course[o].output->contact;
        energy += x->events.stick_slip.state.slip[i] ? x->sys->tally[i] * work_of(x, &x->course[o], tau) : 0.0;
    }
    return energy;
}
