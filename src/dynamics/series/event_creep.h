/* Steps of driver "event" in which planar contacts creep: the direction of a force that turns with a small velocity v follows
 * what the rest of the motion asks for within the time m|v|/limit, and a Taylor series ends after a few of these.
 *
 * There the directions u = x/|x|, x = limit v, are taken as polynomials instead, which is collocation: of degree NODES - 1, and
 * right at the nodes of Radau's formula, the last of which is the end of the step. In the limit |v| -> 0 this damps at once what
 * is off (Hairer and Wanner, Solving Ordinary Differential Equations II, IV.5). With such u given the motion is that of a linear
 * structure under a load, its series has all terms that it takes, and everything else goes on as ever.
 *
 * The unknowns are the angles of u at the nodes, and they solve, by Newton's method, that x has no part across u. This stays
 * regular for v = 0. Its derivative follows from what a constant force does to x. */
#ifndef TRIBO_EVENT_CREEP_H
#define TRIBO_EVENT_CREEP_H

#include <stddef.h>

struct event;

#define TRIBO_CREEP_NODES 8

struct creep {
    double length;                                      /* what the next such step may have; 0: none is known */
    double shorter;                                     /* when last tried none was good that is longer than this; 0: unknown */
    size_t waited, wait;                                /* steps since contacts creep, and how many these have to be */
    size_t contacts, room, terms;                       /* there is room for; room of those that slide */
    double basis[TRIBO_CREEP_NODES][TRIBO_CREEP_NODES]; /* [node][power] coefficients of what is 1 there and 0 at the others */
    double *weight;                                     /* [terms][node][node]: a force that is basis[second] and acts by
                                                             time^term acts so much at the first node, both in steps */
    double *angle;                                      /* [contacts][node] of u, from the first direction of its line */
    double *response;                                   /* [2 room][terms][2 contacts]: series of x, by u = a unit vector; */
    signed char *slip;                                  /* [ncontact] for contacts that slid so */
    unsigned char *holds;                               /* [ncontact] or held, */
    size_t revision;                                    /* and this system; */
    int known;
    size_t *slides; /* [contacts] those that slide */
    int *pivot;     /* [room NODES] */
    double *matrix, *rest;  /* [room NODES][room NODES], [room NODES] */
};

void tribo_creep_free(struct creep *c);

/* Steps longer than this are worthwhile, since friction would stop a contact long before; HUGE_VAL where none can be. */
double tribo_creep_least(const struct event *e, const double *y);

/* The longest step in which those contacts do not creep whose directions, by the last step, which ended with y, do not follow yet
 * what is asked of them, to what keeps velocities to `error`. HUGE_VAL: all follow. */
double tribo_creep_settled(const struct event *e, const double *y, double error);

/* Sets the series of the motion from (t, y) on for a step of length h, which is good if velocities are right to `error`. Returns
 * a status. */
struct creep_step {
    int good;
    double next;  /* how long another one may be, after this one or in its place; 0: none can be good */
    double stray; /* of the step tried before, if any, HUGE_VAL else: how far directions were off where it began */
};
int tribo_creep_expand(struct event *e, double t, const double *y, double h, double error, struct creep_step *step);

#endif
