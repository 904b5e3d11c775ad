/* SPDX-License-Identifier: BSD-3-Clause */
/* Structures from their matrices: in every form of input, with any mass, reduced or not; a finite-element beam. */
#include <stdlib.h>
#include <string.h>

#include "make.h"
#include "beam.h"
#include "model.h"

#define EPSILON 0.05
#define STEP 0.01
#define END 10.0

static void move(tribo_system *sys, double *y)
{
    memset(y, 0, tribo_system_dimension(sys) * sizeof *y);
    run(sys, "rk4/fixed", STEP, 0.0, END, y);
    require(y[tribo_system_dimension(sys) - 1] > 0.01, "no friction, no test");
    tribo_system_destroy(sys);
}

/* ---------------------------------------------------------------------------------------- the reference systems by matrices */

/* Twice the oscillator: mass, stiffness, load and limit. */
TEST(oscillator_by_matrices)
{
    const double two[] = {2.0}, one[] = {1.0}, load[] = {3.0};
    double y[3], want[3];
    tribo_system *sys = oscillator(TRIBO_QUINN, 1.5, 0.5), *linear;
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), EPSILON));
    assert_ok(dense_system(&linear, 1, 1, two, NULL, two, one, 0, NULL, 0));
    assert_ok(tribo_system_add_load(linear, 0.5, NULL, load));
    assert_ok(tribo_set_limit_all(tribo_system_context(linear), 2.0));
    assert_ok(tribo_set_epsilon_all(tribo_system_context(linear), EPSILON));
    move(sys, want);
    move(linear, y);
    want[2] *= 2.0;
    assert_all_exact(y, want, 3);
}

TEST(belt_by_matrices)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {1.0, 0.0, 0.0, 2.0}, direction[] = {1.0, 0.0, -1.0, 1.0};
    const double motion[] = {1.0, 0.0}, limit[] = {0.5, 0.25};
    double y[5], want[5];
    tribo_system *sys, *linear;
    assert_ok(tribo_system_belt(&sys, 2.0, 0.5, 0.25, 1.0, 0.5));
    assert_ok(dense_system(&linear, 2, 2, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_base_motion(linear, 0.5, NULL, motion));
    assert_ok(tribo_set_limit(tribo_system_context(linear), limit));
    assert_ok(tribo_set_epsilon_step(tribo_system_context(linear), STEP, 1.0));
    assert_ok(tribo_set_epsilon_step(tribo_system_context(sys), STEP, 1.0));
    move(sys, want);
    move(linear, y);
    assert_all_exact(y, want, 5);
}

/* ----------------------------------------------------------------------------------------------------------- sparse input */

/* A compressed or uncompressed matrix; entries of the uncompressed one in an order of its own. */
static gsl_spmatrix *sparse(const double *x, size_t rows, size_t cols, int type)
{
    gsl_spmatrix *coo = gsl_spmatrix_alloc(rows, cols);
    for (size_t k = rows * cols; k-- > 0;) {
        const size_t at = k * 7 % (rows * cols); /* 7 divides neither 36 nor 18 */
        if (x[at] != 0.0) {
            gsl_spmatrix_set(coo, at / cols, at % cols, x[at]);
        }
    }
    if (type == GSL_SPMATRIX_COO) {
        return coo;
    }
    gsl_spmatrix *compressed = gsl_spmatrix_compress(coo, type);
    gsl_spmatrix_free(coo);
    return compressed;
}

TEST(sparse_forms)
{
    const int types[] = {GSL_SPMATRIX_COO, GSL_SPMATRIX_CSC, GSL_SPMATRIX_CSR};
    struct random g = random_of(_i);
    struct model m = model_create(&g, _i % 2);
    for (size_t k = 0; k < DOFS * DOFS; k++) {
        /* a band, and a contact that touches two degrees of freedom */
        const size_t off = k / DOFS > k % DOFS ? k / DOFS - k % DOFS : k % DOFS - k / DOFS;
        m.stiffness[k] *= off > 1 ? 0.0 : 1.0;
        m.damping[k] *= off > 2 ? 0.0 : 1.0;
        m.direction[k % DOFS] *= k % DOFS > 1 ? 0.0 : 1.0;
    }
    const size_t nmode = _i / 2 % 2 ? 4 : 0;
    double y[DIMENSION], want[DIMENSION];
    move(model_system(&m, nmode == 0, nmode, EPSILON), want);
    for (size_t k = 0; k < COUNT(types); k++) {
        gsl_spmatrix *mass = sparse(m.mass, DOFS, DOFS, types[k]), *damping = sparse(m.damping, DOFS, DOFS, types[k]);
        gsl_spmatrix *stiffness = sparse(m.stiffness, DOFS, DOFS, types[k]);
        gsl_spmatrix *direction = sparse(m.direction, CONTACTS, DOFS, types[k]);
        tribo_system *sys;
        assert_ok(sparse_system(&sys, mass, nmode ? NULL : damping, stiffness, direction, nmode, NULL, 0));
        model_finish(&m, sys, EPSILON);
        gsl_spmatrix_free(mass);
        gsl_spmatrix_free(damping);
        gsl_spmatrix_free(stiffness);
        gsl_spmatrix_free(direction);
        move(sys, y);
        assert_all_exact(y, want, 2 * (nmode ? nmode : DOFS) + 1);
    }
}

/* A hub with springs to 60 others is neither banded nor full: its matrix stays compressed. */
TEST(star)
{
    enum { ENDS = 60, SIZE = ENDS + 1 };
    double rate[2 * SIZE + 1], y[2 * SIZE + 1] = {0}, pull = 0.0;
    gsl_spmatrix *mass = gsl_spmatrix_alloc(SIZE, SIZE), *stiffness = gsl_spmatrix_alloc(SIZE, SIZE);
    gsl_spmatrix *direction = gsl_spmatrix_alloc(1, SIZE);
    tribo_system *sys;
    gsl_spmatrix_set(mass, 0, 0, 2.0);
    gsl_spmatrix_set(stiffness, 0, 0, ENDS);
    gsl_spmatrix_set(direction, 0, 0, 1.0);
    for (size_t i = 1; i < SIZE; i++) {
        gsl_spmatrix_set(mass, i, i, 0.5);
        gsl_spmatrix_set(stiffness, i, i, 1.0);
        gsl_spmatrix_set(stiffness, 0, i, -1.0);
        gsl_spmatrix_set(stiffness, i, 0, -1.0);
        y[i] = (double)(i * i % 17);
        pull += y[i] - 3.0;
    }
    y[0] = 3.0;
    assert_ok(sparse_system(&sys, mass, NULL, stiffness, direction, 0, NULL, 0));
    const gsl_odeiv2_system *ode = tribo_gsl_system(sys);
    ck_assert_int_eq(ode->function(0.0, y, rate, ode->params), GSL_SUCCESS);
    assert_exact(rate[SIZE], pull / 2.0);
    for (size_t i = 1; i < SIZE; i++) {
        assert_exact(rate[SIZE + i], 2.0 * (3.0 - y[i]));
    }
    tribo_system_destroy(sys);
    gsl_spmatrix_free(mass);
    gsl_spmatrix_free(stiffness);
    gsl_spmatrix_free(direction);
}

/* ------------------------------------------------------------------------------------------------------- other coordinates */

/* In coordinates q = T x a diagonal mass is full, and the motion is the same: rk4 does not mind linear maps. */
TEST(full_mass)
{
    struct random g = random_of(_i);
    const struct model m = model_create(&g, 0);
    struct model full = m;
    double t[DOFS * DOFS], work[DOFS * DOFS], want[DIMENSION], x[DIMENSION], q[DOFS];
    for (size_t k = 0; k < DOFS * DOFS; k++) {
        t[k] = uniform(&g, -0.4, 0.4) + (k % (DOFS + 1) ? 0.0 : 2.0);
    }
    const double *from[] = {m.mass, m.damping, m.stiffness};
    double *to[] = {full.mass, full.damping, full.stiffness};
    for (size_t k = 0; k < 3; k++) {
        multiply(DOFS, DOFS, DOFS, from[k], t, work);
        multiply_transposed(DOFS, DOFS, DOFS, t, work, to[k]);
    }
    multiply(CONTACTS, DOFS, DOFS, m.direction, t, full.direction);
    for (size_t k = 0; k < 2; k++) {
        multiply_transposed(DOFS, DOFS, 1, t, m.load[k], full.load[k]);
    }
    move(model_system(&m, 1, 0, EPSILON), want);
    move(model_system(&full, 1, 0, EPSILON), x);
    for (size_t part = 0; part < 2; part++) {
        multiply(DOFS, DOFS, 1, t, x + part * DOFS, q);
        assert_all_close(q, want + part * DOFS, DOFS, 1e-11);
    }
    assert_close(x[2 * DOFS], want[2 * DOFS], 1e-11);
}

/* With all its modes a reduced system is the whole one. */
TEST(all_modes)
{
    struct random g = random_of(_i);
    const struct model m = model_create(&g, _i % 2);
    double want[DIMENSION], y[DIMENSION], q[DOFS];
    tribo_system *whole = model_system(&m, 0, 0, EPSILON), *reduced = model_system(&m, 0, DOFS, EPSILON);
    memset(want, 0, sizeof want);
    memset(y, 0, sizeof y);
    run(whole, "rk4/fixed", STEP, 0.0, END, want);
    run(reduced, "rk4/fixed", STEP, 0.0, END, y);
    for (size_t part = 0; part < 2; part++) {
        assert_ok(tribo_system_expand(reduced, y + part * DOFS, q));
        assert_all_close(q, want + part * DOFS, DOFS, 1e-11);
    }
    assert_close(y[2 * DOFS], want[2 * DOFS], 1e-11);
    tribo_system_destroy(whole);
    tribo_system_destroy(reduced);
}

/* Modes are orthonormal with M, and orthogonal with K to omega^2; fewer of them are the lowest ones. */
TEST(modes)
{
    struct random g = random_of(_i);
    const struct model m = model_create(&g, 1);
    double omega[DOFS], lowest[DOFS], mode[DOFS][DOFS];
    tribo_system *all = model_system(&m, 0, DOFS, EPSILON), *some = model_system(&m, 0, 3, EPSILON);
    assert_ok(tribo_system_get_frequencies(all, omega));
    assert_ok(tribo_system_get_frequencies(some, lowest));
    assert_all_exact(lowest, omega, 3);
    ck_assert_uint_eq(tribo_system_ndof(some), 3);
    for (size_t k = 0; k < DOFS; k++) {
        double unit[DOFS] = {0};
        unit[k] = 1.0;
        assert_ok(tribo_system_expand(all, unit, mode[k]));
        ck_assert_double_le(omega[k ? k - 1 : 0], omega[k]);
    }
    for (size_t k = 0; k < DOFS * DOFS; k++) {
        const size_t i = k / DOFS, j = k % DOFS;
        assert_close(form(m.mass, mode[i], mode[j]), i == j ? 1.0 : 0.0, 1e-13);
        assert_close(form(m.stiffness, mode[i], mode[j]), i == j ? omega[i] * omega[i] : 0.0, 1e-12);
    }
    tribo_system_destroy(all);
    tribo_system_destroy(some);
}

/* q'' + 2 zeta omega q' + omega^2 q = 0 for every mode, contacts being open. */
TEST(damping_ratio)
{
    struct random g = random_of(_i);
    const struct model m = model_create(&g, 1);
    const double zeta = 0.05, t = 3.0;
    double omega[DOFS], y[DIMENSION] = {0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, DOFS, CONTACTS, m.mass, NULL, m.stiffness, m.direction, 4, NULL, 0));
    assert_ok(tribo_system_get_frequencies(sys, omega));
    assert_ok(tribo_system_set_damping_ratio(sys, 0.9));
    assert_ok(tribo_system_set_damping_ratio(sys, zeta));
    y[0] = y[1] = y[2] = y[3] = 1.0;
    run(sys, "rk4/fixed", 1e-3, 0.0, t, y);
    for (size_t k = 0; k < 4; k++) {
        const double damped = omega[k] * sqrt(1.0 - zeta * zeta);
        const double want = exp(-zeta * omega[k] * t) * (cos(damped * t) + zeta * omega[k] / damped * sin(damped * t));
        assert_close(y[k], want, 1e-11); /* (omega dt)^4 t/120 */
    }
    tribo_system_destroy(sys);
}

/* Two masses on a spring, not held: the first frequency is 0. */
TEST(rigid_body)
{
    const double mass[] = {1.0, 0.0, 0.0, 3.0}, stiffness[] = {12.0, -12.0, -12.0, 12.0}, direction[] = {1.0, 0.0};
    double omega[2];
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 1, mass, NULL, stiffness, direction, 2, NULL, 0));
    assert_ok(tribo_system_get_frequencies(sys, omega));
    assert_exact(omega[0], 0.0);
    assert_close(omega[1], 4.0, 1e-14);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------------------- the beam */

/* CalculiX's natural frequencies in Hz, to their seven printed digits. But the first, so far below the highest of 1.49 MHz that
 * rounding costs other solvers half of their digits: what the matrices of the files have it at is 26.6925899220946, by inverse
 * iteration in 40 digits. */
TEST(beam)
{
    const double want[] = {26.6925899220946, 105.6315, 170.0245, 490.8049, 658.4940, 964.3248, 1008.919, 1781.017, 1831.835};
    const double digit[] = {1e-8, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-3, 1e-3, 1e-3};
    double omega[COUNT(want)];
    char text[200] = "";
    gsl_spmatrix *mass = beam_matrix("M.mtx"), *stiffness = beam_matrix("K.mtx"), *direction = gsl_spmatrix_alloc(1, BEAM_DOFS);
    tribo_system *sys = NULL;
    gsl_spmatrix_set(direction, 0, 2, 1.0);
    const int status = sparse_system(&sys, mass, NULL, stiffness, direction, COUNT(want), text, sizeof text);
    require(status == TRIBO_OK, "%s", text);
    assert_ok(tribo_system_get_frequencies(sys, omega));
    for (size_t k = 0; k < COUNT(want); k++) {
        assert_close(omega[k] / (2.0 * PI), want[k], 0.5001 * digit[k]);
    }
    tribo_system_destroy(sys);
    gsl_spmatrix_free(mass);
    gsl_spmatrix_free(stiffness);
    gsl_spmatrix_free(direction);
}

/* All of the beam, or its modes, all of them; its mass matrix or the diagonal of that. */
static tribo_system *whole_beam(size_t count, int diagonal)
{
    const size_t rows[] = {3, 117, 189, 261, 120, 123, 126, 270, 273}, tip = 264;
    gsl_spmatrix *mass = beam_matrix("M.mtx"), *stiffness = beam_matrix("K.mtx"),
                 *direction = gsl_spmatrix_alloc(COUNT(rows), BEAM_DOFS);
    double load[BEAM_DOFS] = {0};
    char text[200] = "";
    tribo_system *sys = NULL;
    for (size_t k = 0; diagonal && k < mass->nz; k++) {
        mass->data[k] *= mass->i[k] == mass->p[k] ? 1.0 : 0.0;
    }
    for (size_t i = 0; i < COUNT(rows); i++) {
        gsl_spmatrix_set(direction, i, rows[i] - 1, 1.0);
    }
    const int status = sparse_system(&sys, mass, NULL, stiffness, direction, count, text, sizeof text);
    require(status == TRIBO_OK, "%s", text);
    load[tip - 1] = 0.1;
    assert_ok(tribo_system_add_load(sys, 168.0, NULL, load));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.02));
    gsl_spmatrix_free(mass);
    gsl_spmatrix_free(stiffness);
    gsl_spmatrix_free(direction);
    return sys;
}

/* Steps so long that h^2/4 K is a million times M: contacts of the matrices as they are and of modes see the same. */
TEST(beam_in_long_steps)
{
    const double step[] = {2.5e-4, 2e-3}, end = 0.02;
    tribo_system *whole = whole_beam(0, _i), *modal = whole_beam(BEAM_DOFS, _i);
    double y[2 * BEAM_DOFS + 1] = {0}, z[2 * BEAM_DOFS + 1] = {0}, want[BEAM_DOFS];
    run(whole, "moreau/fixed", step[_i], 0.0, end, y);
    run(modal, "moreau/fixed", step[_i], 0.0, end, z);
    assert_ok(tribo_system_expand(modal, z, want));
    const double size = fabs(want[BEAM_DOFS - 25]);
    require(z[2 * BEAM_DOFS] > 1e-4, "no friction, no test");
    for (size_t i = 0; i < BEAM_DOFS; i++) {
        assert_close(y[i], want[i], 1e-7 * size);
    }
    assert_close(y[2 * BEAM_DOFS], z[2 * BEAM_DOFS], 1e-7 * z[2 * BEAM_DOFS]);
    tribo_system_destroy(whole);
    tribo_system_destroy(modal);
}

/* ------------------------------------------------------------------------------------------------------------ errors */

/* Two degrees of freedom, one contact, all well unless a case says otherwise. */
struct input {
    double mass[4], damping[4], stiffness[4], direction[2];
    size_t ndof, nmode;
    int damped, status;
    const char *text;
};

static const struct input refused[] = {
    {{1, NAN, 0, 1}, {0}, {2, -1, -1, 2}, {1, 0}, 2, 0, 0, TRIBO_ERR_NOT_FINITE, "mass[0][1] = nan"},
    {{1, 0.5, 0.25, 1}, {0}, {2, -1, -1, 2}, {1, 0}, 2, 0, 0, TRIBO_ERR_NOT_SYMMETRIC, "mass[0][1] = 0.5, but mass[1][0] = 0.25"},
    {{1, 0, 0, -2}, {0}, {2, -1, -1, 2}, {1, 0}, 2, 0, 0, TRIBO_ERR_INDEFINITE, "pivot -2 at degree of freedom 1"},
    {{1, 0, 0, 0}, {0}, {2, 0, 0, 0}, {1, 0}, 2, 0, 0, TRIBO_ERR_INDEFINITE, "degree of freedom 1 has none, and the stiffness"},
    {{0, 0, 0, 0}, {0}, {2, -1, -1, 2}, {1, 0}, 2, 0, 0, TRIBO_ERR_INDEFINITE, "pivot 0 at degree of freedom"},
    {{1, 0, 0, 0}, {1, 0, 0, 1}, {2, -1, -1, 2}, {1, 0}, 2, 0, 1, TRIBO_ERR_UNSUPPORTED, "damping[1][1] = 1, but degree"},
    {{1, 2, 2, 1}, {0}, {2, -1, -1, 2}, {1, 0}, 2, 0, 0, TRIBO_ERR_INDEFINITE, "mass is not positive definite"},
    {{1, 0, 0, -2}, {0}, {2, -1, -1, 2}, {1, 0}, 2, 1, 0, TRIBO_ERR_INDEFINITE, "pivot -2 at degree of freedom 1"},
    {{1, 0, 0, 2}, {0}, {1, 0, 0, HUGE_VAL}, {1, 0}, 2, 0, 0, TRIBO_ERR_NOT_FINITE, "stiffness[1][1] = inf"},
    {{1, 0, 0, 2}, {0}, {1, 0, 1, 1}, {1, 0}, 2, 1, 0, TRIBO_ERR_NOT_SYMMETRIC, "stiffness[1][0] = 1, but stiffness[0][1] = 0"},
    {{1, 0, 0, 2}, {0}, {-4, 0, 0, 1}, {1, 0}, 2, 1, 0, TRIBO_ERR_INDEFINITE, "omega^2 = -4 of mode 0"},
    {{1, 0, 0, 2}, {0, NAN, 0, 0}, {2, 0, 0, 2}, {1, 0}, 2, 0, 1, TRIBO_ERR_NOT_FINITE, "damping[0][1] = nan"},
    {{1, 0, 0, 2}, {0}, {2, 0, 0, 2}, {1, -HUGE_VAL}, 2, 0, 0, TRIBO_ERR_NOT_FINITE, "direction[0][1] = -inf"},
    {{1, 0, 0, 2}, {0}, {2, 0, 0, 2}, {1e200, 0}, 2, 0, 0, TRIBO_ERR_NOT_FINITE, "contacts 0, 0 is inf"},
    {{2, 1, 1, 2}, {0}, {2, 0, 0, 2}, {1e200, 0}, 2, 0, 0, TRIBO_ERR_NOT_FINITE, "r[0][0] = inf"},
    {{1, 0, 0, 2}, {0}, {2, 0, 0, 2}, {1e200, 0}, 2, 2, 0, TRIBO_ERR_NOT_FINITE, "r[0][0] = inf"},
    {{1, 0, 0, 2}, {0}, {2, -1, -1, 2}, {1, 0}, 2, 3, 0, TRIBO_ERR_SIZE, "nmode = 3 is more than the 2"},
    {{1, 0, 0, 2}, {0}, {2, -1, -1, 2}, {1, 0}, 0, 0, 0, TRIBO_ERR_SIZE, "sizes do not fit"},
    {{1, 0, 0, 2}, {0}, {2, -1, -1, 2}, {1, 0}, SIZE_MAX, 0, 0, TRIBO_ERR_SIZE, "sizes do not fit"},
};

static int create(tribo_system **sys, const struct input *x, char *text, size_t size)
{
    return dense_system(sys, x->ndof, 1, x->mass, x->damped ? x->damping : NULL, x->stiffness, x->direction, x->nmode, text,
                        size);
}

TEST(dense_errors)
{
    tribo_system *sys;
    stain(&sys, sizeof sys);
    for (size_t k = 0; k < COUNT(refused); k++) {
        char text[200] = "";
        assert_status(create(&sys, &refused[k], text, sizeof text), refused[k].status);
        assert_says(text, refused[k].text);
    }
    ck_assert(stained(&sys, sizeof sys));
}

TEST(null_matrices)
{
    const double x[4] = {1.0, 0.0, 0.0, 1.0};
    char text[200];
    tribo_system *sys;
    const struct {
        const double *mass, *stiffness, *direction;
        const char *text;
    } cases[] = {{NULL, x, x, "mass is NULL"}, {x, NULL, x, "stiffness is NULL"}, {x, x, NULL, "direction is NULL"}};
    stain(&sys, sizeof sys);
    for (size_t k = 0; k < COUNT(cases); k++) {
        assert_status(dense_system(&sys, 2, 1, cases[k].mass, NULL, cases[k].stiffness, cases[k].direction, 0, text, sizeof text),
                      TRIBO_ERR_NULL);
        assert_says(text, cases[k].text);
    }
    assert_status(dense_system(NULL, 2, 1, x, NULL, x, x, 0, text, sizeof text), TRIBO_ERR_NULL);
    assert_says(text, "sys is NULL");
    ck_assert(stained(&sys, sizeof sys));
    assert_ok(dense_system(&sys, 2, 0, x, NULL, x, NULL, 0, text, sizeof text)); /* no contacts, no directions */
    tribo_system_destroy(sys);
}

/* Matrices whose sizes do not fit, in turn; those that are NULL. */
TEST(sparse_errors)
{
    const double unit[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const struct {
        size_t size[4][2];
        int status;
        const char *text;
    } cases[] = {
        {{{2, 3}, {0, 0}, {2, 2}, {1, 2}}, TRIBO_ERR_SIZE, "mass is 2 x 3, not 2 x 2"},
        {{{2, 2}, {3, 2}, {2, 2}, {1, 2}}, TRIBO_ERR_SIZE, "damping is 3 x 2"},
        {{{2, 2}, {0, 0}, {3, 3}, {1, 2}}, TRIBO_ERR_SIZE, "stiffness is 3 x 3"},
        {{{2, 2}, {0, 0}, {2, 2}, {1, 3}}, TRIBO_ERR_SIZE, "direction is 1 x 3"},
        {{{0, 0}, {0, 0}, {2, 2}, {1, 2}}, TRIBO_ERR_NULL, "mass is NULL"},
        {{{2, 2}, {0, 0}, {0, 0}, {1, 2}}, TRIBO_ERR_NULL, "stiffness is NULL"},
        {{{2, 2}, {0, 0}, {2, 2}, {0, 0}}, TRIBO_ERR_NULL, "direction is NULL"},
    };
    tribo_system *sys;
    stain(&sys, sizeof sys);
    for (size_t k = 0; k < COUNT(cases); k++) {
        gsl_spmatrix *m[4];
        char text[200] = "";
        for (size_t i = 0; i < 4; i++) {
            const size_t *size = cases[k].size[i];
            m[i] = size[0] ? sparse(unit, size[0], size[1], GSL_SPMATRIX_COO) : NULL;
        }
        assert_status(sparse_system(&sys, m[0], m[1], m[2], m[3], 0, text, sizeof text), cases[k].status);
        assert_says(text, cases[k].text);
        for (size_t i = 0; i < 4; i++) {
            if (m[i]) {
                gsl_spmatrix_free(m[i]);
            }
        }
    }
    ck_assert(stained(&sys, sizeof sys));
}

TEST_MAIN("linear", {oscillator_by_matrices, 1}, {belt_by_matrices, 1}, {sparse_forms, 4}, {star, 1}, {full_mass, 6},
          {all_modes, 6}, {modes, 6}, {damping_ratio, 3}, {rigid_body, 1}, {beam, 1}, {beam_in_long_steps, 2}, {dense_errors, 1},
          {null_matrices, 1}, {sparse_errors, 1})
