/* SPDX-License-Identifier: BSD-3-Clause */
/* Quinn's law as a function of the caller moves the paper's systems as the built-in one. */
#include <string.h>

#include "../../user_quinn.h"
#include "run.h"

enum { BODIES = 5, CHAIN_DIMENSION = 2 * BODIES + 1 };

/* The oscillator, or the chain. */
static tribo_system *create(int chain)
{
    tribo_system *sys;
    assert_ok(chain ? tribo_system_chain(&sys, BODIES, 0.4, 0.9, 0.7) : tribo_system_oscillator(&sys, 0.6, 1.2, 0.7));
    tribo_context *c = tribo_system_context(sys);
    assert_ok(tribo_set_law(c, TRIBO_QUINN));
    assert_ok(tribo_set_epsilon_all(c, 0.05));
    return sys;
}

TEST(runs)
{
    static const char *const method[] = {"rk4/fixed", "rkf45", "rk8pd", "bsimp"};
    const int chain = _i % 2, fixed = _i / 2 == 0;
    double y[2][CHAIN_DIMENSION] = {{0.0}};
    struct quinn q = {0};
    size_t size = 0;
    for (int k = 0; k < 2; k++) {
        tribo_system *sys = create(chain);
        if (k) {
            assert_ok(tribo_set_user_law(tribo_system_context(sys), quinn_box, &q));
        }
        y[k][0] = 2.0;
        run(sys, method[_i / 2], 0.01, fixed ? 0.0 : 1e-11, 20.0, y[k]);
        size = tribo_system_dimension(sys);
        tribo_system_destroy(sys);
    }
    ck_assert_int_gt(q.calls, 4000 * fixed);
    /* Steppers end steps where slips change, which boxes define otherwise: the difference falls with the tolerance. */
    for (size_t i = 0; i < size; i++) {
        assert_close(y[1][i], y[0][i], (fixed ? 1e-15 : 5e-7) * fmax(1.0, fabs(y[0][i])));
    }
}

/* The message of a law that fails within a step comes from the driver. */
static int fails(size_t first, size_t n, int derivatives, const double *v, const double *limit, const double *epsilon,
                 double *box, void *data)
{
    quinn_box(first, n, derivatives, v, limit, epsilon, box, data);
    box[n - 1] = v[n - 1] > 0.1 ? (double)NAN : box[n - 1];
    return 0;
}

TEST(failing_law)
{
    struct quinn q = {0};
    double y[CHAIN_DIMENSION] = {2.0}, t = 0.0;
    tribo_system *sys = create(1);
    assert_ok(tribo_set_user_law(tribo_system_context(sys), fails, &q));
    tribo_driver *drv = driver_create(sys, "rk4/fixed", 0.01, 0.0);
    assert_status(tribo_driver_advance(drv, &t, 20.0, y), TRIBO_ERR_CALLBACK);
    assert_says(tribo_driver_message(drv), "law: lower of contact 4 is nan, not finite (v = ");
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST_MAIN("user_law", {runs, 8}, {failing_law, 1})
