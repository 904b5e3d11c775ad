/* SPDX-License-Identifier: BSD-3-Clause */
/* A joint that slips element by element: springs in series with Coulomb sliders, side by side (Iwan 1966), in your own loop with
 * tribo_elastic_force. Its branches are the first loading curve, doubled (Masing 1926), and a small loop within a large one
 * closes, after which the large one goes on as if nothing had been.
 *
 *     contact_hysteresis FOLDER
 *
 * Writes FOLDER/hysteresis.csv and FOLDER/values-hysteresis.txt. */
#include <math.h>

#include "../../src/damper/output.h"
#include "tribo/tribo.h"

enum { ELEMENTS = 25, STEPS = 400 };

/* All elements have the same stiffness; the first one slips from z = 1/25 on, the last one from z = 1 on. */
struct joint {
    double stiffness[ELEMENTS], limit[ELEMENTS], f[ELEMENTS], z;
};

static struct joint new_joint(void)
{
    struct joint j = {.z = 0.0};
    for (int i = 0; i < ELEMENTS; i++) {
        j.stiffness[i] = 1.0 / ELEMENTS;
        j.limit[i] = j.stiffness[i] * (i + 1) / ELEMENTS;
    }
    return j;
}

/* Takes the joint to z; returns the force that this needs, minus the sum of f. */
static double move(struct joint *j, double z)
{
    double dz[ELEMENTS], sum = 0.0;
    for (int i = 0; i < ELEMENTS; i++) {
        dz[i] = z - j->z;
    }
    need(tribo_elastic_force(ELEMENTS, dz, j->stiffness, j->limit, j->f, NULL), NULL);
    j->z = z;
    for (int i = 0; i < ELEMENTS; i++) {
        sum -= j->f[i];
    }
    return sum;
}

/* The force of a joint that is loaded for the first time. */
static double first_loading(double z)
{
    struct joint fresh = new_joint();
    return move(&fresh, z);
}

/* Through a list of turning points; returns how far the branches are from Masing's rule. Every branch is measured from its own
 * turning point; where a small loop has closed, from the turning point of the loop around it. */
static double trace(FILE *table)
{
    static const struct {
        double z, from; /* the end of a branch, and the turning point that rules the end of it */
    } branch[] = {{0.8, 0.0}, {-0.8, 0.8}, {0.45, -0.8}, {-0.35, 0.45}, {0.45, -0.35}, {0.8, -0.8}, {-0.5, 0.8}};
    struct joint joint = new_joint();
    double worst = 0.0, turn = 0.0, force = 0.0, at_turn[sizeof branch / sizeof *branch];
    for (size_t b = 0; b < sizeof branch / sizeof *branch; b++) {
        for (int k = 1; k <= STEPS; k++) {
            const double z = turn + (branch[b].z - turn) * k / STEPS;
            force = move(&joint, z);
            fprintf(table, "%zu,%.10g,%.10g\n", b, z, force);
        }
        at_turn[b] = force;
        double start = 0.0; /* the force where the ruling branch turned */
        for (size_t e = 0; e < b; e++) {
            start = branch[e].z == branch[b].from ? at_turn[e] : start;
        }
        const double way = branch[b].z - branch[b].from;
        const double rule = b ? start + copysign(2.0 * first_loading(0.5 * fabs(way)), way) : first_loading(way);
        worst = fmax(worst, fabs(force - rule));
        turn = branch[b].z;
    }
    return worst;
}

/* A single element, k = 2 and N = 3, in cycles of amplitude 4: energy of a steady cycle, 4 N (X - N/k), and the stiffness that
 * its force has at the frequency of the motion. */
static void single_element(FILE *values)
{
    const double k = 2.0, limit = 3.0, amplitude = 4.0, pi = acos(-1.0);
    const int steps = 100000;
    double f = 0.0, energy = 0.0, in_phase = 0.0;
    for (int i = 1; i <= 2 * steps; i++) {
        const double z = amplitude * cos(2.0 * pi * i / steps), dz = z - amplitude * cos(2.0 * pi * (i - 1) / steps);
        const double before = f;
        need(tribo_elastic_force(1, &dz, &k, &limit, &f, NULL), NULL);
        if (i > steps) {
            energy -= 0.5 * (before + f) * dz;
            in_phase -= 2.0 * f * z / (amplitude * amplitude * steps);
        }
    }
    const double theta = acos(1.0 - 2.0 * limit / (k * amplitude));
    write_value(values, energy, "hysteresis.energy");
    write_value(values, in_phase, "hysteresis.stiffness");
    write_value(values, k / pi * (theta - 0.5 * sin(2.0 * theta)), "hysteresis.stiffness.formula");
    printf("one element: %.6f a cycle, stiffness %.6f\n", energy, in_phase);
}

int main(int argc, char **argv)
{
    program = "contact_hysteresis";
    if (argc != 2) {
        die("usage: contact_hysteresis FOLDER");
    }
    FILE *table = create_file(argv[1], "hysteresis.csv"), *values = create_file(argv[1], "values-hysteresis.txt");
    fprintf(table, "branch,displacement,force\n");
    const double worst = trace(table);
    single_element(values);
    write_value(values, worst, "hysteresis.masing");
    printf("ends of branches differ from Masing's rule by %.1e at most\n", worst);
    close_file(table, "hysteresis.csv");
    close_file(values, "values-hysteresis.txt");
    return 0;
}
