/* Intervals [a, b] are walked through from left to right. Where all guards are positive at both ends, their quintics and the
 * bounds of what these leave out tell whether they are so between; where they do not tell, or a guard is not positive at b, the
 * interval becomes shorter: up to where the quintics have their first zero, or by a part. Then only those guards are looked at of
 * which the longer interval does not tell that they are positive. */
#include "first_zero.h"
#include "../common/real.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* So many looks at a motion between two events, or a first step of zero, mean that it has frequencies which cannot be followed.
 */
#define MOST_LOOKS ((size_t)1 << 24)

/* Where bounds that hold so long leave intervals of which that many are not this part of it, it need not be tried. */
#define HOPELESS 1e-6

/* The third derivative of a sum of exponentials and sines is at most the root of its size times its bend (Cauchy, Schwarz), that
 * of powers of time at most 4.5 times this and 60 size/longest^3. So over this part of a first length it changes what two
 * derivatives tell by a tenth of noise. */
#define SHORT 2e-6

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

/* x^(1/6) within a factor of 1.13, by the bits of the exponent: frexp and ldexp take three times as long. */
static double sixth_root(double x)
{
    static const double root[] = {1.0, 1.122, 1.26, 1.414, 1.587, 1.782};
    const double normal = greater(x, DBL_MIN);
    uint64_t bits;
    double scale;
    memcpy(&bits, &normal, sizeof bits);
    const int e = (int)(bits >> 52) - 1022 + 6000; /* normal = m 2^(e - 6000), 1/2 <= m < 1 */
    bits = (uint64_t)(e / 6 - 1000 + 1023) << 52;
    memcpy(&scale, &bits, sizeof scale); /* 2^(e/6 - 1000) */
    return x > 0.0 && x <= DBL_MAX ? root[e % 6] * scale : x;
}

static void watch_all(struct first_zero *s)
{
    for (size_t k = 0; s->watching < s->guards && k < s->guards; k++) {
        s->watched[k] = &s->guard[k];
    }
    s->watching = s->guards;
}

/* Middle samples of those watched. */
static void sample(struct first_zero *s, double tau)
{
    double all = 0.0;
    s->look(s->motion, tau, s->watching, s->watched);
    for (size_t k = 0; k < s->watching; k++) {
        struct sample *m = &s->watched[k]->middle;
        all += 0.0 * (m->g + m->d + m->e);
        m->g += s->watched[k]->allowance;
    }
    s->looks++;
    s->lost |= all != 0.0 || s->looks >= MOST_LOOKS;
}

/* Whether a guard cannot be below zero between two samples of it, h apart, until so much after the first one; if so, notes how
 * low it may be. */
static int positive(struct guard *g, const struct sample *from, const struct sample *to, double h, double until)
{
    const double enough = -noise(g), least = tribo_quintic_least(from, to, h, g->bend, until, enough);
    if (!(least >= enough)) {
        return 0;
    }
    g->lowest = greater(g->lowest, g->allowance - least);
    return 1;
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
            s->watched[left++] = g;
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
    return lesser(sixth_root(300.0 * ratio), longest);
}

/* What is known of an interval at the end of which the middle samples are: that no guard is below zero in it, or that one is not
 * positive there, or neither. */
enum { CLEAR, FALLS, IN_DOUBT };

static int judge(struct first_zero *s, double h)
{
    for (size_t k = 0; k < s->watching; k++) {
        if (!(s->watched[k]->middle.g > noise(s->watched[k]))) {
            return FALLS;
        }
    }
    return all_positive(s, h) ? CLEAR : IN_DOUBT;
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

/* The least that two derivatives make of a guard on its way from a sample to a step after it. */
static double least_until(const struct sample *m, double step)
{
    const double end = m->g + step * (m->d + 0.5 * step * m->e);
    const int turns = m->d < 0.0 && m->d + step * m->e > 0.0;
    return turns ? lesser(end, m->g - 0.5 * m->d * m->d / m->e) : end;
}

/* How far it is from the left sample to a guard's zero by two derivatives; HUGE_VAL if it is further than most. */
static double step_to_zero(const struct guard *g, double most)
{
    const struct sample *m = &g->left;
    if (!(m->d < 0.0 && m->g + 2.0 * most * m->d < 0.0 && m->g >= -noise(g))) {
        return HUGE_VAL;
    }
    const double square = m->d * m->d - 2.0 * m->e * m->g;
    const double step = square > 0.0 ? 2.0 * m->g / (sqrt(square) - m->d) : HUGE_VAL;
    return step <= most ? step : HUGE_VAL;
}

/* Whether two derivatives tell that no other one is below zero when g is zero, a step after the left samples. */
static int is_first(const struct first_zero *s, const struct guard *g, double step)
{
    for (size_t k = 0; k < s->guards; k++) {
        const struct guard *other = &s->guard[k];
        if (other != g && least_until(&other->left, step) < -noise(other)) {
            return 0;
        }
    }
    return 1;
}

/* Two derivatives at the left samples, at a, foresee zeros within a part of the length h. One in reach is the first if this
 * returns it; another one is expected. */
static const struct guard *foresee(struct first_zero *s, double a, double h, double longest, double *when)
{
    const struct guard *first = NULL;
    double step = HUGE_VAL;
    for (size_t k = 0; k < s->guards; k++) {
        const double own = step_to_zero(&s->guard[k], greater(SOON * h, s->reach));
        if (own < step) {
            first = &s->guard[k];
            step = own;
        }
    }
    *when = a + step;
    s->expected = first ? *when : s->expected;
    return first && step <= s->reach && *when <= longest && is_first(s, first, step) ? first : NULL;
}

/* A guard is not positive at *b. Narrows [*a, *b] to the first zero of all guards: returns that guard, with *when, or NULL if
 * [*a, *b] must be divided to tell. */
static const struct guard *narrow(struct first_zero *s, double *a, double *b, double *when)
{
    watch_doubtful(s, *b - *a);
    while (!s->lost) {
        double at = 0.0;
        const struct guard *falls = first_to_fall(s, *b - *a, &at);
        const double h = *b - *a;
        *when = *a + at;
        if (falls->right.g >= -noise(falls)) {
            return all_positive_until(s, h, h) ? falls : NULL;
        }
        if (!(*when > *a && *when < *b)) {
            return NULL;
        }
        if (tribo_quintic_error(at, h, falls->bend) <= FINE * noise(falls) && all_positive_until(s, at, h)) {
            return falls;
        }
        sample(s, *when);
        if (some_below(s)) {
            *b = *when;
            keep_right(s);
        } else if (!all_positive(s, at)) {
            *b = *when;
            keep_right(s);
            return NULL;
        } else if (falls->middle.g <= noise(falls)) {
            return falls;
        } else {
            *a = *when;
            keep_left(s);
        }
    }
    return NULL;
}

/* Looks in the middle of an interval [a, *b] in doubt. Returns what is known of it then, or of its first half, up to which *b
 * comes back. */
static int divide(struct first_zero *s, double a, double *b)
{
    const double half = 0.5 * (*b - a);
    watch_doubtful(s, *b - a);
    sample(s, a + half);
    const int first = judge(s, half);
    int clear = first == CLEAR;
    for (size_t k = 0; clear && k < s->watching; k++) {
        struct guard *g = s->watched[k];
        clear = positive(g, &g->middle, &g->right, half, half);
    }
    if (!clear) {
        *b = a + half;
        keep_right(s);
        return first == FALLS ? FALLS : IN_DOUBT;
    }
    for (size_t k = 0; k < s->guards; k++) {
        s->guard[k].middle = s->guard[k].right;
    }
    return CLEAR;
}

/* Finds bounds from a on, and the reach that they leave to two derivatives. Returns a length of interval to try. */
static double find_bounds(struct first_zero *s, double a, double longest, double *better)
{
    *better = s->bound(s->motion, a);
    const double length = first_length(s, longest);
    s->reach = SHORT * length;
    return length;
}

/* What to try after an interval of length h: with care where it is of the length that bounds allow. */
static double longer(const struct first_zero *s, double h)
{
    return (SHORT * h < 0.5 * s->reach ? 1.7 : 1.15) * h;
}

/* Where to look next: where a zero is expected, which is then in reach, unless that is after more than `most`. */
static double next_look(const struct first_zero *s, double a, double h, double most, double longest)
{
    const double before = s->expected - 0.5 * s->reach;
    return before > a && before < lesser(a + most, longest) ? before : lesser(a + h, longest);
}

/* Looks at the start: one that is zero there, or NULL. */
static const struct guard *start(struct first_zero *s)
{
    s->watching = 0;
    watch_all(s);
    for (size_t k = 0; k < s->guards; k++) {
        struct guard *g = &s->guard[k];
        g->allowance = greater(g->allowance, greater(ALLOWED * g->size, DBL_MIN));
    }
    sample(s, 0.0);
    keep_left(s);
    for (size_t k = 0; k < s->guards; k++) {
        if (s->guard[k].left.g <= 0.0) {
            return &s->guard[k];
        }
    }
    return NULL;
}

/* All left samples are at a again, to which only those of guards in doubt have come. */
static void come_to(struct first_zero *s, double a)
{
    watch_all(s);
    sample(s, a);
    keep_left(s);
}

/* In an interval of length h that is too short to be divided: the guard that falls there, if one is below zero at its end. What
 * else is in doubt is rounding. */
static const struct guard *fallen(struct first_zero *s, double h)
{
    double at;
    watch_all(s);
    const struct guard *below = first_to_fall(s, h, &at);
    return below && below->right.g < -noise(below) ? below : NULL;
}

int tribo_first_zero(struct first_zero *s, double longest, const struct guard **first, double *when)
{
    *first = NULL;
    *when = 0.0;
    if (s->guards == 0) {
        return 1;
    }
    s->looks = 0;
    double a = 0.0, better, h = find_bounds(s, a, longest, &better), most = STRETCH * h;
    s->lost = (double)MOST_LOOKS * h < HOPELESS * lesser(better, longest);
    *first = start(s);
    while (!*first && a < longest) {
        if (s->lost || !(h > 0.0)) {
            return 0;
        }
        if (a >= better) {
            h = greater(h, find_bounds(s, a, longest, &better));
        }
        const double begun = a;
        double b = next_look(s, a, h, most, longest);
        watch_all(s);
        sample(s, b);
        int known = judge(s, b - a);
        if (known != CLEAR) {
            keep_right(s);
        }
        if (known == IN_DOUBT) {
            known = divide(s, a, &b);
        }
        if (known == FALLS) {
            *first = narrow(s, &a, &b, when);
        }
        if (known == CLEAR) {
            watch_all(s);
            h = greater(h, longer(s, b - a));
            most = STRETCH * h;
            a = b;
            keep_left(s);
            *first = foresee(s, a, h, longest, when);
        } else if (!*first) {
            most = h = SHRINK * (b - a);
            if (a + h > a && a + h < b && h > s->resolution) {
                if (a > begun) {
                    come_to(s, a);
                }
                continue;
            }
            *first = fallen(s, b - a);
            *when = a = b;
            if (!*first) {
                come_to(s, a);
                h = greater(h, s->resolution);
            }
        }
    }
    return 1;
}
