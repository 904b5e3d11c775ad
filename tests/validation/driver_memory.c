/* Drivers out of memory: an error, nothing leaked, and the driver goes on when there is memory again. GSL is linked statically
 * where there is such a library, so that its allocations would fail here too: there are none. */
#include <string.h>

#include "memory.h"
#include "model.h"

/* exact, event, and auto, which is one of them, decompose structures by GSL. */
static const char *const methods[] = {"rk4/fixed", "rk2",    "rk4",    "rkf45", "rkck",          "rk8pd",
                                      "rk1imp",    "rk2imp", "rk4imp", "msbdf", "central/fixed", "moreau/fixed"};

static tribo_system *start(const struct model *m, double *y)
{
    tribo_system *sys = model_system(m, 1, 0, 0.1);
    memset(y, 0, DIMENSION * sizeof *y);
    y[0] = 1.0;
    return sys;
}

TEST(creation)
{
    struct random g = random_of(1);
    const struct model m = model_create(&g, 1);
    double y[DIMENSION];
    tribo_system *sys = start(&m, y);
    size_t fails = 1;
    for (int status = TRIBO_ERR_MEMORY; status; fails++) {
        tribo_driver *drv = NULL;
        const long none = memory_live();
        memory_fail(fails);
        status = tribo_driver_create(&drv, sys, methods[_i], 0.01, 1e-6, 0.0);
        memory_fail(0);
        require(!status || status == TRIBO_ERR_MEMORY, "%s, allocation %zu: %d", methods[_i], fails, status);
        require(!status || says(tribo_message(tribo_system_context(sys)), "out of memory"), "%s: %s", methods[_i],
                tribo_message(tribo_system_context(sys)));
        require((drv == NULL) == (status != TRIBO_OK), "%s: a driver with status %d", methods[_i], status);
        tribo_driver_destroy(drv);
        require(memory_live() == none, "%s leaves %ld blocks when allocation %zu fails", methods[_i], memory_live() - none,
                fails);
    }
    ck_assert_uint_ge(fails, 4);
    tribo_system_destroy(sys);
}

/* The first advance prepares, and so does one after a change; afterwards none allocates. */
TEST(advance)
{
    struct random g = random_of(2);
    const struct model m = model_create(&g, 1);
    double want[DIMENSION];
    tribo_system *twin = start(&m, want);
    run(twin, methods[_i], 0.01, 1e-6, 0.5, want);
    int status = TRIBO_ERR_MEMORY;
    for (size_t fails = 1; status; fails++) {
        double t = 0.0, y[DIMENSION];
        tribo_system *sys = start(&m, y);
        const double before[] = {y[0], y[1]};
        tribo_driver *drv = driver_create(sys, methods[_i], 0.01, 1e-6);
        memory_fail(fails);
        status = tribo_driver_advance(drv, &t, 0.5, y);
        memory_fail(0);
        if (status) {
            require(status == TRIBO_ERR_MEMORY, "%s, allocation %zu: %d", methods[_i], fails, status);
            assert_says(tribo_driver_message(drv), "out of memory");
            assert_exact(t, 0.0);
            assert_all_exact(y, before, 2);
            driver_advance(drv, &t, 0.5, y);
        }
        assert_all_close(y, want, DIMENSION, 1e-12);
        const size_t calls = memory_calls();
        driver_advance(drv, &t, 1.0, y);
        require(memory_calls() == calls, "%s: %zu allocations", methods[_i], memory_calls() - calls);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    tribo_system_destroy(twin);
}

TEST_MAIN("driver_memory", {creation, COUNT(methods)}, {advance, COUNT(methods)})
