/* SPDX-License-Identifier: BSD-3-Clause */
#include "step_form.h"

#include <stdint.h>
#include <stdlib.h>
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
    s->settings = SIZE_MAX;
    s->memory = s->u = calloc(2 * n + 4 * c + more + 1, sizeof *s->u);
    s->mode = malloc(2 * c + 1);
    if (!s->u || !s->mode) {
        return 0;
    }
    s->a = s->u + n;
    s->v = s->a + n;
    s->end = s->v + c;
    s->f = s->end + c;
    s->base = s->f + c;
    s->more = s->base + c;
    return 1;
}

void tribo_step_form_free(struct step_form *s)
{
    free(s->memory);
    free(s->mode);
}

int tribo_step_form_is_plain(struct step_form *s, const tribo_system *sys)
{
    if (s->settings != tribo_system_revision(sys)) {
        s->settings = tribo_system_revision(sys);
        s->plain = tribo_system_is_plain(sys);
    }
    return s->plain;
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
    return tribo_step_form_is_plain(s, sys) ? tribo_step_force(contacts, h, s->end, s->f)
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

int tribo_step_form_grew(tribo_driver *drv, double t)
{
    return tribo_driver_fail(drv, TRIBO_ERR_NOT_FINITE,
                             "at t = %.17g forces are too large: the motion grew without bound, or dt = %g is too long", t,
                             drv->dt);
}
