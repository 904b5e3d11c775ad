/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar contacts in the drivers with steps: these ask for forces only, and take them as they come. Exact refuses them. */
#include "make.h"
#include "run.h"
#include "../../set_up_driver.h"

static const double identity[4] = {1.0, 0.0, 0.0, 1.0}, stiffness[4] = {1.0, 0.0, 0.0, 1.7};

/* One planar contact of limit 1 on a mass of 1. */
static tribo_system *planar_mass(const double *springs, double epsilon)
{
    tribo_system *s;
    assert_ok(dense_system(&s, 2, 2, identity, NULL, springs, identity, 0, NULL, 0));
    tribo_context *c = tribo_system_context(s);
    assert_ok(tribo_set_planar(c, 1, (const size_t[]){0}));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_epsilon_all(c, epsilon));
    return s;
}

/* x'' + x = p sin 0.7 t + f, y'' + 1.7 y = 1.2 cos(0.7 t + 0.4) + f. */
static tribo_system *planar_oscillator(double p, double epsilon)
{
    const double cosine[2] = {0.0, 1.2 * cos(0.4)}, sine[2] = {p, -1.2 * sin(0.4)};
    tribo_system *s = planar_mass(stiffness, epsilon);
    assert_ok(tribo_system_add_load(s, 0.7, cosine, sine));
    return s;
}

/* Values at t = 60, computed by another code: x, y and dissipation. */
static const struct {
    double p, want[3];
} motions[] = {{1.6, {-0.794389645, -0.394078205, 67.840627726}}, {2.5, {-2.813421575, -0.353837684, 122.943559967}}};

/* The largest error of these; epsilon is that of steps, twice as long as they. */
static double error_of(int motion, const char *method, double dt)
{
    double y[5] = {0.0};
    const double *want = motions[motion].want;
    tribo_system *s = planar_oscillator(motions[motion].p, 2.0 * dt);
    run(s, method, dt, 1e-10, 60.0, y);
    tribo_system_destroy(s);
    return fmax(fabs(y[0] - want[0]), fmax(fabs(y[1] - want[1]), fabs(y[4] - want[2])));
}

/* Steps of 1e-2 and 1e-3: rk4 is of third order, the step form of second. */
TEST(orders)
{
    const struct {
        const char *name;
        double order, error[2];
    } cases[] = {
        {"rk4/fixed", 2.9, {1.3e-7, 1.3e-7}}, {"central/fixed", 1.95, {1.2e-5, 1.8e-5}}, {"moreau/fixed", 1.95, {1e-5, 3e-6}}};
    const int motion = _i % 2, method = _i / 2;
    const double coarse = error_of(motion, cases[method].name, 1e-2), fine = error_of(motion, cases[method].name, 1e-3);
    require(log10(coarse / fine) > cases[method].order, "%s: order %.2f", cases[method].name, log10(coarse / fine));
    require(fine < cases[method].error[motion], "%s: error %.3g", cases[method].name, fine);
}

/* Steppers that look at their errors; epsilon 2e-3. */
TEST(adaptive)
{
    const struct {
        const char *name;
        double error;
    } cases[] = {{"rkf45", 1e-4}, {"msbdf", 1e-2}};
    double y[5] = {0.0};
    tribo_system *s = planar_oscillator(1.6, 2e-3);
    run(s, cases[_i].name, 1e-2, 1e-10, 60.0, y);
    assert_close(y[0], motions[0].want[0], cases[_i].error);
    assert_close(y[1], motions[0].want[1], cases[_i].error);
    assert_close(y[4], motions[0].want[2], cases[_i].error);
    tribo_system_destroy(s);
}

/* Code_Aster's SDND100, at 45 degrees in the plane: k = 1e4, m = 1, limit 1, released 0.85 mm off. Extrema at t = n pi/100, in
 * mm, and from the fourth on rest. The motion stays on its line. */
TEST(released)
{
    const struct {
        const char *name;
        double error, rest; /* of the law, which holds exactly only in the step form */
    } cases[] = {{"rk4/fixed", 2e-10, 1e-5}, {"central/fixed", 4e-8, 4e-8}, {"moreau/fixed", 2e-7, 2e-7}};
    const double springs[4] = {1e4, 0.0, 0.0, 1e4}, want[6] = {-0.65, 0.45, -0.25, 0.05, 0.05, 0.05}, side = sqrt(0.5);
    const double half = PI / 100.0, h = half / 400.0;
    double t = 0.0, y[5] = {0.85e-3 * side, 0.85e-3 * side, 0.0, 0.0, 0.0};
    tribo_system *s = planar_mass(springs, 2.0 * h);
    tribo_driver *d = driver_create(s, cases[_i].name, h, 0.0);
    for (int n = 0; n < 6; n++) {
        driver_advance(d, &t, (n + 1) * half, y);
        assert_close(1e3 * y[0] / side, want[n], n < 3 ? cases[_i].error : cases[_i].rest);
        assert_exact(y[1], y[0]);
        assert_exact(y[3], y[2]);
    }
    assert_close(y[2], 0.0, 1e-12);
    assert_close(y[4], 1e-3 * (0.85 + 2.0 * (0.65 + 0.45 + 0.25) + 0.05), 1e-7);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* A copy moves as the original does, also when that has other contacts by then, or is no more. */
TEST(copies)
{
    const char *names[] = {"rk4/fixed", "rkf45", "central/fixed", "moreau/fixed"};
    double want[5] = {0.0}, y[5] = {0.0}, scalar[5] = {0.0};
    tribo_system *s = planar_oscillator(2.5, 0.02), *copy;
    run(s, names[_i], 0.01, 1e-8, 10.0, want);
    assert_ok(tribo_system_clone(s, &copy));
    assert_ok(tribo_set_planar(tribo_system_context(s), 0, NULL));
    run(s, names[_i], 0.01, 1e-8, 10.0, scalar);
    tribo_system_destroy(s);
    run(copy, names[_i], 0.01, 1e-8, 10.0, y);
    assert_all_exact(y, want, 5);
    require(fabs(scalar[4] - want[4]) > 0.2, "scalar contacts dissipate %g, the planar one %g", scalar[4], want[4]);
    tribo_system_destroy(copy);
}

TEST(refused)
{
    tribo_system *s = planar_oscillator(1.6, 0.01);
    tribo_context *c = tribo_system_context(s);
    tribo_driver *d = NULL;
    double t = 0.0, y[5] = {0.0};
    assert_status(set_up_driver(&d, s, "exact", 0.01, 1e-9, 1e-9), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_system_message(s), "planar");
    assert_ok(tribo_set_planar(c, 0, NULL));
    assert_ok(set_up_driver(&d, s, "exact", 0.01, 1e-9, 1e-9));
    assert_ok(tribo_driver_advance(d, &t, 0.1, y));
    assert_ok(tribo_set_planar(c, 1, (const size_t[]){0}));
    assert_status(tribo_driver_advance(d, &t, 0.2, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(d), "planar");
    assert_exact(t, 0.1);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* A planar contact without limit in one direction leaves that free. */
TEST(open_direction)
{
    static const char *const methods[] = {"event", "central/fixed", "moreau/fixed", "rkf45"};
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, spring[] = {1.0, 0.0, 0.0, 0.0}, limit[] = {1.0, 0.0};
    const size_t first = 0;
    double y[5] = {0.0, 0.0, 0.0, 1.0, 0.0}, t = 0.0;
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 2, mass, NULL, spring, mass, 0, NULL, 0));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    assert_ok(tribo_set_planar(tribo_system_context(sys), 1, &first));
    tribo_driver *drv = driver_create(sys, methods[_i], 0.01, 1e-10);
    driver_advance(drv, &t, 1.0, y);
    assert_close(y[1], 1.0, 1e-9);
    assert_close(y[3], 1.0, 1e-9);
    assert_close(y[4], 0.0, 1e-12);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Two bodies on springs, and one between them; the first one's contact never slips, and the second moves as if it were alone. */
TEST(never_slips)
{
    static const char *const methods[] = {"event", "central/fixed", "moreau/fixed"};
    const double mass[16] = {[0] = 1.0, [5] = 1.0, [10] = 2.0, [15] = 2.0};
    const double direction[16] = {[0] = 1.0, [5] = 1.0, [10] = 1.0, [15] = 1.0};
    const double spring[16] = {3.0, 0.0, -1.0, 0.0, 0.0, 3.0, 0.0, -1.0, -1.0, 0.0, 3.0, 0.0, 0.0, -1.0, 0.0, 3.0};
    const double cosine[] = {1.0, 0.0, 1.0, 0.5}, sine[] = {0.3, 0.8, 0.0, -1.0}, limits[] = {1e3, 1e12, 1e30, 1e200, 1e300};
    const double alone_mass[] = {2.0, 0.0, 0.0, 2.0}, alone_spring[] = {3.0, 0.0, 0.0, 3.0};
    const size_t first[] = {0, 2};
    double want[5] = {0.0}, t = 0.0;
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 2, alone_mass, NULL, alone_spring, identity, 0, NULL, 0));
    assert_ok(tribo_set_planar(tribo_system_context(sys), 1, first));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.3));
    assert_ok(tribo_system_add_load(sys, 0.7, cosine + 2, sine + 2));
    tribo_driver *drv = driver_create(sys, methods[_i], 1e-3, 1e-10);
    driver_advance(drv, &t, 6.0, want);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    require(want[4] > 0.1, "friction dissipates %g", want[4]);
    for (size_t k = 0; k < COUNT(limits); k++) {
        const double limit[] = {limits[k], limits[k], 0.3, 0.3};
        double y[9] = {0.0};
        assert_ok(dense_system(&sys, 4, 4, mass, NULL, spring, direction, 0, NULL, 0));
        assert_ok(tribo_set_planar(tribo_system_context(sys), 2, first));
        assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
        assert_ok(tribo_system_add_load(sys, 0.7, cosine, sine));
        drv = driver_create(sys, methods[_i], 1e-3, 1e-10);
        driver_advance(drv, (t = 0.0, &t), 6.0, y);
        assert_close(hypot(y[0], y[1]), 0.0, 1e-12);
        assert_all_close(y + 2, want, 2, 1e-8);
        assert_all_close(y + 6, want + 2, 2, 1e-8);
        assert_close(y[8], want[4], 1e-8);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}

TEST_MAIN("planar", {orders, 6}, {adaptive, 2}, {released, 3}, {copies, 4}, {refused, 1}, {open_direction, 4}, {never_slips, 3})
