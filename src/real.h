/* Minimum and maximum that compile to one instruction; those of math.h are calls, for the sake of NaN. */
#ifndef TRIBO_REAL_H
#define TRIBO_REAL_H

static inline double lesser(double x, double y)
{
    return x < y ? x : y;
}

static inline double greater(double x, double y)
{
    return x > y ? x : y;
}

/* A NaN becomes lo. */
static inline double clamp(double x, double lo, double hi)
{
    return lesser(greater(x, lo), hi);
}

#endif
