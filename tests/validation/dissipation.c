/* SPDX-License-Identifier: BSD-3-Clause */
/* What friction dissipates, under limits from far below to far above all other forces: it takes the energy that the structure
 * loses, and never gives any. */
#include <string.h>

#include "make.h"
#include "run.h"

#define BODIES 3
#define CONTACTS 3

/* Bodies on springs in a row, the first of them on the ground or not; contacts between bodies and to the ground, some of which
 * repeat each other. */
struct row {
    size_t n, contacts;
    double mass[BODIES * BODIES], stiffness[BODIES * BODIES], direction[CONTACTS * BODIES], limit[CONTACTS];
};

static void add_spring(struct row *r, size_t i, double k)
{
    r->stiffness[i * r->n + i] += k;
    if (i > 0) {
        r->stiffness[(i - 1) * r->n + i - 1] += k;
        r->stiffness[(i - 1) * r->n + i] -= k;
        r->stiffness[i * r->n + i - 1] -= k;
    }
}

/* Limits between 10^least and 10^most, all alike or some of them small, or 0. */
static struct row row_create(struct random *g, double least, double most)
{
    struct row r = {.n = 1 + below(g, BODIES), .contacts = 1 + below(g, CONTACTS)};
    const int alike = below(g, 3) == 0;
    const double all = pow(10.0, uniform(g, least, most));
    for (size_t i = 0; i < r.n; i++) {
        r.mass[i * r.n + i] = log_uniform(g, 1.0);
        add_spring(&r, i, i == 0 && below(g, 3) == 0 ? 0.0 : uniform(g, 0.1, 2.0));
    }
    for (size_t i = 0; i < r.contacts; i++) {
        const size_t a = below(g, r.n), b = below(g, r.n + 1);
        const double side = below(g, 3) ? 1.0 : -1.0, own = pow(10.0, uniform(g, least, most));
        r.direction[i * r.n + a] = side;
        if (b < r.n && b != a) {
            r.direction[i * r.n + b] = -side;
        }
        const double kinds[] = {own, own, own, own, own, log_uniform(g, 2.0), 0.0};
        r.limit[i] = alike ? all : kinds[below(g, COUNT(kinds))];
    }
    return r;
}

static tribo_system *row_system(const struct row *r)
{
    tribo_system *sys;
    assert_ok(dense_system(&sys, r->n, r->contacts, r->mass, NULL, r->stiffness, r->direction, 0, NULL, 0));
    assert_ok(tribo_set_limit(tribo_system_context(sys), r->limit));
    return sys;
}

static void row_start(struct random *g, const struct row *r, double *y)
{
    for (size_t i = 0; i < r->n; i++) {
        y[i] = uniform(g, -1.0, 1.0) * pow(10.0, uniform(g, -3.0, 0.0));
        y[r->n + i] = uniform(g, -1.0, 1.0) * pow(10.0, uniform(g, -4.0, 0.0));
    }
    y[2 * r->n] = 0.0;
}

static double row_energy(const struct row *r, const double *y)
{
    double energy = 0.0;
    for (size_t i = 0; i < r->n; i++) {
        energy += 0.5 * r->mass[i * r->n + i] * y[r->n + i] * y[r->n + i];
        for (size_t j = 0; j < r->n; j++) {
            energy += 0.5 * y[i] * r->stiffness[i * r->n + j] * y[j];
        }
    }
    return energy;
}

/* A limit 10^6 to 10^40 times the other forces stops a contact within 10^-6 to 10^-40, and friction takes its kinetic energy. */
TEST(huge_limits_stop)
{
    static const char *const methods[] = {"exact", "event"};
    struct random g = random_of(_i);
    for (int trial = 0; trial < 100; trial++) {
        const struct row r = row_create(&g, 6.0, _i % 2 ? 14.0 : 40.0);
        double from[2 * BODIES + 1];
        row_start(&g, &r, from);
        for (size_t k = 0; k < COUNT(methods); k++) {
            tribo_system *sys = row_system(&r);
            tribo_driver *drv = driver_create(sys, methods[k], 1e-3, 1e-12);
            double y[2 * BODIES + 1], t = 0.0, backslip;
            memcpy(y, from, sizeof y);
            driver_advance(drv, &t, 8.0, y);
            const double before = row_energy(&r, from), off = row_energy(&r, y) + y[2 * r.n] - before;
            assert_ok(tribo_driver_real(drv, TRIBO_REAL_BACKSLIP, &backslip));
            require(fabs(off) <= 1e-8 * before, "%s, trial %d: energy %g becomes %g more", methods[k], trial, before, off);
            require(y[2 * r.n] >= 0.0, "%s, trial %d: friction takes %g", methods[k], trial, y[2 * r.n]);
            require(backslip <= 1e-8, "%s, trial %d: contacts slip back by %g", methods[k], trial, backslip);
            tribo_driver_destroy(drv);
            tribo_system_destroy(sys);
        }
    }
}
END_TEST

/* Loads, bases that move, and, every other time, limits that swing, through zero too. */
static void drive(tribo_system *sys, struct random *g, const struct row *r, int swings)
{
    double part[2][BODIES], base[2][CONTACTS], swing[2][CONTACTS];
    for (int k = 0; k < 2; k++) {
        for (size_t i = 0; i < BODIES; i++) {
            part[k][i] = uniform(g, -1.0, 1.0);
        }
        for (size_t i = 0; i < CONTACTS; i++) {
            base[k][i] = uniform(g, -0.5, 0.5);
        }
    }
    for (size_t i = 0; i < r->contacts; i++) {
        const double size = r->limit[i] * uniform(g, 0.0, 1.6), phase = uniform(g, 0.0, 2.0 * PI);
        swing[0][i] = size * cos(phase);
        swing[1][i] = size * sin(phase);
    }
    assert_ok(tribo_system_add_load(sys, uniform(g, 0.3, 3.0), part[0], part[1]));
    assert_ok(tribo_system_add_base_motion(sys, uniform(g, 0.3, 3.0), base[0], base[1]));
    if (swings) {
        assert_ok(tribo_system_add_limit(sys, uniform(g, 0.3, 4.0), swing[0], swing[1]));
    }
}

/* Of all methods, by limits of 10^-3 to 10^12; of such as follow a law without jumps in steps of their own to 10^2, and what they
 * dissipate is right to their tolerance. In fixed steps forces and the mean velocity balance energy, and in one in which a
 * contact turns they may give some, by the order of the step. */
TEST(never_negative)
{
    static const struct {
        const char *method;
        double most, tolerance, dt, gives;
        int trials;
    } of[] = {{"exact", 12, 1e-12, 0.1, 1e-13, 150},    {"event", 12, 1e-12, 0.1, 1e-13, 100},
              {"auto", 12, 1e-12, 0.1, 1e-13, 40},      {"central/fixed", 12, 0, 1e-3, 1e-4, 100},
              {"moreau/fixed", 12, 0, 1e-3, 1e-4, 100}, {"rk4/fixed", 12, 0, 1e-2, 1e-13, 60},
              {"rkf45", 2, 1e-8, 0.1, 1e-6, 6},         {"rk8pd", 2, 1e-8, 0.1, 1e-6, 6},
              {"msbdf", 2, 1e-8, 0.1, 1e-6, 6}};
    struct random g = random_of(100 + _i);
    for (int trial = 0; trial < of[_i].trials; trial++) {
        const struct row r = row_create(&g, -3.0, of[_i].most);
        tribo_system *sys = row_system(&r);
        double y[2 * BODIES + 1], t = 0.0, taken = 0.0, most = 0.0;
        row_start(&g, &r, y);
        drive(sys, &g, &r, trial % 2);
        if (of[_i].most < 12.0) {
            assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 1e-2));
        }
        tribo_driver *drv = driver_create(sys, of[_i].method, of[_i].dt, of[_i].tolerance);
        for (int piece = 1; piece <= 10; piece++) {
            driver_advance(drv, &t, 0.8 * piece, y);
            most = fmax(most, row_energy(&r, y) + fabs(y[2 * r.n]));
            require(y[2 * r.n] >= taken - of[_i].gives * most, "%s, trial %d, t = %g: friction takes %g of %g", of[_i].method,
                    trial, t, y[2 * r.n] - taken, most);
            taken = y[2 * r.n];
        }
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}
END_TEST

TEST_MAIN("dissipation", {huge_limits_stop, 8}, {never_negative, 9})
