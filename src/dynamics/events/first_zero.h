/* The first of many functions to fall to zero. */
#ifndef TRIBO_FIRST_ZERO_H
#define TRIBO_FIRST_ZERO_H

#include "motion.h"
#include "quintic.h"

/* What a guard is of; the last one ends a step, and is no event. */
enum { HOLDS, SLIDES, SLOWS };

/* What must not fall below zero while a contact does what it does: side times its velocity (SLIDES), or what is left between
 * side times its force and the limit, or what presses it together, or keeps it apart (HOLDS), or its speed (SLOWS). */
struct guard {
    size_t contact;
    int kind; /* HOLDS, SLIDES or SLOWS */
    double side;
    void *output;      /* the motion's own */
    double offset;     /* the motion's own */
    double limit;      /* how many times the limit, as far as that is the motion's own, is in it */
    double size, bend; /* bounds, from where the search is on, of its parts together and of its sixth derivative */
    double allowance;  /* it begins at zero: so far below counts as zero until it has left zero, and then no more */
    double lowest;     /* below zero by this much at most, so far */
    struct sample left, right, middle; /* with the allowance added */
};

/* Guards, and the motion that they are about, which starts at time 0. */
struct first_zero {
    size_t guards;
    struct guard *guard;
    struct guard **watched;      /* [guards] workspace: those that may be below zero before the next one is known to be, */
    size_t watching;             /* their number; */
    size_t asked;                /* then the others that are looked at, up to this number; then those that are not, */
    double positive_until;       /* since they are known to be positive until then */
    const struct motion *motion; /* look, further, bound */
    void *own;                   /* the motion's */
    double expected;             /* when there may be a zero, for all that the caller knows; 0: no idea */
    double early;                /* by how much it may be earlier, as far as that is known */
    double reach;                /* over such times two derivatives tell all of every guard but rounding, */
    double far_reach;            /* and over such five */
    double resolution;           /* times closer than this are the same */
    size_t looks;
    double a;       /* nobody is below zero until then */
    double h, most; /* so much longer is to be tried, or up to most if a zero is expected there */
    double longest; /* the end of the search */
    double better;  /* when smaller bounds will be worth the work */
    int falls;      /* a guard is not positive where it was looked at last */
    int at_once;    /* a velocity falls to zero so soon after the start that derivatives there tell when */
    int lost;       /* there is no end of looks, or what they see is not finite */
};

/* The guard that is first to meet zero, and when; *first is NULL if none does before longest. Guards start at zero or above.
 * 1, or 0 if this takes too many looks, or guards are not finite. */
int tribo_first_zero(struct first_zero *s, double longest, const struct guard **first, double *when);

#endif
