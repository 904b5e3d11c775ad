/* SPDX-License-Identifier: BSD-3-Clause */
/* Parallel sliders in Segalman's form (2005) of Iwan's (1966). From rest the force is the curve
 *     B(u) = kt u (1 - (u/most)^(chi + 1)/((chi + 2)(1 + beta))), u < most;  fs beyond,
 * most = fs (1 + beta)/(kt (beta + (chi + 1)/(chi + 2))). After a turn at (x_r, p_r) it is p_r +- 2 B(|x - x_r|/2) (Masing),
 * until the loop closes: then the motion continues on the curve that the loop left. The turns of loops that are open are the
 * state. */
#include "element.h"

#include "common/exponent.h"

enum { KT, FS, CHI, BETA, PARAMETERS, HEAD = 3, MOST_ROOM = 1000000 };

struct iwan {
    double kt, chi, weight; /* weight: (chi + 2)(1 + beta) */
    double fs, most;
};

static inline struct iwan iwan_of(double kt, double fs, double chi, double beta)
{
    const double ends = 1.0 + beta, weight = (chi + 2.0) * ends;
    return (struct iwan){kt, chi, weight, fs, fs * weight / (kt * (beta * (chi + 2.0) + (chi + 1.0)))};
}

/* B(u), u >= 0; *slope: B'(u). */
static inline double curve(const struct iwan *p, double u, double *slope)
{
    const int slides = u >= p->most;
    const double ratio = u / greater(p->most, DBL_MIN), power = tribo_exp((p->chi + 1.0) * tribo_log(clamp(ratio, DBL_MIN, 1.0))),
                 part = (ratio > 0.0 ? power : 0.0) / p->weight;
    *slope = slides ? 0.0 : p->kt * (1.0 - (p->chi + 2.0) * part);
    return slides ? p->fs : p->kt * u * (1.0 - part);
}

/* Returns 1 if dx is against the direction state[2] of the last motion. */
static int turns(const double *state, double dx)
{
    return dx * state[2] < 0.0;
}

/* Checks chi, and that the number of turns is whole and at most room, a further turn has room, and turns are finite; a status. */
static int check_state(size_t n, size_t room, const double *dz, const double *parameter, const double *state)
{
    for (size_t i = 0; i < n; i++, state += HEAD + 2 * room) {
        const double count = isfinite(state[1]) ? state[1] : -1.0;
        const size_t used = count >= 0.0 && count <= (double)room ? HEAD + 2 * (size_t)count : HEAD;
        if (!tribo_all_within(state, used, DBL_MAX)) {
            return TRIBO_ERR_NOT_FINITE;
        }
        const double chi = parameter[PARAMETERS * i + CHI];
        if (chi <= -1.0 || chi > 100.0 || !(count >= 0.0 && count <= (double)room) || count != floor(count)) {
            return TRIBO_ERR_RANGE;
        }
        if (count == (double)room && turns(state, dz[i])) {
            return TRIBO_ERR_SIZE;
        }
    }
    return TRIBO_OK;
}

/* The force at x on a branch: base + factor B(distance). */
struct branch {
    double base, factor, distance;
};

/* The branch at x after turn [count][2]: x_r, p_r of the open turns. */
static struct branch branch_at(const double *turn, size_t count, double x)
{
    if (!count) {
        return (struct branch){0.0, x < 0.0 ? -1.0 : 1.0, fabs(x)};
    }
    const double *last = turn + 2 * (count - 1), way = x - last[0];
    return (struct branch){last[1], way < 0.0 ? -2.0 : 2.0, 0.5 * fabs(way)};
}

/* Moves a state by dx; returns the branch of the force of the sliders, which has the sign of x. */
static struct branch move_sliders(const struct iwan *p, double dx, double *state)
{
    double *turn = state + HEAD, x = state[0];
    size_t count = (size_t)state[1];
    if (turns(state, dx)) {
        double ignored;
        const struct branch b = branch_at(turn, count, x);
        turn[2 * count + 1] = b.base + b.factor * curve(p, b.distance, &ignored);
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
    return branch_at(turn, count, x);
}

/* f and df_dz of elements on their branches, base, factor, distance [n]. */
TRIBO_SIMD static void follow_curves(size_t n, double (*restrict p)[TRIBO_CHUNK], const double *restrict base,
                                     const double *restrict factor, const double *restrict distance, double *restrict f,
                                     double *restrict df_dz)
{
    for (size_t i = 0; i < n; i++) {
        const struct iwan own = iwan_of(p[KT][i], p[FS][i], p[CHI][i], p[BETA][i]);
        double slope;
        f[i] = -(base[i] + factor[i] * curve(&own, distance[i], &slope));
        df_dz[i] = -slope;
    }
}

int tribo_iwan_force(size_t n, size_t room, const double *dz, const double *parameter, double *state, double *f, double *df_dz)
{
    static const int range[PARAMETERS] = {POSITIVE, NONNEGATIVE, FINITE, NONNEGATIVE};
    int status = room > MOST_ROOM || n >= SIZE_MAX / (16 * (HEAD + 2 * MOST_ROOM)) ? TRIBO_ERR_SIZE : TRIBO_OK;
    status = status ? status : tribo_check_element(dz, n, FINITE);
    status = status ? status : tribo_check_elements(parameter, n, PARAMETERS, range);
    status = status ? status : n && (!state || !f) ? TRIBO_ERR_NULL : check_state(n, room, dz, parameter, state);
    for (size_t i = 0; !status && i < n; i += TRIBO_CHUNK) {
        double ignored[TRIBO_CHUNK], p[PARAMETERS][TRIBO_CHUNK], base[TRIBO_CHUNK], factor[TRIBO_CHUNK], distance[TRIBO_CHUNK];
        const size_t count = tribo_chunk_from(n, i);
        element_columns(parameter + PARAMETERS * i, count, PARAMETERS, p);
        for (size_t k = 0; k < count; k++) {
            const struct iwan own = iwan_of(p[KT][k], p[FS][k], p[CHI][k], p[BETA][k]);
            const struct branch b = move_sliders(&own, dz[i + k], state + (i + k) * (HEAD + 2 * room));
            base[k] = b.base;
            factor[k] = b.factor;
            distance[k] = b.distance;
        }
        follow_curves(count, p, base, factor, distance, f + i, df_dz ? df_dz + i : ignored);
    }
    return status;
}
