/* SPDX-License-Identifier: BSD-3-Clause */
/* What a call of tribo_balance costs, against everything that it may depend on: one CSV file a picture, and tables. bench_balance
 * --help tells the options; run.sh draws the pictures. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../src/damper/output.h"
#include "contacts.h"
#include "couplings.h"
#include "harness.h"
#ifdef HAVE_CHOLMOD
#include "peer_cholmod.h"
#endif

static const char help[] = "bench_balance: what a call of tribo_balance costs.\n"
                           "\n"
                           "  --out FOLDER     where the tables go, which must exist; \".\"\n"
                           "  --quick          smaller scenes\n"
                           "  --smoke          no times: fails if forces or counts of small scenes are wrong, for ctest\n";

struct options {
    const char *out;
    int quick, smoke;
    struct effort effort;
};

/* -------------------------------------------------------------------------------------------------------------- the unit */

enum { UNIT = 1000 };

struct unit {
    double v[UNIT], a[UNIT], f[UNIT];
};

/* Quinn's law for 1000 contacts that share no body, in plain C. */
static void run_unit(void *data)
{
    struct unit *u = data;
    for (size_t i = 0; i < UNIT; i++) {
        const double feq = u->a[i] > 1.0 ? -1.0 : u->a[i] < -1.0 ? 1.0 : -u->a[i], x = feq - 2.0 * u->v[i];
        u->f[i] = x > 1.0 ? 1.0 : x < -1.0 ? -1.0 : x;
    }
    u->v[0] = u->f[UNIT - 1];
}

static struct job unit_job(void)
{
    static struct unit u;
    for (size_t i = 0; i < UNIT; i++) {
        u.v[i] = sin((double)i);
        u.a[i] = 2.0 * cos((double)i);
    }
    struct job job = {run_unit, &u, 0.0};
    for (int k = 0; k < 100; k++) {
        probe_job(&job);
    }
    return job;
}

/* -------------------------------------------------------------------------------------------------------------- curves */

enum picture { CONTACTS, NEAR, SLEEPING, SPARSE, PICTURES };
static const char *const picture_name[] = {"contacts", "near", "islands", "sparse"};

/* What x counts: contacts; or islands that sleep beside those awake, of which there are AWAKE or none. */
enum { AWAKE = 100 };

static const struct curve {
    enum picture picture;
    const char *name;
    enum coupled coupled;
    int awake; /* all, or of the sleeping islands AWAKE; or none */
    enum change change;
    size_t from, to, quick; /* x */
} curves[] = {
    {CONTACTS, "no two coupled", ALONE, 1, SAME, 10, 1000000, 100000},
    {CONTACTS, "no two coupled: sliding", ALONE, 0, SAME, 10, 1000000, 100000},
    {CONTACTS, "sliding islands of 8", ISLANDS, 0, SAME, 10, 1000000, 100000},
    {CONTACTS, "stuck islands of 8", ISLANDS, 1, SAME, 10, 100000, 10000},
    {CONTACTS, "one stuck dense group", DENSE, 1, SAME, 10, 1000, 300},
    {NEAR, "set unchanged", DENSE, 1, SAME, 10, 1500, 300},
    {NEAR, "one change", DENSE, 1, ONE, 10, 1500, 300},
    {NEAR, "half of the set changes", DENSE, 1, HALF, 10, 1500, 300},
    {NEAR, "operator set anew", DENSE, 1, ANEW, 10, 1500, 300},
    {SLEEPING, "100 islands awake", ISLANDS, 1, SAME, 100, 100000, 10000},
    {SLEEPING, "none awake", ISLANDS, 0, SAME, 100, 100000, 10000},
    {SPARSE, "chain: set unchanged", CHAIN, 1, SAME, 200, 100000, 10000},
    {SPARSE, "chain: one change", CHAIN, 1, ONE, 200, 100000, 10000},
    {SPARSE, "chain: half of the set changes", CHAIN, 1, HALF, 200, 100000, 10000},
    {SPARSE, "chain: 5% of the set changes", CHAIN, 1, SOME, 200, 100000, 10000},
    {SPARSE, "carpet: set unchanged", CARPET, 1, SAME, 200, 100000, 10000},
    {SPARSE, "carpet: one change", CARPET, 1, ONE, 200, 100000, 10000},
    {SPARSE, "carpet: half of the set changes", CARPET, 1, HALF, 200, 100000, 10000},
    {SPARSE, "carpet: 5% of the set changes", CARPET, 1, SOME, 200, 100000, 10000},
};
enum { CURVES = sizeof curves / sizeof *curves, POINTS = 32 };

/* Measured: times in units, and seconds. */
struct track {
    size_t points;
    double x[POINTS], ratio[POINTS], seconds[POINTS];
    struct counts last;
};

static void create_scene(struct contacts *s, const struct curve *c, size_t x)
{
    if (c->picture == SLEEPING) {
        const size_t islands = x + AWAKE;
        contacts_create(s, c->coupled, ISLAND * islands, c->awake ? islands / AWAKE : 0, c->change);
    } else {
        contacts_create(s, c->coupled, x, c->awake ? 1 : 0, c->change);
    }
}

/* 1, 2, 4 (or 3), 10 ... */
static size_t next_point(size_t x)
{
    size_t decade = 1;
    while (10 * decade <= x) {
        decade *= 10;
    }
    return x < 2 * decade ? 2 * decade : x < 5 * decade ? 5 * decade : 10 * decade;
}

static void measure(const struct options *o, FILE *file, const struct job *unit, const struct curve *c, struct track *track)
{
    const size_t to = o->quick ? c->quick : c->to;
    for (size_t x = c->from; x <= to && track->points < POINTS; x = next_point(x)) {
        struct contacts s;
        create_scene(&s, c, x);
        struct job job = {contacts_call, &s, 0.0};
        contacts_count(&s, 4); /* warm */
        probe_job(&job);
        const struct counts k = contacts_count(&s, 4);
        const struct timing t = time_job(&job, unit, &o->effort);
        fprintf(file, "%s,%zu,%zu,%.5g,%.5g,%.5g,%.5g,%zu,%g,%g,%g,%g,%g\n", c->name, x, s.n, t.seconds, t.ratio, t.low, t.high,
                t.repeats, k.solves, k.skipped, k.reused, k.factorizations, k.updates);
        fflush(file);
        track->x[track->points] = (double)x;
        track->seconds[track->points] = t.seconds;
        track->ratio[track->points++] = t.ratio;
        track->last = k;
        contacts_destroy(&s);
    }
}

/* Slope of log(time) over log(x), over the last decade. */
static double slope_of(const struct track *t)
{
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (size_t k = 0; k < t->points; k++) {
        if (t->x[k] >= 0.0999 * t->x[t->points - 1]) {
            const double p = log(t->x[k]), q = log(t->ratio[k]);
            n += 1.0;
            x += p;
            y += q;
            xx += p * p;
            xy += p * q;
        }
    }
    return (n * xy - x * y) / (n * xx - x * x);
}

static void measure_curves(const struct options *o, const struct job *unit, struct track *track)
{
    for (int picture = 0; picture < PICTURES; picture++) {
        char name[40];
        snprintf(name, sizeof name, "%s.csv", picture_name[picture]);
        FILE *file = create_file(o->out, name);
        fprintf(file,
                "curve,x,contacts,seconds,ratio,ratio low,ratio high,repeats,solves,skipped,reused,factorizations,updates\n");
        for (size_t k = 0; k < CURVES; k++) {
            if ((int)curves[k].picture == picture) {
                measure(o, file, unit, &curves[k], &track[k]);
            }
        }
        close_file(file, name);
    }
}

static const struct track *track_of(const struct track *track, const char *name)
{
    for (size_t k = 0; k < CURVES; k++) {
        if (strcmp(curves[k].name, name) == 0) {
            return &track[k];
        }
    }
    die("there is no curve %s", name);
    return NULL;
}

static void print_curves(const struct track *track)
{
    printf(
        "\n| picture | curve | largest | time there | in units | slope over the last decade | solves, updates, factorizations a "
        "call |\n|---|---|---|---|---|---|---|\n");
    for (size_t k = 0; k < CURVES; k++) {
        const struct track *t = &track[k];
        const size_t last = t->points - 1;
        printf("| %s | %s | %g | %.3g us | %.3g | %.2f | %g, %g, %g |\n", picture_name[curves[k].picture], curves[k].name,
               t->x[last], 1e6 * t->seconds[last], t->ratio[last], slope_of(t), t->last.solves, t->last.updates,
               t->last.factorizations);
    }
}

/* --------------------------------------------------------------------------------------- one in a hundred islands */

/* What no call can do without: v and a read, f written. */
static void run_touch(void *contacts)
{
    enum { SUMS = 4 };
    struct contacts *s = contacts;
    const double *restrict v = s->v[0], *restrict a = s->a[s->calls++ % 2];
    double *restrict f = s->f, sum[SUMS] = {0.0};
    for (size_t i = 0; i + SUMS <= s->n; i += SUMS) {
        for (size_t k = 0; k < SUMS; k++) {
            sum[k] += v[i + k] + a[i + k];
            f[i + k] = v[i + k];
        }
    }
    s->f[0] = sum[0] + sum[1] + (sum[2] + sum[3]);
}

/* The part of the time of a scene with all islands active that it takes if one in a hundred is, or none, or if the memory is only
 * touched. */
static double measure_part(const struct options *o, const char *name, size_t stride, enum change change, void (*run_job)(void *))
{
    const size_t n = o->quick ? 20000 : 100000;
    struct contacts few, all;
    contacts_create(&few, ISLANDS, n, stride, change);
    contacts_create(&all, ISLANDS, n, 1, change);
    struct job job = {run_job, &few, 0.0}, unit = {contacts_call, &all, 0.0};
    contacts_count(&few, 4);
    contacts_count(&all, 4);
    probe_job(&job);
    probe_job(&unit);
    const struct counts a = contacts_count(&few, 4), b = contacts_count(&all, 4);
    const struct effort effort = {5, 60, 2.0};
    const struct timing t = time_job(&job, &unit, &effort);
    printf("| %s | %g of %g | %.3g us | %.3g us | %.2f%% (%.2f to %.2f) |\n", name, run_job == contacts_call ? a.solves : 0.0,
           b.solves, 1e6 * t.seconds, 1e6 * t.seconds / t.ratio, 100.0 * t.ratio, 100.0 * t.low, 100.0 * t.high);
    contacts_destroy(&few);
    contacts_destroy(&all);
    return t.ratio;
}

/* --------------------------------------------------------------------------------------------------------- smoke */

static int complain(const char *curve, size_t x, const char *what, double got, double want)
{
    printf("%s, %zu: %s %g, not %g\n", curve, x, what, got, want);
    return 0;
}

/* Forces are a fixed point, and the work is what it should be. */
static int check(const struct curve *c, size_t x)
{
    struct contacts s;
    create_scene(&s, c, x);
    contacts_count(&s, 4);
    const struct counts k = contacts_count(&s, 4);
    const int coupled = c->coupled != ALONE;
    const double groups = !coupled || !c->awake    ? 0.0
                          : c->picture == SLEEPING ? (double)AWAKE
                          : c->coupled == ISLANDS  ? ceil((double)x / ISLAND)
                                                   : 1.0;
    const double updates = c->change == ONE ? 1.0 : c->change == HALF ? (double)(x / 2) : 0.0;
    int good = 1;
    if (c->change != ANEW && c->change != SOME) {
        const double factorizations = c->change == HALF ? groups : 0.0, reused = c->change == SAME ? groups : 0.0;
        good = k.solves == groups ? good : complain(c->name, x, "solves", k.solves, groups);
        good = k.reused == reused ? good : complain(c->name, x, "reused", k.reused, reused);
        good = k.updates == updates ? good : complain(c->name, x, "updates", k.updates, updates);
        good =
            k.factorizations == factorizations ? good : complain(c->name, x, "factorizations", k.factorizations, factorizations);
    }
    if (c->change == SOME) { /* too few for a new factor */
        good = k.factorizations == 0.0 ? good : complain(c->name, x, "factorizations", k.factorizations, 0.0);
    }
    for (int again = 0; again < 2; again++) {
        contacts_call(&s);
        /* rounding of n terms, which f gets from f_eq, and which R adds up over a dense group: R_ij/R_ii = 1/3 */
        const double rounding = c->coupled == DENSE ? (double)(x * x) * DBL_EPSILON / 3.0 : 0.0;
        const double error = contacts_error(&s), allowed = fmax(1e-13, rounding);
        good = error <= allowed ? good : complain(c->name, x, "error", error, allowed);
    }
    contacts_destroy(&s);
    return good;
}

static int smoke(void)
{
    const size_t x[] = {10, 64, 300, 900};
    int good = 1;
    for (size_t k = 0; k < CURVES; k++) {
        for (size_t j = 0; j < sizeof x / sizeof *x; j++) {
            /* islands awake are evenly spread, so that hundreds sleep */
            good = check(&curves[k], curves[k].picture == SLEEPING ? AWAKE * x[j] : x[j]) && good;
        }
    }
    return print_couplings(0) && good;
}

/* -------------------------------------------------------------------------------------------------------------- program */

static void print_wanted(const struct track *track, double part)
{
    const struct track *awake = track_of(track, "100 islands awake"), *look = track_of(track, "none awake");
    const size_t last = awake->points - 1;
    printf("\n| wanted | here |\n|---|---|\n");
    printf("| sliding scene O(n): slope 1 | %.2f |\n", slope_of(track_of(track, "sliding islands of 8")));
    printf("| diagonal scene O(n): slope 1 | %.2f |\n", slope_of(track_of(track, "no two coupled")));
    printf("| one change O(s^2): slope 2 | %.2f |\n", slope_of(track_of(track, "one change")));
    printf("| flat in sleeping islands: the same solves | %g solves and %g factorizations a call beside %g sleeping islands |\n",
           awake->last.solves, awake->last.factorizations, awake->x[last]);
    printf("| flat: the same time, but for a look at all contacts | %.3g us beside %g, %.3g us beside %g |\n",
           1e6 * (awake->seconds[0] - look->seconds[0]), awake->x[0], 1e6 * (awake->seconds[last] - look->seconds[last]),
           awake->x[last]);
    printf("| 1%% of the islands active: at most 3%% | %.2f%% |\n", 100.0 * part);
}

static void run(const struct options *o)
{
    static struct track track[CURVES];
    const struct job unit = unit_job();
    printf("The unit, Quinn's law for %d contacts in plain C, takes %.3g us.\n", UNIT, 1e6 * unit.about);
    measure_curves(o, &unit, track);
    print_curves(track);
    printf("\n| %s contacts in islands of 8 | solved | time | all active | part |\n|---|---|---|---|---|\n",
           o->quick ? "20,000" : "100,000");
    const double part = measure_part(o, "1% active", 100, SAME, contacts_call);
    measure_part(o, "1% active, half of each active island changes", 100, HALF, contacts_call);
    measure_part(o, "none active", 0, SAME, contacts_call);
    measure_part(o, "a loop that reads v and a and writes f", 0, SAME, run_touch);
#ifdef HAVE_CHOLMOD
    compare_cholmod(o->quick ? 2500 : 10000, &o->effort);
#endif
    print_couplings(1);
    print_wanted(track, part);
}

static struct options read_options(int argc, char **argv)
{
    struct options o = {.out = ".", .effort = {5, 25, 0.2}};
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--help") == 0) {
            fputs(help, stdout);
            exit(EXIT_SUCCESS);
        } else if (strcmp(argv[i], "--out") == 0 && i + 1 < argc) {
            o.out = argv[++i];
        } else if (strcmp(argv[i], "--quick") == 0) {
            o.quick = 1;
            o.effort = (struct effort){3, 5, 0.02};
        } else if (strcmp(argv[i], "--smoke") == 0) {
            o.smoke = 1;
        } else {
            die("option %s is not known, or lacks its value; see --help", argv[i]);
        }
    }
    return o;
}

int main(int argc, char **argv)
{
    program = "bench_balance";
    setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
    const struct options options = read_options(argc, argv);
    if (options.smoke) {
        return smoke() ? EXIT_SUCCESS : EXIT_FAILURE;
    }
    run(&options);
    return EXIT_SUCCESS;
}
