#include "variation.h"
#include "elastic.h"

#include <stdlib.h>
#include <string.h>

void tribo_contact_row(const tribo_system *sys, size_t i, const double *v, size_t columns, double *row)
{
    const struct matrix *j = &sys->direction;
    memset(row, 0, columns * sizeof *row);
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        tribo_add(row, j->val[k], v + j->col[k] * columns, columns);
    }
}

static int phase_ends(struct company *company, double tau, double t, const double *y)
{
    struct variation *x = (struct variation *)company;
    tribo_system *sys = x->sys;
    memcpy(x->before, x->events->stick_slip.slip, sys->ncontact);
    if (sys->massless.count) {
        tribo_elastic_perturb(sys, x->before, x->columns, x->v, x->work);
    }
    int status = tribo_stick_slip_acceleration(&x->events->stick_slip, sys, t, y, x->acceleration);
    memset(x->slope, 0, sys->ncontact * sizeof *x->slope);
    tribo_system_loads(sys, DRIVES_BASE, 1, -1.0, x->slope);
    tribo_matrix_multiply_add(&sys->direction, 1.0, x->acceleration, x->slope);
    return status ? status : x->events->transition(x->events->motion, tau, x->columns, x->v);
}

/* 1 if contact i slid, and does not any more, or the other way. One that only touches v = 0 has no derivative there; an elastic
 * one has the same force before and after. */
static int stops(const struct variation *x, size_t i)
{
    const signed char before = x->before[i], now = x->events->stick_slip.slip[i];
    const int slid = (before == 1 || before == -1) && !tribo_massless_touches(&x->sys->massless, i);
    return slid && now != before && now != 2 && before * x->slope[i] < 0.0;
}

/* u += jump of accelerations, dt earlier: v_i' dt = row. */
static void jump_earlier(struct variation *x, size_t i, const double *row)
{
    const size_t n = x->sys->ndof;
    const double *after = x->events->stick_slip.acceleration;
    for (size_t d = 0; d < n; d++) {
        tribo_add(x->v + (n + d) * x->columns, (after[d] - x->acceleration[d]) / x->slope[i], row, x->columns);
    }
}

/* Of several contacts that stop at once, i reverses; the accelerations that others make will be taken from what they hold. */
static void reverse(struct variation *x, size_t i, const double *row)
{
    const struct stick_slip *m = &x->events->stick_slip;
    const size_t n = x->sys->ndof;
    const double jump = m->slip[i] == 0 ? 0.0 : 2.0 * x->before[i] * m->limit[i] / x->slope[i];
    for (size_t d = 0; d < n; d++) {
        tribo_add(x->v + (n + d) * x->columns, jump * tribo_matrix_get(&x->sys->response, d, i), row, x->columns);
    }
}

/* Contacts that stop together do so by what moved them before. */
static void event_decided(struct company *company)
{
    struct variation *x = (struct variation *)company;
    const size_t c = x->sys->ncontact;
    size_t count = 0;
    for (size_t i = 0; i < c; i++) {
        if (stops(x, i)) {
            tribo_contact_row(x->sys, i, x->v + x->sys->ndof * x->columns, x->columns, x->rows + count * x->columns);
            count++;
        }
    }
    for (size_t i = 0, k = 0; i < c; i++) {
        if (stops(x, i)) {
            (count > 1 ? reverse : jump_earlier)(x, i, x->rows + k * x->columns);
            k++;
        }
    }
}

int tribo_variation_create(struct variation *x, struct events *e, tribo_system *sys, size_t columns)
{
    *x = (struct variation){.company = {phase_ends, event_decided}, .events = e, .sys = sys, .columns = columns};
    x->v = malloc(((2 * sys->ndof + sys->ncontact) * columns + 2 * sys->ncontact + 3 * sys->ndof + 1) * sizeof *x->v);
    x->before = malloc(sys->ncontact + 1);
    if (!x->v || !x->before) {
        return 0;
    }
    x->rows = x->v + 2 * sys->ndof * columns;
    x->slope = x->rows + sys->ncontact * columns;
    x->acceleration = x->slope + sys->ncontact;
    x->work = x->acceleration + sys->ndof;
    return 1;
}

void tribo_variation_free(struct variation *x)
{
    free(x->v);
    free(x->before);
    memset(x, 0, sizeof *x);
}
