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

/* Entries of the stiffness and of all springs, P'P/compliance with P = (row i of J, -1 at w), w from the first slider on. */
static size_t list_springs(const struct model *m, size_t w, size_t *row, size_t *col, double *val)
{
    const struct matrix *k = &m->stiffness, *j = &m->direction;
    size_t count = 0;
    for (size_t i = 0; i < k->rows; i++) {
        for (size_t e = k->first[i]; e < k->first[i + 1]; e++) {
            row[count] = i;
            col[count] = k->col[e];
            val[count++] = k->val[e];
        }
    }
    for (size_t i = 0; i < m->ncontact; i++) {
        const size_t first = j->first[i], last = j->first[i + 1];
        for (size_t a = first; m->compliance[i] > 0.0 && a <= last; a++) {
            for (size_t b = first; b <= last; b++) {
                row[count] = a < last ? j->col[a] : w;
                col[count] = b < last ? j->col[b] : w;
                val[count++] = (a < last ? j->val[a] : -1.0) * (b < last ? j->val[b] : -1.0) / m->compliance[i];
            }
        }
        w += m->compliance[i] > 0.0;
    }
    return count;
}

/* Adds all springs to the stiffness. 0 if out of memory. */
static int add_springs(struct model *m, size_t w)
{
    const struct matrix *j = &m->direction;
    struct matrix all = {0};
    size_t room = m->stiffness.first[m->stiffness.rows] + 1, count = 0;
    for (size_t i = 0; i < m->ncontact; i++) {
        const size_t n = j->first[i + 1] - j->first[i] + 1;
        room += m->compliance[i] > 0.0 ? n * n : 0;
    }
    size_t *row = malloc(room * sizeof *row), *col = malloc(room * sizeof *col);
    double *val = malloc(room * sizeof *val);
    int done = row && col && val;
    done = done && replace(&all, m->ndof, m->ndof, list_springs(m, w, row, col, val), row, col, val);
    for (size_t i = 0; done && i < m->ndof; i++) { /* entries of one place stand side by side */
        for (size_t e = all.first[i]; e < all.first[i + 1]; e++) {
            const int again = e > all.first[i] && all.col[e] == all.col[e - 1];
            count -= (size_t)again;
            row[count] = i;
            col[count] = all.col[e];
            val[count] = (again ? val[count] : 0.0) + all.val[e];
            count++;
        }
    }
    done = done && replace(&m->stiffness, m->ndof, m->ndof, count, row, col, val);
    tribo_matrix_free(&all);
    free(row);
    free(col);
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
    return done && add_springs(m, n) && move_contacts(m, n) ? TRIBO_OK : tribo_model_no_memory(m);
}
