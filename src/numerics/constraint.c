/* SPDX-License-Identifier: BSD-3-Clause */
#include "constraint.h"
#include "common/layout.h"
#include "common/real.h"
#include "common/simd.h"
#include "linalg.h"
#include "union_find.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An entry below this part of the terms that it is the sum of is rounding. */
#define ROUNDING (16.0 * DBL_EPSILON)

/* sqrt(mass) of a degree of freedom without mass, in parts of the smallest sqrt(mass) of a tie. */
#define NO_MASS 1e-8

/* The rows of constraints and their ties; and Gaussian elimination of a tie in tie->entry: rows and columns below tie->rank have
 * pivots. */
struct elimination {
    const struct matrix *direction, *mass;
    const size_t *row;         /* [count] */
    const unsigned char *last; /* [count] */
    const size_t *place;       /* [cols] place in tie->dof, plus tie->rows */
    struct tie *tie;
    double *size;   /* [rows][touched] sum of the sizes of an entry's terms */
    double *weight; /* [touched] 1/sqrt(mass) */
    double *scale;  /* [rows] 1/(largest weighted entry of the row at the beginning) */
    double *most;   /* [rows] largest weighted entry of the row beside the pivots */
    double zero;    /* an entry below this part of its size counts as 0 */
};

void tribo_constraints_free(struct constraints *c)
{
    free(c->memory[0]);
    free(c->memory[1]);
    memset(c, 0, sizeof *c);
}

/* --------------------------------------------------------------------------------------------------------- elimination */

/* Returns the weighted size of an entry, 0 if the entry counts as 0. */
static inline double weighted(const struct elimination *e, size_t i, size_t column)
{
    const size_t at = i * e->tie->stride + column;
    const double x = fabs(e->tie->entry[at]), y = x * e->weight[column];
    return x > e->zero * e->size[at] ? y : 0.0;
}

/* Returns the largest weighted entry of row i beside the pivots. */
static double find_most(const struct elimination *e, size_t i)
{
    double most = 0.0;
    for (size_t l = e->tie->rank; l < e->tie->touched; l++) {
        most = greater(most, weighted(e, i, l));
    }
    return most;
}

/* Returns the row of the next pivot, one of the smallest last, or rows if there is none. */
static size_t find_pivot(const struct elimination *e)
{
    const struct tie *tie = e->tie;
    size_t found = tie->rows;
    double best = 0.0;
    for (size_t i = tie->rank; i < tie->rows; i++) {
        const double pivot = e->scale[i] * e->most[i];
        const int wait = found < tie->rows && e->last ? e->last[tie->order[i]] - e->last[tie->order[found]] : 0;
        if (e->most[i] > 0.0 && (found == tie->rows || wait < 0 || (wait == 0 && pivot > best))) {
            found = i;
            best = pivot;
        }
    }
    return found;
}

static void exchange_indices(size_t *list, size_t i, size_t k)
{
    const size_t x = list[i];
    list[i] = list[k];
    list[k] = x;
}

/* row -= factor from, entries first to end - 1; an entry that is rounding becomes 0. */
TRIBO_SIMD static void eliminate(double *restrict row, double *restrict size, const double *restrict from, double factor,
                                 size_t first, size_t end)
{
    for (size_t l = first; l < end; l++) {
        const double part = factor * from[l], left = row[l] - part;
        size[l] += fabs(part);
        row[l] = fabs(left) > ROUNDING * size[l] ? left : 0.0;
    }
}

/* Fills the entries of the tie, size, weight and scale. */
static void fill(struct elimination *e)
{
    const struct tie *tie = e->tie;
    const struct matrix *j = e->direction;
    const size_t t = tie->touched;
    double lightest = DBL_MIN;
    memset(tie->entry, 0, tie->rows * tie->stride * sizeof *tie->entry);
    for (size_t l = 0; l < t; l++) {
        const double mass = e->mass->rows ? tribo_matrix_get(e->mass, tie->dof[l], tie->dof[l]) : 1.0;
        e->weight[l] = mass > 0.0 ? 1.0 / sqrt(mass) : 0.0;
        lightest = greater(lightest, e->weight[l]);
    }
    for (size_t l = 0; l < t; l++) {
        e->weight[l] = e->weight[l] > 0.0 ? e->weight[l] : lightest / NO_MASS;
    }
    for (size_t p = 0; p < tie->rows; p++) {
        const size_t row = e->row[tie->order[p]];
        double most = 0.0, *entry = tie->entry + p * tie->stride;
        for (size_t k = j->first[row]; k < j->first[row + 1]; k++) {
            const size_t l = e->place[j->col[k]] - tie->rows;
            entry[l] = j->val[k];
            most = greater(most, fabs(entry[l]) * e->weight[l]);
        }
        if (t < tie->stride) {
            entry[t + p] = 1.0;
        }
        e->scale[p] = most > 0.0 ? 1.0 / most : 0.0; /* a row of zeros has no pivot */
    }
    for (size_t k = 0; k < tie->rows * tie->stride; k++) {
        e->size[k] = fabs(tie->entry[k]);
    }
}

/* Eliminates the slaves by complete pivoting from the rows below their pivots; for W also, backwards, from the rows above. Leaves
 * the eliminated entries. */
static void eliminate_tie(struct elimination *e)
{
    struct tie *tie = e->tie;
    const size_t t = tie->touched, stride = tie->stride;
    const int inverts = t < stride;
    for (size_t i = 0; i < tie->rows; i++) {
        e->most[i] = find_most(e, i);
    }
    for (size_t p = find_pivot(e); p < tie->rows; p = find_pivot(e)) {
        const size_t to = tie->rank++;
        size_t column = to;
        while (!(weighted(e, p, column) >= e->most[p])) {
            column++;
        }
        double *const array[] = {tie->entry, e->size};
        for (size_t k = 0; k < 2; k++) {
            tribo_exchange(array[k] + to * stride, array[k] + p * stride, stride, 1);
            tribo_exchange(array[k] + to, array[k] + column, tie->rows, stride);
            tribo_exchange(array[k] + t + to, array[k] + t + p, inverts ? tie->rows : 0, stride);
        }
        tribo_exchange(e->weight + to, e->weight + column, 1, 1);
        tribo_exchange(e->scale + to, e->scale + p, 1, 1);
        tribo_exchange(e->most + to, e->most + p, 1, 1);
        exchange_indices(tie->order, to, p);
        exchange_indices(tie->dof, to, column);
        const double *from = tie->entry + to * stride;
        for (size_t i = tie->rank; i < tie->rows; i++) {
            double *row = tie->entry + i * stride;
            if (row[to] != 0.0) {
                eliminate(row, e->size + i * stride, from, row[to] / from[to], tie->rank, stride);
                e->most[i] = find_most(e, i);
            }
        }
    }
    for (size_t p = tie->rank; inverts && p-- > 0;) {
        double *from = tie->entry + p * stride;
        for (size_t l = p + 1; l < stride; l++) {
            from[l] /= from[p];
        }
        for (size_t i = 0; i < p; i++) {
            double *row = tie->entry + i * stride;
            if (row[p] != 0.0) {
                eliminate(row, e->size + i * stride, from, row[p], tie->rank, stride);
            }
        }
    }
}

/* Sets the entries of a tie of one row with one degree of freedom, as fill and eliminate_tie do. */
static void invert_one(const struct elimination *e)
{
    struct tie *tie = e->tie;
    const double entry = e->direction->val[e->direction->first[e->row[tie->order[0]]]];
    tie->rank = entry != 0.0;
    tie->entry[0] = entry;
    if (tie->rank && tie->stride > 1) {
        tie->entry[1] = 1.0 / entry;
    }
}

/* Finds the ties, sets of rows and of degrees of freedom, which come behind all rows. Returns 1, or 0 if out of memory. */
static int find_ties(struct elimination *e, struct constraints *c)
{
    const struct matrix *j = e->direction;
    const size_t count = c->count, all = count + j->cols;
    size_t *parent, *chosen, *of, *place, *first, *member;
    c->memory[0] = ALLOCATE(ARRAY(c->tie, count), ARRAY(c->order, count), ARRAY(parent, all), ARRAY(chosen, all), ARRAY(of, all),
                            ARRAY(place, all), ARRAY(first, all + 1), ARRAY(member, all));
    if (!c->memory[0]) {
        return 0;
    }
    for (size_t k = 0; k < all; k++) {
        parent[k] = k;
        chosen[k] = k < count ? 2 : 0;
    }
    for (size_t p = 0; p < count; p++) {
        for (size_t k = j->first[e->row[p]]; k < j->first[e->row[p] + 1]; k++) {
            tribo_join(parent, p, count + j->col[k]);
        }
    }
    c->ties = tribo_list_sets(all, parent, chosen, of, place, first, member);
    for (size_t t = 0; t < c->ties; t++) {
        struct tie *tie = &c->tie[t];
        tie->order = member + first[t];
        for (size_t k = first[t]; k < first[t + 1]; k++) {
            tie->rows += member[k] < count;
            member[k] -= member[k] < count ? 0 : count;
        }
        tie->dof = tie->order + tie->rows;
        tie->touched = first[t + 1] - first[t] - tie->rows;
    }
    e->place = place + count;
    return 1;
}

int tribo_constraints_create(struct constraints *c, const struct matrix *direction, const struct matrix *mass, const size_t *row,
                             size_t count, const unsigned char *last)
{
    struct elimination e = {.direction = direction, .mass = mass, .row = row, .last = last};
    size_t rows = 0, touched = 0, area = 0, entries = 0, independent = 0;
    *c = (struct constraints){.count = count};
    if (count == 0 || !find_ties(&e, c)) {
        return count == 0;
    }
    for (size_t t = 0; t < c->ties; t++) {
        struct tie *const tie = &c->tie[t];
        tie->stride = tie->touched + (last ? 0 : tie->rows);
        rows = tie->rows > rows ? tie->rows : rows;
        touched = tie->touched > touched ? tie->touched : touched;
        area = tie->rows * tie->stride > area ? tie->rows * tie->stride : area;
        entries += tie->rows * tie->stride;
    }
    double *entry;
    c->memory[1] =
        ALLOCATE(ARRAY(entry, entries), ARRAY(e.size, area), ARRAY(e.weight, touched), ARRAY(e.scale, rows), ARRAY(e.most, rows));
    if (!c->memory[1]) {
        return 0;
    }
    for (size_t k = 0; k < c->ties; k++) {
        e.tie = &c->tie[k];
        e.tie->entry = entry;
        entry += e.tie->rows * e.tie->stride;
        e.zero = last ? sqrt(4.0 * (double)(e.tie->rows + 4) * DBL_EPSILON) : ROUNDING;
        if (e.tie->rows == 1 && e.tie->touched == 1) {
            invert_one(&e);
        } else {
            fill(&e);
            eliminate_tie(&e);
        }
        c->rank += e.tie->rank;
    }
    size_t other = c->rank;
    for (size_t k = 0; k < c->ties; k++) {
        for (size_t p = 0; p < c->tie[k].rows; p++) {
            c->order[p < c->tie[k].rank ? independent++ : other++] = c->tie[k].order[p];
        }
    }
    return 1;
}

size_t tribo_constraints_rank(const struct matrix *direction, const struct matrix *mass)
{
    const size_t n = direction->rows;
    struct constraints c = {0};
    size_t *all = tribo_zeros(n + n / sizeof *all + 1, sizeof *all);
    for (size_t i = 0; all && i < n; i++) {
        all[i] = i;
    }
    const int done = all && tribo_constraints_create(&c, direction, mass, all, n, (const unsigned char *)(all + n));
    const size_t rank = done ? c.rank : n + 1;
    tribo_constraints_free(&c);
    free(all);
    return rank;
}

/* ----------------------------------------------------------------------------------------------- displacements, forces */

int tribo_constraints_basis(const struct constraints *c, size_t ndof, struct matrix *z)
{
    struct triplets t = {0};
    size_t masters = 0, *number = calloc(ndof + 1, sizeof *number); /* [ndof] the column of a master, ndof of a slave */
    if (!number) {
        return 0;
    }
    for (size_t k = 0; k < c->ties; k++) {
        for (size_t p = 0; p < c->tie[k].rank; p++) {
            number[c->tie[k].dof[p]] = ndof;
        }
    }
    for (size_t d = 0; d < ndof; d++) {
        if (number[d] == 0) {
            number[d] = masters++;
            tribo_triplets_put(&t, d, number[d], 1.0);
        }
    }
    for (size_t i = 0; i < c->ties; i++) {
        const struct tie *const tie = &c->tie[i];
        for (size_t p = 0; p < tie->rank; p++) {
            for (size_t k = tie->rank; k < tie->touched; k++) {
                tribo_triplets_put(&t, tie->dof[p], number[tie->dof[k]], -tie->entry[p * tie->stride + k]);
            }
        }
    }
    free(number);
    return tribo_triplets_finish(&t, ndof, masters, z);
}

void tribo_constraints_follow(const struct constraints *c, const double *b, double *q)
{
    for (size_t i = 0; i < c->ties; i++) {
        const struct tie *const tie = &c->tie[i];
        for (size_t p = 0; p < tie->rank; p++) {
            const double *inverse = tie->entry + p * tie->stride + tie->touched;
            for (size_t k = 0; k < tie->rank; k++) {
                q[tie->dof[p]] += inverse[k] * b[tie->order[k]];
            }
        }
    }
}

void tribo_constraints_react(const struct constraints *c, const size_t *rows, size_t columns, const double *force, double *f)
{
    memset(f, 0, c->count * columns * sizeof *f);
    for (size_t i = 0; i < c->ties; i++) {
        const struct tie *const tie = &c->tie[i];
        for (size_t p = 0; p < tie->rank; p++) {
            const double *inverse = tie->entry + p * tie->stride + tie->touched;
            const size_t d = tie->dof[p];
            for (size_t k = 0; rows[0] <= d && d < rows[1] && k < tie->rank; k++) {
                tribo_add(f + tie->order[k] * columns, inverse[k], force + (d - rows[0]) * columns, columns);
            }
        }
    }
}
