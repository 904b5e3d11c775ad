#include "lanczos.h"
#include "common/real.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "tribo/tribo.h"

/* Vectors that are carried on together. */
#define BLOCK 6

/* A mode is found when its residual is this part of it. */
#define FOUND 1e-11

/* Of a vector that is in the space of others, rounding leaves no more than this part. */
#define NOTHING 1e-13

/* What remains of a vector beside others is orthogonal to them to rounding, unless it is less than this part. */
#define LITTLE 0.1

/* Modes are counted at a place that is this far, relative, from the next ones. */
#define GAP 1e-3

/* Modes beyond the last wanted one among which that place is looked for. */
#define FURTHER 30

/* Modes whose omega^2 + shift is the same to this part have one frequency. */
#define ONE 1e-5

#define MOST_BLOCKS 2000
#define MOST_SEARCHES 5

struct lanczos {
    const struct matrix *mass;
    const struct cholesky *shifted;
    double shift;
    size_t n, room, size;      /* of vectors: room for so many, and so many there are */
    size_t pending;            /* the last ones, of which w holds what shift (K + shift M)^-1 M makes of them beyond all */
    int complete;              /* there is nothing beyond */
    double *q;                 /* [room][n] */
    double *w, *mw;            /* [BLOCK][n]; [BLOCK][n] M W */
    double norm[BLOCK];        /* of those of w before anything was taken out of them */
    double *c;                 /* [BLOCK][room] workspace */
    double *h;                 /* [room][room] Q'M shift (K + shift M)^-1 M Q */
    double *theta;             /* [size] its eigenvalues shift/(omega^2 + shift), the largest first */
    double *s, *work;          /* [size][size] its eigenvectors, one a row; [room][room] workspace */
    double gram[BLOCK][BLOCK]; /* W'M W */
    uint64_t seed;
};

/* -------------------------------------------------------------------------------------------------------------- the basis */

static void lanczos_scatter(struct lanczos *l, double *x)
{
    for (size_t i = 0; i < l->n; i++) {
        l->seed = l->seed * 6364136223846793005u + 1442695040888963407u;
        x[i] = (double)(l->seed >> 40) / 8388608.0 - 1.0;
    }
}

/* Norm in M of the j-th vector of w. */
static double norm_of(const struct lanczos *l, size_t j)
{
    const double square = tribo_dot(l->w + j * l->n, l->mw + j * l->n, l->n);
    return square > 0.0 ? sqrt(square) : 0.0;
}

/* Takes out of the vectors of w, from the j-th on, what they have of the basis: twice, since the first time leaves rounding. c
 * [count][room] gets how much that was; mw is up to date then. */
static void separate(struct lanczos *l, size_t j, size_t count)
{
    const size_t n = l->n;
    double *w = l->w + j * n, *mw = l->mw + j * n;
    memset(l->c, 0, count * l->room * sizeof *l->c);
    tribo_matrix_multiply_all(l->mass, count, w, mw);
    for (size_t k = j; k < j + count; k++) {
        l->norm[k] = norm_of(l, k);
    }
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < l->size; i++) {
            const double *q = l->q + i * n;
            for (size_t k = 0; k < count; k++) {
                const double part = tribo_dot(q, mw + k * n, n);
                tribo_add(w + k * n, -part, q, n);
                l->c[k * l->room + i] += part;
            }
        }
        tribo_matrix_multiply_all(l->mass, count, w, mw);
    }
}

/* The j-th vector of w, and those that follow, become any that forces make, with nothing of the basis. 0 if out of memory, which
 * does not happen to a single one. */
static int draw(struct lanczos *l, size_t j, size_t count)
{
    for (size_t k = j; k < j + count; k++) {
        lanczos_scatter(l, l->w + k * l->n);
    }
    const int done = tribo_cholesky_solve(l->shifted, count, l->w + j * l->n);
    separate(l, j, count);
    return done;
}

/* Takes out of the j-th vector of w what it has of those before it, which are the last of the basis; if little remains, of all
 * others once more. Returns the norm of the rest. */
static double separate_from_block(struct lanczos *l, size_t j)
{
    const size_t n = l->n;
    const double whole = l->norm[j], before = norm_of(l, j), *q = l->q + (l->size - j) * n;
    for (size_t i = 0; i < j; i++) {
        const double part = tribo_dot(q + i * n, l->mw + j * n, n);
        tribo_add(l->w + j * n, -part, q + i * n, n);
        tribo_add(l->mw + j * n, -part, l->mw + i * n, n);
    }
    if (!(norm_of(l, j) > LITTLE * before)) {
        separate(l, j, 1);
    }
    const double rest = norm_of(l, j);
    return rest > NOTHING * whole ? rest : 0.0;
}

/* Appends the direction of the j-th vector of w to the basis, which ends with those before it, or another if it has none of its
 * own; if there is none at all, the basis is complete. */
static void lanczos_append(struct lanczos *l, size_t j)
{
    for (int attempt = 0; attempt < 3 && l->size < l->n; attempt++) {
        const double rest = separate_from_block(l, j);
        if (rest > 0.0) {
            for (size_t i = 0; i < l->n; i++) {
                l->q[l->size * l->n + i] = l->w[j * l->n + i] / rest;
                l->mw[j * l->n + i] /= rest;
            }
            l->size++;
            return;
        }
        draw(l, j, 1);
    }
    l->complete = 1;
}

static void find_gram(struct lanczos *l)
{
    for (size_t i = 0; i < l->pending; i++) {
        for (size_t j = 0; j < l->pending; j++) {
            l->gram[i][j] = tribo_dot(l->w + i * l->n, l->mw + j * l->n, l->n);
        }
    }
}

/* One block more. 0 if out of memory. */
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
    separate(l, 0, l->pending);
    for (size_t j = 0; j < l->pending; j++) {
        for (size_t i = 0; i < l->size; i++) {
            l->h[i * l->room + first + j] = l->h[(first + j) * l->room + i] = l->c[j * l->room + i];
        }
    }
    find_gram(l);
    return 1;
}

/* ------------------------------------------------------------------------------------------------------- what is known of
 * modes */

/* theta and s. 0 if out of memory. */
static int project(struct lanczos *l)
{
    const size_t m = l->size;
    for (size_t i = 0; i < m; i++) {
        for (size_t j = 0; j < m; j++) {
            l->work[i * m + j] = -l->h[i * l->room + j];
        }
    }
    if (tribo_symmetric_eigen(l->work, m, l->theta, l->s)) {
        return 0;
    }
    tribo_transpose(m, m, l->s, l->work);
    memcpy(l->s, l->work, m * m * sizeof *l->s);
    for (size_t k = 0; k < m; k++) {
        l->theta[k] = -l->theta[k];
    }
    return 1;
}

/* Norm of shift (K + shift M)^-1 M x - theta x for the k-th. */
static double residual(const struct lanczos *l, size_t k)
{
    const double *s = l->s + k * l->size + l->size - l->pending;
    double sum = 0.0;
    for (size_t i = 0; i < l->pending; i++) {
        for (size_t j = 0; j < l->pending; j++) {
            sum += s[i] * l->gram[i][j] * s[j];
        }
    }
    return sum > 0.0 ? sqrt(sum) : 0.0;
}

static size_t count_found(const struct lanczos *l)
{
    size_t k = 0;
    while (k < l->size && l->theta[k] > 0.0 && (l->complete || residual(l, k) <= FOUND * l->theta[k])) {
        k++;
    }
    return k;
}

/* The best combinations become the basis, as many as are kept: in strips, so that it takes no memory. */
static void compress(struct lanczos *l, size_t keep)
{
    enum { STRIP = 32 };
    const size_t m = l->size;
    for (size_t at = 0; at < l->n; at += STRIP) {
        const size_t width = l->n - at < STRIP ? l->n - at : STRIP;
        for (size_t j = 0; j < width; j++) {
            for (size_t i = 0; i < m; i++) {
                l->c[i] = l->q[i * l->n + at + j];
            }
            for (size_t k = 0; k < keep; k++) {
                l->q[k * l->n + at + j] = tribo_dot(l->s + k * m, l->c, m);
            }
        }
    }
    for (size_t i = 0; i < keep; i++) {
        memset(l->h + i * l->room, 0, keep * sizeof *l->h);
        l->h[i * l->room + i] = l->theta[i];
    }
    l->size = keep;
    l->pending = 0;
}

/* The best become the basis, keep of them or as many as leave room for two blocks more. */
static void lanczos_make_room(struct lanczos *l, size_t keep)
{
    compress(l, l->room == l->n || keep < l->room - 2 * BLOCK ? keep : l->room - 2 * BLOCK);
}

/* Goes on until target modes are found, or all that there are. */
static int converge(struct lanczos *l, size_t target)
{
    for (size_t blocks = 0; blocks < MOST_BLOCKS; blocks++) {
        if (l->size + BLOCK > l->room && l->room < l->n) {
            const size_t found = count_found(l);
            lanczos_make_room(l, found + (l->size - found) / 2);
        }
        if (!lanczos_extend(l) || !project(l)) {
            return TRIBO_ERR_MEMORY;
        }
        if (l->complete || count_found(l) >= target) {
            return TRIBO_OK;
        }
    }
    return TRIBO_ERR_NO_CONVERGENCE;
}

/* The modes found stay; the search goes on from vectors that have nothing to do with them. */
static int lanczos_start_anew(struct lanczos *l)
{
    lanczos_make_room(l, count_found(l));
    return draw(l, 0, BLOCK) ? TRIBO_OK : TRIBO_ERR_MEMORY;
}

/* -----------------------------------------------------------------------------------------------------------------
 * completeness */

/* A theta above those of the wanted modes that have one frequency with the last of them: the frequency may have more modes than
 * there is room for, and any combination of them is one. */
static double above_frequency(const struct lanczos *l, size_t wanted)
{
    size_t first = wanted - 1;
    while (first > 0 && l->theta[first - 1] - l->theta[wanted - 1] <= ONE * l->theta[wanted - 1]) {
        first--;
    }
    const double above = (1.0 + ONE) * l->theta[first];
    return first > 0 ? lesser(above, sqrt(l->theta[first - 1] * l->theta[first])) : above;
}

/* A theta that is well between the wanted ones and others: the first such place from the last wanted one on, within FURTHER; 0 if
 * there is none. More may have to be found for that. */
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
    *between = l->complete ? 0.5 * l->theta[l->size - 1] : 0.0;
    return TRIBO_OK;
}

/* How many modes have a theta above this one, and the growth of the factor that shows it. */
static int count_modes(const struct lanczos *l, const struct matrix *k, double theta, struct low_modes *found)
{
    const struct matrix *m = l->mass;
    const double sigma = l->shift / theta - l->shift;
    struct inertia inertia = {0, 0.0};
    struct matrix shifted;
    double *size = malloc((k->rows + 1) * sizeof *size);
    int status = size && tribo_matrix_sum(&shifted, 1.0, k, -sigma, m) ? TRIBO_OK : TRIBO_ERR_MEMORY;
    if (!status) {
        for (size_t i = 0; i < k->rows; i++) {
            size[i] = tribo_matrix_get(k, i, i) + fabs(sigma) * tribo_matrix_get(m, i, i);
        }
        status = tribo_sparse_inertia(l->shifted->sparse, &shifted, &shifted, size, &inertia);
        tribo_matrix_free(&shifted);
    }
    free(size);
    found->above = sigma;
    found->below = inertia.negative;
    found->growth = inertia.growth;
    return status == TRIBO_ERR_INDEFINITE ? TRIBO_ERR_NO_CONVERGENCE : status;
}

static size_t count_above(const struct lanczos *l, double theta)
{
    const size_t found = count_found(l);
    size_t k = 0;
    while (k < found && l->theta[k] > theta) {
        k++;
    }
    return k;
}

/* Finds all modes with theta above that, which are so many. */
static int complete(struct lanczos *l, double theta, size_t count)
{
    for (int search = 0; search < MOST_SEARCHES && count_above(l, theta) < count; search++) {
        int status = search ? lanczos_start_anew(l) : TRIBO_OK;
        status = status ? status : converge(l, count);
        if (status) {
            return status;
        }
    }
    return count_above(l, theta) == count ? TRIBO_OK : TRIBO_ERR_NO_CONVERGENCE;
}

/* Where there is no room for all that have the frequency of the last wanted one: finds all below it. */
static int complete_below(struct lanczos *l, const struct matrix *k, size_t wanted, struct low_modes *found)
{
    for (size_t search = 0; search < MOST_SEARCHES + wanted / BLOCK; search++) {
        int status = search ? lanczos_start_anew(l) : TRIBO_OK;
        status = status ? status : converge(l, wanted);
        const double theta = status ? 1.0 : above_frequency(l, wanted);
        status = status ? status : count_modes(l, k, theta, found);
        if (status || count_above(l, theta) == found->below) {
            return status;
        }
    }
    return TRIBO_ERR_NO_CONVERGENCE;
}

/* ------------------------------------------------------------------------------------------------------------------------
 * calls */

/* The modes found, once more through (K + shift M)^-1 M: that takes out of them what has no mass. */
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

static int lanczos_find(struct lanczos *l, const struct matrix *k, size_t wanted, struct low_modes *found)
{
    double theta = 0.0;
    int status = lanczos_start_anew(l);
    status = status ? status : converge(l, wanted);
    if (!status && count_found(l) < wanted) {
        found->count = count_found(l);
        return TRIBO_ERR_SIZE;
    }
    status = status ? status : find_gap(l, wanted, &theta);
    status = status || theta == 0.0 ? status : count_modes(l, k, theta, found);
    const int fits = found->below + 2 * BLOCK <= l->room || l->room == l->n;
    if (!status && (theta == 0.0 || !fits)) {
        status = complete_below(l, k, wanted, found);
    } else if (!status) {
        status = complete(l, theta, found->below);
    }
    return status ? status : lanczos_take(l, found->below > wanted ? found->below : wanted, found);
}

int tribo_low_modes(const struct matrix *k, const struct matrix *m, double shift, const struct cholesky *shifted, size_t wanted,
                    struct low_modes *found)
{
    const size_t n = k->rows, most = 2 * wanted + 20 * BLOCK, room = most < n ? most : n;
    struct lanczos l = {.mass = m, .shifted = shifted, .shift = shift, .n = n, .room = room, .seed = 1};
    memset(found, 0, sizeof *found);
    double *memory = malloc(((room + 2 * BLOCK) * n + 3 * room * room + (BLOCK + 1) * room) * sizeof *memory);
    if (!memory) {
        return TRIBO_ERR_MEMORY;
    }
    l.q = memory;
    l.w = l.q + room * n;
    l.mw = l.w + BLOCK * n;
    l.c = l.mw + BLOCK * n;
    l.theta = l.c + BLOCK * room;
    l.h = l.theta + room;
    l.s = l.h + room * room;
    l.work = l.s + room * room;
    const int status = lanczos_find(&l, k, wanted, found);
    free(memory);
    return status;
}
