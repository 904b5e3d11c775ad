#include "tables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_sort.h>

#include "output.h"
#include "linear.h"
#include "march.h"
#include "plot.h"

struct tables open_tables(const struct options *o)
{
    struct tables t = {.out = o->out, .name = o->name, .plot = o->plot, .script = open_plots(o)};
    char *name = new_text("values-%s.txt", t.name);
    t.values = create_file(t.out, name);
    free(name);
    return t;
}

void close_tables(struct tables *t)
{
    char *name = new_text("%s/values-%s.txt", t->out, t->name);
    close_file(t->values, name);
    free(name);
}

FILE *create_table(const struct tables *t, const char *what)
{
    char *name = new_text("%s-%s.csv", t->name, what);
    FILE *file = create_file(t->out, name);
    free(name);
    return file;
}

void close_table(const struct tables *t, FILE *file, const char *what)
{
    char *name = new_text("%s/%s-%s.csv", t->out, t->name, what);
    close_file(file, name);
    free(name);
}

void write_result(const struct tables *t, const char *key, double value)
{
    write_value(t->values, value, "%s.%s", t->name, key);
}

/* ------------------------------------------------------------------------------------------------------------- motions */

void write_motion_head(FILE *file, const struct damper *d)
{
    fprintf(file, "limit,frequency,amplitude,friction power,damping power,input power,periods,message");
    for (size_t c = 1; d && c <= d->contacts; c++) {
        fprintf(file, ",power%zu,stick%zu", c, c);
    }
    for (size_t k = 1; d && k <= d->outputs; k++) {
        fprintf(file, ",amplitude%zu,phase%zu", k, k);
    }
    fprintf(file, "\n");
}

static void write_message(FILE *file, const char *message)
{
    fputc('"', file);
    for (; *message; message++) {
        fputc(*message == '"' ? '\'' : *message, file);
    }
    fputc('"', file);
}

/* count pairs, first [i * step] and second [i * step]; blank if they were not found. */
static void write_pairs(FILE *file, const struct motion *m, size_t count, const double *first, const double *second, size_t step)
{
    for (size_t i = 0; i < count; i++) {
        if (m->found) {
            fprintf(file, ",%.10g,%.10g", first[i * step], second[i * step]);
        } else {
            fprintf(file, ",,");
        }
    }
}

void write_motion(FILE *file, const struct motion *m, const double *y, const struct damper *d)
{
    fprintf(file, "%.10g,%.10g", m->limit, m->hz);
    if (m->found) {
        fprintf(file, ",%.10g,%.10g,%.10g,%.10g,%zu,", m->amplitude, m->friction, m->damped, m->input, m->periods);
    } else {
        fprintf(file, ",,,,,%zu,", m->periods);
        write_message(file, m->message);
    }
    if (d) {
        const double *power = y + d->dimension, *output = power + 2 * d->contacts;
        write_pairs(file, m, d->contacts, power, power + d->contacts, 1);
        write_pairs(file, m, d->outputs, output, output + 1, 2);
    }
    fprintf(file, "\n");
}

void write_curve(struct tables *t, FILE *file, const struct curve *c, const struct damper *d)
{
    for (size_t k = 0; k < c->count; k++) {
        if (looked_for(&c->sample[k])) {
            write_motion(file, &c->sample[k].motion, c->sample[k].y, d);
            t->motions += (size_t)c->sample[k].motion.found;
        }
    }
}

/* -------------------------------------------------------------------------------------------------------------- modes */

void write_frequencies(const struct tables *t, const struct damper *d, const char *given)
{
    double *hz = need_memory(2 * d->modes, sizeof *hz), *stuck = hz + d->modes, worst = 0.0;
    const size_t known = given ? read_frequencies(given, hz, d->kept) : 0, held = stuck_frequencies(d, stuck);
    FILE *table = create_table(t, "frequencies");
    fprintf(table, "mode,frequency,given,relative difference,stuck\n");
    printf("natural frequencies, Hz; the last with all contacts stuck\n  mode         here%s        stuck\n",
           known ? "        given  relative difference" : "");
    for (size_t k = 0; k < d->kept; k++) {
        const double here = d->omega[k] / TURN, off = k < known ? here / hz[k] - 1.0 : 0.0;
        char *seen = k < known ? new_text("%12.7g  %19.1e", hz[k], off) : new_text("%*s", known ? 33 : 0, "");
        char *kept = k < known ? new_text("%.10g,%.3g", hz[k], off) : new_text(",");
        char *still = k < held ? new_text("%.10g", stuck[k] / TURN) : new_text("%s", "");
        printf("  %4zu %12.7g %s%s %12.8s\n", k + 1, here, seen, known ? "" : "", still);
        fprintf(table, "%zu,%.10g,%s,%s\n", k + 1, here, kept, still);
        worst = fmax(worst, fabs(off));
        write_value(t->values, here, "%s.frequency%zu", t->name, k + 1);
        free(seen);
        free(kept);
        free(still);
    }
    if (known) {
        write_result(t, "frequency.error", worst);
    }
    close_table(t, table, "frequencies");
    fflush(stdout);
    free(hz);
}

/* Evenly spaced frequencies, and the resonances between them; *count out. */
static double *linear_frequencies(const struct damper *d, const struct range *band, size_t *count)
{
    enum { EVEN = 2001 };
    double *omega = need_memory(EVEN + 2 * d->modes, sizeof *omega);
    const size_t resonances = d->kept + stuck_frequencies(d, omega);
    memcpy(omega + resonances - d->kept, d->omega, d->kept * sizeof *omega);
    *count = 0;
    for (size_t k = 0; k < resonances; k++) {
        if (omega[k] > TURN * band->from && omega[k] < TURN * band->to) {
            omega[(*count)++] = omega[k];
        }
    }
    for (size_t k = 0; k < EVEN; k++) {
        omega[(*count)++] = TURN * (band->from + (band->to - band->from) * ((double)k / (EVEN - 1)));
    }
    gsl_sort(omega, 1, *count);
    return omega;
}

void write_linear(const struct tables *t, const struct damper *d, const struct range *band)
{
    size_t count;
    double *omega = linear_frequencies(d, band, &count);
    FILE *table = create_table(t, "linear");
    fprintf(table, "frequency,without friction,stuck\n");
    for (size_t k = 0; k < count; k++) {
        fprintf(table, "%.10g,%.10g,%.10g\n", omega[k] / TURN, free_amplitude(d, omega[k]), stuck_amplitude(d, omega[k]));
    }
    close_table(t, table, "linear");
    free(omega);
}

/* ------------------------------------------------------------------------------------------------------------- history */

enum { PERIODS = 3, STEPS = 3000 /* of them all */ };

static void write_instant(FILE *table, const struct damper *d, double cycle, double t, const double *y, const double *v,
                          const double *f, const signed char *slip)
{
    fprintf(table, "%.8g,%.10g,%.10g", cycle, t, load_displacement(d, y));
    for (size_t c = 0; c < d->contacts; c++) {
        fprintf(table, ",%.8g,%.8g,%d", v[c], f[c], slip[c]);
    }
    for (size_t c = 0; c < d->contacts; c++) {
        double z = 0.0;
        for (size_t k = 0; k < d->modes; k++) {
            z += d->contact_shape[c * d->modes + k] * y[k];
        }
        fprintf(table, ",%.8g", z);
    }
    fprintf(table, "\n");
}

void write_history(const struct tables *t, struct worker *w, const struct motion *m, const double *y, const char *what)
{
    const struct damper *d = w->d;
    tribo_context *contacts = tribo_system_context(w->sys);
    double *v = need_memory(2 * d->contacts, sizeof *v), *f = v + d->contacts, now = 0.0;
    double *state = need_memory(w->dimension, sizeof *state);
    signed char *slip = need_memory(d->contacts, sizeof *slip);
    FILE *table = create_table(t, what);
    tribo_driver *marcher = w->drv ? NULL : create_marcher(w, m->limit, m->hz), *drv = marcher ? marcher : w->drv;
    if (!marcher) {
        set_point(w, m->limit, m->hz);
        /* contacts that stick have velocities of rounding size: a law with a band around v = 0 sees them stick */
        need(tribo_set_law(contacts, TRIBO_QUINN), tribo_message(contacts));
        const double size = fmax(m->amplitude, 1e-6 * free_amplitude(d, TURN * m->hz));
        need(tribo_set_epsilon_all(contacts, 1e-8 * TURN * m->hz * size), tribo_message(contacts));
    }
    memcpy(state, y, w->dimension * sizeof *state);
    fprintf(table, "cycle,t,displacement");
    for (size_t c = 0; c < d->contacts; c++) {
        fprintf(table, ",v%zu,f%zu,mode%zu", c + 1, c + 1, c + 1);
    }
    for (size_t c = 0; c < d->contacts; c++) {
        fprintf(table, ",z%zu", c + 1);
    }
    fprintf(table, "\n");
    for (int i = 0; i <= STEPS; i++) {
        const double cycle = (double)PERIODS * i / STEPS;
        need(tribo_driver_advance(drv, &now, cycle / m->hz, state), tribo_driver_message(drv));
        need(tribo_system_contacts(w->sys, now, state, v, NULL, f), tribo_system_message(w->sys));
        need(tribo_system_get_slip(w->sys, slip), tribo_system_message(w->sys));
        write_instant(table, d, cycle, now, state, v, f, slip);
    }
    close_table(t, table, what);
    plot_loops(t, d->contacts, m->limit, what);
    tribo_driver_destroy(marcher);
    free(v);
    free(state);
    free(slip);
}
