#ifndef TRIBO_RK4_H
#define TRIBO_RK4_H

#include <gsl/gsl_odeiv2.h>

extern const gsl_odeiv2_step_type *tribo_step_rk4;

#endif
