/* SPDX-License-Identifier: BSD-3-Clause */
#include "motion.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "team.h"

struct worker create_worker(const struct damper *d, int march)
{
    struct worker w = {.d = d, .march = march, .dimension = d->dimension};
    need(tribo_system_clone(d->sys, &w.sys), NULL);
    if (!d->marched) {
        need(tribo_driver_create(&w.drv, w.sys, "exact"), tribo_system_message(w.sys));
    }
    w.limit = need_memory(d->contacts, sizeof *w.limit);
    w.c = need_memory(2 * d->modes, sizeof *w.c);
    return w;
}

size_t record_of(const struct damper *d)
{
    return d->dimension + 2 * d->contacts + output_size(d) * d->options->outputs.count;
}

void free_worker(struct worker *w)
{
    tribo_driver_destroy(w->drv);
    tribo_driver_destroy(w->marcher);
    tribo_system_destroy(w->sys);
    free(w->limit);
    free(w->c);
}

void set_point(struct worker *w, double limit, double hz)
{
    const struct damper *d = w->d;
    tribo_context *contacts = tribo_system_context(w->sys);
    for (size_t c = 0; c < d->contacts; c++) {
        w->limit[c] = isnan(d->contact[c].limit) ? d->contact[c].mu * limit : d->contact[c].limit;
    }
    need(tribo_set_limit(contacts, w->limit), tribo_message(contacts));
    need(tribo_system_clear_loads(w->sys), tribo_system_message(w->sys));
    need(tribo_system_add_load(w->sys, TURN * hz, d->open.cosine, d->open.sine), tribo_system_message(w->sys));
}

tribo_driver *driver_at(struct worker *w, double limit, double hz)
{
    if (!w->drv) {
        tribo_driver_destroy(w->marcher);
        w->marcher = create_marcher(w, limit, hz);
        return w->marcher;
    }
    set_point(w, limit, hz);
    return w->drv;
}

/* ------------------------------------------------------------------------------------------------------------ measuring */

/* output [outputs][output_size]: half of the way from least to most; of each harmonic amplitude and phase. */
static int measure_outputs(struct worker *w, double *output)
{
    const struct damper *d = w->d;
    int status = TRIBO_OK;
    for (size_t k = 0; k < d->options->outputs.count && !status; k++) {
        double least = 0.0, most = 0.0, cosine = 0.0, sine = 0.0;
        memcpy(w->c, d->output_shape + k * d->modes, d->modes * sizeof *w->c);
        status = tribo_driver_period_extremes(w->drv, w->c, &least, &most, NULL, NULL);
        *output++ = 0.5 * (most - least);
        for (size_t h = 1; 2 * h < output_size(d) && !status; h++) {
            status = tribo_driver_period_harmonic(w->drv, w->c, h, &cosine, &sine);
            *output++ = hypot(cosine, sine);
            *output++ = atan2(cosine, sine) * 360.0 / TURN;
        }
    }
    return status;
}

/* Quantities of the motion just found, in closed form. The mean power of the loads is that of the first harmonic of the
 * displacements in phase with their rates; friction and damping take it. */
static int measure(struct worker *w, struct motion *m, double *power)
{
    const struct damper *d = w->d;
    double least, most, cosine[2], sine[2];
    memcpy(w->c, d->open.measured, d->modes * sizeof *w->c);
    int status = tribo_driver_period_extremes(w->drv, w->c, &least, &most, NULL, NULL);
    for (int k = 0; k < 2 && !status; k++) {
        memcpy(w->c, k ? d->open.sine : d->open.cosine, d->modes * sizeof *w->c);
        status = tribo_driver_period_harmonic(w->drv, w->c, 1, &cosine[k], &sine[k]);
    }
    status = status ? status : tribo_driver_period_dissipation(w->drv, power);
    status = status ? status : tribo_driver_period_stick(w->drv, power + d->contacts);
    status = status ? status : measure_outputs(w, power + 2 * d->contacts);
    if (status) {
        return status;
    }
    m->amplitude = 0.5 * (most - least);
    m->input = 0.5 * TURN * m->hz * (sine[0] - cosine[1]);
    for (size_t c = 0; c < d->contacts; c++) {
        power[c] *= m->hz;
        m->friction += power[c];
    }
    m->damped = m->input - m->friction;
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------- shooting */

static size_t periods_of(const struct worker *w)
{
    size_t periods = 0;
    need(tribo_driver_count(w->drv, TRIBO_COUNT_PERIODS, &periods), NULL);
    return periods;
}

static struct motion shoot(struct worker *w, double limit, double hz, double *y)
{
    struct motion m = {.limit = limit, .hz = hz};
    const size_t before = periods_of(w);
    set_point(w, limit, hz);
    int status = tribo_driver_find_periodic(w->drv, 0.0, 1.0 / hz, y);
    status = status ? status : measure(w, &m, y + w->dimension);
    m.periods = periods_of(w) - before;
    m.found = !status;
    if (status) {
        snprintf(m.message, sizeof m.message, "%s: %s", tribo_strerror(status), tribo_driver_message(w->drv));
    }
    return m;
}

struct motion find_motion(struct worker *w, double limit, double hz, const double *guess, double *y)
{
    double *state = need_memory(record_of(w->d), sizeof *state);
    if (guess) {
        memcpy(state, guess, w->dimension * sizeof *state);
    }
    struct motion m = w->march ? march(w, limit, hz, state) : shoot(w, limit, hz, state);
    if (m.found) {
        const struct scale whole = scale_of(&w->d->open, TURN * hz); /* below NOTHING of it, results are rounding */
        m.amplitude = m.amplitude < NOTHING * whole.amplitude ? 0.0 : m.amplitude;
        m.friction = fabs(m.friction) < NOTHING * fmax(10.0 * m.damped, whole.power) ? 0.0 : m.friction;
        m.damped = fabs(m.damped) < NOTHING * whole.power ? 0.0 : m.damped;
        m.input = fabs(m.input) < NOTHING * whole.power ? 0.0 : m.input;
        memcpy(y, state, record_of(w->d) * sizeof *y);
    }
    free(state);
    show_point();
    return m;
}

static void run_task(void *data, size_t k)
{
    struct task *t = (struct task *)data + k;
    struct worker w = create_worker(t->d, t->march);
    double *y = need_memory(record_of(t->d), sizeof *y);
    t->motion = find_motion(&w, t->limit, t->hz, t->guess, y);
    free(y);
    free_worker(&w);
}

void run_tasks(size_t threads, struct task *task, size_t count)
{
    run_jobs(threads, count, run_task, task);
}
