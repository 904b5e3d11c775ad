/* The forces of contacts at an instant, within their bounds, and the accelerations that these leave. */
#include "stick_slip.h"
#include "common/real.h"
#include "common/simd.h"

#include <math.h>
#include <string.h>

/* Where contacts are not coupled only rounding may take a force beyond the limit, and only if it is this close. */
#define NEAR 1e-3

/* So few contacts are not worth getting ready for more. */
enum { FEW = 3 };

/* The force between lo and hi that lets contact i go on as it does, where without it the acceleration is a. One that friction
 * cannot move takes all that it can of any pull. */
static inline double force_alone(const struct stick_slip *m, size_t i, double a, double lo, double hi)
{
    const double pull = m->constant.diagonal[i] > 0.0 ? a / m->constant.diagonal[i] : a != 0.0 ? copysign(HUGE_VAL, a) : 0.0;
    return clamp(-pull, lo, hi);
}

/* Rounding of R may hide a heavy body, that of its factors does not. */
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

/* Whether no more than one contact is searched for, where that can be told of each alone; and which one. */
static int has_only(struct stick_slip *m)
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

/* The force between lo and hi of the only contact that is searched for: it is decided about alone, the others having theirs in
 * f. */
static double find_force(struct stick_slip *m, const tribo_system *sys, double a, double lo, double hi, double *f)
{
    const struct matrix *j = &sys->direction;
    f[m->work.single] = 0.0;
    m->work.single_a = a;
    for (size_t k = j->first[m->work.single], end = j->first[m->work.single + 1]; k < end; k++) {
        m->work.single_a += j->val[k] * tribo_matrix_row_dot(&sys->response, j->col[k], f);
    }
    return force_alone(m, m->work.single, m->work.single_a, lo, hi);
}

static int solve_box(struct stick_slip *m, const tribo_system *sys, const double *a, double *f)
{
    const int status = tribo_solve_box(m->constant.box, a, m->work.lo, m->work.hi, f);
    return status ? tribo_system_fail(sys, status, "at t = %.17g: %s", sys->time, tribo_message(m->constant.box)) : TRIBO_OK;
}

int tribo_stick_slip_solve(struct stick_slip *m, const tribo_system *sys, const double *a, double *f)
{
    for (size_t k = 0; m->constant.uncoupled && k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        f[i] = force_alone(m, i, a[i], m->work.lo[i], m->work.hi[i]);
    }
    if (m->constant.uncoupled) {
        return TRIBO_OK;
    }
    if (!has_only(m)) {
        return solve_box(m, sys, a, f);
    }
    memcpy(f, m->work.lo, m->constant.contacts * sizeof *f);
    if (m->work.single < m->constant.contacts) {
        f[m->work.single] = find_force(m, sys, a[m->work.single], m->work.lo[m->work.single], m->work.hi[m->work.single], f);
    }
    return TRIBO_OK;
}

/* The force that contact i has whatever the others do. */
static inline double given_force(const struct stick_slip *m, size_t i)
{
    return m->constant.elastic[i]                ? m->state.spring[i]
           : m->state.slip[i] == TRIBO_SLIP_OPEN ? 0.0
                                                 : -m->state.slip[i] * m->state.limit[i];
}

/* Of contacts that are not coupled: force [n], as by given_force or force_alone, and over [n], how far it is above this part of
 * the limit; below 0 for one that is not at rest. Of elastic ones both are those of any other. */
static inline void find_alone(size_t n, const signed char *restrict slip, const double *restrict a,
                              const double *restrict diagonal, const double *restrict limit, const double *restrict stick,
                              double part, double *restrict force, double *restrict over)
{
    for (size_t i = 0; i < n; i++) {
        const double far = a[i] > 0.0 ? HUGE_VAL : a[i] < 0.0 ? -HUGE_VAL : 0.0;
        const double by = diagonal[i] > 0.0 ? diagonal[i] : 1.0, pull = diagonal[i] > 0.0 ? a[i] / by : far;
        const double held = clamp(-pull, -stick[i], stick[i]), given = -slip[i] * limit[i];
        const int rests = slip[i] == TRIBO_SLIP_STUCK;
        force[i] = rests ? held : given;
        over[i] = rests ? fabs(held) - part * stick[i] : -1.0;
    }
}

TRIBO_SIMD static void find_many_alone(const struct stick_slip *m, double *restrict over)
{
    find_alone(m->constant.contacts, m->state.slip, m->work.a, m->constant.diagonal, m->state.limit, m->state.stick, 1.0 - NEAR,
               m->state.force, over);
}

static void put_springs(struct stick_slip *m, double *over)
{
    for (size_t i = 0; i < m->constant.contacts; i++) {
        m->state.force[i] = m->constant.elastic[i] ? m->state.spring[i] : m->state.force[i];
        over[i] = m->constant.elastic[i] ? -1.0 : over[i];
    }
}

/* Forces of contacts that are not coupled, and who is near its limit, or has reached it. */
static void find_all_alone(struct stick_slip *m, const tribo_system *sys)
{
    const size_t n = m->constant.contacts;
    double *const over = m->work.f;
    size_t near = 0;
    if (n > FEW) {
        find_many_alone(m, over);
    }
    for (size_t i = 0; n <= FEW && i < n; i++) {
        find_alone(1, m->state.slip + i, m->work.a + i, m->constant.diagonal + i, m->state.limit + i, m->state.stick + i,
                   1.0 - NEAR, m->state.force + i, over + i);
    }
    if (sys->compliance.count) {
        put_springs(m, over);
    }
    if (m->state.reached < n && tribo_stick_slip_searches(m, m->state.reached)) {
        over[m->state.reached] = 0.0;
    }
    for (size_t i = 0; i < n; i++) {
        if (over[i] >= 0.0) {
            m->work.close[near++] = i;
        }
    }
    m->work.close_count = near;
}

/* Bounds of forces, as contacts do what they are marked to do. */
static void set_bounds(struct stick_slip *m)
{
    for (size_t i = 0; i < m->constant.contacts; i++) {
        const int searches = tribo_stick_slip_searches(m, i);
        m->work.hi[i] = searches ? m->state.stick[i] : given_force(m, i);
        m->work.lo[i] = searches ? -m->state.stick[i] : m->work.hi[i];
    }
}

/* Whether the force of contact i, which is searched for, is close to its limit, or has reached it. */
static inline int is_close(const struct stick_slip *m, size_t i)
{
    return fabs(m->state.force[i]) >= (1.0 - TRIBO_CLOSE) * m->state.stick[i] || i == m->state.reached;
}

/* If any contact is close to its limit, all that are at rest may be at theirs. */
static void find_close(struct stick_slip *m)
{
    size_t rest = 0;
    int any = 0;
    for (size_t i = 0; i < m->constant.contacts; i++) {
        const int searches = tribo_stick_slip_searches(m, i);
        m->work.close[rest] = i;
        rest += (size_t)searches;
        any |= searches && is_close(m, i);
    }
    m->work.close_count = any ? rest : 0;
}

/* All forces where no more than one is searched for. */
static void find_only(struct stick_slip *m, const tribo_system *sys)
{
    const size_t only = m->work.single;
    for (size_t i = 0; i < m->constant.contacts; i++) {
        m->state.force[i] = given_force(m, i);
    }
    m->work.close_count = 0;
    if (only < m->constant.contacts) {
        m->state.force[only] = find_force(m, sys, m->work.a[only], -m->state.stick[only], m->state.stick[only], m->state.force);
        m->work.close[0] = only;
        m->work.close_count = (size_t)is_close(m, only);
    }
}

int tribo_stick_slip_find_forces(struct stick_slip *m, tribo_system *sys)
{
    if (m->constant.uncoupled || has_only(m)) {
        (m->constant.uncoupled ? find_all_alone : find_only)(m, sys);
        return TRIBO_OK;
    }
    set_bounds(m);
    const int status = solve_box(m, sys, m->work.a, m->state.force);
    find_close(m);
    return status;
}
