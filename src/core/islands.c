/* The operator as it is kept: the islands of R's graph, found once, with room for everything that is ever done with them. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"
#include "rows.h"
#include "../real.h"

/* Smaller groups are dense, whatever their entries. */
#define SPARSE_FROM 128

void tribo_op_free(struct op *op)
{
    for (size_t k = 0; op->group && k < op->groups; k++) {
        tribo_sparse_free(op->group[k].sparse);
    }
    struct program *p = &op->program;
    free(op->diagonal);
    free(op->group);
    free(op->group_of);
    free(op->touched);
    free(op->member);
    free(op->r);
    free(op->l);
    free(op->scale);
    free(op->x);
    free(op->reach);
    free(op->at);
    free(op->order);
    free(op->terms);
    free(p->near);
    free(p->held);
    free(p->to);
    free(p->q);
    free(p->basis);
    memset(op, 0, sizeof *op);
}

int tribo_op_diagonal(struct op *op, size_t n, const double *r)
{
    memset(op, 0, sizeof *op);
    op->row_sum = 1.0;
    op->islands = n;
    op->diagonal = malloc((n + 1) * sizeof *op->diagonal);
    for (size_t i = 0; op->diagonal && i < n; i++) {
        op->diagonal[i] = r ? greater(r[i], DBL_MIN) : 1.0;
    }
    return op->diagonal != NULL;
}

/* Arrays of contacts in groups; sizes are known. */
static int allocate_pools(struct op *op, size_t n)
{
    const size_t m = op->members + 1, b = op->blocks + 1;
    op->scale = malloc(m * sizeof *op->scale);
    op->x = calloc(m, sizeof *op->x);
    op->reach = calloc(n + 1, sizeof *op->reach);
    op->at = malloc(m);
    op->order = malloc(m * sizeof *op->order);
    op->terms = calloc(m, sizeof *op->terms);
    op->r = calloc(b, sizeof *op->r);
    op->l = malloc(b * sizeof *op->l);
    if (!op->scale || !op->x || !op->reach || !op->at || !op->order || !op->terms || !op->r || !op->l) {
        return 0;
    }
    memset(op->at, AWAY, m);
    return 1;
}

static int allocate_program(struct op *op)
{
    enum { VECTORS = 10 };
    const size_t s = op->largest + 1;
    struct program *p = &op->program;
    p->near = malloc(s * sizeof *p->near);
    p->to = malloc(s);
    p->q = calloc(VECTORS * s, sizeof *p->q);
    if (!p->near || !p->to || !p->q) {
        return 0;
    }
    double **const vector[] = {&p->lo, &p->hi, &p->gradient, &p->noise, &p->unit, &p->step, &p->row, &p->spare[0], &p->spare[1]};
    for (size_t k = 0; k < VECTORS - 1; k++) {
        *vector[k] = p->q + (k + 1) * s;
    }
    return 1;
}

/* Room for null vectors, once the ranks are known. */
static int allocate_basis(struct op *op)
{
    for (size_t k = 0; k < op->groups; k++) {
        const struct island *is = &op->group[k];
        size_t redundant = is->nullity;
        if (is->sparse && redundant > TRIBO_SPARSE_REDUNDANT) {
            redundant = TRIBO_SPARSE_REDUNDANT;
        }
        op->basis = redundant * is->size > op->basis ? redundant * is->size : op->basis;
    }
    op->program.held = malloc((op->largest + 1) * sizeof *op->program.held);
    op->program.basis = malloc((op->basis + 1) * sizeof *op->program.basis);
    return op->program.held && op->program.basis;
}

int tribo_op_copy(struct op *to, const struct op *from, size_t n)
{
    if (!tribo_op_diagonal(to, n, from->diagonal)) {
        return 0;
    }
    to->row_sum = from->row_sum;
    to->islands = from->islands;
    to->program.work = from->program.work;
    if (!from->groups) {
        return 1;
    }
    to->members = from->members;
    to->largest = from->largest;
    to->blocks = from->blocks;
    to->group_of = malloc(n * sizeof *to->group_of);
    to->member = malloc(from->members * sizeof *to->member);
    to->group = malloc(from->groups * sizeof *to->group);
    to->touched = malloc(from->groups * sizeof *to->touched);
    if (!to->group_of || !to->member || !to->group || !to->touched) {
        return 0;
    }
    memcpy(to->group_of, from->group_of, n * sizeof *to->group_of);
    memcpy(to->member, from->member, from->members * sizeof *to->member);
    for (to->groups = 0; to->groups < from->groups; to->groups++) {
        to->group[to->groups] = from->group[to->groups];
        if (!tribo_sparse_clone(&to->group[to->groups].sparse, from->group[to->groups].sparse)) {
            return 0;
        }
    }
    if (!allocate_pools(to, n) || !allocate_program(to) || !allocate_basis(to)) {
        return 0;
    }
    memcpy(to->touched, from->touched, from->touches * sizeof *to->touched);
    to->touches = from->touches;
    tribo_copy(to->r, from->r, from->blocks);
    tribo_copy(to->l, from->l, from->blocks);
    tribo_copy(to->scale, from->scale, from->members);
    tribo_copy(to->x, from->x, from->members);
    memcpy(to->at, from->at, from->members);
    memcpy(to->order, from->order, from->members * sizeof *to->order);
    memcpy(to->terms, from->terms, from->members * sizeof *to->terms);
    return 1;
}

/* ------------------------------------------------------------------------------------------------------ finding them */

static size_t root_of(size_t *parent, size_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

/* Numbers the islands in the order of their first contact: label [n]. parent [n] is workspace. */
static size_t find_islands(const struct rows *a, size_t *label, size_t *parent)
{
    for (size_t i = 0; i < a->n; i++) {
        parent[i] = i;
    }
    for (size_t i = 0; i < a->n; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            if (a->val[k] != 0.0) {
                const size_t p = root_of(parent, i), q = root_of(parent, a->col[k]);
                parent[p > q ? p : q] = p > q ? q : p;
            }
        }
    }
    size_t islands = 0;
    for (size_t i = 0; i < a->n; i++) {
        label[i] = parent[i] == i ? islands++ : label[root_of(parent, i)];
    }
    return islands;
}

/* From islands with their sizes in count to groups: label becomes the group, or TRIBO_ALONE. place [n]: of a contact in its
 * group. */
static int find_groups(struct op *op, size_t n, size_t *label, size_t *count, size_t *place)
{
    op->group_of = malloc((n + 1) * sizeof *op->group_of);
    op->member = malloc((n + 1) * sizeof *op->member);
    op->group = calloc(op->islands + 1, sizeof *op->group);
    op->touched = malloc((op->islands + 1) * sizeof *op->touched);
    if (!op->group_of || !op->member || !op->group || !op->touched) {
        return 0;
    }
    for (size_t i = 0; i < n; i++) {
        op->group_of[i] = TRIBO_ALONE;
        place[i] = count[label[i]]++;
    }
    for (size_t i = 0; i < n; i++) {
        if (count[label[i]] > 1 && place[i] == 0) {
            op->group[op->groups] = (struct island){.size = count[label[i]], .first = op->members};
            op->members += count[label[i]];
            op->group_of[i] = op->groups++;
            /* the others of the island learn it from their first */
            count[label[i]] = op->group_of[i];
        } else if (place[i] > 0) {
            op->group_of[i] = count[label[i]];
        }
        if (op->group_of[i] != TRIBO_ALONE) {
            op->member[op->group[op->group_of[i]].first + place[i]] = i;
        }
    }
    for (size_t k = 0; k < op->groups; k++) {
        op->largest = op->group[k].size > op->largest ? op->group[k].size : op->largest;
    }
    return 1;
}

/* The rows of a group by place, if it may be worth to keep it sparse. */
static int make_sparse(struct island *is, const struct rows *a, const size_t *member, const size_t *place)
{
    struct rows own;
    size_t entries = 0;
    for (size_t p = 0; p < is->size; p++) {
        entries += a->first[member[p] + 1] - a->first[member[p]];
    }
    if (!tribo_rows_create(&own, is->size, entries)) {
        return 0;
    }
    entries = 0;
    for (size_t p = 0; p < is->size; p++) {
        for (size_t e = a->first[member[p]]; e < a->first[member[p] + 1]; e++) {
            if (a->val[e] != 0.0) {
                own.col[entries] = place[a->col[e]];
                own.val[entries++] = a->val[e];
            }
        }
        own.first[p + 1] = entries;
    }
    const int done = tribo_sparse_create(&is->sparse, &own);
    tribo_rows_free(&own);
    return done;
}

static double diagonal_of(const struct rows *a, size_t i)
{
    const double *entry = tribo_rows_entry(a, i, i);
    return entry ? *entry : 0.0;
}

static void fill(struct op *op, const struct rows *a, const size_t *place)
{
    for (size_t i = 0; i < a->n; i++) {
        double sum = 0.0;
        size_t terms = 0;
        op->diagonal[i] = greater(diagonal_of(a, i), DBL_MIN);
        for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
            sum += fabs(a->val[e]);
            terms += a->val[e] != 0.0;
        }
        op->row_sum = greater(op->row_sum, sum / op->diagonal[i]);
        if (op->group_of[i] == TRIBO_ALONE) {
            continue;
        }
        struct island *is = &op->group[op->group_of[i]];
        op->scale[is->first + place[i]] = tribo_scale(op->diagonal[i]);
        op->terms[is->first + place[i]] = terms;
        double *row = op->r + is->block + place[i] * is->size;
        for (size_t e = a->first[i]; !is->sparse && e < a->first[i + 1]; e++) {
            if (a->val[e] != 0.0) {
                row[place[a->col[e]]] = a->val[e];
            }
        }
    }
}

/* The ranks of all groups. */
static int check_definite(struct op *op, struct flaw *flaw)
{
    for (size_t k = 0; k < op->groups; k++) {
        struct program *p = tribo_op_program(op, k);
        struct island *is = p->island;
        for (size_t i = 0; i < is->size; i++) {
            p->near[i] = i;
            p->at[i] = FREE;
        }
        p->count = is->size;
        size_t where = 0;
        const double left = tribo_factor_rebuild(p, &where);
        if (fabs(left) > 16.0 * (is->sparse ? TRIBO_SPARSE_ZERO : tribo_resolution(is->size))) {
            *flaw = (struct flaw){op->member[is->first + where], is->size, left};
            return TRIBO_ERR_INDEFINITE;
        }
        is->nullity = is->dependents;
        memset(p->at, AWAY, is->size);
        tribo_factor_rebuild(p, NULL);
    }
    op->program.work.factorizations = 0;
    return TRIBO_OK;
}

static int create_groups(struct op *op, const struct rows *a, const size_t *place, struct flaw *flaw)
{
    for (size_t k = 0; k < op->groups; k++) {
        struct island *is = &op->group[k];
        if (is->size > SPARSE_FROM && !make_sparse(is, a, op->member + is->first, place)) {
            return TRIBO_ERR_MEMORY;
        }
        is->block = op->blocks;
        op->blocks += is->sparse ? 0 : is->size * is->size;
    }
    if (!allocate_pools(op, a->n) || !allocate_program(op)) {
        return TRIBO_ERR_MEMORY;
    }
    fill(op, a, place);
    const int status = check_definite(op, flaw);
    return status || allocate_basis(op) ? status : TRIBO_ERR_MEMORY;
}

int tribo_op_create(struct op *op, const struct rows *a, struct flaw *flaw)
{
    const size_t n = a->n;
    int status = TRIBO_ERR_MEMORY;
    size_t *label = malloc((n + 1) * sizeof *label), *count = malloc((n + 1) * sizeof *count),
           *place = malloc((n + 1) * sizeof *place);
    if (label && count && place && tribo_op_diagonal(op, n, NULL)) {
        op->islands = find_islands(a, label, place);
        memset(count, 0, n * sizeof *count);
        if (op->islands == n) {
            for (size_t i = 0; i < n; i++) {
                op->diagonal[i] = greater(diagonal_of(a, i), DBL_MIN);
            }
            status = TRIBO_OK;
        } else if (find_groups(op, n, label, count, place)) {
            status = create_groups(op, a, place, flaw);
        }
    }
    if (status) {
        tribo_op_free(op);
    }
    free(label);
    free(count);
    free(place);
    return status;
}

struct program *tribo_op_program(struct op *op, size_t k)
{
    struct program *p = &op->program;
    struct island *is = &op->group[k];
    p->island = is;
    p->r = op->r + is->block;
    p->l = op->l + is->block;
    p->terms = op->terms + is->first;
    p->scale = op->scale + is->first;
    p->at = op->at + is->first;
    p->order = op->order + is->first;
    p->x = op->x + is->first;
    p->redundant = op->basis / is->size;
    return p;
}
