/* Static friction above kinetic, for the event-located drivers (tribo_set_static). A contact that holds does so up to its static
 * limit. One that cannot breaks away: it has the limit by which it slides from there on, and all are decided about again. Where
 * limits fall with the speed (Stribeck), the law is
 *     N(|v|) sgn v = limit sgn v + (ratio - 1) limit exp(-|v|/velocity) sgn v,
 * of which the last part is smooth while the contact slides, and belongs to the equations of its motion. */
#ifndef TRIBO_BREAKAWAY_H
#define TRIBO_BREAKAWAY_H

#include "dynamics/system/system.h"
#include "common/real.h"

struct breakaway {
    int some, falls;                /* there are static limits; with velocities by which they fall */
    double *ratio, *velocity;       /* [ncontact] */
    double *kinetic, *kinetic_rate; /* [ncontact] limit at high speed, and its rate */
    double *stick, *stick_rate;     /* [ncontact] room for static limits */
    size_t revision;                /* of the system, that steepest is of */
    double steepest;                /* no faster does falling friction make anything grow */
};

/* 1, or 0 if out of memory. tribo_breakaway_free takes what failed too. */
int tribo_breakaway_create(struct breakaway *b, size_t contacts);
void tribo_breakaway_free(struct breakaway *b);

/* Takes the static limits of the system's context. dof, contact: workspace. */
void tribo_breakaway_start(struct breakaway *b, tribo_system *sys, double *dof, double *contact);

/* Takes limits at high speed, 0 where contacts are open, and their rates; both [contacts]. */
void tribo_breakaway_take(struct breakaway *b, size_t contacts, const double *limit, const double *limit_rate);

/* What follows from them: stick, and limit [contacts] of contacts with this slip and v; and their rates, but for what v adds. */
void tribo_breakaway_limits(struct breakaway *b, size_t contacts, const signed char *slip, const double *v, double *limit,
                            double *limit_rate);

/* dN/d|v| of contact i. */
double tribo_breakaway_slope(const struct breakaway *b, size_t i, double v);

/* How many times its limit to slide the limit to stick of contact i is. */
static inline double tribo_breakaway_ratio(const struct breakaway *b, size_t i)
{
    return b->some ? b->ratio[i] : 1.0;
}

/* The static limit of contact i. */
static inline double tribo_breakaway_most(const struct breakaway *b, size_t i)
{
    return product(b->ratio[i], b->kinetic[i]);
}

/* Whether contact i, at rest, would let go of more than rounding by breaking away: then that must be certain. */
static inline int tribo_breakaway_is_sudden(const struct breakaway *b, size_t i)
{
    return b->some && b->stick[i] > b->kinetic[i];
}

/* The contact holds no more by its static limit; 0 if it has none, or does not already. */
int tribo_breakaway_lets_go(struct breakaway *b, size_t i);

/* It holds by its static limit again; 1 if it did not: it broke away, and the others hold it after all. */
int tribo_breakaway_restore(struct breakaway *b, size_t i);

/* Coefficients of powers of time, each stride doubles apart: the next one, the k-th, of exp(-|v|/velocity), from the others and v
 * [k + 1], which is side |v|; */
double tribo_breakaway_part(const struct breakaway *b, size_t i, int side, size_t k, size_t stride, const double *v,
                            const double *part);

/* and the k-th of N(|v|), from those of the limit at high speed (limit [terms], the others are 0) and part [k + 1]. */
double tribo_breakaway_series(const struct breakaway *b, size_t i, size_t k, size_t stride, size_t terms, const double *limit,
                              const double *part);

#endif
