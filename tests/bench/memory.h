/* SPDX-License-Identifier: BSD-3-Clause */
/* What of this process is in memory (Linux; elsewhere 0). */
#ifndef TRIBO_BENCH_MEMORY_H
#define TRIBO_BENCH_MEMORY_H

/* MB at this moment, from where on the peak counts. */
double memory_begin(void);

/* The same, of which nothing begins; the most since memory_begin. */
double memory_held(void);
double memory_peak(void);

#endif
