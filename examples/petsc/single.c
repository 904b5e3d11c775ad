/* SPDX-License-Identifier: BSD-3-Clause */
/* What chain.c and structure.c do, by the drivers of libtribo_gsl in one process; tests compare them.
 *   single chain METHOD BLOCKS STEPS CYCLES ALPHA
 *   single structure MASS STIFFNESS CONTACTS ROWS LOAD_ROW LOAD OMEGA DAMPING STEP STEPS EVERY
 * Prints the same lines. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../src/damper/matrix.h"
#include "../../src/damper/text.h"
#include "tribo/tribo_gsl.h"

enum { MAX_CONTACTS = 64 };

static void chain(char **argument)
{
    const size_t n = (size_t)atol(argument[1]), cycles = (size_t)atol(argument[3]);
    const double omega = 0.5, period = 2.0 * acos(-1.0) / omega, dt = period / atof(argument[2]);
    tribo_system *sys;
    tribo_driver *drv;
    need(tribo_system_chain(&sys, n, 1.0, atof(argument[4]), omega), NULL);
    tribo_context *contacts = tribo_system_context(sys);
    need(tribo_set_epsilon_step(contacts, dt, 0.4), tribo_message(contacts));
    need(tribo_driver_create(&drv, sys, argument[0]), tribo_system_message(sys));
    need(tribo_driver_set_step(drv, dt), tribo_driver_message(drv));
    double *y = need_memory(2 * n + 1, sizeof *y), t = 0.0;
    memset(y, 0, (2 * n + 1) * sizeof *y);
    for (size_t k = 1; k <= cycles; k++) {
        const double before = y[2 * n];
        need(tribo_driver_advance(drv, &t, (double)k * period, y), tribo_driver_message(drv));
        printf("cycle %zu dissipates %.13g\n", k, y[2 * n] - before);
    }
    free(y);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Contacts "row other limit" a line: directions in compressed rows; other: 0 for the ground. */
struct row_contacts {
    size_t count, first[MAX_CONTACTS + 1], col[2 * MAX_CONTACTS];
    double val[2 * MAX_CONTACTS], limit[MAX_CONTACTS];
};

static struct row_contacts read_row_contacts(const char *path, size_t rows)
{
    struct row_contacts c = {0};
    struct text t = open_text(path);
    for (size_t k = 0; next_data(&t); c.first[++c.count] = k) {
        die_at_if(&t, c.count == MAX_CONTACTS, "more than %d contacts", (int)MAX_CONTACTS);
        c.col[k] = next_whole(&t, "row", " ", 1, rows) - 1;
        c.val[k++] = 1.0;
        const size_t other = next_whole(&t, "other row", " ", 0, rows);
        if (other) {
            c.col[k] = other - 1;
            c.val[k++] = -1.0;
        }
        c.limit[c.count] = next_real(&t, "limit", "");
    }
    return c;
}

/* In all of its modes, where stiff ones leave no rounding in the forces of soft ones; with damping, as it is. */
static tribo_system *read_system(char **file, size_t n, double damping)
{
    tribo_system *sys;
    tribo_model *model = NULL;
    const struct rows rows = {n, "the arguments"};
    const struct row_contacts contacts = read_row_contacts(file[2], n);
    struct sparse m = read_matrix(file[0], &rows), k = read_matrix(file[1], &rows);
    need(tribo_model_create(&model, n, contacts.count), NULL);
    need(tribo_model_set_mass_csr(model, m.first, m.col, m.val), tribo_model_message(model));
    need(tribo_model_set_stiffness_csr(model, k.first, k.col, k.val), tribo_model_message(model));
    need(tribo_model_set_direction_csr(model, contacts.first, contacts.col, contacts.val), tribo_model_message(model));
    if (damping > 0.0) {
        for (size_t i = 0; i < k.first[n]; i++) {
            k.val[i] *= damping;
        }
        need(tribo_model_set_damping_csr(model, k.first, k.col, k.val), tribo_model_message(model));
    }
    need(damping > 0.0 ? tribo_system_create(&sys, model) : tribo_system_reduce(&sys, model, n, TRIBO_STATICS_NONE),
         tribo_model_message(model));
    need(tribo_set_limit(tribo_system_context(sys), contacts.limit), tribo_message(tribo_system_context(sys)));
    tribo_model_destroy(model);
    free_sparse(&m);
    free_sparse(&k);
    return sys;
}

static void expand(const tribo_system *sys, int reduced, const double *from, double *to)
{
    if (reduced) {
        need(tribo_system_expand(sys, from, to), NULL);
    } else {
        memcpy(to, from, tribo_system_ndof(sys) * sizeof *to);
    }
}

static double norm(const double *x, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += x[i] * x[i];
    }
    return sqrt(sum);
}

static void structure(char **argument)
{
    const size_t n = (size_t)atol(argument[3]), row = (size_t)atol(argument[4]) - 1;
    const double load = atof(argument[5]), omega = atof(argument[6]), damping = atof(argument[7]), h = atof(argument[8]);
    const long steps = atol(argument[9]), every = atol(argument[10]);
    tribo_system *sys = read_system(argument, n, damping);
    tribo_driver *drv;
    double *pattern = need_memory(n, sizeof *pattern), *y = need_memory(2 * n + 1, sizeof *y), *q = need_memory(n, sizeof *q),
           *u = need_memory(n, sizeof *u), t = 0.0;
    memset(pattern, 0, n * sizeof *pattern);
    memset(y, 0, (2 * n + 1) * sizeof *y);
    pattern[row] = load;
    need(tribo_system_add_load(sys, omega, NULL, pattern), tribo_system_message(sys));
    need(tribo_driver_create(&drv, sys, "moreau/fixed"), tribo_system_message(sys));
    need(tribo_driver_set_step(drv, h), tribo_driver_message(drv));
    for (long k = every; k <= steps; k += every) {
        need(tribo_driver_advance(drv, &t, (double)k * h, y), tribo_driver_message(drv));
        expand(sys, damping == 0.0, y, q);
        expand(sys, damping == 0.0, y + n, u);
        printf("%.9g %.13g %.13g %.13g %.13g\n", t, q[row], norm(q, n), norm(u, n), y[2 * n]);
    }
    free(pattern);
    free(q);
    free(u);
    free(y);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

int main(int argc, char **argv)
{
    program = "single";
    if (argc == 7 && strcmp(argv[1], "chain") == 0) {
        chain(argv + 2);
    } else if (argc == 13 && strcmp(argv[1], "structure") == 0) {
        structure(argv + 2);
    } else {
        die("see the head of single.c for arguments");
    }
    return 0;
}
