/* SPDX-License-Identifier: BSD-3-Clause */
#include "structure_model.h"

#include <stdlib.h>

#include "../../src/damper/output.h"

tribo_model *model_of(const struct structure *s, size_t contacts, const size_t *at)
{
    tribo_model *model = NULL;
    size_t *first = need_memory(contacts + 1, sizeof *first);
    double *val = need_memory(contacts + 1, sizeof *val);
    first[0] = 0;
    for (size_t c = 0; c < contacts; c++) {
        first[c + 1] = c + 1;
        val[c] = 1.0;
    }
    need(tribo_model_create(&model, s->ndof, contacts), NULL);
    need(tribo_model_set_mass_csr(model, s->mass.first, s->mass.col, s->mass.val), tribo_model_message(model));
    need(tribo_model_set_stiffness_csr(model, s->stiffness.first, s->stiffness.col, s->stiffness.val),
         tribo_model_message(model));
    need(tribo_model_set_direction_csr(model, first, at, val), tribo_model_message(model));
    free(first);
    free(val);
    return model;
}
