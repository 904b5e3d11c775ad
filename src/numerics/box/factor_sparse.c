/* SPDX-License-Identifier: BSD-3-Clause */
/* The factor of a large group with few entries: R = L D L' over the free contacts, for an order of elimination and a pattern of L
 * that are those of R as a whole, found once. Contacts that are not in the factor have zeros there. A contact that enters or
 * leaves changes its row and column of L, and the columns on the way to the root of the elimination tree (Davis and Hager 2005,
 * SIAM J. Matrix Anal. Appl. 26, 621, doi:10.1137/S089547980343641X).
 *
 *     all anew     row by row
 *     k enters     row k likewise; column k from R and those rows; L D L' -= pivot times the square of column k, behind k
 *     k leaves     L D L' += pivot times the square of column k, behind k; row and column k become zero
 *     += a w w'    for j on the way from k to the root: a new pivot and column j; w -= its part in column j
 *
 * "Place" is the number of a contact in its group, "position" its number in the order of elimination. */
#include "box_qp.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/real.h"
#include "common/simd.h"
#include "numerics/csr.h"

#define NONE SIZE_MAX

struct sparse {
    struct csr r;      /* R by places */
    size_t *position;  /* [size] of a place */
    size_t *place;     /* [size] of a position */
    size_t *column;    /* [size + 1] column j of L has the slots column[j] to column[j + 1] - 1 */
    size_t *row_of;    /* [slots] rows, ascending in a column */
    size_t *row;       /* [size + 1] row k of L has the entries row[k] to row[k + 1] - 1 of: */
    size_t *column_of; /* [slots] columns, ascending in a row */
    size_t *slot;      /* [slots] slots */
    size_t *run;       /* [size] columns from j on of which each has the rows of the column before it but its own */
};

void tribo_sparse_free(struct sparse *s)
{
    if (s) {
        tribo_csr_free(&s->r);
        free(s->position);
        free(s->column);
        free(s->row_of);
        free(s);
    }
}

struct csr *tribo_sparse_rows(struct sparse *s)
{
    return &s->r;
}

size_t tribo_sparse_slots(const struct sparse *s)
{
    return s->column[s->r.n];
}

/* --------------------------------------------------------------------------------------------------- nested dissection
 * (George 1973): a level of a breadth-first search splits the graph of R into two sides, and is eliminated after them; each side
 * is split likewise. */

/* Parts of at most LEAF nodes are not split. */
#define LEAF 24

struct graph {
    const struct csr *r;
    size_t *node;  /* [n] the order; parts are pieces of it */
    size_t *list;  /* [n] nodes in the order of a search */
    size_t *level; /* [n] distances from its start */
    size_t *mark;  /* [n] stamp: node of the part, not found */
    size_t stamp;
};

struct part {
    size_t begin, end;
};

/* list = the nodes of the part connected with start, nearest first. Returns their number. The other nodes of the part have the
 * mark stamp. */
static size_t search_breadth_first(struct graph *g, struct part part, size_t start)
{
    size_t count = 1;
    g->stamp++;
    for (size_t k = part.begin; k < part.end; k++) {
        g->mark[g->node[k]] = g->stamp;
    }
    g->list[0] = start;
    g->level[start] = g->mark[start] = 0;
    for (size_t next = 0; next < count; next++) {
        const size_t i = g->list[next];
        for (size_t e = g->r->first[i]; e < g->r->first[i + 1]; e++) {
            const size_t j = g->r->col[e];
            if (g->mark[j] == g->stamp) {
                g->mark[j] = 0;
                g->level[j] = g->level[i] + 1;
                g->list[count++] = j;
            }
        }
    }
    return count;
}

/* Orders a part, and appends the two sides that are not in order to stack: of a part in pieces, one piece and the others. */
static void dissect(struct graph *g, struct part part, struct part *stack, size_t *depth)
{
    size_t *node = g->node + part.begin, from = 0, to = 0;
    const size_t size = part.end - part.begin;
    if (size <= LEAF) {
        return;
    }
    const size_t count = search_breadth_first(g, part, node[0]);
    if (count < size) {
        for (size_t k = 0, next = count; k < size; k++) {
            if (g->mark[node[k]] == g->stamp) {
                g->list[next++] = node[k];
            }
        }
        memcpy(node, g->list, size * sizeof *node);
        from = to = count;
    } else {
        /* A search from the far end has more and smaller levels. list[from, to) = a small level that splits the others evenly. */
        search_breadth_first(g, part, g->list[size - 1]);
        const size_t last = g->level[g->list[size - 1]];
        size_t best = SIZE_MAX;
        for (size_t k = 0; k < size;) {
            const size_t level = g->level[g->list[k]], begin = k;
            while (k < size && g->level[g->list[k]] == level) {
                k++;
            }
            const size_t behind = size - k, cost = 4 * (k - begin) + (begin > behind ? begin - behind : behind - begin);
            if (level > 0 && level < last && cost < best) {
                best = cost;
                from = begin;
                to = k;
            }
        }
        if (best == SIZE_MAX) {
            return;
        }
        memcpy(node, g->list, from * sizeof *node);
        memcpy(node + from, g->list + to, (size - to) * sizeof *node);
        memcpy(node + from + size - to, g->list + from, (to - from) * sizeof *node);
    }
    stack[(*depth)++] = (struct part){part.begin, part.begin + from};
    stack[(*depth)++] = (struct part){part.begin + from, part.begin + from + size - to};
}

/* ---------------------------------------------------------------------------------------------------------- pattern of L */

/* Walks the entries of L row by row, and counts them by columns in count [size]. Sets parent [size] of the elimination tree where
 * it is NONE; it stays NONE for roots. fill: also puts row k at the slot count[j]. seen [size] is workspace. */
static void sparse_walk(struct sparse *s, size_t *parent, size_t *seen, size_t *count, int fill)
{
    memset(seen, 0xff, s->r.n * sizeof *seen);
    for (size_t k = 0; k < s->r.n; k++) {
        const size_t i = s->place[k];
        seen[k] = k;
        for (size_t e = s->r.first[i]; e < s->r.first[i + 1]; e++) {
            for (size_t j = s->position[s->r.col[e]]; j < k && seen[j] != k; j = parent[j]) {
                seen[j] = k;
                parent[j] = parent[j] == NONE ? k : parent[j];
                if (fill) {
                    s->row_of[count[j]] = k;
                }
                count[j]++;
            }
        }
    }
}

/* Finds the pattern of L by columns and rows. work [3 size] is workspace. Returns 1; 0 if a dense factor is better; -1 if out of
 * memory. */
static int find_pattern(struct sparse *s, size_t *work)
{
    const size_t size = s->r.n;
    size_t *parent = work, *seen = work + size, *count = work + 2 * size;
    for (size_t k = 0; k < size; k++) {
        s->position[s->place[k]] = k;
        parent[k] = NONE;
        count[k] = 0;
    }
    sparse_walk(s, parent, seen, count, 0);
    for (size_t j = 0; j < size; j++) {
        s->column[j + 1] = s->column[j] + count[j];
        count[j] = s->column[j];
    }
    const size_t slots = s->column[size];
    if (slots > size * size / 8) {
        return 0;
    }
    s->row_of = malloc((3 * slots + 1) * sizeof *s->row_of);
    if (!s->row_of) {
        return -1;
    }
    s->column_of = s->row_of + slots;
    s->slot = s->row_of + 2 * slots;
    sparse_walk(s, parent, seen, count, 1);
    for (size_t q = 0; q < slots; q++) {
        s->row[s->row_of[q] + 1]++;
    }
    for (size_t j = size; j-- > 0;) {
        const size_t begin = s->column[j], end = s->column[j + 1];
        const int alike = end > begin && s->row_of[begin] == j + 1 && end - begin == s->column[j + 2] - end + 1;
        s->run[j] = alike ? s->run[j + 1] + 1 : 1;
    }
    for (size_t k = 0; k < size; k++) {
        s->row[k + 1] += s->row[k];
        count[k] = s->row[k];
    }
    for (size_t j = 0; j < size; j++) {
        for (size_t q = s->column[j]; q < s->column[j + 1]; q++) {
            const size_t t = count[s->row_of[q]]++;
            s->column_of[t] = j;
            s->slot[t] = q;
        }
    }
    return 1;
}

/* ------------------------------------------------------------------------------------------------------- rows of R */

double tribo_sparse_dot(const struct box_qp *p, size_t i, const double *x, double *size)
{
    const struct csr *r = &p->group->sparse->r;
    double sum = 0.0, all = 0.0;
    for (size_t e = r->first[i]; e < r->first[i + 1]; e++) {
        const double term = r->val[e] * x[r->col[e]];
        sum += term;
        all += fabs(term);
    }
    *size = all;
    return sum;
}

/* ------------------------------------------------------------------------------------------------------- the factor */

/* Runs of at least WIDE columns are eliminated together. */
#define WIDE 16

/* Eliminates the first columns [width] of a run from x [n]: x_i -= l_ia x_a for i = a + 1 to n - 1, column after column. The
 * entries l_ia are the n - 1 - a slots before slot_a. A column a with d_a = 0 is not in the factor, and changes nothing. */
TRIBO_SIMD static void subtract_run(const double *l, const size_t *slot, const double *d, size_t width, size_t n,
                                    double *restrict x)
{
    size_t a = 0;
    for (; a + 2 <= width; a += 2) {
        const size_t rest = n - a - 2; /* rows behind both columns; the first one begins with the row between them */
        const double *p = l + slot[a] - (rest + 1), *q = l + slot[a + 1] - rest;
        const double e = d[a] == 0.0 ? 0.0 : x[a];
        x[a + 1] -= e * p[0];
        const double f = d[a + 1] == 0.0 ? 0.0 : x[a + 1];
        for (size_t i = 0; i < rest; i++) {
            x[a + 2 + i] -= e * p[1 + i] + f * q[i];
        }
    }
    for (; a < width; a++) {
        const size_t rest = n - a - 1;
        const double *p = l + slot[a] - rest, e = d[a] == 0.0 ? 0.0 : x[a];
        for (size_t i = 0; i < rest; i++) {
            x[a + 1 + i] -= e * p[i];
        }
    }
}

/* Eliminates columns j to j + width - 1 of a run from w [size], of each column the entries before its slot [width]. x [size] is
 * workspace, zero between calls. */
static void eliminate_run(const struct box_qp *p, const size_t *slot, size_t j, size_t width, double *w, double *x)
{
    const struct sparse *s = p->group->sparse;
    const size_t begin = s->column[j + width - 1], m = slot[width - 1] - begin, *row = s->row_of + begin;
    memcpy(x, w + j, width * sizeof *x);
    for (size_t q = 0; q < m; q++) {
        x[width + q] = w[row[q]];
    }
    subtract_run(p->sparse.l, slot, p->sparse.d + j, width, width + m, x);
    memcpy(w + j, x, width * sizeof *x);
    for (size_t q = 0; q < m; q++) {
        w[row[q]] = x[width + q];
    }
    memset(x, 0, (width + m) * sizeof *x);
}

/* Computes row k of L by elimination with the rows before it in the factor. Returns its pivot. Raises *left to the largest entry
 * that elimination leaves of free contacts that are not in the factor. */
static double sparse_eliminate(const struct box_qp *p, size_t k, double *left)
{
    const struct sparse *s = p->group->sparse;
    const size_t i = s->place[k];
    double pivot = 0.0;
    for (size_t e = s->r.first[i]; e < s->r.first[i + 1]; e++) {
        const size_t j = s->position[s->r.col[e]];
        if (j <= k) {
            p->sparse.w[j] = p->scale[i] * s->r.val[e] * p->scale[s->r.col[e]];
        }
    }
    size_t done = s->row[k]; /* columns of entries before it are eliminated from w */
    for (size_t t = s->row[k]; t < s->row[k + 1]; t++) {
        const size_t j = s->column_of[t];
        if (t >= done && s->run[j] >= WIDE && k - j >= WIDE) {
            const size_t width = s->run[j] < k - j ? s->run[j] : k - j;
            eliminate_run(p, s->slot + t, j, width, p->sparse.w, p->row);
            done = t + width;
        }
        const double y = p->sparse.w[j];
        p->sparse.w[j] = 0.0;
        p->sparse.l[s->slot[t]] = y * p->sparse.d[j];
        if (p->sparse.d[j] == 0.0) {
            *left = p->at[s->place[j]] == FREE ? greater(*left, fabs(y)) : *left;
        } else if (y != 0.0) {
            for (size_t q = s->column[j]; t >= done && q < s->slot[t]; q++) {
                p->sparse.w[s->row_of[q]] -= p->sparse.l[q] * y;
            }
            pivot -= p->sparse.l[s->slot[t]] * y;
        }
    }
    pivot += p->sparse.w[k];
    p->sparse.w[k] = 0.0;
    return pivot;
}

static void sparse_clear_row(const struct box_qp *p, size_t k)
{
    const struct sparse *s = p->group->sparse;
    for (size_t t = s->row[k]; t < s->row[k + 1]; t++) {
        p->sparse.l[s->slot[t]] = 0.0;
    }
}

double tribo_sparse_rebuild(struct box_qp *p, size_t *where)
{
    const struct group *g = p->group;
    const struct sparse *s = g->sparse;
    size_t waiting = g->size; /* order[waiting ...]: dependents */
    double left = 0.0;
    p->work.factorizations++;
    p->sets->rank = 0;
    for (size_t k = 0; k < g->size; k++) {
        const size_t i = s->place[k];
        const double before = left;
        double pivot = 0.0;
        p->sparse.d[k] = 0.0;
        if (p->at[i] == FREE) {
            pivot = sparse_eliminate(p, k, &left);
            left = pivot > TRIBO_SPARSE_ZERO ? left : greater(left, fabs(pivot));
        }
        if (pivot > TRIBO_SPARSE_ZERO) {
            p->sparse.d[k] = 1.0 / pivot;
            p->order[p->sets->rank++] = i;
        } else if (p->at[i] == FREE) {
            p->order[--waiting] = i;
        } else {
            sparse_clear_row(p, k);
        }
        if (where && left > before) {
            *where = i;
        }
    }
    p->sets->dependents = g->size - waiting;
    memmove(p->order + p->sets->rank, p->order + waiting, p->sets->dependents * sizeof *p->order);
    for (size_t d = 0; d < p->sets->dependents; d++) {
        sparse_clear_row(p, s->position[p->order[p->sets->rank + d]]);
    }
    for (size_t k = 0; k < p->sets->rank + p->sets->dependents; k++) {
        p->sparse.index[p->order[k]] = k;
    }
    return left;
}

void tribo_sparse_solve(const struct box_qp *p, double *step)
{
    const struct sparse *s = p->group->sparse;
    const size_t size = p->group->size;
    double *y = p->row;
    for (size_t j = 0; j < size; j++) {
        if (s->run[j] >= WIDE) {
            const size_t behind = j + s->run[j];
            for (size_t i = j; i < behind; i++) {
                y[i] = p->sparse.d[i] == 0.0 ? 0.0 : y[i] + p->scale[s->place[i]] * step[s->place[i]];
            }
            eliminate_run(p, s->column + j + 1, j, s->run[j], y, p->sparse.w);
            j = behind - 1;
            continue;
        }
        y[j] = p->sparse.d[j] == 0.0 ? 0.0 : y[j] + p->scale[s->place[j]] * step[s->place[j]];
        for (size_t q = s->column[j]; y[j] != 0.0 && q < s->column[j + 1]; q++) {
            y[s->row_of[q]] -= p->sparse.l[q] * y[j];
        }
    }
    for (size_t j = size; j-- > 0;) {
        if (p->sparse.d[j] != 0.0) {
            double x = y[j] * p->sparse.d[j];
            for (size_t q = s->column[j]; q < s->column[j + 1]; q++) {
                x -= p->sparse.l[q] * y[s->row_of[q]];
            }
            y[j] = x;
            step[s->place[j]] = p->scale[s->place[j]] * x;
        }
    }
    memset(y, 0, size * sizeof *y);
}

/* L D L' += alpha w w' behind position k, for the workspace w with the pattern of column k of L. Clears w. Returns 0 if a pivot
 * would not be positive: then L D L' is invalid. */
static int sparse_modify(const struct box_qp *p, size_t k, double alpha)
{
    const struct sparse *s = p->group->sparse;
    int good = 1;
    for (size_t j = k; s->column[j] < s->column[j + 1];) {
        j = s->row_of[s->column[j]]; /* the parent in the elimination tree */
        const double x = p->sparse.w[j];
        p->sparse.w[j] = 0.0;
        if (x == 0.0 || p->sparse.d[j] == 0.0 || !good) {
            continue;
        }
        const double before = 1.0 / p->sparse.d[j], after = before + alpha * x * x;
        good = after > TRIBO_SPARSE_ZERO;
        if (!good) {
            continue;
        }
        const double beta = alpha * x / after;
        alpha *= before / after;
        p->sparse.d[j] = 1.0 / after;
        for (size_t q = s->column[j]; q < s->column[j + 1]; q++) {
            p->sparse.w[s->row_of[q]] -= x * p->sparse.l[q];
            p->sparse.l[q] += beta * p->sparse.w[s->row_of[q]];
        }
    }
    return good;
}

/* Returns 1 if contact i depends on the contacts in the factor: its pivot as the last one would be 0 to rounding. */
static int sparse_depends(struct box_qp *p, size_t i)
{
    const struct sparse *s = p->group->sparse;
    double pivot = 0.0, size = 0.0;
    tribo_null_vector(p, i, p->step);
    for (size_t e = s->r.first[i]; e < s->r.first[i + 1]; e++) {
        const size_t j = s->r.col[e];
        if (j == i || p->sparse.d[s->position[j]] != 0.0) {
            pivot += s->r.val[e] * p->step[j];
            size += fabs(s->r.val[e] * p->step[j]);
        }
    }
    return pivot <= 2.0 * TRIBO_SPARSE_ZERO * size;
}

int tribo_sparse_enter(struct box_qp *p, size_t i)
{
    const struct sparse *s = p->group->sparse;
    const size_t k = s->position[i];
    double ignored = 0.0;
    if (p->group->nullity && sparse_depends(p, i)) {
        return DEPENDENT;
    }
    const double pivot = sparse_eliminate(p, k, &ignored);
    if (!(pivot > TRIBO_SPARSE_ZERO)) {
        return UNDECIDED;
    }
    p->sparse.d[k] = 1.0 / pivot;
    for (size_t e = s->r.first[i]; e < s->r.first[i + 1]; e++) {
        const size_t j = s->position[s->r.col[e]];
        if (j > k) {
            p->sparse.w[j] = p->scale[i] * s->r.val[e] * p->scale[s->r.col[e]];
        }
    }
    for (size_t t = s->row[k]; t < s->row[k + 1]; t++) {
        const size_t j = s->column_of[t], slot = s->slot[t];
        const double x = p->sparse.l[slot] / (p->sparse.d[j] == 0.0 ? 1.0 : p->sparse.d[j]); /* where d is 0 l is, too */
        for (size_t q = slot + 1; x != 0.0 && q < s->column[j + 1]; q++) {
            p->sparse.w[s->row_of[q]] -= p->sparse.l[q] * x;
        }
    }
    for (size_t q = s->column[k]; q < s->column[k + 1]; q++) {
        const size_t j = s->row_of[q];
        p->sparse.l[q] = p->sparse.d[j] == 0.0 ? 0.0 : p->sparse.w[j] * p->sparse.d[k];
        p->sparse.w[j] = p->sparse.l[q];
    }
    return sparse_modify(p, k, -pivot) ? INDEPENDENT : UNDECIDED;
}

void tribo_sparse_leave(struct box_qp *p, size_t i)
{
    const struct sparse *s = p->group->sparse;
    const size_t k = s->position[i], at = p->sparse.index[i], dependents = p->sets->dependents;
    if (at >= p->sets->rank) {
        p->sets->dependents--;
        tribo_box_order(p, at, p->order[p->sets->rank + p->sets->dependents]);
        return;
    }
    p->sets->rank--;
    tribo_box_order(p, at, p->order[p->sets->rank]);
    if (dependents) {
        tribo_box_order(p, p->sets->rank, p->order[p->sets->rank + dependents]);
    }
    sparse_clear_row(p, k);
    for (size_t q = s->column[k]; q < s->column[k + 1]; q++) {
        p->sparse.w[s->row_of[q]] = p->sparse.l[q];
        p->sparse.l[q] = 0.0;
    }
    const double pivot = 1.0 / p->sparse.d[k];
    p->sparse.d[k] = 0.0;
    sparse_modify(p, k, pivot);
}

/* ---------------------------------------------------------------------------------------------------------- creation */

int tribo_sparse_create(struct sparse **created, const struct csr *r)
{
    const size_t size = r->n;
    struct sparse *s = calloc(1, sizeof *s);
    size_t *work = calloc(5 * size + 4, sizeof *work), depth = 1;
    int good = -1;
    if (s && work && tribo_csr_transpose(&s->r, size, size, r->first, r->col, r->val)) { /* r is symmetric */
        s->position = malloc(2 * size * sizeof *s->position);
        s->column = calloc(3 * (size + 1), sizeof *s->column);
    }
    if (s && s->position && s->column) {
        struct graph g = {r, s->position + size, work, work + size, work + 2 * size, 0};
        struct part *stack = (void *)(work + 3 * size); /* [size + 2] */
        s->place = g.node;
        s->row = s->column + size + 1;
        s->run = s->row + size + 1;
        for (size_t k = 0; k < size; k++) {
            s->place[k] = k;
        }
        for (stack[0] = (struct part){0, size}; depth-- > 0;) {
            dissect(&g, stack[depth], stack, &depth);
        }
        good = find_pattern(s, work);
    }
    *created = good > 0 ? s : NULL;
    if (good <= 0) {
        tribo_sparse_free(s);
    }
    free(work);
    return good >= 0;
}
