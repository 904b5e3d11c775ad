/* SPDX-License-Identifier: BSD-3-Clause */
/* Periodic motions of structures with many modes: no step makes a matrix, and what steps apply is what the matrix is. */
#include "make.h"
#include "dynamics/driver.h"
#include "dynamics/periodic/shooting.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>
#include "../../set_up_driver.h"

enum { DOFS = 40, CONTACTS = 6, STATES = 2 * DOFS, LOADS = 5, MODES = 6, NEAR = 12, DIRECTIONS = 3 };

static double mass[DOFS][DOFS], damping[DOFS][DOFS], stiffness[DOFS][DOFS], direction[CONTACTS][DOFS];

/* Bodies in a row on springs, one of them with a damper, which couples the modes, or all alike; contacts between some of them,
 * and to the ground. */
static void make_row(struct random *r, int coupled)
{
    for (size_t i = 0; i < DOFS; i++) {
        for (size_t k = 0; k < DOFS; k++) {
            mass[i][k] = stiffness[i][k] = 0.0;
        }
    }
    for (size_t i = 0; i < DOFS; i++) {
        const double spring = uniform(r, 50.0, 200.0);
        mass[i][i] = uniform(r, 0.5, 2.0);
        stiffness[i][i] += 1.0 + spring;
        if (i + 1 < DOFS) {
            stiffness[i + 1][i + 1] += spring;
            stiffness[i][i + 1] = stiffness[i + 1][i] = -spring;
        }
    }
    for (size_t i = 0; i < DOFS; i++) {
        for (size_t k = 0; k < DOFS; k++) {
            damping[i][k] = 0.002 * stiffness[i][k];
        }
    }
    damping[3][3] += coupled ? 1.0 : 0.0;
    for (size_t i = 0; i < CONTACTS; i++) {
        for (size_t k = 0; k < DOFS; k++) {
            direction[i][k] = k == 6 * i + 2 ? 1.0 : k == 6 * i + 5 && i % 2 ? -1.0 : 0.0;
        }
    }
}

static tribo_system *row(struct random *r, int coupled)
{
    tribo_system *sys;
    make_row(r, coupled);
    assert_ok(dense_system(&sys, DOFS, CONTACTS, mass[0], damping[0], stiffness[0], direction[0], 0, NULL, 0));
    return sys;
}

/* The row by its lowest modes, contacts on bodies side by side: the compliance of the other modes couples the contacts. */
static tribo_system *reduced_row(struct random *r)
{
    tribo_model *model;
    tribo_system *sys;
    double beside[NEAR][DOFS] = {{0.0}};
    make_row(r, 0);
    for (size_t i = 0; i < NEAR; i++) {
        beside[i][15 + i] = 1.0;
    }
    assert_ok(tribo_model_create(&model, DOFS, NEAR));
    assert_ok(tribo_model_set_mass(model, mass[0]));
    assert_ok(tribo_model_set_stiffness(model, stiffness[0]));
    assert_ok(tribo_model_set_direction(model, beside[0]));
    assert_ok(tribo_system_reduce(&sys, model, MODES, TRIBO_STATICS_COMPLIANCE));
    assert_ok(tribo_system_set_damping_ratio(sys, 0.02));
    tribo_model_destroy(model);
    return sys;
}

/* The matrix, made now, times vectors is what steps have applied. */
static void compare(struct shooting *s, struct random *r)
{
    double x[STATES], applied[STATES];
    for (size_t i = 0; i < STATES; i++) {
        x[i] = applied[i] = uniform(r, -1.0, 1.0);
    }
    assert_ok(tribo_period_map_apply(&s->map, s->here, applied));
    assert_ok(tribo_period_map_matrix(&s->map, s->here));
    const double *matrix = s->here->derivative.matrix;
    for (size_t i = 0; i < STATES; i++) {
        double sum = 0.0;
        for (size_t k = 0; k < STATES; k++) {
            sum += matrix[i * STATES + k] * x[k];
        }
        assert_close(applied[i], sum, 1e-11);
    }
}

static void compare_trace(tribo_driver *drv, struct shooting *s)
{
    double re[STATES], im[STATES], sum = 0.0, trace = 0.0;
    assert_ok(tribo_driver_get_multipliers(drv, re, im));
    assert_ok(tribo_period_map_matrix(&s->map, s->here));
    const double *d = s->here->derivative.matrix;
    for (size_t i = 0; i < STATES; i++) {
        sum += re[i];
        for (size_t k = 0; s->here->odd && k < STATES; k++) {
            trace += d[i * STATES + k] * d[k * STATES + i];
        }
        trace += s->here->odd ? 0.0 : d[i * STATES + i];
    }
    assert_close(sum, trace, 1e-9);
}

/* The contacts that rest all the time: each may do so elsewhere. */
static size_t count_resting(tribo_driver *drv)
{
    double share[CONTACTS];
    size_t count = 0;
    assert_ok(tribo_driver_period_stick(drv, share));
    for (size_t i = 0; i < CONTACTS; i++) {
        count += share[i] > 1.0 - 1e-12;
    }
    return count;
}

/* Loads and limits that change; the last limits are so large that all contacts rest. */
TEST(many_modes)
{
    struct random r = random_of(_i);
    tribo_system *sys = row(&r, _i % 2);
    double y[STATES + 1] = {0.0}, load[DOFS] = {0.0};
    tribo_driver *drv;
    ck_assert_uint_le(tribo_system_dimension(sys), COUNT(y));
    assert_ok(set_up_driver(&drv, sys, "exact", 1.0, 0.0, 0.0));
    load[DOFS - 1] = 1.0;
    for (int k = 0; k < LOADS; k++) {
        const double omega = 0.7 + 0.3 * k;
        size_t freedom = 0;
        assert_ok(tribo_system_clear_loads(sys));
        assert_ok(tribo_system_add_load(sys, omega, NULL, load));
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), k == LOADS - 1 ? 1e3 : 0.02 * pow(0.5, k)));
        const int status = tribo_driver_find_periodic(drv, 0.0, 2.0 * PI / omega, y);
        require(!status, "load %d: %s", k, status ? tribo_driver_message(drv) : "");
        for (size_t p = 0; p < 2; p++) {
            ck_assert_ptr_null(drv->shooting->point[p].derivative.matrix);
        }
        compare(drv->shooting, &r);
        assert_ok(tribo_driver_get_freedom(drv, &freedom));
        ck_assert_uint_eq(freedom, count_resting(drv));
        compare_trace(drv, drv->shooting);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Contacts that a compliance couples: D x is the difference of images, in directions of displacement and velocity. */
TEST(coupled_contacts)
{
    struct random r = random_of(_i);
    tribo_system *sys = reduced_row(&r);
    double y[100] = {0.0}, load[DOFS] = {0.0}, e[2 * MODES + NEAR], image[2][2 * MODES + NEAR];
    tribo_driver *drv;
    assert_ok(set_up_driver(&drv, sys, "exact", 1.0, 0.0, 0.0));
    load[DOFS - 1] = 1.0;
    assert_ok(tribo_system_add_load(sys, 0.9, NULL, load));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.005));
    const int status = tribo_driver_find_periodic(drv, 0.0, 2.0 * PI / 0.9, y);
    require(!status, "%s", tribo_driver_message(drv));
    struct shooting *s = drv->shooting;
    const size_t n = s->map.n;
    ck_assert_uint_eq(n, 2 * MODES + NEAR);
    for (int turn = 0; turn < DIRECTIONS; turn++) {
        struct point *other = s->here == s->point ? s->point + 1 : s->point;
        for (size_t i = 0; i < n; i++) {
            e[i] = i < 2 * MODES ? uniform(&r, -1.0, 1.0) * s->here->size : 0.0;
        }
        for (int k = 0; k < 2; k++) {
            for (size_t i = 0; i < n; i++) {
                other->x[i] = s->here->x[i] + (k ? 1e-7 : -1e-7) * e[i];
            }
            assert_ok(tribo_period_map_follow(&s->map, other));
            memcpy(image[k], other->image, sizeof image[k]);
        }
        assert_ok(tribo_period_map_apply(&s->map, s->here, e));
        for (size_t i = 0; i < n; i++) {
            const double want = (image[1][i] - image[0][i]) / 2e-7;
            require(fabs(e[i] - want) <= 1e-4 * s->here->size, "direction %d: D x[%zu] = %g, not %g", turn, i, e[i], want);
        }
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST_MAIN("derivative", {many_modes, 6}, {coupled_contacts, 40})
