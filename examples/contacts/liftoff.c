/* SPDX-License-Identifier: BSD-3-Clause */
/* A driven block whose normal load swings so far that it lifts off for a part of each period: the limit opens and closes, and
 * friction with it.
 *
 *     contact_liftoff FOLDER
 *
 * Writes FOLDER/liftoff.csv (one steady period) and FOLDER/values-liftoff.txt. */
#include <math.h>

#include "../../src/damper/output.h"
#include "tribo/tribo_gsl.h"

/* Mass and stiffness are 1; the load is cos(omega t), and the limit 0.6 + sin(omega t) where that is positive. */
static const double omega = 0.35, drive = 1.0, limit = 0.6, swing = 1.0;

static tribo_system *create_system(void)
{
    const double one = 1.0, damping = 0.1;
    tribo_model *model;
    tribo_system *sys;
    need(tribo_model_create(&model, 1, 1), NULL);
    need(tribo_model_set_mass(model, &one), tribo_model_message(model));
    need(tribo_model_set_damping(model, &damping), tribo_model_message(model));
    need(tribo_model_set_stiffness(model, &one), tribo_model_message(model));
    need(tribo_model_set_direction(model, &one), tribo_model_message(model));
    need(tribo_system_create(&sys, model), tribo_model_message(model));
    tribo_model_destroy(model);
    tribo_context *contact = tribo_system_context(sys);
    need(tribo_set_limit(contact, &limit), tribo_message(contact));
    need(tribo_system_add_load(sys, omega, &drive, NULL), tribo_system_message(sys));
    need(tribo_system_add_limit(sys, omega, NULL, &swing), tribo_system_message(sys));
    return sys;
}

/* What friction takes in the period after 200 of them; dt > 0: in steps of dt. */
static double dissipation(tribo_system *sys, const char *method, double dt, FILE *table)
{
    const double period = 2.0 * acos(-1.0) / omega, begin = 200.0 * period;
    tribo_driver *drv;
    double t = 0.0, y[3] = {0.0, 0.0, 0.0};
    need(tribo_driver_create(&drv, sys, method), tribo_system_message(sys));
    if (dt > 0.0) {
        need(tribo_driver_set_step(drv, dt), tribo_driver_message(drv));
    }
    need(tribo_driver_advance(drv, &t, begin, y), tribo_driver_message(drv));
    y[2] = 0.0;
    for (int k = 1; k <= 800; k++) {
        double f, now;
        need(tribo_driver_advance(drv, &t, begin + period * k / 800.0, y), tribo_driver_message(drv));
        need(tribo_system_contacts(sys, t, y, NULL, NULL, &f), tribo_system_message(sys));
        need(tribo_system_get_limit(sys, t, &now), tribo_system_message(sys));
        if (table) {
            fprintf(table, "%.10g,%.10g,%.10g,%.10g,%.10g\n", k / 800.0, y[0], y[1], f, now);
        }
    }
    tribo_driver_destroy(drv);
    return y[2];
}

int main(int argc, char **argv)
{
    program = "contact_liftoff";
    if (argc != 2) {
        die("usage: contact_liftoff FOLDER");
    }
    FILE *table = create_file(argv[1], "liftoff.csv"), *values = create_file(argv[1], "values-liftoff.txt");
    tribo_system *sys = create_system();
    fprintf(table, "part of period,x,v,friction,limit\n");
    const double exact = dissipation(sys, "exact", 0.0, table), event = dissipation(sys, "event", 0.0, NULL);
    need(tribo_set_epsilon_step(tribo_system_context(sys), 1e-3, 1.0), NULL);
    const double rk4 = dissipation(sys, "rk4/fixed", 1e-3, NULL);
    printf("energy of a period: exact %.12f, event %.12f, rk4 with Quinn's law %.12f\n", exact, event, rk4);
    write_value(values, exact, "liftoff.exact");
    write_value(values, event, "liftoff.event");
    write_value(values, rk4, "liftoff.rk4");
    tribo_system_destroy(sys);
    close_file(table, "liftoff.csv");
    close_file(values, "values-liftoff.txt");
    return 0;
}
