/* SPDX-License-Identifier: BSD-3-Clause */
/* A law of one's own beside built-in laws, on the mass on a spring of Quinn (2004), Fig. 5: friction falls with speed to a part
 * of the limit, 0.6; near stick it is Quinn's law. With part 1 the law is Quinn's, and gives the same motion. */
#include <math.h>
#include <stdio.h>

#include "tribo/tribo_dynamics.h"

static double larger(double x, double y)
{
    return x > y ? x : y;
}

/* box [3][n] = lower, upper and shift of each contact: f = clamp(f_eq - shift, lower, upper), see "A law of your own" in the
 * manual. Sets no derivatives: the method "rk4/fixed" calls a law with derivatives = 0. */
static int falling(size_t first, size_t n, int derivatives, const double *v, const double *limit, const double *epsilon,
                   double *restrict box, void *data)
{
    const double part = *(const double *)data, speed = 1.0; /* the fall is by 1 - 1/e at this speed beyond epsilon */
    (void)first;
    for (size_t i = 0; i < n; i++) {
        const double most = larger(fabs(v[i]), epsilon[i]), fall = exp((epsilon[i] - most) / speed);
        const double L = limit[i] * (part + (1.0 - part) * fall), k = 2.0 * L * (v[i] / most);
        box[i] = larger(-L, -L - k);
        box[n + i] = -larger(-L, k - L);
        box[2 * n + i] = k;
    }
    return derivatives; /* not 0: fails where derivatives are asked for */
}

/* y = the motion from y at t = 0 to 40 by a law of the registry, or, if part is given, by the law above; a status. */
static int run(int law, double *part, double *y)
{
    tribo_system *sys = NULL;
    tribo_driver *drv = NULL;
    double t = 0.0;
    int status = tribo_system_oscillator(&sys, 1.0, 0.0, 0.0);
    tribo_context *contacts = status ? NULL : tribo_system_context(sys);
    status = status ? status : tribo_set_law(contacts, law);
    status = status ? status : tribo_set_epsilon_all(contacts, 1e-2);
    if (!status && part) {
        status = tribo_set_user_law(contacts, falling, part);
    }
    status = status ? status : tribo_driver_create(&drv, sys, "rk4/fixed");
    status = status ? status : tribo_driver_set_step(drv, 2e-3);
    status = status ? status : tribo_driver_advance(drv, &t, 40.0, y);
    if (status) {
        fprintf(stderr, "%s: %s\n", tribo_strerror(status), tribo_driver_message(drv));
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    return status;
}

int main(void)
{
    double falls = 0.6, stays = 1.0, y[5][3];
    const struct {
        const char *name;
        int law;
        double *part;
    } runs[] = {{"velocity_limited", TRIBO_VELOCITY_LIMITED, NULL},
                {"smooth", TRIBO_SMOOTH, NULL},
                {"quinn", TRIBO_QUINN, NULL},
                {"own, part 1.0", TRIBO_QUINN, &stays},
                {"own, part 0.6", TRIBO_QUINN, &falls}};
    int failed = 0;
    printf("%-18s %12s %12s %12s\n", "law", "x at t = 40", "velocity", "dissipated");
    for (int k = 0; k < 5 && !failed; k++) {
        y[k][0] = 8.3; /* with Coulomb's law the mass stops at x = 0.3 */
        y[k][1] = y[k][2] = 0.0;
        failed = run(runs[k].law, runs[k].part, y[k]);
        printf("%-18s %12.6f %12.1e %12.6f\n", runs[k].name, y[k][0], y[k][1], y[k][2]);
    }
    /* part 1 is Quinn's law; the other one rests, at another place, and its energy is that of the spring. */
    const double lost = 0.5 * (8.3 * 8.3 - y[4][0] * y[4][0]);
    return failed || fabs(y[3][0] - y[2][0]) > 1e-12 || fabs(y[4][1]) > 1e-9 || fabs(y[4][0] - y[2][0]) < 0.1 ||
           fabs(y[4][2] - lost) > 1e-5 * lost;
}
