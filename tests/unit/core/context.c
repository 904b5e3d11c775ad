/* SPDX-License-Identifier: BSD-3-Clause */
/* Contexts: defaults, settings, copies; what epsilon follows; versions and texts. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "problem.h"

static tribo_context *create(size_t n)
{
    tribo_context *c;
    assert_ok(tribo_create(&c, n));
    return c;
}

TEST(defaults)
{
    tribo_context *c = create(3);
    size_t n = 0;
    int law = -1, coupling = -1;
    double x[3];
    const double zero[3] = {0}, epsilon[3] = {1e-6, 1e-6, 1e-6};
    assert_ok(tribo_get_ncontact(c, &n));
    assert_ok(tribo_get_law(c, &law));
    assert_ok(tribo_get_coupling(c, &coupling));
    ck_assert_uint_eq(n, 3);
    ck_assert_int_eq(law, TRIBO_QUINN);
    ck_assert_int_eq(coupling, TRIBO_CONSISTENT);
    ck_assert_str_eq(tribo_message(c), "");
    assert_ok(tribo_get_limit(c, x));
    assert_all_exact(x, zero, 3);
    assert_ok(tribo_get_epsilon(c, x));
    assert_all_exact(x, epsilon, 3);
    tribo_destroy(c);
    tribo_destroy(NULL);
}

/* Calls on c that need an operator, or an epsilon that follows one, write nothing and tell what is missing. */
static void check_missing(tribo_context *c, int epsilon)
{
    const double v[2] = {0}, a[2] = {1.0, -2.0};
    double f[2], square[4];
    stain(f, sizeof f);
    for (int call = 0; call < (epsilon ? 4 : 6); call++) {
        tribo_set_law(c, 999);
        const int status = epsilon ? (call == 0   ? tribo_get_epsilon(c, f)
                                      : call == 1 ? tribo_force(c, v, a, f)
                                      : call == 2 ? tribo_force_tangent(c, v, a, f, NULL, NULL, NULL)
                                                  : tribo_accept(c, v, a))
                                   : (call == 0   ? tribo_balance(c, v, a, NULL, f)
                                      : call == 1 ? tribo_balance_tangent(c, v, a, f, f, square, square)
                                      : call == 2 ? tribo_step_force(c, 0.1, a, f)
                                      : call == 3 ? tribo_solve_box(c, a, v, v, f)
                                      : call == 4 ? tribo_get_real(c, TRIBO_REAL_MAX_RATE, f)
                                                  : tribo_get_real(c, TRIBO_REAL_MAX_STEP, f));
        require(status == TRIBO_ERR_STATE, "call %d: %d", call, status);
        const int keeps = epsilon ? call < 3 : call > 3; /* a const context */
        assert_says(tribo_message(c), keeps ? "law = 999" : "no operator: call tribo_set_operator_diagonal");
    }
    ck_assert(stained(f, sizeof f));
}

/* There is no operator before one is set: what needs none works, what needs one says so, in a copy too. */
TEST(no_operator)
{
    const double r[2] = {0.5, 2.0}, v[2] = {0}, a[2] = {1.0, -2.0}, want[2] = {-2.0, 1.0}, width[2] = {0.09, 0.36};
    double f[2];
    tribo_context *c = create(2), *copy;
    assert_ok(tribo_set_limit_all(c, 9.0));
    assert_ok(tribo_set_law(c, TRIBO_QUINN_REVERSAL));
    check_missing(c, 0);
    assert_ok(tribo_force(c, v, a, f));
    assert_all_exact(f, a, 2);
    assert_ok(tribo_accept(c, v, a));
    assert_ok(tribo_get_real(c, TRIBO_REAL_RESIDUAL, f));
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_ISLANDS), 0);
    assert_ok(tribo_set_epsilon_step(c, 0.01, 1.0));
    check_missing(c, 1);
    assert_ok(tribo_clone(c, &copy));
    check_missing(copy, 0);
    check_missing(copy, 1);
    for (int which = 0; which < 2; which++) { /* epsilon follows once there is something to follow */
        tribo_context *d = which ? copy : c;
        assert_ok(tribo_set_operator_diagonal(d, r));
        assert_ok(tribo_get_epsilon(d, f));
        assert_all_close(f, width, 2, DBL_EPSILON);
        assert_ok(tribo_balance(d, v, a, NULL, f));
        assert_all_exact(f, want, 2);
        tribo_destroy(d);
    }
}

/* A fixed operator stays; that of a copy can be changed. */
TEST(fixed_operator)
{
    const double r[1] = {0.5}, other[1] = {2.0}, v[1] = {0}, a[1] = {1.0};
    const size_t rowptr[2] = {0, 1}, col[1] = {0};
    tribo_context *c = create(1), *copy;
    double f;
    assert_status(tribo_fix_operator(NULL), TRIBO_ERR_NULL);
    assert_ok(tribo_set_limit_all(c, 9.0));
    assert_ok(tribo_set_operator_diagonal(c, r));
    assert_ok(tribo_fix_operator(c));
    const int statuses[] = {tribo_set_operator_diagonal(c, other), tribo_set_operator_dense(c, other),
                            tribo_set_operator_csr(c, rowptr, col, other),
                            tribo_set_operator_mass(c, 1, other, rowptr, col, other),
                            tribo_set_operator_callback(c, 1, NULL, NULL, rowptr, col, other)};
    for (size_t k = 0; k < COUNT(statuses); k++) {
        ck_assert_int_eq(statuses[k], TRIBO_ERR_UNSUPPORTED);
    }
    assert_says(tribo_message(c), "the operator is fixed");
    assert_says(tribo_message(c), "tribo_clone");
    assert_ok(tribo_balance(c, v, a, NULL, &f));
    assert_exact(f, -2.0);
    assert_ok(tribo_clone(c, &copy));
    assert_ok(tribo_set_operator_diagonal(copy, other));
    assert_ok(tribo_balance(copy, v, a, NULL, &f));
    assert_exact(f, -0.5);
    tribo_destroy(copy);
    tribo_destroy(c);
}

TEST(settings)
{
    tribo_context *c = create(2);
    const double limit[2] = {0.5, 0.0}, epsilon[2] = {1e-3, 7.0}, all[2] = {4.0, 4.0};
    double x[2];
    int value;
    for (int law = 0; law < tribo_law_count(); law++) {
        assert_ok(tribo_set_law(c, law));
        assert_ok(tribo_get_law(c, &value));
        ck_assert_int_eq(value, law);
    }
    for (int coupling = 1; coupling >= 0; coupling--) {
        assert_ok(tribo_set_coupling(c, coupling));
        assert_ok(tribo_get_coupling(c, &value));
        ck_assert_int_eq(value, coupling);
    }
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_get_limit(c, x));
    assert_all_exact(x, limit, 2);
    assert_ok(tribo_set_limit_all(c, 4.0));
    assert_ok(tribo_get_limit(c, x));
    assert_all_exact(x, all, 2);
    assert_ok(tribo_set_epsilon(c, epsilon));
    assert_ok(tribo_get_epsilon(c, x));
    assert_all_exact(x, epsilon, 2);
    assert_ok(tribo_set_epsilon_all(c, 4.0));
    assert_ok(tribo_get_epsilon(c, x));
    assert_all_exact(x, all, 2);
    tribo_destroy(c);
}

/* epsilon = 2 N R dt/lambda_dt, through every later change, until it is given. */
TEST(epsilon_step)
{
    tribo_context *c = create(2);
    const double limit[2] = {1.0, 0.5}, r[2] = {0.25, 8.0}, dense[4] = {2.0, 1.0, 1.0, 4.0};
    const double steps[][2] = {{0.01, 1.0}, {0.5, 0.4}};
    double x[2];
    for (int k = 0; k < 2; k++) {
        const double time = steps[k][0] / steps[k][1];
        const double unit[2] = {2.0 * time, 2.0 * time}, limits[2] = {2.0 * time, time};
        const double both[2] = {0.5 * time, 8.0 * time}, coupled[2] = {4.0 * time, 4.0 * time};
        const double ones[2] = {1.0, 1.0};
        assert_ok(tribo_set_limit_all(c, 1.0));
        assert_ok(tribo_set_operator_diagonal(c, ones));
        assert_ok(tribo_set_epsilon_step(c, steps[k][0], steps[k][1]));
        assert_ok(tribo_get_epsilon(c, x));
        assert_all_close(x, unit, 2, 4.0 * DBL_EPSILON * time);
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_get_epsilon(c, x));
        assert_all_close(x, limits, 2, 4.0 * DBL_EPSILON * time);
        assert_ok(tribo_set_operator_diagonal(c, r));
        assert_ok(tribo_get_epsilon(c, x));
        assert_all_close(x, both, 2, 16.0 * DBL_EPSILON * time);
        assert_close(real_of(c, TRIBO_REAL_MAX_RATE) * time, 1.0, 4.0 * DBL_EPSILON);
        assert_ok(tribo_set_operator_dense(c, dense));
        assert_ok(tribo_get_epsilon(c, x));
        assert_all_close(x, coupled, 2, 16.0 * DBL_EPSILON * time);
        assert_close(real_of(c, TRIBO_REAL_MAX_RATE) * time, 1.0, 4.0 * DBL_EPSILON);
    }
    assert_ok(tribo_set_epsilon(c, limit));
    assert_ok(tribo_set_limit_all(c, 3.0));
    assert_ok(tribo_get_epsilon(c, x));
    assert_all_exact(x, limit, 2);
    tribo_destroy(c);
}

/* The law then reads clamp(clamp(f_eq) - (lambda_dt/(dt R)) v), also where the limit is too small to divide by. */
TEST(epsilon_step_without_division)
{
    tribo_context *c = create(3);
    const double limit[3] = {1.0, 1e-300, 0.0}, v[3] = {0.002, 0.0, 0.0}, feq[3] = {0.5, 1e-301, 5.0};
    const double want[3] = {0.3, 1e-301, 0.0}, unit[3] = {1.0, 1.0, 1.0};
    double f[3];
    assert_ok(tribo_set_operator_diagonal(c, unit));
    assert_ok(tribo_set_epsilon_step(c, 0.01, 1.0));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_force(c, v, feq, f));
    assert_close(f[0], want[0], 2.0 * DBL_EPSILON);
    assert_all_exact(f + 1, want + 1, 2);
    tribo_destroy(c);
}

TEST(open_contacts)
{
    struct random g = random_of(_i);
    const double coupled[4] = {2.0, 1.0, 1.0, 2.0}, alone[2] = {1.0, 1.0}, limit[2] = {0.0, 1.0};
    tribo_context *c = create(2);
    assert_ok(tribo_set_law(c, _i % 6));
    assert_ok(tribo_set_coupling(c, _i / 6 % 2));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(_i / 12 ? tribo_set_operator_dense(c, coupled) : tribo_set_operator_diagonal(c, alone));
    for (int k = 0; k < 50; k++) {
        const double v[2] = {uniform(&g, -1e-6, 1e-6) * (double)(k % 2), 0.0}, a[2] = {uniform(&g, -9, 9), 0.25};
        double feq[2], f[2];
        signed char slip[2];
        assert_ok(tribo_balance(c, v, a, feq, f));
        assert_exact(f[0], 0.0);
        assert_exact(feq[0], 0.0);
        assert_ok(tribo_get_slip(c, slip));
        ck_assert_int_eq(slip[0], TRIBO_SLIP_OPEN);
        assert_ok(tribo_step_force(c, 1.0, a, f));
        assert_exact(f[0], 0.0);
        assert_ok(tribo_force(c, v, a, f));
        assert_exact(f[0], 0.0);
    }
    tribo_destroy(c);
}

/* A contact that opens lets go at once. */
TEST(opening_contacts)
{
    const double r[4] = {2.0, 1.0, 1.0, 2.0}, v[2] = {0}, a[2] = {0.5, 0.5}, limit[2] = {1.0, 0.0}, want[2] = {-0.25, 0.0};
    for (int k = 0; k < 4; k++) {
        double f[2];
        tribo_context *c = create(2);
        assert_ok(tribo_set_operator_dense(c, r));
        assert_ok(tribo_set_coupling(c, k % 2));
        assert_ok(tribo_set_limit_all(c, 1.0));
        assert_ok(tribo_balance(c, v, a, NULL, f));
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(k / 2 == 0 ? tribo_balance(c, v, a, NULL, f) : tribo_step_force(c, 1.0, a, f));
        assert_all_close(f, want, 2, DBL_EPSILON);
        tribo_destroy(c);
    }
}

/* With no contacts nothing is read, and NULL will do for every array. */
TEST(no_contacts)
{
    tribo_context *c = create(0), *copy = NULL;
    const size_t rowptr[1] = {0};
    size_t n = 9;
    assert_ok(tribo_balance(c, NULL, NULL, NULL, NULL)); /* nor an operator */
    assert_ok(tribo_step_force(c, 0.1, NULL, NULL));
    assert_ok(tribo_set_limit(c, NULL));
    assert_ok(tribo_set_epsilon(c, NULL));
    assert_ok(tribo_set_epsilon_step(c, 0.1, 1.0));
    assert_ok(tribo_set_operator_diagonal(c, NULL));
    assert_ok(tribo_set_operator_dense(c, NULL));
    assert_ok(tribo_set_operator_csr(c, rowptr, NULL, NULL));
    assert_ok(tribo_set_operator_mass(c, 0, NULL, rowptr, NULL, NULL));
    assert_ok(tribo_get_limit(c, NULL));
    assert_ok(tribo_force(c, NULL, NULL, NULL));
    assert_ok(tribo_force_tangent(c, NULL, NULL, NULL, NULL, NULL, NULL));
    assert_ok(tribo_balance(c, NULL, NULL, NULL, NULL));
    assert_ok(tribo_balance_tangent(c, NULL, NULL, NULL, NULL, NULL, NULL));
    assert_ok(tribo_step_force(c, 0.1, NULL, NULL));
    assert_ok(tribo_accept(c, NULL, NULL));
    assert_ok(tribo_get_slip(c, NULL));
    assert_ok(tribo_clone(c, &copy));
    assert_ok(tribo_get_ncontact(copy, &n));
    ck_assert_uint_eq(n, 0);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_ISLANDS), 0);
    assert_exact(real_of(c, TRIBO_REAL_MAX_STEP), HUGE_VAL);
    tribo_destroy(copy);
    tribo_destroy(c);
}

/* Laws that do not ask for f_eq do not need the array either. */
TEST(no_feq)
{
    const double v[2] = {0.5, -3.0};
    double f[2], d[2];
    tribo_context *c = create(2);
    assert_ok(tribo_set_law(c, _i ? TRIBO_SMOOTH : TRIBO_VELOCITY_LIMITED));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_epsilon_all(c, 1.0));
    assert_ok(tribo_force(c, v, NULL, f));
    assert_exact(f[0], law_force(_i ? TRIBO_SMOOTH : TRIBO_VELOCITY_LIMITED, 0.5, 0.0, 1.0, 1.0));
    assert_ok(tribo_force_tangent(c, v, NULL, NULL, d, NULL, NULL));
    assert_ok(tribo_accept(c, v, NULL));
    tribo_destroy(c);
}

/* ------------------------------------------------------------------------------------------------------------ copies */

/* What a context answers to a few questions, settings and memory included. */
struct fingerprint {
    int law, coupling;
    double limit[3], epsilon[3], feq[3], f[3], atop[3];
    signed char slip[3];
};

static struct fingerprint fingerprint(tribo_context *c)
{
    const double v[3] = {0.1, 0.0, -0.2}, a[3] = {0.5, -4.0, 1.0}, rest[3] = {0}, twice[3] = {9.0, 9.0, -9.0};
    struct fingerprint x;
    memset(&x, 0, sizeof x);
    assert_ok(tribo_get_law(c, &x.law));
    assert_ok(tribo_get_coupling(c, &x.coupling));
    assert_ok(tribo_get_limit(c, x.limit));
    assert_ok(tribo_get_epsilon(c, x.epsilon));
    assert_ok(tribo_force(c, rest, twice, x.atop));
    assert_ok(tribo_get_slip(c, x.slip));
    assert_ok(tribo_balance(c, v, a, x.feq, x.f));
    return x;
}

/* Everything but the defaults. */
static tribo_context *unusual(void)
{
    const double r[9] = {2.0, 1.0, 0.5, 1.0, 2.0, 0.25, 0.5, 0.25, 1.0}, limit[3] = {1.0, 2.0, 3.0};
    const double fast[3] = {9.0, 0.0, -9.0}, rest[3] = {0};
    tribo_context *c = create(3);
    assert_ok(tribo_set_law(c, TRIBO_QUINN_REVERSAL));
    assert_ok(tribo_set_coupling(c, TRIBO_PARTITION));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_set_epsilon_step(c, 0.1, 1.0));
    assert_ok(tribo_accept(c, fast, rest));
    assert_ok(tribo_balance(c, rest, limit, NULL, NULL));
    return c;
}

static void upset(tribo_context *c)
{
    const double r[3] = {5.0, 6.0, 7.0}, rest[3] = {0};
    assert_ok(tribo_accept(c, rest, rest));
    assert_ok(tribo_set_law(c, TRIBO_SMOOTH));
    assert_ok(tribo_set_coupling(c, TRIBO_CONSISTENT));
    assert_ok(tribo_set_limit_all(c, 0.1));
    assert_ok(tribo_set_epsilon_all(c, 0.1));
    assert_ok(tribo_set_operator_diagonal(c, r));
    assert_status(tribo_set_law(c, 99), TRIBO_ERR_RANGE);
}

TEST(clones)
{
    tribo_context *c = unusual(), *copies[2];
    assert_ok(tribo_clone(c, &copies[0]));
    assert_ok(tribo_clone(c, &copies[1]));
    for (int which = 0; which <= TRIBO_COUNT_REVERSALS; which++) {
        ck_assert_uint_eq(count_of(copies[0], which), count_of(c, which));
    }
    const struct fingerprint x = fingerprint(c), first = fingerprint(copies[0]);
    ck_assert_mem_eq(&first, &x, sizeof x);
    upset(c);
    ck_assert_str_eq(tribo_message(copies[1]), "");
    tribo_destroy(c);
    upset(copies[0]);
    tribo_destroy(copies[0]);
    const struct fingerprint second = fingerprint(copies[1]);
    ck_assert_mem_eq(&second, &x, sizeof x);
    /* epsilon still follows the limits in the copy */
    double epsilon[3];
    const double twice[3] = {2.0, 4.0, 6.0};
    assert_ok(tribo_set_limit(copies[1], twice));
    assert_ok(tribo_get_epsilon(copies[1], epsilon));
    assert_close(epsilon[2], 2.0 * x.epsilon[2], 4.0 * DBL_EPSILON * epsilon[2]);
    tribo_destroy(copies[1]);
}

/* ------------------------------------------------------------------------------------------------------ versions, texts */

TEST(versions)
{
    char *end;
    const char *text = tribo_version_string();
    const long major = strtol(text, &end, 10), minor = strtol(end + 1, &end, 10), patch = strtol(end + 1, &end, 10);
    ck_assert_int_eq(*end, 0);
    ck_assert_int_eq(tribo_version(), 10000 * major + 100 * minor + patch);
    ck_assert_int_eq(tribo_version(), TRIBO_VERSION);
}

TEST(texts_of_statuses)
{
    const int known[] = {TRIBO_OK,
                         TRIBO_ERR_NULL,
                         TRIBO_ERR_NOT_FINITE,
                         TRIBO_ERR_NEGATIVE,
                         TRIBO_ERR_RANGE,
                         TRIBO_ERR_SIZE,
                         TRIBO_ERR_NOT_POSITIVE,
                         TRIBO_ERR_NAME,
                         TRIBO_ERR_STATE,
                         TRIBO_ERR_UNSUPPORTED,
                         TRIBO_ERR_MEMORY,
                         TRIBO_ERR_STOPPED,
                         TRIBO_ERR_STEP,
                         TRIBO_ERR_CALLBACK,
                         TRIBO_ERR_CHATTER,
                         TRIBO_ERR_NOT_SYMMETRIC,
                         TRIBO_ERR_DUPLICATE,
                         TRIBO_ERR_INDEFINITE,
                         TRIBO_ERR_INCONSISTENT,
                         TRIBO_ERR_NO_CONVERGENCE};
    const char *unknown = tribo_strerror(-1);
    for (size_t i = 0; i < COUNT(known); i++) {
        ck_assert_str_ne(tribo_strerror(known[i]), unknown);
        for (size_t j = 0; j < i; j++) {
            ck_assert_str_ne(tribo_strerror(known[i]), tribo_strerror(known[j]));
        }
    }
    const int odd[] = {INT_MIN, INT_MAX, -77, 11, 12, 19, 59, 64, 1000};
    for (size_t i = 0; i < COUNT(odd); i++) {
        ck_assert_str_eq(tribo_strerror(odd[i]), unknown);
    }
    assert_says(tribo_strerror(TRIBO_ERR_CHATTER), "central/fixed");
    for (int status = -300; status < 300; status++) {
        require(strlen(tribo_strerror(status)) > 3, "status %d", status);
    }
}

TEST(messages)
{
    tribo_context *c = create(1);
    ck_assert_uint_gt(strlen(tribo_message(NULL)), 0);
    assert_status(tribo_set_limit_all(c, -1.0), TRIBO_ERR_NEGATIVE);
    ck_assert_str_eq(tribo_message(c), "limit = -1 is negative");
    assert_ok(tribo_set_limit_all(c, 1.0));                  /* success leaves the last failure's text */
    assert_status(tribo_get_limit(c, NULL), TRIBO_ERR_NULL); /* and so does a call on a const context */
    ck_assert_str_eq(tribo_message(c), "limit = -1 is negative");
    tribo_destroy(c);
}

/* A copy of settings: forces, slips and epsilon are those of the context from which they came, whatever was set before; operator
 * and reversal memory stay. */
TEST(copied_settings)
{
    enum { N = 5 };
    struct random g = random_of(_i);
    double r[N * N] = {0.0}, x[N], feq[2][N], f[2][N], v[N], a[N], ratio[N], velocity[N];
    tribo_context *c[2] = {create(N), create(N)}, *other;
    for (size_t i = 0; i < N; i++) {
        r[i * N + i] = 2.0;
        r[i * N + (i + 1) % N] = r[(i + 1) % N * N + i] = 0.5;
    }
    for (int set = 0; set < 40; set++) {
        for (size_t i = 0; i < N; i++) {
            x[i] = uniform(&g, 0.1, 2.0);
            v[i] = uniform(&g, -1.0, 1.0) * (double)(i % 2);
            a[i] = uniform(&g, -4.0, 4.0);
            ratio[i] = 1.5;
            velocity[i] = 0.7;
        }
        for (int k = 0; k < (set ? 1 : 2); k++) {
            assert_ok(tribo_set_operator_dense(c[k], r));
        }
        const int what = (int)uniform(&g, 0.0, 9.0);
        assert_ok(what == 0   ? tribo_set_limit(c[0], x)
                  : what == 1 ? tribo_set_epsilon(c[0], x)
                  : what == 2 ? tribo_set_epsilon_step(c[0], 0.1, 1.0)
                  : what == 3 ? tribo_set_static(c[0], ratio, set % 2 ? velocity : NULL)
                  : what == 4 ? tribo_set_static(c[0], NULL, NULL)
                  : what == 5 ? tribo_set_planar(c[0], 1, (const size_t[]){(size_t)set % 4})
                  : what == 6 ? tribo_set_planar(c[0], 0, NULL)
                  : what == 7 ? tribo_set_law(c[0], set % 2 ? TRIBO_QUINN : TRIBO_COULOMB)
                              : tribo_set_sharing(c[0], set % 2));
        const size_t before = count_of(c[1], TRIBO_COUNT_SETTINGS);
        assert_ok(tribo_copy_settings(c[1], c[0]));
        ck_assert_uint_gt(count_of(c[1], TRIBO_COUNT_SETTINGS), before);
        for (int k = 0; k < 2; k++) {
            assert_ok(tribo_balance(c[k], v, a, feq[k], f[k]));
        }
        for (size_t i = 0; i < N; i++) {
            assert_close(f[1][i], f[0][i], 1e-12);
            assert_close(feq[1][i], feq[0][i], 1e-11);
        }
        assert_ok(tribo_get_epsilon(c[0], f[0]));
        assert_ok(tribo_get_epsilon(c[1], f[1]));
        assert_all_exact(f[1], f[0], N);
    }
    assert_ok(tribo_clone(c[1], &other));
    assert_ok(tribo_set_law(c[0], TRIBO_QUINN_REVERSAL));
    assert_ok(tribo_copy_settings(c[1], c[0]));
    assert_ok(tribo_set_limit_all(c[0], 0.25));
    for (size_t i = 0; i < N; i++) {
        v[i] = 1e3;
        x[i] = 1.0;
    }
    assert_ok(tribo_set_epsilon_all(c[0], 1e-3));
    assert_ok(tribo_copy_settings(c[1], c[0]));
    assert_ok(tribo_accept(c[1], v, v));
    const size_t marks = count_of(c[1], TRIBO_COUNT_REVERSALS);
    assert_ok(tribo_set_limit_all(c[0], 0.5));
    assert_ok(tribo_copy_settings(c[1], c[0]));
    assert_ok(tribo_accept(c[1], v, v)); /* still marked */
    ck_assert_uint_eq(count_of(c[1], TRIBO_COUNT_REVERSALS), marks);
    assert_ok(tribo_copy_settings(c[1], other));
    assert_ok(tribo_copy_settings(c[1], c[0]));
    assert_ok(tribo_accept(c[1], v, v));
    ck_assert_uint_gt(count_of(c[1], TRIBO_COUNT_REVERSALS), marks);
    tribo_destroy(other);
    tribo_destroy(c[0]);
    tribo_destroy(c[1]);
}

/* limit = mu max(load, 0), and nothing changes on an error. */
TEST(normal_loads)
{
    enum { N = 300 };
    double mu[N], load[N], got[N], f[N], v[N], a[N];
    struct random g = random_of(1);
    tribo_context *c = create(N);
    for (size_t i = 0; i < N; i++) {
        mu[i] = i % 7 ? uniform(&g, 0.0, 1.0) : 0.0;
        load[i] = i % 5 ? uniform(&g, -1.0, 2.0) : 0.0;
        v[i] = 1.0;
        a[i] = 0.0;
        got[i] = 1.0;
    }
    assert_ok(tribo_set_operator_diagonal(c, got));
    assert_ok(tribo_set_normal_load(c, mu, load));
    assert_ok(tribo_get_limit(c, got));
    assert_ok(tribo_balance(c, v, a, NULL, f));
    for (size_t i = 0; i < N; i++) {
        assert_exact(got[i], mu[i] * fmax(load[i], 0.0));
        assert_exact(f[i], -got[i]);
    }
    mu[260] = -0.5;
    assert_status(tribo_set_normal_load(c, mu, load), TRIBO_ERR_NEGATIVE);
    assert_says(tribo_message(c), "mu[260] = -0.5 is negative");
    mu[260] = 0.5;
    load[3] = NAN;
    assert_status(tribo_set_normal_load(c, mu, load), TRIBO_ERR_NOT_FINITE);
    assert_says(tribo_message(c), "load[3]");
    assert_status(tribo_set_normal_load(c, NULL, load), TRIBO_ERR_NULL);
    assert_status(tribo_set_normal_load(c, mu, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_set_normal_load(NULL, mu, load), TRIBO_ERR_NULL);
    assert_ok(tribo_get_limit(c, f));
    assert_all_exact(f, got, N);
    mu[3] = load[3] = 1e200;
    assert_ok(tribo_set_normal_load(c, mu, load));
    assert_ok(tribo_get_limit(c, f));
    assert_close(f[3], 1e300, 1e285);
    tribo_destroy(c);
}

/* Another number after every call that sets something, and the same after others, and after calls that fail. */
TEST(revisions)
{
    tribo_context *c = create(2);
    const double x[] = {1.0, 2.0}, bad[] = {1.0, -1.0}, r[] = {2.0, 1.0, 1.0, 3.0}, inverse[] = {1.0, 0.5};
    const size_t rows[] = {0, 1, 2}, cols[] = {0, 1};
    double f[2];
    size_t before = count_of(c, TRIBO_COUNT_SETTINGS);
#define CHANGES(call)                                                                                                            \
    do {                                                                                                                         \
        assert_ok(call);                                                                                                         \
        require(count_of(c, TRIBO_COUNT_SETTINGS) != before, "%s goes unnoticed", #call);                                        \
        before = count_of(c, TRIBO_COUNT_SETTINGS);                                                                              \
    } while (0)
    CHANGES(tribo_set_law(c, TRIBO_SMOOTH));
    CHANGES(tribo_set_limit(c, x));
    CHANGES(tribo_set_limit_all(c, 1.0));
    CHANGES(tribo_set_epsilon(c, x));
    CHANGES(tribo_set_epsilon_all(c, 0.1));
    CHANGES(tribo_set_epsilon_step(c, 0.1, 1.0));
    CHANGES(tribo_set_coupling(c, TRIBO_PARTITION));
    CHANGES(tribo_set_sharing(c, TRIBO_SHARE_PREVIOUS));
    CHANGES(tribo_set_operator_diagonal(c, x));
    CHANGES(tribo_set_operator_dense(c, r));
    CHANGES(tribo_set_operator_csr(c, rows, cols, x));
    CHANGES(tribo_set_operator_mass(c, 2, inverse, rows, cols, x));
    assert_ok(tribo_balance(c, x, x, NULL, f));
    assert_ok(tribo_step_force(c, 0.1, x, f));
    assert_ok(tribo_solve_box(c, x, x, x, f));
    assert_ok(tribo_accept(c, x, x));
    ck_assert_int_ne(tribo_set_limit(c, bad), TRIBO_OK);
    ck_assert_int_ne(tribo_set_law(c, 77), TRIBO_OK);
    ck_assert_int_ne(tribo_set_operator_diagonal(c, bad), TRIBO_OK);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_SETTINGS), before);
    tribo_destroy(c);
}

TEST_MAIN("context", {defaults, 1}, {no_operator, 1}, {fixed_operator, 1}, {settings, 1}, {epsilon_step, 1},
          {epsilon_step_without_division, 1}, {open_contacts, 24}, {opening_contacts, 1}, {no_contacts, 1}, {no_feq, 2},
          {clones, 1}, {versions, 1}, {texts_of_statuses, 1}, {messages, 1}, {copied_settings, 10}, {normal_loads, 1},
          {revisions, 1})
