/* Where the motion leads in a period, and the derivative of that. Where all that drives it is odd (load and bases half a period
 * later are minus what they are), minus the state half a period later serves as well: such a map done twice is a period. */
#ifndef TRIBO_PERIOD_MAP_H
#define TRIBO_PERIOD_MAP_H

#include "energy_norm.h"
#include "variation.h"

/* Begins with y, [n] as all of this, x in coordinates of the energy norm, times the map's scale. */
struct point {
    double *y, *x;
    double *end, *image; /* the state after the span; and the image of x: that, or minus that */
    struct derivative *derivative; /* of the state after the span by that before; NULL: there is none yet */
    double residual;               /* |image - x| */
    double size;                   /* the largest state on the way */
    int odd;                       /* the image is minus the end */
    size_t torn, other;            /* two contacts for which there is no such derivative; ncontact: there is one */
};

struct period_map {
    tribo_driver *drv;
    tribo_system *sys;
    struct events *events;
    size_t n; /* 2 ndof */
    struct energy_norm norm;
    double scale;    /* 1, but for motions so small or large that squares of their sizes are no numbers */
    struct company company;
    struct variation variation;
    double *y, *x;          /* [n + 1] a state; [n] one in coordinates of the norm */
    double *probe;          /* [n][variation.columns] perturbed states to begin with */
    double *limit;          /* [2 ncontact] workspace */
    double t, period, span; /* span: of an integration */
    int odd;                /* span is half a period */
    double size, least;     /* the largest state of this integration so far; below that motions are rounding */
    int moved;              /* there has been an integration */
    size_t halves;          /* half periods integrated */
};

/* 1, or 0 if out of memory; tribo_period_map_free takes what failed too. */
int tribo_period_map_create(struct period_map *m, tribo_driver *drv);
void tribo_period_map_free(struct period_map *m);

/* These return a status, its message on the driver. The first makes ready for the system as it is, and a guess y; the second one
 * follows the motion from p->x, and finds the rest of p; with the third one *residual is that of the whole period, and p->y has
 * velocities of what has no mass, too. */
int tribo_period_map_prepare(struct period_map *m, double t, double period, const double *y);
int tribo_period_map_follow(struct period_map *m, struct point *p);
int tribo_period_map_complete(struct period_map *m, struct point *p, double *residual);

/* x [n] = the derivative of the image by x there, times x; and the same as a matrix [n][n], which the point keeps, made when it is
 * first asked for. Both return a status. */
int tribo_period_map_apply(struct period_map *m, const struct point *p, double *x);
int tribo_period_map_matrix(struct period_map *m, const struct point *p, const double **matrix);

/* x [n] of a state y [n]. */
void tribo_period_map_coordinates(const struct period_map *m, const double *y, double *x);

/* Takes x [n] along for that number of periods; a status, its message on the driver. */
int tribo_period_map_march(struct period_map *m, size_t periods, double *x);

/* Follows the motion from y through a period, with company. */
int tribo_period_map_replay(struct period_map *m, const double *y, struct company *company);

/* From here on by whole periods, or, if what drives the system is odd, by halves. */
void tribo_period_map_choose(struct period_map *m, int odd);

#endif
