/* SPDX-License-Identifier: BSD-3-Clause */
/* Eliminates the degrees of freedom w without mass of a model by K_ww w = J_w'f - K_wq q; q: degrees of freedom with mass.
 *     w = follow q + give f,   follow = -K_ww^-1 K_wq,   give = K_ww^-1 J_w'.
 * The system of q has stiffness K_qq + K_qw follow, directions J_q + J_w follow, and compliance G = J_w give. A spring of
 * compliance c before the slider of contact i adds c to G_ii. Its slider is one more displacement w, with row i of the directions
 * as its row of follow, and row i of G as its row of give. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"
#include "common/layout.h"
#include "common/real.h"

/* A sum is rounding if at most ROUNDING times its terms; a pivot, if at most ROUNDING times its diagonal entry. */
#define ROUNDING (64.0 * DBL_EPSILON)

struct condensed {
    size_t with, without;     /* lengths of q, of w */
    struct expansion x;       /* of the system, before the sliders are appended */
    double *row, *sum, *size; /* [ndof] workspace; sum of the entries of a row, and of their sizes, by columns */
    size_t *column;           /* [ndof] columns of a row with an entry */
    struct matrix whole;      /* [ndof][with] the identity, and follow: all displacements, by place, by q */
    double *own, *shared;     /* [ncontact] G_ii; [ncontact][ncontact] G, NULL if G is diagonal */
    struct matrix kww, kqw;   /* blocks of K */
    struct cholesky factor;   /* Cholesky factor of K_ww */
};

static void condensed_free(struct condensed *s)
{
    tribo_expansion_free(&s->x);
    tribo_matrix_free(&s->kww);
    tribo_matrix_free(&s->kqw);
    tribo_matrix_free(&s->whole);
    tribo_cholesky_free(&s->factor);
    free(s->row);
    free(s->shared);
}

static int check_damping(const tribo_model *m, const struct condensed *s)
{
    for (size_t i = 0; i < m->damping.rows; i++) {
        for (size_t k = m->damping.first[i]; k < m->damping.first[i + 1]; k++) {
            const size_t j = m->damping.col[k];
            if (m->damping.val[k] != 0.0 && (s->x.place[i] >= s->with || s->x.place[j] >= s->with)) {
                return tribo_error(m->message, TRIBO_ERR_UNSUPPORTED,
                                   "damping[%zu][%zu] = %g, but degree of freedom %zu has no mass: there only stiffness acts", i,
                                   j, m->damping.val[k], s->x.place[i] >= s->with ? i : j);
            }
        }
    }
    return TRIBO_OK;
}

/* to [rows][without] = columns w of a, of the rows with place first .. first + rows - 1; place NULL: of all rows. Returns 0 if
 * out of memory. */
static int take_without(const struct condensed *s, const struct matrix *a, const size_t *place, size_t first, size_t rows,
                        struct matrix *to)
{
    struct triplets t = {0};
    for (size_t i = 0; i < a->rows; i++) {
        const size_t row = (place ? place[i] : i) - first;
        for (size_t e = a->first[i]; row < rows && e < a->first[i + 1]; e++) {
            if (s->x.place[a->col[e]] >= s->with) {
                tribo_triplets_put(&t, row, s->x.place[a->col[e]] - s->with, a->val[e]);
            }
        }
    }
    return tribo_triplets_finish(&t, rows, s->without, to);
}

/* Factorizes K_ww. Returns a status, TRIBO_ERR_INDEFINITE if a pivot is rounding. */
static int factorize_without(const tribo_model *m, struct condensed *s)
{
    size_t where = 0, dof = 0;
    double pivot = 0.0;
    int status = s->without ? tribo_cholesky_create(&s->factor, &s->kww, NULL, &where, &pivot) : TRIBO_OK;
    for (size_t k = 0; !status && s->factor.root && k < s->without; k++) {
        where = k;
        pivot = s->factor.root[k] * s->factor.root[k];
        status = pivot <= ROUNDING * tribo_matrix_get(&s->kww, k, k) ? TRIBO_ERR_INDEFINITE : TRIBO_OK;
    }
    while (status == TRIBO_ERR_INDEFINITE && s->x.place[dof] != s->with + where) {
        dof++;
    }
    return status == TRIBO_ERR_INDEFINITE
               ? tribo_error(m->message, status,
                             "mass is not positive definite: degree of freedom %zu has none, and the stiffness does not "
                             "hold it: pivot %g",
                             dof, pivot)
           : status == TRIBO_ERR_SIZE ? tribo_model_too_large(m)
                                      : status;
}

/* s->row = K_ww^-1 (row i of a)', a [..][without]. Returns 0 if the row has no entry. */
static int solve_row(struct condensed *s, const struct matrix *a, size_t i)
{
    tribo_matrix_get_row(a, i, s->row);
    return a->first[i] < a->first[i + 1] && tribo_cholesky_solve(&s->factor, 1, s->row);
}

/* Sets follow = -K_ww^-1 K_wq, and whole; own = G_ii, give, and shared = G if an entry off the diagonal is more than rounding.
 * Returns 0 if out of memory. */
static int find_responses(const tribo_model *m, struct condensed *s)
{
    const size_t n = m->ncontact;
    struct triplets follow = {0}, give = {0}, whole = {0};
    for (size_t q = 0; q < s->with; q++) {
        for (size_t k = 0, end = solve_row(s, &s->kqw, q) ? s->without : 0; k < end; k++) {
            tribo_triplets_put(&follow, k, q, -s->row[k]);
        }
    }
    int done = tribo_triplets_finish(&follow, s->without, s->with, &s->x.follow);
    for (size_t d = 0; done && d < s->with + s->without; d++) {
        if (d < s->with) {
            tribo_triplets_put(&whole, d, d, 1.0);
        } else {
            tribo_triplets_put_row(&whole, d, &s->x.follow, d - s->with);
        }
    }
    for (size_t i = 0; done && i < n; i++) {
        const int touches = solve_row(s, &s->x.touch, i);
        s->own[i] = (m->compliance ? m->compliance[i] : 0.0) + tribo_matrix_row_dot(&s->x.touch, i, s->row);
        for (size_t k = 0; touches && k < s->without; k++) {
            tribo_triplets_put(&give, k, i, s->row[k]);
        }
        for (size_t k = 0; touches && done && k < i; k++) {
            const double shared = tribo_matrix_row_dot(&s->x.touch, k, s->row);
            if (!s->shared && fabs(shared) > ROUNDING * sqrt(s->own[i] * s->own[k])) {
                s->shared = calloc(n * n, sizeof *s->shared);
                done = s->shared != NULL;
            }
            if (s->shared) {
                s->shared[i * n + k] = s->shared[k * n + i] = shared;
            }
        }
    }
    for (size_t i = 0; s->shared && i < n; i++) {
        s->shared[i * n + i] = s->own[i];
    }
    return tribo_triplets_finish(&give, s->without, n, &s->x.give) &
           tribo_triplets_finish(&whole, s->with + s->without, s->with, &s->whole) & done;
}

/* to = a whole, of the rows q, or of all rows (a = J); 0 for entries that are rounding. terms [rows] out, or NULL: sum of the
 * sizes of the terms of to_ii. Returns 0 if out of memory. */
static int condense_combine(struct condensed *s, const struct matrix *a, int all, double *terms, struct matrix *to)
{
    const size_t *place = s->x.place, rows = all ? a->rows : s->with;
    struct triplets t = {0};
    for (size_t i = 0; i < a->rows; i++) {
        const size_t row = all ? i : place[i];
        size_t columns = 0;
        for (size_t e = a->first[i]; row < rows && e < a->first[i + 1]; e++) {
            const size_t j = place[a->col[e]];
            for (size_t f = s->whole.first[j]; f < s->whole.first[j + 1]; f++) {
                const size_t column = s->whole.col[f];
                const double term = a->val[e] * s->whole.val[f];
                if (s->size[column] == 0.0 && term != 0.0) {
                    s->column[columns++] = column;
                }
                s->sum[column] += term;
                s->size[column] += fabs(term);
            }
        }
        if (terms && row < rows) {
            terms[row] = s->size[row];
        }
        while (columns > 0) {
            const size_t j = s->column[--columns];
            tribo_triplets_put(&t, row, j, fabs(s->sum[j]) > ROUNDING * s->size[j] ? s->sum[j] : 0.0);
            s->sum[j] = s->size[j] = 0.0;
        }
    }
    return tribo_triplets_finish(&t, rows, s->with, to);
}

/* Replaces the matrices of m by the matrices of q. Returns 0 if out of memory. */
static int replace_matrices(tribo_model *m, struct condensed *s)
{
    tribo_model made = *m;
    struct matrix half = {0}, other = {0};
    const double even = s->without ? 0.5 : 0.0; /* K of q alone is as given, also if not symmetric */
    made.mass = made.damping = made.stiffness = made.direction = (struct matrix){0};
    made.ndof = s->with;
    const int done = condense_combine(s, &m->mass, 0, NULL, &made.mass) &&
                     (!m->damping.rows || condense_combine(s, &m->damping, 0, NULL, &made.damping)) &&
                     condense_combine(s, &m->stiffness, 0, s->x.terms, &half) && tribo_matrix_transpose(&other, &half) &&
                     tribo_matrix_sum(&made.stiffness, 1.0 - even, &half, even, &other) &&
                     condense_combine(s, &m->direction, 1, NULL, &made.direction);
    tribo_matrix_free(&half);
    tribo_matrix_free(&other);
    tribo_model_free(m);
    *m = made;
    return done;
}

int tribo_model_condense(tribo_model *m, tribo_system **sys)
{
    const size_t given = m->ndof, c = m->ncontact, *mass = m->mass.first;
    size_t where = 0;
    struct condensed s = {.x = {.dofs = given}};
    s.x.place = malloc((given + c) * sizeof *s.x.place);
    s.x.terms = malloc(given * sizeof *s.x.terms);
    int done = s.x.place && s.x.terms &&
               ALLOCATE(ARRAY(s.row, given), ARRAY(s.sum, given), ARRAY(s.size, given), ARRAY(s.own, c), ARRAY(s.column, given));
    int status = done ? TRIBO_OK : TRIBO_ERR_MEMORY;
    for (size_t d = 0; d < given; d++) {
        s.with += mass[d] < mass[d + 1];
    }
    for (size_t d = 0, q = 0; !status && d < given; d++) {
        s.x.place[d] = mass[d] < mass[d + 1] ? q++ : s.with + s.without++;
    }
    for (size_t i = 0; m->compliance && i < m->ncontact; i++) {
        s.x.sliders += m->compliance[i] > 0.0;
    }
    if (status || s.without + s.x.sliders == 0 || s.with == 0) {
        condensed_free(&s);
        return status ? status : tribo_model_build_massive(m, NULL, sys);
    }
    if (s.without) {
        status = tribo_model_check_symmetric(m, "stiffness", &m->stiffness,
                                             ": beside degrees of freedom without mass it must be symmetric");
    }
    done = take_without(&s, &m->stiffness, s.x.place, s.with, s.without, &s.kww) &&
           take_without(&s, &m->stiffness, s.x.place, 0, s.with, &s.kqw) &&
           take_without(&s, &m->direction, NULL, 0, m->ncontact, &s.x.touch);
    status = status ? status : done ? check_damping(m, &s) : TRIBO_ERR_MEMORY;
    status = status ? status : factorize_without(m, &s);
    if (!status) {
        done = find_responses(m, &s) && replace_matrices(m, &s);
        status = done ? tribo_model_build_massive(m, s.own, sys) : TRIBO_ERR_MEMORY;
    }
    if (!status) {
        (*sys)->reduced.given = given;
        status = tribo_compliance_create(*sys, s.own, s.shared, &where);
        status = status || tribo_expansion_create(*sys, &s.x, m->compliance) ? status : TRIBO_ERR_MEMORY;
        status = status == TRIBO_ERR_INDEFINITE
                     ? tribo_error(m->message, TRIBO_ERR_UNSUPPORTED,
                                   "contact %zu moves degrees of freedom without mass only as other contacts do: give these mass",
                                   where)
                     : status;
    }
    condensed_free(&s);
    return status;
}
