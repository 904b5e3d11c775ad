/* SPDX-License-Identifier: BSD-3-Clause */
/* Methods of drivers in a build without GSL: those of tribo_dynamics.h. */
#include "dynamics.h"

int tribo_fortran_method_count(void)
{
    return tribo_method_count();
}

const char *tribo_fortran_method_name(int method)
{
    return tribo_method_name(method);
}

int tribo_fortran_driver_create(tribo_driver **drv, tribo_system *sys, const char *method)
{
    return tribo_driver_create(drv, sys, method);
}
