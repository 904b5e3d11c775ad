/* The lowest modes of structures as CalculiX writes them (name.sti, name.mas, name.dof, name.inp): what finding them takes, and
 * how far the frequencies are from given ones. Prints values by name, "ndof 10680", for modes.sh. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "../../examples/common/output.h"
#include "../../examples/damper/structure.h"
#include "harness.h"
#include "memory.h"
#include "tribo/tribo_gsl.h"


static struct structure read_plate(const char *name)
{
    char *mass = new_text("%s.mas", name), *stiffness = new_text("%s.sti", name), *dofs = new_text("%s.dof", name);
    struct structure s = read_structure(mass, stiffness, dofs);
    free(mass);
    free(stiffness);
    free(dofs);
    return s;
}

static tribo_system *find_modes(const struct structure *s, size_t modes)
{
    tribo_system *sys;
    char message[200] = "";
    gsl_spmatrix *none = gsl_spmatrix_alloc(1, s->ndof);
    need(tribo_system_linear_sparse(&sys, s->mass, NULL, s->stiffness, none, modes, message, sizeof message), message);
    gsl_spmatrix_free(none);
    return sys;
}

int main(int argc, char **argv)
{
    gsl_set_error_handler_off();
    struct structure s = read_plate(argv[1]);
    size_t modes = argc > 2 ? (size_t)atoi(argv[2]) : 20;
    printf("ndof %zu\n", s.ndof);
    double before = memory_begin();
    double begin = cpu_seconds();
    tribo_system *sys = find_modes(&s, modes);
    printf("seconds %.3f\nMB %.1f\n", cpu_seconds() - begin, memory_peak() - before);
    double *omega = need_memory(modes, sizeof *omega);
    tribo_system_get_frequencies(sys, omega);
    for (size_t k = 0; k < modes; k++) {
        printf("hz %.12g\n", omega[k] / (2 * M_PI));
    }
    return 0;
}
