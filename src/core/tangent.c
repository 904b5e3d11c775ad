/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives of the forces of all contacts by velocities, accelerations and limits. With the sets of the last balance they are
 * linear: contacts inside their box (in the partition: all near stick) move so that accelerations, or f_eq, stay balanced; the
 * others follow their law or their bound. */
#include "calls.h"
#include "own.h"

/* Returns the change of a force by its law, f_eq fixed. */
static double law_change(const tribo_context *ctx, const struct change *d, size_t i)
{
    const struct tangents *t = &ctx->last.tangent;
    return product(t->dv[i], tribo_entry(d->v, i)) + product(t->dlimit[i], tribo_limit_change(ctx, d, i));
}

/* Returns the change of kappa = slope v, or of the shift of a law of the caller. */
static double relaxation_change(const tribo_context *ctx, const struct change *d, size_t i)
{
    if (tribo_is_own(ctx)) {
        return -law_change(ctx, d, i);
    }
    const struct contacts *c = &ctx->follow.contacts;
    const double v = ctx->last.v[i], by_limit = product(c->rate[i], v);
    const double rate = tribo_slope_of(c, i) + product(by_limit, tribo_limit_rate(ctx, i, v));
    return product(rate, tribo_entry(d->v, i)) + product(c->follows ? 0.0 : by_limit, tribo_limit_change(ctx, d, i));
}

/* Returns the change of the force of contact i at place k, which is not balanced: by its law, or with its bound. */
static double own_change(const tribo_context *ctx, const struct change *d, const struct box_qp *p, size_t k)
{
    const size_t i = p->member[k];
    if (!ctx->last.near[i] || tribo_is_own(ctx)) {
        return law_change(ctx, d, i);
    }
    /* The bound of a law that relaxes moves with kappa, unless it is the other limit. */
    const struct contacts *c = &ctx->follow.contacts;
    const double v = ctx->last.v[i], kappa = tribo_slope_of(c, i) * v;
    const int side = p->at[k] == AT_UPPER ? 1 : -1, shifted = ctx->set.law->relaxes && side * kappa >= 0.0;
    const int moves = shifted && 0.5 * fabs(kappa) < c->limit[i], across = shifted && !moves;
    const double wider = tribo_limit_change(ctx, d, i) + product(tribo_limit_rate(ctx, i, v), tribo_entry(d->v, i));
    const double change = (across ? -side : side) * wider;
    return moves ? change - relaxation_change(ctx, d, i) : change;
}

/* df = R^-1 (-rhs) over the free contacts, the least in norm; df of the others is given. */
static void follow_free(struct box_qp *p, size_t vectors, const double *rhs, double *df)
{
    const size_t all = p->sets->rank + p->sets->dependents;
    double ignored;
    for (size_t k = 0; k < all; k++) {
        df[p->order[k]] = 0.0;
    }
    /* The second pass removes rounding errors; in a graded group it would find those of df only. */
    for (int pass = 0; pass < (p->group->graded ? 1 : 2); pass++) {
        for (size_t k = 0; k < all; k++) {
            const size_t i = p->order[k];
            p->step[i] = -(tribo_row_dot(p, i, df, &ignored) + rhs[i]);
        }
        tribo_factor_solve(p, vectors, p->step);
        for (size_t k = 0; k < all; k++) {
            df[p->order[k]] += p->step[p->order[k]];
        }
    }
}

/* A solved group, or a cluster. */
struct part {
    struct box_qp *p; /* NULL: it is the cluster */
    size_t vectors, cluster, size;
    const size_t *member; /* [size] */
};

/* Returns df [size], in workspace. */
static const double *part_product(tribo_context *ctx, const struct part *s, const struct change *d)
{
    struct box_qp *p = s->p;
    const int partition = ctx->set.coupling == TRIBO_PARTITION,
              relaxes = !partition && (ctx->set.law->relaxes || tribo_is_own(ctx));
    double *df = p ? p->gradient : ctx->plane.df, *balanced = p ? p->step : ctx->plane.v;
    for (size_t k = 0; p && k < s->size; k++) {
        const size_t i = s->member[k];
        const double r = ctx->op->diagonal[i], most = TRIBO_ROOM * tribo_most(p, k),
                     pull = TRIBO_ROOM * TRIBO_FAR * lesser(r, 1.0);
        df[k] = p->at[k] == FREE ? 0.0 : clamp(own_change(ctx, d, p, k), -most, most);
        p->noise[k] = clamp(tribo_entry(d->a, i), -pull, pull);
        p->noise[k] += relaxes ? r * clamp(relaxation_change(ctx, d, i), -most, most) : 0.0;
    }
    if (p) {
        p->far = 1; /* derivatives are of any size */
        follow_free(p, s->vectors, p->noise, df);
    } else {
        tribo_cluster_product(ctx, s->cluster, d, df);
    }
    if (!partition && !ctx->set.law->remembers) {
        return df;
    }
    /* So far df are forces that f_eq balances. In the partition they are the change of f_eq, which the law reads; laws with a
     * memory have another derivative where |f_eq| exceeds the limit. */
    memcpy(balanced, df, s->size * sizeof *df);
    for (size_t k = 0; k < s->size; k++) {
        const size_t i = s->member[k];
        const double r = ctx->op->diagonal[i];
        if (!ctx->last.near[i] || !tribo_is_scalar(ctx, i)) {
            continue;
        }
        const double others = !p           ? tribo_cluster_others(ctx, s->cluster, k, balanced)
                              : !partition ? tribo_row_others(p, k, balanced)
                                           : 0.0,
                     sum = cut(tribo_entry(d->a, i)) + others;
        const double change = partition ? df[k] : -quotient(cut(sum), r);
        df[k] = law_change(ctx, d, i) + product(ctx->last.tangent.dfeq[i], change);
    }
    return df;
}

/* out [n] = the changes of all forces by d. columns = 1: out [n][n] = the changes by each contact alone, where d has the unit
 * vectors that are made in last.feq, 0 so far. */
static void find_changes(tribo_context *ctx, const struct change *d, size_t columns, double *out)
{
    const size_t n = ctx->n, row = columns ? n : 1, solved = ctx->memory.nsolved;
    double *unit = ctx->last.feq;
    for (size_t k = 0; k < n * row; k++) {
        out[k] = 0.0;
    }
    for (size_t i = 0; i < n; i++) { /* as if the contact was in no solved group */
        const double r = ctx->op->diagonal[i];
        const int balanced = !ctx->op->groups || ctx->op->group_of[i] == TRIBO_ALONE;
        /* Where friction moves nothing, the force jumps as a changes its sign. */
        const int follows = balanced && ctx->follow.contacts.limit[i] > 0.0 && r > TRIBO_IMMOVABLE;
        unit[i] = 1.0;
        const double balance = follows ? quotient(product(ctx->last.tangent.dfeq[i], tribo_entry(d->a, i)), r) : 0.0;
        out[row * i + columns * i] = law_change(ctx, d, i) - balance;
        unit[i] = 0.0;
    }
    for (size_t q = 0; q < solved + ctx->plane.clusters; q++) {
        struct part s = {.p = q < solved ? tribo_collect(ctx, ctx->memory.solved_list[q]) : NULL, .cluster = q - solved};
        if (s.p) {
            s.vectors = tribo_null_basis(s.p);
            s.size = s.p->group->size;
        }
        s.member = s.p ? s.p->member : tribo_cluster_resume(ctx, s.cluster, &s.size);
        for (size_t k = 0; k < (columns ? s.size : 1); k++) {
            unit[s.member[k]] = 1.0;
            const double *df = part_product(ctx, &s, d);
            for (size_t j = 0; j < s.size; j++) {
                out[row * s.member[j] + columns * s.member[k]] = df[j];
            }
            unit[s.member[k]] = 0.0;
        }
    }
}

int tribo_balance_tangent(tribo_context *ctx, const double *v, const double *a, double *feq, double *f, double *df_dv,
                          double *df_da)
{
    const int status = tribo_balance(ctx, v, a, ctx ? ctx->last.feq : NULL, f);
    if (!status || status == TRIBO_ERR_INCONSISTENT) {
        tribo_copy(feq, ctx->last.feq, feq ? ctx->n : 0);
    }
    if (status) {
        return status;
    }
    const size_t n = ctx->n;
    const struct tangents *t = &ctx->last.tangent;
    const int own = tribo_is_own(ctx);
    if (own && ctx->set.coupling == TRIBO_CONSISTENT) {
        tribo_own_sides(ctx);
    }
    /* The derivatives of all laws at v and a. */
    for (size_t i = 0; i < n; i += TRIBO_CHUNK) {
        double ignored[TRIBO_CHUNK];
        const size_t count = tribo_chunk_size(ctx, i);
        const struct contacts c = tribo_chunk_contacts(ctx, i);
        tribo_law_tangents(ctx, &c, i, count, v + i, ctx->last.feq + i,
                           &(struct tangents){ignored, t->dv + i, t->dfeq + i, t->dlimit + i});
    }
    if (own && tribo_own_failed(ctx, t->dv)) {
        return tribo_own_fail(ctx, 1, v);
    }
    tribo_copy(ctx->last.v, v, n);
    ctx->last.linearized = 1;
    memset(ctx->last.feq, 0, n * sizeof *v);
    if (df_dv) {
        find_changes(ctx, &(struct change){ctx->last.feq, NULL, NULL}, 1, df_dv);
    }
    if (df_da) {
        find_changes(ctx, &(struct change){NULL, ctx->last.feq, NULL}, 1, df_da);
    }
    return TRIBO_OK;
}

/* df [n] of all contacts; a status. */
static int tangent_product_of(tribo_context *ctx, const struct change *d, double *df)
{
    const int status = tribo_check_output(ctx, "df", df);
    if (status) {
        return status;
    }
    if (!ctx->last.linearized) {
        return tribo_fail(ctx, TRIBO_ERR_STATE, "no tribo_balance_tangent since the last balance or change");
    }
    find_changes(ctx, d, 0, df);
    return TRIBO_OK;
}

int tribo_tangent_product(tribo_context *ctx, const double *dv, const double *da, double *df)
{
    int status = ctx ? TRIBO_OK : TRIBO_ERR_NULL;
    status = status || !dv ? status : tribo_check_finite(ctx, "dv", dv, ctx->n);
    status = status || !da ? status : tribo_check_finite(ctx, "da", da, ctx->n);
    return status ? status : tangent_product_of(ctx, &(struct change){dv, da, NULL}, df);
}

int tribo_limit_product(tribo_context *ctx, const double *dlimit, double *df)
{
    int status = ctx ? tribo_check_finite(ctx, "dlimit", dlimit, ctx->n) : TRIBO_ERR_NULL;
    for (size_t i = 0; !status && i < ctx->n; i++) {
        if (ctx->set.ratio[i] > 1.0) {
            return tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED, "tribo_limit_product knows no static limits, and ratio[%zu] = %g", i,
                              ctx->set.ratio[i]);
        }
    }
    const double *by_limit = ctx ? ctx->last.tangent.dlimit : NULL;
    for (size_t i = 0; !status && tribo_is_own(ctx) && ctx->last.linearized && i < ctx->n; i++) {
        if (!isfinite(by_limit[i])) {
            return tribo_fail(ctx, TRIBO_ERR_CALLBACK, "law gave no derivative by the limit of contact %zu", i);
        }
    }
    return status ? status : tangent_product_of(ctx, &(struct change){NULL, NULL, dlimit}, df);
}
