/* SPDX-License-Identifier: BSD-3-Clause */
/* Structures with normals that are pressed, and contacts that slide at limits which follow these. A pressed normal adds its
 * stiffness to K. A contact that slides adds the forces side mu N along its own row of J: K~ of the modes is not symmetric then,
 * and has left and right vectors (exponents.c); likewise if K itself is not symmetric, as by loads that follow the structure:
 * the modes are those of its symmetric part. A mode without stiffness drifts: no force follows it, but forces that follow
 * other modes move it. */
#include "motion.h"
#include "parts.h"
#include "common/real.h"

#include <math.h>
#include <string.h>

/* Largest stiffness, damping, or ramp of a mode that drifts, relative to those of all modes, that counts as rounding. */
#define STILL 1e-11

/* Smallest pivot of K~, each mode divided by its frequency. */
#define FIRM 1e-9

double tribo_follow_side(signed char key)
{
    return key == KEY_BACK || key == KEY_TIED_BACK ? 1.0 : key == KEY_FORTH || key == KEY_TIED_FORTH ? -1.0 : 0.0;
}

double tribo_follow_spring(const tribo_system *sys, const struct modal *h, size_t i, size_t *row)
{
    const struct follower *f = tribo_normals_follower(sys, i);
    const double side = f ? f->mu * tribo_follow_side(h->key[i]) : 0.0;
    *row = side != 0.0 ? sys->normals.normal[f->normal].row : i;
    return h->key[i] == KEY_HOLDS ? 1.0 : side;
}

const signed char *tribo_follow_key(const struct stick_slip *m, signed char *key)
{
    const struct normals *s = &m->constant.sys->normals;
    memcpy(key, m->state.key, m->constant.contacts);
    for (size_t k = 0; k < s->count; k++) {
        key[s->normal[k].row] = m->state.pressed[k] ? KEY_PRESSED : KEY_APART;
    }
    for (size_t k = 0; k < s->followers; k++) {
        const struct follower *f = s->follower + k;
        const double side = f->mu * s->normal[f->normal].stiffness > 0.0 ? tribo_stick_slip_follows(m, f->contact) : 0.0;
        const int slides = tribo_slides(m->state.slip[f->contact]);
        if (side != 0.0) {
            key[f->contact] = slides ? (side > 0.0 ? KEY_BACK : KEY_FORTH) : (side > 0.0 ? KEY_TIED_BACK : KEY_TIED_FORTH);
        }
    }
    return key;
}

void tribo_follow_slide(const tribo_system *sys, const signed char *key, size_t columns, const double *way, double *force)
{
    const struct normals *s = &sys->normals;
    memset(force, 0, sys->ncontact * columns * sizeof *force);
    for (size_t k = 0; k < s->followers; k++) {
        const struct follower *f = s->follower + k;
        const struct normal *n = &s->normal[f->normal];
        const double side = tribo_follow_side(key[f->contact]);
        tribo_add(force + f->contact * columns, side * f->mu * n->stiffness, way + n->row * columns, columns);
    }
}

/* ---------------------------------------------------------------------------------------------------------------- structures */

int tribo_follow_press(struct modal_build *b)
{
    const tribo_system *sys = b->sys;
    const struct normals *s = &sys->normals;
    const struct matrix *j = &sys->direction;
    const size_t n = sys->ndof;
    double *sum = NULL;
    b->follows |= sys->circulation > 0.0;
    for (size_t k = 0; k < s->followers; k++) {
        b->follows |= tribo_follow_side(b->h->key[s->follower[k].contact]) != 0.0;
    }
    for (size_t k = 0; k < s->count; k++) {
        const struct normal *at = s->normal + k;
        if (b->h->key[at->row] != KEY_PRESSED) {
            continue;
        }
        if (!sum) {
            sum = tribo_modal_take(&b->scratch, n * n, sizeof *sum);
            if (!sum) {
                return 0;
            }
            tribo_matrix_spread(&sys->k, sum);
        }
        for (size_t e = j->first[at->row]; e < j->first[at->row + 1]; e++) {
            tribo_matrix_add_row(j, at->row, at->stiffness * j->val[e], sum + j->col[e] * n);
        }
    }
    if (!sum) {
        return 1;
    }
    if (sys->circulation == 0.0) {
        tribo_even_out(n, sum);
    }
    b->k = &b->pressed_stiffness;
    return tribo_matrix_from_dense(&b->pressed_stiffness, n, n, sum);
}

/* Returns 0 with b->status set: method exact does not know the structure. */
static int follow_unsupported(struct modal_build *b, const char *why)
{
    b->status = tribo_error(b->sys->message, TRIBO_ERR_UNSUPPORTED, "method exact: %s, %s; method event can do it",
                            b->sys->circulation > 0.0 ? "with a stiffness that is not symmetric"
                                                      : "where contacts slide at limits that follow their normal loads",
                            why);
    return 0;
}

/* Removes rounding from the columns of modes that drift in a = K~ or C~. Returns 0 if such a column is more than rounding. */
static int clear_drifts(const struct modal *h, double *a)
{
    const size_t m = h->modes;
    const double most = tribo_largest(a, m * m);
    for (size_t at = 0; at < m * m; at++) {
        if (h->omega2[at % m] == 0.0) {
            if (fabs(a[at]) > STILL * most) {
                return 0;
            }
            a[at] = 0.0;
        }
    }
    return 1;
}

/* Sets give = the inverse of K~ over the modes that do not drift, 0 elsewhere. */
static int find_give(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t m = h->modes;
    double *lu = tribo_modal_take(&b->scratch, m * (m + 1), sizeof *lu), *scale = lu ? lu + m * m : NULL;
    int *pivot = tribo_modal_take(&b->scratch, m, sizeof *pivot);
    if (!lu || !pivot) {
        return 0;
    }
    for (size_t k = 0; k < m; k++) {
        scale[k] = h->omega2[k] != 0.0 ? 1.0 / sqrt(fabs(h->omega2[k])) : 0.0;
    }
    for (size_t at = 0; at < m * m; at++) {
        const size_t k = at / m, l = at % m;
        lu[at] = h->stiff[at] * scale[k] * scale[l] + (k == l && scale[k] == 0.0);
        h->give[at] = k == l ? scale[k] : 0.0;
    }
    if (!(tribo_lu_create(lu, m, pivot) >= FIRM)) {
        return follow_unsupported(b, "the stiffness of their sum is singular");
    }
    tribo_lu_solve(lu, m, pivot, h->give, m);
    for (size_t at = 0; at < m * m; at++) {
        h->give[at] *= scale[at / m];
    }
    return 1;
}

int tribo_follow_couple(struct modal_build *b)
{
    struct modal *h = b->h;
    const tribo_system *sys = b->sys;
    const size_t m = h->modes, all = sys->ncontact * m;
    if (!b->follows) {
        return 1;
    }
    double *way = tribo_modal_take(&b->scratch, 4 * all, sizeof *way);
    double *pull = tribo_modal_take(&b->scratch, sys->circulation > 0.0 ? m * (m + sys->ndof) : 0, sizeof *pull);
    h->stiff = tribo_modal_take(&h->store, 2 * m * m, sizeof *h->stiff);
    if (!way || !pull || !h->stiff) {
        return 0;
    }
    if (sys->circulation > 0.0) { /* the antisymmetric part of Phi'K Phi */
        double *turned = pull + m * m;
        tribo_matrix_add_columns(&sys->k, 1.0, m, b->shape, turned);
        tribo_multiply_add(m, sys->ndof, m, 1.0, h->phi, turned, pull);
        for (size_t at = 0; at < m * m; at++) {
            h->stiff[at] = 0.5 * (pull[at] - pull[at % m * m + at / m]);
        }
        const double most = tribo_largest(pull, m * m);
        for (size_t k = 0; k < m; k++) { /* only a scale beside K~: != 0, of a mode that does not drift */
            const double own = tribo_largest(h->stiff + k * m, m);
            h->stiff[k * (m + 1)] = own > STILL * most && h->omega2[k] == 0.0 ? -own : 0.0;
            h->omega2[k] -= h->stiff[k * (m + 1)];
        }
    }
    double *slide = way + all, *rate = slide + all, *give = rate + all;
    h->give = h->stiff + m * m;
    tribo_matrix_add_columns(&sys->direction, 1.0, m, b->shape, way);
    tribo_follow_slide(sys, h->key, m, way, slide);
    tribo_modal_rates(b, m, slide, give, rate); /* with the forces of springs by those of sliders */
    for (size_t k = 0; k < all; k++) {
        way[k] = -way[k];
    }
    tribo_multiply_transposed_add(sys->ncontact, m, m, way, rate, h->stiff);
    int damped = 0;
    for (size_t k = 0; k < m; k++) {
        h->stiff[k * (m + 1)] += h->omega2[k];
        damped |= h->omega2[k] == 0.0 && h->damping[k] != 0.0;
    }
    if (damped || !clear_drifts(h, h->stiff) || !clear_drifts(h, h->coupling)) {
        return follow_unsupported(b, "a mode has no stiffness and is not free");
    }
    return find_give(b);
}

int tribo_follow_ramps(struct modal_build *b)
{
    const struct modal *h = b->h;
    struct forced *f = b->forced;
    const size_t m = h->modes;
    memset(f->constant, 0, m * sizeof *f->constant);
    tribo_multiply_add(m, m, 1, 1.0, h->give, f->ramp, f->constant);
    for (size_t k = 0; k < m; k++) {
        const double rest = f->ramp[k] - tribo_dot(h->stiff + k * m, f->constant, m);
        if (h->omega2[k] == 0.0 && fabs(rest) > STILL * tribo_largest(f->ramp, m)) {
            return follow_unsupported(b, "the force on a body that nothing holds grows with time");
        }
    }
    return 1;
}

/* ------------------------------------------------------------------------------------------------------------------ motion */

void tribo_follow_forces(struct exact *x, const double *y, double *force)
{
    const struct forced *f = x->h;
    const struct modal *h = f->modal;
    tribo_system *sys = x->sys;
    const size_t m = h->modes;
    double *acceleration = x->work + x->room;
    tribo_system_free_acceleration(sys, x->t0, y, acceleration);
    for (size_t i = 0; i < sys->ncontact; i++) {
        x->way[i] = h->key[i] == KEY_HOLDS ? 0.0 : x->events.stick_slip.state.force[i];
    }
    tribo_matrix_multiply_add(&sys->response, 1.0, x->way, acceleration);
    memset(force, 0, m * sizeof *force);
    tribo_multiply_add(m, sys->ndof, 1, 1.0, h->psi, acceleration, force);
    tribo_multiply_add(m, m, 1, 1.0, h->stiff, x->place, force);
    tribo_multiply_add(m, m, 1, 1.0, h->coupling, x->rate, force);
    tribo_multiply_add(m, m, 1, -1.0, h->coupling, f->constant, force);
    for (size_t s = 0; s < f->harmonics; s++) {
        const double re = x->z.re[h->exponents + s], im = x->z.im[h->exponents + s];
        for (size_t k = 0; f->forcing[s].omega != 0.0 && k < m; k++) {
            force[k] -= creal(f->g[s * m + k]) * re - cimag(f->g[s * m + k]) * im;
        }
    }
}

void tribo_follow_settle(const struct modal *h, size_t columns, const double *force, double *eta, double *vel, double *acc)
{
    const size_t m = h->modes, all = m * columns;
    memset(vel, 0, all * sizeof *vel);
    tribo_multiply_add(m, m, columns, 1.0, h->give, force, vel);
    tribo_add(eta, -1.0, vel, all);
    memcpy(acc, force, all * sizeof *acc);
    tribo_multiply_add(m, m, columns, -1.0, h->stiff, vel, acc);
    for (size_t k = 0; k < m; k++) {
        memset(acc + k * columns, 0, h->omega2[k] != 0.0 ? columns * sizeof *acc : 0);
    }
    memset(vel, 0, all * sizeof *vel);
}

void tribo_follow_drift(const struct modal *h, size_t columns, const double *zr, const double *zi, double *drift)
{
    const size_t m = h->modes;
    for (size_t k = 0; k < m; k++) {
        for (size_t p = 0; h->omega2[k] == 0.0 && p < h->exponents; p++) {
            const double rr = h->rr[p * m + k], ri = h->ri[p * m + k], lr = h->lr[p], li = h->li[p];
            const double *re = zr + p * columns, *im = zi + p * columns;
            for (size_t j = 0; j < columns; j++) {
                drift[k * columns + j] -= rr * (lr * re[j] - li * im[j]) + ri * (lr * im[j] + li * re[j]);
            }
        }
    }
}

void tribo_follow_pull(const struct modal *h, const tribo_system *sys, size_t columns, const double *v, double *f,
                       const double *eta, double *pull, double *work)
{
    const struct matrix *j = &sys->direction;
    const struct normals *s = &sys->normals;
    const size_t n = sys->ndof, c = columns;
    double *load = work, *way = load + n * c, *slide = way + sys->ncontact * c;
    memset(load, 0, (n + sys->ncontact) * c * sizeof *load);
    tribo_matrix_add_columns(&sys->k, -1.0, c, v, load);
    tribo_matrix_add_columns(j, 1.0, c, v, way);
    tribo_follow_slide(sys, h->key, c, way, slide);
    for (size_t k = 0; k < s->followers; k++) {
        const struct follower *at = s->follower + k;
        const int slides = tribo_follow_side(h->key[at->contact]) != 0.0;
        memcpy(f + at->contact * c, slide + at->contact * c, slides ? c * sizeof *f : 0);
    }
    for (size_t k = 0; k < s->count; k++) {
        const struct normal *at = s->normal + k;
        tribo_add(f + at->row * c, h->key[at->row] == KEY_PRESSED ? -at->stiffness : 0.0, way + at->row * c, c);
    }
    tribo_matrix_add_transposed(j, 1.0, c, f, load);
    memset(pull, 0, h->modes * c * sizeof *pull);
    tribo_multiply_add(h->modes, n, c, 1.0, h->phi, load, pull);
    tribo_multiply_add(h->modes, h->modes, c, 1.0, h->stiff, eta, pull);
}
