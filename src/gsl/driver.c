/* Integration in time: a method by name, and the loop over its steps. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "driver.h"

static const struct method *const methods[] = {
    &tribo_method_rk4_fixed, &tribo_method_rk2,   &tribo_method_rk4,           &tribo_method_rkf45,
    &tribo_method_rkck,      &tribo_method_rk8pd, &tribo_method_rk1imp,        &tribo_method_rk2imp,
    &tribo_method_rk4imp,    &tribo_method_bsimp, &tribo_method_msadams,       &tribo_method_msbdf,
    &tribo_method_exact,     &tribo_method_event, &tribo_method_central_fixed, &tribo_method_moreau_fixed,
};

int tribo_method_count(void)
{
    return (int)(sizeof methods / sizeof *methods);
}

const char *tribo_method_name(int method)
{
    return method >= 0 && method < tribo_method_count() ? methods[method]->name : NULL;
}

/* Exact pays while modes are found in no time and the right-hand side is harmonic. */
static const struct method *automatic(const tribo_system *sys)
{
    const int small = sys->ndof <= 200 && !sys->tables && !sys->limits.knots;
    return small ? &tribo_method_exact : &tribo_method_event;
}

static const struct method *find(const tribo_system *sys, const char *name)
{
    for (int i = 0; i < tribo_method_count(); i++) {
        if (strcmp(methods[i]->name, name) == 0) {
            return methods[i];
        }
    }
    return strcmp(name, "auto") == 0 ? automatic(sys) : NULL;
}

static int check_parameters(const tribo_system *sys, const struct method *method, double dt, double abstol, double reltol)
{
    const struct {
        const char *name;
        double value;
        int positive;
    } all[] = {{"dt", dt, 1}, {"abstol", abstol, method->adaptive}, {"reltol", reltol, 0}};
    for (size_t i = 0; i < 3; i++) {
        if (!isfinite(all[i].value)) {
            return tribo_system_fail(sys, TRIBO_ERR_NOT_FINITE, "%s = %g is not finite", all[i].name, all[i].value);
        }
        if (all[i].positive && all[i].value <= 0.0) {
            return tribo_system_fail(sys, TRIBO_ERR_NOT_POSITIVE, "%s = %g is not positive", all[i].name, all[i].value);
        }
        if (all[i].value < 0.0) {
            return tribo_system_fail(sys, TRIBO_ERR_NEGATIVE, "%s = %g is negative", all[i].name, all[i].value);
        }
    }
    return TRIBO_OK;
}

int tribo_driver_create(tribo_driver **drv, tribo_system *sys, const char *method, double dt, double abstol, double reltol)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (!drv || !method) {
        return tribo_system_fail(sys, TRIBO_ERR_NULL, "%s is NULL", drv ? "method" : "drv");
    }
    const struct method *m = find(sys, method);
    if (!m) {
        return tribo_system_fail(sys, TRIBO_ERR_NAME, "method \"%s\" is unknown", method);
    }
    int status = check_parameters(sys, m, dt, abstol, reltol);
    if (status) {
        return status;
    }
    tribo_driver *d = calloc(1, sizeof *d);
    const size_t dimension = tribo_system_dimension(sys);
    double *work = malloc(2 * dimension * sizeof *work);
    if (!d || !work) {
        free(d);
        free(work);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for a driver of %zu equations", dimension);
    }
    d->sys = sys;
    d->method = m;
    d->dt = dt;
    d->abstol = abstol;
    d->reltol = reltol;
    d->state = work;
    d->slope = work + dimension;
    d->time = NAN;
    d->excess = d->backslip = NAN;
    status = m->create(d);
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
    drv->method->destroy(drv);
    free(drv->state);
    free(drv);
}

const char *tribo_driver_method(const tribo_driver *drv)
{
    return drv ? drv->method->name : NULL;
}

const char *tribo_driver_message(const tribo_driver *drv)
{
    return drv ? drv->message : "drv is NULL";
}

int tribo_driver_fail(tribo_driver *drv, int status, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(drv->message, sizeof drv->message, format, args);
    va_end(args);
    return status;
}

int tribo_driver_set_observer(tribo_driver *drv, int (*seen)(double t, const double *y, int event, void *data), void *data)
{
    if (!drv) {
        return TRIBO_ERR_NULL;
    }
    drv->seen = seen;
    drv->data = data;
    return TRIBO_OK;
}

int tribo_driver_count(const tribo_driver *drv, int which, size_t *value)
{
    if (!drv || !value) {
        return TRIBO_ERR_NULL;
    }
    switch (which) {
    case TRIBO_COUNT_STEPS:
        *value = drv->steps;
        return TRIBO_OK;
    case TRIBO_COUNT_REJECTED:
        *value = drv->rejected;
        return TRIBO_OK;
    case TRIBO_COUNT_EVALUATIONS:
        *value = drv->evaluations;
        return TRIBO_OK;
    case TRIBO_COUNT_JACOBIANS:
        *value = drv->jacobians;
        return TRIBO_OK;
    case TRIBO_COUNT_EVENTS:
        *value = drv->events;
        return TRIBO_OK;
    default:
        return TRIBO_ERR_RANGE;
    }
}

int tribo_driver_real(const tribo_driver *drv, int which, double *value)
{
    if (!drv || !value) {
        return TRIBO_ERR_NULL;
    }
    if (which != TRIBO_REAL_EXCESS && which != TRIBO_REAL_BACKSLIP) {
        return TRIBO_ERR_RANGE;
    }
    const double found = which == TRIBO_REAL_EXCESS ? drv->excess : drv->backslip;
    if (isnan(found)) {
        return TRIBO_ERR_UNSUPPORTED;
    }
    *value = found;
    return TRIBO_OK;
}

int tribo_driver_tell(tribo_driver *drv, double t, const double *y, int event)
{
    const int answer = drv->seen ? drv->seen(t, y, event, drv->data) : 0;
    return answer ? tribo_driver_fail(drv, TRIBO_ERR_STOPPED, "the observer answered %d at t = %.17g", answer, t) : TRIBO_OK;
}

int tribo_driver_fixed_steps(tribo_driver *drv, double *t, double t1, double *y,
                             int (*step)(tribo_driver *, double, double, double *))
{
    const size_t bytes = tribo_system_dimension(drv->sys) * sizeof *y;
    const double begin = *t, whole = (t1 - begin) / drv->dt;
    /* a rest that is only rounding is spread over the steps */
    const double steps = fabs(whole - round(whole)) < 1e-6 && whole > 0.5 ? round(whole) : ceil(whole);
    const double h = whole > steps ? (t1 - begin) / steps : drv->dt;
    for (double k = 1.0; k <= steps; k++) {
        const double next = k < steps ? begin + k * h : t1;
        memcpy(drv->state, y, bytes);
        int status = step(drv, *t, next, y);
        if (status) {
            memcpy(y, drv->state, bytes);
            return status;
        }
        *t = next;
        drv->steps++;
        status = tribo_driver_tell(drv, *t, y, 0);
        if (status) {
            return status;
        }
    }
    return TRIBO_OK;
}

int tribo_driver_advance(tribo_driver *drv, double *t, double t1, double *y)
{
    if (!drv) {
        return TRIBO_ERR_NULL;
    }
    if (!t || !y) {
        return tribo_driver_fail(drv, TRIBO_ERR_NULL, "%s is NULL", t ? "y" : "t");
    }
    const int status = tribo_system_check_state(drv->sys, *t, y);
    if (status) {
        return tribo_driver_fail(drv, status, "%s", tribo_message(drv->sys->contacts));
    }
    if (!isfinite(t1)) {
        return tribo_driver_fail(drv, TRIBO_ERR_NOT_FINITE, "t1 = %g is not finite", t1);
    }
    if (t1 < *t) {
        return tribo_driver_fail(drv, TRIBO_ERR_RANGE, "t1 = %.17g is before t = %.17g", t1, *t);
    }
    const size_t bytes = tribo_system_dimension(drv->sys) * sizeof *y;
    const int continues = *t == drv->time && memcmp(y, drv->state, bytes) == 0;
    const size_t evaluations = drv->sys->evaluations, jacobians = drv->sys->jacobians;
    const int result = *t < t1 ? drv->method->advance(drv, t, t1, y, continues) : TRIBO_OK;
    drv->evaluations += drv->sys->evaluations - evaluations;
    drv->jacobians += drv->sys->jacobians - jacobians;
    drv->time = *t;
    memcpy(drv->state, y, bytes);
    return result;
}
