/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>

#include "output.h"
#include "study.h"
#include "team.h"

static const double LEAST_PART = 1e-6; /* tolerance of the limit of most power */

/* -------------------------------------------------------------------------------------------------------------- power */

/* The dissipated power is found from the motion of one sample. */
struct trial {
    const struct study *study;
    const struct sample *from;
};

static void try_limits(void *data, const double *limit, double *value, size_t count)
{
    const struct trial *t = data;
    struct task *task = need_memory(count, sizeof *task);
    for (size_t k = 0; k < count; k++) {
        task[k] = (struct task){t->study->damper, t->study->options->march, limit[k], t->from->motion.hz, .guess = t->from->y};
    }
    run_tasks(t->study->options->threads, task, count);
    for (size_t k = 0; k < count; k++) {
        value[k] = task[k].motion.found ? -task[k].motion.friction : HUGE_VAL;
    }
    free(task);
}

struct optimum {
    double limit, power, amplitude;
};

/* The best damper by harmonic balance of one mode k that is driven at its resonance. All contacts slide in phase, so that the
 * work of a period is  pi p_k Q = 4 N S Q + pi c_k omega Q^2  with S the sum of |phi_i|: friction dissipates most where it takes
 * half of what the load puts in, 4 N S = pi p_k/2. NaN if the load is not at a natural frequency, if damping couples modes, or
 * unless all contacts are rigid, along one axis, and have the limit that varies. */
static struct optimum balance_mode(const struct damper *d, double drive)
{
    const double pi = acos(-1.0), none = (double)NAN;
    const struct linear *l = &d->open;
    size_t k = 0;
    double sum = 0.0;
    int one = !d->in_plane && !l->coupled;
    for (size_t i = 1; i < d->modes; i++) {
        k = fabs(l->omega[i] - drive) < fabs(l->omega[k] - drive) ? i : k;
    }
    const double damping = l->damping[k * (d->modes + 1)], load = hypot(l->cosine[k], l->sine[k]);
    for (size_t c = 0; c < d->contacts; c++) {
        const struct contact *contact = &d->contact[c];
        one = one && isnan(contact->limit) && contact->mu == 1.0 && contact->stiffness == 0.0 && !contact->normal.direction;
        sum += fabs(d->contact_shape[c * d->modes + k]);
    }
    if (!one || fabs(l->omega[k] - drive) > 0.05 * damping) {
        return (struct optimum){none, none, none};
    }
    const double half = 0.5 * load / (damping * l->omega[k]);
    return (struct optimum){pi * load / (8.0 * sum), 0.25 * drive * load * half, fabs(l->measured[k]) * half};
}

/* Three periods of the motion at a limit of the curve; returns that motion. */
static struct motion show_motion(struct study *s, struct curve *c, double limit, const char *what)
{
    struct worker w = create_worker(s->damper, s->options->march);
    const struct sample *there = reach_sample(c, &w, log(limit));
    const struct motion m = there ? there->motion : (struct motion){.found = 0};
    if (there) {
        write_history(s->tables, &w, &m, there->y, what);
        if (s->options->field.count) {
            write_field(s->tables, s->model->structure, &s->options->field, &w, &m, there->y, what);
        }
    }
    free_worker(&w);
    return m;
}

static void find_most_power(struct study *s, struct curve *c)
{
    const struct sample *most = largest_of(c, POWER);
    if (!most) {
        printf("no motion was found at any of these %ss: %s\n", s->tables->limit, first_message(c, 1));
        return;
    }
    if (!(most->motion.friction > 0.0)) {
        printf("friction dissipates nothing at any of these limits: nothing slips, or the contacts are where nothing moves\n");
        return;
    }
    const size_t at = (size_t)(most - c->sample);
    if (at == 0 || at + 1 == c->count) {
        printf("most power is dissipated at the end of the range, at %s %g: widen --limits to find the optimum\n",
               s->tables->limit, c->sample[at].motion.limit);
        return;
    }
    struct trial t = {.study = s, .from = &c->sample[at]};
    double power;
    const double limit =
        find_least(c->sample[at - 1].motion.limit, c->sample[at + 1].motion.limit, LEAST_PART, try_limits, &t, &power);
    if (!interrupted()) {
        const struct motion best = show_motion(s, c, limit, "history");
        /* above the optimum contacts rest for a part of each period */
        show_motion(s, c, 3.0 * limit, "sticking");
        end_progress();
        if (best.found) {
            const struct optimum simple = balance_mode(s->damper, TURN * best.hz);
            printf("most power: %s %.8g dissipates %.8g, amplitude %.8g\n", s->tables->limit, best.limit, best.friction,
                   best.amplitude);
            write_result(s->tables, s->options->contacts.by_load ? "best.load" : "best.limit", best.limit);
            write_result(s->tables, "best.power", best.friction);
            write_result(s->tables, "best.amplitude", best.amplitude);
            if (isfinite(simple.limit)) {
                printf("by harmonic balance of the driven mode: limit %.5g, power %.6g\n", simple.limit, simple.power);
                write_result(s->tables, "best.limit.balance", simple.limit);
                write_result(s->tables, "best.power.balance", simple.power);
                write_result(s->tables, "best.amplitude.balance", simple.amplitude);
            }
        }
    }
}

/* --------------------------------------------------------------------------------------------------------------- curve */

void print_limits(struct study *s, const struct curve *c)
{
    printf("  %12s    amplitude friction power  damping power  periods\n", s->tables->limit);
    for (size_t k = 0; k < c->count; k++) {
        const struct motion *m = &c->sample[k].motion;
        if (c->sample[k].asked && m->found) {
            printf("  %12.5g %12.5g %14.5g %14.5g %8zu\n", m->limit, m->amplitude, m->friction, m->damped, m->periods);
        } else if (!m->found && searched(&c->sample[k])) {
            printf("  %12.5g  not found: %s\n", m->limit, m->message);
        }
    }
}

void study_limits(struct study *s, struct curve *c)
{
    check_by_marching(s, c);
    if (!interrupted() && s->options->limits.points > 1) {
        find_most_power(s, c);
    } else if (!interrupted()) {
        show_motion(s, c, s->options->limits.from, "loop");
        end_progress();
    }
    write_curves(s->tables, "curve", c, 1, s->damper);
    if (s->options->limits.points > 1) {
        plot_curve(s->tables);
    }
    s->gaps += gaps_of(c);
}
