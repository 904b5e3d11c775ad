/* SPDX-License-Identifier: BSD-3-Clause */
#include "blockwise.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/real.h"
#include "common/simd.h"
#include "step_form.h"

/* ----------------------------------------------------------------------------------------------------------------- life */

/* Finds the bodies. Returns 0 if a contact has none of its own, on which alone its force acts. taken [ndof]: workspace, all 0. */
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
    return alone;
}

/* Counts in at[k], or lists in pulled (not NULL) from at[k] on, the blocks whose rows of K or C have entries in the columns of
 * block k. mark [blocks]: workspace, the last block noted for each. */
static void note_pulls(const tribo_system *sys, size_t blocks, size_t *at, size_t *pulled, size_t *mark)
{
    const struct matrix *const of[] = {&sys->stiffness, &sys->damping};
    memset(mark, -1, blocks * sizeof *mark);
    for (size_t i = 0; i < 2 * sys->ndof; i++) {
        const struct matrix *a = of[i % 2];
        const size_t row = i / 2, to = row / MATRIX_BLOCK;
        for (size_t e = row < a->rows ? a->first[row] : 0; row < a->rows && e < a->first[row + 1]; e++) {
            const size_t from = a->col[e] / MATRIX_BLOCK;
            if (mark[from] != to) {
                mark[from] = to;
                if (pulled) {
                    pulled[at[from]] = to;
                }
                at[from]++;
            }
        }
    }
}

/* Sets first and pulled. In the first pass first[k + 2] counts blocks that block k accelerates, in the second one first[k +
 * 1] is the place of the next of them. Returns 0 if out of memory. */
static int map_pulls(struct blockwise *b, const tribo_system *sys)
{
    size_t *mark = malloc(b->blocks * sizeof *mark);
    if (!mark) {
        return 0;
    }
    note_pulls(sys, b->blocks, b->first + 2, NULL, mark);
    for (size_t k = 0; k < b->blocks; k++) {
        b->first[k + 2] += b->first[k + 1];
    }
    b->pulled = malloc((b->first[b->blocks + 1] + 1) * sizeof *b->pulled);
    if (b->pulled) {
        note_pulls(sys, b->blocks, b->first + 1, b->pulled, mark);
    }
    free(mark);
    return b->pulled != NULL;
}

void tribo_blockwise_free(struct blockwise *b)
{
    free(b->body);
    free(b->mass);
    free(b->first);
    free(b->pulled);
    free(b->driven);
    memset(b, 0, sizeof *b);
}

int tribo_blockwise_create(struct blockwise *b, const tribo_system *sys)
{
    const size_t n = sys->ndof, c = sys->ncontact, blocks = (n + MATRIX_BLOCK - 1) / MATRIX_BLOCK;
    memset(b, 0, sizeof *b);
    b->blocks = blocks;
    b->body = malloc((c + 1) * sizeof *b->body);
    b->mass = calloc(7 * n + 2 * c + 1, sizeof *b->mass);
    b->first = calloc(2 * blocks + 2, sizeof *b->first);
    b->driven = calloc(4 * blocks, 1);
    signed char *taken = calloc(n, 1);
    int done = b->body && b->mass && b->first && b->driven && taken;
    if (done) {
        b->brake = b->mass + n;
        b->band = b->brake + n;
        b->rate = b->band + n;
        b->before = b->rate + n;
        b->after = b->before + n;
        b->load = b->after + n;
        b->turn = b->load + n;
        b->room = b->turn + c;
        b->still = b->first + blocks + 2;
        b->loaded = b->driven + blocks;
        b->awake = b->loaded + blocks;
        b->wakes = b->awake + blocks;
        if (find_bodies(b, sys, taken)) {
            done = map_pulls(b, sys);
        } else {
            tribo_blockwise_free(b);
        }
    }
    free(taken);
    return done;
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

/* Notes that a load or another function, varying with time or not, acts on a degree of freedom, or on the body of a contact. */
static void note_drive(struct blockwise *b, enum drives drives, size_t i, int varies)
{
    const size_t k = (drives == DRIVES_LOAD ? i : b->body[i]) / MATRIX_BLOCK;
    b->driven[k] |= (unsigned char)varies;
    b->loaded[k] |= drives == DRIVES_LOAD;
}

int tribo_blockwise_take(struct blockwise *b, tribo_system *sys)
{
    b->revision = tribo_system_revision(sys);
    b->fits = b->body && tribo_system_is_plain(sys);
    if (!b->fits) {
        return 0;
    }
    b->goes_on = 0;
    b->time = NAN;
    memset(b->awake, 1, b->blocks);
    memset(b->wakes, 0, b->blocks);
    memset(b->load, 0, sys->ndof * sizeof *b->load);
    memset(b->driven, tribo_system_limits_vary(sys), b->blocks);
    memset(b->loaded, 0, b->blocks);
    for (size_t s = 0; s < sys->loads.harmonics; s++) {
        const struct harmonic *h = &sys->loads.harmonic[s];
        for (size_t k = 0; k < h->count; k++) {
            note_drive(b, h->drives, h->index[k], h->drives == DRIVES_BASE || h->omega != 0.0 || h->knots);
        }
    }
    take_limits(b, sys);
    return 1;
}

/* Sums of accelerations and products with masses up to this size are numbers. */
#define MOST 1e100

int tribo_blockwise_take_law(struct blockwise *b, tribo_system *sys)
{
    int law;
    tribo_get_law(sys->contacts, &law);
    const int relaxes = law == TRIBO_QUINN, creeps = law == TRIBO_VELOCITY_LIMITED;
    b->has_law = tribo_blockwise_take(b, sys) && (relaxes || creeps || law == TRIBO_KARNOPP || law == TRIBO_COULOMB) &&
                 !tribo_system_bases_move(sys) && !tribo_system_limits_vary(sys);
    if (!b->has_law) {
        return 0;
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
        b->has_law &= b->mass[d] <= MOST && b->brake[d] <= MOST;
    }
    return b->has_law;
}

/* -------------------------------------------------------------------------------------------------------- accelerations */

static size_t block_size(const tribo_system *sys, size_t k)
{
    const size_t left = sys->ndof - k * MATRIX_BLOCK;
    return left < MATRIX_BLOCK ? left : MATRIX_BLOCK;
}

/* Sets the system's time, and the loads of blocks that have any. */
static void set_time(struct blockwise *b, tribo_system *sys, double t)
{
    tribo_system_set_time(sys, t);
    if (b->time == t) {
        return;
    }
    b->time = t;
    for (size_t k = 0; k < b->blocks; k++) {
        if (b->loaded[k]) {
            memset(b->load + k * MATRIX_BLOCK, 0, block_size(sys, k) * sizeof *b->load);
        }
    }
    for (size_t s = 0; s < sys->loads.harmonics; s++) {
        const struct harmonic *h = &sys->loads.harmonic[s];
        if (h->drives == DRIVES_LOAD) {
            tribo_system_turn(sys, s);
            for (size_t k = 0; k < h->count; k++) {
                b->load[h->index[k]] += h->cosine[k] * h->cos_t + h->sine[k] * h->sin_t;
            }
        }
    }
}

/* a = accelerations of block k without friction at the time set, from its first degree of freedom on. */
static void accelerate(const struct blockwise *b, const tribo_system *sys, size_t k, const double *q, const double *u, double *a)
{
    const size_t begin = k * MATRIX_BLOCK, n = block_size(sys, k), end = begin + n;
    memcpy(a, b->load + begin, n * sizeof *a);
    tribo_matrix_add_rows(&sys->stiffness, begin, end, -1.0, q, a);
    if (sys->damping.rows) {
        tribo_matrix_add_rows(&sys->damping, begin, end, -1.0, u, a);
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

/* The bits of x: all 0 but the sign if x is 0. */
static inline int64_t bits_of(double x)
{
    int64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

enum { STIRS = 1, GROWS = 2 };

/* Takes the step for n degrees of freedom from i on. a [n]: in, accelerations without friction; out, minus twice the work of
 * friction. A body stops at the base if its friction can do that. Returns STIRS if one has a velocity at either end, GROWS
 * if one is not finite: looked at in words as wide as the numbers. */
TRIBO_SIMD static int move(const struct blockwise *b, const struct body_step *s, size_t i, size_t n, int moves,
                           double *restrict a)
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
        speeds |= bits_of(u[d]) | bits_of(end);
        grows |= fabs(end) + fabs(to) <= DBL_MAX ? 0 : -1;
        a[d] = mass[d] * change * ((u[d] - before[d]) + (end - after[d]));
        u_to[d] = end;
        q_to[d] = to;
    }
    return (speeds & INT64_MAX ? STIRS : 0) | (grows ? GROWS : 0);
}

/* The first block from k on that is awake; b->blocks if there is none. */
static inline size_t next_awake(const struct blockwise *b, size_t k)
{
    if (k >= b->blocks || b->awake[k]) {
        return k;
    }
    const unsigned char *found = memchr(b->awake + k, 1, b->blocks - k);
    return found ? (size_t)(found - b->awake) : b->blocks;
}

/* 1 if contacts hold all of block k, which is at rest, in steps of any length. */
static int block_rests(const struct blockwise *b, const tribo_system *sys, size_t k, const double *q, const double *u)
{
    double a[MATRIX_BLOCK];
    int all = 1;
    accelerate(b, sys, k, q, u, a);
    for (size_t i = 0; i < block_size(sys, k); i++) {
        all &= fabs(a[i]) <= b->brake[k * MATRIX_BLOCK + i];
    }
    return all;
}

int tribo_blockwise_step(struct blockwise *b, tribo_system *sys, const struct body_step *s, double *energy)
{
    const int moves = tribo_system_bases_move(sys);
    int did, all = 0;
    size_t stills = 0, left = sys->ndof;
    set_time(b, sys, s->t);
    if (tribo_system_limits_vary(sys)) {
        take_limits(b, sys);
    }
    if (moves) {
        double *last = b->before;
        b->before = b->after;
        b->after = last;
        if (!b->goes_on) {
            find_bases(b, sys, s->from, b->before);
        }
        find_bases(b, sys, s->to, b->after);
    }
    b->goes_on = 1;
    for (size_t k = next_awake(b, 0); k < b->blocks; k = next_awake(b, k + 1)) {
        const size_t n = block_size(sys, k);
        double a[MATRIX_BLOCK];
        accelerate(b, sys, k, s->q, s->u, a);
        all |= did = move(b, s, k * MATRIX_BLOCK, n, moves, a);
        *energy -= 0.5 * tribo_sum(n, a);
        left -= n;
        b->awake[k] = 0;
        if (did & STIRS) {
            b->wakes[k] = 1; /* also by damping that is set later, which is diagonal */
            for (size_t e = b->first[k]; e < b->first[k + 1]; e++) {
                b->wakes[b->pulled[e]] = 1;
            }
        } else if (b->driven[k]) {
            b->wakes[k] = 1;
        } else {
            b->still[stills++] = k;
        }
    }
    b->skipped += left;
    while (stills > 0) {
        const size_t k = b->still[--stills];
        if (!b->wakes[k] && !block_rests(b, sys, k, s->q_to, s->u_to)) {
            b->wakes[k] = 1;
        }
    }
    unsigned char *last = b->awake;
    b->awake = b->wakes;
    b->wakes = last;
    return !(all & GROWS);
}
