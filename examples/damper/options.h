#ifndef EXAMPLES_OPTIONS_H
#define EXAMPLES_OPTIONS_H

#include <stddef.h>

enum { MAX_CONTACTS = 32, DEFAULT_MODES = 12 /* kept by default */ };

/* A degree of freedom as the user names it: a node by its coordinates, and a direction (1, 2, 3 for x, y, z). */
struct place {
    double at[3];
    int direction;
    const char *text; /* for messages */
};

struct options {
    const char *mass, *stiffness, *dofs, *out;
    const char *frequencies; /* NULL for none */
    size_t modes;            /* 0: the default, as far as there are so many */
    double damping;
    struct place contact[MAX_CONTACTS], load;
    size_t contacts;
    double force, drive;
    double limit_from, limit_to;
    size_t limit_points; /* 1: limit_from alone */
    double step;
    int law;
};

/* Reads the command line; prints the help or ends the program with a message where that is due. */
struct options read_options(int argc, char **argv);

#endif
