/* SPDX-License-Identifier: BSD-3-Clause */
/* Quinn (2004), Fig. 10 and 11: two blocks, one on the other, on a belt that moves to and fro. The contacts share the lower
 * block, so that f_eq of each depends on the force of the other: in the paper's way (partition) and in the consistent one.
 *
 *     paper_belt FOLDER
 *
 * Writes FOLDER/fig11.csv and FOLDER/values-fig11.txt, and prints the errors of the final state. */
#include <math.h>
#include <stdlib.h>

#include "../../src/damper/output.h"
#include "tribo/tribo_gsl.h"

static const char *const names[] = {"consistent", "partition"};
static const double end = 60.0;

/* x1, x2, x1', x2' at the end, epsilon -> 0, from an event-driven integration */
static const double exact[] = {-0.9541857100410, -0.1323742578991, -0.109011134358, -0.109011134358};

struct run {
    tribo_system *sys;
    tribo_driver *drv;
    double t, y[5];
};

/* From rest: kappa = 2, limits 0.5 and 0.25, belt velocity sin(0.5 t). */
static struct run start(int coupling, double dt)
{
    struct run r = {NULL, NULL, 0.0, {0.0}};
    need(tribo_system_belt(&r.sys, 2.0, 0.5, 0.25, 1.0, 0.5), NULL);
    tribo_context *contacts = tribo_system_context(r.sys);
    need(tribo_set_coupling(contacts, coupling), tribo_message(contacts));
    need(tribo_set_epsilon_all(contacts, 2.0 * dt), tribo_message(contacts));
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

static void write_motion(const char *folder, double dt)
{
    FILE *table = create_file(folder, "fig11.csv");
    struct run runs[2];
    fprintf(table, "t");
    for (int c = 0; c < 2; c++) {
        runs[c] = start(c, dt);
        fprintf(table, ",x1 %s,x2 %s,z1' %s,z2' %s", names[c], names[c], names[c], names[c]);
    }
    fprintf(table, "\n");
    for (int k = 0; k <= 1200; k++) {
        fprintf(table, "%.10g", k * end / 1200);
        for (int c = 0; c < 2; c++) {
            double v[2];
            run_to(&runs[c], k * end / 1200);
            need(tribo_system_contacts(runs[c].sys, runs[c].t, runs[c].y, v, NULL, NULL), NULL);
            fprintf(table, ",%.10g,%.10g,%.10g,%.10g", runs[c].y[0], runs[c].y[1], v[0], v[1]);
        }
        fprintf(table, "\n");
    }
    stop(&runs[0]);
    stop(&runs[1]);
    close_file(table, "fig11.csv");
}

/* Largest error of the final state; the state itself goes to the values if asked for. */
static double final_error(int coupling, double dt, FILE *values)
{
    struct run r = start(coupling, dt);
    run_to(&r, end);
    stop(&r);
    double error = 0.0;
    for (int i = 0; i < 4; i++) {
        error = fmax(error, fabs(r.y[i] - exact[i]));
        if (values) {
            write_value(values, r.y[i], "fig11.%s.y%d", names[coupling], i);
        }
    }
    return error;
}

int main(int argc, char **argv)
{
    program = "paper_belt";
    if (argc != 2) {
        die("usage: paper_belt FOLDER");
    }
    write_motion(argv[1], 1e-3);
    FILE *values = create_file(argv[1], "values-fig11.txt");
    for (int c = 0; c < 2; c++) {
        double error[4];
        for (int i = 0; i < 4; i++) {
            error[i] = final_error(c, pow(10.0, -2 - i), i == 3 ? values : NULL);
            write_value(values, error[i], "fig11.%s.error%d", names[c], i);
        }
        printf("fig11 %-16s error of the state at t = 60: %.1e, %.1e, %.1e, %.1e at dt 0.01, 1e-3, 1e-4, 1e-5\n", names[c],
               error[0], error[1], error[2], error[3]);
    }
    close_file(values, "values-fig11.txt");
    return 0;
}
