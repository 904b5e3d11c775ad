/* SPDX-License-Identifier: BSD-3-Clause */
#include "normals.h"
#include "system.h"
#include "common/layout.h"
#include "common/real.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* -------------------------------------------------------------------------------------------------------------------- life */

void tribo_normals_free(struct normals *s)
{
    free(s->normal);
    memset(s, 0, sizeof *s);
}

/* Allocates the arrays for at most `count` normals and followers each. Returns 0 if out of memory. */
static int normals_reserve(struct normals *s, size_t count, size_t ncontact)
{
    return ALLOCATE(ARRAY(s->normal, count), ARRAY(s->follower, count), ARRAY(s->at, ncontact), ARRAY(s->by, ncontact),
                    ARRAY(s->force, ncontact)) != NULL;
}

/* Sets stiffest: the largest row sum of |B_n| k |J_n| over the normals, and of |B_i| mu k |J_n| over their contacts, which slide.
 * Where compliance couples contacts, |G^-1| |G| times the forces of those that slide bounds the forces of others. Returns 0 if
 * out of memory. */
static int normals_find_stiffest(tribo_system *sys)
{
    const size_t n = sys->ndof, c = sys->ncontact;
    struct normals *s = &sys->normals;
    struct compliance *g = &sys->compliance;
    double *one, *rate, *force, *shared;
    if (!ALLOCATE(ARRAY(one, n), ARRAY(rate, n), ARRAY(force, c), ARRAY(shared, c))) {
        return 0;
    }
    for (size_t d = 0; d < n; d++) {
        one[d] = 1.0;
    }
    for (size_t k = 0; k < s->count; k++) {
        force[s->normal[k].row] = s->normal[k].stiffness * tribo_matrix_row_size(&sys->direction, s->normal[k].row, one);
    }
    for (size_t k = 0; k < s->followers; k++) {
        const struct follower *f = &s->follower[k];
        force[f->contact] = force[f->second] = f->mu * force[s->normal[f->normal].row];
    }
    if (g->factor) {
        tribo_matrix_add_sizes(&g->g, force, shared);
        tribo_matrix_add_sizes(&g->inverse, shared, force);
    }
    tribo_matrix_add_sizes(&sys->response, force, rate);
    tribo_matrix_add_sizes(&g->pull, force, rate);
    s->stiffest = tribo_largest(rate, n);
    free(one);
    return 1;
}

int tribo_normals_create(tribo_system *sys, size_t count, const struct normal_input *input, char *message)
{
    struct normals *s = &sys->normals;
    if (count == 0) {
        return TRIBO_OK;
    }
    if (!normals_reserve(s, count, sys->ncontact)) {
        return TRIBO_ERR_MEMORY;
    }
    for (size_t k = 0; k < count; k++) {
        const struct normal_input *in = input + k;
        if (s->at[in->row] == 0) {
            s->normal[s->count++] = (struct normal){.row = in->row, .stiffness = in->stiffness, .gap = in->gap};
            s->at[in->row] = s->count;
        }
        s->follower[s->followers++] = (struct follower){in->contact, s->at[in->row] - 1, in->mu, in->contact};
        s->by[in->contact] = s->followers;
        sys->tally[in->row] = 0.0;
        if (tribo_is_compliant(&sys->compliance, in->row)) {
            return tribo_error(message, TRIBO_ERR_UNSUPPORTED,
                               "contact %zu is the normal of contact %zu, and gives way by %g without mass: a normal takes mass, "
                               "no compliance, and no TRIBO_STATICS_COMPLIANCE",
                               in->row, in->contact, sys->compliance.own[in->row]);
        }
    }
    return normals_find_stiffest(sys) ? TRIBO_OK : TRIBO_ERR_MEMORY;
}

int tribo_normals_copy(tribo_system *to, const tribo_system *from)
{
    struct normals *s = &to->normals;
    const struct normals *f = &from->normals;
    *s = *f;
    const int done = !f->count || normals_reserve(s, f->followers, from->ncontact);
    if (done && f->count) {
        memcpy(s->normal, f->normal, (size_t)((char *)f->force - (char *)f->normal)); /* all arrays but force */
    }
    return done;
}

/* ------------------------------------------------------------------------------------------------------------------- checks */

int tribo_normals_check_limits(const tribo_system *sys, const double *limit)
{
    for (size_t i = 0; sys->normals.count && i < sys->ncontact; i++) {
        const int follows = tribo_normals_follower(sys, i) != NULL;
        if (limit[i] > 0.0 && (follows || tribo_normals_at(sys, i))) {
            return tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED, "limit[%zu] = %g, but %scontact %zu %s: leave it 0", i,
                               limit[i], follows ? "the limit of " : "", i,
                               follows ? "follows its normal load" : "is a normal direction, which has no friction");
        }
    }
    return TRIBO_OK;
}

int tribo_normals_pair(tribo_system *sys)
{
    const struct normals *s = &sys->normals;
    const size_t c = sys->ncontact;
    if (s->count == 0) {
        return TRIBO_OK;
    }
    unsigned char *pair = malloc(c);
    int status = pair ? tribo_system_find_pairs(sys, pair) : TRIBO_ERR_MEMORY;
    memset(s->by, 0, c * sizeof *s->by);
    for (size_t k = 0; k < s->followers; k++) {
        s->by[s->follower[k].contact] = k + 1;
        s->follower[k].second = s->follower[k].contact;
    }
    for (size_t i = 0; !status && i < c; i++) {
        const int first = pair[i] == PAIR_FIRST;
        if (first && (s->at[i] || s->at[i + 1] || s->by[i + 1])) {
            status = tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                                 "contact %zu and contact %zu are the directions of one planar contact: only the first takes a "
                                 "normal, and none is one",
                                 i, i + 1);
        } else if (first && s->by[i]) {
            s->by[i + 1] = s->by[i];
            s->follower[s->by[i] - 1].second = i + 1;
        }
        i += (size_t)first;
    }
    status = status || normals_find_stiffest(sys) ? status : TRIBO_ERR_MEMORY;
    free(pair);
    return status == TRIBO_ERR_MEMORY ? tribo_error(sys->message, status, "out of memory for %zu contact%s", c, plural(c))
                                      : status;
}

/* ------------------------------------------------------------------------------------------------------------------- motion */

void tribo_normals_move(tribo_system *sys, const double *q, const double *u)
{
    for (size_t k = 0; k < sys->normals.count; k++) {
        struct normal *const n = sys->normals.normal + k;
        n->depth = tribo_matrix_row_dot(&sys->direction, n->row, q) - n->gap;
        n->speed = tribo_matrix_row_dot(&sys->direction, n->row, u);
        n->size = tribo_matrix_row_size(&sys->direction, n->row, q) + fabs(n->gap);
    }
}

void tribo_normals_set(tribo_system *sys, const double *q, const double *u)
{
    tribo_normals_move(sys, q, u);
    for (size_t k = 0; k < sys->normals.count; k++) {
        struct normal *const n = sys->normals.normal + k;
        n->pressed = n->depth > 0.0;
    }
    if (sys->normals.count) {
        tribo_system_put_limits(sys, 0.0);
    }
}

void tribo_normals_limits(const tribo_system *sys, double *limit, double *rate)
{
    const struct normals *s = &sys->normals;
    for (size_t k = 0; k < s->count; k++) {
        limit[s->normal[k].row] = rate[s->normal[k].row] = 0.0;
    }
    for (size_t k = 0; k < s->followers; k++) {
        const struct follower *f = &s->follower[k];
        const struct normal *n = &s->normal[f->normal];
        limit[f->contact] = limit[f->second] = product(f->mu * n->stiffness, n->depth);
        rate[f->contact] = rate[f->second] = product(f->mu * n->stiffness, n->speed);
    }
}

void tribo_normals_push(const tribo_system *sys, int all, int gap, double factor, const double *x, double *to)
{
    const struct normals *s = &sys->normals;
    for (size_t k = 0; k < s->count; k++) {
        const struct normal *n = &s->normal[k];
        const double depth = tribo_matrix_row_dot(&sys->direction, n->row, x) - (gap ? n->gap : 0.0);
        s->force[n->row] = all || n->pressed ? n->stiffness * depth : 0.0;
    }
    tribo_matrix_multiply_add(&sys->response, -factor, s->force, to);
}
