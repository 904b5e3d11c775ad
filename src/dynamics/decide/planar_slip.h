/* The decision about planar contacts, for methods with events: which of them stick, and in which direction the others slide. */
#ifndef TRIBO_PLANAR_SLIP_H
#define TRIBO_PLANAR_SLIP_H

#include "dynamics/system/system.h"

struct stick_slip;

/* How a contact slides: with a velocity; without one, by its acceleration; or by its force alone, which is about to reach
 * beyond the limit. The value is the power of time with which the velocity begins. */
enum { SLIDES_ON = 0, BY_ACCELERATION = 1, BY_FORCE = 2 };

struct planar_contact {
    size_t at;           /* index of its first direction; the second one is at + 1 */
    double limit[2];     /* both > 0 */
    double most;         /* the largest speed so far */
    double now;          /* speed at this decision; 0 where it begins to slide */
    double before;       /* speed at the decision before */
    int begins;          /* SLIDES_ON, BY_ACCELERATION or BY_FORCE */
    double direction[2]; /* if not SLIDES_ON: direction of limit v, against that of force/limit; length 1 */
};

struct planar_slip {
    tribo_context *disc;            /* forces of contacts at rest, as f_eq by Coulomb's law for v = 0 */
    size_t count;                   /* number of planar contacts */
    struct planar_contact *contact; /* [count] */
    size_t stopped;                 /* a contact that the last decision brought to rest; ncontact if none */
    unsigned char *in_plane;        /* [ncontact] 1: first direction of a planar contact; 2: second direction; 0: scalar */
    double *error;                  /* [ncontact] errors that velocities may have in a step */
    double *rate;                   /* [ncontact] workspace: rates of sliding forces */
    double *ahead;                  /* [ncontact] workspace: accelerations a moment later */
};

void tribo_planar_slip_free(struct planar_slip *p); /* NULL is fine */

/* After tribo_stick_slip_start: takes the planar contacts from the system, unless it continues. Returns a status, its message
 * on the system's context. */
int tribo_planar_slip_start(struct stick_slip *m, const tribo_system *sys, int continues);

/* In the place of tribo_stick_slip_decide where there are planar contacts. */
int tribo_planar_slip_decide(struct stick_slip *m, tribo_system *sys, double t, double *y);

#endif
