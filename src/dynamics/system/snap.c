/* SPDX-License-Identifier: BSD-3-Clause */
/* Removes rounding errors from velocities of bodies with resting contacts. A contact with one degree of freedom sets its
 * velocity. A contact with the difference of two, one of them set, sets the other; and so on: no velocity is set twice. Of bodies
 * joined to each other and nothing else, the pair with the heaviest body is set first. */
#include "system.h"
#include "common/real.h"

#include <math.h>
#include <string.h>

/* Corrections written to list. */
struct snapping {
    const tribo_system *sys;
    double *known; /* [ndof] 1: the velocity is set by a correction in list */
    struct snap *list;
    size_t listed;
    int clash; /* 1: a correction undoes an earlier one */
};

/* Returns |B_di|, the acceleration of degree of freedom d by a unit force of contact i; 1/m_d in unsolved systems. */
static double yield_of(const tribo_system *sys, size_t d, size_t i)
{
    return sys->unsolved ? 1.0 / tribo_matrix_get(&sys->mass, d, d) : fabs(tribo_matrix_get(&sys->response, d, i));
}

/* Returns which entry of row i, of two entries, to correct by the other: 1, the second; 0 if the second is over 1000 times as
 * heavy as the first. */
static size_t follows(const tribo_system *sys, size_t i)
{
    const size_t *dof = sys->direction.col + sys->direction.first[i];
    return yield_of(sys, dof[1], i) >= 1e-3 * yield_of(sys, dof[0], i);
}

static size_t entries_of(const struct matrix *j, size_t i)
{
    return j->first[i + 1] - j->first[i];
}

/* Returns 1 if contact i is rigid, rests, and its row has one entry, or two of equal size. */
static int can_snap(const tribo_system *sys, const signed char *loose, size_t i)
{
    const struct matrix *j = &sys->direction;
    const double *val = j->val + j->first[i];
    const size_t entries = entries_of(j, i);
    return !loose[i] && !tribo_is_compliant(&sys->compliance, i) &&
           (entries == 1 || (entries == 2 && fabs(val[0]) == fabs(val[1])));
}

/* Lists the correction of entry `to` of row i, 0 or 1, by the other entry, if there are two. */
static void snap_take(struct snapping *s, size_t i, size_t to)
{
    const struct matrix *j = &s->sys->direction;
    const size_t first = j->first[i], from = first + entries_of(j, i) - 1 - to;
    to += first;
    s->list[s->listed++] = (struct snap){i, j->col[to], j->col[from], j->val[to], to == from ? 0.0 : j->val[from]};
    s->clash |= s->known[j->col[to]] != 0.0;
    s->known[j->col[to]] = s->known[j->col[from]] = 1.0;
}

/* Lists the corrections of contacts with loose 0; in_order = 1: in the order of contacts, even if they clash. */
static struct snapping find_snaps(const tribo_system *sys, const signed char *loose, int in_order, struct snap *list)
{
    const struct matrix *j = &sys->direction;
    const size_t n = sys->ncontact;
    struct snapping s = {sys, sys->work.acceleration, list, 0, 0};
    memset(s.known, 0, sys->ndof * sizeof *s.known);
    for (size_t i = 0; i < n; i++) {
        const size_t entries = entries_of(j, i);
        if ((entries == 1 || in_order) && can_snap(sys, loose, i)) {
            snap_take(&s, i, entries == 1 ? 0 : follows(sys, i));
        }
    }
    /* else the pairs with one known end; where there are none, the pair with the heaviest body */
    for (int some = !in_order; some;) {
        size_t heaviest = n;
        double least = HUGE_VAL;
        some = 0;
        for (size_t i = 0; i < n; i++) {
            const size_t *dof = j->col + j->first[i];
            const int pair = entries_of(j, i) == 2 && can_snap(sys, loose, i), known = pair && s.known[dof[0]] != 0.0;
            if (pair && known != (s.known[dof[1]] != 0.0)) {
                snap_take(&s, i, (size_t)known);
                some = 1;
            } else if (pair && !known) {
                const double yield = lesser(yield_of(sys, dof[0], i), yield_of(sys, dof[1], i));
                heaviest = yield < least ? i : heaviest;
                least = lesser(yield, least);
            }
        }
        if (!some && heaviest < n) {
            snap_take(&s, heaviest, follows(sys, heaviest));
            some = 1;
        }
    }
    return s;
}

size_t tribo_system_list_snaps(const tribo_system *sys, const signed char *loose, struct snap *list)
{
    return find_snaps(sys, loose, sys->snaps.in_order, list).listed;
}

void tribo_system_order_snaps(tribo_system *sys)
{
    signed char *loose = memset(sys->work.feq, 0, sys->ncontact);
    const struct snapping s = find_snaps(sys, loose, 1, sys->snaps.list);
    sys->snaps.in_order = !s.clash;
    sys->snaps.count = s.listed;
}

void tribo_system_snap(tribo_system *sys, const signed char *loose, const double *base, double *x)
{
    if (!sys->snaps.in_order) {
        sys->snaps.count = tribo_system_list_snaps(sys, loose, sys->snaps.list);
    }
    tribo_snap_all(sys->snaps.list, sys->snaps.count, loose, base, x);
}
