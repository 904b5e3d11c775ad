/* SPDX-License-Identifier: BSD-3-Clause */
/* Walks intervals [a, b] from left to right. An interval is clear of a guard if the quintic through the guard's samples at both
 * ends and the bound of its sixth derivative prove that the guard is not below zero between. Guards that are not clear are
 * doubtful: only these are sampled inside the interval, where the first quintic falls to zero, or in the middle, until the
 * interval is clear, or its first zero is that of a quintic to rounding. Ends of intervals are guesses: the length that bounds
 * allow, where parabolas at a fall to zero, or when a zero came last time. What is certain comes from the bounds. */
#include "first_zero.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* Looks at a phase after which it is given up: the motion has frequencies that cannot be followed. */
#define MOST_LOOKS ((size_t)1 << 24)

/* Give up at the start if MOST_LOOKS first intervals do not cover this part of the time that bounds hold. */
#define HOPELESS 1e-6

/* Reach of two derivatives at the start, in parts of a first length. The third derivative of a sum of exponentials and sines is
 * at most sqrt(size bend) (Cauchy, Schwarz), that of powers of time at most 4.5 times this and 60 size/longest^3: over SHORT it
 * changes the guard by a tenth of noise. */
#define SHORT 1.9e-6

/* The part of an interval within which parabolas foresee a zero. */
#define SOON 0.2

/* A zero of the quintic is that of the guard if both differ there by at most this part of noise. */
#define FINE 0.1

/* A zero within this last part of an interval is not looked at once more, but the middle. */
#define CLOSE 0.999

/* After an interval that needed further looks, this part of it is tried. */
#define SHRINK 0.7

/* Growth of the length of intervals that are clear. */
#define GROWS 1.15

/* An interval that ends at an expected zero may be longer by this factor. */
#define STRETCH 1.5

/* A guard that begins at zero is allowed to be negative by this part of its size. */
#define ALLOWED 1e-14

/* x^(1/6) within 7%: the bits of a double, as an integer, are nearly linear in its logarithm. */
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

/* Least value, until a step on, of the parabola with the value and two derivatives of sample m. */
static double parabola_least(const struct sample *m, double step)
{
    const double end = m->g + step * (m->d + 0.5 * step * m->e);
    const int turns = m->d < 0.0 && m->d + step * m->e > 0.0;
    return turns ? lesser(end, m->g - 0.5 * m->d * m->d / m->e) : end;
}

/* First zero of this parabola within most; HUGE_VAL if there is none. No quotient overflows that most does not make large. */
static double parabola_fall(const struct sample *m, double most)
{
    double when = HUGE_VAL;
    if (m->d < 0.0 && m->g + 2.0 * most * m->d < 0.0) {
        const double line = -m->g / m->d, square = 1.0 + 2.0 * line * (m->e / m->d);
        when = square >= 0.0 ? 2.0 * line / (1.0 + sqrt(square)) : HUGE_VAL;
    } else if (m->g + most * (m->d + 0.5 * most * m->e) < 0.0) {
        const double top = -m->d / m->e;
        when = top + sqrt(greater(top * top - 2.0 * m->g / m->e, 0.0));
    }
    return when <= most ? when : HUGE_VAL;
}

/* Finds bounds and noise from a on, and a length of interval to try. */
static void find_bounds(struct first_zero *s)
{
    s->better = s->motion->bound(s->own, s->a);
    double ratio = HUGE_VAL;
    for (size_t k = 0; k < s->guards; k++) {
        struct guard *g = &s->guard[k];
        g->noise = 4.0 * DBL_EPSILON * g->size;
        ratio = lesser(ratio, g->bend > 0.0 ? g->size / g->bend : HUGE_VAL);
    }
    s->length = lesser(sixth_root(400.0 * ratio), s->longest);
    s->h = greater(s->h, s->length);
}

/* Sets the middle samples of watched guards. */
static void sample(struct first_zero *s, double tau)
{
    double all = 0.0;
    s->motion->look(s->own, tau, s->watching, s->watched);
    for (size_t k = 0; k < s->watching; k++) {
        struct sample *m = &s->watched[k]->middle;
        all += 0.0 * (m->g + m->d + m->e);
        m->g += s->watched[k]->allowance;
    }
    s->looks++;
    s->lost |= all != 0.0 || s->looks >= MOST_LOOKS;
}

/* Makes the middle samples the left ones; drops the allowance of guards that have left zero. */
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

/* 1 if least >= -noise; then updates lowest. */
static int is_clear(struct guard *g, double least)
{
    if (!(least >= -g->noise)) {
        return 0;
    }
    g->lowest = greater(g->lowest, g->allowance - least);
    return 1;
}

/* 1 if the guard is not below zero from the left sample until `until` later; sample b is h after the left one. */
static int positive(struct guard *g, const struct sample *b, double h, double until)
{
    return is_clear(g, tribo_quintic_least(&g->left, b, h, g->bend, until, -g->noise));
}

/* 1 if parabolas at a show no guard but first below zero until a + step, in reach of the derivatives. */
static int are_clear(struct first_zero *s, const struct guard *first, double step)
{
    int clear = 1;
    for (size_t k = 0; clear && k < s->guards; k++) {
        struct guard *g = &s->guard[k];
        clear = g == first || is_clear(g, parabola_least(&g->left, step));
    }
    return clear;
}

/* Watches only the doubtful guards of the interval between left and right samples, h apart. */
static void watch_doubtful(struct first_zero *s, double h)
{
    size_t left = 0;
    for (size_t k = 0; k < s->watching; k++) {
        struct guard *g = s->watched[k];
        if (!(g->right.g > g->noise) || !positive(g, &g->right, h, h)) {
            s->watched[k] = s->watched[left];
            s->watched[left++] = g;
        }
    }
    s->watching = left;
}

/* Among the watched guards that are not positive at the right end, h after a: the guard with the earliest zero of its quintic;
 * *when = that zero, as time after a. NULL: all are positive. begins = 1: a is where guards with an allowance began within that
 * of zero. *fine = 1 if the guard has no allowance, or did not begin at a, and its zero is that of the quintic to rounding. */
static const struct guard *first_to_fall(const struct first_zero *s, double h, int begins, double *when, int *fine)
{
    const struct guard *first = NULL;
    for (size_t k = 0; k < s->watching; k++) {
        const struct guard *g = s->watched[k];
        if (g->right.g <= g->noise) {
            const double guess = g->right.g >= 0.0 ? h : tribo_quintic_zero(&g->left, &g->right, h);
            if (!first || guess < *when) {
                first = g;
                *when = guess;
                *fine =
                    !(begins && g->allowance > 0.0) && (guess == h || tribo_quintic_error(guess, h, g->bend) <= FINE * g->noise);
            }
        }
    }
    return first;
}

/* 1 if no watched guard is below zero from a until `until` later; the middle samples, or the right ones, are h after a. */
static int all_positive(const struct first_zero *s, int middle, double until, double h)
{
    for (size_t k = 0; k < s->watching; k++) {
        struct guard *g = s->watched[k];
        if (!positive(g, middle ? &g->middle : &g->right, h, until)) {
            return 0;
        }
    }
    return 1;
}

/* Moves a to b, where all guards have been sampled. Sets expected, unless it is ahead, to the first zero of parabolas within SOON
 * h, if there is one. Returns the guard if its zero, *when, is within reach of the derivatives; else NULL. */
static const struct guard *come_to(struct first_zero *s, double b, double *when)
{
    const struct guard *first = NULL;
    double step = s->expected > b + SHORT * s->length ? 0.0 : lesser(SOON * s->h, s->longest - b);
    s->a = b;
    s->watching = s->guards;
    keep_left(s);
    for (size_t k = 0; step > 0.0 && k < s->guards; k++) {
        const double own = parabola_fall(&s->guard[k].left, step);
        if (own <= step) {
            first = &s->guard[k];
            step = own;
            *when = s->expected = b + step;
        }
    }
    return first && step <= SHORT * s->length && are_clear(s, first, step) ? first : NULL;
}

/* Searches [a, b]. Returns the first guard to be zero there, with *when; or NULL: no guard is below zero until a, which has moved
 * to b, or towards it. A doubt about an interval too short to be divided is rounding. */
static const struct guard *search_interval(struct first_zero *s, double b, double *when)
{
    const double begun = s->a;
    const size_t looks = s->looks;
    sample(s, b);
    keep_right(s);
    watch_doubtful(s, b - s->a);
    while (s->watching && !s->lost) {
        const double h = b - s->a;
        double at = 0.0;
        int fine = 0;
        const struct guard *falls = first_to_fall(s, h, s->a == begun, &at, &fine);
        const int begins = falls && falls->allowance > 0.0 && s->a == begun;
        if (fine && all_positive(s, 0, at, h)) {
            *when = s->a + at;
            return falls;
        }
        const double next = s->a + (begins ? 0.5 * at : falls && !(fine && at > CLOSE * h) ? at : 0.5 * h);
        if (!(next > s->a && next < b && h > s->resolution)) {
            *when = b;
            if (falls && falls->right.g < -falls->noise) {
                return falls;
            }
            break;
        }
        sample(s, next);
        if (all_positive(s, 1, next - s->a, next - s->a)) {
            s->a = next;
            keep_left(s);
        } else {
            b = next;
            keep_right(s);
        }
        watch_doubtful(s, b - s->a);
    }
    if (s->looks > looks + 1) {
        s->h = greater(SHRINK * (b - begun), greater(s->resolution, DBL_EPSILON * b));
        s->watching = s->guards;
        sample(s, b);
    } else {
        s->h = greater(s->h, GROWS * (b - begun));
    }
    return come_to(s, b, when);
}

/* Looks at the start. Returns a guard that is zero there; or the velocity that is first to fall to zero within reach of the
 * derivatives, with *when: a motion that becomes large until longest hides this zero in its rounding; or NULL. A velocity that
 * is rounding beside others does not count. */
static const struct guard *start(struct first_zero *s, double *when)
{
    const struct guard *first = NULL;
    double step = lesser(SHORT * s->length, s->longest), fastest = 0.0;
    for (size_t k = 0; k < s->guards; k++) {
        s->watched[k] = &s->guard[k];
    }
    s->watching = s->guards;
    sample(s, 0.0);
    for (size_t k = 0; k < s->guards; k++) {
        struct guard *g = &s->guard[k];
        g->left = g->middle;
        fastest = g->kind == SLIDES ? greater(fastest, g->left.g - g->allowance) : fastest;
    }
    for (size_t k = 0; k < s->guards; k++) {
        const struct guard *g = &s->guard[k];
        const struct sample begins = {g->left.g - g->allowance, g->left.d, g->left.e};
        const double own = g->kind == SLIDES ? parabola_fall(&begins, step) : HUGE_VAL;
        if (own <= step && begins.g > ALLOWED * fastest) {
            first = g;
            step = own;
        }
    }
    first = first && are_clear(s, first, step) ? first : NULL;
    s->at_once = first != NULL;
    if (first) {
        *when = step;
        return first;
    }
    for (size_t k = 0; !first && k < s->guards; k++) {
        struct guard *g = &s->guard[k];
        const double more = greater(greater(ALLOWED * g->size, DBL_MIN) - g->allowance, 0.0);
        g->allowance += more;
        g->middle.g += more;
        first = g->middle.g <= 0.0 ? g : NULL;
    }
    return first ? first : come_to(s, 0.0, when);
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
    s->lost = (double)MOST_LOOKS * s->h < HOPELESS * lesser(s->better, longest);
    *first = start(s, when);
    while (!*first && s->a < longest) {
        if (s->lost || !(s->h > 0.0)) {
            return 0;
        }
        if (s->a >= s->better) {
            find_bounds(s);
        }
        /* just before an expected zero, which is in reach of the derivatives there, unless that is too far */
        const double before = s->expected - 0.5 * SHORT * s->length;
        const int near = before > s->a && before < s->a + STRETCH * s->h;
        *first = search_interval(s, lesser(near ? before : s->a + s->h, longest), when);
    }
    return 1;
}
