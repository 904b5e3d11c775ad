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
#include "forecast.h"
#include "common/real.h"
#include "numerics/linalg.h"
#include "numerics/krylov.h"

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

/* Matrices with more rows are not made for steps. These leave the part of the residual that it is of the size, or, if that is
 * more, about the square of what the step before left (Eisenstat and Walker 1996), between two bounds: the motion, which is not
 * linear, leaves about as much. The upper bound keeps steps longer than FLAT. The free structure stands in where its determinants
 * are more than NEARLY_SINGULAR. */
#define DENSE 40
#define MOST_INEXACT 0.15
#define LEAST_INEXACT 1e-6
#define NEARLY_SINGULAR 1e-6

#define UNKNOWN ((size_t)-1)

/* A guess that is so much of the motion's size away from the odd one, along the family, is meant. */
#define MEANT 0.1

/* A guess farther from the forecast than this part of its size is left for the forecast. */
#define FAR 0.1

static double shooting_length(const double *x, size_t n)
{
    return sqrt(tribo_dot(x, x, n));
}

static int shooting_no_memory(const struct shooting *s)
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

static void shooting_exchange(struct shooting *s)
{
    const struct point p = s->here;
    s->here = s->there;
    s->there = p;
}

static void copy_point(const struct shooting *s, struct point *to, const struct point *from)
{
    const size_t n = s->map.n;
    memcpy(to->y, from->y, 4 * n * sizeof *to->y); /* all arrays of a point are in one piece */
    from->derivative->users++;
    tribo_derivative_free(to->derivative);
    to->derivative = from->derivative;
    to->residual = from->residual;
    to->size = from->size;
    to->odd = from->odd;
    to->torn = from->torn;
    to->other = from->other;
}

/* Goes there, and begins anew from there. */
static void shooting_settle(struct shooting *s)
{
    shooting_exchange(s);
    copy_point(s, &s->best, &s->here);
    s->astray = 0;
}

/* -------------------------------------------------------------------------------------------------------------- steps */

static double left_along(const struct shooting *s, const struct point *p)
{
    const size_t n = s->map.n;
    return tribo_dot(s->step, p->x, n) - tribo_dot(s->step, p->image, n);
}

/* a [n][n] = (1 + shift) I - derivative */
static void set_matrix(const struct shooting *s, const double *derivative, double shift)
{
    const size_t n = s->map.n;
    for (size_t i = 0; i < n * n; i++) {
        s->a[i] = (i % (n + 1) == 0 ? 1.0 + shift : 0.0) - derivative[i];
    }
}

/* The matrix (1 + shift) I - derivative at a point, of one span or of two; `from the right` times the inverse that it has for
 * the free structure. */
struct equation {
    struct shooting *s;
    const struct point *at;
    double shift;
    int spans, free;
};

/* x = s->free x */
static void apply_free(const struct shooting *s, double *x)
{
    const size_t half = s->map.sys->ndof;
    for (size_t k = 0; k < half; k++) {
        const double *t = s->free + 4 * k, q = x[k], u = x[half + k];
        x[k] = t[0] * q + t[1] * u;
        x[half + k] = t[2] * q + t[3] * u;
    }
}

static int apply_equation(void *data, double *x)
{
    const struct equation *e = data;
    struct shooting *s = e->s;
    double *moved = s->a;
    int status = TRIBO_OK;
    if (e->free) {
        apply_free(s, x);
    }
    memcpy(moved, x, s->map.n * sizeof *x);
    for (int k = 0; !status && k < e->spans; k++) {
        status = tribo_period_map_apply(&s->map, e->at, moved);
    }
    for (size_t i = 0; i < s->map.n; i++) {
        x[i] = (1.0 + e->shift) * x[i] - moved[i];
    }
    return status;
}

/* x [n], the right-hand side, becomes the solution; *done = 0: there is none, x may be anything. Where contacts rest all
 * the time, there may be many solutions: the Krylov space of a map that brings nothing further apart has the least one. */
static int solve_in_space(struct shooting *s, const struct point *at, double shift, int spans, double tolerance, double *x,
                          int *done)
{
    const int free = !tribo_derivative_rests(at->derivative) && spans == 1;
    struct equation e = {s, at, shift, spans, free};
    double part;
    if (free) {
        /* s->free = inverse of (1 + shift) I - (flow of the free mode over a span), [4] a mode */
        const struct energy_norm *norm = &s->map.norm;
        const double span = s->map.span, sign = s->map.odd ? -1.0 : 1.0;
        for (size_t k = 0; k < norm->n; k++) {
            const double omega = norm->natural[k], half = 0.5 * norm->damping[k], square = omega * omega - half * half;
            const double nu = sqrt(fabs(square)), size = sign * exp(-half * span), c = size * cos(nu * span);
            const double d = nu > 0.0 ? size * sin(nu * span) / nu : 0.0;
            const double qq = 1.0 + shift - (c + half * d), qu = -norm->omega[k] * d, uq = omega * omega / norm->omega[k] * d;
            const double uu = 1.0 + shift - (c - half * d), det = qq * uu - qu * uq;
            const double inverse[] = {uu / det, -qu / det, -uq / det, qq / det};
            static const double unit[] = {1.0, 0.0, 0.0, 1.0};
            memcpy(s->free + 4 * k, square > 0.0 && fabs(det) > NEARLY_SINGULAR ? inverse : unit, sizeof unit);
        }
    }
    const int status = tribo_gmres(s->map.n, apply_equation, &e, tolerance, s->map.n, x, &part, s->space);
    if (free) {
        apply_free(s, x);
    }
    *done = part <= tolerance;
    return status;
}

/* 1 if matrices are too large to be made where that can be avoided. */
static int is_matrix_free(const struct shooting *s)
{
    return s->map.n > DENSE && s->map.events->motion->keep;
}

/* s->step with (I + shift - derivative) step = image - x, the least one if there are many. */
static int newton_step(struct shooting *s, double shift)
{
    const size_t n = s->map.n;
    const double *derivative = NULL, near = s->here.residual / s->here.size;
    const double fell = s->before > 0.0 && near > LEAST_INEXACT ? lesser(s->here.residual / s->before, 1.0) : 0.0;
    const double part = clamp(greater(near, 0.9 * fell * fell), LEAST_INEXACT, MOST_INEXACT);
    int done = 0, status = TRIBO_OK;
    for (int large = is_matrix_free(s); large >= 0 && !status && !done; large--) {
        for (size_t i = 0; i < n; i++) {
            s->step[i] = s->here.image[i] - s->here.x[i];
        }
        status = large ? solve_in_space(s, &s->here, shift, 1, part, s->step, &done) : TRIBO_OK;
    }
    status = status || done ? status : tribo_period_map_matrix(&s->map, &s->here, &derivative);
    if (status || done) {
        return status;
    }
    set_matrix(s, derivative, shift);
    if (tribo_lu_create(s->a, n, s->pivot) > SINGULAR) {
        tribo_lu_solve(s->a, n, s->pivot, s->step, 1);
        return TRIBO_OK;
    }
    set_matrix(s, derivative, shift);
    return tribo_least_norm_solve(s->a, n, CUT, s->step, NULL) ? TRIBO_OK : shooting_no_memory(s);
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
    s->before = s->here.residual;
    if (!status && shooting_length(s->step, s->map.n) < FLAT * s->here.residual) {
        return stride(s);
    }
    s->stride = 0.0;
    return status ? status : try_step(s, to_double ? BEYOND / (1.0 - sqrt(s->rate)) : 1.0);
}

/* Looks for a shorter step, whose ratio for part 1 is known, between low and high; with a shift, or without. */
static int shorten(struct shooting *s, int shifted)
{
    const double whole = shooting_length(s->step, s->map.n);
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

/* -------------------------------------------------------------------------------------------------------------- search */

/* After a step. */
static int proceed(struct shooting *s)
{
    s->rate = 0.0;
    if (s->there.residual < PAYS * s->best.residual) {
        shooting_settle(s);
        s->rate = s->stride > 0.0 ? 0.0 : s->ratio;
        return TRIBO_OK;
    }
    if (s->stride > 0.0 && s->ratio > 0.0) {
        shooting_settle(s);
        return TRIBO_OK;
    }
    s->first = s->astray ? s->first : s->ratio;
    if (s->astray < MOST_ASTRAY && s->ratio > -TOO_FAR) {
        s->astray++;
        shooting_exchange(s);
        return TRIBO_OK;
    }
    const int shifted = s->setbacks++ % 2 == 0;
    copy_point(s, &s->here, &s->best);
    int status = newton_step(s, 0.0);
    if (!status && shooting_length(s->step, s->map.n) > 0.0) {
        status = shorten(s, shifted);
    }
    if (!status && shifted && !(s->there.residual < PAYS * s->best.residual)) {
        /* s->there: the image of s->here */
        memcpy(s->there.x, s->here.image, s->map.n * sizeof *s->there.x);
        status = tribo_period_map_follow(&s->map, &s->there);
    }
    if (!status) {
        shooting_settle(s);
    }
    return status;
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
    s->rate = s->stride = s->before = 0.0;
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

/* From the forecast on, unless the guess is near it. *done = 0: the motion is not found, also where motions from there on fail. */
static int search_from_forecast(struct shooting *s, int *done)
{
    const size_t n = s->map.n;
    const int may = s->map.odd && !s->map.events->stick_slip.breakaway.some && s->map.scale == 1.0;
    int status = may ? tribo_forecast(&s->map, s->here.x, done) : TRIBO_OK;
    if (!status && *done) {
        memcpy(s->step, s->guess, n * sizeof *s->step);
        tribo_add(s->step, -1.0, s->here.x, n);
        *done = shooting_length(s->step, n) > FAR * shooting_length(s->here.x, n);
    }
    if (!status && *done) {
        status = search(s, FIRST);
        *done = !status && close_enough(&s->best, TOLERANCE);
        status = status == TRIBO_ERR_MEMORY ? status : TRIBO_OK;
    }
    return status;
}

static int search_all(struct shooting *s)
{
    int done = 0, status = search_from_forecast(s, &done);
    if (status || done) {
        return status;
    }
    memcpy(s->here.x, s->guess, s->map.n * sizeof *s->guess);
    status = search(s, FIRST);
    if (!status && !close_enough(&s->best, TOLERANCE)) {
        status = search_again(s, MARCHED);
    }
    if (!status && !close_enough(&s->best, TOLERANCE) && s->map.events->stick_slip.breakaway.some) {
        status = search_again(s, MARCHED_STATIC);
    }
    /* Under static limits a motion may be stable and not odd, though all that drives it is. */
    if (!status && !close_enough(&s->best, TOLERANCE) && s->map.odd && s->map.events->stick_slip.breakaway.some) {
        tribo_period_map_choose(&s->map, 0);
        memcpy(s->here.x, s->guess, s->map.n * sizeof *s->guess);
        status = search(s, FIRST);
        if (!status && !close_enough(&s->best, TOLERANCE)) {
            status = search_again(s, MARCHED_STATIC);
        }
    }
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- the family */

/* s->b = the derivative of the whole period. */
static int whole_derivative(struct shooting *s)
{
    const size_t n = s->map.n;
    const double *d = NULL;
    const int status = tribo_period_map_matrix(&s->map, &s->best, &d);
    if (!status && s->best.odd) {
        memset(s->b, 0, n * n * sizeof *s->b);
        tribo_multiply_add(n, n, n, 1.0, d, d, s->b);
    } else if (!status) {
        memcpy(s->b, d, n * n * sizeof *s->b);
    }
    return status;
}

/* Counts the directions in which there are other such motions; takes out of move [n] what leads elsewhere. */
static int find_family(struct shooting *s, double *move)
{
    const size_t n = s->map.n;
    const int status = whole_derivative(s);
    if (status) {
        return status;
    }
    set_matrix(s, s->b, 0.0);
    s->freedom = 0;
    if (tribo_lu_create(s->a, n, s->pivot) > SINGULAR) {
        memset(move, 0, n * sizeof *move);
        return TRIBO_OK;
    }
    set_matrix(s, s->b, 0.0);
    memset(s->step, 0, n * sizeof *s->step);
    tribo_multiply_add(n, n, 1, 1.0, s->a, move, s->step);
    if (!tribo_least_norm_solve(s->a, n, FREE, s->step, &s->freedom)) {
        s->freedom = UNKNOWN;
        return shooting_no_memory(s);
    }
    tribo_add(move, -1.0, s->step, n);
    return TRIBO_OK;
}

/* Takes out of move [n] what leads out of the family, if there is one. Where all contacts slide, and all modes are damped, there
 * is none. */
static int stay_in_family(struct shooting *s, double *move)
{
    const size_t n = s->map.n;
    int status = TRIBO_OK, done = 0;
    if (is_matrix_free(s)) {
        if (tribo_energy_norm_is_damped(&s->map.norm) && !tribo_derivative_rests(s->best.derivative)) {
            memset(move, 0, n * sizeof *move);
            return TRIBO_OK;
        }
        memcpy(s->step, move, n * sizeof *move);
        status = apply_equation(&(struct equation){s, &s->best, 0.0, 2, 0}, s->step);
        status = status ? status : solve_in_space(s, &s->best, 0.0, 2, AIM, s->step, &done);
    }
    if (!status && done) {
        tribo_add(move, -1.0, s->step, n);
    }
    return status || done ? status : find_family(s, move);
}

/* The odd motion may be one of a family, and the guess near another one: that is taken if it comes back. */
static int approach_guess(struct shooting *s)
{
    const size_t n = s->map.n;
    const int any = s->map.odd && shooting_length(s->guess, n) > 0.0;
    tribo_add(s->guess, -1.0, s->best.x, n);
    int status = any && shooting_length(s->guess, n) >= MEANT * s->best.size ? stay_in_family(s, s->guess) : TRIBO_OK;
    if (status || !any || shooting_length(s->guess, n) < MEANT * s->best.size) {
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

int tribo_shooting_freedom(struct shooting *s, size_t *freedom)
{
    const int status = s->freedom == UNKNOWN ? find_family(s, s->guess) : TRIBO_OK;
    *freedom = status ? *freedom : s->freedom;
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- multipliers */

/* The largest first; pairs, next to each other and of one size, stay as they are. */
static void sort(size_t n, double *all_re, double *all_im)
{
    for (size_t i = 1; i < n; i++) {
        const double re = all_re[i], im = all_im[i], size = hypot(re, im);
        size_t k = i;
        for (; k > 0 && hypot(all_re[k - 1], all_im[k - 1]) < size; k--) {
            all_re[k] = all_re[k - 1];
            all_im[k] = all_im[k - 1];
        }
        all_re[k] = re;
        all_im[k] = im;
    }
}

int tribo_shooting_multipliers(struct shooting *s, double *re, double *im)
{
    const size_t n = s->map.n;
    int status = whole_derivative(s);
    if (status) {
        return status;
    }
    double *all_re = s->step, *all_im = s->guess;
    status = tribo_eigen(s->b, n, all_re, all_im, s->a);
    if (!status) { /* a caller's state has more values, which follow: their multipliers are 0 */
        const size_t more = (tribo_system_dimension(s->map.sys) - 1 - n) * sizeof *re;
        sort(n, all_re, all_im);
        memcpy(re, all_re, n * sizeof *re);
        memcpy(im, all_im, n * sizeof *im);
        memset(re + n, 0, more);
        memset(im + n, 0, more);
    }
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

static int shooting_find(struct shooting *s, double *y)
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
    s->freedom = UNKNOWN;
    int status = tribo_period_map_prepare(&s->map, t, period, y);
    status = status ? status : shooting_find(s, y);
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
    return at + 4 * n;
}

struct shooting *tribo_shooting_create(tribo_driver *drv)
{
    const size_t n = tribo_system_energy(drv->sys);
    struct shooting *s = calloc(1, sizeof *s);
    if (!s) {
        return NULL;
    }
    s->memory = malloc((2 * n * n + 16 * n + tribo_gmres_room(n, n) + 1) * sizeof *s->memory);
    s->pivot = malloc((n + 1) * sizeof *s->pivot);
    if (!tribo_period_map_create(&s->map, drv) || !s->memory || !s->pivot) {
        tribo_shooting_free(s);
        return NULL;
    }
    s->step = place_point(&s->best, n, place_point(&s->there, n, place_point(&s->here, n, s->memory)));
    s->guess = s->step + n;
    s->free = s->guess + n;
    s->a = s->free + 2 * n;
    s->b = s->a + n * n;
    s->space = s->b + n * n;
    return s;
}

void tribo_shooting_free(struct shooting *s)
{
    if (s) {
        tribo_derivative_free(s->here.derivative);
        tribo_derivative_free(s->there.derivative);
        tribo_derivative_free(s->best.derivative);
        tribo_period_map_free(&s->map);
        free(s->memory);
        free(s->pivot);
        free(s);
    }
}
