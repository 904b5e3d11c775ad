/* SPDX-License-Identifier: BSD-3-Clause */
/* What methods with steps of one length share. */
#ifndef TRIBO_FIXED_STEPS_H
#define TRIBO_FIXED_STEPS_H

#include "dynamics/driver.h"

/* Computes y, all values, at time next from the state `from` at t. Returns a status, an error if y is not finite. */
typedef int tribo_fixed_step(tribo_driver *drv, double t, double next, const double *from, double *y);

/* Advances y from t[0] over the times t [count + 1], count <= RUN. Returns the number of steps taken; if less than count, the
 * next step needs tribo_fixed_step. */
typedef size_t tribo_fixed_run(tribo_driver *drv, size_t count, const double *t, double *y);

/* Largest number of steps of a run. */
enum { RUN = 32 };

/* Takes steps drv->dt from the last good state y at *t to t1, several by run (NULL: none) without an observer; the last step may
 * be shorter. Keeps states as tribo_driver_keep does, without copies. Returns a status. */
int tribo_driver_fixed_steps(tribo_driver *drv, double *t, double t1, double *y, tribo_fixed_step *step, tribo_fixed_run *run);

/* Of the two methods in step form: Coulomb's law over a step, without epsilon. Contacts at rest stay at rest
 * exactly, and the energy that friction dissipates is that of the discrete motion, -h f'(v + v_end)/2 a step. */
struct step_form {
    double *memory;      /* all arrays; freed by the method */
    double *u, *a;       /* [ndof] velocity (central: half a step back); acceleration, or what a step adds to u */
    double *v, *end, *f; /* [ncontact] velocity at the beginning and at the end of a step, force */
    double *base;        /* [ncontact] b at the end */
    double *spare;       /* [ndof] of the method */
    signed char *mode;   /* [ncontact] slip */
    size_t revision;     /* of the system for which a method has prepared */
};

/* body [j->rows] = the degree of freedom on which contact i acts, lever [j->rows] = its entry of J. Returns 0 if a contact has
 * none or several, or shares it. seen [j->cols]: workspace, all 0. */
int tribo_step_form_bodies(const struct matrix *j, size_t *body, double *lever, signed char *seen);

/* 1, or 0 if out of memory. */
int tribo_step_form_create(struct step_form *s, const tribo_system *sys);

/* base = b(t); v = J u - base. */
void tribo_step_form_find_base(struct step_form *s, tribo_system *sys, double t);
void tribo_step_form_velocity(struct step_form *s, tribo_system *sys, double t, const double *u, double *v);

/* v = J u - base. */
void tribo_step_form_relative(const struct step_form *s, const tribo_system *sys, const double *u, double *v);

/* f = forces over a step of h, from v and end, with the limits of its middle. By tribo_step_force, which stops contacts
 * where they reverse, if contacts are plain; else by tribo_step_force_mean, which knows planar contacts and lost static
 * limits: with it, light bodies between heavy ones come out worse. Returns a status. */
int tribo_step_form_force(struct step_form *s, const tribo_system *sys, tribo_context *contacts, double h);

/* The power that f dissipates at the mean of v and end. */
double tribo_step_form_power(const struct step_form *s, const tribo_system *sys);

/* Returns status, with the message of a motion that grew for TRIBO_ERR_NOT_FINITE, else with message. */
int tribo_step_form_fail(tribo_driver *drv, int status, double t, const char *message);

#endif
