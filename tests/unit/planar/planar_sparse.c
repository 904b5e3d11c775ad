/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar contacts in long rows and on carpets, whose R is kept sparse: the conditions that their solutions meet. */
#include <stdlib.h>
#include <string.h>

#include "problem.h"

/* Contacts on bodies of mass 1 that move in the plane. */
struct field {
    size_t contacts, n, *first, *rowptr, *col; /* R in compressed rows */
    double *val, *limit, *pull, *f, *spare;    /* [n] from limit on */
    tribo_context *c;
};

static size_t neighbours(size_t i, size_t width, size_t contacts, size_t *to)
{
    size_t count = 0;
    to[count++] = i;
    if (i % width > 0) {
        to[count++] = i - 1;
    }
    if (i % width + 1 < width && i + 1 < contacts) {
        to[count++] = i + 1;
    }
    if (i >= width) {
        to[count++] = i - width;
    }
    if (i + width < contacts) {
        to[count++] = i + width;
    }
    return count;
}

/* A row of contacts, or a carpet of rows of `width`, as discs. twice: each contact of a row is there twice. even: limits are 1;
 * else some are 0. */
static struct field field_create(struct random *g, size_t contacts, size_t width, int twice, int even)
{
    struct field s = {.contacts = contacts, .n = 2 * contacts};
    const size_t pairs = twice ? contacts / 2 : contacts, copies = twice ? 2 : 1;
    s.first = calloc(contacts + s.n + 1 + 10 * s.n, sizeof *s.first);
    s.rowptr = s.first + contacts;
    s.col = s.rowptr + s.n + 1;
    s.val = calloc(14 * s.n, sizeof *s.val);
    s.limit = s.val + 10 * s.n;
    s.pull = s.limit + s.n;
    s.f = s.pull + s.n;
    s.spare = s.f + s.n;
    require(s.first && s.val, "no memory");
    for (size_t i = 0; i < s.n; i++) {
        size_t to[5], end = s.rowptr[i];
        const size_t from = i / 2 / copies, count = neighbours(from, width < contacts ? width : pairs, pairs, to);
        for (size_t k = 0; k < copies * count; k++) {
            s.col[end] = 2 * (copies * to[k / copies] + k % copies) + i % 2;
            s.val[end++] = to[k / copies] != from ? -1.0 : width < contacts ? 4.0 : 2.0;
        }
        s.rowptr[i + 1] = end;
        s.limit[i] = i % 2 ? s.limit[i - 1] : even ? 1.0 : below(g, 10) ? uniform(g, 0.3, 1.0) : 0.0;
        s.first[i / 2] = i - i % 2;
    }
    assert_ok(tribo_create(&s.c, s.n));
    assert_ok(tribo_set_planar(s.c, contacts, s.first));
    assert_ok(tribo_set_limit(s.c, s.limit));
    assert_ok(tribo_set_epsilon_all(s.c, 1.0));
    assert_ok(tribo_set_operator_csr(s.c, s.rowptr, s.col, s.val));
    ck_assert_uint_eq(count_of(s.c, TRIBO_COUNT_PLANAR), contacts);
    return s;
}

static void field_free(struct field *s)
{
    tribo_destroy(s->c);
    free(s->first);
    free(s->val);
}

static double row_of(const struct field *s, size_t i, const double *x)
{
    double sum = 0.0;
    for (size_t e = s->rowptr[i]; e < s->rowptr[i + 1]; e++) {
        sum += s->val[e] * x[s->col[e]];
    }
    return sum;
}

/* Pulls that some contacts cannot hold. */
static void pull_at_random(struct field *s, struct random *g, double most)
{
    for (size_t i = 0; i < s->n; i++) {
        s->spare[i] = uniform(g, -most, most);
    }
    for (size_t i = 0; i < s->n; i++) {
        s->pull[i] = row_of(s, i, s->spare);
    }
}

/* Each force is the point of its disc nearest to f - (R f + pull)/4. Returns the number of contacts that slide. */
static size_t check_forces(const struct field *s)
{
    size_t slide = 0;
    for (size_t i = 0; i < s->n; i += 2) {
        const double x = s->f[i] - 0.25 * (s->pull[i] + row_of(s, i, s->f));
        const double y = s->f[i + 1] - 0.25 * (s->pull[i + 1] + row_of(s, i + 1, s->f));
        const double length = hypot(x, y), part = length > s->limit[i] ? s->limit[i] / length : 1.0;
        slide += length > s->limit[i];
        require(fabs(s->f[i] - part * x) <= 1e-13 && fabs(s->f[i + 1] - part * y) <= 1e-13, "contact %zu: %.17g, not %.17g",
                i / 2, s->f[i], part * x);
    }
    return slide;
}

/* Steps and balances at rest of 3000 contacts in a row, and of 1600 on a carpet; their derivatives beside differences. */
TEST(rows_and_carpets)
{
    struct random g = random_of(_i);
    struct field s = _i % 2 ? field_create(&g, 1600, 40, 0, _i > 1) : field_create(&g, 3000, 3000, 0, _i > 1);
    double *zero = calloc(5 * s.n, sizeof *zero), *da = zero + s.n, *df = da + s.n, *ahead = df + s.n, *a = ahead + s.n;
    for (int call = 0; call < 3; call++) {
        pull_at_random(&s, &g, 0.45);
        assert_ok(tribo_step_force(s.c, 0.5, s.pull, s.f));
        for (size_t i = 0; i < s.n; i++) {
            s.pull[i] *= 2.0;
        }
        const size_t slide = check_forces(&s);
        require(slide > s.contacts / 20 && slide < 4 * s.contacts / 5, "%zu slide", slide);
        memcpy(a, s.f, s.n * sizeof *a);
        assert_ok(tribo_balance(s.c, zero, s.pull, NULL, s.f));
        assert_all_close(s.f, a, s.n, 1e-12);
    }
    for (size_t i = 0; i < s.n; i++) {
        da[i] = uniform(&g, -1.0, 1.0);
    }
    assert_ok(tribo_balance_tangent(s.c, zero, s.pull, NULL, s.f, NULL, NULL));
    assert_ok(tribo_tangent_product(s.c, zero, da, df));
    for (int side = -1; side <= 1; side += 2) {
        for (size_t i = 0; i < s.n; i++) {
            a[i] = s.pull[i] + side * 1e-7 * da[i];
        }
        assert_ok(tribo_balance(s.c, zero, a, NULL, side < 0 ? s.f : ahead));
    }
    for (size_t i = 0; i < s.n; i++) {
        assert_close(df[i], (ahead[i] - s.f[i]) / 2e-7, 1e-5);
    }
    field_free(&s);
    free(zero);
}

/* Contacts that are there twice, too many for a dense factor: forces are shared evenly. */
TEST(tied)
{
    struct random g = random_of(_i);
    struct field s = field_create(&g, 1100, 1100, 1, 1);
    for (int call = 0; call < 2; call++) {
        pull_at_random(&s, &g, 1.2);
        assert_ok(tribo_step_force(s.c, 1.0, s.pull, s.f));
        const size_t slide = check_forces(&s);
        require(slide > 10 && slide < 1000, "%zu slide", slide);
        for (size_t i = 0; i < s.n; i += 4) {
            assert_all_close(s.f + i, s.f + i + 2, 2, 1e-7);
        }
    }
    field_free(&s);
}

/* A clone goes on where its original is, and both give the same bits. */
TEST(clone)
{
    struct random g = random_of(_i);
    struct field s = _i % 2 ? field_create(&g, 1600, 40, 0, 0) : field_create(&g, 200, 200, 0, 0);
    tribo_context *copy;
    pull_at_random(&s, &g, 0.7);
    assert_ok(tribo_step_force(s.c, 1.0, s.pull, s.f));
    assert_ok(tribo_clone(s.c, &copy));
    for (int call = 0; call < 3; call++) {
        for (size_t i = 0; i < s.n; i++) {
            s.pull[i] *= uniform(&g, 0.99, 1.01);
        }
        assert_ok(tribo_step_force(s.c, 1.0, s.pull, s.f));
        assert_ok(tribo_step_force(copy, 1.0, s.pull, s.spare));
        assert_all_exact(s.spare, s.f, s.n);
    }
    tribo_destroy(copy);
    field_free(&s);
}

/* Loads, then limits, then the operator change little: the factor of the call before serves, for the same forces. */
TEST(little_changes)
{
    struct random g = random_of(_i);
    struct field s = field_create(&g, 1600, 40, 0, _i > 0);
    pull_at_random(&s, &g, 0.9);
    assert_ok(tribo_step_force(s.c, 1.0, s.pull, s.f));
    for (int call = 0; call < 9; call++) {
        const uint64_t factors = count_of(s.c, TRIBO_COUNT_FACTORIZATIONS), reused = count_of(s.c, TRIBO_COUNT_REUSED);
        const double most = call % 3 == 2 ? 0.1 : 1e-6;
        for (size_t i = 0; i < s.n; i++) {
            s.pull[i] *= 1.0 + uniform(&g, -most, most);
            s.limit[i] = i % 2 ? s.limit[i - 1] : s.limit[i] * (call > 2 ? 1.0 + uniform(&g, -most, most) : 1.0);
        }
        assert_ok(tribo_set_limit(s.c, s.limit));
        if (call > 5) {
            s.val[s.rowptr[2 * call]] += 0.1;
            s.val[s.rowptr[2 * call + 1]] += 0.1;
            assert_ok(tribo_update_operator(s.c, s.val));
        }
        assert_ok(tribo_step_force(s.c, 1.0, s.pull, s.f));
        require(check_forces(&s) > 100, "few slide");
        if (most < 0.1 && call < 6 && call % 3 == 1) {
            ck_assert_uint_eq(count_of(s.c, TRIBO_COUNT_FACTORIZATIONS), factors);
            ck_assert_uint_eq(count_of(s.c, TRIBO_COUNT_REUSED), reused + 1);
        }
    }
    field_free(&s);
}

/* Each call has another load, far from the one before: sweeps come near the solution, and two factors at most follow. */
TEST(other_loads)
{
    struct random g = random_of(_i);
    struct field s = field_create(&g, 1600, 40, 0, 1);
    for (size_t i = 0; i < s.n; i++) {
        s.val[s.rowptr[i]] += 1.0;
    }
    assert_ok(tribo_set_operator_csr(s.c, s.rowptr, s.col, s.val));
    const uint64_t factors = count_of(s.c, TRIBO_COUNT_FACTORIZATIONS);
    for (int call = 0; call < 4; call++) {
        pull_at_random(&s, &g, 0.9);
        assert_ok(tribo_step_force(s.c, 1.0, s.pull, s.f));
        require(check_forces(&s) > 100, "few slide");
    }
    ck_assert_uint_le(count_of(s.c, TRIBO_COUNT_FACTORIZATIONS), factors + 8);
    field_free(&s);
}

/* Loads of 0, equal ones, ones that just reach the limits, opposite halves, one direction, a slope. Another call with the load
 * gives the same. */
TEST(even_loads)
{
    struct random g = random_of(_i);
    struct field s = field_create(&g, 2000, 40, 0, 1);
    for (int kind = 0; kind < 6; kind++) {
        for (size_t i = 0; i < s.n; i++) {
            const double x = (double)(i / 2 % 40) - 19.5;
            const double load[] = {0.0, 0.9, 1.0, x < 0.0 ? -1.2 : 1.2, i % 2 ? 0.0 : 1.0, 0.05 * x};
            s.spare[i] = load[kind];
        }
        for (size_t i = 0; i < s.n; i++) {
            s.pull[i] = row_of(&s, i, s.spare);
        }
        assert_ok(tribo_step_force(s.c, 1.0, s.pull, s.f));
        const size_t slide = check_forces(&s);
        assert_ok(tribo_step_force(s.c, 1.0, s.pull, s.spare));
        ck_assert_uint_eq(check_forces(&s), slide);
        assert_all_close(s.spare, s.f, s.n, 1e-13);
    }
    field_free(&s);
}

TEST_MAIN("planar_sparse", {rows_and_carpets, 4}, {tied, 2}, {clone, 2}, {little_changes, 2}, {other_loads, 2}, {even_loads, 1})
