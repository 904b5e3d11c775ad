/* Forces of contacts whose f_eq is known. */
#include <math.h>

#include "context.h"

/* f_eq as laws read it: where it does not matter it need not be finite, nor even be set. */
TRIBO_SIMD static void select_feq(size_t n, const double *restrict v, const double *restrict band, const double *restrict feq,
                                  double *restrict used)
{
    for (size_t i = 0; band && i < n; i++) {
        used[i] = fabs(v[i]) <= band[i] ? feq[i] : 0.0;
    }
    for (size_t i = 0; !band && i < n; i++) {
        used[i] = v[i] == 0.0 ? feq[i] : 0.0;
    }
}

/* Of planar contacts something else tells whether it matters. */
static void skip_planar(const tribo_context *ctx, size_t i, size_t n, double *used)
{
    for (size_t k = 0; k < n; k++) {
        used[k] = ctx->planar->role[i + k] == ROLE_SCALAR ? used[k] : 0.0;
    }
}

/* The same for the n contacts from i on. */
static void used_feq(const tribo_context *ctx, size_t i, size_t n, const double *v, const double *feq, double *used)
{
    if (ctx->set.law->uses_feq) {
        double room[TRIBO_CHUNK];
        const double *band = ctx->set.law->sticks_in_band ? tribo_epsilons(&ctx->follow.contacts, i, n, room) : NULL;
        select_feq(n, v + i, band, feq + i, used);
        if (ctx->planar) {
            skip_planar(ctx, i, n, used);
        }
    } else {
        memset(used, 0, n * sizeof *used);
    }
}

TRIBO_SIMD static void cut_all(size_t n, double *x)
{
    for (size_t i = 0; i < n; i++) {
        x[i] = cut(x[i]);
    }
}

static int check_force(const tribo_context *ctx, const double *v, const double *feq)
{
    int status = tribo_need_epsilon(ctx);
    status = status ? status : tribo_check_finite(ctx, "v", v, ctx->n);
    if (status) {
        return status;
    }
    if (!feq && ctx->n && ctx->set.law->uses_feq) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "feq is NULL");
    }
    for (size_t i = 0; i < ctx->n; i += TRIBO_CHUNK) {
        double used[TRIBO_CHUNK];
        const size_t n = tribo_chunk_size(ctx, i);
        used_feq(ctx, i, n, v, feq, used);
        for (size_t k = 0; !tribo_all_finite(used, n); k++) {
            if (!isfinite(used[k])) {
                return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "feq[%zu] = %g is not finite", i + k, used[k]);
            }
        }
    }
    return ctx->planar && ctx->set.law->uses_feq ? tribo_planar_check_feq(ctx, v, feq) : TRIBO_OK;
}

static void hand_out(size_t n, const struct tangent *d, double *df_dv, double *df_dfeq, double *df_dlimit)
{
    for (size_t k = 0; df_dv && k < n; k++) {
        df_dv[k] = d[k].dv;
    }
    for (size_t k = 0; df_dfeq && k < n; k++) {
        df_dfeq[k] = d[k].dfeq;
    }
    for (size_t k = 0; df_dlimit && k < n; k++) {
        df_dlimit[k] = d[k].dlimit;
    }
}

/* Each output may be NULL. */
static void evaluate(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv, double *df_dfeq,
                     double *df_dlimit)
{
    for (size_t i = 0; i < ctx->n; i += TRIBO_CHUNK) {
        double used[TRIBO_CHUNK];
        struct tangent d[TRIBO_CHUNK];
        const size_t n = tribo_chunk_size(ctx, i);
        double limit[TRIBO_CHUNK];
        struct contacts c = tribo_contacts_from(&ctx->follow.contacts, i);
        used_feq(ctx, i, n, v, feq, used);
        cut_all(n, used);
        if (ctx->set.breaking) {
            tribo_find_limits(ctx, i, n, v + i, used, limit);
            c.limit = c.bound = limit;
        }
        if (f) {
            ctx->set.law->force(&c, n, v + i, used, f + i);
        }
        if (df_dv || df_dfeq || df_dlimit) {
            tribo_law_tangents(ctx, &c, i, n, v + i, used, d);
            hand_out(n, d, df_dv ? df_dv + i : NULL, df_dfeq ? df_dfeq + i : NULL, df_dlimit ? df_dlimit + i : NULL);
        }
    }
}

int tribo_force(const tribo_context *ctx, const double *v, const double *feq, double *f)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const int status = check_force(ctx, v, feq);
    if (status) {
        return status;
    }
    if (!f && ctx->n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "f is NULL");
    }
    evaluate(ctx, v, feq, f, NULL, NULL, NULL);
    return ctx->planar ? tribo_planar_force(ctx, v, feq, f) : TRIBO_OK;
}

int tribo_force_tangent(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv, double *df_dfeq,
                        double *df_dlimit)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const int status = check_force(ctx, v, feq);
    if (status) {
        return status;
    }
    if (ctx->planar && (df_dv || df_dfeq || df_dlimit)) {
        return tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED,
                          "derivatives of planar contact %zu are no diagonals: see tribo_balance_tangent", ctx->planar->first[0]);
    }
    evaluate(ctx, v, feq, f, df_dv, df_dfeq, df_dlimit);
    return ctx->planar && f ? tribo_planar_force(ctx, v, feq, f) : TRIBO_OK;
}

static double limit_near(const tribo_context *ctx, size_t i, double v, double feq)
{
    double limit = ctx->set.limit[i];
    if (ctx->set.breaking) {
        tribo_find_limits(ctx, i, 1, &v, &feq, &limit);
    }
    return limit;
}

int tribo_accept(tribo_context *ctx, const double *v, const double *feq)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!ctx->set.law->remembers) {
        return tribo_check_finite(ctx, "v", v, ctx->n);
    }
    const int status = check_force(ctx, v, feq);
    if (status) {
        return status;
    }
    ctx->last.linearized = 0;
    for (size_t i = 0; i < ctx->n; i++) {
        const unsigned char before = ctx->moving[i];
        if (ctx->planar && ctx->planar->role[i] != ROLE_SCALAR) {
            continue;
        }
        if (fabs(v[i]) > tribo_epsilon_of(&ctx->follow.contacts, i)) {
            ctx->moving[i] = 1;
        } else if (fabs(feq[i]) <= limit_near(ctx, i, v[i], feq[i])) {
            ctx->moving[i] = 0;
        }
        ctx->count.marks += ctx->moving[i] != before;
    }
    return TRIBO_OK;
}
