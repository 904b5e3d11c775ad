#include "motion.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../common/output.h"
#include "linear.h"
#include "march.h"
#include "team.h"

enum { SAMPLES = 400 /* of a period, for what is measured of it */ };

struct worker create_worker(const struct damper *d, int march)
{
    struct worker w = {.d = d, .march = march, .dimension = 2 * d->modes + 1};
    need(tribo_system_clone(d->sys, &w.sys), NULL);
    need(tribo_driver_create(&w.drv, w.sys, "exact", 1.0, 0.0, 0.0), tribo_message(tribo_system_context(w.sys)));
    w.y = need_memory(w.dimension, sizeof *w.y);
    w.v = need_memory(d->contacts, sizeof *w.v);
    return w;
}

void free_worker(struct worker *w)
{
    tribo_driver_destroy(w->drv);
    tribo_system_destroy(w->sys);
    free(w->y);
    free(w->v);
}

void set_point(struct worker *w, double limit, double hz)
{
    const struct damper *d = w->d;
    tribo_context *contacts = tribo_system_context(w->sys);
    for (size_t c = 0; c < d->contacts; c++) {
        w->v[c] = isnan(d->limit[c]) ? d->mu[c] * limit : d->limit[c];
    }
    need(tribo_set_limit(contacts, w->v), tribo_message(contacts));
    need(tribo_system_clear_loads(w->sys), tribo_message(contacts));
    need(tribo_system_add_load(w->sys, 2.0 * acos(-1.0) * hz, NULL, d->load), tribo_message(contacts));
}

/* ------------------------------------------------------------------------------------------------------------ measuring */

/* The largest value between two samples, of the cubic that has their values and slopes; x[1], v[1] at the end. */
static double top_between(const double *x, const double *v, double h)
{
    if (!(v[0] > 0.0 && v[1] < 0.0)) {
        return fmax(x[0], x[1]);
    }
    const double a = v[0] * h, b = v[1] * h, c = 3.0 * (x[1] - x[0]), quadratic = 3.0 * (a + b) - 2.0 * c,
                 linear = 2.0 * (c - 2.0 * a - b), root = sqrt(fmax(linear * linear - 4.0 * quadratic * a, 0.0)),
                 s = 2.0 * a / (root - linear), r = 1.0 - s;
    return r * r * (1.0 + 2.0 * s) * x[0] + s * r * r * a + s * s * (3.0 - 2.0 * s) * x[1] - s * s * r * b;
}

/* Runs w->y over one period and measures it. */
static int measure(struct worker *w, double hz, struct motion *m)
{
    const struct damper *d = w->d;
    const double h = 1.0 / (hz * SAMPLES), omega = 2.0 * acos(-1.0) * hz;
    double t = 0.0, most = -HUGE_VAL, least = HUGE_VAL;
    double x[2] = {load_displacement(d, w->y)}, v[2] = {load_displacement(d, w->y + d->modes)};
    w->y[2 * d->modes] = 0.0;
    for (int i = 1; i <= SAMPLES; i++) {
        const int status = tribo_driver_advance(w->drv, &t, i * h, w->y);
        if (status) {
            return status;
        }
        x[1] = load_displacement(d, w->y);
        v[1] = load_displacement(d, w->y + d->modes);
        most = fmax(most, top_between(x, v, h));
        least = fmin(least, -top_between((const double[]){-x[0], -x[1]}, (const double[]){-v[0], -v[1]}, h));
        m->damped += damping_power(d, w->y) / SAMPLES;
        m->input += d->force * sin(omega * t) * v[1] / SAMPLES;
        x[0] = x[1];
        v[0] = v[1];
    }
    m->amplitude = 0.5 * (most - least);
    m->friction = w->y[2 * d->modes] * hz;
    return TRIBO_OK;
}

/* Rounding is nothing. */
static void take_rounding_away(const struct damper *d, struct motion *m)
{
    const struct scale whole = free_scale(d, 2.0 * acos(-1.0) * m->hz);
    m->amplitude = m->amplitude < NOTHING * whole.amplitude ? 0.0 : m->amplitude;
    m->friction = fabs(m->friction) < NOTHING * fmax(10.0 * m->damped, whole.power) ? 0.0 : m->friction;
    m->damped = fabs(m->damped) < NOTHING * whole.power ? 0.0 : m->damped;
    m->input = fabs(m->input) < NOTHING * whole.power ? 0.0 : m->input;
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
    if (!status) {
        memcpy(w->y, y, w->dimension * sizeof *y);
        status = measure(w, hz, &m);
    }
    m.periods = periods_of(w) - before;
    m.found = !status;
    if (status) {
        snprintf(m.message, sizeof m.message, "%s: %s", tribo_strerror(status), tribo_driver_message(w->drv));
    }
    return m;
}

struct motion find_motion(struct worker *w, double limit, double hz, const double *guess, double *y)
{
    double *state = need_memory(w->dimension, sizeof *state);
    if (guess) {
        memcpy(state, guess, w->dimension * sizeof *state);
    }
    struct motion m = w->march ? march(w, limit, hz, state) : shoot(w, limit, hz, state);
    if (m.found) {
        take_rounding_away(w->d, &m);
        memcpy(y, state, w->dimension * sizeof *y);
    }
    free(state);
    tell_point();
    return m;
}
