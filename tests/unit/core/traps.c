/* SPDX-License-Identifier: BSD-3-Clause */
/* No call raises a floating-point exception, and what it answers is finite, also where numbers are far from ordinary: R_ii = 0,
 * limits of 0 or beyond all forces, epsilon next to nothing. Every test runs twice: first exceptions are looked for after each
 * call, which tells the call; then they are trapped. */
#include "problem.h"
#include "traps.h"

#define TINY 4.9406564584124654e-324 /* the smallest number */

static double one_of(struct random *g, const double *x, size_t n)
{
    return x[below(g, n)];
}
#define ONE_OF(g, ...) one_of(g, (const double[]){__VA_ARGS__}, COUNT(((const double[]){__VA_ARGS__})))

static double either(struct random *g, double x)
{
    return below(g, 2) ? x : -x;
}

/* Whether to go on: traps are set in odd runs. */
static int trapped(int run)
{
    return run % 2 == 0 || set_traps();
}

/* ------------------------------------------------------------------------------------------------------- one contact */

TEST(single_contacts)
{
    const double sizes[] = {0.0, TINY, 1e-310, DBL_MIN, 1e-160, 1e-6, 1.0, 3.0, 1e10, 1e160, 1e300, DBL_MAX};
    const size_t n = COUNT(sizes);
    for (size_t k = 0; trapped(_i) && k < n * n * n * n; k++) {
        const double limit = sizes[k % n], epsilon = sizes[k / n % n], feq = sizes[k / n / n % n], size = sizes[k / n / n / n];
        const double v[] = {size, -size, 0.3 * fmin(size, epsilon)};
        for (size_t i = 0; epsilon > 0.0 && i < COUNT(v); i++) {
            double f, d[3];
            assert_quiet(tribo_law_eval(_i / 2, v[i], feq, limit, epsilon, &f, d, d + 1, d + 2));
            require(fabs(f) <= limit, "|%g| > %g", f, limit);
            require(isfinite(d[0]) && isfinite(d[1]) && isfinite(d[2]),
                    "derivatives %g %g %g of limit %g, epsilon %g, v %g, feq %g", d[0], d[1], d[2], limit, epsilon, v[i], feq);
        }
    }
}

/* f_eq of contacts that slide is not read: it may be no number. */
TEST(unset_feq)
{
    enum { N = 300 };
    double v[N], feq[N], f[N], d[3][N];
    tribo_context *c;
    assert_ok(tribo_create(&c, N));
    assert_ok(tribo_set_law(c, _i / 2));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_epsilon_all(c, 0.5));
    for (size_t i = 0; i < N; i++) {
        v[i] = i % 3 ? -1.0 : 0.0;
        feq[i] = i % 3 ? (double)NAN : 0.25;
    }
    if (trapped(_i)) {
        assert_quiet(tribo_force(c, v, feq, f));
        assert_quiet(tribo_force_tangent(c, v, feq, f, d[0], d[1], d[2]));
        assert_quiet(tribo_accept(c, v, feq));
        assert_quiet(tribo_law_eval(_i / 2, -1.0, NAN, 1.0, 0.5, f, d[0], d[1], d[2]));
    }
    tribo_destroy(c);
}

/* ------------------------------------------------------------------------------------------------------ many contacts */

#define N 12

/* How far from ordinary the numbers of a scene are. */
struct scene {
    size_t n;
    tribo_context *c;
    const double *limits, *pulls; /* what limits, and accelerations and velocities, are drawn from */
    size_t limits_count, pulls_count;
    double limit[N];
};

static void set_limits(struct random *g, struct scene *s)
{
    for (size_t i = 0; i < s->n; i++) {
        s->limit[i] = one_of(g, s->limits, s->limits_count);
    }
    assert_quiet(tribo_set_limit(s->c, s->limit));
}

static void set_widths(struct random *g, struct scene *s)
{
    double epsilon[N];
    for (size_t i = 0; i < s->n; i++) {
        epsilon[i] = ONE_OF(g, TINY, 1e-310, 1e-300, 1e-6, 1e-3, 1.0, 1e300, DBL_MAX);
    }
    if (below(g, 2)) {
        assert_quiet(tribo_set_epsilon(s->c, epsilon));
    } else {
        assert_quiet(tribo_set_epsilon_step(s->c, ONE_OF(g, 1e-300, 1e-6, 1e-2, 1.0, 1e300), ONE_OF(g, 1e-300, 0.4, 1.0, 1e300)));
    }
}

static void set_other(struct random *g, struct scene *s)
{
    assert_quiet(tribo_set_law(s->c, (int)below(g, 6)));
    assert_quiet(tribo_set_coupling(s->c, (int)below(g, 2)));
    assert_quiet(tribo_set_sharing(s->c, (int)below(g, 2)));
}

static void draw(struct random *g, const struct scene *s, double *x)
{
    for (size_t i = 0; i < s->n; i++) {
        x[i] = either(g, one_of(g, s->pulls, s->pulls_count));
    }
}

/* Velocities at which contacts are near stick, or slide. */
static void draw_velocities(struct random *g, const struct scene *s, double *v)
{
    double epsilon[N];
    assert_quiet(tribo_get_epsilon(s->c, epsilon));
    draw(g, s, v);
    for (size_t i = 0; i < s->n; i++) {
        v[i] = below(g, 3) ? either(g, epsilon[i] * ONE_OF(g, 0.0, 0.0, 0.3, 0.5, 1.0)) : v[i];
    }
}

static void check_numbers(const struct scene *s, const char *what, const double *x, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        require(isfinite(x[k]), "%s[%zu] of %zu contacts is %g", what, k, s->n, x[k]);
    }
}

static void check_forces(const struct scene *s, const char *what, const double *f)
{
    check_numbers(s, what, f, s->n);
    for (size_t i = 0; i < s->n; i++) {
        require(fabs(f[i]) <= s->limit[i], "%s: |%g| > %g of contact %zu", what, f[i], s->limit[i], i);
    }
}

/* In the partition coupling there may be no f_eq. */
static int balanced(int status)
{
    require(!status || status == TRIBO_ERR_INCONSISTENT, "%s", tribo_strerror(status));
    return !status;
}

static void ask_forces(struct random *g, struct scene *s)
{
    double v[N], a[N], feq[N] = {0}, f[N], d[3][N], dv[N * N], da[N * N];
    draw_velocities(g, s, v);
    draw(g, s, a);
    balanced(quiet(tribo_balance(s->c, v, a, below(g, 2) ? feq : NULL, f)));
    check_forces(s, "balance", f);
    check_numbers(s, "feq", feq, s->n);
    if (balanced(quiet(tribo_balance_tangent(s->c, v, a, feq, f, dv, da)))) {
        check_forces(s, "balance_tangent", f);
        check_numbers(s, "df_dv", dv, s->n * s->n);
        check_numbers(s, "df_da", da, s->n * s->n);
        draw(g, s, d[0]);
        draw(g, s, d[1]);
        assert_quiet(tribo_tangent_product(s->c, d[0], d[1], f));
        check_numbers(s, "product", f, s->n);
        assert_quiet(tribo_limit_product(s->c, d[0], f));
        check_numbers(s, "limit_product", f, s->n);
    }
    draw(g, s, feq);
    assert_quiet(tribo_force_tangent(s->c, v, feq, f, d[0], d[1], d[2]));
    check_forces(s, "force", f);
    check_numbers(s, "derivatives", d[0], s->n);
    check_numbers(s, "derivatives", d[1], s->n);
    check_numbers(s, "derivatives", d[2], s->n);
    assert_quiet(tribo_accept(s->c, v, feq));
}

static void ask_steps(struct random *g, struct scene *s)
{
    double v[N], lower[N], upper[N], f[N];
    draw(g, s, v);
    assert_quiet(tribo_step_force(s->c, ONE_OF(g, 1e-3, 1.0, 1e3), v, f));
    check_forces(s, "step_force", f);
    for (size_t i = 0; i < s->n; i++) {
        const double x = either(g, one_of(g, s->limits, s->limits_count)), y = one_of(g, s->limits, s->limits_count);
        lower[i] = fmin(x, y);
        upper[i] = fmax(x, y);
    }
    assert_quiet(tribo_solve_box(s->c, v, lower, upper, f));
    check_numbers(s, "solve_box", f, s->n);
}

static void ask_queries(struct scene *s)
{
    signed char slip[N];
    tribo_context *copy;
    for (int which = 0; which <= TRIBO_REAL_MAX_STEP; which++) {
        double value;
        assert_quiet(tribo_get_real(s->c, which, &value));
        require(isfinite(value) || (which == TRIBO_REAL_MAX_STEP && value == HUGE_VAL), "real %d is %g", which, value);
    }
    for (int which = 0; which <= TRIBO_COUNT_REUSED; which++) {
        size_t value;
        assert_quiet(tribo_get_count(s->c, which, &value));
    }
    quiet(tribo_get_slip(s->c, slip));
    assert_quiet(tribo_clone(s->c, &copy));
    tribo_destroy(s->c);
    s->c = copy;
}

static void exercise(struct random *g, struct scene *s)
{
    for (int call = 0; call < 40; call++) {
        if (call % 4 == 0) {
            set_limits(g, s);
            set_widths(g, s);
            set_other(g, s);
        }
        ask_forces(g, s);
        ask_steps(g, s);
        ask_queries(s);
    }
    tribo_destroy(s->c);
}

static const double all_limits[] = {0.0, TINY, 1e-300, 1e-3, 1.0, 1e10, 1e300, DBL_MAX};
static const double all_pulls[] = {0.0, TINY, 1e-300, 1e-3, 1.0, 1e10, 1e300, DBL_MAX};
static const double ordinary_pulls[] = {0.0, TINY, 1e-300, 1e-6, 0.3, 1.0, 7.0, 1e10};

/* Contacts that share no body: any number at all. */
TEST(uncoupled)
{
    struct random g = random_of(_i / 2);
    struct scene s = {1 + below(&g, N), NULL, all_limits, all_pulls, COUNT(all_limits), COUNT(all_pulls), {0}};
    double r[N];
    if (!trapped(_i)) {
        return;
    }
    for (size_t i = 0; i < s.n; i++) {
        r[i] = ONE_OF(&g, 0.0, 0.0, TINY, 1e-310, DBL_MIN, 1e-200, 1e-3, 1.0, 1e10, 1e200, 1e300);
    }
    assert_quiet(tribo_create(&s.c, s.n));
    assert_quiet(tribo_set_operator_diagonal(s.c, r));
    exercise(&g, &s);
}

/* M^-1 force for masses of 1/data. */
static int divide(size_t ndof, const double *force, double *acceleration, void *data)
{
    const double *inverse = data;
    for (size_t k = 0; k < ndof; k++) {
        acceleration[k] = inverse[k] * force[k];
    }
    return 0;
}

/* Bodies with contacts between each other and the ground; those of the prescribed ones, with each other or the ground, cannot be
 * moved by friction. In all forms of the operator. */
TEST(coupled)
{
    enum { BODIES = 5 };
    struct random g = random_of(_i / 2);
    struct scene s = {1 + below(&g, N), NULL, all_limits, ordinary_pulls, COUNT(all_limits), COUNT(ordinary_pulls), {0}};
    double inverse[BODIES], val[2 * N], r[N * N] = {0}, rval[N * N];
    size_t first[N + 1] = {0}, col[2 * N], rfirst[N + 1] = {0}, rcol[N * N];
    if (!trapped(_i)) {
        return;
    }
    for (size_t b = 0; b < BODIES; b++) {
        inverse[b] = below(&g, 3) ? log_uniform(&g, _i / 2 % 3 ? 1.0 : 8.0) : 0.0;
    }
    for (size_t i = 0; i < s.n; i++) {
        const size_t one = below(&g, BODIES), other = below(&g, BODIES);
        first[i + 1] = first[i];
        col[first[i + 1]] = one;
        val[first[i + 1]++] = 1.0;
        if (other != one) {
            col[first[i + 1]] = other;
            val[first[i + 1]++] = -1.0;
        }
    }
    for (size_t i = 0; i < s.n; i++) {
        for (size_t j = 0; j < s.n; j++) {
            for (size_t k = first[i]; k < first[i + 1]; k++) {
                for (size_t l = first[j]; l < first[j + 1]; l++) {
                    r[i * s.n + j] += col[k] == col[l] ? val[k] * inverse[col[k]] * val[l] : 0.0;
                }
            }
            rcol[rfirst[i] + j] = j;
            rval[rfirst[i] + j] = r[i * s.n + j];
        }
        rfirst[i + 1] = rfirst[i] + s.n;
    }
    assert_quiet(tribo_create(&s.c, s.n));
    switch (_i / 2 % 4) {
    case 0:
        assert_quiet(tribo_set_operator_dense(s.c, r));
        break;
    case 1:
        assert_quiet(tribo_set_operator_csr(s.c, rfirst, rcol, rval));
        break;
    case 2:
        assert_quiet(tribo_set_operator_mass(s.c, BODIES, inverse, first, col, val));
        break;
    default:
        assert_quiet(tribo_set_operator_callback(s.c, BODIES, divide, inverse, first, col, val));
        break;
    }
    exercise(&g, &s);
}

/* A row of many bodies, which is kept sparse, and single contacts beside it, some immovable. */
TEST(sparse)
{
    enum { MANY = 700, ROW = 400 };
    struct random g = random_of(_i / 2);
    static size_t first[MANY + 1], col[3 * MANY];
    static double val[3 * MANY], v[MANY], a[MANY], f[MANY], feq[MANY], limit[MANY];
    tribo_context *c;
    size_t k = 0;
    if (!trapped(_i)) {
        return;
    }
    for (size_t i = 0; i < MANY; i++) {
        for (size_t j = i ? i - 1 : 0; j <= i + 1 && j < MANY; j++) {
            if (j == i || (i < ROW && j < ROW)) {
                col[k] = j;
                val[k++] = j != i ? -1.0 : i < ROW ? 2.0 : (double)(i % 3);
            }
        }
        first[i + 1] = k;
    }
    assert_quiet(tribo_create(&c, MANY));
    assert_quiet(tribo_set_operator_csr(c, first, col, val));
    for (int call = 0; call < 12; call++) {
        for (size_t i = 0; i < MANY; i++) {
            limit[i] = ONE_OF(&g, 0.0, 1e-300, 1.0, 1.0, 2.0, 1e300, DBL_MAX);
            v[i] = either(&g, ONE_OF(&g, 0.0, 0.0, 1e-300, 1e-4, 1.0, 1e10));
            a[i] = either(&g, ONE_OF(&g, 0.0, 1e-300, 1.0, 1e10));
        }
        assert_quiet(tribo_set_law(c, _i / 2));
        assert_quiet(tribo_set_limit(c, limit));
        assert_quiet(call % 3 ? tribo_set_epsilon_step(c, 1e-3, 1.0) : tribo_set_epsilon_all(c, 1e-3));
        assert_quiet(tribo_set_coupling(c, call % 2));
        for (int again = 0; again < 3; again++) {
            balanced(quiet(tribo_balance(c, v, a, again == 1 ? feq : NULL, f)));
            assert_quiet(tribo_step_force(c, 1e-3, v, f));
            v[below(&g, ROW)] = 0.0;
        }
    }
    tribo_destroy(c);
}

/* A step would end with the largest velocities that there are, which are beyond what friction can stop. */
TEST(far_steps)
{
    const double r[] = {2.0, 1.0, 1.0, 2.0}, limit[] = {1.0, 2.0}, v[] = {DBL_MAX, -1e308}, steps[] = {1e-300, 1e-3, 1.0, 1e300};
    double f[2];
    tribo_context *c;
    assert_ok(tribo_create(&c, 2));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_operator_dense(c, r));
    for (size_t k = 0; trapped(_i) && k < COUNT(steps); k++) {
        assert_quiet(tribo_step_force(c, steps[k], v, f));
        require(steps[k] > 1.0 || (f[0] == -1.0 && f[1] == 2.0), "dt %g: %g, %g", steps[k], f[0], f[1]);
    }
    tribo_destroy(c);
}

TEST_MAIN("traps", {far_steps, 2}, {single_contacts, 12}, {unset_feq, 12}, {uncoupled, 200}, {coupled, 200}, {sparse, 12})
