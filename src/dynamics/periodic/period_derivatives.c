/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives of the periodic motion found last by parameters p. With the image of the start x after the span,
 *     d image = D dx + w dp,   dx/dp = (I - D)^-1 w,
 * w: perturbation at the end of the span by the sources of dp, from zero. The motion is then followed once more, with the
 * perturbations dx/dp at its start, which come back to dx/dp.
 *
 * Perturbations by the frequency are at constant phase theta = (1 + e) t of the loads, where q'' += -2 e q'' - e AC q', as by a
 * source, and q' = (1 + e) dq/dtheta. A factor of all loads and bases needs no source: the motion is homogeneous in loads, bases
 * and limits. */
#include "sensitivity.h"
#include "common/layout.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A derivative that comes back differs from its beginning by at most this part. */
#define COMES_BACK 1e-7

/* Slope of a signal, times the period, over its value, above which an extreme at an event is a corner. */
#define CORNER 1e-6

/* Adds slip J q to the paths: the parts of the last phase at the end of it, and of the phase that ends now, at its start. The
 * slider of a contact that rested before the event was where it was before the jump, of another where it is after it. */
static void add_paths(struct sensitivity *d, const signed char *slip, const double *v)
{
    double *after = d->end;
    tribo_system_find_ways(d->map->sys, d->columns, v, d->force, after);
    for (size_t i = 0; i < d->contacts; i++) {
        const signed char before = d->begun && tribo_slides(d->slip[i]) ? d->slip[i] : 0;
        const signed char now = slip && tribo_slides(slip[i]) ? slip[i] : 0;
        const double *at = (d->begun && !before ? d->way : after) + i * d->columns;
        tribo_add(d->path + i * d->columns, before - now, at, d->columns);
    }
}

/* Sets an extreme, and its derivatives, if it is at time s >= 0 of the phase that ends. Returns a status. */
static int update_extreme(struct sensitivity *d, struct extreme *x, const struct signal *signal, double s, double value)
{
    const struct events *e = d->map->events;
    const size_t n = d->map->sys->ndof;
    struct derivative_step step = {.tau = s, .slip = e->stick_slip.state.slip};
    const struct derivative one = {.events = d->map->events, .sys = d->map->sys, .steps = 1, .step = &step};
    double at[4];
    if (!(s >= 0.0)) {
        return TRIBO_OK;
    }
    tribo_signal_at(signal, s, at);
    x->value = value;
    x->corner = (s == 0.0 || s == signal->tau) && fabs(at[1]) * d->map->period > CORNER * fabs(value);
    memcpy(d->moved, d->variation.v, d->n * d->columns * sizeof *d->moved);
    const int status = s > 0.0 ? tribo_derivative_apply(&one, 0, d->columns, d->moved, &d->by) : TRIBO_OK;
    memset(x->by, 0, d->columns * sizeof *x->by);
    tribo_multiply_add(1, d->n, d->columns, 1.0, d->c, d->moved, x->by);
    e->motion->state(e->own, s, d->from, d->now);
    for (size_t j = 0; j < d->columns; j++) {
        x->by[j] += d->kind[j] == TRIBO_PARAMETER_FREQUENCY ? tribo_dot(d->c + n, d->now + n, n) : 0.0;
    }
    return status;
}

static int sensitivity_phase(struct company *company, double tau, double t, const double *y)
{
    struct sensitivity *d = (struct sensitivity *)company;
    const struct events *e = d->map->events;
    const signed char *slip = e->stick_slip.state.slip;
    for (size_t i = 0; d->energy && i < d->contacts; i++) {
        d->energy[i] += tribo_slides(slip[i]) ? d->map->sys->tally[i] * e->motion->work(e->own, i, tau) : 0.0;
    }
    if (d->path) {
        add_paths(d, slip, d->variation.v);
    }
    const int locates = d->c && d->last;
    struct extremes found = {d->least.value, d->most.value, NAN, NAN};
    struct signal signal = {0};
    int status = locates ? e->motion->signal(e->own, d->c, tau, y, &signal) : TRIBO_OK;
    if (!status && locates && !tribo_signal_extremes(&signal, 0.0, &found)) {
        status = tribo_error(d->map->sys->message, TRIBO_ERR_STEP, "a phase of the period is too fast to be followed");
    }
    status = status ? status : update_extreme(d, &d->least, &signal, found.at_least, found.least);
    status = status ? status : update_extreme(d, &d->most, &signal, found.at_most, found.most);
    tribo_signal_free(&signal);
    status = status ? status : tribo_variation_phase(&d->variation, tau, t, y);
    if (d->path) {
        tribo_system_find_ways(d->map->sys, d->columns, d->variation.v, d->force, d->way);
        memcpy(d->slip, slip, d->contacts);
        d->begun = 1;
    }
    status = status || !d->second || !d->last ? status : tribo_second_phase(d->second, tau, t, y);
    memcpy(d->from, y, (d->n + 1) * sizeof *y);
    return status;
}

static void sensitivity_event(struct company *company)
{
    struct sensitivity *d = (struct sensitivity *)company;
    tribo_variation_event(&d->variation);
    if (d->second && d->last) {
        tribo_second_event(d->second);
    }
}

static const struct company observer = {sensitivity_phase, sensitivity_event};

/* Follows the motion over the span with the perturbations v [n][columns] at its start. Returns a status. */
static int follow_perturbed(struct sensitivity *d, const double *v)
{
    struct period_map *m = d->map;
    const struct shooting *s = m->drv->shooting;
    tribo_variation_begin(&d->variation, m->events, v, d->columns, &d->steps);
    d->variation.by = &d->by;
    memcpy(d->from, s->here->y, d->n * sizeof *d->from);
    d->from[d->n] = 0.0;
    int status = tribo_period_map_replay(m, s->here->y, m->span, &d->company);
    status = status ? status : tribo_driver_pass(m->drv, d->variation.status);
    return status || d->steps.torn == d->contacts
               ? status
               : tribo_error(
                     m->drv->message, TRIBO_ERR_UNSUPPORTED,
                     "contact %zu and contact %zu stop or break away at one instant: which of them is first may change the "
                     "motion, and it has no derivatives",
                     d->steps.torn, d->steps.other);
}

/* Returns 1 if entry i of [..][columns] is of a column of TRIBO_PARAMETER_LOADS. */
static int by_loads(const struct sensitivity *d, size_t i)
{
    return d->kind[i % d->columns] == TRIBO_PARAMETER_LOADS;
}

/* d->start = dx/dp, as states. Returns a status. */
static int find_start(struct sensitivity *d, struct shooting *s)
{
    struct period_map *m = d->map;
    const size_t all = d->n * d->columns;
    int status = follow_perturbed(d, d->start);
    memcpy(d->end, d->variation.v, all * sizeof *d->end);
    tribo_energy_norm_of(&m->norm, d->columns, d->end, d->start);
    for (size_t i = 0; m->odd && i < all; i++) {
        d->start[i] = -d->start[i];
    }
    /* by the loads: (I - D) (x - y) = w is solved for y, where a contact at rest stays where it is */
    memcpy(d->now, s->here->x, d->n * sizeof *d->now);
    status = status ? status : tribo_period_map_apply(m, s->here, d->now);
    for (size_t i = 0; i < all; i++) {
        const double *x = s->here->x + i / d->columns;
        d->start[i] = by_loads(d, i) ? *x - d->now[i / d->columns] - d->start[i] : d->start[i];
    }
    status = status ? status : tribo_shooting_solve(s, d->columns, d->start);
    for (size_t i = 0; i < all; i++) {
        d->start[i] = by_loads(d, i) ? s->here->x[i / d->columns] - d->start[i] : d->start[i];
    }
    memcpy(d->end, d->start, all * sizeof *d->end);
    tribo_energy_norm_state(&m->norm, d->columns, d->end, d->start);
    return status;
}

/* Returns TRIBO_OK if all perturbations come back to their beginnings. */
static int check_return(struct sensitivity *d)
{
    struct period_map *m = d->map;
    const size_t all = d->n * d->columns;
    double *begin = malloc(2 * all * sizeof *begin), *after = begin + all;
    if (!begin) {
        return tribo_error(m->drv->message, TRIBO_ERR_MEMORY, "out of memory for %zu derivative%s", d->columns,
                           plural(d->columns));
    }
    int status = TRIBO_OK;
    tribo_energy_norm_of(&m->norm, d->columns, d->start, begin);
    tribo_energy_norm_of(&m->norm, d->columns, d->variation.v, after);
    for (size_t j = 0; !status && j < d->columns; j++) {
        double size = 0.0, miss = 0.0;
        for (size_t i = j; i < all; i += d->columns) {
            size = hypot(size, hypot(begin[i], after[i]));
            miss = hypot(miss, begin[i] - (m->odd ? -after[i] : after[i]));
        }
        if (!(miss <= COMES_BACK * size)) {
            status =
                tribo_error(m->drv->message, TRIBO_ERR_NO_CONVERGENCE,
                            "the derivative by kind[%zu] misses its beginning by %.3g of its size: the motion is not isolated", j,
                            miss / size);
        }
    }
    free(begin);
    return status;
}

/* ----------------------------------------------------------------------------------------------------------------- parameters */

/* Sets the column j of rise and moved_by for the parameter of kind and index; limit [contacts]: limits at the start.
 * Returns a status. */
static int set_parameter(struct sensitivity *d, const tribo_driver *drv, size_t j, size_t index, const double *limit)
{
    const tribo_system *sys = drv->sys;
    const int kind = d->kind[j];
    int steady = 0;
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        steady |= sys->loads.harmonic[k].drives == DRIVES_BASE && sys->loads.harmonic[k].omega == 0.0;
    }
    if (kind < TRIBO_PARAMETER_LIMIT || kind > TRIBO_PARAMETER_DAMPING) {
        return tribo_error(drv->message, TRIBO_ERR_RANGE, "kind[%zu] = %d is none of TRIBO_PARAMETER_...", j, kind);
    }
    if (kind == TRIBO_PARAMETER_LIMIT && index >= sys->ncontact) {
        return tribo_error(drv->message, TRIBO_ERR_RANGE, "index[%zu]: there is no contact %zu", j, index);
    }
    if (kind == TRIBO_PARAMETER_LIMIT && !tribo_system_limits_vary(sys) && limit[index] == 0.0) {
        return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED, "contact %zu is open, and has no derivative by its limit", index);
    }
    if (kind == TRIBO_PARAMETER_LOADS && tribo_system_limits_vary(sys)) {
        return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED,
                           "kind[%zu]: derivatives by the loads are found with constant limits", j);
    }
    if (kind == TRIBO_PARAMETER_FREQUENCY && steady) {
        return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED,
                           "kind[%zu]: derivatives by the frequency are found without bases of constant speed", j);
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double own = i == index ? 1.0 : 0.0;
        d->rise[i * d->columns + j] = kind == TRIBO_PARAMETER_LIMIT ? own : kind == TRIBO_PARAMETER_LOADS ? limit[i] : 0.0;
    }
    d->moved_by[j] = kind == TRIBO_PARAMETER_FREQUENCY ? -2.0 : 0.0;
    d->moved_by[d->columns + j] = kind >= TRIBO_PARAMETER_FREQUENCY ? -1.0 : 0.0;
    d->moves |= kind >= TRIBO_PARAMETER_FREQUENCY;
    return TRIBO_OK;
}

/* -------------------------------------------------------------------------------------------------------------------- results */

/* extremes [columns][2] = derivatives of least and most. Returns a status. */
static int write_extremes(struct sensitivity *d, double *extremes)
{
    struct extreme *least = &d->least, *most = &d->most;
    double low = 1.0, high = 1.0;
    if (d->map->odd) { /* the other half of the period is minus this one */
        struct extreme *const larger = -least->value > most->value ? least : most;
        low = larger == least ? 1.0 : -1.0;
        high = -low;
        least = most = larger;
    }
    if (least->corner || most->corner) {
        return tribo_error(d->map->drv->message, TRIBO_ERR_UNSUPPORTED, "an extreme of the signal lies at an event, at a corner");
    }
    for (size_t j = 0; j < d->columns; j++) {
        const int loads = by_loads(d, j);
        extremes[2 * j] = low * (loads ? least->value - least->by[j] : least->by[j]);
        extremes[2 * j + 1] = high * (loads ? most->value - most->by[j] : most->by[j]);
    }
    return TRIBO_OK;
}

/* energy [columns][contacts] = derivatives of the energies, limit times length of slip; to [columns][dimension] = derivatives of
 * the caller's state at the start y, which without massless degrees of freedom is linear in the methods' state. Each or NULL. */
static void write_columns(struct sensitivity *d, const double *y, double *energy, double *to)
{
    const tribo_driver *drv = d->map->drv;
    tribo_system *sys = drv->sys;
    const size_t n = sys->ndof, dimension = tribo_system_dimension(sys);
    const double spans = d->map->odd ? 2.0 : 1.0;
    double *limit = sys->work.put_limit;
    tribo_system_limits(sys, limit, sys->work.feq);
    for (size_t at = 0; energy && at < d->columns * d->contacts; at++) {
        const size_t i = at % d->contacts, j = at / d->contacts;
        const double longer = sys->tally[i] * limit[i] * d->path[i * d->columns + j];
        const double harder = limit[i] > 0.0 ? d->rise[i * d->columns + j] * (d->energy[i] / limit[i]) : 0.0;
        energy[at] = spans * (by_loads(d, j) ? 2.0 * d->energy[i] - longer - harder : longer + harder);
    }
    for (size_t j = 0; to && j < d->columns; j++) {
        for (size_t i = 0; i < d->n; i++) {
            const int turns = d->kind[j] == TRIBO_PARAMETER_FREQUENCY && i >= n && i < 2 * n;
            d->now[i] = d->start[i * d->columns + j] + (turns ? y[i] : 0.0);
            d->now[i] = by_loads(d, j) ? y[i] - d->now[i] : d->now[i];
        }
        d->now[d->n] = 0.0;
        if (drv->motion) {
            tribo_system_write_state(sys, d->map->t, d->now, to + j * dimension);
        } else {
            memcpy(to + j * dimension, d->now, dimension * sizeof *to);
        }
    }
}

/* ----------------------------------------------------------------------------------------------------------------- the whole */

/* Finds the derivatives by kind and index [columns], and writes them. Returns a status, its message on the driver at work. */
static int differentiate(struct sensitivity *d, struct shooting *s, const size_t *index, double *extremes, double *energy,
                         double *y)
{
    const tribo_driver *drv = d->map->drv;
    double *path = d->path, *energies = d->energy;
    d->path = d->energy = NULL; /* until d->start is known */
    int status = TRIBO_OK;
    const tribo_system *sys = drv->sys;
    const char *const without = s->told->extra.count                         ? "an unknown period"
                                : s->told->map.ring.sectors                  ? "a ring"
                                : sys->normals.count                         ? "limits that follow the motion"
                                : sys->circulation > 0.0                     ? "a stiffness that is not symmetric"
                                : tribo_system_is_plain(sys) == 0            ? "static limits and contacts in a plane"
                                : d->second && tribo_system_limits_vary(sys) ? "limits that change"
                                : d->second && tribo_system_bases_move(sys)  ? "bases that move"
                                : d->second && sys->loads.tables             ? "tables"
                                                                             : NULL;
    if (without) {
        status = tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED, "derivatives%s are found without %s",
                             d->second ? " of multipliers" : "", without);
    } else if (s->flow != s->here) {
        status =
            tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED,
                        "a contact stops or breaks away as the period begins, at t = %.17g: begin it at another time", s->map.t);
    } else {
        status = tribo_shooting_check_touches(s, "derivatives");
    }
    tribo_system_limits(drv->sys, drv->sys->work.put_limit, drv->sys->work.feq);
    for (size_t j = 0; !status && j < d->columns; j++) {
        status = set_parameter(d, drv, j, index[j], drv->sys->work.put_limit);
    }
    d->by = (struct parameters){d->rise, d->moves ? d->moved_by : NULL};
    status = status ? status : find_start(d, s);
    d->path = energy ? path : NULL;
    d->energy = energy ? energies : NULL;
    d->last = 1;
    status = status ? status : follow_perturbed(d, d->start);
    status = status ? status : check_return(d);
    status = status || !extremes ? status : write_extremes(d, extremes);
    if (!status && energy) {
        add_paths(d, NULL, d->variation.v);
    }
    if (!status) {
        write_columns(d, s->here->y, energy, y);
    }
    return status;
}

int tribo_sensitivity_find(struct sensitivity *d, tribo_driver *drv, const size_t *index, double *extremes, double *energy,
                           double *y)
{
    struct shooting *s = drv->shooting;
    const size_t count = d->columns;
    d->company = observer;
    d->map = &s->map;
    d->n = s->map.n;
    d->contacts = drv->sys->ncontact;
    d->least.value = HUGE_VAL;
    d->most.value = -HUGE_VAL;
    const size_t each = d->contacts * count, all = d->n * count;
    const int room = ALLOCATE(ARRAY(d->start, all), ARRAY(d->end, all + each), ARRAY(d->from, d->n + 1), ARRAY(d->now, d->n + 1),
                              ARRAY(d->moved, all), ARRAY(d->least.by, count), ARRAY(d->most.by, count),
                              ARRAY(d->moved_by, 2 * count), ARRAY(d->rise, each), ARRAY(d->way, each), ARRAY(d->force, each),
                              ARRAY(d->path, each), ARRAY(d->energy, d->contacts), ARRAY(d->slip, d->contacts)) &&
                     tribo_variation_create(&d->variation, s->map.sys, count);
    const int status =
        room ? differentiate(d, s, index, extremes, energy, y)
             : tribo_error(s->map.drv->message, TRIBO_ERR_MEMORY, "out of memory for %zu derivative%s", count, plural(count));
    tribo_derivative_free(&d->steps);
    tribo_variation_free(&d->variation);
    free(d->start);
    return status && s->map.drv != drv ? tribo_error(drv->message, status, "%s", s->map.drv->message) : status;
}

int tribo_driver_period_derivatives(tribo_driver *drv, size_t count, const int *kind, const size_t *index, const double *c,
                                    double *extremes, double *energy, double *y)
{
    const char *const missing = !kind ? "kind" : !index ? "index" : extremes && !c ? "c" : NULL;
    c = extremes ? c : NULL;
    int status = tribo_shooting_ready(drv, missing, &c);
    if (status || !count) {
        return status ? status : tribo_error(drv->message, TRIBO_ERR_SIZE, "count = 0");
    }
    const size_t n = drv->shooting->map.n;
    struct sensitivity d = {.columns = count, .kind = kind, .c = c};
    for (size_t k = 2 * drv->sys->ndof; c && drv->motion && k < n; k++) { /* c of f' */
        if (c[k + n - 2 * drv->sys->ndof] != 0.0) {
            return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED,
                               "extremes of velocities of degrees of freedom without mass have no derivatives");
        }
    }
    if (y && drv->sys->expansion.dofs - drv->sys->expansion.sliders > drv->sys->ndof) {
        return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED,
                           "derivatives of y are found without degrees of freedom without mass");
    }
    if (energy && tribo_system_limits_vary(drv->sys)) {
        return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED, "derivatives of energies are found with constant limits");
    }
    return tribo_sensitivity_find(&d, drv, index, extremes, energy, y);
}
