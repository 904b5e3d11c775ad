/* Contacts with compliance: a spring in series with a slider, which is a degree of freedom without mass. */
#include <stdlib.h>

#include "model.h"

/* Replaces a by the matrix of entries (row, col, val), which are count. 0 if out of memory. */
static int replace(struct matrix *a, size_t rows, size_t cols, size_t count, const size_t *row, const size_t *col,
                   const double *val)
{
    struct matrix to = {0};
    const int done = tribo_matrix_from_triplets(&to, rows, cols, count, row, col, val);
    if (done) {
        tribo_matrix_free(a);
        *a = to;
    }
    return done;
}

/* a becomes n x n, with empty rows and columns at the end. 0 if out of memory. */
static int enlarge(struct matrix *a, size_t n)
{
    size_t *row = malloc((a->first[a->rows] + 1) * sizeof *row);
    for (size_t i = 0; row && i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            row[k] = i;
        }
    }
    const int done = row && replace(a, n, n, a->first[a->rows], row, a->col, a->val);
    free(row);
    return done;
}

/* Adds P'P/compliance to the stiffness, P = (row i of J, -1 at w). 0 if out of memory. */
static int add_spring(struct model *m, size_t i, size_t w)
{
    const struct matrix *j = &m->direction;
    const size_t first = j->first[i], n = j->first[i + 1] - first + 1;
    size_t *row = malloc(2 * n * n * sizeof *row), *col = row ? row + n * n : NULL;
    double *val = malloc(n * n * sizeof *val);
    struct matrix spring = {0}, sum = {0};
    for (size_t a = 0; row && val && a < n; a++) {
        const double x = a + 1 < n ? j->val[first + a] : -1.0;
        for (size_t b = 0; b < n; b++) {
            const double y = b + 1 < n ? j->val[first + b] : -1.0;
            row[a * n + b] = a + 1 < n ? j->col[first + a] : w;
            col[a * n + b] = b + 1 < n ? j->col[first + b] : w;
            val[a * n + b] = x * y / m->compliance[i];
        }
    }
    const int done = row && val && replace(&spring, m->ndof, m->ndof, n * n, row, col, val) &&
                     tribo_matrix_sum(&sum, 1.0, &m->stiffness, 1.0, &spring);
    if (done) {
        tribo_matrix_free(&m->stiffness);
        m->stiffness = sum;
    }
    tribo_matrix_free(&spring);
    free(row);
    free(val);
    return done;
}

/* Contacts with compliance act on their sliders alone, degrees of freedom from w on. 0 if out of memory. */
static int move_contacts(struct model *m, size_t w)
{
    const struct matrix *j = &m->direction;
    const size_t room = j->first[j->rows] + j->rows + 1;
    size_t *row = malloc(2 * room * sizeof *row), *col = row ? row + room : NULL, count = 0;
    double *val = malloc(room * sizeof *val);
    for (size_t i = 0; row && val && i < j->rows; i++) {
        const int elastic = m->compliance[i] > 0.0;
        if (elastic) {
            row[count] = i;
            col[count] = w++;
            val[count++] = 1.0;
        }
        for (size_t k = j->first[i]; !elastic && k < j->first[i + 1]; k++) {
            row[count] = i;
            col[count] = j->col[k];
            val[count++] = j->val[k];
        }
    }
    const int done = row && val && replace(&m->direction, m->ncontact, m->ndof, count, row, col, val);
    free(row);
    free(val);
    return done;
}

int tribo_model_add_sliders(struct model *m)
{
    const size_t n = m->ndof;
    for (size_t i = 0; m->compliance && i < m->ncontact; i++) {
        m->sliders += m->compliance[i] > 0.0;
    }
    if (m->sliders == 0) {
        return TRIBO_OK;
    }
    m->ndof += m->sliders;
    int done =
        enlarge(&m->mass, m->ndof) && enlarge(&m->stiffness, m->ndof) && (!m->damping.rows || enlarge(&m->damping, m->ndof));
    for (size_t i = 0, w = n; done && i < m->ncontact; i++) {
        if (m->compliance[i] > 0.0) {
            done = add_spring(m, i, w++);
        }
    }
    return done && move_contacts(m, n) ? TRIBO_OK : tribo_model_no_memory(m);
}
