/* SPDX-License-Identifier: BSD-3-Clause */
/* Laws of the caller: Quinn's law written by its box beside the built-in one, boxes of any kind beside their equations, and laws
 * that fail. */
#include <fenv.h>
#include <stdlib.h>
#include <string.h>

#include "problem.h"
#include "../../user_quinn.h"

enum { MOST = 300 };

/* ----------------------------------------------------------------------------------------------- Quinn's law, twice */

/* p with both laws; epsilon follows the limits, or not. */
static void create_pair(const struct problem *p, int coupling, int follows, struct quinn *q, tribo_context **pair)
{
    q->follows = follows;
    for (int k = 0; k < 2; k++) {
        pair[k] = problem_context(p, TRIBO_QUINN, coupling);
        if (follows) {
            assert_ok(tribo_set_epsilon_step(pair[k], 0.01, 0.4));
        }
    }
    assert_ok(tribo_set_user_law(pair[1], quinn_box, q));
}

static double tolerance_of(const struct problem *p)
{
    double most = 0.0;
    for (size_t i = 0; i < p->n; i++) {
        most = fmax(most, p->limit[i]);
    }
    return 1e-15 * most;
}

TEST(equal_balances)
{
    struct random g = random_of(_i);
    const int coupling = _i % 2, follows = _i / 2 % 2;
    for (int k = 0; k < 20; k++) {
        const struct recipe recipe = recipe_regular(&g, 12);
        const struct problem p = problem_create(&g, &recipe);
        const double most = tolerance_of(&p);
        struct tangent {
            double feq[LARGEST], f[LARGEST], dv[LARGEST * LARGEST], da[LARGEST * LARGEST], by_limit[LARGEST], rate;
        } t[2];
        struct quinn q;
        tribo_context *c[2];
        create_pair(&p, coupling, follows, &q, c);
        for (int j = 0; j < 2; j++) {
            assert_ok(tribo_balance_tangent(c[j], p.v, p.a, t[j].feq, t[j].f, t[j].dv, t[j].da));
            assert_ok(tribo_limit_product(c[j], p.limit, t[j].by_limit));
            t[j].rate = real_of(c[j], TRIBO_REAL_MAX_RATE);
        }
        assert_all_close(t[1].f, t[0].f, p.n, most);
        for (size_t i = 0; i < p.n; i++) {
            assert_close(t[1].feq[i], t[0].feq[i], 4e-15 * fmax(most, fabs(t[0].feq[i])));
            assert_close(t[1].by_limit[i], t[0].by_limit[i], 1e-13 * fmax(1.0, fabs(t[0].by_limit[i])));
        }
        for (size_t i = 0; i < p.n * p.n; i++) {
            assert_close(t[1].dv[i], t[0].dv[i], 1e-13 * fmax(1.0, fabs(t[0].dv[i])));
            assert_close(t[1].da[i], t[0].da[i], 1e-13 * fmax(1.0, fabs(t[0].da[i])));
        }
        assert_close(t[1].rate, t[0].rate, 1e-14 * t[0].rate);
        tribo_destroy(c[0]);
        tribo_destroy(c[1]);
    }
}

/* Contacts that share no body, few and many, alike and not. */
TEST(equal_forces)
{
    const size_t size[] = {1, 2, 127, 128, 129, MOST};
    struct random g = random_of(_i);
    double limit[MOST], epsilon[MOST], r[MOST], v[MOST], feq[MOST], a[MOST], out[2][6][MOST];
    const size_t n = size[_i % 6];
    const int alike = _i / 6 % 2, follows = _i / 12;
    struct quinn q = {.follows = follows};
    for (size_t i = 0; i < n; i++) {
        limit[i] = alike ? 0.7 : uniform(&g, 0.0, 2.0) * (below(&g, 9) > 0);
        epsilon[i] = alike ? 0.3 : uniform(&g, 0.1, 1.0);
        r[i] = alike ? 2.0 : uniform(&g, 0.5, 2.0);
        v[i] = uniform(&g, -1.0, 1.0) * (below(&g, 9) > 0);
        feq[i] = uniform(&g, -2.0, 2.0);
        a[i] = uniform(&g, -4.0, 4.0);
    }
    for (int k = 0; k < 2; k++) {
        tribo_context *c;
        double f[MOST];
        assert_ok(tribo_create(&c, n));
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_set_operator_diagonal(c, r));
        assert_ok(follows ? tribo_set_epsilon_step(c, 0.1, 0.5) : tribo_set_epsilon(c, epsilon));
        if (k) {
            assert_ok(tribo_set_user_law(c, quinn_box, &q));
        }
        assert_ok(tribo_force_tangent(c, v, feq, out[k][0], out[k][1], out[k][2], out[k][3]));
        assert_ok(tribo_force(c, v, feq, f));
        assert_all_exact(f, out[k][0], n);
        assert_ok(tribo_balance(c, v, a, out[k][4], out[k][5]));
        tribo_destroy(c);
    }
    for (int k = 0; k < 6; k++) {
        for (size_t i = 0; i < n; i++) {
            const int jumps = k == 3 && limit[i] == 0.0; /* an open contact has one derivative for each way to close */
            assert_close(jumps ? 0.0 : out[1][k][i], jumps ? 0.0 : out[0][k][i],
                         (k == 0 ? 1e-15 : 1e-14) * fmax(1.0, fabs(out[0][k][i])));
        }
    }
}

/* ----------------------------------------------------------------------------------------------- boxes of any kind */

/* A box that moves with v, in the band and outside. */
static int waves(size_t first, size_t n, int derivatives, const double *v, const double *limit, const double *epsilon,
                 double *box, void *data)
{
    const double *phase = data;
    for (size_t i = 0; i < n; i++) {
        const double x = phase[first + i] + v[i], away = fabs(v[i]) > epsilon[i] ? 1.0 : 0.0;
        const double lower = -0.5 - 0.4 * sin(x), upper = away > 0.0 ? lower : 0.5 + 0.4 * cos(x);
        box[i] = limit[i] * lower;
        box[n + i] = limit[i] * upper;
        box[2 * n + i] = limit[i] * sin(3.0 * x);
        if (derivatives) {
            box[3 * n + i] = limit[i] * -0.4 * cos(x);
            box[4 * n + i] = limit[i] * (away > 0.0 ? -0.4 * cos(x) : -0.4 * sin(x));
            box[5 * n + i] = limit[i] * 3.0 * cos(3.0 * x);
            box[6 * n + i] = lower;
            box[7 * n + i] = upper;
            box[8 * n + i] = sin(3.0 * x);
        }
    }
    return 0;
}

TEST(boxes)
{
    struct random g = random_of(_i);
    size_t smooth = 0, all = 0;
    for (int k = 0; k < 20; k++) {
        const struct recipe recipe = recipe_regular(&g, 12);
        struct problem p = problem_create(&g, &recipe);
        double phase[LARGEST], f[LARGEST], box[3 * LARGEST], dv[LARGEST * LARGEST], da[LARGEST * LARGEST], df[LARGEST],
            f_2[LARGEST], f_1[LARGEST], by_v[LARGEST], by_a[LARGEST];
        signed char slip[LARGEST];
        tribo_context *c = problem_context(&p, TRIBO_COULOMB, TRIBO_CONSISTENT);
        for (size_t i = 0; i < p.n; i++) {
            phase[i] = uniform(&g, -3.0, 3.0);
            by_v[i] = uniform(&g, -1.0, 1.0);
            by_a[i] = uniform(&g, -1.0, 1.0);
        }
        assert_ok(tribo_set_user_law(c, waves, phase));
        assert_ok(tribo_balance(c, p.v, p.a, NULL, f));
        assert_ok(tribo_get_slip(c, slip));
        waves(0, p.n, 0, p.v, p.limit, p.epsilon, box, phase);
        for (size_t i = 0; i < p.n; i++) {
            const double want = fmin(fmax(balancing(&p, i, f) - box[2 * p.n + i], box[i]), box[p.n + i]);
            assert_close(f[i], want, 1e-12 * fmax(1.0, p.limit[i]));
            require((slip[i] == TRIBO_SLIP_STUCK) == (p.limit[i] > 0.0 && f[i] > box[i] && f[i] < box[p.n + i]),
                    "contact %zu: slip %d", i, slip[i]);
        }
        /* derivatives, by differences */
        const double h = 1e-6;
        assert_ok(tribo_balance_tangent(c, p.v, p.a, NULL, f, dv, da));
        assert_ok(tribo_tangent_product(c, by_v, by_a, df));
        problem_forces(c, &p, -h, by_v, by_a, f_1);
        problem_forces(c, &p, h, by_v, by_a, f_2);
        for (size_t i = 0; i < p.n; i++) {
            double want = 0.0;
            for (size_t j = 0; j < p.n; j++) {
                want += dv[i * p.n + j] * by_v[j] + da[i * p.n + j] * by_a[j];
            }
            assert_close(df[i], want, 1e-10 * fmax(1.0, fabs(want)));
            const double kink = fabs(f_2[i] - 2.0 * f[i] + f_1[i]) / h;
            if (kink < 1e-4 * fmax(1.0, fabs(want))) {
                assert_close(want, 0.5 * (f_2[i] - f_1[i]) / h, 1e-6 * fmax(1.0, fabs(want)));
                smooth++;
            }
            all++;
        }
        /* by limits */
        assert_ok(tribo_balance_tangent(c, p.v, p.a, NULL, f, NULL, NULL));
        assert_ok(tribo_limit_product(c, p.limit, df));
        problem_forces_of_limits(c, &p, -h, p.limit, f_1);
        problem_forces_of_limits(c, &p, h, p.limit, f_2);
        for (size_t i = 0; i < p.n; i++) {
            if (fabs(f_2[i] - 2.0 * f[i] + f_1[i]) / h < 1e-4 * fmax(1.0, fabs(df[i]))) {
                assert_close(df[i], 0.5 * (f_2[i] - f_1[i]) / h, 1e-6 * fmax(1.0, fabs(df[i])));
            }
        }
        tribo_destroy(c);
    }
    ck_assert_uint_gt(smooth, all * 95 / 100);
}

/* A contact alone, and beside another one: the same bits. */
TEST(one_contact)
{
    struct random g = random_of(_i);
    int stuck = 0, slides = 0;
    for (int k = 0; k < 200; k++) {
        const int open = below(&g, 9) == 0, follows = below(&g, 2) > 0;
        const double x = open ? 0.0 : uniform(&g, 0.1, 2.0), limit[] = {x, 1.0}, r[] = {uniform(&g, 0.5, 2.0), 1.0};
        const double v[] = {uniform(&g, -1.0, 1.0) * (below(&g, 3) > 0), 0.1}, a[] = {uniform(&g, -4.0, 4.0), 1.0};
        double phase[] = {uniform(&g, -3.0, 3.0), 0.0}, out[2][4][2];
        signed char slip[2][2];
        for (size_t n = 1; n <= 2; n++) {
            tribo_context *c;
            assert_ok(tribo_create(&c, n));
            assert_ok(tribo_set_limit(c, limit));
            assert_ok(tribo_set_operator_diagonal(c, r));
            assert_ok(follows ? tribo_set_epsilon_step(c, 0.1, 0.5) : tribo_set_epsilon_all(c, 0.3));
            assert_ok(tribo_set_user_law(c, waves, phase));
            assert_ok(tribo_balance(c, v, a, out[n - 1][0], out[n - 1][1]));
            assert_ok(tribo_get_slip(c, slip[n - 1]));
            assert_ok(tribo_force(c, v, a, out[n - 1][2]));
            assert_ok(tribo_force_tangent(c, v, a, NULL, out[n - 1][3], NULL, NULL));
            tribo_destroy(c);
        }
        for (int j = 0; j < 4; j++) {
            assert_all_exact(out[0][j], out[1][j], 1);
        }
        ck_assert_int_eq(slip[0][0], slip[1][0]);
        ck_assert_int_eq(slip[0][0] == TRIBO_SLIP_OPEN, open);
        stuck += slip[0][0] == TRIBO_SLIP_STUCK;
        slides += slip[0][0] == TRIBO_SLIP_FORTH || slip[0][0] == TRIBO_SLIP_BACK;
    }
    ck_assert_int_gt(stuck, 10);
    ck_assert_int_gt(slides, 10);
}

/* ------------------------------------------------------------------------------------------------- laws that fail */

/* Coulomb's law, of which one number is another. */
struct wrong {
    size_t contact;
    int row, answer;
    double value;
};

static int wrong_law(size_t first, size_t n, int derivatives, const double *v, const double *limit, const double *epsilon,
                     double *box, void *data)
{
    const struct wrong *w = data;
    (void)epsilon;
    for (size_t i = 0; i < n; i++) {
        const double slide = v[i] > 0.0 ? -limit[i] : limit[i];
        box[i] = v[i] != 0.0 ? slide : -limit[i];
        box[n + i] = v[i] != 0.0 ? slide : limit[i];
        box[2 * n + i] = 0.0;
        for (size_t row = 3; derivatives && row < 6; row++) {
            box[row * n + i] = 0.0;
        }
        if (first + i == w->contact && w->row >= 0 && (w->row < 3 || derivatives)) {
            box[(size_t)w->row * n + i] = w->value;
        }
    }
    return first <= w->contact && w->contact < first + n ? w->answer : 0;
}

/* w fails for a contact alone. */
static void one_fails(struct wrong *w, double v, int by_tangent)
{
    const double limit = 1.0, a = 0.2;
    double f, feq, df;
    signed char slip;
    tribo_context *c;
    assert_ok(tribo_create(&c, 1));
    assert_ok(tribo_set_limit_all(c, limit));
    assert_ok(tribo_set_epsilon_all(c, 0.1));
    assert_ok(tribo_set_operator_diagonal(c, &limit));
    assert_ok(tribo_set_user_law(c, wrong_law, w));
    w->contact = 1;
    assert_ok(tribo_balance(c, &v, &a, &feq, &f));
    w->contact = 0;
    stain(&f, sizeof f);
    stain(&feq, sizeof feq);
    if (!by_tangent) {
        assert_status(tribo_balance(c, &v, &a, &feq, &f), TRIBO_ERR_CALLBACK);
        assert_says(tribo_message(c), w->answer ? "law answered 7 for 1 contact" : "of contact 0 is");
        require(stained(&f, sizeof f) && stained(&feq, sizeof feq), "outputs changed");
        assert_status(tribo_get_slip(c, &slip), TRIBO_ERR_STATE);
        assert_status(tribo_force(c, &v, &a, &f), TRIBO_ERR_CALLBACK);
    }
    assert_status(tribo_force_tangent(c, &v, &a, &f, &df, NULL, NULL), TRIBO_ERR_CALLBACK);
    tribo_destroy(c);
}

TEST(failures)
{
    enum { N = 200, AT = 150 };
    static const struct {
        struct wrong w;
        int tangent;
        const char *text;
    } scene[] = {
        {{AT, 0, 0, NAN}, 0, "law: lower of contact 150 is nan, not finite"},
        {{AT, 2, 0, INFINITY}, 0, "law: shift of contact 150 is inf, not finite"},
        {{AT, 2, 0, 1e308}, 0, "law: shift of contact 150 is 1e+308, too large"},
        {{AT, 1, 0, 1.5}, 0, "law: upper of contact 150 is 1.5, beyond the limit (v = 0, limit = 1)"},
        {{AT, 0, 0, -1.25}, 0, "law: lower of contact 150 is -1.25, beyond the limit"},
        {{AT, 1, 0, -1.5}, 0, "law: upper of contact 150 is -1.5, less than lower"},
        {{AT + 1, 1, 0, 0.0}, 0, "law: upper of contact 151 is 0, above lower, outside epsilon (v = 0.5"},
        {{AT, 4, 0, NAN}, 1, "law: d(upper)/dv of contact 150 is nan, not finite"},
        {{AT, -1, 7, 0.0}, 0, "law answered 7 for 72 contacts, of which the first is contact 128"},
    };
    double limit[N], v[N], a[N], f[N], feq[N], df[N];
    tribo_context *c, *copy;
    for (size_t i = 0; i < N; i++) {
        limit[i] = 1.0;
        v[i] = i == AT + 1 ? 0.5 : 0.0;
        a[i] = 0.2;
    }
    for (int form = 0; form < 2; form++) {
        c = form ? problem_chain(N / 4, 4, TRIBO_CONSISTENT) : NULL;
        if (!form) {
            assert_ok(tribo_create(&c, N));
            assert_ok(tribo_set_operator_diagonal(c, limit));
        }
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_set_epsilon_all(c, 0.1));
        for (size_t k = 0; k < COUNT(scene); k++) {
            struct wrong w = scene[k].w;
            assert_ok(tribo_set_user_law(c, wrong_law, &w));
            assert_ok(tribo_clone(c, &copy));
            stain(f, sizeof f);
            stain(feq, sizeof feq);
            feclearexcept(FE_ALL_EXCEPT);
            if (!scene[k].tangent) {
                assert_status(tribo_balance(copy, v, a, feq, f), TRIBO_ERR_CALLBACK);
                assert_says(tribo_message(copy), scene[k].text);
                require(stained(f, sizeof f) && stained(feq, sizeof feq), "outputs changed");
                assert_status(tribo_force(copy, v, a, f), TRIBO_ERR_CALLBACK);
            }
            assert_status(tribo_balance_tangent(copy, v, a, NULL, NULL, NULL, NULL), TRIBO_ERR_CALLBACK);
            assert_says(tribo_message(copy), scene[k].text);
            assert_status(tribo_tangent_product(copy, v, a, f), TRIBO_ERR_STATE);
            assert_status(tribo_force_tangent(copy, v, a, f, df, NULL, NULL), TRIBO_ERR_CALLBACK);
            ck_assert_int_eq(fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW), 0);
            tribo_destroy(copy);
            one_fails(&w, v[scene[k].w.contact], scene[k].tangent);
        }
        /* no derivative by limit, where one is asked for */
        struct wrong none = {N, -1, 0, 0.0};
        assert_ok(tribo_set_user_law(c, wrong_law, &none));
        assert_ok(tribo_balance_tangent(c, v, a, feq, f, NULL, NULL));
        assert_ok(tribo_tangent_product(c, a, a, df));
        assert_status(tribo_limit_product(c, limit, df), TRIBO_ERR_CALLBACK);
        assert_says(tribo_message(c), "law gave no derivative by the limit of contact 0");
        assert_ok(tribo_force_tangent(c, v, a, f, df, df, NULL));
        assert_status(tribo_force_tangent(c, v, a, f, df, df, feq), TRIBO_ERR_CALLBACK);
        tribo_destroy(c);
    }
}

TEST(settings)
{
    const size_t first[] = {0};
    const double ratio[] = {1.0, 2.0, 1.0}, v[] = {0.0, 0.05, 2.0};
    struct quinn q = {0};
    double f[3], g[3];
    int law;
    tribo_context *c, *copy;
    assert_ok(tribo_create(&c, 3));
    assert_ok(tribo_create(&copy, 3));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_epsilon_all(c, 0.1));
    assert_status(tribo_set_user_law(NULL, quinn_box, &q), TRIBO_ERR_NULL);
    assert_status(tribo_set_user_law(c, NULL, &q), TRIBO_ERR_NULL);
    assert_says(tribo_message(c), "law is NULL");
    assert_ok(tribo_set_planar(c, 1, first));
    assert_status(tribo_set_user_law(c, quinn_box, &q), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_message(c), "laws of the caller know no planar contacts, and contact 0 is one");
    assert_ok(tribo_set_planar(c, 0, NULL));
    assert_ok(tribo_set_static(c, ratio, NULL));
    assert_status(tribo_set_user_law(c, quinn_box, &q), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_message(c), "static limits");
    assert_ok(tribo_get_law(c, &law));
    ck_assert_int_eq(law, TRIBO_QUINN);
    assert_ok(tribo_set_static(c, NULL, NULL));
    const size_t changes = count_of(c, TRIBO_COUNT_SETTINGS);
    assert_ok(tribo_set_user_law(c, quinn_box, &q));
    ck_assert_uint_gt(count_of(c, TRIBO_COUNT_SETTINGS), changes);
    assert_ok(tribo_get_law(c, &law));
    ck_assert_int_eq(law, TRIBO_USER_LAW);
    assert_status(tribo_set_law(c, TRIBO_USER_LAW), TRIBO_ERR_RANGE);
    assert_status(tribo_set_planar(c, 1, first), TRIBO_ERR_UNSUPPORTED);
    assert_status(tribo_set_static(c, ratio, NULL), TRIBO_ERR_UNSUPPORTED);
    assert_ok(tribo_set_static(c, (const double[]){1.0, 1.0, 1.0}, NULL));
    assert_ok(tribo_copy_settings(copy, c));
    assert_ok(tribo_get_law(copy, &law));
    ck_assert_int_eq(law, TRIBO_USER_LAW);
    assert_ok(tribo_force(c, v, v, f));
    assert_ok(tribo_force(copy, v, v, g));
    assert_all_exact(g, f, 3);
    ck_assert_int_gt(q.calls, 1);
    assert_ok(tribo_accept(c, v, v));
    assert_ok(tribo_set_law(c, TRIBO_QUINN));
    assert_ok(tribo_force(c, v, v, g));
    assert_all_close(g, f, 3, 1e-15);
    tribo_destroy(copy);
    tribo_destroy(c);
}

TEST_MAIN("user_law", {equal_balances, 8}, {equal_forces, 24}, {boxes, 4}, {one_contact, 2}, {failures, 1}, {settings, 1})
