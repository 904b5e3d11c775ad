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

/* pull [modes][columns] = -sum of on (J q + G f) over the contacts that hold: constant forces on the modes. row [columns] is
 * workspace. */
static void find_pull(const struct modal *h, const tribo_system *sys, size_t columns, const double *v, double *pull, double *row)
{
    const struct compliance *g = &sys->compliance;
    const struct matrix *direction = &sys->direction;
    memset(pull, 0, h->modes * columns * sizeof *pull);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double *on = h->on + i * h->modes;
        if (h->key[i] != 2 || tribo_largest(on, h->modes) == 0.0) {
            continue;
        }
        memset(row, 0, columns * sizeof *row);
        for (size_t k = direction->first[i]; k < direction->first[i + 1]; k++) {
            tribo_add(row, direction->val[k], v + direction->col[k] * columns, columns);
        }
        for (size_t k = 0; tribo_is_compliant(g, i) && k < g->count; k++) {
            const double entry = tribo_compliance_entry(g, sys->ncontact, i, g->contact[k]);
            tribo_add(row, entry, v + (2 * sys->ndof + k) * columns, columns);
        }
        for (size_t k = 0; k < h->modes; k++) {
            tribo_add(pull + k * columns, -on[k], row, columns);
        }
    }
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

int tribo_modal_transition(void *own, const void *phase, double tau, size_t columns, double *v)
{
    const struct modal *h = phase;
    tribo_system *sys = ((struct exact *)own)->sys;
    const size_t n = h->n, m = h->modes, c = columns, block = n * c;
    double *eta = calloc(13 * block + c + 4 * n + 1, sizeof *eta), *rate = eta + block, *pull = rate + block;
    double *row = pull + block, *work = row + c;
    if (!eta) {
        return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for %zu perturbation%s", columns, plural(columns));
    }
    tribo_multiply_transposed_add(n, m, c, h->psi, v, eta);
    tribo_multiply_transposed_add(n, m, c, h->psi, v + block, rate);
    find_pull(h, sys, c, v, pull, row);
    (h->powers ? tribo_powers_carry : carry_modes)(h, tau, c, pull, eta, rate, work);
    memset(v + block, 0, block * sizeof *v);
    tribo_multiply_add(n, m, c, 1.0, h->phi, eta, v);
    tribo_multiply_add(n, m, c, 1.0, h->phi, rate, v + block);
    for (size_t k = 0; k < sys->compliance.count; k++) {
        const size_t i = sys->compliance.contact[k];
        for (size_t l = 0; h->key[i] == 2 && l < m; l++) {
            tribo_add(v + 2 * block + k * c, h->on[i * m + l], eta + l * c, c);
        }
    }
    free(eta);
    return TRIBO_OK;
}
