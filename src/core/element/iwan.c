/* SPDX-License-Identifier: BSD-3-Clause */
/* Parallel sliders in Segalman's form (2005) of Iwan's (1966). From rest the force is the curve
 *     B(u) = kt u (1 - (u/most)^(chi + 1)/((chi + 2)(1 + beta))), u < most;  fs beyond,
 * most = fs (1 + beta)/(kt (beta + (chi + 1)/(chi + 2))). After a turn at (x_r, p_r) it is p_r +- 2 B(|x - x_r|/2) (Masing),
 * until the loop closes: then the motion continues on the curve that the loop left. The turns of loops that are open are the
 * state. */
#include "element.h"

enum { PARAMETERS = 4, HEAD = 3, MOST_ROOM = 1000000 };

struct iwan {
    double kt, chi, weight; /* weight: (chi + 2)(1 + beta) */
    double fs, most;
};

/* B(u), u >= 0; *slope: B'(u). */
static double curve(const struct iwan *p, double u, double *slope)
{
    if (u >= p->most) {
        *slope = 0.0;
        return p->fs;
    }
    const double part = pow(u / p->most, p->chi + 1.0) / p->weight;
    *slope = p->kt * (1.0 - (p->chi + 2.0) * part);
    return p->kt * u * (1.0 - part);
}

static int check_iwan(size_t n, const double *parameter)
{
    static const int range[PARAMETERS] = {POSITIVE, NONNEGATIVE, FINITE, NONNEGATIVE};
    int status = tribo_check_elements(parameter, n, PARAMETERS, range);
    for (size_t i = 0; !status && i < n; i++) {
        const double chi = parameter[PARAMETERS * i + 2];
        status = chi <= -1.0 || chi > 100.0 ? TRIBO_ERR_RANGE : TRIBO_OK;
    }
    return status;
}

/* Returns 1 if dx is against the direction state[2] of the last motion. */
static int turns(const double *state, double dx)
{
    return dx * state[2] < 0.0;
}

/* Checks that turns are whole numbers up to room, and that a further turn has room. */
static int check_state(size_t n, size_t room, const double *dz, const double *state)
{
    for (size_t i = 0; i < n; i++, state += HEAD + 2 * room) {
        if (!(state[1] >= 0.0 && state[1] <= (double)room) || state[1] != floor(state[1])) {
            return TRIBO_ERR_RANGE;
        }
        if (state[1] == (double)room && turns(state, dz[i])) {
            return TRIBO_ERR_SIZE;
        }
    }
    return TRIBO_OK;
}

/* The force at x on the branch after turn [count][2]: x_r, p_r of the open turns; *slope: its derivative. */
static double branch(const struct iwan *p, const double *turn, size_t count, double x, double *slope)
{
    if (!count) {
        return (x < 0.0 ? -1.0 : 1.0) * curve(p, fabs(x), slope);
    }
    const double *last = turn + 2 * (count - 1), way = x - last[0];
    return last[1] + (way < 0.0 ? -2.0 : 2.0) * curve(p, 0.5 * fabs(way), slope);
}

/* Moves a state by dx; returns the force of the sliders, of the sign of x; *slope: its derivative. */
static double move_sliders(const struct iwan *p, double dx, double *state, double *slope)
{
    double *turn = state + HEAD, x = state[0];
    size_t count = (size_t)state[1];
    if (turns(state, dx)) {
        turn[2 * count + 1] = branch(p, turn, count, x, slope);
        turn[2 * count] = x;
        count++;
    }
    const double sign = dx != 0.0 ? (dx < 0.0 ? -1.0 : 1.0) : state[2];
    x += dx;
    /* Loops that close: at the turn before the last one, or, after one turn, at the other end of the curve from rest. */
    while (count >= 2 && sign * (x - turn[2 * (count - 2)]) >= 0.0) {
        count -= 2;
    }
    if (count == 1 && sign * (x + turn[0]) >= 0.0) {
        count = 0;
    }
    if (fabs(x) >= p->most) { /* all slide: the middle of the curve follows */
        x = x < 0.0 ? -p->most : p->most;
        count = 0;
    }
    state[0] = x;
    state[1] = (double)count;
    state[2] = sign;
    return branch(p, turn, count, x, slope);
}

int tribo_iwan_force(size_t n, size_t room, const double *dz, const double *parameter, double *state, double *f, double *df_dz)
{
    int status = room > MOST_ROOM || n >= SIZE_MAX / (16 * (HEAD + 2 * MOST_ROOM)) ? TRIBO_ERR_SIZE : TRIBO_OK;
    status = status ? status : tribo_check_element(dz, n, FINITE);
    status = status ? status : check_iwan(n, parameter);
    status = status ? status : tribo_check_finite(NULL, "state", state, n * (HEAD + 2 * room));
    status = status ? status : n && !f ? TRIBO_ERR_NULL : check_state(n, room, dz, state);
    for (size_t i = 0; !status && i < n; i++) {
        const double *k = parameter + PARAMETERS * i, kt = k[0], fs = k[1], chi = k[2], beta = k[3];
        const double most = fs * (1.0 + beta) / (kt * (beta + (chi + 1.0) / (chi + 2.0)));
        const struct iwan p = {kt, chi, (chi + 2.0) * (1.0 + beta), fs, most};
        double slope;
        f[i] = -move_sliders(&p, dz[i], state + i * (HEAD + 2 * room), &slope);
        if (df_dz) {
            df_dz[i] = -slope;
        }
    }
    return status;
}
