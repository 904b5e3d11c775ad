/* SPDX-License-Identifier: BSD-3-Clause */
/* Where the paper's partition jumps or fails, beside the consistent coupling. */
#ifndef TRIBO_BENCH_COUPLINGS_H
#define TRIBO_BENCH_COUPLINGS_H

/* Prints the tables; those of the pile of blocks only if it is asked for, since that takes a minute. Returns whether the
 * consistent coupling does everywhere what is said of it. */
int print_couplings(int pile);

#endif
