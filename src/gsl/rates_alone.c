#include "rates_alone.h"
#include "../common/simd.h"

#include <stdlib.h>
#include <string.h>

/* ----------------------------------------------------------------------------------------------------------------- life */

static void forget_contacts(struct rates_alone *r)
{
    for (size_t k = 0; k < r->blocks; k++) {
        if (k == 0 || r->block[k].contacts != r->block[k - 1].contacts) {
            tribo_destroy(r->block[k].contacts);
        }
    }
    for (size_t k = 0; k < r->blocks; k++) {
        r->block[k].contacts = NULL;
    }
    r->fits = 0;
}

void tribo_rates_free(struct rates_alone *r)
{
    forget_contacts(r);
    tribo_bodies_free(&r->bodies);
    free(r->block);
    free(r->memory);
    memset(r, 0, sizeof *r);
}

/* Where a block's arrays begin in those of all: a whole number of lines apart. */
static size_t stride_of(const tribo_system *sys)
{
    return (sys->ndof + TRIBO_LINE - 1) / TRIBO_LINE * TRIBO_LINE;
}

int tribo_rates_create(struct rates_alone *r, const tribo_system *sys)
{
    memset(r, 0, sizeof *r);
    if (!tribo_bodies_create(&r->bodies, sys)) {
        return 0;
    }
    if (!r->bodies.body) {
        return 1;
    }
    r->memory = malloc((3 * MATRIX_BLOCK + 6 * stride_of(sys) + TRIBO_LINE) * sizeof *r->memory);
    r->block = calloc(r->bodies.blocks, sizeof *r->block);
    if (!r->memory || !r->block) {
        return 0;
    }
    r->blocks = r->bodies.blocks;
    r->f = tribo_aligned(r->memory);
    r->v = r->f + MATRIX_BLOCK;
    r->a = r->v + MATRIX_BLOCK;
    r->own = r->a + MATRIX_BLOCK;
    return 1;
}

/* ------------------------------------------------------------------------------------------------------------- settings */

/* Where block k keeps what is its own. */
static struct rates_block own_block(const struct rates_alone *r, const tribo_system *sys, size_t k)
{
    const size_t n = stride_of(sys);
    double *m = r->own + k * MATRIX_BLOCK;
    return (struct rates_block){NULL, m, m + n, m + 2 * n, m + 3 * n, m + 4 * n, m + 5 * n, 1};
}

/* What all degrees of freedom have by their contacts. */
static void take_contacts(struct rates_alone *r, tribo_system *sys)
{
    const struct bodies_alone *b = &r->bodies;
    const struct rates_block all = own_block(r, sys, 0);
    for (size_t d = 0; d < sys->ndof; d++) {
        all.turn[d] = all.mobility[d] = all.tally[d] = all.limit[d] = 0.0;
        all.epsilon[d] = all.r[d] = 1.0;
    }
    tribo_get_limit(sys->contacts, sys->v);
    tribo_get_epsilon(sys->contacts, sys->a);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const size_t d = b->body[i];
        all.turn[d] = b->turn[i];
        all.mobility[d] = tribo_matrix_get(&sys->response, d, i);
        all.tally[d] = sys->tally[i];
        all.limit[d] = sys->v[i];
        all.epsilon[d] = sys->a[i];
        all.r[d] = all.turn[d] * all.mobility[d];
    }
}

static int same_row(const double *x, const double *y, size_t n)
{
    return memcmp(x, y, n * sizeof *x) == 0;
}

static int alike(const struct rates_block *x, const struct rates_block *y, size_t n)
{
    return same_row(x->turn, y->turn, n) && same_row(x->mobility, y->mobility, n) && same_row(x->tally, y->tally, n) &&
           same_row(x->limit, y->limit, n) && same_row(x->epsilon, y->epsilon, n) && same_row(x->r, y->r, n);
}

/* 1, or 0 if contacts cannot be made. */
static int make_contacts(struct rates_block *t, size_t n, int law)
{
    for (size_t d = 0; d < n; d++) {
        t->direct &= t->turn[d] == 1.0;
    }
    return !tribo_create(&t->contacts, n) && !tribo_set_law(t->contacts, law) && !tribo_set_limit(t->contacts, t->limit) &&
           !tribo_set_operator_diagonal(t->contacts, t->r) && !tribo_set_epsilon(t->contacts, t->epsilon);
}

/* Blocks, which share all with the one before if that is alike and as long. */
static int make_blocks(struct rates_alone *r, const tribo_system *sys, int law)
{
    int done = 1;
    for (size_t k = 0; done && k < r->blocks; k++) {
        const size_t n = tribo_bodies_of_block(sys, k);
        r->block[k] = own_block(r, sys, k);
        if (k && n == MATRIX_BLOCK && alike(&r->block[k - 1], &r->block[k], n)) {
            r->block[k] = r->block[k - 1];
        } else {
            done = make_contacts(&r->block[k], n, law);
        }
    }
    return done;
}

void tribo_rates_prepare(struct rates_alone *r, tribo_system *sys)
{
    int law;
    tribo_get_law(sys->contacts, &law);
    forget_contacts(r);
    r->revision = tribo_system_revision(sys);
    if (tribo_bodies_begin(&r->bodies, sys) && law != TRIBO_QUINN_REVERSAL && !sys->base_harmonics &&
        !tribo_system_limits_vary(sys)) {
        take_contacts(r, sys);
        r->fits = make_blocks(r, sys, law);
    }
}

int tribo_rates_fit(const struct rates_alone *r, const tribo_system *sys)
{
    return r->fits && r->revision == tribo_system_revision(sys);
}

/* ---------------------------------------------------------------------------------------------------------------- rates */

/* v = J u, and the accelerations b of contacts = J a. */
TRIBO_SIMD static void turn(size_t n, const double *restrict j, const double *restrict u, const double *restrict a,
                            double *restrict v, double *restrict b)
{
    for (size_t i = 0; i < n; i++) {
        v[i] = j[i] * u[i];
        b[i] = j[i] * a[i];
    }
}

/* a += B f; returns what friction dissipates. */
TRIBO_SIMD static double push(size_t n, const double *restrict mobility, const double *restrict tally, const double *restrict f,
                              const double *restrict v, double *restrict a)
{
    enum { LANES = 8 }; /* side by side, since one sum would wait for itself */
    double part[LANES] = {0.0}, sum = 0.0;
    size_t i = 0;
    for (; i + LANES <= n; i += LANES) {
        for (size_t k = 0; k < LANES; k++) {
            a[i + k] += mobility[i + k] * f[i + k];
            part[k] -= tally[i + k] * f[i + k] * v[i + k];
        }
    }
    for (; i < n; i++) {
        a[i] += mobility[i] * f[i];
        sum -= tally[i] * f[i] * v[i];
    }
    return sum + (((part[0] + part[4]) + (part[1] + part[5])) + ((part[2] + part[6]) + (part[3] + part[7])));
}

int tribo_rates_block(const struct rates_alone *r, const tribo_system *sys, size_t k, const double *q, const double *u, double *a,
                      double *power)
{
    const struct rates_block *b = &r->block[k];
    const size_t n = tribo_bodies_of_block(sys, k);
    const double *v = u + k * MATRIX_BLOCK;
    tribo_bodies_accelerate(&r->bodies, sys, k, q, u, a);
    if (!b->direct) {
        turn(n, b->turn, v, a, r->v, r->a);
        v = r->v;
    }
    const int status = tribo_balance(b->contacts, v, b->direct ? a : r->a, NULL, r->f);
    if (!status) {
        *power += push(n, b->mobility, b->tally, r->f, v, a);
    }
    return status;
}
