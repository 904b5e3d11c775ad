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
    size_t with, without, sliders;              /* lengths of q, of w, and of the part of w that are sliders */
    size_t *place;                              /* [ndof + ncontact] places in q, w: of degrees of freedom, then of sliders */
    double *x, *sum, *size;                     /* [ndof] workspace */
    double *terms;                              /* [with] sum of the sizes of the terms of the stiffness K_ii of q */
    double *own, *shared;                       /* [ncontact] G_ii; [ncontact][ncontact] G, NULL if G is diagonal */
    struct cholesky factor;                     /* Cholesky factor of K_ww */
    struct matrix kqq, kqw, kww, jq, direction; /* blocks of K and J; J_q + J_w follow */
    struct matrix follow, give, touch;          /* [without][with], [without][ncontact]; J_w [ncontact][without] */
};

static void condensed_free(struct condensed *s)
{
    struct matrix *const all[] = {&s->kqq, &s->kqw, &s->kww, &s->jq, &s->direction, &s->follow, &s->give, &s->touch};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        tribo_matrix_free(all[k]);
    }
    tribo_cholesky_free(&s->factor);
    free(s->place);
    free(s->shared);
}

/* Returns 1 if degree of freedom d has no mass: its row of M is empty or 0. */
static int is_massless(const struct model *m, size_t d)
{
    int is = 1;
    for (size_t e = m->mass.first[d]; e < m->mass.first[d + 1]; e++) {
        is &= m->mass.val[e] == 0.0;
    }
    return is;
}

/* Sets place, with, without and sliders; reserves memory. Returns 0 if out of memory. */
static int condense_number(const struct model *m, struct condensed *s)
{
    const size_t n = m->ndof, c = m->ncontact;
    struct layout l = {0};
    do {
        s->place = tribo_layout_array(&l, n + c, sizeof *s->place);
        s->x = tribo_layout_array(&l, n, sizeof *s->x);
        s->sum = tribo_layout_array(&l, n, sizeof *s->sum);
        s->size = tribo_layout_array(&l, n, sizeof *s->size);
        s->terms = tribo_layout_array(&l, n, sizeof *s->terms);
        s->own = tribo_layout_array(&l, c, sizeof *s->own);
    } while (!l.memory && tribo_layout_create(&l));
    for (size_t d = 0; l.memory && d < n; d++) {
        s->with += !is_massless(m, d);
    }
    for (size_t d = 0, q = 0; l.memory && d < n; d++) {
        s->place[d] = is_massless(m, d) ? s->with + s->without++ : q++;
    }
    for (size_t i = 0; l.memory && m->compliance && i < c; i++) {
        if (m->compliance[i] > 0.0) {
            s->place[n + s->sliders] = n + s->sliders;
            s->sliders++;
        }
    }
    return l.memory != NULL;
}

static int check_damping(const struct model *m, const struct condensed *s)
{
    for (size_t i = 0; i < m->damping.rows; i++) {
        for (size_t k = m->damping.first[i]; k < m->damping.first[i + 1]; k++) {
            const size_t j = m->damping.col[k];
            if (m->damping.val[k] != 0.0 && (s->place[i] >= s->with || s->place[j] >= s->with)) {
                return tribo_model_fail(
                    m, TRIBO_ERR_UNSUPPORTED,
                    "damping[%zu][%zu] = %g, but degree of freedom %zu has no mass: there only stiffness acts", i, j,
                    m->damping.val[k], s->place[i] >= s->with ? i : j);
            }
        }
    }
    return TRIBO_OK;
}

enum { Q, W, ALL };

/* to = block of a, rows and columns of q or w; ALL rows for J (rows are contacts). Returns 0 if out of memory. */
static int take_block(const struct condensed *s, const struct matrix *a, int rows, int cols, struct matrix *to)
{
    const size_t begin[] = {0, s->with, 0}, length[] = {s->with, s->without, a->rows};
    struct triplets t = {0};
    for (size_t i = 0; i < a->rows; i++) {
        const size_t row = (rows == ALL ? i : s->place[i]) - begin[rows];
        for (size_t e = a->first[i]; row < length[rows] && e < a->first[i + 1]; e++) {
            const size_t col = s->place[a->col[e]] - begin[cols];
            if (col < length[cols]) {
                tribo_triplets_put(&t, row, col, a->val[e]);
            }
        }
    }
    return tribo_triplets_finish(&t, length[rows], length[cols], to);
}

/* Factorizes K_ww. Returns a status, TRIBO_ERR_INDEFINITE if a pivot is rounding. */
static int factorize_without(const struct model *m, struct condensed *s)
{
    size_t where = 0, dof = 0;
    double pivot = 0.0;
    int status = s->without ? tribo_cholesky_create(&s->factor, &s->kww, NULL, &where, &pivot) : TRIBO_OK;
    for (size_t k = 0; !status && s->factor.root && k < s->without; k++) {
        where = k;
        pivot = s->factor.root[k] * s->factor.root[k];
        status = pivot <= ROUNDING * tribo_matrix_get(&s->kww, k, k) ? TRIBO_ERR_INDEFINITE : TRIBO_OK;
    }
    while (status == TRIBO_ERR_INDEFINITE && s->place[dof] != s->with + where) {
        dof++;
    }
    return status == TRIBO_ERR_INDEFINITE
               ? tribo_model_fail(m, status,
                                  "mass is not positive definite: degree of freedom %zu has none, and the stiffness does not "
                                  "hold it: pivot %g",
                                  dof, pivot)
           : status == TRIBO_ERR_SIZE ? tribo_model_too_large(m)
           : status                   ? tribo_model_no_memory(m)
                                      : TRIBO_OK;
}

/* s->x = K_ww^-1 (row i of a)', a [..][without]. Returns 1, or 0 if the row is empty. */
static int solve_row(struct condensed *s, const struct matrix *a, size_t i)
{
    tribo_matrix_get_row(a, i, s->x);
    if (a->first[i] < a->first[i + 1]) {
        tribo_cholesky_solve(&s->factor, 1, s->x);
    }
    return a->first[i] < a->first[i + 1];
}

/* Sets own = G_ii, give, and shared = G if an entry off the diagonal is more than rounding. Returns 0 if out of memory. */
static int find_compliance(const struct model *m, struct condensed *s)
{
    const size_t n = m->ncontact;
    struct triplets give = {0};
    int done = 1;
    for (size_t i = 0; done && i < n; i++) {
        const int touches = solve_row(s, &s->touch, i);
        s->own[i] = (m->compliance ? m->compliance[i] : 0.0) + tribo_matrix_row_dot(&s->touch, i, s->x);
        for (size_t k = 0; touches && k < s->without; k++) {
            tribo_triplets_put(&give, k, i, s->x[k]);
        }
        for (size_t k = 0; touches && done && k < i; k++) {
            const double shared = tribo_matrix_row_dot(&s->touch, k, s->x);
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
    return tribo_triplets_finish(&give, s->without, n, &s->give) && done;
}

/* Sets follow = -K_ww^-1 K_wq. Returns 0 if out of memory. */
static int find_follow(struct condensed *s)
{
    struct triplets t = {0};
    for (size_t i = 0; i < s->with; i++) {
        for (size_t k = 0, end = solve_row(s, &s->kqw, i) ? s->without : 0; k < end; k++) {
            tribo_triplets_put(&t, k, i, -s->x[k]);
        }
    }
    return tribo_triplets_finish(&t, s->without, s->with, &s->follow);
}

/* to = q + w follow, q [..][with], w [..][without]; 0 for entries that are rounding and rows with skip [rows] != 0 (NULL: none).
 * terms [rows] out, or NULL: sum of the sizes of the terms of to_ii. Returns 0 if out of memory. */
static int condense_combine(struct condensed *s, const struct matrix *q, const struct matrix *w, const double *skip,
                            double *terms, struct matrix *to)
{
    struct triplets t = {0};
    for (size_t i = 0; i < q->rows; i++) {
        if (skip && skip[i] != 0.0) {
            continue;
        }
        if (w->first[i] == w->first[i + 1]) {
            tribo_triplets_put_row(&t, i, q, i);
            if (terms) {
                terms[i] = fabs(tribo_matrix_get(q, i, i));
            }
            continue;
        }
        memset(s->sum, 0, s->with * sizeof *s->sum);
        memset(s->size, 0, s->with * sizeof *s->size);
        for (size_t e = q->first[i]; e < q->first[i + 1]; e++) {
            s->sum[q->col[e]] = q->val[e];
            s->size[q->col[e]] = fabs(q->val[e]);
        }
        for (size_t e = w->first[i]; e < w->first[i + 1]; e++) {
            for (size_t f = s->follow.first[w->col[e]]; f < s->follow.first[w->col[e] + 1]; f++) {
                s->sum[s->follow.col[f]] += w->val[e] * s->follow.val[f];
                s->size[s->follow.col[f]] += fabs(w->val[e] * s->follow.val[f]);
            }
        }
        for (size_t j = 0; j < s->with; j++) {
            tribo_triplets_put(&t, i, j, fabs(s->sum[j]) > ROUNDING * s->size[j] ? s->sum[j] : 0.0);
        }
        if (terms) {
            terms[i] = s->size[i];
        }
    }
    return tribo_triplets_finish(&t, q->rows, s->with, to);
}

/* Appends the sliders to follow, give and touch. Returns 0 if out of memory. */
static int append_sliders(const struct model *m, struct condensed *s)
{
    const size_t n = m->ncontact;
    struct triplets follow = {0}, give = {0}, touch = {0};
    size_t w = s->without;
    for (size_t k = 0; k < s->without; k++) {
        tribo_triplets_put_row(&follow, k, &s->follow, k);
        tribo_triplets_put_row(&give, k, &s->give, k);
    }
    for (size_t i = 0; i < n; i++) {
        if (!(m->compliance && m->compliance[i] > 0.0)) {
            tribo_triplets_put_row(&touch, i, &s->touch, i);
            continue;
        }
        tribo_triplets_put_row(&follow, w, &s->direction, i);
        for (size_t k = 0; k < n; k++) {
            tribo_triplets_put(&give, w, k, s->shared ? s->shared[i * n + k] : k == i ? s->own[i] : 0.0);
        }
        tribo_triplets_put(&touch, i, w++, 1.0);
    }
    tribo_matrix_free(&s->follow);
    tribo_matrix_free(&s->give);
    tribo_matrix_free(&s->touch);
    return tribo_triplets_finish(&follow, w, s->with, &s->follow) & tribo_triplets_finish(&give, w, n, &s->give) &
           tribo_triplets_finish(&touch, n, w, &s->touch);
}

/* Replaces the matrices of m by the matrices of q, with empty rows of J for compliant contacts. Returns 0 if out of memory. */
static int replace_matrices(struct model *m, struct condensed *s)
{
    struct matrix mass = {0}, damping = {0}, stiffness = {0}, rigid = {0}, half = {0}, other = {0};
    const int done = take_block(s, &m->mass, Q, Q, &mass) && (!m->damping.rows || take_block(s, &m->damping, Q, Q, &damping)) &&
                     condense_combine(s, &s->kqq, &s->kqw, NULL, s->terms, &half) && tribo_matrix_transpose(&other, &half) &&
                     tribo_matrix_sum(&stiffness, 0.5, &half, 0.5, &other) &&
                     condense_combine(s, &s->jq, &s->touch, s->own, NULL, &rigid);
    tribo_matrix_free(&half);
    tribo_matrix_free(&other);
    tribo_model_free(m);
    m->mass = mass;
    m->damping = damping;
    m->stiffness = stiffness;
    m->direction = rigid;
    m->ndof = s->with;
    return done;
}

int tribo_model_condense(struct model *m, tribo_system **sys)
{
    struct condensed s = {0};
    const struct matrix *k = &m->stiffness, *j = &m->direction;
    const size_t given = m->ndof;
    size_t where = 0;
    int status = condense_number(m, &s) ? TRIBO_OK : tribo_model_no_memory(m);
    if (status || s.without + s.sliders == 0 || s.with == 0) {
        condensed_free(&s);
        return status ? status : tribo_model_build_massive(m, sys);
    }
    int done = take_block(&s, k, Q, Q, &s.kqq) && take_block(&s, k, Q, W, &s.kqw) && take_block(&s, k, W, W, &s.kww) &&
               take_block(&s, j, ALL, Q, &s.jq) && take_block(&s, j, ALL, W, &s.touch);
    status = done ? check_damping(m, &s) : tribo_model_no_memory(m);
    status = status ? status : factorize_without(m, &s);
    if (!status) {
        done = find_compliance(m, &s) && find_follow(&s) && condense_combine(&s, &s.jq, &s.touch, NULL, NULL, &s.direction) &&
               replace_matrices(m, &s) && append_sliders(m, &s);
        status = done ? tribo_model_build_massive(m, sys) : tribo_model_no_memory(m);
    }
    if (!status) {
        (*sys)->given = given;
        status = tribo_compliance_create(*sys, &s.direction, s.own, s.shared, &where);
        done = status || tribo_expansion_create(*sys, s.sliders, s.place, s.terms, &s.follow, &s.give, &s.touch);
        status = status == TRIBO_ERR_INDEFINITE
                     ? tribo_model_fail(
                           m, TRIBO_ERR_UNSUPPORTED,
                           "contact %zu moves degrees of freedom without mass only as other contacts do: give these mass", where)
                 : status || !done ? tribo_model_no_memory(m)
                                   : TRIBO_OK;
    }
    condensed_free(&s);
    return status;
}
