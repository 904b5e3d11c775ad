/* Newton's method on x = image(x). The map does not part two states in the energy norm (energy_norm.h), so that x - image is
 * monotone: what is left of it along a step, step'(x - image), rises with the length of the step from below zero, and passes zero
 * where the step should end. That, and not the size of the residual, tells how good a step is: where contacts begin to slip the
 * residual may well have to rise for a while.
 *
 *     repeat
 *         step by Newton's method, and follow the motion from there
 *         take it if the residual falls
 *         otherwise go on from there nevertheless, a few times, unless the step has gone much too far
 *         otherwise go back to the best point, and make its step shorter: in its direction, or, the next time, with a shift of
 *             the matrix that first spares what the least force moves the most, and follow the motion for once, since contacts
 *             that come to rest forget
 *
 * A contact that hardly slips does so with the square of the distance to where it does not any more, and a whole family of
 * solutions begins there: Newton's steps become half as long each time, and a quarter is left. Then the step is made twice as
 * long, and a little more. */
#include "shooting.h"
#include "common/real.h"
#include "numerics/eigen.h"
#include "numerics/least_norm.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The state comes back to this part of the largest on the way; and this much is aimed for. */
#define TOLERANCE 1e-10
#define AIM 1e-12

/* Half periods at most of the search from the guess; and of another one from what so many periods of marching come to, where
 * static limits may need more of them. */
#define FIRST 120
#define MOST 200
#define MARCHED 20
#define MARCHED_STATIC 100

/* A step pays if the residual falls to this part. */
#define PAYS 0.9

/* Steps that do not pay, one after the other; one of which this many times as much is left on the other side goes too far. */
#define MOST_ASTRAY 2
#define TOO_FAR 10.0

/* A shorter step is good if so much is left along it; it is looked for so often. */
#define LEFT 0.5
#define MOST_TRIALS 3

/* What is left along the steps towards a double root; and how much further than there the step goes. */
#define DOUBLE_FROM 0.15
#define DOUBLE_TO 0.4
#define BEYOND 1.05

/* The matrix I - derivative is not larger than 2: a step shorter than this part of the residual is none. */
#define FLAT 0.4

/* Spans followed at once: so few that a motion which grows with each never seems to come back beside its size. */
#define LONGEST 1024.0

/* A pivot of I - derivative below this may be that of a family of motions, a singular value below CUT is for steps, and one below
 * FREE when they are counted. */
#define SINGULAR 1e-5
#define CUT 1e-9
#define FREE 1e-7

/* A guess that is so much of the motion's size away from the odd one, along the family, is meant. */
#define MEANT 0.1

static double length(const double *x, size_t n)
{
    return sqrt(tribo_dot(x, x, n));
}

static int no_memory(const struct shooting *s)
{
    return tribo_driver_fail(s->map.drv, TRIBO_ERR_MEMORY, "out of memory for periodic motions of %zu degree%s of freedom",
                             s->map.sys->ndof, plural(s->map.sys->ndof));
}

/* -------------------------------------------------------------------------------------------------------------- points */

/* Whether what is left of a motion of that size is this part of it; of what overflows it never is. */
static int comes_back(double residual, double size, double part)
{
    return residual <= part * size && isfinite(size);
}

static int close_enough(const struct point *p, double part)
{
    return comes_back(p->residual, p->size, part);
}

static void exchange(struct shooting *s)
{
    const struct point p = s->here;
    s->here = s->there;
    s->there = p;
}

static void copy_point(const struct shooting *s, struct point *to, const struct point *from)
{
    const size_t n = s->map.n;
    memcpy(to->y, from->y, (4 * n + n * n) * sizeof *to->y); /* all arrays of a point are in one piece */
    to->residual = from->residual;
    to->size = from->size;
    to->torn = from->torn;
    to->other = from->other;
}

/* Goes there, and begins anew from there. */
static void settle(struct shooting *s)
{
    exchange(s);
    copy_point(s, &s->best, &s->here);
    s->astray = 0;
}

/* -------------------------------------------------------------------------------------------------------------- steps */

static double left_along(const struct shooting *s, const struct point *p)
{
    const size_t n = s->map.n;
    return tribo_dot(s->step, p->x, n) - tribo_dot(s->step, p->image, n);
}

/* to [n][n] = (1 + shift) I - derivative */
static void set_matrix(const struct shooting *s, const double *derivative, double shift, double *to)
{
    const size_t n = s->map.n;
    for (size_t i = 0; i < n * n; i++) {
        to[i] = (i % (n + 1) == 0 ? 1.0 + shift : 0.0) - derivative[i];
    }
}

/* s->step with (I + shift - derivative) step = image - x, the least one if there are many. */
static int newton_step(struct shooting *s, double shift)
{
    const size_t n = s->map.n;
    for (size_t i = 0; i < n; i++) {
        s->step[i] = s->here.image[i] - s->here.x[i];
    }
    set_matrix(s, s->here.derivative, shift, s->a);
    if (tribo_lu_create(s->a, n, s->pivot) > SINGULAR) {
        tribo_lu_solve(s->a, n, s->pivot, s->step, 1);
        return TRIBO_OK;
    }
    set_matrix(s, s->here.derivative, shift, s->a);
    return tribo_least_norm_solve(s->a, n, CUT, s->step, NULL) ? TRIBO_OK : no_memory(s);
}

/* s->there = s->here and part of the step. */
static int try_step(struct shooting *s, double part)
{
    memcpy(s->there.x, s->here.x, s->map.n * sizeof *s->there.x);
    tribo_add(s->there.x, part, s->step, s->map.n);
    const int status = tribo_period_map_follow(&s->map, &s->there);
    if (!status) {
        s->ratio = left_along(s, &s->there) / left_along(s, &s->here);
        s->nearest = lesser(s->nearest, s->there.residual / s->there.size);
    }
    return status;
}

/* Where no step changes the residual, as on a slow belt that takes a body along for many periods, the motion is followed for one
 * period, four, and so on at once. */
static int stride(struct shooting *s)
{
    const size_t n = s->map.n;
    memcpy(s->step, s->here.image, n * sizeof *s->step);
    tribo_add(s->step, -1.0, s->here.x, n);
    s->stride = s->stride > 0.0 ? lesser(4.0 * s->stride, LONGEST) : 1.0;
    return try_step(s, s->stride);
}

static int newton(struct shooting *s)
{
    const int to_double = s->rate > DOUBLE_FROM && s->rate < DOUBLE_TO;
    const int status = newton_step(s, 0.0);
    s->map.drv->newton++;
    if (!status && length(s->step, s->map.n) < FLAT * s->here.residual) {
        return stride(s);
    }
    s->stride = 0.0;
    return status ? status : try_step(s, to_double ? BEYOND / (1.0 - sqrt(s->rate)) : 1.0);
}

/* Looks for a shorter step, whose ratio for part 1 is known, between low and high; with a shift, or without. */
static int shorten(struct shooting *s, int shifted)
{
    const double whole = length(s->step, s->map.n);
    double low = 0.0, high = 1.0, at_low = 1.0, at_high = s->first;
    int status = TRIBO_OK;
    for (int k = 0; !status && k < MOST_TRIALS; k++) {
        const double secant = low + (high - low) * at_low / (at_low - at_high), least = low > 0.0 ? sqrt(low * high) : 0.1 * high;
        const double part = at_high < 0.0 ? lesser(greater(secant, least), 0.9 * high) : 0.5 * high;
        status = shifted ? newton_step(s, s->here.residual / (part * whole)) : TRIBO_OK;
        status = status ? status : try_step(s, shifted ? 1.0 : part);
        if (status || s->there.residual < PAYS * s->here.residual || fabs(s->ratio) < LEFT) {
            return status;
        }
        *(s->ratio > 0.0 ? &low : &high) = part;
        *(s->ratio > 0.0 ? &at_low : &at_high) = s->ratio;
    }
    return status;
}

/* s->there is where the motion leads from s->here. */
static int march(struct shooting *s)
{
    memcpy(s->there.x, s->here.image, s->map.n * sizeof *s->there.x);
    return tribo_period_map_follow(&s->map, &s->there);
}

static int turn_back(struct shooting *s)
{
    const int shifted = s->setbacks++ % 2 == 0;
    copy_point(s, &s->here, &s->best);
    int status = newton_step(s, 0.0);
    if (!status && length(s->step, s->map.n) > 0.0) {
        status = shorten(s, shifted);
    }
    if (!status && shifted && !(s->there.residual < PAYS * s->best.residual)) {
        status = march(s);
    }
    if (!status) {
        settle(s);
    }
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- search */

/* After a step. */
static int proceed(struct shooting *s)
{
    s->rate = 0.0;
    if (s->there.residual < PAYS * s->best.residual) {
        settle(s);
        s->rate = s->stride > 0.0 ? 0.0 : s->ratio;
        return TRIBO_OK;
    }
    if (s->stride > 0.0 && s->ratio > 0.0) {
        settle(s);
        return TRIBO_OK;
    }
    s->first = s->astray ? s->first : s->ratio;
    if (s->astray < MOST_ASTRAY && s->ratio > -TOO_FAR) {
        s->astray++;
        exchange(s);
        return TRIBO_OK;
    }
    return turn_back(s);
}

/* From s->here on: s->best. */
static int search(struct shooting *s, size_t halves)
{
    const size_t most = s->map.halves + halves;
    int status = tribo_period_map_follow(&s->map, &s->here);
    if (status) {
        return status;
    }
    copy_point(s, &s->best, &s->here);
    s->astray = s->setbacks = 0;
    s->rate = s->stride = 0.0;
    s->nearest = s->here.residual / s->here.size;
    while (!status && !close_enough(&s->best, AIM) && s->map.halves < most) {
        status = newton(s);
        if (!status && close_enough(&s->best, TOLERANCE) && !(s->there.residual < PAYS * s->best.residual)) {
            break; /* rounding allows no more */
        }
        status = status ? status : proceed(s);
    }
    return status;
}

/* Where contacts hardly slip, or, by static limits, motions part from each other, steps of Newton's may lead nowhere. What
 * marching from the guess comes to is then where to look. */
static int search_again(struct shooting *s, size_t periods)
{
    memcpy(s->here.x, s->guess, s->map.n * sizeof *s->guess);
    const int status = tribo_period_map_march(&s->map, periods, s->here.x);
    return status ? status : search(s, MOST);
}

static int search_all(struct shooting *s)
{
    int status = search(s, FIRST);
    if (!status && !close_enough(&s->best, TOLERANCE)) {
        status = search_again(s, MARCHED);
    }
    if (!status && !close_enough(&s->best, TOLERANCE) && s->map.events->stick_slip.breakaway.some) {
        status = search_again(s, MARCHED_STATIC);
    }
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- the family */

/* s->b = the derivative of the whole period. */
static void whole_derivative(struct shooting *s)
{
    const size_t n = s->map.n;
    const double *d = s->best.derivative;
    if (s->map.odd) {
        memset(s->b, 0, n * n * sizeof *s->b);
        tribo_multiply_add(n, n, n, 1.0, d, d, s->b);
    } else {
        memcpy(s->b, d, n * n * sizeof *s->b);
    }
}

/* Counts the directions in which there are other such motions; takes out of move [n] what leads elsewhere. */
static int find_family(struct shooting *s, double *move)
{
    const size_t n = s->map.n;
    whole_derivative(s);
    set_matrix(s, s->b, 0.0, s->a);
    s->map.drv->freedom = 0;
    if (tribo_lu_create(s->a, n, s->pivot) > SINGULAR) {
        return TRIBO_OK;
    }
    set_matrix(s, s->b, 0.0, s->a);
    for (size_t i = 0; i < n; i++) {
        s->step[i] = tribo_dot(s->a + i * n, move, n);
    }
    if (!tribo_least_norm_solve(s->a, n, FREE, s->step, &s->map.drv->freedom)) {
        return no_memory(s);
    }
    tribo_add(move, -1.0, s->step, n);
    return TRIBO_OK;
}

/* The odd motion is one of a family, and the guess was near another one: that is taken if it comes back. */
static int approach_guess(struct shooting *s)
{
    const size_t n = s->map.n;
    const int any = s->map.odd && length(s->guess, n) > 0.0;
    tribo_add(s->guess, -1.0, s->best.x, n);
    int status = find_family(s, s->guess);
    if (status || !any || s->map.drv->freedom == 0 || length(s->guess, n) < MEANT * s->best.size) {
        return status;
    }
    tribo_period_map_choose(&s->map, 0);
    memcpy(s->here.x, s->best.x, n * sizeof *s->here.x);
    tribo_add(s->here.x, 1.0, s->guess, n);
    status = tribo_period_map_follow(&s->map, &s->here);
    if (!status && close_enough(&s->here, TOLERANCE)) {
        copy_point(s, &s->best, &s->here);
    } else {
        tribo_period_map_choose(&s->map, 1);
    }
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- multipliers */

static double size_of(const struct shooting *s, size_t i)
{
    return hypot(s->re[i], s->im[i]);
}

/* The largest first; pairs, next to each other and of one size, stay as they are. */
static void sort(struct shooting *s)
{
    for (size_t i = 1; i < s->map.n; i++) {
        const double re = s->re[i], im = s->im[i], size = size_of(s, i);
        size_t k = i;
        for (; k > 0 && size_of(s, k - 1) < size; k--) {
            s->re[k] = s->re[k - 1];
            s->im[k] = s->im[k - 1];
        }
        s->re[k] = re;
        s->im[k] = im;
    }
}

static int find_multipliers(struct shooting *s)
{
    const size_t n = s->map.n;
    whole_derivative(s);
    const int status = tribo_eigen(s->b, n, s->re, s->im, s->a);
    sort(s);
    return status
               ? tribo_driver_fail(s->map.drv, status, "multipliers of %zu equation%s: %s", n, plural(n), tribo_strerror(status))
               : TRIBO_OK;
}

/* -------------------------------------------------------------------------------------------------------------- the whole */

static int no_convergence(const struct shooting *s, double residual)
{
    return tribo_driver_fail(
        s->map.drv, TRIBO_ERR_NO_CONVERGENCE,
        "no motion of period %.17g was found in %g periods: the nearest misses its beginning by %.3g of its size", s->map.period,
        0.5 * (double)s->map.halves, residual);
}

static int find(struct shooting *s, double *y)
{
    double residual = 0.0;
    tribo_period_map_coordinates(&s->map, y, s->here.x);
    memcpy(s->guess, s->here.x, s->map.n * sizeof *s->guess);
    int status = search_all(s);
    if (!status && !close_enough(&s->best, TOLERANCE)) {
        return no_convergence(s, s->nearest);
    }
    status = status ? status : approach_guess(s);
    status = status ? status : tribo_period_map_complete(&s->map, &s->best, &residual);
    if (!status && !comes_back(residual, s->best.size, TOLERANCE)) {
        return no_convergence(s, residual / s->best.size);
    }
    status = status ? status : find_multipliers(s);
    if (!status) {
        memcpy(y, s->best.y, s->map.n * sizeof *y);
        y[s->map.n] = 0.0;
        s->found = 1;
        s->revision = tribo_system_revision(s->map.sys);
    }
    return status;
}

int tribo_shooting_find(struct shooting *s, double t, double period, double *y)
{
    tribo_driver *drv = s->map.drv;
    s->found = 0;
    int status = tribo_period_map_prepare(&s->map, t, period, y);
    status = status ? status : find(s, y);
    drv->periods += (s->map.halves + 1) / 2;
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- life */

static double *place_point(struct point *p, size_t n, double *at)
{
    p->y = at;
    p->x = at + n;
    p->end = at + 2 * n;
    p->image = at + 3 * n;
    p->derivative = at + 4 * n;
    return at + 4 * n + n * n;
}

struct shooting *tribo_shooting_create(tribo_driver *drv)
{
    const size_t n = 2 * drv->sys->ndof;
    struct shooting *s = calloc(1, sizeof *s);
    if (!s) {
        return NULL;
    }
    s->memory = malloc((5 * n * n + 16 * n + 1) * sizeof *s->memory);
    s->pivot = malloc((n + 1) * sizeof *s->pivot);
    if (!tribo_period_map_create(&s->map, drv) || !s->memory || !s->pivot) {
        tribo_shooting_free(s);
        return NULL;
    }
    double *next = place_point(&s->best, n, place_point(&s->there, n, place_point(&s->here, n, s->memory)));
    double **const vectors[] = {&s->step, &s->guess, &s->re, &s->im};
    for (size_t k = 0; k < 4; k++) {
        *vectors[k] = next + k * n;
    }
    s->a = next + 4 * n;
    s->b = s->a + n * n;
    return s;
}

void tribo_shooting_free(struct shooting *s)
{
    if (s) {
        tribo_period_map_free(&s->map);
        free(s->memory);
        free(s->pivot);
        free(s);
    }
}
