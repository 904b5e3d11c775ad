/* SPDX-License-Identifier: BSD-3-Clause */
/* What legacy_structures.f does, by the functions of C. */
#include "../set_up_driver.h"
#include "structure.h"
#include "tape.h"

enum { N = 2, FULL = 6, WHOLE = 2 * FULL + 1, REDUCED = 4 };

static void springs(double stiffness, double k[FULL][FULL])
{
    for (int i = 0; i < FULL; i++) {
        for (int j = 0; j < FULL; j++) {
            k[i][j] = i == j ? 2.0 * stiffness : i - j == 1 || j - i == 1 ? -stiffness : 0.0;
        }
    }
}

static tribo_system *make(int damped, size_t nmode, int statics)
{
    double mass[FULL][FULL] = {{0.0}}, damping[FULL][FULL], stiffness[FULL][FULL];
    const double direction[N][FULL] = {{0.0, 1.0}, {0.0, 0.0, 0.0, 0.0, 1.0}};
    const struct structure s = {FULL, N, mass[0], damped ? damping[0] : NULL, stiffness[0], direction[0], 1};
    tribo_system *sys = NULL;
    for (size_t i = 0; i < FULL; i++) {
        mass[i][i] = 1.0 + 0.1 * (double)(i + 1);
    }
    springs(0.1, damping);
    springs(1.0, stiffness);
    structure_system(&sys, &s, nmode, statics);
    return sys;
}

static void put_reduced(void)
{
    const double cosine[FULL] = {1.0}, sine[FULL] = {0.0};
    double omega[REDUCED] = {0.0}, full[FULL], error = 0.0, y[2 * REDUCED + 1] = {0.0}, t = 0.0;
    tribo_system *sys = make(0, 2, TRIBO_STATICS_MASS), *copy = NULL;
    tribo_driver *drv = NULL;
    put_one((double)tribo_system_ndof(sys));
    tribo_system_get_frequencies(sys, omega);
    put(REDUCED, omega);
    tribo_system_expand(sys, omega, full);
    put(FULL, full);
    tribo_system_get_truncation(sys, 0.5, &error);
    put_one(error);
    put_one(tribo_system_set_damping_ratio(sys, 0.05));
    put_one(tribo_system_add_load(sys, 0.5, cosine, sine));
    tribo_set_limit_all(tribo_system_context(sys), 0.2);
    tribo_system_clone(sys, &copy);
    tribo_system_destroy(sys);
    set_up_driver(&drv, copy, "auto", 0.1, 1e-9, 1e-9);
    put_one(tribo_driver_advance(drv, &t, 20.0, y));
    put(2 * REDUCED + 1, y);
    put_text(tribo_driver_method(drv));
    tribo_driver_real(drv, TRIBO_REAL_BACKSLIP, &error);
    put_one(error);
    tribo_driver_destroy(drv);
    tribo_system_destroy(copy);
    sys = make(0, 2, TRIBO_STATICS_NONE);
    put_one((double)tribo_system_ndof(sys));
    tribo_system_destroy(sys);
}

static void put_look(tribo_system *sys, const double *y)
{
    double v[N], feq[N], f[N], dydt[WHOLE], dfdy[WHOLE][WHOLE], dfdt[WHOLE];
    put_one(tribo_system_contacts(sys, 0.5, y, v, feq, f));
    put(N, v);
    put(N, feq);
    put(N, f);
    put_one(tribo_system_derivative(sys, 0.5, y, dydt));
    put(WHOLE, dydt);
    put_one(tribo_system_jacobian(sys, 0.5, y, dfdy[0], dfdt));
    for (size_t j = 0; j < WHOLE; j++) {
        for (size_t i = 0; i < WHOLE; i++) {
            put_one(dfdy[i][j]);
        }
    }
    put(WHOLE, dfdt);
    put_one(tribo_system_accept(sys, 0.5, y));
}

struct watch {
    int seen, last;
    double sum;
};

static int seen(const tribo_moment *moment, void *data)
{
    struct watch *w = data;
    w->seen += 1 + moment->kind + (moment->kind ? (int)moment->contact + 1 : 0);
    w->sum += moment->t * moment->y[WHOLE - 1];
    return w->seen == w->last;
}

static void put_whole(int damped)
{
    const double time[3] = {0.0, 1.0, 3.0}, value[3] = {0.0, 2.0, -1.0};
    const double pattern[FULL] = {1.0, 0.0, 0.0, -0.5, 0.0, 0.0}, limits[2 * N] = {0.1, 0.2, 0.3, 0.1};
    struct watch watch = {0, 40, 0.0};
    double y[WHOLE] = {0.0}, t = 0.0, limit[N];
    signed char slip[N];
    size_t stuck;
    tribo_system *sys = make(damped, 0, 0);
    tribo_driver *drv = NULL;
    put_one(tribo_system_add_load_table(sys, 3, time, value, pattern));
    put_one(tribo_system_add_base_table(sys, 3, time, value, limits));
    put_one(tribo_system_set_limit_table(sys, 2, time, limits));
    for (int i = 0; i < FULL; i++) {
        y[i] = 0.1 * (i + 1);
        y[i + FULL] = 0.3 - 0.1 * (i + 1);
    }
    put_look(sys, y);
    create_any_driver(&drv, sys, any_method_count() > tribo_method_count() ? "rkf45" : "rk4/fixed");
    put_one(tribo_driver_set_step(drv, 0.1));
    put_one(tribo_driver_set_tolerance(drv, 1e-6, 1e-6));
    put_one(tribo_driver_set_output(drv, 0.1));
    put_one(tribo_driver_set_max_step(drv, 0.05));
    put_one(tribo_driver_set_observer(drv, seen, &watch));
    put_one(tribo_driver_advance(drv, &t, 5.0, y));
    put_one(t);
    put(WHOLE, y);
    put_one(watch.seen);
    put_one(watch.sum);
    put_one(tribo_system_get_limit(sys, 1.5, limit));
    put(N, limit);
    put_one(tribo_system_get_slip(sys, slip));
    put_one(slip[0]);
    put_one(slip[1]);
    put_one(tribo_system_get_count(sys, TRIBO_COUNT_STUCK, &stuck));
    put_one((double)stuck);
    put_one(tribo_system_clear_base_motion(sys));
    put_one(tribo_system_clear_limits(sys));
    tribo_get_limit(tribo_system_context(sys), limit);
    put(N, limit);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

void legacy_structures_play(void)
{
    put_one(tribo_dynamics_has(TRIBO_FEATURE_CHOLMOD));
    put_one(0);
    put_one(any_method_count());
    for (int k = 0; k < any_method_count(); k++) {
        put_text(any_method_name(k));
    }
    put_reduced();
    put_whole(0);
    put_whole(1);
}
