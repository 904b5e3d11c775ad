#include "search.h"
#include "../real.h"

#include <float.h>
#include <math.h>

/* A slope this far below zero, in terms of what the guard's parts do together, is no rounding. */
#define FALLS 1e-6

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

static int falls_fast(const struct guard *g)
{
    return g->size > 0.0 && g->left.d < -FALLS * g->size * sixth_root(g->bend / g->size);
}

/* Samples of all guards at the start. Of those that start at zero, rounding may say that they fall; one that really does is
 * returned. */
static const struct guard *sample_start(struct search *s)
{
    s->look(s->motion, 0.0);
    s->looks++;
    for (size_t k = 0; k < s->guards; k++) {
        struct guard *g = &s->guard[k];
        g->left = s->read(s->motion, g);
        if (g->from_zero || g->left.g <= 0.0) {
            if (g->left.d < 0.0 && falls_fast(g)) {
                return g;
            }
            g->left.g = 0.0;
            g->left.d = greater(g->left.d, 0.0);
            g->left.e = g->left.d > 0.0 ? g->left.e : greater(g->left.e, 0.0);
        }
    }
    return NULL;
}

static void sample(struct search *s, double tau)
{
    s->look(s->motion, tau);
    for (size_t k = 0; k < s->guards; k++) {
        s->guard[k].middle = s->read(s->motion, &s->guard[k]);
    }
    s->looks++;
}

/* 1 if no guard can be zero between its left sample and the next one, h later, which is middle or right. There it may be, but not
 * below. */
static int all_positive(const struct search *s, double h, int to_middle)
{
    for (size_t k = 0; k < s->guards; k++) {
        const struct guard *g = &s->guard[k];
        struct sample end = to_middle ? g->middle : g->right;
        end.g = end.g >= -noise(g) ? greater(end.g, 0.0) : end.g;
        if (!tribo_positive(&g->left, &end, h, g->bend, noise(g))) {
            return 0;
        }
    }
    return 1;
}

/* The length of interval to try first: a fraction of the guards' sizes in doubt. */
static double first_length(const struct search *s, double longest)
{
    double ratio = HUGE_VAL;
    for (size_t k = 0; k < s->guards; k++) {
        ratio = lesser(ratio, s->guard[k].bend > 0.0 ? s->guard[k].size / s->guard[k].bend : HUGE_VAL);
    }
    return lesser(sixth_root(300.0 * ratio), longest);
}

/* The guard that, among those not positive where the interval of length h ends, is the first to fall to zero as far as one can
 * tell. */
static struct guard *first_to_fall(struct search *s, double h, double *when)
{
    struct guard *first = NULL;
    for (size_t k = 0; k < s->guards; k++) {
        struct guard *g = &s->guard[k];
        if (g->right.g <= noise(g)) {
            const double guess = g->right.g >= -noise(g) ? h : tribo_root_guess(&g->left, &g->right, h);
            if (!first || guess < *when) {
                first = g;
                *when = guess;
            }
        }
    }
    return first;
}

/* The last sample becomes the left, or the right, one. */
static void keep_left(struct search *s)
{
    for (size_t k = 0; k < s->guards; k++) {
        s->guard[k].left = s->guard[k].middle;
    }
}

static void keep_right(struct search *s)
{
    for (size_t k = 0; k < s->guards; k++) {
        s->guard[k].right = s->guard[k].middle;
    }
}

/* How far a guard's zero is from its middle sample by Newton's method, if that is as good as another look; 0 if there is need of
 * one. */
static double last_bit(const struct guard *g)
{
    const double step = -g->middle.g / g->middle.d;
    return g->middle.d < 0.0 && fabs(0.5 * g->middle.e * step * step) <= noise(g) ? step : 0.0;
}

/* A guard is not positive at *b; falls seems to be the first to be so, at from *a. Narrows [*a, *b] to the first zero of all
 * guards: returns that guard, with *when, or NULL if
 * [*a, *b] must be divided to tell. */
static const struct guard *find_zero(struct search *s, struct guard *falls, double at, double *a, double *b, double *when)
{
    while (falls->right.g < -noise(falls) && *a + at > *a && *a + at < *b) {
        const double trial = *a + at;
        sample(s, trial);
        int others_below = 0;
        for (size_t k = 0; k < s->guards; k++) {
            others_below |= &s->guard[k] != falls && s->guard[k].middle.g < -noise(&s->guard[k]);
        }
        const double step = last_bit(falls);
        if (others_below || (falls->middle.g < -noise(falls) && step == 0.0)) {
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

/* The guard that is first to meet zero, and when; NULL if none does before longest. */
const struct guard *tribo_search(struct search *s, double longest, double *when)
{
    if (s->guards == 0) {
        return NULL;
    }
    double a = 0.0, h = first_length(s, longest), at = 0.0;
    const struct guard *falls = sample_start(s);
    if (falls) {
        *when = 0.0;
        return falls;
    }
    while (a < longest) {
        double b = lesser(a + h, longest);
        sample(s, b);
        keep_right(s);
        struct guard *below = first_to_fall(s, b - a, &at);
        if (below) {
            falls = find_zero(s, below, at, &a, &b, when);
            if (falls) {
                return falls;
            }
        } else if (all_positive(s, b - a, 0)) {
            h = 1.7 * (b - a);
            a = b;
            keep_left(s);
            continue;
        }
        h = 0.5 * (b - a);
        if (!(a + h > a && a + h < b)) {
            /* nothing left to divide: a guard that is below zero fell right here, and what else is in doubt is rounding */
            *when = b;
            if (below && below->right.g < -noise(below)) {
                return below;
            }
            a = b;
            keep_left(s);
        }
    }
    return NULL;
}
