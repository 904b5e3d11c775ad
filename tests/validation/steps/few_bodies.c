/* SPDX-License-Identifier: BSD-3-Clause */
/* Method "central/fixed" takes the steps of small systems in runs of its own: the motion is that of steps which a solver takes,
 * as it does where a contact that is open and has the row of another one in J makes R singular. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "make.h"
#include "run.h"

enum { MOST = 4, ROOM = MOST + 1, WATCHED = 1, SEVERAL = 20, ADVANCES = 3 };
enum { PLAIN, DAMPED, BELTS, TABLES, SWINGING, LIMIT_TABLE, OPEN, CHANGED, STATIC, SETTINGS };

static const double knots[] = {0.0, 3.0, 4.0, 9.0};

/* Of n bodies, c contacts and their rows of J. */
struct scene {
    size_t n, c;
    double mass[MOST * MOST], damping[MOST * MOST], stiffness[MOST * MOST], j[ROOM * MOST], limit[ROOM], load[MOST];
};

/* Rows of the kinds that J has: one body, the difference of two, or some of all. */
static void pick_row(struct random *r, size_t n, size_t i, double *row)
{
    const size_t kind = below(r, 3);
    for (size_t d = 0; d < n; d++) {
        row[d] = kind == 2 ? uniform(r, -1.0, 1.0) : 0.0;
    }
    row[i % n] = kind == 2 ? 2.0 : 1.0;
    if (kind == 1 && n > 1) {
        row[(i + 1) % n] = -1.0;
    }
}

static struct scene pick(struct random *r)
{
    struct scene s = {.n = 1 + below(r, MOST)};
    const size_t n = s.n;
    s.c = 1 + below(r, n);
    for (size_t i = 0; i < n; i++) {
        s.mass[i * n + i] = uniform(r, 0.5, 2.0);
        s.stiffness[i * n + i] = uniform(r, 1.0, 5.0);
        s.damping[i * n + i] = uniform(r, 0.0, 0.2);
        s.load[i] = uniform(r, -2.0, 2.0);
    }
    for (size_t i = 0; i + 1 < n; i++) {
        s.stiffness[i * n + i + 1] = s.stiffness[(i + 1) * n + i] = uniform(r, -0.5, 0.0);
    }
    for (size_t i = 0; i < s.c; i++) {
        pick_row(r, n, i, s.j + i * n);
        s.limit[i] = uniform(r, 0.1, 1.0);
    }
    memcpy(s.j + s.c * n, s.j, n * sizeof *s.j);
    return s;
}

/* What acts, on so many contacts, of which the last one may be that which stays open. */
static tribo_system *create(const struct scene *s, int setting, size_t c)
{
    const double value[] = {0.0, 1.0, -1.0, 0.0}, whole[] = {1.0, 1.0, 1.0, 1.0};
    double x[4 * ROOM] = {0.0};
    tribo_system *sys;
    char message[200];
    const int status = dense_system(&sys, s->n, c, s->mass, setting == DAMPED ? s->damping : NULL, s->stiffness, s->j, 0, message,
                                    sizeof message);
    require(!status, "%s", message);
    assert_ok(tribo_set_limit(tribo_system_context(sys), s->limit));
    assert_ok(tribo_system_add_load(sys, 0.9, s->load, NULL));
    assert_ok(tribo_system_add_load(sys, 2.1, NULL, s->load));
    if (setting == BELTS) {
        memcpy(x, s->limit, s->c * sizeof *x);
        assert_ok(tribo_system_add_base_motion(sys, 1.1, x, NULL));
        assert_ok(tribo_system_add_base_motion(sys, 0.0, s->limit, NULL));
    }
    if (setting == TABLES) {
        assert_ok(tribo_system_add_load_table(sys, 4, knots, value, whole));
    }
    if (setting == SWINGING) {
        memcpy(x, s->limit, s->c * sizeof *x);
        assert_ok(tribo_system_add_limit(sys, 1.3, x, NULL));
    }
    for (size_t k = 0; setting == LIMIT_TABLE && k < 4; k++) {
        for (size_t i = 0; i < s->c; i++) {
            x[k * c + i] = k == 2 ? 0.0 : (double)(k + 1) * s->limit[i];
        }
    }
    if (setting == LIMIT_TABLE) {
        assert_ok(tribo_system_set_limit_table(sys, 4, knots, x));
    }
    return sys;
}

/* Between two advances. */
static void change(tribo_system *sys, const struct scene *s, int setting)
{
    tribo_context *contacts = tribo_system_context(sys);
    double x[ROOM], ratio[ROOM];
    for (size_t i = 0; i < ROOM; i++) {
        x[i] = (i ? 2.0 : 0.0) * s->limit[i];
        ratio[i] = i < s->c ? 1.5 : 1.0;
    }
    if (setting == OPEN) {
        assert_ok(tribo_set_limit(contacts, x));
    } else if (setting == CHANGED) {
        assert_ok(tribo_set_limit(contacts, x));
        assert_ok(tribo_system_add_load(sys, 1.7, s->load, s->load));
    } else if (setting == STATIC) {
        assert_ok(tribo_set_static(contacts, ratio, NULL));
    }
}

static int seen(const tribo_moment *moment, void *data)
{
    const double *y = moment->y;
    *(double *)data += y[0] * y[0];
    return 0;
}

struct outcome {
    double y[2 * MOST + 1], sum;
    signed char slip[ROOM];
    size_t solves, steps, evaluations;
};

static struct outcome motion(const struct scene *s, int setting, size_t c, int watched)
{
    struct outcome o = {.sum = 0.0};
    double t = 0.0;
    tribo_system *sys = create(s, setting, c);
    tribo_driver *drv = driver_create(sys, "central/fixed", 0.03, 0.0);
    assert_ok(tribo_driver_set_observer(drv, watched ? seen : NULL, &o.sum));
    driver_advance(drv, &t, 0.05, o.y);
    driver_advance(drv, &t, 5.0, o.y);
    change(sys, s, setting);
    driver_advance(drv, &t, 10.0, o.y);
    assert_ok(tribo_system_get_slip(sys, o.slip));
    assert_ok(tribo_system_get_count(sys, TRIBO_COUNT_SOLVES, &o.solves));
    o.steps = driver_count(drv, TRIBO_COUNT_STEPS);
    o.evaluations = driver_count(drv, TRIBO_COUNT_EVALUATIONS);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    return o;
}

/* Of each setting some scenes; returns in how many the contacts share bodies, and runs took the steps nevertheless. */
static size_t compare(struct random *r, int setting, int watched)
{
    const struct scene s = pick(r);
    const struct outcome some = motion(&s, setting, s.c, watched), all = motion(&s, setting, s.c + 1, watched);
    assert_all_close(some.y, all.y, 2 * s.n + 1, 1e-12);
    assert_close(some.sum, all.sum, 1e-12 * (1.0 + all.sum));
    ck_assert_uint_eq(some.steps, all.steps);
    ck_assert_uint_eq(some.evaluations, all.evaluations);
    for (size_t i = 0; i < s.c; i++) {
        require(some.slip[i] == all.slip[i], "contact %zu: %d and %d", i, some.slip[i], all.slip[i]);
    }
    return all.solves > all.steps / 4 && some.solves < all.solves / 4;
}

TEST(as_solved_for)
{
    const int setting = _i / 2, watched = _i % 2;
    struct random r = random_of(_i);
    size_t taken = 0;
    for (int k = 0; k < SEVERAL; k++) {
        taken += compare(&r, setting, watched);
    }
    require(watched || setting == STATIC || taken > SEVERAL / 10, "setting %d: %zu in runs", setting, taken);
}

/* Who watches changes nothing of the places, to the last bit; velocities are brought to their time by the solver, at the end
 * of each advance if nobody watches, and it goes on from what it found last. */
TEST(watched_or_not)
{
    struct random r = random_of(1000 + _i);
    for (int k = 0; k < SEVERAL; k++) {
        const struct scene s = pick(&r);
        const struct outcome alone = motion(&s, _i, s.c, 0), watched = motion(&s, _i, s.c, WATCHED);
        const int in_runs = _i < OPEN && alone.solves <= ADVANCES;
        assert_all_close(alone.y, watched.y, 2 * s.n + 1, 1e-13);
        assert_all_close(alone.y, watched.y, in_runs ? s.n : 0, 0.0);
    }
}

/* A body on the ground or on a belt, and one on top of it, held by their contacts; the belt has a speed. */
static tribo_system *held(double speed)
{
    const double mass[] = {1.3, 0.0, 0.0, 0.7}, stiffness[] = {0.1, 0.0, 0.0, 0.1}, j[] = {1.0, 0.0, -1.0, 1.0};
    const double limit[] = {30.0, 10.0}, swing[] = {speed, 0.0}, load[] = {3.0, -1.0};
    tribo_system *sys;
    char message[200];
    require(!dense_system(&sys, 2, 2, mass, NULL, stiffness, j, 0, message, sizeof message), "%s", message);
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    assert_ok(tribo_system_add_base_motion(sys, 0.5, NULL, swing));
    assert_ok(tribo_system_add_load(sys, 1.7, load, NULL));
    return sys;
}

/* Contacts at rest move with their bases to the last bit, and not at all where these stand. */
TEST(rest_is_exact)
{
    const double speed = 0.7 * _i, nothing[5] = {0.0};
    double y[5] = {0.0}, v[2], t = 0.0;
    tribo_system *sys = held(speed);
    tribo_driver *drv = driver_create(sys, "central/fixed", 0.01, 0.0);
    for (int k = 1; k <= 50; k++) {
        driver_advance(drv, &t, 0.2 * k, y);
        assert_ok(tribo_system_contacts(sys, t, y, v, NULL, NULL));
        assert_all_exact(v, nothing, 2);
        assert_all_exact(y, nothing, speed == 0.0 ? 5 : 0);
    }
    assert_exact(y[4], 0.0);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* A motion that grows without bound ends with the last good state, whichever step of a run that is. */
TEST(grows)
{
    const double mass = 1.0, damping = -40.0 - _i, stiffness = 1.0, j = 1.0, limit = 0.1, force = 1.0;
    double y[3] = {0.0}, t = 0.0;
    tribo_system *sys;
    char message[200];
    require(!dense_system(&sys, 1, 1, &mass, &damping, &stiffness, &j, 0, message, sizeof message), "%s", message);
    assert_ok(tribo_set_limit(tribo_system_context(sys), &limit));
    assert_ok(tribo_system_add_load(sys, 1.0, &force, NULL));
    tribo_driver *drv = driver_create(sys, "central/fixed", 0.01, 0.0);
    assert_status(tribo_driver_advance(drv, &t, 1e4, y), TRIBO_ERR_NOT_FINITE);
    require(t > 1.0 && fabs(y[0]) > 1e290 && isfinite(y[0]) && isfinite(y[1]) && isfinite(y[2]), "t = %g, y = %g %g %g", t, y[0],
            y[1], y[2]);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_STEPS), (size_t)(t / 0.01 + 0.5));
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST_MAIN("few_bodies", {as_solved_for, 2 * SETTINGS}, {watched_or_not, SETTINGS}, {rest_is_exact, 2}, {grows, 8})
