/* SPDX-License-Identifier: BSD-3-Clause */
/* The law of the caller: boxes by its function, checked; forces and derivatives from them. */
#include "own.h"
#include "calls.h"

/* Shifts up to this size can be taken from any f_eq. */
#define SHIFT_MOST (0.25 * DBL_MAX)

/* Contacts as the function of the caller gets them. */
struct asked {
    const double *v, *limit, *epsilon;
    double room[TRIBO_CHUNK];
};

TRIBO_SIMD static void fill_box(size_t n, double *restrict box)
{
    for (size_t i = 0; i < n; i++) {
        box[i] = HUGE_VAL;
    }
}

/* box = what the function of the caller writes over HUGE_VAL. Returns its answer. */
static int ask(const struct contacts *c, size_t n, int derivatives, const double *v, struct asked *to, double *box)
{
    to->v = v;
    to->limit = c->limit;
    to->epsilon = c->follows ? to->room : c->width;
    for (size_t i = 0; c->follows && i < n; i++) {
        to->room[i] = tribo_epsilon_of(c, i);
    }
    if (n == 1 && !derivatives) {
        box[LOWER] = box[UPPER] = box[SHIFT] = HUGE_VAL;
    } else {
        fill_box(n * (derivatives ? ALL_ROWS : BOX_ROWS), box);
    }
    return c->user->law(c->first, n, derivatives, v, to->limit, to->epsilon, box, c->user->data);
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

/* Negative if |lower| or |upper| > limit, or |shift| > SHIFT_MOST, or one is NaN. Raises no floating-point exception. */
static inline int64_t bounds_room(const double *limit, const double *lower, const double *upper, const double *shift)
{
    const double most = SHIFT_MOST;
    const int64_t bound = tribo_size_of(limit), far = tribo_size_of(&most);
    return (bound - tribo_size_of(lower)) | (bound - tribo_size_of(upper)) | (far - tribo_size_of(shift));
}

/* Positive if lower > upper, or lower < upper where |v| > epsilon. */
static inline double order_excess(double v, double epsilon, double lower, double upper)
{
    const double wide = (fabs(v) > epsilon ? upper : lower) - lower;
    return greater(lower - upper, wide);
}

/* f = clamp(feq - shift, lower, upper). Returns 1, or 0 if one of the boxes is none: before a comparison with NaN. */
TRIBO_SIMD static int take_forces(size_t n, const double *restrict v, const double *restrict limit,
                                  const double *restrict epsilon, const double *restrict feq, const double *restrict box,
                                  double *restrict f)
{
    int64_t room = 0, bad = 0; /* as wide as a double, for vectors */
    TRIBO_UNROLLED
    for (size_t i = 0; i < n; i++) {
        room |= bounds_room(limit + i, box + i, box + n + i, box + SHIFT * n + i);
    }
    if (room < 0) {
        return 0;
    }
    for (size_t i = 0; i < n; i++) {
        bad |= order_excess(v[i], epsilon[i], box[i], box[n + i]) > 0.0 ? -1 : 0;
        f[i] = clamp(feq[i] - box[SHIFT * n + i], box[i], box[n + i]);
    }
    return bad == 0;
}

int tribo_own_boxes(const struct contacts *c, size_t n, int derivatives, const double *v, const double *feq, double *box,
                    double *f)
{
    struct asked s;
    int good = !ask(c, n, derivatives, v, &s, box);
    if (good && n == 1) {
        good = bounds_room(s.limit, box + LOWER, box + UPPER, box + SHIFT) >= 0 &&
               !(order_excess(*v, *s.epsilon, box[LOWER], box[UPPER]) > 0.0);
        *f = good ? clamp(*feq - box[SHIFT], box[LOWER], box[UPPER]) : HUGE_VAL;
    } else if (good) {
        good = take_forces(n, v, s.limit, s.epsilon, feq, box, f);
    }
    good = good && (!derivatives || tribo_all_within(box + BY_V_ROWS * n, BOX_ROWS * n, DBL_MAX));
    if (!good) {
        fill_box(n, f);
        fill_box(n * (derivatives ? ALL_ROWS : BOX_ROWS), box);
    }
    return good;
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

static void own_force_all(const struct contacts *c, size_t n, const double *v, const double *feq, double *f)
{
    for (size_t i = 0, m; i < n; i += m) {
        const struct contacts part = tribo_contacts_from(c, i);
        double space[BOX_ROWS * TRIBO_CHUNK + TRIBO_LINE], *box = tribo_aligned(space);
        m = tribo_chunk_from(n, i);
        tribo_own_boxes(&part, m, 0, v + i, feq + i, box, f + i);
    }
}

/* Returns the derivative of clamp(x, lower, upper), x = feq - shift, at constant feq; rows: derivatives of lower, upper, shift. */
static inline double by_side(double x, const double *restrict box, const double *restrict rows, size_t n, size_t i)
{
    const double lower = rows[i], upper = rows[n + i], inside = -rows[SHIFT * n + i], above = x >= box[n + i] ? upper : inside;
    return x <= box[i] ? lower : above;
}

/* Derivatives of f = clamp(feq - shift, lower, upper). dlimit = HUGE_VAL of contacts without derivatives by the limit. */
TRIBO_SIMD static void take_tangents(size_t n, const double *restrict feq, const double *restrict box, double *restrict dv,
                                     double *restrict dfeq, double *restrict dlimit)
{
    const double most = DBL_MAX;
    const int64_t finite = tribo_size_of(&most);
    for (size_t i = 0; i < n; i++) {
        const double x = feq[i] - box[SHIFT * n + i], below = x < box[n + i] ? 1.0 : 0.0;
        const double by_limit = by_side(x, box, box + BY_LIMIT_ROWS * n, n, i);
        dv[i] = by_side(x, box, box + BY_V_ROWS * n, n, i);
        dfeq[i] = x > box[i] ? below : 0.0;
        dlimit[i] = tribo_size_of(&by_limit) <= finite ? by_limit : HUGE_VAL;
    }
}

static void own_tangent_all(const struct contacts *c, size_t n, const double *v, const double *feq, const struct tangents *d)
{
    double space[ALL_ROWS * TRIBO_CHUNK + TRIBO_LINE], *box = tribo_aligned(space);
    if (tribo_own_boxes(c, n, 1, v, feq, box, d->f)) {
        take_tangents(n, feq, box, d->dv, d->dfeq, d->dlimit);
        return;
    }
    fill_box(n, d->dv);
    fill_box(n, d->dfeq);
    fill_box(n, d->dlimit);
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

TRIBO_SIMD void tribo_own_slips(tribo_context *ctx, size_t at, const double *v, const double *box)
{
    const double *limit = ctx->follow.contacts.limit + at, *f = ctx->last.f + at;
    const size_t n = tribo_chunk_size(ctx, at);
    signed char *slip = ctx->last.slip + at;
    TRIBO_APART
    for (size_t i = 0; i < n; i++) {
        slip[i] = tribo_own_slip(v[i], f[i], limit[i], box[i], box[n + i]);
    }
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
            const double middle = 0.5 * tribo_own_at(ctx, LOWER, i) + 0.5 * tribo_own_at(ctx, UPPER, i);
            const double inside = middle + tribo_own_at(ctx, SHIFT, i);
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
        double box[ALL_ROWS * TRIBO_CHUNK], ignored[TRIBO_CHUNK];
        n = tribo_chunk_size(ctx, i);
        if (!tribo_own_boxes(&c, n, 1, rest, rest, box, ignored)) {
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
