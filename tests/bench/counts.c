/* SPDX-License-Identifier: BSD-3-Clause */
/* Fixed amounts of work, whose instructions callgrind counts: see run.sh --counts. bench_counts --list names the scenes;
 * bench_counts SCENE runs one, and prints how many units of what its work is. Nothing but counted() is to be counted. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../src/damper/output.h"
#include "kernel_scene.h"
#include "tribo/tribo_gsl.h"
#include "../set_up_driver.h"

enum { WARM = 100 };

/* What is counted, so many times. */
struct work {
    void (*run)(void *data);
    void *data;
    size_t times;
};

/* A function that stays one, under this name: the compiler cannot see which job it runs. */
#if defined(__GNUC__)
__attribute__((noinline))
#endif
void counted(const struct work *w);

void counted(const struct work *w)
{
    for (size_t k = 0; k < w->times; k++) {
        w->run(w->data);
    }
}

/* ------------------------------------------------------------------------------------------------------------- contacts */

static void run_kernel(void *data)
{
    kernel_call(data);
}

static double count_kernel(enum kernel kernel, size_t n, int alike)
{
    struct kernel_scene s;
    const struct work w = {run_kernel, &s, n == 1 ? 10000 : 100};
    kernel_scene_create(&s, kernel, n, alike ? ALL : NOTHING);
    for (int k = 0; k < WARM; k++) {
        kernel_call(&s);
    }
    counted(&w);
    kernel_scene_destroy(&s);
    return (double)(w.times * n);
}

#if defined(HAVE_FORTRAN)
/* As a Fortran 77 program calls them. */
void trbnew_(const int *n, int *ih, int *ierr);
void trblim_(const int *ih, const int *n, const double *limit, int *ierr);
void trbopd_(const int *ih, const int *n, const double *r, int *ierr);
void trbbal_(const int *ih, const int *n, const double *v, const double *a, double *feq, double *f, int *ierr);
void trbdel_(const int *ih, int *ierr);

static void run_fixed_form(void *data)
{
    static const int one = 1;
    static const double v = 1e-7, a = 0.5;
    double feq, f;
    int status;
    trbbal_(data, &one, &v, &a, &feq, &f, &status);
    need(status, NULL);
}

static double count_fixed_form(void)
{
    static const double unit = 1.0;
    const int one = 1;
    int handle, status[3];
    trbnew_(&one, &handle, status);
    trblim_(&handle, &one, &unit, status + 1);
    trbopd_(&handle, &one, &unit, status + 2);
    need(status[0] | status[1] | status[2], NULL);
    const struct work w = {run_fixed_form, &handle, 10000};
    run_fixed_form(&handle);
    counted(&w);
    trbdel_(&handle, status);
    return (double)w.times;
}
#endif

/* -------------------------------------------------------------------------------------------------------------- drivers */

struct motion {
    tribo_driver *drv;
    double t, stretch, *y;
};

static void run_motion(void *data)
{
    struct motion *m = data;
    need(tribo_driver_advance(m->drv, &m->t, m->t + m->stretch, m->y), tribo_driver_message(m->drv));
}

static double progress(const struct motion *m, int which)
{
    size_t value;
    need(tribo_driver_count(m->drv, which, &value), NULL);
    return (double)value;
}

/* Counts the steps of a stretch of time, or its events, after as much that is not counted. All bodies begin with this speed. */
static double count_motion(tribo_system *sys, size_t n, const char *method, double dt, double stretch, double speed)
{
    struct motion m = {.stretch = stretch, .y = need_memory(2 * n + 1, sizeof *m.y)};
    const int which = dt > 0.0 ? TRIBO_COUNT_STEPS : TRIBO_COUNT_EVENTS;
    const struct work w = {run_motion, &m, 1};
    for (size_t i = 0; i < 2 * n + 1; i++) {
        m.y[i] = i >= n && i < 2 * n ? speed : 0.0;
    }
    need(set_up_driver(&m.drv, sys, method, dt > 0.0 ? dt : 0.01, 1e-11, 1e-11), NULL);
    run_motion(&m);
    const double before = progress(&m, which);
    counted(&w);
    const double units = progress(&m, which) - before;
    tribo_driver_destroy(m.drv);
    tribo_system_destroy(sys);
    free(m.y);
    return units;
}

static int finds_events(const char *method)
{
    return strcmp(method, "exact") == 0 || strcmp(method, "event") == 0;
}

static double count_chain(const char *method, size_t n)
{
    tribo_system *sys;
    const double dt = n > 100 ? 3e-4 : 1e-2;
    need(tribo_system_chain(&sys, n, 1.0, 0.25, 0.5), NULL);
    if (finds_events(method)) {
        return count_motion(sys, n, method, 0.0, 12.0, 0.0); /* a period, nearly */
    }
    need(tribo_set_epsilon_step(tribo_system_context(sys), dt, 0.4), NULL);
    return count_motion(sys, n, method, dt, 200.0 * dt, 0.0);
}

/* Of which a load keeps 1.1% moving, or all of which slide. So many steps that what an advance begins and ends with, which looks
 * at all blocks, is little of them. */
static double count_long_chain(const char *method, size_t n, int slides)
{
    tribo_system *sys;
    const double dt = 0.9 / (double)n;
    need(tribo_system_chain(&sys, n, 1.0, 0.01, 100.0), NULL);
    return count_motion(sys, n, method, dt, (slides ? 500.0 : 5000.0) * dt, slides ? 1.0 : 0.0);
}

/* Steps of 0.01, or the events of this time. */
static double count_small(tribo_system *sys, size_t n, const char *method, double time)
{
    const double dt = 0.01;
    if (finds_events(method)) {
        return count_motion(sys, n, method, 0.0, time, 0.0);
    }
    need(tribo_set_epsilon_step(tribo_system_context(sys), dt, 0.4), NULL);
    return count_motion(sys, n, method, dt, 2000.0 * dt, 0.0);
}

static double count_oscillator(const char *method, double alpha, double omega)
{
    tribo_system *sys;
    need(tribo_system_oscillator(&sys, 1.0, alpha, omega), NULL);
    return count_small(sys, 1, method, 200.0);
}

static double count_belt(const char *method)
{
    tribo_system *sys;
    need(tribo_system_belt(&sys, 2.0, 0.5, 0.25, 1.0, 0.5), NULL);
    return count_small(sys, 2, method, 60.0);
}

/* A periodic motion of a chain of bodies with a contact each but the last two; its derivatives by 20 parameters: the limits,
 * twice. */
enum { BODIES = 12, TOUCHING = 10, PARAMETERS = 20 };

struct steady {
    tribo_driver *drv;
    double period, y[2 * BODIES + 1];
    int kind[PARAMETERS];
    size_t index[PARAMETERS];
};

static void run_search(void *data)
{
    struct steady *s = data;
    memset(s->y, 0, sizeof s->y);
    need(tribo_driver_find_periodic(s->drv, 0.0, s->period, s->y), tribo_driver_message(s->drv));
}

static void run_derivatives(void *data)
{
    const double c[2 * BODIES] = {1.0};
    struct steady *s = data;
    double extremes[PARAMETERS][2], energy[PARAMETERS][TOUCHING];
    need(tribo_driver_period_derivatives(s->drv, PARAMETERS, s->kind, s->index, c, extremes[0], energy[0], NULL),
         tribo_driver_message(s->drv));
}

/* Creates the system of BODIES bodies of mass 1. */
static tribo_system *bodies_of(const double *stiffness, const double *damping, size_t contacts, const double *direction)
{
    double mass[BODIES];
    tribo_model *model;
    tribo_system *sys;
    for (size_t d = 0; d < BODIES; d++) {
        mass[d] = 1.0;
    }
    need(tribo_model_create(&model, BODIES, contacts), NULL);
    need(tribo_model_set_mass_diagonal(model, mass), NULL);
    need(tribo_model_set_stiffness(model, stiffness), NULL);
    need(tribo_model_set_damping(model, damping), NULL);
    need(tribo_model_set_direction(model, direction), NULL);
    need(tribo_system_create(&sys, model), tribo_model_message(model));
    tribo_model_destroy(model);
    return sys;
}

/* Counts the periods of a search, or one call for its derivatives. */
static double count_steady(const char *method, int derivatives)
{
    struct steady s = {.period = 2.0 * acos(-1.0) / 0.6};
    double stiffness[BODIES * BODIES] = {0}, damping[BODIES * BODIES], direction[TOUCHING * BODIES] = {0};
    double load[BODIES], limit[TOUCHING];
    for (size_t d = 0; d < BODIES; d++) {
        load[d] = 1.0 + 0.3 * sin(3.0 * (double)d);
        stiffness[d * BODIES + d] = d == 0 || d + 1 == BODIES ? 20.3 : 40.3;
        if (d > 0) {
            stiffness[d * BODIES + d - 1] = stiffness[(d - 1) * BODIES + d] = -20.0;
        }
    }
    for (size_t i = 0; i < BODIES * BODIES; i++) {
        damping[i] = 0.01 * stiffness[i];
    }
    for (size_t i = 0; i < TOUCHING; i++) {
        direction[i * BODIES + i] = 1.0;
        limit[i] = 0.4 + 0.15 * sin(2.0 * (double)i);
        s.index[i] = s.index[i + TOUCHING] = i;
    }
    tribo_system *sys = bodies_of(stiffness, damping, TOUCHING, direction);
    need(tribo_system_add_load(sys, 0.6, load, NULL), NULL);
    need(tribo_set_limit(tribo_system_context(sys), limit), NULL);
    need(set_up_driver(&s.drv, sys, method, 0.01, 1e-11, 1e-11), NULL);
    run_search(&s);
    const struct motion m = {.drv = s.drv};
    const struct work w = {derivatives ? run_derivatives : run_search, &s, 10};
    const double before = progress(&m, TRIBO_COUNT_PERIODS);
    counted(&w);
    const double periods = progress(&m, TRIBO_COUNT_PERIODS) - before;
    tribo_driver_destroy(s.drv);
    tribo_system_destroy(sys);
    return derivatives ? (double)w.times : periods;
}

/* Searches for the motion of a ring of BODIES bodies with a contact each, told = 1: declared as a ring. */
static double count_ring(const char *method, int told)
{
    const double turn = 2.0 * acos(-1.0);
    struct steady s = {.period = turn / 0.9};
    double stiffness[BODIES * BODIES] = {0}, damping[BODIES * BODIES] = {0}, direction[BODIES * BODIES] = {0};
    double cosine[BODIES], sine[BODIES];
    for (size_t j = 0; j < BODIES; j++) {
        direction[j * BODIES + j] = 1.0;
        damping[j * BODIES + j] = 0.1;
        stiffness[j * BODIES + j] = 2.0;
        stiffness[j * BODIES + (j + 1) % BODIES] = stiffness[(j + 1) % BODIES * BODIES + j] = -0.5;
        cosine[j] = cos(turn * (double)j / BODIES);
        sine[j] = sin(turn * (double)j / BODIES);
    }
    tribo_system *sys = bodies_of(stiffness, damping, BODIES, direction);
    need(tribo_system_add_load(sys, 0.9, cosine, sine), NULL);
    need(tribo_set_limit_all(tribo_system_context(sys), 0.3), NULL);
    need(set_up_driver(&s.drv, sys, method, 0.01, 1e-11, 1e-11), NULL);
    need(tribo_driver_set_ring(s.drv, told ? BODIES : 0, 1), tribo_driver_message(s.drv));
    run_search(&s);
    const struct work w = {run_search, &s, 10};
    counted(&w);
    tribo_driver_destroy(s.drv);
    tribo_system_destroy(sys);
    return (double)w.times;
}

/* --------------------------------------------------------------------------------------------------------------- scenes */

enum subject { KERNEL, FIXED_FORM, CHAIN, RESTING, SLIDING, OSCILLATOR, BELT, STEADY, DERIVATIVES, RING };

static const struct scene {
    const char *name, *unit;
    enum subject subject;
    enum kernel kernel;
    size_t n;
    int alike;
    const char *method;
    double alpha, omega;
} scenes[] = {
    {"force-alike", "contact", KERNEL, FORCE, 1000, 1, NULL, 0.0, 0.0},
    {"force", "contact", KERNEL, FORCE, 1000, 0, NULL, 0.0, 0.0},
    {"force-slide", "contact", KERNEL, FORCE_SLIDE, 1000, 0, NULL, 0.0, 0.0},
    {"force-tangent-alike", "contact", KERNEL, FORCE_TANGENT, 1000, 1, NULL, 0.0, 0.0},
    {"force-tangent", "contact", KERNEL, FORCE_TANGENT, 1000, 0, NULL, 0.0, 0.0},
    {"balance-alike", "contact", KERNEL, BALANCE, 1000, 1, NULL, 0.0, 0.0},
    {"balance", "contact", KERNEL, BALANCE, 1000, 0, NULL, 0.0, 0.0},
    {"balance-stuck", "contact", KERNEL, BALANCE_STUCK, 1000, 0, NULL, 0.0, 0.0},
    {"balance-slide", "contact", KERNEL, BALANCE_SLIDE, 1000, 0, NULL, 0.0, 0.0},
    {"step-alike", "contact", KERNEL, STEP, 1000, 1, NULL, 0.0, 0.0},
    {"step", "contact", KERNEL, STEP, 1000, 0, NULL, 0.0, 0.0},
    {"step-stuck", "contact", KERNEL, STEP_STUCK, 1000, 0, NULL, 0.0, 0.0},
    {"set-limit", "contact", KERNEL, SET_LIMIT, 1000, 0, NULL, 0.0, 0.0},
    {"force-one", "call", KERNEL, FORCE, 1, 0, NULL, 0.0, 0.0},
    {"balance-one", "call", KERNEL, BALANCE, 1, 0, NULL, 0.0, 0.0},
    {"step-one", "call", KERNEL, STEP, 1, 0, NULL, 0.0, 0.0},
    {"set-limit-one", "call", KERNEL, SET_LIMIT, 1, 0, NULL, 0.0, 0.0},
#if defined(HAVE_FORTRAN)
    {"trbbal-one", "call", FIXED_FORM, FORCE, 1, 0, NULL, 0.0, 0.0},
#endif
    {"central-32", "step", CHAIN, FORCE, 32, 0, "central/fixed", 0.0, 0.0},
    {"central-1000", "step", CHAIN, FORCE, 1000, 0, "central/fixed", 0.0, 0.0},
    {"central-resting", "step", RESTING, FORCE, 100000, 0, "central/fixed", 0.0, 0.0},
    {"central-sliding", "step", SLIDING, FORCE, 100000, 0, "central/fixed", 0.0, 0.0},
    {"rk4-32", "step", CHAIN, FORCE, 32, 0, "rk4/fixed", 0.0, 0.0},
    {"rk4-1000", "step", CHAIN, FORCE, 1000, 0, "rk4/fixed", 0.0, 0.0},
    {"moreau-32", "step", CHAIN, FORCE, 32, 0, "moreau/fixed", 0.0, 0.0},
    {"central-7a", "step", OSCILLATOR, FORCE, 1, 0, "central/fixed", 1.5, 0.5},
    {"rk4-7a", "step", OSCILLATOR, FORCE, 1, 0, "rk4/fixed", 1.5, 0.5},
    {"moreau-7a", "step", OSCILLATOR, FORCE, 1, 0, "moreau/fixed", 1.5, 0.5},
    {"central-belt", "step", BELT, FORCE, 2, 0, "central/fixed", 0.0, 0.0},
    {"rk4-belt", "step", BELT, FORCE, 2, 0, "rk4/fixed", 0.0, 0.0},
    {"moreau-belt", "step", BELT, FORCE, 2, 0, "moreau/fixed", 0.0, 0.0},
    {"exact-7a", "event", OSCILLATOR, FORCE, 1, 0, "exact", 1.5, 0.5},
    {"exact-7b", "event", OSCILLATOR, FORCE, 1, 0, "exact", 2.0, 2.0},
    {"exact-belt", "event", BELT, FORCE, 2, 0, "exact", 0.0, 0.0},
    {"exact-32", "event", CHAIN, FORCE, 32, 0, "exact", 0.0, 0.0},
    {"event-7a", "event", OSCILLATOR, FORCE, 1, 0, "event", 1.5, 0.5},
    {"event-belt", "event", BELT, FORCE, 2, 0, "event", 0.0, 0.0},
    {"event-32", "event", CHAIN, FORCE, 32, 0, "event", 0.0, 0.0},
    {"steady-exact", "period", STEADY, FORCE, BODIES, 0, "exact", 0.0, 0.0},
    {"derivatives-exact", "call", DERIVATIVES, FORCE, BODIES, 0, "exact", 0.0, 0.0},
    {"steady-event", "period", STEADY, FORCE, BODIES, 0, "event", 0.0, 0.0},
    {"derivatives-event", "call", DERIVATIVES, FORCE, BODIES, 0, "event", 0.0, 0.0},
    {"ring-whole-exact", "search", RING, FORCE, BODIES, 0, "exact", 0.0, 0.0},
    {"ring-exact", "search", RING, FORCE, BODIES, 1, "exact", 0.0, 0.0},
    {"ring-whole-event", "search", RING, FORCE, BODIES, 0, "event", 0.0, 0.0},
    {"ring-event", "search", RING, FORCE, BODIES, 1, "event", 0.0, 0.0},
};
enum { SCENES = sizeof scenes / sizeof *scenes };

static double run_scene(const struct scene *s)
{
    switch (s->subject) {
    case KERNEL:
        return count_kernel(s->kernel, s->n, s->alike);
    case CHAIN:
        return count_chain(s->method, s->n);
    case RESTING:
    case SLIDING:
        return count_long_chain(s->method, s->n, s->subject == SLIDING);
    case OSCILLATOR:
        return count_oscillator(s->method, s->alpha, s->omega);
    case BELT:
        return count_belt(s->method);
    case STEADY:
    case DERIVATIVES:
        return count_steady(s->method, s->subject == DERIVATIVES);
    case RING:
        return count_ring(s->method, s->alike);
    default:
        break;
    }
#if defined(HAVE_FORTRAN)
    return count_fixed_form();
#else
    return 0.0;
#endif
}

int main(int count, char **argument)
{
    const char *name = count == 2 ? argument[1] : "";
    const int list = strcmp(name, "--list") == 0, all = strcmp(name, "--smoke") == 0;
    int found = list;
    program = "bench_counts";
    for (size_t k = 0; k < SCENES; k++) {
        if (list) {
            printf("%s\n", scenes[k].name);
        } else if (all || strcmp(name, scenes[k].name) == 0) {
            const double units = run_scene(&scenes[k]);
            need(units > 0.0 ? 0 : TRIBO_ERR_STATE, scenes[k].name);
            printf("%.0f %s\n", units, scenes[k].unit);
            found = 1;
        }
    }
    if (!found) {
        fprintf(stderr, "usage: bench_counts --list | --smoke | SCENE\n");
    }
    return found ? EXIT_SUCCESS : EXIT_FAILURE;
}
