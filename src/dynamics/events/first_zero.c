/* Intervals [a, b] are walked through from left to right. Where all guards are positive at both ends, their quintics and the
 * bounds of what these leave out tell whether they are so between; where they do not tell, or a guard is not positive at b,
 * the interval becomes shorter: up to where the quintics have their first zero, or by a part. Then only those guards are
 * looked at of which the longer interval does not tell that they are positive. Where intervals end is a guess: when a zero
 * came last time, or what derivatives at a see ahead; what is certain comes from the bounds. Close to a zero derivatives tell
 * where it is. */
#include "first_zero.h"
#include "common/real.h"
#include "parabola.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* So many looks at a motion between two events, or a first step of zero, mean that it has frequencies which cannot be followed.
 */
#define MOST_LOOKS ((size_t)1 << 24)

/* Where bounds that hold so long leave intervals of which that many are not this part of it, it need not be tried. */
#define HOPELESS 1e-6

/* The third derivative of a sum of exponentials and sines is at most the root of its size times its bend (Cauchy, Schwarz),
 * that of powers of time at most 4.5 times this and 60 size/longest^3. So over this part of a first length it changes what two
 * derivatives tell by a tenth of noise. */
#define SHORT 1.9e-6

/* Over this part of a first length, what five derivatives tell is changed by a tenth of noise by the bound of the sixth. */
#define FAR 2.2e-3

/* So far ahead, in terms of an interval, do five derivatives tell as much as all samples at the ends of it tell in its
 * middle. */
#define AHEAD 0.5

/* Within this part of an interval two derivatives foresee a zero to a thousandth: from just before it, it is in their reach. */
#define SOON 0.1

/* A zero of a quintic which differs there from the guard by no more than this part of its noise is that of the guard. */
#define FINE 0.1

/* After an interval of which not all is known, this part of it is tried. */
#define SHRINK 0.7

/* An interval may be longer by this factor if it ends where a zero is expected. */
#define STRETCH 1.5

/* A guard that begins at zero may stray from there by this part of its size. */
#define ALLOWED 1e-14

/* Values of a guard that are rounding. */
static double noise(const struct guard *g)
{
    return 4.0 * DBL_EPSILON * g->size;
}

/* x^(1/6) within 7%: of the bits of a number, read as a whole number, logarithms are nearly linear. */
static double sixth_root(double x)
{
    const uint64_t one = (uint64_t)1023 << 52;
    const double normal = greater(x, DBL_MIN);
    uint64_t bits;
    double root;
    memcpy(&bits, &normal, sizeof bits);
    bits = bits / 6 + one / 6 * 5;
    memcpy(&root, &bits, sizeof root);
    return x > 0.0 && x <= DBL_MAX ? root : x;
}

static void watch_all(struct first_zero *s)
{
    s->watching = s->asked;
}

static void exchange(struct guard **watched, size_t i, size_t k)
{
    struct guard *g = watched[i];
    watched[i] = watched[k];
    watched[k] = g;
}

/* Middle samples of those watched, and whether one of them is not above zero there. */
static void sample(struct first_zero *s, double tau)
{
    double all = 0.0;
    s->falls = 0;
    s->motion->look(s->own, tau, s->watching, s->watched);
    for (size_t k = 0; k < s->watching; k++) {
        struct guard *g = s->watched[k];
        struct sample *m = &g->middle;
        all += 0.0 * (m->g + m->d + m->e);
        m->g += g->allowance;
        s->falls |= !(m->g > noise(g));
    }
    s->looks++;
    s->lost |= all != 0.0 || s->looks >= MOST_LOOKS;
}

/* Whether a lower bound is enough; if so, notes how low the guard may be. */
static int note_least(struct guard *g, double least, double enough)
{
    if (!(least >= enough)) {
        return 0;
    }
    g->lowest = greater(g->lowest, g->allowance - least);
    return 1;
}

/* Whether a guard cannot be below zero between two samples of it, h apart, until so much after the first one; if so, notes how
 * low it may be. */
static int positive(struct guard *g, const struct sample *from, const struct sample *to, double h, double until)
{
    const double enough = -noise(g);
    return note_least(g, tribo_quintic_least(from, to, h, g->bend, until, enough), enough);
}

/* All that are watched, between the left and the middle sample, h later. */
static int all_positive(struct first_zero *s, double h)
{
    for (size_t k = 0; k < s->watching; k++) {
        struct guard *g = s->watched[k];
        if (!positive(g, &g->left, &g->middle, h, h)) {
            return 0;
        }
    }
    return 1;
}

/* From the left sample on, the right one being h later. */
static int all_positive_until(struct first_zero *s, double until, double h)
{
    for (size_t k = 0; k < s->watching; k++) {
        struct guard *g = s->watched[k];
        if (!positive(g, &g->left, &g->right, h, until)) {
            return 0;
        }
    }
    return 1;
}

/* Leaves under watch those only of which left and right samples, h apart, do not tell that they are positive between. */
static void watch_doubtful(struct first_zero *s, double h)
{
    size_t left = 0;
    for (size_t k = 0; k < s->watching; k++) {
        struct guard *g = s->watched[k];
        if (!(g->right.g > noise(g)) || !positive(g, &g->left, &g->right, h, h)) {
            exchange(s->watched, left++, k);
        }
    }
    s->watching = left;
}

/* The length of interval to try first: a fraction of the guards' sizes in doubt. */
static double first_length(const struct first_zero *s, double longest)
{
    double ratio = HUGE_VAL;
    for (size_t k = 0; k < s->guards; k++) {
        const struct guard *g = &s->guard[k];
        ratio = lesser(ratio, g->bend > 0.0 ? g->size / g->bend : HUGE_VAL);
    }
    return lesser(sixth_root(400.0 * ratio), longest);
}

/* What is known of an interval at the end of which the middle samples are: that no guard is below zero in it, or that one is
 * not positive there, or neither. */
enum { CLEAR, FALLS, IN_DOUBT };

static int judge(struct first_zero *s, double h)
{
    return s->falls ? FALLS : all_positive(s, h) ? CLEAR : IN_DOUBT;
}

static int some_below(const struct first_zero *s)
{
    for (size_t k = 0; k < s->watching; k++) {
        if (s->watched[k]->middle.g < -noise(s->watched[k])) {
            return 1;
        }
    }
    return 0;
}

/* The guard that, among those not positive at the right end of the interval of length h, is the first to fall to zero as far as
 * the quintics tell, and when. */
static struct guard *first_to_fall(const struct first_zero *s, double h, double *when)
{
    struct guard *first = NULL;
    for (size_t k = 0; k < s->watching; k++) {
        struct guard *g = s->watched[k];
        if (g->right.g <= noise(g)) {
            const double guess = g->right.g >= -noise(g) ? h : tribo_quintic_zero(&g->left, &g->right, h);
            if (!first || guess < *when) {
                first = g;
                *when = guess;
            }
        }
    }
    return first;
}

/* The middle sample becomes the left one. A guard that has left zero there needs no allowance any more. */
static void keep_left(struct first_zero *s)
{
    for (size_t k = 0; k < s->watching; k++) {
        struct guard *g = s->watched[k];
        if (g->allowance > 0.0 && g->middle.g > 3.0 * g->allowance) {
            g->middle.g -= g->allowance;
            g->right.g -= g->allowance;
            g->allowance = 0.0;
        }
        g->left = g->middle;
    }
}

static void keep_right(struct first_zero *s)
{
    for (size_t k = 0; k < s->watching; k++) {
        s->watched[k]->right = s->watched[k]->middle;
    }
}

/* By how much the third derivative may change what two tell of a sum of exponentials and sines a step on: it is at most the
 * root of size times bend. */
static double cubic(const struct guard *g, double step)
{
    return sqrt(g->size) * sqrt(g->bend) * step * step * step * (1 / 6.);
}

/* Whether two derivatives tell, but for a doubt, that a guard is not below zero until a step after its left sample. */
static int clears(struct guard *g, double step, double doubt)
{
    return note_least(g, parabola_least(&g->left, step) - doubt, -noise(g));
}

/* Whether two derivatives tell that no other one is below zero when g is zero, a step after the left samples. */
static int is_first(const struct first_zero *s, const struct guard *g, double step)
{
    for (size_t k = 0; k < s->watching; k++) {
        struct guard *other = s->watched[k];
        if (other != g && !clears(other, step, step <= s->reach ? 0.0 : cubic(other, step))) {
            return 0;
        }
    }
    return 1;
}

/* The one of those watched that is first to fall to zero within a span of the left samples, as two derivatives see it, and
 * when; NULL if none does. */
static struct guard *first_in_sight(const struct first_zero *s, double span, double *step)
{
    struct guard *first = NULL;
    *step = span;
    for (size_t k = 0; k < s->watching; k++) {
        struct guard *g = s->watched[k];
        const double own = parabola_fall(&g->left, *step);
        if (own <= *step) {
            first = g;
            *step = own;
        }
    }
    return first;
}

/* The Taylor series p [6] of a guard from its left sample on, in terms of a span, at the end of which it is *end. 1, or 0 if
 * the motion does not know it. */
static int series(const struct first_zero *s, const struct guard *g, double span, double *p, double *end)
{
    double d[3];
    if (!s->motion->further || !s->motion->further(s->own, s->a, g, d)) {
        return 0;
    }
    p[0] = g->left.g;
    p[1] = span * g->left.d;
    p[2] = 0.5 * span * (span * g->left.e);
    p[3] = span * (span * (span * d[0])) * (1 / 6.);
    p[4] = span * (span * (span * (span * d[1]))) * (1 / 24.);
    p[5] = span * (span * (span * (span * (span * d[2])))) * (1 / 120.);
    *end = p[0] + p[1] + p[2] + p[3] + p[4] + p[5];
    return 1;
}

/* By how much a guard may differ from its Taylor series after a span. */
static double remainder_of(const struct guard *g, double span)
{
    const double cube = span * span * span;
    return g->bend * cube * cube * (1 / 720.);
}

/* A guard that two derivatives see fall to zero a step on, in the far reach: whether it falls all the way to there and beyond,
 * and *step is when it is zero. */
static int lands(const struct first_zero *s, const struct guard *g, double *step)
{
    const double span = 2.0 * *step;
    double p[6], end;
    if (g->allowance > 0.0 || !series(s, g, span, p, &end)) {
        return 0;
    }
    const double later = 3.0 * fabs(p[3]) + 4.0 * fabs(p[4]) + 5.0 * fabs(p[5]) + 6.0 * remainder_of(g, span);
    if (!(end < 0.0 && p[1] + 2.0 * greater(p[2], 0.0) + later < 0.0)) {
        return 0;
    }
    *step = span * tribo_taylor_zero(p, 0.5);
    return remainder_of(g, *step) <= FINE * noise(g);
}

/* Derivatives at the left samples, at a, foresee zeros within a part of the length h. One in reach is the first if this
 * returns it; another one is expected. */
static const struct guard *foresee(struct first_zero *s, double h, double longest, double *when)
{
    double step;
    const struct guard *first = first_in_sight(s, greater(SOON * h, s->far_reach), &step);
    if (!first) {
        return NULL;
    }
    const int reached = step <= s->reach || (step <= s->far_reach && lands(s, first, &step));
    *when = s->a + step;
    s->expected = *when;
    s->early = 0.0;
    return reached && *when <= lesser(longest, s->positive_until) && is_first(s, first, step) ? first : NULL;
}

/* By how much earlier to look than where a zero is foreseen that may be earlier, so that it is within reach from there. */
static double margin(const struct first_zero *s, double early)
{
    return greater(0.5 * s->reach, lesser(early, 0.5 * s->far_reach));
}

/* The time in which a guard falls by so much. */
static double time_of(double much, double slope)
{
    return slope < 0.0 ? -much / slope : HUGE_VAL;
}

/* All left samples are at a. Where five derivatives see that guard fall to zero which two see fall first, a zero is expected,
 * and only those guards are asked which two derivatives do not tell to be positive until after that. */
static void predict(struct first_zero *s)
{
    const double span = lesser(AHEAD * s->h, s->longest - s->a);
    double p[6], end, seen;
    const struct guard *g = first_in_sight(s, span, &seen);
    if (!g || !series(s, g, span, p, &end) || !(end < 0.0)) {
        return;
    }
    const double x = tribo_taylor_zero(p, seen / span), step = x * span, until = step + 0.5 * s->far_reach;
    const double slope = p[1] + x * (2.0 * p[2] + x * (3.0 * p[3] + x * (4.0 * p[4] + x * 5.0 * p[5])));
    if (!(step > s->reach)) {
        return;
    }
    s->expected = s->a + step;
    s->early = lesser(span * time_of(remainder_of(g, step), slope), 0.5 * step);
    s->asked = 0;
    for (size_t k = 0; k < s->guards; k++) {
        struct guard *other = s->watched[k];
        if (other == g || !clears(other, until, cubic(other, until))) {
            exchange(s->watched, s->asked++, k);
        }
    }
    s->positive_until = s->asked < s->guards ? s->a + until : HUGE_VAL;
}

/* A guard is not positive at *b. Narrows [a, *b] to the first zero of all guards: returns that guard, with *when, or NULL if
 * [a, *b] must be divided to tell. */
static const struct guard *narrow(struct first_zero *s, double *b, double *when)
{
    const struct guard *first = NULL;
    watch_doubtful(s, *b - s->a);
    while (!first && !s->lost) {
        double at = 0.0;
        const struct guard *falls = first_to_fall(s, *b - s->a, &at);
        const double h = *b - s->a, error = tribo_quintic_error(at, h, falls->bend);
        *when = s->a + at;
        if (falls->right.g >= -noise(falls)) {
            return all_positive_until(s, h, h) ? falls : NULL;
        }
        if (error <= FINE * noise(falls) && *when > s->a && *when < *b && all_positive_until(s, at, h)) {
            return falls;
        }
        at = greater(at - margin(s, h * time_of(error, falls->right.g - falls->left.g)), 0.5 * at);
        *when = s->a + at;
        if (!(*when > s->a && *when < *b)) {
            return NULL;
        }
        sample(s, *when);
        const int below = some_below(s);
        if (below || !all_positive(s, at)) {
            *b = *when;
            keep_right(s);
            if (!below) {
                return NULL;
            }
        } else if (falls->middle.g <= noise(falls)) {
            return falls;
        } else {
            s->a = *when;
            keep_left(s);
            first = foresee(s, *b - s->a, *b, when);
        }
    }
    return first;
}

/* Looks in the middle of an interval [a, *b] in doubt. Returns what is known of it then, or of its first half, up to which *b
 * comes back. */
static int divide(struct first_zero *s, double *b)
{
    const double half = 0.5 * (*b - s->a);
    watch_doubtful(s, *b - s->a);
    sample(s, s->a + half);
    const int first = judge(s, half);
    int clear = first == CLEAR;
    for (size_t k = 0; clear && k < s->watching; k++) {
        struct guard *g = s->watched[k];
        clear = positive(g, &g->middle, &g->right, half, half);
    }
    if (!clear) {
        *b = s->a + half;
        keep_right(s);
        return first == FALLS ? FALLS : IN_DOUBT;
    }
    for (size_t k = 0; k < s->asked; k++) {
        s->watched[k]->middle = s->watched[k]->right;
    }
    return CLEAR;
}

/* Finds bounds from a on, the reach that they leave to derivatives, and a length of interval to try. */
static void find_bounds(struct first_zero *s)
{
    s->better = s->motion->bound(s->own, s->a);
    const double length = first_length(s, s->longest);
    s->reach = SHORT * length;
    s->far_reach = FAR * length;
    s->h = greater(s->h, length);
}

/* What to try after an interval of length h: with care where it is of the length that bounds allow. */
static double longer(const struct first_zero *s, double h)
{
    return (SHORT * h < 0.5 * s->reach ? 1.7 : 1.15) * h;
}

/* Where to look next: where a zero is expected, which is then in reach, unless that is after too much. */
static double next_look(const struct first_zero *s)
{
    const double before = s->expected - margin(s, s->early);
    const int sensible = before > s->a && before < lesser(s->a + s->most, s->longest);
    return lesser(sensible ? before : lesser(s->a + s->h, s->longest), s->positive_until);
}

static void ask_all(struct first_zero *s)
{
    s->asked = s->guards;
    s->positive_until = HUGE_VAL;
}

/* The velocity that is the first to fall to zero so soon after the start that derivatives there see it, and when; NULL if none
 * does. What the motion becomes until longest may be so large that this is lost in the rounding of it. A velocity that is
 * rounding beside others does not count. */
static const struct guard *stops_at_once(struct first_zero *s, double *when)
{
    const struct guard *first = NULL;
    double step = lesser(s->reach, s->longest), fastest = 0.0;
    for (size_t k = 0; k < s->guards; k++) {
        const struct guard *g = &s->guard[k];
        fastest = g->kind == SLIDES ? greater(fastest, g->left.g - g->allowance) : fastest;
    }
    for (size_t k = 0; k < s->guards; k++) {
        const struct guard *g = &s->guard[k];
        const struct sample begins = {g->left.g - g->allowance, g->left.d, g->left.e};
        const int moves = g->kind == SLIDES && begins.g > ALLOWED * fastest;
        const double own = moves ? parabola_fall(&begins, step) : HUGE_VAL;
        if (own <= step) {
            first = g;
            step = own;
        }
    }
    s->at_once = first && is_first(s, first, step);
    *when = s->at_once ? step : *when;
    return s->at_once ? first : NULL;
}

/* Looks at the start: one that is zero there, or at once, or NULL. */
static const struct guard *start(struct first_zero *s, double *when)
{
    ask_all(s);
    watch_all(s);
    for (size_t k = 0; k < s->guards; k++) {
        s->watched[k] = &s->guard[k];
    }
    sample(s, 0.0);
    for (size_t k = 0; k < s->guards; k++) {
        s->guard[k].left = s->guard[k].middle;
    }
    const struct guard *first = stops_at_once(s, when);
    for (size_t k = 0; !first && k < s->guards; k++) {
        struct guard *g = &s->guard[k];
        const double more = greater(greater(ALLOWED * g->size, DBL_MIN) - g->allowance, 0.0);
        g->allowance += more;
        g->middle.g += more;
        first = g->middle.g <= 0.0 ? g : NULL;
    }
    if (!first) {
        keep_left(s);
    }
    return first;
}

/* All left samples are at a again, to which only some have come. */
static void come_to(struct first_zero *s)
{
    ask_all(s);
    watch_all(s);
    sample(s, s->a);
    keep_left(s);
}

/* Nothing happens until b, where the middle samples are: goes there, and returns a guard if its zero is in reach. */
static const struct guard *pass_interval(struct first_zero *s, double b, double *when)
{
    watch_all(s);
    s->h = greater(s->h, longer(s, b - s->a));
    s->most = STRETCH * s->h;
    s->a = b;
    keep_left(s);
    const struct guard *first = foresee(s, s->h, s->longest, when);
    if (!first && s->asked < s->guards) {
        come_to(s);
    }
    if (!first && s->expected <= b) {
        predict(s);
    }
    return first;
}

/* In an interval up to b that is too short to be divided: the guard that falls there, if one is below zero at its end. What
 * else is in doubt is rounding, and all guards come there. */
static const struct guard *fallen(struct first_zero *s, double b, double *when)
{
    double at;
    watch_all(s);
    const struct guard *below = first_to_fall(s, b - s->a, &at);
    *when = s->a = b;
    if (below && below->right.g < -noise(below)) {
        return below;
    }
    come_to(s);
    s->h = greater(s->h, s->resolution);
    return NULL;
}

/* An interval up to *b, where the middle samples are, is not clear: returns CLEAR if it is after another look, or finds the
 * first guard in it, or leaves less to try. */
static int settle_interval(struct first_zero *s, int known, double *b, const struct guard **first, double *when)
{
    const double begun = s->a;
    keep_right(s);
    if (known == IN_DOUBT) {
        known = divide(s, b);
    }
    if (known == FALLS) {
        *first = narrow(s, b, when);
    }
    if (known == CLEAR || *first) {
        return known;
    }
    s->most = s->h = SHRINK * (*b - s->a);
    if (!(s->a + s->h > s->a && s->a + s->h < *b && s->h > s->resolution)) {
        *first = fallen(s, *b, when);
    } else if (s->a > begun) {
        come_to(s);
    } else {
        ask_all(s);
    }
    return known;
}

int tribo_first_zero(struct first_zero *s, double longest, const struct guard **first, double *when)
{
    *first = NULL;
    *when = 0.0;
    if (s->guards == 0) {
        return 1;
    }
    s->looks = 0;
    s->a = s->h = 0.0;
    s->longest = longest;
    find_bounds(s);
    s->most = STRETCH * s->h;
    s->lost = (double)MOST_LOOKS * s->h < HOPELESS * lesser(s->better, longest);
    *first = start(s, when);
    if (!*first && !(s->expected > 0.0)) {
        predict(s);
    }
    while (!*first && s->a < longest) {
        if (s->lost || !(s->h > 0.0)) {
            return 0;
        }
        if (s->a >= s->better) {
            find_bounds(s);
        }
        double b = next_look(s);
        watch_all(s);
        sample(s, b);
        int known = judge(s, b - s->a);
        if (known != CLEAR) {
            known = settle_interval(s, known, &b, first, when);
        }
        if (known == CLEAR) {
            *first = pass_interval(s, b, when);
        }
    }
    return 1;
}
