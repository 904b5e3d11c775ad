/* SPDX-License-Identifier: BSD-3-Clause */
/* Errors of tribo as errors of PETSc: they come with tribo's message and a traceback, and end all ranks, since PETSc aborts MPI
 * when an error of one rank arrives in main. */
#ifndef EXAMPLES_TRIBO_PETSC_H
#define EXAMPLES_TRIBO_PETSC_H

#include <petscsys.h>

#include "tribo/tribo.h"

/* message belongs to the handle of the call, tribo_message(contacts) or tribo_driver_message(driver), and counts the contacts of
 * that handle from 0; where, a literal for printf with arguments behind it, names the place among the contacts of all ranks. */
#define PetscCallTribo(call, message, where, ...)                                                                                \
    do {                                                                                                                         \
        const int tribo_status_ = (call);                                                                                        \
        PetscCheck(tribo_status_ == TRIBO_OK, PETSC_COMM_SELF, PETSC_ERR_LIB, "tribo on rank %d: %s: %s (" where ")",            \
                   PetscGlobalRank, tribo_strerror(tribo_status_), (message), __VA_ARGS__);                                      \
    } while (0)

#endif
