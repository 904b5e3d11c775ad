/* SPDX-License-Identifier: BSD-3-Clause */
#include "step_form.h"

#include "common/layout.h"

#include <string.h>

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

int tribo_step_form_create(struct step_form *s, const tribo_system *sys, size_t more)
{
    const size_t n = sys->ndof, c = sys->ncontact;
    struct layout l = {0};
    do {
        double **const of_contact[] = {&s->v, &s->end, &s->f, &s->base};
        s->memory = s->u = tribo_layout_array(&l, n, sizeof *s->u);
        s->a = tribo_layout_array(&l, n, sizeof *s->a);
        for (size_t k = 0; k < sizeof of_contact / sizeof *of_contact; k++) {
            *of_contact[k] = tribo_layout_array(&l, c, sizeof **of_contact[k]);
        }
        s->more = tribo_layout_array(&l, more, sizeof *s->more);
        s->mode = tribo_layout_array(&l, c, sizeof *s->mode);
    } while (!l.memory && tribo_layout_zeros(&l));
    return l.memory != NULL;
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

void tribo_step_form_turn(struct step_form *s)
{
    double *v = s->v;
    s->v = s->end;
    s->end = v;
}

void tribo_step_form_begin(struct step_form *s, tribo_system *sys, double t, const double *u)
{
    if (s->goes_on) {
        tribo_step_form_turn(s);
    } else {
        tribo_step_form_find_base(s, sys, t);
        tribo_step_form_relative(s, sys, u, s->v);
    }
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
               ? tribo_driver_fail(drv, status, "at t = %.17g: %s", t, message)
               : tribo_driver_fail(
                     drv, status, "at t = %.17g forces are too large: the motion grew without bound, or dt = %g is too long", t,
                     drv->dt);
}
