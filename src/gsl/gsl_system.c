/* SPDX-License-Identifier: BSD-3-Clause */
#include "gsl_system.h"

#include <stdlib.h>

#include <gsl/gsl_errno.h>

#include "tribo/tribo_gsl.h"

int tribo_gsl_status(int status)
{
    return !status ? GSL_SUCCESS : status == TRIBO_ERR_NOT_FINITE ? GSL_FAILURE : GSL_EBADFUNC;
}

static int right_hand_side(double t, const double y[], double dydt[], void *params)
{
    return tribo_gsl_status(tribo_system_derivative(params, t, y, dydt));
}

static int jacobian(double t, const double y[], double *dfdy, double dfdt[], void *params)
{
    return tribo_gsl_status(tribo_system_jacobian(params, t, y, dfdy, dfdt));
}

const gsl_odeiv2_system *tribo_gsl_system(tribo_system *sys)
{
    static const char key;
    gsl_odeiv2_system *s = tribo_system_attached(sys, &key);
    if (s || !sys) {
        return s;
    }
    s = malloc(sizeof *s);
    if (s) {
        s->function = right_hand_side;
        s->jacobian = jacobian;
        s->dimension = tribo_system_dimension(sys);
        s->params = sys;
    }
    if (!s || tribo_system_attach(sys, &key, s, free)) {
        free(s);
        tribo_system_set_message(sys, TRIBO_ERR_MEMORY, "out of memory for GSL's view of the system");
        return NULL;
    }
    return s;
}
