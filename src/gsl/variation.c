#include "variation.h"

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

/* What contacts did, and how fast the velocities of those that slide change, where a phase of length tau ends. */
static void look_back(struct variation *x, double tau)
{
    struct first_zero *search = &x->events->search;
    memcpy(x->before, x->events->stick_slip.slip, x->sys->ncontact);
    memset(x->slope, 0, x->sys->ncontact * sizeof *x->slope);
    search->go(search->motion, tau);
    for (size_t k = 0; k < search->guards; k++) {
        const struct guard *g = &search->guard[k];
        if (g->slides) {
            x->slope[g->contact] = g->side * search->read(search->motion, g).d;
        }
    }
}

static int phase_ends(struct company *company, double tau)
{
    struct variation *x = (struct variation *)company;
    look_back(x, tau);
    return x->events->transition(x->events->motion, tau, x->columns, x->v);
}

/* Contact i reverses. */
static void reverse(struct variation *x, size_t i)
{
    const struct matrix *b = &x->sys->response;
    const size_t n = x->sys->ndof;
    double *u = x->v + n * x->columns;
    const double jump = 2.0 * x->before[i] * x->events->stick_slip.limit[i] / x->slope[i];
    tribo_contact_row(x->sys, i, u, x->columns, x->row);
    for (size_t d = 0; d < n; d++) {
        tribo_add(u + d * x->columns, jump * tribo_matrix_get(b, d, i), x->row, x->columns);
    }
}

static void event_decided(struct company *company)
{
    struct variation *x = (struct variation *)company;
    const signed char *now = x->events->stick_slip.slip;
    for (size_t i = 0; i < x->sys->ncontact; i++) {
        /* a velocity that touches zero has no derivative there; its slope must be one towards zero */
        if (x->before[i] * now[i] == -1 && x->before[i] * x->slope[i] < 0.0) {
            reverse(x, i);
        }
    }
}

int tribo_variation_create(struct variation *x, struct events *e, const tribo_system *sys, size_t columns)
{
    *x = (struct variation){.company = {phase_ends, event_decided}, .events = e, .sys = sys, .columns = columns};
    x->v = malloc(((2 * sys->ndof + 1) * columns + sys->ncontact + 1) * sizeof *x->v);
    x->before = malloc(sys->ncontact + 1);
    if (!x->v || !x->before) {
        return 0;
    }
    x->row = x->v + 2 * sys->ndof * columns;
    x->slope = x->row + columns;
    return 1;
}

void tribo_variation_free(struct variation *x)
{
    free(x->v);
    free(x->before);
    memset(x, 0, sizeof *x);
}
