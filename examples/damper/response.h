#ifndef EXAMPLES_RESPONSE_H
#define EXAMPLES_RESPONSE_H

#include "structure.h"
#include "tribo/tribo_gsl.h"

/* A structure reduced to its lowest modes, with friction contacts to ground and one harmonic load. */
struct damper {
    tribo_system *sys;
    tribo_driver *drv;
    size_t modes, contacts;
    double *omega;         /* [modes] natural frequencies, rad/time */
    double *load_shape;    /* [modes] the modes where and as the load acts */
    double *contact_shape; /* [contacts][modes] the same for the contacts */
    double damping, force;
    double drive, period;          /* of the load: rad/time, time */
    double amplitude, power, norm; /* of the motion without friction, to measure others by: that of the load's place, the most
                                      that the load could put into it, and its energy norm */
    size_t steps;                  /* a period */
};

/* The steady motion at one limit. Powers are means over a period. */
struct response {
    double limit, amplitude;
    double friction, damped, input; /* power lost to friction, lost to modal damping, and put in by the load */
    size_t cycles;                  /* that it took */
    int steady;
};

struct damper create_damper(const struct options *o, const struct structure *s);
void free_damper(struct damper *d);

/* Makes the integrator take this many steps a period. */
void set_steps(struct damper *d, size_t steps);

/* Runs from rest until the motion repeats itself. y [2 modes + 1] out: the state at the beginning of a period. */
struct response find_response(struct damper *d, double limit, double *y);

/* Displacement where the load acts. */
double load_displacement(const struct damper *d, const double *y);

#endif
