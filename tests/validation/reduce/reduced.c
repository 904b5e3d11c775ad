/* SPDX-License-Identifier: BSD-3-Clause */
/* Reduced structures: how soon their motion with contacts at rest is that of the whole, with static responses and without; what
 * tribo_system_get_truncation says of it; and static responses in structures that are free, or have repeated contacts. */
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_complex_math.h>

#include "make.h"
#include "beam.h"
#include "run.h"

/* The beam of src/damper: contacts at z of three nodes, a load at a fourth one. */
enum { HELD = 3, ROWS = 4 };
static const double damping = 0.002, force = 0.1;

static size_t beam_row(const double *at, int direction)
{
    FILE *file = fopen(TRIBO_BEAM "/dofs.txt", "r");
    char line[200];
    size_t row, node, found = BEAM_DOFS;
    int way;
    double x[3];
    require(file, "cannot open %s/dofs.txt", TRIBO_BEAM);
    while (fgets(line, sizeof line, file)) {
        if (sscanf(line, "%zu %zu %d %lf %lf %lf", &row, &node, &way, &x[0], &x[1], &x[2]) == 6 && way == direction &&
            memcmp(x, at, sizeof x) == 0) {
            found = row - 1;
        }
    }
    fclose(file);
    require(found < BEAM_DOFS, "no row at %g, %g, %g", at[0], at[1], at[2]);
    return found;
}

static gsl_spmatrix *beam_directions(size_t rows)
{
    const double at[ROWS][3] = {{200.0, 0.0, 5.0}, {300.0, 0.0, 5.0}, {400.0, 0.0, 5.0}, {400.0, 20.0, 5.0}};
    gsl_spmatrix *j = gsl_spmatrix_alloc(rows, BEAM_DOFS);
    for (size_t i = 0; i < rows; i++) {
        gsl_spmatrix_set(j, i, beam_row(at[i], 3), 1.0);
    }
    return j;
}

/* The beam's lowest modes, and static responses for so many rows: contacts, then the load. */
static tribo_system *beam_reduced(size_t nmode, size_t rows, int statics)
{
    gsl_spmatrix *mass = beam_matrix("M.mtx"), *stiffness = beam_matrix("K.mtx"), *direction = beam_directions(rows);
    char text[200] = "";
    tribo_system *sys = NULL;
    const int status = reduced_system(&sys, mass, stiffness, direction, nmode, statics, text, sizeof text);
    require(status == TRIBO_OK, "%s", text);
    gsl_spmatrix_free(mass);
    gsl_spmatrix_free(stiffness);
    gsl_spmatrix_free(direction);
    return sys;
}

/* What unit amplitudes of the reduced motions do at the places. shape [ROWS][n] */
static void read_shapes(const tribo_system *sys, double *shape)
{
    const size_t n = tribo_system_ndof(sys);
    double *unit = calloc(n, sizeof *unit), *full = malloc(BEAM_DOFS * sizeof *full);
    gsl_spmatrix *places = beam_directions(ROWS);
    for (size_t k = 0; k < n; k++) {
        unit[k] = 1.0;
        assert_ok(tribo_system_expand(sys, unit, full));
        unit[k] = 0.0;
        for (size_t i = 0; i < ROWS; i++) {
            shape[i * n + k] = full[places->p[i]];
        }
    }
    gsl_spmatrix_free(places);
    free(unit);
    free(full);
}

/* Amplitude where the load acts with all contacts stuck: of [H J'; J 0] [q; f] = [load; 0], H being diagonal. */
static double stuck_amplitude(tribo_system *sys, double drive)
{
    const size_t n = tribo_system_ndof(sys);
    double *omega = malloc(n * sizeof *omega), *shape = malloc(ROWS * n * sizeof *shape);
    gsl_complex receptance[ROWS][ROWS];
    assert_ok(tribo_system_get_frequencies(sys, omega));
    read_shapes(sys, shape);
    for (size_t i = 0; i < ROWS; i++) {
        for (size_t j = 0; j < ROWS; j++) {
            receptance[i][j] = GSL_COMPLEX_ZERO;
            for (size_t k = 0; k < n; k++) {
                const gsl_complex h = gsl_complex_rect(omega[k] * omega[k] - drive * drive, 2.0 * damping * omega[k] * drive);
                const gsl_complex part = gsl_complex_rect(shape[i * n + k] * shape[j * n + k], 0.0);
                receptance[i][j] = gsl_complex_add(receptance[i][j], gsl_complex_div(part, h));
            }
        }
    }
    free(omega);
    free(shape);
    /* eliminates the contacts one by one */
    for (size_t p = 0; p < HELD; p++) {
        for (size_t i = p + 1; i < ROWS; i++) {
            const gsl_complex factor = gsl_complex_div(receptance[i][p], receptance[p][p]);
            for (size_t j = p; j < ROWS; j++) {
                receptance[i][j] = gsl_complex_sub(receptance[i][j], gsl_complex_mul(factor, receptance[p][j]));
            }
        }
    }
    return force * gsl_complex_abs(receptance[HELD][HELD]);
}

/* Without static responses 12 modes are 10% off, and 48 modes still 1e-3; with them, of contacts and load, one is as good as
 * all. */
TEST(beam_stuck)
{
    const struct {
        size_t modes;
        double alone;
    } cases[] = {{6, 1.995e-4}, {12, 2.224e-4}, {24, 2.393e-4}, {48, 2.470e-4}};
    const double drive = 2.0 * PI * 26.6925899;
    tribo_system *whole = beam_reduced(BEAM_DOFS, HELD, 0), *alone = beam_reduced(cases[_i].modes, HELD, 0),
                 *beside = beam_reduced(cases[_i].modes, ROWS, 1);
    const double all = stuck_amplitude(whole, drive);
    assert_close(all, 2.47231e-4, 5e-10);
    assert_close(stuck_amplitude(alone, drive), cases[_i].alone, 0.6e-7);
    assert_close(stuck_amplitude(beside, drive) / all, 1.0, 1e-6);
    ck_assert_uint_eq(tribo_system_ndof(alone), cases[_i].modes);
    ck_assert_uint_eq(tribo_system_ndof(beside), cases[_i].modes + ROWS);
    tribo_system_destroy(whole);
    tribo_system_destroy(alone);
    tribo_system_destroy(beside);
}

/* What the contacts dissipate in a second of the periodic motion, all with the same limit. */
static double power_at(tribo_system *sys, double period, double same)
{
    const double limit[HELD] = {same, same, same};
    double energy[HELD], sum = 0.0, *y = calloc(tribo_system_dimension(sys), sizeof *y);
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    tribo_driver *drv = driver_create(sys, "exact", period, 0.0);
    const int status = tribo_driver_find_periodic(drv, 0.0, period, y);
    require(!status, "limit %g: %s", same, tribo_driver_message(drv));
    assert_ok(tribo_driver_period_dissipation(drv, energy));
    for (size_t i = 0; i < HELD; i++) {
        sum += energy[i] / period;
    }
    tribo_driver_destroy(drv);
    free(y);
    return sum;
}

/* The limit that dissipates most hardly depends on how many modes there are: from 1 to 96 it is 0.01977, and so is the power. */
TEST(beam_best)
{
    const size_t modes[] = {1, 6, 12, 24};
    const double drive = 2.0 * PI * 26.6925899, period = 2.0 * PI / drive, best = 0.01977, power = 24.0169;
    double *load = calloc(BEAM_DOFS, sizeof *load);
    tribo_system *sys = beam_reduced(modes[_i / 2], HELD, _i % 2);
    load[beam_row((const double[]){400.0, 20.0, 5.0}, 3)] = force;
    assert_ok(tribo_system_set_damping_ratio(sys, damping));
    assert_ok(tribo_system_add_load(sys, drive, load, NULL));
    const double below = power_at(sys, period, 0.995 * best), at = power_at(sys, period, best),
                 above = power_at(sys, period, 1.005 * best);
    assert_close(at, power, 2e-5 * power);
    /* the parabola through the three has its top there */
    assert_close(0.5 * 0.005 * (below - above) / (below - 2.0 * at + above), 0.0, 5e-5);
    tribo_system_destroy(sys);
    free(load);
}

/* Sum of shape_i^2/(omega^2 - drive^2), for every place. */
static void receptances(const tribo_system *sys, double drive, double *sum)
{
    const size_t n = tribo_system_ndof(sys);
    double *omega = malloc(n * sizeof *omega), *shape = malloc(ROWS * n * sizeof *shape);
    assert_ok(tribo_system_get_frequencies(sys, omega));
    read_shapes(sys, shape);
    for (size_t i = 0; i < ROWS; i++) {
        sum[i] = 0.0;
        for (size_t k = 0; k < n; k++) {
            sum[i] += pow(shape[i * n + k], 2.0) / (omega[k] * omega[k] - drive * drive);
        }
    }
    free(omega);
    free(shape);
}

/* What a force at a contact makes there lacks no more than the bound says, and the bound is not idle. Rounding of the stiffness
 * is 1e-16 (1.5e6 Hz/27 Hz)^2 of the softest motion. */
TEST(truncation_bounds)
{
    const double drives[] = {0.0, 200.0, 2000.0, 6000.0};
    const size_t modes = 12;
    const double drive = drives[_i / 2];
    const int statics = _i % 2;
    double error, all[ROWS], steady[ROWS], some[ROWS], most = 0.0;
    tribo_system *whole = beam_reduced(BEAM_DOFS, ROWS, 0), *sys = beam_reduced(modes, ROWS, statics);
    receptances(whole, drive, all);
    receptances(whole, 0.0, steady);
    receptances(sys, drive, some);
    assert_ok(tribo_system_get_truncation(sys, drive, &error));
    for (size_t i = 0; i < ROWS; i++) {
        const double lack = (all[i] - some[i]) / steady[i];
        require(lack <= error + 1e-8 && lack >= -1e-8, "place %zu lacks %g, more than %g", i, lack, error);
        most = fmax(most, lack);
    }
    require(statics || most > 1e-3 * error, "%g is far from %g", error, most);
    require(!statics || error < pow(drive / 14000.0, 4.0) + 1e-10, "%g with static responses", error);
    assert_ok(tribo_system_get_truncation(sys, 1e6, &error));
    require(isinf(error), "%g above all modes", error);
    tribo_system_destroy(whole);
    tribo_system_destroy(sys);
}

TEST(truncation_errors)
{
    double error;
    tribo_system *sys = beam_reduced(3, HELD, 1), *chain;
    stain(&error, sizeof error);
    assert_ok(tribo_system_chain(&chain, 4, 0.1, 0.1, 1.0));
    assert_status(tribo_system_get_truncation(NULL, 1.0, &error), TRIBO_ERR_NULL);
    assert_status(tribo_system_get_truncation(sys, 1.0, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_system_get_truncation(sys, HUGE_VAL, &error), TRIBO_ERR_NOT_FINITE);
    assert_says(tribo_system_message(sys), "omega = inf is not finite");
    assert_status(tribo_system_get_truncation(chain, 1.0, &error), TRIBO_ERR_UNSUPPORTED);
    ck_assert(stained(&error, sizeof error));
    tribo_system_destroy(sys);
    tribo_system_destroy(chain);
}

/* Where modes and static responses are together all that a small structure can do, they are that: its own frequencies, none twice
 * and none missing, also where a contact moves one mode and nothing else, so that its static response has nothing new. */
TEST(all_of_a_small_structure)
{
    enum { N = 4 };
    gsl_spmatrix *mass = gsl_spmatrix_alloc(N, N), *stiffness = gsl_spmatrix_alloc(N, N), *direction = gsl_spmatrix_alloc(N, N);
    const size_t nmode = (size_t)_i + 1;
    char text[200] = "";
    double omega[N], error;
    tribo_system *sys;
    for (size_t i = 0; i < N; i++) {
        gsl_spmatrix_set(mass, i, i, (double)(i + 1));
        gsl_spmatrix_set(stiffness, i, i, 100.0);
        gsl_spmatrix_set(direction, i, i, i == 2 ? 1e6 : 1.0);
    }
    require(!reduced_system(&sys, mass, stiffness, direction, nmode, 1, text, sizeof text), "%zu modes: %s", nmode, text);
    ck_assert_uint_eq(tribo_system_ndof(sys), N);
    assert_ok(tribo_system_get_frequencies(sys, omega));
    for (size_t k = 0; k < N; k++) {
        assert_close(omega[k], 10.0 / sqrt((double)(N - k)), 1e-13);
    }
    assert_ok(tribo_system_get_truncation(sys, 1.0, &error));
    ck_assert(error < 1e-2);
    tribo_system_destroy(sys);
    gsl_spmatrix_free(mass);
    gsl_spmatrix_free(stiffness);
    gsl_spmatrix_free(direction);
}

/* Two bodies on a spring and a third one by itself, all free: the contacts at both ends of the spring feel one elastic motion,
 * and what they lack is lost beside the rigid-body motions. Then all of it may be missing. */
TEST(free_bodies)
{
    gsl_spmatrix *mass = gsl_spmatrix_alloc(3, 3), *stiffness = gsl_spmatrix_alloc(3, 3), *direction = gsl_spmatrix_alloc(2, 3);
    char text[200] = "";
    double omega[3], error;
    tribo_system *sys;
    for (size_t i = 0; i < 3; i++) {
        gsl_spmatrix_set(mass, i, i, i == 1 ? 2.0 : 1.0);
    }
    for (size_t i = 0; i < 2; i++) {
        gsl_spmatrix_set(stiffness, i, i, 1.0);
        gsl_spmatrix_set(stiffness, i, 1 - i, -1.0);
        gsl_spmatrix_set(direction, i, i, i ? -1.0 : 1.0);
    }
    require(!reduced_system(&sys, mass, stiffness, direction, 2, 1, text, sizeof text), "%s", text);
    ck_assert_uint_eq(tribo_system_ndof(sys), 3);
    assert_ok(tribo_system_get_frequencies(sys, omega));
    assert_exact(omega[0], 0.0);
    assert_exact(omega[1], 0.0);
    assert_close(omega[2], sqrt(1.5), 1e-13);
    assert_ok(tribo_system_get_truncation(sys, 0.01, &error));
    ck_assert(error >= 0.0);
    tribo_system_destroy(sys);
    gsl_spmatrix_free(mass);
    gsl_spmatrix_free(stiffness);
    gsl_spmatrix_free(direction);
}

/* Two free chains of which one drift is a mode and the other is left to the static response of a contact of both: a drift, too.
 * As compliance it would have no bound. */
TEST(drifts_left_out)
{
    struct random g = random_of(_i + 1);
    const size_t n = 4 + below(&g, 60), cut = 1 + below(&g, n - 1);
    gsl_spmatrix *mass = gsl_spmatrix_alloc(n, n), *stiffness = gsl_spmatrix_alloc(n, n), *direction = gsl_spmatrix_alloc(1, n);
    char text[200] = "";
    double omega[2];
    tribo_system *sys;
    for (size_t i = 0; i < n; i++) {
        gsl_spmatrix_set(mass, i, i, 0.5 + uniform(&g, 0.0, 1.0));
        if (i > 0 && i != cut) {
            const double k = exp(6.0 * uniform(&g, 0.0, 1.0));
            gsl_spmatrix_set(stiffness, i, i, gsl_spmatrix_get(stiffness, i, i) + k);
            gsl_spmatrix_set(stiffness, i - 1, i - 1, gsl_spmatrix_get(stiffness, i - 1, i - 1) + k);
            gsl_spmatrix_set(stiffness, i, i - 1, -k);
            gsl_spmatrix_set(stiffness, i - 1, i, -k);
        }
    }
    gsl_spmatrix_set(direction, 0, below(&g, cut), 1.0);
    gsl_spmatrix_set(direction, 0, cut + below(&g, n - cut), 0.5);
    require(!reduced_system(&sys, mass, stiffness, direction, 1, TRIBO_STATICS_MASS, text, sizeof text), "%s", text);
    ck_assert_uint_eq(tribo_system_ndof(sys), 2);
    assert_ok(tribo_system_get_frequencies(sys, omega));
    assert_exact(omega[0], 0.0);
    assert_exact(omega[1], 0.0);
    tribo_system_destroy(sys);
    assert_status(reduced_system(&sys, mass, stiffness, direction, 1, TRIBO_STATICS_COMPLIANCE, text, sizeof text),
                  TRIBO_ERR_UNSUPPORTED);
    assert_says(text, "nmode = 1 leaves out a motion that contact 0 moves");
    gsl_spmatrix_free(mass);
    gsl_spmatrix_free(stiffness);
    gsl_spmatrix_free(direction);
}

/* A body on a spring, and two that only inertia couples with it, which are free to drift together: the first one has no part in
 * that, however little of it numerical modes leave, and a contact of it cannot stop them. */
TEST(drift_beside_a_contact)
{
    const double mass[] = {2.6, 0.1, -0.1, 0.1, 0.4, 0.0, -0.1, 0.0, 1.6},
                 stiffness[] = {0.7, 0.0, 0.0, 0.0, 0.7, -0.7, 0.0, -0.7, 0.7}, direction[] = {1.0, 0.0, 0.0};
    const double y[] = {0.0, 0.0, 1.0, 0.0, 0.0};
    char text[200] = "";
    double omega[2], v;
    tribo_system *sys;
    require(!dense_system(&sys, 3, 1, mass, NULL, stiffness, direction, 2, text, sizeof text), "%s", text);
    assert_ok(tribo_system_get_frequencies(sys, omega));
    assert_exact(omega[0], 0.0);
    assert_ok(tribo_system_contacts(sys, 0.0, y, &v, NULL, NULL));
    assert_exact(v, 0.0);
    tribo_system_destroy(sys);
}

/* Forces of a damping matrix that is not symmetric, as of a rotor, stay as they are. */
TEST(rotor)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, damping_matrix[] = {0.1, 5.0, -4.0, 0.2}, stiffness[] = {2.0, 0.0, 0.0, 3.0},
                 direction[] = {1.0, 0.0};
    const double y[] = {0.0, 0.0, 1.0, 2.0, 0.0}, want[] = {-10.1, 3.6};
    char text[200] = "";
    double rate[5];
    tribo_system *sys;
    require(!dense_system(&sys, 2, 1, mass, damping_matrix, stiffness, direction, 2, text, sizeof text), "%s", text);
    assert_ok(tribo_system_derivative(sys, 0.0, y, rate));
    assert_close(rate[2], want[0], 1e-12);
    assert_close(rate[3], want[1], 1e-12);
    tribo_system_destroy(sys);
}

/* A copy knows it, too. */
TEST(copies_keep_truncation)
{
    double error, want;
    tribo_system *sys = beam_reduced(6, HELD, 0), *copy;
    assert_ok(tribo_system_clone(sys, &copy));
    assert_ok(tribo_system_get_truncation(sys, 100.0, &want));
    assert_ok(tribo_system_get_truncation(copy, 100.0, &error));
    assert_exact(error, want);
    tribo_system_destroy(sys);
    tribo_system_destroy(copy);
}

TEST_MAIN("reduced", {drift_beside_a_contact, 1}, {beam_stuck, 4}, {beam_best, 8}, {truncation_bounds, 8}, {truncation_errors, 1},
          {all_of_a_small_structure, 4}, {free_bodies, 1}, {drifts_left_out, 100}, {rotor, 1}, {copies_keep_truncation, 1})
