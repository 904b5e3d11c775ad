/* SPDX-License-Identifier: BSD-3-Clause */
/* The search for the first of many functions that falls to zero, of sums of sines that decay, whose zeros are known or looked for
 * point by point, with whatever is expected. */
#include <math.h>

#include "support.h"
#include "dynamics/events/first_zero.h"

enum { MOST_GUARDS = 6, TERMS = 3, POINTS = 4000, CASES = 100 };

/* size times e^{-decay t} cos(omega t + phase). */
struct term {
    double size, decay, omega, phase;
};

struct course {
    double offset, ramp;
    struct term term[TERMS];
};

struct scene {
    size_t guards;
    struct course course[MOST_GUARDS];
    double scale, unit; /* values are so many times as large, times too */
    double longest;
    int broken; /* a look sees what is not a number from 1 on */
    struct first_zero search;
    struct guard guard[MOST_GUARDS], *watched[MOST_GUARDS];
};

/* The k-th derivative by time in units. */
static double derivative(const struct course *c, double t, int k)
{
    double sum = k == 0 ? c->offset + c->ramp * t : k == 1 ? c->ramp : 0.0;
    for (int n = 0; n < TERMS; n++) {
        const struct term *w = &c->term[n];
        const double size = w->size * pow(hypot(w->decay, w->omega), k) * exp(-w->decay * t);
        sum += size == 0.0 ? 0.0 : size * cos(w->omega * t + w->phase + k * atan2(w->omega, -w->decay));
    }
    return sum;
}

static void look(void *own, double tau, size_t guards, struct guard *const *guard)
{
    const struct scene *s = own;
    const double t = tau / s->unit;
    for (size_t k = 0; k < guards; k++) {
        const struct course *c = &s->course[guard[k]->contact];
        const double g = s->broken && t > 1.0 ? (double)NAN : derivative(c, t, 0);
        guard[k]->middle = (struct sample){s->scale * g, s->scale * derivative(c, t, 1) / s->unit,
                                           s->scale * derivative(c, t, 2) / s->unit / s->unit};
    }
}

static double bound(void *own, double tau)
{
    struct scene *s = own;
    for (size_t k = 0; k < s->guards; k++) {
        const struct course *c = &s->course[k];
        struct guard *g = &s->guard[k];
        g->size = s->scale * (fabs(c->offset) + fabs(c->ramp) * s->longest);
        g->bend = 0.0;
        for (int n = 0; n < TERMS; n++) {
            const struct term *w = &c->term[n];
            const double size = s->scale * w->size * exp(-w->decay * tau / s->unit);
            g->size += size;
            g->bend += size * pow(hypot(w->decay, w->omega) / s->unit, 6.0);
        }
    }
    return tau > 0.0 ? 2.0 * tau : s->unit;
}

/* What is found: when, in units; longest if nothing is. */
static double find(struct scene *s, double expected, const struct guard **first)
{
    double when;
    static const struct motion motion = {.look = look, .bound = bound};
    s->search = (struct first_zero){.guards = s->guards,
                                    .guard = s->guard,
                                    .watched = s->watched,
                                    .motion = &motion,
                                    .own = s,
                                    .expected = expected * s->unit,
                                    .resolution = 1e-30 * s->unit};
    for (size_t k = 0; k < s->guards; k++) {
        s->guard[k] = (struct guard){.contact = k};
    }
    require(tribo_first_zero(&s->search, s->longest * s->unit, first, &when), "lost after %zu looks", s->search.looks);
    return *first ? when / s->unit : s->longest;
}

/* One guard, of the difference between a constant and a cosine. */
static struct scene cosine(double offset, double size)
{
    return (struct scene){1, {{offset, 0.0, {{size, 0.0, 1.0, 0.0}}}}, 1.0, 1.0, 20.0, 0, {0}, {{0}}, {NULL}};
}

/* Whatever is expected, a zero is found there, or none. */
static void finds(struct scene *s, int any, double when, double within)
{
    const double expected[] = {0.0, 0.5, when, when + 1e-3, when - 1e-5, 3.0 * when};
    for (size_t k = 0; k < COUNT(expected); k++) {
        const struct guard *first;
        const double at = find(s, expected[k], &first);
        require(any == (first != NULL), "expected %g: %s at %.17g", expected[k], first ? "found" : "nothing", at);
        require(!any || fabs(at - when) <= within, "expected %g, scale %g, unit %g: %.17g, not %.17g", expected[k], s->scale,
                s->unit, at, when);
    }
}

TEST(single_zero)
{
    struct scene s = cosine(0.0, 1.0);
    finds(&s, 1, 0.5 * PI, 1e-14);
    s = cosine(0.5, 1.0);
    finds(&s, 1, 2.0 * PI / 3.0, 1e-14);
}

/* Just below zero there are two close ones, of which the first is found; just above there is none. */
TEST(double_roots)
{
    for (double gap = 1e-2; gap > 1e-13; gap *= 0.1) {
        struct scene s = cosine(1.0 + gap, 1.0);
        finds(&s, 0, 0.0, 0.0);
        s = cosine(1.0 - gap, 1.0);
        finds(&s, 1, acos(gap - 1.0), 1e-14 / sqrt(gap));
    }
}

/* Of two guards that bend differently the one that falls a moment before the other. */
TEST(two_guards_at_nearly_the_same_time)
{
    const double when = 0.5 * PI - 0.05;
    for (double apart = 1e-1; apart > 1e-13; apart *= 0.1) {
        for (int side = -1; side <= 1; side += 2) {
            struct scene s = cosine(0.0, 1.0);
            s.guards = 2;
            s.course[0].term[0].phase = 0.05 + side * apart;
            s.course[1].term[0] = (struct term){0.5, 0.0, 2.0, 0.1 - 0.5 * PI};
            finds(&s, 1, when - fmax(side * apart, 0.0), 1e-14);
        }
    }
}

TEST(roots_at_the_ends)
{
    struct scene s = cosine(0.0, 1.0);
    s.longest = 0.5 * PI + 1e-9;
    finds(&s, 1, 0.5 * PI, 1e-14);
    s.longest = 0.5 * PI - 1e-9;
    finds(&s, 0, 0.0, 0.0);
}

/* A guard that begins at zero and rises is not taken for one that falls. */
TEST(zero_at_the_start)
{
    struct scene s = cosine(0.0, 1.0);
    s.course[0].term[0].phase = -0.5 * PI;
    finds(&s, 1, PI, 2e-13);
}

/* A fast sine that hardly counts, and a line. */
TEST(tiny_fast_term)
{
    struct scene s = cosine(1.0, 0.0);
    s.course[0].ramp = -0.25;
    s.course[0].term[1] = (struct term){1e-20, 0.0, 300.0, 0.0};
    finds(&s, 1, 4.0, 1e-13);
}

TEST(whatever_the_scale)
{
    for (double scale = 1e-150; scale <= 1e150; scale *= 1e75) {
        for (double unit = 1e-20; unit <= 1e20; unit *= 1e10) {
            struct scene s = cosine(0.5, 1.0);
            s.scale = scale;
            s.unit = unit;
            finds(&s, 1, 2.0 * PI / 3.0, 1e-14);
        }
    }
}

static void draw(struct random *r, struct scene *s)
{
    *s = (struct scene){.guards = 1 + below(r, MOST_GUARDS), .scale = 1.0, .unit = 1.0, .longest = 20.0};
    for (size_t k = 0; k < s->guards; k++) {
        struct course *c = &s->course[k];
        for (int n = 0; n < TERMS; n++) {
            c->term[n] = (struct term){uniform(r, 0.0, 1.0), n == 0 ? uniform(r, 0.0, 0.3) : 0.0, uniform(r, 0.1, 6.0),
                                       uniform(r, 0.0, 2.0 * PI)};
        }
        c->offset = uniform(r, 0.0, 2.0) - fmin(derivative(c, 0.0, 0), 0.0);
    }
}

static double lowest_at(const struct scene *s, double t)
{
    double least = HUGE_VAL;
    for (size_t k = 0; k < s->guards; k++) {
        least = fmin(least, derivative(&s->course[k], t, 0));
    }
    return least;
}

static double lowest_until(const struct scene *s, double end)
{
    double least = HUGE_VAL;
    for (int k = 0; k <= POINTS; k++) {
        least = fmin(least, lowest_at(s, end * k / POINTS));
    }
    return least;
}

/* Nobody is below zero before what is found, point by point, and the guard found is zero there. */
static int find_rightly(struct scene *s, double expected)
{
    const struct guard *first;
    const double at = find(s, expected, &first), least = lowest_until(s, at);
    require(least >= -1e-13, "%g before %.17g", least, at);
    require(!first || fabs(derivative(&s->course[first->contact], at, 0)) <= 1e-13, "not zero at %.17g", at);
    return first != NULL;
}

TEST(none_is_missed)
{
    struct random r = random_of(_i);
    int found = 0;
    for (int n = 0; n < CASES; n++) {
        struct scene s;
        draw(&r, &s);
        found += find_rightly(&s, n % 3 == 0 ? uniform(&r, 0.0, 20.0) : 0.0);
    }
    require(found > CASES / 4 && found < CASES, "%d found", found);
}

/* All guards are moved so that the lowest of them just leaves zero alone, or just does not. */
TEST(near_touch)
{
    struct random r = random_of(_i);
    int found = 0;
    for (int n = 0; n < CASES; n++) {
        struct scene s;
        draw(&r, &s);
        const double lift = pow(10.0, uniform(&r, -12.0, -1.0)) * (n % 4 < 2 ? 1.0 : -1.0) - lowest_until(&s, s.longest);
        for (size_t k = 0; k < s.guards; k++) {
            s.course[k].offset += lift;
        }
        if (lowest_at(&s, 0.0) > 0.0) {
            found += find_rightly(&s, 0.0);
        }
    }
    require(found > CASES / 4 && found < CASES, "%d found", found);
}

TEST(not_finite)
{
    struct scene s = cosine(2.0, 1.0);
    const struct guard *first;
    double when;
    s.broken = 1;
    s.longest = 0.5;
    (void)find(&s, 0.0, &first);
    require(tribo_first_zero(&s.search, 20.0, &first, &when) == 0, "found");
}

TEST_MAIN("first_zero", {single_zero, 1}, {double_roots, 1}, {two_guards_at_nearly_the_same_time, 1}, {roots_at_the_ends, 1},
          {zero_at_the_start, 1}, {tiny_fast_term, 1}, {whatever_the_scale, 1}, {none_is_missed, 8}, {near_touch, 8},
          {not_finite, 1})
