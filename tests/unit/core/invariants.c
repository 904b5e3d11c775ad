/* SPDX-License-Identifier: BSD-3-Clause */
/* What must not depend on the choice of directions, numbering and units. */
#include "problem.h"

struct answer {
    double feq[LARGEST], f[LARGEST], step[LARGEST];
};

/* Every law and coupling, from a context of its own; odd contacts of a reversal law come in sliding. */
static struct answer ask(const struct problem *p, int law, int coupling, double dt)
{
    struct answer x;
    double fast[LARGEST], vfree[LARGEST];
    tribo_context *c = problem_context(p, law, coupling);
    for (size_t i = 0; i < p->n; i++) {
        vfree[i] = p->v[i] + dt * p->a[i];
        fast[i] = p->v[i] != 0.0 ? 9.0 * p->epsilon[i] : 0.0;
    }
    assert_ok(tribo_accept(c, fast, p->v));
    const int status = tribo_balance(c, p->v, p->a, x.feq, x.f);
    require(!status || status == TRIBO_ERR_INCONSISTENT, "%s", tribo_message(c));
    assert_ok(tribo_step_force(c, dt, vfree, x.step));
    tribo_destroy(c);
    return x;
}

#define EVERY_LAW_AND_COUPLING 12

TEST(odd_symmetry)
{
    struct random g = random_of(_i);
    for (int k = 0; k < EVERY_LAW_AND_COUPLING; k++) {
        const struct recipe recipe = recipe_random(&g, USUAL, 0.5);
        const struct problem p = problem_create(&g, &recipe);
        struct problem mirrored = p;
        for (size_t i = 0; i < p.n; i++) {
            mirrored.v[i] = -p.v[i];
            mirrored.a[i] = -p.a[i];
        }
        const struct answer x = ask(&p, k / 2, k % 2, 0.1), y = ask(&mirrored, k / 2, k % 2, 0.1);
        for (size_t i = 0; i < p.n; i++) {
            assert_exact(y.f[i], -x.f[i]);
            assert_exact(y.feq[i], -x.feq[i]);
            assert_exact(y.step[i], -x.step[i]);
        }
    }
}

/* Turning single contacts around turns their forces. */
TEST(direction_of_contacts)
{
    struct random g = random_of(_i);
    for (int k = 0; k < EVERY_LAW_AND_COUPLING; k++) {
        const struct recipe recipe = recipe_regular(&g, 20);
        const struct problem p = problem_create(&g, &recipe);
        struct problem turned = p;
        double side[LARGEST];
        for (size_t i = 0; i < p.n; i++) {
            side[i] = below(&g, 2) ? 1.0 : -1.0;
            turned.v[i] *= side[i];
            turned.a[i] *= side[i];
        }
        for (size_t i = 0; i < p.n * p.n; i++) {
            turned.r[i] *= side[i / p.n] * side[i % p.n];
        }
        const struct answer x = ask(&p, k / 2, k % 2, 0.1), y = ask(&turned, k / 2, k % 2, 0.1);
        for (size_t i = 0; i < p.n; i++) {
            assert_exact(y.f[i], side[i] * x.f[i]);
            assert_exact(y.step[i], side[i] * x.step[i]);
        }
    }
}

/* To rounding only: sums and pivots change their order. */
TEST(permutation_of_contacts)
{
    struct random g = random_of(_i);
    for (int k = 0; k < EVERY_LAW_AND_COUPLING; k++) {
        const struct recipe recipe = recipe_regular(&g, 20);
        const struct problem p = problem_create(&g, &recipe);
        struct problem q = p;
        size_t to[LARGEST];
        for (size_t i = 0; i < p.n; i++) {
            const size_t at = below(&g, i + 1);
            to[i] = to[at];
            to[at] = i;
        }
        for (size_t i = 0; i < p.n; i++) {
            q.v[to[i]] = p.v[i], q.a[to[i]] = p.a[i];
            q.limit[to[i]] = p.limit[i], q.epsilon[to[i]] = p.epsilon[i];
            for (size_t j = 0; j < p.n; j++) {
                q.r[to[i] * p.n + to[j]] = p.r[i * p.n + j];
            }
        }
        const struct answer x = ask(&p, k / 2, k % 2, 0.1), y = ask(&q, k / 2, k % 2, 0.1);
        for (size_t i = 0; i < p.n; i++) {
            assert_close(y.f[to[i]], x.f[i], 1e-12);
            assert_close(y.step[to[i]], x.step[i], 1e-12);
        }
    }
}

/* The same problem with forces, lengths and times in other units. */
static struct problem rescale(const struct problem *p, double force, double length, double time)
{
    struct problem q = *p;
    for (size_t i = 0; i < p->n; i++) {
        q.v[i] *= length / time;
        q.epsilon[i] *= length / time;
        q.a[i] *= length / (time * time);
        q.limit[i] *= force;
    }
    for (size_t i = 0; i < p->n * p->n; i++) {
        q.r[i] *= length / (time * time * force);
    }
    return q;
}

static void check_units(struct random *g, double force, double length, double time, double tolerance)
{
    for (int k = 0; k < EVERY_LAW_AND_COUPLING; k++) {
        const struct recipe recipe = recipe_regular(g, 20);
        const struct problem p = problem_create(g, &recipe), q = rescale(&p, force, length, time);
        const struct answer x = ask(&p, k / 2, k % 2, 0.125), y = ask(&q, k / 2, k % 2, 0.125 * time);
        for (size_t i = 0; i < p.n; i++) {
            assert_close(y.f[i] / force, x.f[i], tolerance);
            assert_close(y.feq[i] / force, x.feq[i], tolerance * (1.0 + fabs(x.feq[i])));
            assert_close(y.step[i] / force, x.step[i], tolerance);
        }
    }
}

/* Units that differ by powers of two change no digit, where that of R, length/(time^2 force), is a power of four: the solver
 * takes roots of it. */
TEST(units_by_powers_of_two)
{
    struct random g = random_of(_i);
    const int length = (int)below(&g, 61) - 30, time = (int)below(&g, 31) - 15, force = length + 2 * ((int)below(&g, 21) - 10);
    check_units(&g, ldexp(1.0, force), ldexp(1.0, length), ldexp(1.0, time), 0.0);
}

TEST(units)
{
    struct random g = random_of(_i);
    const double force = log_uniform(&g, 20), length = log_uniform(&g, 20), time = log_uniform(&g, 10);
    check_units(&g, force, length, time, 1e-12);
}

TEST_MAIN("invariants", {odd_symmetry, 30}, {direction_of_contacts, 20}, {permutation_of_contacts, 20},
          {units_by_powers_of_two, 20}, {units, 30})
