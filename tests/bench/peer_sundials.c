/* SPDX-License-Identifier: BSD-3-Clause */
/* SUNDIALS as an expert would use it for Coulomb's law: the contacts' modes are held in the right-hand side, roots of the sliding
 * velocities and of what is left to the limits end a mode, and integration starts again behind each.
 *
 * What it takes to do this well, all of it learned the hard way by others: velocities of the contacts are states, so that
 * contacts at rest are so exactly; no step is longer than the structure's fastest motion allows, or else roots are missed in
 * pairs; the dissipated energy is no state, but the limit times the way slid. Linear solvers see the band that chains have. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "../../src/damper/output.h"
#include "harness.h"
#include "methods.h"
#include "motion.h"

enum { BROKE = 2 };

/* Forces this close are the same; and how far ahead to look then, over the highest frequency. */
#define SAME 1e-10
#define MOMENT 1e-3

enum solver { BDF, ADAMS, ERK_5, ERK_8 };

/* In terms of the highest frequency; with 2 some roots of the chain go missing. */
static const double longest_step = 1.0;

struct run {
    const struct model *model;
    free_motion *motion;
    size_t n, c, stride;             /* stride 1: q, s; 2: q_0, s_0, q_1 ... */
    int coupled;                     /* R is not diagonal */
    signed char *mode;               /* [c] 0: at rest, else the direction */
    int *found;                      /* [c] */
    double *scratch, *ahead;         /* [2 n] */
    double *feq, *base;              /* [c] of contacts at rest; position at the begin of a slide */
    double rest[CONTACTS][CONTACTS]; /* R_SS^-1 of the contacts at rest, in their places; coupled only */
    double dissipated, deadline;
    size_t evaluations, events, steps;
};

/* ------------------------------------------------------------------------------------------------------------- motion */

static const double *speeds(const struct run *r, const double *y)
{
    return r->stride == 1 ? y + r->n : y + 1;
}

/* Adds friction to the accelerations of the contacts; f_eq of those at rest is a by-product. */
static void add_friction(struct run *r, double *a)
{
    const struct model *m = r->model;
    const size_t c = r->c, stride = r->stride;
    if (!r->coupled) {
        for (size_t i = 0; i < c; i++) {
            r->feq[i] = -a[i * stride];
            a[i * stride] = r->mode[i] ? a[i * stride] - r->mode[i] * limit_of(m, i) : 0.0;
        }
        return;
    }
    double f[CONTACTS] = {0.0}, slid[CONTACTS];
    for (size_t i = 0; i < c; i++) {
        f[i] = -r->mode[i] * m->limit[i];
    }
    for (size_t i = 0; i < c; i++) {
        slid[i] = a[i * stride];
        for (size_t j = 0; j < c; j++) {
            slid[i] += r->mode[j] ? delassus(m, i, j) * f[j] : 0.0;
        }
    }
    for (size_t i = 0; i < c; i++) {
        for (size_t j = 0; j < c && !r->mode[i]; j++) {
            f[i] -= r->mode[j] ? 0.0 : r->rest[i][j] * slid[j];
        }
        r->feq[i] = f[i];
    }
    for (size_t i = 0; i < c; i++) {
        a[i * stride] = r->mode[i] ? slid[i] : 0.0;
        for (size_t j = 0; j < c && r->mode[i]; j++) {
            a[i * stride] += r->mode[j] ? 0.0 : delassus(m, i, j) * f[j];
        }
    }
}

static void move(struct run *r, double t, const double *y, double *dy)
{
    double *ds = r->stride == 1 ? dy + r->n : dy + 1;
    r->motion(r->model, t, y, speeds(r, y), dy, ds, r->stride);
    add_friction(r, ds);
    r->evaluations++;
}

static int right_hand_side(realtype t, N_Vector y, N_Vector dy, void *run)
{
    const struct run *r = run;
    move(run, t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
    return r->deadline > 0.0 && cpu_seconds() > r->deadline ? -1 : 0;
}

static int roots(realtype t, N_Vector y, realtype *g, void *run)
{
    struct run *r = run;
    const double *v = speeds(r, N_VGetArrayPointer(y));
    move(r, t, N_VGetArrayPointer(y), r->scratch);
    for (size_t i = 0; i < r->c; i++) {
        g[i] = r->mode[i] ? v[i * r->stride] : limit_of(r->model, i) - fabs(r->feq[i]);
    }
    return 0;
}

/* -------------------------------------------------------------------------------------------------------------- events */

/* R_SS^-1 by Gauss-Jordan, S being the contacts at rest. */
static void find_rest(struct run *r)
{
    double a[CONTACTS][CONTACTS];
    for (size_t i = 0; i < r->c; i++) {
        for (size_t j = 0; j < r->c; j++) {
            const int both = !r->mode[i] && !r->mode[j];
            a[i][j] = both ? delassus(r->model, i, j) : i == j ? 1.0 : 0.0;
            r->rest[i][j] = i == j ? 1.0 : 0.0;
        }
    }
    for (size_t k = 0; k < r->c; k++) {
        const double pivot = a[k][k];
        for (size_t j = 0; j < r->c; j++) {
            a[k][j] /= pivot;
            r->rest[k][j] /= pivot;
        }
        for (size_t i = 0; i < r->c; i++) {
            const double part = a[i][k];
            for (size_t j = 0; j < r->c && i != k; j++) {
                a[i][j] -= part * a[k][j];
                r->rest[i][j] -= part * r->rest[k][j];
            }
        }
    }
}

static void count_way(struct run *r, size_t i, const double *q)
{
    const double at = q[i * r->stride];
    r->dissipated += r->mode[i] * limit_of(r->model, i) * (at - r->base[i]) / (r->model->kind == CHAIN ? (double)r->n : 1.0);
    r->base[i] = at;
}

static void release(struct run *r, size_t i, const double *q)
{
    r->mode[i] = r->feq[i] > 0.0 ? -1 : 1;
    r->base[i] = q[i * r->stride];
}

/* The contact at rest whose force is most in terms of its limit, and over `least` of that; c if there is none. */
static size_t over_limit(const struct run *r, double least)
{
    size_t worst = r->c;
    for (size_t i = 0; i < r->c; i++) {
        const double load = fabs(r->feq[i]) / limit_of(r->model, i);
        if (!r->mode[i] && load > least) {
            worst = i;
            least = load;
        }
    }
    return worst;
}

/* f_eq a moment later, with the modes of now: the midpoint rule, since at rest all begins with t^2. */
static void look_ahead(struct run *r, double t, const double *y, double moment)
{
    move(r, t, y, r->scratch);
    for (size_t i = 0; i < 2 * r->n; i++) {
        r->ahead[i] = y[i] + 0.5 * moment * r->scratch[i];
    }
    move(r, t + 0.5 * moment, r->ahead, r->scratch);
    for (size_t i = 0; i < 2 * r->n; i++) {
        r->ahead[i] = y[i] + moment * r->scratch[i];
    }
    move(r, t + moment, r->ahead, r->scratch);
}

/* One contact after the other: those that came to rest stay if they can, and the one most over its limit goes, until none is. */
static void decide(struct run *r, double t, double *y)
{
    double *v = r->stride == 1 ? y + r->n : y + 1;
    for (size_t i = 0; i < r->c; i++) {
        if (r->found[i] && r->mode[i]) {
            count_way(r, i, y);
            v[i * r->stride] = 0.0;
            r->mode[i] = 0;
            r->events++;
        } else if (r->found[i]) {
            r->found[i] = BROKE;
            r->events++;
        }
    }
    move(r, t, y, r->scratch);
    for (size_t i = 0; i < r->c; i++) {
        if (r->found[i] == BROKE) {
            release(r, i, y);
        }
    }
    size_t worst;
    do {
        if (r->coupled) {
            find_rest(r);
        }
        move(r, t, y, r->scratch);
        worst = over_limit(r, 1.0 + SAME);
        if (worst == r->c && over_limit(r, 1.0 - SAME) < r->c) {
            /* exactly at its limit, as on the belt at the start: it goes if a moment later it would be over it */
            look_ahead(r, t, y, MOMENT / r->model->fastest);
            worst = over_limit(r, 1.0 + SAME);
        }
        if (worst < r->c) {
            release(r, worst, y);
        }
    } while (worst < r->c);
}

/* ------------------------------------------------------------------------------------------------- CVODE and ERKStep */

struct package {
    enum solver solver;
    void *memory;
    SUNContext context;
    N_Vector y;
    SUNMatrix matrix;
    SUNLinearSolver linear;
    SUNNonlinearSolver iteration;
};

static void need_flag(int flag)
{
    if (flag < 0) {
        die("SUNDIALS: error %d", flag);
    }
}

static void create_cvode(struct package *p, struct run *r, double tolerance, double size)
{
    const sunindextype dimension = (sunindextype)(2 * r->n);
    p->memory = CVodeCreate(p->solver == BDF ? CV_BDF : CV_ADAMS, p->context);
    need_flag(CVodeInit(p->memory, right_hand_side, 0.0, p->y));
    CVodeSetErrFile(p->memory, NULL);
    CVodeSetUserData(p->memory, r);
    need_flag(CVodeSStolerances(p->memory, tolerance, tolerance * size));
    if (p->solver == ADAMS) {
        p->iteration = SUNNonlinSol_FixedPoint(p->y, 0, p->context);
        need_flag(CVodeSetNonlinearSolver(p->memory, p->iteration));
    } else {
        /* q_i and s_i depend on their neighbours */
        const int band = r->stride == 2;
        p->matrix = band ? SUNBandMatrix(dimension, 3, 3, p->context) : SUNDenseMatrix(dimension, dimension, p->context);
        p->linear = band ? SUNLinSol_Band(p->y, p->matrix, p->context) : SUNLinSol_Dense(p->y, p->matrix, p->context);
        need_flag(CVodeSetLinearSolver(p->memory, p->linear, p->matrix));
    }
    need_flag(CVodeRootInit(p->memory, (int)r->c, roots));
    CVodeSetNoInactiveRootWarn(p->memory);
    CVodeSetMaxNumSteps(p->memory, 10000000);
    CVodeSetMaxStep(p->memory, longest_step / r->model->fastest);
}

static void create_erkstep(struct package *p, struct run *r, double tolerance, double size)
{
    p->memory = ERKStepCreate(right_hand_side, 0.0, p->y, p->context);
    ERKStepSetErrFile(p->memory, NULL);
    ERKStepSetUserData(p->memory, r);
    need_flag(ERKStepSStolerances(p->memory, tolerance, tolerance * size));
    need_flag(ERKStepSetTableNum(p->memory, p->solver == ERK_5 ? ARKODE_DORMAND_PRINCE_7_4_5 : ARKODE_FEHLBERG_13_7_8));
    need_flag(ERKStepRootInit(p->memory, (int)r->c, roots));
    ERKStepSetNoInactiveRootWarn(p->memory);
    ERKStepSetMaxNumSteps(p->memory, 10000000);
    ERKStepSetMaxStep(p->memory, longest_step / r->model->fastest);
}

static void create(struct package *p, struct run *r, double tolerance, double size)
{
    need_flag(SUNContext_Create(NULL, &p->context));
    p->y = N_VNew_Serial((sunindextype)(2 * r->n), p->context);
    N_VConst(0.0, p->y);
    (p->solver == BDF || p->solver == ADAMS ? create_cvode : create_erkstep)(p, r, tolerance, size);
}

static void destroy(struct package *p)
{
    if (p->solver == BDF || p->solver == ADAMS) {
        CVodeFree(&p->memory);
    } else {
        ERKStepFree(&p->memory);
    }
    SUNLinSolFree(p->linear);
    SUNMatDestroy(p->matrix);
    SUNNonlinSolFree(p->iteration);
    N_VDestroy(p->y);
    SUNContext_Free(&p->context);
}

/* Counts start at zero again with it. */
static void restart(struct package *p, struct run *r, double t)
{
    long steps = 0;
    if (p->solver == BDF || p->solver == ADAMS) {
        CVodeGetNumSteps(p->memory, &steps);
        need_flag(CVodeReInit(p->memory, t, p->y));
    } else {
        ERKStepGetNumSteps(p->memory, &steps);
        need_flag(ERKStepReInit(p->memory, right_hand_side, t, p->y));
    }
    r->steps += (size_t)steps;
}

/* Integrates to the end of a mode or to t1; 1 if it is a mode that ended. */
static int evolve(struct package *p, struct run *r, double *t, double t1, struct outcome *o)
{
    int flag;
    if (p->solver == BDF || p->solver == ADAMS) {
        CVodeSetStopTime(p->memory, t1);
        flag = CVode(p->memory, t1, p->y, t, CV_NORMAL);
    } else {
        ERKStepSetStopTime(p->memory, t1);
        flag = ERKStepEvolve(p->memory, t1, p->y, t, ARK_NORMAL);
    }
    if (flag < 0) {
        outcome_fail(o, "SUNDIALS answers %d at t = %g", flag, *t);
    } else if (flag == CV_ROOT_RETURN) {
        (p->solver == BDF || p->solver == ADAMS ? CVodeGetRootInfo : ERKStepGetRootInfo)(p->memory, r->found);
        return 1;
    }
    return 0;
}

static void advance(struct package *p, struct run *r, double *t, double t1, struct outcome *o)
{
    while (*t < t1 && !o->failure[0]) {
        if (evolve(p, r, t, t1, o)) {
            decide(r, *t, N_VGetArrayPointer(p->y));
            restart(p, r, *t);
        }
        if (r->events > 1000 * r->c + 100000) {
            outcome_fail(o, "%zu events by t = %g", r->events, *t);
        }
    }
    for (size_t i = 0; i < r->c && r->model->kind <= CHAIN; i++) {
        count_way(r, i, N_VGetArrayPointer(p->y));
    }
}

/* ---------------------------------------------------------------------------------------------------------------- run */

static void run(const struct method *method, const struct scene *s, double tolerance, struct outcome *o)
{
    const struct model *m = &s->model;
    struct run r = {.model = m, .motion = motion_of(m), .n = m->n, .c = m->c, .deadline = o->deadline};
    struct package p = {.solver = (enum solver)method->number};
    r.stride = m->kind == CHAIN && p.solver == BDF ? 2 : 1;
    r.coupled = m->kind > CHAIN;
    r.mode = need_memory(m->c, sizeof *r.mode);
    r.found = need_memory(m->c, sizeof *r.found);
    r.scratch = need_memory(4 * m->n + 2 * m->c, sizeof *r.scratch);
    r.ahead = r.scratch + 2 * m->n;
    r.feq = r.ahead + 2 * m->n;
    r.base = r.feq + m->c;
    create(&p, &r, tolerance, s->size);
    double t = 0.0, *y = N_VGetArrayPointer(p.y), answer[2 * MODES + 1] = {0.0};
    decide(&r, t, y);
    if (s->begin > 0.0) {
        advance(&p, &r, &t, s->begin, o);
    }
    const double d = r.dissipated;
    advance(&p, &r, &t, s->end, o);
    if (s->answers == 1) {
        o->answer[0] = r.dissipated - d;
    } else {
        memcpy(answer, y, m->n * sizeof *y);
        velocities(m, s->end, y + m->n, 1, answer + m->n);
        outcome_answer(o, s, answer, 0.0);
    }
    restart(&p, &r, t);
    o->steps = r.steps;
    o->evaluations = r.evaluations;
    o->events = r.events;
    destroy(&p);
    free(r.mode);
    free(r.found);
    free(r.scratch);
}

static const struct method all[] = {
    {"sundials", "cvode-bdf", "coulomb", TOLERANCE, 0.0, NULL, run, 0.0, BDF},
    {"sundials", "cvode-adams", "coulomb", TOLERANCE, 0.0, NULL, run, 0.0, ADAMS},
    {"sundials", "arkode-5", "coulomb", TOLERANCE, 0.0, NULL, run, 0.0, ERK_5},
    {"sundials", "arkode-8", "coulomb", TOLERANCE, 0.0, NULL, run, 0.0, ERK_8},
};
const struct methods sundials_methods = {all, sizeof all / sizeof *all};
