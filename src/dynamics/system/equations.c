/* SPDX-License-Identifier: BSD-3-Clause */
/* The equations of motion of a system. */
#include "system.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void tribo_system_smooth(const tribo_system *sys, int order, double scale, const double *q, const double *u, const double *f,
                         double *to)
{
    memset(to, 0, sys->ndof * sizeof *to);
    tribo_system_loads(sys, DRIVES_LOAD, order, scale, to);
    tribo_matrix_multiply_add(&sys->stiffness, -1.0, q, to);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, u, to);
    }
    if (sys->compliance.count) {
        tribo_matrix_multiply_add(&sys->compliance.pull, 1.0, f, to);
    }
    if (sys->normals.count) {
        tribo_normals_push(sys, 0, order == 0, 1.0, q, to);
    }
}

void tribo_system_free_acceleration(tribo_system *sys, double t, const double *y, double *acceleration)
{
    tribo_system_set_time(sys, t);
    if (sys->compliance.count) {
        tribo_compliance_get(sys, y, sys->work.put_limit);
    }
    tribo_system_smooth(sys, 0, 1.0, y, y + sys->ndof, sys->work.put_limit, acceleration);
}

void tribo_system_free_motion(tribo_system *sys, double t, const double *y, double *acceleration, double *v, double *a)
{
    if (sys->normals.count) {
        tribo_system_set_time(sys, t);
        tribo_normals_set(sys, y, y + sys->ndof);
    }
    tribo_system_free_acceleration(sys, t, y, acceleration);
    tribo_matrix_multiply(&sys->direction, y + sys->ndof, v);
    tribo_matrix_multiply(&sys->direction, acceleration, a);
    if (tribo_system_bases_move(sys)) {
        tribo_system_loads(sys, DRIVES_BASE, 0, -1.0, v);
        tribo_system_loads(sys, DRIVES_BASE, 1, -1.0, a);
    }
}

/* f [ncontact]: sets the forces at normals, -N, of the motion set. */
static void equations_put_normals(const tribo_system *sys, double *f)
{
    for (size_t k = 0; k < sys->normals.count; k++) {
        const struct normal *n = &sys->normals.normal[k];
        f[n->row] = n->pressed ? -n->stiffness * n->depth : 0.0;
    }
}

int tribo_system_rates(tribo_system *sys, double t, const double *y, int accepted, double *acceleration, double *power)
{
    int law;
    tribo_get_law(sys->contacts, &law);
    accepted = accepted && law == TRIBO_QUINN_REVERSAL;
    sys->evaluations++;
    tribo_system_free_motion(sys, t, y, acceleration, sys->work.v, sys->work.a);
    sys->status = tribo_balance(sys->contacts, sys->work.v, sys->work.a, accepted ? sys->work.feq : NULL, sys->work.f);
    if (!sys->status) {
        /* f stays valid: where a reversal mark changes, both forms of the law give the same force */
        sys->status = accepted ? tribo_accept(sys->contacts, sys->work.v, sys->work.feq) : TRIBO_OK;
        *power = -tribo_dot_of_three(sys->ncontact, sys->tally, sys->work.f, sys->work.v);
        tribo_matrix_multiply_add(&sys->response, 1.0, sys->work.f, acceleration);
        if (sys->normals.count) {
            equations_put_normals(sys, sys->work.f);
        }
    }
    return tribo_system_explain(sys, sys->status);
}

int tribo_system_begin_rates(tribo_system *sys, const char *what, const double *y, const char *name, const double *to)
{
    int status = tribo_system_take_settings(sys);
    status = status ? status : tribo_system_check_mass(sys, what);
    status = status ? status : tribo_system_check_solved(sys, what);
    status = status ? status : tribo_system_check_given(sys, y, "y");
    return sys->status = status ? status : tribo_system_check_given(sys, to, name);
}

int tribo_system_derivative(tribo_system *sys, double t, const double *y, double *dydt)
{
    if (!sys || tribo_system_begin_rates(sys, "the right-hand side", y, "dydt", dydt)) {
        return sys ? sys->status : TRIBO_ERR_NULL;
    }
    const size_t n = sys->ndof;
    double power = 0.0;
    if (tribo_system_rates(sys, t, y, 0, sys->work.acceleration, &power)) {
        const int status = tribo_system_check_state(sys, t, y); /* names the value of y that is not finite */
        return sys->status = status ? status : sys->status;
    }
    memcpy(dydt, y + n, n * sizeof *dydt);
    memcpy(dydt + n, sys->work.acceleration, n * sizeof *dydt);
    dydt[2 * n] = power;
    return TRIBO_OK;
}

int tribo_system_get_force(const tribo_system *sys, double *f)
{
    const int status = tribo_system_check_given(sys, f, "f");
    if (!status) {
        memcpy(f, sys->work.f, sys->ncontact * sizeof *f);
    }
    return status;
}

/* --------------------------------------------------------------------------------------------------------------------- states */

/* Checks the caller's state *y; sets sys->work.v and sys->work.a, and *y = the methods' state. Returns a status. */
static int contacts_at(tribo_system *sys, double t, const double **y)
{
    const struct expansion *x = &sys->expansion;
    const double *own = x->place ? sys->work.motion : *y;
    int status = tribo_system_check_state(sys, t, *y);
    status = status ? status : tribo_system_take_settings(sys);
    status = status ? status : tribo_system_check_solved(sys, "the force of contacts");
    if (status) {
        return status;
    }
    if (x->place) {
        tribo_system_set_time(sys, t);
        tribo_system_read_state(sys, *y, sys->work.motion);
        tribo_normals_set(sys, own, own + sys->ndof);
        tribo_get_limit(sys->contacts, sys->work.a);
        tribo_compliance_enter(sys, sys->work.a, sys->work.feq, sys->work.motion);
    }
    tribo_system_free_motion(sys, t, own, sys->work.acceleration, sys->work.v, sys->work.a);
    if (x->sliders) {
        tribo_compliance_move(sys, own, sys->work.v, sys->work.feq);
    } else if (x->place) {
        tribo_system_add_velocities(sys, *y, sys->work.v);
    }
    for (size_t k = 0; k < sys->compliance.count; k++) { /* with R_ii = 0 and a_i = 0 a contact sticks where v_i = 0 */
        sys->work.a[sys->compliance.contact[k]] = 0.0;
    }
    *y = own;
    return TRIBO_OK;
}

int tribo_system_contacts(tribo_system *sys, double t, const double *y, double *v, double *feq, double *f)
{
    int status = sys ? contacts_at(sys, t, &y) : TRIBO_ERR_NULL;
    if (!status) {
        status = tribo_system_explain(sys, tribo_balance(sys->contacts, sys->work.v, sys->work.a, feq, f));
    }
    for (int k = 0; !status && k < 2; k++) {
        double *to = k ? feq : f;
        if (to) {
            equations_put_normals(sys, to);
        }
        for (size_t e = 0; to && e < sys->compliance.count; e++) { /* of compliant contacts, the forces in y */
            to[sys->compliance.contact[e]] = y[2 * sys->ndof + e];
        }
    }
    if (!status && v) {
        memcpy(v, sys->work.v, sys->ncontact * sizeof *v);
    }
    return status;
}

int tribo_system_accept(tribo_system *sys, double t, const double *y)
{
    int status = sys ? tribo_system_check_mass(sys, "this call") : TRIBO_ERR_NULL;
    status = status ? status : contacts_at(sys, t, &y);
    if (!status) {
        status = tribo_system_explain(sys, tribo_balance(sys->contacts, sys->work.v, sys->work.a, sys->work.feq, NULL));
    }
    return status ? status : tribo_system_explain(sys, tribo_accept(sys->contacts, sys->work.v, sys->work.feq));
}
