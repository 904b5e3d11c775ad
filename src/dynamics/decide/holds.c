/* Which of the contacts at rest hold: an independent set of them keeps all of them where they are. */
#include "numerics/constraint.h"
#include "stick_slip.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Tells the context that finds the forces of those that hold who they are. f [ncontact] is workspace. */
static int take_holds(struct stick_slip *m, double *f)
{
    for (size_t i = 0; i < m->contacts; i++) {
        f[i] = m->loose[i] ? 0.0 : 1.0;
    }
    m->hold_differs = 0;
    return tribo_set_limit(m->hold, f);
}

int tribo_stick_slip_balance(struct stick_slip *m, const double *a, double *f)
{
    for (size_t i = 0; m->uncoupled && i < m->contacts; i++) {
        f[i] = tribo_stick_slip_balance_alone(m, i, a[i]);
    }
    const int status = m->hold_differs && !m->uncoupled ? take_holds(m, f) : TRIBO_OK;
    return status || m->uncoupled ? status : tribo_balance(m->hold, m->still, a, f, NULL);
}

/* Of the contacts at rest, marks only an independent set as holding; rather such that are inside their limits, or go there. */
static int choose_holds(struct stick_slip *m, const tribo_system *sys)
{
    struct constraints c = {0};
    size_t rest = 0;
    for (size_t i = 0; i < m->contacts; i++) {
        const signed char tied = m->tied[i];
        m->at[rest] = i;
        m->last[rest] = (unsigned char)(tied == 0 ? 0 : tied == 2 ? 1 : 2);
        rest += tribo_stick_slip_searches(m, i) && m->can_hold[i];
    }
    const int done = rest < 2 || tribo_constraints_create(&c, &sys->direction, &sys->mass, m->at, rest, m->last);
    for (size_t k = done && rest > 1 ? c.rank : rest; k < rest; k++) {
        m->holds[m->at[c.order[k]]] = 0;
    }
    tribo_constraints_free(&c);
    return done ? TRIBO_OK
                : tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s at rest", rest, plural(rest));
}

/* Whether others are tied than before; takes it down. Whoever is may rest by others. */
static int take_ties(struct stick_slip *m)
{
    const int changes = memcmp(m->before, m->tied, m->contacts) != 0;
    memcpy(m->before, m->tied, m->contacts);
    return changes;
}

/* All contacts at rest hold that can. */
static void hold_all(size_t n, const signed char *restrict slip, const unsigned char *restrict can, unsigned char *restrict holds)
{
    for (size_t i = 0; i < n; i++) {
        holds[i] = (slip[i] == TRIBO_SLIP_STUCK) & can[i];
    }
}

/* What follows from who holds: who is loose, and whether that has changed; keys; and how many rest by themselves. */
static void note_holds(struct stick_slip *m)
{
    m->dependents = 0;
    for (size_t i = 0; i < m->contacts; i++) {
        const signed char loose = (signed char)(!m->holds[i] || m->elastic[i]);
        m->unlisted |= loose != m->loose[i];
        m->dependents += tribo_stick_slip_depends(m, i);
        m->loose[i] = loose;
        m->key[i] = (signed char)((m->slip[i] == TRIBO_SLIP_STUCK) + m->holds[i]);
    }
    m->hold_differs |= m->unlisted;
}

static int find_anew(struct stick_slip *m, const tribo_system *sys)
{
    m->fresh = 0;
    hold_all(m->contacts, m->slip, m->can_hold, m->holds);
    const int status = m->independent ? TRIBO_OK : choose_holds(m, sys);
    note_holds(m);
    return status;
}

int tribo_stick_slip_find_holds(struct stick_slip *m, const tribo_system *sys)
{
    const int others = !m->independent && take_ties(m);
    return m->fresh || others ? find_anew(m, sys) : TRIBO_OK;
}

/* 1 if J x - base is more than the rounding of x for a contact that holds. */
static int moves(struct stick_slip *m, const tribo_system *sys, const double *base, const double *x)
{
    const struct matrix *j = &sys->direction;
    for (size_t i = 0; i < m->contacts; i++) {
        double sum = -base[i], size = fabs(base[i]);
        for (size_t k = m->loose[i] ? j->first[i + 1] : j->first[i]; k < j->first[i + 1]; k++) {
            sum += j->val[k] * x[j->col[k]];
            size += fabs(j->val[k] * x[j->col[k]]);
        }
        if (!m->loose[i] && fabs(sum) > 4.0 * DBL_EPSILON * size) {
            return 1;
        }
    }
    return 0;
}

/* x -= B_I R_II^-1 (J_I x - base), twice, since the first time leaves rounding of what it takes away. */
int tribo_stick_slip_project(struct stick_slip *m, const tribo_system *sys, const double *base, double *x)
{
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < m->contacts; i++) {
            m->lo[i] = -base[i];
        }
        tribo_matrix_multiply_add(&sys->direction, 1.0, x, m->lo);
        const int status = tribo_stick_slip_balance(m, m->lo, m->f);
        if (status) {
            return tribo_system_fail(sys, status, "%s", tribo_message(m->hold));
        }
        tribo_matrix_multiply_add(&sys->response, 1.0, m->f, x);
    }
    return TRIBO_OK;
}

void tribo_stick_slip_list_snaps(struct stick_slip *m, const tribo_system *sys)
{
    size_t hold = 0;
    for (size_t i = 0; i < m->contacts; i++) {
        hold += !m->loose[i];
    }
    m->snaps = tribo_system_list_snaps(sys, m->loose, m->snap);
    m->simple = m->snaps == hold;
    m->unlisted = 0;
}

static void snap(const struct stick_slip *m, const double *base, double *x)
{
    for (const struct snap *s = m->snap; s < m->snap + m->snaps; s++) {
        if (!m->loose[s->contact]) {
            tribo_snap(s, base, x);
        }
    }
}

/* First the last bits of simple contacts; then, if there is more, what the contacts take away. */
int tribo_stick_slip_hold(struct stick_slip *m, const tribo_system *sys, const double *base, double *x)
{
    if (m->unlisted && !sys->snaps_in_order) {
        tribo_stick_slip_list_snaps(m, sys);
    }
    snap(m, base, x);
    if (m->simple || !moves(m, sys, base, x)) {
        return TRIBO_OK;
    }
    const int status = tribo_stick_slip_project(m, sys, base, x);
    if (!status) {
        snap(m, base, x);
    }
    return status;
}
