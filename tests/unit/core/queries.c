/* SPDX-License-Identifier: BSD-3-Clause */
/* What a context tells of the last call: stick and slip of each contact, counts, rates and the largest step. */
#include <string.h>

#include "problem.h"

/* Forces found, with what comes along. */
struct answer {
    double feq[LARGEST], f[LARGEST];
};

TEST(modes)
{
    struct random g = random_of(_i);
    const struct recipe recipe = recipe_random(&g, USUAL, 0.5);
    const struct problem p = problem_create(&g, &recipe);
    struct answer x;
    const double none[LARGEST] = {0.0};
    signed char slip[LARGEST];
    size_t stuck = 0;
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
    stain(slip, sizeof slip);
    assert_status(tribo_get_slip(c, slip), TRIBO_ERR_STATE);
    ck_assert(stained(slip, sizeof slip));
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_STUCK), 0);
    for (int step = 0; step < 2; step++) {
        assert_ok(step ? tribo_step_force(c, 0.1, p.v, x.f) : tribo_balance(c, p.v, p.a, NULL, x.f));
        assert_ok(tribo_get_slip(c, slip));
        stuck = 0;
        for (size_t i = 0; i < p.n; i++) {
            const int slides = fabs(x.f[i]) == p.limit[i], want = p.limit[i] > 0.0 ? slides ? (int)-sgn(x.f[i]) : 0 : 2;
            require(slip[i] == want, "slip %d of contact %zu, f = %g of %g", slip[i], i, x.f[i], p.limit[i]);
            stuck += want == 0;
        }
        ck_assert_uint_eq(count_of(c, TRIBO_COUNT_STUCK), stuck);
        /* a call that is refused changes nothing; another operator or forces in a box of the caller's own leave no modes */
        assert_status(tribo_balance(c, NULL, p.a, NULL, x.f), TRIBO_ERR_NULL);
        assert_ok(tribo_get_slip(c, slip));
        assert_ok(step ? tribo_set_operator_dense(c, p.r) : tribo_solve_box(c, p.a, none, none, x.f));
        stain(slip, sizeof slip);
        assert_status(tribo_get_slip(c, slip), TRIBO_ERR_STATE);
        ck_assert(stained(slip, sizeof slip));
        ck_assert_uint_eq(count_of(c, TRIBO_COUNT_STUCK), 0);
    }
    tribo_destroy(c);
}

/* The smooth law never reaches its limit; where it gives less than N tanh(1) the contact counts as stuck. */
TEST(modes_of_the_smooth_law)
{
    const double v[] = {0.5, -0.99, 1.01, -7.0}, rest[] = {0.0, 0.0, 0.0, 0.0}, unit[] = {1.0, 1.0, 1.0, 1.0};
    const signed char want[] = {0, 0, 1, -1};
    signed char slip[4];
    tribo_context *c;
    assert_ok(tribo_create(&c, 4));
    assert_ok(tribo_set_law(c, TRIBO_SMOOTH));
    assert_ok(tribo_set_operator_diagonal(c, unit));
    assert_ok(tribo_set_limit_all(c, 2.0));
    assert_ok(tribo_set_epsilon_all(c, 1.0));
    assert_ok(tribo_balance(c, v, rest, NULL, NULL));
    assert_ok(tribo_get_slip(c, slip));
    ck_assert_mem_eq(slip, want, sizeof want);
    tribo_destroy(c);
}

/* Islands {0, 2}, {1}, {3, 4} and the open contact {5}; 3 and 4 are the same contact twice. */
static const struct problem islands = {
    .n = 6,
    .r = {2, 0, 1, 0, 0, 0, /**/ 0, 1, 0, 0, 0, 0, /**/ 1, 0, 2, 0, 0, 0,
          0, 0, 0, 1, 1, 0, /**/ 0, 0, 0, 1, 1, 0, /**/ 0, 0, 0, 0, 0, 1},
    .limit = {1, 1, 1, 1, 1, 0},
    .epsilon = {1, 1, 1, 1, 1, 1},
};

TEST(counts)
{
    struct problem p = islands;
    tribo_context *c = problem_context(&p, TRIBO_QUINN, _i);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_ISLANDS), 4);
    /* nobody moves but the open contact: the groups of two are solved, with ranks 2 and 1; single contacts need no solver */
    p.v[5] = 5.0;
    assert_ok(tribo_balance(c, p.v, p.a, NULL, NULL));
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_SOLVES), 2);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_SKIPPED), 2);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_RANK), 3);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_STUCK), 5);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_FACTORIZATIONS), 2);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_REUSED), 0);
    /* 0 and 1 slide: {0, 2}, for contact 2, and {3, 4} are solved, the latter with what is there */
    p.v[0] = p.v[1] = 2.0;
    assert_ok(tribo_balance(c, p.v, p.a, NULL, NULL));
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_SOLVES), 4);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_SKIPPED), 4);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_RANK), 2);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_STUCK), 3);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_FACTORIZATIONS), 3);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_REUSED), 1);
    /* the step force asks every contact that is closed */
    assert_ok(tribo_step_force(c, 0.1, p.v, p.a));
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_SOLVES), 6);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_SKIPPED), 6);
    tribo_destroy(c);
}

/* Pulled hard, then let go: the stick set has to change, and is counted. */
TEST(updates)
{
    struct problem p = twins;
    struct answer x;
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
    assert_ok(tribo_balance(c, p.v, p.a, x.feq, x.f));
    for (int k = 0; k < 20; k++) {
        p.a[2] = k % 2 ? 40.0 : 0.1;
        p.a[0] = p.a[1] = k % 3 ? -25.0 : 1.0;
        assert_ok(tribo_balance(c, p.v, p.a, x.feq, x.f));
    }
    ck_assert_uint_gt(count_of(c, TRIBO_COUNT_UPDATES), 0);
    tribo_destroy(c);
}

/* The bound on lambda holds for the largest eigenvalue of R diag(2N/epsilon), which a power iteration finds; in the consistent
 * coupling every contact has its own rate. */
TEST(rates)
{
    struct random g = random_of(_i);
    const struct recipe recipe = recipe_regular(&g, 20);
    const struct problem p = problem_create(&g, &recipe);
    double own = 0.0, x[LARGEST], y[LARGEST], length = 0.0;
    for (size_t i = 0; i < p.n; i++) {
        own = fmax(own, 2.0 * p.limit[i] / p.epsilon[i] * p.r[i * p.n + i]);
        x[i] = 1.0 + 0.1 * (double)i;
    }
    for (int k = 0; k < 500; k++) {
        length = 0.0;
        for (size_t i = 0; i < p.n; i++) {
            y[i] = 0.0;
            for (size_t j = 0; j < p.n; j++) {
                y[i] += p.r[i * p.n + j] * 2.0 * p.limit[j] / p.epsilon[j] * x[j];
            }
            length = fmax(length, fabs(y[i]));
        }
        for (size_t i = 0; i < p.n; i++) {
            x[i] = y[i] / length;
        }
    }
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
    assert_close(real_of(c, TRIBO_REAL_MAX_RATE), own, 4.0 * DBL_EPSILON * own);
    assert_close(real_of(c, TRIBO_REAL_MAX_STEP), 2.785 / own, 4.0 * DBL_EPSILON / own);
    assert_ok(tribo_set_coupling(c, TRIBO_PARTITION));
    ck_assert_double_ge(real_of(c, TRIBO_REAL_MAX_RATE), length * (1.0 - 1e-9));
    assert_ok(tribo_set_law(c, TRIBO_SMOOTH));
    ck_assert_double_ge(real_of(c, TRIBO_REAL_MAX_RATE), 0.5 * length * (1.0 - 1e-9));
    assert_ok(tribo_set_law(c, TRIBO_KARNOPP));
    assert_exact(real_of(c, TRIBO_REAL_MAX_RATE), 0.0);
    assert_exact(real_of(c, TRIBO_REAL_MAX_STEP), HUGE_VAL);
    tribo_destroy(c);
}

/* Operators of the belt of the paper, of stacks of bodies, and of bodies that many contacts join, all of full rank; and how close
 * to the edge of stability the largest step is. */
static struct problem scene_of(int which, double *tight)
{
    const size_t sizes[] = {2, 2, 3, 6, 24, 7};
    struct problem p = {.n = sizes[which]};
    *tight = which < 2 ? 1.001 : which < 5 ? 1.03 : 1.1;
    for (size_t i = 0; i < p.n; i++) {
        p.limit[i] = p.epsilon[i] = 1.0;
        p.r[i * p.n + i] = which == 1 ? 1.0 + 0.5 * (double)i : i ? 2.0 : 1.0;
        for (size_t j = 0; j < i; j++) {
            const double all = which == 5 ? 0.4 + 0.01 * (double)(i * j % 7) : 0.0;
            p.r[i * p.n + j] = p.r[j * p.n + i] = which < 5 && j + 1 == i ? -1.0 : all;
        }
    }
    return p;
}

/* Largest |v| after many steps of rk4 from random velocities in the band; nothing else pulls. */
static double after_steps(struct random *g, tribo_context *c, const struct problem *p, double dt)
{
    static const double part[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
    double v[LARGEST], at[LARGEST], f[LARGEST], rate[LARGEST], sum[LARGEST], most = 0.0;
    for (size_t i = 0; i < p->n; i++) {
        v[i] = uniform(g, -0.3, 0.3);
    }
    for (int step = 0; step < 4000; step++) {
        memset(sum, 0, sizeof sum);
        for (size_t stage = 0; stage < 4; stage++) {
            for (size_t i = 0; i < p->n; i++) {
                at[i] = v[i] + (stage ? part[stage] * dt * rate[i] : 0.0);
            }
            assert_ok(tribo_balance(c, at, p->a, NULL, f));
            for (size_t i = 0; i < p->n; i++) {
                rate[i] = (double)acceleration(p, i, f);
                sum[i] += weight[stage] * rate[i];
            }
        }
        for (size_t i = 0; i < p->n; i++) {
            v[i] += dt / 6.0 * sum[i];
        }
    }
    for (size_t i = 0; i < p->n; i++) {
        most = fmax(most, fabs(v[i]));
    }
    return most;
}

/* The largest step is one at which contacts come to rest, and not much too small. */
TEST(largest_steps)
{
    const int laws[] = {TRIBO_QUINN, TRIBO_QUINN, TRIBO_VELOCITY_LIMITED, TRIBO_SMOOTH};
    struct random g = random_of(_i);
    double tight;
    const struct problem p = scene_of(_i / 4, &tight);
    tribo_context *c = problem_context(&p, laws[_i % 4], _i % 4 == 1 ? TRIBO_PARTITION : TRIBO_CONSISTENT);
    assert_ok(tribo_set_epsilon_step(c, 1.0, 1.0));
    if (_i % 4 == 0) {
        tight = 1.001;
    }
    const double dt = real_of(c, TRIBO_REAL_MAX_STEP), rest = after_steps(&g, c, &p, 0.99 * dt),
                 moves = after_steps(&g, c, &p, 1.01 * tight * dt);
    require(rest < 1e-3, "|v| is %g at %g", rest, 0.99 * dt);
    require(moves > 1e-3, "|v| is %g at %g", moves, 1.01 * tight * dt);
    tribo_destroy(c);
}

TEST_MAIN("queries", {modes, 40}, {modes_of_the_smooth_law, 1}, {counts, 2}, {updates, 1}, {rates, 20}, {largest_steps, 24})
