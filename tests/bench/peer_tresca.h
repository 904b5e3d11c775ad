/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar contacts of limit 1 by the solvers of Siconos: its contacts have a normal direction too, which here is held at a force
 * of 1 with a friction coefficient of 1, and coupled with nothing. */
#ifndef BENCH_PEER_TRESCA_H
#define BENCH_PEER_TRESCA_H

#include <stddef.h>

struct tresca;

/* Solvers: their names, NULL after the last. */
const char *tresca_name(size_t solver);

/* n contacts with R, r [2n][2n]; to this tolerance of Siconos' own. NULL if out of memory. */
struct tresca *tresca_create(size_t solver, size_t n, const double *r, double tolerance);
void tresca_destroy(struct tresca *t);

/* f [2n] of R f + pull, from the last solution. 0, or what Siconos says. */
int tresca_solve(struct tresca *t, const double *pull, double *f);

#endif
