/* SPDX-License-Identifier: BSD-3-Clause */
#include "motion.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "team.h"

static void open_driver(struct worker *w)
{
    if (!w->d->marched) {
        need(tribo_driver_create(&w->drv, w->sys, "auto"), tribo_system_message(w->sys));
    }
}

struct worker create_worker(const struct damper *d, int march)
{
    struct worker w = {.d = d, .march = march, .at = d->options->limits.from, .dimension = d->dimension};
    need(tribo_system_clone(d->sys, &w.sys), NULL);
    open_driver(&w);
    w.limit = need_memory(d->rows, sizeof *w.limit);
    w.each = need_memory(d->rows, sizeof *w.each);
    w.c = need_memory(2 * d->modes, sizeof *w.c);
    return w;
}

void free_worker(struct worker *w)
{
    tribo_driver_destroy(w->drv);
    tribo_driver_destroy(w->marcher);
    tribo_system_destroy(w->sys);
    free(w->limit);
    free(w->each);
    free(w->c);
}

void set_point(struct worker *w, double limit, double hz)
{
    const struct damper *d = w->d;
    const int follows = d->rows > d->contacts;
    if (follows && w->at != limit) { /* gaps of normal directions belong to the structure */
        tribo_driver_destroy(w->drv);
        tribo_system_destroy(w->sys);
        w->sys = create_system(d, limit);
        open_driver(w);
        w->at = limit;
    }
    tribo_context *contacts = tribo_system_context(w->sys);
    for (size_t c = 0; c < d->contacts; c++) {
        const double own = d->contact[c].limit;
        w->limit[c] = d->contact[c].normal.direction ? 0.0 : isnan(own) ? d->contact[c].mu * limit : own;
    }
    need(tribo_set_limit(contacts, w->limit), tribo_message(contacts));
    need(tribo_system_clear_loads(w->sys), tribo_system_message(w->sys));
    need(tribo_system_add_load(w->sys, TURN * hz, d->open.cosine, d->open.sine), tribo_system_message(w->sys));
    /* a constant load holds the loads of normal directions at rest */
    memset(w->c, 0, d->modes * sizeof *w->c);
    for (size_t k = d->contacts * d->modes; k < d->rows * d->modes; k++) {
        w->c[k % d->modes] += rest_load(&d->contact[k / d->modes], limit) * d->contact_shape[k];
    }
    need(follows ? tribo_system_add_load(w->sys, 0.0, w->c, NULL) : TRIBO_OK, tribo_system_message(w->sys));
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

/* output [outputs][d->output]: half of the way from least to most; of each harmonic amplitude and phase. */
static int measure_outputs(struct worker *w, double *output)
{
    const struct damper *d = w->d;
    int status = TRIBO_OK;
    for (size_t k = 0; k < d->options->outputs.count && !status; k++) {
        double least = 0.0, most = 0.0, cosine = 0.0, sine = 0.0;
        memcpy(w->c, d->output_shape + k * d->modes, d->modes * sizeof *w->c);
        status = tribo_driver_period_extremes(w->drv, w->c, &least, &most, NULL, NULL);
        *output++ = 0.5 * (most - least);
        for (size_t h = 1; 2 * h < d->output && !status; h++) {
            status = tribo_driver_period_harmonic(w->drv, w->c, h, &cosine, &sine);
            *output++ = hypot(cosine, sine);
            *output++ = atan2(cosine, sine) * 360.0 / TURN;
        }
    }
    return status;
}

/* Times of lift-off and touch-down of the contacts in a period. */
struct opening {
    size_t contacts;
    double *since; /* [contacts] of lift-off; NaN: pressed */
    double *open;  /* [contacts] time open so far */
};

static int see_opening(const tribo_moment *moment, void *data)
{
    struct opening *o = data;
    const size_t c = moment->contact;
    if (c < o->contacts && moment->kind == TRIBO_MOMENT_LIFT) {
        o->since[c] = moment->t;
    } else if (c < o->contacts && moment->kind == TRIBO_MOMENT_TOUCH) {
        o->open[c] += moment->t - (isnan(o->since[c]) ? 0.0 : o->since[c]);
        o->since[c] = (double)NAN;
    }
    return 0;
}

int measure_openings(struct worker *w, double hz, double *y)
{
    const struct damper *d = w->d;
    const size_t n = d->dimension;
    double *open = y + n + 2 * d->contacts, *state = need_memory(n + d->rows, sizeof *state), *f = state + n, now = 0.0;
    struct opening o = {d->contacts, w->each, open};
    signed char *slip = need_memory(d->rows, sizeof *slip);
    memcpy(state, y, n * sizeof *state);
    int status = tribo_system_contacts(w->sys, 0.0, y, NULL, NULL, f);
    status = status ? status : tribo_system_get_slip(w->sys, slip);
    for (size_t c = 0; c < d->contacts; c++) {
        const int is_open = d->contact[c].normal.direction && slip[c] == TRIBO_SLIP_OPEN;
        o.since[c] = is_open ? 0.0 : (double)NAN;
        open[c] = 0.0;
    }
    status = status ? status : tribo_driver_set_observer(w->drv, see_opening, &o);
    status = status ? status : tribo_driver_advance(w->drv, &now, 1.0 / hz, state);
    need(tribo_driver_set_observer(w->drv, NULL, NULL), NULL);
    for (size_t c = 0; c < d->contacts; c++) {
        open[c] = fmin(hz * (open[c] + (isnan(o.since[c]) ? 0.0 : 1.0 / hz - o.since[c])), 1.0);
    }
    free(state);
    free(slip);
    return status;
}

/* Sets m->message if the motion that w->drv found last has a multiplier outside of the unit circle. */
static void note_instability(struct worker *w, struct motion *m)
{
    double *re = need_memory(2 * w->dimension, sizeof *re), *im = re + w->dimension;
    if (tribo_driver_get_multipliers(w->drv, re, im) == TRIBO_OK && hypot(re[0], im[0]) > 1.0 + 1e-6) {
        snprintf(m->message, sizeof m->message, "unstable: motions beside it leave it by a factor of %.4g a period",
                 hypot(re[0], im[0]));
    }
    free(re);
}

void set_outcome(struct motion *m, int status, const struct worker *w)
{
    m->found = !status;
    if (status) {
        snprintf(m->message, sizeof m->message, "%s: %s", tribo_strerror(status), tribo_driver_message(w->drv));
    }
}

/* In closed form. Harmonic loads do work on the first harmonic of the displacements only. The power of damping is the input less
 * that of friction. */
int measure_motion(struct worker *w, struct motion *m, double *y)
{
    const struct damper *d = w->d;
    double *power = y + d->dimension, least, most, cosine[2], sine[2];
    memcpy(w->c, d->open.measured, d->modes * sizeof *w->c);
    int status = tribo_driver_period_extremes(w->drv, w->c, &least, &most, NULL, NULL);
    for (int k = 0; k < 2 && !status; k++) {
        memcpy(w->c, k ? d->open.sine : d->open.cosine, d->modes * sizeof *w->c);
        status = tribo_driver_period_harmonic(w->drv, w->c, 1, &cosine[k], &sine[k]);
    }
    status = status ? status : tribo_driver_period_dissipation(w->drv, w->each);
    memcpy(power, w->each, d->contacts * sizeof *power);
    status = status ? status : tribo_driver_period_stick(w->drv, w->each);
    memcpy(power + d->contacts, w->each, d->contacts * sizeof *power);
    status = status ? status : measure_outputs(w, power + 3 * d->contacts);
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
    set_point(w, limit, hz); /* may open another driver, which counts anew */
    const size_t before = periods_of(w);
    int status = tribo_driver_find_periodic(w->drv, 0.0, 1.0 / hz, y);
    status = status ? status : measure_motion(w, &m, y);
    if (!status && w->d->rows > w->d->contacts) { /* loads of normal directions follow the motion */
        note_instability(w, &m);
        status = measure_openings(w, hz, y);
    }
    m.periods = periods_of(w) - before;
    set_outcome(&m, status, w);
    return m;
}

struct motion find_motion(struct worker *w, double limit, double hz, const double *guess, double *y)
{
    double *state = need_memory(w->d->record, sizeof *state);
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
        memcpy(y, state, w->d->record * sizeof *y);
    }
    free(state);
    show_point();
    return m;
}

static void run_task(void *data, size_t k)
{
    struct task *t = (struct task *)data + k;
    struct worker w = create_worker(t->d, t->march);
    double *y = need_memory(t->d->record, sizeof *y);
    t->motion = find_motion(&w, t->limit, t->hz, t->guess, y);
    free(y);
    free_worker(&w);
}

void run_tasks(size_t threads, struct task *task, size_t count)
{
    run_jobs(threads, count, run_task, task);
}
