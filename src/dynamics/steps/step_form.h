/* What the two methods in step form share: Coulomb's law over a step. No epsilon, contacts at rest stay at
 * rest exactly, and the energy that friction dissipates is that of the discrete motion, -h f'(v + v_end)/2 a step. */
#ifndef TRIBO_STEP_FORM_H
#define TRIBO_STEP_FORM_H

#include "dynamics/driver.h"

struct step_form {
    double *u, *a;       /* [ndof] velocity (central: half a step back), acceleration or what a step adds to u */
    double *v, *end, *f; /* [ncontact] velocity before and at the end, force */
    double *base;        /* [ncontact] b at the end */
    int statics;         /* there are static limits */
    size_t settings;     /* revision of the system in which that is so */
    int goes_on;         /* end is the velocity that the next step begins with */
    signed char *mode;   /* [ncontact] */
    size_t revision;     /* of the system that a method has prepared for */
};

/* 1, or 0 if out of memory. tribo_step_form_free takes what failed too. */
int tribo_step_form_create(struct step_form *s, const tribo_system *sys);
void tribo_step_form_free(struct step_form *s);

/* Looks whether limits are static: at the beginning of an advance, and whenever an observer has changed the system. */
void tribo_step_form_start(struct step_form *s, const tribo_system *sys);

/* base = b(t), if the base moves at all. */
void tribo_step_form_find_base(struct step_form *s, tribo_system *sys, double t);

/* v = J u - base. */
void tribo_step_form_relative(const struct step_form *s, const tribo_system *sys, const double *u, double *v);

/* v and end take each other's place. */
void tribo_step_form_turn(struct step_form *s);

/* v = the velocity that a step begins with, at t. What has no mass may begin with another one than it ended with. */
void tribo_step_form_begin(struct step_form *s, tribo_system *sys, double t, const double *u);

/* f over a step of h, from v and end. By tribo_step_force_mean if there are planar contacts, or static limits, of which it knows
 * who has lost them; else by tribo_step_force, which stops contacts where they reverse: with the mean, light bodies between heavy
 * ones come out worse. */
int tribo_step_form_force(struct step_form *s, const tribo_system *sys, tribo_context *contacts, double h);

/* The power that f dissipates at the mean of two velocities. */
double tribo_step_form_power(const tribo_system *sys, const double *f, const double *before, const double *after);

/* The limit that a step goes by is that of its middle. */
void tribo_step_form_set_limits(tribo_system *sys, double middle);

int tribo_step_form_grew(tribo_driver *drv, double t);

#endif
