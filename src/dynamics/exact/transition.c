/* SPDX-License-Identifier: BSD-3-Clause */
/* The derivative of the end state of a phase of method "exact" by the start state.
 *
 * Sliding forces and loads do not depend on the state: perturbations of eta move as without these forces. The forces of contacts
 * at rest depend on the state: a perturbation of J q + G f of a held contact is a constant force on the modes. */
#include "modal.h"
#include "dynamics/system/cos_sin.h"
#include "dynamics/periodic/variation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* [modes][columns]: eta, rate = eta', pull = constant force on eta, change = eta at the start; [exponents][columns]:
 * z = zr - i zi, with z' `next` numbers later; row [columns] workspace. */
struct transition {
    const struct modal_phase *phase;
    const struct modal *h;
    const tribo_system *sys;
    size_t columns, block, next; /* block: distance from displacements to velocities */
    double *eta, *rate, *pull, *change, *zr, *zi, *row;
};

struct modal_phase *tribo_modal_phase_create(struct modal *h, double tau)
{
    struct modal_phase *phase = malloc(sizeof *phase + 2 * h->exponents * sizeof *phase->re);
    if (!phase) {
        return NULL;
    }
    h->users++;
    phase->h = h;
    phase->tau = tau;
    phase->im = phase->re + h->exponents;
    for (size_t p = 0; p < h->exponents; p++) {
        const double size = h->lr[p] != 0.0 ? exp(h->lr[p] * tau) : 1.0;
        tribo_turn(h->li[p] * tau, &phase->re[p], &phase->im[p]);
        phase->re[p] *= size;
        phase->im[p] *= size;
    }
    return phase;
}

void tribo_modal_phase_free(void *phase)
{
    if (phase) {
        tribo_modal_free(((struct modal_phase *)phase)->h);
        free(phase);
    }
}

/* Sets eta and rate from v, and pull = -sum of on (J q + G f) over the contacts that hold. */
static void transition_split(const struct transition *x, const double *v)
{
    const struct modal *h = x->h;
    const struct compliance *g = &x->sys->compliance;
    const size_t c = x->columns, m = h->modes;
    memset(x->eta, 0, 3 * x->block * sizeof *x->eta);
    tribo_multiply_transposed_two(h->n, m, c, h->psi, v, x->block, x->eta, x->block);
    for (size_t i = 0; i < x->sys->ncontact; i++) {
        const double *on = h->on + i * m;
        if (h->key[i] != 2 || tribo_largest(on, m) == 0.0) {
            continue;
        }
        tribo_contact_row(x->sys, i, v, c, x->row);
        for (size_t k = 0; tribo_is_compliant(g, i) && k < g->count; k++) {
            const double entry = tribo_compliance_entry(g, x->sys->ncontact, i, g->contact[k]);
            tribo_add(x->row, entry, v + 2 * x->block + k * c, c);
        }
        for (size_t k = 0; k < m; k++) {
            tribo_add(x->pull + k * c, -on[k], x->row, c);
        }
    }
}

/* Moves modes without coupling by tau: (eta, eta')(tau) = t (eta, eta')(0), by the exponents of a mode, beside the part by
 * pull. */
static void move_alone(const struct transition *x)
{
    const struct modal *h = x->h;
    const double tau = x->phase->tau;
    for (size_t k = 0, p = 0; k < h->modes; k++) {
        double *eta = x->eta + k * x->columns, *rate = x->rate + k * x->columns, t[] = {0.0, 0.0, 0.0, 0.0};
        const double *pull = x->pull + k * x->columns;
        const double place = h->omega2[k] != 0.0 ? 1.0 / h->omega2[k] : 0.0;
        const double speed = h->omega2[k] == 0.0 && !h->drifts[k] ? 1.0 / h->damping[k] : 0.0, push = h->drifts[k] ? tau : 0.0;
        for (; p < h->exponents && h->owner[p] == k; p++) {
            const double re = x->phase->re[p], im = x->phase->im[p];
            const double fr = h->lr[p] * re - h->li[p] * im, fi = h->lr[p] * im + h->li[p] * re;
            t[0] += re * h->ar[p] - im * h->ai[p];
            t[1] += re * h->br[p] - im * h->bi[p];
            t[2] += fr * h->ar[p] - fi * h->ai[p];
            t[3] += fr * h->br[p] - fi * h->bi[p];
        }
        if (h->drifts[k]) {
            t[0] = t[3] = 1.0;
            t[1] = tau;
        }
        for (size_t j = 0; j < x->columns; j++) {
            const double off = place * pull[j], vel = speed * pull[j], q = eta[j] - off, u = rate[j] - vel;
            eta[j] = off + vel * tau + 0.5 * push * tau * pull[j] + t[0] * q + t[1] * u;
            rate[j] = vel + push * pull[j] + t[2] * q + t[3] * u;
        }
    }
}

/* eta += factor pull/omega^2; pull/omega^2 is eta at rest. */
static void transition_add_rest(const struct transition *x, double factor)
{
    for (size_t k = 0; k < x->h->modes; k++) {
        tribo_add(x->eta + k * x->columns, factor / x->h->omega2[k], x->pull + k * x->columns, x->columns);
    }
}

/* Moves modes that damping couples, all with omega > 0: zr - i zi = z at tau, from eta and rate at the start; the same for z'.
 * z = a eta + b eta' with a = -b omega^2/lambda, since b is a left eigenvector: only b is read, half as much data. */
static void move_together(const struct transition *x)
{
    const struct modal *h = x->h;
    const size_t m = h->modes, c = x->columns;
    transition_add_rest(x, -1.0);
    memset(x->zr, 0, 2 * x->next * sizeof *x->zr);
    memset(x->zi, 0, 2 * x->next * sizeof *x->zi);
    for (size_t k = 0; k < m; k++) {
        for (size_t j = 0; j < c; j++) {
            x->eta[k * c + j] *= h->omega2[k];
        }
    }
    tribo_multiply_transposed_two(m, h->exponents, c, h->br, x->eta, x->block, x->zr, x->next);
    tribo_multiply_transposed_two(m, h->exponents, c, h->bi, x->eta, x->block, x->zi, x->next);
    for (size_t p = 0; p < h->exponents; p++) {
        const double re = x->phase->re[p], im = x->phase->im[p];
        double *zr = x->zr + p * c, *zi = x->zi + p * c, *rate_r = zr + x->next, *rate_i = zi + x->next;
        const double lr = h->lr[p], li = h->li[p], square = lr * lr + li * li;
        for (size_t j = 0; j < c; j++) {
            const double r = rate_r[j] - (lr * zr[j] + li * zi[j]) / square, i = rate_i[j] - (lr * zi[j] - li * zr[j]) / square;
            zr[j] = re * r - im * i;
            zi[j] = -(im * r + re * i);
            rate_r[j] = lr * zr[j] + li * zi[j];
            rate_i[j] = -(li * zr[j] - lr * zi[j]);
        }
    }
    memset(x->eta, 0, 2 * x->block * sizeof *x->eta);
    tribo_multiply_transposed_two(h->exponents, m, c, h->rr, x->zr, x->next, x->eta, x->block);
    tribo_multiply_transposed_two(h->exponents, m, c, h->ri, x->zi, x->next, x->eta, x->block);
    transition_add_rest(x, 1.0);
}

int tribo_modal_transition(const struct modal_phase *phase, const tribo_system *sys, size_t columns, double *v)
{
    const size_t block = sys->ndof * columns;
    const struct modal *h = phase->h;
    double *work = malloc((12 * block + columns + 1) * sizeof *work);
    if (!work) {
        return 0;
    }
    const struct transition x = {.phase = phase,
                                 .h = h,
                                 .sys = sys,
                                 .columns = columns,
                                 .block = block,
                                 .next = 2 * block,
                                 .eta = work,
                                 .rate = work + block,
                                 .pull = work + 2 * block,
                                 .change = work + 3 * block,
                                 .zr = work + 4 * block,
                                 .zi = work + 8 * block,
                                 .row = work + 12 * block};
    transition_split(&x, v);
    memcpy(x.change, x.eta, block * sizeof *x.change);
    if (h->coupling) {
        move_together(&x);
    } else {
        move_alone(&x);
    }
    memset(v + block, 0, block * sizeof *v);
    tribo_add(x.eta, -1.0, x.change, h->modes * columns);
    tribo_multiply_transposed_two(h->modes, h->n, columns, h->phi, x.eta, block, v, block);
    for (size_t k = 0; k < sys->compliance.count; k++) {
        const size_t i = sys->compliance.contact[k];
        const double *on = h->on + i * h->modes;
        for (size_t l = 0; h->key[i] == 2 && l < h->modes; l++) {
            tribo_add(v + 2 * block + k * columns, on[l], x.eta + l * columns, columns);
        }
    }
    free(work);
    return 1;
}
