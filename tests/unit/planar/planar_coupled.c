/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar contacts that R couples with each other and with scalar ones: what makes their solution, in long double, and another
 * method's. */
#include <string.h>

#include "problem.h"

struct scene {
    struct problem p;
    size_t count, first[LARGEST];
    int wide[LARGEST]; /* of the contact that begins with a direction: 1, 2, or 0 */
};

/* Some neighbours become planar contacts: discs, ellipses, and now and then a line. */
static struct scene scene_create(struct random *g, const struct recipe *recipe)
{
    struct scene s = {.p = problem_create(g, recipe)};
    for (size_t i = 0; i < s.p.n; i += (size_t)s.wide[i]) {
        s.wide[i] = i + 1 < s.p.n && below(g, 3) > 0 ? 2 : 1;
        if (s.wide[i] == 2) {
            const size_t kind = below(g, 8);
            s.first[s.count++] = i;
            s.p.limit[i + 1] = kind < 5 ? s.p.limit[i] : kind < 7 ? s.p.limit[i] * uniform(g, 0.1, 1.0) : 0.0;
            s.p.epsilon[i + 1] = s.p.epsilon[i];
            s.p.v[i + 1] = s.p.v[i] == 0.0 ? 0.0 : s.p.epsilon[i] * uniform(g, -1.0, 1.0);
        }
    }
    return s;
}

static tribo_context *scene_context(const struct scene *s, int law)
{
    tribo_context *c = problem_context(&s->p, law, TRIBO_CONSISTENT);
    assert_ok(tribo_set_planar(c, s->count, s->first));
    return c;
}

static long double norm(int wide, const long double *x)
{
    return wide == 2 ? hypotl(x[0], x[1]) : fabsl(x[0]);
}

/* c of the lens, kappa in parts of limits; relaxes 0: the disc. Where the contact slides: 1, and c is twice its direction. */
static int shift_of(const struct scene *s, size_t i, int relaxes, long double *c)
{
    const double *b = s->p.limit + i, *v = s->p.v + i, e = s->p.epsilon[i];
    const double far = s->wide[i] == 2 ? fmax(b[0], b[1]) : b[0];
    for (int k = 0; k < s->wide[i]; k++) {
        c[k] = far > 0.0 ? 2.0L * b[k] * v[k] / (far * e) : 0.0L;
    }
    const long double length = norm(s->wide[i], c);
    const int slides = length >= 2.0L;
    for (int k = 0; k < s->wide[i]; k++) {
        c[k] *= slides ? 2.0L / length : relaxes ? 1.0L : 0.0L;
    }
    return slides;
}

/* Distance of z from y if y is in the lens, else infinity. */
static long double distance(int wide, const long double *c, const long double *z, const long double *y)
{
    long double shifted[2], off[2];
    for (int k = 0; k < wide; k++) {
        shifted[k] = y[k] + c[k];
        off[k] = y[k] - z[k];
    }
    return norm(wide, y) <= 1.0L + 1e-17L && norm(wide, shifted) <= 1.0L + 1e-17L ? norm(wide, off) : HUGE_VALL;
}

/* y = the point of the lens that is nearest to z: the best of all that may be. */
static void project(int wide, const long double *c, const long double *z, long double *y)
{
    const long double length = norm(wide, c), w[2] = {z[0] + c[0], wide == 2 ? z[1] + c[1] : 0.0L};
    const long double from = norm(wide, z), beyond = norm(wide, w);
    const long double height = sqrtl(fmaxl((1.0L - 0.5L * length) * (1.0L + 0.5L * length), 0.0L)),
                      per = length > 0.0L ? height / length : 0.0L;
    const long double x = wide == 2 ? c[0] : 0.0L, t = wide == 2 ? c[1] : 0.0L;
    const long double candidates[5][2] = {{z[0], z[1]},
                                          {z[0] / from, z[1] / from},
                                          {w[0] / beyond - c[0], wide == 2 ? w[1] / beyond - c[1] : 0.0L},
                                          {-0.5L * c[0] - per * t, -0.5L * t + per * x},
                                          {-0.5L * c[0] + per * t, -0.5L * t - per * x}};
    long double best = HUGE_VALL;
    for (size_t k = 0; k < COUNT(candidates); k++) {
        const long double d = distance(wide, c, z, candidates[k]);
        if (d < best) {
            best = d;
            memcpy(y, candidates[k], sizeof candidates[k]);
        }
    }
    if (best == HUGE_VALL) { /* a corner, up to rounding */
        const long double side = -z[0] * t + z[1] * x > 0.0L ? 3 : 4;
        memcpy(y, candidates[(int)side], sizeof candidates[0]);
    }
}

/* The largest eigenvalue of a contact's own block in parts of limits. */
static long double stiffness(const struct scene *s, size_t i)
{
    const double *b = s->p.limit + i;
    const size_t n = s->p.n;
    const long double a = (long double)b[0] * b[0] * s->p.r[i * n + i];
    if (s->wide[i] == 1) {
        return a;
    }
    const long double d = (long double)b[1] * b[1] * s->p.r[(i + 1) * n + i + 1],
                      m = (long double)b[0] * b[1] * s->p.r[i * n + i + 1];
    return 0.5L * (a + d) + hypotl(0.5L * (a - d), m);
}

/* Where one step of the projection takes the contact at i, in parts of limits, from forces f; *noise: what rounding of f's sums
 * may make of it. A contact that slides: where it is. */
static void fixed_point(const struct scene *s, size_t i, int relaxes, const double *f, long double *y, double *noise)
{
    const struct problem *p = &s->p;
    const long double stiff = stiffness(s, i);
    long double c[2] = {0.0L, 0.0L}, z[2] = {0.0L, 0.0L};
    *noise = 0.0;
    if (shift_of(s, i, relaxes, c)) {
        y[0] = -0.5L * c[0];
        y[1] = -0.5L * c[1];
        return;
    }
    for (int k = 0; k < s->wide[i]; k++) {
        const size_t row = i + (size_t)k;
        long double pull = acceleration(p, row, f);
        double size = fabs(p->a[row]);
        for (int j = 0; j < s->wide[i]; j++) {
            pull += (long double)p->r[row * p->n + i + (size_t)j] * c[j] * p->limit[i + (size_t)j];
        }
        for (size_t j = 0; j < p->n; j++) {
            size += fabs(p->r[row * p->n + j] * f[j]);
        }
        z[k] = (p->limit[row] > 0.0 ? f[row] / (long double)p->limit[row] : 0.0L) - pull * p->limit[row] / stiff;
        *noise += (double)((double)(p->n + 4) * DBL_EPSILON * size * p->limit[row] / stiff);
    }
    project(s->wide[i], c, z, y);
}

/* part: of limits, beyond rounding. */
static void check_fixed_point(const struct scene *s, int relaxes, const double *f, double part)
{
    for (size_t i = 0; i < s->p.n; i += (size_t)s->wide[i]) {
        long double y[2] = {0.0L, 0.0L};
        double noise = 0.0;
        const int open = !(stiffness(s, i) > 0.0L);
        if (!open) {
            fixed_point(s, i, relaxes, f, y, &noise);
        }
        for (int k = 0; k < s->wide[i]; k++) {
            const double limit = s->p.limit[i + (size_t)k];
            assert_close(f[i + (size_t)k], (double)(open ? 0.0L : y[k] * limit), (part + 4.0 * noise) * limit);
        }
    }
}

/* Sweeps of the projection, a contact after the other, until they move nothing, in parts of each force: a force far below its
 * limit stands still in parts of that long before the end. Returns whether they came to that. */
static int gauss_seidel(const struct scene *s, int relaxes, double *f)
{
    double moved = 1.0;
    for (int sweep = 0; sweep < 4000 && moved > 1e-15; sweep++) {
        moved = 0.0;
        for (size_t i = 0; i < s->p.n; i += (size_t)s->wide[i]) {
            long double y[2] = {0.0L, 0.0L};
            double noise;
            if (stiffness(s, i) > 0.0L) {
                fixed_point(s, i, relaxes, f, y, &noise);
            }
            for (int k = 0; k < s->wide[i]; k++) {
                const size_t row = i + (size_t)k;
                const double to = (double)(y[k] * s->p.limit[row]);
                moved = fmax(moved, to != f[row] ? fabs(to - f[row]) / fmax(fabs(to), fabs(f[row])) : 0.0);
                f[row] = to;
            }
        }
    }
    return moved <= 1e-15;
}

/* 1/2 f'Rf + (a + R_d kappa)'f */
static long double objective(const struct scene *s, int relaxes, const double *f, long double *size)
{
    long double sum = 0.0L;
    *size = 0.0L;
    for (size_t i = 0; i < s->p.n; i += (size_t)s->wide[i]) {
        long double c[2] = {0.0L, 0.0L};
        shift_of(s, i, relaxes, c);
        for (int k = 0; k < s->wide[i]; k++) {
            const size_t row = i + (size_t)k;
            long double pull = 0.5L * (acceleration(&s->p, row, f) + s->p.a[row]);
            for (int j = 0; j < s->wide[i]; j++) {
                pull += (long double)s->p.r[row * s->p.n + i + (size_t)j] * c[j] * s->p.limit[i + (size_t)j];
            }
            sum += pull * f[row];
            *size += fabsl(pull * f[row]);
        }
    }
    return sum;
}

/* The fixed point is met, no other method finds a lower objective, and where that one has come to an end R f is the same. */
static void check_solution(const struct scene *s, int relaxes, const double *f, size_t *ended)
{
    double other[LARGEST] = {0.0};
    long double size, ignored;
    check_fixed_point(s, relaxes, f, 1e-12);
    const int done = gauss_seidel(s, relaxes, other);
    const long double mine = objective(s, relaxes, f, &size), theirs = objective(s, relaxes, other, &ignored);
    require(mine <= theirs + 1e-13L * size, "objective %Lg, and %Lg can be", mine, theirs);
    for (size_t i = 0; done && i < s->p.n; i++) {
        const double scale = balancing_noise(&s->p, i, f) / ((double)(s->p.n + 4) * DBL_EPSILON) * s->p.r[i * s->p.n + i];
        assert_close((double)acceleration(&s->p, i, f), (double)acceleration(&s->p, i, other), 1e-7 * scale);
    }
    *ended += (size_t)done;
}

/* Of every rank, discs, ellipses, lines, lenses and intervals; _i: decades of masses, arms and limits, so that masses differ by
 * up to 1e8. */
TEST(random_problems)
{
    struct random g = random_of(_i);
    size_t solved = 0, ended = 0;
    const int laws[] = {TRIBO_QUINN, TRIBO_COULOMB, TRIBO_KARNOPP};
    for (int k = 0; k < 200; k++) {
        const struct recipe recipe = recipe_random(&g, 12, (double)_i);
        const struct scene s = scene_create(&g, &recipe);
        const int law = laws[k % 4 == 3 ? 2 : 0];
        double f[LARGEST];
        tribo_context *c = scene_context(&s, law);
        assert_ok(tribo_balance(c, s.p.v, s.p.a, NULL, f));
        require(real_of(c, TRIBO_REAL_RESIDUAL) < 1e-12 || _i > 0, "residual %g", real_of(c, TRIBO_REAL_RESIDUAL));
        check_solution(&s, law == TRIBO_QUINN, f, &ended);
        solved += count_of(c, TRIBO_COUNT_SOLVES);
        tribo_destroy(c);
    }
    require(solved > 100 && ended > 20, "%zu problems, and %zu with two methods", solved, ended);
}

/* The step form is the problem at rest with a = vfree/dt. */
TEST(steps)
{
    struct random g = random_of(_i);
    size_t ended = 0;
    for (int k = 0; k < 50; k++) {
        const struct recipe recipe = recipe_random(&g, 12, (double)_i);
        struct scene s = scene_create(&g, &recipe);
        double f[LARGEST], vfree[LARGEST];
        tribo_context *c = scene_context(&s, TRIBO_QUINN);
        for (size_t i = 0; i < s.p.n; i++) {
            vfree[i] = 0.01 * s.p.a[i];
            s.p.a[i] = vfree[i] / 0.01;
            s.p.v[i] = 0.0;
        }
        assert_ok(tribo_step_force(c, 0.01, vfree, f));
        check_solution(&s, 0, f, &ended);
        tribo_destroy(c);
    }
}

enum { TALLEST = 3, CORNER = 4, WAYS = 5 }; /* boxes of a stack; corners of a box; directions in which a box moves */

/* Boxes upon each other, each on four corners whose heights differ by up to uneven; j [8 boxes][WAYS boxes]. R has eigenvalues
 * down to uneven^2, and 0. */
static struct scene scene_of_stack(struct random *g, size_t boxes, double uneven, double *j)
{
    static const double inverse[] = {1.0, 1.0, 5.8, 5.8, 3.0}; /* mass; inertia about x, y, z */
    const size_t n = 2 * CORNER * boxes, ways = WAYS * boxes;
    struct scene s = {.p = {.n = n}, .count = CORNER * boxes};
    const int alike = below(g, 2) == 0;
    double limit = 0.0;
    memset(j, 0, n * ways * sizeof *j);
    for (size_t i = 0; i < n; i += 2) {
        const double x = i % 4 ? 0.5 : -0.5, y = i / 4 % 2 ? 0.5 : -0.5, above = uneven * uniform(g, -1.0, 1.0);
        for (size_t side = 0; side < 2 && side <= i / (2 * CORNER); side++) {
            const double way = side ? -1.0 : 1.0, z = above + (side ? 0.1 : -0.1);
            double *row = j + i * ways + (i / (2 * CORNER) - side) * WAYS;
            memcpy(row, (double[]){way, 0.0, 0.0, way * z, -way * y}, WAYS * sizeof *row);
            memcpy(row + ways, (double[]){0.0, way, -way * z, 0.0, way * x}, WAYS * sizeof *row);
        }
        s.first[i / 2] = i;
        s.wide[i] = 2;
        limit = alike && i > 0 ? limit : log_uniform(g, 1.0);
        s.p.limit[i] = s.p.limit[i + 1] = limit;
        s.p.epsilon[i] = s.p.epsilon[i + 1] = 1.0;
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < n; k++) {
            for (size_t d = 0; d < ways; d++) {
                s.p.r[i * n + k] += inverse[d % WAYS] * j[i * ways + d] * j[k * ways + d];
            }
        }
    }
    return s;
}

/* Motions of the boxes, fast and slow; uneven from 1 down to 1e-10. Redundant contacts balance to 4e-12 of limits. */
TEST(boxes_on_uneven_corners)
{
    struct random g = random_of(_i);
    const double h = 0.01;
    for (int k = 0; k < 60; k++) {
        double j[2 * CORNER * TALLEST * WAYS * TALLEST];
        const size_t boxes = 1 + (size_t)k % TALLEST, ways = WAYS * boxes;
        struct scene s = scene_of_stack(&g, boxes, pow(10.0, -_i), j);
        tribo_context *c = scene_context(&s, TRIBO_COULOMB);
        for (int call = 0; call < 3; call++) {
            double f[LARGEST], vfree[LARGEST] = {0.0};
            for (size_t d = 0; d < ways; d++) {
                const double speed = pow(10.0, -3.0 * call) * uniform(&g, -1.0, 1.0);
                for (size_t i = 0; i < s.p.n; i++) {
                    vfree[i] += j[i * ways + d] * speed;
                }
            }
            for (size_t i = 0; i < s.p.n; i++) {
                s.p.a[i] = vfree[i] / h;
            }
            assert_ok(tribo_step_force(c, h, vfree, f));
            check_fixed_point(&s, 0, f, 4e-12);
        }
        tribo_destroy(c);
    }
}

/* Other tangential directions, the same forces: each planar contact's are turned by an angle of its own. */
TEST(turned)
{
    struct random g = random_of(_i);
    for (int k = 0; k < 50; k++) {
        const struct recipe recipe = recipe_regular(&g, 12);
        struct scene s = scene_create(&g, &recipe), t;
        const size_t n = s.p.n;
        double turn[LARGEST * LARGEST], f[LARGEST], got[LARGEST];
        t = s;
        t.p = problem_turn(&g, &s.p, s.wide, turn);
        tribo_context *c = scene_context(&s, TRIBO_QUINN), *d = scene_context(&t, TRIBO_QUINN);
        if (k % 2) {
            assert_ok(tribo_set_epsilon_step(c, 0.1, 1.0));
            assert_ok(tribo_set_epsilon_step(d, 0.1, 1.0));
            assert_close(real_of(d, TRIBO_REAL_MAX_RATE), real_of(c, TRIBO_REAL_MAX_RATE), 1e-12);
            assert_close(real_of(c, TRIBO_REAL_MAX_RATE), 10.0, 1e-13);
        }
        assert_ok(tribo_balance(c, s.p.v, s.p.a, NULL, f));
        assert_ok(tribo_balance(d, t.p.v, t.p.a, NULL, got));
        problem_check_turned(n, turn, f, got);
        tribo_destroy(c);
        tribo_destroy(d);
    }
}

/* ------------------------------------------------------------------------------------------------------ derivatives */

#define STEP 1e-7

/* Differences to both sides that differ by more are of a point with a kink, where derivatives are one-sided. */
#define KINK 1e-5

/* Differences along (dv, da) where there is no kink; returns how many could be compared. */
static size_t check_direction(tribo_context *c, const struct problem *p, const double *by_v, const double *by_a, const double *dv,
                              const double *da)
{
    double f[LARGEST], before[LARGEST], after[LARGEST];
    size_t smooth = 0;
    problem_forces(c, p, 0.0, dv, da, f);
    problem_forces(c, p, -STEP, dv, da, before);
    problem_forces(c, p, STEP, dv, da, after);
    for (size_t i = 0; i < p->n; i++) {
        const double forward = (after[i] - f[i]) / STEP, backward = (f[i] - before[i]) / STEP;
        double want = 0.0, size = 1.0;
        for (size_t j = 0; j < p->n; j++) {
            want += by_v[i * p->n + j] * dv[j] + by_a[i * p->n + j] * da[j];
            size += fabs(by_v[i * p->n + j] * dv[j]) + fabs(by_a[i * p->n + j] * da[j]);
        }
        if (fabs(forward - backward) < KINK * size) {
            assert_close(want, 0.5 * (forward + backward), 2e-5 * size);
            smooth++;
        }
    }
    return smooth;
}

TEST(tangents)
{
    struct random g = random_of(_i);
    size_t smooth = 0, all = 0;
    for (int k = 0; k < 60; k++) {
        const struct recipe recipe = recipe_regular(&g, 10);
        const struct scene s = scene_create(&g, &recipe);
        const size_t n = s.p.n;
        double by_v[LARGEST * LARGEST], by_a[LARGEST * LARGEST], dv[LARGEST], da[LARGEST], df[LARGEST], f[LARGEST];
        tribo_context *c = scene_context(&s, k % tribo_law_count());
        for (size_t i = 0; i < n; i++) {
            const int jumps = k % tribo_law_count() == TRIBO_COULOMB;
            dv[i] = jumps ? 0.0 : uniform(&g, -1.0, 1.0);
            da[i] = uniform(&g, -1.0, 1.0);
        }
        assert_ok(tribo_balance_tangent(c, s.p.v, s.p.a, NULL, f, by_v, by_a));
        assert_ok(tribo_tangent_product(c, dv, da, df));
        for (size_t i = 0; i < n; i++) {
            double want = 0.0, size = 1.0;
            for (size_t j = 0; j < n; j++) {
                want += by_v[i * n + j] * dv[j] + by_a[i * n + j] * da[j];
                size += fabs(by_v[i * n + j] * dv[j]) + fabs(by_a[i * n + j] * da[j]);
            }
            assert_close(df[i], want, 1e-12 * size);
        }
        smooth += check_direction(c, &s.p, by_v, by_a, dv, da);
        all += n;
        tribo_destroy(c);
    }
    require(smooth > all / 2, "only %zu of %zu compared", smooth, all);
}

/* Discs stay discs, ellipses change their shape; lines stay lines. */
static void change_limits(struct random *g, const struct scene *s, double *dlimit)
{
    for (size_t i = 0; i < s->p.n; i++) {
        const int disc = i > 0 && s->wide[i] == 0 && s->p.limit[i] == s->p.limit[i - 1];
        dlimit[i] = disc ? dlimit[i - 1] : s->p.limit[i] > 0.0 ? uniform(g, -1.0, 1.0) : 0.0;
    }
}

/* Every law, and epsilon that is given or follows the limits. */
TEST(limits)
{
    struct random g = random_of(_i);
    const int law = _i % tribo_law_count(), follows = _i / tribo_law_count();
    size_t smooth = 0, all = 0;
    for (int k = 0; k < 40; k++) {
        const struct recipe recipe = recipe_regular(&g, 10);
        const struct scene s = scene_create(&g, &recipe);
        double dlimit[LARGEST], df[LARGEST], f[LARGEST], before[LARGEST], after[LARGEST];
        tribo_context *c = scene_context(&s, law);
        change_limits(&g, &s, dlimit);
        if (follows) {
            assert_ok(tribo_set_epsilon_step(c, 1.0, 2.0));
        }
        assert_ok(tribo_balance_tangent(c, s.p.v, s.p.a, NULL, f, NULL, NULL));
        assert_ok(tribo_limit_product(c, dlimit, df));
        problem_forces_of_limits(c, &s.p, -STEP, dlimit, before);
        problem_forces_of_limits(c, &s.p, STEP, dlimit, after);
        for (size_t i = 0; i < s.p.n; i++) {
            const double forward = (after[i] - f[i]) / STEP, backward = (f[i] - before[i]) / STEP, size = 1.0 + fabs(df[i]);
            if (fabs(forward - backward) < KINK * size) {
                assert_close(df[i], 0.5 * (forward + backward), 2e-5 * size);
                smooth++;
            }
        }
        all += s.p.n;
        tribo_destroy(c);
    }
    require(smooth > all / 2, "only %zu of %zu compared", smooth, all);
}

/* ------------------------------------------------------------------------------------------------ redundant contacts */

/* m planar contacts that hold one body in the same way: pulled along any line they share as scalar ones do; and ask for nothing
 * but the last forces if told so. */
TEST(identical_contacts_share)
{
    enum { MOST = 6 };
    struct random g = random_of(_i);
    const size_t m = 2 + below(&g, MOST - 1);
    const double angle = uniform(&g, -PI, PI), e[2] = {cos(angle), sin(angle)};
    double r[4 * MOST * MOST] = {0.0}, line[MOST * MOST], limit[2 * MOST], a[2 * MOST], f[2 * MOST], want[MOST], total = 0.0;
    const double none[2 * MOST] = {0.0};
    size_t first[MOST];
    tribo_context *c, *scalar;
    for (size_t i = 0; i < m; i++) {
        first[i] = 2 * i;
        limit[2 * i] = limit[2 * i + 1] = uniform(&g, 0.2, 2.0);
        total += limit[2 * i];
        for (size_t j = 0; j < m; j++) {
            line[i * m + j] = r[4 * i * m + 2 * j] = r[(2 * i + 1) * 2 * m + 2 * j + 1] = 1.0;
        }
    }
    assert_ok(tribo_create(&c, 2 * m));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_set_planar(c, m, first));
    assert_ok(tribo_create(&scalar, m));
    assert_ok(tribo_set_operator_dense(scalar, line));
    for (size_t i = 0; i < m; i++) {
        want[i] = limit[2 * i];
    }
    assert_ok(tribo_set_limit(scalar, want));
    for (int k = 0; k < 10; k++) {
        const double pull = total * uniform(&g, -1.2, 1.2);
        double pulls[MOST];
        for (size_t i = 0; i < 2 * m; i++) {
            a[i] = pull * e[i % 2];
            pulls[i / 2] = pull;
        }
        assert_ok(tribo_balance(scalar, none, pulls, NULL, want));
        assert_ok(tribo_balance(c, none, a, NULL, f));
        for (size_t i = 0; i < 2 * m; i++) {
            assert_close(f[i], want[i / 2] * e[i % 2], 2e-8 * total);
        }
    }
    tribo_destroy(c);
    tribo_destroy(scalar);
}

/* The share is the same whatever was solved before, and no other solution has a smaller norm; without it, the forces stay near
 * the last ones. */
static void check_least_norm(int seed, int small)
{
    struct random g = random_of(seed);
    size_t apart = 0;
    for (int k = 0; k < 20; k++) {
        const struct recipe recipe = {4 + below(&g, 8), 3, 0.0, 0.9, 1.0, 0.0, 0.5, 0.0};
        struct scene s = scene_create(&g, &recipe);
        for (size_t i = 0; small && i < s.p.n; i += (size_t)s.wide[i]) {
            const double part = uniform(&g, 0.3, 3.0) * (below(&g, 2) ? 1e-3 : 1.0);
            for (size_t d = i; d < i + (size_t)s.wide[i]; d++) {
                s.p.limit[d] *= part;
            }
        }
        double f[LARGEST], again[LARGEST], last[LARGEST], disturbed[LARGEST], norm_of = 0.0, norm_of_last = 0.0;
        for (size_t i = 0; i < s.p.n; i++) { /* what some forces balance, with a little to slide */
            f[i] = s.p.limit[i] * uniform(&g, -1.0, 1.0);
            s.p.v[i] = s.p.a[i] = 0.0;
        }
        for (size_t i = 0; i < s.p.n; i++) {
            last[i] = -(double)acceleration(&s.p, i, f);
        }
        memcpy(s.p.a, last, sizeof s.p.a);
        tribo_context *c = scene_context(&s, TRIBO_QUINN), *d = scene_context(&s, TRIBO_QUINN);
        assert_ok(tribo_set_sharing(d, TRIBO_SHARE_PREVIOUS));
        for (size_t i = 0; i < s.p.n; i++) {
            disturbed[i] = 3.0 * s.p.a[i] * uniform(&g, -1.0, 1.0);
        }
        assert_ok(tribo_balance(c, s.p.v, s.p.a, NULL, f));
        assert_ok(tribo_balance(c, s.p.v, disturbed, NULL, again));
        assert_ok(tribo_balance(c, s.p.v, s.p.a, NULL, again));
        assert_ok(tribo_balance(d, s.p.v, disturbed, NULL, last));
        assert_ok(tribo_balance(d, s.p.v, s.p.a, NULL, last));
        assert_all_close(again, f, s.p.n, 1e-7);
        check_fixed_point(&s, 1, f, 1e-12);
        for (size_t i = 0; i < s.p.n; i++) {
            norm_of += f[i] * f[i];
            norm_of_last += last[i] * last[i];
            assert_close((double)acceleration(&s.p, i, f), (double)acceleration(&s.p, i, last), 1e-10);
        }
        require(norm_of <= norm_of_last + 1e-7, "norm %.17g, and %.17g can be", norm_of, norm_of_last);
        apart += norm_of < norm_of_last - 1e-3;
        tribo_destroy(c);
        tribo_destroy(d);
    }
    require(apart > 3, "%zu of 20 shares differ", apart);
}

TEST(least_norm)
{
    check_least_norm(_i, 0);
}

/* Some limits are 1000 times as small as others, so that rounding is a larger part of these. */
TEST(least_norm_of_small_limits)
{
    static const int seeds[] = {3, 5, 11, 21, 27, 28, 37, 46, 48, 74};
    check_least_norm(seeds[_i], 1);
}

/* Three planar contacts or two and a scalar one on a body of three directions, R = J J': a rim bears a pressure of rounding,
 * along which many solutions differ. want: an interior-point method in numbers of 16 bytes. */
TEST(least_norm_beside_rims)
{
    enum { N = 5, M = 3 };
    static const struct {
        double j[N * M], a[N], want[N];
        size_t first[2];
    } known[] = {
        {{-0.66435054931045023, 0.81390263845523503, 0, -0.82306311390587084, 0, -0.38228433174163295, 0.53884114138154637,
          0.97410391808589725, 0.65482543985919384, 0.54804779548152716, 0.5164316686049234, 0, 1.6461262278117417, -0,
          0.76456866348326591},
         {-0.16083607418989748, -1.8502989744590981, 2.8387168888089374, 1.6638224024710146, 3.7005979489181962},
         {-0.0640001478824, 0.739638319447, -0.749320287243, -0.98173103212, -0.190273961891},
         {0, 3}},
        {{0, 0.8798446178563144, 0.89198119128494935, 0, 0.51725237151872738, 0, 0.41704268684764328, 0.34875261087105119,
          0.97077104417571403, 0.41562757354208468, 0, 0.97897228076383724, 0, -0.48839088852018442, 0},
         {-1.6461658766448248, -0.26535863741483195, -1.5608401704459671, -1.3926331007376438, 0.25055224072344934},
         {0.985189600228, -0.171468514904, 0.0113411170738, 0.459359879858, 0.550912650651},
         {0, 2}},
        {{-0.57522966733174075, 0, -0.41852206566967065, 0.40018278091436166, -0.68980233032075366, 0.62724607794646481,
          0.84960345625673583, 0.93035260214191129, 0.87104683803027716, -0.51784451542449794, 0.65777966377820896,
          -0.62851156641777362, 0.47859838573307245, 0.82886877107217538, 0.39849492074277876},
         {-1.6082016134065498, 1.0962571637227574, 3.4820527722586769, -1.3214854712615061, 2.057305539306145},
         {0.985457549433, 0.169921800443, -0.543334488149, 0.710970603394, -0.748324388677},
         {0, 2}}};
    const double none[N] = {0.0};
    double r[N * N], f[N];
    tribo_context *c;
    for (size_t i = 0; i < N * N; i++) {
        const double *one = known[_i].j + i / N * M, *other = known[_i].j + i % N * M;
        r[i] = (double)((long double)one[0] * other[0] + (long double)one[1] * other[1] + (long double)one[2] * other[2]);
    }
    assert_ok(tribo_create(&c, N));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_set_planar(c, 2, known[_i].first));
    assert_ok(tribo_balance(c, none, known[_i].a, NULL, f));
    assert_all_close(f, known[_i].want, N, 1e-7);
    tribo_destroy(c);
}

/* A clone solves the groups of its own contacts, whatever becomes of the context that it is a copy of, and of its memory. */
TEST(clones)
{
    enum { N = 4 };
    const double r[N * N] = {2.0, 1.0, 0.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 1.0, 0.0, 0.0, 1.0, 2.0};
    const double v[N] = {0.0}, a[N] = {0.5, -0.2, 0.3, 0.4}, limit[N] = {1.0, 1.0, 1.0, 1.0};
    const size_t first[] = {2, 0};
    double f[N], want[N];
    tribo_context *c, *copy, *other;
    assert_ok(tribo_create(&c, N));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_clone(c, &other));
    assert_ok(tribo_set_planar(c, 1, first));
    assert_ok(tribo_balance(c, v, a, NULL, want));
    assert_ok(tribo_clone(c, &copy));
    tribo_destroy(c);
    assert_ok(tribo_set_planar(other, 1, first + 1));
    assert_ok(tribo_balance(copy, v, a, NULL, f));
    assert_all_close(f, want, N, 1e-14);
    tribo_destroy(copy);
    tribo_destroy(other);
}

TEST_MAIN("planar_coupled", {identical_contacts_share, 20}, {least_norm, 5}, {least_norm_of_small_limits, 10},
          {least_norm_beside_rims, 3}, {random_problems, 5}, {steps, 5}, {boxes_on_uneven_corners, 11}, {turned, 3},
          {tangents, 3}, {limits, 12}, {clones, 1})
