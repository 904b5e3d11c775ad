/* What is known of contacts whatever they do, and the memory for what they do. */
#include "numerics/constraint.h"
#include "stick_slip.h"
#include "common/layout.h"
#include "common/real.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static void lay_out_numbers(struct stick_slip *m, struct layout *l, size_t contacts, size_t dofs)
{
    double **const by_contact[] = {&m->limit,     &m->limit_rate,     &m->force,   &m->base,   &m->noise,     &m->diagonal,
                                   &m->seen,      &m->parting,        &m->v,       &m->own_a,  &m->lo,        &m->hi,
                                   &m->f,         &m->still,          &m->swing,   &m->spring, &m->slack,     &m->spring_rate,
                                   &m->base_size, &m->base_rate_size, &m->inertia, &m->gain,   &m->allowance, &m->excess};
    double **const by_dof[] = {&m->size, &m->acceleration, &m->free, &m->rate, &m->load_size};
    const size_t contact_arrays = sizeof by_contact / sizeof *by_contact, dof_arrays = sizeof by_dof / sizeof *by_dof;
    double *work = tribo_layout_array(l, contact_arrays * contacts + dof_arrays * dofs, sizeof *work);
    for (size_t k = 0; work && k < contact_arrays; k++) {
        *by_contact[k] = work + k * contacts;
    }
    for (size_t k = 0; work && k < dof_arrays; k++) {
        *by_dof[k] = work + contact_arrays * contacts + k * dofs;
    }
    m->found = m->gain; /* three arrays of contacts, the last ones, and one of degrees of freedom, the first one */
    m->founds = 3 * contacts + dofs;
}

static void lay_out_marks(struct stick_slip *m, struct layout *l, size_t contacts)
{
    signed char **const sign[] = {&m->slip, &m->tied, &m->before, &m->loose, &m->slid, &m->pulled, &m->key};
    unsigned char **const mark[] = {&m->holds, &m->rested, &m->can_hold, &m->elastic, &m->last};
    const size_t signs = sizeof sign / sizeof *sign, marks = sizeof mark / sizeof *mark;
    signed char *work = tribo_layout_array(l, (signs + marks) * contacts + sizeof(uint64_t), 1);
    for (size_t k = 0; work && k < marks; k++) {
        *mark[k] = (unsigned char *)work + k * contacts;
    }
    for (size_t k = 0; work && k < signs; k++) {
        *sign[k] = work + (marks + k) * contacts;
    }
}

static void lay_out_arrays(struct stick_slip *m, struct layout *l, size_t contacts, size_t dofs)
{
    m->memory = tribo_layout_array(l, 0, 1);
    lay_out_numbers(m, l, contacts, dofs);
    lay_out_marks(m, l, contacts);
    m->at = tribo_layout_array(l, contacts, sizeof *m->at);
    m->asked = m->all = tribo_layout_array(l, contacts, sizeof *m->all);
    m->close = tribo_layout_array(l, contacts, sizeof *m->close);
    m->snap = tribo_layout_array(l, contacts, sizeof *m->snap);
}

static int create_arrays(struct stick_slip *m, size_t contacts, size_t dofs)
{
    struct layout l = {0};
    lay_out_arrays(m, &l, contacts, dofs);
    const int done = tribo_layout_zeros(&l);
    if (done) {
        lay_out_arrays(m, &l, contacts, dofs);
    }
    return done;
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

/* Whether every contact, in order, moves a body that none before it touches: a single one, or one of two that it takes the
 * difference of, so that no pivot is lost to rounding. */
static int are_in_order(const struct stick_slip *m, const tribo_system *sys)
{
    size_t i = 0;
    while (i < sys->ncontact && m->diagonal[i] > 0.0) {
        i++;
    }
    return i == sys->ncontact && sys->snaps_in_order && m->simple;
}

/* Whether any contact can hold without the others. 0 if out of memory. */
static int find_dependence(struct stick_slip *m, const tribo_system *sys)
{
    const int plain = m->uncoupled || are_in_order(m, sys);
    const size_t rank = plain ? sys->ncontact : tribo_constraints_rank(&sys->direction, &sys->mass);
    m->independent = rank == sys->ncontact;
    return rank <= sys->ncontact;
}

int tribo_stick_slip_create(struct stick_slip *m, tribo_system *sys)
{
    const size_t c = sys->ncontact + 1;
    *m = (struct stick_slip){.contacts = sys->ncontact, .only = sys->ncontact, .doubt = 1.0};
    if (create_contexts(m, sys->contacts) && create_arrays(m, c, sys->ndof) &&
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
    free(m->memory);
    memset(m, 0, sizeof *m);
}
