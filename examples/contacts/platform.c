/* SPDX-License-Identifier: BSD-3-Clause */
/* A blade between two platform dampers: contacts on both sides, pressed by a preload, with stiffness in tangential and normal
 * direction. The motion of the blade changes both normal loads, and lifts the contacts off in turn.
 *
 *     contact_platform FOLDER
 *
 * Writes FOLDER/platform.csv (steady motions over the frequency, for three preloads) and FOLDER/values-platform.txt. */
#include <math.h>

#include "../../src/damper/output.h"
#include "tribo/tribo_dynamics.h"

/* Blade: mass 1, stiffness and damping in x (along the platforms) and y (across); load amplitudes in phase. Contacts: stiffness
 * in x and y, coefficient of friction. */
static const double stiffness[2] = {12.0, 21.0}, damping[2] = {0.1, 0.1}, force[2] = {3.0, 6.0}, tangential = 5.0, normal = 10.0,
                    mu = 0.5;
static const double pi = 3.14159265358979323846;
enum { DOF = 2, CONTACTS = 4, DIMENSION = 2 * DOF + CONTACTS + 1 }; /* contacts 0, 1: friction; 2, 3: their normals */

/* At rest both contacts carry the preload: their gap is negative. */
static tribo_system *create_system(double preload, double omega)
{
    const double mass[DOF] = {1.0, 1.0}, compliance[CONTACTS] = {1.0 / tangential, 1.0 / tangential};
    const double direction[CONTACTS][DOF] = {{1.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}};
    tribo_model *model;
    tribo_system *sys;
    need(tribo_model_create(&model, DOF, CONTACTS), NULL);
    need(tribo_model_set_mass_diagonal(model, mass), tribo_model_message(model));
    need(tribo_model_set_damping_diagonal(model, damping), tribo_model_message(model));
    need(tribo_model_set_stiffness_diagonal(model, stiffness), tribo_model_message(model));
    need(tribo_model_set_direction(model, direction[0]), tribo_model_message(model));
    need(tribo_model_set_compliance(model, compliance), tribo_model_message(model));
    for (size_t k = 0; k < 2; k++) {
        need(tribo_model_set_normal(model, k, 2 + k, mu, normal, -preload / normal), tribo_model_message(model));
    }
    need(tribo_system_create(&sys, model), tribo_model_message(model));
    tribo_model_destroy(model);
    need(tribo_system_add_load(sys, omega, force, NULL), tribo_system_message(sys));
    return sys;
}

/* Times for which contacts are open in a period. */
struct open {
    double since[2], length;
    int is[2];
};

static void add_open(struct open *open, size_t k, double t)
{
    open->length += open->is[k] ? t - open->since[k] : 0.0;
    open->since[k] = t;
}

static int see(const tribo_moment *moment, void *data)
{
    struct open *open = data;
    if (moment->kind == TRIBO_MOMENT_LIFT || moment->kind == TRIBO_MOMENT_TOUCH) {
        add_open(open, moment->contact, moment->t);
        open->is[moment->contact] = moment->kind == TRIBO_MOMENT_LIFT;
    }
    return 0;
}

/* One steady motion from the guess y: amplitudes along x and y, energy of a period, share of the period in which a contact is
 * open. */
static int find_motion(double preload, double omega, double *y, double *amplitude, double *energy, double *share)
{
    const double period = 2.0 * pi / omega;
    tribo_system *sys = create_system(preload, omega);
    tribo_driver *drv;
    struct open open = {{0.0, 0.0}, 0.0, {0, 0}};
    need(tribo_driver_create(&drv, sys, "event"), tribo_system_message(sys));
    const int status = tribo_driver_find_periodic(drv, 0.0, period, y);
    for (size_t k = 0; !status && k < DOF; k++) {
        double c[2 * DOF] = {0.0}, least, most;
        c[k] = 1.0;
        need(tribo_driver_period_extremes(drv, c, &least, &most, NULL, NULL), tribo_driver_message(drv));
        amplitude[k] = 0.5 * (most - least);
    }
    if (!status) {
        double t = 0.0, state[DIMENSION];
        double energies[CONTACTS];
        need(tribo_driver_period_dissipation(drv, energies), tribo_driver_message(drv));
        *energy = energies[0] + energies[1];
        for (size_t k = 0; k < DIMENSION; k++) {
            state[k] = y[k];
        }
        for (size_t k = 0; k < 2; k++) {
            open.is[k] = preload + (k ? -1.0 : 1.0) * normal * y[1] <= 0.0;
        }
        need(tribo_driver_set_observer(drv, see, &open), tribo_driver_message(drv));
        need(tribo_driver_advance(drv, &t, period, state), tribo_driver_message(drv));
        add_open(&open, 0, period);
        add_open(&open, 1, period);
        *share = 0.5 * open.length / period;
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    return status;
}

/* The amplitude along the platforms by method moreau: 4000 steps a period, after 200 periods. */
static double march(double preload, double omega)
{
    const double period = 2.0 * pi / omega, begin = 200.0 * period;
    double t = 0.0, y[DIMENSION] = {0.0}, least = HUGE_VAL, most = -HUGE_VAL;
    tribo_system *sys = create_system(preload, omega);
    tribo_driver *drv;
    need(tribo_driver_create(&drv, sys, "moreau/fixed"), tribo_system_message(sys));
    need(tribo_driver_set_step(drv, period / 4000.0), tribo_driver_message(drv));
    need(tribo_driver_advance(drv, &t, begin, y), tribo_driver_message(drv));
    for (int k = 1; k <= 1000; k++) {
        need(tribo_driver_advance(drv, &t, begin + period * k / 1000.0, y), tribo_driver_message(drv));
        least = fmin(least, y[0]);
        most = fmax(most, y[0]);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    return 0.5 * (most - least);
}

int main(int argc, char **argv)
{
    static const double preload[] = {2.0, 8.0, 32.0};
    program = "contact_platform";
    if (argc != 2) {
        die("usage: contact_platform FOLDER");
    }
    FILE *table = create_file(argv[1], "platform.csv"), *values = create_file(argv[1], "values-platform.txt");
    fprintf(table, "omega");
    for (size_t k = 0; k < 3; k++) {
        fprintf(table, ",x %g,y %g,energy %g,open %g", preload[k], preload[k], preload[k], preload[k]);
    }
    fprintf(table, "\n");
    double y[3][DIMENSION] = {{0.0}}, largest[3] = {0.0}, at[3] = {0.0}, open[3] = {0.0};
    int missing = 0;
    for (int step = 0; step <= 200; step++) {
        const double omega = 2.0 + 0.03 * step;
        fprintf(table, "%.10g", omega);
        for (size_t k = 0; k < 3; k++) {
            double amplitude[DOF], energy, share;
            if (find_motion(preload[k], omega, y[k], amplitude, &energy, &share)) {
                missing++;
                fprintf(table, ",nan,nan,nan,nan");
                continue;
            }
            fprintf(table, ",%.10g,%.10g,%.10g,%.10g", amplitude[0], amplitude[1], energy, share);
            at[k] = amplitude[0] > largest[k] ? omega : at[k];
            largest[k] = fmax(largest[k], amplitude[0]);
            open[k] = fmax(open[k], share);
        }
        fprintf(table, "\n");
    }
    for (size_t k = 0; k < 3; k++) {
        printf("preload %4g: largest amplitude along the platforms %.4f, contacts open for up to %.1f%% of the period\n",
               preload[k], largest[k], 100.0 * open[k]);
        write_value(values, largest[k], "platform.amplitude%zu", k + 1);
        write_value(values, open[k], "platform.open%zu", k + 1);
    }
    write_value(values, march(preload[1], at[1]), "platform.amplitude2.moreau");
    write_value(values, missing, "platform.missing");
    close_file(table, "platform.csv");
    close_file(values, "values-platform.txt");
    return 0;
}
