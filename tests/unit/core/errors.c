/* SPDX-License-Identifier: BSD-3-Clause */
/* Every way in which a call can fail: its status, its message, that outputs stay untouched, and that the context goes on as
 * before. */
#include <string.h>

#include "problem.h"

#define N 3

/* What a context is and does, in bits; asked of a copy, so that it does not change. */
struct fingerprint {
    int law, coupling;
    double limit[N], epsilon[N], reversal[N], feq[N], f[N];
    size_t marks;
};

static struct fingerprint fingerprint(const tribo_context *ctx)
{
    const double v[N] = {0.1, 0.0, -0.2}, a[N] = {0.5, -4.0, 1.0}, rest[N] = {0}, beyond[N] = {9.0, 9.0, -9.0};
    struct fingerprint x;
    tribo_context *c;
    memset(&x, 0, sizeof x);
    assert_ok(tribo_clone(ctx, &c));
    assert_ok(tribo_get_law(c, &x.law));
    assert_ok(tribo_get_coupling(c, &x.coupling));
    assert_ok(tribo_get_limit(c, x.limit));
    assert_ok(tribo_get_epsilon(c, x.epsilon));
    assert_ok(tribo_force(c, rest, beyond, x.reversal));
    assert_ok(tribo_balance(c, v, a, x.feq, x.f));
    x.marks = count_of(c, TRIBO_COUNT_REVERSALS);
    tribo_destroy(c);
    return x;
}

/* Outputs of all kinds, stained before each call. */
static struct {
    double f[N], dv[N], dfeq[N], dlimit[N], square[2][N * N], value;
    tribo_context *context;
    signed char slip[N];
    size_t count;
    int number;
} out;

static tribo_context *c;
static struct fingerprint before;

static void begin(void)
{
    const double r[N * N] = {2.0, 1.0, 0.5, 1.0, 2.0, 0.25, 0.5, 0.25, 1.0}, limit[N] = {1.0, 2.0, 3.0};
    const double fast[N] = {99.0, 0.0, -99.0}, rest[N] = {0};
    assert_ok(tribo_create(&c, N));
    assert_ok(tribo_set_law(c, TRIBO_QUINN_REVERSAL));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_set_epsilon_step(c, 0.1, 1.0));
    assert_ok(tribo_accept(c, fast, rest));
    before = fingerprint(c);
}

static void end(void)
{
    tribo_destroy(c);
}

static void check_refusal(const char *call, int got, int want, const char *text)
{
    require(got == want, "%s: %d (%s), not %d", call, got, tribo_message(c), want);
    require(says(tribo_message(c), text), "%s: \"%s\" does not say \"%s\"", call, tribo_message(c), text);
    require(stained(&out, sizeof out), "%s wrote to its outputs", call);
    const struct fingerprint after = fingerprint(c);
    require(memcmp(&after, &before, sizeof after) == 0, "%s left the context changed", call);
}

/* Another failure comes first, so that the message cannot be that of the refusal before. */
#define REFUSED(status, text, ...)                                                                                               \
    do {                                                                                                                         \
        tribo_set_law(c, 999);                                                                                                   \
        stain(&out, sizeof out);                                                                                                 \
        check_refusal(#__VA_ARGS__, __VA_ARGS__, status, text);                                                                  \
    } while (0)

/* A call on a const context leaves the message of the failure before. */
#define REFUSED_CONST(status, ...) REFUSED(status, "law = 999 is none of the 6 laws", __VA_ARGS__)

/* Three values. */
#define THREE(x, y, z) ((const double[N]){x, y, z})

static const double good[N] = {1.0, 0.0, -1.0};

/* ---------------------------------------------------------------------------------------------------------- contexts */

TEST(no_context)
{
    const size_t rowptr[N + 1] = {0};
    tribo_context *const null = NULL;
    stain(&out, sizeof out);
    const int statuses[] = {
        tribo_create(NULL, N),
        tribo_clone(null, &out.context),
        tribo_copy_settings(null, null),
        tribo_get_ncontact(null, &out.count),
        tribo_set_law(null, TRIBO_QUINN),
        tribo_get_law(null, &out.number),
        tribo_set_limit(null, good),
        tribo_set_limit_all(null, 1.0),
        tribo_get_limit(null, out.f),
        tribo_set_epsilon(null, good),
        tribo_set_epsilon_all(null, 1.0),
        tribo_set_epsilon_step(null, 1.0, 1.0),
        tribo_get_epsilon(null, out.f),
        tribo_fix_operator(null),
        tribo_set_operator_diagonal(null, good),
        tribo_set_operator_dense(null, good),
        tribo_set_operator_csr(null, rowptr, rowptr, good),
        tribo_set_operator_mass(null, N, good, rowptr, rowptr, good),
        tribo_set_coupling(null, TRIBO_PARTITION),
        tribo_get_coupling(null, &out.number),
        tribo_force(null, good, good, out.f),
        tribo_force_tangent(null, good, good, out.f, out.dv, out.dfeq, out.dlimit),
        tribo_balance(null, good, good, out.dv, out.f),
        tribo_balance_tangent(null, good, good, out.dv, out.f, out.square[0], out.square[1]),
        tribo_step_force(null, 1.0, good, out.f),
        tribo_accept(null, good, good),
        tribo_get_slip(null, out.slip),
        tribo_get_count(null, TRIBO_COUNT_RANK, &out.count),
        tribo_get_real(null, TRIBO_REAL_RESIDUAL, &out.value),
    };
    for (size_t i = 0; i < COUNT(statuses); i++) {
        require(statuses[i] == TRIBO_ERR_NULL, "call %zu answers %d", i, statuses[i]);
    }
    ck_assert(stained(&out, sizeof out));
}

TEST(contexts)
{
    begin();
    stain(&out, sizeof out);
    assert_status(tribo_create(&out.context, SIZE_MAX), TRIBO_ERR_SIZE);
    assert_status(tribo_create(&out.context, SIZE_MAX / 64), TRIBO_ERR_SIZE);
    ck_assert(stained(&out, sizeof out));
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_clone(c, NULL));
    tribo_context *pair;
    assert_ok(tribo_create(&pair, 2));
    REFUSED(TRIBO_ERR_NULL, "from is NULL", tribo_copy_settings(c, NULL));
    REFUSED(TRIBO_ERR_SIZE, "from has 2 contacts, but ctx 3 contacts", tribo_copy_settings(c, pair));
    tribo_destroy(pair);
    end();
}

TEST(getters)
{
    begin();
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_get_ncontact(c, NULL));
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_get_law(c, NULL));
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_get_coupling(c, NULL));
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_get_limit(c, NULL));
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_get_epsilon(c, NULL));
    REFUSED_CONST(TRIBO_ERR_STATE, tribo_get_slip(c, out.slip));
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_get_slip(c, NULL));
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_get_count(c, TRIBO_COUNT_STUCK, NULL));
    REFUSED(TRIBO_ERR_RANGE, "sharing = 2", tribo_set_sharing(c, 2));
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_get_sharing(c, NULL));
    REFUSED(TRIBO_ERR_NULL, "df is NULL", tribo_tangent_product(c, NULL, NULL, NULL));
    REFUSED_CONST(TRIBO_ERR_RANGE, tribo_get_count(c, -1, &out.count));
    REFUSED_CONST(TRIBO_ERR_RANGE, tribo_get_count(c, TRIBO_COUNT_VALUES + 1, &out.count));
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_get_real(c, TRIBO_REAL_RESIDUAL, NULL));
    REFUSED_CONST(TRIBO_ERR_RANGE, tribo_get_real(c, -1, &out.value));
    REFUSED_CONST(TRIBO_ERR_RANGE, tribo_get_real(c, TRIBO_REAL_MAX_STEP + 1, &out.value));
    end();
}

TEST(settings)
{
    begin();
    REFUSED(TRIBO_ERR_RANGE, "law = -1", tribo_set_law(c, -1));
    REFUSED(TRIBO_ERR_RANGE, "law = 6", tribo_set_law(c, tribo_law_count()));
    REFUSED(TRIBO_ERR_RANGE, "coupling = 2", tribo_set_coupling(c, 2));
    REFUSED(TRIBO_ERR_RANGE, "coupling = -1", tribo_set_coupling(c, -1));
    REFUSED(TRIBO_ERR_NULL, "limit is NULL", tribo_set_limit(c, NULL));
    REFUSED(TRIBO_ERR_NOT_FINITE, "limit[1] = nan", tribo_set_limit(c, THREE(7.0, NAN, -1.0)));
    REFUSED(TRIBO_ERR_NOT_FINITE, "limit[2] = inf", tribo_set_limit(c, THREE(7.0, 7.0, HUGE_VAL)));
    REFUSED(TRIBO_ERR_NEGATIVE, "limit[2] = -0.5", tribo_set_limit(c, THREE(7.0, 0.0, -0.5)));
    REFUSED(TRIBO_ERR_NOT_FINITE, "limit = nan", tribo_set_limit_all(c, NAN));
    REFUSED(TRIBO_ERR_NOT_FINITE, "limit = -inf", tribo_set_limit_all(c, -HUGE_VAL));
    REFUSED(TRIBO_ERR_NEGATIVE, "limit = -1e-300", tribo_set_limit_all(c, -1e-300));
    REFUSED(TRIBO_ERR_NULL, "epsilon is NULL", tribo_set_epsilon(c, NULL));
    REFUSED(TRIBO_ERR_NOT_FINITE, "epsilon[0] = nan", tribo_set_epsilon(c, THREE(NAN, 1.0, 1.0)));
    REFUSED(TRIBO_ERR_NOT_FINITE, "epsilon[1] = inf", tribo_set_epsilon(c, THREE(1.0, HUGE_VAL, 1.0)));
    REFUSED(TRIBO_ERR_NOT_POSITIVE, "epsilon[1] = 0", tribo_set_epsilon(c, THREE(1.0, 0.0, 1.0)));
    REFUSED(TRIBO_ERR_NOT_POSITIVE, "epsilon[2] = -2", tribo_set_epsilon(c, THREE(1.0, 1.0, -2.0)));
    REFUSED(TRIBO_ERR_NOT_FINITE, "epsilon = nan", tribo_set_epsilon_all(c, NAN));
    REFUSED(TRIBO_ERR_NOT_POSITIVE, "epsilon = 0", tribo_set_epsilon_all(c, 0.0));
    REFUSED(TRIBO_ERR_NOT_POSITIVE, "epsilon = -1", tribo_set_epsilon_all(c, -1.0));
    REFUSED(TRIBO_ERR_NOT_FINITE, "dt = inf", tribo_set_epsilon_step(c, HUGE_VAL, 1.0));
    REFUSED(TRIBO_ERR_NOT_POSITIVE, "dt = 0", tribo_set_epsilon_step(c, 0.0, 1.0));
    REFUSED(TRIBO_ERR_NOT_FINITE, "lambda_dt = nan", tribo_set_epsilon_step(c, 1.0, NAN));
    REFUSED(TRIBO_ERR_NOT_POSITIVE, "lambda_dt = -3", tribo_set_epsilon_step(c, 1.0, -3.0));
    end();
}

/* --------------------------------------------------------------------------------------------------------- operators */

TEST(diagonal_and_dense)
{
    begin();
    REFUSED(TRIBO_ERR_NULL, "r is NULL", tribo_set_operator_diagonal(c, NULL));
    REFUSED(TRIBO_ERR_NOT_FINITE, "r[1] = nan", tribo_set_operator_diagonal(c, THREE(1.0, NAN, 1.0)));
    REFUSED(TRIBO_ERR_NEGATIVE, "r[2] = -4", tribo_set_operator_diagonal(c, THREE(1.0, 1.0, -4.0)));
    REFUSED(TRIBO_ERR_NULL, "r is NULL", tribo_set_operator_dense(c, NULL));
    const struct {
        double r[N * N];
        int status;
        const char *text[2];
    } cases[] = {
        {{1, 0, 0, 0, 1, 0, NAN, 0, 1}, TRIBO_ERR_NOT_FINITE, {"r[2][0]", "nan"}},
        {{1, 0, 0, 0, 1, HUGE_VAL, 0, 0, 1}, TRIBO_ERR_NOT_FINITE, {"r[1][2]", "inf"}},
        {{1, 0, 0.5, 0, 1, 0, 0.25, 0, 1}, TRIBO_ERR_NOT_SYMMETRIC, {"contacts 0, 2", "0.5 one way and 0.25"}},
        {{1, 0, 0, 0, 1, 0, 0, 0.125, 1}, TRIBO_ERR_NOT_SYMMETRIC, {"contacts 2, 1", "0.125 one way and 0"}},
        {{1, 0.5, 0, 0.50000001, 1, 0, 0, 0, 1}, TRIBO_ERR_NOT_SYMMETRIC, {"contacts 0, 1", "0.5 one way and 0.50000001 the"}},
        {{1, 1e-9, 0, 0, 1, 0, 0, 0, 1}, TRIBO_ERR_NOT_SYMMETRIC, {"contacts 0, 1", "1e-09"}},
        {{1, 0, 0, 0, -3, 0, 0, 0, 1}, TRIBO_ERR_INDEFINITE, {"contact 1", "-3"}},
        {{1, 0, 0, 0, 1, 1.5, 0, 1.5, 2}, TRIBO_ERR_INDEFINITE, {"contacts 1, 2", "1.5"}},
        {{0, 0, 0.5, 0, 1, 0, 0.5, 0, 1}, TRIBO_ERR_INDEFINITE, {"contacts 0, 2", "0.5"}},
        /* every pair of contacts would pass */
        {{1, -0.75, -0.75, -0.75, 1, -0.75, -0.75, -0.75, 1}, TRIBO_ERR_INDEFINITE, {"pivot -", "group of 3"}},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        REFUSED(cases[i].status, cases[i].text[0], tribo_set_operator_dense(c, cases[i].r));
        REFUSED(cases[i].status, cases[i].text[1], tribo_set_operator_dense(c, cases[i].r));
    }
    end();
}

/* Compressed rows are checked alike for R and for J. */
struct rows {
    size_t first[N + 1], col[4];
    double val[4];
};

static const struct {
    struct rows a;
    int status;
    const char *text[2];
} bad_rows[] = {
    {{{1, 2, 3, 4}, {0, 0, 1, 2}, {1, 1, 1, 1}}, TRIBO_ERR_SIZE, {"rowptr[0]", "1"}},
    {{{0, 3, 2, 3}, {0, 1, 2, 0}, {1, 1, 1, 1}}, TRIBO_ERR_SIZE, {"rowptr[2] = 2", "rowptr[1] = 3"}},
    {{{0, 1, 2, 3}, {0, N, 2, 0}, {1, 1, 1, 1}}, TRIBO_ERR_RANGE, {"col[1] = 3", "contact 1"}},
    {{{0, 1, 2, 3}, {0, 1, SIZE_MAX, 0}, {1, 1, 1, 1}}, TRIBO_ERR_RANGE, {"col[2]", "contact 2"}},
    {{{0, 1, 2, 3}, {0, 1, 2, 0}, {1, 1, NAN, 1}}, TRIBO_ERR_NOT_FINITE, {"val[2] = nan", "contact 2"}},
    {{{0, 1, 2, 3}, {0, 1, 2, 0}, {1, -HUGE_VAL, 1, 1}}, TRIBO_ERR_NOT_FINITE, {"val[1] = -inf", "contact 1"}},
    {{{0, 1, 3, 4}, {0, 1, 1, 2}, {1, 1, 1, 1}}, TRIBO_ERR_DUPLICATE, {"contact 1", "column 1 twice"}},
    {{{0, 3, 3, 4}, {2, 1, 2, 2}, {1, 1, 1, 1}}, TRIBO_ERR_DUPLICATE, {"contact 0", "column 2 twice"}},
};

TEST(compressed_rows)
{
    begin();
    for (size_t i = 0; i < COUNT(bad_rows); i++) {
        const struct rows *a = &bad_rows[i].a;
        for (size_t k = 0; k < 2; k++) {
            REFUSED(bad_rows[i].status, bad_rows[i].text[k], tribo_set_operator_csr(c, a->first, a->col, a->val));
            REFUSED(bad_rows[i].status, bad_rows[i].text[k],
                    tribo_set_operator_mass(c, N, THREE(1.0, 1.0, 1.0), a->first, a->col, a->val));
        }
    }
    const struct rows skew = {{0, 2, 3, 4}, {0, 1, 1, 2}, {1, 0.5, 1, 1}}, fine = {{0, 1, 2, 3}, {0, 1, 2}, {1, 1, 1}};
    REFUSED(TRIBO_ERR_NOT_SYMMETRIC, "contacts 0, 1", tribo_set_operator_csr(c, skew.first, skew.col, skew.val));
    REFUSED(TRIBO_ERR_NULL, "rowptr is NULL", tribo_set_operator_csr(c, NULL, fine.col, fine.val));
    REFUSED(TRIBO_ERR_NULL, "col is NULL", tribo_set_operator_csr(c, fine.first, NULL, fine.val));
    REFUSED(TRIBO_ERR_NULL, "val is NULL", tribo_set_operator_csr(c, fine.first, fine.col, NULL));
    end();
}

TEST(mass)
{
    begin();
    const struct rows j = {{0, 1, 2, 3}, {0, 1, 2}, {1, 1, 1}}, huge = {{0, 1, 2, 3}, {0, 1, 2}, {1, 1e200, 1}};
    const double unit[N] = {1.0, 1.0, 1.0};
    REFUSED(TRIBO_ERR_NULL, "inverse_mass is NULL", tribo_set_operator_mass(c, N, NULL, j.first, j.col, j.val));
    REFUSED(TRIBO_ERR_NOT_FINITE, "inverse_mass[2] = nan",
            tribo_set_operator_mass(c, N, THREE(1.0, 1.0, NAN), j.first, j.col, j.val));
    REFUSED(TRIBO_ERR_NEGATIVE, "inverse_mass[1] = -2",
            tribo_set_operator_mass(c, N, THREE(1.0, -2.0, 1.0), j.first, j.col, j.val));
    REFUSED(TRIBO_ERR_SIZE, "ndof", tribo_set_operator_mass(c, SIZE_MAX, unit, j.first, j.col, j.val));
    REFUSED(TRIBO_ERR_RANGE, "col[2] = 2 of contact 2 is not below 2",
            tribo_set_operator_mass(c, 2, unit, j.first, j.col, j.val));
    REFUSED(TRIBO_ERR_NULL, "rowptr is NULL", tribo_set_operator_mass(c, N, unit, NULL, j.col, j.val));
    REFUSED(TRIBO_ERR_NULL, "col is NULL", tribo_set_operator_mass(c, N, unit, j.first, NULL, j.val));
    REFUSED(TRIBO_ERR_NULL, "val is NULL", tribo_set_operator_mass(c, N, unit, j.first, j.col, NULL));
    REFUSED(TRIBO_ERR_NOT_FINITE, "contacts 1, 1 is inf", tribo_set_operator_mass(c, N, unit, huge.first, huge.col, huge.val));
    end();
}

/* ------------------------------------------------------------------------------------------------------------ forces */

TEST(forces)
{
    begin();
    const double *bad_v = THREE(0.0, NAN, 0.0), *bad_feq = THREE(0.0, 0.0, HUGE_VAL);
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_force(c, NULL, good, out.f));
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_force(c, good, NULL, out.f));
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_force(c, good, good, NULL));
    REFUSED_CONST(TRIBO_ERR_NOT_FINITE, tribo_force(c, bad_v, good, out.f));
    REFUSED_CONST(TRIBO_ERR_NOT_FINITE, tribo_force(c, THREE(0.0, 0.0, 0.0), bad_feq, out.f));
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_force_tangent(c, NULL, good, out.f, out.dv, out.dfeq, out.dlimit));
    REFUSED_CONST(TRIBO_ERR_NULL, tribo_force_tangent(c, good, NULL, out.f, out.dv, out.dfeq, out.dlimit));
    REFUSED_CONST(TRIBO_ERR_NOT_FINITE, tribo_force_tangent(c, bad_v, good, out.f, out.dv, out.dfeq, out.dlimit));
    REFUSED_CONST(TRIBO_ERR_NOT_FINITE,
                  tribo_force_tangent(c, THREE(0.0, 0.0, 0.0), bad_feq, out.f, out.dv, out.dfeq, out.dlimit));
    /* a contact that slides has no use for f_eq */
    const double sliding[N] = {9.0, 9.0, -9.0};
    assert_ok(tribo_force(c, sliding, THREE(NAN, HUGE_VAL, NAN), out.f));
    assert_all_exact(out.f, THREE(-1.0, -2.0, 3.0), N);
    assert_ok(tribo_force_tangent(c, sliding, THREE(NAN, HUGE_VAL, NAN), out.f, NULL, NULL, NULL));
    assert_all_exact(out.f, THREE(-1.0, -2.0, 3.0), N);
    end();
}

TEST(balances)
{
    begin();
    const double *bad[] = {THREE(NAN, 0.0, 0.0), THREE(0.0, -HUGE_VAL, 0.0)};
    REFUSED(TRIBO_ERR_NULL, "v is NULL", tribo_balance(c, NULL, good, out.dv, out.f));
    REFUSED(TRIBO_ERR_NULL, "a is NULL", tribo_balance(c, good, NULL, out.dv, out.f));
    REFUSED(TRIBO_ERR_NOT_FINITE, "v[0] = nan", tribo_balance(c, bad[0], good, out.dv, out.f));
    REFUSED(TRIBO_ERR_NOT_FINITE, "a[1] = -inf", tribo_balance(c, good, bad[1], out.dv, out.f));
    REFUSED(TRIBO_ERR_NULL, "v is NULL", tribo_balance_tangent(c, NULL, good, out.dv, out.f, out.square[0], out.square[1]));
    REFUSED(TRIBO_ERR_NULL, "a is NULL", tribo_balance_tangent(c, good, NULL, out.dv, out.f, out.square[0], out.square[1]));
    REFUSED(TRIBO_ERR_NOT_FINITE, "v[1] = -inf",
            tribo_balance_tangent(c, bad[1], good, out.dv, out.f, out.square[0], out.square[1]));
    REFUSED(TRIBO_ERR_NOT_FINITE, "a[0] = nan",
            tribo_balance_tangent(c, good, bad[0], out.dv, out.f, out.square[0], out.square[1]));
    end();
}

TEST(step_forces_and_acceptance)
{
    begin();
    const double *bad = THREE(0.0, 0.0, NAN);
    REFUSED(TRIBO_ERR_NULL, "vfree is NULL", tribo_step_force(c, 0.1, NULL, out.f));
    REFUSED(TRIBO_ERR_NULL, "f is NULL", tribo_step_force(c, 0.1, good, NULL));
    REFUSED(TRIBO_ERR_NOT_FINITE, "vfree[2] = nan", tribo_step_force(c, 0.1, bad, out.f));
    REFUSED(TRIBO_ERR_NOT_FINITE, "dt = nan", tribo_step_force(c, NAN, good, out.f));
    REFUSED(TRIBO_ERR_NOT_POSITIVE, "dt = 0", tribo_step_force(c, 0.0, good, out.f));
    REFUSED(TRIBO_ERR_NOT_POSITIVE, "dt = -0.1", tribo_step_force(c, -0.1, good, out.f));
    REFUSED(TRIBO_ERR_NULL, "v is NULL", tribo_accept(c, NULL, good));
    REFUSED(TRIBO_ERR_NULL, "feq is NULL", tribo_accept(c, good, NULL));
    REFUSED(TRIBO_ERR_NOT_FINITE, "v[2] = nan", tribo_accept(c, bad, good));
    REFUSED(TRIBO_ERR_NOT_FINITE, "feq[2] = nan", tribo_accept(c, THREE(0.0, 9.0, 0.0), bad));
    end();
}

/* A law without memory checks v all the same. */
TEST(acceptance_without_memory)
{
    begin();
    assert_ok(tribo_set_law(c, TRIBO_KARNOPP));
    before = fingerprint(c);
    REFUSED(TRIBO_ERR_NULL, "v is NULL", tribo_accept(c, NULL, good));
    REFUSED(TRIBO_ERR_NOT_FINITE, "v[0] = inf", tribo_accept(c, THREE(HUGE_VAL, 0.0, 0.0), good));
    end();
}

TEST(single_contacts)
{
    const struct {
        int law;
        double v, feq, limit, epsilon;
        int status;
    } cases[] = {
        {-1, 0, 0, 1, 1, TRIBO_ERR_RANGE},
        {6, 0, 0, 1, 1, TRIBO_ERR_RANGE},
        {TRIBO_QUINN, NAN, 0, 1, 1, TRIBO_ERR_NOT_FINITE},
        {TRIBO_QUINN, 0, NAN, 1, 1, TRIBO_ERR_NOT_FINITE},
        {TRIBO_QUINN, 0, 0, HUGE_VAL, 1, TRIBO_ERR_NOT_FINITE},
        {TRIBO_QUINN, 0, 0, 1, NAN, TRIBO_ERR_NOT_FINITE},
        {TRIBO_QUINN, 0, 0, -1, 1, TRIBO_ERR_NEGATIVE},
        {TRIBO_QUINN, 0, 0, 1, 0, TRIBO_ERR_NOT_POSITIVE},
        {TRIBO_QUINN, 0, 0, 1, -1, TRIBO_ERR_NOT_POSITIVE},
        {TRIBO_COULOMB, 0, HUGE_VAL, 1, 1, TRIBO_ERR_NOT_FINITE},
    };
    stain(&out, sizeof out);
    for (size_t i = 0; i < COUNT(cases); i++) {
        assert_status(tribo_law_eval(cases[i].law, cases[i].v, cases[i].feq, cases[i].limit, cases[i].epsilon, out.f, out.dv,
                                     out.dfeq, out.dlimit),
                      cases[i].status);
    }
    assert_status(tribo_law_eval(TRIBO_QUINN, 0, 0, 1, 1, NULL, out.dv, out.dfeq, out.dlimit), TRIBO_ERR_NULL);
    ck_assert(stained(&out, sizeof out));
    assert_ok(tribo_law_eval(TRIBO_QUINN, 2.0, NAN, 1, 1, out.f, NULL, NULL, NULL));
    assert_ok(tribo_law_eval(TRIBO_SMOOTH, 0.0, NAN, 1, 1, out.f, NULL, NULL, NULL));
}

TEST_MAIN("errors", {no_context, 1}, {contexts, 1}, {getters, 1}, {settings, 1}, {diagonal_and_dense, 1}, {compressed_rows, 1},
          {mass, 1}, {forces, 1}, {balances, 1}, {step_forces_and_acceptance, 1}, {acceptance_without_memory, 1},
          {single_contacts, 1})
