/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory of systems and drivers: none is asked for while the chain moves; and when there is none, nothing leaks. GSL allocates
 * for itself only in steppers, which are not among those that fail here; CHOLMOD's allocations fail as the library's own. */
#include <stdlib.h>
#include <string.h>

#if defined(TRIBO_CHOLMOD)
#include <SuiteSparse_config.h>
#endif

#include "make.h"
#include "memory.h"
#include "model.h"
#include "../set_up_driver.h"

/* Gives CHOLMOD the allocations that are counted. */
static void count_cholmod(void)
{
#if !defined(TRIBO_CHOLMOD)
#elif SUITESPARSE_MAIN_VERSION < 7
    SuiteSparse_config.malloc_func = malloc;
    SuiteSparse_config.calloc_func = calloc;
    SuiteSparse_config.realloc_func = realloc;
    SuiteSparse_config.free_func = free;
#else
    SuiteSparse_config_malloc_func_set(malloc);
    SuiteSparse_config_calloc_func_set(calloc);
    SuiteSparse_config_realloc_func_set(realloc);
    SuiteSparse_config_free_func_set(free);
#endif
}

TEST(fixed_steps_allocate_nothing)
{
    double t = 0.0, y[17] = {0};
    tribo_system *sys;
    assert_ok(tribo_system_chain(&sys, 8, 0.1, 0.25, 0.5));
    assert_ok(tribo_set_law(tribo_system_context(sys), _i));
    tribo_driver *drv = driver_create(sys, "rk4/fixed", 0.01, 0.0);
    const size_t before = memory_calls();
    require(before > 0, "allocations are not counted");
    const int status = tribo_driver_advance(drv, &t, 5.0, y);
    require(memory_calls() == before, "%zu allocations", memory_calls() - before);
    assert_status(status, TRIBO_OK);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

static const struct model *model;

static int make_chain(tribo_system **sys, tribo_driver **drv)
{
    (void)drv;
    return tribo_system_chain(sys, 8, 0.1, 0.25, 0.5);
}

static int make_belt(tribo_system **sys, tribo_driver **drv)
{
    (void)drv;
    return tribo_system_belt(sys, 2.0, 0.5, 0.25, 1.0, 0.5);
}

static int make_oscillator(tribo_system **sys, tribo_driver **drv)
{
    (void)drv;
    return tribo_system_oscillator(sys, 1.0, 1.5, 0.5);
}

static int make_linear(tribo_system **sys, const struct model *m, int damped, size_t nmode)
{
    return dense_system(sys, DOFS, CONTACTS, m->mass, damped ? m->damping : NULL, m->stiffness, m->direction, nmode, NULL, 0);
}

static int make_full(tribo_system **sys, tribo_driver **drv)
{
    (void)drv;
    return make_linear(sys, model, 1, 0);
}

static int make_diagonal(tribo_system **sys, tribo_driver **drv)
{
    struct model m = *model;
    for (size_t k = 0; k < DOFS * DOFS; k++) {
        m.mass[k] *= k % (DOFS + 1) ? 0.0 : 1.0;
    }
    (void)drv;
    return make_linear(sys, &m, 1, 0);
}

static int make_reduced(tribo_system **sys, tribo_driver **drv)
{
    (void)drv;
    return make_linear(sys, model, 0, 3);
}

enum { MASSES = 210 };

/* A chain long enough for sparse factors, with static responses. */
static int make_long(tribo_system **sys, int statics)
{
    gsl_spmatrix *m = gsl_spmatrix_alloc(MASSES, MASSES), *k = gsl_spmatrix_alloc(MASSES, MASSES),
                 *j = gsl_spmatrix_alloc(2, MASSES);
    for (size_t i = 0; i < MASSES; i++) {
        gsl_spmatrix_set(m, i, i, 4.0);
        gsl_spmatrix_set(k, i, i, 2.0);
        for (size_t to = i ? i - 1 : 1; to <= i + 1 && to < MASSES; to += 2) {
            gsl_spmatrix_set(m, i, to, 1.0);
            gsl_spmatrix_set(k, i, to, -1.0);
        }
    }
    gsl_spmatrix_set(j, 0, 50, 1.0);
    gsl_spmatrix_set(j, 1, 120, 1.0);
    const int status = reduced_system(sys, m, k, j, 3, statics, NULL, 0);
    gsl_spmatrix_free(m);
    gsl_spmatrix_free(k);
    gsl_spmatrix_free(j);
    return status;
}

/* Its copy. */
static int make_sparse(tribo_system **sys, tribo_driver **drv)
{
    tribo_system *from = NULL;
    (void)drv;
    int status = make_long(&from, TRIBO_STATICS_MASS);
    status = status ? status : tribo_system_clone(from, sys);
    tribo_system_destroy(from);
    return status;
}

/* The same with compliance, and a load that bends its contacts. */
static int make_compliant(tribo_system **sys, tribo_driver **drv)
{
    const double load[MASSES] = {[70] = 1.0};
    tribo_system *from = NULL;
    (void)drv;
    int status = make_long(&from, TRIBO_STATICS_COMPLIANCE);
    status = status ? status : tribo_system_set_damping_ratio(from, 0.1);
    status = status ? status : tribo_system_add_load(from, 1.0, load, NULL);
    status = status ? status : tribo_system_clone(from, sys);
    tribo_system_destroy(from);
    return status;
}

static int make_driver(tribo_system **sys, tribo_driver **drv)
{
    const int status = tribo_system_oscillator(sys, 1.0, 1.5, 0.5);
    return status ? status : set_up_driver(drv, *sys, "rk4/fixed", 0.1, 0.0, 0.0);
}

/* A system with all that can be added to it. */
static int make_loaded(tribo_system **sys, tribo_driver **drv)
{
    (void)drv;
    int status = make_linear(sys, model, 0, 3);
    status = status ? status : tribo_system_add_load(*sys, 1.0, model->load[0], NULL);
    status = status ? status : tribo_system_add_base_motion(*sys, 1.0, NULL, model->motion[0]);
    return status ? status : tribo_system_set_damping_ratio(*sys, 0.1);
}

/* Systems of all kinds, and copies of them; tables too. */
static int make_copy(tribo_system **sys, tribo_driver **drv)
{
    const double times[] = {0.0, 1.0}, values[] = {0.0, 1.0}, limits[2 * CONTACTS] = {1.0};
    tribo_system *from = NULL;
    (void)drv;
    int status = make_loaded(&from, drv);
    status = status ? status : tribo_system_add_load_table(from, 2, times, values, model->load[0]);
    status = status ? status : tribo_system_add_base_table(from, 2, times, values, limits);
    status = status ? status : tribo_system_set_limit_table(from, 2, times, limits);
    status = status ? status : tribo_system_add_limit(from, 1.0, limits, NULL);
    status = status ? status : tribo_system_clone(from, sys);
    tribo_system_destroy(from);
    return status;
}

static int make_full_copy(tribo_system **sys, tribo_driver **drv)
{
    tribo_system *from = NULL;
    int status = make_full(&from, drv);
    status = status ? status : tribo_system_clone(from, sys);
    tribo_system_destroy(from);
    return status;
}

/* From rest, with contacts that hold: what a held structure needs, with damping that couples its modes, or without. */
static int advance_exact(tribo_system **sys, tribo_driver **drv, int damped)
{
    double y[DIMENSION] = {0}, t = 0.0;
    int status = make_linear(sys, model, damped, 0);
    status = status                       ? status
             : tribo_system_context(*sys) ? tribo_set_limit_all(tribo_system_context(*sys), 1.0)
                                          : TRIBO_ERR_MEMORY;
    status = status ? status : tribo_system_add_load(*sys, 1.0, model->load[0], NULL);
    status = status ? status : tribo_system_add_base_motion(*sys, 1.0, NULL, model->motion[0]);
    status = status ? status : set_up_driver(drv, *sys, "exact", 1.0, 0.0, 0.0);
    return status ? status : tribo_driver_advance(*drv, &t, 0.1, y);
}

static int make_exact(tribo_system **sys, tribo_driver **drv)
{
    return advance_exact(sys, drv, 0);
}

static int make_coupled(tribo_system **sys, tribo_driver **drv)
{
    return advance_exact(sys, drv, 1);
}

/* Two sliders of which one is beyond its limit, on masses that are coupled or not, and one degree of freedom that only follows; a
 * copy of that. */
static int advance_massless(tribo_system **sys, tribo_driver **drv, double coupled, const char *method)
{
    enum { N = 5 };
    double mass[N * N] = {2.0, coupled}, stiffness[N * N] = {0.0}, direction[3 * N] = {0.0}, y[2 * N + 1] = {0.0}, t = 0.0;
    const double limit[] = {1.0, 1.0, 1.0}, load[N] = {1.0}, base[] = {0.1, 0.2, 0.0};
    tribo_system *from = NULL;
    mass[N] = coupled;
    mass[N + 1] = 1.0;
    for (size_t i = 2; i < N; i++) {
        stiffness[0] += 1.0;
        stiffness[i] = stiffness[i * N] = -1.0;
        stiffness[i * N + i] = 2.0;
        direction[(i - 2) * N + i] = 1.0;
    }
    direction[2 * N + N - 1] = 0.0;
    direction[2 * N + 1] = 1.0;
    y[2] = 3.0;
    int status = dense_system(&from, N, 3, mass, NULL, stiffness, direction, 0, NULL, 0);
    status = status ? status : tribo_system_clone(from, sys);
    tribo_system_destroy(from);
    status = status ? status : tribo_system_context(*sys) ? tribo_set_limit(tribo_system_context(*sys), limit) : TRIBO_ERR_MEMORY;
    status = status ? status : tribo_system_add_load(*sys, 1.0, load, NULL);
    status = status ? status : tribo_system_add_base_motion(*sys, 1.0, base, NULL);
    status = status ? status : set_up_driver(drv, *sys, method, 0.1, 1e-9, 0.0);
    status = status ? status : tribo_driver_advance(*drv, &t, 0.1, y);
    return status || strcmp(method, "exact") != 0 ? status : tribo_driver_find_periodic(*drv, 0.0, 2.0 * PI, y);
}

static int make_massless(tribo_system **sys, tribo_driver **drv)
{
    return advance_massless(sys, drv, 0.0, "exact");
}

static int make_massless_coupled(tribo_system **sys, tribo_driver **drv)
{
    return advance_massless(sys, drv, 0.5, "exact");
}

static int make_massless_event(tribo_system **sys, tribo_driver **drv)
{
    return advance_massless(sys, drv, 0.5, "event");
}

static int make_massless_moreau(tribo_system **sys, tribo_driver **drv)
{
    return advance_massless(sys, drv, 0.5, "moreau/fixed");
}

/* Modes of which some are far below the others, and so are found a second time. */
static int make_graded(tribo_system **sys, tribo_driver **drv)
{
    const double k = 1e8, stiffness[] = {k, -k, 0.0, -k, k + 1.0, -1.0, 0.0, -1.0, 1.0}, direction[] = {1.0, 0.0, 0.0};
    const double mass[] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    (void)drv;
    return dense_system(sys, 3, 1, mass, NULL, stiffness, direction, 2, NULL, 0);
}

/* A model of compressed rows with one elastic contact: all of it, or its modes. */
static int make_sliders(tribo_system **sys, size_t nmode)
{
    const size_t row[] = {0, 2, 4}, col[] = {0, 1, 0, 1}, end[] = {0, 2, 3};
    const double mass[] = {1.0, 2.0}, stiffness[] = {2.0, -1.0, -1.0, 2.0}, j[] = {1.0, -1.0, 1.0}, soft[] = {0.5, 0.0};
    tribo_model *from = NULL;
    int status = tribo_model_create(&from, 2, 2);
    status = status ? status : tribo_model_set_mass_diagonal(from, mass);
    status = status || nmode ? status : tribo_model_set_damping_csr(from, row, col, stiffness);
    status = status ? status : tribo_model_set_stiffness_csr(from, row, col, stiffness);
    status = status ? status : tribo_model_set_direction_csr(from, end, col, j);
    status = status ? status : tribo_model_set_compliance(from, soft);
    status = status ? status : nmode ? tribo_system_reduce(sys, from, nmode, TRIBO_STATICS_NONE) : tribo_system_create(sys, from);
    tribo_model_destroy(from);
    return status;
}

static int make_whole_sliders(tribo_system **sys, tribo_driver **drv)
{
    (void)drv;
    return make_sliders(sys, 0);
}

static int make_reduced_sliders(tribo_system **sys, tribo_driver **drv)
{
    (void)drv;
    return make_sliders(sys, 2);
}

/* A periodic motion, one of a family since a contact never slips, and what its period holds. */
static int find_periodic(tribo_system **sys, tribo_driver **drv, const char *method)
{
    const double limits[CONTACTS] = {1e3, 0.1, 0.1}, c[DIMENSION] = {1.0};
    double y[DIMENSION] = {0}, contact[CONTACTS], a, b;
    int status = make_linear(sys, model, 1, 0);
    status = status                       ? status
             : tribo_system_context(*sys) ? tribo_set_limit(tribo_system_context(*sys), limits)
                                          : TRIBO_ERR_MEMORY;
    status = status ? status : tribo_system_add_load(*sys, 1.0, model->load[0], NULL);
    status = status ? status : set_up_driver(drv, *sys, method, 1.0, 1e-13, 0.0);
    status = status ? status : tribo_driver_find_periodic(*drv, 0.0, 2.0 * PI, y);
    status = status ? status : tribo_driver_period_extremes(*drv, c, &a, &b, NULL, NULL);
    return status ? status : tribo_driver_period_stick(*drv, contact);
}

static int make_periodic(tribo_system **sys, tribo_driver **drv)
{
    return find_periodic(sys, drv, "exact");
}

static int make_periodic_event(tribo_system **sys, tribo_driver **drv)
{
    return find_periodic(sys, drv, "event");
}

/* A periodic motion of an elastic contact that slides at a limit which follows the motion, and lifts off. */
static int make_following(tribo_system **sys, tribo_driver **drv)
{
    const double mass[] = {1.0, 1.0}, stiffness[] = {12.0, 1.0, 1.0, 21.0}, direction[] = {1.0, 0.0, 0.0, 1.0},
                 soft[] = {0.2, 0.0};
    const double damping[] = {0.4, 2.0}, steady[] = {0.0, 100.0}, swing[] = {60.0, 60.0};
    double y[6] = {0.0};
    tribo_model *from = NULL;
    int status = tribo_model_create(&from, 2, 2);
    status = status ? status : tribo_model_set_mass_diagonal(from, mass);
    status = status ? status : tribo_model_set_damping_diagonal(from, damping);
    status = status ? status : tribo_model_set_stiffness(from, stiffness);
    status = status ? status : tribo_model_set_direction(from, direction);
    status = status ? status : tribo_model_set_compliance(from, soft);
    status = status ? status : tribo_model_set_normal(from, 0, 1, 0.85, 21.0, 0.0);
    status = status ? status : tribo_system_create(sys, from);
    tribo_model_destroy(from);
    status = status ? status : tribo_system_add_load(*sys, 0.0, steady, NULL);
    status = status ? status : tribo_system_add_load(*sys, 5.0, swing, NULL);
    status = status ? status : set_up_driver(drv, *sys, "exact", 1.0, 0.0, 0.0);
    return status ? status : tribo_driver_find_periodic(*drv, 0.0, 2.0 * PI / 5.0, y);
}

/* A cycle of a block on a belt. */
static int make_cycle(tribo_system **sys, tribo_driver **drv)
{
    const double one = 1.0, belt = 0.2, ratio = 1.0 / 0.6, limit = 0.6;
    double y[3] = {0.0}, period = 0.0;
    int status = dense_system(sys, 1, 1, &one, NULL, &one, &one, 0, NULL, 0);
    status = status ? status : tribo_system_add_base_motion(*sys, 0.0, &belt, NULL);
    tribo_context *c = status ? NULL : tribo_system_context(*sys);
    status = status || c ? status : TRIBO_ERR_MEMORY;
    status = status ? status : tribo_set_limit(c, &limit);
    status = status ? status : tribo_set_static(c, &ratio, NULL);
    status = status ? status : set_up_driver(drv, *sys, "exact", 1.0, 1e-13, 0.0);
    return status ? status : tribo_driver_find_cycle(*drv, 0.0, &period, y);
}

/* An equilibrium of steady sliding, and its onset of flutter, with a contact that may rest. */
static int make_equilibrium(tribo_system **sys, tribo_driver **drv)
{
    const double mass[] = {1.0, 1.0, 1.0}, belt[] = {0.5, 0.0, 0.0}, load[] = {0.0, 10.0, 0.1};
    const double stiffness[] = {23.25, 7.8, 0.0, 7.8, 7.75, 0.0, 0.0, 0.0, 1.0};
    double y[7] = {0.0}, re[6], im[6], critical, omega;
    size_t count;
    tribo_model *from = NULL;
    (void)drv;
    int status = tribo_model_create(&from, 3, 3);
    status = status ? status : tribo_model_set_mass_diagonal(from, mass);
    status = status ? status : tribo_model_set_stiffness(from, stiffness);
    status = status ? status : tribo_model_set_direction(from, (const double[]){1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
    status = status ? status : tribo_model_set_normal(from, 0, 1, 0.6, 11.0, 0.0);
    status = status ? status : tribo_system_create(sys, from);
    tribo_model_destroy(from);
    status = status ? status : tribo_system_add_load(*sys, 0.0, load, NULL);
    status = status ? status : tribo_system_add_base_motion(*sys, 0.0, belt, NULL);
    tribo_context *c = status ? NULL : tribo_system_context(*sys);
    status = status || c ? status : TRIBO_ERR_MEMORY;
    status = status ? status : tribo_set_limit(c, (const double[]){0.0, 0.0, 1.0});
    status = status ? status : tribo_system_equilibrium(*sys, NULL, y, NULL, &count, re, im);
    return status ? status : tribo_system_find_flutter(*sys, TRIBO_FLUTTER_FRICTION, NULL, NULL, 0.78, 2.0, &critical, &omega);
}

/* A nonlinear mode, from the linear one, and the mode of the next amplitude. */
static int make_mode(tribo_system **sys, tribo_driver **drv)
{
    const double limits[] = {0.1, 0.05}, c[] = {1.0, 0.0, 0.0, 0.5};
    double y[6] = {0.0}, omega = 0.0, zeta = 0.0, re[5], im[5];
    int status = make_sliders(sys, 0);
    tribo_context *own = status ? NULL : tribo_system_context(*sys);
    status = status || own ? status : TRIBO_ERR_MEMORY;
    status = status ? status : tribo_set_limit(own, limits);
    status = status ? status : set_up_driver(drv, *sys, "exact", 1.0, 1e-13, 0.0);
    status = status ? status : tribo_driver_find_mode(*drv, c, 1.0, &omega, &zeta, y);
    status = status ? status : tribo_driver_find_mode(*drv, c, 1.2, &omega, &zeta, y);
    return status ? status : tribo_driver_get_multipliers(*drv, re, im);
}

/* A step of a curve of cycles. */
static int make_curve(tribo_system **sys, tribo_driver **drv)
{
    const double one = 1.0, belt = 1.2, ratio = 1.0 / 0.6, limit = 0.6, fall = 0.5, damping = 0.115;
    const tribo_curve curve = {.size = sizeof curve,
                               .motion = TRIBO_MOTION_CYCLE,
                               .parameter = TRIBO_PARAMETER_BASES,
                               .least = 0.9,
                               .most = 2.0,
                               .step = 0.05,
                               .points = 2,
                               .coarse = 1};
    double y[3] = {0.0, 1.2, 0.0}, period = 0.0;
    int status = dense_system(sys, 1, 1, &one, &damping, &one, &one, 0, NULL, 0);
    status = status ? status : tribo_system_add_base_motion(*sys, 0.0, &belt, NULL);
    tribo_context *c = status ? NULL : tribo_system_context(*sys);
    status = status || c ? status : TRIBO_ERR_MEMORY;
    status = status ? status : tribo_set_limit(c, &limit);
    status = status ? status : tribo_set_static(c, &ratio, &fall);
    status = status ? status : set_up_driver(drv, *sys, "event", 1.0, 1e-13, 0.0);
    return status ? status : tribo_driver_follow_curve(*drv, &curve, 0.0, &period, y, NULL, NULL);
}

static const struct {
    const char *name;
    int (*make)(tribo_system **sys, tribo_driver **drv);
} makers[] = {{"chain", make_chain},
              {"belt", make_belt},
              {"oscillator", make_oscillator},
              {"full", make_full},
              {"diagonal", make_diagonal},
              {"reduced", make_reduced},
              {"driver", make_driver},
              {"loaded", make_loaded},
              {"exact", make_exact},
              {"coupled", make_coupled},
              {"following", make_following},
              {"graded", make_graded},
              {"copy", make_copy},
              {"full copy", make_full_copy},
              {"periodic", make_periodic},
              {"cycle", make_cycle},
              {"equilibrium", make_equilibrium},
              {"mode", make_mode},
              {"curve", make_curve},
              {"periodic event", make_periodic_event},
              {"sparse", make_sparse},
              {"compliant", make_compliant},
              {"massless", make_massless},
              {"massless coupled", make_massless_coupled},
              {"massless event", make_massless_event},
              {"massless moreau", make_massless_moreau},
              {"sliders", make_whole_sliders},
              {"reduced sliders", make_reduced_sliders}};

/* Fails one allocation after the other, until there are no more. Those that make blocks smaller may fail without an error. */
TEST(failures)
{
    struct random g = random_of(1);
    const struct model m = model_create(&g, 1);
    model = &m;
    size_t fails = 1;
    count_cholmod();
    for (int failed = 1; failed; fails++) {
        tribo_system *sys = NULL;
        tribo_driver *drv = NULL;
        const long none = memory_live();
        const size_t before = memory_calls();
        memory_fail(fails);
        const int status = makers[_i].make(&sys, &drv);
        memory_fail(0);
        failed = memory_calls() - before >= fails;
        require(!status || (failed && status == TRIBO_ERR_MEMORY), "%s, allocation %zu: %d", makers[_i].name, fails, status);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
        require(memory_live() == none, "%s leaves %ld blocks behind when allocation %zu fails", makers[_i].name,
                memory_live() - none, fails);
    }
    ck_assert_uint_gt(fails, 10);
}

/* Every call allocates the Jacobian's workspace, in one block. */
TEST(failing_jacobian)
{
    double y[DIMENSION] = {0}, dfdy[DIMENSION * DIMENSION], dfdt[DIMENSION];
    struct random g = random_of(1);
    const struct model m = model_create(&g, 1);
    tribo_system *sys = model_system(&m, 1, 0, 0.1);
    const gsl_odeiv2_system *ode = tribo_gsl_system(sys);
    for (int round = 0; round < 2; round++) {
        memory_fail(1);
        const int status = ode->jacobian(0.0, y, dfdy, dfdt, ode->params);
        memory_fail(0);
        ck_assert_int_eq(status, GSL_EBADFUNC);
        assert_says(tribo_system_message(sys), "out of memory for the Jacobian");
        ck_assert_int_eq(ode->jacobian(0.0, y, dfdy, dfdt, ode->params), GSL_SUCCESS);
    }
    tribo_system_destroy(sys);
}

TEST_MAIN("memory", {fixed_steps_allocate_nothing, 6}, {failures, COUNT(makers)}, {failing_jacobian, 1})
