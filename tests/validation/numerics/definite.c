/* SPDX-License-Identifier: BSD-3-Clause */
/* Definite matrices: solutions for sets of rows, by what makes them solutions. */
#include "numerics/definite.h"
#include "support.h"

#include <math.h>
#include <string.h>

#define MOST 12

/* A = B B' + a little, with rows of zeros; graded: rows of sizes from 1e-4 to 1e4. */
static size_t random_matrix(struct random *r, double *a)
{
    const size_t n = 1 + below(r, MOST), rank = 1 + below(r, n);
    double b[MOST][MOST], scale[MOST];
    for (size_t i = 0; i < n; i++) {
        scale[i] = below(r, 4) == 0 ? 0.0 : pow(10.0, uniform(r, -4.0, 4.0));
        for (size_t k = 0; k < rank; k++) {
            b[i][k] = uniform(r, -1.0, 1.0);
        }
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < n; k++) {
            a[i * n + k] = i == k ? 0.05 : 0.0;
            for (size_t j = 0; j < rank; j++) {
                a[i * n + k] += b[i][j] * b[k][j];
            }
            a[i * n + k] *= scale[i] * scale[k];
        }
    }
    return n;
}

/* What of row i is left of A f + q, in parts of its terms. */
static double left(size_t n, const double *a, size_t i, const double *q, const double *f)
{
    double sum = q[i], size = fabs(q[i]);
    for (size_t k = 0; k < n; k++) {
        sum += a[i * n + k] * f[k];
        size += fabs(a[i * n + k] * f[k]);
    }
    return size > 0.0 ? sum / size : 0.0;
}

/* Creates d from a [n][n]; if diagonal, makes a diagonal first. */
static void create(struct definite *d, size_t n, int diagonal, double *a)
{
    double own[MOST];
    size_t where;
    for (size_t i = 0; i < n; i++) {
        own[i] = a[i * n + i];
        for (size_t k = 0; diagonal && k < n; k++) {
            a[i * n + k] = i == k ? own[i] : 0.0;
        }
    }
    assert_ok(tribo_definite_create(d, n, own, diagonal ? NULL : a, &where));
}

TEST(sets)
{
    struct random r = random_of(_i);
    struct definite d;
    double a[MOST * MOST], q[MOST], x[MOST];
    signed char skip[MOST];
    const size_t n = random_matrix(&r, a);
    create(&d, n, _i % 4 == 0, a);
    for (int round = 0; round < 20; round++) {
        for (size_t i = 0; i < n; i++) {
            q[i] = uniform(&r, -1.0, 1.0);
            x[i] = -q[i];
            skip[i] = (signed char)(round == 0 || round % 3 ? (int)below(&r, 3) - 1 : skip[i]);
        }
        tribo_definite_solve(&d, round ? skip : NULL, 1, x);
        for (size_t i = 0; i < n; i++) {
            const int in = a[i * n + i] > 0.0 && (!round || skip[i] == 0);
            assert_close(in ? left(n, a, i, q, x) : x[i], 0.0, 1e-11);
        }
    }
    tribo_definite_free(&d);
}

TEST(refused)
{
    struct definite d;
    const double singular[9] = {1.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 4.0};
    const double own[3] = {1.0, 0.0, 4.0};
    size_t where = 7;
    assert_status(tribo_definite_create(&d, 3, own, singular, &where), TRIBO_ERR_INDEFINITE);
    ck_assert_uint_eq(where, 2);
    tribo_definite_free(&d);
}

TEST_MAIN("definite", {sets, 200}, {refused, 1})
