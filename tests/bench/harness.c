#include "harness.h"

#include <stdlib.h>
#include <time.h>

/* Below this a measurement is that of the clock and of what else the processor remembers: runs are repeated to last so long. */
#define SHORTEST 2e-3

enum { MOST = 64 };

/* Of the processor, so that what the machine does for others in the meantime does not count; memory and caches are shared still,
 * and the speed of the processor changes, which is what ratios are for. */
double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double seconds_of(const struct method *m, const struct scene *s, double setting, size_t times)
{
    const double begin = cpu_seconds();
    for (size_t k = 0; k < times; k++) {
        struct outcome o = {.failure = ""};
        m->run(m, s, setting, &o);
    }
    return (cpu_seconds() - begin) / (double)times;
}

static size_t times_for(double seconds)
{
    return seconds < SHORTEST ? (size_t)(SHORTEST / (seconds + 1e-7)) + 1 : 1;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double quantile(const double *sorted, size_t n, double q)
{
    const double at = q * (double)(n - 1);
    const size_t i = (size_t)at < n - 1 ? (size_t)at : n - 1;
    return i + 1 < n ? sorted[i] + (at - (double)i) * (sorted[i + 1] - sorted[i]) : sorted[i];
}

struct timing time_run(const struct method *m, const struct scene *s, double setting, double first, const struct effort *effort)
{
    double seconds[MOST], ratio[MOST], sorted_seconds[MOST], sorted[MOST];
    const size_t times = times_for(first);
    double unit = seconds_of(unit_method, s, s->dt, 1);
    const size_t unit_times = times_for(unit);
    struct timing t = {0};
    unit = seconds_of(unit_method, s, s->dt, unit_times);
    while (t.repeats < effort->repeats ||
           (t.high - t.low > effort->spread * t.ratio && t.repeats < effort->most_repeats && t.repeats < MOST)) {
        const double here = seconds_of(m, s, setting, times), after = seconds_of(unit_method, s, s->dt, unit_times);
        seconds[t.repeats] = here;
        ratio[t.repeats] = here / (0.5 * (unit + after) * s->unit_part);
        unit = after;
        t.repeats++;
        for (size_t i = 0; i < t.repeats; i++) {
            sorted_seconds[i] = seconds[i];
            sorted[i] = ratio[i];
        }
        qsort(sorted_seconds, t.repeats, sizeof *sorted_seconds, ascending);
        qsort(sorted, t.repeats, sizeof *sorted, ascending);
        t.seconds = quantile(sorted_seconds, t.repeats, 0.5);
        t.ratio = quantile(sorted, t.repeats, 0.5);
        t.low = quantile(sorted, t.repeats, 0.25);
        t.high = quantile(sorted, t.repeats, 0.75);
    }
    return t;
}
