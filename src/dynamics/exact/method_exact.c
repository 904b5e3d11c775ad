/* SPDX-License-Identifier: BSD-3-Clause */
/* Method "exact": Coulomb's law without regularization on a linear structure, without time steps. Between events the motion is
 * known in closed form from the modes of the structure with the contacts at rest held (modal.h). No event is skipped
 * (first_zero.h): the sixth derivative of a sum of exponentials is at most the sum of |amplitude| |lambda|^6, which bounds the
 * difference to a quintic. At an event stick_slip.h decides which contacts stick. The energy integral is closed, too
 * (energy.c). */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/events/events.h"
#include "motion.h"
#include "common/real.h"
#include "common/layout.h"

/* Number of phases without modes with the same contacts held: about as many take as long as a decomposition. */
#define LASTING 6

/* Bytes of structures above which all structures are dropped. */
#define CACHE_BYTES ((size_t)512 << 20)

/* Least degrees of freedom and contacts for phases without modes: fewer modes take as long as powers, fewer sets come again. */
#define POWERS_LEAST 40
#define POWERS_CONTACTS 6

/* ---------------------------------------------------------------------------------------------- structures that are held */

static void drop_helds(struct exact *x)
{
    for (size_t k = 0; k < TRIBO_HELD_LISTS; k++) {
        while (x->held.last[k]) {
            struct modal *next = x->held.last[k]->next;
            tribo_forced_free(x->held.last[k]);
            tribo_modal_free(x->held.last[k]);
            x->held.last[k] = next;
        }
    }
    x->held.bytes = 0;
    x->held.like = x->held.powers = NULL;
}

/* *found = the structure with the contacts at rest held, under the loads, with powers = 1 without modes. Returns a status. */
static int find_held(struct exact *x, int powers, struct modal **found)
{
    const struct stick_slip *m = &x->events.stick_slip;
    const signed char *key = x->sys->normals.count ? tribo_follow_key(m, x->held.room) : m->state.key;
    uint64_t hash = 0, word;
    for (size_t i = 0; i < m->constant.contacts; i += sizeof word) {
        memcpy(&word, key + i, sizeof word);
        hash = (hash ^ word) * UINT64_C(0x9e3779b97f4a7c15);
    }
    struct modal **const list = &x->held.last[(hash >> 32) % TRIBO_HELD_LISTS], **at = list;
    while (*at && (((*at)->powers != NULL) != powers || memcmp((*at)->key, key, m->constant.contacts) != 0)) {
        at = &(*at)->next;
    }
    struct modal *h = *at, *const known = h;
    if (!known && x->held.bytes > CACHE_BYTES) {
        drop_helds(x);
    }
    if (!known || !h->forced) {
        const int status = tribo_modal_create(&h, x->sys, m->state.slip, key, powers, powers ? x->held.like : NULL);
        if (status) {
            return status;
        }
        x->held.bytes += (known ? 0 : h->store.bytes) + h->forced->store.bytes;
    }
    if (known) {
        *at = h->next;
    }
    x->held.like = powers && h->rests == 0 ? h : x->held.like;
    h->next = *list;
    *list = h;
    *found = h;
    return TRIBO_OK;
}

/* Sets x->h, the structure of the next phase. If no base moves at a constant speed, no limit varies, K is symmetric, and the
 * structure is large enough, phases have no modes, until LASTING follow each other with the same contacts held;
 * from there on in this run they have: no motion depends on runs before. Returns a status. */
static int choose_held(struct exact *x)
{
    const tribo_system *sys = x->sys;
    struct held *s = &x->held;
    struct modal *h = NULL;
    int powers = !tribo_system_limits_vary(sys) && sys->circulation == 0.0 && sys->ndof >= POWERS_LEAST &&
                 sys->ncontact >= POWERS_CONTACTS;
    for (size_t k = 0; powers && k < sys->loads.harmonics; k++) {
        const struct harmonic *w = &sys->loads.harmonic[k];
        powers &= (w->drives == DRIVES_LOAD && !w->knots) || (w->drives == DRIVES_BASE && w->omega != 0.0);
    }
    if (x->events.anew) {
        s->run++;
        s->powers = NULL;
        x->events.anew = 0;
    }
    int status = powers ? find_held(x, 1, &h) : TRIBO_OK;
    s->phases = h && h == s->powers ? s->phases + 1 : 0;
    if (!status && h && s->phases == LASTING) {
        h->run = s->run;
    }
    s->powers = h && h->run != s->run ? h : NULL;
    status = status || s->powers ? status : find_held(x, 0, &h);
    x->h = status ? x->h : h->forced;
    return status;
}

/* --------------------------------------------------------------------------------------------------------------------- guards */

static void method_exact_look(void *own, double tau, size_t guards, struct guard *const *guard)
{
    struct exact *x = own;
    x->sys->evaluations++;
    tribo_modal_motion_go(x, tau);
    for (size_t k = 0; k < guards; k++) {
        struct guard *g = guard[k];
        if (g->output) {
            /* An output is computed once for both guards, side 1 and -1. */
            struct course *c = g->output;
            if (c->tau != tau) {
                tribo_course_look(x, c);
            }
            g->middle.g = g->offset + g->side * c->at.g;
            g->middle.d = g->side * c->at.d;
            g->middle.e = g->side * c->at.e;
        } else {
            g->middle = (struct sample){g->offset, 0.0, 0.0};
        }
        if (g->limit != 0.0) {
            /* Adds the part of the limit by functions of time, or the limit that follows. */
            const struct sample limit = tribo_modal_motion_limit(x, g->contact);
            g->middle.g += g->limit * limit.g;
            g->middle.d += g->limit * limit.d;
            g->middle.e += g->limit * limit.e;
        }
    }
}

/* Sets size and bend of all guards from tau on. Returns the time from which new bounds are worth finding: max(2 tau, 1/decay),
 * HUGE_VAL if nothing decays. At tau = 0 courses have bounds from tribo_course_begin. */
static double method_exact_bound(void *own, double tau)
{
    struct exact *x = own;
    const double decay = x->h->decay;
    if (tau > 0.0) {
        tribo_modal_motion_bound(x, tau);
        for (size_t k = 0; k < x->h->outputs; k++) {
            tribo_course_bound(x, &x->course[k]);
        }
    }
    for (size_t k = 0; k < x->events.search.guards; k++) {
        struct guard *g = &x->events.search.guard[k];
        const struct course *c = g->output;
        g->size = fabs(g->offset) + (c ? c->size : 0.0);
        g->bend = c ? c->bend : 0.0;
        double mu;
        if (g->limit != 0.0) {
            const struct course *limit = tribo_modal_limit_course(x, g->contact, &mu);
            g->size += fabs(g->limit) * mu * limit->size;
            g->bend += fabs(g->limit) * mu * limit->bend;
        }
    }
    return decay > 0.0 ? greater(2.0 * tau, 1.0 / decay) : HUGE_VAL;
}

/* Returns the data for the guards of contact i; c: course of the output of contact i; NULL: none. */
static struct watch watch_of(const struct exact *x, size_t i, struct course *c)
{
    const double swing = x->events.stick_slip.constant.swing[i];
    const int follows = x->sys->normals.count && (tribo_normals_follower(x->sys, i) || tribo_normals_at(x->sys, i));
    const int varies = swing > 0.0 || follows || x->sys->loads.limit_tables;
    const double steady = varies ? tribo_system_steady_limit(x->sys, i) : x->events.stick_slip.state.limit[i];
    return (struct watch){.output = c,
                          .size = c ? c->size : 0.0,
                          .constant = follows ? 0.0 : steady,
                          .least = follows ? -HUGE_VAL : steady - swing,
                          .varies = varies};
}

static int method_exact_begin(void *own, double t, const double *y, double *reach)
{
    struct exact *x = own;
    const struct stick_slip *m = &x->events.stick_slip;
    tribo_stick_slip_press(m, x->sys);
    const int status = choose_held(x);
    const struct forced *h = x->h;
    if (status) {
        return status;
    }
    if (!tribo_modal_motion_start(x, t, y, reach)) {
        return tribo_error(x->sys->message, TRIBO_ERR_MEMORY, "out of memory for %zu term%s", h->terms, plural(h->terms));
    }
    x->events.search.guards = 0;
    for (size_t k = 0; k < h->outputs; k++) {
        const size_t i = h->output[k].contact;
        /* N of a normal, < 0 if it is apart, without rounding against the decision */
        const struct normal *n = k >= h->holding && k < h->limits ? &x->sys->normals.normal[k - h->holding] : NULL;
        const double load = n ? n->stiffness * (tribo_matrix_row_dot(&x->sys->direction, n->row, y) - n->gap) : 0.0;
        const double value = k < h->sliding   ? tribo_stick_slip_first_velocity(m, x->sys, i, y)
                             : k < h->holding ? m->state.force[i]
                             : !n             ? x->slopes.limit[i]
                             : n->pressed     ? greater(load, 0.0)
                                              : lesser(load, 0.0);
        tribo_course_begin(x, k, value);
    }
    for (size_t k = 0; k < h->holding; k++) {
        const struct watch w = watch_of(x, h->output[k].contact, &x->course[k]);
        tribo_events_guard_contact(&x->events, h->output[k].contact, &w);
    }
    for (size_t i = 0; tribo_system_limits_vary(x->sys) && i < x->sys->ncontact; i++) {
        const struct watch w = watch_of(x, i, NULL);
        tribo_events_guard_limit(&x->events, i, &w);
    }
    return TRIBO_OK;
}

static const struct motion motion_closed = {.begin = method_exact_begin,
                                            .look = method_exact_look,
                                            .bound = method_exact_bound,
                                            .state = tribo_modal_motion_state,
                                            .keep = tribo_modal_phase_keep,
                                            .release = tribo_modal_phase_release,
                                            .transition = tribo_modal_transition,
                                            .signal = tribo_modal_motion_signal,
                                            .work = tribo_modal_motion_work};

/* --------------------------------------------------------------------------------------------------------- the driver */

static void method_exact_destroy(tribo_driver *drv)
{
    struct exact *x = drv->own;
    if (x) {
        drop_helds(x);
        tribo_events_free(&x->events);
        tribo_signal_free(&x->factor[0]);
        tribo_signal_free(&x->factor[1]);
        free(x->held.room);
        free(x->lot);
        free(x);
    }
}

/* Returns a status: falling static limits, and tables of base motions where K~ is not symmetric, are unsupported. Every advance
 * checks, since the system may change. */
static int check_system(const tribo_system *sys)
{
    for (size_t k = 0; (sys->normals.count || sys->circulation > 0.0) && k < sys->loads.harmonics; k++) {
        if (sys->loads.harmonic[k].knots && sys->loads.harmonic[k].drives == DRIVES_BASE) {
            return tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                               "base motions follow a table, which method exact does not take beside %s: take event or auto",
                               sys->normals.count ? "limits that follow normal loads" : "a stiffness that is not symmetric");
        }
    }
    const size_t drops = sys->normals.count ? tribo_system_first_dropping(sys, 0) : sys->ncontact;
    if (drops < sys->ncontact) {
        return tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                           "contact %zu has a static limit, which method exact does not take beside limits that follow normal "
                           "loads, as of contact %zu: take event or auto",
                           drops, sys->normals.follower[0].contact);
    }
    const size_t i = tribo_system_first_dropping(sys, 1);
    return i == sys->ncontact ? TRIBO_OK
                              : tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                                            "contact %zu has a static limit that falls with the speed, and method exact "
                                            "takes such that drop at once only: take event or auto",
                                            i);
}

static int method_exact_create(tribo_driver *drv)
{
    const int unsupported = check_system(drv->sys);
    if (unsupported) {
        return unsupported;
    }
    struct exact *x = tribo_zeros(1, sizeof *x);
    drv->own = x;
    if (!x || !(x->held.room = tribo_zeros(drv->sys->ncontact + sizeof(uint64_t), 1))) {
        return tribo_error(drv->sys->message, TRIBO_ERR_MEMORY, "out of memory for method exact");
    }
    x->sys = drv->sys;
    return tribo_events_create(&x->events, drv, &motion_closed, x);
}

static int method_exact_open_events(tribo_driver *drv, struct events **events)
{
    struct exact *x = drv->own;
    tribo_system *sys = drv->sys;
    if (check_system(sys) || tribo_compliance_check(sys)) {
        return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED, "%s", tribo_system_message(sys));
    }
    if (x->held.structure != sys->structure) {
        drop_helds(x);
        x->held.structure = sys->structure;
    }
    for (size_t k = 0; x->held.revision != sys->revision && k < TRIBO_HELD_LISTS; k++) {
        for (struct modal *h = x->held.last[k]; h; h = h->next) {
            x->held.bytes -= h->forced ? h->forced->store.bytes : 0;
            tribo_forced_free(h);
        }
    }
    x->held.revision = sys->revision;
    *events = &x->events;
    return TRIBO_OK;
}

const struct method tribo_method_exact = {"exact",
                                          TAKES_OUTPUT | NEEDS_SCALAR,
                                          method_exact_create,
                                          method_exact_destroy,
                                          tribo_events_method,
                                          method_exact_open_events,
                                          tribo_events_find_periodic};
