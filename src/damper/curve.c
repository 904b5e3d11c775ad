/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "team.h"

enum { MOST_SAMPLES = 1000, ROUNDS = 12, CLIMBS = 12 };
static const double LEAST_WIDTH = 1.0 / 16384.0; /* of a gap between samples, relative to the whole curve */
static const double LEAST_AMPLITUDE = 1e-5;      /* of the largest one: below, it does not matter how the curve bends */

/* -------------------------------------------------------------------------------------------------------------- samples */

/* Index of the first sample at or right of x. */
static size_t index_of(const struct curve *c, double x)
{
    size_t k = 0;
    while (k < c->count && c->sample[k].x < x) {
        k++;
    }
    return k;
}

void ask_sample(struct curve *c, double x, int asked)
{
    const size_t k = index_of(c, x);
    if (k < c->count && c->sample[k].x == x) {
        c->sample[k].asked |= asked;
        return;
    }
    c->sample = need_room(c->sample, c->count, sizeof *c->sample);
    memmove(&c->sample[k + 1], &c->sample[k], (c->count - k) * sizeof *c->sample);
    c->sample[k] = (struct sample){.x = x, .asked = asked, .y = need_memory(c->record, sizeof(double))};
    c->count++;
}

static int found(const struct curve *c, size_t k)
{
    return c->sample[k].motion.found;
}

/* The nearest sample that was found, on one side of sample k; or NULL. */
static const struct sample *neighbour(const struct curve *c, size_t k, int right)
{
    while (right ? ++k < c->count : k-- > 0) {
        if (found(c, k)) {
            return &c->sample[k];
        }
    }
    return NULL;
}

/* Starts of a search: the nearer neighbour, the other one, rest; the first `tries` of them are tried until one succeeds. */
enum { NEARER = 1, ALL = 3 };
static void find_sample(struct curve *c, struct worker *w, size_t k, int tries)
{
    struct sample *s = &c->sample[k];
    const struct sample *left = neighbour(c, k, 0), *right = neighbour(c, k, 1);
    const int right_first = right && (!left || right->x - s->x < s->x - left->x);
    const struct sample *guess[] = {right_first ? right : left, right_first ? left : right, NULL};
    const double limit = c->over_limit ? exp(s->x) : c->fixed, hz = c->over_limit ? c->fixed : s->x;
    for (int i = 0; i < tries && !s->motion.found && !interrupted(); i++) {
        if (guess[i] || i == 2) {
            const size_t periods = s->motion.periods;
            s->motion = find_motion(w, limit, hz, guess[i] ? guess[i]->y : NULL, s->y);
            s->motion.periods += periods;
        }
    }
}

/* Finds the motion at x, in a sample that is there or added; returns its place. */
static size_t find_at(struct curve *c, struct worker *w, double x)
{
    ask_sample(c, x, 0);
    find_sample(c, w, index_of(c, x), ALL);
    return index_of(c, x);
}

/* ------------------------------------------------------------------------------------------------------------ refinement */

const struct sample *largest_of(const struct curve *c, enum quantity of)
{
    static const double PART = 0.3; /* of the power of the loads: less of it lost to friction is not sensitive */
    const struct sample *best = NULL;
    double most = -HUGE_VAL;
    for (size_t k = 0; k < c->count; k++) {
        const struct motion *m = &c->sample[k].motion;
        const double slip = m->friction > PART * m->input ? -m->friction / m->limit : -HUGE_VAL;
        const double value = of == AMPLITUDE ? m->amplitude : of == POWER ? m->friction : slip;
        if (m->found && value > most) {
            best = &c->sample[k];
            most = value;
        }
    }
    return best;
}

static double off_chord(const struct sample *s, double left, double middle, double right)
{
    return fabs(middle - left - (right - left) * (s[0].x - s[-1].x) / (s[1].x - s[-1].x));
}

/* 1 if the curve bends at sample k: the logarithm of the amplitude, or the power. */
static int bends(const struct curve *c, size_t k, double amplitude, double power, double tolerance)
{
    if (k == 0 || k + 1 >= c->count || !found(c, k - 1) || !found(c, k) || !found(c, k + 1)) {
        return 0;
    }
    const struct sample *s = &c->sample[k];
    double x[3], p[3];
    for (int i = 0; i < 3; i++) {
        x[i] = log(fmax(s[i - 1].motion.amplitude, LEAST_AMPLITUDE * amplitude));
        p[i] = s[i - 1].motion.friction;
    }
    return off_chord(s, x[0], x[1], x[2]) > tolerance || off_chord(s, p[0], p[1], p[2]) > tolerance * power;
}

/* Adds a sample between k and k + 1; from its motion, motions beside it that were not found are tried again. */
static void split_gap(struct curve *c, struct worker *w, size_t k)
{
    find_at(c, w, 0.5 * (c->sample[k].x + c->sample[k + 1].x));
    if (found(c, k + 1)) {
        find_sample(c, w, k, NEARER);
        find_sample(c, w, k + 2, NEARER);
    }
}

/* Adds a sample to each gap beside a bend or a motion that was not found; from the right, since samples on the left keep their
 * places then. Returns the number of samples added. */
static size_t refine(struct curve *c, struct worker *w, double tolerance)
{
    const struct sample *largest = largest_of(c, AMPLITUDE), *most = largest_of(c, POWER);
    const double amplitude = largest ? largest->motion.amplitude : 0.0, power = most ? fmax(most->motion.friction, 0.0) : 0.0;
    const double whole = c->sample[c->count - 1].x - c->sample[0].x;
    char *more = need_memory(c->count, 1);
    size_t added = 0;
    for (size_t k = 0; k + 1 < c->count; k++) {
        more[k] = c->sample[k + 1].x - c->sample[k].x > LEAST_WIDTH * whole &&
                  (found(c, k) != found(c, k + 1) || bends(c, k, amplitude, power, tolerance) ||
                   bends(c, k + 1, amplitude, power, tolerance));
    }
    for (size_t k = c->count - 1; k-- > 0;) {
        if (more[k] && c->count < MOST_SAMPLES && !interrupted()) {
            split_gap(c, w, k);
            added++;
        }
    }
    free(more);
    return added;
}

void find_curve(struct curve *c, struct worker *w, double tolerance)
{
    for (size_t k = 0; k < c->count; k++) {
        find_sample(c, w, k, ALL);
    }
    for (size_t k = c->count; k-- > 0;) {
        find_sample(c, w, k, NEARER); /* those that were not found, from the right */
    }
    for (int round = 0; round < ROUNDS && c->count > 1 && refine(c, w, tolerance) > 0; round++) {
    }
}

const struct sample *reach_sample(struct curve *c, struct worker *w, double x)
{
    size_t k = find_at(c, w, x);
    for (int i = 0; i < ROUNDS && !found(c, k) && !interrupted(); i++) {
        if (k > 0 && found(c, k - 1)) {
            split_gap(c, w, k - 1);
        } else if (k + 1 < c->count && found(c, k + 1)) {
            split_gap(c, w, k);
        }
        k = index_of(c, x);
    }
    return found(c, k) ? &c->sample[k] : NULL;
}

/* --------------------------------------------------------------------------------------------------------------- largest */

/* 1 if sample k is not below its neighbours. */
static int is_top(const struct curve *c, size_t k)
{
    const struct sample *s = &c->sample[k];
    return k > 0 && k + 1 < c->count && found(c, k - 1) && found(c, k) && found(c, k + 1) &&
           s->motion.amplitude >= s[-1].motion.amplitude && s->motion.amplitude >= s[1].motion.amplitude;
}

/* Adds samples from a top of the samples, at x, to the top of the curve: each at the top of the parabola through a sample and its
 * neighbours. */
static void climb(struct curve *c, struct worker *w, double x)
{
    const double whole = c->sample[c->count - 1].x - c->sample[0].x;
    for (int i = 0; i < CLIMBS && !interrupted() && is_top(c, index_of(c, x)); i++) {
        const struct sample *s = &c->sample[index_of(c, x)];
        const double left = s[-1].x - s[0].x, right = s[1].x - s[0].x, reached = s->motion.amplitude;
        const double a = (s[-1].motion.amplitude - reached) / left, b = (s[1].motion.amplitude - reached) / right;
        const double top = s[0].x + 0.5 * (a * right - b * left) / (a - b);
        if (!(fabs(top - x) > 1e-8 * whole)) {
            return;
        }
        const size_t k = find_at(c, w, top); /* may move the samples */
        const struct motion *there = &c->sample[k].motion;
        x = there->found && there->amplitude > reached ? top : x;
    }
}

void find_largest(struct curve *c, struct worker *w, double tolerance)
{
    const struct sample *largest = largest_of(c, AMPLITUDE);
    double *x = need_memory(c->count, sizeof *x);
    size_t tops = 0;
    for (size_t k = 0; k < c->count; k++) {
        if (is_top(c, k) && c->sample[k].motion.amplitude * (1.0 + tolerance) >= largest->motion.amplitude) {
            x[tops++] = c->sample[k].x;
        }
    }
    for (size_t i = 0; i < tops; i++) {
        climb(c, w, x[i]);
    }
    free(x);
}

size_t spread_samples(const struct curve *c, size_t most, const struct sample **chosen)
{
    size_t count = 0, passed = 0, taken = 0;
    for (size_t k = 0; k < c->count; k++) {
        count += c->sample[k].asked && found(c, k);
    }
    const size_t wanted = count < most ? count : most;
    for (size_t k = 0; k < c->count; k++) {
        if (c->sample[k].asked && found(c, k) && passed++ == (2 * taken + 1) * count / (2 * wanted)) {
            chosen[taken++] = &c->sample[k];
        }
    }
    return taken;
}

int searched(const struct sample *s)
{
    return s->motion.found || s->motion.message[0] != '\0';
}

size_t gaps_of(const struct curve *c)
{
    size_t gaps = 0;
    for (size_t k = 0; k < c->count; k++) {
        gaps += !found(c, k) && searched(&c->sample[k]);
    }
    return gaps;
}
