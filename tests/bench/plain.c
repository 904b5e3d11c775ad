/* SPDX-License-Identifier: BSD-3-Clause */
/* What one writes by hand, without any library: rk4 with Quinn's law, whose time at dt = 0.01 is the unit of the bench, and for
 * one or two contacts the Moreau-Jean rule. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../src/damper/output.h"
#include "methods.h"
#include "motion.h"

static inline double clamp(double x, double limit)
{
    return x > limit ? limit : x < -limit ? -limit : x;
}

/* ------------------------------------------------------------------------------------------------- Quinn's law, rk4 */

/* State: q, s (motion.h; the beam has its modal velocities), D. */
typedef void right_hand_side(const struct model *m, const double *rate, double t, const double *y, double *dy);

/* rate: 2 N/epsilon of each contact. */
static inline void oscillator(const struct model *m, const double *rate, double t, const double *y, double *dy)
{
    oscillator_motion(m, t, y, y + 1, dy, dy + 1, 1);
    const double f = clamp(clamp(-dy[1], m->limit[0]) - rate[0] * y[1], m->limit[0]);
    dy[1] += f;
    dy[2] = -f * y[1];
}

static inline void chain(const struct model *m, const double *rate, double t, const double *y, double *dy)
{
    const size_t n = m->n;
    const double limit = m->limit[0], slope = rate[0], *v = y + n;
    double *a = dy + n, power = 0.0;
    chain_motion(m, t, y, v, dy, a, 1);
    for (size_t i = 0; i < n; i++) {
        const double f = clamp(clamp(-a[i], limit) - slope * v[i], limit);
        a[i] += f;
        power -= f * v[i];
    }
    dy[2 * n] = power / (double)n;
}

/* The paper's partition: the contacts with |v| <= epsilon = 2 N/rate balance each other, the others slide. */
static inline void belt(const struct model *m, const double *rate, double t, const double *y, double *dy)
{
    const double *v = y + 2, *limit = m->limit;
    double *a = dy + 2, f[2];
    belt_motion(m, t, y, v, dy, a, 1);
    const int near0 = fabs(v[0]) * rate[0] <= 2.0 * limit[0], near1 = fabs(v[1]) * rate[1] <= 2.0 * limit[1];
    if (near0 && near1) {
        f[0] = -(2.0 * a[0] + a[1]);
        f[1] = -(a[0] + a[1]);
    } else {
        f[0] = v[0] > 0.0 ? -limit[0] : limit[0];
        f[1] = v[1] > 0.0 ? -limit[1] : limit[1];
        if (near0) {
            f[0] = f[1] - a[0];
        } else if (near1) {
            f[1] = 0.5 * (f[0] - a[1]);
        }
    }
    f[0] = near0 ? clamp(clamp(f[0], limit[0]) - rate[0] * v[0], limit[0]) : f[0];
    f[1] = near1 ? clamp(clamp(f[1], limit[1]) - rate[1] * v[1], limit[1]) : f[1];
    a[0] += f[0] - f[1];
    a[1] += 2.0 * f[1] - f[0];
    dy[4] = -(f[0] * v[0] + f[1] * v[1]);
}

/* Solves the first n of a x = b in place, a symmetric and positive definite. */
static inline void eliminate(size_t n, double a[CONTACTS][CONTACTS], double *x)
{
    for (size_t k = 0; k < n; k++) {
        for (size_t i = k + 1; i < n; i++) {
            const double part = a[i][k] / a[k][k];
            for (size_t j = k + 1; j < n; j++) {
                a[i][j] -= part * a[k][j];
            }
            x[i] -= part * x[k];
        }
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t j = k + 1; j < n; j++) {
            x[k] -= a[k][j] * x[j];
        }
        x[k] /= a[k][k];
    }
}

static inline void beam(const struct model *m, const double *rate, double t, const double *y, double *dy)
{
    const struct modal *b = &m->beam;
    const double load = sin(m->omega * t), *u = y + MODES;
    double *a = dy + MODES, v[CONTACTS], f[CONTACTS], r[CONTACTS][CONTACTS], x[CONTACTS], power = 0.0;
    size_t near[CONTACTS], count = 0;
    for (size_t i = 0; i < MODES; i++) {
        dy[i] = u[i];
        a[i] = load * b->load[i] - b->stiffness[i] * y[i] - b->damping[i] * u[i];
    }
    for (size_t c = 0; c < CONTACTS; c++) {
        v[c] = 0.0;
        for (size_t i = 0; i < MODES; i++) {
            v[c] += b->j[c][i] * u[i];
        }
        f[c] = 0.0;
        if (fabs(v[c]) * rate[c] <= 2.0 * m->limit[c]) {
            near[count++] = c;
        } else {
            f[c] = v[c] > 0.0 ? -m->limit[c] : m->limit[c];
        }
    }
    for (size_t k = 0; k < count; k++) {
        double sum = 0.0;
        for (size_t i = 0; i < MODES; i++) {
            sum += b->j[near[k]][i] * a[i];
        }
        for (size_t c = 0; c < CONTACTS; c++) {
            sum += b->r[near[k]][c] * f[c];
        }
        x[k] = -sum;
        for (size_t l = 0; l < count; l++) {
            r[k][l] = b->r[near[k]][near[l]];
        }
    }
    eliminate(count, r, x);
    for (size_t k = 0; k < count; k++) {
        const size_t c = near[k];
        f[c] = clamp(clamp(x[k], m->limit[c]) - rate[c] * v[c], m->limit[c]);
    }
    for (size_t c = 0; c < CONTACTS; c++) {
        power -= f[c] * v[c];
        for (size_t i = 0; i < MODES; i++) {
            a[i] += b->j[c][i] * f[c];
        }
    }
    dy[2 * MODES] = power;
}

/* steps of length h from t on; work: 4 times the dimension. */
static inline void rk4(right_hand_side *rhs, const struct model *m, const double *rate, size_t dimension, double t, double h,
                       size_t steps, double *restrict y, double *restrict work)
{
    double *restrict k = work, *restrict sum = work + dimension, *restrict z = work + 2 * dimension;
    const double begin = t;
    for (size_t s = 1; s <= steps; s++) {
        rhs(m, rate, t, y, sum);
        for (size_t i = 0; i < dimension; i++) {
            z[i] = y[i] + 0.5 * h * sum[i];
        }
        rhs(m, rate, t + 0.5 * h, z, k);
        for (size_t i = 0; i < dimension; i++) {
            z[i] = y[i] + 0.5 * h * k[i];
            sum[i] += 2.0 * k[i];
        }
        rhs(m, rate, t + 0.5 * h, z, k);
        for (size_t i = 0; i < dimension; i++) {
            z[i] = y[i] + h * k[i];
            sum[i] += 2.0 * k[i];
        }
        rhs(m, rate, t + h, z, k);
        for (size_t i = 0; i < dimension; i++) {
            y[i] += h / 6.0 * (sum[i] + k[i]);
        }
        t = begin + (double)s * h;
    }
}

/* One for each kind, so that the compiler sees all of it. */
static void rk4_steps(const struct model *m, const double *rate, double t, double h, size_t steps, double *y, double *work)
{
    switch (m->kind) {
    case OSCILLATOR:
        rk4(oscillator, m, rate, 3, t, h, steps, y, work);
        break;
    case CHAIN:
        rk4(chain, m, rate, 2 * m->n + 1, t, h, steps, y, work);
        break;
    case BELT:
        rk4(belt, m, rate, 5, t, h, steps, y, work);
        break;
    case BEAM:
        rk4(beam, m, rate, 2 * MODES + 1, t, h, steps, y, work);
        break;
    }
}

static size_t steps_in(double time, double dt)
{
    return (size_t)ceil(time / dt * (1.0 - 1e-9));
}

static void run_rk4(const struct method *method, const struct scene *s, double dt, struct outcome *o)
{
    const struct model *m = &s->model;
    const size_t first = steps_in(s->begin, dt), second = steps_in(s->end - s->begin, dt), last = 2 * m->n;
    const double h = (s->end - s->begin) / (double)second;
    double rate[CONTACTS], *y = need_memory(4 * (2 * m->n + 1), sizeof *y), *work = y + 2 * m->n + 1, d = 0.0;
    (void)method;
    for (size_t c = 0; c < CONTACTS; c++) {
        /* lambda = 2 N R/epsilon = lambda_dt/dt */
        rate[c] = s->lambda_dt / h / delassus(m, c < m->c ? c : 0, c < m->c ? c : 0);
    }
    if (first) {
        rk4_steps(m, rate, 0.0, s->begin / (double)first, first, y, work);
        d = y[last];
    }
    rk4_steps(m, rate, s->begin, h, second, y, work);
    if (m->kind == BELT) {
        velocities(m, s->end, y + 2, 1, work);
        memcpy(y + 2, work, 2 * sizeof *y);
    }
    o->steps = first + second;
    o->evaluations = 4 * o->steps;
    outcome_answer(o, s, y, d);
    free(y);
}

/* ------------------------------------------------------------------------------------------------------- Moreau-Jean */

/* The implicit midpoint rule, its load the mean of both ends; friction over the step by trying the cases. */
static void moreau_oscillator(const struct model *m, double t, double h, size_t steps, double *y)
{
    const double w = 1.0 / (1.0 + 0.25 * h * h), begin = t;
    double q = y[0], v = y[1], d = y[2], last = 0.5 * m->alpha * sin(m->omega * t);
    for (size_t s = 1; s <= steps; s++) {
        t = begin + (double)s * h;
        const double next = 0.5 * m->alpha * sin(m->omega * t), load = last + next;
        const double free = v + h * w * (load - q - 0.5 * h * v);
        const double f = clamp(-free / (h * w), m->limit[0]), after = free + h * w * f;
        d -= 0.5 * h * f * (v + after);
        q += 0.5 * h * (v + after);
        v = after;
        last = next;
    }
    y[0] = q;
    y[1] = v;
    y[2] = d;
}

/* With W the operator of a step: A = I + h^2/4 K is diagonal. */
static void moreau_belt(const struct model *m, double t, double h, size_t steps, double *y)
{
    const double w0 = 1.0 / (1.0 + 0.25 * h * h), w1 = 1.0 / (1.0 + 0.25 * h * h * m->kappa), begin = t;
    const double r00 = h * w0, r01 = -h * w0, r11 = h * (w0 + w1), whole = r00 * r11 - r01 * r01;
    for (size_t s = 1; s <= steps; s++) {
        t = begin + (double)s * h;
        const double u0 = y[2] + h * w0 * -(y[0] + 0.5 * h * y[2]), u1 = y[3] - h * w1 * m->kappa * (y[1] + 0.5 * h * y[3]);
        const double v0 = u0 - m->alpha * sin(m->omega * t), v1 = u1 - u0;
        double f0 = -(r11 * v0 - r01 * v1) / whole, f1 = -(r00 * v1 - r01 * v0) / whole;
        if (fabs(f0) > m->limit[0] || fabs(f1) > m->limit[1]) {
            /* Gauss-Seidel, which for two contacts is as good as trying all cases */
            f0 = clamp(f0, m->limit[0]);
            f1 = clamp(f1, m->limit[1]);
            for (int k = 0; k < 100; k++) {
                const double before = f1;
                f0 = clamp(-(v0 + r01 * f1) / r00, m->limit[0]);
                f1 = clamp(-(v1 + r01 * f0) / r11, m->limit[1]);
                if (fabs(f1 - before) < 1e-14) {
                    break;
                }
            }
        }
        const double e0 = u0 + h * w0 * (f0 - f1), e1 = u1 + h * w1 * f1;
        y[0] += 0.5 * h * (y[2] + e0);
        y[1] += 0.5 * h * (y[3] + e1);
        y[2] = e0;
        y[3] = e1;
    }
}

static void run_moreau(const struct method *method, const struct scene *s, double dt, struct outcome *o)
{
    const size_t first = steps_in(s->begin, dt), second = steps_in(s->end - s->begin, dt);
    void (*step)(const struct model *, double, double, size_t, double *) =
        s->model.kind == BELT ? moreau_belt : moreau_oscillator;
    double y[5] = {0.0}, d = 0.0;
    (void)method;
    if (first) {
        step(&s->model, 0.0, s->begin / (double)first, first, y);
        d = y[2];
    }
    step(&s->model, s->begin, (s->end - s->begin) / (double)second, second, y);
    o->steps = o->evaluations = first + second;
    outcome_answer(o, s, y, d);
}

static int is_small(const struct scene *s)
{
    return s->model.c <= 2;
}

static const struct method all[] = {
    {"plain", "rk4", "quinn", STEP, 2.6, NULL, run_rk4, 0.0, 0},
    {"plain", "moreau", "coulomb", STEP, 0.0, is_small, run_moreau, 0.0, 0},
};
const struct methods plain_methods = {all, sizeof all / sizeof *all};
const struct method *const unit_method = &all[0];
