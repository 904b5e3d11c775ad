/* SPDX-License-Identifier: BSD-3-Clause */
/* The holding contacts H: an independent set of the contacts at rest that keeps all of them where they are. */
#include "numerics/constraint.h"
#include "stick_slip.h"

#include <float.h>
#include <math.h>
#include <string.h>

int tribo_stick_slip_balance(struct stick_slip *m, const double *a, double *f)
{
    const struct slip_constant *c = &m->constant;
    const signed char *loose = m->state.loose;
    if (c->uncoupled) {
        for (size_t i = 0; i < c->contacts; i++) {
            f[i] = loose[i] ? 0.0 : -a[i] / c->diagonal[i];
        }
        return TRIBO_OK;
    }
    int status = TRIBO_OK;
    if (m->state.hold_differs) { /* constant.hold knows H by limits 1 (holds) and 0 */
        for (size_t i = 0; i < c->contacts; i++) {
            f[i] = loose[i] ? 0.0 : 1.0;
        }
        m->state.hold_differs = 0;
        status = tribo_set_limit(c->hold, f);
    }
    status = status ? status : tribo_balance(c->hold, c->still, a, f, NULL);
    return status ? tribo_error(c->sys->message, status, "%s", tribo_message(c->hold)) : TRIBO_OK;
}

void tribo_stick_slip_set_hold(struct stick_slip *m, size_t i, int holds)
{
    struct slip_state *s = &m->state;
    const int rests = s->slip[i] == TRIBO_SLIP_STUCK, loose = !holds || tribo_force_is_state(m, i);
    s->dependents += (size_t)(rests && !holds);
    s->dependents -= (size_t)(s->key[i] == 1);
    s->hold_differs |= loose != s->loose[i];
    s->snaps_differ |= loose != s->loose[i];
    s->holds[i] = (unsigned char)holds;
    s->loose[i] = (signed char)loose;
    s->key[i] = (signed char)(rests + holds);
}

int tribo_stick_slip_find_holds(struct stick_slip *m, const tribo_system *sys)
{
    const struct slip_constant *c = &m->constant;
    struct slip_state *s = &m->state;
    const size_t n = c->contacts;
    if (c->independent || (!s->fresh && memcmp(s->before, s->tied, n) == 0)) {
        return TRIBO_OK;
    }
    struct constraints ties = {0};
    size_t rest = 0, *at = m->work.at;
    for (size_t i = 0; i < n; i++) {
        s->holds[i] = s->slip[i] == TRIBO_SLIP_STUCK && tribo_can_hold(m, i);
        at[rest] = i;
        m->work.last[rest] = (unsigned char)(s->tied[i] == 1 ? 2 : s->tied[i] == 2);
        rest += s->holds[i] && !tribo_force_is_state(m, i);
    }
    if (rest > 1) {
        /* an independent set: first contacts inside their limits, then those that go back inside, then those at their limits */
        if (!tribo_constraints_create(&ties, &sys->direction, &sys->mass, at, rest, m->work.last)) {
            tribo_constraints_free(&ties);
            return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s at rest", rest, plural(rest));
        }
        for (size_t k = ties.rank; k < rest; k++) {
            s->holds[at[ties.order[k]]] = 0;
        }
        tribo_constraints_free(&ties);
    }
    for (size_t i = 0; i < n; i++) {
        tribo_stick_slip_set_hold(m, i, s->holds[i]);
    }
    memcpy(s->before, s->tied, n);
    s->fresh = 0;
    return TRIBO_OK;
}

/* The second time removes the rounding of the first. */
int tribo_stick_slip_project(struct stick_slip *m, const tribo_system *sys, const double *base, double *x)
{
    const int status = tribo_stick_slip_pull(m, sys, base, x, m->work.f);
    return status ? status : tribo_stick_slip_pull(m, sys, base, x, m->work.f);
}

int tribo_stick_slip_hold(struct stick_slip *m, const tribo_system *sys, const double *base, double *x)
{
    struct slip_state *s = &m->state;
    int status = TRIBO_OK;
    if (s->snaps_differ && !sys->snaps.in_order) {
        size_t holding = 0;
        for (size_t i = 0; i < m->constant.contacts; i++) {
            holding += !s->loose[i];
        }
        s->snaps = tribo_system_list_snaps(sys, s->loose, s->snap);
        s->simple = s->snaps == holding;
    }
    s->snaps_differ = 0;
    tribo_snap_all(s->snap, s->snaps, s->loose, base, x);
    int moves = 0; /* 1: J x - base of a holding contact exceeds the rounding of x */
    for (size_t i = 0; !s->simple && i < m->constant.contacts; i++) {
        const double size = tribo_matrix_row_size(&sys->direction, i, x) + fabs(base[i]);
        const double rest = fabs(tribo_matrix_row_dot(&sys->direction, i, x) - base[i]);
        moves |= !s->loose[i] && rest > 4.0 * DBL_EPSILON * size;
    }
    if (moves) {
        status = tribo_stick_slip_project(m, sys, base, x);
        tribo_snap_all(s->snap, s->snaps, s->loose, base, x);
    }
    return status;
}
