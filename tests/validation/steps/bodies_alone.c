/* SPDX-License-Identifier: BSD-3-Clause */
/* Methods "central/fixed" and "rk4/fixed" go their own ways where contacts share no body, and the former leaves out what is at
 * rest: the motion is the one of contacts that are solved for together, which a contact that is open ties into one group. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "make.h"
#include "run.h"

/* Masses of 1 in a row between springs of 1, each on a contact but every `bare`-th; the ends are tied to the ground. */
struct row {
    size_t n, bare; /* 0: all are on contacts */
    int damped, tied;
    size_t coupled; /* if not 0: the mass matrix couples the first body and this one, which are without contacts */
};

enum { PLAIN, LOADED, DAMPED, BELTS, SWINGING, LIMIT_TABLE, RELEASED, SETTINGS };

static const double knots[] = {0.0, 3.0, 4.0, 5.0};

static gsl_spmatrix *band(size_t n, double diagonal, double beside)
{
    gsl_spmatrix *a = gsl_spmatrix_alloc(n, n);
    for (size_t i = 0; i < n; i++) {
        gsl_spmatrix_set(a, i, i, diagonal);
        if (i > 0 && beside < 0.0) {
            gsl_spmatrix_set(a, i - 1, i, beside);
            gsl_spmatrix_set(a, i, i - 1, beside);
        }
    }
    return a;
}

static int has_contact(const struct row *r, size_t i)
{
    return !r->bare || i % r->bare != 0;
}

static size_t contacts_of(const struct row *r)
{
    size_t count = 0;
    for (size_t i = 0; i < r->n; i++) {
        count += (size_t)has_contact(r, i);
    }
    return count;
}

/* Contacts are numbered from the last mass to the first, and see the velocity with a factor of -2. */
static tribo_system *row_create(const struct row *r)
{
    const size_t c = contacts_of(r);
    gsl_spmatrix *m = band(r->n, 1.0, 0.0), *k = band(r->n, 2.0, -1.0), *d = band(r->n, 0.2, -0.1);
    gsl_spmatrix *j = gsl_spmatrix_alloc(c + (size_t)r->tied, r->n);
    if (r->coupled) {
        gsl_spmatrix_set(m, 0, r->coupled, 0.5);
        gsl_spmatrix_set(m, r->coupled, 0, 0.5);
    }
    for (size_t i = 0, at = c; i < r->n; i++) {
        if (has_contact(r, i)) {
            gsl_spmatrix_set(j, --at, i, -2.0);
        }
    }
    if (r->tied) {
        gsl_spmatrix_set(j, c, 0, 1.0);
        if (r->n > 1) {
            gsl_spmatrix_set(j, c, 1, -1.0);
        }
    }
    tribo_system *sys;
    char message[200];
    const int status = sparse_system(&sys, m, r->damped ? d : NULL, k, j, 0, message, sizeof message);
    require(!status, "%s", message);
    gsl_spmatrix_free(m);
    gsl_spmatrix_free(k);
    gsl_spmatrix_free(d);
    gsl_spmatrix_free(j);
    return sys;
}

/* What acts, by setting, on what number of contacts; x has room. */
static void act(tribo_system *sys, const struct row *r, int setting, double *x)
{
    const size_t c = tribo_system_ncontact(sys), solid = contacts_of(r);
    memset(x, 0, 4 * (c + r->n) * sizeof *x);
    for (size_t i = 0; i < solid; i++) {
        x[i] = 0.1 + 0.01 * (double)(i % 7);
    }
    assert_ok(tribo_set_limit(tribo_system_context(sys), x));
    if (setting == SWINGING) {
        for (size_t i = 0; i < solid; i++) {
            x[i] *= i % 3 ? 0.0 : 0.8;
        }
        assert_ok(tribo_system_add_limit(sys, 1.3, x, NULL));
    }
    for (size_t k = 0; setting == LIMIT_TABLE && k < 4; k++) {
        for (size_t i = 0; i < solid; i++) {
            x[k * c + i] = 0.05 * (double)(k + 1);
        }
        x[k * c + solid] = 0.0;
    }
    if (setting == LIMIT_TABLE) {
        assert_ok(tribo_system_set_limit_table(sys, 4, knots, x));
    }
    memset(x, 0, 4 * (c + r->n) * sizeof *x);
    if (setting == BELTS) {
        x[2] = 0.7;
        x[solid - 1] = -0.5;
        assert_ok(tribo_system_add_base_motion(sys, 0.0, x, NULL));
        x[2] = 0.0;
        assert_ok(tribo_system_add_base_motion(sys, 0.9, x, NULL));
        memset(x, 0, c * sizeof *x);
    }
    x[0] = 2.0;
    assert_ok(tribo_system_add_load(sys, 0.8, x, NULL));
    if (setting == LOADED) {
        const double value[] = {0.0, 0.0, 3.0, 0.0};
        x[0] = 0.0;
        x[r->n * 51 / 100] = 1.0;
        assert_ok(tribo_system_add_load_table(sys, 4, knots, value, x));
        x[r->n * 51 / 100] = 0.0;
        x[r->n - 1] = 0.05;
        assert_ok(tribo_system_add_load(sys, 0.0, x, NULL));
    }
}

/* Limits that follow a table might change: nothing is left out. The table says what they are. */
static void keep_awake(tribo_system *sys)
{
    const double time[] = {0.0, 1.0};
    const size_t c = tribo_system_ncontact(sys);
    double *limit = malloc(2 * c * sizeof *limit);
    assert_ok(tribo_get_limit(tribo_system_context(sys), limit));
    memcpy(limit + c, limit, c * sizeof *limit);
    assert_ok(tribo_system_set_limit_table(sys, 2, time, limit));
    free(limit);
}

static int seen(const tribo_moment *moment, void *data)
{
    const double *y = moment->y;
    *(double *)data += y[0] * y[0];
    return 0;
}

/* What a motion is counted by. */
struct counts {
    size_t rested, stuck, evaluations;
};

enum { UNWATCHED, WATCHED, KEPT_AWAKE };

/* From springs that strain the contacts a little, in three advances. */
static double *motion(const char *method, const struct row *r, int setting, int how, struct counts *counts)
{
    tribo_system *sys = row_create(r);
    const size_t n = r->n, c = tribo_system_ncontact(sys);
    double *y = calloc(2 * n + 2, sizeof *y), *x = malloc((4 * (c + n) + 1) * sizeof *x), t = 0.0;
    act(sys, r, setting, x);
    if (how == KEPT_AWAKE) {
        keep_awake(sys);
    }
    assert_ok(tribo_set_epsilon_step(tribo_system_context(sys), 0.1, 0.4));
    for (size_t i = 0; i < n; i++) {
        y[i] = 0.01 * (double)((i * 37) % 11) * (double)(has_contact(r, i));
    }
    y[n + n / 4] = 0.8;
    tribo_driver *drv = driver_create(sys, method, 0.1, 0.0);
    assert_ok(tribo_driver_set_observer(drv, how == WATCHED ? seen : NULL, &y[2 * n + 1]));
    driver_advance(drv, &t, 10.0, y);
    driver_advance(drv, &t, 20.05, y);
    if (setting == RELEASED) { /* what held does not hold any more */
        memset(x, 0, c * sizeof *x);
        assert_ok(tribo_set_limit(tribo_system_context(sys), x));
        if (how == KEPT_AWAKE) {
            keep_awake(sys);
        }
    }
    driver_advance(drv, &t, 30.0, y);
    counts->rested = driver_count(drv, TRIBO_COUNT_RESTED);
    counts->evaluations = driver_count(drv, TRIBO_COUNT_EVALUATIONS);
    assert_ok(tribo_system_get_count(sys, TRIBO_COUNT_STUCK, &counts->stuck));
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    free(x);
    return y;
}

static const struct row rows[] = {{1, 0, 0, 0, 0},   {2, 0, 0, 0, 0},       {5, 0, 0, 0, 0},   {131, 4, 0, 0, 0},
                                  {400, 3, 0, 0, 0}, {512, 255, 0, 0, 255}, {1500, 0, 0, 0, 0}};

static const char *const methods[] = {"central/fixed", "rk4/fixed"};
enum { CASES = (int)COUNT(rows) * SETTINGS };

/* Case k; 0 if there is none. */
static int pick(int k, struct row *r, int *setting)
{
    *r = rows[k / SETTINGS];
    *setting = k % SETTINGS;
    r->damped = *setting == DAMPED;
    return r->n >= 5 || *setting != BELTS;
}

TEST(as_solved_for_together)
{
    const char *method = methods[_i / (2 * CASES)];
    const int watched = _i / CASES % 2, central = _i < 2 * CASES;
    struct row r;
    int setting;
    struct counts apart, together;
    if (!pick(_i % CASES, &r, &setting)) {
        return;
    }
    double *alone = motion(method, &r, setting, watched, &apart);
    r.tied = 1;
    double *tied = motion(method, &r, setting, watched, &together);
    assert_all_close(alone, tied, 2 * r.n + 1, 1e-12);
    assert_close(alone[2 * r.n + 1], tied[2 * r.n + 1], 1e-12 * tied[2 * r.n + 1]);
    ck_assert_uint_eq(together.rested, 0);
    ck_assert_uint_eq(apart.stuck, together.stuck);
    ck_assert_uint_eq(apart.evaluations, together.evaluations);
    require(!central || r.n < 1500 || setting == SWINGING || setting == LIMIT_TABLE || apart.rested > 0,
            "n = %zu, setting %d: none at rest", r.n, setting);
    free(alone);
    free(tied);
}

/* The motion of rk4 by a law, from one body that moves, while all others are strained. */
static double *motion_by(int law, const struct row *r)
{
    tribo_system *sys = row_create(r);
    tribo_context *c = tribo_system_context(sys);
    double *y = calloc(2 * r->n + 1, sizeof *y), *x = malloc(4 * (tribo_system_ncontact(sys) + r->n) * sizeof *x);
    act(sys, r, PLAIN, x);
    assert_ok(tribo_set_law(c, law));
    assert_ok(tribo_set_epsilon_all(c, 0.3));
    for (size_t i = 0; i < r->n; i++) {
        y[i] = 0.01 * (double)((i * 37) % 11) * (double)(has_contact(r, i));
    }
    y[r->n + r->n / 4] = 0.8;
    run(sys, "rk4/fixed", 0.02, 0.0, 2.0, y);
    tribo_system_destroy(sys);
    free(x);
    return y;
}

TEST(laws_as_solved_for_together)
{
    struct row r = rows[3];
    double *alone = motion_by(_i, &r);
    r.tied = 1;
    double *tied = motion_by(_i, &r);
    require(alone[2 * r.n] > 0.01, "law %d dissipates %g", _i, alone[2 * r.n]);
    assert_all_close(alone, tied, 2 * r.n + 1, 1e-12);
    free(alone);
    free(tied);
}

/* Who watches changes nothing, to the last bit. */
TEST(watched_or_not)
{
    const char *method = methods[_i / CASES];
    struct row r;
    int setting;
    struct counts counts;
    if (!pick(_i % CASES, &r, &setting)) {
        return;
    }
    double *alone = motion(method, &r, setting, UNWATCHED, &counts), *watched = motion(method, &r, setting, WATCHED, &counts);
    for (size_t i = 0; i < 2 * r.n + 1; i++) {
        assert_exact(alone[i], watched[i]);
    }
    free(alone);
    free(watched);
}

/* Nor does it, to the last bit, that blocks at rest are left out. */
static void assert_same_awake(const struct row *r, int setting)
{
    struct counts left_out, awake;
    double *some = motion("central/fixed", r, setting, UNWATCHED, &left_out);
    double *all = motion("central/fixed", r, setting, KEPT_AWAKE, &awake);
    assert_all_close(some, all, 2 * r->n + 1, 0.0);
    ck_assert_uint_eq(awake.rested, 0);
    require(r->n < 1500 || left_out.rested > 0, "setting %d: none at rest", setting);
    free(some);
    free(all);
}

TEST(left_out_or_not)
{
    struct row r;
    int setting;
    if (pick(_i, &r, &setting) && setting != SWINGING && setting != LIMIT_TABLE) {
        assert_same_awake(&r, setting);
    }
}

/* From rest but for one body's speed, under a steady load on the first, with one limit for all. */
static double *plain_motion(const struct row *r, double limit, double load, size_t body, double speed, int how)
{
    tribo_system *sys = row_create(r);
    double *y = calloc(2 * r->n + 1, sizeof *y), *x = calloc(r->n, sizeof *x);
    x[0] = load;
    assert_ok(tribo_system_add_load(sys, 0.0, x, NULL));
    for (size_t i = 0; i < r->n; i++) {
        x[i] = limit;
    }
    assert_ok(tribo_set_limit(tribo_system_context(sys), x));
    if (how == KEPT_AWAKE) {
        keep_awake(sys);
    }
    y[r->n + body] = speed;
    run(sys, "central/fixed", 0.1, 0.0, 30.0, y);
    tribo_system_destroy(sys);
    free(x);
    return y;
}

/* Bodies 0 and 255 are without contacts. Body 256, which a wave reaches, accelerates both, and feels only the latter: its block
 * wakes one at which it pulls, but which does not pull at it. */
TEST(coupled_masses)
{
    const struct row r = {512, 255, 0, 0, 255};
    double *some = plain_motion(&r, 0.3, 0.0, 258, 5.0, UNWATCHED), *all = plain_motion(&r, 0.3, 0.0, 258, 5.0, KEPT_AWAKE);
    require(all[0] != 0.0, "the first body does not move: this shows nothing");
    assert_all_close(some, all, 2 * r.n + 1, 0.0);
    free(some);
    free(all);
}

/* Loads above the limit by less than lengths of steps differ by: what does not move in one step may creep in another. */
TEST(hardly_held)
{
    const struct row r = {1, 0, 0, 0, 0};
    size_t creeps = 0;
    for (int k = 0; k < 100; k++) {
        const double limit = 0.3 + 0.001 * k, load = nextafter(2.0 * limit, 10.0);
        double *some = plain_motion(&r, limit, load, 0, 0.0, UNWATCHED), *all = plain_motion(&r, limit, load, 0, 0.0, KEPT_AWAKE);
        creeps += all[0] > 0.0;
        assert_exact(some[0], all[0]);
        free(some);
        free(all);
    }
    require(creeps > 0, "nothing creeps: this shows nothing");
}

/* Steps that are too long end with an error that says so, and with the last good state. */
TEST(grows)
{
    const struct row r = {131, 4, 0, 0, 0};
    double y[2 * 131 + 1] = {0}, t = 0.0, x[4 * 2 * 131];
    tribo_system *sys = row_create(&r);
    act(sys, &r, PLAIN, x);
    assert_ok(tribo_set_epsilon_step(tribo_system_context(sys), 0.1, 0.4));
    tribo_driver *drv = driver_create(sys, "rk4/fixed", 20.0, 0.0);
    assert_status(tribo_driver_advance(drv, &t, 1e6, y), TRIBO_ERR_NOT_FINITE);
    require(strstr(tribo_driver_message(drv), "in a step of 20: a[") != NULL ||
                strstr(tribo_driver_message(drv), "in a step of 20: v[") != NULL ||
                strstr(tribo_driver_message(drv), "the motion grows without bound") != NULL,
            "%s", tribo_driver_message(drv));
    for (size_t i = 0; i < COUNT(y); i++) {
        require(isfinite(y[i]), "y[%zu] = %g", i, y[i]);
    }
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_STEPS), (size_t)(t / 20.0 + 0.5));
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Nothing but the end of the step shows it: what is dissipated, and all before, is finite. */
TEST(ends_beyond_numbers)
{
    enum { N = 6 };
    double mass[N * N] = {0}, stiffness[N * N] = {0}, y[2 * N + 1] = {0}, t = 0.0;
    tribo_system *sys;
    for (size_t i = 0; i < N; i++) {
        mass[i * N + i] = 1.0;
    }
    assert_ok(dense_system(&sys, N, N, mass, NULL, stiffness, mass, 0, NULL, 0));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.01));
    y[N] = 1e308;
    tribo_driver *drv = driver_create(sys, "rk4/fixed", 1.0, 0.0);
    assert_status(tribo_driver_advance(drv, &t, 30.0, y), TRIBO_ERR_NOT_FINITE);
    assert_says(tribo_driver_message(drv), "y[0] = inf");
    assert_exact(t, 0.0);
    assert_exact(y[N], 1e308);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Of the paper's chain a load moves 1%: its blocks are all that steps look at, from beginning to end, and the few beside them. */
TEST(steps_cost_what_moves)
{
    const size_t n = 100000;
    const double dt = 0.9 / (double)n;
    double t = 0.0, *y = calloc(2 * n + 1, sizeof *y);
    tribo_system *sys;
    assert_ok(tribo_system_chain(&sys, n, 1.0, 0.01, 100.0));
    tribo_driver *drv = driver_create(sys, "central/fixed", dt, 0.0);
    driver_advance(drv, &t, 2000.0 * dt, y);
    size_t moved = 0;
    for (size_t i = 0; i < n; i++) {
        moved += y[i] != 0.0;
    }
    const double rested = (double)driver_count(drv, TRIBO_COUNT_RESTED) / (double)driver_count(drv, TRIBO_COUNT_STEPS);
    require(moved > n / 200 && moved < n / 50, "%zu blocks have moved", moved);
    require(rested > 0.98 * (double)n, "%g of %zu blocks at rest, a step", rested, n);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    free(y);
}

TEST_MAIN("bodies_alone", {as_solved_for_together, 4 * CASES}, {laws_as_solved_for_together, 6}, {watched_or_not, 2 * CASES},
          {left_out_or_not, CASES}, {coupled_masses, 1}, {hardly_held, 1}, {grows, 1}, {ends_beyond_numbers, 1},
          {steps_cost_what_moves, 1})
