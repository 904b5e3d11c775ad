#include "modes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A balancing force this close to the limit counts as just at it: far above rounding, and far below what a wrong guess could change. */
#define AT_LIMIT 1e-9

/* Velocities are known to this part of what they are the sum of. */
#define NOISE 1e-14

int tribo_modes_create(struct modes *m, tribo_system *sys)
{
    const size_t c = sys->ncontact + 1, n = sys->ndof;
    memset(m, 0, sizeof *m);
    m->patience = 64 + 16 * sys->ncontact;
    int status = tribo_clone(sys->contacts, &m->judge);
    status = status ? status : tribo_clone(sys->contacts, &m->hold);
    double *work = malloc((11 * c + 2 * n + m->patience) * sizeof *work);
    m->mode = malloc(5 * c);
    m->limit = work;
    if (status || !work || !m->mode) {
        tribo_modes_free(m);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the modes of %zu contacts", sys->ncontact);
    }
    m->weak = m->mode + c;
    m->holds = (unsigned char *)m->mode + 2 * c;
    m->blocked = m->holds + c;
    m->rested = m->blocked + c;
    m->force = work + c;
    m->v = work + 2 * c;
    m->a = work + 3 * c;
    m->rate = work + 4 * c;
    m->lo = work + 5 * c;
    m->hi = work + 6 * c;
    m->diagonal = work + 7 * c;
    m->base = work + 8 * c;
    m->limit_rate = work + 9 * c;
    m->noise = work + 10 * c;
    m->acceleration = work + 11 * c;
    m->jerk = m->acceleration + n;
    m->recent = m->jerk + n;
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->diagonal[i] = tribo_system_delassus(sys, i, i);
    }
    size_t islands;
    tribo_get_count(m->judge, TRIBO_COUNT_ISLANDS, &islands);
    m->uncoupled = islands == sys->ncontact;
    tribo_set_law(m->judge, TRIBO_COULOMB);
    tribo_set_coupling(m->judge, TRIBO_CONSISTENT);
    tribo_set_law(m->hold, TRIBO_COULOMB);
    tribo_set_coupling(m->hold, TRIBO_PARTITION);
    m->simple = 1;
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->simple &= sys->direction.first[i + 1] - sys->direction.first[i] <= 1;
    }
    return TRIBO_OK;
}

void tribo_modes_free(struct modes *m)
{
    tribo_destroy(m->judge);
    tribo_destroy(m->hold);
    free(m->limit);
    free(m->mode);
    memset(m, 0, sizeof *m);
}

/* What of the velocities may be rounding, as far as the state alone tells. */
static void find_noise(struct modes *m, const tribo_system *sys, const double *y)
{
    const struct matrix *j = &sys->direction;
    const double *u = y + sys->ndof;
    for (size_t i = 0; i < sys->ncontact; i++) {
        double size = fabs(m->base[i]);
        for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
            size += fabs(j->val[k] * u[j->col[k]]);
        }
        m->noise[i] = NOISE * size;
    }
}

static signed char mode_of_velocity(const struct modes *m, size_t i)
{
    return (signed char)(fabs(m->v[i]) <= m->noise[i] ? 0 : m->v[i] > 0.0 ? 1 : -1);
}

/* Brings limits, and with them which contacts are open, up to the time of v. */
static void update_limits(struct modes *m, const tribo_system *sys)
{
    tribo_system_limits(sys, m->limit, m->limit_rate);
    tribo_set_limit(m->judge, m->limit);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (m->limit[i] == 0.0 && m->limit_rate[i] == 0.0) {
            m->mode[i] = 2;
        } else if (m->mode[i] == 2) {
            m->mode[i] = mode_of_velocity(m, i);
        }
    }
}

int tribo_modes_start(struct modes *m, tribo_system *sys, double t, double *y, int continues)
{
    tribo_system_free_motion(sys, t, y, m->acceleration, m->v, m->a);
    tribo_system_limits(sys, m->limit, m->limit_rate);
    memset(m->base, 0, sys->ncontact * sizeof *m->base);
    tribo_system_loads(sys, 1, 0, 1.0, m->base);
    find_noise(m, sys, y);
    for (size_t i = 0; !continues && i < sys->ncontact; i++) {
        m->mode[i] = (signed char)(m->limit[i] == 0.0 ? 2 : mode_of_velocity(m, i));
    }
    m->events = 0;
    return tribo_modes_decide(m, sys, t, y);
}

/* Bounds for the rates of forces: sliding ones follow their limit, those just at their limit may not go beyond. */
static void set_rate_bounds(struct modes *m, size_t c, double bound)
{
    for (size_t i = 0; i < c; i++) {
        const int rests = m->mode[i] == 0;
        const double side = !rests ? -m->mode[i] : m->force[i] > 0.0 ? 1.0 : -1.0;
        const double along = m->mode[i] == 2 ? 0.0 : side * m->limit_rate[i];
        m->lo[i] = rests && !(m->weak[i] && side < 0.0) ? -bound : along;
        m->hi[i] = rests && !(m->weak[i] && side > 0.0) ? bound : along;
    }
}

/* The contacts at their limit: those whose rate of f_eq would take it beyond the limit slide off. */
static int decide_by_rates(struct modes *m, tribo_system *sys, const double *y)
{
    const size_t n = sys->ndof, c = sys->ncontact;
    memset(m->jerk, 0, n * sizeof *m->jerk);
    memset(m->a, 0, c * sizeof *m->a);
    tribo_system_loads(sys, 0, 1, 1.0, m->jerk);
    tribo_matrix_multiply_add(&sys->stiffness, -1.0, y + n, m->jerk);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, m->acceleration, m->jerk);
    }
    tribo_system_loads(sys, 1, 2, -1.0, m->a);
    tribo_matrix_multiply_add(&sys->direction, 1.0, m->jerk, m->a);
    double bound = 0.0;
    for (size_t i = 0; i < c; i++) {
        bound = fmax(bound, m->diagonal[i] > 0.0 ? fabs(m->a[i]) / m->diagonal[i] : 0.0);
        bound = fmax(bound, fabs(m->limit_rate[i]));
    }
    const double scale = bound;
    int status, short_of = 1;
    /* the box wants bounds where there are none; if they matter, they were too narrow */
    for (int round = 0; round < 4 && short_of; round++) {
        bound *= 1e3;
        set_rate_bounds(m, c, bound);
        status = tribo_solve_box(m->judge, m->a, m->lo, m->hi, m->rate);
        if (status) {
            return tribo_system_fail(sys, status, "%s", tribo_message(m->judge));
        }
        short_of = 0;
        for (size_t i = 0; i < c; i++) {
            short_of |= m->mode[i] == 0 && fabs(m->rate[i]) >= bound && bound > 0.0;
        }
    }
    for (size_t i = 0; i < c; i++) {
        m->blocked[i] = !(m->rate[i] > m->lo[i] && m->rate[i] < m->hi[i]);
    }
    tribo_matrix_multiply_add(&sys->response, 1.0, m->rate, m->jerk);
    memset(m->a, 0, c * sizeof *m->a);
    tribo_system_loads(sys, 1, 2, -1.0, m->a);
    tribo_matrix_multiply_add(&sys->direction, 1.0, m->jerk, m->a);
    for (size_t i = 0; i < c; i++) {
        const double side = m->force[i] > 0.0 ? -1.0 : 1.0;
        if (m->weak[i] && side * m->a[i] > AT_LIMIT * m->diagonal[i] * scale) {
            m->mode[i] = (signed char)side;
            m->force[i] = -side * m->limit[i];
        }
    }
    return TRIBO_OK;
}

/* Forces and accelerations with the contacts at rest as they are marked, and what the forces say about them. */
static int decide_by_forces(struct modes *m, tribo_system *sys, double t, const double *y)
{
    tribo_system_free_motion(sys, t, y, m->acceleration, m->v, m->a);
    update_limits(m, sys);
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->v[i] = m->mode[i] == 2 ? 0.0 : m->mode[i];
    }
    const int status = tribo_balance(m->judge, m->v, m->a, m->rate, m->force);
    if (status) {
        return tribo_system_fail(sys, status, "at t = %.17g: %s", t, tribo_message(m->judge));
    }
    int weak = 0;
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double feq = m->rate[i], limit = m->limit[i];
        m->weak[i] = 0;
        m->blocked[i] = 0;
        if (m->mode[i] == 0 && fabs(feq) > (1.0 + AT_LIMIT) * limit) {
            m->mode[i] = feq > 0.0 ? -1 : 1;
        } else if (m->mode[i] == 0 && fabs(feq) >= (1.0 - AT_LIMIT) * limit) {
            m->weak[i] = 1;
            weak = 1;
        }
    }
    tribo_matrix_multiply_add(&sys->response, 1.0, m->force, m->acceleration);
    return weak ? decide_by_rates(m, sys, y) : TRIBO_OK;
}

/* The contacts that hold get limits in the context that finds their forces, the others none. */
static void set_hold(struct modes *m, const tribo_system *sys)
{
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->lo[i] = m->holds[i] ? 1.0 : 0.0;
    }
    tribo_set_limit(m->hold, m->lo);
}

/* Of the contacts at rest, marks an independent set as holding; such whose forces can go both ways if there are enough of them. */
static int find_holds(struct modes *m, const tribo_system *sys)
{
    const size_t c = sys->ncontact;
    size_t rest = 0;
    for (size_t i = 0; i < c; i++) {
        m->holds[i] = m->mode[i] == 0 && m->diagonal[i] > 0.0;
        rest += m->holds[i];
    }
    if (m->uncoupled || rest < 2) {
        set_hold(m, sys);
        return TRIBO_OK;
    }
    size_t p = 0, *at = malloc(2 * rest * sizeof *at), *order = at + rest;
    double *r = malloc(rest * rest * sizeof *r);
    unsigned char *last = malloc(rest);
    if (!at || !r || !last) {
        free(at);
        free(r);
        free(last);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for %zu contacts at rest", rest);
    }
    for (size_t i = 0; i < c; i++) {
        if (m->holds[i]) {
            last[p] = (unsigned char)(m->weak[i] + m->blocked[i]);
            at[p++] = i;
        }
    }
    for (p = 0; p < rest; p++) {
        for (size_t q = 0; q < rest; q++) {
            r[p * rest + q] = tribo_system_delassus(sys, at[p], at[q]);
        }
    }
    for (size_t k = tribo_independent_rows(r, rest, last, order); k < rest; k++) {
        m->holds[at[order[k]]] = 0;
    }
    free(at);
    free(r);
    free(last);
    set_hold(m, sys);
    return TRIBO_OK;
}

/* x -= B_I R_II^-1 (J_I x - base) over the contacts that hold, twice, since the first time leaves rounding; then the last bits. */
int tribo_modes_hold(struct modes *m, tribo_system *sys, const double *base, double *x)
{
    const size_t c = sys->ncontact;
    for (int pass = 0; pass < 2 && !m->simple; pass++) {
        memset(m->v, 0, c * sizeof *m->v);
        for (size_t i = 0; i < c; i++) {
            m->a[i] = -base[i];
        }
        tribo_matrix_multiply_add(&sys->direction, 1.0, x, m->a);
        const int status = tribo_balance(m->hold, m->v, m->a, m->rate, NULL);
        if (status) {
            return tribo_system_fail(sys, status, "%s", tribo_message(m->hold));
        }
        tribo_matrix_multiply_add(&sys->response, 1.0, m->rate, x);
    }
    tribo_system_snap(sys, m->mode, base, x);
    return TRIBO_OK;
}

int tribo_modes_decide(struct modes *m, tribo_system *sys, double t, double *y)
{
    double *u = y + sys->ndof;
    memset(m->base, 0, sys->ncontact * sizeof *m->base);
    tribo_system_set_time(sys, t);
    tribo_system_loads(sys, 1, 0, 1.0, m->base);
    memset(m->weak, 0, sys->ncontact);
    memset(m->blocked, 0, sys->ncontact);
    int status = TRIBO_OK;
    size_t found = 1;
    /* whoever has no velocity is decided about, also those that another contact now holds, or that have only just been let go */
    while (!status && found) {
        status = find_holds(m, sys);
        status = status ? status : tribo_modes_hold(m, sys, m->base, u);
        found = 0;
        for (size_t i = 0; !status && i < sys->ncontact; i++) {
            if ((m->mode[i] == 1 || m->mode[i] == -1) && fabs(tribo_modes_velocity(m, sys, i, y)) <= m->noise[i]) {
                m->mode[i] = 0;
                found++;
            }
        }
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->v[i] = tribo_modes_velocity(m, sys, i, y);
        m->rested[i] = m->mode[i] == 0;
    }
    status = status ? status : decide_by_forces(m, sys, t, y);
    return status ? status : find_holds(m, sys);
}

double tribo_modes_velocity(const struct modes *m, const tribo_system *sys, size_t i, const double *y)
{
    const struct matrix *j = &sys->direction;
    double v = -m->base[i];
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        v += j->val[k] * y[sys->ndof + j->col[k]];
    }
    return v;
}

int tribo_modes_proceed(struct modes *m, tribo_driver *drv, const struct search *search, const struct guard *event, double t, double *y,
                        double shortest)
{
    for (size_t k = 0; k < search->guards; k++) {
        const struct guard *g = &search->guard[k];
        m->noise[g->contact] = g->offset == 0.0 ? NOISE * g->size : m->noise[g->contact];
    }
    if (event) {
        const size_t slot = m->events++ % m->patience;
        drv->events++;
        if (m->events > m->patience && t - m->recent[slot] < 1e-6 * shortest) {
            return tribo_driver_fail(drv, TRIBO_ERR_CHATTER,
                                     "%zu events up to t = %.17g took no time, the last one of contact %zu", m->patience, t,
                                     event->contact);
        }
        m->recent[slot] = t;
        if (event->offset == 0.0) {
            m->mode[event->contact] = 0;
        }
    }
    const int status = tribo_modes_decide(m, drv->sys, t, y);
    return status ? tribo_driver_fail(drv, status, "%s", tribo_message(drv->sys->contacts)) : TRIBO_OK;
}
