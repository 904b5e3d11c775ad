/* SPDX-License-Identifier: BSD-3-Clause */
/* Problems over discs with a sparse factor, beside the same problems with a dense one. */
#include <stdlib.h>
#include <string.h>

#include "numerics/csr.h"
#include "numerics/disc/disc_qp.h"
#include "support.h"

/* Contacts of a row or a carpet, one after the other; their directions are places. */
struct scene {
    size_t places, *contact; /* [places] of a place */
    double *r;               /* [places][places] */
    unsigned char *wide;     /* [places] directions of the contact that begins there, or 0 */
    struct csr pattern;
    /* the problem: directions near stick with a limit */
    size_t size, *place; /* [size] */
    double *limit, *pull, *shift;
};

/* 1 if contacts i and j, i <= j, share a body. tied: contacts come in pairs between the same two bodies. */
static int touch(size_t i, size_t j, size_t width, int tied)
{
    const size_t a = tied ? i / 2 : i, b = tied ? j / 2 : j;
    return a == b || (a + 1 == b && b % width > 0) || (a + width == b && width > 1);
}

/* R of contacts on bodies of mass 1, or with blocks and masses at random. */
static void couple(struct scene *s, struct random *g, size_t width, int tied, int even)
{
    const size_t n = s->places;
    const double own = even ? (width <= s->contact[n - 1] ? 4.0 : 2.0) + 0.1 : 5.0;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = i; j < n; j++) {
            if (touch(s->contact[i], s->contact[j], width, tied)) {
                const size_t a = s->contact[i] / (tied ? 2 : 1), b = s->contact[j] / (tied ? 2 : 1);
                const int first = s->wide[i] > 0, same = first == (s->wide[j] > 0);
                const double beside = even ? (same ? -1.0 : 0.0) : uniform(g, -0.5, 0.5);
                s->r[i * n + j] = s->r[j * n + i] = a == b ? (same ? own : even ? 0.0 : 0.7) : beside;
            }
        }
    }
    for (size_t i = 0; tied && i < n; i++) { /* both of a pair have the same rows and columns */
        const size_t back = s->contact[i] % 2 ? i - 2 : i;
        for (size_t j = 0; j < n; j++) {
            const size_t to = s->contact[j] % 2 ? j - 2 : j;
            s->r[i * n + j] = s->r[back * n + to];
        }
    }
}

/* kind % 4: 0 at random; 1 all alike; 2 tied; 3 with scalar contacts, open ones and lenses. */
static struct scene scene_create(struct random *g, size_t contacts, size_t width, int kind)
{
    const int tied = kind % 4 == 2, mixed = kind % 4 == 3;
    struct scene s = {0};
    size_t entries = 0;
    s.contact = calloc(4 * contacts, sizeof *s.contact);
    s.place = s.contact + 2 * contacts;
    s.wide = calloc(2 * contacts, 1);
    s.limit = calloc(6 * contacts, sizeof *s.limit);
    s.pull = s.limit + 2 * contacts;
    s.shift = s.pull + 2 * contacts;
    for (size_t k = 0; k < contacts; k++) {
        const size_t directions = mixed && below(g, 4) == 0 ? 1 : 2;
        s.wide[s.places] = (unsigned char)directions;
        for (size_t d = 0; d < directions; d++) {
            s.contact[s.places++] = k;
        }
    }
    const size_t n = s.places;
    s.r = calloc(n * n, sizeof *s.r);
    couple(&s, g, width, tied, kind % 4 == 1);
    require(tribo_csr_create(&s.pattern, n, n * n), "no memory");
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            const size_t a = s.contact[i], b = s.contact[j];
            if (touch(a < b ? a : b, a < b ? b : a, width, tied)) {
                s.pattern.val[entries] = s.r[i * n + j];
                s.pattern.col[entries++] = j;
            }
        }
        s.pattern.first[i + 1] = entries;
    }
    for (size_t i = 0; i < n; i += s.wide[i]) {
        const double limit = kind % 4 == 1 ? 1.0 : uniform(g, 0.2, 1.0), angle = uniform(g, -PI, PI), size = uniform(g, 0.0, 1.9);
        for (size_t k = i; k < i + s.wide[i] && !(mixed && i && below(g, 5) == 0); k += s.wide[i]) {
            for (size_t d = 0; d < s.wide[i]; d++) {
                s.limit[s.size] = tied && s.contact[i] % 2 ? s.limit[s.size - 2] : limit;
                s.shift[s.size] = mixed ? size * (d ? sin(angle) : cos(angle)) : 0.0;
                s.place[s.size++] = i + d;
            }
        }
    }
    return s;
}

static void scene_free(struct scene *s)
{
    tribo_csr_free(&s->pattern);
    free(s->contact);
    free(s->wide);
    free(s->limit);
    free(s->r);
}

/* Pulls of which some need more than limits; those of tied contacts are the same, apart from this part of the contacts. */
static void pull(struct scene *s, struct random *g, double apart)
{
    double *need = calloc(s->places, sizeof *need);
    for (size_t i = 0; i < s->places; i++) {
        need[i] = uniform(g, -0.8, 0.8);
    }
    for (size_t e = 0; e < s->size; e++) {
        s->pull[e] = 0.0;
        for (size_t j = 0; j < s->places; j++) {
            s->pull[e] += s->limit[e] * s->r[s->place[e] * s->places + j] * need[j];
        }
        s->pull[e] += s->limit[e] * (uniform(g, 0.0, 1.0) < apart ? uniform(g, -1.0, 1.0) : 0.0);
    }
    free(need);
}

/* The problem of a scene, S = limit R limit, from y = 0. pattern NULL: with a dense factor. */
static void problem_create(struct disc_qp *p, const struct scene *s, struct sparse *pattern)
{
    const size_t n = s->size, entries = s->pattern.first[s->places];
    const struct disc_room room = {.size = s->places,
                                   .dense = pattern ? 0 : n,
                                   .places = pattern ? s->places : 0,
                                   .entries = pattern ? entries : 0,
                                   .slots = pattern ? tribo_sparse_slots(pattern) : 0};
    size_t *direction = malloc(s->places * sizeof *direction), end = 0;
    memset(p, 0, sizeof *p);
    require(direction && tribo_disc_create(p, &room), "no memory");
    for (size_t i = 0, e = 0; i < s->places; i++) {
        direction[i] = e < n && s->place[e] == i ? e++ : SIZE_MAX;
    }
    p->size = n;
    p->near_enough = TRIBO_NEAR_ENOUGH;
    p->s.pattern = pattern;
    p->s.places = s->places;
    p->s.place = s->place;
    for (size_t e = 0; e < n; e++) {
        p->wide[e] = s->wide[s->place[e]];
        p->shift[e] = s->shift[e];
        p->weight[e] = s->limit[e];
        for (size_t t = s->pattern.first[s->place[e]]; t < s->pattern.first[s->place[e] + 1]; t++) {
            const size_t j = direction[s->pattern.col[t]];
            const double x = j == SIZE_MAX ? 0.0 : s->limit[e] * s->limit[j] * s->pattern.val[t];
            if (j != SIZE_MAX && pattern) {
                p->s.own[e] = j == e ? end : p->s.own[e];
                p->s.val[end] = x;
                p->s.col[end] = j;
                p->s.slot[end++] = t;
                p->s.first[e + 1] = end;
            } else if (j != SIZE_MAX) {
                p->s.val[e * n + j] = x;
            }
        }
    }
    free(direction);
}

/* The problem of a scene with a dense factor, and with a sparse one. Returns the pattern of this factor. */
static struct sparse *pair_create(struct disc_qp *dense, struct disc_qp *sparse, const struct scene *s)
{
    struct sparse *pattern;
    require(tribo_sparse_create(&pattern, &s->pattern) && pattern, "no sparse factor");
    problem_create(dense, s, NULL);
    problem_create(sparse, s, pattern);
    return pattern;
}

static void pair_free(struct disc_qp *dense, struct disc_qp *sparse, struct sparse *pattern)
{
    tribo_disc_free(dense);
    tribo_disc_free(sparse);
    tribo_sparse_free(pattern);
}

/* rows [size] = S x. */
static void multiply(const struct disc_qp *p, const double *x, double *rows)
{
    memset(rows, 0, p->size * sizeof *rows);
    for (size_t e = 0; e < p->size; e += p->wide[e]) {
        tribo_disc_add(p, e, x, rows + e);
    }
}

/* Asserts that both problems follow x [size] to this tolerance; x [3 size]: the rest becomes what they answer. */
static void assert_follow_alike(struct disc_qp *dense, struct disc_qp *sparse, double *x, double tolerance)
{
    const size_t n = dense->size;
    tribo_disc_follow(dense, x, x + n);
    tribo_disc_follow(sparse, x, x + 2 * n);
    assert_all_close(x + 2 * n, x + n, n, tolerance);
}

/* Solutions, those of least norm, and changes along the freedoms, from one pull to the next. */
TEST(beside_dense)
{
    static const size_t shape[][2] = {{60, 60}, {100, 10}, {150, 150}, {169, 13}};
    const size_t *of = shape[_i / 4 % (int)COUNT(shape)];
    const int tied = _i % 4 == 2;
    struct random g = random_of(_i);
    struct scene s = scene_create(&g, of[0], of[1] < of[0] ? of[1] : of[0], _i);
    struct disc_qp dense, sparse;
    struct sparse *pattern = pair_create(&dense, &sparse, &s);
    const size_t n = s.size;
    double *x = calloc(4 * n, sizeof *x);
    for (int call = 0; call < 4; call++) {
        pull(&s, &g, call % 2 ? 0.1 : 0.0);
        memcpy(dense.pull, s.pull, n * sizeof *s.pull);
        memcpy(sparse.pull, s.pull, n * sizeof *s.pull);
        require(tribo_disc_solve(&dense) && tribo_disc_solve(&sparse), "no convergence");
        multiply(&dense, dense.y, x);
        multiply(&sparse, sparse.y, x + n);
        assert_all_close(x + n, x, n, 1e-11);
        if (tied) {
            require(tribo_disc_share(&dense) && tribo_disc_share(&sparse), "no share");
            assert_all_close(sparse.y, dense.y, n, 1e-7);
            continue;
        }
        assert_all_close(sparse.y, dense.y, n, 1e-11);
        for (size_t e = 0; e < n; e++) {
            x[e] = uniform(&g, -1.0, 1.0);
        }
        tribo_disc_linearize(&dense);
        tribo_disc_linearize(&sparse);
        assert_follow_alike(&dense, &sparse, x, 1e-8);
    }
    pair_free(&dense, &sparse, pattern);
    scene_free(&s);
    free(x);
}

/* Changes along the freedoms of tied contacts are of least norm. */
TEST(least_norm_of_changes)
{
    struct random g = random_of(_i);
    struct scene s = scene_create(&g, 60, 60, 2);
    struct disc_qp dense, sparse;
    struct sparse *pattern = pair_create(&dense, &sparse, &s);
    const size_t n = s.size;
    double *x = calloc(3 * n, sizeof *x);
    for (size_t e = 0; e < n; e++) { /* in the range of S */
        x[n + e] = uniform(&g, -1.0, 1.0);
    }
    multiply(&dense, x + n, x);
    memset(dense.place, LENS_INSIDE, n);
    memset(sparse.place, LENS_INSIDE, n);
    tribo_disc_linearize(&dense);
    tribo_disc_linearize(&sparse);
    tribo_disc_redundant(&sparse);
    ck_assert_uint_eq(sparse.factor.redundant, dense.factor.redundant);
    require(dense.factor.redundant > 50, "few are redundant");
    assert_follow_alike(&dense, &sparse, x, 1e-9);
    pair_free(&dense, &sparse, pattern);
    scene_free(&s);
    free(x);
}

TEST_MAIN("sparse_discs", {beside_dense, 32}, {least_norm_of_changes, 3})
