/* SPDX-License-Identifier: BSD-3-Clause */
/* Newton's method on the projection equations y = P(y - gain gradient), P the projection onto the lenses. The projection gives
 * the place of each contact, and its derivative there the freedoms: all directions inside; along the rim on a rim, as if on a
 * spring, since the pressure turns with y; none at a corner. Along the freedoms the equations are symmetric. */
#include "disc_qp.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "common/real.h"
#include "common/simd.h"
#include "numerics/csr.h"

/* A set of redundant contacts counts as balanced up to this part of limits: the rounding of pull. */
#define DISAGREEMENT 5e-13

/* Least diagonal entry of Newton's matrix, in parts of the largest: null vectors then have squares that do not underflow. */
#define NEXT_TO_NOTHING 1e-200

/* A contact whose stiffnesses along its directions differ by more than this factor is skew: it has a gain for each direction. */
#define SKEW 1e4

/* Distances along its stiffer direction count by the ratio of lengths of the same energy, at most FINEST. */
#define FINEST 1e6

/* Rounding beyond this part of a limit is divided by the pressure on the rim. */
#define DOUBTFUL 1e-8

/* A distance longer than any within a set, in parts of limits. */
#define BEYOND_ALL 4.0

/* sum [2] = S x in the rows of the contact at i, which have the same columns, size [2] = sum_k |s_ik x_k| there; sum[1] = sum[0]
 * and size[1] = size[0] for a contact of one direction. */
static inline void contact_rows(const struct disc_qp *p, size_t i, const double *x, double *sum, double *size)
{
    const size_t begin = tribo_disc_row(p, i), terms = tribo_disc_terms(p, i);
    const size_t *col = p->s.pattern ? p->s.col + begin : NULL;
    const double *row = p->s.val + begin, *beside = p->s.val + tribo_disc_row(p, i + p->wide[i] - 1);
    sum[0] = sum[1] = size[0] = size[1] = 0.0;
    for (size_t t = 0; t < terms; t++) {
        const double to = x[col ? col[t] : t], term[2] = {row[t] * to, beside[t] * to};
        sum[0] += term[0];
        sum[1] += term[1];
        size[0] += fabs(term[0]);
        size[1] += fabs(term[1]);
    }
}

void tribo_disc_add(const struct disc_qp *p, size_t i, const double *x, double *sum)
{
    double part[2], size[2];
    contact_rows(p, i, x, part, size);
    for (size_t k = 0; k < p->wide[i]; k++) {
        sum[k] += part[k];
    }
}

/* S is symmetric: a dense S is summed by columns, which are its rows, in vectors. */
TRIBO_SIMD void tribo_disc_multiply(const struct disc_qp *p, const double *x, double *restrict y, double *restrict size)
{
    const size_t n = p->size;
    for (size_t i = 0; i < n; i++) {
        y[i] = size[i] = 0.0;
    }
    for (size_t i = 0; !p->s.pattern && i < n; i++) {
        const double *row = p->s.val + i * n;
        for (size_t k = 0; k < n; k++) {
            const double term = row[k] * x[i];
            y[k] += term;
            size[k] += fabs(term);
        }
    }
    for (size_t i = 0; p->s.pattern && i < n; i += p->wide[i]) {
        double sum[2], all[2];
        contact_rows(p, i, x, sum, all);
        for (size_t k = 0; k < p->wide[i]; k++) {
            y[i + k] = sum[k];
            size[i + k] = all[k];
        }
    }
}

void tribo_disc_gains(struct disc_qp *p)
{
    for (size_t i = 0; i < p->size; i += p->wide[i]) {
        const double *own = p->s.val + tribo_disc_own(p, i), a = own[0];
        const double d = p->wide[i] == 2 ? p->s.val[tribo_disc_own(p, i + 1)] : a;
        const double turned[2] = {0.5 * (a - d), p->wide[i] == 2 ? own[1] : 0.0};
        const double largest = greater(0.5 * (a + d) + tribo_length(2, turned), DBL_MIN);
        const int skew = lesser(a, d) * SKEW < greater(a, d);
        for (size_t k = i; k < i + p->wide[i]; k++) {
            p->gain[k] = 1.0 / (skew ? greater(2.0 * p->s.val[tribo_disc_own(p, k)], DBL_MIN) : largest);
        }
    }
}

int tribo_disc_descend(const struct disc_qp *p, size_t i, const double *gradient, double *to)
{
    const double *y = p->y + i;
    if (p->wide[i] == 1) {
        const double z = y[0] - product(p->gain[i], gradient[0]);
        return tribo_lens_project(1, p->shift + i, &z, to);
    }
    const double weight[2] = {1.0 / p->gain[i], 1.0 / p->gain[i + 1]};
    const double q[2] = {weight[0] * y[0] - gradient[0], weight[1] * y[1] - gradient[1]};
    return tribo_lens_minimize(p->shift + i, weight, q, to);
}

void tribo_disc_gradients(struct disc_qp *p)
{
    tribo_disc_multiply(p, p->y, p->gradient, p->noise);
    for (size_t i = 0; i < p->size; i++) {
        p->gradient[i] += p->pull[i];
        p->noise[i] = tribo_resolution(tribo_disc_terms(p, i)) * (p->noise[i] + fabs(p->pull[i]));
    }
}

/* Returns the limit of direction i, 1, or the size of its pull if forces are far below limits. */
static double unit_of(const struct disc_qp *p, size_t i)
{
    return p->near_enough < TRIBO_NEAR_ENOUGH
               ? lesser(product(p->gain[i], p->noise[i] / tribo_resolution(tribo_disc_terms(p, i))), 1.0)
               : 1.0;
}

double tribo_disc_places(struct disc_qp *p)
{
    const int far = p->near_enough < TRIBO_NEAR_ENOUGH;
    double worst = 0.0;
    p->residual = 0.0;
    for (size_t i = 0; i < p->size; i += p->wide[i]) {
        double off[2] = {0.0, 0.0}, noise[2] = {0.0, 0.0}, move[2];
        p->place[i] = (unsigned char)tribo_disc_descend(p, i, p->gradient + i, p->to + i);
        for (size_t k = 0; k < p->wide[i]; k++) {
            p->outward[i + k] = p->to[i + k] + (p->place[i] == LENS_ON_SHIFTED ? p->shift[i + k] : 0.0);
            off[k] = p->to[i + k] - p->y[i + k];
            noise[k] = product(p->gain[i + k], p->noise[i + k]);
            move[k] = product(p->gain[i + k], p->gradient[i + k]);
        }
        /* Pressure on the rim: the part of y - gain gradient beyond the rim, over gain. */
        double sum = 0.0;
        for (size_t k = i; k < i + p->wide[i]; k++) {
            sum += p->outward[k] * ((p->y[k] - p->to[k]) / p->gain[k] - p->gradient[k]);
        }
        p->curvature[i] = greater(sum, 0.0);
        double distance = tribo_length(p->wide[i], off);
        p->residual = greater(p->residual, distance);
        if (p->gain[i] != p->gain[i + p->wide[i] - 1]) { /* skew */
            const size_t stiff = p->gain[i] > p->gain[i + 1];
            const double finer = lesser(sqrt(p->gain[i + 1 - stiff] / p->gain[i + stiff]), FINEST);
            off[stiff] *= finer;
            noise[stiff] = finer * (noise[stiff] + 4.0 * DBL_EPSILON * fabs(p->y[i + stiff]));
            distance = tribo_length(2, off);
        }
        const double unit = far ? greater(unit_of(p, i), unit_of(p, i + p->wide[i] - 1)) : 1.0;
        const double rounding = greater(unit * (p->factor.sets.dependents ? DISAGREEMENT : 16.0 * DBL_EPSILON), DBL_MIN);
        double doubt = greater(noise[0], noise[1]); /* of y - gain gradient; of y less if it is pressed against a rim */
        if (doubt > DOUBTFUL) {
            doubt = greater(DOUBTFUL, doubt / greater(1.0, tribo_length(p->wide[i], move)));
        }
        worst = greater(worst, quotient(distance, greater(rounding, doubt)));
    }
    return worst;
}

static void add_freedom(struct disc_qp *p, size_t at, double x, double y, double curvature)
{
    const size_t row = p->s.pattern ? p->s.place[at] : at;
    p->freedom[p->freedoms++] = (struct freedom){at, row, {x, y}, curvature};
}

/* Returns x [size] along a freedom. */
static double tangent_qp_along(const struct freedom *e, const double *x)
{
    return e->tangent[0] * x[e->at] + (e->tangent[1] != 0.0 ? e->tangent[1] * x[e->at + 1] : 0.0);
}

static int is_on_rim(const struct disc_qp *p, size_t i)
{
    return p->wide[i] == 2 && (p->place[i] == LENS_ON_DISC || p->place[i] == LENS_ON_SHIFTED);
}

void tribo_disc_list(struct disc_qp *p)
{
    p->freedoms = 0;
    for (size_t i = 0; i < p->size; i += p->wide[i]) {
        for (size_t k = i; p->place[i] == LENS_INSIDE && k < i + p->wide[i]; k++) {
            add_freedom(p, k, 1.0, 0.0, 0.0);
        }
        if (is_on_rim(p, i)) {
            add_freedom(p, i, -p->outward[i + 1], p->outward[i], p->curvature[i]);
        }
    }
}

void tribo_disc_assemble(struct disc_qp *p)
{
    p->factor.matrix = p->s.pattern ? tribo_sparse_rows(p->s.pattern)->val : p->factor.dense;
    for (size_t k = 0; k < p->freedoms; k++) {
        const struct freedom *f = &p->freedom[k];
        const size_t begin = tribo_disc_row(p, f->at), terms = tribo_disc_terms(p, f->at);
        const int both = f->tangent[1] != 0.0;
        const double *row = p->s.val + begin, *other = both ? p->s.val + tribo_disc_row(p, f->at + 1) : row;
        for (size_t t = 0; t < terms; t++) {
            const size_t j = p->s.pattern ? p->s.col[begin + t] : t;
            double x = f->tangent[0] * row[t] + (both ? f->tangent[1] * other[t] : 0.0);
            if (is_on_rim(p, j)) {
                const double y = f->tangent[0] * row[t + 1] + (both ? f->tangent[1] * other[t + 1] : 0.0);
                x = p->outward[j] * y - p->outward[j + 1] * x;
            }
            *tribo_disc_entry(p, begin + t) = x;
        }
        *tribo_disc_entry(p, tribo_disc_own(p, f->at)) += f->curvature;
    }
}

void tribo_disc_factorize(struct disc_qp *p)
{
    struct box_qp *f = &p->factor.qp;
    double *scale = f->q, largest = 0.0;
    p->factor.group = (struct group){.size = p->s.pattern ? p->s.places : p->size, .sparse = p->s.pattern};
    f->group = &p->factor.group;
    f->sets = &p->factor.sets;
    f->r = p->factor.matrix;
    f->count = p->freedoms;
    memset(f->at, AWAY, p->factor.group.size);
    for (size_t k = 0; p->s.pattern && k < p->s.places; k++) {
        scale[k] = 0.0;
    }
    for (size_t k = 0; k < p->freedoms; k++) {
        largest = greater(largest, *tribo_disc_entry(p, tribo_disc_own(p, p->freedom[k].at)));
    }
    for (size_t k = 0; k < p->freedoms; k++) {
        const size_t row = p->freedom[k].row;
        double *own = tribo_disc_entry(p, tribo_disc_own(p, p->freedom[k].at));
        *own = greater(*own, NEXT_TO_NOTHING * largest);
        scale[row] = tribo_scale(*own);
        f->near[k] = row;
        f->at[row] = FREE;
    }
    tribo_factor_rebuild(f, NULL);
    f->null.redundant = p->s.pattern ? 0 : p->size;
    p->factor.redundant = tribo_null_basis(f);
}

void tribo_disc_linearize(struct disc_qp *p)
{
    tribo_disc_list(p);
    tribo_disc_assemble(p);
    tribo_disc_factorize(p);
}

void tribo_disc_redundant(struct disc_qp *p)
{
    if (p->s.pattern) {
        p->factor.qp.null.redundant = TRIBO_SPARSE_REDUNDANT;
        p->factor.redundant = tribo_null_basis(&p->factor.qp);
    }
}

/* move [size] = step, by rows of Newton's matrix, along the freedoms. */
static void spread(const struct disc_qp *p, const double *step, double *move)
{
    memset(move, 0, p->size * sizeof *move);
    for (size_t k = 0; k < p->freedoms; k++) {
        const struct freedom *e = &p->freedom[k];
        move[e->at] += e->tangent[0] * step[e->row];
        if (e->tangent[1] != 0.0) {
            move[e->at + 1] += e->tangent[1] * step[e->row];
        }
    }
}

void tribo_disc_follow(struct disc_qp *p, const double *rhs, double *move)
{
    for (size_t k = 0; k < p->freedoms; k++) {
        p->step[p->freedom[k].row] = -tangent_qp_along(&p->freedom[k], rhs);
    }
    tribo_factor_solve(&p->factor.qp, p->factor.redundant, p->step);
    spread(p, p->step, move);
}

void tribo_disc_slide(struct disc_qp *p, const double *rhs, double *move)
{
    double *pull = p->spare, *balanced = p->step, most = 0.0;
    int apart = 0;
    for (size_t k = 0; k < p->freedoms; k++) {
        const size_t row = p->freedom[k].row;
        pull[row] = balanced[row] = -tangent_qp_along(&p->freedom[k], rhs);
    }
    tribo_null_project(&p->factor.qp, p->factor.redundant, balanced, balanced);
    for (size_t k = 0; k < p->freedoms; k++) {
        const size_t i = p->freedom[k].at, row = p->freedom[k].row;
        pull[row] -= balanced[row];
        most = greater(most, fabs(pull[row]));
        apart |= product(p->gain[i], fabs(pull[row])) > DISAGREEMENT * unit_of(p, i);
    }
    for (size_t k = 0; k < p->freedoms; k++) {
        double *x = &pull[p->freedom[k].row];
        *x = apart ? BEYOND_ALL * (*x / most) : 0.0;
    }
    spread(p, pull, move);
}

void tribo_disc_drag(const struct disc_qp *p, size_t i, const double *dshift, double *dy)
{
    for (size_t k = 0; k < p->wide[i]; k++) {
        dy[k] = p->place[i] == LENS_ON_SHIFTED ? -dshift[k] : 0.0;
    }
    if (p->place[i] == LENS_AT_CORNER) {
        /* d(corner) = -dc/2 + d(side height across), across = (-c_2, c_1)/|c|: height falls as |c| grows, across turns with c. */
        const struct corner k = tribo_lens_corner(p->shift + i, p->to + i);
        const double *e = k.along, grows = e[0] * dshift[0] + e[1] * dshift[1], turns = e[0] * dshift[1] - e[1] * dshift[0];
        const double falls = -0.5 * quotient(k.half, greater(k.height, DBL_MIN)) * grows,
                     turn = k.height * turns / (2.0 * k.half);
        dy[0] = -0.5 * dshift[0] - k.side * (falls * e[1] + turn * e[0]);
        dy[1] = -0.5 * dshift[1] + k.side * (falls * e[0] - turn * e[1]);
    }
}
