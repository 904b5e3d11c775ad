/* SPDX-License-Identifier: BSD-3-Clause */
/* The law of the caller: boxes by its function, checked; forces and derivatives from them. */
#include "own.h"
#include "calls.h"

/* Shifts up to this size can be taken from any f_eq. */
#define SHIFT_MOST (0.25 * DBL_MAX)

/* Contacts as the function of the caller gets them. */
struct asked {
    const double *v, *limit, *epsilon;
    double room[2][TRIBO_CHUNK];
};

TRIBO_SIMD static void fill_with(size_t n, double x, double *restrict to)
{
    for (size_t i = 0; i < n; i++) {
        to[i] = x;
    }
}

/* box = what the function of the caller writes over HUGE_VAL. Returns its answer. */
static int ask(const struct contacts *c, size_t n, int derivatives, const double *v, struct asked *to, double *box)
{
    to->v = v;
    to->limit = c->alike ? to->room[0] : c->limit;
    to->epsilon = c->alike || c->follows ? to->room[1] : c->width;
    if (c->alike) {
        fill_with(n, *c->limit, to->room[0]);
        fill_with(n, tribo_epsilon_of(c, 0), to->room[1]);
    }
    for (size_t i = 0; !c->alike && c->follows && i < n; i++) {
        to->room[1][i] = tribo_epsilon_of(c, i);
    }
    fill_with(n * (derivatives ? ALL_ROWS : BOX_ROWS), HUGE_VAL, box);
    return c->user->law(c->first, n, derivatives, v, to->limit, to->epsilon, box, c->user->data);
}

TRIBO_SIMD static int are_boxes(size_t n, const double *restrict v, const double *restrict limit, const double *restrict epsilon,
                                const double *restrict box)
{
    const double *lower = box, *upper = box + n, *shift = box + SHIFT * n;
    int64_t bad = 0; /* as wide as a double, for vectors */
    TRIBO_UNROLLED
    for (size_t i = 0; i < n; i++) {
        const double wide = (fabs(v[i]) > epsilon[i] ? upper[i] : lower[i]) - lower[i];
        const double out = greater(-limit[i] - lower[i], upper[i] - limit[i]);
        bad |= greater(greater(out, lower[i] - upper[i]), greater(wide, fabs(shift[i]) - SHIFT_MOST)) > 0.0 ? -1 : 0;
    }
    return bad == 0;
}

/* tribo_own_boxes; *s = the arguments of the caller's function. */
static int boxes_of(const struct contacts *c, size_t n, int derivatives, const double *v, struct asked *s, double *box)
{
    const size_t all = n * (derivatives ? ALL_ROWS : BOX_ROWS), needed = n * (derivatives ? BY_LIMIT_ROWS : BOX_ROWS);
    const int good = !ask(c, n, derivatives, v, s, box) && tribo_all_within(box, needed, DBL_MAX) &&
                     are_boxes(n, v, s->limit, s->epsilon, box);
    for (size_t k = good ? needed : 0; k < all; k++) {
        box[k] = good && isfinite(box[k]) ? box[k] : HUGE_VAL;
    }
    return good;
}

int tribo_own_boxes(const struct contacts *c, size_t n, int derivatives, const double *v, double *box)
{
    struct asked s;
    return boxes_of(c, n, derivatives, v, &s, box);
}

/* What is wrong with the box of contact i of asked, and in which row; NULL: nothing. */
static const char *flaw(const struct asked *s, size_t n, size_t i, int rows, const double *box, int *row)
{
    const double *of = box + i;
    for (*row = 0; *row < rows; ++*row) {
        if (!isfinite(of[(size_t)*row * n])) {
            return "not finite";
        }
    }
    const int low = of[0]<-s->limit[i], high = of[n]> s->limit[i], wide = fabs(s->v[i]) > s->epsilon[i] && of[0] < of[n];
    *row = low ? LOWER : fabs(of[SHIFT * n]) > SHIFT_MOST ? SHIFT : UPPER;
    return low || high     ? "beyond the limit"
           : of[0] > of[n] ? "less than lower"
           : *row == SHIFT ? "too large"
           : wide          ? "above lower, outside epsilon"
                           : NULL;
}

int tribo_own_fail(tribo_context *ctx, int derivatives, const double *v)
{
    static const char *const name[] = {"lower", "upper", "shift", "d(lower)/dv", "d(upper)/dv", "d(shift)/dv"};
    for (size_t i = 0, n; i < ctx->n; i += n) {
        const struct contacts c = tribo_chunk_contacts(ctx, i);
        double box[ALL_ROWS * TRIBO_CHUNK];
        struct asked s;
        n = tribo_chunk_size(ctx, i);
        const int answer = ask(&c, n, derivatives, v + i, &s, box);
        if (answer) {
            return tribo_fail(ctx, TRIBO_ERR_CALLBACK, "law answered %d for %zu contact%s, of which the first is contact %zu",
                              answer, n, plural(n), i);
        }
        for (size_t k = 0; k < n; k++) {
            int row;
            const char *wrong = flaw(&s, n, k, derivatives ? BY_LIMIT_ROWS : BOX_ROWS, box, &row);
            if (wrong) {
                return tribo_fail(ctx, TRIBO_ERR_CALLBACK, "law: %s of contact %zu is %.15g, %s (v = %g, limit = %.15g)",
                                  name[row], i + k, box[(size_t)row * n + k], wrong, v[i + k], s.limit[k]);
            }
        }
    }
    return tribo_fail(ctx, TRIBO_ERR_CALLBACK, "law has different answers to equal questions");
}

/* ------------------------------------------------------------------------------------------------------- forces of boxes */

TRIBO_SIMD static void clamp_all(size_t n, const double *restrict feq, const double *restrict lower, const double *restrict upper,
                                 const double *restrict shift, double *restrict f)
{
    for (size_t i = 0; i < n; i++) {
        f[i] = clamp(feq[i] - shift[i], lower[i], upper[i]);
    }
}

static void own_force_all(const struct contacts *c, size_t n, const double *v, const double *feq, double *f)
{
    for (size_t i = 0, m; i < n; i += m) {
        const struct contacts part = tribo_contacts_from(c, i);
        double box[BOX_ROWS * TRIBO_CHUNK];
        m = tribo_chunk_from(n, i);
        tribo_own_boxes(&part, m, 0, v + i, box);
        clamp_all(m, feq + i, box, box + m, box + SHIFT * m, f + i);
    }
}

static void own_tangent_all(const struct contacts *c, size_t n, const double *v, const double *feq, const struct tangents *d)
{
    double box[ALL_ROWS * TRIBO_CHUNK];
    const int good = tribo_own_boxes(c, n, 1, v, box);
    for (size_t i = 0; i < n; i++) {
        const double x = feq[i] - box[SHIFT * n + i];
        const int row = x <= box[i] ? LOWER : x >= box[n + i] ? UPPER : SHIFT;
        const double *by_v = box + (BY_V_ROWS + (size_t)row) * n, *by_limit = box + (BY_LIMIT_ROWS + (size_t)row) * n;
        d->f[i] = clamp(x, box[i], box[n + i]);
        d->dv[i] = row == SHIFT ? -by_v[i] : by_v[i];
        d->dfeq[i] = row == SHIFT ? 1.0 : good ? 0.0 : HUGE_VAL;
        d->dlimit[i] = row == SHIFT ? -by_limit[i] : by_limit[i];
    }
}

const struct law tribo_law_own = {
    .id = TRIBO_USER_LAW,
    .name = "of the caller",
    .uses_feq = 1,
    .sticks_in_band = 1,
    .holds = 1.0,
    .force = own_force_all,
    .tangent = own_tangent_all,
};

/* ------------------------------------------------------------------------------------------------------------- balances */

TRIBO_SIMD static void slips_of_boxes(size_t n, const double *restrict v, const double *restrict f, const double *restrict limit,
                                      const double *restrict lower, const double *restrict upper, signed char *restrict slip)
{
    for (size_t i = 0; i < n; i++) {
        const double to = v[i] != 0.0 ? v[i] : -f[i], forth = to > 0.0 ? TRIBO_SLIP_FORTH : 0.0, back = to < 0.0 ? 1.0 : 0.0;
        const double under = f[i] < upper[i] ? 0.0 : forth - back, slides = f[i] > lower[i] ? under : forth - back;
        slip[i] = (signed char)(int)(limit[i] > 0.0 ? slides : TRIBO_SLIP_OPEN); /* as in slip_by_force */
    }
}

void tribo_own_forces(tribo_context *ctx, size_t i, const double *v, const double *feq, double *f)
{
    const size_t n = tribo_chunk_size(ctx, i);
    const struct contacts c = tribo_chunk_contacts(ctx, i);
    double box[BOX_ROWS * TRIBO_CHUNK];
    struct asked s;
    boxes_of(&c, n, 0, v, &s, box);
    clamp_all(n, feq, box, box + n, box + SHIFT * n, f);
    if (tribo_all_alone(ctx)) {
        slips_of_boxes(n, v, f, s.limit, box, box + n, ctx->last.slip + i);
    }
    for (int row = 0; !tribo_all_alone(ctx) && row < BOX_ROWS; row++) {
        memcpy(tribo_own_row(ctx, row) + i, box + (size_t)row * n, n * sizeof *box);
    }
}

void tribo_own_slips(tribo_context *ctx, const double *v)
{
    if (!tribo_all_alone(ctx)) {
        slips_of_boxes(ctx->n, v, ctx->last.f, ctx->follow.contacts.limit, tribo_own_row(ctx, LOWER), tribo_own_row(ctx, UPPER),
                       ctx->last.slip);
    }
    ctx->last.slips = SLIPS_WRITTEN;
}

int tribo_own_failed(const tribo_context *ctx, const double *f)
{
    int failed = 0;
    for (size_t i = 0; i < ctx->n; i += TRIBO_CHUNK) {
        failed |= !isfinite(f[i]); /* as all others of a chunk without boxes */
    }
    return failed;
}

void tribo_own_sides(tribo_context *ctx)
{
    for (size_t k = 0; k < ctx->memory.nsolved; k++) {
        const struct box_qp *p = tribo_problem(ctx, ctx->memory.solved_list[k]);
        for (size_t e = 0; e < p->group->size; e++) {
            const size_t i = p->member[e];
            const double middle = 0.5 * tribo_own_row(ctx, LOWER)[i] + 0.5 * tribo_own_row(ctx, UPPER)[i];
            const double inside = middle + tribo_own_row(ctx, SHIFT)[i];
            const double far = p->at[e] == AT_UPPER ? 2.0 * SHIFT_MOST : -2.0 * SHIFT_MOST;
            ctx->last.feq[i] = !ctx->last.near[i] ? ctx->last.feq[i] : p->at[e] == FREE ? inside : far;
        }
    }
}

int tribo_own_rate(const tribo_context *ctx, double *rate)
{
    *rate = 0.0;
    for (size_t i = 0, n; i < ctx->n; i += n) {
        const double rest[TRIBO_CHUNK] = {0.0};
        const struct contacts c = tribo_chunk_contacts(ctx, i);
        double box[ALL_ROWS * TRIBO_CHUNK];
        n = tribo_chunk_size(ctx, i);
        if (!tribo_own_boxes(&c, n, 1, rest, box)) {
            return TRIBO_ERR_CALLBACK;
        }
        for (size_t k = 0; k < n; k++) {
            const double *by_v = box + BY_V_ROWS * n + k;
            const double slope = box[k] < box[n + k] ? by_v[SHIFT * n] : -lesser(by_v[0], by_v[n]);
            const int alone = box[k] < box[n + k] && ctx->set.coupling == TRIBO_CONSISTENT;
            *rate = greater(*rate, product(product(slope, ctx->op->diagonal[i + k]), alone ? 1.0 : ctx->op->growth));
        }
    }
    return TRIBO_OK;
}
