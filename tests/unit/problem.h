/* SPDX-License-Identifier: BSD-3-Clause */
/* Random problems of coupled contacts, and what their equations say in long double. */
#ifndef TRIBO_TESTS_PROBLEM_H
#define TRIBO_TESTS_PROBLEM_H

#include "support.h"

#define LARGEST 200 /* contacts of a problem */
#define USUAL 40

struct problem {
    size_t n;
    double r[LARGEST * LARGEST];
    double limit[LARGEST], epsilon[LARGEST], v[LARGEST], a[LARGEST];
};

/* What problems are like. */
struct recipe {
    size_t contacts, bodies; /* fewer bodies than contacts: R is singular */
    double decades;          /* spread of masses, lever arms and limits */
    double speed;            /* |v|/epsilon of those that move, at most */
    double pull;             /* |a|/(R_ii N), at most */
    double open, resting;    /* parts of the contacts with limit 0, with v = 0 */
    double nearly;           /* part of the redundant contacts that are so up to 1e-16 to 0.1 only */
};

/* 1 to most contacts of all ranks, redundant and nearly redundant ones among them, in all states of motion. */
struct recipe recipe_random(struct random *g, size_t most, double decades);
/* 2 to most contacts with R well conditioned. */
struct recipe recipe_regular(struct random *g, size_t most);

struct problem problem_create(struct random *g, const struct recipe *recipe);
tribo_context *problem_context(const struct problem *p, int law, int coupling);

/* f of the problem's v + step dv and a + step da. */
void problem_forces(tribo_context *c, const struct problem *p, double step, const double *dv, const double *da, double *f);

/* f with limits that have gone by part of dlimit. */
void problem_forces_of_limits(tribo_context *c, const struct problem *p, double part, const double *dlimit, double *f);

/* The same contacts in other tangential directions: turn [n][n] takes each that is two directions wide (wide[i] of those that
 * begin at i) by an angle of its own, and p's limits become the same in both of its directions. */
struct problem problem_turn(struct random *g, struct problem *p, const int *wide, double *turn);

/* turn f = got. */
void problem_check_turned(size_t n, const double *turn, const double *f, const double *got);

/* A chain of n contacts between bodies of mass 1: tridiagonal R. */
tribo_context *problem_chain(size_t n, size_t islands, int coupling);

/* Contacts of one body that moves one way, of which each sees so much [n] of that: R = r direction direction'. */
tribo_context *problem_of_one_body(size_t n, const double *direction, double r);

/* (a + R f)_i; without its own force, f_eq of contact i; and what rounding may make of that. */
long double acceleration(const struct problem *p, size_t i, const double *f);
double balancing(const struct problem *p, size_t i, const double *f);
double balancing_noise(const struct problem *p, size_t i, const double *f);

/* tribo_law_eval */
double law_force(int law, double v, double feq, double limit, double epsilon);

size_t count_of(const tribo_context *c, int which);
double real_of(const tribo_context *c, int which);

/* Contacts 0 and 1 are the same, contact 2 pulls on both; all stuck. */
extern const struct problem twins;

#endif
