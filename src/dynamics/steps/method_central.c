/* SPDX-License-Identifier: BSD-3-Clause */
/* Method "central/fixed": central differences, velocities half a step apart from displacements. Explicit; stable for dt
 * below 2/omega_max. Damping acts on the velocity of half a step before. Small systems take runs of steps; blockwise.c
 * takes the steps of others whose contacts share no body. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "blockwise.h"
#include "numerics/box/small.h"
#include "dynamics/reduce/spectrum.h"
#include "dynamics/system/cos_sin.h"
#include "fixed_steps.h"
#include "common/real.h"
#include "common/layout.h"

/* Runs of steps of at most FEW degrees of freedom and contacts, which may share bodies: all matrices are small squares, and
 * loads, bases and limits are found for all steps of a run at once.
 *
 * Friction over a step is the solution of min 1/2 p'Rp + v'p with |p| <= time limit, where v are the velocities of the
 * contacts without friction and p the impulses. The first guess is that contacts hold and slide as in the step before: its p
 * is the solution if each is within its bounds, and no contact that slides moves in the direction of its friction. Else
 * contacts change between the two as in numerics/box/small.h; if that takes too many rounds, the step is left to the caller. */
enum { FEW = SMALL };

struct few_bodies {
    int fits;        /* 1: runs can be taken with the settings */
    size_t revision; /* of the system to which all of this belongs; SIZE_MAX: none */
    double stiffness[FEW * FEW], damping[FEW * FEW], direction[FEW * FEW], response[FEW * FEW]; /* [n][n], [c][n], [n][c] */
    double r[FEW * FEW], inverse[FEW * FEW], part[FEW]; /* see numerics/box/small.h; of r and inverse [c][c] */
    unsigned inverse_of;
    signed char at[FEW]; /* in the step before: FREE: holds; AT_LOWER, AT_UPPER: slides, with friction -limit, limit */
    /* of the steps of a run: durations over which forces act; lengths, that of the step before the run first; and what acts */
    double time[RUN], h[RUN + 1];
    double load[FEW][RUN], base[FEW][RUN], limit[RUN][FEW]; /* limits that do not vary: limit[0] */
};

struct central {
    struct step_form common;
    struct few_bodies few;
    struct blockwise alone;
    double energy; /* dissipated up to u */
    double last;   /* length of the step before; 0: u is the velocity at t */
    double when;   /* time of u */
    double stable; /* a step length known to be stable; 0: none */
};

static void central_destroy(tribo_driver *drv)
{
    struct central *x = drv->own;
    if (x) {
        free(x->common.memory);
        tribo_blockwise_free(&x->alone);
        free(x);
    }
}

static int central_create(tribo_driver *drv)
{
    struct central *x = tribo_zeros(1, sizeof *x);
    drv->own = x;
    if (!x || !tribo_step_form_create(&x->common, drv->sys) || !tribo_blockwise_create(&x->alone, drv->sys)) {
        return tribo_error(drv->sys->message, TRIBO_ERR_MEMORY, "out of memory for method %s", drv->method->name);
    }
    x->few.revision = SIZE_MAX;
    return TRIBO_OK;
}

/* Makes u_to of u, and adds the work of friction to the energy. Returns a status. */
static int kick(tribo_driver *drv, const struct body_step *k, double *energy)
{
    struct central *x = drv->own;
    struct step_form *s = &x->common;
    tribo_system *sys = drv->sys;
    tribo_step_form_velocity(s, sys, k->from, k->u, s->v);
    /* velocities without friction, by forces at t and q */
    tribo_system_set_time(sys, k->t);
    tribo_normals_set(sys, k->q, k->u);
    tribo_system_smooth(sys, 0, 1.0, k->q, k->u, NULL, s->a);
    for (size_t i = 0; i < sys->ndof; i++) {
        k->u_to[i] = k->u[i] + k->time * s->a[i];
    }
    sys->evaluations++;
    tribo_step_form_velocity(s, sys, k->to, k->u_to, s->end);
    if (tribo_system_limits_vary(sys)) {
        tribo_system_set_time(sys, k->t);
    }
    const int status = tribo_step_form_force(s, sys, sys->contacts, k->time);
    if (status) {
        return tribo_step_form_fail(drv, status, k->t, tribo_message(sys->contacts));
    }
    tribo_matrix_multiply_add(&sys->response, k->time, s->f, k->u_to);
    tribo_get_slip(sys->contacts, s->mode);
    tribo_system_snap(sys, s->mode, s->base, k->u_to);
    tribo_step_form_relative(s, sys, k->u_to, s->end);
    *energy += k->time * tribo_step_form_power(s, sys);
    return TRIBO_OK;
}

/* Sets velocities and energy of y, half a step ahead of u, to those at t. The next step goes on from u. */
static int synchronise(tribo_driver *drv, double t, double *y)
{
    struct central *x = drv->own;
    struct step_form *s = &x->common;
    const size_t n = drv->sys->ndof;
    const struct body_step back = {.from = x->when, .t = t, .to = t, .time = 0.5 * x->last, .q = y, .u = s->u, .u_to = y + n};
    y[2 * n] = x->energy;
    const int status = kick(drv, &back, y + 2 * n);
    return status ? status : tribo_driver_check(drv, y);
}

/* ------------------------------------------------------------------------------------------------------------ few bodies */

/* Adds harmonics and tables that drive loads or bases at the times t [count] to rows [n], which begin with 0. */
static void few_find_drives(tribo_system *sys, enum drives drives, size_t n, size_t count, const double *t, double row[FEW][RUN])
{
    double cosine[RUN], sine[RUN];
    memset(row, 0, n * sizeof *row);
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        const struct harmonic *h = &sys->loads.harmonic[k];
        if (h->drives == drives) {
            tribo_cos_sin_all(h->omega, count, t, cosine, sine);
            for (size_t s = 0; h->knots && s < count; s++) {
                tribo_system_set_time(sys, t[s]);
                cosine[s] = h->cos_t;
            }
            for (size_t e = 0; e < h->count; e++) {
                const double a = h->cosine[e], b = h->sine[e];
                double *restrict to = row[h->index[e]];
                for (size_t s = 0; s < count; s++) {
                    to[s] += a * cosine[s] + b * sine[s];
                }
            }
        }
    }
}

/* Durations and lengths of steps, after one of length `last`; loads and limits at t, bases at the middles. 0 if a limit is
 * too large. */
static int few_find_all(struct few_bodies *b, tribo_system *sys, size_t count, const double *t, double last)
{
    double middle[RUN];
    int fits = 1;
    b->h[0] = last;
    for (size_t s = 0; s < count; s++) {
        b->h[s + 1] = t[s + 1] - t[s];
        b->time[s] = 0.5 * ((s ? t[s] - t[s - 1] : last) + (t[s + 1] - t[s]));
        middle[s] = t[s] + 0.5 * (t[s + 1] - t[s]);
    }
    few_find_drives(sys, DRIVES_LOAD, sys->ndof, count, t, b->load);
    few_find_drives(sys, DRIVES_BASE, sys->ncontact, count, middle, b->base);
    const int vary = tribo_system_limits_vary(sys);
    for (size_t s = 0; s < (vary ? count : 1); s++) {
        if (vary) {
            tribo_system_set_time(sys, t[s]);
        }
        tribo_get_limit(sys->contacts, b->limit[s]);
        for (size_t i = 0; i < sys->ncontact; i++) {
            fits &= b->limit[s][i] <= TRIBO_SMALL_MOST;
        }
    }
    return fits;
}

/* Row a [m] times x. */
static inline double row_times(size_t m, const double *a, const double *x)
{
    double sum = a[0] * x[0];
    for (size_t j = 1; j < m; j++) {
        sum += a[j] * x[j];
    }
    return sum;
}

/* The motion of a run, in local memory: compilers keep it in registers. */
struct few_state {
    double q[FEW], u[FEW], v[FEW], energy;
    signed char at[FEW];
};

/* The first steps of a run of n degrees of freedom and c contacts. in_order = 1: without calls. Returns how many of count could
 * be taken; of the next step only motion->at has changed. */
static inline size_t few_steps(struct few_bodies *b, tribo_system *sys, size_t n, size_t c, int in_order, size_t count,
                               struct few_state *motion)
{
    static const double least[FEW] = {0.0};
    struct few_state m = *motion;
    size_t s = 0;
    for (; s < count; s++) {
        const double *limit = b->limit[tribo_system_limits_vary(sys) ? s : 0];
        double u[FEW], v[FEW], less[FEW], most[FEW], base[FEW], p[FEW] = {0.0}, end[FEW], work = 0.0;
        signed char loose[FEW];
        const struct small x = {b->r, b->inverse, &b->inverse_of, b->part, least, v, less, most, m.at, p, end};
        for (size_t d = 0; d < n; d++) {
            const double a = b->load[d][s] - row_times(n, b->damping + d * n, m.u); /* q is known later than u */
            u[d] = m.u[d] + b->time[s] * (a - row_times(n, b->stiffness + d * n, m.q));
        }
        for (size_t i = 0; i < c; i++) {
            base[i] = b->base[i][s];
            v[i] = row_times(n, b->direction + i * n, u) - base[i];
            most[i] = b->time[s] * limit[i];
            less[i] = -most[i];
        }
        if (!tribo_small_solve(c, &x)) {
            break;
        }
        for (size_t d = 0; d < n; d++) {
            u[d] += row_times(c, b->response + d * c, p);
        }
        for (size_t i = 0; i < c; i++) {
            const int holds = m.at[i] == FREE;
            const double to = holds ? 0.0 : end[i];
            loose[i] = !(holds && fabs(p[i]) < most[i]);
            work += sys->tally[i] * p[i] * (m.v[i] + to);
            m.v[i] = to;
        }
        if (b->inverse_of && in_order) { /* makes the velocities of holding contacts exact, but of those at their bounds */
            tribo_snap_all(sys->snaps.list, sys->snaps.count, loose, base, u);
        } else if (b->inverse_of) {
            tribo_system_snap(sys, loose, base, u);
        }
        for (size_t d = 0; d < n; d++) {
            m.q[d] += b->h[s + 1] * u[d];
            m.u[d] = u[d];
        }
        m.energy -= 0.5 * work;
    }
    *motion = m;
    return s;
}

/* Takes steps between the times t [count + 1], count <= RUN, of the motion in y and u, if the system is small. Velocities of y
 * are set by synchronise. Returns the number of steps taken, after which the motion is finite; if it is less than count, the
 * next step is for others. */
static size_t central_run(tribo_driver *drv, size_t count, const double *t, double *y)
{
    struct central *x = drv->own;
    struct few_bodies *b = &x->few;
    tribo_system *sys = drv->sys;
    const size_t n = sys->ndof, c = sys->ncontact;
    if (!few_find_all(b, sys, count, t, x->last)) {
        return 0;
    }
    struct few_state m = {.energy = x->energy};
    memcpy(m.q, y, n * sizeof *y);
    memcpy(m.u, x->common.u, n * sizeof *y);
    memcpy(m.at, b->at, sizeof m.at);
    tribo_step_form_velocity(&x->common, sys, x->when, x->common.u, m.v);
    /* sizes as constants make loops straight: a step then takes half the time */
    const size_t taken = n != c || !sys->snaps.in_order ? few_steps(b, sys, n, c, 0, count, &m)
                         : n == 1                       ? few_steps(b, sys, 1, 1, 1, count, &m)
                         : n == 2                       ? few_steps(b, sys, 2, 2, 1, count, &m)
                         : n == 3                       ? few_steps(b, sys, 3, 3, 1, count, &m)
                                                        : few_steps(b, sys, FEW, FEW, 1, count, &m);
    /* numbers that are not finite come back in every step that follows */
    if (taken == 0 || !isfinite(m.energy) || !tribo_dense_finite(m.q, n) || !tribo_dense_finite(m.u, n)) {
        return 0;
    }
    memcpy(y, m.q, n * sizeof *y);
    memcpy(x->common.u, m.u, n * sizeof *y);
    memcpy(b->at, m.at, sizeof m.at);
    x->last = b->h[taken];
    x->when = t[taken - 1] + 0.5 * x->last;
    y[2 * n] = x->energy = m.energy;
    sys->evaluations += taken;
    return taken;
}

/* ------------------------------------------------------------------------------------------------------------ the method */

/* Takes the settings of the system: of runs, if they have changed, or of blocks. */
static void take_settings(struct central *x, tribo_system *sys)
{
    const size_t revision = tribo_system_revision(sys), c = sys->ncontact;
    struct few_bodies *b = &x->few;
    if (b->revision != revision) {
        b->revision = revision;
        b->fits = sys->ndof <= FEW && c <= FEW && tribo_system_is_plain(sys) && !sys->normals.count;
        if (b->fits) {
            memset(b->damping, 0, sizeof b->damping);
            tribo_matrix_spread(&sys->stiffness, b->stiffness);
            tribo_matrix_spread(&sys->damping, b->damping);
            tribo_matrix_spread(&sys->direction, b->direction);
            tribo_matrix_spread(&sys->response, b->response);
            for (size_t k = 0; k < c * c; k++) {
                b->r[k] = tribo_system_delassus(sys, k / c, k % c);
                b->part[k / c] = tribo_resolution(c);
            }
            memset(b->at, FREE, sizeof b->at);
            b->inverse_of = 0;
            b->fits = tribo_small_fits(c, b->r, b->inverse); /* 0 if R is out of range, or nearly singular */
        }
    }
    if (!b->fits) {
        tribo_blockwise_take(&x->alone, sys);
    }
}

/* A step of few bodies, block by block, or by one problem of all contacts. The first two leave velocities of y to synchronise. */
static int central_step(tribo_driver *drv, double t, double next, const double *from, double *y)
{
    struct central *x = drv->own;
    struct step_form *s = &x->common;
    const size_t n = drv->sys->ndof;
    const double times[] = {t, next}, h = next - t;
    if (drv->seen && x->few.revision != tribo_system_revision(drv->sys)) {
        take_settings(x, drv->sys); /* the observer has changed them */
    }
    if (drv->seen && x->few.fits) {
        memcpy(y, from, n * sizeof *y);
        if (central_run(drv, 1, times, y)) {
            return synchronise(drv, next, y);
        }
    }
    const struct body_step k = {x->when, t, t + 0.5 * h, 0.5 * (x->last + h), h, from, s->u, y, s->spare};
    const int alone = !x->few.fits && x->alone.fits;
    double energy = x->energy;
    int status = TRIBO_OK;
    if (alone) {
        drv->sys->evaluations++;
        if (!tribo_blockwise_step(&x->alone, drv->sys, &k, &energy, &drv->rested) || !isfinite(energy)) {
            return tribo_step_form_fail(drv, TRIBO_ERR_NOT_FINITE, t, NULL);
        }
    } else {
        status = kick(drv, &k, &energy);
        for (size_t i = 0; !status && i < n; i++) {
            y[i] = from[i] + h * k.u_to[i];
            y[n + i] = k.u_to[i];
        }
    }
    y[2 * n] = x->energy = energy;
    status = status || alone ? status : tribo_driver_check(drv, y);
    if (status) {
        return status;
    }
    s->spare = s->u;
    s->u = k.u_to;
    x->last = h;
    x->when = k.to;
    return drv->seen ? synchronise(drv, next, y) : TRIBO_OK;
}

/* TRIBO_ERR_STEP if steps of h are unstable: they are stable while h^2 AK + 2 h AC has no eigenvalue of 4 or more. */
static int check_step(tribo_driver *drv, double h)
{
    struct central *x = drv->own;
    const tribo_system *sys = drv->sys;
    double value, limit = h;
    x->stable = x->common.revision == sys->revision ? x->stable : 0.0;
    x->common.revision = sys->revision;
    if (h <= x->stable) {
        return TRIBO_OK;
    }
    int status = tribo_system_highest(sys, 1.0, lesser(2.0 / h, DBL_MAX), &value);
    if (!status && h * sqrt(value) < 2.0) {
        x->stable = h;
        return TRIBO_OK;
    }
    /* the eigenvalue over h^2 falls with h: limit descends to the largest stable step */
    while (!status && 2.0 / sqrt(value) < 0.9999 * limit) {
        limit = 2.0 / sqrt(value);
        status = tribo_system_highest(sys, 1.0, 2.0 / limit, &value);
    }
    return status ? tribo_driver_pass(drv, status)
                  : tribo_error(drv->message, TRIBO_ERR_STEP,
                                "central differences are unstable in steps of %g: dt must be below %.4g", h, limit);
}

static int central_advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    struct central *x = drv->own;
    struct step_form *s = &x->common;
    const size_t n = drv->sys->ndof;
    const double begin = *t;
    int status = check_step(drv, lesser(drv->dt, t1 - *t));
    if (status) {
        return status;
    }
    if (!continues) {
        memcpy(s->u, y + n, n * sizeof *y);
        x->energy = y[2 * n];
        x->last = 0.0;
        x->when = *t;
    }
    take_settings(x, drv->sys);
    status = tribo_driver_fixed_steps(drv, t, t1, y, central_step, x->few.fits ? central_run : NULL);
    if (status && *t > begin && !drv->seen) {
        memcpy(drv->state + n, s->u, n * sizeof *y);
    }
    return status || drv->seen ? status : synchronise(drv, t1, y);
}

const struct method tribo_method_central_fixed = {.name = "central/fixed",
                                                  .takes = TAKES_STEP | NEEDS_MASS,
                                                  .create = central_create,
                                                  .destroy = central_destroy,
                                                  .advance = central_advance};
