/* Taylor series of the forces of planar contacts that slide, coefficient by coefficient beside those of the motion.
 *
 * In units of its limits a contact has the velocity x = limit v, which is tau^s times a series, with s = 0 where it slides
 * already, and 1 or 2 where it begins to (planar_slip.h); and the direction u = x/|x|, which makes the force -limit u. Both are
 * taken along the first direction n and its normal t:
 *     |u| = 1   gives the n-part of each coefficient of u from those before,
 *     x = |x| u gives its t-part, if x is known; and the next one of |x|.
 * Where the contact begins to slide x follows from the acceleration, and so from the force itself: then t-parts, tau_k, solve
 *     (S + D_k) tau_k = acceleration along limit t without them - what those before ask for
 * with S what t-parts do to such accelerations while contacts at rest are held; D_k = (k + 1)|x_0| for s = 1, and 0 for s = 2.
 * For s = 1 the series converges; for s = 2 it is asymptotic: as good as its last terms, which are what a step is chosen by.
 *
 * Or u is given, a polynomial, and only what follows from it is found (event_creep.h). */
#ifndef TRIBO_PLANAR_SERIES_H
#define TRIBO_PLANAR_SERIES_H

#include "dynamics/decide/stick_slip.h"

struct planar_line {
    double n[2], t[2];
    double *xn, *xt, *un, *ut, *speed; /* [order + 1] coefficients; speed: of |x| */
    double size, bend;                 /* bounds of the square, and of its sixth derivative */
};

struct planar_series {
    size_t order, room;       /* so many contacts there is room for, */
    int given;                /* un and ut of those that slide, who all do so already, are given */
    struct planar_line *line; /* [room] */
    double *work;
    double *square;            /* [2 order + 1][room] coefficients */
    size_t begins, begin_room; /* contacts that begin to slide, */
    size_t *begin;             /* [begins] which; and room for */
    int *pivot;                /* [begins] */
    double *s, *lu, *tau;      /* [begins][begins] S, S + D, [begins] */
    double *answer, *held;     /* [begins][ndof], [ncontact] what t-parts do to q'', and to the forces of contacts that hold */
};

void tribo_planar_series_free(struct planar_series *s);

/* The time in which friction would stop the planar contact p; and the least one of those that slide already, HUGE_VAL if there
 * is none. */
double tribo_planar_series_stop(const struct stick_slip *m, const tribo_system *sys, const struct planar_contact *p,
                                const double *y);
double tribo_planar_series_first_stop(const struct stick_slip *m, const tribo_system *sys, const double *y);

/* The value at h of a series x [powers + 1]. */
double tribo_planar_series_value(const double *x, size_t powers, double h);

/* Sets the order for a phase that begins with y, order at most; makes room, and S for contacts that begin to slide. a, f
 * [ncontact] workspace. Returns a status, its message on the system's context, and so below. */
int tribo_planar_series_begin(struct planar_series *s, size_t order, struct stick_slip *m, const tribo_system *sys,
                              const double *y, double *a, double *f);

/* Takes the k-th coefficients v [ncontact] of velocities, and sets those of the forces f [ncontact] of contacts that slide, but
 * for the t-parts of such that begin to. */
int tribo_planar_series_forces(struct planar_series *s, const struct stick_slip *m, const tribo_system *sys, size_t k,
                               const double *v, double *f);

/* Finds these, and adds what they do to the k-th coefficients of q'' (acc) and of forces that hold. base [ncontact] is that of
 * accelerations of bases. */
int tribo_planar_series_finish(struct planar_series *s, const struct stick_slip *m, const tribo_system *sys, size_t k,
                               const double *base, double *acc, double *held);

/* The k-th coefficient of the power that contacts take. */
double tribo_planar_series_power(const struct planar_series *s, const struct stick_slip *m, const tribo_system *sys, size_t k);

/* For guards over [0, h]: squares of |x|, but for tau^2s, or half the larger limit times |force/limit|^2 of contacts at rest,
 * whose forces are f [order + 1][ncontact]. All terms count: those of x, or force, end where their squares' are not small yet. */
void tribo_planar_series_squares(struct planar_series *s, const struct stick_slip *m, const double *f, double h);

/* The errors that velocities of contacts may have, [ncontact], besides that of the driver's tolerance. */
void tribo_planar_series_errors(const struct planar_series *s, const struct stick_slip *m, double *error);

/* By how much, at h, the velocities of contacts may be off, as the series of forces differ from what those of velocities ask for:
 * in parts of error, and of m->plane->error. */
double tribo_planar_series_defect(const struct planar_series *s, const struct stick_slip *m, double h, double error);

#endif
