#ifndef DAMPER_DAMPER_H
#define DAMPER_DAMPER_H

#include "options.h"
#include "structure.h"
#include "tribo/tribo_gsl.h"

#define TURN 6.283185307179586476925 /* radians */

/* A structure reduced to its lowest modes and to static responses, with friction contacts. Made once, then only read: each thread
 * has a copy of sys. Static responses are modes, too, orthogonal to all others in mass and stiffness. Behind the modes sys has a
 * slider without mass for each contact on a spring. */
struct damper {
    tribo_system *reduced;               /* answers how much is left out */
    tribo_system *sys;                   /* the same with springs, without a load */
    size_t ndof, kept, modes;            /* of the structure; lowest modes kept; those and static responses */
    size_t contacts, outputs, dimension; /* dimension: of a state */
    size_t planar;                       /* contacts in a plane, of which contacts counts both directions */
    double *omega;                       /* [modes] natural frequencies, rad/time */
    double *load_shape;                  /* [modes] the modes where and as the load acts */
    double *contact_shape;               /* [contacts][modes] the same for the contacts */
    double *output_shape;                /* [outputs][modes] the same for the places of --output */
    double *load;                        /* [modes] the load's amplitude */
    double *stiffness;                   /* [contacts] of springs; 0: rigid */
    double *limit;                       /* [contacts] NaN: mu times the limit that varies */
    double *mu;
    double damping, force, step;
    int law;
};

/* kept: the lowest modes to keep. */
struct damper create_damper(const struct options *o, const struct structure *s, size_t kept);
void free_damper(struct damper *d);

/* The ends of the band of the load, Hz. */
double lowest_drive(const struct options *o, const struct damper *d);
double highest_drive(const struct options *o, const struct damper *d);

/* Ends the program if at this frequency of the load there is nothing to compute with. */
void check_drive(const struct damper *d, double hz);

/* Displacement where the load acts; y may be the velocities, too. */
double load_displacement(const struct damper *d, const double *y);

/* Power lost to damping. */
double damping_power(const struct damper *d, const double *y);

#endif
