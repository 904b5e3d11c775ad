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

static void free_harmonic(struct harmonic *h)
{
    free(h->index);
}

static void lay_out_harmonic(struct harmonic *h, struct layout *l, size_t n)
{
    h->index = tribo_layout_array(l, n, sizeof *h->index);
    h->cosine = tribo_layout_array(l, n, sizeof *h->cosine);
    h->sine = tribo_layout_array(l, n, sizeof *h->sine);
}

/* Allocates n entries. Returns 0 if out of memory; then nothing is allocated. */
static int create_harmonic(struct harmonic *h, size_t n)
{
    struct layout l = {0};
    lay_out_harmonic(h, &l, n);
    const int done = tribo_layout_create(&l);
    if (done) {
        lay_out_harmonic(h, &l, n);
    }
    return done;
}

static void free_table(struct table *t)
{
    free(t->time);
    free(t->value);
    free(t->pattern);
}

void tribo_loads_free(tribo_system *sys)
{
    for (size_t k = 0; k < sys->harmonics; k++) {
        free_harmonic(&sys->harmonic[k]);
    }
    free(sys->harmonic);
    for (size_t k = 0; k < sys->tables; k++) {
        free_table(&sys->table[k]);
    }
    free(sys->table);
    free_table(&sys->limits);
}

/* ------------------------------------------------------------------------------------------------------------------- copies */

/* t = table of time [knots] and value [knots][columns]. Returns 0 if out of memory. */
static int create_table(struct table *t, size_t knots, size_t columns, const double *time, const double *value)
{
    int done = 1;
    t->knots = knots;
    t->time = tribo_copy_of(time, knots, sizeof *t->time, &done);
    t->value = tribo_copy_of(value, knots * columns, sizeof *t->value, &done);
    return done;
}

static int copy_harmonic(struct harmonic *to, const struct harmonic *from)
{
    *to = *from;
    to->time = NAN;
    if (!create_harmonic(to, from->count)) {
        return 0;
    }
    memcpy(to->index, from->index, from->count * sizeof *to->index);
    memcpy(to->cosine, from->cosine, from->count * sizeof *to->cosine);
    memcpy(to->sine, from->sine, from->count * sizeof *to->sine);
    return 1;
}

/* to = from, with value [knots][columns] and pattern [n] or NULL. Returns 0 if out of memory. */
static int copy_table(struct table *to, const struct table *from, size_t columns, size_t n)
{
    int done = 1;
    *to = (struct table){.drives = from->drives};
    if (from->knots) {
        done = create_table(to, from->knots, columns, from->time, from->value);
        to->pattern = tribo_copy_of(from->pattern, n, sizeof *to->pattern, &done);
    }
    return done;
}

int tribo_loads_copy(tribo_system *sys, const tribo_system *from)
{
    sys->harmonic = malloc((from->harmonics + 1) * sizeof *sys->harmonic);
    sys->table = malloc((from->tables + 1) * sizeof *sys->table);
    int done = sys->harmonic && sys->table;
    for (size_t k = 0; done && k < from->harmonics; k++) {
        done = copy_harmonic(&sys->harmonic[sys->harmonics++], &from->harmonic[k]);
    }
    for (size_t k = 0; done && k < from->tables; k++) {
        const size_t n = from->table[k].drives == DRIVES_BASE ? sys->ncontact : sys->ndof;
        done = copy_table(&sys->table[sys->tables++], &from->table[k], 1, n);
    }
    sys->base_tables = from->base_tables;
    sys->base_harmonics = from->base_harmonics;
    sys->limit_harmonics = from->limit_harmonics;
    return done && copy_table(&sys->limits, &from->limits, sys->ncontact, 0);
}

/* ------------------------------------------------------------------------------------------------------------------ at a time */

void tribo_system_forget_time(tribo_system *sys)
{
    sys->time = NAN;
    for (size_t k = 0; k < sys->harmonics; k++) {
        sys->harmonic[k].time = NAN;
    }
}

void tribo_harmonic_turn(const tribo_system *sys, struct harmonic *h)
{
    h->time = sys->time;
    h->turns = 0;
    tribo_cos_sin(h->omega, sys->time, sys->low, &h->cos_t, &h->sin_t);
}

enum { MOST_TURNS = 16 };

void tribo_harmonic_take(const tribo_system *sys, struct harmonic *h, double c, double s)
{
    if (h->drives == DRIVES_LOAD && h->turns < MOST_TURNS) {
        h->turns++;
        h->time = sys->time;
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

/* Returns value (order 0) or slope (order 1) of column i of a table at the set time. */
static double look_up(const tribo_system *sys, const struct table *table, size_t columns, size_t i, int order)
{
    const size_t k = table->at;
    const double *v = table->value + k * columns + i;
    if (k + 1 == table->knots || sys->time < table->time[0]) {
        return order ? 0.0 : *v;
    }
    const double slope = (v[columns] - v[0]) / (table->time[k + 1] - table->time[k]);
    return order ? slope : v[0] + slope * (sys->time - table->time[k] + sys->low);
}

void tribo_system_put_limits(tribo_system *sys, double later)
{
    tribo_system_limits(sys, sys->put_limit, sys->feq);
    for (size_t i = 0; i < sys->ncontact; i++) {
        sys->put_limit[i] = clamp(sys->put_limit[i] + later * sys->feq[i], 0.0, DBL_MAX);
    }
    tribo_set_limit(sys->contacts, sys->put_limit);
}

void tribo_system_set_low(tribo_system *sys, double low)
{
    if (low != sys->low) {
        sys->low = low;
        tribo_system_forget_time(sys);
    }
}

void tribo_system_set_time(tribo_system *sys, double t)
{
    if (t == sys->time) {
        return;
    }
    sys->time = t;
    for (size_t k = 0; k < sys->tables; k++) {
        sys->table[k].at = knot_at(&sys->table[k], t);
    }
    if (tribo_system_limits_vary(sys)) {
        sys->limits.at = knot_at(&sys->limits, sys->time);
        tribo_system_put_limits(sys, 0.0);
    }
}

double tribo_system_next_kink(const tribo_system *sys, double t)
{
    double next = HUGE_VAL;
    if (sys->tables == 0 && sys->limits.knots == 0) {
        return next;
    }
    for (size_t k = 0; k <= sys->tables; k++) {
        const struct table *table = k < sys->tables ? &sys->table[k] : &sys->limits;
        for (size_t i = table->knots ? knot_at(table, t) : 0; i < table->knots; i++) {
            if (table->time[i] > t || (table->time[i] == t && sys->low < 0.0)) {
                next = lesser(next, table->time[i]);
                break;
            }
        }
    }
    return next;
}

void tribo_system_tables(const tribo_system *sys, enum drives drives, int order, double factor, size_t begin, size_t end,
                         double *to)
{
    for (size_t k = 0; order < 2 && k < sys->tables; k++) {
        const struct table *table = &sys->table[k];
        const double value = factor * look_up(sys, table, 1, 0, order);
        for (size_t i = begin; table->drives == drives && i < end; i++) {
            to[i] += value * table->pattern[i];
        }
    }
}

/* *c, *s = order-th derivatives of cos(omega t), sin(omega t) at the set time. */
static inline void loads_differentiate(const struct harmonic *h, int order, double *c, double *s)
{
    *c = h->cos_t;
    *s = h->sin_t;
    for (int d = 0; d < order; d++) {
        const double dc = -h->omega * *s;
        *s = h->omega * *c;
        *c = dc;
    }
}

void tribo_system_loads(const tribo_system *sys, enum drives drives, int order, double factor, double *to)
{
    for (size_t k = 0; k < sys->harmonics; k++) {
        struct harmonic *h = &sys->harmonic[k];
        if (h->drives != drives) {
            continue;
        }
        double c, s;
        tribo_system_turn_to(sys, h);
        loads_differentiate(h, order, &c, &s);
        for (size_t i = 0; i < h->count; i++) {
            to[h->index[i]] += factor * (h->cosine[i] * c + h->sine[i] * s);
        }
    }
    if (sys->tables && drives != DRIVES_LIMIT) {
        tribo_system_tables(sys, drives, order, factor, 0, drives == DRIVES_BASE ? sys->ncontact : sys->ndof, to);
    }
}

/* ------------------------------------------------------------------------------------------------------------------- limits */

/* Returns the order-th derivative of the limit of contact i without harmonics. */
static double loads_steady_limit(const tribo_system *sys, size_t i, int order)
{
    if (sys->limits.knots) {
        return order < 2 ? look_up(sys, &sys->limits, sys->ncontact, i, order) : 0.0;
    }
    return order ? 0.0 : sys->given_limit[i];
}

void tribo_system_limits(const tribo_system *sys, double *limit, double *rate)
{
    if (!tribo_system_limits_vary(sys)) {
        tribo_get_limit(sys->contacts, limit);
        memset(rate, 0, sys->ncontact * sizeof *rate);
        return;
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        limit[i] = loads_steady_limit(sys, i, 0);
        rate[i] = loads_steady_limit(sys, i, 1);
    }
    tribo_system_loads(sys, DRIVES_LIMIT, 0, 1.0, limit);
    tribo_system_loads(sys, DRIVES_LIMIT, 1, 1.0, rate);
}

double tribo_system_swing(const tribo_system *sys, size_t i)
{
    double sum = 0.0;
    for (size_t k = 0; k < sys->harmonics; k++) {
        const struct harmonic *h = &sys->harmonic[k];
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
        most[i] = sys->limits.knots ? 0.0 : sys->given_limit[i];
        for (size_t k = 0; k < sys->limits.knots; k++) {
            most[i] = greater(most[i], sys->limits.value[k * sys->ncontact + i]);
        }
        most[i] += tribo_system_swing(sys, i);
    }
}

/* A limit is 0 if its derivatives of order 0 to DERIVATIVES - 1 are all rounding. */
#define DERIVATIVES 9

int tribo_system_presses(const tribo_system *sys, size_t i, double doubt)
{
    for (int order = 0; order < DERIVATIVES; order++) {
        double sum = loads_steady_limit(sys, i, order), size = fabs(sum);
        for (size_t k = 0; k < sys->harmonics; k++) {
            const struct harmonic *h = &sys->harmonic[k];
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

/* ------------------------------------------------------------------------------------------------------------------ harmonics */

/* h = entries of cosine, sine [n] that are not both 0; all entries for limits, where the index is the contact. Returns 0 if out
 * of memory. */
static int loads_compress(struct harmonic *h, size_t n, const double *cosine, const double *sine)
{
    if (!create_harmonic(h, n)) {
        return 0;
    }
    for (size_t i = 0; i < n; i++) {
        if (cosine[i] != 0.0 || sine[i] != 0.0 || h->drives == DRIVES_LIMIT) {
            h->index[h->count] = i;
            h->cosine[h->count] = cosine[i];
            h->sine[h->count++] = sine[i];
        }
    }
    return 1;
}

static int check_amplitudes(const tribo_system *sys, const char *name, const double *x, size_t n)
{
    for (size_t i = 0; x && i < n; i++) {
        if (!isfinite(x[i])) {
            return tribo_system_fail(sys, TRIBO_ERR_NOT_FINITE, "%s[%zu] = %g is not finite", name, i, x[i]);
        }
    }
    return TRIBO_OK;
}

/* Returns TRIBO_ERR_UNSUPPORTED for a load on a degree of freedom without mass, or a varying limit of a compliant contact. */
static int check_place(const tribo_system *sys, enum drives drives, const char *name, const double *x)
{
    const size_t *place = sys->expansion.place;
    const int of_load = drives == DRIVES_LOAD;
    const size_t n = !x || !place || (of_load && sys->modes) ? 0 : of_load ? sys->given : sys->ncontact;
    for (size_t i = 0; i < n; i++) {
        if (x[i] != 0.0 && of_load && place[i] >= sys->ndof) {
            return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                     "%s[%zu] = %g, but degree of freedom %zu has no mass, and takes no load", name, i, x[i], i);
        }
        if (x[i] != 0.0 && drives == DRIVES_LIMIT && tribo_is_compliant(&sys->compliance, i)) {
            return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                     "%s[%zu] = %g, but contact %zu is elastic, and its limit must be constant", name, i, x[i],
                                     i);
        }
    }
    return TRIBO_OK;
}

/* Largest limit; keeps results computed from limits finite. */
#define MOST_LIMIT 1e300

static int loads_check_limits(const tribo_system *sys, const double *cosine, const double *sine)
{
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double most =
            sys->given_limit[i] + tribo_system_swing(sys, i) + hypot(cosine ? cosine[i] : 0.0, sine ? sine[i] : 0.0);
        if (!(most <= MOST_LIMIT)) {
            return tribo_system_fail(sys, TRIBO_ERR_RANGE, "limit of contact %zu comes to %g, and %g is the most", i, most,
                                     MOST_LIMIT);
        }
    }
    return TRIBO_OK;
}

/* Appends a harmonic, parts [2][n] cosine and sine. Returns 0 if out of memory. */
static int append_harmonic(tribo_system *sys, enum drives drives, double omega, size_t n, const double *parts)
{
    struct harmonic h = {.omega = omega, .drives = drives, .time = NAN};
    struct harmonic *all = realloc(sys->harmonic, (sys->harmonics + 1) * sizeof *all);
    sys->harmonic = all ? all : sys->harmonic;
    if (!all || !loads_compress(&h, n, parts, parts + n)) {
        return 0;
    }
    sys->harmonic[sys->harmonics++] = h;
    sys->base_harmonics += drives == DRIVES_BASE;
    sys->limit_harmonics += drives == DRIVES_LIMIT;
    sys->revision++;
    tribo_system_forget_time(sys);
    return 1;
}

/* Appends the base motion b = -d(way)/dt, way [2][ncontact] cosine and sine: displacements of compliant contacts by the last
 * load, so that v includes d(way)/dt. Returns 0 if out of memory; then the load is removed. */
static int append_bend(tribo_system *sys, double omega, double *way)
{
    const size_t c = sys->ncontact;
    for (size_t i = 0; i < c; i++) {
        const double cosine = way[i], sine = way[c + i];
        way[i] = -omega * sine;
        way[c + i] = omega * cosine;
    }
    if (tribo_largest(way, 2 * c) == 0.0) {
        return 1;
    }
    if (!append_harmonic(sys, DRIVES_BASE, omega, c, way)) {
        free_harmonic(&sys->harmonic[--sys->harmonics]);
        return 0;
    }
    sys->harmonic[sys->harmonics - 1].by_load = 1;
    return 1;
}

static int loads_add_harmonic(tribo_system *sys, enum drives drives, double omega, const double *cosine, const double *sine)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    const int of_contacts = drives != DRIVES_LOAD;
    const size_t given = of_contacts ? sys->ncontact : sys->given, n = of_contacts ? sys->ncontact : sys->ndof;
    if (!isfinite(omega)) {
        return tribo_system_fail(sys, TRIBO_ERR_NOT_FINITE, "omega = %g is not finite", omega);
    }
    int status = check_amplitudes(sys, "cosine", cosine, given);
    status = status ? status : check_amplitudes(sys, "sine", sine, given);
    status = status ? status : check_place(sys, drives, "cosine", cosine);
    status = status ? status : check_place(sys, drives, "sine", sine);
    status = status || drives != DRIVES_LIMIT ? status : loads_check_limits(sys, cosine, sine);
    if (status) {
        return status;
    }
    double *parts = tribo_zeros(2 * n + 1, sizeof *parts), *way = tribo_zeros(2 * sys->ncontact + 1, sizeof *way);
    for (int part = 0; parts && way && part < 2; part++) {
        const double *from = part ? sine : cosine;
        if (from && of_contacts) {
            memcpy(parts + (size_t)part * n, from, n * sizeof *parts);
        } else if (from) {
            tribo_system_accelerate(sys, from, parts + (size_t)part * n, way + (size_t)part * sys->ncontact);
        }
    }
    const int done =
        parts && way && append_harmonic(sys, drives, omega, n, parts) && (of_contacts || append_bend(sys, omega, way));
    free(parts);
    free(way);
    return done ? TRIBO_OK
                : tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for a harmonic of %zu value%s", n, plural(n));
}

int tribo_system_add_load(tribo_system *sys, double omega, const double *cosine, const double *sine)
{
    return loads_add_harmonic(sys, DRIVES_LOAD, omega, cosine, sine);
}

/* Removes the harmonics of loads, bases or limits, and the tables of loads or bases. */
static void remove_driven(tribo_system *sys, enum drives drives)
{
    size_t kept = 0;
    for (size_t k = 0; k < sys->harmonics; k++) {
        const struct harmonic *h = &sys->harmonic[k];
        const enum drives of = h->by_load ? DRIVES_LOAD : h->drives;
        if (of != drives) {
            sys->harmonic[kept++] = *h;
        } else {
            sys->base_harmonics -= h->drives == DRIVES_BASE;
            sys->limit_harmonics -= h->drives == DRIVES_LIMIT;
            free_harmonic(&sys->harmonic[k]);
        }
    }
    sys->harmonics = kept;
    kept = 0;
    for (size_t k = 0; k < sys->tables; k++) {
        if (sys->table[k].drives != drives) {
            sys->table[kept++] = sys->table[k];
        } else {
            free_table(&sys->table[k]);
        }
    }
    sys->tables = kept;
    sys->base_tables = drives == DRIVES_BASE ? 0 : sys->base_tables;
    sys->revision++;
    tribo_system_forget_time(sys);
}

int tribo_system_clear_loads(tribo_system *sys)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    remove_driven(sys, DRIVES_LOAD);
    return TRIBO_OK;
}

int tribo_system_add_base_motion(tribo_system *sys, double omega, const double *cosine, const double *sine)
{
    return loads_add_harmonic(sys, DRIVES_BASE, omega, cosine, sine);
}

/* Takes the settings; if limits are still constant, copies the limits of the context to given_limit. Returns a status. */
static int loads_begin_limits(tribo_system *sys)
{
    const int status = tribo_system_take_settings(sys);
    if (!status && !tribo_system_limits_vary(sys)) {
        tribo_get_limit(sys->contacts, sys->given_limit);
    }
    return status;
}

int tribo_system_add_limit(tribo_system *sys, double omega, const double *cosine, const double *sine)
{
    const int status = sys ? loads_begin_limits(sys) : TRIBO_ERR_NULL;
    return status ? status : loads_add_harmonic(sys, DRIVES_LIMIT, omega, cosine, sine);
}

/* --------------------------------------------------------------------------------------------------------------------- tables */

/* Returns TRIBO_OK if time [knots] ascends and is finite, and value is not NULL; name: of value, for the message. */
static int check_knots(const tribo_system *sys, size_t knots, const double *time, const char *name, const double *value)
{
    if (!time || !value) {
        return tribo_system_fail(sys, TRIBO_ERR_NULL, "%s is NULL", time ? name : "time");
    }
    for (size_t k = 0; k < knots; k++) {
        if (!isfinite(time[k])) {
            return tribo_system_fail(sys, TRIBO_ERR_NOT_FINITE, "time[%zu] = %g is not finite", k, time[k]);
        }
        if (k && time[k] <= time[k - 1]) {
            return tribo_system_fail(sys, TRIBO_ERR_RANGE, "time[%zu] = %.17g is not after time[%zu] = %.17g", k, time[k], k - 1,
                                     time[k - 1]);
        }
    }
    return TRIBO_OK;
}

/* Returns TRIBO_OK if limit [knots][ncontact] is finite, not negative, and 0 at elastic contacts. */
static int check_limit_table(const tribo_system *sys, size_t knots, const double *limit)
{
    const size_t n = sys->ncontact;
    int status = TRIBO_OK;
    for (size_t k = 0; !status && k < knots * n; k++) {
        if (!isfinite(limit[k])) {
            status = tribo_system_fail(sys, TRIBO_ERR_NOT_FINITE, "limit[%zu] = %g of contact %zu is not finite", k / n, limit[k],
                                       k % n);
        } else if (limit[k] < 0.0) {
            status =
                tribo_system_fail(sys, TRIBO_ERR_NEGATIVE, "limit[%zu] = %g of contact %zu is negative", k / n, limit[k], k % n);
        }
    }
    for (size_t k = 0; !status && k < knots; k++) {
        status = check_place(sys, DRIVES_LIMIT, "limit", limit + k * n);
    }
    return status;
}

/* Adds the table value [knots] times pattern: forces [given], or base velocities [ncontact]. Returns a status. */
static int add_table(tribo_system *sys, enum drives drives, size_t knots, const double *time, const double *value,
                     const double *pattern)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (knots == 0 || !pattern) {
        return knots ? tribo_system_fail(sys, TRIBO_ERR_NULL, "pattern is NULL")
                     : tribo_system_fail(sys, TRIBO_ERR_SIZE, "knots = 0");
    }
    const int of_bases = drives == DRIVES_BASE;
    int status = check_knots(sys, knots, time, "value", value);
    status = status ? status : check_amplitudes(sys, "value", value, knots);
    status = status ? status : check_amplitudes(sys, "pattern", pattern, of_bases ? sys->ncontact : sys->given);
    status = status ? status : check_place(sys, drives, "pattern", pattern);
    if (status) {
        return status;
    }
    struct table t = {.drives = drives};
    struct table *all = realloc(sys->table, (sys->tables + 1) * sizeof *all);
    sys->table = all ? all : sys->table;
    if (all && create_table(&t, knots, 1, time, value)) {
        t.pattern = malloc(((of_bases ? sys->ncontact : sys->ndof) + 1) * sizeof *t.pattern);
    }
    if (!t.pattern) {
        free_table(&t);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for a table of %zu knot%s", knots, plural(knots));
    }
    if (of_bases) {
        memcpy(t.pattern, pattern, sys->ncontact * sizeof *pattern);
    } else {
        memset(sys->feq, 0, sys->ncontact * sizeof *sys->feq);
        tribo_system_accelerate(sys, pattern, t.pattern, sys->feq);
    }
    if (!of_bases && tribo_largest(sys->feq, sys->ncontact) > 0.0) {
        free_table(&t);
        return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                 "the load of a table bends what is reduced to compliance: take TRIBO_STATICS_MASS");
    }
    sys->table[sys->tables++] = t;
    sys->base_tables += (size_t)of_bases;
    sys->revision++;
    tribo_system_forget_time(sys);
    return TRIBO_OK;
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
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    struct table t = {0};
    int status = knots ? TRIBO_OK : tribo_system_fail(sys, TRIBO_ERR_SIZE, "knots = 0");
    status = status ? status : check_knots(sys, knots, time, "limit", limit);
    status = status ? status : check_limit_table(sys, knots, limit);
    status = status ? status : loads_begin_limits(sys);
    if (status) {
        return status;
    }
    if (!create_table(&t, knots, sys->ncontact, time, limit)) {
        free_table(&t);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for a table of %zu knot%s", knots, plural(knots));
    }
    free_table(&sys->limits);
    sys->limits = t;
    sys->revision++;
    tribo_system_forget_time(sys);
    return TRIBO_OK;
}

int tribo_system_clear_limits(tribo_system *sys)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (tribo_system_limits_vary(sys)) {
        tribo_set_limit(sys->contacts, sys->given_limit);
    }
    free_table(&sys->limits);
    sys->limits = (struct table){0};
    remove_driven(sys, DRIVES_LIMIT);
    return TRIBO_OK;
}

int tribo_system_clear_base_motion(tribo_system *sys)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    remove_driven(sys, DRIVES_BASE);
    return TRIBO_OK;
}
