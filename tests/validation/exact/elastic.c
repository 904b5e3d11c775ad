/* SPDX-License-Identifier: BSD-3-Clause */
/* Elastic contacts: sliders without mass on springs, in method "exact"; and what else has no mass. */
#include "make.h"
#include "sliders.h"

#include <string.h>
#include "../../set_up_driver.h"

static tribo_driver *exact(tribo_system *s)
{
    tribo_driver *d = NULL;
    const int status = set_up_driver(&d, s, "exact", 1e-3, 0.0, 0.0);
    require(!status, "%s", tribo_system_message(s));
    return d;
}

static void advance(tribo_driver *d, double *t, double t1, double *y)
{
    const int status = tribo_driver_advance(d, t, t1, y);
    require(!status, "t = %.17g: %s", *t, tribo_driver_message(d));
}

/* ---------------------------------------------------------------------------------------------------------- closed forms */

static const double k2[4] = {2.0, -2.0, -2.0, 2.0}, unit[4] = {1.0, 0.0, 0.0, 1.0}, one_mass[4] = {1.0, 0.0, 0.0, 0.0};

/* Energy 4 N (X - N/k) a cycle, k = 2, N = 3, X = 4: a mass that a rigid contact holds to a base X sin t, and a slider on it. */
TEST(loop_of_driven_mass)
{
    const double pi = acos(-1.0), way[2] = {4.0, 0.0};
    tribo_system *s = linear(2, 2, one_mass, NULL, k2, unit);
    tribo_driver *d = exact(s);
    double t = 0.0, y[5] = {0.0, 0.0, 4.0, 0.0, 0.0};
    assert_ok(tribo_set_limit(tribo_system_context(s), (const double[]){1e3, 3.0}));
    assert_ok(tribo_system_add_base_motion(s, 1.0, way, NULL));
    advance(d, &t, 1.5 * pi, y);
    /* Masing: from the turning point at -4 the slider holds for a way of 2 N/k = 3 */
    assert_close(y[0], -4.0, 1e-11);
    assert_close(2.0 * (y[1] - y[0]), 3.0, 1e-11);
    const double held = y[1], before = y[4];
    advance(d, &t, 1.5 * pi + acos(0.25), y);
    assert_close(y[0], -1.0, 1e-10);
    assert_close(y[1], held, 1e-10);
    assert_close(y[4], before, 1e-10);
    advance(d, &t, 3.5 * pi, y);
    assert_close(y[4] - before, 30.0, 1e-10);
    assert_close(2.0 * (y[1] - y[0]), 3.0, 1e-11);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* The same loop of a slider between a spring on the ground and a moving base; beside it a mass that has nothing to do with it. */
TEST(loop_of_driven_slider)
{
    const double pi = acos(-1.0), stiffness[4] = {1.0, 0.0, 0.0, 2.0}, direction[2] = {0.0, 1.0}, way[1] = {4.0};
    tribo_system *s = linear(2, 1, one_mass, NULL, stiffness, direction);
    tribo_driver *d = exact(s);
    double t = 0.0, y[5] = {0.5};
    assert_ok(tribo_set_limit_all(tribo_system_context(s), 3.0));
    assert_ok(tribo_system_add_base_motion(s, 1.0, way, NULL));
    advance(d, &t, 1.5 * pi, y);
    const double before = y[4];
    advance(d, &t, 5.5 * pi, y);
    assert_close(y[4] - before, 60.0, 1e-10);
    assert_close(y[0], 0.5 * cos(t), 1e-11);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

TEST(steady_state)
{
    const double period = 2.0 * acos(-1.0) / 1.1;
    tribo_system *s = element(0.5, 1);
    tribo_driver *d = NULL;
    double t = 0.0, y[5] = {0.0}, most = 0.0;
    assert_ok(set_up_driver(&d, s, "auto", 1e-4, 0.0, 0.0));
    assert_exact(strcmp(tribo_driver_method(d), "exact"), 0);
    advance(d, &t, 80.0 * period, y);
    const double before[2] = {y[0], y[2]};
    assert_ok(tribo_driver_set_observer(d, see_most, &most));
    advance(d, &t, 81.0 * period, y);
    assert_close(y[0], before[0], 1e-10);
    assert_close(y[2], before[1], 1e-10);
    assert_close(most, 3.38660810, 1e-8);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* Two equal elements in parallel are one of both springs and both limits. */
TEST(parallel)
{
    tribo_system *one = element(0.5, 1), *two = element(0.5, 2);
    tribo_driver *d = exact(one), *e = exact(two);
    double t = 0.0, tt = 0.0, y[5] = {0.0}, z[7] = {0.0};
    for (int k = 1; k <= 40; k++) {
        advance(d, &t, 1.7 * k, y);
        advance(e, &tt, 1.7 * k, z);
        assert_close(z[0], y[0], 1e-10);
        assert_close(z[1], y[1], 1e-10);
        assert_close(z[2], y[1], 1e-10);
        assert_close(z[3], y[2], 1e-10);
        assert_close(z[6], y[4], 1e-10);
    }
    tribo_driver_destroy(d);
    tribo_driver_destroy(e);
    tribo_system_destroy(one);
    tribo_system_destroy(two);
}

/* Without limit the element is no more than a mark on the mass; with a large one it is a spring. */
TEST(extremes)
{
    const double limit = _i ? 1e3 : 0.0, k = _i ? 2.0 : 1.0, mass = 1.0, damping = 0.1, load = 1.0;
    tribo_system *s = element(limit, 1), *plain = linear(1, 0, &mass, &damping, &k, NULL);
    tribo_driver *d = exact(s), *e = exact(plain);
    double t = 0.0, tt = 0.0, y[5] = {0.3, 0.0, 0.2, 0.0, 0.0}, z[3] = {0.3, 0.2, 0.0};
    y[1] = _i ? 0.0 : 7.0;
    assert_ok(tribo_system_add_load(plain, 1.1, &load, NULL));
    for (int i = 1; i <= 20; i++) {
        advance(d, &t, 1.3 * i, y);
        advance(e, &tt, 1.3 * i, z);
        assert_close(y[0], z[0], 1e-11);
        assert_close(y[2], z[1], 1e-11);
        assert_close(y[1], _i ? 0.0 : z[0], 1e-11);
        assert_close(y[3], _i ? 0.0 : z[1], 1e-11);
        assert_exact(y[4], 0.0);
    }
    tribo_driver_destroy(d);
    tribo_driver_destroy(e);
    tribo_system_destroy(s);
    tribo_system_destroy(plain);
}

/* A slider that starts beyond its limit goes back to it, and dissipates limit times the way. */
TEST(start_beyond_limit)
{
    tribo_system *s = element(0.5, 1);
    tribo_driver *d = exact(s);
    double t = 0.0, y[5] = {0.0, 3.0, -0.1, 0.0, 1.0};
    advance(d, &t, 1e-9, y);
    assert_close(y[1], 0.5, 1e-8);
    assert_close(y[4], 1.0 + 0.5 * 2.5, 1e-8);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* -------------------------------------------------------------------------------------------- against return mapping */

/* Way of the spring of slider i, of masses at q and the base at time t. */
static double way_of(size_t i, double t, const double *q)
{
    return i == 0 ? q[0] : i == 1 ? q[0] - q[1] : q[1] - base_speed / base_omega * sin(base_omega * t);
}

/* Velocities and accelerations x' [2 MASSES] of x; spring forces f from those at the start of the step, at x0 and t0. */
static void slope(double t, const double *x, double t0, const double *x0, const double *f0, int rigid, double *f, double *dx)
{
    double force[MASSES] = {0.0, 0.9 * sin(load_omega * t), 1.3 * cos(load_omega * t)};
    for (size_t i = 0; i < SLIDERS; i++) {
        f[i] = clamped(f0[i] + springs[i] * (way_of(i, t, x) - way_of(i, t0, x0)), limits[i]);
    }
    force[0] -= f[0] + f[1];
    force[1] += f[1] - f[2];
    for (size_t i = 0; i < MASSES; i++) {
        for (size_t j = 0; j < MASSES; j++) {
            force[i] -= grounded[i][j] * x[j] + 0.05 * grounded[i][j] * x[MASSES + j];
        }
    }
    force[2] -= rigid * rigid_limit;
    for (size_t i = 0; i < MASSES; i++) {
        dx[i] = x[MASSES + i];
        dx[MASSES + i] = force[i] / masses[i];
    }
}

/* A step by Heun's method; rigid: the direction in which mass 2 slides. */
static void heun(double t, double h, double *x, double *f, int rigid)
{
    double a[2 * MASSES], b[2 * MASSES], to[2 * MASSES], next[SLIDERS];
    slope(t, x, t, x, f, rigid, next, a);
    for (size_t i = 0; i < 2 * MASSES; i++) {
        to[i] = x[i] + h * a[i];
    }
    slope(t + h, to, t, x, f, rigid, next, b);
    for (size_t i = 0; i < 2 * MASSES; i++) {
        to[i] = x[i] + 0.5 * h * (a[i] + b[i]);
    }
    slope(t + h, to, t, x, f, rigid, next, b);
    memcpy(x, to, sizeof to);
    memcpy(f, next, sizeof next);
}

/* Without the rigid contact; and with it, which is made to slide all the time by a base that is fast. */
TEST(return_mapping)
{
    const int rigid = _i == 1;
    const double h = 2e-5, limit[] = {limits[0], limits[1], limits[2], rigid ? rigid_limit : 0.0}, fast[] = {0.0, 0.0, 0.0, 9.0};
    tribo_system *s = structure(0.0);
    tribo_driver *d = exact(s);
    double t = 0.0, y[2 * DOFS + 1] = {0.0}, x[2 * MASSES] = {0.0}, f[SLIDERS] = {0.0};
    assert_ok(tribo_set_limit(tribo_system_context(s), limit));
    assert_ok(tribo_system_add_base_motion(s, 0.0, fast, NULL));
    for (int k = 0; k < 30; k++) {
        advance(d, &t, k + 1.0, y);
        for (int i = 0; i < 50000; i++) {
            heun(k + i * h, h, x, f, -rigid);
        }
        for (size_t i = 0; i < MASSES; i++) {
            assert_close(y[i], x[i], 2e-8);
            assert_close(y[DOFS + i], x[MASSES + i], 2e-8);
        }
        for (size_t i = 0; i < SLIDERS; i++) {
            const double q = i == 1 ? y[0] : i == 0 ? y[0] : y[1];
            assert_close(springs[i] * (q - y[MASSES + i]), f[i], 1e-7);
        }
    }
    size_t events;
    assert_ok(tribo_driver_count(d, TRIBO_COUNT_EVENTS, &events));
    ck_assert_uint_gt(events, 20);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* ------------------------------------------------------------------------------------------------------ random structures */

#define HEAVY 3
#define RIGID 2
#define ALL (HEAVY + SLIDERS + 1) /* and one without mass that no contact touches */

struct scene {
    double mass[ALL * ALL], stiffness[ALL * ALL], direction[(SLIDERS + RIGID) * ALL], limit[SLIDERS + RIGID], load[ALL];
};

static void add_spring(double *k, double value, size_t a, size_t b)
{
    k[a * ALL + a] += value;
    k[b * ALL + b] += value;
    k[a * ALL + b] -= value;
    k[b * ALL + a] -= value;
}

/* Masses that are coupled or not, sliders on springs from masses to the ground or to other masses, rigid contacts; sliders that
 * springs couple or not. */
static struct scene scene_of(struct random *r, int coupled, int shared)
{
    struct scene s = {{0.0}, {0.0}, {0.0}, {0.0}, {0.0}};
    for (size_t i = 0; i < HEAVY; i++) {
        const size_t next = (i + 1) % HEAVY;
        s.mass[i * ALL + i] = uniform(r, 1.0, 3.0);
        s.mass[i * ALL + next] = s.mass[next * ALL + i] = coupled ? uniform(r, -0.3, 0.3) : 0.0;
        s.stiffness[i * ALL + i] += uniform(r, 0.1, 1.0);
        add_spring(s.stiffness, uniform(r, 0.1, 2.0), i, next);
        s.load[i] = uniform(r, -1.0, 1.0);
    }
    for (size_t i = 0; i < SLIDERS; i++) {
        const size_t w = HEAVY + i;
        add_spring(s.stiffness, uniform(r, 0.5, 3.0), w, below(r, HEAVY));
        s.direction[i * ALL + w] = uniform(r, 0.5, 1.5);
        s.direction[i * ALL + below(r, HEAVY)] = below(r, 2) ? uniform(r, -1.0, 1.0) : 0.0;
        s.limit[i] = uniform(r, 0.05, 0.6);
    }
    for (size_t i = SLIDERS; i < SLIDERS + RIGID; i++) {
        s.direction[i * ALL + below(r, HEAVY)] = 1.0;
        s.direction[i * ALL + below(r, HEAVY)] = -0.7;
        s.limit[i] = uniform(r, 0.0, 0.4);
    }
    for (size_t i = 0; shared && i + 1 < SLIDERS; i++) {
        add_spring(s.stiffness, uniform(r, 0.2, 5.0), HEAVY + i, HEAVY + i + 1);
    }
    add_spring(s.stiffness, 1.0, ALL - 1, 0);
    add_spring(s.stiffness, 0.5, ALL - 1, 1);
    return s;
}

static gsl_spmatrix *sparse_of(const double *a, size_t rows)
{
    gsl_spmatrix *m = gsl_spmatrix_alloc(rows, ALL);
    for (size_t i = 0; i < rows * ALL; i++) {
        if (a[i] != 0.0) {
            gsl_spmatrix_set(m, i / ALL, i % ALL, a[i]);
        }
    }
    return m;
}

static tribo_system *scene_system(const struct scene *s)
{
    gsl_spmatrix *m = sparse_of(s->mass, ALL), *k = sparse_of(s->stiffness, ALL), *j = sparse_of(s->direction, SLIDERS + RIGID);
    tribo_system *sys = NULL;
    char text[200] = "";
    const int status = sparse_system(&sys, m, NULL, k, j, 0, text, sizeof text);
    require(!status, "%s", text);
    gsl_spmatrix_free(m);
    gsl_spmatrix_free(k);
    gsl_spmatrix_free(j);
    return sys;
}

static double form(const double *a, const double *x)
{
    double sum = 0.0;
    for (size_t i = 0; i < ALL * ALL; i++) {
        sum += 0.5 * a[i] * x[i / ALL] * x[i % ALL];
    }
    return sum;
}

/* Kinetic, elastic and dissipated energy, and that of the steady load. */
static double energy_of(const struct scene *s, const double *y)
{
    double sum = form(s->stiffness, y) + form(s->mass, y + ALL) + y[2 * ALL];
    for (size_t i = 0; i < ALL; i++) {
        sum -= s->load[i] * y[i];
    }
    return sum;
}

/* K_ww w + K_wq q is the force of the slider, within its limit; and nothing where there is no contact. */
static void check_statics(const struct scene *s, const double *y)
{
    for (size_t d = HEAVY; d < ALL; d++) {
        double force = 0.0;
        for (size_t i = 0; i < ALL; i++) {
            force += s->stiffness[d * ALL + i] * y[i];
        }
        const double most = d < ALL - 1 ? s->limit[d - HEAVY] * s->direction[(d - HEAVY) * ALL + d] : 0.0;
        require(fabs(force) <= most + 1e-12, "degree of freedom %zu: force %.17g, limit %.17g", d, force, most);
    }
}

/* With a steady load nothing comes in after the start, and in the end all that the load gave is dissipated. */
static void conserves(const char *method, int seed, double tolerance)
{
    struct random r = random_of(seed);
    const struct scene s = scene_of(&r, seed % 2, seed % 5 > 2);
    tribo_system *sys = seed % 3 ? linear(ALL, SLIDERS + RIGID, s.mass, NULL, s.stiffness, s.direction) : scene_system(&s);
    tribo_driver *d = driver_create(sys, method, 1e-3, 1e-13);
    double t = 0.0, y[2 * ALL + 1] = {0.0}, most;
    assert_ok(tribo_set_limit(tribo_system_context(sys), s.limit));
    assert_ok(tribo_system_add_load(sys, 0.0, s.load, NULL));
    for (size_t i = 0; i < HEAVY; i++) {
        y[ALL + i] = uniform(&r, -2.0, 2.0);
    }
    const double all = energy_of(&s, y);
    for (int k = 1; k <= 40; k++) {
        const double before = y[2 * ALL];
        advance(d, &t, 0.7 * k, y);
        check_statics(&s, y);
        assert_close(energy_of(&s, y), all, tolerance);
        require(y[2 * ALL] >= before - 1e-13, "energy comes back");
    }
    assert_ok(tribo_driver_real(d, TRIBO_REAL_EXCESS, &most));
    assert_close(most, 0.0, tolerance);
    assert_ok(tribo_driver_real(d, TRIBO_REAL_BACKSLIP, &most));
    assert_close(most, 0.0, tolerance);
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

TEST(energy)
{
    conserves("exact", _i, 1e-11);
}

TEST(energy_event)
{
    conserves("event", _i, 1e-10);
}

/* Sliders that begin beyond their limits go back: the one whose force is inside its limit stays, the others move against their
 * forces, which are the limits, and dissipate these times their ways. */
TEST(energy_of_return)
{
    struct random r = random_of(_i);
    const struct scene s = scene_of(&r, 0, 1);
    tribo_system *sys = linear(ALL, SLIDERS + RIGID, s.mass, NULL, s.stiffness, s.direction);
    tribo_driver *d = exact(sys);
    double t = 0.0, y[2 * ALL + 1] = {0.0}, before[SLIDERS], sum = 0.0;
    assert_ok(tribo_set_limit(tribo_system_context(sys), s.limit));
    for (size_t i = 0; i < SLIDERS; i++) {
        before[i] = y[HEAVY + i] = uniform(&r, -1.0, 1.0);
    }
    advance(d, &t, 1e-14, y);
    check_statics(&s, y);
    for (size_t i = 0; i < SLIDERS; i++) {
        const double along = s.direction[i * ALL + HEAVY + i], way = along * (before[i] - y[HEAVY + i]);
        double force = 0.0;
        for (size_t k = 0; k < ALL; k++) {
            force += s.stiffness[(HEAVY + i) * ALL + k] * y[k] / along;
        }
        require(fabs(way) < 1e-12 || fabs(fabs(force) - s.limit[i]) < 1e-12, "slider %zu moves by %g at force %g", i, way, force);
        require(force * way > -1e-12, "slider %zu moves by %g with force %g", i, way, force);
        sum += force * way;
    }
    assert_close(y[2 * ALL], sum, 1e-12);
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

/* ----------------------------------------------------------------------------------------------------------- refusals */

static int create(const double *mass, const double *damping, const double *stiffness, const double *direction, char *text)
{
    tribo_system *s = NULL;
    const int status = dense_system(&s, 3, 2, mass, damping, stiffness, direction, 0, text, 200);
    tribo_system_destroy(s);
    return status;
}

TEST(refused_structures)
{
    const double mass[9] = {1.0}, damping[9] = {0.1, 0.0, 0.0, 0.0, 0.2};
    const double held[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0},
                 loose[9] = {1.0, 0.0, 0.0, 0.0, 0.3, -0.3, 0.0, -0.3, 0.3};
    const double joined[9] = {1.0, 0.0, 0.0, 0.0, 1.0, -0.5, 0.0, -0.5, 1.0}, direction[6] = {0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const double none[9] = {1.0, 0.0, 0.0, 0.0, 1.0}, doubled[6] = {0.0, 1.0, 0.0, 0.0, 1.0, 0.0};
    const double chained[9] = {2.0, -1.0, 0.0, -1.0, 1.5, -0.5, 0.0, -0.5, 0.5};
    char text[200] = "";
    assert_ok(create(mass, NULL, held, direction, text));
    assert_status(create(mass, damping, held, direction, text), TRIBO_ERR_UNSUPPORTED);
    assert_says(text, "damping[1][1] = 0.2, but degree of freedom 1 has no mass");
    assert_status(create(mass, NULL, loose, direction, text), TRIBO_ERR_INDEFINITE);
    assert_says(text, "the stiffness does not hold it");
    assert_ok(create(mass, NULL, joined, direction, text));
    assert_ok(create(mass, NULL, chained, direction, text));
    /* a spring of nothing; two contacts on one slider */
    assert_status(create(mass, NULL, none, direction, text), TRIBO_ERR_INDEFINITE);
    assert_says(text, "degree of freedom 2 has none, and the stiffness does not hold it: pivot 0");
    assert_status(create(mass, NULL, held, doubled, text), TRIBO_ERR_UNSUPPORTED);
    assert_says(text, "contact 1 moves degrees of freedom without mass only as other contacts do");
}

TEST(refused_methods)
{
    tribo_system *s = element(0.5, 1), *copy;
    assert_ok(tribo_system_clone(s, &copy));
    tribo_system_destroy(s);
    const char *message = tribo_system_message(copy);
    for (int k = 0; k < tribo_method_count(); k++) {
        tribo_driver *d = NULL;
        const char *name = any_method_name(k);
        const int able =
            !strcmp(name, "exact") || !strcmp(name, "auto") || !strcmp(name, "event") || !strcmp(name, "moreau/fixed");
        assert_status(set_up_driver(&d, copy, name, 1e-3, 1e-6, 1e-6), able ? TRIBO_OK : TRIBO_ERR_UNSUPPORTED);
        if (!able) {
            assert_says(message, name);
            assert_says(message, "degree of freedom 1 has none");
        }
        tribo_driver_destroy(d);
    }
    tribo_system_destroy(copy);
}

TEST(refused_calls)
{
    const double on[2] = {0.0, 1.0}, time[2] = {0.0, 1.0}, limit[2] = {0.5, 0.6}, zero[5] = {0.0};
    double dydt[5], dfdy[25];
    tribo_system *s = element(0.5, 1);
    const char *message = tribo_system_message(s);
    assert_status(tribo_system_add_load(s, 1.0, NULL, on), TRIBO_ERR_UNSUPPORTED);
    assert_says(message, "sine[1] = 1, but degree of freedom 1 has no mass");
    assert_status(tribo_system_add_load_table(s, 2, time, limit, on), TRIBO_ERR_UNSUPPORTED);
    assert_says(message, "pattern[1] = 1");
    assert_status(tribo_system_add_limit(s, 1.0, limit, NULL), TRIBO_ERR_UNSUPPORTED);
    assert_says(message, "contact 0 is elastic");
    assert_status(tribo_system_set_limit_table(s, 2, time, limit), TRIBO_ERR_UNSUPPORTED);
    assert_says(message, "contact 0 is elastic");
    assert_status(tribo_system_accept(s, 0.0, zero), TRIBO_ERR_UNSUPPORTED);
    const gsl_odeiv2_system *ode = tribo_gsl_system(s);
    ck_assert_int_eq(ode->function(0.0, zero, dydt, ode->params), GSL_EBADFUNC);
    ck_assert_int_eq(ode->jacobian(0.0, zero, dfdy, dydt, ode->params), GSL_EBADFUNC);
    tribo_system_destroy(s);
}

TEST_MAIN("elastic", {loop_of_driven_mass, 1}, {loop_of_driven_slider, 1}, {steady_state, 1}, {parallel, 1}, {extremes, 2},
          {start_beyond_limit, 1}, {return_mapping, 2}, {energy, 300}, {energy_event, 100}, {energy_of_return, 50},
          {refused_structures, 1}, {refused_methods, 1}, {refused_calls, 1})
