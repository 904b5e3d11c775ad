/* SPDX-License-Identifier: BSD-3-Clause */
/* Methods "central/fixed" and "moreau/fixed": second order, an energy balance of the discrete motion that closes to rounding,
 * exact stick, and nothing that depends on epsilon. */
#include <stdlib.h>
#include <string.h>

#include "make.h"
#include "coulomb.h"
#include "model.h"

static const char *const methods[] = {"central/fixed", "moreau/fixed"};

/* -------------------------------------------------------------------------------------------------------------- accuracy */

/* Where contacts stick, second order; a step of which a contact reverses without stick is taken for one of stick, and the error
 * falls with dt only: 7b. Orders over a factor of 100; errors jump with where the steps are. The chain is stable to 0.0291. */
TEST(orders)
{
    const double dt[] = {0.029, 0.01, 0.003, 0.001, 0.0003}, least[] = {1.7, 0.7, 0.7, 1.7, 1.7, 1.7, 1.7};
    const struct reference *r = &references[_i % REFERENCES];
    double error[COUNT(dt)];
    for (size_t k = 0; k < COUNT(dt); k++) {
        error[k] = reference_error(r, methods[_i / REFERENCES], dt[k], 0.0, NULL);
    }
    const double order = order_of(dt, error, COUNT(dt));
    require(order >= least[_i % REFERENCES], "%s, %s: order %.2f, errors %.2g to %.2g", r->name, methods[_i / REFERENCES], order,
            error[0], error[COUNT(dt) - 1]);
}

/* Errors seen with other codes, to two digits; the first lines are settings for errors of 1e-4. */
static const struct {
    int reference, method;
    double dt, error;
} seen[] = {
    {0, 0, 0.04, 1e-4},   {3, 0, 0.003, 1e-4},   {4, 0, 0.02, 1e-4},   {0, 1, 0.04, 1e-4},    {4, 1, 0.015, 1e-4},
    {3, 0, 0.01, 8.2e-4}, {3, 0, 0.001, 5.2e-6}, {4, 1, 0.01, 2.6e-5}, {4, 1, 0.001, 2.8e-7},
};

TEST(errors_seen)
{
    const double error = reference_error(&references[seen[_i].reference], methods[seen[_i].method], seen[_i].dt, 0.0, NULL);
    require(error <= 1.05 * seen[_i].error, "%s, %s, dt %g: %.3g", references[seen[_i].reference].name, methods[seen[_i].method],
            seen[_i].dt, error);
}

/* One evaluation a step, and central's velocity at the end takes one more. */
TEST(counts)
{
    double t = 0.0, y[3] = {0};
    tribo_system *sys = oscillator(TRIBO_QUINN, 1.5, 0.5);
    tribo_driver *drv = driver_create(sys, methods[_i], 0.25, 0.0);
    driver_advance(drv, &t, 25.0, y);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_STEPS), 100);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_EVALUATIONS), _i ? 100 : 101);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_EVENTS), 0);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* -------------------------------------------------------------------------------------------------------------- energy */

/* The discrete motion as an observer sees it, step by step. central: u is the velocity of half a step before t, which the
 * displacements tell. */
struct account {
    const struct model *m;
    int implicit;
    size_t steps;
    double t, h, y[DIMENSION], u[DOFS], dissipated, exchanged, stray, off;
};

static double wave(double cosine, double sine, double phase)
{
    return cosine * cos(phase) + sine * sin(phase);
}

/* The force that M (u1 - u0)/(t1 - t0) = p - K q - C u + r leaves to friction, with p, q and u as given, does work on the
 * contacts' mean velocity; on blocks, every second degree of freedom is none. Returns what is dissipated. */
static double work(struct account *a, double t0, double t1, const double *u0, const double *u1, const double *p, const double *q,
                   const double *u)
{
    const struct model *m = a->m;
    double sum = 0.0;
    for (size_t i = 0; i < DOFS; i++) {
        double r = -p[i];
        for (size_t j = 0; j < DOFS; j++) {
            r += m->mass[i * DOFS + j] * (u1[j] - u0[j]) / (t1 - t0);
            r += m->stiffness[i * DOFS + j] * q[j] + m->damping[i * DOFS + j] * u[j];
        }
        if (i % 2 == 0) {
            const double b0 = wave(m->motion[0][i / 2], m->motion[1][i / 2], m->motion_omega * t0);
            const double b1 = wave(m->motion[0][i / 2], m->motion[1][i / 2], m->motion_omega * t1);
            const double part = -(t1 - t0) * r * 0.5 * (u0[i] + u1[i] - b0 - b1);
            sum += part;
            a->exchanged += fabs(part);
        } else {
            a->stray = fmax(a->stray, fabs(r));
        }
    }
    return sum;
}

static void load(const struct model *m, double t, double *p)
{
    for (size_t i = 0; i < DOFS; i++) {
        p[i] = wave(m->load[0][i], m->load[1][i], m->load_omega * t);
    }
}

/* The means over the step. */
static void add_implicit(struct account *a, double t, const double *y)
{
    double p[DOFS], end[DOFS], q[DOFS], u[DOFS];
    load(a->m, a->t, p);
    load(a->m, t, end);
    for (size_t i = 0; i < DOFS; i++) {
        p[i] = 0.5 * (p[i] + end[i]);
        q[i] = 0.5 * (a->y[i] + y[i]);
        u[i] = 0.5 * (a->y[DOFS + i] + y[DOFS + i]);
    }
    a->dissipated += work(a, a->t, t, a->y + DOFS, y + DOFS, p, q, u);
    a->off = fmax(a->off, fabs(y[2 * DOFS] - a->dissipated));
}

/* From half a step before a->t to half a step before t, and from there, for who looks, to t. */
static void add_central(struct account *a, double t, const double *y)
{
    double p[DOFS], u[DOFS];
    const double h = t - a->t;
    for (size_t i = 0; i < DOFS; i++) {
        u[i] = (y[i] - a->y[i]) / h;
    }
    load(a->m, a->t, p);
    a->dissipated += work(a, a->t - 0.5 * a->h, a->t + 0.5 * h, a->u, u, p, a->y, a->u);
    load(a->m, t, p);
    const double rest = work(a, t - 0.5 * h, t, u, y + DOFS, p, y, u);
    a->off = fmax(a->off, fabs(y[2 * DOFS] - a->dissipated - rest));
    a->h = h;
    memcpy(a->u, u, sizeof u);
}

static int add_up(const tribo_moment *moment, void *data)
{
    const double t = moment->t, *y = moment->y;
    struct account *a = data;
    (a->implicit ? add_implicit : add_central)(a, t, y);
    a->t = t;
    a->steps++;
    memcpy(a->y, y, sizeof a->y);
    return 0;
}

/* Contacts are blocks on moving ground, so that the friction of each is what its equation leaves. */
TEST(balance_of_energy)
{
    struct random g = random_of(_i);
    struct model m = model_create(&g, 1);
    memset(m.direction, 0, sizeof m.direction);
    for (size_t i = 0; i < CONTACTS; i++) {
        m.direction[i * DOFS + 2 * i] = 1.0;
    }
    struct account a = {.m = &m, .implicit = _i % 2, .y = {1.0}};
    double t = 0.0, y[DIMENSION] = {1.0};
    tribo_system *sys = model_system(&m, 1, 0, 0.1);
    tribo_driver *drv = driver_create(sys, methods[_i % 2], 0.05, 0.0);
    assert_ok(tribo_driver_set_observer(drv, add_up, &a));
    driver_advance(drv, &t, 20.0, y);
    ck_assert_uint_eq(a.steps, 400);
    require(a.dissipated > 1.0, "dissipation %g", a.dissipated);
    assert_close(a.off, 0.0, 1e-12 * a.exchanged);
    assert_close(a.stray, 0.0, 1e-11);
    assert_exact(y[2 * DOFS], a.y[2 * DOFS]);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* --------------------------------------------------------------------------------------------------- no epsilon, no creep */

/* Law, epsilon and coupling of the context do not matter. */
TEST(no_epsilon)
{
    double want[17];
    for (int law = 0; law < tribo_law_count(); law++) {
        double y[17] = {0};
        tribo_system *sys;
        assert_ok(tribo_system_chain(&sys, 8, 1.0, 0.4, 1.0));
        tribo_context *c = tribo_system_context(sys);
        assert_ok(tribo_set_law(c, law));
        assert_ok(tribo_set_epsilon_all(c, pow(10.0, law - 3)));
        assert_ok(tribo_set_coupling(c, law % 2 ? TRIBO_PARTITION : TRIBO_CONSISTENT));
        run(sys, methods[_i], 0.01, 0.0, 10.0, y);
        tribo_system_destroy(sys);
        require(y[16] > 0.01, "nothing moves");
        if (law == 0) {
            memcpy(want, y, sizeof want);
        }
        assert_all_exact(y, want, 17);
    }
}

/* At rest for good: on the ground nothing moves at all, on a belt and on each other velocities are equal, to the last bit. */
TEST(stuck)
{
    double y[17] = {0}, z[5] = {0}, v[2], t = 0.0;
    tribo_system *sys;
    assert_ok(tribo_system_chain(&sys, 8, 10.0, 0.25, 0.5));
    run(sys, methods[_i], 0.01, 0.0, 100.0, y);
    for (size_t i = 0; i < 17; i++) {
        assert_exact(y[i], 0.0);
    }
    tribo_system_destroy(sys);
    assert_ok(tribo_system_belt(&sys, 2.0, 50.0, 20.0, 1.0, 0.5));
    tribo_driver *drv = driver_create(sys, methods[_i], 0.01, 0.0);
    for (int k = 1; k <= 200; k++) {
        driver_advance(drv, &t, 0.5 * k, z);
        assert_ok(tribo_system_contacts(sys, t, z, v, NULL, NULL));
        assert_exact(v[0], 0.0);
        assert_exact(v[1], 0.0);
    }
    assert_close(z[0], 2.0 * (1.0 - cos(50.0)), 1e-3);
    assert_close(z[4], 0.0, 1e-12);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* The rest point of a free oscillator stays where it is. */
TEST(no_creep)
{
    double y[3] = {2.75, 0.0, 0.0}, t = 0.0;
    tribo_system *sys = oscillator(TRIBO_QUINN, 0.0, 1.0);
    tribo_driver *drv = driver_create(sys, methods[_i], 0.01, 0.0);
    driver_advance(drv, &t, 25.0, y);
    const double rest = y[0];
    driver_advance(drv, &t, 2000.0, y);
    assert_exact(y[0], rest);
    assert_exact(y[1], 0.0);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------------------ stability */

/* Highest frequency of two unit masses with springs 100 to the ground and 150 between: 20. Central differences are stable up to
 * dt = 2/20, whatever the friction; beyond, they are refused. The midpoint rule does not mind. */
TEST(limit_of_stability)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {250.0, -150.0, -150.0, 250.0}, direction[] = {1.0, 0.0};
    const struct {
        double dt, limit;
        int method, status;
    } cases[] = {{0.0999, 0.0, 0, TRIBO_OK},     {0.0999, 0.5, 0, TRIBO_OK},      {0.1001, 0.0, 0, TRIBO_ERR_STEP},
                 {0.11, 0.5, 0, TRIBO_ERR_STEP}, {1e300, 0.5, 0, TRIBO_ERR_STEP}, {1.0, 0.5, 1, TRIBO_OK},
                 {100.0, 0.0, 1, TRIBO_OK}};
    for (size_t k = 0; k < COUNT(cases); k++) {
        double t = 0.0, y[5] = {1.0, -1.0, 0.0, 0.0, 0.0};
        tribo_system *sys;
        assert_ok(dense_system(&sys, 2, 1, mass, NULL, stiffness, direction, 0, NULL, 0));
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), cases[k].limit));
        tribo_driver *drv = driver_create(sys, methods[cases[k].method], cases[k].dt, 0.0);
        const int status = tribo_driver_advance(drv, &t, 20000.0 * cases[k].dt, y);
        require(status == cases[k].status, "case %zu: %d, %s", k, status, tribo_driver_message(drv));
        if (status) {
            assert_says(tribo_driver_message(drv), "unstable in steps of ");
            assert_says(tribo_driver_message(drv), "dt must be below 0.1");
            assert_exact(t, 0.0);
            assert_exact(y[0], 1.0);
            driver_advance(drv, &t, 0.09, y); /* a step that is shorter */
        } else {
            require(fabs(y[0]) < 10.0 && fabs(y[1]) < 10.0, "case %zu: %g, %g", k, y[0], y[1]);
        }
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}

/* Central differences written out, for a diagonal mass matrix and no friction: whether steps of h grow. */
static int grows(const struct model *m, int damped, double h)
{
    double q[DOFS] = {1.0, -0.5, 0.3, 0.2, -0.7, 0.4}, u[DOFS] = {0.0}, most = 0.0;
    for (int k = 0; k < 4000 && most < 1e6; k++) {
        double a[DOFS] = {0.0};
        for (size_t e = 0; e < DOFS * DOFS; e++) {
            const double force = m->stiffness[e] * q[e % DOFS] + (damped ? m->damping[e] * u[e % DOFS] : 0.0);
            a[e / DOFS] -= force / m->mass[e / DOFS * (DOFS + 1)];
        }
        for (size_t i = 0; i < DOFS; i++) {
            u[i] += h * a[i];
            q[i] += h * u[i];
            most = fmax(most, fabs(q[i]));
        }
    }
    return most >= 1e6;
}

/* 1 if steps of dt are taken, 0 if they are refused. */
static int taken(tribo_system *sys, double dt)
{
    double t = 0.0, *y = calloc(tribo_system_dimension(sys), sizeof *y);
    tribo_driver *drv = driver_create(sys, "central/fixed", dt, 0.0);
    const int status = tribo_driver_advance(drv, &t, 3.0 * dt, y);
    require(status == TRIBO_OK || status == TRIBO_ERR_STEP, "%d: %s", status, tribo_driver_message(drv));
    tribo_driver_destroy(drv);
    free(y);
    return status == TRIBO_OK;
}

/* A hundredth below what trial shows to be stable is taken, a hundredth above is not. Damping, which acts on the velocity of half
 * a step before, lowers it. */
TEST(largest_stable_step)
{
    struct random g = random_of(_i / 2);
    const struct model m = model_create(&g, 0);
    double lo = 0.0, hi = 10.0;
    for (int k = 0; k < 40; k++) {
        const double middle = 0.5 * (lo + hi);
        *(grows(&m, _i % 2, middle) ? &hi : &lo) = middle;
    }
    tribo_system *sys = model_system(&m, _i % 2, 0, 0.1);
    ck_assert(taken(sys, 0.99 * lo));
    ck_assert(!taken(sys, 1.01 * lo));
    tribo_system_destroy(sys);
}

/* Chains of many blocks: the last one of the paper's chain has the highest frequency for itself, n sqrt(8/sqrt 3); of one between
 * two walls many are just below 2. */
TEST(long_chains)
{
    const size_t n = 20000;
    tribo_system *sys;
    assert_ok(tribo_system_chain(&sys, n, 1e-3, 0.25, 0.5));
    const double limit = 2.0 / ((double)n * sqrt(8.0 / sqrt(3.0)));
    ck_assert(taken(sys, 0.99 * limit));
    ck_assert(!taken(sys, 1.01 * limit));
    tribo_system_destroy(sys);
    gsl_spmatrix *mass = gsl_spmatrix_alloc(n, n), *stiffness = gsl_spmatrix_alloc(n, n), *none = gsl_spmatrix_alloc(1, n);
    for (size_t i = 0; i < n; i++) {
        gsl_spmatrix_set(mass, i, i, 1.0);
        gsl_spmatrix_set(stiffness, i, i, 2.0);
        if (i) {
            gsl_spmatrix_set(stiffness, i, i - 1, -1.0);
            gsl_spmatrix_set(stiffness, i - 1, i, -1.0);
        }
    }
    assert_ok(sparse_system(&sys, mass, NULL, stiffness, none, 0, NULL, 0));
    ck_assert(taken(sys, 0.98));
    ck_assert(!taken(sys, 1.01));
    tribo_system_destroy(sys);
    gsl_spmatrix_free(mass);
    gsl_spmatrix_free(stiffness);
    gsl_spmatrix_free(none);
}

/* Damping that is changed, or not symmetric; a matrix of a step that cannot be prepared stays unprepared. */
TEST(damping)
{
    struct random g = random_of(1);
    const struct model m = model_create(&g, 1);
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, gyroscopic[] = {0.0, 1.0, -1.0, 0.0}, stiffness[] = {4.0, -1.0, -1.0, 4.0},
                 direction[] = {1.0, 0.0, 1.0, 1.0};
    for (double h = 0.1; h < 3.0; h *= 5.0) {
        double y[2][DIMENSION] = {{1.0}, {1.0}}, t = 0.0;
        tribo_system *sys = model_system(&m, 0, 4, 0.1);
        tribo_driver *drv = driver_create(sys, "moreau/fixed", h, 0.0);
        memcpy(y[0], y[1], sizeof y[0]);
        driver_advance(drv, &t, 4.0 * h, y[0]);
        assert_ok(tribo_system_set_damping_ratio(sys, 0.5));
        memcpy(y[0], y[1], sizeof y[0]);
        t = 0.0;
        driver_advance(drv, &t, 40.0 * h, y[0]);
        run(sys, "moreau/fixed", h, 0.0, 40.0 * h, y[1]);
        assert_all_exact(y[0], y[1], tribo_system_dimension(sys));
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    double t = 0.0, y[5] = {1.0, 0.0, 0.0, 0.5, 0.0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 2, mass, gyroscopic, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.3));
    tribo_driver *drv = driver_create(sys, "moreau/fixed", 0.1, 0.0);
    for (int k = 0; k < 3; k++) {
        assert_status(tribo_driver_advance(drv, &t, 3.0, y), TRIBO_ERR_NOT_SYMMETRIC);
        assert_says(tribo_driver_message(drv), "in steps of 0.1, r of contacts 0, 1");
        assert_exact(t, 0.0);
        assert_exact(y[0], 1.0);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------------------- observers */

/* What an observer sees, and where it stops, are velocities and energy of that time: second order, as at the end. */
static int compare(const tribo_moment *moment, void *data)
{
    const double t = moment->t, *y = moment->y;
    struct account *a = data;
    double z[3] = {0.5, 1.0, 0.0}, begin = 0.0;
    tribo_system *sys;
    assert_ok(tribo_system_oscillator(&sys, 1.0, 1.5, 0.5));
    tribo_driver *drv = driver_create(sys, "exact", 100.0, 0.0);
    driver_advance(drv, &begin, t, z);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    a->off = fmax(a->off, fmax(fabs(y[1] - z[1]), fabs(y[2] - z[2])));
    return t > 9.0 - 1e-9;
}

TEST(synchronous)
{
    const double dt[] = {0.1, 0.05, 0.025, 0.0125};
    double error[4], end[4][3];
    for (size_t k = 0; k < 4; k++) {
        struct account a = {.m = NULL};
        double t = 0.0, y[3] = {0.5, 1.0, 0.0};
        tribo_system *sys;
        assert_ok(tribo_system_oscillator(&sys, 1.0, 1.5, 0.5));
        tribo_driver *drv = driver_create(sys, methods[_i], dt[k], 0.0);
        assert_ok(tribo_driver_set_observer(drv, compare, &a));
        assert_status(tribo_driver_advance(drv, &t, 12.0, y), TRIBO_ERR_STOPPED);
        assert_close(t, 9.0, 1e-12);
        error[k] = a.off;
        /* to look changes nothing, and nor does a stop */
        assert_ok(tribo_driver_set_observer(drv, NULL, NULL));
        driver_advance(drv, &t, 12.0, y);
        memcpy(end[k], y, sizeof y);
        double z[3] = {0.5, 1.0, 0.0};
        run(sys, methods[_i], dt[k], 0.0, 12.0, z);
        assert_all_close(y, z, 3, 1e-14);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    require(order_of(dt, error, 4) > 1.7, "order %.2f, errors %g to %g", order_of(dt, error, 4), error[0], error[3]);
}

static int raise_static(const tribo_moment *moment, void *data)
{
    const double t = moment->t;
    const double ratio = 4.0;
    if (fabs(t - 0.5) < 1e-9) {
        assert_ok(tribo_set_static(data, &ratio, NULL));
    }
    return 0;
}

/* Static limits that an observer sets count from the next step on, as they do from the next advance on: a block that slides to
 * rest does so by the limit to slide. */
TEST(static_limits_by_an_observer)
{
    const double one = 1.0, limit = 1.0;
    double y[2][3] = {{0.0, 1.0, 0.0}, {0.0, 1.0, 0.0}};
    for (int watched = 0; watched < 2; watched++) {
        double t = 0.0;
        tribo_system *sys;
        assert_ok(dense_system(&sys, 1, 1, &one, NULL, &(double){0.0}, &one, 0, NULL, 0));
        tribo_context *contacts = tribo_system_context(sys);
        assert_ok(tribo_set_limit(contacts, &limit));
        tribo_driver *drv = driver_create(sys, methods[_i], 0.0625, 0.0);
        if (watched) {
            assert_ok(tribo_driver_set_observer(drv, raise_static, contacts));
        } else {
            driver_advance(drv, &t, 0.5, y[0]);
            raise_static(&(tribo_moment){.t = t, .y = y[0]}, contacts);
        }
        driver_advance(drv, &t, 2.0, y[watched]);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    assert_close(y[0][0], 0.5, 0.01);
    assert_all_close(y[1], y[0], 3, 1e-12);
}

/* ---------------------------------------------------------------------------------------------------------------- tables */

/* Closed forms as in the suite event: load 0, 2, 0 at t = 0, 2, 4 on limit 1; and limit 2, 0, 0 at t = 0, 2, 3 under load 1. */
TEST(tables)
{
    const double time[] = {0.0, 2.0, 4.0}, value[] = {0.0, 2.0, 0.0}, limit_time[] = {0.0, 2.0, 3.0}, limit[] = {2.0, 0.0, 0.0};
    const double one = 1.0, rest = 1.0 / 6.0 + 5.0 / 3.0 + 1.0 / 8.0, dt[] = {0.03, 0.003};
    double error[2][2];
    for (size_t k = 0; k < 2; k++) {
        double y[3] = {0}, z[3] = {0};
        tribo_system *sys = block(1.0, 0.0, 1.0), *other = block(1.0, 0.0, 17.0);
        assert_ok(tribo_system_add_load_table(sys, 3, time, value, &one));
        run(sys, methods[_i], dt[k], 0.0, 10.0, y);
        assert_exact(y[1], 0.0);
        error[0][k] = fmax(fabs(y[0] - rest), fabs(y[2] - rest));
        assert_ok(tribo_system_add_load(other, 0.0, &one, NULL));
        assert_ok(tribo_system_set_limit_table(other, 3, limit_time, limit));
        run(other, methods[_i], dt[k], 0.0, 3.0, z);
        error[1][k] = fmax(fmax(fabs(z[0] - 7.0 / 6.0), fabs(z[1] - 1.5)), fabs(z[2] - 1.0 / 24.0));
        tribo_system_destroy(sys);
        tribo_system_destroy(other);
    }
    for (size_t k = 0; k < 2; k++) {
        require(error[k][0] < 5.0 * dt[0] * dt[0] && error[k][1] < 5.0 * dt[1] * dt[1], "%zu: errors %g, %g", k, error[k][0],
                error[k][1]);
    }
}

/* The observer may end a run; it goes on from there. */
static int stop_at(const tribo_moment *moment, void *data)
{
    const double t = moment->t;
    return t >= *(double *)data ? 5 : 0;
}

TEST(observer_stops)
{
    double y[3] = {0}, want[3] = {0}, t = 0.0, when = 7.0;
    tribo_system *sys = oscillator(TRIBO_QUINN, 1.5, 0.5);
    tribo_driver *drv = driver_create(sys, methods[_i], 0.01, 0.0);
    run(sys, methods[_i], 0.01, 0.0, 20.0, want);
    assert_ok(tribo_driver_set_observer(drv, stop_at, &when));
    assert_status(tribo_driver_advance(drv, &t, 20.0, y), TRIBO_ERR_STOPPED);
    assert_says(tribo_driver_message(drv), "observer answered 5");
    assert_close(t, 7.0, 1e-9);
    assert_ok(tribo_driver_set_observer(drv, NULL, NULL));
    driver_advance(drv, &t, 20.0, y);
    assert_all_close(y, want, 3, 1e-9);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST_MAIN("step_form", {orders, 2 * REFERENCES}, {errors_seen, COUNT(seen)}, {counts, 2}, {balance_of_energy, 12},
          {no_epsilon, 2}, {stuck, 2}, {no_creep, 2}, {limit_of_stability, 1}, {largest_stable_step, 8}, {long_chains, 1},
          {damping, 1}, {static_limits_by_an_observer, 2}, {synchronous, 2}, {tables, 2}, {observer_stops, 2})
