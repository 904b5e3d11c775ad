/* SPDX-License-Identifier: BSD-3-Clause */
/* Quinn's three reference systems. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "common/layout.h"
#include "model.h"

/* Creates the system of the matrices of m, which are complete if done = 1, and frees these. limit, load, motion [ncontact], load
 * and motion with cos(omega t), or NULL. Returns a status. */
static int quinn_build(tribo_system **sys, tribo_model *m, int done, const double *limit, double omega, const double *load,
                       const double *motion)
{
    tribo_system *s = NULL;
    int status = done ? tribo_model_build(m, &s) : TRIBO_ERR_MEMORY;
    tribo_model_free(m);
    status = status ? status : tribo_set_limit(s->contacts, limit);
    if (!status) {
        tribo_get_limit(s->contacts, s->loads.given_limit);
    }
    status = status || !load ? status : tribo_system_add_load(s, omega, NULL, load);
    status = status || !motion ? status : tribo_system_add_base_motion(s, omega, NULL, motion);
    if (status) {
        tribo_system_destroy(s);
    } else {
        *sys = s;
    }
    return status;
}

/* quinn_build for n <= 2 bodies with masses 1 and n contacts; stiffness, direction [n][n]. */
static int build_dense(tribo_system **sys, size_t n, const double *stiffness, const double *direction, const double *limit,
                       double omega, const double *load, const double *motion)
{
    tribo_model m = {.ndof = n, .ncontact = n};
    if (!sys || !isfinite(stiffness[n * n - 1])) {
        return sys ? TRIBO_ERR_NOT_FINITE : TRIBO_ERR_NULL;
    }
    const int done = tribo_matrix_diagonal(&m.mass, n, NULL) && tribo_matrix_from_dense(&m.stiffness, n, n, stiffness) &&
                     tribo_matrix_from_dense(&m.direction, n, n, direction);
    return quinn_build(sys, &m, done, limit, omega, load, motion);
}

int tribo_system_oscillator(tribo_system **sys, double limit, double alpha, double omega)
{
    const double one = 1.0;
    return build_dense(sys, 1, &one, &one, &limit, omega, &alpha, NULL);
}

int tribo_system_belt(tribo_system **sys, double kappa, double limit1, double limit2, double speed, double omega)
{
    const double stiffness[] = {1.0, 0.0, 0.0, kappa}, direction[] = {1.0, 0.0, -1.0, 1.0};
    const double limit[] = {limit1, limit2}, motion[] = {speed, 0.0};
    return build_dense(sys, 2, stiffness, direction, limit, omega, NULL, motion);
}

/* each [n] = whole/n, but 3/4 of whole/n for the last block: the paper's last equation is 4/3 times an equation with symmetric
 * stiffness, so the last block has 3/4 of the mass and friction of the others. */
static void share_out(double *each, size_t n, double whole)
{
    for (size_t i = 0; i < n; i++) {
        each[i] = (i + 1 < n ? 1.0 : 0.75) * whole / (double)n;
    }
}

/* Springs n between neighbours, 2 n between the last block and the ground. */
int tribo_system_chain(tribo_system **sys, size_t n, double limit, double alpha, double omega)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (n < 2 || n > SIZE_MAX / 1024) {
        return TRIBO_ERR_SIZE;
    }
    tribo_model m = {.ndof = n, .ncontact = n};
    struct triplets t = {0};
    const double spring = (double)n;
    double *mass, *bound, *load;
    const int room = ALLOCATE(ARRAY(mass, n), ARRAY(bound, n), ARRAY(load, n)) != NULL;
    for (size_t i = 0; room && i < n; i++) {
        for (size_t j = i ? i - 1 : 0; j < n && j <= i + 1; j++) {
            tribo_triplets_put(&t, i, j, j != i ? -spring : i == 0 ? spring : i + 1 < n ? 2.0 * spring : 3.0 * spring);
        }
    }
    if (room) {
        share_out(mass, n, 1.0);
        share_out(bound, n, limit);
        load[0] = alpha;
    }
    const int done = tribo_triplets_finish(&t, n, n, &m.stiffness) && room && tribo_matrix_diagonal(&m.mass, n, mass) &&
                     tribo_matrix_diagonal(&m.direction, n, NULL);
    const int status = quinn_build(sys, &m, done, bound, omega, load, NULL);
    if (!status) {
        (*sys)->tally[n - 1] = 4.0 / 3.0; /* the paper counts the friction of every block in full */
    }
    free(mass);
    return status;
}
