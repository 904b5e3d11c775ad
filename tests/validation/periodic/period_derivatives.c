/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives of periodic motions, and of their multipliers, by limits, loads, frequency and damping: against closed forms, and
 * differences of motions. */
#include "run.h"
#include "search.h"

#include <complex.h>
#include <string.h>

#define DOFS 48
#define CONTACTS 10
#define STATES (2 * DOFS + CONTACTS + 1)

static const char *const methods[] = {"exact", "event", "auto"};

/* ------------------------------------------------------------------------------------------------------ one oscillator */

/* Of Den Hartog's amplitude, by limit and by frequency; 4 N x0 a period are dissipated. By the loads, with the sum of degree
 * 1. */
TEST(den_hartog)
{
    static const int kind[] = {TRIBO_PARAMETER_LIMIT, TRIBO_PARAMETER_LOADS, TRIBO_PARAMETER_FREQUENCY, TRIBO_PARAMETER_DAMPING};
    static const size_t index[4] = {0};
    const double one[] = {1.0, 0.0}, by_limit = -0.51052875503341, by_beta = 4.80844813153893, r = 0.3, beta = 0.7;
    struct search s = oscillator_search(methods[_i], 0.0, r, 1.0, beta);
    double y[3] = {0}, extremes[4][2], energy[4], start[4][3];
    find(&s, 0.0, y);
    const double x0 = amplitude(&s, 0), want[] = {by_limit, x0 - r * by_limit, beta * by_beta, 0.0};
    assert_ok(tribo_driver_period_derivatives(s.drv, 4, kind, index, one, extremes[0], energy, start[0]));
    for (int j = 0; j < 4; j++) {
        assert_close(extremes[j][1], want[j], 1e-9);
        assert_close(extremes[j][0], -want[j], 1e-9);
        assert_close(energy[j], 4.0 * (r * want[j] + (j == 0 ? x0 : 0.0)), 1e-8);
        assert_exact(start[j][2], 0.0);
    }
    search_free(&s);
}

/* The limit of most energy, of 4 N x0 where there are no stops: V/(sqrt(2) U). By secants on the derivative. */
TEST(most_energy)
{
    static const int kind = TRIBO_PARAMETER_LIMIT;
    static const size_t index = 0;
    struct search s = oscillator_search(methods[_i], 0.0, 0.6, 1.0, 0.8);
    const double v = 1.0 / (1.0 - 0.8 * 0.8), u = tan(PI / 1.6) / 0.8;
    double limit[2] = {0.6, 0.7}, slope[2], y[3] = {0};
    for (int k = 0; k < 9 && fabs(limit[1] - limit[0]) > 1e-13; k++) {
        assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), limit[k > 0]));
        find(&s, 0.0, y);
        assert_ok(tribo_driver_period_derivatives(s.drv, 1, &kind, &index, NULL, NULL, &slope[k > 0], NULL));
        if (k > 0) {
            const double next = limit[1] - slope[1] * (limit[1] - limit[0]) / (slope[1] - slope[0]);
            limit[0] = limit[1];
            slope[0] = slope[1];
            limit[1] = next;
        }
    }
    assert_close(limit[1], v / (sqrt(2.0) * fabs(u)), 1e-11);
    search_free(&s);
}

/* ---------------------------------------------------------------------------------------------------------- structures */

/* What a scene has. */
enum { PLAIN = 0, DAMPED = 1, COUPLED = 2, ELASTIC = 4, BASE = 8, EVEN = 16, FREE = 32, SWINGS = 64 };

struct scene {
    int with;
    size_t n, contacts;
    double limit[CONTACTS], loads, frequency, damping; /* factors */
    double omega;
};

/* A chain of n bodies, the first ones on the ground by springs; contact i holds body i, or 2 i, to the ground, every third one to
 * the next body. FREE: no stiffness, and the bodies slide on the contacts. */
static tribo_system *build(const struct scene *s)
{
    static double mass[DOFS], k[DOFS * DOFS], c[DOFS * DOFS], j[CONTACTS * DOFS];
    double compliance[CONTACTS], cosine[DOFS] = {0}, sine[DOFS] = {0}, base[CONTACTS] = {0}, swing[CONTACTS] = {0};
    const size_t n = s->n;
    tribo_model *model = NULL;
    tribo_system *sys = NULL;
    memset(k, 0, sizeof k);
    memset(c, 0, sizeof c);
    memset(j, 0, sizeof j);
    for (size_t d = 0; d < n; d++) {
        const double next = 2.0 + 0.1 * (double)(d % 7);
        mass[d] = 1.0 + 0.05 * (double)(d % 5);
        k[d * n + d] += s->with & FREE ? 0.0 : 0.3 + 0.02 * (double)d;
        if (d + 1 < n) {
            k[d * n + d] += next;
            k[(d + 1) * n + d + 1] += next;
            k[d * n + d + 1] = k[(d + 1) * n + d] = -next;
        }
    }
    for (size_t d = 0; d < n; d++) {
        for (size_t e = 0; e < n; e++) {
            c[d * n + e] = s->with & DAMPED ? s->damping * 0.02 * k[d * n + e] : 0.0;
        }
        c[d * n + d] += s->with & COUPLED ? s->damping * 0.05 * (double)(d % 3 + 1) : 0.0;
        cosine[d] = s->loads * (1.0 + 0.3 * sin(3.0 * (double)d));
        sine[d] = s->loads * 0.5 * cos(5.0 * (double)d);
    }
    for (size_t i = 0; i < s->contacts; i++) {
        const size_t d = 2 * s->contacts > n ? i % n : 2 * i;
        j[i * n + d] = 1.0;
        if (i % 3 == 2 && d + 1 < n) {
            j[i * n + d + 1] = -1.0;
        }
        compliance[i] = s->with & ELASTIC && i % 2 == 0 ? 0.2 + 0.01 * (double)i : 0.0;
        base[i] = i == 0 ? s->loads * s->frequency * 0.4 : 0.0; /* a velocity: displacements do not depend on the frequency */
        swing[i] = i == 1 ? 0.15 : 0.0;
    }
    assert_ok(tribo_model_create(&model, n, s->contacts));
    assert_ok(tribo_model_set_mass_diagonal(model, mass));
    assert_ok(tribo_model_set_stiffness(model, k));
    if (s->with & (DAMPED | COUPLED)) {
        assert_ok(tribo_model_set_damping(model, c));
    }
    assert_ok(tribo_model_set_direction(model, j));
    assert_ok(tribo_model_set_compliance(model, compliance));
    const int status = tribo_system_create(&sys, model);
    require(!status, "%s", tribo_model_message(model));
    tribo_model_destroy(model);
    assert_ok(tribo_system_add_load(sys, s->omega * s->frequency, cosine, sine));
    if (s->with & EVEN) {
        assert_ok(tribo_system_add_load(sys, 2.0 * s->omega * s->frequency, sine, cosine));
    }
    if (s->with & BASE) {
        assert_ok(tribo_system_add_base_motion(sys, s->omega * s->frequency, NULL, base));
    }
    assert_ok(tribo_set_limit(tribo_system_context(sys), s->limit));
    if (s->with & SWINGS) {
        assert_ok(tribo_system_add_limit(sys, 2.0 * s->omega * s->frequency, swing, NULL));
    }
    return sys;
}

/* The quantities: extremes of a displacement, of a mix of displacements and velocities, energies, state. */
struct quantities {
    double extremes[2][2], energy[CONTACTS], y[STATES];
};

static void combine(const struct scene *s, int which, double *c)
{
    memset(c, 0, 2 * s->n * sizeof *c);
    c[s->n / 2] = 1.0;
    for (size_t d = 0; which && d < s->n; d++) {
        c[d] = cos((double)d);
    }
}

static double period_of(const struct scene *s)
{
    return 2.0 * PI / (s->omega * s->frequency);
}

static tribo_driver *solve(const struct scene *s, const char *method, tribo_system *sys, struct quantities *q)
{
    double c[2 * DOFS];
    tribo_driver *drv = driver_create(sys, method, 0.1, 1e-14);
    const int status = tribo_driver_find_periodic(drv, 0.0, period_of(s), q->y);
    require(!status, "%s: %s", tribo_strerror(status), tribo_driver_message(drv));
    for (int which = 0; which < 2; which++) {
        combine(s, which, c);
        assert_ok(tribo_driver_period_extremes(drv, c, &q->extremes[which][0], &q->extremes[which][1], NULL, NULL));
    }
    assert_ok(tribo_driver_period_dissipation(drv, q->energy));
    return drv;
}

static double *parameter(struct scene *s, int kind, size_t index)
{
    return kind == TRIBO_PARAMETER_LIMIT       ? &s->limit[index]
           : kind == TRIBO_PARAMETER_LOADS     ? &s->loads
           : kind == TRIBO_PARAMETER_FREQUENCY ? &s->frequency
                                               : &s->damping;
}

/* d = differences of the quantities by a parameter: of fourth order, with the guess at the motion. */
static void differentiate(const struct scene *from, int kind, size_t index, const struct quantities *at, double h,
                          struct quantities *d)
{
    static const double weight[] = {1.0 / 12.0, -2.0 / 3.0, 2.0 / 3.0, -1.0 / 12.0}, step[] = {-2.0, -1.0, 1.0, 2.0};
    double *const to = (double *)d;
    memset(d, 0, sizeof *d);
    for (int k = 0; k < 4; k++) {
        struct scene s = *from;
        struct quantities q = *at;
        *parameter(&s, kind, index) += h * step[k];
        tribo_system *sys = build(&s);
        tribo_driver_destroy(solve(&s, "exact", sys, &q));
        tribo_system_destroy(sys);
        for (size_t i = 0; i < sizeof q / sizeof(double); i++) {
            to[i] += weight[k] / h * ((const double *)&q)[i];
        }
    }
}

static const struct {
    int with;
    size_t n, contacts;
    double omega, limit;
} scenes[] = {
    {PLAIN, 3, 2, 0.7, 0.3},
    {DAMPED, 4, 3, 0.9, 0.4},
    {COUPLED | EVEN, 5, 3, 0.8, 0.5},
    {DAMPED | BASE, 4, 3, 0.8, 0.8},
    {COUPLED | BASE | EVEN, 6, 4, 1.1, 0.6},
    {DAMPED | ELASTIC, 5, 4, 0.9, 0.5},
    {COUPLED | ELASTIC | BASE | EVEN, 6, 5, 0.7, 0.35},
    {FREE, 1, 1, 0.9, 0.4},
    {FREE | DAMPED, 3, 2, 0.9, 0.4},
    {DAMPED | SWINGS, 4, 3, 0.9, 0.5},
    {COUPLED | SWINGS | ELASTIC, 4, 3, 0.9, 0.5},
    {DAMPED, 44, 7, 0.5, 0.8},
    {COUPLED | BASE | EVEN, 44, 8, 0.4, 0.8},
};

static struct scene scene_of(size_t k)
{
    struct scene s = {.with = scenes[k].with,
                      .n = scenes[k].n,
                      .contacts = scenes[k].contacts,
                      .loads = 1.0,
                      .frequency = 1.0,
                      .damping = 1.0,
                      .omega = scenes[k].omega};
    for (size_t i = 0; i < s.contacts; i++) {
        s.limit[i] = scenes[k].limit * (1.0 + 0.37 * sin(1.7 * (double)i));
    }
    return s;
}

/* NULL, or what differs by more than 2e-8 of the largest of n values, or of 1. */
static const char *off_values(const char *what, const double *got, const double *want, size_t n)
{
    double size = 1.0;
    for (size_t i = 0; i < n; i++) {
        size = fmax(size, fabs(want[i]));
    }
    return differences(what, got, want, n, 2e-8 * size);
}

/* Compares the derivatives by one parameter of kind with differences, of the longer of two steps, or of the shorter one. */
static void check_derivatives(const struct scene *s, const char *method, int kind, size_t index)
{
    struct quantities q, want, got;
    memset(&q, 0, sizeof q);
    memset(&got, 0, sizeof got);
    tribo_system *sys = build(s);
    tribo_driver *drv = solve(s, method, sys, &q);
    double c[2 * DOFS];
    const int varies = s->with & SWINGS;
    for (int which = 0; which < 2; which++) {
        combine(s, which, c);
        const int status = tribo_driver_period_derivatives(drv, 1, &kind, &index, c, got.extremes[which],
                                                           which || varies ? NULL : got.energy, which ? NULL : got.y);
        require(!status, "%s", tribo_driver_message(drv));
    }
    const char *off = "";
    for (double h = 1e-4; off && h > 1e-6; h *= 0.1) {
        differentiate(s, kind, index, &q, h, &want);
        off = off_values("y", got.y, want.y, tribo_system_dimension(sys));
        off = off ? off : off_values("extremes", got.extremes[0], want.extremes[0], 4);
        off = off || varies ? off : off_values("energies", got.energy, want.energy, s->contacts);
    }
    require(!off, "%s", off);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST(by_differences)
{
    const struct scene s = scene_of((size_t)_i / 2);
    const char *const method = methods[_i % 2];
    for (size_t i = 0; i<s.contacts; i += s.contacts> 4 ? 3 : 1) {
        check_derivatives(&s, method, TRIBO_PARAMETER_LIMIT, i);
    }
    if (!(s.with & SWINGS)) {
        check_derivatives(&s, method, TRIBO_PARAMETER_LOADS, 0);
    }
    check_derivatives(&s, method, TRIBO_PARAMETER_FREQUENCY, 0);
    check_derivatives(&s, method, TRIBO_PARAMETER_DAMPING, 0);
}

/* Many parameters in one call: the same as one by one. */
TEST(at_once)
{
    static const int kind[] = {TRIBO_PARAMETER_LIMIT, TRIBO_PARAMETER_DAMPING, TRIBO_PARAMETER_LIMIT, TRIBO_PARAMETER_LOADS,
                               TRIBO_PARAMETER_FREQUENCY};
    static const size_t index[] = {2, 0, 0, 9, 9};
    const struct scene s = scene_of(4);
    struct quantities q;
    double c[2 * DOFS], extremes[5][2], energy[5 * CONTACTS] = {0}, y[5 * STATES];
    memset(&q, 0, sizeof q);
    tribo_system *sys = build(&s);
    tribo_driver *drv = solve(&s, methods[_i], sys, &q);
    const size_t dimension = tribo_system_dimension(sys);
    combine(&s, 1, c);
    assert_ok(tribo_driver_period_derivatives(drv, 5, kind, index, c, extremes[0], energy, y));
    for (size_t j = 0; j < 5; j++) {
        struct quantities one;
        assert_ok(tribo_driver_period_derivatives(drv, 1, kind + j, index + j, c, one.extremes[0], NULL, NULL));
        assert_all_close(extremes[j], one.extremes[0], 2, 1e-11);
        assert_ok(tribo_driver_period_derivatives(drv, 1, kind + j, index + j, NULL, NULL, one.energy, NULL));
        assert_all_close(&energy[j * s.contacts], one.energy, s.contacts, 1e-11);
        assert_ok(tribo_driver_period_derivatives(drv, 1, kind + j, index + j, NULL, NULL, NULL, one.y));
        assert_all_close(&y[j * dimension], one.y, dimension, 1e-11);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* x [n] = a^-1 x by elimination with pivots. */
static void eliminate(size_t n, double a[CONTACTS][CONTACTS], double *x)
{
    for (size_t k = 0; k < n; k++) {
        size_t most = k;
        for (size_t i = k + 1; i < n; i++) {
            most = fabs(a[i][k]) > fabs(a[most][k]) ? i : most;
        }
        for (size_t j = 0; j <= n; j++) {
            double *one = j < n ? &a[k][j] : &x[k], *other = j < n ? &a[most][j] : &x[most];
            const double swap = *one;
            *one = *other;
            *other = swap;
        }
        for (size_t i = 0; i < n; i++) {
            const double part = i == k ? 0.0 : a[i][k] / a[k][k];
            for (size_t j = k; j < n; j++) {
                a[i][j] -= part * a[k][j];
            }
            x[i] -= part * x[k];
        }
    }
    for (size_t k = 0; k < n; k++) {
        x[k] /= a[k][k];
    }
}

/* Ten limits by which ten contacts dissipate the energies that are asked for: Newton's method by the derivatives finds the limits
 * that had these energies, and doubles the digits in each of the last steps. */
TEST(ten_limits)
{
    static const int kind[CONTACTS] = {0};
    struct scene s = {
        .with = DAMPED, .n = CONTACTS, .contacts = CONTACTS, .loads = 1.0, .frequency = 1.0, .damping = 2.0, .omega = 0.55};
    double want[CONTACTS], y[STATES] = {0}, energy[CONTACTS], off[9] = {0}, found[CONTACTS];
    size_t index[CONTACTS];
    struct quantities q;
    for (size_t i = 0; i < CONTACTS; i++) {
        s.limit[i] = want[i] = 0.4 + 0.15 * sin(2.0 * (double)i);
        index[i] = i;
    }
    memset(&q, 0, sizeof q);
    tribo_system *sys = build(&s);
    tribo_driver_destroy(solve(&s, "exact", sys, &q));
    tribo_driver *drv = driver_create(sys, "exact", 0.1, 1e-14);
    for (size_t i = 0; i < CONTACTS; i++) {
        found[i] = want[i] * (1.0 + 0.1 * cos(3.0 * (double)i));
    }
    size_t steps = 0;
    for (; steps < 9 && (steps == 0 || off[steps - 1] > 1e-11); steps++) {
        double by[CONTACTS][CONTACTS], jacobian[CONTACTS][CONTACTS], step[CONTACTS];
        assert_ok(tribo_set_limit(tribo_system_context(sys), found));
        assert_ok(tribo_driver_find_periodic(drv, 0.0, period_of(&s), y));
        assert_ok(tribo_driver_period_dissipation(drv, energy));
        const int status = tribo_driver_period_derivatives(drv, CONTACTS, kind, index, NULL, NULL, by[0], NULL);
        require(!status, "%s", tribo_driver_message(drv));
        for (size_t i = 0; i < CONTACTS; i++) {
            step[i] = q.energy[i] - energy[i];
            for (size_t j = 0; j < CONTACTS; j++) {
                jacobian[i][j] = by[j][i];
            }
        }
        eliminate(CONTACTS, jacobian, step);
        for (size_t i = 0; i < CONTACTS; i++) {
            found[i] += step[i];
            off[steps] = fmax(off[steps], fabs(found[i] - want[i]));
        }
    }
    assert_all_close(found, want, CONTACTS, 1e-11);
    require(steps <= 7 && off[steps - 1] < 1e-2 * off[steps - 2], "%zu steps, the last from %g to %g", steps, off[steps - 2],
            off[steps - 1]);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* A contact that rests all the time stays where it is, in derivatives by loads, too; y of the guess is the motion's. */
TEST(rests)
{
    struct scene s = scene_of(1);
    s.limit[1] = 50.0;
    check_derivatives(&s, methods[_i], TRIBO_PARAMETER_LIMIT, 0);
    check_derivatives(&s, methods[_i], TRIBO_PARAMETER_LOADS, 0);
    check_derivatives(&s, methods[_i], TRIBO_PARAMETER_FREQUENCY, 0);
}

/* Errors, which leave results as they were. */
TEST(errors)
{
    const double one[] = {1.0, 0.0}, nan[] = {NAN, 0.0}, velocity[] = {0.0, 1.0}, ratio = 1.5, belt = 0.1;
    const int limit = TRIBO_PARAMETER_LIMIT, loads = TRIBO_PARAMETER_LOADS, frequency = TRIBO_PARAMETER_FREQUENCY, none = 4;
    const size_t zero = 0, far = 1;
    struct search s = oscillator_search(methods[_i], 0.1, 0.3, 1.0, 0.7);
    double y[3] = {0}, extremes[2], energy, start[3];
    stain(extremes, sizeof extremes);
    assert_status(tribo_driver_period_derivatives(NULL, 1, &limit, &zero, one, extremes, NULL, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_driver_period_derivatives(s.drv, 1, &limit, &zero, one, extremes, NULL, NULL), TRIBO_ERR_STATE);
    find(&s, 0.0, y);
    assert_status(tribo_driver_period_derivatives(s.drv, 1, NULL, &zero, one, extremes, NULL, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_driver_period_derivatives(s.drv, 1, &limit, NULL, one, extremes, NULL, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_driver_period_derivatives(s.drv, 1, &limit, &zero, NULL, extremes, NULL, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_driver_period_derivatives(s.drv, 0, &limit, &zero, one, extremes, NULL, NULL), TRIBO_ERR_SIZE);
    assert_status(tribo_driver_period_derivatives(s.drv, 1, &none, &zero, one, extremes, NULL, NULL), TRIBO_ERR_RANGE);
    assert_status(tribo_driver_period_derivatives(s.drv, 1, &limit, &far, one, extremes, NULL, NULL), TRIBO_ERR_RANGE);
    assert_status(tribo_driver_period_derivatives(s.drv, 1, &limit, &zero, nan, extremes, NULL, NULL), TRIBO_ERR_NOT_FINITE);
    assert_ok(tribo_driver_period_derivatives(s.drv, 1, &limit, &zero, velocity, start, NULL, NULL));
    assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), 0.0));
    assert_status(tribo_driver_period_derivatives(s.drv, 1, &limit, &zero, one, extremes, NULL, NULL), TRIBO_ERR_STATE);
    find(&s, 0.0, y);
    assert_status(tribo_driver_period_derivatives(s.drv, 1, &limit, &zero, one, extremes, NULL, NULL), TRIBO_ERR_UNSUPPORTED);
    assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), 0.3));
    assert_ok(tribo_set_static(tribo_system_context(s.sys), &ratio, NULL));
    find(&s, 0.0, y);
    assert_status(tribo_driver_period_derivatives(s.drv, 1, &limit, &zero, one, extremes, NULL, NULL), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(s.drv), "static");
    assert_ok(tribo_set_static(tribo_system_context(s.sys), NULL, NULL));
    assert_ok(tribo_system_add_limit(s.sys, 1.4, &belt, NULL));
    find(&s, 0.0, y);
    assert_status(tribo_driver_period_derivatives(s.drv, 1, &loads, &zero, one, extremes, NULL, NULL), TRIBO_ERR_UNSUPPORTED);
    assert_status(tribo_driver_period_derivatives(s.drv, 1, &limit, &zero, one, NULL, &energy, NULL), TRIBO_ERR_UNSUPPORTED);
    assert_ok(tribo_system_clear_limits(s.sys));
    assert_ok(tribo_system_add_base_motion(s.sys, 0.0, &belt, NULL));
    find(&s, 0.0, y);
    assert_status(tribo_driver_period_derivatives(s.drv, 1, &frequency, &zero, one, extremes, NULL, NULL), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(s.drv), "constant speed");
    ck_assert_int_eq(stained(extremes, sizeof extremes), 1);
    search_free(&s);
}

/* Where the period begins as a contact stops there is no derivative of the state. Where two contacts of a symmetric structure,
 * that act on each other, stop at one instant, a limit that changes parts them. */
TEST(no_derivative)
{
    const int kind = TRIBO_PARAMETER_LIMIT;
    const size_t index = 0;
    const double one[] = {1.0, 0.0}, beta = 0.5, mass[] = {1.0, 0.3, 0.3, 1.0}, stiffness[] = {2.0, -1.0, -1.0, 2.0},
                 damping[] = {0.1, 0.0, 0.0, 0.1}, direction[] = {1.0, 0.0, 0.0, 1.0}, cosine[] = {1.0, 1.0},
                 limit[] = {0.1, 0.1}, c[] = {1.0, 0.0, 0.0, 0.0};
    double y[3] = {1.0 / (1.0 - beta * beta), 0.0}, extremes[2], z[5] = {0};
    struct search s = oscillator_search(methods[_i], 0.0, 0.05, 1.0, beta);
    find(&s, 0.0, y);
    assert_status(tribo_driver_period_derivatives(s.drv, 1, &kind, &index, one, extremes, NULL, NULL), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(s.drv), "begins");
    search_free(&s);
    s = search_create(methods[_i], 2, 2, mass, damping, stiffness, direction, 0.8, cosine);
    assert_ok(tribo_set_limit(tribo_system_context(s.sys), limit));
    find(&s, 0.0, z);
    assert_status(tribo_driver_period_derivatives(s.drv, 1, &kind, &index, c, extremes, NULL, NULL), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(s.drv), "one instant");
    search_free(&s);
}

/* -------------------------------------------------------------------------------------------------------- multipliers */

/* Of Den Hartog's motion, beta = 0.7, r = 0.3: with rho = (x0 beta^2 - r)/(x0 beta^2 + r) the multipliers are lambda^2,
 * lambda^2 + (1 + rho) cos(pi/beta) lambda + rho = 0. */
TEST(multipliers_den_hartog)
{
    static const int kind[] = {TRIBO_PARAMETER_LIMIT, TRIBO_PARAMETER_LOADS, TRIBO_PARAMETER_FREQUENCY, TRIBO_PARAMETER_DAMPING};
    static const size_t index[4] = {0};
    const double by_limit = -0.51052875503341, by_beta = 4.80844813153893, r = 0.3, beta = 0.7, square = beta * beta;
    struct search s = oscillator_search(methods[_i], 0.0, r, 1.0, beta);
    double y[3] = {0}, mr[2], mi[2], re[4], im[4];
    find(&s, 0.0, y);
    const double x0 = amplitude(&s, 0), sum = x0 * square + r, c = cos(PI / beta), rho = (x0 * square - r) / sum;
    const double by_x0 = 2.0 * r * square / (sum * sum), by_r = -2.0 * x0 * square / (sum * sum);
    const double rho_by[] = {by_r + by_x0 * by_limit, -r * (by_r + by_x0 * by_limit),
                             beta * by_x0 * by_beta + 4.0 * x0 * square * r / (sum * sum), 0.0};
    const double c_by[] = {0.0, 0.0, sin(PI / beta) * PI / beta, 0.0};
    const double complex lambda = csqrt((1.0 + rho) * (1.0 + rho) * c * c / 4.0 - rho) - (1.0 + rho) * c / 2.0;
    assert_ok(tribo_driver_get_multipliers(s.drv, mr, mi));
    for (size_t k = 0; k < 2; k++) {
        const int upper = cimag(lambda * lambda) * mi[k] > 0.0;
        assert_close(mr[k], creal(lambda * lambda), 1e-10);
        assert_ok(tribo_driver_multiplier_derivatives(s.drv, k, 4, kind, index, re, im));
        for (size_t j = 0; j < 4; j++) {
            const double complex by = -(rho_by[j] * c * lambda + (1.0 + rho) * c_by[j] * lambda + rho_by[j]) /
                                      (2.0 * lambda + (1.0 + rho) * c) * 2.0 * lambda;
            assert_close(re[j], creal(by), 1e-9);
            assert_close(im[j], upper ? cimag(by) : -cimag(by), 1e-9);
        }
    }
    search_free(&s);
}

/* to[2] = the multiplier nearest to at[2] of the scene with a parameter more by h, from the guess y. */
static void multiplier_beside(const struct scene *from, int kind, size_t index, double h, const double *y, const double *at,
                              double *to)
{
    double guess[STATES], re[STATES], im[STATES], nearest = HUGE_VAL;
    struct scene s = *from;
    *parameter(&s, kind, index) += h;
    tribo_system *sys = build(&s);
    tribo_driver *drv = driver_create(sys, "exact", 0.1, 1e-14);
    memcpy(guess, y, sizeof guess);
    assert_ok(tribo_driver_find_periodic(drv, 0.0, period_of(&s), guess));
    assert_ok(tribo_driver_get_multipliers(drv, re, im));
    for (size_t k = 0; k + 1 < tribo_system_dimension(sys); k++) {
        const double off = hypot(re[k] - at[0], im[k] - at[1]);
        if (off < nearest) {
            nearest = off;
            to[0] = re[k];
            to[1] = im[k];
        }
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Compares the derivative of multiplier `which` with differences of fourth order by two steps, extrapolated to step 0. */
static void check_multiplier(const struct scene *s, tribo_driver *drv, size_t which, int kind, size_t index, const double *y)
{
    double mr[STATES], mi[STATES], got[2], coarse[2], fine[2];
    assert_ok(tribo_driver_get_multipliers(drv, mr, mi));
    const int status = tribo_driver_multiplier_derivatives(drv, which, 1, &kind, &index, got, got + 1);
    require(!status, "multiplier %zu: %s", which, tribo_driver_message(drv));
    for (int half = 0; half < 2; half++) {
        const double h = half ? 1e-4 : 2e-4, at[] = {mr[which], mi[which]};
        double *const by = half ? fine : coarse, a[2], b[2], c[2], d[2];
        multiplier_beside(s, kind, index, -2.0 * h, y, at, a);
        multiplier_beside(s, kind, index, -h, y, at, b);
        multiplier_beside(s, kind, index, h, y, at, c);
        multiplier_beside(s, kind, index, 2.0 * h, y, at, d);
        for (size_t k = 0; k < 2; k++) {
            by[k] = (a[k] - d[k] + 8.0 * (c[k] - b[k])) / (12.0 * h);
        }
    }
    const double size = fmax(1.0, hypot(got[0], got[1]));
    for (size_t k = 0; k < 2; k++) {
        const double want = fine[k] + (fine[k] - coarse[k]) / 15.0;
        require(fabs(got[k] - want) <= 1e-8 * size, "multiplier %zu, kind %d of %zu: %.15g, differences %.15g and %.15g", which,
                kind, index, got[k], fine[k], coarse[k]);
    }
}

TEST(multipliers_by_differences)
{
    static const size_t scene[] = {0, 1, 8, 2, 4, 5, 6, 11};
    struct scene s = scene_of(scene[_i / 2]);
    double y[STATES] = {0}, share[CONTACTS];
    size_t rest = 0;
    s.with &= ~BASE;
    for (size_t i = 0; _i >= 6 && _i < 10 && i < s.contacts; i++) {
        s.limit[i] *= 1.7; /* contacts rest for a part of the period */
    }
    tribo_system *sys = build(&s);
    tribo_driver *drv = driver_create(sys, methods[_i % 2], 0.1, 1e-14);
    assert_ok(tribo_driver_find_periodic(drv, 0.0, period_of(&s), y));
    if (_i >= 6) {
        assert_ok(tribo_driver_period_stick(drv, share));
        for (size_t i = 0; i < s.contacts; i++) {
            rest += share[i] > 0.0 && share[i] < 1.0;
        }
        ck_assert_uint_ge(rest, 1);
    }
    for (size_t which = 0; which < 3; which += 2) {
        check_multiplier(&s, drv, which, TRIBO_PARAMETER_LIMIT, 0, y);
        check_multiplier(&s, drv, which, TRIBO_PARAMETER_LIMIT, s.contacts - 1, y);
        check_multiplier(&s, drv, which, TRIBO_PARAMETER_LOADS, 0, y);
        if (_i < 14) { /* the large structure has two multipliers that nearly merge over the frequency */
            check_multiplier(&s, drv, which, TRIBO_PARAMETER_FREQUENCY, 0, y);
        }
        check_multiplier(&s, drv, which, TRIBO_PARAMETER_DAMPING, 0, y);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* A contact at rest has the multiplier 1, whatever the parameters; two have it twice. */
TEST(multipliers_of_rest)
{
    static const int kind[] = {TRIBO_PARAMETER_LIMIT, TRIBO_PARAMETER_LOADS, TRIBO_PARAMETER_FREQUENCY};
    static const size_t index[3] = {0};
    double y[STATES] = {0}, re[3], im[3], zero[3] = {0};
    struct scene s = scene_of(1);
    for (size_t resting = 1; resting < 3; resting++) {
        s.limit[resting] = 50.0;
        tribo_system *sys = build(&s);
        tribo_driver *drv = driver_create(sys, methods[_i], 0.1, 1e-14);
        assert_ok(tribo_driver_find_periodic(drv, 0.0, period_of(&s), y));
        const int status = tribo_driver_multiplier_derivatives(drv, 0, 3, kind, index, re, im);
        assert_status(status, resting == 1 ? TRIBO_OK : TRIBO_ERR_UNSUPPORTED);
        if (status) {
            assert_says(tribo_driver_message(drv), "repeated");
        } else {
            assert_all_close(re, zero, 3, 1e-10);
            assert_all_close(im, zero, 3, 1e-10);
        }
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}

/* Two equal oscillators apart have each multiplier twice; two contacts on one body stop at one instant. */
TEST(multipliers_refused)
{
    const int limit = TRIBO_PARAMETER_LIMIT, frequency = TRIBO_PARAMETER_FREQUENCY;
    const size_t zero = 0;
    const double unit[] = {1.0, 0.0, 0.0, 1.0}, part[] = {0.1, 0.0, 0.0, 0.1}, cosine[] = {1.0, 1.0}, both[] = {1.0, 1.0},
                 limits[] = {0.1, 0.2}, ratio = 1.5;
    double y[5] = {0}, z[3] = {0}, re, im;
    struct search s = search_create(methods[_i], 2, 2, unit, part, unit, unit, 0.7, cosine);
    assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), 0.3));
    find(&s, 0.0, y);
    assert_status(tribo_driver_multiplier_derivatives(s.drv, 0, 1, &limit, &zero, &re, &im), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(s.drv), "repeated");
    search_free(&s);
    s = search_create(methods[_i], 1, 2, unit, part, unit, both, 0.7, cosine);
    assert_ok(tribo_set_limit(tribo_system_context(s.sys), limits));
    find(&s, 0.0, z);
    assert_status(tribo_driver_multiplier_derivatives(s.drv, 0, 1, &limit, &zero, &re, &im), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(s.drv), "one instant");
    search_free(&s);
    s = oscillator_search(methods[_i], 0.1, 0.3, 1.0, 0.7);
    re = im = 7.0;
    assert_status(tribo_driver_multiplier_derivatives(NULL, 0, 1, &limit, &zero, &re, &im), TRIBO_ERR_NULL);
    assert_status(tribo_driver_multiplier_derivatives(s.drv, 0, 1, &limit, &zero, &re, &im), TRIBO_ERR_STATE);
    find(&s, 0.0, z);
    assert_status(tribo_driver_multiplier_derivatives(s.drv, 0, 1, NULL, &zero, &re, &im), TRIBO_ERR_NULL);
    assert_status(tribo_driver_multiplier_derivatives(s.drv, 0, 1, &limit, NULL, &re, &im), TRIBO_ERR_NULL);
    assert_status(tribo_driver_multiplier_derivatives(s.drv, 0, 1, &limit, &zero, NULL, &im), TRIBO_ERR_NULL);
    assert_status(tribo_driver_multiplier_derivatives(s.drv, 0, 1, &limit, &zero, &re, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_driver_multiplier_derivatives(s.drv, 0, 0, &limit, &zero, &re, &im), TRIBO_ERR_SIZE);
    assert_status(tribo_driver_multiplier_derivatives(s.drv, 2, 1, &limit, &zero, &re, &im), TRIBO_ERR_RANGE);
    assert_ok(tribo_system_add_base_motion(s.sys, 0.7, NULL, limits));
    find(&s, 0.0, z);
    assert_status(tribo_driver_multiplier_derivatives(s.drv, 0, 1, &frequency, &zero, &re, &im), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(s.drv), "bases");
    assert_ok(tribo_system_clear_base_motion(s.sys));
    assert_ok(tribo_set_static(tribo_system_context(s.sys), &ratio, NULL));
    find(&s, 0.0, z);
    assert_status(tribo_driver_multiplier_derivatives(s.drv, 0, 1, &limit, &zero, &re, &im), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(s.drv), "static");
    assert_exact(re, 7.0);
    assert_exact(im, 7.0);
    search_free(&s);
}

/* Damping where the series of a perturbed motion is shorter than that of the motion; the contact never slides. */
TEST(multipliers_by_shorter_series)
{
    static const double mass[] = {0.6, 0.0, 0.0, 0.6}, stiffness[] = {4.0, -1.0, -1.0, 3.5}, damping[] = {0.2, -0.05, -0.05, 0.3},
                        row[] = {1.0, 0.5}, compliance[] = {0.1};
    static const int kind = TRIBO_PARAMETER_DAMPING;
    static const size_t zero = 0;
    double re[2][5], im[2][5];
    for (int k = 0; k < 2; k++) {
        double y[6] = {0}, x[5], v[5];
        tribo_model *model = dense_model(2, 1, mass, damping, stiffness, row);
        assert_ok(tribo_model_set_compliance(model, compliance));
        tribo_system *sys = finish_model(model);
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), 10.0));
        assert_ok(tribo_system_add_load(sys, 1.1, (const double[]){0.3, 0.2}, NULL));
        assert_ok(tribo_system_add_load(sys, 2.2, (const double[]){0.1, -0.1}, NULL));
        tribo_driver *drv = driver_create(sys, methods[k], 0.1, 1e-14);
        assert_ok(tribo_driver_find_periodic(drv, 0.3, 2.0 * PI / 1.1, y));
        assert_ok(tribo_driver_get_multipliers(drv, x, v));
        for (size_t i = 0; i < 5; i++) {
            assert_ok(tribo_driver_multiplier_derivatives(drv, i, 1, &kind, &zero, &re[k][i], &im[k][i]));
        }
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    assert_all_close(re[1], re[0], 5, 1e-8);
    assert_all_close(im[1], im[0], 5, 1e-8);
}

TEST_MAIN("period_derivatives", {den_hartog, 3}, {most_energy, 3}, {by_differences, 2 * COUNT(scenes)}, {at_once, 3},
          {ten_limits, 1}, {rests, 2}, {errors, 3}, {no_derivative, 3}, {multipliers_den_hartog, 3},
          {multipliers_by_differences, 16}, {multipliers_of_rest, 2}, {multipliers_refused, 2},
          {multipliers_by_shorter_series, 1})
