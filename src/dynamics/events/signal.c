/* SPDX-License-Identifier: BSD-3-Clause */
#include "signal.h"
#include "common/real.h"
#include "first_zero.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Most turning points of a phase; more are rounding. */
#define MOST_TURNS 100000

int tribo_signal_reserve(struct signal *s, size_t terms, size_t degree)
{
    if (terms > s->room[0] || degree + 1 > s->room[1]) {
        double complex *more = malloc((3 * terms + degree + 1) * sizeof *more);
        if (!more) {
            return 0;
        }
        free(s->c);
        s->c = more;
        s->lambda = more + terms;
        s->grown = more + 2 * terms;
        s->a = (double *)(more + 3 * terms);
        s->room[0] = terms;
        s->room[1] = degree + 1;
    }
    s->terms = 0;
    s->degree = degree;
    memset(s->a, 0, (degree + 1) * sizeof *s->a);
    return 1;
}

void tribo_signal_free(struct signal *s)
{
    free(s->c);
    memset(s, 0, sizeof *s);
}

void tribo_signal_add(struct signal *s, double complex c, double complex lambda)
{
    s->c[s->terms] = c;
    s->lambda[s->terms++] = lambda;
}

void tribo_signal_at(const struct signal *s, double at, double *to)
{
    double v0 = 0.0, v1 = 0.0, v2 = 0.0, v3 = 0.0;
    for (size_t j = s->degree + 1; j-- > 0;) {
        v3 = v3 * at + v2;
        v2 = v2 * at + v1;
        v1 = v1 * at + v0;
        v0 = v0 * at + s->a[j];
    }
    to[0] = v0;
    to[1] = v1;
    to[2] = 2.0 * v2;
    to[3] = 6.0 * v3;
    for (size_t p = 0; p < s->terms; p++) {
        double complex term = s->c[p] * cexp(s->lambda[p] * at);
        for (int k = 0; k < 4; k++) {
            to[k] += creal(term);
            term *= s->lambda[p];
        }
    }
}

/* -------------------------------------------------------------------------------------------------------------- extremes */

/* side times the slope of a signal, from a time on: must not fall below zero. */
struct course {
    const struct signal *s;
    double from, side;
    struct first_zero *search;
};

static void look_at_slope(void *own, double tau, size_t guards, struct guard *const *guard)
{
    const struct course *c = own;
    double v[4];
    (void)guards;
    tribo_signal_at(c->s, c->from + tau, v);
    guard[0]->middle = (struct sample){c->side * v[1], c->side * v[2], c->side * v[3]};
}

static double bound(void *own, double tau)
{
    const struct course *c = own;
    const struct signal *s = c->s;
    struct guard *g = c->search->guard;
    double power = 1.0; /* tau^(j - 1) */
    (void)tau;
    g->size = g->bend = 0.0;
    for (size_t p = 0; p < s->terms; p++) {
        const double rate = cabs(s->lambda[p]), growth = creal(s->lambda[p]);
        const double size = cabs(s->c[p]) * rate * exp(growth * (growth > 0.0 ? s->tau : c->from));
        g->size += size;
        g->bend += size * pow(rate, 6.0);
    }
    for (size_t j = 1; j <= s->degree; j++) {
        const double size = fabs((double)j * s->a[j]) * power, k = (double)j - 1.0;
        g->size += size;
        g->bend += j < 7 ? 0.0 : size * k * (k - 1) * (k - 2) * (k - 3) * (k - 4) * (k - 5) / pow(s->tau, 6.0);
        power *= s->tau;
    }
    return HUGE_VAL;
}

static void look(const struct signal *s, double at, double t, struct extremes *e)
{
    double v[4];
    tribo_signal_at(s, at, v);
    if (v[0] < e->least) {
        e->least = v[0];
        e->at_least = t + at;
    }
    if (v[0] > e->most) {
        e->most = v[0];
        e->at_most = t + at;
    }
}

/* Goes from one turning point to the next, the first zero of the slope. */
int tribo_signal_extremes(const struct signal *s, double t, struct extremes *e)
{
    struct guard guard = {0}, *watched = &guard;
    static const struct motion motion = {.look = look_at_slope, .bound = bound};
    struct first_zero search = {.guards = 1, .guard = &guard, .watched = &watched, .motion = &motion};
    struct course course = {.s = s, .search = &search};
    const struct guard *met = &guard;
    double v[4], when = 0.0;
    search.own = &course;
    search.resolution = 1e-16 * s->tau;
    look(s, 0.0, t, e);
    look(s, s->tau, t, e);
    tribo_signal_at(s, 0.0, v);
    course.side = v[1] > 0.0 || (v[1] == 0.0 && v[2] > 0.0) ? 1.0 : -1.0;
    for (int k = 0; met && k < MOST_TURNS && course.from < s->tau; k++) {
        guard = (struct guard){0};
        if (!tribo_first_zero(&search, s->tau - course.from, &met, &when)) {
            return 0;
        }
        course.from += met ? greater(when, search.resolution) : 0.0;
        course.side = -course.side;
        look(s, lesser(course.from, s->tau), t, e);
    }
    return 1;
}

/* -------------------------------------------------------------------------------------------------------------- integrals */

/* The integral of s^j e^{z s}/tau^j from 0 to tau, by the series of the exponential: |z| tau is small, or by parts. */
static double complex moment(double complex z, double tau, size_t j)
{
    double complex term = tau, sum = 0.0;
    for (size_t k = 0; k < 200 && cabs(term) > 1e-18 * tau; k++) {
        sum += term / (double)(j + k + 1);
        term *= z * tau / (double)(k + 1);
    }
    return sum;
}

/* The integral of e^{z s} from 0 to tau; grown: e^{z tau}. */
static double complex integral(double complex z, double tau, double complex grown)
{
    return cabs(z) * tau < 1.0 ? moment(z, tau, 0) : (grown - 1.0) / z;
}

/* The integral of sum a_j s^j e^{z s} from 0 to tau; grown: e^{z tau}. It is found upwards in j by parts where that loses no
 * digits, else by the series. */
static double complex integrate_powers(const struct signal *s, double complex z, double tau, double complex grown)
{
    const double turn = cabs(z) * tau;
    double complex sum = 0.0, m = 1.0; /* M_j, the moment of z; for j = 0 by parts: j M_{j-1}/tau = 1 */
    double power = 1.0;
    for (size_t j = 0; j <= s->degree; j++) {
        m = turn < 4.0 + (double)j ? moment(z, tau, j) : (grown - (j ? (double)j * m / tau : 1.0)) / z;
        sum += s->a[j] * power * m;
        power *= tau;
    }
    return sum;
}

void tribo_signal_integrate(const struct signal *s, double omega, double *re, double *im)
{
    const double tau = s->tau;
    const double complex turns = -omega * I;
    double complex sum = integrate_powers(s, turns, tau, cexp(turns * tau));
    for (size_t p = 0; p < s->terms; p++) {
        /* half of c e^{lambda s} and half of its conjugate */
        for (int side = -1; side <= 1; side += 2) {
            const double complex z = (side < 0 ? conj(s->lambda[p]) : s->lambda[p]) - omega * I;
            sum += 0.5 * (side < 0 ? conj(s->c[p]) : s->c[p]) * integral(z, tau, cexp(z * tau));
        }
    }
    *re += creal(sum);
    *im += cimag(sum);
}

double tribo_signal_product(struct signal *s)
{
    const double tau = s->tau;
    double sum = 0.0, power = tau;
    for (size_t j = 0; j <= s[0].degree; j++) {
        double by = power;
        for (size_t k = 0; k <= s[1].degree; k++) {
            sum += s[0].a[j] * s[1].a[k] * by / (double)(j + k + 1);
            by *= tau;
        }
        power *= tau;
    }
    for (size_t p = 0; p < s[0].terms; p++) {
        const double complex lambda = s[0].lambda[p], grown = cexp(lambda * tau);
        s[0].grown[p] = grown;
        sum += creal(s[0].c[p] * integrate_powers(s + 1, lambda, tau, grown));
    }
    for (size_t q = 0; q < s[1].terms; q++) {
        const double complex lambda = s[1].lambda[q], grown = cexp(lambda * tau);
        double complex other = integrate_powers(s, lambda, tau, grown);
        for (size_t p = 0; p < s[0].terms; p++) {
            const double complex one = s[0].lambda[p], end = s[0].grown[p], c = 0.5 * s[0].c[p];
            other += c * integral(one + lambda, tau, end * grown);
            other += conj(c) * integral(conj(one) + lambda, tau, conj(end) * grown);
        }
        sum += creal(s[1].c[q] * other);
    }
    return sum;
}
