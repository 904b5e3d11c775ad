/* SPDX-License-Identifier: BSD-3-Clause */
/* Random scenes of contacts between bodies, from a few to hundreds, in rows and in heaps, with repeated ones among them, masses
 * and limits up to six orders of magnitude apart: one context each through many calls, every answer against its equations.
 * TRIBO_SEED and TRIBO_BLOCKS as in random.c. */
#include <string.h>

#include "support.h"

#define BLOCK 25
#define MOST 560
#define ARMS 3 /* bodies that a contact touches, at most */

struct scene {
    size_t n, bodies, first[MOST + 1], body[ARMS * MOST];
    double arm[ARMS * MOST], inverse[2 * MOST], diagonal[MOST];
    double limit[MOST], epsilon[MOST], v[MOST], a[MOST];
};

/* Contact i touches bodies near one another, or is one that was before. */
static void connect(struct scene *s, struct random *g, size_t i, int in_a_row, int repeats)
{
    size_t *k = &s->first[i + 1];
    *k = s->first[i];
    if (repeats && i > 0 && below(g, 5) == 0) {
        const size_t other = below(g, i);
        for (size_t e = s->first[other]; e < s->first[other + 1]; e++) {
            s->body[*k] = s->body[e];
            s->arm[(*k)++] = s->arm[e];
        }
        return;
    }
    const size_t base = in_a_row ? i * s->bodies / s->n : below(g, s->bodies), arms = 1 + below(g, ARMS);
    for (size_t e = 0; e < arms; e++) {
        const size_t body = (base + below(g, 4)) % s->bodies;
        int known = 0;
        for (size_t m = s->first[i]; m < *k; m++) {
            known |= s->body[m] == body;
        }
        if (!known) {
            s->body[*k] = body;
            s->arm[(*k)++] = below(g, 2) ? (below(g, 2) ? 1.0 : -1.0) : uniform(g, -1.0, 1.0);
        }
    }
}

static void create(struct scene *s, struct random *g)
{
    const size_t kind = below(g, 5);
    const double decades = below(g, 2) ? 0.0 : uniform(g, 0.0, 3.0);
    const int repeats = below(g, 2) == 0;
    memset(s, 0, sizeof *s);
    s->n = kind == 4 ? 150 + below(g, 400) : 2 + below(g, kind == 3 ? 120 : 40);
    s->bodies = below(g, 3) ? s->n + below(g, s->n) : 1 + below(g, s->n);
    for (size_t b = 0; b < s->bodies; b++) {
        s->inverse[b] = log_uniform(g, decades);
    }
    for (size_t i = 0; i < s->n; i++) {
        connect(s, g, i, kind == 4 || kind == 2, repeats);
        for (size_t e = s->first[i]; e < s->first[i + 1]; e++) {
            s->diagonal[i] += s->arm[e] * s->arm[e] * s->inverse[s->body[e]];
        }
        s->limit[i] = below(g, 10) ? log_uniform(g, decades) : 0.0;
        s->epsilon[i] = uniform(g, 0.1, 2.0);
        s->v[i] = below(g, 3) ? s->epsilon[i] * uniform(g, -2.0, 2.0) : 0.0;
        s->a[i] = s->diagonal[i] * s->limit[i] * uniform(g, -2.0, 2.0);
    }
}

static void disturb(struct scene *s, struct random *g)
{
    for (size_t i = 0; i < s->n; i++) {
        if (below(g, 8) == 0) {
            s->v[i] = below(g, 2) ? 0.0 : s->epsilon[i] * uniform(g, -2.0, 2.0);
        }
        s->a[i] += below(g, 3) ? 0.0 : s->diagonal[i] * s->limit[i] * uniform(g, -0.3, 0.3);
    }
}

/* f is what the law makes of the f_eq that the others leave, to 1e-12 of the limit; that f_eq may be uncertain by 3e-13
 * of its terms, which neighbours with much higher limits make large. free
 * is a, or what the step would end with over its length. */
static void check(const struct scene *s, int law, const double *free, const double *f, int seed)
{
    static double push[2 * MOST], size[2 * MOST];
    memset(push, 0, sizeof push);
    memset(size, 0, sizeof size);
    for (size_t i = 0; i < s->n; i++) {
        for (size_t e = s->first[i]; e < s->first[i + 1]; e++) {
            push[s->body[e]] += s->inverse[s->body[e]] * s->arm[e] * f[i];
            size[s->body[e]] += fabs(s->inverse[s->body[e]] * s->arm[e] * f[i]);
        }
    }
    for (size_t i = 0; i < s->n; i++) {
        double acceleration = free[i], sum = fabs(free[i]), want;
        for (size_t e = s->first[i]; e < s->first[i + 1]; e++) {
            acceleration += s->arm[e] * push[s->body[e]];
            sum += fabs(s->arm[e]) * size[s->body[e]];
        }
        if (s->limit[i] > 0.0 && s->diagonal[i] > 0.0) {
            const double feq = f[i] - acceleration / s->diagonal[i];
            assert_ok(tribo_law_eval(law, s->v[i], feq, s->limit[i], s->epsilon[i], &want, NULL, NULL, NULL));
            require(fabs(f[i] - want) <= 1e-12 * s->limit[i] + 3e-13 * sum / s->diagonal[i],
                    "seed %d, %zu contacts: f[%zu] off by %g of %g", seed, s->n, i, f[i] - want, s->limit[i]);
        }
    }
}

static void run(int seed)
{
    static struct scene s;
    static double f[MOST], free[MOST];
    struct random g = random_of(seed);
    create(&s, &g);
    const int law = below(&g, 2) ? TRIBO_QUINN : TRIBO_COULOMB;
    tribo_context *c;
    assert_ok(tribo_create(&c, s.n));
    assert_ok(tribo_set_operator_mass(c, s.bodies, s.inverse, s.first, s.body, s.arm));
    assert_ok(tribo_set_law(c, law));
    assert_ok(tribo_set_limit(c, s.limit));
    assert_ok(tribo_set_epsilon(c, s.epsilon));
    assert_ok(tribo_set_sharing(c, seed % 3 ? TRIBO_SHARE_LEAST_NORM : TRIBO_SHARE_PREVIOUS));
    for (int k = 0; k < 40; k++) {
        disturb(&s, &g);
        const int step = below(&g, 3) == 0;
        if (step) {
            const struct scene now = s;
            for (size_t i = 0; i < s.n; i++) {
                free[i] = s.v[i] / 0.5;
                s.v[i] = 0.0;
            }
            assert_ok(tribo_step_force(c, 0.5, now.v, f));
            check(&s, TRIBO_COULOMB, free, f, seed);
            s = now;
        } else {
            assert_ok(tribo_balance(c, s.v, s.a, NULL, f));
            check(&s, law, s.a, f, seed);
        }
    }
    tribo_destroy(c);
}

TEST(contacts)
{
    const int first = setting("TRIBO_SEED", 0) + BLOCK * _i;
    for (int seed = first; seed < first + BLOCK; seed++) {
        run(seed);
    }
}

int main(void)
{
    const struct test tests[] = {{contacts, setting("TRIBO_BLOCKS", 1)}};
    return run_suite("contacts", tests, COUNT(tests));
}
