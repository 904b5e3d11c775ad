/* SPDX-License-Identifier: BSD-3-Clause */
/* Rings of equal sectors under loads that travel, by a part of the period and of the sectors: against closed forms, and against
 * searches over the whole period. */
#include "make.h"
#include "run.h"
#include "search.h"

#include <string.h>

enum { BLADES = 12, DOFS = 24, CONTACTS = 14, STATES = 2 * DOFS + CONTACTS + 1 };

static const char *const methods[] = {"exact", "event", "auto"};

/* Damping, frequency, limit, engine order, amplitude. */
static const struct row {
    double c, omega, limit;
    size_t order;
    double amplitude;
} rows[] = {{0.1, 0.9, 0.3, 2, 1.308608817440},
            {0.1, 0.9, 0.3, 1, 2.509200552339},
            {0.1, 1.0, 0.2, 5, 0.522947882341},
            {0.0, 0.9, 0.3, 2, 1.391711300796}};

/* Two drivers of one system: drv with the ring, plain without. */
struct ring {
    size_t sectors, order, n, contacts;
    double period;
    tribo_system *sys;
    tribo_driver *drv, *plain;
};

static void ring_free(struct ring *r)
{
    tribo_driver_destroy(r->drv);
    tribo_driver_destroy(r->plain);
    tribo_system_destroy(r->sys);
}

static void ring_start(struct ring *r, const char *method)
{
    r->drv = driver_create(r->sys, method, 0.1, 1e-14);
    r->plain = driver_create(r->sys, method, 0.1, 1e-14);
    assert_ok(tribo_driver_set_ring(r->drv, r->sectors, r->order));
}

/* Calls add for sector 0's amplitudes [n of a sector] of harmonic k of the period, in all sectors, each later by order/sectors of
 * the period. */
static void add_travelling(const struct ring *r, int (*add)(tribo_system *, double, const double *, const double *), size_t k,
                           size_t all, const double *cosine, const double *sine)
{
    double c[DOFS], s[DOFS];
    for (size_t d = 0; d < all; d++) {
        const size_t each = all / r->sectors;
        const double angle = 2.0 * PI * (double)(k * r->order * (d / each) % r->sectors) / (double)r->sectors;
        c[d] = cos(angle) * cosine[d % each] - sin(angle) * sine[d % each];
        s[d] = sin(angle) * cosine[d % each] + cos(angle) * sine[d % each];
    }
    assert_ok(add(r->sys, 2.0 * PI * (double)k / r->period, c, s));
}

/* A body on a spring of stiffness 1, on the ground by a contact, with a spring of 0.5 to the next body. */
static tribo_model *one_blade(double damping)
{
    return dense_model(2, 1, (double[]){1.0, 0.0, 0.0, 0.0}, (double[]){damping, 0.0, 0.0, 0.0}, (double[]){1.5, -0.5, -0.5, 0.5},
                       (double[]){1.0, 0.0});
}

/* A ring of BLADES blades, as by one_blade; mass_of_3: mass of blade 3. */
static struct ring blades(const char *method, const struct row *row, double mass_of_3)
{
    struct ring r = {.sectors = BLADES, .order = row->order, .n = BLADES, .contacts = BLADES, .period = 2.0 * PI / row->omega};
    tribo_model *blade = one_blade(row->c), *model;
    double mass[BLADES];
    assert_ok(tribo_model_create(&model, BLADES, BLADES));
    assert_ok(tribo_model_set_ring(model, blade, BLADES));
    if (mass_of_3 != 1.0) {
        for (size_t j = 0; j < BLADES; j++) {
            mass[j] = j == 3 ? mass_of_3 : 1.0;
        }
        assert_ok(tribo_model_set_mass_diagonal(model, mass));
    }
    tribo_model_destroy(blade);
    r.sys = finish_model(model);
    add_travelling(&r, tribo_system_add_load, 1, BLADES, (double[]){1.0}, (double[]){0.0});
    assert_ok(tribo_set_limit_all(tribo_system_context(r.sys), row->limit));
    ring_start(&r, method);
    return r;
}

static void find_motion(tribo_driver *drv, double t, double period, double *y)
{
    const int status = tribo_driver_find_periodic(drv, t, period, y);
    require(!status, "%s: %s", tribo_strerror(status), tribo_driver_message(drv));
}

/* Digits of the closed form at all bodies. The whole ring takes half a period, the ring a twelfth, of order 2 a sixth, with a
 * half or a quarter of the bodies; events of bodies that move alike count once. */
TEST(closed_form)
{
    const struct row *row = &rows[_i / 3];
    struct ring r = blades(methods[_i % 3], row, 1.0);
    double y[STATES] = {0}, z[STATES] = {0};
    find_motion(r.drv, 0.2, r.period, y);
    find_motion(r.plain, 0.2, r.period, z);
    const size_t events = driver_count(r.drv, TRIBO_COUNT_EVENTS), looks = driver_count(r.drv, TRIBO_COUNT_EVALUATIONS);
    const size_t all = driver_count(r.plain, TRIBO_COUNT_EVENTS), all_looks = driver_count(r.plain, TRIBO_COUNT_EVALUATIONS);
    require(3 * events <= all && 2 * looks <= all_looks, "%zu of %zu events, %zu of %zu evaluations", events, all, looks,
            all_looks);
    ck_assert_uint_eq(driver_count(r.drv, TRIBO_COUNT_PERIODS), 1);
    assert_all_close(y, z, 2 * BLADES, 2e-12);
    assert_ok(tribo_driver_set_ring(r.drv, 0, 0)); /* the motion found stays that of the ring */
    for (size_t j = 0; j < BLADES; j++) {
        double c[2 * BLADES] = {0}, least, most;
        c[j] = 1.0;
        assert_ok(tribo_driver_period_extremes(r.drv, c, &least, &most, NULL, NULL));
        assert_close(most, row->amplitude, 1e-12);
        assert_close(least, -row->amplitude, 1e-12);
    }
    ring_free(&r);
}

/* Adds value to a[i][j] of a matrix of `columns`, in all sectors; i counts from sector `from` on, j from sector `to` on. */
static void put_in_sectors(double *a, size_t sectors, size_t rows_each, size_t columns_each, size_t i, size_t j, double value)
{
    for (size_t s = 0; s < sectors; s++) {
        a[(i + s * rows_each) % (sectors * rows_each) * sectors * columns_each +
          (j + s * columns_each) % (sectors * columns_each)] += value;
    }
}

/* Random sectors: chains of bodies, a spring and a damper to the next sector, a contact to the ground, and one to the next
 * sector; kind 1: elastic; 2: loads of all harmonics, a constant one, too; 3: a base that travels; 4: limits that do; 5: masses
 * that are coupled. */
static struct ring random_ring(struct random *g, const char *method, int kind)
{
    const size_t sectors = 2 + below(g, 6), m = 1 + below(g, 3), contacts = 1 + below(g, 2);
    struct ring r = {.sectors = sectors,
                     .order = below(g, sectors + 1),
                     .n = sectors * m,
                     .contacts = sectors * contacts,
                     .period = 2.0 * PI / uniform(g, 0.5, 3.0)};
    double mass[DOFS * DOFS] = {0}, damping[DOFS * DOFS] = {0}, stiffness[DOFS * DOFS] = {0}, direction[CONTACTS * DOFS] = {0};
    double cosine[3], sine[3], soft[CONTACTS], limit[CONTACTS];
    const double link = uniform(g, 0.2, 2.0);
    for (size_t d = 0; d < m; d++) {
        const double ground = uniform(g, 0.5, 2.0), next = uniform(g, 0.5, 3.0), size = uniform(g, 0.5, 2.0);
        put_in_sectors(mass, sectors, m, m, d, d, size);
        put_in_sectors(stiffness, sectors, m, m, d, d, ground);
        put_in_sectors(damping, sectors, m, m, d, d, 0.1 * size);
        for (int k = 0; k < 4 && d + 1 < m; k++) {
            put_in_sectors(stiffness, sectors, m, m, d + (size_t)k / 2, d + (size_t)k % 2, k == 0 || k == 3 ? next : -next);
        }
    }
    for (int k = 0; k < 4; k++) {
        const size_t i = k / 2 ? m : 0, j = k % 2 ? m : 0;
        const double sign = i == j ? 1.0 : -1.0;
        put_in_sectors(stiffness, sectors, m, m, i, j, sign * link);
        put_in_sectors(damping, sectors, m, m, i, j, sign * 0.05 * link);
        put_in_sectors(mass, sectors, m, m, i, j, kind == 5 ? 0.1 : 0.0);
    }
    put_in_sectors(direction, sectors, contacts, m, 0, 0, 1.0);
    if (contacts > 1) {
        put_in_sectors(direction, sectors, contacts, m, 1, m - 1, 1.0);
        put_in_sectors(direction, sectors, contacts, m, 1, m, sectors * m == 1 ? 0.0 : -1.0);
    }
    const double first = uniform(g, 0.1, 0.6), second = uniform(g, 0.05, 0.3);
    for (size_t i = 0; i < r.contacts; i++) {
        soft[i] = i % contacts ? 0.0 : 0.3;
        limit[i] = i % contacts ? second : first;
    }
    tribo_model *model = dense_model(r.n, r.contacts, mass, damping, stiffness, direction);
    if (kind == 1) {
        assert_ok(tribo_model_set_compliance(model, soft));
    }
    r.sys = finish_model(model);
    assert_ok(tribo_set_limit(tribo_system_context(r.sys), limit));
    for (size_t k = kind == 2 ? 0 : 1; k < (kind == 2 ? 4 : 2); k++) {
        for (size_t d = 0; d < m; d++) {
            cosine[d] = uniform(g, -1.0, 1.0);
            sine[d] = k ? uniform(g, -1.0, 1.0) : 0.0;
        }
        add_travelling(&r, tribo_system_add_load, k, r.n, cosine, sine);
    }
    if (kind == 3) {
        add_travelling(&r, tribo_system_add_base_motion, 1, r.contacts, (double[]){0.3, 0.1}, (double[]){-0.2, 0.4});
    } else if (kind == 4) {
        add_travelling(&r, tribo_system_add_limit, 2, r.contacts, (double[]){0.05, 0.02}, (double[]){0.03, 0.01});
    }
    ring_start(&r, method);
    return r;
}

static void assert_same(const struct ring *r, size_t count, int (*ask)(tribo_driver *, double *))
{
    double one[CONTACTS], other[CONTACTS];
    assert_ok(ask(r->drv, one));
    assert_ok(ask(r->plain, other));
    assert_all_close(one, other, count, 1e-9);
}

/* Multipliers by their power sums, and the freedom. Where coupled contacts of several sectors stop at one instant there are no
 * multipliers; without the ring rounding may part these contacts. */
static void assert_same_flow(const struct ring *r, size_t all)
{
    double re[2][STATES], im[2][STATES], sum[2][4] = {{0}};
    const int status = tribo_driver_get_multipliers(r->drv, re[0], im[0]);
    if (status == TRIBO_ERR_UNSUPPORTED && r->order % r->sectors == 0) {
        assert_says(tribo_driver_message(r->drv), "at one instant");
        return;
    }
    assert_status(tribo_driver_get_multipliers(r->plain, re[1], im[1]), status);
    for (int k = 0; !status && k < 2; k++) {
        for (size_t i = 0; i < all; i++) {
            const double square = re[k][i] * re[k][i] - im[k][i] * im[k][i], double_product = 2.0 * re[k][i] * im[k][i];
            sum[k][0] += re[k][i];
            sum[k][1] += square;
            sum[k][2] += re[k][i] * square - im[k][i] * double_product;
            sum[k][3] += square * square - double_product * double_product;
        }
    }
    assert_all_close(sum[0], sum[1], 4, 1e-8);
    ck_assert_uint_eq(driver_freedom(r->drv), driver_freedom(r->plain));
}

/* The motion and its quantities are those of the search over the whole period; the motion comes back to its beginning. */
TEST(random_rings)
{
    struct random g = random_of(_i);
    struct ring r = random_ring(&g, methods[_i % 3], _i / 3 % 6);
    const size_t dimension = tribo_system_dimension(r.sys);
    double y[STATES] = {0}, z[STATES] = {0}, c[2 * DOFS], a[4], b[4], t = 0.3;
    find_motion(r.drv, t, r.period, y);
    find_motion(r.plain, t, r.period, z);
    assert_all_close(y, z, dimension, 1e-9);
    for (size_t d = 0; d < 2 * r.n; d++) {
        c[d] = uniform(&g, -1.0, 1.0);
    }
    assert_ok(tribo_driver_period_extremes(r.drv, c, &a[0], &a[1], NULL, NULL));
    assert_ok(tribo_driver_period_extremes(r.plain, c, &b[0], &b[1], NULL, NULL));
    assert_ok(tribo_driver_period_harmonic(r.drv, c, 1, &a[2], &a[3]));
    assert_ok(tribo_driver_period_harmonic(r.plain, c, 1, &b[2], &b[3]));
    assert_all_close(a, b, 4, 1e-9);
    assert_same(&r, r.contacts, tribo_driver_period_dissipation);
    assert_same(&r, r.contacts, tribo_driver_period_stick);
    assert_same_flow(&r, dimension - 1);
    memcpy(z, y, sizeof z);
    driver_advance(r.plain, &t, t + r.period, z);
    assert_all_close(z, y, dimension - 1, 1e-9);
    ring_free(&r);
}

static void assert_refused(const struct ring *r, int status, const char *part)
{
    double y[STATES] = {0};
    assert_status(tribo_driver_find_periodic(r->drv, 0.0, r->period, y), status);
    assert_says(tribo_driver_message(r->drv), part);
}

/* A load that does not travel, or a sector that differs, is refused, and the message names the entry; without the ring the motion
 * is found. */
TEST(refused)
{
    const int kind = TRIBO_PARAMETER_LIMIT;
    const size_t index = 0;
    struct ring r = blades(methods[_i], &rows[1], 1.0);
    double y[STATES] = {0}, load[BLADES] = {0}, limit[BLADES], by[2 * BLADES + 1], re[STATES], im[STATES];
    assert_status(tribo_driver_set_ring(NULL, BLADES, 1), TRIBO_ERR_NULL);
    assert_status(tribo_driver_set_ring(r.drv, 5, 1), TRIBO_ERR_RANGE);
    assert_says(tribo_driver_message(r.drv), "equal sectors = 5");
    assert_ok(tribo_driver_set_ring(r.drv, BLADES, BLADES - 1));
    assert_refused(&r, TRIBO_ERR_RANGE, "order = 11: that on degree of freedom 1");
    assert_ok(tribo_driver_set_ring(r.drv, BLADES, 1));
    find_motion(r.drv, 0.0, r.period, y);
    assert_status(tribo_driver_period_derivatives(r.drv, 1, &kind, &index, NULL, NULL, NULL, by), TRIBO_ERR_UNSUPPORTED);
    assert_status(tribo_driver_multiplier_derivatives(r.drv, 0, 1, &kind, &index, re, im), TRIBO_ERR_UNSUPPORTED);
    for (size_t j = 0; j < BLADES; j++) {
        limit[j] = j == 7 ? 0.31 : 0.3;
    }
    assert_ok(tribo_set_limit(tribo_system_context(r.sys), limit));
    assert_status(tribo_driver_get_multipliers(r.drv, re, im), TRIBO_ERR_STATE);
    assert_refused(&r, TRIBO_ERR_RANGE, "limit[6]");
    assert_ok(tribo_driver_set_ring(r.drv, 1, 0));
    find_motion(r.drv, 0.0, r.period, y);
    assert_ok(tribo_driver_get_multipliers(r.drv, re, im));
    tribo_driver *other = driver_create(r.sys, "rk4/fixed", 0.1, 1e-14);
    assert_status(tribo_driver_set_ring(other, BLADES, 1), TRIBO_ERR_UNSUPPORTED);
    tribo_driver_destroy(other);
    assert_ok(tribo_set_limit_all(tribo_system_context(r.sys), 0.3));
    assert_ok(tribo_driver_set_ring(r.drv, BLADES, 1));
    load[5] = 1e-6;
    assert_ok(tribo_system_add_load(r.sys, 0.0, load, NULL));
    assert_refused(&r, TRIBO_ERR_RANGE, "that on degree of freedom 5");
    assert_ok(tribo_system_clear_loads(r.sys));
    assert_ok(tribo_system_add_base_motion(r.sys, rows[1].omega, load, NULL));
    assert_refused(&r, TRIBO_ERR_RANGE, "base motions do not travel with order = 1: that of contact 5");
    ring_free(&r);
    r = blades(methods[_i], &rows[1], 1.0 + 1e-9);
    assert_refused(&r, TRIBO_ERR_RANGE, "mass[2][2] = 1, but mass[3][3] = 1.00000000");
    ring_free(&r);
}

/* A model that is no ring of the sector is refused; springs and normals of the sector stand in all sectors. */
TEST(models)
{
    tribo_model *sector = one_blade(0.1), *model, *empty;
    tribo_system *sys;
    assert_ok(tribo_model_create(&model, 3, 3));
    assert_ok(tribo_model_create(&empty, 2, 1));
    assert_status(tribo_model_set_ring(NULL, sector, 3), TRIBO_ERR_NULL);
    assert_status(tribo_model_set_ring(model, NULL, 3), TRIBO_ERR_NULL);
    assert_status(tribo_model_set_ring(model, model, 3), TRIBO_ERR_NULL);
    assert_status(tribo_model_set_ring(model, sector, 0), TRIBO_ERR_SIZE);
    assert_status(tribo_model_set_ring(model, sector, 2), TRIBO_ERR_SIZE);
    assert_status(tribo_model_set_ring(model, sector, 1), TRIBO_ERR_SIZE);
    assert_says(tribo_model_message(model), "sectors = 1");
    assert_status(tribo_model_set_ring(model, empty, 3), TRIBO_ERR_STATE);
    assert_says(tribo_model_message(model), "mass of the sector");
    assert_ok(tribo_model_set_ring(model, sector, 3));
    assert_ok(tribo_model_set_compliance(sector, (double[]){0.25}));
    assert_ok(tribo_model_set_ring(model, sector, 3));
    sys = finish_model(model);
    ck_assert_uint_eq(tribo_system_dimension(sys), 2 * 3 + 3 + 1);
    tribo_system_destroy(sys);
    tribo_model_destroy(sector);
    tribo_model_destroy(empty);
    sector =
        dense_model(2, 2, (double[]){1.0, 0.0, 0.0, 1.0}, NULL, (double[]){1.0, 0.0, 0.0, 1.0}, (double[]){1.0, 0.0, 0.0, 1.0});
    assert_ok(tribo_model_set_normal(sector, 0, 1, 0.5, 3.0, 0.0));
    assert_ok(tribo_model_create(&model, 6, 6));
    assert_ok(tribo_model_set_compliance(model, (double[]){0.1, 0.1, 0.1, 0.1, 0.1, 0.1})); /* of no sector: goes */
    assert_ok(tribo_model_set_ring(model, sector, 3));
    tribo_model_destroy(sector);
    sys = finish_model(model);
    double y[13] = {0}, force[6];
    y[3] = 1.0; /* the normal of sector 1 presses with 3 */
    assert_ok(tribo_system_contacts(sys, 0.0, y, NULL, NULL, force));
    assert_all_exact(force, ((double[]){0.0, 0.0, 0.0, -3.0, 0.0, 0.0}), 6);
    tribo_system_destroy(sys);
}

/* Coupled blades that all stop at one instant, but for rounding of the search, have no multipliers. */
TEST(one_instant)
{
    struct random g = random_of(_i);
    double mass[BLADES * BLADES] = {0.0}, stiffness[BLADES * BLADES] = {0.0}, damping[BLADES * BLADES] = {0.0},
                         unit[BLADES * BLADES] = {0.0}, cosine[BLADES];
    for (size_t i = 0; i < BLADES; i++) {
        const size_t next = (i + 1) % BLADES;
        cosine[i] = unit[i * BLADES + i] = 1.0;
        mass[i * BLADES + i] = 1.1;
        stiffness[i * BLADES + i] = 2.0;
        damping[i * BLADES + i] = 0.1;
        mass[i * BLADES + next] = mass[next * BLADES + i] = 0.05;
        stiffness[i * BLADES + next] = stiffness[next * BLADES + i] = -0.3;
    }
    for (int k = 0; k < 120; k++) {
        double y[2 * BLADES + 1] = {0.0}, re[2 * BLADES], im[2 * BLADES];
        struct search s = search_create("exact", BLADES, BLADES, mass, damping, stiffness, unit, 0.7 + 0.15 * (k % 9), cosine);
        assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), 0.05 + 0.043 * (k % 7)));
        for (size_t i = 0; i < 2 * BLADES; i++) {
            y[i] = uniform(&g, -0.5, 0.5);
        }
        find(&s, 0.0, y);
        assert_status(tribo_driver_get_multipliers(s.drv, re, im), TRIBO_ERR_UNSUPPORTED);
        assert_says(tribo_driver_message(s.drv), "one instant");
        search_free(&s);
    }
}

TEST_MAIN("ring", {models, 1}, {closed_form, 3 * COUNT(rows)}, {random_rings, 90}, {refused, 3}, {one_instant, 2})
