/* SPDX-License-Identifier: BSD-3-Clause */
#include "study.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "output.h"
#include "team.h"

enum { LEAST_MODES = 12, MOST_MODES = 200 /* kept by default */ };
enum { HARMONICS = 9 /* of the load, up to which displacements at the contacts are right to MOST_MISSING */ };
static const double MOST_MISSING = 0.01, MOST_ERROR = 0.01;

/* -------------------------------------------------------------------------------------------------------------- comparing */

/* Contacts in a plane with a normal direction are marched with Coulomb's law, all others are exact. */
void compare_models(const struct model *m, size_t threads, struct point *point, size_t count)
{
    struct damper both[] = {m->damper, m->finer};
    struct task *task = need_memory(2 * count, sizeof *task);
    for (size_t k = 0; k < 2 * count; k++) {
        both[k % 2].law = TRIBO_COULOMB;
        task[k] = (struct task){&both[k % 2], m->damper.marched, .limit = point[k / 2].limit, .hz = point[k / 2].hz};
    }
    if (!m->whole) {
        run_tasks(threads, task, 2 * count);
    }
    for (size_t k = 0; k < count; k++) {
        const struct motion *kept = &task[2 * k].motion, *more = &task[2 * k + 1].motion;
        point[k].compared = kept->found && more->found;
        if (point[k].compared) {
            const double in = fmax(fabs(kept->friction) + kept->damped, fabs(more->friction) + more->damped);
            point[k].amplitude = relative_difference(kept->amplitude, more->amplitude);
            point[k].power = in > 0.0 ? fabs(kept->friction - more->friction) / in : 0.0;
        }
    }
    free(task);
}

/* The largest change with all contacts stuck: of amplitudes at the ends of the band, and of natural frequencies up to the highest
 * of the loads, the first one always. */
static double stuck_change(const struct model *m)
{
    const struct linear *kept = &m->damper.stuck, *more = &m->finer.stuck;
    const double end[] = {TURN * m->damper.lowest, TURN * m->damper.highest};
    double change = 0.0;
    for (int k = 0; k < 2; k++) {
        change = fmax(change, relative_difference(scale_of(kept, end[k]).amplitude, scale_of(more, end[k]).amplitude));
    }
    for (size_t k = 0; k < kept->count && k < more->count && (k == 0 || more->omega[k] <= end[1]); k++) {
        change = fmax(change, relative_difference(kept->omega[k], more->omega[k]));
    }
    return change;
}

/* The largest changes of points that count, and with all contacts stuck; error: the model error. */
struct changes {
    double amplitude, power, stuck, error;
    size_t points;
};

static struct changes largest_changes(const struct model *m, const struct point *point, size_t count)
{
    struct changes c = {.stuck = m->whole ? 0.0 : stuck_change(m)};
    for (size_t k = 0; k < count; k++) {
        if (point[k].compared && !point[k].between) {
            c.amplitude = fmax(c.amplitude, point[k].amplitude);
            c.power = fmax(c.power, point[k].power);
            c.points++;
        }
    }
    const double error = MARGIN * fmax(fmax(c.amplitude, c.power), c.stuck);
    c.error = m->whole ? 0.0 : c.points ? error : (double)NAN;
    return c;
}

/* --------------------------------------------------------------------------------------------------------------- choosing */

/* The damper with `kept` modes; with all, if modes and static responses are more than half of them. */
static struct damper with_modes(const struct options *o, const struct structure *s, size_t kept)
{
    return create_damper(o, s, 2 * (kept + o->contacts.count + o->loads.count) < s->ndof ? kept : s->ndof);
}

/* A bound of the part of the displacements at contacts and loads that is missing, up to harmonic HARMONICS. */
static double missing(const struct damper *d)
{
    double error;
    need(tribo_system_get_truncation(d->reduced, HARMONICS * TURN * d->highest, &error), "truncation");
    return d->kept < d->ndof ? error : 0.0;
}

/* 1 if --modes does not fix the modes and twice as many are allowed. */
static int may_double(const struct model *m)
{
    return !m->options->modes && m->damper.kept < m->damper.ndof && 2 * m->damper.kept <= MOST_MODES;
}

enum { PROBES = 3 };

/* The model error at the middle of each third of all limits, at PROBES frequencies of a band. */
static double probe_error(const struct model *m)
{
    const struct options *o = m->options;
    const double low = m->damper.lowest, high = m->damper.highest;
    const size_t limits = o->limits.points < PROBES ? o->limits.points : PROBES, bands = o->drive.points > 1 ? PROBES : 1;
    struct point probe[PROBES * PROBES];
    for (size_t k = 0; k < limits * bands; k++) {
        const size_t middle = (2 * (k % limits) + 1) * o->limits.points / (2 * limits);
        const double hz = low + (double)(k / limits) / (PROBES - 1) * (high - low);
        probe[k] = (struct point){.limit = limit_of(&o->limits, middle), .hz = hz};
    }
    compare_models(m, o->threads, probe, limits * bands);
    return largest_changes(m, probe, limits * bands).error;
}

static void check_drives(const struct damper *d)
{
    const double end[] = {d->lowest, d->highest};
    for (int k = 0; k < 2 && !is_unloaded(d->options); k++) {
        check_drive(d, end[k]);
        if (d->options->march || d->options->check) {
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
    struct model m = {
        .options = o, .structure = s, .damper = o->modes ? create_damper(o, s, o->modes) : with_modes(o, s, LEAST_MODES)};
    check_drives(&m.damper);
    while (may_double(&m) && !(missing(&m.damper) <= MOST_MISSING)) {
        const size_t kept = 2 * m.damper.kept;
        free_damper(&m.damper);
        m.damper = with_modes(o, s, kept);
    }
    add_finer(&m);
    while (!is_unloaded(o) && may_double(&m) && take_more_modes(&m, probe_error(&m))) {
    }
    end_progress();
    check_drives(&m.damper);
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
    const double error = missing(d);
    write_frequencies(t, d, m->options->frequencies);
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

const char *advice(const struct model *m, double error)
{
    return error <= MOST_ERROR ? "" : may_double(m) ? ": again with these" : ": take more --modes";
}

double report_error(const struct tables *t, const struct model *m, const struct point *point, size_t count)
{
    const struct changes c = largest_changes(m, point, count);
    if (m->whole) {
        printf("model error: none, since all modes are there\n");
    } else if (c.points == 0) {
        printf("model error: not known, since no motion was found with %zu modes, too\n", m->finer.kept);
    } else {
        printf("model error: at most %.1e; with %zu modes amplitudes change by %.1e, powers by %.1e (at %zu point%s), all stuck "
               "by %.1e%s\n",
               c.error, m->finer.kept, c.amplitude, c.power, c.points, c.points == 1 ? "" : "s", c.stuck, advice(m, c.error));
    }
    for (size_t k = 0; !m->whole && c.points > 0 && k < count; k++) {
        const struct point *p = &point[k];
        if (p->between && p->compared && fmax(p->amplitude, p->power) > c.error) {
            printf("  more where contacts just begin to slip: at %.5g the amplitude changes by %.1e, the power by %.1e\n",
                   p->limit, p->amplitude, p->power);
        }
    }
    if (!isnan(c.error)) {
        write_result(t, "model.error", c.error);
    }
    return c.error;
}
