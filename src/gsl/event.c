/* Method "event": Coulomb's law itself on any system. While the modes of the contacts last, the motion is smooth, and its Taylor
 * series at the start of a step follows from the equations of motion, one product with the structure's matrices and one solve for
 * the held contacts an order; velocities and forces of the contacts come out as polynomials too.
 *
 * Why no event is missed: on a step of length h, at most (order + 1)/2 over the highest frequency that structure or loads can
 * have, what the series leaves out is less than its last term, and that is below the tolerance; and the search on the polynomials
 * cannot skip a zero (roots.h). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "driver.h"
#include "modes.h"
#include "search.h"
#include "../real.h"

struct event {
    tribo_system *sys;
    struct modes modes;
    struct search search;
    size_t order;
    double tolerance; /* relative */
    double fastest;   /* bound on the frequencies of the motion */
    size_t revision;
    double tau;    /* where look() was */
    double *q, *u; /* [order + 1][ndof] coefficients of the powers of time */
    double *v, *f; /* [ncontact][order + 1] */
    double *d;     /* [order + 1] dissipated energy */
    double *acceleration, *zero, *a, *force, *largest;
};

/* ------------------------------------------------------------------------------------------------------------- series */

/* The k-th coefficient of f for the contacts that do not hold: sliding ones follow their limit, others keep their force. */
static void given_forces(const struct event *e, size_t k, double *force)
{
    const struct modes *m = &e->modes;
    for (size_t i = 0; i < e->sys->ncontact; i++) {
        const double limit = k == 0 ? m->limit[i] : k == 1 ? m->limit_rate[i] : 0.0;
        force[i] = m->mode[i] == 0 ? (k == 0 && !m->holds[i] ? m->force[i] : 0.0) : m->mode[i] == 2 ? 0.0 : -m->mode[i] * limit;
    }
}

/* Coefficients of the motion from (t, y) on. Returns a status. */
static int expand(struct event *e, double t, const double *y)
{
    tribo_system *sys = e->sys;
    const size_t n = sys->ndof, c = sys->ncontact, stride = e->order + 1;
    memcpy(e->q, y, n * sizeof *y);
    memcpy(e->u, y + n, n * sizeof *y);
    e->d[0] = y[2 * n];
    tribo_system_set_time(sys, t);
    double factorial = 1.0;
    for (size_t k = 0; k < stride; k++) {
        double *acc = e->acceleration, *v = e->zero, *a = e->a;
        const double *q = e->q + k * n, *u = e->u + k * n;
        factorial *= k ? (double)k : 1.0;
        memset(acc, 0, n * sizeof *acc);
        memset(v, 0, c * sizeof *v);
        memset(a, 0, c * sizeof *a);
        tribo_system_loads(sys, 1, (int)k, -1.0 / factorial, v);
        tribo_matrix_multiply_add(&sys->direction, 1.0, u, v);
        for (size_t i = 0; i < c; i++) {
            e->v[i * stride + k] = e->modes.mode[i] == 0 || (k == 0 && e->modes.rested[i]) ? 0.0 : v[i];
        }
        given_forces(e, k, e->force);
        tribo_system_loads(sys, 0, (int)k, 1.0 / factorial, acc);
        tribo_matrix_multiply_add(&sys->stiffness, -1.0, q, acc);
        if (sys->damping.rows) {
            tribo_matrix_multiply_add(&sys->damping, -1.0, u, acc);
        }
        tribo_matrix_multiply_add(&sys->response, 1.0, e->force, acc);
        tribo_system_loads(sys, 1, (int)k + 1, -1.0 / factorial, a);
        tribo_matrix_multiply_add(&sys->direction, 1.0, acc, a);
        double *held = e->largest;
        int status = tribo_modes_balance(&e->modes, a, held);
        if (status) {
            return tribo_system_fail(sys, status, "at t = %.17g: %s", t, tribo_message(e->modes.hold));
        }
        for (size_t i = 0; i < c; i++) {
            e->f[i * stride + k] = e->force[i] + held[i];
        }
        tribo_matrix_multiply_add(&sys->response, 1.0, held, acc);
        /* contacts at rest must not creep by what rounding leaves in acc */
        memset(a, 0, c * sizeof *a);
        tribo_system_loads(sys, 1, (int)k + 1, 1.0 / factorial, a);
        status = tribo_modes_hold(&e->modes, sys, a, acc);
        if (status) {
            return status;
        }
        for (size_t i = 0; k + 1 < stride && i < n; i++) {
            e->q[(k + 1) * n + i] = u[i] / (double)(k + 1);
            e->u[(k + 1) * n + i] = acc[i] / (double)(k + 1);
        }
        sys->evaluations++;
    }
    /* power: forces of sliding contacts are linear in time at most */
    for (size_t k = 0; k + 1 < stride; k++) {
        double power = 0.0;
        for (size_t i = 0; i < c; i++) {
            const double *f = e->f + i * stride, *v = e->v + i * stride;
            power += e->modes.mode[i] == 0 ? 0.0 : f[0] * v[k] + (k ? f[1] * v[k - 1] : 0.0);
        }
        e->d[k + 1] = -sys->power * power / (double)(k + 1);
    }
    return TRIBO_OK;
}

static double largest(const double *x, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        most = greater(most, fabs(x[i]));
    }
    return most;
}

/* The step on which the last two terms of everything stay below the tolerance. */
static double step_length(const struct event *e, const tribo_driver *drv)
{
    const size_t n = e->sys->ndof, c = e->sys->ncontact, stride = e->order + 1;
    const double q = drv->abstol + drv->reltol * largest(e->q, n), u = drv->abstol + drv->reltol * largest(e->u, n);
    const double d = drv->abstol + drv->reltol * fabs(e->d[0]);
    double h = 0.5 * (double)stride / e->fastest;
    for (size_t k = e->order - 1; k <= e->order; k++) {
        double term = greater(largest(e->q + k * n, n) / q, greater(largest(e->u + k * n, n) / u, fabs(e->d[k]) / d));
        for (size_t i = 0; i < c; i++) {
            /* contacts at rest: their forces, to the same part of the limit; sliding ones: their velocities */
            const int rests = e->modes.mode[i] == 0;
            term = greater(term, fabs((rests ? e->f : e->v)[i * stride + k]) / (rests ? e->tolerance * e->modes.limit[i] : u));
        }
        h = term > 0.0 ? lesser(h, pow(term, -1.0 / (double)k)) : h;
    }
    return h;
}

/* --------------------------------------------------------------------------------------------------------- guards */

static void look(void *motion, double tau)
{
    ((struct event *)motion)->tau = tau;
}

static struct sample read_guard(const void *motion, const struct guard *g)
{
    const struct event *e = motion;
    const double *c = g->watch, s = e->tau;
    double v0 = 0.0, v1 = 0.0, v2 = 0.0;
    for (size_t k = e->order + 1; k-- > 0;) {
        v2 = v2 * s + v1;
        v1 = v1 * s + v0;
        v0 = v0 * s + c[k];
    }
    return (struct sample){g->offset + g->ramp * s + g->side * v0, g->ramp + g->side * v1, 2.0 * g->side * v2};
}

/* Bounds of a polynomial and of its sixth derivative over [0, h]. */
static void bound(const double *c, size_t order, double h, double *size, double *bend)
{
    double power = 1.0;
    *size = 0.0;
    *bend = 0.0;
    for (size_t k = 0; k <= order; k++) {
        *size += fabs(c[k]) * power;
        power *= h;
    }
    power = 1.0;
    for (size_t k = 6; k <= order; k++) {
        *bend += (double)(k * (k - 1) * (k - 2)) * (double)((k - 3) * (k - 4) * (k - 5)) * fabs(c[k]) * power;
        power *= h;
    }
}

static void set_guards(struct event *e, double h)
{
    const size_t stride = e->order + 1;
    const struct modes *m = &e->modes;
    e->search.guards = 0;
    for (size_t i = 0; i < e->sys->ncontact; i++) {
        struct guard g = {.contact = i, .watch = (m->mode[i] ? e->v : e->f) + i * stride, .side = m->mode[i]};
        if (m->mode[i] == 2) {
            continue;
        }
        bound(g.watch, e->order, h, &g.size, &g.bend);
        if (m->mode[i] != 0) {
            g.from_zero = m->rested[i];
            e->search.guard[e->search.guards++] = g;
            continue;
        }
        g.offset = m->limit[i];
        g.ramp = m->limit_rate[i];
        const int near = g.size >= lesser(m->limit[i], m->limit[i] + m->limit_rate[i] * h);
        g.size += m->limit[i] + fabs(m->limit_rate[i]) * h;
        for (int side = -1; near && side <= 1; side += 2) {
            g.side = side;
            g.from_zero = m->weak[i] && side * m->force[i] < 0.0;
            e->search.guard[e->search.guards++] = g;
        }
    }
}

/* ------------------------------------------------------------------------------------------------------- the driver */

static void destroy(tribo_driver *drv)
{
    struct event *e = drv->own;
    if (e) {
        tribo_modes_free(&e->modes);
        free(e->q);
        free(e->search.guard);
        free(e);
    }
}

static int create(tribo_driver *drv)
{
    tribo_system *sys = drv->sys;
    const size_t n = sys->ndof, c = sys->ncontact;
    struct event *e = calloc(1, sizeof *e);
    drv->own = e;
    int status = e ? tribo_modes_create(&e->modes, sys) : TRIBO_ERR_MEMORY;
    if (status) {
        return tribo_system_fail(sys, status, "out of memory for method event");
    }
    /* the more digits are wanted, the more terms pay */
    e->tolerance = lesser(greater(lesser(drv->abstol, greater(drv->reltol, drv->abstol)), 1e-16), 1e-2);
    e->order = (size_t)(10.0 - 1.5 * log10(e->tolerance));
    const size_t stride = e->order + 1;
    double *work = malloc((2 * stride * n + 2 * stride * c + stride + n + 4 * c + 1) * sizeof *work);
    e->search.guard = malloc((2 * c + 1) * sizeof *e->search.guard);
    if (!work || !e->search.guard) {
        free(work);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for method event");
    }
    e->sys = sys;
    e->q = work;
    e->u = e->q + stride * n;
    e->v = e->u + stride * n;
    e->f = e->v + stride * c;
    e->d = e->f + stride * c;
    e->acceleration = e->d + stride;
    e->zero = e->acceleration + n;
    e->a = e->zero + c;
    e->force = e->a + c;
    e->largest = e->force + c;
    e->search.look = look;
    e->search.read = read_guard;
    e->search.motion = e;
    return TRIBO_OK;
}

static double row_sum(const struct matrix *a)
{
    double most = 0.0;
    for (size_t i = 0; i < a->rows; i++) {
        double sum = 0.0;
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            sum += fabs(a->val[k]);
        }
        most = greater(most, sum);
    }
    return most;
}

/* No exponent of the structure, held or not, and no load is faster than this. */
static void find_fastest(struct event *e)
{
    const tribo_system *sys = e->sys;
    e->fastest = greater(sqrt(row_sum(&sys->stiffness)), sys->damping.rows ? row_sum(&sys->damping) : 0.0);
    for (size_t s = 0; s < sys->harmonics; s++) {
        e->fastest = greater(e->fastest, fabs(sys->harmonic[s].omega));
    }
    e->revision = sys->revision;
}

/* State and energy at tau. */
static void move_to(const struct event *e, double tau, double *y)
{
    const size_t n = e->sys->ndof;
    memset(y, 0, (2 * n + 1) * sizeof *y);
    for (size_t k = e->order + 1; k-- > 0;) {
        for (size_t i = 0; i < n; i++) {
            y[i] = y[i] * tau + e->q[k * n + i];
            y[n + i] = y[n + i] * tau + e->u[k * n + i];
        }
        y[2 * n] = y[2 * n] * tau + e->d[k];
    }
}

static int advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    struct event *e = drv->own;
    tribo_system *sys = drv->sys;
    if (e->fastest == 0.0 || e->revision != sys->revision) {
        find_fastest(e);
    }
    int status = tribo_modes_start(&e->modes, sys, *t, y, continues);
    if (status) {
        return tribo_driver_fail(drv, status, "%s", tribo_message(sys->contacts));
    }
    while (!status && *t < t1) {
        status = expand(e, *t, y);
        if (status) {
            return tribo_driver_fail(drv, status, "%s", tribo_message(sys->contacts));
        }
        const double end = lesser(t1, tribo_system_next_kink(sys, *t)), length = step_length(e, drv),
                     h = lesser(length, end - *t);
        if (!(*t + h > *t)) {
            return tribo_driver_fail(drv, TRIBO_ERR_STEP, "at t = %.17g the step is down to %g", *t, h);
        }
        double when = h;
        set_guards(e, h);
        const struct guard *event = tribo_search(&e->search, h, &when);
        when = event ? lesser(when, h) : h;
        move_to(e, when, y);
        *t = when < end - *t ? *t + when : end;
        drv->steps++;
        status = tribo_modes_proceed(&e->modes, drv, &e->search, event, *t, y, 1.0 / e->fastest);
        if (!status) {
            status = tribo_driver_tell(drv, *t, y, event != NULL);
        }
    }
    return status;
}

const struct method tribo_method_event = {"event", 1, create, destroy, advance, NULL};
