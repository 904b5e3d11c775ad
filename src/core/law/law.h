/* What a friction law is: a record in the registry, a force and its derivatives for one contact, and the loops over
 * contacts that the TRIBO_LAW macro makes of them. To add a law, write one file like quinn.c, and add its record to
 * registry.c and its number to tribo.h. */
#ifndef TRIBO_LAW_H
#define TRIBO_LAW_H

#include <math.h>
#include <stddef.h>

#include "../../common/real.h"
#include "../../common/simd.h"

/* Per contact: limit N; epsilon; slope = 2N/epsilon, kept apart so that nothing divides by N; moving, the reversal memory. */
struct contacts {
    const double *limit, *epsilon, *slope;
    const unsigned char *moving;
    double follows; /* 1: epsilon is proportional to the limit; 0: it does not depend on it */
};

struct tangent {
    double dv, dfeq, dlimit;
};

struct law {
    int id;
    const char *name, *reference;
    int uses_feq;
    int sticks_in_band; /* reads f_eq where |v| <= epsilon; otherwise where v = 0 */
    int relaxes;        /* inside the band f = clamp(f_eq) - slope v, otherwise clamp(f_eq) */
    int remembers;      /* uses the reversal memory */
    /* f_eq is finite, also where it does not matter, and TRIBO_FAR at most; v is any finite number */
    void (*force)(const struct contacts *c, size_t n, const double *v, const double *feq, double *f);
    void (*tangent)(const struct contacts *c, size_t n, const double *v, const double *feq, struct tangent *d);
};

extern const struct law tribo_law_coulomb, tribo_law_velocity_limited, tribo_law_smooth, tribo_law_karnopp, tribo_law_quinn,
    tribo_law_quinn_reversal;

const struct law *tribo_law(int id); /* NULL if there is none */

/* slope = 2 limit/epsilon */
static inline double tribo_slope(double limit, double epsilon)
{
    return 2.0 * quotient(limit, epsilon);
}

static inline double sign(double x)
{
    return (double)((x > 0.0) - (x < 0.0));
}

/* -limit sgn v, for v != 0. */
static inline double sliding(double v, double limit)
{
    return copysign(limit, -v);
}

/* Defines <name>_force_all and <name>_tangent_all from the law's functions of one contact, <name>_force and <name>_tangent. */
#define TRIBO_LAW_LOOPS(name)                                                                                                    \
    TRIBO_SIMD static void name##_force_all(const struct contacts *c, size_t n, const double *restrict v,                        \
                                            const double *restrict feq, double *restrict f)                                      \
    {                                                                                                                            \
        const double *restrict limit = c->limit, *restrict epsilon = c->epsilon, *restrict slope = c->slope;                     \
        const unsigned char *restrict moving = c->moving;                                                                        \
        for (size_t i = 0; i < n; i++) {                                                                                         \
            f[i] = name##_force(v[i], feq[i], limit[i], epsilon[i], slope[i], moving[i]);                                        \
        }                                                                                                                        \
    }                                                                                                                            \
    static void name##_tangent_all(const struct contacts *c, size_t n, const double *v, const double *feq, struct tangent *d)    \
    {                                                                                                                            \
        for (size_t i = 0; i < n; i++) {                                                                                         \
            d[i] = name##_tangent(v[i], feq[i], c->limit[i], c->epsilon[i], c->slope[i], c->moving[i], c->follows);              \
        }                                                                                                                        \
    }

#endif
