/* What the periodic motion found last holds. Each call follows it through its period once more, phase by phase in closed form. */
#include "shooting.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Goes along with a period, and does something with each phase. */
struct replay {
    struct company company;
    struct period_map *map;
    int (*phase)(struct replay *r, double tau, const double *end);
    const double *c;             /* [2 ndof] the combination asked for */
    struct signal signal, slope; /* it, in the phase */
    double elapsed;              /* since the period began */
    struct extremes extremes;
    double omega, re, im; /* integral with e^{-i omega t} */
    double *sum;          /* [ncontact] */
    double *row;          /* [2 ndof] workspace */
};

static int no_memory(const struct replay *r)
{
    return tribo_system_fail(r->map->sys, TRIBO_ERR_MEMORY, "out of memory for a phase of the period");
}

/* map->x is the state that the phase began with. */
static int phase_ends(struct company *company, double tau, double t, const double *y)
{
    struct replay *r = (struct replay *)company;
    const int status = r->phase(r, tau, y);
    (void)t;
    r->elapsed += tau;
    memcpy(r->map->x, y, r->map->n * sizeof *y);
    return status;
}

static void event_decided(struct company *company)
{
    (void)company;
}

static int set_signal(struct replay *r, double tau, const double *end)
{
    return r->map->events->signal(r->map->events->motion, r->c, tau, end, &r->signal);
}

/* Has r->phase called with all phases of the period. Returns a status. */
static int replay(tribo_driver *drv, struct replay *r)
{
    struct shooting *s = drv->shooting;
    if (!s || !s->found || s->revision != tribo_system_revision(drv->sys)) {
        return tribo_driver_fail(drv, TRIBO_ERR_STATE, "%s: call tribo_driver_find_periodic first",
                                 s && s->found ? "the system has changed since the periodic motion was found"
                                               : "no periodic motion was found");
    }
    r->company = (struct company){phase_ends, event_decided};
    r->map = &s->map;
    r->elapsed = 0.0;
    memcpy(s->map.x, s->best.y, s->map.n * sizeof *s->map.x);
    const int status = tribo_period_map_replay(&s->map, s->best.y, &r->company);
    tribo_signal_free(&r->signal);
    tribo_signal_free(&r->slope);
    return status && s->map.drv != drv ? tribo_driver_fail(drv, status, "%s", s->map.drv->message) : status;
}

static int check_combination(tribo_driver *drv, const double *c)
{
    for (size_t i = 0; i < 2 * drv->sys->ndof; i++) {
        if (!isfinite(c[i])) {
            return tribo_driver_fail(drv, TRIBO_ERR_NOT_FINITE, "c[%zu] = %g is not finite", i, c[i]);
        }
    }
    return TRIBO_OK;
}

/* -------------------------------------------------------------------------------------------------------------- extremes */

static int find_extremes(struct replay *r, double tau, const double *end)
{
    const int status = set_signal(r, tau, end);
    return status || tribo_signal_extremes(&r->signal, &r->slope, r->map->t + r->elapsed, &r->extremes) ? status : no_memory(r);
}

int tribo_driver_period_extremes_at(tribo_driver *drv, const double *c, double *least, double *most, double *at_least,
                                    double *at_most)
{
    if (!drv) {
        return TRIBO_ERR_NULL;
    }
    if (!c || !least || !most || !at_least || !at_most) {
        return tribo_driver_fail(drv, TRIBO_ERR_NULL, "%s is NULL",
                                 !c         ? "c"
                                 : !least   ? "least"
                                 : !most    ? "most"
                                 : at_least ? "at_most"
                                            : "at_least");
    }
    struct replay r = {.phase = find_extremes, .c = c, .extremes = {HUGE_VAL, -HUGE_VAL, 0.0, 0.0}};
    int status = check_combination(drv, c);
    status = status ? status : replay(drv, &r);
    if (!status) {
        *least = r.extremes.least;
        *most = r.extremes.most;
        *at_least = r.extremes.at_least;
        *at_most = r.extremes.at_most;
    }
    return status;
}

int tribo_driver_period_extremes(tribo_driver *drv, const double *c, double *least, double *most)
{
    double at_least, at_most;
    return tribo_driver_period_extremes_at(drv, c, least, most, &at_least, &at_most);
}

/* -------------------------------------------------------------------------------------------------------------- harmonics */

static int integrate(struct replay *r, double tau, const double *end)
{
    const int status = set_signal(r, tau, end);
    if (!status) {
        double re = 0.0, im = 0.0;
        const double angle = r->omega * (r->map->t + r->elapsed), c = cos(angle), d = -sin(angle);
        tribo_signal_integrate(&r->signal, r->omega, &re, &im);
        r->re += c * re - d * im;
        r->im += d * re + c * im;
    }
    return status;
}

int tribo_driver_period_harmonic(tribo_driver *drv, const double *c, size_t k, double *cosine, double *sine)
{
    if (!drv) {
        return TRIBO_ERR_NULL;
    }
    if (!c || !cosine || !sine) {
        return tribo_driver_fail(drv, TRIBO_ERR_NULL, "%s is NULL", !c ? "c" : !cosine ? "cosine" : "sine");
    }
    struct replay r = {.phase = integrate, .c = c};
    int status = check_combination(drv, c);
    if (!status && drv->shooting) {
        r.omega = 2.0 * acos(-1.0) * (double)k / drv->shooting->map.period;
    }
    status = status ? status : replay(drv, &r);
    if (!status) {
        const double factor = (k ? 2.0 : 1.0) / drv->shooting->map.period;
        *cosine = factor * r.re;
        *sine = k ? -factor * r.im : 0.0;
    }
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- contacts */

/* Entry i of a harmonic, or 0, as Re(a e^{i omega s}), s from t on. */
static double complex entry(const struct harmonic *w, size_t i, double t)
{
    for (size_t k = 0; k < w->count; k++) {
        if (w->index[k] == i) {
            return (w->cosine[k] - w->sine[k] * I) * cexp(w->omega * t * I);
        }
    }
    return 0.0;
}

/* The integral of e^{i omega s} over tau, about the middle. */
static double complex integral(double omega, double tau)
{
    return (omega != 0.0 ? 2.0 * sin(0.5 * omega * tau) / omega : tau) * cexp(0.5 * omega * tau * I);
}

/* Integrals over tau of the velocity of contact i, and of that times what a harmonic makes of its limit, limit. */
struct way {
    size_t i;
    double t, tau;
    const struct harmonic *limit;
    double complex amplitude;
};

/* The part of the base, which moves from below. */
static double way_of_base(const tribo_system *sys, const struct way *x)
{
    double way = 0.0;
    for (size_t s = 0; s < sys->harmonics; s++) {
        const struct harmonic *w = &sys->harmonic[s];
        const double complex b = w->drives == DRIVES_BASE ? entry(w, x->i, x->t) : 0.0;
        if (b != 0.0 && !x->limit) {
            way -= creal(b * integral(w->omega, x->tau));
        } else if (b != 0.0) {
            const double complex sum = integral(x->limit->omega + w->omega, x->tau);
            const double complex difference = integral(x->limit->omega - w->omega, x->tau);
            way -= 0.5 * creal(x->amplitude * (b * sum + conj(b) * difference));
        }
    }
    return way;
}

/* The work of what harmonics add to the limit of contact i. */
static int add_swing(struct replay *r, const struct way *steady, const double *end, double *work, double *limit)
{
    const tribo_system *sys = r->map->sys;
    struct way x = *steady;
    memset(r->row, 0, 2 * sys->ndof * sizeof *r->row);
    for (size_t k = sys->direction.first[x.i]; k < sys->direction.first[x.i + 1]; k++) {
        r->row[sys->ndof + sys->direction.col[k]] = sys->direction.val[k];
    }
    r->c = r->row;
    int status = set_signal(r, x.tau, end);
    for (size_t s = 0; !status && s < sys->harmonics; s++) {
        x.limit = &sys->harmonic[s];
        if (x.limit->drives == DRIVES_LIMIT && (x.amplitude = entry(x.limit, x.i, x.t)) != 0.0) {
            double re = 0.0, im = 0.0;
            tribo_signal_integrate(&r->signal, x.limit->omega, &re, &im);
            *work += creal(x.amplitude) * re + cimag(x.amplitude) * im + way_of_base(sys, &x);
            *limit -= creal(x.amplitude);
        }
    }
    return status;
}

/* A sliding force dissipates its size times the way. */
static int find_work(struct replay *r, size_t i, double tau, const double *end, double *work)
{
    const tribo_system *sys = r->map->sys;
    const struct stick_slip *m = &r->map->events->stick_slip;
    const struct way x = {i, r->map->t + r->elapsed, tau, NULL, 0.0};
    double limit = m->limit[i], swung = 0.0;
    const int status = m->swing[i] > 0.0 ? add_swing(r, &x, end, &swung, &limit) : TRIBO_OK;
    const double way = tribo_matrix_row_dot(&sys->direction, i, end) - tribo_matrix_row_dot(&sys->direction, i, r->map->x);
    *work = m->slip[i] * (swung + limit * (way + way_of_base(sys, &x)));
    return status;
}

static int add_energy(struct replay *r, double tau, const double *end)
{
    const struct events *e = r->map->events;
    int status = TRIBO_OK;
    for (size_t i = 0; !status && i < r->map->sys->ncontact; i++) {
        if (e->stick_slip.slip[i] == 1 || e->stick_slip.slip[i] == -1) {
            double work = 0.0;
            if (e->work) {
                work = e->work(e->motion, i, tau);
            } else {
                status = find_work(r, i, tau, end, &work);
            }
            r->sum[i] += r->map->sys->tally[i] * work;
        }
    }
    return status;
}

static int add_rest(struct replay *r, double tau, const double *end)
{
    (void)end;
    for (size_t i = 0; i < r->map->sys->ncontact; i++) {
        r->sum[i] += r->map->events->stick_slip.slip[i] == 0 ? tau / r->map->period : 0.0;
    }
    return TRIBO_OK;
}

/* to [ncontact] = the sum over the phases. */
static int sum_up(tribo_driver *drv, const char *name, int (*phase)(struct replay *, double, const double *), double *to)
{
    if (!drv) {
        return TRIBO_ERR_NULL;
    }
    if (!to) {
        return tribo_driver_fail(drv, TRIBO_ERR_NULL, "%s is NULL", name);
    }
    const size_t count = drv->sys->ncontact;
    struct replay r = {.phase = phase, .sum = calloc(count + 2 * drv->sys->ndof + 1, sizeof *to)};
    r.row = r.sum ? r.sum + count : NULL;
    const int status = r.sum ? replay(drv, &r)
                             : tribo_driver_fail(drv, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s", count, plural(count));
    if (!status) {
        memcpy(to, r.sum, count * sizeof *to);
    }
    free(r.sum);
    return status;
}

int tribo_driver_period_dissipation(tribo_driver *drv, double *energy)
{
    return sum_up(drv, "energy", add_energy, energy);
}

int tribo_driver_period_stick(tribo_driver *drv, double *share)
{
    return sum_up(drv, "share", add_rest, share);
}
