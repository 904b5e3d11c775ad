/* The holding contacts H: an independent set of the contacts at rest that keeps all of them where they are. */
#include "numerics/constraint.h"
#include "stick_slip.h"

#include <float.h>
#include <math.h>
#include <string.h>

int tribo_stick_slip_balance(struct stick_slip *m, const double *a, double *f)
{
    const struct slip_constant *c = &m->constant;
    int status = TRIBO_OK;
    for (size_t i = 0; c->uncoupled && i < c->contacts; i++) {
        f[i] = tribo_stick_slip_balance_alone(m, i, a[i]);
    }
    if (m->state.hold_differs && !c->uncoupled) {
        /* constant.hold knows H by limits 1 (holds) and 0 */
        for (size_t i = 0; i < c->contacts; i++) {
            f[i] = m->state.loose[i] ? 0.0 : 1.0;
        }
        m->state.hold_differs = 0;
        status = tribo_set_limit(c->hold, f);
    }
    return status || c->uncoupled ? status : tribo_balance(c->hold, c->still, a, f, NULL);
}

/* Reduces holds[] to an independent set: first contacts inside their limits, then those that go back inside, then those at their
 * limits. */
static int choose_holds(struct stick_slip *m, const tribo_system *sys)
{
    struct constraints c = {0};
    size_t rest = 0, *at = m->work.at;
    for (size_t i = 0; i < m->constant.contacts; i++) {
        const signed char tied = m->state.tied[i];
        at[rest] = i;
        m->work.last[rest] = (unsigned char)(tied == 0 ? 0 : tied == 2 ? 1 : 2);
        rest += tribo_stick_slip_searches(m, i) && m->constant.can_hold[i];
    }
    const int done = rest < 2 || tribo_constraints_create(&c, &sys->direction, &sys->mass, at, rest, m->work.last);
    for (size_t k = done && rest > 1 ? c.rank : rest; k < rest; k++) {
        m->state.holds[at[c.order[k]]] = 0;
    }
    tribo_constraints_free(&c);
    return done ? TRIBO_OK
                : tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s at rest", rest, plural(rest));
}

int tribo_stick_slip_find_holds(struct stick_slip *m, const tribo_system *sys)
{
    const struct slip_constant *c = &m->constant;
    struct slip_state *s = &m->state;
    if (!c->independent) {
        s->fresh |= memcmp(s->before, s->tied, c->contacts) != 0;
        memcpy(s->before, s->tied, c->contacts);
    }
    if (!s->fresh) {
        return TRIBO_OK;
    }
    s->fresh = 0;
    for (size_t i = 0; i < c->contacts; i++) {
        s->holds[i] = (s->slip[i] == TRIBO_SLIP_STUCK) & c->can_hold[i];
    }
    const int status = c->independent ? TRIBO_OK : choose_holds(m, sys);
    s->dependents = 0;
    for (size_t i = 0; i < c->contacts; i++) {
        const signed char loose = (signed char)(!s->holds[i] || c->elastic[i]);
        s->unlisted |= loose != s->loose[i];
        s->dependents += tribo_stick_slip_depends(m, i);
        s->loose[i] = loose;
        s->key[i] = (signed char)((s->slip[i] == TRIBO_SLIP_STUCK) + s->holds[i]);
    }
    s->hold_differs |= s->unlisted;
    return status;
}

/* 1 if J x - base of a holding contact exceeds the rounding of x. */
static int moves(const struct stick_slip *m, const tribo_system *sys, const double *base, const double *x)
{
    const struct matrix *j = &sys->direction;
    for (size_t i = 0; i < m->constant.contacts; i++) {
        double sum = -base[i], size = fabs(base[i]);
        for (size_t k = m->state.loose[i] ? j->first[i + 1] : j->first[i]; k < j->first[i + 1]; k++) {
            sum += j->val[k] * x[j->col[k]];
            size += fabs(j->val[k] * x[j->col[k]]);
        }
        if (!m->state.loose[i] && fabs(sum) > 4.0 * DBL_EPSILON * size) {
            return 1;
        }
    }
    return 0;
}

/* x -= B_H R_HH^-1 (J_H x - base), twice: the second time removes the rounding of the first. */
int tribo_stick_slip_project(struct stick_slip *m, const tribo_system *sys, const double *base, double *x)
{
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < m->constant.contacts; i++) {
            m->work.lo[i] = -base[i];
        }
        tribo_matrix_multiply_add(&sys->direction, 1.0, x, m->work.lo);
        const int status = tribo_stick_slip_balance(m, m->work.lo, m->work.f);
        if (status) {
            return tribo_system_fail(sys, status, "%s", tribo_message(m->constant.hold));
        }
        tribo_matrix_multiply_add(&sys->response, 1.0, m->work.f, x);
    }
    return TRIBO_OK;
}

void tribo_stick_slip_list_snaps(struct stick_slip *m, const tribo_system *sys)
{
    size_t hold = 0;
    for (size_t i = 0; i < m->constant.contacts; i++) {
        hold += !m->state.loose[i];
    }
    m->state.snaps = tribo_system_list_snaps(sys, m->state.loose, m->state.snap);
    m->state.simple = m->state.snaps == hold;
    m->state.unlisted = 0;
}

static void apply_snaps(const struct slip_state *state, const double *base, double *x)
{
    for (const struct snap *s = state->snap; s < state->snap + state->snaps; s++) {
        if (!state->loose[s->contact]) {
            tribo_snap(s, base, x);
        }
    }
}

int tribo_stick_slip_hold(struct stick_slip *m, const tribo_system *sys, const double *base, double *x)
{
    if (m->state.unlisted && !sys->snaps_in_order) {
        tribo_stick_slip_list_snaps(m, sys);
    }
    apply_snaps(&m->state, base, x);
    if (m->state.simple || !moves(m, sys, base, x)) {
        return TRIBO_OK;
    }
    const int status = tribo_stick_slip_project(m, sys, base, x);
    if (!status) {
        apply_snaps(&m->state, base, x);
    }
    return status;
}
