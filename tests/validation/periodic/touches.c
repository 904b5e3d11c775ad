/* SPDX-License-Identifier: BSD-3-Clause */
/* Periodic motions in which an elastic contact only touches its limit: neighbouring motions slide there or do not, and one-sided
 * derivatives differ. Such a motion has no multipliers; with the slider a little nearer to the middle it has. */
#include <math.h>
#include <string.h>

#include "../run.h"

/* A body of mass 1 on a spring 1 and a damper DAMPING, under a load cos(OMEGA t), with an elastic contact. FOLLOWS: the limit is
 * mu N of a second body at rest, of spring 1, which a constant load presses on a normal. */
#define DAMPING 0.2
#define OMEGA 1.3
#define CONTACT 2.0

enum { CONSTANT, FOLLOWS, KINDS };

/* With the contact at rest and its slider at `place` the body is at CONTACT place/(1 + CONTACT) + size() cos(OMEGA t - lag()). */
static double size(void)
{
    return 1.0 / hypot(1.0 + CONTACT - OMEGA * OMEGA, DAMPING * OMEGA);
}

static double lag(void)
{
    return atan2(DAMPING * OMEGA, 1.0 + CONTACT - OMEGA * OMEGA);
}

static tribo_system *system_create(int kind, double limit)
{
    const size_t n = kind == FOLLOWS ? 2 : 1;
    const double unit[] = {1.0, 0.0, 0.0, 1.0}, damping[] = {DAMPING, 0.0, 0.0, DAMPING}, soft[] = {1.0 / CONTACT, 0.0};
    tribo_model *model = dense_model(n, n, unit, damping, unit, unit);
    assert_ok(tribo_model_set_compliance(model, soft));
    if (kind == FOLLOWS) {
        assert_ok(tribo_model_set_normal(model, 0, 1, 0.5, 3.0, 0.0));
    }
    tribo_system *sys = finish_model(model);
    if (kind == FOLLOWS) { /* N = 3 y, 4 y = load */
        assert_ok(tribo_system_add_load(sys, 0.0, (double[]){0.0, 4.0 * limit / 1.5}, NULL));
    } else {
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), limit));
    }
    assert_ok(tribo_system_add_load(sys, OMEGA, (double[]){1.0, 0.0}, NULL));
    return sys;
}

/* Sets y to the motion at t, with the slider at place. */
static void start(int kind, double t, double place, double limit, double *y)
{
    memset(y, 0, 6 * sizeof *y);
    y[0] = CONTACT * place / (1.0 + CONTACT) + size() * cos(OMEGA * t - lag());
    y[1] = limit / 1.5; /* of FOLLOWS */
    y[kind == FOLLOWS ? 2 : 1] = -OMEGA * size() * sin(OMEGA * t - lag());
    y[kind == FOLLOWS ? 4 : 2] = place;
}

/* The contact is at rest; margin: part of its limit that its force stays away from it. */
static int ask(int kind, const char *method, double t, double margin, double *re, double *im)
{
    const double limit = 1.5 * CONTACT * size(), firm = CONTACT / (1.0 + CONTACT);
    const double place = ((1.0 - margin) * limit - CONTACT * size()) / firm;
    tribo_system *sys = system_create(kind, limit);
    tribo_driver *drv = NULL;
    double y[6], z[6];
    assert_ok(tribo_driver_create(&drv, sys, method));
    start(kind, t, place, limit, y);
    assert_ok(tribo_driver_find_periodic(drv, t, 2.0 * PI / OMEGA, y));
    const int status = tribo_driver_get_multipliers(drv, re, im);
    if (status) {
        require(says(tribo_driver_message(drv), "elastic contact 0 only touches its limit"), "%s", tribo_driver_message(drv));
    }
    if (status && kind == CONSTANT) {
        const int parameter = TRIBO_PARAMETER_LOADS;
        const size_t index = 0;
        const int also = tribo_driver_period_derivatives(drv, 1, &parameter, &index, NULL, NULL, NULL, z);
        require(also == status, "derivatives: %d, multipliers: %d: %s", also, status, tribo_driver_message(drv));
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    return status;
}

static const char *const method[] = {"exact", "event", "auto"};

/* At any time of the period, also where the force is the limit as the period begins. */
TEST(touches)
{
    double re[5], im[5];
    const double trough = (lag() + PI) / OMEGA;
    for (int k = 0; k < 8; k++) {
        const double t = k ? 0.37 * k : trough;
        const int status = ask(_i % KINDS, method[_i / KINDS], t, 0.0, re, im);
        require(status == TRIBO_ERR_UNSUPPORTED, "period from %g on: status %d", t, status);
    }
}

/* With the least force more the motion has the multipliers of the structure with the contact at rest. */
TEST(stays_within)
{
    const double margins[] = {1e-5, 1e-3, 0.2}, period = 2.0 * PI / OMEGA;
    const double turn = period * sqrt(1.0 + CONTACT - 0.25 * DAMPING * DAMPING), factor = exp(-0.5 * DAMPING * period);
    for (int k = 0; k < 3; k++) {
        double re[5], im[5];
        const int kind = _i % KINDS, status = ask(kind, method[_i / KINDS], 0.3, margins[k], re, im);
        require(!status, "margin %g: status %d", margins[k], status);
        assert_close(re[0], 1.0, 1e-10);
        size_t at = 1;
        while (at < 4 && fabs(re[at] - factor * cos(turn)) > 1e-9) {
            at++;
        }
        assert_close(re[at], factor * cos(turn), 1e-9);
        assert_close(fabs(im[at]), fabs(factor * sin(turn)), 1e-9);
    }
}

static int see_stability(const tribo_curve_point *point, void *data)
{
    *(int *)data = point->stable;
    return 0;
}

/* The stability of a point of a curve is known where the contact stays within its limit. */
TEST(stability)
{
    for (int k = 0; k < 2; k++) {
        const double limit = 1.5 * CONTACT * size(), firm = CONTACT / (1.0 + CONTACT), margin = k ? 0.2 : 0.0;
        const double place = ((1.0 - margin) * limit - CONTACT * size()) / firm;
        const tribo_curve curve = {
            .size = sizeof curve, .parameter = TRIBO_PARAMETER_SWING, .most = 2.0, .step = 0.1, .points = 1};
        double y[6], period = 2.0 * PI / OMEGA;
        int stable = 7;
        tribo_system *sys = system_create(FOLLOWS, limit);
        tribo_driver *drv = NULL;
        assert_ok(tribo_driver_create(&drv, sys, method[_i]));
        start(FOLLOWS, 0.3, place, limit, y);
        const int status = tribo_driver_follow_curve(drv, &curve, 0.3, &period, y, see_stability, &stable);
        require(!status, "%s", tribo_driver_message(drv));
        ck_assert_int_eq(stable, k ? 1 : -1);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}

int main(void)
{
    const int all = KINDS * COUNT(method);
    const struct test tests[] = {{touches, all}, {stays_within, all}, {stability, COUNT(method)}};
    return run_suite("touches", tests, COUNT(tests));
}
