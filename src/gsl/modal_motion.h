/* The motion of a structure with contacts held, from a state on, in closed form: a phase of method "exact". */
#ifndef TRIBO_MODAL_MOTION_H
#define TRIBO_MODAL_MOTION_H

#include "modal.h"
#include "quintic.h"
#include "stick_slip.h"
#include "signal.h"

/* What of an output is linear in time. */
struct line {
    double start, ramp;
};

/* It began at t0; amplitudes eta = off + vel t + acc t^2/2 (of modes that drift, from their state) + harmonics + Re(r z). */
struct modal_motion {
    tribo_system *sys;
    const struct stick_slip *contacts; /* the caller's */
    const struct modal *h;
    double t0, tau;                        /* tau: where w is */
    double *eta, *rate, *off, *vel, *acc;  /* [modes] at t0 */
    double *drift, *drift_rate;            /* [modes] of those that drift: what harmonics do not explain, at t0 */
    size_t room;                           /* of terms */
    double *zr, *zi;                       /* [terms] at t0 */
    double *wr, *wi, *w1r, *w1i;           /* [terms] z and z' at tau, */
    double *w2r, *w2i;                     /* [terms] and z''; room apart */
    double far;                            /* the time of the last look that was far from another one, or 0, */
    double *far_r, *far_i;                 /* [terms] and e^{lambda far} */
    double *er, *ei;                       /* [terms] workspace */
    double *growth, *growth6;              /* [terms] bounds of |z| and of its sixth derivative */
    double *cos_t, *sin_t, *cos_0, *sin_0; /* [harmonics] terms of harmonics at t0 + tau, at t0; of contacts times */
    double *side;                          /* [harmonics] how many times their force follows the limit; others 1 */
    double *now, *work;                    /* [modes] eta and eta' at tau; workspace */
    double *dq;                            /* [ndof] by how much q has changed at tau */
    const double *steady;                  /* [ncontact] force of a sliding contact, without harmonics of its limit; */
    struct line *line;                     /* [ncontact] while limits have any: its velocity, as far as it is linear in time */
    double *room_for_steady;               /* [ncontact] where steady stands if limits have any */
    double longest;                        /* so long do bounds hold */
};

/* 1, or 0 if out of memory. tribo_modal_motion_free takes what failed too. */
int tribo_modal_motion_create(struct modal_motion *x, tribo_system *sys, const struct stick_slip *contacts);
void tribo_modal_motion_free(struct modal_motion *x);

/* Makes room for this many terms; 1, or 0 if out of memory. */
int tribo_modal_motion_reserve(struct modal_motion *x, size_t terms);

/* Starts at (t, y) with h held, for a time of longest. Returns for how long its bounds can hold. */
double tribo_modal_motion_start(struct modal_motion *x, const struct modal *h, double t, const double *y, double longest);

/* Goes to t0 + tau: z and its derivatives, and the harmonics. */
void tribo_modal_motion_go(struct modal_motion *x, double tau);

/* An output there, with two derivatives. */
struct sample tribo_modal_motion_output(const struct modal_motion *x, const struct output *w, const struct line *line);

/* What harmonics add to the limit of contact i there, with two derivatives; and a bound of the sixth derivative of that. */
struct sample tribo_modal_motion_limit(const struct modal_motion *x, size_t i);
double tribo_modal_motion_limit_bend(const struct modal_motion *x, size_t i);

/* The line of an output that is at->g at t0, where the motion still is. Sets its derivatives there, too. */
struct line tribo_modal_motion_line(const struct modal_motion *x, const struct output *w, int of_velocity, struct sample *at);

/* The third to fifth derivative of an output there, into to [3]; 1, or 0 if they are not known: where loads resonate. */
int tribo_modal_motion_further(const struct modal_motion *x, const struct output *c, double *to);

/* Energy dissipated until t0 + tau, where dq is. */
double tribo_modal_motion_dissipated(const struct modal_motion *x, double tau);

/* Goes to t0 + tau: the state there. from is the state at t0; to may be the same. */
void tribo_modal_motion_state(struct modal_motion *x, double tau, const double *from, double *to);

/* Bounds of the terms from tau on, */
void tribo_modal_motion_bound(struct modal_motion *x, double tau);

/* and of what an output has of them, and of the sixth derivative of that. */
void tribo_modal_motion_output_bounds(const struct modal_motion *x, const struct output *w, double *size, double *bend);

/* c'y, c [2 ndof], in the phase that lasts tau and ends with the state end. Returns a status. */
int tribo_modal_motion_signal(const struct modal_motion *x, const double *c, double tau, const double *end, struct signal *to);

#endif
