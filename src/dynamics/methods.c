/* The table of methods, and method "auto". */
#include "driver.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/name.h"
#include "common/real.h"
#include "common/zeros.h"

static const struct method automatic;

static const struct method *const methods[] = {
    &tribo_method_rk4_fixed,     &tribo_method_exact,        &tribo_method_event,
    &tribo_method_central_fixed, &tribo_method_moreau_fixed, &automatic,
};

int tribo_method_count(void)
{
    return (int)(sizeof methods / sizeof *methods);
}

const char *tribo_method_name(int method)
{
    return method >= 0 && method < tribo_method_count() ? methods[method]->name : NULL;
}

int tribo_driver_create(tribo_driver **drv, tribo_system *sys, const char *method)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (!drv || !method) {
        return tribo_system_fail(sys, TRIBO_ERR_NULL, "%s is NULL", drv ? "method" : "drv");
    }
    const struct method *m = NULL;
    char list[200] = "";
    for (int i = 0; i < tribo_method_count(); i++) {
        const size_t used = strlen(list);
        m = tribo_same_name(methods[i]->name, method) ? methods[i] : m;
        snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", methods[i]->name);
    }
    return m ? tribo_driver_create_method(drv, sys, m)
             : tribo_system_fail(sys, TRIBO_ERR_NAME,
                                 "method \"%.20s\" is unknown; there are %s; tribo_gsl_driver_create takes GSL's steppers",
                                 method, list);
}

/* ------------------------------------------------------------------------------------------------------ method "auto" */

enum { EVENT, EXACT };

/* The two drivers of auto, each created at first use. */
struct choice {
    tribo_driver *inner[2];
    int refused; /* 1: exact has refused the system of this revision */
    size_t revision;
};

/* Returns EXACT for up to 200 degrees of freedom, where modes are cheap, if exact supports the system; else EVENT. */
static int driver_choose(const tribo_driver *drv)
{
    const tribo_system *sys = drv->sys;
    const struct choice *c = drv->own;
    const int refused = c->refused && c->revision == tribo_system_revision(sys);
    const int closed = !sys->tables && !tribo_system_falls(sys) && !tribo_system_planar(sys);
    return sys->ndof <= 200 && closed && !refused ? EXACT : EVENT;
}

/* Creates inner[which] unless it exists. Returns a status; the message is in the system. */
static int provide(tribo_driver *drv, int which)
{
    static const struct method *const of[] = {&tribo_method_event, &tribo_method_exact};
    struct choice *c = drv->own;
    drv->at_work = of[which];
    return c->inner[which] ? TRIBO_OK : tribo_driver_create_method(&c->inner[which], drv->sys, of[which]);
}

static int create_choice(tribo_driver *drv)
{
    drv->own = tribo_zeros(1, sizeof(struct choice));
    drv->excess = drv->backslip = 0.0;
    return drv->own ? provide(drv, driver_choose(drv))
                    : tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method auto");
}

static void destroy_choice(tribo_driver *drv)
{
    struct choice *c = drv->own;
    if (c) {
        tribo_driver_destroy(c->inner[EXACT]);
        tribo_driver_destroy(c->inner[EVENT]);
        free(c);
    }
}

/* An advance from *t to t1; with finds = 1 the search for a periodic motion from *t. */
struct task {
    double *t, t1, period, *y;
    int finds;
};

/* Runs task x by inner[which] with the settings of drv; adds the counts of inner[which] to drv. Returns a status. */
static int delegate(tribo_driver *drv, int which, const struct task *x)
{
    const struct choice *c = drv->own;
    int status = provide(drv, which);
    if (status) {
        return tribo_driver_fail(drv, status, "method %s: %s", drv->at_work->name, tribo_system_message(drv->sys));
    }
    tribo_driver *inner = c->inner[which];
    const tribo_driver before = *inner;
    if (inner->abstol != drv->abstol || inner->reltol != drv->reltol) {
        inner->revision = SIZE_MAX;
    }
    inner->abstol = drv->abstol;
    inner->reltol = drv->reltol;
    inner->output = drv->output;
    inner->seen = drv->seen;
    inner->data = drv->data;
    status = x->finds ? inner->method->find_periodic(inner, *x->t, x->period, x->y)
                      : tribo_driver_advance_motion(inner, x->t, x->t1, x->y);
    /* evaluations of an advance: counted by tribo_driver_advance_motion for drv */
    drv->steps += inner->steps - before.steps;
    drv->rejected += inner->rejected - before.rejected;
    drv->events += inner->events - before.events;
    drv->periods += inner->periods - before.periods;
    drv->newton += inner->newton - before.newton;
    drv->evaluations += x->finds ? inner->evaluations - before.evaluations : 0;
    drv->excess = greater(drv->excess, inner->excess);
    drv->backslip = greater(drv->backslip, inner->backslip);
    if (x->finds) {
        drv->shooting = inner->shooting;
    }
    const int kept = x->finds ? TRIBO_OK : tribo_driver_keep(drv, *x->t, x->y);
    if (status && !(which == EXACT && status == TRIBO_ERR_UNSUPPORTED)) {
        tribo_driver_fail(drv, status, "%s", inner->message);
    }
    return status ? status : kept;
}

static int choose_and_delegate(tribo_driver *drv, const struct task *x)
{
    struct choice *c = drv->own;
    if (driver_choose(drv) == EXACT) {
        const int status = delegate(drv, EXACT, x);
        if (status != TRIBO_ERR_UNSUPPORTED) {
            return status;
        }
        c->refused = 1;
        c->revision = tribo_system_revision(drv->sys);
    }
    return delegate(drv, EVENT, x);
}

static int advance_choice(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    (void)continues;
    return choose_and_delegate(drv, &(struct task){.t = t, .t1 = t1, .y = y});
}

static int find_by_choice(tribo_driver *drv, double t, double period, double *y)
{
    return choose_and_delegate(drv, &(struct task){.t = &t, .period = period, .y = y, .finds = 1});
}

static const struct method automatic = {.name = "auto",
                                        .takes = TAKES_TOLERANCE | TAKES_OUTPUT,
                                        .create = create_choice,
                                        .destroy = destroy_choice,
                                        .advance = advance_choice,
                                        .find_periodic = find_by_choice};
