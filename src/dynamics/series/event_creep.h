/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps of method "event" in which planar contacts creep: the direction of the force at a small velocity v relaxes to that of the
 * motion within the time m|v|/limit, and a Taylor series converges over a few such times only.
 *
 * There the directions u = x/|x|, x = limit v, are polynomials of degree NODES - 1, by collocation at the nodes of Radau's
 * formula, the last of which is the end of the step. For |v| -> 0 this damps errors at once (Hairer and Wanner, Solving Ordinary
 * Differential Equations II, IV.5). With u given the motion is that of a linear structure under a load, and its series converges.
 *
 * The unknowns are the angles of u at the nodes; Newton's method solves that x has no part across u, which is regular for v = 0.
 * The derivative follows from the response of x to a constant force. */
#ifndef TRIBO_EVENT_CREEP_H
#define TRIBO_EVENT_CREEP_H

#include <stddef.h>

struct event;

#define TRIBO_CREEP_NODES 8

struct creep {
    double length;                                      /* of the next such step; 0: unknown */
    size_t waited, wait;                                /* steps since contacts creep, and number of steps to wait */
    size_t contacts;                                    /* room for planar contacts */
    size_t room;                                        /* room for sliding ones */
    size_t terms;                                       /* room for terms */
    double basis[TRIBO_CREEP_NODES][TRIBO_CREEP_NODES]; /* [node][power] of the polynomial that is 1 there, 0 at other nodes */
    double *weight;   /* [terms][node][node] effect at the first node of a force basis[second] that acts by time^term, in steps */
    double *angle;    /* [contacts][node] of u, from n of its line */
    double *response; /* [2 room][terms][2 contacts] series of x by u = a unit vector */
    size_t *slides;   /* [contacts] the sliding contacts */
    int *pivot;       /* [room NODES] */
    double *matrix;   /* [room NODES][room NODES] Newton's */
    double *rest;     /* [room NODES] its right-hand side */
};

void tribo_creep_free(struct creep *c);

/* Least length of a step that pays: much longer than the time in which friction would stop a contact; HUGE_VAL if none can
 * pay. */
double tribo_creep_least(const struct event *e, const double *y);

/* The longest step in which no contact creeps whose direction, at the end y of the last step, has not relaxed yet to what keeps
 * velocities to `error`; HUGE_VAL if all have. */
double tribo_creep_settled(const struct event *e, const double *y, double error);

/* Finds the series of the motion from (t, y) on for a step of length h; step->good = 1 if velocities are right to `error`.
 * Returns a status. */
struct creep_step {
    int good;
    double next;  /* how long another one may be, after this one or in its place; 0: none can be good */
    double stray; /* of the step tried before, if any, HUGE_VAL else: how far directions were off where it began */
};
int tribo_creep_expand(struct event *e, double t, const double *y, double h, double error, struct creep_step *step);

#endif
