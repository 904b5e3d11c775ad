/* SPDX-License-Identifier: BSD-3-Clause */
/* Drivers out of memory: an error, nothing leaked, and the driver goes on when there is memory again. GSL is linked statically
 * where there is such a library, so that its allocations fail here too, and none does: GSL would end the program. Memory is
 * bounded, as it is where there is no more, by every bound at which something else fails. */
#include <string.h>

#include "memory.h"
#include "model.h"
#include "../set_up_driver.h"

static tribo_system *start(const struct model *m, int planar, double *y)
{
    const size_t first = 0;
    tribo_system *sys = model_system(m, 1, 0, 0.1);
    double limit[CONTACTS];
    assert_ok(tribo_set_planar(tribo_system_context(sys), planar ? 1 : 0, &first));
    assert_ok(tribo_system_get_limit(sys, 0.0, limit)); /* the system has taken its settings, and their memory */
    memset(y, 0, DIMENSION * sizeof *y);
    y[0] = 1.0;
    return sys;
}

static void create_within_bounds(const char *method, int planar)
{
    struct random g = random_of(1);
    const struct model m = model_create(&g, 1);
    double y[DIMENSION];
    tribo_system *sys = start(&m, planar, y);
    size_t failures = 0, bytes = 0;
    for (int status = TRIBO_ERR_MEMORY; status; bytes = memory_missed()) {
        tribo_driver *drv = NULL;
        const long none = memory_live();
        memory_bound(bytes);
        status = set_up_driver(&drv, sys, method, 0.01, 1e-6, 0.0);
        memory_unbound();
        failures += status != TRIBO_OK;
        require(!status || status == TRIBO_ERR_MEMORY, "%s, %zu bytes: %d", method, bytes, status);
        require(!status || says(tribo_system_message(sys), "out of memory"), "%s: %s", method, tribo_system_message(sys));
        require((drv == NULL) == (status != TRIBO_OK), "%s: a driver with status %d", method, status);
        tribo_driver_destroy(drv);
        require(memory_live() == none, "%s leaves %ld blocks with %zu bytes", method, memory_live() - none, bytes);
    }
    ck_assert_uint_ge(failures, 3);
    tribo_system_destroy(sys);
}

/* Methods with fixed steps prepare at the beginning, so that nothing has happened when that fails, and nothing is allocated
 * later. Exact and event prepare what they need for contacts that stick when they first do, and GSL allocates in all steps of
 * implicit ones: where they end there is a good state, from which another run comes as close as its tolerance says. */
static void advance_within_bounds(const char *method, int planar)
{
    struct random g = random_of(2);
    const struct model m = model_create(&g, 1);
    const int fixed = strstr(method, "/fixed") != NULL;
    double want[DIMENSION];
    tribo_system *twin = start(&m, planar, want);
    run(twin, method, 0.01, 1e-6, 0.5, want);
    int status = TRIBO_ERR_MEMORY;
    const long none = memory_live();
    for (size_t bytes = 0; status; bytes = memory_missed()) {
        double t = 0.0, y[DIMENSION], before[DIMENSION];
        tribo_system *sys = start(&m, planar, y);
        memcpy(before, y, sizeof y);
        tribo_driver *drv = driver_create(sys, method, 0.01, 1e-6);
        memory_bound(bytes);
        status = tribo_driver_advance(drv, &t, 0.5, y);
        memory_unbound();
        if (status) {
            require(status == TRIBO_ERR_MEMORY, "%s, %zu bytes: %d", method, bytes, status);
            assert_says(tribo_driver_message(drv), "out of memory");
            require(!fixed || (t == 0.0 && memcmp(y, before, sizeof y) == 0), "%s went on to %g", method, t);
            driver_advance(drv, &t, 0.5, y);
        }
        assert_all_close(y, want, DIMENSION, fixed || strcmp(method, "exact") == 0 ? 1e-12 : 1e-4);
        const size_t calls = memory_calls();
        driver_advance(drv, &t, 1.0, y);
        require(!fixed || memory_calls() == calls, "%s: %zu allocations", method, memory_calls() - calls);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
        require(memory_live() == none, "%s leaves %ld blocks with %zu bytes", method, memory_live() - none, bytes);
    }
    tribo_system_destroy(twin);
}

TEST(creation)
{
    create_within_bounds(any_method_name(_i), 0);
}

TEST(advance)
{
    advance_within_bounds(any_method_name(_i), 0);
}

/* Two of the contacts are the directions of one. */
TEST(planar)
{
    static const char *const methods[] = {"event", "central/fixed", "moreau/fixed", "rk4/fixed"};
    create_within_bounds(methods[_i], 1);
    advance_within_bounds(methods[_i], 1);
}

TEST_MAIN("driver_memory", {creation, 17}, {advance, 17}, {planar, 4})
