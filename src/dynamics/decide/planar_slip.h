/* Planar contacts of the event-located drivers: who sticks at an instant, and who slides, and which way. */
#ifndef TRIBO_PLANAR_SLIP_H
#define TRIBO_PLANAR_SLIP_H

#include "dynamics/system/system.h"

struct stick_slip;

/* How a contact slides: it has a velocity; or has none yet, and an acceleration; or neither, and its force is about to reach
 * beyond the limit. The velocity then begins with the power of time that this is. */
enum { SLIDES_ON = 0, BY_ACCELERATION = 1, BY_FORCE = 2 };

struct planar_contact {
    size_t at;           /* its first direction; the other one follows */
    double limit[2];     /* both > 0 */
    double most;         /* the largest speed seen, */
    double now, before;  /* that at this decision, and at the one before; 0 where it begins to slide */
    int begins;          /* one of these */
    double direction[2]; /* while it begins: of limit v, which is against that of force/limit; length 1 */
};

struct planar_slip {
    tribo_context *disc; /* finds the forces of contacts at rest, that of Coulomb's law for v = 0 */
    size_t count;
    struct planar_contact *contact; /* [count] those with two limits */
    size_t stopped;                 /* a contact that the last decision found to stick; ncontact if there is none */
    unsigned char *in_plane;        /* [ncontact] 1: first direction of one, 2: second direction, 0: of none */
    double *error;                  /* [ncontact] errors that velocities may have in a step */
    double *rate, *ahead;           /* [ncontact] workspace: of forces that slide; accelerations of a moment later */
};

void tribo_planar_slip_free(struct planar_slip *p); /* NULL is fine */

/* After tribo_stick_slip_start: takes the planar contacts from the system, unless it continues. Returns a status, its message on
 * the system's context. */
int tribo_planar_slip_start(struct stick_slip *m, const tribo_system *sys, int continues);

/* In the place of tribo_stick_slip_decide where there are planar contacts. */
int tribo_planar_slip_decide(struct stick_slip *m, tribo_system *sys, double t, double *y);

#endif
