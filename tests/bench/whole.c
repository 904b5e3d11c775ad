/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps of moreau/fixed on a structure as it is, and reduced: what they take, and how far the motions are from each other.
 *   bench_whole mass stiffness dofs contacts modes
 * Contacts are spread over the degrees of freedom in direction z, the last of which has the load. modes 0: not reduced alone.
 * Prints values by name; status 1 if the two differ by more than 1e-3 of the largest displacement of the load. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>

#include "../../src/damper/output.h"
#include "structure_model.h"
#include "harness.h"
#include "memory.h"
#include "tribo/tribo_gsl.h"
#include "../set_up_driver.h"

#define PI 3.14159265358979323846
#define SAME 1e-3

enum { STEPS = 200, PER_PERIOD = 100 };

struct scene {
    struct structure s;
    size_t contacts, load;
    size_t *at; /* [contacts + 1] rows of the contacts; the last one is the load, a contact that stays open */
    double hz, limit;
};

static size_t count_vertical(const struct structure *s)
{
    size_t count = 0;
    for (size_t i = 0; i < s->ndof; i++) {
        count += s->dof[i].direction == 3;
    }
    return count;
}

static void spread_contacts(struct scene *x)
{
    const size_t vertical = count_vertical(&x->s);
    size_t at = 0, placed = 0;
    if (x->contacts == 0 || x->contacts >= vertical) {
        die("%zu contacts among %zu degrees of freedom in direction z", x->contacts, vertical);
    }
    x->at = need_memory(x->contacts + 1, sizeof *x->at);
    for (size_t i = 0; i < x->s.ndof; i++) {
        if (x->s.dof[i].direction == 3) {
            x->load = i;
            if (placed < x->contacts && at++ * x->contacts >= placed * vertical) {
                x->at[placed++] = i;
            }
        }
    }
    x->at[x->contacts] = x->load;
}

static tribo_system *create(const struct scene *x, size_t modes)
{
    tribo_system *sys;
    tribo_model *model = model_of(&x->s, x->contacts + 1, x->at);
    double *limit = need_memory(x->contacts + 1, sizeof *limit), *force = need_memory(x->s.ndof, sizeof *force);
    need(modes ? tribo_system_reduce(&sys, model, modes, TRIBO_STATICS_MASS) : tribo_system_create(&sys, model),
         tribo_model_message(model));
    tribo_model_destroy(model);
    for (size_t i = 0; i < x->contacts; i++) {
        limit[i] = x->limit / (double)x->contacts;
    }
    limit[x->contacts] = 0.0;
    for (size_t i = 0; i < x->s.ndof; i++) {
        force[i] = i == x->load ? 1.0 : 0.0;
    }
    need(tribo_set_limit(tribo_system_context(sys), limit), NULL);
    need(tribo_system_add_load(sys, 2.0 * PI * x->hz, NULL, force), NULL);
    free(limit);
    free(force);
    return sys;
}

/* Displacements of the load after each step into place [STEPS]; before is what was in memory without the system. */
static void march(tribo_system *sys, const struct scene *x, int reduced, double before, double *place)
{
    const double h = 1.0 / (PER_PERIOD * x->hz);
    tribo_driver *drv;
    const int status = set_up_driver(&drv, sys, "moreau/fixed", h, 0.0, 0.0);
    need(status, status ? tribo_system_message(sys) : NULL);
    double *y = need_memory(tribo_system_dimension(sys), sizeof *y), *full = need_memory(x->s.ndof, sizeof *full), t = 0.0;
    for (size_t i = 0; i < tribo_system_dimension(sys); i++) {
        y[i] = 0.0;
    }
    double begin = cpu_seconds();
    for (int k = 0; k < STEPS; k++) {
        const int failed = tribo_driver_advance(drv, &t, h * (k + 1), y);
        need(failed, failed ? tribo_driver_message(drv) : NULL);
        if (reduced) {
            need(tribo_system_expand(sys, y, full), NULL);
        }
        place[k] = reduced ? full[x->load] : y[x->load];
        if (k == 0) {
            printf("%s first step %.2f s\n", reduced ? "reduced" : "whole", cpu_seconds() - begin);
            begin = cpu_seconds();
        }
    }
    printf("%s step %.3f ms\n", reduced ? "reduced" : "whole", 1e3 * (cpu_seconds() - begin) / (STEPS - 1));
    printf("%s held %.0f MB\n", reduced ? "reduced" : "whole", memory_held() - before);
    tribo_driver_destroy(drv);
    free(y);
    free(full);
}

static void run(const struct scene *x, size_t modes, double *place)
{
    const char *name = modes ? "reduced" : "whole";
    const double before = memory_begin(), begin = cpu_seconds();
    tribo_system *sys = create(x, modes);
    printf("%s system %.2f s\n", name, cpu_seconds() - begin);
    march(sys, x, modes > 0, before, place);
    printf("%s memory %.0f MB\n", name, memory_peak() - before);
    tribo_system_destroy(sys);
}

static double difference(const double *a, const double *b)
{
    double most = 0.0, size = 0.0;
    for (int k = 0; k < STEPS; k++) {
        most = fmax(most, fabs(a[k] - b[k]));
        size = fmax(size, fabs(a[k]));
    }
    return most / size;
}

int main(int argc, char **argv)
{
    program = "bench_whole";
    gsl_set_error_handler_off(); /* as read_structure expects */
    if (argc != 6) {
        die("usage: bench_whole mass stiffness dofs contacts modes");
    }
    struct scene x = {.s = read_structure(argv[1], argv[2], argv[3]), .contacts = strtoul(argv[4], NULL, 10), .hz = 40.0};
    const size_t modes = strtoul(argv[5], NULL, 10);
    double whole[STEPS], reduced[STEPS];
    x.limit = 0.5;
    spread_contacts(&x);
    printf("ndof %zu\n", x.s.ndof);
    run(&x, 0, whole);
    if (modes) {
        run(&x, modes, reduced);
        printf("difference %.1e\n", difference(whole, reduced));
    }
    free(x.at);
    free_structure(&x.s);
    return modes && !(difference(whole, reduced) <= SAME);
}
