/* A function by its values and two derivatives at both ends of an interval, or by five derivatives at one: where it has no
 * zero, and where it has one. */
#ifndef TRIBO_QUINTIC_H
#define TRIBO_QUINTIC_H

/* Value, first and second derivative. */
struct sample {
    double g, d, e;
};

/* A lower bound of a function with these samples at the ends of an interval of length h, whose sixth derivative is at most bend
 * in size, from the beginning of that for a time of until, at most h. No sharper than it takes to be at least `enough`;
 * where it is less, it is just that. */
double tribo_quintic_least(const struct sample *a, const struct sample *b, double h, double bend, double until, double enough);

/* The first place in (0, h) where the quintic through both samples falls to zero; a.g > 0 >= b.g. */
double tribo_quintic_zero(const struct sample *a, const struct sample *b, double h);

/* The first place where a series p [6] in powers of s, 0 <= s <= 1, falls to zero, looked for from a guess on; it is positive
 * at 0, and not at 1. */
double tribo_taylor_zero(const double *p, double guess);

/* By how much the quintic may differ from the function there. */
double tribo_quintic_error(double at, double h, double bend);

#endif
