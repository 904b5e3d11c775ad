/* SPDX-License-Identifier: BSD-3-Clause */
/* The motions of a reduced structure: its lowest modes, found densely or by Lanczos' method, and static responses to forces at
 * its contacts. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/layout.h"
#include "common/real.h"
#include "lanczos.h"
#include "dynamics/system/model.h"
#include "normal_modes.h"

/* SHIFT: shift over the mean omega^2 of the degrees of freedom, weighted by mass: far below elastic omega^2, far above rounding
 * in rigid-body motions. If K + shift M is not definite, the shift grows by MORE, below MOST_SHIFT. */
#define SHIFT 1e-9
#define MORE 1e3
#define MOST_SHIFT 1e-3

/* For a singular M, M + SLIGHT K/(mean omega^2) is factored, which is definite if M is semidefinite. */
#define SLIGHT 1e-12

/* The factor of K + shift M must reproduce a mode, with an error of omega^2 up to SAME omega^2 + SAME_SHIFT shift; the second
 * term allows for rounding of the factor. */
#define SAME 1e-5
#define SAME_SHIFT 1e-3

/* A force at a contact acts on the modes only, if the rest without their part is at most TAKEN times the force. A response of the
 * other motions is a new attachment mode if its part orthogonal to the other ones is more than OWN times the response. */
#define TAKEN 1e-12
#define OWN 1e-7

/* There is no bound of the truncation if left-out modes may have omega^2 <= ABOVE shift: static responses are inexact for
 * these. */
#define ABOVE 10.0

/* Part of the diagonal added to a flexibility that is singular because displacements of contacts depend on each other. */
#define RIDGE 1e-12

/* The remedy of a message about a mode in doubt. */
#define FEWER "reduce the system to fewer modes"

/* K + shift M and its factor. */
struct shifted {
    double shift;
    struct cholesky factor;
};

/* ------------------------------------------------------------------------------------------------------------------- messages */

/* Writes the message for a status of a search that found `count` modes. Returns the status. */
static int search_failed(const tribo_model *m, int status, size_t count)
{
    return !status || status == TRIBO_ERR_MEMORY ? status
           : status == TRIBO_ERR_SIZE
               ? tribo_error(m->message, status, "nmode = %zu, but the mass matrix lets the structure have %zu mode%s only",
                             m->nmode, count, plural(count))
               : tribo_error(m->message, status,
                             "nmode = %zu: these modes are not found, or not counted; reduce the system to fewer or more",
                             m->nmode);
}

/* ---------------------------------------------------------------------------------------------------------------- the factors */

/* Returns sum |K_ii| / sum |M_ii|; 1 without stiffness, 0 without mass. */
static double mean_square_frequency(const tribo_model *m)
{
    double stiffness = 0.0, mass = 0.0;
    for (size_t i = 0; i < m->ndof; i++) {
        stiffness += fabs(tribo_matrix_get(&m->stiffness, i, i));
        mass += fabs(tribo_matrix_get(&m->mass, i, i));
    }
    return !(mass > 0.0) ? 0.0 : stiffness > 0.0 ? greater(stiffness / mass, 1e-200) : 1.0;
}

/* Sets *c = the factor of factor K + other M. Returns a status. */
static int factorize_sum(const tribo_model *m, double factor, double other, struct cholesky *c, size_t *where)
{
    struct matrix sum;
    double pivot;
    memset(c, 0, sizeof *c);
    if (!tribo_matrix_sum(&sum, factor, &m->stiffness, other, &m->mass)) {
        return TRIBO_ERR_MEMORY;
    }
    return tribo_cholesky_create(c, &sum, &sum, where, &pivot);
}

static int factor_failed(const tribo_model *m, int status, const char *what, size_t where)
{
    return status == TRIBO_ERR_INDEFINITE
               ? tribo_error(m->message, status, "%s is not positive semidefinite: it shows at degree of freedom %zu", what,
                             where)
           : status == TRIBO_ERR_SIZE ? tribo_model_too_large(m)
                                      : status;
}

static int factorize_shifted(const tribo_model *m, struct shifted *s)
{
    const double mean = mean_square_frequency(m);
    size_t where = 0;
    int status = TRIBO_ERR_INDEFINITE;
    if (!(mean > 0.0)) {
        return tribo_error(m->message, TRIBO_ERR_INDEFINITE, "mass is zero");
    }
    for (double part = SHIFT; status == TRIBO_ERR_INDEFINITE && part < MOST_SHIFT; part *= MORE) {
        s->shift = part * mean;
        status = factorize_sum(m, 1.0, s->shift, &s->factor, &where);
    }
    return factor_failed(m, status, "stiffness", where);
}

/* Returns TRIBO_ERR_INDEFINITE, and the row *where, if M is not semidefinite. For large M only minors of two rows are checked,
 * |M_ij| <= sqrt(M_ii M_jj): with a positive definite K the low modes are right whatever M does to the high ones. */
static int check_mass(const tribo_model *m, size_t *where)
{
    const struct matrix *mass = &m->mass;
    struct cholesky c;
    for (size_t i = 0; i < mass->rows; i++) {
        const double own = tribo_matrix_get(mass, i, i);
        for (size_t k = mass->first[i]; k < mass->first[i + 1]; k++) {
            const double other = tribo_matrix_get(mass, mass->col[k], mass->col[k]);
            if (own < 0.0 || fabs(mass->val[k]) > (1.0 + 1e-9) * sqrt(own) * sqrt(fabs(other))) {
                *where = i;
                return TRIBO_ERR_INDEFINITE;
            }
        }
    }
    if (m->ndof > DENSE_MOST || tribo_matrix_is_diagonal(mass)) {
        return TRIBO_OK;
    }
    const int status = factorize_sum(m, SLIGHT / mean_square_frequency(m), 1.0, &c, where);
    tribo_cholesky_free(&c);
    return status;
}

/* ------------------------------------------------------------------------------------------------------------------ the modes */

/* Finds the `wanted` lowest modes among combinations of x [count][ndof], which may be r->phi. Stiffer motions are unknown here:
 * omega^2 is computed without rounding of the largest entries, by tribo_matrix_form. Returns a status. */
static int find_among(const tribo_model *m, size_t count, const double *x, size_t wanted, struct reduced *r)
{
    const size_t n = m->ndof;
    struct matrix rows = {0}, z = {0}, mass = {0};
    struct cholesky c = {0};
    const struct modes_text text = {m->message, "", FEWER};
    size_t where;
    double pivot, *product = malloc(count * count * sizeof *product);
    const int done = product && tribo_matrix_from_dense(&rows, count, n, x) && tribo_matrix_transpose(&z, &rows) &&
                     tribo_matrix_congruent(&m->mass, &z, product) && tribo_matrix_from_dense(&mass, count, count, product);
    tribo_matrix_free(&rows);
    free(product);
    int status = done ? tribo_cholesky_create(&c, &mass, &mass, &where, &pivot) : TRIBO_ERR_MEMORY;
    status = search_failed(m, status, 0);
    status = status ? status : tribo_normal_modes(&m->stiffness, NULL, &z, &c, wanted, r->omega2, r->phi, &text);
    tribo_cholesky_free(&c);
    tribo_matrix_free(&z);
    for (size_t k = 0; !status && k < wanted; k++) {
        const double *phi = r->phi + k * n;
        r->omega2[k] = r->omega2[k] != 0.0 ? tribo_matrix_form(&m->stiffness, phi, phi) : 0.0;
    }
    r->count = wanted;
    return status;
}

/* Checks that rounding moves no mode across low->above, where modes were counted; and that each mode is an eigenvector, by SAME
 * and SAME_SHIFT: with the norms in M of (omega^2 + shift) (K + shift M)^-1 M phi - phi. Returns a status. */
static int check_modes(const tribo_model *m, const struct shifted *s, const struct low_modes *low, const struct reduced *r)
{
    const size_t n = m->ndof, below = low->below < r->count ? low->below : r->count;
    double *root = malloc(3 * n * sizeof *root), *x = root + n, *mx = x + n;
    int right = 1;
    if (!root) {
        return TRIBO_ERR_MEMORY;
    }
    tribo_matrix_roots(&m->stiffness, NULL, root);
    for (size_t k = 0; right && k < r->count; k++) {
        const double *phi = r->phi + k * n, omega2 = r->omega2[k],
                     distance = k < below ? low->above - omega2 : omega2 - low->above;
        if (k <= below && k + 1 >= below) {
            right = distance > low->growth * tribo_matrix_noise(&m->stiffness, root, phi, phi);
        }
        tribo_matrix_multiply(&m->mass, phi, x);
        tribo_cholesky_solve(&s->factor, 1, x);
        for (size_t i = 0; i < n; i++) {
            x[i] = (omega2 + s->shift) * x[i] - phi[i];
        }
        tribo_matrix_multiply(&m->mass, x, mx);
        right &= sqrt(fabs(tribo_dot(x, mx, n))) * (omega2 + s->shift) <= SAME * omega2 + SAME_SHIFT * s->shift;
    }
    free(root);
    return right ? TRIBO_OK : TRIBO_ERR_NO_CONVERGENCE;
}

/* Finds the lowest modes: by Lanczos' method for large structures with few modes, and for singular mass. Returns a status. */
static int find_lowest(const tribo_model *m, struct shifted *s, struct reduced *r)
{
    const int large = m->ndof > DENSE_MOST || (m->ndof >= SPARSE_LEAST && 4 * m->nmode <= m->ndof);
    size_t where = 0;
    if (!large || !tribo_cholmod) {
        const struct matrix whole = {0};
        const struct modes_text text = {m->message, "", FEWER};
        struct cholesky mass = {0};
        int status = m->ndof > DENSE_MOST ? tribo_model_too_large(m) : tribo_model_factorize(m, &mass);
        status = status ? status : tribo_normal_modes(&m->stiffness, NULL, &whole, &mass, m->nmode, r->omega2, r->phi, &text);
        tribo_cholesky_free(&mass);
        r->count = m->nmode;
        r->truncation.above = m->nmode == m->ndof ? HUGE_VAL : status ? 0.0 : r->omega2[m->nmode - 1];
        if (status != TRIBO_ERR_INDEFINITE || !tribo_cholmod || check_mass(m, &where) == TRIBO_ERR_INDEFINITE) {
            return status || r->omega2[0] < 0.0 ? status : factorize_shifted(m, s);
        }
    }
    struct low_modes low;
    int status = check_mass(m, &where);
    status = factor_failed(m, status, "mass", where);
    status = status ? status : factorize_shifted(m, s);
    if (status) {
        return status;
    }
    status = tribo_low_modes(&m->stiffness, &m->mass, s->shift, &s->factor, m->nmode, &low);
    status = status ? search_failed(m, status, low.count) : find_among(m, low.count, low.phi, m->nmode, r);
    free(low.phi);
    if (status) {
        return status;
    }
    r->truncation.above = low.below == m->nmode ? low.above : r->omega2[m->nmode - 1];
    return search_failed(m, check_modes(m, s, &low, r), 0);
}

/* ----------------------------------------------------------------------------------------------------------- attachment modes */

/* Makes x orthogonal in M to `count` phi_k, orthonormal in M. Sets mx [ndof] = M x. Returns the norm of x in M. */
static double low_modes_separate(const tribo_model *m, size_t count, const double *phi, double *x, double *mx)
{
    tribo_matrix_multiply(&m->mass, x, mx);
    tribo_separate(&m->mass, count, phi, 1, x, mx, 0, NULL);
    const double square = tribo_dot(x, mx, m->ndof);
    return square > 0.0 ? sqrt(square) : 0.0;
}

/* Returns |x'Kx|/norm^2. Below shift/2 no stiffness holds x, and a static response does not exist. */
static double square_frequency(const tribo_model *m, const double *x, double norm)
{
    return norm > 0.0 ? fabs(tribo_matrix_form(&m->stiffness, x, x)) / norm / norm : HUGE_VAL;
}

/* Appends the part of x [ndof], orthogonal to the modes and with norm `whole` in M, that is orthogonal to the other attachment
 * modes, unless it is rounding. If that is a drift with a small elastic part, removes the elastic part by inverse iteration. mx
 * [ndof]: workspace. */
static void add_attachment(const tribo_model *m, const struct shifted *s, struct reduced *r, double *x, double whole, double *mx)
{
    const size_t n = m->ndof;
    double norm = low_modes_separate(m, r->count - m->nmode, r->phi + m->nmode * n, x, mx), before = HUGE_VAL;
    if (!(norm > OWN * whole)) {
        return;
    }
    double omega2 = square_frequency(m, x, norm);
    while (omega2 < lesser(0.5 * s->shift, 0.25 * before)) {
        before = omega2;
        memset(x, 0, n * sizeof *x); /* mx = M x, by low_modes_separate */
        tribo_add(x, s->shift, mx, n);
        tribo_cholesky_solve(&s->factor, 1, x);
        norm = low_modes_separate(m, r->count, r->phi, x, mx);
        omega2 = square_frequency(m, x, norm);
    }
    for (size_t k = 0; k < n; k++) {
        r->phi[r->count * n + k] = x[k] / norm;
    }
    r->count++;
}

/* x [ndof] = the static response, beside the modes, to a force at contact i. The force is taken without the part that acts on the
 * modes, M Phi Phi'force. A second solution removes the effect of shift except shift^2: x += (K + shift M)^-1 shift M x. before,
 * mx [ndof]: workspace. Returns the norm of x in M. */
static double contact_response(const tribo_model *m, const struct shifted *s, const struct reduced *r, size_t i, double *x,
                               double *before, double *mx)
{
    const size_t n = m->ndof;
    tribo_matrix_get_row(&m->direction, i, x);
    const double whole = tribo_dot(x, x, n);
    for (int pass = 0; pass < 2; pass++) {
        memset(mx, 0, n * sizeof *mx);
        for (size_t k = 0; k < m->nmode; k++) {
            tribo_add(mx, -tribo_dot(r->phi + k * n, x, n), r->phi + k * n, n);
        }
        tribo_matrix_multiply_add(&m->mass, 1.0, mx, x);
    }
    const int taken = !(tribo_dot(x, x, n) > TAKEN * TAKEN * whole);
    double norm = 0.0;
    memset(before, 0, n * sizeof *before);
    memset(x, 0, taken ? n * sizeof *x : 0);
    for (int solution = 0; !taken && solution < 2; solution++) {
        if (solution) {
            memcpy(before, x, n * sizeof *x);
            memset(x, 0, n * sizeof *x);
            tribo_add(x, s->shift, mx, n);
        }
        tribo_cholesky_solve(&s->factor, 1, x);
        tribo_add(x, 1.0, before, n);
        norm = low_modes_separate(m, m->nmode, r->phi, x, mx);
    }
    return norm;
}

/* Sets *part = the largest x'Ax/x'Bx, A [n][n] semidefinite and a part of B, to rounding of the diagonal of B; 1 if B is lost
 * in the rounding of a subtraction, as of rigid-body motions. Overwrites a and b. value [n]: workspace. Returns 0 if out of
 * memory. */
static int largest_part(size_t n, double *a, double *b, double *value, double *part)
{
    struct matrix whole = {0};
    struct cholesky c = {0};
    size_t where;
    double pivot;
    for (size_t i = 0; i < n; i++) {
        b[i * n + i] += b[i * n + i] > 0.0 ? RIDGE * b[i * n + i] : 1.0;
    }
    int status =
        tribo_matrix_from_dense(&whole, n, n, b) ? tribo_cholesky_create(&c, &whole, &whole, &where, &pivot) : TRIBO_ERR_MEMORY;
    status = status ? status : tribo_symmetric_eigen_by(&c, a, n, value, b);
    *part = status ? 1.0 : clamp(n ? value[n - 1] : 0.0, 0.0, 1.0);
    tribo_cholesky_free(&c);
    return status != TRIBO_ERR_MEMORY;
}

/* Keeps the static responses of contacts beside the modes, or adds attachment modes to r, and makes all motions orthogonal in K.
 * Sets r->flexibility and r->truncation.missing. Returns a status. */
static int attach(const tribo_model *m, const struct shifted *s, struct reduced *r)
{
    const size_t n = m->ndof, c = m->ncontact;
    double *x = malloc((3 * n + 2 * c * c + c) * sizeof *x);
    double *mx = x + n, *missing = mx + 2 * n, *whole = missing + c * c, *work = whole + c * c; /* missing: J x in rows */
    int status = x ? TRIBO_OK : TRIBO_ERR_MEMORY;
    for (size_t i = 0; !status && i < c; i++) {
        const double norm = contact_response(m, s, r, i, x, mx + n, mx);
        tribo_matrix_multiply(&m->direction, x, missing + i * c);
        if (r->residual && square_frequency(m, x, norm) < 0.5 * s->shift) {
            status = tribo_error(m->message, TRIBO_ERR_UNSUPPORTED,
                                 "nmode = %zu leaves out a motion that contact %zu moves and no stiffness holds: take "
                                 "more modes, or TRIBO_STATICS_MASS",
                                 m->nmode, i);
        } else if (r->residual) {
            memcpy(r->residual + i * n, x, n * sizeof *x);
        } else if (m->attachments) {
            add_attachment(m, s, r, x, norm, mx);
        }
    }
    if (!status && r->flexibility) {
        memcpy(r->flexibility, missing, c * c * sizeof *missing);
        tribo_even_out(c, r->flexibility);
    }
    r->truncation.missing = c > m->nmode ? 1.0 : 0.0;
    if (!status && c <= m->nmode) {
        memcpy(whole, missing, c * c * sizeof *whole);
        for (size_t k = 0; k < m->nmode; k++) { /* the elastic part of the modes, J phi phi'J'/omega^2 */
            tribo_matrix_multiply(&m->direction, r->phi + k * n, work);
            for (size_t i = 0; r->omega2[k] > 0.0 && i < c; i++) {
                tribo_add(whole + i * c, work[i] / r->omega2[k], work, c);
            }
        }
        status = largest_part(c, missing, whole, work, &r->truncation.missing) ? TRIBO_OK : TRIBO_ERR_MEMORY;
    }
    free(x);
    return status || r->count == m->nmode ? status : find_among(m, r->count, r->phi, r->count, r);
}

/* ------------------------------------------------------------------------------------------------------------------ calls */

int tribo_model_find_modes(const tribo_model *m, struct reduced *r)
{
    const size_t n = m->ndof, most = m->nmode + (m->attachments ? m->ncontact : 0);
    struct shifted s = {0.0, {0}};
    *r = (struct reduced){.truncation.order = m->attachments ? 2.0 : m->flexible ? 1.0 : 0.0};
    const size_t c = m->flexible ? m->ncontact : 0;
    int status = TRIBO_ERR_MEMORY;
    if (ALLOCATE(ARRAY(r->omega2, most), ARRAY(r->phi, most * n), ARRAY(r->residual, c * n), ARRAY(r->flexibility, c * c))) {
        r->residual = m->flexible ? r->residual : NULL;
        r->flexibility = m->flexible ? r->flexibility : NULL;
        status = find_lowest(m, &s, r);
    }
    if (!status && r->omega2[0] < 0.0) {
        status = tribo_error(m->message, TRIBO_ERR_INDEFINITE, "stiffness is not positive semidefinite: omega^2 = %g of mode 0",
                             r->omega2[0]);
    }
    status = status || m->nmode == n || !m->ncontact ? status : attach(m, &s, r);
    r->truncation.above = r->truncation.above > ABOVE * s.shift ? r->truncation.above : 0.0;
    tribo_cholesky_free(&s.factor);
    return status;
}
