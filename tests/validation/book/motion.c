/* SPDX-License-Identifier: BSD-3-Clause */
#include "book.h"

static int keep_moment(const tribo_moment *moment, void *data)
{
    struct motion *m = data;
    if (moment->kind != TRIBO_MOMENT_STEP) {
        const size_t k = m->count++ % MOST_MOMENTS;
        m->kind[k] = moment->kind;
        m->contact[k] = moment->contact;
        m->at[k] = moment->t;
        m->q[k] = moment->y[0];
    }
    return 0;
}

void motion_begin(struct motion *m, tribo_system *sys, const char *method)
{
    memset(m, 0, sizeof *m);
    m->sys = sys;
    need(tribo_driver_create(&m->drv, sys, method), tribo_system_message(sys));
    need(tribo_driver_set_observer(m->drv, keep_moment, m), method);
}

void motion_advance(struct motion *m, double t1, double *y)
{
    need(tribo_driver_advance(m->drv, &m->t, t1, y), tribo_driver_message(m->drv));
}

void motion_end(struct motion *m)
{
    tribo_driver_destroy(m->drv);
    tribo_system_destroy(m->sys);
}

void motion_find(struct motion *m, double period, double *y)
{
    memset(y, 0, tribo_system_dimension(m->sys) * sizeof *y);
    need(tribo_driver_find_periodic(m->drv, 0.0, period, y), tribo_driver_message(m->drv));
}

double motion_most(struct motion *m, const double *c)
{
    double least, most;
    need(tribo_driver_period_extremes(m->drv, c, &least, &most, NULL, NULL), tribo_driver_message(m->drv));
    return most;
}

tribo_system *dense(size_t ndof, size_t ncontact, const double *mass, const double *damping, const double *stiffness,
                    const double *direction, const double *compliance)
{
    tribo_model *model;
    tribo_system *sys;
    need(tribo_model_create(&model, ndof, ncontact), "model");
    need(tribo_model_set_mass_diagonal(model, mass), tribo_model_message(model));
    need(damping ? tribo_model_set_damping(model, damping) : TRIBO_OK, tribo_model_message(model));
    need(tribo_model_set_stiffness(model, stiffness), tribo_model_message(model));
    need(tribo_model_set_direction(model, direction), tribo_model_message(model));
    need(compliance ? tribo_model_set_compliance(model, compliance) : TRIBO_OK, tribo_model_message(model));
    need(tribo_system_create(&sys, model), tribo_model_message(model));
    tribo_model_destroy(model);
    return sys;
}

tribo_system *oscillator(double damping, double stiffness, double limit, double cosine, double sine, double omega)
{
    const double one = 1.0;
    tribo_system *sys = dense(1, 1, &one, &damping, &stiffness, &one, NULL);
    need(tribo_set_limit_all(tribo_system_context(sys), limit), "limit");
    need(tribo_system_add_load(sys, omega, &cosine, &sine), tribo_system_message(sys));
    return sys;
}
