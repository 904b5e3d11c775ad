/* The inertia of sparse symmetric matrices that may be indefinite, by the multifrontal method (Duff and Reid 1983, ACM Trans.
 * Math. Softw. 9, 302, doi:10.1145/356044.356047): columns with the same rows are eliminated together, in a dense matrix, and
 * what that leaves of their rows is added to the matrix of the columns that come next. No factor is kept. */
#ifndef TRIBO_MULTIFRONTAL_H
#define TRIBO_MULTIFRONTAL_H

#include "matrix.h"
#include "sparse_factor.h"

/* Groups of columns of a factor L, as CHOLMOD finds them; a group comes after all whose rows are its columns. */
struct supernodes {
    size_t n, count;
    const size_t *order; /* [n] which row of the matrix each row of L is */
    const size_t *first; /* [count + 1] the first column of each group */
    const size_t *begin; /* [count + 1] where its rows begin among */
    const size_t *row;   /* the rows of all groups, each ascending, its own columns first */
};

/* The lower triangle of the matrix in the order of L: column j has rows row[first[j]] to row[first[j + 1] - 1], as they come. */
struct lower_columns {
    const size_t *first, *row;
    const double *val;
};

/* As tribo_sparse_inertia. */
int tribo_multifrontal_inertia(const struct lower_columns *a, const struct supernodes *s, const double *size,
                               struct inertia *found);

#endif
