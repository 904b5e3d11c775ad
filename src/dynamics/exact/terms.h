/* SPDX-License-Identifier: BSD-3-Clause */
/* The terms of a modal motion: exponentials and harmonics, with two derivatives. */
#ifndef TRIBO_MODAL_TERMS_H
#define TRIBO_MODAL_TERMS_H

#include "motion.h"

/* TRIBO_TERMS terms side by side: z at t0; w, w1 = w' and w2 = w'' at tau. */
struct lot {
    double zr[TRIBO_TERMS], zi[TRIBO_TERMS];
    double wr[TRIBO_TERMS], wi[TRIBO_TERMS], w1r[TRIBO_TERMS], w1i[TRIBO_TERMS], w2r[TRIBO_TERMS], w2i[TRIBO_TERMS];
};

/* A complex number; of a harmonic, cosine and sine. The functions return term p at t0, w of term p, and w' of term p. */
struct number {
    double re, im;
};

static inline struct number tribo_term_at_start(const struct modal_motion *x, size_t p)
{
    const struct lot *lot = &x->lot[p / TRIBO_TERMS];
    return (struct number){lot->zr[p % TRIBO_TERMS], lot->zi[p % TRIBO_TERMS]};
}

static inline struct number tribo_term(const struct modal_motion *x, size_t p)
{
    const struct lot *lot = &x->lot[p / TRIBO_TERMS];
    return (struct number){lot->wr[p % TRIBO_TERMS], lot->wi[p % TRIBO_TERMS]};
}

static inline struct number tribo_term_rate(const struct modal_motion *x, size_t p)
{
    const struct lot *lot = &x->lot[p / TRIBO_TERMS];
    return (struct number){lot->w1r[p % TRIBO_TERMS], lot->w1i[p % TRIBO_TERMS]};
}

static inline struct number tribo_harmonic_at_start(const struct modal_motion *x, size_t s)
{
    return tribo_term_at_start(x, x->h->exponents + s);
}

static inline struct number tribo_harmonic(const struct modal_motion *x, size_t s)
{
    return tribo_term(x, x->h->exponents + s);
}

static inline void tribo_term_begin(struct modal_motion *x, size_t p, double re, double im)
{
    struct lot *lot = &x->lot[p / TRIBO_TERMS];
    lot->zr[p % TRIBO_TERMS] = re;
    lot->zi[p % TRIBO_TERMS] = im;
}

/* Returns (e^z - 1)/z, the integral of e^{z s} over s from 0 to 1, without loss of digits for small z. */
double complex tribo_exp_1(double complex z);

/* Sets z, growth and growth6 of the last lot to 0, before terms are set: entries after the last term stay 0. */
void tribo_modal_terms_clear(struct modal_motion *x);

/* Set w, w' and w'': tribo_modal_terms_rest for t0; tribo_modal_terms_go for t0 + tau, without resonances. */
void tribo_modal_terms_rest(struct modal_motion *x);
void tribo_modal_terms_go(struct modal_motion *x, double tau);

#endif
