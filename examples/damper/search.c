#include "search.h"

#include <math.h>

#include "team.h"

enum { INNER = 4 };

double find_least(double low, double high, double part, evaluate *values, void *data)
{
    double a = log(low), b = log(high), limit[INNER], value[INNER], best = sqrt(low * high);
    while (b - a > part && !interrupted()) {
        const double step = (b - a) / (INNER + 1);
        int least = 0;
        for (int i = 0; i < INNER; i++) {
            limit[i] = exp(a + (i + 1) * step);
        }
        values(data, limit, value, INNER);
        for (int i = 1; i < INNER; i++) {
            least = value[i] < value[least] ? i : least;
        }
        best = limit[least];
        a += least * step;
        b = a + 2.0 * step;
    }
    return best;
}
