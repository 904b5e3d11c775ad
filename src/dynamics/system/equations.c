/* SPDX-License-Identifier: BSD-3-Clause */
/* The equations of motion of a system; creation and destruction of systems. */
#include "system.h"
#include "common/real.h"
#include "common/simd.h"
#include "common/zeros.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void tribo_system_free_acceleration(tribo_system *sys, double t, const double *y, double *acceleration)
{
    const size_t n = sys->ndof;
    if (!tribo_system_is_at(sys, t)) {
        tribo_system_set_time(sys, t);
    }
    memset(acceleration, 0, n * sizeof *acceleration);
    tribo_system_loads(sys, DRIVES_LOAD, 0, 1.0, acceleration);
    tribo_matrix_multiply_add(&sys->stiffness, -1.0, y, acceleration);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, y + n, acceleration);
    }
    if (sys->compliance.count) {
        tribo_compliance_get(sys, y, sys->work.put_limit);
        tribo_matrix_multiply_add(&sys->compliance.pull, 1.0, sys->work.put_limit, acceleration);
    }
}

void tribo_system_free_motion(tribo_system *sys, double t, const double *y, double *acceleration, double *v, double *a)
{
    tribo_system_free_acceleration(sys, t, y, acceleration);
    memset(v, 0, sys->ncontact * sizeof *v);
    memset(a, 0, sys->ncontact * sizeof *a);
    if (tribo_system_bases_move(sys)) {
        tribo_system_loads(sys, DRIVES_BASE, 0, -1.0, v);
        tribo_system_loads(sys, DRIVES_BASE, 1, -1.0, a);
    }
    tribo_matrix_multiply_add(&sys->direction, 1.0, y + sys->ndof, v);
    tribo_matrix_multiply_add(&sys->direction, 1.0, acceleration, a);
}

/* v and a of the contacts: arrays of the system, or, if J is the identity and bases do not move, of the motion. */
struct seen {
    const double *v, *a;
};

static struct seen see(tribo_system *sys, double t, const double *y, double *acceleration)
{
    if (tribo_system_bases_move(sys)) {
        tribo_system_free_motion(sys, t, y, acceleration, sys->work.v, sys->work.a);
        return (struct seen){sys->work.v, sys->work.a};
    }
    tribo_system_free_acceleration(sys, t, y, acceleration);
    return (struct seen){tribo_matrix_image(&sys->direction, y + sys->ndof, sys->work.v),
                         tribo_matrix_image(&sys->direction, acceleration, sys->work.a)};
}

enum { LANES = 8 }; /* partial sums: additions to a single sum wait for each other */

TRIBO_SIMD static double equations_power_of(size_t n, const double *restrict tally, const double *restrict f,
                                            const double *restrict v)
{
    double part[LANES] = {0.0}, sum = 0.0;
    size_t i = 0;
    for (; i + LANES <= n; i += LANES) {
        for (size_t k = 0; k < LANES; k++) {
            part[k] -= tally[i + k] * f[i + k] * v[i + k];
        }
    }
    for (; i < n; i++) {
        sum -= tally[i] * f[i] * v[i];
    }
    return sum + (((part[0] + part[4]) + (part[1] + part[5])) + ((part[2] + part[6]) + (part[3] + part[7])));
}

/* tribo_system_rates; accepted = 1: (t, y) is an accepted state of the reversal law. */
static int rates_at(tribo_system *sys, double t, const double *y, int accepted, double *acceleration, double *power)
{
    sys->evaluations++;
    const struct seen seen = see(sys, t, y, acceleration);
    sys->status = tribo_balance(sys->contacts, seen.v, seen.a, accepted ? sys->work.feq : NULL, sys->work.f);
    if (!sys->status) {
        /* f stays valid: where a reversal mark changes, both forms of the law give the same force */
        sys->status = accepted ? tribo_accept(sys->contacts, seen.v, sys->work.feq) : TRIBO_OK;
        *power = equations_power_of(sys->ncontact, sys->tally, sys->work.f, seen.v);
        tribo_matrix_multiply_add(&sys->response, 1.0, sys->work.f, acceleration);
    }
    return tribo_system_explain(sys, sys->status);
}

int tribo_system_rates(tribo_system *sys, double t, const double *y, double *acceleration, double *power)
{
    return rates_at(sys, t, y, 0, acceleration, power);
}

int tribo_system_begin_rates(tribo_system *sys, double t, const double *y, double *acceleration, double *power)
{
    int law;
    tribo_get_law(sys->contacts, &law);
    return rates_at(sys, t, y, law == TRIBO_QUINN_REVERSAL, acceleration, power);
}

/* Sets the rest of dydt, q' [ndof]. If J is the identity and bases do not move, also sys->work.v = q' for the driver. */
static void equations_complete(tribo_system *sys, const double *y, double *dydt)
{
    const double *u = y + sys->ndof;
    memcpy(dydt, u, sys->ndof * sizeof *dydt);
    if (sys->direction.identity && !tribo_system_bases_move(sys)) {
        memcpy(sys->work.v, u, sys->ncontact * sizeof *sys->work.v);
    }
}

int tribo_system_begin_step(tribo_system *sys, double t, const double *y, double *dydt)
{
    const size_t n = sys->ndof;
    equations_complete(sys, y, dydt);
    return tribo_system_begin_rates(sys, t, y, dydt + n, dydt + 2 * n);
}

int tribo_system_derivative(tribo_system *sys, double t, const double *y, double *dydt)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    const size_t n = sys->ndof;
    double power = 0.0;
    sys->status = tribo_system_take_settings(sys);
    sys->status = sys->status ? sys->status : tribo_system_check_rates(sys, "the right-hand side");
    if (!sys->status && (!y || !dydt)) {
        sys->status = tribo_system_fail(sys, TRIBO_ERR_NULL, "%s is NULL", y ? "dydt" : "y");
    }
    if (sys->status) {
        return sys->status;
    }
    if (tribo_system_rates(sys, t, y, sys->work.acceleration, &power)) {
        const int status = tribo_system_check_state(sys, t, y); /* names the value of y that is not finite */
        return sys->status = status ? status : sys->status;
    }
    equations_complete(sys, y, dydt);
    memcpy(dydt + n, sys->work.acceleration, n * sizeof *dydt);
    dydt[2 * n] = power;
    return TRIBO_OK;
}

int tribo_system_get_force(const tribo_system *sys, double *f)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (!f) {
        return tribo_system_fail(sys, TRIBO_ERR_NULL, "f is NULL");
    }
    memcpy(f, sys->work.f, sys->ncontact * sizeof *f);
    return TRIBO_OK;
}

/* --------------------------------------------------------------------------------------------------------------------- states */

/* Checks the caller's state *y; sets sys->work.v and sys->work.a, and *y = the methods' state. Returns a status. */
static int contacts_at(tribo_system *sys, double t, const double **y)
{
    int status = tribo_system_check_state(sys, t, *y);
    status = status ? status : tribo_system_take_settings(sys);
    status = status ? status : tribo_system_check_solved(sys, "the force of contacts");
    if (!status && sys->expansion.place) {
        tribo_system_set_time(sys, t);
        tribo_system_read_state(sys, *y, sys->work.motion);
        tribo_get_limit(sys->contacts, sys->work.a);
        tribo_compliance_enter(sys, sys->work.a, sys->work.feq, sys->work.motion);
    }
    if (!status) {
        tribo_system_free_motion(sys, t, sys->expansion.place ? sys->work.motion : *y, sys->work.acceleration, sys->work.v,
                                 sys->work.a);
    }
    if (!status && sys->expansion.sliders) {
        tribo_compliance_move(sys, sys->work.motion, sys->work.v, sys->work.feq);
    } else if (!status && sys->expansion.place) {
        tribo_system_add_velocities(sys, *y, sys->work.v);
    }
    for (size_t k = 0; !status && k < sys->compliance.count; k++) { /* with R_ii = 0 and a_i = 0 a contact sticks where v_i = 0 */
        sys->work.a[sys->compliance.contact[k]] = 0.0;
    }
    *y = sys->expansion.place ? sys->work.motion : *y;
    return status;
}

int tribo_system_contacts(tribo_system *sys, double t, const double *y, double *v, double *feq, double *f)
{
    int status = sys ? contacts_at(sys, t, &y) : TRIBO_ERR_NULL;
    if (!status) {
        status = tribo_system_explain(sys, tribo_balance(sys->contacts, sys->work.v, sys->work.a, feq, f));
    }
    for (size_t k = 0; !status && k < 2 * sys->compliance.count; k++) { /* of compliant contacts, the forces in y */
        double *to = k % 2 ? feq : f;
        if (to) {
            to[sys->compliance.contact[k / 2]] = y[2 * sys->ndof + k / 2];
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

/* ----------------------------------------------------------------------------------------------------------------------- life */

int tribo_system_build(tribo_system **sys, size_t ndof, size_t ncontact, struct matrix *stiffness, struct matrix *damping,
                       struct matrix *direction, struct matrix *response)
{
    tribo_system *s = tribo_zeros(1, sizeof *s);
    int status = s ? tribo_create(&s->contacts, ncontact) : TRIBO_ERR_MEMORY;
    double *work = status ? NULL : tribo_zeros(8 * (ncontact + 1) + ndof, sizeof *work);
    char *message = work ? tribo_zeros(TRIBO_MESSAGE, 1) : NULL;
    if (!message) {
        free(work);
        tribo_system_destroy(s);
        tribo_matrix_free(stiffness);
        tribo_matrix_free(damping);
        tribo_matrix_free(direction);
        tribo_matrix_free(response);
        return status ? status : TRIBO_ERR_MEMORY;
    }
    double **const part[] = {&s->work.v,         &s->work.a,     &s->work.f,
                             &s->work.feq,       &s->work.dv_dt, &s->loads.given_limit,
                             &s->work.put_limit, &s->tally,      &s->work.acceleration};
    for (size_t k = 0; k < sizeof part / sizeof *part; k++) {
        *part[k] = work + k * (ncontact + 1);
    }
    s->message = message;
    s->ndof = ndof;
    s->ncontact = ncontact;
    s->given = ndof;
    s->stiffness = *stiffness;
    s->damping = *damping;
    s->direction = *direction;
    s->response = *response;
    s->loads.time = NAN;
    for (size_t i = 0; i < ncontact; i++) {
        s->tally[i] = 1.0;
    }
    *sys = s;
    return TRIBO_OK;
}

/* Copies all that tribo_system_build does not set. Returns 1, or 0 if out of memory. */
static int copy_rest(tribo_system *to, const tribo_system *sys)
{
    tribo_destroy(to->contacts);
    to->contacts = NULL;
    to->revision = sys->revision;
    to->given = sys->given;
    to->unsolved = sys->unsolved;
    memcpy(to->loads.given_limit, sys->loads.given_limit, sys->ncontact * sizeof *to->loads.given_limit);
    to->copied = sys->copied;
    memcpy(to->tally, sys->tally, sys->ncontact * sizeof *to->tally);
    int done = 1;
    const size_t dofs = sys->expansion.place ? sys->expansion.dofs : sys->ndof;
    to->reduced.modes = tribo_copy_of(sys->reduced.modes, sys->given * dofs, sizeof *to->reduced.modes, &done);
    to->reduced.omega = tribo_copy_of(sys->reduced.omega, dofs, sizeof *to->reduced.omega, &done);
    to->reduced.truncation = sys->reduced.truncation;
    done = done && (!sys->lent || (tribo_clone(sys->lent, &to->lent) == TRIBO_OK && tribo_fix_operator(to->lent) == TRIBO_OK));
    return done && tribo_clone(sys->contacts, &to->contacts) == TRIBO_OK && tribo_matrix_copy(&to->k, &sys->k) &&
           tribo_matrix_copy(&to->c, &sys->c) && tribo_matrix_copy(&to->mass, &sys->mass) &&
           tribo_cholesky_copy(&to->factor, &sys->factor) && tribo_compliance_copy(to, sys) && tribo_expansion_copy(to, sys) &&
           tribo_loads_copy(to, sys);
}

int tribo_system_clone(const tribo_system *sys, tribo_system **copy)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (!copy) {
        return tribo_system_fail(sys, TRIBO_ERR_NULL, "copy is NULL");
    }
    tribo_system *to = NULL;
    struct matrix a[4] = {{0}};
    const struct matrix *from[] = {&sys->stiffness, &sys->damping, &sys->direction, &sys->response};
    int done = 1;
    for (size_t k = 0; done && k < 4; k++) {
        done = tribo_matrix_copy(&a[k], from[k]);
    }
    for (size_t k = 0; !done && k < 4; k++) {
        tribo_matrix_free(&a[k]);
    }
    done = done && tribo_system_build(&to, sys->ndof, sys->ncontact, &a[0], &a[1], &a[2], &a[3]) == TRIBO_OK;
    if (!done || !copy_rest(to, sys)) {
        tribo_system_destroy(to);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for a copy of %zu degree%s of freedom", sys->ndof,
                                 plural(sys->ndof));
    }
    *copy = to;
    return TRIBO_OK;
}

void tribo_system_destroy(tribo_system *sys)
{
    if (!sys) {
        return;
    }
    tribo_system_detach(sys);
    tribo_destroy(sys->contacts);
    tribo_destroy(sys->lent);
    free(sys->message);
    tribo_matrix_free(&sys->stiffness);
    tribo_matrix_free(&sys->damping);
    tribo_matrix_free(&sys->direction);
    tribo_matrix_free(&sys->response);
    tribo_loads_free(sys);
    tribo_matrix_free(&sys->k);
    tribo_matrix_free(&sys->c);
    tribo_matrix_free(&sys->mass);
    tribo_cholesky_free(&sys->factor);
    tribo_compliance_free(&sys->compliance);
    tribo_expansion_free(&sys->expansion);
    free(sys->reduced.modes);
    free(sys->reduced.omega);
    free(sys->work.v);
    free(sys->work.motion);
    free(sys);
}
