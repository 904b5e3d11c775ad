/* SPDX-License-Identifier: BSD-3-Clause */
/* What forces of planar contacts are made of: sliding, nearness to stick, the own block of R, forces of others. */
#include "core/static.h"
#include "parts.h"

/* Contacts nearer to the edge of their band have lenses whose inside is rounding. */
#define EDGE (1.0 - 16.0 * DBL_EPSILON)

struct slide tribo_planar_slide(const struct contacts *c, size_t i, size_t directions, const double *v)
{
    struct slide s = {.directions = directions, .open = 1};
    double longest = -1.0;
    for (size_t k = 0; k < directions; k++) {
        const double way = product(c->bound[i + k], tribo_epsilon_of(c, i + k));
        s.far = way > longest || (way == longest && c->bound[i + k] > c->bound[i]) ? k : s.far;
        longest = greater(longest, way);
        s.open &= !(c->bound[i + k] > 0.0);
    }
    const double bound = c->bound[i + s.far];
    for (size_t k = 0; k < directions && !s.open; k++) {
        s.part[k] = c->bound[i + k] == bound ? 1.0 : quotient(c->bound[i + k], bound);
        s.x[k] = product(s.part[k], v[k]);
    }
    s.length = tribo_length(2, s.x);
    for (size_t k = 0; k < directions && s.length > 0.0; k++) {
        s.n[k] = s.x[k] / s.length;
    }
    s.epsilon = tribo_epsilon_of(c, i + s.far);
    s.speed = quotient(s.length, s.epsilon);
    return s;
}

int tribo_planar_near(const struct law *law, const struct slide *s)
{
    const int near = !law->sticks_in_band ? s->length == 0.0 : law->relaxes ? s->speed < EDGE : s->speed <= 1.0;
    return !s->open && law->uses_feq && near;
}

/* Laws that do not use f_eq have the force of a scalar contact with limit and epsilon 1, along the direction of motion. */
double tribo_planar_carried(const struct law *law, double speed, double *slope)
{
    const double one = 1.0, two = 2.0, none = 0.0;
    const unsigned char moving = 0;
    const struct contacts c = {&one, &one, &one, &two, &moving, 0, 0, 0};
    double f = -1.0;
    struct tangent d = {0.0, 0.0, 0.0};
    if (!law->uses_feq) {
        law->tangent(&c, 1, &speed, &none, &(struct tangents){&f, &d.dv, &d.dfeq, &d.dlimit});
    }
    *slope = d.dv;
    return f;
}

void tribo_planar_slide_force(const struct law *law, const struct slide *s, const double *limit, double *f)
{
    double ignored;
    const double carried = tribo_planar_carried(law, s->speed, &ignored);
    for (size_t k = 0; k < s->directions; k++) {
        f[k] = carried * s->n[k] * limit[k];
    }
}

double tribo_planar_others(const tribo_context *ctx, const struct cluster *g, size_t k, size_t from, size_t directions, double a)
{
    const double *row = g->r + k * g->size;
    double sum = cut(a);
    for (size_t j = 0; j < g->size; j++) {
        const double bound = ctx->follow.contacts.bound[g->member[j]];
        sum += j - from < directions ? 0.0 : row[j] * clamp(ctx->last.f[g->member[j]], -bound, bound);
    }
    return sum;
}

struct block tribo_block_at(const double *r, size_t size, size_t k, size_t directions)
{
    const double *row = r + k * (size + 1), own[3] = {row[0], directions == 2 ? row[1] : 0.0, row[(directions - 1) * (size + 1)]};
    return tribo_block_of(own);
}

struct block tribo_block_of(const double *own)
{
    const double mean = 0.5 * own[0] + 0.5 * own[2], half = 0.5 * own[0] - 0.5 * own[2];
    const double turned[2] = {half, own[1]}, spread = tribo_length(2, turned);
    const double raw[2] = {half >= 0.0 ? spread + half : own[1], half >= 0.0 ? own[1] : spread - half},
                 length = tribo_length(2, raw);
    return (struct block){
        mean + spread, greater(mean - spread, 0.0), {length > 0.0 ? raw[0] / length : 1.0, length > 0.0 ? raw[1] / length : 0.0}};
}

void tribo_planar_push(const struct block *b, double *x)
{
    const double *e = b->e, along = e[0] * x[0] + e[1] * x[1], across = e[0] * x[1] - e[1] * x[0];
    const int lost = b->small <= 16.0 * DBL_EPSILON * b->great && fabs(across) <= 1e-12 * (fabs(x[0]) + fabs(x[1]));
    const double first = quotient(-along, greater(b->great, TRIBO_IMMOVABLE));
    const double second = lost ? 0.0 : quotient(-across, greater(b->small, TRIBO_IMMOVABLE));
    x[0] = cut(e[0] * first - e[1] * second);
    x[1] = cut(e[1] * first + e[0] * second);
}

void tribo_planar_limits(const tribo_context *ctx, size_t i, size_t directions, int holds, const double *v, double *limit)
{
    const double speed = tribo_length((int)directions, v);
    for (size_t k = 0; k < directions; k++) {
        limit[k] = holds && ctx->set.breaking == DROPS ? ctx->follow.hold[i + k] : tribo_limit_at(ctx, i + k, speed);
    }
}

struct contacts tribo_planar_view(const tribo_context *ctx, size_t i, size_t directions, double *limit)
{
    struct contacts c = tribo_contacts_from(&ctx->follow.contacts, i);
    if (ctx->set.breaking) {
        tribo_copy(limit, ctx->follow.hold + i, directions);
        c.limit = c.bound = limit;
    }
    return c;
}
