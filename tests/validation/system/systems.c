/* SPDX-License-Identifier: BSD-3-Clause */
/* The reference systems' equations of motion, as the paper writes them; sizes, and errors of everything about systems. */
#include <stdlib.h>
#include <string.h>

#include "model.h"

/* The context of a system with limits, and epsilon so wide that forces are not just signs. */
static tribo_context *widen(tribo_system *sys, double epsilon)
{
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), epsilon));
    return tribo_system_context(sys);
}

static void rate_of(tribo_system *sys, double t, const double *y, double *dydt)
{
    const gsl_odeiv2_system *ode = tribo_gsl_system(sys);
    ck_assert_int_eq(ode->function(t, y, dydt, ode->params), GSL_SUCCESS);
}

static double law_force(int law, double v, double feq, double limit, double epsilon)
{
    double f;
    assert_ok(tribo_law_eval(law, v, feq, limit, epsilon, &f, NULL, NULL, NULL));
    return f;
}

TEST(oscillator_equations)
{
    struct random g = random_of(_i);
    tribo_system *sys;
    assert_ok(tribo_system_oscillator(&sys, 0.7, 1.3, 0.9));
    widen(sys, 0.5);
    for (int k = 0; k < 100; k++) {
        const double t = uniform(&g, 0.0, 9.0), y[3] = {uniform(&g, -2.0, 2.0), uniform(&g, -0.5, 0.5), 3.0};
        const double load = 1.3 * sin(0.9 * t), feq = y[0] - load, f = law_force(TRIBO_QUINN, y[1], feq, 0.7, 0.5);
        const double want[3] = {y[1], load - y[0] + f, -f * y[1]};
        double got[3], contact[3];
        rate_of(sys, t, y, got);
        assert_all_close(got, want, 3, 1e-15);
        assert_ok(tribo_system_contacts(sys, t, y, contact, contact + 1, contact + 2));
        assert_exact(contact[0], y[1]);
        assert_close(contact[1], feq, 1e-15);
        assert_close(contact[2], f, 1e-15);
    }
    tribo_system_destroy(sys);
}

#define BLOCKS 5

/* Of a block's mass and friction in the paper's equations, what it has itself: the last equation is 4/3 of a symmetric one. */
static double part(size_t i)
{
    return (i + 1 < BLOCKS ? 1.0 : 0.75) / BLOCKS;
}

/* Block i's balance without friction, times n: what f_eq has to hold. */
static double elastic(const double *u, size_t i, double load)
{
    const double n = BLOCKS;
    if (i == 0) {
        return n * (n * (u[0] - u[1]) - load);
    }
    if (i == BLOCKS - 1) {
        return n * n * (-4.0 / 3.0 * u[i - 1] + 4.0 * u[i]);
    }
    return n * n * (-u[i - 1] + 2.0 * u[i] - u[i + 1]);
}

TEST(chain_equations)
{
    struct random g = random_of(_i);
    tribo_system *sys;
    assert_ok(tribo_system_chain(&sys, BLOCKS, 0.7, 0.25, 0.5));
    widen(sys, 0.5);
    for (int k = 0; k < 100; k++) {
        const double t = uniform(&g, 0.0, 9.0), load = 0.25 * sin(0.5 * t);
        double y[2 * BLOCKS + 1], got[2 * BLOCKS + 1], want[2 * BLOCKS + 1], feq[BLOCKS], f[BLOCKS], force[BLOCKS];
        want[2 * BLOCKS] = y[2 * BLOCKS] = 0.0;
        for (size_t i = 0; i < 2 * BLOCKS; i++) {
            y[i] = uniform(&g, -0.1, 0.1) * (i < BLOCKS ? 1.0 : 5.0);
        }
        for (size_t i = 0; i < BLOCKS; i++) {
            const double u = y[BLOCKS + i], hold = elastic(y, i, load);
            f[i] = law_force(TRIBO_QUINN, u, hold, 0.7, 0.5);
            want[i] = u;
            want[BLOCKS + i] = f[i] - hold;
            want[2 * BLOCKS] -= f[i] * u / BLOCKS;
        }
        rate_of(sys, t, y, got);
        assert_all_close(got, want, 2 * BLOCKS + 1, 2e-14);
        assert_ok(tribo_system_contacts(sys, t, y, NULL, feq, force));
        for (size_t i = 0; i < BLOCKS; i++) {
            assert_close(feq[i], part(i) * elastic(y, i, load), 2e-14);
            assert_close(force[i], part(i) * f[i], 2e-14);
        }
    }
    tribo_system_destroy(sys);
}

TEST(chain_settings)
{
    tribo_system *sys;
    double limit[BLOCKS];
    assert_ok(tribo_system_chain(&sys, BLOCKS, 0.7, 0.25, 0.5));
    assert_ok(tribo_get_limit(tribo_system_context(sys), limit));
    for (size_t i = 0; i < BLOCKS; i++) {
        assert_close(limit[i], 0.7 * part(i), 1e-16);
    }
    /* a load is a force, as on any structure */
    double y[2 * BLOCKS + 1] = {0.0}, rate[2 * BLOCKS + 1];
    const double pull[BLOCKS] = {[BLOCKS - 2] = 7.0, [BLOCKS - 1] = 3.0};
    assert_ok(tribo_system_clear_loads(sys));
    assert_ok(tribo_system_add_load(sys, 0.0, pull, NULL));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.0));
    rate_of(sys, 0.0, y, rate);
    assert_close(rate[2 * BLOCKS - 2], 7.0 / part(BLOCKS - 2), 1e-13);
    assert_close(rate[2 * BLOCKS - 1], 3.0 / part(BLOCKS - 1), 1e-13);
    tribo_system_destroy(sys);
}

/* The ways that blocks have slid, all and that of the last one. */
struct way {
    double before[BLOCKS], all, last;
};

static int measure(const tribo_moment *moment, void *data)
{
    const double *y = moment->y;
    struct way *way = data;
    for (size_t i = 0; i < BLOCKS; i++) {
        way->all += fabs(y[i] - way->before[i]);
    }
    way->last += fabs(y[BLOCKS - 1] - way->before[BLOCKS - 1]);
    memcpy(way->before, y, sizeof way->before);
    return 0;
}

/* The paper's D is (1/n) mu N times the ways of all blocks alike, also where the last one slides. */
TEST(chain_dissipation)
{
    static const struct {
        const char *name;
        double dt, tolerance, off;
    } methods[] = {{"exact", 1.0, 0.0, 1e-13},        {"event", 1.0, 1e-12, 1e-10},   {"central/fixed", 1e-3, 0.0, 2e-3},
                   {"moreau/fixed", 1e-3, 0.0, 2e-3}, {"rk4/fixed", 1e-3, 0.0, 2e-3}, {"rk4imp", 1e-3, 1e-6, 2e-3}};
    double t = 0.0, y[2 * BLOCKS + 1] = {0.0};
    struct way way = {{0.0}, 0.0, 0.0};
    tribo_system *sys;
    assert_ok(tribo_system_chain(&sys, BLOCKS, 0.7, 2.5, 0.5));
    widen(sys, 1e-3);
    tribo_driver *drv = driver_create(sys, methods[_i].name, methods[_i].dt, methods[_i].tolerance);
    assert_ok(tribo_driver_set_observer(drv, measure, &way));
    driver_advance(drv, &t, 8.0 * PI, y);
    require(way.last > 0.03 * way.all, "the last block slides %g of %g", way.last, way.all);
    assert_close(y[2 * BLOCKS] / (0.7 / BLOCKS * way.all), 1.0, methods[_i].off);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Eq. 7: v = (x1' - U, x2' - x1'), and R = [[1, -1], [-1, 2]] and a = (-x1 - U', x1 - kappa x2) give f_eq of the partition where
 * both are near stick. */
TEST(belt_equations)
{
    struct random g = random_of(_i);
    tribo_system *sys;
    assert_ok(tribo_system_belt(&sys, 2.0, 0.5, 0.25, 1.5, 0.5));
    assert_ok(tribo_set_coupling(widen(sys, 9.0), TRIBO_PARTITION));
    for (int k = 0; k < 100; k++) {
        const double t = uniform(&g, 0.0, 9.0), u = 1.5 * sin(0.5 * t), du = 0.75 * cos(0.5 * t);
        double y[5], got[5], v[2], feq[2], f[2];
        for (size_t i = 0; i < 5; i++) {
            y[i] = uniform(&g, -1.0, 1.0);
        }
        const double a[2] = {-y[0] - du, y[0] - 2.0 * y[1]};
        rate_of(sys, t, y, got);
        assert_ok(tribo_system_contacts(sys, t, y, v, feq, f));
        const double moves[2] = {y[2] - u, y[3] - y[2]};
        const double want[5] = {y[2], y[3], -y[0] + f[0] - f[1], -2.0 * y[1] + f[1], -f[0] * v[0] - f[1] * v[1]};
        assert_all_close(v, moves, 2, 1e-15);
        assert_all_close(got, want, 5, 1e-14);
        assert_close(feq[0] - feq[1] + a[0], 0.0, 1e-13);
        assert_close(-feq[0] + 2.0 * feq[1] + a[1], 0.0, 1e-13);
        assert_close(f[0], law_force(TRIBO_QUINN, v[0], feq[0], 0.5, 9.0), 1e-15);
        assert_close(f[1], law_force(TRIBO_QUINN, v[1], feq[1], 0.25, 9.0), 1e-15);
    }
    tribo_system_destroy(sys);
}

/* With O(n^2) memory or work this would not end. */
TEST(long_chain)
{
    const size_t n = 300000;
    tribo_system *sys;
    assert_ok(tribo_system_chain(&sys, n, 1e-3, 0.25, 0.5));
    double *y = calloc(2 * n + 1, sizeof *y);
    widen(sys, 1e-5);
    run(sys, "rk4/fixed", 1e-6, 0.0, 1e-5, y);
    ck_assert_double_gt(y[0], 0.0);
    free(y);
    tribo_system_destroy(sys);
}

TEST(sizes)
{
    tribo_system *sys;
    assert_ok(tribo_system_chain(&sys, 7, 1.0, 0.25, 0.5));
    ck_assert_uint_eq(tribo_system_ndof(sys), 7);
    ck_assert_uint_eq(tribo_system_ncontact(sys), 7);
    ck_assert_uint_eq(tribo_system_dimension(sys), 15);
    ck_assert_uint_eq(tribo_gsl_system(sys)->dimension, 15);
    tribo_system_destroy(sys);
    ck_assert_uint_eq(tribo_system_ndof(NULL), 0);
    ck_assert_uint_eq(tribo_system_ncontact(NULL), 0);
    ck_assert_uint_eq(tribo_system_dimension(NULL), 0);
    ck_assert_ptr_null(tribo_system_context(NULL));
    ck_assert_ptr_null(tribo_gsl_system(NULL));
    tribo_system_destroy(NULL);
}

/* For other people's drivers: the memory of the reversal law advances with the states that they accept. */
TEST(acceptance)
{
    const double fast[3] = {0.0, 5.0, 0.0}, rest[3] = {3.0, 0.0, 0.0}, slow[3] = {0.5, 0.0, 0.0};
    double f;
    tribo_system *sys = oscillator(TRIBO_QUINN_REVERSAL, 0.0, 1.0);
    widen(sys, 0.1);
    assert_ok(tribo_system_contacts(sys, 0.0, rest, NULL, NULL, &f));
    assert_exact(f, 1.0);
    assert_ok(tribo_system_accept(sys, 0.0, fast));
    assert_ok(tribo_system_contacts(sys, 0.0, rest, NULL, NULL, &f));
    assert_close(f, 3.0 - 4.0 * log(2.0), 1e-14); /* g(3) */
    assert_ok(tribo_system_accept(sys, 0.0, slow));
    assert_ok(tribo_system_contacts(sys, 0.0, rest, NULL, NULL, &f));
    assert_exact(f, 1.0);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------------------ errors */

TEST(creation_errors)
{
    tribo_system *sys;
    stain(&sys, sizeof sys);
    const double huge = HUGE_VAL;
    const struct {
        int got, want;
    } cases[] = {
        {tribo_system_oscillator(NULL, 1, 1, 1), TRIBO_ERR_NULL},
        {tribo_system_oscillator(&sys, NAN, 1, 1), TRIBO_ERR_NOT_FINITE},
        {tribo_system_oscillator(&sys, -1, 1, 1), TRIBO_ERR_NEGATIVE},
        {tribo_system_oscillator(&sys, 1, huge, 1), TRIBO_ERR_NOT_FINITE},
        {tribo_system_oscillator(&sys, 1, 1, NAN), TRIBO_ERR_NOT_FINITE},
        {tribo_system_chain(NULL, 4, 1, 1, 1), TRIBO_ERR_NULL},
        {tribo_system_chain(&sys, 0, 1, 1, 1), TRIBO_ERR_SIZE},
        {tribo_system_chain(&sys, 1, 1, 1, 1), TRIBO_ERR_SIZE},
        {tribo_system_chain(&sys, SIZE_MAX, 1, 1, 1), TRIBO_ERR_SIZE},
        {tribo_system_chain(&sys, 4, -1, 1, 1), TRIBO_ERR_NEGATIVE},
        {tribo_system_chain(&sys, 4, huge, 1, 1), TRIBO_ERR_NOT_FINITE},
        {tribo_system_chain(&sys, 4, 1, NAN, 1), TRIBO_ERR_NOT_FINITE},
        {tribo_system_chain(&sys, 4, 1, 1, huge), TRIBO_ERR_NOT_FINITE},
        {tribo_system_belt(NULL, 2, 1, 1, 1, 1), TRIBO_ERR_NULL},
        {tribo_system_belt(&sys, NAN, 1, 1, 1, 1), TRIBO_ERR_NOT_FINITE},
        {tribo_system_belt(&sys, 2, -1, 1, 1, 1), TRIBO_ERR_NEGATIVE},
        {tribo_system_belt(&sys, 2, 1, NAN, 1, 1), TRIBO_ERR_NOT_FINITE},
        {tribo_system_belt(&sys, 2, 1, 1, huge, 1), TRIBO_ERR_NOT_FINITE},
        {tribo_system_belt(&sys, 2, 1, 1, 1, NAN), TRIBO_ERR_NOT_FINITE},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        require(cases[i].got == cases[i].want, "case %zu: %d, not %d", i, cases[i].got, cases[i].want);
    }
    ck_assert(stained(&sys, sizeof sys));
}

#define REFUSED(status, text, call)                                                                                              \
    do {                                                                                                                         \
        assert_status(call, status);                                                                                             \
        assert_says(tribo_system_message(sys), text);                                                                            \
    } while (0)

TEST(load_errors)
{
    struct random g = random_of(_i);
    const struct model m = model_create(&g, 1);
    double bad[DOFS] = {0}, before[DIMENSION], after[DIMENSION], y[DIMENSION];
    tribo_system *sys = model_system(&m, 1, 0, 0.1);
    for (size_t i = 0; i < DIMENSION; i++) {
        y[i] = uniform(&g, -1.0, 1.0);
    }
    rate_of(sys, 0.3, y, before);
    bad[2] = NAN;
    REFUSED(TRIBO_ERR_NOT_FINITE, "cosine[2] = nan", tribo_system_add_load(sys, 1.0, bad, NULL));
    REFUSED(TRIBO_ERR_NOT_FINITE, "sine[2] = nan", tribo_system_add_load(sys, 1.0, NULL, bad));
    REFUSED(TRIBO_ERR_NOT_FINITE, "omega = inf", tribo_system_add_load(sys, HUGE_VAL, NULL, m.load[0]));
    REFUSED(TRIBO_ERR_NOT_FINITE, "cosine[2] = nan", tribo_system_add_base_motion(sys, 1.0, bad, NULL));
    REFUSED(TRIBO_ERR_NOT_FINITE, "sine[2] = nan", tribo_system_add_base_motion(sys, 1.0, NULL, bad));
    REFUSED(TRIBO_ERR_NOT_FINITE, "omega = nan", tribo_system_add_base_motion(sys, NAN, NULL, m.motion[0]));
    assert_status(tribo_system_add_load(NULL, 1.0, m.load[0], NULL), TRIBO_ERR_NULL);
    assert_status(tribo_system_add_base_motion(NULL, 1.0, m.motion[0], NULL), TRIBO_ERR_NULL);
    assert_ok(tribo_system_add_load(sys, 1.0, NULL, NULL));
    rate_of(sys, 0.3, y, after);
    assert_all_exact(after, before, DIMENSION);
    tribo_system_destroy(sys);
}

/* Harmonics add up, also at a time for which those before have been evaluated. */
TEST(loads_add_up)
{
    struct random g = random_of(_i);
    const struct model m = model_create(&g, 0);
    const double y[DIMENSION] = {0};
    double before[DIMENSION], after[DIMENSION];
    tribo_system *sys = model_system(&m, 1, 0, 0.1);
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.0));
    rate_of(sys, 0.3, y, before);
    assert_ok(tribo_system_add_load(sys, 2.0, m.load[0], m.load[1]));
    rate_of(sys, 0.3, y, after);
    for (size_t i = 0; i < DOFS; i++) {
        const double load = m.load[0][i] * cos(0.6) + m.load[1][i] * sin(0.6);
        assert_close(after[DOFS + i] - before[DOFS + i], load / m.mass[i * (DOFS + 1)], 1e-13);
    }
    tribo_system_destroy(sys);
}

TEST(state_errors)
{
    double good[3] = {0.0, 0.1, 0.0}, bad[3] = {0.0, 0.0, HUGE_VAL}, v, feq, f;
    tribo_system *sys = oscillator(TRIBO_QUINN_REVERSAL, 1.0, 1.0);
    stain(&v, sizeof v), stain(&feq, sizeof feq), stain(&f, sizeof f);
    REFUSED(TRIBO_ERR_NULL, "y is NULL", tribo_system_contacts(sys, 0.0, NULL, &v, &feq, &f));
    REFUSED(TRIBO_ERR_NOT_FINITE, "t = nan", tribo_system_contacts(sys, NAN, good, &v, &feq, &f));
    REFUSED(TRIBO_ERR_NOT_FINITE, "y[2] = inf", tribo_system_contacts(sys, 0.0, bad, &v, &feq, &f));
    REFUSED(TRIBO_ERR_NULL, "y is NULL", tribo_system_accept(sys, 0.0, NULL));
    REFUSED(TRIBO_ERR_NOT_FINITE, "y[2] = inf", tribo_system_accept(sys, 0.0, bad));
    assert_status(tribo_system_contacts(NULL, 0.0, good, &v, &feq, &f), TRIBO_ERR_NULL);
    assert_status(tribo_system_accept(NULL, 0.0, good), TRIBO_ERR_NULL);
    ck_assert(stained(&v, sizeof v) && stained(&feq, sizeof feq) && stained(&f, sizeof f));
    tribo_system_destroy(sys);
}

/* The operator of a system's context is the system's; that of a copy is not. */
TEST(operator_of_a_system)
{
    const double twice = 2.0, y[3] = {0.1, 0.0, 0.0}, v = 0.0, a = -0.1;
    double before, after;
    tribo_system *sys = oscillator(TRIBO_QUINN, 0.0, 1.0);
    tribo_context *copy, *lent = tribo_system_context(sys);
    assert_ok(tribo_system_contacts(sys, 0.0, y, NULL, NULL, &before));
    assert_status(tribo_set_operator_diagonal(lent, &twice), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_message(lent), "the operator is fixed, as that of a tribo_system is");
    assert_ok(tribo_system_contacts(sys, 0.0, y, NULL, NULL, &after));
    assert_exact(after, before);
    assert_exact(after, 0.1);
    assert_ok(tribo_clone(tribo_system_context(sys), &copy));
    assert_ok(tribo_set_operator_diagonal(copy, &twice));
    assert_ok(tribo_balance(copy, &v, &a, NULL, &after));
    assert_exact(after, 0.05);
    tribo_destroy(copy);
    tribo_system_destroy(sys);
}

/* What only reduced systems have. */
TEST(unreduced)
{
    double x[3] = {1.0, 1.0, 1.0};
    tribo_system *sys = oscillator(TRIBO_QUINN, 1.0, 1.0);
    REFUSED(TRIBO_ERR_UNSUPPORTED, "not reduced", tribo_system_set_damping_ratio(sys, 0.1));
    REFUSED(TRIBO_ERR_UNSUPPORTED, "not reduced", tribo_system_get_frequencies(sys, x));
    REFUSED(TRIBO_ERR_UNSUPPORTED, "not reduced", tribo_system_expand(sys, x, x + 1));
    assert_status(tribo_system_set_damping_ratio(NULL, 0.1), TRIBO_ERR_NULL);
    assert_status(tribo_system_get_frequencies(NULL, x), TRIBO_ERR_NULL);
    assert_status(tribo_system_expand(NULL, x, x + 1), TRIBO_ERR_NULL);
    assert_exact(x[0], 1.0);
    tribo_system_destroy(sys);
}

TEST(reduced)
{
    struct random g = random_of(_i);
    const struct model m = model_create(&g, 1);
    double x[DOFS];
    tribo_system *sys = model_system(&m, 0, 2, 0.1);
    REFUSED(TRIBO_ERR_NOT_FINITE, "zeta = nan", tribo_system_set_damping_ratio(sys, NAN));
    REFUSED(TRIBO_ERR_NEGATIVE, "zeta = -0.5", tribo_system_set_damping_ratio(sys, -0.5));
    REFUSED(TRIBO_ERR_NULL, "omega is NULL", tribo_system_get_frequencies(sys, NULL));
    REFUSED(TRIBO_ERR_NULL, "reduced is NULL", tribo_system_expand(sys, NULL, x));
    REFUSED(TRIBO_ERR_NULL, "full is NULL", tribo_system_expand(sys, m.load[0], NULL));
    tribo_system_destroy(sys);
}

TEST_MAIN("systems", {oscillator_equations, 2}, {chain_equations, 2}, {chain_settings, 1}, {chain_dissipation, 6},
          {belt_equations, 2}, {long_chain, 1}, {sizes, 1}, {acceptance, 1}, {creation_errors, 1}, {load_errors, 1},
          {loads_add_up, 2}, {state_errors, 1}, {operator_of_a_system, 1}, {unreduced, 1}, {reduced, 1})
