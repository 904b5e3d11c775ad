/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes in which everything coincides that can: equal limits, or limits that differ by rounding or little more, in packs and
 * chains from rest and released; contacts that repeat each other, or hold one body to bases that part; loads that just reach a
 * limit; limits that follow a table; light bodies between heavy ones; early and late. The closed form (in one advance and in
 * many), the event-driven series and central differences have to agree, and none may fail.
 *
 * TRIBO_SEED and TRIBO_BLOCKS as in random.c; with TRIBO_TABLE set, a line a kind tells the largest differences. */
#include <stdio.h>
#include <string.h>

#include "structure.h"
#include "../set_up_driver.h"

#define BLOCK 25
#define DURATION 8.0
#define STEP 1e-3
#define CUTS 40

#define KNOTS 5

struct scene {
    struct structure structure;
    size_t swings; /* harmonics of the limits */
    struct wave swing[2];
    int table; /* limits follow this, from DURATION KNOTS on constant */
    double time[KNOTS], limit[KNOTS * MOST_CONTACTS];
};

static int chance(struct random *g, double p)
{
    return uniform(g, 0.0, 1.0) < p;
}

static double any_of(struct random *g, const double *values, size_t n)
{
    return values[below(g, n)];
}

/* ------------------------------------------------------------------------------------------------------- ingredients */

/* From body i to body j, or to the ground if j is none. */
static void add_spring(struct structure *s, size_t i, size_t j, double k)
{
    const size_t n = s->ndof;
    s->stiffness[i * n + i] += k;
    if (j < n) {
        s->stiffness[j * n + j] += k;
        s->stiffness[i * n + j] -= k;
        s->stiffness[j * n + i] -= k;
    }
}

/* Bodies in a row: alike, or masses and springs at random. */
static void make_row(struct structure *s, struct random *g, size_t n, int alike)
{
    s->ndof = n;
    for (size_t i = 0; i < n; i++) {
        s->mass[i * n + i] = alike ? 1.0 : uniform(g, 0.5, 2.0);
        add_spring(s, i, n, alike ? 1.0 : uniform(g, 0.5, 2.0));
        if (i) {
            add_spring(s, i, i - 1, alike ? 0.5 : uniform(g, 0.2, 1.0));
        }
    }
}

/* Contact i is of body `body` with the ground, or with the body below. */
static void connect(struct structure *s, size_t i, size_t body, int on_body_below)
{
    s->direction[i * s->ndof + body] = 1.0;
    if (on_body_below && body) {
        s->direction[i * s->ndof + body - 1] = -1.0;
    }
}

/* 1, but for rounding, or a little more. */
static double nearly_one(struct random *g, size_t how)
{
    const double apart[] = {0.0, 0.0, 1e-12, 1e-9, 1e-6, 1e-3};
    return how == 1 ? 1.0 + 1e-15 * ((double)below(g, 5) - 2.0) : 1.0 + apart[how] * uniform(g, -1.0, 1.0);
}

/* On one body, on all, or on both ends. */
static void add_load(struct structure *s, struct random *g, double size)
{
    const double omegas[] = {0.3, 0.5, 0.7, 1.0, 2.0};
    const size_t where = below(g, 4), at = below(g, s->ndof);
    s->load[0].omega = any_of(g, omegas, COUNT(omegas));
    for (size_t i = 0; i < s->ndof; i++) {
        const int loaded = where == 0 ? i == at : where == 1 ? i + 1 == s->ndof : where == 2 ? 1 : i == 0 || i + 1 == s->ndof;
        s->load[0].sine[i] = loaded ? size : 0.0;
        s->load[0].cosine[i] = loaded && where == 0 && chance(g, 0.5) ? size : 0.0;
    }
}

/* ------------------------------------------------------------------------------------------------------------- scenes */

static void make_equal_limits(struct scene *c, struct random *g, int piled)
{
    struct structure *s = &c->structure;
    const size_t how = below(g, 6);
    make_row(s, g, 2 + below(g, 7), chance(g, 0.5));
    s->ncontact = s->ndof;
    for (size_t i = 0; i < s->ncontact; i++) {
        connect(s, i, i, piled);
        s->limit[i] = 0.2 * nearly_one(g, how);
    }
    s->damped = chance(g, 0.3);
    for (size_t k = 0; k < s->ndof * s->ndof; k++) {
        s->damping[k] = 0.03 * s->stiffness[k];
    }
}

static void pack(struct scene *c, struct random *g)
{
    make_equal_limits(c, g, 1);
    add_load(&c->structure, g, chance(g, 0.7) ? 1.0 : uniform(g, 0.3, 3.0));
}

static void chain(struct scene *c, struct random *g)
{
    make_equal_limits(c, g, 0);
    add_load(&c->structure, g, chance(g, 0.7) ? 1.0 : uniform(g, 0.3, 3.0));
}

static void released(struct scene *c, struct random *g)
{
    struct structure *s = &c->structure;
    make_equal_limits(c, g, chance(g, 0.5));
    const double size = chance(g, 0.5) ? 1.0 : uniform(g, 0.3, 3.0);
    const size_t shape = below(g, 4), from = below(g, 3); /* positions, velocities, both */
    for (size_t i = 0; i < s->ndof; i++) {
        const double x = shape == 0   ? 1.0
                         : shape == 1 ? (double)(i + 1 == s->ndof)
                         : shape == 2 ? (i % 2 ? 1.0 : -1.0)
                                      : (double)i / (double)s->ndof;
        s->start[i] = from != 1 ? size * x : 0.0;
        s->start[s->ndof + i] = from != 0 ? size * x : 0.0;
    }
}

static void belt(struct scene *c, struct random *g)
{
    const double limits[] = {1e-7, 0.1, 0.2, 0.25, 0.5, 1.0, 2.0}, kappas[] = {0.5, 1.0, 2.0, 4.0},
                 omegas[] = {0.0, 0.25, 0.5, 1.0, 2.0};
    struct structure *s = &c->structure;
    s->ndof = s->ncontact = 2;
    s->mass[0] = s->mass[3] = s->stiffness[0] = 1.0;
    s->stiffness[3] = any_of(g, kappas, COUNT(kappas));
    connect(s, 0, 0, 0);
    connect(s, 1, 1, 1);
    s->limit[0] = any_of(g, limits, COUNT(limits));
    s->limit[1] = any_of(g, limits, COUNT(limits));
    s->motion[0].omega = any_of(g, omegas, COUNT(omegas));
    s->motion[0].sine[0] = 1.0;
    s->motion[0].cosine[0] = chance(g, 0.3) ? 1.0 : 0.0;
}

/* Loads, or springs, that meet a limit, or exceed it by next to nothing. */
static void grazing(struct scene *c, struct random *g)
{
    const double beyond[] = {0.0,   2.2e-16, -2.2e-16, 1e-15, -1e-15, 1e-14, -1e-14, 1e-13,
                             1e-12, -1e-12,  1e-11,    1e-10, -1e-10, 1e-9,  -1e-9};
    struct structure *s = &c->structure;
    const int alike = chance(g, 0.5), piled = chance(g, 0.5);
    const double by = 1.0 + any_of(g, beyond, COUNT(beyond));
    make_row(s, g, 1 + below(g, 3), alike);
    s->ncontact = s->ndof;
    for (size_t i = 0; i < s->ncontact; i++) {
        connect(s, i, i, piled);
        s->limit[i] = alike ? 0.5 : uniform(g, 0.3, 1.0);
    }
    const size_t last = s->ndof - 1, kind = below(g, 4);
    const double peak = s->limit[last] * by;
    if (kind == 0) {
        s->load[0].cosine[last] = peak;
    } else if (kind == 1) {
        s->load[0].omega = 1.0;
        s->load[0].sine[last] = peak;
    } else if (kind == 2) {
        s->load[0].omega = 0.7;
        s->load[0].sine[last] = 0.5 * peak;
        s->load[1].omega = 2.1;
        s->load[1].sine[last] = -0.5 * peak;
    } else {
        for (size_t i = 0; i < s->ndof; i++) {
            s->start[i] = s->limit[i] * by / s->stiffness[i * s->ndof + i];
        }
    }
}

static void whole_numbers(struct scene *c, struct random *g)
{
    c->structure = structure_even((int)below(g, 1 << 30));
}

/* Several contacts hold one body to bases that now and then move alike. */
static void parting_bases(struct scene *c, struct random *g)
{
    struct structure *s = &c->structure;
    make_row(s, g, 1 + below(g, 3), 1);
    s->ncontact = s->ndof + 1 + below(g, 2);
    s->motion[0].omega = 1.0;
    s->motion[1].omega = chance(g, 0.5) ? 2.0 : 0.5;
    for (size_t i = 0; i < s->ncontact; i++) {
        connect(s, i, i % s->ndof, 0);
        s->direction[i * s->ndof + i % s->ndof] *= chance(g, 0.5) ? 1.0 : -1.0;
        s->limit[i] = chance(g, 0.5) ? 0.5 : uniform(g, 0.1, 1.0);
        for (size_t k = 0; k < 2; k++) {
            s->motion[k].sine[i] = (double)below(g, 3) - 1.0;
            s->motion[k].cosine[i] = chance(g, 0.3) ? 1.0 - 2.0 * (double)k : 0.0;
        }
    }
    if (chance(g, 0.5)) {
        add_load(s, g, 1.0);
    }
}

static void doubled(struct scene *c, struct random *g)
{
    struct structure *s = &c->structure;
    const size_t how = below(g, 6);
    const int piled = chance(g, 0.5);
    make_row(s, g, 1 + below(g, 4), 1);
    s->ncontact = 2 * s->ndof;
    for (size_t i = 0; i < s->ncontact; i++) {
        connect(s, i, i % s->ndof, piled);
        s->limit[i] = 0.1 * nearly_one(g, how);
    }
    add_load(s, g, 1.0);
}

static void limit_table(struct scene *c, struct random *g)
{
    struct structure *s = &c->structure;
    const int even = chance(g, 0.5);
    make_row(s, g, 1 + below(g, 3), 1);
    s->ncontact = s->ndof + 1 + below(g, 2);
    for (size_t i = 0; i < s->ncontact; i++) {
        connect(s, i, i % s->ndof, chance(g, 0.4));
    }
    if (chance(g, 0.4)) {
        for (size_t i = 0; i < s->ndof; i++) {
            s->start[i] = uniform(g, -1.0, 1.0);
        }
    }
    add_load(s, g, 1.0);
    for (size_t k = 0; k < 2 && chance(g, 0.5); k++) {
        const double omegas[] = {0.5, 1.0, 2.0};
        s->motion[k].omega = any_of(g, omegas, COUNT(omegas));
        for (size_t i = 0; i < s->ncontact; i++) {
            s->motion[k].sine[i] = i < s->ndof || chance(g, 0.7) ? 1.0 : 0.5;
        }
    }
    c->table = 1;
    for (size_t k = 0; k < KNOTS; k++) {
        const double time[KNOTS] = {0.0, 1.0, 2.5, 4.0, 8.0};
        c->time[k] = time[k];
        for (size_t i = 0; i < s->ncontact; i++) {
            c->limit[k * s->ncontact + i] = even ? 0.25 * (double)below(g, 4) : uniform(g, 0.0, 1.0);
        }
    }
}

/* Limits that swing, with small whole numbers and all alike, or at random: contacts lift off and touch down, alone and together,
 * graze, and meet loads that do the same. */
static void swinging_limits(struct scene *c, struct random *g)
{
    const double omegas[] = {0.0, 0.5, 1.0, 2.0}, sizes[] = {0.0, 0.25, 0.5, 0.5, -0.5, 1.0};
    struct structure *s = &c->structure;
    const int even = chance(g, 0.6), alike = chance(g, 0.5);
    make_row(s, g, 1 + below(g, 4), even);
    s->ncontact = s->ndof + below(g, 3);
    const double limit = any_of(g, sizes, COUNT(sizes)), cosine = any_of(g, sizes, COUNT(sizes)),
                 sine = any_of(g, sizes, COUNT(sizes));
    for (size_t i = 0; i < s->ncontact; i++) {
        connect(s, i, i % s->ndof, chance(g, 0.4));
        s->limit[i] = fabs(alike ? limit : even ? any_of(g, sizes, COUNT(sizes)) : uniform(g, 0.0, 1.0));
        for (size_t k = 0; k < 2; k++) {
            c->swing[k].cosine[i] = k ? 0.0 : alike ? cosine : even ? any_of(g, sizes, COUNT(sizes)) : uniform(g, -1.0, 1.0);
            c->swing[k].sine[i] = alike && !k ? sine : even ? any_of(g, sizes, COUNT(sizes)) : uniform(g, -1.0, 1.0);
        }
    }
    c->swings = 2;
    c->swing[0].omega = any_of(g, omegas, COUNT(omegas));
    c->swing[1].omega = any_of(g, omegas, COUNT(omegas));
    if (chance(g, 0.7)) {
        add_load(s, g, chance(g, 0.5) ? 1.0 : uniform(g, 0.2, 2.0));
    }
    if (chance(g, 0.3)) {
        s->motion[0].omega = any_of(g, omegas, COUNT(omegas));
        s->motion[0].sine[0] = 1.0;
        s->motion[0].cosine[0] = chance(g, 0.5) ? 0.5 : 0.0;
    }
    if (chance(g, 0.5)) {
        for (size_t i = 0; i < s->ndof; i++) {
            s->start[i] = even ? 0.5 * (double)below(g, 4) : uniform(g, -1.0, 1.0);
        }
    }
}

/* Every other body weighs next to nothing, on a spring that fits it; loads are on the others. */
static void light_and_heavy(struct scene *c, struct random *g)
{
    struct structure *s = &c->structure;
    const double ratio = pow(10.0, uniform(g, 0.0, 16.0));
    const size_t light = below(g, 2), n = 2 + below(g, 4);
    s->ndof = s->ncontact = n;
    s->load[0].omega = 0.5;
    s->load[1].omega = 0.7;
    for (size_t i = 0; i < n; i++) {
        s->mass[i * n + i] = i % 2 == light ? 1.0 / ratio : 1.0;
        add_spring(s, i, n, s->mass[i * n + i]);
        connect(s, i, i, 1);
        s->limit[i] = uniform(g, 0.1, 0.5);
        s->load[0].sine[i] = i % 2 == light ? 0.0 : uniform(g, -1.0, 1.0);
        s->load[1].sine[i] = i % 2 == light ? 0.0 : 1.0;
    }
}

/* ---------------------------------------------------------------------------------------------------------- agreement */

static const struct kind {
    const char *name;
    void (*make)(struct scene *, struct random *);
    double duration;
} kinds[] = {{"pack, equal limits", pack, DURATION},
             {"chain, equal limits", chain, DURATION},
             {"released", released, DURATION},
             {"belt", belt, DURATION},
             {"grazing", grazing, DURATION},
             {"whole numbers", whole_numbers, 20.0},
             {"parting bases", parting_bases, DURATION},
             {"doubled contacts", doubled, DURATION},
             {"limit table", limit_table, DURATION},
             {"swinging limits", swinging_limits, DURATION},
             {"light and heavy", light_and_heavy, DURATION}};

/* What a motion is compared by: largest differences, and how far it strays from Coulomb's law. */
struct apart {
    double cut, event, central, excess;
    size_t scenes;
};

static struct apart worst[COUNT(kinds)];

/* y after so many advances. Returns how far the motion strayed from the law, as far as the method knows. */
static double move(const struct scene *c, double duration, int seed, const struct kind *kind, const char *method, int cuts,
                   double *y)
{
    const struct structure *s = &c->structure;
    const double dt = strcmp(method, "central/fixed") == 0 ? STEP : 1.0;
    tribo_system *sys = structure_system(s);
    tribo_driver *drv = NULL;
    double t = s->begin, excess = 0.0;
    if (c->table) {
        assert_ok(tribo_system_set_limit_table(sys, KNOTS, c->time, c->limit));
    }
    for (size_t k = 0; k < c->swings; k++) {
        assert_ok(tribo_system_add_limit(sys, c->swing[k].omega, c->swing[k].cosine, c->swing[k].sine));
    }
    memcpy(y, s->start, (2 * s->ndof + 1) * sizeof *y);
    assert_ok(set_up_driver(&drv, sys, method, dt, 1e-12, 1e-12));
    for (int k = 1; k <= cuts; k++) {
        const int status = tribo_driver_advance(drv, &t, s->begin + duration * k / cuts, y);
        require(status == TRIBO_OK, "%s, seed %d, %s: %d at t = %g: %s", kind->name, seed, method, status, t,
                tribo_driver_message(drv));
    }
    tribo_driver_real(drv, TRIBO_REAL_EXCESS, &excess);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    return excess;
}

static void within(const struct kind *kind, int seed, const char *what, double *most, double off, double allowed)
{
    *most = fmax(*most, off);
    require(off <= allowed, "%s, seed %d: %s differs by %.3g", kind->name, seed, what, off);
}

static void agree(size_t k, int seed)
{
    const struct kind *kind = &kinds[k];
    struct random g = random_of(1000 * seed + (int)k);
    struct scene c;
    double want[MOST_STATES], cut[MOST_STATES], event[MOST_STATES], central[MOST_STATES];
    memset(&c, 0, sizeof c);
    kind->make(&c, &g);
    c.structure.begin = c.table ? 0.0 : any_of(&g, (const double[]){0.0, 0.0, 1e3, 1e6}, 4);
    const size_t n = 2 * c.structure.ndof + 1;
    const double excess[] = {move(&c, kind->duration, seed, kind, "exact", 1, want),
                             move(&c, kind->duration, seed, kind, "exact", CUTS, cut),
                             move(&c, kind->duration, seed, kind, "event", 1, event)};
    move(&c, kind->duration, seed, kind, "central/fixed", 1, central);
    const double size = fmax(size_of(want, n), 1e-2);
    within(kind, seed, "the same in pieces", &worst[k].cut, distance(cut, want, n) / size, 1e-10);
    within(kind, seed, "event", &worst[k].event, distance(event, want, n) / size, 1e-9);
    within(kind, seed, "central/fixed", &worst[k].central, distance(central, want, n) / size, 5e-3);
    within(kind, seed, "Coulomb's law", &worst[k].excess, fmax(excess[0], fmax(excess[1], excess[2])), 1e-11);
    worst[k].scenes++;
}

TEST(methods_agree)
{
    const int first = setting("TRIBO_SEED", 0) + BLOCK * _i;
    for (size_t k = 0; k < COUNT(kinds); k++) {
        for (int seed = first; seed < first + BLOCK; seed++) {
            agree(k, seed);
        }
    }
}

/* All blocks in one process, since Check's forks keep what they find to themselves. */
TEST(table)
{
    for (int block = 0; block < setting("TRIBO_TABLE", 0); block++) {
        for (size_t k = 0; k < COUNT(kinds); k++) {
            for (int seed = BLOCK * block; seed < BLOCK * (block + 1); seed++) {
                agree(k, setting("TRIBO_SEED", 0) + seed);
            }
        }
    }
    for (size_t k = 0; k < COUNT(kinds) && setting("TRIBO_TABLE", 0); k++) {
        const struct apart *a = &worst[k];
        printf("| %-19s | %6zu | %.1e | %.1e | %.1e | %.1e |\n", kinds[k].name, a->scenes, a->cut, a->event, a->central,
               a->excess);
    }
}

int main(void)
{
    const int tabled = setting("TRIBO_TABLE", 0) > 0;
    const struct test tests[] = {{table, 1}, {methods_agree, setting("TRIBO_BLOCKS", 1)}};
    return run_suite("degenerate", tests, tabled ? 1 : 2);
}
