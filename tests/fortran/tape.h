/* SPDX-License-Identifier: BSD-3-Clause */
/* Results of the C interface, one number after the other, for Fortran to compare with: see tape.f90. */
#ifndef TRIBO_TESTS_TAPE_H
#define TRIBO_TESTS_TAPE_H

#include <stddef.h>

void put(size_t n, const double *x);
void put_one(double x);
void put_text(const char *text); /* length and characters; NULL is empty */

#endif
