/* SPDX-License-Identifier: BSD-3-Clause */
/* The operator R in all its forms. Entries are small integers over powers of two, so that every form holds the same bits. */
#include <stdlib.h>
#include <string.h>

#include "problem.h"

#define BODIES 6

/* J [n][BODIES], its weights, and R = J diag(weight) J'. */
struct structure {
    size_t n;
    double j[LARGEST * BODIES], weight[BODIES], r[LARGEST * LARGEST];
};

static void multiply(struct structure *s)
{
    for (size_t k = 0; k < s->n * s->n; k++) {
        s->r[k] = 0.0;
        for (size_t b = 0; b < BODIES; b++) {
            s->r[k] += s->j[k / s->n * BODIES + b] * s->weight[b] * s->j[k % s->n * BODIES + b];
        }
    }
}

/* Every contact between two bodies, or a body and the ground; more contacts than bodies are redundant. */
static struct structure structure_create(struct random *g, size_t n)
{
    struct structure s = {.n = n};
    for (size_t b = 0; b < BODIES; b++) {
        s.weight[b] = ldexp(1.0, (int)below(g, 7) - 3);
    }
    for (size_t i = 0; i < n; i++) {
        s.j[i * BODIES + below(g, BODIES)] = below(g, 2) ? 1.0 : -3.0;
        s.j[i * BODIES + below(g, BODIES)] = below(g, 2) ? -1.0 : 2.0;
    }
    multiply(&s);
    return s;
}

/* Compressed rows of an [n][columns] matrix, columns of a row in random order, with some of its zeros. */
struct rows {
    size_t first[LARGEST + 1], col[LARGEST * LARGEST];
    double val[LARGEST * LARGEST];
};

static struct rows compress(struct random *g, size_t n, size_t columns, const double *x)
{
    struct rows a = {{0}, {0}, {0}};
    for (size_t i = 0; i < n; i++) {
        size_t count = 0;
        size_t *col = a.col + a.first[i];
        for (size_t j = 0; j < columns; j++) {
            if (x[i * columns + j] != 0.0 || below(g, 4) == 0) {
                const size_t at = below(g, ++count);
                col[count - 1] = col[at];
                col[at] = j;
            }
        }
        a.first[i + 1] = a.first[i] + count;
        for (size_t k = 0; k < count; k++) {
            a.val[a.first[i] + k] = x[i * columns + col[k]];
        }
    }
    return a;
}

enum { DENSE, CSR, MASS, FORMS };

static void set_form(tribo_context *c, struct random *g, const struct structure *s, int form)
{
    const struct rows r = compress(g, s->n, s->n, s->r), j = compress(g, s->n, BODIES, s->j);
    if (form == DENSE) {
        assert_ok(tribo_set_operator_dense(c, s->r));
    } else if (form == CSR) {
        assert_ok(tribo_set_operator_csr(c, r.first, r.col, r.val));
    } else {
        assert_ok(tribo_set_operator_mass(c, BODIES, s->weight, j.first, j.col, j.val));
    }
}

/* What a context with this operator answers. */
struct answer {
    double feq[LARGEST], f[LARGEST], step[LARGEST];
    size_t islands;
};

static struct answer ask(tribo_context *c, const struct structure *s, int seed)
{
    struct random g = random_of(seed);
    struct answer x;
    double v[LARGEST], a[LARGEST];
    for (size_t i = 0; i < s->n; i++) {
        v[i] = uniform(&g, -1.0, 1.0) * (double)below(&g, 3);
        a[i] = uniform(&g, -5.0, 5.0);
    }
    memset(&x, 0, sizeof x);
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_epsilon_all(c, 1.0));
    assert_ok(tribo_balance(c, v, a, x.feq, x.f));
    assert_ok(tribo_step_force(c, 0.5, v, x.step));
    x.islands = count_of(c, TRIBO_COUNT_ISLANDS);
    return x;
}

TEST(forms_agree)
{
    struct random g = random_of(_i);
    const struct structure s = structure_create(&g, 1 + below(&g, LARGEST));
    struct answer x[FORMS];
    for (int form = 0; form < FORMS; form++) {
        tribo_context *c;
        assert_ok(tribo_create(&c, s.n));
        set_form(c, &g, &s, form);
        x[form] = ask(c, &s, _i);
        tribo_destroy(c);
        ck_assert_mem_eq(&x[form], &x[0], sizeof x[0]);
    }
}

/* An operator replaces the one before, whatever that was. */
TEST(forms_replace_each_other)
{
    struct random g = random_of(_i);
    const struct structure s = structure_create(&g, 12), other = structure_create(&g, 12);
    const double ones[12] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    tribo_context *c, *fresh;
    assert_ok(tribo_create(&fresh, s.n));
    set_form(fresh, &g, &s, DENSE);
    const struct answer want = ask(fresh, &s, _i);
    tribo_destroy(fresh);
    for (int form = 0; form < FORMS; form++) {
        assert_ok(tribo_create(&c, s.n));
        set_form(c, &g, &other, (form + _i) % FORMS);
        if (_i % 2) {
            assert_ok(tribo_set_operator_diagonal(c, ones));
        }
        set_form(c, &g, &s, form);
        const struct answer x = ask(c, &s, _i);
        ck_assert_mem_eq(&x, &want, sizeof x);
        tribo_destroy(c);
    }
}

/* Contacts on bodies of their own, and one that the other contact's body carries in vain: all the same as a diagonal. */
TEST(diagonal_in_any_form)
{
    struct random g = random_of(_i);
    struct structure s = {.n = 4, .weight = {0.5, 2.0, 1.0, 4.0, 0.0, 1.0}};
    for (size_t i = 0; i < 4; i++) {
        s.j[i * BODIES + i] = (double)i - 1.0;
        s.j[i * BODIES + 4] = 7.0; /* shared, but its motion is prescribed */
    }
    multiply(&s);
    const double diagonal[4] = {0.5, 0.0, 1.0, 16.0};
    tribo_context *c;
    assert_ok(tribo_create(&c, 4));
    assert_ok(tribo_set_operator_diagonal(c, diagonal));
    const struct answer want = ask(c, &s, _i);
    ck_assert_uint_eq(want.islands, 4);
    for (int form = 0; form < FORMS; form++) {
        set_form(c, &g, &s, form);
        const struct answer x = ask(c, &s, _i);
        ck_assert_mem_eq(&x, &want, sizeof x);
        ck_assert_uint_eq(count_of(c, TRIBO_COUNT_SOLVES), 0);
    }
    tribo_destroy(c);
}

/* 30000 contacts: pairs (i, n-1-i) that share a body. Only their blocks are stored. */
TEST(many_islands)
{
    const size_t n = 30000;
    size_t *first = malloc((n + 1) * sizeof *first), *col = malloc(2 * n * sizeof *col);
    double *val = malloc(2 * n * sizeof *val), *v = calloc(n, sizeof *v), *f = malloc(n * sizeof *f);
    double *a = malloc(n * sizeof *a);
    for (size_t i = 0; i < n; i++) {
        first[i] = 2 * i;
        col[2 * i] = n - 1 - i;
        col[2 * i + 1] = i;
        val[2 * i] = -1.0;
        val[2 * i + 1] = i < n / 2 ? 2.0 : 1.0;
        a[i] = i < n / 2 ? -1.0 : 0.75; /* f = (0.25, -0.5) */
    }
    first[n] = 2 * n;
    tribo_context *c;
    assert_ok(tribo_create(&c, n));
    assert_ok(tribo_set_operator_csr(c, first, col, val));
    assert_ok(tribo_set_limit_all(c, 1.0));
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_ISLANDS), n / 2);
    assert_ok(tribo_balance(c, v, a, NULL, f));
    for (size_t i = 0; i < n; i++) {
        assert_close(f[i], i < n / 2 ? 0.25 : -0.5, 4.0 * DBL_EPSILON);
    }
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_SOLVES), n / 2);
    tribo_destroy(c);
    free(first), free(col), free(val), free(v), free(f), free(a);
}

/* -------------------------------------------------------------------------------------------------- what is an operator */

/* Any J M^-1 J' is one, singular ones of all ranks and scales too, as rounding leaves it. */
TEST(products_are_accepted)
{
    struct random g = random_of(_i);
    for (int k = 0; k < 10; k++) {
        const struct recipe recipe = recipe_random(&g, USUAL, 0.5 * (double)(k % 8));
        const struct problem p = problem_create(&g, &recipe);
        tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
        tribo_destroy(c);
    }
}

/* R - shift * largest diagonal entry * xx' with x a null vector: a negative eigenvalue as large as the shift. */
TEST(negative_eigenvalues_are_refused)
{
    const double shifts[] = {1e-9, 1e-6, 1e-2};
    for (size_t k = 0; k < COUNT(shifts); k++) {
        /* J = (1, 0), (0, 1), (1, 1): null vector (1, 1, -1) */
        double r[9] = {1, 0, 1, 0, 1, 1, 1, 1, 2};
        const double x[3] = {1, 1, -1};
        for (size_t i = 0; i < 9; i++) {
            r[i] -= shifts[k] * x[i / 3] * x[i % 3];
        }
        tribo_context *c;
        assert_ok(tribo_create(&c, 3));
        assert_status(tribo_set_operator_dense(c, r), TRIBO_ERR_INDEFINITE);
        tribo_destroy(c);
    }
}

/* Rounding may make (i, j) and (j, i) differ: the mean counts. */
TEST(symmetric_to_rounding)
{
    const double skew[4] = {2.0, 1.0 + 4e-12, 1.0, 3.0}, mean[4] = {2.0, 1.0 + 2e-12, 1.0 + 2e-12, 3.0};
    const double v[2] = {0.0, 0.0}, a[2] = {1.0, 0.5}, limit[2] = {9.0, 9.0};
    double f[2][2];
    for (int k = 0; k < 2; k++) {
        tribo_context *c;
        assert_ok(tribo_create(&c, 2));
        assert_ok(tribo_set_operator_dense(c, k ? mean : skew));
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_balance(c, v, a, NULL, f[k]));
        tribo_destroy(c);
    }
    assert_all_close(f[0], f[1], 2, 2.0 * DBL_EPSILON);
}

/* M^-1 of a mass matrix that is tridiagonal, 4 and 1, by elimination. */
static int solve_mass(size_t ndof, const double *force, double *acceleration, void *data)
{
    double pivot[64];
    int *calls = data;
    if (--*calls < 0) {
        return 7;
    }
    for (size_t i = 0; i < ndof; i++) {
        pivot[i] = 4.0 - (i ? 1.0 / pivot[i - 1] : 0.0);
        acceleration[i] = force[i] - (i ? acceleration[i - 1] / pivot[i - 1] : 0.0);
    }
    for (size_t i = ndof; i-- > 0;) {
        acceleration[i] = (acceleration[i] - (i + 1 < ndof ? acceleration[i + 1] : 0.0)) / pivot[i];
    }
    return 0;
}

/* R from J and M^-1 is that which gives the same forces as the dense one. */
TEST(consistent_mass)
{
    struct random g = random_of(_i);
    const size_t n = 2 + below(&g, 20), ndof = n + below(&g, 30);
    size_t first[30] = {0}, col[64];
    double val[64], v[30], a[30], f[30], want[30], limit[30], column[64], force[64], *r = calloc(n * n, sizeof *r);
    for (size_t i = 0; i < n; i++) {
        col[2 * i] = i;
        val[2 * i] = uniform(&g, 0.5, 2.0);
        col[2 * i + 1] = (i + 1 + below(&g, ndof - 1)) % ndof;
        val[2 * i + 1] = uniform(&g, -1.0, 1.0);
        first[i + 1] = 2 * i + 2;
        v[i] = below(&g, 2) ? 0.0 : uniform(&g, -1.5, 1.5);
        a[i] = uniform(&g, -1.0, 1.0);
        limit[i] = uniform(&g, 0.1, 2.0);
    }
    for (size_t j = 0; j < n; j++) {
        int calls = 1;
        memset(force, 0, sizeof force);
        force[col[2 * j]] += val[2 * j];
        force[col[2 * j + 1]] += val[2 * j + 1];
        solve_mass(ndof, force, column, &calls);
        for (size_t i = 0; i < n; i++) {
            r[i * n + j] = val[2 * i] * column[col[2 * i]] + val[2 * i + 1] * column[col[2 * i + 1]];
        }
    }
    for (int dense = 0; dense < 2; dense++) {
        tribo_context *c;
        int calls = (int)n;
        assert_ok(tribo_create(&c, n));
        assert_ok(dense ? tribo_set_operator_dense(c, r)
                        : tribo_set_operator_callback(c, ndof, solve_mass, &calls, first, col, val));
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_set_epsilon_all(c, 1.0));
        assert_ok(tribo_balance(c, v, a, NULL, dense ? want : f));
        tribo_destroy(c);
    }
    assert_all_close(f, want, n, 1e-12);
    free(r);
}

/* The callback's failure is told, and nothing changes. */
TEST(callback_fails)
{
    const size_t first[] = {0, 1, 2}, col[] = {0, 1};
    const double val[] = {1.0, 1.0}, diagonal[] = {3.0, 5.0};
    double v[2] = {0.0, 0.0}, a[2] = {0.3, 0.5}, f[2];
    int calls = 1;
    tribo_context *c;
    assert_ok(tribo_create(&c, 2));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_operator_diagonal(c, diagonal));
    assert_status(tribo_set_operator_callback(c, 2, solve_mass, &calls, first, col, val), TRIBO_ERR_CALLBACK);
    assert_says(tribo_message(c), "apply answered 7 for contact 1");
    assert_status(tribo_set_operator_callback(c, 2, NULL, &calls, first, col, val), TRIBO_ERR_NULL);
    assert_says(tribo_message(c), "apply is NULL");
    assert_ok(tribo_balance(c, v, a, NULL, f));
    assert_close(f[0], -0.1, 1e-16);
    assert_close(f[1], -0.1, 1e-16);
    tribo_destroy(c);
}

TEST_MAIN("operators", {forms_agree, 60}, {forms_replace_each_other, 12}, {diagonal_in_any_form, 10}, {many_islands, 1},
          {products_are_accepted, 100}, {negative_eigenvalues_are_refused, 1}, {symmetric_to_rounding, 1}, {consistent_mass, 40},
          {callback_fails, 1})
