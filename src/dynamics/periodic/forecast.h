/* Approximate state of the odd periodic motion. Model: friction is constant in each of N intervals of half a period, and obeys
 * Coulomb's law for the mean velocity of the interval. Damping that couples free modes is neglected. */
#ifndef TRIBO_FORECAST_H
#define TRIBO_FORECAST_H

#include "period_map.h"

/* Sets x [m->n] = coordinates of the state at m->t, m->odd = 1. Sets *done = 0 if there is no forecast: a mode does not oscillate
 * (as without stiffness), or resonates without damping, or x is not finite. Returns a status, its message on the driver. */
int tribo_forecast(struct period_map *m, double *x, int *done);

#endif
