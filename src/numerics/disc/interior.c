/* SPDX-License-Identifier: BSD-3-Clause */
/* A primal-dual interior-point method (Boyd and Vandenberghe 2004, Convex Optimization, section 11.7): it begins in the middle of
 * all lenses, takes a few dozen factorizations, and ends so near the solution that the place of each contact shows. Each disc is
 * a constraint |x|^2 <= 1, x = y or y + c, with room (1 - |x|^2)/2 and multiplier press. */
#include "disc_qp.h"

#include <string.h>

#include "common/real.h"

enum { ROUNDS = 100 };

/* press exceeds aim/room by this factor at most. Where a step along a rim leaves little room, aim/room is far beyond the
 * pressure: press falls below it to the part TOO_LITTLE. */
#define FAR_OFF 100.0
#define TOO_LITTLE 1e-6

/* Part of the way to the first rim that a step takes. */
#define NEARLY 0.99

/* The least room: less may be rounding. */
#define NO_ROOM 1e-20

/* Finds x and room of all discs at y. Returns the average of room times press. */
static double find_rooms(struct disc_qp *p)
{
    double sum = 0.0;
    for (struct disc *d = p->disc; d < p->disc + p->discs; d++) {
        for (size_t k = 0; k < p->wide[d->at]; k++) {
            d->x[k] = p->y[d->at + k] + (d->shifted ? p->shift[d->at + k] : 0.0);
        }
        /* without cancellation where y is near the rim in one direction only */
        const double length = tribo_length(p->wide[d->at], d->x);
        d->room = greater(0.5 * (1.0 - length) * (1.0 + length), NO_ROOM);
        sum += d->room * d->press;
    }
    return sum / (double)p->discs;
}

/* aim [size] of p = the change of y towards room times press = aim. */
static void find_step(struct disc_qp *p, double aim)
{
    tribo_disc_gradients(p);
    memset(p->place, LENS_INSIDE, p->size);
    tribo_disc_list(p);
    tribo_disc_assemble(p);
    for (const struct disc *d = p->disc; d < p->disc + p->discs; d++) {
        for (size_t k = 0; k < p->wide[d->at]; k++) {
            const size_t row = tribo_disc_own(p, d->at + k) - k;
            p->gradient[d->at + k] += aim / d->room * d->x[k];
            *tribo_disc_entry(p, row + k) += d->press;
            for (size_t j = 0; j < p->wide[d->at]; j++) {
                *tribo_disc_entry(p, row + j) += d->press / d->room * d->x[k] * d->x[j];
            }
        }
    }
    tribo_disc_factorize(p);
    tribo_disc_follow(p, p->gradient, p->aim);
}

void tribo_disc_interior(struct disc_qp *p, double least)
{
    double most = 0.0, stiffest = 0.0, length = 1.0;
    p->discs = 0;
    for (size_t i = 0; i < p->size; i++) {
        p->y[i] = -0.5 * p->shift[i];
    }
    tribo_disc_gradients(p);
    for (size_t i = 0; i < p->size; i += p->wide[i]) {
        stiffest = greater(stiffest, 1.0 / lesser(p->gain[i], p->gain[i + p->wide[i] - 1]));
        most = greater(most, greater(stiffest, tribo_length(p->wide[i], p->gradient + i)));
        p->disc[p->discs++] = (struct disc){.at = i};
        p->disc[p->discs++] = (struct disc){.at = i, .shifted = 1};
    }
    find_rooms(p);
    for (struct disc *d = p->disc; d < p->disc + p->discs; d++) {
        d->press = most / d->room;
    }
    for (int round = 0; round < ROUNDS; round++) {
        const double average = find_rooms(p), aim = (length > 0.9 ? 0.1 : length > 0.2 ? 0.5 : 1.0) * average;
        if (!(average > least * stiffest)) {
            break;
        }
        find_step(p, aim);
        /* the part of step, and of the changes of press with it, up to the first rim or press of 0 */
        length = 1.0 / NEARLY;
        for (struct disc *d = p->disc; d < p->disc + p->discs; d++) {
            double turn = 0.0;
            for (size_t k = 0; k < p->wide[d->at]; k++) {
                turn += d->x[k] * p->aim[d->at + k];
            }
            d->change = aim / d->room - d->press + product(d->press / d->room, turn);
            length = lesser(length, tribo_way_to_rim(p->wide[d->at], d->x, p->aim + d->at));
            length = d->change < 0.0 ? lesser(length, quotient(d->press, -d->change)) : length;
        }
        length *= NEARLY;
        if (!(length > 1e-12)) {
            break;
        }
        /* y and press go by length along their steps. A press far from aim/room would let y cross the disc again and again. */
        for (size_t i = 0; i < p->size; i++) {
            p->y[i] += length * p->aim[i];
        }
        find_rooms(p);
        for (struct disc *d = p->disc; d < p->disc + p->discs; d++) {
            d->press = clamp(d->press + length * d->change, TOO_LITTLE * (aim / d->room), FAR_OFF * (aim / d->room));
        }
    }
}
