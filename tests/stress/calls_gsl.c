/* SPDX-License-Identifier: BSD-3-Clause */
/* A string of bytes as a program for tribo_gsl.h: systems of all kinds are created, loaded, changed and destroyed, drivers of all
 * methods advance them, with legal and illegal arguments in any order that is allowed. What must hold whatever comes: states are
 * finite, and on an error untouched or those of the last good step; errors have a message; outputs of calls that fail stay as
 * they were; nothing crashes, and GSL's error handler, which aborts, is never called.
 *
 * ctest replays the strings in corpus_gsl, and TRIBO_BLOCKS times 1000 random ones from TRIBO_SEED on. As a target of
 * libFuzzer: ../fuzz. */
#include <math.h>
#include <string.h>

#include "calls_gsl.h"
#include "make.h"
#include "../set_up_driver.h"

/* Least pivot of a mass matrix over its diagonal, in scenes whose events are looked for. */
#define LIGHT 1e-8

const char *input = "";

/* ------------------------------------------------------------------------------------------------------------- choices */

size_t choose(struct bytes *b, size_t n)
{
    if (b->left == 0) {
        return 0;
    }
    b->left--;
    return *b->at++ % n;
}

double number(struct bytes *b)
{
    static const double plain[] = {0.0, 1.0, -1.0, 0.5, 2.0, -0.25, 3.0, 0.1, 1e-3, 10.0, 0.3, -2.0, 1.0, 0.7},
                        odd[] = {NAN, HUGE_VAL, -HUGE_VAL, 1e300, -1e200, 1e-300, 4e-320, -0.0};
    const size_t k = choose(b, 64);
    return k == 63 ? odd[choose(b, COUNT(odd))] : plain[k % COUNT(plain)];
}

double positive(struct bytes *b)
{
    const double x = number(b);
    return x == 0.0 || choose(b, 16) == 15 ? x : fabs(x);
}

void fill(struct bytes *b, double *x, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        x[i] = number(b);
    }
}

int wild(const double *x, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (!(fabs(x[i]) < 1e6) || (x[i] != 0.0 && fabs(x[i]) < 1e-9)) {
            return 1;
        }
    }
    return 0;
}

int are_finite(const double *y, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(y[i])) {
            return 0;
        }
    }
    return 1;
}

/* A call on a system: an error has a message. */
static void check(const struct scene *s, int status)
{
    const char *text = tribo_system_message(s->sys);
    demand(status == TRIBO_OK || text[0] != '\0', "status %d without a message", status);
    demand(strcmp(tribo_strerror(status), tribo_strerror(-1)) != 0, "status %d is unknown", status);
}

/* A call on the context that the system lends. */
static void check_setting(const tribo_context *c, int status)
{
    demand(status == TRIBO_OK || tribo_message(c)[0] != '\0', "status %d without a message", status);
}

static void destroy_scene(struct scene *s)
{
    for (size_t k = 0; k < DRIVERS; k++) {
        tribo_driver_destroy(s->run[k].drv);
    }
    tribo_system_destroy(s->sys);
    memset(s, 0, sizeof *s);
}

void fill_matrix(struct bytes *b, double *a, size_t n, double diagonal)
{
    const size_t kind = choose(b, 8);
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < i; j++) {
            a[i * n + j] = a[j * n + i] = kind < 4 ? 0.0 : 0.1 * number(b);
        }
        a[i * n + i] = kind == 7 ? number(b) : diagonal + positive(b);
    }
    if (kind == 6 && choose(b, 8) == 7 && n > 1) {
        a[1] += 1.0;
    }
}

int light(const double *mass, size_t n)
{
    double a[MOST_DOFS * MOST_DOFS];
    memcpy(a, mass, n * n * sizeof *a);
    for (size_t k = 0; k < n; k++) {
        if (!(a[k * n + k] > LIGHT * mass[k * n + k])) {
            return 1;
        }
        for (size_t i = k + 1; i < n; i++) {
            for (size_t j = k + 1; j < n; j++) {
                a[i * n + j] -= a[i * n + k] * a[k * n + j] / a[k * n + k];
            }
        }
    }
    return 0;
}

static int create_linear(struct bytes *b, struct scene *s)
{
    double mass[MOST_DOFS * MOST_DOFS], damping[MOST_DOFS * MOST_DOFS], stiffness[MOST_DOFS * MOST_DOFS],
        direction[MOST_CONTACTS * MOST_DOFS];
    char text[200] = "";
    const size_t n = 1 + choose(b, 4), c = choose(b, 5), nmode = choose(b, 4) == 3 ? choose(b, 6) : 0, damped = choose(b, 3);
    fill_matrix(b, mass, n, 0.5);
    fill_matrix(b, stiffness, n, choose(b, 8) == 7 ? -1.0 : 0.0);
    fill_matrix(b, damping, n, 0.0);
    fill(b, direction, c * n);
    s->given = n;
    s->wild = light(mass, n) || wild(mass, n * n) || wild(stiffness, n * n) || wild(damping, n * n) || wild(direction, c * n);
    const int status =
        dense_system(&s->sys, n, c, mass, damped == 1 ? damping : NULL, stiffness, direction, nmode, text, sizeof text);
    demand(status == TRIBO_OK || text[0] != '\0', "status %d without a message", status);
    return status;
}

static void create_scene(struct bytes *b, struct scene *s)
{
    const double x = positive(b), y = number(b), z = number(b), w = positive(b), all[] = {x, y, z, w};
    int status;
    destroy_scene(s);
    s->wild = wild(all, 4);
    switch (choose(b, 5)) {
    case 0:
        status = tribo_system_oscillator(&s->sys, x, y, z);
        break;
    case 1:
        status = tribo_system_chain(&s->sys, 1 + choose(b, 5), x, y, z);
        break;
    case 2:
        status = tribo_system_belt(&s->sys, y, x, w, z, y);
        break;
    case 4:
        status = create_pressed(b, s);
        break;
    default:
        status = create_linear(b, s);
        break;
    }
    demand((status == TRIBO_OK) == (s->sys != NULL), "status %d", status);
    s->n = tribo_system_ndof(s->sys);
    s->c = tribo_system_ncontact(s->sys);
    s->dimension = tribo_system_dimension(s->sys);
    s->given = s->given ? s->given : s->n;
    demand(s->n <= MOST_DOFS && s->c <= MOST_CONTACTS, "%zu, %zu", s->n, s->c);
}

/* -------------------------------------------------------------------------------------------------- changes of a system */

static void load(struct bytes *b, struct scene *s)
{
    double cosine[MOST_DOFS], sine[MOST_DOFS], time[3], value[3 * MOST_CONTACTS];
    const size_t knots = choose(b, 4), some = choose(b, 3);
    const double omega = number(b);
    fill(b, cosine, MOST_DOFS);
    fill(b, sine, MOST_DOFS);
    fill(b, value, COUNT(value));
    time[0] = number(b);
    time[1] = time[0] + positive(b);
    time[2] = time[1] + positive(b);
    s->omega = omega;
    s->wild |= wild(&omega, 1) || wild(cosine, MOST_DOFS) || wild(sine, MOST_DOFS) || wild(value, COUNT(value)) || wild(time, 3);
    switch (choose(b, 6)) {
    case 0:
        check(s, tribo_system_add_load(s->sys, omega, some ? cosine : NULL, some < 2 ? sine : NULL));
        break;
    case 1:
        check(s, tribo_system_add_base_motion(s->sys, omega, some ? cosine : NULL, some < 2 ? sine : NULL));
        break;
    case 2:
        check(s, tribo_system_add_load_table(s->sys, knots, time, value, choose(b, 16) ? cosine : NULL));
        break;
    case 3:
        for (size_t k = 0; k < COUNT(value) && choose(b, 16); k++) {
            value[k] = fabs(value[k]);
        }
        check(s, tribo_system_set_limit_table(s->sys, knots, time, value));
        break;
    case 4:
        check(s, tribo_system_add_limit(s->sys, omega, some ? cosine : NULL, some < 2 ? sine : NULL));
        break;
    default:
        check(s, tribo_system_set_damping_ratio(s->sys, 0.1 * positive(b)));
        break;
    }
}

static void set(struct bytes *b, struct scene *s)
{
    tribo_context *c = tribo_system_context(s->sys);
    double x[MOST_CONTACTS];
    for (size_t i = 0; i < MOST_CONTACTS; i++) {
        x[i] = positive(b);
    }
    s->wild |= wild(x, MOST_CONTACTS);
    switch (choose(b, 8)) {
    case 0:
        check_setting(c, tribo_set_limit(c, x));
        break;
    case 1:
        check_setting(c, tribo_set_limit_all(c, x[0]));
        break;
    case 2:
        check_setting(c, tribo_set_epsilon(c, x));
        break;
    case 3:
        check_setting(c, tribo_set_epsilon_all(c, 0.1 * x[0]));
        break;
    case 4:
        check_setting(c, tribo_set_epsilon_step(c, x[0], x[1]));
        break;
    case 5:
        check_setting(c, tribo_set_law(c, (int)choose(b, 8) - 1));
        break;
    case 6:
        check_setting(c, tribo_set_coupling(c, (int)choose(b, 4) - 1));
        break;
    default:
        check_setting(c, tribo_set_sharing(c, (int)choose(b, 4) - 1));
        break;
    }
}

static void ask(struct bytes *b, struct scene *s, const struct run *r)
{
    double v[MOST_CONTACTS], feq[MOST_CONTACTS], f[MOST_CONTACTS], y[MOST_STATES], omega[MOST_DOFS], full[MOST_DOFS];
    const double t = number(b);
    memcpy(y, r->y, sizeof y);
    y[choose(b, MOST_STATES)] = number(b);
    const int which = (int)choose(b, 3),
              status = tribo_system_contacts(s->sys, t, y, which ? v : NULL, which == 1 ? feq : NULL, f);
    check(s, status);
    demand(status || are_finite(f, s->c), "forces are not finite");
    demand(status || !which || are_finite(v, s->c), "velocities are not finite");
    check(s, tribo_system_accept(s->sys, t, y));
    check(s, tribo_system_get_frequencies(s->sys, omega));
    check(s, tribo_system_expand(s->sys, y, full));
}

/* ------------------------------------------------------------------------------------------------------------ drivers */

static int observe(const tribo_moment *moment, void *data)
{
    const double t = moment->t, *y = moment->y;
    const int step = moment->kind == TRIBO_MOMENT_STEP;
    struct run *r = data;
    demand(moment->size == sizeof *moment, "size %zu", moment->size);
    demand(step || (r->events && moment->kind > 0 && moment->kind <= TRIBO_MOMENT_TOUCH), "kind %d", moment->kind);
    demand(step ? moment->contact == SIZE_MAX : moment->contact < r->contacts, "contact %zu", moment->contact);
    demand(t >= r->last && t <= r->to, "%.17g after %.17g, from %.17g to %.17g", t, r->last, r->from, r->to);
    for (size_t i = 0; i < 3; i++) {
        demand(isfinite(y[i]), "y[%zu] = %g", i, y[i]);
    }
    r->last = t;
    return ++r->seen >= r->patience ? 1 : 0;
}

/* A setting, or what it must refuse. */
static void tune(struct bytes *b, struct run *r)
{
    static const double tolerances[] = {1e-6, 1e-3, 1e-9, 0.0, 1e-1, -1.0, NAN};
    const double h = 0.1 * positive(b);
    double abstol, reltol;
    int status;
    switch (choose(b, 4)) {
    case 0:
        status = tribo_driver_set_max_step(r->drv, h);
        break;
    case 1:
        abstol = tolerances[choose(b, 16) % COUNT(tolerances)];
        reltol = tolerances[choose(b, 16) % COUNT(tolerances)];
        status = tribo_driver_set_tolerance(r->drv, abstol, reltol);
        r->tolerance = status ? r->tolerance : fmax(abstol, reltol);
        break;
    case 2:
        status = tribo_driver_set_output(r->drv, h);
        break;
    default:
        status = tribo_driver_set_step(r->drv, h);
        break;
    }
    demand(status == TRIBO_OK || tribo_driver_message(r->drv)[0] != '\0', "status %d without a message", status);
}

static void create_run(struct bytes *b, struct scene *s, struct run *r)
{
    const int kind = (int)choose(b, (size_t)any_method_count() + 1);
    const char *const name = kind < any_method_count() ? any_method_name(kind) : "rk5";
    tribo_driver_destroy(r->drv);
    memset(r, 0, sizeof *r);
    const int status = create_any_driver(&r->drv, s->sys, name);
    check(s, status);
    demand((status == TRIBO_OK) == (r->drv != NULL), "status %d", status);
    demand(status || strlen(tribo_driver_method(r->drv)) > 1, "no name");
    r->events = strcmp(name, "exact") == 0 || strcmp(name, "event") == 0 || strcmp(name, "auto") == 0;
    r->patience = PATIENCE;
    r->contacts = s->c;
    for (int k = 0; !status && k < 3; k++) {
        tune(b, r);
    }
}

static void set_run(struct bytes *b, const struct scene *s, struct run *r)
{
    size_t count;
    switch (choose(b, 4)) {
    case 0:
        fill(b, r->y, s->dimension);
        break;
    case 1:
        tune(b, r);
        break;
    case 2:
        r->patience = 1 + choose(b, 40);
        break;
    default:
        for (int which = TRIBO_COUNT_STEPS; which <= TRIBO_COUNT_EVENTS; which++) {
            demand(tribo_driver_count(r->drv, which, &count) == TRIBO_OK, "count %d", which);
        }
        break;
    }
}

/* Steps of exact and event may be many where numbers are wild, and the others' where only few of them make dt: those are left
 * out. */
int bearable(const struct scene *s, const struct run *r, double span)
{
    return !(r->events && (s->wild || wild(r->y, s->dimension) || wild(&r->t, 1) || wild(&span, 1)));
}

static void advance(struct bytes *b, struct scene *s, struct run *r)
{
    static const double spans[] = {0.1, 1.0, 0.0, 0.01, 0.5, 3.0, 1e-6, 0.1, -1.0, NAN, 1e-300, 1e20};
    const double span = spans[choose(b, 16) % COUNT(spans)], before = r->t, t1 = before + span;
    double y[MOST_STATES];
    if (!bearable(s, r, span)) {
        return;
    }
    memcpy(y, r->y, sizeof y);
    r->from = r->last = before;
    r->to = t1;
    r->seen = 0;
    demand(tribo_driver_set_observer(r->drv, observe, r) == TRIBO_OK, "observer");
    const int legal = isfinite(t1) && t1 >= before && are_finite(y, s->dimension);
    const int status = tribo_driver_advance(r->drv, &r->t, t1, r->y);
    demand(status == TRIBO_OK || tribo_driver_message(r->drv)[0] != '\0', "status %d without a message", status);
    demand(strcmp(tribo_strerror(status), tribo_strerror(-1)) != 0, "status %d is unknown", status);
    demand(legal || status, "illegal, but well done");
    demand(legal || (r->t == before && memcmp(y, r->y, sizeof y) == 0), "illegal, but changed");
    demand(!legal || are_finite(r->y, s->dimension), "%s, status %d: not finite", tribo_driver_method(r->drv), status);
    demand(!legal || (r->t >= before && r->t <= t1), "%.17g from %.17g to %.17g", r->t, before, t1);
    demand(status || r->t == t1, "%.17g, not %.17g", r->t, t1);
    demand(status != TRIBO_ERR_STOPPED || r->seen == r->patience, "stopped by nobody");
    demand(r->seen < r->patience || status, "not stopped");
    if (!are_finite(r->y, s->dimension)) {
        memset(r->y, 0, sizeof r->y);
    }
}

/* --------------------------------------------------------------------------------------------------------------- input */

static void step(struct bytes *b, struct scene *s)
{
    struct run *r = &s->run[choose(b, DRIVERS)];
    const size_t what = choose(b, 16);
    if (!s->sys || what == 15) {
        create_scene(b, s);
    } else if (what == 14) {
        destroy_scene(s);
    } else if (what == 13) {
        load(b, s);
    } else if (what == 12 || what == 11) {
        set(b, s);
    } else if (what == 10) {
        ask(b, s, r);
    } else if (!r->drv || what == 9) {
        create_run(b, s, r);
    } else if (what == 8) {
        set_run(b, s, r);
    } else if (what == 7) {
        periods(b, s, r);
    } else {
        advance(b, s, r);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct bytes b = {data, size};
    struct scene scene[SYSTEMS];
    memset(scene, 0, sizeof scene);
    for (int calls = 0; calls < MOST_CALLS && b.left; calls++) {
        step(&b, &scene[choose(&b, SYSTEMS)]);
    }
    for (size_t k = 0; k < SYSTEMS; k++) {
        destroy_scene(&scene[k]);
    }
    return 0;
}

#ifndef TRIBO_FUZZER
static void replay_file(const char *name)
{
    static uint8_t data[1 << 16];
    FILE *file = fopen(name, "rb");
    demand(file, "cannot be read");
    const size_t size = fread(data, 1, sizeof data, file);
    fclose(file);
    input = name;
    LLVMFuzzerTestOneInput(data, size);
}

/* splitmix64, as in support.c. */
static uint64_t draw(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static void replay_seed(unsigned long seed)
{
    uint8_t data[2000];
    char name[40];
    uint64_t state = seed;
    const size_t size = 20 + draw(&state) % (sizeof data - 20);
    for (size_t i = 0; i < size; i++) {
        data[i] = (uint8_t)(draw(&state) >> 20);
    }
    snprintf(name, sizeof name, "seed %lu", seed);
    input = name;
    LLVMFuzzerTestOneInput(data, size);
}

static unsigned long setting(const char *name, unsigned long otherwise)
{
    const char *text = getenv(name);
    return text ? strtoul(text, NULL, 10) : otherwise;
}

/* Arguments: files to replay. */
int main(int argc, char **argv)
{
    const unsigned long first = setting("TRIBO_SEED", 0), count = 1000 * setting("TRIBO_BLOCKS", 1);
    for (int k = 1; k < argc; k++) {
        replay_file(argv[k]);
    }
    for (unsigned long seed = first; seed < first + count; seed++) {
        replay_seed(seed);
    }
    printf("%d files and %lu random strings\n", argc - 1, count);
    return 0;
}
#endif
