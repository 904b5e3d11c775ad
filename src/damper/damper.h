/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_DAMPER_H
#define DAMPER_DAMPER_H

#include "linear.h"
#include "options.h"
#include "structure.h"
#include "tribo/tribo_dynamics.h"

#define TURN 6.283185307179586476925 /* radians */

/* A structure reduced to its lowest modes and to static responses, with friction contacts. Made once, then only read: each thread
 * has a copy of sys. Static responses are modes, too, orthogonal to all others in mass and stiffness.
 * The record of a motion: the state at the beginning of a period; of each contact the power lost to its friction; of each contact
 * the share of the period for which it is at rest; the share for which it has lifted off; of each output the amplitude, and of
 * each harmonic h, of the first one always, a and phase of a sin(h omega t + phase), phase in degrees. Marching leaves powers and
 * shares NaN. */
struct damper {
    const struct options *options;
    tribo_system *reduced;         /* for truncation, and for displacements of the whole structure */
    tribo_system *sys;             /* the same with springs, without a load; with normal directions at the first of --limits */
    size_t ndof, kept, modes;      /* of the structure; lowest modes kept; those and static responses */
    size_t contacts;               /* number of them, of a contact in a plane both directions */
    size_t rows;                   /* number of contacts and of normal directions behind them */
    const struct contact *contact; /* [rows] */
    size_t dimension;              /* of a state */
    size_t output, record;         /* numbers of an output in a record; numbers of a record */
    int in_plane;                  /* 1: contacts slide in a plane */
    int marched;                   /* 1: motions are found by marching only, since such contacts have a normal direction */
    struct linear open, stuck;     /* without friction, and with all contacts stuck */
    double lowest, highest;        /* ends of the band of the load, Hz */
    double backbone;               /* frequency of the mode of --backbone, rad/time */
    double *contact_shape;         /* [rows][modes] the modes at the contacts, positive where normal directions press */
    const double *output_shape;    /* [outputs][modes] at the places of --output */
    int law;
};

/* Sets values that depend on the structure: the size of loads, and limits that were not given; checks the contacts. */
void complete_options(struct options *o, const struct structure *s);

/* kept: the lowest modes to keep. The options must stay. */
struct damper create_damper(const struct options *o, const struct structure *s, size_t kept);
void free_damper(struct damper *d);

/* The system of modes, with the springs of contacts, for a value of --limits. */
tribo_system *create_system(const struct damper *d, double limit);

/* The load of a normal spring where the structure is at rest, for a value of --limits; 0 if the contact has a gap. */
double rest_load(const struct contact *c, double limit);

/* Ends the program if at this frequency of the load there is nothing to compute with. */
void check_drive(const struct damper *d, double hz);

#endif
