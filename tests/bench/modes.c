/* SPDX-License-Identifier: BSD-3-Clause */
/* The lowest modes of a structure: what finding them takes, and how far frequencies are from others'.
 *   bench_modes mass stiffness dofs modes [frequencies in Hz [tolerance]]
 * Prints values by name; status 1 if a frequency is off by more than the tolerance, 1e-6, of itself. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>

#include "../../src/damper/output.h"
#include "structure_model.h"
#include "harness.h"
#include "memory.h"
#include "tribo/tribo_gsl.h"

#define PI 3.14159265358979323846
#define SAME 1e-6

enum { MOST = 1000 };

static tribo_system *find_modes(const struct structure *s, size_t modes)
{
    tribo_system *sys;
    tribo_model *model = model_of(s, 0, NULL);
    need(tribo_system_reduce(&sys, model, modes, TRIBO_STATICS_NONE), tribo_model_message(model));
    tribo_model_destroy(model);
    return sys;
}

/* The largest difference from the frequencies of a file, relative. */
static double compare(const char *path, size_t modes, const double *omega)
{
    double hz[MOST], most = 0.0;
    const size_t count = read_frequencies(path, hz, modes);
    for (size_t k = 0; k < count; k++) {
        most = fmax(most, fabs(omega[k] / (2.0 * PI * hz[k]) - 1.0));
    }
    printf("compared %zu\ndifference %.1e\n", count, most);
    return most;
}

int main(int argc, char **argv)
{
    program = "bench_modes";
    gsl_set_error_handler_off(); /* as read_structure expects */
    const long modes = argc > 4 ? strtol(argv[4], NULL, 10) : 0;
    if (argc < 5 || modes < 1 || modes > MOST) {
        die("usage: bench_modes mass stiffness dofs modes [frequencies [tolerance]], 1 to %d modes", MOST);
    }
    double omega[MOST], begin = cpu_seconds();
    struct structure s = read_structure(argv[1], argv[2], argv[3]);
    printf("ndof %zu\nreading %.2f s\n", s.ndof, cpu_seconds() - begin);
    const double before = memory_begin();
    begin = cpu_seconds();
    tribo_system *sys = find_modes(&s, (size_t)modes);
    printf("modes %.3f s\nmemory %.0f MB\n", cpu_seconds() - begin, memory_peak() - before);
    need(tribo_system_get_frequencies(sys, omega), NULL);
    printf("first %.9g Hz\nlast %.9g Hz\n", omega[0] / (2.0 * PI), omega[modes - 1] / (2.0 * PI));
    const double difference = argc > 5 ? compare(argv[5], (size_t)modes, omega) : 0.0;
    tribo_system_destroy(sys);
    free_structure(&s);
    return !(difference <= (argc > 6 ? strtod(argv[6], NULL) : SAME));
}
