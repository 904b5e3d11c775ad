/* SPDX-License-Identifier: BSD-3-Clause */
#include "make.h"
#include "beam.h"

#include "support.h"

gsl_spmatrix *beam_matrix(const char *name)
{
    char path[500];
    snprintf(path, sizeof path, "%s/%s", TRIBO_BEAM, name);
    FILE *file = fopen(path, "r");
    require(file, "cannot open %s", path);
    gsl_spmatrix *lower = gsl_spmatrix_fscanf(file);
    fclose(file);
    require(lower, "cannot read %s", path);
    gsl_spmatrix *whole = gsl_spmatrix_alloc(lower->size1, lower->size2);
    for (size_t k = 0; k < lower->nz; k++) {
        const size_t i = (size_t)lower->i[k], j = (size_t)lower->p[k];
        gsl_spmatrix_set(whole, i, j, lower->data[k]);
        gsl_spmatrix_set(whole, j, i, lower->data[k]);
    }
    gsl_spmatrix_free(lower);
    return whole;
}

/* Rows of dofs.txt, counted from 1. */
tribo_system *beam_with_springs(double compliance, double limit)
{
    gsl_spmatrix *mass = beam_matrix("M.mtx"), *stiffness = beam_matrix("K.mtx"), *direction = gsl_spmatrix_alloc(3, BEAM_DOFS);
    const size_t rows[] = {117, 189, 261};
    const double each[] = {compliance, compliance, compliance};
    tribo_model *model;
    tribo_system *sys;
    for (size_t i = 0; i < 3; i++) {
        gsl_spmatrix_set(direction, i, rows[i] - 1, 1.0);
    }
    assert_ok(tribo_model_create(&model, BEAM_DOFS, 3));
    assert_ok(tribo_gsl_model_set_mass(model, mass));
    assert_ok(tribo_gsl_model_set_stiffness(model, stiffness));
    assert_ok(tribo_gsl_model_set_direction(model, direction));
    assert_ok(tribo_model_set_compliance(model, each));
    assert_ok(tribo_system_reduce(&sys, model, BEAM_MODES, TRIBO_STATICS_NONE));
    tribo_model_destroy(model);
    gsl_spmatrix_free(mass);
    gsl_spmatrix_free(stiffness);
    gsl_spmatrix_free(direction);
    assert_ok(tribo_system_set_damping_ratio(sys, 0.002));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), limit));
    return sys;
}

tribo_system *beam_with_contacts(double limit)
{
    return beam_with_springs(0.0, limit);
}

void beam_add_load(tribo_system *sys, double omega)
{
    double load[BEAM_DOFS] = {0};
    const size_t tip = 264;
    load[tip - 1] = 0.1;
    assert_ok(tribo_system_add_load(sys, omega, NULL, load));
}

tribo_system *beam_with_damper(double limit)
{
    double omega[BEAM_MODES];
    tribo_system *sys = beam_with_contacts(limit);
    assert_ok(tribo_system_get_frequencies(sys, omega));
    beam_add_load(sys, omega[0]);
    return sys;
}
