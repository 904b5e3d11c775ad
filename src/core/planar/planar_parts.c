/* What forces of planar contacts are made of: sliding, nearness to stick, the own block of R, forces of others. */
#include "parts.h"

/* Contacts nearer to the edge of their band have lenses whose inside is rounding. */
#define EDGE (1.0 - 16.0 * DBL_EPSILON)

struct slide tribo_planar_slide(const struct contacts *c, size_t i, const double *v)
{
    const double reach[2] = {product(c->bound[i], tribo_epsilon_of(c, i)), product(c->bound[i + 1], tribo_epsilon_of(c, i + 1))};
    const size_t far = reach[1] > reach[0] || (reach[1] == reach[0] && c->bound[i + 1] > c->bound[i]) ? i + 1 : i;
    struct slide s = {.open = !(c->bound[i] > 0.0 || c->bound[i + 1] > 0.0), .far = far - i, .epsilon = tribo_epsilon_of(c, far)};
    for (size_t k = 0; k < 2 && !s.open; k++) {
        s.part[k] = c->bound[i + k] == c->bound[far] ? 1.0 : quotient(c->bound[i + k], c->bound[far]);
        s.x[k] = product(s.part[k], v[k]);
    }
    s.length = tribo_length(2, s.x);
    for (size_t k = 0; k < 2 && s.length > 0.0; k++) {
        s.n[k] = s.x[k] / s.length;
    }
    s.speed = quotient(s.length, s.epsilon);
    return s;
}

/* speed: |v|/epsilon; rests: v = 0. */
static int is_near(const struct law *law, double speed, int rests)
{
    return law->uses_feq && (!law->sticks_in_band ? rests : law->relaxes ? speed < EDGE : speed <= 1.0);
}

int tribo_planar_near(const struct law *law, const struct slide *s)
{
    return !s->open && is_near(law, s->speed, s->length == 0.0);
}

int tribo_scalar_near(const struct law *law, const struct contacts *c, size_t i, double v)
{
    return c->limit[i] > 0.0 && is_near(law, quotient(fabs(v), tribo_epsilon_of(c, i)), v == 0.0);
}

/* Laws that do not use f_eq are those of a scalar contact, along the direction of motion. */
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
    for (size_t k = 0; k < 2; k++) {
        f[k] = carried * s->n[k] * limit[k];
    }
}

double tribo_planar_others(const tribo_context *ctx, const struct cluster *g, size_t k, size_t from, size_t directions, double a)
{
    const size_t *member = ctx->planar->member + g->member;
    const double *row = ctx->planar->r + g->r + k * g->size;
    double sum = cut(a);
    for (size_t j = 0; j < g->size; j++) {
        const double bound = ctx->follow.contacts.bound[member[j]];
        sum += j - from < directions ? 0.0 : row[j] * clamp(tribo_force_of(ctx, member[j]), -bound, bound);
    }
    return sum;
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
