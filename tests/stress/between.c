/* SPDX-License-Identifier: BSD-3-Clause */
/* What may happen between two advances, at random: limits, static ones, some that fall with the speed, loads, tables and bases
 * that change, states and times that are set, advances of no length, of next to none, and in many pieces, calls that are refused,
 * observers that stop a run, memory that ends, periodic motions that are looked for, other drivers of the same system, copies of
 * it, of which one lives on. A driver that has seen all of that has to go on as a new one does, on a system that has the same
 * settings and has seen nothing; and the closed form has to agree with the event-driven series. TRIBO_SEED and TRIBO_BLOCKS as in
 * random.c. */
#include <stdio.h>
#include <string.h>

#include "memory.h"
#include "structure.h"
#include "../set_up_driver.h"

#define BLOCK 5
#define ADVANCES 20
#define KNOTS 4
#define DT 0.01 /* of methods with steps of one length */

enum {
    LIMITS,
    NORMAL_LOADS,
    LOAD,
    NO_LOADS,
    BASE,
    NO_BASE,
    STATIC, /* elastic contacts take what stands before this, */
    NO_STATIC,
    SWING,
    LOAD_TABLE, /* and the closed form what stands before this */
    BASE_TABLE,
    LIMIT_TABLE,
    NO_LIMIT_TABLE,
    FALLING,
    KINDS
};

/* A setting, and its numbers: by contacts, degrees of freedom or knots. */
struct change {
    int kind;
    double omega, time[KNOTS], x[KNOTS * MOST_CONTACTS], y[MOST_DOFS];
};

static const struct way {
    const char *method;
    double dt, tolerance;
    double near; /* the most that it may be off a new driver, of the size of the state */
    int closed;  /* takes no tables, nor limits that fall with the speed */
    int elastic; /* takes elastic contacts */
} ways[] = {{"exact", 0.5, 0.0, 1e-10, 1, 1},
            {"event", 0.5, 1e-11, 1e-8, 0, 1},
            {"central/fixed", DT, 0.0, 1e-10, 0, 0},
            {"moreau/fixed", DT, 0.0, 1e-10, 0, 1},
            {"rk4/fixed", DT, 0.0, 1e-10, 0, 0}};

/* A system with the driver that lives long, what was set since, and where they are. */
struct life {
    struct structure s;
    const struct way *way;
    struct random g;
    tribo_system *sys;
    tribo_driver *drv;
    struct change change[2 * ADVANCES];
    size_t changes;
    int swings, goes_on; /* limits swing; (t, y) is where the driver has left off */
    double t, y[MOST_STATES];
};

static int chance(struct random *g, double p)
{
    return uniform(g, 0.0, 1.0) < p;
}

/* ------------------------------------------------------------------------------------------------------------ settings */

static int apply(tribo_system *sys, const struct change *c)
{
    tribo_context *contacts = tribo_system_context(sys);
    switch (c->kind) {
    case LIMITS:
        return tribo_set_limit(contacts, c->x);
    case NORMAL_LOADS:
        return tribo_set_normal_load(contacts, c->x, c->y);
    case STATIC:
    case NO_STATIC:
        return tribo_set_static(contacts, c->kind == STATIC ? c->x : NULL, NULL);
    case FALLING:
        return tribo_set_static(contacts, c->x, c->y);
    case LOAD:
        return tribo_system_add_load(sys, c->omega, c->y, NULL);
    case NO_LOADS:
        return tribo_system_clear_loads(sys);
    case BASE:
        return tribo_system_add_base_motion(sys, c->omega, c->x, c->y);
    case NO_BASE:
        return tribo_system_clear_base_motion(sys);
    case SWING:
        return tribo_system_add_limit(sys, c->omega, c->x, NULL);
    case LOAD_TABLE:
        return tribo_system_add_load_table(sys, KNOTS, c->time, c->x, c->y);
    case BASE_TABLE:
        return tribo_system_add_base_table(sys, KNOTS, c->time, c->x, c->y);
    default:
        return c->kind == LIMIT_TABLE ? tribo_system_set_limit_table(sys, KNOTS, c->time, c->x) : tribo_system_clear_limits(sys);
    }
}

/* Numbers that a setting of this kind may have. While limits swing one that is set is never 0: a contact that has lifted off has
 * that limit, and to set what is there changes nothing. */
static double number(struct random *g, int kind, int swings)
{
    switch (kind) {
    case STATIC:
    case FALLING:
        return chance(g, 0.5) ? 1.0 : uniform(g, 1.0, 2.0);
    case LIMITS:
    case NORMAL_LOADS:
    case LIMIT_TABLE:
        return chance(g, 0.1) && !swings ? 0.0 : 0.3 * log_uniform(g, 0.7);
    default:
        return chance(g, 0.4) ? 0.0 : uniform(g, -0.5, 0.5);
    }
}

/* The k-th of the others: what has no mass takes no load. */
static double second_number(struct life *l, int kind, size_t k)
{
    switch (kind) {
    case NORMAL_LOADS:
        return uniform(&l->g, l->swings ? 0.1 : -0.3, 2.0);
    case FALLING:
        return uniform(&l->g, 0.1, 1.0);
    default:
        return kind == LOAD && k >= l->s.ndof - l->s.springs ? 0.0 : uniform(&l->g, -0.5, 0.5);
    }
}

static struct change any_change(struct life *l)
{
    struct random *g = &l->g;
    struct change c = {.kind = (int)below(g, l->s.springs     ? STATIC
                                             : l->way->closed ? LOAD_TABLE
                                                              : KINDS),
                       .omega = uniform(g, 0.3, 2.0)};
    c.omega = chance(g, 0.3) ? 0.0 : c.omega;
    for (size_t k = 0; k < COUNT(c.x); k++) {
        c.x[k] = number(g, c.kind, l->swings);
    }
    for (size_t k = 0; k < COUNT(c.y); k++) {
        c.y[k] = second_number(l, c.kind, k);
    }
    for (size_t k = 0; k < KNOTS; k++) {
        c.time[k] = (k ? c.time[k - 1] : l->t - 0.5) + uniform(g, 0.3, 1.0);
    }
    return c;
}

static void set_something(struct life *l)
{
    struct change *c = &l->change[l->changes];
    *c = any_change(l);
    assert_ok(apply(l->sys, c));
    l->swings |= c->kind == SWING;
    l->changes++;
    l->goes_on = 0;
}

static void set_state(struct life *l)
{
    const size_t n = l->s.ndof, i = below(&l->g, n);
    switch (below(&l->g, 4)) {
    case 0:
        l->y[n + i] = uniform(&l->g, -1.0, 1.0);
        break;
    case 1:
        l->y[i] += uniform(&l->g, -0.5, 0.5);
        break;
    case 2:
        l->y[2 * n] += 1.0;
        break;
    default:
        l->t += uniform(&l->g, -2.0, 2.0);
    }
    l->goes_on = 0;
}

/* -------------------------------------------------------------------------------------------------------- disturbances */

static tribo_driver *new_driver(tribo_system *sys, const struct way *way)
{
    tribo_driver *drv = NULL;
    const int status = set_up_driver(&drv, sys, way->method, way->dt, way->tolerance, 0.0);
    require(!status, "%s: %s", way->method, tribo_system_message(sys));
    return drv;
}

/* The driver goes somewhere else, which may fail. */
static void go_astray(struct life *l, tribo_driver *drv, double t, double duration)
{
    double y[MOST_STATES];
    memcpy(y, l->y, sizeof y);
    y[below(&l->g, l->s.ndof)] += chance(&l->g, 0.5) ? 0.1 : 0.0;
    tribo_driver_advance(drv, &t, t + duration, y);
    l->goes_on &= drv != l->drv;
}

static void ask_in_vain(struct life *l)
{
    double t = l->t, y[MOST_STATES], bad[MOST_CONTACTS], load[MOST_DOFS] = {0.0};
    tribo_context *contacts = tribo_system_context(l->sys);
    for (size_t i = 0; i < MOST_CONTACTS; i++) {
        bad[i] = i + 1 < l->s.ncontact ? 0.3 : -(double)NAN;
    }
    load[l->s.ndof - 1] = HUGE_VAL;
    memcpy(y, l->y, sizeof y);
    y[below(&l->g, 2 * l->s.ndof)] = NAN;
    assert_status(tribo_driver_advance(l->drv, &t, t - 1.0, l->y), TRIBO_ERR_RANGE);
    assert_status(tribo_driver_advance(l->drv, &t, t + 1.0, y), TRIBO_ERR_NOT_FINITE);
    assert_status(tribo_set_limit(contacts, bad), TRIBO_ERR_NOT_FINITE);
    assert_status(tribo_set_static(contacts, bad, NULL), TRIBO_ERR_NOT_FINITE);
    assert_status(tribo_system_add_load(l->sys, 1.0, load, NULL), TRIBO_ERR_NOT_FINITE);
    assert_status(tribo_system_add_limit(l->sys, 1.0, NULL, bad), TRIBO_ERR_NOT_FINITE);
    assert_status(tribo_system_add_base_motion(l->sys, 1.0, bad, NULL), TRIBO_ERR_NOT_FINITE);
}

static int stop_here(const tribo_moment *moment, void *left)
{
    (void)moment;
    return --*(int *)left <= 0;
}

static void be_stopped(struct life *l)
{
    int left = 1 + (int)below(&l->g, 4);
    assert_ok(tribo_driver_set_observer(l->drv, stop_here, &left));
    go_astray(l, l->drv, l->t, 1.0);
    assert_ok(tribo_driver_set_observer(l->drv, NULL, NULL));
}

static void run_out_of_memory(struct life *l)
{
    memory_fail(1 + below(&l->g, 12));
    go_astray(l, l->drv, l->t, 0.5);
    memory_fail(0);
}

static void look_elsewhere(struct life *l)
{
    double f[MOST_CONTACTS], y[MOST_STATES];
    tribo_system_contacts(l->sys, l->t + uniform(&l->g, -1.0, 1.0), l->y, NULL, f, NULL);
    memcpy(y, l->y, sizeof y);
    if (chance(&l->g, 0.3) && l->way->closed) {
        tribo_driver_find_periodic(l->drv, l->t, 2.0 * PI, y);
        l->goes_on = 0;
    }
}

/* Another driver of the same system, or of a copy, which is then changed, and ends. */
static void let_others_move(struct life *l, int copies)
{
    tribo_system *sys = l->sys;
    if (copies) {
        assert_ok(tribo_system_clone(l->sys, &sys));
    }
    tribo_driver *other = new_driver(sys, l->way);
    go_astray(l, other, l->t, 1.0);
    if (copies) {
        const struct change c = any_change(l);
        assert_ok(apply(sys, &c));
        go_astray(l, other, l->t, 0.5);
    }
    tribo_driver_destroy(other);
    if (copies) {
        tribo_system_destroy(sys);
    }
}

/* The copy lives on, after the original has been changed. */
static void become_a_copy(struct life *l)
{
    tribo_system *copy;
    assert_ok(tribo_system_clone(l->sys, &copy));
    const struct change c = any_change(l);
    assert_ok(apply(l->sys, &c));
    tribo_driver_destroy(l->drv);
    tribo_system_destroy(l->sys);
    l->sys = copy;
    l->drv = new_driver(copy, l->way);
    l->goes_on = 0;
}

static void disturb(struct life *l)
{
    switch (below(&l->g, 12)) {
    case 0:
        go_astray(l, l->drv, l->t + uniform(&l->g, -1.0, 1.0), uniform(&l->g, 0.0, 1.0));
        break;
    case 1:
        ask_in_vain(l);
        break;
    case 2:
        be_stopped(l);
        break;
    case 3:
        run_out_of_memory(l);
        break;
    case 4:
        look_elsewhere(l);
        break;
    case 5:
    case 6:
        let_others_move(l, chance(&l->g, 0.5));
        break;
    case 7:
        become_a_copy(l);
        break;
    default:
        break;
    }
}

/* ------------------------------------------------------------------------------------------------------------ advances */

/* In so many pieces. */
static int advance(tribo_driver *drv, double t, double t1, int pieces, double *y)
{
    const double begin = t;
    int status = tribo_driver_advance(drv, &t, t, y);
    for (int p = 1; p <= pieces && !status; p++) {
        status = tribo_driver_advance(drv, &t, p == pieces ? t1 : begin + (t1 - begin) * p / pieces, y);
    }
    return status;
}

/* The same by a new driver of a new system. */
static int advance_anew(const struct life *l, const struct way *way, double t1, double *y)
{
    tribo_system *sys = structure_system(&l->s);
    assert_ok(tribo_set_epsilon_step(tribo_system_context(sys), DT, 0.4));
    for (size_t k = 0; k < l->changes; k++) {
        assert_ok(apply(sys, &l->change[k]));
    }
    tribo_driver *drv = new_driver(sys, way);
    memcpy(y, l->y, sizeof l->y);
    const int status = advance(drv, l->t, t1, 1, y);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    return status;
}

static void compare(const struct life *l, int seed, const char *whom, double t1, const double *y, const double *want, double near)
{
    const size_t n = 2 * l->s.ndof + 1;
    const double off = distance(y, want, n), size = fmax(1.0, size_of(want, n));
    require(off <= near * size, "seed %d, %s, from t = %.17g to %.17g with %zu changes: %s is off %s by %.3g of %.3g", seed,
            l->s.name, l->t, t1, l->changes, l->way->method, whom, off, size);
}

/* Steps of one length go on half a step later, or end elsewhere in pieces: those that differ are not compared. Contacts with
 * static limits that tie each other on bases that part may be refused, and rounding tells when. Returns whether life goes on. */
static int advance_and_compare(struct life *l, int seed)
{
    static const double lengths[] = {1e-13, 1e-9, 1e-5, 3e-3, 0.1, 1.0, 1.0, 2.0, 3.0};
    const double t1 = l->t + lengths[below(&l->g, COUNT(lengths))];
    const int pieces = chance(&l->g, 0.2) ? 2 + (int)below(&l->g, 30) : 1, steps = l->way->dt == DT;
    double y[MOST_STATES], anew[MOST_STATES], other[MOST_STATES];
    memcpy(y, l->y, sizeof y);
    const int status = advance(l->drv, l->t, t1, pieces, y), want = advance_anew(l, l->way, t1, anew);
    const int refused = status == TRIBO_ERR_UNSUPPORTED || want == TRIBO_ERR_UNSUPPORTED;
    require(status == want || refused, "seed %d, %s, %s: %d, not %d: %s", seed, l->s.name, l->way->method, status, want,
            tribo_driver_message(l->drv));
    if (status || want) {
        return 0;
    }
    if (!steps || (pieces == 1 && !l->goes_on)) {
        compare(l, seed, "a new driver", t1, y, anew, l->way->near);
    }
    if (l->way->closed && !advance_anew(l, &ways[1], t1, other)) {
        compare(l, seed, "event", t1, y, other, 1e-7);
    }
    memcpy(l->y, y, sizeof y);
    l->t = t1;
    l->goes_on = 1;
    return 1;
}

static void live(const struct structure *s, const struct way *way, int seed)
{
    struct life l = {.s = *s, .way = way, .g = random_of(seed), .sys = structure_system(s), .t = s->begin};
    assert_ok(tribo_set_epsilon_step(tribo_system_context(l.sys), DT, 0.4));
    memcpy(l.y, s->start, sizeof s->start);
    l.drv = new_driver(l.sys, way);
    for (int k = 0, lives = 1; k < ADVANCES && lives; k++) {
        for (size_t changes = below(&l.g, 3); changes > 0; changes--) {
            set_something(&l);
        }
        if (chance(&l.g, 0.3)) {
            set_state(&l);
        }
        disturb(&l);
        lives = advance_and_compare(&l, seed) && size_of(l.y, 2 * s->ndof) < 50.0;
    }
    tribo_driver_destroy(l.drv);
    tribo_system_destroy(l.sys);
}

/* Structures of up to 12 degrees of freedom, small ones of whole numbers, and some with elastic contacts. */
TEST(as_a_new_driver)
{
    const struct way *way = &ways[_i % (int)COUNT(ways)];
    const int first = setting("TRIBO_SEED", 0) + BLOCK * (_i / (int)COUNT(ways));
    for (int seed = first; seed < first + BLOCK; seed++) {
        const struct structure any = structure_create(seed), even = structure_even(seed);
        live(&any, way, seed);
        live(&even, way, seed);
        if (way->elastic) {
            const struct structure elastic = structure_elastic(seed);
            live(&elastic, way, seed);
        }
    }
}

int main(void)
{
    const int blocks = setting("TRIBO_BLOCKS", 1);
    const struct test tests[] = {{as_a_new_driver, blocks * (int)COUNT(ways)}};
    return run_suite("between", tests, COUNT(tests));
}
