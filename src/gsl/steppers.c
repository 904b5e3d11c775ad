/* GSL's steppers, adaptive, and the classical Runge-Kutta method with fixed steps. */
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "driver.h"
#include "rk4.h"

/* Why GSL gave up. */
static int explain(tribo_driver *drv, int gsl_status, double t, double h)
{
    if (drv->sys->status) {
        return tribo_driver_fail(drv, drv->sys->status, "at t = %.17g: %s", t, tribo_message(drv->sys->contacts));
    }
    return tribo_driver_fail(drv, TRIBO_ERR_STEP, "step from t = %.17g failed down to a length of %g: %s", t, h,
                             gsl_strerror(gsl_status));
}

/* ------------------------------------------------------------------------------------------------- rk4 with fixed steps */

static void destroy_rk4(tribo_driver *drv)
{
    gsl_odeiv2_step *step = drv->own;
    if (step && step->state) {
        step->type->free(step->state);
    }
    free(step);
}

/* Not by gsl_odeiv2_step_alloc, which would abort if there were no memory. */
static int create_rk4(tribo_driver *drv)
{
    gsl_odeiv2_step *step = malloc(sizeof *step);
    drv->own = step;
    if (step) {
        *step = (gsl_odeiv2_step){tribo_step_rk4, drv->sys->odeiv2.dimension, tribo_step_rk4->alloc(drv->sys->odeiv2.dimension)};
    }
    return step && step->state ? TRIBO_OK : tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method rk4/fixed");
}

static int rk4_step(tribo_driver *drv, double t, double next, double *y)
{
    int status = tribo_system_begin_step(drv->sys, t, y, drv->slope);
    if (status) {
        return explain(drv, GSL_EBADFUNC, t, next - t);
    }
    status = gsl_odeiv2_step_apply(drv->own, t, next - t, y, NULL, drv->slope, NULL, &drv->sys->odeiv2);
    return status ? explain(drv, status, t, next - t) : TRIBO_OK;
}

static int advance_rk4(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    (void)continues;
    return tribo_driver_fixed_steps(drv, t, t1, y, rk4_step);
}

const struct method tribo_method_rk4_fixed = {"rk4/fixed", 0, create_rk4, destroy_rk4, advance_rk4, NULL};

/* ------------------------------------------------------------------------------------------------------- GSL's steppers */

static int create(tribo_driver *drv)
{
    const gsl_odeiv2_step_type *type = *(const gsl_odeiv2_step_type *const *)drv->method->with;
    drv->own = gsl_odeiv2_driver_alloc_y_new(&drv->sys->odeiv2, type, drv->dt, drv->abstol, drv->reltol);
    return drv->own ? TRIBO_OK : tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method %s", drv->method->name);
}

static void destroy(tribo_driver *drv)
{
    if (drv->own) {
        gsl_odeiv2_driver_free(drv->own);
    }
}

static int advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    gsl_odeiv2_driver *gsl = drv->own;
    const size_t bytes = tribo_system_dimension(drv->sys) * sizeof *y;
    int law, status = TRIBO_OK;
    if (!continues) {
        gsl_odeiv2_evolve_reset(gsl->e);
        gsl_odeiv2_step_reset(gsl->s);
        gsl->h = drv->dt;
    }
    tribo_get_law(drv->sys->contacts, &law);
    while (!status && *t < t1) {
        const unsigned long failed = gsl->e->failed_steps;
        const double good = *t;
        memcpy(drv->state, y, bytes);
        const int result = gsl_odeiv2_evolve_apply(gsl->e, gsl->c, gsl->s, gsl->sys, t, t1, &gsl->h, y);
        drv->rejected += gsl->e->failed_steps - failed;
        if (result) {
            /* GSL may leave the step that it was not content with */
            *t = good;
            memcpy(y, drv->state, bytes);
            return explain(drv, result, *t, gsl->h);
        }
        drv->steps++;
        if (law == TRIBO_QUINN_REVERSAL && tribo_system_begin_step(drv->sys, *t, y, drv->slope)) {
            return explain(drv, GSL_EBADFUNC, *t, gsl->h);
        }
        status = tribo_driver_tell(drv, *t, y, 0);
    }
    return status;
}

#define GSL_METHOD(id, type) const struct method tribo_method_##id = {#id, 1, create, destroy, advance, &type};
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
