/* SPDX-License-Identifier: BSD-3-Clause */
/* Structures reduced to modes and a compliance without mass at contacts: against the whole structure, against static responses
 * with mass, and by all methods. */
#include <stdlib.h>
#include <string.h>

#include "make.h"
#include "beam.h"
#include "run.h"

/* Contacts at rows 117, 189, 261 of the beam, the load at row 264. */
enum { HELD = 3, TIP = 263 };
static const size_t rows[HELD] = {116, 188, 260};
static const double force = 0.1, damping = 0.002, first = 2.0 * PI * 26.6925899;

static tribo_system *beam(size_t nmode, int statics, double limit)
{
    gsl_spmatrix *mass = beam_matrix("M.mtx"), *stiffness = beam_matrix("K.mtx"),
                 *direction = gsl_spmatrix_alloc(HELD, BEAM_DOFS);
    tribo_system *sys = NULL;
    char text[200] = "";
    for (size_t i = 0; i < HELD; i++) {
        gsl_spmatrix_set(direction, i, rows[i], 1.0);
    }
    const int status = reduced_system(&sys, mass, stiffness, direction, nmode, statics, text, sizeof text);
    require(!status, "%s", text);
    gsl_spmatrix_free(mass);
    gsl_spmatrix_free(stiffness);
    gsl_spmatrix_free(direction);
    assert_ok(tribo_system_set_damping_ratio(sys, damping));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), limit));
    return sys;
}

static void add_tip(tribo_system *sys, double omega)
{
    double load[BEAM_DOFS] = {0};
    load[TIP] = force;
    assert_ok(tribo_system_add_load(sys, omega, load, NULL));
}

/* What the contacts dissipate in a second of the periodic motion. */
static double power_of(tribo_system *sys, const char *method, double omega, double *y)
{
    const double period = 2.0 * PI / omega;
    double energy[HELD], sum = 0.0;
    tribo_driver *drv = driver_create(sys, method, period, 1e-12);
    const int status = tribo_driver_find_periodic(drv, 0.0, period, y);
    require(!status, "%s", tribo_driver_message(drv));
    assert_ok(tribo_driver_period_dissipation(drv, energy));
    for (size_t i = 0; i < HELD; i++) {
        sum += energy[i] / period;
    }
    tribo_driver_destroy(drv);
    return sum;
}

/* At three times the first frequency, limit 0.1: the whole structure dissipates 2.6134e-4, and 12 modes alone 9.46e-3. */
TEST(power)
{
    const size_t modes[] = {12, 24, 48, 24};
    const double want[] = {3.1013e-4, 2.6297e-4, 2.6114e-4, 2.6297e-4};
    double y[2 * (48 + HELD) + 1] = {0};
    tribo_system *sys = beam(modes[_i], TRIBO_STATICS_COMPLIANCE, 0.1);
    add_tip(sys, 3.0 * first);
    ck_assert_uint_eq(tribo_system_ndof(sys), modes[_i] + HELD);
    assert_close(power_of(sys, _i < 3 ? "exact" : "event", 3.0 * first, y) / want[_i], 1.0, 2e-5);
    tribo_system_destroy(sys);
}

/* Where the first mode comes to lag by a quarter of a period, all contacts stuck. */
static double stuck_resonance(tribo_system *sys)
{
    const size_t n = tribo_system_dimension(sys);
    double low = first, high = 0.0, *y = calloc(n, sizeof *y);
    tribo_driver *drv = driver_create(sys, "exact", 1.0, 0.0);
    for (int ahead = 0, k = 0; k < 120 && !(high > 0.0 && high - low < 1e-7 * low); k++) {
        const double omega = high > 0.0 ? 0.5 * (low + high) : 1.05 * low;
        assert_ok(tribo_system_clear_loads(sys));
        add_tip(sys, omega);
        memset(y, 0, n * sizeof *y);
        assert_ok(tribo_driver_find_periodic(drv, 0.0, 2.0 * PI / omega, y));
        const int now = y[0] > 0.0 ? 1 : -1;
        ahead = ahead ? ahead : now;
        *(now == ahead ? &low : &high) = omega;
    }
    tribo_driver_destroy(drv);
    free(y);
    return low;
}

TEST(resonance)
{
    const size_t modes[] = {6, 12, 24};
    const double most[] = {1e-2, 1e-4, 3e-6};
    tribo_system *sys = beam(modes[_i], TRIBO_STATICS_COMPLIANCE, 1e3), *all = beam(48, TRIBO_STATICS_MASS, 1e3);
    const double ratio = stuck_resonance(sys) / stuck_resonance(all);
    require(fabs(ratio - 1.0) < most[_i], "%zu modes: off by %g", modes[_i], ratio - 1.0);
    tribo_system_destroy(sys);
    tribo_system_destroy(all);
}

/* Marching by all methods; the load of the tip bends the contacts, and is taken away with what it bends. */
TEST(methods)
{
    static const char *const method[] = {"event", "moreau/fixed"};
    const double end = 8.0 * PI / first, dt = end / 40000.0;
    double y[2][2 * (12 + HELD) + 1] = {{0}}, t = 0.0, u = 0.0, size = 0.0;
    tribo_system *sys = beam(_i ? 3 : 12, TRIBO_STATICS_COMPLIANCE, 0.05), *copy;
    add_tip(sys, 2.0);
    assert_ok(tribo_system_clear_loads(sys));
    add_tip(sys, 3.0 * first);
    assert_ok(tribo_system_clone(sys, &copy));
    tribo_driver *exact = driver_create(sys, "exact", 1.0, 0.0), *other = driver_create(copy, method[_i], dt, 1e-13);
    driver_advance(exact, &t, end, y[0]);
    driver_advance(other, &u, end, y[1]);
    const size_t n = tribo_system_ndof(sys);
    for (size_t k = 0; k < n; k++) {
        size = fmax(size, fabs(y[0][k]));
    }
    for (size_t k = 0; k < n; k++) {
        assert_close(y[1][k] / size, y[0][k] / size, _i ? 1e-4 : 1e-9);
    }
    assert_close(y[1][2 * n] / y[0][2 * n], 1.0, _i ? 1e-3 : 1e-9);
    ck_assert(y[0][2 * n] > 0.0 && driver_count(exact, TRIBO_COUNT_EVENTS) > 50);
    tribo_driver_destroy(exact);
    tribo_driver_destroy(other);
    tribo_system_destroy(sys);
    tribo_system_destroy(copy);
}

/* Displacements of contacts are those of w; bounds of what is missing lie between those of modes alone and of static
 * responses. */
TEST(displacements)
{
    double y[5 + HELD], full[BEAM_DOFS], error[3];
    struct random r = random_of(1);
    tribo_system *sys[3];
    for (int k = 0; k < 3; k++) {
        sys[k] = beam(5, k, 1.0);
        assert_ok(tribo_system_get_truncation(sys[k], 1.5 * first, &error[k]));
    }
    require(error[1] < 0.5 * error[2] && error[2] < 0.5 * error[0], "%g, %g and %g are missing", error[0], error[1], error[2]);
    assert_ok(tribo_system_get_truncation(sys[2], 0.0, error));
    assert_close(error[0], 0.0, 1e-8);
    for (size_t k = 0; k < 5 + HELD; k++) {
        y[k] = uniform(&r, -1.0, 1.0);
    }
    assert_ok(tribo_system_expand(sys[2], y, full));
    for (size_t i = 0; i < HELD; i++) {
        assert_close(full[rows[i]], y[5 + i], 1e-9);
    }
    for (int k = 0; k < 3; k++) {
        tribo_system_destroy(sys[k]);
    }
}

/* Two masses on a spring, free: the contacts at both ends feel one elastic motion, which the rigid-body mode leaves to a
 * compliance that depends: refused; a contact at one end has it, exactly. */
TEST(free_bodies)
{
    gsl_spmatrix *mass = gsl_spmatrix_alloc(2, 2), *stiffness = gsl_spmatrix_alloc(2, 2), *both = gsl_spmatrix_alloc(2, 2),
                 *one = gsl_spmatrix_alloc(1, 2);
    char text[200] = "";
    double omega[2];
    tribo_system *sys = NULL;
    for (size_t i = 0; i < 2; i++) {
        gsl_spmatrix_set(mass, i, i, 1.0);
        gsl_spmatrix_set(stiffness, i, i, 3.0);
        gsl_spmatrix_set(stiffness, i, 1 - i, -3.0);
        gsl_spmatrix_set(both, i, i, 1.0);
    }
    gsl_spmatrix_set(one, 0, 0, 1.0);
    assert_status(reduced_system(&sys, mass, stiffness, both, 1, TRIBO_STATICS_COMPLIANCE, text, sizeof text),
                  TRIBO_ERR_UNSUPPORTED);
    assert_says(text, "the flexibility that 1 mode leaves to contact 1 is that of other contacts");
    assert_status(reduced_system(&sys, mass, stiffness, one, 1, 3, text, sizeof text), TRIBO_ERR_RANGE);
    assert_says(text, "static_contacts = 3");
    assert_ok(reduced_system(&sys, mass, stiffness, one, 1, TRIBO_STATICS_COMPLIANCE, text, sizeof text));
    assert_ok(tribo_system_get_frequencies(sys, omega));
    assert_exact(omega[0], 0.0);
    ck_assert(isinf(omega[1]));
    /* q = (x1 + x2)/sqrt 2 with speed 1, the contact held: G = 1/12 */
    double y[5] = {0.0, 0.0, 1.0, 0.0, 0.0}, t = 0.0;
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 1e3));
    tribo_driver *drv = driver_create(sys, "exact", 1.0, 0.0);
    const double w = sqrt(12.0 / 2.0);
    driver_advance(drv, &t, 0.7, y);
    assert_close(y[0], sin(w * t) / w, 1e-13);
    assert_close(y[2], cos(w * t), 1e-13);
    assert_exact(y[1], 0.0);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    gsl_spmatrix_free(mass);
    gsl_spmatrix_free(stiffness);
    gsl_spmatrix_free(both);
    gsl_spmatrix_free(one);
}

/* What a table makes of the load would bend the contacts, with kinks. */
TEST(tables)
{
    const double time[] = {0.0, 1.0}, value[] = {0.0, 1.0}, load[BEAM_DOFS] = {[TIP] = 1.0};
    tribo_system *sys = beam(3, TRIBO_STATICS_COMPLIANCE, 1.0);
    assert_status(tribo_system_add_load_table(sys, 2, time, value, load), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_system_message(sys), "TRIBO_STATICS_MASS");
    tribo_system_destroy(sys);
}

/* A load moves contacts at once, by the displacements that modes lack, also where contacts are more than modes: by a cosine as by
 * a sine a quarter of a turn later. */
TEST(few_modes)
{
    double load[BEAM_DOFS] = {0}, y[2 * (1 + HELD) + 1] = {0}, v[2][HELD];
    const double omega = 0.5 * first, t = 0.3 / omega;
    load[TIP] = force;
    for (int sine = 0; sine < 2; sine++) {
        tribo_system *sys = beam(1, TRIBO_STATICS_COMPLIANCE, 1.0);
        assert_ok(tribo_system_add_load(sys, omega, sine ? NULL : load, sine ? load : NULL));
        assert_ok(tribo_system_contacts(sys, t + (sine ? 0.5 * PI / omega : 0.0), y, v[sine], NULL, NULL));
        tribo_system_destroy(sys);
    }
    for (size_t i = 0; i < HELD; i++) {
        require(fabs(v[0][i]) > 0.0, "contact %zu does not move", i);
        assert_close(v[1][i], v[0][i], 1e-9 * fabs(v[0][i]));
    }
}

TEST_MAIN("compliance", {power, 4}, {resonance, 3}, {methods, 2}, {displacements, 1}, {free_bodies, 1}, {tables, 1},
          {few_modes, 1})
