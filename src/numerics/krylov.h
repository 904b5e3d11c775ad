/* Linear equations of which only products with the matrix are known, by GMRES (Saad and Schultz 1986). */
#ifndef TRIBO_KRYLOV_H
#define TRIBO_KRYLOV_H

#include <stddef.h>

/* x [n] = A x; returns a status. */
typedef int tribo_product(void *data, double *x);

/* Numbers of workspace for spaces of `most` dimensions. */
size_t tribo_gmres_room(size_t n, size_t most);

/* x [n], the right-hand side, becomes the solution in the Krylov space of at most `most` dimensions that leaves the smallest
 * residual; *part is the part of x that it leaves: at most tolerance, unless the space is too small. Returns the status of a
 * product that failed. */
int tribo_gmres(size_t n, tribo_product *product, void *data, double tolerance, size_t most, double *x, double *part,
                double *work);

#endif
