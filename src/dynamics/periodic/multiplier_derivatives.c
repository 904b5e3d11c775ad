/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives of a multiplier by parameters p. With D = d image/d x, its eigenvalue lambda, and right and left eigenvectors u, w,
 *     dlambda = w'(dD) u / w'u.
 * (dD) u is found along the motion: V, the perturbation that begins as u, and DV, its derivative by p, which begins as zero.
 * An event of contact i at time t comes later by
 *     dt = -J_i dq'/v_i' where v_i = 0,  dt = (dlimit_i - d|f_i|)/|f_i|' where contact i breaks away,
 * d: by p at constant time. V jumps at stops of rigid contacts only. A phase that lasts dtau longer adds V' dtau to DV, and the
 * damping adds the response of V to damping = 1. A jump V += c (r V), c = q''+ - q''-, r = J_i/v_i', adds to DV
 *     c (r DV) + (dc + c' dt) (r V) - c (r V) J_i (dq''- + q'''- dt)/v_i'.
 * For a set of contacts at rest q'' is linear in the state, the load and the limits, so that all these derivatives are
 * accelerations by changes of these. By the frequency times are those of the motion, not of constant phase.
 * Multipliers depend on loads over limits. */
#include "sensitivity.h"
#include "common/layout.h"
#include "common/real.h"
#include "numerics/linalg.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Columns of w: V, real and imaginary part, then for each parameter DV, likewise. */
struct second {
    struct sensitivity *d;
    size_t count, wide;        /* parameters; columns of w */
    double *w;                 /* [n][wide] */
    double *rate;              /* [n][2] V' at the end of the phase */
    double *before;            /* [n][count] perturbations by p at the end of the phase */
    double *y;                 /* [n] state there */
    double *bend;              /* [count + 1][ndof] change of q'' there by p, and by time */
    double *pull;              /* [count + 1][contacts] change of forces of contacts at rest, likewise */
    double *shift;             /* [count] dt at the end of the phase */
    double *last;              /* [count] dt at its start */
    double *damped;            /* [3][n], and at least [4][contacts], workspace */
    double *z, *after;         /* [n + 1] change of a state; [ndof] of q'' after a jump */
    double *push, *a, *spring; /* [contacts] workspace */
    double *along;             /* [wide] workspace */
    double tau;
    size_t steps; /* of d at the end of the phase */
    int damps;    /* 1: a parameter is the damping */
    int open;     /* 1: the end of the last phase is not yet in w */
    int status;   /* of an event */
};

/* to [ndof], f [contacts] = change of q'' and of the forces of contacts at rest and of elastic ones by the change x->z of the
 * state, the load dt later, and the limits of sliding contacts by parameter p; p = count: none. Returns a status. */
static int find_change(struct second *x, double dt, size_t p, double *to, double *f)
{
    const struct sensitivity *d = x->d;
    struct stick_slip *m = &d->map->events->stick_slip;
    const tribo_system *sys = d->map->sys;
    tribo_compliance_get(sys, x->z, x->spring);
    tribo_system_smooth(sys, 1, dt, x->z, x->z + sys->ndof, x->spring, to);
    if (p < x->count && d->kind[p] == TRIBO_PARAMETER_DAMPING && sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, x->y + sys->ndof, to);
    }
    for (size_t i = 0; i < d->contacts; i++) {
        const signed char slip = m->state.slip[i];
        x->push[i] = p < x->count && tribo_slides(slip) && !tribo_force_is_state(m, i) ? -slip * d->rise[i * x->count + p] : 0.0;
    }
    tribo_matrix_multiply_add(&sys->response, 1.0, x->push, to);
    tribo_matrix_multiply(&sys->direction, to, x->a);
    const int status = tribo_stick_slip_balance(m, x->a, f);
    tribo_matrix_multiply_add(&sys->response, 1.0, f, to);
    tribo_add(f, 1.0, x->spring, d->contacts); /* of elastic contacts, which f lacks */
    return status;
}

/* x->z = change of the state by p at the end of the phase, and dt later; p = count: by dt only. */
static void change_state(struct second *x, size_t p, double dt)
{
    const struct sensitivity *d = x->d;
    const size_t n = d->map->sys->ndof;
    const int by = p < x->count, turns = by && d->kind[p] == TRIBO_PARAMETER_FREQUENCY;
    memcpy(x->z, x->y + n, n * sizeof *x->z);
    memcpy(x->z + n, d->variation.acceleration, n * sizeof *x->z);
    tribo_compliance_put(d->map->sys, d->variation.spring_rate, x->z);
    for (size_t i = 0; i < d->n; i++) {
        const double turned = turns && i >= n && i < 2 * n ? x->y[i] : 0.0;
        x->z[i] = (by ? x->before[i * x->count + p] + turned : 0.0) + dt * x->z[i];
    }
}

/* Puts the end of the last phase, later by shift, into w. */
static void close_phase(struct second *x)
{
    for (size_t p = 0; x->open && p < x->count; p++) {
        const double turns = x->d->kind[p] == TRIBO_PARAMETER_FREQUENCY ? 1.0 : 0.0;
        const double longer = x->shift[p] - x->last[p] - turns * x->tau;
        for (size_t i = 0; i < 2 * x->d->n; i++) {
            x->w[i / 2 * x->wide + 2 + 2 * p + i % 2] += longer * x->rate[i];
        }
        x->last[p] = x->shift[p];
        x->shift[p] = 0.0;
    }
    x->open = 0;
}

/* to [n] = the response to source of the motion from the state x->z, over the time tau up to t, in as many series as that takes.
 * Returns a status. */
static int respond(struct second *x, double tau, double t, const struct source *source, double *to)
{
    struct events *e = x->d->map->events;
    const tribo_system *sys = x->d->map->sys;
    double reach = 0.0;
    int status = TRIBO_OK;
    for (double left = tau; !status && left > 0.0; left = reach < left ? left - reach : 0.0) {
        reach = left;
        status = e->motion->begin(e->own, t - left, x->z, &reach);
        status = status ? status : e->motion->transition(e->own, NULL, reach, 1, to, source);
        if (!status && reach < left) {
            e->motion->state(e->own, reach, x->z, x->z);
            tribo_compliance_get(sys, x->z, x->spring);
            for (size_t k = 0; k < sys->compliance.count; k++) {
                const size_t i = sys->compliance.contact[k];
                e->stick_slip.state.force[i] = x->spring[i];
            }
        }
    }
    return status;
}

/* x->rate [n][2] = the response of V to damping = 1 of struct source, over the phase of length tau that ends at t. The source is
 * linear in the motion: the response of V is that of the motion from the state + part V, less that of the motion from the state,
 * over part. Begins the phase of the motion anew. Returns a status. */
static int find_damped(struct second *x, double tau, double t)
{
    static const double none = 0.0, one = 1.0;
    const struct sensitivity *d = x->d;
    struct events *e = d->map->events;
    tribo_system *sys = d->map->sys;
    const size_t n = d->n, guards = e->search.guards;
    const struct source source = {.force = x->push, .inertia = &none, .damping = &one};
    struct guard *const kept = malloc((guards + 1) * sizeof *kept);
    if (!kept) {
        return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for derivatives of a multiplier");
    }
    memcpy(kept, e->search.guard, guards * sizeof *kept);
    memset(x->push, 0, d->contacts * sizeof *x->push);
    memcpy(x->a, e->stick_slip.state.force, d->contacts * sizeof *x->a);
    for (size_t i = 0; i < 2 * n; i++) {
        x->rate[i] = x->w[i / 2 * x->wide + i % 2];
    }
    if (sys->compliance.count) {
        tribo_compliance_perturb(sys, e->stick_slip.state.slip, NULL, 2, x->rate, x->damped);
    }
    const double size = tribo_largest(d->from, n), part = (size > 0.0 ? size : 1.0) / tribo_largest(x->rate, 2 * n);
    memset(x->damped, 0, 3 * n * sizeof *x->damped);
    int status = TRIBO_OK;
    for (size_t k = 0; !status && k < 3; k++) { /* the motion itself last */
        memcpy(x->z, d->from, (n + 1) * sizeof *x->z);
        memcpy(e->stick_slip.state.force, x->a, d->contacts * sizeof *x->a);
        for (size_t i = 0; k < 2 && i < n; i++) {
            x->z[i] += part * x->rate[2 * i + k];
            if (i >= 2 * sys->ndof) {
                e->stick_slip.state.force[sys->compliance.contact[i - 2 * sys->ndof]] += part * x->rate[2 * i + k];
            }
        }
        status = respond(x, tau, t, &source, x->damped + k * n);
    }
    for (size_t i = 0; i < 2 * n; i++) {
        x->rate[i] = (x->damped[i % 2 * n + i / 2] - x->damped[2 * n + i / 2]) / part;
    }
    memcpy(e->search.guard, kept, guards * sizeof *kept);
    e->search.guards = guards;
    free(kept);
    tribo_system_set_time(sys, t);
    return status;
}

int tribo_second_phase(struct second *x, double tau, double t, const double *y)
{
    struct sensitivity *d = x->d;
    const size_t n = d->map->sys->ndof;
    close_phase(x);
    int status = x->status || !x->damps ? x->status : find_damped(x, tau, t);
    status = status ? status : tribo_derivative_apply(&d->steps, d->steps.steps - 1, x->wide, x->w, NULL);
    for (size_t at = 0; x->damps && at < 2 * d->n * x->count; at++) {
        const size_t i = at / (2 * x->count), j = at % (2 * x->count);
        x->w[i * x->wide + 2 + j] -= d->kind[j / 2] == TRIBO_PARAMETER_DAMPING ? x->rate[2 * i + j % 2] : 0.0;
    }
    memcpy(x->before, d->variation.v, d->n * x->count * sizeof *x->before);
    memcpy(x->y, y, d->n * sizeof *y);
    for (size_t k = 0; !status && k < 2; k++) {
        for (size_t i = 0; i < d->n; i++) {
            x->z[i] = x->w[i * x->wide + k];
        }
        status = find_change(x, 0.0, x->count, x->after, x->pull);
        for (size_t i = 0; i < n; i++) {
            x->rate[2 * i + k] = x->z[n + i];
            x->rate[2 * (n + i) + k] = x->after[i];
        }
        tribo_matrix_multiply(&d->map->sys->direction, x->z + n, x->a);
        for (size_t i = 0; i < d->contacts; i++) {
            x->a[i] *= tribo_force_is_state(&d->map->events->stick_slip, i);
        }
        tribo_compliance_rates(d->map->sys, d->map->events->stick_slip.state.slip, NULL, 1, x->a, x->push);
        for (size_t i = 2 * n; i < d->n; i++) {
            x->rate[2 * i + k] = x->push[d->map->sys->compliance.contact[i - 2 * n]];
        }
    }
    for (size_t p = 0; !status && p < x->count; p++) {
        change_state(x, p, 0.0);
        status = find_change(x, 0.0, p, x->bend + p * n, x->pull + p * d->contacts);
    }
    change_state(x, x->count, 1.0);
    status = status ? status : find_change(x, 1.0, x->count, x->bend + x->count * n, x->pull + x->count * d->contacts);
    x->tau = tau;
    x->steps = d->steps.steps;
    x->open = 1;
    return status;
}

/* Sets shift at an event. Returns 0 if the event is of more than one contact, or its time has no derivative. */
static int find_shift(struct second *x)
{
    const struct sensitivity *d = x->d;
    const struct variation *v = &d->variation;
    const struct events *e = d->map->events;
    const signed char *now = e->stick_slip.state.slip;
    const size_t n = d->map->sys->ndof, at = v->count ? v->contact[0] : e->met ? e->met->contact : 0;
    size_t changes = 0, own = 0; /* changes: number of contacts but `at` of which slip changes; own = 1: that of `at` does */
    for (size_t i = 0; i < d->contacts; i++) {
        const size_t change = v->before[i] != now[i] && !(v->count == 1 && v->group[i] == 1);
        own += i == at ? change : 0;
        changes += i == at ? 0 : change;
    }
    const int stops = v->count == 1 || (own && tribo_slides(v->before[at]) && now[at] == TRIBO_SLIP_STUCK &&
                                        tribo_force_is_state(&e->stick_slip, at) && e->met->kind == SLIDES);
    const int breaks = own && !stops && v->before[at] == 0 && tribo_slides(now[at]) && e->met && e->met->kind == HOLDS;
    for (size_t p = 0; (stops || breaks) && p < x->count; p++) {
        const double *pull = x->pull + at, *by_time = pull + x->count * d->contacts;
        change_state(x, p, 0.0);
        x->shift[p] = stops ? -tribo_matrix_row_dot(&d->map->sys->direction, at, x->z + n) / v->rate[at]
                            : -(now[at] * d->rise[at * x->count + p] + pull[p * d->contacts]) / *by_time;
        if (!isfinite(x->shift[p])) {
            return 0;
        }
    }
    return changes == 0 && v->count <= 1 && (stops || breaks || !own);
}

void tribo_second_event(struct second *x)
{
    const struct sensitivity *d = x->d;
    const size_t n = d->map->sys->ndof;
    if (!x->status && !find_shift(x)) {
        x->status = tribo_error(d->map->sys->message, TRIBO_ERR_UNSUPPORTED,
                                "contacts stop or break away at one instant, or a force only touches its limit: derivatives of "
                                "multipliers are found where each event has its own time");
    }
    close_phase(x);
    if (x->status || d->steps.steps == x->steps) {
        return;
    }
    const double *row = d->steps.step[d->steps.steps - 1].jump, *c = row + d->n;
    const size_t i = d->variation.contact[0];
    double *along = x->along; /* r V, then r DV of each parameter */
    memset(along, 0, x->wide * sizeof *along);
    tribo_multiply_add(1, d->n, x->wide, 1.0, row, x->w, along);
    for (size_t p = 0; !x->status && p < x->count; p++) {
        const double dt = x->last[p];
        double *before = x->bend + p * n;
        tribo_add(before, dt, x->bend + x->count * n, n);
        change_state(x, p, dt);
        x->status = find_change(x, dt, p, x->after, x->pull);
        const double part = tribo_matrix_row_dot(&d->map->sys->direction, i, before) / d->variation.rate[i];
        for (size_t at = 0; at < 2 * n; at++) {
            const size_t k = at % 2, r = at / 2;
            x->w[(n + r) * x->wide + 2 + 2 * p + k] +=
                c[r] * (along[2 + 2 * p + k] - along[k] * part) + (x->after[r] - before[r]) * along[k];
        }
    }
    for (size_t at = 0; at < 2 * n; at++) {
        x->w[(n + at / 2) * x->wide + at % 2] += c[at / 2] * along[at % 2];
    }
}

int tribo_driver_multiplier_derivatives(tribo_driver *drv, size_t which, size_t count, const int *kind, const size_t *index,
                                        double *re, double *im)
{
    const double *none = NULL;
    int status = tribo_shooting_ready(drv, !kind ? "kind" : !index ? "index" : !re ? "re" : !im ? "im" : NULL, &none);
    if (status || !count) {
        return status ? status : tribo_error(drv->message, TRIBO_ERR_SIZE, "count = 0");
    }
    struct shooting *s = drv->shooting;
    const size_t n = s->map.n, dofs = drv->sys->ndof, c = drv->sys->ncontact, wide = 2 + 2 * count;
    const char *const without = s->told->extra.count ? "an unknown period" : s->told->map.ring.sectors ? "a ring" : NULL;
    if (without || which >= n) {
        return without
                   ? tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED, "derivatives of multipliers are found without %s", without)
                   : tribo_error(drv->message, TRIBO_ERR_RANGE, "multiplier[%zu] is 0, or there is none", which);
    }
    struct sensitivity d = {.columns = count, .kind = kind};
    struct second x = {.d = &d, .count = count, .wide = wide};
    double complex *vector = NULL, lambda; /* [2][n] u, w */
    double *room, *coordinates;
    if (!ALLOCATE(ARRAY(vector, 2 * n), ARRAY(room, 2 * n * n + 2 * tribo_system_dimension(drv->sys)),
                  ARRAY(coordinates, n * wide), ARRAY(x.w, n * wide), ARRAY(x.rate, 2 * n), ARRAY(x.before, n * count),
                  ARRAY(x.y, n), ARRAY(x.bend, (count + 1) * dofs), ARRAY(x.pull, (count + 1) * c), ARRAY(x.shift, count),
                  ARRAY(x.last, count), ARRAY(x.z, n + 1), ARRAY(x.damped, 3 * n + 4 * c), ARRAY(x.after, dofs), ARRAY(x.push, c),
                  ARRAY(x.a, c), ARRAY(x.spring, c), ARRAY(x.along, wide))) {
        return tribo_error(drv->message, TRIBO_ERR_MEMORY, "out of memory for derivatives of a multiplier");
    }
    d.second = &x;
    for (size_t p = 0; p < count; p++) {
        x.damps |= kind[p] == TRIBO_PARAMETER_DAMPING;
    }
    status = tribo_shooting_vectors(s, which, vector, &lambda, room);
    for (size_t i = 0; !status && i < n; i++) {
        coordinates[i * wide] = creal(vector[i]);
        coordinates[i * wide + 1] = cimag(vector[i]);
    }
    tribo_energy_norm_state(&s->map.norm, wide, coordinates, x.w);
    status = status ? status : tribo_sensitivity_find(&d, drv, index, NULL, NULL, NULL);
    status = status ? status : tribo_driver_pass(drv, x.status);
    if (!status) {
        close_phase(&x);
        tribo_energy_norm_of(&s->map.norm, wide, x.w, coordinates);
        for (size_t p = 0; p < count; p++) {
            double complex sum = 0.0;
            for (size_t i = 0; i < n; i++) {
                sum += vector[n + i] * (coordinates[i * wide + 2 + 2 * p] + coordinates[i * wide + 3 + 2 * p] * I);
            }
            sum *= (s->map.odd ? -2.0 * lambda : 1.0) * (kind[p] == TRIBO_PARAMETER_LOADS ? -1.0 : 1.0);
            re[p] = creal(sum);
            im[p] = cimag(sum);
        }
    }
    free(vector);
    return status;
}
