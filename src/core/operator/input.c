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

void tribo_pattern_release(struct pattern *p)
{
    if (p && TRIBO_SHARED_ADD(p->references, SIZE_MAX) == 0) { /* one less */
        free(p);
    }
}

void tribo_renewal_free(struct renewal *r)
{
    if (r) {
        tribo_operator_release(r->op);
        tribo_memory_free(&r->memory);
        tribo_clusters_free(&r->plane);
        tribo_csr_free(&r->drafts.t);
        tribo_csr_free(&r->drafts.a);
        free(r->drafts.diagonal);
    }
}

/* Makes clusters of the operator in r, and exchanges the two for those of ctx; a status. After a failure ctx has what it had. */
static int install(tribo_context *ctx, struct renewal *r)
{
    const int status = tribo_clusters_make(&r->plane, ctx, ctx->plane.count, ctx->plane.first, r->op, &r->memory);
    if (status) {
        return status;
    }
    const struct renewal spent = {ctx->op, ctx->memory, ctx->plane, r->drafts};
    r->memory.problem.work.factorizations += spent.memory.problem.work.factorizations;
    r->memory.problem.work.updates += spent.memory.problem.work.updates;
    ctx->op = r->op;
    ctx->memory = r->memory;
    ctx->plane = r->plane;
    *r = spent;
    ctx->last.slips = NO_SLIPS;
    tribo_refresh(ctx);
    return TRIBO_OK;
}

/* Ends a tribo_set_operator_...: frees r, and unless status is a failure gives ctx form and pattern, which is released otherwise.
 * Returns status. */
static int finish(tribo_context *ctx, struct renewal *r, int status, int form, struct pattern *pattern)
{
    tribo_renewal_free(r);
    tribo_pattern_release(status ? pattern : ctx->pattern);
    if (!status) {
        tribo_renewal_free(ctx->renewal);
        free(ctx->renewal);
        ctx->renewal = NULL;
        ctx->pattern = pattern;
        ctx->form = form;
    }
    return status;
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

/* Allocates the arrays of drafts but t and a, unless drafts have these arrays. Returns 0 if out of memory. */
static int allocate_drafts(const tribo_context *ctx, struct drafts *d)
{
    const size_t n = ctx->n;
    return d->diagonal || ALLOCATE(ARRAY(d->diagonal, n + 1), ARRAY(d->x, 2 * n + 1), ARRAY(d->place, 4 * n + 1));
}

/* Takes rows drafts.a as the operator; a status. negligible: see symmetrize; from: see tribo_operator_create. */
static int put_rows(tribo_context *ctx, struct renewal *r, double negligible, const struct inertia *from)
{
    int status = allocate_drafts(ctx, &r->drafts) ? TRIBO_OK : TRIBO_ERR_MEMORY;
    status = status ? status : symmetrize(ctx, &r->drafts.a, negligible, r->drafts.diagonal);
    status = status ? status : tribo_operator_create(&r->op, &r->memory, &r->drafts, from, ctx);
    return status == TRIBO_ERR_MEMORY ? input_out_of_memory(ctx) : status ? status : install(ctx, r);
}

/* -------------------------------------------------------------------------------------------------- forms of input */

/* Checks the places of the rows of a matrix [n][columns]; a status. */
static int check_rows(tribo_context *ctx, size_t columns, const size_t *rowptr, const size_t *col)
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
    if (rowptr[n] && !col) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "col is NULL");
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
            if (col[k] >= columns) {
                return tribo_fail(ctx, TRIBO_ERR_RANGE, "col[%zu] = %zu of contact %zu is not below %zu", k, col[k], i, columns);
            }
        }
    }
    return TRIBO_OK;
}

/* t = the transpose of a matrix [n][columns] by rows, in which equal columns of a row are neighbours. Checks values, and that no
 * row has a column twice; a status. */
static int transpose_rows(tribo_context *ctx, struct csr *t, size_t columns, const size_t *rowptr, const size_t *col,
                          const double *val)
{
    if (rowptr[ctx->n] && !val) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "val is NULL");
    }
    for (size_t i = 0; i < ctx->n; i++) {
        for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
            if (!isfinite(val[k])) {
                return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "val[%zu] = %g of contact %zu is not finite", k, val[k], i);
            }
        }
    }
    if (!tribo_csr_transpose(t, ctx->n, columns, rowptr, col, val)) {
        return input_out_of_memory(ctx);
    }
    for (size_t j = 0; j < t->n; j++) {
        for (size_t k = t->first[j] + 1; k < t->first[j + 1]; k++) {
            if (t->col[k] == t->col[k - 1]) {
                return tribo_fail(ctx, TRIBO_ERR_DUPLICATE, "contact %zu has column %zu twice", t->col[k], j);
            }
        }
    }
    return TRIBO_OK;
}

/* Takes val, of this form with this pattern, an argument of this name, as the operator; a status. */
static int put_values(tribo_context *ctx, struct renewal *r, int form, const struct pattern *p, const char *name,
                      const double *val)
{
    const size_t n = ctx->n;
    struct drafts *d = &r->drafts;
    struct csr *a = &d->a, *t = &d->t;
    if (form == FORM_DIAGONAL) {
        const double none = 0.0;
        const int status = tribo_check_nonnegative(ctx, name, val, n);
        struct delassus *op = status ? NULL : tribo_operator_diagonal(r->op, n, n ? val : &none);
        if (!op) {
            return status ? status : input_out_of_memory(ctx);
        }
        r->op = op;
        tribo_memory_clear(&r->memory);
        return install(ctx, r);
    }
    if (form == FORM_DENSE) {
        if (!val && n) {
            return tribo_fail(ctx, TRIBO_ERR_NULL, "%s is NULL", name);
        }
        for (size_t k = 0; k < n * n; k++) {
            if (!isfinite(val[k])) {
                return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "%s[%zu][%zu] = %g is not finite", name, k / n, k % n, val[k]);
            }
        }
        if (!a->first && !tribo_csr_create(a, n, n * n)) { /* room for all entries: further values may have other zeros */
            return input_out_of_memory(ctx);
        }
        for (size_t i = 0, end = 0; i < n; i++) {
            for (size_t j = 0; j < n; j++) {
                a->col[end] = j;
                a->val[end] = val[i * n + j];
                end += val[i * n + j] != 0.0;
            }
            a->first[i + 1] = end;
        }
        return put_rows(ctx, r, 0.0, NULL);
    }
    const struct inertia from = {p->inverse_mass, p->rowptr, p->col, val, t};
    const int status = transpose_rows(ctx, t, p->ndof, p->rowptr, p->col, val), mass = form == FORM_MASS;
    const int made =
        !status && (mass ? allocate_drafts(ctx, d) && tribo_csr_product(a, d->place, t, from.w, p->rowptr, p->col, val, n)
                         : tribo_csr_transpose(a, t->n, t->n, t->first, t->col, t->val));
    return status ? status : made ? put_rows(ctx, r, 0.0, mass ? &from : NULL) : input_out_of_memory(ctx);
}

/* Sets an operator of this form by val; rows: of a matrix [n][ndof], of FORM_ROWS and FORM_MASS; a status. */
static int set_by_values(tribo_context *ctx, int form, size_t ndof, const double *inverse_mass, const size_t *rowptr,
                         const size_t *col, const double *val)
{
    const int by_rows = form == FORM_ROWS || form == FORM_MASS;
    struct renewal own = {0};
    struct pattern *p = NULL, like = {.references = 1, .ndof = ndof};
    int status = check_change(ctx, ndof);
    status = status || form != FORM_MASS ? status : tribo_check_nonnegative(ctx, "inverse_mass", inverse_mass, ndof);
    status = status || !by_rows ? status : check_rows(ctx, ndof, rowptr, col);
    if (!status && rowptr) {
        const size_t n = ctx->n, masses = form == FORM_MASS ? ndof : 0;
        if (!ALLOCATE(ARRAY(p, 1), ARRAY(like.inverse_mass, masses), ARRAY(like.rowptr, n + 1), ARRAY(like.col, rowptr[n]))) {
            return input_out_of_memory(ctx);
        }
        tribo_copy(like.inverse_mass, inverse_mass, masses);
        memcpy(like.rowptr, rowptr, (n + 1) * sizeof *rowptr);
        memcpy(like.col, rowptr[n] ? col : like.rowptr, rowptr[n] * sizeof *col);
        *p = like;
    }
    status = status ? status : put_values(ctx, &own, form, p, by_rows ? "val" : "r", val);
    return finish(ctx, &own, status, form, p);
}

int tribo_set_operator_diagonal(tribo_context *ctx, const double *r)
{
    return set_by_values(ctx, FORM_DIAGONAL, 0, NULL, NULL, NULL, r);
}

int tribo_set_operator_dense(tribo_context *ctx, const double *r)
{
    return set_by_values(ctx, FORM_DENSE, 0, NULL, NULL, NULL, r);
}

int tribo_set_operator_csr(tribo_context *ctx, const size_t *rowptr, const size_t *col, const double *val)
{
    return set_by_values(ctx, FORM_ROWS, ctx ? ctx->n : 0, NULL, rowptr, col, val);
}

int tribo_set_operator_mass(tribo_context *ctx, size_t ndof, const double *inverse_mass, const size_t *rowptr, const size_t *col,
                            const double *val)
{
    return set_by_values(ctx, FORM_MASS, ndof, inverse_mass, rowptr, col, val);
}

/* ------------------------------------------------------------------------------------------------- by the caller's solver */

/* Moves the first rows of a to memory for entries. Returns 0 if out of memory. */
static int widen_rows(struct csr *a, size_t rows, size_t entries)
{
    struct csr wide;
    const int done = tribo_csr_create(&wide, a->n, entries);
    if (done) {
        memcpy(wide.first, a->first, (rows + 1) * sizeof *a->first);
        memcpy(wide.col, a->col, a->first[rows] * sizeof *a->col);
        memcpy(wide.val, a->val, a->first[rows] * sizeof *a->val);
        tribo_csr_free(a);
        *a = wide;
    }
    return done;
}

int tribo_set_operator_callback(tribo_context *ctx, size_t ndof,
                                int (*apply)(size_t ndof, const double *force, double *acceleration, void *data), void *data,
                                const size_t *rowptr, const size_t *col, const double *val)
{
    struct renewal own = {0};
    struct csr *a = &own.drafts.a;
    int status = check_change(ctx, ndof);
    if (!status && !apply) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "apply is NULL");
    }
    status = status ? status : check_rows(ctx, ndof, rowptr, col);
    status = status ? status : transpose_rows(ctx, &own.drafts.t, ndof, rowptr, col, val);
    if (status) {
        return finish(ctx, &own, status, FORM_CALLBACK, NULL);
    }
    /* Columns J M^-1 J' e_j are rows, since R is symmetric; without their zeros. */
    const size_t n = ctx->n;
    size_t room = n;
    double *force = calloc(2 * ndof + 1, sizeof *force), *acceleration = force ? force + ndof : NULL;
    status = force && tribo_csr_create(a, n, room) ? TRIBO_OK : input_out_of_memory(ctx);
    for (size_t j = 0; !status && j < n; j++) {
        for (size_t k = rowptr[j]; k < rowptr[j + 1]; k++) {
            force[col[k]] = val[k];
        }
        const int answer = apply(ndof, force, acceleration, data);
        for (size_t k = rowptr[j]; k < rowptr[j + 1]; k++) {
            force[col[k]] = 0.0;
        }
        status = answer ? tribo_fail(ctx, TRIBO_ERR_CALLBACK, "apply answered %d for contact %zu", answer, j) : TRIBO_OK;
        if (!status && room - a->first[j] < n) {
            room = 2 * room + n;
            status = widen_rows(a, j, room) ? TRIBO_OK : input_out_of_memory(ctx);
        }
        for (size_t i = 0, end = status ? 0 : a->first[j]; !status && i < n; i++) {
            double r = 0.0;
            for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
                r += val[k] * acceleration[col[k]];
            }
            if (!isfinite(r)) {
                status = tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "apply makes r of contacts %zu, %zu %g", i, j, r);
            }
            a->col[end] = i;
            a->val[end] = r;
            end += r != 0.0;
            a->first[j + 1] = end;
        }
    }
    free(force);
    status = status ? status : put_rows(ctx, &own, NEGLIGIBLE, NULL);
    return finish(ctx, &own, status, FORM_CALLBACK, NULL);
}

/* ---------------------------------------------------------------------------------------------------- new values */

size_t tribo_operator_values(const tribo_context *ctx)
{
    return ctx->form == FORM_DIAGONAL ? ctx->n
           : ctx->form == FORM_DENSE  ? ctx->n * ctx->n
           : ctx->pattern             ? ctx->pattern->rowptr[ctx->n]
                                      : 0;
}

int tribo_update_operator(tribo_context *ctx, const double *val)
{
    int status = check_change(ctx, 0);
    status = status ? status : tribo_need_operator(ctx, ctx);
    if (status || ctx->form == FORM_NONE) {
        return status;
    }
    if (ctx->form == FORM_CALLBACK) {
        return tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED, "the operator was set by a callback: set another one");
    }
    if (!ctx->renewal && !(ctx->renewal = calloc(1, sizeof *ctx->renewal))) {
        return input_out_of_memory(ctx);
    }
    struct renewal *r = ctx->renewal;
    if (r->op && TRIBO_SHARED_ADD(r->op->references, (size_t)0) > 1) {
        tribo_operator_release(r->op); /* a clone has it */
        r->op = NULL;
    }
    status = put_values(ctx, r, ctx->form, ctx->pattern, "val", val);
    if (status || ctx->set.sharing != TRIBO_SHARE_PREVIOUS) {
        return status;
    }
    /* Previous forces are those in the memory of the spent operator: after a failure of the caller's law last.f is not finite. */
    for (size_t g = 0; g < r->op->groups; g++) {
        const struct box_qp *p = tribo_memory_problem(r->op, &r->memory, g);
        for (size_t k = 0; k < p->group->size; k++) {
            ctx->last.f[p->member[k]] = p->x[k];
        }
    }
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->last.f[i] = isfinite(ctx->last.f[i]) ? ctx->last.f[i] : 0.0;
    }
    tribo_keep_forces(ctx);
    tribo_clusters_keep(&ctx->plane, &r->plane, ctx->n);
    return TRIBO_OK;
}
