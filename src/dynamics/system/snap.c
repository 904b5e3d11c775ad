/* SPDX-License-Identifier: BSD-3-Clause */
/* Removes rounding errors from velocities of bodies with resting contacts. A contact with one degree of freedom sets its
 * velocity. A contact with the difference of two, one of them set, sets the other; and so on: no velocity is set twice. Of bodies
 * joined to each other and nothing else, the pair with the heaviest body is set first. */
#include "system.h"
#include "common/real.h"

#include <math.h>
#include <string.h>

/* Velocities x [ndof] to correct; or, if list is not NULL, corrections to write to list. */
struct snapping {
    const tribo_system *sys;
    const signed char *loose;
    const double *base;
    double *x, *known; /* known [ndof] 1: x is final */
    struct snap *list;
    size_t listed;
};

/* Returns |B_di|, the acceleration of degree of freedom d by a unit force of contact i; 1/m_d in unsolved systems. */
static double yield_of(const tribo_system *sys, size_t d, size_t i)
{
    return sys->unsolved ? 1.0 / tribo_matrix_get(&sys->mass, d, d) : fabs(tribo_matrix_get(&sys->response, d, i));
}

/* Returns which entry of row i to correct by the other: 1, the second; 0 if the second is over 1000 times as heavy as the
 * first. */
static size_t follows(const tribo_system *sys, size_t i, size_t first)
{
    const size_t *dof = sys->direction.col + first;
    return yield_of(sys, dof[1], i) >= 1e-3 * yield_of(sys, dof[0], i);
}

/* Returns 1 if contact i rests and its row is the difference or sum of two degrees of freedom, with entries of equal size. */
static inline int is_pair(const struct snapping *s, size_t i)
{
    const struct matrix *j = &s->sys->direction;
    const size_t first = j->first[i];
    return !s->loose[i] && j->first[i + 1] - first == 2 && fabs(j->val[first]) == fabs(j->val[first + 1]);
}

/* Corrects, or lists, entry `to` of row i by entry `from`; to = from: the row has one entry. */
static void snap_take(struct snapping *s, size_t i, size_t to, size_t from)
{
    const struct matrix *j = &s->sys->direction;
    const struct snap one = {i, j->col[to], j->col[from], j->val[to], to == from ? 0.0 : j->val[from]};
    if (s->list) {
        s->list[s->listed++] = one;
    } else {
        tribo_snap(&one, s->base, s->x);
    }
}

/* Corrects entry `to` of row i, a pair, by the other entry. Both are known then. */
static void snap_pair(struct snapping *s, size_t i, size_t to)
{
    const struct matrix *j = &s->sys->direction;
    const size_t from = 2 * j->first[i] + 1 - to;
    snap_take(s, i, to, from);
    s->known[j->col[to]] = s->known[j->col[from]] = 1.0;
}

static int knows(const struct snapping *s, size_t entry)
{
    return s->known[s->sys->direction.col[entry]] != 0.0;
}

/* Sets snaps_in_order = 1 if no rigid contact corrects a degree of freedom in the row of an earlier rigid contact. */
void tribo_system_order_snaps(tribo_system *sys)
{
    const struct matrix *j = &sys->direction;
    const struct snapping s = {.sys = sys, .loose = NULL, .known = sys->work.acceleration};
    memset(s.known, 0, sys->ndof * sizeof *s.known);
    sys->snaps_in_order = 1;
    for (size_t i = 0; i < sys->ncontact; i++) {
        const size_t first = j->first[i];
        const size_t count = tribo_is_compliant(&sys->compliance, i) ? 0 : j->first[i + 1] - first;
        const size_t moves = first + (count == 2 ? follows(sys, i, first) : 0);
        sys->snaps_in_order &= count == 0 || count > 2 || !knows(&s, moves);
        for (size_t k = first; count <= 2 && k < first + count; k++) {
            s.known[j->col[k]] = 1.0;
        }
    }
}

/* Corrects rows of one entry; if snaps_in_order, also pairs. Else then pairs with one known end, and, where there are none, the
 * pair with the heaviest body of those without. */
static void snap(struct snapping *s)
{
    const tribo_system *sys = s->sys;
    const struct matrix *j = &sys->direction;
    const size_t n = sys->ncontact;
    int left = 0;
    for (size_t i = 0; i < n; i++) {
        const size_t first = j->first[i];
        if (!s->loose[i] && j->first[i + 1] - first == 1) {
            /* snap_take for a single entry, inline: every step calls it for many contacts */
            if (s->list) {
                snap_take(s, i, first, first);
            } else {
                s->x[j->col[first]] = s->base[i] / j->val[first];
            }
        } else if (sys->snaps_in_order && is_pair(s, i)) {
            const size_t to = first + follows(sys, i, first);
            snap_take(s, i, to, 2 * first + 1 - to);
        } else {
            left |= !s->loose[i];
        }
    }
    if (!left || sys->snaps_in_order) {
        return;
    }
    memset(s->known, 0, sys->ndof * sizeof *s->known);
    for (size_t i = 0; i < n; i++) {
        if (!s->loose[i] && j->first[i + 1] - j->first[i] == 1) {
            s->known[j->col[j->first[i]]] = 1.0;
        }
    }
    for (int some = 1; some;) {
        size_t heaviest = n;
        double least = HUGE_VAL;
        some = 0;
        for (size_t i = 0; i < n; i++) {
            const size_t first = j->first[i];
            if (is_pair(s, i) && knows(s, first) != knows(s, first + 1)) {
                snap_pair(s, i, first + (size_t)knows(s, first));
                some = 1;
            } else if (is_pair(s, i) && !knows(s, first)) {
                const double yield = lesser(yield_of(sys, j->col[first], i), yield_of(sys, j->col[first + 1], i));
                heaviest = yield < least ? i : heaviest;
                least = lesser(yield, least);
            }
        }
        if (!some && heaviest < n) {
            snap_pair(s, heaviest, j->first[heaviest] + follows(sys, heaviest, j->first[heaviest]));
            some = 1;
        }
    }
}

void tribo_system_snap(const tribo_system *sys, const signed char *loose, const double *base, double *x)
{
    snap(&(struct snapping){sys, loose, base, x, sys->work.acceleration, NULL, 0});
}

size_t tribo_system_list_snaps(const tribo_system *sys, const signed char *loose, struct snap *list)
{
    struct snapping s = {sys, loose, NULL, NULL, sys->work.acceleration, list, 0};
    snap(&s);
    return s.listed;
}
