/* SPDX-License-Identifier: BSD-3-Clause */
/* tribo inside CVODE of SUNDIALS: an oscillator with long times of rest, x'' + x = f + 1.5 sin 0.5 t, |f| <= 1.
 *
 *     integrator_cvode
 *
 * Prints the error of the energy that friction takes in ten cycles and what the run took, for settings that are right and
 * wrong. */
#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "tribo/tribo.h"

/* By driver "exact". */
static const double energy = 67.67360117824;

static void need(int status, const char *text)
{
    if (status < 0 || (status > 0 && text)) {
        fprintf(stderr, "error %d %s\n", status, text ? text : "");
        exit(1);
    }
}

/* y = x, v, energy. */
static int right_side(realtype t, N_Vector y, N_Vector slope, void *data)
{
    tribo_context *contact = data;
    const double *s = N_VGetArrayPointer(y), v = s[1], a = 1.5 * sin(0.5 * t) - s[0];
    double *d = N_VGetArrayPointer(slope), f;
    if (tribo_balance(contact, &v, &a, NULL, &f)) {
        return -1;
    }
    d[0] = v;
    d[1] = a + f;
    d[2] = -f * v;
    return 0;
}

/* Derivatives of the right side, from those of f by v and a; da/dx = -1. */
static int jacobian(realtype t, N_Vector y, N_Vector slope, SUNMatrix j, void *data, N_Vector t1, N_Vector t2, N_Vector t3)
{
    tribo_context *contact = data;
    const double *s = N_VGetArrayPointer(y), v = s[1], a = 1.5 * sin(0.5 * t) - s[0];
    double f, df_dv, df_da;
    (void)slope;
    (void)t1;
    (void)t2;
    (void)t3;
    if (tribo_balance_tangent(contact, &v, &a, NULL, &f, &df_dv, &df_da)) {
        return -1;
    }
    SM_ELEMENT_D(j, 0, 1) = 1.0;
    SM_ELEMENT_D(j, 1, 0) = -1.0 - df_da;
    SM_ELEMENT_D(j, 1, 1) = df_dv;
    SM_ELEMENT_D(j, 2, 0) = v * df_da;
    SM_ELEMENT_D(j, 2, 1) = -f - v * df_dv;
    return 0;
}

/* Settings, in the order of the printed numbers. */
static const struct settings {
    const char *name;
    double epsilon, longest;             /* longest step, 0: none */
    double relative, absolute, velocity; /* tolerances: relative; absolute, of x and energy, and of v */
    int tangents;
    double least, most; /* of the error */
} settings[] = {
    {"wide", 1e-2, 0.1, 1e-8, 1e-8, 1e-5, 1, 0.0, 2e-5},        {"middle", 1e-3, 0.1, 1e-8, 1e-8, 1e-6, 1, 0.0, 3e-5},
    {"narrow", 1e-4, 0.1, 1e-8, 1e-8, 1e-7, 1, 0.0, 3e-6},      {"fine", 1e-5, 0.1, 1e-11, 1e-11, 1e-9, 1, 0.0, 3e-8},
    {"unbounded", 1e-4, 0.0, 1e-8, 1e-8, 1e-7, 1, 0.99, 1.01},  {"tolerant", 1e-4, 0.1, 1e-8, 1e-8, 1e-4, 1, 3e-5, 1e-2},
    {"differences", 1e-4, 0.1, 1e-8, 1e-8, 1e-7, 0, 0.0, 3e-6},
};

/* Returns 1 if the error is outside its bounds. */
static int run(const struct settings *s)
{
    const double one = 1.0, end = 40.0 * acos(-1.0);
    SUNContext context;
    tribo_context *contact;
    long steps, calls, extra, jacobians;
    realtype t = 0.0;
    need(tribo_create(&contact, 1), "contact");
    need(tribo_set_limit(contact, &one), "limit");
    need(tribo_set_operator_diagonal(contact, &one), "operator");
    need(tribo_set_epsilon_all(contact, s->epsilon), "epsilon");
    need(SUNContext_Create(NULL, &context), NULL);
    N_Vector y = N_VNew_Serial(3, context), tolerance = N_VNew_Serial(3, context);
    SUNMatrix matrix = SUNDenseMatrix(3, 3, context);
    SUNLinearSolver solver = SUNLinSol_Dense(y, matrix, context);
    void *cvode = CVodeCreate(CV_BDF, context);
    N_VConst(0.0, y);
    N_VConst(s->absolute, tolerance);
    N_VGetArrayPointer(tolerance)[1] = s->velocity;
    need(CVodeInit(cvode, right_side, 0.0, y), NULL);
    need(CVodeSetUserData(cvode, contact), NULL);
    need(CVodeSVtolerances(cvode, s->relative, tolerance), NULL);
    need(CVodeSetLinearSolver(cvode, solver, matrix), NULL);
    if (s->tangents) {
        need(CVodeSetJacFn(cvode, jacobian), NULL);
    }
    need(CVodeSetMaxNumSteps(cvode, 10000000), NULL);
    need(CVodeSetMaxStep(cvode, s->longest), NULL);
    need(CVodeSetStopTime(cvode, end), NULL);
    need(CVode(cvode, end, y, &t, CV_NORMAL), NULL);
    need(CVodeGetNumSteps(cvode, &steps), NULL);
    need(CVodeGetNumRhsEvals(cvode, &calls), NULL);
    need(CVodeGetNumLinRhsEvals(cvode, &extra), NULL);
    need(CVodeGetNumJacEvals(cvode, &jacobians), NULL);
    const double error = fabs(N_VGetArrayPointer(y)[2] / energy - 1.0);
    printf("cvode.%s.error %.3e\n", s->name, error);
    printf("cvode.%s.steps %ld\ncvode.%s.calls %ld\ncvode.%s.jacobians %ld\n", s->name, steps, s->name, calls + extra, s->name,
           jacobians);
    CVodeFree(&cvode);
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
    N_VDestroy(tolerance);
    N_VDestroy(y);
    SUNContext_Free(&context);
    tribo_destroy(contact);
    return !(error >= s->least && error <= s->most);
}

int main(void)
{
    int bad = 0;
    for (size_t k = 0; k < sizeof settings / sizeof *settings; k++) {
        bad += run(&settings[k]);
    }
    return bad > 0;
}
