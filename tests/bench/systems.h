/* SPDX-License-Identifier: BSD-3-Clause */
/* What the bench runs: mechanical systems, each with a question whose exact answer is known.
 *
 * A model is a system as plain code and other packages see it, free of this library:
 *     q' = u,  u' = load(t) - K q - C q' + J' f,  v = J u - b(t),  R = J J',
 * with masses of one (the beam is described by its modes). */
#ifndef TRIBO_BENCH_SYSTEMS_H
#define TRIBO_BENCH_SYSTEMS_H

#include <stddef.h>

#include "tribo/tribo_gsl.h"

#define PI 3.14159265358979323846

enum { MODES = 12, CONTACTS = 3 /* of the beam */, ANSWERS = 2 * MODES };

enum kind { OSCILLATOR, CHAIN, BELT, BEAM };

/* The beam's modes: stiffness, damping, amplitudes of the load, J and R. And coordinates s of the velocities whose first entries
 * are those of the contacts, so that a contact at rest is so exactly: u = back s, s = forth u. */
struct modal {
    double stiffness[MODES], damping[MODES], load[MODES];
    double j[CONTACTS][MODES], r[CONTACTS][CONTACTS];
    double back[MODES][MODES], forth[MODES][MODES];
};

struct model {
    enum kind kind;
    size_t n, c;
    double alpha, omega;    /* of the load, or of the belt */
    double kappa;           /* belt */
    double limit[CONTACTS]; /* chain: the first is that of all */
    double fastest;         /* highest natural frequency */
    struct modal beam;
};

static inline double limit_of(const struct model *m, size_t contact)
{
    return m->limit[m->kind == CHAIN ? 0 : contact];
}

/* The answer is D, what friction dissipates over the last cycle, or the state q, u at the end. */
struct scene {
    char name[20];
    struct model model;
    double begin, end; /* of the last cycle; begin 0: the answer is the state at the end */
    double dt;         /* step of the unit of time, plain rk4 with Quinn's law, */
    double unit_part;  /* of whose run the unit is this part (1, but where dt is not 0.01) */
    double lambda_dt;  /* of Quinn's law with rk4, see tribo_set_epsilon_step */
    double size;       /* of displacements, for tolerances */
    size_t answers;
    double weight[ANSWERS]; /* in the error */
    int printed;            /* whether the reference is a printed value; else it is method exact's */
    double reference[ANSWERS];
    double second[ANSWERS]; /* method event's, at the tightest tolerance */
    tribo_system *beam;     /* NULL for the others, which each run makes for itself */
};

/* All scenes, count of them; their references still unknown, unless printed. Ends the program if one cannot be made. */
struct scene *systems_create(size_t *count);
void systems_destroy(struct scene *scene, size_t count);

/* A system for a run, which ends it by scene_close. */
tribo_system *scene_open(const struct scene *s);
void scene_close(const struct scene *s, tribo_system *sys);

/* How far an answer is from another: relative for D, the largest difference of the belt's states, relative in the energy norm for
 * those of the beam. */
double scene_error(const struct scene *s, const double *answer, const double *reference);

#endif
