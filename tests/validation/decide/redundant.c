/* SPDX-License-Identifier: BSD-3-Clause */
/* Static limits of contacts that tie each other: all hold as long as any forces within their limits do, and not a moment longer.
 * Which contacts break away then, and what motion follows, is the same by all methods. */
#include <string.h>

#include "make.h"
#include "run.h"
#include "../../set_up_driver.h"

#define BODIES 3
#define CONTACTS 6
#define SCENES 100

/* Bodies on springs of their own, pulled ever harder from rest; contacts with the ground and each other, more than bodies, so
 * that some are redundant. */
struct scene {
    size_t bodies, contacts;
    double mass[BODIES * BODIES], stiffness[BODIES * BODIES], direction[CONTACTS * BODIES], limit[CONTACTS], ratio[CONTACTS];
    double pull[BODIES], omega;
};

/* Contact i < bodies is of body i, with one before or the ground. */
static void connect(struct scene *s, struct random *g, size_t i)
{
    const size_t own = i < s->bodies ? i : below(g, s->bodies), other = i < s->bodies ? below(g, i + 1) : below(g, s->bodies + 1);
    s->direction[i * s->bodies + own] = 1.0;
    if (other < s->bodies && other != own) {
        s->direction[i * s->bodies + other] = -1.0;
    }
}

static struct scene random_scene(struct random *g)
{
    struct scene s = {.omega = uniform(g, 0.3, 1.5)};
    const int alike = below(g, 3) == 0;
    s.bodies = 1 + below(g, BODIES);
    s.contacts = s.bodies + 1 + below(g, CONTACTS - s.bodies);
    for (size_t b = 0; b < s.bodies; b++) {
        s.mass[b * s.bodies + b] = alike ? 1.0 : uniform(g, 0.5, 2.0);
        s.stiffness[b * s.bodies + b] = alike ? 1.0 : uniform(g, 0.5, 2.0);
        s.pull[b] = uniform(g, -2.0, 2.0);
    }
    for (size_t i = 0; i < s.contacts; i++) {
        connect(&s, g, i);
        s.limit[i] = alike ? 0.5 : uniform(g, 0.1, 1.0);
        s.ratio[i] = alike ? 1.5 : uniform(g, 1.0, 2.0);
    }
    return s;
}

static tribo_system *system_of(const struct scene *s)
{
    tribo_system *sys;
    assert_ok(dense_system(&sys, s->bodies, s->contacts, s->mass, NULL, s->stiffness, s->direction, 0, NULL, 0));
    assert_ok(tribo_set_limit(tribo_system_context(sys), s->limit));
    assert_ok(tribo_set_static(tribo_system_context(sys), s->ratio, NULL));
    assert_ok(tribo_system_add_load(sys, s->omega, NULL, s->pull));
    return sys;
}

/* c = J x/mass. */
static void at_contacts(const struct scene *s, const double *x, int of_force, double *c)
{
    for (size_t i = 0; i < s->contacts; i++) {
        c[i] = 0.0;
        for (size_t b = 0; b < s->bodies; b++) {
            c[i] += s->direction[i * s->bodies + b] * x[b] / (of_force ? s->mass[b * s->bodies + b] : 1.0);
        }
    }
}

/* Whether any forces within static limits hold all contacts under so many times the pull: the best forces leave no
 * acceleration. */
static int can_hold(const struct scene *s, tribo_context *box, double times)
{
    double a[CONTACTS], lower[CONTACTS], upper[CONTACTS], f[CONTACTS];
    struct scene pulled = *s;
    for (size_t b = 0; b < s->bodies; b++) {
        pulled.pull[b] *= times;
    }
    at_contacts(s, pulled.pull, 1, a);
    for (size_t i = 0; i < s->contacts; i++) {
        upper[i] = s->ratio[i] * s->limit[i];
        lower[i] = -upper[i];
    }
    assert_ok(tribo_solve_box(box, a, lower, upper, f));
    for (size_t i = 0; i < s->contacts; i++) {
        for (size_t b = 0; b < s->bodies; b++) {
            pulled.pull[b] += s->direction[i * s->bodies + b] * f[i];
        }
    }
    at_contacts(s, pulled.pull, 1, a);
    double most = 0.0;
    for (size_t i = 0; i < s->contacts; i++) {
        most = fmax(most, fabs(a[i]));
    }
    return most < 1e-9;
}

/* When all contacts begin to move; HUGE_VAL if they do not, or only just, before loads turn back. */
static double breaks_away_at(const struct scene *s, tribo_system *sys)
{
    tribo_context *box;
    double low = 0.0, high = 0.97;
    assert_ok(tribo_clone(tribo_system_context(sys), &box));
    const int breaks = !can_hold(s, box, high);
    for (int k = 0; breaks && k < 50; k++) {
        const double middle = 0.5 * (low + high);
        *(can_hold(s, box, middle) ? &low : &high) = middle;
    }
    tribo_destroy(box);
    return breaks ? asin(high) / s->omega : HUGE_VAL;
}

static double moved(const struct scene *s, const double *q)
{
    double c[CONTACTS], most = 0.0;
    at_contacts(s, q, 0, c);
    for (size_t i = 0; i < s->contacts; i++) {
        most = fmax(most, fabs(c[i]));
    }
    return most;
}

/* Looks just before and after contacts break away, and returns the state a while later. */
static void go(const struct scene *s, tribo_system *sys, const char *method, double when, double *y)
{
    const int located = method[0] == 'e';
    tribo_driver *drv = driver_create(sys, method, located ? 0.1 : 2e-4, located ? 1e-11 : 0.0);
    double t = 0.0;
    driver_advance(drv, &t, when - 1e-4, y);
    require(!located || moved(s, y) < 1e-9, "%s moves %g before %.9g", method, moved(s, y), when);
    driver_advance(drv, &t, when + 0.1, y);
    require(moved(s, y) > 1e-7, "%s has moved but %g at %.9g", method, moved(s, y), t);
    driver_advance(drv, &t, when + 0.6, y);
    tribo_driver_destroy(drv);
}

/* "exact" beside another method. */
static void compare(int seed, const char *method, double tolerance)
{
    struct random g = random_of(seed);
    size_t breaks = 0;
    for (int k = 0; k < SCENES; k++) {
        const struct scene s = random_scene(&g);
        tribo_system *sys = system_of(&s);
        double y[2][2 * BODIES + 1] = {{0.0}};
        const double when = breaks_away_at(&s, sys);
        if (when < HUGE_VAL) {
            go(&s, sys, "exact", when, y[0]);
            go(&s, sys, method, when, y[1]);
            const char *off = differences(method, y[1], y[0], 2 * s.bodies + 1, tolerance);
            require(!off, "scene %d: %s", k, off);
            breaks++;
        }
        tribo_system_destroy(sys);
    }
    ck_assert_uint_gt(breaks, SCENES / 5);
}

TEST(hold_as_long_as_they_can)
{
    compare(_i, "event", 1e-8);
}

/* Contacts that slide carry no static limit to those that rest beside them. */
TEST(steps_agree)
{
    compare(_i, _i % 2 ? "central/fixed" : "moreau/fixed", 3e-3);
}

/* One body between the ground and a base that swings, which is contact `swings` of the two: its state at begin + 15. */
static void between_ground_and_base(const char *method, double begin, size_t swings, double *y)
{
    const double one = 1.0, direction[] = {-1.0, -1.0}, ratio[] = {1.5, 1.5}, start[] = {0.676787, 0.357586, 0.0};
    double cosine[2] = {0.0}, t = begin;
    tribo_system *sys;
    tribo_driver *drv;
    cosine[swings] = -0.5;
    assert_ok(dense_system(&sys, 1, 2, &one, NULL, &one, direction, 0, NULL, 0));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.5));
    assert_ok(tribo_set_static(tribo_system_context(sys), ratio, NULL));
    assert_ok(tribo_system_add_base_motion(sys, 0.5, cosine, NULL));
    assert_ok(set_up_driver(&drv, sys, method, 0.1, 1e-11, 1e-11));
    memcpy(y, start, sizeof start);
    const int status = tribo_driver_advance(drv, &t, begin + 15.0, y);
    require(status == TRIBO_OK, "%s, contact %zu swings: %s", method, swings, tribo_driver_message(drv));
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* While both rest the body follows one of them, and the other sees the rounding of that, and of time. */
TEST(either_holds)
{
    const char *method = _i % 2 ? "event" : "exact";
    const double begin = _i < 2 ? 0.0 : 1000.0;
    double y[3], other[3];
    between_ground_and_base(method, begin, 0, y);
    between_ground_and_base(method, begin, 1, other);
    assert_all_close(y, other, 3, 1e-10);
}

#define MANY 100
#define MODES 160

/* Contacts that see all modes, each in its own way, are as many as they are, however many: while they hold, none of them
 * moves. */
TEST(many_hold)
{
    struct random g = random_of(_i);
    double mass[MODES * MODES] = {0.0}, stiffness[MODES * MODES] = {0.0}, direction[MANY * MODES], load[MODES];
    double y[2 * MODES + 1] = {0.0}, largest = 0.0;
    tribo_system *sys;
    for (size_t d = 0; d < MODES; d++) {
        mass[d * MODES + d] = 1.0;
        stiffness[d * MODES + d] = uniform(&g, 1.0, 9.0);
        load[d] = uniform(&g, -1.0, 1.0);
    }
    for (size_t k = 0; k < MANY * MODES; k++) {
        direction[k] = uniform(&g, -1.0, 1.0);
    }
    assert_ok(dense_system(&sys, MODES, MANY, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 1e3));
    assert_ok(tribo_system_add_load(sys, 0.7, NULL, load));
    run(sys, "exact", 1.0, 0.0, 3.0, y);
    for (size_t d = 0; d < MODES; d++) {
        largest = fmax(largest, fabs(y[d]));
    }
    require(largest > 0.1, "nothing moves: %g", largest);
    for (size_t i = 0; i < MANY; i++) {
        double moved = 0.0;
        for (size_t d = 0; d < MODES; d++) {
            moved += direction[i * MODES + d] * y[d];
        }
        require(fabs(moved) <= 1e-11 * largest, "contact %zu has moved by %g of %g", i, moved, largest);
    }
    tribo_system_destroy(sys);
}

TEST_MAIN("redundant", {either_holds, 4}, {many_hold, 3}, {hold_as_long_as_they_can, 20}, {steps_agree, 6})
