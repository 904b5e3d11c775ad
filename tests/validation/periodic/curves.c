/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves of periodic motions: folds, flips, grazing and ends by other codes and closed forms; nonlinear modes over the amplitude;
 * the work where motions are unique; what curves refuse. */
#include "beam.h"
#include "run.h"
#include "squeal.h"

#include <stdint.h>
#include <string.h>

/* Special points seen, and what all points have in common. */
struct curve_seen {
    tribo_driver *drv;
    size_t points, specials, stops_at;
    struct {
        int kind, stable;
        double parameter;
        size_t contact;
    } special[20];
    double last, period, zeta, gap; /* gap: least difference of the parameter between two points in a row */
    int stable, asks;               /* asks: extremes of every point */
    double most;                    /* largest q_0 of all points */
};

static int look(const tribo_curve_point *p, void *data)
{
    struct curve_seen *s = data;
    const double c[2 * BEAM_MODES] = {1.0};
    double low, high;
    ck_assert_uint_eq(p->size, sizeof *p);
    s->points++;
    const double gap = fabs(p->parameter - s->last);
    s->gap = s->points > 1 ? fmin(s->gap, gap) : HUGE_VAL;
    s->last = p->parameter;
    s->period = p->period;
    s->zeta = p->zeta;
    s->stable = p->stable;
    if (s->asks) {
        assert_ok(tribo_driver_period_extremes(s->drv, c, &low, &high, NULL, NULL));
        s->most = fmax(s->most, high);
    }
    if (p->kind != TRIBO_POINT_REGULAR && s->specials < sizeof s->special / sizeof *s->special) {
        s->special[s->specials].kind = p->kind;
        s->special[s->specials].stable = p->stable;
        s->special[s->specials].parameter = p->parameter;
        s->special[s->specials++].contact = p->contact;
    }
    return s->stops_at && s->points == s->stops_at ? 7 : 0;
}

static void assert_special(const struct curve_seen *s, size_t k, int kind, double parameter, size_t contact)
{
    require(k < s->specials, "%zu special points, and not %zu", s->specials, k + 1);
    require(s->special[k].kind == kind && s->special[k].contact == contact, "special point %zu: kind %d, contact %zu", k,
            s->special[k].kind, s->special[k].contact);
    assert_close(s->special[k].parameter, parameter, 1e-8);
}

/* x'' + damping x' + x + stop max(x - gap, 0) = load cos(omega t). */
static tribo_system *stopped(double damping, double stop, double gap, double load, double omega)
{
    const double one = 1.0, j[] = {1.0, 1.0};
    tribo_model *model = dense_model(1, 2, &one, &damping, &one, j);
    assert_ok(tribo_model_set_normal(model, 0, 1, 0.0, stop, gap));
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_system_add_load(sys, omega, &load, NULL));
    return sys;
}

static int follow(tribo_driver *drv, const tribo_curve *curve, double period, double *y, struct curve_seen *s)
{
    s->drv = drv;
    return tribo_driver_follow_curve(drv, curve, 0.0, &period, y, look, s);
}

static void end(tribo_driver *drv, tribo_system *sys)
{
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* The stop hardens the resonance, which turns back twice. Folds by Newton's method for det(D - I) = 0 on closed pieces; grazing
 * where the amplitude without the stop is the gap. Downwards the curve is the same. */
TEST(stop_folds)
{
    static const char *const methods[] = {"exact", "event"};
    tribo_system *sys = stopped(0.1, 1.5, 1.0, 0.4, _i ? 1.8 : 0.6);
    tribo_driver *drv = driver_create(sys, methods[_i % 2], 1e-3, 1e-13);
    const double one = 0.6 / (_i ? 1.8 : 0.6);
    const tribo_curve curve = {.size = sizeof curve,
                               .parameter = TRIBO_PARAMETER_FREQUENCY,
                               .least = one,
                               .most = 3.0 * one,
                               .step = _i ? -0.1 * one : 0.1};
    double y[3] = {0.0};
    struct curve_seen s = {.asks = 1};
    const int status = follow(drv, &curve, 2.0 * PI / (_i ? 1.8 : 0.6), y, &s);
    require(!status, "%s", tribo_driver_message(drv));
    ck_assert_uint_eq(s.specials, 4);
    /* of x'' + 0.1 x' + x = 0.4 cos(omega t) the amplitude is 1 at omega^2 = u: (1 - u)^2 + 0.01 u = 0.16 */
    const double mean = 1.0 - 0.005, root = sqrt(mean * mean - 0.84);
    const size_t order[2][4] = {{0, 1, 2, 3}, {3, 2, 1, 0}};
    const size_t *at = order[_i];
    assert_special(&s, at[0], TRIBO_POINT_GRAZE, sqrt(mean - root) / 0.6 * one, 1);
    assert_special(&s, at[1], TRIBO_POINT_FOLD, 1.959116208891 * one, SIZE_MAX);
    assert_special(&s, at[2], TRIBO_POINT_FOLD, 1.946569623911 * one, SIZE_MAX);
    assert_special(&s, at[3], TRIBO_POINT_GRAZE, sqrt(mean + root) / 0.6 * one, 1);
    assert_exact(s.last, _i ? one : 3.0);
    ck_assert_int_eq(s.stable, 1);
    assert_close(s.most, 3.015, 0.02);
    require(s.points < 90, "%zu points", s.points);
    end(drv, sys);
}

/* The same over the load: two folds by det(D - I) = 0; a constant load, which SWING leaves alone, moves the stop by 0.1. */
TEST(stop_loads)
{
    const double constant = _i ? 0.1 : 0.0;
    tribo_system *sys = stopped(0.1, 1.5, 1.0 + constant, 0.1, 1.17);
    tribo_driver *drv = driver_create(sys, "exact", 1e-3, 1e-13);
    const tribo_curve curve = {
        .size = sizeof curve, .parameter = _i ? TRIBO_PARAMETER_SWING : TRIBO_PARAMETER_LOADS, .most = 6.0, .step = 0.3};
    double y[3] = {0.0};
    struct curve_seen s = {0};
    assert_ok(tribo_system_add_load(sys, 0.0, &constant, NULL));
    assert_ok(follow(drv, &curve, 2.0 * PI / 1.17, y, &s));
    ck_assert_uint_eq(s.specials, 3);
    assert_special(&s, 0, TRIBO_POINT_GRAZE, hypot(1.0 - 1.17 * 1.17, 0.117) / 0.1, 1);
    assert_special(&s, 1, TRIBO_POINT_FOLD, 4.055686933997, SIZE_MAX);
    assert_special(&s, 2, TRIBO_POINT_FOLD, 3.777495581431, SIZE_MAX);
    end(drv, sys);
}

/* The cycle of squeal from a belt at speed 0.5 to one at speed 1: periods of other codes. */
TEST(squeal_speed)
{
    tribo_system *sys = squeal(0.5, 0.6, 0.1);
    tribo_driver *drv = driver_create(sys, "event", 1e-3, 1e-13);
    const tribo_curve curve = {.size = sizeof curve,
                               .motion = TRIBO_MOTION_CYCLE,
                               .parameter = TRIBO_PARAMETER_BASES,
                               .least = 1.0,
                               .most = 2.0,
                               .step = 0.1,
                               .coarse = 1};
    double y[5] = {0.17, 1.47, 0.4, 1.37, 0.0};
    struct curve_seen s = {0};
    const int status = follow(drv, &curve, 0.0, y, &s);
    require(!status, "%s", tribo_driver_message(drv));
    assert_close(s.period, 1.48153261, 1e-8);
    ck_assert_int_eq(s.stable, 1);
    end(drv, sys);
}

/* Without a gap a motion of twice the period begins and ends, by det(D + I) = 0. */
TEST(flips)
{
    tribo_system *sys = stopped(0.05, 3.0, 0.0, 1.0, 0.72);
    tribo_driver *drv = driver_create(sys, "exact", 1e-3, 1e-13);
    const tribo_curve curve = {
        .size = sizeof curve, .parameter = TRIBO_PARAMETER_FREQUENCY, .least = 1.0, .most = 1.5, .step = 0.05};
    double y[3] = {0.0};
    struct curve_seen s = {0};
    assert_ok(follow(drv, &curve, 2.0 * PI / 0.72, y, &s));
    ck_assert_uint_eq(s.specials, 2);
    assert_special(&s, 0, TRIBO_POINT_FLIP, 1.342073615431 / 1.2, SIZE_MAX);
    assert_special(&s, 1, TRIBO_POINT_FLIP, 1.513511510415 / 1.2, SIZE_MAX);
    end(drv, sys);
}

/* Two masses, of which one meets a stop: complex multipliers leave the unit circle, and come back, by another code. */
TEST(torus)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {1.7, -0.7, -0.7, 1.5}, damping[] = {0.05, 0.0, 0.0, 0.05},
                 omega = 0.65 * 2.1;
    const double j[] = {1.0, 0.0, 1.0, 0.0}, load[] = {0.2, 0.5};
    tribo_model *model = dense_model(2, 2, mass, damping, stiffness, j);
    assert_ok(tribo_model_set_normal(model, 0, 1, 0.0, 20.0, 0.2));
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_system_add_load(sys, omega, load, NULL));
    tribo_driver *drv = driver_create(sys, "exact", 1e-3, 1e-13);
    const tribo_curve curve = {
        .size = sizeof curve, .parameter = TRIBO_PARAMETER_FREQUENCY, .least = 1.0, .most = 1.15, .step = 0.05};
    double y[5] = {-0.42, -0.7, 0.02, 0.09, 0.0};
    struct curve_seen s = {0};
    assert_ok(follow(drv, &curve, 2.0 * PI / omega, y, &s));
    ck_assert_uint_eq(s.specials, 2);
    assert_special(&s, 0, TRIBO_POINT_TORUS, 2.169861617220 / 2.1, SIZE_MAX);
    assert_special(&s, 1, TRIBO_POINT_TORUS, 2.338008757868 / 2.1, SIZE_MAX);
    end(drv, sys);
}

/* A block, m = k = 1, on a belt of speed v0; limit 0.6, at rest 1; falls: velocity by which it falls, 0: at once. */
static tribo_system *block(double v0, double falls)
{
    const double one = 1.0, damping = 0.115, ratio = 1.0 / 0.6;
    tribo_system *sys = finish_model(dense_model(1, 1, &one, &damping, &one, &one));
    assert_ok(tribo_system_add_base_motion(sys, 0.0, &v0, NULL));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.6));
    assert_ok(tribo_set_static(tribo_system_context(sys), &ratio, falls > 0.0 ? &falls : NULL));
    return sys;
}

/* Stick-slip turns back where the block only just reaches the speed of the belt, and becomes the unstable cycle without stick,
 * which shrinks to the state of rest as that loses stability; over the speed of the belt and over the damping. The turn: by an
 * integration from the break-away without acceleration, to the next largest velocity. */
TEST(stick_slip)
{
    static const double turn[] = {1.3944354951658, 1.4940878426778};
    const double rest[] = {0.5 * log(0.8 / 0.115), 0.8 * exp(-2.0) / 0.115};
    tribo_system *sys = block(1.0, 0.5);
    tribo_driver *drv = driver_create(sys, "auto", 1e-3, 1e-13);
    const tribo_curve curve = {.size = sizeof curve,
                               .motion = TRIBO_MOTION_CYCLE,
                               .parameter = _i ? TRIBO_PARAMETER_DAMPING : TRIBO_PARAMETER_LOADS,
                               .most = 4.0,
                               .step = 0.05};
    double y[3] = {0.0, 1.0, 0.0};
    struct curve_seen s = {0};
    const int status = follow(drv, &curve, 0.0, y, &s);
    require(!status, "%s", tribo_driver_message(drv));
    ck_assert_uint_eq(s.specials, 2);
    assert_special(&s, 0, TRIBO_POINT_FOLD, turn[_i], 0);
    assert_special(&s, 1, TRIBO_POINT_REST, rest[_i], SIZE_MAX);
    end(drv, sys);
}

/* The limit drops at once: there is no unstable cycle, and stick-slip ends where the decaying slip only just reaches the belt. */
TEST(stick_slip_ends)
{
    tribo_system *sys = block(0.2, 0.0);
    tribo_driver *drv = driver_create(sys, "exact", 1e-3, 1e-13);
    const tribo_curve curve = {
        .size = sizeof curve, .motion = TRIBO_MOTION_CYCLE, .parameter = TRIBO_PARAMETER_LOADS, .most = 4.0, .step = 0.2};
    double y[3] = {0.0, 0.2, 0.0};
    struct curve_seen s = {0};
    assert_status(follow(drv, &curve, 0.0, y, &s), TRIBO_ERR_NO_CONVERGENCE);
    require(strstr(tribo_driver_message(drv), "the curve ends at parameter = 2.00746993") != NULL, "%s",
            tribo_driver_message(drv));
    assert_close(s.last, 2.0074699385739, 1e-8);
    ck_assert_uint_eq(s.specials, 0);
    end(drv, sys);
}

/* The mode of m = k = kt = 1, limit 0.5: without slip up to amplitude 0.5; known values at the end. */
TEST(mode)
{
    static const double most[] = {0.6, 1.0, 2.0}, omega[] = {1.3747608670481, 1.2258676901977, 1.0935981120212};
    static const double zeta[] = {0.046412663224, 0.105752880426, 0.101057277142};
    const double one = 1.0, c[] = {1.0, 0.0};
    tribo_model *model = dense_model(1, 1, &one, NULL, &one, &one);
    assert_ok(tribo_model_set_compliance(model, &one));
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.5));
    tribo_driver *drv = driver_create(sys, "exact", 1e-3, 1e-13);
    const tribo_curve curve = {.size = sizeof curve,
                               .motion = TRIBO_MOTION_MODE,
                               .parameter = TRIBO_PARAMETER_AMPLITUDE,
                               .least = 0.1,
                               .most = most[_i],
                               .step = 0.2,
                               .amplitude = 0.3,
                               .c = c};
    double y[4] = {0.0};
    struct curve_seen s = {0};
    const int status = follow(drv, &curve, 0.0, y, &s);
    require(!status, "%s", tribo_driver_message(drv));
    ck_assert_uint_eq(s.specials, 1);
    assert_special(&s, 0, TRIBO_POINT_SLIDE, 0.5, 0);
    assert_close(2.0 * PI / s.period, omega[_i], 1e-9);
    assert_close(s.zeta, zeta[_i], 1e-9);
    assert_close(y[0], most[_i], 1e-11);
    end(drv, sys);
}

/* The beam, over its limits, and over the frequency: the same motions as by searches from point to point, with no more work. */
TEST(beam)
{
    double y[BEAM_STATES] = {0}, z[BEAM_STATES] = {0}, omega[BEAM_MODES];
    tribo_system *sys = beam_with_contacts(0.01);
    assert_ok(tribo_system_get_frequencies(sys, omega));
    const double first = _i ? 0.98 * omega[0] : omega[0], period = 2.0 * PI / first;
    beam_add_load(sys, first);
    tribo_driver *drv = driver_create(sys, "exact", period, 0.0);
    const tribo_curve curve = {.size = sizeof curve,
                               .parameter = _i ? TRIBO_PARAMETER_FREQUENCY : TRIBO_PARAMETER_LIMITS,
                               .least = 1.0,
                               .most = _i ? 1.05 : 3.0,
                               .step = _i ? 0.002 : 0.1,
                               .coarse = 1};
    struct curve_seen s = {0};
    const int status = follow(drv, &curve, period, y, &s);
    require(!status, "%s", tribo_driver_message(drv));
    const size_t work = driver_count(drv, TRIBO_COUNT_PERIODS);
    tribo_driver_destroy(drv);
    tribo_system *other = beam_with_contacts(0.01);
    tribo_driver *stepping = driver_create(other, "exact", period, 0.0);
    size_t steps = 0;
    for (double p = 1.0; p < curve.most + 0.5 * curve.step; p += curve.step, steps++) {
        const double w = _i ? p * first : first;
        assert_ok(tribo_system_clear_loads(other));
        beam_add_load(other, w);
        assert_ok(tribo_set_limit_all(tribo_system_context(other), _i ? 0.01 : 0.01 * p));
        assert_ok(tribo_driver_find_periodic(stepping, 0.0, 2.0 * PI / w, z));
    }
    const size_t stepped = driver_count(stepping, TRIBO_COUNT_PERIODS);
    for (size_t k = 0; k < 2 * BEAM_MODES; k++) {
        assert_close(y[k], z[k], 1e-9 * fmax(1.0, fabs(z[k])));
    }
    require((double)work / (double)s.points <= (double)stepped / (double)steps, "%zu periods for %zu points, %zu for %zu steps",
            work, s.points, stepped, steps);
    end(stepping, other);
    tribo_system_destroy(sys);
}

/* Two masses, reduced to one mode and the compliance of the contact, which the load bends: driven by loads and a base at a
 * frequency, loads and the velocity of the base times these factors. */
static tribo_system *bent(double omega, double loads, double bases)
{
    const double mass[] = {1.0, 0.0, 0.0, 2.0}, stiffness[] = {3.0, -2.0, -2.0, 2.0}, j[] = {0.0, 1.0};
    const double load[] = {0.2 * loads, 0.7 * loads}, base = 0.3 * bases;
    tribo_system *sys;
    tribo_model *model = dense_model(2, 1, mass, NULL, stiffness, j);
    assert_ok(tribo_system_reduce(&sys, model, 1, TRIBO_STATICS_COMPLIANCE));
    tribo_model_destroy(model);
    assert_ok(tribo_system_set_damping_ratio(sys, 0.05));
    assert_ok(tribo_system_add_load(sys, omega, load, NULL));
    assert_ok(tribo_system_add_base_motion(sys, omega, &base, NULL));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.3));
    return sys;
}

/* The last point of a curve over what drives the contact is the motion of a system made with that. */
TEST(drives)
{
    static const int parameter[] = {TRIBO_PARAMETER_LOADS, TRIBO_PARAMETER_SWING, TRIBO_PARAMETER_BASES,
                                    TRIBO_PARAMETER_FREQUENCY};
    static const double loads[] = {1.4, 1.4, 1.0, 1.0}, bases[] = {1.4, 1.4, 1.4, 1.4}, pace[] = {1.0, 1.0, 1.0, 1.4};
    const tribo_curve curve = {.size = sizeof curve, .parameter = parameter[_i], .least = 1.0, .most = 1.4, .step = 0.2};
    double y[2][8] = {{0.0}}, period = 2.0 * PI / 1.3;
    struct curve_seen s = {0};
    for (int k = 0; k < 2; k++) {
        tribo_system *sys = k ? bent(1.3 * pace[_i], loads[_i], bases[_i]) : bent(1.3, 1.0, 1.0);
        tribo_driver *drv = driver_create(sys, "exact", 1e-3, 1e-13);
        const int status =
            k ? tribo_driver_find_periodic(drv, 0.0, period / pace[_i], y[k]) : follow(drv, &curve, period, y[k], &s);
        require(!status, "%s", tribo_driver_message(drv));
        end(drv, sys);
    }
    assert_exact(s.last, 1.4);
    assert_all_close(y[0], y[1], 4, 1e-10);
}

/* The observer ends a curve, which keeps its last point; what curves refuse. */
TEST(refuses)
{
    tribo_system *sys = stopped(0.1, 1.5, 1.0, 0.4, 0.6);
    tribo_driver *drv = driver_create(sys, "exact", 1e-3, 1e-13);
    const tribo_curve good = {
        .size = sizeof good, .parameter = TRIBO_PARAMETER_FREQUENCY, .least = 0.5, .most = 3.0, .step = 0.1};
    double y[3] = {0.0}, period = 2.0 * PI / 0.6, same;
    struct curve_seen s = {.stops_at = 3};
    assert_status(follow(drv, &good, period, y, &s), TRIBO_ERR_STOPPED);
    ck_assert_uint_eq(s.points, 3);
    require(strstr(tribo_driver_message(drv), "the observer answered 7") != NULL, "%s", tribo_driver_message(drv));
    const struct {
        tribo_curve curve;
        double period;
        int status;
        const char *says;
    } cases[] = {
        {{.size = 3, .parameter = 2, .least = 0.5, .most = 3.0, .step = 0.1}, period, TRIBO_ERR_SIZE, "curve->size"},
        {{.size = sizeof good, .parameter = 2, .least = 1e308, .most = 1.5e308, .step = 0.1},
         period,
         TRIBO_ERR_NOT_FINITE,
         "most = 1.5e+308 is too large"},
        {{.size = sizeof good, .parameter = 2, .least = 0.5, .most = 3.0, .step = 0.1},
         NAN,
         TRIBO_ERR_NOT_FINITE,
         "period = nan is not finite"},
        {{.size = sizeof good, .parameter = 2, .least = NAN, .most = 3.0, .step = 0.1},
         period,
         TRIBO_ERR_NOT_FINITE,
         "least = nan is not finite"},
        {{.size = sizeof good, .parameter = 2, .least = 0.5, .most = 3.0, .step = HUGE_VAL},
         period,
         TRIBO_ERR_NOT_FINITE,
         "step = inf is not finite"},
        {{.size = sizeof good, .parameter = 8, .least = 0.5, .most = 3.0, .step = 0.1},
         period,
         TRIBO_ERR_RANGE,
         "parameter = 8 is no"},
        {{.size = sizeof good, .motion = 3, .parameter = 2, .least = 0.5, .most = 3.0, .step = 0.1},
         period,
         TRIBO_ERR_RANGE,
         "motion = 3 is no"},
        {{.size = sizeof good, .parameter = 2, .least = 1.5, .most = 3.0, .step = 0.1},
         period,
         TRIBO_ERR_RANGE,
         "the parameter of the system, 1, is outside"},
        {{.size = sizeof good, .parameter = 0, .index = 2, .most = 3.0, .step = 0.1},
         period,
         TRIBO_ERR_RANGE,
         "there is no contact 2"},
        {{.size = sizeof good, .parameter = 0, .index = 0, .most = 3.0, .step = 0.1},
         period,
         TRIBO_ERR_UNSUPPORTED,
         "the limit of contact 0 follows the motion"},
        {{.size = sizeof good, .parameter = 5, .least = 0.5, .most = 3.0, .step = 0.1},
         period,
         TRIBO_ERR_UNSUPPORTED,
         "modes are followed over their amplitude"},
        {{.size = sizeof good, .motion = 1, .parameter = 2, .least = 0.5, .most = 3.0, .step = 0.1},
         0.0,
         TRIBO_ERR_UNSUPPORTED,
         "cycles have no frequency"},
        {{.size = sizeof good, .motion = 1, .parameter = 1, .least = 0.5, .most = 3.0, .step = 0.1},
         0.0,
         TRIBO_ERR_UNSUPPORTED,
         "load[0]"},
        {{.size = sizeof good, .motion = 2, .parameter = 5, .least = 0.5, .most = 3.0, .step = 0.1},
         0.0,
         TRIBO_ERR_NULL,
         "curve->c is NULL"},
        {{.size = sizeof good, .parameter = 2, .least = 0.0, .most = 3.0, .step = 0.1},
         period,
         TRIBO_ERR_NOT_POSITIVE,
         "least = 0 is not positive"},
        {{.size = sizeof good, .parameter = 1, .least = -1.0, .most = 3.0, .step = 0.1},
         period,
         TRIBO_ERR_NOT_POSITIVE,
         "least = -1 is negative"},
        {{.size = sizeof good, .parameter = 2, .least = 0.5, .most = 3.0}, period, TRIBO_ERR_NOT_POSITIVE, "step is 0"},
        {{.size = sizeof good, .parameter = 2, .least = 0.5, .most = 3.0, .step = 0.1}, 3.0, TRIBO_ERR_RANGE, "load[0]"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const double before[] = {y[0], y[1], y[2]};
        same = cases[k].period;
        const int status = tribo_driver_follow_curve(drv, &cases[k].curve, 0.0, &same, y, NULL, NULL);
        require(status == cases[k].status, "case %zu: %d, %s", k, status, tribo_driver_message(drv));
        assert_says(tribo_driver_message(drv), cases[k].says);
        ck_assert_int_eq(memcmp(&same, &cases[k].period, sizeof same), 0);
        ck_assert_int_eq(memcmp(before, y, sizeof before), 0);
    }
    assert_status(tribo_driver_follow_curve(NULL, &good, 0.0, &period, y, NULL, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_driver_follow_curve(drv, NULL, 0.0, &period, y, NULL, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_driver_follow_curve(drv, &good, 0.0, NULL, y, NULL, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_driver_follow_curve(drv, &good, 0.0, &period, NULL, NULL, NULL), TRIBO_ERR_NULL);
    end(drv, sys);
    const tribo_curve limits = {
        .size = sizeof limits, .motion = TRIBO_MOTION_CYCLE, .parameter = TRIBO_PARAMETER_LIMITS, .most = 2.0, .step = 0.1};
    double x[5] = {0.0};
    sys = squeal(0.5, 0.6, 0.1);
    drv = driver_create(sys, "event", 1e-3, 1e-13);
    assert_status(follow(drv, &limits, 0.0, x, &s), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(drv), "the limit of contact 0 follows the motion");
    end(drv, sys);
}

/* A range of whole steps, also to rounding: the last point is at the bound, once. */
TEST(whole_steps)
{
    for (int steps = 1; steps < 9; steps++) {
        const double one = 1.0, damping = 0.2, load = 1.0, step = _i ? -0.1 : 0.1, last = 1.0 + steps * step;
        tribo_system *sys = finish_model(dense_model(1, 1, &one, &damping, &one, &one));
        assert_ok(tribo_system_add_load(sys, 0.6, &load, NULL));
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.1));
        tribo_driver *drv = driver_create(sys, "exact", 1e-3, 1e-13);
        const tribo_curve curve = {.size = sizeof curve,
                                   .parameter = TRIBO_PARAMETER_LIMITS,
                                   .least = fmin(1.0, last),
                                   .most = fmax(1.0, last),
                                   .step = step};
        double y[3] = {0.0};
        struct curve_seen s = {0};
        assert_ok(follow(drv, &curve, 2.0 * PI / 0.6, y, &s));
        assert_exact(s.last, last);
        require(s.gap > 1e-6, "%d steps: two points are %g from each other", steps, s.gap);
        end(drv, sys);
    }
}

TEST_MAIN("curves", {stop_folds, 2}, {stop_loads, 2}, {squeal_speed, 1}, {flips, 1}, {torus, 1}, {stick_slip, 2},
          {stick_slip_ends, 1}, {mode, 3}, {beam, 2}, {drives, 4}, {refuses, 1}, {whole_steps, 2})
