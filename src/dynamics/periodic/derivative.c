#include "derivative.h"

#include <stdlib.h>
#include <string.h>

struct derivative *tribo_derivative_create(struct events *e, const tribo_system *sys)
{
    struct derivative *d = calloc(1, sizeof *d);
    unsigned char *rests = malloc(sys->ncontact + 1);
    if (!d || !rests) {
        free(d);
        free(rests);
        return NULL;
    }
    *d = (struct derivative){.users = 1, .events = e, .sys = sys, .rests = rests};
    tribo_derivative_clear(d);
    return d;
}

void tribo_derivative_clear(struct derivative *d)
{
    for (size_t k = 0; k < d->steps; k++) {
        if (d->step[k].phase) {
            d->events->motion->release(d->step[k].phase);
        }
    }
    d->steps = d->numbers = 0;
    memset(d->rests, 1, d->sys->ncontact);
    free(d->matrix);
    d->matrix = NULL;
}

void tribo_derivative_free(struct derivative *d)
{
    if (!d || --d->users > 0) {
        return;
    }
    tribo_derivative_clear(d);
    free(d->step);
    free(d->slip);
    free(d->number);
    free(d->rests);
    free(d);
}

/* Makes room for one more step. Returns 0 if out of memory. */
static int reserve_step(struct derivative *d)
{
    if (d->steps < d->room) {
        return 1;
    }
    const size_t room = 2 * d->room + 16;
    struct derivative_step *step = realloc(d->step, room * sizeof *step);
    d->step = step ? step : d->step;
    signed char *slip = step ? realloc(d->slip, room * d->sys->ncontact + 1) : NULL;
    d->slip = slip ? slip : d->slip;
    d->room = slip ? room : d->room;
    return slip != NULL;
}

int tribo_derivative_add_phase(struct derivative *d, double tau, const signed char *slip)
{
    if (!reserve_step(d)) {
        return 0;
    }
    const struct events *e = d->events;
    memcpy(d->slip + d->steps * d->sys->ncontact, slip, d->sys->ncontact);
    for (size_t i = 0; i < d->sys->ncontact; i++) {
        d->rests[i] &= slip[i] == TRIBO_SLIP_STUCK;
    }
    void *phase = e->motion->keep ? e->motion->keep(e->own, tau) : NULL;
    const int kept = phase || !e->motion->keep;
    d->step[d->steps] = (struct derivative_step){.phase = phase, .tau = tau};
    d->steps += (size_t)kept;
    return kept;
}

int tribo_derivative_add_jumps(struct derivative *d, size_t jumps, const double *row, const double *column)
{
    const size_t n = d->sys->ndof, all = tribo_system_energy(d->sys), count = (all + n) * jumps;
    const size_t room = 2 * d->number_room + count;
    if (d->numbers + count > d->number_room) {
        double *more = realloc(d->number, room * sizeof *more);
        if (!more) {
            return 0;
        }
        d->number = more;
        d->number_room = room;
    }
    if (!reserve_step(d)) {
        return 0;
    }
    d->step[d->steps++] = (struct derivative_step){.first = d->numbers, .jumps = jumps};
    memcpy(d->number + d->numbers, row, all * jumps * sizeof *row);
    memcpy(d->number + d->numbers + all * jumps, column, n * jumps * sizeof *column);
    d->numbers += count;
    return 1;
}

int tribo_derivative_apply(const struct derivative *d, size_t first, size_t columns, double *v)
{
    const size_t n = d->sys->ndof, c = d->sys->ncontact, all = tribo_system_energy(d->sys);
    double *work = malloc((2 * c * columns + 1) * sizeof *work);
    int status = work ? TRIBO_OK
                      : tribo_system_fail(d->sys, TRIBO_ERR_MEMORY, "out of memory for %zu perturbation%s", columns, plural(columns));
    for (size_t k = first; !status && k < d->steps; k++) {
        const struct derivative_step *s = d->step + k;
        if (s->jumps) {
            const double *row = d->number + s->first, *column = row + all * s->jumps;
            memset(work, 0, s->jumps * columns * sizeof *work);
            tribo_multiply_add(s->jumps, all, columns, 1.0, row, v, work);
            tribo_multiply_add(n, s->jumps, columns, 1.0, column, work, v + n * columns);
            continue;
        }
        if (d->sys->compliance.count) {
            tribo_compliance_perturb(d->sys, d->slip + k * c, columns, v, work);
        }
        status = d->events->motion->transition(d->events->own, s->phase, s->tau, columns, v);
    }
    free(work);
    return status;
}

int tribo_derivative_rests(const struct derivative *d)
{
    return d->sys->ncontact && memchr(d->rests, 1, d->sys->ncontact) != NULL;
}
