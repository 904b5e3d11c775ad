/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions that get nowhere: by guards, or steps, that no system makes. The loop over events must find out after little work. */
#include <math.h>

#include "dynamics/events/events.h"
#include "support.h"
#include "../../make.h"
#include "../../set_up_driver.h"

static const struct motion *honest;
static struct motion dishonest;
static struct events *spoilt;
static tribo_system *sys;
static tribo_driver *drv;

/* A driver of an oscillator that slides and sticks, whose phases begin by `begin`. */
static void spoil(const char *method, int (*begin)(void *own, double t, const double *y, double *reach))
{
    assert_ok(tribo_system_oscillator(&sys, 1.0, 1.5, 0.5));
    assert_ok(set_up_driver(&drv, sys, method, 0.01, 1e-10, 1e-10));
    assert_ok(drv->method->open(drv, &spoilt));
    honest = spoilt->motion;
    dishonest = *honest;
    dishonest.begin = begin;
    spoilt->motion = &dishonest;
}

static void give_back(void)
{
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Every contact that slides seems to go the other way, and to stop a moment after it began. */
static int begin_backwards(void *own, double t, const double *y, double *reach)
{
    const int status = honest->begin(own, t, y, reach);
    for (size_t k = 0; k < spoilt->search.guards; k++) {
        struct guard *g = &spoilt->search.guard[k];
        g->side = g->kind ? -g->side : g->side;
    }
    return status;
}

/* Every contact at rest seems to be at its limit before it is. */
static int begin_weak(void *own, double t, const double *y, double *reach)
{
    const int status = honest->begin(own, t, y, reach);
    for (size_t k = 0; k < spoilt->search.guards; k++) {
        struct guard *g = &spoilt->search.guard[k];
        g->offset -= g->kind ? 0.0 : 0.5;
    }
    return status;
}

static int begin_short(void *own, double t, const double *y, double *reach)
{
    const int status = honest->begin(own, t, y, reach);
    *reach = 1e-25;
    return status;
}

static const char *const methods[] = {"exact", "event"};

TEST(events_chatter)
{
    double y[3] = {0.0}, t = 0.0;
    size_t events;
    spoil(methods[_i % 2], _i < 2 ? begin_backwards : begin_weak);
    assert_status(tribo_driver_advance(drv, &t, 600.0, y), TRIBO_ERR_CHATTER);
    assert_says(tribo_driver_message(drv), "contact 0");
    assert_ok(tribo_driver_count(drv, TRIBO_COUNT_EVENTS, &events));
    require(events < 1100000, "%zu events", events);
    give_back();
}
END_TEST

TEST(steps_end)
{
    double y[3] = {0.0}, t = 0.0;
    size_t steps;
    spoil(methods[_i], begin_short);
    assert_status(tribo_driver_advance(drv, &t, 600.0, y), TRIBO_ERR_STEP);
    assert_says(tribo_driver_message(drv), "step is down to 1e-25");
    assert_ok(tribo_driver_count(drv, TRIBO_COUNT_STEPS, &steps));
    require(steps < 200000, "%zu steps", steps);
    give_back();
}
END_TEST

/* Limits whose rates overflow, and such that swing faster than anyone could follow: that is said at once. */
TEST(guards_overflow)
{
    const double fast[] = {1e150, 1e150, 1e60, 1e16}, sine[] = {_i ? 0.5 : 1e300};
    double y[3] = {_i ? 3.0 : 0.0}, t = 0.0;
    assert_ok(tribo_system_oscillator(&sys, 0.0, 1.5, 0.5));
    assert_ok(tribo_system_add_limit(sys, fast[_i], NULL, sine));
    assert_ok(set_up_driver(&drv, sys, _i ? "exact" : "event", 0.01, 1e-9, 1e-9));
    assert_status(tribo_driver_advance(drv, &t, 1.0, y), TRIBO_ERR_STEP);
    assert_says(tribo_driver_message(drv), _i ? "after 1 look" : "the step is down to 0");
    assert_exact(t, 0.0);
    give_back();
}
END_TEST

/* A structure whose motion grows e-fold 10^149 times in the time asked for, at rest. */
TEST(structure_too_fast)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {1.0, 1e300, 1e300, 1.0}, direction[] = {1.0, 0.0};
    double y[5] = {0.0}, t = 0.0;
    size_t steps;
    assert_ok(dense_system(&sys, 2, 1, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(set_up_driver(&drv, sys, methods[_i], 0.01, 1e-9, 1e-9));
    assert_status(tribo_driver_advance(drv, &t, 1.0, y), TRIBO_ERR_STEP);
    assert_says(tribo_driver_message(drv), _i ? "the step is down to 0" : "100000 such steps lead nowhere");
    assert_ok(tribo_driver_count(drv, TRIBO_COUNT_STEPS, &steps));
    require(t < 1e-100 && steps < 200000, "%zu steps to t = %g", steps, t);
    give_back();
}
END_TEST

TEST_MAIN("headway", {events_chatter, 4}, {steps_end, 2}, {guards_overflow, 4}, {structure_too_fast, 2})
