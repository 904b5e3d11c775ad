#ifndef DAMPER_DAMPER_H
#define DAMPER_DAMPER_H

#include "options.h"
#include "structure.h"
#include "tribo/tribo_gsl.h"

#define TURN 6.283185307179586476925 /* radians */

/* A structure reduced to its lowest modes, with friction contacts. Made once, then only read: who computes takes a copy of
 * sys. Behind the modes it has a slider without mass for each contact on a spring. */
struct damper {
    tribo_system *sys;                     /* without a load */
    size_t ndof, modes, contacts, motions; /* motions: modes and sliders */
    size_t planar;                         /* contacts in a plane, of which contacts counts both directions */
    double *omega;                         /* [modes] natural frequencies, rad/time */
    double *load_shape;                    /* [modes] the modes where and as the load acts */
    double *contact_shape;                 /* [contacts][modes] the same for the contacts */
    double *load;                          /* [ndof], or with sliders [motions], the load's amplitude */
    double *stiffness;                     /* [contacts] of springs; 0: rigid */
    double *limit;                         /* [contacts] NaN: mu times the limit that varies */
    double *mu;
    double damping, force, step;
};

struct damper create_damper(const struct options *o, const struct structure *s);
void free_damper(struct damper *d);

/* Ends the program if at this frequency of the load there is nothing to compute with. */
void check_drive(const struct damper *d, double hz);

/* Displacement where the load acts; y may be the velocities, too. */
double load_displacement(const struct damper *d, const double *y);

/* Power lost to damping. */
double damping_power(const struct damper *d, const double *y);

#endif
