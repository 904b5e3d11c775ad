/* Finds heavy bodies behind light bodies, hidden by the rounding of R. */
#ifndef TRIBO_HIDDEN_H
#define TRIBO_HIDDEN_H

#include "numerics/matrix.h"

struct hidden {
    size_t contact; /* contact with the largest spread */
    double spread;  /* ratio of the largest to the smallest share J^2/m in R_ii of `contact` */
};

/* r [ncontact][ncontact] = J X, X = responses of the bodies to contact forces. own [entries of J]: the entry of X of the same
 * contact and degree of freedom. Returns 1 if R hides a body, 0 if not, -1 if out of memory. */
int tribo_hidden(const struct matrix *direction, const struct matrix *mass, const double *own, const double *r,
                 struct hidden *where);

#endif
