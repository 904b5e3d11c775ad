/* The forces of contacts at an instant, within their bounds, and the accelerations that these leave. */
#include "stick_slip.h"
#include "../common/real.h"
#include "../common/simd.h"

#include <math.h>
#include <string.h>

/* By rounding alone, which is far less. */
#define NEAR 1e-3

/* The force between lo and hi that lets contact i go on as it does, where without it the acceleration is a. One that friction
 * cannot move takes all that it can of any pull. */
static inline double force_alone(const struct stick_slip *m, size_t i, double a, double lo, double hi)
{
    const double pull = m->diagonal[i] > 0.0 ? a / m->diagonal[i] : a != 0.0 ? copysign(HUGE_VAL, a) : 0.0;
    return clamp(-pull, lo, hi);
}

/* Rounding of R may hide a heavy body, that of its factors does not. */
void tribo_stick_slip_accelerate(struct stick_slip *m, const tribo_system *sys, const double *a, const double *f, double *v)
{
    for (size_t k = 0; k < m->asks; k++) {
        const size_t i = m->asked[k];
        v[i] = a[i] + (m->uncoupled ? m->diagonal[i] * f[i] : 0.0);
    }
    if (!m->uncoupled) {
        tribo_matrix_multiply(&sys->response, f, m->rate);
        tribo_matrix_multiply_add(&sys->direction, 1.0, m->rate, v);
    }
}

void tribo_stick_slip_accelerate_searched(struct stick_slip *m, const tribo_system *sys, const double *a, const double *f,
                                          double *v)
{
    if (m->only < m->contacts) {
        v[m->only] = m->pull + m->diagonal[m->only] * f[m->only];
    } else {
        tribo_stick_slip_accelerate(m, sys, a, f, v);
    }
}

/* The only contact whose force is searched for, ncontact if there is none; 0 if there are more. */
static int find_only(struct stick_slip *m)
{
    m->only = m->contacts;
    for (size_t i = 0; i < m->contacts; i++) {
        if (tribo_stick_slip_searches(m, i)) {
            if (m->only < m->contacts) {
                m->only = m->contacts;
                return 0;
            }
            m->only = i;
        }
    }
    return 1;
}

/* The solution where the forces of all contacts but one are known: that one is decided about alone. */
static void solve_only(struct stick_slip *m, const tribo_system *sys, const double *a, double *f)
{
    const struct matrix *j = &sys->direction;
    const size_t only = m->only;
    memcpy(f, m->lo, m->contacts * sizeof *f);
    if (only < m->contacts) {
        f[only] = 0.0;
        m->pull = a[only];
        for (size_t k = j->first[only]; k < j->first[only + 1]; k++) {
            m->pull += j->val[k] * tribo_matrix_row_dot(&sys->response, j->col[k], f);
        }
        f[only] = force_alone(m, only, m->pull, m->lo[only], m->hi[only]);
    }
}

static int solve_coupled(struct stick_slip *m, const tribo_system *sys, const double *a, double *f)
{
    if (m->independent && find_only(m)) {
        solve_only(m, sys, a, f);
        return TRIBO_OK;
    }
    const int status = tribo_solve_box(m->box, a, m->lo, m->hi, f);
    return status ? tribo_system_fail(sys, status, "at t = %.17g: %s", sys->time, tribo_message(m->box)) : TRIBO_OK;
}

int tribo_stick_slip_solve(struct stick_slip *m, const tribo_system *sys, const double *a, double *f)
{
    for (size_t k = 0; m->uncoupled && k < m->asks; k++) {
        const size_t i = m->asked[k];
        f[i] = force_alone(m, i, a[i], m->lo[i], m->hi[i]);
    }
    return m->uncoupled ? TRIBO_OK : solve_coupled(m, sys, a, f);
}

/* The force that contact i has whatever the others do. */
static inline double given_force(const struct stick_slip *m, size_t i)
{
    return m->elastic[i] ? m->spring[i] : m->slip[i] == 2 ? 0.0 : -m->slip[i] * m->limit[i];
}

/* Of contacts that are not coupled: force [n], as by given_force or force_alone, and over [n], how far it is above this part of the
 * limit; below 0 for one that is not at rest. Of elastic ones both are those of any other. */
TRIBO_SIMD static void find_alone(size_t n, const signed char *restrict slip, const double *restrict a,
                                  const double *restrict diagonal, const double *restrict limit, const double *restrict stick,
                                  double part, double *restrict force, double *restrict over)
{
    for (size_t i = 0; i < n; i++) {
        const double far = a[i] > 0.0 ? HUGE_VAL : a[i] < 0.0 ? -HUGE_VAL : 0.0;
        const double by = diagonal[i] > 0.0 ? diagonal[i] : 1.0, pull = diagonal[i] > 0.0 ? a[i] / by : far;
        const double held = clamp(-pull, -stick[i], stick[i]), given = -slip[i] * limit[i];
        const int rests = slip[i] == 0;
        force[i] = rests ? held : given;
        over[i] = rests ? fabs(held) - part * stick[i] : -1.0;
    }
}

static void put_springs(struct stick_slip *m, double *over)
{
    for (size_t i = 0; i < m->contacts; i++) {
        m->force[i] = m->elastic[i] ? m->spring[i] : m->force[i];
        over[i] = m->elastic[i] ? -1.0 : over[i];
    }
}

/* Forces of contacts that are not coupled, and who is near its limit, or has reached it. */
static void find_all_alone(struct stick_slip *m, const tribo_system *sys)
{
    const size_t n = m->contacts;
    double *const over = m->f;
    size_t near = 0;
    find_alone(n, m->slip, m->a, m->diagonal, m->limit, m->stick, 1.0 - NEAR, m->force, over);
    if (sys->massless.count) {
        put_springs(m, over);
    }
    if (m->reached < n && tribo_stick_slip_searches(m, m->reached)) {
        over[m->reached] = 0.0;
    }
    for (size_t i = 0; i < n; i++) {
        if (over[i] >= 0.0) {
            m->close[near++] = i;
        }
    }
    m->closes = near;
}

/* Bounds of forces, as contacts do what they are marked to do. */
static void set_bounds(struct stick_slip *m)
{
    for (size_t i = 0; i < m->contacts; i++) {
        const int searches = tribo_stick_slip_searches(m, i);
        m->hi[i] = searches ? m->stick[i] : given_force(m, i);
        m->lo[i] = searches ? -m->stick[i] : m->hi[i];
    }
}

/* If any contact is close to its limit, all that are at rest may be at theirs. */
static void find_close(struct stick_slip *m)
{
    size_t rest = 0;
    int any = 0;
    for (size_t i = 0; i < m->contacts; i++) {
        const int searches = tribo_stick_slip_searches(m, i);
        m->close[rest] = i;
        rest += (size_t)searches;
        any |= searches && (fabs(m->force[i]) >= (1.0 - TRIBO_CLOSE) * m->stick[i] || i == m->reached);
    }
    m->closes = any ? rest : 0;
}

int tribo_stick_slip_find_forces(struct stick_slip *m, tribo_system *sys)
{
    if (m->uncoupled) {
        find_all_alone(m, sys);
        return TRIBO_OK;
    }
    set_bounds(m);
    const int status = solve_coupled(m, sys, m->a, m->force);
    find_close(m);
    return status;
}
