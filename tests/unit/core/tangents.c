/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives of the coupled balance against differences, in random directions. */
#include <stdlib.h>
#include <string.h>

#include "problem.h"

#define STEP 1e-6

/* Three values. */
#define THREE(x, y, z) ((const double[]){x, y, z})

struct tangent {
    double f[LARGEST], dv[LARGEST * LARGEST], da[LARGEST * LARGEST];
};

/* How many of the components have no kink and no jump within the step; these are compared. */
static size_t check_direction(tribo_context *c, const struct problem *p, const struct tangent *t, const double *dv,
                              const double *da)
{
    double f[LARGEST], before[LARGEST], after[LARGEST];
    size_t smooth = 0;
    problem_forces(c, p, 0.0, dv, da, f);
    problem_forces(c, p, -STEP, dv, da, before);
    problem_forces(c, p, STEP, dv, da, after);
    assert_all_close(t->f, f, p->n, 1e-14);
    for (size_t i = 0; i < p->n; i++) {
        const double forward = (after[i] - f[i]) / STEP, backward = (f[i] - before[i]) / STEP;
        double want = 0.0, size = 1.0;
        for (size_t j = 0; j < p->n; j++) {
            const double terms[] = {t->dv[i * p->n + j] * dv[j], t->da[i * p->n + j] * da[j]};
            want += terms[0] + terms[1];
            size += fabs(terms[0]) + fabs(terms[1]);
        }
        /* 1e-9 from rounding; the smooth and reversal laws add STEP times a curvature of up to 100 */
        if (fabs(forward - backward) < 2e-4 * size) {
            assert_close(want, 0.5 * (forward + backward), 1e-6 * size);
            smooth++;
        }
    }
    return smooth;
}

/* 0: no static limits; 1: such that drop at once, if the law knows stick; 2: such that fall with speed. */
static void set_static(struct random *g, tribo_context *c, size_t n, int breaking)
{
    double ratio[LARGEST], velocity[LARGEST];
    int law;
    for (size_t i = 0; i < n; i++) {
        ratio[i] = uniform(g, 1.0, 2.0);
        velocity[i] = uniform(g, 0.5, 2.0);
    }
    assert_ok(tribo_get_law(c, &law));
    if (breaking == 2 || (breaking == 1 && law != TRIBO_VELOCITY_LIMITED && law != TRIBO_SMOOTH)) {
        assert_ok(tribo_set_static(c, ratio, breaking == 2 ? velocity : NULL));
    }
}

/* Problems in which epsilon, limits and R are of the order of 1. Odd contacts have the reversal memory set. */
static tribo_context *create(struct random *g, int law, int coupling, int breaking, struct problem *p)
{
    struct recipe recipe = recipe_regular(g, 12);
    recipe.resting = law == TRIBO_COULOMB ? 0.5 : 0.0; /* at rest and saturated, the other laws have a kink */
    *p = problem_create(g, &recipe);
    tribo_context *c = problem_context(p, law, coupling);
    double v[LARGEST], none[LARGEST] = {0};
    for (size_t i = 0; i < p->n; i++) {
        v[i] = i % 2 ? 9.0 : 0.0;
    }
    assert_ok(tribo_accept(c, v, none));
    set_static(g, c, p->n, breaking);
    return c;
}

TEST(tangents)
{
    struct random g = random_of(_i);
    const int law = _i % tribo_law_count(), coupling = _i / tribo_law_count() % 2, breaking = _i / tribo_law_count() / 2 % 3;
    size_t smooth = 0, all = 0;
    for (int k = 0; k < 10; k++) {
        struct problem p;
        struct tangent t;
        tribo_context *c = create(&g, law, coupling, breaking, &p);
        assert_ok(tribo_balance_tangent(c, p.v, p.a, NULL, t.f, t.dv, t.da));
        for (int way = 0; way < 4; way++) {
            double dv[LARGEST], da[LARGEST];
            for (size_t i = 0; i < p.n; i++) {
                /* Coulomb's law jumps at rest, with derivative 0: there only a moves */
                dv[i] = law == TRIBO_COULOMB || way == 1 ? 0.0 : uniform(&g, -1.0, 1.0);
                da[i] = way == 2 ? 0.0 : uniform(&g, -1.0, 1.0);
            }
            smooth += check_direction(c, &p, &t, dv, da);
            all += p.n;
        }
        tribo_destroy(c);
    }
    ck_assert_uint_gt(smooth, all * 95 / 100);
}

static void answer_apart(const tribo_context *c, const struct problem *p, double *feq, double *f, double *dv, double *da)
{
    tribo_context *copy; /* since forces found before show in the last digits */
    assert_ok(tribo_clone(c, &copy));
    assert_ok(tribo_balance_tangent(copy, p->v, p->a, feq, f, dv, da));
    tribo_destroy(copy);
}

/* Each output may be left out, and does not depend on the others. */
TEST(optional_outputs)
{
    struct random g = random_of(_i);
    struct problem p;
    struct tangent all, one;
    double feq[LARGEST], feq_alone[LARGEST];
    tribo_context *c = create(&g, TRIBO_QUINN_REVERSAL, _i % 2, 0, &p);
    answer_apart(c, &p, feq, all.f, all.dv, all.da);
    answer_apart(c, &p, NULL, NULL, one.dv, NULL);
    answer_apart(c, &p, NULL, NULL, NULL, one.da);
    answer_apart(c, &p, feq_alone, one.f, NULL, NULL);
    assert_all_exact(one.dv, all.dv, p.n * p.n);
    assert_all_exact(one.da, all.da, p.n * p.n);
    assert_all_exact(one.f, all.f, p.n);
    assert_all_exact(feq_alone, feq, p.n);
    assert_ok(tribo_balance(c, p.v, p.a, feq_alone, one.f));
    assert_all_exact(one.f, all.f, p.n);
    assert_all_exact(feq_alone, feq, p.n);
    tribo_destroy(c);
}

/* Uncoupled contacts: what tribo_force_tangent says, with f_eq = -a/R. */
TEST(uncoupled)
{
    struct random g = random_of(_i);
    const double r[] = {0.5, 2.0, 1.0}, limit[] = {1.0, 0.7, 0.0};
    double v[3], a[3], feq[3], f[3], dv[9], da[9], law_dv[3], law_dfeq[3];
    tribo_context *c;
    assert_ok(tribo_create(&c, 3));
    assert_ok(tribo_set_law(c, _i % tribo_law_count()));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_epsilon_all(c, 1.0));
    assert_ok(tribo_set_operator_diagonal(c, r));
    for (size_t i = 0; i < 3; i++) {
        v[i] = uniform(&g, -1.2, 1.2) * (double)below(&g, 2);
        a[i] = uniform(&g, -1.0, 1.0);
    }
    assert_ok(tribo_balance_tangent(c, v, a, feq, f, dv, da));
    assert_ok(tribo_force_tangent(c, v, feq, NULL, law_dv, law_dfeq, NULL));
    for (size_t k = 0; k < 9; k++) {
        const size_t i = k / 3;
        assert_exact(dv[k], k % 4 ? 0.0 : law_dv[i]);
        assert_exact(da[k], k % 4 || limit[i] == 0.0 ? 0.0 : -law_dfeq[i] / r[i]);
    }
    tribo_destroy(c);
}

/* Where friction moves nothing its force jumps as a changes its sign, and has no derivative but by v. */
TEST(immovable)
{
    const double r[] = {2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}, none[] = {0.0, 0.0, 0.0}, da[] = {1.0, 1e10, -1.0};
    for (int law = 0; law < tribo_law_count(); law++) {
        double f[3], dv[9], by_a[9];
        tribo_context *c;
        assert_ok(tribo_create(&c, 3));
        assert_ok(tribo_set_law(c, law));
        assert_ok(tribo_set_limit_all(c, 1.0));
        assert_ok(_i ? tribo_set_operator_diagonal(c, THREE(2.0, 0.0, 1.0)) : tribo_set_operator_dense(c, r));
        assert_ok(tribo_balance_tangent(c, none, none, NULL, f, dv, by_a));
        assert_exact(f[1], 0.0);
        for (size_t k = 0; k < 3; k++) {
            assert_exact(by_a[3 + k], 0.0);
            assert_exact(by_a[3 * k + 1], 0.0);
            assert_exact(dv[3 * k + 1], k == 1 ? dv[4] : 0.0);
        }
        assert_ok(tribo_tangent_product(c, NULL, da, f));
        assert_exact(f[1], 0.0);
        assert_exact(f[0], by_a[0]);
        assert_exact(f[2], -by_a[8]);
        tribo_destroy(c);
    }
}

/* An open contact has no derivatives, whatever epsilon is. */
TEST(tangents_of_open_contacts)
{
    const double r[] = {2.0, 1.0, 1.0, 2.0}, limit[] = {1.0, 0.0}, v[] = {0.0, 0.0}, a[] = {0.1, 0.1};
    const double want_dv[] = {-50.0, 0.0, 0.0, 0.0}, want_da[] = {-0.5, 0.0, 0.0, 0.0};
    double f[2], dv[4], da[4];
    tribo_context *c;
    assert_ok(tribo_create(&c, 2));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_epsilon_step(c, 0.01, 1.0));
    assert_ok(tribo_balance_tangent(c, v, a, NULL, f, dv, da));
    assert_all_close(dv, want_dv, 4, 1e-12);
    assert_all_close(da, want_da, 4, 1e-15);
    tribo_destroy(c);
}

/* The product is the matrices' product, for every law and coupling, groups and single contacts. */
TEST(product_of_tangents)
{
    struct random g = random_of(_i);
    const int law = _i % tribo_law_count(), coupling = _i / tribo_law_count() % 2;
    const struct recipe recipe = recipe_random(&g, USUAL, 0.3);
    const struct problem p = problem_create(&g, &recipe);
    const size_t n = p.n;
    double *dv = malloc(n * n * sizeof *dv), *da = malloc(n * n * sizeof *da), x[LARGEST], y[LARGEST], df[LARGEST];
    tribo_context *c = problem_context(&p, law, coupling);
    set_static(&g, c, p.n, _i / tribo_law_count() / 2 % 3);
    assert_status(tribo_tangent_product(c, p.v, p.a, df), TRIBO_ERR_STATE);
    const int status = tribo_balance_tangent(c, p.v, p.a, NULL, NULL, dv, da);
    if (status != TRIBO_ERR_INCONSISTENT) {
        assert_ok(status);
        for (size_t i = 0; i < n; i++) {
            x[i] = uniform(&g, -1.0, 1.0);
            y[i] = uniform(&g, -1.0, 1.0);
        }
        for (int part = 1; part < 4; part++) {
            assert_ok(tribo_tangent_product(c, part & 1 ? x : NULL, part & 2 ? y : NULL, df));
            for (size_t i = 0; i < n; i++) {
                double want = 0.0, size = 0.0;
                for (size_t j = 0; j < n; j++) {
                    const double terms[] = {part & 1 ? dv[i * n + j] * x[j] : 0.0, part & 2 ? da[i * n + j] * y[j] : 0.0};
                    want += terms[0] + terms[1];
                    size += fabs(terms[0]) + fabs(terms[1]);
                }
                assert_close(df[i], want, 1e-9 * size);
            }
        }
        assert_ok(tribo_set_limit(c, p.limit));
        assert_status(tribo_tangent_product(c, x, y, df), TRIBO_ERR_STATE);
        assert_says(tribo_message(c), "tribo_balance_tangent");
    }
    tribo_destroy(c);
    free(dv);
    free(da);
}

/* ------------------------------------------------------------------------------------------------------------ limits */

/* How many forces have no kink within the step; these are compared. */
static size_t check_limits(tribo_context *c, const struct problem *p, const double *dlimit)
{
    double f[LARGEST], df[LARGEST], before[LARGEST], after[LARGEST];
    size_t smooth = 0;
    assert_ok(tribo_balance_tangent(c, p->v, p->a, NULL, f, NULL, NULL));
    assert_ok(tribo_limit_product(c, dlimit, df));
    problem_forces_of_limits(c, p, -STEP, dlimit, before);
    problem_forces_of_limits(c, p, STEP, dlimit, after);
    for (size_t i = 0; i < p->n; i++) {
        const double forward = (after[i] - f[i]) / STEP, backward = (f[i] - before[i]) / STEP, size = 1.0 + fabs(df[i]);
        if (fabs(forward - backward) < 2e-4 * size) {
            assert_close(df[i], 0.5 * (forward + backward), 2e-6 * size);
            smooth++;
        }
    }
    return smooth;
}

/* Every law and coupling; epsilon that is given, and that follows the limits. */
TEST(limits)
{
    struct random g = random_of(_i);
    const int law = _i % tribo_law_count(), coupling = _i / tribo_law_count() % 2, follows = _i / tribo_law_count() / 2;
    size_t smooth = 0, all = 0;
    for (int k = 0; k < 20; k++) {
        struct problem p;
        double dlimit[LARGEST];
        tribo_context *c = create(&g, law, coupling, 0, &p);
        for (size_t i = 0; i < p.n; i++) {
            dlimit[i] = p.limit[i] > 0.0 ? uniform(&g, -1.0, 1.0) : 0.0;
        }
        if (follows) {
            assert_ok(tribo_set_epsilon_step(c, 1.0, 2.0));
        }
        smooth += check_limits(c, &p, dlimit);
        all += p.n;
        tribo_destroy(c);
    }
    ck_assert_uint_gt(smooth, all * 95 / 100);
}

/* Two masses pull at one rope: what one contact, which slides, carries more, the other, which holds, carries less. An open
 * contact stays open; and the product tells what it has not been asked for. */
TEST(limits_of_neighbours)
{
    const double r[] = {1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0}, limit[] = {0.3, 2.0, 0.0}, v[] = {1.0, 0.0, 0.0};
    const double a[] = {1.0, 1.0, 1.0}, one[] = {1.0, 0.0, 7.0};
    double df[3];
    tribo_context *c;
    assert_ok(tribo_create(&c, 3));
    assert_ok(tribo_set_epsilon_all(c, 0.1));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_status(tribo_limit_product(c, one, df), TRIBO_ERR_STATE);
    assert_ok(tribo_balance_tangent(c, v, a, NULL, NULL, NULL, NULL));
    assert_ok(tribo_limit_product(c, one, df));
    assert_all_close(df, THREE(-1.0, 1.0, 0.0), 3, 1e-15);
    assert_status(tribo_limit_product(c, THREE(0.0, NAN, 0.0), df), TRIBO_ERR_NOT_FINITE);
    assert_says(tribo_message(c), "dlimit[1] = nan");
    assert_status(tribo_limit_product(c, NULL, df), TRIBO_ERR_NULL);
    assert_status(tribo_limit_product(c, one, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_limit_product(NULL, one, df), TRIBO_ERR_NULL);
    assert_ok(tribo_set_limit(c, limit));
    assert_status(tribo_limit_product(c, one, df), TRIBO_ERR_STATE);
    tribo_destroy(c);
}

TEST_MAIN("tangents", {tangents, 72}, {optional_outputs, 6}, {uncoupled, 60}, {immovable, 2}, {tangents_of_open_contacts, 1},
          {product_of_tangents, 144}, {limits, 24}, {limits_of_neighbours, 1})
