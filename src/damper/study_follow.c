/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves over the frequency, followed around their folds. */
#include <math.h>
#include <stdio.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "study.h"
#include "team.h"

/* Kinds of special points. */
static const char *const kinds[] = {
    [TRIBO_POINT_FOLD] = "fold",   [TRIBO_POINT_FLIP] = "flip",   [TRIBO_POINT_TORUS] = "torus", [TRIBO_POINT_BRANCH] = "branch",
    [TRIBO_POINT_STICK] = "stick", [TRIBO_POINT_SLIDE] = "slide", [TRIBO_POINT_GRAZE] = "graze", [TRIBO_POINT_ORDER] = "order"};

/* Data of see_point: the curve so far, and hz, the frequency of its first point, where point->parameter is 1. */
struct trail {
    struct curve *curve;
    struct worker *w;
    double hz;
};

static struct sample *add_sample(struct curve *c, double hz)
{
    c->sample = need_room(c->sample, c->count, sizeof *c->sample);
    struct sample *s = &c->sample[c->count++];
    *s = (struct sample){
        .x = hz, .motion = {.limit = c->fixed, .hz = hz, .stable = -1}, .y = need_memory(c->record, sizeof(double))};
    return s;
}

static int see_point(const tribo_curve_point *point, void *data)
{
    const struct trail *t = data;
    const struct damper *d = t->w->d;
    struct sample *s = add_sample(t->curve, point->parameter * t->hz);
    struct motion *m = &s->motion;
    s->asked = point->kind == TRIBO_POINT_REGULAR;
    m->stable = s->asked ? point->stable : -1;
    memcpy(s->y, point->y, d->dimension * sizeof *s->y);
    set_outcome(m, measure_motion(t->w, m, s->y), t->w);
    const size_t c = point->contact, contacts = d->contacts;
    if (m->found && !s->asked) {
        snprintf(m->message, sizeof m->message, c < d->rows ? "%s of %s %zu" : "%s", kinds[point->kind],
                 c < contacts ? "contact" : "normal", c < contacts ? c + 1 : c - contacts + 1);
    }
    show_point();
    return interrupted();
}

void follow_curve(struct curve *c, struct worker *w)
{
    const struct range *band = &w->d->options->drive;
    const int up = w->d->options->follow > 0;
    const struct trail t = {c, w, up ? band->from : band->to};
    const double step = (band->to - band->from) / ((double)(band->points - 1) * t.hz);
    const tribo_curve curve = {.size = sizeof curve,
                               .parameter = TRIBO_PARAMETER_FREQUENCY,
                               .least = band->from / t.hz,
                               .most = band->to / t.hz,
                               .step = up ? step : -step,
                               .points = SIZE_MAX,
                               .coarse = abs(w->d->options->follow) < 2};
    double period = 1.0 / t.hz, *y = need_memory(w->dimension, sizeof *y);
    set_point(w, c->fixed, t.hz);
    const int status = tribo_driver_follow_curve(w->drv, &curve, 0.0, &period, y, see_point, (void *)&t);
    if (status && !interrupted()) {
        set_outcome(&add_sample(c, 1.0 / period)->motion, status, w);
    }
    for (size_t k = 0; k < c->count && w->d->rows > w->d->contacts; k++) {
        struct sample *s = &c->sample[k];
        if (s->motion.found) {
            set_point(w, c->fixed, s->motion.hz);
            set_outcome(&s->motion, measure_openings(w, s->motion.hz, s->y), w);
        }
    }
    free(y);
}

/* ------------------------------------------------------------------------------------------------------------- the folds */

/* Returns fold i of the curve, counted from 0; NULL: there are less. */
static const struct sample *fold_of(const struct curve *c, size_t i)
{
    for (size_t k = 0; k < c->count; k++) {
        const struct motion *m = &c->sample[k].motion;
        if (m->found && strncmp(m->message, "fold", 4) == 0 && i-- == 0) {
            return &c->sample[k];
        }
    }
    return NULL;
}

void report_folds(const struct study *s, const struct curve *c, size_t count)
{
    struct study finer = *s;
    double *fixed = need_memory(count, sizeof *fixed), change = 0.0;
    const struct sample *fold;
    size_t folds = 0, others = 0;
    for (size_t k = 0; k < count; k++) {
        fixed[k] = c[k].fixed;
        for (size_t i = 0; (fold = fold_of(&c[k], i)); i++, folds++) {
            const struct motion *m = &fold->motion;
            printf("  %12.5g  the curve turns back at %.10g, amplitude %.8g: %s\n", m->limit, m->hz, m->amplitude, m->message);
            write_value(s->tables->values, m->hz, "%s.fold%zu.%zu", s->tables->name, k + 1, i + 1);
        }
    }
    finer.damper = &s->model->finer;
    struct curve *more = folds && !s->model->whole && !interrupted() ? run_curves(&finer, 0, fixed, count) : NULL;
    for (size_t k = 0; more && k < count; k++) {
        for (size_t i = 0; (fold = fold_of(&more[k], i)); i++, others++) {
            const struct sample *here = fold_of(&c[k], i);
            change = here ? fmax(change, relative_difference(fold->x, here->x)) : change;
        }
    }
    if (more && others == folds) {
        printf("with %zu modes frequencies at which curves turn back change by %.1e\n", s->model->finer.kept, change);
    } else if (more && !interrupted()) {
        printf("with %zu modes curves turn back %zu times, not %zu times: take more --modes\n", s->model->finer.kept, others,
               folds);
    }
    if (more) {
        free_curves(more, count);
    }
    free(fixed);
}
