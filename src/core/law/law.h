/* What a friction law is: a record in the registry, a force and its derivatives for one contact, and the loops over
 * contacts that TRIBO_LAW_LOOPS makes of them. To add a law, write one file like quinn.c, and add its record to
 * registry.c and its number to tribo.h. */
#ifndef TRIBO_LAW_H
#define TRIBO_LAW_H

#include <float.h>
#include <math.h>
#include <stddef.h>

#include "common/real.h"
#include "common/simd.h"

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
    int alike;  /* limit, bound, width and rate of the first are those of all */
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
    return (struct contacts){c->limit + i,  c->bound + i, c->width + i, c->rate + i,
                             c->moving + i, c->follows,   c->scales,    c->alike};
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

/* The same of many contacts, and their forces. */
struct tangents {
    double *f, *dv, *dfeq, *dlimit;
};

struct law {
    int id;
    const char *name, *reference;
    int uses_feq;
    int sticks_in_band; /* reads f_eq where |v| <= epsilon; otherwise where v = 0 */
    int relaxes;        /* inside the band f = clamp(f_eq) - slope v, otherwise clamp(f_eq) */
    int remembers;      /* uses the reversal memory, and must be told of accepted steps */
    double holds;       /* a contact counts as stuck while |f| is less than this part of its limit */
    /* f_eq is finite, also where it does not matter, and TRIBO_FAR at most; v is any finite number. A law that does not use f_eq
     * gets numbers all the same. */
    void (*force)(const struct contacts *c, size_t n, const double *v, const double *feq, double *f);
    /* the same with the f_eq of contacts that share no body; a and 1/R_ii are TRIBO_PLAIN at most */
    void (*balance)(const struct contacts *c, size_t n, const double *v, const double *a, const double *inverse, double *f);
    void (*tangent)(const struct contacts *c, size_t n, const double *v, const double *feq, const struct tangents *d);
    double (*force_of_one)(const struct contacts *c, double v, double feq); /* the force of the first */
};

extern const struct law tribo_law_coulomb, tribo_law_velocity_limited, tribo_law_smooth, tribo_law_karnopp, tribo_law_quinn,
    tribo_law_quinn_reversal;

const struct law *tribo_law(int id); /* NULL if there is none */

/* f_eq of a contact that shares no body, from 1/R_ii: a product takes a tenth of the time of a division. Where that might be no
 * number, tribo_alone_far is for it; where both are numbers they have the same bits. */
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

/* v where |v| <= epsilon, and elsewhere what makes no product overflow: laws reckon with it for all contacts before they
 * choose. */
static inline double inside_band(double v, double epsilon)
{
    return clamp(v, -epsilon, epsilon);
}

/* -limit sgn v, for v != 0. */
static inline double sliding(double v, double limit)
{
    return copysign(limit, -v);
}

/* How the force follows the limit where a contact slides, and where it carries clamp(feq, -limit, limit). These and the laws
 * choose between numbers that are there already, which is what makes loops of them fast. */
static inline double sliding_rate(double v)
{
    return copysign(1.0, -v);
}

static inline double held_rate(double feq, int held)
{
    return held ? 0.0 : sign(feq);
}

/* Defines <name>_force_all, <name>_balance_all, <name>_tangent_all and <name>_force_of_one from the law's functions of one
 * contact, <name>_force and <name>_tangent. */
#define TRIBO_FORCE_EACH(name, limit, epsilon, slope, rate)                                                                      \
    for (size_t i = 0; i < n; i++) {                                                                                             \
        f[i] = name##_force(v[i], feq[i], limit, epsilon, slope);                                                                \
    }

#define TRIBO_BALANCE_EACH(name, limit, epsilon, slope, rate)                                                                    \
    for (size_t i = 0; i < n; i++) {                                                                                             \
        f[i] = name##_force(v[i], tribo_alone(a[i], inverse[i]), limit, epsilon, slope);                                         \
    }

#define TRIBO_TANGENT_EACH(name, limit, epsilon, slope, rate)                                                                    \
    for (size_t i = 0; i < n; i++) {                                                                                             \
        const struct tangent d = name##_tangent(v[i], feq[i], limit, epsilon, slope, stays * (rate), scales);                    \
        f[i] = name##_force(v[i], feq[i], limit, epsilon, slope);                                                                \
        dv[i] = d.dv;                                                                                                            \
        dfeq[i] = d.dfeq;                                                                                                        \
        dlimit[i] = d.dlimit;                                                                                                    \
    }

/* What is the same for all contacts is read once, and whether epsilon follows the limit is asked once. */
#define TRIBO_LAW_LOOP(each, name)                                                                                               \
    const double *limit = c->limit, *bound = c->bound, *width = c->width, *rate = c->rate;                                       \
    if (c->alike) {                                                                                                              \
        const double one = *limit, epsilon = tribo_epsilon_of(c, 0), slope = tribo_slope_of(c, 0);                               \
        each(name, one, epsilon, slope, *rate)                                                                                   \
    } else if (c->follows) {                                                                                                     \
        each(name, limit[i], tribo_epsilon(1, width[i], bound[i]), tribo_slope(1, rate[i], bound[i]), rate[i])                   \
    } else {                                                                                                                     \
        each(name, limit[i], tribo_epsilon(0, width[i], bound[i]), tribo_slope(0, rate[i], bound[i]), rate[i])                   \
    }

#define TRIBO_LAW_LOOPS(name)                                                                                                    \
    static double name##_force_of_one(const struct contacts *c, double v, double feq)                                            \
    {                                                                                                                            \
        return name##_force(v, feq, *c->limit, tribo_epsilon_of(c, 0), tribo_slope_of(c, 0));                                    \
    }                                                                                                                            \
    TRIBO_SIMD static void name##_force_all(const struct contacts *c, size_t n, const double *restrict v,                        \
                                            const double *restrict feq, double *restrict f)                                      \
    {                                                                                                                            \
        TRIBO_LAW_LOOP(TRIBO_FORCE_EACH, name);                                                                                  \
    }                                                                                                                            \
    TRIBO_SIMD static void name##_balance_all(const struct contacts *c, size_t n, const double *restrict v,                      \
                                              const double *restrict a, const double *restrict inverse, double *restrict f)      \
    {                                                                                                                            \
        TRIBO_LAW_LOOP(TRIBO_BALANCE_EACH, name);                                                                                \
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
