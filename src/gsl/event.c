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
#include "../simd.h"

struct event {
    tribo_system *sys;
    struct modes modes;
    struct search search;
    size_t order;
    double tolerance; /* relative */
    double fastest;   /* bound on the frequencies of the motion */
    size_t revision;
    double tau;            /* where look() was */
    double *q, *u;         /* [order + 1][ndof] coefficients of the powers of time */
    double *watch;         /* [order + 1][ncontact] velocities of sliding contacts, forces of those at rest */
    double *d;             /* [order + 1] dissipated energy */
    double *size, *bend;   /* [ncontact] bounds of what is watched, and of its sixth derivative */
    double *cosine, *sine; /* [order + 2][harmonics] coefficients of cos(omega t) and sin(omega t) */
    double *acceleration, *base, *a, *given, *held;
};

/* ------------------------------------------------------------------------------------------------------------- series */

static void expand_harmonics(struct event *e, double t)
{
    tribo_system *sys = e->sys;
    const size_t h = sys->harmonics;
    tribo_system_set_time(sys, t);
    for (size_t s = 0; s < h; s++) {
        double c = sys->harmonic[s].cos_t, d = sys->harmonic[s].sin_t;
        for (size_t k = 0; k < e->order + 2; k++) {
            const double rate = sys->harmonic[s].omega / (double)(k + 1), next = -rate * d;
            e->cosine[k * h + s] = c;
            e->sine[k * h + s] = d;
            d = rate * c;
            c = next;
        }
    }
}

/* to += factor times the k-th coefficient of the harmonics that load the structure, or move the base. */
static void add_harmonics(const struct event *e, int moves_base, size_t k, double factor, double *to)
{
    for (size_t s = 0; s < e->sys->harmonics; s++) {
        const struct harmonic *w = &e->sys->harmonic[s];
        const double c = factor * e->cosine[k * e->sys->harmonics + s], d = factor * e->sine[k * e->sys->harmonics + s];
        for (size_t i = 0; w->moves_base == moves_base && i < w->count; i++) {
            to[w->index[i]] += c * w->cosine[i] + d * w->sine[i];
        }
    }
}

/* The k-th coefficient of f for the contacts that do not hold: sliding ones follow their limit, others keep their force. */
static void given_forces(struct event *e, size_t k)
{
    const struct modes *m = &e->modes;
    for (size_t i = 0; i < e->sys->ncontact; i++) {
        const double limit = k == 0 ? m->limit[i] : m->limit_rate[i], kept = k == 0 && !m->holds[i] ? m->force[i] : 0.0;
        e->given[i] = m->mode[i] == 0 ? kept : m->mode[i] == 2 ? 0.0 : -m->mode[i] * limit;
    }
}

/* The k-th coefficients of accelerations and of what is watched. Returns a status. */
static int expand_forces(struct event *e, size_t k)
{
    tribo_system *sys = e->sys;
    const size_t n = sys->ndof, c = sys->ncontact;
    const double *q = e->q + k * n, *u = e->u + k * n;
    double *acc = e->acceleration, *watch = e->watch + k * c;
    memset(acc, 0, n * sizeof *acc);
    add_harmonics(e, 0, k, 1.0, acc);
    tribo_matrix_multiply_add(&sys->stiffness, -1.0, q, acc);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, u, acc);
    }
    if (k < 2) {
        tribo_system_tables(sys, (int)k, 1.0, acc);
        given_forces(e, k);
        tribo_matrix_multiply_add(&sys->response, 1.0, e->given, acc);
    }
    memset(e->base, 0, c * sizeof *e->base);
    add_harmonics(e, 1, k + 1, (double)(k + 1), e->base);
    for (size_t i = 0; i < c; i++) {
        e->a[i] = -e->base[i];
    }
    tribo_matrix_multiply_add(&sys->direction, 1.0, acc, e->a);
    const int status = tribo_modes_balance(&e->modes, e->a, e->held);
    if (status) {
        return tribo_system_fail(sys, status, "%s", tribo_message(e->modes.hold));
    }
    tribo_matrix_multiply_add(&sys->response, 1.0, e->held, acc);
    memset(watch, 0, c * sizeof *watch);
    add_harmonics(e, 1, k, -1.0, watch);
    tribo_matrix_multiply_add(&sys->direction, 1.0, u, watch);
    for (size_t i = 0; i < c; i++) {
        const double force = e->held[i] + (k < 2 ? e->given[i] : 0.0);
        watch[i] = e->modes.mode[i] == 0 ? force : k == 0 && e->modes.rested[i] ? 0.0 : watch[i];
    }
    /* contacts at rest must not creep by what rounding leaves in acc */
    return tribo_modes_hold(&e->modes, sys, e->base, acc);
}

/* Coefficients of the motion from (t, y) on. Returns a status. */
static int expand(struct event *e, double t, const double *y)
{
    tribo_system *sys = e->sys;
    const size_t n = sys->ndof, c = sys->ncontact;
    memcpy(e->q, y, n * sizeof *y);
    memcpy(e->u, y + n, n * sizeof *y);
    e->d[0] = y[2 * n];
    expand_harmonics(e, t);
    for (size_t k = 0; k <= e->order; k++) {
        const int status = expand_forces(e, k);
        if (status) {
            return status;
        }
        const double part = 1.0 / (double)(k + 1);
        for (size_t i = 0; k < e->order && i < n; i++) {
            e->q[(k + 1) * n + i] = part * e->u[k * n + i];
            e->u[(k + 1) * n + i] = part * e->acceleration[i];
        }
    }
    sys->evaluations += e->order + 1;
    /* power of the sliding contacts, whose forces are linear in time */
    for (size_t k = 0; k < e->order; k++) {
        double power = 0.0;
        for (size_t i = 0; i < c; i++) {
            const signed char mode = e->modes.mode[i];
            if (mode == 1 || mode == -1) {
                const double rate = k ? e->modes.limit_rate[i] * e->watch[(k - 1) * c + i] : 0.0;
                power -= mode * (e->modes.limit[i] * e->watch[k * c + i] + rate);
            }
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
    const size_t n = e->sys->ndof, c = e->sys->ncontact;
    const double q = drv->abstol + drv->reltol * largest(e->q, n), u = drv->abstol + drv->reltol * largest(e->u, n);
    const double d = drv->abstol + drv->reltol * fabs(e->d[0]);
    double h = 0.5 * (double)(e->order + 1) / e->fastest;
    for (size_t k = e->order - 1; k <= e->order; k++) {
        double term = greater(largest(e->q + k * n, n) / q, greater(largest(e->u + k * n, n) / u, fabs(e->d[k]) / d));
        for (size_t i = 0; i < c; i++) {
            /* forces of contacts at rest to the same part of their limit */
            const double scale = e->modes.mode[i] == 0 ? e->tolerance * e->modes.limit[i] : u;
            term = greater(term, fabs(e->watch[k * c + i]) / scale);
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
    const size_t c = e->sys->ncontact;
    const double *watch = g->watch, s = e->tau;
    double v0 = 0.0, v1 = 0.0, v2 = 0.0;
    for (size_t k = e->order + 1; k-- > 0;) {
        v2 = v2 * s + v1;
        v1 = v1 * s + v0;
        v0 = v0 * s + watch[k * c];
    }
    return (struct sample){g->offset + g->ramp * s + g->side * v0, g->ramp + g->side * v1, 2.0 * g->side * v2};
}

/* Bounds of all that is watched over [0, h]. */
TRIBO_SIMD static void find_bounds(size_t c, size_t order, double h, const double *restrict watch, double *restrict size,
                                   double *restrict bend)
{
    double power = 1.0;
    memset(size, 0, c * sizeof *size);
    memset(bend, 0, c * sizeof *bend);
    for (size_t k = 0; k <= order; k++) {
        const double six =
            k < 6 ? 0.0 : (double)(k * (k - 1) * (k - 2)) * (double)((k - 3) * (k - 4) * (k - 5)) / (h * h * h * h * h * h);
        const double *restrict w = watch + k * c;
        for (size_t i = 0; i < c; i++) {
            const double x = fabs(w[i]) * power;
            size[i] += x;
            bend[i] += six * x;
        }
        power *= h;
    }
}

static void set_guards(struct event *e, double h)
{
    const struct modes *m = &e->modes;
    struct search *s = &e->search;
    s->guards = 0;
    find_bounds(m->contacts, e->order, h, e->watch, e->size, e->bend);
    for (size_t i = 0; i < m->contacts; i++) {
        struct guard g = {.contact = i, .watch = e->watch + i, .side = m->mode[i], .size = e->size[i], .bend = e->bend[i]};
        if (m->mode[i] == 1 || m->mode[i] == -1) {
            g.from_zero = m->rested[i];
            s->guard[s->guards++] = g;
        } else if (m->mode[i] == 0 && e->size[i] >= lesser(m->limit[i], m->limit[i] + m->limit_rate[i] * h)) {
            g.offset = m->limit[i];
            g.ramp = m->limit_rate[i];
            g.size += m->limit[i] + fabs(m->limit_rate[i]) * h;
            for (int side = -1; side <= 1; side += 2) {
                g.side = side;
                g.from_zero = m->weak[i] && side * m->force[i] < 0.0;
                s->guard[s->guards++] = g;
            }
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
        free(e->cosine);
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
    const size_t terms = e->order + 1;
    double *work = malloc((terms * (2 * n + c + 1) + n + 6 * c + 1) * sizeof *work);
    e->search.guard = malloc((2 * c + 1) * sizeof *e->search.guard);
    if (!work || !e->search.guard) {
        free(work);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for method event");
    }
    e->sys = sys;
    e->q = work;
    e->u = e->q + terms * n;
    e->watch = e->u + terms * n;
    e->d = e->watch + terms * c;
    e->acceleration = e->d + terms;
    e->base = e->acceleration + n;
    e->a = e->base + c;
    e->given = e->a + c;
    e->held = e->given + c;
    e->size = e->held + c;
    e->bend = e->size + c;
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

/* A bound on the frequencies: no exponent of the structure, held or not, and no load is faster. And room for the harmonics, which
 * may have become more. */
static int prepare(struct event *e)
{
    const tribo_system *sys = e->sys;
    if (e->cosine && e->revision == sys->revision) {
        return TRIBO_OK;
    }
    const size_t room = (e->order + 2) * sys->harmonics + 1;
    double *more = realloc(e->cosine, 2 * room * sizeof *more);
    if (!more) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for %zu harmonics", sys->harmonics);
    }
    e->cosine = more;
    e->sine = more + room;
    e->fastest = greater(sqrt(row_sum(&sys->stiffness)), sys->damping.rows ? row_sum(&sys->damping) : 0.0);
    for (size_t s = 0; s < sys->harmonics; s++) {
        e->fastest = greater(e->fastest, fabs(sys->harmonic[s].omega));
    }
    e->revision = sys->revision;
    return TRIBO_OK;
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
    int status = prepare(e);
    status = status ? status : tribo_modes_start(&e->modes, sys, *t, y, continues);
    if (status) {
        return tribo_driver_fail(drv, status, "%s", tribo_message(sys->contacts));
    }
    const double shortest = 1.0 / greater(e->fastest, 1.0 / (t1 - *t));
    while (!status && *t < t1) {
        status = expand(e, *t, y);
        if (status) {
            return tribo_driver_fail(drv, status, "at t = %.17g: %s", *t, tribo_message(sys->contacts));
        }
        const double end = lesser(t1, tribo_system_next_kink(sys, *t)), length = step_length(e, drv),
                     h = lesser(length, end - *t);
        if (!(*t + h > *t)) {
            return tribo_driver_fail(drv, TRIBO_ERR_STEP, "at t = %.17g the step is down to %g", *t, h);
        }
        double when = h;
        /* bounds over a time of the structure's: what is rounding must not depend on where the run is to end */
        set_guards(e, e->fastest > 0.0 ? greater(h, lesser(length, 1.0 / e->fastest)) : h);
        const struct guard *event = tribo_search(&e->search, h, &when);
        when = event ? lesser(when, h) : h;
        move_to(e, when, y);
        *t = when < end - *t ? *t + when : end;
        drv->steps++;
        status = tribo_modes_proceed(&e->modes, drv, &e->search, event, *t, y, shortest);
        if (!status) {
            status = tribo_driver_accept(drv, *t, y, event != NULL);
        }
    }
    return status;
}

const struct method tribo_method_event = {"event", 1, create, destroy, advance, NULL};
