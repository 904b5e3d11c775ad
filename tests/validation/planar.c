/* Planar contacts in the drivers: those that ask for forces only take them as they come, the others refuse. */
#include "run.h"

static const double identity[4] = {1.0, 0.0, 0.0, 1.0}, stiffness[4] = {1.0, 0.0, 0.0, 1.7};

/* x'' + x = 1.6 sin 0.7 t + f, y'' + 1.7 y = 1.2 cos(0.7 t + 0.4) + f, limit 1. */
static tribo_system *planar_oscillator(double epsilon)
{
    const double cosine[2] = {0.0, 1.2 * cos(0.4)}, sine[2] = {1.6, -1.2 * sin(0.4)};
    tribo_system *s;
    assert_ok(tribo_system_linear(&s, 2, 2, identity, NULL, stiffness, identity, 0, NULL, 0));
    assert_ok(tribo_system_add_load(s, 0.7, cosine, sine));
    tribo_context *c = tribo_system_context(s);
    assert_ok(tribo_set_planar(c, 1, (const size_t[]){0}));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_epsilon_all(c, epsilon));
    return s;
}

TEST(methods)
{
    const struct {
        const char *name;
        double dt, epsilon, error;
    } cases[] = {{"rk4/fixed", 1e-3, 2e-3, 1.3e-7},
                 {"rkf45", 1e-2, 2e-3, 1e-4},
                 {"msbdf", 1e-2, 2e-3, 1e-2},
                 {"central/fixed", 1e-3, 1.0, 2e-2},
                 {"moreau/fixed", 1e-3, 1.0, 2e-2}};
    const double want[3] = {-0.794389645, -0.394078205, 67.840627726};
    tribo_system *s = planar_oscillator(cases[_i].epsilon);
    tribo_driver *d;
    double t = 0.0, y[5] = {0.0};
    assert_ok(tribo_driver_create(&d, s, cases[_i].name, cases[_i].dt, 1e-10, 1e-10));
    const int status = tribo_driver_advance(d, &t, 60.0, y);
    require(!status, "%s: %s", cases[_i].name, tribo_driver_message(d));
    assert_close(y[0], want[0], cases[_i].error);
    assert_close(y[1], want[1], cases[_i].error);
    assert_close(y[4], want[2], cases[_i].error);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

TEST(refused)
{
    const char *names[] = {"event", "exact", "auto"};
    tribo_system *s = planar_oscillator(0.01);
    tribo_context *c = tribo_system_context(s);
    tribo_driver *d = NULL;
    double t = 0.0, y[5] = {0.0};
    assert_status(tribo_driver_create(&d, s, names[_i], 0.01, 1e-9, 1e-9), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_message(c), "planar");
    assert_ok(tribo_set_planar(c, 0, NULL));
    assert_ok(tribo_driver_create(&d, s, names[_i], 0.01, 1e-9, 1e-9));
    assert_ok(tribo_driver_advance(d, &t, 0.1, y));
    assert_ok(tribo_set_planar(c, 1, (const size_t[]){0}));
    assert_status(tribo_driver_advance(d, &t, 0.2, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(d), "planar");
    assert_exact(t, 0.1);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

TEST_MAIN("planar", {methods, 5}, {refused, 3})
