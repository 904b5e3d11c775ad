/* Methods "central/fixed" and "moreau/fixed": second order, an energy balance of the discrete motion that closes to rounding,
 * exact stick, and nothing that depends on epsilon. */
#include <string.h>

#include "coulomb.h"
#include "model.h"

static const char *const methods[] = {"central/fixed", "moreau/fixed"};

/* -------------------------------------------------------------------------------------------------------------- accuracy */

/* Where contacts stick, second order; a step of which a contact reverses without stick is taken for one of stick, and the error
 * falls with dt only: 7b. Orders over a factor of 100; errors jump with where the steps are. */
TEST(orders)
{
    const double dt[] = {0.03, 0.01, 0.003, 0.001, 0.0003}, least[] = {1.7, 0.7, 0.7, 1.7, 1.7, 1.7, 1.7};
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

/* The discrete motion as an observer sees it, step by step. */
struct account {
    const struct model *m;
    int implicit;
    size_t steps;
    double t, y[DIMENSION], dissipated, exchanged, stray;
};

static double wave(double cosine, double sine, double phase)
{
    return cosine * cos(phase) + sine * sin(phase);
}

/* The force that M (u' - u)/time = p - K q - C u + r leaves to friction: central takes p at the start, q and u before, moreau the
 * means. What it does to the contacts' mean velocity is what the step must have dissipated. */
static int add_up(double t, const double *y, int event, void *data)
{
    struct account *a = data;
    const struct model *m = a->m;
    const double h = t - a->t, time = !a->implicit && a->steps == 0 ? 0.5 * h : h;
    /* central's velocities are those of half a step before */
    const double from = a->implicit || a->steps == 0 ? a->t : a->t - 0.5 * h, to = from + time;
    const double ends[2] = {a->t, a->implicit ? t : a->t};
    (void)event;
    for (size_t i = 0; i < DOFS; i++) {
        double r = 0.0;
        for (int end = 0; end < 2; end++) {
            r -= 0.5 * wave(m->load[0][i], m->load[1][i], m->load_omega * ends[end]);
        }
        for (size_t j = 0; j < DOFS; j++) {
            const double u = a->y[DOFS + j], q = a->y[j], implicit = a->implicit ? 0.5 : 0.0;
            r += m->mass[i * DOFS + j] * (y[DOFS + j] - u) / time;
            r += m->stiffness[i * DOFS + j] * (q + implicit * (y[j] - q));
            r += m->damping[i * DOFS + j] * (u + implicit * (y[DOFS + j] - u));
        }
        if (i % 2 == 0) {
            const double b0 = wave(m->motion[0][i / 2], m->motion[1][i / 2], m->motion_omega * from);
            const double b1 = wave(m->motion[0][i / 2], m->motion[1][i / 2], m->motion_omega * to);
            const double part = -time * r * 0.5 * (a->y[DOFS + i] + y[DOFS + i] - b0 - b1);
            a->dissipated += part;
            a->exchanged += fabs(part);
        } else {
            a->stray = fmax(a->stray, fabs(r));
        }
    }
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
    struct account a = {&m, _i % 2, 0, 0.0, {1.0}, 0.0, 0.0, 0.0};
    double t = 0.0, y[DIMENSION] = {1.0};
    tribo_system *sys = model_system(&m, 1, 0, 0.1);
    tribo_driver *drv = driver_create(sys, methods[_i % 2], 0.05, 0.0);
    assert_ok(tribo_driver_set_observer(drv, add_up, &a));
    driver_advance(drv, &t, 20.0, y);
    require(a.dissipated > 1.0, "dissipation %g", a.dissipated);
    assert_close(a.y[2 * DOFS], a.dissipated, 1e-12 * a.exchanged);
    assert_close(a.stray, 0.0, 1e-11);
    /* at the end central adds half a step */
    assert_close(y[2 * DOFS], a.dissipated, _i % 2 ? 1e-12 * a.exchanged : 0.25);
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
 * dt = 2/20, whatever the friction; beyond, the motion grows until the driver says so. The midpoint rule does not mind. */
TEST(limit_of_stability)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {250.0, -150.0, -150.0, 250.0}, direction[] = {1.0, 0.0};
    const struct {
        double dt, limit;
        int method, status;
    } cases[] = {{0.099, 0.0, 0, TRIBO_OK},
                 {0.099, 0.5, 0, TRIBO_OK},
                 {0.101, 0.0, 0, TRIBO_ERR_NOT_FINITE},
                 {0.11, 0.5, 0, TRIBO_ERR_NOT_FINITE},
                 {1.0, 0.5, 1, TRIBO_OK},
                 {100.0, 0.0, 1, TRIBO_OK}};
    for (size_t k = 0; k < COUNT(cases); k++) {
        double t = 0.0, y[5] = {1.0, -1.0, 0.0, 0.0, 0.0};
        tribo_system *sys;
        assert_ok(tribo_system_linear(&sys, 2, 1, mass, NULL, stiffness, direction, 0, NULL, 0));
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), cases[k].limit));
        tribo_driver *drv = driver_create(sys, methods[cases[k].method], cases[k].dt, 0.0);
        const int status = tribo_driver_advance(drv, &t, 20000.0 * cases[k].dt, y);
        require(status == cases[k].status, "case %zu: %d, %s", k, status, tribo_driver_message(drv));
        if (status) {
            assert_says(tribo_driver_message(drv), "grew without bound");
            assert_says(tribo_driver_message(drv), cases[k].dt < 0.105 ? "dt = 0.101" : "dt = 0.11");
            require(t > 0.0 && t < 20000.0 * cases[k].dt, "t = %g", t);
            require(isfinite(y[0]) && isfinite(y[1]) && isfinite(y[2]) && isfinite(y[3]), "the state kept is not finite");
        } else {
            require(fabs(y[0]) < 10.0 && fabs(y[1]) < 10.0, "case %zu: %g, %g", k, y[0], y[1]);
        }
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}

/* ---------------------------------------------------------------------------------------------------------------- tables */

/* The closed forms of event.c: load 0, 2, 0 at t = 0, 2, 4 on limit 1; and limit 2, 0, 0 at t = 0, 2, 3 under load 1. */
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
static int stop_at(double t, const double *y, int event, void *data)
{
    (void)y;
    (void)event;
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
          {no_epsilon, 2}, {stuck, 2}, {no_creep, 2}, {limit_of_stability, 1}, {tables, 2}, {observer_stops, 2})
