/* What is known of contacts between decisions: velocities and accelerations, and how much of them may be rounding. Decisions are
 * made in scalar_slip.c and planar_slip.c. */
#include "constraint.h"
#include "stick_slip.h"
#include "../common/real.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Accelerations are known to this part of what they are the sum of. */
#define NOISE 2e-14

/* The moment later, in parts of one over the highest frequency. What has changed by then is far above noise, as a rule, and
 * nearly linear in time. */
#define LOOK_AHEAD 1e-4

/* All arrays of numbers are one block. */
static int create_numbers(struct stick_slip *m, size_t contacts, size_t dofs)
{
    double **const by_contact[] = {&m->limit,     &m->limit_rate,     &m->force,   &m->base,   &m->noise,     &m->diagonal,
                                   &m->seen,      &m->parting,        &m->v,       &m->own_a,  &m->lo,        &m->hi,
                                   &m->f,         &m->still,          &m->swing,   &m->spring, &m->slack,     &m->spring_rate,
                                   &m->base_size, &m->base_rate_size, &m->inertia, &m->gain,   &m->allowance, &m->excess};
    double **const by_dof[] = {&m->size, &m->acceleration, &m->free, &m->rate, &m->load_size};
    const size_t contact_arrays = sizeof by_contact / sizeof *by_contact, dof_arrays = sizeof by_dof / sizeof *by_dof;
    double *work = calloc(contact_arrays * contacts + dof_arrays * dofs, sizeof *work);
    for (size_t k = 0; work && k < contact_arrays; k++) {
        *by_contact[k] = work + k * contacts;
    }
    for (size_t k = 0; work && k < dof_arrays; k++) {
        *by_dof[k] = work + contact_arrays * contacts + k * dofs;
    }
    m->found = m->gain; /* three arrays of contacts, the last ones, and one of degrees of freedom, the first one */
    m->founds = 3 * contacts + dofs;
    return work != NULL;
}

static int create_marks(struct stick_slip *m, size_t contacts)
{
    signed char **const sign[] = {&m->slip, &m->tied, &m->before, &m->loose, &m->slid, &m->pulled, &m->key};
    unsigned char **const mark[] = {&m->holds, &m->rested, &m->can_hold, &m->elastic, &m->last};
    const size_t signs = sizeof sign / sizeof *sign, marks = sizeof mark / sizeof *mark;
    signed char *work = calloc((signs + marks) * contacts + sizeof(uint64_t), 1);
    for (size_t k = 0; work && k < marks; k++) {
        *mark[k] = (unsigned char *)work + k * contacts;
    }
    for (size_t k = 0; work && k < signs; k++) {
        *sign[k] = work + (marks + k) * contacts;
    }
    return work != NULL;
}

static int create_lists(struct stick_slip *m, size_t contacts)
{
    m->at = malloc(3 * contacts * sizeof *m->at);
    if (m->at) {
        m->asked = m->all = m->at + contacts;
        m->close = m->at + 2 * contacts;
    }
    m->snap = malloc(contacts * sizeof *m->snap);
    return m->at && m->snap;
}

/* Contexts that know directions only. Where R couples nobody they are not asked for forces, and the second one is not needed. */
static int create_contexts(struct stick_slip *m, const tribo_context *contacts)
{
    size_t islands;
    if (tribo_clone(contacts, &m->box)) {
        return 0;
    }
    tribo_set_planar(m->box, 0, NULL);
    tribo_get_count(m->box, TRIBO_COUNT_ISLANDS, &islands);
    m->uncoupled = islands == m->contacts;
    if (m->uncoupled) {
        return 1;
    }
    tribo_set_static(m->box, NULL, NULL);
    if (tribo_clone(m->box, &m->hold)) {
        return 0;
    }
    /* a contact that has reached its limit stays there while others take over */
    tribo_set_sharing(m->box, TRIBO_SHARE_PREVIOUS);
    tribo_set_law(m->hold, TRIBO_COULOMB);
    tribo_set_coupling(m->hold, TRIBO_PARTITION);
    return 1;
}

/* What contacts are, whatever they do. */
static void find_kinds(struct stick_slip *m, const tribo_system *sys)
{
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->diagonal[i] = tribo_system_delassus(sys, i, i);
        m->inertia[i] = m->diagonal[i] > 0.0 ? quotient(1.0, m->diagonal[i]) : 0.0;
        m->elastic[i] = (unsigned char)tribo_massless_touches(&sys->massless, i);
        m->can_hold[i] = m->diagonal[i] > 0.0 || m->elastic[i];
        m->all[i] = i;
    }
}

/* Whether any contact can hold without the others. 0 if out of memory. */
static int find_dependence(struct stick_slip *m, const tribo_system *sys)
{
    const size_t rank = m->uncoupled ? sys->ncontact : tribo_constraints_rank(&sys->direction, &sys->mass);
    m->independent = rank == sys->ncontact;
    return rank <= sys->ncontact;
}

int tribo_stick_slip_create(struct stick_slip *m, tribo_system *sys)
{
    const size_t c = sys->ncontact + 1;
    *m = (struct stick_slip){.contacts = sys->ncontact, .only = sys->ncontact, .doubt = 1.0};
    if (create_contexts(m, sys->contacts) && create_numbers(m, c, sys->ndof) && create_marks(m, c) && create_lists(m, c) &&
        tribo_breakaway_create(&m->breakaway, sys->ncontact)) {
        find_kinds(m, sys);
        tribo_stick_slip_list_snaps(m, sys); /* nobody being loose */
        if (find_dependence(m, sys)) {
            return TRIBO_OK;
        }
    }
    tribo_stick_slip_free(m);
    return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s", sys->ncontact, plural(sys->ncontact));
}

void tribo_stick_slip_free(struct stick_slip *m)
{
    tribo_destroy(m->box);
    tribo_destroy(m->hold);
    tribo_breakaway_free(&m->breakaway);
    free(m->limit);
    free(m->holds);
    free(m->at);
    free(m->snap);
    memset(m, 0, sizeof *m);
}

/* ---------------------------------------------------------------------------------------------------------- rounding */

/* y += amplitudes of the order-th derivatives of loads, or of b. */
static void add_amplitudes(const tribo_system *sys, enum drives drives, int order, double *y)
{
    for (size_t s = 0; s < sys->harmonics; s++) {
        const struct harmonic *w = &sys->harmonic[s];
        const double rate = order ? fabs(w->omega) : 1.0;
        for (size_t k = 0; w->drives == drives && k < w->count; k++) {
            y[w->index[k]] += rate * (fabs(w->cosine[k]) + fabs(w->sine[k]));
        }
    }
}

void tribo_stick_slip_find_scales(struct stick_slip *m, const tribo_system *sys)
{
    const double fastest = tribo_system_fastest(sys) + m->breakaway.steepest;
    m->horizon = LOOK_AHEAD / (fastest > 0.0 ? fastest : 1.0);
    memset(m->base_size, 0, sys->ncontact * sizeof *m->base_size);
    memset(m->base_rate_size, 0, sys->ncontact * sizeof *m->base_rate_size);
    memset(m->load_size, 0, sys->ndof * sizeof *m->load_size);
    add_amplitudes(sys, DRIVES_BASE, 0, m->base_size);
    add_amplitudes(sys, DRIVES_BASE, 1, m->base_rate_size);
    add_amplitudes(sys, DRIVES_LOAD, 0, m->load_size);
}

void tribo_stick_slip_forget_gains(struct stick_slip *m)
{
    memset(m->found, 0, m->founds * sizeof *m->found);
}

/* The size of all that q'' of degree of freedom d is the sum of. */
static double find_size(struct stick_slip *m, const tribo_system *sys, const double *y, size_t d)
{
    if (m->size[d] > 0.0) {
        return m->size[d];
    }
    if (sys->tables) {
        tribo_system_tables(sys, 0, 1.0, d, d + 1, m->size);
    }
    double size = m->load_size[d] + fabs(m->size[d]) + tribo_matrix_row_size(&sys->stiffness, d, y) +
                  tribo_matrix_row_size(&sys->response, d, m->force);
    size += sys->damping.rows ? tribo_matrix_row_size(&sys->damping, d, y + sys->ndof) : 0.0;
    return m->size[d] = size;
}

void tribo_stick_slip_find_gain(struct stick_slip *m, const tribo_system *sys, const double *y, size_t i)
{
    const struct matrix *j = &sys->direction;
    double size = 0.0, speed = 0.0;
    if (m->gain[i] > 0.0) {
        return;
    }
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        const size_t d = j->col[k];
        size += fabs(j->val[k] * find_size(m, sys, y, d));
        speed += fabs(j->val[k] * y[sys->ndof + d]);
    }
    m->noise[i] = tribo_stick_slip_velocity_noise(m, i, speed);
    m->gain[i] = NOISE * m->doubt * (m->base_rate_size[i] + size);
    m->allowance[i] = TRIBO_ALLOWED * m->gain[i] * m->inertia[i];
    if (m->swing[i] > 0.0) {
        m->allowance[i] += TRIBO_LIMIT_NOISE * m->doubt * tribo_breakaway_ratio(&m->breakaway, i) * m->swing[i];
    }
    if (m->base_moves) {
        m->parting[i] = greater(4.0 * m->doubt * m->noise[i], m->gain[i] * m->horizon / LOOK_AHEAD);
    }
}

int tribo_stick_slip_is_faint(struct stick_slip *m, const tribo_system *sys, const double *y, size_t i)
{
    tribo_stick_slip_find_gain(m, sys, y, i);
    return fabs(tribo_stick_slip_velocity(m, sys, i, y)) <= TRIBO_VELOCITY_NOISE * m->gain[i] * m->horizon / LOOK_AHEAD;
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
    if (m->slip[i] == 0) {
        const double ratio = tribo_breakaway_ratio(&m->breakaway, i);
        return m->holds[i] || !m->tied[i] ? 0.0 : m->force[i] > 0.0 ? ratio : -ratio;
    }
    return m->slip[i] == 2 ? 0.0 : -m->slip[i];
}

double tribo_stick_slip_slack(const struct stick_slip *m, size_t i)
{
    return tribo_breakaway_is_sudden(&m->breakaway, i) ? m->allowance[i] : 0.0;
}

/* ------------------------------------------------------------------------------------------------------------ motion */

void tribo_stick_slip_find_free(struct stick_slip *m, tribo_system *sys, double t, const double *y)
{
    tribo_system_free_acceleration(sys, t, y, m->free);
    m->a = m->free;
    if (!sys->direction.identity || sys->base_harmonics) {
        tribo_stick_slip_contact_accelerations(sys, m->free, 1, m->own_a);
        m->a = m->own_a;
    }
}

void tribo_stick_slip_contact_accelerations(const tribo_system *sys, const double *acceleration, int order, double *to)
{
    tribo_matrix_multiply(&sys->direction, acceleration, to);
    if (sys->base_harmonics) {
        tribo_system_loads(sys, DRIVES_BASE, order, -1.0, to);
    }
}

const double *tribo_stick_slip_find_acceleration(struct stick_slip *m, const tribo_system *sys)
{
    memcpy(m->acceleration, m->free, sys->ndof * sizeof *m->free);
    tribo_matrix_multiply_add(&sys->response, 1.0, m->force, m->acceleration);
    return m->acceleration;
}

void tribo_stick_slip_find_rate(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    memset(m->rate, 0, sys->ndof * sizeof *m->rate);
    tribo_system_loads(sys, DRIVES_LOAD, 1, 1.0, m->rate);
    tribo_matrix_multiply_add(&sys->stiffness, -1.0, y + sys->ndof, m->rate);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, tribo_stick_slip_find_acceleration(m, sys), m->rate);
    }
}
