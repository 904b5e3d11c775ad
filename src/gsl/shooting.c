/* Newton's method on image - x.
 *
 * The map x -> image does not part two states in the energy norm (energy_norm.h), so that the residual never grows when the
 * motion is just followed, period by period, and I - derivative is a monotone matrix. Newton's method does the rest: where a step
 * of it does not pay, the motion is followed for a while, since contacts that come to rest forget. */
#include "shooting.h"
#include "../common/real.h"
#include "eigen.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* The state returned comes back to this part of the largest on the way, */
#define TOLERANCE 1e-10

/* and this much is aimed for. */
#define AIM 1e-12

/* So many half periods at most. */
#define MOST 80

/* A pivot of I - derivative below this, a singular value, or a distance of a multiplier from 1, is that of a family. */
#define SINGULAR 1e-6

/* -------------------------------------------------------------------------------------------------------------- integration */

static double norm_of(const double *x, size_t n)
{
    return sqrt(tribo_dot(x, x, n));
}

static int goes_along(struct company *company, double tau)
{
    struct shooting *s = (struct shooting *)((char *)company - offsetof(struct shooting, company));
    tribo_energy_norm_of(&s->norm, 1, s->events->next, s->seen);
    s->size = greater(s->size, norm_of(s->seen, s->n));
    return s->variation.company.ends(&s->variation.company, tau);
}

static void decided(struct company *company)
{
    struct shooting *s = (struct shooting *)((char *)company - offsetof(struct shooting, company));
    s->variation.company.decided(&s->variation.company);
}

/* Contacts that rested where the last integration ended do so where the next begins: to rounding, which is taken away. */
static int hold_still(struct shooting *s)
{
    struct stick_slip *m = &s->events->stick_slip;
    double *base = m->base;
    tribo_system_set_time(s->sys, s->t);
    memset(base, 0, s->sys->ncontact * sizeof *base);
    tribo_system_loads(s->sys, 1, 0, 1.0, base);
    const int status = tribo_stick_slip_hold(m, s->sys, base, s->y + s->sys->ndof);
    return status ? tribo_driver_fail(s->drv, status, "%s", tribo_message(s->sys->contacts)) : TRIBO_OK;
}

/* s->y from t on for a span. */
static int integrate(struct shooting *s, double t, double end)
{
    tribo_driver *drv = s->drv;
    const size_t bytes = (s->n + 1) * sizeof *s->y;
    drv->time = t;
    memcpy(drv->state, s->y, bytes);
    const int status = tribo_events_advance(s->events, drv, &t, end, s->y, 0);
    s->halves += s->side < 0.0 ? 1 : 2;
    return status ? status : tribo_driver_check(drv, s->y);
}

static double distance(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    }
    return sqrt(sum);
}

static void turn(struct shooting *s, size_t count, double *x)
{
    for (size_t i = 0; s->side < 0.0 && i < count; i++) {
        x[i] = -x[i];
    }
}

/* Where p->x leads. */
static int follow(struct shooting *s, struct point *p)
{
    const size_t n = s->n;
    tribo_energy_norm_state(&s->norm, 1, p->x, s->y);
    s->y[n] = 0.0;
    int status = s->moved ? hold_still(s) : TRIBO_OK;
    if (status) {
        return status;
    }
    tribo_energy_norm_of(&s->norm, 1, s->y, p->x);
    memcpy(s->variation.v, s->unit, n * n * sizeof *s->unit);
    s->size = norm_of(p->x, n);
    s->events->company = &s->company;
    status = integrate(s, s->t, s->t + s->span);
    s->events->company = NULL;
    if (status) {
        return status;
    }
    s->moved = 1;
    tribo_energy_norm_of(&s->norm, 1, s->y, p->image);
    tribo_energy_norm_of(&s->norm, n, s->variation.v, p->derivative);
    turn(s, n, p->image);
    turn(s, n * n, p->derivative);
    p->residual = distance(p->image, p->x, n);
    p->size = s->size;
    return TRIBO_OK;
}

/* -------------------------------------------------------------------------------------------------------------- Newton's step */

/* s->a = I - derivative. */
static void set_matrix(struct shooting *s, const struct point *p)
{
    const size_t n = s->n;
    for (size_t i = 0; i < n * n; i++) {
        s->a[i] = (i % (n + 1) == 0 ? 1.0 : 0.0) - p->derivative[i];
    }
}

/* The least step that solves as well as can be, from the eigenvalues of a'a. Returns the dimension of a's kernel, or n + 1 if out
 * of memory. */
static size_t least_norm_step(struct shooting *s, const double *right)
{
    const size_t n = s->n;
    double *values = malloc((n * n + 2 * n) * sizeof *values), *vectors = values + n, *rotated = vectors + n * n;
    size_t kernel = 0;
    memset(s->b, 0, n * n * sizeof *s->b);
    for (size_t i = 0; values && i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            tribo_add(s->b + j * n, s->a[i * n + j], s->a + i * n, n);
        }
    }
    if (!values || !tribo_symmetric_eigen(s->b, n, values, vectors)) {
        free(values);
        return n + 1;
    }
    memset(rotated, 0, n * sizeof *rotated);
    memset(s->step, 0, n * sizeof *s->step);
    for (size_t i = 0; i < n; i++) {
        tribo_add(rotated, right[i], s->a + i * n, n);
    }
    for (size_t k = 0; k < n; k++) {
        double part = 0.0;
        for (size_t i = 0; i < n; i++) {
            part += vectors[i * n + k] * rotated[i];
        }
        const int free_direction = values[k] < SINGULAR * SINGULAR;
        kernel += (size_t)free_direction;
        for (size_t i = 0; !free_direction && i < n; i++) {
            s->step[i] += vectors[i * n + k] * part / values[k];
        }
    }
    free(values);
    return kernel;
}

/* s->step with (I - derivative) step = image - x. Returns as above. */
static size_t newton_step(struct shooting *s, const struct point *p)
{
    const size_t n = s->n;
    for (size_t i = 0; i < n; i++) {
        s->step[i] = p->image[i] - p->x[i];
    }
    set_matrix(s, p);
    memcpy(s->b, s->a, n * n * sizeof *s->a);
    if (tribo_lu_create(s->b, n, s->pivot) > SINGULAR) {
        tribo_lu_solve(s->b, n, s->pivot, s->step, 1);
        return 0;
    }
    memcpy(s->seen, s->step, n * sizeof *s->step);
    return least_norm_step(s, s->seen);
}

/* -------------------------------------------------------------------------------------------------------------- search */

static void exchange(struct shooting *s)
{
    const struct point p = s->here;
    s->here = s->there;
    s->there = p;
}

static int no_memory(struct shooting *s)
{
    return tribo_driver_fail(s->drv, TRIBO_ERR_MEMORY, "out of memory for periodic motions of %zu degrees of freedom",
                             s->sys->ndof);
}

static int close_enough(const struct point *p, double part)
{
    return p->residual <= part * p->size;
}

/* Goes on from where s->here leads, so often. */
static int march(struct shooting *s, size_t times)
{
    int status = TRIBO_OK;
    for (size_t k = 0; !status && k < times && s->halves < s->most; k++) {
        memcpy(s->there.x, s->here.image, s->n * sizeof *s->there.x);
        status = follow(s, &s->there);
        if (!status) {
            exchange(s);
        }
    }
    return status;
}

/* Newton's method from s->here on, which has been followed. */
static int search(struct shooting *s)
{
    size_t rest = 1;
    int status = TRIBO_OK;
    while (!status && !close_enough(&s->here, AIM) && s->halves < s->most) {
        s->freedom = newton_step(s, &s->here);
        if (s->freedom > s->n) {
            return no_memory(s);
        }
        s->drv->newton++;
        for (size_t i = 0; i < s->n; i++) {
            s->there.x[i] = s->here.x[i] + s->step[i];
        }
        status = follow(s, &s->there);
        if (status) {
            return status;
        }
        if (s->there.residual < 0.5 * s->here.residual) {
            exchange(s);
        } else if (close_enough(&s->here, TOLERANCE)) {
            break; /* rounding allows no more */
        } else {
            status = march(s, rest);
            rest *= 2;
        }
    }
    return status;
}

/* The rest of the period, where the search has looked at half of it. */
static int complete(struct shooting *s, double *residual)
{
    *residual = s->here.residual;
    if (s->side > 0.0) {
        return TRIBO_OK;
    }
    memcpy(s->seen, s->here.image, s->n * sizeof *s->seen);
    turn(s, s->n, s->seen);
    tribo_energy_norm_state(&s->norm, 1, s->seen, s->y);
    s->y[s->n] = 0.0;
    const int status = integrate(s, s->t + s->span, s->t + s->period);
    tribo_energy_norm_of(&s->norm, 1, s->y, s->seen);
    *residual = distance(s->seen, s->here.x, s->n);
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- multipliers */

static void sort(struct shooting *s)
{
    for (size_t i = 1; i < s->n; i++) {
        const double re = s->re[i], im = s->im[i], size = hypot(re, im);
        size_t k = i;
        for (; k > 0 && hypot(s->re[k - 1], s->im[k - 1]) < size; k--) {
            s->re[k] = s->re[k - 1];
            s->im[k] = s->im[k - 1];
        }
        s->re[k] = re;
        s->im[k] = im;
    }
}

static int find_multipliers(struct shooting *s)
{
    const size_t n = s->n;
    memcpy(s->b, s->here.derivative, n * n * sizeof *s->b);
    const int status = tribo_eigen(s->b, n, s->re, s->im, s->a);
    for (size_t i = 0; !status && s->side < 0.0 && i < n; i++) {
        const double re = s->re[i], im = s->im[i];
        s->re[i] = re * re - im * im;
        s->im[i] = 2.0 * re * im;
    }
    s->freedom = 0;
    for (size_t i = 0; !status && i < n; i++) {
        s->freedom += hypot(s->re[i] - 1.0, s->im[i]) < SINGULAR;
    }
    sort(s);
    return status ? tribo_driver_fail(s->drv, status, "multipliers of %zu equations: %s", n, tribo_strerror(status)) : TRIBO_OK;
}

/* -------------------------------------------------------------------------------------------------------------- symmetry */

/* 1 if the motion half a period later may be minus that of now: all that drives it is odd. */
static int may_be_odd(const tribo_system *sys, double period)
{
    for (size_t k = 0; k < sys->harmonics; k++) {
        const double order = round(fabs(sys->harmonic[k].omega) * period / (2.0 * acos(-1.0)));
        if (sys->harmonic[k].count > 0 && fmod(order, 2.0) != 1.0) {
            return 0;
        }
    }
    return 1;
}

/* -------------------------------------------------------------------------------------------------------------- the whole */

static int prepare(struct shooting *s, double t, double period)
{
    const size_t n = s->n;
    const double least = 0.2 * acos(-1.0) / period;
    int status = s->drv->method->open(s->drv, &s->events);
    if (status) {
        return status;
    }
    if (!s->norm.phi || s->revision != s->sys->revision || s->period != period) {
        tribo_energy_norm_free(&s->norm);
        status = tribo_energy_norm_create(&s->norm, s->sys, least);
        if (status) {
            return tribo_driver_fail(s->drv, status, "%s", tribo_message(s->sys->contacts));
        }
        memset(s->a, 0, n * n * sizeof *s->a);
        for (size_t i = 0; i < n; i++) {
            s->a[i * n + i] = 1.0;
        }
        tribo_energy_norm_state(&s->norm, n, s->a, s->unit);
        s->revision = s->sys->revision;
    }
    if (!s->variation.v && !tribo_variation_create(&s->variation, s->events, s->sys, n)) {
        return no_memory(s);
    }
    s->t = t;
    s->period = period;
    s->side = may_be_odd(s->sys, period) ? -1.0 : 1.0;
    s->span = s->side < 0.0 ? 0.5 * period : period;
    s->moved = s->found = 0;
    s->halves = 0;
    s->most = MOST;
    return TRIBO_OK;
}

static int find(struct shooting *s, double *y)
{
    double residual;
    tribo_energy_norm_of(&s->norm, 1, y, s->here.x);
    int status = follow(s, &s->here);
    status = status ? status : search(s);
    status = status ? status : complete(s, &residual);
    if (status) {
        return status;
    }
    if (!(residual <= TOLERANCE * s->here.size)) {
        return tribo_driver_fail(s->drv, TRIBO_ERR_NO_CONVERGENCE,
                                 "no motion of period %.17g was found in %g periods: the nearest misses its beginning by %g of "
                                 "its size",
                                 s->period, 0.5 * (double)s->halves, residual / s->here.size);
    }
    status = find_multipliers(s);
    if (!status) {
        tribo_energy_norm_state(&s->norm, 1, s->here.x, y);
        y[s->n] = 0.0;
        s->found = 1;
    }
    return status;
}

int tribo_shooting_find(struct shooting *s, double t, double period, double *y)
{
    tribo_driver *drv = s->drv;
    int (*const seen)(double, const double *, int, void *) = drv->seen;
    drv->seen = NULL;
    int status = prepare(s, t, period);
    status = status ? status : find(s, y);
    drv->seen = seen;
    drv->periods += (s->halves + 1) / 2;
    drv->knows = 0;
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- life */

struct shooting *tribo_shooting_create(tribo_driver *drv)
{
    struct shooting *s = calloc(1, sizeof *s);
    const size_t n = 2 * drv->sys->ndof;
    if (!s) {
        return NULL;
    }
    *s = (struct shooting){.drv = drv, .sys = drv->sys, .n = n, .company = {goes_along, decided}};
    s->y = malloc((5 * n * n + 9 * n + 2) * sizeof *s->y);
    s->pivot = malloc((n + 1) * sizeof *s->pivot);
    if (!s->y || !s->pivot) {
        tribo_shooting_free(s);
        return NULL;
    }
    double **const vectors[] = {&s->seen, &s->step, &s->here.x, &s->here.image, &s->there.x, &s->there.image, &s->re, &s->im};
    double **const matrices[] = {&s->unit, &s->a, &s->b, &s->here.derivative, &s->there.derivative};
    double *next = s->y + n + 1;
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++, next += n) {
        *vectors[k] = next;
    }
    for (size_t k = 0; k < sizeof matrices / sizeof *matrices; k++, next += n * n) {
        *matrices[k] = next;
    }
    return s;
}

void tribo_shooting_free(struct shooting *s)
{
    if (s) {
        tribo_energy_norm_free(&s->norm);
        tribo_variation_free(&s->variation);
        free(s->y);
        free(s->pivot);
        free(s);
    }
}
