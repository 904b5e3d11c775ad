#include "system.h"
#include "../common/real.h"
#include "../common/twofold.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int right_hand_side(double t, const double y[], double dydt[], void *params);
static int jacobian(double t, const double y[], double *dfdy, double dfdt[], void *params);

int tribo_system_build(tribo_system **sys, size_t ndof, size_t ncontact, struct matrix *stiffness, struct matrix *damping,
                       struct matrix *direction, struct matrix *response)
{
    tribo_system *s = calloc(1, sizeof *s);
    int status = s ? tribo_create(&s->contacts, ncontact) : TRIBO_ERR_MEMORY;
    double *work = status ? NULL : calloc(6 * (ncontact + 1) + ndof, sizeof *work);
    if (!work) {
        tribo_system_destroy(s);
        tribo_matrix_free(stiffness);
        tribo_matrix_free(damping);
        tribo_matrix_free(direction);
        tribo_matrix_free(response);
        return status ? status : TRIBO_ERR_MEMORY;
    }
    s->ndof = ndof;
    s->ncontact = ncontact;
    s->given = ndof;
    s->stiffness = *stiffness;
    s->damping = *damping;
    s->direction = *direction;
    s->response = *response;
    s->power = 1.0;
    s->time = NAN;
    s->v = work;
    s->a = work + (ncontact + 1);
    s->f = work + 2 * (ncontact + 1);
    s->feq = work + 3 * (ncontact + 1);
    s->dv_dt = work + 4 * (ncontact + 1);
    s->given_limit = work + 5 * (ncontact + 1);
    s->acceleration = work + 6 * (ncontact + 1);
    s->odeiv2 = (gsl_odeiv2_system){right_hand_side, jacobian, 2 * ndof + 1, s};
    *sys = s;
    return TRIBO_OK;
}

static void free_harmonic(struct harmonic *h)
{
    free(h->index);
    free(h->cosine);
    free(h->sine);
}

static void free_table(struct table *t)
{
    free(t->time);
    free(t->value);
    free(t->pattern);
}

void tribo_system_destroy(tribo_system *sys)
{
    if (!sys) {
        return;
    }
    tribo_destroy(sys->contacts);
    tribo_matrix_free(&sys->stiffness);
    tribo_matrix_free(&sys->damping);
    tribo_matrix_free(&sys->direction);
    tribo_matrix_free(&sys->response);
    for (size_t k = 0; k < sys->harmonics; k++) {
        free_harmonic(&sys->harmonic[k]);
    }
    free(sys->harmonic);
    for (size_t k = 0; k < sys->tables; k++) {
        free_table(&sys->table[k]);
    }
    free(sys->table);
    free_table(&sys->limits);
    tribo_matrix_free(&sys->elastic);
    tribo_matrix_free(&sys->viscous);
    tribo_matrix_free(&sys->metric);
    tribo_cholesky_free(&sys->factor);
    free(sys->modes);
    free(sys->omega);
    free(sys->v);
    free(sys->dense);
    free(sys);
}

size_t tribo_system_ndof(const tribo_system *sys)
{
    return sys ? sys->ndof : 0;
}

size_t tribo_system_ncontact(const tribo_system *sys)
{
    return sys ? sys->ncontact : 0;
}

size_t tribo_system_dimension(const tribo_system *sys)
{
    return sys ? 2 * sys->ndof + 1 : 0;
}

tribo_context *tribo_system_context(tribo_system *sys)
{
    if (sys) {
        tribo_set_owner(sys->contacts, "a tribo_system");
    }
    return sys ? sys->contacts : NULL;
}

const gsl_odeiv2_system *tribo_system_odeiv2(tribo_system *sys)
{
    return sys ? &sys->odeiv2 : NULL;
}

/* --------------------------------------------------------------------------------------------------------- motion */

/* The knot at or before t, the first one if there is none. */
static size_t knot_at(const struct table *table, double t)
{
    size_t lo = 0, hi = table->knots;
    while (hi - lo > 1) {
        const size_t mid = lo + (hi - lo) / 2;
        *(table->time[mid] <= t ? &lo : &hi) = mid;
    }
    return lo;
}

/* Value (order 0) or slope (1) of column i of a table with so many of them at the time set. */
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

size_t tribo_system_revision(const tribo_system *sys)
{
    return sys->revision + tribo_revision(sys->contacts) - sys->ours;
}

/* Makes the limits of the context those of the table, at the time set. */
static void follow_limits(tribo_system *sys)
{
    const size_t before = tribo_revision(sys->contacts);
    sys->limits.at = knot_at(&sys->limits, sys->time);
    tribo_system_limits(sys, sys->v, sys->a);
    tribo_set_limit(sys->contacts, sys->v);
    sys->seen = tribo_revision(sys->contacts);
    sys->ours += sys->seen - before;
}

/* The harmonic at t + low. What rounding leaves of omega t is turned on: phases of late times would tremble by it. */
static void turn(struct harmonic *h, double t, double low)
{
    const double angle = h->omega * t,
                 rest = (fabs(angle) < TWOFOLD_FAR ? twofold_product(h->omega, t).lo : 0.0) + h->omega * low;
    const double c = cos(angle), s = sin(angle), x = cos(rest), y = sin(rest);
    h->cos_t = c * x - s * y;
    h->sin_t = s * x + c * y;
}

static void set_loads(tribo_system *sys, double t)
{
    for (size_t k = 0; k < sys->harmonics; k++) {
        turn(&sys->harmonic[k], t, sys->low);
    }
    for (size_t k = 0; k < sys->tables; k++) {
        sys->table[k].at = knot_at(&sys->table[k], t);
    }
    sys->time = t;
}

void tribo_system_set_low(tribo_system *sys, double low)
{
    if (low != sys->low) {
        sys->low = low;
        sys->time = NAN;
    }
}

void tribo_system_set_time(tribo_system *sys, double t)
{
    const int moves = t != sys->time;
    if (moves) {
        set_loads(sys, t);
    }
    if (sys->limits.knots && (moves || sys->seen != tribo_revision(sys->contacts))) {
        follow_limits(sys);
    }
}

void tribo_system_limits(const tribo_system *sys, double *limit, double *rate)
{
    if (sys->limits.knots == 0) {
        tribo_get_limit(sys->contacts, limit);
        memset(rate, 0, sys->ncontact * sizeof *rate);
        return;
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        limit[i] = look_up(sys, &sys->limits, sys->ncontact, i, 0);
        rate[i] = look_up(sys, &sys->limits, sys->ncontact, i, 1);
    }
}

double tribo_system_next_kink(const tribo_system *sys, double t)
{
    double next = HUGE_VAL;
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

void tribo_system_tables(const tribo_system *sys, int order, double factor, double *to)
{
    for (size_t k = 0; order < 2 && k < sys->tables; k++) {
        const double value = factor * look_up(sys, &sys->table[k], 1, 0, order);
        for (size_t i = 0; i < sys->ndof; i++) {
            to[i] += value * sys->table[k].pattern[i];
        }
    }
}

void tribo_system_loads(const tribo_system *sys, int moves_base, int order, double factor, double *to)
{
    for (size_t k = 0; k < sys->harmonics; k++) {
        const struct harmonic *h = &sys->harmonic[k];
        if (h->moves_base != moves_base) {
            continue;
        }
        double c = h->cos_t, s = h->sin_t;
        for (int d = 0; d < order; d++) {
            const double dc = -h->omega * s;
            s = h->omega * c;
            c = dc;
        }
        for (size_t i = 0; i < h->count; i++) {
            to[h->index[i]] += factor * (h->cosine[i] * c + h->sine[i] * s);
        }
    }
    if (!moves_base && sys->tables) {
        tribo_system_tables(sys, order, factor, to);
    }
}

double tribo_system_fastest(const tribo_system *sys)
{
    double most = greater(sqrt(tribo_matrix_row_sum(&sys->stiffness)), tribo_matrix_row_sum(&sys->damping));
    for (size_t s = 0; s < sys->harmonics; s++) {
        most = greater(most, fabs(sys->harmonic[s].omega));
    }
    return most;
}

double tribo_system_delassus(const tribo_system *sys, size_t i, size_t j)
{
    const struct matrix *a = &sys->direction;
    double sum = 0.0;
    for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
        sum += a->val[k] * tribo_matrix_get(&sys->response, a->col[k], j);
    }
    return sum;
}

double tribo_system_weight(const tribo_system *sys, size_t i)
{
    /* only the chain has a metric of its own, and there contact i is on degree of freedom i */
    return sys->loads_accelerate && sys->metric.rows ? tribo_matrix_get(&sys->metric, i, i) : 1.0;
}

/* Which of its two degrees of freedom a contact at rest moves by rounding of the other: the second, but no heavy one by a light
 * one's. */
static size_t follows(const tribo_system *sys, size_t i, size_t first)
{
    const size_t *dof = sys->direction.col + first;
    const double one = fabs(tribo_matrix_get(&sys->response, dof[0], i)),
                 other = fabs(tribo_matrix_get(&sys->response, dof[1], i));
    return other >= 1e-3 * one;
}

void tribo_system_snap(const tribo_system *sys, const signed char *loose, const double *base, double *x)
{
    const struct matrix *j = &sys->direction;
    for (size_t i = 0; i < sys->ncontact; i++) {
        const size_t first = j->first[i], count = j->first[i + 1] - first;
        if (!loose[i] && count == 1) {
            x[j->col[first]] = base[i] / j->val[first];
        } else if (!loose[i] && count == 2 && fabs(j->val[first]) == fabs(j->val[first + 1])) {
            const size_t to = first + follows(sys, i, first), from = 2 * first + 1 - to;
            x[j->col[to]] = (base[i] - j->val[from] * x[j->col[from]]) / j->val[to];
        }
    }
}

void tribo_system_free_motion(tribo_system *sys, double t, const double *y, double *acceleration, double *v, double *a)
{
    const size_t n = sys->ndof;
    tribo_system_set_time(sys, t);
    memset(acceleration, 0, n * sizeof *acceleration);
    tribo_system_loads(sys, 0, 0, 1.0, acceleration);
    tribo_matrix_multiply_add(&sys->stiffness, -1.0, y, acceleration);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, y + n, acceleration);
    }
    memset(v, 0, sys->ncontact * sizeof *v);
    memset(a, 0, sys->ncontact * sizeof *a);
    if (sys->base_harmonics) {
        tribo_system_loads(sys, 1, 0, -1.0, v);
        tribo_system_loads(sys, 1, 1, -1.0, a);
    }
    tribo_matrix_multiply_add(&sys->direction, 1.0, y + n, v);
    tribo_matrix_multiply_add(&sys->direction, 1.0, acceleration, a);
}

/* Completes dydt from the forces. */
static void add_forces(const tribo_system *sys, const double *y, double *dydt)
{
    const size_t n = sys->ndof;
    memcpy(dydt, y + n, n * sizeof *dydt);
    tribo_matrix_multiply_add(&sys->response, 1.0, sys->f, dydt + n);
    double power = 0.0;
    for (size_t i = 0; i < sys->ncontact; i++) {
        power += sys->f[i] * sys->v[i];
    }
    dydt[2 * n] = -sys->power * power;
}

static int right_hand_side(double t, const double y[], double dydt[], void *params)
{
    tribo_system *sys = params;
    sys->evaluations++;
    tribo_system_free_motion(sys, t, y, dydt + sys->ndof, sys->v, sys->a);
    sys->status = tribo_balance(sys->contacts, sys->v, sys->a, NULL, sys->f);
    if (sys->status) {
        /* a step that is too long may overflow, and a shorter one not */
        return sys->status == TRIBO_ERR_NOT_FINITE ? GSL_FAILURE : GSL_EBADFUNC;
    }
    add_forces(sys, y, dydt);
    return GSL_SUCCESS;
}

int tribo_system_begin_step(tribo_system *sys, double t, const double *y, double *dydt)
{
    int law;
    tribo_get_law(sys->contacts, &law);
    if (law != TRIBO_QUINN_REVERSAL) {
        right_hand_side(t, y, dydt, sys);
        return sys->status;
    }
    sys->evaluations++;
    tribo_system_free_motion(sys, t, y, dydt + sys->ndof, sys->v, sys->a);
    sys->status = tribo_balance(sys->contacts, sys->v, sys->a, sys->feq, sys->f);
    if (!sys->status) {
        /* the forces stay: where a mark changes, the law's two forms agree */
        sys->status = tribo_accept(sys->contacts, sys->v, sys->feq);
        add_forces(sys, y, dydt);
    }
    return sys->status;
}

/* --------------------------------------------------------------------------------------------------------- Jacobian */

/* The matrices of the Jacobian, dense, and room for its products. */
struct dense {
    double *stiffness, *damping, *direction, *response, *df_dv, *df_da, *df_dq, *df_du, *pull, *load;
};

static struct dense dense_of(const tribo_system *sys)
{
    const size_t n = sys->ndof, m = sys->ncontact;
    struct dense d;
    d.stiffness = sys->dense;
    d.damping = d.stiffness + n * n;
    d.direction = d.damping + n * n;
    d.response = d.direction + m * n;
    d.df_dv = d.response + n * m;
    d.df_da = d.df_dv + m * m;
    d.df_dq = d.df_da + m * m;
    d.df_du = d.df_dq + m * n;
    d.pull = d.df_du + m * n;
    d.load = d.pull + m * n;
    return d;
}

static int expand(const struct matrix *a, double *to)
{
    double *from = tribo_matrix_to_dense(a);
    if (from) {
        memcpy(to, from, a->rows * a->cols * sizeof *to);
    }
    free(from);
    return from != NULL;
}

static int create_dense(tribo_system *sys)
{
    const size_t n = sys->ndof, m = sys->ncontact;
    sys->dense = calloc(2 * n * n + 5 * m * n + 2 * m * m + n + 1, sizeof *sys->dense);
    if (!sys->dense) {
        return 0;
    }
    const struct dense d = dense_of(sys);
    if (expand(&sys->stiffness, d.stiffness) && (!sys->damping.rows || expand(&sys->damping, d.damping)) &&
        expand(&sys->direction, d.direction) && expand(&sys->response, d.response)) {
        return 1;
    }
    free(sys->dense);
    sys->dense = NULL;
    return 0;
}

/* c += factor a b; a [rows][inner], b [inner][cols]. Skips zeros of a, of which diagonal operators have many. */
static void multiply_add(size_t rows, size_t inner, size_t cols, double factor, const double *a, const double *b, double *c)
{
    for (size_t i = 0; i < rows; i++) {
        for (size_t k = 0; k < inner; k++) {
            const double x = factor * a[i * inner + k];
            for (size_t j = 0; x != 0.0 && j < cols; j++) {
                c[i * cols + j] += x * b[k * cols + j];
            }
        }
    }
}

/* With u = q':  u' = load - AK q - AC u + B f,  f = f(v, a),  v = J u - b,  a = J (load - AK q - AC u) - b'. */
static int jacobian(double t, const double y[], double *dfdy, double dfdt[], void *params)
{
    tribo_system *sys = params;
    const size_t n = sys->ndof, m = sys->ncontact, size = 2 * n + 1;
    sys->jacobians++;
    if (!sys->dense && !create_dense(sys)) {
        sys->status = tribo_set_message(sys->contacts, TRIBO_ERR_MEMORY, "out of memory for the Jacobian");
        return GSL_EBADFUNC;
    }
    const struct dense d = dense_of(sys);
    tribo_system_free_motion(sys, t, y, d.load, sys->v, sys->a);
    sys->status = tribo_balance_tangent(sys->contacts, sys->v, sys->a, NULL, sys->f, d.df_dv, d.df_da);
    if (sys->status) {
        return sys->status == TRIBO_ERR_NOT_FINITE ? GSL_FAILURE : GSL_EBADFUNC;
    }

    /* pull = (df/da) J,  df/dq = -pull AK,  df/du = (df/dv) J - pull AC */
    memset(d.df_dq, 0, 3 * m * n * sizeof *d.df_dq);
    multiply_add(m, m, n, 1.0, d.df_da, d.direction, d.pull);
    multiply_add(m, n, n, -1.0, d.pull, d.stiffness, d.df_dq);
    multiply_add(m, n, n, -1.0, d.pull, d.damping, d.df_du);
    multiply_add(m, m, n, 1.0, d.df_dv, d.direction, d.df_du);

    /* df/dt = -(df/dv) b' + (df/da) (J load' - b'') */
    double *df_dt = sys->feq;
    memset(d.load, 0, n * sizeof *d.load);
    memset(sys->dv_dt, 0, m * sizeof *sys->dv_dt);
    memset(sys->a, 0, m * sizeof *sys->a);
    memset(df_dt, 0, m * sizeof *df_dt);
    tribo_system_loads(sys, 0, 1, 1.0, d.load);
    tribo_system_loads(sys, 1, 1, -1.0, sys->dv_dt);
    tribo_system_loads(sys, 1, 2, -1.0, sys->a);
    tribo_matrix_multiply_add(&sys->direction, 1.0, d.load, sys->a);
    multiply_add(m, m, 1, 1.0, d.df_dv, sys->dv_dt, df_dt);
    multiply_add(m, m, 1, 1.0, d.df_da, sys->a, df_dt);

    memset(dfdy, 0, size * size * sizeof *dfdy);
    memset(dfdt, 0, size * sizeof *dfdt);
    for (size_t i = 0; i < n; i++) {
        double *row = dfdy + (n + i) * size;
        dfdy[i * size + n + i] = 1.0;
        for (size_t j = 0; j < n; j++) {
            row[j] = -d.stiffness[i * n + j];
            row[n + j] = -d.damping[i * n + j];
        }
        multiply_add(1, m, n, 1.0, d.response + i * m, d.df_dq, row);
        multiply_add(1, m, n, 1.0, d.response + i * m, d.df_du, row + n);
        dfdt[n + i] = d.load[i];
        multiply_add(1, m, 1, 1.0, d.response + i * m, df_dt, dfdt + n + i);
    }
    /* power = -power f.v */
    double *row = dfdy + 2 * n * size;
    multiply_add(1, m, n, -sys->power, sys->v, d.df_dq, row);
    multiply_add(1, m, n, -sys->power, sys->v, d.df_du, row + n);
    multiply_add(1, m, n, -sys->power, sys->f, d.direction, row + n);
    multiply_add(1, m, 1, -sys->power, sys->v, df_dt, dfdt + 2 * n);
    multiply_add(1, m, 1, -sys->power, sys->f, sys->dv_dt, dfdt + 2 * n);
    return GSL_SUCCESS;
}

/* --------------------------------------------------------------------------------------------------------- queries */

int tribo_system_fail(const tribo_system *sys, int status, const char *format, ...)
{
    char text[200];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return tribo_set_message(sys->contacts, status, text);
}

int tribo_system_check_state(const tribo_system *sys, double t, const double *y)
{
    if (!isfinite(t)) {
        return tribo_system_fail(sys, TRIBO_ERR_NOT_FINITE, "t = %g is not finite", t);
    }
    if (!y) {
        return tribo_system_fail(sys, TRIBO_ERR_NULL, "y is NULL");
    }
    for (size_t i = 0; i < 2 * sys->ndof + 1; i++) {
        if (!isfinite(y[i])) {
            return tribo_system_fail(sys, TRIBO_ERR_NOT_FINITE, "y[%zu] = %g is not finite", i, y[i]);
        }
    }
    return TRIBO_OK;
}

/* v and a of a state, after checking it. */
static int contacts_at(tribo_system *sys, double t, const double *y)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    const int status = tribo_system_check_state(sys, t, y);
    if (!status) {
        tribo_system_free_motion(sys, t, y, sys->acceleration, sys->v, sys->a);
    }
    return status;
}

int tribo_system_contacts(tribo_system *sys, double t, const double *y, double *v, double *feq, double *f)
{
    int status = contacts_at(sys, t, y);
    if (!status) {
        status = tribo_balance(sys->contacts, sys->v, sys->a, feq, f);
    }
    if (!status && v) {
        memcpy(v, sys->v, sys->ncontact * sizeof *v);
    }
    return status;
}

int tribo_system_accept(tribo_system *sys, double t, const double *y)
{
    int status = contacts_at(sys, t, y);
    if (!status) {
        status = tribo_balance(sys->contacts, sys->v, sys->a, sys->feq, NULL);
    }
    return status ? status : tribo_accept(sys->contacts, sys->v, sys->feq);
}

/* ------------------------------------------------------------------------------------------------------------ loads */

/* Keeps only entries in which cosine or sine is not zero. */
static int compress(struct harmonic *h, size_t n, const double *cosine, const double *sine)
{
    h->index = malloc((n + 1) * sizeof *h->index);
    h->cosine = malloc((n + 1) * sizeof *h->cosine);
    h->sine = malloc((n + 1) * sizeof *h->sine);
    if (!h->index || !h->cosine || !h->sine) {
        return 0;
    }
    for (size_t i = 0; i < n; i++) {
        if (cosine[i] != 0.0 || sine[i] != 0.0) {
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

static int add_harmonic(tribo_system *sys, int moves_base, double omega, const double *cosine, const double *sine)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    const size_t given = moves_base ? sys->ncontact : sys->given, n = moves_base ? sys->ncontact : sys->ndof;
    if (!isfinite(omega)) {
        return tribo_system_fail(sys, TRIBO_ERR_NOT_FINITE, "omega = %g is not finite", omega);
    }
    int status = check_amplitudes(sys, "cosine", cosine, given);
    if (!status) {
        status = check_amplitudes(sys, "sine", sine, given);
    }
    if (status) {
        return status;
    }
    struct harmonic h = {.omega = omega, .moves_base = moves_base};
    double *parts = calloc(2 * n + 1, sizeof *parts);
    struct harmonic *all = realloc(sys->harmonic, (sys->harmonics + 1) * sizeof *all);
    sys->harmonic = all ? all : sys->harmonic;
    int done = parts && all;
    for (int part = 0; done && part < 2; part++) {
        const double *from = part ? sine : cosine;
        if (from && moves_base) {
            memcpy(parts + (size_t)part * n, from, n * sizeof *parts);
        } else if (from) {
            tribo_system_accelerate(sys, from, parts + (size_t)part * n);
        }
    }
    done = done && compress(&h, n, parts, parts + n);
    free(parts);
    if (!done) {
        free_harmonic(&h);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for a harmonic of %zu entries", n);
    }
    sys->harmonic[sys->harmonics++] = h;
    sys->base_harmonics += (size_t)moves_base;
    sys->revision++;
    sys->time = NAN;
    return TRIBO_OK;
}

int tribo_system_add_load(tribo_system *sys, double omega, const double *cosine, const double *sine)
{
    return add_harmonic(sys, 0, omega, cosine, sine);
}

int tribo_system_add_motion(tribo_system *sys, double omega, const double *cosine, const double *sine)
{
    return add_harmonic(sys, 1, omega, cosine, sine);
}

/* ----------------------------------------------------------------------------------------------------------- tables */

static int check_table(const tribo_system *sys, size_t knots, size_t columns, const double *time, const double *value)
{
    if (!time || !value) {
        return tribo_system_fail(sys, TRIBO_ERR_NULL, "%s is NULL", time ? "value" : "time");
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
    return check_amplitudes(sys, "value", value, knots * columns);
}

/* A copy of the table; 0 if out of memory. */
static int create_table(struct table *t, size_t knots, size_t columns, const double *time, const double *value)
{
    t->knots = knots;
    t->time = malloc((knots + 1) * sizeof *t->time);
    t->value = malloc((knots * columns + 1) * sizeof *t->value);
    if (!t->time || !t->value) {
        return 0;
    }
    memcpy(t->time, time, knots * sizeof *time);
    memcpy(t->value, value, knots * columns * sizeof *value);
    return 1;
}

int tribo_system_add_load_table(tribo_system *sys, size_t knots, const double *time, const double *value, const double *pattern)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (knots == 0 || !pattern) {
        return knots ? tribo_system_fail(sys, TRIBO_ERR_NULL, "pattern is NULL")
                     : tribo_system_fail(sys, TRIBO_ERR_SIZE, "knots = 0");
    }
    int status = check_table(sys, knots, 1, time, value);
    status = status ? status : check_amplitudes(sys, "pattern", pattern, sys->given);
    if (status) {
        return status;
    }
    struct table t = {0};
    struct table *all = realloc(sys->table, (sys->tables + 1) * sizeof *all);
    sys->table = all ? all : sys->table;
    if (all && create_table(&t, knots, 1, time, value)) {
        t.pattern = malloc((sys->ndof + 1) * sizeof *t.pattern);
    }
    if (!t.pattern) {
        free_table(&t);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for a table of %zu knots", knots);
    }
    tribo_system_accelerate(sys, pattern, t.pattern);
    sys->table[sys->tables++] = t;
    sys->revision++;
    sys->time = NAN;
    return TRIBO_OK;
}

int tribo_system_set_limit_table(tribo_system *sys, size_t knots, const double *time, const double *limit)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    struct table t = {0};
    if (knots) {
        const int status = check_table(sys, knots, sys->ncontact, time, limit);
        if (status) {
            return status;
        }
        for (size_t k = 0; k < knots * sys->ncontact; k++) {
            if (limit[k] < 0.0) {
                return tribo_system_fail(sys, TRIBO_ERR_NEGATIVE, "limit[%zu] = %g of contact %zu is negative", k / sys->ncontact,
                                         limit[k], k % sys->ncontact);
            }
        }
        if (!create_table(&t, knots, sys->ncontact, time, limit)) {
            free_table(&t);
            return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for a table of %zu knots", knots);
        }
    }
    if (!sys->limits.knots && knots) {
        tribo_get_limit(sys->contacts, sys->given_limit);
    } else if (sys->limits.knots && !knots) {
        tribo_set_limit(sys->contacts, sys->given_limit);
    }
    free_table(&sys->limits);
    sys->limits = t;
    sys->revision++;
    sys->time = NAN;
    return TRIBO_OK;
}
