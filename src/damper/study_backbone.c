/* SPDX-License-Identifier: BSD-3-Clause */
/* Natural frequency and damping ratio of a mode over the amplitude. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "study.h"
#include "team.h"

enum { COMPARED = 3 /* amplitudes, at most, that are found with twice the modes, too */ };

/* The nonlinear mode of an amplitude. */
struct vibration {
    struct motion motion; /* amplitude, found and message only */
    double omega, zeta;   /* frequency, rad/time, and damping ratio; before the search: of the amplitude before */
};

/* Finds every step-th one of v [amplitudes], each from the one before, the first from the linear modes, with the modes of d.
 * stick [amplitudes][contacts] out, or NULL: shares of rest. */
static void find_backbone(const struct damper *d, const struct options *o, size_t step, struct vibration *v, double *stick)
{
    struct worker w = create_worker(d, 0);
    double *y = need_memory(w.dimension, sizeof *y), omega = d->backbone, zeta = 0.0;
    set_point(&w, o->limits.from, d->lowest);
    memcpy(w.c, d->open.measured, d->modes * sizeof *w.c);
    for (size_t k = step / 2; k < o->amplitudes.points && !interrupted(); k += step) {
        v[k] = (struct vibration){{.amplitude = limit_of(&o->amplitudes, k)}, omega, zeta};
        set_outcome(&v[k].motion, tribo_driver_find_mode(w.drv, w.c, v[k].motion.amplitude, &v[k].omega, &v[k].zeta, y), &w);
        show_point();
        omega = v[k].omega;
        zeta = v[k].zeta;
        if (stick && v[k].motion.found) {
            need(tribo_driver_period_stick(w.drv, w.each), tribo_driver_message(w.drv));
            memcpy(stick + k * d->contacts, w.each, d->contacts * sizeof *stick);
        }
    }
    end_progress();
    free(y);
    free_worker(&w);
}

/* Writes and prints the modes that were searched: amplitude, frequency, damping ratio, and shares of rest in the table only, or the
 * message. Returns the one of most damping, or NULL. */
static const struct vibration *write_backbone(struct study *s, const struct vibration *v, const double *stick)
{
    const size_t contacts = s->damper->contacts;
    const struct vibration *most = NULL;
    FILE *table = create_table(s->tables, "backbone", "csv");
    fprintf(table, "amplitude,frequency,damping ratio");
    for (size_t c = 1; c <= contacts; c++) {
        fprintf(table, ",stick%zu", c);
    }
    fprintf(table, ",message\n");
    printf("mode %zu\n     amplitude    frequency  damping ratio\n", s->options->backbone);
    for (size_t k = 0; k < s->options->amplitudes.points; k++, v++) {
        const struct motion *m = &v->motion;
        if (m->found) {
            printf("  %12.5g %12.7g %14.5g\n", m->amplitude, v->omega / TURN, v->zeta);
            most = !most || v->zeta > most->zeta ? v : most;
            s->tables->motions++;
        } else if (m->message[0]) {
            printf("  %12.5g  not found: %s\n", m->amplitude, m->message);
            s->gaps++;
        } else {
            continue;
        }
        fprintf(table, m->found ? "%.10g,%.10g,%.10g" : "%.10g,,", m->amplitude, v->omega / TURN, v->zeta);
        for (size_t c = 0; c < contacts; c++) {
            fprintf(table, m->found ? ",%.10g" : ",", stick[k * contacts + c]);
        }
        fprintf(table, m->found ? ",\n" : ",\"%s\"\n", m->message);
    }
    close_table(s->tables, table, "backbone", "csv");
    return most;
}

void study_backbone(struct study *s)
{
    const struct damper *d = s->damper;
    const size_t count = s->options->amplitudes.points;
    struct vibration *v = need_memory(2 * count, sizeof *v), *there = v + count;
    double *stick = need_memory(count * d->contacts, sizeof *stick), hz = 0.0, zeta = 0.0;
    size_t compared = 0;
    report_model(s->tables, s->model);
    find_backbone(d, s->options, 1, v, stick);
    const struct vibration *most = write_backbone(s, v, stick);
    if (most) {
        printf("most damping: ratio %.8g at amplitude %.8g, frequency %.8g\n", most->zeta, most->motion.amplitude,
               most->omega / TURN);
        write_result(s->tables, "backbone.damping", most->zeta);
        write_result(s->tables, "backbone.amplitude", most->motion.amplitude);
        write_result(s->tables, "backbone.frequency", most->omega / TURN);
    }
    if (s->model->whole) {
        printf("model error: none, since all modes are there\n");
    } else if (!interrupted()) { /* some of them with twice the modes, too */
        find_backbone(&s->model->finer, s->options, (count + COMPARED - 1) / COMPARED, there, NULL);
        for (size_t k = 0; k < count; k++) {
            const int both = v[k].motion.found && there[k].motion.found;
            hz = both ? fmax(hz, relative_difference(there[k].omega, v[k].omega)) : hz;
            zeta = both ? fmax(zeta, fabs(there[k].zeta - v[k].zeta)) : zeta;
            compared += (size_t)both;
        }
        printf("model error: with %zu modes frequencies change by %.1e of themselves, damping ratios by %.1e (at %zu point%s)\n",
               s->model->finer.kept, hz, zeta, compared, compared == 1 ? "" : "s");
    }
    if (compared) {
        write_result(s->tables, "model.frequency", hz);
        write_result(s->tables, "model.damping", zeta);
    }
    plot_backbone(s->tables);
    free(v);
    free(stick);
}
