/* SPDX-License-Identifier: BSD-3-Clause */
#include "stick_slip.h"

#include <math.h>
#include <string.h>

void tribo_breakaway_start(struct breakaway *b, tribo_system *sys, double *dof, double *contact)
{
    b->some = 0;
    b->falls = tribo_system_falls(sys);
    tribo_get_static(sys->contacts, b->ratio, b->velocity);
    for (size_t i = 0; i < sys->ncontact; i++) {
        b->some |= b->ratio[i] > 1.0;
    }
    if (b->revision == tribo_system_revision(sys)) {
        return;
    }
    b->revision = tribo_system_revision(sys);
    b->steepest = 0.0;
    if (b->falls) {
        /* the largest row sum of |J| |B| diag(slopes at rest), with the largest limits of all times */
        memset(dof, 0, sys->ndof * sizeof *dof);
        tribo_system_most_limits(sys, b->kinetic);
        for (size_t i = 0; i < sys->ncontact; i++) {
            contact[i] = -tribo_breakaway_slope(b, i, 0.0);
        }
        tribo_matrix_add_sizes(&sys->response, contact, dof);
        memset(contact, 0, sys->ncontact * sizeof *contact);
        tribo_matrix_add_sizes(&sys->direction, dof, contact);
        b->steepest = tribo_largest(contact, sys->ncontact);
    }
}

/* exp(-|v|/velocity); 0 if limits drop at once. */
static double part_at(const struct breakaway *b, size_t i, double v)
{
    return b->falls ? exp(-quotient(fabs(v), b->velocity[i])) : 0.0;
}

void tribo_breakaway_take(struct breakaway *b, size_t contacts, const double *limit, const double *limit_rate)
{
    memcpy(b->kinetic, limit, contacts * sizeof *limit);
    memcpy(b->kinetic_rate, limit_rate, contacts * sizeof *limit_rate);
}

void tribo_breakaway_limits(struct breakaway *b, size_t contacts, const signed char *slip, const double *v, double *limit,
                            double *limit_rate)
{
    for (size_t i = 0; i < contacts; i++) {
        const double more = (b->ratio[i] - 1.0) * part_at(b, i, slip[i] ? v[i] : 0.0);
        limit[i] = product(1.0 + more, b->kinetic[i]);
        limit_rate[i] = product(1.0 + more, b->kinetic_rate[i]);
        tribo_breakaway_stick(b, i, b->ratio[i]);
    }
}

double tribo_breakaway_slope(const struct breakaway *b, size_t i, double v)
{
    return b->falls ? quotient(product(1.0 - b->ratio[i], b->kinetic[i]) * part_at(b, i, v), b->velocity[i]) : 0.0;
}

void tribo_breakaway_stick(struct breakaway *b, size_t i, double ratio)
{
    b->stick[i] = product(ratio, b->kinetic[i]);
    b->stick_rate[i] = product(ratio, b->kinetic_rate[i]);
}
