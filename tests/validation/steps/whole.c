/* SPDX-License-Identifier: BSD-3-Clause */
/* Structures with a consistent mass matrix that are larger than dense matrices are made for, without reduction: what moreau/fixed
 * makes of them where the motion is known in another way, and what is refused. Without CHOLMOD all is refused. */
#include <stdlib.h>
#include <string.h>

#include "make.h"
#include "run.h"
#include "../../set_up_driver.h"

/* Masses on a grid with springs between them and to the ground all around; M = 1 + K/12, which changes no shape. Copies of a grid
 * hold nothing of each other. */
struct grid {
    size_t rows, cols, copies;
};

struct matrices {
    size_t n;
    gsl_spmatrix *mass, *damping, *stiffness, *direction;
};

static void couple(gsl_spmatrix *k, size_t i, size_t j)
{
    gsl_spmatrix_set(k, i, j, -1.0);
    gsl_spmatrix_set(k, j, i, -1.0);
}

static gsl_spmatrix *stiffness_of(const struct grid *g)
{
    const size_t n = g->rows * g->cols * g->copies;
    gsl_spmatrix *k = gsl_spmatrix_alloc(n, n);
    for (size_t at = 0; at < n; at++) {
        gsl_spmatrix_set(k, at, at, g->rows > 1 ? 4.0 : 2.0);
        if (at % g->cols + 1 < g->cols) {
            couple(k, at, at + 1);
        }
        if (at / g->cols % g->rows + 1 < g->rows) {
            couple(k, at, at + g->cols);
        }
    }
    return k;
}

/* one + factor K */
static gsl_spmatrix *combine(const gsl_spmatrix *k, double one, double factor)
{
    gsl_spmatrix *m = gsl_spmatrix_alloc(k->size1, k->size2);
    for (size_t e = 0; e < k->nz; e++) {
        gsl_spmatrix_set(m, (size_t)k->i[e], (size_t)k->p[e], factor * k->data[e] + (k->i[e] == k->p[e] ? one : 0.0));
    }
    return m;
}

static const double slow = 0.02, fast = 0.03; /* C = slow + fast K */

static struct matrices matrices_of(const struct grid *g, size_t contacts)
{
    struct matrices x = {.n = g->rows * g->cols * g->copies, .stiffness = stiffness_of(g)};
    x.mass = combine(x.stiffness, 1.0, 1.0 / 12.0);
    x.damping = combine(x.stiffness, slow, fast);
    x.direction = gsl_spmatrix_alloc(contacts, x.n);
    return x;
}

static void free_matrices(struct matrices *x)
{
    gsl_spmatrix_free(x->mass);
    gsl_spmatrix_free(x->damping);
    gsl_spmatrix_free(x->stiffness);
    gsl_spmatrix_free(x->direction);
}

/* The system, or NULL: the library has been built without CHOLMOD, and says so. */
static tribo_system *create(struct matrices *x)
{
    char text[200] = "";
    tribo_system *sys = NULL;
    const int status = sparse_system(&sys, x->mass, x->damping, x->stiffness, x->direction, 0, text, sizeof text);
    free_matrices(x);
    if (status == TRIBO_ERR_UNSUPPORTED) {
        assert_says(text, "build tribo with TRIBO_SPARSE=ON");
        ck_assert_int_eq(tribo_dynamics_has(TRIBO_FEATURE_CHOLMOD), 0);
        return NULL;
    }
    ck_assert_int_eq(tribo_dynamics_has(-1), 0);
    require(status == TRIBO_OK, "%s", text);
    return sys;
}

/* ----------------------------------------------------------------------------------------------------------- one shape */

/* The midpoint rule of a'' + c a' + w2 a = cos(omega t), from a and rest. */
static double follow(double a, double c, double w2, double omega, double h, size_t steps)
{
    double v = 0.0;
    for (size_t k = 0; k < steps; k++) {
        const double t = h * (double)k, load = 0.5 * (cos(omega * t) + cos(omega * (t + h)));
        const double dv = h * (load - w2 * (a + 0.5 * h * v) - c * v) / (1.0 + 0.5 * h * c + 0.25 * h * h * w2);
        a += h * (v + 0.5 * dv);
        v += dv;
    }
    return a;
}

/* A mode that a load of its shape drives does what one equation does, and no other mode does anything. */
TEST(one_shape)
{
    enum { SIDE = 60, STEPS = 300 };
    const struct grid g = {SIDE, SIDE, 1};
    const double p = 2.0, q = 3.0,
                 k = 4.0 * pow(sin(0.5 * PI * p / (SIDE + 1)), 2.0) + 4.0 * pow(sin(0.5 * PI * q / (SIDE + 1)), 2.0);
    const double mass = 1.0 + k / 12.0, omega = 0.11, h = 0.5, a = 3.0;
    struct matrices x = matrices_of(&g, 1); /* whose limit stays 0 */
    const size_t n = x.n;
    gsl_spmatrix_set(x.direction, 0, 0, 1.0);
    tribo_system *sys = create(&x);
    if (!sys) {
        return;
    }
    double *shape = malloc(2 * n * sizeof *shape), *force = shape + n, *y = calloc(2 * n + 1, sizeof *y), t = 0.0;
    for (size_t i = 0; i < n; i++) {
        shape[i] = sin(PI * p * (double)(i / SIDE + 1) / (SIDE + 1)) * sin(PI * q * (double)(i % SIDE + 1) / (SIDE + 1));
        force[i] = mass * shape[i];
        y[i] = a * shape[i];
    }
    assert_ok(tribo_system_add_load(sys, omega, force, NULL));
    tribo_driver *drv = driver_create(sys, "moreau/fixed", h, 0.0);
    driver_advance(drv, &t, h * STEPS, y);
    const double want = follow(a, (slow + fast * k) / mass, k / mass, omega, h, STEPS);
    for (size_t i = 0; i < n; i++) {
        require(fabs(y[i] - want * shape[i]) <= 1e-10 * fabs(want), "y[%zu] = %.15g, not %.15g", i, y[i], want * shape[i]);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    free(shape);
    free(y);
}
END_TEST

/* ------------------------------------------------------------------------------------------------------------ friction */

enum { LINKS = 3, CONTACTS = 2, FEW = 2 };

/* In each of the first copies: a contact of the first mass to the ground, and one between the others. */
static tribo_system *chains(size_t copies, double weight)
{
    const struct grid g = {1, LINKS, copies};
    const size_t touched = copies < FEW ? copies : FEW;
    struct matrices x = matrices_of(&g, CONTACTS * touched);
    double *force = calloc(x.n, sizeof *force), limit[CONTACTS * FEW];
    for (size_t c = 0; c < touched; c++) {
        gsl_spmatrix_set(x.direction, CONTACTS * c, LINKS * c, 1.0);
        gsl_spmatrix_set(x.direction, CONTACTS * c + 1, LINKS * c + 1, 1.0);
        gsl_spmatrix_set(x.direction, CONTACTS * c + 1, LINKS * c + 2, -1.0);
        limit[CONTACTS * c] = 0.3 * weight;
        limit[CONTACTS * c + 1] = 0.2 * weight;
        force[LINKS * c + 2] = 1.0;
    }
    tribo_system *sys = create(&x);
    if (sys) {
        assert_ok(tribo_system_add_load(sys, 0.9, NULL, force));
        assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    }
    free(force);
    return sys;
}

/* Each of many chains moves as one alone, of which a small system solves for the accelerations. */
TEST(chains_alike)
{
    enum { COPIES = 1001, STEPS = 400 };
    const double h = 0.05, weight = _i ? 4.0 : 1.0;
    tribo_system *many = chains(COPIES, weight), *one = chains(1, weight);
    if (!many) {
        tribo_system_destroy(one);
        return;
    }
    const size_t n = tribo_system_ndof(many);
    double *y = calloc(2 * n + 1, sizeof *y), small[2 * LINKS + 1] = {0.0}, t = 0.0, s = 0.0;
    tribo_driver *all = driver_create(many, "moreau/fixed", h, 0.0), *alone = driver_create(one, "moreau/fixed", h, 0.0);
    for (int k = 1; k <= STEPS; k++) {
        driver_advance(all, &t, h * k, y);
        driver_advance(alone, &s, h * k, small);
        for (size_t c = 0; c < FEW; c++) {
            assert_all_close(y + LINKS * c, small, LINKS, 1e-11);
            assert_all_close(y + n + LINKS * c, small + LINKS, LINKS, 1e-11);
        }
        assert_close(y[2 * n], FEW * small[2 * LINKS], 1e-11);
    }
    require(small[2 * LINKS] > 0.1, "nothing slipped: %g", small[2 * LINKS]);
    tribo_driver_destroy(all);
    tribo_driver_destroy(alone);
    tribo_system_destroy(many);
    tribo_system_destroy(one);
    free(y);
}
END_TEST

static tribo_system *copy_instead(tribo_system *sys)
{
    tribo_system *copy = NULL;
    assert_ok(tribo_system_clone(sys, &copy));
    tribo_system_destroy(sys);
    return copy;
}

/* The corner of a square pulled across its contact: displacement and energy after a while. Further contacts are open; of a system
 * that has them a copy is taken. */
static int pull(size_t contacts, double *corner, double *energy)
{
    const struct grid g = {60, 60, 1};
    struct matrices x = matrices_of(&g, contacts);
    double *force = calloc(x.n, sizeof *force), *limit = calloc(contacts, sizeof *limit);
    for (size_t i = 0; i < contacts; i++) {
        gsl_spmatrix_set(x.direction, i, 61 * i, 1.0);
    }
    force[1] = 1.0;
    limit[0] = 0.2;
    double *y = calloc(2 * x.n + 1, sizeof *y), t = 0.0;
    tribo_system *sys = create(&x);
    const int created = sys != NULL;
    if (created) {
        assert_ok(tribo_system_add_load(sys, 0.5, NULL, force));
        assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
        sys = contacts > 1 ? copy_instead(sys) : sys;
        tribo_driver *drv = driver_create(sys, "moreau/fixed", 0.1, 0.0);
        driver_advance(drv, &t, 40.0, y);
        *corner = y[0];
        *energy = y[tribo_system_dimension(sys) - 1];
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    free(force);
    free(limit);
    free(y);
    return created;
}

/* A step that solves once, and one that solves twice since it keeps no responses of so many contacts. */
TEST(many_contacts)
{
    double corner[2], energy[2];
    if (pull(1, &corner[0], &energy[0]) && pull(50, &corner[1], &energy[1])) {
        require(energy[0] > 0.05, "nothing slipped: %g", energy[0]);
        assert_close(corner[1], corner[0], 1e-11);
        assert_close(energy[1], energy[0], 1e-11);
    }
}
END_TEST

/* Whether the library has been built with CHOLMOD. */
static int has_sparse(void)
{
    const struct grid g = {1, 3001, 1};
    struct matrices x = matrices_of(&g, 1);
    tribo_system *sys = create(&x);
    tribo_system_destroy(sys);
    return sys != NULL;
}

/* ---------------------------------------------------------------------------------------------------- beside reduction */

/* The contact in a square in steps of moreau/fixed, as it is or reduced; the second contact is the load and stays open. */
static int follow_contact(size_t modes, size_t steps, double *place, double *energy)
{
    const struct grid g = {60, 60, 1};
    struct matrices x = matrices_of(&g, 2);
    const double h = 0.25, limit[2] = {0.2, 0.0};
    const size_t n = x.n, contact = 20 * 60 + 20, load = 30 * 60 + 30;
    char text[200] = "";
    double *force = calloc(n, sizeof *force), *y = calloc(2 * n + 1, sizeof *y), *full = calloc(n, sizeof *full), t = 0.0;
    gsl_spmatrix_set(x.direction, 0, contact, 1.0);
    gsl_spmatrix_set(x.direction, 1, load, 1.0);
    force[load] = 1.0;
    tribo_system *sys = NULL;
    const int status = modes ? reduced_system(&sys, x.mass, x.stiffness, x.direction, modes, 1, text, sizeof text)
                             : sparse_system(&sys, x.mass, NULL, x.stiffness, x.direction, 0, text, sizeof text);
    free_matrices(&x);
    require(status == TRIBO_OK || status == TRIBO_ERR_UNSUPPORTED, "%s", text);
    if (!status) {
        assert_ok(tribo_system_add_load(sys, 0.05, NULL, force));
        assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
        tribo_driver *drv = driver_create(sys, "moreau/fixed", h, 0.0);
        for (size_t k = 0; k < steps; k++) {
            driver_advance(drv, &t, h * (double)(k + 1), y);
            if (modes) {
                assert_ok(tribo_system_expand(sys, y, full));
            }
            place[k] = modes ? full[contact] : y[contact];
        }
        *energy = y[tribo_system_dimension(sys) - 1];
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    free(force);
    free(y);
    free(full);
    return status == TRIBO_OK;
}

/* What is not reduced moves as what is reduced to modes and static responses, the better the more modes. */
TEST(reduced_alike)
{
    enum { STEPS = 800 };
    static double whole[STEPS], few[STEPS], many[STEPS];
    double dissipated[3], size = 0.0, off[2] = {0.0, 0.0};
    if (!follow_contact(0, STEPS, whole, &dissipated[0]) || !follow_contact(10, STEPS, few, &dissipated[1]) ||
        !follow_contact(120, STEPS, many, &dissipated[2])) {
        return;
    }
    for (size_t k = 0; k < STEPS; k++) {
        size = fmax(size, fabs(whole[k]));
        off[0] = fmax(off[0], fabs(few[k] - whole[k]));
        off[1] = fmax(off[1], fabs(many[k] - whole[k]));
    }
    require(dissipated[0] > 0.01, "nothing slipped: %g", dissipated[0]);
    require(off[1] < 0.1 * size && off[1] < 0.5 * off[0], "off by %g and %g of %g", off[0], off[1], size);
    assert_close(dissipated[2], dissipated[0], 0.1 * dissipated[0]);
}
END_TEST

/* ------------------------------------------------------------------------------------------------------ diagonal masses */

/* The corner of a square with masses of its own at each place, numbered row by row or in strides, which makes a wide band. */
static double numbered(const char *method, size_t stride, double lopsided, double *energy)
{
    enum { SIDE = 60, N = SIDE * SIDE };
    const struct grid g = {SIDE, SIDE, 1};
    struct matrices x = matrices_of(&g, 1);
    gsl_spmatrix *k = gsl_spmatrix_alloc(N, N), *m = gsl_spmatrix_alloc(N, N), *c = gsl_spmatrix_alloc(N, N);
    double *force = calloc(N, sizeof *force), *y = calloc(2 * N + 1, sizeof *y), t = 0.0;
    for (size_t e = 0; e < x.stiffness->nz; e++) {
        const size_t i = (size_t)x.stiffness->i[e], j = (size_t)x.stiffness->p[e];
        gsl_spmatrix_set(k, i * stride % N, j * stride % N, x.stiffness->data[e]);
        gsl_spmatrix_set(c, i * stride % N, j * stride % N, 0.01 * x.stiffness->data[e] * (i < j ? 1.0 + lopsided : 1.0));
    }
    for (size_t i = 0; i < N; i++) {
        gsl_spmatrix_set(m, i * stride % N, i * stride % N, 1.0 + (double)(i % 3));
    }
    gsl_spmatrix_set(x.direction, 0, 0, 1.0);
    force[stride] = 1.0;
    tribo_system *sys;
    char text[200] = "";
    assert_ok(sparse_system(&sys, m, c, k, x.direction, 0, text, sizeof text));
    const double limit = 0.2;
    assert_ok(tribo_set_limit(tribo_system_context(sys), &limit));
    assert_ok(tribo_system_add_load(sys, 0.5, NULL, force));
    tribo_driver *drv = driver_create(sys, method, 0.1, 0.0);
    driver_advance(drv, &t, 20.0, y);
    *energy = y[2 * N];
    const double corner = y[0];
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    free_matrices(&x);
    gsl_spmatrix_free(k);
    gsl_spmatrix_free(m);
    gsl_spmatrix_free(c);
    free(force);
    free(y);
    return corner;
}

/* How degrees of freedom are numbered changes neither the motion nor what it takes. */
TEST(numbering)
{
    static const char *const method[] = {"central/fixed", "moreau/fixed"};
    double one, other;
    if (_i == 1 && !has_sparse()) {
        return;
    }
    assert_close(numbered(method[_i], 1567, 0.0, &other), numbered(method[_i], 1, 0.0, &one), 1e-11);
    require(one > 0.05, "nothing slipped: %g", one);
    assert_close(other, one, 1e-11);
}
END_TEST

/* Damping that is not symmetric has a band only. */
TEST(lopsided)
{
    double none, one;
    const double symmetric = numbered("moreau/fixed", 1, 1e-9, &none), other = numbered("moreau/fixed", 1, 0.5, &one);
    require(fabs(symmetric - other) > 1e-9, "damping did nothing: %.12g", other);
    assert_close(numbered("central/fixed", 1, 0.5, &none), other, 2e-2 * fabs(other));
    assert_close(none, one, 2e-2 * one);
}
END_TEST

/* ------------------------------------------------------------------------------------------------------------ refusals */

/* What takes accelerations is refused by name, and the state stays. */
TEST(refused)
{
    static const char *const part = "moreau/fixed, or tribo_system_reduce";
    const struct grid g = {1, 3001, 1};
    struct matrices x = matrices_of(&g, 1);
    gsl_spmatrix_set(x.direction, 0, 0, 1.0);
    const size_t n = x.n;
    tribo_system *sys = create(&x);
    if (!sys) {
        return;
    }
    tribo_driver *drv = NULL;
    for (int m = 0; m < any_method_count(); m++) {
        const char *name = any_method_name(m);
        if (strcmp(name, "moreau/fixed") != 0) {
            assert_status(set_up_driver(&drv, sys, name, 0.1, 1e-6, 1e-6), TRIBO_ERR_UNSUPPORTED);
            assert_says(tribo_system_message(sys), name);
            assert_says(tribo_system_message(sys), part);
        }
    }
    double *y = calloc(4 * n + 2, sizeof *y), *slope = y + 2 * n + 1, f;
    assert_status(tribo_system_contacts(sys, 0.0, y, NULL, NULL, &f), TRIBO_ERR_UNSUPPORTED);
    assert_status(tribo_system_accept(sys, 0.0, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_system_message(sys), part);
    const gsl_odeiv2_system *ode = tribo_gsl_system(sys);
    ck_assert_int_ne(ode->function(0.0, y, slope, ode->params), 0);
    ck_assert_int_ne(ode->jacobian(0.0, y, NULL, slope, ode->params), 0);
    assert_says(tribo_system_message(sys), part);
    tribo_system_destroy(sys);
    free(y);
}
END_TEST

/* Matrices that will not do: damping that is not symmetric, a mass matrix that is indefinite, and a step too long for a stiffness
 * that is. */
TEST(matrices)
{
    const struct grid g = {1, 3001, 1};
    struct matrices x = matrices_of(&g, 1);
    char text[200] = "";
    tribo_system *sys = NULL;
    double *y = calloc(2 * x.n + 1, sizeof *y), t = 0.0;
    gsl_spmatrix_set(x.direction, 0, 0, 1.0);
    gsl_spmatrix_set(x.damping, 7, 8, 0.5);
    const int status = sparse_system(&sys, x.mass, x.damping, x.stiffness, x.direction, 0, text, sizeof text);
    if (status == TRIBO_ERR_UNSUPPORTED) {
        assert_says(text, "TRIBO_SPARSE=ON");
    } else {
        assert_status(status, TRIBO_ERR_NOT_SYMMETRIC);
        assert_says(text, "damping[7][8] = 0.5");
        gsl_spmatrix_set(x.mass, 9, 9, -1.0);
        assert_status(sparse_system(&sys, x.mass, NULL, x.stiffness, x.direction, 0, text, sizeof text), TRIBO_ERR_INDEFINITE);
        assert_says(text, "mass is not positive definite");
        gsl_spmatrix_set(x.mass, 9, 9, 1.0);
        gsl_spmatrix_set(x.stiffness, 11, 11, -100.0);
        assert_ok(sparse_system(&sys, x.mass, NULL, x.stiffness, x.direction, 0, text, sizeof text));
        tribo_driver *drv = driver_create(sys, "moreau/fixed", 1.0, 0.0);
        assert_status(tribo_driver_advance(drv, &t, 1.0, y), TRIBO_ERR_INDEFINITE);
        assert_says(tribo_driver_message(drv), "the matrix of a step of length 1 is not positive definite");
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    free_matrices(&x);
    free(y);
}
END_TEST

TEST_MAIN("whole", {one_shape, 1}, {chains_alike, 2}, {many_contacts, 1}, {reduced_alike, 1}, {numbering, 2}, {lopsided, 1},
          {refused, 1}, {matrices, 1})
