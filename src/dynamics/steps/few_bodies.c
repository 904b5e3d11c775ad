#include "few_bodies.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "dynamics/system/cos_sin.h"
#include "common/real.h"
#include "step_form.h"

/* ------------------------------------------------------------------------------------------------------------- settings */

/* Numbers whose products are numbers. */
#define LEAST 1e-100
#define MOST 1e100

/* What elimination must leave of the diagonal of R: inverses are good to rounding. */
#define LEAST_PIVOT 0.01

static void take_matrix(const struct matrix *a, double to[FEW][FEW])
{
    memset(to, 0, FEW * sizeof *to);
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            to[i][a->col[k]] += a->val[k];
        }
    }
}

/* The inverse over a set of contacts, from that over all of them but the last one, i: rank one more. 0 if R is nearly
 * singular. */
static int few_invert(struct few_bodies *b, unsigned set, size_t i)
{
    double(*to)[FEW] = b->inverse[set], (*less)[FEW] = b->inverse[set & ~(1u << i)];
    double z[FEW] = {0.0}, pivot = 0.0;
    z[i] = 1.0;
    for (size_t k = 0; k < i; k++) {
        for (size_t l = 0; l < i; l++) {
            z[k] -= less[k][l] * b->r[l][i];
        }
    }
    for (size_t k = 0; k <= i; k++) {
        pivot += b->r[i][k] * z[k];
    }
    const int fits = pivot > LEAST_PIVOT * b->r[i][i];
    for (size_t k = 0; fits && k < FEW; k++) {
        for (size_t l = 0; l < FEW; l++) {
            to[k][l] = less[k][l] + z[k] * z[l] / pivot;
        }
    }
    return fits;
}

/* 0 if R is no matrix for runs. */
static int take_operator(struct few_bodies *b, const tribo_system *sys)
{
    int fits = 1;
    for (size_t i = 0; i < b->c; i++) {
        for (size_t j = 0; j < b->c; j++) {
            b->r[i][j] = tribo_system_delassus(sys, i, j);
        }
        fits &= b->r[i][i] >= LEAST && b->r[i][i] <= MOST;
    }
    memset(b->inverse[0], 0, sizeof b->inverse[0]);
    for (size_t i = 0; fits && i < b->c; i++) {
        for (unsigned set = 1u << i; fits && set < 2u << i; set++) {
            fits = few_invert(b, set, i);
        }
    }
    return fits;
}

/* 0 if contacts are planar, have static limits, or a limit is too large. */
static int few_take_contacts(struct few_bodies *b, const tribo_system *sys)
{
    int fits = tribo_step_form_plain(sys);
    tribo_get_limit(sys->contacts, b->limit);
    for (size_t i = 0; i < b->c; i++) {
        fits &= b->limit[i] <= MOST;
        b->tally[i] = sys->tally[i];
    }
    return fits;
}

static int take_all(struct few_bodies *b, const tribo_system *sys)
{
    b->n = sys->ndof;
    b->c = sys->ncontact;
    if (b->n > FEW || b->c > FEW || sys->unsolved || sys->massless.count) {
        return 0;
    }
    take_matrix(&sys->stiffness, b->stiffness);
    take_matrix(&sys->damping, b->damping);
    take_matrix(&sys->direction, b->direction);
    take_matrix(&sys->response, b->response);
    b->slip = (struct few_slip){.resting = (1u << b->c) - 1};
    for (unsigned set = 0; set < 1u << b->c; set++) {
        struct snap list[FEW];
        signed char loose[FEW];
        for (size_t i = 0; i < b->c; i++) {
            loose[i] = !(set >> i & 1u);
        }
        b->snaps[set] = tribo_system_list_snaps(sys, loose, list);
        for (size_t k = 0; k < b->snaps[set]; k++) {
            const struct snap *from = &list[k];
            struct few_snap x = {.contact = from->contact, .to = from->to};
            memcpy(x.rest, b->direction[x.contact], sizeof x.rest);
            x.turn = x.rest[x.to];
            x.rest[x.to] = 0.0;
            b->snap[set][k] = x;
        }
    }
    return few_take_contacts(b, sys) && take_operator(b, sys);
}

int tribo_few_take(struct few_bodies *b, tribo_system *sys)
{
    const size_t revision = tribo_system_revision(sys);
    if (b->revision != revision) {
        b->fits = take_all(b, sys);
        b->revision = revision;
    }
    return b->fits;
}

/* ---------------------------------------------------------------------------------------------------- what acts in a run */

/* Adds harmonics that drive loads or bases at the times t [count] to the rows `to`. */
static void few_add_harmonics(const tribo_system *sys, enum drives drives, size_t count, const double *t, double to[FEW][RUN])
{
    double cosine[RUN], sine[RUN];
    for (size_t k = 0; k < sys->harmonics; k++) {
        const struct harmonic *h = &sys->harmonic[k];
        if (h->drives == drives) {
            tribo_cos_sin_all(h->omega, count, t, cosine, sine);
            for (size_t e = 0; e < h->count; e++) {
                double *row = to[h->index[e]];
                for (size_t s = 0; s < count; s++) {
                    row[s] += h->cosine[e] * cosine[s] + h->sine[e] * sine[s];
                }
            }
        }
    }
}

/* Finds lengths, loads at t, bases at the middles of steps, limits at t. last: the length of the step before. 0 if a limit is too
 * large. */
static int few_find_all(struct few_bodies *b, tribo_system *sys, size_t count, const double *t, double last)
{
    const int vary = tribo_system_limits_vary(sys);
    int fits = 1;
    b->h[0] = last;
    for (size_t s = 0; s < count; s++) {
        b->h[s + 1] = t[s + 1] - t[s];
        b->to[s] = t[s] + 0.5 * (t[s + 1] - t[s]);
        b->time[s] = 0.5 * (b->h[s] + b->h[s + 1]);
    }
    memset(b->load, 0, b->n * sizeof *b->load);
    few_add_harmonics(sys, DRIVES_LOAD, count, t, b->load);
    if (tribo_system_bases_move(sys)) {
        memset(b->base, 0, b->c * sizeof *b->base);
        few_add_harmonics(sys, DRIVES_BASE, count, b->to, b->base);
    }
    for (size_t s = 0; sys->base_tables && s < count; s++) {
        double base[FEW] = {0.0};
        tribo_system_set_time(sys, b->to[s]);
        tribo_system_tables(sys, DRIVES_BASE, 0, 1.0, 0, b->c, base);
        for (size_t i = 0; i < b->c; i++) {
            b->base[i][s] += base[i];
        }
    }
    for (size_t s = 0; (vary || sys->tables > sys->base_tables) && s < count; s++) {
        double load[FEW] = {0.0}, limit[FEW];
        tribo_system_set_time(sys, t[s]);
        tribo_system_tables(sys, DRIVES_LOAD, 0, 1.0, 0, b->n, load);
        for (size_t d = 0; d < b->n; d++) {
            b->load[d][s] += load[d];
        }
        tribo_get_limit(sys->contacts, limit);
        for (size_t i = 0; vary && i < b->c; i++) {
            fits &= limit[i] <= MOST;
            b->limits[i][s] = limit[i];
        }
    }
    return fits;
}

/* ----------------------------------------------------------------------------------------------------------------- runs */

/* Of so few numbers that a call would take longer. */
static inline void copy_few(size_t n, const double *from, double *to)
{
    for (size_t i = 0; i < n && i < FEW; i++) {
        to[i] = from[i];
    }
}

/* Numbers that are not finite come back in every step that follows. */
static int is_finite(const struct few_bodies *b, const struct few_carried *m)
{
    int finite = isfinite(m->energy) != 0;
    for (size_t d = 0; d < b->n; d++) {
        finite &= fabs(m->q[d]) + fabs(m->u[d]) <= DBL_MAX;
    }
    return finite;
}

size_t tribo_few_run(struct few_bodies *b, tribo_system *sys, size_t count, const double *t, struct few_motion *m)
{
    const size_t n = b->n, c = b->c;
    const struct few_parts has = {n, c, sys->damping.rows > 0, tribo_system_bases_move(sys), tribo_system_limits_vary(sys)};
    struct few_carried x;
    if (!few_find_all(b, sys, count, t, m->last)) {
        return 0;
    }
    copy_few(n, m->q, x.q);
    copy_few(n, m->u, x.u);
    copy_few(c, m->v, x.v);
    x.energy = m->energy;
    x.slip = b->slip;
    const size_t taken = tribo_few_steps(b, has, count, &x);
    if (taken == 0 || !is_finite(b, &x)) {
        return 0;
    }
    copy_few(n, x.q, m->q);
    copy_few(n, x.u, m->u);
    copy_few(c, x.v, m->v);
    m->energy = x.energy;
    m->last = b->h[taken];
    b->slip = x.slip;
    return taken;
}
