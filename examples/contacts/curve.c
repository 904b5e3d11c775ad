/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves that turn back, stable and unstable parts: a mass that meets an elastic stop, over the frequency of the load; stick-slip
 * of a block on a belt, over the speed of the belt.
 *
 *     contact_curve FOLDER
 *
 * Writes FOLDER/curve-stop.csv, FOLDER/curve-belt.csv, FOLDER/curve-points.csv and FOLDER/values-curve.txt. */
#include <math.h>

#include "../../src/damper/output.h"
#include "tribo/tribo_dynamics.h"

/* The mass and its spring are 1; a load of amplitude 0.4 and frequency 0.6; a stop of stiffness 1.5 behind a gap of 1. */
static const double frequency = 0.6, load = 0.4, stop_damping = 0.1, stop = 1.5, gap = 1.0;

/* Limit 0.6, at rest 1, falling by the velocity 0.5; a belt of speed 1. */
static const double kinetic = 0.6, fall = 0.5, belt = 1.0, belt_damping = 0.115;

struct record {
    tribo_driver *drv;
    FILE *table, *points;
    int which, folds, stable; /* stable: of the last regular point */
    double fold[2], rest;
};

/* Writes the parameter, largest and smallest displacement, and whether the motion is stable; special points with their kind. */
static int note(const tribo_curve_point *point, void *data)
{
    struct record *r = data;
    const double c[] = {1.0, 0.0};
    double least, most;
    need(tribo_driver_period_extremes(r->drv, c, &least, &most, NULL, NULL), tribo_driver_message(r->drv));
    const int parts = point->kind == TRIBO_POINT_FOLD || point->kind == TRIBO_POINT_REST ? 2 : 1; /* that end or begin here */
    for (int k = 0; k < parts; k++) {
        const int stable = point->kind == TRIBO_POINT_REGULAR ? point->stable : k ? !r->stable : r->stable;
        fprintf(r->table, "%.12g,%.10g,%.10g,%d\n", point->parameter, most, least, stable);
    }
    r->stable = point->kind == TRIBO_POINT_REGULAR ? point->stable : r->stable;
    if (point->kind != TRIBO_POINT_REGULAR) {
        fprintf(r->points, "%d,%d,%.12g,%.10g\n", r->which, point->kind, point->parameter, most);
    }
    if (point->kind == TRIBO_POINT_FOLD && r->folds < 2) {
        r->fold[r->folds++] = point->parameter;
    }
    r->rest = point->kind == TRIBO_POINT_REST ? point->parameter : r->rest;
    return 0;
}

/* The mass with its stop, or the block on the belt. */
static tribo_system *create_system(int on_belt)
{
    const double one = 1.0, j[] = {1.0, 1.0}, ratio = 1.0 / kinetic;
    tribo_model *model;
    tribo_system *sys;
    need(tribo_model_create(&model, 1, on_belt ? 1 : 2), NULL);
    need(tribo_model_set_mass(model, &one), tribo_model_message(model));
    need(tribo_model_set_stiffness(model, &one), tribo_model_message(model));
    need(tribo_model_set_damping(model, on_belt ? &belt_damping : &stop_damping), tribo_model_message(model));
    need(tribo_model_set_direction(model, j), tribo_model_message(model));
    if (!on_belt) {
        need(tribo_model_set_normal(model, 0, 1, 0.0, stop, gap), tribo_model_message(model));
    }
    need(tribo_system_create(&sys, model), tribo_model_message(model));
    tribo_model_destroy(model);
    if (on_belt) {
        tribo_context *contact = tribo_system_context(sys);
        need(tribo_set_limit(contact, &kinetic), tribo_message(contact));
        need(tribo_set_static(contact, &ratio, &fall), tribo_message(contact));
        need(tribo_system_add_base_motion(sys, 0.0, &belt, NULL), tribo_system_message(sys));
    } else {
        need(tribo_system_add_load(sys, frequency, &load, NULL), tribo_system_message(sys));
    }
    return sys;
}

static void follow(const tribo_curve *curve, int on_belt, const char *folder, const char *name, struct record *r)
{
    double period = on_belt ? 0.0 : 2.0 * acos(-1.0) / frequency, y[3] = {0.0, on_belt ? belt : 0.0, 0.0};
    tribo_system *sys = create_system(on_belt);
    r->table = create_file(folder, name);
    r->which = on_belt;
    r->folds = 0;
    fprintf(r->table, "parameter,most,least,stable\n");
    need(tribo_driver_create(&r->drv, sys, "auto"), tribo_system_message(sys));
    need(tribo_driver_follow_curve(r->drv, curve, 0.0, &period, y, note, r), tribo_driver_message(r->drv));
    tribo_driver_destroy(r->drv);
    tribo_system_destroy(sys);
    close_file(r->table, name);
}

int main(int argc, char **argv)
{
    program = "contact_curve";
    if (argc != 2) {
        die("usage: contact_curve FOLDER");
    }
    const tribo_curve over_frequency = {
        .size = sizeof over_frequency, .parameter = TRIBO_PARAMETER_FREQUENCY, .least = 1.0, .most = 2.5, .step = 0.05};
    const tribo_curve over_speed = {.size = sizeof over_speed,
                                    .motion = TRIBO_MOTION_CYCLE,
                                    .parameter = TRIBO_PARAMETER_LOADS,
                                    .least = 0.1,
                                    .most = 2.0,
                                    .step = 0.05};
    struct record r = {.points = create_file(argv[1], "curve-points.csv")};
    FILE *values = create_file(argv[1], "values-curve.txt");
    fprintf(r.points, "which,kind,parameter,most\n");
    follow(&over_frequency, 0, argv[1], "curve-stop.csv", &r);
    printf("the resonance turns back at %.10f and %.10f of the first frequency", r.fold[0], r.fold[1]);
    write_value(values, r.fold[0], "curve.fold1");
    write_value(values, r.fold[1], "curve.fold2");
    follow(&over_speed, 1, argv[1], "curve-belt.csv", &r);
    printf("; stick-slip turns back at %.10f of the speed, and its unstable part ends at %.10f\n", r.fold[0], r.rest);
    write_value(values, r.fold[0], "curve.belt");
    write_value(values, r.rest, "curve.rest");
    write_value(values, fall * log((1.0 - kinetic) / (fall * belt_damping)), "curve.rest.formula");
    close_file(values, "values-curve.txt");
    close_file(r.points, "curve-points.csv");
    return 0;
}
