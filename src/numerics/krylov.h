/* SPDX-License-Identifier: BSD-3-Clause */
/* Linear equations whose matrix is known by its products, by GMRES (Saad and Schultz 1986). */
#ifndef TRIBO_KRYLOV_H
#define TRIBO_KRYLOV_H

#include <stddef.h>

/* x [n] = A x. Returns a status. */
typedef int tribo_product(void *data, double *x);

/* Returns the doubles of workspace for a space of `most` dimensions. */
size_t tribo_gmres_room(size_t n, size_t most);

/* x [n] = the y with the smallest |x - A y| in the Krylov space of at most `most` dimensions; *part = |x - A y| / |x|, at most
 * tolerance unless the space is too small. Returns TRIBO_OK, or the status of a product that failed. */
int tribo_gmres(size_t n, tribo_product *product, void *data, double tolerance, size_t most, double *x, double *part,
                double *work);

#endif
