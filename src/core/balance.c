/* Forces of contacts that share bodies: f_eq and f from z'' = R f + a.
 *
 * The consistent coupling is a box-constrained quadratic program. With kappa = slope v inside the band of a law that relaxes, and
 * 0 for the others, the fixed point f_i = clamp(clamp(f_eq,i, -N, N) - kappa_i, -N, N) minimizes 1/2 f'Rf + (a + diag(R) kappa)'f
 * over the contacts near stick, where  kappa > 0: -N <= f <= max(-N, N - kappa);  kappa < 0: min(N, -N - kappa) <= f <= N. */
#include <float.h>

#include "internal.h"
#include "../real.h"

/* f_eq of a contact that shares no body. */
static double single_feq(const tribo_context *ctx, size_t i, double a)
{
    return ctx->limit[i] > 0.0 ? clamp(-a / ctx->op.diagonal[i], -DBL_MAX, DBL_MAX) : 0.0;
}

/* One island and its contacts near stick: near[0..count), by their place in it. */
struct island {
    const size_t *member;
    const double *block;
    size_t size, count;
};

static struct island island_of(const tribo_context *ctx, size_t k)
{
    const size_t first = ctx->op.first[k];
    return (struct island){ctx->op.member + first, ctx->op.block + ctx->op.offset[k], ctx->op.first[k + 1] - first, 0};
}

static int near_stick(const tribo_context *ctx, const double *v, size_t i)
{
    return ctx->law->uses_feq && fabs(v[i]) <= tribo_band(ctx, i) && ctx->limit[i] > 0.0;
}

/* Collects the contacts near stick in front of ctx->near, the others behind them. */
static void split(const tribo_context *ctx, const double *v, struct island *is)
{
    size_t behind = is->size;
    for (size_t p = is->size; p-- > 0;) {
        if (!near_stick(ctx, v, is->member[p])) {
            ctx->near[--behind] = p;
        }
    }
    for (size_t p = 0; p < is->size; p++) {
        if (near_stick(ctx, v, is->member[p])) {
            ctx->near[is->count++] = p;
        }
    }
}

/* The solver's matrix, and q = scale a + what the contacts that are not near stick do. */
static void gather(tribo_context *ctx, const struct island *is, const double *a, double scale)
{
    struct solver *s = &ctx->solver;
    for (size_t p = 0; p < is->count; p++) {
        const double *row = is->block + ctx->near[p] * is->size;
        double sum = scale * a[is->member[ctx->near[p]]];
        for (size_t q = is->count; q < is->size; q++) {
            sum += row[ctx->near[q]] * ctx->f[is->member[ctx->near[q]]];
        }
        s->q[p] = sum;
        for (size_t q = 0; q < is->count; q++) {
            s->g[p * is->count + q] = row[ctx->near[q]];
        }
    }
}

/* Solves the box over the contacts near stick, from the last forces; lo, hi and q are set. */
static int solve_box(tribo_context *ctx, const struct island *is)
{
    struct solver *s = &ctx->solver;
    for (size_t p = 0; p < is->count; p++) {
        s->x[p] = ctx->f[is->member[ctx->near[p]]];
    }
    ctx->solves++;
    if (!tribo_solver_box(s, is->count)) {
        return tribo_fail(ctx, TRIBO_ERR_NO_CONVERGENCE, "no stick set found for the %zu contacts near stick around contact %zu",
                          is->count, is->member[ctx->near[0]]);
    }
    for (size_t p = 0; p < is->count; p++) {
        const size_t i = is->member[ctx->near[p]];
        const double fixed_point = clamp(s->x[p] - s->gradient[p] / ctx->op.diagonal[i], s->lo[p], s->hi[p]);
        ctx->residual = greater(ctx->residual, fabs(s->x[p] - fixed_point) / greater(ctx->limit[i], 0.5 * (s->hi[p] - s->lo[p])));
    }
    ctx->rank += s->rank;
    return TRIBO_OK;
}

/* f_eq = f + kappa - (R f + a + diag(R) kappa)/R_ii, with f as the solver finds it. */
static int solve_consistent(tribo_context *ctx, const struct island *is, const double *v, const double *a)
{
    struct solver *s = &ctx->solver;
    gather(ctx, is, a, 1.0);
    for (size_t p = 0; p < is->count; p++) {
        const size_t i = is->member[ctx->near[p]];
        const double limit = ctx->limit[i], kappa = ctx->law->relaxes ? ctx->slope[i] * v[i] : 0.0;
        s->lo[p] = kappa < 0.0 ? lesser(limit, -limit - kappa) : -limit;
        s->hi[p] = kappa > 0.0 ? greater(-limit, limit - kappa) : limit;
        s->q[p] += ctx->op.diagonal[i] * kappa;
    }
    const int status = solve_box(ctx, is);
    for (size_t p = 0; !status && p < is->count; p++) {
        const size_t i = is->member[ctx->near[p]];
        const double kappa = ctx->law->relaxes ? ctx->slope[i] * v[i] : 0.0;
        ctx->feq[i] = clamp(s->x[p] + kappa - s->gradient[p] / ctx->op.diagonal[i], -DBL_MAX, DBL_MAX);
    }
    return status;
}

static int solve_partition(tribo_context *ctx, const struct island *is, const double *a)
{
    struct solver *s = &ctx->solver;
    gather(ctx, is, a, 1.0);
    ctx->solves++;
    tribo_solver_prepare(s, is->count);
    const int consistent = tribo_solver_linear(s, is->count);
    for (size_t p = 0; p < is->count; p++) {
        const size_t i = is->member[ctx->near[p]];
        const double off = s->gradient[p] / ctx->op.diagonal[i];
        ctx->residual = greater(ctx->residual, fabs(off) / ctx->limit[i]);
        ctx->feq[i] = clamp(s->x[p], -DBL_MAX, DBL_MAX);
    }
    ctx->rank += s->rank;
    if (consistent) {
        return TRIBO_OK;
    }
    return tribo_fail(ctx, TRIBO_ERR_INCONSISTENT,
                      "no f_eq balances the %zu contacts near stick around contact %zu: rank %zu, and a is outside its range",
                      is->count, is->member[ctx->near[0]], s->rank);
}

static void law_force(const tribo_context *ctx, size_t i, const double *v, double *f)
{
    const struct contacts all = tribo_contacts(ctx), c = tribo_contacts_from(&all, i);
    ctx->law->force(&c, 1, v + i, ctx->feq + i, f + i);
}

/* f_eq of the contacts that no solver saw. */
static void fill_feq(tribo_context *ctx, const struct island *is, const double *a)
{
    for (size_t q = is->count; q < is->size; q++) {
        const size_t p = ctx->near[q], i = is->member[p];
        double sum = a[i];
        for (size_t j = 0; j < is->size; j++) {
            sum += j == p ? 0.0 : is->block[p * is->size + j] * ctx->f[is->member[j]];
        }
        ctx->feq[i] = ctx->limit[i] > 0.0 ? clamp(-sum / ctx->op.diagonal[i], -DBL_MAX, DBL_MAX) : 0.0;
    }
}

static int balance_islands(tribo_context *ctx, const double *v, const double *a, int want_feq)
{
    int status = TRIBO_OK;
    for (size_t k = 0; k < ctx->op.islands; k++) {
        struct island is = island_of(ctx, k);
        if (is.size == 1) {
            ctx->feq[*is.member] = single_feq(ctx, *is.member, a[*is.member]);
            law_force(ctx, *is.member, v, ctx->f);
            ctx->skipped++;
            continue;
        }
        split(ctx, v, &is);
        for (size_t q = is.count; q < is.size; q++) {
            law_force(ctx, is.member[ctx->near[q]], v, ctx->f);
        }
        if (is.count) {
            const int one = ctx->coupling == TRIBO_PARTITION ? solve_partition(ctx, &is, a) : solve_consistent(ctx, &is, v, a);
            if (one == TRIBO_ERR_NO_CONVERGENCE) {
                return one;
            }
            status = one ? one : status;
            for (size_t p = 0; p < is.count; p++) {
                law_force(ctx, is.member[ctx->near[p]], v, ctx->f);
            }
        } else {
            ctx->skipped++;
        }
        if (want_feq) {
            fill_feq(ctx, &is, a);
        }
    }
    return status;
}

/* f_eq of contacts that share no body: single_feq for all of them. */
TRIBO_SIMD static void diagonal_feq(size_t n, const double *restrict r, const double *restrict limit, const double *restrict a,
                                    double *restrict feq)
{
    for (size_t i = 0; i < n; i++) {
        const double x = clamp(-a[i] / r[i], -DBL_MAX, DBL_MAX);
        feq[i] = limit[i] > 0.0 ? x : 0.0;
    }
}

int tribo_balance(tribo_context *ctx, const double *v, const double *a, double *feq, double *f)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    int status = tribo_check_finite(ctx, "v", v, ctx->n);
    if (!status) {
        status = tribo_check_finite(ctx, "a", a, ctx->n);
    }
    if (status) {
        return status;
    }
    ctx->rank = 0;
    ctx->residual = 0.0;
    ctx->balanced = 0;
    if (ctx->op.islands == 0) {
        const struct contacts c = tribo_contacts(ctx);
        diagonal_feq(ctx->n, ctx->op.diagonal, ctx->limit, a, ctx->feq);
        ctx->law->force(&c, ctx->n, v, ctx->feq, ctx->f);
    } else {
        status = balance_islands(ctx, v, a, feq != NULL);
        if (status == TRIBO_ERR_NO_CONVERGENCE) {
            return status;
        }
    }
    ctx->balanced = 1;
    ctx->holds = ctx->law->id == TRIBO_SMOOTH ? tanh(1.0) : 1.0;
    if (feq) {
        tribo_copy(feq, ctx->feq, ctx->n);
    }
    if (f) {
        tribo_copy(f, ctx->f, ctx->n);
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------- step force and box */

/* The box over all contacts, bounds as given; scale multiplies a. Contacts whose bounds leave no choice take no part in the
 * solver. */
static int box_islands(tribo_context *ctx, const double *a, double scale, const double *lower, const double *upper)
{
    struct solver *s = &ctx->solver;
    for (size_t k = 0; k < ctx->op.islands; k++) {
        struct island is = island_of(ctx, k);
        size_t behind = is.size;
        if (is.size == 1) {
            const size_t i = *is.member;
            ctx->f[i] = clamp(-(scale * a[i]) / ctx->op.diagonal[i], lower[i], upper[i]);
            ctx->skipped++;
            continue;
        }
        for (size_t p = is.size; p-- > 0;) {
            const size_t i = is.member[p];
            if (lower[i] == upper[i]) {
                ctx->near[--behind] = p;
                ctx->f[i] = lower[i];
            }
        }
        for (size_t p = 0; p < is.size; p++) {
            if (lower[is.member[p]] < upper[is.member[p]]) {
                ctx->near[is.count++] = p;
            }
        }
        if (is.count == 0) {
            ctx->skipped++;
            continue;
        }
        gather(ctx, &is, a, scale);
        for (size_t p = 0; p < is.count; p++) {
            s->lo[p] = lower[is.member[ctx->near[p]]];
            s->hi[p] = upper[is.member[ctx->near[p]]];
        }
        const int status = solve_box(ctx, &is);
        if (status) {
            return status;
        }
        for (size_t p = 0; p < is.count; p++) {
            ctx->f[is.member[ctx->near[p]]] = clamp(s->x[p], s->lo[p], s->hi[p]);
        }
    }
    return TRIBO_OK;
}

/* The box for any operator, after the checks. */
static int box(tribo_context *ctx, const double *a, double scale, const double *lower, const double *upper, double *f)
{
    ctx->rank = 0;
    ctx->residual = 0.0;
    ctx->balanced = 0;
    for (size_t i = 0; ctx->op.islands == 0 && i < ctx->n; i++) {
        ctx->f[i] = clamp(-(scale * a[i]) / ctx->op.diagonal[i], lower[i], upper[i]);
    }
    const int status = ctx->op.islands ? box_islands(ctx, a, scale, lower, upper) : TRIBO_OK;
    if (!status) {
        tribo_copy(f, ctx->f, ctx->n);
    }
    return status;
}

int tribo_step_force(tribo_context *ctx, double dt, const double *vfree, double *f)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!isfinite(dt)) {
        return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "dt = %g is not finite", dt);
    }
    if (dt <= 0.0) {
        return tribo_fail(ctx, TRIBO_ERR_NOT_POSITIVE, "dt = %g is not positive", dt);
    }
    int status = tribo_check_finite(ctx, "vfree", vfree, ctx->n);
    if (status) {
        return status;
    }
    if (!f && ctx->n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "f is NULL");
    }
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->column[i] = -ctx->limit[i];
    }
    status = box(ctx, vfree, 1.0 / dt, ctx->column, ctx->limit, f);
    if (!status) {
        ctx->balanced = 1;
        ctx->holds = 1.0;
    }
    return status;
}

int tribo_solve_box(tribo_context *ctx, const double *a, const double *lower, const double *upper, double *f)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    int status = tribo_check_finite(ctx, "a", a, ctx->n);
    status = status ? status : tribo_check_finite(ctx, "lower", lower, ctx->n);
    status = status ? status : tribo_check_finite(ctx, "upper", upper, ctx->n);
    if (status) {
        return status;
    }
    for (size_t i = 0; i < ctx->n; i++) {
        if (lower[i] > upper[i]) {
            return tribo_fail(ctx, TRIBO_ERR_RANGE, "lower[%zu] = %g is above upper[%zu] = %g", i, lower[i], i, upper[i]);
        }
    }
    if (!f && ctx->n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "f is NULL");
    }
    return box(ctx, a, 1.0, lower, upper, f);
}

/* ----------------------------------------------------------------------------------------------------------- tangents */

static struct tangent law_tangent(const tribo_context *ctx, const struct law *law, size_t i, const double *v)
{
    const struct contacts all = tribo_contacts(ctx), c = tribo_contacts_from(&all, i);
    struct tangent d;
    law->tangent(&c, 1, v + i, ctx->feq + i, &d);
    return d;
}

/* Splits an island once more, into the contacts whose force follows the others, which the solver gets factorized, and the rest.
 * In the partition that is every contact near stick, in the consistent coupling only those inside their box. */
static void factorize_followers(tribo_context *ctx, struct island *is, const double *v)
{
    struct solver *s = &ctx->solver;
    const struct law *base = ctx->law->remembers ? &tribo_law_quinn : ctx->law;
    is->count = 0;
    split(ctx, v, is);
    for (size_t p = 0; ctx->coupling == TRIBO_CONSISTENT && p < is->count;) {
        if (law_tangent(ctx, base, is->member[ctx->near[p]], v).dfeq != 0.0) {
            p++;
        } else {
            const size_t saturated = ctx->near[p];
            ctx->near[p] = ctx->near[--is->count];
            ctx->near[is->count] = saturated;
        }
    }
    for (size_t p = 0; p < is->count; p++) {
        for (size_t q = 0; q < is->count; q++) {
            s->g[p * is->count + q] = is->block[ctx->near[p] * is->size + ctx->near[q]];
        }
    }
    if (is->count) {
        tribo_solver_prepare(s, is->count);
    }
}

/* The derivative of f (by place in the island) when v (by_v) or a of the contact at place c changes. */
static void column(tribo_context *ctx, const struct island *is, const double *v, size_t c, int by_v, double *df)
{
    struct solver *s = &ctx->solver;
    const struct law *base = ctx->law->remembers ? &tribo_law_quinn : ctx->law;
    const size_t n = is->size;
    const int partition = ctx->coupling == TRIBO_PARTITION;
    memset(df, 0, n * sizeof *df);
    if (by_v) {
        df[c] = law_tangent(ctx, partition ? ctx->law : base, is->member[c], v).dv;
    }
    /* consistent: R_FF df_F = R_cc (df_c/dv_c) e_c - da_F - R_FB df_B;  partition: R_SS df_eq = -da_S - R_SL df_L */
    for (size_t p = 0; p < is->count; p++) {
        const double *row = is->block + ctx->near[p] * n;
        s->q[p] = !by_v && ctx->near[p] == c ? 1.0 : 0.0;
        s->q[p] -= by_v && ctx->near[p] == c && !partition ? row[c] * df[c] : 0.0;
        for (size_t q = is->count; q < n; q++) {
            s->q[p] += row[ctx->near[q]] * df[ctx->near[q]];
        }
    }
    if (is->count) {
        tribo_solver_linear(s, is->count);
    }
    for (size_t p = 0; p < is->count; p++) {
        const size_t place = ctx->near[p];
        df[place] = partition ? df[place] + law_tangent(ctx, ctx->law, is->member[place], v).dfeq * s->x[p] : s->x[p];
    }
    if (base != ctx->law && !partition) {
        /* the forces so far are those that f_eq balances; the law itself has another derivative where f_eq is beyond the limit */
        for (size_t p = 0; p < n; p++) {
            const struct tangent d = law_tangent(ctx, ctx->law, is->member[p], v);
            double sum = !by_v && p == c ? 1.0 : 0.0;
            for (size_t j = 0; j < n; j++) {
                sum += j == p ? 0.0 : is->block[p * n + j] * df[j];
            }
            const double dfeq = near_stick(ctx, v, is->member[p]) ? -sum / is->block[p * n + p] : 0.0;
            s->rhs[p] = (by_v && p == c ? d.dv : 0.0) + d.dfeq * dfeq;
        }
        memcpy(df, s->rhs, n * sizeof *df);
    }
}

static void tangent_islands(tribo_context *ctx, const double *v, double *df_dv, double *df_da)
{
    const size_t n = ctx->n;
    for (size_t k = 0; k < ctx->op.islands; k++) {
        struct island is = island_of(ctx, k);
        factorize_followers(ctx, &is, v);
        for (int by_v = 0; by_v < 2; by_v++) {
            double *out = by_v ? df_dv : df_da;
            for (size_t c = 0; out && c < is.size; c++) {
                column(ctx, &is, v, c, by_v, ctx->column);
                for (size_t p = 0; p < is.size; p++) {
                    out[is.member[p] * n + is.member[c]] = ctx->column[p];
                }
            }
        }
    }
}

int tribo_balance_tangent(tribo_context *ctx, const double *v, const double *a, double *feq, double *f, double *df_dv,
                          double *df_da)
{
    const int status = tribo_balance(ctx, v, a, feq, f);
    if (status) {
        return status;
    }
    const size_t n = ctx->n;
    for (int by_v = 0; by_v < 2; by_v++) {
        double *out = by_v ? df_dv : df_da;
        for (size_t k = 0; out && k < n * n; k++) {
            out[k] = 0.0;
        }
    }
    if (ctx->op.islands) {
        tangent_islands(ctx, v, df_dv, df_da);
        return TRIBO_OK;
    }
    for (size_t i = 0; i < n; i++) {
        const struct tangent d = law_tangent(ctx, ctx->law, i, v);
        if (df_dv) {
            df_dv[i * n + i] = d.dv;
        }
        if (df_da) {
            df_da[i * n + i] = ctx->limit[i] > 0.0 ? -d.dfeq / ctx->op.diagonal[i] : 0.0;
        }
    }
    return TRIBO_OK;
}
