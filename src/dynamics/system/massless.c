/* Structures with degrees of freedom without mass, from the matrices of the caller. */
#include "massless.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "elastic.h"
#include "model.h"
#include "common/real.h"

/* A pivot that is not more than this part of the diagonal entry is rounding; and so is compliance that contacts share. */
#define ROUNDING (64.0 * DBL_EPSILON)

void tribo_massless_free(struct massless *m)
{
    tribo_matrix_free(&m->follow);
    tribo_matrix_free(&m->give);
    free(m->is);
    free(m->compliance);
    if (m->shared) {
        tribo_definite_free(m->shared);
    }
    free(m->shared);
    memset(m, 0, sizeof *m);
}

/* w->shared = C [ncontact][ncontact]. Returns the status of tribo_definite_create. */
static int create_shared(struct massless *w, size_t ncontact, const double *c, size_t *where)
{
    w->shared = calloc(1, sizeof *w->shared);
    return w->shared ? tribo_definite_create(w->shared, ncontact, c, where) : TRIBO_ERR_MEMORY;
}

int tribo_massless_copy(struct massless *to, const struct massless *from, size_t ndof, size_t ncontact)
{
    size_t where;
    int done = 1;
    if (from->count) {
        to->is = tribo_copy_of(from->is, ndof, 1, &done);
        to->compliance = tribo_copy_of(from->compliance, ncontact, sizeof *to->compliance, &done);
        done = done && tribo_matrix_copy(&to->follow, &from->follow) && tribo_matrix_copy(&to->give, &from->give);
        done = done && (!from->shared || create_shared(to, ncontact, from->shared->matrix, &where) == TRIBO_OK);
        to->count = from->count;
        to->stiffest = from->stiffest;
        to->own = from->own;
        to->added = from->added;
        to->tightest = from->tightest;
    }
    return done;
}

void tribo_massless_follow(const struct massless *m, double *x)
{
    for (size_t d = 0; d < m->follow.rows; d++) {
        x[d] = m->is[d] ? 0.0 : x[d];
    }
    if (m->count) {
        tribo_matrix_multiply_add(&m->follow, 1.0, x, x);
    }
}

/* ------------------------------------------------------------------------------------------------------ which they are */

static int row_is_empty(const struct matrix *a, size_t i)
{
    for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
        if (a->val[k] != 0.0) {
            return 0;
        }
    }
    return 1;
}

/* Who has no mass, if there is anybody. */
static int find_massless(const struct model *m, struct massless *w)
{
    for (size_t d = 0; d < m->ndof; d++) {
        w->count += (size_t)row_is_empty(&m->mass, d);
    }
    if (w->count == 0) {
        return 1;
    }
    w->is = malloc(m->ndof);
    w->compliance = calloc(m->ncontact + 1, sizeof *w->compliance);
    for (size_t d = 0; w->is && d < m->ndof; d++) {
        w->is[d] = (unsigned char)row_is_empty(&m->mass, d);
    }
    return w->is && w->compliance;
}

static int check_damping(const struct model *m, const struct massless *w)
{
    for (size_t i = 0; i < m->damping.rows; i++) {
        for (size_t k = m->damping.first[i]; k < m->damping.first[i + 1]; k++) {
            const size_t j = m->damping.col[k];
            if (m->damping.val[k] != 0.0 && (w->is[i] || w->is[j])) {
                return tribo_model_fail(
                    m, TRIBO_ERR_UNSUPPORTED,
                    "damping[%zu][%zu] = %g, but degree of freedom %zu has no mass: there only stiffness acts", i, j,
                    m->damping.val[k], w->is[i] ? i : j);
            }
        }
    }
    return TRIBO_OK;
}

/* --------------------------------------------------------------------------------------------------- how they give way */

/* Solutions of K_ww x = b, column by column, and where w stand among the degrees of freedom. */
struct statics {
    struct cholesky factor;
    size_t n, *dof, *place; /* [n]; [ndof] */
    double *x;              /* [n] */
};

static int no_hold(const struct model *m, size_t dof, double pivot)
{
    return tribo_model_fail(m, TRIBO_ERR_INDEFINITE,
                            "mass is not positive definite: degree of freedom %zu has none, and the stiffness does not hold it: "
                            "pivot %g",
                            dof, pivot);
}

/* Factors of K_ww, of which no pivot is rounding. */
static int massless_factorize(const struct model *m, struct statics *s, const struct matrix *kww)
{
    size_t where;
    double pivot;
    const int status = tribo_cholesky_create(&s->factor, kww, &where, &pivot);
    if (status == TRIBO_ERR_INDEFINITE) {
        return no_hold(m, s->dof[where], pivot);
    }
    for (size_t k = 0; !status && s->factor.root && k < s->n; k++) {
        const size_t at = tribo_cholesky_row(&s->factor, k);
        const double found = s->factor.root[k] * s->factor.root[k];
        if (found <= ROUNDING * tribo_matrix_get(kww, at, at)) {
            return no_hold(m, s->dof[at], found);
        }
    }
    return status == TRIBO_ERR_SIZE ? tribo_model_too_large(m) : status ? tribo_model_no_memory(m) : TRIBO_OK;
}

/* Room for the entries of a matrix, row i and column j. */
struct triplets {
    size_t count, *i, *j;
    double *v;
};

static int create_triplets(struct triplets *t, size_t room)
{
    *t = (struct triplets){0, malloc((room + 1) * sizeof *t->i), malloc((room + 1) * sizeof *t->j),
                           malloc((room + 1) * sizeof *t->v)};
    return t->i && t->j && t->v;
}

static void free_triplets(struct triplets *t)
{
    free(t->i);
    free(t->j);
    free(t->v);
}

static void massless_put(struct triplets *t, size_t i, size_t j, double v)
{
    if (v != 0.0) {
        t->i[t->count] = i;
        t->j[t->count] = j;
        t->v[t->count++] = v;
    }
}

static int begin_statics(const struct model *m, const struct massless *w, struct statics *s)
{
    const struct matrix *k = &m->stiffness;
    struct triplets t = {0};
    struct matrix kww = {0};
    s->dof = malloc((w->count + 1) * sizeof *s->dof);
    s->place = malloc(m->ndof * sizeof *s->place);
    s->x = malloc((w->count + 1) * sizeof *s->x);
    int done = s->dof && s->place && s->x && create_triplets(&t, k->first[k->rows]);
    for (size_t d = 0; done && d < m->ndof; d++) {
        s->place[d] = s->n;
        if (w->is[d]) {
            s->dof[s->n++] = d;
        }
    }
    for (size_t a = 0; done && a < s->n; a++) {
        for (size_t e = k->first[s->dof[a]]; e < k->first[s->dof[a] + 1]; e++) {
            if (w->is[k->col[e]]) {
                massless_put(&t, a, s->place[k->col[e]], k->val[e]);
            }
        }
    }
    done = done && tribo_matrix_from_triplets(&kww, s->n, s->n, t.count, t.i, t.j, t.v);
    const int status = done ? massless_factorize(m, s, &kww) : tribo_model_no_memory(m);
    tribo_matrix_free(&kww);
    free_triplets(&t);
    return status;
}

/* x = K_ww^-1 times the entries in w of row i of a. 0 if it has none. */
static int solve_row(const struct massless *w, struct statics *s, const struct matrix *a, size_t i)
{
    int any = 0;
    memset(s->x, 0, s->n * sizeof *s->x);
    for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
        if (w->is[a->col[e]]) {
            s->x[s->place[a->col[e]]] = a->val[e];
            any |= a->val[e] != 0.0;
        }
    }
    if (any) {
        tribo_cholesky_solve(&s->factor, 1, s->x);
    }
    return any;
}

/* Rows of a that touch w, of massive degrees of freedom or of contacts. */
static size_t touching(const struct massless *w, const struct matrix *a, int massive_only)
{
    size_t count = 0;
    for (size_t i = 0; i < a->rows; i++) {
        int any = 0;
        for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
            any |= w->is[a->col[e]];
        }
        count += any && !(massive_only && w->is[i]);
    }
    return count;
}

/* to [ndof][rows of a] = factor K_ww^-1 (columns of a')_w. 0 if out of memory. */
static int massless_respond(const struct model *m, const struct massless *w, struct statics *s, const struct matrix *a,
                            double factor, struct matrix *to)
{
    const int of_stiffness = a == &m->stiffness;
    struct triplets t;
    int done = create_triplets(&t, touching(w, a, of_stiffness) * s->n);
    for (size_t i = 0; done && i < a->rows; i++) {
        if (!(of_stiffness && w->is[i]) && solve_row(w, s, a, i)) {
            for (size_t k = 0; k < s->n; k++) {
                massless_put(&t, s->dof[k], i, factor * s->x[k]);
            }
        }
    }
    done = done && tribo_matrix_from_triplets(to, m->ndof, a->rows, t.count, t.i, t.j, t.v);
    free_triplets(&t);
    return done;
}

/* By how much contact i gives way to the forces that x is the response to. */
static double way_of(const struct massless *w, const struct statics *s, const struct matrix *j, size_t i)
{
    double way = 0.0;
    for (size_t e = j->first[i]; e < j->first[i + 1]; e++) {
        way += w->is[j->col[e]] ? j->val[e] * s->x[s->place[j->col[e]]] : 0.0;
    }
    return way;
}

/* A dense C is shared. Returns a status. */
static int share_compliance(const struct model *m, struct massless *w, const double *c)
{
    size_t where = 0;
    const int status = create_shared(w, m->ncontact, c, &where);
    return status == TRIBO_ERR_INDEFINITE
               ? tribo_model_fail(m, TRIBO_ERR_UNSUPPORTED,
                                  "contact %zu moves degrees of freedom without mass only as other contacts do: give these mass",
                                  where)
           : status ? tribo_model_no_memory(m)
                    : TRIBO_OK;
}

/* C, which is diagonal if entries beside the diagonal are rounding. */
static int find_compliance(const struct model *m, struct massless *w, struct statics *s)
{
    const struct matrix *j = &m->direction;
    const size_t n = m->ncontact;
    double *c = NULL;
    int status = TRIBO_OK;
    for (size_t i = 0; !status && i < n; i++) {
        if (!solve_row(w, s, j, i)) {
            continue;
        }
        w->compliance[i] = way_of(w, s, j, i);
        for (size_t k = 0; !status && k < i; k++) {
            const double shared = way_of(w, s, j, k);
            if (fabs(shared) > ROUNDING * sqrt(w->compliance[i] * w->compliance[k])) {
                c = c ? c : calloc(n * n, sizeof *c);
                status = c ? TRIBO_OK : tribo_model_no_memory(m);
            }
            if (c) {
                c[i * n + k] = c[k * n + i] = shared;
            }
        }
    }
    for (size_t i = 0; c && i < n; i++) {
        c[i * n + i] = w->compliance[i];
    }
    status = status || !c ? status : share_compliance(m, w, c);
    free(c);
    return status;
}

static int massless_find_statics(const struct model *m, struct massless *w)
{
    struct statics s = {.n = 0};
    int status = begin_statics(m, w, &s);
    status = status ? status : find_compliance(m, w, &s);
    if (!status && (!massless_respond(m, w, &s, &m->stiffness, -1.0, &w->follow) ||
                    !massless_respond(m, w, &s, &m->direction, 1.0, &w->give))) {
        status = tribo_model_no_memory(m);
    }
    tribo_cholesky_free(&s.factor);
    free(s.dof);
    free(s.place);
    free(s.x);
    return status;
}

/* ------------------------------------------------------------------------------------------------- the system of the others */

/* to = a without rows, or columns, of w. */
static int without(const struct massless *w, const struct matrix *a, int rows, struct matrix *to)
{
    struct triplets t;
    int done = create_triplets(&t, a->first[a->rows]);
    for (size_t i = 0; done && i < a->rows; i++) {
        for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
            if (!w->is[rows ? i : a->col[e]]) {
                massless_put(&t, i, a->col[e], a->val[e]);
            }
        }
    }
    done = done && tribo_matrix_from_triplets(to, a->rows, a->cols, t.count, t.i, t.j, t.v);
    free_triplets(&t);
    return done;
}

/* to = mass with ones for w. */
static int fill_mass(const struct massless *w, const struct matrix *mass, struct matrix *to)
{
    const size_t n = mass->rows;
    double *one = malloc(n * sizeof *one);
    struct matrix ones = {0};
    for (size_t d = 0; one && d < n; d++) {
        one[d] = w->is[d] ? 1.0 : 0.0;
    }
    const int done = one && tribo_matrix_diagonal(&ones, n, one) && tribo_matrix_sum(to, 1.0, mass, 1.0, &ones);
    tribo_matrix_free(&ones);
    free(one);
    return done;
}

static void massless_exchange(struct matrix *a, struct matrix *b)
{
    const struct matrix c = *a;
    *a = *b;
    *b = c;
}

/* Contact i adds so much to omega^2. */
static void note_added(struct massless *w, size_t i, double added)
{
    w->tightest = added > w->added ? i : w->tightest;
    w->added = greater(w->added, added);
}

/* w->own, less what is rounding; added, and tightest. force [ncontact], as large as it can be beside q = 1. */
static void find_tightest(const tribo_system *s, struct massless *w, const double *force)
{
    const struct matrix *k = &s->stiffness, *b = &s->response, *give = &w->give;
    for (size_t d = 0; d < s->ndof; d++) {
        double own = 0.0, size = 0.0;
        for (size_t e = k->first[d]; !w->is[d] && e < k->first[d + 1]; e++) {
            const size_t j = k->col[e];
            const double part = k->val[e] * (j == d ? 1.0 : w->is[j] ? tribo_matrix_get(&w->follow, j, d) : 0.0);
            own += part;
            size += fabs(part);
            for (size_t g = give->first[j]; g < give->first[j + 1]; g++) {
                note_added(w, give->col[g], fabs(k->val[e] * give->val[g]) * force[give->col[g]]);
            }
        }
        w->own = own > ROUNDING * size ? greater(w->own, own) : w->own;
        for (size_t e = b->first[d]; e < b->first[d + 1]; e++) {
            note_added(w, b->col[e], fabs(b->val[e]) * force[b->col[e]]);
        }
    }
}

/* The largest row sum of what accelerates by places: those of w, and forces of elastic contacts, as large as they can be beside
 * q = 1. 0 if out of memory. */
static int find_stiffest(tribo_system *s)
{
    const size_t n = s->ndof, c = s->ncontact;
    struct massless *w = &s->massless;
    double *q = calloc(3 * n + c + 1, sizeof *q);
    if (!q) {
        return 0;
    }
    double *places = q + n, *rate = q + 2 * n, *force = q + 3 * n;
    for (size_t d = 0; d < n; d++) {
        places[d] = q[d] = w->is[d] ? 0.0 : 1.0;
    }
    tribo_matrix_add_sizes(&w->follow, q, places);
    tribo_matrix_add_sizes(&s->direction, places, force);
    tribo_elastic_sizes(s, force);
    find_tightest(s, w, force);
    tribo_matrix_add_sizes(&w->give, force, places);
    tribo_matrix_add_sizes(&s->stiffness, places, rate);
    tribo_matrix_add_sizes(&s->response, force, rate);
    w->stiffest = tribo_largest(rate, n);
    free(q);
    return 1;
}

/* A system that accelerates w by nothing; then it is told all of mass, stiffness and direction, and how w follows. */
static int massless_build(struct model *m, struct massless *w, int (*build_massive)(struct model *, tribo_system **),
                          tribo_system **sys)
{
    struct matrix mass = {0}, stiffness = {0}, direction = {0};
    const int done =
        fill_mass(w, &m->mass, &mass) && without(w, &m->stiffness, 1, &stiffness) && without(w, &m->direction, 0, &direction);
    massless_exchange(&m->mass, &mass);
    massless_exchange(&m->stiffness, &stiffness);
    massless_exchange(&m->direction, &direction);
    int status = done ? build_massive(m, sys) : tribo_model_no_memory(m);
    if (!status) {
        massless_exchange(&(*sys)->mass, &mass);
        massless_exchange(&(*sys)->elastic, &stiffness);
        massless_exchange(&(*sys)->direction, &direction);
        (*sys)->massless = *w;
        *w = (struct massless){0};
        status = find_stiffest(*sys) ? TRIBO_OK : tribo_model_no_memory(m);
    }
    tribo_matrix_free(&mass);
    tribo_matrix_free(&stiffness);
    tribo_matrix_free(&direction);
    return status;
}

int tribo_model_build_massless(struct model *m, int (*build_massive)(struct model *, tribo_system **), tribo_system **sys)
{
    struct massless w = {0};
    int status = find_massless(m, &w) ? TRIBO_OK : tribo_model_no_memory(m);
    if (status || w.count == 0 || w.count == m->ndof) {
        status = status ? status : build_massive(m, sys);
    } else {
        /* Without accelerations nobody knows what follows statically. */
        status = m->ndof <= DENSE_MOST || tribo_matrix_is_diagonal(&m->mass)
                     ? TRIBO_OK
                     : tribo_model_fail(
                           m, TRIBO_ERR_UNSUPPORTED,
                           "%zu degree%s of freedom have no mass: with a mass matrix that is not diagonal there may be %d "
                           "in all, not %zu degree%s of freedom",
                           w.count, plural(w.count), DENSE_MOST, m->ndof, plural(m->ndof));
        status = status ? status : check_damping(m, &w);
        status = status ? status : massless_find_statics(m, &w);
        status = status ? status : massless_build(m, &w, build_massive, sys);
    }
    tribo_massless_free(&w);
    return status;
}
