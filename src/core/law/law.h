/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction laws. A law is a force of one contact, its derivatives, the loops over contacts that TRIBO_LAW_LOOPS makes of both,
 * and a record. To add a law, write one file like quinn.c; add its record to registry.c and its number to tribo.h. */
#ifndef TRIBO_LAW_H
#define TRIBO_LAW_H

#include <float.h>
#include <math.h>
#include <stddef.h>

#include "common/real.h"
#include "common/simd.h"

/* Contacts as laws see them, an array each. A law finds epsilon, and slope = 2 limit/epsilon, from width and rate, which stay
 * when limits change:
 *   epsilon does not follow the limit:  epsilon = width,        slope = rate bound,  rate = 2/epsilon
 *   it follows the limit:               epsilon = width bound,  slope = rate,        rate = 2/width, or 0 where nothing
 * relaxes */
struct contacts {
    const double *limit;
    const double *bound; /* the limit, or less where products with width or rate would overflow */
    const double *width, *rate;
    const unsigned char *moving; /* reversal memory */
    int follows;
    int scales;                  /* epsilon follows the caller's limit, also where it is in width (static limits) */
    int alike;                   /* all have the first limit, bound, width and rate */
    size_t first;                /* number of the first contact */
    const struct user_law *user; /* of the caller's law; NULL: contacts of no context */
};

/* The caller's law, see tribo_set_user_law. */
struct user_law {
    int (*law)(size_t first, size_t n, int derivatives, const double *v, const double *limit, const double *epsilon, double *box,
               void *data);
    void *data;
};

/* Returns rate for a given epsilon. */
static inline double tribo_rate(double epsilon)
{
    return 2.0 * quotient(1.0, epsilon);
}

/* c from contact i on. */
static inline struct contacts tribo_contacts_from(const struct contacts *c, size_t i)
{
    const size_t own = c->alike ? 0 : i;
    return (struct contacts){c->limit + own, c->bound + own, c->width + own, c->rate + own, c->moving + i,
                             c->follows,     c->scales,      c->alike,       c->first + i,  c->user};
}

/* epsilon and slope of contact i. Factors are chosen, since a product that is not needed might overflow. */
static inline double tribo_epsilon_of(const struct contacts *c, size_t i)
{
    return greater(c->width[i] * (c->follows ? c->bound[i] : 1.0), c->follows ? DBL_MIN : 0.0);
}

static inline double tribo_slope_of(const struct contacts *c, size_t i)
{
    return c->rate[i] * (!c->follows ? c->bound[i] : c->bound[i] > 0.0 ? 1.0 : 0.0);
}

/* Derivatives of a force. */
struct tangent {
    double dv, dfeq, dlimit;
};

/* Forces and derivatives of many contacts. */
struct tangents {
    double *f, *dv, *dfeq, *dlimit;
};

struct law {
    int id;
    const char *name, *reference;
    int uses_feq;
    int sticks_in_band; /* reads f_eq where |v| <= epsilon; else where v = 0 */
    int relaxes;        /* near stick f = clamp(f_eq) - slope v; else clamp(f_eq) */
    int remembers;      /* uses the reversal memory, which tribo_accept updates */
    double holds;       /* a contact is stuck if |f| < holds limit */
    /* f [n]; v is finite, and |feq| <= TRIBO_FAR, also where the law does not use it */
    void (*force)(const struct contacts *c, size_t n, const double *v, const double *feq, double *f);
    void (*tangent)(const struct contacts *c, size_t n, const double *v, const double *feq, const struct tangents *d);
};

extern const struct law tribo_law_coulomb, tribo_law_velocity_limited, tribo_law_smooth, tribo_law_karnopp, tribo_law_quinn,
    tribo_law_quinn_reversal;
extern const struct law tribo_law_own; /* own.c; it has no number of the registry */

/* Returns the law of this number, or NULL. */
const struct law *tribo_law(int id);

/* f_eq of a contact that shares no body, from 1/R_ii: a product takes a tenth of the time of a division. tribo_alone_far never
 * overflows, and has the same bits where tribo_alone does not. */
#define TRIBO_PLAIN 1e100
static inline double tribo_alone(double a, double inverse)
{
    return -a * inverse;
}

static inline double tribo_alone_far(double a, double inverse)
{
    return scaled(-a, inverse);
}

static inline double sign(double x)
{
    return x != 0.0 ? copysign(1.0, x) : 0.0;
}

/* v within the band: laws compute with it for all contacts before they choose, and no product overflows. */
static inline double inside_band(double v, double epsilon)
{
    return clamp(v, -epsilon, epsilon);
}

/* -limit sgn v, for v != 0. */
static inline double sliding(double v, double limit)
{
    return copysign(limit, -v);
}

/* d(force)/d(limit) where a contact carries clamp(feq, -limit, limit). Laws choose between numbers, not between computations:
 * their loops become vectors. */
static inline double held_rate(double feq, int held)
{
    return held ? 0.0 : sign(feq);
}

/* Derivatives of a law that slides with its limit, or carries clamp(feq, -limit, limit). */
static inline struct tangent dry_tangent(int slides, double v, double feq, double limit)
{
    const int held = fabs(feq) < limit;
    const double gain = held ? 1.0 : 0.0, rate = held_rate(feq, held);
    return (struct tangent){0.0, slides ? 0.0 : gain, slides ? sliding(v, 1.0) : rate};
}

/* The calls in the record of a law. */
#define TRIBO_LAW_CALLS(name) .force = name##_force_all, .tangent = name##_tangent_all

/* Defines <name>_force_all and <name>_tangent_all from the law's functions of one contact, <name>_force and
 * <name>_tangent. */
#define TRIBO_FORCE_EACH(name, limit, epsilon, slope, rate)                                                                      \
    for (size_t i = 0; i < n; i++) {                                                                                             \
        f[i] = name##_force(v[i], feq[i], limit, epsilon, slope);                                                                \
    }

#define TRIBO_TANGENT_EACH(name, limit, epsilon, slope, rate)                                                                    \
    for (size_t i = 0; i < n; i++) {                                                                                             \
        const struct tangent d = name##_tangent(v[i], feq[i], limit, epsilon, slope, stays * (rate), scales);                    \
        f[i] = name##_force(v[i], feq[i], limit, epsilon, slope);                                                                \
        dv[i] = d.dv;                                                                                                            \
        dfeq[i] = d.dfeq;                                                                                                        \
        dlimit[i] = d.dlimit;                                                                                                    \
    }

/* Reads once what is the same for all contacts; checks once if epsilon follows the limit. */
#define TRIBO_LAW_LOOP(each, name)                                                                                               \
    const double *limit = c->limit, *bound = c->bound, *width = c->width, *rate = c->rate;                                       \
    if (c->alike) {                                                                                                              \
        const double one = *limit, epsilon = tribo_epsilon_of(c, 0), slope = tribo_slope_of(c, 0);                               \
        each(name, one, epsilon, slope, *rate)                                                                                   \
    } else if (c->follows) {                                                                                                     \
        each(name, limit[i], greater(width[i] * bound[i], DBL_MIN), (bound[i] > 0.0 ? rate[i] : 0.0), rate[i])                   \
    } else {                                                                                                                     \
        each(name, limit[i], width[i], rate[i] * bound[i], rate[i])                                                              \
    }

#define TRIBO_LAW_LOOPS(name)                                                                                                    \
    TRIBO_SIMD static void name##_force_all(const struct contacts *c, size_t n, const double *restrict v,                        \
                                            const double *restrict feq, double *restrict f)                                      \
    {                                                                                                                            \
        TRIBO_LAW_LOOP(TRIBO_FORCE_EACH, name);                                                                                  \
    }                                                                                                                            \
    TRIBO_SIMD static void name##_tangent_to(const struct contacts *c, size_t n, const double *restrict v,                       \
                                             const double *restrict feq, double *restrict f, double *restrict dv,                \
                                             double *restrict dfeq, double *restrict dlimit)                                     \
    {                                                                                                                            \
        const double scales = c->scales, stays = 1.0 - scales;                                                                   \
        TRIBO_LAW_LOOP(TRIBO_TANGENT_EACH, name);                                                                                \
    }                                                                                                                            \
    static void name##_tangent_all(const struct contacts *c, size_t n, const double *v, const double *feq,                       \
                                   const struct tangents *d)                                                                     \
    {                                                                                                                            \
        name##_tangent_to(c, n, v, feq, d->f, d->dv, d->dfeq, d->dlimit);                                                        \
    }

#endif
