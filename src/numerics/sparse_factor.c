/* SPDX-License-Identifier: BSD-3-Clause */
#include "sparse_factor.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tribo/tribo.h"

#if defined(TRIBO_CHOLMOD)

#include <cholmod.h>

/* Workspace of solves, kept for the next solve of as many vectors. */
struct room {
    cholmod_dense *solution, *work[2];
};

struct sparse_factor {
    cholmod_common common;
    cholmod_factor *l;
    struct room room[2]; /* of one vector; of many */
    double *column;      /* [n] workspace */
};

static void sparse_factor_start(cholmod_common *common)
{
    cholmod_l_start(common);
    common->print = 0;
    common->supernodal = CHOLMOD_SUPERNODAL;
    common->final_ll = 1;
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_AMD;
    common->postorder = 1;
    common->quick_return_if_not_posdef = 1;
}

/* Returns a as CHOLMOD reads it: rows as columns, and the lower triangle as the upper one. */
static cholmod_sparse view_of(const struct matrix *a)
{
    return (cholmod_sparse){.nrow = a->rows,
                            .ncol = a->cols,
                            .nzmax = a->first[a->rows],
                            .p = a->first,
                            .i = a->col,
                            .x = a->val,
                            .stype = 1,
                            .itype = CHOLMOD_LONG,
                            .xtype = CHOLMOD_REAL,
                            .dtype = CHOLMOD_DOUBLE,
                            .sorted = 1,
                            .packed = 1};
}

/* Returns the lower triangle of P A P', or NULL if out of memory. Frees spent, which a may be a view of. */
static cholmod_sparse *half_of(cholmod_sparse *a, struct matrix *spent, const cholmod_factor *l, cholmod_common *common)
{
    cholmod_sparse *half = l ? cholmod_l_ptranspose(a, 1, l->Perm, NULL, 0, common) : NULL;
    if (spent) {
        tribo_matrix_free(spent);
    }
    return half;
}

/* x [count][n] = the solution of the system `what` of CHOLMOD. Makes the room of count vectors before: cholmod_l_solve2 goes on
 * without work[0] where there is no memory. Returns 1, or 0 if out of memory. */
static int sparse_factor_apply(struct sparse_factor *f, int what, size_t count, double *x)
{
    const size_t n = f->l->n, most = f->l->maxesize;
    cholmod_dense b = {
        .nrow = n, .ncol = count, .nzmax = n * count, .d = n, .x = x, .xtype = CHOLMOD_REAL, .dtype = CHOLMOD_DOUBLE};
    struct room *room = &f->room[count > 1];
    if (!cholmod_l_ensure_dense(&room->solution, n, count, n, CHOLMOD_REAL, &f->common) ||
        !cholmod_l_ensure_dense(&room->work[0], n, count, n, CHOLMOD_REAL, &f->common) ||
        !cholmod_l_ensure_dense(&room->work[1], count, most, count, CHOLMOD_REAL, &f->common) ||
        !cholmod_l_solve2(what, f->l, &b, NULL, &room->solution, NULL, &room->work[0], &room->work[1], &f->common)) {
        return 0;
    }
    memcpy(x, room->solution->x, n * count * sizeof *x);
    return 1;
}

static int status_of(const cholmod_common *common)
{
    return common->status == CHOLMOD_OUT_OF_MEMORY || common->status == CHOLMOD_TOO_LARGE ? TRIBO_ERR_MEMORY
           : common->status == CHOLMOD_NOT_POSDEF                                         ? TRIBO_ERR_INDEFINITE
                                                                                          : TRIBO_OK;
}

static void sparse_factor_destroy(struct sparse_factor *f)
{
    if (f) {
        cholmod_l_free_factor(&f->l, &f->common);
        for (size_t k = 0; k < 2; k++) {
            cholmod_l_free_dense(&f->room[k].solution, &f->common);
            cholmod_l_free_dense(&f->room[k].work[0], &f->common);
            cholmod_l_free_dense(&f->room[k].work[1], &f->common);
        }
        cholmod_l_finish(&f->common);
        free(f->column);
        free(f);
    }
}

static int sparse_factor_create(struct sparse_factor **factor, const struct matrix *a, struct matrix *spent, size_t *where)
{
    struct sparse_factor *f = calloc(1, sizeof *f);
    double nothing[2] = {0.0, 0.0};
    if (!f) {
        return TRIBO_ERR_MEMORY;
    }
    sparse_factor_start(&f->common);
    /* cholmod_l_factorize would keep all of a beside its half. */
    cholmod_sparse view = view_of(a);
    f->l = cholmod_l_analyze(&view, &f->common);
    cholmod_sparse *half = half_of(&view, spent, f->l, &f->common);
    if (half) {
        cholmod_l_super_numeric(half, NULL, nothing, f->l, &f->common);
    }
    cholmod_l_free_sparse(&half, &f->common);
    int status = status_of(&f->common);
    f->column = f->l ? calloc(f->l->n + 1, sizeof *f->column) : NULL;
    /* Makes the room of single solves, which cannot fail afterwards. */
    status = status || (f->column && sparse_factor_apply(f, CHOLMOD_A, 1, f->column)) ? status : TRIBO_ERR_MEMORY;
    if (status) {
        const size_t row = f->l ? f->l->minor : 0; /* of P A P' */
        *where = f->l && row < f->l->n ? (size_t)((const SuiteSparse_long *)f->l->Perm)[row] : 0;
        sparse_factor_destroy(f);
        return status;
    }
    *factor = f;
    return TRIBO_OK;
}

static int sparse_factor_solve(struct sparse_factor *f, size_t count, double *x)
{
    return sparse_factor_apply(f, CHOLMOD_A, count, x);
}

static void sparse_factor_half_solve(struct sparse_factor *f, int back, double *x, size_t cols)
{
    for (size_t j = 0; j < cols; j++) {
        for (size_t i = 0; i < f->l->n; i++) {
            f->column[i] = x[i * cols + j];
        }
        sparse_factor_apply(f, back ? CHOLMOD_Lt : CHOLMOD_P, 1, f->column);
        sparse_factor_apply(f, back ? CHOLMOD_Pt : CHOLMOD_L, 1, f->column);
        for (size_t i = 0; i < f->l->n; i++) {
            x[i * cols + j] = f->column[i];
        }
    }
}

static int sparse_inertia(const struct sparse_factor *like, const struct matrix *a, struct matrix *spent, const double *size,
                          struct inertia *found)
{
    cholmod_common common;
    double nothing[2] = {0.0, 0.0}, *sum = calloc(a->rows + 1, sizeof *sum); /* [n] sum_k |L_ik|^2 |D_k| */
    cholmod_sparse view = view_of(a);
    struct inertia all = {0, 0.0};
    sparse_factor_start(&common);
    common.supernodal = CHOLMOD_SIMPLICIAL; /* the only one of CHOLMOD's factors that may be indefinite */
    common.final_ll = 0;
    common.grow2 = 0;
    common.method[0].ordering = like ? CHOLMOD_GIVEN : CHOLMOD_AMD;
    cholmod_factor *l = cholmod_l_analyze_p(&view, like ? like->l->Perm : NULL, NULL, 0, &common);
    cholmod_sparse *half = half_of(&view, spent, l, &common), *upper = half ? cholmod_l_transpose(half, 1, &common) : NULL;
    cholmod_l_free_sparse(&half, &common);
    if (upper) {
        cholmod_l_rowfac(upper, NULL, nothing, 0, l->n, l, &common);
    }
    int status = sum ? status_of(&common) : TRIBO_ERR_MEMORY;
    status = !status && l->minor < l->n ? TRIBO_ERR_INDEFINITE : status;
    for (size_t k = 0; !status && k < l->n; k++) { /* a column of L begins with its entry of D */
        const SuiteSparse_long *first = l->p, *count = l->nz, *row = l->i, *order = l->Perm;
        const double *column = (const double *)l->x + first[k], d = column[0];
        status = isfinite(d) ? TRIBO_OK : TRIBO_ERR_INDEFINITE;
        all.negative += d < 0.0;
        sum[k] += fabs(d);
        for (SuiteSparse_long e = 1; e < count[k]; e++) {
            sum[row[first[k] + e]] += column[e] * column[e] * fabs(d);
        }
        /* row k is complete: columns behind k begin below it */
        all.growth = greater(all.growth, sum[k] / fabs(size[order[k]]));
    }
    *found = status ? *found : all;
    free(sum);
    cholmod_l_free_sparse(&upper, &common);
    cholmod_l_free_factor(&l, &common);
    cholmod_l_finish(&common);
    return status;
}

static const struct sparse_solver cholmod = {
    sparse_factor_create, sparse_factor_destroy, sparse_factor_solve, sparse_factor_half_solve, sparse_inertia,
};

const struct sparse_solver *const tribo_cholmod = &cholmod;

#else

const struct sparse_solver *const tribo_cholmod = NULL;

#endif
