/* SPDX-License-Identifier: BSD-3-Clause */
/* The structures of the tool's readers as models of the library. */
#ifndef TRIBO_BENCH_STRUCTURE_MODEL_H
#define TRIBO_BENCH_STRUCTURE_MODEL_H

#include "../../src/damper/structure.h"
#include "tribo/tribo_dynamics.h"

/* Mass and stiffness of s, with contacts of the degrees of freedom at [contacts] to ground. Ends the program with a message where
 * the library refuses them. */
tribo_model *model_of(const struct structure *s, size_t contacts, const size_t *at);

#endif
