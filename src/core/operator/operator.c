/* The operator as it is kept: the islands of R's graph, found once, with room for everything that is ever done with them. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "operator.h"
#include "../../common/csr.h"
#include "../../common/simd.h"
#include "../../common/twofold.h"

/* Smaller groups are dense, whatever their entries. */
#define SPARSE_FROM 128

/* A group whose contacts touch bodies with masses so far apart is kept to twice as many digits, if a pivot of R is small, too. */
#define GRADED_FROM 1e3
#define GRADED_PIVOT 1e-4

/* That is worth its cost in groups so small, and does up to this; in larger ones masses must not differ more than that. */
#define GRADED_TO 256
#define GRADED_MOST 1e18
#define GRADED_MOST_LARGE 1e10

void tribo_operator_free(struct delassus *op)
{
    for (size_t k = 0; op->group && k < op->groups; k++) {
        tribo_sparse_free(op->group[k].sparse);
    }
    struct box_qp *p = &op->problem;
    free(op->diagonal);
    free(op->group);
    free(op->group_of);
    free(op->solved);
    free(op->solved_list);
    free(op->store);
    free(op->member);
    free(op->row_sum);
    free(p->near);
    free(p->held);
    free(p->to);
    free(p->q);
    free(p->basis);
    *op = (struct delassus){.most = TRIBO_FAR};
}

int tribo_operator_diagonal(struct delassus *op, size_t n, const double *r)
{
    *op = (struct delassus){.most = TRIBO_FAR, .growth = 1.0, .islands = n};
    op->diagonal = malloc((n + 1) * sizeof *op->diagonal);
    for (size_t i = 0; op->diagonal && r && i < n; i++) {
        op->diagonal[i] = greater(r[i], TRIBO_IMMOVABLE);
    }
    return op->diagonal != NULL;
}

/* What a group keeps, in doubles, which are as large as everything else that it keeps. */
static size_t kept_by(const struct group *g)
{
    return 5 * g->size + (g->sparse ? 0 : (g->graded ? 4 : 2) * g->size * g->size);
}

struct box_qp *tribo_operator_problem(struct delassus *op, size_t k)
{
    struct box_qp *p = &op->problem;
    struct group *g = &op->group[k];
    const size_t size = g->size;
    p->group = g;
    p->x = op->store + g->kept;
    p->member = op->member + g->first;
    p->order = (void *)(p->x + size);
    p->at = (void *)(p->x + 2 * size);
    p->terms = (void *)(p->x + 3 * size);
    p->scale = p->x + 4 * size;
    p->r = p->x + 5 * size;
    p->l = p->r + size * size;
    p->r_low = p->l + size * size;
    p->l_low = p->r_low + size * size;
    p->redundant = op->basis / size;
    return p;
}

void tribo_operator_expect(const struct delassus *op, size_t k)
{
    enum { MOST = 2048 }; /* what there is beyond will come by itself */
    const size_t bytes = kept_by(&op->group[k]) * sizeof *op->store;
    tribo_expect(op->store + op->group[k].kept, bytes < MOST ? bytes : MOST, 0);
}

static int allocate_store(struct delassus *op)
{
    op->store = calloc(op->stored + 1, sizeof *op->store);
    return op->store != NULL;
}

static int allocate_program(struct delassus *op)
{
    enum { VECTORS = 13 };
    const size_t s = op->largest + 1;
    struct box_qp *p = &op->problem;
    p->near = malloc(s * sizeof *p->near);
    p->to = malloc(s);
    p->q = calloc(VECTORS * s, sizeof *p->q);
    if (!p->near || !p->to || !p->q) {
        return 0;
    }
    double **const vector[] = {&p->lo,   &p->hi,   &p->gradient, &p->noise, &p->low,      &p->first,
                               &p->unit, &p->step, &p->step_low, &p->row,   &p->spare[0], &p->spare[1]};
    for (size_t k = 0; k < VECTORS - 1; k++) {
        *vector[k] = p->q + (k + 1) * s;
    }
    return 1;
}

/* Room for null vectors, once the ranks are known. */
static int allocate_basis(struct delassus *op)
{
    for (size_t k = 0; k < op->groups; k++) {
        const struct group *g = &op->group[k];
        size_t redundant = g->nullity;
        if (g->sparse && redundant > TRIBO_SPARSE_REDUNDANT) {
            redundant = TRIBO_SPARSE_REDUNDANT;
        }
        op->basis = redundant * g->size > op->basis ? redundant * g->size : op->basis;
    }
    op->problem.held = malloc((op->largest + 1) * sizeof *op->problem.held);
    op->problem.basis = malloc((op->basis + 1) * sizeof *op->problem.basis);
    return op->problem.held && op->problem.basis;
}

static int allocate_groups(struct delassus *op, size_t n, size_t groups)
{
    op->group_of = malloc(n * sizeof *op->group_of);
    op->group = calloc(groups, sizeof *op->group);
    op->solved = calloc(groups, 1);
    op->solved_list = malloc(groups * sizeof *op->solved_list);
    op->member = malloc(n * sizeof *op->member);
    op->row_sum = calloc(n, sizeof *op->row_sum);
    return op->member && op->row_sum && op->group_of && op->group && op->solved && op->solved_list;
}

int tribo_operator_copy(struct delassus *to, const struct delassus *from, size_t n)
{
    if (!from->diagonal) {
        *to = (struct delassus){.most = TRIBO_FAR};
        return 1;
    }
    if (!tribo_operator_diagonal(to, n, from->diagonal)) {
        return 0;
    }
    to->growth = from->growth;
    to->islands = from->islands;
    to->most = from->most;
    to->problem.work = from->problem.work;
    if (!from->groups) {
        return 1;
    }
    to->largest = from->largest;
    to->span = from->span;
    to->largest_sum = from->largest_sum;
    to->stored = from->stored;
    if (!allocate_groups(to, n, from->groups)) {
        return 0;
    }
    memcpy(to->group_of, from->group_of, n * sizeof *to->group_of);
    memcpy(to->member, from->member, n * sizeof *to->member);
    memcpy(to->row_sum, from->row_sum, n * sizeof *to->row_sum);
    for (to->groups = 0; to->groups < from->groups; to->groups++) {
        to->group[to->groups] = from->group[to->groups];
        if (!tribo_sparse_clone(&to->group[to->groups].sparse, from->group[to->groups].sparse)) {
            return 0;
        }
    }
    if (!allocate_store(to) || !allocate_program(to) || !allocate_basis(to)) {
        return 0;
    }
    memcpy(to->solved, from->solved, from->groups);
    memcpy(to->solved_list, from->solved_list, from->nsolved * sizeof *to->solved_list);
    to->nsolved = from->nsolved;
    memcpy(to->store, from->store, from->stored * sizeof *to->store);
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
static size_t find_islands(const struct csr *a, size_t *label, size_t *parent)
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

/* Makes groups of the islands of more than one contact. place [n] gets where a contact stands in its group; count [islands] is
 * workspace. */
static int find_groups(struct delassus *op, size_t n, const size_t *label, size_t *place, size_t *count)
{
    size_t members = 0;
    if (!allocate_groups(op, n, op->islands)) {
        return 0;
    }
    memset(count, 0, op->islands * sizeof *count);
    for (size_t i = 0; i < n; i++) {
        op->group_of[i] = TRIBO_ALONE;
        op->row_sum[i] = -1.0;
        place[i] = count[label[i]]++;
    }
    for (size_t i = 0; i < n; i++) {
        if (count[label[i]] > 1 && place[i] == 0) {
            op->group[op->groups].size = count[label[i]];
            op->group_of[i] = op->groups++;
            /* the others of the group learn it from their first */
            count[label[i]] = op->group_of[i];
        } else if (place[i] > 0) {
            op->group_of[i] = count[label[i]];
        }
    }
    for (size_t k = 0; k < op->groups; k++) {
        op->group[k].first = members;
        members += op->group[k].size;
        op->largest = op->group[k].size > op->largest ? op->group[k].size : op->largest;
    }
    for (size_t i = 0; i < n; i++) {
        if (op->group_of[i] != TRIBO_ALONE) {
            op->member[op->group[op->group_of[i]].first + place[i]] = i;
        }
    }
    return 1;
}

/* The rows of a group by place, if it may be worth to keep it sparse. */
static int make_sparse(struct group *g, const struct csr *a, const size_t *member, const size_t *place)
{
    struct csr own;
    size_t entries = 0;
    for (size_t p = 0; p < g->size; p++) {
        entries += a->first[member[p] + 1] - a->first[member[p]];
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
    const int done = tribo_sparse_create(&g->sparse, &own);
    tribo_csr_free(&own);
    return done;
}

static double diagonal_of(const struct csr *a, size_t i)
{
    const double *entry = tribo_csr_entry(a, i, i);
    return entry ? *entry : 0.0;
}

static void fill_diagonal(struct delassus *op, const struct csr *a)
{
    for (size_t i = 0; i < a->n; i++) {
        op->diagonal[i] = greater(diagonal_of(a, i), TRIBO_IMMOVABLE);
    }
}

/* y = D^-1 |R| x, x [n] being positive. Returns the largest y_i/x_i, which bounds the eigenvalues of D^-1 R from above (Collatz
 * 1942), more closely with every call on the last y. */
static double grow(const struct delassus *op, const struct csr *a, const double *x, double *y)
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

/* 0 if out of memory. */
static int find_growth(struct delassus *op, const struct csr *a)
{
    enum { FEW = 4, MANY = 8 }; /* for the largest eigenvalue of contacts in a row, to 2% whatever the masses */
    double before = HUGE_VAL, *x = malloc((2 * a->n + 1) * sizeof *x);
    for (size_t i = 0; x && i < a->n; i++) {
        x[i] = 1.0 / sqrt(op->diagonal[i]);
    }
    for (int k = 0; x && (k < FEW || (k < MANY && op->growth < 0.999 * before)); k++) {
        before = op->growth;
        op->growth = k % 2 ? grow(op, a, x + a->n, x) : grow(op, a, x, x + a->n);
    }
    free(x);
    return x != NULL;
}

/* How much the shares J_ik^2 w_k of bodies in R_ii differ: the largest over the smallest. */
static double spread_of(const struct inertia *from, size_t i)
{
    double least = HUGE_VAL, most = 0.0;
    for (size_t e = from->rowptr[i]; e < from->rowptr[i + 1]; e++) {
        const double x = fabs(from->val[e]), root = x * sqrt(from->w[from->col[e]]);
        if (root > 0.0) {
            least = lesser(least, root);
            most = greater(most, root);
        }
    }
    const double ratio = most > 0.0 ? quotient(most, least) : 1.0;
    return ratio < 1e150 ? ratio * ratio : TRIBO_FAR;
}

/* Whether the group may have to be graded. Returns 0 if the masses differ too much for it: then flaw says where. */
static int find_grading(struct group *g, const struct inertia *from, const size_t *member, struct flaw *flaw)
{
    double most = 1.0;
    for (size_t c = 0; from && c < g->size; c++) {
        const double spread = spread_of(from, member[c]);
        if (spread > most) {
            most = spread;
            *flaw = (struct flaw){member[c], g->size, spread};
        }
    }
    g->graded = most > GRADED_FROM && g->size <= GRADED_TO;
    return most <= (g->graded ? GRADED_MOST : GRADED_MOST_LARGE);
}

/* Everything is free. Returns what is left, as tribo_factor_rebuild does. */
static double factorize_all(struct box_qp *p, size_t *where)
{
    p->count = p->group->size;
    for (size_t i = 0; i < p->count; i++) {
        p->near[i] = i;
        p->at[i] = FREE;
    }
    return tribo_factor_rebuild(p, where);
}

/* 1 if R as it is filled in has a pivot so small that its rounding counts. */
static int loses_digits(struct box_qp *p)
{
    const struct group *g = p->group;
    size_t where;
    factorize_all(p, &where);
    const double last = g->rank ? p->l[(g->rank - 1) * (g->size + 1)] : 1.0; /* the root of its inverse */
    return g->rank < g->size || 1.0 < GRADED_PIVOT * last * last;
}

/* R of a graded group to twice as many digits. */
static void fill_graded(const struct box_qp *p, const struct inertia *from, const size_t *member, const size_t *place)
{
    const size_t size = p->group->size;
    memset(p->r, 0, size * size * sizeof *p->r);
    for (size_t c = 0; c < size; c++) {
        const size_t i = member[c];
        for (size_t e = from->rowptr[i]; e < from->rowptr[i + 1]; e++) {
            const size_t dof = from->col[e];
            const struct twofold x = twofold_product(from->val[e], from->w[dof]);
            for (size_t k = from->t->first[dof]; x.hi != 0.0 && k < from->t->first[dof + 1]; k++) {
                const size_t at = c * size + place[from->t->col[k]];
                const struct twofold term = twofold_times(x, (struct twofold){from->t->val[k], 0.0}),
                                     sum = twofold_add((struct twofold){p->r[at], p->r_low[at]}, term);
                p->r[at] = sum.hi;
                p->r_low[at] = sum.lo;
            }
        }
    }
}

static void fill_group(struct delassus *op, size_t k, const struct csr *a, const struct inertia *from, const size_t *place)
{
    struct box_qp *p = tribo_operator_problem(op, k);
    struct group *g = p->group;
    const size_t span = p->member[g->size - 1] - p->member[0];
    op->span = span > op->span ? span : op->span;
    g->lightest = HUGE_VAL;
    g->terms = 0;
    for (size_t c = 0; c < g->size; c++) {
        const size_t i = p->member[c];
        p->at[c] = AWAY;
        op->row_sum[i] = 0.0;
        p->scale[c] = tribo_scale(op->diagonal[i]);
        g->lightest = lesser(g->lightest, p->scale[c]);
        for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
            p->terms[c] += a->val[e] != 0.0;
            op->row_sum[i] += lesser(fabs(a->val[e]), TRIBO_FAR);
            if (a->val[e] != 0.0 && !g->sparse) {
                p->r[c * g->size + place[a->col[e]]] = a->val[e];
            }
        }
        g->terms = p->terms[c] > g->terms ? p->terms[c] : g->terms;
    }
    if (g->graded) {
        g->graded = 0;
        g->graded = loses_digits(p);
        if (g->graded) {
            fill_graded(p, from, p->member, place);
        }
    }
    for (size_t c = 0; c < g->size; c++) {
        op->largest_sum = greater(op->largest_sum, op->row_sum[p->member[c]]);
        op->most = lesser(op->most, tribo_most(p, c));
    }
}

/* The ranks of all groups. */
static int check_definite(struct delassus *op, struct flaw *flaw)
{
    for (size_t k = 0; k < op->groups; k++) {
        struct box_qp *p = tribo_operator_problem(op, k);
        struct group *g = p->group;
        size_t where = 0;
        const double left = factorize_all(p, &where);
        const double zero = g->sparse ? TRIBO_SPARSE_ZERO : g->graded ? TRIBO_GRADED_ZERO : tribo_resolution(g->size);
        if (fabs(left) > 16.0 * zero) {
            *flaw = (struct flaw){p->member[where], g->size, left};
            return TRIBO_ERR_INDEFINITE;
        }
        g->nullity = g->dependents;
        memset(p->at, AWAY, g->size);
        tribo_factor_rebuild(p, NULL);
    }
    op->problem.work.factorizations = 0;
    return TRIBO_OK;
}

static int create_groups(struct delassus *op, const struct csr *a, const struct inertia *from, const size_t *place,
                         struct flaw *flaw)
{
    for (size_t k = 0; k < op->groups; k++) {
        struct group *g = &op->group[k];
        const size_t *member = op->member + g->first;
        if (!find_grading(g, from, member, flaw)) {
            return TRIBO_ERR_UNSUPPORTED;
        }
        if (!g->graded && g->size > SPARSE_FROM && !make_sparse(g, a, member, place)) {
            return TRIBO_ERR_MEMORY;
        }
        g->kept = op->stored;
        op->stored += kept_by(g);
    }
    if (!allocate_store(op) || !allocate_program(op)) {
        return TRIBO_ERR_MEMORY;
    }
    for (size_t k = 0; k < op->groups; k++) {
        fill_group(op, k, a, from, place);
    }
    const int status = check_definite(op, flaw);
    return status || allocate_basis(op) ? status : TRIBO_ERR_MEMORY;
}

int tribo_operator_create(struct delassus *op, const struct csr *a, const struct inertia *from, struct flaw *flaw)
{
    const size_t n = a->n;
    int status = TRIBO_ERR_MEMORY;
    size_t *label = malloc((n + 1) * sizeof *label), *count = malloc((n + 1) * sizeof *count),
           *place = malloc((n + 1) * sizeof *place);
    if (label && count && place && tribo_operator_diagonal(op, n, NULL)) {
        op->islands = find_islands(a, label, place);
        fill_diagonal(op, a);
        if (op->islands == n) {
            status = TRIBO_OK;
        } else if (find_growth(op, a) && find_groups(op, n, label, place, count)) {
            status = create_groups(op, a, from, place, flaw);
        }
    }
    if (status) {
        tribo_operator_free(op);
    }
    free(label);
    free(count);
    free(place);
    return status;
}
