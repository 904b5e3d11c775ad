/* SPDX-License-Identifier: BSD-3-Clause */
/* "moreau/fixed" of structures that are a band, with contacts between bodies and the base: the same motion as when the bodies are
 * numbered in a way that leaves no band, so that the contacts are solved for as a dense problem; and what large ones cost. */
#include <stdlib.h>
#include <string.h>

#include "make.h"
#include "run.h"

enum { BODIES = 16, STATES = 2 * BODIES + 1, MOST_CONTACTS = BODIES };

/* A structure by its matrices, and what contacts and loads do; contact i is at body[i]. */
struct scene {
    size_t contacts, body[MOST_CONTACTS];
    double mass[BODIES], stiffness[BODIES * BODIES], damping[BODIES * BODIES], lever[MOST_CONTACTS], limit[MOST_CONTACTS],
        load[BODIES], motion[MOST_CONTACTS], swing[MOST_CONTACTS];
};

/* A spring between bodies, or to the ground, which is body BODIES. */
static void tie(double *k, size_t i, size_t j, double spring)
{
    k[i * BODIES + i] += spring;
    if (j < BODIES) {
        k[j * BODIES + j] += spring;
        k[i * BODIES + j] -= spring;
        k[j * BODIES + i] -= spring;
    }
}

/* Kinds: 0 any numbers, 1 all alike, 2 stiff springs, 3 some limits zero and levers negative, 4 a belt. */
static struct scene scene_create(struct random *g, int kind)
{
    struct scene s = {0};
    const size_t reach = kind == 1 ? 1 : 1 + below(g, 2);
    for (size_t i = 0; i < BODIES; i++) {
        s.mass[i] = kind == 1 ? 1.0 : log_uniform(g, 1.0);
        s.load[i] = kind == 1 ? (double)(i == 0) : uniform(g, -1.0, 1.0) * (double)(below(g, 3) == 0);
        tie(s.stiffness, i, BODIES, kind == 1 ? 0.0 : uniform(g, 0.0, 1.0));
        for (size_t j = i + 1; j <= i + reach && j < BODIES; j++) {
            tie(s.stiffness, i, j, kind == 1 ? 4.0 : kind == 2 ? 1e6 * uniform(g, 0.5, 1.0) : uniform(g, 0.0, 4.0));
            tie(s.damping, i, j, kind == 1 ? 0.0 : uniform(g, 0.0, 0.1));
        }
        if (kind == 1 || below(g, 4) > 0 || BODIES - i <= 8 - s.contacts) {
            const size_t c = s.contacts++;
            s.body[c] = i;
            s.lever[c] = kind == 1 ? 1.0 : uniform(g, 0.5, 2.0) * (kind == 3 && below(g, 2) ? -1.0 : 1.0);
            s.limit[c] = kind == 1 ? 0.05 : kind == 3 && below(g, 3) == 0 ? 0.0 : uniform(g, 0.0, 0.4);
            s.motion[c] = kind == 4 ? uniform(g, -0.5, 0.5) : 0.0;
            s.swing[c] = kind == 4 ? uniform(g, 0.0, 0.5) : 0.0;
        }
    }
    return s;
}

/* The structure, body i being number place[i]. */
static tribo_system *scene_system(const struct scene *s, const size_t *place)
{
    double mass[BODIES * BODIES] = {0}, stiffness[BODIES * BODIES], damping[BODIES * BODIES],
                         direction[MOST_CONTACTS * BODIES] = {0}, load[BODIES];
    tribo_system *sys;
    for (size_t i = 0; i < BODIES; i++) {
        mass[place[i] * (BODIES + 1)] = s->mass[i];
        load[place[i]] = s->load[i];
        for (size_t j = 0; j < BODIES; j++) {
            stiffness[place[i] * BODIES + place[j]] = s->stiffness[i * BODIES + j];
            damping[place[i] * BODIES + place[j]] = s->damping[i * BODIES + j];
        }
    }
    for (size_t c = 0; c < s->contacts; c++) {
        direction[c * BODIES + place[s->body[c]]] = s->lever[c];
    }
    assert_ok(dense_system(&sys, BODIES, s->contacts, mass, damping, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_set_limit(tribo_system_context(sys), s->limit));
    assert_ok(tribo_system_add_load(sys, 0.7, load, NULL));
    assert_ok(tribo_system_add_base_motion(sys, 1.3, s->motion, NULL));
    assert_ok(tribo_system_add_limit(sys, 0.9, NULL, s->swing));
    return sys;
}

static void renumber(const double *y, const size_t *place, double *to)
{
    for (size_t i = 0; i < BODIES; i++) {
        to[place[i]] = y[i];
        to[BODIES + place[i]] = y[BODIES + i];
    }
    to[STATES - 1] = y[STATES - 1];
}

/* Step by step, each from the same state, since rounding grows from step to step. Steps of both signs of reversal, of stick and
 * of slip are among them: how many contacts have come to rest is counted. */
TEST(numbering)
{
    enum { STEPS = 200, MIDDLE = 5 };
    struct random g = random_of(_i);
    const struct scene s = scene_create(&g, _i % 5);
    const double h = _i % 2 ? 0.05 : 0.4;
    size_t same[BODIES], mixed[BODIES], rests = 0;
    for (size_t i = 0; i < BODIES; i++) {
        same[i] = i;
        mixed[i] = i * MIDDLE % BODIES;
    }
    tribo_system *band = scene_system(&s, same), *dense = scene_system(&s, mixed);
    tribo_driver *drv = driver_create(band, "moreau/fixed", h, 0.0), *other = driver_create(dense, "moreau/fixed", h, 0.0);
    double y[STATES] = {0}, begin[STATES], end[STATES], t = 0.0;
    for (int k = 0; k < STEPS; k++) {
        const double next = (k + 1) * h;
        double time = t, largest = 1e-3;
        renumber(y, mixed, begin);
        driver_advance(drv, &t, next, y);
        driver_advance(other, &time, next, begin);
        renumber(y, mixed, end);
        for (size_t i = 0; i < STATES; i++) {
            largest = fmax(largest, fabs(end[i]));
        }
        const char *off = differences("end", end, begin, STATES, 1e-12 * largest);
        require(!off, "kind %d, step %d: %s", _i % 5, k, off);
        for (size_t c = 0; c < s.contacts && _i % 5 != 4; c++) {
            rests += y[BODIES + s.body[c]] == 0.0;
        }
    }
    require(_i % 5 == 4 || (rests > 0 && rests < STEPS * s.contacts), "%zu at rest", rests);
    tribo_driver_destroy(drv);
    tribo_driver_destroy(other);
    tribo_system_destroy(band);
    tribo_system_destroy(dense);
}
END_TEST

/* A dense operator of so many contacts would take 80 GB. The push of a step goes on through hundreds of blocks. */
TEST(long_chain)
{
    enum { BLOCKS = 100000 };
    tribo_system *sys;
    double t = 0.0, *y = calloc(2 * BLOCKS + 1, sizeof *y);
    require(y, "no memory");
    assert_ok(tribo_system_chain(&sys, BLOCKS, 0.5, 1.0, 0.7));
    tribo_driver *drv = driver_create(sys, "moreau/fixed", 0.01, 0.0);
    driver_advance(drv, &t, 0.05, y);
    ck_assert_double_gt(y[0], 0.0);
    ck_assert_double_gt(y[2 * BLOCKS], 0.0);
    assert_exact(y[BLOCKS - 1], 0.0);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    free(y);
}
END_TEST

TEST_MAIN("band", {numbering, 40}, {long_chain, 1})
