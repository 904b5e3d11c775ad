/* SPDX-License-Identifier: BSD-3-Clause */
#include "degrees.h"

#include <limits.h>
#include <stdlib.h>

#include "calculix.h"
#include "lines.h"

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

static void check_rows(const char *path, const struct degree *dof, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const struct degree *d = &dof[i];
        if (d->row <= i) {
            die("%s:%zu: row %zu has been given in line %zu", path, d->line, d->row, d[-1].line);
        }
        if (d->row > i + 1) {
            die("%s:%zu: row %zu, but there is no row %zu", path, d->line, d->row, i + 1);
        }
    }
}

struct degree *read_degrees(const char *path, size_t *count)
{
    struct lines l = open_lines(path);
    struct degree *dof = NULL;
    const int calculix = is_named(path, ".dof");
    size_t room = 0, n = 0;
    for (; next_data(&l); n++) {
        dof = need_room(dof, n, &room, sizeof *dof);
        dof[n] = calculix ? read_calculix_degree(&l, n + 1) : read_degree(&l);
    }
    close_lines(&l);
    if (n == 0) {
        die("%s: there is no degree of freedom in it", path);
    }
    if (calculix) {
        find_calculix_places(path, dof, n);
    } else {
        qsort(dof, n, sizeof *dof, compare_rows);
        check_rows(path, dof, n);
    }
    *count = n;
    return dof;
}
