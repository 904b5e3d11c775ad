/* SPDX-License-Identifier: BSD-3-Clause */
/* tribo-damper: the steady response of a finite-element model with friction contacts to harmonic loads, and the limit of contacts
 * that makes the best friction damper. Options: tribo-damper --help. */
#include <stdlib.h>

#include "output.h"
#include "study.h"
#include "team.h"

enum { INTERRUPTED = 130 /* status, as shells have it */ };

int main(int argc, char **argv)
{
    program = "tribo-damper";
    struct options options = read_options(argc, argv);
    struct structure structure = read_structure(options.mass, options.stiffness, options.dofs);
    if (options.damping_matrix) {
        structure.damping = read_matrix(options.damping_matrix, &(struct rows){structure.ndof, options.dofs});
    }
    complete_options(&options, &structure);
    report_loose_rows(&structure, options.stiffness);
    watch_interrupts();
    struct model model = create_model(&options, &structure);
    struct tables tables = open_tables(&options);
    struct study study = {&options, &model, &model.damper, &tables, .gaps = 0};
    run_study(&study);
    write_result(&tables, "gaps", (double)study.gaps);
    if (study.gaps) {
        printf("%zu point%s not found: gaps in the tables, with messages\n", study.gaps, study.gaps == 1 ? " was" : "s were");
    }
    if (interrupted()) {
        printf(tables.motions ? "interrupted: tables hold what was found until then\n"
                              : "interrupted before a motion was found: there are no tables of motions\n");
    }
    close_tables(&tables);
    draw_plots(&tables);
    die_if(study.nothing[0], "option --follow: no motion was found: %s", study.nothing);
    close_file(stdout, "standard output");
    free_model(&model);
    free_structure(&structure);
    free_options(&options);
    return interrupted() ? INTERRUPTED : EXIT_SUCCESS;
}
