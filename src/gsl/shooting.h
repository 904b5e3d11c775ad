/* The search for a motion that comes back after a period. */
#ifndef TRIBO_SHOOTING_H
#define TRIBO_SHOOTING_H

#include "energy_norm.h"
#include "variation.h"

/* A state to begin with, in coordinates of the energy norm, and where the motion leads from there: image is the state a period
 * later, or minus the state half a period later, and derivative that of image by x. */
struct point {
    double *x, *image, *derivative; /* [n], [n], [n][n] */
    double residual;                /* |image - x| */
    double size;                    /* the largest state on the way */
};

struct shooting {
    tribo_driver *drv;
    tribo_system *sys;
    struct events *events;
    size_t n; /* 2 ndof */
    struct energy_norm norm;
    size_t revision; /* of the system whose norm it is */
    struct company company;
    struct variation variation;
    struct point here, there;
    double *y, *seen;             /* [n + 1] a state; [n] one in coordinates of the norm */
    double *unit, *a, *b, *step;  /* [n][n] perturbed states to begin with, workspace; [n] */
    size_t *pivot;                /* [n] */
    double t, period, span, side; /* span: of an integration; side: 1, or -1 where span is half a period */
    double size;                  /* the largest state of this integration so far */
    int moved;                    /* there has been an integration before */
    size_t halves, most;          /* half periods integrated in this search, and how many there may be */
    double *re, *im;              /* [n] multipliers of the last motion found */
    int found;
    size_t freedom; /* dimension of its family */
};

/* NULL if out of memory. */
struct shooting *tribo_shooting_create(tribo_driver *drv);
void tribo_shooting_free(struct shooting *s);

/* As tribo_driver_find_periodic, arguments being checked. */
int tribo_shooting_find(struct shooting *s, double t, double period, double *y);

#endif
