/* SPDX-License-Identifier: BSD-3-Clause */
#include "motion.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "team.h"

/* LAPACK: least squares by singular values; matrices column by column. */
void dgelss_(const int *rows, const int *cols, const int *count, double *a, const int *stride, double *b, const int *next,
             double *singular, const double *least, int *rank, double *work, const int *size, int *info);

/* The motion is run in blocks of cycles, and its transient extrapolated after each from the last KEEP + 1 of them. */
enum { BLOCK = 16, KEEP = 8, BLOCKS = 60, QUIET = 5 };
static const double TOLERANCE = 1e-6;
/* Largest drift of a steady motion in a period, of its energy norm: only friction stops modes that no stiffness holds, after many
 * periods. */
static const double DRIFT = 0.01;
static const double LEAST_STEPS = 400, MOST_STEPS = 1e5; /* a period; an amplitude is the largest of the values there */
static const double COULOMB_STEPS = 1000;                /* a period in steps of 1 */

/* The march of one motion. */
struct run {
    const struct damper *d;
    tribo_driver *drv;
    double limit, period, omega; /* of the load */
    size_t steps;                /* a period */
    struct scale free;
    double *output;  /* [outputs][d->output] of the last cycle: amplitude, then cosine and sine of each harmonic */
    double *extreme; /* [outputs][2] least and most */
};

/* ---------------------------------------------------------------------------------------------------------------- steps */

/* Steps a period. rk4 damps a mode by (omega dt)^5/144 of critical, and follows it up to omega dt = 2.8; the implicit midpoint
 * rule, of Coulomb's law, is stable with any. */
static double steps_of(const struct damper *d, double hz)
{
    const double highest = fmax(d->open.omega[d->modes - 1], TURN * hz);
    const double radians = d->law == TRIBO_COULOMB ? COULOMB_STEPS : highest / hz;
    return fmax(LEAST_STEPS, ceil(radians / d->options->step));
}

void check_steps(const struct damper *d, double hz)
{
    die_if(!(steps_of(d, hz) <= MOST_STEPS), "a period of %g Hz would take %g steps, more than %g: take a larger --step%s", hz,
           steps_of(d, hz), MOST_STEPS, d->law == TRIBO_COULOMB ? "" : ", fewer --modes, --statics off, or --law coulomb");
}

tribo_driver *create_marcher(struct worker *w, double limit, double hz)
{
    const double dt = 1.0 / (hz * steps_of(w->d, hz));
    tribo_context *contacts = tribo_system_context(w->sys);
    tribo_driver *drv;
    set_point(w, limit, hz);
    const int coulomb = w->d->law == TRIBO_COULOMB;
    if (!coulomb) { /* stuck contacts relax within a step or so, which rk4 still follows; epsilon follows each limit */
        need(tribo_set_epsilon_step(contacts, dt, 1.0), tribo_message(contacts));
    }
    need(tribo_driver_create(&drv, w->sys, coulomb ? "moreau/fixed" : "rk4/fixed"), tribo_system_message(w->sys));
    need(tribo_driver_set_step(drv, dt), tribo_driver_message(drv));
    return drv;
}

/* Adds the displacements of outputs in state y at time t to r->output; the first step clears it. */
static void sample_outputs(const struct run *r, const double *y, double t, size_t step)
{
    const struct damper *d = r->d;
    double *o = r->output;
    for (size_t k = 0; k < d->options->outputs.count; k++) {
        const double x = dot(d->output_shape + k * d->modes, y, d->modes);
        double *extreme = r->extreme + 2 * k;
        extreme[0] = step == 1 ? x : fmin(extreme[0], x);
        extreme[1] = step == 1 ? x : fmax(extreme[1], x);
        *o++ = 0.5 * (extreme[1] - extreme[0]);
        for (size_t h = 1; 2 * h < d->output; h++, o += 2) {
            o[0] = (step == 1 ? 0.0 : o[0]) + 2.0 * x * cos((double)h * r->omega * t) / (double)r->steps;
            o[1] = (step == 1 ? 0.0 : o[1]) + 2.0 * x * sin((double)h * r->omega * t) / (double)r->steps;
        }
    }
}

/* Runs y through one period and measures it. The loads are the same in every period, so that time may begin at 0 again. */
static struct motion run_cycle(const struct run *r, double *y)
{
    const struct damper *d = r->d;
    const size_t n = d->modes;
    const double *v = y + n, share = 1.0 / (double)r->steps;
    struct motion m = {.hz = 1.0 / r->period};
    double t = 0.0, least = HUGE_VAL, most = -HUGE_VAL;
    y[d->dimension - 1] = 0.0;
    for (size_t i = 1; i <= r->steps; i++) {
        need(tribo_driver_advance(r->drv, &t, r->period * (double)i / (double)r->steps, y), tribo_driver_message(r->drv));
        const double x = dot(d->open.measured, y, d->modes);
        least = fmin(least, x);
        most = fmax(most, x);
        for (size_t k = 0; k < n; k++) {
            const double *row = d->open.damping + k * n;
            m.damped += share * v[k] * (d->open.coupled ? dot(row, v, n) : row[k] * v[k]);
        }
        m.input += share * cos(r->omega * t) * dot(d->open.cosine, v, d->modes);
        m.input += share * sin(r->omega * t) * dot(d->open.sine, v, d->modes);
        sample_outputs(r, y, t, i);
    }
    m.amplitude = 0.5 * (most - least);
    m.friction = y[d->dimension - 1] / r->period;
    return m;
}

/* ----------------------------------------------------------------------------------------------------- steady motion */

/* Energy norm of the difference of two states; of a itself if b is NULL. */
static double distance(const struct damper *d, const double *a, const double *b)
{
    double sum = 0.0;
    for (size_t k = 0; k < d->modes; k++) {
        const double x = d->open.omega[k] * (a[k] - (b ? b[k] : 0.0)), v = a[d->modes + k] - (b ? b[d->modes + k] : 0.0);
        sum += x * x + v * v;
    }
    return sqrt(sum);
}

/* Returns the largest difference of states a and b in modes that no stiffness holds, times r->omega, as a velocity: these
 * displacements are not in distance(). */
static double drift(const struct run *r, const double *a, const double *b)
{
    const double *omega = r->d->open.omega;
    double most = 0.0;
    for (size_t k = 0; k < r->d->modes && omega[k] <= LOOSE * omega[r->d->modes - 1]; k++) {
        most = fmax(most, r->omega * fabs(a[k] - b[k]));
    }
    return most;
}

/* Where the sequence of states y_0 ... y_keep+1 leads to, if each is a linear function of the one before, as it is close to a
 * steady motion: reduced rank extrapolation, s = y_0 - dY (d2Y)^+ dy_0 with first and second differences (Eddy 1979, Mesina
 * 1977). Plain repetition would do too, but a mode with a damping ratio of 0.2% takes a thousand cycles. */
static void extrapolate(const struct damper *d, double *const *y, size_t keep, double *to)
{
    enum { SIZE = 3 * KEEP + 64 };
    const size_t n = d->dimension - 1;
    const double least = 1e-9;
    const int rows = (int)n, cols = (int)keep, one = 1, size = SIZE + (int)n;
    double *second = need_memory(n * keep, sizeof *second), *first = need_memory(n, sizeof *first);
    double *work = need_memory((size_t)size, sizeof *work), norm[KEEP] = {0.0}, singular[KEEP];
    int rank, info;
    for (size_t i = 0; i < n; i++) {
        const double weight = i < d->modes ? d->open.omega[i] : i < 2 * d->modes ? 1.0 : d->open.omega[0];
        first[i] = weight * (y[1][i] - y[0][i]);
        for (size_t k = 0; k < keep; k++) {
            second[k * n + i] = weight * (y[k + 2][i] - 2.0 * y[k + 1][i] + y[k][i]);
            norm[k] = hypot(norm[k], second[k * n + i]);
        }
    }
    for (size_t i = 0; i < n * keep; i++) {
        second[i] /= norm[i / n] > 0.0 ? norm[i / n] : 1.0;
    }
    dgelss_(&rows, &cols, &one, second, &rows, first, &rows, singular, &least, &rank, work, &size, &info);
    for (size_t i = 0; i < n; i++) {
        to[i] = y[0][i];
        for (size_t k = 0; k < keep && info == 0; k++) {
            to[i] -= norm[k] > 0.0 ? first[k] / norm[k] * (y[k + 1][i] - y[k][i]) : 0.0;
        }
    }
    free(second);
    free(first);
    free(work);
}

/* 1 if amplitude and dissipated power have not changed for QUIET cycles. Powers are compared with the input, since friction
 * dissipates nothing where contacts never slip. */
static int quiet(const struct scale *free, const struct motion *m)
{
    for (int k = BLOCK - QUIET; k < BLOCK; k++) {
        const double power = m[k].friction + fabs(m[k].damped);
        if (fabs(m[k].amplitude - m[k - 1].amplitude) > fmax(TOLERANCE * m[k].amplitude, NOTHING * free->amplitude) ||
            fabs(m[k].friction - m[k - 1].friction) > fmax(TOLERANCE * power, NOTHING * free->power)) {
            return 0;
        }
    }
    return 1;
}

/* Cycles from state[0] until they repeat themselves, the last one out; state[0] is then at the beginning of the next. */
static struct motion settle_motion(const struct run *r, double *const *state)
{
    const struct damper *d = r->d;
    const size_t n = d->dimension, keep = n - 1 < KEEP ? n - 1 : KEEP;
    double *ahead = state[BLOCK + 1], change = HUGE_VAL;
    struct motion m[BLOCK];
    size_t cycles = 0, pause = 0, wait = 0;
    int steady = 0;
    while (!steady && cycles < BLOCKS * BLOCK && !interrupted()) {
        for (size_t k = 0; k < BLOCK; k++) {
            memcpy(state[k + 1], state[k], n * sizeof *state[k]);
            m[k] = run_cycle(r, state[k + 1]);
        }
        const double last = distance(d, state[BLOCK], state[BLOCK - 1]), size = distance(d, state[BLOCK], NULL);
        cycles += BLOCK;
        show_march(r->limit, 1.0 / r->period, cycles, size > 0.0 ? last / size : 0.0);
        memcpy(ahead, state[BLOCK], n * sizeof *ahead);
        if (last > NOTHING * r->free.norm) {
            extrapolate(d, state + BLOCK - (keep + 1), keep, ahead);
        }
        steady = quiet(&r->free, m) && distance(d, ahead, state[BLOCK]) < fmax(TOLERANCE * size, NOTHING * r->free.norm) &&
                 drift(r, state[BLOCK], state[BLOCK - 1]) < fmax(DRIFT * size, NOTHING * r->free.norm);
        /* contacts may begin or cease to stick on the way to where the extrapolation leads: then rather wait, longer each time */
        if (wait == 0 && last > 0.5 * change) {
            pause = 2 * pause + 1;
            wait = pause;
        } else if (wait > 0) {
            wait--;
        }
        change = last;
        memcpy(state[0], wait || steady ? state[BLOCK] : ahead, n * sizeof *ahead);
    }
    m[BLOCK - 1].periods = cycles;
    m[BLOCK - 1].found = steady;
    return m[BLOCK - 1];
}

struct motion march(struct worker *w, double limit, double hz, double *y)
{
    const size_t n = w->dimension;
    double *memory = need_memory((BLOCK + 2) * n, sizeof *memory), *state[BLOCK + 2];
    for (size_t k = 0; k < BLOCK + 2; k++) {
        state[k] = memory + k * n;
    }
    memcpy(state[0], y, n * sizeof *y);
    const struct damper *d = w->d;
    struct run r = {.d = d, .limit = limit, .period = 1.0 / hz, .omega = TURN * hz, .steps = (size_t)steps_of(d, hz)};
    r.free = scale_of(&d->open, r.omega);
    r.output = need_memory(d->options->outputs.count * d->output, sizeof *r.output);
    r.extreme = need_memory(2 * d->options->outputs.count, sizeof *r.extreme);
    r.drv = create_marcher(w, limit, hz);
    struct motion m = settle_motion(&r, state);
    m.limit = limit;
    m.hz = hz;
    if (!m.found) {
        snprintf(m.message, sizeof m.message, "%s after %zu periods", interrupted() ? "interrupted" : "not steady", m.periods);
    }
    memcpy(y, state[0], n * sizeof *y);
    double *record = y + n;
    for (size_t c = 0; c < 3 * d->contacts; c++) {
        *record++ = (double)NAN;
    }
    for (size_t k = 0; k < d->output * d->options->outputs.count; k++) {
        const size_t h = k % d->output;
        const double *o = &r.output[k];
        *record++ = h == 0 ? o[0] : h % 2 ? hypot(o[0], o[1]) : atan2(o[-1], o[0]) * 360.0 / TURN;
    }
    tribo_driver_destroy(r.drv);
    free(r.output);
    free(r.extreme);
    free(memory);
    return m;
}
