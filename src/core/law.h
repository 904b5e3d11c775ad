/* What a friction law is: a record in the registry, a force and its derivatives for one contact, and the loops over
 * contacts that the TRIBO_LAW macro makes of them. To add a law, write one file like law_quinn.c, and add its record to
 * laws.c and its number to tribo.h. */
#ifndef TRIBO_LAW_H
#define TRIBO_LAW_H

#include <math.h>
#include <stddef.h>

#include "../real.h"
#include "../simd.h"

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

static inline double sign(double x)
{
    return (double)((x > 0.0) - (x < 0.0));
}

/* -limit sgn v, for v != 0. */
static inline double sliding(double v, double limit)
{
    return copysign(limit, -v);
}

/* Defines force_all and tangent_all from the law's functions of one contact. */
#define TRIBO_LAW_LOOPS                                                                                                          \
    TRIBO_SIMD static void force_all(const struct contacts *c, size_t n, const double *restrict v, const double *restrict feq,   \
                                     double *restrict f)                                                                         \
    {                                                                                                                            \
        const double *restrict limit = c->limit, *restrict epsilon = c->epsilon, *restrict slope = c->slope;                     \
        const unsigned char *restrict moving = c->moving;                                                                        \
        for (size_t i = 0; i < n; i++) {                                                                                         \
            f[i] = force(v[i], feq[i], limit[i], epsilon[i], slope[i], moving[i]);                                               \
        }                                                                                                                        \
    }                                                                                                                            \
    static void tangent_all(const struct contacts *c, size_t n, const double *v, const double *feq, struct tangent *d)           \
    {                                                                                                                            \
        for (size_t i = 0; i < n; i++) {                                                                                         \
            d[i] = tangent(v[i], feq[i], c->limit[i], c->epsilon[i], c->slope[i], c->moving[i], c->follows);                     \
        }                                                                                                                        \
    }

#endif
