/* SPDX-License-Identifier: BSD-3-Clause */
#include <stdlib.h>

#include "problem.h"

struct recipe recipe_random(struct random *g, size_t most, double decades)
{
    const size_t n = 1 + below(g, most);
    const double pulls[] = {0.1, 1.0, 4.0};
    return (struct recipe){n, 1 + below(g, n + 2), decades, 2.0, pulls[below(g, COUNT(pulls))], 0.1, 0.3, 0.5};
}

struct recipe recipe_regular(struct random *g, size_t most)
{
    const size_t n = 2 + below(g, most - 1);
    return (struct recipe){n, 2 * n, 0.0, 1.5, 2.0, 0.0, 0.2, 0.0};
}

/* A row of J: up to 4 bodies, or all of them; where contacts are redundant, now and then that of an earlier one,
 * reversed, and turned a little or not at all. */
static void direction(struct random *g, const struct recipe *recipe, size_t i, double *j)
{
    const size_t m = recipe->bodies;
    double *row = j + i * m;
    const double arm = log_uniform(g, recipe->decades);
    const int copies = i > 0 && m < recipe->contacts && below(g, 5) == 0;
    const double *from = j + (copies ? below(g, i) : 0) * m;
    const double turn = uniform(g, 0.0, 1.0) < recipe->nearly ? pow(10.0, uniform(g, -16.0, -1.0)) : 0.0;
    for (size_t k = 0; k < m; k++) {
        row[k] = copies ? -2.0 * from[k] * (1.0 + turn * uniform(g, -1.0, 1.0)) : 0.0;
    }
    const size_t all = below(g, 3) == 0 || m > recipe->contacts, some = all ? m : 1 + below(g, 4);
    for (size_t k = 0; !copies && k < some; k++) {
        row[all ? k : below(g, m)] = arm * (uniform(g, 0.3, 1.0)) * (below(g, 2) ? 1.0 : -1.0);
    }
}

struct problem problem_create(struct random *g, const struct recipe *recipe)
{
    struct problem p = {.n = recipe->contacts};
    double j[LARGEST * 2 * LARGEST], w[2 * LARGEST];
    const size_t n = p.n, m = recipe->bodies;
    for (size_t k = 0; k < m; k++) {
        w[k] = log_uniform(g, recipe->decades);
    }
    for (size_t i = 0; i < n; i++) {
        direction(g, recipe, i, j);
        for (size_t l = 0; l <= i; l++) {
            long double sum = 0.0L;
            for (size_t k = 0; k < m; k++) {
                sum += (long double)j[i * m + k] * w[k] * j[l * m + k];
            }
            p.r[i * n + l] = p.r[l * n + i] = (double)sum;
        }
        p.limit[i] = uniform(g, 0.0, 1.0) < recipe->open ? 0.0 : log_uniform(g, recipe->decades);
        p.epsilon[i] = log_uniform(g, recipe->decades);
        p.v[i] = uniform(g, 0.0, 1.0) < recipe->resting ? 0.0 : p.epsilon[i] * uniform(g, -recipe->speed, recipe->speed);
        p.a[i] = p.r[i * n + i] * (p.limit[i] > 0.0 ? p.limit[i] : 1.0) * uniform(g, -recipe->pull, recipe->pull);
    }
    return p;
}

tribo_context *problem_context(const struct problem *p, int law, int coupling)
{
    tribo_context *c;
    assert_ok(tribo_create(&c, p->n));
    assert_ok(tribo_set_law(c, law));
    assert_ok(tribo_set_coupling(c, coupling));
    assert_ok(tribo_set_limit(c, p->limit));
    assert_ok(tribo_set_epsilon(c, p->epsilon));
    assert_ok(tribo_set_operator_dense(c, p->r));
    return c;
}

long double acceleration(const struct problem *p, size_t i, const double *f)
{
    long double sum = p->a[i];
    for (size_t j = 0; j < p->n; j++) {
        sum += (long double)p->r[i * p->n + j] * f[j];
    }
    return sum;
}

double balancing(const struct problem *p, size_t i, const double *f)
{
    return (double)(f[i] - acceleration(p, i, f) / p->r[i * p->n + i]);
}

double balancing_noise(const struct problem *p, size_t i, const double *f)
{
    double sum = fabs(p->a[i]);
    for (size_t j = 0; j < p->n; j++) {
        sum += fabs(p->r[i * p->n + j] * f[j]);
    }
    return (double)(p->n + 4) * DBL_EPSILON * sum / p->r[i * p->n + i];
}

double law_force(int law, double v, double feq, double limit, double epsilon)
{
    double f;
    assert_ok(tribo_law_eval(law, v, feq, limit, epsilon, &f, NULL, NULL, NULL));
    return f;
}

size_t count_of(const tribo_context *c, int which)
{
    size_t value;
    assert_ok(tribo_get_count(c, which, &value));
    return value;
}

double real_of(const tribo_context *c, int which)
{
    double value;
    assert_ok(tribo_get_real(c, which, &value));
    return value;
}

void problem_forces(tribo_context *c, const struct problem *p, double step, const double *dv, const double *da, double *f)
{
    double v[LARGEST], a[LARGEST];
    for (size_t i = 0; i < p->n; i++) {
        v[i] = p->v[i] + step * dv[i];
        a[i] = p->a[i] + step * da[i];
    }
    assert_ok(tribo_balance(c, v, a, NULL, f));
}

void problem_forces_of_limits(tribo_context *c, const struct problem *p, double part, const double *dlimit, double *f)
{
    double limit[LARGEST];
    for (size_t i = 0; i < p->n; i++) {
        limit[i] = p->limit[i] + part * dlimit[i];
    }
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_balance(c, p->v, p->a, NULL, f));
}

struct problem problem_turn(struct random *g, struct problem *p, const int *wide, double *turn)
{
    const size_t n = p->n;
    for (size_t k = 0; k < n * n; k++) {
        turn[k] = 0.0;
    }
    for (size_t i = 0; i < n; i += (size_t)wide[i]) {
        const double angle = wide[i] == 2 ? uniform(g, -PI, PI) : 0.0;
        turn[i * n + i] = cos(angle);
        if (wide[i] == 2) {
            p->limit[i + 1] = p->limit[i];
            turn[i * n + i + 1] = -sin(angle);
            turn[(i + 1) * n + i] = sin(angle);
            turn[(i + 1) * n + i + 1] = cos(angle);
        }
    }
    struct problem t = *p;
    for (size_t i = 0; i < n; i++) {
        t.v[i] = t.a[i] = 0.0;
        for (size_t j = 0; j < n; j++) {
            t.v[i] += turn[i * n + j] * p->v[j];
            t.a[i] += turn[i * n + j] * p->a[j];
            t.r[i * n + j] = 0.0;
            for (size_t l = 0; l < n * n; l++) {
                t.r[i * n + j] += turn[i * n + l / n] * p->r[l] * turn[j * n + l % n];
            }
        }
    }
    return t;
}

void problem_check_turned(size_t n, const double *turn, const double *f, const double *got)
{
    for (size_t i = 0; i < n; i++) {
        double want = 0.0;
        for (size_t j = 0; j < n; j++) {
            want += turn[i * n + j] * f[j];
        }
        assert_close(got[i], want, 2e-10);
    }
}

tribo_context *problem_of_one_body(size_t n, const double *direction, double r)
{
    double *all = malloc(n * n * sizeof *all);
    tribo_context *c;
    for (size_t i = 0; i < n * n; i++) {
        all[i] = r * direction[i / n] * direction[i % n];
    }
    assert_ok(tribo_create(&c, n));
    assert_ok(tribo_set_operator_dense(c, all));
    free(all);
    return c;
}

tribo_context *problem_chain(size_t n, size_t islands, int coupling)
{
    const size_t all = n * islands;
    size_t *first = malloc((all + 1) * sizeof *first), *col = malloc(3 * all * sizeof *col), k = 0;
    double *val = malloc(3 * all * sizeof *val);
    tribo_context *c;
    first[0] = 0;
    for (size_t i = 0; i < all; i++) {
        if (i % n > 0) {
            col[k] = i - 1;
            val[k++] = -1.0;
        }
        col[k] = i;
        val[k++] = 2.0;
        if (i % n + 1 < n) {
            col[k] = i + 1;
            val[k++] = -1.0;
        }
        first[i + 1] = k;
    }
    assert_ok(tribo_create(&c, all));
    assert_ok(tribo_set_operator_csr(c, first, col, val));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_epsilon_all(c, 1.0));
    assert_ok(tribo_set_coupling(c, coupling));
    free(first);
    free(col);
    free(val);
    return c;
}

const struct problem twins = {
    .n = 3,
    .r = {2.0, 2.0, 1.0, 2.0, 2.0, 1.0, 1.0, 1.0, 1.0},
    .limit = {5.0, 5.0, 5.0},
    .epsilon = {0.1, 0.1, 0.1},
    .v = {0.0, 0.0, 0.0},
};
