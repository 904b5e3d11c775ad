/* Displacements without mass: while nothing holds them they follow the others, K_ww w = -K_wq q; modes are of what is left. */
#include "parts.h"

#include <stdlib.h>
#include <string.h>

/* place [z->cols] = where a displacement stands among those without mass, or, ~ of that, among the others. Returns how many have
 * none. */
static size_t slack_divide(const struct modal_build *b, const struct matrix *z, ptrdiff_t *place)
{
    size_t free_ones = 0, others = 0;
    memset(place, 0, z->cols * sizeof *place);
    for (size_t d = 0; d < z->rows; d++) {
        for (size_t e = z->first[d]; e < z->first[d + 1]; e++) {
            place[z->col[e]] |= !b->shared->sys->massless.is[d] && z->val[e] != 0.0;
        }
    }
    for (size_t j = 0; j < z->cols; j++) {
        place[j] = place[j] ? ~(ptrdiff_t)others++ : (ptrdiff_t)free_ones++;
    }
    return free_ones;
}

/* The free ones of z [..][slack] in their places, and the others y [others][slack] = K_ww^-1 K_wq, from k = Z'KZ. Returns a
 * status. */
static int solve_slack(struct modal_build *b, const double *k, size_t cols, const ptrdiff_t *place, size_t slack, double *y)
{
    double *kww = tribo_modal_scratch(b, slack * slack), pivot;
    struct matrix a = {0};
    size_t where;
    if (!kww) {
        return TRIBO_ERR_MEMORY;
    }
    for (size_t i = 0; i < cols; i++) {
        for (size_t j = 0; j < cols && place[i] >= 0; j++) {
            if (place[j] >= 0) {
                kww[(size_t)place[i] * slack + (size_t)place[j]] = k[i * cols + j];
            } else {
                y[(size_t)~place[j] * slack + (size_t)place[i]] = k[i * cols + j];
            }
        }
    }
    int status = tribo_matrix_from_dense(&a, slack, slack, kww) ? TRIBO_OK : TRIBO_ERR_MEMORY;
    status = status ? status : tribo_cholesky_create(&b->slack_stiffness, &a, &where, &pivot);
    tribo_matrix_free(&a);
    if (status == TRIBO_ERR_INDEFINITE) {
        return tribo_system_fail(b->shared->sys, status,
                                 "with contacts held, the stiffness does not hold what has no mass: pivot %g", pivot);
    }
    return status || tribo_cholesky_solve(&b->slack_stiffness, cols - slack, y) ? status : TRIBO_ERR_MEMORY;
}

/* x [ndof][others] = Z_q - Z_w y'; and slack = Z_w. */
static int slack_split(struct modal_build *b, const struct matrix *z, const ptrdiff_t *place, size_t slack, const double *y,
                       double *x)
{
    const size_t others = z->cols - slack;
    double *w = tribo_modal_scratch(b, z->rows * slack);
    for (size_t d = 0; w && d < z->rows; d++) {
        for (size_t e = z->first[d]; e < z->first[d + 1]; e++) {
            const ptrdiff_t at = place[z->col[e]];
            if (at < 0) {
                x[d * others + (size_t)~at] += z->val[e];
                continue;
            }
            w[d * slack + (size_t)at] = z->val[e];
            for (size_t j = 0; j < others; j++) {
                x[d * others + j] -= z->val[e] * y[j * slack + (size_t)at];
            }
        }
    }
    return w && tribo_matrix_from_dense(&b->slack, z->rows, slack, w);
}

int tribo_modal_condense(struct modal_build *b, struct matrix *z)
{
    if (!z->rows && !tribo_matrix_diagonal(z, b->n, NULL)) {
        return TRIBO_ERR_MEMORY;
    }
    const size_t cols = z->cols;
    ptrdiff_t *place = malloc((cols + 1) * sizeof *place);
    double *k = tribo_modal_scratch(b, cols * cols);
    const size_t slack = place ? slack_divide(b, z, place) : 0, others = cols - slack;
    double *y = tribo_modal_scratch(b, others * slack), *x = tribo_modal_scratch(b, b->n * others);
    int status = place && k && y && x && tribo_matrix_congruent(b->shared->stiffness, z, k) ? TRIBO_OK : TRIBO_ERR_MEMORY;
    if (!status && slack) {
        status = solve_slack(b, k, cols, place, slack, y);
        status = status || slack_split(b, z, place, slack, y, x) ? status : TRIBO_ERR_MEMORY;
        tribo_matrix_free(z);
        status = status || tribo_matrix_from_dense(z, b->n, others, x) ? status : TRIBO_ERR_MEMORY;
    }
    free(place);
    return status;
}

int tribo_modal_relax(struct modal_build *b, double *y)
{
    const struct matrix *w = &b->slack;
    double *force = w->cols ? tribo_modal_scratch(b, b->n + w->cols) : NULL, *give = force ? force + b->n : NULL;
    if (!force) {
        return w->cols == 0;
    }
    tribo_matrix_multiply_add(b->shared->stiffness, -1.0, y, force);
    for (size_t d = 0; d < w->rows; d++) {
        for (size_t e = w->first[d]; e < w->first[d + 1]; e++) {
            give[w->col[e]] += w->val[e] * force[d];
        }
    }
    const int done = tribo_cholesky_solve(&b->slack_stiffness, 1, give);
    tribo_matrix_multiply_add(w, 1.0, give, y);
    return done;
}
