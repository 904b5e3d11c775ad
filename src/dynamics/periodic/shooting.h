/* SPDX-License-Identifier: BSD-3-Clause */
/* Shooting: the search for a fixed point x = image(x) of the period map. */
#ifndef TRIBO_SHOOTING_H
#define TRIBO_SHOOTING_H

#include "period_map.h"

struct shooting {
    struct period_map map;
    struct point point[2];
    struct point *here, *there; /* current point; end of the step */
    struct point *flow;         /* here, or there at another time of the motion found: has its multipliers */
    double *a, *b;              /* [n][n] workspace; a owns the memory of all arrays */
    double *space;              /* workspace of tribo_gmres */
    double *step, *guess;       /* [n] */
    double ratio;               /* left_along(there)/left_along(here) of the step */
    double rate;                /* ratio of the last step if it was good, else 0 */
    double stride;              /* spans extrapolated at once; 0: Newton's steps */
    int spans;                  /* spans of the equation solved in a Krylov space */
    int preconditions;          /* 1: that equation is I - D times (I - F)^-1 from the right, apply_free */
    double before;              /* residual before the last step */
    double nearest;             /* least residual/size so far */
    int found;
    size_t revision; /* of the system when the motion was found */
};

/* Returns NULL if out of memory. */
struct shooting *tribo_shooting_create(tribo_driver *drv);

/* Sets re, im [tribo_system_dimension - 1] = multipliers of the motion found; *freedom = dimension of its family. */
int tribo_shooting_multipliers(struct shooting *s, double *re, double *im);
int tribo_shooting_freedom(struct shooting *s, size_t *freedom);

/* As tribo_driver_find_periodic, with arguments already checked. */
int tribo_shooting_find(struct shooting *s, double t, double period, double *y);

#endif
