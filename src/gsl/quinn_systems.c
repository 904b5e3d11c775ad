/* Quinn's three reference systems, all with M = I. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "system.h"

/* A matrix under construction. */
struct list {
    size_t count;
    size_t *i, *j;
    double *v;
};

static int list_create(struct list *l, size_t room)
{
    l->count = 0;
    l->i = malloc(room * sizeof *l->i);
    l->j = malloc(room * sizeof *l->j);
    l->v = malloc(room * sizeof *l->v);
    return l->i && l->j && l->v;
}

static void list_free(struct list *l)
{
    free(l->i);
    free(l->j);
    free(l->v);
}

static void put(struct list *l, size_t i, size_t j, double v)
{
    l->i[l->count] = i;
    l->j[l->count] = j;
    l->v[l->count++] = v;
}

/* A system of unit masses with these stiffnesses and directions, one contact a row; and its limits. */
static int build(tribo_system **sys, size_t n, const struct list *stiffness, const struct list *direction, const double *limit)
{
    struct matrix k, c = {0}, j, b;
    const int done[] = {
        tribo_matrix_from_triplets(&k, n, n, stiffness->count, stiffness->i, stiffness->j, stiffness->v),
        tribo_matrix_from_triplets(&j, n, n, direction->count, direction->i, direction->j, direction->v),
        tribo_matrix_from_triplets(&b, n, n, direction->count, direction->j, direction->i, direction->v),
    };
    if (!done[0] || !done[1] || !done[2]) {
        tribo_matrix_free(&k);
        tribo_matrix_free(&j);
        tribo_matrix_free(&b);
        return TRIBO_ERR_MEMORY;
    }
    double *ones = malloc(n * sizeof *ones);
    tribo_system *s;
    int status = tribo_system_build(&s, n, n, &k, &c, &j, &b);
    if (status || !ones) {
        tribo_system_destroy(status ? NULL : s);
        free(ones);
        return TRIBO_ERR_MEMORY;
    }
    for (size_t i = 0; i < n; i++) {
        ones[i] = 1.0;
    }
    s->loads_accelerate = 1;
    status = tribo_set_operator_mass(s->contacts, n, ones, s->direction.first, s->direction.col, s->direction.val);
    free(ones);
    if (!status) {
        status = tribo_set_limit(s->contacts, limit);
    }
    if (status) {
        tribo_system_destroy(s);
        return status;
    }
    *sys = s;
    return TRIBO_OK;
}

int tribo_system_oscillator(tribo_system **sys, double limit, double alpha, double omega)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    size_t zero = 0;
    double one = 1.0;
    const struct list unit = {1, &zero, &zero, &one};
    tribo_system *s;
    if (!isfinite(alpha)) {
        return TRIBO_ERR_NOT_FINITE;
    }
    int status = build(&s, 1, &unit, &unit, &limit);
    if (status) {
        return status;
    }
    status = tribo_system_add_load(s, omega, NULL, &alpha);
    if (status) {
        tribo_system_destroy(s);
        return status;
    }
    *sys = s;
    return TRIBO_OK;
}

/* Multiplied by n, the chain's equations have unit masses, forces f_i, and n^2 for every spring. */
static void chain_stiffness(struct list *k, size_t n)
{
    const double spring = (double)n * (double)n;
    put(k, 0, 0, spring);
    put(k, 0, 1, -spring);
    for (size_t i = 1; i + 1 < n; i++) {
        put(k, i, i - 1, -spring);
        put(k, i, i, 2.0 * spring);
        put(k, i, i + 1, -spring);
    }
    put(k, n - 1, n - 2, -4.0 / 3.0 * spring);
    put(k, n - 1, n - 1, 4.0 * spring);
}

/* With 3/4 of the last row the stiffness is symmetric. */
static int set_metric(tribo_system *sys, size_t n)
{
    double *weight = malloc(n * sizeof *weight), pivot;
    size_t where;
    int status = weight && tribo_matrix_identity(&sys->metric, n) ? TRIBO_OK : TRIBO_ERR_MEMORY;
    for (size_t i = 0; !status && i < n; i++) {
        weight[i] = i + 1 < n ? 1.0 : 0.75;
    }
    if (!status && !tribo_matrix_scale_rows(&sys->metric, weight)) {
        status = TRIBO_ERR_MEMORY;
    }
    free(weight);
    return status ? status : tribo_cholesky_create(&sys->factor, &sys->metric, &where, &pivot);
}

int tribo_system_chain(tribo_system **sys, size_t n, double limit, double alpha, double omega)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (n < 2 || n > SIZE_MAX / 1024) {
        return TRIBO_ERR_SIZE;
    }
    if (!isfinite(alpha)) {
        return TRIBO_ERR_NOT_FINITE;
    }
    struct list k, j;
    double *limits = malloc(n * sizeof *limits), *load = calloc(n, sizeof *load);
    const int lists[] = {list_create(&k, 3 * n), list_create(&j, n)};
    int status = TRIBO_ERR_MEMORY;
    tribo_system *s = NULL;
    if (limits && load && lists[0] && lists[1]) {
        chain_stiffness(&k, n);
        for (size_t i = 0; i < n; i++) {
            put(&j, i, i, 1.0);
            limits[i] = limit;
        }
        load[0] = (double)n * alpha;
        status = build(&s, n, &k, &j, limits);
        if (!status) {
            s->power = 1.0 / (double)n;
            status = set_metric(s, n);
        }
        if (!status) {
            status = tribo_system_add_load(s, omega, NULL, load);
        }
    }
    list_free(&k);
    list_free(&j);
    free(limits);
    free(load);
    if (status) {
        tribo_system_destroy(s);
        return status;
    }
    *sys = s;
    return TRIBO_OK;
}

int tribo_system_belt(tribo_system **sys, double kappa, double limit1, double limit2, double speed, double omega)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (!isfinite(kappa) || !isfinite(speed)) {
        return TRIBO_ERR_NOT_FINITE;
    }
    size_t k_at[] = {0, 1}, j_row[] = {0, 1, 1}, j_col[] = {0, 0, 1};
    double k_value[] = {1.0, kappa}, j_value[] = {1.0, -1.0, 1.0};
    const struct list k = {2, k_at, k_at, k_value}, j = {3, j_row, j_col, j_value};
    const double limits[] = {limit1, limit2}, motion[] = {speed, 0.0};
    tribo_system *s;
    int status = build(&s, 2, &k, &j, limits);
    if (status) {
        return status;
    }
    status = tribo_system_add_base_motion(s, omega, NULL, motion);
    if (status) {
        tribo_system_destroy(s);
        return status;
    }
    *sys = s;
    return TRIBO_OK;
}
