/* Newton's method for r(x) = x - image(x) = 0. The map never increases the distance of two states in the energy norm
 * (energy_norm.h), so r is monotone: step'r(x + part step) rises with part from below zero, and is zero at the right length. This
 * product, and not |r|, measures a step: where contacts begin to slip, |r| may have to rise for some steps.
 *
 *     repeat
 *         find Newton's step, and integrate from its end
 *         accept the step if the residual falls
 *         otherwise continue from the end, for a few steps, unless the step has gone much too far
 *         otherwise go back to the best point and shorten its step, in turn by a shift of the matrix, which shortens the
 *             directions first where a small force makes a large motion, or by a factor; if no shifted step is good, take
 *             the image as the next point, because contacts that come to rest forget the initial state
 *
 * If a contact hardly slips, r goes with the square of the distance to states where the contact rests, the border of a family
 * of solutions (a double root): Newton's steps halve each time, and ratio = 1/4. Then the step is made twice as long, and a
 * little more. */
#include "shooting.h"
#include "forecast.h"
#include "common/real.h"
#include "numerics/linalg.h"
#include "numerics/krylov.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Residual over size: TOLERANCE of a motion that is found, AIM that ends the search. */
#define TOLERANCE 1e-10
#define AIM 1e-12

/* FIRST: half periods, at most, of the search from the guess. MOST: the same of a search from the state after MARCHED periods
 * from the guess, or after MARCHED_STATIC, since static limits may need more. */
#define FIRST 120
#define MOST 200
#define MARCHED 20
#define MARCHED_STATIC 100

/* A step is successful if the residual falls to this part. */
#define PAYS 0.9

/* MOST_ASTRAY: unsuccessful steps in a row. TOO_FAR: a step with ratio <= -TOO_FAR has gone too far. */
#define MOST_ASTRAY 2
#define TOO_FAR 10.0

/* LEFT: |ratio| below which a shorter step is good. MOST_TRIALS: number of shorter steps tried. */
#define LEFT 0.5
#define MOST_TRIALS 3

/* DOUBLE_FROM, DOUBLE_TO: range of ratio near a double root. BEYOND: length of the step over the distance to the double root. */
#define DOUBLE_FROM 0.15
#define DOUBLE_TO 0.4
#define BEYOND 1.05

/* |I - derivative| <= 2: a step shorter than this part of the residual cannot solve the equation. */
#define FLAT 0.4

/* Most spans extrapolated at once: few enough that a motion that grows in each span has residual > TOLERANCE size. */
#define LONGEST 1024.0

/* SINGULAR: pivot of I - derivative below which there may be a family of motions. Singular values are zero below CUT in steps,
 * and below FREE in the dimension of the family. */
#define SINGULAR 1e-5
#define CUT 1e-9
#define FREE 1e-7

/* DENSE: with more rows, steps are solved by GMRES without a matrix, to a part of the residual: residual/size, or, if larger, 0.9
 * (residual/previous residual)^2 (Eisenstat and Walker 1996), within [LEAST_INEXACT, MOST_INEXACT], because the nonlinear motion
 * leaves about as much. MOST_INEXACT keeps steps longer than FLAT. NEARLY_SINGULAR: the free structure preconditions modes with
 * a larger determinant. */
#define DENSE 40
#define MOST_INEXACT 0.15
#define LEAST_INEXACT 1e-6
#define NEARLY_SINGULAR 1e-6

#define UNKNOWN ((size_t)-1)

/* A guess chooses a motion of the family if its distance from the odd motion along the family is this part of the size. */
#define MEANT 0.1

/* The search starts from the forecast if |guess - forecast| > FAR |forecast|. */
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

/* Returns 1 if residual <= part size and size is finite. */
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
    memcpy(to->y, from->y, 4 * n * sizeof *to->y); /* y, x, end and image are contiguous */
    from->derivative->users++;
    tribo_derivative_free(to->derivative);
    to->derivative = from->derivative;
    to->residual = from->residual;
    to->size = from->size;
    to->odd = from->odd;
    to->torn = from->torn;
    to->other = from->other;
}

/* Accepts the step: here = best = there, astray = 0. */
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

/* The matrix (1 + shift) I - D, D = the derivative at the point `at` over 1 or 2 spans; free = 1: times s->free from the right,
 * its inverse for the free structure. */
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

/* Solves in place for x [n], first the right-hand side. *done = 0: no solution, x undefined. If contacts rest all the time, there
 * may be many solutions: the Krylov space, then without s->free, of a map that increases no distance has the shortest. */
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

/* Returns 1 if n > DENSE and phases are kept: then steps are solved without a matrix. */
static int is_matrix_free(const struct shooting *s)
{
    return s->map.n > DENSE && s->map.events->motion->keep;
}

/* Sets s->step, the shortest solution of ((1 + shift) I - derivative) step = image - x. Returns a status. */
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

/* Sets s->there from there.x = here.x + part step, s->ratio and s->nearest. Returns a status. */
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

/* Sets s->there from there.x = here.x + stride (image - x), stride = 1, 4, 16, ... spans, where no step changes the residual, as
 * on a slow belt that carries a body for many periods. Returns a status. */
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

/* Tries shorter steps, part in (low, high); ratio = s->first at part 1. shifted = 1: steps by a shifted matrix. */
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

/* Accepts or rejects s->there after a step. Returns a status. */
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
        /* there = the image of here */
        memcpy(s->there.x, s->here.image, s->map.n * sizeof *s->there.x);
        status = tribo_period_map_follow(&s->map, &s->there);
    }
    if (!status) {
        shooting_settle(s);
    }
    return status;
}

/* Searches from s->here for at most `halves` half periods; the result is s->best. Returns a status. */
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
            break; /* limit of rounding */
        }
        status = status ? status : proceed(s);
    }
    return status;
}

/* Searches from the state `periods` periods after the guess: where contacts hardly slip, or static limits make motions diverge,
 * Newton's steps may fail. Returns a status. */
static int search_again(struct shooting *s, size_t periods)
{
    memcpy(s->here.x, s->guess, s->map.n * sizeof *s->guess);
    const int status = tribo_period_map_march(&s->map, periods, s->here.x);
    return status ? status : search(s, MOST);
}

/* Searches from the forecast, unless the guess is near it. *done = 0: not found, also after a failed integration. */
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
    /* With static limits a stable motion may be not odd, although all drives are odd. */
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

/* Sets s->b = the derivative over the whole period. Returns a status. */
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

/* Sets s->freedom = dimension of the kernel of I - derivative, and projects move [n] on the kernel. Returns a status. */
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

/* Projects move [n] on the family of periodic motions. If all modes are damped and no contact rests in all phases, there is no
 * family: move = 0. Returns a status. */
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

/* Takes the motion nearest to the guess in the family of the odd motion, if that motion comes back. */
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

/* Sorts by size, the largest first. The order within pairs, neighbours of equal size, stays. */
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
    if (!status) { /* further values of a caller's state depend on these: their multipliers are 0 */
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
