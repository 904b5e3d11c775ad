/* What tries single steps of y' = f(t, y), and how steppers.c makes a motion of them. */
#ifndef TRIBO_STEPPER_H
#define TRIBO_STEPPER_H

#include "system.h"

/* A step to be tried, and what came of it; all arrays [dimension]. */
struct step {
    double t, h;
    const double *y, *slope; /* where it begins, and f there */
    const double *tolerance; /* of y */
    double *to, *error;      /* where it ends, and how far that may be off */
    double *end;             /* f there, */
    int ends;                /* if it is known */
};

/* A way to make steps. What create returns is handed to the others; NULL if out of memory. */
struct stepper {
    void *(*create)(const struct stepper *kind, size_t dimension);
    void (*destroy)(void *own);
    void (*restart)(void *own);                                   /* what it remembers is about another motion */
    int (*attempt)(void *own, tribo_system *sys, struct step *s); /* a GSL status; anything but GSL_EBADFUNC: try a shorter one */
    /* How many times longer the next step may be, size being the largest error in terms of the tolerance. accept: s has been
     * accepted. */
    double (*accept)(void *own, const struct step *s, double size);
    double (*reject)(void *own, double size);
    double stable;    /* what decays at a rate goes on decaying in steps of this over the rate; HUGE_VAL: in any */
    const void *with; /* its own */
};

/* The usual rule, for errors that go with the order-th power of the step. */
double tribo_stepper_growth(double size, double order);

/* runge_kutta.c, bdf.c */
extern const struct stepper tribo_stepper_rk2, tribo_stepper_rk4, tribo_stepper_rkf45, tribo_stepper_rkck, tribo_stepper_rk8pd,
    tribo_stepper_rk1imp, tribo_stepper_rk2imp, tribo_stepper_rk4imp, tribo_stepper_msbdf;

/* The classical Runge-Kutta method without estimate of an error: s->to, in four evaluations but for the one that makes s->slope.
 * work [4][dimension]. */
int tribo_rk4_step(tribo_system *sys, struct step *s, double *work);

#endif
