/* SPDX-License-Identifier: BSD-3-Clause */
/* Motion of a structure with contacts held, from a state on, in closed form: a phase of method "exact". */
#ifndef TRIBO_MODAL_MOTION_H
#define TRIBO_MODAL_MOTION_H

#include "modal.h"
#include "dynamics/events/quintic.h"
#include "dynamics/decide/stick_slip.h"
#include "dynamics/events/signal.h"

/* The linear part of an output, start + ramp tau. */
struct line {
    double start, ramp;
};

/* An output in a phase. */
struct course {
    const struct output *output;
    struct line line;
    double size, bend; /* bounds of |output| and of the sixth derivative */
    double tau;        /* time of the last look */
    struct sample at;  /* output at tau, with two derivatives */
};

/* A phase from t0. A mode: eta = constant + vel tau + acc tau^2/2 + harmonics + (Re(r z), or drift_rate tau if the mode
 * drifts). A shape by bases: eta = harmonics, or tau. */
struct modal_motion {
    tribo_system *sys;
    const struct stick_slip *contacts; /* the caller's */
    const struct forced *h;
    double t0, tau, longest;    /* tau: time after t0 that the terms w are for; longest: the bounds hold until t0 + longest */
    int runs;                   /* 1: some shape has vel, acc or drift_rate tau not 0 */
    size_t room;                /* number of terms, and of shapes, that the arrays have room for */
    double *vel, *acc;          /* [shapes] */
    double *drift, *drift_rate; /* [shapes] eta, eta' at t0 minus harmonics; of modes without drift, minus constant and vel */
    double *place, *rate;       /* [shapes] eta - eta(t0) at tau; eta' at tau, or eta' - eta'(t0) if brief (tau short) */
    struct lot *lot;            /* [terms/TRIBO_TERMS] terms: exponents, then harmonics; harmonics of limits times side */
    int looked;                 /* 1: far is set, in this phase */
    double far;                 /* time after t0 of the last look with e^{lambda tau} computed in full */
    double *far_r, *far_i;      /* [terms] e^{lambda far} */
    double *er, *ei;            /* [terms] workspace: w - z, the change since t0 */
    double *growth, *growth6;   /* [terms] bounds of |w| and of the sixth derivative */
    double *work;               /* [10 room + 2 ndof] workspace */
    double *way;                /* [ncontact] workspace */
    double *steady;             /* [ncontact] force of a sliding contact without harmonics of the limit */
    struct course *course;      /* [ncontact] courses of the outputs of h */
    struct signal velocity;     /* workspace */
};

/* Returns 1, or 0 if out of memory. tribo_modal_motion_free also takes an x that failed. */
int tribo_modal_motion_create(struct modal_motion *x, tribo_system *sys, const struct stick_slip *contacts);
void tribo_modal_motion_free(struct modal_motion *x);

/* Starts a phase at (t, y) with structure h, for a time of at most *longest; sets *longest to the time for which the bounds hold.
 * Returns 1, or 0 if out of memory. */
int tribo_modal_motion_start(struct modal_motion *x, const struct forced *h, double t, const double *y, double *longest);

/* Goes to t0 + tau: sets w, w' and w'' of all terms. */
void tribo_modal_motion_go(struct modal_motion *x, double tau);

/* Return the part of limit i by harmonics, with two derivatives, at x->tau; a bound of the sixth derivative of this part. */
struct sample tribo_modal_motion_limit(const struct modal_motion *x, size_t i);
double tribo_modal_motion_limit_bend(const struct modal_motion *x, size_t i);

/* Return the energy dissipated until t0 + tau, x and x->place being there: by the contact of course c, which slides, counted
 * once; by all. */
double tribo_modal_motion_work(struct modal_motion *x, const struct course *c, double tau);
double tribo_modal_motion_dissipated(struct modal_motion *x, double tau);

/* Goes to t0 + tau: to = state there, from = state at t0. to may be from. */
void tribo_modal_motion_state(struct modal_motion *x, double tau, const double *from, double *to);

/* Sets growth and growth6 for times from tau to longest. */
void tribo_modal_motion_bound(struct modal_motion *x, double tau);

/* *to = c'[q, q', f, f'], f: of compliant contacts, in the phase of length tau that ends in the state end. Returns a status. */
int tribo_modal_motion_signal(const struct modal_motion *x, const double *c, double tau, const double *end, struct signal *to);

/* course.c. begin: starts the course of c->output, value at t0; x is at t0; of_velocity 1: a velocity, 0: a force. look: sets
 * c->at for x->tau. bound: sets c->size and c->bend from growth and growth6. */
void tribo_course_begin(const struct modal_motion *x, struct course *c, int of_velocity, double value);
void tribo_course_look(const struct modal_motion *x, struct course *c);
void tribo_course_bound(const struct modal_motion *x, struct course *c);

#endif
