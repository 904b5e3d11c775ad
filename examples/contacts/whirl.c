/* SPDX-License-Identifier: BSD-3-Clause */
/* A mass on an isotropic spring, driven round in circles on a rough plane. One planar contact lets it run in a circle, whose
 * radius and lag are known; two scalar ones in its place (a friction pyramid) do not. Your own loop, rk4, with tribo_balance.
 *
 *     contact_whirl FOLDER
 *
 * Writes FOLDER/whirl.csv and FOLDER/values-whirl.txt. */
#include <math.h>

#include "../../src/damper/output.h"
#include "tribo/tribo.h"

/* Mass, stiffness and the turning force are 1. */
static const double omega = 0.6, limit = 0.3;

/* The state (x, y, x', y') and what rubs. */
struct whirl {
    tribo_context *contact;
    double t, s[4];
};

static void rates(const struct whirl *w, double t, const double *s, double *out)
{
    const double free[2] = {cos(omega * t) - s[0], sin(omega * t) - s[1]};
    double f[2];
    need(tribo_balance(w->contact, s + 2, free, NULL, f), tribo_message(w->contact));
    for (int i = 0; i < 2; i++) {
        out[i] = s[2 + i];
        out[2 + i] = free[i] + f[i];
    }
}

static void step(struct whirl *w, double dt)
{
    static const double at[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    double k[4] = {0.0}, next[4], s[4];
    for (int i = 0; i < 4; i++) {
        next[i] = w->s[i];
    }
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < 4; i++) {
            s[i] = w->s[i] + at[stage] * dt * k[i];
        }
        rates(w, w->t + at[stage] * dt, s, k);
        for (int i = 0; i < 4; i++) {
            next[i] += dt * weight[stage] * k[i];
        }
    }
    w->t += dt;
    for (int i = 0; i < 4; i++) {
        w->s[i] = next[i];
    }
}

static struct whirl create(int planar, double dt)
{
    struct whirl w = {NULL, 0.0, {0.0, 0.0, 0.0, 0.0}};
    const double unit_mass[2] = {1.0, 1.0};
    const size_t first = 0;
    need(tribo_create(&w.contact, 2), NULL);
    need(tribo_set_limit_all(w.contact, limit), tribo_message(w.contact));
    need(tribo_set_operator_diagonal(w.contact, unit_mass), tribo_message(w.contact));
    need(tribo_set_planar(w.contact, planar ? 1 : 0, &first), tribo_message(w.contact));
    need(tribo_set_epsilon_step(w.contact, dt, 1.0), tribo_message(w.contact));
    return w;
}

/* Runs until the motion is steady, and a period more. Returns the radius at the end; lag is how far the motion is behind the
 * force, swing how much the radius changes over the period. */
static double run(struct whirl *w, double dt, FILE *table, double *lag, double *swing)
{
    const double turn = 2.0 * acos(-1.0), period = turn / omega;
    const int steps = (int)lround(period / dt);
    double least = HUGE_VAL, most = 0.0, radius = 0.0;
    for (int k = 1; k <= 80 * steps; k++) {
        step(w, period / steps);
        radius = hypot(w->s[0], w->s[1]);
        if (k > 79 * steps) {
            least = fmin(least, radius);
            most = fmax(most, radius);
        }
        if (k % (steps / 100) == 0 && (k < 6 * steps || k >= 79 * steps)) {
            fprintf(table, "%.8g,%.8g,%.8g,%d\n", w->t, w->s[0], w->s[1], k >= 79 * steps);
        }
    }
    *lag = remainder(omega * w->t - atan2(w->s[1], w->s[0]), turn);
    *swing = most - least;
    tribo_destroy(w->contact);
    return radius;
}

int main(int argc, char **argv)
{
    program = "contact_whirl";
    if (argc != 2) {
        die("usage: contact_whirl FOLDER");
    }
    FILE *table = create_file(argv[1], "whirl.csv"), *values = create_file(argv[1], "values-whirl.txt");
    const double dt = 0.01;
    double lag, pyramid_lag, swing, pyramid_swing;
    struct whirl disc = create(1, dt), pyramid = create(0, dt);
    fprintf(table, "t,x,y,steady\n");
    const double radius = run(&disc, dt, table, &lag, &swing);
    fprintf(table, "\n\n");
    printf("planar contact: radius %.8f, lag %.8f\n", radius, lag);
    write_value(values, radius, "whirl.radius");
    write_value(values, sqrt(1.0 - limit * limit) / (1.0 - omega * omega), "whirl.radius.formula");
    write_value(values, lag, "whirl.lag");
    write_value(values, asin(limit), "whirl.lag.formula");
    run(&pyramid, dt, table, &pyramid_lag, &pyramid_swing);
    write_value(values, swing, "whirl.swing");
    write_value(values, pyramid_swing, "whirl.swing.pyramid");
    printf("two scalar contacts: the radius swings by %.3f\n", pyramid_swing);
    close_file(table, "whirl.csv");
    close_file(values, "values-whirl.txt");
    return 0;
}
