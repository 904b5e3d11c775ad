/* SPDX-License-Identifier: BSD-3-Clause */
/* Accelerations of the models, by hand, without friction. Plain code and other packages share them: their compilers see all of
 * it. State: q and velocities s, each with a stride. The velocities are those of the contacts, v = s, followed for the beam by
 * others (see modal.back); chain and oscillator have J = 1. */
#ifndef TRIBO_BENCH_MOTION_H
#define TRIBO_BENCH_MOTION_H

#include <math.h>

#include "systems.h"

/* q' and s' into dq and ds. */
typedef void free_motion(const struct model *m, double t, const double *q, const double *s, double *dq, double *ds,
                         size_t stride);

static inline void oscillator_motion(const struct model *m, double t, const double *q, const double *s, double *dq, double *ds,
                                     size_t stride)
{
    (void)stride;
    dq[0] = s[0];
    ds[0] = m->alpha * sin(m->omega * t) - q[0];
}

static inline void chain_motion(const struct model *m, double t, const double *q, const double *s, double *dq, double *ds,
                                size_t stride)
{
    const size_t n = m->n, last = (n - 1) * stride;
    const double k = (double)n * (double)n;
    for (size_t i = 0; i <= last; i += stride) {
        dq[i] = s[i];
    }
    ds[0] = k * (q[stride] - q[0]) + (double)n * m->alpha * sin(m->omega * t);
    for (size_t i = stride; i < last; i += stride) {
        ds[i] = k * (q[i - stride] - 2.0 * q[i] + q[i + stride]);
    }
    ds[last] = k * (4.0 / 3.0 * q[last - stride] - 4.0 * q[last]);
}

static inline void belt_motion(const struct model *m, double t, const double *q, const double *s, double *dq, double *ds,
                               size_t stride)
{
    const double belt = m->alpha * sin(m->omega * t), rate = m->alpha * m->omega * cos(m->omega * t);
    dq[0] = s[0] + belt;
    dq[stride] = s[stride] + s[0] + belt;
    ds[0] = -q[0] - rate;
    ds[stride] = q[0] - m->kappa * q[stride];
}

static inline void beam_motion(const struct model *m, double t, const double *q, const double *s, double *dq, double *ds,
                               size_t stride)
{
    const struct modal *b = &m->beam;
    const double load = sin(m->omega * t);
    double a[MODES];
    for (size_t i = 0; i < MODES; i++) {
        double u = 0.0;
        for (size_t k = 0; k < MODES; k++) {
            u += b->back[i][k] * s[k * stride];
        }
        dq[i * stride] = u;
        a[i] = load * b->load[i] - b->stiffness[i] * q[i * stride] - b->damping[i] * u;
    }
    for (size_t k = 0; k < MODES; k++) {
        double sum = 0.0;
        for (size_t i = 0; i < MODES; i++) {
            sum += b->forth[k][i] * a[i];
        }
        ds[k * stride] = sum;
    }
}

static inline free_motion *motion_of(const struct model *m)
{
    static free_motion *const all[] = {oscillator_motion, chain_motion, belt_motion, beam_motion};
    return all[m->kind];
}

/* R_ij; chain and oscillator: the identity. */
static inline double delassus(const struct model *m, size_t i, size_t j)
{
    static const double belt[2][2] = {{1.0, -1.0}, {-1.0, 2.0}};
    return m->kind == BELT ? belt[i][j] : m->kind == BEAM ? m->beam.r[i][j] : i == j ? 1.0 : 0.0;
}

/* u from s at time t. */
static inline void velocities(const struct model *m, double t, const double *s, size_t stride, double *u)
{
    const double belt = m->kind == BELT ? m->alpha * sin(m->omega * t) : 0.0;
    for (size_t i = 0; i < m->n; i++) {
        u[i] = m->kind == BELT ? s[0] + belt + (i ? s[stride] : 0.0) : s[i * stride];
        for (size_t k = 0; m->kind == BEAM && k < MODES; k++) {
            u[i] = (k ? u[i] : 0.0) + m->beam.back[i][k] * s[k * stride];
        }
    }
}

#endif
