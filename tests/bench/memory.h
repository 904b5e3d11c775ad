/* What of this process is in memory (Linux; elsewhere 0). */
#ifndef TRIBO_BENCH_MEMORY_H
#define TRIBO_BENCH_MEMORY_H

/* MB at this moment, from where on the peak counts. */
double memory_begin(void);

/* The most since then. */
double memory_peak(void);

#endif
