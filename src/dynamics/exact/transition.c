/* SPDX-License-Identifier: BSD-3-Clause */
/* The derivative of the end state of a phase of method "exact" by the start state.
 *
 * Sliding forces and loads do not depend on the state: perturbations of eta move as without these forces. The forces of contacts
 * at rest depend on the state: a perturbation of J q + G f of a held contact is a constant force on the modes. */
#include "motion.h"
#include "dynamics/system/cos_sin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void *tribo_modal_phase_keep(void *own, double tau)
{
    struct modal *h = ((struct exact *)own)->h->modal;
    (void)tau;
    h->users++;
    return h;
}

void tribo_modal_phase_release(void *phase)
{
    tribo_modal_free(phase);
}

/* tribo_powers_carry for a structure with modes; work [10 modes][columns] + [4 modes]. */
static void carry_modes(const struct modal *h, double tau, size_t columns, const double *pull, double *eta, double *rate,
                        double *work)
{
    const size_t m = h->modes, c = columns, block = m * c;
    double *vel = work, *acc = vel + block, *zr = acc + block, *zi = zr + 2 * block, *wr = zi + 2 * block, *wi = wr + 2 * block,
           *turn = wi + 2 * block;
    tribo_modal_settle(h, c, pull, eta, rate, vel, acc);
    tribo_modal_split(h, c, eta, rate, zr, zi);
    if (h->stiff) {
        tribo_follow_drift(h, c, zr, zi, rate);
    }
    tribo_cos_sin_all(tau, h->exponents, h->li, turn, turn + 2 * m);
    for (size_t p = 0, at = 0; p < h->exponents; p++) {
        const double size = h->lr[p] != 0.0 ? exp(h->lr[p] * tau) : 1.0, re = size * turn[p], im = size * turn[2 * m + p];
        for (size_t j = 0; j < c; j++, at++) {
            /* z becomes w - z, w that at tau, beside w'. */
            const double r = re * zr[at] - im * zi[at], i = re * zi[at] + im * zr[at];
            wr[at] = h->lr[p] * r - h->li[p] * i;
            wi[at] = h->lr[p] * i + h->li[p] * r;
            zr[at] = r - zr[at];
            zi[at] = i - zi[at];
        }
    }
    for (size_t at = 0; at < m * c; at++) {
        const double drift = vel[at] + (tribo_modal_drifts(h, at / c) ? rate[at] : 0.0);
        eta[at] = tau * (drift + 0.5 * tau * acc[at]);
        rate[at] = drift + tau * acc[at];
    }
    tribo_modal_join(h, c, zr, zi, eta);
    tribo_modal_join(h, c, wr, wi, rate);
}

int tribo_modal_transition(void *own, const void *phase, double tau, size_t columns, double *v, const struct source *source)
{
    const struct exact *x = own;
    const struct modal *h = phase ? phase : x->h->modal;
    tribo_system *sys = x->sys;
    const size_t n = sys->ndof, m = h->modes, c = columns, block = n * c, wide = tribo_modal_wide(h->within);
    const size_t ways = 2 * sys->ncontact * c;
    double *moved = v + h->within[0] * c;
    double *eta = malloc((13 * block + 2 * ways + 4 * n + 1) * sizeof *eta), *rate = eta + block;
    double *pull = rate + block, *way = pull + block, *force = way + ways / 2, *work = way + ways;
    if (!eta) {
        return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for %zu perturbation%s", columns, plural(columns));
    }
    memset(eta, 0, (3 * block + ways) * sizeof *eta);
    tribo_multiply_add(m, wide, c, 1.0, h->psi, moved, eta);
    tribo_multiply_add(m, wide, c, 1.0, h->psi, moved + block, rate);
    if (h->stiff) {
        for (size_t k = 0; k < sys->compliance.count; k++) {
            memcpy(way + sys->compliance.contact[k] * c, v + (2 * n + k) * c, c * sizeof *v);
        }
        tribo_follow_pull(h, sys, c, v, way, eta, pull, work);
    } else {
        /* constant forces on the modes: -on (J q + G f) of contacts that hold; on times the force of others, f of compliant
         * ones */
        tribo_system_find_ways(sys, c, v, force, way);
        for (size_t i = 0; i < sys->ncontact * c; i++) {
            way[i] = h->key[i / c] == KEY_HOLDS ? -way[i] : force[i] + (source ? source->force[i] : 0.0);
        }
        tribo_multiply_transposed_add(sys->ncontact, m, c, h->on, way, pull);
    }
    if (h->powers) {
        tribo_powers_carry(h, tau, c, pull, eta, rate, work, NULL);
    } else {
        carry_modes(h, tau, c, pull, eta, rate, work);
    }
    const int status = source && source->inertia ? tribo_modal_source(x, tau, c, source, eta, rate) : TRIBO_OK;
    memset(v + block, 0, block * sizeof *v);
    tribo_multiply_transposed_add(m, wide, c, h->phi, eta, moved);
    tribo_multiply_transposed_add(m, wide, c, h->phi, rate, moved + block);
    for (size_t k = 0; k < sys->compliance.count; k++) {
        size_t row;
        const double by = tribo_follow_spring(sys, h, sys->compliance.contact[k], &row);
        tribo_multiply_add(by != 0.0, m, c, by, h->on + row * m, eta, v + 2 * block + k * c);
    }
    free(eta);
    return status;
}
