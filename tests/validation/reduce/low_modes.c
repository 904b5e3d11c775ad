/* SPDX-License-Identifier: BSD-3-Clause */
/* Structures that are stiff inside and softly mounted, or free: their low modes are as good as their high ones, rigid-body
 * motions are exactly that, and where nobody can tell one from the other there is an error. */
#include <stdlib.h>
#include <string.h>

#include "make.h"
#include "run.h"

/* -------------------------------------------------------------------------------------------------------- steel beams */

/* A steel bar of 1 m and 10 mm x 10 mm, so many cubic elements long, on a spring at each end. length is that of the unit of
 * length in metres, mass that of the unit of mass in kg; time is in s. */
struct bar {
    size_t elements;
    int lumped;
    double length, mass, bounce; /* bounce: rad/s, of the bar as a rigid body on its springs */
};

struct bar_values {
    double rigidity, weight, span, spring; /* EI, mass per length, length */
};

static struct bar_values values_of(const struct bar *bar)
{
    const double side = 0.01 / bar->length, unit = bar->mass / bar->length; /* of a pressure, with s */
    struct bar_values v = {.rigidity = 2.1e11 / unit * pow(side, 4) / 12.0, .span = 1.0 / bar->length};
    v.weight = 7850.0 * pow(bar->length, 3) / bar->mass * side * side;
    v.spring = 0.5 * v.weight * v.span * bar->bounce * bar->bounce;
    return v;
}

/* Adds factor times an element's matrix. */
static void add_element(double *to, size_t n, size_t at, double factor, double l, const double *shape)
{
    for (size_t k = 0; k < 16; k++) {
        const size_t i = k / 4, j = k % 4;
        to[(2 * at + i) * n + 2 * at + j] += factor * shape[k] * (i % 2 ? l : 1.0) * (j % 2 ? l : 1.0);
    }
}

/* Deflections and rotations in turn: 2 (elements + 1) degrees of freedom. One contact at the middle, and what else is asked. */
static int bar_system(tribo_system **sys, const struct bar *bar, size_t nmode, char *text, size_t size)
{
    const double stiff[] = {12, 6, -12, 6, 6, 4, -6, 2, -12, -6, 12, -6, 6, 2, -6, 4};
    const double full[] = {156, 22, 54, -13, 22, 4, 13, -3, 54, 13, 156, -22, -13, -3, -22, 4};
    const double lumps[] = {210, 0, 0, 0, 0, 17.5, 0, 0, 0, 0, 210, 0, 0, 0, 0, 17.5};
    const struct bar_values v = values_of(bar);
    const size_t n = 2 * (bar->elements + 1);
    const double l = v.span / (double)bar->elements;
    double *k = calloc(n * n, sizeof *k), *m = calloc(n * n, sizeof *m), *j = calloc(n, sizeof *j);
    for (size_t e = 0; e < bar->elements; e++) {
        add_element(k, n, e, v.rigidity / (l * l * l), l, stiff);
        add_element(m, n, e, v.weight * l / 420.0, l, bar->lumped ? lumps : full);
    }
    k[0] += v.spring;
    k[(n - 2) * n + n - 2] += v.spring;
    j[bar->elements / 2 * 2] = 1.0;
    const int status = dense_system(sys, n, 1, m, NULL, k, j, nmode, text, size);
    free(k);
    free(m);
    free(j);
    return status;
}

static tribo_system *bar_create(const struct bar *bar, size_t nmode)
{
    char text[200] = "";
    tribo_system *sys = NULL;
    const int status = bar_system(&sys, bar, nmode, text, sizeof text);
    require(status == TRIBO_OK, "%zu elements: %s", bar->elements, text);
    return sys;
}

/* First omega of an Euler-Bernoulli beam on springs at its ends: tan s + tanh s = spring/(4 EI s^3) L^3 with s = beta L/2, and
 * omega = beta^2 sqrt(EI/m'). */
static double first_omega(const struct bar *bar)
{
    const struct bar_values v = values_of(bar);
    const double ratio = v.spring * pow(v.span, 3) / (4.0 * v.rigidity);
    double lo = 0.0, hi = 0.499 * PI;
    for (int k = 0; k < 200; k++) {
        const double s = 0.5 * (lo + hi);
        *(tan(s) + tanh(s) > ratio / (s * s * s) ? &hi : &lo) = s;
    }
    return pow(2.0 * lo / v.span, 2.0) * sqrt(v.rigidity / v.weight);
}

static const size_t finer[] = {20, 80, 130, 160};

/* On springs of 1 Hz, under the highest mode of up to 28 MHz. */
TEST(soft_mounts)
{
    double omega[6];
    const struct bar bar = {finer[_i / 2], _i % 2, 1.0, 1.0, 2.0 * PI};
    tribo_system *sys = bar_create(&bar, 6);
    assert_ok(tribo_system_get_frequencies(sys, omega));
    assert_close(omega[0] / first_omega(&bar), 1.0, bar.lumped ? 1.3e-3 / pow((double)bar.elements, 2.0) + 2e-8 : 1e-7);
    require(omega[0] < omega[1] && omega[1] < 0.1 * omega[2], "%g, %g, %g", omega[0], omega[1], omega[2]);
    tribo_system_destroy(sys);
}

/* Such a beam shaken, its contact open: it moves as with few elements, which no rounding harms. */
TEST(soft_mounts_shaken)
{
    double middle[2];
    for (size_t k = 0; k < 2; k++) {
        const struct bar bar = {k ? 100 : 10, _i, 1.0, 1.0, 2.0 * PI};
        tribo_system *sys = bar_create(&bar, 0);
        const size_t n = tribo_system_ndof(sys);
        double *y = calloc(2 * n + 1, sizeof *y), *load = calloc(n, sizeof *load);
        load[0] = load[n - 2] = 0.1;
        assert_ok(tribo_system_add_load(sys, 2.0, NULL, load));
        run(sys, "exact", 1.0, 0.0, 10.3, y);
        middle[k] = y[bar.elements];
        free(y);
        free(load);
        tribo_system_destroy(sys);
    }
    require(fabs(middle[0]) > 1e-3 && fabs(middle[0]) < 0.1, "%g m", middle[0]);
    assert_close(middle[1] / middle[0], 1.0, 2e-4); /* 10 elements with lumped masses */
}

/* Free in space the beam has two rigid-body modes, omega = 0 exactly, in m and kg and in mm and t. Bending begins at
 * 4.730040745^2 sqrt(EI/m'). */
TEST(free_beams)
{
    const size_t elements[] = {4, 20, 80, 160};
    double omega[4];
    const int small = _i / 2 % 2;
    const struct bar bar = {elements[_i / 4], _i % 2, small ? 1e-3 : 1.0, small ? 1e3 : 1.0, 0.0};
    const struct bar_values v = values_of(&bar);
    tribo_system *sys = bar_create(&bar, 4);
    assert_ok(tribo_system_get_frequencies(sys, omega));
    assert_exact(omega[0], 0.0);
    assert_exact(omega[1], 0.0);
    const double bending = 22.37328545 * sqrt(v.rigidity / v.weight) / (v.span * v.span), h = 4.73 / (double)bar.elements;
    assert_close(omega[2] / bending, 1.0, bar.lumped ? 0.3 * h * h : 1e-3 * pow(h, 4) + 1e-8);
    tribo_system_destroy(sys);
}

/* Thrown, it flies on and turns on; nothing else happens to it. */
TEST(free_flight)
{
    const struct bar bar = {40, _i % 2, _i / 2 ? 1e-3 : 1.0, _i / 2 ? 1e3 : 1.0, 0.0};
    const double span = 1.0 / bar.length, speed = 3.0 * span, turn = 0.01;
    tribo_system *sys = bar_create(&bar, 0);
    const size_t n = tribo_system_ndof(sys);
    double *y = calloc(2 * n + 1, sizeof *y), *want = calloc(2 * n + 1, sizeof *want);
    for (size_t i = 0; i < n; i++) {
        const double rate = i % 2 ? turn : speed + turn * span * ((double)i / 2.0 / 40.0 - 0.5);
        y[n + i] = want[n + i] = rate;
        want[i] = 100.0 * rate;
    }
    run(sys, "exact", 1.0, 0.0, 100.0, y);
    for (size_t i = 0; i < 2 * n; i++) {
        const double size = (i < n ? 100.0 : 1.0) * (i % 2 ? turn : speed);
        assert_close(y[i], want[i], 1e-8 * size);
    }
    free(y);
    free(want);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------- few degrees of freedom */

/* A soft mode beside one that is stiffer by any factor: q_1 = cos t. */
TEST(beside_a_stiff_one)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {pow(10.0, 2.0 * _i), 0.0, 0.0, 1.0}, direction[] = {1.0, 0.0};
    double y[5] = {0.0, 1.0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 1, mass, NULL, stiffness, direction, 0, NULL, 0));
    run(sys, "exact", 1.0, 0.0, 10.0, y);
    assert_close(y[1], cos(10.0), 1e-13);
    assert_close(y[3], -sin(10.0), 1e-13);
    tribo_system_destroy(sys);
}

/* The same with damping in proportion to the stiffness, whose small part is kept as well. */
TEST(damping_beside_a_stiff_one)
{
    const double r = pow(10.0, 2.0 * _i), zeta = 0.013, slow = sqrt(1.0 - zeta * zeta);
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {r, 0.0, 0.0, 1.0},
                 damping[] = {2.0 * zeta * r, 0.0, 0.0, 2.0 * zeta};
    const double direction[] = {1.0, 0.0};
    double y[5] = {0.0, 1.0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 1, mass, damping, stiffness, direction, 0, NULL, 0));
    run(sys, "exact", 1.0, 0.0, 10.0, y);
    assert_close(y[1], exp(-10.0 * zeta) * (cos(10.0 * slow) + zeta / slow * sin(10.0 * slow)), 1e-13);
    tribo_system_destroy(sys);
}

/* And with damping that couples the two, by a cross term c: to first order in 1/r it adds nothing to the soft mode, and its own
 * part stays, up to any r. */
TEST(coupling_to_a_stiff_one)
{
    const double r = pow(10.0, 4.0 * _i), zeta = 0.01, slow = sqrt(1.0 - zeta * zeta);
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {r, 0.0, 0.0, 1.0};
    const double damping[] = {0.02 * sqrt(r), 1e-3, 1e-3, 2.0 * zeta}, direction[] = {1.0, 0.0};
    double y[5] = {0.0, 1.0}, t = 0.0;
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 1, mass, damping, stiffness, direction, 0, NULL, 0));
    tribo_driver *drv = driver_create(sys, "exact", 1.0, 0.0);
    driver_advance(drv, &t, 10.0, y);
    assert_close(y[1], exp(-10.0 * zeta) * (cos(10.0 * slow) + zeta / slow * sin(10.0 * slow)), 1e-5 / sqrt(r) + 1e-7);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* A stiff one of damping ratio 1/2 is no weakly damped mode: exponents that QR does not resolve are refused. */
TEST(strong_coupling_to_a_stiff_one)
{
    const double r = 1e20, mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {r, 0.0, 0.0, 1.0}, direction[] = {1.0, 0.0};
    const double damping[] = {sqrt(r), 1e-3, 1e-3, 0.02};
    double y[5] = {0.0, 1.0}, t = 0.0;
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 1, mass, damping, stiffness, direction, 0, NULL, 0));
    tribo_driver *drv = driver_create(sys, "exact", 1.0, 0.0);
    assert_status(tribo_driver_advance(drv, &t, 10.0, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(drv), "too different frequencies");
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Two masses of 1 on a spring r, one of them on a spring of 1: the lower omega^2 is near 1/2, as long as r + 1 and r tell. In
 * between nobody knows. */
TEST(from_a_spring_to_rounding)
{
    const double r = pow(2.0, 4.0 * _i), mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {r, -r, -r, r + 1.0};
    const double high = r + 0.5 + sqrt(r * r + 0.25), low = r > 4e15 ? 0.0 : r / high; /* their product is r, their sum 2 r + 1 */
    const double direction[] = {1.0, 0.0}, noise = 1e-15 * r;
    double omega[2], y[5] = {0.0, 0.0, 1.0, 1.0 - low / r}, t = 0.0;
    char text[200] = "";
    tribo_system *sys = NULL, *whole;
    assert_ok(dense_system(&whole, 2, 1, mass, NULL, stiffness, direction, 0, NULL, 0));
    tribo_driver *drv = driver_create(whole, "exact", 1.0, 0.0);
    const int status = dense_system(&sys, 2, 1, mass, NULL, stiffness, direction, 2, text, sizeof text);
    ck_assert_int_eq(tribo_driver_advance(drv, &t, 10.0, y), status);
    if (status) {
        assert_status(status, TRIBO_ERR_UNSUPPORTED);
        assert_says(text, "of mode 0 is hardly more than rounding of the stiffness");
        assert_says(tribo_driver_message(drv), "of mode 0 is hardly more than rounding of the stiffness");
        require(r > 1e12 && r < 1e16, "refused at %g", r);
    } else {
        require(r < 1e14 || r > 4e15, "accepted at %g", r);
        assert_ok(tribo_system_get_frequencies(sys, omega));
        assert_close(omega[0], sqrt(low), r > 4e15 ? 0.0 : 1e-15 + noise);
        assert_close(omega[1] / sqrt(high), 1.0, 1e-14);
        assert_close(y[0], low > 0.0 ? sin(10.0 * sqrt(low)) / sqrt(low) : 10.0, low > 0.0 ? 1e-12 + 10.0 * noise : 1e-12);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    tribo_system_destroy(whole);
}

/* Free chains with springs of any size: one rigid-body mode, to the bit; with a soft spring to the ground there is none. */
TEST(chains)
{
    enum { MASSES = 12 };
    struct random g = random_of(_i);
    double mass[MASSES * MASSES] = {0}, stiffness[MASSES * MASSES] = {0}, direction[MASSES] = {1.0}, omega[MASSES], all = 0.0;
    for (size_t i = 0; i < MASSES; i++) {
        all += mass[i * (MASSES + 1)] = pow(10.0, uniform(&g, -2.0, 2.0));
    }
    for (size_t i = 1; i < MASSES; i++) {
        const double k = pow(10.0, uniform(&g, 2.0, 9.0));
        stiffness[i * (MASSES + 1)] += k;
        stiffness[(i - 1) * (MASSES + 1)] += k;
        stiffness[i * MASSES + i - 1] = stiffness[(i - 1) * MASSES + i] = -k;
    }
    for (int grounded = 0; grounded < 2; grounded++) {
        tribo_system *sys;
        stiffness[MASSES * MASSES - 1] += grounded ? 1.0 : 0.0;
        assert_ok(dense_system(&sys, MASSES, 1, mass, NULL, stiffness, direction, MASSES, NULL, 0));
        assert_ok(tribo_system_get_frequencies(sys, omega));
        require(omega[1] > 0.0, "two rigid bodies");
        if (grounded) {
            assert_close(omega[0] / sqrt(1.0 / all), 1.0, 0.02); /* all masses on the spring of 1, nearly */
        } else {
            assert_exact(omega[0], 0.0);
        }
        tribo_system_destroy(sys);
    }
}

TEST_MAIN("low_modes", {soft_mounts, 8}, {soft_mounts_shaken, 2}, {free_beams, 16}, {free_flight, 4}, {beside_a_stiff_one, 13},
          {damping_beside_a_stiff_one, 10}, {coupling_to_a_stiff_one, 6}, {strong_coupling_to_a_stiff_one, 1},
          {from_a_spring_to_rounding, 16}, {chains, 20})
