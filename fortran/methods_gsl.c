/* SPDX-License-Identifier: BSD-3-Clause */
/* Methods of drivers in a build with GSL: those of tribo_dynamics.h, followed by GSL's steppers. */
#include "tribo/tribo_gsl.h"

#include "dynamics.h"

int tribo_fortran_method_count(void)
{
    return tribo_method_count() + tribo_gsl_stepper_count();
}

const char *tribo_fortran_method_name(int method)
{
    const int stepper = method - tribo_method_count();
    return stepper < 0 ? tribo_method_name(method) : tribo_gsl_stepper_name(stepper);
}

int tribo_fortran_driver_create(tribo_driver **drv, tribo_system *sys, const char *method)
{
    const int status = tribo_gsl_driver_create(drv, sys, method);
    return status == TRIBO_ERR_NAME ? tribo_driver_create(drv, sys, method) : status;
}
