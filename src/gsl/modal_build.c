#include "modal_build.h"
#include "../real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

/* ------------------------------------------------------------------------------------------------------------ memory */

/* Zeroed memory that belongs to a list. NULL if there is none left. */
static void *take(void **list, size_t *bytes, size_t count, size_t size)
{
    void **block = calloc(1, sizeof *block + (count + 1) * size);
    if (!block) {
        return NULL;
    }
    *block = *list;
    *list = block;
    *bytes += (count + 1) * size;
    return block + 1;
}

static void give_back(void *list)
{
    while (list) {
        void *next = *(void **)list;
        free(list);
        list = next;
    }
}

double *tribo_modal_keep(struct build *b, size_t count)
{
    return take(&b->h->memory, &b->h->bytes, count, sizeof(double));
}

size_t *tribo_modal_keep_indices(struct build *b, size_t count)
{
    return take(&b->h->memory, &b->h->bytes, count, sizeof(size_t));
}

unsigned char *tribo_modal_keep_bytes(struct build *b, size_t count)
{
    return take(&b->h->memory, &b->h->bytes, count, 1);
}

struct output *tribo_modal_keep_outputs(struct build *b, size_t count)
{
    return take(&b->h->memory, &b->h->bytes, count, sizeof *b->h->output);
}

double *tribo_modal_scratch(struct build *b, size_t count)
{
    size_t ignored = 0;
    return take(&b->scratch, &ignored, count, sizeof(double));
}

size_t *tribo_modal_scratch_indices(struct build *b, size_t count)
{
    size_t ignored = 0;
    return take(&b->scratch, &ignored, count, sizeof(size_t));
}

void tribo_modal_free(struct modal *h)
{
    if (h) {
        give_back(h->memory);
        free(h);
    }
}

/* ------------------------------------------------------------------------------------- the contacts that hold, and R_II */

/* Lists the contacts that hold, and their R_II if it is diagonal. */
static int list_rest(struct build *b, const unsigned char *holds)
{
    struct modal *h = b->h;
    size_t islands;
    b->rest = tribo_modal_scratch_indices(b, b->sys->ncontact);
    for (size_t i = 0; b->rest && i < b->sys->ncontact; i++) {
        if (holds[i]) {
            b->rest[h->rest++] = i;
        }
    }
    tribo_get_count(b->sys->contacts, TRIBO_COUNT_ISLANDS, &islands);
    if (!b->rest || islands < b->sys->ncontact) {
        return b->rest != NULL;
    }
    b->r_diagonal = tribo_modal_scratch(b, h->rest);
    for (size_t p = 0; b->r_diagonal && p < h->rest; p++) {
        b->r_diagonal[p] = tribo_system_delassus(b->sys, b->rest[p], b->rest[p]);
    }
    return b->r_diagonal != NULL;
}

/* Factorizes R_II, for solve_rest. */
static int factorize_rest(struct build *b)
{
    const size_t s = b->h->rest;
    double *r = tribo_modal_scratch(b, s * s), pivot;
    size_t where;
    struct matrix m = {0};
    for (size_t p = 0; r && p < s; p++) {
        for (size_t q = 0; q < s; q++) {
            r[p * s + q] = tribo_system_delassus(b->sys, b->rest[p], b->rest[q]);
        }
    }
    const int done = r && tribo_matrix_from_dense(&m, s, s, r) && tribo_cholesky_create(&b->r, &m, &where, &pivot) == TRIBO_OK;
    tribo_matrix_free(&m);
    return done;
}

/* x [rest] = R_II^-1 x. */
void tribo_modal_solve_rest(const struct build *b, double *x)
{
    if (b->r_diagonal) {
        for (size_t p = 0; p < b->h->rest; p++) {
            x[p] /= b->r_diagonal[p];
        }
    } else {
        tribo_half_solve(&b->r, x, 1);
        tribo_half_solve_back(&b->r, x, 1);
    }
}

/* x [rest] = factor * J_I q + keep * x. */
void tribo_modal_at_rest(const struct build *b, double factor, const double *q, double keep_part, double *x)
{
    const struct matrix *j = &b->sys->direction;
    for (size_t p = 0; p < b->h->rest; p++) {
        double sum = 0.0;
        for (size_t k = j->first[b->rest[p]]; k < j->first[b->rest[p] + 1]; k++) {
            sum += j->val[k] * q[j->col[k]];
        }
        x[p] = factor * sum + keep_part * x[p];
    }
}

/* ------------------------------------------------------------------------------------------------- modes of vibration */

/* 1 if every contact that holds has one degree of freedom, and W is diagonal: those degrees of freedom simply drop out. */
static int holds_single_dofs(const struct build *b)
{
    const struct matrix *j = &b->sys->direction;
    for (size_t p = 0; p < b->h->rest; p++) {
        if (j->first[b->rest[p] + 1] - j->first[b->rest[p]] != 1) {
            return 0;
        }
    }
    return b->sys->factor.factor == NULL;
}

/* phi and omega^2 from the stiffness of the degrees of freedom that are not held. */
static int modes_by_elimination(struct build *b)
{
    const struct matrix *j = &b->sys->direction, *ak = &b->sys->stiffness;
    size_t *place = tribo_modal_scratch_indices(b, b->n), m = 0;
    if (!place) {
        return 0;
    }
    for (size_t p = 0; p < b->h->rest; p++) {
        place[j->col[j->first[b->rest[p]]]] = (size_t)-1;
    }
    for (size_t d = 0; d < b->n; d++) {
        place[d] = place[d] ? (size_t)-1 : m++;
    }
    b->h->modes = m;
    double *k = tribo_modal_scratch(b, m * m), *v = tribo_modal_scratch(b, m * m);
    b->h->omega2 = tribo_modal_keep(b, m);
    b->phi = tribo_modal_scratch(b, m * b->n);
    if (!k || !v || !b->h->omega2 || !b->phi) {
        return 0;
    }
    const double *root = b->sys->factor.root;
    for (size_t d = 0; d < b->n; d++) {
        for (size_t e = ak->first[d]; place[d] < m && e < ak->first[d + 1]; e++) {
            const size_t other = ak->col[e];
            if (place[other] < m) {
                const double x = ak->val[e] * (root ? root[d] / root[other] : 1.0);
                k[place[d] * m + place[other]] += 0.5 * x;
                k[place[other] * m + place[d]] += 0.5 * x;
            }
        }
    }
    if (!tribo_symmetric_eigen(k, m, b->h->omega2, v)) {
        return 0;
    }
    for (size_t mode = 0; mode < m; mode++) {
        for (size_t d = 0; d < b->n; d++) {
            b->phi[mode * b->n + d] = place[d] < m ? v[place[d] * m + mode] / (root ? root[d] : 1.0) : 0.0;
        }
    }
    return 1;
}

/* The same by an orthogonal basis Q2 of what J_I S leaves free, S S' = W^-1: phi = S Q2 V. */
static int modes_by_projection(struct build *b)
{
    const size_t n = b->n, s = b->h->rest, m = n - s;
    const struct matrix *j = &b->sys->direction;
    b->h->modes = m;
    double *js = tribo_modal_scratch(b, n * s), *q = tribo_modal_scratch(b, n * n), *tau = tribo_modal_scratch(b, s),
           *r = tribo_modal_scratch(b, n * s), *z = tribo_modal_scratch(b, m * n);
    double *kz = tribo_modal_scratch(b, m * n), *wkz = tribo_modal_scratch(b, m * n), *k = tribo_modal_scratch(b, m * m),
           *v = tribo_modal_scratch(b, m * m);
    b->h->omega2 = tribo_modal_keep(b, m);
    b->phi = tribo_modal_scratch(b, m * n);
    if (!js || !q || !tau || !r || !z || !kz || !wkz || !k || !v || !b->h->omega2 || !b->phi) {
        return 0;
    }
    for (size_t p = 0; p < s; p++) {
        for (size_t e = j->first[b->rest[p]]; e < j->first[b->rest[p] + 1]; e++) {
            js[j->col[e] * s + p] = j->val[e];
        }
    }
    if (s) {
        tribo_half_solve(&b->sys->factor, js, s);
        gsl_matrix_view jv = gsl_matrix_view_array(js, n, s), qv = gsl_matrix_view_array(q, n, n),
                        rv = gsl_matrix_view_array(r, n, s);
        gsl_vector_view tv = gsl_vector_view_array(tau, s);
        gsl_linalg_QR_decomp(&jv.matrix, &tv.vector);
        gsl_linalg_QR_unpack(&jv.matrix, &tv.vector, &qv.matrix, &rv.matrix);
    } else {
        for (size_t d = 0; d < n; d++) {
            q[d * n + d] = 1.0;
        }
    }
    tribo_half_solve_back(&b->sys->factor, q, n);
    for (size_t mode = 0; mode < m; mode++) {
        for (size_t d = 0; d < n; d++) {
            z[mode * n + d] = q[d * n + s + mode];
        }
        tribo_matrix_multiply_add(&b->sys->stiffness, 1.0, z + mode * n, kz + mode * n);
        if (b->sys->metric.rows) {
            tribo_matrix_multiply_add(&b->sys->metric, 1.0, kz + mode * n, wkz + mode * n);
        } else {
            memcpy(wkz + mode * n, kz + mode * n, n * sizeof *wkz);
        }
    }
    for (size_t p = 0; p < m; p++) {
        for (size_t o = 0; o < m; o++) {
            const double x = 0.5 * dot(z + p * n, wkz + o * n, n);
            k[p * m + o] += x;
            k[o * m + p] += x;
        }
    }
    if (!tribo_symmetric_eigen(k, m, b->h->omega2, v)) {
        return 0;
    }
    for (size_t mode = 0; mode < m; mode++) {
        for (size_t p = 0; p < m; p++) {
            add(b->phi + mode * n, v[p * m + mode], z + p * n, n);
        }
    }
    return 1;
}

/* Sum of the diagonal's absolute values: of a semidefinite matrix no eigenvalue is larger. */
static double trace(const struct matrix *a)
{
    double sum = 0.0;
    for (size_t i = 0; i < a->rows; i++) {
        sum += fabs(tribo_matrix_get(a, i, i));
    }
    return sum;
}

/* What follows from phi: W phi, AK phi, AC phi, damping, and which modes drift. */
static int complete_modes(struct build *b)
{
    struct modal *h = b->h;
    const size_t n = b->n, m = h->modes;
    double *c = tribo_modal_scratch(b, m * m);
    b->psi = tribo_modal_scratch(b, m * n);
    b->ak_phi = tribo_modal_scratch(b, m * n);
    b->ac_phi = tribo_modal_scratch(b, m * n);
    h->damping = tribo_modal_keep(b, m);
    h->drifts = tribo_modal_keep_bytes(b, m);
    if (!c || !b->psi || !b->ak_phi || !b->ac_phi || !h->damping || !h->drifts) {
        return 0;
    }
    for (size_t k = 0; k < m; k++) {
        const double *phi = b->phi + k * n;
        if (b->sys->metric.rows) {
            tribo_matrix_multiply_add(&b->sys->metric, 1.0, phi, b->psi + k * n);
        } else {
            memcpy(b->psi + k * n, phi, n * sizeof *phi);
        }
        tribo_matrix_multiply_add(&b->sys->stiffness, 1.0, phi, b->ak_phi + k * n);
        if (b->sys->damping.rows) {
            tribo_matrix_multiply_add(&b->sys->damping, 1.0, phi, b->ac_phi + k * n);
        }
    }
    /* what is left where motion is held may be nothing but rounding of the whole: zero is in terms of that */
    double most = trace(&b->sys->damping), beside = 0.0;
    for (size_t k = 0; k < m; k++) {
        for (size_t l = 0; b->sys->damping.rows && l < m; l++) {
            c[k * m + l] = dot(b->psi + k * n, b->ac_phi + l * n, n);
            beside = k == l ? beside : greater(beside, fabs(c[k * m + l]));
        }
    }
    if (beside > 1e-14 * most) {
        h->coupling = tribo_modal_keep(b, m * m);
        if (!h->coupling) {
            return 0;
        }
        memcpy(h->coupling, c, m * m * sizeof *c);
    }
    const double zero = 1e-13 * trace(&b->sys->stiffness);
    for (size_t k = 0; k < m; k++) {
        h->damping[k] = fabs(c[k * m + k]) > 1e-14 * most ? c[k * m + k] : 0.0;
        h->omega2[k] = fabs(h->omega2[k]) > zero ? h->omega2[k] : 0.0;
        h->drifts[k] = h->omega2[k] == 0.0 && h->damping[k] == 0.0;
    }
    return 1;
}

/* ------------------------------------------------------------------------------------------------------- structures */

/* Keeps modes and belt velocities for the degrees of freedom that move. */
static int compress(struct build *b)
{
    struct modal *h = b->h;
    const size_t n = b->n, m = h->modes, s = h->harmonics;
    h->dof = tribo_modal_keep_indices(b, n);
    for (size_t d = 0; h->dof && d < n; d++) {
        int moves = b->y0[d] != 0.0;
        for (size_t k = 0; k < m; k++) {
            moves |= b->phi[k * n + d] != 0.0 || b->psi[k * n + d] != 0.0;
        }
        for (size_t w = 0; w < s; w++) {
            moves |= b->yr[w * n + d] != 0.0 || b->yi[w * n + d] != 0.0;
        }
        if (moves) {
            h->dof[h->moving++] = d;
        }
    }
    h->phi = tribo_modal_keep(b, m * h->moving);
    h->psi = tribo_modal_keep(b, m * h->moving);
    h->yr = tribo_modal_keep(b, s * h->moving);
    h->yi = tribo_modal_keep(b, s * h->moving);
    h->y0 = tribo_modal_keep(b, h->moving);
    if (!h->dof || !h->phi || !h->psi || !h->yr || !h->yi || !h->y0) {
        return 0;
    }
    for (size_t i = 0; i < h->moving; i++) {
        const size_t d = h->dof[i];
        for (size_t k = 0; k < m; k++) {
            h->phi[k * h->moving + i] = b->phi[k * n + d];
            h->psi[k * h->moving + i] = b->psi[k * n + d];
        }
        for (size_t w = 0; w < s; w++) {
            h->yr[w * h->moving + i] = b->yr[w * n + d];
            h->yi[w * h->moving + i] = b->yi[w * n + d];
        }
        h->y0[i] = b->y0[d];
    }
    return 1;
}

static int build(struct build *b, const signed char *mode, const unsigned char *holds)
{
    struct modal *h = b->h;
    h->key = take(&h->memory, &h->bytes, b->sys->ncontact, 1);
    for (size_t i = 0; h->key && i < b->sys->ncontact; i++) {
        h->key[i] = (signed char)((mode[i] == 0) + holds[i]);
    }
    if (!h->key || !list_rest(b, holds) || (!b->r_diagonal && !factorize_rest(b)) ||
        !(holds_single_dofs(b) ? modes_by_elimination(b) : modes_by_projection(b)) || !complete_modes(b)) {
        return TRIBO_ERR_MEMORY;
    }
    const int status = tribo_modal_exponents(b);
    if (status) {
        return status;
    }
    h->size = tribo_modal_keep(b, h->exponents);
    for (size_t p = 0; h->size && p < h->exponents; p++) {
        h->size[p] = hypot(h->lr[p], h->li[p]);
        h->fastest = greater(h->fastest, h->size[p]);
    }
    const int done = h->size && tribo_modal_forcing(b) && tribo_modal_response(b) && tribo_modal_outputs(b) && compress(b);
    return done ? TRIBO_OK : b->status ? b->status : TRIBO_ERR_MEMORY;
}

int tribo_modal_create(struct modal **modal, tribo_system *sys, const signed char *mode, const unsigned char *holds)
{
    struct build b = {.sys = sys, .n = sys->ndof, .h = calloc(1, sizeof *b.h)};
    int status = b.h ? build(&b, mode, holds) : TRIBO_ERR_MEMORY;
    give_back(b.scratch);
    tribo_cholesky_free(&b.r);
    if (status) {
        tribo_modal_free(b.h);
        return status == TRIBO_ERR_MEMORY ? tribo_system_fail(sys, status, "out of memory for the modes of a held structure")
                                          : status;
    }
    *modal = b.h;
    return TRIBO_OK;
}
