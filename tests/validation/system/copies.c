/* SPDX-License-Identifier: BSD-3-Clause */
/* Copies of systems move as the originals do, to the last bit, and know nothing of each other. */
#include <string.h>

#include "model.h"

static const double times[] = {0.0, 1.0, 2.5}, values[] = {0.0, 1.0, -0.5},
                    limits[] = {0.5, 0.4, 0.3, 1.0, 0.1, 0.2, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3};

enum { KINDS = 7 };

static tribo_system *any_system(int kind)
{
    struct random g = random_of(kind);
    const struct model m = model_create(&g, kind == 4);
    tribo_system *sys = NULL;
    double pattern[DOFS] = {1.0, 0.0, -1.0, 0.5, 0.0, 0.0};
    switch (kind) {
    case 0:
        assert_ok(tribo_system_oscillator(&sys, 1.0, 1.5, 0.5));
        break;
    case 1:
        assert_ok(tribo_system_chain(&sys, 5, 0.1, 0.5, 0.5));
        break;
    case 2:
        assert_ok(tribo_system_belt(&sys, 1.0, 0.5, 0.25, 1.0, 0.5));
        break;
    default: /* diagonal, full, reduced, with tables */
        sys = model_system(&m, kind != 5, kind == 5 ? 4 : 0, 0.1);
        if (kind == 5) {
            assert_ok(tribo_system_set_damping_ratio(sys, 0.02));
        }
        if (kind == 6) {
            assert_ok(tribo_system_add_load_table(sys, 3, times, values, pattern));
            assert_ok(tribo_system_set_limit_table(sys, 3, times, limits));
        }
        if (kind == 3) {
            assert_ok(tribo_system_add_limit(sys, 0.75, limits + 3, limits));
        }
    }
    return sys;
}

static void same_motion(tribo_system *a, tribo_system *b, const char *method)
{
    double y[DIMENSION] = {0.3, -0.2}, z[DIMENSION] = {0.3, -0.2};
    run(a, method, 0.01, 1e-8, 2.0, y);
    run(b, method, 0.01, 1e-8, 2.0, z);
    require(memcmp(y, z, sizeof y) == 0, "%s: %.17g and %.17g", method, y[0], z[0]);
}

TEST(as_the_original)
{
    static const char *const methods[] = {"rk4/fixed", "event", "central/fixed", "moreau/fixed", "msbdf", "exact"};
    tribo_system *sys = any_system(_i), *copy = NULL, *other = any_system(_i);
    double lone[CONTACTS + 2] = {0.0};
    assert_ok(tribo_system_clone(sys, &copy));
    ck_assert_uint_eq(tribo_system_dimension(copy), tribo_system_dimension(sys));
    /* what is done to the original is not done to the copy, and this lives longer */
    assert_ok(tribo_system_clear_loads(sys));
    assert_ok(tribo_set_law(tribo_system_context(sys), TRIBO_SMOOTH));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 7.0));
    tribo_system_destroy(sys);
    for (size_t k = 0; k < COUNT(methods) - (_i == 6); k++) {
        same_motion(copy, other, methods[k]);
    }
    assert_ok(tribo_get_limit(tribo_system_context(copy), lone));
    require(lone[0] != 7.0, "the copy's limit is the original's");
    if (_i == 5) {
        double a[4], b[4];
        assert_ok(tribo_system_get_frequencies(copy, a));
        assert_ok(tribo_system_get_frequencies(other, b));
        assert_all_exact(a, b, 4);
    }
    tribo_system_destroy(copy);
    tribo_system_destroy(other);
}

/* Without loads nothing happens; bases go on moving; new loads may be added. */
TEST(clear_loads)
{
    double y[DIMENSION] = {0.0}, belt[5] = {0.0}, again[3] = {0.0}, want[3] = {0.0};
    const double one = 1.0, alpha = 1.5;
    tribo_system *sys = any_system(0), *shaken = any_system(2);
    assert_ok(tribo_system_clear_loads(sys));
    assert_ok(tribo_system_add_load_table(sys, 3, times, values, &one));
    assert_ok(tribo_system_clear_loads(sys));
    run(sys, "exact", 0.01, 0.0, 20.0, y);
    for (size_t i = 0; i < 3; i++) {
        assert_exact(y[i], 0.0);
    }
    assert_ok(tribo_system_add_load(sys, 0.5, NULL, &alpha));
    run(sys, "exact", 0.01, 0.0, 20.0, again);
    tribo_system *fresh = any_system(0);
    run(fresh, "exact", 0.01, 0.0, 20.0, want);
    assert_all_close(again, want, 3, 1e-12);
    assert_ok(tribo_system_clear_loads(shaken));
    run(shaken, "exact", 0.01, 0.0, 5.0, belt);
    ck_assert(belt[4] > 0.0);
    assert_status(tribo_system_clear_loads(NULL), TRIBO_ERR_NULL);
    assert_status(tribo_system_clone(NULL, &sys), TRIBO_ERR_NULL);
    assert_status(tribo_system_clone(sys, NULL), TRIBO_ERR_NULL);
    tribo_system_destroy(sys);
    tribo_system_destroy(fresh);
    tribo_system_destroy(shaken);
}

TEST_MAIN("copies", {as_the_original, KINDS}, {clear_loads, 1})
