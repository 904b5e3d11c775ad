/* Forces of contacts that share bodies: f_eq and f from z'' = R f + a.
 *
 * The consistent coupling is a box-constrained quadratic program. With kappa = slope v inside the band of a law that relaxes, and
 * 0 for the others, the fixed point f_i = clamp(clamp(f_eq,i, -N, N) - kappa_i, -N, N) minimizes 1/2 f'Rf + (a + diag(R) kappa)'f
 * over the contacts near stick, where  kappa > 0: -N <= f <= max(-N, N - kappa);  kappa < 0: min(N, -N - kappa) <= f <= N.
 *
 * A call first looks at all contacts as if they were alone, which is all there is to know of those that are, of open ones and of
 * sliding ones; then it solves for the groups in which it found one near stick. */
#include <float.h>

#include "internal.h"
#include "../real.h"

/* So many contacts are looked at together: few enough that in a large scene most of such chunks have none near stick, and all
 * that is read of them stays in the first-level cache. */
#define CHUNK 128

/* Marks the contacts near stick, |v| <= band (0 for all if band is NULL). */
TRIBO_SIMD static void find_near(size_t n, const double *restrict v, const double *restrict band, const double *restrict limit,
                                 unsigned char *restrict near)
{
    if (band) {
        for (size_t i = 0; i < n; i++) {
            near[i] = (fabs(v[i]) <= band[i]) & (limit[i] > 0.0);
        }
    } else {
        for (size_t i = 0; i < n; i++) {
            near[i] = (v[i] == 0.0) & (limit[i] > 0.0);
        }
    }
}

/* Whether any contact is in its band (at v = 0 if band is NULL). Beyond, laws that ask for f_eq all say the same. */
TRIBO_SIMD static int any_in_band(size_t n, const double *restrict v, const double *restrict band)
{
    int64_t any = 0; /* as wide as what is compared */
    for (size_t i = 0; band && i < n; i++) {
        any |= fabs(v[i]) <= band[i];
    }
    for (size_t i = 0; !band && i < n; i++) {
        any |= v[i] == 0.0;
    }
    return any != 0;
}

TRIBO_SIMD static void slide(size_t n, const double *restrict v, const double *restrict limit, double *restrict f)
{
    for (size_t i = 0; i < n; i++) {
        f[i] = v[i] > 0.0 ? -limit[i] : limit[i];
    }
}

/* f_eq of contacts that share no body. */
TRIBO_SIMD static void feq_alone(size_t n, const double *restrict r, const double *restrict limit, const double *restrict a,
                                 double *restrict feq)
{
    for (size_t i = 0; i < n; i++) {
        const double x = clamp(-a[i] / r[i], -DBL_MAX, DBL_MAX);
        feq[i] = limit[i] > 0.0 ? x : 0.0;
    }
}

static void begin(tribo_context *ctx)
{
    for (size_t k = 0; k < ctx->op.touches; k++) {
        ctx->op.group[ctx->op.touched[k]].touched = 0;
    }
    ctx->op.touches = 0;
    ctx->rank = 0;
    ctx->residual = 0.0;
    ctx->balanced = 0;
    ctx->linearized = 0;
}

/* For shares that go on from these forces, also in groups that no solver saw. */
static void remember(tribo_context *ctx)
{
    for (size_t g = 0; ctx->sharing == TRIBO_SHARE_LAST && g < ctx->op.groups; g++) {
        struct program *p = tribo_op_program(&ctx->op, g);
        for (size_t k = 0; !p->island->touched && k < p->island->size; k++) {
            p->x[k] = ctx->f[ctx->op.member[p->island->first + k]];
            p->at[k] = p->at[k] == FREE ? FREE : AWAY;
        }
    }
}

/* A group that has not been solved for in this call, but has a contact with near from *i on, or op.groups. */
static size_t next_group(tribo_context *ctx, size_t *i)
{
    struct op *op = &ctx->op;
    while (*i < ctx->n) {
        const unsigned char *found = memchr(ctx->near + *i, 1, ctx->n - *i);
        *i = found ? (size_t)(found - ctx->near) + 1 : ctx->n;
        const size_t k = found ? op->group_of[*i - 1] : TRIBO_ALONE;
        if (k != TRIBO_ALONE && !op->group[k].touched) {
            op->group[k].touched = 1;
            op->touched[op->touches++] = k;
            return k;
        }
    }
    return op->groups;
}

struct program *tribo_collect(tribo_context *ctx, size_t k)
{
    struct program *p = tribo_op_program(&ctx->op, k);
    const size_t *member = ctx->op.member + p->island->first;
    size_t behind = p->island->size;
    p->count = 0;
    for (size_t i = 0; i < p->island->size; i++) {
        if (ctx->near[member[i]]) {
            p->near[p->count++] = i;
        } else {
            p->near[--behind] = i;
            p->x[i] = ctx->f[member[i]];
        }
    }
    return p;
}

/* Solves the program of a group; q, lo and hi are set. */
static int solve(tribo_context *ctx, struct program *p)
{
    const struct island *is = p->island;
    const size_t *member = ctx->op.member + is->first;
    const struct work before = p->work;
    for (size_t e = 0; e < p->count; e++) {
        const size_t i = p->near[e];
        p->unit[i] = lesser(ctx->op.diagonal[member[i]] * (0.5 * p->hi[i] - 0.5 * p->lo[i]), DBL_MAX);
    }
    ctx->solves++;
    if (!tribo_box_solve(p)) {
        return tribo_fail(ctx, TRIBO_ERR_NO_CONVERGENCE, "no stick set found for the %zu contacts near stick around contact %zu",
                          p->count, member[p->near[0]]);
    }
    if (is->nullity && ctx->sharing == TRIBO_SHARE_LEAST) {
        tribo_box_share(p);
    }
    ctx->reused += p->work.factorizations == before.factorizations && p->work.updates == before.updates;
    for (size_t e = 0; e < p->count; e++) {
        const size_t i = p->near[e];
        const double to = clamp(p->x[i] - p->gradient[i] / ctx->op.diagonal[member[i]], p->lo[i], p->hi[i]);
        const double size = greater(ctx->limit[member[i]], 0.5 * p->hi[i] - 0.5 * p->lo[i]);
        ctx->residual = greater(ctx->residual, size > 0.0 ? fabs(p->x[i] - to) / size : 0.0);
    }
    ctx->rank += is->rank;
    return TRIBO_OK;
}

/* kappa, see above. */
static double relaxation(const tribo_context *ctx, size_t i, const double *v)
{
    return ctx->law->relaxes ? ctx->slope[i] * v[i] : 0.0;
}

/* f_eq = f + kappa - (R f + a + diag(R) kappa)/R_ii, with f as the solver finds it. */
static int solve_consistent(tribo_context *ctx, struct program *p, const double *v, const double *a)
{
    const size_t *member = ctx->op.member + p->island->first;
    for (size_t e = 0; e < p->count; e++) {
        const size_t k = p->near[e], i = member[k];
        const double limit = ctx->limit[i], kappa = relaxation(ctx, i, v);
        p->lo[k] = kappa < 0.0 ? lesser(limit, -limit - kappa) : -limit;
        p->hi[k] = kappa > 0.0 ? greater(-limit, limit - kappa) : limit;
        p->q[k] = a[i] + ctx->op.diagonal[i] * kappa;
    }
    const int status = solve(ctx, p);
    for (size_t e = 0; !status && e < p->count; e++) {
        const size_t k = p->near[e], i = member[k];
        /* of a contact inside its box the gradient is rounding, of which the forces of a large group would gather too much */
        const double beyond = p->at[k] == FREE ? 0.0 : p->gradient[k] / ctx->op.diagonal[i];
        ctx->feq[i] = clamp(p->x[k] + relaxation(ctx, i, v) - beyond, -DBL_MAX, DBL_MAX);
    }
    return status;
}

static int solve_partition(tribo_context *ctx, struct program *p, const double *a)
{
    const struct island *is = p->island;
    const size_t *member = ctx->op.member + is->first;
    const struct work before = p->work;
    for (size_t e = 0; e < p->count; e++) {
        const size_t k = p->near[e], i = member[k];
        p->q[k] = a[i];
        p->unit[k] = lesser(ctx->op.diagonal[i] * ctx->limit[i], DBL_MAX);
    }
    ctx->solves++;
    const int consistent = tribo_box_linear(p);
    ctx->reused += p->work.factorizations == before.factorizations && p->work.updates == before.updates;
    for (size_t e = 0; e < p->count; e++) {
        const size_t k = p->near[e], i = member[k];
        ctx->residual = greater(ctx->residual, fabs(p->gradient[k] / ctx->op.diagonal[i]) / ctx->limit[i]);
        ctx->feq[i] = clamp(p->x[k], -DBL_MAX, DBL_MAX);
    }
    ctx->rank += is->rank;
    if (consistent) {
        return TRIBO_OK;
    }
    return tribo_fail(ctx, TRIBO_ERR_INCONSISTENT,
                      "no f_eq balances the %zu contacts near stick around contact %zu: rank %zu, and a is outside its range",
                      p->count, member[p->near[0]], is->rank);
}

/* The law's forces of the near contacts of a group, run by run of neighbours. */
static void near_forces(tribo_context *ctx, const struct program *p, const double *v)
{
    const struct contacts all = tribo_contacts(ctx);
    const size_t *member = ctx->op.member + p->island->first;
    for (size_t e = 0, run; e < p->count; e += run) {
        const size_t i = member[p->near[e]];
        const struct contacts c = tribo_contacts_from(&all, i);
        for (run = 1; e + run < p->count && member[p->near[e + run]] == i + run;) {
            run++;
        }
        ctx->law->force(&c, run, v + i, ctx->feq + i, ctx->f + i);
    }
}

/* step = the values [n] of a group's contacts. */
static void gather(const tribo_context *ctx, struct program *p, const double *values)
{
    for (size_t k = 0; k < p->island->size; k++) {
        p->step[k] = values[ctx->op.member[p->island->first + k]];
    }
}

/* f_eq of the contacts in groups that no solver saw. */
static void feq_of_others(tribo_context *ctx, const double *a)
{
    for (size_t g = 0; g < ctx->op.groups; g++) {
        struct program *p = tribo_op_program(&ctx->op, g);
        const size_t *member = ctx->op.member + p->island->first, size = p->island->size;
        gather(ctx, p, ctx->f);
        for (size_t k = 0; k < size; k++) {
            const size_t i = member[k];
            if (!ctx->near[i] && ctx->limit[i] > 0.0) {
                const double sum = a[i] + tribo_row_others(p, k, p->step);
                ctx->feq[i] = clamp(-sum / ctx->op.diagonal[i], -DBL_MAX, DBL_MAX);
            }
        }
    }
}

/* f of all contacts as if they were alone, and who is near stick. Where contacts are coupled a chunk of sliding ones needs no
 * more than that, and f_eq only if the caller wants it. */
static void balance_alone(tribo_context *ctx, const double *v, const double *a, int wanted)
{
    const struct contacts all = tribo_contacts(ctx);
    const int coupled = ctx->op.groups > 0 && ctx->law->uses_feq;
    for (size_t i = 0; i < ctx->n; i += CHUNK) {
        const struct contacts c = tribo_contacts_from(&all, i);
        const size_t n = ctx->n - i < CHUNK ? ctx->n - i : CHUNK;
        const double *band = ctx->law->sticks_in_band ? ctx->epsilon + i : NULL;
        const int slides = coupled && !any_in_band(n, v + i, band);
        if (slides) {
            memset(ctx->near + i, 0, n);
            slide(n, v + i, ctx->limit + i, ctx->f + i);
        } else if (coupled) {
            find_near(n, v + i, band, ctx->limit + i, ctx->near + i);
        }
        if (wanted || !slides) {
            feq_alone(n, ctx->op.diagonal + i, ctx->limit + i, a + i, ctx->feq + i);
        }
        if (!slides) {
            ctx->law->force(&c, n, v + i, ctx->feq + i, ctx->f + i);
        }
    }
}

static int balance(tribo_context *ctx, const double *v, const double *a, int wanted)
{
    begin(ctx);
    balance_alone(ctx, v, a, wanted);
    if (ctx->op.groups == 0) {
        return TRIBO_OK; /* nobody asks for near */
    }
    if (!ctx->law->uses_feq) {
        memset(ctx->near, 0, ctx->n);
        return TRIBO_OK;
    }
    int status = TRIBO_OK;
    size_t i = 0, k = next_group(ctx, &i);
    for (; k < ctx->op.groups; k = next_group(ctx, &i)) {
        struct program *p = tribo_collect(ctx, k);
        const int one = ctx->coupling == TRIBO_PARTITION ? solve_partition(ctx, p, a) : solve_consistent(ctx, p, v, a);
        if (one == TRIBO_ERR_NO_CONVERGENCE) {
            return one;
        }
        status = one ? one : status;
        near_forces(ctx, p, v);
    }
    return status;
}

int tribo_balance(tribo_context *ctx, const double *v, const double *a, double *feq, double *f)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    int status = tribo_check_finite(ctx, "v", v, ctx->n);
    status = status ? status : tribo_check_finite(ctx, "a", a, ctx->n);
    if (status) {
        return status;
    }
    status = balance(ctx, v, a, feq != NULL);
    if (status == TRIBO_ERR_NO_CONVERGENCE) {
        return status;
    }
    ctx->skipped += ctx->op.islands - ctx->op.touches;
    remember(ctx);
    ctx->balanced = 1;
    ctx->holds = ctx->law->id == TRIBO_SMOOTH ? tanh(1.0) : 1.0;
    if (feq) {
        feq_of_others(ctx, a);
        tribo_copy(feq, ctx->feq, ctx->n);
    }
    if (f) {
        tribo_copy(f, ctx->f, ctx->n);
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------- step force and box */

/* The box over all contacts, bounds as given; scale multiplies a. Contacts whose bounds leave no choice take no part in the
 * solver, nor do those that are pulled harder than reach, what the others could do, if it is given. */
static int box(tribo_context *ctx, const double *a, double scale, const double *lower, const double *upper, const double *reach,
               double *f)
{
    begin(ctx);
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->f[i] = clamp(-(scale * a[i]) / ctx->op.diagonal[i], lower[i], upper[i]);
    }
    for (size_t i = 0; ctx->op.groups > 0 && i < ctx->n; i++) {
        ctx->near[i] = lower[i] < upper[i] && !(reach && fabs(scale * a[i]) > reach[i]);
    }
    size_t i = ctx->op.groups ? 0 : ctx->n, g = next_group(ctx, &i);
    for (; g < ctx->op.groups; g = next_group(ctx, &i)) {
        struct program *p = tribo_collect(ctx, g);
        const size_t *member = ctx->op.member + p->island->first;
        for (size_t e = 0; e < p->count; e++) {
            const size_t k = p->near[e];
            p->lo[k] = lower[member[k]];
            p->hi[k] = upper[member[k]];
            p->q[k] = scale * a[member[k]];
        }
        const int status = solve(ctx, p);
        if (status) {
            return status;
        }
        for (size_t e = 0; e < p->count; e++) {
            const size_t k = p->near[e];
            ctx->f[member[k]] = clamp(p->x[k], p->lo[k], p->hi[k]);
        }
    }
    ctx->skipped += ctx->op.islands - ctx->op.touches;
    remember(ctx);
    tribo_copy(f, ctx->f, ctx->n);
    return TRIBO_OK;
}

/* The most that friction can do to the contacts, while the limits stay as they are. */
static const double *reaches(tribo_context *ctx)
{
    struct op *op = &ctx->op;
    for (size_t g = 0; !op->reaches && g < op->groups; g++) {
        struct program *p = tribo_op_program(op, g);
        const size_t *member = op->member + p->island->first, size = p->island->size;
        gather(ctx, p, ctx->limit);
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
    int status = tribo_check_finite(ctx, "vfree", vfree, ctx->n);
    if (status) {
        return status;
    }
    if (!f && ctx->n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "f is NULL");
    }
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->lower[i] = -ctx->limit[i];
    }
    status = box(ctx, vfree, lesser(1.0 / dt, DBL_MAX), ctx->lower, ctx->limit, ctx->op.groups ? reaches(ctx) : NULL, f);
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
    return box(ctx, a, 1.0, lower, upper, NULL, f);
}
