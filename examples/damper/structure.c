#include "structure.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

#include "lines.h"
#include "matrix_market.h"

/* One line; rows may come in any order. */
static struct degree read_degree(struct lines *l)
{
    struct degree d = {.line = l->line};
    d.row = next_whole(l, "row", 1, INT_MAX);
    d.node = next_whole(l, "node", 0, INT_MAX);
    d.direction = (int)next_whole(l, "direction", 1, 3);
    for (int i = 0; i < 3; i++) {
        d.at[i] = next_real(l, (const char *[]){"coordinate x", "coordinate y", "coordinate z"}[i]);
    }
    expect_end(l);
    return d;
}

static int compare_rows(const void *a, const void *b)
{
    const struct degree *x = a, *y = b;
    return x->row != y->row ? (x->row < y->row ? -1 : 1) : (x->line > y->line) - (x->line < y->line);
}

static void read_degrees(struct structure *s, const char *path)
{
    struct lines l = open_lines(path);
    size_t room = 0;
    while (next_data(&l)) {
        s->dof = need_room(s->dof, s->ndof, &room, sizeof *s->dof);
        s->dof[s->ndof++] = read_degree(&l);
    }
    close_lines(&l);
    if (s->ndof == 0) {
        die("%s: there is no degree of freedom in it", path);
    }
    qsort(s->dof, s->ndof, sizeof *s->dof, compare_rows);
    for (size_t i = 0; i < s->ndof; i++) {
        const struct degree *d = &s->dof[i];
        if (d->row <= i) {
            die("%s:%zu: row %zu has been given in line %zu", path, d->line, d->row, d[-1].line);
        }
        if (d->row > i + 1) {
            die("%s:%zu: row %zu, but there is no row %zu", path, d->line, d->row, i + 1);
        }
    }
}

struct structure read_structure(const char *mass, const char *stiffness, const char *dofs)
{
    struct structure s = {0};
    read_degrees(&s, dofs);
    s.mass = read_matrix(mass, s.ndof);
    s.stiffness = read_matrix(stiffness, s.ndof);
    return s;
}

void free_structure(struct structure *s)
{
    gsl_spmatrix_free(s->mass);
    gsl_spmatrix_free(s->stiffness);
    free(s->dof);
}

static double distance(const struct degree *d, const double *at)
{
    return hypot(hypot(d->at[0] - at[0], d->at[1] - at[1]), d->at[2] - at[2]);
}

size_t find_degree(const struct structure *s, const struct place *p)
{
    const double origin[3] = {0.0, 0.0, 0.0};
    double size = 0.0;
    size_t nearest = 0, found = s->ndof;
    for (size_t i = 0; i < s->ndof; i++) {
        size = fmax(size, distance(&s->dof[i], origin));
        nearest = distance(&s->dof[i], p->at) < distance(&s->dof[nearest], p->at) ? i : nearest;
    }
    const double *at = s->dof[nearest].at;
    if (!(distance(&s->dof[nearest], p->at) <= 1e-6 * size)) {
        die("%s: no free node is there; the nearest is at %g,%g,%g", p->origin, at[0], at[1], at[2]);
    }
    for (size_t i = 0; i < s->ndof; i++) {
        if (s->dof[i].direction != p->direction || distance(&s->dof[i], p->at) > 1e-6 * size) {
            continue;
        }
        if (found < s->ndof) {
            die("%s: two rows are there, %zu (node %zu) and %zu (node %zu)", p->origin, s->dof[found].row, s->dof[found].node,
                s->dof[i].row, s->dof[i].node);
        }
        found = i;
    }
    if (found == s->ndof) {
        die("%s: the node there cannot move along %c", p->origin, "xyz"[p->direction - 1]);
    }
    return found;
}

size_t read_frequencies(const char *path, double *hz, size_t room)
{
    struct lines l = open_lines(path);
    size_t count = 0;
    while (next_data(&l)) {
        const double value = next_real(&l, "frequency");
        expect_end(&l);
        if (value <= 0.0) {
            die_at(&l, "frequency %g is not positive", value);
        }
        if (count < room) {
            hz[count++] = value;
        }
    }
    close_lines(&l);
    return count;
}
