/* SPDX-License-Identifier: BSD-3-Clause */
/* The book of validation: programs of its rows, and what they share. Every function of a row computes one number. */
#ifndef TRIBO_TESTS_BOOK_H
#define TRIBO_TESTS_BOOK_H

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "tribo/tribo_dynamics.h"

#define PI 3.14159265358979323846
#define COUNT(array) (sizeof(array) / sizeof *(array))

/* A row: its key in book.txt, and the function that computes its number. */
struct row {
    const char *key;
    double (*compute)(int variant);
    int variant;
};

/* The rows of one file; a row without key ends them. */
extern const struct row rows_oscillators[], rows_periodic[], rows_planar[], rows_normals[], rows_bodies[], rows_elements[];

/* Ends the program with the text where status is not 0. */
void need(int status, const char *text);

/* A system and a driver on it, and the moments of contacts that an advance passes. */
enum { MOST_MOMENTS = 64 };
struct motion {
    tribo_system *sys;
    tribo_driver *drv;
    double t;
    size_t count; /* moments, of which the last MOST_MOMENTS are kept */
    int kind[MOST_MOMENTS];
    size_t contact[MOST_MOMENTS];
    double at[MOST_MOMENTS], q[MOST_MOMENTS]; /* time, and y[0] */
};

/* A motion by a method of a system, which then belongs to the motion. */
void motion_begin(struct motion *m, tribo_system *sys, const char *method);
void motion_advance(struct motion *m, double t1, double *y);
void motion_end(struct motion *m);

/* Finds a periodic motion from rest; y [dimension] out. */
void motion_find(struct motion *m, double period, double *y);

/* Largest value of c'[q, q'] over the period found. */
double motion_most(struct motion *m, const double *c);

/* A system with dense matrices; damping, compliance or stiffness may be NULL. */
tribo_system *dense(size_t ndof, size_t ncontact, const double *mass, const double *damping, const double *stiffness,
                    const double *direction, const double *compliance);

/* x'' + damping x' + stiffness x = cosine cos(omega t) + sine sin(omega t) + f, |f| <= limit. */
tribo_system *oscillator(double damping, double stiffness, double limit, double cosine, double sine, double omega);

#endif
