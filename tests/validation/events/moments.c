/* SPDX-License-Identifier: BSD-3-Clause */
/* Moments that an observer sees: which contact changes, and how, compared with what contacts do before and after. */
#include <stdint.h>
#include <string.h>

#include "../sliders.h"
#include "set_up_driver.h"

#define MOST 4000
#define MOST_DOF 6
#define MOST_CONTACTS 4

/* A system and how long it is watched; the methods that can do it. */
struct scene {
    const char *name;
    tribo_system *(*create)(void);
    double end, start[2 * MOST_DOF + 1];
    int exact;
    unsigned kinds; /* those that must occur, bit by bit */
};

enum {
    STICK = 1 << TRIBO_MOMENT_STICK,
    SLIP = 1 << TRIBO_MOMENT_SLIP,
    REVERSE = 1 << TRIBO_MOMENT_REVERSE,
    LIFT = 1 << TRIBO_MOMENT_LIFT,
    TOUCH = 1 << TRIBO_MOMENT_TOUCH
};

static tribo_system *weak(void)
{
    return oscillator(TRIBO_COULOMB, 1.5, 0.5);
}

static tribo_system *strong(void)
{
    return oscillator(TRIBO_COULOMB, 30.0, 0.5);
}

/* Two oscillators alike, each with its contact, on one load; coupled by a spring that is never stretched. */
static tribo_system *twins(void)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {1.5, -0.5, -0.5, 1.5}, load[] = {1.5, 1.5};
    tribo_system *s = linear(2, 2, mass, NULL, stiffness, mass);
    assert_ok(tribo_set_limit_all(tribo_system_context(s), 1.0));
    assert_ok(tribo_system_add_load(s, 0.5, NULL, load));
    return s;
}

static tribo_system *belt(void)
{
    tribo_system *s;
    assert_ok(tribo_system_belt(&s, 2.0, 0.5, 0.25, 1.0, 0.5));
    return s;
}

static tribo_system *liftoff(void)
{
    const double one = 1.0, damping = 0.1, limit = 0.6;
    tribo_system *s = linear(1, 1, &one, &damping, &one, &one);
    assert_ok(tribo_set_limit_all(tribo_system_context(s), limit));
    assert_ok(tribo_system_add_load(s, 0.35, &one, NULL));
    assert_ok(tribo_system_add_limit(s, 0.35, NULL, &one));
    return s;
}

/* The limit falls to 0 and rises again by a table. */
static tribo_system *opened(void)
{
    const double time[] = {0.0, 3.0, 6.0, 9.0, 12.0}, limit[] = {1.0, 1.0, 0.0, 0.0, 2.0};
    tribo_system *s = weak();
    assert_ok(tribo_system_set_limit_table(s, 5, time, limit));
    return s;
}

/* Contact 1 and 2 are one in a plane, 0 is scalar. */
static tribo_system *planar(void)
{
    const double mass[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const double stiffness[9] = {1.0, 0.0, 0.0, 0.0, 1.7, 0.0, 0.0, 0.0, 1.2};
    const double direction[9] = {0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0};
    const double limit[3] = {0.4, 1.0, 1.0}, cosine[3] = {0.0, 0.4, 0.2}, sine[3] = {1.3, 0.0, 1.0};
    const size_t first = 1;
    tribo_system *s = linear(3, 3, mass, NULL, stiffness, direction);
    assert_ok(tribo_set_planar(tribo_system_context(s), 1, &first));
    assert_ok(tribo_set_limit(tribo_system_context(s), limit));
    assert_ok(tribo_system_add_load(s, 0.7, cosine, sine));
    return s;
}

/* A contact in the plane that goes to and fro on a line, as in weak and strong. */
static tribo_system *line(double size)
{
    const double identity[4] = {1.0, 0.0, 0.0, 1.0}, load[2] = {0.6 * size, 0.8 * size};
    const size_t first = 0;
    tribo_system *s = linear(2, 2, identity, NULL, identity, identity);
    assert_ok(tribo_set_planar(tribo_system_context(s), 1, &first));
    assert_ok(tribo_set_limit_all(tribo_system_context(s), 1.0));
    assert_ok(tribo_system_add_load(s, 0.5, NULL, load));
    return s;
}

static tribo_system *weak_line(void)
{
    return line(1.5);
}

static tribo_system *strong_line(void)
{
    return line(30.0);
}

static tribo_system *elastic(void)
{
    return element(0.4, 1);
}

static tribo_system *elastic_twins(void)
{
    return element(0.4, 2);
}

static tribo_system *stick_slip(void)
{
    const double one = 1.0, ratio = 1.0 / 0.6, speed = 0.2;
    tribo_system *s = linear(1, 1, &one, NULL, &one, &one);
    assert_ok(tribo_set_limit_all(tribo_system_context(s), 0.6));
    assert_ok(tribo_set_static(tribo_system_context(s), &ratio, NULL));
    assert_ok(tribo_system_add_base_motion(s, 0.0, &speed, NULL));
    return s;
}

static const struct scene scenes[] = {
    {"weak", weak, 60.0, {0.0}, 1, STICK | SLIP},
    {"strong", strong, 60.0, {0.0}, 1, REVERSE},
    {"twins", twins, 60.0, {0.0}, 1, STICK | SLIP},
    {"belt", belt, 60.0, {0.0}, 1, STICK | SLIP},
    {"lift-off", liftoff, 100.0, {0.0}, 1, LIFT | TOUCH},
    {"table", opened, 20.0, {0.0}, 0, STICK | SLIP | LIFT | TOUCH},
    {"planar", planar, 40.0, {0.0}, 0, STICK | SLIP},
    {"weak line", weak_line, 30.0, {0.0}, 0, STICK | SLIP},
    {"strong line", strong_line, 30.0, {0.0}, 0, SLIP},
    {"elastic", elastic, 60.0, {0.0}, 1, STICK | SLIP},
    {"elastic twins", elastic_twins, 60.0, {0.0}, 1, STICK | SLIP},
    {"stick-slip", stick_slip, 60.0, {0.0, 0.2}, 1, STICK | SLIP},
};

static const char *const located[] = {"event", "exact", "auto"};

/* ------------------------------------------------------------------------------------------------------------ tapes */

struct seen {
    double t, y[2 * MOST_DOF + 1];
    int kind;
    size_t contact;
};

struct tape {
    size_t dimension, count, stops; /* stops: calls to be answered by 1, then 0 */
    struct seen seen[MOST];
};

static int record(const tribo_moment *moment, void *data)
{
    struct tape *tape = data;
    struct seen *s = &tape->seen[tape->count];
    require(tape->count < MOST, "%zu moments", tape->count);
    ck_assert_uint_eq(moment->size, sizeof *moment);
    ck_assert((moment->kind == TRIBO_MOMENT_STEP) == (moment->contact == SIZE_MAX));
    s->t = moment->t;
    s->kind = moment->kind;
    s->contact = moment->contact;
    memcpy(s->y, moment->y, tape->dimension * sizeof *s->y);
    tape->count++;
    return tape->stops > 0;
}

/* A driver that tape watches, of a scene with an event-located method. */
static tribo_driver *watch(tribo_system *sys, int method, struct tape *tape)
{
    tribo_driver *drv;
    memset(tape, 0, sizeof *tape);
    tape->dimension = tribo_system_dimension(sys);
    assert_ok(tribo_driver_create(&drv, sys, located[method]));
    assert_ok(tribo_driver_set_observer(drv, record, tape));
    return drv;
}

/* ----------------------------------------------------------------------------------------------- before and after */

/* What contacts do at t in the middle of a phase: -1, 0, 1, 2 open, 3 sliding in the plane. */
static void look(tribo_system *sys, const char *method, const struct scene *scene, double t, signed char *does)
{
    double y[2 * MOST_DOF + 1], v[MOST_CONTACTS], from = 0.0;
    signed char slip[MOST_CONTACTS];
    tribo_driver *drv;
    memcpy(y, scene->start, sizeof y);
    assert_ok(create_any_driver(&drv, sys, method));
    driver_advance(drv, &from, t, y);
    assert_ok(tribo_system_contacts(sys, t, y, v, NULL, NULL));
    assert_ok(tribo_system_get_slip(sys, slip));
    for (size_t i = 0; i < tribo_system_ncontact(sys); i++) {
        const int plane = slip[i] == 3, moves = fabs(v[i]) > 1e-9 || (plane && (fabs(v[i + 1]) > 1e-9));
        does[i] = (signed char)(slip[i] == 2 ? 2 : !moves ? 0 : plane ? 3 : v[i] > 0.0 ? 1 : -1);
        if (plane) {
            does[++i] = 0; /* seen by its first direction */
        }
    }
    tribo_driver_destroy(drv);
}

/* What a contact does after such a moment, of which the sign may be either. */
static int fits(int kind, signed char before, signed char after)
{
    switch (kind) {
    case TRIBO_MOMENT_STICK:
        return before != 0 && before != 2 && after == 0;
    case TRIBO_MOMENT_SLIP:
        return before == 0 && after != 0 && after != 2;
    case TRIBO_MOMENT_REVERSE:
        return before == 3 ? after == 3 : before == -after && after != 0;
    case TRIBO_MOMENT_LIFT:
        return before != 2 && after == 2;
    default:
        return before == 2 && after != 2;
    }
}

/* Between moments that are apart, each contact does what its moments say, and nothing changes without one. Returns the phases
 * compared. */
static size_t compare(const struct scene *s, int method)
{
    static struct tape tape;
    tribo_system *sys = s->create(), *other = s->create();
    const size_t contacts = tribo_system_ncontact(sys);
    tribo_driver *drv = watch(sys, method, &tape);
    double t = 0.0, y[2 * MOST_DOF + 1];
    signed char before[MOST_CONTACTS] = {0}, after[MOST_CONTACTS] = {0};
    int changes[MOST_CONTACTS] = {0}, kind[MOST_CONTACTS] = {0};
    unsigned kinds = 0;
    size_t phases = 0;
    memcpy(y, s->start, sizeof y);
    tribo_context *c = tribo_system_context(other);
    assert_ok(tribo_set_law(c, TRIBO_COULOMB));
    driver_advance(drv, &t, s->end, y);
    require(tape.count > 1, "%s: %zu moments", s->name, tape.count);
    ck_assert_int_eq(tape.seen[tape.count - 1].kind, TRIBO_MOMENT_STEP);
    assert_exact(tape.seen[tape.count - 1].t, s->end);
    assert_all_exact(tape.seen[tape.count - 1].y, y, tape.dimension);
    look(other, located[method], s, 0.5 * tape.seen[0].t, before);
    for (size_t k = 0; k + 1 < tape.count; k++) {
        const struct seen *m = &tape.seen[k], *next = m + 1;
        kinds |= 1u << m->kind;
        require(next->t >= m->t, "%s: %.17g after %.17g", s->name, next->t, m->t);
        require(next->t > m->t || next->contact > m->contact, "%s, t = %g: contact %zu after %zu", s->name, m->t, next->contact,
                m->contact);
        if (m->kind != TRIBO_MOMENT_STEP) {
            require(m->contact < contacts, "%s: contact %zu", s->name, m->contact);
            changes[m->contact]++;
            kind[m->contact] = m->kind;
        }
        if (next->t - m->t < 1e-3) {
            continue; /* with the next one */
        }
        phases++;
        look(other, located[method], s, 0.5 * (m->t + next->t), after);
        for (size_t i = 0; i < contacts; i++) {
            const int fit = changes[i] == 0   ? before[i] == after[i]
                            : changes[i] == 1 ? fits(kind[i], before[i], after[i])
                                              : (kind[i] == TRIBO_MOMENT_STICK) == (after[i] == 0);
            require(fit, "%s, t = %.17g: contact %zu: %d, then %d by %d moments, the last one of kind %d", s->name, m->t, i,
                    before[i], after[i], changes[i], kind[i]);
            changes[i] = 0;
        }
        memcpy(before, after, sizeof before);
    }
    require((kinds & s->kinds) == s->kinds, "%s: kinds %x, not %x", s->name, kinds, s->kinds);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    tribo_system_destroy(other);
    return phases;
}

TEST(before_and_after)
{
    const struct scene *s = &scenes[_i / 3];
    if (_i % 3 == 1 && !s->exact) {
        return;
    }
    const size_t phases = compare(s, _i % 3);
    require(phases > 0, "%s: %zu phases", s->name, phases);
}

/* Bodies in a row on springs, contacts with the ground and between them, loads, and by turns bases that move, limits that swing
 * through zero, and static limits. */
static int seed;

static tribo_system *some_bodies(void)
{
    struct random g = random_of(seed);
    const size_t n = 2 + (size_t)seed % 3, c = 1 + (size_t)(seed / 3) % MOST_CONTACTS;
    double mass[16] = {0.0}, stiffness[16] = {0.0}, direction[16] = {0.0}, limit[4], cosine[4], sine[4], swing[4] = {0.0},
           base[4] = {0.0}, ratio[4];
    for (size_t i = 0; i < n; i++) {
        mass[i * n + i] = uniform(&g, 0.5, 2.0);
        stiffness[i * n + i] += uniform(&g, 0.3, 1.0);
        cosine[i] = uniform(&g, -1.0, 1.0);
        sine[i] = uniform(&g, -1.0, 1.0);
        if (i) {
            const double k = uniform(&g, 0.5, 2.0);
            stiffness[i * n + i] += k;
            stiffness[(i - 1) * n + i - 1] += k;
            stiffness[i * n + i - 1] = stiffness[(i - 1) * n + i] = -k;
        }
    }
    for (size_t i = 0; i < c && i < n; i++) {
        direction[i * n + i] = 1.0;
        if (i && uniform(&g, 0.0, 1.0) < 0.5) {
            direction[i * n + i - 1] = -1.0;
        }
    }
    for (size_t i = 0; i < c; i++) {
        limit[i] = uniform(&g, 0.1, 0.6);
        base[i] = seed % 5 == 1 ? uniform(&g, -0.5, 0.5) : 0.0;
        swing[i] = seed % 5 == 2 ? uniform(&g, 0.0, 1.5) * limit[i] : 0.0;
        ratio[i] = seed % 5 == 3 ? uniform(&g, 1.0, 1.5) : 1.0;
    }
    tribo_system *s = linear(n, c < n ? c : n, mass, NULL, stiffness, direction);
    assert_ok(tribo_set_limit(tribo_system_context(s), limit));
    assert_ok(tribo_set_static(tribo_system_context(s), ratio, NULL));
    assert_ok(tribo_system_add_load(s, uniform(&g, 0.5, 1.5), cosine, sine));
    assert_ok(tribo_system_add_base_motion(s, uniform(&g, 0.5, 1.5), base, NULL));
    assert_ok(tribo_system_add_limit(s, uniform(&g, 0.5, 1.5), NULL, swing));
    return s;
}

TEST(some)
{
    seed = _i / 3;
    compare(&(struct scene){"some bodies", some_bodies, 30.0, {0.0}, 1, 0}, _i % 3);
}

/* Contacts alike change together, and each is seen. */
TEST(together)
{
    static struct tape tape;
    tribo_system *sys = _i < 3 ? twins() : elastic_twins();
    tribo_driver *drv = watch(sys, _i % 3, &tape);
    double t = 0.0, y[2 * MOST_DOF + 1] = {0.0};
    driver_advance(drv, &t, 60.0, y);
    require(tape.count > 20 && tape.count % 2 == 1, "%zu moments", tape.count);
    for (size_t k = 0; k + 1 < tape.count; k += 2) {
        const struct seen *a = &tape.seen[k], *b = a + 1;
        require(a->contact == 0 && b->contact == 1 && a->kind == b->kind && a->t == b->t, "t = %g, %g: contacts %zu, %zu", a->t,
                b->t, a->contact, b->contact);
        assert_all_exact(a->y, b->y, tape.dimension);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------------------ stops */

/* Stopped at each moment, also of contacts that change together, a run sees the moments of one that goes on. */
TEST(stopped_at_each)
{
    static struct tape whole, parts;
    const struct scene *s = &scenes[_i / 3];
    const int method = _i % 3;
    if (method == 1 && !s->exact) {
        return;
    }
    tribo_system *sys = s->create(), *other = s->create();
    tribo_driver *drv = watch(sys, method, &whole);
    double t = 0.0, u = 0.0, y[2 * MOST_DOF + 1], z[2 * MOST_DOF + 1];
    memcpy(y, s->start, sizeof y);
    memcpy(z, s->start, sizeof z);
    driver_advance(drv, &t, s->end, y);
    tribo_driver_destroy(drv);
    drv = watch(other, method, &parts);
    parts.stops = 1;
    for (size_t k = 1; u < s->end; k++) {
        assert_status(tribo_driver_advance(drv, &u, s->end, z), TRIBO_ERR_STOPPED);
        assert_says(tribo_driver_message(drv), "observer answered 1");
        ck_assert_uint_eq(parts.count, k);
        assert_exact(u, parts.seen[k - 1].t);
        assert_all_exact(z, parts.seen[k - 1].y, parts.dimension);
    }
    size_t i = 0, k = 0;
    for (; i < whole.count; i++) {
        const struct seen *m = &whole.seen[i];
        require(k < parts.count, "%s: the moment at %.17g of contact %zu is lost", s->name, m->t, m->contact);
        require(m->kind == parts.seen[k].kind && m->contact == parts.seen[k].contact && fabs(m->t - parts.seen[k].t) < 1e-8,
                "%s: contact %zu, kind %d at %.17g, but stopped at each contact %zu, kind %d at %.17g", s->name, m->contact,
                m->kind, m->t, parts.seen[k].contact, parts.seen[k].kind, parts.seen[k].t);
        k++;
    }
    ck_assert_uint_eq(k, parts.count);
    assert_all_close(y, z, parts.dimension, 1e-8);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    tribo_system_destroy(other);
}

/* Stopped at each output, too, it sees the same events. */
TEST(stopped_between)
{
    static struct tape whole, parts;
    const struct scene *s = &scenes[_i / 3];
    const int method = _i % 3;
    if (method == 1 && !s->exact) {
        return;
    }
    tribo_system *sys = s->create(), *other = s->create();
    tribo_driver *drv = watch(sys, method, &whole);
    double t = 0.0, u = 0.0, y[2 * MOST_DOF + 1], z[2 * MOST_DOF + 1];
    memcpy(y, s->start, sizeof y);
    memcpy(z, s->start, sizeof z);
    driver_advance(drv, &t, s->end, y);
    tribo_driver_destroy(drv);
    drv = watch(other, method, &parts);
    assert_ok(tribo_driver_set_output(drv, 0.37));
    parts.stops = 1;
    while (u < s->end) {
        assert_status(tribo_driver_advance(drv, &u, s->end, z), TRIBO_ERR_STOPPED);
    }
    size_t k = 0;
    for (size_t i = 0; i < whole.count; i++) {
        const struct seen *m = &whole.seen[i];
        while (m->kind != TRIBO_MOMENT_STEP && k < parts.count && parts.seen[k].kind == TRIBO_MOMENT_STEP) {
            k++;
        }
        require(m->kind == TRIBO_MOMENT_STEP || (k < parts.count && m->kind == parts.seen[k].kind &&
                                                 m->contact == parts.seen[k].contact && fabs(m->t - parts.seen[k].t) < 1e-8),
                "%s: the moment at %.17g of contact %zu, kind %d, differs", s->name, m->t, m->contact, m->kind);
        k += m->kind != TRIBO_MOMENT_STEP;
    }
    assert_all_close(y, z, parts.dimension, 1e-8);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    tribo_system_destroy(other);
}

/* ------------------------------------------------------------------------------------------------------------ output */

/* Output shows the motion between events, and does not change it. */
TEST(output)
{
    static struct tape tape;
    const struct scene *s = &scenes[_i / 3];
    const int method = _i % 3;
    const double dt = 0.1;
    if (method == 1 && !s->exact) {
        return;
    }
    tribo_system *sys = s->create(), *other = s->create();
    tribo_driver *drv = watch(sys, method, &tape), *alone;
    double t = 0.0, u = 0.0, y[2 * MOST_DOF + 1], z[2 * MOST_DOF + 1];
    memcpy(y, s->start, sizeof y);
    memcpy(z, s->start, sizeof z);
    assert_ok(tribo_driver_create(&alone, other, located[method]));
    assert_ok(tribo_driver_set_output(drv, dt));
    driver_advance(drv, &t, 10.0, y);
    driver_advance(alone, &u, 10.0, z);
    assert_all_close(y, z, tape.dimension, method ? 1e-12 : 0.0);
    tribo_driver_destroy(alone);
    assert_ok(tribo_driver_create(&alone, other, located[method]));
    size_t shown = 1;
    u = 0.0;
    memcpy(z, s->start, sizeof z);
    for (size_t k = 0; k < tape.count; k++) {
        if (tape.seen[k].t == (double)shown * dt) {
            driver_advance(alone, &u, tape.seen[k].t, z);
            assert_all_close(tape.seen[k].y, z, tape.dimension, 1e-8);
            shown++;
        }
    }
    require(shown >= 100, "%s: %zu outputs", s->name, shown);
    tribo_driver_destroy(drv);
    tribo_driver_destroy(alone);
    tribo_system_destroy(sys);
    tribo_system_destroy(other);
}

TEST_MAIN("moments", {before_and_after, 3 * COUNT(scenes)}, {some, 150}, {together, 6}, {stopped_at_each, 3 * COUNT(scenes)},
          {stopped_between, 3 * COUNT(scenes)}, {output, 3 * COUNT(scenes)})
