/* SPDX-License-Identifier: BSD-3-Clause */
/* The sparse factor by itself: a solution with it has the residual of rounding, which the solver around it would otherwise mend
 * by taking more rounds. */
#include <stdlib.h>
#include <string.h>

#include "numerics/box/box_qp.h"
#include "numerics/csr.h"
#include "support.h"

/* A carpet of contacts that feel those next to them: `reach` to each side in a row, one in the rows before and behind. */
static struct csr carpet(size_t width, size_t height, size_t reach)
{
    const size_t n = width * height;
    struct csr r;
    require(tribo_csr_create(&r, n, (2 * reach + 3) * n), "no memory");
    size_t k = 0;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = i > width ? i - width : 0; j < n && j <= i + width; j++) {
            const size_t apart = j > i ? j - i : i - j;
            const int beside = apart <= reach && i / width == j / width;
            if (beside || apart == width) {
                r.col[k] = j;
                r.val[k++] = j == i ? 2.0 * (double)(reach + 1) + 0.1 : -1.0;
            }
        }
        r.first[i + 1] = k;
    }
    return r;
}

/* A group of its own with all the room that it needs. */
struct workshop {
    struct group group;
    struct sets sets;
    struct box_qp p;
    double *values;
    size_t *places;
    signed char *at;
};

static void open(struct workshop *w, const struct csr *r)
{
    const size_t n = r->n;
    *w = (struct workshop){.group = {.size = n}};
    require(tribo_sparse_create(&w->group.sparse, r) && w->group.sparse, "no sparse factor");
    w->values = calloc(tribo_sparse_slots(w->group.sparse) + 4 * n, sizeof *w->values);
    w->places = malloc(2 * n * sizeof *w->places);
    w->at = malloc(n);
    require(w->values && w->places && w->at, "no memory");
    double *scale = w->values + 3 * n;
    for (size_t i = 0; i < n; i++) {
        scale[i] = 1.0;
    }
    w->p = (struct box_qp){.group = &w->group,
                           .sets = &w->sets,
                           .scale = scale,
                           .at = w->at,
                           .row = w->values + 2 * n,
                           .order = w->places + n,
                           .sparse = {.l = w->values + 4 * n, .d = w->values, .w = w->values + n, .index = w->places}};
}

static void close(struct workshop *w)
{
    tribo_sparse_free(w->group.sparse);
    free(w->values);
    free(w->places);
    free(w->at);
}

/* Carpets of several shapes, with all, most or few contacts in the factor. */
TEST(residual)
{
    static const size_t shape[][3] = {{400, 1, 1}, {20, 20, 1}, {60, 60, 1}, {12, 40, 5}, {200, 3, 2}};
    const double share[] = {1.0, 0.9, 0.5, 0.1};
    const size_t *s = shape[_i % (int)COUNT(shape)];
    struct random g = random_of(_i);
    struct csr r = carpet(s[0], s[1], s[2]);
    struct workshop w;
    double *x = malloc(2 * r.n * sizeof *x), *want = x + r.n;
    require(x, "no memory");
    open(&w, &r);
    for (int round = 0; round < 3; round++) {
        for (size_t i = 0; i < r.n; i++) {
            w.at[i] = uniform(&g, 0.0, 1.0) < share[_i % (int)COUNT(share)] ? FREE : AT_UPPER;
            want[i] = w.at[i] == FREE ? uniform(&g, -1.0, 1.0) : 0.0;
        }
        size_t free_ones = 0, where = 0;
        for (size_t i = 0; i < r.n; i++) {
            double size;
            x[i] = w.at[i] == FREE ? tribo_sparse_dot(&w.p, i, want, &size) : 0.0;
            free_ones += w.at[i] == FREE;
        }
        assert_exact(tribo_sparse_rebuild(&w.p, &where), 0.0);
        ck_assert_uint_eq(w.sets.rank, free_ones);
        tribo_sparse_solve(&w.p, x);
        assert_all_close(x, want, r.n, 1e-13 * (double)(s[2] + 1));
    }
    close(&w);
    tribo_csr_free(&r);
    free(x);
}
END_TEST

TEST_MAIN("factor", {residual, 20})
