/* Walks intervals [a, b] from left to right. Where all guards are positive at both ends, quintics through both samples and the
 * bound of the sixth derivative decide whether they are positive between; if that is open, or a guard is not positive at b,
 * the interval becomes shorter: up to the first zero of the quintics, or by a part. Then only guards are sampled that the
 * longer interval leaves open. Ends of intervals are guesses: when a zero came last time, or what derivatives at a foresee.
 * What is certain comes from the bounds. Close to a zero derivatives alone find it. */
#include "first_zero.h"
#include "common/real.h"
#include "parabola.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* Looks at a phase after which it is given up: the motion has frequencies that cannot be followed. */
#define MOST_LOOKS ((size_t)1 << 24)

/* Give up at the start if MOST_LOOKS first intervals do not cover this part of the time that bounds hold. */
#define HOPELESS 1e-6

/* Reach of two derivatives, in parts of a first length. The third derivative of a sum of exponentials and sines is at most
 * sqrt(size bend) (Cauchy, Schwarz), that of powers of time at most 4.5 times this and 60 size/longest^3: over SHORT it
 * changes the guard by a tenth of noise. */
#define SHORT 1.9e-6

/* The part of an interval within which two derivatives foresee a zero to a thousandth; from just before, it is in their
 * reach. */
#define SOON 0.1

/* A zero of the quintic is that of the guard if both differ there by at most this part of noise. */
#define FINE 0.1

/* After an interval that stays open, this part of it is tried. */
#define SHRINK 0.7

/* An interval that ends at an expected zero may be longer by this factor. */
#define STRETCH 1.5

/* A guard that begins at zero is allowed to be negative by this part of its size. */
#define ALLOWED 1e-14

/* Rounding of a guard. */
static double noise(const struct guard *g)
{
    return 4.0 * DBL_EPSILON * g->size;
}

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

static void watch_all(struct first_zero *s)
{
    s->watching = s->guards;
}

static void exchange(struct guard **watched, size_t i, size_t k)
{
    struct guard *g = watched[i];
    watched[i] = watched[k];
    watched[k] = g;
}

/* Sets the middle samples of watched guards; falls = 1 if one is not above zero. */
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

/* 1 if least >= enough; then updates lowest. */
static int note_least(struct guard *g, double least, double enough)
{
    if (!(least >= enough)) {
        return 0;
    }
    g->lowest = greater(g->lowest, g->allowance - least);
    return 1;
}

/* 1 if a guard with samples from and to, h apart, is not below zero from the first one until `until` later; then updates
 * lowest. */
static int positive(struct guard *g, const struct sample *from, const struct sample *to, double h, double until)
{
    const double enough = -noise(g);
    return note_least(g, tribo_quintic_least(from, to, h, g->bend, until, enough), enough);
}

/* 1 if all watched guards are positive between the left and the middle sample, h later. */
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

/* The same from the left sample until `until` later; the right sample is h later. */
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

/* Watches only guards that may be negative between the left and right samples, h apart. */
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

/* State of an interval that ends at the middle samples: no guard is below zero in it; one is not positive at its end; open. */
enum { CLEAR, FALLS, IN_DOUBT };

static int judge(struct first_zero *s, double h)
{
    return s->falls ? FALLS : all_positive(s, h) ? CLEAR : IN_DOUBT;
}

/* The guard not positive at the right end of the interval of length h whose quintic is the first to be zero; *when = its
 * zero. */
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

/* Bound of the third derivative's part in a guard a step on: sqrt(size bend) step^3/6. */
static double cubic(const struct guard *g, double step)
{
    return sqrt(g->size) * sqrt(g->bend) * step * step * step * (1 / 6.);
}

/* 1 if the parabola at the left sample, less doubt, is not below zero until a step on. */
static int clears(struct guard *g, double step, double doubt)
{
    return note_least(g, parabola_least(&g->left, step) - doubt, -noise(g));
}

/* 1 if no other watched guard is below zero until a step after the left samples, where g is zero. */
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

/* The watched guard whose parabola at its left sample is the first to be zero within span; *step = when. NULL if there is
 * none. */
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

/* Foresees zeros by derivatives at a within SOON h. Returns the guard if it is certain to be the first; else sets expected. */
static const struct guard *foresee(struct first_zero *s, double h, double longest, double *when)
{
    double step;
    const struct guard *first = first_in_sight(s, SOON * h, &step);
    if (!first) {
        return NULL;
    }
    *when = s->a + step;
    s->expected = *when;
    return step <= s->reach && *when <= longest && is_first(s, first, step) ? first : NULL;
}

/* A guard is not positive at *b. Narrows [a, *b] to the first zero of all guards and returns that guard, with *when; NULL if
 * [a, *b] must be divided. */
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
        at = greater(at - 0.5 * s->reach, 0.5 * at);
        *when = s->a + at;
        if (!(*when > s->a && *when < *b)) {
            return NULL;
        }
        sample(s, *when);
        int below = 0;
        for (size_t k = 0; k < s->watching; k++) {
            below |= s->watched[k]->middle.g < -noise(s->watched[k]);
        }
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

/* Looks in the middle of an open interval [a, *b]. Returns the state of it, or of its first half, to which *b moves back. */
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
    for (size_t k = 0; k < s->guards; k++) {
        s->watched[k]->middle = s->watched[k]->right;
    }
    return CLEAR;
}

/* Finds bounds from a on, the reach of derivatives by them, and a length of interval to try. */
static void find_bounds(struct first_zero *s)
{
    s->better = s->motion->bound(s->own, s->a);
    double ratio = HUGE_VAL;
    for (size_t k = 0; k < s->guards; k++) {
        const struct guard *g = &s->guard[k];
        ratio = lesser(ratio, g->bend > 0.0 ? g->size / g->bend : HUGE_VAL);
    }
    const double length = lesser(sixth_root(400.0 * ratio), s->longest);
    s->reach = SHORT * length;
    s->h = greater(s->h, length);
}

/* The time to look at next: just before an expected zero, unless that is too far. */
static double next_look(const struct first_zero *s)
{
    const double before = s->expected - greater(0.5 * s->reach, s->early);
    const int sensible = before > s->a && before < lesser(s->a + s->most, s->longest);
    return sensible ? before : lesser(s->a + s->h, s->longest);
}

/* The velocity that is first to fall to zero within reach of the derivatives at the start, with *when; NULL if there is none.
 * A motion that becomes large until longest hides this zero in its rounding. A velocity that is rounding beside others does
 * not count. */
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

/* Looks at the start; returns a guard that is zero there, or at once, or NULL. */
static const struct guard *start(struct first_zero *s, double *when)
{
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

/* Samples all guards at a, where only some have left samples. */
static void come_to(struct first_zero *s)
{
    watch_all(s);
    sample(s, s->a);
    keep_left(s);
}

/* No guard is zero until b, where the middle samples are: moves a there; returns a guard if its zero is in reach. */
static const struct guard *pass_interval(struct first_zero *s, double b, double *when)
{
    watch_all(s);
    /* with care near the length that bounds allow */
    s->h = greater(s->h, (SHORT * (b - s->a) < 0.5 * s->reach ? 1.7 : 1.15) * (b - s->a));
    s->most = STRETCH * s->h;
    s->a = b;
    keep_left(s);
    const struct guard *first = foresee(s, s->h, s->longest, when);
    return first;
}

/* In an interval up to b too short to be divided: returns the guard below zero at b, if there is one. Else the doubt is
 * rounding, and a moves to b. */
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

/* The interval up to *b, where the middle samples are, is not clear: returns CLEAR if another look makes it so; or finds the
 * first guard in it; or shortens it. */
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
