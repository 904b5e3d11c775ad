#include "model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "march.h"
#include "output.h"
#include "study.h"
#include "team.h"

enum { LEAST_MODES = 12, MOST_MODES = 200 /* kept by default */ };
enum { HARMONICS = 9 /* of the load, up to which next to nothing may be missing at the contacts */ };
static const double MOST_MISSING = 0.01, MOST_ERROR = 0.01;

/* -------------------------------------------------------------------------------------------------------------- comparing */

struct comparison {
    const struct model *model;
    const struct point *point;
    struct motion *motion; /* [count][2] */
};

/* Contacts in a plane are marched with Coulomb's law, all others are exact. */
static void find_one(void *data, size_t k)
{
    const struct comparison *c = data;
    const struct damper *d = k % 2 ? &c->model->finer : &c->model->damper;
    struct damper coulomb = *d;
    coulomb.law = TRIBO_COULOMB;
    struct worker w = create_worker(&coulomb, coulomb.planar > 0);
    double *y = need_memory(record_of(w.d), sizeof *y);
    c->motion[k] = find_motion(&w, c->point[k / 2].limit, c->point[k / 2].hz, NULL, y);
    free(y);
    free_worker(&w);
}

void compare_models(const struct model *m, size_t threads, struct point *point, size_t count)
{
    struct comparison c = {m, point, need_memory(2 * count, sizeof *c.motion)};
    if (!m->whole) {
        run_jobs(threads, 2 * count, find_one, &c);
    }
    for (size_t k = 0; k < count; k++) {
        const struct motion *kept = &c.motion[2 * k], *more = kept + 1;
        point[k].compared = kept->found && more->found;
        if (point[k].compared) {
            const double in = fmax(fabs(kept->friction) + kept->damped, fabs(more->friction) + more->damped);
            point[k].amplitude = relative_difference(kept->amplitude, more->amplitude);
            point[k].power = in > 0.0 ? fabs(kept->friction - more->friction) / in : 0.0;
        }
    }
    free(c.motion);
}

double model_error(const struct point *point, size_t count)
{
    double error = (double)NAN;
    for (size_t k = 0; k < count; k++) {
        error = point[k].compared ? fmax(error, 2.0 * fmax(point[k].amplitude, point[k].power)) : error;
    }
    return error;
}

/* --------------------------------------------------------------------------------------------------------------- choosing */

/* So many modes; all, where these and static responses are more than half of them. */
static struct damper with_modes(const struct options *o, const struct structure *s, size_t kept)
{
    return create_damper(o, s, 2 * (kept + o->contacts.count + o->loads.count) < s->ndof ? kept : s->ndof);
}

/* What is missing at contacts and load, as a part of the displacements there, up to the highest harmonic that matters. */
static double missing(const struct damper *d, const struct options *o)
{
    const double hz = highest_drive(o, d);
    double error;
    need(tribo_system_get_truncation(d->reduced, HARMONICS * TURN * hz, &error), "truncation");
    return d->kept < d->ndof ? error : 0.0;
}

/* Whether the number of modes is free, and there may be twice as many. */
static int may_double(const struct model *m)
{
    return !m->options->modes && m->damper.kept < m->damper.ndof && 2 * m->damper.kept <= MOST_MODES;
}

enum { PROBES = 3 };

/* The middle of each third of all limits, at PROBES frequencies of a band. Returns how many. */
static size_t place_probes(const struct options *o, const struct damper *d, struct point *probe)
{
    const size_t limits = o->limits.points < PROBES ? o->limits.points : PROBES, bands = o->drive.points > 1 ? PROBES : 1;
    for (size_t k = 0; k < limits * bands; k++) {
        const double part = (double)(k / limits) / (PROBES - 1);
        const double hz = lowest_drive(o, d) + part * (highest_drive(o, d) - lowest_drive(o, d));
        const size_t middle = (2 * (k % limits) + 1) * o->limits.points / (2 * limits);
        probe[k] = (struct point){.limit = limit_of(&o->limits, middle), .hz = hz};
    }
    return limits * bands;
}

static double probe_error(const struct model *m)
{
    struct point probe[PROBES * PROBES];
    const size_t count = place_probes(m->options, &m->damper, probe);
    compare_models(m, m->options->threads, probe, count);
    return model_error(probe, count);
}

static void check_drives(const struct options *o, const struct damper *d)
{
    const double end[] = {lowest_drive(o, d), highest_drive(o, d)};
    for (int k = 0; k < 2; k++) {
        check_drive(d, end[k]);
        if (o->march || o->check) {
            check_steps(d, end[k]);
        }
    }
}

static void add_finer(struct model *m)
{
    m->whole = m->damper.kept == m->damper.ndof;
    if (!m->whole) {
        m->finer = with_modes(m->options, m->structure, 2 * m->damper.kept);
    }
}

int take_more_modes(struct model *m, double error)
{
    if (!may_double(m) || !(error > MOST_ERROR) || interrupted()) {
        return 0;
    }
    free_damper(&m->damper);
    m->damper = m->finer;
    add_finer(m);
    return 1;
}

struct model create_model(const struct options *o, const struct structure *s)
{
    struct model m = {.options = o,
                      .structure = s,
                      .damper = o->modes ? create_damper(o, s, o->modes) : with_modes(o, s, LEAST_MODES)};
    check_drives(o, &m.damper);
    while (may_double(&m) && !(missing(&m.damper, o) <= MOST_MISSING)) {
        const size_t kept = 2 * m.damper.kept;
        free_damper(&m.damper);
        m.damper = with_modes(o, s, kept);
    }
    add_finer(&m);
    while (may_double(&m) && take_more_modes(&m, probe_error(&m))) {
    }
    end_telling();
    check_drives(o, &m.damper);
    return m;
}

void free_model(struct model *m)
{
    free_damper(&m->damper);
    if (!m->whole) {
        free_damper(&m->finer);
    }
}

/* ------------------------------------------------------------------------------------------------------------------ telling */

void report_model(const struct tables *t, const struct model *m)
{
    const struct damper *d = &m->damper;
    const double error = missing(d, m->options);
    if (m->whole) {
        printf("model: all %zu modes\n", d->kept);
    } else {
        printf("model: %zu mode%s, up to %.5g Hz, and %zu static responses; up to %d times the load's frequency\n  ", d->kept,
               d->kept == 1 ? "" : "s", d->open.omega[d->kept - 1] / TURN, d->modes - d->kept, (int)HARMONICS);
        if (error < 1.0) {
            printf("at most %.1e of displacements at contacts%s is missing\n", error, m->options->statics ? " and load" : "");
        } else {
            printf("there may be modes that are not kept\n");
        }
    }
    write_result(t, "model.modes", (double)d->kept);
    if (error < 1.0) {
        write_result(t, "model.missing", error);
    }
}

void report_error(const struct tables *t, const struct model *m, const struct point *point, size_t count)
{
    const double error = m->whole ? 0.0 : model_error(point, count);
    double amplitude = 0.0, power = 0.0;
    size_t compared = 0;
    for (size_t k = 0; k < count; k++) {
        amplitude = fmax(amplitude, point[k].amplitude);
        power = fmax(power, point[k].power);
        compared += (size_t)point[k].compared;
    }
    if (m->whole) {
        printf("model error: none, since all modes are there\n");
    } else if (compared == 0) {
        printf("model error: not known, since no motion was found with %zu modes, too\n", m->finer.kept);
    } else {
        printf("model error: at most %.1e; with %zu modes amplitudes change by %.1e, powers by %.1e (at %zu point%s)%s\n", error,
               m->finer.kept, amplitude, power, compared, compared == 1 ? "" : "s",
               error <= MOST_ERROR ? "" : may_double(m) ? ": again with these" : ": take more --modes");
    }
    if (!isnan(error)) {
        write_result(t, "model.error", error);
    }
}
