#include "bodies_alone.h"
#include "few_bodies.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/linalg.h"
#include "common/real.h"
#include "common/simd.h"

/* ----------------------------------------------------------------------------------------------------------------- life */

/* The only entry of contact i in J that is not 0; 0 if there are none, or more. */
static int find_body(const struct matrix *j, size_t i, size_t *body, double *turn)
{
    size_t count = 0;
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        if (j->val[k] != 0.0) {
            *body = j->col[k];
            *turn = j->val[k];
            count++;
        }
    }
    return count == 1;
}

/* Whether each contact has a body of its own, on which alone its force acts. single [ndof] is workspace: all 1. */
static int find_bodies(struct bodies_alone *b, const tribo_system *sys, unsigned char *single)
{
    const struct matrix *response = &sys->response;
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (!find_body(&sys->direction, i, &b->body[i], &b->turn[i]) || !single[b->body[i]]) {
            return 0;
        }
        const size_t d = b->body[i];
        const double mobility = tribo_matrix_get(response, d, i);
        b->mass[d] = sys->tally[i] * b->turn[i] / mobility;
        single[d] = 0;
        if (!(b->mass[d] > 0.0) || !isfinite(b->mass[d]) || fabs(mobility) < DBL_MIN) {
            return 0;
        }
    }
    return response->first[response->rows] == sys->ncontact;
}

/* A map in the making: as long as `to` is NULL it only counts. */
struct map {
    size_t *at;   /* [blocks] how many blocks each one pulls at; where it notes the next of them */
    size_t *mark; /* [blocks] the last one noted, from 1 on: 0 at first */
    size_t *to;
};

static void note_pull(const struct map *m, size_t block, size_t k)
{
    if (m->mark[block] != k + 1) {
        m->mark[block] = k + 1;
        if (m->to) {
            m->to[m->at[block]] = k;
        }
        m->at[block]++;
    }
}

/* Blocks in which matrix a has entries in rows of block k pull at it. */
static void note_pulls(const struct map *m, const struct matrix *a, size_t k)
{
    const size_t end = (k + 1) * MATRIX_BLOCK;
    for (size_t i = k * MATRIX_BLOCK; i < end && i < a->rows; i++) {
        for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
            note_pull(m, a->col[e] / MATRIX_BLOCK, k);
        }
    }
}

/* Damping that is set later is diagonal: each block pulls at itself. */
static void note_all(const struct map *m, const tribo_system *sys, size_t blocks)
{
    for (size_t k = 0; k < blocks; k++) {
        note_pull(m, k, k);
        note_pulls(m, &sys->stiffness, k);
        note_pulls(m, &sys->damping, k);
    }
}

/* How many blocks there are. */
static size_t bodies_blocks_of(size_t n)
{
    return (n + MATRIX_BLOCK - 1) / MATRIX_BLOCK;
}

static int bodies_allocate(struct bodies_alone *b, size_t n, size_t c)
{
    b->blocks = bodies_blocks_of(n);
    b->body = malloc((c + 1) * sizeof *b->body);
    b->rows = calloc(b->blocks + 1, sizeof *b->rows);
    b->mass = calloc(5 * n + 2 * c + 1, sizeof *b->mass);
    b->first = calloc(2 * b->blocks + 2, sizeof *b->first);
    b->driven = calloc(4 * b->blocks + 1, 1);
    if (!b->body || !b->rows || !b->mass || !b->first || !b->driven) {
        return 0;
    }
    b->brake = b->mass + n;
    b->before = b->brake + n;
    b->after = b->before + n;
    b->load = b->after + n;
    b->turn = b->load + n;
    b->room = b->turn + c;
    b->still = b->first + b->blocks + 2;
    b->awake = b->driven + b->blocks;
    b->wakes = b->awake + b->blocks;
    b->loaded = b->wakes + b->blocks;
    return 1;
}

void tribo_bodies_free(struct bodies_alone *b)
{
    free(b->body);
    free(b->rows);
    free(b->mass);
    free(b->first);
    free(b->pulled);
    free(b->driven);
    memset(b, 0, sizeof *b);
}

int tribo_bodies_create(struct bodies_alone *b, const tribo_system *sys)
{
    const size_t n = sys->ndof;
    memset(b, 0, sizeof *b);
    unsigned char *single = malloc(n);
    size_t *mark = calloc(2 * bodies_blocks_of(n), sizeof *mark);
    int done = single && mark && bodies_allocate(b, n, sys->ncontact);
    if (done) {
        memset(single, 1, n);
        if (!find_bodies(b, sys, single)) {
            tribo_bodies_free(b);
        } else {
            /* The map of the blocks: counted first, then written. mark [2 blocks] is workspace, all 0. While it is written first[k + 1] is
             * where block k goes on, and in the end where it ends. */
            note_all(&(struct map){b->first + 2, mark, NULL}, sys, b->blocks);
            for (size_t k = 0; k < b->blocks; k++) {
                b->first[k + 2] += b->first[k + 1];
            }
            b->pulled = malloc((b->first[b->blocks + 1] + 1) * sizeof *b->pulled);
            if (b->pulled) {
                note_all(&(struct map){b->first + 1, mark + b->blocks, b->pulled}, sys, b->blocks);
            }
            done = b->pulled != NULL;
        }
    }
    free(single);
    free(mark);
    return done;
}

/* ------------------------------------------------------------------------------------------------------------- settings */

/* Whether Coulomb's law of scalar contacts with one limit is all that there is. */
static int plain_contacts(struct bodies_alone *b, const tribo_system *sys)
{
    size_t planar = 0;
    tribo_get_count(sys->contacts, TRIBO_COUNT_PLANAR, &planar);
    tribo_get_static(sys->contacts, b->room, NULL);
    for (size_t i = 0; i < sys->ncontact; i++) {
        planar += b->room[i] > 1.0;
    }
    return !planar;
}

static void bodies_take_limits(struct bodies_alone *b, const tribo_system *sys)
{
    tribo_get_limit(sys->contacts, b->room);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const size_t d = b->body[i];
        b->brake[d] = product(fabs(tribo_matrix_get(&sys->response, d, i)), lesser(b->room[i], TRIBO_FAR));
    }
    /* Where the masses and brakes of block k are read: where those of the block before are, if they are the same. What is not read
     * need not come from memory. */
    for (size_t k = 0, i = 0; k < b->blocks; k++, i += MATRIX_BLOCK) {
        const struct body_rows own = {b->mass + i, b->brake + i};
        const struct body_rows *last = k ? &b->rows[k - 1] : &own;
        const size_t bytes = tribo_bodies_of_block(sys, k) * sizeof *own.mass;
        const int same = memcmp(last->mass, own.mass, bytes) == 0 && memcmp(last->brake, own.brake, bytes) == 0;
        b->rows[k] = same ? *last : own;
    }
}

int tribo_bodies_begin(struct bodies_alone *b, tribo_system *sys)
{
    b->goes_on = 0;
    b->revision = tribo_system_revision(sys);
    b->fits = b->body && plain_contacts(b, sys);
    if (b->fits) {
        memset(b->awake, 1, b->blocks);
        memset(b->wakes, 0, b->blocks);
        memset(b->load, 0, sys->ndof * sizeof *b->load);
        /* Blocks on which something acts that changes with time, or moves; and those with a load. */
        memset(b->driven, tribo_system_limits_vary(sys), b->blocks);
        memset(b->loaded, 0, b->blocks);
        for (size_t s = 0; s < sys->harmonics; s++) {
            const struct harmonic *h = &sys->harmonic[s];
            for (size_t k = 0; k < h->count; k++) {
                const size_t d = h->drives == DRIVES_LOAD ? h->index[k] : b->body[h->index[k]];
                b->driven[d / MATRIX_BLOCK] |= h->drives == DRIVES_BASE || h->omega != 0.0;
                b->loaded[d / MATRIX_BLOCK] |= h->drives == DRIVES_LOAD;
            }
        }
        for (size_t s = 0; s < sys->tables; s++) {
            const int of_load = sys->table[s].drives == DRIVES_LOAD;
            for (size_t k = 0; k < (of_load ? sys->ndof : sys->ncontact); k++) {
                const size_t block = (of_load ? k : b->body[k]) / MATRIX_BLOCK;
                b->driven[block] |= sys->table[s].pattern[k] != 0.0;
                b->loaded[block] |= of_load && sys->table[s].pattern[k] != 0.0;
            }
        }
        bodies_take_limits(b, sys);
    }
    return b->fits;
}

/* ---------------------------------------------------------------------------------------------------------------- steps */

static void find_bases(struct bodies_alone *b, tribo_system *sys, double t, double *velocity)
{
    tribo_system_set_time(sys, t);
    memset(b->room, 0, sys->ncontact * sizeof *b->room);
    tribo_system_loads(sys, DRIVES_BASE, 0, 1.0, b->room);
    for (size_t i = 0; i < sys->ncontact; i++) {
        velocity[b->body[i]] = b->room[i] / b->turn[i];
    }
}

void tribo_bodies_set_time(struct bodies_alone *b, tribo_system *sys, double t)
{
    tribo_system_set_time(sys, t);
    for (size_t s = 0; s < sys->harmonics; s++) {
        const struct harmonic *h = &sys->harmonic[s];
        for (size_t k = 0; h->drives == DRIVES_LOAD && k < h->count; k++) {
            b->load[h->index[k]] = 0.0;
        }
    }
    if (sys->tables > sys->base_tables) {
        /* What tables say, of the blocks that they drive. Other loads there are forgotten. */
        for (size_t k = 0; k < b->blocks; k++) {
            if (b->driven[k]) {
                const size_t begin = k * MATRIX_BLOCK, n = tribo_bodies_of_block(sys, k);
                memset(b->load + begin, 0, n * sizeof *b->load);
                tribo_system_tables(sys, DRIVES_LOAD, 0, 1.0, begin, begin + n, b->load);
            }
        }
    }
    for (size_t s = 0; s < sys->harmonics; s++) {
        const struct harmonic *h = &sys->harmonic[s];
        if (h->drives == DRIVES_LOAD) {
            tribo_system_turn(sys, s);
        }
        for (size_t k = 0; h->drives == DRIVES_LOAD && k < h->count; k++) {
            b->load[h->index[k]] += h->cosine[k] * h->cos_t + h->sine[k] * h->sin_t;
        }
    }
}

/* What came of a step. */
enum { STIRS = 1, GROWS = 2 };

/* Its bits, of which only the sign may be set where x is 0. */
static inline int64_t bodies_bits_of(double x)
{
    int64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* A step of one degree of freedom: its velocity and place at the end, and what friction does, twice. */
struct moved {
    double u, q, work;
};

/* a: the acceleration without friction. A contact whose body would come no farther than its force can bring it back rests at the
 * end. */
static inline struct moved move_one(double time, double h, double mass, double brake, double before, double after, double q,
                                    double u, double a)
{
    const double most = time * brake, free = u + time * a, v = free - after, change = clamp(-v, -most, most);
    const int rests = fabs(v) < most;
    const double end = (rests ? after : free) + (rests ? 0.0 : change); /* no choice of sums: that makes loops fast */
    return (struct moved){end, q + h * end, mass * change * ((u - before) + (end - after))};
}

/* What came of it, as wide as what is looked at: other bits than the sign if the body moves; any if it is no longer finite. */
struct fate {
    int64_t speeds, grows;
};

static inline void note(struct fate *f, double u, const struct moved *m)
{
    f->speeds |= bodies_bits_of(u) | bodies_bits_of(m->u);
    f->grows |= fabs(m->u) + fabs(m->q) <= DBL_MAX ? 0 : -1;
}

/* n degrees of freedom, from the first of those that all arrays begin with. a: accelerations, which become what friction does. */
TRIBO_SIMD static int move(size_t n, double time, double h, const double *restrict mass, const double *restrict brake,
                           const double *restrict before, const double *restrict after, const double *restrict q,
                           const double *restrict u, double *restrict q_to, double *restrict u_to, double *restrict a)
{
    struct fate fate = {0, 0};
    for (size_t i = 0; i < n; i++) {
        const struct moved to = move_one(time, h, mass[i], brake[i], before[i], after[i], q[i], u[i], a[i]);
        note(&fate, u[i], &to);
        a[i] = to.work;
        u_to[i] = to.u;
        q_to[i] = to.q;
    }
    return (fate.speeds & INT64_MAX ? STIRS : 0) | (fate.grows ? GROWS : 0);
}

/* The acceleration of degree of freedom i without friction, by its rows. */
static inline double free_one(const struct bodies_alone *b, const tribo_system *sys, size_t i, const double *q, const double *u)
{
    const double a = b->load[i] - tribo_matrix_row_dot(&sys->stiffness, i, q);
    return sys->damping.rows ? a - tribo_matrix_row_dot(&sys->damping, i, u) : a;
}

static void accelerate_block(const struct bodies_alone *b, const tribo_system *sys, size_t k, const double *q, const double *u,
                             double *a)
{
    const size_t i = k * MATRIX_BLOCK, n = tribo_bodies_of_block(sys, k);
    if (b->loaded[k]) {
        memcpy(a, b->load + i, n * sizeof *a);
    } else {
        memset(a, 0, n * sizeof *a);
    }
    tribo_matrix_add_rows(&sys->stiffness, i, i + n, -1.0, q, a);
    if (sys->damping.rows) {
        tribo_matrix_add_rows(&sys->damping, i, i + n, -1.0, u, a);
    }
}

void tribo_bodies_accelerate(const struct bodies_alone *b, const tribo_system *sys, size_t k, const double *q, const double *u,
                             double *a)
{
    if (sys->ndof <= FEW) {
        for (size_t i = 0; i < sys->ndof; i++) {
            a[i] = free_one(b, sys, i, q, u);
        }
    } else {
        accelerate_block(b, sys, k, q, u, a);
    }
}

/* Block k. */
static int step_block(const struct bodies_alone *b, const tribo_system *sys, const struct body_step *s, size_t k, double *energy)
{
    static const double nothing[MATRIX_BLOCK];
    double work[MATRIX_BLOCK];
    const size_t i = k * MATRIX_BLOCK, n = tribo_bodies_of_block(sys, k);
    const int moves = tribo_system_bases_move(sys);
    const double *before = moves ? b->before + i : nothing, *after = moves ? b->after + i : nothing;
    accelerate_block(b, sys, k, s->q, s->u, work);
    const int did = move(n, s->time, s->h, b->rows[k].mass, b->rows[k].brake, before, after, s->q + i, s->u + i, s->q_to + i,
                         s->u_to + i, work);
    *energy -= 0.5 * tribo_sum(n, work);
    return did;
}

/* The first block from k on that is awake; as many as there are, if there is none. Long rows of blocks at rest are passed over by
 * the C library, many at a time. */
static inline size_t next_awake(const struct bodies_alone *b, size_t k)
{
    if (k >= b->blocks || b->awake[k]) {
        return k;
    }
    const unsigned char *found = memchr(b->awake + k, 1, b->blocks - k);
    return found ? (size_t)(found - b->awake) : b->blocks;
}

/* Whether contacts hold all of block k, which is at rest, in steps of any length. */
static int bodies_holds(const struct bodies_alone *b, const tribo_system *sys, size_t k, const double *q, const double *u)
{
    double a[MATRIX_BLOCK];
    int all = 1;
    tribo_bodies_accelerate(b, sys, k, q, u, a);
    for (size_t i = 0; i < tribo_bodies_of_block(sys, k); i++) {
        all &= fabs(a[i]) <= b->rows[k].brake[i];
    }
    return all;
}

/* Blocks that the next step would leave out are asked once whether they stay where they are. */
static void let_rest(struct bodies_alone *b, const tribo_system *sys, const struct body_step *s)
{
    while (b->stills > 0) {
        const size_t k = b->still[--b->stills];
        if (!b->wakes[k] && !bodies_holds(b, sys, k, s->q_to, s->u_to)) {
            b->wakes[k] = 1;
        }
    }
}

int tribo_bodies_step(struct bodies_alone *b, tribo_system *sys, const struct body_step *s, double *energy)
{
    int all = 0;
    size_t left = sys->ndof;
    /* All that acts from outside, at the times of the step. */
    tribo_bodies_set_time(b, sys, s->t);
    if (tribo_system_limits_vary(sys)) {
        bodies_take_limits(b, sys);
    }
    if (tribo_system_bases_move(sys)) {
        double *first = b->before;
        b->before = b->after;
        b->after = first;
        if (!b->goes_on) {
            find_bases(b, sys, s->from, b->before);
        }
        find_bases(b, sys, s->to, b->after);
    }
    b->goes_on = 1;
    for (size_t k = next_awake(b, 0); k < b->blocks; k = next_awake(b, k + 1)) {
        const int did = step_block(b, sys, s, k, energy);
        all |= did;
        left -= tribo_bodies_of_block(sys, k);
        /* What the next step looks at since it has looked at block k: all that this pulls at, if it has moved. */
        const int moved = did & STIRS;
        b->awake[k] = 0;
        if (moved) {
            for (size_t e = b->first[k]; e < b->first[k + 1]; e++) {
                b->wakes[b->pulled[e]] = 1;
            }
        } else if (b->driven[k]) {
            b->wakes[k] = 1;
        } else {
            b->still[b->stills++] = k;
        }
    }
    b->skipped += left;
    let_rest(b, sys, s);
    unsigned char *last = b->awake;
    b->awake = b->wakes;
    b->wakes = last;
    return !(all & GROWS);
}
