/* SPDX-License-Identifier: BSD-3-Clause */
/* Times runs on a machine that others use too: each is compared to a unit, run just before and just after it. For all programs of
 * this folder; knows nothing of friction. */
#ifndef TRIBO_BENCH_HARNESS_H
#define TRIBO_BENCH_HARNESS_H

#include <stddef.h>

struct job {
    void (*run)(void *data);
    void *data;
    double about; /* seconds that it takes, roughly: short jobs are timed many at a time */
};

struct effort {
    size_t least, most; /* repeats */
    double budget;      /* seconds, after which no repeat beyond the least begins */
};

struct timing {
    double seconds;          /* of a run, median */
    double ratio, low, high; /* to the unit: median and quartiles */
    size_t repeats;
};

/* Runs a job once, notes how long it takes, and returns that. */
double probe_job(struct job *job);

/* Both jobs must have been probed. */
struct timing time_job(const struct job *job, const struct job *unit, const struct effort *effort);

/* Of the processor, so that what the machine does for others in the meantime does not count. */
double cpu_seconds(void);

#endif
