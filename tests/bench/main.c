/* Run time against error of methods for friction, on systems whose answer is known: one CSV file a system. bench --help tells the
 * options; run.sh draws the pictures and prints the tables. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../examples/common/output.h"
#include "harness.h"

static const char help[] = "bench: run time against error of methods for friction, on systems whose answer is known.\n"
                           "\n"
                           "  --out FOLDER     where the tables go, which must exist; \".\"\n"
                           "  --system NAME    only this one; may be given several times\n"
                           "  --method NAME    only methods whose package, name or law is NAME\n"
                           "  --quick          fewer settings and shorter runs\n"
                           "  --full           longer runs too\n"
                           "  --smoke          no times: checks what cheap settings answer, for ctest\n"
                           "  --list           names of systems and methods\n";

enum { MOST_CHOSEN = 32, PER_DECADE = 4 };

struct options {
    const char *out, *system[MOST_CHOSEN], *method[MOST_CHOSEN];
    size_t systems, methods;
    int smoke, list;
    size_t skip; /* of the settings all but each skip-th are left out */
    struct effort effort;
};

static const struct methods *const packages[] = {&plain_methods, &tribo_methods, &sundials_methods, &siconos_methods};

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

/* The k-th setting of a sweep, from coarse to fine; 0 after the last. */
static double setting_of(const struct method *m, const struct scene *s, size_t k)
{
    const double longest = m->stable > 0.0 ? m->stable / s->model.fastest : HUGE_VAL;
    switch (m->sweep) {
    case STEP:
        /* four to a factor of ten, scene.dt among them; beginning where the method is stable */
        for (int i = PER_DECADE;; i--) {
            const double dt = s->dt * pow(10.0, (double)i / PER_DECADE);
            if (dt <= longest * (1.0 + 1e-9)) {
                return k <= 4 * PER_DECADE ? dt * pow(10.0, -(double)k / PER_DECADE) : 0.0;
            }
        }
    case TOLERANCE:
        return k <= 11 ? pow(10.0, -2.0 - (double)k) : 0.0;
    default:
        return k == 0 ? 1.0 : 0.0;
    }
}

/* --------------------------------------------------------------------------------------------------------------- rows */

static void write_header(FILE *file)
{
    fprintf(file, "system,package,method,law,setting,error,seconds,ratio,ratio low,ratio high,repeats,evaluations,events,steps\n");
}

static void write_row(FILE *file, const struct scene *s, const struct method *m, double setting, double error,
                      const struct timing *t, const struct outcome *o)
{
    fprintf(file, "%s,%s,%s,%s,%.4g,%.4g,%.5g,%.4g,%.4g,%.4g,%zu,%zu,%zu,%zu\n", s->name, m->package, m->name, m->law,
            m->sweep == NO_SETTING ? (double)NAN : setting, error, t->seconds, t->ratio, t->low, t->high, t->repeats, o->evaluations,
            o->events, o->steps);
    fflush(file);
}

/* The method that the reference is from is judged by the other one. */
static double error_of(const struct scene *s, const struct method *m, const struct outcome *o)
{
    const int own = !s->printed && strcmp(m->name, "exact") == 0;
    return scene_error(s, o->answer, own ? s->second : s->reference);
}

/* All settings of a method, until a run takes too long. */
static void run_method(const struct options *options, FILE *file, const struct scene *s, const struct method *m)
{
    double setting, last = 0.0;
    for (size_t k = 0; (setting = setting_of(m, s, k)) > 0.0; k++) {
        if (k % options->skip && !(m->sweep == STEP && setting == s->dt)) {
            continue;
        }
        struct outcome o = {.failure = ""};
        const double begin = cpu_seconds();
        m->run(m, s, setting, &o);
        const double seconds = cpu_seconds() - begin;
        if (o.failure[0]) {
            printf("  %s %s, %s, setting %.3g failed: %s\n", m->package, m->name, m->law, setting, o.failure);
            if (last > 0.0 && seconds > options->effort.longest) {
                break;
            }
            continue;
        }
        struct effort effort = options->effort;
        if (seconds > effort.longest) {
            if (last > 0.0 || seconds > 20.0 * effort.longest) {
                printf("  %s %s, %s: from setting %.3g on more than %.2g s\n", m->package, m->name, m->law, setting, effort.longest);
                break;
            }
            effort.repeats = effort.most_repeats = 3;
        }
        last = seconds;
        const struct timing t = time_run(m, s, setting, seconds, &effort);
        write_row(file, s, m, setting, error_of(s, m, &o), &t, &o);
    }
}

/* ---------------------------------------------------------------------------------------------------------- references */

static const struct method *find_method(const char *name)
{
    for (size_t i = 0; i < tribo_methods.count; i++) {
        if (strcmp(tribo_methods.method[i].name, name) == 0) {
            return &tribo_methods.method[i];
        }
    }
    return NULL;
}

static void ask(const struct scene *s, const char *name, double setting, double *answer)
{
    const struct method *m = find_method(name);
    struct outcome o = {.failure = ""};
    m->run(m, s, setting, &o);
    if (o.failure[0]) {
        die("%s: no reference from method %s: %s", s->name, name, o.failure);
    }
    memcpy(answer, o.answer, s->answers * sizeof *answer);
}

/* Two independent methods must agree before one of them may judge. */
static void find_reference(struct scene *s)
{
    double exact[ANSWERS];
    ask(s, "exact", 1.0, exact);
    ask(s, "event", 1e-13, s->second);
    const double apart = scene_error(s, exact, s->second);
    printf("%s: exact and event at 1e-13 differ by %.1e", s->name, apart);
    if (!s->printed) {
        memcpy(s->reference, exact, sizeof exact);
    } else {
        printf("; exact and the printed value by %.1e", scene_error(s, exact, s->reference));
    }
    printf("\n");
    if (!(apart < 1e-9)) {
        die("%s: there is no reference", s->name);
    }
}

/* ------------------------------------------------------------------------------------------------------------- program */

static void run_scene(const struct options *options, struct scene *s)
{
    char name[40];
    snprintf(name, sizeof name, "%s.csv", s->name);
    find_reference(s);
    FILE *file = create_file(options->out, name);
    write_header(file);
    for (size_t p = 0; p < sizeof packages / sizeof *packages; p++) {
        for (size_t i = 0; i < packages[p]->count; i++) {
            const struct method *m = &packages[p]->method[i];
            if (is_chosen(options, m) && (!m->fits || m->fits(s))) {
                run_method(options, file, s, m);
            }
        }
    }
    close_file(file, name);
}

static void list(const struct scene *scene, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        printf("system  %s\n", scene[i].name);
    }
    for (size_t p = 0; p < sizeof packages / sizeof *packages; p++) {
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
    struct options o = {.out = ".", .skip = 1, .effort = {5, 0.4, 0.1, 15}};
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
            o.skip = 2;
            o.effort = (struct effort){5, 0.06, 0.2, 9};
        } else if (strcmp(argv[i], "--full") == 0) {
            o.effort.longest = 4.0;
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
    const struct options options = read_options(argc, argv);
    size_t count;
    struct scene *scene = systems_create(&count);
    if (options.list) {
        list(scene, count);
    }
    for (size_t i = 0; i < count && !options.list; i++) {
        if (chosen(options.system, options.systems, scene[i].name)) {
            run_scene(&options, &scene[i]);
        }
    }
    systems_destroy(scene, count);
    return 0;
}
