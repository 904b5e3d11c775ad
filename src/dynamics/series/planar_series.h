/* SPDX-License-Identifier: BSD-3-Clause */
/* Taylor series of the forces of sliding planar contacts, found coefficient by coefficient with those of the motion.
 *
 * In units of its limits a contact has the velocity x = limit v, which is tau^s times a series, with s = 0 where it slides
 * already, and 1 or 2 where it begins to (stick_slip.h); and the direction u = x/|x|, which makes the force -limit u. Both are
 * taken along the first direction n and its normal t:
 *     |u| = 1   gives the n-part of each coefficient of u from those before,
 *     x = |x| u gives its t-part, if x is known; and the next one of |x|.
 * Where the contact begins to slide x follows from the acceleration, and so from the force itself: then t-parts, tau_k, solve
 *     (S + D_k) tau_k = acceleration along limit t without t-parts - terms of the coefficients before,
 * with S the response of such accelerations to t-parts while contacts at rest are held;
 * D_k = (k + 1)|x_0| for s = 1, and 0 for s = 2.
 * For s = 1 the series converges; for s = 2 it is asymptotic: as good as its last terms, which are what a step is chosen by.
 *
 * Or u is given, a polynomial, and only what follows from it is found (event_creep.h). */
#ifndef TRIBO_PLANAR_SERIES_H
#define TRIBO_PLANAR_SERIES_H

#include "dynamics/decide/stick_slip.h"

struct planar_line {
    double n[2], t[2];
    double *xn, *xt, *un, *ut; /* [order + 1] coefficients of x and u along n and t */
    double *speed;             /* [order + 1] coefficients of |x| */
    double *square; /* [2 order + 1] |x|^2/time^(2s); of a contact at rest half the larger limit times |force/limit|^2 */
};

struct planar_series {
    size_t order;
    size_t room;              /* for contacts */
    int given;                /* 1: un and ut are given, and all sliding contacts slide already */
    struct planar_line *line; /* [room] */
    double *work;             /* the series of all lines */
    size_t begins;            /* number of contacts that begin to slide */
    size_t begin_room;        /* for such contacts */
    size_t *begin;            /* [begins] these contacts */
    int *pivot;               /* [begins] */
    double *s, *lu;           /* [begins][begins] S, S + D */
    double *tau;              /* [begins] */
    double *answer;           /* [begins][ndof] q'' by unit t-parts */
    double *held;             /* [begins][ncontact] holding forces by unit t-parts */
};

void tribo_planar_series_free(struct planar_series *s);

/* The time in which friction would stop planar contact p; and the least such time of contacts that slide already, HUGE_VAL if
 * there is none. */
double tribo_planar_series_stop(const struct stick_slip *m, const tribo_system *sys, const struct planar_contact *p,
                                const double *y);
double tribo_planar_series_first_stop(const struct stick_slip *m, const tribo_system *sys, const double *y);

/* The value at h of a series x [powers + 1]. */
double tribo_planar_series_value(const double *x, size_t powers, double h);

/* Sets the order for a phase that begins with y, at most order; makes room; finds S for contacts that begin to slide. a, f
 * [ncontact]: workspace. Returns a status, its message on the system's context, as the functions below. */
int tribo_planar_series_begin(struct planar_series *s, size_t order, struct stick_slip *m, const tribo_system *sys,
                              const double *y, double *a, double *f);

/* Takes the k-th coefficients v [ncontact] of velocities; sets those of sliding forces f [ncontact], without the t-parts of
 * contacts that begin to slide. */
int tribo_planar_series_forces(struct planar_series *s, const struct stick_slip *m, const tribo_system *sys, size_t k,
                               const double *v, double *f);

/* Finds these t-parts, and adds their effect to the k-th coefficients of q'' (acc) and of holding forces. base [ncontact]:
 * that of accelerations of bases. */
int tribo_planar_series_finish(struct planar_series *s, const struct stick_slip *m, const tribo_system *sys, size_t k,
                               const double *base, double *acc, double *held);

/* The k-th coefficient of the power that planar contacts dissipate. */
double tribo_planar_series_power(const struct planar_series *s, const struct stick_slip *m, const tribo_system *sys, size_t k);

/* Sets square of all lines, with forces f [order + 1][ncontact] of contacts at rest. All terms count: those of the square are not
 * small where those of x end. */
void tribo_planar_series_squares(struct planar_series *s, const struct stick_slip *m, const double *f);

/* Sets error [ncontact] of velocities, besides that of the driver's tolerance. */
void tribo_planar_series_errors(const struct planar_series *s, const struct stick_slip *m, double *error);

/* Error of the velocities of contacts at h, by the difference between the series of u and x/|x|, in units of error or
 * plane->error, the smaller one. */
double tribo_planar_series_defect(const struct planar_series *s, const struct stick_slip *m, double h, double error);

#endif
