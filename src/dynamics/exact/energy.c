/* SPDX-License-Identifier: BSD-3-Clause */
/* The energy that friction dissipates in a phase, in closed form. A steady force dissipates |force| times the distance slid. A
 * limit that varies is a sum of exponentials and powers of time, as the velocity: their product is integrated (signal.h). If a
 * large limit swings through zero, its parts cancel each other. Samples integrate the power, of one sign, then, if a load
 * resonates, and in a phase so short that samples are fewer than terms. */
#include "motion.h"
#include "common/real.h"

#include <math.h>

/* Smallest |sum|/(size of the parts) at which the sum keeps enough digits. */
#define CANCELS 1e-4

/* Number of samples of an interval; largest number of samples where parts cancel. */
enum { SAMPLES = 8, MOST_SAMPLES = 32768 };

/* Returns the work of the contact by Gauss's rule with SAMPLES points in each interval; steady: the part of its limit that does
 * not vary. The caller chooses intervals in which no term turns by more than 1 rad. Goes through the phase and back to tau. */
static double sampled_work(struct exact *x, const struct course *course, double tau, double steady, size_t intervals)
{
    static const double at[] = {0.18343464249564980, 0.52553240991632899, 0.79666647741362674, 0.96028985649753623},
                        weight[] = {0.36268378337836198, 0.31370664587788729, 0.22238103445337447, 0.10122853629037626};
    const double half = 0.5 * tau / (double)intervals;
    const size_t i = course->output->contact;
    struct course c = *course;
    double work = 0.0;
    for (size_t k = 0; k < SAMPLES * intervals; k++) {
        const size_t point = k % SAMPLES;
        tribo_modal_motion_go(x, half * ((double)(2 * (k / SAMPLES) + 1) + (point % 2 ? at[point / 2] : -at[point / 2])));
        tribo_course_look(x, &c);
        const double limit = steady + tribo_modal_motion_limit(x, i).g;
        work += weight[point / 2] * greater(limit, 0.0) * greater(x->events.stick_slip.state.slip[i] * c.at.g, 0.0);
    }
    tribo_modal_motion_go(x, tau);
    return half * work;
}

/* Sets *s = the output of course c over [0, tau], and *fastest to at least |lambda| of its terms. Returns a bound of its size. */
static double set_signal(const struct exact *x, const struct course *c, double tau, struct signal *s, double *fastest)
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
    while (s->degree > 0 && s->a[s->degree] == 0.0) {
        s->degree--;
    }
    for (size_t p = 0; p < terms; p++) {
        const double complex z = tribo_part(&x->z, p);
        if (c->output->size[p] > 0.0) {
            tribo_signal_add(s, (c->output->cr[p] + c->output->ci[p] * I) * z, h->lr[p] + h->li[p] * I);
            *fastest = greater(*fastest, h->size[p]);
        }
        size += c->output->size[p] * (fabs(creal(z)) + fabs(cimag(z)));
    }
    return size;
}

/* Returns the energy that the contact of course c, which slides, dissipates until tau, its force counted once: by a steady force,
 * the force times the distance; else closed, as the integral of limit times velocity, or by samples. */
static inline double work_of(struct exact *x, const struct course *c, double tau)
{
    const size_t i = c->output->contact;
    const signed char slip = x->events.stick_slip.state.slip[i];
    double mu;
    const struct course *part = tribo_system_limits_vary(x->sys) ? tribo_modal_limit_course(x, i, &mu) : NULL;
    const int follows = tribo_normals_follower(x->sys, i) != NULL;
    if (!part || !tribo_slides(slip)) {
        return follows ? 0.0 : -x->steady[i] * tribo_dot(c->output->on_rate, x->place, x->h->shapes);
    }
    double fastest = 0.0;
    const double steady = follows ? 0.0 : tribo_system_steady_limit(x->sys, i),
                 velocity = set_signal(x, c, tau, &x->factor[0], &fastest);
    const double limit = set_signal(x, part, tau, &x->factor[1], &fastest) + fabs(steady);
    const double intervals = ceil(fastest * tau) + 1.0;
    if (!x->h->resonant && SAMPLES * intervals > (double)x->h->terms) {
        x->factor[1].a[0] += steady;
        const double work = slip * tribo_signal_product(x->factor);
        const int many = SAMPLES * intervals > MOST_SAMPLES && !follows;
        if (work >= CANCELS * tau * velocity * limit || many) {
            return mu * work;
        }
    }
    return sampled_work(x, c, tau, steady, (size_t)intervals);
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
