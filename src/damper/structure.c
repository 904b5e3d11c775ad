/* SPDX-License-Identifier: BSD-3-Clause */
#include "structure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "output.h"
#include "text.h"

struct structure read_structure(const char *mass, const char *stiffness, const char *dofs)
{
    struct structure s = {0};
    s.dof = read_degrees(dofs, &s.ndof);
    const struct rows rows = {s.ndof, dofs};
    s.mass = read_matrix(mass, &rows);
    s.stiffness = read_matrix(stiffness, &rows);
    return s;
}

void free_structure(struct structure *s)
{
    free_sparse(&s->mass);
    free_sparse(&s->stiffness);
    free_sparse(&s->damping);
    free(s->dof);
}

void report_loose_rows(const struct structure *s, const char *stiffness)
{
    char *held = need_memory(s->ndof, sizeof *held);
    size_t loose = 0, first = 0;
    for (size_t k = 0; k < s->stiffness.first[s->ndof]; k++) {
        held[s->stiffness.col[k]] |= s->stiffness.val[k] != 0.0;
    }
    for (size_t i = s->ndof; i-- > 0;) {
        loose += !held[i];
        first = held[i] ? first : i;
    }
    free(held);
    if (loose) {
        const struct degree *d = &s->dof[first];
        printf("%s: no stiffness holds row %zu (node %zu, direction %c)", stiffness, d->row, d->node, "xyz"[d->direction - 1]);
        printf(loose > 1 ? ", and %zu others\n" : "\n", loose - 1);
    }
}

static double distance_to(const struct degree *d, const double *at)
{
    return hypot(hypot(d->at[0] - at[0], d->at[1] - at[1]), d->at[2] - at[2]);
}

size_t find_degree(const struct structure *s, const struct place *p)
{
    const double origin[3] = {0.0, 0.0, 0.0};
    double size = 0.0;
    size_t nearest = 0, found = s->ndof;
    for (size_t i = 0; i < s->ndof; i++) {
        size = fmax(size, distance_to(&s->dof[i], origin));
        nearest = distance_to(&s->dof[i], p->at) < distance_to(&s->dof[nearest], p->at) ? i : nearest;
    }
    const double *at = s->dof[nearest].at;
    die_if(!(distance_to(&s->dof[nearest], p->at) <= 1e-6 * size), "%s: no free node is there; the nearest is at %g,%g,%g",
           p->origin, at[0], at[1], at[2]);
    for (size_t i = 0; i < s->ndof; i++) {
        if (s->dof[i].direction != p->direction || distance_to(&s->dof[i], p->at) > 1e-6 * size) {
            continue;
        }
        die_if(found < s->ndof, "%s: two rows are there, %zu (node %zu) and %zu (node %zu)", p->origin, s->dof[found].row,
               s->dof[found].node, s->dof[i].row, s->dof[i].node);
        found = i;
    }
    die_if(found == s->ndof, "%s: the node there cannot move along %c", p->origin, "xyz"[p->direction - 1]);
    return found;
}

size_t read_frequencies(const char *path, double *hz, size_t room)
{
    struct text t = open_text(path);
    size_t count = 0;
    while (next_data(&t)) {
        const double value = next_real(&t, "frequency", "");
        die_at_if(&t, value <= 0.0, "frequency %g is not positive", value);
        if (count < room) {
            hz[count++] = value;
        }
    }
    return count;
}
