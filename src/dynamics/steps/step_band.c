/* The box-constrained problem of a step by the method of numerics/box/box.c, for bodies instead of contacts:
 *
 * begin with the contacts that held in the last step repeat  du = solution with these held; contacts whose force is above the
 * limit slide, contacts that move along their force hold until   no contact changes, or rounds end
 *
 * Where the band is stiff, the slip of a body overloads its neighbours within the step, and each round would reach the next
 * neighbour only. So in rounds in which contacts only begin to slide, neighbours within `reach` slide along, and reach
 * doubles from round to round; a contact that slides too early moves along its force, and holds again. */
#include "step_band.h"
#include "numerics/band.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/real.h"

/* held[]: the contact on a body slides, holds, or held until neighbours began to slide. */
enum { FREE, HOLDS, FOLLOWS };

/* A round costs as much as the band has entries, and a step hardly ever takes more than 10. */
enum { ROUNDS = 100 };

/* The first column of row i. */
static size_t band_begin_of(const struct step_band *b, size_t i)
{
    return i > b->width ? i - b->width : 0;
}

void tribo_step_band_free(struct step_band *b)
{
    free(b->a);
    free(b->body);
    free(b->mass);
    free(b->at);
    *b = (struct step_band){0};
}

/* ---------------------------------------------------------------------------------------------------- whether it applies */

/* 1 if each contact touches one body, and each body one contact at most. seen [ndof]: workspace, all 0. */
static int each_its_own(const struct matrix *j, signed char *seen)
{
    for (size_t i = 0; i < j->rows; i++) {
        const size_t k = j->first[i];
        if (j->first[i + 1] - k != 1 || j->val[k] == 0.0 || seen[j->col[k]]) {
            return 0;
        }
        seen[j->col[k]] = 1;
    }
    return 1;
}

/* 1 if M A is symmetric, to rounding: damping matrices need not be. */
static int symmetric(const struct matrix *a, const double *mass)
{
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            const double x = mass[i] * a->val[k], mirror = mass[a->col[k]] * tribo_matrix_get(a, a->col[k], i);
            if (!(fabs(x - mirror) <= 8.0 * DBL_EPSILON * fabs(x))) {
                return 0;
            }
        }
    }
    return 1;
}

static int band_allocate(struct step_band *b, size_t n, size_t count)
{
    if (b->body) {
        return 1;
    }
    b->body = malloc((count + n + 1) * sizeof *b->body);
    b->mass = calloc(3 * n + 3 * count + 1, sizeof *b->mass);
    b->at = calloc(count + n + 1, 1);
    if (!b->body || !b->mass || !b->at) {
        tribo_step_band_free(b);
        return 0;
    }
    b->contact = b->body + count;
    b->push = b->mass + n;
    b->move = b->push + n;
    b->lever = b->move + n;
    b->inverse = b->lever + count;
    b->noise = b->inverse + count;
    b->held = b->at + count;
    return 1;
}

/* 1 if M is diagonal, contacts have bodies of their own, and the band is symmetric and narrow enough to save work. */
static int applies(struct step_band *b, const tribo_system *sys)
{
    const size_t n = sys->ndof;
    if (!sys->ncontact || sys->compliance.count || sys->k.rows || sys->modes || sys->mass.rows != n ||
        !tribo_matrix_is_diagonal(&sys->mass)) {
        return 0;
    }
    for (size_t i = 0; i < n; i++) {
        b->mass[i] = tribo_matrix_get(&sys->mass, i, i);
    }
    size_t below = 0, above = 0;
    tribo_matrix_widen(&sys->stiffness, &below, &above);
    tribo_matrix_widen(&sys->damping, &below, &above);
    b->width = below > above ? below : above;
    memset(b->held, 0, n);
    return 2 * b->width <= sys->ncontact && each_its_own(&sys->direction, b->held) && symmetric(&sys->stiffness, b->mass) &&
           symmetric(&sys->damping, b->mass);
}

/* ------------------------------------------------------------------------------------------------------------ the factor */

/* Factorizes A without held bodies. Returns the place of a pivot that is not positive, or n. */
static size_t band_factorize(struct step_band *b)
{
    const size_t where = tribo_band_factorize(b->n, b->width, b->a, b->held, b->l);
    b->factored = where == b->n;
    return where;
}

int tribo_step_band_create(struct step_band *b, const tribo_system *sys, double h, size_t *where)
{
    const size_t n = sys->ndof;
    b->n = 0;
    if (!band_allocate(b, n, sys->ncontact)) {
        return TRIBO_ERR_MEMORY;
    }
    if (!applies(b, sys)) {
        return TRIBO_OK;
    }
    free(b->a);
    b->a = calloc(2 * n * (b->width + 1), sizeof *b->a);
    if (!b->a) {
        return TRIBO_ERR_MEMORY;
    }
    b->l = b->a + n * (b->width + 1);
    b->count = sys->ncontact;
    for (size_t i = 0; i < n; i++) {
        b->a[i * (b->width + 1) + b->width] = b->mass[i];
    }
    tribo_band_add(b->a, b->width, &sys->stiffness, 0.25 * h * h, b->mass);
    tribo_band_add(b->a, b->width, &sys->damping, 0.5 * h, b->mass);
    for (size_t d = 0; d < n; d++) {
        b->contact[d] = b->count;
    }
    for (size_t i = 0; i < b->count; i++) {
        b->body[i] = sys->direction.col[sys->direction.first[i]];
        b->contact[b->body[i]] = i;
        b->lever[i] = sys->direction.val[sys->direction.first[i]];
        b->inverse[i] = 1.0 / b->lever[i];
    }
    b->n = n;
    memset(b->held, 0, n);
    b->factored = 0;
    *where = band_factorize(b); /* with no body held: A is definite if and only if all these pivots are positive */
    return *where < n ? TRIBO_ERR_INDEFINITE : TRIBO_OK;
}

/* --------------------------------------------------------------------------------------------------------------- the step */

/* Row i of A times x; *size = sum of the absolute values of its terms. Right of the diagonal rows are columns of the lower
 * half. */
static double row_dot(const struct step_band *b, size_t i, const double *x, double *size)
{
    const size_t w = b->width, end = i + w < b->n ? i + w : b->n - 1;
    const double *row = b->a + i * (w + 1);
    double sum = 0.0, sizes = 0.0;
    for (size_t j = band_begin_of(b, i); j <= i; j++) {
        const double term = x[j] * row[j + w - i];
        sum += term;
        sizes += fabs(term);
    }
    for (size_t j = i + 1, at = j * (w + 1) + w - 1; j <= end; j++, at += w) {
        const double term = x[j] * b->a[at];
        sum += term;
        sizes += fabs(term);
    }
    *size = sizes;
    return sum;
}

/* Sets held[]; the factor is kept if it does not change. */
static void hold_bodies(struct step_band *b)
{
    for (size_t i = 0; i < b->count; i++) {
        const signed char holds = b->at[i] ? FREE : HOLDS;
        b->factored &= b->held[b->body[i]] == holds;
        b->held[b->body[i]] = holds;
    }
    if (!b->factored) {
        band_factorize(b);
    }
}

/* du, f and noise with the contacts as they are in at[]. */
static void solve_sets(struct step_band *b, const struct band_step *s)
{
    const double doubt = 8.0 * DBL_EPSILON, rate = 1.0 / s->h;
    const size_t n = b->n, w = b->width;
    double *x = s->du, *f = s->f;
    hold_bodies(b);
    memcpy(x, b->push, n * sizeof *x);
    for (size_t i = 0; i < b->count; i++) {
        f[i] = b->at[i] * s->limit[i];
        x[b->body[i]] += s->h * b->lever[i] * f[i];
    }
    /* columns of held bodies that move with their bases go to the right-hand side */
    for (size_t i = 0; i < b->count; i++) {
        const size_t d = b->body[i], end = d + w < n ? d + w : n - 1;
        b->move[d] = b->at[i] ? 0.0 : s->base[i] / b->lever[i] - s->u[d];
        for (size_t j = band_begin_of(b, d); b->move[d] != 0.0 && j <= end; j++) {
            x[j] -= b->move[d] * (j <= d ? b->a[d * (w + 1) + j + w - d] : b->a[j * (w + 1) + d + w - j]);
        }
    }
    for (size_t d = 0; d < n; d++) {
        x[d] = b->held[d] ? 0.0 : x[d];
    }
    tribo_band_solve(n, w, b->l, x);
    for (size_t i = 0; i < b->count; i++) {
        x[b->body[i]] = b->at[i] ? x[b->body[i]] : b->move[b->body[i]];
    }
    for (size_t i = 0; i < b->count; i++) {
        const size_t d = b->body[i];
        double size;
        const double sum = row_dot(b, d, x, &size), unit = rate * b->inverse[i];
        b->noise[i] = doubt * fabs(unit) * (size + fabs(b->push[d]) + fabs(b->a[d * (w + 1) + w] * s->u[d]));
        f[i] = b->at[i] ? f[i] : unit * (sum - b->push[d]);
    }
}

/* Revises at[] by forces and velocities: *freed contacts begin to slide, *caught contacts begin to hold. */
static void band_revise(struct step_band *b, const struct band_step *s, size_t *freed, size_t *caught)
{
    const double rate = 1.0 / s->h;
    *freed = *caught = 0;
    for (size_t i = 0; i < b->count; i++) {
        const size_t d = b->body[i];
        const double noise = b->noise[i], most = s->limit[i] + noise;
        const signed char at = b->at[i];
        if (at == 0) {
            const int side = (s->f[i] > most) - (s->f[i] < -most);
            b->at[i] = (signed char)side;
            *freed += side != 0;
        } else {
            /* the force that would take the velocity away within the step */
            const double v = b->lever[i] * (s->u[d] + s->du[d]) - s->base[i];
            const double pull = v * b->a[d * (b->width + 1) + b->width] * (rate * b->inverse[i] * b->inverse[i]);
            if (pull * at > noise) {
                b->at[i] = 0;
                ++*caught;
            }
        }
    }
}

/* Passes over the bodies upwards or downwards: a holding contact within `reach` bodies after one that begins to slide slides
 * along. */
static void band_sweep(struct step_band *b, size_t reach, int upwards)
{
    size_t left = 0;
    double way = 0.0;
    for (size_t k = 0; k < b->n; k++) {
        const size_t d = upwards ? k : b->n - 1 - k, i = b->contact[d];
        const int contact = i < b->count;
        if (contact && b->held[d] == HOLDS && b->at[i]) {
            left = reach;
            way = b->lever[i] * b->at[i];
        } else if (left > 0) {
            left--;
            if (contact && !b->at[i]) {
                b->at[i] = b->lever[i] * way > 0.0 ? 1 : -1;
                b->held[d] = FOLLOWS;
            }
        }
    }
}

int tribo_step_band_solve(struct step_band *b, const struct band_step *s)
{
    size_t reach = 0, freed, caught;
    memcpy(b->push, s->du, b->n * sizeof *s->du);
    for (int round = 0; round < ROUNDS; round++) {
        solve_sets(b, s);
        band_revise(b, s, &freed, &caught);
        if (freed + caught == 0) {
            for (size_t i = 0; i < b->count; i++) {
                s->f[i] = clamp(s->f[i], -s->limit[i], s->limit[i]);
            }
            return 1;
        }
        reach = caught ? 0 : 2 * reach + 1;
        if (reach > 1) {
            band_sweep(b, reach, 1);
            band_sweep(b, reach, 0);
        }
    }
    memcpy(s->du, b->push, b->n * sizeof *s->du);
    return 0;
}
