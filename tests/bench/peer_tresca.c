/* SPDX-License-Identifier: BSD-3-Clause */
#include "peer_tresca.h"

#include <stdlib.h>

#include <Friction_cst.h>
#include <FrictionContactProblem.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <SolverOptions.h>

struct tresca {
    size_t n;
    FrictionContactProblem *problem;
    SolverOptions *options;
    double *q, *mu, *reaction, *velocity; /* [3n], [n], [3n], [3n] */
};

static const struct {
    const char *name;
    int id;
} solvers[] = {{"NSGS", SICONOS_FRICTION_3D_NSGS}, {"TFP", SICONOS_FRICTION_3D_TFP}, {"NSN_AC", SICONOS_FRICTION_3D_NSN_AC}};

const char *tresca_name(size_t solver)
{
    return solver < sizeof solvers / sizeof *solvers ? solvers[solver].name : NULL;
}

/* Where direction i of the plane stands among three. */
static size_t place(size_t i)
{
    return i / 2 * 3 + 1 + i % 2;
}

/* By columns, which makes no difference. */
static double *widen(size_t n, const double *r)
{
    const size_t size = 3 * n;
    double *m = calloc(size * size, sizeof *m);
    for (size_t i = 0; m && i < 2 * n; i++) {
        for (size_t k = 0; k < 2 * n; k++) {
            m[place(i) * size + place(k)] = r[i * 2 * n + k];
        }
        m[i / 2 * 3 * (size + 1)] = 1.0;
    }
    return m;
}

struct tresca *tresca_create(size_t solver, size_t n, const double *r, double tolerance)
{
    enum { MOST = 20000 };
    struct tresca *t = calloc(1, sizeof *t);
    double *m = widen(n, r), *q = calloc(10 * n, sizeof *q);
    if (!t || !m || !q) {
        free(t);
        free(m);
        free(q);
        return NULL;
    }
    *t = (struct tresca){.n = n, .q = q, .mu = q + 9 * n, .reaction = q + 3 * n, .velocity = q + 6 * n};
    for (size_t i = 0; i < n; i++) {
        t->q[3 * i] = -1.0;
        t->mu[i] = 1.0;
    }
    const int size = 3 * (int)n;
    t->problem = frictionContactProblem_new_with_data(3, (int)n, NM_create_from_data(NM_DENSE, size, size, m), t->q, t->mu);
    t->options = solver_options_create(solvers[solver].id);
    t->options->dparam[SICONOS_DPARAM_TOL] = tolerance;
    t->options->iparam[SICONOS_IPARAM_MAX_ITER] = MOST;
    return t;
}

void tresca_destroy(struct tresca *t)
{
    solver_options_delete(t->options);
    free(t->options);
    NM_clear(t->problem->M); /* with what widen has made */
    free(t->problem->M);
    free(t->problem); /* q and mu are not Siconos' */
    free(t->q);
    free(t);
}

int tresca_solve(struct tresca *t, const double *pull, double *f)
{
    for (size_t i = 0; i < 2 * t->n; i++) {
        t->q[place(i)] = pull[i];
    }
    const int info = fc3d_driver(t->problem, t->reaction, t->velocity, t->options);
    for (size_t i = 0; i < 2 * t->n; i++) {
        f[i] = t->reaction[place(i)];
    }
    return info;
}
