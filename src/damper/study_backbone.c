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
    double amplitude, omega, zeta; /* omega, zeta: a guess before it is found; of the mode before */
    int found;
    char message[200]; /* why it was not found; else empty */
};

/* Finds v from the mode y [dimension] before, or from the linear modes, with omega and zeta as they are; y out: its state. */
static void find_vibration(struct worker *w, struct vibration *v, double *y)
{
    const struct damper *d = w->d;
    memset(w->c, 0, 2 * d->modes * sizeof *w->c);
    memcpy(w->c, d->open.measured, d->modes * sizeof *w->c);
    const int status = tribo_driver_find_mode(w->drv, w->c, v->amplitude, &v->omega, &v->zeta, y);
    v->found = !status;
    v->message[0] = '\0';
    if (status) {
        snprintf(v->message, sizeof v->message, "%s: %s", tribo_strerror(status), tribo_driver_message(w->drv));
    }
    show_point();
}

/* Finds every step-th one of v [amplitudes], each from the one before, with the modes of d; writes amplitude, frequency,
 * damping ratio and shares of rest to the table, unless it is NULL; blank where the mode was not found. */
static void find_backbone(const struct damper *d, const struct options *o, size_t step, struct vibration *v, FILE *table)
{
    struct worker w = create_worker(d, 0);
    double *y = need_memory(w.dimension, sizeof *y);
    struct vibration before = {.omega = linear_of_backbone(d)->omega[o->backbone - 1]};
    set_point(&w, o->limits.from, d->lowest);
    for (size_t c = 0; table && c <= d->contacts; c++) {
        fprintf(table, c ? ",stick%zu" : "amplitude,frequency,damping ratio", c);
    }
    if (table) {
        fprintf(table, ",message\n");
    }
    for (size_t k = step / 2; k < o->amplitudes.points && !interrupted(); k += step) {
        v[k] = before;
        v[k].amplitude = limit_of(&o->amplitudes, k);
        find_vibration(&w, &v[k], y);
        before = v[k];
        if (table && v[k].found) {
            need(tribo_driver_period_stick(w.drv, w.each), tribo_driver_message(w.drv));
        }
        if (table) {
            fprintf(table, v[k].found ? "%.10g,%.10g,%.10g" : "%.10g,,", v[k].amplitude, v[k].omega / TURN, v[k].zeta);
        }
        for (size_t c = 0; table && c < d->contacts; c++) {
            fprintf(table, v[k].found ? ",%.10g" : ",", w.each[c]);
        }
        if (table) {
            fprintf(table, v[k].found ? ",\n" : ",\"%s\"\n", v[k].message);
        }
    }
    end_progress();
    free(y);
    free_worker(&w);
}

void study_backbone(struct study *s)
{
    const struct damper *d = s->damper;
    const size_t count = s->options->amplitudes.points;
    struct vibration *v = need_memory(2 * count, sizeof *v), *there = v + count;
    const struct vibration *most = NULL;
    double hz = 0.0, zeta = 0.0;
    size_t compared = 0;
    write_frequencies(s->tables, d, s->options->frequencies);
    report_model(s->tables, s->model);
    FILE *table = create_table(s->tables, "backbone", "csv");
    find_backbone(d, s->options, 1, v, table);
    close_table(s->tables, table, "backbone", "csv");
    printf("mode %zu\n     amplitude    frequency  damping ratio\n", s->options->backbone);
    for (size_t k = 0; k < count; k++) {
        if (v[k].found) {
            printf("  %12.5g %12.7g %14.5g\n", v[k].amplitude, v[k].omega / TURN, v[k].zeta);
            most = !most || v[k].zeta > most->zeta ? &v[k] : most;
            s->tables->motions++;
        } else if (v[k].message[0]) {
            printf("  %12.5g  not found: %s\n", v[k].amplitude, v[k].message);
            s->gaps++;
        }
    }
    if (most) {
        printf("most damping: ratio %.8g at amplitude %.8g, frequency %.8g\n", most->zeta, most->amplitude, most->omega / TURN);
        write_result(s->tables, "backbone.damping", most->zeta);
        write_result(s->tables, "backbone.amplitude", most->amplitude);
        write_result(s->tables, "backbone.frequency", most->omega / TURN);
    }
    if (s->model->whole) {
        printf("model error: none, since all modes are there\n");
    } else if (!interrupted()) { /* some of them with twice the modes, too */
        find_backbone(&s->model->finer, s->options, (count + COMPARED - 1) / COMPARED, there, NULL);
        for (size_t k = 0; k < count; k++) {
            const int both = v[k].found && there[k].found;
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
}
