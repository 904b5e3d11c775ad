/* The search for a motion that comes back after a period. */
#ifndef TRIBO_SHOOTING_H
#define TRIBO_SHOOTING_H

#include "period_map.h"

struct shooting {
    struct period_map map;
    struct point here, there, best; /* where the search is; where a step leads; where it goes back to */
    double *memory;
    double *a, *b;        /* [n][n] workspace */
    double *step, *guess; /* [n] */
    size_t *pivot;        /* [n] */
    double ratio;         /* what is left along the step after it, beside what was before */
    double first, rate;   /* that of the step from best; that of the last one, if it was good */
    double stride;        /* spans followed at once; 0: steps are Newton's */
    size_t astray;        /* steps since best that did not pay */
    size_t setbacks;      /* how often the search has gone back */
    double nearest;       /* the least residual seen beside the size */
    double *re, *im;      /* [n] multipliers of the last motion found */
    int found;
    size_t revision; /* of the system then */
};

/* NULL if out of memory. */
struct shooting *tribo_shooting_create(tribo_driver *drv);
void tribo_shooting_free(struct shooting *s);

/* As tribo_driver_find_periodic, arguments being checked. */
int tribo_shooting_find(struct shooting *s, double t, double period, double *y);

#endif
