/* SPDX-License-Identifier: BSD-3-Clause */
/* Method "moreau/fixed": implicit midpoint rule for the structure, Coulomb's law over the step, mean of the loads at both ends
 * (Jean and Moreau 1992, theta = 1/2). The matrix of the structure is factorized once for each step length. Stable for any dt. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/system/delassus.h"
#include "fixed_steps.h"
#include "step_matrix.h"
#include "common/layout.h"
#include "common/real.h"

/* Data of steps of length h: matrix S = M + h/2 C + h^2/4 K, and contacts with the operator J S^-1 J'.
 *
 * A compliant contact has forces f0 and f1 at the ends of the step; (f0 + f1)/2 acts during the step. The contact slides by
 *     h J (u0 + u1)/2 + G (f1 - f0) - displacement of its base,   |f1| <= limit.
 * The context computes f1/2 within limit/2: 4 G/h^2 is added to its operator, J (u0 + u1) - 2 G f0/h replaces the velocity at the
 * end.
 *
 * A normal is pressed in a step if it is in the middle at constant velocity; then S has its stiffness. Limits that follow it are
 * those of the middle at constant velocity, of compliant contacts those of the end. */
struct moreau {
    struct step_form common;
    double h; /* prepared step length; 0: none */
    struct step_matrix matrix;
    int whole;               /* 1: contacts are ready; made at first need where the matrix holds bodies */
    size_t told;             /* TRIBO_COUNT_SETTINGS of the system's contacts as contacts took them; SIZE_MAX: never */
    double *limit;           /* [ncontact] limits in a step; limit/2 for compliant contacts */
    double *spring, *give;   /* [ncontact] forces f0 of compliant contacts; workspace, as G f0 */
    double *early, *late;    /* [ncontact] limits at the beginning and at the end of a step, if limits follow the motion */
    double *pressed;         /* [normals] 1: S has the normal */
    tribo_context *contacts; /* contacts with the operator of a step */
    size_t settings;         /* sys->settings.changes at the creation of contacts */
    size_t planar;           /* planar contacts of contacts */
};

static void moreau_destroy(tribo_driver *drv)
{
    struct moreau *m = drv->own;
    if (m) {
        tribo_destroy(m->contacts);
        free(m->common.memory);
        free(m->limit);
        tribo_step_matrix_free(&m->matrix);
        free(m);
    }
}

static int moreau_create(tribo_driver *drv)
{
    const size_t c = drv->sys->ncontact;
    struct moreau *m = calloc(1, sizeof *m);
    drv->own = m;
    if (!m || !tribo_step_form_create(&m->common, drv->sys) ||
        !ALLOCATE(ARRAY(m->limit, c), ARRAY(m->spring, c), ARRAY(m->give, c), ARRAY(m->late, c), ARRAY(m->early, c),
                  ARRAY(m->pressed, c))) {
        return tribo_error(drv->sys->message, TRIBO_ERR_MEMORY, "out of memory for method %s", drv->method->name);
    }
    return TRIBO_OK;
}

/* Sets the operator r. If r has lost light bodies to rounding, sets the operator of separate bodies, of a diagonal S, or refuses.
 * own: see tribo_hidden. Returns a status. */
static int set_operator(struct moreau *m, const tribo_system *sys, const double *r, const double *own, double h)
{
    const struct matrix *j = &sys->direction;
    struct hidden where;
    const int hidden = tribo_hidden(j, &sys->mass, own, r, &where);
    if (hidden < 0) {
        return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for the contacts of a step");
    }
    if (hidden && (m->matrix.below || m->matrix.above || sys->compliance.count)) {
        return tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                           "contact %zu touches bodies of which one gives way %g times as much as the other in steps of %g: %s",
                           where.contact, where.spread, h,
                           sys->unsolved ? "reduce the system" : "take central/fixed, event or exact");
    }
    for (size_t d = 0; hidden && d < sys->ndof; d++) {
        m->common.spare[d] = 1.0 / tribo_matrix_get(&m->matrix.s, d, d);
    }
    const int status = hidden ? tribo_set_operator_mass(m->contacts, sys->ndof, m->common.spare, j->first, j->col, j->val)
                              : tribo_set_operator_dense(m->contacts, r);
    return status ? tribo_error(sys->message, status, "in steps of %g, %s", h, tribo_message(m->contacts)) : TRIBO_OK;
}

/* Makes contacts with the operator J S^-1 J'. Returns a status. */
static int prepare_whole(struct moreau *m, const tribo_system *sys, double h)
{
    const size_t c = sys->ncontact;
    tribo_destroy(m->contacts);
    m->contacts = NULL;
    m->settings = sys->settings.changes;
    m->planar = tribo_system_planar(sys);
    m->told = SIZE_MAX;
    /* a clone is made again where settings change; the law of a context by create accepts all static limits */
    if (m->planar) {
        tribo_clone(sys->contacts, &m->contacts);
    } else {
        tribo_create(&m->contacts, c);
    }
    double *r = calloc(c * c + 1, sizeof *r), *own = malloc((sys->direction.first[c] + 1) * sizeof *own);
    const int done =
        r && own && m->contacts && tribo_delassus_by_columns(&sys->direction, tribo_step_matrix_solve, &m->matrix, r, own);
    if (done && !m->matrix.pivot) {
        tribo_even_out(c, r);
    }
    for (size_t k = 0; done && k < c * c; k++) {
        r[k] += 4.0 / (h * h) * tribo_compliance_entry(&sys->compliance, k / c, k % c);
    }
    const int status = done ? set_operator(m, sys, r, own, h)
                            : tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for the contacts of a step");
    free(r);
    free(own);
    m->whole = !status;
    return status;
}

/* Prepares steps of length h, if that is not done. Returns a status. */
static int moreau_prepare(struct moreau *m, const tribo_system *sys, double h)
{
    int same = 1;
    for (size_t k = 0; k < sys->normals.count; k++) {
        same &= m->pressed[k] == sys->normals.normal[k].pressed;
        m->pressed[k] = sys->normals.normal[k].pressed;
    }
    /* steps of equal length differ only by rounding of times */
    if (same && fabs(h - m->h) <= 1e-9 * h && m->common.revision == sys->revision &&
        (m->settings == sys->settings.changes || !(tribo_system_planar(sys) || m->planar))) {
        return TRIBO_OK;
    }
    m->h = 0.0;
    m->whole = 0;
    int status = tribo_step_matrix_create(&m->matrix, sys, h, !tribo_system_planar(sys) && !sys->normals.count);
    status = status || m->matrix.count ? status : prepare_whole(m, sys, h);
    if (!status) {
        m->h = h;
        m->common.revision = sys->revision;
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------------ a step */

/* s->a = impulse of loads, structure, and f0/2 of compliant contacts in a step; s->u = displacements in the middle of the step at
 * constant velocity. */
static void find_push(struct moreau *m, tribo_system *sys, double t, double next, const double *from)
{
    struct step_form *s = &m->common;
    const size_t n = sys->ndof;
    const double h = next - t, *u = from + n;
    double *p = s->a, *load = sys->unsolved ? p : s->spare;
    memset(load, 0, n * sizeof *load);
    tribo_system_set_time(sys, t);
    tribo_system_loads(sys, DRIVES_LOAD, 0, 0.5 * h, load);
    tribo_system_set_time(sys, next);
    tribo_system_loads(sys, DRIVES_LOAD, 0, 0.5 * h, load);
    for (size_t i = 0; i < n; i++) {
        s->u[i] = from[i] + 0.5 * h * u[i];
    }
    if (!sys->unsolved) {
        tribo_matrix_multiply(&sys->mass, load, p);
    }
    tribo_matrix_multiply_add(&sys->k, -h, s->u, p);
    tribo_matrix_multiply_add(&sys->c, -h, u, p);
    for (size_t k = 0; k < sys->compliance.count; k++) {
        const size_t i = sys->compliance.contact[k];
        tribo_matrix_add_row(&sys->direction, i, 0.5 * h * m->spring[i], p);
    }
    for (size_t k = 0; k < sys->normals.count; k++) {
        const struct normal *own = &sys->normals.normal[k];
        tribo_matrix_add_row(&sys->direction, own->row, own->pressed ? -h * own->stiffness * own->depth : 0.0, p);
    }
    sys->evaluations++;
}

/* Sets s->f, s->mode, and s->u = velocity at the end of the step, by the impulse s->a: by bodies held, or else by the operator of
 * contacts. Returns a status. */
static int moreau_respond(struct moreau *m, const tribo_system *sys, double h, const double *u)
{
    struct step_form *s = &m->common;
    const struct compliance *g = &sys->compliance;
    const struct band_step step = {h, m->limit, s->base, u, s->a, s->f};
    tribo_get_limit(sys->contacts, m->limit);
    for (size_t k = 0; k < g->count; k++) {
        const size_t i = g->contact[k];
        m->limit[i] = 0.5 * (sys->normals.count ? m->late[i] : m->limit[i]);
    }
    const int held = tribo_step_matrix_hold(&m->matrix, sys, &step);
    int status = held || m->whole ? TRIBO_OK : prepare_whole(m, sys, h);
    if (status) {
        return status;
    }
    if (!held) {
        tribo_step_matrix_solve(&m->matrix, 1, s->a);
    }
    memcpy(s->u, u, sys->ndof * sizeof *u);
    tribo_add(s->u, 1.0, s->a, sys->ndof);
    if (held) {
        memcpy(s->mode, m->matrix.at, sys->ncontact);
        return tribo_dense_finite(s->f, sys->ncontact) ? TRIBO_OK : TRIBO_ERR_NOT_FINITE;
    }
    size_t settings = 0;
    tribo_get_count(sys->contacts, TRIBO_COUNT_SETTINGS, &settings); /* limits that vary with time count */
    if (m->told != settings) {
        double *ratio = m->give, *velocity = s->end;
        tribo_get_static(sys->contacts, ratio, velocity);
        tribo_set_limit(m->contacts, m->limit);
        tribo_set_static(m->contacts, ratio, tribo_system_falls(sys) ? velocity : NULL);
        m->told = settings;
    }
    tribo_step_form_relative(s, sys, s->u, s->end);
    tribo_compliance_give(sys, 1, m->spring, m->give);
    for (size_t k = 0; k < g->count; k++) {
        const size_t i = g->contact[k];
        s->end[i] += s->v[i] - 2.0 / h * m->give[i];
    }
    status = tribo_step_form_force(s, sys, m->contacts, h);
    if (!status) {
        memset(s->spare, 0, sys->ndof * sizeof *s->spare); /* h S^-1 J' f */
        for (size_t i = 0; i < sys->ncontact; i++) {
            tribo_matrix_add_row(&sys->direction, i, h * s->f[i], s->spare);
        }
        tribo_step_matrix_solve(&m->matrix, 1, s->spare);
        tribo_add(s->u, 1.0, s->spare, sys->ndof);
        tribo_get_slip(m->contacts, s->mode);
    }
    return status;
}

/* Sets late, and the motion of the normals in the middle of a step from `from` at t, at constant velocity. */
static void foresee_normals(struct moreau *m, tribo_system *sys, double t, double h, const double *from)
{
    const size_t n = sys->ndof;
    for (int part = 2; sys->normals.count && part > 0; part--) {
        tribo_system_set_time(sys, t + 0.5 * part * h);
        memcpy(m->common.u, from, n * sizeof *from);
        tribo_add(m->common.u, 0.5 * part * h, from + n, n);
        tribo_normals_set(sys, m->common.u, from + n);
        if (part == 2) {
            tribo_get_limit(sys->contacts, m->late);
        }
    }
}

/* Sets the forces of compliant contacts in y = f1; s->end and s->f = velocity and force of which friction has its power: (v +
 * end)/2 is the velocity of sliding. */
static void end_springs(struct moreau *m, const tribo_system *sys, double h, double *y)
{
    struct step_form *s = &m->common;
    const struct compliance *g = &sys->compliance;
    for (size_t k = 0; k < g->count; k++) {
        y[2 * sys->ndof + k] = 2.0 * s->f[g->contact[k]];
        m->spring[g->contact[k]] = y[2 * sys->ndof + k] - m->spring[g->contact[k]];
    }
    tribo_compliance_give(sys, 1, m->spring, m->give);
    for (size_t k = 0; k < g->count; k++) {
        const size_t i = g->contact[k];
        const double slides = s->v[i] + s->end[i] + 2.0 / h * m->give[i];
        s->end[i] = (s->mode[i] != TRIBO_SLIP_STUCK && s->f[i] * slides < 0.0 ? slides : 0.0) - s->v[i];
        s->f[i] *= 2.0;
        if (sys->normals.count) { /* the work of a contact that slides all the step */
            s->f[i] = copysign(0.5 * (m->early[i] + m->late[i]), -slides);
        }
    }
}

static int moreau_step(tribo_driver *drv, double t, double next, const double *from, double *y)
{
    struct moreau *m = drv->own;
    struct step_form *s = &m->common;
    tribo_system *sys = drv->sys;
    const struct compliance *g = &sys->compliance;
    const size_t n = sys->ndof, energy = tribo_system_energy(sys);
    const double h = next - t, *u = from + n;
    if (g->count) {
        if (sys->normals.count) {
            tribo_system_set_time(sys, t);
            tribo_normals_set(sys, from, u);
        }
        memcpy(y, from, tribo_system_size(sys) * sizeof *y);
        tribo_get_limit(sys->contacts, m->early);
        tribo_compliance_enter(sys, m->early, m->spring, y);
        from = y;
        u = from + n;
    }
    foresee_normals(m, sys, t, h, from);
    int status = moreau_prepare(m, sys, h);
    if (status) {
        return tribo_driver_pass(drv, status);
    }
    tribo_step_form_velocity(s, sys, t, u, s->v);
    find_push(m, sys, t, next, from);
    tribo_step_form_find_base(s, sys, next);
    if (tribo_system_limits_vary(sys)) {
        tribo_system_set_time(sys, t + 0.5 * h);
    }
    status = moreau_respond(m, sys, h, u);
    if (status) {
        return tribo_step_form_fail(drv, status, t, m->whole ? tribo_message(m->contacts) : tribo_system_message(sys));
    }
    tribo_system_snap(sys, s->mode, s->base, s->u);
    tribo_step_form_relative(s, sys, s->u, s->end);
    for (size_t i = 0; i < n; i++) {
        y[i] = from[i] + 0.5 * h * (u[i] + s->u[i]);
        y[n + i] = s->u[i];
    }
    if (g->count) {
        end_springs(m, sys, h, y);
    }
    y[energy] = from[energy] + h * tribo_step_form_power(s, sys);
    return tribo_driver_check(drv, y);
}

static int moreau_advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    (void)continues;
    return tribo_driver_fixed_steps(drv, t, t1, y, moreau_step, NULL);
}

const struct method tribo_method_moreau_fixed = {.name = "moreau/fixed",
                                                 .takes = TAKES_STEP | TAKES_UNSOLVED,
                                                 .create = moreau_create,
                                                 .destroy = moreau_destroy,
                                                 .advance = moreau_advance};
