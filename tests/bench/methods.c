/* SPDX-License-Identifier: BSD-3-Clause */
/* The drivers of libtribo_gsl. */
#include "methods.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../src/damper/output.h"
#include "harness.h"
#include "../set_up_driver.h"

void outcome_fail(struct outcome *o, const char *format, ...)
{
    if (o->failure[0] == '\0') {
        va_list args;
        va_start(args, format);
        vsnprintf(o->failure, sizeof o->failure, format, args);
        va_end(args);
    }
}

void outcome_answer(struct outcome *o, const struct scene *s, const double *y, double d_at_begin)
{
    if (s->answers == 1) {
        o->answer[0] = y[2 * s->model.n] - d_at_begin;
    } else {
        memcpy(o->answer, y, s->answers * sizeof *y);
    }
    for (size_t i = 0; i < s->answers; i++) {
        if (!isfinite(o->answer[i])) {
            outcome_fail(o, "the motion is not finite");
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------ settings */

/* Velocity scale of the regularized laws where the stepper adapts. The error of Quinn's law goes with its square, that of laws
 * that creep with itself. */
static double epsilon_for(const struct scene *s, const char *law, double tolerance)
{
    const int balances = strncmp(law, "quinn", 5) == 0;
    return s->size * s->model.omega * (balances ? sqrt(tolerance) : tolerance);
}

static void set_law(const struct method *m, const struct scene *s, double setting, tribo_context *contacts)
{
    int law;
    if (tribo_law_find(m->law, &law) || law == TRIBO_COULOMB) {
        return;
    }
    need(tribo_set_law(contacts, law), NULL);
    if (m->sweep == STEP) {
        need(tribo_set_epsilon_step(contacts, setting, s->lambda_dt), NULL);
    } else {
        need(tribo_set_epsilon_all(contacts, epsilon_for(s, m->law, setting)), NULL);
    }
}

static void count(const tribo_driver *drv, struct outcome *o)
{
    tribo_driver_count(drv, TRIBO_COUNT_STEPS, &o->steps);
    tribo_driver_count(drv, TRIBO_COUNT_EVALUATIONS, &o->evaluations);
    tribo_driver_count(drv, TRIBO_COUNT_EVENTS, &o->events);
}

static void advance(tribo_driver *drv, double *t, double t1, double *y, struct outcome *o)
{
    if (o->failure[0] == '\0' && tribo_driver_advance(drv, t, t1, y)) {
        outcome_fail(o, "%s", tribo_driver_message(drv));
    }
}

static int in_time(const tribo_moment *moment, void *deadline)
{
    (void)moment;
    return cpu_seconds() > *(const double *)deadline;
}

static void run(const struct method *m, const struct scene *s, double setting, struct outcome *o)
{
    tribo_system *sys = scene_open(s);
    tribo_context *contacts = tribo_system_context(sys);
    /* steps end where the questions are */
    const double cycle = s->end - s->begin, dt = m->sweep == STEP ? cycle / ceil(cycle / setting * (1.0 - 1e-9)) : s->dt;
    const double tolerance = m->sweep == TOLERANCE ? setting : 1.0;
    const size_t dimension = tribo_system_dimension(sys);
    double *y = need_memory(dimension, sizeof *y), t = 0.0, d = 0.0;
    set_law(m, s, m->sweep == STEP ? dt : setting, contacts);
    tribo_driver *drv;
    need(set_up_driver(&drv, sys, m->name, dt, tolerance * s->size, m->sweep == TOLERANCE ? tolerance : 0.0),
         tribo_system_message(sys));
    if (o->deadline > 0.0 && m->sweep != NO_SETTING) {
        need(tribo_driver_set_observer(drv, in_time, &o->deadline), NULL);
        tribo_driver_set_output(drv, 0.01 * cycle); /* other methods show each step */
    }
    if (s->begin > 0.0) {
        advance(drv, &t, s->begin, y, o);
        d = y[dimension - 1];
    }
    advance(drv, &t, s->end, y, o);
    outcome_answer(o, s, y, d);
    count(drv, o);
    tribo_driver_destroy(drv);
    scene_close(s, sys);
    free(y);
}

/* What solves with dense matrices of the whole state. */
static int is_moderate(const struct scene *s)
{
    return s->model.n <= 32;
}

/* A decomposition of the structure for every new set of held contacts: with n = 512 a run takes 3 s. */
static int is_decomposable(const struct scene *s)
{
    return s->model.n <= 128;
}

static const struct method all[] = {
    {"tribo", "exact", "coulomb", NO_SETTING, 0.0, is_decomposable, run, 10.0, 0},
    {"tribo", "event", "coulomb", TOLERANCE, 0.0, NULL, run, 10.0, 0},
    {"tribo", "central/fixed", "coulomb", STEP, 1.95, NULL, run, 0.0, 0},
    {"tribo", "moreau/fixed", "coulomb", STEP, 0.0, NULL, run, 0.0, 0},
    {"tribo", "rk4/fixed", "quinn", STEP, 2.6, NULL, run, 0.0, 0},
    {"tribo", "rk4/fixed", "quinn-reversal", STEP, 2.6, NULL, run, 0.0, 0},
    {"tribo", "rk4/fixed", "smooth", STEP, 2.6, NULL, run, 0.0, 0},
    {"tribo", "rk4/fixed", "velocity-limited", STEP, 2.6, NULL, run, 0.0, 0},
    {"tribo", "rkf45", "quinn", TOLERANCE, 0.0, NULL, run, 0.0, 0},
    {"tribo", "rk8pd", "quinn", TOLERANCE, 0.0, NULL, run, 0.0, 0},
    {"tribo", "msbdf", "quinn", TOLERANCE, 0.0, is_moderate, run, 0.0, 0},
    {"tribo", "rk4imp", "quinn", TOLERANCE, 0.0, is_moderate, run, 0.0, 0},
    {"tribo", "rkf45", "quinn-reversal", TOLERANCE, 0.0, NULL, run, 0.0, 0},
    {"tribo", "msbdf", "quinn-reversal", TOLERANCE, 0.0, is_moderate, run, 0.0, 0},
    {"tribo", "rkf45", "smooth", TOLERANCE, 0.0, NULL, run, 0.0, 0},
    {"tribo", "msbdf", "smooth", TOLERANCE, 0.0, is_moderate, run, 0.0, 0},
    {"tribo", "rkf45", "velocity-limited", TOLERANCE, 0.0, NULL, run, 0.0, 0},
    {"tribo", "msbdf", "velocity-limited", TOLERANCE, 0.0, is_moderate, run, 0.0, 0},
};
const struct methods tribo_methods = {all, sizeof all / sizeof *all};
