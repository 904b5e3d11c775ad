/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_CONTACT_H
#define DAMPER_CONTACT_H

#include "text.h"

/* A degree of freedom as the user names it: a node by its coordinates, and a direction (1, 2, 3 for x, y, z). */
struct place {
    double at[3];
    int direction;
    const char *origin; /* where it was given, for messages */
};

/* The normal load of a contact by a spring that lifts off: stiffness max(0, displacement - gap), or max(0, load + stiffness
 * displacement), where the structure at rest holds the load. */
struct normal {
    int direction;    /* 1, 2, 3; < 0: the node presses as it moves against it; 0: there is none */
    double stiffness; /* > 0 */
    double gap;       /* NaN: load is given */
    double load;      /* NaN: gap is given, or the load is that of --limits */
};

/* A contact between a node and the ground, or another node; or one of the two directions of a contact in a plane; or the normal
 * direction of a contact, along which a spring presses. */
struct contact {
    struct place at, to;
    int between;  /* 0: to the ground, and there is no to */
    double limit; /* NaN: mu times the value of --limits */
    double mu;
    double stiffness; /* of the spring before the slider, 0: a rigid contact; of a normal direction, of the spring that presses */
    double belt;      /* velocity of the other end, the ground, along the contact */
    double ratio;     /* limit at rest over limit while sliding, >= 1 */
    int directions;   /* of the contact, of which this is the first one; 0: this is the second one of the contact before */
    struct normal normal;
    char *line; /* origin of a contact from a file, or NULL; owned */
};

/* A harmonic load, size sin(omega t + phase): a force at a place; or an acceleration of all supports along a direction. */
struct load {
    struct place at; /* of the supports: the direction only */
    int supports;    /* 1: the supports move */
    double size;     /* a force, NaN: that of --force; or an acceleration */
    double phase;    /* degrees */
};

struct loads {
    struct load *load;
    size_t count;
};

/* "X,Y,Z,DIR" */
struct place read_place(struct text *t);

/* "X,Y,Z,DIR" and the words force=FORCE phase=DEGREES, or "DIR" and acceleration=NUMBER phase=DEGREES, parted by colons or
 * blanks: add the load to a struct loads. */
reader read_load, read_base;

struct contacts {
    struct contact *contact; /* [count + normals] */
    size_t count;
    size_t normals; /* normal directions, behind all contacts, in the order of their contacts; added by add_normals */
    int vary;       /* 1: a contact follows --limits */
    int by_load;    /* 1: one that does has mu=, so that --limits gives normal loads */
};

/* "X,Y,Z,DIR", where DIR may be two directions, and words to=X,Y,Z limit=FORCE mu=NUMBER load=FORCE stiffness=NUMBER
 * normal=DIR,STIFFNESS gap=LENGTH belt=VELOCITY static=RATIO behind it, parted by colons or blanks: adds the contact, or the two
 * directions of a planar one, to a struct contacts. The other one adds the contacts of a file, one a line. */
reader read_contact, read_contacts;

void add_normals(struct contacts *all);
void free_contacts(struct contacts *all);

#endif
