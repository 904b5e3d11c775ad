/* SPDX-License-Identifier: BSD-3-Clause */
/* Compliance of contacts: forces of sets of contacts, by what makes them solutions. */
#include "dynamics/system/system.h"
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

/* Returns a system of one body and n contacts with the compliance a [n][n], and the status of that in *status; if diagonal, makes
 * a diagonal first. */
static tribo_system *create(size_t n, int diagonal, double *a, int *status, size_t *where)
{
    const double none[MOST] = {0.0};
    double own[MOST];
    tribo_system *sys;
    for (size_t i = 0; i < n; i++) {
        own[i] = a[i * n + i];
        for (size_t k = 0; diagonal && k < n; k++) {
            a[i * n + k] = i == k ? own[i] : 0.0;
        }
    }
    assert_ok(tribo_system_build(&sys, 1, n));
    ck_assert(tribo_matrix_diagonal(&sys->mass, 1, NULL) && tribo_matrix_diagonal(&sys->stiffness, 1, NULL) &&
              tribo_matrix_from_dense(&sys->direction, n, 1, none));
    *status = tribo_compliance_create(sys, own, diagonal ? NULL : a, where);
    return sys;
}

TEST(sets)
{
    struct random r = random_of(_i);
    double a[MOST * MOST], q[2][MOST], x[2 * MOST];
    signed char slip[MOST];
    const size_t n = random_matrix(&r, a);
    int status;
    size_t where;
    tribo_system *sys = create(n, _i % 4 == 0, a, &status, &where);
    assert_ok(status);
    for (int round = 0; round < 20; round++) {
        for (size_t i = 0; i < n; i++) {
            for (size_t k = 0; k < 2; k++) {
                q[k][i] = uniform(&r, -1.0, 1.0);
                x[2 * i + k] = -q[k][i];
            }
            slip[i] = (signed char)(round == 0 || round % 3 ? (int)below(&r, 3) - 1 : slip[i]);
        }
        tribo_compliance_solve(sys, round ? slip : NULL, 2, x);
        for (size_t k = 0; k < 2; k++) {
            double f[MOST];
            for (size_t i = 0; i < n; i++) {
                f[i] = x[2 * i + k];
            }
            for (size_t i = 0; i < n; i++) {
                const int in = a[i * n + i] > 0.0 && (!round || slip[i] == 0);
                assert_close(in ? left(n, a, i, q[k], f) : f[i], 0.0, 1e-11);
            }
        }
    }
    tribo_system_destroy(sys);
}

/* Rows of G G^-1 are those of the identity, and G is given back. */
TEST(inverse)
{
    struct random r = random_of(_i);
    double a[MOST * MOST], f[MOST], x[MOST], q[MOST];
    const size_t n = random_matrix(&r, a);
    int status;
    size_t where;
    tribo_system *sys = create(n, _i % 4 == 0, a, &status, &where);
    assert_ok(status);
    for (size_t j = 0; j < n; j++) {
        for (size_t i = 0; i < n; i++) {
            f[i] = tribo_matrix_get(&sys->compliance.inverse, i, j);
            q[i] = i == j ? -1.0 : 0.0;
            ck_assert(tribo_compliance_entry(&sys->compliance, i, j) == a[i * n + j]);
        }
        for (size_t i = 0; i < n; i++) {
            assert_close(a[i * n + i] > 0.0 && a[j * n + j] > 0.0 ? left(n, a, i, q, f) : f[i], 0.0, 1e-11);
        }
        tribo_compliance_give(sys, 1, f, x);
        assert_close(x[j], a[j * n + j] > 0.0 ? 1.0 : 0.0, 1e-6);
    }
    tribo_system_destroy(sys);
}

TEST(refused)
{
    double singular[9] = {1.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 4.0};
    size_t where = 7;
    int status;
    tribo_system *sys = create(3, 0, singular, &status, &where);
    assert_status(status, TRIBO_ERR_INDEFINITE);
    ck_assert_uint_eq(where, 2);
    tribo_system_destroy(sys);
}

TEST_MAIN("shared_compliance", {sets, 200}, {inverse, 200}, {refused, 1})
