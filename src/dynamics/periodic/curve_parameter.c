/* SPDX-License-Identifier: BSD-3-Clause */
/* The parameter of a curve: the system of the twin for each value, the first motion, and the border of a section. */
#include "curve.h"
#include "common/real.h"

#include <math.h>
#include <string.h>

/* Difference of a parameter for the derivative by it, over the larger of the parameter and its step. */
#define NEARBY 1e-7

/* Largest distance from the range of a parameter within searches, in steps. */
#define OUTSIDE 4.0

double tribo_curve_first(const struct track *c)
{
    return c->ask->parameter == TRIBO_PARAMETER_LIMIT       ? c->limit[c->ask->index]
           : c->ask->parameter == TRIBO_PARAMETER_AMPLITUDE ? c->ask->amplitude
                                                            : 1.0;
}

int tribo_curve_set(struct track *c, double value)
{
    struct period_map *m = &c->s->map;
    const int parameter = c->ask->parameter;
    const double drives = parameter == TRIBO_PARAMETER_LOADS ? value : 1.0;
    const double size[] = {[DRIVES_LOAD] = drives,
                           [DRIVES_BASE] = parameter == TRIBO_PARAMETER_BASES ? value : drives,
                           [DRIVES_LIMIT] = parameter == TRIBO_PARAMETER_LIMITS ? value : 1.0};
    int status = TRIBO_OK;
    if (parameter == TRIBO_PARAMETER_AMPLITUDE) {
        c->mode.amplitude = value;
        return status;
    }
    tribo_loads_scale(m->sys, c->like, size, parameter == TRIBO_PARAMETER_SWING ? value : 1.0,
                      parameter == TRIBO_PARAMETER_FREQUENCY ? value : 1.0);
    if (parameter == TRIBO_PARAMETER_FREQUENCY) {
        m->t = c->t / value;
        m->period = c->period / value;
        tribo_period_map_choose(m, m->odd);
    } else if (parameter == TRIBO_PARAMETER_LIMIT || parameter == TRIBO_PARAMETER_LIMITS) {
        for (size_t i = 0; i < m->sys->ncontact; i++) {
            c->put[i] = parameter == TRIBO_PARAMETER_LIMITS ? value * c->limit[i] : i == c->ask->index ? value : c->limit[i];
        }
        status = tribo_set_limit(tribo_system_context(m->sys), c->put);
        status = status ? tribo_error(m->drv->message, status, "limits of a curve at %g", value)
                        : tribo_driver_pass(m->drv, tribo_system_take_settings(m->sys));
    } else if (parameter == TRIBO_PARAMETER_DAMPING) {
        return tribo_shooting_set_damping(c->s, c->like, value, 0.0);
    }
    return status ? status : m->drv->at_work->open(m->drv, &m->events);
}

/* -------------------------------------------------------------------------------------------------------------- the border */

/* The last unknown is p/unit. */
static int curve_apply(struct shooting *s, const struct point *p)
{
    const struct track *c = s->curve;
    const size_t last = c->count - 1;
    const double value = p->unknown[last] * s->extra.unit[last], slack = OUTSIDE * fabs(c->ask->step);
    const int positive = c->ask->parameter == TRIBO_PARAMETER_FREQUENCY || c->ask->parameter == TRIBO_PARAMETER_AMPLITUDE;
    if (!(value >= c->ask->least - slack && value <= c->ask->most + slack && (positive ? value > 0.0 : value >= 0.0))) {
        return tribo_error(s->map.drv->message, TRIBO_ERR_NO_CONVERGENCE, "the parameter goes to %g", value);
    }
    const int status = tribo_curve_set(s->curve, value);
    return status || !c->base.count ? status : c->base.apply(s, p);
}

/* The derivative by p is a difference, to the side on which the sequence of events is the same. */
static int curve_border(struct shooting *s, struct point *p)
{
    struct track *c = s->curve;
    const size_t n = c->n, count = c->count, last = count - 1;
    const double unit = s->extra.unit[last], value = p->unknown[last] * unit;
    double *column = p->border + last * n, *row = p->border + count * n + last * (n + count);
    struct point *const beside = &s->beside;
    int same = c->ask->parameter == TRIBO_PARAMETER_AMPLITUDE, status = same ? TRIBO_OK : tribo_period_map_matrix(&s->map, p);
    status = status || !c->base.count ? status : c->base.border(s, p);
    memset(column, 0, n * sizeof *column);
    for (int side = value < c->ask->most ? 1 : -1, k = 0; !status && !same && k < 2; k++, side = -side) {
        const double by = side * NEARBY * greater(fabs(value), fabs(c->ask->step));
        status = tribo_curve_set(c, value + by);
        memcpy(beside->x, p->x, n * sizeof *p->x);
        status = status ? status : tribo_period_map_follow(&s->map, beside);
        same = !status && tribo_word_same(&p->derivative, &beside->derivative, c->width);
        for (size_t i = 0; (same || k == 0) && i < n; i++) {
            column[i] = (beside->image[i] - p->image[i]) / by * unit;
        }
        status = status ? status : tribo_curve_set(c, value);
    }
    p->value[last] = -c->ahead;
    for (size_t i = 0; i < n + count; i++) {
        const double z = i < n ? p->x[i] - c->origin[i] : p->unknown[i - n] - c->origin[i] / s->extra.unit[i - n];
        row[i] = c->row[i];
        p->value[last] += c->row[i] * z;
    }
    return status;
}

const struct border tribo_curve_border = {.apply = curve_apply, .border = curve_border};

/* ---------------------------------------------------------------------------------------------------------- the first motion */

int tribo_curve_begin(struct track *c)
{
    struct shooting *s = c->owner;
    int status = TRIBO_OK;
    s->found = 0;
    s->told = s;
    if (c->ask->motion == TRIBO_MOTION_MODE) {
        c->base = tribo_mode_border;
        status = tribo_shooting_find_mode(s, c->w);
        c->s = status ? NULL : s->twin.drv->shooting;
        c->mode.like = s->map.sys;
        c->mode.c = c->w->c;
        c->mode.amplitude = c->w->amplitude;
    } else {
        status = tribo_shooting_create_twin(s, 0);
        if (status) {
            return status;
        }
        c->s = s->twin.drv->shooting;
        c->base = c->ask->motion == TRIBO_MOTION_CYCLE ? tribo_cycle_border : (struct border){.count = 0};
        status = c->ask->motion == TRIBO_MOTION_CYCLE ? tribo_shooting_find_cycle(c->s, c->w) : tribo_shooting_find(c->s, c->w);
        if (status) {
            tribo_error(s->map.drv->message, status, "%s", tribo_driver_message(c->s->map.drv));
        }
    }
    return status;
}
