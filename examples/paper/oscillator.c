/* SPDX-License-Identifier: BSD-3-Clause */
/* Quinn (2004), Fig. 5 and 6: a mass on a spring slides, comes to rest where the spring is still stretched, and has to stay
 * there. Coulomb's law with fixed steps chatters and drifts, the velocity-limited law creeps, Quinn's law rests.
 *
 *     paper_oscillator FOLDER
 *
 * Writes FOLDER/fig5.csv (all three laws), FOLDER/values-fig5.txt, and prints the rest points. */
#include <math.h>

#include "../../src/damper/output.h"
#include "tribo/tribo_gsl.h"

static const int laws[] = {TRIBO_COULOMB, TRIBO_VELOCITY_LIMITED, TRIBO_QUINN};
enum { LAWS = sizeof laws / sizeof *laws };

/* A free oscillator of unit mass, stiffness and limit, and its integrator with fixed steps. */
struct run {
    tribo_system *sys;
    tribo_driver *drv;
    double t, y[3];
};

static struct run start(int law, double dt, double epsilon, double x, double v)
{
    struct run r = {NULL, NULL, 0.0, {x, v, 0.0}};
    need(tribo_system_oscillator(&r.sys, 1.0, 0.0, 0.0), NULL);
    tribo_context *contacts = tribo_system_context(r.sys);
    need(tribo_set_law(contacts, law), tribo_message(contacts));
    need(tribo_set_epsilon_all(contacts, epsilon), tribo_message(contacts));
    need(tribo_driver_create(&r.drv, r.sys, "rk4/fixed"), tribo_system_message(r.sys));
    need(tribo_driver_set_step(r.drv, dt), tribo_driver_message(r.drv));
    return r;
}

static void run_to(struct run *r, double t)
{
    need(tribo_driver_advance(r->drv, &r->t, t, r->y), tribo_driver_message(r->drv));
}

static void stop(struct run *r)
{
    tribo_driver_destroy(r->drv);
    tribo_system_destroy(r->sys);
}

/* Where the oscillator is after so long a time that it should rest. */
static double rest_point(double dt, double epsilon, double x, double v, double end)
{
    struct run r = start(TRIBO_QUINN, dt, epsilon, x, v);
    run_to(&r, end);
    stop(&r);
    return r.y[0];
}

static void write_motion(const char *folder, double dt, double end)
{
    FILE *table = create_file(folder, "fig5.csv");
    struct run runs[LAWS];
    fprintf(table, "t");
    for (int i = 0; i < LAWS; i++) {
        const char *name = tribo_law_name(laws[i]);
        runs[i] = start(laws[i], dt, 2.0 * dt, 2.75, 0.0);
        fprintf(table, ",x %s,v %s,f %s", name, name, name);
    }
    fprintf(table, "\n");
    for (int k = 0; k <= (int)lround(end / dt); k++) {
        fprintf(table, "%.10g", k * dt);
        for (int i = 0; i < LAWS; i++) {
            double f;
            run_to(&runs[i], k * dt);
            need(tribo_system_contacts(runs[i].sys, runs[i].t, runs[i].y, NULL, NULL, &f), NULL);
            fprintf(table, ",%.10g,%.10g,%.10g", runs[i].y[0], runs[i].y[1], f);
        }
        fprintf(table, "\n");
    }
    for (int i = 0; i < LAWS; i++) {
        printf("fig5  %-16s x(%g) = %.7f\n", tribo_law_name(laws[i]), end, runs[i].y[0]);
        stop(&runs[i]);
    }
    close_file(table, "fig5.csv");
}

int main(int argc, char **argv)
{
    program = "paper_oscillator";
    if (argc != 2) {
        die("usage: paper_oscillator FOLDER");
    }
    const double dt = 0.01;
    write_motion(argv[1], dt, 10.0);

    FILE *values = create_file(argv[1], "values-fig5.txt");
    write_value(values, rest_point(dt, 2.0 * dt, 2.75, 0.0, 10.0), "fig5.rest");
    write_value(values, rest_point(1e-4, 2e-4, 2.75, 0.0, 10.0), "fig5.rest.fine");
    /* Eq. 6 is what the regularization does to the rest point, with steps too short to matter */
    write_value(values, rest_point(1e-5, 0.02, 2.75, 0.0, 5.0) + 0.75, "eq6.error");
    write_value(values, 0.02 * 0.02 * (-0.75 - 1.0) / 8.0, "eq6.error.formula");
    write_value(values, rest_point(1e-4, 2e-4, 12.0, 6.0, 30.0), "long.rest");
    write_value(values, 15.0 - sqrt(205.0), "long.rest.exact");
    close_file(values, "values-fig5.txt");
    return 0;
}
