/* SPDX-License-Identifier: BSD-3-Clause */
/* Reduction to a tolerance, by bisection of the number of modes. */
#include <math.h>

#include "dynamics/system/model.h"

/* FIRST: first number of modes. The bisection ends at a difference of 1 + enough/CLOSE modes. */
enum { FIRST = 8, CLOSE = 8 };

int tribo_system_reduce_to(tribo_system **sys, tribo_model *model, double omega, double tolerance, int statics)
{
    if (!model) {
        return TRIBO_ERR_NULL;
    }
    if (!sys) {
        return tribo_error(model->message, TRIBO_ERR_NULL, "sys is NULL");
    }
    int status = tribo_check_number(model->message, NOT_NEGATIVE, omega, "omega = %g", omega);
    status = status ? status : tribo_check_number(model->message, POSITIVE, tolerance, "tolerance = %g", tolerance);
    const size_t most = model->ndof;
    size_t few = 0, enough = 0, nmode = FIRST < most ? FIRST : most; /* number of modes: too few, enough */
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
            status = tribo_error(model->message, TRIBO_ERR_UNSUPPORTED, "tolerance = %g is less than the error of all modes",
                                 tolerance);
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
