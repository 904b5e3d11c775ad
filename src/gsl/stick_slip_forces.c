/* The forces of contacts at an instant, within their bounds, and the accelerations that these leave. */
#include "stick_slip.h"
#include "../common/real.h"

#include <math.h>
#include <string.h>

/* The force within bounds that lets contact i go on as it does, where without it the acceleration is a. One that friction cannot
 * move takes all that it can of any pull. */
static double force_alone(const struct stick_slip *m, size_t i, double a)
{
    const double pull = m->diagonal[i] > 0.0 ? a / m->diagonal[i] : a != 0.0 ? copysign(HUGE_VAL, a) : 0.0;
    return clamp(-pull, m->lo[i], m->hi[i]);
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

/* The only contact whose bounds leave it a choice, ncontact if there is none; 0 if there are more. */
static int find_only(const struct stick_slip *m, size_t *only)
{
    *only = m->contacts;
    for (size_t i = 0; i < m->contacts; i++) {
        if (m->lo[i] < m->hi[i]) {
            if (*only < m->contacts) {
                return 0;
            }
            *only = i;
        }
    }
    return 1;
}

/* The solution where the forces of all contacts but one are known. */
static void solve_only(struct stick_slip *m, const tribo_system *sys, size_t only, const double *a, double *f)
{
    memcpy(f, m->lo, m->contacts * sizeof *f);
    if (only < m->contacts) {
        f[only] = 0.0;
        tribo_matrix_multiply(&sys->response, f, m->rate);
        f[only] = force_alone(m, only, a[only] + tribo_matrix_row_dot(&sys->direction, only, m->rate));
    }
}

static int solve_coupled(struct stick_slip *m, const tribo_system *sys, const double *a, double *f)
{
    size_t only;
    if (m->independent && find_only(m, &only)) {
        solve_only(m, sys, only, a, f);
        return TRIBO_OK;
    }
    const int status = tribo_solve_box(m->box, a, m->lo, m->hi, f);
    return status ? tribo_system_fail(sys, status, "at t = %.17g: %s", sys->time, tribo_message(m->box)) : TRIBO_OK;
}

static inline int solve(struct stick_slip *m, const tribo_system *sys, const double *a, double *f)
{
    for (size_t k = 0; m->uncoupled && k < m->asks; k++) {
        const size_t i = m->asked[k];
        f[i] = force_alone(m, i, a[i]);
    }
    return m->uncoupled ? TRIBO_OK : solve_coupled(m, sys, a, f);
}

int tribo_stick_slip_solve(struct stick_slip *m, const tribo_system *sys, const double *a, double *f)
{
    return solve(m, sys, a, f);
}

/* The force that contact i has whatever the others do. */
static double given_force(const struct stick_slip *m, size_t i)
{
    return m->elastic[i] ? m->spring[i] : m->slip[i] == 2 ? 0.0 : -m->slip[i] * m->limit[i];
}

/* Bounds of the force of contact i, as it does what it is marked to do. */
static void set_bounds(struct stick_slip *m, size_t i)
{
    if (tribo_stick_slip_searches(m, i)) {
        m->lo[i] = -m->stick[i];
        m->hi[i] = m->stick[i];
    } else {
        m->lo[i] = m->hi[i] = given_force(m, i);
    }
}

int tribo_stick_slip_find_forces(struct stick_slip *m, tribo_system *sys)
{
    for (size_t k = 0; k < m->asks; k++) {
        set_bounds(m, m->asked[k]);
    }
    return solve(m, sys, m->a, m->force);
}
