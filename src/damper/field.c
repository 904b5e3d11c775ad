/* SPDX-License-Identifier: BSD-3-Clause */
#include "tables.h"

#include <stdlib.h>
#include <string.h>

#include "output.h"

static int by_node(const void *a, const void *b)
{
    const struct degree *x = *(const struct degree *const *)a, *y = *(const struct degree *const *)b;
    return x->node != y->node ? (x->node < y->node ? -1 : 1) : (x->row > y->row) - (x->row < y->row);
}

void write_field(const struct tables *t, const struct structure *s, const struct list *phases, struct worker *w,
                 const struct motion *m, const double *y, const char *what)
{
    const size_t n = s->ndof;
    const struct degree **row = need_memory(n, sizeof *row);
    double *state = need_memory(w->dimension, sizeof *state), *full = need_memory(n, sizeof *full);
    size_t nodes = 0;
    for (size_t i = 0; i < n; i++) {
        row[i] = &s->dof[i];
    }
    qsort(row, n, sizeof *row, by_node);
    for (size_t i = 0; i < n; i++) {
        nodes += i == 0 || row[i]->node != row[i - 1]->node;
    }
    FILE *file = create_table(t, what, "vtk");
    fprintf(file, "# vtk DataFile Version 3.0\n%s: %s %.6g, %.8g Hz\nASCII\nDATASET POLYDATA\nPOINTS %zu double\n", program,
            t->limit, m->limit, m->hz, nodes);
    for (size_t i = 0; i < n; i++) {
        if (i == 0 || row[i]->node != row[i - 1]->node) {
            fprintf(file, "%.10g %.10g %.10g\n", row[i]->at[0], row[i]->at[1], row[i]->at[2]);
        }
    }
    fprintf(file, "VERTICES %zu %zu\n", nodes, 2 * nodes);
    for (size_t i = 0; i < nodes; i++) {
        fprintf(file, "1 %zu\n", i);
    }
    fprintf(file, "POINT_DATA %zu\n", nodes);
    for (size_t k = 0; k < phases->count; k++) {
        double now = 0.0, u[3] = {0.0, 0.0, 0.0};
        tribo_driver *drv = driver_at(w, m->limit, m->hz);
        memcpy(state, y, w->dimension * sizeof *state);
        need(tribo_driver_advance(drv, &now, phases->value[k] / 360.0 / m->hz, state), tribo_driver_message(drv));
        need(tribo_system_expand(w->d->reduced, state, full), NULL);
        fprintf(file, "VECTORS displacement_%g double\n", phases->value[k]);
        for (size_t i = 0; i < n; i++) {
            u[row[i]->direction - 1] = full[row[i] - s->dof];
            if (i + 1 == n || row[i]->node != row[i + 1]->node) {
                fprintf(file, "%.8g %.8g %.8g\n", u[0], u[1], u[2]);
                u[0] = u[1] = u[2] = 0.0;
            }
        }
    }
    close_table(t, file, what, "vtk");
    free(row);
    free(state);
    free(full);
}
