/* SPDX-License-Identifier: BSD-3-Clause */
/* Reduction to a tolerance, by bisection of the number of modes. */
#include <math.h>
#include <stdio.h>

#include "tribo/tribo_dynamics.h"

/* FIRST: first number of modes. The bisection ends at a difference of 1 + enough/CLOSE modes. */
enum { FIRST = 8, CLOSE = 8 };

static int refuse(tribo_model *model, int status, const char *name, double value, const char *text)
{
    char message[80];
    snprintf(message, sizeof message, "%s = %g is %s", name, value, text);
    return tribo_model_refuse(model, status, message);
}

int tribo_system_reduce_to(tribo_system **sys, tribo_model *model, double omega, double tolerance, int statics)
{
    if (!model) {
        return TRIBO_ERR_NULL;
    }
    if (!sys) {
        return tribo_model_refuse(model, TRIBO_ERR_NULL, "sys is NULL");
    }
    if (!isfinite(omega) || !isfinite(tolerance)) {
        return isfinite(omega) ? refuse(model, TRIBO_ERR_NOT_FINITE, "tolerance", tolerance, "not finite")
                               : refuse(model, TRIBO_ERR_NOT_FINITE, "omega", omega, "not finite");
    }
    if (omega < 0.0 || tolerance <= 0.0) {
        return omega < 0.0 ? refuse(model, TRIBO_ERR_NEGATIVE, "omega", omega, "negative")
                           : refuse(model, TRIBO_ERR_NOT_POSITIVE, "tolerance", tolerance, "not positive");
    }
    const size_t most = tribo_model_ndof(model);
    size_t few = 0, enough = 0, nmode = FIRST < most ? FIRST : most; /* number of modes: too few, enough */
    int status = TRIBO_OK;
    tribo_system *best = NULL;
    while (!status && (enough == 0 || enough - few > 1 + enough / CLOSE)) {
        tribo_system *found = NULL;
        double error = HUGE_VAL;
        status = tribo_system_reduce(&found, model, nmode, statics);
        status = status ? status : tribo_system_get_truncation(found, omega, &error);
        if (!status && error <= tolerance) {
            tribo_system_destroy(best);
            best = found;
            enough = nmode;
        } else {
            tribo_system_destroy(found);
            few = nmode;
        }
        if (!status && few == most) {
            status = refuse(model, TRIBO_ERR_UNSUPPORTED, "tolerance", tolerance, "less than the error of all modes");
        }
        nmode = enough ? few + (enough - few) / 2 : nmode < most / 2 ? 2 * nmode : most;
    }
    if (status) {
        tribo_system_destroy(best);
        return status;
    }
    *sys = best;
    return TRIBO_OK;
}
