/* SPDX-License-Identifier: BSD-3-Clause */
/* New values of an operator: the bits of a context with a new operator, and no memory asked for. */
#include <stdio.h>
#include <string.h>

#include "memory.h"
#include "problem.h"

enum { DIAGONAL, DENSE, ROWS, MASS, FORMS, BODIES = 8, MANY = 160 };

/* J [n][BODIES] in rows of up to three entries, of R by set_row up to five; R [n][n] = J diag(weight) J'. */
struct structure {
    size_t n, first[MANY + 1], col[5 * MANY];
    double j[5 * MANY], weight[BODIES], r[MANY * MANY], diagonal[MANY];
};

/* New values in the same places; zeros: some are 0. */
static void change(struct random *g, struct structure *s, int zeros)
{
    for (size_t k = 0; k < s->first[s->n]; k++) {
        s->j[k] = zeros && below(g, 3) == 0 ? 0.0 : uniform(g, 0.2, 2.0) * (below(g, 2) ? 1.0 : -1.0);
    }
    memset(s->r, 0, sizeof s->r);
    for (size_t a = 0; a < s->n; a++) {
        for (size_t k = s->first[a]; k < s->first[a + 1]; k++) {
            for (size_t b = 0; b < s->n; b++) {
                for (size_t l = s->first[b]; l < s->first[b + 1]; l++) {
                    s->r[a * s->n + b] += s->col[k] == s->col[l] ? s->j[k] * s->weight[s->col[k]] * s->j[l] : 0.0;
                }
            }
        }
    }
    for (size_t a = 0; a < s->n; a++) {
        s->diagonal[a] = s->r[a * s->n + a];
        for (size_t b = 0; b < a; b++) {
            s->r[b * s->n + a] = s->r[a * s->n + b];
        }
    }
}

static void structure_create(struct random *g, struct structure *s, size_t n)
{
    s->n = n;
    s->first[0] = 0;
    for (size_t b = 0; b < BODIES; b++) {
        s->weight[b] = exp(uniform(g, -1.0, 1.0));
    }
    for (size_t i = 0; i < n; i++) {
        const size_t body = below(g, BODIES - 2), count = 1 + below(g, 3);
        for (size_t k = 0; k < count; k++) {
            s->col[s->first[i] + k] = body + count - 1 - k;
        }
        s->first[i + 1] = s->first[i] + count;
    }
    change(g, s, 0);
}

/* A row of n contacts in compressed rows: kept sparse if it is long, unless it is free at both ends, so that R is singular. gaps:
 * R also couples contacts i and i + 2, by 0 at random places. */
static void set_row(struct structure *s, struct random *g, size_t n, int free, int gaps)
{
    double size[MANY], far[MANY];
    s->n = n;
    s->first[0] = 0;
    for (size_t i = 0; i < n; i++) {
        size[i] = uniform(g, 0.5, 2.0);
        far[i] = below(g, 20) ? -0.25 : 0.0;
    }
    const size_t reach = gaps ? 2 : 1;
    for (size_t i = 0, k = 0; i < n; i++) {
        for (size_t j = i > reach ? i - reach : 0; j <= i + reach && j < n; j++) {
            const int end = free && (i == 0 || i == n - 1);
            const double own = gaps ? 3.0 : end ? 1.0 : 2.0;
            s->col[k] = j;
            s->j[k++] = size[i] * size[j] * (i == j ? own : i + 2 == j ? far[i] : j + 2 == i ? far[j] : -1.0);
        }
        s->first[i + 1] = k;
    }
}

/* R by the rows of the structure. */
static size_t rows_of(const struct structure *s, size_t *first, size_t *col, double *val)
{
    size_t k = 0;
    for (size_t i = 0; i < s->n; i++) {
        first[i] = k;
        for (size_t j = s->n; j-- > 0;) {
            col[k] = j;
            val[k++] = s->r[i * s->n + j];
        }
    }
    first[s->n] = k;
    return k;
}

static size_t row_first[MANY + 1], row_col[MANY * MANY];
static double row_val[MANY * MANY];

static const double *values(const struct structure *s, int form)
{
    rows_of(s, row_first, row_col, row_val);
    return form == DIAGONAL ? s->diagonal : form == DENSE ? s->r : form == ROWS ? row_val : s->j;
}

static int set_form(tribo_context *c, const struct structure *s, int form)
{
    const double *val = values(s, form);
    return form == DIAGONAL ? tribo_set_operator_diagonal(c, val)
           : form == DENSE  ? tribo_set_operator_dense(c, val)
           : form == ROWS   ? tribo_set_operator_csr(c, row_first, row_col, val)
                            : tribo_set_operator_mass(c, BODIES, s->weight, s->first, s->col, val);
}

/* A context without an operator: planar contacts (1), static limits (2), an epsilon that follows (4). */
static tribo_context *context_of(size_t n, unsigned kind)
{
    tribo_context *c;
    double ratio[MANY];
    size_t first[MANY / 4], planar = 0;
    assert_ok(tribo_create(&c, n));
    for (size_t i = 0; i < n; i++) {
        ratio[i] = 1.25;
    }
    for (size_t i = 0; i + 1 < n && i < MANY; i += 4) {
        first[planar++] = i;
    }
    assert_ok(kind & 1 ? tribo_set_planar(c, planar, first) : TRIBO_OK);
    assert_ok(kind & 2 ? tribo_set_static(c, ratio, NULL) : TRIBO_OK);
    assert_ok(kind & 4 ? tribo_set_epsilon_step(c, 0.01, 0.4) : tribo_set_epsilon_all(c, 0.3));
    return c;
}

/* All answers of a context at v and a, and after a step. */
struct answers {
    double feq[MANY], f[MANY], step[MANY], mean[MANY], epsilon[MANY], dv[MANY * 4];
    signed char slip[MANY];
    size_t islands;
};

static void ask(tribo_context *c, const double *v, const double *a, struct answers *to)
{
    memset(to, 0, sizeof *to);
    assert_ok(tribo_balance_tangent(c, v, a, to->feq, to->f, NULL, NULL));
    assert_ok(tribo_tangent_product(c, v, a, to->dv));
    assert_ok(tribo_step_force(c, 0.1, v, to->step));
    assert_ok(tribo_step_force_mean(c, 0.1, a, v, to->mean));
    assert_ok(tribo_get_slip(c, to->slip));
    assert_ok(tribo_get_epsilon(c, to->epsilon));
    to->islands = count_of(c, TRIBO_COUNT_ISLANDS);
}

/* The same answers, of solutions from other beginnings; planar contacts share to about 1e-8. */
static void require_close(const struct answers *one, const struct answers *other, size_t n, unsigned kind)
{
    const double near = kind & 1 ? 1e-8 : 1e-12;
    assert_all_close(one->f, other->f, n, near);
    assert_all_close(one->step, other->step, n, near);
    assert_all_close(one->epsilon, other->epsilon, n, 0.0);
    require(one->islands == other->islands, "%zu islands, then %zu", one->islands, other->islands);
}

static void draw(struct random *g, size_t n, double *v, double *a, double *limit)
{
    for (size_t i = 0; i < n; i++) {
        v[i] = below(g, 3) ? uniform(g, -0.4, 0.4) : 0.0;
        a[i] = uniform(g, -2.0, 2.0);
        limit[i] = below(g, 4) ? uniform(g, 0.1, 1.0) : 0.0;
    }
}

/* Answers after many updates are those of a context with the last values set. */
TEST(bits_of_a_new_operator)
{
    struct random g = random_of(_i);
    static struct structure s;
    static struct answers one, other;
    const int form = _i % FORMS;
    const unsigned kind = (unsigned)(_i / FORMS) % 8;
    double v[MANY], a[MANY], limit[MANY];
    structure_create(&g, &s, 2 + below(&g, 12));
    tribo_context *c = context_of(s.n, kind), *clone = NULL;
    assert_ok(set_form(c, &s, form));
    for (int k = 0; k < 40; k++) {
        change(&g, &s, k % 4 == 1);
        draw(&g, s.n, v, a, limit);
        if (k % 10 == 5) {
            tribo_destroy(clone);
            assert_ok(tribo_clone(c, &clone));
            ask(clone, v, a, &other);
        }
        assert_ok(tribo_update_operator(c, values(&s, form)));
        if (k % 10 == 5) {
            ask(clone, v, a, &one); /* the clone keeps its operator */
            require_close(&one, &other, s.n, kind);
            assert_ok(tribo_update_operator(clone, values(&s, form)));
        }
        tribo_context *fresh = context_of(s.n, kind);
        assert_ok(set_form(fresh, &s, form));
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_set_limit(fresh, limit));
        ask(fresh, v, a, &one);
        ask(c, v, a, &other);
        require(memcmp(&one, &other, sizeof one) == 0, "form %d, kind %u, update %d: other answers", form, kind, k);
        if (k % 10 == 5) {
            assert_ok(tribo_set_limit(clone, limit));
            ask(clone, v, a, &other);
            require(memcmp(&one, &other, sizeof one) == 0, "form %d, kind %u, update %d of a clone", form, kind, k);
        }
        tribo_destroy(fresh);
    }
    tribo_destroy(clone);
    tribo_destroy(c);
}

/* Large groups, sparse and dense ones, those with a redundant contact among them, and those with zeros at other places after each
 * update. */
TEST(bits_of_large_groups)
{
    struct random g = random_of(_i);
    static struct structure s;
    static struct answers one, other;
    double v[MANY], a[MANY], limit[MANY];
    const int rows = _i % 3 > 0, gaps = _i % 6 == 4;
    const unsigned kind = (unsigned)(_i / 6);
    tribo_context *c = context_of(MANY, kind);
    size_t asked = 0;
    for (int k = 0; k < 12; k++) {
        if (rows) {
            set_row(&s, &g, MANY, _i % 3 == 2, gaps);
        } else if (k == 0) {
            structure_create(&g, &s, MANY);
        } else {
            change(&g, &s, 0);
        }
        tribo_context *fresh = context_of(MANY, kind);
        tribo_context *both[] = {fresh, c};
        for (int which = 0; which < 2; which++) {
            const size_t before = memory_calls();
            assert_ok(which && k ? tribo_update_operator(c, rows ? s.j : values(&s, ROWS))
                      : rows ? tribo_set_operator_csr(both[which], s.first, s.col, s.j)
                                 : set_form(both[which], &s, ROWS));
            asked += which && k > 1 ? memory_calls() - before : 0;
        }
        draw(&g, MANY, v, a, limit);
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_set_limit(fresh, limit));
        ask(fresh, v, a, &one);
        ask(c, v, a, &other);
        require(memcmp(&one, &other, sizeof one) == 0, "update %d: other answers", k);
        tribo_destroy(fresh);
    }
    require(gaps || asked == 0, "%zu allocations", asked);
    tribo_destroy(c);
}

/* Many steps of an operator and limits that change, after the first update. */
TEST(no_memory)
{
    struct random g = random_of(_i);
    static struct structure s;
    const int form = _i % FORMS;
    double v[MANY], a[MANY], limit[MANY], f[MANY];
    structure_create(&g, &s, 8);
    tribo_context *c = context_of(s.n, (unsigned)(_i / FORMS));
    assert_ok(set_form(c, &s, form));
    const size_t before_first = memory_calls();
    assert_ok(tribo_update_operator(c, values(&s, form)));
    const size_t before = memory_calls();
    require(before > before_first, "allocations are not counted");
    for (int step = 0; step < 12500; step++) {
        if (step % 25 == 0) {
            draw(&g, s.n, v, a, limit);
            change(&g, &s, 0);
        } else {
            s.j[below(&g, s.first[s.n])] *= 1.0625;
            for (size_t k = 0; k < s.n * s.n; k++) {
                s.r[k] *= 1.03125;
            }
            s.diagonal[below(&g, s.n)] *= 1.03125;
        }
        limit[below(&g, s.n)] = below(&g, 2) ? 0.5 : 0.0;
        assert_ok(tribo_update_operator(c, values(&s, form)));
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(step % 2 ? tribo_step_force(c, 0.01, v, f) : tribo_balance(c, v, a, NULL, f));
    }
    require(memory_calls() == before, "%zu allocations", memory_calls() - before);
    tribo_destroy(c);
}

/* Refused values change nothing, and are named. */
TEST(refusals)
{
    struct random g = random_of(_i);
    static struct structure s;
    static struct answers one, other;
    static double bad[MANY * MANY];
    const int form = _i % FORMS;
    double v[MANY], a[MANY], limit[MANY];
    const unsigned kind = (unsigned)(_i / FORMS);
    tribo_context *c = context_of(5, kind);
    structure_create(&g, &s, 5);
    assert_status(tribo_update_operator(NULL, s.r), TRIBO_ERR_NULL);
    assert_status(tribo_update_operator(c, s.r), TRIBO_ERR_STATE);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_VALUES), 0);
    assert_ok(set_form(c, &s, form));
    const size_t count = count_of(c, TRIBO_COUNT_VALUES);
    ck_assert_uint_eq(count, form == DIAGONAL ? 5 : form == MASS ? s.first[5] : 25);
    change(&g, &s, 0);
    assert_ok(tribo_update_operator(c, values(&s, form)));
    draw(&g, 5, v, a, limit);
    assert_ok(tribo_set_limit(c, limit));
    ask(c, v, a, &one);
    assert_status(tribo_update_operator(c, NULL), TRIBO_ERR_NULL);
    assert_says(tribo_message(c), "val is NULL");
    for (size_t k = 0; k < count; k++) {
        memcpy(bad, values(&s, form), count * sizeof *bad);
        bad[k] = k % 2 ? (double)NAN : HUGE_VAL;
        assert_status(tribo_update_operator(c, bad), TRIBO_ERR_NOT_FINITE);
        char name[40];
        if (form == DENSE) {
            snprintf(name, sizeof name, "val[%zu][%zu]", k / 5, k % 5);
        } else {
            snprintf(name, sizeof name, "val[%zu]", k);
        }
        assert_says(tribo_message(c), name);
    }
    if (form == DENSE || form == ROWS) {
        memcpy(bad, values(&s, form), count * sizeof *bad);
        bad[form == DENSE ? 1 : 3] += 0.5;
        assert_status(tribo_update_operator(c, bad), TRIBO_ERR_NOT_SYMMETRIC);
        for (size_t k = 0; k < count; k++) {
            bad[k] = k / 5 == (form == DENSE ? k % 5 : 4 - k % 5) ? 1.0 : -0.5;
        }
        assert_status(tribo_update_operator(c, bad), TRIBO_ERR_INDEFINITE);
    }
    if (form == DIAGONAL) {
        memcpy(bad, s.diagonal, sizeof s.diagonal);
        bad[3] = -1.0;
        assert_status(tribo_update_operator(c, bad), TRIBO_ERR_NEGATIVE);
        assert_says(tribo_message(c), "val[3] = -1 is negative");
    }
    ask(c, v, a, &other);
    require_close(&one, &other, s.n, kind);
    assert_ok(tribo_fix_operator(c));
    assert_status(tribo_update_operator(c, values(&s, form)), TRIBO_ERR_UNSUPPORTED);
    tribo_destroy(c);
}

static int apply(size_t ndof, const double *force, double *acceleration, void *data)
{
    memcpy(acceleration, force, ndof * sizeof *force);
    return data != NULL;
}

TEST(callback)
{
    const size_t first[] = {0, 1}, col[] = {0};
    const double one = 1.0;
    tribo_context *c;
    assert_ok(tribo_create(&c, 1));
    assert_ok(tribo_set_operator_callback(c, 1, apply, NULL, first, col, &one));
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_VALUES), 0);
    assert_status(tribo_update_operator(c, &one), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_message(c), "callback");
    tribo_destroy(c);
}

/* Memory that ends leaves the old operator, and leaks nothing. */
TEST(memory_ends)
{
    struct random g = random_of(_i);
    static struct structure s, next;
    static struct answers one, other;
    const int form = _i % FORMS;
    double v[MANY], a[MANY], limit[MANY];
    const unsigned kind = (unsigned)(_i / FORMS);
    size_t fails = 1;
    structure_create(&g, &s, 6);
    draw(&g, s.n, v, a, limit);
    next = s;
    change(&g, &next, 0);
    for (int status = TRIBO_ERR_MEMORY; status; fails++) {
        const long none = memory_live();
        tribo_context *c = context_of(s.n, kind);
        assert_ok(set_form(c, &s, form));
        assert_ok(tribo_set_limit(c, limit));
        ask(c, v, a, &one);
        memory_fail(fails);
        status = tribo_update_operator(c, values(&next, form));
        memory_fail(0);
        if (status) {
            assert_status(status, TRIBO_ERR_MEMORY);
            assert_says(tribo_message(c), "out of memory");
            ask(c, v, a, &other);
            require_close(&one, &other, s.n, kind);
            assert_ok(tribo_update_operator(c, values(&next, form)));
        }
        tribo_destroy(c);
        require(memory_live() == none, "%ld blocks left behind", memory_live() - none);
    }
    ck_assert_uint_gt(fails, 2);
}

/* Contacts that are the same share by their forces of the last call, also if R has new values since. */
TEST(previous_forces)
{
    const double r[] = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0}, twice[] = {2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0};
    const double v[3] = {0.0, 0.0, 0.0}, a[3] = {0.5, 0.5, 0.5}, pull[3] = {1.0, 1.0, 1.0}, most[] = {0.0625, 0.125, 1.0};
    double before[3], after[3];
    tribo_context *c;
    assert_ok(tribo_create(&c, 3));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_set_sharing(c, TRIBO_SHARE_PREVIOUS));
    assert_ok(tribo_set_limit(c, most));
    assert_ok(tribo_balance(c, v, a, NULL, before));
    require(before[0] != before[1] && before[1] != before[2], "equal shares");
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_update_operator(c, twice));
    assert_ok(tribo_balance(c, v, pull, NULL, after)); /* balanced by the same forces */
    assert_all_close(after, before, 3, 1e-15);
    tribo_destroy(c);
}

/* The box of Coulomb's law at rest; fails if *data is not 0. */
static int box_at_rest(size_t first, size_t n, int derivatives, const double *v, const double *limit, const double *epsilon,
                       double *box, void *data)
{
    (void)first, (void)v, (void)epsilon;
    for (size_t i = 0; i < n; i++) {
        box[i] = -limit[i];
        box[n + i] = limit[i];
        box[2 * n + i] = 0.0;
    }
    return derivatives || *(const int *)data;
}

/* A call in which the caller's law fails leaves the previous forces, also if R has new values since. */
TEST(previous_forces_after_failure)
{
    const double r[] = {1.0, 1.0, 1.0, 1.0}, twice[] = {2.0, 2.0, 2.0, 2.0}, v[2] = {0.0, 0.0}, a[2] = {0.5, 0.5},
                 pull[2] = {1.0, 1.0};
    double before[2], after[2];
    int fails = 0;
    tribo_context *c;
    assert_ok(tribo_create(&c, 2));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_set_epsilon_all(c, 1.0));
    assert_ok(tribo_set_sharing(c, TRIBO_SHARE_PREVIOUS));
    assert_ok(tribo_set_user_law(c, box_at_rest, &fails));
    assert_ok(tribo_set_limit(c, (const double[]){0.125, 1.0}));
    assert_ok(tribo_balance(c, v, a, NULL, before));
    fails = 1;
    assert_status(tribo_balance(c, v, a, NULL, after), TRIBO_ERR_CALLBACK);
    fails = 0;
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_update_operator(c, twice));
    assert_ok(tribo_balance(c, v, pull, NULL, after));
    assert_all_close(after, before, 2, 1e-15);
    tribo_destroy(c);
}

TEST_MAIN("update", {bits_of_a_new_operator, 96}, {bits_of_large_groups, 12}, {no_memory, 8}, {refusals, 16}, {callback, 1},
          {memory_ends, 16}, {previous_forces, 1}, {previous_forces_after_failure, 1})
