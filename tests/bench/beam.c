/* SPDX-License-Identifier: BSD-3-Clause */
#include "beam.h"

#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>

#include "../../src/damper/output.h"
#include "structure_model.h"

static const struct place contact_place[CONTACTS] = {
    {{200.0, 0.0, 5.0}, 3, "contact 1"}, {{300.0, 0.0, 5.0}, 3, "contact 2"}, {{400.0, 0.0, 5.0}, 3, "contact 3"}};
static const struct place load_place = {{400.0, 20.0, 5.0}, 3, "load"};
static const double damping = 0.002, force = 0.1;

/* ------------------------------------------------------------------------------------------------------------ structure */

/* What a unit amplitude of each mode does at the load and at the contacts. */
static void read_shapes(struct modal *b, const tribo_system *sys, size_t ndof, size_t load, const size_t *row)
{
    double unit[MODES] = {0.0}, *full = need_memory(ndof, sizeof *full);
    for (size_t k = 0; k < MODES; k++) {
        unit[k] = 1.0;
        need(tribo_system_expand(sys, unit, full), NULL);
        unit[k] = 0.0;
        b->load[k] = force * full[load];
        for (size_t c = 0; c < CONTACTS; c++) {
            b->j[c][k] = full[row[c]];
        }
    }
    free(full);
}

static tribo_system *reduce(const struct structure *s, const size_t *row, size_t load, struct model *m)
{
    struct modal *b = &m->beam;
    tribo_model *model = model_of(s, CONTACTS, row);
    tribo_system *sys;
    need(tribo_system_reduce(&sys, model, MODES, TRIBO_STATICS_NONE), tribo_model_message(model));
    tribo_model_destroy(model);

    double frequency[MODES], *sine = need_memory(s->ndof, sizeof *sine);
    need(tribo_system_get_frequencies(sys, frequency), NULL);
    need(tribo_system_set_damping_ratio(sys, damping), NULL);
    sine[load] = force;
    need(tribo_system_add_load(sys, frequency[0], NULL, sine), NULL);
    free(sine);
    m->alpha = 1.0;
    m->omega = frequency[0];
    for (size_t k = 0; k < MODES; k++) {
        b->stiffness[k] = frequency[k] * frequency[k];
        b->damping[k] = 2.0 * damping * frequency[k];
    }
    read_shapes(b, sys, s->ndof, load, row);
    return sys;
}

/* ------------------------------------------------------------------------------------- coordinates of the contacts */

/* J' = Q R: the first columns of Q span what the contacts see, the others do not move them. forth = (J; other columns of Q'),
 * back is its inverse. */
static void find_coordinates(struct modal *b)
{
    gsl_matrix *jt = gsl_matrix_alloc(MODES, CONTACTS), *q = gsl_matrix_alloc(MODES, MODES),
               *r = gsl_matrix_alloc(MODES, CONTACTS);
    gsl_vector *tau = gsl_vector_alloc(CONTACTS);
    gsl_matrix *forth = gsl_matrix_alloc(MODES, MODES);
    gsl_matrix_view back = gsl_matrix_view_array(b->back[0], MODES, MODES);
    gsl_permutation *p = gsl_permutation_alloc(MODES);
    int sign;
    for (size_t i = 0; i < MODES; i++) {
        for (size_t c = 0; c < CONTACTS; c++) {
            gsl_matrix_set(jt, i, c, b->j[c][i]);
        }
    }
    gsl_linalg_QR_decomp(jt, tau);
    gsl_linalg_QR_unpack(jt, tau, q, r);
    for (size_t k = 0; k < MODES; k++) {
        for (size_t i = 0; i < MODES; i++) {
            b->forth[k][i] = k < CONTACTS ? b->j[k][i] : gsl_matrix_get(q, i, k);
            gsl_matrix_set(forth, k, i, b->forth[k][i]);
        }
    }
    gsl_linalg_LU_decomp(forth, p, &sign);
    gsl_linalg_LU_invert(forth, p, &back.matrix);
    gsl_matrix_free(jt);
    gsl_matrix_free(q);
    gsl_matrix_free(r);
    gsl_matrix_free(forth);
    gsl_vector_free(tau);
    gsl_permutation_free(p);
    for (size_t i = 0; i < CONTACTS; i++) {
        for (size_t k = 0; k < CONTACTS; k++) {
            b->r[i][k] = 0.0;
            for (size_t d = 0; d < MODES; d++) {
                b->r[i][k] += b->j[i][d] * b->j[k][d];
            }
        }
    }
}

tribo_system *beam_create(struct model *model)
{
    *model = (struct model){.kind = BEAM, .n = MODES, .c = CONTACTS};
    gsl_set_error_handler_off(); /* as read_structure expects */
    struct structure s = read_structure(BEAM_FILES "/M.mtx", BEAM_FILES "/K.mtx", BEAM_FILES "/dofs.txt");
    size_t row[CONTACTS];
    for (size_t c = 0; c < CONTACTS; c++) {
        row[c] = find_degree(&s, &contact_place[c]);
    }
    tribo_system *sys = reduce(&s, row, find_degree(&s, &load_place), model);
    free_structure(&s);
    find_coordinates(&model->beam);
    double sum = 0.0;
    for (size_t c = 0; c < CONTACTS; c++) {
        sum += fabs(model->beam.j[c][0]);
    }
    for (size_t c = 0; c < CONTACTS; c++) {
        model->limit[c] = PI / 8.0 * fabs(model->beam.load[0]) / sum;
    }
    return sys;
}
