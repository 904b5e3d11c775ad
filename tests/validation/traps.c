/* SPDX-License-Identifier: BSD-3-Clause */
/* Systems and drivers raise no floating-point exceptions. As in unit/traps.c every test runs twice: exceptions are looked for,
 * and they are trapped. */
#include <string.h>

#include "make.h"
#include "tribo/tribo_gsl.h"

#include "traps.h"
#include "../set_up_driver.h"

enum { OSCILLATOR, CHAIN, BELT, IMMOVABLE, SYSTEMS };

#define METHODS 17

/* Two masses on springs, each with a contact to the ground, and a contact that friction cannot move: it is driven from both
 * sides. */
static tribo_system *immovable(void)
{
    const double mass[4] = {1.0, 0.0, 0.0, 2.0}, stiffness[4] = {3.0, -1.0, -1.0, 3.0};
    const double direction[6] = {1.0, 0.0, 0.0, 0.0, 0.0, 1.0}, limit[3] = {0.2, 0.3, 0.1};
    const double load[2] = {1.0, 0.5}, driven[3] = {0.0, 0.7, 0.0};
    tribo_system *s;
    assert_ok(dense_system(&s, 2, 3, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_set_limit(tribo_system_context(s), limit));
    assert_ok(tribo_system_add_load(s, 1.3, NULL, load));
    assert_ok(tribo_system_add_base_motion(s, 0.7, NULL, driven));
    return s;
}

static tribo_system *create(int which)
{
    tribo_system *s = NULL;
    switch (which) {
    case OSCILLATOR:
        assert_quiet(tribo_system_oscillator(&s, 1.0, 1.5, 0.5));
        break;
    case CHAIN:
        assert_quiet(tribo_system_chain(&s, 8, 1.0, 0.25, 0.5));
        break;
    case BELT:
        assert_quiet(tribo_system_belt(&s, 2.0, 0.5, 0.25, 1.0, 0.5));
        break;
    default:
        expect_no_exception();
        s = immovable();
        ck_assert_ptr_null(exception_raised());
        break;
    }
    return s;
}

/* Under every law and coupling; where a law jumps, or contacts that friction cannot move creep for ever, a method may find no
 * step. */
static void play(int which, const char *method, int law, int coupling)
{
    tribo_system *s = create(which);
    tribo_context *c = tribo_system_context(s);
    tribo_driver *d;
    double y[64] = {0}, t = 0.0;
    assert_quiet(tribo_set_law(c, law));
    assert_quiet(tribo_set_coupling(c, coupling));
    assert_quiet(tribo_set_epsilon_step(c, 0.01, 0.4));
    assert_quiet(set_up_driver(&d, s, method, 0.01, 1e-5, 1e-5));
    for (int k = 1, status = TRIBO_OK; k <= 6 && !status; k++) {
        status = quiet(tribo_driver_advance(d, &t, 0.5 * k, y));
        require(!status || (status == TRIBO_ERR_STEP && !strchr(method, '/')), "%s, system %d, law %d: %d, %s", method, which,
                law, status, tribo_driver_message(d));
    }
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

TEST(drivers)
{
    const char *method = any_method_name(_i / 2 % METHODS);
    ck_assert_int_eq(any_method_count(), METHODS);
    /* Coulomb's law jumps, and for the chain adaptive methods chatter for long */
    const int first = strchr(method, '/') ? TRIBO_COULOMB : TRIBO_COULOMB + 1;
    for (int law = first; law < tribo_law_count() && (_i % 2 == 0 || set_traps()); law++) {
        play(_i / 2 / METHODS, method, law, TRIBO_CONSISTENT);
        play(_i / 2 / METHODS, method, law, TRIBO_PARTITION);
    }
}

/* Everything but integration, for all laws. */
TEST(systems)
{
    tribo_system *s = create(_i / 2 % SYSTEMS);
    const gsl_odeiv2_system *ode = tribo_gsl_system(s);
    const size_t n = tribo_system_dimension(s);
    double y[64] = {0}, dydt[64], dfdy[64 * 64], dfdt[64], v[8], feq[8], f[8];
    assert_quiet(tribo_set_law(tribo_system_context(s), _i / 2 / SYSTEMS));
    assert_quiet(tribo_set_epsilon_step(tribo_system_context(s), 0.01, 0.4));
    for (int k = 0; k < 20 && (_i % 2 == 0 || set_traps()); k++) {
        for (size_t i = 0; i < n; i++) {
            y[i] = k % 4 ? 1e-3 * (double)((7 * i + 13 * (size_t)k) % 11) - 5e-3 : 0.0;
        }
        ck_assert_int_eq(quiet(ode->function(0.1 * k, y, dydt, ode->params)), 0);
        ck_assert_int_eq(quiet(ode->jacobian(0.1 * k, y, dfdy, dfdt, ode->params)), 0);
        assert_quiet(tribo_system_contacts(s, 0.1 * k, y, v, feq, f));
        assert_quiet(tribo_system_accept(s, 0.1 * k, y));
    }
    tribo_system_destroy(s);
}

/* Thrown blocks, without springs and loads: nothing swings, grows or decays. */
TEST(thrown)
{
    const double mass[4] = {1.0, 0.0, 0.0, 2.0}, nothing[4] = {0.0}, direction[4] = {1.0, 0.0, -1.0, 1.0}, limit[2] = {0.5, 0.25};
    double y[5] = {0.0, 0.0, 1.0, -0.5, 0.0}, t = 0.0;
    tribo_system *s;
    tribo_driver *d;
    assert_ok(dense_system(&s, 2, 2, mass, NULL, nothing, direction, 0, NULL, 0));
    assert_ok(tribo_set_limit(tribo_system_context(s), limit));
    assert_quiet(set_up_driver(&d, s, "exact", 0.01, 0.0, 0.0));
    if (_i == 0 || set_traps()) {
        assert_quiet(tribo_driver_advance(d, &t, 10.0, y));
        assert_close(y[2], 0.0, 1e-15);
        assert_close(y[3], 0.0, 1e-15);
    }
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

TEST_MAIN("traps", {drivers, 2 * SYSTEMS *METHODS}, {systems, 2 * SYSTEMS * 6}, {thrown, 2})
