/* Velocities and accelerations of contacts, and bounds of their rounding. Decisions are made in scalar_slip.c and
 * planar_slip.c. */
#include "stick_slip.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Rounding of an acceleration, in parts of the sum of the sizes of its terms. */
#define NOISE 2e-14

/* The horizon, in parts of one over the highest frequency: changes until then are nearly linear in time, and mostly far above
 * noise. */
#define LOOK_AHEAD 1e-4

/* ---------------------------------------------------------------------------------------------------------- rounding */

/* y += amplitudes of the harmonics that drive loads or bases, or (order 1) of their rates. */
static void add_amplitudes(const tribo_system *sys, enum drives drives, int order, double *y)
{
    for (size_t s = 0; s < sys->harmonics; s++) {
        const struct harmonic *w = &sys->harmonic[s];
        const double rate = order ? fabs(w->omega) : 1.0;
        for (size_t k = 0; w->drives == drives && k < w->count; k++) {
            y[w->index[k]] += rate * (fabs(w->cosine[k]) + fabs(w->sine[k]));
        }
    }
}

/* y [ncontact] += largest values of the tables of bases; rate [ncontact] += their steepest slopes. */
static void add_base_tables(const tribo_system *sys, double *y, double *rate)
{
    for (size_t s = 0; s < sys->tables; s++) {
        const struct table *table = &sys->table[s];
        double most = 0.0, steepest = 0.0;
        for (size_t k = 0; table->drives == DRIVES_BASE && k < table->knots; k++) {
            const double rise = k ? (table->value[k] - table->value[k - 1]) / (table->time[k] - table->time[k - 1]) : 0.0;
            most = greater(most, fabs(table->value[k]));
            steepest = greater(steepest, fabs(rise));
        }
        for (size_t i = 0; table->drives == DRIVES_BASE && i < sys->ncontact; i++) {
            y[i] += most * fabs(table->pattern[i]);
            rate[i] += steepest * fabs(table->pattern[i]);
        }
    }
}

void tribo_stick_slip_find_scales(struct stick_slip *m, const tribo_system *sys)
{
    struct slip_constant *k = &m->constant;
    const size_t c = sys->ncontact;
    const double fastest = tribo_system_fastest(sys) + m->breakaway.steepest;
    k->horizon = LOOK_AHEAD / (fastest > 0.0 ? fastest : 1.0);
    memset(k->base_size, 0, c * sizeof *k->base_size);
    memset(k->base_rate_size, 0, c * sizeof *k->base_rate_size);
    memset(k->load_size, 0, sys->ndof * sizeof *k->load_size);
    add_amplitudes(sys, DRIVES_BASE, 0, k->base_size);
    add_amplitudes(sys, DRIVES_BASE, 1, k->base_rate_size);
    add_base_tables(sys, k->base_size, k->base_rate_size);
    add_amplitudes(sys, DRIVES_LOAD, 0, k->load_size);
    /* t is known to its rounding. Of contacts that depend on each other one follows its base, and the others see its
     * rounding. */
    const double late = DBL_EPSILON * fabs(sys->time) / TRIBO_VELOCITY_NOISE;
    for (size_t i = 0; i < c; i++) {
        k->base_size[i] += late * k->base_rate_size[i];
    }
    const double largest = k->independent ? 0.0 : tribo_largest(k->base_size, c);
    for (size_t i = 0; i < c; i++) {
        k->base_size[i] = greater(k->base_size[i], largest);
    }
}

void tribo_stick_slip_forget_gains(struct stick_slip *m)
{
    memset(m->noise.found, 0, m->noise.founds * sizeof *m->noise.found);
}

/* Returns noise.size[d], the size of the terms of q''_d; finds it first if it is 0. */
static double find_size(struct stick_slip *m, const tribo_system *sys, const double *y, size_t d)
{
    if (m->noise.size[d] > 0.0) {
        return m->noise.size[d];
    }
    if (sys->tables) {
        tribo_system_tables(sys, DRIVES_LOAD, 0, 1.0, d, d + 1, m->noise.size);
    }
    double size = m->constant.load_size[d] + fabs(m->noise.size[d]) + tribo_matrix_row_size(&sys->stiffness, d, y) +
                  tribo_matrix_row_size(&sys->response, d, m->state.force);
    size += sys->damping.rows ? tribo_matrix_row_size(&sys->damping, d, y + sys->ndof) : 0.0;
    size += sys->compliance.count ? tribo_matrix_row_size(&sys->compliance.pull, d, m->state.spring) : 0.0;
    return m->noise.size[d] = size;
}

double tribo_stick_slip_acceleration_size(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    double size = 0.0;
    for (size_t d = 0; d < sys->ndof; d++) {
        size = greater(size, find_size(m, sys, y, d));
    }
    return size;
}

void tribo_stick_slip_find_gain(struct stick_slip *m, const tribo_system *sys, const double *y, size_t i)
{
    const struct matrix *j = &sys->direction;
    double size = 0.0, speed = 0.0;
    if (m->noise.acceleration[i] > 0.0) {
        return;
    }
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        const size_t d = j->col[k];
        size += fabs(j->val[k] * find_size(m, sys, y, d));
        speed += fabs(j->val[k] * y[sys->ndof + d]);
    }
    m->noise.velocity[i] = tribo_stick_slip_velocity_noise(m, i, speed);
    m->noise.acceleration[i] = NOISE * m->noise.factor * (m->constant.base_rate_size[i] + size);
    m->noise.allowance[i] = TRIBO_ALLOWED * m->noise.acceleration[i] * m->constant.inertia[i];
    if (m->constant.swing[i] > 0.0) {
        m->noise.allowance[i] +=
            TRIBO_LIMIT_NOISE * m->noise.factor * tribo_breakaway_ratio(&m->breakaway, i) * m->constant.swing[i];
    }
    if (m->constant.base_moves) {
        m->noise.parting[i] =
            greater(4.0 * m->noise.factor * m->noise.velocity[i], m->noise.acceleration[i] * m->constant.horizon / LOOK_AHEAD);
    }
}

int tribo_stick_slip_is_faint(struct stick_slip *m, const tribo_system *sys, const double *y, size_t i)
{
    tribo_stick_slip_find_gain(m, sys, y, i);
    return fabs(tribo_stick_slip_velocity(m, sys, i, y)) <=
           TRIBO_VELOCITY_NOISE * m->noise.acceleration[i] * m->constant.horizon / LOOK_AHEAD;
}

void tribo_stick_slip_find_gains(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    for (size_t i = 0; i < sys->ncontact; i++) {
        tribo_stick_slip_find_gain(m, sys, y, i);
    }
}

/* -------------------------------------------------------------------------------------------------- one contact, as decided */

double tribo_stick_slip_follows(const struct stick_slip *m, size_t i)
{
    if (m->state.slip[i] == TRIBO_SLIP_STUCK) {
        const double ratio = tribo_breakaway_ratio(&m->breakaway, i);
        return m->state.holds[i] || !m->state.tied[i] ? 0.0 : m->state.force[i] > 0.0 ? ratio : -ratio;
    }
    return m->state.slip[i] == TRIBO_SLIP_OPEN ? 0.0 : -m->state.slip[i];
}

double tribo_stick_slip_margin(const struct stick_slip *m, size_t i)
{
    return tribo_breakaway_is_sudden(&m->breakaway, i) ? m->noise.allowance[i] : 0.0;
}

/* ------------------------------------------------------------------------------------------------------------ motion */

void tribo_stick_slip_find_free(struct stick_slip *m, tribo_system *sys, double t, const double *y)
{
    tribo_system_free_acceleration(sys, t, y, m->work.free);
    m->work.a = m->work.free;
    if (!sys->direction.identity || tribo_system_bases_move(sys)) {
        tribo_stick_slip_contact_accelerations(sys, m->work.free, 1, m->work.own_a);
        m->work.a = m->work.own_a;
    }
}

void tribo_stick_slip_contact_accelerations(const tribo_system *sys, const double *acceleration, int order, double *to)
{
    tribo_matrix_multiply(&sys->direction, acceleration, to);
    if (tribo_system_bases_move(sys)) {
        tribo_system_loads(sys, DRIVES_BASE, order, -1.0, to);
    }
}

const double *tribo_stick_slip_find_acceleration(struct stick_slip *m, const tribo_system *sys)
{
    memcpy(m->work.acceleration, m->work.free, sys->ndof * sizeof *m->work.free);
    tribo_matrix_multiply_add(&sys->response, 1.0, m->state.force, m->work.acceleration);
    return m->work.acceleration;
}

void tribo_stick_slip_find_rate(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    memset(m->work.rate, 0, sys->ndof * sizeof *m->work.rate);
    tribo_system_loads(sys, DRIVES_LOAD, 1, 1.0, m->work.rate);
    tribo_matrix_multiply_add(&sys->stiffness, -1.0, y + sys->ndof, m->work.rate);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, tribo_stick_slip_find_acceleration(m, sys), m->work.rate);
    }
    if (sys->compliance.count) {
        tribo_matrix_multiply_add(&sys->compliance.pull, 1.0, m->state.spring_rate, m->work.rate);
    }
}
