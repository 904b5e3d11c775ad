/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions that contacts on belts keep up by themselves. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "study.h"
#include "team.h"

/* A multiplier of at most this size is that of a cycle which is stable. */
static const double STABLE = 1.0 + 1e-6;

/* Finds a cycle from rest, with the modes of w; y [dimension] out: state of the cycle. *largest = the largest modulus of the
 * multipliers, without the one nearest to 1, of the motion along the cycle; NaN if multipliers are not known. */
static struct motion find_cycle(struct worker *w, double limit, double guess, double *y, double *largest)
{
    const size_t n = w->dimension - 1;
    struct motion m = {.limit = limit};
    double period = guess, least = 0.0, most = 0.0, *re = need_memory(2 * n, sizeof *re), *im = re + n;
    size_t along = 0;
    set_point(w, limit, w->d->lowest);
    int status = tribo_driver_find_cycle(w->drv, 0.0, &period, y);
    memcpy(w->c, w->d->open.measured, w->d->modes * sizeof *w->c);
    status = status ? status : tribo_driver_period_extremes(w->drv, w->c, &least, &most, NULL, NULL);
    m.hz = 1.0 / period;
    m.amplitude = 0.5 * (most - least);
    set_outcome(&m, status, w);
    *largest = !status && tribo_driver_get_multipliers(w->drv, re, im) == TRIBO_OK ? 0.0 : (double)NAN;
    for (size_t k = 1; k < n; k++) {
        along = hypot(re[k] - 1.0, im[k]) < hypot(re[along] - 1.0, im[along]) ? k : along;
    }
    for (size_t k = 0; k < n && !isnan(*largest); k++) {
        *largest = k != along ? fmax(*largest, hypot(re[k], im[k])) : *largest;
    }
    free(re);
    return m;
}

/* Returns the error of cycle m: MARGIN times the larger change of period and amplitude with twice the modes; infinite if twice
 * the modes have no cycle; 0 if m was not found, or with all modes. */
static double error_of_cycle(const struct study *s, const struct motion *m)
{
    if (!m->found || s->model->whole) {
        return 0.0;
    }
    struct worker w = create_worker(&s->model->finer, 0);
    double *y = need_memory(w.dimension, sizeof *y), largest;
    const struct motion there = find_cycle(&w, s->options->limits.from, 1.0 / m->hz, y, &largest);
    const double change = fmax(relative_difference(there.hz, m->hz), relative_difference(there.amplitude, m->amplitude));
    free(y);
    free_worker(&w);
    return there.found ? MARGIN * change : HUGE_VAL;
}

/* Prints whether steady sliding of w->sys is stable, and the exponent of largest growth. */
static void report_sliding(const struct study *s, struct worker *w)
{
    double *y = need_memory(3 * w->dimension, sizeof *y), *re = y + w->dimension, *im = re + w->dimension;
    size_t count = 0;
    if (tribo_system_equilibrium(w->sys, NULL, y, NULL, &count, re, im)) {
        printf("steady sliding: not known: %s\n", tribo_system_message(w->sys));
    } else if (count > 0) {
        printf("steady sliding: %s, exponent %.8g a unit of time, at %.8g Hz\n", re[0] > 0.0 ? "unstable" : "stable", re[0],
               im[0] / TURN);
        write_result(s->tables, "sliding.growth", re[0]);
        write_result(s->tables, "sliding.frequency", im[0] / TURN);
    }
    free(y);
}

void study_cycle(struct study *s)
{
    const struct options *o = s->options;
    struct worker w = {0};
    struct motion m;
    double *y = NULL, largest, error;
    do {
        free_worker(&w);
        free(y);
        w = create_worker(s->damper, 0);
        y = need_memory(w.dimension, sizeof *y);
        m = find_cycle(&w, o->limits.from, o->cycle, y, &largest);
        error = error_of_cycle(s, &m);
    } while (take_more_modes(s->model, error));
    report_model(s->tables, s->model);
    report_sliding(s, &w);
    s->tables->motions += (size_t)m.found;
    s->gaps += (size_t)!m.found;
    if (m.found) {
        printf("cycle: period %.10g, %.8g Hz, amplitude %.8g, %s\n", 1.0 / m.hz, m.hz, m.amplitude,
               isnan(largest)      ? "multipliers not known"
               : largest <= STABLE ? "stable"
                                   : "unstable");
        write_result(s->tables, "cycle.period", 1.0 / m.hz);
        write_result(s->tables, "cycle.frequency", m.hz);
        write_result(s->tables, "cycle.amplitude", m.amplitude);
        need(tribo_driver_period_stick(w.drv, w.each), tribo_driver_message(w.drv));
        for (size_t c = 0; c < s->damper->contacts; c++) {
            printf("  contact %zu sticks for %.6g of the period\n", c + 1, w.each[c]);
            write_value(s->tables->values, w.each[c], "%s.cycle.stick%zu", s->tables->name, c + 1);
        }
        write_history(s->tables, &w, &m, y, "cycle");
    } else {
        printf("no cycle was found: %s\n", m.message);
    }
    if (m.found && !isnan(largest)) {
        printf("  a period multiplies the distance of motions beside it by %.8g\n", largest);
        write_result(s->tables, "cycle.multiplier", largest);
    }
    if (m.found && s->model->whole) {
        printf("model error: none, since all modes are there\n");
    } else if (m.found && error < HUGE_VAL) {
        printf("model error: at most %.1e of period and amplitude, by %zu modes%s\n", error, s->model->finer.kept,
               advice(s->model, error));
        write_result(s->tables, "model.error", error);
    } else if (m.found) {
        printf("model error: not known, since no cycle was found with %zu modes: this one may be of the modes kept only%s\n",
               s->model->finer.kept, advice(s->model, error));
    }
    free(y);
    free_worker(&w);
}
