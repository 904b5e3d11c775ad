/* A function by its values and two derivatives at both ends of an interval: where it has no zero, and where it has one. */
#ifndef TRIBO_QUINTIC_H
#define TRIBO_QUINTIC_H

/* Value, first and second derivative. */
struct sample {
    double g, d, e;
};

/* A lower bound, on an interval of length h, of a function with these samples at its ends whose sixth derivative is at most bend
 * in size. */
double tribo_quintic_least(const struct sample *a, const struct sample *b, double h, double bend);

/* The first place in (0, h) where the quintic through both samples falls to zero; a.g > 0 >= b.g. */
double tribo_quintic_zero(const struct sample *a, const struct sample *b, double h);

#endif
