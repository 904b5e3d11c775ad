/* SPDX-License-Identifier: BSD-3-Clause */
/* A primal-dual interior-point method (Boyd and Vandenberghe 2004, Convex Optimization, section 11.7): it begins in the middle of
 * all lenses, takes a few dozen factorizations, and ends so near the solution that the place of each contact shows. Each disc is
 * a constraint |y + o|^2 <= 1, o = 0 or c, with room (1 - |y + o|^2)/2 and multiplier press. */
#include "disc_qp.h"

#include <math.h>
#include <string.h>

#include "common/real.h"

enum { DISCS = 2, ROUNDS = 100 };

/* press and aim/room differ by this factor at most. */
#define FAR_OFF 100.0

/* The method ends when the average of room times press falls below this part of the largest stiffness. */
#define NEXT_TO_NOTHING 1e-13

/* Part of the way to the first rim that a step takes. */
#define NEARLY 0.99

/* The least room: less may be rounding. */
#define NO_ROOM 1e-20

/* Returns y_k + o_k of disc d of the contact at i. */
static double offset(const struct disc_qp *p, size_t i, size_t k, int d)
{
    return p->y[i + k] + (d ? p->shift[i + k] : 0.0);
}

/* Returns the room of disc d, as (1 - |x|)(1 + |x|)/2, without cancellation where y is near the rim in one direction only. */
static double room_of(const struct disc_qp *p, size_t i, int d)
{
    double x[2];
    for (size_t k = 0; k < p->wide[i]; k++) {
        x[k] = offset(p, i, k, d);
    }
    const double length = tribo_length(p->wide[i], x);
    return greater(0.5 * (1.0 - length) * (1.0 + length), NO_ROOM);
}

/* Returns the average of room times press. */
static double average(const struct disc_qp *p)
{
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < p->size; i += p->wide[i]) {
        for (int d = 0; d < DISCS; d++) {
            sum += room_of(p, i, d) * p->press[DISCS * i + (size_t)d];
            count += 1.0;
        }
    }
    return sum / count;
}

/* step = the change of y towards room times press = aim. */
static void find_step(struct disc_qp *p, double aim)
{
    const size_t n = p->size;
    tribo_disc_gradients(p);
    memcpy(p->factor.matrix, p->s, n * n * sizeof *p->factor.matrix);
    for (size_t i = 0; i < n; i += p->wide[i]) {
        for (int d = 0; d < DISCS; d++) {
            const double press = p->press[DISCS * i + (size_t)d], room = room_of(p, i, d);
            for (size_t k = 0; k < p->wide[i]; k++) {
                p->gradient[i + k] += aim / room * offset(p, i, k, d);
                p->factor.matrix[(i + k) * (n + 1)] += press;
                for (size_t j = 0; j < p->wide[i]; j++) {
                    p->factor.matrix[(i + k) * n + i + j] += press / room * offset(p, i, k, d) * offset(p, i, j, d);
                }
            }
        }
    }
    tribo_disc_factorize(p, n);
    for (size_t i = 0; i < n; i++) {
        p->step[i] = -p->gradient[i];
    }
    tribo_disc_backsolve(p);
}

/* Returns the change of the press of disc d with step. */
static double press_step(const struct disc_qp *p, size_t i, int d, double aim)
{
    const double press = p->press[DISCS * i + (size_t)d], room = room_of(p, i, d);
    double turn = 0.0;
    for (size_t k = 0; k < p->wide[i]; k++) {
        turn += offset(p, i, k, d) * p->step[i + k];
    }
    return aim / room - press + product(press / room, turn);
}

/* Returns the part of step, and of the changes of press, that a step takes. */
static double longest_step(const struct disc_qp *p, double aim)
{
    double length = 1.0 / NEARLY;
    for (size_t i = 0; i < p->size; i += p->wide[i]) {
        for (int d = 0; d < DISCS; d++) {
            const double change = press_step(p, i, d, aim);
            double x[2];
            for (size_t k = 0; k < p->wide[i]; k++) {
                x[k] = offset(p, i, k, d);
            }
            length = lesser(length, tribo_way_to_rim(p->wide[i], x, p->step + i));
            length = change < 0.0 ? lesser(length, quotient(p->press[DISCS * i + (size_t)d], -change)) : length;
        }
    }
    return NEARLY * length;
}

void tribo_disc_interior(struct disc_qp *p)
{
    double most = 0.0, stiffest = 0.0;
    for (size_t i = 0; i < p->size; i++) {
        p->y[i] = -0.5 * p->shift[i];
    }
    tribo_disc_gradients(p);
    for (size_t i = 0; i < p->size; i += p->wide[i]) {
        stiffest = greater(stiffest, 1.0 / lesser(p->gain[i], p->gain[i + p->wide[i] - 1]));
        most = greater(most, greater(stiffest, tribo_length(p->wide[i], p->gradient + i)));
    }
    for (size_t i = 0; i < p->size; i += p->wide[i]) {
        for (int d = 0; d < DISCS; d++) {
            p->press[DISCS * i + (size_t)d] = most / room_of(p, i, d);
        }
    }
    const double enough = NEXT_TO_NOTHING * stiffest;
    double length = 1.0;
    for (int round = 0; round < ROUNDS; round++) {
        const double product = average(p), aim = (length > 0.9 ? 0.1 : length > 0.2 ? 0.5 : 1.0) * product;
        if (!(product > enough)) {
            break;
        }
        find_step(p, aim);
        length = longest_step(p, aim);
        if (!(length > 1e-12)) {
            break;
        }
        /* y and press go by length along their steps. A press far from aim/room would let y cross the disc again and again. */
        for (size_t i = 0; i < p->size; i += p->wide[i]) {
            for (int d = 0; d < DISCS; d++) {
                p->press[DISCS * i + (size_t)d] += length * press_step(p, i, d, aim);
            }
            for (size_t k = i; k < i + p->wide[i]; k++) {
                p->y[k] += length * p->step[k];
            }
            for (int d = 0; d < DISCS; d++) {
                const double press = aim / room_of(p, i, d);
                p->press[DISCS * i + (size_t)d] = clamp(p->press[DISCS * i + (size_t)d], press / FAR_OFF, FAR_OFF * press);
            }
        }
    }
}
