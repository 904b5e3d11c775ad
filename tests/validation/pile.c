#include "pile.h"

#include <math.h>

int pile_create(tribo_system **sys, double ratio)
{
    enum { N = PILE_BLOCKS };
    double mass[N * N] = {0.0}, stiffness[N * N] = {0.0}, direction[N * N] = {0.0}, limit[N], belt[N] = {1.0};
    for (size_t i = 0; i < N; i++) {
        mass[i * N + i] = i % 2 ? 1.0 / ratio : 1.0;
        stiffness[i * N + i] = mass[i * N + i] * (1.0 + (double)i / N);
        direction[i * N + i] = 1.0;
        if (i > 0) {
            direction[i * N + i - 1] = -1.0;
        }
        limit[i] = 0.5 * (1.0 - 0.3*(i*i*37%61)/61.0 - 0.5*(double)i / N);
    }
    const int status = tribo_system_linear(sys, N, N, mass, NULL, stiffness, direction, 0, NULL, 0);
    return status   ? status
           : tribo_set_limit(tribo_system_context(*sys), limit) ? tribo_set_limit(tribo_system_context(*sys), limit)
                                                                : tribo_system_add_motion(*sys, 0.5, NULL, belt);
}

double pile_distance(const double *y, const double *want)
{
    double most = 0.0;
    for (size_t i = 0; i < PILE_BLOCKS; i++) {
        most = fmax(most, fabs(y[i] - want[i]));
        most = i % 2 ? most : fmax(most, fabs(y[PILE_BLOCKS + i] - want[PILE_BLOCKS + i]));
    }
    return most;
}
