/* SPDX-License-Identifier: BSD-3-Clause */
/* Coupled contacts of bodies whose masses are far apart, redundant ones among them, against an enumeration of all stick sets in
 * numbers of twice as many digits. */
#include "tribo/tribo.h"

#include "numerics/twofold.h"
#include "support.h"

#include <float.h>
#include <string.h>

enum { BODIES = 4, CONTACTS = 5 };

/* Relative errors of a that the library takes for the caller's rounding (TRIBO_DISAGREEMENT). */
#define ROUNDING 5e-13

struct scene {
    size_t bodies, contacts;
    double inverse[BODIES], j[CONTACTS][BODIES], limit[CONTACTS];
    struct twofold a[CONTACTS], r[CONTACTS][CONTACTS];
};

static struct twofold number(double x)
{
    return (struct twofold){x, 0.0};
}

static struct twofold divided(struct twofold a, struct twofold b)
{
    struct twofold x = number(a.hi / b.hi);
    for (int pass = 0; pass < 2; pass++) {
        x = twofold_add(x, number(twofold_minus(a, twofold_times(b, x)).hi / b.hi));
    }
    return x;
}

/* z''_i = R_i f + a_i */
static struct twofold acceleration(const struct scene *s, size_t i, const struct twofold *f)
{
    struct twofold sum = s->a[i];
    for (size_t k = 0; k < s->contacts; k++) {
        sum = twofold_add(sum, twofold_times(s->r[i][k], f[k]));
    }
    return sum;
}

/* The forces of contacts that all stick but those with side -1 or 1, which slide; redundant ones among the former get 0. */
static void solve(const struct scene *s, const int *side, struct twofold *f)
{
    struct twofold m[CONTACTS][CONTACTS + 1];
    size_t stuck[CONTACTS], n = 0, rank = 0;
    for (size_t i = 0; i < s->contacts; i++) {
        f[i] = number(side[i] * s->limit[i]);
        if (!side[i]) {
            stuck[n++] = i;
        }
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < n; k++) {
            m[i][k] = s->r[stuck[i]][stuck[k]];
        }
        m[i][n] = twofold_scale(acceleration(s, stuck[i], f), -1.0);
    }
    for (; rank < n; rank++) {
        size_t best = rank;
        for (size_t i = rank; i < n; i++) {
            const double own = s->r[stuck[i]][stuck[i]].hi, other = s->r[stuck[best]][stuck[best]].hi;
            best = m[i][i].hi / own > m[best][best].hi / other ? i : best;
        }
        if (m[best][best].hi <= 1e-27 * s->r[stuck[best]][stuck[best]].hi) {
            break;
        }
        for (size_t k = 0; k <= n; k++) {
            const struct twofold x = m[rank][k];
            m[rank][k] = m[best][k];
            m[best][k] = x;
        }
        for (size_t k = 0; k < n; k++) {
            const struct twofold x = m[k][rank];
            m[k][rank] = m[k][best];
            m[k][best] = x;
        }
        const size_t i = stuck[rank];
        stuck[rank] = stuck[best];
        stuck[best] = i;
        for (size_t k = 0; k < n; k++) {
            const struct twofold part = divided(m[k][rank], m[rank][rank]);
            for (size_t c = rank; k != rank && c <= n; c++) {
                m[k][c] = twofold_minus(m[k][c], twofold_times(part, m[rank][c]));
            }
        }
    }
    for (size_t i = 0; i < rank; i++) {
        f[stuck[i]] = divided(m[i][n], m[i][i]);
    }
}

/* Of all stick sets, the forces that miss Coulomb's law least: f_i = clamp(f_i - z''_i/R_ii). Returns by what part of a limit. */
static double enumerate(const struct scene *s, struct twofold *found)
{
    double least = HUGE_VAL;
    int side[CONTACTS];
    for (size_t set = 0; set < (size_t)(pow(3.0, (double)s->contacts) + 0.5); set++) {
        struct twofold f[CONTACTS];
        double most = 0.0;
        for (size_t i = 0, rest = set; i < s->contacts; i++, rest /= 3) {
            side[i] = (int)(rest % 3) - 1;
        }
        solve(s, side, f);
        for (size_t i = 0; i < s->contacts; i++) {
            const struct twofold step = divided(acceleration(s, i, f), s->r[i][i]), to = twofold_minus(f[i], step);
            const double off = to.hi > s->limit[i]    ? twofold_minus(f[i], number(s->limit[i])).hi
                               : to.hi < -s->limit[i] ? twofold_minus(f[i], number(-s->limit[i])).hi
                                                      : step.hi;
            most = fmax(most, fabs(off) / s->limit[i]);
        }
        if (most < least) {
            least = most;
            memcpy(found, f, sizeof f);
        }
    }
    return least;
}

/* How far forces on bodies are apart, in parts of the largest limit at the body. */
static double apart(const struct scene *s, const struct twofold *f, const struct twofold *g)
{
    double most = 0.0;
    for (size_t b = 0; b < s->bodies; b++) {
        struct twofold sum = number(0.0);
        double limit = 0.0;
        for (size_t i = 0; i < s->contacts; i++) {
            sum = twofold_add(sum, twofold_times(number(s->j[i][b]), twofold_minus(f[i], g[i])));
            limit = fmax(limit, fabs(s->j[i][b]) * s->limit[i]);
        }
        most = limit > 0.0 ? fmax(most, fabs(sum.hi) / limit) : most;
    }
    return most;
}

static double either(struct random *g, double size)
{
    return below(g, 2) ? size : -size;
}

/* Masses up to 10^decades, equal ones in one scene of four; contacts that repeat others; accelerations of the bodies, or any. */
static struct scene any_scene(struct random *g, double decades)
{
    struct scene s = {1 + below(g, BODIES), 1 + below(g, CONTACTS), {0}, {{0}}, {0}, {{0, 0}}, {{{0, 0}}}};
    struct twofold own[BODIES];
    const int grid = !below(g, 4), any = !below(g, 3);
    for (size_t b = 0; b < s.bodies; b++) {
        s.inverse[b] = pow(10.0, grid ? decades * (double)below(g, 3) - decades : uniform(g, -decades, decades));
        const double force = below(g, 6) ? either(g, pow(10.0, uniform(g, -2.0, 2.0))) : 0.0;
        own[b] = twofold_product(force, below(g, 3) ? s.inverse[b] : 1.0);
    }
    for (size_t i = 0; i < s.contacts; i++) {
        const size_t one = below(g, s.bodies), other = below(g, s.bodies + 1);
        if (i > 0 && !below(g, 5)) {
            memcpy(s.j[i], s.j[i - 1], sizeof s.j[i]);
        } else {
            s.j[i][one] = below(g, 4) ? 1.0 : uniform(g, -2.0, 2.0);
            if (other < s.bodies && other != one) {
                s.j[i][other] = below(g, 4) ? -1.0 : uniform(g, -2.0, 2.0);
            }
        }
        for (size_t b = 0; b < s.bodies; b++) {
            s.a[i] = twofold_add(s.a[i], twofold_times(number(s.j[i][b]), own[b]));
        }
        s.a[i] = any ? number(either(g, pow(10.0, uniform(g, -decades, decades)))) : s.a[i];
        s.limit[i] = below(g, 3) ? pow(10.0, uniform(g, -2.0, 1.0)) : 1.0;
        for (size_t k = 0; k <= i; k++) {
            for (size_t b = 0; b < s.bodies; b++) {
                const struct twofold share = twofold_times(twofold_product(s.j[i][b], s.j[k][b]), number(s.inverse[b]));
                s.r[i][k] = twofold_add(s.r[i][k], share);
            }
            s.r[k][i] = s.r[i][k];
        }
    }
    return s;
}

static tribo_context *context_of(const struct scene *s, int *status)
{
    size_t first[CONTACTS + 1] = {0}, col[CONTACTS * BODIES], n = 0;
    double val[CONTACTS * BODIES];
    tribo_context *c;
    for (size_t i = 0; i < s->contacts; i++) {
        for (size_t b = 0; b < s->bodies; b++) {
            col[n] = b;
            val[n] = s->j[i][b];
            n += s->j[i][b] != 0.0;
        }
        first[i + 1] = n;
    }
    assert_ok(tribo_create(&c, s->contacts));
    assert_ok(tribo_set_law(c, TRIBO_COULOMB));
    assert_ok(tribo_set_limit(c, s->limit));
    *status = tribo_set_operator_mass(c, s->bodies, s->inverse, first, col, val);
    return c;
}

/* 1 if errors of a of the size of rounding change the forces on bodies by more than 1e-8: then no digits of f are asked for. */
static int ill_posed(struct random *g, const struct scene *s, const struct twofold *f)
{
    int ill = 0;
    for (int tries = 0; tries < 25 && !ill; tries++) {
        struct scene near = *s;
        struct twofold other[CONTACTS];
        for (size_t i = 0; i < s->contacts; i++) {
            near.a[i] = twofold_times(s->a[i], twofold_sum(1.0, ROUNDING * ((double)below(g, 3) - 1.0)));
        }
        ill = enumerate(&near, other) > 1e-15 || apart(s, f, other) > 1e-8;
    }
    return ill;
}

/* _i: masses over 4, 12 and 18 decades. A call that fails is wrong, too. */
TEST(enumerated)
{
    const double decades[] = {2.0, 6.0, 9.0};
    struct random g = random_of(_i);
    size_t solved = 0;
    for (size_t k = 0; k < 400; k++) {
        const struct scene s = any_scene(&g, decades[_i % 3]);
        struct twofold want[CONTACTS], got[CONTACTS];
        double a[CONTACTS], f[CONTACTS], v[CONTACTS] = {0.0};
        int status;
        tribo_context *c = context_of(&s, &status);
        require(!status || (status == TRIBO_ERR_UNSUPPORTED && _i % 3 == 2), "scene %zu: %s", k, tribo_message(c));
        for (size_t i = 0; i < s.contacts; i++) {
            a[i] = s.a[i].hi;
        }
        for (int step = 0; !status && step < 2 && enumerate(&s, want) < 1e-15; step++) {
            const int failed = step ? tribo_step_force(c, 1.0, a, f) : tribo_balance(c, v, a, NULL, f);
            for (size_t i = 0; i < s.contacts; i++) {
                got[i] = number(f[i]);
            }
            const double off = failed ? HUGE_VAL : apart(&s, want, got);
            solved += off <= 1e-6;
            require(off <= 1e-6 || ill_posed(&g, &s, want), "scene %zu, %s: %s, off by %g of a limit", k,
                    step ? "step" : "balance", failed ? tribo_message(c) : "status 0", off);
        }
        tribo_destroy(c);
    }
    require(solved > 700, "%zu solved only", solved);
}

/* A heavy body rests on the ground by contact 0. A light one slides on it by contact 3, dragged through contacts 1 and 2, which
 * reach their limits at once: whatever their pull is, the heavy one stays at rest. _i: the light one's mass. */
TEST(heavy_rests)
{
    const double inverse[] = {0.01, pow(10.0, 1.0 + 2.0 * _i)};
    for (double pull = 2.0; pull < 1e12; pull *= 10.0) {
        const size_t first[] = {0, 1, 2, 3, 5}, col[] = {0, 1, 1, 0, 1};
        const double j[] = {1, 1, 1, -1, 1}, most = 0.5 * pull / inverse[1], limit[] = {1e-2, most, most, 1e-6}, v[4] = {0};
        const double a[] = {1e-5, -pull, -pull, -1e-4};
        double f[4], residual;
        tribo_context *c;
        assert_ok(tribo_create(&c, 4));
        assert_ok(tribo_set_law(c, TRIBO_COULOMB));
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_set_operator_mass(c, 2, inverse, first, col, j));
        assert_ok(tribo_balance(c, v, a, NULL, f));
        assert_close(f[0], f[3] - a[0] / inverse[0], 1e-12);
        assert_ok(tribo_get_real(c, TRIBO_REAL_RESIDUAL, &residual));
        assert_close(residual, 0.0, 1e-9);
        assert_ok(tribo_step_force(c, 1.0, a, f));
        assert_close(f[0], f[3] - a[0] / inverse[0], 1e-12);
        tribo_destroy(c);
    }
}

TEST_MAIN("masses", {enumerated, 6}, {heavy_rests, 8})
