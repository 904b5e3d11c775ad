/* SPDX-License-Identifier: BSD-3-Clause */
/* The operator: groups, the connected parts of R's graph; and the memory of a context that goes with it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/context.h"
#include "common/layout.h"
#include "numerics/box/small.h"
#include "numerics/csr.h"
#include "common/simd.h"
#include "numerics/twofold.h"
#include "numerics/union_find.h"

/* Smaller groups are dense, whatever their entries; groups of at most DENSE_UP_TO contacts where a sparse factor, which does not
 * choose its pivots, would have small ones. */
#define SPARSE_FROM 128
#define DENSE_UP_TO 2048

/* Groups of up to GRADED_TO contacts are kept to twice as many digits if the masses of a contact's bodies differ by more than
 * GRADED_FROM, and a pivot of R is less than GRADED_PIVOT. Masses differ by at most GRADED_MOST; in larger groups by
 * GRADED_MOST_LARGE. */
#define GRADED_FROM 1e3
#define GRADED_PIVOT 1e-4
#define GRADED_TO 256
#define GRADED_MOST 1e18
#define GRADED_MOST_LARGE 1e10

int tribo_prefers_sparse(size_t size, int thin)
{
    return size > (thin ? DENSE_UP_TO : SPARSE_FROM);
}

static void forget_sparse(struct delassus *op)
{
    for (size_t k = 0; k < op->laid_out; k++) {
        tribo_sparse_free(op->group[k].made);
    }
}

void tribo_operator_release(struct delassus *op)
{
    if (!op || TRIBO_SHARED_ADD(op->references, SIZE_MAX) > 0) { /* one less */
        return;
    }
    forget_sparse(op);
    free(op->rooms[0].block);
    free(op->rooms[1].block);
    free(op);
}

void tribo_memory_free(struct memory *m)
{
    free(m->rooms[0].block);
    free(m->rooms[1].block);
    *m = (struct memory){0};
}

struct delassus *tribo_operator_diagonal(struct delassus *spent, size_t n, const double *r)
{
    struct delassus *o = spent;
    double *diagonal = spent ? spent->diagonal : NULL;
    if (!spent && !ALLOCATE(ARRAY(o, 1), ARRAY(diagonal, r ? 2 * n + TRIBO_LINE : 0))) {
        return NULL;
    }
    *o = (struct delassus){.references = 1,
                           .most = TRIBO_FAR,
                           .growth = 1.0,
                           .islands = r ? n : 0,
                           .diagonal = r ? diagonal : NULL,
                           .group_of = o->group_of,
                           .group = o->group,
                           .member = o->member,
                           .row_sum = o->row_sum,
                           .rooms = {o->rooms[0], o->rooms[1]},
                           .laid_out = o->laid_out};
    o->inverse = r ? tribo_aligned(diagonal + n) : NULL;
    for (size_t i = 0; r && i < n; i++) {
        diagonal[i] = greater(r[i], TRIBO_IMMOVABLE);
        o->inverse[i] = 1.0 / diagonal[i];
    }
    return o;
}

struct box_qp *tribo_memory_problem(const struct delassus *op, struct memory *m, size_t k)
{
    struct box_qp *p = &m->problem;
    const struct group *g = &op->group[k];
    const size_t size = g->size;
    double *fixed = op->fixed + g->fixed;
    p->group = g;
    p->sets = &m->sets[k];
    p->member = op->member + g->first;
    p->scale = fixed;
    p->rounding.part = fixed + size;
    p->rounding.least = fixed + 2 * size;
    p->r = fixed + 3 * size;
    p->low.r = p->r + size * size;
    p->x = m->store + g->kept;
    p->order = (void *)(p->x + size);
    p->at = (void *)(p->x + 2 * size);
    p->l = p->x + 3 * size;
    p->low.l = p->l + size * size;
    p->inverse = p->l + (g->graded ? 2 : 1) * size * size;
    if (g->sparse) {
        p->sparse = (struct sparse_factor){p->l + 3 * size, p->l, p->l + size, (void *)(p->l + 2 * size)};
    }
    p->null.redundant = op->basis / size;
    return p;
}

/* Allocates a memory of zeros without its basis, whose size follows from ranks. Returns 0 if out of memory. */
static int allocate_memory(struct memory *m, const struct delassus *op)
{
    struct box_qp *p = &m->problem;
    const size_t s = op->largest + 1;
    return ALLOCATE_IN(m->rooms, ARRAY(m->store, op->kept_size + 1), ARRAY(m->sets, op->groups),
                       ARRAY(m->solved_list, op->groups), ARRAY(m->solved, op->groups), ARRAY(p->q, s), ARRAY(p->lo, s),
                       ARRAY(p->hi, s), ARRAY(p->gradient, s), ARRAY(p->noise, s), ARRAY(p->low.x, s),
                       ARRAY(p->rounding.terms, s), ARRAY(p->rounding.unit, s), ARRAY(p->step, s), ARRAY(p->low.step, s),
                       ARRAY(p->low.gradient, s), ARRAY(p->row, s), ARRAY(p->spare[0], s), ARRAY(p->spare[1], s),
                       ARRAY(p->near, s), ARRAY(p->null.held, s), ARRAY(p->to, s)) != NULL;
}

static int allocate_basis(struct memory *m, const struct delassus *op)
{
    return !op->basis || ALLOCATE_IN(m->rooms + 1, ARRAY(m->problem.null.basis, op->basis));
}

int tribo_memory_copy(struct memory *to, const struct memory *from, const struct delassus *op)
{
    *to = (struct memory){0};
    to->problem.work = from->problem.work;
    if (!op->groups) {
        return 1;
    }
    if (!allocate_memory(to, op) || !allocate_basis(to, op)) {
        return 0;
    }
    /* all from store to solved */
    memcpy(to->store, from->store, (size_t)((char *)(to->solved + op->groups) - (char *)to->store));
    to->nsolved = from->nsolved;
    return 1;
}

/* ------------------------------------------------------------------------------------------------------ finding them */

/* Makes groups of the islands of more than one contact. place [n] = the place of a contact in its group; work [3 n + 1] is
 * workspace. Returns 0 if out of memory. */
static int find_groups(struct delassus *op, const struct csr *a, size_t *place, size_t *work)
{
    const size_t n = a->n;
    size_t *parent = work, *count = work + n, *first = work + 2 * n;
    for (size_t i = 0; i < n; i++) {
        parent[i] = i;
        count[i] = 0;
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            if (a->val[k] != 0.0) {
                tribo_join(parent, i, a->col[k]);
            }
        }
    }
    op->islands = 0;
    for (size_t i = 0; i < n; i++) {
        op->islands += parent[i] == i;
        op->groups += ++count[tribo_root(parent, i)] == 2;
    }
    if (!op->groups) {
        return 1;
    }
    if (op->groups != op->laid_out) {
        forget_sparse(op);
        op->laid_out = 0;
        if (!ALLOCATE_IN(op->rooms, ARRAY(op->group_of, n), ARRAY(op->member, n), ARRAY(op->row_sum, n),
                         ARRAY(op->group, op->groups))) {
            return 0;
        }
        op->laid_out = op->groups;
    }
    tribo_list_sets(n, parent, count, op->group_of, place, first, op->member);
    for (size_t i = 0; i < n; i++) {
        op->row_sum[i] = -1.0;
    }
    for (size_t k = 0; k < op->groups; k++) {
        op->group[k].first = first[k];
        op->group[k].size = first[k + 1] - first[k];
        op->largest = op->group[k].size > op->largest ? op->group[k].size : op->largest;
    }
    return 1;
}

/* Sets rows->val to the entries of group g in a. Returns 1; returns 0, and may set a part of rows->val, if the places of the
 * entries of g differ from those of rows. */
static int set_values_of(struct csr *rows, const struct group *g, const struct csr *a, const size_t *member, const size_t *place)
{
    size_t entries = 0;
    int same = rows->n == g->size;
    for (size_t p = 0; same && p < g->size; p++) {
        for (size_t e = a->first[member[p]]; same && e < a->first[member[p] + 1]; e++) {
            if (a->val[e] != 0.0) {
                same = entries < rows->first[p + 1] && rows->col[entries] == place[a->col[e]];
                if (same) {
                    rows->val[entries++] = a->val[e];
                }
            }
        }
        same = same && entries == rows->first[p + 1];
    }
    return same;
}

/* Sets g->made to the sparse factor of a group; NULL if a dense factor is better. Returns 0 if out of memory. */
static int make_sparse(struct group *g, const struct csr *a, const size_t *member, const size_t *place)
{
    if (g->made && set_values_of(tribo_sparse_rows(g->made), g, a, member, place)) {
        return 1;
    }
    struct csr own;
    size_t entries = 0;
    uint64_t shape = 14695981039346656037u ^ g->size; /* the hash FNV-1a, of words */
    for (size_t p = 0; p < g->size; p++) {
        for (size_t e = a->first[member[p]]; e < a->first[member[p] + 1]; e++) {
            if (a->val[e] != 0.0) {
                shape = (shape ^ (p * g->size + place[a->col[e]])) * 1099511628211u;
                entries++;
            }
        }
    }
    if (shape == g->dense_shape) {
        return 1;
    }
    if (!tribo_csr_create(&own, g->size, entries)) {
        return 0;
    }
    entries = 0;
    for (size_t p = 0; p < g->size; p++) {
        for (size_t e = a->first[member[p]]; e < a->first[member[p] + 1]; e++) {
            if (a->val[e] != 0.0) {
                own.col[entries] = place[a->col[e]];
                own.val[entries++] = a->val[e];
            }
        }
        own.first[p + 1] = entries;
    }
    tribo_sparse_free(g->made);
    const int done = tribo_sparse_create(&g->made, &own);
    tribo_csr_free(&own);
    g->dense_shape = done && !g->made ? shape : 0;
    return done;
}

/* y = D^-1 |R| x, x [n] > 0. Returns the largest y_i/x_i, which bounds the eigenvalues of D^-1 R from above (Collatz 1942), more
 * closely with every call on the last y. */
static double operator_grow(const struct delassus *op, const struct csr *a, const double *x, double *y)
{
    double most = 1.0;
    for (size_t i = 0; i < a->n; i++) {
        double sum = 0.0;
        for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
            sum += fabs(a->val[e]) * x[a->col[e]];
        }
        y[i] = greater(x[i], quotient(sum, op->diagonal[i]));
        most = greater(most, y[i] / x[i]);
    }
    return most;
}

/* Sets spread: the largest ratio of shares J_ik^2 w_k of bodies in one R_ii; fails if it is too large; a status. */
static int find_grading(struct group *g, const struct inertia *from, const size_t *member, tribo_context *note)
{
    g->spread = 1.0;
    for (size_t c = 0; from && c < g->size; c++) {
        const size_t i = member[c];
        double least = HUGE_VAL, most = 0.0;
        for (size_t e = from->rowptr[i]; e < from->rowptr[i + 1]; e++) {
            const double root = fabs(from->val[e]) * sqrt(from->w[from->col[e]]);
            least = root > 0.0 ? lesser(least, root) : least;
            most = greater(most, root);
        }
        const double ratio = most > 0.0 ? quotient(most, least) : 1.0, spread = ratio < 1e150 ? ratio * ratio : TRIBO_FAR;
        if (spread > g->spread) {
            g->spread = spread;
            g->uneven = i;
        }
    }
    g->graded = g->spread > GRADED_FROM && g->size <= GRADED_TO;
    return g->spread <= (g->graded ? GRADED_MOST : GRADED_MOST_LARGE)
               ? TRIBO_OK
               : tribo_fail(
                     note, TRIBO_ERR_UNSUPPORTED,
                     "inverse_mass: contact %zu touches bodies whose masses differ by %g, in a group of %zu coupled contact%s",
                     g->uneven, g->spread, g->size, plural(g->size));
}

/* Factorizes R over all contacts of a group. Returns what tribo_factor_rebuild does. */
static double factorize_all(struct box_qp *p, size_t *where)
{
    p->count = p->group->size;
    for (size_t i = 0; i < p->count; i++) {
        p->near[i] = i;
        p->at[i] = FREE;
    }
    return tribo_factor_rebuild(p, where);
}

/* r + r_low = R of a graded group to twice as many digits. */
static void fill_graded(const struct box_qp *p, double *r, double *r_low, const struct inertia *from, const size_t *member,
                        const size_t *place)
{
    const size_t size = p->group->size;
    memset(r, 0, size * size * sizeof *r);
    for (size_t c = 0; c < size; c++) {
        const size_t i = member[c];
        for (size_t e = from->rowptr[i]; e < from->rowptr[i + 1]; e++) {
            const size_t dof = from->col[e];
            const struct twofold x = twofold_product(from->val[e], from->w[dof]);
            for (size_t k = from->t->first[dof]; x.hi != 0.0 && k < from->t->first[dof + 1]; k++) {
                const size_t j = from->t->col[k], at = c * size + place[j];
                /* R_ij = 0 of a contact j in another group, though i and j share this body: terms cancel, or J has a 0 */
                if (place[j] >= size || member[place[j]] != j) {
                    continue;
                }
                const struct twofold term = twofold_times(x, (struct twofold){from->t->val[k], 0.0}),
                                     sum = twofold_add((struct twofold){r[at], r_low[at]}, term);
                r[at] = sum.hi;
                r_low[at] = sum.lo;
            }
        }
    }
}

/* Sets what is constant of group k. */
static void fill_group(struct delassus *op, struct memory *m, size_t k, const struct csr *a, const size_t *place)
{
    struct box_qp *p = tribo_memory_problem(op, m, k);
    struct group *g = &op->group[k];
    double *scale = op->fixed + g->fixed, *part = scale + g->size, *least = part + g->size, *r = least + g->size;
    g->lightest = HUGE_VAL;
    g->terms = 0;
    for (size_t c = 0; c < g->size; c++) {
        const size_t i = p->member[c];
        p->at[c] = AWAY;
        size_t terms = 0;
        op->row_sum[i] = 0.0;
        scale[c] = tribo_scale(op->diagonal[i]);
        g->lightest = lesser(g->lightest, scale[c]);
        for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
            terms += a->val[e] != 0.0;
            op->row_sum[i] += lesser(fabs(a->val[e]), TRIBO_FAR);
            if (a->val[e] != 0.0 && !g->sparse) {
                r[c * g->size + place[a->col[e]]] = a->val[e];
            }
        }
        part[c] = tribo_resolution(terms);
        g->terms = terms > g->terms ? terms : g->terms;
    }
    for (size_t c = 0; c < g->size; c++) {
        least[c] = DBL_MIN + quotient(DBL_MIN, scale[c] * g->lightest);
    }
    for (size_t c = 0; c < g->size; c++) {
        op->largest_sum = greater(op->largest_sum, op->row_sum[p->member[c]]);
        op->most = lesser(op->most, tribo_most(p, c));
    }
}

/* 1 if a pivot of the factor of a group is small, or zero. */
static int is_thin(const struct box_qp *p)
{
    const size_t size = p->group->size;
    double most = 1.0; /* 1/pivot */
    for (size_t i = 0; p->group->sparse && i < size; i++) {
        most = greater(most, p->sparse.d[i]);
    }
    if (!p->group->sparse && p->sets->rank) {
        const double last = p->l[(p->sets->rank - 1) * (size + 1)];
        most = last * last;
    }
    return p->sets->dependents || most * TRIBO_DOUBTFUL >= 1.0;
}

/* Factors R of group k, graded if g->graded and a pivot is small; sets nullity, small and the room for null vectors from the
 * rank. Gives up the sparse factor if a pivot is small in a group of at most DENSE_UP_TO contacts: *again = 1, since the group
 * needs room for a dense one. Returns TRIBO_OK, or TRIBO_ERR_INDEFINITE if a pivot is below zero by more than rounding. */
static int judge_group(struct delassus *op, struct memory *m, size_t k, const struct inertia *from, const size_t *place,
                       int *again, tribo_context *note)
{
    struct group *g = &op->group[k];
    const int uneven = g->graded;
    size_t where = 0;
    g->graded = 0;
    struct box_qp *p = tribo_memory_problem(op, m, k);
    double left = factorize_all(p, &where);
    if (g->sparse && !tribo_prefers_sparse(g->size, is_thin(p))) {
        g->sparse = NULL;
        *again = 1;
        return TRIBO_OK;
    }
    const double last = uneven && p->sets->rank ? p->l[(p->sets->rank - 1) * (g->size + 1)] : 1.0; /* the root of its inverse */
    if (uneven && (p->sets->rank < g->size || 1.0 < GRADED_PIVOT * last * last)) {
        /* R in doubles may have a pivot so small that its rounding counts. */
        double *r = op->fixed + g->fixed + 3 * g->size;
        fill_graded(p, r, r + g->size * g->size, from, p->member, place);
        g->graded = 1;
        p = tribo_memory_problem(op, m, k);
        left = factorize_all(p, &where);
    }
    const double zero = g->sparse ? TRIBO_SPARSE_ZERO : g->graded ? TRIBO_GRADED_ZERO : tribo_resolution(g->size);
    if (fabs(left) > 16.0 * zero) {
        return tribo_fail(note, TRIBO_ERR_INDEFINITE,
                          "r is indefinite: relative pivot %g at contact %zu, in a group of %zu coupled contact%s", left,
                          p->member[where], g->size, plural(g->size));
    }
    g->nullity = p->sets->dependents;
    g->thin = is_thin(p);
    g->small = g->size <= SMALL && !g->nullity && !g->graded && tribo_small_fits(g->size, p->r, p->inverse);
    memset(p->at, AWAY, g->size);
    tribo_factor_rebuild(p, NULL);
    const size_t redundant = g->sparse && g->nullity > TRIBO_SPARSE_REDUNDANT ? TRIBO_SPARSE_REDUNDANT : g->nullity;
    op->basis = redundant * g->size > op->basis ? redundant * g->size : op->basis;
    return TRIBO_OK;
}

/* Allocates what is constant of the groups, and a memory without its basis, in the place of those of another layout. Returns 0 if
 * out of memory. */
static int allocate_groups(struct delassus *op, struct memory *m)
{
    op->fixed_size = op->kept_size = 0;
    for (size_t k = 0; k < op->groups; k++) {
        struct group *g = &op->group[k];
        /* in doubles, which are as large as indices */
        const size_t square = g->size * g->size, matrix = g->graded ? 2 * square : square,
                     inverse = g->size <= SMALL ? square : 0;
        g->fixed = op->fixed_size;
        g->kept = op->kept_size;
        op->fixed_size += 3 * g->size + (g->sparse ? 0 : matrix);
        op->kept_size += 3 * g->size + inverse + (g->sparse ? 3 * g->size + tribo_sparse_slots(g->sparse) : matrix);
    }
    tribo_memory_clear(m);
    return ALLOCATE_IN(op->rooms + 1, ARRAY(op->fixed, op->fixed_size + 1)) && allocate_memory(m, op);
}

int tribo_operator_create(struct delassus **created, struct memory *m, struct drafts *d, const struct inertia *from,
                          tribo_context *note)
{
    enum { FEW = 4, MANY = 8 }; /* for the largest eigenvalue of contacts in a row, to 2% whatever the masses */
    const struct csr *a = &d->a;
    const size_t n = a->n;
    size_t *place = d->place;
    double before = HUGE_VAL, *x = d->x;
    struct delassus *op = tribo_operator_diagonal(*created, n, d->diagonal);
    *created = op;
    tribo_memory_clear(m);
    const int made = op && find_groups(op, a, place, place + n);
    const size_t groups = made ? op->groups : 0;
    int status = made ? TRIBO_OK : TRIBO_ERR_MEMORY;
    for (size_t i = 0; made && i < n; i++) {
        x[i] = 1.0 / sqrt(op->diagonal[i]);
    }
    for (int k = 0; groups && (k < FEW || (k < MANY && op->growth < 0.999 * before)); k++) {
        before = op->growth;
        op->growth = k % 2 ? operator_grow(op, a, x + n, x) : operator_grow(op, a, x, x + n);
    }
    for (size_t k = 0; !status && k < groups; k++) {
        struct group *g = &op->group[k];
        const size_t *member = op->member + g->first;
        g->sparse = NULL;
        status = find_grading(g, from, member, note);
        if (!status && !g->graded && tribo_prefers_sparse(g->size, 0)) {
            status = make_sparse(g, a, member, place) ? TRIBO_OK : TRIBO_ERR_MEMORY;
            g->sparse = g->made;
        }
    }
    for (int again = groups > 0; !status && again;) {
        again = 0;
        status = allocate_groups(op, m) ? TRIBO_OK : TRIBO_ERR_MEMORY;
        for (size_t k = 0; !status && k < groups; k++) {
            fill_group(op, m, k, a, place);
            status = judge_group(op, m, k, from, place, &again, note);
        }
    }
    m->problem.work.factorizations = 0;
    return status ? status : allocate_basis(m, op) ? TRIBO_OK : TRIBO_ERR_MEMORY;
}
