/* SPDX-License-Identifier: BSD-3-Clause */
/* What a contact whose limit follows the motion costs, and how exact it is: a period of a motion that slides, lifts off and
 * touches down, from its beginning, to which it must return. Two bodies of mass 1 in one: x'' + 0.346 x' + 12 x + f = 60 cos 5t,
 * y'' + 2 y' + 21 y + N = 100 + 60 cos 5t, N = 21 max(y, 0), |f| <= 0.85 N; rigid, or with a spring of stiffness 5 before the
 * slider (case 4 of tests/validation/series/normals.c). Then periodic motions of the beam of the examples on three such
 * contacts. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "../../src/damper/output.h"
#include "../set_up_driver.h"
#include "harness.h"
#include "structure_model.h"
#include "tribo/tribo_gsl.h"

enum { STATE = 6 };

static const double period = 6.283185307179586 / 5.0;

static tribo_system *create_scene(double soft)
{
    const double mass[] = {1.0, 1.0}, damping[] = {0.1 * sqrt(12.0), 2.0}, stiffness[] = {12.0, 21.0};
    const double direction[] = {1.0, 0.0, 0.0, 1.0}, compliance[] = {soft, 0.0}, steady[] = {0.0, 100.0}, swing[] = {60.0, 60.0};
    tribo_model *model;
    tribo_system *sys;
    need(tribo_model_create(&model, 2, 2), NULL);
    need(tribo_model_set_mass_diagonal(model, mass), NULL);
    need(tribo_model_set_damping_diagonal(model, damping), NULL);
    need(tribo_model_set_stiffness_diagonal(model, stiffness), NULL);
    need(tribo_model_set_direction(model, direction), NULL);
    need(tribo_model_set_compliance(model, compliance), NULL);
    need(tribo_model_set_normal(model, 0, 1, 0.85, 21.0, 0.0), NULL);
    need(tribo_system_create(&sys, model), tribo_model_message(model));
    tribo_model_destroy(model);
    need(tribo_system_add_load(sys, 0.0, steady, NULL), tribo_system_message(sys));
    need(tribo_system_add_load(sys, 5.0, swing, NULL), tribo_system_message(sys));
    return sys;
}

/* A period by a method. setting: steps a period; of event the tolerance. */
struct pass {
    tribo_system *sys;
    const char *method;
    double setting;
    const double *begin; /* [STATE] of the periodic motion */
    double error;        /* largest difference of displacements and velocities at its end */
};

static void run_pass(void *data)
{
    struct pass *p = data;
    tribo_driver *drv;
    double t = 0.0, y[STATE];
    const int steps = p->setting > 1.0;
    need(set_up_driver(&drv, p->sys, p->method, steps ? period / p->setting : 0.0, steps ? 0.0 : p->setting,
                       steps ? 0.0 : p->setting),
         tribo_system_message(p->sys));
    memcpy(y, p->begin, sizeof y);
    need(tribo_driver_advance(drv, &t, period, y), tribo_driver_message(drv));
    tribo_driver_destroy(drv);
    p->error = 0.0;
    for (size_t i = 0; i < 4; i++) {
        p->error = fmax(p->error, fabs(y[i] - p->begin[i]));
    }
}

static void find_begin(tribo_system *sys, double *y)
{
    tribo_driver *drv;
    need(tribo_driver_create(&drv, sys, "event"), tribo_system_message(sys));
    need(tribo_driver_find_periodic(drv, 0.0, period, y), tribo_driver_message(drv));
    tribo_driver_destroy(drv);
}

/* Of event tolerances, which errors stay below; of others steps a period. They are of first order at touch-down. */
static const struct {
    const char *method;
    double soft, setting;
} row[] = {{"event", 0.2, 1e-4},           {"event", 0.2, 1e-8},        {"event", 0.2, 1e-12},
           {"moreau/fixed", 0.2, 1000.0},  {"moreau/fixed", 0.2, 1e4},  {"moreau/fixed", 0.2, 1e5},
           {"event", 0.0, 1e-4},           {"event", 0.0, 1e-8},        {"event", 0.0, 1e-12},
           {"moreau/fixed", 0.0, 1000.0},  {"moreau/fixed", 0.0, 1e4},  {"moreau/fixed", 0.0, 1e5},
           {"central/fixed", 0.0, 1000.0}, {"central/fixed", 0.0, 1e4}, {"central/fixed", 0.0, 1e5}};

enum { ROWS = sizeof row / sizeof *row };

/* ------------------------------------------------------------------------------------------------------ the beam's motions
 * Three contacts on its centre line slide along x, mu 0.3; springs of 1 N/mm along z press with `load` N at rest, with more and
 * less as the beam bends, and lift off. 0.1 N at the free end, POINTS frequencies from 20 to 60 Hz, each from the motion
 * before. */

enum { CONTACTS = 3, POINTS = 41, MODES = 12 };

static tribo_system *create_beam(const struct structure *s, double load, double stiffness)
{
    double compliance[2 * CONTACTS] = {0.0};
    size_t at[2 * CONTACTS];
    tribo_system *sys;
    for (size_t k = 0; k < CONTACTS; k++) {
        const struct place along = {{200.0 + 100.0 * (double)k, 0.0, 5.0}, 1, "contact"};
        const struct place across = {{200.0 + 100.0 * (double)k, 0.0, 5.0}, 3, "normal"};
        at[k] = find_degree(s, &along);
        at[CONTACTS + k] = find_degree(s, &across);
        compliance[k] = stiffness > 0.0 ? 1.0 / stiffness : 0.0;
    }
    tribo_model *model = model_of(s, 2 * CONTACTS, at);
    need(tribo_model_set_compliance(model, compliance), tribo_model_message(model));
    for (size_t k = 0; k < CONTACTS; k++) {
        need(tribo_model_set_normal(model, k, CONTACTS + k, 0.3, 1.0, -load), tribo_model_message(model));
    }
    need(tribo_system_reduce(&sys, model, MODES, TRIBO_STATICS_MASS), tribo_model_message(model));
    tribo_model_destroy(model);
    need(tribo_system_set_damping_ratio(sys, 0.002), NULL);
    return sys;
}

/* Prints a row. Returns 1 if all motions are found. */
static int find_motions(const struct structure *s, double load, double stiffness)
{
    static const struct place free_end = {{400.0, 20.0, 5.0}, 3, "load"};
    tribo_system *sys = create_beam(s, load, stiffness);
    tribo_driver *drv;
    size_t found = 0, periods, events;
    double *y = need_memory(tribo_system_dimension(sys), sizeof *y), *force = need_memory(s->ndof, sizeof *force);
    double seconds = 0.0, first = 0.0, energy[2 * CONTACTS], power = 0.0;
    memset(y, 0, tribo_system_dimension(sys) * sizeof *y);
    memset(force, 0, s->ndof * sizeof *force);
    force[find_degree(s, &free_end)] = 0.1;
    need(set_up_driver(&drv, sys, "exact", 1.0, 0.0, 0.0), NULL);
    for (size_t k = 0; k < POINTS; k++) {
        const double hz = 20.0 + 40.0 * (double)k / (POINTS - 1);
        need(tribo_system_clear_loads(sys), NULL);
        need(tribo_system_add_load(sys, 6.283185307179586 * hz, NULL, force), tribo_system_message(sys));
        const double begin = cpu_seconds();
        const int status = tribo_driver_find_periodic(drv, 0.0, 1.0 / hz, y);
        seconds += cpu_seconds() - begin;
        first = k ? first : seconds;
        found += !status;
        if (!status) {
            need(tribo_driver_period_dissipation(drv, energy), tribo_driver_message(drv));
            power = hz * (energy[0] + energy[1] + energy[2]);
        }
    }
    need(tribo_driver_count(drv, TRIBO_COUNT_PERIODS, &periods), NULL);
    need(tribo_driver_count(drv, TRIBO_COUNT_EVENTS, &events), NULL);
    printf("| %s | %g | %zu | %.2g ms | %.2g ms | %.1f | %.0f | %.6g |\n", stiffness > 0.0 ? "elastic" : "rigid", load, found,
           1e3 * seconds / POINTS, 1e3 * first, (double)periods / POINTS, (double)events / POINTS, power);
    fflush(stdout);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    free(force);
    free(y);
    return found == POINTS;
}

static int run_beam(int smoke)
{
    static const double load[] = {0.05, 0.005, 0.3};
    struct structure s = read_structure(BEAM_FILES "/M.mtx", BEAM_FILES "/K.mtx", BEAM_FILES "/dofs.txt");
    int good = 1;
    printf("\n| contacts | load, N | found | a point | the first | periods | events | power at 60 Hz "
           "|\n|---|---|---|---|---|---|---|---|\n");
    for (size_t k = 0; k < (smoke ? 1 : 3); k++) {
        good &= find_motions(&s, load[k], 0.0) & find_motions(&s, load[k], 20.0);
    }
    free_structure(&s);
    return good;
}

int main(int argc, char **argv)
{
    const int smoke = argc > 1 && strcmp(argv[1], "--smoke") == 0;
    const struct effort effort = {5, 41, 1.0};
    int good = 1;
    program = "bench_follow";
    gsl_set_error_handler_off(); /* as read_structure expects */
    printf("| contact | method | steps or tolerance | error | time | by event, 1e-8 |\n|---|---|---|---|---|---|\n");
    for (int k = 0; k < 2; k++) {
        const double soft = k ? 0.0 : 0.2;
        tribo_system *sys = create_scene(soft);
        double begin[STATE] = {0.0};
        find_begin(sys, begin);
        struct pass unit = {sys, "event", 1e-8, begin, 0.0};
        struct job by = {run_pass, &unit, 0.0};
        probe_job(&by);
        for (size_t r = 0; r < ROWS; r++) {
            struct pass p = {sys, row[r].method, row[r].setting, begin, 0.0};
            struct job job = {run_pass, &p, 0.0};
            if (row[r].soft != soft) {
                continue;
            }
            probe_job(&job);
            good = good && p.error < (p.setting > 1.0 ? 60.0 / p.setting : p.setting);
            printf("| %s | `%s` | %g | %.1e |", k ? "rigid" : "elastic", p.method, p.setting, p.error);
            if (!smoke) {
                const struct timing t = time_job(&job, &by, &effort);
                printf(" %.3g us | %.2g |", 1e6 * t.seconds, t.ratio);
            }
            printf("\n");
            fflush(stdout);
        }
        tribo_system_destroy(sys);
    }
    return run_beam(smoke) && good ? EXIT_SUCCESS : EXIT_FAILURE;
}
