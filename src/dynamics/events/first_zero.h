/* SPDX-License-Identifier: BSD-3-Clause */
/* The first of many functions to fall to zero. */
#ifndef TRIBO_FIRST_ZERO_H
#define TRIBO_FIRST_ZERO_H

#include "motion.h"
#include "quintic.h"

/* Kinds of guards: force or limit; velocity; speed of a planar contact, which ends a step and is no event. */
enum { HOLDS, SLIDES, SLOWS };

/* A function that is not below zero while a contact keeps its slip: offset + side output + limit times the motion's part of the
 * limit, in time from the start of the phase. */
struct guard {
    size_t contact;
    int kind;             /* HOLDS, SLIDES or SLOWS */
    double side;          /* 1 or -1; 0: no output */
    void *output;         /* velocity or force of the contact, in the motion's terms */
    double offset;        /* constant */
    double limit;         /* factor of the motion's part of the limit; 0: none */
    double size;          /* bound of the sum of the sizes of its terms, from the last bound on */
    double bend;          /* bound of its sixth derivative, likewise */
    double noise;         /* rounding of its values, by size */
    double allowance;     /* values down to -allowance count as zero until the guard has left zero */
    double lowest;        /* bound of its negative values so far */
    struct sample left;   /* at a, with the allowance added */
    struct sample middle; /* at the last look */
    struct sample right;  /* at the end of the interval */
};

/* The search, from time 0 on. */
struct first_zero {
    size_t guards;
    struct guard *guard;         /* [guards] */
    struct guard **watched;      /* [guards] first the guards that are sampled */
    size_t watching;             /* number of guards that are sampled */
    const struct motion *motion; /* look, bound */
    void *own;                   /* the motion's */
    double expected;             /* time of an expected zero; 0: unknown */
    double resolution;           /* times closer than this are the same */
    size_t looks;
    double a;       /* no guard is below zero until a */
    double h;       /* length of the next interval */
    double length;  /* length of an interval by the last bounds */
    double longest; /* end of the search */
    double better;  /* time from which smaller bounds are worth finding */
    int at_once;    /* 1: the zero is in reach of derivatives at the start */
    int lost;       /* 1: too many looks, or samples that are not finite */
};

/* Finds *first, the guard that is first to be zero, and *when; NULL if none is before longest. Guards start at zero or above.
 * Returns 0 if this takes too many looks, or guards are not finite. */
int tribo_first_zero(struct first_zero *s, double longest, const struct guard **first, double *when);

#endif
