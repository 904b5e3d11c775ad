/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions of time: loads on the structure, motions of bases, limits. */
#include "cos_sin.h"
#include "system.h"
#include "common/layout.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns the length of a function of time: of accelerations, or of values of contacts. */
static size_t length_of(const tribo_system *sys, enum drives drives)
{
    return drives == DRIVES_LOAD ? sys->ndof : sys->ncontact;
}

/* Allocates the arrays of h, of h->count entries and h->knots knots; copies them from the block `from` of equal arrays (NULL:
 * leaves them unset). Returns 0 if out of memory. */
static int create_harmonic(struct harmonic *h, const void *from)
{
    const int done = ALLOCATE(ARRAY(h->index, h->count), ARRAY(h->cosine, h->count), ARRAY(h->sine, h->count),
                              ARRAY(h->knot, h->knots), ARRAY(h->value, h->knots * h->columns)) != NULL;
    if (done && from) {
        memcpy(h->index, from, (size_t)((char *)(h->value + h->knots * h->columns) - (char *)h->index));
    }
    return done;
}

void tribo_loads_free(tribo_system *sys)
{
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        free(sys->loads.harmonic[k].index);
    }
    free(sys->loads.harmonic);
}

/* Counts the functions of time, of which some were added or removed. */
static void loads_changed(tribo_system *sys)
{
    struct loads *l = &sys->loads;
    l->tables = l->bases = l->limits = l->limit_tables = 0;
    for (size_t k = 0; k < l->harmonics; k++) {
        const struct harmonic *h = &l->harmonic[k];
        l->tables += h->knots > 0;
        l->bases += h->drives == DRIVES_BASE;
        l->limits += h->drives == DRIVES_LIMIT;
        l->limit_tables += h->drives == DRIVES_LIMIT && h->knots > 0;
    }
    sys->revision++;
    l->time = NAN;
}

int tribo_loads_copy(tribo_system *sys, const tribo_system *from)
{
    struct loads *l = &sys->loads;
    l->harmonic = malloc((from->loads.harmonics + 1) * sizeof *l->harmonic);
    int done = l->harmonic != NULL;
    for (; done && l->harmonics < from->loads.harmonics; l->harmonics++) {
        struct harmonic *h = &l->harmonic[l->harmonics];
        *h = from->loads.harmonic[l->harmonics];
        done = create_harmonic(h, h->index);
    }
    loads_changed(sys);
    return done;
}

int tribo_loads_copy_first(tribo_system *sys, const tribo_system *from)
{
    const int done = tribo_loads_copy(sys, from);
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        struct harmonic *h = &sys->loads.harmonic[k];
        while (h->count && h->index[h->count - 1] >= length_of(sys, h->drives)) {
            h->count--;
        }
    }
    return done;
}

/* ------------------------------------------------------------------------------------------------------------------ at a time */

/* Returns the last knot of a table at or before t; 0 if there is none. */
static size_t knot_at(const struct harmonic *h, double t)
{
    size_t lo = 0, end = h->knots;
    while (end > lo + 1) {
        const size_t mid = lo + (end - lo) / 2;
        *(h->knot[mid] <= t ? &lo : &end) = mid;
    }
    return lo;
}

/* Returns value (order 0), slope (order 1) or 0 of column i of a table at the set time. h->at: the last knot at or before it. */
static double look_up(const tribo_system *sys, const struct harmonic *h, size_t i, int order)
{
    const size_t k = h->at;
    const double *v = h->value + k * h->columns + i;
    if (order > 1 || k + 1 == h->knots || sys->loads.time < h->knot[0]) {
        return order ? 0.0 : *v;
    }
    const double slope = (v[h->columns] - v[0]) / (h->knot[k + 1] - h->knot[k]);
    return order ? slope : v[0] + slope * (sys->loads.time - h->knot[k] + sys->loads.low);
}

double tribo_system_table(const tribo_system *sys, size_t k, size_t i, double *slope)
{
    *slope = look_up(sys, &sys->loads.harmonic[k], i, 1);
    return look_up(sys, &sys->loads.harmonic[k], i, 0);
}

void tribo_system_put_limits(tribo_system *sys, double later)
{
    tribo_system_limits(sys, sys->work.put_limit, sys->work.feq);
    for (size_t i = 0; i < sys->ncontact; i++) {
        sys->work.put_limit[i] = clamp(sys->work.put_limit[i] + later * sys->work.feq[i], 0.0, DBL_MAX);
    }
    tribo_set_limit(sys->contacts, sys->work.put_limit);
}

void tribo_system_set_low(tribo_system *sys, double low)
{
    if (low != sys->loads.low) {
        sys->loads.low = low;
        sys->loads.time = NAN;
    }
}

void tribo_system_turn_to(tribo_system *sys, double t)
{
    sys->loads.time = t;
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        struct harmonic *const h = sys->loads.harmonic + k;
        if (h->knots == 0) {
            tribo_cos_sin(h->omega, t, sys->loads.low, &h->cos_t, &h->sin_t);
        } else {
            h->at = knot_at(h, t);
            h->cos_t = look_up(sys, h, 0, 0);
        }
    }
    if (tribo_system_limits_vary(sys)) {
        tribo_system_put_limits(sys, 0.0);
    }
}

double tribo_system_load_frequency(const tribo_system *sys)
{
    double most = 0.0;
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        most = greater(most, fabs(sys->loads.harmonic[k].omega));
    }
    return most;
}

double tribo_system_next_kink(const tribo_system *sys, double t)
{
    double next = HUGE_VAL;
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        const struct harmonic *h = &sys->loads.harmonic[k];
        size_t i = knot_at(h, t);
        while (i < h->knots && !(h->knot[i] > t || (h->knot[i] == t && sys->loads.low < 0.0))) {
            i++;
        }
        next = i < h->knots ? lesser(next, h->knot[i]) : next;
    }
    return next;
}

/* *c, *s = order-th derivatives at the set time of cos(omega t) and sin(omega t); of a table, *c of its value for entry e. */
static inline void loads_differentiate(const tribo_system *sys, size_t k, size_t e, int order, double *c, double *s)
{
    const struct harmonic *h = &sys->loads.harmonic[k];
    if (h->knots) {
        *c = h->columns > 1 || order ? look_up(sys, h, h->columns > 1 ? e : 0, order) : h->cos_t;
        *s = 0.0;
        return;
    }
    *c = h->cos_t;
    *s = h->sin_t;
    if (order) {
        double power = order & 2 ? -1.0 : 1.0;
        for (int d = 0; d < order; d++) {
            power *= h->omega;
        }
        *c = power * (order & 1 ? -h->sin_t : h->cos_t);
        *s = power * (order & 1 ? h->cos_t : h->sin_t);
    }
}

void tribo_loads_keep_constant(tribo_system *sys)
{
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        struct harmonic *const h = sys->loads.harmonic + k;
        h->count = h->omega != 0.0 ? 0 : h->count;
    }
}

void tribo_system_loads(const tribo_system *sys, enum drives drives, int order, double factor, double *to)
{
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        const struct harmonic *h = &sys->loads.harmonic[k];
        double c, s;
        if (h->drives != drives) {
            continue;
        }
        loads_differentiate(sys, k, 0, order, &c, &s);
        for (size_t e = 0; e < h->count; e++) {
            c = h->columns > 1 ? look_up(sys, h, e, order) : c;
            to[h->index[e]] += factor * (h->cosine[e] * c + h->sine[e] * s);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------------- limits */

void tribo_system_limits(const tribo_system *sys, double *limit, double *rate)
{
    for (size_t i = 0; i < sys->ncontact; i++) {
        limit[i] = tribo_system_steady_limit(sys, i);
        rate[i] = 0.0;
    }
    tribo_system_loads(sys, DRIVES_LIMIT, 0, 1.0, limit);
    tribo_system_loads(sys, DRIVES_LIMIT, 1, 1.0, rate);
    tribo_normals_limits(sys, limit, rate);
}

double tribo_system_swing(const tribo_system *sys, size_t i)
{
    double sum = 0.0;
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        const struct harmonic *h = &sys->loads.harmonic[k];
        sum += h->drives == DRIVES_LIMIT && !h->knots ? hypot(h->cosine[i], h->sine[i]) : 0.0;
    }
    return sum;
}

int tribo_system_varies_limit(const tribo_system *sys, size_t i, size_t j)
{
    int varies = 0;
    double off = i == j || !sys->loads.limits ? 0.0 : fabs(tribo_system_steady_limit(sys, i) - tribo_system_steady_limit(sys, j));
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        const struct harmonic *h = &sys->loads.harmonic[k];
        if (h->drives == DRIVES_LIMIT) {
            varies |= h->knots || h->cosine[i] != 0.0 || h->sine[i] != 0.0 || h->cosine[j] != 0.0 || h->sine[j] != 0.0;
            off += fabs(h->cosine[i] - h->cosine[j]) + fabs(h->sine[i] - h->sine[j]);
            for (size_t p = 0; p < h->knots; p++) {
                off += fabs(h->value[p * h->columns + i] - h->value[p * h->columns + j]);
            }
        }
    }
    return varies && (i == j || off > 0.0);
}

void tribo_system_most_limits(const tribo_system *sys, double *most)
{
    for (size_t i = 0; i < sys->ncontact; i++) {
        most[i] = tribo_system_steady_limit(sys, i);
        for (size_t k = 0; k < sys->loads.harmonics; k++) {
            const struct harmonic *h = &sys->loads.harmonic[k];
            for (size_t p = 0; h->drives == DRIVES_LIMIT && p < h->knots; p++) {
                most[i] = greater(most[i], h->value[p * h->columns + i]);
            }
        }
        most[i] += tribo_system_swing(sys, i);
    }
}

/* A limit is 0 if its derivatives of order 0 to DERIVATIVES - 1 are all rounding. */
#define DERIVATIVES 9

int tribo_system_presses(const tribo_system *sys, size_t i, double doubt)
{
    for (int order = 0; order < DERIVATIVES; order++) {
        double sum = order ? 0.0 : tribo_system_steady_limit(sys, i), size = fabs(sum);
        for (size_t k = 0; k < sys->loads.harmonics; k++) {
            const struct harmonic *h = &sys->loads.harmonic[k];
            double c, s;
            if (h->drives == DRIVES_LIMIT) {
                loads_differentiate(sys, k, i, order, &c, &s);
                sum += h->cosine[i] * c + h->sine[i] * s;
                size += h->knots ? fabs(c) : hypot(h->cosine[i], h->sine[i]) * hypot(c, s);
            }
        }
        if (fabs(sum) > TRIBO_LIMIT_NOISE * doubt * size) {
            return sum > 0.0;
        }
    }
    return 0;
}

/* ------------------------------------------------------------------------------------------------------------------- checks */

/* Checks x, amplitudes of loads, bases or limits in the caller's coordinates, or NULL. Returns TRIBO_ERR_UNSUPPORTED for a load on
 * a degree of freedom without mass, or the varying limit of a compliant contact, of a normal, or of a contact that has one. */
static int check_pattern(const tribo_system *sys, enum drives drives, const char *name, const double *x)
{
    const size_t *place = sys->reduced.modes ? NULL : sys->expansion.place;
    const size_t n = drives == DRIVES_LOAD ? sys->reduced.given : sys->ncontact;
    int status = tribo_check_array(sys->message, FINITE, name, x, n);
    for (size_t i = 0; x && drives != DRIVES_BASE && !status && i < n; i++) {
        const int load = drives == DRIVES_LOAD;
        const char *why = load ? (place && place[i] >= sys->ndof ? "has no mass, and takes no load" : NULL)
                          : tribo_is_compliant(&sys->compliance, i) ? "is elastic, and its limit must be constant"
                          : tribo_normals_follower(sys, i)          ? "has a limit that follows its normal load"
                          : tribo_normals_at(sys, i)                ? "is a normal direction, without friction"
                                                                    : NULL;
        if (why && x[i] != 0.0) {
            status = tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                                 load ? "%s[%zu] = %g, but degree of freedom %zu %s" : "%s[%zu] = %g, but contact %zu %s", name,
                                 i, x[i], i, why);
        }
    }
    return status;
}

/* Largest limit; keeps results computed from limits finite. */
#define MOST_LIMIT 1e300

/* Returns TRIBO_OK if knots ascend, and the values, called name, are finite; limits >= 0, and 0 of compliant contacts. */
static int check_table(const tribo_system *sys, const struct harmonic *h, const char *name)
{
    const double *time = h->knot, *value = h->value;
    const size_t n = h->columns;
    if (!h->knots || !time || !value) {
        return h->knots ? tribo_error(sys->message, TRIBO_ERR_NULL, "%s is NULL", time ? name : "time")
                        : tribo_error(sys->message, TRIBO_ERR_SIZE, "knots = 0");
    }
    int status = tribo_check_array(sys->message, FINITE, "time", time, h->knots);
    for (size_t k = 1; !status && k < h->knots; k++) {
        if (time[k] <= time[k - 1]) {
            status = tribo_error(sys->message, TRIBO_ERR_RANGE, "time[%zu] = %.17g is not after time[%zu] = %.17g", k, time[k],
                                 k - 1, time[k - 1]);
        }
    }
    if (status || h->drives != DRIVES_LIMIT) {
        return status ? status : tribo_check_array(sys->message, FINITE, name, value, h->knots);
    }
    for (size_t k = 0; !status && k < h->knots * n; k++) {
        status =
            tribo_check_number(sys->message, NOT_NEGATIVE, value[k], "limit[%zu] = %g of contact %zu", k / n, value[k], k % n);
    }
    for (size_t k = 0; !status && k < h->knots; k++) {
        status = check_pattern(sys, DRIVES_LIMIT, name, value + k * n);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------------ add and remove */

/* Removes the functions that drive loads, bases or limits; tables = 1: tables only. */
static void remove_driven(struct loads *l, enum drives drives, int tables)
{
    size_t left = 0;
    for (size_t k = 0; k < l->harmonics; k++) {
        struct harmonic *h = &l->harmonic[k];
        if ((h->by_load ? DRIVES_LOAD : h->drives) == drives && (h->knots || !tables)) {
            free(h->index);
        } else {
            l->harmonic[left++] = *h;
        }
    }
    l->harmonics = left;
}

/* Appends a function of time like h, unless it is 0, or replaces the table of limits. parts [2][n]: cosine and sine, of which
 * entries that are both 0 are left out; limits have all entries, so that the index is the contact. Returns 0 if out of memory. */
static int append_harmonic(tribo_system *sys, struct harmonic h, const double *parts)
{
    const size_t n = length_of(sys, h.drives);
    const double *time = h.knot, *value = h.value;
    struct loads *l = &sys->loads;
    for (size_t i = 0; i < n; i++) {
        h.count += parts[i] != 0.0 || parts[n + i] != 0.0 || h.drives == DRIVES_LIMIT;
    }
    if (h.count == 0) {
        return 1;
    }
    struct harmonic *all = realloc(l->harmonic, (l->harmonics + 1) * sizeof *all);
    l->harmonic = all ? all : l->harmonic;
    if (!all || !create_harmonic(&h, NULL)) {
        return 0;
    }
    for (size_t i = 0, e = 0; e < h.count; i++) {
        if (parts[i] != 0.0 || parts[n + i] != 0.0 || h.drives == DRIVES_LIMIT) {
            h.index[e] = i;
            h.cosine[e] = parts[i];
            h.sine[e++] = parts[n + i];
        }
    }
    if (h.knots) {
        memcpy(h.knot, time, h.knots * sizeof *time);
        memcpy(h.value, value, h.knots * h.columns * sizeof *value);
    }
    if (h.knots && h.drives == DRIVES_LIMIT) {
        remove_driven(l, DRIVES_LIMIT, 1);
    }
    all[l->harmonics++] = h;
    loads_changed(sys);
    return 1;
}

/* Adds a function of time like h, cosine and sine in the caller's coordinates, or NULL. Displacements of compliant contacts by a
 * load, way [2][ncontact], become a base motion b = -d(way)/dt, so that v includes d(way)/dt. Returns a status. */
static int take_harmonic(tribo_system *sys, struct harmonic h, const double *cosine, const double *sine)
{
    const size_t n = length_of(sys, h.drives), c = sys->ncontact, before = sys->loads.harmonics;
    double *parts = tribo_zeros(2 * n + 4 * c + 1, sizeof *parts), *way = parts ? parts + 2 * n : NULL;
    for (size_t part = 0; parts && part < 2; part++) {
        const double *from = part ? sine : cosine;
        if (from && h.drives != DRIVES_LOAD) {
            memcpy(parts + part * n, from, n * sizeof *parts);
        } else if (from) {
            tribo_system_accelerate(sys, from, parts + part * n, way + part * c);
        }
    }
    for (size_t i = 0; parts && h.knots && h.drives == DRIVES_LIMIT && i < n; i++) {
        parts[i] = 1.0;
    }
    if (parts && h.knots && tribo_largest(way, c) > 0.0) {
        free(parts);
        return tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                           "the load of a table bends what is reduced to compliance: take TRIBO_STATICS_MASS");
    }
    int done = parts && append_harmonic(sys, h, parts);
    if (done && tribo_largest(way, 2 * c) * fabs(h.omega) > 0.0) {
        double *base = way + 2 * c;
        for (size_t i = 0; i < c; i++) {
            base[i] = -h.omega * way[c + i];
            base[c + i] = h.omega * way[i];
        }
        done = append_harmonic(sys, (struct harmonic){.drives = DRIVES_BASE, .omega = h.omega, .by_load = 1}, base);
        if (!done && sys->loads.harmonics > before) {
            free(sys->loads.harmonic[--sys->loads.harmonics].index);
        }
    }
    free(parts);
    return done
               ? TRIBO_OK
               : tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for a function of time of %zu value%s", n, plural(n));
}

/* Checks and adds a function of time; table: name of the values of a table, NULL: a harmonic. Returns a status. */
static int loads_add(tribo_system *sys, struct harmonic h, const char *table, const double *cosine, const double *sine)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    int status = table ? check_table(sys, &h, table) : tribo_check_number(sys->message, FINITE, h.omega, "omega = %g", h.omega);
    status = status || !table || h.drives == DRIVES_LIMIT ? status : tribo_system_check_given(sys, cosine, "pattern");
    status = status ? status : check_pattern(sys, h.drives, table ? "pattern" : "cosine", cosine);
    status = status ? status : check_pattern(sys, h.drives, "sine", sine);
    const int limits = h.drives == DRIVES_LIMIT;
    status = status || !limits ? status : tribo_system_take_settings(sys);
    for (size_t i = 0; !status && limits && !table && i < sys->ncontact; i++) {
        const double most =
            sys->loads.given_limit[i] + tribo_system_swing(sys, i) + hypot(cosine ? cosine[i] : 0.0, sine ? sine[i] : 0.0);
        if (!(most <= MOST_LIMIT)) {
            status = tribo_error(sys->message, TRIBO_ERR_RANGE, "limit of contact %zu comes to %g, and %g is the most", i, most,
                                 MOST_LIMIT);
        }
    }
    return status ? status : take_harmonic(sys, h, cosine, sine);
}

/* Adds a table; name: of value, for messages. */
static int add_table(tribo_system *sys, enum drives drives, size_t columns, size_t knots, const double *time, const char *name,
                     const double *value, const double *pattern)
{
    const struct harmonic h = {
        .drives = drives, .knots = knots, .columns = columns, .knot = (double *)time, .value = (double *)value};
    return loads_add(sys, h, name, pattern, NULL);
}

int tribo_system_add_load(tribo_system *sys, double omega, const double *cosine, const double *sine)
{
    return loads_add(sys, (struct harmonic){.drives = DRIVES_LOAD, .omega = omega}, NULL, cosine, sine);
}

int tribo_system_add_base_motion(tribo_system *sys, double omega, const double *cosine, const double *sine)
{
    return loads_add(sys, (struct harmonic){.drives = DRIVES_BASE, .omega = omega}, NULL, cosine, sine);
}

int tribo_system_add_limit(tribo_system *sys, double omega, const double *cosine, const double *sine)
{
    return loads_add(sys, (struct harmonic){.drives = DRIVES_LIMIT, .omega = omega}, NULL, cosine, sine);
}

int tribo_system_add_load_table(tribo_system *sys, size_t knots, const double *time, const double *value, const double *pattern)
{
    return add_table(sys, DRIVES_LOAD, 1, knots, time, "value", value, pattern);
}

int tribo_system_add_base_table(tribo_system *sys, size_t knots, const double *time, const double *value, const double *pattern)
{
    return add_table(sys, DRIVES_BASE, 1, knots, time, "value", value, pattern);
}

int tribo_system_set_limit_table(tribo_system *sys, size_t knots, const double *time, const double *limit)
{
    return add_table(sys, DRIVES_LIMIT, sys ? sys->ncontact : 0, knots, time, "limit", limit, NULL);
}

void tribo_loads_scale(tribo_system *sys, const tribo_system *like, const double *size, double swing, double pace)
{
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        const struct harmonic *from = &like->loads.harmonic[k];
        struct harmonic *h = &sys->loads.harmonic[k];
        const double moves = h->drives == DRIVES_LIMIT ? 1.0 : h->drives == DRIVES_BASE ? pace * swing : swing;
        const double factor = size[h->by_load ? DRIVES_LOAD : h->drives] * (from->omega != 0.0 ? moves : 1.0);
        h->omega = pace * from->omega;
        for (size_t e = 0; e < h->count; e++) {
            h->cosine[e] = factor * from->cosine[e];
            h->sine[e] = factor * from->sine[e];
        }
    }
    loads_changed(sys);
}

static int loads_clear(tribo_system *sys, enum drives drives)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (drives == DRIVES_LIMIT && tribo_system_limits_vary(sys)) {
        tribo_set_limit(sys->contacts, sys->loads.given_limit);
    }
    remove_driven(&sys->loads, drives, 0);
    loads_changed(sys);
    return TRIBO_OK;
}

int tribo_system_clear_loads(tribo_system *sys)
{
    return loads_clear(sys, DRIVES_LOAD);
}

int tribo_system_clear_base_motion(tribo_system *sys)
{
    return loads_clear(sys, DRIVES_BASE);
}

int tribo_system_clear_limits(tribo_system *sys)
{
    return loads_clear(sys, DRIVES_LIMIT);
}
