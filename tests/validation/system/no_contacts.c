/* SPDX-License-Identifier: BSD-3-Clause */
/* A structure without contacts is one like others: every method moves it, and answers for friction that there is none. */
#include "make.h"
#include "run.h"
#include "set_up_driver.h"

#include <string.h>

/* x'' + x = 0.5 cos 0.7t, from x = 1. */
TEST(moves_freely)
{
    const char *method = any_method_name(_i);
    const int exact = strcmp(method, "exact") == 0 || strcmp(method, "auto") == 0, fixed = strstr(method, "/fixed") != NULL;
    const double one = 1.0, load = 0.5, t1 = 10.0, a = 0.5 / (1.0 - 0.49);
    double y[3] = {1.0, 0.0, 0.0}, none = 7.0;
    size_t stuck = 7;
    tribo_system *sys;
    assert_ok(dense_system(&sys, 1, 0, &one, NULL, &one, NULL, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 0.7, &load, NULL));
    ck_assert_uint_eq(tribo_system_ncontact(sys), 0);
    run(sys, method, 1e-3, 1e-9, t1, y);
    const double error = exact ? 1e-13 : fixed ? 1e-6 : strcmp(method, "rk1imp") ? 1e-5 : 1e-4; /* that one is of first order */
    assert_close(y[0], (1.0 - a) * cos(t1) + a * cos(0.7 * t1), error);
    assert_close(y[1], -(1.0 - a) * sin(t1) - 0.7 * a * sin(0.7 * t1), error);
    assert_exact(y[2], 0.0);
    assert_ok(tribo_system_contacts(sys, t1, y, NULL, NULL, &none));
    assert_exact(none, 7.0);
    assert_ok(tribo_system_get_count(sys, TRIBO_COUNT_STUCK, &stuck));
    ck_assert_uint_eq(stuck, 0);
    tribo_system_destroy(sys);
}

TEST_MAIN("no_contacts", {moves_freely, 17})
