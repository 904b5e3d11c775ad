#include "variation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Relative difference of equal times, and of a force at its limit; relative size of a negligible coupling. */
#define TOGETHER 1e-6

void tribo_contact_row(const tribo_system *sys, size_t i, const double *v, size_t columns, double *row)
{
    const struct matrix *j = &sys->direction;
    memset(row, 0, columns * sizeof *row);
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        tribo_add(row, j->val[k], v + j->col[k] * columns, columns);
    }
}

/* Sets x->f: R_HH f_H = -a_H, a = J acceleration - (order-th derivative of b; 0 if order = 0). Returns a status. */
static int change_of_holds(struct variation *x, const double *acceleration, int order)
{
    memset(x->a, 0, x->sys->ncontact * sizeof *x->a);
    if (order) {
        tribo_system_loads(x->sys, DRIVES_BASE, order, -1.0, x->a);
    }
    tribo_matrix_multiply_add(&x->sys->direction, 1.0, acceleration, x->a);
    const int status = tribo_stick_slip_balance(&x->events->stick_slip, x->a, x->f);
    return status ? tribo_system_fail(x->sys, status, "%s", tribo_message(x->events->stick_slip.constant.hold)) : TRIBO_OK;
}

/* to [ndof] += -AK q - AC u: the change of q'' by a change (q, u) of the state. */
static void add_change(const tribo_system *sys, const double *q, const double *u, double *to)
{
    tribo_matrix_multiply_add(&sys->stiffness, -1.0, q, to);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, u, to);
    }
}

/* Sets x->rise at the state y; forces of contacts outside H follow their limits. Returns a status. */
static int find_rise(struct variation *x, const double *y)
{
    tribo_system *sys = x->sys;
    const struct stick_slip *m = &x->events->stick_slip;
    double *rate = x->column;
    tribo_system_limits(sys, x->a, x->f);
    for (size_t i = 0; i < sys->ncontact; i++) {
        x->rise[i] = -x->f[i] * tribo_breakaway_ratio(&m->breakaway, i);
        x->f[i] *= tribo_stick_slip_follows(m, i);
    }
    memset(rate, 0, sys->ndof * sizeof *rate);
    tribo_system_loads(sys, DRIVES_LOAD, 1, 1.0, rate);
    add_change(sys, y + sys->ndof, x->acceleration, rate);
    tribo_matrix_multiply_add(&sys->response, 1.0, x->f, rate);
    const int status = change_of_holds(x, rate, 2);
    for (size_t i = 0; i < sys->ncontact; i++) {
        x->rise[i] += x->side[i] * x->f[i];
    }
    return status;
}

/* Sets x->pull. Returns a status. */
static int find_pull(struct variation *x)
{
    const size_t n = x->sys->ndof, all = tribo_system_energy(x->sys);
    double *state = x->column, *change = state + 2 * n;
    int status = TRIBO_OK;
    memset(state, 0, 2 * n * sizeof *state);
    for (size_t j = 0; !status && j < 2 * n; j++) {
        state[j] = 1.0;
        memset(change, 0, n * sizeof *change);
        add_change(x->sys, state, state + n, change);
        state[j] = 0.0;
        status = change_of_holds(x, change, 0);
        for (size_t k = 0; k < x->count; k++) {
            x->pull[k * all + j] = x->side[x->met[k]] * x->f[x->met[k]];
        }
    }
    return status;
}

/* Returns 1 if the phase ended because a holding force met a static limit that drops at once. */
static int variation_breaks_away(const struct variation *x)
{
    const struct guard *g = x->events->met;
    const struct stick_slip *m = &x->events->stick_slip;
    return g && g->kind == HOLDS && !m->breakaway.falls && m->state.holds[g->contact] &&
           tribo_breakaway_is_sudden(&m->breakaway, g->contact);
}

/* Sets x->met, x->count and x->side from m->work.f, the forces at the end of the phase. */
static void find_met(struct variation *x)
{
    const struct stick_slip *m = &x->events->stick_slip;
    x->count = 0;
    memset(x->side, 0, x->sys->ncontact);
    if (!variation_breaks_away(x)) {
        return;
    }
    tribo_system_limits(x->sys, x->a, x->f);
    for (size_t i = 0; i < x->sys->ncontact; i++) {
        const double met = (1.0 - TOGETHER) * tribo_breakaway_ratio(&m->breakaway, i) * x->a[i];
        const int may = m->state.holds[i] && tribo_breakaway_is_sudden(&m->breakaway, i);
        if (may && (i == x->events->met->contact || fabs(m->work.f[i]) >= met)) {
            x->side[i] = (signed char)(m->work.f[i] > 0.0 ? 1 : -1);
            x->met[x->count++] = i;
        }
    }
}

/* Sets x->f = the change of f' of holding contacts if contact i is released, by damping and the jump of q''. */
static int change_of_rates(struct variation *x, size_t i)
{
    const struct breakaway *b = &x->events->stick_slip.breakaway;
    const tribo_system *sys = x->sys;
    double *jump = x->column, *rate = jump + sys->ndof;
    memset(jump, 0, 2 * sys->ndof * sizeof *jump);
    memset(x->f, 0, sys->ncontact * sizeof *x->f);
    x->f[i] = tribo_breakaway_most(b, i) - b->kinetic[i];
    tribo_matrix_multiply_add(&sys->response, 1.0, x->f, jump);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, jump, rate);
    }
    return change_of_holds(x, rate, 0);
}

/* Sets x->bond = a contact in met, but not met[0], if the release of one contact in met changes the force of another or its rate;
 * else ncontact. Returns a status. */
static int find_bond(struct variation *x)
{
    int status = TRIBO_OK;
    x->bond = x->sys->ncontact;
    for (size_t k = 0; !status && x->count > 1 && k < x->count; k++) {
        const size_t i = x->met[k];
        memset(x->a, 0, x->sys->ncontact * sizeof *x->a);
        x->a[i] = 1.0;
        status = tribo_stick_slip_balance(&x->events->stick_slip, x->a, x->f);
        for (size_t l = 0; l < k; l++) {
            x->bond = fabs(x->f[x->met[l]]) > TOGETHER * fabs(x->f[i]) ? i : x->bond;
        }
        status = status ? status : change_of_rates(x, i);
        for (size_t l = 0; l < x->count; l++) {
            x->bond = l != k && fabs(x->f[x->met[l]]) > TOGETHER * x->rise[x->met[l]] ? x->met[k ? k : l] : x->bond;
        }
    }
    return status ? tribo_system_fail(x->sys, status, "%s", tribo_message(x->events->stick_slip.constant.hold)) : TRIBO_OK;
}

/* Sets x->rise, x->pull and x->bond, and removes contacts with rise <= 0 from x->met. Returns a status. */
static int look_at_met(struct variation *x, const double *y)
{
    int status = find_rise(x, y);
    /* keep contacts with rise > 0; the other forces only touch their limits */
    size_t count = 0;
    for (size_t k = 0; k < x->count; k++) {
        const size_t i = x->met[k];
        if (x->rise[i] > 0.0) {
            x->met[count++] = i;
        } else {
            x->side[i] = 0;
        }
    }
    x->count = count;
    status = status ? status : find_pull(x);
    return status ? status : find_bond(x);
}

static int no_derivative(const struct variation *x)
{
    return tribo_system_fail(x->sys, TRIBO_ERR_MEMORY, "out of memory for the derivative of a motion");
}

/* Applies the steps of x->to from x->applied on to x->v. Returns a status. */
static int catch_up(struct variation *x)
{
    const size_t first = x->applied;
    x->applied = x->to->steps;
    return tribo_derivative_apply(x->to, first, x->columns, x->v);
}

static int phase_ends(struct company *company, double tau, double t, const double *y)
{
    struct variation *x = (struct variation *)company;
    tribo_system *sys = x->sys;
    memcpy(x->before, x->events->stick_slip.state.slip, sys->ncontact);
    int status = tribo_stick_slip_acceleration(&x->events->stick_slip, sys, t, y, x->acceleration, x->force);
    status = status ? status : x->status;
    find_met(x);
    memset(x->slope, 0, sys->ncontact * sizeof *x->slope);
    tribo_system_loads(sys, DRIVES_BASE, 1, -1.0, x->slope);
    tribo_matrix_multiply_add(&sys->direction, 1.0, x->acceleration, x->slope);
    if (!status && !tribo_derivative_add_phase(x->to, tau, x->before)) {
        status = no_derivative(x);
    }
    status = status || x->events->motion->keep ? status : catch_up(x);
    return status || !x->count ? status : look_at_met(x, y);
}

/* Returns 1 if v_i = 0 ended the phase and a contact at rest begins to slide: the force of contact i makes it slide. Then q''
 * jumps at the stop of contact i, which lasts an instant only. */
static int pulls_loose(const struct variation *x, size_t i)
{
    const struct guard *met = x->events->met;
    const signed char *now = x->events->stick_slip.state.slip;
    int loose = 0;
    for (size_t k = 0; k < x->sys->ncontact; k++) {
        loose |= x->before[k] == 0 && tribo_slides(now[k]);
    }
    return loose && met && met->kind == SLIDES && met->contact == i;
}

/* Returns 1 if contact i slid and stops or reverses. Returns 0 if v_i only touches 0, where there is no derivative, and for an
 * elastic contact, because its force is continuous. */
static int stops(const struct variation *x, size_t i)
{
    const signed char before = x->before[i], now = x->events->stick_slip.state.slip[i];
    const int slid = tribo_slides(before) && !x->events->stick_slip.constant.elastic[i];
    return slid && now != 2 && before * x->slope[i] < 0.0 && (now != before || pulls_loose(x, i));
}

/* Appends a jump of q'' that comes earlier by dt = row v/slope. Returns the place of the jump: ndof entries, ncontact doubles
 * apart. */
static double *add_earlier(struct variation *x, double slope, const double *row)
{
    const size_t n = tribo_system_energy(x->sys);
    double *to = x->row + x->jumps * n;
    for (size_t j = 0; j < n; j++) {
        to[j] = row[j] / slope;
    }
    return x->jump + x->jumps++;
}

/* Appends the whole jump q''+ - q''-, earlier by row v/slope. */
static void jump_earlier(struct variation *x, double slope, const double *row)
{
    const double *after = tribo_stick_slip_find_acceleration(&x->events->stick_slip, x->sys);
    double *jump = add_earlier(x, slope, row);
    for (size_t d = 0; d < x->sys->ndof; d++) {
        jump[d * x->sys->ncontact] = after[d] - x->acceleration[d];
    }
}

/* Sets x->stopped = the contacts that stop, and x->rows = (0, J_i) of these contacts. Returns their number. */
static size_t find_stopped(struct variation *x)
{
    const struct matrix *j = &x->sys->direction;
    size_t count = 0;
    for (size_t i = 0; i < x->sys->ncontact; i++) {
        if (stops(x, i)) {
            double *row = x->rows + count * tribo_system_energy(x->sys);
            memset(row, 0, tribo_system_energy(x->sys) * sizeof *row);
            for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
                row[x->sys->ndof + j->col[k]] += j->val[k];
            }
            x->stopped[count++] = i;
        }
    }
    return count;
}

/* Returns 1 if the `count` contacts stop, or break away, at one time in perturbed motions too, tied together by holding contacts:
 * dt = rows[k] v/slope[contact[k]] is the same for all k. slope [ncontact], rows [count][n]. */
static int together(struct variation *x, const size_t *contact, size_t count, const double *slope, const double *rows)
{
    if (count == 1) {
        return 1;
    }
    x->status = x->status ? x->status : catch_up(x);
    memset(x->changes, 0, count * x->columns * sizeof *x->changes);
    tribo_multiply_add(count, tribo_system_energy(x->sys), x->columns, 1.0, rows, x->v, x->changes);
    const double first = slope[contact[0]], size = tribo_largest(x->changes, x->columns) / fabs(first);
    for (size_t k = 1; k < count; k++) {
        for (size_t j = 0; j < x->columns; j++) {
            const double dt = x->changes[k * x->columns + j] / slope[contact[k]] - x->changes[j] / first;
            if (fabs(dt) > TOGETHER * size) {
                return 0;
            }
        }
    }
    return 1;
}

/* Returns 1 if the force of contact i may jump when others stop: i stops, or rests before or after, and is not elastic. */
static int takes_part(const struct variation *x, size_t i)
{
    const int rests = x->before[i] == 0 || x->events->stick_slip.state.slip[i] == TRIBO_SLIP_STUCK;
    return !x->events->stick_slip.constant.elastic[i] && (rests || stops(x, i));
}

/* Sets x->group = group for contact i and all contacts that its forces reach by shared bodies and contacts that take part. */
static void gather(struct variation *x, size_t i, size_t group)
{
    size_t count = 0;
    x->queue[count++] = i;
    x->group[i] = group;
    for (size_t k = 0; k < count; k++) {
        const size_t one = x->queue[k];
        for (size_t j = 0; j < x->sys->ncontact; j++) {
            const double coupling = x->group[j] ? 0.0 : fabs(tribo_system_delassus(x->sys, one, j));
            if (coupling > TOGETHER * tribo_system_delassus(x->sys, one, one) && takes_part(x, j)) {
                x->group[j] = group;
                x->queue[count++] = j;
            }
        }
    }
}

/* Moves the contacts of the group in stopped[first .. count - 1], and their rows, to index `first` on. Returns their number. */
static size_t bring_forward(struct variation *x, size_t first, size_t count, size_t group)
{
    size_t next = first;
    for (size_t k = first; k < count; k++) {
        if (x->group[x->stopped[k]] == group) {
            const size_t i = next++;
            const size_t contact = x->stopped[i], n = tribo_system_energy(x->sys);
            x->stopped[i] = x->stopped[k];
            x->stopped[k] = contact;
            for (size_t j = 0; i != k && j < n; j++) {
                const double change = x->rows[i * n + j];
                x->rows[i * n + j] = x->rows[k * n + j];
                x->rows[k * n + j] = change;
            }
        }
    }
    return next - first;
}

/* Appends one jump for each group of contacts that stop by coincidence: no forces pass between groups. */
static void stop_by_groups(struct variation *x, size_t count)
{
    for (size_t next = 0, of_group; next < count; next += of_group) {
        const size_t *stopped = x->stopped + next, group = x->group[stopped[0]];
        const double *rows = x->rows + next * tribo_system_energy(x->sys);
        of_group = bring_forward(x, next, count, group);
        if (together(x, stopped, of_group, x->slope, rows)) {
            /* jump of q'' by the change of the forces of the group */
            const double slope = x->slope[stopped[0]];
            const size_t n = x->sys->ndof;
            double *jump = add_earlier(x, slope, rows), *change = x->column;
            for (size_t i = 0; i < x->sys->ncontact; i++) {
                x->f[i] = x->group[i] == group ? x->events->stick_slip.state.force[i] - x->force[i] : 0.0;
            }
            memset(change, 0, n * sizeof *change);
            tribo_matrix_multiply_add(&x->sys->response, 1.0, x->f, change);
            for (size_t d = 0; d < n; d++) {
                jump[d * x->sys->ncontact] = change[d];
            }
        } else {
            /* if a contact of the group slides afterwards, the order of stops matters: there is no derivative */
            for (size_t i = 0; i < x->sys->ncontact; i++) {
                if (x->group[i] == group && x->events->stick_slip.state.slip[i] != TRIBO_SLIP_STUCK) {
                    x->torn = i;
                    x->other = stopped[i == stopped[0]];
                }
            }
        }
    }
}

static void stop_earlier(struct variation *x)
{
    const size_t count = find_stopped(x);
    if (!count) {
        return;
    }
    /* group: contacts that stop, and all contacts that their forces reach */
    memset(x->group, 0, x->sys->ncontact * sizeof *x->group);
    for (size_t k = 0; k < count; k++) {
        if (!x->group[x->stopped[k]]) {
            gather(x, x->stopped[k], k + 1);
        }
    }
    /* contact i loses its static limit by its own rise, or outside all groups: the order of this jump and the stop matters */
    const struct stick_slip *m = &x->events->stick_slip;
    for (size_t i = 0; i < x->sys->ncontact; i++) {
        const int goes = x->before[i] == 0 && tribo_slides(m->state.slip[i]);
        if (goes && (x->side[i] || !x->group[i]) && tribo_breakaway_is_sudden(&m->breakaway, i)) {
            x->torn = i;
            x->other = x->stopped[0];
        }
    }
    if (together(x, x->stopped, count, x->slope, x->rows)) {
        jump_earlier(x, x->slope[x->stopped[0]], x->rows);
    } else {
        stop_by_groups(x, count);
    }
}

/* Returns a contact that couples contacts in met: bond, or one outside met that begins to slide; ncontact: none. */
static size_t find_bound(const struct variation *x)
{
    size_t bound = x->bond;
    for (size_t i = 0; i < x->sys->ncontact; i++) {
        const signed char now = x->events->stick_slip.state.slip[i];
        bound = x->before[i] == 0 && tribo_slides(now) && !x->side[i] ? i : bound;
    }
    return bound;
}

static void event_decided(struct company *company)
{
    struct variation *x = (struct variation *)company;
    const size_t n = x->sys->ndof, c = x->sys->ncontact;
    x->jumps = 0;
    stop_earlier(x);
    /* gone: contacts in met that are released; one jump if perturbed motions release them at one time, else one jump for each */
    const signed char *now = x->events->stick_slip.state.slip;
    size_t gone = 0;
    for (size_t k = 0; k < x->count; k++) {
        gone += now[x->met[k]] != 0;
    }
    if (gone && together(x, x->met, x->count, x->rise, x->pull)) {
        jump_earlier(x, x->rise[x->met[0]], x->pull);
    } else if (gone) {
        const size_t bound = find_bound(x);
        for (size_t k = 0; k < x->count; k++) {
            if (now[x->met[k]] != 0) {
                /* jump by the drop of f_i; the projection at the start of the next phase adds the change of holding forces */
                const size_t i = x->met[k];
                const double *row = x->pull + k * tribo_system_energy(x->sys);
                const struct stick_slip *m = &x->events->stick_slip;
                const double drop =
                    -(m->state.slip[i] + x->side[i] * tribo_breakaway_ratio(&m->breakaway, i)) * m->state.limit[i];
                double *jump = add_earlier(x, x->rise[i], row);
                for (size_t d = 0; d < x->sys->ndof; d++) {
                    jump[d * x->sys->ncontact] = drop * tribo_matrix_get(&x->sys->response, d, i);
                }
            }
        }
        if (bound < x->sys->ncontact) {
            x->torn = x->met[0];
            x->other = bound;
        }
    }
    for (size_t d = 0; d < n; d++) {
        memmove(x->jump + d * x->jumps, x->jump + d * c, x->jumps * sizeof *x->jump);
    }
    if (x->jumps && !tribo_derivative_add_jumps(x->to, x->jumps, x->row, x->jump)) {
        x->status = no_derivative(x);
    } else if (!x->events->motion->keep && !x->status) {
        x->status = catch_up(x);
    }
}

void tribo_variation_begin(struct variation *x, const double *v, struct derivative *to)
{
    memcpy(x->v, v, tribo_system_energy(x->sys) * x->columns * sizeof *v);
    x->to = to;
    x->applied = 0;
    x->status = TRIBO_OK;
    x->torn = x->other = x->sys->ncontact;
}

int tribo_variation_create(struct variation *x, struct events *e, tribo_system *sys, size_t columns)
{
    const size_t n = sys->ndof, c = sys->ncontact, all = tribo_system_energy(sys);
    *x = (struct variation){.company = {phase_ends, event_decided}, .events = e, .sys = sys, .columns = columns};
    x->v = malloc((all * columns + c * (columns + 3 * all + n) + 5 * c + 4 * n + 1) * sizeof *x->v);
    x->before = malloc(2 * c + 1);
    x->stopped = malloc((4 * c + 1) * sizeof *x->stopped);
    if (!x->v || !x->before || !x->stopped) {
        return 0;
    }
    double **const array[] = {&x->rows, &x->pull, &x->row,  &x->jump,  &x->changes,      &x->slope,
                              &x->a,    &x->f,    &x->rise, &x->force, &x->acceleration, &x->column};
    const size_t count[] = {all * c, all * c, all * c, n * c, c * columns, c, c, c, c, c, n, 3 * n};
    double *next = x->v + all * columns;
    for (size_t k = 0; k < sizeof array / sizeof *array; k++) {
        *array[k] = next;
        next += count[k];
    }
    x->side = x->before + c;
    x->met = x->stopped + c;
    x->group = x->met + c;
    x->queue = x->group + c;
    return 1;
}

void tribo_variation_free(struct variation *x)
{
    free(x->v);
    free(x->before);
    free(x->stopped);
    memset(x, 0, sizeof *x);
}
