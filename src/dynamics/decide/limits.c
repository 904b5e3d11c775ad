/* SPDX-License-Identifier: BSD-3-Clause */
/* Limits above those to slide (tribo_set_static). A contact at rest holds up to state.stick; one that cannot breaks away: its
 * bound is the limit to slide, and all contacts are decided about again. A limit that falls with the speed (Stribeck) is
 *     N(|v|) = kinetic + (ratio - 1) kinetic exp(-|v|/velocity).
 * The exponential is smooth while the contact slides: the equations of motion contain it. */
#include "stick_slip.h"

#include <math.h>
#include <string.h>

void tribo_limits_start(struct stick_slip *m, tribo_system *sys)
{
    struct slip_limits *b = &m->limits;
    double *dof = m->work.rate, *slope = m->work.v;
    b->falls = tribo_system_falls(sys);
    b->differ = tribo_system_first_dropping(sys, 0) < sys->ncontact;
    b->steepest = 0.0;
    tribo_get_static(sys->contacts, b->ratio, b->velocity);
    if (b->falls) {
        /* the largest row sum of |J| |B| diag(slopes at rest), with the largest limits of all times */
        memset(dof, 0, sys->ndof * sizeof *dof);
        tribo_system_most_limits(sys, b->kinetic);
        for (size_t i = 0; i < sys->ncontact; i++) {
            slope[i] = quotient(product(b->ratio[i] - 1.0, b->kinetic[i]), b->velocity[i]);
        }
        tribo_matrix_add_sizes(&sys->response, slope, dof);
        memset(slope, 0, sys->ncontact * sizeof *slope);
        tribo_matrix_add_sizes(&sys->direction, dof, slope);
        b->steepest = tribo_largest(slope, sys->ncontact);
    }
}

void tribo_limits_take(struct stick_slip *m)
{
    struct slip_state *s = &m->state;
    for (size_t i = 0; i < m->constant.contacts; i++) {
        s->limit[i] = greater(s->limit[i], 0.0);
        m->limits.kinetic[i] = s->limit[i];
        m->limits.kinetic_rate[i] = s->limit_rate[i];
        tribo_limits_set_stick(m, i, m->limits.ratio[i]);
    }
}

void tribo_limits_set_stick(struct stick_slip *m, size_t i, double ratio)
{
    m->state.stick[i] = product(ratio, m->limits.kinetic[i]);
    m->state.stick_rate[i] = product(ratio, m->limits.kinetic_rate[i]);
}

void tribo_limits_fall(struct stick_slip *m, const tribo_system *sys, const double *y, const double *a)
{
    const struct slip_limits *b = &m->limits;
    for (size_t i = 0; i < m->constant.contacts; i++) {
        const signed char slip = m->state.slip[i];
        const double speed = slip ? fabs(tribo_stick_slip_velocity(m, sys, i, y)) : 0.0;
        const double more = (b->ratio[i] - 1.0) * exp(-quotient(speed, b->velocity[i]));
        m->state.limit[i] = product(1.0 + more, b->kinetic[i]);
        m->state.limit_rate[i] = product(1.0 + more, b->kinetic_rate[i]);
        if (a && slip) { /* as the contact gains speed */
            m->state.limit_rate[i] -= slip * a[i] * quotient(product(more, b->kinetic[i]), b->velocity[i]);
        }
    }
}
