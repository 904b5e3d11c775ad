/* SPDX-License-Identifier: BSD-3-Clause */
/* Squeal of a body on a belt, N = normal y. For mu > mu_c two modes of the sliding body couple, and the sliding state is unstable
 * (flutter; the model of Hoffmann, Fischer, Allgaier and Gaul 2002). The motion grows into a limit cycle of slip, stick and
 * lift-off.
 *
 *     contact_squeal FOLDER
 *
 * Writes FOLDER/squeal-growth.csv, FOLDER/squeal-cycle.csv (one period of the limit cycle) and FOLDER/values-squeal.txt. */
#include <complex.h>
#include <math.h>

#include "../../src/damper/output.h"
#include "tribo/tribo_dynamics.h"

/* Mass 1, two inclined springs, the stiffness `normal` of the contact in y, pressed by `preload`; damping 0.1 in x and y. */
static const double spring[2] = {11.0, 20.0}, angle[2] = {150.0, 30.0}, damping = 0.1, normal = 11.0, preload = 10.0, belt = 0.5,
                    mu = 0.6;
static const double pi = 3.14159265358979323846;
enum { DIMENSION = 5 }; /* x, y, x', y', energy */

/* k [2][2]: stiffness of the inclined springs. */
static void find_stiffness(double *k)
{
    k[0] = k[1] = k[2] = k[3] = 0.0;
    for (int i = 0; i < 2; i++) {
        const double c = cos(angle[i] * pi / 180.0), s = sin(angle[i] * pi / 180.0);
        k[0] += spring[i] * c * c;
        k[1] += spring[i] * c * s;
        k[3] += spring[i] * s * s;
    }
    k[2] = k[1];
}

static tribo_system *create_system(const double *k)
{
    const double mass[] = {1.0, 1.0}, damped[] = {damping, damping}, direction[] = {1.0, 0.0, 0.0, 1.0};
    const double load[] = {0.0, preload}, speed[] = {belt, 0.0};
    tribo_model *model;
    tribo_system *sys;
    need(tribo_model_create(&model, 2, 2), NULL);
    need(tribo_model_set_mass_diagonal(model, mass), tribo_model_message(model));
    need(tribo_model_set_damping_diagonal(model, damped), tribo_model_message(model));
    need(tribo_model_set_stiffness(model, k), tribo_model_message(model));
    need(tribo_model_set_direction(model, direction), tribo_model_message(model));
    need(tribo_model_set_normal(model, 0, 1, mu, normal, 0.0), tribo_model_message(model));
    need(tribo_system_create(&sys, model), tribo_model_message(model));
    tribo_model_destroy(model);
    need(tribo_system_add_load(sys, 0.0, load, NULL), tribo_system_message(sys));
    need(tribo_system_add_base_motion(sys, 0.0, speed, NULL), tribo_system_message(sys));
    return sys;
}

/* Events of the limit cycle: times of the last two break-aways, and the kind of the phase, as moments have it. */
struct cycle {
    double begin, last;
    int phase;
    FILE *table;
};

static int see(const tribo_moment *moment, void *data)
{
    struct cycle *cycle = data;
    if (moment->kind != TRIBO_MOMENT_STEP) {
        cycle->phase = moment->kind;
    }
    if (moment->kind == TRIBO_MOMENT_SLIP) {
        cycle->begin = cycle->last;
        cycle->last = moment->t;
    }
    if (cycle->table) {
        fprintf(cycle->table, "%.10g,%.10g,%.10g,%.10g,%.10g,%d\n", moment->t, moment->y[0], moment->y[1], moment->y[2],
                moment->y[3], cycle->phase);
    }
    return 0;
}

/* growth + i omega of motions about the sliding state: the equation l^2 + damping l + kappa = 0 for the eigenvalues kappa of the
 * stiffness while sliding, which is not symmetric. */
static double complex find_flutter(const double *k)
{
    const double a = k[0], b = k[1] - mu * normal, c = k[2], d = k[3] + normal;
    const double complex kappa = 0.5 * (a + d) + csqrt(0.25 * (a - d) * (a - d) + b * c);
    const double complex root = csqrt(0.25 * damping * damping - kappa);
    return fabs(creal(root)) - 0.5 * damping + fabs(cimag(root)) * (double complex)I;
}

int main(int argc, char **argv)
{
    program = "contact_squeal";
    if (argc != 2) {
        die("usage: contact_squeal FOLDER");
    }
    double k[4], t = 0.0, y[DIMENSION] = {0.0}, middle[2], small, large;
    find_stiffness(k);
    const double critical = ((k[0] - k[3] - normal) * (k[0] - k[3] - normal) + 4.0 * k[1] * k[1]) / (4.0 * k[1] * normal);

    /* The sliding state: x and y at which all forces balance; the motion starts near it,. */
    const double det = k[0] * (k[3] + normal) - (k[1] - mu * normal) * k[2];
    middle[0] = -(k[1] - mu * normal) * preload / det;
    middle[1] = k[0] * preload / det;
    y[0] = middle[0] + 1e-3;
    y[1] = middle[1];

    FILE *values = create_file(argv[1], "values-squeal.txt");
    struct cycle cycle = {0.0, 0.0, TRIBO_MOMENT_STEP, create_file(argv[1], "squeal-growth.csv")};
    tribo_driver *drv;
    tribo_system *sys = create_system(k);
    need(tribo_driver_create(&drv, sys, "event"), tribo_system_message(sys));
    need(tribo_driver_set_observer(drv, see, &cycle), tribo_driver_message(drv));
    need(tribo_driver_set_output(drv, 0.01), tribo_driver_message(drv));

    /* Growth: the distance from the sliding state, once the other mode has died away, over eight periods of the flutter. */
    const double complex flutter = find_flutter(k);
    const double span = 2.0 * pi / cimag(flutter);
    fprintf(cycle.table, "t,x,y,vx,vy,phase\n");
    need(tribo_driver_advance(drv, &t, 8.0 * span, y), tribo_driver_message(drv));
    small = hypot(y[0] - middle[0], y[1] - middle[1]);
    need(tribo_driver_advance(drv, &t, 16.0 * span, y), tribo_driver_message(drv));
    large = hypot(y[0] - middle[0], y[1] - middle[1]);
    const double growth = log(large / small) / (8.0 * span);
    need(tribo_driver_advance(drv, &t, 60.0, y), tribo_driver_message(drv));
    close_file(cycle.table, "squeal-growth.csv");

    /* The limit cycle, which draws motions in by 0.869 a period, from one break-away to the next. */
    cycle.table = NULL;
    need(tribo_driver_set_output(drv, 500.0), tribo_driver_message(drv));
    need(tribo_driver_advance(drv, &t, 500.0, y), tribo_driver_message(drv));
    const double period = cycle.last - cycle.begin;
    cycle.table = create_file(argv[1], "squeal-cycle.csv");
    fprintf(cycle.table, "t,x,y,vx,vy,phase\n");
    need(tribo_driver_set_output(drv, 0.002), tribo_driver_message(drv));
    need(tribo_driver_advance(drv, &t, t + period, y), tribo_driver_message(drv));
    close_file(cycle.table, "squeal-cycle.csv");

    printf("critical coefficient of friction %.10f; growth at %.2f: %.4f of %.4f; limit cycle of period %.10f\n", critical, mu,
           growth, creal(flutter), period);
    write_value(values, critical, "squeal.critical");
    write_value(values, growth, "squeal.growth");
    write_value(values, creal(flutter), "squeal.growth.formula");
    write_value(values, period, "squeal.period");
    close_file(values, "values-squeal.txt");
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    return 0;
}
