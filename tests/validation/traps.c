/* No operation of a run that goes well is invalid, divides by zero or overflows: programs that trap these may use the drivers. */
#define _GNU_SOURCE /* feenableexcept */
#include <fenv.h>
#include <string.h>

#include "coulomb.h"
#include "model.h"

static const char *const methods[] = {"rk4/fixed", "rk2",    "rk4",    "rkf45", "rkck",          "rk8pd",
                                      "rk1imp",    "rk2imp", "rk4imp", "msbdf", "central/fixed", "moreau/fixed"};

/* Karnopp's law jumps at the edge of its band, where an implicit method may find no solution. */
static void play(tribo_system *sys, const char *method, const double *start)
{
    double t = 0.0, y[MOST_STATES] = {0.0};
    memcpy(y, start, tribo_system_dimension(sys) * sizeof *y);
    tribo_driver *drv = driver_create(sys, method, 0.01, 1e-5);
    feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    const int status = tribo_driver_advance(drv, &t, 6.0, y);
    fedisableexcept(FE_ALL_EXCEPT);
    int law;
    assert_ok(tribo_get_law(tribo_system_context(sys), &law));
    require(status == TRIBO_OK || (law == TRIBO_KARNOPP && status == TRIBO_ERR_STEP), "%s, law %d: %d, %s", method, law, status,
            tribo_driver_message(drv));
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* From rest or on the way, under all laws that have a band; kinks of tables on the way, and limits that go to zero. */
TEST(trapped)
{
    const double rest[MOST_STATES] = {0.0}, moves[MOST_STATES] = {1.0, 0.0, -0.5, 0.0, 0.3};
    const double time[] = {1.0, 3.0}, limit[] = {1.0, 0.0}, one = 1.0;
    struct random g = random_of(_i);
    const struct model m = model_create(&g, 1);
    for (size_t start = 0; start < 2; start++) {
        const double *y = start ? moves : rest;
        for (int law = TRIBO_VELOCITY_LIMITED; law < tribo_law_count(); law++) {
            tribo_system *sys = oscillator(law, 1.5, 0.5);
            assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 0.01));
            play(sys, methods[_i], y);
        }
        tribo_system *sys = oscillator(TRIBO_QUINN, 2.0, 2.0);
        assert_ok(tribo_set_epsilon_step(tribo_system_context(sys), 0.01, 1.0));
        assert_ok(tribo_system_set_limit_table(sys, 2, time, limit));
        assert_ok(tribo_system_add_load_table(sys, 2, time, limit, &one));
        play(sys, methods[_i], y);
        assert_ok(tribo_system_belt(&sys, 2.0, 0.5, 0.25, 1.0, 0.5));
        assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 0.01));
        play(sys, methods[_i], y);
        assert_ok(tribo_system_chain(&sys, 8, 1.0, 0.4, 1.0));
        assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 0.1));
        play(sys, methods[_i], y);
        play(model_system(&m, 1, 0, 0.05), methods[_i], y);
        play(model_system(&m, 0, 3, 0.05), methods[_i], y);
    }
}

TEST_MAIN("traps", {trapped, COUNT(methods)})
