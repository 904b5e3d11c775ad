/* SPDX-License-Identifier: BSD-3-Clause */
#include "system.h"
#include "common/real.h"
#include "common/layout.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int tribo_error(char *message, int status, const char *format, ...)
{
    if (message) {
        va_list args;
        va_start(args, format);
        vsnprintf(message, TRIBO_MESSAGE, format, args);
        va_end(args);
    }
    return status;
}

static int is_in(enum range range, double x)
{
    return isfinite(x) && (range == FINITE || x > 0.0 || (range == NOT_NEGATIVE && x == 0.0));
}

int tribo_check_number(char *message, enum range range, double x, const char *format, ...)
{
    static const char *const text[] = {"is not finite", "is negative", "is not positive"};
    static const int error[] = {TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_NOT_POSITIVE};
    char subject[TRIBO_MESSAGE];
    va_list args;
    if (is_in(range, x)) {
        return TRIBO_OK;
    }
    const int which = isfinite(x) ? (int)range : FINITE;
    va_start(args, format);
    vsnprintf(subject, sizeof subject, format, args);
    va_end(args);
    return tribo_error(message, error[which], "%s %s", subject, text[which]);
}

int tribo_check_array(char *message, enum range range, const char *name, const double *x, size_t n)
{
    size_t i = 0;
    while (x && i < n && is_in(range, x[i])) {
        i++;
    }
    return x && i < n ? tribo_check_number(message, range, x[i], "%s[%zu] = %g", name, i, x[i]) : TRIBO_OK;
}

int tribo_check_numbers(char *message, size_t n, const char *const *name, const double *x)
{
    size_t worst = 0;
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += x[i];
        worst = isfinite(x[worst]) && !(fabs(x[i]) <= fabs(x[worst])) ? i : worst;
    }
    return isfinite(sum) ? TRIBO_OK
                         : tribo_error(message, TRIBO_ERR_NOT_FINITE, "%s = %g is %s", name[worst], x[worst],
                                       isfinite(x[worst]) ? "too large" : "not finite");
}

int tribo_system_explain(const tribo_system *sys, int status)
{
    return status ? tribo_error(sys->message, status, "%s", tribo_message(sys->contacts)) : TRIBO_OK;
}

const char *tribo_system_message(const tribo_system *sys)
{
    return sys ? sys->message : "sys is NULL";
}

int tribo_system_check_mass(const tribo_system *sys, const char *who)
{
    const struct expansion *x = &sys->expansion;
    size_t d = 0;
    while (x->place && x->place[d] < sys->ndof) {
        d++;
    }
    return x->place ? tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                                  "%s needs mass, and degree of freedom %zu has none: take exact, event or moreau/fixed", who, d)
                    : TRIBO_OK;
}

int tribo_system_check_solved(const tribo_system *sys, const char *what)
{
    return sys->unsolved
               ? tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                             "%s needs accelerations: %zu degree%s of freedom are more than the %d that are solved for with a "
                             "mass matrix that is not diagonal; take moreau/fixed, or tribo_system_reduce",
                             what, sys->ndof, plural(sys->ndof), DENSE_MOST)
               : TRIBO_OK;
}

int tribo_system_check_contacts(const tribo_system *sys, const char *method, int scalar)
{
    const int springs = sys->expansion.place != NULL;
    const size_t planar = scalar > 0 || (springs && scalar == 0) ? tribo_system_planar(sys) : 0;
    if (planar) {
        return tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                           "method %s knows no planar contacts%s, of which the system has %zu%s", method,
                           springs ? " where degrees of freedom have no mass" : "", planar, springs ? "" : ": take event");
    }
    if (springs) {
        tribo_get_static(sys->contacts, sys->work.feq, NULL);
    }
    for (size_t k = 0; k < sys->compliance.count; k++) {
        const size_t i = sys->compliance.contact[k];
        if (sys->work.feq[i] > 1.0) {
            return tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                               "contact %zu is elastic, and takes no static limit: ratio[%zu] = %g", i, i, sys->work.feq[i]);
        }
    }
    return TRIBO_OK;
}

int tribo_system_check_given(const tribo_system *sys, const void *argument, const char *name)
{
    return !sys ? TRIBO_ERR_NULL : argument ? TRIBO_OK : tribo_error(sys->message, TRIBO_ERR_NULL, "%s is NULL", name);
}

int tribo_system_check_state(const tribo_system *sys, double t, const double *y)
{
    int status = tribo_check_number(sys->message, FINITE, t, "t = %g", t);
    status = status ? status : tribo_system_check_given(sys, y, "y");
    return status ? status : tribo_check_array(sys->message, FINITE, "y", y, tribo_system_dimension(sys));
}

/* -------------------------------------------------------------------------------------------------------------------- queries */

size_t tribo_system_revision(const tribo_system *sys)
{
    return sys->revision + sys->settings.changes;
}

size_t tribo_system_planar(const tribo_system *sys)
{
    size_t planar = 0;
    tribo_get_count(sys->contacts, TRIBO_COUNT_PLANAR, &planar);
    return planar;
}

int tribo_system_find_pairs(const tribo_system *sys, unsigned char *pair)
{
    const size_t c = sys->ncontact;
    memset(pair, PAIR_NONE, c);
    if (!tribo_system_planar(sys)) {
        return TRIBO_OK;
    }
    tribo_context *probe = NULL;
    double *one;
    signed char *slip;
    int status = ALLOCATE(ARRAY(one, c), ARRAY(slip, c)) ? tribo_clone(sys->contacts, &probe) : TRIBO_ERR_MEMORY;
    for (size_t i = 0; !status && i < c; i++) {
        one[i] = 1.0;
    }
    status = status ? status : tribo_set_law(probe, TRIBO_COULOMB);
    status = status ? status : tribo_set_limit(probe, one);
    status = status ? status : tribo_balance(probe, one, one, NULL, one);
    status = status ? status : tribo_get_slip(probe, slip);
    for (size_t i = 0; !status && i < c; i++) {
        pair[i] = i > 0 && pair[i - 1] == PAIR_FIRST ? PAIR_SECOND : slip[i] == TRIBO_SLIP_PLANE ? PAIR_FIRST : PAIR_NONE;
    }
    free(one);
    tribo_destroy(probe);
    return status ? tribo_error(sys->message, status, "%s, of planar contacts", tribo_strerror(status)) : TRIBO_OK;
}

size_t tribo_system_ndof(const tribo_system *sys)
{
    return sys ? sys->expansion.dofs - sys->expansion.sliders : 0;
}

size_t tribo_system_ncontact(const tribo_system *sys)
{
    return sys ? sys->ncontact : 0;
}

size_t tribo_system_dimension(const tribo_system *sys)
{
    return sys ? 2 * tribo_system_ndof(sys) + sys->expansion.sliders + 1 : 0;
}

int tribo_dynamics_has(int feature)
{
#if defined(TRIBO_CHOLMOD)
    return feature == TRIBO_FEATURE_CHOLMOD;
#else
    (void)feature;
    return 0;
#endif
}

tribo_context *tribo_system_context(tribo_system *sys)
{
    if (sys && !sys->lent && tribo_clone(sys->contacts, &sys->lent) == TRIBO_OK) {
        tribo_fix_operator(sys->lent);
        if (tribo_system_limits_vary(sys)) {
            tribo_set_limit(sys->lent, sys->loads.given_limit);
        }
        tribo_get_count(sys->lent, TRIBO_COUNT_SETTINGS, &sys->settings.copied);
    }
    return sys ? sys->lent : NULL;
}

int tribo_system_take_settings(tribo_system *sys)
{
    size_t now = 0;
    if (!sys->lent || tribo_get_count(sys->lent, TRIBO_COUNT_SETTINGS, &now) || now == sys->settings.copied) {
        return TRIBO_OK;
    }
    tribo_get_limit(sys->lent, sys->work.put_limit);
    int status = tribo_normals_check_limits(sys, sys->work.put_limit);
    if (status) {
        return status;
    }
    status = tribo_system_explain(sys, tribo_copy_settings(sys->contacts, sys->lent));
    status = status ? status : tribo_normals_pair(sys);
    if (!status) {
        tribo_get_limit(sys->lent, sys->loads.given_limit);
        sys->settings.copied = now;
        sys->settings.changes++;
        sys->loads.time = NAN;
    }
    return status;
}

int tribo_system_get_slip(const tribo_system *sys, signed char *slip)
{
    const int status = sys ? tribo_get_slip(sys->contacts, slip) : TRIBO_ERR_NULL;
    static const char early[] = "no forces of contacts were computed yet: call tribo_system_contacts";
    return status && sys ? tribo_error(sys->message, status, "%s", slip ? early : "slip is NULL") : status;
}

int tribo_system_get_count(const tribo_system *sys, int which, size_t *value)
{
    const int status = sys ? tribo_get_count(sys->contacts, which, value) : TRIBO_ERR_NULL;
    return !status || !sys ? status
           : value         ? tribo_error(sys->message, status, "which = %d is no count", which)
                           : tribo_error(sys->message, status, "value is NULL");
}

int tribo_system_get_limit(tribo_system *sys, double t, double *limit)
{
    int status = sys ? tribo_check_number(sys->message, FINITE, t, "t = %g", t) : TRIBO_ERR_NULL;
    status = status || sys->ncontact == 0 ? status : tribo_system_check_given(sys, limit, "limit");
    if (!status && sys->normals.count) {
        return tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                           "the limit of contact %zu follows its normal load, and is no function of time: tribo_system_contacts "
                           "finds the loads by the state",
                           sys->normals.follower[0].contact);
    }
    status = status ? status : tribo_system_take_settings(sys);
    if (!status) {
        tribo_system_set_time(sys, t);
        tribo_get_limit(sys->contacts, limit);
    }
    return status;
}

int tribo_system_set_message(tribo_system *sys, int status, const char *text)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    sys->status = tribo_error(sys->message, status, "%s", text ? text : "");
    return status;
}

/* ------------------------------------------------------------------------------------------------------------------ structure */

void tribo_system_solve_mass(const tribo_system *sys, double *x)
{
    if (sys->factor.factor || sys->factor.sparse) {
        tribo_cholesky_solve(&sys->factor, 1, x);
    }
    for (size_t d = 0; !sys->factor.factor && !sys->factor.sparse && !sys->unsolved && d < sys->ndof; d++) {
        x[d] *= 1.0 / tribo_matrix_get(&sys->mass, d, d);
    }
}

void tribo_system_accelerate(const tribo_system *sys, const double *force, double *to, double *way)
{
    const size_t dofs = sys->expansion.dofs;
    memset(to, 0, sys->ndof * sizeof *to);
    for (size_t i = 0; i < sys->reduced.given; i++) {
        if (!sys->reduced.modes) {
            tribo_system_add_part(sys, i, force[i], to, way);
        }
        for (size_t j = 0; sys->reduced.modes && j < dofs; j++) {
            tribo_system_add_part(sys, j, sys->reduced.modes[i * dofs + j] * force[i], to, way);
        }
    }
    tribo_system_solve_mass(sys, to);
}

double tribo_system_fastest(const tribo_system *sys)
{
    const double stiffest = sys->compliance.count ? sys->compliance.stiffest : tribo_matrix_row_sum(&sys->stiffness);
    return greater(greater(sqrt(stiffest + 2.0 * sys->circulation + sys->normals.stiffest), tribo_matrix_row_sum(&sys->damping)),
                   tribo_system_load_frequency(sys));
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

size_t tribo_system_first_dropping(const tribo_system *sys, int falls)
{
    const double *ratio = sys->work.feq, *velocity = sys->work.dv_dt;
    size_t i = 0;
    tribo_get_static(sys->contacts, sys->work.feq, falls ? sys->work.dv_dt : NULL);
    while (i < sys->ncontact && !(ratio[i] > 1.0 && (!falls || velocity[i] > 0.0))) {
        i++;
    }
    return i;
}

int tribo_system_is_plain(const tribo_system *sys)
{
    return !tribo_system_planar(sys) && tribo_system_first_dropping(sys, 0) == sys->ncontact;
}

void tribo_system_rest_limits(const tribo_system *sys, double *limit)
{
    tribo_get_limit(sys->contacts, limit);
    tribo_get_static(sys->contacts, sys->work.feq, NULL);
    for (size_t i = 0; i < sys->ncontact; i++) {
        limit[i] *= sys->work.feq[i];
    }
}

int tribo_system_falls(const tribo_system *sys)
{
    return tribo_system_first_dropping(sys, 1) < sys->ncontact;
}

/* ------------------------------------------------------------------------------------------------------------- attached data */

struct attached {
    const void *key;
    void *data;
    void (*destroy)(void *data);
    struct attached *next;
};

static const struct attached *attached_find(const tribo_system *sys, const void *key)
{
    const struct attached *a = sys ? sys->attached : NULL;
    while (a && a->key != key) {
        a = a->next;
    }
    return a;
}

int tribo_system_attach(tribo_system *sys, const void *key, void *data, void (*destroy)(void *data))
{
    const int status = tribo_system_check_given(sys, key, "key");
    if (status) {
        return status;
    }
    if (attached_find(sys, key)) {
        return tribo_error(sys->message, TRIBO_ERR_STATE, "data of this key is attached to the system already");
    }
    struct attached *a = malloc(sizeof *a);
    if (!a) {
        return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for data attached to the system");
    }
    *a = (struct attached){key, data, destroy, sys->attached};
    sys->attached = a;
    return TRIBO_OK;
}

void *tribo_system_attached(const tribo_system *sys, const void *key)
{
    const struct attached *a = attached_find(sys, key);
    return a ? a->data : NULL;
}

/* ----------------------------------------------------------------------------------------------------------------------- life */

int tribo_system_build(tribo_system **sys, size_t ndof, size_t ncontact)
{
    const size_t c = ncontact;
    tribo_system *s, new = {.ndof = ndof, .ncontact = c, .loads.time = NAN, .reduced.given = ndof, .expansion.dofs = ndof};
    struct workspace *w = &new.work;
    if (!ALLOCATE(ARRAY(s, 1), ARRAY(w->v, c), ARRAY(w->a, c), ARRAY(w->f, c), ARRAY(w->feq, c), ARRAY(w->dv_dt, c),
                  ARRAY(w->put_limit, c), ARRAY(w->acceleration, ndof), ARRAY(new.loads.given_limit, c), ARRAY(new.tally, c),
                  ARRAY(new.snaps.list, c), ARRAY(new.message, TRIBO_MESSAGE))) {
        return TRIBO_ERR_MEMORY;
    }
    for (size_t i = 0; i < c; i++) {
        new.tally[i] = 1.0;
    }
    *s = new;
    *sys = s;
    return TRIBO_OK;
}

void tribo_system_put_damping(tribo_system *sys, const struct matrix *c, const struct matrix *rates)
{
    tribo_matrix_free(&sys->c);
    tribo_matrix_free(&sys->damping);
    sys->c = *c;
    sys->damping = *rates;
    sys->revision++;
    sys->structure++;
}

int tribo_system_clone(const tribo_system *sys, tribo_system **copy)
{
    const int status = tribo_system_check_given(sys, copy, "copy");
    if (status) {
        return status;
    }
    tribo_system *to = NULL;
    const struct compliance *g = &sys->compliance;
    double *entries = g->factor ? tribo_matrix_to_dense(&g->g) : NULL;
    size_t where;
    const size_t c = sys->ncontact, dofs = sys->expansion.dofs;
    int done = (entries || !g->factor) && tribo_system_build(&to, sys->ndof, c) == TRIBO_OK;
    if (done) {
        to->revision = sys->revision;
        to->reduced = sys->reduced;
        to->unsolved = sys->unsolved;
        to->circulation = sys->circulation;
        to->settings.copied = sys->settings.copied;
        memcpy(to->loads.given_limit, sys->loads.given_limit, c * sizeof *to->loads.given_limit);
        memcpy(to->tally, sys->tally, c * sizeof *to->tally);
        to->reduced.modes = tribo_copy_of(sys->reduced.modes, sys->reduced.given * dofs, sizeof *to->reduced.modes, &done);
        const struct matrix *const from[] = {&sys->stiffness, &sys->damping, &sys->direction, &sys->response,
                                             &sys->k,         &sys->c,       &sys->mass};
        struct matrix *const copies[] = {&to->stiffness, &to->damping, &to->direction, &to->response, &to->k, &to->c, &to->mass};
        for (size_t k = 0; done && k < sizeof from / sizeof *from; k++) {
            done = tribo_matrix_copy(copies[k], from[k]);
        }
    }
    done = done && (!sys->lent || (tribo_clone(sys->lent, &to->lent) == TRIBO_OK && tribo_fix_operator(to->lent) == TRIBO_OK));
    if (done && !sys->unsolved) {
        double pivot;
        done = tribo_cholesky_create(&to->factor, &to->mass, NULL, &where, &pivot) == TRIBO_OK;
    }
    done = done && tribo_clone(sys->contacts, &to->contacts) == TRIBO_OK &&
           (!g->own || tribo_compliance_create(to, g->own, entries, &where) == TRIBO_OK) && tribo_normals_copy(to, sys) &&
           tribo_expansion_copy(to, sys) && tribo_loads_copy(to, sys);
    free(entries);
    if (!done) {
        tribo_system_destroy(to);
        return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for a copy of %zu degree%s of freedom", sys->ndof,
                           plural(sys->ndof));
    }
    *copy = to;
    return TRIBO_OK;
}

void tribo_system_destroy(tribo_system *sys)
{
    if (!sys) {
        return;
    }
    struct matrix *const matrix[] = {&sys->stiffness, &sys->damping, &sys->direction, &sys->response,
                                     &sys->k,         &sys->c,       &sys->mass};
    for (size_t k = 0; k < sizeof matrix / sizeof *matrix; k++) {
        tribo_matrix_free(matrix[k]);
    }
    for (struct attached *a = sys->attached, *next; a; a = next) {
        next = a->next;
        if (a->destroy) {
            a->destroy(a->data);
        }
        free(a);
    }
    tribo_destroy(sys->contacts);
    tribo_destroy(sys->lent);
    tribo_loads_free(sys);
    tribo_cholesky_free(&sys->factor);
    tribo_compliance_free(&sys->compliance);
    tribo_normals_free(&sys->normals);
    tribo_expansion_free(&sys->expansion);
    free(sys->reduced.modes);
    free(sys->work.motion);
    free(sys);
}
