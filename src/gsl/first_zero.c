/* Intervals [a, b] are walked through from left to right. Where all guards are positive at both ends, their quintics and the
 * bounds of what these leave out tell whether they are so between; where they do not tell, or a guard is not positive at b, the
 * interval becomes shorter: up to where the quintics have their first zero, or by half. */
#include "first_zero.h"
#include "../common/real.h"

#include <float.h>
#include <math.h>

/* So many looks at a motion between two events, or a first step of zero, mean that it has frequencies which cannot be followed.
 */
#define MOST_LOOKS ((size_t)1 << 24)

/* A guard that begins at zero may stray from there by this part of its size. */
#define ALLOWED 1e-14

/* Values of a guard that are rounding. */
static double noise(const struct guard *g)
{
    return 4.0 * DBL_EPSILON * g->size;
}

/* x^(1/6) within a factor of 1.13. */
static double sixth_root(double x)
{
    static const double root[] = {1.0, 1.122, 1.26, 1.414, 1.587, 1.782};
    int e;
    frexp(x, &e);
    e += 6000;
    return x > 0.0 && x <= DBL_MAX ? ldexp(root[e % 6], e / 6 - 1000) : x;
}

static void sample(struct first_zero *s, double tau)
{
    s->go(s->motion, tau);
    for (size_t k = 0; k < s->guards; k++) {
        s->guard[k].middle = s->read(s->motion, &s->guard[k]);
        s->guard[k].middle.g += s->guard[k].allowance;
    }
    s->looks++;
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

/* The last sample becomes the left one. A guard that has left zero needs no allowance any more. */
static void keep_left(struct first_zero *s)
{
    for (size_t k = 0; k < s->guards; k++) {
        struct guard *g = &s->guard[k];
        g->left = g->middle;
        if (g->allowance > 0.0 && g->left.g > 3.0 * g->allowance) {
            g->left.g -= g->allowance;
            g->right.g -= g->allowance;
            g->allowance = 0.0;
        }
    }
}

static void keep_right(struct first_zero *s)
{
    for (size_t k = 0; k < s->guards; k++) {
        s->guard[k].right = s->guard[k].middle;
    }
}

/* Whether another guard is below zero where the middle sample is, or by its slope step after it. */
static int some_below(const struct first_zero *s, const struct guard *but, double step)
{
    for (size_t k = 0; k < s->guards; k++) {
        const struct guard *g = &s->guard[k];
        if (g != but && g->middle.g + step * g->middle.d < -noise(g)) {
            return 1;
        }
    }
    return 0;
}

/* How far a guard's zero is from its middle sample by Newton's method, if that is as good as another look; 0 if there is need of
 * one. */
static double last_bit(const struct first_zero *s, const struct guard *g)
{
    const double step = g->middle.d < 0.0 ? -g->middle.g / g->middle.d : 0.0;
    return fabs(0.5 * g->middle.e * step * step) <= noise(g) && !some_below(s, g, step) ? step : 0.0;
}

/* A guard is not positive at *b; falls seems to be the first to be so, at from *a. Narrows [*a, *b] to the first zero of all
 * guards: returns that guard, with *when, or NULL if [*a, *b] must be divided to tell. */
static const struct guard *narrow(struct first_zero *s, struct guard *falls, double at, double *a, double *b, double *when)
{
    while (falls->right.g < -noise(falls) && *a + at > *a && *a + at < *b && s->looks < MOST_LOOKS) {
        const double trial = *a + at;
        sample(s, trial);
        const double step = last_bit(s, falls);
        if (some_below(s, falls, 0.0) || (falls->middle.g < -noise(falls) && step == 0.0)) {
            *b = trial;
            keep_right(s);
            falls = first_to_fall(s, *b - *a, &at);
            continue;
        }
        if (!all_positive(s, at, 1)) {
            *b = trial;
            keep_right(s);
            return NULL;
        }
        *when = greater(trial + step, 0.0);
        if (step != 0.0 || falls->middle.g <= noise(falls)) {
            return falls;
        }
        *a = trial;
        keep_left(s);
        falls = first_to_fall(s, *b - *a, &at);
    }
    *when = *b;
    return all_positive(s, *b - *a, 0) ? falls : NULL;
}

int tribo_first_zero(struct first_zero *s, double longest, const struct guard **first, double *when)
{
    *first = NULL;
    if (s->guards == 0) {
        return 1;
    }
    s->looks = 0;
    double a = 0.0, better = s->bound(s->motion, 0.0), h = first_length(s, longest), at = 0.0;
    for (size_t k = 0; k < s->guards; k++) {
        struct guard *g = &s->guard[k];
        g->allowance = greater(g->allowance, greater(ALLOWED * g->size, DBL_MIN));
    }
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
        if (s->looks >= MOST_LOOKS || !(h > 0.0)) {
            return 0;
        }
        if (a >= better) {
            better = s->bound(s->motion, a);
        }
        double b = lesser(a + h, longest);
        sample(s, b);
        keep_right(s);
        struct guard *below = first_to_fall(s, b - a, &at);
        if (below) {
            *first = narrow(s, below, at, &a, &b, when);
            if (*first) {
                return 1;
            }
        } else if (all_positive(s, b - a, 0)) {
            h = 1.7 * (b - a);
            a = b;
            keep_left(s);
            continue;
        }
        h = 0.5 * (b - a);
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
