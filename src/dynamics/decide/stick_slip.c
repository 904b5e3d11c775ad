/* SPDX-License-Identifier: BSD-3-Clause */
/* What contacts do at an instant: limits and bases, which contacts are at rest, velocities and accelerations, and bounds of their
 * rounding. The decision:
 *
 *     contacts without velocity, or with none left in the direction of their slip, are at rest
 *     the forces decide which of them slide (scalar_slip.c; planar_slip.c if there are planar contacts)
 *     an independent set of the contacts at rest holds: it keeps all of them where they are */
#include "numerics/constraint.h"
#include "stick_slip.h"
#include "common/layout.h"
#include "numerics/csr.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Rounding of an acceleration, in parts of the sum of the sizes of its terms. */
#define NOISE 2e-14

/* The horizon, in parts of one over the highest frequency: changes until then are nearly linear in time, and mostly far above
 * noise. */
#define LOOK_AHEAD 1e-4

/* ------------------------------------------------------------------------------------------------------------ constants */

/* Contexts that know J and M only. Where R is diagonal forces are found without them: there is no constant.hold, and without
 * planar contacts no constant.box. */
static int create_contexts(struct slip_constant *c, const tribo_context *contacts)
{
    size_t islands;
    tribo_get_count(contacts, TRIBO_COUNT_ISLANDS, &islands);
    if (islands < c->contacts) { /* joined by R, or by planar contacts */
        if (tribo_clone(contacts, &c->box)) {
            return 0;
        }
        tribo_set_planar(c->box, 0, NULL);
        tribo_get_count(c->box, TRIBO_COUNT_ISLANDS, &islands);
    }
    c->uncoupled = islands == c->contacts;
    if (c->uncoupled) {
        return 1;
    }
    tribo_set_static(c->box, NULL, NULL);
    if (tribo_clone(c->box, &c->hold)) {
        return 0;
    }
    /* a contact that has reached its limit stays there while others take over */
    tribo_set_sharing(c->box, TRIBO_SHARE_PREVIOUS);
    tribo_set_law(c->hold, TRIBO_COULOMB);
    tribo_set_coupling(c->hold, TRIBO_PARTITION);
    return 1;
}

/* Fills R_ii, 1/R_ii and elastic[]; sets independent; lists the snaps of all rigid contacts. Returns 0 if out of
 * memory. */
static int find_constants(struct stick_slip *m, const tribo_system *sys)
{
    struct slip_constant *c = &m->constant;
    struct constraints ties = {0};
    size_t *rigid = m->work.at, count = 0;
    int in_order = sys->snaps.in_order; /* row by row, J has a degree of freedom that no row before has, with no loss of digits */
    for (size_t i = 0; i < c->contacts; i++) {
        c->diagonal[i] = tribo_system_delassus(sys, i, i);
        c->inertia[i] = c->diagonal[i] > 0.0 ? quotient(1.0, c->diagonal[i]) : 0.0;
        c->elastic[i] = (unsigned char)tribo_is_compliant(&sys->compliance, i);
        m->state.loose[i] = (signed char)c->elastic[i];
        rigid[count] = i;
        count += !c->elastic[i];
        in_order &= c->diagonal[i] > 0.0;
    }
    m->state.snaps = tribo_system_list_snaps(sys, m->state.loose, m->state.snap);
    m->state.simple = m->state.snaps == count;
    if (c->uncoupled || (in_order && m->state.simple)) {
        c->independent = 1;
    } else if (tribo_constraints_create(&ties, &sys->direction, &sys->mass, rigid, count, m->work.last)) {
        c->independent = ties.rank == count;
    } else {
        tribo_constraints_free(&ties);
        return 0;
    }
    tribo_constraints_free(&ties);
    for (size_t i = 0; c->independent && i < c->contacts; i++) {
        tribo_stick_slip_set_hold(m, i, tribo_can_hold(m, i));
    }
    return 1;
}

int tribo_stick_slip_create(struct stick_slip *m, tribo_system *sys)
{
    const size_t n = sys->ncontact + 1, dofs = sys->ndof;
    struct slip_constant *c = &m->constant;
    struct slip_state *s = &m->state;
    struct slip_noise *r = &m->noise;
    struct slip_work *w = &m->work;
    struct slip_limits *b = &m->limits;
    *m = (struct stick_slip){.constant = {.sys = sys, .contacts = sys->ncontact},
                             .noise = {.factor = 1.0, .founds = 3 * n + dofs}};
    /* r->acceleration to r->size are zeroed together */
    c->memory = ALLOCATE(ARRAY(c->diagonal, n), ARRAY(c->inertia, n), ARRAY(c->still, n), ARRAY(c->swing, n),
                         ARRAY(c->base_size, n), ARRAY(c->base_rate_size, n), ARRAY(s->limit, n), ARRAY(s->limit_rate, n),
                         ARRAY(s->force, n), ARRAY(s->spring, n), ARRAY(s->spring_rate, n), ARRAY(s->base, n), ARRAY(s->glide, n),
                         ARRAY(r->velocity, n), ARRAY(r->velocity_scale, n), ARRAY(r->spring, n), ARRAY(r->parting, n),
                         ARRAY(w->a, n), ARRAY(w->v, n), ARRAY(w->lo, n), ARRAY(w->hi, n), ARRAY(w->f, n), ARRAY(b->ratio, n),
                         ARRAY(b->velocity, n), ARRAY(b->kinetic, n), ARRAY(b->kinetic_rate, n), ARRAY(s->stick, n),
                         ARRAY(s->stick_rate, n), ARRAY(r->acceleration, n), ARRAY(r->allowance, n), ARRAY(r->excess, n),
                         ARRAY(r->size, dofs), ARRAY(c->load_size, dofs), ARRAY(w->acceleration, dofs), ARRAY(w->free, dofs),
                         ARRAY(w->rate, dofs), ARRAY(s->slip, n), ARRAY(s->tied, n), ARRAY(s->before, n), ARRAY(s->loose, n),
                         ARRAY(s->slid, n), ARRAY(w->pulled, n), ARRAY(s->key, n + sizeof(uint64_t)), ARRAY(s->holds, n),
                         ARRAY(s->rested, n), ARRAY(c->elastic, n), ARRAY(c->pair, n), ARRAY(w->last, n), ARRAY(s->pressed, n),
                         ARRAY(s->was_pressed, n), ARRAY(s->rests, n), ARRAY(w->at, n), ARRAY(w->doubt, n), ARRAY(s->snap, n));
    if (c->memory && create_contexts(c, sys->contacts) && find_constants(m, sys)) {
        return TRIBO_OK;
    }
    tribo_stick_slip_free(m);
    return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s", sys->ncontact, plural(sys->ncontact));
}

void tribo_stick_slip_free(struct stick_slip *m)
{
    tribo_destroy(m->constant.box);
    tribo_destroy(m->constant.hold);
    tribo_planar_slip_free(m->plane);
    free(m->constant.memory);
    memset(m, 0, sizeof *m);
}

/* ------------------------------------------------------------------------------------------------------------ rounding */

/* y += amplitudes of b(t), or of the harmonics of the load; order 1: of their rates. */
static void add_amplitudes(const tribo_system *sys, enum drives drives, int order, double *y)
{
    for (size_t s = 0; s < sys->loads.harmonics; s++) {
        const struct harmonic *w = &sys->loads.harmonic[s];
        double most = w->knots ? 0.0 : order ? fabs(w->omega) : 1.0;
        for (size_t k = order ? 1 : 0; drives == DRIVES_BASE && k < w->knots; k++) {
            const double rise = order ? (w->value[k] - w->value[k - 1]) / (w->knot[k] - w->knot[k - 1]) : w->value[k];
            most = greater(most, fabs(rise));
        }
        for (size_t k = 0; w->drives == drives && k < w->count; k++) {
            y[w->index[k]] += most * (fabs(w->cosine[k]) + fabs(w->sine[k]));
        }
    }
}

/* Sets horizon, base_moves, base_size, base_rate_size and load_size. */
static void find_scales(struct stick_slip *m, const tribo_system *sys)
{
    struct slip_constant *k = &m->constant;
    const size_t c = sys->ncontact;
    const double fastest = tribo_system_fastest(sys) + m->limits.steepest;
    k->horizon = LOOK_AHEAD / (fastest > 0.0 ? fastest : 1.0);
    memset(k->base_size, 0, c * sizeof *k->base_size);
    memset(k->base_rate_size, 0, c * sizeof *k->base_rate_size);
    memset(k->load_size, 0, sys->ndof * sizeof *k->load_size);
    add_amplitudes(sys, DRIVES_BASE, 0, k->base_size);
    add_amplitudes(sys, DRIVES_BASE, 1, k->base_rate_size);
    add_amplitudes(sys, DRIVES_LOAD, 0, k->load_size);
    /* t is known to its rounding. Of contacts that depend on each other one follows its base, and the others see its
     * rounding. */
    const double late = DBL_EPSILON * fabs(sys->loads.time) / TRIBO_VELOCITY_NOISE;
    for (size_t i = 0; i < c; i++) {
        k->base_size[i] += late * k->base_rate_size[i];
    }
    const double largest = tribo_largest(k->base_size, c);
    k->base_moves = largest > 0.0;
    for (size_t i = 0; !k->independent && i < c; i++) {
        k->base_size[i] = largest;
    }
}

static void forget_gains(struct stick_slip *m)
{
    memset(m->noise.acceleration, 0, m->noise.founds * sizeof *m->noise.acceleration);
}

/* Returns noise.size[d], the size of the terms of q''_d; finds it first if it is 0. */
static inline double find_size(struct stick_slip *m, const tribo_system *sys, const double *y, size_t d)
{
    if (m->noise.size[d] > 0.0) {
        return m->noise.size[d];
    }
    double size = m->constant.load_size[d] + tribo_matrix_row_size(&sys->stiffness, d, y) +
                  tribo_matrix_row_size(&sys->response, d, m->state.force);
    for (size_t s = 0; sys->loads.tables && s < sys->loads.harmonics; s++) {
        const struct harmonic *w = &sys->loads.harmonic[s];
        const size_t all[] = {0, w->drives == DRIVES_LOAD && w->knots ? w->count : 0}, at = tribo_rows_find(all, w->index, 0, d);
        size += at < w->count ? fabs(w->cosine[at] * w->cos_t) : 0.0;
    }
    for (size_t k = 0; k < sys->normals.count; k++) {
        const struct normal *n = &sys->normals.normal[k];
        size += fabs(tribo_matrix_get(&sys->response, d, n->row)) * n->stiffness * n->size;
    }
    size += sys->damping.rows ? tribo_matrix_row_size(&sys->damping, d, y + sys->ndof) : 0.0;
    size += sys->compliance.count ? tribo_matrix_row_size(&sys->compliance.pull, d, m->state.spring) : 0.0;
    return m->noise.size[d] = size;
}

double tribo_stick_slip_acceleration_size(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    double size = 0.0;
    for (size_t d = 0; d < sys->ndof; d++) {
        size = greater(size, find_size(m, sys, y, d));
    }
    return size;
}

void tribo_stick_slip_find_gain(struct stick_slip *m, const tribo_system *sys, const double *y, size_t i)
{
    const struct matrix *j = &sys->direction;
    double size = 0.0;
    if (m->noise.acceleration[i] > 0.0) {
        return;
    }
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        size += fabs(j->val[k] * find_size(m, sys, y, j->col[k]));
    }
    m->noise.velocity[i] = tribo_stick_slip_velocity_noise(m, i, tribo_matrix_row_size(j, i, y + sys->ndof));
    m->noise.acceleration[i] = NOISE * m->noise.factor * (m->constant.base_rate_size[i] + size);
    m->noise.allowance[i] = TRIBO_ALLOWED * m->noise.acceleration[i] * m->constant.inertia[i];
    if (m->constant.swing[i] > 0.0) {
        m->noise.allowance[i] += TRIBO_LIMIT_NOISE * m->noise.factor * m->limits.ratio[i] * m->constant.swing[i];
    }
    if (m->constant.base_moves) {
        m->noise.parting[i] =
            greater(4.0 * m->noise.factor * m->noise.velocity[i], m->noise.acceleration[i] * m->constant.horizon / LOOK_AHEAD);
    }
}

void tribo_stick_slip_find_gains(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    for (size_t i = 0; i < sys->ncontact; i++) {
        tribo_stick_slip_find_gain(m, sys, y, i);
    }
}

/* -------------------------------------------------------------------------------------------------- one contact, as decided */

double tribo_stick_slip_follows(const struct stick_slip *m, size_t i)
{
    if (m->state.slip[i] == TRIBO_SLIP_STUCK) {
        const double ratio = m->limits.ratio[i];
        return m->state.holds[i] || !m->state.tied[i] ? 0.0 : m->state.force[i] > 0.0 ? ratio : -ratio;
    }
    return m->state.slip[i] == TRIBO_SLIP_OPEN ? 0.0 : -m->state.slip[i];
}

/* -------------------------------------------------------------------------------------------------------------- motion */

void tribo_stick_slip_contact_accelerations(const tribo_system *sys, const double *acceleration, int order, double *to)
{
    tribo_matrix_multiply(&sys->direction, acceleration, to);
    if (tribo_system_bases_move(sys)) {
        tribo_system_loads(sys, DRIVES_BASE, order, -1.0, to);
    }
}

void tribo_stick_slip_find_rate(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    if (sys->damping.rows) {
        memcpy(m->work.acceleration, m->work.free, sys->ndof * sizeof *m->work.free);
        tribo_matrix_multiply_add(&sys->response, 1.0, m->state.force, m->work.acceleration);
    }
    tribo_system_smooth(sys, 1, 1.0, y + sys->ndof, m->work.acceleration, m->state.spring_rate, m->work.rate);
}

void tribo_stick_slip_accelerate(struct stick_slip *m, const tribo_system *sys, const double *a, const double *f, double *v)
{
    /* J (M^-1 J' f) in the place of R f: rounding of R may hide a heavy body, that of its factors does not */
    tribo_matrix_multiply(&sys->response, f, m->work.rate);
    memmove(v, a, m->constant.contacts * sizeof *v);
    tribo_matrix_multiply_add(&sys->direction, 1.0, m->work.rate, v);
}

/* Sets state.base = b(t). It stays zero if no base moves. */
static void find_base(struct stick_slip *m, const tribo_system *sys)
{
    if (tribo_system_bases_move(sys)) {
        memset(m->state.base, 0, sys->ncontact * sizeof *m->state.base);
        tribo_system_loads(sys, DRIVES_BASE, 0, 1.0, m->state.base);
    }
}

int tribo_stick_slip_acceleration(struct stick_slip *m, tribo_system *sys, double t, const double *y, double *acceleration,
                                  double *force)
{
    const struct slip_state *s = &m->state;
    const size_t c = sys->ncontact;
    tribo_stick_slip_press(m, sys);
    tribo_system_free_acceleration(sys, t, y, acceleration);
    find_base(m, sys);
    if (sys->compliance.count) {
        tribo_elastic_find(m, sys, y);
    }
    if (tribo_system_limits_vary(sys)) {
        tribo_normals_move(sys, y, y + sys->ndof);
        tribo_system_limits(sys, s->limit, s->limit_rate);
        tribo_limits_take(m);
    }
    if (m->limits.falls) {
        tribo_limits_fall(m, sys, y, NULL);
    }
    for (size_t i = 0; i < c; i++) {
        const double follows = m->constant.swing[i] > 0.0 ? tribo_stick_slip_follows(m, i) : 0.0;
        force[i] = !s->loose[i]                     ? 0.0
                   : s->slip[i] == TRIBO_SLIP_OPEN  ? 0.0
                   : m->constant.pair[i]            ? s->spring[i]
                   : s->slip[i] != TRIBO_SLIP_STUCK ? -s->slip[i] * s->limit[i]
                   : follows != 0.0                 ? follows * m->limits.kinetic[i]
                   : m->constant.elastic[i]         ? s->spring[i]
                                                    : s->force[i];
    }
    if (m->plane) {
        tribo_planar_slip_forces(m, sys, y, force);
    }
    tribo_matrix_multiply_add(&sys->response, 1.0, force, acceleration);
    tribo_stick_slip_contact_accelerations(sys, acceleration, 1, m->work.v);
    const int status = tribo_stick_slip_balance(m, m->work.v, m->work.f);
    tribo_matrix_multiply_add(&sys->response, 1.0, m->work.f, acceleration);
    tribo_add(force, 1.0, m->work.f, c);
    return status;
}

/* ---------------------------------------------------------------------------------------------------------------- rest */

/* The slip of contact i by its velocity in y. */
static signed char slip_of(struct stick_slip *m, const tribo_system *sys, size_t i, const double *y)
{
    const double v = tribo_stick_slip_find_velocity(m, sys, i, y), noise = m->noise.factor * m->noise.velocity[i];
    return (signed char)(fabs(v) <= noise ? TRIBO_SLIP_STUCK : v > 0.0 ? TRIBO_SLIP_FORTH : TRIBO_SLIP_BACK);
}

void tribo_stick_slip_press(const struct stick_slip *m, tribo_system *sys)
{
    for (size_t k = 0; k < sys->normals.count; k++) {
        sys->normals.normal[k].pressed = m->state.pressed[k];
    }
}

/* Presses normals at depth 0 that do not move by their acceleration, with the forces of contacts of the last decision, if the
 * acceleration is more than rounding; else a normal leaves its side if its depth ended the phase, and is open if not. */
static void press_by_acceleration(struct stick_slip *m, tribo_system *sys, const double *y)
{
    const struct matrix *j = &sys->direction;
    double *size = m->work.rate, *acceleration = m->work.free;
    tribo_system_free_acceleration(sys, sys->loads.time, y, acceleration);
    memcpy(size, acceleration, sys->ndof * sizeof *size);
    tribo_matrix_multiply_add(&sys->response, 1.0, m->state.force, acceleration);
    for (size_t k = 0; k < sys->normals.count; k++) {
        struct normal *n = &sys->normals.normal[k];
        if (m->state.rests[k]) {
            const double order = tribo_matrix_row_dot(j, n->row, acceleration);
            const double rounding = NOISE * m->noise.factor * tribo_matrix_row_size(j, n->row, size);
            const int leaves = n->row == m->state.reached && !m->state.was_pressed[k];
            n->pressed = fabs(order) > rounding ? order > 0.0 : leaves;
        }
    }
}

/* Sets which normals are pressed just after the set time: by the lowest derivative of the depth that is more than rounding. Sets
 * swing = size of the terms of limits that follow. Returns the number of normals by the acceleration. */
static size_t press(struct stick_slip *m, tribo_system *sys, const double *y)
{
    const struct matrix *j = &sys->direction;
    const double factor = m->noise.factor;
    size_t resting = 0;
    tribo_normals_move(sys, y, y + sys->ndof);
    for (size_t k = 0; k < sys->normals.count; k++) {
        struct normal *n = &sys->normals.normal[k];
        const int at_zero = n->row == m->state.reached || fabs(n->depth) <= TRIBO_LIMIT_NOISE * factor * n->size;
        const double still = TRIBO_VELOCITY_NOISE * factor * tribo_matrix_row_size(j, n->row, y + sys->ndof);
        const double order = at_zero ? n->speed : n->depth;
        n->depth = at_zero ? 0.0 : n->depth;
        m->state.rests[k] = at_zero && fabs(order) <= still;
        n->pressed = order > 0.0 && !m->state.rests[k];
        resting += m->state.rests[k];
        m->constant.swing[n->row] = greater(n->stiffness * n->size, DBL_MIN);
    }
    if (resting) {
        press_by_acceleration(m, sys, y);
    }
    for (size_t k = 0; k < sys->normals.count; k++) {
        m->state.pressed[k] = (unsigned char)sys->normals.normal[k].pressed;
    }
    for (size_t k = 0; k < sys->normals.followers; k++) {
        const struct follower *f = &sys->normals.follower[k];
        const double swing = f->mu * m->constant.swing[sys->normals.normal[f->normal].row];
        m->constant.swing[f->contact] = m->constant.swing[f->second] = greater(swing, DBL_MIN);
    }
    return resting;
}

/* Returns 1 if contact i has a limit > 0 just after the set time. */
static int presses(const struct stick_slip *m, const tribo_system *sys, size_t i)
{
    const struct follower *f = tribo_normals_follower(sys, i);
    const struct normal *n = f ? &sys->normals.normal[f->normal] : NULL;
    return n                            ? n->pressed && f->mu * n->stiffness > 0.0
           : tribo_normals_at(sys, i)   ? 0
           : m->constant.swing[i] > 0.0 ? tribo_system_presses(sys, i, m->noise.factor)
                                        : m->state.limit[i] != 0.0 || m->state.limit_rate[i] != 0.0;
}

/* Updates limits, and opens and closes contacts by them. */
static void update_limits(struct stick_slip *m, tribo_system *sys, const double *y)
{
    struct slip_state *s = &m->state;
    if (!tribo_system_limits_vary(sys)) {
        return;
    }
    if (sys->normals.count) {
        press(m, sys, y);
    }
    tribo_system_limits(sys, s->limit, s->limit_rate);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (!presses(m, sys, i)) {
            s->limit[i] = s->limit_rate[i] = 0.0;
            tribo_stick_slip_set(m, i, TRIBO_SLIP_OPEN);
        } else if (s->slip[i] == TRIBO_SLIP_OPEN) {
            tribo_stick_slip_set(m, i, m->plane && m->plane->in_plane[i] ? TRIBO_SLIP_PLANE : slip_of(m, sys, i, y));
        }
    }
    tribo_limits_take(m);
}

int tribo_stick_slip_find_resting(struct stick_slip *m, const tribo_system *sys, double *y)
{
    const struct slip_state *s = &m->state;
    const size_t n = m->constant.contacts;
    int status = TRIBO_OK;
    /* contacts that a holding contact keeps at rest come to rest too */
    for (size_t found = 1; !status && found;) {
        status = tribo_stick_slip_find_holds(m, sys);
        status = status ? status : tribo_stick_slip_hold(m, sys, s->base, y + sys->ndof);
        found = 0;
        for (size_t i = 0; !status && i < n; i++) {
            if (tribo_slides(s->slip[i]) && !m->constant.elastic[i] &&
                s->slip[i] * tribo_stick_slip_find_velocity(m, sys, i, y) <= m->noise.factor * m->noise.velocity[i]) {
                tribo_stick_slip_set(m, i, TRIBO_SLIP_STUCK);
                found++;
            }
        }
    }
    /* where bases part, a contact at rest that does not hold slides by its velocity */
    for (size_t i = 0; !status && s->dependents && m->constant.base_moves && i < n; i++) {
        if (s->slip[i] == TRIBO_SLIP_STUCK && !s->holds[i]) {
            const int loses = s->rested[i] && !m->limits.falls && tribo_drops(m, i);
            tribo_stick_slip_set(m, i, slip_of(m, sys, i, y));
            if (s->slip[i] && loses) { /* irreversible, so it must not depend on the choice of H */
                status = tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                                     "contact %zu has a static limit and is tied to others that stop beside it: which of "
                                     "them rest is not unique; take central/fixed or moreau/fixed",
                                     i);
            }
        }
    }
    const signed char *restrict slip = s->slip;
    unsigned char *restrict rested = s->rested;
    for (size_t i = 0; i < n; i++) {
        rested[i] = slip[i] == TRIBO_SLIP_STUCK;
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------------- instant */

/* Decides, with normals at rest pressed by the forces of the last decision. Returns a status. */
static int decide_once(struct stick_slip *m, tribo_system *sys, double t, double *y)
{
    const int springs = sys->compliance.count > 0;
    memset(m->state.tied, 0, sys->ncontact);
    update_limits(m, sys, y);
    if (springs) {
        tribo_elastic_place(m, sys, y);
    }
    int status = m->plane ? tribo_planar_slip_find_resting(m, sys, y) : tribo_stick_slip_find_resting(m, sys, y);
    if (!status) {
        if (m->limits.falls) {
            tribo_limits_fall(m, sys, y, NULL);
        }
        if (springs) {
            tribo_elastic_move(m, sys, y);
        }
        tribo_system_free_acceleration(sys, t, y, m->work.free);
        tribo_stick_slip_contact_accelerations(sys, m->work.free, 1, m->work.a);
        forget_gains(m);
        status = m->plane ? tribo_planar_slip_settle(m, sys, y) : tribo_scalar_slip_settle(m, sys, y);
    }
    return status;
}

int tribo_stick_slip_decide(struct stick_slip *m, tribo_system *sys, double t, double *y)
{
    tribo_system_set_time(sys, t);
    find_base(m, sys);
    if (sys->normals.count) {
        memcpy(m->state.was_pressed, m->state.pressed, sys->normals.count);
    }
    int status = decide_once(m, sys, t, y);
    if (!status && sys->normals.count &&
        memchr(m->state.rests, 1, sys->normals.count)) { /* the forces found may press other normals at rest */
        memcpy(m->work.last, m->state.pressed, sys->normals.count);
        const int others = press(m, sys, y) > 0 && memcmp(m->work.last, m->state.pressed, sys->normals.count) != 0;
        status = others ? decide_once(m, sys, t, y) : TRIBO_OK;
    }
    m->state.reached = sys->ncontact;
    if (status) {
        return status;
    }
    for (size_t i = 0; sys->compliance.count && i < sys->ncontact; i++) {
        m->noise.allowance[i] = m->constant.elastic[i] ? m->noise.spring[i] : m->noise.allowance[i];
        m->state.slid[i] = m->state.slip[i];
    }
    return tribo_stick_slip_find_holds(m, sys);
}

void tribo_stick_slip_forget_shares(struct stick_slip *m)
{
    const double *still = m->constant.still;
    if (!m->constant.independent && !m->constant.uncoupled) {
        tribo_solve_box(m->constant.box, still, still, still, m->work.f);
    }
}

int tribo_stick_slip_start(struct stick_slip *m, tribo_system *sys, double t, double *y, int continues)
{
    struct slip_constant *k = &m->constant;
    struct slip_state *s = &m->state;
    const size_t c = sys->ncontact;
    tribo_system_set_time(sys, t);
    m->noise.factor = 1.0;
    s->reached = c;
    for (size_t i = 0; i < c; i++) {
        k->swing[i] = tribo_system_swing(sys, i);
    }
    if (!continues) {
        memset(s->pressed, 0, sys->normals.count);
        memset(s->force, 0, c * sizeof *s->force);
    }
    if (sys->normals.count) {
        press(m, sys, y);
    }
    tribo_system_limits(sys, s->limit, s->limit_rate);
    tribo_limits_start(m, sys);
    tribo_limits_take(m);
    memset(s->base, 0, c * sizeof *s->base);
    find_base(m, sys);
    find_scales(m, sys);
    memset(m->noise.velocity_scale, 0, c * sizeof *m->noise.velocity_scale);
    if (!continues) {
        forget_gains(m);
        for (size_t i = 0; i < c; i++) {
            const signed char slip = slip_of(m, sys, i, y);
            /* several contacts that hold a body together leave what rounding of accelerations makes of v_i */
            tribo_stick_slip_find_gain(m, sys, y, i);
            const double faint = TRIBO_VELOCITY_NOISE * m->noise.acceleration[i] * k->horizon / LOOK_AHEAD;
            const int rests = slip == 0 || fabs(tribo_stick_slip_velocity(m, sys, i, y)) <= faint;
            tribo_stick_slip_set(m, i, (signed char)(s->limit[i] == 0.0 ? TRIBO_SLIP_OPEN : rests ? TRIBO_SLIP_STUCK : slip));
            s->rested[i] = 0;
        }
        tribo_stick_slip_forget_shares(m);
        const int status = tribo_elastic_pair(m, sys);
        if (status) {
            return status;
        }
        tribo_elastic_start(m, sys, y);
    }
    s->fresh = s->hold_differs = 1;
    s->reached = c;
    const int status = tribo_planar_slip_start(m, sys, continues);
    if (m->plane) { /* decisions set limits at rest */
        tribo_set_static(m->plane->disc, NULL, NULL);
    }
    return status;
}
