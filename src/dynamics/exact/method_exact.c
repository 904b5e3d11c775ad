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
#include "terms.h"
#include "transition.h"
#include "common/real.h"
#include "common/zeros.h"

/* Bytes of structures above which all structures are dropped. */
#define CACHE_BYTES ((size_t)256 << 20)

/* A structure with contacts held; print: hash of all bytes of modal->key. Structures of different print have different keys. */
struct held {
    struct modal *modal;
    uint64_t print;
};

struct exact {
    tribo_system *sys;
    struct events events;
    struct modal_shared shared; /* data of all held structures; zeros until the first structure is created */
    struct held *held;
    size_t helds, room, bytes, revision;
    struct modal_known known; /* parts of structures that do not depend on loads */
    size_t structure;         /* sys->structure that known belongs to */

    struct modal_motion motion; /* of the phase */
    struct course *course;      /* [ncontact] courses of the outputs of the structure */
    double *work;               /* workspace of transitions; NULL before the first one */
    size_t columns;             /* number of columns that work has room for */
};

/* ---------------------------------------------------------------------------------------------- structures that are held */

static void drop_helds(struct exact *x)
{
    for (size_t i = 0; i < x->helds; i++) {
        tribo_modal_free(x->held[i].modal);
    }
    tribo_modal_shared_free(&x->shared);
    x->helds = 0;
    x->bytes = 0;
}

/* Returns a hash of key [n], with zeros after key up to a multiple of 8 bytes. */
static uint64_t print_of(size_t n, const signed char *key)
{
    uint64_t print = 0, part;
    for (size_t i = 0; i < n; i += sizeof part) {
        memcpy(&part, key + i, sizeof part);
        print = (print ^ part) * 0x9e3779b97f4a7c15;
    }
    return print;
}

/* Returns 1 if held has the key [n] with this print. Up to 8 contacts different keys have different prints. */
static int has_key(struct held held, uint64_t print, size_t n, const signed char *key)
{
    return held.print == print && (n <= sizeof print || memcmp(held.modal->key, key, n) == 0);
}

/* *found = structure with the contacts at rest held. held[] is in order of last use, searched from the end. Returns a status. */
static int find_held(struct exact *x, const struct modal **found)
{
    tribo_system *sys = x->sys;
    const struct stick_slip *m = &x->events.stick_slip;
    const uint64_t print = print_of(m->constant.contacts, m->state.key);
    for (size_t i = x->helds; i-- > 0;) {
        const struct held held = x->held[i];
        if (has_key(held, print, m->constant.contacts, m->state.key)) {
            for (; i + 1 < x->helds; i++) {
                x->held[i] = x->held[i + 1];
            }
            x->held[i] = held;
            *found = held.modal;
            return TRIBO_OK;
        }
    }
    if (x->bytes + x->known.bytes > CACHE_BYTES) {
        drop_helds(x);
        tribo_modal_forget(&x->known);
    }
    if (x->helds == x->room) {
        const size_t room = 2 * x->room + 16;
        struct held *more = realloc(x->held, room * sizeof *more);
        if (!more) {
            return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for %zu held structure%s", room, plural(room));
        }
        x->held = more;
        x->room = room;
    }
    struct modal *h;
    int status = x->shared.sys ? TRIBO_OK : tribo_modal_shared_create(&x->shared, sys);
    x->shared.known = &x->known;
    status = status ? status : tribo_modal_create(&h, &x->shared, m->state.slip, m->state.holds);
    if (status) {
        return status;
    }
    x->held[x->helds++] = (struct held){h, print};
    x->bytes += h->bytes;
    *found = h;
    return TRIBO_OK;
}

/* --------------------------------------------------------------------------------------------------------------------- guards */

static void method_exact_look(void *own, double tau, size_t guards, struct guard *const *guard)
{
    struct modal_motion *x = &((struct exact *)own)->motion;
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
            /* Adds the part of the limit by harmonics. */
            const struct sample limit = tribo_modal_motion_limit(x, g->contact);
            g->middle.g += g->limit * limit.g;
            g->middle.d += g->limit * limit.d;
            g->middle.e += g->limit * limit.e;
        }
    }
}

/* to [3] = third to fifth derivative of guard g. Returns 1; 0, to not set, for a varying limit, a resonance, or no output. */
static int look_further(void *own, double tau, const struct guard *g, double *to)
{
    struct modal_motion *x = &((struct exact *)own)->motion;
    const struct course *c = g->output;
    if (!c || g->limit != 0.0) {
        return 0;
    }
    tribo_modal_motion_go(x, tau);
    if (!tribo_course_look_further(x, c, to)) {
        return 0;
    }
    for (int k = 0; k < 3; k++) {
        to[k] *= g->side;
    }
    return 1;
}

static void move_to(void *own, double tau, const double *from, double *to)
{
    tribo_modal_motion_state(&((struct exact *)own)->motion, tau, from, to);
}

/* Sets the time t of the system, and cosine and sine of each harmonic from the terms at the end of the phase. */
static void arrive(void *own, double t)
{
    const struct exact *exact = own;
    const struct modal_motion *x = &exact->motion;
    x->sys->evaluations += exact->events.search.looks;
    tribo_system_set_time(x->sys, t);
    for (size_t s = 0; s < x->h->given; s++) {
        const struct number at = tribo_harmonic(x, s);
        tribo_harmonic_take(x->sys, &x->sys->harmonic[x->h->forcing[s].harmonic], at.re, at.im);
    }
}

/* Sets size and bend of all guards from tau on. Returns the time from which new bounds are worth finding: max(2 tau, 1/decay),
 * HUGE_VAL if nothing decays. At tau = 0 courses have bounds from tribo_course_begin. */
static double method_exact_bound(void *own, double tau)
{
    struct exact *x = own;
    const double decay = x->motion.h->decay;
    if (tau > 0.0) {
        tribo_modal_motion_bound(&x->motion, tau);
        for (size_t k = 0; k < x->motion.h->outputs; k++) {
            tribo_course_bound(&x->motion, &x->course[k]);
        }
    }
    for (size_t k = 0; k < x->events.search.guards; k++) {
        /* g->size and g->bend from the bounds of course c */
        struct guard *g = &x->events.search.guard[k];
        const struct course *c = g->output;
        g->size = fabs(g->offset) + (c ? c->size : 0.0);
        g->bend = c ? c->bend : 0.0;
        if (g->limit != 0.0) {
            g->size += fabs(g->limit) * x->events.stick_slip.constant.swing[g->contact];
            g->bend += fabs(g->limit) * tribo_modal_motion_limit_bend(&x->motion, g->contact);
        }
    }
    return decay > 0.0 ? greater(2.0 * tau, 1.0 / decay) : HUGE_VAL;
}

/* Returns the limit of contact i without harmonics. */
static double steady_limit(const struct exact *x, size_t i)
{
    return x->events.stick_slip.constant.swing[i] > 0.0 ? x->sys->given_limit[i] : x->events.stick_slip.state.limit[i];
}

/* Returns the data for the guards of contact i; c: course of the output of contact i; NULL: none. */
static struct watch watch_of(const struct exact *x, size_t i, struct course *c)
{
    const double steady = steady_limit(x, i), swing = x->events.stick_slip.constant.swing[i];
    return (struct watch){
        .output = c, .size = c ? c->size : 0.0, .constant = steady, .least = steady - swing, .varies = swing > 0.0};
}

static int method_exact_begin(void *own, double t, const double *y, double *reach)
{
    struct exact *x = own;
    const struct modal *h = NULL;
    const int status = find_held(x, &h);
    if (status) {
        return status;
    }
    if (!tribo_modal_motion_reserve(&x->motion, h->terms)) {
        return tribo_system_fail(x->sys, TRIBO_ERR_MEMORY, "out of memory for %zu term%s", h->terms, plural(h->terms));
    }
    *reach = tribo_modal_motion_start(&x->motion, h, t, y, *reach);
    tribo_events_clear_guards(&x->events);
    for (size_t k = 0; k < x->motion.h->outputs; k++) {
        struct course *c = &x->course[k];
        const struct stick_slip *m = &x->events.stick_slip;
        const int of_velocity = k < x->motion.h->sliding;
        c->output = &x->motion.h->output[k];
        const size_t i = c->output->contact;
        const double value = of_velocity ? tribo_stick_slip_first_velocity(m, x->sys, i, y) : m->state.force[i];
        tribo_course_begin(&x->motion, c, of_velocity, value);
        const struct watch w = watch_of(x, i, c);
        tribo_events_guard_contact(&x->events, i, &w);
    }
    for (size_t i = 0; x->sys->limit_harmonics && i < x->sys->ncontact; i++) {
        const struct watch w = watch_of(x, i, NULL);
        tribo_events_guard_limit(&x->events, i, &w);
    }
    return TRIBO_OK;
}

static void *keep_phase(void *own, double tau)
{
    return tribo_modal_phase_create(((struct exact *)own)->motion.h, tau);
}

static void release_phase(void *phase)
{
    tribo_modal_phase_free(phase);
}

static int method_exact_transition(void *own, const void *phase, double tau, size_t columns, double *v)
{
    (void)tau;
    struct exact *x = own;
    if (columns > x->columns) {
        double *more = realloc(x->work, tribo_modal_transition_room(x->sys, columns) * sizeof *more);
        if (!more) {
            return tribo_system_fail(x->sys, TRIBO_ERR_MEMORY, "out of memory for %zu perturbation%s", columns, plural(columns));
        }
        x->work = more;
        x->columns = columns;
    }
    tribo_modal_transition(phase, x->sys, columns, v, x->work);
    return TRIBO_OK;
}

static int method_exact_combine(void *own, const double *c, double tau, const double *end, struct signal *to)
{
    return tribo_modal_motion_signal(&((struct exact *)own)->motion, c, tau, end, to);
}

static double closed_work(void *own, size_t i, double tau)
{
    return tribo_modal_motion_work(&((struct exact *)own)->motion, i, tau);
}

static const struct motion motion_closed = {.begin = method_exact_begin,
                                            .look = method_exact_look,
                                            .further = look_further,
                                            .bound = method_exact_bound,
                                            .state = move_to,
                                            .arrive = arrive,
                                            .keep = keep_phase,
                                            .release = release_phase,
                                            .transition = method_exact_transition,
                                            .signal = method_exact_combine,
                                            .work = closed_work};

/* --------------------------------------------------------------------------------------------------------- the driver */

static void method_exact_destroy(tribo_driver *drv)
{
    struct exact *x = drv->own;
    if (x) {
        drop_helds(x);
        tribo_modal_forget(&x->known);
        free(x->held);
        tribo_events_free(&x->events);
        tribo_modal_motion_free(&x->motion);
        free(x->course);
        free(x->work);
        free(x);
    }
}

/* Returns a status: tables and falling static limits are unsupported. Every advance checks, since the system may change. */
static int check_system(const tribo_system *sys)
{
    if (sys->tables || sys->limits.knots) {
        return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                 "%s follow a table, and method exact takes harmonic ones only: take event or auto",
                                 sys->tables > sys->base_tables ? "loads"
                                 : sys->tables                  ? "base motions"
                                                                : "limits");
    }
    const size_t i = tribo_system_first_falling(sys);
    return i == sys->ncontact ? TRIBO_OK
                              : tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
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
    if (!x) {
        return tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method exact");
    }
    x->sys = drv->sys;
    x->course = malloc((drv->sys->ncontact + 1) * sizeof *x->course);
    const int status = tribo_events_create(&x->events, drv, &motion_closed, x);
    if (status) {
        return status;
    }
    if (!x->course || !tribo_modal_motion_create(&x->motion, drv->sys, &x->events.stick_slip)) {
        return tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method exact");
    }
    return TRIBO_OK;
}

static int method_exact_open_events(tribo_driver *drv, struct events **events)
{
    struct exact *x = drv->own;
    tribo_system *sys = drv->sys;
    if (check_system(sys) || tribo_compliance_check(sys)) {
        return tribo_driver_fail(drv, TRIBO_ERR_UNSUPPORTED, "%s", tribo_system_message(sys));
    }
    if (x->revision != sys->revision) {
        drop_helds(x);
        x->revision = sys->revision;
    }
    if (x->structure != sys->structure) {
        tribo_modal_forget(&x->known);
        x->structure = sys->structure;
    }
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
