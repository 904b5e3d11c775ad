/* SPDX-License-Identifier: BSD-3-Clause */
/* Random scenes of planar contacts, on the ground and between bodies, by method "event": a scene that is turned, mirrored, or has
 * bodies and contacts in another order moves as the one it came from does; on a line a planar contact is a scalar one; and what
 * loads give is found in the structure or dissipated. TRIBO_SEED and TRIBO_BLOCKS as in random.c. */
#include <stdio.h>
#include <string.h>

#include "structure.h"
#include "../set_up_driver.h"

#define BLOCK 10
#define BODIES 3 /* at most */
#define TOLERANCE 1e-11
#define NEAR 1e-8

enum { TURNED, REORDERED, ON_A_LINE, CONSTANT_LOADS, KINDS };

static int chance(struct random *g, double p)
{
    return uniform(g, 0.0, 1.0) < p;
}

/* ------------------------------------------------------------------------------------------------------------- scenes */

/* A spring between bodies i and j, or the ground if that is none, in all directions alike or not. */
static void add_spring(struct structure *s, struct random *g, size_t i, size_t j, int line)
{
    const size_t n = s->ndof;
    const double a = uniform(g, 0.1, 2.0), b = uniform(g, 0.1, 2.0), c = line ? 0.0 : uniform(g, -0.5, 0.5) * sqrt(a * b);
    const double k[] = {a, c, c, b};
    for (size_t e = 0; e < 4; e++) {
        const size_t x = 2 * i + e / 2, y = 2 * i + e % 2, u = 2 * j + e / 2, v = 2 * j + e % 2;
        s->stiffness[x * n + y] += k[e];
        if (u < n) {
            s->stiffness[u * n + v] += k[e];
            s->stiffness[x * n + v] -= k[e];
            s->stiffness[u * n + y] -= k[e];
        }
    }
}

/* Contact k holds body k, to the ground or another body. */
static void add_contact(struct structure *s, struct random *g, size_t k)
{
    const size_t n = s->ndof, other = k && chance(g, 0.6) ? below(g, k) : n;
    const double limit = uniform(g, 0.1, 1.0);
    for (size_t d = 0; d < 2; d++) {
        s->direction[(2 * k + d) * n + 2 * k + d] = 1.0;
        s->limit[2 * k + d] = limit;
        if (other < n) {
            s->direction[(2 * k + d) * n + 2 * other + d] = -1.0;
        }
    }
}

/* Numbers along x only, if all happens on a line. */
static void fill(struct random *g, double size, double *to, size_t n, int line)
{
    for (size_t i = 0; i < n; i++) {
        to[i] = line && i % 2 ? 0.0 : uniform(g, -size, size);
    }
}

static struct structure scene(int seed, int kind)
{
    struct random g = random_of(KINDS * seed + kind);
    const size_t bodies = 1 + below(&g, BODIES), contacts = 1 + below(&g, bodies), n = 2 * bodies;
    struct structure s = {.ndof = n, .ncontact = 2 * contacts, .damped = kind != CONSTANT_LOADS && chance(&g, 0.3)};
    const int line = kind == ON_A_LINE, belts = kind != CONSTANT_LOADS && chance(&g, 0.4);
    for (size_t i = 0; i < bodies; i++) {
        s.mass[2 * i * (n + 1)] = s.mass[(2 * i + 1) * (n + 1)] = uniform(&g, 0.5, 2.0);
        add_spring(&s, &g, i, n, line);
        if (i) {
            add_spring(&s, &g, i, i - 1, line);
        }
    }
    for (size_t k = 0; k < n * n; k++) {
        s.damping[k] = 0.05 * s.stiffness[k];
    }
    for (size_t k = 0; k < contacts; k++) {
        add_contact(&s, &g, k);
    }
    for (size_t w = 0; w < 2; w++) {
        s.load[w].omega = kind == CONSTANT_LOADS ? 0.0 : uniform(&g, 0.3, 2.0);
        s.motion[w].omega = uniform(&g, 0.3, 2.0);
        fill(&g, 1.0, s.load[w].cosine, n, line);
        fill(&g, 1.0, s.load[w].sine, n, line);
        fill(&g, belts ? 0.3 : 0.0, s.motion[w].cosine, 2 * contacts, line);
    }
    fill(&g, 1.0, s.start, 2 * n, line);
    snprintf(s.name, sizeof s.name, "%zu bodies, %zu contacts%s%s", bodies, contacts, s.damped ? ", damped" : "",
             belts ? ", belts" : "");
    return s;
}

static void move(const struct structure *s, int seed, int planar, double *y)
{
    const size_t first[BODIES] = {0, 2, 4};
    double t = 0.0;
    tribo_system *sys = structure_system(s);
    tribo_driver *drv = NULL;
    assert_ok(tribo_set_planar(tribo_system_context(sys), planar ? s->ncontact / 2 : 0, first));
    assert_ok(set_up_driver(&drv, sys, "event", 0.5, TOLERANCE, 0.0));
    memcpy(y, s->start, (2 * s->ndof + 1) * sizeof *y);
    const int status = tribo_driver_advance(drv, &t, 10.0, y);
    require(!status, "seed %d, %s: %s", seed, s->name, tribo_driver_message(drv));
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* ---------------------------------------------------------------------------------------------------------- symmetries */

/* How pairs of directions change: pair k of the new ones is pair from[k] of the old, times turn. */
struct map {
    size_t pairs, from[BODIES];
    double turn[4];
};

static struct map any_map(struct random *g, size_t pairs, const double *turn, int reorders)
{
    struct map m = {.pairs = pairs};
    for (size_t k = 0; k < pairs; k++) {
        m.from[k] = k;
    }
    for (size_t k = pairs; reorders && k > 1; k--) {
        const size_t other = below(g, k), at = m.from[k - 1];
        m.from[k - 1] = m.from[other];
        m.from[other] = at;
    }
    memcpy(m.turn, turn, sizeof m.turn);
    return m;
}

static double entry(const struct map *m, size_t i, size_t j)
{
    return m->from[i / 2] == j / 2 ? m->turn[2 * (i % 2) + j % 2] : 0.0;
}

static void map_vector(const struct map *m, double *x)
{
    double old[2 * BODIES];
    memcpy(old, x, 2 * m->pairs * sizeof *x);
    for (size_t i = 0; i < 2 * m->pairs; i++) {
        x[i] = 0.0;
        for (size_t j = 0; j < 2 * m->pairs; j++) {
            x[i] += entry(m, i, j) * old[j];
        }
    }
}

/* a [rows][columns], of which both are mapped. */
static void map_matrix(const struct map *rows, const struct map *columns, double *a)
{
    const size_t n = 2 * columns->pairs;
    for (size_t i = 0; i < 2 * rows->pairs; i++) {
        map_vector(columns, a + i * n);
    }
    for (size_t j = 0; j < n; j++) {
        double column[2 * BODIES];
        for (size_t i = 0; i < 2 * rows->pairs; i++) {
            column[i] = a[i * n + j];
        }
        map_vector(rows, column);
        for (size_t i = 0; i < 2 * rows->pairs; i++) {
            a[i * n + j] = column[i];
        }
    }
}

static void make_symmetric(double *a, size_t n)
{
    for (size_t k = 0; k < n * n; k++) {
        a[k] = k / n > k % n ? a[k % n * n + k / n] : a[k];
    }
}

static struct structure mapped(const struct structure *s, const struct map *bodies, const struct map *contacts)
{
    struct structure to = *s;
    double *const square[] = {to.mass, to.damping, to.stiffness};
    for (size_t k = 0; k < 3; k++) {
        map_matrix(bodies, bodies, square[k]);
        make_symmetric(square[k], s->ndof);
    }
    map_matrix(contacts, bodies, to.direction);
    for (size_t i = 0; i < s->ncontact; i++) {
        to.limit[i] = s->limit[2 * contacts->from[i / 2]];
    }
    for (size_t w = 0; w < 2; w++) {
        map_vector(bodies, to.load[w].cosine);
        map_vector(bodies, to.load[w].sine);
        map_vector(contacts, to.motion[w].cosine);
    }
    map_vector(bodies, to.start);
    map_vector(bodies, to.start + s->ndof);
    return to;
}

static void compare(const struct structure *s, int seed, int kind, const double *y, const double *want)
{
    const double off = distance(y, want, 2 * s->ndof + 1), size = fmax(1.0, size_of(want, 2 * s->ndof));
    require(off <= NEAR * size, "seed %d, kind %d, %s: off by %.3g of %.3g", seed, kind, s->name, off, size);
}

/* Turned by an angle, contacts by another one; or bodies and contacts in another order, and seen in a mirror. */
static void compare_mapped(int seed, int kind)
{
    const struct structure s = scene(seed, kind);
    struct random g = random_of(seed);
    const double angle[] = {uniform(&g, -PI, PI), uniform(&g, -PI, PI)}, mirror[] = {0.0, 1.0, 1.0, 0.0};
    struct map map[2];
    for (size_t k = 0; k < 2; k++) {
        const double c = cos(angle[k]), d = sin(angle[k]), turn[] = {c, -d, d, c};
        map[k] = any_map(&g, (k ? s.ncontact : s.ndof) / 2, kind == TURNED ? turn : mirror, kind == REORDERED);
    }
    const struct structure other = mapped(&s, &map[0], &map[1]);
    double y[MOST_STATES], want[MOST_STATES];
    move(&s, seed, 1, want);
    move(&other, seed, 1, y);
    map_vector(&map[0], want);
    map_vector(&map[0], want + s.ndof);
    compare(&s, seed, kind, y, want);
}

/* ------------------------------------------------------------------------------------------------------------- line, energy */

static void compare_on_a_line(int seed)
{
    const struct structure s = scene(seed, ON_A_LINE);
    struct structure scalar = s;
    double y[MOST_STATES], want[MOST_STATES];
    for (size_t i = 1; i < s.ncontact; i += 2) {
        scalar.limit[i] = 0.0;
    }
    move(&s, seed, 1, y);
    move(&scalar, seed, 0, want);
    compare(&s, seed, ON_A_LINE, y, want);
}

static void balance_energy(int seed)
{
    const struct structure s = scene(seed, CONSTANT_LOADS);
    double y[MOST_STATES], sum = structure_energy(&s, s.start);
    move(&s, seed, 1, y);
    for (size_t i = 0; i < s.ndof; i++) {
        sum += (s.load[0].cosine[i] + s.load[1].cosine[i]) * (y[i] - s.start[i]);
    }
    const double left = sum - structure_energy(&s, y) - y[2 * s.ndof];
    require(y[2 * s.ndof] > 0.0 && fabs(left) <= NEAR * (1.0 + fabs(sum)),
            "seed %d, %s: %.3g of %.3g is missing, %.3g dissipated", seed, s.name, left, sum, y[2 * s.ndof]);
}

TEST(planar)
{
    const int first = setting("TRIBO_SEED", 0) + BLOCK * (_i / KINDS), kind = _i % KINDS;
    for (int seed = first; seed < first + BLOCK; seed++) {
        if (kind == ON_A_LINE) {
            compare_on_a_line(seed);
        } else if (kind == CONSTANT_LOADS) {
            balance_energy(seed);
        } else {
            compare_mapped(seed, kind);
        }
    }
}

int main(void)
{
    const int blocks = setting("TRIBO_BLOCKS", 1);
    const struct test tests[] = {{planar, blocks * KINDS}};
    return run_suite("planar", tests, COUNT(tests));
}
