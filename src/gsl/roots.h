/* Steps that cannot skip a root. */
#ifndef TRIBO_ROOTS_H
#define TRIBO_ROOTS_H

/* A function with value c0 >= 0, first and second derivative c1 and c2 here, and third derivative of at most bend in size, stays positive
 * over the step returned, at most longest: it lies above c0 + c1 h + c2 h^2/2 - bend h^3/6, whose first root is bounded from below. Close to a
 * simple root the bound is sharp to third order. */
double tribo_safe_step(double c0, double c1, double c2, double bend, double longest);

#endif
