/* SPDX-License-Identifier: BSD-3-Clause */
#include "make.h"
#include "model.h"

/* A = shift I + G'G/DOFS, exactly symmetric. */
static void definite(struct random *g, double shift, double *a)
{
    double x[DOFS * DOFS];
    for (size_t k = 0; k < DOFS * DOFS; k++) {
        x[k] = uniform(g, -1.0, 1.0);
    }
    multiply_transposed(DOFS, DOFS, DOFS, x, x, a);
    for (size_t k = 0; k < DOFS * DOFS; k++) {
        a[k] = a[k] / DOFS + (k % (DOFS + 1) ? 0.0 : shift);
    }
}

static void fill(struct random *g, double size, double *x, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        x[i] = uniform(g, -size, size);
    }
}

struct model model_create(struct random *g, int full)
{
    struct model m;
    definite(g, 0.5, m.mass);
    definite(g, 0.05, m.damping);
    definite(g, 0.5, m.stiffness);
    for (size_t k = 0; k < DOFS * DOFS; k++) {
        m.mass[k] = full || k % (DOFS + 1) == 0 ? m.mass[k] : 0.0;
        m.damping[k] *= 0.2;
        m.stiffness[k] *= 4.0;
    }
    fill(g, 1.0, m.direction, CONTACTS * DOFS);
    fill(g, 2.0, m.load[0], 2 * DOFS);
    fill(g, 0.5, m.motion[0], 2 * CONTACTS);
    m.load_omega = uniform(g, 0.5, 2.0);
    m.motion_omega = uniform(g, 0.5, 2.0);
    return m;
}

tribo_system *model_system(const struct model *m, int damped, size_t nmode, double epsilon)
{
    char text[200] = "";
    tribo_system *sys = NULL;
    const int status = dense_system(&sys, DOFS, CONTACTS, m->mass, damped ? m->damping : NULL, m->stiffness, m->direction, nmode,
                                    text, sizeof text);
    require(status == TRIBO_OK, "%d: %s", status, text);
    model_finish(m, sys, epsilon);
    return sys;
}

void model_finish(const struct model *m, tribo_system *sys, double epsilon)
{
    const double limit[CONTACTS] = {0.5, 1.0, 0.25};
    assert_ok(tribo_system_add_load(sys, m->load_omega, m->load[0], m->load[1]));
    assert_ok(tribo_system_add_base_motion(sys, m->motion_omega, m->motion[0], m->motion[1]));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), epsilon));
}

void multiply(size_t rows, size_t inner, size_t cols, const double *a, const double *b, double *c)
{
    for (size_t i = 0; i < rows * cols; i++) {
        c[i] = 0.0;
        for (size_t k = 0; k < inner; k++) {
            c[i] += a[i / cols * inner + k] * b[k * cols + i % cols];
        }
    }
}

void multiply_transposed(size_t rows, size_t inner, size_t cols, const double *a, const double *b, double *c)
{
    for (size_t i = 0; i < rows * cols; i++) {
        c[i] = 0.0;
        for (size_t k = 0; k < inner; k++) {
            c[i] += a[k * rows + i / cols] * b[k * cols + i % cols];
        }
    }
}

double form(const double *a, const double *x, const double *y)
{
    double ay[DOFS], sum = 0.0;
    multiply(DOFS, DOFS, 1, a, y, ay);
    for (size_t i = 0; i < DOFS; i++) {
        sum += x[i] * ay[i];
    }
    return sum;
}

void model_swing(tribo_system *sys, struct random *g, double *c, double *s)
{
    for (int k = 0; k < 2; k++) {
        for (size_t i = 0; i < CONTACTS; i++) {
            c[i] = uniform(g, -1.0, 1.0);
            s[i] = uniform(g, -1.0, 1.0);
        }
        assert_ok(tribo_system_add_limit(sys, k ? 1.7 : 0.6, c, s));
    }
}
