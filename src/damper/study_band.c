/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "plot.h"
#include "search.h"
#include "study.h"
#include "team.h"

static const double BEND = 0.02;       /* tolerance of curves; a larger one misses narrow peaks */
static const double LEAST_PART = 5e-4; /* tolerance of the best limit */

/* Curves over the band, one for each limit. */
struct family {
    const struct study *study;
    struct curve *curve;
};

/* The frequencies that the user gives, and the resonances of the structure, free or stuck. */
static void ask_band(const struct study *s, struct curve *c)
{
    const struct range *band = &s->options->drive;
    const struct damper *d = s->damper;
    for (size_t k = 0; k < band->points; k++) {
        ask_sample(c, band->from + (band->to - band->from) * ((double)k / (double)(band->points - 1)), 1);
    }
    for (size_t k = 0; k < d->kept + d->stuck.count; k++) {
        const double hz = (k < d->stuck.count ? d->stuck.omega[k] : d->open.omega[k - d->stuck.count]) / TURN;
        if (hz > band->from && hz < band->to) {
            ask_sample(c, hz, 0);
        }
    }
}

static void run_curve(void *data, size_t k)
{
    const struct family *f = data;
    struct curve *c = &f->curve[k];
    struct worker w = create_worker(f->study->damper, f->study->options->march);
    find_curve(c, &w, BEND);
    find_largest(c, &w, BEND);
    free_worker(&w);
}

static struct family run_family(const struct study *s, const double *limit, size_t count)
{
    struct family f = {s, need_memory(count, sizeof *f.curve)};
    for (size_t k = 0; k < count; k++) {
        f.curve[k] = create_curve(0, limit[k], record_of(s->damper));
        ask_band(s, &f.curve[k]);
    }
    run_jobs(s->options->threads, count, run_curve, &f);
    return f;
}

static void free_family(struct family *f, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        free_curve(&f->curve[k]);
    }
    free(f->curve);
}

/* ---------------------------------------------------------------------------------------------------------- best limit */

static void largest_amplitudes(void *data, const double *limit, double *value, size_t count)
{
    const struct study *s = data;
    struct family f = run_family(s, limit, count);
    for (size_t k = 0; k < count; k++) {
        const struct sample *top = largest_of(&f.curve[k]);
        value[k] = top ? top->motion.amplitude : HUGE_VAL;
    }
    free_family(&f, count);
}

/* Returns 1 if the curve of the best limit is in a table. */
static int report_best(struct study *s, double limit)
{
    struct family f = run_family(s, &limit, 1);
    const struct sample *top = largest_of(&f.curve[0]);
    end_progress();
    const int shown = top && !interrupted();
    check_by_marching(s, &f.curve[0]);
    if (shown) {
        FILE *table = create_table(s->tables, "best");
        write_motion_head(s->tables, table, s->damper);
        write_curve(s->tables, table, &f.curve[0], s->damper);
        close_table(s->tables, table, "best");
        printf("best %s of the band: %.6g, largest amplitude %.8g at %.7g Hz\n", s->tables->limit, limit, top->motion.amplitude,
               top->motion.hz);
        write_result(s->tables, strcmp(s->tables->limit, "limit") == 0 ? "band.limit" : "band.load", limit);
        write_result(s->tables, "band.amplitude", top->motion.amplitude);
        write_result(s->tables, "band.frequency", top->motion.hz);
        s->gaps += gaps_of(&f.curve[0]);
    }
    free_family(&f, 1);
    return shown;
}

/* The first message of a motion that was not found. */
static const char *first_message(const struct family *f, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        for (size_t i = 0; i < f->curve[k].count; i++) {
            if (f->curve[k].sample[i].motion.message[0]) {
                return f->curve[k].sample[i].motion.message;
            }
        }
    }
    return "not looked for";
}

/* Largest amplitudes over the limits may have several valleys: those within this factor of the lowest value are searched. */
static const double NEAR_LOWEST = 1.25;

/* The limit with the least value, between the neighbours of limits with low ones; 0 if the least is at an end. */
static double search_valleys(struct study *s, const double *limit, const double *value, size_t count)
{
    double least = HUGE_VAL, best = 0.0, lowest = HUGE_VAL;
    for (size_t k = 0; k < count; k++) {
        lowest = fmin(lowest, value[k]);
    }
    for (size_t k = 1; k + 1 < count; k++) {
        if (value[k] <= value[k - 1] && value[k] <= value[k + 1] && value[k] <= NEAR_LOWEST * lowest) {
            double found;
            const double there = find_least(limit[k - 1], limit[k + 1], LEAST_PART, largest_amplitudes, s, &found);
            best = found < least ? there : best;
            least = fmin(found, least);
        }
    }
    return least <= value[0] && least <= value[count - 1] ? best : 0.0;
}

/* Returns the best limit; 0 if there is none. */
static double find_best(struct study *s, const struct family *f, const double *limit, size_t count)
{
    double *value = need_memory(count, sizeof *value), least = HUGE_VAL;
    for (size_t k = 0; k < count; k++) {
        const struct sample *top = largest_of(&f->curve[k]);
        value[k] = top ? top->motion.amplitude : HUGE_VAL;
        least = fmin(least, value[k]);
    }
    const double found = least < HUGE_VAL ? search_valleys(s, limit, value, count) : 0.0;
    int shown = 0;
    end_progress();
    if (least == HUGE_VAL) {
        printf("no motion was found at any of these %ss: %s\n", s->tables->limit, first_message(f, count));
        check_by_marching(s, &f->curve[0]);
    } else if (found == 0.0 && !interrupted()) {
        printf("no %s within the range is better than its ends: widen --limits to find the best\n", s->tables->limit);
        check_by_marching(s, &f->curve[0]);
    } else if (!interrupted()) {
        shown = report_best(s, found);
    } else {
        check_by_marching(s, &f->curve[0]);
    }
    free(value);
    return shown ? found : 0.0;
}

/* -------------------------------------------------------------------------------------------------------------- family */

/* Returns the model error. */
static double write_family(struct study *s, const struct family *f, size_t count)
{
    FILE *table = create_table(s->tables, "family");
    write_motion_head(s->tables, table, s->damper);
    printf("  %12s   points    not found  largest amplitude  at frequency\n", s->tables->limit);
    for (size_t k = 0; k < count; k++) {
        const struct curve *c = &f->curve[k];
        const struct sample *top = largest_of(c);
        write_curve(s->tables, table, c, s->damper);
        fprintf(table, "%s", k + 1 < count && c->count ? "\n" : "");
        if (top) {
            printf("  %12.5g %8zu %12zu %18.8g %13.7g\n", c->fixed, c->count, gaps_of(c), top->motion.amplitude, top->motion.hz);
        }
        s->gaps += gaps_of(c);
    }
    close_table(s->tables, table, "family");
    return show_model_error(s, f->curve, count);
}

void study_band(struct study *s)
{
    const struct range *limits = &s->options->limits;
    const size_t count = limits->points;
    double *limit = need_memory(count, sizeof *limit);
    for (size_t k = 0; k < count; k++) {
        limit[k] = limit_of(limits, k);
    }
    struct family f;
    int again;
    do {
        show_model(s);
        check_extremes(s, lowest_drive(s->options, s->damper));
        f = run_family(s, limit, count);
        end_progress();
        again = begin_again(s, write_family(s, &f, count));
        if (again) {
            free_family(&f, count);
        }
    } while (again);
    write_linear(s->tables, s->damper, &s->options->drive);
    double best = 0.0;
    if (!interrupted() && count > 1) {
        best = find_best(s, &f, limit, count);
    } else {
        check_by_marching(s, &f.curve[0]);
    }
    plot_family(s->tables, limit, count, best);
    free_family(&f, count);
    free(limit);
}
