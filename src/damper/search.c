/* SPDX-License-Identifier: BSD-3-Clause */
#include "search.h"

#include <math.h>

#include "team.h"

/* Each step finds two more values, in the middles of the halves, and keeps the least of three with its neighbours: the interval
 * is halved. */
double find_least(double low, double high, double part, evaluate *values, void *data, double *least)
{
    double a = log(low), b = log(high), best = sqrt(low * high);
    values(data, &best, least, 1);
    while (b - a > part && !interrupted()) {
        const double quarter = 0.25 * (b - a), limit[] = {exp(a + quarter), exp(b - quarter)};
        double value[2];
        values(data, limit, value, 2);
        const int side = value[0] < *least && value[0] <= value[1] ? -1 : value[1] < *least ? 1 : 0;
        if (side) {
            best = limit[side > 0];
            *least = value[side > 0];
        }
        a += (1 + side) * quarter;
        b = a + 2.0 * quarter;
    }
    return best;
}
