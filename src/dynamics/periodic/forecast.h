/* A state near the odd periodic motion, from a model of it: friction is constant in each of N intervals of half a period, and follows
 * Coulomb's law for the mean velocity of the interval. Damping that free modes share is left out. */
#ifndef TRIBO_FORECAST_H
#define TRIBO_FORECAST_H

#include "period_map.h"

/* x [m->n] = coordinates of the state at m->t, where the map goes by half periods; *done = 0 if there is none: a mode without
 * stiffness, a resonance without damping. Returns a status, its message on the driver. */
int tribo_forecast(struct period_map *m, double *x, int *done);

#endif
