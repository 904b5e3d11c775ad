/* SPDX-License-Identifier: BSD-3-Clause */
/* What a steady motion costs over the number of modes of the structure and of its contacts.
 *   bench_points [[mass stiffness dofs contacts] modes none|mass|compliance]
 * Without arguments: the beam of the examples on three contacts, driven at frequencies about three times its first one, in 12,
 * 24, 48 and 96 modes, alone, with static responses of the contacts, and with compliance; or one row of these. Otherwise a
 * structure whose contacts are spread over the degrees of freedom in direction z, the last of which has the load, driven about
 * its first frequency. POINTS motions at several frequencies and limits, by one driver, each from the motion before. Prints a row
 * a system: times in milliseconds and beside those of the first row; spans followed, events and decompositions a point; power at
 * the first point. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "../../src/damper/output.h"
#include "structure_model.h"
#include "harness.h"
#include "tribo/tribo_gsl.h"
#include "../set_up_driver.h"

#define PI 3.14159265358979323846
#define DAMPING 0.002

enum { FREQUENCIES = 4, LIMITS = 5, POINTS = FREQUENCIES * LIMITS };

struct scene {
    struct structure s;
    size_t contacts, load, *at; /* [contacts] rows of the contacts */
    double force, omega, limit; /* of the first point */
};

struct cost {
    double seconds, power;
    size_t found, periods, events;
};

static void place_beam(struct scene *x)
{
    static const struct place place[] = {{{200.0, 0.0, 5.0}, 3, "contact 1"},
                                         {{300.0, 0.0, 5.0}, 3, "contact 2"},
                                         {{400.0, 0.0, 5.0}, 3, "contact 3"},
                                         {{400.0, 20.0, 5.0}, 3, "load"}};
    x->s = read_structure(BEAM_FILES "/M.mtx", BEAM_FILES "/K.mtx", BEAM_FILES "/dofs.txt");
    x->contacts = 3;
    x->at = need_memory(x->contacts, sizeof *x->at);
    for (size_t i = 0; i < x->contacts; i++) {
        x->at[i] = find_degree(&x->s, &place[i]);
    }
    x->load = find_degree(&x->s, &place[3]);
    x->force = 0.1;
    x->omega = 3.0;
    x->limit = 0.1;
}

static void spread_contacts(struct scene *x)
{
    size_t vertical = 0, at = 0, placed = 0;
    for (size_t i = 0; i < x->s.ndof; i++) {
        vertical += x->s.dof[i].direction == 3;
    }
    if (x->contacts == 0 || x->contacts >= vertical) {
        die("%zu contacts among %zu degrees of freedom in direction z", x->contacts, vertical);
    }
    x->at = need_memory(x->contacts, sizeof *x->at);
    for (size_t i = 0; i < x->s.ndof; i++) {
        if (x->s.dof[i].direction == 3) {
            x->load = i;
            if (placed < x->contacts && at++ * x->contacts >= placed * vertical) {
                x->at[placed++] = i;
            }
        }
    }
    x->force = 1.0;
    x->omega = 1.0;
    x->limit = 1.0 / (double)x->contacts;
}

static tribo_system *create(const struct scene *x, size_t modes, int statics, double *first)
{
    tribo_system *sys;
    tribo_model *model = model_of(&x->s, x->contacts, x->at);
    need(tribo_system_reduce(&sys, model, modes, statics), tribo_model_message(model));
    tribo_model_destroy(model);
    double *frequency = need_memory(tribo_system_dimension(sys), sizeof *frequency);
    need(tribo_system_get_frequencies(sys, frequency), NULL);
    need(tribo_system_set_damping_ratio(sys, DAMPING), NULL);
    *first = frequency[0];
    free(frequency);
    return sys;
}

static double find_power(tribo_driver *drv, size_t contacts, double period)
{
    double *energy = need_memory(contacts, sizeof *energy), power = 0.0;
    need(tribo_driver_period_dissipation(drv, energy), tribo_driver_message(drv));
    for (size_t i = 0; i < contacts; i++) {
        power += energy[i] / period;
    }
    free(energy);
    return power;
}

/* The first point is the scene's; others have higher frequencies, and limits down to a hundredth. */
static struct cost run(const struct scene *x, tribo_system *sys, double first)
{
    struct cost cost = {0};
    tribo_context *c = tribo_system_context(sys);
    double *y = need_memory(tribo_system_dimension(sys), sizeof *y), *load = need_memory(x->s.ndof, sizeof *load);
    memset(y, 0, tribo_system_dimension(sys) * sizeof *y);
    memset(load, 0, x->s.ndof * sizeof *load);
    load[x->load] = x->force;
    tribo_driver *drv;
    need(set_up_driver(&drv, sys, "exact", 1.0, 0.0, 0.0), NULL);
    for (size_t k = 0; k < POINTS; k++) {
        const double omega = x->omega * first * (1.0 + 0.05 * (double)(k / LIMITS)), period = 2.0 * PI / omega;
        need(tribo_system_clear_loads(sys), tribo_system_message(sys));
        need(tribo_system_add_load(sys, omega, NULL, load), tribo_system_message(sys));
        need(tribo_set_limit_all(c, x->limit * pow(0.01, (double)(k % LIMITS) / (LIMITS - 1))), tribo_message(c));
        const double begin = cpu_seconds();
        const int status = tribo_driver_find_periodic(drv, 0.0, period, y);
        cost.seconds += (cpu_seconds() - begin) / POINTS;
        cost.found += !status;
        if (status) {
            fprintf(stderr, "%s\n", tribo_driver_message(drv));
        } else if (k == 0) {
            cost.power = find_power(drv, x->contacts, period);
        }
    }
    need(tribo_driver_count(drv, TRIBO_COUNT_PERIODS, &cost.periods), NULL);
    need(tribo_driver_count(drv, TRIBO_COUNT_EVENTS, &cost.events), NULL);
    tribo_driver_destroy(drv);
    free(y);
    free(load);
    return cost;
}

static const char *const kind[] = {"none", "mass", "compliance"};

/* Returns the seconds of a point. */
static double measure(const struct scene *x, size_t modes, int statics, double unit)
{
    double first;
    tribo_system *sys = create(x, modes, statics, &first);
    const struct cost cost = run(x, sys, first);
    printf("%5zu %10s %6zu %10.2f %8.1f %9.1f %9.1f %14.6g\n", modes, kind[statics], cost.found, 1e3 * cost.seconds,
           unit > 0.0 ? cost.seconds / unit : 1.0, (double)cost.periods / POINTS, (double)cost.events / POINTS, cost.power);
    fflush(stdout);
    tribo_system_destroy(sys);
    return cost.seconds;
}

int main(int argc, char **argv)
{
    program = "bench_points";
    gsl_set_error_handler_off(); /* as read_structure expects */
    if (argc != 1 && argc != 3 && argc != 7) {
        die("usage: bench_points [[mass stiffness dofs contacts] modes none|mass|compliance]");
    }
    struct scene x = {.force = 0.1};
    printf("%5s %10s %6s %10s %8s %9s %9s %14s\n", "modes", "statics", "found", "ms a point", "ratio", "periods", "events",
           "power");
    if (argc < 7) {
        place_beam(&x);
    } else {
        x.s = read_structure(argv[1], argv[2], argv[3]);
        x.contacts = strtoul(argv[4], NULL, 10);
        spread_contacts(&x);
    }
    if (argc > 1) {
        const char *statics = argv[argc - 1];
        measure(&x, strtoul(argv[argc - 2], NULL, 10), !strcmp(statics, kind[1]) + 2 * !strcmp(statics, kind[2]), 0.0);
    }
    static const size_t modes[] = {12, 24, 48, 96};
    double unit = 0.0;
    for (size_t k = 0; argc == 1 && k < 12; k++) {
        const double seconds = measure(&x, modes[k % 4], (int)(k / 4), unit);
        unit = k ? unit : seconds;
    }
    free(x.at);
    free_structure(&x.s);
    return EXIT_SUCCESS;
}
