/* SPDX-License-Identifier: BSD-3-Clause */
/* Periodic motions of a ring of N equal sectors under loads that travel: x_j+1(t) = x_j(t - order period/N). With g the greatest
 * common divisor of N and the order, sector j + N/g moves as sector j; and, if all drives are odd and N/g is even, sector j +
 * N/(2g) as minus sector j. The twin has the first of these sectors only, with matrices that close the ring behind the last one,
 * and the search follows a part of the period, period g/N; if all drives are odd and N/g is odd, half of that. */
#include "shooting.h"
#include "common/real.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Largest difference of entries that are equal, relative to the largest entry; LOADS: of loads, which are computed. */
#define EQUAL 1e-12
#define LOADS 1e-11

/* -------------------------------------------------------------------------------------------------------------- checks */

/* Returns TRIBO_OK if the entries of a that belong to sectors j and k are those of sectors j + 1 and k + 1, for all j and k. */
static int check_equal(tribo_driver *drv, const char *name, const struct matrix *a)
{
    const size_t rows = a->rows / drv->shooting->asked.sectors, cols = a->cols / drv->shooting->asked.sectors;
    double most = 0.0;
    for (size_t k = 0; a->rows && k < a->first[a->rows]; k++) {
        most = greater(most, fabs(a->val[k]));
    }
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            const size_t j = a->col[k], to = (i + rows) % a->rows, at = (j + cols) % a->cols;
            const double other = tribo_matrix_get(a, to, at);
            if (!(fabs(other - a->val[k]) <= EQUAL * most)) {
                return tribo_error(drv->message, TRIBO_ERR_RANGE,
                                   "sectors are not equal: %s[%zu][%zu] = %.17g, but %s[%zu][%zu] = %.17g", name, i, j, a->val[k],
                                   name, to, at, other);
            }
        }
    }
    return TRIBO_OK;
}

/* Returns TRIBO_OK if all functions of time of the kind and the frequency of h travel: sector j + 1 has those of sector j, later
 * by order/sectors of the period. work [2n]. */
static int check_travel(tribo_driver *drv, const struct harmonic *h, double period, double *work)
{
    const tribo_system *sys = drv->sys;
    const struct ring_of *of = &drv->shooting->asked;
    const size_t n = h->drives == DRIVES_LOAD ? sys->ndof : sys->ncontact, each = n / of->sectors;
    const double turns = round(fabs(h->omega) * period / FULL_TURN) * (double)of->order, sectors = (double)of->sectors;
    const double angle = FULL_TURN * fmod(turns, sectors) / sectors, c = cos(angle), s = sin(angle);
    double *re = work, *im = work + n, most = 0.0;
    memset(work, 0, 2 * n * sizeof *work);
    for (size_t k = 0; k < sys->loads.harmonics; k++) { /* re - i im: amplitudes of e^(i |omega| t) */
        const struct harmonic *one = &sys->loads.harmonic[k];
        for (size_t e = 0; one->drives == h->drives && fabs(one->omega) == fabs(h->omega) && e < one->count; e++) {
            re[one->index[e]] += one->cosine[e];
            im[one->index[e]] += one->omega < 0.0 ? -one->sine[e] : one->sine[e];
        }
    }
    for (size_t d = 0; d < n; d++) {
        most = greater(most, hypot(re[d], im[d]));
    }
    for (size_t d = 0; d < n; d++) {
        const size_t to = (d + each) % n;
        if (!(hypot(c * re[to] + s * im[to] - re[d], c * im[to] - s * re[to] - im[d]) <= LOADS * most)) {
            return h->drives == DRIVES_LOAD
                       ? tribo_error(
                             drv->message, TRIBO_ERR_RANGE,
                             "loads do not travel with order = %zu: that on degree of freedom %zu, omega = %.17g, is not that "
                             "on degree of freedom %zu, later",
                             of->order, to, h->omega, d)
                       : tribo_error(drv->message, TRIBO_ERR_RANGE,
                                     "%s do not travel with order = %zu: that of contact %zu, omega = %.17g, is not that of "
                                     "contact %zu, later",
                                     h->drives == DRIVES_BASE ? "base motions" : "limits", of->order, to, h->omega, d);
        }
    }
    return TRIBO_OK;
}

/* Returns TRIBO_OK if the system has equal sectors, and loads that travel. */
static int check_ring(tribo_driver *drv, double period)
{
    const tribo_system *sys = drv->sys;
    const size_t each = sys->ncontact / drv->shooting->asked.sectors,
                 most = sys->ndof > sys->ncontact ? sys->ndof : sys->ncontact;
    if (sys->reduced.modes || tribo_system_ndof(sys) != sys->ndof || sys->normals.count || !tribo_system_is_plain(sys)) {
        return tribo_error(
            drv->message, TRIBO_ERR_UNSUPPORTED,
            "rings have no modes or degrees of freedom without mass, no limits that are static or follow the motion, "
            "and no contacts in a plane");
    }
    const double *limit = sys->loads.given_limit;
    double *work = malloc((2 * most + 1) * sizeof *work);
    int status = work ? TRIBO_OK : tribo_error(drv->message, TRIBO_ERR_MEMORY, "out of memory for a ring");
    for (size_t i = 0; !status && i < sys->ncontact; i++) {
        const size_t to = (i + each) % sys->ncontact;
        if (limit[i] != limit[to]) {
            status = tribo_error(drv->message, TRIBO_ERR_RANGE,
                                 "sectors are not equal: limit[%zu] = %.17g, but limit[%zu] = %.17g", i, limit[i], to, limit[to]);
        }
    }
    const struct matrix *const matrix[] = {&sys->mass, &sys->k, &sys->c, &sys->direction, tribo_springs_matrix(sys)};
    static const char *const name[] = {"mass", "stiffness", "damping", "direction", "compliance"};
    for (size_t k = 0; !status && k < sizeof matrix / sizeof *matrix; k++) {
        status = check_equal(drv, name[k], matrix[k]);
    }
    for (size_t k = 0; !status && k < sys->loads.harmonics; k++) {
        status = check_travel(drv, &sys->loads.harmonic[k], period, work);
    }
    free(work);
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- the twin */

/* Returns the ring of the sectors that move differently, of all sectors if whole = 1. */
static struct ring find_ring(const struct ring_of *of, int odd, int whole, double period)
{
    const size_t all = of->sectors, order = of->order;
    size_t common = all, rest = order, step = 0;
    while (rest) {
        const size_t next = common % rest;
        common = rest;
        rest = next;
    }
    while (step * order % all != common % all) {
        step++;
    }
    struct ring r = {.sectors = all, .step = step, .parts = all / common, .lag = period * (double)order / (double)all};
    if (!whole) {
        r.sectors = odd && r.parts % 2 == 0 ? r.parts / 2 : r.parts;
        r.alternates = odd && r.parts % 2 == 0;
        if (odd && !r.alternates) { /* (parts + 1)/2 parts later, less half a period */
            r.step = step * ((r.parts + 1) / 2);
            r.parts *= 2;
            r.reversed = 1;
        }
        r.reversed ^= (int)(r.alternates * (r.step / r.sectors % 2));
        r.step %= r.sectors;
    }
    return r;
}

/* Returns the sign of sector j of the whole ring beside its sector j % r->sectors. */
static double sign_of(const struct ring *r, size_t j)
{
    return r->alternates && j / r->sectors % 2 ? -1.0 : 1.0;
}

/* to [rows of r->sectors][columns of r->sectors] = the sum over all sectors of the columns of a that move alike. */
static void fold_matrix(const tribo_driver *drv, const struct ring *r, const struct matrix *a, double *to)
{
    const size_t each = a->cols / drv->shooting->asked.sectors, columns = each * r->sectors;
    const size_t rows = a->rows / drv->shooting->asked.sectors * r->sectors;
    memset(to, 0, rows * columns * sizeof *to);
    for (size_t i = 0; i < rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            to[i * columns + a->col[k] % columns] += sign_of(r, a->col[k] / each) * a->val[k];
        }
    }
}

/* Creates *sys, the system of the first r->sectors of the ring. Returns a status. */
static int fold_system(tribo_driver *drv, const struct ring *r, tribo_system **sys)
{
    const tribo_system *from = drv->sys;
    const size_t n = from->ndof / drv->shooting->asked.sectors * r->sectors,
                 contacts = from->ncontact / drv->shooting->asked.sectors * r->sectors;
    double *a = malloc((n * (n + contacts) + 1) * sizeof *a);
    tribo_model *m = NULL;
    int status = a ? tribo_model_create(&m, n, contacts) : TRIBO_ERR_MEMORY;
    if (!status) {
        fold_matrix(drv, r, &from->mass, a);
        tribo_even_out(n, a);
        status = tribo_model_set_mass(m, a);
        fold_matrix(drv, r, &from->k, a);
        if (from->circulation == 0.0) {
            tribo_even_out(n, a);
        }
        status = status ? status : tribo_model_set_stiffness(m, a);
        fold_matrix(drv, r, &from->direction, a);
        status = status ? status : tribo_model_set_direction(m, a);
    }
    if (!status && from->c.rows) {
        fold_matrix(drv, r, &from->c, a);
        status = tribo_model_set_damping(m, a);
    }
    status = status ? status : tribo_springs_copy_first(m, from);
    status = status ? status : tribo_system_create(sys, m);
    if (!status) {
        status = tribo_set_limit(tribo_system_context(*sys), from->loads.given_limit);
        status = status ? status : tribo_system_take_settings(*sys);
    }
    if (!status) {
        memcpy((*sys)->tally, from->tally, contacts * sizeof *from->tally);
        status = tribo_loads_copy_first(*sys, from) ? TRIBO_OK : TRIBO_ERR_MEMORY;
    }
    status = status ? tribo_error(drv->message, status, "sectors of a ring: %s", tribo_strerror(status)) : status;
    tribo_model_destroy(m);
    free(a);
    return status;
}

/* y = the state of the whole ring, of which z is that of the twin. */
static void unfold_state(const struct shooting *s, const double *z, double *y)
{
    const struct ring *r = &s->twin.drv->shooting->map.ring;
    const tribo_system *sys = s->map.sys;
    const size_t all = s->whole.sectors, block[] = {sys->ndof, sys->ndof, s->map.n - 2 * sys->ndof};
    for (size_t b = 0; b < 3; y += block[b], z += block[b] / all * r->sectors, b++) {
        const size_t each = block[b] / all;
        for (size_t i = 0; i < block[b]; i++) {
            y[i] = sign_of(r, i / each) * z[i % (each * r->sectors)];
        }
    }
}

void tribo_ring_fold_combination(const struct shooting *s, const double *c, double *to)
{
    const struct ring *r = &s->told->map.ring;
    const tribo_system *sys = s->map.sys;
    const size_t all = s->whole.sectors;
    const size_t springs = s->map.n - 2 * sys->ndof, block[] = {sys->ndof, sys->ndof, springs, springs};
    for (size_t b = 0; b < 4; c += block[b], to += block[b] / all * r->sectors, b++) {
        const size_t each = block[b] / all, wrap = each * r->sectors;
        memset(to, 0, wrap * sizeof *to);
        for (size_t i = 0; i < block[b]; i++) {
            to[i % wrap] += sign_of(r, i / each) * c[i];
        }
    }
}

/* -------------------------------------------------------------------------------------------------------------- search */

int tribo_shooting_find_ring(struct shooting *s, struct wanted *w)
{
    tribo_driver *drv = s->map.drv;
    s->found = 0;
    s->told = s;
    s->whole = s->asked;
    tribo_shooting_leave_twin(s);
    int status = check_ring(drv, w->period);
    const struct ring ring = find_ring(&s->asked, tribo_system_is_odd(drv->sys, w->period), 0, w->period);
    status = status ? status : fold_system(drv, &ring, &s->twin.sys);
    status = status ? status : tribo_shooting_drive_twin(s);
    if (status) {
        return status;
    }
    struct shooting *t = s->twin.drv->shooting;
    t->map.ring = ring;
    const size_t n = s->map.sys->ndof, first = t->map.sys->ndof; /* the first sectors of the guess */
    memcpy(s->step, w->y, first * sizeof *w->y);
    memcpy(s->step + first, w->y + n, first * sizeof *w->y);
    memcpy(s->step + 2 * first, w->y + 2 * n, (t->map.n - 2 * first) * sizeof *w->y);
    struct wanted of_twin = {.t = w->t, .period = w->period, .y = s->step};
    status = tribo_shooting_find(t, &of_twin);
    drv->newton += t->map.drv->newton;
    drv->events += t->map.drv->events;
    drv->evaluations += t->map.drv->evaluations;
    drv->periods += (size_t)ceil(tribo_periods_followed(&t->map));
    if (status) {
        return tribo_error(drv->message, status, "%s", t->map.drv->message);
    }
    unfold_state(s, t->here->y, w->y);
    w->y[s->map.n] = 0.0;
    s->found = 1;
    s->revision = tribo_system_revision(s->map.sys);
    s->touches = SIZE_MAX;
    s->told = t;
    return TRIBO_OK;
}

int tribo_ring_find_flow(struct shooting *s)
{
    struct period_map *m = &s->map;
    const struct point *found = s->told->here;
    int status = tribo_driver_pass(m->drv, tribo_system_take_settings(m->sys));
    if (!status && s->revision != tribo_system_revision(m->sys)) {
        return tribo_error(m->drv->message, TRIBO_ERR_STATE, "the system has changed since the periodic motion was found");
    }
    m->ring = find_ring(&s->whole, 0, 1, s->told->map.period);
    unfold_state(s, found->y, s->step);
    status = status ? status : tribo_period_map_prepare(m, s->told->map.t, s->told->map.period, s->step);
    if (!status) {
        tribo_energy_norm_of(&m->norm, 1, s->step, s->here->x);
        status = tribo_period_map_follow(m, s->here);
    }
    return status ? status : tribo_shooting_find_flow(s);
}
