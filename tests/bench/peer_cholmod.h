/* SPDX-License-Identifier: BSD-3-Clause */
/* CHOLMOD (SuiteSparse) on the same matrix as a carpet of contacts. */
#ifndef TRIBO_BENCH_PEER_CHOLMOD_H
#define TRIBO_BENCH_PEER_CHOLMOD_H

#include "harness.h"

/* Prints a table of what a new factor, one contact that leaves or enters, and a solution take. */
void compare_cholmod(size_t n, const struct effort *effort);

#endif
