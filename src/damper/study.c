/* SPDX-License-Identifier: BSD-3-Clause */
#include "study.h"

#include <math.h>
#include <stdlib.h>

#include "output.h"
#include "team.h"

static const double BEND = 0.02; /* tolerance of curves; a larger one misses narrow peaks */

double limit_of(const struct range *limits, size_t k)
{
    const double part = k ? (double)k / (double)(limits->points - 1) : 0.0;
    return pow(limits->from, 1.0 - part) * pow(limits->to, part);
}

/* --------------------------------------------------------------------------------------------------------------- curves */

/* Adds the points that the user gives; to a band also the resonances of the structure, free or stuck. */
static void ask_samples(const struct study *s, struct curve *c)
{
    const struct range *limits = &s->options->limits, *band = &s->options->drive;
    const struct damper *d = s->damper;
    for (size_t k = 0; c->over_limit && k < limits->points; k++) {
        ask_sample(c, log(limit_of(limits, k)), 1);
    }
    for (size_t k = 0; !c->over_limit && k < band->points; k++) {
        ask_sample(c, band->from + (band->to - band->from) * ((double)k / (double)(band->points - 1)), 1);
    }
    for (size_t k = 0; !c->over_limit && k < d->kept + d->stuck.count; k++) {
        const double hz = (k < d->stuck.count ? d->stuck.omega[k] : d->open.omega[k - d->stuck.count]) / TURN;
        if (hz > band->from && hz < band->to) {
            ask_sample(c, hz, 0);
        }
    }
}

struct job_of_curves {
    const struct study *study;
    struct curve *curve;
};

static void run_curve(void *data, size_t k)
{
    const struct job_of_curves *j = data;
    struct curve *c = &j->curve[k];
    struct worker w = create_worker(j->study->damper, j->study->options->march);
    if (j->study->options->follow) {
        follow_curve(c, &w);
    } else {
        ask_samples(j->study, c);
        find_curve(c, &w, BEND);
        if (!c->over_limit) {
            find_largest(c, &w, BEND);
        }
    }
    free_worker(&w);
}

struct curve *run_curves(const struct study *s, int over_limit, const double *fixed, size_t count)
{
    struct job_of_curves j = {s, need_memory(count, sizeof *j.curve)};
    for (size_t k = 0; k < count; k++) {
        j.curve[k] = (struct curve){.over_limit = over_limit, .fixed = fixed[k], .record = s->damper->record};
    }
    run_jobs(s->options->threads, count, run_curve, &j);
    end_progress();
    return j.curve;
}

void free_curves(struct curve *c, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        for (size_t i = 0; i < c[k].count; i++) {
            free(c[k].sample[i].y);
        }
        free(c[k].sample);
    }
    free(c);
}

const char *first_message(const struct curve *c, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        for (size_t i = 0; i < c[k].count; i++) {
            if (c[k].sample[i].motion.message[0]) {
                return c[k].sample[i].motion.message;
            }
        }
    }
    return "not looked for";
}

/* Each step finds two more values, in the middles of the halves, and keeps the least of three with its neighbours: the interval
 * is halved. */
double find_least(double low, double high, double part,
                  void (*values)(void *data, const double *limit, double *value, size_t count), void *data, double *least)
{
    double a = log(low), b = log(high), best = sqrt(low * high);
    values(data, &best, least, 1);
    while (b - a > part && !interrupted()) {
        const double quarter = 0.25 * (b - a), limit[] = {exp(a + quarter), exp(b - quarter)};
        double value[2];
        values(data, limit, value, 2);
        const int side = value[0] < *least && value[0] <= value[1] ? -1 : value[1] < *least ? 1 : 0;
        if (side) {
            best = limit[side > 0];
            *least = value[side > 0];
        }
        a += (1 + side) * quarter;
        b = a + 2.0 * quarter;
    }
    return best;
}

/* ---------------------------------------------------------------------------------------------------------------- a run */

void run_study(struct study *s)
{
    const struct options *o = s->options;
    if (is_unloaded(o)) {
        (o->backbone ? study_backbone : study_cycle)(s);
        return;
    }
    const int band = o->drive.points > 1;
    const size_t count = band ? o->limits.points : 1;
    double *fixed = need_memory(count, sizeof *fixed);
    struct curve *c = NULL;
    for (int again = 1; again;) {
        const double hz = s->damper->lowest;
        report_model(s->tables, s->model);
        check_extremes(s, hz);
        for (size_t k = 0; k < count; k++) {
            fixed[k] = band ? limit_of(&o->limits, k) : hz;
        }
        c = run_curves(s, !band, fixed, count);
        if (band) {
            write_family(s, c, count);
        } else {
            print_limits(s, c);
        }
        again = take_more_modes(s->model, show_model_error(s, c, count));
        if (again) {
            free_curves(c, count);
            close_tables(s->tables);
            *s->tables = open_tables(o);
            s->gaps = 0;
        }
    }
    if (o->follow) {
        report_folds(s, c, count);
    }
    if (band) {
        study_band(s, c, count);
    } else {
        study_limits(s, c);
    }
    free_curves(c, count);
    free(fixed);
}
