#include "rates_alone.h"
#include "numerics/linalg.h"
#include "common/real.h"
#include "common/simd.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ----------------------------------------------------------------------------------------------------------------- life */

void tribo_rates_free(struct rates_alone *r)
{
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

static size_t apart(size_t x, size_t y)
{
    return x > y ? x - y : y - x;
}

int tribo_rates_create(struct rates_alone *r, const tribo_system *sys)
{
    const size_t n = stride_of(sys);
    memset(r, 0, sizeof *r);
    if (!tribo_bodies_create(&r->bodies, sys)) {
        return 0;
    }
    if (!r->bodies.body) {
        return 1;
    }
    r->memory = malloc(((4 + RATES_TIMES) * n + TRIBO_LINE) * sizeof *r->memory);
    r->block = calloc(r->bodies.blocks, sizeof *r->block);
    if (!r->memory || !r->block) {
        return 0;
    }
    r->blocks = r->bodies.blocks;
    size_t reach = 0;
    for (size_t k = 0; k < r->bodies.blocks; k++) {
        for (size_t e = r->bodies.first[k]; e < r->bodies.first[k + 1]; e++) {
            reach = apart(k, r->bodies.pulled[e]) > reach ? apart(k, r->bodies.pulled[e]) : reach;
        }
    }
    r->reach = reach;
    r->own = tribo_aligned(r->memory);
    for (size_t k = 0; k < RATES_TIMES; k++) {
        r->load[k] = r->own + (4 + k) * n;
    }
    return 1;
}

/* ------------------------------------------------------------------------------------------------------------- settings */

/* Where block k keeps what is its own. */
static struct rates_block own_block(const struct rates_alone *r, const tribo_system *sys, size_t k)
{
    const size_t n = stride_of(sys);
    double *m = r->own + k * MATRIX_BLOCK;
    return (struct rates_block){m, m + n, m + 2 * n, m + 3 * n};
}

/* 1, or 0 if the law is none of these. */
static int find_grip(int law, enum grip *grip)
{
    *grip = law == TRIBO_QUINN ? RELAXES : law == TRIBO_VELOCITY_LIMITED ? CREEPS : HOLDS;
    return *grip != HOLDS || law == TRIBO_KARNOPP || law == TRIBO_COULOMB;
}

/* The part of |B| limit by which the law brakes at the edge of the band, rather more than less. */
static const double edge[] = {[RELAXES] = 2.0, [CREEPS] = 1.0, [HOLDS] = 0.0};

static double rate_of(double part, double brake, double band)
{
    const double rate = part * quotient(brake, band);
    return rate * band < part * brake ? rate * (1.0 + DBL_EPSILON) : rate;
}

/* Beyond this, sums of accelerations or products with masses might not be numbers. */
#define MOST 1e100

/* What all degrees of freedom have by their contacts: 1, or 0 if that is beyond what can be reckoned with. */
static int rates_take_contacts(struct rates_alone *r, tribo_system *sys, int law)
{
    const struct bodies_alone *b = &r->bodies;
    const struct rates_block all = own_block(r, sys, 0);
    const double part = edge[r->grip];
    int fits = 1;
    for (size_t d = 0; d < sys->ndof; d++) {
        all.mass[d] = b->mass[d];
        all.brake[d] = all.rate[d] = 0.0;
        all.band[d] = 1.0;
    }
    tribo_get_epsilon(sys->contacts, sys->v);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const size_t d = b->body[i];
        all.brake[d] = b->brake[d];
        all.band[d] = law == TRIBO_COULOMB ? 0.0 : quotient(sys->v[i], fabs(b->turn[i]));
        all.rate[d] = part > 0.0 ? rate_of(part, all.brake[d], all.band[d]) : 0.0;
        fits &= all.mass[d] <= MOST && all.brake[d] <= MOST && all.rate[d] * all.band[d] >= part * all.brake[d];
    }
    return fits;
}

static int same_row(const double *x, const double *y, size_t n)
{
    return memcmp(x, y, n * sizeof *x) == 0;
}

static int alike(const struct rates_block *x, const struct rates_block *y, size_t n)
{
    return same_row(x->mass, y->mass, n) && same_row(x->brake, y->brake, n) && same_row(x->band, y->band, n) &&
           same_row(x->rate, y->rate, n);
}

void tribo_rates_prepare(struct rates_alone *r, tribo_system *sys)
{
    int law;
    tribo_get_law(sys->contacts, &law);
    r->revision = tribo_system_revision(sys);
    r->fits = tribo_bodies_begin(&r->bodies, sys) && find_grip(law, &r->grip) && !tribo_system_bases_move(sys) &&
              !tribo_system_limits_vary(sys) && rates_take_contacts(r, sys, law);
    if (r->fits) {
        memset(r->load[0], 0, RATES_TIMES * stride_of(sys) * sizeof *r->load[0]);
        /* Blocks, which are read where the one before is if they are alike. */
        for (size_t k = 0; k < r->blocks; k++) {
            const struct rates_block own = own_block(r, sys, k);
            const int same = k && alike(&r->block[k - 1], &own, tribo_bodies_of_block(sys, k));
            r->block[k] = same ? r->block[k - 1] : own;
        }
    }
}

int tribo_rates_fit(const struct rates_alone *r, const tribo_system *sys)
{
    return r->fits && r->revision == tribo_system_revision(sys);
}

/* ---------------------------------------------------------------------------------------------------------------- rates */

void tribo_rates_set_time(struct rates_alone *r, tribo_system *sys, size_t k, double t)
{
    r->bodies.load = r->load[k];
    tribo_bodies_set_time(&r->bodies, sys, t);
}

/* By the law of each grip: takes from the accelerations a of bodies, at velocities u, what their contacts hold against; heat is
 * what each dissipates. */
TRIBO_SIMD static void relax(size_t n, const double *restrict mass, const double *restrict brake, const double *restrict band,
                             const double *restrict rate, const double *restrict u, double *restrict a, double *restrict heat)
{
    for (size_t i = 0; i < n; i++) {
        const double held = clamp(a[i], -brake[i], brake[i]), slowed = rate[i] * clamp(u[i], -band[i], band[i]);
        const double taken = clamp(held + slowed, -brake[i], brake[i]);
        a[i] -= taken;
        heat[i] = mass[i] * taken * u[i];
    }
}

TRIBO_SIMD static void rates_creep(size_t n, const double *restrict mass, const double *restrict brake,
                                   const double *restrict band, const double *restrict rate, const double *restrict u,
                                   double *restrict a, double *restrict heat)
{
    for (size_t i = 0; i < n; i++) {
        const double taken = clamp(rate[i] * clamp(u[i], -band[i], band[i]), -brake[i], brake[i]);
        a[i] -= taken;
        heat[i] = mass[i] * taken * u[i];
    }
}

TRIBO_SIMD static void hold(size_t n, const double *restrict mass, const double *restrict brake, const double *restrict band,
                            const double *restrict u, double *restrict a, double *restrict heat)
{
    for (size_t i = 0; i < n; i++) {
        const double held = clamp(a[i], -brake[i], brake[i]), slid = copysign(brake[i], u[i]);
        const double taken = fabs(u[i]) > band[i] ? slid : held;
        a[i] -= taken;
        heat[i] = mass[i] * taken * u[i];
    }
}

double tribo_rates_block(struct rates_alone *r, const tribo_system *sys, size_t time, size_t k, const double *q, const double *u,
                         double *a)
{
    const struct rates_block *b = &r->block[k];
    const size_t n = tribo_bodies_of_block(sys, k);
    const double *v = u + k * MATRIX_BLOCK;
    double heat[MATRIX_BLOCK];
    r->bodies.load = r->load[time];
    tribo_bodies_accelerate(&r->bodies, sys, k, q, u, a);
    if (r->grip == RELAXES) {
        relax(n, b->mass, b->brake, b->band, b->rate, v, a, heat);
    } else if (r->grip == CREEPS) {
        rates_creep(n, b->mass, b->brake, b->band, b->rate, v, a, heat);
    } else {
        hold(n, b->mass, b->brake, b->band, v, a, heat);
    }
    return tribo_sum(n, heat);
}
