/* SPDX-License-Identifier: BSD-3-Clause */
/* Equilibria of steady sliding, their exponents, and the onset of flutter, beside closed forms; of random structures beside
 * derivatives and the Jacobian of the system. */
#include "run.h"
#include "squeal.h"

#include <complex.h>
#include <string.h>

/* m = k = 1, damping c, on a base of this velocity, with a limit of 0.6. */
static tribo_system *block(double c, double belt)
{
    const double one = 1.0;
    tribo_system *sys = finish_model(dense_model(1, 1, &one, &c, &one, &one));
    assert_ok(tribo_system_add_base_motion(sys, 0.0, &belt, NULL));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.6));
    return sys;
}

static size_t find(tribo_system *sys, const signed char *given, double *y, signed char *slip, double *re, double *im)
{
    size_t count;
    const int status = tribo_system_equilibrium(sys, given, y, slip, &count, re, im);
    require(!status, "%s", tribo_system_message(sys));
    return count;
}

/* K of squeal, with the normal stiffness in it. */
static void squeal_stiffness(double *k)
{
    const double a = PI / 6.0;
    k[0] = 31.0 * cos(a) * cos(a);
    k[1] = k[2] = 9.0 * cos(a) * sin(a);
    k[3] = 31.0 * sin(a) * sin(a) + 11.0;
}

/* The undamped state of squeal: place and exponents below and above flutter; the belt in the other direction is stable, and so is
 * one at rest, where the direction may be given. */
TEST(mode_coupling)
{
    const double mu = _i ? 0.6 : 0.4;
    tribo_system *sys = squeal(0.5, mu, 0.0);
    double k[4], y[5] = {7.0, 3.0, 1.0, 1.0, 1.0}, re[4], im[4];
    signed char slip[2];
    squeal_stiffness(k);
    k[1] -= mu * 11.0;
    const double det = k[0] * k[3] - k[1] * k[2], mean = 0.5 * (k[0] + k[3]);
    const double complex root = csqrt(mean * mean - det), up = csqrt(-(mean + root)), low = csqrt(-(mean - root));
    ck_assert_uint_eq(find(sys, NULL, y, slip, re, im), 4);
    assert_close(y[0], -10.0 * k[1] / det, 1e-14);
    assert_close(y[1], 10.0 * k[0] / det, 1e-14);
    assert_all_exact(y + 2, ((double[]){0.0, 0.0, 0.0}), 3);
    ck_assert_int_eq(slip[0], TRIBO_SLIP_BACK);
    ck_assert_int_eq(slip[1], TRIBO_SLIP_OPEN);
    assert_close(re[0], _i ? fabs(creal(up)) : 0.0, _i ? 1e-13 : 0.0);
    assert_close(re[3], _i ? -fabs(creal(up)) : 0.0, _i ? 1e-13 : 0.0);
    assert_close(im[0], fabs(cimag(up)), 1e-13);
    assert_close(im[2], fabs(cimag(low)), 1e-13);
    assert_exact(im[1], -im[0]);
    tribo_system_destroy(sys);
}

/* mu_c of squeal, of one structure and of two alike, for a belt that moves and for a direction that is given. */
TEST(onset)
{
    double k[4], critical, omega;
    squeal_stiffness(k);
    const double mu = ((k[0] - k[3]) * (k[0] - k[3]) + 4.0 * k[1] * k[1]) / (4.0 * k[1] * 11.0);
    assert_close(mu, 0.47237749297, 1e-11);
    tribo_system *sys = squeal(_i ? 0.0 : 0.5, 0.6, 0.0);
    const signed char back[] = {TRIBO_SLIP_BACK, 0};
    assert_ok(tribo_system_find_flutter(sys, TRIBO_FLUTTER_FRICTION, _i ? back : NULL, NULL, 0.0, 1.3, &critical, &omega));
    assert_close(0.6 * critical, mu, 1e-12);
    assert_close(omega, sqrt(0.5 * (k[0] + k[3])), 1e-12);
    assert_close(omega, 4.5825756950, 1e-9);
    assert_ok(tribo_system_find_flutter(sys, TRIBO_FLUTTER_FRICTION, _i ? back : NULL, NULL, 0.0, 0.78, &critical, &omega));
    assert_exact(critical, HUGE_VAL);
    assert_exact(omega, 0.0);
    assert_status(tribo_system_find_flutter(sys, TRIBO_FLUTTER_FRICTION, _i ? back : NULL, NULL, 1.0, 0.0, &critical, &omega),
                  TRIBO_ERR_RANGE);
    assert_says(tribo_system_message(sys), "not stable at the factor from = 1");
    tribo_system_destroy(sys);
}

/* Squeal without and with damping, held off the belt by a load of 1 until a second contact, of limit 0.7 times the factor,
 * presses it down: flutter begins at a jump, as the normal touches. */
TEST(touch_down)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, damping[] = {0.1, 0.0, 0.0, 0.1}, j[] = {1.0, 0.0, 0.0, 1.0, 0.0, 1.0};
    const double load[] = {0.0, -1.0}, belt[] = {0.5, 0.0, 1.0}, limit[] = {0.0, 0.0, 0.7};
    double k[4], critical, omega;
    squeal_stiffness(k);
    k[3] -= 11.0;
    tribo_model *model = dense_model(2, 3, mass, _i ? damping : NULL, k, j);
    assert_ok(tribo_model_set_normal(model, 0, 1, 0.6, 11.0, 0.0));
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_system_add_load(sys, 0.0, load, NULL));
    assert_ok(tribo_system_add_base_motion(sys, 0.0, belt, NULL));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    const int status = tribo_system_find_flutter(sys, TRIBO_FLUTTER_FRICTION, NULL, NULL, 0.0, 2.0, &critical, &omega);
    require(!status, "%s", tribo_system_message(sys));
    assert_close(critical, 1.0 / 0.7, 1e-8);
    /* squares mean + i rest; lambda^2 + 0.1 lambda + square = 0 with damping */
    const double mean = 0.5 * (k[0] + k[3] + 11.0), det = k[0] * (k[3] + 11.0) - (k[1] - 0.6 / 0.7 * 11.0) * k[2];
    const double complex square = mean + sqrt(det - mean * mean) * (double complex)_Complex_I;
    assert_close(omega, _i ? fabs(cimag(csqrt(0.0025 - square))) : sqrt(mean), 1e-8);
    tribo_system_destroy(sys);
}

/* Two structures as squeal, alike: each exponent twice, and both merge at once. */
TEST(alike)
{
    double own[4], k[16] = {0.0}, mass[16] = {0.0}, j[16] = {0.0}, load[4] = {0.0, 10.0, 0.0, 10.0}, critical, omega;
    const double belt[4] = {0.5, 0.0, 0.5, 0.0};
    squeal_stiffness(own);
    own[3] -= 11.0;
    for (size_t d = 0; d < 4; d++) {
        mass[5 * d] = j[5 * d] = 1.0;
        k[5 * d] = own[3 * (d % 2)];
        k[4 * d + (d ^ 1)] = own[1];
    }
    tribo_model *model = dense_model(4, 4, mass, NULL, k, j);
    assert_ok(tribo_model_set_normal(model, 0, 1, 0.6, 11.0, 0.0));
    assert_ok(tribo_model_set_normal(model, 2, 3, 0.6, 11.0, 0.0));
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_system_add_load(sys, 0.0, load, NULL));
    assert_ok(tribo_system_add_base_motion(sys, 0.0, belt, NULL));
    const int status = tribo_system_find_flutter(sys, TRIBO_FLUTTER_FRICTION, NULL, NULL, 0.0, 1.3, &critical, &omega);
    require(!status, "%s", tribo_system_message(sys));
    assert_close(0.6 * critical, 0.47237749297, 1e-11);
    double y[9] = {0.0}, re[8], im[8];
    ck_assert_uint_eq(find(sys, NULL, y, NULL, re, im), 8);
    assert_close(re[0], re[2], 1e-13);
    assert_close(y[0], y[2], 1e-14);
    tribo_system_destroy(sys);
}

/* A limit that is constant leaves the exponents of the structure without friction. */
TEST(constant_limit)
{
    tribo_system *sys = block(_i ? 0.1 : 0.0, _i ? -0.2 : 0.2);
    double y[3] = {0.0}, re[2], im[2];
    signed char slip;
    ck_assert_uint_eq(find(sys, NULL, y, &slip, re, im), 2);
    assert_close(y[0], _i ? -0.6 : 0.6, 1e-15);
    ck_assert_int_eq(slip, _i ? TRIBO_SLIP_FORTH : TRIBO_SLIP_BACK);
    assert_close(re[0], _i ? -0.05 : 0.0, _i ? 1e-14 : 0.0);
    assert_close(im[0], _i ? sqrt(1.0 - 0.0025) : 1.0, 1e-14);
    assert_exact(im[1], -im[0]);
    assert_exact(re[1], re[0]);
    tribo_system_destroy(sys);
}

/* A stiffness that is not symmetric: squares 5 + 3i, 5 - 3i; the friction of a constant limit has no part in it. */
TEST(circulation)
{
    const double one[] = {1.0, 0.0, 0.0, 1.0}, k[] = {5.0, 3.0, -3.0, 5.0}, belt[] = {1.0, 1.0};
    tribo_system *sys = finish_model(dense_model(2, 2, one, NULL, k, one));
    double y[5] = {0.0}, re[4], im[4], critical;
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.5));
    assert_ok(tribo_system_add_base_motion(sys, 0.0, belt, NULL));
    ck_assert_uint_eq(find(sys, NULL, y, NULL, re, im), 4);
    const double complex lambda = csqrt(-5.0 + 3.0 * (double complex)_Complex_I);
    assert_close(re[0], creal(lambda), 1e-14);
    assert_close(im[0], cimag(lambda), 1e-14);
    assert_close(re[3], -creal(lambda), 1e-14);
    assert_close(y[0], 0.5 * (5.0 - 3.0) / 34.0, 1e-15);
    assert_close(y[1], 0.5 * (5.0 + 3.0) / 34.0, 1e-15);
    assert_status(tribo_system_find_flutter(sys, TRIBO_FLUTTER_FRICTION, NULL, NULL, 0.0, 1.0, &critical, NULL), TRIBO_ERR_RANGE);
    tribo_system_destroy(sys);
}

/* Without contacts: the structure alone; without limits, contacts on a belt are open. */
TEST(no_friction)
{
    const double one = 1.0, k = 4.0, load = 2.0, belt = 1.0;
    tribo_model *model;
    assert_ok(tribo_model_create(&model, 1, 0));
    assert_ok(tribo_model_set_mass(model, &one));
    assert_ok(tribo_model_set_stiffness(model, &k));
    tribo_system *sys = finish_model(_i ? dense_model(1, 1, &one, NULL, &k, &one) : model);
    double y[3] = {0.0}, re[2], im[2], critical;
    signed char slip = 7;
    if (_i) {
        tribo_model_destroy(model);
        assert_ok(tribo_system_add_base_motion(sys, 0.0, &belt, NULL));
    }
    assert_ok(tribo_system_add_load(sys, 0.0, &load, NULL));
    ck_assert_uint_eq(find(sys, NULL, y, &slip, re, im), 2);
    assert_close(y[0], 0.5, 1e-15);
    assert_close(im[0], 2.0, 1e-15);
    ck_assert_int_eq(slip, _i ? TRIBO_SLIP_OPEN : 7);
    assert_ok(tribo_system_find_flutter(sys, TRIBO_FLUTTER_FRICTION, NULL, NULL, 0.0, 3.0, &critical, NULL));
    assert_exact(critical, HUGE_VAL);
    tribo_system_destroy(sys);
}

/* A limit 0.6 + 0.4 exp(-|v|/0.5) takes 0.8 exp(-|v|/0.5) away from the damping. */
TEST(falling_limit)
{
    const double ratio = 1.0 / 0.6, velocity = 0.5, c = 0.115;
    tribo_system *sys = block(c, 1.0);
    double y[3] = {0.0}, re[2], im[2], critical, omega;
    assert_ok(tribo_set_static(tribo_system_context(sys), &ratio, &velocity));
    find(sys, NULL, y, NULL, re, im);
    const double half = 0.5 * (c - 0.8 * exp(-2.0));
    assert_close(y[0], 0.6 + 0.4 * exp(-2.0), 1e-14);
    assert_close(re[0], -half, 1e-14);
    assert_close(im[0], sqrt(1.0 - half * half), 1e-14);
    assert_ok(tribo_system_find_flutter(sys, TRIBO_FLUTTER_SPEED, NULL, NULL, 2.0, 0.1, &critical, &omega));
    assert_close(critical, 0.5 * log(0.8 / c), 1e-12);
    assert_close(omega, 1.0, 1e-12);
    assert_ok(tribo_system_find_flutter(sys, TRIBO_FLUTTER_FRICTION, NULL, NULL, 0.0, 3.0, &critical, NULL));
    assert_close(critical, c / (0.8 * exp(-2.0)), 1e-12);
    const signed char back = TRIBO_SLIP_BACK;
    assert_ok(tribo_system_clear_base_motion(sys));
    find(sys, &back, y, NULL, re, im);
    assert_close(y[0], 1.0, 1e-14);
    assert_close(re[0], 0.5 * (0.8 - c), 1e-14);
    tribo_system_destroy(sys);
}

/* The block beside a body on a spring, without a contact and without damping, of the same frequency or almost: its exponents have
 * no part in the onset. */
TEST(beside_undamped)
{
    const double one[] = {1.0, 0.0, 0.0, 1.0}, k[] = {1.0, 0.0, 0.0, _i ? 1.001 : 1.0}, damping[] = {0.115, 0.0, 0.0, 0.0};
    const double belt = 1.0, ratio = 1.0 / 0.6, velocity = 0.5;
    tribo_system *sys = finish_model(dense_model(2, 1, one, damping, k, one));
    double critical, omega;
    assert_ok(tribo_system_add_base_motion(sys, 0.0, &belt, NULL));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.6));
    assert_ok(tribo_set_static(tribo_system_context(sys), &ratio, &velocity));
    assert_ok(tribo_system_find_flutter(sys, TRIBO_FLUTTER_SPEED, NULL, NULL, 2.0, 0.1, &critical, &omega));
    assert_close(critical, 0.5 * log(0.8 / 0.115), 1e-11);
    assert_close(omega, 1.0, 1e-12);
    assert_ok(tribo_system_find_flutter(sys, TRIBO_FLUTTER_FRICTION, NULL, NULL, 0.0, 3.0, &critical, &omega));
    assert_close(critical, 0.115 / (0.8 * exp(-2.0)), 1e-11);
    assert_close(omega, 1.0, 1e-12);
    tribo_system_destroy(sys);
}

/* A body with two contacts side by side and a second body on a spring from it: the contacts share the force as limits allow, and
 * hold the first body. */
TEST(shared)
{
    static const double limit[][2] = {{0.6, 0.6}, {0.2, 0.9}, {0.45, 0.45}, {0.5, 0.5}};
    const double mass[] = {1.0, 0.0, 0.0, 2.0}, k[] = {3.0, -2.0, -2.0, 2.0}, j[] = {1.0, 0.0, 2.0, 0.0};
    const double twice[] = {1.0, 0.0, 1.0, 0.0}, load[] = {1.0, 0.0};
    tribo_system *sys = finish_model(dense_model(2, 2, mass, NULL, k, _i == 3 ? j : twice));
    double y[5] = {0.0, 7.0}, re[4], im[4];
    signed char slip[2];
    size_t count;
    assert_ok(tribo_system_add_load(sys, 0.0, load, NULL));
    assert_ok(tribo_system_add_load(sys, 3.0, load, load));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit[_i]));
    if (_i == 2) {
        assert_status(tribo_system_equilibrium(sys, NULL, y, slip, &count, re, im), TRIBO_ERR_NO_CONVERGENCE);
        assert_says(tribo_system_message(sys), "cannot rest");
        assert_exact(y[1], 7.0);
    } else {
        ck_assert_uint_eq(find(sys, NULL, y, slip, re, im), 2);
        assert_all_close(y, ((double[]){0.0, 0.0, 0.0, 0.0, 0.0}), 5, 1e-15);
        assert_close(im[0], 1.0, 1e-14);
        assert_exact(re[0], 0.0);
        ck_assert_int_eq(slip[0], TRIBO_SLIP_STUCK);
        ck_assert_int_eq(slip[1], TRIBO_SLIP_STUCK);
    }
    tribo_system_destroy(sys);
}

/* A contact with a spring rests: the spring counts, from where its slider is; at the limit it is refused, and on a belt it has
 * the limit. */
TEST(springs)
{
    const double one = 1.0, soft = 0.5, load = 1.2, belt = -1.0;
    tribo_model *model = dense_model(1, 1, &one, NULL, &one, &one);
    assert_ok(tribo_model_set_compliance(model, &soft));
    tribo_system *sys = finish_model(model);
    double y[4] = {0.0, 0.0, 0.3, 0.0}, re[2], im[2];
    signed char slip;
    assert_ok(tribo_system_add_load(sys, 0.0, &load, NULL));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.8));
    find(sys, NULL, y, &slip, re, im);
    assert_close(y[0], (load + 2.0 * 0.3) / 3.0, 1e-15); /* the spring of stiffness 2 begins at 0.3 */
    assert_close(y[2], 0.3, 1e-15);
    assert_close(im[0], sqrt(3.0), 1e-14);
    ck_assert_int_eq(slip, TRIBO_SLIP_STUCK);
    y[2] = -0.2;
    assert_status(tribo_system_equilibrium(sys, NULL, y, NULL, NULL, NULL, NULL), TRIBO_ERR_NO_CONVERGENCE);
    assert_ok(tribo_system_add_base_motion(sys, 0.0, &belt, NULL));
    find(sys, NULL, y, &slip, re, im);
    assert_close(y[0], load - 0.8, 1e-15);
    assert_close(y[2], y[0] - 0.4, 1e-15);
    assert_close(im[0], 1.0, 1e-14);
    ck_assert_int_eq(slip, TRIBO_SLIP_FORTH);
    tribo_system_destroy(sys);
}

/* Of a structure reduced to one mode and the compliance of its contact a harmonic load moves the contact: it does not act. The
 * slider on a belt leaves the mode its frequency, one at rest has the stiffness of the contact. */
TEST(reduced)
{
    const double mass[] = {1.0, 0.0, 0.0, 2.0}, k[] = {3.0, -2.0, -2.0, 2.0}, j[] = {1.0, 0.0}, load[] = {1.0, 0.5}, belt = 1.0;
    tribo_model *model = dense_model(2, 1, mass, NULL, k, j);
    tribo_system *sys;
    double y[8] = {0.0}, re[4], im[4], natural[2], stuck;
    signed char slip;
    assert_ok(tribo_system_reduce(&sys, model, 1, TRIBO_STATICS_COMPLIANCE));
    assert_ok(tribo_system_get_frequencies(sys, natural));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.7));
    assert_ok(tribo_system_add_load(sys, 3.0, load, load));
    ck_assert_uint_eq(find(sys, NULL, y, &slip, re, im), 2);
    ck_assert_int_eq(slip, TRIBO_SLIP_STUCK);
    stuck = im[0];
    assert_ok(tribo_system_add_base_motion(sys, 0.0, &belt, NULL));
    ck_assert_uint_eq(find(sys, NULL, y, &slip, re, im), 2);
    ck_assert_int_eq(slip, TRIBO_SLIP_BACK);
    assert_close(im[0], natural[0], 1e-13);
    /* omega^2 = 2 - sqrt 3; at rest the compliance, equal to the square of the shape at the contact, adds 1 */
    assert_close(natural[0], sqrt(2.0 - sqrt(3.0)), 1e-14);
    assert_close(stuck, sqrt(3.0 - sqrt(3.0)), 1e-13);
    tribo_system_destroy(sys);
    tribo_model_destroy(model);
}

/* A body in the plane on a belt: across the belt friction is damping, limit over speed. */
TEST(across)
{
    const double one[] = {1.0, 0.0, 0.0, 1.0}, k[] = {4.0, 0.0, 0.0, 9.0}, belt[] = {0.3, 0.4};
    tribo_system *sys = finish_model(dense_model(2, 2, one, NULL, k, one));
    const size_t first = 0;
    double y[5] = {0.0}, re[4], im[4];
    signed char slip[2];
    assert_ok(tribo_set_planar(tribo_system_context(sys), 1, &first));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 2.0));
    assert_ok(tribo_system_add_base_motion(sys, 0.0, belt, NULL));
    find(sys, NULL, y, slip, re, im);
    assert_close(y[0], 0.3, 1e-15); /* 2 (0.6, 0.8), over the stiffness */
    assert_close(y[1], 1.6 / 9.0, 1e-15);
    ck_assert_int_eq(slip[0], TRIBO_SLIP_PLANE);
    ck_assert_int_eq(slip[1], TRIBO_SLIP_PLANE);
    /* damping 4 e e', e across the belt: x z + 4 lambda (0.64 z + 0.36 x) = 0, x = lambda^2 + 4, z = lambda^2 + 9 */
    for (size_t k0 = 0; k0 < 4; k0++) {
        const double complex l = re[k0] + im[k0] * (double complex)_Complex_I, x = l * l + 4.0, z = l * l + 9.0;
        require(cabs(x * z + 4.0 * l * (0.64 * z + 0.36 * x)) < 1e-11, "lambda = %g + %g i", re[k0], im[k0]);
    }
    assert_ok(tribo_system_clear_base_motion(sys));
    memset(y, 0, sizeof y);
    ck_assert_uint_eq(find(sys, NULL, y, slip, re, im), 0);
    ck_assert_int_eq(slip[1], TRIBO_SLIP_STUCK);
    const double load[] = {1.5, 1.5};
    assert_ok(tribo_system_add_load(sys, 0.0, load, NULL));
    assert_status(tribo_system_equilibrium(sys, NULL, y, NULL, NULL, NULL, NULL), TRIBO_ERR_NO_CONVERGENCE); /* a disc, no box */
    tribo_system_destroy(sys);
}

/* Squeal in several directions of the load: pressed, open; at a friction that jams: two equilibria, or none. */
TEST(lifts)
{
    static const double load[] = {10.0, -10.0, 10.0, -10.0};
    static const int want[] = {TRIBO_OK, TRIBO_OK, TRIBO_ERR_UNSUPPORTED, TRIBO_ERR_NO_CONVERGENCE};
    const int jams = _i > 1;
    tribo_system *sys = squeal(jams ? -0.5 : 0.5, jams ? 20.0 : 0.3, 0.0);
    double k[4], y[5] = {0.0}, re[4], im[4];
    const double press[] = {0.0, load[_i] * (jams ? -1.0 : 1.0)};
    size_t count;
    signed char slip[2];
    squeal_stiffness(k);
    k[3] -= 11.0;
    assert_ok(tribo_system_clear_loads(sys));
    assert_ok(tribo_system_add_load(sys, 0.0, press, NULL));
    const int status = tribo_system_equilibrium(sys, NULL, y, slip, &count, re, im);
    require(status == want[_i], "%d: %s", status, tribo_system_message(sys));
    if (_i == 1) {
        const double det = k[0] * k[3] - k[1] * k[2], mean = 0.5 * (k[0] + k[3]);
        assert_close(y[1], -10.0 * k[0] / det, 1e-14);
        assert_close(im[0], sqrt(mean + sqrt(mean * mean - det)), 1e-13);
        ck_assert_int_eq(slip[0], TRIBO_SLIP_OPEN);
    }
    tribo_system_destroy(sys);
}

/* ----------------------------------------------------------------------------------------------------- random structures */

enum { DOFS = 5, ROWS = 6, SIZE = 2 * DOFS };

/* a [n][n] = x'x + shift. */
static void random_form(struct random *g, size_t n, double shift, double *a)
{
    double x[DOFS * DOFS];
    for (size_t k = 0; k < n * n; k++) {
        x[k] = uniform(g, -1.0, 1.0);
    }
    for (size_t at = 0; at < n * n; at++) {
        a[at] = at / n == at % n ? shift : 0.0;
        for (size_t k = 0; k < n; k++) {
            a[at] += x[k * n + at / n] * x[k * n + at % n];
        }
    }
}

/* log |det(A - lambda)| of A [SIZE][SIZE], rows of stride SIZE + 1. */
static double log_det(const double *a, double complex lambda)
{
    double complex m[SIZE][SIZE];
    double sum = 0.0;
    for (size_t i = 0; i < SIZE; i++) {
        for (size_t k = 0; k < SIZE; k++) {
            m[i][k] = a[i * (SIZE + 1) + k] - (i == k ? lambda : 0.0);
        }
    }
    for (size_t k = 0; k < SIZE; k++) {
        size_t p = k;
        for (size_t i = k; i < SIZE; i++) {
            p = cabs(m[i][k]) > cabs(m[p][k]) ? i : p;
        }
        for (size_t l = 0; l < SIZE; l++) {
            const double complex z = m[k][l];
            m[k][l] = m[p][l];
            m[p][l] = z;
        }
        sum += log(cabs(m[k][k]));
        for (size_t i = k + 1; i < SIZE; i++) {
            const double complex by = m[i][k] / m[k][k];
            for (size_t l = k; l < SIZE; l++) {
                m[i][l] -= by * m[k][l];
            }
        }
    }
    return sum;
}

/* Two contacts with normals, of which the second rests in every third structure; two with limits of their own, that fall in the
 * structures without normals. At the equilibrium the derivative of the state is 0, and each exponent is an eigenvalue of the
 * Jacobian. Refusals are rare. */
TEST(random_structures)
{
    double mass[DOFS * DOFS], damping[DOFS * DOFS], stiffness[DOFS * DOFS], j[ROWS * DOFS], load[DOFS], belt[ROWS];
    const double ratio[ROWS] = {1.0, 1.0, 1.0, 1.0, 1.5, 2.0}, velocity[ROWS] = {1.0, 1.0, 1.0, 1.0, 0.7, 0.3};
    int found = 0, open = 0;
    for (int seed = 0; seed < 300; seed++) {
        struct random g = random_of(seed);
        const int normals = seed % 2, rests = seed % 3 == 0, damped = seed % 5 != 0;
        random_form(&g, DOFS, 0.5, mass);
        random_form(&g, DOFS, 1.0, stiffness);
        random_form(&g, DOFS, 0.0, damping);
        stiffness[1] += seed % 7 == 0 ? 0.5 : 0.0;
        for (size_t k = 0; k < ROWS * DOFS; k++) {
            j[k] = uniform(&g, -1.0, 1.0);
        }
        for (size_t k = 0; k < DOFS; k++) {
            load[k] = uniform(&g, -1.0, 1.0);
        }
        const double limits[ROWS] = {normals ? 0.0 : 0.3, 0.0, normals ? 0.0 : rests ? 9.0 : 0.2, 0.0, 0.1, 0.2};
        for (size_t i = 0; i < ROWS; i++) {
            belt[i] = i == 1 || i == 3 || (i == 2 && rests) ? 0.0 : uniform(&g, 0.2, 1.0) * (double)(1 - 2 * (int)(i % 2));
        }
        tribo_model *model = dense_model(DOFS, ROWS, mass, damped ? damping : NULL, stiffness, j);
        for (size_t i = 0; normals && i < 4; i += 2) {
            const double mu = i == 2 && rests ? 50.0 : 0.4;
            assert_ok(tribo_model_set_normal(model, i, i + 1, mu, uniform(&g, 1.0, 5.0), uniform(&g, -0.3, 0.2)));
        }
        tribo_system *sys = finish_model(model);
        assert_ok(tribo_set_law(tribo_system_context(sys), TRIBO_COULOMB));
        assert_ok(tribo_set_limit(tribo_system_context(sys), limits));
        if (!normals) {
            assert_ok(tribo_set_static(tribo_system_context(sys), ratio, velocity));
        }
        assert_ok(tribo_system_add_load(sys, 0.0, load, NULL));
        assert_ok(tribo_system_add_base_motion(sys, 0.0, belt, NULL));
        double y[SIZE + 1] = {0.0}, rate[SIZE + 1], jacobian[(SIZE + 1) * (SIZE + 1)], re[SIZE], im[SIZE];
        signed char slip[ROWS];
        size_t count;
        const int status = tribo_system_equilibrium(sys, NULL, y, slip, &count, re, im);
        if (!status) {
            found++;
            open += normals && (slip[0] == TRIBO_SLIP_OPEN || slip[2] == TRIBO_SLIP_OPEN);
            ck_assert_uint_eq(count, (size_t)(SIZE - 2 * (slip[2] == TRIBO_SLIP_STUCK)));
            assert_ok(tribo_system_derivative(sys, 0.0, y, rate));
            for (size_t k = 0; k < SIZE; k++) {
                require(fabs(rate[k]) < 1e-12, "seed %d: rate[%zu] = %g", seed, k, rate[k]);
            }
            assert_ok(tribo_system_jacobian(sys, 0.0, y, jacobian, NULL));
            for (size_t k = 0; k < count; k++) {
                const double complex lambda = re[k] + im[k] * (double complex)_Complex_I;
                const double at = log_det(jacobian, lambda), beside = log_det(jacobian, lambda * 1.001 + 1e-4);
                require(at < beside + log(1e-7), "seed %d: lambda = %.10g + %.10g i is no exponent: %g, %g", seed, re[k], im[k],
                        at, beside);
            }
        }
        tribo_system_destroy(sys);
    }
    require(found > 280 && open > 20, "%d found, %d with a normal that does not press", found, open);
}

/* 15 normals, more than those of which all sets are tried: blocks between springs, every other one lifted off; and with friction
 * that makes the problem not monotone. */
TEST(many_normals)
{
    enum { BLOCKS = 15, ALL = 2 * BLOCKS };
    static double mass[ALL * ALL], k[ALL * ALL], j[ALL * ALL], load[ALL], belt[ALL], y[2 * ALL + 1], re[2 * ALL], im[2 * ALL];
    signed char slip[ALL];
    size_t count;
    memset(k, 0, sizeof k);
    memset(belt, 0, sizeof belt);
    memset(y, 0, sizeof y);
    for (size_t b = 0; b < BLOCKS; b++) {
        const size_t x = 2 * b, z = x + 1;
        mass[x * ALL + x] = mass[z * ALL + z] = j[x * ALL + x] = j[z * ALL + z] = 1.0;
        k[x * ALL + x] = 9.0;
        k[z * ALL + z] = 4.0;
        k[x * ALL + z] = k[z * ALL + x] = 1.5;
        load[x] = 0.0;
        load[z] = b % 2 ? -1.0 : 1.0;
        belt[x] = _i ? -1.0 : 1.0;
    }
    tribo_model *model = dense_model(ALL, ALL, mass, NULL, k, j);
    for (size_t b = 0; b < BLOCKS; b++) {
        assert_ok(tribo_model_set_normal(model, 2 * b, 2 * b + 1, _i ? 400.0 : 0.5, 7.0, 0.0));
    }
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_system_add_load(sys, 0.0, load, NULL));
    assert_ok(tribo_system_add_base_motion(sys, 0.0, belt, NULL));
    if (_i) {
        assert_status(tribo_system_equilibrium(sys, NULL, y, slip, &count, re, im), TRIBO_ERR_UNSUPPORTED);
        assert_says(tribo_system_message(sys), "several equilibria");
    } else {
        ck_assert_uint_eq(find(sys, NULL, y, slip, re, im), 2 * ALL);
        for (size_t b = 0; b < BLOCKS; b++) {
            /* pressed: 9 x + (1.5 - 3.5) z = 0, 1.5 x + 11 z = 1 */
            assert_close(y[2 * b + 1], b % 2 ? -9.0 / (36.0 - 2.25) : 9.0 / (99.0 + 3.0), 1e-14);
            ck_assert_int_eq(slip[2 * b], b % 2 ? TRIBO_SLIP_OPEN : TRIBO_SLIP_BACK);
        }
    }
    tribo_system_destroy(sys);
}

TEST(refused)
{
    tribo_system *sys = squeal(0.5, 0.6, 0.0);
    double y[5] = {0.1}, bad[5] = {0.0, NAN}, re[4], im[4], critical = 3.0, omega = 3.0;
    const double one[] = {1.0, 0.0}, time[] = {0.0, 1.0};
    const signed char forth[] = {TRIBO_SLIP_FORTH, 0}, normal[] = {0, TRIBO_SLIP_BACK}, none[] = {TRIBO_SLIP_PLANE, 0};
    size_t count = 7;
    assert_status(tribo_system_equilibrium(NULL, NULL, y, NULL, &count, re, im), TRIBO_ERR_NULL);
    assert_status(tribo_system_equilibrium(sys, NULL, NULL, NULL, &count, re, im), TRIBO_ERR_NULL);
    assert_status(tribo_system_equilibrium(sys, NULL, y, NULL, &count, re, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_system_equilibrium(sys, NULL, bad, NULL, &count, re, im), TRIBO_ERR_NOT_FINITE);
    assert_status(tribo_system_equilibrium(sys, forth, y, NULL, &count, re, im), TRIBO_ERR_RANGE);
    assert_says(tribo_system_message(sys), "the other direction");
    assert_status(tribo_system_equilibrium(sys, normal, y, NULL, &count, re, im), TRIBO_ERR_RANGE);
    assert_status(tribo_system_equilibrium(sys, none, y, NULL, &count, re, im), TRIBO_ERR_RANGE);
    const int flutter = TRIBO_FLUTTER_FRICTION;
    assert_status(tribo_system_find_flutter(NULL, flutter, NULL, NULL, 0.0, 1.0, &critical, &omega), TRIBO_ERR_NULL);
    assert_status(tribo_system_find_flutter(sys, flutter, NULL, NULL, 0.0, 1.0, NULL, &omega), TRIBO_ERR_NULL);
    assert_status(tribo_system_find_flutter(sys, 2, NULL, NULL, 0.0, 1.0, &critical, &omega), TRIBO_ERR_RANGE);
    assert_status(tribo_system_find_flutter(sys, flutter, NULL, NULL, 0.0, NAN, &critical, &omega), TRIBO_ERR_NOT_FINITE);
    assert_says(tribo_system_message(sys), "to = nan is not finite");
    assert_status(tribo_system_find_flutter(sys, flutter, NULL, NULL, 0.0, -1.0, &critical, &omega), TRIBO_ERR_NEGATIVE);
    assert_says(tribo_system_message(sys), "to = -1 is negative");
    assert_status(tribo_system_find_flutter(sys, flutter, NULL, bad, 0.0, 1.0, &critical, &omega), TRIBO_ERR_NOT_FINITE);
    assert_ok(tribo_system_add_base_motion(sys, 2.0, one, NULL));
    assert_status(tribo_system_equilibrium(sys, NULL, y, NULL, &count, re, im), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_system_message(sys), "base motion depends on time");
    assert_ok(tribo_system_clear_base_motion(sys));
    assert_ok(tribo_system_add_load_table(sys, 2, time, time, one));
    assert_status(tribo_system_equilibrium(sys, NULL, y, NULL, &count, re, im), TRIBO_ERR_UNSUPPORTED);
    assert_status(tribo_system_find_flutter(sys, flutter, NULL, NULL, 0.0, 1.0, &critical, &omega), TRIBO_ERR_UNSUPPORTED);
    assert_exact(y[0], 0.1);
    ck_assert_uint_eq(count, 7);
    assert_exact(critical, 3.0);
    assert_exact(omega, 3.0);
    tribo_system_destroy(sys);
    const double mass = 1.0, nothing = 0.0;
    sys = finish_model(dense_model(1, 1, &mass, NULL, &nothing, &mass));
    assert_status(tribo_system_equilibrium(sys, NULL, y, NULL, NULL, NULL, NULL), TRIBO_ERR_INDEFINITE);
    assert_says(tribo_system_message(sys), "singular");
    tribo_system_destroy(sys);
}

TEST_MAIN("equilibrium", {mode_coupling, 2}, {onset, 2}, {touch_down, 2}, {alike, 1}, {constant_limit, 2}, {no_friction, 2},
          {circulation, 1}, {falling_limit, 1}, {beside_undamped, 2}, {shared, 4}, {springs, 1}, {reduced, 1}, {across, 1},
          {lifts, 4}, {random_structures, 1}, {many_normals, 2}, {refused, 1})
