/* SPDX-License-Identifier: BSD-3-Clause */
/* Run time against error of methods for friction, on systems whose answer is known: one CSV file a system. bench --help tells the
 * options; run.sh draws the pictures and prints the tables. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../src/damper/output.h"
#include "harness.h"
#include "methods.h"

static const char help[] = "bench: run time against error of methods for friction, on systems whose answer is known.\n"
                           "\n"
                           "  --out FOLDER     where the tables go, which must exist; \".\"\n"
                           "  --system NAME    only this one; may be given several times\n"
                           "  --method NAME    only methods whose package, name or law is NAME; may be given several times\n"
                           "  --quick          fewer settings and shorter runs\n"
                           "  --smoke          no times: fails if cheap settings answer wrong, for ctest\n"
                           "  --list           names of systems and methods\n";

enum { MOST_CHOSEN = 32 };

struct options {
    const char *out, *system[MOST_CHOSEN], *method[MOST_CHOSEN];
    size_t systems, methods;
    int smoke, list;
    int per_decade;        /* settings of a sweep */
    double longest, units; /* seconds of a run, or units if that is more; slower settings are left out */
    struct effort effort;  /* of its timing */
};

static const struct methods *const packages[] = {
    &plain_methods,
    &tribo_methods,
#ifdef HAVE_SUNDIALS
    &sundials_methods,
#endif
#ifdef HAVE_SICONOS
    &siconos_methods,
#endif
};
enum { PACKAGES = sizeof packages / sizeof *packages };

/* ----------------------------------------------------------------------------------------------------------- settings */

static int chosen(const char *const *list, size_t count, const char *name)
{
    for (size_t i = 0; i < count; i++) {
        if (strcmp(list[i], name) == 0) {
            return 1;
        }
    }
    return count == 0;
}

static int is_chosen(const struct options *o, const struct method *m)
{
    return chosen(o->method, o->methods, m->name) || chosen(o->method, o->methods, m->package) ||
           chosen(o->method, o->methods, m->law);
}

/* The k-th setting of a sweep, from coarse to fine; 0 after the last. Steps begin where the method is stable, four decades
 * down, scene.dt among them. */
static double setting_of(const struct options *o, const struct method *m, const struct scene *s, int k)
{
    if (m->sweep == TOLERANCE) {
        const int exponent = -2 - (o->per_decade > 2 ? k : 2 * k);
        return exponent >= -13 ? pow(10.0, exponent) : 0.0;
    }
    if (m->sweep == NO_SETTING) {
        return k == 0 ? 1.0 : 0.0;
    }
    const double longest = m->stable > 0.0 ? m->stable / s->model.fastest : 10.0 * s->dt;
    const double first = floor(o->per_decade * log10(longest / s->dt) * (1.0 + 1e-9));
    return k <= 4 * o->per_decade ? s->dt * pow(10.0, (first - k) / o->per_decade) : 0.0;
}

/* --------------------------------------------------------------------------------------------------------------- runs */

struct run {
    const struct method *method;
    const struct scene *scene;
    double setting, deadline;
    struct outcome outcome;
};

static void run_once(void *data)
{
    struct run *r = data;
    r->outcome = (struct outcome){.deadline = r->deadline};
    r->method->run(r->method, r->scene, r->setting, &r->outcome);
}

/* The method that the reference is from is judged by the other one. */
static double error_of(const struct run *r)
{
    const struct scene *s = r->scene;
    const int own = !s->printed && strcmp(r->method->name, "exact") == 0;
    return scene_error(s, r->outcome.answer, own ? s->second : s->reference);
}

static void write_row(FILE *file, const struct run *r, const struct timing *t)
{
    const struct method *m = r->method;
    const struct outcome *o = &r->outcome;
    const double part = r->scene->unit_part;
    fprintf(file, "%s,%s,%s,%s,%.4g,%.4g,%.5g,%.4g,%.4g,%.4g,%zu,%zu,%zu,%zu\n", r->scene->name, m->package, m->name, m->law,
            m->sweep == NO_SETTING ? (double)NAN : r->setting, error_of(r), t->seconds, t->ratio / part, t->low / part,
            t->high / part, t->repeats, o->evaluations, o->events, o->steps);
    fflush(file);
}

/* All settings of a method, until a run takes too long; of long runs every other one, timed once. */
static void run_method(const struct options *options, FILE *file, const struct scene *s, const struct method *m,
                       const struct job *unit)
{
    const double longest = fmax(options->longest, options->units * unit->about);
    const double limit = longest * fmax(m->patience, 1.0);
    struct run r = {m, s, 0.0, 0.0, {.failure = ""}};
    struct job job = {run_once, &r, 0.0};
    for (int k = 0; (r.setting = setting_of(options, m, s, k)) > 0.0; k += job.about > longest ? 2 : 1) {
        r.deadline = cpu_seconds() + limit;
        if (probe_job(&job) > limit) {
            break;
        }
        r.deadline = 0.0;
        if (r.outcome.failure[0]) {
            printf("  %s %s, %s, setting %.3g: %s\n", m->package, m->name, m->law, r.setting, r.outcome.failure);
        } else {
            struct effort effort = options->effort;
            effort.least = job.about > options->longest ? 1 : effort.least;
            const struct timing t = time_job(&job, unit, &effort);
            write_row(file, &r, &t);
        }
    }
}

/* ---------------------------------------------------------------------------------------------------------- references */

static const struct method *find_method(const char *package, const char *name, const char *law)
{
    for (size_t p = 0; p < PACKAGES; p++) {
        for (size_t i = 0; i < packages[p]->count; i++) {
            const struct method *m = &packages[p]->method[i];
            if (strcmp(m->package, package) == 0 && strcmp(m->name, name) == 0 && strcmp(m->law, law) == 0) {
                return m;
            }
        }
    }
    return NULL;
}

static void ask(const struct scene *s, const char *name, double setting, double *answer)
{
    struct run r = {find_method("tribo", name, "coulomb"), s, setting, 0.0, {.failure = ""}};
    run_once(&r);
    if (r.outcome.failure[0]) {
        die("%s: no reference from method %s: %s", s->name, name, r.outcome.failure);
    }
    memcpy(answer, r.outcome.answer, s->answers * sizeof *answer);
}

/* Two independent methods, or one and the printed value, must agree before one of them may judge. */
static void find_reference(struct scene *s)
{
    ask(s, "event", 1e-13, s->second);
    if (!s->printed) {
        ask(s, "exact", 1.0, s->reference);
    }
    const double apart = scene_error(s, s->second, s->reference);
    printf("%s: %s and event at 1e-13 differ by %.1e\n", s->name, s->printed ? "the printed value" : "exact", apart);
    if (!(apart < 1e-10)) {
        die("%s: there is no reference", s->name);
    }
}

/* ------------------------------------------------------------------------------------------------------------- program */

static void run_scene(const struct options *options, const struct scene *s)
{
    char name[40];
    snprintf(name, sizeof name, "%s.csv", s->name);
    FILE *file = create_file(options->out, name);
    fprintf(file,
            "system,package,method,law,setting,error,seconds,ratio,ratio low,ratio high,repeats,evaluations,events,steps\n");
    struct run r = {unit_method, s, s->dt, 0.0, {.failure = ""}};
    struct job unit = {run_once, &r, 0.0};
    probe_job(&unit);
    for (size_t p = 0; p < PACKAGES; p++) {
        for (size_t i = 0; i < packages[p]->count; i++) {
            const struct method *m = &packages[p]->method[i];
            if (is_chosen(options, m) && (!m->fits || m->fits(s))) {
                run_method(options, file, s, m, &unit);
            }
        }
    }
    close_file(file, name);
}

/* What cheap settings are known to reach, at most half as much again is right. Those of rk4 and of the velocity-limited law were
 * measured by other codes too, the rest here. */
static const struct {
    const char *system, *package, *name, *law;
    double setting, error;
} known[] = {
    {"oscillator-7a", "plain", "rk4", "quinn", 0.01, 1.2e-5},
    {"oscillator-7a", "plain", "moreau", "coulomb", 0.1, 1.4e-4},
    {"oscillator-7a", "tribo", "rk4/fixed", "quinn", 0.01, 1.2e-5},
    {"oscillator-7a", "tribo", "rk4/fixed", "velocity-limited", 0.01, 1.2e-2},
    {"oscillator-7a", "tribo", "central/fixed", "coulomb", 0.01, 5.0e-6},
    {"oscillator-7a", "tribo", "moreau/fixed", "coulomb", 0.01, 5.7e-6},
    {"oscillator-7a", "tribo", "event", "coulomb", 1e-9, 2e-11},
    {"oscillator-7a", "tribo", "exact", "coulomb", 1.0, 1e-12},
    {"oscillator-7a", "sundials", "cvode-adams", "coulomb", 1e-6, 5.2e-6},
    {"oscillator-7a", "sundials", "arkode-5", "coulomb", 1e-6, 7.2e-7},
    {"oscillator-7a", "siconos", "moreau-jean", "coulomb", 0.1, 1.7e-4},
    {"oscillator-7b", "tribo", "rk4/fixed", "quinn-reversal", 0.01, 3.8e-5},
    {"oscillator-7b", "tribo", "exact", "coulomb", 1.0, 1e-12},
    {"belt", "plain", "rk4", "quinn", 0.01, 1.5e-5},
    {"belt", "plain", "moreau", "coulomb", 0.01, 2.6e-5},
    {"belt", "tribo", "rk4/fixed", "quinn", 0.01, 1.5e-5},
    {"belt", "tribo", "exact", "coulomb", 1.0, 1e-12},
    {"chain-32", "plain", "rk4", "quinn", 0.01, 1.1e-4},
    {"chain-32", "tribo", "central/fixed", "coulomb", 0.01, 8.2e-4},
    {"chain-32", "tribo", "event", "coulomb", 1e-9, 1e-11},
    {"chain-32", "tribo", "exact", "coulomb", 1.0, 4e-12},
};

/* Whether a scene's methods answer as they are known to. */
static int smoke(const struct scene *s)
{
    int good = 1;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const struct method *m = find_method(known[i].package, known[i].name, known[i].law);
        if (m && strcmp(known[i].system, s->name) == 0) {
            struct run r = {m, s, known[i].setting, 0.0, {.failure = ""}};
            run_once(&r);
            const double error = error_of(&r);
            const int holds = !r.outcome.failure[0] && error <= 1.5 * known[i].error;
            printf("  %s %s, %s, setting %g: error %.1e, known %.1e%s%s%s\n", m->package, m->name, m->law, r.setting, error,
                   known[i].error, holds ? "" : " WRONG", r.outcome.failure[0] ? ": " : "", r.outcome.failure);
            good = good && holds;
        }
    }
    return good;
}

static void list(const struct scene *scene, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        printf("system  %s\n", scene[i].name);
    }
    for (size_t p = 0; p < PACKAGES; p++) {
        for (size_t i = 0; i < packages[p]->count; i++) {
            const struct method *m = &packages[p]->method[i];
            printf("method  %s %s, %s\n", m->package, m->name, m->law);
        }
    }
}

static const char *value_of(int argc, char **argv, int *i)
{
    if (*i + 1 == argc) {
        die("option %s needs a value; see --help", argv[*i]);
    }
    return argv[++*i];
}

static struct options read_options(int argc, char **argv)
{
    struct options o = {.out = ".", .per_decade = 3, .longest = 0.15, .units = 4.0, .effort = {3, 15, 0.03}};
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--help") == 0) {
            fputs(help, stdout);
            exit(EXIT_SUCCESS);
        } else if (strcmp(argv[i], "--out") == 0) {
            o.out = value_of(argc, argv, &i);
        } else if (strcmp(argv[i], "--system") == 0 && o.systems < MOST_CHOSEN) {
            o.system[o.systems++] = value_of(argc, argv, &i);
        } else if (strcmp(argv[i], "--method") == 0 && o.methods < MOST_CHOSEN) {
            o.method[o.methods++] = value_of(argc, argv, &i);
        } else if (strcmp(argv[i], "--quick") == 0) {
            o.per_decade = 2;
            o.longest = 0.015;
            o.units = 1.5;
            o.effort = (struct effort){2, 2, 0.0};
        } else if (strcmp(argv[i], "--smoke") == 0) {
            o.smoke = 1;
        } else if (strcmp(argv[i], "--list") == 0) {
            o.list = 1;
        } else {
            die("option %s is not known, or given too often; see --help", argv[i]);
        }
    }
    return o;
}

int main(int argc, char **argv)
{
    program = "bench";
    setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
    const struct options options = read_options(argc, argv);
    size_t count;
    int good = 1;
    struct scene *scene = systems_create(&count);
    if (options.list) {
        list(scene, count);
    }
    for (size_t i = 0; i < count && !options.list; i++) {
        if (chosen(options.system, options.systems, scene[i].name)) {
            find_reference(&scene[i]);
            if (options.smoke) {
                good = smoke(&scene[i]) && good;
            } else {
                run_scene(&options, &scene[i]);
            }
        }
    }
    systems_destroy(scene, count);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
