#ifndef DAMPER_OPTIONS_H
#define DAMPER_OPTIONS_H

#include "contact.h"
#include "numbers.h"

enum { DEFAULT_MODES = 12 /* kept by default */ };

struct options {
    const char *mass, *stiffness, *dofs;
    const char *out, *name;  /* folder of the tables, and how their names begin */
    const char *plot;        /* png or svg: pictures; NULL: none */
    const char *frequencies; /* NULL for none */
    size_t modes;            /* 0: as many as the answer needs */
    int statics;             /* beside the modes, static responses of contacts and load */
    double damping;
    struct contacts contacts;
    struct place load;
    struct place *output; /* [outputs] */
    size_t outputs, output_room;
    double force;
    struct range drive; /* Hz; from 0: the first natural frequency */
    struct range limits;
    int march;    /* find steady motions by marching */
    size_t check; /* points to be found by marching as well */
    double step;
    int law;
    size_t threads; /* 0: one a core */
};

/* Reads the command line; prints help or version, or ends the program with a message, where that is due. */
struct options read_options(int argc, char **argv);

/* Whether a contact's limit follows the option --limits. */
int limits_vary(const struct options *o);

void print_help(void);

#endif
