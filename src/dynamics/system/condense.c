/* Eliminates the degrees of freedom w without mass of a model by K_ww w = J_w'f - K_wq q; q: degrees of freedom with mass.
 *     w = follow q + give f,   follow = -K_ww^-1 K_wq,   give = K_ww^-1 J_w'.
 * The system of q has stiffness K_qq + K_qw follow, directions J_q + J_w follow, and compliance G = J_w give. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"
#include "common/real.h"

/* A sum is rounding if at most ROUNDING times its terms; a pivot, if at most ROUNDING times its diagonal entry. */
#define ROUNDING (64.0 * DBL_EPSILON)

/* ---------------------------------------------------------------------------------------------------- lists of entries */

/* Entries v of a matrix: row i, column j. */
struct triplets {
    size_t count, room, *i, *j;
    double *v;
    int failed; /* 1: out of memory */
};

static void condense_put(struct triplets *t, size_t i, size_t j, double v)
{
    if (t->count == t->room && !t->failed) {
        const size_t room = 2 * t->room + 64;
        size_t *rows = realloc(t->i, room * sizeof *rows), *cols = rows ? realloc(t->j, room * sizeof *cols) : NULL;
        double *values = cols ? realloc(t->v, room * sizeof *values) : NULL;
        t->i = rows ? rows : t->i;
        t->j = cols ? cols : t->j;
        t->v = values ? values : t->v;
        t->room = values ? room : t->room;
        t->failed = !values;
    }
    if (v != 0.0 && !t->failed) {
        t->i[t->count] = i;
        t->j[t->count] = j;
        t->v[t->count++] = v;
    }
}

/* to [rows][cols] = matrix of the entries in t; frees t. Returns 0 if out of memory. */
static int finish_triplets(struct triplets *t, size_t rows, size_t cols, struct matrix *to)
{
    const int done = !t->failed && tribo_matrix_from_triplets(to, rows, cols, t->count, t->i, t->j, t->v);
    free(t->i);
    free(t->j);
    free(t->v);
    return done;
}

static void put_row(struct triplets *t, const struct matrix *a, size_t row, size_t i)
{
    for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
        condense_put(t, row, a->col[e], a->val[e]);
    }
}

/* ------------------------------------------------------------------------------------------------------------- sliders */

/* Adds up entries of k with equal row and column. Returns 0 if out of memory. */
static int sum_places(struct matrix *k)
{
    struct triplets t = {0};
    struct matrix sum = {0};
    for (size_t i = 0; i < k->rows; i++) {
        for (size_t e = k->first[i], next; e < k->first[i + 1]; e = next) {
            double v = 0.0;
            for (next = e; next < k->first[i + 1] && k->col[next] == k->col[e]; next++) {
                v += k->val[next];
            }
            condense_put(&t, i, k->col[e], v);
        }
    }
    const int done = finish_triplets(&t, k->rows, k->cols, &sum);
    tribo_matrix_free(k);
    *k = sum;
    return done;
}

int tribo_model_add_sliders(struct model *m)
{
    const struct matrix *j = &m->direction;
    struct triplets k = {0}, d = {0};
    struct matrix stiffness = {0}, direction = {0};
    if (!m->compliance || tribo_largest(m->compliance, m->ncontact) == 0.0) {
        return TRIBO_OK;
    }
    for (size_t i = 0; i < m->ndof; i++) {
        put_row(&k, &m->stiffness, i, i);
    }
    for (size_t i = 0; i < m->ncontact; i++) {
        const size_t w = m->ndof + m->sliders, first = j->first[i], last = j->first[i + 1];
        if (m->compliance[i] == 0.0) {
            put_row(&d, j, i, i);
            continue;
        }
        /* k += P'P/compliance with P = (row i of J, -1 at w) */
        for (size_t a = first; a <= last; a++) {
            for (size_t b = first; b <= last; b++) {
                const double product = (a < last ? j->val[a] : -1.0) * (b < last ? j->val[b] : -1.0);
                condense_put(&k, a < last ? j->col[a] : w, b < last ? j->col[b] : w, product / m->compliance[i]);
            }
        }
        condense_put(&d, i, w, 1.0);
        m->sliders++;
    }
    const size_t n = m->ndof + m->sliders;
    const int done = finish_triplets(&k, n, n, &stiffness) & finish_triplets(&d, m->ncontact, n, &direction);
    if (!done || !sum_places(&stiffness)) {
        tribo_matrix_free(&stiffness);
        tribo_matrix_free(&direction);
        return tribo_model_no_memory(m);
    }
    tribo_matrix_free(&m->stiffness);
    tribo_matrix_free(&m->direction);
    m->stiffness = stiffness;
    m->direction = direction;
    m->ndof = n;
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------- q and w */

struct condensed {
    size_t with, without;     /* lengths of q and w */
    unsigned char *is;        /* [ndof] 1: no mass */
    size_t *place, *dof;      /* [ndof] index in q or w; [without] degree of freedom of an index in w */
    struct cholesky factor;   /* Cholesky factor of K_ww */
    double *x, *sum, *size;   /* [without], [with], [with] workspace */
    double *terms;            /* [with] sum of the sizes of the terms of the stiffness K_ii of q */
    double *own, *shared;     /* [ncontact] G_ii; [ncontact][ncontact] G, NULL if G is diagonal */
    struct matrix kqq, kqw, kww, jq, touch; /* blocks of K and J; touch = J_w */
    struct matrix follow, give;             /* [without][with], [without][ncontact] */
};

static void condensed_free(struct condensed *s)
{
    struct matrix *const all[] = {&s->kqq, &s->kqw, &s->kww, &s->jq, &s->touch, &s->follow, &s->give};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        tribo_matrix_free(all[k]);
    }
    tribo_cholesky_free(&s->factor);
    free(s->is);
    free(s->place);
    free(s->sum);
    free(s->shared);
}

/* Sets is, place, dof, with and without. A degree of freedom has no mass if its row of M is missing or 0. Returns 0 if out of
 * memory. */
static int condense_number(const struct model *m, struct condensed *s)
{
    s->is = malloc(m->ndof + 1);
    s->place = malloc((2 * m->ndof + 1) * sizeof *s->place);
    s->sum = malloc((4 * m->ndof + m->ncontact + 1) * sizeof *s->sum);
    if (!s->is || !s->place || !s->sum) {
        return 0;
    }
    s->dof = s->place + m->ndof;
    s->size = s->sum + m->ndof;
    s->x = s->size + m->ndof;
    s->terms = s->x + m->ndof;
    s->own = s->terms + m->ndof;
    for (size_t d = 0; d < m->ndof; d++) {
        s->is[d] = 1;
        for (size_t e = 0, row = d < m->mass.rows; row && e < m->mass.first[d + 1] - m->mass.first[d]; e++) {
            s->is[d] &= m->mass.val[m->mass.first[d] + e] == 0.0;
        }
        s->dof[s->without] = d;
        s->place[d] = s->is[d] ? s->without++ : s->with++;
    }
    return 1;
}

static int check_damping(const struct model *m, const struct condensed *s)
{
    for (size_t i = 0; i < m->damping.rows; i++) {
        for (size_t k = m->damping.first[i]; k < m->damping.first[i + 1]; k++) {
            const size_t j = m->damping.col[k];
            if (m->damping.val[k] != 0.0 && (s->is[i] || s->is[j])) {
                return tribo_model_fail(
                    m, TRIBO_ERR_UNSUPPORTED,
                    "damping[%zu][%zu] = %g, but degree of freedom %zu has no mass: there only stiffness acts", i, j,
                    m->damping.val[k], s->is[i] ? i : j);
            }
        }
    }
    return TRIBO_OK;
}

enum { Q, W, ALL };

/* to = block of a, rows and columns of q or w; ALL rows for J (rows are contacts). Returns 0 if out of memory. */
static int take_block(const struct condensed *s, const struct matrix *a, int rows, int cols, struct matrix *to)
{
    const size_t of[] = {s->with, s->without, a->rows};
    struct triplets t = {0};
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t e = a->first[i]; (rows == ALL || s->is[i] == rows) && e < a->first[i + 1]; e++) {
            if (s->is[a->col[e]] == cols) {
                condense_put(&t, rows == ALL ? i : s->place[i], s->place[a->col[e]], a->val[e]);
            }
        }
    }
    return finish_triplets(&t, of[rows], of[cols], to);
}

/* s->x = K_ww^-1 (row i of a)', a [..][without]. Returns 1, or 0 if the row is empty. */
static int solve_row(struct condensed *s, const struct matrix *a, size_t i)
{
    memset(s->x, 0, s->without * sizeof *s->x);
    for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
        s->x[a->col[e]] = a->val[e];
    }
    if (a->first[i] < a->first[i + 1]) {
        tribo_cholesky_solve(&s->factor, 1, s->x);
    }
    return a->first[i] < a->first[i + 1];
}

/* to = factor K_ww^-1 a', a [..][without]. Returns 0 if out of memory. */
static int condense_respond(struct condensed *s, const struct matrix *a, double factor, struct matrix *to)
{
    struct triplets t = {0};
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = 0, end = solve_row(s, a, i) ? s->without : 0; k < end; k++) {
            condense_put(&t, k, i, factor * s->x[k]);
        }
    }
    return finish_triplets(&t, s->without, a->rows, to);
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
            put_row(&t, q, i, i);
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
            condense_put(&t, i, j, fabs(s->sum[j]) > ROUNDING * s->size[j] ? s->sum[j] : 0.0);
        }
        if (terms) {
            terms[i] = s->size[i];
        }
    }
    return finish_triplets(&t, q->rows, s->with, to);
}

/* Factorizes K_ww. Returns a status, TRIBO_ERR_INDEFINITE if a pivot is rounding. */
static int factorize_without(const struct model *m, struct condensed *s)
{
    size_t where = 0;
    double pivot = 0.0;
    int status = tribo_cholesky_create(&s->factor, &s->kww, &where, &pivot);
    for (size_t k = 0; !status && s->factor.root && k < s->without; k++) {
        where = k;
        pivot = s->factor.root[k] * s->factor.root[k];
        status = pivot <= ROUNDING * tribo_matrix_get(&s->kww, k, k) ? TRIBO_ERR_INDEFINITE : TRIBO_OK;
    }
    return status == TRIBO_ERR_INDEFINITE
               ? tribo_model_fail(m, status,
                                  "mass is not positive definite: degree of freedom %zu has none, and the stiffness does not "
                                  "hold it: pivot %g",
                                  s->dof[where], pivot)
           : status == TRIBO_ERR_SIZE ? tribo_model_too_large(m)
           : status                   ? tribo_model_no_memory(m)
                                      : TRIBO_OK;
}

/* Sets own = G_ii, and shared = G if an entry off the diagonal is more than rounding. Returns a status. */
static int find_compliance(const struct model *m, struct condensed *s)
{
    const size_t n = m->ncontact;
    memset(s->own, 0, n * sizeof *s->own);
    for (size_t i = 0; i < n; i++) {
        if (!solve_row(s, &s->touch, i)) {
            continue;
        }
        s->own[i] = tribo_matrix_row_dot(&s->touch, i, s->x);
        for (size_t k = 0; k < i; k++) {
            const double shared = tribo_matrix_row_dot(&s->touch, k, s->x);
            if (!s->shared && fabs(shared) > ROUNDING * sqrt(s->own[i] * s->own[k])) {
                s->shared = calloc(n * n, sizeof *s->shared);
                if (!s->shared) {
                    return tribo_model_no_memory(m);
                }
            }
            if (s->shared) {
                s->shared[i * n + k] = s->shared[k * n + i] = shared;
            }
        }
    }
    for (size_t i = 0; s->shared && i < n; i++) {
        s->shared[i * n + i] = s->own[i];
    }
    return TRIBO_OK;
}

/* Replaces the matrices of m by the matrices of q. direction = J of all contacts; m->direction = J with empty rows of compliant
 * contacts. Returns 0 if out of memory. */
static int replace_matrices(struct model *m, struct condensed *s, struct matrix *direction)
{
    struct matrix mass = {0}, damping = {0}, stiffness = {0}, rigid = {0}, half = {0}, other = {0};
    const int done = take_block(s, &m->mass, Q, Q, &mass) && (!m->damping.rows || take_block(s, &m->damping, Q, Q, &damping)) &&
                     condense_combine(s, &s->kqq, &s->kqw, NULL, s->terms, &half) && tribo_matrix_transpose(&other, &half) &&
                     tribo_matrix_sum(&stiffness, 0.5, &half, 0.5, &other) &&
                     condense_combine(s, &s->jq, &s->touch, NULL, NULL, direction) &&
                     condense_combine(s, &s->jq, &s->touch, s->own, NULL, &rigid);
    tribo_matrix_free(&half);
    tribo_matrix_free(&other);
    tribo_model_free(m);
    m->mass = mass;
    m->damping = damping;
    m->stiffness = stiffness;
    m->direction = rigid;
    m->terms = s->terms;
    m->ndof = s->with;
    return done;
}

/* Builds the system of q, with its compliance, and w as its expansion. Returns a status. */
static int build_without(struct model *m, struct condensed *s, int (*build_massive)(struct model *, tribo_system **),
                         tribo_system **sys)
{
    const size_t dofs = m->ndof;
    struct matrix direction = {0};
    size_t where = 0;
    int status = replace_matrices(m, s, &direction) ? build_massive(m, sys) : tribo_model_no_memory(m);
    if (!status) {
        for (size_t d = 0; d < dofs; d++) {
            s->place[d] += s->is[d] ? s->with : 0;
        }
        (*sys)->given = dofs - m->sliders;
        status = tribo_compliance_create(*sys, &direction, s->own, s->shared, &where);
        if (!status && !tribo_expansion_create(*sys, m->sliders, s->place, m->nmode ? NULL : s->terms, &s->follow, &s->give,
                                               &s->touch)) {
            status = TRIBO_ERR_MEMORY;
        }
        status = status == TRIBO_ERR_INDEFINITE
                     ? tribo_model_fail(
                           m, TRIBO_ERR_UNSUPPORTED,
                           "contact %zu moves degrees of freedom without mass only as other contacts do: give these mass", where)
                 : status ? tribo_model_no_memory(m)
                          : TRIBO_OK;
    }
    tribo_matrix_free(&direction);
    return status;
}

int tribo_model_condense(struct model *m, int (*build_massive)(struct model *, tribo_system **), tribo_system **sys)
{
    struct condensed s = {0};
    int status = condense_number(m, &s) ? TRIBO_OK : tribo_model_no_memory(m);
    if (!status && s.without > 0 && s.with > 0) {
        const struct matrix *k = &m->stiffness, *j = &m->direction;
        const int done = take_block(&s, k, Q, Q, &s.kqq) && take_block(&s, k, Q, W, &s.kqw) && take_block(&s, k, W, W, &s.kww) &&
                         take_block(&s, j, ALL, Q, &s.jq) && take_block(&s, j, ALL, W, &s.touch);
        status = done ? check_damping(m, &s) : tribo_model_no_memory(m);
        status = status ? status : factorize_without(m, &s);
        status = status ? status : find_compliance(m, &s);
        if (!status && (!condense_respond(&s, &s.kqw, -1.0, &s.follow) || !condense_respond(&s, &s.touch, 1.0, &s.give))) {
            status = tribo_model_no_memory(m);
        }
        status = status ? status : build_without(m, &s, build_massive, sys);
    } else {
        status = status ? status : build_massive(m, sys);
    }
    condensed_free(&s);
    return status;
}
