/* SPDX-License-Identifier: BSD-3-Clause */
/* Methods of the bench: ways to answer a scene's question, each with one setting that trades time for accuracy. */
#ifndef TRIBO_BENCH_METHODS_H
#define TRIBO_BENCH_METHODS_H

#include "systems.h"

struct outcome {
    double answer[ANSWERS];
    size_t steps, evaluations, events;
    double deadline;   /* in, as cpu_seconds() counts: a method may give up then; 0: none */
    char failure[160]; /* "": none */
};

enum sweep { NO_SETTING, STEP, TOLERANCE };

struct method {
    const char *package; /* whose time integration it is: plain, tribo, sundials, siconos */
    const char *name;
    const char *law; /* "coulomb" is Coulomb's law itself, without epsilon */
    enum sweep sweep;
    double stable;                      /* STEP: the longest is this over the highest frequency; 0: any */
    int (*fits)(const struct scene *s); /* NULL: all scenes */
    /* From nothing to the answer, as a user's first run would be: system, driver, run. (The beam's modes are there already.) */
    void (*run)(const struct method *m, const struct scene *s, double setting, struct outcome *o);
    double patience; /* its runs may take so many times as long as others' may; 0: 1 */
    int number;      /* the package's own: law, solver ... */
};

struct methods {
    const struct method *method;
    size_t count;
};

/* One a package; that of a peer is there if it was found. */
extern const struct methods plain_methods, tribo_methods, sundials_methods, siconos_methods;

/* The unit of time: plain rk4 with Quinn's law, in steps of the scene's dt. */
extern const struct method *const unit_method;

/* Notes a failure, the first one counts. */
void outcome_fail(struct outcome *o, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 2, 3)))
#endif
    ;

/* The answer from states at the begin of the last cycle and at the end; y: q, u, D. */
void outcome_answer(struct outcome *o, const struct scene *s, const double *y, double d_at_begin);

#endif
