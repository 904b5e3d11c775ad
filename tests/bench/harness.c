/* SPDX-License-Identifier: BSD-3-Clause */
#define _POSIX_C_SOURCE 199309L /* clock_gettime */

#include "harness.h"

#include <stdlib.h>
#include <time.h>

/* Below this a measurement is that of the clock: jobs are repeated to last so long. */
#define SHORTEST 2e-3

enum { MOST = 64 };

/* Memory and caches are shared with others still, and the speed of the processor changes; ratios are for that. */
double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double probe_job(struct job *job)
{
    const double begin = cpu_seconds();
    job->run(job->data);
    return job->about = cpu_seconds() - begin;
}

static double seconds_of(const struct job *job)
{
    const size_t times = job->about < SHORTEST ? (size_t)(SHORTEST / (job->about + 1e-7)) + 1 : 1;
    const double begin = cpu_seconds();
    for (size_t k = 0; k < times; k++) {
        job->run(job->data);
    }
    return (cpu_seconds() - begin) / (double)times;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Sorts the values. */
static double quantile(double *value, size_t n, double q)
{
    qsort(value, n, sizeof *value, ascending);
    const double at = q * (double)(n - 1);
    const size_t i = (size_t)at;
    return i + 1 < n ? value[i] + (at - (double)i) * (value[i + 1] - value[i]) : value[i];
}

struct timing time_job(const struct job *job, const struct job *unit, const struct effort *effort)
{
    double seconds[MOST], ratio[MOST], before = seconds_of(unit);
    const double end = cpu_seconds() + effort->budget;
    struct timing t = {0};
    while (t.repeats < effort->least || (t.repeats < effort->most && t.repeats < MOST && cpu_seconds() < end)) {
        seconds[t.repeats] = seconds_of(job);
        const double after = seconds_of(unit);
        ratio[t.repeats] = seconds[t.repeats] / (0.5 * (before + after));
        before = after;
        t.repeats++;
    }
    t.seconds = quantile(seconds, t.repeats, 0.5);
    t.ratio = quantile(ratio, t.repeats, 0.5);
    t.low = quantile(ratio, t.repeats, 0.25);
    t.high = quantile(ratio, t.repeats, 0.75);
    return t;
}
