/* SPDX-License-Identifier: BSD-3-Clause */
/* Systems with compliance beside the same systems with a degree of freedom without mass for each slider: the same motions to the
 * last bit, with the displacements of sliders behind the velocities in the state. Stiffness and compliance are powers of 2 or
 * sums of few, so that both ways to the matrices are without rounding. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "make.h"
#include "run.h"

enum { N = 3, E = 2, C = 3, M = N + E, STATE = 2 * N + E + 1, WHOLE = 2 * M + 1 };

static const double mass[N] = {1.0, 2.0, 1.5}, soft[C] = {0.25, 0.0, 4.0}, limit[C] = {0.4, 0.3, 0.25};
static const double stiffness[N * N] = {3.0, -1.0, 0.0, -1.0, 2.5, -1.5, 0.0, -1.5, 1.75};
static const double direction[C * N] = {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, -1.0, 0.0};
static const double cosine[M] = {0.0, 0.0, 1.3}, sine[M] = {0.0, 0.9, 0.0}, base[C] = {0.3, 0.0, 0.0};

static void load(tribo_system *sys)
{
    assert_ok(tribo_system_add_load(sys, 0.9, cosine, sine));
    assert_ok(tribo_system_add_base_motion(sys, 0.9, base, NULL));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
}

static tribo_system *with_compliance(size_t nmode)
{
    tribo_model *model;
    tribo_system *sys;
    assert_ok(tribo_model_create(&model, N, C));
    assert_ok(tribo_model_set_mass_diagonal(model, mass));
    assert_ok(tribo_model_set_stiffness(model, stiffness));
    assert_ok(tribo_model_set_direction(model, direction));
    assert_ok(tribo_model_set_compliance(model, soft));
    if (!nmode) {
        double damping[N * N];
        for (size_t i = 0; i < N * N; i++) {
            damping[i] = 0.05 * stiffness[i];
        }
        assert_ok(tribo_model_set_damping(model, damping));
    }
    assert_ok(nmode ? tribo_system_reduce(&sys, model, nmode, TRIBO_STATICS_NONE) : tribo_system_create(&sys, model));
    tribo_model_destroy(model);
    load(sys);
    return sys;
}

/* Sliders are the degrees of freedom N, for contact 0, and N + 1, for contact 2. */
static tribo_system *without_mass(void)
{
    double m[M * M] = {0.0}, c[M * M] = {0.0}, k[M * M] = {0.0}, j[C * M] = {0.0};
    for (size_t i = 0; i < N; i++) {
        m[i * M + i] = mass[i];
        for (size_t l = 0; l < N; l++) {
            k[i * M + l] = stiffness[i * N + l];
            c[i * M + l] = 0.05 * stiffness[i * N + l];
        }
    }
    for (size_t i = 0, w = N; i < C; i++) {
        double p[M] = {0.0};
        memcpy(p, direction + i * N, N * sizeof *p);
        memcpy(j + i * M, p, N * sizeof *p);
        if (soft[i] > 0.0) {
            memset(j + i * M, 0, N * sizeof *p);
            j[i * M + w] = 1.0;
            p[w++] = -1.0;
        }
        for (size_t a = 0; soft[i] > 0.0 && a < M * M; a++) {
            k[a] += p[a / M] * p[a % M] / soft[i];
        }
    }
    tribo_system *sys = NULL;
    char text[200] = "";
    require(!dense_system(&sys, M, C, m, c, k, j, 0, text, sizeof text), "%s", text);
    load(sys);
    return sys;
}

/* The state with compliance of a state with degrees of freedom without mass. */
static void order(const double *whole, double *y)
{
    memcpy(y, whole, N * sizeof *y);
    memcpy(y + N, whole + M, N * sizeof *y);
    memcpy(y + 2 * N, whole + N, E * sizeof *y);
    y[2 * N + E] = whole[2 * M];
}

static void same(size_t n, const double *a, const double *b, const char *name, const char *method, double t)
{
    for (size_t i = 0; i < n; i++) {
        require(a[i] == b[i], "%s: at t = %.17g %s[%zu] = %.17g is not %.17g", method, t, name, i, a[i], b[i]);
    }
}

static const char *const method[] = {"exact", "event", "auto", "moreau/fixed"};

TEST(sizes)
{
    tribo_system *sys = with_compliance(0), *reduced = with_compliance(2);
    require(tribo_system_ndof(sys) == N && tribo_system_dimension(sys) == STATE, "%zu degrees of freedom, %zu values",
            tribo_system_ndof(sys), tribo_system_dimension(sys));
    require(tribo_system_ndof(reduced) == 2 && tribo_system_dimension(reduced) == 2 * 2 + E + 1, "%zu modes, %zu values",
            tribo_system_ndof(reduced), tribo_system_dimension(reduced));
    tribo_system *copy;
    assert_ok(tribo_system_clone(sys, &copy));
    require(tribo_system_dimension(copy) == STATE, "a copy has %zu values", tribo_system_dimension(copy));
    double y[STATE] = {0.0}, t = 0.0, omega[2] = {0.0};
    assert_ok(tribo_system_get_frequencies(reduced, omega));
    require(omega[0] > 0.0 && omega[1] < 2.0, "frequencies %g and %g", omega[0], omega[1]);
    y[2 * N + 1] = NAN;
    tribo_driver *drv = driver_create(sys, "exact", 1.0, 1e-9);
    require(tribo_driver_advance(drv, &t, 1.0, y) == TRIBO_ERR_NOT_FINITE && strstr(tribo_driver_message(drv), "y[7] = nan"),
            "%s", tribo_driver_message(drv));
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    tribo_system_destroy(copy);
    tribo_system_destroy(reduced);
}

/* What an observer sees, one after the other. */
struct tape {
    size_t values, count;
    double y[4000][WHOLE], t[4000];
    int kind[4000];
};

static int record(const tribo_moment *moment, void *data)
{
    struct tape *tape = data;
    memcpy(tape->y[tape->count], moment->y, tape->values * sizeof(double));
    tape->t[tape->count] = moment->t;
    tape->kind[tape->count++] = moment->kind;
    return 0;
}

/* Advances, each from the state of the last one: its moments, its end, and what contacts do there. */
TEST(motions)
{
    static struct tape tape[2];
    const char *name = method[_i];
    tribo_system *sys[] = {with_compliance(0), without_mass()};
    tribo_driver *drv[2];
    double y[STATE] = {0.0}, whole[WHOLE] = {0.0}, expected[STATE], t[2] = {0.0, 0.0};
    const size_t values[] = {STATE, WHOLE};
    for (int k = 0; k < 2; k++) {
        drv[k] = driver_create(sys[k], name, 0.01, 1e-9);
        tape[k] = (struct tape){.values = values[k]};
        assert_ok(tribo_driver_set_observer(drv[k], record, &tape[k]));
    }
    y[2 * N] = whole[N] = 0.3; /* the slider is beyond its limit */
    for (int i = 1; i <= 12; i++) {
        assert_ok(tribo_driver_advance(drv[0], &t[0], 0.77 * i, y));
        assert_ok(tribo_driver_advance(drv[1], &t[1], 0.77 * i, whole));
        order(whole, expected);
        same(STATE, y, expected, "y", name, t[0]);
        double v[C], f[C], w[C], g[C];
        signed char slip[C], stands[C];
        assert_ok(tribo_system_contacts(sys[0], t[0], y, v, NULL, f));
        assert_ok(tribo_system_contacts(sys[1], t[1], whole, w, NULL, g));
        assert_ok(tribo_system_get_slip(sys[0], slip));
        assert_ok(tribo_system_get_slip(sys[1], stands));
        for (size_t c = 0; c < C; c++) {
            require(fabs(v[c] - w[c]) < 1e-12, "%s: at t = %g contact %zu has velocity %.17g, not %.17g", name, t[0], c, v[c],
                    w[c]);
            require(fabs(f[c] - g[c]) < 1e-12, "%s: at t = %g contact %zu has force %.17g, not %.17g", name, t[0], c, f[c], g[c]);
            require(slip[c] == stands[c] || fabs(w[c]) < 1e-12, "%s: at t = %g contact %zu has slip %d, not %d", name, t[0], c,
                    slip[c], stands[c]);
        }
    }
    require(tape[0].count == tape[1].count && tape[0].count > 12, "%zu moments, not %zu", tape[0].count, tape[1].count);
    for (size_t k = 0; k < tape[0].count; k++) {
        order(tape[1].y[k], expected);
        require(tape[0].t[k] == tape[1].t[k] && tape[0].kind[k] == tape[1].kind[k], "moment %zu", k);
        same(STATE, tape[0].y[k], expected, "y", name, tape[0].t[k]);
    }
    for (int k = 0; k < 2; k++) {
        tribo_driver_destroy(drv[k]);
        tribo_system_destroy(sys[k]);
    }
}

/* Velocities of sliders are no part of the state: a driver that begins where another one is finds the same motion. */
TEST(beginnings)
{
    const char *name = method[_i];
    tribo_system *sys = with_compliance(0);
    tribo_driver *drv = driver_create(sys, name, 0.01, 1e-9), *other = driver_create(sys, name, 0.01, 1e-9);
    double y[STATE] = {0.0}, t = 0.0;
    for (int i = 1; i <= 30; i++) {
        double from[STATE], begin = t;
        memcpy(from, y, sizeof from);
        assert_ok(tribo_driver_advance(drv, &t, 0.31 * i, y));
        from[STATE - 1] += 1.0; /* so that it is a motion that begins */
        assert_ok(tribo_driver_advance(other, &begin, 0.31 * i, from));
        from[STATE - 1] -= 1.0;
        for (size_t k = 0; k < STATE; k++) {
            require(fabs(y[k] - from[k]) < 1e-11, "%s: from t = %g on y[%zu] = %.17g, but %.17g", name, 0.31 * (i - 1), k, y[k],
                    from[k]);
        }
    }
    tribo_driver_destroy(drv);
    tribo_driver_destroy(other);
    tribo_system_destroy(sys);
}

TEST(periods)
{
    const char *name = method[_i];
    tribo_system *sys[] = {with_compliance(0), without_mass()};
    const double period = 2.0 * acos(-1.0) / 0.9;
    double y[STATE] = {0.0}, whole[WHOLE] = {0.0}, expected[STATE];
    const double c[2 * N] = {0.3, -1.0, 0.0, 0.0, 0.0, 0.7}, d[2 * M] = {0.3, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.7};
    tribo_driver *drv[2];
    for (int k = 0; k < 2; k++) {
        drv[k] = driver_create(sys[k], name, 0.01, 1e-9);
        assert_ok(tribo_driver_find_periodic(drv[k], 0.2, period, k ? whole : y));
    }
    order(whole, expected);
    same(STATE, y, expected, "y", name, 0.2);
    double value[2][4], re[2][2 * M], im[2][2 * M];
    for (int k = 0; k < 2; k++) {
        assert_ok(tribo_driver_period_extremes(drv[k], k ? d : c, &value[k][0], &value[k][1], NULL, NULL));
        assert_ok(tribo_driver_period_harmonic(drv[k], k ? d : c, 1, &value[k][2], &value[k][3]));
        assert_ok(tribo_driver_get_multipliers(drv[k], re[k], im[k]));
    }
    same(4, value[0], value[1], "value", name, 0.2);
    same(STATE - 1, re[0], re[1], "re", name, 0.2);
    same(STATE - 1, im[0], im[1], "im", name, 0.2);
    for (size_t i = STATE - 1; i < 2 * M; i++) {
        require(fabs(re[1][i]) < 1e-12, "multiplier %zu is %g, not 0", i, re[1][i]);
    }
    require(hypot(re[0][0], im[0][0]) > 1e-3, "the largest multiplier is %g", re[0][0]);
    for (int k = 0; k < 2; k++) {
        tribo_driver_destroy(drv[k]);
        tribo_system_destroy(sys[k]);
    }
}

TEST_MAIN("sliders", {sizes, 1}, {motions, 4}, {beginnings, 4}, {periods, 3})
