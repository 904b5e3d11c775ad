/* SPDX-License-Identifier: BSD-3-Clause */
/* How many eigenvalues are negative, from sparse factors, and how far rounding grows in them, of matrices where both are
 * known. */
#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/linalg.h"
#include "support.h"

/* a is freed: early, if there is a factor like it. */
static struct inertia inertia_of(struct matrix *a, const struct sparse_factor *like)
{
    struct inertia found = {0, 0.0};
    double *size = malloc(a->rows * sizeof *size);
    for (size_t i = 0; i < a->rows; i++) {
        size[i] = tribo_matrix_get(a, i, i);
    }
    assert_ok(tribo_cholmod->inertia(like, a, like ? a : NULL, size, &found));
    free(size);
    tribo_matrix_free(a);
    return found;
}

/* Entries are freed. */
static struct matrix dense(size_t n, double *entries)
{
    struct matrix a;
    require(tribo_matrix_from_dense(&a, n, n, entries), "out of memory");
    free(entries);
    return a;
}

/* --------------------------------------------------------------------------------------------------------------- known ones */

/* 4 less neighbours on a grid: eigenvalues are sums of sines. */
static double *grid(size_t rows, size_t cols, double shift)
{
    const size_t n = rows * cols;
    double *a = calloc(n * n, sizeof *a);
    for (size_t i = 0; i < n; i++) {
        a[i * n + i] = 4.0 - shift;
        if (i % cols + 1 < cols) {
            a[i * n + i + 1] = a[(i + 1) * n + i] = -1.0;
        }
        if (i + cols < n) {
            a[i * n + i + cols] = a[(i + cols) * n + i] = -1.0;
        }
    }
    return a;
}

static size_t count_of_grid(size_t rows, size_t cols, double shift)
{
    size_t count = 0;
    for (size_t p = 1; p <= rows; p++) {
        for (size_t q = 1; q <= cols; q++) {
            const double x = sin(0.5 * PI * (double)p / (double)(rows + 1)), y = sin(0.5 * PI * (double)q / (double)(cols + 1));
            count += 4.0 * x * x + 4.0 * y * y < shift;
        }
    }
    return count;
}

/* Shifts from none to all below, also with the order of a definite factor. */
TEST(grids)
{
    static const size_t rows[] = {1, 3, 9, 25}, cols[] = {7, 50, 41, 26};
    const size_t r = rows[_i], c = cols[_i];
    const double shift[] = {-0.3, 0.05, 0.51, 1.23, 3.21, 6.7, 8.2};
    struct matrix definite = dense(r * c, grid(r, c, -1.0));
    struct sparse_factor *like;
    size_t where;
    if (!tribo_cholmod) {
        return;
    }
    assert_ok(tribo_cholmod->create(&like, &definite, &definite, &where));
    for (size_t k = 0; k < COUNT(shift); k++) {
        struct matrix a = dense(r * c, grid(r, c, shift[k])), b = dense(r * c, grid(r, c, shift[k]));
        const struct inertia alone = inertia_of(&a, NULL), with = inertia_of(&b, like);
        ck_assert_uint_eq(alone.negative, count_of_grid(r, c, shift[k]));
        ck_assert_uint_eq(with.negative, alone.negative);
        assert_exact(with.growth, alone.growth);
        require(alone.growth >= 1.0, "growth %g", alone.growth);
    }
    tribo_cholmod->destroy(like);
    tribo_matrix_free(&definite);
}

/* A = Q'SQ with signs S is full. */
static double *signed_products(size_t n, size_t negative, int seed)
{
    struct random g = random_of(seed);
    double *a = calloc(n * n, sizeof *a), *q = malloc(n * n * sizeof *q);
    for (size_t k = 0; k < n * n; k++) {
        q[k] = uniform(&g, -1.0, 1.0) + (k % (n + 1) == 0 ? sqrt((double)n) : 0.0);
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            for (size_t k = 0; k < n; k++) {
                a[i * n + j] += (k < negative ? -1.0 : 1.0) * q[k * n + i] * q[k * n + j];
            }
        }
    }
    free(q);
    return a;
}

TEST(full)
{
    static const size_t size[] = {1, 2, 3, 7, 8, 47, 48, 49, 53, 96, 97, 150};
    const size_t n = size[_i];
    if (!tribo_cholmod) {
        return;
    }
    for (size_t negative = 0; negative <= n; negative += negative < 3 || n < 50 ? 1 : 11) {
        struct matrix a = dense(n, signed_products(n, negative, (int)n));
        ck_assert_uint_eq(inertia_of(&a, NULL).negative, negative);
    }
}

/* The squares of a definite factor's row add up to the diagonal: nothing grows, in any order. */
TEST(definite)
{
    static const size_t size[] = {1, 5, 60, 131};
    if (tribo_cholmod) {
        struct matrix a = dense(size[_i], signed_products(size[_i], 0, _i)), b = dense(20 * 31, grid(20, 31, 0.0));
        assert_close(inertia_of(&a, NULL).growth, 1.0, 1e-12);
        assert_close(inertia_of(&b, NULL).growth, 1.0, 1e-12);
    }
}

/* (e 1; 1 e) = (1; 1/e 1) (e; e - 1/e) (1 1/e; 1), in either order. */
TEST(growth)
{
    const double e = pow(10.0, -_i - 1);
    const double entries[] = {e, 1.0, 1.0, e}, size[] = {1.0, 1.0};
    struct inertia found;
    struct matrix a;
    require(tribo_matrix_from_dense(&a, 2, 2, entries), "out of memory");
    if (tribo_cholmod) {
        assert_ok(tribo_cholmod->inertia(NULL, &a, NULL, size, &found));
        ck_assert_uint_eq(found.negative, 1);
        assert_close(found.growth, 2.0 / e - e, 1e-12 * found.growth);
    }
    tribo_matrix_free(&a);
}

/* ------------------------------------------------------------------------------------------------------------ sparse ones */

/* Few entries anywhere, and columns without neighbours. */
TEST(random_places)
{
    enum { N = 160 };
    struct random g = random_of(_i);
    double *a = calloc(N * N, sizeof *a), *copy = malloc(N * N * sizeof *copy);
    double value[N];
    size_t negative = 0;
    for (size_t k = 0; k < (size_t)(20 * (_i % 20)); k++) {
        const size_t i = (size_t)uniform(&g, 0.0, N), j = (size_t)uniform(&g, 0.0, N);
        a[i * N + j] = a[j * N + i] = uniform(&g, -1.0, 1.0);
    }
    for (size_t i = 0; i < N; i++) {
        a[i * N + i] += uniform(&g, -2.0, 2.0);
    }
    memcpy(copy, a, N * N * sizeof *copy);
    assert_ok(tribo_symmetric_eigen(copy, N, value));
    while (negative < N && value[negative] < 0.0) {
        negative++;
    }
    struct matrix sparse = dense(N, a);
    if (tribo_cholmod) {
        ck_assert_uint_eq(inertia_of(&sparse, NULL).negative, negative);
    } else {
        tribo_matrix_free(&sparse);
    }
    free(copy);
}

/* ---------------------------------------------------------------------------------------------------------------- refused */

TEST(no_pivot)
{
    const double entries[][4] = {{0.0, 1.0, 1.0, 0.0},
                                 {1.0, 1.0, 1.0, 1.0},
                                 {0.0, 0.0, 0.0, 0.0},
                                 {NAN, 1.0, 1.0, NAN},
                                 {DBL_MAX, DBL_MAX, DBL_MAX, -DBL_MAX}};
    const double size[] = {1.0, 1.0};
    struct inertia found = {7, 7.0};
    struct matrix a;
    require(tribo_matrix_from_dense(&a, 2, 2, entries[_i]), "out of memory");
    if (tribo_cholmod) {
        assert_status(tribo_cholmod->inertia(NULL, &a, NULL, size, &found), TRIBO_ERR_INDEFINITE);
    }
    ck_assert_uint_eq(found.negative, 7);
    tribo_matrix_free(&a);
}

TEST_MAIN("inertia", {grids, 4}, {full, 12}, {definite, 4}, {growth, 6}, {random_places, 60}, {no_pivot, 5})
