/* The planar element of elastic.c and contact.c: two equal springs that end in one Coulomb slider. */
#ifndef TRIBO_ELASTIC_H
#define TRIBO_ELASTIC_H

#include "check.h"

/* An element after a displacement dz. slip is the unit vector of f where it slides, 0 where it sticks. */
struct elastic_end {
    double slip[2];
    double xx, xy, yy; /* df/dz */
};

/* Return mapping: f [2] becomes p = f - stiffness dz, or limit p/|p| where |p| > limit. With limit 0 f is 0, and so is df/dz.
 * A displacement so large that stiffness dz is beyond all forces keeps its direction. */
static inline struct elastic_end elastic_return(const double *dz, double stiffness, double limit, double *f)
{
    const double k = lesser(stiffness, TRIBO_FAR / greater(greater(fabs(dz[0]), fabs(dz[1])), 1.0));
    const double to[2] = {cut(f[0]) - k * dz[0], cut(f[1]) - k * dz[1]};
    const double most = greater(greater(fabs(to[0]), fabs(to[1])), DBL_MIN), x = to[0] / most, y = to[1] / most;
    const double length = greater(sqrt(x * x + y * y), DBL_MIN), room = quotient(limit, most);
    if (length <= room) {
        f[0] = to[0];
        f[1] = to[1];
        return (struct elastic_end){{0.0, 0.0}, -stiffness, 0.0, -stiffness};
    }
    /* The derivative of limit p/|p|. */
    const double slip[2] = {x / length, y / length}, rate = -k * (room / length);
    f[0] = limit * slip[0];
    f[1] = limit * slip[1];
    return (struct elastic_end){
        {slip[0], slip[1]}, rate * slip[1] * slip[1], -rate * slip[0] * slip[1], rate * slip[0] * slip[0]};
}

/* TRIBO_ERR_SIZE where arrays of n elements are larger than memory. */
static inline int elastic_check_size(size_t n)
{
    return n >= SIZE_MAX / 128 ? TRIBO_ERR_SIZE : TRIBO_OK;
}

#endif
