/* SPDX-License-Identifier: BSD-3-Clause */
/* Drivers: settings, queries, and advances that restore the last good state after an error. */
#include "driver.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/real.h"
#include "common/layout.h"

int tribo_driver_create_method(tribo_driver **drv, tribo_system *sys, const struct method *m)
{
    int status = tribo_system_take_settings(sys);
    status = status ? status : tribo_system_check_contacts(sys, m->name, tribo_method_scalar(m));
    if (!status && m->takes & NEEDS_MASS) {
        char who[40];
        snprintf(who, sizeof who, "method %s", m->name);
        status = tribo_system_check_mass(sys, who);
    }
    status = status || m->takes & TAKES_UNSOLVED ? status : tribo_system_check_solved(sys, m->name);
    if (status) {
        return status;
    }
    const size_t size = tribo_system_size(sys), shown = sys->expansion.place ? tribo_system_dimension(sys) : 0;
    tribo_driver *d, new = {.sys = sys, .revision = SIZE_MAX, .method = m, .at_work = m};
    if (!ALLOCATE(ARRAY(d, 1), ARRAY(new.state, size), ARRAY(new.slope, size), ARRAY(new.motion, shown), ARRAY(new.shown, shown),
                  ARRAY(new.message, TRIBO_MESSAGE))) {
        return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for a driver of %zu equation%s", size, plural(size));
    }
    new.motion = shown ? new.motion : NULL;
    new.shown = shown ? new.shown : NULL;
    *d = new;
    tribo_system_order_snaps(sys);
    status = m->create ? m->create(d) : TRIBO_OK;
    if (status) {
        tribo_driver_destroy(d);
        return status;
    }
    *drv = d;
    return TRIBO_OK;
}

void tribo_driver_destroy(tribo_driver *drv)
{
    if (!drv) {
        return;
    }
    tribo_shooting_free(drv->shooting);
    drv->method->destroy(drv);
    free(drv);
}

const char *tribo_driver_method(const tribo_driver *drv)
{
    return drv ? drv->at_work->name : NULL;
}

const char *tribo_driver_message(const tribo_driver *drv)
{
    return drv ? drv->message : "drv is NULL";
}

int tribo_driver_pass(const tribo_driver *drv, int status)
{
    return status ? tribo_error(drv->message, status, "%s", tribo_system_message(drv->sys)) : TRIBO_OK;
}

int tribo_driver_explain(tribo_driver *drv, double t, double h)
{
    return tribo_error(drv->message, drv->sys->status, "at t = %.17g, in a step of %g: %s", t, h, tribo_system_message(drv->sys));
}

/* -------------------------------------------------------------------------------------------------------------- settings */

int tribo_driver_set_observer(tribo_driver *drv, int (*seen)(const tribo_moment *moment, void *data), void *data)
{
    if (!drv) {
        return TRIBO_ERR_NULL;
    }
    drv->seen = seen;
    drv->data = data;
    return TRIBO_OK;
}

/* Returns TRIBO_OK if the method of drv accepts the setting, a bit TAKES_..., and value, called name, is positive. text: the
 * setting, and the methods that accept it. */
static int check_setting(const tribo_driver *drv, int setting, const char *text, const char *name, double value)
{
    return !drv ? TRIBO_ERR_NULL
           : drv->method->takes & setting
               ? tribo_check_number(drv->message, POSITIVE, value, "%s = %g", name, value)
               : tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED, "method %s takes no %s do", drv->method->name, text);
}

int tribo_driver_set_step(tribo_driver *drv, double dt)
{
    const int status =
        check_setting(drv, TAKES_STEP, "step; rk4/fixed, central/fixed, moreau/fixed and GSL's adaptive methods", "dt", dt);
    if (!status) {
        drv->dt = dt;
        drv->revision = SIZE_MAX;
    }
    return status;
}

int tribo_driver_set_tolerance(tribo_driver *drv, double abstol, double reltol)
{
    int status = check_setting(drv, TAKES_TOLERANCE, "tolerance; event, auto and GSL's adaptive methods", "abstol", abstol);
    status = status ? status : tribo_check_number(drv->message, NOT_NEGATIVE, reltol, "reltol = %g", reltol);
    if (!status) {
        drv->abstol = abstol;
        drv->reltol = reltol;
        drv->revision = SIZE_MAX;
    }
    return status;
}

int tribo_driver_set_output(tribo_driver *drv, double dt)
{
    const int status = check_setting(drv, TAKES_OUTPUT, "output; exact, event and auto", "dt", dt);
    if (!status) {
        drv->output = dt;
    }
    return status;
}

int tribo_driver_set_max_step(tribo_driver *drv, double h)
{
    const int status = check_setting(drv, TAKES_MAX_STEP, "largest step; GSL's adaptive methods", "h", h == HUGE_VAL ? 1.0 : h);
    if (!status) {
        drv->max_step = h;
    }
    return status;
}

/* --------------------------------------------------------------------------------------------------------------- queries */

/* Returns TRIBO_OK if drv and value are not NULL. */
static int check_query(const tribo_driver *drv, const void *value)
{
    return drv && value ? TRIBO_OK : drv ? tribo_error(drv->message, TRIBO_ERR_NULL, "value is NULL") : TRIBO_ERR_NULL;
}

int tribo_driver_count(const tribo_driver *drv, int which, size_t *value)
{
    const int status = check_query(drv, value);
    if (status) {
        return status;
    }
    enum { FIRST = TRIBO_COUNT_STEPS };
    const size_t counts[] = {
        [TRIBO_COUNT_STEPS - FIRST] = drv->steps,
        [TRIBO_COUNT_REJECTED - FIRST] = drv->rejected,
        [TRIBO_COUNT_EVALUATIONS - FIRST] = drv->evaluations,
        [TRIBO_COUNT_JACOBIANS - FIRST] = drv->jacobians,
        [TRIBO_COUNT_EVENTS - FIRST] = drv->events,
        [TRIBO_COUNT_PERIODS - FIRST] = drv->periods,
        [TRIBO_COUNT_NEWTON - FIRST] = drv->newton,
        [TRIBO_COUNT_RESTED - FIRST] = drv->rested,
    };
    if (which >= FIRST && (size_t)which - FIRST < sizeof counts / sizeof *counts) {
        *value = counts[which - FIRST];
        return TRIBO_OK;
    }
    return tribo_error(drv->message, TRIBO_ERR_RANGE, "which = %d is no count of a driver", which);
}

int tribo_driver_real(const tribo_driver *drv, int which, double *value)
{
    const int status = check_query(drv, value);
    if (status) {
        return status;
    }
    if (which != TRIBO_REAL_EXCESS && which != TRIBO_REAL_BACKSLIP) {
        return tribo_error(drv->message, TRIBO_ERR_RANGE, "which = %d is no real quantity of a driver", which);
    }
    if (!(drv->method->takes & TAKES_OUTPUT)) {
        return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED, "method %s does not bound how far the motion strays",
                           drv->method->name);
    }
    *value = which == TRIBO_REAL_EXCESS ? drv->excess : drv->backslip;
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------- states */

int tribo_driver_check(tribo_driver *drv, const double *y)
{
    if (tribo_dense_finite(y, tribo_system_size(drv->sys))) {
        return TRIBO_OK;
    }
    const double *shown = drv->shown ? drv->shown : y;
    size_t i = 0;
    if (drv->shown) {
        tribo_system_write_state(drv->sys, drv->time, y, drv->shown);
    }
    while (i + 1 < tribo_system_dimension(drv->sys) && isfinite(shown[i])) {
        i++;
    }
    char why[60] = "";
    if (drv->dt > 0.0) {
        snprintf(why, sizeof why, ", or dt = %g is too long", drv->dt);
    }
    return tribo_error(drv->message, TRIBO_ERR_NOT_FINITE, "y[%zu] = %g after t = %.17g: the motion grows without bound%s", i,
                       shown[i], drv->time, why);
}

void tribo_driver_keep(tribo_driver *drv, double t, const double *y)
{
    drv->time = t;
    memcpy(drv->state, y, tribo_system_size(drv->sys) * sizeof *y);
}

int tribo_driver_show(tribo_driver *drv, double t, const double *y, int kind, size_t contact)
{
    const tribo_moment moment = {sizeof moment, t, drv->shown ? drv->shown : y, kind, contact};
    if (drv->seen && drv->shown) {
        tribo_system_write_state(drv->sys, t, y, drv->shown);
    }
    const int answer = drv->seen ? drv->seen(&moment, drv->data) : 0;
    return answer ? tribo_error(drv->message, TRIBO_ERR_STOPPED, "the observer answered %d at t = %.17g", answer, t) : TRIBO_OK;
}

int tribo_driver_accept(tribo_driver *drv, double t, const double *y)
{
    const int status = tribo_driver_check(drv, y);
    if (status) {
        return status;
    }
    tribo_driver_keep(drv, t, y);
    return tribo_driver_show(drv, t, y, TRIBO_MOMENT_STEP, SIZE_MAX);
}

/* tribo_driver_advance for a methods' state y [tribo_system_size]. */
static int advance_motion(tribo_driver *drv, double *t, double t1, double *y)
{
    tribo_system *sys = drv->sys;
    const struct method *method = drv->method;
    int status = tribo_system_take_settings(sys);
    if (!status && (method->takes & (TAKES_STEP | TAKES_TOLERANCE)) == TAKES_STEP && drv->dt == 0.0) {
        return tribo_error(drv->message, TRIBO_ERR_STATE, "method %s has no step: call tribo_driver_set_step", method->name);
    }
    status = status ? status : tribo_system_check_contacts(sys, method->name, tribo_method_scalar(method));
    if (status || t1 == *t) {
        return tribo_driver_pass(drv, status);
    }
    const size_t bytes = tribo_system_size(sys) * sizeof *y, evaluations = sys->evaluations, jacobians = sys->jacobians;
    const int continues = *t == drv->time && drv->revision == tribo_system_revision(sys) && memcmp(y, drv->state, bytes) == 0;
    tribo_driver_keep(drv, *t, y);
    status = method->advance(drv, t, t1, y, continues);
    status = status ? status : tribo_driver_check(drv, y);
    if (!status) {
        tribo_driver_keep(drv, *t, y);
    }
    *t = drv->time;
    memcpy(y, drv->state, bytes);
    drv->revision = status == TRIBO_OK || status == TRIBO_ERR_STOPPED ? tribo_system_revision(sys) : SIZE_MAX;
    drv->evaluations += sys->evaluations - evaluations;
    drv->jacobians += sys->jacobians - jacobians;
    return status;
}

int tribo_driver_advance(tribo_driver *drv, double *t, double t1, double *y)
{
    if (!drv || !t) {
        return drv ? tribo_error(drv->message, TRIBO_ERR_NULL, "t is NULL") : TRIBO_ERR_NULL;
    }
    int status = tribo_driver_pass(drv, tribo_system_check_state(drv->sys, *t, y));
    status = status ? status : tribo_check_number(drv->message, FINITE, t1, "t1 = %g", t1);
    if (!status && t1 < *t) {
        status = tribo_error(drv->message, TRIBO_ERR_RANGE, "t1 = %.17g is before t = %.17g", t1, *t);
    }
    if (status || !drv->motion) {
        return status ? status : advance_motion(drv, t, t1, y);
    }
    tribo_system_write_state(drv->sys, drv->time, drv->state, drv->shown);
    if (memcmp(y, drv->shown, tribo_system_dimension(drv->sys) * sizeof *y) == 0) { /* an unchanged y keeps f */
        memcpy(drv->motion, drv->state, tribo_system_size(drv->sys) * sizeof *y);
    } else {
        tribo_system_read_state(drv->sys, y, drv->motion);
    }
    status = advance_motion(drv, t, t1, drv->motion);
    tribo_system_write_state(drv->sys, *t, drv->motion, y);
    return status;
}
