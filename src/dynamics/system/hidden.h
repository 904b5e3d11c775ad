/* Whether R, in rounding, has lost heavy bodies behind light ones. */
#ifndef TRIBO_HIDDEN_H
#define TRIBO_HIDDEN_H

#include "numerics/matrix.h"

struct hidden {
    size_t contact; /* touches bodies */
    double spread;  /* of which one gives way so many times as much as the other */
};

/* r [ncontact][ncontact] = J X, X being what forces of the contacts do to the bodies; own [entries of J]: what that of its
 * contact does to the degree of freedom of each entry. 1 if bodies are hidden, 0 if not, -1 if out of memory. */
int tribo_hidden(const struct matrix *direction, const struct matrix *mass, const double *own, const double *r,
                 struct hidden *where);

#endif
