#include "modes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int tribo_modes_create(struct modes *m, tribo_system *sys)
{
    const size_t c = sys->ncontact + 1, n = sys->ndof;
    memset(m, 0, sizeof *m);
    m->patience = 64 + 16 * sys->ncontact;
    int status = tribo_clone(sys->contacts, &m->judge);
    double *work = malloc((10 * c + 2 * n + m->patience) * sizeof *work);
    m->mode = malloc(2 * c);
    m->limit = work;
    if (status || !work || !m->mode) {
        tribo_modes_free(m);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the modes of %zu contacts", sys->ncontact);
    }
    m->weak = m->mode + c;
    m->force = work + c;
    m->v = work + 2 * c;
    m->a = work + 3 * c;
    m->rate = work + 4 * c;
    m->lo = work + 5 * c;
    m->hi = work + 6 * c;
    m->diagonal = work + 7 * c;
    m->base = work + 8 * c;
    m->base_rate = work + 9 * c;
    m->acceleration = work + 10 * c;
    m->jerk = m->acceleration + n;
    m->recent = m->jerk + n;
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->diagonal[i] = 0.0;
        for (size_t k = sys->direction.first[i]; k < sys->direction.first[i + 1]; k++) {
            m->diagonal[i] += sys->direction.val[k] * tribo_matrix_get(&sys->response, sys->direction.col[k], i);
        }
    }
    tribo_set_law(m->judge, TRIBO_COULOMB);
    tribo_set_coupling(m->judge, TRIBO_CONSISTENT);
    return TRIBO_OK;
}

void tribo_modes_free(struct modes *m)
{
    tribo_destroy(m->judge);
    free(m->limit);
    free(m->mode);
    memset(m, 0, sizeof *m);
}

/* What of v_i may be rounding. */
static double noise(const tribo_system *sys, const struct modes *m, const double *u, size_t i)
{
    const struct matrix *j = &sys->direction;
    double sum = 0.0, size = 0.0;
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        sum += j->val[k] * u[j->col[k]];
        size += fabs(j->val[k] * u[j->col[k]]);
    }
    return 1e-14 * (size + fabs(m->v[i] - sum));
}

int tribo_modes_start(struct modes *m, tribo_system *sys, double t, double *y, int continues)
{
    tribo_get_limit(sys->contacts, m->limit);
    tribo_set_limit(m->judge, m->limit);
    tribo_system_free_motion(sys, t, y, m->acceleration, m->v, m->a);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (m->limit[i] == 0.0) {
            m->mode[i] = 2;
        } else if (!continues || m->mode[i] == 2) {
            m->mode[i] = (signed char)(fabs(m->v[i]) <= noise(sys, m, y + sys->ndof, i) ? 0 : m->v[i] > 0.0 ? 1 : -1);
        }
    }
    m->events = 0;
    tribo_modes_project(m, sys, t, y);
    return tribo_modes_decide(m, sys, t, y);
}

/* The contacts at their limit: those whose rate of f_eq would take it beyond the limit slide off. */
static int decide_by_rates(struct modes *m, tribo_system *sys, const double *y)
{
    const size_t n = sys->ndof, c = sys->ncontact;
    memset(m->jerk, 0, n * sizeof *m->jerk);
    memset(m->a, 0, c * sizeof *m->a);
    tribo_system_harmonics(sys, 0, 1, 1.0, m->jerk);
    tribo_matrix_multiply_add(&sys->stiffness, -1.0, y + n, m->jerk);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, m->acceleration, m->jerk);
    }
    tribo_system_harmonics(sys, 1, 2, -1.0, m->a);
    tribo_matrix_multiply_add(&sys->direction, 1.0, m->jerk, m->a);
    double bound = 0.0;
    for (size_t i = 0; i < c; i++) {
        bound = fmax(bound, m->diagonal[i] > 0.0 ? 1e3 * fabs(m->a[i]) / m->diagonal[i] : 0.0);
    }
    for (size_t i = 0; i < c; i++) {
        const int rests = m->mode[i] == 0, weak = m->weak[i];
        m->lo[i] = rests && !(weak && m->force[i] < 0.0) ? -bound : 0.0;
        m->hi[i] = rests && !(weak && m->force[i] > 0.0) ? bound : 0.0;
    }
    const int status = tribo_solve_box(m->judge, m->a, m->lo, m->hi, m->rate);
    if (status) {
        return tribo_system_fail(sys, status, "%s", tribo_message(m->judge));
    }
    for (size_t i = 0; i < c; i++) {
        m->lo[i] = fabs(m->a[i]);
    }
    tribo_matrix_multiply_add(&sys->response, 1.0, m->rate, m->jerk);
    memset(m->a, 0, c * sizeof *m->a);
    tribo_system_harmonics(sys, 1, 2, -1.0, m->a);
    tribo_matrix_multiply_add(&sys->direction, 1.0, m->jerk, m->a);
    for (size_t i = 0; i < c; i++) {
        const double side = m->force[i] > 0.0 ? -1.0 : 1.0;
        if (m->weak[i] && side * m->a[i] > TRIBO_AT_LIMIT * m->lo[i]) {
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
        if (m->mode[i] == 0 && fabs(feq) > (1.0 + TRIBO_AT_LIMIT) * limit) {
            m->mode[i] = feq > 0.0 ? -1 : 1;
        } else if (m->mode[i] == 0 && fabs(feq) >= (1.0 - TRIBO_AT_LIMIT) * limit) {
            m->weak[i] = 1;
            weak = 1;
        }
    }
    tribo_matrix_multiply_add(&sys->response, 1.0, m->force, m->acceleration);
    return weak ? decide_by_rates(m, sys, y) : TRIBO_OK;
}

/* Marks sliding contacts that are about to meet v = 0 within rounding as at rest; how many. */
static size_t arrive(struct modes *m, const tribo_system *sys, const double *y)
{
    const struct matrix *j = &sys->direction;
    size_t count = 0;
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (m->mode[i] != 1 && m->mode[i] != -1) {
            continue;
        }
        m->v[i] = tribo_modes_velocity(m, sys, i, y);
        if (m->mode[i] * m->v[i] > noise(sys, m, y + sys->ndof, i)) {
            continue;
        }
        double a = -m->base_rate[i];
        for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
            a += j->val[k] * m->acceleration[j->col[k]];
        }
        if (m->mode[i] * a < -TRIBO_AT_LIMIT * m->diagonal[i] * m->limit[i]) {
            m->mode[i] = 0;
            count++;
        }
    }
    return count;
}

int tribo_modes_decide(struct modes *m, tribo_system *sys, double t, const double *y)
{
    memset(m->base, 0, 2 * (sys->ncontact + 1) * sizeof *m->base);
    tribo_system_set_time(sys, t);
    tribo_system_harmonics(sys, 1, 0, 1.0, m->base);
    tribo_system_harmonics(sys, 1, 1, 1.0, m->base_rate);
    int status;
    size_t rounds = 0;
    do {
        status = decide_by_forces(m, sys, t, y);
    } while (!status && arrive(m, sys, y) && rounds++ < sys->ncontact);
    return status;
}

void tribo_modes_project(struct modes *m, tribo_system *sys, double t, double *y)
{
    const struct matrix *j = &sys->direction;
    double *u = y + sys->ndof, *base = m->base;
    memset(base, 0, sys->ncontact * sizeof *base);
    tribo_system_set_time(sys, t);
    tribo_system_harmonics(sys, 1, 0, 1.0, base);
    for (int sweep = 0; sweep < 4; sweep++) {
        double left = 0.0;
        for (size_t i = 0; i < sys->ncontact; i++) {
            const size_t first = j->first[i], last = j->first[i + 1];
            if (m->mode[i] != 0 || first == last) {
                continue;
            }
            double off = -base[i], square = 0.0;
            for (size_t k = first; k < last; k++) {
                off += j->val[k] * u[j->col[k]];
                square += j->val[k] * j->val[k];
            }
            left = fmax(left, fabs(off));
            if (off != 0.0 && last - first <= 2) {
                const double other = last - first == 2 ? j->val[first] * u[j->col[first]] : 0.0;
                u[j->col[last - 1]] = (base[i] - other) / j->val[last - 1];
            } else if (off != 0.0) {
                for (size_t k = first; k < last; k++) {
                    u[j->col[k]] -= off * j->val[k] / square;
                }
            }
        }
        if (left == 0.0) {
            return;
        }
    }
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

int tribo_modes_proceed(struct modes *m, tribo_driver *drv, const struct guard *event, double t, double *y, double shortest)
{
    if (event) {
        const size_t slot = m->events++ % m->patience;
        drv->events++;
        if (m->events > m->patience && t - m->recent[slot] < 1e-6 * shortest) {
            return tribo_driver_fail(drv, TRIBO_ERR_CHATTER, "%zu events up to t = %.17g took no time, the last one of contact %zu", m->patience,
                                     t, event->contact);
        }
        m->recent[slot] = t;
        if (event->offset == 0.0) {
            m->mode[event->contact] = 0;
        }
    }
    tribo_modes_project(m, drv->sys, t, y);
    const int status = tribo_modes_decide(m, drv->sys, t, y);
    return status ? tribo_driver_fail(drv, status, "%s", tribo_message(drv->sys->contacts)) : TRIBO_OK;
}
