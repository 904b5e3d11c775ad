/* SPDX-License-Identifier: BSD-3-Clause */
/* Lowest modes of structures with more degrees of freedom than dense matrices are made for, where they are known in closed form:
 * simple and repeated frequencies, rigid-body motions, masses that are zero; and what is refused. Without CHOLMOD what is small
 * enough comes out the same, and the rest is refused, too. */
#include <stdlib.h>
#include <string.h>

#include "make.h"
#include "run.h"

/* Springs and masses on a grid, each mass with those beside it; one contact, on the first mass. */
struct grid {
    size_t rows, cols, copies;
    int free;       /* or on springs to the ground all around */
    double defect;  /* a spring to the ground, or less than none, at the last mass */
    int consistent; /* mass with off-diagonal entries: M = 1 + K/12, which changes no shape */
    int holes;      /* of every second mass along a row, which must be odd in number: 1, 3, ... have none */
};

static size_t size_of(const struct grid *g)
{
    return g->rows * g->cols * g->copies;
}

static void add(gsl_spmatrix *a, size_t i, size_t j, double x)
{
    gsl_spmatrix_set(a, i, j, gsl_spmatrix_get(a, i, j) + x);
}

static void add_spring(gsl_spmatrix *k, size_t i, size_t j)
{
    add(k, i, i, 1.0);
    add(k, j, j, 1.0);
    add(k, i, j, -1.0);
    add(k, j, i, -1.0);
}

static gsl_spmatrix *stiffness_of(const struct grid *g)
{
    const size_t n = size_of(g);
    gsl_spmatrix *k = gsl_spmatrix_alloc(n, n);
    for (size_t at = 0; at < n; at++) {
        const size_t i = at / g->cols % g->rows, j = at % g->cols;
        if (j + 1 < g->cols) {
            add_spring(k, at, at + 1);
        }
        if (i + 1 < g->rows) {
            add_spring(k, at, at + g->cols);
        }
        const double outside = (i == 0) + (i + 1 == g->rows) * (g->rows > 1) + (j == 0) + (j + 1 == g->cols);
        add(k, at, at, g->free ? 0.0 : g->rows > 1 ? outside : (double)((j == 0) + (j + 1 == g->cols)));
    }
    add(k, n - 1, n - 1, g->defect);
    return k;
}

static gsl_spmatrix *mass_of(const struct grid *g, const gsl_spmatrix *k)
{
    const size_t n = size_of(g);
    gsl_spmatrix *m = gsl_spmatrix_alloc(n, n);
    for (size_t e = 0; g->consistent && e < k->nz; e++) {
        gsl_spmatrix_set(m, (size_t)k->i[e], (size_t)k->p[e], k->data[e] / 12.0);
    }
    for (size_t i = 0; i < n; i++) {
        add(m, i, i, g->holes && i % g->cols % 2 ? 0.0 : 1.0);
    }
    return m;
}

static int create(tribo_system **sys, const struct grid *g, size_t nmode, char *text, size_t size)
{
    const size_t n = size_of(g);
    gsl_spmatrix *k = stiffness_of(g), *m = mass_of(g, k), *j = gsl_spmatrix_alloc(1, n);
    gsl_spmatrix_set(j, 0, 0, 1.0);
    const int status = reduced_system(sys, m, k, j, nmode, 1, text, size);
    gsl_spmatrix_free(k);
    gsl_spmatrix_free(m);
    gsl_spmatrix_free(j);
    return status;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* omega^2 of all modes: 4 sin^2 of halves of p pi/(cols + 1), or of p pi/cols if it is free, for either direction. A defect: of
 * single masses. */
static double *known_modes(const struct grid *g)
{
    const size_t n = size_of(g);
    double *omega2 = malloc(n * sizeof *omega2);
    for (size_t at = 0; at < n; at++) {
        const double i = (double)(at / g->cols % g->rows), j = (double)(at % g->cols);
        const double rows = (double)g->rows, cols = (double)g->cols;
        const double x = g->free ? j / cols : (j + 1.0) / (cols + 1.0), y = g->free ? i / rows : (i + 1.0) / (rows + 1.0);
        const double alone = 4.0 * pow(sin(0.5 * PI * x), 2.0) + (g->rows > 1 ? 4.0 * pow(sin(0.5 * PI * y), 2.0) : 0.0);
        const double square = alone + (at == n - 1 ? g->defect : 0.0);
        omega2[at] = g->consistent ? square / (1.0 + square / 12.0) : square;
    }
    qsort(omega2, n, sizeof *omega2, compare);
    return omega2;
}

static void check_modes(const struct grid *g, size_t nmode)
{
    double omega[100], error, *want = known_modes(g);
    char text[200] = "";
    tribo_system *sys = NULL;
    const int status = create(&sys, g, nmode, text, sizeof text);
    if (status == TRIBO_ERR_UNSUPPORTED) {
        ck_assert_int_eq(tribo_dynamics_has(TRIBO_FEATURE_CHOLMOD), 0);
        assert_says(text, "build tribo with TRIBO_SPARSE=ON");
        free(want);
        return;
    }
    require(status == TRIBO_OK, "%s", text);
    assert_ok(tribo_system_get_frequencies(sys, omega));
    for (size_t k = 0; k < nmode; k++) {
        require(fabs(omega[k] * omega[k] - want[k]) <= 1e-11 * want[k], "mode %zu: omega^2 = %.15g, not %.15g", k,
                omega[k] * omega[k], want[k]);
    }
    require(!g->free || omega[0] == 0.0, "omega = %g of a rigid body", omega[0]);
    if (want[nmode] - want[nmode - 1] <= 1e-9 * want[nmode]) { /* a mode that slow is left out: no bound holds beyond */
        assert_ok(tribo_system_get_truncation(sys, 1.001 * omega[nmode - 1], &error));
        require(error == HUGE_VAL, "a bound of %g", error);
    }
    tribo_system_destroy(sys);
    free(want);
}

/* Squares, of which most frequencies come twice; and the cut may go through a pair. */
TEST(squares)
{
    const size_t wanted[] = {1, 2, 3, 7, 20, 60};
    const struct grid g = {20, 20, 1, .free = _i % 2, .consistent = _i / 2 % 2};
    check_modes(&g, wanted[_i / 4]);
}

/* Chains that are alike and hold nothing of each other: every frequency as often as there are chains. */
TEST(alike)
{
    const size_t copies[] = {2, 5, 6, 7, 13, 30};
    const struct grid g = {1, 400 / copies[_i / 4] + 1, copies[_i / 4], .free = _i % 2, .consistent = _i / 2 % 2};
    check_modes(&g, copies[_i / 4] + 3);
}

/* Single masses and pairs, each frequency more often than there is room for in the search, one of them apart or none. */
TEST(more_than_room)
{
    const struct {
        size_t cols, copies, nmode;
        double defect;
    } cases[] = {{1, 400, 20, 0.0},   {1, 400, 1, 0.0},    {1, 400, 50, 0.0},  {2, 600, 20, 0.0},
                 {3, 1200, 7, 0.0},   {1, 4000, 30, 0.0},  {1, 600, 20, -0.5}, {1, 600, 1, -0.5},
                 {1, 600, 20, -1e-3}, {1, 600, 20, -1e-4}, {1, 600, 20, 0.5}};
    const struct grid g = {
        1, cases[_i / 4].cols, cases[_i / 4].copies, .free = _i % 2, .consistent = _i / 2 % 2, .defect = cases[_i / 4].defect};
    if (!g.free || g.defect >= 0.0) {
        check_modes(&g, cases[_i / 4].nmode);
    }
}

/* 3001 masses in a chain, and a square of 3600: more than dense matrices are made for. */
TEST(large)
{
    const struct grid g = {_i % 2 ? 60 : 1, _i % 2 ? 60 : 3001, 1, .free = _i / 2, .consistent = 1};
    char text[200] = "";
    tribo_system *sys = NULL;
    if (create(&sys, &g, 1, text, sizeof text) == TRIBO_ERR_UNSUPPORTED) {
        assert_says(text, "build tribo with TRIBO_SPARSE=ON");
        return;
    }
    tribo_system_destroy(sys);
    check_modes(&g, 12);
}

/* A chain of which every second mass is none: springs are in series there, and a mass is at every end. */
TEST(holes)
{
    const size_t cols = _i ? 401 : 21, nmode = 5, masses = cols / 2 + 1;
    const struct grid g = {1, cols, 1, .free = 1, .holes = 1};
    double omega[100]; /* of all degrees of freedom of sys */
    char text[200] = "";
    tribo_system *sys = NULL;
    const int status = create(&sys, &g, nmode, text, sizeof text);
    if (status == TRIBO_ERR_INDEFINITE) {
        assert_says(text, "mass is not positive definite: pivot 0"); /* without CHOLMOD */
        return;
    }
    require(status == TRIBO_OK, "%s", text);
    assert_ok(tribo_system_get_frequencies(sys, omega));
    for (size_t k = 0; k < nmode; k++) {
        const double want = sqrt(2.0) * sin(0.5 * PI * (double)k / (double)masses);
        require(fabs(omega[k] - want) <= 1e-11 * want, "mode %zu: omega = %.15g, not %.15g", k, omega[k], want);
    }
    tribo_system_destroy(sys);
    assert_status(create(&sys, &g, masses + 1, text, sizeof text), TRIBO_ERR_SIZE);
    require(_i || strstr(text, "lets the structure have 11 modes only"), "%s", text);
}

/* What is no structure. */
TEST(refused)
{
    const struct {
        struct grid g;
        double mass; /* of the last one, instead */
        const char *text;
    } cases[] = {{{1, 400, 1, .defect = -1.5}, 1.0, "stiffness is not positive semidefinite"},
                 {{1, 400, 1, .free = 1, .defect = -1e-4}, 1.0, "stiffness is not positive semidefinite"},
                 {{.rows = 20, .cols = 20, .copies = 1}, -1.0, "at degree of freedom 399"},
                 {{.rows = 60, .cols = 60, .copies = 1}, -1.0, "at degree of freedom 3599"}};
    const struct grid *g = &cases[_i].g;
    const size_t n = size_of(g);
    char text[200] = "";
    tribo_system *sys;
    gsl_spmatrix *k = stiffness_of(g), *m = mass_of(g, k), *j = gsl_spmatrix_alloc(1, n);
    gsl_spmatrix_set(m, n - 1, n - 1, cases[_i].mass);
    gsl_spmatrix_set(j, 0, 0, 1.0);
    stain(&sys, sizeof sys);
    const int status = sparse_system(&sys, m, NULL, k, j, 4, text, sizeof text);
    if (status == TRIBO_ERR_UNSUPPORTED && n > 3000) {
        assert_says(text, "TRIBO_SPARSE=ON");
    } else {
        assert_status(status, TRIBO_ERR_INDEFINITE);
        assert_says(text, cases[_i].text);
    }
    assert_status(reduced_system(&sys, m, k, j, 0, 1, text, sizeof text), TRIBO_ERR_SIZE);
    assert_says(text, "nmode = 0");
    ck_assert(stained(&sys, sizeof sys));
    gsl_spmatrix_free(k);
    gsl_spmatrix_free(m);
    gsl_spmatrix_free(j);
}

/* The same contact twice, and one that touches nothing: one static response. */
TEST(needless_contacts)
{
    const struct grid g = {20, 20, 1, .free = _i};
    double error;
    gsl_spmatrix *k = stiffness_of(&g), *m = mass_of(&g, k), *j = gsl_spmatrix_alloc(3, size_of(&g));
    tribo_system *sys;
    gsl_spmatrix_set(j, 0, 27, 1.0);
    gsl_spmatrix_set(j, 1, 27, -2.0);
    assert_ok(reduced_system(&sys, m, k, j, 4, 1, NULL, 0));
    ck_assert_uint_eq(tribo_system_ndof(sys), 5);
    assert_ok(tribo_system_get_truncation(sys, 0.0, &error));
    require(error < 1e-12, "%g", error);
    tribo_system_destroy(sys);
    gsl_spmatrix_free(k);
    gsl_spmatrix_free(m);
    gsl_spmatrix_free(j);
}

TEST_MAIN("many_modes", {squares, 24}, {alike, 24}, {more_than_room, 44}, {large, 4}, {holes, 2}, {refused, 4},
          {needless_contacts, 2})
