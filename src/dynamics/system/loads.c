/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions of time: loads on the structure, motions of bases, limits. */
#include "cos_sin.h"
#include "system.h"
#include "common/layout.h"
#include "common/real.h"
#include "common/zeros.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns the length of a function of time: of accelerations, or of values of contacts. */
static size_t length_of(const tribo_system *sys, enum drives drives)
{
    return drives == DRIVES_LOAD ? sys->ndof : sys->ncontact;
}

/* Allocates the arrays of h->count entries; copies them from the block `from` of equal arrays (NULL: leaves them unset). Returns
 * 0 if out of memory. */
static int create_harmonic(struct harmonic *h, const void *from)
{
    struct layout l = {0};
    do {
        h->index = tribo_layout_array(&l, h->count, sizeof *h->index);
        h->cosine = tribo_layout_array(&l, h->count, sizeof *h->cosine);
        h->sine = tribo_layout_array(&l, h->count, sizeof *h->sine);
    } while (!l.memory && tribo_layout_create(&l));
    if (l.memory && from) {
        memcpy(l.memory, from, l.used);
    }
    return l.memory != NULL;
}

/* create_harmonic for a table, with t->knots, t->columns and a pattern [n]. */
static int create_table(struct table *t, size_t n, const void *from)
{
    struct layout l = {0};
    do {
        t->time = tribo_layout_array(&l, t->knots, sizeof *t->time);
        t->value = tribo_layout_array(&l, t->knots * t->columns, sizeof *t->value);
        t->pattern = tribo_layout_array(&l, n, sizeof *t->pattern);
    } while (!l.memory && tribo_layout_create(&l));
    if (l.memory && from) {
        memcpy(l.memory, from, l.used);
    }
    return l.memory != NULL;
}

void tribo_loads_free(tribo_system *sys)
{
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        free(sys->loads.harmonic[k].index);
    }
    for (size_t k = 0; k < sys->loads.tables; k++) {
        free(sys->loads.table[k].time);
    }
    free(sys->loads.harmonic);
    free(sys->loads.table);
}

/* Sets the numbers of functions of b(t) and of limits. */
static void loads_count(tribo_system *sys)
{
    struct loads *l = &sys->loads;
    l->base_harmonics = l->limit_harmonics = l->base_tables = l->limit_tables = 0;
    for (size_t k = 0; k < l->harmonics; k++) {
        l->base_harmonics += l->harmonic[k].drives == DRIVES_BASE;
        l->limit_harmonics += l->harmonic[k].drives == DRIVES_LIMIT;
    }
    for (size_t k = 0; k < l->tables; k++) {
        l->base_tables += l->table[k].drives == DRIVES_BASE;
        l->limit_tables += l->table[k].drives == DRIVES_LIMIT;
    }
}

int tribo_loads_copy(tribo_system *sys, const tribo_system *from)
{
    sys->loads.harmonic = malloc((from->loads.harmonics + 1) * sizeof *sys->loads.harmonic);
    sys->loads.table = malloc((from->loads.tables + 1) * sizeof *sys->loads.table);
    int done = sys->loads.harmonic && sys->loads.table;
    for (; done && sys->loads.harmonics < from->loads.harmonics; sys->loads.harmonics++) {
        struct harmonic *h = &sys->loads.harmonic[sys->loads.harmonics];
        *h = from->loads.harmonic[sys->loads.harmonics];
        h->time = NAN;
        done = create_harmonic(h, h->index);
    }
    for (; done && sys->loads.tables < from->loads.tables; sys->loads.tables++) {
        struct table *t = &sys->loads.table[sys->loads.tables];
        *t = from->loads.table[sys->loads.tables];
        done = create_table(t, length_of(sys, t->drives), t->time);
    }
    loads_count(sys);
    return done;
}

/* ------------------------------------------------------------------------------------------------------------------ at a time */

void tribo_system_forget_time(tribo_system *sys)
{
    sys->loads.time = NAN;
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        sys->loads.harmonic[k].time = NAN;
    }
}

void tribo_harmonic_turn(const tribo_system *sys, struct harmonic *h)
{
    h->time = sys->loads.time;
    h->turns = 0;
    tribo_cos_sin(h->omega, sys->loads.time, sys->loads.low, &h->cos_t, &h->sin_t);
}

enum { MOST_TURNS = 16 };

void tribo_harmonic_take(const tribo_system *sys, struct harmonic *h, double c, double s)
{
    if (h->drives == DRIVES_LOAD && h->turns < MOST_TURNS) {
        h->turns++;
        h->time = sys->loads.time;
        h->cos_t = c;
        h->sin_t = s;
    }
}

/* Returns the last knot at or before t; 0 if there is none. */
static size_t knot_at(const struct table *table, double t)
{
    size_t lo = 0, hi = table->knots;
    while (hi - lo > 1) {
        const size_t mid = lo + (hi - lo) / 2;
        *(table->time[mid] <= t ? &lo : &hi) = mid;
    }
    return lo;
}

/* Returns value (order 0) or slope (order 1) of column i of a table at t + low; k: the last knot at or before t. */
static double look_up(const struct table *table, size_t k, double t, double low, size_t i, int order)
{
    const double *v = table->value + k * table->columns + i;
    if (k + 1 == table->knots || t < table->time[0]) {
        return order ? 0.0 : *v;
    }
    const double slope = (v[table->columns] - v[0]) / (table->time[k + 1] - table->time[k]);
    return order ? slope : v[0] + slope * (t - table->time[k] + low);
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
        tribo_system_forget_time(sys);
    }
}

void tribo_system_set_time(tribo_system *sys, double t)
{
    if (t == sys->loads.time) {
        return;
    }
    sys->loads.time = t;
    for (size_t k = 0; k < sys->loads.tables; k++) {
        sys->loads.table[k].at = knot_at(&sys->loads.table[k], t);
    }
    if (tribo_system_limits_vary(sys)) {
        tribo_system_put_limits(sys, 0.0);
    }
}

double tribo_system_next_kink(const tribo_system *sys, double t)
{
    double next = HUGE_VAL;
    for (size_t k = 0; k < sys->loads.tables; k++) {
        const struct table *table = &sys->loads.table[k];
        size_t i = knot_at(table, t);
        while (i < table->knots && !(table->time[i] > t || (table->time[i] == t && sys->loads.low < 0.0))) {
            i++;
        }
        next = i < table->knots ? lesser(next, table->time[i]) : next;
    }
    return next;
}

void tribo_system_tables(const tribo_system *sys, enum drives drives, int order, double factor, size_t begin, size_t end,
                         double *to)
{
    for (size_t k = 0; order < 2 && k < sys->loads.tables; k++) {
        const struct table *table = &sys->loads.table[k];
        if (table->drives != drives) {
            continue;
        }
        double value = 0.0;
        for (size_t i = begin; i < end; i++) {
            if (i == begin || table->columns > 1) {
                value = factor * look_up(table, table->at, sys->loads.time, sys->loads.low, table->columns > 1 ? i : 0, order);
            }
            to[i] += value * table->pattern[i];
        }
    }
}

/* *c, *s = order-th derivatives of cos(omega t), sin(omega t) at the set time. */
static inline void loads_differentiate(const struct harmonic *h, int order, double *c, double *s)
{
    double power = order & 2 ? -1.0 : 1.0;
    for (int d = 0; d < order; d++) {
        power *= h->omega;
    }
    *c = power * (order & 1 ? -h->sin_t : h->cos_t);
    *s = power * (order & 1 ? h->cos_t : h->sin_t);
}

void tribo_system_loads(const tribo_system *sys, enum drives drives, int order, double factor, double *to)
{
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        struct harmonic *h = &sys->loads.harmonic[k];
        if (h->drives != drives) {
            continue;
        }
        double c, s;
        tribo_system_turn(sys, k);
        loads_differentiate(h, order, &c, &s);
        for (size_t i = 0; i < h->count; i++) {
            to[h->index[i]] += factor * (h->cosine[i] * c + h->sine[i] * s);
        }
    }
    if (sys->loads.tables) {
        tribo_system_tables(sys, drives, order, factor, 0, length_of(sys, drives), to);
    }
}

/* ------------------------------------------------------------------------------------------------------------------- limits */

void tribo_system_limits(const tribo_system *sys, double *limit, double *rate)
{
    memset(rate, 0, sys->ncontact * sizeof *rate);
    if (!tribo_system_limits_vary(sys)) {
        tribo_get_limit(sys->contacts, limit);
        return;
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        limit[i] = sys->loads.limit_tables ? 0.0 : sys->loads.given_limit[i];
    }
    tribo_system_loads(sys, DRIVES_LIMIT, 0, 1.0, limit);
    tribo_system_loads(sys, DRIVES_LIMIT, 1, 1.0, rate);
}

double tribo_system_swing(const tribo_system *sys, size_t i)
{
    double sum = 0.0;
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        const struct harmonic *h = &sys->loads.harmonic[k];
        sum += h->drives == DRIVES_LIMIT ? hypot(h->cosine[i], h->sine[i]) : 0.0;
    }
    return sum;
}

void tribo_system_most_limits(const tribo_system *sys, double *most)
{
    if (!tribo_system_limits_vary(sys)) {
        tribo_get_limit(sys->contacts, most);
        return;
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        most[i] = sys->loads.limit_tables ? 0.0 : sys->loads.given_limit[i];
        for (size_t k = 0; k < sys->loads.tables; k++) {
            const struct table *table = &sys->loads.table[k];
            for (size_t p = 0; table->drives == DRIVES_LIMIT && p < table->knots; p++) {
                most[i] = greater(most[i], table->value[p * table->columns + i]);
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
        double *limit = sys->work.feq, sum;
        limit[i] = sys->loads.limit_tables || order ? 0.0 : sys->loads.given_limit[i];
        tribo_system_tables(sys, DRIVES_LIMIT, order, 1.0, i, i + 1, limit);
        sum = limit[i];
        double size = fabs(sum);
        for (size_t k = 0; k < sys->loads.harmonics; k++) {
            const struct harmonic *h = &sys->loads.harmonic[k];
            double c, s;
            if (h->drives == DRIVES_LIMIT) {
                tribo_system_turn(sys, k);
                loads_differentiate(h, order, &c, &s);
                sum += h->cosine[i] * c + h->sine[i] * s;
                size += hypot(h->cosine[i], h->sine[i]) * hypot(c, s);
            }
        }
        if (fabs(sum) > TRIBO_LIMIT_NOISE * doubt * size) {
            return sum > 0.0;
        }
    }
    return 0;
}

/* ------------------------------------------------------------------------------------------------------------------- checks */

/* Checks x, amplitudes of loads, bases or limits in the caller's coordinates, or NULL. Returns TRIBO_ERR_UNSUPPORTED for a load
 * on a degree of freedom without mass, or a varying limit of a compliant contact. */
static int check_pattern(const tribo_system *sys, enum drives drives, const char *name, const double *x)
{
    const size_t *place = sys->expansion.place, n = drives == DRIVES_LOAD ? sys->given : sys->ncontact;
    const int status = tribo_system_check_finite(sys, name, x, n);
    for (size_t i = 0; x && place && !status && i < n; i++) {
        if (x[i] != 0.0 && drives == DRIVES_LOAD && !sys->reduced.modes && place[i] >= sys->ndof) {
            return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                     "%s[%zu] = %g, but degree of freedom %zu has no mass, and takes no load", name, i, x[i], i);
        }
        if (x[i] != 0.0 && drives == DRIVES_LIMIT && tribo_is_compliant(&sys->compliance, i)) {
            return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                     "%s[%zu] = %g, but contact %zu is elastic, and its limit must be constant", name, i, x[i],
                                     i);
        }
    }
    return status;
}

/* Largest limit; keeps results computed from limits finite. */
#define MOST_LIMIT 1e300

static int loads_check_limits(const tribo_system *sys, const double *cosine, const double *sine)
{
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double most =
            sys->loads.given_limit[i] + tribo_system_swing(sys, i) + hypot(cosine ? cosine[i] : 0.0, sine ? sine[i] : 0.0);
        if (!(most <= MOST_LIMIT)) {
            return tribo_system_fail(sys, TRIBO_ERR_RANGE, "limit of contact %zu comes to %g, and %g is the most", i, most,
                                     MOST_LIMIT);
        }
    }
    return TRIBO_OK;
}

/* Takes the settings; if limits are still constant, copies the limits of the context to given_limit. Returns a status. */
static int loads_begin_limits(tribo_system *sys)
{
    const int status = tribo_system_take_settings(sys);
    if (!status && !tribo_system_limits_vary(sys)) {
        tribo_get_limit(sys->contacts, sys->loads.given_limit);
    }
    return status;
}

/* Returns TRIBO_OK if there are knots, time [knots] ascends and is finite, and value is not NULL; name: of value, for the
 * message. */
static int check_knots(const tribo_system *sys, size_t knots, const double *time, const char *name, const double *value)
{
    if (knots == 0 || !time || !value) {
        return knots ? tribo_system_fail(sys, TRIBO_ERR_NULL, "%s is NULL", time ? name : "time")
                     : tribo_system_fail(sys, TRIBO_ERR_SIZE, "knots = 0");
    }
    const int status = tribo_system_check_finite(sys, "time", time, knots);
    for (size_t k = 1; !status && k < knots; k++) {
        if (time[k] <= time[k - 1]) {
            return tribo_system_fail(sys, TRIBO_ERR_RANGE, "time[%zu] = %.17g is not after time[%zu] = %.17g", k, time[k], k - 1,
                                     time[k - 1]);
        }
    }
    return status;
}

/* Returns TRIBO_OK if limit [knots][ncontact] is finite, not negative, and 0 at elastic contacts. */
static int check_limit_table(const tribo_system *sys, size_t knots, const double *limit)
{
    const size_t n = sys->ncontact;
    int status = TRIBO_OK;
    for (size_t k = 0; !status && k < knots * n; k++) {
        if (!isfinite(limit[k]) || limit[k] < 0.0) {
            const int finite = isfinite(limit[k]);
            status =
                tribo_system_fail(sys, finite ? TRIBO_ERR_NEGATIVE : TRIBO_ERR_NOT_FINITE, "limit[%zu] = %g of contact %zu is %s",
                                  k / n, limit[k], k % n, finite ? "negative" : "not finite");
        }
    }
    for (size_t k = 0; !status && k < knots; k++) {
        status = check_pattern(sys, DRIVES_LIMIT, "limit", limit + k * n);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------------ add and remove */

/* Notes a change of the functions of time. */
static int loads_changed(tribo_system *sys)
{
    loads_count(sys);
    sys->revision++;
    tribo_system_forget_time(sys);
    return TRIBO_OK;
}

/* Appends a harmonic, parts [2][n] cosine and sine: entries that are not both 0; all entries for limits, where the index is the
 * contact. Returns 0 if out of memory. */
static int append_harmonic(tribo_system *sys, enum drives drives, double omega, const double *parts, int by_load)
{
    const size_t n = length_of(sys, drives);
    struct harmonic h = {.omega = omega, .drives = drives, .time = NAN, .by_load = by_load};
    struct harmonic *all = realloc(sys->loads.harmonic, (sys->loads.harmonics + 1) * sizeof *all);
    for (size_t i = 0; i < n; i++) {
        h.count += parts[i] != 0.0 || parts[n + i] != 0.0 || drives == DRIVES_LIMIT;
    }
    sys->loads.harmonic = all ? all : sys->loads.harmonic;
    if (!all || !create_harmonic(&h, NULL)) {
        return 0;
    }
    for (size_t i = 0, e = 0; e < h.count; i++) {
        if (parts[i] != 0.0 || parts[n + i] != 0.0 || drives == DRIVES_LIMIT) {
            h.index[e] = i;
            h.cosine[e] = parts[i];
            h.sine[e++] = parts[n + i];
        }
    }
    sys->loads.harmonic[sys->loads.harmonics++] = h;
    return loads_changed(sys) == TRIBO_OK;
}

/* Adds a harmonic. Displacements of compliant contacts by a load, way [2][ncontact], become a base motion b = -d(way)/dt, so that
 * v includes d(way)/dt. Returns a status. */
static int loads_add_harmonic(tribo_system *sys, enum drives drives, double omega, const double *cosine, const double *sine)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    const size_t n = length_of(sys, drives), c = sys->ncontact;
    int status = drives == DRIVES_LIMIT ? loads_begin_limits(sys) : TRIBO_OK;
    status = status || isfinite(omega) ? status : tribo_system_fail(sys, TRIBO_ERR_NOT_FINITE, "omega = %g is not finite", omega);
    status = status ? status : check_pattern(sys, drives, "cosine", cosine);
    status = status ? status : check_pattern(sys, drives, "sine", sine);
    status = status || drives != DRIVES_LIMIT ? status : loads_check_limits(sys, cosine, sine);
    if (status) {
        return status;
    }
    double *parts = tribo_zeros(2 * (n + c) + 1, sizeof *parts), *way = parts ? parts + 2 * n : NULL;
    for (size_t part = 0; parts && part < 2; part++) {
        const double *from = part ? sine : cosine;
        if (from && drives != DRIVES_LOAD) {
            memcpy(parts + part * n, from, n * sizeof *parts);
        } else if (from) {
            tribo_system_accelerate(sys, from, parts + part * n, way + part * c);
        }
    }
    int done = parts && append_harmonic(sys, drives, omega, parts, 0);
    if (done && tribo_largest(way, 2 * c) * fabs(omega) > 0.0) {
        for (size_t i = 0; i < c; i++) {
            parts[i] = -omega * way[c + i];
            parts[c + i] = omega * way[i];
        }
        done = append_harmonic(sys, DRIVES_BASE, omega, parts, 1);
        if (!done) {
            free(sys->loads.harmonic[--sys->loads.harmonics].index);
        }
    }
    free(parts);
    return done ? TRIBO_OK
                : tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for a harmonic of %zu value%s", n, plural(n));
}

/* Appends a table, or replaces the table of limits, value [knots][columns]; pattern: forces [given], base velocities [ncontact], or NULL: ones. Returns a status. */
static int append_table(tribo_system *sys, enum drives drives, size_t knots, size_t columns, const double *time,
                        const double *value, const double *pattern)
{
    struct table t = {.drives = drives, .knots = knots, .columns = columns};
    struct table *all = realloc(sys->loads.table, (sys->loads.tables + 1) * sizeof *all);
    double *way = sys->work.feq;
    sys->loads.table = all ? all : sys->loads.table;
    if (!all || !create_table(&t, length_of(sys, drives), NULL)) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for a table of %zu knot%s", knots, plural(knots));
    }
    memcpy(t.time, time, knots * sizeof *time);
    memcpy(t.value, value, knots * columns * sizeof *value);
    memset(way, 0, sys->ncontact * sizeof *way);
    if (drives == DRIVES_LOAD) {
        tribo_system_accelerate(sys, pattern, t.pattern, way);
    }
    for (size_t i = 0; drives != DRIVES_LOAD && i < sys->ncontact; i++) {
        t.pattern[i] = pattern ? pattern[i] : 1.0;
    }
    if (tribo_largest(way, sys->ncontact) > 0.0) {
        free(t.time);
        return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                 "the load of a table bends what is reduced to compliance: take TRIBO_STATICS_MASS");
    }
    size_t k = drives == DRIVES_LIMIT ? 0 : sys->loads.tables;
    while (k < sys->loads.tables && sys->loads.table[k].drives != DRIVES_LIMIT) {
        k++;
    }
    if (k < sys->loads.tables) {
        free(sys->loads.table[k].time);
    } else {
        sys->loads.tables++;
    }
    sys->loads.table[k] = t;
    return loads_changed(sys);
}

/* Adds the table value [knots] times pattern: forces [given], or base velocities [ncontact]. Returns a status. */
static int add_table(tribo_system *sys, enum drives drives, size_t knots, const double *time, const double *value,
                     const double *pattern)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    int status = knots == 0 || pattern ? check_knots(sys, knots, time, "value", value)
                                       : tribo_system_fail(sys, TRIBO_ERR_NULL, "pattern is NULL");
    status = status ? status : tribo_system_check_finite(sys, "value", value, knots);
    status = status ? status : check_pattern(sys, drives, "pattern", pattern);
    return status ? status : append_table(sys, drives, knots, 1, time, value, pattern);
}

/* Removes the harmonics and tables that drive loads, bases or limits. Returns a status. */
static int remove_driven(tribo_system *sys, enum drives drives)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    struct loads *l = &sys->loads;
    const size_t harmonics = l->harmonics, tables = l->tables;
    l->harmonics = l->tables = 0;
    for (size_t k = 0; k < harmonics; k++) {
        if ((l->harmonic[k].by_load ? DRIVES_LOAD : l->harmonic[k].drives) == drives) {
            free(l->harmonic[k].index);
        } else {
            l->harmonic[l->harmonics++] = l->harmonic[k];
        }
    }
    for (size_t k = 0; k < tables; k++) {
        if (l->table[k].drives == drives) {
            free(l->table[k].time);
        } else {
            l->table[l->tables++] = l->table[k];
        }
    }
    return loads_changed(sys);
}

int tribo_system_add_load(tribo_system *sys, double omega, const double *cosine, const double *sine)
{
    return loads_add_harmonic(sys, DRIVES_LOAD, omega, cosine, sine);
}

int tribo_system_add_base_motion(tribo_system *sys, double omega, const double *cosine, const double *sine)
{
    return loads_add_harmonic(sys, DRIVES_BASE, omega, cosine, sine);
}

int tribo_system_add_limit(tribo_system *sys, double omega, const double *cosine, const double *sine)
{
    return loads_add_harmonic(sys, DRIVES_LIMIT, omega, cosine, sine);
}

int tribo_system_add_load_table(tribo_system *sys, size_t knots, const double *time, const double *value, const double *pattern)
{
    return add_table(sys, DRIVES_LOAD, knots, time, value, pattern);
}

int tribo_system_add_base_table(tribo_system *sys, size_t knots, const double *time, const double *value, const double *pattern)
{
    return add_table(sys, DRIVES_BASE, knots, time, value, pattern);
}

int tribo_system_set_limit_table(tribo_system *sys, size_t knots, const double *time, const double *limit)
{
    int status = sys ? check_knots(sys, knots, time, "limit", limit) : TRIBO_ERR_NULL;
    status = status ? status : check_limit_table(sys, knots, limit);
    status = status ? status : loads_begin_limits(sys);
    return status ? status : append_table(sys, DRIVES_LIMIT, knots, sys->ncontact, time, limit, NULL);
}

int tribo_system_clear_loads(tribo_system *sys)
{
    return remove_driven(sys, DRIVES_LOAD);
}

int tribo_system_clear_base_motion(tribo_system *sys)
{
    return remove_driven(sys, DRIVES_BASE);
}

int tribo_system_clear_limits(tribo_system *sys)
{
    if (sys && tribo_system_limits_vary(sys)) {
        tribo_set_limit(sys->contacts, sys->loads.given_limit);
    }
    return remove_driven(sys, DRIVES_LIMIT);
}
