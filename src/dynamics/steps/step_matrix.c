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

void tribo_step_matrix_free(struct step_matrix *m)
{
    free(m->band);
    free(m->pivot);
    free(m->body);
    tribo_cholesky_free(&m->sparse);
    tribo_matrix_free(&m->s);
    *m = (struct step_matrix){0};
}

/* Sets count if contacts hold bodies of their own, and S is narrow enough to save work. Returns 0 if out of memory. */
static int matrix_find_bodies(struct step_matrix *m, const tribo_system *sys)
{
    const size_t n = m->n, count = sys->ncontact;
    if (!count || sys->compliance.count || m->below != m->above || 2 * m->below > count) {
        return 1;
    }
    if (!ALLOCATE(ARRAY(m->body, count), ARRAY(m->contact, n), ARRAY(m->lever, count), ARRAY(m->own, count),
                  ARRAY(m->noise, count), ARRAY(m->push, n), ARRAY(m->move, n), ARRAY(m->at, count), ARRAY(m->held, n))) {
        return 0;
    }
    m->count = tribo_step_form_bodies(&sys->direction, m->body, m->lever, m->held) ? count : 0;
    memset(m->held, 0, n);
    for (size_t d = 0; d < n; d++) {
        m->contact[d] = count;
    }
    for (size_t i = 0; i < m->count; i++) {
        m->contact[m->body[i]] = i;
        m->own[i] = tribo_matrix_get(&m->s, m->body[i], m->body[i]);
    }
    return 1;
}

/* ---------------------------------------------------------------------------------------------- the matrix and its factor */

/* Sets the band [n][below + 1] of L, S = L L', by the lower triangle of S: row i begins with column i - below. Rows and columns
 * held are replaced by those of the identity. Returns the row of a pivot that is not positive, or n. */
static size_t band_factorize(struct step_matrix *m)
{
    const struct matrix *s = &m->s;
    const signed char *held = m->held;
    const size_t width = m->below;
    double *l = m->band;
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

/* With exchanges of rows, by LAPACK: S must be regular, but need not be definite. Returns a status, and the row *where of a pivot
 * that is 0. */
static int factorize_lopsided(struct step_matrix *m, size_t *where)
{
    const size_t n = m->n, all = 2 * m->below + m->above + 1, middle = m->below + m->above;
    m->band = n < INT_MAX && all < INT_MAX ? calloc(n * all, sizeof *m->band) : NULL;
    m->pivot = malloc(n * sizeof *m->pivot);
    if (!m->band || !m->pivot) {
        return TRIBO_ERR_MEMORY;
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = m->s.first[i]; k < m->s.first[i + 1]; k++) {
            m->band[m->s.col[k] * all + middle + i - m->s.col[k]] = m->s.val[k];
        }
    }
    const int rows = (int)n, below = (int)m->below, above = (int)m->above, stride = (int)all;
    int info;
    dgbtrf_(&rows, &rows, &below, &above, m->band, &stride, m->pivot, &info);
    *where = info > 0 ? (size_t)info - 1 : n;
    return info > 0 ? TRIBO_ERR_INDEFINITE : TRIBO_OK;
}

/* S += factor k J_n' J_n over the pressed normals. Returns 0 if out of memory. */
static int matrix_add_normals(struct step_matrix *m, const tribo_system *sys, double factor)
{
    const struct matrix *j = &sys->direction;
    int done = 1;
    for (size_t k = 0; done && k < sys->normals.count; k++) {
        const struct normal *n = &sys->normals.normal[k];
        struct triplets t = {0};
        struct matrix own = {0}, sum = m->s;
        for (size_t d = j->first[n->row]; n->pressed && d < j->first[n->row + 1]; d++) {
            for (size_t e = j->first[n->row]; e < j->first[n->row + 1]; e++) {
                tribo_triplets_put(&t, j->col[d], j->col[e], n->stiffness * j->val[d] * j->val[e]);
            }
        }
        done = tribo_triplets_finish(&t, m->n, m->n, &own);
        if (done) {
            done = tribo_matrix_sum(&m->s, 1.0, &sum, factor, &own);
            tribo_matrix_free(&sum);
        }
        tribo_matrix_free(&own);
    }
    return done;
}

int tribo_step_matrix_create(struct step_matrix *m, const tribo_system *sys, double h, int holds)
{
    const struct matrix *const part[] = {&sys->k, &sys->c};
    const double factor[] = {0.25 * h * h, 0.5 * h};
    size_t where = 0, j;
    double x, y;
    tribo_step_matrix_free(m);
    m->n = sys->ndof;
    int status = tribo_matrix_copy(&m->s, &sys->mass) ? TRIBO_OK : TRIBO_ERR_MEMORY;
    for (int p = 0; !status && p < 2; p++) {
        struct matrix sum = m->s;
        if (part[p]->rows) {
            status = tribo_matrix_sum(&m->s, 1.0, &sum, factor[p], part[p]) ? TRIBO_OK : TRIBO_ERR_MEMORY;
            tribo_matrix_free(&sum);
        }
    }
    status = status || matrix_add_normals(m, sys, factor[0]) ? status : TRIBO_ERR_MEMORY;
    for (size_t i = 0; i < m->s.rows; i++) {
        for (size_t k = m->s.first[i]; k < m->s.first[i + 1]; k++) {
            j = m->s.col[k];
            m->below = i > j && i - j > m->below ? i - j : m->below;
            m->above = j > i && j - i > m->above ? j - i : m->above;
        }
    }
    if (!status && (sys->c.rows || sys->circulation > 0.0) && tribo_matrix_flaw(&m->s, 1, &where, &j, &x, &y)) {
        status = factorize_lopsided(m, &where);
    } else if (!status && (!holds || matrix_find_bodies(m, sys))) {
        /* a sparse factor costs less than the band if that has far more entries than S, or is almost the whole matrix */
        const size_t n = m->n, width = m->below > m->above ? m->below : m->above;
        const int sparse = n >= SPARSE_LEAST && (width > 5 * (m->s.first[n] / n + 1) || 2 * width > n);
        if (sparse && !m->count && tribo_cholmod) {
            status = tribo_cholesky_create(&m->sparse, &m->s, &m->s, &where, &x);
        } else {
            m->band = n < INT_MAX ? malloc(n * (m->below + 1) * sizeof *m->band) : NULL;
            where = m->band ? band_factorize(m) : 0;
            status = !m->band ? TRIBO_ERR_MEMORY : where < n ? TRIBO_ERR_INDEFINITE : TRIBO_OK;
        }
    } else {
        status = TRIBO_ERR_MEMORY;
    }
    if (status == TRIBO_ERR_INDEFINITE) {
        return tribo_error(sys->message, status,
                           "the matrix of a step of length %g is not positive definite at degree of freedom %zu", h, where);
    }
    return status ? tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for the matrix of a step") : TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------- solutions */

int tribo_step_matrix_solve(const void *matrix, size_t count, double *x)
{
    const struct step_matrix *m = matrix;
    if (m->sparse.n) {
        return tribo_cholesky_solve(&m->sparse, count, x);
    }
    const int n = (int)m->n, below = (int)m->below, above = (int)m->above, all = (int)count;
    const int stride = 1 + below + (m->pivot ? below + above : 0);
    int info;
    if (m->pivot) {
        dgbtrs_("N", &n, &below, &above, &all, m->band, &stride, m->pivot, x, &n, &info, 1);
    } else if (below) { /* LAPACK's upper band, by columns, is L by rows */
        dpbtrs_("U", &n, &below, &all, m->band, &stride, x, &n, &info, 1);
    } else {
        for (size_t k = 0, d = 0; k < count * m->n; k++, d = d + 1 < m->n ? d + 1 : 0) {
            x[k] /= m->band[d] * m->band[d];
        }
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

/* The bodies of contacts at rest, or none, are held in the factor. */
static void hold_bodies(struct step_matrix *m, int none)
{
    int changed = 0;
    for (size_t i = 0; i < m->count; i++) {
        const signed char holds = none || m->at[i] ? FREE : HOLDS;
        changed |= m->held[m->body[i]] != holds;
        m->held[m->body[i]] = holds;
    }
    if (changed) {
        band_factorize(m);
    }
}

/* du, f and noise with the contacts as they are in at[]. */
static void solve_sets(struct step_matrix *m, const struct band_step *s)
{
    const struct matrix *matrix = &m->s;
    double *x = s->du, *f = s->f;
    hold_bodies(m, 0);
    for (size_t i = 0; i < m->count; i++) {
        f[i] = m->at[i] * s->limit[i];
        m->move[m->body[i]] = m->at[i] ? 0.0 : s->base[i] / m->lever[i] - s->u[m->body[i]];
    }
    /* rows of held bodies are those of the identity; their columns go to the right-hand side, times the moves of their bases */
    tribo_matrix_multiply(matrix, m->move, x);
    for (size_t d = 0; d < matrix->rows; d++) {
        const size_t i = m->contact[d];
        const double rest = m->push[d] - x[d];
        x[d] = m->held[d] ? m->move[d] : i < m->count ? rest + s->h * m->lever[i] * f[i] : rest;
    }
    tribo_step_matrix_solve(m, 1, x);
    for (size_t i = 0; i < m->count; i++) {
        const size_t d = m->body[i];
        const double size = tribo_matrix_row_size(matrix, d, x) + fabs(m->push[d]) + fabs(m->own[i] * s->u[d]);
        const double unit = 1.0 / (s->h * m->lever[i]);
        m->noise[i] = 8.0 * DBL_EPSILON * fabs(unit) * size;
        f[i] = m->at[i] ? f[i] : unit * (tribo_matrix_row_dot(matrix, d, x) - m->push[d]);
    }
}

/* Passes over the bodies upwards or downwards: a holding contact within `reach` bodies after one that begins to slide slides
 * along. */
static void band_sweep(struct step_matrix *m, size_t reach, int upwards)
{
    const size_t n = m->n;
    size_t left = 0;
    double way = 0.0;
    for (size_t k = 0; k < n; k++) {
        const size_t d = upwards ? k : n - 1 - k, i = m->contact[d];
        const int contact = i < m->count;
        if (contact && m->held[d] == HOLDS && m->at[i]) {
            left = reach;
            way = m->lever[i] * m->at[i];
        } else if (left > 0) {
            left--;
            if (contact && !m->at[i]) {
                m->at[i] = m->lever[i] * way > 0.0 ? 1 : -1;
                m->held[d] = FOLLOWS;
            }
        }
    }
}

int tribo_step_matrix_hold(struct step_matrix *m, const tribo_system *sys, const struct band_step *s)
{
    const int rounds = m->count && tribo_system_is_plain(sys) ? ROUNDS : 0;
    size_t reach = 0, freed = 1, caught = 0; /* contacts that begin to slide, to hold */
    if (rounds) {
        memcpy(m->push, s->du, m->n * sizeof *s->du);
    }
    for (int round = 0; freed + caught > 0 && round < rounds; round++) {
        solve_sets(m, s);
        freed = caught = 0;
        for (size_t i = 0; i < m->count; i++) {
            const double noise = m->noise[i], most = s->limit[i] + noise, lever = m->lever[i];
            if (m->at[i] == 0) {
                m->at[i] = (signed char)((s->f[i] > most) - (s->f[i] < -most));
                freed += m->at[i] != 0;
                continue;
            }
            /* the force that would take the velocity away within the step */
            const double v = lever * (s->u[m->body[i]] + s->du[m->body[i]]) - s->base[i];
            if (v * m->own[i] / (s->h * lever * lever) * m->at[i] > noise) {
                m->at[i] = 0;
                caught++;
            }
        }
        reach = caught ? 0 : 2 * reach + 1;
        if (freed && reach > 1) {
            band_sweep(m, reach, 1);
            band_sweep(m, reach, 0);
        }
    }
    if (rounds && freed + caught == 0) {
        for (size_t i = 0; i < m->count; i++) {
            s->f[i] = clamp(s->f[i], -s->limit[i], s->limit[i]);
        }
        return 1;
    }
    hold_bodies(m, 1);
    if (rounds) {
        memcpy(s->du, m->push, m->n * sizeof *s->du);
    }
    return 0;
}
