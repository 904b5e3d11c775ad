/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls of calls_gsl.c: systems whose limits follow the motion, searches for periodic motions, cycles and nonlinear modes, and
 * queries of the motions found. A motion found returns to its state after its period. */
#include <math.h>
#include <string.h>

#include "calls_gsl.h"

int create_pressed(struct bytes *b, struct scene *s)
{
    double mass[MOST_DOFS * MOST_DOFS], damping[MOST_DOFS * MOST_DOFS], stiffness[MOST_DOFS * MOST_DOFS],
        direction[MOST_CONTACTS * MOST_DOFS], compliance[MOST_CONTACTS], normal[3];
    const size_t n = 1 + choose(b, 4), c = 2 + choose(b, 4), pressed = 1 + choose(b, 2);
    tribo_model *model;
    fill_matrix(b, mass, n, 0.5);
    fill_matrix(b, stiffness, n, 0.0);
    fill_matrix(b, damping, n, 0.1);
    fill(b, direction, c * n);
    for (size_t i = 0; i < c; i++) {
        compliance[i] = choose(b, 2) ? positive(b) : 0.0;
    }
    s->given = n;
    s->wild =
        wild(mass, n * n) || wild(stiffness, n * n) || wild(damping, n * n) || wild(direction, c * n) || wild(compliance, c);
    demand(tribo_model_create(&model, n, c) == TRIBO_OK, "model");
    int status = tribo_model_set_mass(model, mass);
    status = status ? status : tribo_model_set_stiffness(model, stiffness);
    status = status ? status : tribo_model_set_damping(model, damping);
    status = status ? status : tribo_model_set_direction(model, direction);
    status = status || choose(b, 2) ? status : tribo_model_set_compliance(model, compliance);
    for (size_t k = 0; k < pressed && !status; k++) {
        const size_t contact = choose(b, c), row = choose(b, 32) ? choose(b, c) : c;
        normal[0] = positive(b), normal[1] = 10.0 * positive(b), normal[2] = number(b);
        s->wild |= wild(normal, 3);
        const int refused = tribo_model_set_normal(model, contact, row, normal[0], normal[1], normal[2]);
        demand(refused || (contact != row && row < c && are_finite(normal, 3)), "contact %zu, normal %zu", contact, row);
        demand(!refused || tribo_model_message(model)[0] != '\0', "status %d without a message", refused);
    }
    status = status ? status : tribo_system_create(&s->sys, model);
    demand(status == TRIBO_OK || tribo_model_message(model)[0] != '\0', "status %d without a message", status);
    tribo_model_destroy(model);
    return status;
}

static int say(const struct run *r, int status)
{
    demand(status == TRIBO_OK || tribo_driver_message(r->drv)[0] != '\0', "status %d without a message", status);
    demand(strcmp(tribo_strerror(status), tribo_strerror(-1)) != 0, "status %d is unknown", status);
    return status;
}

/* The state after a period from y is y, but for what multipliers make of rounding, and energy. */
static void come_back(const struct scene *s, struct run *r, double t, double period, const double *y)
{
    double re[MOST_STATES], im[MOST_STATES], again[MOST_STATES], size = 1.0, most = 1.0, off = 0.0;
    const size_t states = s->dimension - 1;
    if (say(r, tribo_driver_get_multipliers(r->drv, re, im))) {
        return;
    }
    for (size_t i = 0; i < states; i++) {
        demand(isfinite(re[i]) && isfinite(im[i]), "multiplier %zu", i);
        most = fmax(most, hypot(re[i], im[i]));
        size = fmax(size, fabs(y[i]));
    }
    memcpy(again, y, sizeof again);
    double end = t;
    demand(tribo_driver_set_observer(r->drv, NULL, NULL) == TRIBO_OK, "observer");
    if (most > 1e4 || period > 100.0 || say(r, tribo_driver_advance(r->drv, &end, t + period, again))) {
        return;
    }
    for (size_t i = 0; i < states; i++) {
        off = fmax(off, fabs(again[i] - y[i]));
    }
    demand(off <= (1e-6 + 10.0 * r->tolerance) * most * size, "%s: off by %g of %g after %.17g from %.17g, largest multiplier %g",
           tribo_driver_method(r->drv), off, size, period, t, most);
}

static void question(struct bytes *b, const struct scene *s, const struct run *r)
{
    double c[2 * MOST_DOFS], x[4], each[MOST_CONTACTS], y[4 * MOST_STATES];
    size_t index[4];
    int kind[4];
    fill(b, c, 2 * s->n);
    const int legal = are_finite(c, 2 * s->n);
    int status = say(r, tribo_driver_period_extremes(r->drv, c, x, x + 1, x + 2, x + 3));
    demand(status || (legal && x[0] <= x[1]), "extremes %g, %g", x[0], x[1]);
    status = say(r, tribo_driver_period_harmonic(r->drv, c, choose(b, 4), x, x + 1));
    demand(status || are_finite(x, 2), "harmonic %g, %g", x[0], x[1]);
    status = say(r, tribo_driver_period_dissipation(r->drv, each));
    demand(status || are_finite(each, s->c), "energies");
    status = say(r, tribo_driver_period_stick(r->drv, each));
    for (size_t i = 0; i < s->c && !status; i++) {
        demand(each[i] >= 0.0 && each[i] <= 1.0, "share %g", each[i]);
    }
    const size_t count = choose(b, 5);
    for (size_t k = 0; k < count; k++) {
        kind[k] = (int)choose(b, 6) - 1;
        index[k] = choose(b, s->c + 1);
    }
    status = say(r, tribo_driver_period_derivatives(r->drv, count, kind, index, legal ? c : NULL, NULL, NULL, y));
    demand(status || (count && are_finite(y, count * s->dimension)), "derivatives");
    double re[5], im[5];
    const size_t which = choose(b, s->dimension);
    status = say(r, tribo_driver_multiplier_derivatives(r->drv, which, count, kind, index, re, im));
    demand(status || (are_finite(re, count) && are_finite(im, count)), "derivatives of a multiplier");
}

void periods(struct bytes *b, struct scene *s, struct run *r)
{
    double c[2 * MOST_DOFS], y[MOST_STATES], period, omega = 0.0, zeta = 0.01 * number(b);
    const size_t what = choose(b, 4);
    const double t = number(b), guess = positive(b), amplitude = positive(b), given[] = {t, guess, amplitude};
    if (!bearable(s, r, 1.0) || s->wild || wild(given, 3)) {
        return;
    }
    memset(c, 0, sizeof c);
    c[choose(b, s->n + s->n)] = 1.0;
    memcpy(y, r->y, sizeof y);
    period = what == 2 ? guess : s->omega != 0.0 ? 6.283185307179586 / fabs(s->omega) : 1.0;
    const int status = what == 0   ? tribo_driver_find_mode(r->drv, c, amplitude, &omega, &zeta, y)
                       : what == 1 ? tribo_driver_find_cycle(r->drv, t, &period, y)
                                   : tribo_driver_find_periodic(r->drv, t, period, y);
    demand(!say(r, status) || memcmp(y, r->y, sizeof y) == 0, "status %d, but changed", status);
    demand(status || are_finite(y, s->dimension), "%s, search %zu, status %d: not finite", tribo_driver_method(r->drv), what,
           status);
    if (!status && what > 0) {
        demand(period > 0.0, "period %g", period);
        come_back(s, r, t, period, y);
    }
    demand(status || what > 0 || (omega > 0.0 && isfinite(zeta)), "omega %g, zeta %g", omega, zeta);
    question(b, s, r);
}
