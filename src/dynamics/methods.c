/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of methods, and method "auto". */
#include "driver.h"

#include <stdio.h>
#include <string.h>

#include "common/text.h"

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
    int status = tribo_system_check_given(sys, drv, "drv");
    status = status ? status : tribo_system_check_given(sys, method, "method");
    for (int i = 0; !status && i < tribo_method_count(); i++) {
        if (tribo_same_name(methods[i]->name, method)) {
            return tribo_driver_create_method(drv, sys, methods[i]);
        }
    }
    char list[200];
    for (int i = 0, used = 0; i < tribo_method_count(); i++) {
        used += snprintf(list + used, sizeof list - (size_t)used, "%s%s", i ? ", " : "", methods[i]->name);
    }
    return status ? status
                  : tribo_error(sys->message, TRIBO_ERR_NAME,
                                "method \"%.20s\" is unknown; there are %s; tribo_gsl_driver_create takes GSL's steppers", method,
                                list);
}

/* ------------------------------------------------------------------------------------------------------ method "auto" */

enum { EVENT, EXACT };

static const struct method *const choices[] = {&tribo_method_event, &tribo_method_exact};

/* Returns EXACT for up to 200 degrees of freedom, where modes are cheap, unless exact refused the system; else EVENT. */
static int driver_choose(const tribo_driver *drv)
{
    const tribo_system *sys = drv->sys;
    const int refused = drv->choice.refused && drv->choice.revision == tribo_system_revision(sys);
    return sys->ndof <= 200 && !refused ? EXACT : EVENT;
}

/* Makes a method that takes the contacts the one at work, with its data. Returns a status; the message is in the system. */
static int set_to_work(tribo_driver *drv, int which)
{
    const struct method *m = drv->at_work = choices[which];
    drv->own = drv->choice.own[which];
    int status = tribo_system_check_contacts(drv->sys, m->name, tribo_method_scalar(m));
    status = status || drv->own ? status : m->create(drv);
    if (status) {
        drv->at_work->destroy(drv);
        drv->own = NULL;
        tribo_error(drv->message, status, "method %s: %s", drv->at_work->name, tribo_system_message(drv->sys));
    }
    drv->choice.own[which] = drv->own;
    return status;
}

static void destroy_choice(tribo_driver *drv)
{
    for (int which = EVENT; which <= EXACT; which++) {
        drv->own = drv->choice.own[which];
        choices[which]->destroy(drv);
    }
}

/* Returns 1 if exact, chosen, has refused the system with this status: event is next. */
static int is_refused(tribo_driver *drv, int which, int status)
{
    if (which == EVENT || status != TRIBO_ERR_UNSUPPORTED) {
        return 0;
    }
    drv->choice.refused = 1;
    drv->choice.revision = tribo_system_revision(drv->sys);
    drv->message[0] = '\0';
    return 1;
}

static int create_choice(tribo_driver *drv)
{
    const int which = driver_choose(drv), status = set_to_work(drv, which);
    return is_refused(drv, which, status) ? set_to_work(drv, EVENT) : status;
}

static int advance_choice(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    const struct method *last = drv->at_work;
    for (int which = driver_choose(drv);; which = EVENT) {
        int status = set_to_work(drv, which);
        status = status ? status : drv->at_work->advance(drv, t, t1, y, continues && last == drv->at_work);
        if (!is_refused(drv, which, status)) {
            return status;
        }
        *t = drv->time;
        memcpy(y, drv->state, tribo_system_size(drv->sys) * sizeof *y);
        continues = 0;
    }
}

static int find_by_choice(tribo_driver *drv, struct wanted *w)
{
    for (int which = driver_choose(drv);; which = EVENT) {
        int status = set_to_work(drv, which);
        status = status ? status : drv->at_work->find_periodic(drv, w);
        if (!is_refused(drv, which, status)) {
            return status;
        }
    }
}

static const struct method automatic = {.name = "auto",
                                        .takes = TAKES_TOLERANCE | TAKES_OUTPUT | TAKES_PAIRS,
                                        .create = create_choice,
                                        .destroy = destroy_choice,
                                        .advance = advance_choice,
                                        .find_periodic = find_by_choice};
