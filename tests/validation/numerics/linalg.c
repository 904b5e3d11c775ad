/* SPDX-License-Identifier: BSD-3-Clause */
/* The library's own linear algebra: constraints, normal modes, general eigenvalues, at any ratio of sizes. */
#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/constraint.h"
#include "numerics/linalg.h"
#include "dynamics/reduce/normal_modes.h"
#include "support.h"

/* -------------------------------------------------------------------------------------------------------- constraints */

static struct matrix dense(size_t rows, size_t cols, const double *entries)
{
    struct matrix a;
    require(tribo_matrix_from_dense(&a, rows, cols, entries), "out of memory");
    return a;
}

static struct matrix diagonal(size_t n, const double *entries)
{
    struct matrix a;
    require(tribo_matrix_diagonal(&a, n, entries), "out of memory");
    return a;
}

#define MOST 40

/* Constraints from all rows of a dense J. */
static struct constraints constrain(size_t rows, size_t cols, const double *entries, const double *mass,
                                    const unsigned char *last)
{
    struct constraints c;
    size_t all[MOST];
    for (size_t i = 0; i < rows; i++) {
        all[i] = i;
    }
    struct matrix j = dense(rows, cols, entries), m = diagonal(cols, mass);
    require(tribo_constraints_create(&c, &j, &m, all, rows, last), "out of memory");
    tribo_matrix_free(&j);
    tribo_matrix_free(&m);
    return c;
}

/* A light body between the ground and a heavy one: two contacts, independent whatever the masses. */
TEST(light_between)
{
    const double j[] = {1.0, 0.0, -1.0, 1.0}, mass[] = {pow(10.0, -_i), 1.0}, force[] = {3.0, 5.0}, b[] = {7.0, 0.25};
    const unsigned char last[2] = {0};
    double f[2], q[2] = {0};
    for (int choose = 0; choose < 2; choose++) {
        struct constraints c = constrain(2, 2, j, mass, choose ? last : NULL);
        ck_assert_uint_eq(c.rank, 2);
        tribo_constraints_free(&c);
    }
    struct constraints c = constrain(2, 2, j, mass, NULL);
    /* the heavy one is pushed by the second contact alone, the light one by both */
    tribo_constraints_react(&c, (const size_t[]){0, 2}, 1, force, f);
    assert_exact(f[1], 5.0);
    assert_exact(f[0], 8.0);
    tribo_constraints_react(&c, (const size_t[]){1, 2}, 1, force + 1, f);
    assert_exact(f[1], 5.0);
    assert_exact(f[0], 5.0);
    tribo_constraints_follow(&c, b, q);
    assert_exact(q[0], 7.0);
    assert_exact(q[1], 7.25);
    tribo_constraints_free(&c);
}

/* The body that follows is the lighter one. */
TEST(light_follows)
{
    const double j[] = {1.0, -1.0};
    for (int heavy = 0; heavy < 2; heavy++) {
        const double mass[] = {heavy ? 1.0 : 3.0, heavy ? 3.0 : 1.0};
        struct constraints c = constrain(1, 2, j, mass, NULL);
        ck_assert_uint_eq(c.tie[0].dof[0], heavy ? 0 : 1);
        tribo_constraints_free(&c);
    }
}

/* A pile of bodies of any mass, every contact twice: half of the contacts hold, and those that are to be last do not. */
TEST(piles)
{
    enum { BODIES = 20 };
    struct random g = random_of(_i);
    double j[2 * BODIES * BODIES] = {0}, mass[BODIES];
    unsigned char last[2 * BODIES], taken[2 * BODIES] = {0};
    for (size_t i = 0; i < BODIES; i++) {
        const size_t first = below(&g, 2);
        mass[i] = log_uniform(&g, 8.0);
        for (size_t k = 0; k < 2; k++) {
            j[(2 * i + k) * BODIES + i] = 1.0;
            if (i) {
                j[(2 * i + k) * BODIES + i - 1] = -1.0;
            }
            last[2 * i + k] = k != first;
        }
    }
    struct constraints c = constrain(2 * BODIES, BODIES, j, mass, last);
    ck_assert_uint_eq(c.rank, BODIES);
    for (size_t k = 0; k < 2 * BODIES; k++) {
        ck_assert_uint_eq(last[c.order[k]], k < BODIES ? 0 : 1);
        taken[c.order[k]]++;
        ck_assert_uint_eq(taken[c.order[k]], 1);
    }
    tribo_constraints_free(&c);
}

/* Bodies tied in clusters: displacements that a basis allows are one for each cluster that is free, with entries 0 and 1. */
TEST(clusters)
{
    enum { BODIES = 12, CLUSTERS = 4 };
    struct random g = random_of(_i);
    double j[BODIES * BODIES] = {0}, mass[BODIES];
    size_t rows = 0, cluster[BODIES], leader[CLUSTERS];
    for (size_t i = 0; i < BODIES; i++) {
        mass[i] = log_uniform(&g, 6.0);
        cluster[i] = i < CLUSTERS ? i : below(&g, CLUSTERS);
        if (i < CLUSTERS) {
            leader[i] = i;
            continue;
        }
        j[rows * BODIES + i] = 1.0;
        j[rows++ * BODIES + leader[cluster[i]]] = -1.0;
        leader[cluster[i]] = i;
    }
    j[rows++ * BODIES + leader[0]] = 1.0; /* the ground */
    struct constraints c = constrain(rows, BODIES, j, mass, NULL);
    struct matrix z;
    require(tribo_constraints_basis(&c, BODIES, &z), "out of memory");
    ck_assert_uint_eq(c.rank, rows);
    ck_assert_uint_eq(z.cols, CLUSTERS - 1);
    for (size_t k = 0; k < z.cols; k++) {
        size_t moving = 0, which = 0;
        for (size_t i = 0; i < BODIES; i++) {
            const double x = tribo_matrix_get(&z, i, k);
            require(x == 0.0 || x == 1.0, "%g", x);
            which = x == 1.0 ? cluster[i] : which;
        }
        require(which > 0, "the one on the ground moves");
        for (size_t i = 0; i < BODIES; i++) {
            assert_exact(tribo_matrix_get(&z, i, k), cluster[i] == which ? 1.0 : 0.0);
            moving += cluster[i] == which;
        }
        require(moving > 0, "nothing moves");
    }
    tribo_matrix_free(&z);
    tribo_constraints_free(&c);
}

/* Rows of any scale in columns of any scale, with dependent ones among them: J = D1 A D2, whose rank is that of A. */
TEST(graded_rows)
{
    enum { ROWS = 9, COLS = 12 };
    struct random g = random_of(_i);
    const size_t rank = 1 + (size_t)_i % ROWS;
    double j[ROWS * COLS] = {0}, base[ROWS * COLS], mass[COLS];
    const unsigned char last[ROWS] = {0};
    for (size_t k = 0; k < rank * COLS; k++) {
        base[k] = (double)below(&g, 7) - 3.0;
    }
    for (size_t i = 0; i < ROWS; i++) {
        for (size_t r = 0; r < rank; r++) {
            const double x = i < rank ? (double)(i == r) : (double)below(&g, 5) - 2.0;
            for (size_t k = 0; k < COLS; k++) {
                j[i * COLS + k] += x * base[r * COLS + k];
            }
        }
    }
    double to[COLS];
    for (size_t k = 0; k < COLS; k++) {
        to[k] = log_uniform(&g, 10.0);
        mass[k] = log_uniform(&g, 6.0);
    }
    for (size_t i = 0; i < ROWS; i++) {
        const double scale = log_uniform(&g, 10.0);
        for (size_t k = 0; k < COLS; k++) {
            j[i * COLS + k] *= scale * to[k];
        }
    }
    struct constraints c = constrain(ROWS, COLS, j, mass, last);
    ck_assert_uint_eq(c.rank, rank);
    tribo_constraints_free(&c);
}

/* Forces come back from what they do, and displacements do what is asked of them. */
TEST(forces_and_displacements)
{
    enum { ROWS = 8, COLS = 14 };
    struct random g = random_of(_i);
    double j[ROWS * COLS], mass[COLS], want[ROWS], f[ROWS], force[COLS] = {0}, q[COLS] = {0};
    for (size_t k = 0; k < ROWS * COLS; k++) {
        j[k] = below(&g, 3) ? 0.0 : uniform(&g, -1.0, 1.0);
    }
    for (size_t i = 0; i < ROWS; i++) {
        j[i * COLS + i] += 2.0;
        want[i] = uniform(&g, -1.0, 1.0);
        for (size_t k = 0; k < COLS; k++) {
            force[k] += j[i * COLS + k] * want[i];
        }
    }
    for (size_t k = 0; k < COLS; k++) {
        mass[k] = log_uniform(&g, 3.0);
    }
    struct constraints c = constrain(ROWS, COLS, j, mass, NULL);
    struct matrix z;
    require(tribo_constraints_basis(&c, COLS, &z), "out of memory");
    ck_assert_uint_eq(c.rank, ROWS);
    tribo_constraints_react(&c, (const size_t[]){0, COLS}, 1, force, f);
    assert_all_close(f, want, ROWS, 1e-12);
    tribo_constraints_follow(&c, want, q);
    for (size_t i = 0; i < ROWS; i++) {
        double sum = 0.0;
        for (size_t k = 0; k < COLS; k++) {
            sum += j[i * COLS + k] * q[k];
        }
        assert_close(sum, want[i], 1e-12);
        for (size_t m = 0; m < z.cols; m++) {
            double left = 0.0, size = 0.0;
            for (size_t k = 0; k < COLS; k++) {
                left += j[i * COLS + k] * tribo_matrix_get(&z, k, m);
                size += fabs(j[i * COLS + k] * tribo_matrix_get(&z, k, m));
            }
            assert_close(left, 0.0, 1e-13 * size);
        }
    }
    tribo_matrix_free(&z);
    tribo_constraints_free(&c);
}

/* Nearly the same contact twice: to half the digits it is the same, where some may be left out. */
TEST(nearly_dependent)
{
    const double j[] = {1.0, 1.0, 1.0, 1.0 + pow(10.0, -_i)}, mass[] = {1.0, 1.0};
    const unsigned char last[2] = {0};
    struct constraints some = constrain(2, 2, j, mass, last), all = constrain(2, 2, j, mass, NULL);
    ck_assert_uint_eq(some.rank, _i < 7 ? 2 : 1);
    ck_assert_uint_eq(all.rank, _i < 15 ? 2 : 1);
    tribo_constraints_free(&some);
    tribo_constraints_free(&all);
}

/* A contact that touches nothing depends on the others, if there are any. */
TEST(touches_nothing)
{
    const double j[] = {0.0, 0.0, 0.0, 2.0, 1.0, 0.0}, mass[] = {1.0, 1.0};
    struct constraints c = constrain(3, 2, j, mass, NULL), none = constrain(0, 2, j, mass, NULL);
    ck_assert_uint_eq(c.rank, 2);
    ck_assert_uint_eq(c.order[2], 0);
    ck_assert_uint_eq(none.rank, 0);
    tribo_constraints_free(&c);
    tribo_constraints_free(&none);
}

/* ------------------------------------------------------------------------------------------------------- normal modes */

/* K = D B D with a well-conditioned B has eigenvalues as far apart as the scales are; their product is known, and each of them
 * from the one side: Rayleigh quotients of the modes found, which are orthonormal, and have nothing of each other. */
TEST(graded_stiffness)
{
    enum { N = 10 };
    struct random g = random_of(_i);
    double k[N * N] = {0}, omega2[N], phi[N * N], product = 1.0;
    const struct matrix whole = {0};
    const struct cholesky unit = {0};
    const struct modes_text text = {NULL, "", ""};
    for (size_t i = 0; i < N; i++) {
        const double scale = pow(10.0, uniform(&g, -7.0, 7.0));
        /* tridiagonal (2, -1): determinant N + 1 */
        k[i * N + i] = scale;
        product *= scale * scale;
    }
    for (size_t i = 0; i < N; i++) {
        const double own = k[i * N + i];
        for (size_t p = i; p < N; p++) {
            const double other = k[p * N + p];
            if (p > i) {
                k[i * N + p] = k[p * N + i] = p == i + 1 ? -own * other : 0.0;
            }
        }
    }
    for (size_t i = 0; i < N; i++) {
        k[i * N + i] *= 2.0 * k[i * N + i];
    }
    struct matrix a = dense(N, N, k);
    assert_ok(tribo_normal_modes(&a, NULL, &whole, &unit, N, omega2, phi, &text));
    for (size_t i = 0; i < N; i++) {
        product /= omega2[i];
        require(omega2[i] > 0.0 && (i == 0 || omega2[i] >= omega2[i - 1]), "%g after %g", omega2[i], omega2[i ? i - 1 : 0]);
    }
    assert_close(product * (N + 1.0), 1.0, 1e-11);
    for (size_t p = 0; p < N; p++) {
        for (size_t q = 0; q <= p; q++) {
            double force[N] = {0};
            tribo_matrix_multiply_add(&a, 1.0, phi + q * N, force);
            assert_close(tribo_dot(phi + p * N, phi + q * N, N), p == q ? 1.0 : 0.0, 1e-13);
            assert_close(tribo_dot(phi + p * N, force, N), p == q ? omega2[p] : 0.0, 1e-9 * sqrt(omega2[p] * omega2[q]));
        }
    }
    tribo_matrix_free(&a);
}

/* A stiffness that pushes: omega^2 < 0, however small beside the others. */
TEST(negative_stiffness)
{
    const double k[] = {1e15, 0.0, 0.0, 0.0, -2.0, 1.0, 0.0, 1.0, 1e7}, low = -2.0 - 1.0 / (1e7 + 2.0);
    double omega2[3], phi[9];
    const struct matrix whole = {0};
    const struct cholesky unit = {0};
    const struct modes_text text = {NULL, "", ""};
    struct matrix a = dense(3, 3, k);
    assert_ok(tribo_normal_modes(&a, NULL, &whole, &unit, 3, omega2, phi, &text));
    assert_close(omega2[0], low, 1e-14);
    assert_close(omega2[1] / 1e7, 1.0, 1e-13);
    assert_close(omega2[2] / 1e15, 1.0, 1e-15);
    tribo_matrix_free(&a);
}

TEST(overflowing_stiffness)
{
    const double k[] = {1e200, 0.0, 0.0, 1.0}, m[] = {1e-200, 1.0};
    double omega2[2], phi[4], pivot;
    size_t where;
    const struct matrix whole = {0};
    struct cholesky c;
    const struct modes_text text = {NULL, "", ""};
    struct matrix a = dense(2, 2, k), mass = diagonal(2, m);
    assert_ok(tribo_cholesky_create(&c, &mass, NULL, &where, &pivot));
    assert_status(tribo_normal_modes(&a, NULL, &whole, &c, 2, omega2, phi, &text), TRIBO_ERR_NOT_FINITE);
    tribo_cholesky_free(&c);
    tribo_matrix_free(&mass);
    tribo_matrix_free(&a);
}

/* ------------------------------------------------------------------------------------------------ small symmetric matrices */

enum { GRADED, EQUAL, NEARLY_EQUAL, SINGULAR, ZERO, KINDS };

/* a [2][2], without negative eigenvalues. */
static void pair_of_kind(int kind, struct random *g, double *a)
{
    const double scale = pow(10.0, uniform(g, -12.0, 12.0)), share = uniform(g, -0.9, 0.9);
    a[0] = kind == ZERO ? 0.0 : kind == GRADED ? pow(10.0, uniform(g, -12.0, 12.0)) : scale;
    a[3] = kind == NEARLY_EQUAL ? a[0] * (1.0 + pow(10.0, uniform(g, -16.0, -8.0))) : kind == ZERO ? 0.0 : scale;
    a[1] = a[2] = kind == GRADED         ? share * sqrt(a[0]) * sqrt(a[3])
                  : kind == NEARLY_EQUAL ? a[0] * share * pow(10.0, uniform(g, -16.0, 0.0))
                  : kind == SINGULAR     ? copysign(a[0], share)
                                         : 0.0;
}

/* Eigenvalues of pairs are known to rounding of themselves, but for one that is zero; vectors are orthonormal to rounding. */
TEST(pairs)
{
    struct random g = random_of(_i);
    double a[4], value[2], x[4];
    const int kind = _i % KINDS;
    pair_of_kind(kind, &g, a);
    memcpy(x, a, sizeof a);
    assert_ok(tribo_symmetric_eigen(x, 2, value));
    const long double half = 0.5L * ((long double)a[0] - a[3]), middle = 0.5L * ((long double)a[0] + a[3]);
    const double high = (double)(middle + hypotl(half, a[1]));
    const double low = high > 0.0 ? (double)(((long double)a[0] * a[3] - (long double)a[1] * a[1]) / high) : 0.0;
    require(value[0] <= value[1], "%g before %g", value[0], value[1]);
    require(fabs(value[1] - high) <= 8.0 * DBL_EPSILON * high, "%.17g, not %.17g", value[1], high);
    require(fabs(value[0] - low) <= 40.0 * DBL_EPSILON * (kind == SINGULAR ? high : low), "%.17g, not %.17g", value[0], low);
    assert_close(x[0] * x[0] + x[1] * x[1], 1.0, 4.0 * DBL_EPSILON);
    assert_close(x[2] * x[2] + x[3] * x[3], 1.0, 4.0 * DBL_EPSILON);
    assert_close(x[0] * x[2] + x[1] * x[3], 0.0, 4.0 * DBL_EPSILON);
    for (size_t k = 0; k < 2; k++) {
        for (size_t i = 0; i < 2; i++) {
            const double off = a[2 * i] * x[2 * k] + a[2 * i + 1] * x[2 * k + 1] - value[k] * x[2 * k + i];
            require(fabs(off) <= 8.0 * DBL_EPSILON * high, "mode %zu: %g beside %g", k, off, high);
        }
    }
}

TEST(one_alone)
{
    double x = -3.5, value;
    assert_ok(tribo_symmetric_eigen(&x, 1, &value));
    assert_exact(value, -3.5);
    assert_exact(x, 1.0);
}

/* ------------------------------------------------------------------------------------------------- general eigenvalues */

/* Largest |A x - lambda x| beside the largest entry of A. */
static double eigen_residual(const double *a, size_t n)
{
    double t[MOST * MOST], re[MOST], im[MOST], x[MOST * MOST], most = 0.0, worst = 0.0;
    memcpy(t, a, n * n * sizeof *t);
    assert_ok(tribo_eigen(t, n, re, im, x));
    for (size_t k = 0; k < n * n; k++) {
        most = fmax(most, fabs(a[k]));
    }
    for (size_t k = 0; k < n; k++) {
        const double *v = x + k * n, *w = im[k] > 0.0 ? v + n : v;
        double square = 0.0, length = 0.0;
        require(im[k] >= 0.0 || (k > 0 && im[k] == -im[k - 1] && re[k] == re[k - 1]), "no pair");
        for (size_t i = 0; im[k] >= 0.0 && i < n; i++) {
            double r = -re[k] * v[i] + im[k] * w[i], s = im[k] > 0.0 ? -re[k] * w[i] - im[k] * v[i] : 0.0;
            for (size_t p = 0; p < n; p++) {
                r += a[i * n + p] * v[p];
                s += im[k] > 0.0 ? a[i * n + p] * w[p] : 0.0;
            }
            square += r * r + s * s;
            length += v[i] * v[i] + (im[k] > 0.0 ? w[i] * w[i] : 0.0);
        }
        assert_close(length, im[k] >= 0.0 ? 1.0 : 0.0, 1e-13);
        worst = fmax(worst, sqrt(square));
    }
    return most > 0.0 ? worst / most : worst;
}

TEST(random_eigenvalues)
{
    struct random g = random_of(_i);
    double a[MOST * MOST];
    const size_t n = 1 + (size_t)_i % MOST;
    for (size_t k = 0; k < n * n; k++) {
        a[k] = below(&g, 3) ? uniform(&g, -1.0, 1.0) : (double)below(&g, 3) - 1.0;
    }
    const double off = eigen_residual(a, n);
    require(off < 1e-15 * (double)(20 + 5 * n), "n = %zu: %g", n, off);
}

/* Permutations in a circle keep the plain algorithm turning for good; their eigenvalues are the roots of unity. */
TEST(circles)
{
    double a[MOST * MOST] = {0}, re[MOST], im[MOST], x[MOST * MOST];
    const size_t n = 2 + (size_t)_i;
    for (size_t i = 0; i < n; i++) {
        a[i * n + (i + 1) % n] = 1.0;
    }
    assert_ok(tribo_eigen(a, n, re, im, x));
    for (size_t k = 0; k < n; k++) {
        const double turns = atan2(im[k], re[k]) / (2.0 * PI) * (double)n;
        assert_close(hypot(re[k], im[k]), 1.0, 1e-13);
        assert_close(turns, round(turns), 1e-12);
    }
}

TEST(eigenvalues_of_what_is_none)
{
    double a[9] = {1.0, 2.0, 3.0, 4.0, NAN, 6.0, 7.0, 8.0, 9.0}, re[3], im[3], x[9];
    assert_status(tribo_eigen(a, 3, re, im, x), TRIBO_ERR_NOT_FINITE);
    a[4] = HUGE_VAL;
    assert_status(tribo_eigen(a, 3, re, im, x), TRIBO_ERR_NOT_FINITE);
    assert_ok(tribo_eigen(a, 0, re, im, x));
}

/* ---------------------------------------------------------------------------------------------------- linear equations */

/* A = L L' with rows of any size: its factor solves; and less a part of one row's pivot, that row is the one that is not
 * definite. */
TEST(definite_factor)
{
    enum { N = 30 };
    struct random g = random_of(_i);
    double l[N][N] = {{0}}, a[N * N], x[N], rest[N], pivot;
    size_t where;
    struct cholesky c;
    for (size_t i = 0; i < N; i++) {
        for (size_t j = 0; j <= i; j++) {
            l[i][j] = i == j ? 1.0 : uniform(&g, -0.5, 0.5);
        }
    }
    for (size_t i = 0; i < N * N; i++) {
        a[i] = 0.0;
        for (size_t k = 0; k < N; k++) {
            a[i] += l[i / N][k] * l[i % N][k];
        }
    }
    struct matrix m = dense(N, N, a);
    for (size_t i = 0; i < N; i++) {
        x[i] = rest[i] = uniform(&g, -1.0, 1.0);
    }
    assert_ok(tribo_cholesky_create(&c, &m, NULL, &where, &pivot));
    ck_assert(tribo_cholesky_solve(&c, 1, x));
    for (size_t i = 0; i < N; i++) {
        for (size_t k = 0; k < N; k++) {
            rest[i] -= a[i * N + k] * x[k];
        }
        assert_close(rest[i], 0.0, 1e-11);
    }
    tribo_cholesky_free(&c);
    tribo_matrix_free(&m);
    const size_t bad = below(&g, N);
    a[bad * N + bad] = -1e-3;
    m = dense(N, N, a);
    assert_status(tribo_cholesky_create(&c, &m, NULL, &where, &pivot), TRIBO_ERR_INDEFINITE);
    ck_assert_uint_eq(where, bad);
    require(pivot < 0.0, "pivot %g", pivot);
    tribo_matrix_free(&m);
}

TEST(equations)
{
    enum { N = 12, COLS = 3 };
    struct random g = random_of(_i);
    double a[N * N], lu[N * N], want[N * COLS], x[N * COLS] = {0};
    int pivot[N];
    for (size_t k = 0; k < N * N; k++) {
        a[k] = lu[k] = uniform(&g, -1.0, 1.0);
    }
    for (size_t k = 0; k < N * COLS; k++) {
        want[k] = uniform(&g, -1.0, 1.0);
    }
    for (size_t i = 0; i < N; i++) {
        for (size_t k = 0; k < N; k++) {
            for (size_t c = 0; c < COLS; c++) {
                x[i * COLS + c] += a[i * N + k] * want[k * COLS + c];
            }
        }
    }
    require(tribo_lu_create(lu, N, pivot) > 0.0, "singular");
    tribo_lu_solve(lu, N, pivot, x, COLS);
    assert_all_close(x, want, N * COLS, 1e-10);
    /* two equal rows */
    memcpy(a + N, a, N * sizeof *a);
    require(tribo_lu_create(a, N, pivot) < 1e-14, "not singular");
    a[0] = NAN;
    assert_exact(tribo_lu_create(a, N, pivot), 0.0);
}

/* ------------------------------------------------------------------------------------------------------ Krylov spaces */

enum { SPACE = 12 };

static int multiply_by(void *data, double *x)
{
    const double *a = data;
    double y[SPACE] = {0.0};
    for (size_t i = 0; i < SPACE; i++) {
        for (size_t k = 0; k < SPACE; k++) {
            y[i] += a[i * SPACE + k] * x[k];
        }
    }
    memcpy(x, y, sizeof y);
    return TRIBO_OK;
}

/* Loop test: up to _i % 4 dimensions of I - (a map that brings nothing further apart) are zero; of the solutions the least is
 * found. A space that is too small leaves what it says. */
TEST(krylov)
{
    struct random g = random_of(_i);
    const size_t zeros = (size_t)(_i % 4);
    double a[SPACE * SPACE] = {0.0}, want[SPACE], x[SPACE], b[SPACE], part, work[(SPACE + 1) * (2 * SPACE + 4)];
    for (size_t i = 0; i < SPACE; i++) {
        a[i * SPACE + i] = i < zeros ? 0.0 : 1.0;
        want[i] = i < zeros ? 0.0 : uniform(&g, -1.0, 1.0);
        for (size_t k = zeros; i >= zeros && k < SPACE; k++) {
            a[i * SPACE + k] -= uniform(&g, -0.5, 0.5) / sqrt((double)SPACE);
        }
    }
    memcpy(x, want, sizeof x);
    multiply_by(a, x);
    memcpy(b, x, sizeof b);
    ck_assert_uint_le(tribo_gmres_room(SPACE, SPACE), sizeof work / sizeof *work);
    assert_ok(tribo_gmres(SPACE, multiply_by, a, 1e-13, SPACE, x, &part, work));
    assert_close(part, 0.0, 1e-13);
    assert_all_close(x, want, SPACE, 1e-11);
    memcpy(x, b, sizeof x);
    assert_ok(tribo_gmres(SPACE, multiply_by, a, 1e-13, 2, x, &part, work));
    multiply_by(a, x);
    double left = 0.0, size = 0.0;
    for (size_t i = 0; i < SPACE; i++) {
        left += (b[i] - x[i]) * (b[i] - x[i]);
        size += b[i] * b[i];
    }
    ck_assert(part > 1e-3);
    assert_close(sqrt(left / size), part, 1e-13);
}

/* ------------------------------------------------------------------------------------------------------- least norm */

/* A = B (I - V V') has the kernel V. The solution has no part in V, and its residual none in the range of A. */
TEST(shortest)
{
    struct random g = random_of(_i);
    const size_t zeros = (size_t)(_i % 5);
    double a[SPACE * SPACE], b[SPACE * SPACE], v[SPACE * SPACE], value[SPACE], x[SPACE], y[SPACE], left[SPACE];
    size_t kernel;
    for (size_t i = 0; i < SPACE; i++) {
        x[i] = y[i] = uniform(&g, -1.0, 1.0);
        for (size_t k = 0; k < SPACE; k++) {
            b[i * SPACE + k] = uniform(&g, -1.0, 1.0);
            v[i * SPACE + k] = v[k * SPACE + i] = uniform(&g, -1.0, 1.0);
        }
    }
    assert_ok(tribo_symmetric_eigen(v, SPACE, value));
    memcpy(a, b, sizeof a);
    for (size_t i = 0; i < SPACE; i++) {
        for (size_t j = 0; j < zeros; j++) {
            double part = 0.0;
            for (size_t k = 0; k < SPACE; k++) {
                part += b[i * SPACE + k] * v[j * SPACE + k];
            }
            for (size_t k = 0; k < SPACE; k++) {
                a[i * SPACE + k] -= part * v[j * SPACE + k];
            }
        }
    }
    memcpy(b, a, sizeof b);
    require(tribo_least_norm_solve(b, SPACE, 1e-9, y, &kernel), "out of memory");
    ck_assert_uint_eq(kernel, zeros);
    for (size_t j = 0; j < zeros; j++) {
        double part = 0.0;
        for (size_t k = 0; k < SPACE; k++) {
            part += v[j * SPACE + k] * y[k];
        }
        assert_close(part, 0.0, 1e-12 * (1.0 + tribo_largest(y, SPACE)));
    }
    for (size_t i = 0; i < SPACE; i++) {
        left[i] = tribo_dot(a + i * SPACE, y, SPACE) - x[i];
    }
    for (size_t k = 0; k < SPACE; k++) {
        double part = 0.0;
        for (size_t i = 0; i < SPACE; i++) {
            part += a[i * SPACE + k] * left[i];
        }
        assert_close(part, 0.0, 1e-12 * (1.0 + tribo_largest(y, SPACE)));
    }
    a[0] = INFINITY;
    require(tribo_least_norm_solve(a, SPACE, 1e-9, y, NULL), "out of memory");
    ck_assert(isnan(y[0]));
}

TEST_MAIN("linalg", {light_between, 31}, {light_follows, 1}, {piles, 20}, {clusters, 20}, {graded_rows, 45},
          {forces_and_displacements, 20}, {nearly_dependent, 17}, {touches_nothing, 1}, {graded_stiffness, 20}, {pairs, 400},
          {one_alone, 1}, {negative_stiffness, 1}, {overflowing_stiffness, 1}, {random_eigenvalues, 120}, {circles, 20},
          {eigenvalues_of_what_is_none, 1}, {equations, 10}, {definite_factor, 50}, {krylov, 20}, {shortest, 50})
