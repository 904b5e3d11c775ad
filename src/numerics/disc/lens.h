/* SPDX-License-Identifier: BSD-3-Clause */
/* The set of forces of one contact in units of its limit: the lens of two unit discs D and D - c, |c| < 2, or for one direction
 * the interval that is the same in one dimension. c = 0: the disc itself. */
#ifndef TRIBO_LENS_H
#define TRIBO_LENS_H

/* Places of points of the set: inside, on the rim of D, on the rim of D - c, or where the two rims meet. */
enum { LENS_INSIDE, LENS_ON_DISC, LENS_ON_SHIFTED, LENS_AT_CORNER };

/* y = the point of the set nearest to z. Returns its place. directions: 1 or 2. */
int tribo_lens_project(int directions, const double *c, const double *z, double *y);

/* y = the minimum of sum_k weight_k y_k^2/2 - q_k y_k in the set of a contact of two directions, weight > 0. Returns its place.
 * weight = (1, 1): the point nearest to q. */
int tribo_lens_minimize(const double *c, const double *weight, const double *q, double *y);

/* A corner is -c/2 + side height (-c_2, c_1)/|c|. tribo_lens_corner returns the corner nearer to z. */
struct corner {
    double along[2];     /* c/|c| */
    double half, height; /* |c|/2, sqrt(1 - half^2) */
    double side;         /* 1 or -1 */
};
struct corner tribo_lens_corner(const double *c, const double *z);

/* Returns |x|, x [directions]; squares neither overflow nor underflow. */
double tribo_length(int directions, const double *x);

/* Returns the t > 0 with |x + t step| = 1, for |x| < 1. */
double tribo_way_to_rim(int directions, const double *x, const double *step);

#endif
