/* GSL's steppers, adaptive, and the classical Runge-Kutta method with fixed steps. */
#include <math.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "driver.h"
#include "rk4.h"

static const gsl_odeiv2_step_type *type_of(const tribo_driver *drv)
{
    return *(const gsl_odeiv2_step_type *const *)drv->method->with;
}

static int create(tribo_driver *drv)
{
    const double abstol = drv->method->adaptive ? drv->abstol : 1.0;
    drv->own = gsl_odeiv2_driver_alloc_y_new(&drv->sys->odeiv2, type_of(drv), drv->dt, abstol, drv->reltol);
    return drv->own ? TRIBO_OK : tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method %s", drv->method->name);
}

static void destroy(tribo_driver *drv)
{
    if (drv->own) {
        gsl_odeiv2_driver_free(drv->own);
    }
}

/* Why GSL gave up. */
static int explain(tribo_driver *drv, int gsl_status, double t, double h)
{
    if (drv->sys->status) {
        return tribo_driver_fail(drv, drv->sys->status, "at t = %.17g: %s", t, tribo_message(drv->sys->contacts));
    }
    return tribo_driver_fail(drv, TRIBO_ERR_STEP, "step from t = %.17g failed down to a length of %g: %s", t, h,
                             gsl_strerror(gsl_status));
}

static int rk4_step(tribo_driver *drv, double t, double next, double *y)
{
    gsl_odeiv2_driver *gsl = drv->own;
    int status = tribo_system_begin_step(drv->sys, t, y, drv->slope);
    if (status) {
        return explain(drv, GSL_EBADFUNC, t, next - t);
    }
    status = gsl_odeiv2_step_apply(gsl->s, t, next - t, y, gsl->e->yerr, drv->slope, NULL, gsl->sys);
    return status ? explain(drv, status, t, next - t) : TRIBO_OK;
}

static int advance_fixed(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    (void)continues;
    return tribo_driver_fixed_steps(drv, t, t1, y, rk4_step);
}

static int advance_adaptive(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    gsl_odeiv2_driver *gsl = drv->own;
    size_t law_changes = 0, changes = 0;
    if (!continues) {
        gsl_odeiv2_evolve_reset(gsl->e);
        gsl_odeiv2_step_reset(gsl->s);
        gsl->h = drv->dt;
    }
    tribo_get_count(drv->sys->contacts, TRIBO_COUNT_MEMORY, &law_changes);
    const size_t bytes = tribo_system_dimension(drv->sys) * sizeof *y;
    while (*t < t1) {
        const unsigned long failed = gsl->e->failed_steps;
        const double good = *t;
        memcpy(drv->state, y, bytes);
        int status = gsl_odeiv2_evolve_apply(gsl->e, gsl->c, gsl->s, gsl->sys, t, t1, &gsl->h, y);
        drv->rejected += gsl->e->failed_steps - failed;
        if (status) {
            /* GSL may leave the step that it was not content with */
            *t = good;
            memcpy(y, drv->state, bytes);
            return explain(drv, status, *t, gsl->h);
        }
        drv->steps++;
        int law;
        tribo_get_law(drv->sys->contacts, &law);
        if (law == TRIBO_QUINN_REVERSAL) {
            status = tribo_system_begin_step(drv->sys, *t, y, drv->slope);
            if (status) {
                return explain(drv, GSL_EBADFUNC, *t, gsl->h);
            }
            /* the slope that GSL has kept of this state was that of the law before */
            tribo_get_count(drv->sys->contacts, TRIBO_COUNT_MEMORY, &changes);
            if (changes != law_changes) {
                gsl_odeiv2_evolve_reset(gsl->e);
                law_changes = changes;
            }
        }
        status = tribo_driver_tell(drv, *t, y, 0);
        if (status) {
            return status;
        }
    }
    return TRIBO_OK;
}

#define GSL_METHOD(id, type) const struct method tribo_method_##id = {#id, 1, create, destroy, advance_adaptive, &type};
GSL_METHOD(rk2, gsl_odeiv2_step_rk2)
GSL_METHOD(rk4, gsl_odeiv2_step_rk4)
GSL_METHOD(rkf45, gsl_odeiv2_step_rkf45)
GSL_METHOD(rkck, gsl_odeiv2_step_rkck)
GSL_METHOD(rk8pd, gsl_odeiv2_step_rk8pd)
GSL_METHOD(rk1imp, gsl_odeiv2_step_rk1imp)
GSL_METHOD(rk2imp, gsl_odeiv2_step_rk2imp)
GSL_METHOD(rk4imp, gsl_odeiv2_step_rk4imp)
GSL_METHOD(bsimp, gsl_odeiv2_step_bsimp)
GSL_METHOD(msadams, gsl_odeiv2_step_msadams)
GSL_METHOD(msbdf, gsl_odeiv2_step_msbdf)

const struct method tribo_method_rk4_fixed = {"rk4/fixed", 0, create, destroy, advance_fixed, &tribo_step_rk4};
