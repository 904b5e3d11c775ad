/* SPDX-License-Identifier: BSD-3-Clause */
/* Cycles: periodic motions of systems without drives in time. The period T is an unknown of the shooting beside x; the condition
 * is that steps do not go along the flow: rate'step = 0, a section across the flow.
 *
 *     repeat, later each time
 *         find a return: two break-aways of one contact at states near each other; without break-aways a sampled state near the
 *             first one
 *         shoot, from the middle of the longest phase, far from events
 *     divide the period as long as the motion comes back earlier
 *     let the period begin as a contact breaks away
 *
 * Steps keep contacts at rest: the derivative is projected onto the states in which they rest. */
#include "shooting.h"
#include "common/layout.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* MOST_RETURNS: break-aways of a contact that are compared. SAMPLES: of a motion without break-aways in a length of the
 * search. */
enum { MOST_RETURNS = 16, SAMPLES = 64 };

/* In lengths of the search: times between looks at the break-aways; until there are MOST_RETURNS; time that is sampled. */
#define LOOKS 4.0
#define FARTHEST 1024.0
#define SAMPLED 16.0

/* NEARER: a return after several turns replaces one after fewer if its distance is smaller by this factor. NEAR: largest distance
 * of a sampled return over the largest distance before. */
#define NEARER 0.5
#define NEAR 0.3

/* length = speed period. AT_REST: length over size below which a motion is at rest. COMES_BACK: largest residual over length of a
 * cycle. SAME: largest distance over length of equal states. STAYS: largest residual over size of a period that begins at a
 * break-away. */
#define AT_REST 1e-6
#define COMES_BACK 1e-7
#define SAME 1e-6
#define STAYS 1e-8

/* A motion that comes back after this part of a period found does not move. */
#define LEAST_PART 1e-4

/* Largest change of a period by a search, as a factor. */
#define STRAYS 4.0

/* Observer: the longest phase, and break-aways of the contact of lowest index that breaks away. */
struct course {
    struct company company;
    const struct period_map *map;
    double elapsed;              /* time since the beginning */
    double longest, middle;      /* length of the longest phase, time of its middle */
    signed char *before;         /* [ncontact] slip in the phase */
    double *end;                 /* [n] state at the end of the phase */
    double *x;                   /* [n] workspace of the search */
    double *stopped;             /* [ncontact] times of coming to rest; 0: at rest since the beginning */
    size_t contact, count;       /* contact: ncontact if none breaks away */
    double *state;               /* [MOST_RETURNS][n] state at break-away k in row k % MOST_RETURNS, the last ones */
    double time[MOST_RETURNS];   /* likewise */
    double rested[MOST_RETURNS]; /* likewise: time at rest before */
};

static int course_phase(struct company *company, double tau, double t, const double *y)
{
    struct course *c = (struct course *)company;
    (void)t;
    if (tau > c->longest) {
        c->longest = tau;
        c->middle = c->elapsed + 0.5 * tau;
    }
    c->elapsed += tau;
    memcpy(c->before, c->map->events->stick_slip.state.slip, c->map->sys->ncontact);
    memcpy(c->end, y, c->map->n * sizeof *y);
    return TRIBO_OK;
}

static void course_decided(struct company *company)
{
    struct course *c = (struct course *)company;
    const signed char *now = c->map->events->stick_slip.state.slip;
    for (size_t i = 0; i < c->map->sys->ncontact; i++) {
        if (c->before[i] != TRIBO_SLIP_STUCK && now[i] == TRIBO_SLIP_STUCK) {
            c->stopped[i] = c->elapsed;
        }
        if (c->before[i] == TRIBO_SLIP_STUCK && tribo_slides(now[i]) && i <= c->contact) {
            c->count = i < c->contact ? 0 : c->count;
            c->contact = i;
            const size_t k = c->count++ % MOST_RETURNS;
            memcpy(c->state + k * c->map->n, c->end, c->map->n * sizeof *c->end);
            c->time[k] = c->elapsed;
            c->rested[k] = c->elapsed - c->stopped[i];
        }
    }
}

static void course_begin(struct course *c)
{
    c->elapsed = c->longest = c->middle = 0.0;
    c->contact = c->map->sys->ncontact;
    c->count = 0;
    memset(c->stopped, 0, c->map->sys->ncontact * sizeof *c->stopped);
}

/* -------------------------------------------------------------------------------------------------------------- shooting */

/* The unknown is T/extra.unit. */
static int cycle_apply(struct shooting *s, const struct point *p)
{
    const double period = p->unknown[0] * s->extra.unit[0], first = s->extra.first;
    if (!(period >= first / STRAYS && period <= first * STRAYS)) {
        return tribo_error(s->map.drv->message, TRIBO_ERR_NO_CONVERGENCE,
                           "no cycle was found: from period = %g the search goes to %g", first, period);
    }
    s->map.period = period;
    tribo_period_map_choose(&s->map, 0);
    return TRIBO_OK;
}

static int cycle_border(struct shooting *s, struct point *p)
{
    const size_t n = s->map.n;
    double *column = p->border, *row = p->border + s->extra.count * n;
    tribo_period_map_rate(&s->map, p->end, column);
    const double speed = tribo_energy_length(column, n);
    for (size_t i = 0; i < n; i++) {
        row[i] = speed > 0.0 ? column[i] / speed : 0.0;
        column[i] *= s->extra.unit[0];
    }
    memset(row + n, 0, s->extra.count * sizeof *row);
    p->value[0] = 0.0;
    return TRIBO_OK;
}

const struct border tribo_cycle_border = {.count = 1, .apply = cycle_apply, .border = cycle_border};

/* speed period of a point that was followed. */
static double cycle_length(const struct shooting *s, const struct point *p)
{
    return tribo_energy_length(p->border, s->map.n) * p->unknown[0];
}

/* Shoots from x at s->here. Sets *found = 1 if s->here is a cycle, *rests = 1 if it is a motion at rest. Returns a status: not
 * that of a search which ends. */
static int cycle_shoot(struct shooting *s, double period, int *found, int *rests)
{
    struct point *p = s->here;
    const double size = greater(tribo_energy_length(p->x, s->map.n), s->map.least);
    int closed;
    s->extra.unit[0] = size > 0.0 ? period / size : period;
    p->unknown[0] = period / s->extra.unit[0];
    const int status = tribo_shooting_try(s, period, &closed);
    const double length = cycle_length(s, s->here);
    *rests |= closed && !(length > AT_REST * s->here->size);
    *found = closed && length > AT_REST * s->here->size && s->here->residual <= COMES_BACK * length;
    s->map.period = *found ? s->here->unknown[0] * s->extra.unit[0] : period;
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- returns */

/* Marches from x. x = a state to which the motion returns after *period, about; *period = 0: there is none, *rests = 1 if the
 * motion comes to rest. Returns a status. */
static int find_return(struct shooting *s, struct course *c, double scale, double *x, double *period, int *rests)
{
    const size_t n = s->map.n;
    const double step = scale / SAMPLES;
    double *other = s->step, best = HUGE_VAL;
    int status = TRIBO_OK;
    *period = 0.0;
    course_begin(c);
    while (!status && c->count < MOST_RETURNS && c->elapsed < FARTHEST * scale) {
        status = tribo_period_map_march(&s->map, LOOKS * scale, 1, &c->company, x);
    }
    if (c->count >= 2) {
        const size_t newest = (c->count - 1) % MOST_RETURNS;
        tribo_energy_norm_of(&s->map.norm, 1, c->state + newest * n, x);
        for (size_t k = 1; k < c->count && k < MOST_RETURNS; k++) {
            const size_t at = (c->count - 1 - k) % MOST_RETURNS;
            tribo_energy_norm_of(&s->map.norm, 1, c->state + at * n, other);
            const double distance = tribo_energy_distance(other, x, n);
            if (distance < NEARER * best) {
                best = distance;
                *period = c->time[newest] - c->time[at];
            }
        }
        return status;
    }
    double last = 0.0, before = 0.0, most = 0.0;
    memcpy(other, x, n * sizeof *x);
    for (double k = 1.0; !status && k <= SAMPLED * SAMPLES; k += 1.0) {
        status = tribo_period_map_march(&s->map, step, 1, NULL, other);
        const double distance = tribo_energy_distance(other, x, n);
        if (last < before && last <= distance && last < NEAR * most && last < NEARER * best) {
            best = last;
            *period = (k - 1.0) * step;
        }
        most = greater(most, distance);
        before = last;
        last = distance;
    }
    *rests |= !status && most <= AT_REST * greater(tribo_energy_length(x, n), s->map.least);
    return status;
}

/* Shoots from the guess, if it has a period, and from returns of the motion from it, later each time. Returns a status. */
static int search_cycle(struct shooting *s, struct course *c, double guess, double scale)
{
    static const double marched[] = {0.0, 0.0, 20.0, 200.0};
    double period = guess, *x = c->x, time = scale;
    int found = 0, rests = 0, status = TRIBO_OK;
    for (size_t k = guess > 0.0 ? 0 : 1; !status && !found && k < sizeof marched / sizeof *marched; k++) {
        memcpy(x, s->guess, s->map.n * sizeof *x);
        s->map.period = time;
        if (marched[k] > 0.0) {
            status = tribo_period_map_march(&s->map, marched[k] * time, 1, NULL, x);
        }
        status = status || k == 0 ? status : find_return(s, c, scale, x, &period, &rests);
        time = period > 0.0 ? period : time;
        if (!status && period > 0.0) { /* to the middle of the longest phase */
            memcpy(s->here->x, x, s->map.n * sizeof *x);
            course_begin(c);
            status = tribo_period_map_march(&s->map, period, 1, &c->company, x);
            status = status ? status : tribo_period_map_march(&s->map, c->middle, 1, NULL, s->here->x);
        }
        status = status || !(period > 0.0) ? status : cycle_shoot(s, period, &found, &rests);
    }
    if (status || found) {
        return status;
    }
    return tribo_error(s->map.drv->message, TRIBO_ERR_NO_CONVERGENCE, "no cycle was found in %g times of %g: %s",
                       tribo_periods_followed(&s->map), time,
                       rests          ? "the motion comes to rest, or near to a state of rest"
                       : period > 0.0 ? "the motion does not come back to its beginning"
                                      : "the motion does not come back near to a state that it had");
}

/* -------------------------------------------------------------------------------------------------------------- the period */

/* Divides the period of s->here as long as the motion comes back earlier; lets it begin where the contact of lowest index breaks
 * away, after its longest rest. Returns a status. */
static int settle_period(struct shooting *s, struct course *c)
{
    static const double primes[] = {2.0, 3.0, 5.0, 7.0, 11.0, 13.0};
    const size_t n = s->map.n;
    const double whole = s->map.period;
    double period = whole, *x = s->guess;
    int status = TRIBO_OK, found = 0, rests = 0;
    for (size_t k = 0; !status && period > LEAST_PART * whole && k < sizeof primes / sizeof *primes;) {
        memcpy(x, s->here->x, n * sizeof *x);
        status = tribo_period_map_march(&s->map, period / primes[k], 1, NULL, x);
        if (tribo_energy_distance(x, s->here->x, n) <= SAME * cycle_length(s, s->here)) {
            period /= primes[k];
        } else {
            k++;
        }
    }
    if (!status && !(period > LEAST_PART * whole)) {
        return tribo_error(s->map.drv->message, TRIBO_ERR_NO_CONVERGENCE,
                           "no cycle was found: the motion stays at its beginning");
    }
    if (!status && period < whole) {
        status = cycle_shoot(s, period, &found, &rests);
        status = status || found ? status : tribo_shooting_fails(s, s->nearest);
    }
    memcpy(x, s->here->x, n * sizeof *x);
    course_begin(c);
    status = status ? status : tribo_period_map_march(&s->map, s->map.period, 2, &c->company, x);
    size_t at = MOST_RETURNS; /* the break-away in the second of these periods */
    for (size_t k = 0; k < c->count && k < MOST_RETURNS; k++) {
        const int second = c->time[k] > 0.5 * c->elapsed;
        at = second && (at == MOST_RETURNS || c->rested[k] > (1.0 + SAME) * c->rested[at]) ? k : at;
    }
    s->flow = s->here;
    if (status || at == MOST_RETURNS) {
        return status;
    }
    tribo_energy_norm_of(&s->map.norm, 1, c->state + at * n, s->there->x);
    s->map.moved = 0;
    status = tribo_period_map_follow(&s->map, s->there);
    if (!status && !tribo_point_is_closed(s->there, STAYS)) {
        return tribo_shooting_fails(s, s->there->residual / s->there->size);
    }
    tribo_shooting_turn(s);
    return status;
}

int tribo_shooting_find_cycle(struct shooting *s, struct wanted *w)
{
    const size_t n = s->map.n, contacts = s->map.sys->ncontact;
    const struct energy_norm *norm = &s->map.norm;
    struct course c = {.company = {course_phase, course_decided}, .map = &s->map};
    double scale = w->period; /* the guess, or else the longest natural period */
    s->found = 0;
    s->extra = tribo_cycle_border;
    int status = tribo_period_map_prepare(&s->map, w->t, scale > 0.0 ? scale : 1.0, w->y);
    if (!status && !(scale > 0.0)) {
        const double most = tribo_largest(norm->natural, norm->n);
        double least = most;
        for (size_t k = 0; k < norm->n; k++) {
            least = norm->natural[k] > SAME * most ? lesser(least, norm->natural[k]) : least;
        }
        scale = FULL_TURN / least;
        status = least > 0.0 ? tribo_period_map_prepare(&s->map, w->t, scale, w->y)
                             : tribo_error(s->map.drv->message, TRIBO_ERR_NOT_POSITIVE,
                                           "period = 0 is no guess for a structure without natural frequencies");
    }
    if (!status && !ALLOCATE(ARRAY(c.state, MOST_RETURNS * n), ARRAY(c.end, n), ARRAY(c.x, n), ARRAY(c.stopped, contacts),
                             ARRAY(c.before, contacts))) {
        status = tribo_error(s->map.drv->message, TRIBO_ERR_MEMORY, "out of memory for cycles of %zu degree%s of freedom",
                             s->map.sys->ndof, plural(s->map.sys->ndof));
    }
    if (!status) {
        tribo_period_map_choose(&s->map, 0);
        tribo_energy_norm_of(&s->map.norm, 1, w->y, s->guess);
        status = search_cycle(s, &c, w->period, scale);
    }
    status = status ? status : settle_period(s, &c);
    if (!status) {
        tribo_shooting_keep(s, w);
    }
    s->map.drv->periods += (size_t)ceil(tribo_periods_followed(&s->map));
    free(c.state);
    return status;
}
