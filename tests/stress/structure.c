/* SPDX-License-Identifier: BSD-3-Clause */
#include "make.h"
#include "structure.h"

#include <stdio.h>
#include <string.h>
#include "../set_up_driver.h"

/* -------------------------------------------------------------------------------------------------------- construction */

static double normal(struct random *g)
{
    return sqrt(-2.0 * log(uniform(g, 0.0, 1.0) + 1e-300)) * cos(2.0 * PI * uniform(g, 0.0, 1.0));
}

static int chance(struct random *g, double p)
{
    return uniform(g, 0.0, 1.0) < p;
}

/* Masses of up to this ratio, rarely coupled ones. */
static void make_mass(struct structure *s, struct random *g, double ratio, int full)
{
    const size_t n = s->ndof;
    for (size_t i = 0; i < n; i++) {
        s->mass[i * n + i] = pow(ratio, uniform(g, -0.5, 0.5));
    }
    for (size_t i = 0; i < n && full; i++) {
        for (size_t j = 0; j < i; j++) {
            const double x = 0.3 / (double)n * normal(g) * sqrt(s->mass[i * n + i] * s->mass[j * n + j]);
            s->mass[i * n + j] = s->mass[j * n + i] = x;
        }
    }
}

/* Springs in a row, and to the ground unless the structure is free; with those frequencies stay of the order of 1. */
static void make_stiffness(struct structure *s, struct random *g, int is_free)
{
    const size_t n = s->ndof;
    for (size_t i = 0; i < n; i++) {
        s->stiffness[i * n + i] += is_free ? 0.0 : uniform(g, 0.2, 1.2) * s->mass[i * n + i];
        if (i) {
            const double k = uniform(g, 0.3, 1.3) * sqrt(s->mass[i * n + i] * s->mass[(i - 1) * n + i - 1]);
            s->stiffness[i * n + i] += k;
            s->stiffness[(i - 1) * n + i - 1] += k;
            s->stiffness[i * n + i - 1] -= k;
            s->stiffness[(i - 1) * n + i] -= k;
        }
    }
}

/* Proportional to the stiffness, or with dashpots to the ground besides. */
static void make_damping(struct structure *s, struct random *g, int dashpots)
{
    const size_t n = s->ndof;
    const double part = uniform(g, 0.0, 0.1);
    for (size_t k = 0; k < n * n; k++) {
        s->damping[k] = part * s->stiffness[k];
    }
    for (size_t i = 0; dashpots && i < n; i++) {
        s->damping[i * n + i] += uniform(g, 0.0, 0.2) * s->mass[i * n + i];
    }
}

/* A block on the ground, two blocks on each other, the same contact again or its opposite, the sum of two others, anything, or
 * one that is driven from both sides. */
static void make_direction(struct structure *s, struct random *g, size_t i)
{
    const size_t n = s->ndof, a = below(g, n), b = below(g, n), other = i ? below(g, i) : 0, kind = below(g, 12);
    double *row = s->direction + i * n;
    const double *const first = s->direction + other * n, *const last = s->direction + (i ? i - 1 : 0) * n;
    for (size_t j = 0; j < n; j++) {
        const double any = chance(g, 0.5) ? normal(g) : 0.0;
        row[j] = kind < 4                   ? (double)(j == a)
                 : kind < 7                 ? (double)(j == a) - (double)(j == b && a != b)
                 : kind == 7 && i           ? first[j]
                 : kind == 8 && i           ? -first[j]
                 : kind == 9 && i           ? first[j] + last[j]
                 : kind == 10 && i % 4 == 3 ? 0.0
                                            : any;
    }
}

static void make_wave(struct wave *w, struct random *g, size_t n, double omega, double size, const double *mass)
{
    w->omega = omega;
    for (size_t i = 0; i < n; i++) {
        const double scale = size * (mass ? mass[i * (n + 1)] : 1.0);
        w->cosine[i] = chance(g, 0.5) ? scale * normal(g) : 0.0;
        w->sine[i] = chance(g, 0.5) ? scale * normal(g) : 0.0;
    }
}

struct structure structure_create(int seed)
{
    struct random g = random_of(seed);
    struct structure s = {.ndof = 1 + below(&g, MOST_DOFS), .ncontact = 1 + below(&g, MOST_CONTACTS)};
    const double ratio = chance(&g, 0.4) ? pow(10.0, uniform(&g, 0.0, 6.0)) : 1.0;
    const size_t damping = below(&g, 4);
    const int full = chance(&g, 0.4), belts = chance(&g, 0.5), steady = belts && chance(&g, 0.3), even = chance(&g, 0.2);
    const int is_free = damping < 3 && chance(&g, 0.15), moving = chance(&g, 0.5);
    make_mass(&s, &g, ratio, full);
    make_stiffness(&s, &g, is_free);
    s.damped = damping > 1;
    if (s.damped) {
        make_damping(&s, &g, damping == 3);
    }
    const double level = pow(ratio, uniform(&g, -0.5, 0.5));
    for (size_t i = 0; i < s.ncontact; i++) {
        make_direction(&s, &g, i);
        s.limit[i] = chance(&g, 0.1) ? 0.0 : even ? 0.3 * level : level * pow(10.0, uniform(&g, -2.0, 0.5));
    }
    make_wave(&s.load[0], &g, s.ndof, uniform(&g, 0.3, 2.3), 1.0, s.mass);
    make_wave(&s.load[1], &g, s.ndof, uniform(&g, 0.3, 3.3), 0.5, s.mass);
    if (belts) {
        make_wave(&s.motion[0], &g, s.ncontact, uniform(&g, 0.3, 1.3), 0.3, NULL);
        make_wave(&s.motion[1], &g, s.ncontact, steady ? 0.0 : uniform(&g, 0.3, 1.3), steady ? 0.1 : 0.2, NULL);
    }
    for (size_t i = 0; moving && i < 2 * s.ndof; i++) {
        s.start[i] = normal(&g);
    }
    snprintf(s.name, sizeof s.name, "%zu dofs, %zu contacts, mass ratio %.1g%s%s%s%s%s", s.ndof, s.ncontact, ratio,
             full ? ", full mass" : "", s.damped ? damping == 3 ? ", dashpots" : ", damped" : "", is_free ? ", free" : "",
             belts ? steady ? ", belts at constant speed" : ", belts" : "", moving ? ", moving" : "");
    return s;
}

/* Small integers everywhere, and halves of them: events coincide, limits are touched and not exceeded, contacts repeat each
 * other, loads are in resonance. */
struct structure structure_even(int seed)
{
    static const double omegas[] = {0.0, 0.5, 1.0, 1.0, 2.0, 3.0}, limits[] = {0.0, 0.5, 1.0, 1.0, 2.0, 4.0};
    struct random g = random_of(seed);
    struct structure s = {.ndof = 1 + below(&g, 4), .ncontact = 1 + below(&g, 5)};
    const size_t n = s.ndof;
    const int grounded = chance(&g, 0.8), belts = chance(&g, 0.5), moving = chance(&g, 0.5);
    s.damped = chance(&g, 0.2);
    for (size_t i = 0; i < n; i++) {
        s.mass[i * n + i] = chance(&g, 0.8) ? 1.0 : 2.0;
        s.stiffness[i * n + i] += grounded ? (double)below(&g, 3) : 0.0;
        for (size_t j = 0; j < i; j++) {
            const double k = chance(&g, 0.5) ? (double)below(&g, 3) : 0.0;
            s.stiffness[i * n + i] += k;
            s.stiffness[j * n + j] += k;
            s.stiffness[i * n + j] -= k;
            s.stiffness[j * n + i] -= k;
        }
    }
    for (size_t k = 0; k < n * n && s.damped; k++) {
        s.damping[k] = 0.25 * s.stiffness[k];
    }
    for (size_t i = 0; i < s.ncontact; i++) {
        s.limit[i] = limits[below(&g, COUNT(limits))];
        for (size_t j = 0; j < n; j++) {
            s.direction[i * n + j] = chance(&g, 0.5) ? 0.0 : chance(&g, 0.6) ? 1.0 : -1.0;
        }
    }
    for (size_t k = 0; k < 2; k++) {
        s.load[k].omega = omegas[below(&g, COUNT(omegas))];
        s.motion[k].omega = omegas[below(&g, COUNT(omegas))];
        for (size_t i = 0; i < MOST_DOFS; i++) {
            s.load[k].cosine[i] = chance(&g, 0.3) ? (double)below(&g, 5) - 2.0 : 0.0;
            s.load[k].sine[i] = chance(&g, 0.3) ? (double)below(&g, 5) - 2.0 : 0.0;
            s.motion[k].cosine[i] = belts && chance(&g, 0.3) ? (double)below(&g, 3) - 1.0 : 0.0;
            s.motion[k].sine[i] = belts && chance(&g, 0.3) ? (double)below(&g, 3) - 1.0 : 0.0;
        }
    }
    for (size_t i = 0; moving && i < 2 * n; i++) {
        s.start[i] = (double)below(&g, 5) - 2.0;
    }
    snprintf(s.name, sizeof s.name, "%zu dofs, %zu contacts%s%s%s%s", n, s.ncontact, s.damped ? ", damped" : "",
             grounded ? "" : ", free", belts ? ", belts" : "", moving ? ", moving" : "");
    return s;
}

struct structure structure_falling(int seed)
{
    struct random g = random_of(seed);
    struct structure s = structure_create(seed);
    s.falls = 1;
    for (size_t i = 0; i < s.ncontact; i++) {
        s.ratio[i] = chance(&g, 0.2) ? 1.0 : uniform(&g, 1.0, 2.0);
        s.velocity[i] = log_uniform(&g, 0.5);
    }
    return s;
}

/* a [rows][n] with a column of zeros more. */
static void widen(double *a, size_t rows, size_t n)
{
    for (size_t i = rows; i-- > 0;) {
        memmove(a + i * (n + 1), a + i * n, n * sizeof *a);
        a[i * (n + 1) + n] = 0.0;
    }
}

/* A spring holds the body that contact i is on, and its far end slides. */
static void add_spring(struct structure *s, struct random *g, size_t bodies, size_t i)
{
    const size_t n = s->ndof, body = below(g, bodies);
    const double k = uniform(g, 0.3, 3.0) * s->mass[body * (n + 1)];
    double *const square[] = {s->mass, s->damping, s->stiffness};
    for (size_t a = 0; a < 3; a++) {
        memset(square[a] + n * n, 0, n * sizeof **square);
        widen(square[a], n + 1, n);
    }
    widen(s->direction, s->ncontact, n);
    memset(s->direction + i * (n + 1), 0, n * sizeof *s->direction);
    s->direction[i * (n + 1) + n] = 1.0;
    s->stiffness[body * (n + 2)] += k;
    s->stiffness[n * (n + 2)] = k;
    s->stiffness[body * (n + 1) + n] = s->stiffness[n * (n + 1) + body] = -k;
    memmove(s->start + n + 1, s->start + n, n * sizeof *s->start);
    s->start[n] = s->start[body];
    s->start[2 * n + 1] = 0.0;
    for (size_t a = 0; a < 2; a++) {
        s->load[a].cosine[n] = s->load[a].sine[n] = 0.0;
    }
    s->ndof++;
    s->springs++;
}

struct structure structure_elastic(int seed)
{
    struct random g = random_of(seed);
    struct structure s = structure_create(seed);
    const size_t bodies = s.ndof;
    for (size_t i = 0; i < s.ncontact && s.ndof < MOST_DOFS; i++) {
        if (!i || chance(&g, 0.5)) {
            add_spring(&s, &g, bodies, i);
        }
    }
    snprintf(s.name + strlen(s.name), sizeof s.name - strlen(s.name), ", %zu elastic", s.springs);
    return s;
}

/* ---------------------------------------------------------------------------------------------------------------- use */

tribo_system *structure_system(const struct structure *s)
{
    char text[200] = "";
    tribo_system *sys = NULL;
    const int status = dense_system(&sys, s->ndof, s->ncontact, s->mass, s->damped ? s->damping : NULL, s->stiffness,
                                    s->direction, 0, text, sizeof text);
    require(status == TRIBO_OK, "%s: %d: %s", s->name, status, text);
    for (size_t k = 0; k < 2; k++) {
        assert_ok(tribo_system_add_load(sys, s->load[k].omega, s->load[k].cosine, s->load[k].sine));
        assert_ok(tribo_system_add_base_motion(sys, s->motion[k].omega, s->motion[k].cosine, s->motion[k].sine));
    }
    assert_ok(tribo_set_limit(tribo_system_context(sys), s->limit));
    if (s->falls) {
        assert_ok(tribo_set_static(tribo_system_context(sys), s->ratio, s->velocity));
    }
    return sys;
}

int structure_run(const struct structure *s, const char *method, double dt, double tolerance, double duration, double *y,
                  char *text)
{
    tribo_system *sys = structure_system(s);
    tribo_driver *drv = NULL;
    double t = s->begin;
    memcpy(y, s->start, (2 * s->ndof + 1) * sizeof *y);
    assert_ok(set_up_driver(&drv, sys, method, dt, tolerance, tolerance));
    const int status = tribo_driver_advance(drv, &t, s->begin + duration, y);
    snprintf(text, 200, "%s", tribo_driver_message(drv));
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    return status;
}

double structure_energy(const struct structure *s, const double *y)
{
    double sum = 0.0;
    for (size_t i = 0; i < s->ndof; i++) {
        for (size_t j = 0; j < s->ndof; j++) {
            sum += 0.5 * y[i] * s->stiffness[i * s->ndof + j] * y[j];
            sum += 0.5 * y[s->ndof + i] * s->mass[i * s->ndof + j] * y[s->ndof + j];
        }
    }
    return sum;
}

double distance(const double *x, const double *y, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, fabs(x[i] - y[i]));
    }
    return most;
}

double size_of(const double *y, size_t n)
{
    const double zeros[MOST_STATES] = {0};
    return distance(y, zeros, n);
}
