/* The set of forces of one contact in units of its limit: the lens D ∩ (D - c) of two unit discs, |c| < 2, or for one direction
 * the interval that is the same in one dimension. c = 0: the disc itself. */
#ifndef TRIBO_LENS_H
#define TRIBO_LENS_H

/* Where a point of the set is: inside, on the rim of D, on that of D - c, or where the two meet. */
enum { LENS_INSIDE, LENS_ON_DISC, LENS_ON_SHIFTED, LENS_AT_CORNER };

/* y = the point of the set that is nearest to z; returns where it is. directions: 1 or 2. */
int tribo_lens_project(int directions, const double *c, const double *z, double *y);

/* y = the point of the set of a contact of two directions at which sum_k weight_k y_k^2/2 - q_k y_k is least; weight > 0. Returns
 * where it is. weight = (1, 1): nearest to q. */
int tribo_lens_minimize(const double *c, const double *weight, const double *q, double *y);

/* Which of the two corners is nearer to z: how they follow c. corner = -c/2 + side height (-c_2, c_1)/|c|. */
struct corner {
    double along[2];     /* c/|c| */
    double half, height; /* |c|/2, sqrt(1 - half^2) */
    double side;         /* 1 or -1 */
};
struct corner tribo_lens_corner(const double *c, const double *z);

/* The length of x [directions], whose squares neither overflow nor underflow to nothing. */
double tribo_length(int directions, const double *x);

/* The t > 0 at which |x + t step| = 1, for |x| < 1. */
double tribo_way_to_rim(int directions, const double *x, const double *step);

#endif
