/* Steps of central differences of a few bodies. */
#include "few_bodies.h"

#include <float.h>
#include <math.h>

#include "common/real.h"

/* The contacts in a step: bounds of impulses, velocities without friction; impulses, and velocities at the end. */
struct impulses {
    double most[FEW], v[FEW], p[FEW], end[FEW];
};

/* Row i of A x, the matrix being of m columns. */
static inline double row_times(size_t m, const double a[FEW], const double *x)
{
    double sum = a[0] * x[0];
    for (size_t j = 1; j < m; j++) {
        sum += a[j] * x[j];
    }
    return sum;
}

static inline int few_rests(const struct few_slip *slip, size_t i)
{
    return slip->resting >> i & 1;
}

/* What rounding leaves of doubt about the velocity of contact i. */
static inline double noise_of(const struct few_bodies *b, size_t c, size_t i, const struct impulses *x)
{
    double size = fabs(x->v[i]);
    for (size_t j = 0; j < c; j++) {
        size += fabs(b->r[i][j]) * x->most[j];
    }
    return 4.0 * DBL_EPSILON * size;
}

/* Contacts whose impulse is beyond its bound slide; those that move where friction pushes them hold. Returns whether any
 * changes. */
static inline int few_revise(const struct few_bodies *b, size_t c, const struct impulses *x, struct few_slip *slip)
{
    int changed = 0;
    for (size_t i = 0; i < c; i++) {
        const double along = slip->side[i] * x->end[i];
        if (few_rests(slip, i) && fabs(x->p[i]) > x->most[i]) {
            slip->side[i] = x->p[i] > 0.0 ? 1.0 : -1.0;
            slip->resting &= ~(1u << i);
            changed = 1;
        } else if (along > 0.0 && along > noise_of(b, c, i, x) && x->most[i] > 0.0) {
            slip->side[i] = 0.0;
            slip->resting |= 1u << i;
            changed = 1;
        }
    }
    return changed;
}

/* 0 if no end comes of it. */
static inline int few_settle(const struct few_bodies *b, size_t c, struct few_slip *slip, struct impulses *x)
{
    enum { ROUNDS = 2 * FEW + 2 };
    int changed = 1;
    for (int round = 0; changed && round < ROUNDS; round++) {
        /* Impulses and velocities at the end, of contacts that do this. */
        double held[FEW] = {0.0};
        for (size_t i = 0; i < c; i++) {
            x->p[i] = slip->side[i] * x->most[i];
        }
        for (size_t i = 0; i < c; i++) {
            x->end[i] = x->v[i] + row_times(c, b->r[i], x->p);
        }
        for (size_t i = 0; slip->resting && i < c; i++) {
            held[i] = row_times(c, b->inverse[slip->resting][i], x->end);
        }
        for (size_t i = 0; slip->resting && i < c; i++) {
            x->p[i] -= held[i];
            x->end[i] = few_rests(slip, i) ? 0.0 : x->end[i] - row_times(c, b->r[i], held);
        }
        changed = few_revise(b, c, x, slip);
    }
    return !changed;
}

/* Takes the rounding out of the velocities of contacts at rest: one at its limit is not. */
static inline void snap(const struct few_bodies *b, struct few_parts has, size_t s, const struct few_slip *slip,
                        const struct impulses *x, double *u)
{
    unsigned set = 0;
    for (size_t i = 0; i < has.c; i++) {
        set |= (unsigned)(few_rests(slip, i) && fabs(x->p[i]) < x->most[i]) << i;
    }
    for (size_t k = 0; k < has.c && k < b->snaps[set]; k++) {
        const struct few_snap *to = &b->snap[set][k];
        const double value = ((has.bases ? b->base[to->contact][s] : 0.0) - row_times(has.n, to->rest, u)) / to->turn;
        for (size_t d = 0; d < has.n; d++) {
            u[d] = to->to == d ? value : u[d];
        }
    }
}

/* 0, and nothing is changed but slip, if the step is for others. */
static inline int few_step(const struct few_bodies *b, struct few_parts has, size_t s, struct few_carried *m)
{
    struct impulses x = {{0.0}, {0.0}, {0.0}, {0.0}};
    double u[FEW] = {0.0}, work = 0.0;
    /* The velocities u without friction. */
    for (size_t d = 0; d < has.n; d++) {
        const double a = b->load[d][s] - row_times(has.n, b->stiffness[d], m->q);
        u[d] = m->u[d] + b->time[s] * (has.damped ? a - row_times(has.n, b->damping[d], m->u) : a);
    }
    for (size_t i = 0; i < has.c; i++) {
        x.v[i] = row_times(has.n, b->direction[i], u) - (has.bases ? b->base[i][s] : 0.0);
        x.most[i] = b->time[s] * (has.vary ? b->limits[i][s] : b->limit[i]);
    }
    if (!few_settle(b, has.c, &m->slip, &x)) {
        return 0;
    }
    for (size_t d = 0; d < has.n; d++) {
        u[d] += row_times(has.c, b->response[d], x.p);
    }
    if (m->slip.resting) {
        snap(b, has, s, &m->slip, &x, u);
    }
    for (size_t i = 0; i < has.c; i++) {
        work += b->tally[i] * x.p[i] * (m->v[i] + x.end[i]);
        m->v[i] = x.end[i];
    }
    for (size_t d = 0; d < has.n; d++) {
        m->q[d] += b->h[s + 1] * u[d];
        m->u[d] = u[d];
    }
    m->energy -= 0.5 * work;
    return 1;
}

static inline size_t steps(const struct few_bodies *b, struct few_parts has, size_t count, struct few_carried *to)
{
    struct few_carried m = *to;
    size_t s = 0;
    while (s < count && few_step(b, has, s, &m)) {
        s++;
    }
    *to = m;
    return s;
}

/* With as many contacts as degrees of freedom. */
static inline size_t square_steps(const struct few_bodies *b, struct few_parts has, size_t n, size_t count, struct few_carried *m)
{
    return steps(b, (struct few_parts){n, n, has.damped, has.bases, has.vary}, count, m);
}

/* One for each size, so that compilers see it, and one for the others. */
size_t tribo_few_steps(const struct few_bodies *b, struct few_parts has, size_t count, struct few_carried *m)
{
    switch (has.n == has.c ? has.n : 0) {
    case 1:
        return square_steps(b, has, 1, count, m);
    case 2:
        return square_steps(b, has, 2, count, m);
    case 3:
        return square_steps(b, has, 3, count, m);
    case 4:
        return square_steps(b, has, 4, count, m);
    default:
        return steps(b, has, count, m);
    }
}
