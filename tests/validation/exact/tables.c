/* SPDX-License-Identifier: BSD-3-Clause */
/* Loads and limits by tables in method exact: ramps on one body in closed form, and random structures beside method event. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../run.h"

enum { DOFS = 5, CONTACTS = 4, KNOTS = 40, SIZE = 2 * DOFS + CONTACTS + 1 };

/* ---------------------------------------------------------------------------------------------------------------- one body */

/* A body of mass 1, with stiffness k and damping c, and a contact that is open, under the load 1 + t/2 until t = 6. */
static void assert_ramp(double k, double c, double (*closed)(double t))
{
    const double one = 1.0, time[] = {0.0, 6.0}, value[] = {1.0, 4.0};
    tribo_system *sys = finish_model(dense_model(1, 1, &one, &c, &k, &one));
    double y[3] = {0.3, -0.2, 0.0}, t = 0.0;
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.0));
    assert_ok(tribo_system_add_load_table(sys, 2, time, value, &one));
    tribo_driver *drv = driver_create(sys, "exact", 100.0, 0.0);
    for (double end = 0.7; end < 6.0; end += 0.9) {
        driver_advance(drv, &t, end, y);
        assert_close(y[0], closed(end), 1e-13 * (1.0 + fabs(closed(end))));
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* x'' + 4 x = 1 + t/2 */
static double spring(double t)
{
    return 0.25 + t / 8.0 + (0.3 - 0.25) * cos(2.0 * t) + 0.5 * (-0.2 - 1.0 / 8.0) * sin(2.0 * t);
}

/* x'' + 2 x' + 5 x = 1 + t/2 */
static double damped(double t)
{
    const double rate = 0.1, place = (1.0 - 2.0 * rate) / 5.0, a = 0.3 - place, b = (-0.2 - rate + a) / 2.0;
    return place + rate * t + exp(-t) * (a * cos(2.0 * t) + b * sin(2.0 * t));
}

/* x'' = 1 + t/2 */
static double free_body(double t)
{
    return 0.3 - 0.2 * t + 0.5 * t * t + t * t * t / 12.0;
}

/* x'' + 2 x' = 1 + t/2 */
static double damper(double t)
{
    const double rate = 0.375, a = 0.5 * (-0.2 - rate);
    return 0.3 + rate * t + 0.125 * t * t + a * (1.0 - exp(-2.0 * t));
}

TEST(ramps)
{
    assert_ramp(4.0, 0.0, spring);
    assert_ramp(5.0, 2.0, damped);
    assert_ramp(0.0, 0.0, free_body);
    assert_ramp(0.0, 2.0, damper);
}

/* A blow of impulse 1, a triangle of width 2 dt, on a body of mass 1 without stiffness: friction 1 stops it after 1/2 - dt, however
 * far the advance goes and however short the blow is. */
TEST(blows)
{
    const double zero = 0.0, one = 1.0;
    for (double dt = 1e-3, end = 1e4; dt > 1e-9; dt *= 0.1, end = dt < 1e-7 ? 1e7 : 10.0) {
        const double time[] = {0.0, dt, 2.0 * dt}, value[] = {0.0, 1.0 / dt, 0.0};
        double y[3] = {0.0}, t = 0.0;
        tribo_system *sys = finish_model(dense_model(1, 1, &one, NULL, &zero, &one));
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), 1.0));
        assert_ok(tribo_system_add_load_table(sys, 3, time, value, &one));
        tribo_driver *drv = driver_create(sys, "exact", 100.0, 0.0);
        driver_advance(drv, &t, end, y);
        require(fabs(y[0] - 0.5) < 1.1 * dt + 1e-8, "dt = %g, until %g: %.15g", dt, end, y[0]);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}

/* A body of mass 1 that nothing but friction holds, under a load 0.2 + t: at rest until the limit 1, of t/10 more each unit of
 * time, is reached at 0.2 + t = 1 + t/10; then x'' = t - 0.8 - t/10. */
TEST(breaks_away)
{
    const double one = 1.0, none = 0.0, time[] = {0.0, 10.0}, value[] = {0.2, 10.2}, limit[] = {1.0, 2.0};
    const double begin = 0.8 / 0.9, s = 4.0 - begin;
    tribo_system *sys = finish_model(dense_model(1, 1, &one, NULL, &none, &one));
    double y[3] = {0.0}, t = 0.0;
    assert_ok(tribo_system_add_load_table(sys, 2, time, value, &one));
    assert_ok(tribo_system_set_limit_table(sys, 2, time, limit));
    tribo_driver *drv = driver_create(sys, _i ? "auto" : "exact", 100.0, 0.0);
    driver_advance(drv, &t, 4.0, y);
    assert_close(y[0], 0.9 * s * s * s / 6.0, 1e-13);
    assert_close(y[1], 0.9 * s * s / 2.0, 1e-13);
    /* the integral of (1 + t/10) 0.45 (t - begin)^2 */
    assert_close(y[2], 0.45 * ((1.0 + begin / 10.0) * s * s * s / 3.0 + s * s * s * s / 40.0), 1e-12);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* --------------------------------------------------------------------------------------------------------- random structures */

static int chance(struct random *g, double p)
{
    return uniform(g, 0.0, 1.0) < p;
}

/* Rows of J: contacts, the last of which is the normal of contact 0 if `follows`. */
struct scene {
    size_t n, contacts;
    double mass[DOFS * DOFS], damping[DOFS * DOFS], stiffness[DOFS * DOFS], direction[CONTACTS * DOFS], compliance[CONTACTS];
    int follows, limits, swings, bases;
    double start[SIZE], limit[CONTACTS];
    char name[200];
};

static struct scene scene_create(struct random *g)
{
    struct scene s = {.n = 1 + below(g, DOFS), .contacts = 1 + below(g, CONTACTS)};
    const size_t n = s.n, damping = below(g, 4);
    const int is_free = chance(g, 0.3), elastic = chance(g, 0.3), skew = chance(g, 0.15);
    s.follows = s.contacts > 1 && chance(g, 0.25);
    s.limits = chance(g, 0.5);
    s.swings = !s.follows && chance(g, 0.3);
    s.bases = chance(g, 0.5);
    for (size_t i = 0; i < n; i++) {
        s.mass[i * (n + 1)] = log_uniform(g, 0.4);
        s.stiffness[i * (n + 1)] += is_free && chance(g, 0.6) ? 0.0 : uniform(g, 0.3, 5.0);
        for (size_t j = 0; j < i; j++) {
            const double k = chance(g, 0.5) ? uniform(g, 0.0, 3.0) : 0.0;
            s.stiffness[i * n + j] -= k;
            s.stiffness[j * n + i] -= k;
            s.stiffness[i * (n + 1)] += k;
            s.stiffness[j * (n + 1)] += k;
        }
    }
    for (size_t k = 0; k < n * n && damping; k++) {
        s.damping[k] = (damping == 2 ? 0.1 : 0.01) * s.stiffness[k];
    }
    for (size_t i = 0; i < n && damping == 3; i++) {
        s.damping[i * (n + 1)] += chance(g, 0.5) ? uniform(g, 0.0, 1.0) * s.mass[i * (n + 1)] : 0.0;
    }
    s.bases = s.bases && !s.follows && !skew;
    for (size_t i = 0; skew && !is_free && i + 1 < n; i++) {
        const double part = uniform(g, -1.0, 1.0);
        s.stiffness[i * n + i + 1] += part;
        s.stiffness[(i + 1) * n + i] -= part;
    }
    for (size_t i = 0; i < s.contacts; i++) {
        s.direction[i * n + below(g, n)] = 1.0;
        const size_t b = below(g, n);
        s.direction[i * n + b] -= s.direction[i * n + b] == 0.0 && chance(g, 0.4) ? 1.0 : 0.0;
        s.limit[i] = uniform(g, 0.1, 1.0);
        s.compliance[i] = elastic && !s.limits && !s.swings && chance(g, 0.6) && !(s.follows && i + 1 == s.contacts) ? 0.4 : 0.0;
    }
    for (size_t i = 0; i < 2 * n && chance(g, 0.8); i++) {
        s.start[i] = uniform(g, -1.0, 1.0);
    }
    snprintf(s.name, sizeof s.name, "%zu dofs, %zu contacts%s%s%s%s%s%s%s", n, s.contacts, is_free ? ", free" : "",
             elastic ? ", elastic" : "", s.limits ? ", limits" : "", s.swings ? ", swing" : "", s.follows ? ", follow" : "",
             skew ? ", skew" : "", s.bases ? ", bases" : "");
    return s;
}

static tribo_system *scene_system(const struct scene *s, struct random g)
{
    tribo_system *sys = NULL;
    double time[KNOTS], value[KNOTS], limit[KNOTS * CONTACTS], pattern[DOFS], wave[2][CONTACTS] = {{0.0}};
    tribo_model *model = dense_model(s->n, s->contacts, s->mass, s->damping, s->stiffness, s->direction);
    assert_ok(tribo_model_set_compliance(model, s->compliance));
    if (s->follows) {
        assert_ok(tribo_model_set_normal(model, 0, s->contacts - 1, 0.4, 3.0, -0.3));
    }
    const int status = tribo_system_create(&sys, model);
    require(!status, "%s: %s", s->name, tribo_model_message(model));
    tribo_model_destroy(model);
    for (int table = 0; table < 2; table++) {
        const size_t knots = 1 + below(&g, KNOTS);
        for (size_t k = 0; k < knots; k++) {
            time[k] = (k ? time[k - 1] : uniform(&g, -1.0, 1.0)) + uniform(&g, 0.05, 0.6);
            value[k] = chance(&g, 0.3) && k ? value[k - 1] : uniform(&g, -2.0, 2.0);
        }
        for (size_t i = 0; i < s->n; i++) {
            pattern[i] = chance(&g, 0.7) ? uniform(&g, -1.0, 1.0) : 0.0;
        }
        assert_ok(tribo_system_add_load_table(sys, knots, time, value, pattern));
        for (size_t i = 0; i < s->contacts; i++) {
            limit[i] = chance(&g, 0.6) ? uniform(&g, -1.0, 1.0) : 0.0;
        }
        if (s->bases) {
            assert_ok(tribo_system_add_base_table(sys, knots, time, value, limit));
        }
    }
    assert_ok(tribo_system_add_load(sys, uniform(&g, 0.5, 3.0), pattern, NULL));
    for (size_t i = 0; i < s->contacts; i++) {
        const int takes = !(s->follows && (i == 0 || i + 1 == s->contacts));
        for (size_t k = 0; k < KNOTS; k++) {
            limit[k * s->contacts + i] = takes && !chance(&g, 0.15) ? uniform(&g, 0.0, 1.0) : 0.0;
        }
        wave[0][i] = takes ? uniform(&g, -0.4, 0.4) : 0.0;
        wave[1][i] = takes ? s->limit[i] : 0.0;
    }
    if (s->limits) {
        for (size_t k = 0; k < KNOTS; k++) {
            time[k] = 0.3 * (double)k + uniform(&g, 0.0, 0.2);
        }
        assert_ok(tribo_system_set_limit_table(sys, KNOTS, time, limit));
    } else {
        assert_ok(tribo_set_limit(tribo_system_context(sys), wave[1]));
    }
    if (s->swings) {
        assert_ok(tribo_system_add_limit(sys, uniform(&g, 0.5, 3.0), wave[0], NULL));
    }
    return sys;
}

TEST(agree)
{
    int taken = 0;
    for (int seed = 60 * _i; seed < 60 * (_i + 1); seed++) {
        struct random g = random_of(seed + setting("TRIBO_SEED", 0));
        const struct scene s = scene_create(&g);
        double y[2][SIZE], size = 1.0;
        int refused = 0;
        for (int k = 0; k < 2 && !refused; k++) {
            tribo_system *sys = scene_system(&s, g);
            tribo_driver *drv = NULL;
            double t = -0.4;
            memcpy(y[k], s.start, sizeof y[k]);
            assert_ok(tribo_driver_create(&drv, sys, k ? "event" : "exact"));
            const int status = tribo_driver_advance(drv, &t, 10.0, y[k]);
            refused = !k && status == TRIBO_ERR_UNSUPPORTED;
            require(!status || refused, "seed %d, %s, %s: %s", seed, s.name, k ? "event" : "exact", tribo_driver_message(drv));
            tribo_driver_destroy(drv);
            tribo_system_destroy(sys);
        }
        taken += !refused;
        for (size_t i = 0; !refused && i < SIZE; i++) {
            size = fmax(size, fabs(y[1][i]));
        }
        for (size_t i = 0; !refused && i < SIZE; i++) {
            require(fabs(y[0][i] - y[1][i]) <= 1e-10 * size, "seed %d, %s: y[%zu] = %.15g by exact, %.15g by event", seed, s.name,
                    i, y[0][i], y[1][i]);
        }
    }
    require(taken >= 50, "exact refuses %d of 60", 60 - taken);
}

TEST_MAIN("tables", {ramps, 1}, {blows, 1}, {breaks_away, 2}, {agree, setting("TRIBO_BLOCKS", 5)})
