/* The search for a motion that comes back after a period. */
#ifndef TRIBO_SHOOTING_H
#define TRIBO_SHOOTING_H

#include "period_map.h"

struct shooting {
    struct period_map map;
    struct point here, there, best; /* where the search is; where a step leads; where it goes back to */
    double *memory;
    double *a, *b;        /* [n][n] workspace */
    double *space;        /* of Krylov spaces, and */
    double *free;         /* [2 n] the inverse of I - derivative that the free structure has: [n/2] matrices of two rows */
    double *step, *guess; /* [n] */
    int *pivot;           /* [n] */
    double ratio;         /* what is left along the step after it, beside what was before */
    double first, rate;   /* that of the step from best; that of the last one, if it was good */
    double stride;        /* spans followed at once; 0: steps are Newton's */
    double before;        /* the residual before the last step; 0: there was none */
    size_t astray;        /* steps since best that did not pay */
    size_t setbacks;      /* how often the search has gone back */
    double nearest;       /* the least residual seen beside the size */
    int found;
    size_t freedom;  /* the dimension of the family of the motion found, once it is asked for; or UNKNOWN */
    size_t revision; /* of the system then */
};

/* NULL if out of memory. */
struct shooting *tribo_shooting_create(tribo_driver *drv);
void tribo_shooting_free(struct shooting *s);

/* The multipliers re, im [tribo_system_dimension - 1] of the motion found; the dimension of its family. Both return a status. */
int tribo_shooting_multipliers(struct shooting *s, double *re, double *im);
int tribo_shooting_freedom(struct shooting *s, size_t *freedom);

/* As tribo_driver_find_periodic, arguments being checked. */
int tribo_shooting_find(struct shooting *s, double t, double period, double *y);

#endif
