/* SPDX-License-Identifier: BSD-3-Clause */
/* A driver with settings for any method. */
#ifndef TEST_SET_UP_DRIVER_H
#define TEST_SET_UP_DRIVER_H

#include <string.h>

#ifdef TRIBO_TESTS_WITHOUT_GSL /* no steppers */
#include "tribo/tribo_dynamics.h"
#define tribo_gsl_stepper_count() 0
#define tribo_gsl_stepper_name(stepper) NULL
#define tribo_gsl_driver_create(drv, sys, stepper) TRIBO_ERR_NAME
#else
#include "tribo/tribo_gsl.h"
#endif

/* Methods of tribo_dynamics.h and steppers of GSL in one list. NULL outside. */
static inline int any_method_count(void)
{
    return tribo_method_count() + tribo_gsl_stepper_count();
}

static inline const char *any_method_name(int i)
{
    const int stepper = i - tribo_method_count();
    return stepper < 0 ? tribo_method_name(i) : tribo_gsl_stepper_name(stepper);
}

/* A driver by the method or the stepper of that name. */
static inline int create_any_driver(tribo_driver **drv, tribo_system *sys, const char *method)
{
    const int status = tribo_driver_create(drv, sys, method);
    return status == TRIBO_ERR_NAME ? tribo_gsl_driver_create(drv, sys, method) : status;
}

/* Creates a driver, and sets what its method takes: dt as step, for exact and auto as output; tolerances where abstol > 0.
 * Returns a status; *drv = NULL if it fails. */
static inline int set_up_driver(tribo_driver **drv, tribo_system *sys, const char *method, double dt, double abstol,
                                double reltol)
{
    tribo_driver *made;
    int status = create_any_driver(&made, sys, method);
    *drv = NULL;
    if (status) {
        return status;
    }
    const int fixed = strstr(method, "/fixed") != NULL, exact = strcmp(method, "exact") == 0;
    const int automatic = strcmp(method, "auto") == 0;
    if (exact || automatic) {
        status = tribo_driver_set_output(made, dt);
    } else if (strcmp(method, "event") != 0) {
        status = tribo_driver_set_step(made, dt);
    }
    if (!status && abstol > 0.0 && !fixed && !exact) {
        status = tribo_driver_set_tolerance(made, abstol, reltol);
    }
    status = status == TRIBO_ERR_UNSUPPORTED ? TRIBO_OK : status; /* a method by other letters */
    if (status) {
        tribo_driver_destroy(made);
        return status;
    }
    *drv = made;
    return TRIBO_OK;
}

#endif
