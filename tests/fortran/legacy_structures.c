/* What legacy_structures.f does, by the functions of C. */
#include "../make.h"
#include "tape.h"
#include "tribo/tribo_gsl.h"
#include "../set_up_driver.h"

enum { N = 2, FULL = 6, WHOLE = 2 * FULL + 1, REDUCED = 4 };

static gsl_spmatrix *rows_of(gsl_spmatrix *triplets)
{
    gsl_spmatrix *rows = gsl_spmatrix_compress(triplets, GSL_SPMATRIX_CSR);
    gsl_spmatrix_free(triplets);
    return rows;
}

static gsl_spmatrix *mass_of_row(void)
{
    gsl_spmatrix *m = gsl_spmatrix_alloc(FULL, FULL);
    for (size_t i = 0; i < FULL; i++) {
        gsl_spmatrix_set(m, i, i, 1.0 + 0.1 * (double)(i + 1));
    }
    return rows_of(m);
}

static gsl_spmatrix *springs(double stiffness)
{
    gsl_spmatrix *k = gsl_spmatrix_alloc(FULL, FULL);
    for (size_t i = 0; i < FULL; i++) {
        if (i > 0) {
            gsl_spmatrix_set(k, i, i - 1, -stiffness);
        }
        gsl_spmatrix_set(k, i, i, 2.0 * stiffness);
        if (i + 1 < FULL) {
            gsl_spmatrix_set(k, i, i + 1, -stiffness);
        }
    }
    return rows_of(k);
}

static gsl_spmatrix *contacts(void)
{
    gsl_spmatrix *j = gsl_spmatrix_alloc(N, FULL);
    gsl_spmatrix_set(j, 0, 1, 1.0);
    gsl_spmatrix_set(j, 1, 4, 1.0);
    return rows_of(j);
}

static tribo_system *make(int damped, size_t nmode, int static_contacts)
{
    gsl_spmatrix *m = mass_of_row(), *c = springs(0.1), *k = springs(1.0), *j = contacts();
    tribo_system *sys = NULL;
    if (nmode) {
        reduced_system(&sys, m, k, j, nmode, static_contacts, NULL, 0);
    } else {
        sparse_system(&sys, m, damped ? c : NULL, k, j, 0, NULL, 0);
    }
    gsl_spmatrix_free(m);
    gsl_spmatrix_free(c);
    gsl_spmatrix_free(k);
    gsl_spmatrix_free(j);
    return sys;
}

static void put_reduced(void)
{
    const double cosine[FULL] = {1.0}, sine[FULL] = {0.0};
    double omega[REDUCED] = {0.0}, full[FULL], error = 0.0, y[2 * REDUCED + 1] = {0.0}, t = 0.0;
    tribo_system *sys = make(0, 2, 1), *copy = NULL;
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
    sys = make(0, 2, 0);
    put_one((double)tribo_system_ndof(sys));
    tribo_system_destroy(sys);
}

static void put_look(tribo_system *sys, const double *y)
{
    const gsl_odeiv2_system *ode = tribo_gsl_system(sys);
    double v[N], feq[N], f[N], dydt[WHOLE], dfdy[WHOLE][WHOLE], dfdt[WHOLE];
    put_one(tribo_system_contacts(sys, 0.5, y, v, feq, f));
    put(N, v);
    put(N, feq);
    put(N, f);
    put_one(ode->function(0.5, y, dydt, ode->params));
    put(WHOLE, dydt);
    put_one(ode->jacobian(0.5, y, dfdy[0], dfdt, ode->params));
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
    tribo_gsl_driver_create(&drv, sys, "rkf45");
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
