/* SPDX-License-Identifier: BSD-3-Clause */
#include <stdio.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_spmatrix.h>
#include <tribo/tribo_gsl.h>

/* A free oscillator whose friction is all that moves it, which is not at all; the matrices are GSL's. */
int main(void)
{
    double t = 0, y[3] = {0.5, 0, 0};
    tribo_model *model = NULL;
    tribo_system *sys = NULL;
    tribo_driver *drv = NULL;
    gsl_spmatrix *one = gsl_spmatrix_alloc(1, 1);
    int ok;

    gsl_spmatrix_set(one, 0, 0, 1);
    ok = tribo_model_create(&model, 1, 1) == TRIBO_OK && tribo_gsl_model_set_mass(model, one) == TRIBO_OK &&
         tribo_gsl_model_set_stiffness(model, one) == TRIBO_OK && tribo_gsl_model_set_direction(model, one) == TRIBO_OK &&
         tribo_system_create(&sys, model) == TRIBO_OK && tribo_set_limit_all(tribo_system_context(sys), 1) == TRIBO_OK &&
         tribo_gsl_driver_create(&drv, sys, "rk8pd") == TRIBO_OK && tribo_driver_set_tolerance(drv, 1e-9, 1e-9) == TRIBO_OK &&
         tribo_driver_advance(drv, &t, M_PI, y) == TRIBO_OK && gsl_fcmp(y[0], 0.5, 1e-9) == 0;
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    tribo_model_destroy(model);
    gsl_spmatrix_free(one);
    printf("q(%g) = %g\n", t, y[0]);
    return ok ? 0 : 1;
}
