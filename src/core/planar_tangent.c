/* How the forces of a cluster follow velocities, accelerations and limits: the contacts near stick stay in their places, and
 * Newton's equations along what these leave them say how they stay balanced. */
#include "context.h"

void tribo_planar_linearize(tribo_context *ctx, const double *v, const double *a)
{
    tribo_copy(ctx->plane.v, v, ctx->n);
    tribo_copy(ctx->plane.a, a, ctx->n);
}

/* The problem of a cluster as the last balance left it. */
static void resume(tribo_context *ctx, const struct cluster *g)
{
    struct disc_qp *p = &ctx->plane.problem;
    if (tribo_planar_collect(ctx, g, ctx->plane.v)) {
        tribo_planar_pose(ctx, g, ctx->plane.a);
        tribo_disc_gains(p);
        tribo_disc_gradients(p);
        tribo_disc_places(p);
        tribo_disc_linearize(p);
    }
}

/* How the units of a planar contact follow its limits: part of either direction, and epsilon, as a part of itself. */
struct units_change {
    double part[2], epsilon;
};

static struct units_change change_units(const tribo_context *ctx, size_t i, const struct slide *s, const struct change *d)
{
    const double *limit = ctx->set.limit + i, dlimit[2] = {tribo_limit_change(ctx, d, i), tribo_limit_change(ctx, d, i + 1)};
    const size_t far = s->part[0] == 1.0 && tribo_epsilon_of(&ctx->follow.contacts, i) == s->epsilon ? 0 : 1;
    struct units_change u = {{0.0, 0.0}, 0.0};
    for (size_t k = 0; k < 2 && !s->open; k++) {
        u.part[k] = k == far ? 0.0 : quotient(dlimit[k] - product(s->part[k], dlimit[far]), limit[far]);
    }
    u.epsilon = s->open || !ctx->follow.contacts.follows ? 0.0 : tribo_limit_growth(ctx, d, i + far);
    return u;
}

/* df of a planar contact that is not near stick. */
static void slide_product(const tribo_context *ctx, size_t i, const struct change *d, double *df)
{
    const double *v = ctx->plane.v + i;
    const struct slide s = tribo_planar_slide(&ctx->follow.contacts, i, v);
    const struct units_change u = change_units(ctx, i, &s, d);
    double slope, dx[2];
    const double carried = tribo_planar_carried(ctx->set.law, s.speed, &slope);
    for (size_t k = 0; k < 2; k++) {
        dx[k] = product(s.part[k], tribo_entry(d->v, i + k)) + product(u.part[k], v[k]);
    }
    const double along = s.n[0] * dx[0] + s.n[1] * dx[1];
    for (size_t k = 0; k < 2; k++) {
        const double turn = s.length > 0.0 ? carried * quotient(dx[k] - s.n[k] * along, s.length) : 0.0;
        const double grow =
            slope * (quotient(s.length > 0.0 ? s.n[k] * along : dx[k], s.epsilon) - product(product(s.speed, u.epsilon), s.n[k]));
        const double own = product(carried * s.n[k], tribo_limit_change(ctx, d, i + k));
        df[i + k] = s.open ? 0.0 : product(ctx->set.limit[i + k], turn + grow) + own;
    }
}

/* df of all contacts of a cluster that are not near stick, and of the others what their limits make of it. */
static void products_of_slips(const tribo_context *ctx, const struct cluster *g, const struct change *d, double *df)
{
    const size_t *member = ctx->planar->member + g->member;
    const struct disc_qp *p = &ctx->plane.problem;
    for (size_t k = 0; k < g->size; k++) {
        const size_t i = member[k];
        if (ctx->planar->role[i] == ROLE_FIRST) {
            slide_product(ctx, i, d, df);
        } else if (ctx->planar->role[i] == ROLE_SCALAR) {
            const struct tangent *law = &ctx->last.tangent[i];
            df[i] = product(law->dv, tribo_entry(d->v, i)) + product(law->dlimit, tribo_limit_change(ctx, d, i));
        }
    }
    for (size_t e = 0; e < p->size; e++) {
        const size_t i = member[ctx->plane.near[e]];
        df[i] = product(p->y[e], tribo_limit_change(ctx, d, i));
    }
}

/* How the shift of direction e of the problem changes. */
static double shift_change(const tribo_context *ctx, const size_t *member, size_t e, const struct change *d)
{
    const struct contacts *c = &ctx->follow.contacts;
    const size_t i = member[ctx->plane.near[e]];
    const double dv = tribo_entry(d->v, i), shift = ctx->plane.problem.shift[e];
    if (!ctx->set.law->relaxes) {
        return 0.0;
    }
    if (ctx->planar->role[i] == ROLE_SCALAR) {
        const double epsilon = c->follows ? tribo_limit_growth(ctx, d, i) : 0.0;
        return product(2.0 * quotient(1.0, tribo_epsilon_of(c, i)), dv) - product(shift, epsilon);
    }
    const size_t second = ctx->planar->role[i] == ROLE_SECOND;
    const struct slide s = tribo_planar_slide(c, i - second, ctx->plane.v + i - second);
    const struct units_change u = change_units(ctx, i - second, &s, d);
    const double dx = product(s.part[second], dv) + product(u.part[second], ctx->plane.v[i]);
    return 2.0 * quotient(dx, s.epsilon) - product(shift, u.epsilon);
}

/* y of the contacts near stick goes with their shift; dshift [size]. */
static void drag_all(const struct disc_qp *p, const double *dshift, double *dy)
{
    for (size_t e = 0; e < p->size; e += p->wide[e]) {
        tribo_disc_drag(p, e, dshift + e, dy + e);
    }
}

/* What presses on direction e of the problem, as its limit and those that shifts are parts of change. */
static double press_change(const tribo_context *ctx, const struct cluster *g, size_t e, const struct change *d)
{
    const struct disc_qp *p = &ctx->plane.problem;
    const size_t *member = ctx->planar->member + g->member, *near = ctx->plane.near;
    const size_t n = p->size, first = p->wide[e] ? e : e - 1, i = member[near[e]];
    double sum = product(tribo_limit_growth(ctx, d, i), p->gradient[e]);
    for (size_t j = first; j < first + p->wide[first]; j++) {
        sum += product(p->s[e * n + j] * p->shift[j], tribo_limit_growth(ctx, d, member[near[j]]));
    }
    return sum;
}

/* rhs [size] = the gradient that df, changes and shifts leave to balance; dy: what shifts drag along. */
static void find_rhs(const tribo_context *ctx, const struct cluster *g, const struct change *d, const double *df,
                     const double *dshift, const double *dy, double *rhs)
{
    const struct disc_qp *p = &ctx->plane.problem;
    const struct unit u = tribo_planar_units(ctx, g);
    const size_t *member = ctx->planar->member + g->member, *near = ctx->plane.near, n = p->size;
    for (size_t e = 0; e < n; e++) {
        const double *row = ctx->planar->r + g->r + near[e] * g->size;
        double sum = cut(tribo_entry(d->a, member[near[e]]));
        for (size_t j = 0; j < g->size; j++) {
            sum += product(row[j], df[member[j]]);
        }
        rhs[e] = ctx->follow.contacts.bound[member[near[e]]] / u.force * quotient(quotient(cut(sum), u.r), u.force);
        rhs[e] += d->limit ? press_change(ctx, g, e, d) : 0.0;
        for (size_t j = 0; j < n; j++) {
            rhs[e] += p->s[e * n + j] * dy[j];
        }
    }
    for (size_t e = 0; e < n; e += p->wide[e]) {
        for (size_t k = e; k < e + p->wide[e]; k++) {
            for (size_t j = e; j < e + p->wide[e]; j++) {
                rhs[k] += p->s[k * n + j] * dshift[j];
            }
        }
    }
}

/* Forces so far are those that f_eq balances; a law with a memory has another derivative where f_eq is beyond the limit.
 * before: the former, df: what becomes of them. */
static void reverse(const tribo_context *ctx, const struct cluster *g, const struct change *d, const double *before, double *df)
{
    const size_t *member = ctx->planar->member + g->member;
    for (size_t e = 0; ctx->set.law->remembers && e < ctx->plane.problem.size; e++) {
        const size_t k = ctx->plane.near[e], i = member[k];
        const double *row = ctx->planar->r + g->r + k * g->size;
        const struct tangent *law = &ctx->last.tangent[i];
        double sum = divisible(tribo_entry(d->a, i), row[k]);
        for (size_t j = 0; j < g->size; j++) {
            sum += j == k ? 0.0 : product(row[j], before[member[j]]);
        }
        if (ctx->planar->role[i] == ROLE_SCALAR) {
            df[i] = product(law->dv, tribo_entry(d->v, i)) + product(law->dlimit, tribo_limit_change(ctx, d, i)) -
                    product(law->dfeq, quotient(cut(sum), row[k]));
        }
    }
}

/* Lenses that move faster with v have the derivatives of these. */
#define STEEPEST 1e150

/* df [n] of a cluster that was resumed. */
static void cluster_product(tribo_context *ctx, const struct cluster *g, const struct change *d, double *df)
{
    struct disc_qp *p = &ctx->plane.problem;
    const size_t *member = ctx->planar->member + g->member, *near = ctx->plane.near;
    double *dshift = p->from, *dy = p->best, *rhs = p->noise, *move = p->aim;
    products_of_slips(ctx, g, d, df);
    for (size_t e = 0; e < p->size; e++) {
        dshift[e] = clamp(shift_change(ctx, member, e, d), -STEEPEST, STEEPEST);
    }
    drag_all(p, dshift, dy);
    find_rhs(ctx, g, d, df, dshift, dy, rhs);
    if (p->size) {
        tribo_disc_follow(p, rhs, move);
    }
    for (size_t e = 0; e < p->size; e++) {
        df[member[near[e]]] += product(ctx->follow.contacts.bound[member[near[e]]], dy[e] + move[e]);
    }
    if (ctx->set.law->remembers) {
        for (size_t k = 0; k < g->size; k++) {
            ctx->plane.other[member[k]] = df[member[k]];
        }
        reverse(ctx, g, d, ctx->plane.other, df);
    }
}

static void write_column(const tribo_context *ctx, const struct cluster *g, size_t column, const double *df, double *out)
{
    for (size_t k = 0; k < g->size; k++) {
        const size_t i = ctx->planar->member[g->member + k];
        out[i * ctx->n + column] = df[i];
    }
}

void tribo_planar_columns(tribo_context *ctx, double *df_dv, double *df_da)
{
    double *unit = ctx->plane.unit, *df = ctx->plane.df;
    const struct change by_v = {unit, NULL, NULL}, by_a = {NULL, unit, NULL};
    for (size_t q = 0; q < ctx->planar->clusters; q++) {
        const struct cluster *g = &ctx->planar->cluster[q];
        resume(ctx, g);
        for (size_t k = 0; k < g->size; k++) {
            const size_t i = ctx->planar->member[g->member + k];
            unit[i] = 1.0;
            if (df_dv) {
                cluster_product(ctx, g, &by_v, df);
                write_column(ctx, g, i, df, df_dv);
            }
            if (df_da) {
                cluster_product(ctx, g, &by_a, df);
                write_column(ctx, g, i, df, df_da);
            }
            unit[i] = 0.0;
        }
    }
}

void tribo_planar_product(tribo_context *ctx, const struct change *d, double *df)
{
    for (size_t q = 0; q < ctx->planar->clusters; q++) {
        const struct cluster *g = &ctx->planar->cluster[q];
        resume(ctx, g);
        cluster_product(ctx, g, d, df);
    }
}
