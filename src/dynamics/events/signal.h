/* SPDX-License-Identifier: BSD-3-Clause */
/* A linear combination of the state in a phase, in closed form: Re(sum c_p e^{lambda_p s}) + sum a_j s^j, 0 <= s <= tau. */
#ifndef TRIBO_SIGNAL_H
#define TRIBO_SIGNAL_H

#include "common/imaginary.h"

#include <stddef.h>

struct signal {
    size_t terms, degree;
    size_t room[2];             /* for terms, and for degrees */
    double complex *c, *lambda; /* [terms] */
    double complex *grown;      /* [terms] workspace of tribo_signal_product */
    double *a;                  /* [degree + 1] */
    double tau;
};

/* Makes room for terms, and sets terms = 0 and a = 0 up to degree. Returns 0 if out of memory. */
int tribo_signal_reserve(struct signal *s, size_t terms, size_t degree);
void tribo_signal_free(struct signal *s);

void tribo_signal_add(struct signal *s, double complex c, double complex lambda);

/* to[4] = the value and its first three derivatives. */
void tribo_signal_at(const struct signal *s, double at, double *to);

/* Least and largest value of a signal in pieces, and their times. */
struct extremes {
    double least, most, at_least, at_most;
};

/* Updates *e by a piece that begins at t. Returns 0 if the piece is too fast to be followed. */
int tribo_signal_extremes(const struct signal *s, double t, struct extremes *e);

/* *re + i *im += integral of the signal times e^{-i omega s} over [0, tau]. */
void tribo_signal_integrate(const struct signal *s, double omega, double *re, double *im);

/* Returns the integral of s[0] s[1] over [0, tau], tau of s[0]. */
double tribo_signal_product(struct signal *s);

#endif
