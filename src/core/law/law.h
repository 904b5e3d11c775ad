/* What a friction law is: a record in the registry, a force and its derivatives for one contact, and the loops over
 * contacts that TRIBO_LAW_LOOPS makes of them. To add a law, write one file like quinn.c, and add its record to
 * registry.c and its number to tribo.h. */
#ifndef TRIBO_LAW_H
#define TRIBO_LAW_H

#include <float.h>
#include <math.h>
#include <stddef.h>

#include "../../common/real.h"
#include "../../common/simd.h"

/* What laws know of contacts, an array each. Everything but limits stays when limits change: a law finds epsilon, and slope =
 * 2 limit/epsilon, from width and rate.
 *   epsilon does not follow the limit:  epsilon = width,        slope = rate bound,  rate = 2/epsilon
 *   it follows the limit:               epsilon = width bound,  slope = rate,        rate = 2/width, or 0 where nothing relaxes
 */
struct contacts {
    const double *limit;
    const double *bound; /* the same, or less where width or rate times it would be no number */
    const double *width, *rate;
    const unsigned char *moving; /* reversal memory */
    int follows;
    int scales; /* epsilon goes with the caller's limit, also where it is in width (static limits) */
};

/* follows is a constant. */
static inline double tribo_epsilon(int follows, double width, double bound)
{
    return follows ? greater(width * bound, DBL_MIN) : width;
}

static inline double tribo_slope(int follows, double rate, double bound)
{
    return follows ? (bound > 0.0 ? rate : 0.0) : rate * bound;
}

/* rate of an epsilon that is given. */
static inline double tribo_rate(double epsilon)
{
    return 2.0 * quotient(1.0, epsilon);
}

static inline struct contacts tribo_contacts_from(const struct contacts *c, size_t i)
{
    return (struct contacts){c->limit + i, c->bound + i, c->width + i, c->rate + i, c->moving + i, c->follows, c->scales};
}

/* epsilon and slope of contact i, where follows is no constant: factors are chosen, not products, which might overflow where they
 * are not wanted. */
static inline double tribo_epsilon_of(const struct contacts *c, size_t i)
{
    return greater(c->width[i] * (c->follows ? c->bound[i] : 1.0), c->follows ? DBL_MIN : 0.0);
}

static inline double tribo_slope_of(const struct contacts *c, size_t i)
{
    return c->rate[i] * (!c->follows ? c->bound[i] : c->bound[i] > 0.0 ? 1.0 : 0.0);
}

/* How the slope follows the limit. */
static inline double tribo_slope_rate_of(const struct contacts *c, size_t i)
{
    return c->follows ? 0.0 : c->rate[i];
}

struct tangent {
    double dv, dfeq, dlimit;
};

struct law {
    int id;
    const char *name, *reference;
    int uses_feq;
    int sticks_in_band; /* reads f_eq where |v| <= epsilon; otherwise where v = 0 */
    int relaxes;        /* inside the band f = clamp(f_eq) - slope v, otherwise clamp(f_eq) */
    int remembers;      /* uses the reversal memory, and must be told of accepted steps */
    double holds;       /* a contact counts as stuck while |f| is less than this part of its limit */
    /* f_eq is finite, also where it does not matter, and TRIBO_FAR at most; v is any finite number */
    void (*force)(const struct contacts *c, size_t n, const double *v, const double *feq, double *f);
    void (*tangent)(const struct contacts *c, size_t n, const double *v, const double *feq, struct tangent *d);
};

extern const struct law tribo_law_coulomb, tribo_law_velocity_limited, tribo_law_smooth, tribo_law_karnopp, tribo_law_quinn,
    tribo_law_quinn_reversal;

const struct law *tribo_law(int id); /* NULL if there is none */

static inline double sign(double x)
{
    return (double)((x > 0.0) - (x < 0.0));
}

/* -limit sgn v, for v != 0. */
static inline double sliding(double v, double limit)
{
    return copysign(limit, -v);
}

/* How these forces change: of a contact that slides, and of one that carries clamp(feq, -limit, limit). */
static inline struct tangent sliding_tangent(double v)
{
    return (struct tangent){0.0, 0.0, -sign(v)};
}

static inline struct tangent held_tangent(double feq, double limit)
{
    const int held = fabs(feq) < limit;
    return (struct tangent){0.0, held ? 1.0 : 0.0, held ? 0.0 : sign(feq)};
}

/* Defines <name>_force_all and <name>_tangent_all from the law's functions of one contact, <name>_force and <name>_tangent. */
#define TRIBO_LAW_LOOP(name, follows)                                                                                            \
    for (size_t i = 0; i < n; i++) {                                                                                             \
        f[i] = name##_force(v[i], feq[i], limit[i], tribo_epsilon(follows, width[i], bound[i]),                                  \
                            tribo_slope(follows, rate[i], bound[i]), moving[i]);                                                 \
    }

#define TRIBO_LAW_LOOPS(name)                                                                                                    \
    TRIBO_SIMD static void name##_force_all(const struct contacts *c, size_t n, const double *restrict v,                        \
                                            const double *restrict feq, double *restrict f)                                      \
    {                                                                                                                            \
        const double *limit = c->limit, *bound = c->bound, *width = c->width, *rate = c->rate;                                   \
        const unsigned char *moving = c->moving;                                                                                 \
        if (c->follows) {                                                                                                        \
            TRIBO_LAW_LOOP(name, 1)                                                                                              \
        } else {                                                                                                                 \
            TRIBO_LAW_LOOP(name, 0)                                                                                              \
        }                                                                                                                        \
    }                                                                                                                            \
    static void name##_tangent_all(const struct contacts *c, size_t n, const double *v, const double *feq, struct tangent *d)    \
    {                                                                                                                            \
        for (size_t i = 0; i < n; i++) {                                                                                         \
            d[i] = name##_tangent(v[i], feq[i], c->limit[i], tribo_epsilon_of(c, i), tribo_slope_of(c, i), c->moving[i],         \
                                  c->scales);                                                                                    \
        }                                                                                                                        \
    }

#endif
