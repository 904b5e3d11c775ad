#include "held.h"
#include "../real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_complex.h>
#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>

/* Closer than this, relative, the response to a harmonic is computed without the closed form's small divisor; and a mode this
 * close to critical damping has no two exponents that could be told apart to 12 digits. */
#define RESONANCE 1e-3

/* A response larger than one over this would leave too few digits. */
#define UNDAMPED 1e-9
#define CRITICAL 1e-8

/* Bases that part from each other by no more than this part of their motion go together. */
#define NO_MOTION 1e-14

/* What is needed only while a held structure is built. Vectors of the whole structure: [ndof], modes of it [modes][ndof]. */
struct build {
    tribo_system *sys;
    struct held *h;
    size_t n;
    size_t *rest;       /* [h->rest] the contacts that hold */
    double *r_diagonal; /* [rest] R_II, if the contacts share no body; */
    struct cholesky r;  /* its factor, if they do */
    double *phi, *psi, *ak_phi, *ac_phi;
    double *g, *g_rate; /* [modes][rest] force of the held contacts per unit of eta, eta' */
    double *yr, *yi;    /* [harmonics][ndof] */
    double *y0;         /* [ndof] velocities from belts of constant speed */
    void *scratch;      /* list of what is freed at the end */
    int status;         /* of a failure other than of memory */
};

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

static double *keep(struct build *b, size_t count)
{
    return take(&b->h->memory, &b->h->bytes, count, sizeof(double));
}

static size_t *keep_indices(struct build *b, size_t count)
{
    return take(&b->h->memory, &b->h->bytes, count, sizeof(size_t));
}

static unsigned char *keep_bytes(struct build *b, size_t count)
{
    return take(&b->h->memory, &b->h->bytes, count, 1);
}

static double *scratch(struct build *b, size_t count)
{
    size_t ignored = 0;
    return take(&b->scratch, &ignored, count, sizeof(double));
}

static size_t *scratch_indices(struct build *b, size_t count)
{
    size_t ignored = 0;
    return take(&b->scratch, &ignored, count, sizeof(size_t));
}

static double dot(const double *x, const double *y, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += x[i] * y[i];
    }
    return sum;
}

static void add(double *to, double factor, const double *x, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        to[i] += factor * x[i];
    }
}

void tribo_held_free(struct held *h)
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
    struct held *h = b->h;
    size_t islands;
    b->rest = scratch_indices(b, b->sys->ncontact);
    for (size_t i = 0; b->rest && i < b->sys->ncontact; i++) {
        if (holds[i]) {
            b->rest[h->rest++] = i;
        }
    }
    tribo_get_count(b->sys->contacts, TRIBO_COUNT_ISLANDS, &islands);
    if (!b->rest || islands < b->sys->ncontact) {
        return b->rest != NULL;
    }
    b->r_diagonal = scratch(b, h->rest);
    for (size_t p = 0; b->r_diagonal && p < h->rest; p++) {
        b->r_diagonal[p] = tribo_system_delassus(b->sys, b->rest[p], b->rest[p]);
    }
    return b->r_diagonal != NULL;
}

/* Factorizes R_II, for solve_rest. */
static int factorize_rest(struct build *b)
{
    const size_t s = b->h->rest;
    double *r = scratch(b, s * s), pivot;
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
static void solve_rest(const struct build *b, double *x)
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
static void at_rest(const struct build *b, double factor, const double *q, double keep_part, double *x)
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
    size_t *place = scratch_indices(b, b->n), m = 0;
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
    double *k = scratch(b, m * m), *v = scratch(b, m * m);
    b->h->omega2 = keep(b, m);
    b->phi = scratch(b, m * b->n);
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
    double *js = scratch(b, n * s), *q = scratch(b, n * n), *tau = scratch(b, s), *r = scratch(b, n * s), *z = scratch(b, m * n);
    double *kz = scratch(b, m * n), *wkz = scratch(b, m * n), *k = scratch(b, m * m), *v = scratch(b, m * m);
    b->h->omega2 = keep(b, m);
    b->phi = scratch(b, m * n);
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
    struct held *h = b->h;
    const size_t n = b->n, m = h->modes;
    double *c = scratch(b, m * m);
    b->psi = scratch(b, m * n);
    b->ak_phi = scratch(b, m * n);
    b->ac_phi = scratch(b, m * n);
    h->damping = keep(b, m);
    h->drifts = keep_bytes(b, m);
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
        h->coupling = keep(b, m * m);
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

/* ------------------------------------------------------------------------------------------------------- exponents */

static int unsupported(const struct build *b, const char *why)
{
    return tribo_system_fail(b->sys, TRIBO_ERR_UNSUPPORTED, "method exact: %s; method event can do it", why);
}

static int exponents_decoupled(struct build *b)
{
    struct held *h = b->h;
    const size_t m = h->modes;
    h->lr = keep(b, 2 * m);
    h->li = keep(b, 2 * m);
    h->ar = keep(b, 2 * m);
    h->ai = keep(b, 2 * m);
    h->br = keep(b, 2 * m);
    h->bi = keep(b, 2 * m);
    h->owner = keep_indices(b, 2 * m);
    if (!h->lr || !h->li || !h->ar || !h->ai || !h->br || !h->bi || !h->owner) {
        return TRIBO_ERR_MEMORY;
    }
    size_t p = 0;
    for (size_t k = 0; k < m; k++) {
        const double half = 0.5 * h->damping[k], square = h->omega2[k] - half * half, root = sqrt(fabs(square));
        if (h->drifts[k]) {
            continue;
        }
        if (fabs(square) < CRITICAL * greater(fabs(h->omega2[k]), half * half)) {
            return unsupported(b, "a mode is critically damped");
        }
        if (square > 0.0) {
            h->lr[p] = -half;
            h->li[p] = root;
            h->ar[p] = 1.0;
            h->ai[p] = -half / root;
            h->bi[p] = -1.0 / root;
            h->owner[p++] = k;
            continue;
        }
        const double far = half > 0.0 ? -half - root : -half + root, near = h->omega2[k] / far;
        for (int which = 0; which < 2; which++) {
            h->lr[p] = which ? far : near;
            h->br[p] = which ? 1.0 / (far - near) : 1.0 / (near - far);
            h->ar[p] = -h->br[p] * (which ? near : far);
            h->owner[p++] = k;
        }
    }
    h->exponents = p;
    return TRIBO_OK;
}

/* Eigenvalues of the first-order form x' = A x, x = (s eta, eta'), with s so chosen that A is well scaled. */
static int exponents_coupled(struct build *b)
{
    struct held *h = b->h;
    const size_t m = h->modes, size = 2 * m;
    double *a = scratch(b, size * size), *s = scratch(b, m), *values = scratch(b, 2 * size),
           *vectors = scratch(b, 2 * size * size);
    double *lu = scratch(b, 2 * size * size), *inverse = scratch(b, 2 * size * size);
    size_t *order = scratch_indices(b, size);
    gsl_eigen_nonsymmv_workspace *work = gsl_eigen_nonsymmv_alloc(size);
    if (!a || !s || !values || !vectors || !lu || !inverse || !order || !work) {
        gsl_eigen_nonsymmv_free(work);
        return TRIBO_ERR_MEMORY;
    }
    for (size_t k = 0; k < m; k++) {
        if (!(h->omega2[k] > 0.0)) {
            gsl_eigen_nonsymmv_free(work);
            return unsupported(b, "coupled damping, and a mode without stiffness");
        }
        s[k] = sqrt(h->omega2[k]);
        a[k * size + m + k] = s[k];
        a[(m + k) * size + k] = -s[k];
        for (size_t l = 0; l < m; l++) {
            a[(m + k) * size + m + l] -= h->coupling[k * m + l];
        }
    }
    gsl_matrix_view av = gsl_matrix_view_array(a, size, size);
    gsl_vector_complex_view ev = gsl_vector_complex_view_array(values, size);
    gsl_matrix_complex_view vv = gsl_matrix_complex_view_array(vectors, size, size);
    gsl_matrix_complex_view fv = gsl_matrix_complex_view_array(lu, size, size),
                            iv = gsl_matrix_complex_view_array(inverse, size, size);
    gsl_eigen_nonsymmv(&av.matrix, &ev.vector, &vv.matrix, work);
    gsl_eigen_nonsymmv_free(work);
    memcpy(lu, vectors, 2 * size * size * sizeof *lu);
    gsl_permutation p = {size, order};
    int sign;
    gsl_linalg_complex_LU_decomp(&fv.matrix, &p, &sign);
    for (size_t i = 0; i < size; i++) {
        if (hypot(lu[2 * (i * size + i)], lu[2 * (i * size + i) + 1]) < 1e-6) {
            return unsupported(b, "two modes have nearly the same exponent and shape");
        }
    }
    gsl_linalg_complex_LU_invert(&fv.matrix, &p, &iv.matrix);

    h->lr = keep(b, size);
    h->li = keep(b, size);
    h->ar = keep(b, size * m);
    h->ai = keep(b, size * m);
    h->br = keep(b, size * m);
    h->bi = keep(b, size * m);
    h->rr = keep(b, size * m);
    h->ri = keep(b, size * m);
    if (!h->lr || !h->li || !h->ar || !h->ai || !h->br || !h->bi || !h->rr || !h->ri) {
        return TRIBO_ERR_MEMORY;
    }
    size_t e = 0;
    for (size_t i = 0; i < size; i++) {
        const double nu = values[2 * i + 1], twice = nu > 0.0 ? 2.0 : 1.0;
        if (nu < 0.0) {
            continue;
        }
        h->lr[e] = values[2 * i];
        h->li[e] = nu;
        for (size_t k = 0; k < m; k++) {
            h->ar[e * m + k] = s[k] * inverse[2 * (i * size + k)];
            h->ai[e * m + k] = s[k] * inverse[2 * (i * size + k) + 1];
            h->br[e * m + k] = inverse[2 * (i * size + m + k)];
            h->bi[e * m + k] = inverse[2 * (i * size + m + k) + 1];
            h->rr[k * size + e] = twice * vectors[2 * (k * size + i)] / s[k];
            h->ri[k * size + e] = twice * vectors[2 * (k * size + i) + 1] / s[k];
        }
        e++;
    }
    h->exponents = e;
    for (size_t k = 0; k < m; k++) {
        memmove(h->rr + k * e, h->rr + k * size, e * sizeof *h->rr);
        memmove(h->ri + k * e, h->ri + k * size, e * sizeof *h->ri);
    }
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------- harmonics */

/* y [ndof] = velocities from the b of the contacts that hold: B_I R_II^-1 b_I. x [rest] has b_I. */
static void belt_velocities(const struct build *b, double *x, double *y)
{
    solve_rest(b, x);
    for (size_t d = 0; d < b->n; d++) {
        double sum = 0.0;
        for (size_t p = 0; p < b->h->rest; p++) {
            sum += tribo_matrix_get(&b->sys->response, d, b->rest[p]) * x[p];
        }
        y[d] = sum;
    }
}

/* One part (0 cosine, 1 minus sine: harmonics are Re((c - i s) e^{i Omega t})) of a harmonic of b_I. */
static void base_part(const struct build *b, const struct harmonic *w, int part, double *x)
{
    for (size_t p = 0; p < b->h->rest; p++) {
        x[p] = 0.0;
        for (size_t i = 0; i < w->count; i++) {
            if (w->index[i] == b->rest[p]) {
                x[p] = part ? -w->sine[i] : w->cosine[i];
            }
        }
    }
}

/* Forcing of eta by each harmonic, and what the held contacts are moved by. */
static int find_forcing(struct build *b)
{
    struct held *h = b->h;
    const size_t n = b->n, m = h->modes, count = b->sys->harmonics;
    h->harmonics = count;
    h->gr = keep(b, count * m);
    h->gi = keep(b, count * m);
    h->ramp = keep(b, m);
    b->yr = scratch(b, count * n);
    b->yi = scratch(b, count * n);
    b->y0 = scratch(b, n);
    double *x = scratch(b, h->rest), *pull = scratch(b, n), *drag = scratch(b, n);
    if (!h->gr || !h->gi || !h->ramp || !b->yr || !b->yi || !b->y0 || !x || !pull || !drag) {
        return 0;
    }
    for (size_t w = 0; w < count; w++) {
        const struct harmonic *wave = &b->sys->harmonic[w];
        double *g[] = {h->gr + w * m, h->gi + w * m}, *y[] = {b->yr + w * n, b->yi + w * n};
        for (int part = 0; !wave->moves_base && part < 2; part++) {
            for (size_t k = 0; k < m; k++) {
                for (size_t i = 0; i < wave->count; i++) {
                    g[part][k] += (part ? -wave->sine[i] : wave->cosine[i]) * b->psi[k * n + wave->index[i]];
                }
            }
        }
        for (int part = 0; wave->moves_base && part < 2; part++) {
            base_part(b, wave, part, x);
            belt_velocities(b, x, y[part]);
        }
        for (int part = 0; wave->moves_base && part < 2; part++) {
            if (wave->omega == 0.0) {
                if (part == 0) {
                    add(b->y0, 1.0, y[0], n);
                }
                memset(y[part], 0, n * sizeof **y);
                continue;
            }
            /* -AK y/(i Omega) - AC y; 1/i turns the real part into minus the imaginary one */
            memset(pull, 0, n * sizeof *pull);
            memset(drag, 0, n * sizeof *drag);
            tribo_matrix_multiply_add(&b->sys->stiffness, (part ? -1.0 : 1.0) / wave->omega, y[part], pull);
            if (b->sys->damping.rows) {
                tribo_matrix_multiply_add(&b->sys->damping, -1.0, y[part], drag);
            }
            for (size_t k = 0; k < m; k++) {
                g[1 - part][k] += dot(b->psi + k * n, pull, n);
                g[part][k] += dot(b->psi + k * n, drag, n);
            }
        }
    }
    memset(pull, 0, n * sizeof *pull);
    tribo_matrix_multiply_add(&b->sys->stiffness, -1.0, b->y0, pull);
    for (size_t k = 0; k < m; k++) {
        h->ramp[k] = dot(b->psi + k * n, pull, n);
    }
    return 1;
}

/* Response of eta to the harmonics, (diag(omega^2) - Omega^2 + i Omega C~) x = g. */
static int find_response(struct build *b)
{
    struct held *h = b->h;
    const size_t m = h->modes, count = h->harmonics;
    h->xr = keep(b, count * m);
    h->xi = keep(b, count * m);
    h->resonant = keep_bytes(b, count * m);
    double *a = scratch(b, 2 * m * m), *x = scratch(b, 2 * m);
    size_t *order = scratch_indices(b, m);
    if (!h->xr || !h->xi || !h->resonant || !a || !x || !order) {
        return 0;
    }
    for (size_t w = 0; w < count; w++) {
        const double omega = b->sys->harmonic[w].omega;
        const double *gr = h->gr + w * m, *gi = h->gi + w * m;
        for (size_t k = 0; omega != 0.0 && !h->coupling && k < m; k++) {
            const double re = h->omega2[k] - omega * omega, im = omega * h->damping[k], square = re * re + im * im;
            h->resonant[w * m + k] = sqrt(square) < RESONANCE * fabs(h->omega2[k]) && (gr[k] != 0.0 || gi[k] != 0.0);
            h->any_resonant |= h->resonant[w * m + k];
            if (!h->resonant[w * m + k] && (gr[k] != 0.0 || gi[k] != 0.0)) {
                h->xr[w * m + k] = (gr[k] * re + gi[k] * im) / square;
                h->xi[w * m + k] = (gi[k] * re - gr[k] * im) / square;
            }
        }
        if (omega == 0.0 || !h->coupling || m == 0) {
            continue;
        }
        for (size_t k = 0; k < m; k++) {
            for (size_t l = 0; l < m; l++) {
                a[2 * (k * m + l)] = k == l ? h->omega2[k] - omega * omega : 0.0;
                a[2 * (k * m + l) + 1] = omega * h->coupling[k * m + l];
            }
            x[2 * k] = gr[k];
            x[2 * k + 1] = gi[k];
        }
        gsl_matrix_complex_view av = gsl_matrix_complex_view_array(a, m, m);
        gsl_vector_complex_view xv = gsl_vector_complex_view_array(x, m);
        gsl_permutation p = {m, order};
        int sign;
        gsl_linalg_complex_LU_decomp(&av.matrix, &p, &sign);
        for (size_t k = 0; k < m; k++) {
            if (hypot(a[2 * (k * m + k)], a[2 * (k * m + k) + 1]) <= UNDAMPED * omega * omega) {
                b->status =
                    tribo_system_fail(b->sys, TRIBO_ERR_UNSUPPORTED,
                                      "the harmonic of omega = %g is in resonance with an undamped mode, while damping couples "
                                      "others: take method event",
                                      omega);
                return 0;
            }
        }
        gsl_linalg_complex_LU_svx(&av.matrix, &p, &xv.vector);
        for (size_t k = 0; k < m; k++) {
            h->xr[w * m + k] = x[2 * k];
            h->xi[w * m + k] = x[2 * k + 1];
        }
    }
    return 1;
}

/* --------------------------------------------------------------------------------------------------------- watches */

/* Adds what a contact gets from position (eta) and velocity (eta') amplitudes of mode k. */
static void watch_mode(const struct build *b, struct watch *w, size_t k, double position, double velocity)
{
    const struct held *h = b->h;
    const size_t m = h->modes;
    for (size_t p = 0; p < h->exponents; p++) {
        if (h->owner && h->owner[p] != k) {
            continue;
        }
        const double rr = h->owner ? 1.0 : h->rr[k * h->exponents + p], ri = h->owner ? 0.0 : h->ri[k * h->exponents + p];
        const double fr = position + velocity * h->lr[p], fi = velocity * h->li[p];
        w->cr[p] += fr * rr - fi * ri;
        w->ci[p] += fr * ri + fi * rr;
    }
    for (size_t s = 0; s < h->harmonics; s++) {
        const double omega = b->sys->harmonic[s].omega, xr = h->xr[s * m + k], xi = h->xi[s * m + k];
        w->rr[s] += position * xr - velocity * omega * xi;
        w->ri[s] += position * xi + velocity * omega * xr;
    }
}

static int create_watch(struct build *b, struct watch *w, size_t contact)
{
    const size_t p = b->h->exponents, s = b->h->harmonics, m = b->h->modes;
    double *x = keep(b, 4 * p + 4 * s + m);
    if (!x) {
        return 0;
    }
    double *y = x + 4 * p;
    *w = (struct watch){contact, x, x + p, x + 2 * p, x + 3 * p, y, y + s, y + 2 * s, y + 3 * s, y + 4 * s, 0.0};
    return 1;
}

static double sixth_power(double x)
{
    return x * x * x * x * x * x;
}

static void finish_watch(const struct build *b, struct watch *w)
{
    for (size_t p = 0; p < b->h->exponents; p++) {
        w->size[p] = hypot(w->cr[p], w->ci[p]);
        w->bend[p] = w->size[p] * sixth_power(b->h->size[p]);
    }
    for (size_t s = 0; s < b->h->harmonics; s++) {
        w->wave[s] = hypot(w->rr[s], w->ri[s]);
        w->wave_bend[s] = w->wave[s] * sixth_power(b->sys->harmonic[s].omega);
    }
}

/* The largest |x + i y|, nearly. */
static double largest(const double *x, const double *y, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        most = greater(most, fabs(x[i]) + fabs(y[i]));
    }
    return most;
}

/* What the belts make of v_i = J_i q' - b_i, in all harmonics; what is only rounding of their motion is left out. Returns whether
 * there is anything. */
static int watch_belts(const struct build *b, struct watch *w, size_t i)
{
    const struct matrix *j = &b->sys->direction;
    int any = 0;
    for (size_t s = 0; s < b->h->harmonics; s++) {
        const struct harmonic *wave = &b->sys->harmonic[s];
        const double *yr = b->yr + s * b->n, *yi = b->yi + s * b->n, most = largest(yr, yi, b->n);
        double re = 0.0, im = 0.0, size = 0.0;
        for (size_t e = j->first[i]; e < j->first[i + 1]; e++) {
            re += j->val[e] * yr[j->col[e]];
            im += j->val[e] * yi[j->col[e]];
            size += fabs(j->val[e]) * most;
        }
        for (size_t e = 0; wave->moves_base && wave->omega != 0.0 && e < wave->count; e++) {
            re -= wave->index[e] == i ? wave->cosine[e] : 0.0;
            im += wave->index[e] == i ? wave->sine[e] : 0.0;
        }
        if (fabs(re) + fabs(im) > NO_MOTION * size) {
            w->rr[s] += re;
            w->ri[s] += im;
            any = 1;
        }
    }
    return any;
}

/* v_i = J_i q' - b_i. */
static int watch_sliding(struct build *b, struct watch *w, size_t i)
{
    if (!create_watch(b, w, i)) {
        return 0;
    }
    const struct matrix *j = &b->sys->direction;
    for (size_t k = 0; k < b->h->modes; k++) {
        double shape = 0.0;
        for (size_t e = j->first[i]; e < j->first[i + 1]; e++) {
            shape += j->val[e] * b->phi[k * b->n + j->col[e]];
        }
        w->on_rate[k] = shape;
        watch_mode(b, w, k, 0.0, shape);
    }
    watch_belts(b, w, i);
    finish_watch(b, w);
    return 1;
}

/* The same of a contact that rests by itself: the modes do not move it, but its base may part from those that hold. */
static int watch_parting(struct build *b, struct watch *all, size_t *used, size_t i)
{
    struct watch *w = &all[*used];
    if (!create_watch(b, w, i)) {
        return 0;
    }
    *used += watch_belts(b, w, i) != 0;
    finish_watch(b, w);
    return 1;
}

/* f_I = R_II^-1 (J_I AK q + J_I AC q' - J_I load + b_I'), for all that hold, by modes and by harmonics; only those that change at
 * all are watched. */
static int watch_held(struct build *b, struct watch *all, size_t *used)
{
    struct held *h = b->h;
    const size_t n = b->n, m = h->modes, s = h->rest;
    double *by_q = scratch(b, m * s), *by_u = scratch(b, m * s), *wave_r = scratch(b, h->harmonics * s);
    double *wave_i = scratch(b, h->harmonics * s), *ramp = scratch(b, s), *load = scratch(b, n), *x = scratch(b, s);
    if (!by_q || !by_u || !wave_r || !wave_i || !ramp || !load || !x) {
        return 0;
    }
    for (size_t k = 0; k < m; k++) {
        at_rest(b, 1.0, b->ak_phi + k * n, 0.0, by_q + k * s);
        at_rest(b, 1.0, b->ac_phi + k * n, 0.0, by_u + k * s);
        solve_rest(b, by_q + k * s);
        solve_rest(b, by_u + k * s);
    }
    for (size_t w = 0; w < h->harmonics; w++) {
        const struct harmonic *wave = &b->sys->harmonic[w];
        double *f[] = {wave_r + w * s, wave_i + w * s}, *y[] = {b->yr + w * n, b->yi + w * n};
        for (int part = 0; wave->omega != 0.0 && part < 2; part++) {
            memset(load, 0, n * sizeof *load);
            for (size_t e = 0; !wave->moves_base && e < wave->count; e++) {
                load[wave->index[e]] = part ? wave->sine[e] : -wave->cosine[e];
            }
            if (b->sys->damping.rows) {
                tribo_matrix_multiply_add(&b->sys->damping, 1.0, y[part], load);
            }
            at_rest(b, 1.0, load, 1.0, f[part]);
            memset(load, 0, n * sizeof *load);
            tribo_matrix_multiply_add(&b->sys->stiffness, (part ? 1.0 : -1.0) / wave->omega, y[part], load);
            at_rest(b, 1.0, load, 1.0, f[1 - part]);
            if (wave->moves_base) {
                base_part(b, wave, part, x);
                add(f[1 - part], part ? -wave->omega : wave->omega, x, s);
            }
        }
        solve_rest(b, f[0]);
        solve_rest(b, f[1]);
    }
    memset(load, 0, n * sizeof *load);
    tribo_matrix_multiply_add(&b->sys->stiffness, 1.0, b->y0, load);
    at_rest(b, 1.0, load, 0.0, ramp);
    solve_rest(b, ramp);

    for (size_t p = 0; p < s; p++) {
        int changes = ramp[p] != 0.0;
        for (size_t k = 0; k < m; k++) {
            changes |= by_q[k * s + p] != 0.0 || by_u[k * s + p] != 0.0;
        }
        for (size_t w = 0; w < h->harmonics; w++) {
            changes |= wave_r[w * s + p] != 0.0 || wave_i[w * s + p] != 0.0;
        }
        if (!changes) {
            continue;
        }
        struct watch *watch = &all[(*used)++];
        if (!create_watch(b, watch, b->rest[p])) {
            return 0;
        }
        watch->ramp = ramp[p];
        for (size_t k = 0; k < m; k++) {
            watch->on_rate[k] = by_q[k * s + p];
            watch_mode(b, watch, k, by_q[k * s + p], by_u[k * s + p]);
        }
        for (size_t w = 0; w < h->harmonics; w++) {
            watch->rr[w] += wave_r[w * s + p];
            watch->ri[w] += wave_i[w * s + p];
        }
        finish_watch(b, watch);
    }
    return 1;
}

static int find_watches(struct build *b)
{
    struct held *h = b->h;
    const size_t c = b->sys->ncontact;
    h->watch = take(&h->memory, &h->bytes, c, sizeof *h->watch);
    if (!h->watch) {
        return 0;
    }
    for (size_t i = 0; i < c; i++) {
        const int done = h->key[i] == 0   ? watch_sliding(b, &h->watch[h->watches++], i)
                         : h->key[i] == 1 ? watch_parting(b, h->watch, &h->watches, i)
                                          : 1;
        if (!done) {
            return 0;
        }
    }
    h->sliding = h->watches;
    return watch_held(b, h->watch, &h->watches);
}

/* Keeps modes and belt velocities for the degrees of freedom that move. */
static int compress(struct build *b)
{
    struct held *h = b->h;
    const size_t n = b->n, m = h->modes, s = h->harmonics;
    h->dof = keep_indices(b, n);
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
    h->phi = keep(b, m * h->moving);
    h->psi = keep(b, m * h->moving);
    h->yr = keep(b, s * h->moving);
    h->yi = keep(b, s * h->moving);
    h->y0 = keep(b, h->moving);
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
    struct held *h = b->h;
    h->key = take(&h->memory, &h->bytes, b->sys->ncontact, 1);
    for (size_t i = 0; h->key && i < b->sys->ncontact; i++) {
        h->key[i] = (signed char)((mode[i] == 0) + holds[i]);
    }
    if (!h->key || !list_rest(b, holds) || (!b->r_diagonal && !factorize_rest(b)) ||
        !(holds_single_dofs(b) ? modes_by_elimination(b) : modes_by_projection(b)) || !complete_modes(b)) {
        return TRIBO_ERR_MEMORY;
    }
    const int status = h->coupling ? exponents_coupled(b) : exponents_decoupled(b);
    if (status) {
        return status;
    }
    h->size = keep(b, h->exponents);
    for (size_t p = 0; h->size && p < h->exponents; p++) {
        h->size[p] = hypot(h->lr[p], h->li[p]);
        h->fastest = greater(h->fastest, h->size[p]);
    }
    const int done = h->size && find_forcing(b) && find_response(b) && find_watches(b) && compress(b);
    return done ? TRIBO_OK : b->status ? b->status : TRIBO_ERR_MEMORY;
}

int tribo_held_create(struct held **held, tribo_system *sys, const signed char *mode, const unsigned char *holds)
{
    struct build b = {.sys = sys, .n = sys->ndof, .h = calloc(1, sizeof *b.h)};
    int status = b.h ? build(&b, mode, holds) : TRIBO_ERR_MEMORY;
    give_back(b.scratch);
    tribo_cholesky_free(&b.r);
    if (status) {
        tribo_held_free(b.h);
        return status == TRIBO_ERR_MEMORY ? tribo_system_fail(sys, status, "out of memory for the modes of a held structure")
                                          : status;
    }
    *held = b.h;
    return TRIBO_OK;
}
