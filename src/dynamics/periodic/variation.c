/* SPDX-License-Identifier: BSD-3-Clause */
#include "variation.h"
#include "common/layout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Relative difference of equal times, and of a force at its limit; relative size of a negligible coupling. */
#define TOGETHER 1e-6

/* Crossings within this part of 1/(highest frequency) may follow each other in any order: a periodic motion is exact to 1e-10. */
#define AT_ONCE 1e-9

/* ---------------------------------------------------------------------------------------------------------------- steps */

void tribo_derivative_free(struct derivative *d)
{
    for (size_t k = 0; k < d->steps; k++) {
        if (d->step[k].phase) {
            d->events->motion->release(d->step[k].phase);
        }
        free(d->step[k].slip);
        free(d->step[k].jump);
    }
    free(d->matrix);
    free(d->step);
    memset(d, 0, sizeof *d);
}

static int no_room(const struct derivative *d)
{
    return tribo_error(d->sys->message, TRIBO_ERR_MEMORY, "out of memory for the derivative of a motion");
}

/* Appends an empty step. Returns NULL if out of memory. */
static struct derivative_step *add_step(struct derivative *d)
{
    if (d->steps == d->room) {
        const size_t room = 2 * d->room + 16;
        struct derivative_step *step = realloc(d->step, room * sizeof *step);
        if (!step) {
            return NULL;
        }
        d->step = step;
        d->room = room;
    }
    memset(d->step + d->steps, 0, sizeof *d->step);
    return d->step + d->steps++;
}

/* Appends a jump; a change of the limit of contact moves the time of its crossing by lift times the change. Returns a status. */
static int add_jump(struct derivative *d, const double *row, size_t contact, double lift, const double *column)
{
    const size_t n = tribo_system_energy(d->sys), moved = n - d->sys->ndof;
    struct derivative_step *s = add_step(d);
    double *jump = s ? malloc((n + moved) * sizeof *jump) : NULL;
    if (jump) {
        s->jump = jump;
        s->contact = contact;
        s->lift = lift;
        memcpy(jump, row, n * sizeof *row);
        memcpy(jump + n, column, moved * sizeof *column);
    }
    return jump ? TRIBO_OK : no_room(d);
}

int tribo_derivative_apply(const struct derivative *d, size_t first, size_t columns, double *v, const struct parameters *p)
{
    const size_t n = d->sys->ndof, all = tribo_system_energy(d->sys), each = d->sys->ncontact * columns;
    double *work = malloc((3 * each + columns) * sizeof *work), *force = work + 2 * each + columns;
    const double *const moves = p ? p->moves : NULL;
    const struct source source = {.force = force, .inertia = moves, .damping = moves ? moves + columns : NULL};
    int status =
        work ? TRIBO_OK
             : tribo_error(d->sys->message, TRIBO_ERR_MEMORY, "out of memory for %zu perturbation%s", columns, plural(columns));
    for (size_t k = first; !status && k < d->steps; k++) {
        const struct derivative_step *const s = d->step + k;
        if (s->jump) {
            memset(work, 0, columns * sizeof *work);
            tribo_multiply_add(1, all, columns, 1.0, s->jump, v, work);
            tribo_add(work, s->lift, p ? p->rise + s->contact * columns : v, p ? columns : 0);
            tribo_multiply_add(all - n, 1, columns, 1.0, s->jump + all, work, v + n * columns);
            continue;
        }
        if (d->sys->compliance.count) {
            tribo_compliance_perturb(d->sys, s->slip, p ? p->rise : NULL, columns, v, work);
        }
        for (size_t i = 0; p && i < each; i++) {
            const size_t contact = i / columns;
            const int pushes = tribo_slides(s->slip[contact]) && !tribo_force_is_state(&d->events->stick_slip, contact);
            force[i] = pushes ? -s->slip[contact] * p->rise[i] : 0.0;
        }
        status = d->events->motion->transition(d->events->own, s->phase, s->tau, columns, v, p ? &source : NULL);
    }
    free(work);
    return status;
}

int tribo_derivative_rests(const struct derivative *d)
{
    for (size_t i = 0; i < d->sys->ncontact; i++) {
        size_t k = 0;
        while (k < d->steps && (d->step[k].jump || d->step[k].slip[i] == TRIBO_SLIP_STUCK)) {
            k++;
        }
        if (k == d->steps) {
            return 1;
        }
    }
    return 0;
}

double tribo_derivative_middle(const struct derivative *d)
{
    double elapsed = 0.0, longest = 0.0, middle = 0.0;
    for (size_t k = 0; k < d->steps; k++) {
        middle = d->step[k].tau > longest ? elapsed + 0.5 * d->step[k].tau : middle;
        longest = d->step[k].tau > longest ? d->step[k].tau : longest;
        elapsed += d->step[k].tau;
    }
    return middle;
}

/* Applies the steps of x->to from x->applied on to x->v. Returns a status. */
static int catch_up(struct variation *x)
{
    const size_t first = x->applied;
    x->applied = x->to->steps;
    return tribo_derivative_apply(x->to, first, x->columns, x->v, x->by);
}

/* Returns 1 if steps may wait for catch_up. */
static int may_wait(const struct variation *x)
{
    return x->to->events->motion->keep && !x->by;
}

/* -------------------------------------------------------------------------------------------------------- static limits */

/* to [cols] += factor A'x. */
static void add_transposed(const struct matrix *a, double factor, const double *x, double *to)
{
    for (size_t i = 0; i < a->rows; i++) {
        tribo_matrix_add_row(a, i, factor * x[i], to);
    }
}

/* Lists the crossings of static limits that drop at once, at tau into the phase, which ends at y: by the guard that ended the
 * phase, and of other contacts at the same time. Forces that do not rise only touch their limits. Sets row = dg/dstate over the
 * rate of the guard g: by forces f_i = e'J (-AK q - AC q' + B f), e = -R_HH^-1 unit_i, with f of normals and of sliding
 * contacts. */
static int find_drops(struct variation *x, double tau, const double *y)
{
    struct events *e = x->to->events;
    struct stick_slip *m = &e->stick_slip;
    const size_t n = tribo_system_energy(x->sys);
    int status = TRIBO_OK;
    for (size_t k = 0; m->limits.differ && !m->limits.falls && !status && k < e->search.guards; k++) {
        struct guard *g = &e->search.guard[k];
        const size_t i = g->contact;
        if (g->kind != HOLDS || !g->output || !m->state.holds[i] || !tribo_drops(m, i)) {
            continue;
        }
        e->motion->look(e->own, tau, 1, &g);
        if (!(g->middle.d < 0.0) || (g != e->met && !(g->middle.g <= TOGETHER * m->state.stick[i]))) {
            continue;
        }
        double *row = x->row + x->count * n;
        memset(row, 0, n * sizeof *row);
        memset(x->change, 0, x->sys->ndof * sizeof *x->change);
        memset(x->a, 0, x->sys->ncontact * sizeof *x->a);
        x->a[i] = g->side;
        double by_limit = m->limits.ratio[i];
        tribo_stick_slip_hold_by_forces(m, i, x->force, x->a, &by_limit);
        status = tribo_stick_slip_balance(m, x->a, x->f);
        add_transposed(&x->sys->direction, 1.0, x->f, x->change);
        memset(x->a, 0, x->sys->ncontact * sizeof *x->a); /* from here on: x->change times what forces do to q'' */
        add_transposed(&x->sys->response, 1.0, x->change, x->a);
        add_transposed(&x->sys->stiffness, -1.0, x->change, row);
        for (size_t j = 0; j < x->sys->normals.count; j++) {
            const struct normal *normal = &x->sys->normals.normal[j];
            double force = 0.0; /* by x->change, and by the limit that follows */
            for (size_t c = 0; m->state.pressed[j] && c < x->sys->ncontact; c++) {
                const struct follower *f = tribo_normals_follower(x->sys, c);
                const double mu = f && f->normal == j ? f->mu : 0.0, limit = m->state.limit[c];
                const int slides = tribo_slides(m->state.slip[c]) || m->state.slip[c] == TRIBO_SLIP_PLANE;
                const double part = c == normal->row ? 1.0 : slides && limit > 0.0 ? -mu * x->force[c] / limit : 0.0;
                force -= part * x->a[c];
                force += c == i ? by_limit * mu : 0.0;
            }
            tribo_matrix_add_row(&x->sys->direction, normal->row, force * normal->stiffness, row);
        }
        add_transposed(&x->sys->damping, -1.0, x->change, row + x->sys->ndof);
        tribo_stick_slip_turn(m, x->sys, y, x->a, row + x->sys->ndof);
        for (size_t l = 0; l < n; l++) {
            row[l] /= g->middle.d;
        }
        x->contact[x->count++] = i;
    }
    return status;
}

/* There is no derivative, because of contacts i and j. */
static void tear(struct variation *x, size_t i, size_t j)
{
    x->to->torn = i < j ? i : j;
    x->to->other = i < j ? j : i;
}

/* Depth, speed and acceleration of a normal, relative to the largest ones of the structure, that are rounding. */
#define RESTS 1e-13

/* Where a normal rests at depth 0 some neighbouring motions are pressed, and others are not: there is no derivative; nor where a
 * contact in a plane begins to slide without a limit, and motions beside it in any direction. */
static void tear_resting(struct variation *x, const double *y)
{
    const tribo_system *sys = x->sys;
    const struct normals *s = &sys->normals;
    const size_t n = sys->ndof;
    const struct stick_slip *m = &x->to->events->stick_slip;
    for (size_t k = 0; m->plane && k < m->plane->count; k++) {
        if (tribo_slides_in_plane(m, m->plane->contact + k) && m->plane->contact[k].begins && m->plane->contact[k].lag) {
            tear(x, m->plane->contact[k].at, m->plane->contact[k].at + 1);
        }
    }
    for (size_t k = 0; k < s->followers; k++) {
        const struct normal *at = &s->normal[s->follower[k].normal];
        const double *const value[] = {y, y + n, x->acceleration};
        double reach = 0.0;
        int rests = 1;
        for (size_t e = sys->direction.first[at->row]; e < sys->direction.first[at->row + 1]; e++) {
            reach += fabs(sys->direction.val[e]);
        }
        for (size_t order = 0; order < 3; order++) {
            const double gap = order ? 0.0 : at->gap, off = tribo_matrix_row_dot(&sys->direction, at->row, value[order]) - gap;
            rests &= fabs(off) <= RESTS * (reach * tribo_largest(value[order], n) + fabs(gap));
        }
        if (rests) {
            tear(x, s->follower[k].contact, at->row);
        }
    }
}

int tribo_variation_phase(struct variation *x, double tau, double t, const double *y)
{
    struct stick_slip *m = &x->to->events->stick_slip;
    x->count = 0;
    x->clock += tau;
    int status = x->status ? x->status : tribo_stick_slip_acceleration(m, x->sys, t, y, x->acceleration, x->force);
    tribo_stick_slip_contact_accelerations(x->sys, x->acceleration, 1, x->rate);
    tribo_elastic_move(m, x->sys, y);
    memcpy(x->spring_rate, m->state.spring_rate, x->sys->ncontact * sizeof *x->spring_rate);
    if (status) {
        return status;
    }
    tear_resting(x, y);
    x->uncertain = tribo_stick_slip_uncertain(m);
    const struct motion *motion = x->to->events->motion;
    struct derivative_step *s = add_step(x->to);
    int done = s != NULL;
    if (s) {
        s->tau = tau;
        x->before = s->slip = malloc(x->sys->ncontact + x->sys->normals.count + 1);
        done = s->slip != NULL;
        s->phase = motion->keep ? motion->keep(x->to->events->own, tau) : NULL;
    }
    if (done) {
        memcpy(s->slip, m->state.slip, x->sys->ncontact);
        for (size_t k = 0; k < x->sys->normals.count; k++) {
            s->slip[x->sys->ncontact + k] = (signed char)m->state.pressed[k];
        }
    }
    status = done && (s->phase || !motion->keep) ? TRIBO_OK : no_room(x->to);
    status = status || may_wait(x) ? status : catch_up(x);
    return status ? status : find_drops(x, tau, y);
}

/* ------------------------------------------------------------------------------------------------------------- velocities */

/* Returns 1 if contact i slid and stops or reverses; also for an instant only, where v_i = 0 ended the phase and the force of
 * contact i makes a contact at rest slide. Returns 0 if v_i only touches 0, where there is no derivative, and for an elastic
 * contact, because its force is continuous. */
static int stops(const struct variation *x, size_t i)
{
    const signed char before = x->before[i], *now = x->to->events->stick_slip.state.slip;
    const struct guard *met = x->to->events->met;
    int acts = now[i] != before;
    if (x->to->events->stick_slip.constant.pair[i]) {
        return 0;
    }
    if (before == TRIBO_SLIP_PLANE) {
        return now[i] == TRIBO_SLIP_STUCK || x->to->events->stick_slip.state.rested[i];
    }
    if (!tribo_slides(before) || tribo_force_is_state(&x->to->events->stick_slip, i) || now[i] == TRIBO_SLIP_OPEN) {
        return 0;
    }
    for (size_t k = 0; met && met->kind == SLIDES && met->contact == i && k < x->sys->ncontact; k++) {
        acts |= x->before[k] == 0 && tribo_slides(now[k]);
    }
    return acts && before * x->rate[i] < 0.0;
}

/* ----------------------------------------------------------------------------------------------------------------- groups */

/* Sets x->group = group for contact i and all contacts that its forces reach by shared bodies and contacts whose forces may jump:
 * these stop, or rest before or after, and are not elastic. */
static void gather(struct variation *x, size_t i, size_t group)
{
    const struct stick_slip *m = &x->to->events->stick_slip;
    const double least = TOGETHER * tribo_system_delassus(x->sys, i, i);
    x->group[i] = group;
    for (size_t j = 0; j < x->sys->ncontact; j++) {
        const int passes = !x->group[j] && !tribo_force_is_state(m, j) &&
                           (x->before[j] == 0 || m->state.slip[j] == TRIBO_SLIP_STUCK || stops(x, j));
        const int pair = m->plane && (m->plane->in_plane[i] == 1 ? j == i + 1 : m->plane->in_plane[i] == 2 && j + 1 == i);
        if (passes && (pair || fabs(tribo_system_delassus(x->sys, i, j)) > least)) {
            gather(x, j, group);
        }
    }
}

/* Returns the first crossing of the group of crossing `first` that perturbed motions do not make at the same time, tied together
 * by holding contacts; count if there is none. */
static size_t find_apart(struct variation *x, size_t first)
{
    const size_t n = tribo_system_energy(x->sys), group = x->group[x->contact[first]];
    double *delay = x->delay, *difference = delay + x->columns;
    for (size_t k = first + 1; k < x->count; k++) {
        if (x->group[x->contact[k]] == group) {
            x->status = x->status ? x->status : catch_up(x);
            memset(delay, 0, x->columns * sizeof *delay);
            tribo_multiply_add(1, n, x->columns, 1.0, x->row + first * n, x->v, delay);
            memcpy(difference, delay, x->columns * sizeof *delay);
            tribo_multiply_add(1, n, x->columns, -1.0, x->row + k * n, x->v, difference);
            if (tribo_largest(difference, x->columns) > TOGETHER * tribo_largest(delay, x->columns)) {
                return k;
            }
        }
    }
    return x->count;
}

/* Carries perturbations over the crossings of the group of crossing `first`, its first one: appends the jump of q'' by the forces
 * of the group, earlier by that crossing. */
static void carry_over(struct variation *x, size_t first)
{
    const size_t n = x->sys->ndof, all = tribo_system_energy(x->sys), group = x->group[x->contact[first]];
    const struct slip_state *now = &x->to->events->stick_slip.state;
    int acts = 0, slides = 0; /* 1: a contact stops, or breaks away; slides afterwards */
    for (size_t k = first; k < x->count; k++) {
        const size_t i = x->contact[k];
        acts |= x->group[i] == group && (x->before[i] != 0 || now->slip[i] != 0);
    }
    if (!acts) {
        return;
    }
    const size_t apart = find_apart(x, first);
    for (size_t i = 0; i < x->sys->ncontact; i++) {
        slides |= x->group[i] == group && now->slip[i] != TRIBO_SLIP_STUCK;
        x->f[i] = x->group[i] == group ? now->force[i] - x->force[i] : 0.0;
    }
    if (apart < x->count) {
        if (slides) {
            tear(x, x->contact[first], x->contact[apart]);
        }
        return;
    }
    memset(x->change, 0, (all - n) * sizeof *x->change);
    tribo_matrix_multiply(&x->sys->response, x->f, x->change);
    for (size_t l = 0; l < x->count; l++) {
        const double change = tribo_dot(x->row + l * all + n, x->change, n);
        if (x->group[x->contact[l]] != group && fabs(change) > TOGETHER) {
            tear(x, x->contact[first], x->contact[l]);
        }
    }
    x->status = x->status ? x->status : add_jump(x->to, x->row + first * all, 0, 0.0, x->change);
}

/* Where elastic contact i = met->contact breaks away and other elastic contacts stop, because f' jumps: appends the jump of f',
 * earlier by (df_i - dlimit)/(f_i' - limit'). */
static void carry_over_springs(struct variation *x)
{
    const struct stick_slip *m = &x->to->events->stick_slip;
    const struct guard *met = x->to->events->met;
    const struct compliance *g = &x->sys->compliance;
    const size_t n = x->sys->ndof, all = tribo_system_energy(x->sys), i = met ? met->contact : 0;
    int stop = 0;
    if (!met || met->kind != HOLDS || !tribo_is_compliant(g, i) || x->before[i] != 0 || !tribo_slides(m->state.slip[i])) {
        return;
    }
    const double slope = x->spring_rate[i] + met->side * m->state.limit_rate[i];
    memset(x->change, 0, (all - n) * sizeof *x->change);
    memset(x->row, 0, all * sizeof *x->row);
    for (size_t k = 0; k < g->count; k++) {
        const size_t j = g->contact[k];
        stop |= tribo_slides(x->before[j]) && m->state.slip[j] == TRIBO_SLIP_STUCK;
        x->change[n + k] = m->state.spring_rate[j] - x->spring_rate[j];
        x->row[2 * n + k] = j == i && slope != 0.0 ? 1.0 / slope : 0.0;
    }
    const struct follower *f = tribo_normals_follower(x->sys, i);
    if (f && slope != 0.0) {
        const struct normal *normal = &x->sys->normals.normal[f->normal];
        tribo_matrix_add_row(&x->sys->direction, normal->row, met->side * f->mu * normal->stiffness / slope, x->row);
    }
    x->status = x->status || !stop || slope == 0.0 ? x->status : add_jump(x->to, x->row, i, met->side / slope, x->change);
}

/* Appends the jumps of f' where normals lift off or touch down, earlier by depth/speed. Of several normals each makes the jumps
 * of its own contacts. Where a normal is at rest f' of a contact that slides does not jump; if the contact sticks there is no
 * derivative. */
static void carry_over_normals(struct variation *x)
{
    const struct slip_state *now = &x->to->events->stick_slip.state;
    const struct normals *s = &x->sys->normals;
    const struct compliance *g = &x->sys->compliance;
    const size_t n = x->sys->ndof, all = tribo_system_energy(x->sys);
    const signed char *pressed = x->before + x->sys->ncontact;
    size_t changes = 0;
    for (size_t k = 0; k < s->count; k++) {
        changes += pressed[k] != now->pressed[k];
    }
    for (size_t k = 0; g->count && k < s->count; k++) {
        if (pressed[k] == now->pressed[k]) {
            continue;
        }
        for (size_t l = 0; now->rests[k] && l < g->count; l++) {
            const struct follower *f = tribo_normals_follower(x->sys, g->contact[l]);
            if (f && f->normal == k && now->slip[g->contact[l]] == TRIBO_SLIP_STUCK) {
                tear(x, g->contact[l], s->normal[k].row);
            }
        }
        if (now->rests[k]) {
            continue;
        }
        memset(x->change, 0, (all - n) * sizeof *x->change);
        memset(x->row, 0, all * sizeof *x->row);
        tribo_matrix_add_row(&x->sys->direction, s->normal[k].row, 1.0 / s->normal[k].speed, x->row);
        for (size_t l = 0; l < g->count; l++) {
            const size_t j = g->contact[l];
            const struct follower *f = tribo_normals_follower(x->sys, j);
            const int own = changes == 1 || (f && f->normal == k);
            x->change[n + l] = own ? now->spring_rate[j] - x->spring_rate[j] : 0.0;
        }
        x->status = x->status ? x->status : add_jump(x->to, x->row, 0, 0.0, x->change);
    }
}

/* There is no derivative if a contact coupled to i has crossed at an event before, at the instant at which i crosses, and one of
 * the two slides. */
static void tear_at_once(struct variation *x, size_t i)
{
    const struct stick_slip *m = &x->to->events->stick_slip;
    const double least = TOGETHER * tribo_system_delassus(x->sys, i, i), before = x->clock - AT_ONCE / x->to->events->fastest;
    for (size_t j = 0; j < x->sys->ncontact; j++) {
        const int slides = m->state.slip[i] != TRIBO_SLIP_STUCK || m->state.slip[j] != TRIBO_SLIP_STUCK;
        if (x->crossed[j] >= before && j != i && slides && fabs(tribo_system_delassus(x->sys, i, j)) > least) {
            tear(x, i, j);
        }
    }
}

void tribo_variation_event(struct variation *x)
{
    const struct stick_slip *m = &x->to->events->stick_slip;
    const size_t n = tribo_system_energy(x->sys);
    if (x->uncertain < x->sys->ncontact && m->state.slip[x->uncertain] != TRIBO_SLIP_STUCK) {
        tear(x, x->uncertain, x->uncertain + 1);
    }
    for (size_t i = 0, end; i < x->sys->ncontact; i = end) {
        const int pair = m->plane && m->plane->in_plane[i] == 1;
        double power = 0.0; /* rate of g = f'v along the force f of a contact that slides */
        end = i + (pair ? 2 : 1);
        for (size_t k = i; k < end; k++) {
            power += x->force[k] * x->rate[k];
        }
        if (stops(x, i) && (!pair || power > 0.0)) {
            double *row = x->row + x->count * n;
            memset(row, 0, n * sizeof *row);
            for (size_t k = i; k < end; k++) {
                const double part = pair ? x->force[k] / power : 1.0 / x->rate[k];
                tribo_matrix_add_row(&x->sys->direction, k, part, row + x->sys->ndof);
            }
            x->contact[x->count++] = i;
        }
    }
    memset(x->group, 0, x->sys->ncontact * sizeof *x->group);
    for (size_t k = 0; k < x->count; k++) {
        if (!x->group[x->contact[k]]) {
            gather(x, x->contact[k], k + 1);
        }
    }
    for (size_t k = 0; k < x->count; k++) {
        if (x->group[x->contact[k]] == k + 1) {
            carry_over(x, k);
        }
    }
    for (size_t k = 0; k < x->count; k++) {
        tear_at_once(x, x->contact[k]);
    }
    for (size_t k = 0; k < x->count; k++) {
        x->crossed[x->contact[k]] = x->clock;
    }
    /* contact i loses its static limit by none of these groups: the order of the crossings matters */
    for (size_t i = 0; x->count && i < x->sys->ncontact; i++) {
        const int slides = tribo_slides(m->state.slip[i]) || m->state.slip[i] == TRIBO_SLIP_PLANE;
        if (x->before[i] == 0 && slides && !x->group[i] && tribo_drops(m, i)) {
            tear(x, i, x->contact[0]);
        }
    }
    carry_over_springs(x);
    carry_over_normals(x);
    x->status = x->status || may_wait(x) ? x->status : catch_up(x);
}

/* c_v'q'' = w'(load - AK q - AC q' + B f), w = c_v + J'f with f_H = -R_HH^-1 B_H'c_v over the contacts H that are held. */
int tribo_variation_rate_row(struct variation *x, struct events *e, const double *c, double *row)
{
    const size_t n = x->sys->ndof;
    double *const w = x->acceleration;
    memset(row, 0, tribo_system_energy(x->sys) * sizeof *row);
    memcpy(row + n, c, n * sizeof *c);
    memcpy(w, c + n, n * sizeof *c);
    memset(x->a, 0, x->sys->ncontact * sizeof *x->a);
    add_transposed(&x->sys->response, 1.0, w, x->a);
    const int status = tribo_stick_slip_balance(&e->stick_slip, x->a, x->f);
    add_transposed(&x->sys->direction, 1.0, x->f, w);
    add_transposed(&x->sys->stiffness, -1.0, w, row);
    add_transposed(&x->sys->damping, -1.0, w, row + n);
    memset(x->a, 0, x->sys->ncontact * sizeof *x->a);
    add_transposed(&x->sys->compliance.pull, 1.0, w, x->a);
    for (size_t k = 0; k < x->sys->compliance.count; k++) {
        row[2 * n + k] = x->a[x->sys->compliance.contact[k]];
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------------------- calls */

void tribo_variation_begin(struct variation *x, struct events *e, const double *v, size_t columns, struct derivative *to)
{
    tribo_derivative_free(to);
    *to = (struct derivative){.events = e, .sys = x->sys, .torn = x->sys->ncontact, .other = x->sys->ncontact};
    memcpy(x->v, v, tribo_system_energy(x->sys) * columns * sizeof *v);
    x->columns = columns;
    x->to = to;
    x->by = NULL;
    x->applied = 0;
    x->status = TRIBO_OK;
    x->clock = 0.0;
    for (size_t i = 0; i < x->sys->ncontact; i++) {
        x->crossed[i] = -HUGE_VAL;
    }
}

int tribo_variation_create(struct variation *x, tribo_system *sys, size_t columns)
{
    const size_t n = sys->ndof, c = sys->ncontact, all = tribo_system_energy(sys);
    *x = (struct variation){.sys = sys};
    return ALLOCATE(ARRAY(x->v, all * columns), ARRAY(x->acceleration, n), ARRAY(x->force, c), ARRAY(x->rate, c),
                    ARRAY(x->spring_rate, c), ARRAY(x->row, c * all), ARRAY(x->a, c), ARRAY(x->f, c), ARRAY(x->change, all - n),
                    ARRAY(x->delay, 2 * columns), ARRAY(x->contact, c), ARRAY(x->group, c), ARRAY(x->crossed, c)) != NULL;
}

void tribo_variation_free(struct variation *x)
{
    free(x->v);
    memset(x, 0, sizeof *x);
}
