/* The force over a time step, and the box-constrained problem for laws of the caller's own. */
#include <float.h>

#include "context.h"

/* Forces of contacts that share no body. */
TRIBO_SIMD static void box_alone(size_t n, double dt, const double *restrict v, const double *restrict r, const double *lower,
                                 const double *upper, double *restrict f)
{
    for (size_t i = 0; lower && i < n; i++) {
        f[i] = clamp(quotient(-v[i], greater(r[i] * dt, DBL_MIN)), lower[i], upper[i]);
    }
    for (size_t i = 0; !lower && i < n; i++) {
        f[i] = clamp(quotient(-v[i], greater(r[i] * dt, DBL_MIN)), -upper[i], upper[i]);
    }
}

/* The box over all contacts, with v = dt a; lower NULL: -upper. Contacts whose bounds leave no choice take no part in the solver,
 * nor do those that are pulled harder than reach, what the others could do, if it is given. */
static int box_all(tribo_context *ctx, double dt, const double *v, const double *lower, const double *upper, const double *reach,
                   double *f)
{
    const double scale = ctx->op.groups ? quotient(1.0, dt) : 0.0;
    ctx->kept = 1;
    box_alone(ctx->n, dt, v, ctx->op.diagonal, lower, upper, ctx->f);
    for (size_t i = 0; ctx->op.groups > 0 && i < ctx->n; i++) {
        const int chooses = (lower ? lower[i] : -upper[i]) < upper[i];
        ctx->last.state[i] = chooses && !(reach && fabs(scale * v[i]) > reach[i]) ? NEAR : BACK;
    }
    if (ctx->op.groups) {
        tribo_find_near_groups(ctx, 0, ctx->n);
    }
    for (size_t g = 0; g < ctx->op.nsolved; g++) {
        struct box_qp *p = tribo_collect(ctx, ctx->op.solved_list[g]);
        const size_t *member = p->member;
        for (size_t e = 0; e < p->count; e++) {
            const size_t k = p->near[e], i = member[k];
            const double lo = lower ? lower[i] : -upper[i];
            p->lo[k] = ctx->far ? tribo_cut(p, k, lo) : lo;
            p->hi[k] = ctx->far ? tribo_cut(p, k, upper[i]) : upper[i];
            p->q[k] = cut(scale * v[i]);
        }
        const int status = tribo_solve_group(ctx, p);
        if (status) {
            return status;
        }
        for (size_t e = 0; e < p->count; e++) {
            const size_t k = p->near[e], i = member[k];
            ctx->f[i] = clamp(p->x[k], lower ? lower[i] : -upper[i], upper[i]);
        }
    }
    ctx->skipped += ctx->op.islands - ctx->op.nsolved;
    tribo_remember_forces(ctx);
    tribo_copy(f, ctx->f, ctx->n);
    return TRIBO_OK;
}

/* The most that friction can do to the contacts, while the limits stay as they are. */
static const double *reaches(tribo_context *ctx)
{
    struct operator* op = & ctx->op;
    for (size_t g = 0; !op->reaches && g < op->groups; g++) {
        struct box_qp *p = tribo_operator_problem(op, g);
        const size_t *member = p->member, size = p->group->size;
        for (size_t k = 0; k < size; k++) {
            p->step[k] = ctx->bound[member[k]];
        }
        for (size_t k = 0; k < size; k++) {
            tribo_row_dot(p, k, p->step, &op->reach[member[k]]);
        }
    }
    op->reaches = 1;
    return op->reach;
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
    int status = tribo_need_operator(ctx);
    status = status ? status : tribo_check_finite(ctx, "vfree", vfree, ctx->n);
    if (status) {
        return status;
    }
    if (!f && ctx->n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "f is NULL");
    }
    tribo_begin_call(ctx);
    status = box_all(ctx, dt, vfree, NULL, ctx->limit, ctx->op.groups ? reaches(ctx) : NULL, f);
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
    int status = tribo_need_operator(ctx);
    status = status ? status : tribo_check_finite(ctx, "a", a, ctx->n);
    status = status ? status : tribo_check_finite(ctx, "lower", lower, ctx->n);
    status = status ? status : tribo_check_finite(ctx, "upper", upper, ctx->n);
    if (status) {
        return status;
    }
    double most = 0.0;
    for (size_t i = 0; i < ctx->n; i++) {
        if (lower[i] > upper[i]) {
            return tribo_fail(ctx, TRIBO_ERR_RANGE, "lower[%zu] = %g is above upper[%zu] = %g", i, lower[i], i, upper[i]);
        }
        most = greater(most, greater(upper[i], -lower[i]));
    }
    if (!f && ctx->n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "f is NULL");
    }
    tribo_begin_call(ctx);
    ctx->far = most > TRIBO_ROOM * ctx->op.most;
    return box_all(ctx, 1.0, a, lower, upper, NULL, f);
}
