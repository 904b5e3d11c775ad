/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls look at contacts in chunks of 128, and at vectors of them: what they say of a contact does not depend on its place, nor
 * on how many there are, nor on whether all have the same limit and epsilon. */
#include <stdio.h>
#include <stdlib.h>

#include "support.h"

#define MOST 1300 /* forces of so many are not kept */

static const size_t counts[] = {1, 2, 7, 8, 9, 127, 128, 129, 255, 256, 257, 1024, 1025, MOST};
static const size_t places[] = {0, 1, 3, 7, 8, 9, 126, 127, 128, 129, 255, 256, 299};

/* -------------------------------------------------------------------------------------------------------------- errors */

struct arrays {
    double v[MOST], a[MOST], limit[MOST];
    struct {
        double f[MOST], feq[MOST], d[3][MOST];
    } out;
};

static tribo_context *create(size_t n)
{
    tribo_context *c;
    double unit[MOST];
    for (size_t i = 0; i < n; i++) {
        unit[i] = 1.0;
    }
    assert_ok(tribo_create(&c, n));
    assert_ok(tribo_set_limit(c, unit));
    assert_ok(tribo_set_epsilon(c, unit));
    assert_ok(tribo_set_operator_diagonal(c, unit));
    return c;
}

/* x[i] = value makes the call fail with this status, and a message that names it. */
static void expect(tribo_context *c, int got, int want, const char *name, size_t i, double value)
{
    char text[80];
    snprintf(text, sizeof text, "%s[%zu] = %g is ", name, i, value);
    require(got == want, "%s: %d, not %d", text, got, want);
    assert_says(tribo_message(c), text);
}

static void expect_all(tribo_context *c, struct arrays *s, size_t i, double value)
{
    const double v = s->v[i], a = s->a[i];
    const int status = TRIBO_ERR_NOT_FINITE;
    stain(&s->out, sizeof s->out);
    s->v[i] = value;
    assert_status(tribo_force(c, s->v, s->a, s->out.f), status);
    assert_status(tribo_force_tangent(c, s->v, s->a, s->out.f, s->out.d[0], s->out.d[1], s->out.d[2]), status);
    expect(c, tribo_balance(c, s->v, s->a, s->out.feq, s->out.f), status, "v", i, value);
    s->v[i] = v;
    s->a[i] = value;
    assert_status(tribo_force(c, s->v, s->a, s->out.f), status);
    assert_status(tribo_force_tangent(c, s->v, s->a, s->out.f, s->out.d[0], s->out.d[1], s->out.d[2]), status);
    expect(c, tribo_balance(c, s->v, s->a, s->out.feq, s->out.f), status, "a", i, value);
    s->a[i] = a;
    ck_assert(stained(&s->out, sizeof s->out));
}

static void expect_limit(tribo_context *c, struct arrays *s, size_t n, size_t i, double value, int status)
{
    double kept[MOST];
    s->limit[i] = value;
    expect(c, tribo_set_limit(c, s->limit), status, "limit", i, value);
    s->limit[i] = 1.0;
    assert_ok(tribo_get_limit(c, kept));
    for (size_t k = 0; k < n; k++) {
        assert_exact(kept[k], 1.0);
    }
}

TEST(culprits)
{
    const size_t n = counts[_i];
    tribo_context *c = create(n);
    static struct arrays s;
    for (size_t i = 0; i < n; i++) {
        s.v[i] = 0.5 - (double)(i % 2);
        s.a[i] = 0.25;
        s.limit[i] = 1.0;
    }
    for (size_t k = 0; k < COUNT(places) && places[k] < n; k++) {
        const double values[] = {NAN, INFINITY, -INFINITY};
        for (size_t m = 0; m < COUNT(values); m++) {
            expect_all(c, &s, places[k], values[m]);
            expect_limit(c, &s, n, places[k], values[m], TRIBO_ERR_NOT_FINITE);
        }
        expect_limit(c, &s, n, places[k], -DBL_MIN, TRIBO_ERR_NEGATIVE);
        s.limit[places[k]] = -0.0;
        assert_ok(tribo_set_limit(c, s.limit));
        s.limit[places[k]] = 1.0;
        assert_ok(tribo_set_limit(c, s.limit));
    }
    tribo_destroy(c);
}

/* Where f_eq does not matter it may be anything, and beyond 1e300 it is cut, also beside others that are plain. */
TEST(feq_that_does_not_matter)
{
    const size_t n = counts[_i];
    tribo_context *c = create(n);
    double v[MOST], feq[MOST], want[MOST], got[MOST];
    for (size_t i = 0; i < n; i++) {
        v[i] = i % 3 ? 0.25 : -4.0;
        feq[i] = 0.125 * (double)(i % 5);
    }
    assert_ok(tribo_force(c, v, feq, want));
    for (size_t k = 0; k < COUNT(places) && places[k] < n; k++) {
        const size_t i = places[k];
        const double before = feq[i];
        feq[i] = i % 3 ? before : k % 2 ? (double)NAN : -(double)INFINITY;
        assert_ok(tribo_force(c, v, feq, got));
        assert_all_exact(got, want, n);
        feq[i] = i % 3 ? 1.7e308 : before;
        assert_ok(tribo_force(c, v, feq, got));
        assert_exact(got[i], i % 3 ? 0.5 : 1.0);
        feq[i] = before;
    }
    tribo_destroy(c);
}

/* -------------------------------------------------------------------------------------------------------------- places */

struct scene {
    double r[MOST], limit[MOST], epsilon[MOST], v[MOST], a[MOST];
};

/* Chunks in which all contacts have one limit and one epsilon, chunks in which one has not, and others; all of the first kind,
 * of which only some have those of the chunk before; and chunks that have one epsilon, but many limits. */
static struct scene draw(struct random *g, int kind)
{
    struct scene s;
    for (size_t i = 0; i < MOST; i++) {
        const int alike = kind == 0 || (kind == 1 && i != 130 && i != MOST - 1) || (kind == 2 && i < 128);
        s.r[i] = i % 50 ? log_uniform(g, 2.0) : 0.0;
        s.limit[i] = kind == 4 ? 1.0 + (double)(i / 256 % 2) : alike ? 1.25 : below(g, 9) ? log_uniform(g, 1.0) : 0.0;
        s.epsilon[i] = kind >= 4 ? 1.5 + (double)(i / 384 % 2) : alike ? 0.75 : log_uniform(g, 1.0);
        s.v[i] = below(g, 4) ? uniform(g, -2.0, 2.0) * s.epsilon[i] : below(g, 2) ? s.epsilon[i] : 0.0;
        s.a[i] = uniform(g, -2.0, 2.0) * s.limit[i] * (i % 7 ? 1.0 : s.r[i]);
    }
    return s;
}

struct results {
    double f[MOST], df[4][MOST], feq[MOST], balanced[MOST], only[MOST];
    signed char slip[MOST];
};

static void call(int law, int follows, const struct scene *s, size_t i, size_t n, struct results *r)
{
    tribo_context *c;
    assert_ok(tribo_create(&c, n));
    assert_ok(tribo_set_law(c, law));
    assert_ok(tribo_set_limit(c, s->limit + i));
    assert_ok(tribo_set_operator_diagonal(c, s->r + i));
    assert_ok(follows ? tribo_set_epsilon_step(c, 0.1, 0.5) : tribo_set_epsilon(c, s->epsilon + i));
    assert_ok(tribo_accept(c, s->v + i, s->a + i));
    assert_ok(tribo_force(c, s->v + i, s->a + i, r->f + i));
    assert_ok(tribo_force_tangent(c, s->v + i, s->a + i, r->df[3] + i, r->df[0] + i, r->df[1] + i, r->df[2] + i));
    assert_ok(tribo_balance(c, s->v + i, s->a + i, NULL, r->only + i));
    assert_ok(tribo_balance(c, s->v + i, s->a + i, r->feq + i, r->balanced + i));
    assert_ok(tribo_get_slip(c, r->slip + i));
    tribo_destroy(c);
}

TEST(as_alone)
{
    static struct results many, each;
    struct random g = random_of(_i);
    const struct scene s = draw(&g, _i % 6);
    for (int law = 0; law < tribo_law_count(); law++) {
        for (int follows = 0; follows < 2; follows++) {
            call(law, follows, &s, 0, MOST, &many);
            for (size_t i = 0; i < MOST; i++) {
                call(law, follows, &s, i, 1, &each);
            }
            assert_all_exact(many.f, each.f, MOST);
            assert_all_exact(many.df[3], many.f, MOST);
            for (int k = 0; k < 4; k++) {
                assert_all_exact(many.df[k], each.df[k], MOST);
            }
            assert_all_exact(many.feq, each.feq, MOST);
            assert_all_exact(many.balanced, each.balanced, MOST);
            assert_all_exact(many.only, each.balanced, MOST);
            ck_assert_mem_eq(many.slip, each.slip, MOST);
        }
    }
}

/* Velocities around those that a step stops; in some chunks all are faster. */
static struct scene draw_step(struct random *g, double dt, double scale)
{
    struct scene s;
    for (size_t i = 0; i < MOST; i++) {
        const int fast = i / 128 % 3 == 1;
        s.r[i] = i % 50 ? scale * (i < 600 ? 3.0 : log_uniform(g, 2.0)) : 0.0;
        s.limit[i] = i < 400 ? 1.25 : fast || below(g, 9) ? log_uniform(g, 1.0) : 0.0;
        const double stopped = (fast ? 3.0 * scale : s.r[i]) * dt * s.limit[i];
        s.v[i] = (below(g, 2) ? 1.0 : -1.0) * (fast ? uniform(g, 0.95, 9.0) : uniform(g, 0.0, 2.0)) * stopped;
        s.v[i] = below(g, 9) || fast ? s.v[i] : 0.0;
    }
    return s;
}

static void step(const struct scene *s, double dt, size_t i, size_t n, double *f, signed char *slip)
{
    tribo_context *c;
    assert_ok(tribo_create(&c, n));
    assert_ok(tribo_set_limit(c, s->limit + i));
    assert_ok(tribo_set_operator_diagonal(c, s->r + i));
    assert_ok(tribo_step_force(c, dt, s->v + i, f + i));
    assert_ok(tribo_get_slip(c, slip + i));
    tribo_destroy(c);
}

/* What stops a contact, as far as its limit allows: to a few roundings, and the same bits wherever it stands. */
TEST(steps_as_alone)
{
    const double steps[] = {1e-3, 1.0, 1e150, 1e-120, 1e-305}, scales[] = {1.0, 1e150, 1e-150, 1e-130};
    const double dt = steps[(size_t)_i % COUNT(steps)], scale = scales[(size_t)_i / COUNT(steps) % COUNT(scales)];
    struct random g = random_of(_i);
    const struct scene s = draw_step(&g, dt, scale);
    double many[MOST], each[MOST];
    signed char slip[2][MOST];
    step(&s, dt, 0, MOST, many, slip[0]);
    for (size_t i = 0; i < MOST; i++) {
        step(&s, dt, i, 1, each, slip[1]);
        const long double stops = -(long double)s.v[i] / ((long double)dt * fmax(s.r[i], DBL_MIN));
        const double want = (double)fminl(fmaxl(stops, -s.limit[i]), s.limit[i]);
        require(fabs(many[i] - want) <= 1e-15 * fabs(want), "f[%zu] = %.17g, not %.17g", i, many[i], want);
        require(fabs(want) < 0.999 * s.limit[i] ? slip[0][i] == TRIBO_SLIP_STUCK : 1, "contact %zu slips by %d", i, slip[0][i]);
    }
    ck_assert_mem_eq(many, each, sizeof many);
    ck_assert_mem_eq(slip[0], slip[1], MOST);
}

/* f_eq = -a/R_ii for numbers of any size, which are not looked at like others. */
TEST(feq_of_any_size)
{
    static const double sizes[] = {0.0, 1e-300, 1e-120, 1e-3, 1.0, 1e10, 1e99, 1e101, 1e250, 1e305, DBL_MAX};
    enum { SIZES = sizeof sizes / sizeof *sizes, N = SIZES * SIZES };
    const double zero[N] = {0};
    double r[N], a[N], feq[N], f[N];
    tribo_context *c;
    for (size_t i = 0; i < N; i++) {
        r[i] = sizes[i / SIZES];
        a[i] = sizes[i % SIZES];
    }
    assert_ok(tribo_create(&c, N));
    assert_ok(tribo_set_limit_all(c, 1e200));
    assert_ok(tribo_set_operator_diagonal(c, r));
    assert_ok(tribo_balance(c, zero, a, feq, f));
    for (size_t i = 0; i < N; i++) {
        const double want = (double)fmaxl(-(long double)a[i] / fmax(r[i], DBL_MIN), -1e300);
        require(fabs(feq[i] - want) <= 1e-15 * fabs(want) + DBL_MIN, "f_eq = %.17g, not %.17g, at %g/%g", feq[i], want, a[i],
                r[i]);
        require(fabs(f[i] - fmax(want, -1e200)) <= 1e-15 * fabs(want) + DBL_MIN, "f = %.17g of f_eq = %.17g", f[i], feq[i]);
    }
    tribo_destroy(c);
}

/* So many contacts that no output stays in a cache: a small scene again and again. */
#define MANY (((size_t)1 << 22) + 77)

struct large {
    double *v, *a, *setting, *memory; /* [MANY] but for the memory of outputs */
    double *out[4];                   /* as far from the beginning of a line of cache as can be, in four ways */
    tribo_context *c;
};

static void repeat(const double *few, double *many)
{
    for (size_t i = 0; i < MANY; i++) {
        many[i] = few[i % MOST];
    }
}

static struct large enlarge(const struct scene *s)
{
    struct large h;
    h.v = malloc(7 * (MANY + 16) * sizeof *h.v);
    ck_assert_ptr_nonnull(h.v);
    h.a = h.v + MANY;
    h.setting = h.a + MANY;
    h.memory = h.setting + MANY;
    for (size_t k = 0; k < 4; k++) {
        h.out[k] = h.memory + k * (MANY + 10) + 1;
    }
    assert_ok(tribo_create(&h.c, MANY));
    repeat(s->limit, h.setting);
    assert_ok(tribo_set_limit(h.c, h.setting));
    repeat(s->epsilon, h.setting);
    assert_ok(tribo_set_epsilon(h.c, h.setting));
    repeat(s->r, h.setting);
    assert_ok(tribo_set_operator_diagonal(h.c, h.setting));
    repeat(s->v, h.v);
    repeat(s->a, h.a);
    return h;
}

/* Output k is that of the small scene, and what is around it was not written to. */
static void assert_repeated(const struct large *h, size_t k, const double *few)
{
    for (size_t i = 0; i < MANY; i += MOST) {
        assert_all_exact(h->out[k] + i, few, MANY - i < MOST ? MANY - i : MOST);
    }
    ck_assert(stained(h->out[k] - 1, sizeof *h->out[k]) && stained(h->out[k] + MANY, sizeof *h->out[k]));
}

TEST(as_few)
{
    enum { OUTPUTS = 4 };
    static struct results few;
    struct random g = random_of(_i);
    const struct scene s = draw(&g, 1);
    struct large h = enlarge(&s);
    const size_t bytes = OUTPUTS * (MANY + 10) * sizeof *h.memory;
    call(TRIBO_QUINN, 0, &s, 0, MOST, &few);
    stain(h.memory, bytes);
    assert_ok(tribo_force_tangent(h.c, h.v, h.a, h.out[0], h.out[1], h.out[2], h.out[3]));
    const double *want[] = {few.f, few.df[0], few.df[1], few.df[2]};
    for (size_t k = 0; k < OUTPUTS; k++) {
        assert_repeated(&h, k, want[k]);
    }
    stain(h.memory, bytes);
    assert_ok(tribo_force(h.c, h.v, h.a, h.out[0]));
    assert_ok(tribo_balance(h.c, h.v, h.a, h.out[1], h.out[2]));
    assert_repeated(&h, 0, few.f);
    assert_repeated(&h, 1, few.feq);
    assert_repeated(&h, 2, few.balanced);
    stain(h.memory, bytes);
    h.v[MANY - 1] = NAN;
    assert_status(tribo_force(h.c, h.v, h.a, h.out[0]), TRIBO_ERR_NOT_FINITE);
    assert_status(tribo_force_tangent(h.c, h.v, h.a, h.out[0], h.out[1], h.out[2], h.out[3]), TRIBO_ERR_NOT_FINITE);
    assert_status(tribo_balance(h.c, h.v, h.a, h.out[1], h.out[2]), TRIBO_ERR_NOT_FINITE);
    ck_assert(stained(h.memory, bytes));
    tribo_destroy(h.c);
    free(h.v);
}

/* R near the largest double: a step stops what it can stop, also for one contact. */
TEST(steps_of_far_operators)
{
    const double r[] = {1.548e305, 1.548e305}, v[] = {2.245e77, 2.245e77}, dt = 1.628e-212;
    for (size_t n = 1; n <= 2; n++) {
        double f[2];
        tribo_context *c;
        assert_ok(tribo_create(&c, n));
        assert_ok(tribo_set_operator_diagonal(c, r));
        assert_ok(tribo_set_limit_all(c, 1.239e-11));
        assert_ok(tribo_step_force(c, dt, v, f));
        for (size_t i = 0; i < n; i++) {
            assert_close(f[i], -v[0] / (dt * r[0]), 1e-14 * 9e-17);
        }
        tribo_destroy(c);
    }
}

TEST_MAIN("borders", {culprits, COUNT(counts)}, {feq_that_does_not_matter, COUNT(counts)}, {as_alone, 12}, {steps_as_alone, 20},
          {feq_of_any_size, 1}, {as_few, 1}, {steps_of_far_operators, 1})
