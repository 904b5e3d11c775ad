/* Static limits above the limits to slide (tribo_set_static), for methods with events. A contact at rest holds up to its static
 * limit; one that cannot breaks away: its bound is the limit to slide, and all contacts are decided about again. A limit that
 * falls with the speed (Stribeck) is
 *     N(|v|) = limit + (ratio - 1) limit exp(-|v|/velocity),
 * whose last part is smooth while the contact slides, and belongs to the equations of its motion. */
#ifndef TRIBO_BREAKAWAY_H
#define TRIBO_BREAKAWAY_H

#include "dynamics/system/system.h"
#include "common/real.h"

struct breakaway {
    int some;             /* 1: there are static limits */
    int falls;            /* 1: with velocities by which they fall */
    double *ratio;        /* [ncontact] static limit over the limit at high speed */
    double *velocity;     /* [ncontact] */
    double *kinetic;      /* [ncontact] limit at high speed */
    double *kinetic_rate; /* [ncontact] its rate */
    double *stick;        /* [ncontact] limit at rest */
    double *stick_rate;   /* [ncontact] its rate */
    double steepest;      /* bound of the growth rate of perturbations by limits that fall */
    size_t revision;      /* of the system that steepest is of; SIZE_MAX: none */
};

/* Takes ratio and velocity from the system's context; finds steepest. dof [ndof], contact [ncontact]: workspace. */
void tribo_breakaway_start(struct breakaway *b, tribo_system *sys, double *dof, double *contact);

/* Takes limits at high speed, 0 for open contacts, and their rates; both [contacts]. */
void tribo_breakaway_take(struct breakaway *b, size_t contacts, const double *limit, const double *limit_rate);

/* Sets stick, and limit [contacts] of contacts with this slip and v, and their rates without the part of v'. */
void tribo_breakaway_limits(struct breakaway *b, size_t contacts, const signed char *slip, const double *v, double *limit,
                            double *limit_rate);

/* dN/d|v| of contact i. */
double tribo_breakaway_slope(const struct breakaway *b, size_t i, double v);

/* Static limit of contact i over its limit at high speed. */
static inline double tribo_breakaway_ratio(const struct breakaway *b, size_t i)
{
    return b->some ? b->ratio[i] : 1.0;
}

/* The static limit of contact i. */
static inline double tribo_breakaway_most(const struct breakaway *b, size_t i)
{
    return product(b->ratio[i], b->kinetic[i]);
}

/* 1 if the limit of contact i drops as it breaks away, which must be certain then. */
static inline int tribo_breakaway_is_sudden(const struct breakaway *b, size_t i)
{
    return b->some && b->stick[i] > b->kinetic[i];
}

/* Lowers stick to the limit to slide. Returns 0 if limits fall with the speed, or stick is not above that. */
int tribo_breakaway_lets_go(struct breakaway *b, size_t i);

/* Sets stick to the static limit again. Returns 1 if it was lower: the contact broke away, and others hold it after all. */
int tribo_breakaway_restore(struct breakaway *b, size_t i);

/* Coefficient k of exp(-|v|/velocity) in powers of time, from those before in part and from v [k + 1] = side |v|; both stride
 * doubles apart. */
double tribo_breakaway_part(const struct breakaway *b, size_t i, int side, size_t k, size_t stride, const double *v,
                            const double *part);

/* Coefficient k of N(|v|), from those of the limit at high speed, limit [terms], and from part [k + 1]. */
double tribo_breakaway_series(const struct breakaway *b, size_t i, size_t k, size_t stride, size_t terms, const double *limit,
                              const double *part);

#endif
