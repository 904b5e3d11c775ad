/* SPDX-License-Identifier: BSD-3-Clause */
#include "lanczos.h"
#include "common/layout.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tribo/tribo.h"

/* Number of vectors in a block. */
#define BLOCK 6

/* A mode is found if its residual is at most this part of theta. */
#define FOUND 1e-11

/* A vector depends on the basis if the rest orthogonal to the basis is at most this part of the vector: rounding. */
#define NOTHING 1e-13

/* If the rest of a vector after a subtraction is less than this part, rounding makes it not orthogonal: repeat. */
#define LITTLE 0.1

/* Modes are counted in a gap between two theta, relative, larger than this. */
#define GAP 1e-3

/* The gap is searched up to this number of modes after the last wanted one. */
#define FURTHER 30

/* Modes have one frequency if their omega^2 + shift differ by no more than this part. */
#define ONE 1e-5

#define MOST_BLOCKS 2000
#define MOST_SEARCHES 5

struct lanczos {
    const struct matrix *mass;
    const struct cholesky *shifted;
    double shift;
    size_t n, room, size;      /* length of a vector; most vectors in the basis; vectors in the basis */
    size_t pending;            /* number of newest basis vectors q with w = shift (K + shift M)^-1 M q, orthogonal to the basis */
    int complete;              /* 1: no vector is independent of the basis */
    double *q;                 /* [room][n] basis */
    double *w, *mw;            /* [BLOCK][n]; [BLOCK][n] M W */
    double norm[BLOCK];        /* norms in M of w before orthogonalization */
    double *c, *terms;         /* [BLOCK][room], [n] workspace */
    double *h;                 /* [room][room] Q'M shift (K + shift M)^-1 M Q */
    double *theta;             /* [size] eigenvalues of h, shift/(omega^2 + shift), descending */
    double *s;                 /* [size][size] eigenvectors of h, in rows */
    double gram[BLOCK][BLOCK]; /* W'M W */
    uint64_t seed;
};

/* -------------------------------------------------------------------------------------------------------------- the basis */

void tribo_scatter(uint64_t *seed, size_t n, double *x)
{
    for (size_t i = 0; i < n; i++) {
        *seed = *seed * 6364136223846793005u + 1442695040888963407u;
        const double part = (double)(*seed >> 40) / 16777216.0;
        x[i] = part < 0.5 ? part - 1.0 : part;
    }
}

/* Returns the norm in M of vector j of w. */
static double norm_of(const struct lanczos *l, size_t j)
{
    const double square = tribo_dot(l->w + j * l->n, l->mw + j * l->n, l->n);
    return square > 0.0 ? sqrt(square) : 0.0;
}

void tribo_separate(const struct matrix *mass, size_t size, const double *q, size_t count, double *w, double *mw, size_t stride,
                    double *c)
{
    const size_t n = mass->cols;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < size; i++) {
            for (size_t k = 0; k < count; k++) {
                const double part = tribo_dot(q + i * n, mw + k * n, n);
                tribo_add(w + k * n, -part, q + i * n, n);
                if (c) {
                    c[k * stride + i] += part;
                }
            }
        }
        tribo_matrix_multiply_all(mass, count, w, mw);
    }
}

/* Makes vectors j .. j + count - 1 of w orthogonal to the basis. Sets c [count][room] = the coefficients of the parts removed,
 * norm, and mw = M W. */
static void lanczos_separate(struct lanczos *l, size_t j, size_t count)
{
    double *w = l->w + j * l->n, *mw = l->mw + j * l->n;
    memset(l->c, 0, count * l->room * sizeof *l->c);
    tribo_matrix_multiply_all(l->mass, count, w, mw);
    for (size_t k = j; k < j + count; k++) {
        l->norm[k] = norm_of(l, k);
    }
    tribo_separate(l->mass, l->size, l->q, count, w, mw, l->room, l->c);
}

/* Sets vectors j .. j + count - 1 of w = (K + shift M)^-1 (random forces), orthogonal to the basis. Returns 0 if out of memory,
 * never for count = 1. */
static int draw(struct lanczos *l, size_t j, size_t count)
{
    for (size_t k = j; k < j + count; k++) {
        tribo_scatter(&l->seed, l->n, l->w + k * l->n);
    }
    const int done = tribo_cholesky_solve(l->shifted, count, l->w + j * l->n);
    lanczos_separate(l, j, count);
    return done;
}

/* Appends vector j of w, normalized, to the basis, or a random vector if vector j depends on the basis. The last j vectors of the
 * basis come from w: vector j becomes orthogonal to these; if little remains, to the whole basis again. Sets complete = 1 if no
 * vector is independent. */
static void lanczos_append(struct lanczos *l, size_t j)
{
    const size_t n = l->n;
    double *w = l->w + j * n, *mw = l->mw + j * n;
    for (int attempt = 0; attempt < 3 && l->size < n; attempt++) {
        const double whole = l->norm[j], before = norm_of(l, j), *q = l->q + (l->size - j) * n;
        for (size_t i = 0; i < j; i++) {
            const double part = tribo_dot(q + i * n, mw, n);
            tribo_add(w, -part, q + i * n, n);
            tribo_add(mw, -part, l->mw + i * n, n);
        }
        if (!(norm_of(l, j) > LITTLE * before)) {
            lanczos_separate(l, j, 1);
        }
        const double rest = norm_of(l, j);
        if (rest > NOTHING * whole) {
            for (size_t i = 0; i < n; i++) {
                l->q[l->size * n + i] = w[i] / rest;
                mw[i] /= rest;
            }
            l->size++;
            return;
        }
        draw(l, j, 1);
    }
    l->complete = 1;
}

/* Appends one block to the basis, and updates w, h and gram, and theta and s, the modes of h. Returns 0 if out of memory. */
static int lanczos_extend(struct lanczos *l)
{
    const size_t first = l->size;
    for (size_t j = 0; j < BLOCK && !l->complete; j++) {
        lanczos_append(l, j);
    }
    l->pending = l->size - first;
    memset(l->w, 0, l->pending * l->n * sizeof *l->w);
    tribo_add(l->w, l->shift, l->mw, l->pending * l->n);
    if (l->pending && !tribo_cholesky_solve(l->shifted, l->pending, l->w)) {
        return 0;
    }
    lanczos_separate(l, 0, l->pending);
    for (size_t j = 0; j < l->pending; j++) {
        for (size_t i = 0; i < l->size; i++) {
            l->h[i * l->room + first + j] = l->h[(first + j) * l->room + i] = l->c[j * l->room + i];
        }
        for (size_t i = 0; i < l->pending; i++) {
            l->gram[j][i] = tribo_dot(l->w + j * l->n, l->mw + i * l->n, l->n);
        }
    }
    const size_t m = l->size;
    for (size_t i = 0; i < m * m; i++) {
        l->s[i] = -l->h[i / m * l->room + i % m];
    }
    if (tribo_symmetric_eigen(l->s, m, l->theta)) {
        return 0;
    }
    for (size_t k = 0; k < m; k++) {
        l->theta[k] = -l->theta[k];
    }
    return 1;
}

/* ------------------------------------------------------------------------------------------------------ modes of the basis */

/* Returns the number of modes x for which the norm in M of shift (K + shift M)^-1 M x - theta x is at most FOUND theta. */
static size_t count_found(const struct lanczos *l)
{
    for (size_t k = 0; k < l->size; k++) {
        const double *s = l->s + k * l->size + l->size - l->pending;
        double square = 0.0;
        for (size_t i = 0; i < l->pending && !l->complete; i++) {
            for (size_t j = 0; j < l->pending; j++) {
                square += s[i] * l->gram[i][j] * s[j];
            }
        }
        if (!(l->theta[k] > 0.0 && (square <= 0.0 || sqrt(square) <= FOUND * l->theta[k]))) {
            return k;
        }
    }
    return l->size;
}

/* Replaces the basis by the first `keep` combinations s. */
static void compress(struct lanczos *l, size_t keep)
{
    const size_t m = l->size;
    for (size_t d = 0; d < l->n; d++) {
        for (size_t i = 0; i < m; i++) {
            l->c[i] = l->q[i * l->n + d];
        }
        for (size_t k = 0; k < keep; k++) {
            l->q[k * l->n + d] = tribo_dot(l->s + k * m, l->c, m);
        }
    }
    for (size_t i = 0; i < keep; i++) {
        memset(l->h + i * l->room, 0, keep * sizeof *l->h);
        l->h[i * l->room + i] = l->theta[i];
    }
    l->size = keep;
    l->pending = 0;
}

/* Replaces the basis by the first `keep` combinations s, or fewer: room for two blocks remains. */
static void lanczos_make_room(struct lanczos *l, size_t keep)
{
    compress(l, l->room == l->n || keep < l->room - 2 * BLOCK ? keep : l->room - 2 * BLOCK);
}

/* Extends the basis until `target` modes are found or the basis is complete. Returns a status. */
static int converge(struct lanczos *l, size_t target)
{
    for (size_t blocks = 0; blocks < MOST_BLOCKS; blocks++) {
        if (l->size + BLOCK > l->room && l->room < l->n) {
            const size_t found = count_found(l);
            lanczos_make_room(l, found + (l->size - found) / 2);
        }
        if (!lanczos_extend(l)) {
            return TRIBO_ERR_MEMORY;
        }
        if (l->complete || count_found(l) >= target) {
            return TRIBO_OK;
        }
    }
    return TRIBO_ERR_NO_CONVERGENCE;
}

/* --------------------------------------------------------------------------------------------------------- completeness */

/* Returns a theta above all modes that have the frequency of mode wanted - 1: the frequency may have more modes than there is
 * room for, and any combination of these is a mode. */
static double above_frequency(const struct lanczos *l, size_t wanted)
{
    size_t first = wanted - 1;
    while (first > 0 && l->theta[first - 1] - l->theta[wanted - 1] <= ONE * l->theta[wanted - 1]) {
        first--;
    }
    const double above = (1.0 + ONE) * l->theta[first];
    return first > 0 ? lesser(above, sqrt(l->theta[first - 1] * l->theta[first])) : above;
}

/* Sets *between = a theta in the first gap after mode wanted - 1; if there is none, below all theta, or, if the basis is not
 * complete, above the frequency of mode wanted - 1. Finds more modes if needed. Returns a status. */
static int find_gap(struct lanczos *l, size_t wanted, double *between)
{
    for (size_t p = wanted; l->complete ? p < l->size : p <= wanted + FURTHER; p++) {
        const int status = count_found(l) < p || p == l->size ? converge(l, p) : TRIBO_OK;
        if (status) {
            return status;
        }
        const double next = p < l->size ? greater(l->theta[p], 0.0) : 0.0;
        if (l->theta[p - 1] - next > GAP * l->theta[p - 1]) {
            *between = sqrt(l->theta[p - 1] * greater(next, 0.25 * l->theta[p - 1]));
            return TRIBO_OK;
        }
    }
    *between = l->complete ? 0.5 * l->theta[l->size - 1] : above_frequency(l, wanted);
    return TRIBO_OK;
}

/* Sets found->below = the number of modes above theta, found->above and found->growth. Returns a status. */
static int count_modes(const struct lanczos *l, const struct matrix *k, double theta, struct low_modes *found)
{
    const struct matrix *m = l->mass;
    const double sigma = l->shift / theta - l->shift;
    struct inertia inertia = {0, 0.0};
    struct matrix shifted;
    int status = tribo_matrix_sum(&shifted, 1.0, k, -sigma, m) ? TRIBO_OK : TRIBO_ERR_MEMORY;
    if (!status) {
        for (size_t i = 0; i < k->rows; i++) {
            l->terms[i] = tribo_matrix_get(k, i, i) + fabs(sigma) * tribo_matrix_get(m, i, i);
        }
        status = tribo_cholmod->inertia(l->shifted->sparse, &shifted, &shifted, l->terms, &inertia);
        tribo_matrix_free(&shifted);
    }
    found->above = sigma;
    found->below = inertia.negative;
    found->growth = inertia.growth;
    return status == TRIBO_ERR_INDEFINITE ? TRIBO_ERR_NO_CONVERGENCE : status;
}

/* ---------------------------------------------------------------------------------------------------------------- calls */

/* Sets found->phi = shift/theta (K + shift M)^-1 M q, q the first `count` modes: removes parts without mass. Returns a status. */
static int lanczos_take(struct lanczos *l, size_t count, struct low_modes *found)
{
    const size_t n = l->n;
    int done = 1;
    compress(l, count);
    found->count = count;
    found->phi = malloc(count * n * sizeof *found->phi);
    if (!found->phi) {
        return TRIBO_ERR_MEMORY;
    }
    for (size_t k = 0; done && k < count; k += BLOCK) {
        const size_t some = count - k < BLOCK ? count - k : BLOCK;
        tribo_matrix_multiply_all(l->mass, some, l->q + k * n, found->phi + k * n);
        done = tribo_cholesky_solve(l->shifted, some, found->phi + k * n);
    }
    for (size_t k = 0; k < count; k++) {
        for (size_t i = 0; i < n; i++) {
            found->phi[k * n + i] *= l->shift / l->theta[k];
        }
    }
    return done ? TRIBO_OK : TRIBO_ERR_MEMORY;
}

/* Finds modes until those above a theta are as many as are counted. If the modes of the frequency of mode wanted - 1 do not fit,
 * theta is above this frequency. Returns a status. */
static int lanczos_find(struct lanczos *l, const struct matrix *k, size_t wanted, struct low_modes *found)
{
    size_t target = wanted;
    for (size_t search = 0; search < MOST_SEARCHES + wanted / BLOCK; search++) {
        double theta = 0.0;
        int status = TRIBO_OK;
        size_t above = 0;
        if (search == 0 || count_found(l) >= target) { /* restarts with the modes found and random vectors orthogonal to these */
            lanczos_make_room(l, count_found(l));
            status = draw(l, 0, BLOCK) ? TRIBO_OK : TRIBO_ERR_MEMORY;
        }
        status = status ? status : converge(l, target);
        if (!status && count_found(l) < wanted) {
            found->count = count_found(l);
            return TRIBO_ERR_SIZE;
        }
        status = status ? status : find_gap(l, wanted, &theta);
        status = status ? status : count_modes(l, k, theta, found);
        const int fits = found->below + 2 * BLOCK <= l->room || l->room == l->n;
        if (!status && !fits) {
            theta = above_frequency(l, wanted);
            status = count_modes(l, k, theta, found);
        }
        while (above < count_found(l) && l->theta[above] > theta) {
            above++;
        }
        if (status || above == found->below) {
            return status ? status : lanczos_take(l, found->below > wanted ? found->below : wanted, found);
        }
        target = fits && found->below > wanted ? found->below : wanted;
    }
    return TRIBO_ERR_NO_CONVERGENCE;
}

int tribo_low_modes(const struct matrix *k, const struct matrix *m, double shift, const struct cholesky *shifted, size_t wanted,
                    struct low_modes *found)
{
    const size_t n = k->rows, most = 2 * wanted + 20 * BLOCK, room = most < n ? most : n;
    struct lanczos l = {.mass = m, .shifted = shifted, .shift = shift, .n = n, .room = room, .seed = 1};
    memset(found, 0, sizeof *found);
    if (!ALLOCATE(ARRAY(l.q, room * n), ARRAY(l.w, BLOCK * n), ARRAY(l.mw, BLOCK * n), ARRAY(l.c, BLOCK * room),
                  ARRAY(l.terms, n), ARRAY(l.theta, room), ARRAY(l.h, room * room), ARRAY(l.s, room * room))) {
        return TRIBO_ERR_MEMORY;
    }
    const int status = lanczos_find(&l, k, wanted, found);
    free(l.q);
    return status;
}
