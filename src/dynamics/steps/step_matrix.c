/* SPDX-License-Identifier: BSD-3-Clause */
#include "step_matrix.h"
#include "fixed_steps.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/layout.h"
#include "common/real.h"
#include "numerics/lapack.h"

/* Returns status, with a message in the system: TRIBO_ERR_INDEFINITE at degree of freedom `where`, or TRIBO_ERR_MEMORY. */
static int step_matrix_fail(const tribo_system *sys, int status, double h, size_t where)
{
    return status == TRIBO_ERR_INDEFINITE
               ? tribo_system_fail(
                     sys, status, "the matrix of a step of length %g is not positive definite at degree of freedom %zu", h, where)
           : status ? tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the matrix of a step")
                    : TRIBO_OK;
}

void tribo_step_matrix_free(struct step_matrix *m)
{
    free(m->band);
    free(m->pivot);
    tribo_cholesky_free(&m->sparse);
    tribo_matrix_free(&m->s);
    *m = (struct step_matrix){0};
}

/* ------------------------------------------------------------------------------------------------------------- the matrix */

int tribo_step_matrix_create(struct step_matrix *m, const tribo_system *sys, double h)
{
    tribo_step_matrix_free(m);
    m->n = sys->ndof;
    const struct matrix *const part[] = {&sys->k, &sys->c};
    const double factor[] = {0.25 * h * h, 0.5 * h};
    int done = tribo_matrix_copy(&m->s, &sys->mass);
    for (int p = 0; done && p < 2; p++) {
        struct matrix sum = m->s;
        if (part[p]->rows) {
            done = tribo_matrix_sum(&m->s, 1.0, &sum, factor[p], part[p]);
            tribo_matrix_free(&sum);
        }
    }
    for (size_t i = 0; i < m->s.rows; i++) {
        for (size_t k = m->s.first[i], j; k < m->s.first[i + 1]; k++) {
            j = m->s.col[k];
            m->below = i > j && i - j > m->below ? i - j : m->below;
            m->above = j > i && j - i > m->above ? j - i : m->above;
        }
    }
    return step_matrix_fail(sys, done ? TRIBO_OK : TRIBO_ERR_MEMORY, h, 0);
}

/* ------------------------------------------------------------------------------------------------------------ its factor */

/* Sets the band l [n][below + 1] of L, S = L L', by the lower triangle of S: row i begins with column i - below. Rows and columns
 * held [n] (NULL: none) are replaced by those of the identity. Returns the row of a pivot that is not positive, or n. */
static size_t band_factorize(const struct step_matrix *m, const signed char *held, double *l)
{
    const struct matrix *s = &m->s;
    const size_t width = m->below;
    for (size_t i = 0; i < m->n; i++) {
        const int holds = held && held[i];
        double *own = l + i * (width + 1) + width - i; /* own[j] = l_ij */
        memset(l + i * (width + 1), 0, (width + 1) * sizeof *l);
        for (size_t k = s->first[i]; k < s->first[i + 1] && s->col[k] <= i; k++) {
            own[s->col[k]] = holds || (held && held[s->col[k]]) ? 0.0 : s->val[k];
        }
        double pivot = holds ? 1.0 : own[i];
        for (size_t j = i > width ? i - width : 0; !holds && j < i; j++) {
            const double *other = l + j * (width + 1) + width - j;
            double x = own[j];
            for (size_t k = i > width ? i - width : 0; k < j; k++) {
                x -= own[k] * other[k];
            }
            own[j] = x / other[j];
            pivot -= own[j] * own[j];
        }
        if (!(pivot > 0.0)) {
            return i;
        }
        own[i] = sqrt(pivot);
    }
    return m->n;
}

/* x [n] = (L L')^-1 x. LAPACK's upper band, by columns, is L by rows. */
static void band_solve(const struct step_matrix *m, const double *l, double *x)
{
    const int rows = (int)m->n, below = (int)m->below, stride = below + 1, one = 1;
    for (size_t i = 0; !below && i < m->n; i++) {
        x[i] = x[i] / l[i] / l[i];
    }
    if (below) {
        dtbsv_("U", "T", "N", &rows, &below, l, &stride, x, &one, 1, 1, 1);
        dtbsv_("U", "N", "N", &rows, &below, l, &stride, x, &one, 1, 1, 1);
    }
}

int tribo_step_matrix_factorize(struct step_matrix *m, const tribo_system *sys, double h, int consumes)
{
    /* a sparse factor costs less than the band if that has far more entries than S, or is almost the whole matrix */
    const size_t width = m->below > m->above ? m->below : m->above;
    const int sparse = m->n >= SPARSE_LEAST && (width > 5 * (m->s.first[m->n] / m->n + 1) || 2 * width > m->n);
    size_t where = 0, j;
    double x, y;
    int status;
    if (sys->c.rows && tribo_matrix_flaw(&m->s, 1, &where, &j, &x, &y)) {
        /* with exchanges of rows, by LAPACK: S must be regular, but need not be definite */
        const size_t n = m->n, all = 2 * m->below + m->above + 1, middle = m->below + m->above;
        m->band = n < INT_MAX && all < INT_MAX ? calloc(n * all, sizeof *m->band) : NULL;
        m->pivot = malloc(n * sizeof *m->pivot);
        if (!m->band || !m->pivot) {
            return step_matrix_fail(sys, TRIBO_ERR_MEMORY, h, 0);
        }
        for (size_t i = 0; i < n; i++) {
            for (size_t k = m->s.first[i]; k < m->s.first[i + 1]; k++) {
                m->band[m->s.col[k] * all + middle + i - m->s.col[k]] = m->s.val[k];
            }
        }
        const int rows = (int)n, below = (int)m->below, above = (int)m->above, stride = (int)all;
        int info;
        dgbtrf_(&rows, &rows, &below, &above, m->band, &stride, m->pivot, &info);
        where = info > 0 ? (size_t)info - 1 : n;
        status = info > 0 ? TRIBO_ERR_INDEFINITE : TRIBO_OK;
    } else if (sparse && tribo_sparse_available()) {
        status = tribo_cholesky_create(&m->sparse, &m->s, consumes ? &m->s : NULL, &where, &x);
    } else {
        m->band = malloc(m->n * (m->below + 1) * sizeof *m->band);
        where = m->band ? band_factorize(m, NULL, m->band) : 0;
        status = !m->band ? TRIBO_ERR_MEMORY : where < m->n ? TRIBO_ERR_INDEFINITE : TRIBO_OK;
    }
    return step_matrix_fail(sys, status, h, where);
}

/* ------------------------------------------------------------------------------------------------------------- solutions */

int tribo_step_matrix_solve(const void *matrix, size_t count, double *x)
{
    const struct step_matrix *m = matrix;
    if (m->sparse.n) {
        return tribo_cholesky_solve(&m->sparse, count, x);
    }
    if (m->pivot) {
        const int n = (int)m->n, below = (int)m->below, above = (int)m->above, all = (int)count, stride = 2 * below + above + 1;
        int info;
        dgbtrs_("N", &n, &below, &above, &all, m->band, &stride, m->pivot, x, &n, &info, 1);
    }
    for (size_t k = 0; !m->pivot && k < count; k++) {
        band_solve(m, m->band, x + k * m->n);
    }
    return 1;
}

/* ------------------------------------------------------------------------------------------------------ bodies held */

/* The box-constrained problem of a step by the method of numerics/box/box.c, for bodies instead of contacts: begin
 * with the contacts that held in the last step; repeat: du = solution with these held; contact i slides if |f_i| > limit_i,
 * and holds if it moves along f_i; until no contact changes, or after ROUNDS.
 *
 * Where the band is stiff, the slip of a body overloads its neighbours within the step, and each round would reach the next
 * neighbour only. So in rounds in which contacts only begin to slide, neighbours within `reach` slide along, and reach
 * doubles from round to round; a contact that slides too early moves along its force, and holds again. */

/* held[]: the contact on a body slides, holds, or held until neighbours began to slide. */
enum { FREE, HOLDS, FOLLOWS };

/* A round costs as much as the band has entries, and a step hardly ever takes more than 10. */
enum { ROUNDS = 100 };

int tribo_step_band_create(struct step_band *b, const tribo_system *sys, const struct step_matrix *m, double h)
{
    const size_t n = m->n, count = b->count = sys->ncontact;
    struct layout l = {0};
    b->matrix = NULL;
    if (!b->body) { /* at is kept where the length of steps changes */
        do {
            b->body = tribo_layout_array(&l, count, sizeof *b->body);
            b->contact = tribo_layout_array(&l, n, sizeof *b->contact);
            b->lever = tribo_layout_array(&l, count, sizeof *b->lever);
            b->own = tribo_layout_array(&l, count, sizeof *b->own);
            b->noise = tribo_layout_array(&l, count, sizeof *b->noise);
            b->push = tribo_layout_array(&l, n, sizeof *b->push);
            b->move = tribo_layout_array(&l, n, sizeof *b->move);
            b->at = tribo_layout_array(&l, count, 1);
            b->held = tribo_layout_array(&l, n, 1);
        } while (!l.memory && tribo_layout_zeros(&l));
    }
    if (!b->body) {
        return step_matrix_fail(sys, TRIBO_ERR_MEMORY, h, 0);
    }
    /* contacts must have bodies of their own, and S be symmetric and narrow enough to save work */
    size_t i, j;
    double x, y;
    memset(b->held, 0, n);
    if (!count || sys->compliance.count || m->below != m->above || 2 * m->below > count ||
        !tribo_step_form_bodies(&sys->direction, b->body, b->lever, b->held) || tribo_matrix_flaw(&m->s, 1, &i, &j, &x, &y)) {
        return TRIBO_OK;
    }
    free(b->l);
    b->l = malloc(n * (m->below + 1) * sizeof *b->l);
    if (!b->l) {
        return step_matrix_fail(sys, TRIBO_ERR_MEMORY, h, 0);
    }
    b->matrix = m;
    for (size_t d = 0; d < n; d++) {
        b->contact[d] = count;
    }
    for (i = 0; i < count; i++) {
        b->contact[b->body[i]] = i;
        b->own[i] = tribo_matrix_get(&m->s, b->body[i], b->body[i]);
    }
    memset(b->held, 0, n);
    b->factored = 0;
    const size_t where = band_factorize(m, NULL, b->l); /* S is definite if and only if all these pivots are positive */
    return step_matrix_fail(sys, where < n ? TRIBO_ERR_INDEFINITE : TRIBO_OK, h, where);
}

/* --------------------------------------------------------------------------------------------------------------- the step */

/* du, f and noise with the contacts as they are in at[]; the factor is kept if held[] does not change. */
static void solve_sets(struct step_band *b, const struct band_step *s)
{
    const double doubt = 8.0 * DBL_EPSILON;
    const struct matrix *matrix = &b->matrix->s;
    const size_t n = matrix->rows;
    double *x = s->du, *f = s->f;
    for (size_t i = 0; i < b->count; i++) {
        const signed char holds = b->at[i] ? FREE : HOLDS;
        b->factored &= b->held[b->body[i]] == holds;
        b->held[b->body[i]] = holds;
    }
    if (!b->factored) {
        b->factored = band_factorize(b->matrix, b->held, b->l) == n;
    }
    memcpy(x, b->push, n * sizeof *x);
    memset(b->move, 0, n * sizeof *x);
    for (size_t i = 0; i < b->count; i++) {
        const size_t d = b->body[i];
        f[i] = b->at[i] * s->limit[i];
        x[d] += s->h * b->lever[i] * f[i];
        b->move[d] = b->at[i] ? 0.0 : s->base[i] / b->lever[i] - s->u[d];
    }
    /* columns of held bodies that move with their bases go to the right-hand side */
    tribo_matrix_multiply_add(matrix, -1.0, b->move, x);
    for (size_t d = 0; d < n; d++) {
        x[d] = b->held[d] ? 0.0 : x[d];
    }
    band_solve(b->matrix, b->l, x);
    for (size_t d = 0; d < n; d++) {
        x[d] = b->held[d] ? b->move[d] : x[d];
    }
    for (size_t i = 0; i < b->count; i++) {
        const size_t d = b->body[i];
        const double size = tribo_matrix_row_size(matrix, d, x) + fabs(b->push[d]) + fabs(b->own[i] * s->u[d]);
        const double unit = 1.0 / (s->h * b->lever[i]);
        b->noise[i] = doubt * fabs(unit) * size;
        f[i] = b->at[i] ? f[i] : unit * (tribo_matrix_row_dot(matrix, d, x) - b->push[d]);
    }
}

/* Revises at[] by forces and velocities: *freed contacts begin to slide, *caught contacts begin to hold. */
static void band_revise(struct step_band *b, const struct band_step *s, size_t *freed, size_t *caught)
{
    *freed = *caught = 0;
    for (size_t i = 0; i < b->count; i++) {
        const size_t d = b->body[i];
        const double noise = b->noise[i], most = s->limit[i] + noise;
        const signed char at = b->at[i];
        if (at == 0) {
            const int side = (s->f[i] > most) - (s->f[i] < -most);
            b->at[i] = (signed char)side;
            *freed += side != 0;
        } else {
            /* the force that would take the velocity away within the step */
            const double v = b->lever[i] * (s->u[d] + s->du[d]) - s->base[i];
            const double pull = v * b->own[i] / (s->h * b->lever[i] * b->lever[i]);
            if (pull * at > noise) {
                b->at[i] = 0;
                ++*caught;
            }
        }
    }
}

/* Passes over the bodies upwards or downwards: a holding contact within `reach` bodies after one that begins to slide slides
 * along. */
static void band_sweep(struct step_band *b, size_t reach, int upwards)
{
    const size_t n = b->matrix->n;
    size_t left = 0;
    double way = 0.0;
    for (size_t k = 0; k < n; k++) {
        const size_t d = upwards ? k : n - 1 - k, i = b->contact[d];
        const int contact = i < b->count;
        if (contact && b->held[d] == HOLDS && b->at[i]) {
            left = reach;
            way = b->lever[i] * b->at[i];
        } else if (left > 0) {
            left--;
            if (contact && !b->at[i]) {
                b->at[i] = b->lever[i] * way > 0.0 ? 1 : -1;
                b->held[d] = FOLLOWS;
            }
        }
    }
}

int tribo_step_band_solve(struct step_band *b, const struct band_step *s)
{
    size_t reach = 0, freed, caught;
    memcpy(b->push, s->du, b->matrix->n * sizeof *s->du);
    for (int round = 0; round < ROUNDS; round++) {
        solve_sets(b, s);
        band_revise(b, s, &freed, &caught);
        if (freed + caught == 0) {
            for (size_t i = 0; i < b->count; i++) {
                s->f[i] = clamp(s->f[i], -s->limit[i], s->limit[i]);
            }
            return 1;
        }
        reach = caught ? 0 : 2 * reach + 1;
        if (reach > 1) {
            band_sweep(b, reach, 1);
            band_sweep(b, reach, 0);
        }
    }
    memcpy(s->du, b->push, b->matrix->n * sizeof *s->du);
    return 0;
}
