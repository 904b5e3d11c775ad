/* SPDX-License-Identifier: BSD-3-Clause */
/* What a backbone costs: the first mode of the beam with elastic contacts, frequency and damping over the amplitude, by
 * tribo_driver_find_mode and by harmonic balance with one harmonic, the describing function of the contacts. --smoke: no
 * times. */
#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../src/damper/output.h"
#include "beam.h"
#include "harness.h"
#include "tribo/tribo_dynamics.h"

enum { AMPLITUDES = 60, STATE = 2 * MODES + CONTACTS + 1, MOST_ITERATIONS = 300 };

static const double limit = 1e-2, soft = 0.3;

struct backbone {
    struct model model;
    tribo_driver *drv;
    double amplitude[AMPLITUDES];
    double exact[AMPLITUDES][2], one[AMPLITUDES][2]; /* omega and zeta */
    size_t iterations;                               /* of one harmonic */
};

static void run_modes(void *data)
{
    struct backbone *b = data;
    double c[2 * MODES] = {1.0}, y[STATE] = {0.0}, omega = 0.0, zeta = 0.0;
    for (size_t k = 0; k < AMPLITUDES; k++) {
        need(tribo_driver_find_mode(b->drv, c, b->amplitude[k], &omega, &zeta, y), tribo_driver_message(b->drv));
        b->exact[k][0] = omega;
        b->exact[k][1] = zeta;
    }
}

/* x [MODES] = (a - shift)^-1 x by elimination with pivots. */
static void solve_shifted(const double complex a[MODES][MODES], double complex shift, double complex *x)
{
    double complex m[MODES][MODES];
    memcpy(m, a, sizeof m);
    for (size_t k = 0; k < MODES; k++) {
        m[k][k] -= shift;
    }
    for (size_t k = 0; k < MODES; k++) {
        size_t p = k;
        for (size_t i = k + 1; i < MODES; i++) {
            p = cabs(m[i][k]) > cabs(m[p][k]) ? i : p;
        }
        for (size_t j = 0; j < MODES; j++) {
            const double complex t = m[k][j];
            m[k][j] = m[p][j];
            m[p][j] = t;
        }
        const double complex t = x[k];
        x[k] = x[p];
        x[p] = t;
        for (size_t i = k + 1; i < MODES; i++) {
            const double complex f = m[i][k] / m[k][k];
            for (size_t j = k; j < MODES; j++) {
                m[i][j] -= f * m[k][j];
            }
            x[i] -= f * x[k];
        }
    }
    for (size_t k = MODES; k-- > 0;) {
        for (size_t j = k + 1; j < MODES; j++) {
            x[k] -= m[k][j] * x[j];
        }
        x[k] /= m[k][k];
    }
}

/* Stiffness of a contact at displacements of this amplitude. */
static double complex contact_stiffness(double amplitude)
{
    const double part = limit * soft / amplitude;
    if (!(part < 1.0)) {
        return 1.0 / soft;
    }
    const double angle = acos(1.0 - 2.0 * part);
    return (angle - 0.5 * sin(2.0 * angle) + 4.0 * part * (1.0 - part) * I) / (PI * soft);
}

/* q = Re x e^{i omega t}: (K + i omega C + contacts) x = (omega^2 + 2 i omega delta) x, by inverse iteration, the contacts of the
 * amplitude of x; x_0 = amplitude. */
static void run_one_harmonic(void *data)
{
    struct backbone *b = data;
    double complex x[MODES] = {1.0}, value = 0.0;
    b->iterations = 0;
    for (size_t k = 0; k < AMPLITUDES; k++) {
        double change = 1.0;
        for (size_t n = 0; n < MOST_ITERATIONS && change > 1e-12; n++) {
            double complex a[MODES][MODES] = {{0.0}}, y[MODES];
            const double omega = sqrt(creal(value));
            for (size_t i = 0; i < MODES; i++) {
                a[i][i] = b->model.beam.stiffness[i] + omega * b->model.beam.damping[i] * I;
            }
            for (size_t c = 0; c < CONTACTS; c++) {
                double complex u = 0.0;
                for (size_t i = 0; i < MODES; i++) {
                    u += b->model.beam.j[c][i] * x[i] * (b->amplitude[k] / x[0]);
                }
                const double complex stiffness = contact_stiffness(cabs(u));
                for (size_t i = 0; i < MODES * MODES; i++) {
                    a[i / MODES][i % MODES] += b->model.beam.j[c][i / MODES] * b->model.beam.j[c][i % MODES] * stiffness;
                }
            }
            memcpy(y, x, sizeof y);
            solve_shifted((const double complex(*)[MODES])a, value, y);
            double complex product = 0.0, square = 0.0;
            for (size_t i = 0; i < MODES; i++) { /* symmetric a: x'(a - value)^-1 x */
                product += x[i] * y[i];
                square += x[i] * x[i];
            }
            const double complex next = value + square / product;
            change = cabs(next - value) / cabs(next);
            value = next;
            for (size_t i = 0; i < MODES; i++) {
                x[i] = y[i] / y[0];
            }
            b->iterations++;
        }
        const double omega = sqrt(creal(value));
        b->one[k][0] = omega;
        b->one[k][1] = 0.5 * cimag(value) / (omega * omega);
        need(!(change < 1e-9), "one harmonic does not converge");
    }
}

int main(int argc, char **argv)
{
    program = "bench_backbone";
    struct backbone b = {.iterations = 0};
    double mass[MODES], compliance[CONTACTS];
    tribo_model *model;
    tribo_system *sys = NULL;
    tribo_system_destroy(beam_create(&b.model));
    for (size_t k = 0; k < MODES; k++) {
        mass[k] = 1.0;
    }
    for (size_t i = 0; i < CONTACTS; i++) {
        compliance[i] = soft;
    }
    need(tribo_model_create(&model, MODES, CONTACTS), "no model");
    need(tribo_model_set_mass_diagonal(model, mass) || tribo_model_set_stiffness_diagonal(model, b.model.beam.stiffness) ||
             tribo_model_set_damping_diagonal(model, b.model.beam.damping) ||
             tribo_model_set_direction(model, b.model.beam.j[0]) || tribo_model_set_compliance(model, compliance) ||
             tribo_system_create(&sys, model),
         tribo_model_message(model));
    tribo_model_destroy(model);
    need(tribo_set_limit_all(tribo_system_context(sys), limit), "no limits");
    need(tribo_driver_create(&b.drv, sys, "exact"), tribo_system_message(sys));
    for (size_t k = 0; k < AMPLITUDES; k++) {
        b.amplitude[k] = limit / (b.model.omega * b.model.omega) * pow(10.0, 0.1 * (double)k - 1.0);
    }
    struct job exact = {run_modes, &b, 0.0}, one = {run_one_harmonic, &b, 0.0};
    const double seconds[] = {probe_job(&exact), probe_job(&one)};
    double worst[2] = {0.0, 0.0}, most = 0.0;
    for (size_t k = 0; k < AMPLITUDES; k++) {
        worst[0] = fmax(worst[0], fabs(b.one[k][0] / b.exact[k][0] - 1.0));
        worst[1] = fmax(worst[1], fabs(b.one[k][1] - b.exact[k][1]));
        most = fmax(most, b.exact[k][1]);
    }
    printf("one harmonic: omega off by %.2e of it, zeta by %.2e of %.3g\n", worst[0], worst[1], most);
    if (argc < 2 || strcmp(argv[1], "--smoke") != 0) {
        printf("%d amplitudes: modes %.3g ms, one harmonic %.3g ms (%zu iterations)\n", AMPLITUDES, 1e3 * seconds[0],
               1e3 * seconds[1], b.iterations);
    }
    tribo_driver_destroy(b.drv);
    tribo_system_destroy(sys);
    return worst[0] < 0.02 && worst[1] < 0.05 * most ? EXIT_SUCCESS : EXIT_FAILURE;
}
