/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks of steady motions: closed forms, twice the modes, marching. */
#include <math.h>
#include <stdlib.h>

#include "output.h"
#include "study.h"
#include "team.h"

static void compare(const struct study *s, const struct motion *m, double known, const char *key, const char *what)
{
    if (!m->found) {
        printf("%s: not found: %s\n", what, m->message);
        return;
    }
    printf("%s: amplitude %.10g, in closed form within the same modes %.10g\n", what, m->amplitude, known);
    write_result(s->tables, key, m->amplitude);
    write_value(s->tables->values, known, "%s.%s.analytic", s->tables->name, key);
}

void check_extremes(const struct study *s, double hz)
{
    const struct damper *d = s->damper;
    if (!s->options->contacts.vary || d->rows > d->contacts) {
        return; /* a contact that lifts off is not linear without friction */
    }
    struct contact *each = need_memory(d->contacts, sizeof *each);
    struct damper all = *d;
    all.contact = each;
    for (size_t c = 0; c < d->contacts; c++) { /* limits of their own are left out: all contacts are open, or all stuck */
        each[c] = d->contact[c];
        each[c].limit = (double)NAN;
        each[c].mu = 1.0;
    }
    struct task task[] = {{&all, s->options->march, 0.0, hz, .guess = NULL},
                          {&all, s->options->march, 1e6 * s->options->size, hz, .guess = NULL}};
    run_tasks(s->options->threads, task, 2);
    const double omega = TURN * hz;
    end_progress();
    if (!interrupted()) {
        printf("load at %.7g Hz\n", hz);
        compare(s, &task[0].motion, scale_of(&d->open, omega).amplitude, "free", "without friction");
        compare(s, &task[1].motion, scale_of(&d->stuck, omega).amplitude, "stuck", "all contacts stuck");
    }
    fflush(stdout);
    free(each);
}

/* --------------------------------------------------------------------------------------------------------- more modes */

enum { EVEN_POINTS = 8 /* of one curve, the largest and the most sensitive among them */ };
enum { CURVE_POINTS = 3 /* of each of several curves, the largest among them */ };
enum { ROUNDS = 4 /* of two more points beside that of the largest change */ };

struct points {
    size_t count;
    struct point *point;
};

/* Adds the sample of a curve, unless it is there or its motion was not found. */
static void add_point(struct points *p, const struct curve *c, size_t sample)
{
    const struct sample *s = &c->sample[sample];
    const struct motion *m = &s->motion;
    int is_there = !m->found;
    for (size_t k = 0; k < p->count; k++) {
        is_there = is_there || (p->point[k].curve == c && p->point[k].sample == sample);
    }
    if (!is_there) {
        const int between = !s->asked && s != largest_of(c, AMPLITUDE);
        p->point[p->count++] = (struct point){.limit = m->limit, .hz = m->hz, .curve = c, .sample = sample, .between = between};
    }
}

/* Adds the middle one of the samples from begin to end - 1 that the user gave. */
static void add_middle(struct points *p, const struct curve *c, size_t begin, size_t end)
{
    size_t asked = 0, passed = 0;
    for (size_t i = begin; i < end; i++) {
        asked += (size_t)c->sample[i].asked;
    }
    for (size_t i = begin; i < end; i++) {
        if (c->sample[i].asked && passed++ == asked / 2) {
            add_point(p, c, i);
        }
    }
}

/* The larger of both changes; 0 of a point between. */
static double change_of(const struct point *p)
{
    return p->between ? 0.0 : fmax(p->amplitude, p->power);
}

/* Adds samples on both sides of the point of the largest change: errors peak where a curve is steep, as where contacts just stick
 * for ever. */
static void add_beside_worst(struct points *p)
{
    const struct point *worst = p->point;
    for (size_t k = 1; k < p->count; k++) {
        worst = change_of(&p->point[k]) > change_of(worst) ? &p->point[k] : worst;
    }
    const struct curve *c = worst->curve;
    const size_t at = worst->sample;
    size_t begin = 0, end = c->count;
    for (size_t k = 0; k < p->count; k++) {
        const size_t sample = p->point[k].curve == c ? p->point[k].sample : at;
        begin = sample < at && sample >= begin ? sample + 1 : begin;
        end = sample > at && sample < end ? sample : end;
    }
    add_middle(p, c, begin, at);
    add_middle(p, c, at + 1, end);
}

/* Points spread over each curve, the largest and, on a single curve, the most sensitive among them. */
double show_model_error(const struct study *s, const struct curve *c, size_t curves)
{
    const size_t most = curves > 1 ? CURVE_POINTS : EVEN_POINTS, others = curves > 1 ? 1 : 2;
    struct points p = {0, need_memory(curves * most + 2 * ROUNDS, sizeof *p.point)};
    for (size_t k = 0; k < curves; k++) {
        const struct sample *chosen[EVEN_POINTS];
        size_t count = spread_samples(&c[k], most - others, chosen);
        chosen[count++] = largest_of(&c[k], AMPLITUDE);
        chosen[count++] = others > 1 ? largest_of(&c[k], SENSITIVITY) : NULL;
        for (size_t i = 0; i < count; i++) {
            if (chosen[i]) {
                add_point(&p, &c[k], (size_t)(chosen[i] - c[k].sample));
            }
        }
    }
    size_t compared = 0;
    for (int round = 0; round <= ROUNDS && compared < p.count && !interrupted(); round++) {
        compare_models(s->model, s->options->threads, p.point + compared, p.count - compared);
        compared = p.count;
        if (round < ROUNDS && !s->model->whole) {
            add_beside_worst(&p);
        }
    }
    end_progress();
    const double error = interrupted() ? (double)NAN : report_error(s->tables, s->model, p.point, compared);
    fflush(stdout);
    free(p.point);
    return error;
}

/* ------------------------------------------------------------------------------------------------------------- marching */

/* task: by marching, of the samples. */
static void report(const struct study *s, const struct sample *const *sample, const struct task *task, size_t count)
{
    FILE *table = create_table(s->tables, "check", "csv");
    double amplitude = 0.0, power = 0.0, most = 0.0, unbalanced = 0.0;
    write_motion_head(s->tables, table, NULL);
    printf("by marching in time (%s, %s)\n  %12s    frequency    amplitude   difference  periods\n",
           s->options->law == TRIBO_COULOMB ? "midpoint rule" : "rk4", tribo_law_name(s->options->law), s->tables->limit);
    for (size_t k = 0; k < count; k++) {
        const struct motion *here = &task[k].motion, *known = &sample[k]->motion;
        write_motion(table, here, NULL, NULL);
        if (!here->found) {
            printf("  %12.5g %12.5g  %s\n", here->limit, here->hz, here->message);
            continue;
        }
        const double off = relative_difference(here->amplitude, known->amplitude);
        printf("  %12.5g %12.5g %12.5g %12.1e %8zu\n", here->limit, here->hz, here->amplitude, off, here->periods);
        amplitude = fmax(amplitude, off);
        power = fmax(power, fabs(here->friction - known->friction));
        most = fmax(most, known->friction);
        unbalanced = fmax(unbalanced, relative_difference(here->input, here->friction + here->damped));
    }
    write_result(s->tables, "check.amplitude", amplitude);
    write_result(s->tables, "check.power", power > 0.0 ? power / (most > 0.0 ? most : power) : 0.0);
    write_result(s->tables, "check.balance", unbalanced);
    close_table(s->tables, table, "check", "csv");
}

void check_by_marching(const struct study *s, const struct curve *c)
{
    const size_t most = s->options->check;
    if (most == 0) {
        return;
    }
    if (s->options->march) {
        printf("--check was not done: all points are by marching already\n");
        return;
    }
    const struct sample **sample = need_memory(most, sizeof *sample);
    struct task *task = need_memory(most, sizeof *task);
    const size_t count = spread_samples(c, most, sample);
    for (size_t k = 0; k < count; k++) {
        task[k] = (struct task){s->damper, 1, .limit = sample[k]->motion.limit, .hz = sample[k]->motion.hz};
    }
    run_tasks(s->options->threads, task, count);
    end_progress();
    if (count == 0 || interrupted()) {
        printf("--check was not done: %s\n", interrupted() ? "interrupted" : "no motion was found");
    } else {
        report(s, sample, task, count);
    }
    free(sample);
    free(task);
}
