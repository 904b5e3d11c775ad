/* SPDX-License-Identifier: BSD-3-Clause */
/* What a steady motion costs: tribo_driver_find_periodic beside what people do, marching to rest and harmonic balance, on the
 * beam of the examples at several frequencies and limits. bench_periodic --help tells the options. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "make.h"
#include "../../src/damper/output.h"
#include "beam.h"
#include "harmonic_balance.h"
#include "harness.h"
#include "../set_up_driver.h"

static const char help[] = "bench_periodic: what the steady motion of a structure with friction costs.\n"
                           "\n"
                           "  --out FOLDER     where the table goes, which must exist; \".\"\n"
                           "  --smoke          no times: fails if harmonic balance and shooting disagree, for ctest\n";

enum { FREQUENCIES = 4, LIMITS = 9, POINTS = FREQUENCIES * LIMITS, STATE = 2 * MODES + 1, MOST_CYCLES = 20000, FIRST_CHECK = 64 };

/* Seconds that a pass may take: what takes longer is extrapolated. */
#define BUDGET 40.0

static const double frequency[FREQUENCIES] = {0.97, 1.0, 1.03, 1.1}; /* times the first natural one */
static const double wanted[] = {1e-3, 1e-6};                         /* errors */
enum { WANTED = sizeof wanted / sizeof *wanted };

/* The beam by its modes, one load, and what is known of its motions. */
struct study {
    struct model model;
    tribo_system *sys;
    struct steady reference[POINTS];
    struct steady largest[FREQUENCIES]; /* of all limits: what errors are measured by */
};

static double omega_of(const struct study *s, size_t point)
{
    return frequency[point / LIMITS] * s->model.omega;
}

/* From a hundredth to a hundred times the best limit. */
static double limit_of_point(const struct study *s, size_t point)
{
    return s->model.limit[0] * pow(10.0, 0.5 * (double)(point % LIMITS) - 2.0);
}

/* The difference of two motions, beside the largest of all limits. */
static double difference(const struct study *s, size_t point, const struct steady *a, const struct steady *b)
{
    const struct steady *largest = &s->largest[point / LIMITS];
    return fmax(fabs(a->amplitude - b->amplitude) / largest->amplitude, fabs(a->power - b->power) / largest->power);
}

static double error_of(const struct study *s, size_t point, const struct steady *found)
{
    return difference(s, point, found, &s->reference[point]);
}

static void set_point(const struct study *s, size_t point)
{
    tribo_context *c = tribo_system_context(s->sys);
    need(tribo_system_clear_loads(s->sys), tribo_system_message(s->sys));
    need(tribo_system_add_load(s->sys, omega_of(s, point), NULL, s->model.beam.load), tribo_system_message(s->sys));
    need(tribo_set_limit_all(c, limit_of_point(s, point)), tribo_message(c));
}

/* ------------------------------------------------------------------------------------------------------------- methods */

/* One pass over all points, each from the motion at the limit before. error: the worst, INFINITY if a point was not found. */
struct pass {
    const struct study *study;
    const char *method;
    double setting, aim;
    double error;
    size_t work; /* periods integrated, or Newton's steps */
};

static tribo_driver *open_driver(const struct pass *p, double dt, double tolerance)
{
    tribo_driver *drv;
    need(set_up_driver(&drv, p->study->sys, p->method, dt, tolerance, tolerance), tribo_system_message(p->study->sys));
    return drv;
}

/* Half of how far the load's place moves, times the load, over a period from y on, which ends where the period does. */
static double amplitude_from(const struct study *s, tribo_driver *drv, double period, size_t samples, double *y)
{
    double t = 0.0, least = HUGE_VAL, most = -HUGE_VAL;
    for (size_t i = 1; i <= samples; i++) {
        double work = 0.0;
        need(tribo_driver_advance(drv, &t, period * (double)i / (double)samples, y), tribo_driver_message(drv));
        for (size_t k = 0; k < MODES; k++) {
            work += s->model.beam.load[k] * y[k];
        }
        least = fmin(least, work);
        most = fmax(most, work);
    }
    return 0.5 * (most - least);
}

/* What the periodic motion found last holds, in closed form; drv NULL: none was found. */
static void measure_period(const struct study *s, tribo_driver *drv, double period, struct steady *found)
{
    double c[2 * MODES] = {0.0}, energy[CONTACTS], least, most;
    *found = (struct steady){HUGE_VAL, 0.0};
    if (drv) {
        memcpy(c, s->model.beam.load, sizeof s->model.beam.load);
        need(tribo_driver_period_extremes(drv, c, &least, &most, NULL, NULL), tribo_driver_message(drv));
        need(tribo_driver_period_dissipation(drv, energy), tribo_driver_message(drv));
        found->amplitude = 0.5 * (most - least);
        for (size_t i = 0; i < CONTACTS; i++) {
            found->power += energy[i] / period;
        }
    }
}

/* Shooting: setting is the tolerance of "event". */
static void run_shooting(void *data)
{
    struct pass *p = data;
    const struct study *s = p->study;
    tribo_driver *drv = open_driver(p, 1.0, p->setting);
    double y[STATE] = {0.0};
    p->error = 0.0;
    for (size_t i = 0; i < POINTS; i++) {
        const double period = 2.0 * PI / omega_of(s, i);
        struct steady found;
        set_point(s, i);
        memset(y, 0, i % LIMITS ? 0 : sizeof y);
        const int status = tribo_driver_find_periodic(drv, 0.0, period, y);
        measure_period(s, status ? NULL : drv, period, &found);
        p->error = fmax(p->error, error_of(s, i, &found));
    }
    need(tribo_driver_count(drv, TRIBO_COUNT_PERIODS, &p->work), NULL);
    tribo_driver_destroy(drv);
}

/* The amplitude of the period that begins with y. */
static double marched_amplitude(const struct study *s, tribo_driver *drv, double period, size_t samples, const double *y)
{
    double copy[STATE];
    memcpy(copy, y, sizeof copy);
    return amplitude_from(s, drv, period, samples, copy);
}

/* Marches as a user does, who does not know where to: until amplitude and power of a cycle are within half of the aim of what
 * they were when half as many cycles had passed. Returns the error: HUGE_VAL where steps are too long to be stable. */
static double march(struct pass *p, tribo_driver *drv, size_t point, double period, double *y)
{
    const struct study *s = p->study;
    struct steady before = {HUGE_VAL, HUGE_VAL}, found;
    for (size_t cycle = 1, check = FIRST_CHECK; cycle <= MOST_CYCLES; cycle++, p->work++) {
        double t = 0.0;
        y[2 * MODES] = 0.0;
        if (tribo_driver_advance(drv, &t, period, y)) {
            return HUGE_VAL;
        }
        if (cycle == check) {
            found.power = y[2 * MODES] / period;
            found.amplitude = marched_amplitude(s, drv, period, (size_t)p->setting, y);
            if (difference(s, point, &found, &before) <= 0.5 * p->aim) {
                return error_of(s, point, &found);
            }
            before = found;
            check *= 2;
        }
    }
    return HUGE_VAL;
}

/* Marching: setting is the number of steps a period. A pass that diverges ends at once. */
static void run_marching(void *data)
{
    struct pass *p = data;
    const struct study *s = p->study;
    double y[STATE] = {0.0};
    p->error = 0.0;
    p->work = 0;
    for (size_t i = 0; i < POINTS && p->error < HUGE_VAL; i++) {
        const double period = 2.0 * PI / omega_of(s, i), dt = period / p->setting;
        set_point(s, i);
        need(tribo_set_epsilon_step(tribo_system_context(s->sys), dt, 1.0), NULL);
        tribo_driver *drv = open_driver(p, dt, 0.0);
        p->error = fmax(p->error, march(p, drv, i, period, y));
        tribo_driver_destroy(drv);
    }
}

/* Harmonic balance: method is the highest harmonic, setting epsilon. */
static void run_balance(void *data)
{
    struct pass *p = data;
    const struct study *s = p->study;
    struct harmonic_balance *b = balance_create(&s->model, (size_t)atoi(p->method));
    p->error = 0.0;
    p->work = 0;
    for (size_t i = 0; i < POINTS; i++) {
        struct steady found;
        const size_t steps = balance_solve(b, omega_of(s, i), limit_of_point(s, i), p->setting, &found);
        p->work += steps;
        p->error = fmax(p->error, steps ? error_of(s, i, &found) : HUGE_VAL);
    }
    balance_free(b);
}

static const struct way {
    const char *name, *method;
    void (*run)(void *data);
    double setting[12]; /* the coarsest first */
} ways[] =
    {
        {"shooting on exact", "exact", run_shooting, {0.0}},
        {"shooting on event", "event", run_shooting, {1e-6, 1e-9}},
        {"marching, rk4, Quinn's law", "rk4/fixed", run_marching, {200, 400, 800, 1600, 3200, 6400, 12800, 25600}},
        {"marching, central", "central/fixed", run_marching, {200, 400, 800, 1600, 3200, 6400, 12800, 25600}},
},
  balances[] = {
      {"harmonic balance, 15", "15", run_balance, {1e-2, 1e-3, 1e-4, 1e-5}},
      {"harmonic balance, 63", "63", run_balance, {1e-2, 1e-3, 1e-4, 1e-5}},
      {"harmonic balance, 127", "127", run_balance, {1e-2, 1e-3, 1e-4, 1e-5}},
};
enum { WAYS = sizeof ways / sizeof *ways, BALANCES = sizeof balances / sizeof *balances };

/* --------------------------------------------------------------------------------------------------------------- scene */

static void create_study(struct study *s)
{
    double unit[MODES * MODES] = {0.0}, stiffness[MODES * MODES] = {0.0}, damping[MODES * MODES] = {0.0};
    char message[200] = "";
    tribo_system_destroy(beam_create(&s->model));
    for (size_t k = 0; k < MODES; k++) {
        unit[k * MODES + k] = 1.0;
        stiffness[k * MODES + k] = s->model.beam.stiffness[k];
        damping[k * MODES + k] = s->model.beam.damping[k];
    }
    need(dense_system(&s->sys, MODES, CONTACTS, unit, damping, stiffness, s->model.beam.j[0], 0, message, sizeof message),
         message);
}

/* The reference, by marching "exact" from the motion that shooting has found: one more period, which must bring it back. */
static void find_reference(struct study *s)
{
    struct pass p = {.study = s, .method = "exact"};
    tribo_driver *drv = open_driver(&p, 1.0, 0.0);
    double y[STATE] = {0.0};
    for (size_t i = 0; i < POINTS; i++) {
        const double period = 2.0 * PI / omega_of(s, i);
        set_point(s, i);
        need(tribo_driver_find_periodic(drv, 0.0, period, y), tribo_driver_message(drv));
        s->reference[i].amplitude = amplitude_from(s, drv, period, 40000, y);
        s->reference[i].power = y[2 * MODES] / period;
        struct steady *largest = &s->largest[i / LIMITS];
        largest->amplitude = fmax(largest->amplitude, s->reference[i].amplitude);
        largest->power = fmax(largest->power, s->reference[i].power);
        y[2 * MODES] = 0.0;
    }
    tribo_driver_destroy(drv);
}

/* --------------------------------------------------------------------------------------------------------------- tables */

/* A row; order: by which the result is extrapolated, or 0. */
static void report(FILE *table, const struct way *w, const struct pass *p, const struct timing *t, double order)
{
    const double point = 1e3 * t->seconds / POINTS, work = (double)p->work / POINTS;
    printf("%-28s %8.0e %9.1e %10.3g %11.3g %10.4g %8.1f", w->name, p->aim, p->error, p->setting, point, t->ratio, work);
    printf(order > 0.0 ? "  extrapolated, order %.2g\n" : "\n", order);
    fprintf(table, "%s,%g,%g,%g,%g,%g,%g,%g,%g,%g\n", w->name, p->aim, p->error, p->setting, point, t->ratio, t->low, t->high,
            work, order);
    fflush(stdout);
}

static void time_pass(FILE *table, const struct way *w, const struct pass *p, const struct job *job, const struct job *unit)
{
    const struct effort effort = {1, 15, 20.0};
    const struct timing t = time_job(job, unit, &effort);
    report(table, w, p, &t, 0.0);
}

/* What passes came to, beside the unit; and by what setting, and in which time, the last two of them would have it come to the
 * aim. */
static void extrapolate(FILE *table, const struct way *w, const struct pass *before, const struct pass *last, double seconds,
                        struct job *unit)
{
    struct timing t = {.seconds = seconds};
    const double order = log(before->error / last->error) / log(last->setting / before->setting);
    t.ratio = t.low = t.high = seconds / probe_job(unit);
    report(table, w, last, &t, 0.0);
    if (order > 0.1) {
        const double finer = pow(last->error / last->aim, 1.0 / order);
        struct pass p = *last;
        p.error = p.aim;
        p.setting *= finer;
        t.seconds *= finer;
        t.ratio *= finer;
        report(table, w, &p, &t, order);
    } else {
        printf("%-28s %8.0e  not by smaller steps: the error does not fall evenly\n", w->name, last->aim);
    }
}

/* The coarsest setting that reaches an error, timed beside shooting on "exact"; or what is reached within the budget. */
static void measure(const struct study *s, FILE *table, const struct way *w, double aim, struct job *unit)
{
    struct pass last = {.error = HUGE_VAL}, before = last;
    double seconds = 0.0;
    for (size_t k = 0; seconds < 0.5 * BUDGET && (k == 0 || w->setting[k] != 0.0); k++) {
        struct pass p = {.study = s, .method = w->method, .setting = w->setting[k], .aim = aim};
        struct job job = {w->run, &p, 0.0};
        seconds = probe_job(&job);
        if (p.error <= aim) {
            time_pass(table, w, &p, &job, unit);
            return;
        }
        before = last;
        last = p;
    }
    extrapolate(table, w, &before, &last, seconds, unit);
}

/* How near harmonic balance comes, over epsilon. */
static void measure_balance(const struct study *s, FILE *table, const struct way *w, const struct job *unit)
{
    for (size_t k = 0; w->setting[k] != 0.0; k++) {
        struct pass p = {.study = s, .method = w->method, .setting = w->setting[k]};
        struct job job = {w->run, &p, 0.0};
        probe_job(&job);
        time_pass(table, w, &p, &job, unit);
    }
}

static void run_bench(const struct study *s, const char *out)
{
    FILE *table = create_file(out, "periodic.csv");
    struct pass p = {.study = s, .method = "exact"};
    struct job unit = {run_shooting, &p, 0.0};
    probe_job(&unit);
    printf("%d steady motions of the beam (12 modes, 3 contacts): %d frequencies, %d limits\n", POINTS, FREQUENCIES, LIMITS);
    printf("%-28s %8s %9s %10s %11s %10s %8s\n", "", "aim", "error", "setting", "ms a point", "ratio", "work");
    fprintf(table, "method,aim,error,setting,ms a point,ratio,low,high,work a point,order\n");
    for (size_t k = 0; k < BALANCES; k++) {
        measure_balance(s, table, &balances[k], &unit);
    }
    for (size_t a = 0; a < WANTED; a++) {
        for (size_t k = 0; k < WAYS; k++) {
            measure(s, table, &ways[k], wanted[a], &unit);
        }
    }
    close_file(table, "periodic.csv");
}

/* Harmonic balance knows nothing of the library, and with many harmonics and a steep law comes to the same motions. */
static int agree(const struct study *s)
{
    struct pass p = {.study = s, .method = "63", .setting = 1e-4};
    run_balance(&p);
    printf("harmonic balance and shooting differ by %.1e\n", p.error);
    return p.error < 2e-3;
}

int main(int argc, char **argv)
{
    program = "bench_periodic";
    const char *out = ".";
    int smoke = 0;
    for (int i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "--smoke")) {
            smoke = 1;
        } else if (!strcmp(argv[i], "--out") && i + 1 < argc) {
            out = argv[++i];
        } else {
            fputs(help, strcmp(argv[i], "--help") ? stderr : stdout);
            return strcmp(argv[i], "--help") ? EXIT_FAILURE : EXIT_SUCCESS;
        }
    }
    struct study s = {.sys = NULL};
    create_study(&s);
    find_reference(&s);
    const int ok = agree(&s);
    if (!smoke) {
        run_bench(&s, out);
    }
    tribo_system_destroy(s.sys);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}
