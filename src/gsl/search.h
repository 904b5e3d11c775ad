/* The first of many functions to fall to zero. */
#ifndef TRIBO_SEARCH_H
#define TRIBO_SEARCH_H

#include <stddef.h>

#include "roots.h"

/* Something about a contact that must stay positive while its mode lasts: offset + side * value. Sliding contacts: their
 * velocity, side being its sign, offset 0. Contacts at rest: what is left between their force and the limit, offset being the
 * limit. */
struct guard {
    size_t contact;
    const void *watch; /* the motion's own */
    double offset, side;
    double start, ramp; /* the motion's own */
    double size, bend;  /* bounds of its parts together, and of its sixth derivative */
    int from_zero;      /* it starts at zero, and has been decided to leave it */
    struct sample left, right, middle;
};

/* Guards, and the motion that they are about, which starts at time 0. */
struct search {
    size_t guards;
    struct guard *guard;
    void (*look)(void *motion, double tau);                               /* goes to tau */
    struct sample (*read)(const void *motion, const struct guard *guard); /* the guard there */
    void *motion;
    size_t looks;
};

/* The guard that is first to meet zero, and when; NULL if none does before longest. What is zero at the start has been decided to
 * leave it. */
const struct guard *tribo_search(struct search *s, double longest, double *when);

#endif
