/* SPDX-License-Identifier: BSD-3-Clause */
/* Quinn (2004), Fig. 7 and 9: how the dissipation of one cycle converges as the time step shrinks, for one friction law.
 *
 *     paper_dissipation FOLDER CASE LAW
 *
 * CASE is fig7a or fig7b (oscillator that sticks, or never does), fig9 (chain of 32 blocks), or rod: a finer and slower chain,
 * close to a rod that is pulled quasi-statically.
 * As in the paper: classical Runge-Kutta method with fixed steps, epsilon in proportion to them. The steps divide a
 * cycle, h = T/ceil(T/dt), so that a cycle ends with a step. Writes FOLDER/CASE-LAW.csv and FOLDER/values-CASE-LAW.txt. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_fit.h>

#include "../../src/damper/output.h"
#include "tribo/tribo_gsl.h"

enum { MAX_STEPS = 11 };

struct test_case {
    const char *name;
    size_t blocks; /* of the chain; 0 for the oscillator */
    double alpha, omega;
    int cycle;            /* the one whose dissipation is taken */
    double epsilon;       /* in units of the step */
    int coarsest, finest; /* steps dt = 10^-(k/2), k = coarsest to finest */
    int finest_further;   /* the finest of laws that are not the paper's */
    double exact;         /* for epsilon -> 0: event-driven integration; 2 alpha^3/3 for the rod */
};

static const struct test_case cases[] = {
    {"fig7a", 0, 1.5, 0.5, 50, 2.0, 2, 10, 9, 7.18924625072},
    {"fig7b", 0, 2.0, 2.0, 50, 2.0, 2, 10, 10, 1.763834207376},
    {"fig9", 32, 0.25, 0.5, 4, 10.0 * 0.5, 3, 10, 9, 0.0104949600025},
    {"rod", 128, 0.25, 0.05, 4, 2.0, 5, 5, 5, 2.0 * 0.25 * 0.25 * 0.25 / 3.0},
};

static const struct test_case *find_case(const char *name)
{
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        if (strcmp(cases[i].name, name) == 0) {
            return &cases[i];
        }
    }
    die("there is no case \"%s\"; there are fig7a, fig7b, fig9 and rod", name);
    return NULL;
}

static tribo_system *create_system(const struct test_case *c)
{
    tribo_system *sys;
    need(c->blocks ? tribo_system_chain(&sys, c->blocks, 1.0, c->alpha, c->omega)
                   : tribo_system_oscillator(&sys, 1.0, c->alpha, c->omega),
         c->name);
    return sys;
}

/* Whether a cycle ends as it began, but for rounding: then it is what all later ones are. */
static int repeats(const double *y, const double *before, size_t dimension)
{
    for (size_t i = 0; i + 1 < dimension; i++) {
        if (fabs(y[i] - before[i]) > 1e-14) {
            return 0;
        }
    }
    return 1;
}

/* Dissipation over the case's cycle, from rest, in steps of h. */
static double dissipation(const struct test_case *c, int law, double period, double h)
{
    tribo_system *sys = create_system(c);
    tribo_context *contacts = tribo_system_context(sys);
    need(tribo_set_law(contacts, law), tribo_message(contacts));
    need(tribo_set_epsilon_all(contacts, c->epsilon * h), tribo_message(contacts));
    tribo_driver *drv;
    need(tribo_driver_create(&drv, sys, "rk4/fixed"), tribo_system_message(sys));
    need(tribo_driver_set_step(drv, h), tribo_driver_message(drv));

    const size_t dimension = tribo_system_dimension(sys);
    double *y = need_memory(2 * dimension, sizeof *y), *before = y + dimension, t = 0.0;
    for (int k = 1; k <= c->cycle && !(k > 1 && repeats(y, before, dimension)); k++) {
        memcpy(before, y, dimension * sizeof *y);
        need(tribo_driver_advance(drv, &t, k * period, y), tribo_driver_message(drv));
    }
    const double d = y[dimension - 1] - before[dimension - 1];
    free(y);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    return d;
}

/* Slope of log error over log h, up to h = 0.02 (beyond that no law has settled), where the error is well above rounding and
 * above the digits of the exact value. */
static double fitted_order(const double *h, const double *error, size_t n)
{
    double x[MAX_STEPS], y[MAX_STEPS], order, unused[5];
    size_t used = 0;
    for (size_t i = 0; i < n; i++) {
        if (h[i] < 0.02 && fabs(error[i]) > 1e-10) {
            x[used] = log(h[i]);
            y[used++] = log(fabs(error[i]));
        }
    }
    if (used < 2) {
        return 0.0;
    }
    gsl_fit_linear(x, 1, y, 1, used, &unused[0], &order, &unused[1], &unused[2], &unused[3], &unused[4]);
    return order;
}

/* All steps of the case; returns their number. The chain's begin smaller, since rk4 is not stable with dt = 0.1 there. */
static size_t run_steps(const struct test_case *c, int law, FILE *table, FILE *values, double *h, double *error)
{
    const double period = 2.0 * acos(-1.0) / c->omega;
    const int paper = law == TRIBO_COULOMB || law == TRIBO_VELOCITY_LIMITED || law == TRIBO_QUINN;
    const int finest = paper ? c->finest : c->finest_further;
    size_t n = 0;
    fprintf(table, "dt,D,relative error\n");
    for (int k = c->coarsest; k <= finest; k++, n++) {
        h[n] = period / ceil(period * pow(10.0, 0.5 * k));
        const double d = dissipation(c, law, period, h[n]);
        error[n] = d / c->exact - 1.0;
        fprintf(table, "%.10g,%.13g,%.6g\n", h[n], d, error[n]);
        fflush(table);
        write_value(values, d, "%s.%s.D%d", c->name, tribo_law_name(law), k);
        write_value(values, fabs(error[n]), "%s.%s.error%d", c->name, tribo_law_name(law), k);
    }
    return n;
}

int main(int argc, char **argv)
{
    program = "paper_dissipation";
    if (argc != 4) {
        die("usage: paper_dissipation FOLDER CASE LAW");
    }
    const struct test_case *c = find_case(argv[2]);
    int law;
    if (tribo_law_find(argv[3], &law)) {
        die("there is no law \"%s\"", argv[3]);
    }
    char name[100];
    snprintf(name, sizeof name, "%s-%s.csv", c->name, argv[3]);
    FILE *table = create_file(argv[1], name);
    snprintf(name, sizeof name, "values-%s-%s.txt", c->name, argv[3]);
    FILE *values = create_file(argv[1], name);

    double h[MAX_STEPS], error[MAX_STEPS];
    const size_t n = run_steps(c, law, table, values, h, error);
    const double order = fitted_order(h, error, n);
    write_value(values, order, "%s.%s.order", c->name, argv[3]);
    close_file(table, "the table");
    close_file(values, "the values");
    printf("%-5s %-16s relative error of D from %.1e at dt %.2g to %.1e at dt %.2g, order %.2f\n", c->name, argv[3],
           fabs(error[0]), h[0], fabs(error[n - 1]), h[n - 1], order);
    return 0;
}
