/* A structure with friction contacts, as a user meets it: matrices from a finite-element program, contacts by coordinates, its
 * steady response to a harmonic load, and the question which contact force makes the best friction damper. tribo-damper --help
 * tells the rest. */
#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>

#include "output.h"
#include "march.h"
#include "study.h"
#include "team.h"

enum { INTERRUPTED = 130 /* status, as shells have it */ };

static void check_drives(const struct options *o, const struct damper *d)
{
    const double first = d->omega[0] / TURN;
    const double ends[] = {o->drive.from > 0.0 ? o->drive.from : first, o->drive.to > 0.0 ? o->drive.to : first};
    for (int k = 0; k < 2; k++) {
        check_drive(d, ends[k]);
        if (o->march || o->check) {
            check_steps(d, ends[k]);
        }
    }
}

int main(int argc, char **argv)
{
    program = "tribo-damper";
    gsl_set_error_handler_off();
    const struct options options = read_options(argc, argv);
    struct structure structure = read_structure(options.mass, options.stiffness, options.dofs);
    tell_of_loose_rows(&structure, options.stiffness);
    struct damper damper = create_damper(&options, &structure);
    free_structure(&structure);
    struct tables tables = open_tables(&options);
    struct study study = {&options, &damper, &tables, 0};
    check_drives(&options, &damper);
    watch_interrupts();
    write_frequencies(&tables, &damper, options.frequencies);
    (options.drive.points > 1 ? study_band : study_limits)(&study);
    write_result(&tables, "gaps", (double)study.gaps);
    if (study.gaps) {
        printf("%zu point%s not found: gaps in the tables, with messages\n", study.gaps, study.gaps == 1 ? " was" : "s were");
    }
    if (interrupted()) {
        printf("interrupted: tables hold what was found until then\n");
    }
    close_tables(&tables);
    close_file(stdout, "standard output");
    free_damper(&damper);
    return interrupted() ? INTERRUPTED : EXIT_SUCCESS;
}
