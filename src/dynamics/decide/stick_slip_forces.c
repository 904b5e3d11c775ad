/* The forces of contacts at an instant, within their bounds, and the accelerations that these leave. */
#include "stick_slip.h"
#include "common/real.h"

#include <math.h>
#include <string.h>

/* R diagonal: only rounding takes a force beyond the limit, and only from this part of the limit below it. */
#define NEAR 1e-3

/* clamp(-a/R_ii, lo, hi); for R_ii = 0 the bound against a. */
static inline double force_alone(const struct slip_constant *c, size_t i, double a, double lo, double hi)
{
    const double pull = c->diagonal[i] > 0.0 ? a / c->diagonal[i] : a != 0.0 ? copysign(HUGE_VAL, a) : 0.0;
    return clamp(-pull, lo, hi);
}

/* J (M^-1 J' f) in the place of R f: rounding of R may hide a heavy body, that of its factors does not. */
void tribo_stick_slip_accelerate(struct stick_slip *m, const tribo_system *sys, const double *a, const double *f, double *v)
{
    for (size_t k = 0; k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        v[i] = a[i] + (m->constant.uncoupled ? m->constant.diagonal[i] * f[i] : 0.0);
    }
    if (!m->constant.uncoupled) {
        tribo_matrix_multiply(&sys->response, f, m->work.rate);
        tribo_matrix_multiply_add(&sys->direction, 1.0, m->work.rate, v);
    }
}

/* Sets work.single. Returns 1 if at most one force is unknown, and no contact depends on others. */
static int has_single(struct stick_slip *m)
{
    size_t found = 0;
    m->work.single = m->constant.contacts;
    for (size_t i = 0; i < m->constant.contacts; i++) {
        if (tribo_stick_slip_searches(m, i)) {
            m->work.single = i;
            found++;
        }
    }
    if (found > 1 || !m->constant.independent) {
        m->work.single = m->constant.contacts;
    }
    return found <= 1 && m->constant.independent;
}

/* Sets f_i of the single contact, -limit..limit, at acceleration a_i without friction, from the other forces in f. */
static void find_single(struct stick_slip *m, const tribo_system *sys, const double *a, double lo, double hi, double *f)
{
    const struct matrix *j = &sys->direction;
    const size_t i = m->work.single;
    double sum = a[i];
    f[i] = 0.0;
    for (size_t k = j->first[i], end = j->first[i + 1]; k < end; k++) {
        sum += j->val[k] * tribo_matrix_row_dot(&sys->response, j->col[k], f);
    }
    m->work.single_a = sum;
    f[i] = force_alone(&m->constant, i, sum, lo, hi);
}

static int solve_box(struct stick_slip *m, const tribo_system *sys, const double *a, double *f)
{
    const int status = tribo_solve_box(m->constant.box, a, m->work.lo, m->work.hi, f);
    return status ? tribo_system_fail(sys, status, "at t = %.17g: %s", sys->time, tribo_message(m->constant.box)) : TRIBO_OK;
}

int tribo_stick_slip_solve(struct stick_slip *m, const tribo_system *sys, const double *a, double *f)
{
    const double *lo = m->work.lo, *hi = m->work.hi;
    if (m->constant.uncoupled) {
        for (size_t k = 0; k < m->work.undecided_count; k++) {
            const size_t i = m->work.undecided[k];
            f[i] = force_alone(&m->constant, i, a[i], lo[i], hi[i]);
        }
        return TRIBO_OK;
    }
    if (!has_single(m)) {
        return solve_box(m, sys, a, f);
    }
    memcpy(f, lo, m->constant.contacts * sizeof *f);
    if (m->work.single < m->constant.contacts) {
        find_single(m, sys, a, lo[m->work.single], hi[m->work.single], f);
    }
    return TRIBO_OK;
}

/* The force of contact i that does not depend on the others. */
static inline double given_force(const struct stick_slip *m, size_t i)
{
    const struct slip_state *s = &m->state;
    return m->constant.elastic[i] ? s->spring[i] : s->slip[i] == TRIBO_SLIP_OPEN ? 0.0 : -s->slip[i] * s->limit[i];
}

/* R diagonal: all forces; work.close = contacts near their limits, and state.reached. */
static void find_all_alone(struct stick_slip *m, const tribo_system *sys)
{
    struct slip_state *s = &m->state;
    const size_t n = m->constant.contacts;
    const signed char *restrict slip = s->slip;
    const double *restrict a = m->work.a, *restrict diagonal = m->constant.diagonal, *restrict stick = s->stick;
    double *restrict force = s->force, *restrict over = m->work.f; /* over: |f| - (1 - NEAR) limit at rest, else -1 */
    for (size_t i = 0; i < n; i++) {
        const double far = a[i] > 0.0 ? HUGE_VAL : a[i] < 0.0 ? -HUGE_VAL : 0.0;
        const double by = diagonal[i] > 0.0 ? diagonal[i] : 1.0, pull = diagonal[i] > 0.0 ? a[i] / by : far;
        const double held = clamp(-pull, -stick[i], stick[i]), given = -slip[i] * s->limit[i];
        const int rests = slip[i] == TRIBO_SLIP_STUCK;
        force[i] = rests ? held : given;
        over[i] = rests ? fabs(held) - (1.0 - NEAR) * stick[i] : -1.0;
    }
    for (size_t i = 0; sys->compliance.count && i < n; i++) {
        force[i] = m->constant.elastic[i] ? s->spring[i] : force[i];
        over[i] = m->constant.elastic[i] ? -1.0 : over[i];
    }
    if (s->reached < n && tribo_stick_slip_searches(m, s->reached)) {
        over[s->reached] = 0.0;
    }
    size_t near = 0;
    for (size_t i = 0; i < n; i++) {
        if (over[i] >= 0.0) {
            m->work.close[near++] = i;
        }
    }
    m->work.close_count = near;
}

/* 1 if the force of contact i, at rest, is close to its limit, or has reached it. */
static inline int is_close(const struct stick_slip *m, size_t i)
{
    return fabs(m->state.force[i]) >= (1.0 - TRIBO_CLOSE) * m->state.stick[i] || i == m->state.reached;
}

int tribo_stick_slip_find_forces(struct stick_slip *m, tribo_system *sys)
{
    struct slip_state *s = &m->state;
    struct slip_work *w = &m->work;
    const size_t n = m->constant.contacts;
    if (m->constant.uncoupled) {
        find_all_alone(m, sys);
        return TRIBO_OK;
    }
    if (has_single(m)) {
        const size_t single = w->single;
        for (size_t i = 0; i < n; i++) {
            s->force[i] = given_force(m, i);
        }
        w->close_count = 0;
        if (single < n) {
            find_single(m, sys, w->a, -s->stick[single], s->stick[single], s->force);
            w->close[0] = single;
            w->close_count = (size_t)is_close(m, single);
        }
        return TRIBO_OK;
    }
    for (size_t i = 0; i < n; i++) {
        const int searches = tribo_stick_slip_searches(m, i);
        w->hi[i] = searches ? s->stick[i] : given_force(m, i);
        w->lo[i] = searches ? -s->stick[i] : w->hi[i];
    }
    const int status = solve_box(m, sys, w->a, s->force);
    size_t rest = 0;
    int any = 0;
    for (size_t i = 0; i < n; i++) { /* if any contact is close to its limit, all contacts at rest may be at theirs */
        const int searches = tribo_stick_slip_searches(m, i);
        w->close[rest] = i;
        rest += (size_t)searches;
        any |= searches && is_close(m, i);
    }
    w->close_count = any ? rest : 0;
    return status;
}
