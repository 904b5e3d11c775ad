/* The constant part of a decision, and the memory of all parts. */
#include "numerics/constraint.h"
#include "stick_slip.h"
#include "common/layout.h"
#include "common/real.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Sets every pointer of p [count] to an array of n doubles, one after the other. */
static void lay_out_doubles(struct layout *l, double **const *p, size_t count, size_t n)
{
    double *work = tribo_layout_array(l, count * n, sizeof *work);
    for (size_t k = 0; work && k < count; k++) {
        *p[k] = work + k * n;
    }
}

static void lay_out_arrays(struct stick_slip *m, struct layout *l, size_t contacts, size_t dofs)
{
    struct slip_constant *c = &m->constant;
    struct slip_state *s = &m->state;
    struct slip_noise *r = &m->noise;
    struct slip_work *w = &m->work;
    double **const by_contact[] = {
        &c->diagonal, &c->inertia, &c->still, &c->swing, &c->base_size, &c->base_rate_size, &s->limit, &s->limit_rate,
        &s->force, &s->spring, &s->spring_rate, &s->base, &s->glide, &r->velocity, &r->velocity_scale, &r->spring,
        &r->parting, &w->own_a, &w->v, &w->lo, &w->hi, &w->f};
    double **const by_dof[] = {&c->load_size, &w->acceleration, &w->free, &w->rate};
    signed char **const sign[] = {&s->slip, &s->tied, &s->before, &s->loose, &s->slid, &w->pulled, &s->key};
    unsigned char **const mark[] = {&s->holds, &s->rested, &c->can_hold, &c->elastic, &w->last};
    const size_t signs = sizeof sign / sizeof *sign, marks = sizeof mark / sizeof *mark;
    c->memory = tribo_layout_array(l, 0, 1);
    lay_out_doubles(l, by_contact, sizeof by_contact / sizeof *by_contact, contacts);
    lay_out_doubles(l, by_dof, sizeof by_dof / sizeof *by_dof, dofs);
    r->founds = 3 * contacts + dofs;
    r->found = tribo_layout_array(l, r->founds, sizeof *r->found);
    w->at = tribo_layout_array(l, contacts, sizeof *w->at);
    w->undecided = c->all = tribo_layout_array(l, contacts, sizeof *c->all);
    w->close = tribo_layout_array(l, contacts, sizeof *w->close);
    s->snap = tribo_layout_array(l, contacts, sizeof *s->snap);
    signed char *bytes = tribo_layout_array(l, (signs + marks) * contacts + sizeof(uint64_t), 1);
    if (bytes) {
        r->acceleration = r->found;
        r->allowance = r->found + contacts;
        r->excess = r->found + 2 * contacts;
        r->size = r->found + 3 * contacts;
    }
    for (size_t k = 0; bytes && k < marks; k++) {
        *mark[k] = (unsigned char *)bytes + k * contacts;
    }
    for (size_t k = 0; bytes && k < signs; k++) { /* key last: zeros follow it */
        *sign[k] = bytes + (marks + k) * contacts;
    }
}

/* Contexts that know J and M only. Where R is diagonal forces are found without them, and there is no constant.hold. */
static int create_contexts(struct slip_constant *c, const tribo_context *contacts)
{
    size_t islands;
    if (tribo_clone(contacts, &c->box)) {
        return 0;
    }
    tribo_set_planar(c->box, 0, NULL);
    tribo_get_count(c->box, TRIBO_COUNT_ISLANDS, &islands);
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

/* Fills R_ii, 1/R_ii, elastic[] and can_hold[]; lists the snaps of all rigid contacts; sets independent. Returns 0 if out of
 * memory. */
static int find_constants(struct stick_slip *m, const tribo_system *sys)
{
    struct slip_constant *c = &m->constant;
    struct constraints ties = {0};
    size_t *rigid = m->work.at, count = 0;
    int in_order = sys->snaps_in_order; /* row by row, J has a degree of freedom that no row before has, with no loss of digits */
    for (size_t i = 0; i < c->contacts; i++) {
        c->diagonal[i] = tribo_system_delassus(sys, i, i);
        c->inertia[i] = c->diagonal[i] > 0.0 ? quotient(1.0, c->diagonal[i]) : 0.0;
        c->elastic[i] = (unsigned char)tribo_is_compliant(&sys->compliance, i);
        c->can_hold[i] = c->diagonal[i] > 0.0 || c->elastic[i];
        c->all[i] = i;
        m->state.loose[i] = (signed char)c->elastic[i];
        rigid[count] = i;
        count += !c->elastic[i];
        in_order &= c->diagonal[i] > 0.0;
    }
    tribo_stick_slip_list_snaps(m, sys); /* loose[] = 0: of all rigid contacts */
    if (c->uncoupled || (in_order && m->state.simple)) {
        c->independent = 1;
        return 1;
    }
    const int done = tribo_constraints_create(&ties, &sys->direction, &sys->mass, rigid, count, m->work.last);
    c->independent = done && ties.rank == count;
    tribo_constraints_free(&ties);
    return done;
}

int tribo_stick_slip_create(struct stick_slip *m, tribo_system *sys)
{
    const size_t c = sys->ncontact + 1;
    struct layout l = {0};
    *m = (struct stick_slip){.constant.contacts = sys->ncontact, .work.single = sys->ncontact, .noise.factor = 1.0};
    lay_out_arrays(m, &l, c, sys->ndof);
    if (create_contexts(&m->constant, sys->contacts) && tribo_layout_zeros(&l)) {
        lay_out_arrays(m, &l, c, sys->ndof);
        if (tribo_breakaway_create(&m->breakaway, sys->ncontact) && find_constants(m, sys)) {
            return TRIBO_OK;
        }
    }
    tribo_stick_slip_free(m);
    return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s", sys->ncontact, plural(sys->ncontact));
}

void tribo_stick_slip_free(struct stick_slip *m)
{
    tribo_destroy(m->constant.box);
    tribo_destroy(m->constant.hold);
    tribo_breakaway_free(&m->breakaway);
    free(m->constant.memory);
    memset(m, 0, sizeof *m);
}
