/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef EXAMPLES_PETSC_VTK_H
#define EXAMPLES_PETSC_VTK_H

#include "contacts.h"

/* Writes a legacy VTK file (ParaView, VisIt): a point a node, and after those a point a contact, which moves with its node; with
 * displacements, and of contacts the friction force and the slip: 0 stuck, 1 and -1 sliding, 2 open, 3 for nodes. place, q: rows
 * of the structure, three a node; f, slip: a row a contact. Collective; the first rank writes. */
PetscErrorCode WriteVtk(const char *path, Vec place, Vec q, const Contacts *contacts, Vec f, Vec slip);

#endif
