/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_OPTIONS_H
#define DAMPER_OPTIONS_H

#include "contact.h"

enum { DEFAULT_MODES = 12 /* kept by default */ };

struct outputs {
    struct place *place; /* [count] */
    size_t count;
};

struct texts {
    char **text; /* [count] */
    size_t count;
};

struct options {
    const char *mass, *stiffness, *dofs;
    const char *damping_matrix; /* NULL: ratios */
    const char *out, *name;     /* folder of the tables, and how their names begin */
    const char *plot;           /* png or svg: pictures; NULL: none */
    const char *frequencies;    /* NULL for none */
    size_t modes;               /* 0: as many as the answer needs */
    int statics;                /* beside the modes, static responses of contacts and loads */
    struct list damping;        /* ratios of mode 1, 2, ...; the last one is that of all others */
    struct contacts contacts;
    struct loads loads;
    struct outputs outputs;
    size_t harmonics;        /* of each output */
    struct list field;       /* phases of displacement fields, degrees */
    double force;            /* of loads without one */
    double size;             /* the sum of all forces; of supports, acceleration times mass */
    struct range drive;      /* Hz; from 0: the first natural frequency */
    struct range limits;     /* of contacts, or normal loads */
    int follow;              /* curves over the band: 1: up, -1: down, 2, -2: with changes of events; 0: not followed */
    double cycle;            /* a guess of the period, 0: none; < 0: no cycle is looked for */
    size_t backbone;         /* number of a mode; 0: no backbone curve */
    struct range amplitudes; /* of the backbone curve */
    int march;               /* find steady motions by marching */
    size_t check;            /* points to be found by marching as well */
    double step;
    int law;
    size_t threads;     /* 0: one a core */
    struct texts texts; /* what options point to */
};

/* Reads the command line; prints help or version, or ends the program with a message, where that is due. */
struct options read_options(int argc, char **argv);
void free_options(struct options *o);

/* 1 if loads do not act: with --backbone or --cycle. */
int is_unloaded(const struct options *o);

/* Where amplitudes are measured: at the first force, without forces at the first output. */
const struct place *measured_place(const struct options *o);

#endif
