/* SPDX-License-Identifier: BSD-3-Clause */
/* tribo_model: its forms of input, its errors, and what its systems are. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "run.h"

enum { N = 3, C = 2 };

static const double mass[N] = {1.0, 2.0, 0.5}, damping[N] = {0.1, 0.2, 0.3};
static const double full_mass[N * N] = {1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.5};
static const double full_damping[N * N] = {0.1, 0.0, 0.0, 0.0, 0.2, 0.0, 0.0, 0.0, 0.3};
static const double stiffness[N * N] = {3.0, -1.0, 0.0, -1.0, 4.0, -2.0, 0.0, -2.0, 5.0};
static const double direction[C * N] = {1.0, 0.0, 0.0, 0.0, -1.0, 1.0};
static const size_t mass_row[] = {0, 1, 2, 3}, mass_col[] = {0, 1, 2};
static const size_t row[] = {0, 2, 5, 7}, col[] = {1, 0, 0, 2, 1, 2, 1}; /* columns in any order */
static const double val[] = {-1.0, 3.0, -1.0, -2.0, 4.0, 5.0, -2.0};
static const size_t j_row[] = {0, 1, 3}, j_col[] = {0, 2, 1};
static const double j_val[] = {1.0, 1.0, -1.0};

static tribo_model *new_model(void)
{
    tribo_model *model;
    assert_ok(tribo_model_create(&model, N, C));
    return model;
}

/* form 0: dense, 1: diagonals, 2: compressed rows. */
static void fill(tribo_model *model, int form)
{
    assert_ok(form == 0   ? tribo_model_set_mass(model, full_mass)
              : form == 1 ? tribo_model_set_mass_diagonal(model, mass)
                          : tribo_model_set_mass_csr(model, mass_row, mass_col, mass));
    assert_ok(form == 0   ? tribo_model_set_damping(model, full_damping)
              : form == 1 ? tribo_model_set_damping_diagonal(model, damping)
                          : tribo_model_set_damping_csr(model, mass_row, mass_col, damping));
    assert_ok(form < 2 ? tribo_model_set_stiffness(model, stiffness) : tribo_model_set_stiffness_csr(model, row, col, val));
    assert_ok(form < 2 ? tribo_model_set_direction(model, direction) : tribo_model_set_direction_csr(model, j_row, j_col, j_val));
}

/* The state after a while with a load and limits. */
static void follow(tribo_system *sys, double *y)
{
    const double limit[C] = {0.2, 0.1}, load[N] = {1.0, 0.0, 0.5};
    tribo_driver *drv = driver_create(sys, "exact", 0.5, 1e-9);
    double t = 0.0;
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    assert_ok(tribo_system_add_load(sys, 1.3, NULL, load));
    memset(y, 0, (2 * N + 1) * sizeof *y);
    assert_ok(tribo_driver_advance(drv, &t, 20.0, y));
    tribo_driver_destroy(drv);
}

/* All forms make the same system, to the last bit, also after the model is gone, and a second time. */
TEST(forms)
{
    double y[4][2 * N + 1];
    for (int form = 0; form < 3; form++) {
        tribo_model *model = new_model();
        tribo_system *first, *second;
        fill(model, form);
        assert_ok(tribo_system_create(&first, model));
        assert_ok(tribo_system_create(&second, model));
        tribo_model_destroy(model);
        follow(first, y[form]);
        follow(second, y[3]);
        assert_all_exact(y[form], y[0], 2 * N + 1);
        assert_all_exact(y[3], y[0], 2 * N + 1);
        tribo_system_destroy(first);
        tribo_system_destroy(second);
    }
    require(fabs(y[0][0]) > 1e-3, "it moves");
}

/* A matrix that is set again replaces the last one; one that is refused leaves it. */
TEST(set_again)
{
    double y[2][2 * N + 1];
    const double heavy[N] = {10.0, 20.0, 5.0}, wrong[N] = {1.0, NAN, 1.0};
    for (int k = 0; k < 2; k++) {
        tribo_model *model = new_model();
        tribo_system *sys;
        fill(model, 1);
        if (k) {
            assert_ok(tribo_model_set_mass_diagonal(model, heavy));
            assert_ok(tribo_model_set_mass_diagonal(model, mass));
            assert_status(tribo_model_set_mass_diagonal(model, wrong), TRIBO_ERR_NOT_FINITE);
            assert_says(tribo_model_message(model), "mass[1][1] = nan is not finite");
        }
        assert_ok(tribo_system_create(&sys, model));
        follow(sys, y[k]);
        tribo_system_destroy(sys);
        tribo_model_destroy(model);
    }
    assert_all_exact(y[1], y[0], 2 * N + 1);
}

#define REFUSED(call, status, text)                                                                                              \
    do {                                                                                                                         \
        assert_status(call, status);                                                                                             \
        assert_says(tribo_model_message(model), text);                                                                           \
    } while (0)

TEST(errors)
{
    const size_t backward[] = {0, 2, 1, 3}, late[] = {1, 2, 3, 4}, far[] = {0, 1, 7}, leap[] = {0, (size_t)1 << 40, 2, 3},
                 twice[] = {1, 1, 0, 2, 1, 2, 1};
    const double inf[N * N] = {1.0, 0.0, 0.0, 0.0, 1.0, INFINITY, 0.0, 0.0, 1.0},
                         skew[N * N] = {1.0, 2.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const double negative[C] = {0.0, -1.0}, tiny[C] = {1e-310, 0.0};
    tribo_model *model = NULL;
    tribo_system *sys = NULL;
    assert_status(tribo_model_create(NULL, 1, 1), TRIBO_ERR_NULL);
    assert_status(tribo_model_create(&model, 0, 1), TRIBO_ERR_SIZE);
    assert_status(tribo_model_create(&model, (size_t)-1, 1), TRIBO_ERR_SIZE);
    assert_status(tribo_model_set_mass(NULL, mass), TRIBO_ERR_NULL);
    assert_status(tribo_system_create(&sys, NULL), TRIBO_ERR_NULL);
    assert_says(tribo_model_message(NULL), "NULL");
    model = new_model();
    REFUSED(tribo_system_create(&sys, model), TRIBO_ERR_STATE, "mass has not been set");
    fill(model, 0);
    REFUSED(tribo_model_set_mass(model, NULL), TRIBO_ERR_NULL, "mass is NULL");
    REFUSED(tribo_model_set_stiffness_csr(model, NULL, col, val), TRIBO_ERR_NULL, "stiffness: rowptr is NULL");
    REFUSED(tribo_model_set_stiffness_csr(model, row, NULL, val), TRIBO_ERR_NULL, "stiffness: col is NULL");
    REFUSED(tribo_model_set_stiffness_csr(model, row, col, NULL), TRIBO_ERR_NULL, "stiffness: val is NULL");
    REFUSED(tribo_model_set_stiffness(model, inf), TRIBO_ERR_NOT_FINITE, "stiffness[1][2] = inf is not finite");
    REFUSED(tribo_model_set_mass_csr(model, backward, mass_col, mass), TRIBO_ERR_SIZE,
            "mass: rowptr[2] = 1 is below rowptr[1] = 2");
    REFUSED(tribo_model_set_mass_csr(model, leap, mass_col, mass), TRIBO_ERR_SIZE, "mass: rowptr[2] = 2 is below rowptr[1]");
    REFUSED(tribo_model_set_mass_csr(model, late, mass_col, mass), TRIBO_ERR_SIZE, "mass: rowptr[0] = 1 is not 0");
    REFUSED(tribo_model_set_mass_csr(model, mass_row, far, mass), TRIBO_ERR_RANGE, "mass: col[2] = 7 is not below 3");
    REFUSED(tribo_model_set_stiffness_csr(model, row, twice, val), TRIBO_ERR_DUPLICATE, "stiffness[0][1] is given twice");
    REFUSED(tribo_model_set_compliance(model, NULL), TRIBO_ERR_NULL, "compliance is NULL");
    REFUSED(tribo_model_set_compliance(model, negative), TRIBO_ERR_NEGATIVE, "compliance[1] = -1 is negative");
    REFUSED(tribo_model_set_compliance(model, tiny), TRIBO_ERR_RANGE, "compliance[0] = 1e-310");
    REFUSED(tribo_system_create(NULL, model), TRIBO_ERR_NULL, "sys is NULL");
    REFUSED(tribo_system_reduce(&sys, model, 0, TRIBO_STATICS_NONE), TRIBO_ERR_SIZE, "nmode = 0");
    REFUSED(tribo_system_reduce(&sys, model, 4, TRIBO_STATICS_NONE), TRIBO_ERR_SIZE, "nmode = 4 is more than the 3");
    REFUSED(tribo_system_reduce(&sys, model, 2, 3), TRIBO_ERR_RANGE, "static_contacts = 3");
    REFUSED(tribo_system_reduce(&sys, model, 2, TRIBO_STATICS_COMPLIANCE), TRIBO_ERR_UNSUPPORTED,
            "tribo_system_set_damping_ratio");
    assert_ok(tribo_system_create(&sys, model)); /* nothing that was refused has changed it */
    tribo_system_destroy(sys);
    sys = NULL;
    assert_ok(tribo_model_set_stiffness(model, skew));
    REFUSED(tribo_system_reduce(&sys, model, 2, TRIBO_STATICS_NONE), TRIBO_ERR_NOT_SYMMETRIC,
            "stiffness[0][1] = 2, but stiffness[1][0] = 0");
    assert_status(tribo_model_refuse(model, TRIBO_ERR_NAME, "file K.mtx: line 3"), TRIBO_ERR_NAME);
    assert_says(tribo_model_message(model), "file K.mtx: line 3");
    require(sys == NULL && tribo_model_ndof(model) == N && tribo_model_ncontact(model) == C && tribo_model_ndof(NULL) == 0,
            "sizes");
    tribo_model_destroy(model);
    tribo_model_destroy(NULL);
}

/* A contact with compliance is a spring before a slider: x'' + 0.1 x' + x + f = cos 1.1 t, stiffness 1, limit 0.5, has the exact
 * steady amplitude 3.38660810 (contacts.md of the design: one harmonic alone says 3.3923). */
TEST(compliance)
{
    const double one = 1.0, c = 0.1, soft = 1.0, limit = 0.5, x[2] = {1.0};
    double y[4] = {0.0}, least, most;
    tribo_model *model = dense_model(1, 1, &one, &c, &one, &one);
    assert_ok(tribo_model_set_compliance(model, &soft));
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_set_limit(tribo_system_context(sys), &limit));
    assert_ok(tribo_system_add_load(sys, 1.1, &one, NULL));
    tribo_driver *drv = driver_create(sys, "exact", 1.0, 1e-9);
    assert_ok(tribo_driver_find_periodic(drv, 0.0, 2.0 * acos(-1.0) / 1.1, y));
    assert_ok(tribo_driver_period_extremes(drv, x, &least, &most, NULL, NULL));
    assert_close(most, 3.38660810, 1e-7);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Compliance 0 is a rigid contact; reduced to all modes the elastic structure is the same one. */
TEST(compliance_reduced)
{
    const double soft[C] = {0.0, 0.7}, limit[C] = {0.2, 0.1}, load[N] = {1.0, 0.0, 0.5};
    double place[2][N];
    for (int reduced = 0; reduced < 2; reduced++) {
        tribo_model *model = new_model();
        tribo_system *sys;
        assert_ok(tribo_model_set_mass_diagonal(model, mass));
        assert_ok(tribo_model_set_stiffness(model, stiffness));
        assert_ok(tribo_model_set_direction(model, direction));
        assert_ok(tribo_model_set_compliance(model, soft));
        assert_ok(reduced ? tribo_system_reduce(&sys, model, N, TRIBO_STATICS_NONE) : tribo_system_create(&sys, model));
        assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
        assert_ok(tribo_system_add_load(sys, 1.3, NULL, load));
        double y[2 * N + 2] = {0.0}, t = 0.0;
        tribo_driver *drv = driver_create(sys, "exact", 0.5, 1e-9);
        assert_ok(tribo_driver_advance(drv, &t, 20.0, y));
        if (reduced) {
            assert_ok(tribo_system_expand(sys, y, place[1]));
        } else {
            memcpy(place[0], y, sizeof place[0]);
        }
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
        tribo_model_destroy(model);
    }
    for (size_t i = 0; i < N; i++) {
        assert_close(place[1][i], place[0][i], 1e-9);
    }
}

/* Entries of the stiffness that are given as 0 change no bit, also between degrees of freedom without mass, W, and with mass. */
TEST(given_zeros)
{
    enum { W = 40, M = 2 * W };
    static size_t first[M + 1], at[M * M];
    static double entry[M * M], masses[M], way[M], y[2][2 * M + 1];
    for (size_t d = 0; d < M; d++) {
        masses[d] = d < W ? 0.0 : 1.0;
        y[0][d] = y[1][d] = d < W ? 0.0 : 0.01 * (double)(d - W);
    }
    way[W] = 1.0;
    for (int given = 0; given < 2; given++) {
        size_t count = 0;
        for (size_t i = 0; i < M; i++) {
            first[i] = count;
            for (size_t j = 0; j < M; j++) {
                const size_t low = i < j ? i : j, off = i < j ? j - i : i - j;
                const int coupled = (off == 1 && i < W && j < W) || (off == W && low + 1 < W); /* the last mass stands alone */
                if (off == 0 || coupled || given) {
                    at[count] = j;
                    entry[count++] = off == 0 ? 4.0 : coupled ? -1.0 : 0.0;
                }
            }
        }
        first[M] = count;
        const double limit = 0.02;
        tribo_model *model;
        assert_ok(tribo_model_create(&model, M, 1));
        assert_ok(tribo_model_set_mass_diagonal(model, masses));
        assert_ok(tribo_model_set_stiffness_csr(model, first, at, entry));
        assert_ok(tribo_model_set_direction(model, way));
        tribo_system *sys = finish_model(model);
        assert_ok(tribo_set_limit(tribo_system_context(sys), &limit));
        tribo_driver *drv = driver_create(sys, "event", 0.5, 1e-9);
        double t = 0.0;
        assert_ok(tribo_driver_advance(drv, &t, 5.0, y[given]));
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    require(memcmp(y[0], y[1], sizeof y[0]) == 0 && y[0][M - 1] != 0.0, "zeros");
}

/* A contact whose row of J has zeros only touches nothing, as one without entries: no method divides by a 0. */
TEST(zero_direction)
{
    static const size_t first[C + 1] = {0, 1, 3}, at[] = {0, 0, 1};
    static const double entry[] = {1.0, 0.0, 0.0}, dense[C * N] = {1.0}, limit[C] = {0.2, 0.1}, load[N] = {1.0, 0.0, 0.5};
    static const char *const method[] = {"central/fixed", "moreau/fixed", "exact", "event"};
    for (size_t k = 0; k < sizeof method / sizeof *method; k++) {
        double y[2][2 * N + 1] = {{0.0}};
        for (int given = 0; given < 2; given++) {
            tribo_model *model = new_model();
            double t = 0.0;
            assert_ok(tribo_model_set_mass_diagonal(model, mass));
            assert_ok(tribo_model_set_stiffness(model, stiffness));
            assert_ok(given ? tribo_model_set_direction_csr(model, first, at, entry) : tribo_model_set_direction(model, dense));
            tribo_system *sys = finish_model(model);
            assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
            assert_ok(tribo_system_add_load(sys, 1.3, NULL, load));
            tribo_driver *drv = driver_create(sys, method[k], 0.05, 1e-9);
            assert_ok(tribo_driver_advance(drv, &t, 20.0, y[given]));
            tribo_driver_destroy(drv);
            tribo_system_destroy(sys);
        }
        require(memcmp(y[0], y[1], sizeof y[0]) == 0 && y[0][0] != 0.0, "zeros of J");
    }
}

/* A degree of freedom without mass that no contact moves: there is no spring between contacts, in a copy neither. */
TEST(copy_without_springs)
{
    static const double some[2] = {1.0, 0.0}, coupled[4] = {2.0, -1.0, -1.0, 2.0}, one[2] = {1.0, 0.0};
    tribo_model *model;
    tribo_system *copy;
    double y[2][5] = {{0.4}, {0.4}}, f[2];
    assert_ok(tribo_model_create(&model, 2, 1));
    assert_ok(tribo_model_set_mass_diagonal(model, some));
    assert_ok(tribo_model_set_stiffness(model, coupled));
    assert_ok(tribo_model_set_direction(model, one));
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.1));
    assert_ok(tribo_system_clone(sys, &copy));
    for (int k = 0; k < 2; k++) {
        tribo_driver *drv = driver_create(k ? copy : sys, "exact", 0.5, 1e-9);
        double t = 0.0;
        assert_ok(tribo_driver_advance(drv, &t, 3.0, y[k]));
        assert_ok(tribo_system_contacts(k ? copy : sys, t, y[k], NULL, NULL, &f[k]));
        tribo_driver_destroy(drv);
    }
    require(memcmp(y[0], y[1], sizeof y[0]) == 0 && f[0] == f[1] && y[0][0] != 0.4, "%g, and %g by a copy", y[0][0], y[1][0]);
    tribo_system_destroy(copy);
    tribo_system_destroy(sys);
}

TEST_MAIN("models", {forms, 1}, {set_again, 1}, {errors, 1}, {compliance, 1}, {compliance_reduced, 1}, {given_zeros, 1},
          {zero_direction, 1}, {copy_without_springs, 1})
