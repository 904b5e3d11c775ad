/* Forces of contacts whose f_eq is known. */
#include <float.h>
#include <math.h>

#include "internal.h"

/* f_eq is read only near v = 0, and need not be finite elsewhere. */
static int check(const tribo_context *ctx, const double *v, const double *feq)
{
    const int status = tribo_check_finite(ctx, "v", v, ctx->n);
    if (status || !ctx->law->uses_feq) {
        return status;
    }
    if (!feq && ctx->n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "feq is NULL");
    }
    int bad = 0;
    for (size_t i = 0; i < ctx->n; i++) {
        bad |= !(fabs(feq[i]) <= DBL_MAX) & (fabs(v[i]) <= tribo_band(ctx, i));
    }
    for (size_t i = 0; bad && i < ctx->n; i++) {
        if (!isfinite(feq[i]) && fabs(v[i]) <= tribo_band(ctx, i)) {
            return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "feq[%zu] = %g is not finite", i, feq[i]);
        }
    }
    return TRIBO_OK;
}

int tribo_force(const tribo_context *ctx, const double *v, const double *feq, double *f)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const int status = check(ctx, v, feq);
    if (status) {
        return status;
    }
    if (!f && ctx->n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "f is NULL");
    }
    const struct contacts c = tribo_contacts(ctx);
    ctx->law->force(&c, ctx->n, v, ctx->law->uses_feq ? feq : v, f);
    return TRIBO_OK;
}

int tribo_force_tangent(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv, double *df_dfeq,
                        double *df_dlimit)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const int status = check(ctx, v, feq);
    if (status) {
        return status;
    }
    const struct contacts all = tribo_contacts(ctx);
    feq = ctx->law->uses_feq ? feq : v;
    for (size_t i = 0; i < ctx->n; i++) {
        const struct contacts c = tribo_contacts_from(&all, i);
        struct tangent d;
        ctx->law->tangent(&c, 1, v + i, feq + i, &d);
        if (f) {
            ctx->law->force(&c, 1, v + i, feq + i, f + i);
        }
        if (df_dv) {
            df_dv[i] = d.dv;
        }
        if (df_dfeq) {
            df_dfeq[i] = d.dfeq;
        }
        if (df_dlimit) {
            df_dlimit[i] = d.dlimit;
        }
    }
    return TRIBO_OK;
}

int tribo_accept(tribo_context *ctx, const double *v, const double *feq)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!ctx->law->remembers) {
        return tribo_check_finite(ctx, "v", v, ctx->n);
    }
    const int status = check(ctx, v, feq);
    if (status) {
        return status;
    }
    ctx->linearized = 0;
    for (size_t i = 0; i < ctx->n; i++) {
        const unsigned char before = ctx->moving[i];
        if (fabs(v[i]) > ctx->epsilon[i]) {
            ctx->moving[i] = 1;
        } else if (fabs(feq[i]) <= ctx->limit[i]) {
            ctx->moving[i] = 0;
        }
        ctx->marks += ctx->moving[i] != before;
    }
    return TRIBO_OK;
}
