/* SPDX-License-Identifier: BSD-3-Clause */
#include "planar_series.h"
#include "common/real.h"

#include <stdlib.h>
#include <string.h>

/* Decimal digits of the largest coefficient; squares have twice as many. At a small speed time is short, and its inverse
 * powers are large. */
#define MOST_DIGITS 100.0

/* Error of a velocity, in parts of the contact's own speed, even if that is far below the tolerance: the direction counts. */
#define PART 1e-4

/* Least order. */
#define LEAST_ORDER 4.0

void tribo_planar_series_free(struct planar_series *s)
{
    free(s->line);
    free(s->work);
    free(s->begin);
    free(s->s);
    memset(s, 0, sizeof *s);
}

static int planar_series_reserve(struct planar_series *s, size_t terms, size_t contacts)
{
    if (s->line && s->room >= contacts) {
        return 1;
    }
    tribo_planar_series_free(s);
    s->line = malloc(contacts * sizeof *s->line);
    s->work = malloc(7 * terms * contacts * sizeof *s->work);
    for (size_t k = 0; s->line && s->work && k < contacts; k++) {
        struct planar_line *l = &s->line[k];
        l->xn = s->work + 7 * terms * k;
        l->xt = l->xn + terms;
        l->un = l->xt + terms;
        l->ut = l->un + terms;
        l->speed = l->ut + terms;
        l->square = l->speed + terms;
    }
    s->room = s->line && s->work ? contacts : 0;
    return s->room > 0;
}

static int reserve_begins(struct planar_series *s, const tribo_system *sys, size_t begins)
{
    if (s->s && s->begin_room >= begins) {
        return 1;
    }
    free(s->begin);
    free(s->s);
    s->begin_room = 0;
    s->begin = malloc(2 * begins * sizeof *s->begin);
    s->s = malloc(begins * (2 * begins + 1 + sys->ndof + sys->ncontact) * sizeof *s->s);
    if (!s->begin || !s->s) {
        return 0;
    }
    s->pivot = (int *)(s->begin + begins);
    s->lu = s->s + begins * begins;
    s->tau = s->lu + begins * begins;
    s->answer = s->tau + begins;
    s->held = s->answer + begins * sys->ndof;
    s->begin_room = begins;
    return 1;
}

/* (limit t)'J acc, acc [ncontact] being J acc. */
static double planar_series_along(const struct planar_contact *p, const struct planar_line *l, const double *acc)
{
    return p->limit[0] * l->t[0] * acc[p->at] + p->limit[1] * l->t[1] * acc[p->at + 1];
}

/* Fills answer, held and a column of S: what a unit t-part of beginning contact q does to q'', to holding forces, to
 * accelerations along all t. */
static int planar_series_answer(struct planar_series *s, size_t q, struct stick_slip *m, const tribo_system *sys, double *a,
                                double *f)
{
    const size_t c = sys->ncontact, n = sys->ndof;
    const struct planar_contact *all = m->plane->contact, *p = &all[s->begin[q]];
    const struct planar_line *l = &s->line[s->begin[q]];
    double *acc = s->answer + q * n, *held = s->held + q * c;
    memset(acc, 0, n * sizeof *acc);
    memset(f, 0, c * sizeof *f);
    memset(a, 0, c * sizeof *a);
    f[p->at] = -p->limit[0] * l->t[0];
    f[p->at + 1] = -p->limit[1] * l->t[1];
    tribo_matrix_multiply_add(&sys->response, 1.0, f, acc);
    tribo_matrix_multiply_add(&sys->direction, 1.0, acc, a);
    const int status = tribo_stick_slip_balance(m, a, held);
    if (status) {
        return status;
    }
    tribo_matrix_multiply_add(&sys->response, 1.0, held, acc);
    memset(a, 0, c * sizeof *a);
    tribo_matrix_multiply_add(&sys->direction, 1.0, acc, a);
    for (size_t r = 0; r < s->begins; r++) {
        s->s[r * s->begins + q] = -planar_series_along(&all[s->begin[r]], &s->line[s->begin[r]], a);
    }
    return TRIBO_OK;
}

double tribo_planar_series_stop(const struct stick_slip *m, const tribo_system *sys, const struct planar_contact *p,
                                const double *y)
{
    double time[2];
    for (size_t d = 0; d < 2; d++) {
        time[d] = fabs(tribo_stick_slip_velocity(m, sys, p->at + d, y)) / (p->limit[d] * m->constant.diagonal[p->at + d]);
    }
    return greater(time[0], time[1]);
}

double tribo_planar_series_first_stop(const struct stick_slip *m, const tribo_system *sys, const double *y)
{
    double least = HUGE_VAL;
    for (size_t k = 0; k < m->plane->count; k++) {
        const struct planar_contact *p = &m->plane->contact[k];
        if (tribo_slides_in_plane(m, p) && p->begins == SLIDES_ON) {
            least = lesser(least, tribo_planar_series_stop(m, sys, p, y));
        }
    }
    return least;
}

int tribo_planar_series_begin(struct planar_series *s, size_t order, struct stick_slip *m, const tribo_system *sys,
                              const double *y, double *a, double *f)
{
    const struct planar_slip *plane = m->plane;
    size_t begins = 0;
    for (size_t k = 0; k < plane->count; k++) {
        begins += tribo_slides_in_plane(m, &plane->contact[k]) && plane->contact[k].begins != SLIDES_ON;
    }
    if ((plane->count && !planar_series_reserve(s, order + 1, plane->count)) || (begins && !reserve_begins(s, sys, begins))) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for series of %zu contact%s in a plane", plane->count,
                                 plural(plane->count));
    }
    /* coefficients stay within MOST_DIGITS: their unit of time is that of the first stop */
    const double most = MOST_DIGITS / greater(-log10(tribo_planar_series_first_stop(m, sys, y)), 1.0);
    s->order = s->given ? order : (size_t)greater(lesser((double)order, most), LEAST_ORDER);
    s->begins = 0;
    for (size_t k = 0; k < plane->count; k++) {
        const struct planar_contact *p = &plane->contact[k];
        struct planar_line *l = &s->line[k];
        if (tribo_slides_in_plane(m, p) && p->begins != SLIDES_ON) {
            memcpy(l->n, p->direction, sizeof l->n);
            l->t[0] = -l->n[1];
            l->t[1] = l->n[0];
            s->begin[s->begins++] = k;
        }
    }
    int status = TRIBO_OK;
    for (size_t q = 0; !status && q < s->begins; q++) {
        status = planar_series_answer(s, q, m, sys, a, f);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------- coefficients */

/* Sum of x_j y_{k - j}, from <= j < to. */
static double product_of(const double *x, const double *y, size_t k, size_t from, size_t to)
{
    double sum = 0.0;
    for (size_t j = from; j < to; j++) {
        sum += x[j] * y[k - j];
    }
    return sum;
}

/* Sets coefficient m of x = limit v; the first one gives n, or has to be along n. Returns 0 if it is against n. */
static int take_velocity(struct planar_line *l, const struct planar_contact *p, size_t m, const double *v)
{
    const double x[2] = {p->limit[0] * v[0], p->limit[1] * v[1]};
    if (m == 0 && p->begins == SLIDES_ON) {
        l->xn[0] = hypot(x[0], x[1]);
        l->n[0] = x[0] / l->xn[0];
        l->n[1] = x[1] / l->xn[0];
        l->t[0] = -l->n[1];
        l->t[1] = l->n[0];
    } else {
        l->xn[m] = l->n[0] * x[0] + l->n[1] * x[1];
    }
    l->xt[m] = m ? l->t[0] * x[0] + l->t[1] * x[1] : 0.0;
    return m > 0 || l->xn[0] > 0.0;
}

/* Part of coefficient k of |x| u along t that does not have the last coefficients of u and |x|. */
static double before(const struct planar_line *l, size_t k)
{
    return k > 1 ? product_of(l->speed, l->ut, k, 1, k) : 0.0;
}

int tribo_planar_series_forces(struct planar_series *s, const struct stick_slip *m, const tribo_system *sys, size_t k,
                               const double *v, double *f)
{
    for (size_t c = 0; c < m->plane->count; c++) {
        const struct planar_contact *p = &m->plane->contact[c];
        struct planar_line *l = &s->line[c];
        const size_t shift = (size_t)p->begins;
        if (!tribo_slides_in_plane(m, p)) {
            continue;
        }
        if (k >= shift && !take_velocity(l, p, k - shift, v + p->at)) {
            return tribo_system_fail(sys, TRIBO_ERR_CHATTER,
                                     "at t = %.17g it is not clear in which direction the planar contact %zu begins to slide",
                                     sys->loads.time, p->at);
        }
        if (!s->given) {
            const double both = k > 1 ? product_of(l->un, l->un, k, 1, k) + product_of(l->ut, l->ut, k, 1, k) : 0.0;
            l->un[k] = k ? -0.5 * both : 1.0;
            l->ut[k] = k && p->begins == SLIDES_ON ? (l->xt[k] - before(l, k)) / l->xn[0] : 0.0;
        }
        if (!s->given && k >= shift) {
            const size_t j = k - shift;
            l->speed[j] = l->xn[j] - product_of(l->speed, l->un, j, 0, j);
        }
        for (size_t d = 0; d < 2; d++) {
            f[p->at + d] = -p->limit[d] * (l->n[d] * l->un[k] + l->t[d] * l->ut[k]);
        }
    }
    return TRIBO_OK;
}

int tribo_planar_series_finish(struct planar_series *s, const struct stick_slip *m, const tribo_system *sys, size_t k,
                               const double *base, double *acc, double *held)
{
    const size_t n = s->begins;
    double *a = sys->work.a;
    if (n == 0 || k == 0) {
        return TRIBO_OK;
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        a[i] = -base[i];
    }
    tribo_matrix_multiply_add(&sys->direction, 1.0, acc, a);
    memcpy(s->lu, s->s, n * n * sizeof *s->s);
    for (size_t q = 0; q < n; q++) {
        const struct planar_contact *p = &m->plane->contact[s->begin[q]];
        const struct planar_line *l = &s->line[s->begin[q]];
        const double times = (double)(k + 1);
        double asked = k > 1 ? l->ut[k - 1] * l->xn[0] + before(l, k - 1) : 0.0;
        if (p->begins == BY_ACCELERATION) {
            asked = before(l, k);
            s->lu[q * n + q] += times * l->xn[0];
        }
        s->tau[q] = planar_series_along(p, l, a) - times * asked;
    }
    if (!(tribo_lu_create(s->lu, n, s->pivot) > 0.0)) {
        return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                 "at t = %.17g friction cannot turn the planar contact %zu, which begins to slide",
                                 sys->loads.time, m->plane->contact[s->begin[0]].at);
    }
    tribo_lu_solve(s->lu, n, s->pivot, s->tau, 1);
    for (size_t q = 0; q < n; q++) {
        s->line[s->begin[q]].ut[k] = s->tau[q];
        tribo_add(acc, s->tau[q], s->answer + q * sys->ndof, sys->ndof);
        tribo_add(held, s->tau[q], s->held + q * sys->ncontact, sys->ncontact);
    }
    return TRIBO_OK;
}

double tribo_planar_series_power(const struct planar_series *s, const struct stick_slip *m, const tribo_system *sys, size_t k)
{
    double power = 0.0;
    for (size_t c = 0; c < m->plane->count; c++) {
        const struct planar_contact *p = &m->plane->contact[c];
        const struct planar_line *l = &s->line[c];
        const size_t shift = (size_t)p->begins;
        if (tribo_slides_in_plane(m, p) && k >= shift) {
            const size_t j = k - shift;
            power += sys->tally[p->at] * (product_of(l->un, l->xn, j, 0, j + 1) + product_of(l->ut, l->xt, j, 0, j + 1));
        }
    }
    return power;
}

/* -------------------------------------------------------------------------------------------------------------- guards */

/* Coefficient k of x^2, x [terms]. */
static double square_of(const double *x, size_t terms, size_t k)
{
    return product_of(x, x, k, k < terms ? 0 : k - terms + 1, k < terms ? k + 1 : terms);
}

void tribo_planar_series_squares(struct planar_series *s, const struct stick_slip *m, const double *f)
{
    for (size_t c = 0; c < m->plane->count; c++) {
        const struct planar_contact *p = &m->plane->contact[c];
        struct planar_line *l = &s->line[c];
        const int moves = tribo_slides_in_plane(m, p);
        const size_t terms = s->order + 1 - (moves ? (size_t)p->begins : 0);
        const double scale = moves ? 1.0 : 0.5 * greater(p->limit[0], p->limit[1]);
        for (size_t k = 0; !moves && k <= s->order; k++) {
            const double *force = f + k * m->constant.contacts + p->at;
            l->xn[k] = force[0] / p->limit[0];
            l->xt[k] = force[1] / p->limit[1];
        }
        for (size_t k = 0; k <= 2 * s->order; k++) {
            l->square[k] = k < 2 * terms - 1 ? scale * (square_of(l->xn, terms, k) + square_of(l->xt, terms, k)) : 0.0;
        }
    }
}

double tribo_planar_series_value(const double *x, size_t powers, double h)
{
    double sum = 0.0;
    for (size_t k = powers + 1; k-- > 0;) {
        sum = sum * h + x[k];
    }
    return sum;
}

void tribo_planar_series_errors(const struct planar_series *s, const struct stick_slip *m, double *error)
{
    for (size_t i = 0; i < m->constant.contacts; i++) {
        error[i] = HUGE_VAL;
    }
    for (size_t c = 0; c < m->plane->count; c++) {
        const struct planar_contact *p = &m->plane->contact[c];
        if (tribo_slides_in_plane(m, p) && p->begins == SLIDES_ON) {
            error[p->at] = error[p->at + 1] = PART * s->line[c].xn[0] / greater(p->limit[0], p->limit[1]);
        }
    }
}

double tribo_planar_series_defect(const struct planar_series *s, const struct stick_slip *m, double h, double error)
{
    double most = 0.0;
    for (size_t c = 0; c < m->plane->count; c++) {
        const struct planar_contact *p = &m->plane->contact[c];
        const struct planar_line *l = &s->line[c];
        const size_t last = s->order - (size_t)p->begins;
        if (tribo_slides_in_plane(m, p)) {
            const double xn = tribo_planar_series_value(l->xn, last, h), xt = tribo_planar_series_value(l->xt, last, h),
                         size = hypot(xn, xt);
            const double off = hypot(tribo_planar_series_value(l->un, s->order, h) - xn / size,
                                     tribo_planar_series_value(l->ut, s->order, h) - xt / size);
            const double most_r =
                greater(p->limit[0] * m->constant.diagonal[p->at], p->limit[1] * m->constant.diagonal[p->at + 1]);
            const double defect = off * most_r * h / (double)(s->order + 1);
            most = greater(most, defect / lesser(error, m->plane->error[p->at]));
        }
    }
    return most;
}
