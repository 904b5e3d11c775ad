/* SPDX-License-Identifier: BSD-3-Clause */
/* Stiffness that is not symmetric: Ziegler's double pendulum under a load that follows it, whose flutter load is known. Motions
 * beside the matrix exponential, multipliers beside eigenvalues, and friction by all methods. */
#include <math.h>
#include <string.h>

#include "../run.h"

/* Two rods of length 1 with joints of stiffness 1, angles q; masses 2 at the first joint's end, 1 at the second. LOAD: P of
 *     3 q1'' + q2'' + (2 - P) q1 + (P - 1) q2 = 0,    q1'' + q2'' - q1 + q2 = 0,
 *     2 w^4 - (7 - 2 P) w^2 + 1 = 0:    flutter from P = 7/2 - sqrt 2 on. */
#define FLUTTER (3.5 - sqrt(2.0))

/* A contact of the second rod, that is open if limit = 0, with compliance c or rigid. */
static tribo_system *pendulum(double p, const double *damping, double limit, double c)
{
    const double mass[] = {3.0, 1.0, 1.0, 1.0}, stiffness[] = {2.0 - p, p - 1.0, -1.0, 1.0}, row[] = {0.3, 1.0};
    tribo_model *model = dense_model(2, 1, mass, damping, stiffness, row);
    assert_ok(tribo_model_set_compliance(model, &c));
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), limit));
    return sys;
}

/* e [16] = e^{A t} of y' = A y, by the series of A t/2^20, squared 20 times. */
static void exponential(double p, const double *damping, double t, double *e)
{
    /* M^-1 = [1 -1; -1 3]/2 */
    const double k[] = {2.0 - p, p - 1.0, -1.0, 1.0}, inverse[] = {0.5, -0.5, -0.5, 1.5};
    double a[16] = {0.0}, term[16] = {0.0}, next[16];
    a[2] = a[7] = 1.0;
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            for (int l = 0; l < 2; l++) {
                a[4 * (2 + i) + j] -= inverse[2 * i + l] * k[2 * l + j];
                a[4 * (2 + i) + 2 + j] -= damping ? inverse[2 * i + l] * damping[2 * l + j] : 0.0;
            }
        }
    }
    /* e = e^{A t} - 1, so that squares lose no digits: (1 + e)^2 - 1 = 2 e + e e */
    memset(e, 0, 16 * sizeof *e);
    for (int i = 0; i < 4; i++) {
        term[5 * i] = 1.0;
    }
    for (int order = 1; order < 12 + 20; order++) {
        const int squares = order >= 12;
        for (int i = 0; i < 4; i++) {
            for (int j = 0; j < 4; j++) {
                double sum = 0.0;
                for (int l = 0; l < 4; l++) {
                    sum +=
                        squares ? e[4 * i + l] * e[4 * l + j] : term[4 * i + l] * a[4 * l + j] * t / (1048576.0 * (double)order);
                }
                next[4 * i + j] = sum;
            }
        }
        for (int i = 0; i < 16; i++) {
            term[i] = next[i];
            e[i] = squares ? 2.0 * e[i] + next[i] : e[i] + next[i];
        }
    }
    for (int i = 0; i < 4; i++) {
        e[5 * i] += 1.0;
    }
}

static const double small[] = {0.05, -0.02, -0.02, 0.02}, *const dampings[] = {NULL, small};

/* dt: step, or first step; methods without steps do not read it. */
static void assert_motion(double p, const double *damping, const char *method, double dt, double tolerance)
{
    const double start[] = {0.1, -0.2, 0.3, 0.05};
    const double t1 = 7.0;
    double e[16], y[5], z[4], size = 0.3, t = 0.0;
    tribo_system *sys = pendulum(p, damping, 0.0, 0.0);
    tribo_driver *drv = driver_create(sys, method, dt, 1e-11);
    exponential(p, damping, t1, e);
    for (int i = 0; i < 4; i++) {
        z[i] = y[i] = 0.0;
        for (int j = 0; j < 4; j++) {
            z[i] += e[4 * i + j] * start[j];
        }
        size = fmax(size, fabs(z[i]));
    }
    memcpy(y, start, sizeof start);
    y[4] = 0.0;
    driver_advance(drv, &t, t1, y);
    assert_all_close(y, z, 4, tolerance * size);
    assert_exact(y[4], 0.0);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Below the flutter load, above it, and beyond divergence of the symmetric part. */
TEST(moves_as_the_exponential)
{
    static const double loads[] = {-1.0, 0.5, 1.5, 2.0, 2.2, 3.0, 5.0, 6.0};
    for (size_t k = 0; k < sizeof loads / sizeof *loads; k++) {
        for (int d = 0; d < 2; d++) {
            assert_motion(loads[k], dampings[d], "exact", 100.0, 1e-12);
            assert_motion(loads[k], dampings[d], "event", 100.0, 1e-10);
            assert_motion(loads[k], dampings[d], "rk4/fixed", 5e-3, 1e-7);
            assert_motion(loads[k], dampings[d], "moreau/fixed", 1e-3, 1e-4);
            assert_motion(loads[k], dampings[d], "rk8pd", 1e-3, 1e-7);
            assert_motion(loads[k], dampings[d], "msbdf", 1e-3, 1e-5);
        }
    }
}

/* At the flutter load two exponents and their shapes are one: exact says so, and auto takes event. */
TEST(border_of_flutter)
{
    double y[5] = {0.1, -0.2, 0.3, 0.05, 0.0}, t = 0.0;
    tribo_system *sys = pendulum(FLUTTER, NULL, 0.0, 0.0);
    tribo_driver *drv = driver_create(sys, "exact", 100.0, 0.0);
    assert_status(tribo_driver_advance(drv, &t, 7.0, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(drv), "method event can do it");
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    assert_motion(FLUTTER, NULL, "auto", 100.0, 1e-11);
    assert_motion(FLUTTER * (1.0 + 1e-10), NULL, "auto", 100.0, 1e-11);
}

/* Multipliers of the motion under a harmonic load: eigenvalues of the exponential, by its trace, that of its square, and its
 * determinant. On both sides of the flutter load all moduli are 1, or one is not. */
TEST(multipliers)
{
    static const double loads[] = {1.0, 2.0, 2.08, 2.09, 2.5};
    const double omega = 1.7, period = 2.0 * PI / omega, force[] = {0.2, 0.1};
    for (size_t k = 0; k < sizeof loads / sizeof *loads; k++) {
        for (int d = 0; d < 4; d++) {
            double y[5] = {0.0}, re[4], im[4], e[16], trace = 0.0, square = 0.0, sum = 0.0, squares = 0.0;
            tribo_system *sys = pendulum(loads[k], dampings[d / 2], 0.0, 0.0);
            tribo_driver *drv = driver_create(sys, d % 2 ? "event" : "exact", 100.0, 0.0);
            assert_ok(tribo_system_add_load(sys, omega, force, NULL));
            const int status = tribo_driver_find_periodic(drv, 0.0, period, y);
            require(!status, "P = %g: %s", loads[k], tribo_driver_message(drv));
            assert_ok(tribo_driver_get_multipliers(drv, re, im));
            exponential(loads[k], dampings[d / 2], period, e);
            for (int i = 0; i < 4; i++) {
                trace += e[5 * i];
                sum += re[i];
                squares += re[i] * re[i] - im[i] * im[i];
                for (int j = 0; j < 4; j++) {
                    square += e[4 * i + j] * e[4 * j + i];
                }
            }
            assert_close(sum, trace, 1e-9);
            assert_close(squares, square, 1e-9);
            if (d < 2) {
                const double most = hypot(re[0], im[0]);
                require(loads[k] < FLUTTER ? fabs(most - 1.0) < 1e-7 : most > 1.05, "P = %g: modulus %.12g", loads[k], most);
            }
            tribo_driver_destroy(drv);
            tribo_system_destroy(sys);
        }
    }
}

/* Largest difference of the states after 20 units of time by a method, in steps dt or 0, and by exact. */
static double difference_by(const char *method, double dt, double p, const double *damping, double limit, double c)
{
    const double force[] = {0.5, 0.4};
    double y[2][6], off = 0.0;
    for (int k = 0; k < 2; k++) {
        tribo_system *sys = pendulum(p, damping, limit, c);
        assert_ok(tribo_system_add_load(sys, 1.3, force, NULL));
        tribo_driver *drv = driver_create(sys, k ? method : "exact", k && dt > 0.0 ? dt : 100.0, 0.0);
        double t = 0.0;
        memcpy(y[k], (double[]){0.1, 0.2, 0.0, 0.0, 0.0, 0.0}, sizeof y[k]);
        driver_advance(drv, &t, 20.0, y[k]);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    require(y[0][c > 0.0 ? 5 : 4] > 0.01, "friction dissipates %g only", y[0][c > 0.0 ? 5 : 4]);
    for (int i = 0; i < (c > 0.0 ? 6 : 5); i++) {
        off = fmax(off, fabs(y[0][i] - y[1][i]));
    }
    return off;
}

/* With friction, rigid and elastic: exact and event agree; methods with steps by their order. */
TEST(friction)
{
    for (double p = 0.5; p < 3.0; p += 0.55) {
        for (int d = 0; d < 4; d++) {
            assert_close(difference_by("event", 0.0, p, dampings[d / 2], 0.2, d % 2 ? 0.4 : 0.0), 0.0, 1e-9);
        }
    }
    for (double p = 0.5; p < 1.5; p += 0.55) {
        const double coarse = difference_by("central/fixed", 4e-3, p, NULL, 0.2, 0.0),
                     fine = difference_by("central/fixed", 1e-3, p, NULL, 0.2, 0.0);
        require(fine < 1e-5 && fine < 0.15 * coarse, "P = %g, central/fixed: %g, %g", p, coarse, fine);
        for (int elastic = 0; elastic < 2; elastic++) {
            const double c = elastic ? 0.4 : 0.0, far = difference_by("moreau/fixed", 4e-3, p, small, 0.2, c),
                         near = difference_by("moreau/fixed", 1e-3, p, small, 0.2, c);
            require(near < 1e-5 && near < 0.15 * far, "P = %g, moreau/fixed: %g, %g", p, far, near);
        }
    }
}

/* What takes no such stiffness says so. */
TEST(refused)
{
    const double mass[] = {3.0, 1.0, 1.0, 1.0}, stiffness[] = {1.0, 0.5, -1.0, 1.0}, row[] = {0.0, 1.0};
    for (int massless = 0; massless < 2; massless++) {
        tribo_model *model;
        tribo_system *sys = NULL;
        assert_ok(tribo_model_create(&model, 2, 1));
        assert_ok(massless ? tribo_model_set_mass_diagonal(model, (double[]){1.0, 0.0}) : tribo_model_set_mass(model, mass));
        assert_ok(tribo_model_set_stiffness(model, stiffness));
        assert_ok(tribo_model_set_direction(model, row));
        const int status = massless ? tribo_system_create(&sys, model) : tribo_system_reduce(&sys, model, 1, TRIBO_STATICS_NONE);
        assert_status(status, TRIBO_ERR_NOT_SYMMETRIC);
        assert_says(tribo_model_message(model), "stiffness[0][1] = 0.5, but stiffness[1][0] = -1");
        assert_says(tribo_model_message(model), massless ? "without mass" : "modes for a reduction");
        tribo_model_destroy(model);
    }
    const double time[] = {0.0, 1.0};
    const int parameter = TRIBO_PARAMETER_FREQUENCY;
    const size_t index = 0;
    double y[5] = {0.0}, z[5];
    tribo_system *sys = pendulum(1.0, small, 0.0, 0.0);
    tribo_driver *drv = driver_create(sys, "exact", 100.0, 0.0);
    assert_ok(tribo_system_add_load(sys, 1.7, row, NULL));
    assert_ok(tribo_driver_find_periodic(drv, 0.0, 2.0 * PI / 1.7, y));
    assert_status(tribo_driver_period_derivatives(drv, 1, &parameter, &index, NULL, NULL, NULL, z), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(drv), "a stiffness that is not symmetric");
    double t = 0.0;
    assert_ok(tribo_system_add_base_table(sys, 2, time, row, row + 1));
    assert_status(tribo_driver_advance(drv, &t, 1.0, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(drv), "base motions follow a table, which method exact does not take beside a stiffness");
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST_MAIN("circulatory", {moves_as_the_exponential, 1}, {border_of_flutter, 1}, {multipliers, 1}, {friction, 1}, {refused, 1})
