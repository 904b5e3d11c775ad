#include "system.h"
#include "../common/real.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

int tribo_system_fail(const tribo_system *sys, int status, const char *format, ...)
{
    char text[200];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return tribo_set_message(sys->contacts, status, text);
}

int tribo_system_check_mass(const tribo_system *sys, const char *who)
{
    size_t d = 0;
    while (sys->massless.count && !sys->massless.is[d]) {
        d++;
    }
    return sys->massless.count
               ? tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                   "%s needs mass, and degree of freedom %zu has none: take exact, event or moreau/fixed", who, d)
               : TRIBO_OK;
}

int tribo_system_check_solved(const tribo_system *sys, const char *what)
{
    return sys->unsolved ? tribo_system_fail(
                               sys, TRIBO_ERR_UNSUPPORTED,
                               "%s needs accelerations: %zu degree%s of freedom are more than the %d that are solved for with a "
                               "mass matrix that is not diagonal; take moreau/fixed, or tribo_system_reduced",
                               what, sys->ndof, plural(sys->ndof), DENSE_MOST)
                         : TRIBO_OK;
}

int tribo_system_check_rates(const tribo_system *sys, const char *what)
{
    const int status = tribo_system_check_mass(sys, what);
    return status ? status : tribo_system_check_solved(sys, what);
}

int tribo_system_check_state(const tribo_system *sys, double t, const double *y)
{
    if (!isfinite(t)) {
        return tribo_system_fail(sys, TRIBO_ERR_NOT_FINITE, "t = %g is not finite", t);
    }
    if (!y) {
        return tribo_system_fail(sys, TRIBO_ERR_NULL, "y is NULL");
    }
    const size_t dimension = tribo_system_dimension(sys);
    for (size_t i = 0; i < dimension; i++) {
        if (!isfinite(y[i])) {
            return tribo_system_fail(sys, TRIBO_ERR_NOT_FINITE, "y[%zu] = %g is not finite", i, y[i]);
        }
    }
    return TRIBO_OK;
}

/* -------------------------------------------------------------------------------------------------------------------- queries */

size_t tribo_system_revision(const tribo_system *sys)
{
    return sys->revision + tribo_revision(sys->contacts) - sys->ours;
}

size_t tribo_system_planar(const tribo_system *sys)
{
    size_t planar = 0;
    tribo_get_count(sys->contacts, TRIBO_COUNT_PLANAR, &planar);
    return planar;
}

size_t tribo_system_ndof(const tribo_system *sys)
{
    return sys ? sys->ndof : 0;
}

size_t tribo_system_ncontact(const tribo_system *sys)
{
    return sys ? sys->ncontact : 0;
}

size_t tribo_system_dimension(const tribo_system *sys)
{
    return sys ? 2 * sys->ndof + 1 : 0;
}

tribo_context *tribo_system_context(tribo_system *sys)
{
    if (sys) {
        tribo_set_owner(sys->contacts, "a tribo_system");
    }
    return sys ? sys->contacts : NULL;
}

const gsl_odeiv2_system *tribo_system_odeiv2(tribo_system *sys)
{
    return sys ? &sys->odeiv2 : NULL;
}

/* ------------------------------------------------------------------------------------------------------------------ structure */

void tribo_system_add_mass(const tribo_system *sys, double factor, const double *x, double *to)
{
    if (sys->mass.rows) {
        tribo_matrix_multiply_add(&sys->mass, factor, x, to);
    } else {
        tribo_add(to, factor, x, sys->ndof);
    }
}

void tribo_system_accelerate(const tribo_system *sys, const double *force, double *to)
{
    if (sys->modes) {
        for (size_t j = 0; j < sys->ndof; j++) {
            to[j] = 0.0;
        }
        for (size_t i = 0; i < sys->given; i++) {
            for (size_t j = 0; j < sys->ndof; j++) {
                to[j] += sys->modes[i * sys->ndof + j] * force[i];
            }
        }
        return;
    }
    memcpy(to, force, sys->ndof * sizeof *to);
    if (sys->unsolved) {
        return;
    }
    const int diagonal = !sys->factor.factor && !sys->factor.sparse;
    if (!diagonal) {
        tribo_cholesky_solve(&sys->factor, 1, to);
    }
    for (size_t i = 0; diagonal && i < sys->ndof; i++) {
        const double mass = tribo_matrix_get(&sys->mass, i, i);
        to[i] *= mass > 0.0 ? 1.0 / mass : 0.0;
    }
}

double tribo_system_fastest(const tribo_system *sys)
{
    const double stiffest = sys->massless.count ? sys->massless.stiffest : tribo_matrix_row_sum(&sys->stiffness);
    double most = greater(sqrt(stiffest), tribo_matrix_row_sum(&sys->damping));
    for (size_t s = 0; s < sys->harmonics; s++) {
        most = greater(most, fabs(sys->harmonic[s].omega));
    }
    return most;
}

double tribo_system_delassus(const tribo_system *sys, size_t i, size_t j)
{
    const struct matrix *a = &sys->direction;
    double sum = 0.0;
    for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
        sum += a->val[k] * tribo_matrix_get(&sys->response, a->col[k], j);
    }
    return sum;
}

/* How much degree of freedom d gives way to contact i. */
static double yield_of(const tribo_system *sys, size_t d, size_t i)
{
    return sys->unsolved ? 1.0 / tribo_matrix_get(&sys->mass, d, d) : fabs(tribo_matrix_get(&sys->response, d, i));
}

/* Which of its two degrees of freedom a contact at rest moves by rounding of the other: the second, but no heavy one by a light
 * one's. */
static size_t follows(const tribo_system *sys, size_t i, size_t first)
{
    const size_t *dof = sys->direction.col + first;
    return yield_of(sys, dof[1], i) >= 1e-3 * yield_of(sys, dof[0], i);
}

/* Whether two entries of a row of J, of which this is the first, take a difference, or a sum. */
static inline int are_alike(const struct matrix *j, size_t first)
{
    return fabs(j->val[first]) == fabs(j->val[first + 1]);
}

size_t tribo_system_follower(const tribo_system *sys, size_t i)
{
    const struct matrix *j = &sys->direction;
    const size_t first = j->first[i], count = j->first[i + 1] - first;
    return count == 1 ? j->col[first] : count == 2 && are_alike(j, first) ? j->col[first + follows(sys, i, first)] : SIZE_MAX;
}

/* Velocities x of degrees of freedom whose contacts rest on moving bases; known [ndof] is 1 where no other contact is to change
 * them. */
struct snapping {
    const tribo_system *sys;
    const signed char *loose;
    const double *base;
    double *x, *known;
};

/* Contacts at rest on one degree of freedom stop it. Returns how many there are on two, of which they take the difference. */
static size_t snap_single(struct snapping *s)
{
    const struct matrix *j = &s->sys->direction;
    size_t pairs = 0;
    for (size_t i = 0; i < s->sys->ncontact; i++) {
        const size_t first = j->first[i], count = j->first[i + 1] - first;
        if (!s->loose[i] && count == 1) {
            s->x[j->col[first]] = s->base[i] / j->val[first];
            s->known[j->col[first]] = 1.0;
        }
        pairs += !s->loose[i] && count == 2 && are_alike(j, first);
    }
    return pairs;
}

/* How many of the two degrees of freedom of contact i are known; 2 if it does not rest on two. */
static int known_of_pair(const struct snapping *s, size_t i)
{
    const struct matrix *j = &s->sys->direction;
    const size_t first = j->first[i];
    const int is_pair = !s->loose[i] && j->first[i + 1] - first == 2 && are_alike(j, first);
    return is_pair ? (s->known[j->col[first]] != 0.0) + (s->known[j->col[first + 1]] != 0.0) : 2;
}

/* Entry `to` of row i follows the other one. */
static void snap_pair(struct snapping *s, size_t i, size_t to)
{
    const struct matrix *j = &s->sys->direction;
    const size_t from = 2 * j->first[i] + 1 - to;
    s->x[j->col[to]] = (s->base[i] - j->val[from] * s->x[j->col[from]]) / j->val[to];
    s->known[j->col[to]] = s->known[j->col[from]] = 1.0;
}

/* What is known takes the others along; returns how many pairs did. */
static size_t snap_known(struct snapping *s)
{
    const struct matrix *j = &s->sys->direction;
    size_t found = 0;
    for (size_t i = 0; i < s->sys->ncontact; i++) {
        if (known_of_pair(s, i) == 1) {
            snap_pair(s, i, j->first[i] + (s->known[j->col[j->first[i]]] != 0.0));
            found++;
        }
    }
    return found;
}

/* Where nothing is known, the pair with the heaviest body makes a beginning; returns 0 if there is none. */
static size_t snap_heaviest(struct snapping *s)
{
    const struct matrix *j = &s->sys->direction;
    size_t found = s->sys->ncontact;
    double least = HUGE_VAL;
    for (size_t i = 0; i < s->sys->ncontact; i++) {
        const size_t *dof = j->col + j->first[i];
        const double yield = known_of_pair(s, i) ? HUGE_VAL : lesser(yield_of(s->sys, dof[0], i), yield_of(s->sys, dof[1], i));
        found = yield < least ? i : found;
        least = lesser(least, yield);
    }
    if (found == s->sys->ncontact) {
        return 0;
    }
    snap_pair(s, found, j->first[found] + follows(s->sys, found, j->first[found]));
    return 1;
}

void tribo_system_snap(const tribo_system *sys, const signed char *loose, const double *base, double *x)
{
    struct snapping s = {sys, loose, base, x, sys->acceleration};
    memset(s.known, 0, sys->ndof * sizeof *s.known);
    size_t pairs = snap_single(&s);
    for (size_t done = 1; pairs && done; pairs -= done) {
        done = snap_known(&s);
        done = done ? done : snap_heaviest(&s);
    }
}
