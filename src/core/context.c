/* Life of a context, and its settings. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"

#define DEFAULT_EPSILON 1e-6

double tribo_slope(double limit, double epsilon)
{
    return 2.0 * quotient(limit, epsilon);
}

/* The bounds of the solver, which are the limits unless one of them is beyond what can be told apart. */
static void find_bounds(tribo_context *ctx)
{
    ctx->largest = 0.0;
    for (size_t k = 0; k < tribo_chunks(ctx->n); k++) {
        ctx->largest = greater(ctx->largest, ctx->chunk[k].largest);
    }
    if (ctx->largest <= ctx->op.most) {
        ctx->bound = ctx->limit;
        return;
    }
    ctx->bound = ctx->bounds;
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->bound[i] = lesser(ctx->limit[i], TRIBO_FAR);
    }
    for (size_t g = 0; g < ctx->op.groups; g++) {
        const struct program *p = tribo_op_program(&ctx->op, g);
        for (size_t k = 0; k < p->island->size; k++) {
            ctx->bound[p->member[k]] = lesser(ctx->limit[p->member[k]], tribo_most(p, k));
        }
    }
}

static void take_given(tribo_context *ctx)
{
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->epsilon[i] = ctx->given[i];
        ctx->slope[i] = tribo_slope(ctx->bound[i], ctx->given[i]);
    }
}

/* epsilon = 2 limit R_ii time, with a slope that knows nothing of the limit. What friction cannot move does not relax. */
static void follow_step(tribo_context *ctx)
{
    const double time = quotient(ctx->step, ctx->lambda_dt);
    for (size_t i = 0; i < ctx->n; i++) {
        const double width = greater(product(ctx->op.diagonal[i], time), DBL_MIN), slope = 1.0 / width;
        const double limit = lesser(ctx->bound[i], 0.5 * TRIBO_FAR * lesser(slope, 1.0));
        ctx->epsilon[i] = greater(2.0 * width * limit, DBL_MIN);
        ctx->slope[i] = limit > 0.0 && ctx->op.diagonal[i] > TRIBO_IMMOVABLE ? slope : 0.0;
    }
}

void tribo_refresh(tribo_context *ctx)
{
    ctx->op.reaches = 0;
    ctx->linearized = 0;
    ctx->revision++;
    tribo_refresh_limits(ctx);
    find_bounds(ctx);
    if (ctx->step > 0.0 && ctx->op.diagonal) {
        follow_step(ctx);
    } else {
        take_given(ctx);
    }
    tribo_refresh_widths(ctx);
}

/* Everything but the operator. One contact more than asked for, so that no array is empty. */
static int allocate(tribo_context *ctx, size_t n)
{
    const size_t m = n + 1;
    ctx->n = n;
    ctx->message = tribo_message_create();
    ctx->given = malloc(m * sizeof *ctx->given);
    ctx->limit = ctx->limit_then = ctx->limits = calloc(2 * m, sizeof *ctx->limits);
    ctx->bounds = malloc(m * sizeof *ctx->bounds);
    ctx->epsilon = malloc(m * sizeof *ctx->epsilon);
    ctx->slope = malloc(m * sizeof *ctx->slope);
    ctx->moving = calloc(m, sizeof *ctx->moving);
    ctx->feq = calloc(m, sizeof *ctx->feq);
    ctx->f = calloc(m, sizeof *ctx->f);
    ctx->v = malloc(m * sizeof *ctx->v);
    ctx->chunk = malloc(tribo_chunks(m) * sizeof *ctx->chunk);
    ctx->last.state = calloc(m + tribo_chunks(m), 1);
    ctx->spare.state = calloc(m + tribo_chunks(m), 1);
    ctx->tangent = malloc(m * sizeof *ctx->tangent);
    if (ctx->last.state && ctx->spare.state) {
        ctx->last.kind = ctx->last.state + m;
        ctx->spare.kind = ctx->spare.state + m;
    }
    return ctx->message && ctx->chunk && ctx->last.state && ctx->spare.state && ctx->given && ctx->limits && ctx->bounds &&
           ctx->epsilon && ctx->slope && ctx->moving && ctx->feq && ctx->f && ctx->v && ctx->tangent;
}

int tribo_create(tribo_context **ctx, size_t ncontact)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (ncontact >= SIZE_MAX / 64) {
        return TRIBO_ERR_SIZE;
    }
    tribo_context *c = calloc(1, sizeof *c);
    if (!c || !allocate(c, ncontact)) {
        tribo_destroy(c);
        return TRIBO_ERR_MEMORY;
    }
    c->op.most = TRIBO_FAR;
    c->law = tribo_law(TRIBO_QUINN);
    c->kept = 1;
    c->coupling = TRIBO_CONSISTENT;
    c->sharing = TRIBO_SHARE_LEAST_NORM;
    for (size_t i = 0; i < ncontact; i++) {
        c->given[i] = DEFAULT_EPSILON;
    }
    tribo_refresh(c);
    *ctx = c;
    return TRIBO_OK;
}

int tribo_clone(const tribo_context *ctx, tribo_context **copy)
{
    if (!ctx || !copy) {
        return TRIBO_ERR_NULL;
    }
    const size_t n = ctx->n;
    tribo_context *c = malloc(sizeof *c);
    if (!c) {
        return tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for a copy of %zu contacts", n);
    }
    *c = *ctx;
    c->owner = NULL;
    memset(&c->op, 0, sizeof c->op);
    if (!allocate(c, n) || !tribo_op_copy(&c->op, &ctx->op, n)) {
        tribo_destroy(c);
        return tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for a copy of %zu contacts", n);
    }
    c->linearized = 0;
    tribo_copy(c->given, ctx->given, n);
    tribo_copy(c->limit, ctx->limit, n);
    if (ctx->limit_then != ctx->limit) {
        c->limit_then = c->limits + n + 1;
        tribo_copy(c->limit_then, ctx->limit_then, n);
    }
    c->bound = ctx->bound == ctx->limit ? c->limit : c->bounds;
    tribo_copy(c->bound, ctx->bound, n);
    tribo_copy(c->epsilon, ctx->epsilon, n);
    tribo_copy(c->slope, ctx->slope, n);
    tribo_copy(c->feq, ctx->feq, n);
    tribo_copy(c->f, ctx->f, n);
    memcpy(c->moving, ctx->moving, n);
    memcpy(c->chunk, ctx->chunk, tribo_chunks(n) * sizeof *c->chunk);
    memcpy(c->last.state, ctx->last.state, n);
    memcpy(c->last.kind, ctx->last.kind, tribo_chunks(n));
    *copy = c;
    return TRIBO_OK;
}

void tribo_destroy(tribo_context *ctx)
{
    if (!ctx) {
        return;
    }
    tribo_op_free(&ctx->op);
    free(ctx->message);
    free(ctx->given);
    free(ctx->limits);
    free(ctx->bounds);
    free(ctx->epsilon);
    free(ctx->slope);
    free(ctx->moving);
    free(ctx->feq);
    free(ctx->f);
    free(ctx->v);
    free(ctx->chunk);
    free(ctx->last.state);
    free(ctx->spare.state);
    free(ctx->tangent);
    free(ctx);
}

size_t tribo_revision(const tribo_context *ctx)
{
    return ctx ? ctx->revision : 0;
}

int tribo_set_owner(tribo_context *ctx, const char *owner)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    ctx->owner = owner;
    return TRIBO_OK;
}

int tribo_fail_without_operator(const tribo_context *ctx)
{
    return tribo_fail(ctx, TRIBO_ERR_STATE,
                      "no operator: call tribo_set_operator_diagonal or another tribo_set_operator_... first");
}

int tribo_get_ncontact(const tribo_context *ctx, size_t *ncontact)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!ncontact) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "ncontact is NULL");
    }
    *ncontact = ctx->n;
    return TRIBO_OK;
}

int tribo_set_law(tribo_context *ctx, int law)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const struct law *l = tribo_law(law);
    if (!l) {
        return tribo_fail(ctx, TRIBO_ERR_RANGE, "law = %d is none of the %d laws", law, tribo_law_count());
    }
    ctx->law = l;
    ctx->linearized = 0;
    ctx->revision++;
    memset(ctx->moving, 0, ctx->n);
    return TRIBO_OK;
}

int tribo_get_law(const tribo_context *ctx, int *law)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!law) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "law is NULL");
    }
    *law = ctx->law->id;
    return TRIBO_OK;
}

/* Where limits are set: those of the last balance stay, for its modes. */
static double *new_limits(tribo_context *ctx)
{
    if (ctx->limit_then == ctx->limit) {
        ctx->limit = ctx->limits + (ctx->limit == ctx->limits ? ctx->n + 1 : 0);
    }
    return ctx->limit;
}

int tribo_set_limit(tribo_context *ctx, const double *limit)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const int status = tribo_check_nonnegative(ctx, "limit", limit, ctx->n);
    if (status) {
        return status;
    }
    tribo_copy(new_limits(ctx), limit, ctx->n);
    tribo_refresh(ctx);
    return TRIBO_OK;
}

int tribo_set_limit_all(tribo_context *ctx, double limit)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!isfinite(limit)) {
        return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "limit = %g is not finite", limit);
    }
    if (limit < 0.0) {
        return tribo_fail(ctx, TRIBO_ERR_NEGATIVE, "limit = %g is negative", limit);
    }
    double *each = new_limits(ctx);
    for (size_t i = 0; i < ctx->n; i++) {
        each[i] = limit;
    }
    tribo_refresh(ctx);
    return TRIBO_OK;
}

static int copy_out(const tribo_context *ctx, const char *name, const double *from, double *to)
{
    if (!to && ctx->n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "%s is NULL", name);
    }
    tribo_copy(to, from, ctx->n);
    return TRIBO_OK;
}

int tribo_get_limit(const tribo_context *ctx, double *limit)
{
    return ctx ? copy_out(ctx, "limit", ctx->limit, limit) : TRIBO_ERR_NULL;
}

int tribo_get_epsilon(const tribo_context *ctx, double *epsilon)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const int status = tribo_need_epsilon(ctx);
    return status ? status : copy_out(ctx, "epsilon", ctx->epsilon, epsilon);
}

int tribo_set_epsilon(tribo_context *ctx, const double *epsilon)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const int status = tribo_check_positive(ctx, "epsilon", epsilon, ctx->n);
    if (status) {
        return status;
    }
    tribo_copy(ctx->given, epsilon, ctx->n);
    ctx->step = 0.0;
    tribo_refresh(ctx);
    return TRIBO_OK;
}

static int check_scalar(const tribo_context *ctx, const char *name, double x)
{
    if (!isfinite(x)) {
        return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "%s = %g is not finite", name, x);
    }
    if (x <= 0.0) {
        return tribo_fail(ctx, TRIBO_ERR_NOT_POSITIVE, "%s = %g is not positive", name, x);
    }
    return TRIBO_OK;
}

int tribo_set_epsilon_all(tribo_context *ctx, double epsilon)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const int status = check_scalar(ctx, "epsilon", epsilon);
    if (status) {
        return status;
    }
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->given[i] = epsilon;
    }
    ctx->step = 0.0;
    tribo_refresh(ctx);
    return TRIBO_OK;
}

int tribo_set_epsilon_step(tribo_context *ctx, double dt, double lambda_dt)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    int status = check_scalar(ctx, "dt", dt);
    if (!status) {
        status = check_scalar(ctx, "lambda_dt", lambda_dt);
    }
    if (status) {
        return status;
    }
    ctx->step = dt;
    ctx->lambda_dt = lambda_dt;
    tribo_refresh(ctx);
    return TRIBO_OK;
}

int tribo_set_coupling(tribo_context *ctx, int coupling)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (coupling != TRIBO_CONSISTENT && coupling != TRIBO_PARTITION) {
        return tribo_fail(ctx, TRIBO_ERR_RANGE, "coupling = %d is neither TRIBO_CONSISTENT nor TRIBO_PARTITION", coupling);
    }
    ctx->coupling = coupling;
    ctx->linearized = 0;
    ctx->revision++;
    return TRIBO_OK;
}

int tribo_get_coupling(const tribo_context *ctx, int *coupling)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!coupling) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "coupling is NULL");
    }
    *coupling = ctx->coupling;
    return TRIBO_OK;
}

int tribo_set_sharing(tribo_context *ctx, int sharing)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (sharing != TRIBO_SHARE_LEAST_NORM && sharing != TRIBO_SHARE_PREVIOUS) {
        return tribo_fail(ctx, TRIBO_ERR_RANGE, "sharing = %d is neither TRIBO_SHARE_LEAST_NORM nor TRIBO_SHARE_PREVIOUS",
                          sharing);
    }
    ctx->sharing = sharing;
    ctx->linearized = 0;
    ctx->revision++;
    return TRIBO_OK;
}

int tribo_get_sharing(const tribo_context *ctx, int *sharing)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!sharing) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "sharing is NULL");
    }
    *sharing = ctx->sharing;
    return TRIBO_OK;
}

/* The force alone tells: only where a law holds the contact is it less than the limit. (The smooth law never reaches the limit;
 * it counts as holding where |v| < epsilon.) */
static signed char mode_of(const tribo_context *ctx, size_t i)
{
    const double limit = ctx->limit_then[i], f = tribo_force_of(ctx, i);
    return (signed char)(limit > 0.0 ? fabs(f) < ctx->holds * limit ? 0 : f < 0.0 ? 1 : -1 : 2);
}

int tribo_get_slip(const tribo_context *ctx, signed char *mode)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!mode && ctx->n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "mode is NULL");
    }
    if (!ctx->balanced) {
        return tribo_fail(ctx, TRIBO_ERR_STATE,
                          "no tribo_balance or tribo_step_force since the last tribo_solve_box or operator");
    }
    for (size_t i = 0; i < ctx->n; i++) {
        mode[i] = mode_of(ctx, i);
    }
    return TRIBO_OK;
}

static size_t count_stuck(const tribo_context *ctx)
{
    size_t stuck = 0;
    for (size_t i = 0; ctx->balanced && i < ctx->n; i++) {
        stuck += mode_of(ctx, i) == 0;
    }
    return stuck;
}

int tribo_get_count(const tribo_context *ctx, int which, size_t *value)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!value) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "value is NULL");
    }
    const size_t counts[] = {
        [TRIBO_COUNT_STUCK] = which == TRIBO_COUNT_STUCK ? count_stuck(ctx) : 0,
        [TRIBO_COUNT_RANK] = ctx->rank,
        [TRIBO_COUNT_ISLANDS] = ctx->op.islands,
        [TRIBO_COUNT_SOLVES] = ctx->solves,
        [TRIBO_COUNT_SKIPPED] = ctx->skipped,
        [TRIBO_COUNT_FACTORIZATIONS] = ctx->op.program.work.factorizations,
        [TRIBO_COUNT_UPDATES] = ctx->op.program.work.updates,
        [TRIBO_COUNT_REVERSALS] = ctx->marks,
        [TRIBO_COUNT_REUSED] = ctx->reused,
    };
    if (which < 0 || which >= (int)(sizeof counts / sizeof *counts)) {
        return tribo_fail(ctx, TRIBO_ERR_RANGE, "which = %d is no count", which);
    }
    *value = counts[which];
    return TRIBO_OK;
}

/* In the consistent coupling a stuck contact relaxes at its own 2 N R_ii/epsilon; otherwise v' = -R diag(s) v with s =
 * 2N/epsilon, or half of it for the laws that are dampers near v = 0. The eigenvalues of that are at most the largest s_i R_ii
 * times the largest eigenvalue of D^-1 R, for any set of contacts near stick. */
static double max_rate(const tribo_context *ctx)
{
    double rate = 0.0;
    for (size_t i = 0; i < ctx->n; i++) {
        if (ctx->limit[i] > 0.0) {
            rate = greater(rate, product(ctx->slope[i], ctx->op.diagonal[i]));
        }
    }
    if (!ctx->law->uses_feq) {
        return product(0.5 * rate, ctx->op.growth);
    }
    if (!ctx->law->relaxes) {
        return 0.0;
    }
    return ctx->coupling == TRIBO_PARTITION ? product(rate, ctx->op.growth) : rate;
}

int tribo_get_real(const tribo_context *ctx, int which, double *value)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!value) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "value is NULL");
    }
    if (which == TRIBO_REAL_RESIDUAL) {
        *value = ctx->residual;
        return TRIBO_OK;
    }
    if (which != TRIBO_REAL_MAX_RATE && which != TRIBO_REAL_MAX_STEP) {
        return tribo_fail(ctx, TRIBO_ERR_RANGE, "which = %d is no real quantity", which);
    }
    const int status = tribo_need_operator(ctx);
    if (!status) {
        const double rate = max_rate(ctx);
        *value = which == TRIBO_REAL_MAX_RATE ? rate : rate > 0.0 ? quotient(2.785, rate) : HUGE_VAL;
    }
    return status;
}
