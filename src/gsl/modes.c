#include "modes.h"
#include "../real.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A balancing force this close to the limit counts as just at it: mostly far above rounding, and far below what a wrong guess
 * could change. */
#define AT_LIMIT 1e-9

/* Where a force only touches its limit, the time of that is known to the square root of rounding, and its rate to no more. */
#define STATIONARY 1e-7

/* Velocities and accelerations are known to this part of what they are the sum of. */
#define NOISE 2e-14

/* So many derivatives are asked when contacts are at their limit. */
#define ORDERS 4

int tribo_modes_create(struct modes *m, tribo_system *sys)
{
    const size_t c = sys->ncontact + 1, n = sys->ndof;
    memset(m, 0, sizeof *m);
    m->patience = 64 + 16 * sys->ncontact;
    int status = tribo_clone(sys->contacts, &m->judge);
    status = status ? status : tribo_clone(sys->contacts, &m->hold);
    /* a contact that has reached its limit stays there while others take over */
    status = status ? status : tribo_set_sharing(m->judge, TRIBO_SHARE_LAST);
    double *work = malloc((13 * c + (2 + 2 * ORDERS) * n + m->patience) * sizeof *work);
    m->mode = calloc(5, c);
    m->at = malloc(c * sizeof *m->at);
    m->limit = work;
    if (status || !work || !m->mode || !m->at) {
        tribo_modes_free(m);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the modes of %zu contacts", sys->ncontact);
    }
    m->weak = m->mode + c;
    m->holds = (unsigned char *)m->mode + 2 * c;
    m->rested = m->holds + c;
    m->before = m->mode + 4 * c;
    m->contacts = sys->ncontact;
    m->force = work + c;
    m->v = work + 2 * c;
    m->a = work + 3 * c;
    m->rate = work + 4 * c;
    m->lo = work + 5 * c;
    m->hi = work + 6 * c;
    m->diagonal = work + 7 * c;
    m->base = work + 8 * c;
    m->limit_rate = work + 9 * c;
    m->noise = work + 10 * c;
    m->slope = work + 11 * c;
    m->still = work + 12 * c;
    m->acceleration = work + 13 * c;
    memset(m->still, 0, c * sizeof *m->still);
    m->jerk = m->acceleration + n;
    m->size = m->jerk + ORDERS * n;
    m->recent = m->size + (1 + ORDERS) * n;
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->diagonal[i] = tribo_system_delassus(sys, i, i);
    }
    size_t islands;
    tribo_get_count(m->judge, TRIBO_COUNT_ISLANDS, &islands);
    m->uncoupled = islands == sys->ncontact;
    tribo_set_law(m->judge, TRIBO_COULOMB);
    tribo_set_coupling(m->judge, TRIBO_CONSISTENT);
    tribo_set_law(m->hold, TRIBO_COULOMB);
    tribo_set_coupling(m->hold, TRIBO_PARTITION);
    m->simple = 1;
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->simple &= sys->direction.first[i + 1] - sys->direction.first[i] <= 1;
    }
    return TRIBO_OK;
}

void tribo_modes_free(struct modes *m)
{
    tribo_destroy(m->judge);
    tribo_destroy(m->hold);
    free(m->limit);
    free(m->mode);
    free(m->at);
    free(m->order);
    free(m->block);
    free(m->last);
    memset(m, 0, sizeof *m);
}

/* What of the velocities may be rounding, as far as the state alone tells. */
static void find_noise(struct modes *m, const tribo_system *sys, const double *y)
{
    const struct matrix *j = &sys->direction;
    const double *u = y + sys->ndof;
    for (size_t i = 0; i < sys->ncontact; i++) {
        double size = fabs(m->base[i]);
        for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
            size += fabs(j->val[k] * u[j->col[k]]);
        }
        m->noise[i] = NOISE * size;
    }
}

static signed char mode_of_velocity(const struct modes *m, size_t i)
{
    return (signed char)(fabs(m->v[i]) <= m->noise[i] ? 0 : m->v[i] > 0.0 ? 1 : -1);
}

/* Brings limits, and with them which contacts are open, up to the time of v. */
static void update_limits(struct modes *m, const tribo_system *sys)
{
    if (sys->limits.knots) {
        tribo_system_limits(sys, m->limit, m->limit_rate);
        tribo_set_limit(m->judge, m->limit);
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (m->limit[i] == 0.0 && m->limit_rate[i] == 0.0) {
            m->mode[i] = 2;
        } else if (m->mode[i] == 2) {
            m->mode[i] = mode_of_velocity(m, i);
        }
    }
}

int tribo_modes_start(struct modes *m, tribo_system *sys, double t, double *y, int continues)
{
    tribo_system_free_motion(sys, t, y, m->acceleration, m->v, m->a);
    tribo_system_limits(sys, m->limit, m->limit_rate);
    tribo_set_limit(m->judge, m->limit);
    m->fresh = 1;
    memset(m->base, 0, sys->ncontact * sizeof *m->base);
    tribo_system_loads(sys, 1, 0, 1.0, m->base);
    find_noise(m, sys, y);
    for (size_t i = 0; !continues && i < sys->ncontact; i++) {
        m->mode[i] = (signed char)(m->limit[i] == 0.0 ? 2 : mode_of_velocity(m, i));
    }
    m->events = 0;
    return tribo_modes_decide(m, sys, t, y);
}

/* Bounds for the rates of forces (order 1) or their further derivatives: sliding ones follow their limit, those at their limit
 * and not decided about yet may not go beyond. */
static void set_rate_bounds(struct modes *m, size_t c, int order, double bound)
{
    for (size_t i = 0; i < c; i++) {
        const int rests = m->mode[i] == 0;
        const double side = !rests ? -m->mode[i] : m->force[i] > 0.0 ? 1.0 : -1.0;
        const double along = m->mode[i] == 2 || order > 1 ? 0.0 : side * m->limit_rate[i];
        m->lo[i] = rests && !(m->weak[i] == 1 && side < 0.0) ? -bound : along;
        m->hi[i] = rests && !(m->weak[i] == 1 && side > 0.0) ? bound : along;
    }
}

/* The rates that go with accelerations' rates a. scale is what they are like. */
static int solve_rates(struct modes *m, const tribo_system *sys, int order, double scale)
{
    int beyond = 1;
    double bound = scale;
    /* the box wants bounds where there are none; if they matter, they were too narrow */
    for (int round = 0; round < 4 && beyond; round++) {
        bound *= 1e3;
        set_rate_bounds(m, sys->ncontact, order, bound);
        const int status = tribo_solve_box(m->judge, m->a, m->lo, m->hi, m->rate);
        if (status) {
            return tribo_system_fail(sys, status, "%s", tribo_message(m->judge));
        }
        beyond = 0;
        for (size_t i = 0; i < sys->ncontact; i++) {
            beyond |= m->mode[i] == 0 && fabs(m->rate[i]) >= bound && bound > 0.0;
        }
    }
    return TRIBO_OK;
}

static void add_sizes(const struct matrix *a, const double *x, double *y)
{
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            y[i] += fabs(a->val[k] * x[a->col[k]]);
        }
    }
}

/* The same for the order-th derivatives of the loads, or of b. */
static void add_amplitudes(const tribo_system *sys, int moves_base, int order, double *y)
{
    for (size_t s = 0; s < sys->harmonics; s++) {
        const struct harmonic *w = &sys->harmonic[s];
        const double rate = pow(fabs(w->omega), order);
        for (size_t k = 0; w->moves_base == moves_base && k < w->count; k++) {
            y[w->index[k]] += rate * (fabs(w->cosine[k]) + fabs(w->sine[k]));
        }
    }
}

/* What the order-th derivatives of q'' are like, to tell rounding from what they are: the sum of the sizes of their parts but
 * friction. load is that of the load; older and old are the sizes of the two derivatives of q before. */
static void find_sizes(const tribo_system *sys, int order, const double *load, const double *older, const double *old,
                       double *size)
{
    for (size_t d = 0; d < sys->ndof; d++) {
        size[d] = fabs(load[d]);
    }
    add_amplitudes(sys, 0, order, size);
    add_sizes(&sys->stiffness, older, size);
    if (sys->damping.rows) {
        add_sizes(&sys->damping, old, size);
    }
}

/* |J| size and the order-th derivative of b: what accelerations of contacts take without friction, in lo. Returns the largest,
 * and in force the largest force that would take. */
static double contact_scales(struct modes *m, const tribo_system *sys, int order, const double *size, double *force)
{
    double most = 0.0;
    *force = 0.0;
    memset(m->lo, 0, sys->ncontact * sizeof *m->lo);
    add_sizes(&sys->direction, size, m->lo);
    add_amplitudes(sys, 1, order, m->lo);
    for (size_t i = 0; i < sys->ncontact; i++) {
        most = greater(most, m->lo[i]);
        *force = greater(*force, m->diagonal[i] > 0.0 ? m->lo[i] / m->diagonal[i] : 0.0);
    }
    return most;
}

/* Of the contacts at their limit, those slide off whose rate of f_eq would take it beyond the limit, and those keep hold that it
 * takes back inside; if it does neither, the next derivative decides. */
static int decide_by_rates(struct modes *m, tribo_system *sys, const double *y)
{
    const size_t n = sys->ndof, c = sys->ncontact;
    const double *older = y + n, *old = m->acceleration, *older_size = older, *old_size = m->size;
    size_t undecided = 1;
    memset(m->jerk, 0, n * sizeof *m->jerk);
    tribo_system_loads(sys, 0, 0, 1.0, m->jerk);
    find_sizes(sys, 0, m->jerk, y, older, m->size);
    add_sizes(&sys->response, m->force, m->size);
    for (int order = 1; order <= ORDERS && undecided; order++) {
        double *next = m->jerk + (size_t)(order - 1) * n, *size = m->size + (size_t)order * n;
        memset(next, 0, n * sizeof *next);
        memset(m->a, 0, c * sizeof *m->a);
        tribo_system_loads(sys, 0, order, 1.0, next);
        double scale;
        find_sizes(sys, order, next, older, old, size);
        double most = contact_scales(m, sys, order + 1, size, &scale);
        find_sizes(sys, order, next, older_size, old_size, size);
        contact_scales(m, sys, order + 1, size, &scale);
        tribo_matrix_multiply_add(&sys->stiffness, -1.0, older, next);
        if (sys->damping.rows) {
            tribo_matrix_multiply_add(&sys->damping, -1.0, old, next);
        }
        tribo_system_loads(sys, 1, order + 1, -1.0, m->a);
        tribo_matrix_multiply_add(&sys->direction, 1.0, next, m->a);
        for (size_t i = 0; i < c; i++) {
            m->slope[i] = order == 1 ? m->a[i] : m->slope[i];
            scale = greater(scale, order == 1 ? fabs(m->limit_rate[i]) : 0.0);
        }
        const int status = solve_rates(m, sys, order, scale);
        if (status) {
            return status;
        }
        tribo_matrix_multiply_add(&sys->response, 1.0, m->rate, next);
        add_sizes(&sys->response, m->rate, size);
        memset(m->a, 0, c * sizeof *m->a);
        tribo_system_loads(sys, 1, order + 1, -1.0, m->a);
        tribo_matrix_multiply_add(&sys->direction, 1.0, next, m->a);
        memset(m->lo, 0, c * sizeof *m->lo);
        add_sizes(&sys->direction, size, m->lo);
        for (size_t i = 0; i < c; i++) {
            most = greater(most, fabs(m->a[i]));
        }
        undecided = 0;
        for (size_t i = 0; i < c; i++) {
            const double slow = greater(STATIONARY * lesser(m->diagonal[i] * scale, most), NOISE * m->lo[i]);
            const double side = m->force[i] > 0.0 ? -1.0 : 1.0;
            const double along = order == 1 ? -side * m->limit_rate[i] : 0.0;
            if (m->weak[i] == 1 && side * m->a[i] > slow) {
                m->mode[i] = (signed char)side;
                m->force[i] = -side * m->limit[i];
                m->weak[i] = 0;
            } else if (m->weak[i] == 1 && side * (m->rate[i] - along) > STATIONARY * scale) {
                m->weak[i] = 2;
            }
            undecided += m->weak[i] == 1;
        }
        older = old;
        old = next;
        older_size = old_size;
        old_size = size;
    }
    return TRIBO_OK;
}

/* How far beyond its limit (hi), or below it (lo), a balancing force may be and still count as just at it: a small part of the
 * limit, or what rounding of all the forces on the contact's bodies comes to. Beyond the limit it accelerates the contact's own
 * bodies: then of a light one between heavy ones even a small part of the limit would be an acceleration that these never have.
 * Below it holds all bodies that rest on each other, and a lack of it shows in what the heavy ones do. rate holds f_eq. */
static void find_margins(struct modes *m, const tribo_system *sys)
{
    double most = DBL_MIN, noise = 0.0, force = 0.0;
    for (size_t d = 0; d < sys->ndof; d++) {
        m->jerk[d] = fabs(m->acceleration[d]);
    }
    memset(m->lo, 0, sys->ncontact * sizeof *m->lo);
    memset(m->hi, 0, sys->ncontact * sizeof *m->hi);
    add_sizes(&sys->direction, m->jerk, m->lo);
    add_sizes(&sys->response, m->force, m->jerk);
    add_sizes(&sys->direction, m->jerk, m->hi);
    for (size_t i = 0; i < sys->ncontact; i++) {
        most = greater(most, fabs(m->a[i]) + m->lo[i]);
        noise = greater(noise, NOISE * m->hi[i]);
        force = greater(force, fabs(m->force[i]));
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double limit = m->limit[i], r = m->diagonal[i];
        if (m->mode[i] != 0 || (fabs(m->rate[i]) < 0.5 * limit && NOISE * m->hi[i] < 0.5 * limit * r)) {
            m->hi[i] = m->lo[i] = 0.0; /* moves, or is so far inside that no margin matters */
            continue;
        }
        m->hi[i] = r > 0.0 ? greater(AT_LIMIT * lesser(limit, most / r), NOISE * m->hi[i] / r) : AT_LIMIT * limit;
        m->lo[i] = greater(greater(m->hi[i], AT_LIMIT * limit), lesser(STATIONARY * limit, noise / most * force));
    }
}

/* A contact that friction cannot move is at rest for a moment only, unless b is: it goes where b's first derivative that is not
 * zero takes it. Returns that direction. */
static signed char driven_direction(struct modes *m, const tribo_system *sys, size_t i)
{
    for (int order = 1; order <= ORDERS; order++) {
        memset(m->a, 0, sys->ncontact * sizeof *m->a);
        memset(m->lo, 0, sys->ncontact * sizeof *m->lo);
        tribo_system_loads(sys, 1, order, -1.0, m->a);
        add_amplitudes(sys, 1, order, m->lo);
        if (fabs(m->a[i]) > AT_LIMIT * m->lo[i]) {
            return m->a[i] > 0.0 ? 1 : -1;
        }
    }
    return 0;
}

/* Forces and accelerations with the contacts at rest as they are marked, and what the forces say about them. */
static int decide_by_forces(struct modes *m, tribo_system *sys, double t, const double *y)
{
    tribo_system_set_time(sys, t);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (m->mode[i] == 0 && m->diagonal[i] == 0.0) {
            m->mode[i] = driven_direction(m, sys, i);
        }
    }
    tribo_system_free_motion(sys, t, y, m->acceleration, m->v, m->a);
    update_limits(m, sys);
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->v[i] = m->mode[i] == 2 ? 0.0 : m->mode[i];
    }
    const int status = tribo_balance(m->judge, m->v, m->a, m->rate, m->force);
    if (status) {
        return tribo_system_fail(sys, status, "at t = %.17g: %s", t, tribo_message(m->judge));
    }
    int weak = 0;
    tribo_matrix_multiply_add(&sys->response, 1.0, m->force, m->acceleration);
    find_margins(m, sys);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double feq = m->rate[i], limit = m->limit[i];
        m->weak[i] = 0;
        if (m->mode[i] == 0 && fabs(feq) > limit + m->hi[i]) {
            m->mode[i] = feq > 0.0 ? -1 : 1;
        } else if (m->mode[i] == 0 && fabs(feq) >= limit - m->lo[i]) {
            m->weak[i] = 1;
            weak = 1;
        }
    }
    return weak ? decide_by_rates(m, sys, y) : TRIBO_OK;
}

int tribo_modes_balance(struct modes *m, const double *a, double *f)
{
    for (size_t i = 0; m->uncoupled && i < m->contacts; i++) {
        f[i] = m->holds[i] ? -a[i] / m->diagonal[i] : 0.0;
    }
    return m->uncoupled ? TRIBO_OK : tribo_balance(m->hold, m->still, a, f, NULL);
}

/* Room for what choose_holds needs for so many contacts. */
static int make_room(struct modes *m, size_t rest)
{
    if (rest <= m->room) {
        return 1;
    }
    free(m->order);
    free(m->block);
    free(m->last);
    m->order = malloc(rest * sizeof *m->order);
    m->block = malloc(rest * rest * sizeof *m->block);
    m->last = malloc(rest);
    m->room = m->order && m->block && m->last ? rest : 0;
    return m->room > 0;
}

/* Marks an independent set of the contacts at rest, those named at, as holding; rather such that are inside their limits, or go
 * there. */
static int choose_holds(struct modes *m, const tribo_system *sys, size_t rest)
{
    if (!make_room(m, rest)) {
        return 0;
    }
    for (size_t p = 0; p < rest; p++) {
        const signed char weak = m->weak[m->at[p]];
        m->last[p] = (unsigned char)(weak == 0 ? 0 : weak == 2 ? 1 : 2);
        m->holds[m->at[p]] = 1;
        for (size_t q = 0; q < rest; q++) {
            m->block[p * rest + q] = tribo_system_delassus(sys, m->at[p], m->at[q]);
        }
    }
    for (size_t k = tribo_independent_rows(m->block, rest, m->last, m->order); k < rest; k++) {
        m->holds[m->at[m->order[k]]] = 0;
    }
    return 1;
}

/* A contact that holds, but would go beyond its limit while those that do not hold keep their forces; ncontact if there is none.
 */
static size_t misplaced(struct modes *m)
{
    int inward = 0;
    for (size_t i = 0; i < m->contacts; i++) {
        inward |= m->holds[i] && m->weak[i] == 2;
    }
    if (!inward || tribo_modes_balance(m, m->slope, m->rate) != TRIBO_OK) {
        return m->contacts;
    }
    for (size_t i = 0; i < m->contacts; i++) {
        const double side = m->force[i] > 0.0 ? 1.0 : -1.0;
        if (m->holds[i] && m->weak[i] == 2 && side * m->rate[i] > m->limit_rate[i]) {
            return i;
        }
    }
    return m->contacts;
}

/* Which of the contacts at rest hold. */
static int find_holds(struct modes *m, const tribo_system *sys)
{
    const size_t c = sys->ncontact;
    size_t rest = 0, changes = 0;
    for (size_t i = 0; i < c; i++) {
        const signed char now = (signed char)(m->mode[i] == 0 ? 1 + m->weak[i] : 0);
        changes += now != m->before[i];
        m->before[i] = now;
        m->at[rest] = i;
        rest += m->mode[i] == 0 && m->diagonal[i] > 0.0;
    }
    if (changes == 0 && !m->fresh) {
        return TRIBO_OK;
    }
    m->fresh = 0;
    size_t found = c;
    do {
        for (size_t i = 0; i < c; i++) {
            m->holds[i] = m->mode[i] == 0 && m->diagonal[i] > 0.0;
        }
        if (m->uncoupled) {
            break;
        }
        if (rest > 1 && !choose_holds(m, sys, rest)) {
            return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for %zu contacts at rest", rest);
        }
        for (size_t i = 0; i < c; i++) {
            m->lo[i] = m->holds[i] ? 1.0 : 0.0;
        }
        tribo_set_limit(m->hold, m->lo);
        found = misplaced(m);
        if (found < c) {
            m->weak[found] = 1;
        }
    } while (found < c);
    return TRIBO_OK;
}

/* 1 if J x - base is more than the rounding of x for a contact that holds. */
static int moves(struct modes *m, const tribo_system *sys, const double *base, const double *x)
{
    const struct matrix *j = &sys->direction;
    for (size_t i = 0; i < m->contacts; i++) {
        double sum = -base[i], size = fabs(base[i]);
        for (size_t k = m->holds[i] ? j->first[i] : j->first[i + 1]; k < j->first[i + 1]; k++) {
            sum += j->val[k] * x[j->col[k]];
            size += fabs(j->val[k] * x[j->col[k]]);
        }
        if (m->holds[i] && fabs(sum) > 4.0 * DBL_EPSILON * size) {
            return 1;
        }
    }
    return 0;
}

/* First the last bits of simple contacts; then, if there is more, x -= B_I R_II^-1 (J_I x - base), twice, since the first time
 * leaves rounding of what it takes away. */
int tribo_modes_hold(struct modes *m, const tribo_system *sys, const double *base, double *x)
{
    tribo_system_snap(sys, m->mode, base, x);
    if (m->simple || !moves(m, sys, base, x)) {
        return TRIBO_OK;
    }
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < m->contacts; i++) {
            m->a[i] = -base[i];
        }
        tribo_matrix_multiply_add(&sys->direction, 1.0, x, m->a);
        const int status = tribo_modes_balance(m, m->a, m->rate);
        if (status) {
            return tribo_system_fail(sys, status, "%s", tribo_message(m->hold));
        }
        tribo_matrix_multiply_add(&sys->response, 1.0, m->rate, x);
    }
    tribo_system_snap(sys, m->mode, base, x);
    return TRIBO_OK;
}

int tribo_modes_decide(struct modes *m, tribo_system *sys, double t, double *y)
{
    double *u = y + sys->ndof;
    memset(m->base, 0, sys->ncontact * sizeof *m->base);
    tribo_system_set_time(sys, t);
    tribo_system_loads(sys, 1, 0, 1.0, m->base);
    memset(m->weak, 0, sys->ncontact);
    int status = TRIBO_OK;
    size_t found = 1;
    /* whoever has no velocity is decided about, also those that another contact now holds, or that have only just been let go */
    while (!status && found) {
        status = find_holds(m, sys);
        status = status ? status : tribo_modes_hold(m, sys, m->base, u);
        found = 0;
        for (size_t i = 0; !status && i < sys->ncontact; i++) {
            if ((m->mode[i] == 1 || m->mode[i] == -1) && fabs(tribo_modes_velocity(m, sys, i, y)) <= m->noise[i]) {
                m->mode[i] = 0;
                found++;
            }
        }
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->v[i] = tribo_modes_velocity(m, sys, i, y);
        m->rested[i] = m->mode[i] == 0;
    }
    status = status ? status : decide_by_forces(m, sys, t, y);
    return status ? status : find_holds(m, sys);
}

double tribo_modes_velocity(const struct modes *m, const tribo_system *sys, size_t i, const double *y)
{
    const struct matrix *j = &sys->direction;
    double v = -m->base[i];
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        v += j->val[k] * y[sys->ndof + j->col[k]];
    }
    return v;
}

int tribo_modes_proceed(struct modes *m, tribo_driver *drv, const struct search *search, const struct guard *event, double t,
                        double *y, double shortest)
{
    for (size_t k = 0; k < search->guards; k++) {
        const struct guard *g = &search->guard[k];
        m->noise[g->contact] = g->offset == 0.0 ? NOISE * g->size : m->noise[g->contact];
    }
    if (event) {
        const size_t slot = m->events++ % m->patience;
        drv->events++;
        if (m->events > m->patience && t - m->recent[slot] < 1e-6 * shortest) {
            return tribo_driver_fail(drv, TRIBO_ERR_CHATTER,
                                     "%zu events up to t = %.17g took no time, the last one of contact %zu", m->patience, t,
                                     event->contact);
        }
        m->recent[slot] = t;
        if (event->offset == 0.0) {
            m->mode[event->contact] = 0;
        }
    }
    const int status = tribo_modes_decide(m, drv->sys, t, y);
    return status ? tribo_driver_fail(drv, status, "%s", tribo_message(drv->sys->contacts)) : TRIBO_OK;
}
