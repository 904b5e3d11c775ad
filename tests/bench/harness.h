/* Times runs on a machine that others use too. */
#ifndef TRIBO_BENCH_HARNESS_H
#define TRIBO_BENCH_HARNESS_H

#include "methods.h"

struct timing {
    double seconds;          /* median */
    double ratio, low, high; /* to the unit, measured before and after each run: median and quartiles */
    size_t repeats;
};

struct effort {
    size_t repeats;      /* at least */
    double longest;      /* seconds; a method's longer settings are left out */
    double spread;       /* of the quartiles, that is good enough */
    size_t most_repeats; /* if it is not */
};

double cpu_seconds(void);

/* Times a run against the unit, and leaves its outcome. first: seconds that a run takes, about. */
struct timing time_run(const struct method *m, const struct scene *s, double setting, double first, const struct effort *effort);

#endif
