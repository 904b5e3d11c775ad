/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory: none is asked for once a context is set up; and when there is none, nothing leaks and nothing is lost. */
#include <string.h>

#include "memory.h"
#include "problem.h"

static const size_t first[] = {0, 2, 4, 5}, col[] = {0, 1, 1, 0, 2};
static const double val[] = {2.0, 1.0, 2.0, 1.0, 1.0}, weight[] = {1.0, 0.5, 2.0};
static const double dense[] = {1.0, 0.5, 0.25, 0.5, 1.0, 0.5, 0.25, 0.5, 1.0}, unit[] = {1.0, 1.0, 1.0};

/* ---------------------------------------------------------------------------------------------------------- hot paths */

static void work(tribo_context *c, const struct problem *p)
{
    static double f[LARGEST], feq[LARGEST], square[2][LARGEST * LARGEST];
    static signed char slip[LARGEST];
    size_t count;
    tribo_balance(c, p->v, p->a, feq, f);
    tribo_force(c, p->v, feq, f);
    tribo_force_tangent(c, p->v, feq, f, square[0], square[1], NULL);
    tribo_balance_tangent(c, p->v, p->a, feq, f, square[0], square[1]);
    tribo_tangent_product(c, p->v, p->a, f);
    tribo_limit_product(c, p->v, f);
    tribo_step_force(c, 0.1, p->v, f);
    tribo_step_force_mean(c, 0.1, p->a, p->v, f);
    tribo_solve_box(c, p->a, p->v, p->v, f);
    tribo_accept(c, p->v, feq);
    tribo_get_slip(c, slip);
    tribo_get_count(c, TRIBO_COUNT_STUCK, &count);
    tribo_set_limit(c, p->limit);
    tribo_set_epsilon(c, p->epsilon);
    tribo_set_epsilon_step(c, 0.1, 1.0);
    tribo_set_law(c, TRIBO_QUINN_REVERSAL);
    tribo_set_coupling(c, TRIBO_PARTITION);
    tribo_force(c, NULL, NULL, NULL);
    tribo_balance(c, NULL, NULL, NULL, NULL);
}

TEST(hot_paths)
{
    struct random g = random_of(_i);
    const struct recipe recipe = recipe_random(&g, USUAL, 0.5);
    struct problem p = problem_create(&g, &recipe);
    const size_t none = memory_calls();
    tribo_context *c = problem_context(&p, _i % tribo_law_count(), _i / tribo_law_count() % 2);
    const size_t before = memory_calls();
    require(before > none, "allocations are not counted");
    for (int k = 0; k < 5; k++) {
        work(c, &p);
        for (size_t i = 0; i < p.n; i++) {
            p.v[i] *= -0.7;
            p.a[i] = -p.a[i];
        }
    }
    require(memory_calls() == before, "%zu allocations", memory_calls() - before);
    tribo_destroy(c);
}

/* f of the contacts in use of p, by a context of these alone. */
static void forces_of_some(const struct problem *p, const int *used, double *f)
{
    struct problem some = {.n = 0};
    size_t of[LARGEST];
    double g[LARGEST];
    for (size_t i = 0; i < p->n; i++) {
        of[some.n] = i;
        some.n += used[i] != 0;
        f[i] = 0.0;
    }
    for (size_t i = 0; i < some.n; i++) {
        some.limit[i] = p->limit[of[i]];
        some.epsilon[i] = p->epsilon[of[i]];
        some.v[i] = p->v[of[i]];
        some.a[i] = p->a[of[i]];
        for (size_t j = 0; j < some.n; j++) {
            some.r[i * some.n + j] = p->r[of[i] * p->n + of[j]];
        }
    }
    tribo_context *c = problem_context(&some, TRIBO_QUINN, TRIBO_CONSISTENT);
    assert_ok(tribo_balance(c, some.v, some.a, NULL, g));
    for (size_t i = 0; i < some.n; i++) {
        f[of[i]] = g[i];
    }
    tribo_destroy(c);
}

/* Contacts come and go by their limits: no allocation in many steps, forces and ranks of those in use alone, and no solve where
 * all are away. */
TEST(come_and_go)
{
    struct random g = random_of(_i);
    const struct recipe recipe = recipe_regular(&g, 12);
    struct problem p = problem_create(&g, &recipe);
    double limit[LARGEST], f[LARGEST], want[LARGEST];
    int used[LARGEST];
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
    size_t asked = 0;
    for (size_t i = 0; i < p.n; i += 2) {
        p.v[i] = 0.0;
    }
    for (int step = 0; step < 25000; step++) {
        const size_t before = memory_calls(), solves = count_of(c, TRIBO_COUNT_SOLVES);
        size_t in_use = 0;
        for (size_t i = 0; i < p.n; i++) {
            used[i] = step % 100 != 50 && below(&g, 3) > 0 && p.limit[i] > 0.0;
            limit[i] = used[i] ? p.limit[i] : 0.0;
            in_use += used[i] != 0;
        }
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_balance(c, p.v, p.a, NULL, f));
        asked += memory_calls() - before;
        require(count_of(c, TRIBO_COUNT_RANK) <= in_use, "rank %zu of %zu", count_of(c, TRIBO_COUNT_RANK), in_use);
        require(in_use || count_of(c, TRIBO_COUNT_SOLVES) == solves, "solved for contacts that are away");
        if (step % 500 == 0 || step % 500 == 50) {
            forces_of_some(&p, used, want);
            assert_all_close(f, want, p.n, 1e-12);
        }
    }
    require(asked == 0, "%zu allocations", asked);
    require(p.n < 4 || count_of(c, TRIBO_COUNT_SOLVES) > 10000, "%zu solves", count_of(c, TRIBO_COUNT_SOLVES));
    tribo_destroy(c);
}

TEST(planar)
{
    struct random g = random_of(_i);
    struct recipe recipe = recipe_regular(&g, USUAL);
    struct problem p = problem_create(&g, &recipe);
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
    assert_ok(tribo_set_planar(c, 1, first));
    const size_t before = memory_calls();
    for (int k = 0; k < 5; k++) {
        work(c, &p);
        for (size_t i = 0; i < p.n; i++) {
            p.v[i] *= -0.7;
        }
    }
    require(memory_calls() == before, "%zu allocations", memory_calls() - before);
    require(count_of(c, TRIBO_COUNT_SOLVES) > 0, "nothing was solved");
    tribo_destroy(c);
}

/* A row of so many contacts, which is kept sparse. */
static int set_row(tribo_context *c, size_t n)
{
    size_t row[LARGEST + 1] = {0}, at[3 * LARGEST], k = 0;
    double r[3 * LARGEST];
    for (size_t i = 0; i < n; i++) {
        for (size_t j = i > 0 ? i - 1 : 0; j < n && j <= i + 1; j++) {
            at[k] = j;
            r[k++] = i == j ? 2.0 : -1.0;
        }
        row[i + 1] = k;
    }
    return tribo_set_operator_csr(c, row, at, r);
}

TEST(hot_paths_of_a_sparse_group)
{
    struct random g = random_of(_i);
    const size_t n = LARGEST;
    struct problem p = {.n = n};
    double f[LARGEST];
    tribo_context *c;
    assert_ok(tribo_create(&c, n));
    assert_ok(set_row(c, n));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_epsilon_all(c, 1.0));
    const size_t before = memory_calls();
    for (int k = 0; k < 20; k++) {
        for (size_t i = 0; i < n; i++) {
            p.v[i] = below(&g, 4) ? p.v[i] : uniform(&g, -1.5, 1.5);
            p.a[i] = uniform(&g, -2.0, 2.0);
        }
        assert_ok(tribo_set_coupling(c, k % 2));
        assert_ok(tribo_balance_tangent(c, p.v, p.a, f, f, NULL, NULL));
        assert_ok(tribo_tangent_product(c, p.v, p.a, f));
        assert_ok(tribo_limit_product(c, p.v, f));
        assert_ok(tribo_step_force(c, 0.1, p.v, f));
    }
    require(memory_calls() == before, "%zu allocations", memory_calls() - before);
    require(count_of(c, TRIBO_COUNT_UPDATES) > 100, "few changes");
    tribo_destroy(c);
}

/* ---------------------------------------------------------------------------------------------------- failing allocations */

static int create(tribo_context *c)
{
    tribo_context *other = c;
    const int status = tribo_create(&other, 7);
    if (status) {
        return other == c ? status : -1; /* the output was written to */
    }
    tribo_destroy(other);
    return status;
}

static int clone(tribo_context *c)
{
    tribo_context *other = c;
    const int status = tribo_clone(c, &other);
    if (status) {
        return other == c ? status : -1;
    }
    tribo_destroy(other);
    return status;
}

static int set_diagonal(tribo_context *c)
{
    return tribo_set_operator_diagonal(c, unit);
}

static int set_dense(tribo_context *c)
{
    return tribo_set_operator_dense(c, dense);
}

static int set_csr(tribo_context *c)
{
    return tribo_set_operator_csr(c, first, col, val);
}

static int set_mass(tribo_context *c)
{
    return tribo_set_operator_mass(c, 3, weight, first, col, val);
}

static int solve_mass(size_t ndof, const double *force, double *acceleration, void *data)
{
    (void)data;
    memcpy(acceleration, force, ndof * sizeof *force);
    return 0;
}

static int set_callback(tribo_context *c)
{
    return tribo_set_operator_callback(c, 3, solve_mass, NULL, first, col, val);
}

/* A diagonal operator that does not look like one takes a way of its own. */
static int set_dense_diagonal(tribo_context *c)
{
    const double r[] = {1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0};
    return tribo_set_operator_dense(c, r);
}

static int set_planar(tribo_context *c)
{
    return tribo_set_planar(c, 1, first);
}

/* An operator and a clone of a context with planar contacts. */
static int copy_planar(tribo_context *c)
{
    tribo_context *copy, *other = NULL;
    if (tribo_clone(c, &copy)) {
        return TRIBO_ERR_MEMORY;
    }
    int status = tribo_set_planar(copy, 1, first);
    status = status ? status : set_dense(copy);
    require(!status || says(tribo_message(copy), "out of memory"), "\"%s\"", tribo_message(copy));
    status = status ? status : tribo_clone(copy, &other);
    tribo_destroy(other);
    tribo_destroy(copy);
    return status;
}

/* Settings of a context with planar contacts. */
static int copy_settings(tribo_context *c)
{
    tribo_context *from;
    int status = tribo_clone(c, &from);
    if (!status) {
        status = tribo_set_planar(from, 1, first);
        status = status ? status : tribo_copy_settings(c, from);
        tribo_destroy(from);
    }
    return status;
}

static const struct {
    const char *name;
    int (*call)(tribo_context *c);
    int has_message;
} calls[] = {
    {"create", create, 0},
    {"clone", clone, 0},
    {"diagonal", set_diagonal, 1},
    {"dense", set_dense, 1},
    {"csr", set_csr, 1},
    {"mass", set_mass, 1},
    {"callback", set_callback, 1},
    {"diagonal as dense", set_dense_diagonal, 1},
    {"planar", set_planar, 1},
    {"planar copy", copy_planar, 0},
    {"settings", copy_settings, 0},
};

/* A context with islands {0, 1} and {2}. */
static tribo_context *set_up(void)
{
    tribo_context *c;
    assert_ok(tribo_create(&c, 3));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(set_csr(c));
    return c;
}

static void ask(tribo_context *c, double *answer)
{
    const double v[] = {0.0, 1e-7, 0.0}, a[] = {0.3, 0.2, -0.6};
    assert_ok(tribo_balance(c, v, a, answer, answer + 3));
    answer[6] = (double)count_of(c, TRIBO_COUNT_ISLANDS);
}

/* Fails one allocation after the other, until there are no more. */
TEST(failures)
{
    double before[7], after[7];
    size_t fails = 1;
    for (int status = TRIBO_ERR_MEMORY; status; fails++) {
        const long none = memory_live();
        tribo_context *c = set_up();
        ask(c, before);
        const long live = memory_live();
        memory_fail(fails);
        status = calls[_i].call(c);
        memory_fail(0);
        if (status) {
            assert_status(status, TRIBO_ERR_MEMORY);
            require(memory_live() == live, "%s leaks when allocation %zu fails", calls[_i].name, fails);
            assert_says(tribo_message(c), calls[_i].has_message ? "out of memory" : "");
            ask(c, after);
            assert_all_close(after, before, 7, 1e-15); /* the second search starts from what the first found */
            assert_ok(calls[_i].call(c));
        }
        tribo_destroy(c);
        require(memory_live() == none, "%s leaves %ld blocks behind", calls[_i].name, memory_live() - none);
    }
    ck_assert_uint_gt(fails, 2);
}

/* The same for an operator that is kept sparse, and its clone. */
TEST(failures_of_a_sparse_group)
{
    int status = TRIBO_ERR_MEMORY;
    for (size_t fails = 1; status; fails++) {
        const long none = memory_live();
        tribo_context *c, *copy = NULL;
        assert_ok(tribo_create(&c, LARGEST));
        assert_ok(_i ? set_row(c, LARGEST) : TRIBO_OK);
        const long live = memory_live();
        memory_fail(fails);
        status = _i ? tribo_clone(c, &copy) : set_row(c, LARGEST);
        memory_fail(0);
        if (status) {
            assert_status(status, TRIBO_ERR_MEMORY);
            require(memory_live() == live, "leak when allocation %zu fails", fails);
        } else {
            require(fails > (_i ? 2 : 15), "only %zu allocations", fails); /* a copy shares the operator */
        }
        tribo_destroy(copy);
        tribo_destroy(c);
        require(memory_live() == none, "%ld blocks left behind", memory_live() - none);
    }
}

/* Refused operators leave nothing behind either. */
TEST(refusals)
{
    const size_t bad_col[] = {0, 1, 1, 1, 2};
    const double skew[] = {1.0, 0.5, 0.25, 0.5, 1.0, 0.5, 0.25, 0.125, 1.0};
    const double indefinite[] = {1.0, -0.75, -0.75, -0.75, 1.0, -0.75, -0.75, -0.75, 1.0};
    const long none = memory_live();
    tribo_context *c = set_up();
    const long live = memory_live();
    assert_status(tribo_set_operator_csr(c, first, bad_col, val), TRIBO_ERR_DUPLICATE);
    assert_status(tribo_set_operator_mass(c, 3, weight, first, bad_col, val), TRIBO_ERR_DUPLICATE);
    assert_status(tribo_set_operator_dense(c, skew), TRIBO_ERR_NOT_SYMMETRIC);
    assert_status(tribo_set_operator_dense(c, indefinite), TRIBO_ERR_INDEFINITE);
    require(memory_live() == live, "%ld blocks leak", memory_live() - live);
    tribo_destroy(c);
    require(memory_live() == none, "%ld blocks leak", memory_live() - none);
}

TEST_MAIN("allocation", {hot_paths, 24}, {come_and_go, 4}, {planar, 4}, {hot_paths_of_a_sparse_group, 2},
          {failures, COUNT(calls)}, {failures_of_a_sparse_group, 2}, {refusals, 1})
