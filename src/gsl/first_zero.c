/* Intervals [a, b] are walked through from left to right. Where all guards are positive at both ends, their quintics and the
 * bounds of what these leave out tell whether they are so between; where they do not tell, or a guard is not positive at b, the
 * interval becomes shorter: up to where the quintics have their first zero, or by a part. */
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
 * derivatives tell by a thousandth of noise. */
#define SHORT 2.5e-7

/* Within this part of an interval two derivatives foresee a zero to a thousandth: from just before it, it is in their reach. */
#define SOON 0.1

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

static void sample(struct first_zero *s, double tau)
{
    double not_finite = 0.0;
    s->look(s->motion, tau, s->guards, s->guard);
    for (size_t k = 0; k < s->guards; k++) {
        struct sample *m = &s->guard[k].middle;
        not_finite += (m->g - m->g) + (m->d - m->d) + (m->e - m->e);
        m->g += s->guard[k].allowance;
    }
    s->looks++;
    s->lost |= not_finite != 0.0 || s->looks >= MOST_LOOKS;
}

/* 1 if no guard can be below zero between its left sample and the next one, h later. */
static int all_positive(struct first_zero *s, double h, int to_middle)
{
    for (size_t k = 0; k < s->guards; k++) {
        struct guard *g = &s->guard[k];
        const double least = tribo_quintic_least(&g->left, to_middle ? &g->middle : &g->right, h, g->bend);
        if (!(least >= -noise(g))) {
            return 0;
        }
        g->lowest = greater(g->lowest, g->allowance - least);
    }
    return 1;
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

/* The guard that, among those not positive at the right end of the interval of length h, is the first to fall to zero as far as
 * the quintics tell, and when. */
static struct guard *first_to_fall(struct first_zero *s, double h, double *when)
{
    struct guard *first = NULL;
    for (size_t k = 0; k < s->guards; k++) {
        struct guard *g = &s->guard[k];
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

/* A guard that has left zero at the middle sample needs no allowance any more. */
static void drop_allowances(struct first_zero *s)
{
    for (size_t k = 0; k < s->guards; k++) {
        struct guard *g = &s->guard[k];
        if (g->allowance > 0.0 && g->middle.g > 3.0 * g->allowance) {
            g->middle.g -= g->allowance;
            g->right.g -= g->allowance;
            g->allowance = 0.0;
        }
    }
}

/* The middle sample becomes the left one. */
static void keep_left(struct first_zero *s)
{
    drop_allowances(s);
    for (size_t k = 0; k < s->guards; k++) {
        s->guard[k].left = s->guard[k].middle;
    }
}

static void keep_right(struct first_zero *s)
{
    for (size_t k = 0; k < s->guards; k++) {
        s->guard[k].right = s->guard[k].middle;
    }
}

static int some_below(const struct first_zero *s)
{
    for (size_t k = 0; k < s->guards; k++) {
        if (s->guard[k].middle.g < -noise(&s->guard[k])) {
            return 1;
        }
    }
    return 0;
}

/* The least that two derivatives make of a guard on its way from the middle sample to a step after it. */
static double least_until(const struct sample *m, double step)
{
    const double end = m->g + step * (m->d + 0.5 * step * m->e);
    const int turns = m->d < 0.0 && m->d + step * m->e > 0.0;
    return turns ? lesser(end, m->g - 0.5 * m->d * m->d / m->e) : end;
}

/* How far it is from the middle sample to a guard's zero by two derivatives; HUGE_VAL if it is further than most. */
static double step_to_zero(const struct guard *g, double most)
{
    const struct sample *m = &g->middle;
    if (!(m->d < 0.0 && m->g + 2.0 * most * m->d < 0.0 && m->g >= -noise(g))) {
        return HUGE_VAL;
    }
    const double square = m->d * m->d - 2.0 * m->e * m->g;
    const double step = square > 0.0 ? 2.0 * m->g / (sqrt(square) - m->d) : HUGE_VAL;
    return step <= most ? step : HUGE_VAL;
}

/* Expects a zero where two derivatives at the middle sample, at b, foresee it within a part of the length h. */
static void foresee(struct first_zero *s, double b, double h)
{
    double soonest = HUGE_VAL;
    for (size_t k = 0; k < s->guards; k++) {
        soonest = lesser(soonest, step_to_zero(&s->guard[k], SOON * h));
    }
    s->expected = soonest < HUGE_VAL ? b + soonest : s->expected;
}

/* The guard that is the first to meet zero within reach of the middle sample, and when; NULL if there is none. */
static struct guard *first_near(const struct first_zero *s, double *step)
{
    struct guard *first = NULL;
    *step = HUGE_VAL;
    for (size_t k = 0; k < s->guards; k++) {
        const double own = step_to_zero(&s->guard[k], s->reach);
        if (own < *step) {
            first = &s->guard[k];
            *step = own;
        }
    }
    for (size_t k = 0; first && k < s->guards; k++) {
        const struct guard *g = &s->guard[k];
        if (g != first && least_until(&g->middle, *step) < -noise(g)) {
            return NULL;
        }
    }
    return first;
}

/* A guard is not positive at *b; falls seems to be the first to be so, at from *a. Narrows [*a, *b] to the first zero of all
 * guards: returns that guard, with *when, or NULL if [*a, *b] must be divided to tell. */
static const struct guard *narrow(struct first_zero *s, struct guard *falls, double at, double *a, double *b, double *when)
{
    while (falls->right.g < -noise(falls) && *a + at > *a && *a + at < *b && !s->lost) {
        /* a little before the zero, so that it is in reach from there */
        const double length = at > s->reach ? at - 0.5 * s->reach : at, trial = *a + length;
        double step;
        sample(s, trial);
        if (some_below(s)) {
            *b = trial;
            keep_right(s);
            falls = first_to_fall(s, *b - *a, &at);
            continue;
        }
        if (!all_positive(s, length, 1)) {
            *b = trial;
            keep_right(s);
            return NULL;
        }
        drop_allowances(s);
        const struct guard *near = first_near(s, &step);
        if (near || falls->middle.g <= noise(falls)) {
            *when = near ? greater(trial + step, 0.0) : trial;
            return near ? near : falls;
        }
        *a = trial;
        keep_left(s);
        falls = first_to_fall(s, *b - *a, &at);
    }
    *when = *b;
    return all_positive(s, *b - *a, 0) ? falls : NULL;
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

/* Where to look next: not further than to where a zero is expected, which is then in reach. */
static double next_look(const struct first_zero *s, double a, double h, double longest)
{
    const double b = lesser(a + h, longest), before = s->expected - 0.5 * s->reach;
    return before > a && before < b ? before : b;
}

int tribo_first_zero(struct first_zero *s, double longest, const struct guard **first, double *when)
{
    *first = NULL;
    if (s->guards == 0) {
        return 1;
    }
    s->looks = 0;
    s->lost = 0;
    double a = 0.0, better, h = find_bounds(s, a, longest, &better), at = 0.0, step;
    for (size_t k = 0; k < s->guards; k++) {
        struct guard *g = &s->guard[k];
        g->allowance = greater(g->allowance, greater(ALLOWED * g->size, DBL_MIN));
    }
    s->lost = (double)MOST_LOOKS * h < HOPELESS * lesser(better, longest);
    sample(s, 0.0);
    keep_left(s);
    for (size_t k = 0; k < s->guards; k++) {
        if (s->guard[k].left.g <= 0.0) {
            *first = &s->guard[k];
            *when = 0.0;
            return 1;
        }
    }
    while (a < longest) {
        if (s->lost || !(h > 0.0)) {
            return 0;
        }
        if (a >= better) {
            h = greater(h, find_bounds(s, a, longest, &better));
        }
        double b = next_look(s, a, h, longest);
        sample(s, b);
        keep_right(s);
        struct guard *below = first_to_fall(s, b - a, &at);
        if (below) {
            *first = narrow(s, below, at, &a, &b, when);
            if (*first) {
                return 1;
            }
        } else if (all_positive(s, b - a, 0)) {
            drop_allowances(s);
            const struct guard *near = first_near(s, &step);
            if (near && b + step <= longest) {
                *first = near;
                *when = b + step;
                return 1;
            }
            h = greater(h, longer(s, b - a));
            foresee(s, b, h);
            a = b;
            keep_left(s);
            continue;
        }
        h = 0.7 * (b - a);
        if (!(a + h > a && a + h < b && h > s->resolution)) {
            /* nothing left to divide: a guard that is below zero fell right here, and what else is in doubt is rounding */
            below = first_to_fall(s, b - a, &at);
            if (below && below->right.g < -noise(below)) {
                *first = below;
                *when = b;
                return 1;
            }
            sample(s, b);
            a = b;
            keep_left(s);
            h = greater(h, s->resolution);
        }
    }
    return 1;
}
