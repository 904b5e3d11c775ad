/* SPDX-License-Identifier: BSD-3-Clause */
/* Newton's method for r(x) = x - image(x) = 0. The map never increases the distance of two states in the energy norm
 * (energy_norm.h), so r is monotone: step'r(x + part step) rises with part from below zero, and is zero at the right length. This
 * product, and not |r|, measures a step: where contacts begin to slip, |r| may have to rise for some steps.
 *
 *     repeat
 *         find Newton's step, and integrate from its end
 *         shorten the step, a few times, until the residual falls or the product is small
 *
 * If a contact hardly slips, r goes with the square of the distance to states where the contact rests, the border of a family
 * of solutions (a double root): Newton's steps halve each time, and ratio = 1/4. Then the step is made twice as long, and a
 * little more.
 *
 * Where limits follow the motion, friction may feed energy in, the map may increase distances, and r is not monotone. Then |r|
 * measures a step, which is halved until |r| falls; if it does not, the search begins anew some periods later.
 *
 * Unknowns beside x (struct border), such as the period of a cycle, have as many conditions: Newton's equation is bordered by
 * their columns and rows, and |r| with the conditions measures a step. */
#include "shooting.h"
#include "common/layout.h"
#include "common/real.h"
#include "numerics/linalg.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Residual over size that ends the search; in a ring divided by the number of parts, as errors of the parts add up. */
#define AIM 1e-12

/* Half periods, at most, of a search. */
#define MOST 200

/* A step is successful if the residual falls to this part. */
#define PAYS 0.9

/* LEFT: |ratio| below which a shorter step is good. HALVED: most halvings of a step; MOST_HALVED: likewise, if may_diverge. */
#define LEFT 0.5
enum { HALVED = 3, MOST_HALVED = 6 };

/* DOUBLE_FROM, DOUBLE_TO: range of ratio near a double root. BEYOND: length of the step over the distance to the double root. */
#define DOUBLE_FROM 0.15
#define DOUBLE_TO 0.4
#define BEYOND 1.05

/* |I - derivative| <= 2: a step shorter than this part of the residual cannot solve the equation. */
#define FLAT 0.4

/* Most spans extrapolated at once: few enough that a motion that grows in each span has residual > TRIBO_PERIODIC size. */
#define LONGEST 1024.0

/* SINGULAR: right-hand side over solution of a nearly singular equation. Singular values of I - derivative are zero below CUT in
 * steps, and below FREE in the dimension of the family. */
#define SINGULAR 1e-5
#define CUT 1e-9
#define FREE 1e-7

/* Steps are solved by GMRES to a part of the residual: residual/size, or, if larger, 0.9 (residual/previous residual)^2
 * (Eisenstat and Walker 1996), within [LEAST_INEXACT, MOST_INEXACT], because the nonlinear motion leaves about as much; and at
 * most the root of residual/size, because near a double root inexact steps stray. MOST_INEXACT keeps steps longer than FLAT,
 * and what they leave below DOUBLE_FROM. NEARLY_SINGULAR: the free structure preconditions modes with a larger determinant. */
#define MOST_INEXACT 0.1
#define LEAST_INEXACT 1e-6
#define NEARLY_SINGULAR 1e-6

/* Values of a state up to which many equations are solved by the matrix. */
#define DIRECT 200

/* AT_ONCE: a velocity below AT_ONCE times the largest velocity of a motion may be rounding, and its sign may differ between
 * the beginning and the end of a period. LASTS: largest residual over size of a periodic motion, from another beginning of the
 * period. */
#define AT_ONCE 1e-8
#define LASTS 1e-6

/* Distance of two multipliers over the size of the larger one, cosine of the angle of u and w, and size of lambda times that
 * cosine, below which a multiplier is not simple, or rounding. */
#define SIMPLE 1e-6
#define ROUNDING 1e-9

/* A guess chooses a motion of the family if its distance from the odd motion along the family is this part of the size. */
#define MEANT 0.1

/* The search starts from the forecast if |guess - forecast| > FAR |forecast|. */
#define FAR 0.1

int tribo_shooting_fails(const struct shooting *s, double residual)
{
    return tribo_error(s->map.drv->message, TRIBO_ERR_NO_CONVERGENCE,
                       "no motion of period %.17g was found in %g periods: the nearest misses its beginning by %.3g of its size",
                       s->map.period, tribo_periods_followed(&s->map), residual);
}

static int no_memory(const struct shooting *s)
{
    return tribo_error(s->map.drv->message, TRIBO_ERR_MEMORY, "out of memory for periodic motions of %zu degree%s of freedom",
                       s->map.sys->ndof, plural(s->map.sys->ndof));
}

/* -------------------------------------------------------------------------------------------------------------- points */

int tribo_point_is_closed(const struct point *p, double part)
{
    return p->residual <= part * p->size && isfinite(p->size);
}

void tribo_shooting_turn(struct shooting *s)
{
    struct point *const left = s->here;
    s->here = s->there;
    s->there = left;
}

/* to [n] = image - x of the point p. */
static void find_misfit(const struct shooting *s, const struct point *p, double *to)
{
    memcpy(to, p->image, s->map.n * sizeof *to);
    tribo_add(to, -1.0, p->x, s->map.n);
}

int tribo_shooting_follow(struct shooting *s, struct point *p)
{
    const size_t k = s->extra.count;
    int status = k ? s->extra.apply(s, p) : TRIBO_OK;
    if (status == TRIBO_ERR_NO_CONVERGENCE) {
        p->residual = p->size = HUGE_VAL;
        return TRIBO_OK;
    }
    status = status ? status : tribo_period_map_follow(&s->map, p);
    if (k && !status) {
        status = s->extra.border(s, p);
        p->residual = hypot(p->residual, tribo_energy_length(p->value, k));
    }
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- steps */

static double left_along(const struct shooting *s, const struct point *p)
{
    const size_t n = s->map.n;
    return tribo_dot(s->step, p->x, n) - tribo_dot(s->step, p->image, n);
}

/* Flow of a mode of the free structure: its coordinates are multiplied by [qq, qu; uq, uu]. */
struct free_flow {
    double qq, qu, uq, uu;
};

/* Returns the flow of mode k over a span, times sign; all 0 if the mode does not vibrate. */
static struct free_flow free_flow_of(const struct energy_norm *norm, size_t k, double span, double sign)
{
    const double omega = norm->natural[k], half = 0.5 * norm->damping[k], square = omega * omega - half * half;
    const double nu = sqrt(fabs(square)), size = sign * exp(-half * span), c = size * cos(nu * span);
    const double d = nu > 0.0 ? size * sin(nu * span) / nu : 0.0;
    return square > 0.0 ? (struct free_flow){c + half * d, norm->omega[k] * d, -omega * omega / norm->omega[k] * d, c - half * d}
                        : (struct free_flow){0.0, 0.0, 0.0, 0.0};
}

/* x = (I - F)^-1 x, F: flow of the free structure over a span, times sign; modes without vibration, and modes for which that is
 * nearly singular, stay, and stay [n] = their part of x, which becomes 0 in x; NULL: they stay in x. */
static void solve_free(const struct shooting *s, double span, double sign, double *stay, double *x)
{
    const struct energy_norm *norm = &s->map.norm;
    if (stay) {
        memcpy(stay, x, s->map.n * sizeof *x);
    }
    for (size_t k = 0; k < norm->n; k++) {
        const struct free_flow f = free_flow_of(norm, k, span, sign);
        const double det = (1.0 - f.qq) * (1.0 - f.uu) - f.qu * f.uq, q = x[k], u = x[norm->n + k];
        const int solves = (f.qq != 0.0 || f.qu != 0.0) && fabs(det) > NEARLY_SINGULAR;
        if (solves) {
            x[k] = ((1.0 - f.uu) * q + f.qu * u) / det;
            x[norm->n + k] = ((1.0 - f.qq) * u + f.uq * q) / det;
        }
        if (stay) {
            *(solves ? &stay[k] : &x[k]) = 0.0;
            *(solves ? &stay[norm->n + k] : &x[norm->n + k]) = 0.0;
        }
    }
    memset(x + 2 * norm->n, 0, (stay ? norm->springs : 0) * sizeof *x);
}

/* If s->preconditions, x = (I - F)^-1 x, F: flow of the free structure over a span, in a ring then turned back. There
 * (I - F)^-1 = (I + F + ... + F^(parts - 1)) (I - F^parts)^-1, and turned back by all parts a state is itself; or, if all drives
 * are odd, by half of the parts minus itself. Uses s->a. */
static void apply_free(struct shooting *s, double *x)
{
    const struct ring *r = &s->map.ring;
    const struct energy_norm *norm = &s->map.norm;
    const size_t n = s->map.n, parts = s->map.alternates ? r->parts / 2 : r->parts;
    double *stay = s->a, *first = stay + n;
    if (!s->preconditions) {
        return;
    }
    if (!r->sectors) {
        solve_free(s, s->map.span, s->map.odd ? -1.0 : 1.0, NULL, x);
        return;
    }
    solve_free(s, (double)parts * s->map.span, s->map.alternates ? -1.0 : 1.0, stay, x);
    memcpy(first, x, n * sizeof *x);
    for (size_t p = 1; p < parts; p++) {
        for (size_t k = 0; k < norm->n; k++) {
            const struct free_flow f = free_flow_of(norm, k, s->map.span, 1.0);
            const double q = x[k], u = x[norm->n + k];
            x[k] = f.qq * q + f.qu * u;
            x[norm->n + k] = f.uq * q + f.uu * u;
        }
        tribo_period_map_turn(&s->map, x);
        tribo_add(x, 1.0, first, n);
    }
    tribo_add(x, 1.0, stay, n);
}

/* x = (I - D) x, D = the derivative at s->here over s->spans spans; apply_free first. */
static int apply_equation(void *data, double *x)
{
    struct shooting *s = data;
    int status = TRIBO_OK;
    apply_free(s, x);
    memcpy(s->a, x, s->map.n * sizeof *x);
    for (size_t k = 0; !status && k < s->spans; k++) {
        status = tribo_period_map_apply(&s->map, s->here, s->a);
    }
    tribo_add(x, -1.0, s->a, s->map.n);
    return status;
}

/* Sets s->b = D, the derivative at p over `spans` spans. Returns a status. */
static int find_derivative(struct shooting *s, struct point *p, size_t spans)
{
    const size_t n = s->map.n;
    const int status = tribo_period_map_matrix(&s->map, p);
    const double *d = p->derivative.matrix;
    if (!status) {
        memcpy(s->b, d, n * n * sizeof *s->b);
    }
    for (size_t k = 1; !status && k < spans; k++) {
        memcpy(s->a, s->b, n * n * sizeof *s->b);
        memset(s->b, 0, n * n * sizeof *s->b);
        tribo_multiply_add(n, n, n, 1.0, d, s->a, s->b);
    }
    if (!status && spans > 1 && s->map.ring.sectors) { /* on again, by what all parts have turned back */
        const size_t turned = spans * s->map.ring.step % s->map.ring.sectors;
        tribo_energy_norm_state(&s->map.norm, n, s->b, s->a);
        tribo_ring_turn(&s->map, (s->map.ring.sectors - turned) % s->map.ring.sectors, 1.0, n, s->a, s->map.turned);
        tribo_energy_norm_of(&s->map.norm, n, s->map.turned, s->b);
    }
    return status;
}

/* x [n + count] = the shortest solution of (I - D) y = x, D over `spans` spans from p, bordered by the columns and rows of
 * `count` unknowns, by a matrix, with singular values below cut taken as zero; *kernel = their number. Returns a status. */
static int solve_dense(struct shooting *s, struct point *p, size_t spans, size_t count, double cut, double *x, size_t *kernel)
{
    const size_t n = s->map.n, all = n + count;
    const int status = find_derivative(s, p, spans);
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            s->a[i * all + j] = (i == j ? 1.0 : 0.0) - s->b[i * n + j];
        }
        for (size_t k = 0; k < count; k++) {
            s->a[i * all + n + k] = -p->border[k * n + i];
        }
    }
    memcpy(s->a + n * all, p->border + count * n, count * all * sizeof *s->a);
    return status || tribo_least_norm_solve(s->a, all, cut, x, kernel) ? status : no_memory(s);
}

/* x [n] = the shortest solution of (I - D) y = x, D over s->spans spans from s->here, by GMRES to `tolerance`: if contacts
 * rest all the time, there may be many solutions; the Krylov space, then without apply_free, of a map that increases no
 * distance has the shortest. If that fails, and if the equation is nearly singular, by a matrix. Returns a status. */
static int solve_equation(struct shooting *s, double tolerance, double cut, double *x)
{
    const size_t n = s->map.n;
    double part;
    memcpy(s->b, x, n * sizeof *x);
    s->preconditions = s->spans == 1 && !tribo_derivative_rests(&s->here->derivative);
    const int status = tribo_gmres(n, apply_equation, s, tolerance, n, x, &part, s->space);
    apply_free(s, x);
    s->preconditions = 0;
    if (status || (part <= tolerance && SINGULAR * tribo_energy_length(x, n) <= tribo_energy_length(s->b, n))) {
        return status;
    }
    memcpy(x, s->b, n * sizeof *x);
    return solve_dense(s, s->here, s->spans, 0, cut, x, NULL);
}

/* Sets s->there from there.x = here.x + part step, s->ratio and s->nearest. Returns a status. */
static int try_step(struct shooting *s, double part)
{
    memcpy(s->there->x, s->here->x, s->map.n * sizeof *s->there->x);
    tribo_add(s->there->x, part, s->step, s->map.n);
    memcpy(s->there->unknown, s->here->unknown, sizeof s->here->unknown);
    tribo_add(s->there->unknown, part, s->step + s->map.n, s->extra.count);
    const int status = tribo_shooting_follow(s, s->there);
    if (!status) {
        s->ratio = left_along(s, s->there) / left_along(s, s->here);
        s->nearest = isfinite(s->there->size) ? lesser(s->nearest, s->there->residual / s->there->size) : s->nearest;
    }
    return status;
}

/* Returns 1 if the residual has fallen by the step. */
static int pays(const struct shooting *s)
{
    return s->there->residual < PAYS * s->here->residual;
}

/* Returns 1 if the map may increase distances: limits follow the motion, K is not symmetric, or there are unknowns beside x. */
static int may_diverge(const struct shooting *s)
{
    return s->map.sys->normals.count > 0 || s->map.sys->circulation > 0.0 || s->extra.count > 0;
}

/* Takes Newton's step s->step, the shortest solution of (I - derivative) step = image - x; or, where no step changes the
 * residual, as on a slow belt that carries a body for many periods, extrapolates 1, 4, 16, ... spans. *part = length of the
 * step over s->step. Returns a status. */
static int newton(struct shooting *s, double *part)
{
    const int to_double = s->rate > DOUBLE_FROM && s->rate < DOUBLE_TO;
    const double near = s->here->residual / s->here->size;
    const double fell = s->before > 0.0 && near > LEAST_INEXACT ? lesser(s->here->residual / s->before, 1.0) : 0.0;
    const double most = lesser(MOST_INEXACT, sqrt(near));
    find_misfit(s, s->here, s->step);
    for (size_t k = 0; k < s->extra.count; k++) {
        s->step[s->map.n + k] = -s->here->value[k];
    }
    s->spans = 1;
    const int status = s->extra.count
                           ? solve_dense(s, s->here, 1, s->extra.count, CUT, s->step, NULL)
                           : solve_equation(s, clamp(greater(near, 0.9 * fell * fell), LEAST_INEXACT, most), CUT, s->step);
    s->map.drv->newton++;
    s->before = s->here->residual;
    s->stride = s->stride > 0.0 ? lesser(4.0 * s->stride, LONGEST) : 1.0;
    if (!status && !may_diverge(s) && tribo_energy_length(s->step, s->map.n) < FLAT * s->here->residual) {
        find_misfit(s, s->here, s->step);
        *part = s->stride;
    } else {
        s->stride = 0.0;
        *part = to_double && !may_diverge(s) ? BEYOND / (1.0 - sqrt(s->rate)) : 1.0;
    }
    return status ? status : try_step(s, *part);
}

/* Halves a step of length part until it is good. Returns a status. */
static int shorten(struct shooting *s, double part)
{
    const int diverges = may_diverge(s), most = diverges ? MOST_HALVED : HALVED;
    int status = TRIBO_OK, good = 0;
    for (int k = 0; !status && !good && k < most; k++) {
        part *= 0.5;
        status = try_step(s, part);
        good = pays(s) || (!diverges && fabs(s->ratio) < LEFT);
    }
    return status;
}

int tribo_shooting_tangent(struct shooting *s, double *x)
{
    const size_t count = s->extra.count, all = s->map.n + count;
    memset(x, 0, all * sizeof *x);
    x[all - 1] = 1.0;
    return solve_dense(s, s->here, 1, count, CUT, x, NULL);
}

int tribo_shooting_solve(struct shooting *s, size_t columns, double *x)
{
    const size_t n = s->map.n, direct = n <= DIRECT;
    int *pivot = malloc((n + 1) * sizeof *pivot);
    int status = !pivot ? no_memory(s) : direct ? find_derivative(s, s->here, 1) : TRIBO_OK;
    for (size_t i = 0; direct && !status && i < n * n; i++) {
        s->a[i] = (i % (n + 1) == 0 ? 1.0 : 0.0) - s->b[i];
    }
    const int regular = direct && !status && tribo_lu_create(s->a, n, pivot) > FREE;
    if (regular) {
        tribo_lu_solve(s->a, n, pivot, x, columns);
    }
    s->spans = 1;
    for (size_t j = 0; !status && !regular && j < columns; j++) {
        for (size_t i = 0; i < n; i++) {
            s->step[i] = x[i * columns + j];
        }
        status = tribo_energy_length(s->step, n) > 0.0 ? solve_equation(s, AIM, FREE, s->step) : TRIBO_OK;
        for (size_t i = 0; i < n; i++) {
            x[i * columns + j] = s->step[i];
        }
    }
    free(pivot);
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- search */

int tribo_shooting_search(struct shooting *s)
{
    const size_t most = s->map.halves + MOST;
    int status = tribo_shooting_follow(s, s->here);
    if (status) {
        return status;
    }
    s->rate = s->stride = s->before = 0.0;
    s->nearest = s->here->residual / s->here->size;
    const double part_of = 1.0 / (double)s->map.ring.parts, aim = AIM * part_of;
    while (!status && isfinite(s->here->size) && !tribo_point_is_closed(s->here, aim) && s->map.halves < most) {
        double part;
        status = newton(s, &part);
        const int falls = !status && pays(s);
        if (!status && !falls && tribo_point_is_closed(s->here, TRIBO_PERIODIC * part_of)) {
            break; /* limit of rounding */
        }
        s->rate = falls && s->stride == 0.0 ? s->ratio : 0.0;
        if (!status && !falls && !(s->stride > 0.0 && s->ratio > 0.0)) {
            status = shorten(s, part);
        }
        if (may_diverge(s) && (status || !pays(s))) {
            break;
        }
        tribo_shooting_turn(s);
    }
    return status;
}

int tribo_shooting_try(struct shooting *s, double period, int *closed)
{
    s->map.moved = 0;
    s->extra.first = period;
    const int status = tribo_shooting_search(s);
    *closed = !status && tribo_point_is_closed(s->here, TRIBO_PERIODIC);
    return status == TRIBO_ERR_MEMORY || status == TRIBO_ERR_UNSUPPORTED ? status : TRIBO_OK;
}

/* Searches from the forecast, unless the guess is near it; then from the guess, and from states some periods after it: where
 * contacts hardly slip, and where motions diverge by static limits or limits that follow, Newton's steps may fail. With static
 * limits a stable motion may be not odd, although all drives are odd. Returns a status. */
static int search_all(struct shooting *s)
{
    static const size_t marched[] = {0, 20, 100};
    const size_t n = s->map.n, statics = !tribo_system_is_plain(s->map.sys), marches = statics || may_diverge(s);
    const int was_odd = s->map.odd;
    int tries = (was_odd || (s->map.alternates && s->map.ring.sectors)) && !statics && s->map.norm.scale == 1.0, done = 0;
    int status = tries ? tribo_forecast(&s->map, s->here->x, &tries) : TRIBO_OK;
    if (!status && tries && tribo_energy_distance(s->guess, s->here->x, n) > FAR * tribo_energy_length(s->here->x, n)) {
        status = tribo_shooting_search(s);
        done = !status && tribo_point_is_closed(s->here, TRIBO_PERIODIC);
        status = status == TRIBO_ERR_MEMORY ? status : TRIBO_OK;
    }
    for (int odd = was_odd; odd >= (statics ? 0 : was_odd); odd--) {
        for (size_t k = 0; !status && !done && k < 2 + marches; k++) {
            tribo_period_map_choose(&s->map, odd);
            memcpy(s->here->x, s->guess, n * sizeof *s->guess);
            status = tribo_period_map_march(&s->map, s->map.period, marched[k], NULL, s->here->x);
            status = status ? status : tribo_shooting_search(s);
            done = !status && tribo_point_is_closed(s->here, TRIBO_PERIODIC);
        }
    }
    return status || done ? status : tribo_shooting_fails(s, s->nearest);
}

/* -------------------------------------------------------------------------------------------------------------- the family */

/* Takes the motion nearest to the guess in the family of the odd motion, if that motion comes back. If all modes are damped and
 * no contact rests in all phases, there is no family. Returns a status. */
static int approach_guess(struct shooting *s)
{
    const size_t n = s->map.n;
    const int alone = s->map.norm.damped && !tribo_derivative_rests(&s->here->derivative);
    if (!s->map.odd || alone || !(tribo_energy_length(s->guess, n) > 0.0) ||
        tribo_energy_distance(s->guess, s->here->x, n) < MEANT * s->here->size) {
        return TRIBO_OK;
    }
    /* guess = the part of guess - x in the family, the kernel of I - derivative over the period */
    tribo_add(s->guess, -1.0, s->here->x, n);
    memcpy(s->step, s->guess, n * sizeof *s->step);
    s->spans = 2;
    int status = apply_equation(s, s->step);
    status = status ? status : solve_equation(s, AIM, FREE, s->step);
    tribo_add(s->guess, -1.0, s->step, n);
    if (status || tribo_energy_length(s->guess, n) < MEANT * s->here->size) {
        return status;
    }
    tribo_period_map_choose(&s->map, 0);
    memcpy(s->there->x, s->here->x, n * sizeof *s->here->x);
    tribo_add(s->there->x, 1.0, s->guess, n);
    status = tribo_period_map_follow(&s->map, s->there);
    if (!status && tribo_point_is_closed(s->there, TRIBO_PERIODIC)) {
        tribo_shooting_turn(s);
    } else {
        tribo_period_map_choose(&s->map, 1);
    }
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- multipliers */

/* Sets s->flow: s->here; or, if a contact that slides at its beginning or end has there no velocity beside AT_ONCE of what the
 * motion may have, so that its event falls on both or on neither, the motion from the middle of its longest phase on. If that
 * does not come back, a contact slides at the beginning and is held at the end, above its kinetic limit. Returns a status. */
int tribo_shooting_find_flow(struct shooting *s)
{
    const struct derivative *d = &s->here->derivative;
    tribo_system *sys = s->map.sys;
    double *v = s->map.limit;
    const signed char *first = d->step->slip, *last = first;
    for (size_t k = 0; k < d->steps; k++) {
        last = d->step[k].slip ? d->step[k].slip : last;
    }
    tribo_system_set_time(sys, s->map.t);
    tribo_matrix_multiply(&sys->direction, s->here->y + sys->ndof, v);
    tribo_system_loads(sys, DRIVES_BASE, 0, -1.0, v);
    s->flow = s->here;
    for (size_t i = 0; i < sys->ncontact && s->flow == s->here; i++) {
        const double most = s->here->size / s->map.norm.scale * sqrt(tribo_system_delassus(sys, i, i));
        if ((tribo_slides(first[i]) || tribo_slides(last[i])) && fabs(v[i]) <= AT_ONCE * most) {
            const int status = tribo_period_map_later(&s->map, s->here->y, tribo_derivative_middle(d), s->there);
            if (status || !tribo_point_is_closed(s->there, LASTS)) {
                return status ? status : tribo_shooting_fails(s, s->there->residual / s->there->size);
            }
            s->flow = s->there;
        }
    }
    return TRIBO_OK;
}

int tribo_shooting_check_touches(struct shooting *s, const char *what)
{
    const int changed = s->revision != tribo_system_revision(s->map.sys);
    const int known = !changed && s->touches != SIZE_MAX;
    size_t contact = s->touches;
    const int status = known ? TRIBO_OK : tribo_period_map_find_touch(&s->map, s->here->y, changed, &contact);
    s->touches = status ? SIZE_MAX : contact;
    return status || contact == s->map.sys->ncontact
               ? status
               : tribo_error(s->map.drv->message, TRIBO_ERR_UNSUPPORTED,
                             "the force of elastic contact %zu only touches its limit: beside this motion are some that slide "
                             "there and some that do not, and it has no %s",
                             contact, what);
}

/* Returns the number of spans of the period of the motion found. */
static size_t spans_of_period(const struct shooting *s)
{
    return s->flow->odd ? 2 : s->map.ring.parts;
}

int tribo_shooting_freedom(struct shooting *s, size_t *freedom)
{
    memset(s->step, 0, s->map.n * sizeof *s->step);
    return solve_dense(s, s->flow, spans_of_period(s), 0, FREE, s->step, freedom);
}

int tribo_shooting_multipliers(struct shooting *s, double *re, double *im)
{
    const size_t n = s->map.n, all = tribo_system_dimension(s->map.sys) - 1;
    const int missing = find_derivative(s, s->flow, spans_of_period(s));
    const int status = missing ? missing : tribo_eigen(s->b, n, s->step, s->guess, s->a);
    if (status) {
        return missing ? missing
                       : tribo_error(s->map.drv->message, status, "multipliers of %zu equation%s: %s", n, plural(n),
                                     tribo_strerror(status));
    }
    for (size_t i = 0; i < n; i++) { /* the largest first; the order within pairs, neighbours of equal size, stays */
        const double size = hypot(s->step[i], s->guess[i]);
        size_t k = i;
        for (; k > 0 && hypot(re[k - 1], im[k - 1]) < size; k--) {
            re[k] = re[k - 1];
            im[k] = im[k - 1];
        }
        re[k] = s->step[i];
        im[k] = s->guess[i];
    }
    for (size_t i = n; i < all; i++) { /* values of a caller's state that depend on the others */
        re[i] = im[i] = 0.0;
    }
    return TRIBO_OK;
}

int tribo_shooting_vectors(struct shooting *s, size_t which, double complex *vector, double complex *lambda, double *room)
{
    const size_t n = s->map.n, all = tribo_system_dimension(s->map.sys) - 1;
    double *a = room, *x = a + n * n, *re = x + n * n, *im = re + all, gap = HUGE_VAL;
    double complex product = 0.0;
    int status = tribo_shooting_multipliers(s, re, im);
    status = status ? status : tribo_period_map_matrix(&s->map, s->here);
    if (status) {
        return status;
    }
    const double complex mu = re[which] + im[which] * I;
    for (int left = 0; !status && left < 2; left++) {
        double nearest = HUGE_VAL;
        size_t at = 0, row;
        memcpy(a, s->here->derivative.matrix, n * n * sizeof *a);
        if (left) {
            tribo_transpose(n, n, s->here->derivative.matrix, a);
        }
        status = tribo_eigen(a, n, re, im, x);
        for (size_t k = 0; !status && k < n; k++) {
            const double complex one = re[k] + im[k] * I;
            const double off = left ? cabs(one - *lambda) : cabs((s->here->odd ? one * one : one) - mu);
            gap = left ? gap : off < nearest ? nearest : lesser(gap, off);
            at = off < nearest ? k : at;
            nearest = lesser(nearest, off);
        }
        *lambda = left ? *lambda : re[at] + im[at] * I;
        row = im[at] < 0.0 ? at - 1 : at;
        for (size_t i = 0; !status && i < n; i++) {
            const double turned = im[at] == 0.0 ? 0.0 : (im[at] > 0.0 ? 1.0 : -1.0) * x[(row + 1) * n + i];
            vector[(size_t)left * n + i] = x[row * n + i] + turned * I;
            product += left ? vector[n + i] * vector[i] : 0.0;
        }
    }
    if (status) {
        return tribo_error(s->map.drv->message, status, "multiplier[%zu]: %s", which, tribo_strerror(status));
    }
    for (size_t i = 0; i < n; i++) {
        vector[n + i] /= product;
    }
    return gap > SIMPLE * cabs(mu) && cabs(product) > SIMPLE && cabs(*lambda) * cabs(product) > ROUNDING
               ? TRIBO_OK
               : tribo_error(s->map.drv->message, TRIBO_ERR_UNSUPPORTED,
                             "multiplier[%zu] = %g%+gi is repeated, or 0, within rounding, and has no derivatives", which,
                             creal(mu), cimag(mu));
}

/* -------------------------------------------------------------------------------------------------------------- the whole */

/* Sets the residual of s->here over all parts of the period of a ring: |r + D r + ... + D^(parts - 1) r|, r = image - x. Returns
 * a status. */
static int complete_ring(struct shooting *s)
{
    int status = TRIBO_OK;
    find_misfit(s, s->here, s->step);
    memcpy(s->guess, s->step, s->map.n * sizeof *s->step);
    for (size_t k = 1; !status && k < s->map.ring.parts; k++) {
        status = tribo_period_map_apply(&s->map, s->here, s->guess);
        tribo_add(s->guess, 1.0, s->step, s->map.n);
    }
    s->here->residual = tribo_energy_length(s->guess, s->map.n);
    return status;
}

void tribo_shooting_keep(struct shooting *s, struct wanted *w)
{
    memcpy(w->y, s->here->y, s->map.n * sizeof *w->y);
    w->y[s->map.n] = 0.0;
    w->period = s->map.period;
    s->found = 1;
    s->told = s;
    s->revision = tribo_system_revision(s->map.sys);
    s->touches = SIZE_MAX;
}

int tribo_shooting_find(struct shooting *s, struct wanted *w)
{
    s->found = 0;
    s->extra.count = 0;
    int status = tribo_period_map_prepare(&s->map, w->t, w->period, w->y);
    if (!status) {
        tribo_energy_norm_of(&s->map.norm, 1, w->y, s->guess);
        status = search_all(s);
    }
    status = status ? status : approach_guess(s);
    status = status ? status : s->map.ring.sectors ? complete_ring(s) : tribo_period_map_complete(&s->map, s->here);
    if (!status && !tribo_point_is_closed(s->here, TRIBO_PERIODIC)) {
        status = tribo_shooting_fails(s, s->here->residual / s->here->size);
    }
    status = status || s->map.ring.sectors ? status : tribo_shooting_find_flow(s);
    if (!status) {
        tribo_shooting_keep(s, w);
    }
    s->map.drv->periods += (size_t)ceil(tribo_periods_followed(&s->map));
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- life */

struct shooting *tribo_shooting_create(tribo_driver *drv)
{
    const size_t n = tribo_system_energy(drv->sys), all = n + TRIBO_UNKNOWNS;
    struct shooting *s = calloc(1, sizeof *s);
    if (!s) {
        return NULL;
    }
    struct point *const p = s->point, *const other = s->point + 1, *const beside = &s->beside;
    if (!ALLOCATE(ARRAY(s->a, all * all), ARRAY(s->b, n * n), ARRAY(s->step, all), ARRAY(s->guess, n),
                  ARRAY(s->space, tribo_gmres_room(n, n)), ARRAY(p->y, n), ARRAY(p->x, n), ARRAY(p->end, n), ARRAY(p->image, n),
                  ARRAY(other->y, n), ARRAY(other->x, n), ARRAY(other->end, n), ARRAY(other->image, n), ARRAY(beside->y, n),
                  ARRAY(beside->x, n), ARRAY(beside->end, n), ARRAY(beside->image, n),
                  ARRAY(p->border, TRIBO_UNKNOWNS * (n + all)), ARRAY(other->border, TRIBO_UNKNOWNS * (n + all))) ||
        !tribo_period_map_create(&s->map, drv)) {
        tribo_shooting_free(s);
        return NULL;
    }
    s->here = p;
    s->there = other;
    return s;
}

void tribo_shooting_free(struct shooting *s)
{
    if (s) {
        for (size_t k = 0; k < 2; k++) {
            tribo_derivative_free(&s->point[k].derivative);
        }
        tribo_derivative_free(&s->beside.derivative);
        tribo_period_map_free(&s->map);
        tribo_shooting_leave_twin(s);
        free(s->a);
        free(s);
    }
}
