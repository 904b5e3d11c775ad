/* SPDX-License-Identifier: BSD-3-Clause */
/* Three clutches between four shafts: the model CoupledClutches of the Modelica Standard Library and of the FMI cross-check.
 *
 *     clutches FOLDER
 *
 * Writes FOLDER/clutches.csv (speeds over time) and FOLDER/values-clutches.txt, and prints the events, and the speeds at the end
 * beside those that simulators have published (github.com/modelica/fmi-cross-check). */
#include <math.h>
#include <time.h>

#include "../../src/damper/output.h"
#include "tribo/tribo_dynamics.h"

enum { SHAFTS = 4, CLUTCHES = 3, DIMENSION = 2 * SHAFTS + 1 };
static const double pi = 3.14159265358979323846, last = 1.5;

/* Clutch 1 has the limit 10 max(0, cos 0.4 pi t); clutches 2 and 3 have the limit 10 from these times on. */
static const double engaged[CLUTCHES] = {0.0, 0.4, 0.9}, torque = 10.0;

/* Speeds at t = 1.5 in reference files of the cross-check. */
static const struct {
    const char *name;
    double speed[SHAFTS];
} published[] = {
    {"Dymola 2016", {3.2463737, 2.4628646, 2.4634151, 2.4639888}},
    {"CATIA R2016x", {3.2468, 2.46444, 2.46444, 2.46444}},
    {"SimulationX 3.7", {3.2449259, 2.4638701, 2.4638701, 2.4638701}},
    {"MWorks 2016", {3.2431638, 2.4579112, 2.4622088, 2.4733359}},
    {"MapleSim 2018", {2.9093519, 2.4888100, 2.5484640, 2.6847493}},
};

/* Inertias 1, torque 10 sin 10 pi t on the first shaft, static limit 1.1 times the kinetic one. */
static tribo_system *create_system(void)
{
    const double inertia[SHAFTS] = {1.0, 1.0, 1.0, 1.0}, stiffness[SHAFTS] = {0.0}, drive[SHAFTS] = {torque};
    const double swing[CLUTCHES] = {torque};
    const double relative[CLUTCHES][SHAFTS] = {{1.0, -1.0}, {0.0, 1.0, -1.0}, {0.0, 0.0, 1.0, -1.0}};
    const double ratio[CLUTCHES] = {1.1, 1.1, 1.1};
    tribo_model *model;
    tribo_system *sys;
    need(tribo_model_create(&model, SHAFTS, CLUTCHES), NULL);
    need(tribo_model_set_mass_diagonal(model, inertia), tribo_model_message(model));
    need(tribo_model_set_stiffness_diagonal(model, stiffness), tribo_model_message(model));
    need(tribo_model_set_direction(model, relative[0]), tribo_model_message(model));
    need(tribo_system_create(&sys, model), tribo_model_message(model));
    tribo_model_destroy(model);
    need(tribo_system_add_load(sys, 10.0 * pi, NULL, drive), tribo_system_message(sys));
    need(tribo_system_add_limit(sys, 0.4 * pi, swing, NULL), tribo_system_message(sys));
    need(tribo_set_static(tribo_system_context(sys), ratio, NULL), tribo_message(tribo_system_context(sys)));
    return sys;
}

/* Sets the limits of the clutches engaged at t; that of clutch 1 swings about 0. */
static void engage(tribo_system *sys, double t)
{
    double limit[CLUTCHES] = {0.0};
    for (int k = 1; k < CLUTCHES; k++) {
        limit[k] = t >= engaged[k] ? torque : 0.0;
    }
    need(tribo_set_limit(tribo_system_context(sys), limit), tribo_message(tribo_system_context(sys)));
}

static const char *const kinds[] = {"", "sticks", "breaks away", "reverses", "opens", "closes"};

struct events {
    FILE *values;
    int count;
};

/* data: struct events. */
static int print_event(const tribo_moment *moment, void *data)
{
    struct events *events = data;
    if (moment->kind != TRIBO_MOMENT_STEP) {
        printf("  %.12f  clutch %zu %s\n", moment->t, moment->contact + 1, kinds[moment->kind]);
        write_value(events->values, moment->t, "clutches.event%d", ++events->count);
    }
    return 0;
}

/* data: the table of speeds. */
static int write_speeds(const tribo_moment *moment, void *data)
{
    const double *speed = moment->y + SHAFTS;
    fprintf(data, "%.10g,%.10g,%.10g,%.10g,%.10g\n", moment->t, speed[0], speed[1], speed[2], speed[3]);
    return 0;
}

/* Moves the shafts to t = 1.5 by "exact"; output: time between moments, 0 for events alone. */
static void simulate(double *y, int (*seen)(const tribo_moment *moment, void *data), void *data, double output)
{
    const double stop[CLUTCHES] = {engaged[1], engaged[2], last};
    double t = 0.0;
    tribo_driver *drv;
    tribo_system *sys = create_system();
    need(tribo_driver_create(&drv, sys, "exact"), tribo_system_message(sys));
    need(tribo_driver_set_observer(drv, seen, data), tribo_driver_message(drv));
    if (output > 0.0) {
        need(tribo_driver_set_output(drv, output), tribo_driver_message(drv));
    }
    for (int k = 0; k < DIMENSION; k++) {
        y[k] = k == SHAFTS ? 10.0 : 0.0;
    }
    for (int k = 0; k < CLUTCHES; k++) {
        engage(sys, t);
        need(tribo_driver_advance(drv, &t, stop[k], y), tribo_driver_message(drv));
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

static void print_speeds(const char *name, const double *speed)
{
    printf("  %-16s %14.10f %14.10f %14.10f %14.10f\n", name, speed[0], speed[1], speed[2], speed[3]);
}

int main(int argc, char **argv)
{
    enum { RUNS = 200 };
    double y[DIMENSION];
    program = "clutches";
    if (argc != 2) {
        die("usage: clutches FOLDER");
    }
    FILE *table = create_file(argv[1], "clutches.csv"), *values = create_file(argv[1], "values-clutches.txt");
    fprintf(table, "t,w1,w2,w3,w4\n");
    simulate(y, write_speeds, table, 2e-3);
    printf("Events:\n");
    struct events events = {values, 0};
    simulate(y, print_event, &events, 0.0);
    const clock_t begin = clock();
    for (int k = 0; k < RUNS; k++) {
        simulate(y, NULL, NULL, 0.0);
    }
    printf("One run: %.0f us\nSpeeds at t = 1.5:\n", 1e6 * (double)(clock() - begin) / CLOCKS_PER_SEC / RUNS);
    for (size_t k = 0; k < sizeof published / sizeof *published; k++) {
        print_speeds(published[k].name, published[k].speed);
    }
    print_speeds("tribo, exact", y + SHAFTS);
    for (int k = 0; k < SHAFTS; k++) {
        write_value(values, y[SHAFTS + k], "clutches.w%d", k + 1);
    }
    close_file(table, "clutches.csv");
    close_file(values, "values-clutches.txt");
    return 0;
}
