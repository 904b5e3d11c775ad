/* SPDX-License-Identifier: BSD-3-Clause */
#include "tables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"

struct tables open_tables(const struct options *o)
{
    const char *limit = o->contacts.by_load ? "normal load" : "limit";
    struct tables t = {.out = o->out, .name = o->name, .limit = limit, .followed = o->follow != 0, .plot = o->plot};
    char *name = new_text("values-%s.txt", t.name);
    open_plots(&t);
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

FILE *create_table(const struct tables *t, const char *what, const char *ending)
{
    char *name = new_text("%s-%s.%s", t->name, what, ending);
    FILE *file = create_file(t->out, name);
    free(name);
    return file;
}

void close_table(const struct tables *t, FILE *file, const char *what, const char *ending)
{
    char *name = new_text("%s/%s-%s.%s", t->out, t->name, what, ending);
    close_file(file, name);
    free(name);
}

void write_result(const struct tables *t, const char *key, double value)
{
    write_value(t->values, value, "%s.%s", t->name, key);
}

/* ------------------------------------------------------------------------------------------------------------- motions */

void write_motion_head(const struct tables *t, FILE *file, const struct damper *d)
{
    fprintf(file, "%s,frequency,amplitude,friction power,damping power,input power,periods,message", t->limit);
    fprintf(file, d && d->options->follow ? ",stable" : "");
    for (size_t c = 1; d && c <= d->contacts; c++) {
        fprintf(file, d->contact[c - 1].normal.direction ? ",power%zu,stick%zu,open%zu" : ",power%zu,stick%zu", c, c, c);
    }
    for (size_t k = 1; d && k <= d->options->outputs.count; k++) {
        fprintf(file, ",amplitude%zu,phase%zu", k, k);
        for (size_t h = 1; h <= d->options->harmonics; h++) {
            fprintf(file, h > 1 ? ",harmonic%zu.%zu,phase%zu.%zu" : ",harmonic%zu.%zu", k, h, k, h);
        }
    }
    fprintf(file, "\n");
}

/* Blank if the motion was not found, or for NaN. */
static void write_number(FILE *file, const struct motion *m, double value)
{
    fprintf(file, !m->found || isnan(value) ? "," : ",%.10g", value);
}

void write_motion(FILE *file, const struct motion *m, const double *y, const struct damper *d)
{
    fprintf(file, "%.10g,%.10g", m->limit, m->hz);
    write_number(file, m, m->amplitude);
    write_number(file, m, m->friction);
    write_number(file, m, m->damped);
    write_number(file, m, m->input);
    fprintf(file, ",%zu,%s", m->periods, m->message[0] ? "\"" : "");
    for (const char *c = m->message; *c; c++) {
        fputc(*c == '"' ? '\'' : *c, file);
    }
    fprintf(file, m->message[0] ? "\"" : "");
    if (d && d->options->follow) {
        write_number(file, m, m->stable < 0 ? (double)NAN : m->stable);
    }
    for (size_t c = 0; d && c < d->contacts; c++) {
        write_number(file, m, y[d->dimension + c]);
        write_number(file, m, y[d->dimension + d->contacts + c]);
        if (d->contact[c].normal.direction) {
            write_number(file, m, y[d->dimension + 2 * d->contacts + c]);
        }
    }
    for (size_t k = 0; d && k < d->options->outputs.count; k++) {
        const double *o = y + d->dimension + 3 * d->contacts + k * d->output;
        write_number(file, m, o[0]);
        write_number(file, m, o[2]);
        for (size_t h = 1; h <= d->options->harmonics; h++) {
            write_number(file, m, o[2 * h - 1]);
            if (h > 1) {
                write_number(file, m, o[2 * h]);
            }
        }
    }
    fprintf(file, "\n");
}

void write_curves(struct tables *t, const char *what, const struct curve *c, size_t count, const struct damper *d)
{
    FILE *file = create_table(t, what, "csv");
    write_motion_head(t, file, d);
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < c[i].count; k++) {
            const struct sample *s = &c[i].sample[k];
            if (searched(s)) {
                write_motion(file, &s->motion, s->y, d);
                t->motions += (size_t)s->motion.found;
            }
        }
        fprintf(file, i + 1 < count && c[i].count ? "\n" : "");
    }
    close_table(t, file, what, "csv");
}

/* -------------------------------------------------------------------------------------------------------------- modes */

void write_frequencies(const struct tables *t, const struct damper *d, const char *given)
{
    double *hz = need_memory(d->kept, sizeof *hz), worst = 0.0;
    const size_t known = given ? read_frequencies(given, hz, d->kept) : 0;
    FILE *table = create_table(t, "frequencies", "csv");
    fprintf(table, "mode,frequency,given,relative difference,stuck\n");
    printf("natural frequencies, Hz; the last with all contacts stuck\n  mode         here%s        stuck\n",
           known ? "        given  relative difference" : "");
    for (size_t k = 0; k < d->kept; k++) {
        const double here = d->open.omega[k] / TURN, off = k < known ? here / hz[k] - 1.0 : 0.0;
        char *seen = k < known ? new_text("%12.7g  %19.1e", hz[k], off) : new_text("%*s", known ? 33 : 0, "");
        char *still = k < d->stuck.count ? new_text("%.10g", d->stuck.omega[k] / TURN) : new_text("%s", "");
        printf("  %4zu %12.7g %s %12.8s\n", k + 1, here, seen, still);
        fprintf(table, "%zu,%.10g,", k + 1, here);
        fprintf(table, k < known ? "%.10g,%.3g" : ",", hz[k], off);
        fprintf(table, ",%s\n", still);
        worst = fmax(worst, fabs(off));
        write_value(t->values, here, "%s.frequency%zu", t->name, k + 1);
        free(seen);
        free(still);
    }
    if (known) {
        write_result(t, "frequency.error", worst);
    }
    close_table(t, table, "frequencies", "csv");
    fflush(stdout);
    free(hz);
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void write_linear(const struct tables *t, const struct damper *d, const struct range *band)
{
    enum { EVEN = 2001 };
    double *omega = need_memory(EVEN + 2 * d->modes, sizeof *omega);
    size_t count = 0;
    FILE *table = create_table(t, "linear", "csv");
    for (size_t k = 0; k < d->kept + d->stuck.count; k++) {
        const double resonance = k < d->kept ? d->open.omega[k] : d->stuck.omega[k - d->kept];
        if (resonance > TURN * band->from && resonance < TURN * band->to) {
            omega[count++] = resonance;
        }
    }
    for (size_t k = 0; k < EVEN; k++) {
        omega[count++] = TURN * (band->from + (band->to - band->from) * ((double)k / (EVEN - 1)));
    }
    qsort(omega, count, sizeof *omega, compare_numbers);
    fprintf(table, "frequency,without friction,stuck\n");
    for (size_t k = 0; k < count; k++) {
        fprintf(table, "%.10g,%.10g,%.10g\n", omega[k] / TURN, scale_of(&d->open, omega[k]).amplitude,
                scale_of(&d->stuck, omega[k]).amplitude);
    }
    close_table(t, table, "linear", "csv");
    free(omega);
}

/* ------------------------------------------------------------------------------------------------------------- history */

enum { PERIODS = 3, STEPS = 3000 /* of them all */ };

void write_history(const struct tables *t, struct worker *w, const struct motion *m, const double *y, const char *what)
{
    const struct damper *d = w->d;
    double *v = need_memory(2 * d->rows, sizeof *v), *f = v + d->rows, now = 0.0;
    double *state = need_memory(w->dimension, sizeof *state);
    signed char *slip = need_memory(d->rows, sizeof *slip);
    FILE *table = create_table(t, what, "csv");
    tribo_driver *drv = driver_at(w, m->limit, m->hz);
    if (drv == w->drv) {
        tribo_context *contacts = tribo_system_context(w->sys);
        /* contacts that stick have velocities of rounding size: a law with a band around v = 0 sees them stick */
        const double size = fmax(m->amplitude, 1e-6 * scale_of(&d->open, TURN * m->hz).amplitude);
        need(tribo_set_law(contacts, TRIBO_QUINN), tribo_message(contacts));
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
    for (size_t r = d->contacts; r < d->rows; r++) {
        fprintf(table, ",normal%zu", r - d->contacts + 1);
    }
    fprintf(table, "\n");
    for (int i = 0; i <= STEPS; i++) {
        const double cycle = (double)PERIODS * i / STEPS;
        need(tribo_driver_advance(drv, &now, cycle / m->hz, state), tribo_driver_message(drv));
        need(tribo_system_contacts(w->sys, now, state, v, NULL, f), tribo_system_message(w->sys));
        need(tribo_system_get_slip(w->sys, slip), tribo_system_message(w->sys));
        fprintf(table, "%.8g,%.10g,%.10g", cycle, now, dot(d->open.measured, state, d->modes));
        for (size_t c = 0; c < d->contacts; c++) {
            fprintf(table, ",%.8g,%.8g,%d", v[c], f[c], slip[c]);
        }
        for (size_t c = 0; c < d->contacts; c++) {
            fprintf(table, ",%.8g", dot(d->contact_shape + c * d->modes, state, d->modes));
        }
        for (size_t r = d->contacts; r < d->rows; r++) {
            fprintf(table, ",%.8g", -f[r]);
        }
        fprintf(table, "\n");
    }
    close_table(t, table, what, "csv");
    plot_loops(t, d->contacts, m->limit, what);
    free(v);
    free(state);
    free(slip);
}

/* --------------------------------------------------------------------------------------------------------------- field */

static int by_node(const void *a, const void *b)
{
    const struct degree *x = *(const struct degree *const *)a, *y = *(const struct degree *const *)b;
    return x->node != y->node ? (x->node < y->node ? -1 : 1) : (x->row > y->row) - (x->row < y->row);
}

void write_field(const struct tables *t, const struct structure *s, const struct list *phases, struct worker *w,
                 const struct motion *m, const double *y, const char *what)
{
    const size_t n = s->ndof;
    const struct degree **row = need_memory(n, sizeof *row);
    double *state = need_memory(w->dimension, sizeof *state), *full = need_memory(n, sizeof *full);
    size_t nodes = 0;
    for (size_t i = 0; i < n; i++) {
        row[i] = &s->dof[i];
    }
    qsort(row, n, sizeof *row, by_node);
    for (size_t i = 0; i < n; i++) {
        nodes += i == 0 || row[i]->node != row[i - 1]->node;
    }
    FILE *file = create_table(t, what, "vtk");
    fprintf(file, "# vtk DataFile Version 3.0\n%s: %s %.6g, %.8g Hz\nASCII\nDATASET POLYDATA\nPOINTS %zu double\n", program,
            t->limit, m->limit, m->hz, nodes);
    for (size_t i = 0; i < n; i++) {
        if (i == 0 || row[i]->node != row[i - 1]->node) {
            fprintf(file, "%.10g %.10g %.10g\n", row[i]->at[0], row[i]->at[1], row[i]->at[2]);
        }
    }
    fprintf(file, "VERTICES %zu %zu\n", nodes, 2 * nodes);
    for (size_t i = 0; i < nodes; i++) {
        fprintf(file, "1 %zu\n", i);
    }
    fprintf(file, "POINT_DATA %zu\n", nodes);
    for (size_t k = 0; k < phases->count; k++) {
        double now = 0.0, u[3] = {0.0, 0.0, 0.0};
        tribo_driver *drv = driver_at(w, m->limit, m->hz);
        memcpy(state, y, w->dimension * sizeof *state);
        need(tribo_driver_advance(drv, &now, phases->value[k] / 360.0 / m->hz, state), tribo_driver_message(drv));
        need(tribo_system_expand(w->d->reduced, state, full), NULL);
        fprintf(file, "VECTORS displacement_%g double\n", phases->value[k]);
        for (size_t i = 0; i < n; i++) {
            u[row[i]->direction - 1] = full[row[i] - s->dof];
            if (i + 1 == n || row[i]->node != row[i + 1]->node) {
                fprintf(file, "%.8g %.8g %.8g\n", u[0], u[1], u[2]);
                u[0] = u[1] = u[2] = 0.0;
            }
        }
    }
    close_table(t, file, what, "vtk");
    free(row);
    free(state);
    free(full);
}
