#include "few_bodies.h"

#include <math.h>
#include <string.h>

#include "common/real.h"
#include "dynamics/system/cos_sin.h"
#include "step_form.h"

/* ------------------------------------------------------------------------------------------------------------- settings */

int tribo_few_take(struct few_bodies *b, tribo_system *sys)
{
    const size_t revision = tribo_system_revision(sys);
    if (b->revision == revision) {
        return b->fits;
    }
    b->revision = revision;
    b->n = sys->ndof;
    b->c = sys->ncontact;
    b->fits = b->n <= FEW && b->c <= FEW && !sys->unsolved && tribo_step_form_plain(sys);
    if (!b->fits) {
        return 0;
    }
    memset(b->damping, 0, sizeof b->damping);
    tribo_matrix_spread(&sys->stiffness, b->stiffness);
    tribo_matrix_spread(&sys->damping, b->damping);
    tribo_matrix_spread(&sys->direction, b->direction);
    tribo_matrix_spread(&sys->response, b->response);
    for (unsigned set = 0; set < 1u << b->c; set++) { /* the snaps of each set of holding contacts */
        signed char loose[FEW];
        for (size_t i = 0; i < b->c; i++) {
            loose[i] = !(set >> i & 1u);
        }
        b->snaps[set] = tribo_system_list_snaps(sys, loose, b->snap[set]);
    }
    for (size_t i = 0; i < b->c; i++) {
        for (size_t j = 0; j < b->c; j++) {
            b->r[i * b->c + j] = tribo_system_delassus(sys, i, j);
        }
        b->part[i] = tribo_resolution(b->c);
        b->tally[i] = sys->tally[i];
    }
    memset(b->at, FREE, sizeof b->at);
    b->inverse_of = 0;
    b->fits = tribo_small_fits(b->c, b->r, b->inverse); /* 0 if R is out of range, or nearly singular */
    return b->fits;
}

/* ---------------------------------------------------------------------------------------------------- what acts in a run */

/* Adds harmonics and tables that drive loads or bases at the times t [count] to rows [n], which begin with 0. */
static void few_find_drives(tribo_system *sys, enum drives drives, size_t n, size_t count, const double *t, double row[FEW][RUN])
{
    double cosine[RUN], sine[RUN];
    memset(row, 0, n * sizeof *row);
    for (size_t k = 0; k < sys->harmonics; k++) {
        const struct harmonic *h = &sys->harmonic[k];
        if (h->drives == drives) {
            tribo_cos_sin_all(h->omega, count, t, cosine, sine);
            for (size_t e = 0; e < h->count; e++) {
                double *to = row[h->index[e]];
                for (size_t s = 0; s < count; s++) {
                    to[s] += h->cosine[e] * cosine[s] + h->sine[e] * sine[s];
                }
            }
        }
    }
    for (size_t s = 0; sys->tables && s < count; s++) {
        double x[FEW] = {0.0};
        tribo_system_set_time(sys, t[s]);
        tribo_system_tables(sys, drives, 0, 1.0, 0, n, x);
        for (size_t i = 0; i < n; i++) {
            row[i][s] += x[i];
        }
    }
}

/* Durations and lengths of steps, after one of length `last`; loads and limits at t, bases at the middles. 0 if a limit is
 * too large. */
static int few_find_all(struct few_bodies *b, tribo_system *sys, size_t count, const double *t, double last)
{
    double middle[RUN], limit[FEW];
    int fits = 1;
    b->h[0] = last;
    for (size_t s = 0; s < count; s++) {
        b->h[s + 1] = t[s + 1] - t[s];
        b->time[s] = 0.5 * (b->h[s] + b->h[s + 1]);
        middle[s] = t[s] + 0.5 * (t[s + 1] - t[s]);
    }
    few_find_drives(sys, DRIVES_LOAD, b->n, count, t, b->load);
    few_find_drives(sys, DRIVES_BASE, b->c, count, middle, b->base);
    const int vary = tribo_system_limits_vary(sys);
    for (size_t s = 0; s < count; s++) {
        if (vary) {
            tribo_system_set_time(sys, t[s]);
        }
        if (vary || s == 0) {
            tribo_get_limit(sys->contacts, limit);
        }
        for (size_t i = 0; i < b->c; i++) {
            fits &= limit[i] <= TRIBO_SMALL_MOST;
            b->limit[i][s] = limit[i];
        }
    }
    return fits;
}

/* ---------------------------------------------------------------------------------------------------------------- steps */

/* Row a [m] times x. */
static inline double row_times(size_t m, const double *a, const double *x)
{
    double sum = a[0] * x[0];
    for (size_t j = 1; j < m; j++) {
        sum += a[j] * x[j];
    }
    return sum;
}

/* The motion of a run, in local memory: compilers keep it in registers. */
struct few_state {
    double q[FEW], u[FEW], v[FEW], energy;
    signed char at[FEW];
};

/* Step s of a run. 0 if it has to be left to others: then only m->at has changed. */
static inline int few_step(struct few_bodies *b, size_t n, size_t c, size_t s, struct few_state *m)
{
    static const double least[FEW] = {0.0};
    double u[FEW] = {0.0}, v[FEW], less[FEW], most[FEW], base[FEW], p[FEW] = {0.0}, end[FEW], work = 0.0;
    const struct small x = {b->r, b->inverse, &b->inverse_of, b->part, least, v, less, most, m->at, p, end};
    for (size_t d = 0; d < n; d++) {
        const double a = b->load[d][s] - row_times(n, b->damping + d * n, m->u); /* q is known later than u */
        u[d] = m->u[d] + b->time[s] * (a - row_times(n, b->stiffness + d * n, m->q));
    }
    for (size_t i = 0; i < c; i++) {
        base[i] = b->base[i][s];
        v[i] = row_times(n, b->direction + i * n, u) - base[i];
        most[i] = b->time[s] * b->limit[i][s];
        less[i] = -most[i];
    }
    if (!tribo_small_solve(c, &x)) {
        return 0;
    }
    for (size_t d = 0; d < n; d++) {
        u[d] += row_times(c, b->response + d * c, p);
    }
    /* makes the velocities of holding contacts exact, but of those at their bounds */
    unsigned set = 0;
    for (size_t i = 0; b->inverse_of && i < c; i++) {
        set |= (unsigned)(m->at[i] == FREE && fabs(p[i]) < most[i]) << i;
    }
    for (size_t k = 0; k < b->snaps[set]; k++) {
        tribo_snap(&b->snap[set][k], base, u);
    }
    for (size_t i = 0; i < c; i++) {
        const double to = m->at[i] == FREE ? 0.0 : end[i];
        work += b->tally[i] * p[i] * (m->v[i] + to);
        m->v[i] = to;
    }
    for (size_t d = 0; d < n; d++) {
        m->q[d] += b->h[s + 1] * u[d];
        m->u[d] = u[d];
    }
    m->energy -= 0.5 * work;
    return 1;
}

/* The first steps of a run. Returns how many of count could be taken. */
static inline size_t few_steps(struct few_bodies *b, size_t n, size_t c, size_t count, struct few_state *motion)
{
    struct few_state m = *motion;
    size_t s = 0;
    while (s < count && few_step(b, n, c, s, &m)) {
        s++;
    }
    *motion = m;
    return s;
}

size_t tribo_few_run(struct few_bodies *b, tribo_system *sys, size_t count, const double *t, struct few_motion *m)
{
    const size_t n = b->n, c = b->c;
    struct few_state x = {.energy = m->energy};
    if (!few_find_all(b, sys, count, t, m->last)) {
        return 0;
    }
    memcpy(x.q, m->q, n * sizeof *x.q);
    memcpy(x.u, m->u, n * sizeof *x.u);
    memcpy(x.v, m->v, c * sizeof *x.v);
    memcpy(x.at, b->at, sizeof x.at);
    /* sizes as constants make loops straight: a step then takes half the time */
    const size_t taken = n != c   ? few_steps(b, n, c, count, &x)
                         : n == 1 ? few_steps(b, 1, 1, count, &x)
                         : n == 2 ? few_steps(b, 2, 2, count, &x)
                         : n == 3 ? few_steps(b, 3, 3, count, &x)
                                  : few_steps(b, FEW, FEW, count, &x);
    /* numbers that are not finite come back in every step that follows */
    if (taken == 0 || !isfinite(x.energy) || !tribo_dense_finite(x.q, n) || !tribo_dense_finite(x.u, n)) {
        return 0;
    }
    memcpy(m->q, x.q, n * sizeof *x.q);
    memcpy(m->u, x.u, n * sizeof *x.u);
    memcpy(m->v, x.v, c * sizeof *x.v);
    m->energy = x.energy;
    m->last = b->h[taken];
    memcpy(b->at, x.at, sizeof x.at);
    return taken;
}
