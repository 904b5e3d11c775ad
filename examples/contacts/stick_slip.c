/* SPDX-License-Identifier: BSD-3-Clause */
/* A block on a belt, held by a spring: static friction is above kinetic, so that it sticks, breaks away and sticks again for
 * ever, as brakes, bows and faults do.
 *
 *     contact_stick_slip FOLDER
 *
 * Writes FOLDER/stick-slip.csv and FOLDER/values-stick-slip.txt. */
#include <math.h>

#include "../../src/damper/output.h"
#include "tribo/tribo_gsl.h"

/* Mass, stiffness and static limit are 1. */
static const double kinetic = 0.6, belt = 0.2;

/* When the block broke away and stuck, the last two times of each. */
struct events {
    double breaks[2], sticks[2];
};

static int note_event(const tribo_moment *moment, void *data)
{
    struct events *e = data;
    double *last = moment->kind == TRIBO_MOMENT_STICK ? e->sticks : e->breaks;
    if (moment->kind != TRIBO_MOMENT_STEP) {
        last[0] = last[1];
        last[1] = moment->t;
    }
    return 0;
}

static tribo_system *create_system(void)
{
    const double one = 1.0, ratio = 1.0 / kinetic;
    tribo_model *model;
    tribo_system *sys;
    need(tribo_model_create(&model, 1, 1), NULL);
    need(tribo_model_set_mass(model, &one), tribo_model_message(model));
    need(tribo_model_set_stiffness(model, &one), tribo_model_message(model));
    need(tribo_model_set_direction(model, &one), tribo_model_message(model));
    need(tribo_system_create(&sys, model), tribo_model_message(model));
    tribo_model_destroy(model);
    tribo_context *contact = tribo_system_context(sys);
    need(tribo_set_limit(contact, &kinetic), tribo_message(contact));
    need(tribo_set_static(contact, &ratio, NULL), tribo_message(contact));
    need(tribo_system_add_base_motion(sys, 0.0, &belt, NULL), tribo_system_message(sys));
    return sys;
}

int main(int argc, char **argv)
{
    program = "contact_stick_slip";
    if (argc != 2) {
        die("usage: contact_stick_slip FOLDER");
    }
    FILE *table = create_file(argv[1], "stick-slip.csv"), *values = create_file(argv[1], "values-stick-slip.txt");
    tribo_system *sys = create_system();
    tribo_driver *drv;
    struct events e = {{0.0, 0.0}, {0.0, 0.0}};
    double t = 0.0, y[3] = {0.0, 0.0, 0.0}, least = 1.0, most = -1.0;
    need(tribo_driver_create(&drv, sys, "exact"), tribo_system_message(sys));
    need(tribo_driver_set_observer(drv, note_event, &e), tribo_driver_message(drv));
    fprintf(table, "t,x,v,friction\n");
    for (int k = 0; k <= 3500; k++) {
        double f;
        need(tribo_driver_advance(drv, &t, 0.01 * k, y), tribo_driver_message(drv));
        need(tribo_system_contacts(sys, t, y, NULL, NULL, &f), tribo_system_message(sys));
        fprintf(table, "%.10g,%.10g,%.10g,%.10g\n", t, y[0], y[1], f);
        least = t > 20.0 ? fmin(least, y[0]) : least;
        most = t > 20.0 ? fmax(most, y[0]) : most;
    }
    const double pi = acos(-1.0), drop = 1.0 - kinetic, period = e.breaks[1] - e.breaks[0];
    const double slip = e.sticks[1] > e.breaks[1] ? e.sticks[1] - e.breaks[1] : e.sticks[1] - e.breaks[0];
    printf("period %.10f, of which %.10f slipping\n", period, slip);
    write_value(values, period, "stick-slip.period");
    write_value(values, 2.0 * drop / belt + 2.0 * (pi - atan(drop / belt)), "stick-slip.period.formula");
    write_value(values, slip, "stick-slip.slip");
    write_value(values, 2.0 * (pi - atan(drop / belt)), "stick-slip.slip.formula");
    write_value(values, 0.5 * (most - least), "stick-slip.amplitude");
    write_value(values, hypot(drop, belt), "stick-slip.amplitude.formula");
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    close_file(table, "stick-slip.csv");
    close_file(values, "values-stick-slip.txt");
    return 0;
}
