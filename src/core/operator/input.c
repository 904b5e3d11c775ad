/* SPDX-License-Identifier: BSD-3-Clause */
/* The operator R: forms of input, and their checks. Every form becomes sorted compressed rows. The operator of a context is
 * replaced when all checks are done. */
#include <stdlib.h>

#include "core/calls.h"
#include "numerics/csr.h"

/* Entries (i,j) and (j,i) may differ by this part: the caller's rounding. */
#define ASYMMETRY 1e-10

/* Entries up to this part of the diagonal are rounding of an inverse. */
#define NEGLIGIBLE 1e-17

/* Makes a exactly symmetric, diagonal [n] = its diagonal; a status. Entries up to this part of the diagonal become 0. */
static int symmetrize(tribo_context *ctx, const struct csr *a, double negligible, double *diagonal)
{
    for (size_t i = 0; i < a->n; i++) {
        const double *r = tribo_csr_entry(a, i, i);
        diagonal[i] = r ? *r : 0.0;
        if (diagonal[i] < 0.0) {
            return tribo_fail(ctx, TRIBO_ERR_INDEFINITE, "r: the diagonal entry of contact %zu is %g", i, diagonal[i]);
        }
    }
    for (size_t i = 0; i < a->n; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            const size_t j = a->col[k];
            double *other = j == i ? &a->val[k] : tribo_csr_entry(a, j, i);
            const double x = a->val[k], y = other ? *other : 0.0;
            const double size = sqrt(diagonal[i]) * sqrt(diagonal[j]);
            if (!isfinite(x)) {
                return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "r of contacts %zu, %zu is %g", i, j, x);
            }
            if (fabs(0.5 * x - 0.5 * y) > 0.5 * ASYMMETRY * greater(size, greater(fabs(x), fabs(y)))) {
                return tribo_fail(ctx, TRIBO_ERR_NOT_SYMMETRIC, "r of contacts %zu, %zu is %.15g one way and %.15g the other", i,
                                  j, x, y);
            }
            if (fabs(x) - size > ASYMMETRY * size) {
                return tribo_fail(ctx, TRIBO_ERR_INDEFINITE,
                                  "r of contacts %zu, %zu is %.15g, more than the root of their diagonal entries' product, %.15g",
                                  i, j, x, size);
            }
            const int counts = j == i || lesser(fabs(x), fabs(y)) > negligible * size;
            a->val[k] = counts ? x + 0.5 * (y - x) : 0.0;
            if (other) {
                *other = a->val[k];
            }
        }
    }
    return TRIBO_OK;
}

static int input_out_of_memory(tribo_context *ctx)
{
    return tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for an operator of %zu contact%s", ctx->n, plural(ctx->n));
}

/* Replaces the operator and its memory; if there is no memory for clusters of op, the old ones stay. */
static int install(tribo_context *ctx, struct delassus *op, struct memory *m)
{
    const int status = tribo_clusters_renew(ctx, ctx->plane.count, ctx->plane.first, op, m);
    if (status) {
        tribo_operator_release(op);
        tribo_memory_free(m);
        return status;
    }
    m->problem.work.factorizations += ctx->memory.problem.work.factorizations;
    m->problem.work.updates += ctx->memory.problem.work.updates;
    tribo_operator_release(ctx->op);
    tribo_memory_free(&ctx->memory);
    ctx->op = op;
    ctx->memory = *m;
    ctx->last.slips = NO_SLIPS;
    tribo_refresh(ctx);
    return TRIBO_OK;
}

/* Fails if the caller must not change the operator, or for too many degrees of freedom; a status. */
static int check_change(tribo_context *ctx, size_t ndof)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (ndof >= SIZE_MAX / 64) {
        return tribo_fail(ctx, TRIBO_ERR_SIZE, "ndof = %zu is too large", ndof);
    }
    return ctx->fixed ? tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED,
                                   "the operator is fixed, as that of a tribo_system is: set that of a copy (tribo_clone)")
                      : TRIBO_OK;
}

int tribo_fix_operator(tribo_context *ctx)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    ctx->fixed = 1;
    return TRIBO_OK;
}

int tribo_set_operator_diagonal(tribo_context *ctx, const double *r)
{
    int status = check_change(ctx, 0);
    status = status ? status : tribo_check_nonnegative(ctx, "r", r, ctx->n);
    const double none = 0.0;
    struct memory m = {0};
    if (status) {
        return status;
    }
    struct delassus *op = tribo_operator_diagonal(ctx->n, r ? r : &none);
    return op ? install(ctx, op, &m) : input_out_of_memory(ctx);
}

/* Takes rows a, columns ascending, as the operator, and frees them; a status. negligible: see symmetrize; from: see
 * tribo_operator_create. */
static int install_rows(tribo_context *ctx, struct csr *a, double negligible, const struct inertia *from)
{
    struct delassus *op;
    struct memory m;
    double *diagonal = malloc((ctx->n + 1) * sizeof *diagonal);
    int status = diagonal ? symmetrize(ctx, a, negligible, diagonal) : TRIBO_ERR_MEMORY;
    status = status ? status : tribo_operator_create(&op, &m, a, diagonal, from, ctx);
    free(diagonal);
    tribo_csr_free(a);
    return status == TRIBO_ERR_MEMORY ? input_out_of_memory(ctx) : status ? status : install(ctx, op, &m);
}

/* -------------------------------------------------------------------------------------------------- forms of input */

/* Checks the rows of a matrix [n][columns], t = its transpose, in which equal columns of a row are neighbours; a status. */
static int input_read(tribo_context *ctx, size_t columns, const size_t *rowptr, const size_t *col, const double *val,
                      struct csr *t)
{
    const size_t n = ctx->n;
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
    if (!tribo_csr_transpose(t, n, columns, rowptr, col, val)) {
        return input_out_of_memory(ctx);
    }
    for (size_t j = 0; j < t->n; j++) {
        for (size_t k = t->first[j] + 1; k < t->first[j + 1]; k++) {
            if (t->col[k] == t->col[k - 1]) {
                const size_t i = t->col[k];
                tribo_csr_free(t);
                return tribo_fail(ctx, TRIBO_ERR_DUPLICATE, "contact %zu has column %zu twice", i, j);
            }
        }
    }
    return TRIBO_OK;
}

int tribo_set_operator_csr(tribo_context *ctx, const size_t *rowptr, const size_t *col, const double *val)
{
    struct csr t, a;
    int status = check_change(ctx, 0);
    status = status ? status : input_read(ctx, ctx->n, rowptr, col, val, &t);
    if (status) {
        return status;
    }
    const int done = tribo_csr_transpose(&a, t.n, t.n, t.first, t.col, t.val);
    tribo_csr_free(&t);
    return done ? install_rows(ctx, &a, 0.0, NULL) : input_out_of_memory(ctx);
}

int tribo_set_operator_mass(tribo_context *ctx, size_t ndof, const double *inverse_mass, const size_t *rowptr, const size_t *col,
                            const double *val)
{
    struct csr t, a;
    int status = check_change(ctx, ndof);
    status = status ? status : tribo_check_nonnegative(ctx, "inverse_mass", inverse_mass, ndof);
    status = status ? status : input_read(ctx, ndof, rowptr, col, val, &t);
    if (status) {
        return status;
    }
    const struct inertia from = {inverse_mass, rowptr, col, val, &t};
    const int done = tribo_csr_product(&a, ctx->n, &t, inverse_mass, rowptr, col, val);
    status = done ? install_rows(ctx, &a, 0.0, &from) : input_out_of_memory(ctx);
    tribo_csr_free(&t);
    return status;
}

/* Columns R e_j: given, or J M^-1 J' e_j by the caller's mass matrix. */
struct columns {
    const double *dense;        /* [n][n] R; NULL: by apply, f -> M^-1 f */
    const size_t *rowptr, *col; /* J */
    const double *val;
    size_t ndof;
    int (*apply)(size_t ndof, const double *force, double *acceleration, void *data);
    void *data;
};

/* column [n] = R e_j, where apply finds it; a status. work [2 ndof] is zero between calls, but its second half. */
static int find_column(tribo_context *ctx, const struct columns *m, size_t j, double *work, double *column)
{
    double *acceleration = work + m->ndof;
    for (size_t k = m->rowptr[j]; k < m->rowptr[j + 1]; k++) {
        work[m->col[k]] = m->val[k];
    }
    const int answer = m->apply(m->ndof, work, acceleration, m->data);
    for (size_t k = m->rowptr[j]; k < m->rowptr[j + 1]; k++) {
        work[m->col[k]] = 0.0;
    }
    if (answer) {
        return tribo_fail(ctx, TRIBO_ERR_CALLBACK, "apply answered %d for contact %zu", answer, j);
    }
    for (size_t i = 0; i < ctx->n; i++) {
        column[i] = 0.0;
        for (size_t k = m->rowptr[i]; k < m->rowptr[i + 1]; k++) {
            column[i] += m->val[k] * acceleration[m->col[k]];
        }
        if (!isfinite(column[i])) {
            return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "apply makes r of contacts %zu, %zu %g", i, j, column[i]);
        }
    }
    return TRIBO_OK;
}

/* Takes columns, which are rows since R is symmetric, without their zeros as the operator; a status. */
static int install_columns(tribo_context *ctx, const struct columns *m)
{
    const size_t n = ctx->n;
    struct csr a = {0};
    size_t room = n;
    double *work = calloc(2 * m->ndof + n + 1, sizeof *work), *column = work ? work + 2 * m->ndof : NULL;
    int status = work && tribo_csr_create(&a, n, room) ? TRIBO_OK : input_out_of_memory(ctx);
    for (size_t j = 0; !status && j < n; j++) {
        const double *row = m->dense ? m->dense + j * n : column;
        status = m->dense ? TRIBO_OK : find_column(ctx, m, j, work, column);
        if (!status && room - a.first[j] < n) {
            const struct csr less = a;
            room = 2 * room + n;
            status = tribo_csr_create(&a, n, room) ? TRIBO_OK : input_out_of_memory(ctx);
            if (!status) {
                memcpy(a.first, less.first, (j + 1) * sizeof *a.first);
                memcpy(a.col, less.col, less.first[j] * sizeof *a.col);
                memcpy(a.val, less.val, less.first[j] * sizeof *a.val);
            }
            free(less.first);
        }
        for (size_t i = 0, end = status ? 0 : a.first[j]; !status && i < n; i++) {
            a.col[end] = i;
            a.val[end] = row[i];
            end += row[i] != 0.0;
            a.first[j + 1] = end;
        }
    }
    free(work);
    if (status) {
        tribo_csr_free(&a);
    }
    return status ? status : install_rows(ctx, &a, m->dense ? 0.0 : NEGLIGIBLE, NULL);
}

int tribo_set_operator_dense(tribo_context *ctx, const double *r)
{
    const int status = check_change(ctx, 0);
    if (status) {
        return status;
    }
    const size_t n = ctx->n;
    if (!r && n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "r is NULL");
    }
    for (size_t k = 0; k < n * n; k++) {
        if (!isfinite(r[k])) {
            return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "r[%zu][%zu] = %g is not finite", k / n, k % n, r[k]);
        }
    }
    return install_columns(ctx, &(const struct columns){.dense = r});
}

int tribo_set_operator_callback(tribo_context *ctx, size_t ndof,
                                int (*apply)(size_t ndof, const double *force, double *acceleration, void *data), void *data,
                                const size_t *rowptr, const size_t *col, const double *val)
{
    struct csr t;
    int status = check_change(ctx, ndof);
    if (!status && !apply) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "apply is NULL");
    }
    status = status ? status : input_read(ctx, ndof, rowptr, col, val, &t);
    if (status) {
        return status;
    }
    tribo_csr_free(&t);
    return install_columns(ctx, &(const struct columns){NULL, rowptr, col, val, ndof, apply, data});
}
