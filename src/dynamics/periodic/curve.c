/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves of periodic motions by pseudo-arc-length: from a motion, `ahead` along the tangent, then by shooting to the curve within
 * the section row'(z - origin) = ahead. The step is chosen by the angle between tangents.
 *
 * Where motions are unique the section is p = constant, the guess an extrapolation of the last motions, and no derivative by p
 * is needed.
 *
 * The curve is smooth as long as the sequence of events is the same. Where that changes the tangent may jump. If it jumps by so
 * much that no section ahead meets the curve, the search begins anew from the change, along the tangent of the map of the new
 * sequence.
 *
 * Between two motions with the same sequence a special point is a zero of a test function: of dp along the curve at folds, of the
 * modulus of a multiplier less 1 at others. A change of the sequence is bisected. */
#include "curve.h"
#include "common/layout.h"
#include "common/real.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A step of p is as long as this part of the size of the motion; the longest step along the curve, likewise. */
#define SHARE 0.1
#define REACH 0.2

/* Angle between tangents for which steps keep their length; largest one, of a cosine; change of the length, at most. */
#define TURN 0.15
#define COSINE 0.7
#define LONGER 1.6
#define SHORTER 0.4

/* Distance of a motion from its guess, over the step, at most; likewise over the size, for which steps keep their length where
 * motions are unique. */
#define ASTRAY 0.5
#define EXPECTED 0.02

/* Lengths over the size: shortest step; interval of a fold, and of other special points. */
#define LEAST 1e-10
#define FOLDED 1e-8
#define LOCATED 1e-10

/* Length of pieces up to where they meet, over the width of the bracket. PARALLEL: square of the angle of pieces that do not
 * meet. */
#define JOINED 10.0
#define PARALLEL 1e-8

/* Length of the last piece of a curve, over that of LOCATED, below which the curve ends. */
#define PROGRESS 10.0

/* First and last distance over the size at which the curve is looked for beyond a change of the sequence of events, and their
 * ratio. */
#define BEYOND_FIRST 1e-7
#define BEYOND_LAST 1e-2
#define BEYOND_RATIO 10.0

/* Distance from a bound of p, over the largest step of p, at which the curve ends there. */
#define AT_BOUND 1e-9

/* Size of a cycle, over that of the motion, from which p is extrapolated to a state of rest. */
#define SWING 1e-2

/* |multiplier| - 1 of motions that are not stable. Modulus of an imaginary part of a complex multiplier. */
#define OUTSIDE 1e-6
#define COMPLEX 1e-6

/* BARRED: number of shortened steps in a row, after which the end of the piece is looked for. MOST_TESTS: motions to locate a
 * point. MOST_POINTS: of a curve, as one that closes upon itself. */
enum { BARRED = 3, MOST_TESTS = 100, MOST_POINTS = 10000 };

/* -------------------------------------------------------------------------------------------------------------- motions */

static double parameter_of(const struct track *c, const struct knot *k)
{
    return k->z[c->n + c->count - 1];
}

static double size_of(const struct track *c, const struct knot *k)
{
    return greater(tribo_energy_length(k->z, c->n), c->s->map.least);
}

static double period_of(const struct track *c, const struct knot *k)
{
    return c->base.count ? k->z[c->n] : c->period;
}

/* Returns the change of the sequence of events from a to b; TRIBO_POINT_FOLD: the curve turns back between them. *contact as by
 * tribo_word_change. */
static int change_between(const struct track *c, const struct knot *a, const struct knot *b, size_t *contact)
{
    const size_t last = c->n + c->count - 1;
    const int kind = tribo_word_change(&a->word, &b->word, c->like->ncontact, contact);
    return a->tangent[last] * b->tangent[last] < 0.0 ? TRIBO_POINT_FOLD : kind;
}

/* Divides the tangent v by its length, unless that is 0. */
static void make_unit(const struct track *c, double *v)
{
    const size_t all = c->n + c->count;
    const double length = tribo_energy_length(v, all);
    for (size_t i = 0; length > 0.0 && i < all; i++) {
        v[i] /= length;
    }
}

/* Sets the units for a step from k; its tangent keeps its direction. */
static void choose_units(struct track *c, struct knot *k)
{
    const double size = size_of(c, k), before[] = {c->unit[0], c->unit[1], c->unit[2]};
    for (size_t i = 0; i < c->count; i++) {
        c->unit[i] = i + 1 == c->count ? fabs(c->ask->step) / (SHARE * size)
                     : i == 0          ? period_of(c, k) / size
                                       : 1.0 / (period_of(c, k) * size);
        k->tangent[c->n + i] *= before[i] / c->unit[i];
    }
    make_unit(c, k->tangent);
}

/* to [n + count] = z of k, and `length` times the tangent, [n + count] over units. */
static void go_along(const struct track *c, const struct knot *k, const double *tangent, double length, double *to)
{
    for (size_t i = 0; i < c->n + c->count; i++) {
        to[i] = k->z[i] + length * tangent[i] * (i < c->n ? 1.0 : c->unit[i - c->n]);
    }
}

/* |a - b|, over units. */
static double apart(const struct track *c, const double *a, const double *b)
{
    double square = 0.0;
    for (size_t i = 0; i < c->n + c->count; i++) {
        const double d = (a[i] - b[i]) / (i < c->n ? 1.0 : c->unit[i - c->n]);
        square += d * d;
    }
    return sqrt(square);
}

/* Returns the section ahead of a in which b lies. */
static double length_ahead(const struct track *c, const struct knot *a, const struct knot *b)
{
    double length = 0.0;
    for (size_t i = 0; i < c->n + c->count; i++) {
        length += a->tangent[i] * (b->z[i] - a->z[i]) / (i < c->n ? 1.0 : c->unit[i - c->n]);
    }
    return length;
}

/* Returns the length from a, forth or back along its tangent, to where the tangent of b meets it: of almost equal tangents the
 * distance. */
static double length_to_kink(const struct track *c, const struct knot *a, const struct knot *b)
{
    const double both = tribo_dot(a->tangent, b->tangent, c->n + c->count), square = 1.0 - both * both;
    return square > PARALLEL ? fabs(length_ahead(c, a, b) + both * length_ahead(c, b, a)) / square : apart(c, a->z, b->z);
}

/* Sets c->s->here from z, and the border of the section. */
static void place(struct track *c, const double *z)
{
    struct shooting *s = c->s;
    memcpy(s->here->x, z, c->n * sizeof *z);
    s->extra = tribo_curve_border;
    memcpy(s->extra.unit, c->unit, sizeof c->unit);
    for (size_t i = 0; i < c->count; i++) {
        s->here->unknown[i] = z[c->n + i] / c->unit[i];
    }
    s->extra.first = c->base.count ? z[c->n] : c->period;
    s->extra.count = c->unique ? 0 : c->count;
}

/* Sets k->re, im without the multipliers of the family, trivial and outside. */
static int find_multipliers(struct track *c, struct knot *k)
{
    struct shooting *s = c->s;
    const size_t n = c->n;
    const int cycle = c->ask->motion == TRIBO_MOTION_CYCLE, rests = tribo_derivative_rests(&s->here->derivative);
    k->outside = c->unique ? 0 : -1;
    s->flow = s->here;
    int status = cycle ? TRIBO_OK : tribo_shooting_find_flow(s);
    if (status || c->unique || c->ask->motion == TRIBO_MOTION_MODE || s->flow->derivative.torn < s->map.sys->ncontact) {
        return status;
    }
    k->trivial = 0;
    status = tribo_shooting_multipliers(s, k->re, k->im);
    status = status || !(cycle || rests) ? status : tribo_shooting_freedom(s, &k->trivial);
    k->trivial = cycle && !k->trivial ? 1 : k->trivial;
    for (size_t j = 0; !status && j < k->trivial; j++) {
        size_t nearest = 0;
        for (size_t i = 1; i + j < n; i++) {
            nearest = hypot(k->re[i] - 1.0, k->im[i]) < hypot(k->re[nearest] - 1.0, k->im[nearest]) ? i : nearest;
        }
        memmove(k->re + nearest, k->re + nearest + 1, (n - 1 - nearest) * sizeof *k->re);
        memmove(k->im + nearest, k->im + nearest + 1, (n - 1 - nearest) * sizeof *k->im);
        k->re[n - 1] = k->im[n - 1] = 0.0;
    }
    k->outside = 0;
    for (size_t i = 0; i < n; i++) {
        k->outside += hypot(k->re[i], k->im[i]) > 1.0 + OUTSIDE;
    }
    return status;
}

/* Sets k from the motion c->s->here. Returns a status. */
static int read_knot(struct track *c, struct knot *k, double parameter)
{
    struct shooting *s = c->s;
    const size_t n = c->n, all = n + c->count;
    int status = TRIBO_OK;
    memcpy(k->z, s->here->x, n * sizeof *k->z);
    for (size_t i = 0; i < c->count; i++) {
        k->z[n + i] = s->here->unknown[i] * c->unit[i];
    }
    memcpy(k->rate, s->here->border, n * sizeof *k->rate);
    if (c->unique) {
        k->z[n] = parameter;
        memset(k->tangent, 0, all * sizeof *k->tangent);
        k->tangent[n] = c->ask->step > 0.0 ? 1.0 : -1.0;
    } else {
        status = tribo_shooting_tangent(s, k->tangent);
        make_unit(c, k->tangent);
    }
    if (!status && !tribo_word_read(&k->word, s->here, c->width)) {
        status = tribo_error(s->map.drv->message, TRIBO_ERR_MEMORY, "out of memory for a sequence of events");
    }
    return status ? status : find_multipliers(c, k);
}

/* Shoots from the guess z [n + count]. *found = 1: to k. Returns a status: not that of a search that fails. */
static int correct(struct track *c, const double *z, struct knot *k, int *found)
{
    struct shooting *s = c->s;
    const double parameter = z[c->n + c->count - 1];
    place(c, z);
    *found = 0;
    int status = c->unique ? tribo_curve_set(c, parameter) : TRIBO_OK;
    status = status ? status : tribo_shooting_search(s);
    if (!status && !c->unique && tribo_point_is_closed(s->here, TRIBO_PERIODIC)) { /* unique motions are as odd as the drives */
        status = tribo_period_map_complete(&s->map, s->here);
    }
    *found = !status && tribo_point_is_closed(s->here, TRIBO_PERIODIC);
    if (c->unique && !*found && status != TRIBO_ERR_MEMORY) { /* the whole search */
        memcpy(c->w->y, s->here->y, c->n * sizeof *c->w->y);
        c->w->y[c->n] = 0.0;
        c->w->t = s->map.t;
        c->w->period = s->map.period;
        c->halves += s->map.halves - c->counted;
        status = tribo_shooting_find(s, c->w);
        c->counted = s->map.halves;
        *found = !status;
    }
    if (*found) {
        status = read_knot(c, k, parameter);
        *found = !status;
    }
    return status == TRIBO_ERR_MEMORY || status == TRIBO_ERR_UNSUPPORTED ? status : TRIBO_OK;
}

/* Makes k the motion c->s->here again. Returns a status. */
static int restore(struct track *c, const struct knot *k)
{
    place(c, k->z);
    int status = c->unique ? tribo_curve_set(c, parameter_of(c, k)) : TRIBO_OK;
    status = status ? status : tribo_shooting_follow(c->s, c->s->here);
    c->s->flow = c->s->here;
    return status || c->ask->motion == TRIBO_MOTION_CYCLE ? status : tribo_shooting_find_flow(c->s);
}

/* Shows the motion k, c->s->here, to the observer. Returns a status. */
static int show(struct track *c, const struct knot *k, int kind, size_t contact)
{
    struct shooting *s = c->s;
    tribo_driver *drv = c->owner->map.drv;
    const size_t count = s->extra.count;
    tribo_shooting_keep(s, c->w);
    c->owner->found = 1;
    c->owner->told = s;
    c->owner->revision = tribo_system_revision(drv->sys);
    int stable = k->outside < 0 ? -1 : k->outside == 0;
    if (stable >= 0 && !c->unique) { /* multipliers show no stability if the force of an elastic contact only touches its limit */
        const int status = tribo_shooting_check_touches(s, "stability");
        if (status && status != TRIBO_ERR_UNSUPPORTED) {
            return status;
        }
        stable = status == TRIBO_ERR_UNSUPPORTED ? -1 : stable;
    }
    if (drv->motion) {
        tribo_system_write_state(s->map.sys, s->map.t, c->w->y, c->shown);
    } else {
        memcpy(c->shown, c->w->y, (c->n + 1) * sizeof *c->shown);
    }
    const int normal = contact != SIZE_MAX && contact >= drv->sys->ncontact;
    const tribo_curve_point point = {.size = sizeof point,
                                     .parameter = parameter_of(c, k),
                                     .t = s->map.t,
                                     .period = s->map.period,
                                     .zeta = c->base.count > 1 ? k->z[c->n + 1] * s->map.period / FULL_TURN : 0.0,
                                     .y = c->shown,
                                     .kind = kind,
                                     .contact = normal ? drv->sys->normals.normal[contact - drv->sys->ncontact].row : contact,
                                     .stable = stable};
    c->points++;
    s->extra.count = c->base.count;
    const int answer = c->seen ? c->seen(&point, c->data) : 0;
    s->extra.count = count;
    return answer ? tribo_error(s->map.drv->message, TRIBO_ERR_STOPPED, "the observer answered %d at parameter = %.17g", answer,
                                point.parameter)
                  : TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------ special points */

/* A special point between lo and hi, in sections `low` and `high` ahead of c->origin. */
struct bracket {
    struct knot *lo, *hi, *mid;
    double low, high;
    size_t which;             /* multiplier, or BY_... */
    const struct knot *first; /* for BY_RATE */
};

/* Tests: dp along the curve; -1 if the sequence of events is that of lo, else 1; rate'(rate of the first motion). */
#define BY_PARAMETER SIZE_MAX
#define BY_WORD (SIZE_MAX - 1)
#define BY_RATE (SIZE_MAX - 2)

static double test_of(const struct track *c, const struct bracket *b, const struct knot *k)
{
    return b->which == BY_PARAMETER ? k->tangent[c->n + c->count - 1]
           : b->which == BY_RATE    ? tribo_dot(b->first->rate, k->rate, c->n)
           : b->which == BY_WORD    ? (tribo_word_equal(&b->lo->word, &k->word) ? -1.0 : 1.0)
                                    : hypot(k->re[b->which], k->im[b->which]) - 1.0;
}

/* to = from. Returns a status. */
static int copy_knot(const struct track *c, struct knot *to, const struct knot *from)
{
    memcpy(to->z, from->z, c->values * sizeof *to->z);
    to->trivial = from->trivial;
    to->outside = from->outside;
    int done = 1;
    tribo_word_free(&to->word);
    to->word = from->word;
    to->word.letter = tribo_copy_of(from->word.letter, from->word.letters * c->width, 1, &done);
    to->word.letters = done ? from->word.letters : 0;
    return done ? TRIBO_OK : tribo_error(c->s->map.drv->message, TRIBO_ERR_MEMORY, "out of memory for a sequence of events");
}

/* Locates the zero of the test `which` between from and to, in sections low and high, to `width`, in the knots of spare [3].
 * b->lo, b->hi: the ends. Returns a status. */
static int locate(struct track *c, const struct knot *from, const struct knot *to, double low, double high, size_t which,
                  double width, struct knot *spare, struct bracket *b)
{
    const size_t all = c->n + c->count;
    *b = (struct bracket){spare, spare + 1, spare + 2, low, high, which, from};
    int side = 0, found = 1, status = copy_knot(c, b->lo, from);
    status = status ? status : copy_knot(c, b->hi, to);
    double at_low = test_of(c, b, from), at_high = test_of(c, b, to);
    for (int k = 0; !status && found && b->high - b->low > width && k < MOST_TESTS; k++) {
        double *const z = b->mid->tangent, span = b->high - b->low;
        double part = which == BY_WORD || k % 3 == 2 ? 0.5 : at_low / (at_low - at_high);
        part = clamp(part, 0.25 * width / span, 1.0 - 0.25 * width / span);
        found = 0;
        c->ahead = b->low + part * span;
        for (int trial = 0; !status && !found && trial < 3; trial++) {
            const struct knot *const end = trial == 1 ? b->lo : b->hi;
            const double along = tribo_dot(c->row, end->tangent, all);
            go_along(c, end, end->tangent, (c->ahead - (trial == 1 ? b->low : b->high)) / along, z);
            for (size_t i = 0; !trial && i < all; i++) {
                z[i] = b->lo->z[i] + part * (b->hi->z[i] - b->lo->z[i]);
            }
            status = correct(c, z, b->mid, &found);
        }
        const double at = found && !status ? test_of(c, b, b->mid) : 0.0;
        const int lower = at_low < 0.0 ? at < 0.0 : at > 0.0;
        struct knot **const end = lower ? &b->lo : &b->hi, *const left = *end;
        if (found && !status) {
            *(lower ? &b->low : &b->high) = c->ahead;
            *(lower ? &at_low : &at_high) = at;
            *(lower ? &at_high : &at_low) *= side == 1 + lower ? 0.5 : 1.0; /* Illinois */
            side = 1 + lower;
            *end = b->mid;
            b->mid = left;
        }
    }
    return status || found ? status
                           : tribo_error(c->s->map.drv->message, TRIBO_ERR_NO_CONVERGENCE,
                                         "a special point of the curve between %.17g and %.17g was not located",
                                         parameter_of(c, b->lo), parameter_of(c, b->hi));
}

/* Shows the special points between from and to, which have the same sequence of events. Returns a status. */
static int show_smooth(struct track *c, const struct knot *from, const struct knot *to, double low, double high)
{
    const size_t last = c->n + c->count - 1;
    const double size = size_of(c, from);
    const int turns = from->tangent[last] * to->tangent[last] < 0.0, known = from->outside >= 0 && to->outside >= 0;
    const int more = to->outside - from->outside;
    struct bracket b;
    int status = TRIBO_OK;
    if (turns) {
        status = locate(c, from, to, low, high, BY_PARAMETER, FOLDED * size, c->knot + 6, &b);
        status = status ? status : restore(c, b.lo);
        status = status ? status : show(c, b.lo, TRIBO_POINT_FOLD, SIZE_MAX);
    }
    if (!status && known && from->trivial == to->trivial && more != 0 && !(turns && abs(more) == 1)) {
        const size_t which = (size_t)(more > 0 ? to->outside : from->outside) - 1;
        status = locate(c, from, to, low, high, which, LOCATED * size, c->knot + 6, &b);
        if (!status) {
            const int kind = fabs(b.lo->im[which]) > COMPLEX ? TRIBO_POINT_TORUS
                             : b.lo->re[which] < 0.0         ? TRIBO_POINT_FLIP
                                                             : TRIBO_POINT_BRANCH;
            status = restore(c, b.lo);
            status = status ? status : show(c, b.lo, kind, SIZE_MAX);
        }
    }
    return status;
}

/* Shows the special points between from and to, of sections 0 and high; to is c->s->here, also at the end. Where a section meets
 * another piece of the curve, which does not join that of from, *to becomes the last motion before, *joined = 0. Returns a
 * status. */
static int show_specials(struct track *c, const struct knot *from, struct knot *to, double high, int *joined)
{
    const size_t points = c->points, last = c->n + c->count - 1;
    struct knot *const at = c->knot + 2;
    double low = 0.0;
    int status = copy_knot(c, at, from);
    *joined = 1;
    while (!status && !tribo_word_equal(&at->word, &to->word) &&
           !(c->ask->coarse && at->tangent[last] * to->tangent[last] > 0.0)) {
        struct bracket b;
        status = locate(c, at, to, low, high, BY_WORD, LOCATED * size_of(c, at), c->knot + 3, &b);
        const double off = greater(length_to_kink(c, b.lo, b.hi), length_to_kink(c, b.hi, b.lo));
        if (!status && !c->unique && off > JOINED * LOCATED * size_of(c, at)) {
            *joined = 0;
            status = copy_knot(c, to, b.lo);
            high = b.low;
            break;
        }
        status = status ? status : show_smooth(c, at, b.lo, low, b.low);
        size_t contact;
        const int kind = change_between(c, b.lo, b.hi, &contact);
        status = status ? status : restore(c, b.lo);
        status = status ? status : show(c, b.lo, kind, contact);
        low = b.high;
        status = status ? status : copy_knot(c, at, b.hi);
    }
    status = status ? status : show_smooth(c, at, to, low, high);
    return status || (c->points == points && *joined) ? status : restore(c, to);
}

/* -------------------------------------------------------------------------------------------------------------- steps */

/* Shoots to b in the section `length` ahead of a, from a guess along the tangent, or, where motions are unique, on the polynomial
 * in p through the last motions. *found = 1 if b is near enough to the guess, and the curve does not turn by too much. *way =
 * distance from the guess. Returns a status. */
static int try_ahead(struct track *c, struct knot *a, double length, struct knot *b, int *found, double *way)
{
    const size_t n = c->n, known = c->unique && c->known > 1 ? c->known : 0;
    const struct knot *const past[] = {a, c->knot + 11, c->knot + 12};
    double *const z = c->guess;
    c->origin = a->z;
    c->row = a->tangent;
    c->ahead = length;
    go_along(c, a, a->tangent, length, z);
    memset(z, 0, known ? n * sizeof *z : 0);
    for (size_t j = 0; j < known; j++) {
        double weight = 1.0;
        for (size_t l = 0; l < known; l++) {
            weight *= l == j ? 1.0 : (z[n] - past[l]->z[n]) / (past[j]->z[n] - past[l]->z[n]);
        }
        tribo_add(z, weight, past[j]->z, n);
    }
    const int status = correct(c, z, b, found);
    if (*found && !c->unique) {
        const double turn = tribo_dot(a->tangent, b->tangent, n + c->count);
        *way = apart(c, z, b->z);
        *found = *way <= ASTRAY * length && (turn >= COSINE || !tribo_word_equal(&a->word, &b->word));
    } else if (*found) {
        *way = tribo_energy_distance(z, b->z, n);
    }
    return status;
}

/* Bisects the lengths ahead of a to the last one at which the curve is found with the same sequence of events, between 0 and
 * `high`; *at = that motion, *low its length. Returns a status. */
static int find_barrier(struct track *c, struct knot *a, double high, struct knot **at, double *low)
{
    struct knot *spare = c->knot + 10;
    const double width = LOCATED * size_of(c, a);
    int found, status = copy_knot(c, *at = c->knot + 9, a);
    *low = 0.0;
    while (!status && high - *low > width) {
        const double middle = 0.5 * (*low + high);
        go_along(c, *at, (*at)->tangent, (middle - *low) / tribo_dot(a->tangent, (*at)->tangent, c->n + c->count), c->guess);
        c->origin = a->z;
        c->row = a->tangent;
        c->ahead = middle;
        status = correct(c, c->guess, spare, &found);
        found = found && tribo_word_equal(&a->word, &spare->word);
        *(found ? low : &high) = middle;
        if (found) {
            struct knot *const left = *at;
            *at = spare;
            spare = left;
        }
    }
    return status;
}

/* Looks for the curve beyond the motion a, at a change of the sequence of events: b, *found = 1. Returns a status. */
static int find_beyond(struct track *c, struct knot *a, struct knot *b, int *found)
{
    const size_t all = c->n + c->count;
    const double size = size_of(c, a);
    double *const row = c->beyond, *const z = c->guess;
    int status = TRIBO_OK;
    *found = 0;
    for (double length = BEYOND_FIRST * size; !status && !*found && length < BEYOND_LAST * size; length *= BEYOND_RATIO) {
        c->origin = a->z;
        c->row = a->tangent;
        c->ahead = length;
        go_along(c, a, a->tangent, length, z);
        place(c, z);
        status = tribo_shooting_follow(c->s, c->s->here);
        status = status == TRIBO_ERR_MEMORY ? status : TRIBO_OK;
        if (status || !isfinite(c->s->here->size) || !tribo_word_read(&b->word, c->s->here, c->width) ||
            tribo_word_equal(&a->word, &b->word)) {
            continue;
        }
        status = tribo_shooting_tangent(c->s, row);
        make_unit(c, row);
        for (int side = 0; !status && !*found && side < 2; side++) {
            for (size_t i = 0; i < all; i++) {
                row[i] = side ? -row[i] : row[i];
            }
            go_along(c, a, row, length, z);
            c->row = row;
            status = correct(c, z, b, found);
            *found = *found && apart(c, z, b->z) <= ASTRAY * length && length_to_kink(c, a, b) <= JOINED * LOCATED * size &&
                     !tribo_word_equal(&a->word, &b->word);
        }
    }
    return status;
}

/* Passes the end of a piece of the curve between a and the section `high` ahead of it, to b. Returns a status. */
static int pass_barrier(struct track *c, struct knot *a, double high, struct knot *b)
{
    struct knot *at;
    double low;
    int kind = TRIBO_POINT_REGULAR, found = 0, joined, status = find_barrier(c, a, high, &at, &low);
    size_t contact = SIZE_MAX;
    status = status ? status : find_beyond(c, at, b, &found);
    if (!status && found) {
        kind = change_between(c, at, b, &contact);
    }
    c->origin = a->z;
    c->row = a->tangent;
    const int kept = status ? status : restore(c, at);
    status = kept ? kept : show_specials(c, a, at, low, &joined);
    status = status ? status : show(c, at, kind, contact);
    if (!status && !found && low > PROGRESS * LOCATED * size_of(c, a)) { /* a length that is too short to find the change */
        return copy_knot(c, b, at);
    }
    if (!status && !found) {
        status =
            tribo_error(c->s->map.drv->message, TRIBO_ERR_NO_CONVERGENCE,
                        "the curve ends at parameter = %.17g: motions nearby, beyond it, do not join it", parameter_of(c, at));
    }
    status = status ? status : restore(c, b);
    return status ? status : show(c, b, TRIBO_POINT_REGULAR, SIZE_MAX);
}

/* Shoots to b at the bound of the range that the step from a to b reaches. Returns a status. */
static int end_at_bound(struct track *c, const struct knot *a, struct knot *b)
{
    const size_t n = c->n, last = n + c->count - 1;
    const double bound = b->z[last] > a->z[last] ? c->ask->most : c->ask->least;
    const double part = (bound - a->z[last]) / (b->z[last] - a->z[last]);
    double *const row = c->beyond, *const z = c->guess;
    int found;
    for (size_t i = 0; i <= last; i++) {
        z[i] = a->z[i] + part * (b->z[i] - a->z[i]);
        row[i] = 0.0;
    }
    z[last] = bound;
    row[last] = 1.0;
    c->origin = z;
    c->row = row;
    c->ahead = 0.0;
    const int status = correct(c, z, b, &found);
    if (!status && found && tribo_dot(a->tangent, b->tangent, last + 1) < 0.0) {
        for (size_t i = 0; i <= last; i++) {
            b->tangent[i] = -b->tangent[i];
        }
    }
    c->origin = a->z;
    c->row = a->tangent;
    return status || found ? status
                           : tribo_error(c->s->map.drv->message, TRIBO_ERR_NO_CONVERGENCE,
                                         "the curve was not found at the end of the range, at parameter = %.17g", bound);
}

/* Where the cycle shrinks to a state of rest between a and b, `high` ahead, b becomes that, *rests = 1. Returns a status. */
static int end_at_rest(struct track *c, const struct knot *a, struct knot *b, double high, int *rests)
{
    struct bracket rest;
    *rests = c->ask->motion == TRIBO_MOTION_CYCLE && tribo_dot(a->rate, b->rate, c->n) < 0.0;
    if (!*rests) {
        return TRIBO_OK;
    }
    struct knot *const near = c->knot + 9, *const nearer = c->knot + 10;
    double *const z = c->guess;
    int found = 1, status = locate(c, a, b, 0.0, high, BY_RATE, FOLDED * size_of(c, a), c->knot + 6, &rest);
    for (int k = 0; !status && found && k < 2; k++) {
        const double back = SWING * size_of(c, a) / (k + 1.0);
        for (size_t i = 0; i < c->n + c->count; i++) {
            z[i] = rest.lo->z[i] + (a->z[i] - rest.lo->z[i]) * (back / rest.low);
        }
        c->ahead = rest.low - back;
        status = correct(c, z, k ? nearer : near, &found);
    }
    status = status ? status : copy_knot(c, b, rest.lo);
    status = status ? status : restore(c, b);
    /* p goes with the square of the size of the cycle */
    const double small = tribo_dot(nearer->rate, nearer->rate, c->n), large = tribo_dot(near->rate, near->rate, c->n);
    if (found && small < large) {
        const double slope = (parameter_of(c, near) - parameter_of(c, nearer)) / (large - small);
        b->z[c->n + c->count - 1] = parameter_of(c, nearer) - small * slope;
    }
    return status;
}

/* Takes a step of about *length from the motion *a, shown, to one that is shown. *ends = 1: at a bound. Returns a status. */
static int step_ahead(struct track *c, struct knot **a, struct knot **b, double *length, size_t *barred, int *ends)
{
    const size_t last = c->n + c->count - 1;
    const double size = size_of(c, *a);
    double tried = 0.0, way = 0.0;
    int found = 0, status = TRIBO_OK;
    choose_units(c, *a);
    const double longest = lesser(REACH * size, SHARE * size / fabs((*a)->tangent[last]));
    *length = lesser(*length, longest);
    for (int k = 0; !status && !found && (k == 0 || *length > LEAST * size); k++) {
        *length *= k ? 0.5 : 1.0;
        tried = *length * (k ? 2.0 : 1.0);
        status = try_ahead(c, *a, *length, *b, &found, &way);
        *barred += k == 1;
        *barred = k == 0 && found && *barred <= BARRED ? 0 : *barred;
    }
    if (status) {
        return status;
    }
    if (!found && c->unique) {
        return tribo_shooting_fails(c->s, c->s->nearest);
    }
    if (!found || (*barred > BARRED && !c->unique)) {
        tried = found ? lesser(2.0 * *length, longest) : tried;
        *barred = 0;
        status = pass_barrier(c, *a, tried, *b);
        *length = BEYOND_LAST * size;
    } else {
        const double p = (*b)->z[last], near = AT_BOUND * fabs(c->ask->step);
        *ends = (p > (*a)->z[last] && p >= c->ask->most - near) || (p < (*a)->z[last] && p <= c->ask->least + near);
        status = *ends ? end_at_bound(c, *a, *b) : TRIBO_OK;
        int rests = 0, joined = 1;
        status = status ? status : end_at_rest(c, *a, *b, *length, &rests);
        status = status ? status : show_specials(c, *a, *b, length_ahead(c, *a, *b), &joined);
        *ends = (*ends || rests) && joined;
        *barred = joined ? *barred : BARRED + 1;
        status = status ? status : show(c, *b, rests && joined ? TRIBO_POINT_REST : TRIBO_POINT_REGULAR, SIZE_MAX);
        const double turn = acos(clamp(tribo_dot((*a)->tangent, (*b)->tangent, last + 1), -1.0, 1.0));
        const double factor = c->unique ? sqrt(EXPECTED * size / way) : TURN / turn;
        *length *= tried > *length ? 1.0 : clamp(factor, SHORTER, LONGER);
    }
    if (c->unique && !status) {
        status = copy_knot(c, c->knot + 12, c->knot + 11);
        status = status ? status : copy_knot(c, c->knot + 11, *a);
        c->known = c->known < 3 ? c->known + 1 : 3;
    }
    struct knot *const left = *a;
    *a = *b;
    *b = left;
    return status;
}

/* Follows the curve from the motion c->s->here. Returns a status. */
static int follow(struct track *c)
{
    struct shooting *s = c->s;
    const size_t n = c->n, last = n + c->count - 1;
    struct knot *a = c->knot, *b = c->knot + 1;
    size_t barred = 0;
    int found, ends = 0, status = TRIBO_OK;
    if (c->ask->motion == TRIBO_MOTION_CYCLE) { /* to the middle of the longest phase, far from events */
        status = tribo_period_map_march(&s->map, tribo_derivative_middle(&s->here->derivative), 1, NULL, s->here->x);
    }
    memcpy(a->z, s->here->x, n * sizeof *a->z);
    a->z[n] = s->map.period;
    a->z[n + 1] = c->base.count > 1 ? s->here->unknown[1] * s->extra.unit[1] : 0.0;
    a->z[last] = tribo_curve_first(c);
    choose_units(c, a);
    memset(c->beyond, 0, (last + 1) * sizeof *c->beyond);
    c->beyond[last] = c->ask->step > 0.0 ? 1.0 : -1.0;
    memcpy(c->guess, a->z, (last + 1) * sizeof *a->z);
    c->origin = c->guess;
    c->row = c->beyond;
    c->ahead = 0.0;
    c->known = 1;
    status = status ? status : correct(c, c->guess, a, &found);
    if (!status && !found) {
        status = tribo_shooting_fails(s, s->nearest);
    }
    double length = SHARE * size_of(c, a);
    status = status ? status : show(c, a, TRIBO_POINT_REGULAR, SIZE_MAX);
    const size_t most = c->ask->points ? c->ask->points : MOST_POINTS;
    while (!status && !ends && c->points < most) {
        status = step_ahead(c, &a, &b, &length, &barred, &ends);
    }
    return status;
}

/* Allocates the arrays of c. Returns a status, its message on the driver of owner. */
static int allocate(struct track *c)
{
    const tribo_system *sys = c->owner->map.sys;
    const size_t n = c->n, all = n + TRIBO_UNKNOWNS, dimension = tribo_system_dimension(sys), multipliers = dimension + n;
    struct knot *const k = c->knot;
    c->values = 3 * all + 2 * multipliers;
    if (!ALLOCATE(ARRAY(k->z, TRIBO_KNOTS * c->values), ARRAY(c->guess, all), ARRAY(c->beyond, all), ARRAY(c->shown, dimension),
                  ARRAY(c->limit, sys->ncontact), ARRAY(c->put, sys->ncontact))) {
        return tribo_error(c->owner->map.drv->message, TRIBO_ERR_MEMORY, "out of memory for a curve");
    }
    for (size_t i = 0; i < TRIBO_KNOTS; i++) {
        k[i].z = k->z + i * c->values;
        k[i].rate = k[i].z + all;
        k[i].tangent = k[i].rate + all;
        k[i].re = k[i].tangent + all;
        k[i].im = k[i].re + multipliers;
    }
    return TRIBO_OK;
}

int tribo_shooting_follow_curve(struct shooting *s, struct wanted *w)
{
    struct track *c = w->curve;
    tribo_driver *drv = s->map.drv;
    c->owner = s;
    c->w = w;
    c->like = drv->sys;
    c->n = s->map.n;
    c->width = drv->sys->ncontact + drv->sys->normals.count;
    int status = allocate(c);
    if (status) {
        return status;
    }
    memcpy(c->limit, drv->sys->loads.given_limit, drv->sys->ncontact * sizeof *c->limit);
    c->t = w->t;
    const double first = tribo_curve_first(c);
    if (!(first >= c->ask->least && first <= c->ask->most)) {
        return tribo_error(drv->message, TRIBO_ERR_RANGE, "the parameter of the system, %g, is outside of [%g, %g]", first,
                           c->ask->least, c->ask->most);
    }
    status = tribo_curve_begin(c);
    if (!status) {
        struct shooting *t = c->s;
        c->counted = t->map.halves;
        c->period = w->period;
        c->count = c->base.count + 1;
        c->unique = c->ask->motion == TRIBO_MOTION_PERIODIC && tribo_system_is_plain(drv->sys) && !drv->sys->normals.count &&
                    drv->sys->circulation == 0.0;
        for (size_t k = 0; k < t->map.norm.n; k++) {
            c->unique &= t->map.norm.damping[k] >= 0.0;
        }
        t->curve = c;
        t->mode = c->ask->motion == TRIBO_MOTION_MODE ? &c->mode : NULL;
        status = follow(c);
        t->curve = NULL;
        t->mode = NULL;
        t->extra.count = c->base.count;
        if (status) {
            tribo_error(drv->message, status, "%s", tribo_driver_message(t->map.drv));
        }
        s->found = s->found && (!status || status == TRIBO_ERR_STOPPED); /* else s->here need not be the last point */
        drv->periods += t->map.drv->periods + (c->halves + t->map.halves - c->counted + 1) / 2;
        drv->newton += t->map.drv->newton;
    }
    for (size_t i = 0; i < TRIBO_KNOTS; i++) {
        tribo_word_free(&c->knot[i].word);
    }
    w->period = c->points ? c->s->map.period : w->period;
    return status;
}
