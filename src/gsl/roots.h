/* Intervals on which a function has no root, and where it has one. */
#ifndef TRIBO_ROOTS_H
#define TRIBO_ROOTS_H

/* Value, first and second derivative. */
struct sample {
    double g, d, e;
};

/* 1 if a function with these samples at the ends of an interval of length h, and a sixth derivative of at most bend in size, is
 * above -noise on all of it. */
int tribo_positive(const struct sample *a, const struct sample *b, double h, double bend, double noise);

/* The first place in (0, h) where the quintic through both samples falls to zero; a.g > 0 >= b.g. */
double tribo_root_guess(const struct sample *a, const struct sample *b, double h);

#endif
