/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves of periodic motions over a parameter p: z = (x, unknowns, p), unknowns: the period of cycles, and delta of modes. */
#ifndef TRIBO_CURVE_H
#define TRIBO_CURVE_H

#include "shooting.h"

/* The sequence of events of a period: slip of contacts and states of normals in each phase, phases that are alike in one. */
struct word {
    size_t letters, width;
    signed char *letter; /* [letters][width] */
};

/* w = the sequence of the motion of p. width: contacts and normals. Returns 1, or 0 if out of memory. Call tribo_word_free also
 * after a failure. */
int tribo_word_read(struct word *w, const struct point *p, size_t width);
void tribo_word_free(struct word *w);

/* Returns 1 if the sequences are equal, wherever their periods begin. */
int tribo_word_equal(const struct word *a, const struct word *b);

/* Returns 1 if the phases of two motions from one time on have the same slip and states of normals, one after the other. */
int tribo_word_same(const struct derivative *a, const struct derivative *b, size_t width);

/* Returns the change of the sequence from `from` to `to`: TRIBO_POINT_STICK, _SLIDE, _GRAZE or _ORDER. *contact = the lowest
 * index i at which the sequences of slip or state i alone differ, i >= contacts: normal i - contacts; SIZE_MAX if the change is
 * TRIBO_POINT_ORDER: the sequences of all contacts and normals alone are equal. */
int tribo_word_change(const struct word *from, const struct word *to, size_t contacts, size_t *contact);

/* A motion of the curve; its arrays follow each other, from z on. */
struct knot {
    double *z;       /* [n + count] x, unknowns and p in their own units */
    double *tangent; /* [n + count] along the curve, of length 1 with unknowns over units of the curve */
    double *rate;    /* [n] direction of x', of cycles */
    double *re, *im; /* [all] multipliers, the largest first; without the `trivial` ones nearest to 1 */
    size_t trivial;  /* of the family, and along a cycle */
    int outside;     /* number of multipliers outside of the unit circle; -1: not known */
    struct word word;
};

enum { TRIBO_KNOTS = 13 };

struct track {
    const tribo_curve *ask;
    struct shooting *owner, *s; /* of the caller's driver; of its twin */
    const tribo_system *like;   /* the caller's system */
    struct wanted *w;
    struct mode mode;       /* of modes */
    struct border base;     /* unknowns beside x and p */
    size_t n, count, width; /* count: unknowns and p */
    double t, period;       /* of the first motion */
    double *limit, *put;    /* [ncontact] limits of the first motion; workspace */
    double unit[TRIBO_UNKNOWNS];
    const double *origin, *row; /* the section row'(z - origin) = ahead, over units */
    double ahead;
    int unique; /* 1: one motion for each p: sections of constant p */
    /* 0, 1: ends of a step; 2 to 8: to locate points; 9, 10: ends of a piece; 11, 12: the last ones */
    struct knot knot[TRIBO_KNOTS]; /* knot[0].z owns the memory of all arrays */
    size_t values;                 /* numbers in the arrays of a knot */
    size_t known;                  /* number of last motions for a polynomial: the end of the step, and those of knot[11], [12] */
    double *guess, *beyond;        /* [n + count] a guess; a tangent */
    double *shown;                 /* [dimension] state of the last point, as the caller has it */
    int (*seen)(const tribo_curve_point *point, void *data);
    void *data;
    size_t points;          /* seen so far */
    size_t halves, counted; /* half periods before the last search of the whole; those of the map that its driver has counted */
};

/* curve_parameter.c. begin: finds the first motion, s->here of the twin. set: sets system, t and period of the twin for p =
 * value. Both return a status, its message on the driver of owner (begin), or of the twin (set). border: that of a section; its
 * user sets unit, and the count: number of unknowns and p, or 0 where motions are unique. */
int tribo_curve_begin(struct track *c);
int tribo_curve_set(struct track *c, double value);
extern const struct border tribo_curve_border;

/* Returns the value of the parameter of the caller's system. */
double tribo_curve_first(const struct track *c);

#endif
