/* SPDX-License-Identifier: BSD-3-Clause */
#include "blockwise.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/layout.h"
#include "common/real.h"
#include "common/simd.h"
#include "fixed_steps.h"

/* ----------------------------------------------------------------------------------------------------------------- life */

/* Finds the bodies; first and last, by the entries of K and C. Returns 0 if a contact has no body of its own, on which alone its
 * force acts. taken [ndof]: workspace, all 0. */
static int find_bodies(struct blockwise *b, const tribo_system *sys, signed char *taken)
{
    int alone = sys->response.first[sys->response.rows] == sys->ncontact &&
                tribo_step_form_bodies(&sys->direction, b->body, b->turn, taken);
    for (size_t i = 0; alone && i < sys->ncontact; i++) {
        const double mobility = tribo_matrix_get(&sys->response, b->body[i], i);
        const double mass = fabs(mobility) < DBL_MIN ? 0.0 : sys->tally[i] * b->turn[i] / mobility;
        b->mass[b->body[i]] = mass;
        alone = mass > 0.0 && isfinite(mass);
    }
    const struct matrix *const of[] = {&sys->stiffness, &sys->damping};
    for (size_t k = 0; k < b->blocks; k++) {
        b->first[k] = b->last[k] = k;
    }
    for (size_t row = 0; alone && row < sys->ndof; row++) {
        const size_t to = row / MATRIX_BLOCK;
        for (int m = 0; m < 2; m++) {
            for (size_t e = of[m]->rows ? of[m]->first[row] : 0; of[m]->rows && e < of[m]->first[row + 1]; e++) {
                const size_t from = of[m]->col[e] / MATRIX_BLOCK;
                b->first[from] = to < b->first[from] ? to : b->first[from];
                b->last[from] = to > b->last[from] ? to : b->last[from];
            }
        }
    }
    return alone;
}

void tribo_blockwise_free(struct blockwise *b)
{
    free(b->body);
    memset(b, 0, sizeof *b);
}

int tribo_blockwise_create(struct blockwise *b, const tribo_system *sys)
{
    const size_t n = sys->ndof, c = sys->ncontact, blocks = (n + MATRIX_BLOCK - 1) / MATRIX_BLOCK;
    signed char *taken;
    memset(b, 0, sizeof *b);
    b->blocks = blocks;
    if (!ALLOCATE(ARRAY(b->body, c), ARRAY(b->mass, n), ARRAY(b->brake, n), ARRAY(b->band, n), ARRAY(b->rate, n),
                  ARRAY(b->before, n), ARRAY(b->after, n), ARRAY(b->load, n), ARRAY(b->turn, c), ARRAY(b->room, c),
                  ARRAY(b->first, blocks), ARRAY(b->last, blocks), ARRAY(b->driven, blocks), ARRAY(b->awake, blocks),
                  ARRAY(b->wakes, blocks), ARRAY(taken, n))) {
        return 0;
    }
    if (!find_bodies(b, sys, taken)) {
        tribo_blockwise_free(b);
    }
    return 1;
}

/* ------------------------------------------------------------------------------------------------------------- settings */

static void take_limits(struct blockwise *b, const tribo_system *sys)
{
    tribo_get_limit(sys->contacts, b->room);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const size_t d = b->body[i];
        b->brake[d] = product(fabs(tribo_matrix_get(&sys->response, d, i)), lesser(b->room[i], TRIBO_FAR));
    }
}

void tribo_blockwise_take(struct blockwise *b, tribo_system *sys)
{
    b->revision = tribo_system_revision(sys);
    b->fits = b->body && tribo_system_is_plain(sys) && !sys->normals.count;
    if (!b->fits) {
        return;
    }
    memset(b->awake, 1, b->blocks);
    memset(b->wakes, 0, b->blocks);
    memset(b->load, 0, sys->ndof * sizeof *b->load);
    b->when = NAN;
    memset(b->driven, tribo_system_limits_vary(sys), b->blocks);
    for (size_t s = 0; s < sys->loads.harmonics; s++) {
        const struct harmonic *h = &sys->loads.harmonic[s];
        for (size_t k = 0; k < h->count; k++) {
            const size_t d = h->drives == DRIVES_LOAD ? h->index[k] : b->body[h->index[k]];
            b->driven[d / MATRIX_BLOCK] |= h->drives == DRIVES_BASE || h->omega != 0.0 || h->knots;
        }
    }
    take_limits(b, sys);
}

/* Sums of accelerations and products with masses up to this size are numbers. */
#define MOST 1e100

void tribo_blockwise_take_law(struct blockwise *b, tribo_system *sys)
{
    int law;
    tribo_get_law(sys->contacts, &law);
    const int relaxes = law == TRIBO_QUINN, creeps = law == TRIBO_VELOCITY_LIMITED;
    tribo_blockwise_take(b, sys);
    b->fits = b->fits && (relaxes || creeps || law == TRIBO_KARNOPP || law == TRIBO_COULOMB) && !tribo_system_bases_move(sys) &&
              !tribo_system_limits_vary(sys);
    if (!b->fits) {
        return;
    }
    /* at the edge of the band Quinn's law opposes the velocity by 2 limit before it is cut to the limit, the limited one by
     * limit */
    const double edge = relaxes ? 2.0 : creeps ? 1.0 : 0.0;
    b->grip = creeps ? 0.0 : 1.0;
    tribo_get_epsilon(sys->contacts, b->room);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const size_t d = b->body[i];
        b->band[d] = law == TRIBO_COULOMB ? 0.0 : quotient(b->room[i], fabs(b->turn[i]));
        b->rate[d] = edge > 0.0 ? edge * quotient(b->brake[d], b->band[d]) : 0.0;
        b->fits &= b->mass[d] <= MOST && b->brake[d] <= MOST;
    }
}

/* -------------------------------------------------------------------------------------------------------- accelerations */

static size_t block_size(const tribo_system *sys, size_t k)
{
    const size_t left = sys->ndof - k * MATRIX_BLOCK;
    return left < MATRIX_BLOCK ? left : MATRIX_BLOCK;
}

/* Sets the system's time, and load: clears only the entries that are driven. */
static void set_time(struct blockwise *b, tribo_system *sys, double t)
{
    const struct loads *all = &sys->loads;
    tribo_system_set_time(sys, t);
    if (t == b->when) {
        return;
    }
    b->when = t;
    for (size_t s = 0; s < all->harmonics; s++) {
        const struct harmonic *h = &all->harmonic[s];
        for (size_t k = 0; h->drives == DRIVES_LOAD && k < h->count; k++) {
            b->load[h->index[k]] = 0.0;
        }
    }
    tribo_system_loads(sys, DRIVES_LOAD, 0, 1.0, b->load);
}

/* a = accelerations of block k without friction at the time set, from its first degree of freedom on. */
static void accelerate(const struct blockwise *b, const tribo_system *sys, size_t k, const double *q, const double *u, double *a)
{
    const size_t begin = k * MATRIX_BLOCK, end = begin + block_size(sys, k);
    tribo_matrix_add_rows(&sys->stiffness, begin, end, -1.0, q, b->load + begin, a);
    if (sys->damping.rows) {
        tribo_matrix_add_rows(&sys->damping, begin, end, -1.0, u, a, a);
    }
}

/* By the law: takes from the accelerations a of n bodies at velocities u what their contacts, from body i on, oppose. heat
 * [n] = power that each dissipates. */
TRIBO_SIMD static void oppose(const struct blockwise *b, size_t i, size_t n, const double *restrict u, double *restrict a,
                              double *restrict heat)
{
    const double *restrict mass = b->mass + i, *restrict brake = b->brake + i, *restrict band = b->band + i;
    const double *restrict rate = b->rate + i, grip = b->grip;
    for (size_t d = 0; d < n; d++) {
        const double held = grip * clamp(a[d], -brake[d], brake[d]), slowed = rate[d] * clamp(u[d], -band[d], band[d]);
        const double inside = clamp(held + slowed, -brake[d], brake[d]), outside = copysign(brake[d], u[d]);
        const double taken = fabs(u[d]) > band[d] ? outside : inside;
        a[d] -= taken;
        heat[d] = mass[d] * taken * u[d];
    }
}

void tribo_blockwise_rates(struct blockwise *b, tribo_system *sys, double t, const double *y, double *a, double *power)
{
    const double *u = y + sys->ndof;
    double heat[MATRIX_BLOCK];
    set_time(b, sys, t);
    *power = 0.0;
    for (size_t k = 0; k < b->blocks; k++) {
        const size_t i = k * MATRIX_BLOCK, n = block_size(sys, k);
        accelerate(b, sys, k, y, u, a + i);
        oppose(b, i, n, u + i, a + i, heat);
        *power += tribo_sum(n, heat);
    }
    sys->evaluations++;
}

/* ---------------------------------------------------------------------------------------------------------------- steps */

static void find_bases(struct blockwise *b, tribo_system *sys, double t, double *velocity)
{
    tribo_system_set_time(sys, t);
    memset(b->room, 0, sys->ncontact * sizeof *b->room);
    tribo_system_loads(sys, DRIVES_BASE, 0, 1.0, b->room);
    for (size_t i = 0; i < sys->ncontact; i++) {
        velocity[b->body[i]] = b->room[i] / b->turn[i];
    }
}

enum { STIRS = 1, GROWS = 2 };

/* Takes the step for n degrees of freedom from i on, with accelerations a [n] without friction. work [n] = minus twice the work
 * of friction. A body stops at the base if its friction can do that. Returns STIRS if one has a velocity at either end, GROWS if
 * one is not finite: looked at in words as wide as the numbers. */
TRIBO_SIMD static int move(const struct blockwise *b, const struct body_step *s, size_t i, size_t n, int moves,
                           const double *restrict a, double *restrict work)
{
    static const double resting[MATRIX_BLOCK];
    const double time = s->time, h = s->h;
    const double *restrict mass = b->mass + i, *restrict brake = b->brake + i;
    const double *restrict before = moves ? b->before + i : resting, *restrict after = moves ? b->after + i : resting;
    const double *restrict q = s->q + i, *restrict u = s->u + i;
    double *restrict q_to = s->q_to + i, *restrict u_to = s->u_to + i;
    int64_t speeds = 0, grows = 0;
    TRIBO_APART
    for (size_t d = 0; d < n; d++) {
        const double most = time * brake[d], free = u[d] + time * a[d], v = free - after[d], change = clamp(-v, -most, most);
        const int rests = fabs(v) < most;
        const double end = (rests ? after[d] : free) + (rests ? 0.0 : change); /* no choice of sums: loops are faster */
        const double to = q[d] + h * end;
        speeds |= fabs(u[d]) + fabs(end) > 0.0 ? -1 : 0;
        grows |= fabs(end) + fabs(to) <= DBL_MAX ? 0 : -1;
        work[d] = mass[d] * change * ((u[d] - before[d]) + (end - after[d]));
        u_to[d] = end;
        q_to[d] = to;
    }
    return (speeds ? STIRS : 0) | (grows ? GROWS : 0);
}

int tribo_blockwise_step(struct blockwise *b, tribo_system *sys, const struct body_step *s, double *energy, size_t *rested)
{
    const int moves = tribo_system_bases_move(sys);
    int did, all = 0;
    *rested += sys->ndof;
    set_time(b, sys, s->t);
    if (tribo_system_limits_vary(sys)) {
        take_limits(b, sys);
    }
    if (moves) {
        find_bases(b, sys, s->from, b->before);
        find_bases(b, sys, s->to, b->after);
    }
    for (unsigned char *next = b->awake; (next = memchr(next, 1, (size_t)(b->awake + b->blocks - next))) != NULL;) {
        const size_t k = (size_t)(next - b->awake), n = block_size(sys, k);
        double a[MATRIX_BLOCK], work[MATRIX_BLOCK];
        int wakes = b->driven[k] | b->wakes[k];
        accelerate(b, sys, k, s->q, s->u, a);
        all |= did = move(b, s, k * MATRIX_BLOCK, n, moves, a, work);
        *energy -= 0.5 * tribo_sum(n, work);
        *rested -= n;
        *next = 0;
        if (did & STIRS) {
            memset(b->wakes + b->first[k], 1, b->last[k] - b->first[k] + 1);
            continue;
        }
        /* contacts hold the block at rest in steps of any length */
        for (size_t i = 0; !wakes && i < n; i++) {
            wakes = !(fabs(a[i]) <= b->brake[k * MATRIX_BLOCK + i]);
        }
        b->wakes[k] = (unsigned char)wakes;
    }
    unsigned char *last = b->awake;
    b->awake = b->wakes;
    b->wakes = last;
    return !(all & GROWS);
}
