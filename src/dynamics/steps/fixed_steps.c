/* SPDX-License-Identifier: BSD-3-Clause */
#include "fixed_steps.h"
#include "common/layout.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

int tribo_driver_fixed_steps(tribo_driver *drv, double *t, double t1, double *y, tribo_fixed_step *step, tribo_fixed_run *run)
{
    const double begin = *t, whole = (t1 - begin) / drv->dt, resolution = DBL_EPSILON * greater(fabs(begin), fabs(t1));
    if (drv->dt < 16.0 * resolution) {
        return tribo_error(drv->message, TRIBO_ERR_STEP, "from t = %.17g to %.17g, dt = %g is hardly more than time resolves, %g",
                           begin, t1, drv->dt, resolution);
    }
    /* a rest that is only rounding is spread over the steps */
    const double rest = greater(1e-6, 4.0 * resolution / drv->dt);
    const double steps = fabs(whole - round(whole)) < rest && whole > 0.5 ? round(whole) : greater(ceil(whole), 1.0);
    const double h = whole > steps ? (t1 - begin) / steps : drv->dt;
    /* begins with the last good state, drv->state; states are written there and in y by turns */
    double *from = drv->state, *to = y;
    int status = TRIBO_OK;
    for (double k = 0.0; k < steps && !status;) {
        const size_t count = !run || drv->seen ? 1 : steps - k < RUN ? (size_t)(steps - k) : RUN;
        double time[RUN + 1];
        time[0] = drv->time;
        for (size_t s = 1; s <= count; s++) {
            time[s] = k + (double)s < steps ? begin + (k + (double)s) * h : t1;
        }
        size_t taken = run && !drv->seen ? run(drv, count, time, from) : 0;
        if (taken == 0) {
            status = step(drv, time[0], time[1], from, to);
            if (status) {
                break;
            }
            double *last = from;
            from = to;
            to = last;
            taken = 1;
        }
        k += (double)taken;
        drv->time = time[taken];
        drv->steps += taken;
        status = drv->seen ? tribo_driver_show(drv, drv->time, from, TRIBO_MOMENT_STEP, SIZE_MAX) : TRIBO_OK;
    }
    memcpy(from == y ? drv->state : y, from, tribo_system_size(drv->sys) * sizeof *y);
    *t = drv->time;
    return status;
}

/* ----------------------------------------------------------------------------------------------------------- step form */

int tribo_step_form_bodies(const struct matrix *j, size_t *body, double *lever, signed char *seen)
{
    for (size_t i = 0; i < j->rows; i++) {
        size_t entries = 0;
        for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
            if (j->val[k] != 0.0) {
                body[i] = j->col[k];
                lever[i] = j->val[k];
                entries++;
            }
        }
        if (entries != 1 || seen[body[i]]) {
            return 0;
        }
        seen[body[i]] = 1;
    }
    return 1;
}

int tribo_step_form_create(struct step_form *s, const tribo_system *sys)
{
    const size_t n = sys->ndof, c = sys->ncontact;
    s->memory = ALLOCATE(ARRAY(s->u, n), ARRAY(s->a, n), ARRAY(s->spare, n), ARRAY(s->v, c), ARRAY(s->end, c), ARRAY(s->f, c),
                         ARRAY(s->base, c), ARRAY(s->mode, c));
    return s->memory != NULL;
}

void tribo_step_form_find_base(struct step_form *s, tribo_system *sys, double t)
{
    memset(s->base, 0, sys->ncontact * sizeof *s->base);
    if (tribo_system_bases_move(sys)) {
        tribo_system_set_time(sys, t);
        tribo_system_loads(sys, DRIVES_BASE, 0, 1.0, s->base);
    }
}

void tribo_step_form_relative(const struct step_form *s, const tribo_system *sys, const double *u, double *v)
{
    tribo_matrix_multiply(&sys->direction, u, v);
    for (size_t i = 0; tribo_system_bases_move(sys) && i < sys->ncontact; i++) {
        v[i] -= s->base[i];
    }
}

void tribo_step_form_velocity(struct step_form *s, tribo_system *sys, double t, const double *u, double *v)
{
    tribo_step_form_find_base(s, sys, t);
    tribo_step_form_relative(s, sys, u, v);
}

int tribo_step_form_force(struct step_form *s, const tribo_system *sys, tribo_context *contacts, double h)
{
    return tribo_system_is_plain(sys) ? tribo_step_force(contacts, h, s->end, s->f)
                                      : tribo_step_force_mean(contacts, h, s->v, s->end, s->f);
}

double tribo_step_form_power(const struct step_form *s, const tribo_system *sys)
{
    double sum = 0.0;
    for (size_t i = 0; i < sys->ncontact; i++) {
        sum -= sys->tally[i] * s->f[i] * (s->v[i] + s->end[i]);
    }
    return 0.5 * sum;
}

int tribo_step_form_fail(tribo_driver *drv, int status, double t, const char *message)
{
    return status != TRIBO_ERR_NOT_FINITE
               ? tribo_error(drv->message, status, "at t = %.17g: %s", t, message)
               : tribo_error(drv->message, status,
                             "at t = %.17g forces are too large: the motion grew without bound, or dt = %g is too long", t,
                             drv->dt);
}
