/* SPDX-License-Identifier: BSD-3-Clause */
/* Elastic contacts: loops against closed forms, planar elements against what a disc does, derivatives against differences. */
#include "support.h"

#include <string.h>

/* Moves an element to z in steps; adds up the work that is done on it. */
static void move_to(double *z, double to, double stiffness, double limit, double *f, double *work)
{
    enum { STEPS = 1000 };
    const double dz = (to - *z) / STEPS;
    for (int k = 0; k < STEPS; k++) {
        const double before = *f;
        assert_ok(tribo_elastic_force(1, &dz, &stiffness, &limit, f, NULL));
        *work -= 0.5 * (before + *f) * dz;
    }
    *z = to;
}

/* The steady loop of amplitude X > N/k: 4 N (X - N/k) a cycle. Along the way Masing's rule: what is unloaded follows the first
 * loading curve twice as large, and where an inner loop closes the outer one goes on. */
TEST(masing)
{
    const double k = 2.0, limit = 3.0, most = 4.0;
    double z = 0.0, f = 0.0, work = 0.0;
    move_to(&z, most, k, limit, &f, &work);
    assert_exact(f, -3.0);
    work = 0.0;
    move_to(&z, 2.0, k, limit, &f, &work);
    assert_close(f, k * 2.0 - 3.0, 1e-12);
    move_to(&z, 2.5, k, limit, &f, &work);
    assert_close(f, 0.0, 1e-12);
    move_to(&z, 2.0, k, limit, &f, &work);
    assert_close(f, 1.0, 1e-12);
    move_to(&z, -most, k, limit, &f, &work);
    assert_exact(f, 3.0);
    move_to(&z, most, k, limit, &f, &work);
    assert_close(work, 30.0, 1e-2); /* corners of the loop are cut by steps of 8/1000 */
}

/* The first harmonic of the force over a steady loop, over its amplitude. */
TEST(equivalent_stiffness)
{
    enum { STEPS = 20000 };
    const double k = 2.0, limit = 3.0, most = 4.0, theta = acos(1.0 - 2.0 * limit / (k * most));
    double z = most, f = -limit, sum = 0.0;
    for (int i = 1; i <= STEPS; i++) {
        const double to = most * cos(2.0 * PI * i / STEPS), dz = to - z;
        assert_ok(tribo_elastic_force(1, &dz, &k, &limit, &f, NULL));
        sum -= f * cos(2.0 * PI * i / STEPS);
        z = to;
    }
    assert_close(k / PI * (theta - 0.5 * sin(2.0 * theta)), 0.6850376425, 1e-10);
    assert_close(2.0 * sum / STEPS / most, 0.6850376425, 1e-6);
}

/* On a line, in any direction, the plane is the scalar element. */
TEST(plane_on_a_line)
{
    struct random g = random_of(_i);
    const double angle = uniform(&g, 0.0, 2.0 * PI), limit = uniform(&g, 0.1, 2.0), k = uniform(&g, 0.0, 5.0);
    double line = 0.0, plane[2] = {0.0, 0.0};
    for (int i = 0; i < 50; i++) {
        const double d = uniform(&g, -1.0, 1.0), dz[] = {d * cos(angle), d * sin(angle)};
        assert_ok(tribo_elastic_force(1, &d, &k, &limit, &line, NULL));
        assert_ok(tribo_elastic_force_planar(1, dz, &k, &limit, plane, NULL));
        assert_close(plane[0], line * cos(angle), 1e-14 * limit);
        assert_close(plane[1], line * sin(angle), 1e-14 * limit);
    }
}

/* The force is the point of the disc that is nearest, and df_dz says how it follows. */
TEST(plane)
{
    enum { N = 40 };
    struct random g = random_of(_i);
    double dz[2 * N], k[N], limit[N], f[2 * N], before[2 * N], d[4 * N];
    for (size_t i = 0; i < N; i++) {
        k[i] = uniform(&g, 0.0, 3.0);
        limit[i] = i % 5 ? uniform(&g, 0.0, 2.0) : 0.0;
        for (size_t c = 0; c < 2; c++) {
            before[2 * i + c] = f[2 * i + c] = uniform(&g, -1.0, 1.0);
            dz[2 * i + c] = uniform(&g, -1.0, 1.0);
        }
    }
    assert_ok(tribo_elastic_force_planar(N, dz, k, limit, f, d));
    for (size_t i = 0; i < N; i++) {
        const double to[] = {before[2 * i] - k[i] * dz[2 * i], before[2 * i + 1] - k[i] * dz[2 * i + 1]};
        const double part = fmin(1.0, limit[i] / hypot(to[0], to[1]));
        assert_close(f[2 * i], part * to[0], 1e-15);
        assert_close(f[2 * i + 1], part * to[1], 1e-15);
        for (size_t c = 0; c < 2; c++) {
            const double h = 1e-6;
            double ahead[2] = {before[2 * i], before[2 * i + 1]}, back[2] = {ahead[0], ahead[1]},
                   step[] = {dz[2 * i], dz[2 * i + 1]};
            step[c] += h;
            assert_ok(tribo_elastic_force_planar(1, step, k + i, limit + i, ahead, NULL));
            step[c] -= 2.0 * h;
            assert_ok(tribo_elastic_force_planar(1, step, k + i, limit + i, back, NULL));
            for (size_t r = 0; r < 2; r++) {
                assert_close(d[4 * i + 2 * r + c], (ahead[r] - back[r]) / (2.0 * h), 1e-8);
            }
        }
    }
}

TEST(slope)
{
    const double dz[] = {-0.1, -1.0, 1.0, 0.0}, k[] = {2.0, 2.0, 2.0, 2.0}, limit[] = {1.0, 1.0, 1.0, 0.25},
                 want[] = {-2.0, 0.0, 0.0, 0.0};
    double f[] = {0.5, 0.5, 0.5, 0.5}, d[4];
    assert_ok(tribo_elastic_force(4, dz, k, limit, f, d));
    assert_all_exact(f, ((const double[]){0.7, 1.0, -1.0, 0.25}), 4);
    assert_all_exact(d, want, 4);
    /* With limit 0 the force stays 0. */
    const double none[4] = {0.0};
    double nothing[2] = {0.0, 0.0};
    assert_ok(tribo_elastic_force_planar(1, none, k, none, nothing, d));
    assert_all_exact(d, none, 4);
    assert_ok(tribo_elastic_force(1, none, k, none, nothing, d));
    assert_exact(d[0], 0.0);
    assert_all_exact(nothing, none, 2);
}

/* A displacement so large that stiffness dz is beyond all forces keeps its direction. */
TEST(far)
{
    const double dz[] = {4e200, -3e200}, k = 1e200, limit = 10.0;
    double f[] = {1.0, 1.0}, d[4];
    assert_ok(tribo_elastic_force_planar(1, dz, &k, &limit, f, d));
    assert_all_close(f, ((const double[]){-8.0, 6.0}), 2, 1e-14);
    assert_close(d[0] * 5e200, -3.6, 1e-14);
}

/* Bodies get J' f as from every other call: a mass on an elastic contact, z = x, swings about the spring's zero at sqrt(k/m), and
 * what the contact does to it never adds energy; z = x_1 - x_2 puts f on body 1 and -f on body 2. */
TEST(signs)
{
    enum { STEPS = 20000 };
    const double k = 4.0, limit = 1e3, dt = 0.5 * PI / STEPS;
    const double direction[] = {1.0, -1.0};
    double x[] = {0.25, -0.25}, u[] = {0.0, 0.0}, f = -k * 0.5;
    for (int i = 0; i < STEPS; i++) {
        double dz = 0.0;
        for (int b = 0; b < 2; b++) { /* masses 2: the relative motion has m = 1, omega = 2 */
            u[b] += dt * direction[b] * f / 2.0 * (i ? 1.0 : 0.5);
            x[b] += dt * u[b];
            dz += direction[b] * dt * u[b];
        }
        assert_ok(tribo_elastic_force(1, &dz, &k, &limit, &f, NULL));
    }
    assert_close(x[0] - x[1], -0.5, 1e-6); /* half a period: pi/omega */
    const double v = 3.0, slide = 10.0, small = 1.0;
    double sliding = 0.0, kinetic;
    signed char slip;
    tribo_context *c;
    assert_ok(tribo_create(&c, 1));
    assert_ok(tribo_set_limit_all(c, small));
    assert_ok(tribo_elastic_force(1, &slide, &k, &small, &sliding, NULL));
    const double none = 0.0, one = 1.0;
    assert_ok(tribo_set_operator_diagonal(c, &one));
    assert_ok(tribo_balance(c, &v, &none, NULL, &kinetic));
    assert_ok(tribo_get_slip(c, &slip));
    assert_exact(sliding, kinetic);
    ck_assert_int_eq(slip, TRIBO_SLIP_FORTH);
    tribo_destroy(c);
}

/* Nothing is written on errors, and numbers of any size raise no exception that matters. */
TEST(bad_input)
{
    double dz[] = {0.1, 0.1}, k[] = {1.0, 1.0}, limit[] = {1.0, 1.0}, f[] = {0.5, 0.25}, d[] = {7.0, 7.0};
    double *const all[] = {dz, k, limit, f};
    for (size_t a = 0; a < 4; a++) {
        const double kept = all[a][1];
        all[a][1] = NAN;
        assert_status(tribo_elastic_force(2, dz, k, limit, f, d), TRIBO_ERR_NOT_FINITE);
        assert_status(tribo_elastic_force_planar(1, dz, a == 1 ? k + 1 : k, a == 2 ? limit + 1 : limit, f, NULL),
                      TRIBO_ERR_NOT_FINITE);
        all[a][1] = -1.0;
        assert_status(a == 1 || a == 2 ? tribo_elastic_force(2, dz, k, limit, f, d) : TRIBO_ERR_NEGATIVE, TRIBO_ERR_NEGATIVE);
        all[a][1] = kept;
        assert_status(tribo_elastic_force(2, a == 0 ? NULL : dz, a == 1 ? NULL : k, a == 2 ? NULL : limit, a == 3 ? NULL : f, d),
                      TRIBO_ERR_NULL);
    }
    assert_exact(f[0], 0.5);
    assert_exact(d[0], 7.0);
    assert_status(tribo_elastic_force(SIZE_MAX / 8, dz, k, limit, f, d), TRIBO_ERR_SIZE);
    assert_ok(tribo_elastic_force(0, NULL, NULL, NULL, NULL, NULL));
    const double sizes[] = {0.0, 5e-324, 1e-300, 1.0, 1e300, DBL_MAX};
    for (size_t i = 0; i < 6 * 6 * 6 * 6; i++) {
        const double x = sizes[i % 6], y = sizes[i / 6 % 6], z = sizes[i / 36 % 6], step[] = {x, -z};
        double force[] = {sizes[i / 216], -x}, rate[4];
        assert_ok(tribo_elastic_force_planar(1, step, &y, &z, force, rate));
        require(hypot(force[0] / fmax(z, 1.0), force[1] / fmax(z, 1.0)) <= (1.0 + 1e-15) * fmin(z, 1.0), "%g %g beyond %g",
                force[0], force[1], z);
        assert_ok(tribo_elastic_force(1, &x, &y, &z, force, rate));
        require(fabs(force[0]) <= z, "%g beyond %g", force[0], z);
    }
}

TEST_MAIN("elastic", {masing, 1}, {equivalent_stiffness, 1}, {plane_on_a_line, 20}, {plane, 20}, {slope, 1}, {far, 1}, {signs, 1},
          {bad_input, 1})
