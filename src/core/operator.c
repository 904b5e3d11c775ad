/* The operator R: its forms of input, its checks, and its islands. Every form becomes sorted compressed rows first; the new
 * operator replaces the old one only when everything about it is known to be right. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"
#include "../real.h"

/* Entries (i,j) and (j,i) may differ by rounding of whoever computed them. */
#define ASYMMETRY 1e-10

struct rows {
    size_t n;
    size_t *first, *col;
    double *val;
};

static void rows_free(struct rows *a)
{
    free(a->first);
    free(a->col);
    free(a->val);
}

static int rows_create(struct rows *a, size_t n, size_t entries)
{
    a->n = n;
    a->first = calloc(n + 1, sizeof *a->first);
    a->col = malloc((entries + 1) * sizeof *a->col);
    a->val = malloc((entries + 1) * sizeof *a->val);
    if (a->first && a->col && a->val) {
        return 1;
    }
    rows_free(a);
    return 0;
}

void tribo_op_free(struct op *op)
{
    free(op->diagonal);
    free(op->first);
    free(op->member);
    free(op->offset);
    free(op->block);
    memset(op, 0, sizeof *op);
}

int tribo_op_identity(struct op *op, size_t n)
{
    memset(op, 0, sizeof *op);
    op->row_sum = 1.0;
    op->diagonal = malloc((n + 1) * sizeof *op->diagonal);
    for (size_t i = 0; op->diagonal && i < n; i++) {
        op->diagonal[i] = 1.0;
    }
    return op->diagonal != NULL;
}

static int allocate_islands(struct op *op, size_t n, size_t entries)
{
    op->first = malloc((op->islands + 1) * sizeof *op->first);
    op->member = malloc((n + 1) * sizeof *op->member);
    op->offset = malloc((op->islands + 1) * sizeof *op->offset);
    op->block = malloc((entries + 1) * sizeof *op->block);
    return op->first && op->member && op->offset && op->block;
}

int tribo_op_copy(struct op *to, const struct op *from, size_t n)
{
    if (!tribo_op_identity(to, n)) {
        return 0;
    }
    tribo_copy(to->diagonal, from->diagonal, n);
    to->row_sum = from->row_sum;
    to->largest = from->largest;
    to->islands = from->islands;
    if (from->islands) {
        const size_t entries = from->offset[from->islands];
        if (!allocate_islands(to, n, entries)) {
            return 0;
        }
        memcpy(to->first, from->first, (from->islands + 1) * sizeof *to->first);
        memcpy(to->member, from->member, n * sizeof *to->member);
        memcpy(to->offset, from->offset, (from->islands + 1) * sizeof *to->offset);
        memcpy(to->block, from->block, entries * sizeof *to->block);
    }
    return 1;
}

/* The new operator is right: it takes the old one's place. */
static int install(tribo_context *ctx, struct op *op, struct solver *solver)
{
    solver->factorizations += ctx->solver.factorizations;
    solver->updates += ctx->solver.updates;
    tribo_op_free(&ctx->op);
    tribo_solver_free(&ctx->solver);
    ctx->op = *op;
    ctx->solver = *solver;
    ctx->balanced = 0;
    tribo_refresh(ctx);
    return TRIBO_OK;
}

static int install_diagonal(tribo_context *ctx, const double *r)
{
    struct op op;
    struct solver solver;
    if (!tribo_op_identity(&op, ctx->n) || !tribo_solver_create(&solver, 0)) {
        tribo_op_free(&op);
        return tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for an operator of %zu contacts", ctx->n);
    }
    for (size_t i = 0; i < ctx->n; i++) {
        op.diagonal[i] = greater(r[i], DBL_MIN);
    }
    return install(ctx, &op, &solver);
}

int tribo_set_operator_diagonal(tribo_context *ctx, const double *r)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const int status = tribo_check_nonnegative(ctx, "r", r, ctx->n);
    return status ? status : install_diagonal(ctx, r);
}

/* ------------------------------------------------------------------------------------------------------ islands */

static double diagonal_of(const struct rows *a, size_t i)
{
    for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
        if (a->col[k] == i) {
            return a->val[k];
        }
    }
    return 0.0;
}

/* The entry at (i, j), or 0. Columns are sorted. */
static double *entry(const struct rows *a, size_t i, size_t j)
{
    size_t lo = a->first[i], hi = a->first[i + 1];
    while (lo < hi) {
        const size_t mid = lo + (hi - lo) / 2;
        if (a->col[mid] == j) {
            return &a->val[mid];
        }
        if (a->col[mid] < j) {
            lo = mid + 1;
        } else {
            hi = mid;
        }
    }
    return NULL;
}

/* Makes a exactly symmetric, or says where it is not. */
static int symmetrize(const tribo_context *ctx, const struct rows *a)
{
    for (size_t i = 0; i < a->n; i++) {
        const double r = diagonal_of(a, i);
        if (r < 0.0) {
            return tribo_fail(ctx, TRIBO_ERR_INDEFINITE, "r: the diagonal entry of contact %zu is %g", i, r);
        }
    }
    for (size_t i = 0; i < a->n; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            const size_t j = a->col[k];
            double *other = j == i ? &a->val[k] : entry(a, j, i);
            const double x = a->val[k], y = other ? *other : 0.0;
            const double size = sqrt(diagonal_of(a, i)) * sqrt(diagonal_of(a, j));
            if (!isfinite(x)) {
                return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "r of contacts %zu, %zu is %g", i, j, x);
            }
            if (fabs(x - y) > ASYMMETRY * greater(size, greater(fabs(x), fabs(y)))) {
                return tribo_fail(ctx, TRIBO_ERR_NOT_SYMMETRIC, "r of contacts %zu, %zu is %g one way and %g the other", i, j, x,
                                  y);
            }
            if (fabs(x) > (1.0 + ASYMMETRY) * size) {
                return tribo_fail(ctx, TRIBO_ERR_INDEFINITE,
                                  "r of contacts %zu, %zu is %g, more than the root of their diagonal entries' product, %g", i, j,
                                  x, size);
            }
            if (j != i) {
                a->val[k] = other ? x + 0.5 * (y - x) : 0.0;
            }
            if (other) {
                *other = a->val[k];
            }
        }
    }
    return TRIBO_OK;
}

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

static void fill_islands(struct op *op, const struct rows *a, const size_t *label, size_t *place)
{
    const size_t n = a->n;
    memset(op->first, 0, (op->islands + 1) * sizeof *op->first);
    for (size_t i = 0; i < n; i++) {
        op->first[label[i] + 1]++;
    }
    for (size_t k = 0; k < op->islands; k++) {
        op->first[k + 1] += op->first[k];
        op->offset[k] = op->first[k];
    }
    for (size_t i = 0; i < n; i++) {
        place[i] = op->offset[label[i]]++;
        op->member[place[i]] = i;
    }
    size_t entries = 0;
    for (size_t k = 0; k < op->islands; k++) {
        const size_t size = op->first[k + 1] - op->first[k];
        op->offset[k] = entries;
        entries += size * size;
        op->largest = size > op->largest ? size : op->largest;
    }
    op->offset[op->islands] = entries;
    memset(op->block, 0, entries * sizeof *op->block);
    op->row_sum = 1.0;
    for (size_t i = 0; i < n; i++) {
        const size_t k = label[i], size = op->first[k + 1] - op->first[k];
        double *row = op->block + op->offset[k] + (place[i] - op->first[k]) * size;
        double sum = 0.0;
        for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
            if (a->val[e] != 0.0) {
                row[place[a->col[e]] - op->first[k]] = a->val[e];
                sum += fabs(a->val[e]);
            }
        }
        op->diagonal[i] = greater(diagonal_of(a, i), DBL_MIN);
        op->row_sum = greater(op->row_sum, sum / op->diagonal[i]);
    }
}

static int check_definite(const tribo_context *ctx, const struct op *op, struct solver *solver)
{
    for (size_t k = 0; k < op->islands; k++) {
        const size_t size = op->first[k + 1] - op->first[k];
        size_t where;
        double pivot;
        memcpy(solver->g, op->block + op->offset[k], size * size * sizeof *solver->g);
        if (size > 1 && tribo_solver_rank(solver, size, &where, &pivot) < 0) {
            return tribo_fail(ctx, TRIBO_ERR_INDEFINITE,
                              "r is indefinite: relative pivot %g at contact %zu, in a group of %zu coupled contacts", pivot,
                              op->member[op->first[k] + where], size);
        }
    }
    return TRIBO_OK;
}

static size_t square_sum(const size_t *label, size_t *count, size_t n)
{
    size_t sum = 0;
    memset(count, 0, n * sizeof *count);
    for (size_t i = 0; i < n; i++) {
        sum += 2 * count[label[i]]++ + 1;
    }
    return sum;
}

/* Takes a, sorted rows with finite entries, as the operator. Frees a. */
static int install_rows(tribo_context *ctx, struct rows *a)
{
    const size_t n = a->n;
    struct op op = {0};
    struct solver solver = {0};
    int status = symmetrize(ctx, a);
    size_t *label = malloc((n + 1) * sizeof *label), *place = malloc((n + 1) * sizeof *place);
    const int memory = label && place && tribo_op_identity(&op, n);
    if (!status && memory) {
        op.islands = find_islands(a, label, place);
    }
    if (!status && memory && op.islands == n) {
        for (size_t i = 0; i < n; i++) {
            op.diagonal[i] = diagonal_of(a, i);
        }
        status = install_diagonal(ctx, op.diagonal);
        tribo_op_free(&op);
    } else if (!status && memory && allocate_islands(&op, n, square_sum(label, place, n))) {
        fill_islands(&op, a, label, place);
        if (tribo_solver_create(&solver, op.largest)) {
            status = check_definite(ctx, &op, &solver);
            solver.factorizations = 0;
            status = status ? status : install(ctx, &op, &solver);
        } else {
            status = tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for a group of %zu coupled contacts", op.largest);
        }
    } else if (!status) {
        status = tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for an operator of %zu contacts", n);
    }
    if (status) {
        tribo_op_free(&op);
        tribo_solver_free(&solver);
    }
    free(label);
    free(place);
    rows_free(a);
    return status;
}

/* -------------------------------------------------------------------------------------------------- forms of input */

int tribo_set_operator_dense(tribo_context *ctx, const double *r)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const size_t n = ctx->n;
    if (!r && n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "r is NULL");
    }
    size_t entries = 0;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            if (!isfinite(r[i * n + j])) {
                return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "r[%zu][%zu] = %g is not finite", i, j, r[i * n + j]);
            }
            entries += r[i * n + j] != 0.0;
        }
    }
    struct rows a;
    if (!rows_create(&a, n, entries)) {
        return tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for an operator of %zu contacts", n);
    }
    size_t k = 0;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            if (r[i * n + j] != 0.0) {
                a.col[k] = j;
                a.val[k++] = r[i * n + j];
            }
        }
        a.first[i + 1] = k;
    }
    return install_rows(ctx, &a);
}

/* Checks the compressed rows of an [n][columns] matrix called name. */
static int check_rows(const tribo_context *ctx, size_t n, size_t columns, const size_t *rowptr, const size_t *col,
                      const double *val)
{
    if (!rowptr) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "rowptr is NULL");
    }
    if (rowptr[0] != 0) {
        return tribo_fail(ctx, TRIBO_ERR_SIZE, "rowptr[0] = %zu is not 0", rowptr[0]);
    }
    for (size_t i = 0; i < n; i++) {
        if (rowptr[i + 1] < rowptr[i]) {
            return tribo_fail(ctx, TRIBO_ERR_SIZE, "rowptr[%zu] = %zu is less than rowptr[%zu] = %zu", i + 1, rowptr[i + 1], i,
                              rowptr[i]);
        }
    }
    if (rowptr[n] && (!col || !val)) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "%s is NULL", col ? "val" : "col");
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
            if (col[k] >= columns) {
                return tribo_fail(ctx, TRIBO_ERR_RANGE, "col[%zu] = %zu of contact %zu is not below %zu", k, col[k], i, columns);
            }
            if (!isfinite(val[k])) {
                return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "val[%zu] = %g of contact %zu is not finite", k, val[k], i);
            }
        }
    }
    return TRIBO_OK;
}

/* b = a', columns sorted. Entries of a in one row must differ in column, or *row and *col name the first that doesn't. */
static int transpose(struct rows *b, size_t n, size_t columns, const size_t *rowptr, const size_t *col, const double *val)
{
    if (!rows_create(b, columns, rowptr[n])) {
        return 0;
    }
    for (size_t k = 0; k < rowptr[n]; k++) {
        b->first[col[k] + 1]++;
    }
    for (size_t j = 0; j < columns; j++) {
        b->first[j + 1] += b->first[j];
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
            const size_t to = b->first[col[k]]++;
            b->col[to] = i;
            b->val[to] = val[k];
        }
    }
    for (size_t j = columns; j > 0; j--) {
        b->first[j] = b->first[j - 1];
    }
    b->first[0] = 0;
    return 1;
}

/* In the transposed matrix equal columns of a row have become neighbours. */
static int check_duplicates(const tribo_context *ctx, const struct rows *t)
{
    for (size_t j = 0; j < t->n; j++) {
        for (size_t k = t->first[j] + 1; k < t->first[j + 1]; k++) {
            if (t->col[k] == t->col[k - 1]) {
                return tribo_fail(ctx, TRIBO_ERR_DUPLICATE, "contact %zu has column %zu twice", t->col[k], j);
            }
        }
    }
    return TRIBO_OK;
}

int tribo_set_operator_csr(tribo_context *ctx, const size_t *rowptr, const size_t *col, const double *val)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    int status = check_rows(ctx, ctx->n, ctx->n, rowptr, col, val);
    if (status) {
        return status;
    }
    struct rows t, a;
    if (!transpose(&t, ctx->n, ctx->n, rowptr, col, val)) {
        return tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for an operator of %zu contacts", ctx->n);
    }
    status = check_duplicates(ctx, &t);
    if (!status && !transpose(&a, t.n, t.n, t.first, t.col, t.val)) {
        status = tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for an operator of %zu contacts", ctx->n);
    }
    rows_free(&t);
    return status ? status : install_rows(ctx, &a);
}

/* The columns that row i of J diag(w) J' has entries in; t is J'. seen [n] keeps i + 1 for each. With sum [n], adds up
 * the entries too. */
static size_t product_row(size_t i, const struct rows *t, const double *w, const size_t *rowptr, const size_t *col,
                          const double *val, size_t *seen, size_t *column, double *sum)
{
    size_t count = 0;
    for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
        const size_t dof = col[k];
        const double x = val[k] * w[dof];
        for (size_t e = t->first[dof]; x != 0.0 && e < t->first[dof + 1]; e++) {
            const size_t j = t->col[e];
            if (seen[j] != i + 1) {
                seen[j] = i + 1;
                column[count++] = j;
                sum[j] = 0.0;
            }
            sum[j] += x * t->val[e];
        }
    }
    return count;
}

/* a = J diag(w) J', columns sorted. */
static int product(struct rows *a, size_t n, const struct rows *t, const double *w, const size_t *rowptr, const size_t *col,
                   const double *val)
{
    size_t *seen = calloc(n + 1, sizeof *seen), *column = malloc((n + 1) * sizeof *column);
    double *sum = malloc((n + 1) * sizeof *sum);
    struct rows unsorted = {0};
    int done = 0;
    if (seen && column && sum) {
        size_t entries = 0;
        for (size_t i = 0; i < n; i++) {
            entries += product_row(i, t, w, rowptr, col, val, seen, column, sum);
        }
        memset(seen, 0, n * sizeof *seen);
        if (rows_create(&unsorted, n, entries)) {
            for (size_t i = 0; i < n; i++) {
                const size_t count = product_row(i, t, w, rowptr, col, val, seen, column, sum);
                const size_t first = unsorted.first[i];
                for (size_t k = 0; k < count; k++) {
                    unsorted.col[first + k] = column[k];
                    unsorted.val[first + k] = sum[column[k]];
                }
                unsorted.first[i + 1] = first + count;
            }
            /* it is symmetric, and transposing sorts */
            done = transpose(a, n, n, unsorted.first, unsorted.col, unsorted.val);
            rows_free(&unsorted);
        }
    }
    free(seen);
    free(column);
    free(sum);
    return done;
}

int tribo_set_operator_mass(tribo_context *ctx, size_t ndof, const double *inverse_mass, const size_t *rowptr, const size_t *col,
                            const double *val)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (ndof >= SIZE_MAX / 64) {
        return tribo_fail(ctx, TRIBO_ERR_SIZE, "ndof = %zu is too large", ndof);
    }
    int status = tribo_check_nonnegative(ctx, "inverse_mass", inverse_mass, ndof);
    if (!status) {
        status = check_rows(ctx, ctx->n, ndof, rowptr, col, val);
    }
    if (status) {
        return status;
    }
    struct rows t, a;
    if (!transpose(&t, ctx->n, ndof, rowptr, col, val)) {
        return tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for an operator of %zu contacts", ctx->n);
    }
    status = check_duplicates(ctx, &t);
    if (!status && !product(&a, ctx->n, &t, inverse_mass, rowptr, col, val)) {
        status = tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for an operator of %zu contacts", ctx->n);
    }
    rows_free(&t);
    return status ? status : install_rows(ctx, &a);
}
