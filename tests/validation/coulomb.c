/* SPDX-License-Identifier: BSD-3-Clause */
#include "make.h"
#include "coulomb.h"

#include <string.h>
#include "../set_up_driver.h"

static tribo_system *free_oscillator(void)
{
    return oscillator(TRIBO_QUINN, 0.0, 1.0);
}

static tribo_system *fig_7a(void)
{
    return oscillator(TRIBO_QUINN, 1.5, 0.5);
}

static tribo_system *fig_7b(void)
{
    return oscillator(TRIBO_QUINN, 2.0, 2.0);
}

static tribo_system *third(void)
{
    return oscillator(TRIBO_QUINN, 1.7, 0.8);
}

static tribo_system *fig_9(void)
{
    tribo_system *sys;
    assert_ok(tribo_system_chain(&sys, 32, 1.0, 0.25, 0.5));
    return sys;
}

static tribo_system *fig_11(void)
{
    tribo_system *sys;
    assert_ok(tribo_system_belt(&sys, 2.0, 0.5, 0.25, 1.0, 0.5));
    return sys;
}

/* From two event-driven integrations that agree, of order 8, with tolerances of 1e-13; the third: see reference.c. 15 - sqrt(205)
 * and -3/4 are where the free oscillator rests. */
const struct reference references[REFERENCES] = {
    {"oscillator 7a", fig_7a, {0.0, 0.0}, 49.0 * 4.0 * PI, 50.0 * 4.0 * PI, {7.18924625072}, 1},
    {"oscillator 7b", fig_7b, {0.0, 0.0}, 49.0 * PI, 50.0 * PI, {1.763834207376}, 1},
    {"oscillator 1.7, 0.8", third, {0.3, 0.0}, 19.0 * 2.5 * PI, 20.0 * 2.5 * PI, {14.5285732322338}, 1},
    {"chain", fig_9, {0.0, 0.0}, 12.0 * PI, 16.0 * PI, {0.0104949600025}, 1},
    {"belt", fig_11, {0.0, 0.0}, -1.0, 60.0, {-0.9541857100410, -0.1323742578991, -0.109011134358, -0.109011134358}, 4},
    {"free oscillator", free_oscillator, {2.75, 0.0}, -1.0, 25.0, {-0.75, 0.0, 0.5 * (2.75 * 2.75 - 0.75 * 0.75)}, 3},
    {"many turns", free_oscillator, {12.0, 6.0}, -1.0, 60.0, {0.682178936723468, 0.0}, 2},
};

tribo_driver *driver_relative(tribo_system *sys, const char *method, double dt, double abstol, double reltol)
{
    tribo_driver *drv = NULL;
    const int status = set_up_driver(&drv, sys, method, dt, abstol, reltol);
    require(status == TRIBO_OK, "%s: %s", method, tribo_system_message(sys));
    return drv;
}

double reference_error(const struct reference *r, const char *method, double dt, double tolerance, struct effort *effort)
{
    tribo_system *sys = r->create();
    const size_t n = tribo_system_ndof(sys), last = tribo_system_dimension(sys) - 1;
    /* the chain's energy is small, and its tolerance relative */
    tribo_driver *drv = driver_relative(sys, method, dt, tolerance > 0.0 ? 1e-2 * tolerance : 0.0, tolerance);
    double t = 0.0, y[MOST_STATES] = {0}, before = 0.0, error = 0.0;
    require(last < MOST_STATES, "%s has %zu states", r->name, last + 1);
    y[0] = r->start[0];
    y[n] = r->start[1];
    if (r->before >= 0.0) {
        driver_advance(drv, &t, r->before, y);
        before = y[last];
    }
    driver_advance(drv, &t, r->end, y);
    for (size_t i = 0; i < r->count; i++) {
        error = fmax(error, r->before >= 0.0 ? fabs((y[last] - before) / r->want[i] - 1.0) : fabs(y[i] - r->want[i]));
    }
    if (effort) {
        *effort = (struct effort){driver_count(drv, TRIBO_COUNT_STEPS), driver_count(drv, TRIBO_COUNT_EVALUATIONS),
                                  driver_count(drv, TRIBO_COUNT_EVENTS)};
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    return error;
}

tribo_system *block(double mass, double stiffness, double limit)
{
    const double one = 1.0;
    tribo_system *sys;
    assert_ok(dense_system(&sys, 1, 1, &mass, NULL, &stiffness, &one, 0, NULL, 0));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), limit));
    return sys;
}

int log_event(const tribo_moment *moment, void *data)
{
    const double t = moment->t, *y = moment->y;
    const int event = moment->kind != TRIBO_MOMENT_STEP;
    struct log *log = data;
    require(t >= log->last, "seen at %.17g after %.17g", t, log->last);
    log->last = t;
    log->calls++;
    if (event && log->events < MOST_SEEN) {
        log->t[log->events] = t;
        memcpy(log->y[log->events], y, (log->dimension < 8 ? log->dimension : 8) * sizeof *y);
    }
    log->events += event != 0;
    return 0;
}
