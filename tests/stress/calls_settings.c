/* SPDX-License-Identifier: BSD-3-Clause */
/* What calls_core.c sets: law, coupling, sharing, limits, epsilon, and the operator in all its forms. */
#include <math.h>
#include <string.h>

#include "calls_core.h"
#include "../user_quinn.h"

/* Numbers of laws from which on the law is Quinn's as a caller writes it. */
enum { USER = 200 };

static struct quinn quinn = {0, 0};

void set_number(struct slot *s, struct string *in)
{
    const int which = (int)take(in) % 3, value = (int)take(in) - 2;
    if (which == 0 && value >= USER) {
        check(s, "set_user_law", tribo_set_user_law(s->c, quinn_box, &quinn), TRIBO_OK);
        s->law = TRIBO_QUINN;
        s->own = 1;
        s->linear = 0;
        return;
    }
    int *const setting = which == 0 ? &s->law : which == 1 ? &s->coupling : &s->sharing;
    const int most = which == 0 ? 6 : 2, legal = value >= 0 && value < most;
    const int status = which == 0   ? tribo_set_law(s->c, value)
                       : which == 1 ? tribo_set_coupling(s->c, value)
                                    : tribo_set_sharing(s->c, value);
    if (!check(s, "set_number", status, legal ? TRIBO_OK : TRIBO_ERR_RANGE)) {
        *setting = value;
        s->own = s->own && which != 0;
        s->linear = 0;
    }
}

void set_limit(struct slot *s, struct string *in)
{
    double x[MOST];
    int wild = 0;
    const int all = take(in) % 4 == 0;
    numbers(in, x, all ? 1 : s->n, NONNEGATIVE, &wild);
    for (size_t i = 1; all && i < s->n; i++) {
        x[i] = x[0];
    }
    const int want = fault(x, all ? 1 : s->n, NONNEGATIVE);
    if (!check(s, "set_limit", all ? tribo_set_limit_all(s->c, x[0]) : tribo_set_limit(s->c, x), want)) {
        memcpy(s->limit, x, s->n * sizeof *x);
        s->wild_limit = wild;
        s->linear = 0;
    }
}

void set_epsilon(struct slot *s, struct string *in)
{
    double x[MOST];
    int wild = 0;
    const unsigned kind = take(in) % 4;
    const size_t count = kind == 0 ? 1 : kind == 1 ? 2 : s->n;
    numbers(in, x, count, POSITIVE, &wild);
    int want = fault(x, count, POSITIVE);
    if (kind == 1 && want) { /* dt is looked at first */
        want = fault(x, 1, POSITIVE) ? fault(x, 1, POSITIVE) : fault(x + 1, 1, POSITIVE);
    }
    const int status = kind == 0   ? tribo_set_epsilon_all(s->c, x[0])
                       : kind == 1 ? tribo_set_epsilon_step(s->c, x[0], x[1])
                                   : tribo_set_epsilon(s->c, x);
    if (!check(s, "set_epsilon", status, want)) {
        s->follows = kind == 1;
        for (size_t i = 0; kind != 1 && i < s->n; i++) {
            s->epsilon[i] = x[kind == 0 ? 0 : i];
        }
        s->wild_epsilon = wild;
        s->linear = 0;
    }
}

/* J [n][2], in compressed rows, and the inverse masses of the bodies. A third of the time a few bodies have all contacts,
 * otherwise they stand in a row. */
struct bodies {
    size_t count, first[MOST + 1], col[2 * MOST];
    double inverse[MOST + 1], val[2 * MOST];
    int wild;
};

static struct bodies take_bodies(struct string *in, size_t n)
{
    struct bodies b = {.count = n + 1};
    const int few = n < 100 && take(in) % 3 == 0;
    b.count = few ? BODIES : n + 1;
    for (size_t k = 0; k < b.count; k++) {
        b.inverse[k] = k < 12 ? fabs(number(in, &b.wild)) : b.inverse[k % 12];
    }
    for (size_t i = 0; i < n; i++) {
        const size_t one = few ? take(in) % BODIES : i, other = few ? take(in) % BODIES : i + 1;
        b.first[i + 1] = b.first[i];
        b.col[b.first[i + 1]] = one;
        b.val[b.first[i + 1]++] = 1.0;
        if (other != one) {
            b.col[b.first[i + 1]] = other;
            b.val[b.first[i + 1]++] = -1.0;
        }
    }
    return b;
}

static double coupling_of(const struct bodies *b, size_t i, size_t j)
{
    double sum = 0.0;
    for (size_t k = b->first[i]; k < b->first[i + 1]; k++) {
        for (size_t l = b->first[j]; l < b->first[j + 1]; l++) {
            sum += b->col[k] == b->col[l] ? b->val[k] * b->inverse[b->col[k]] * b->val[l] : 0.0;
        }
    }
    return sum;
}

struct inertia {
    const double *inverse;
    int fails;
};

static int accelerate(size_t ndof, const double *force, double *acceleration, void *data)
{
    const struct inertia *m = data;
    for (size_t k = 0; k < ndof; k++) {
        acceleration[k] = m->inverse[k] * force[k];
    }
    return m->fails;
}

/* R as it comes from the bodies, in one of all forms; or with a fault of its own. */
void set_operator(struct slot *s, struct string *in)
{
    const unsigned form = take(in) % 5, spoilt = take(in);
    const size_t n = s->n;
    struct bodies b = take_bodies(in, n);
    double *r = calloc(n * n + 1, sizeof *r), *val = calloc(n * n + 1, sizeof *val);
    size_t *first = calloc(n + 1, sizeof *first), *col = calloc(n * n + 1, sizeof *col);
    require(r && val && first && col, "memory");
    int want = TRIBO_OK;
    for (size_t i = 0; i < n * n; i++) {
        r[i] = form == 0 && i % (n + 1) ? 0.0 : coupling_of(&b, i / n, i % n);
    }
    if (n && spoilt < 24) {
        static const double faults[] = {-1.0, (double)NAN, HUGE_VAL};
        static const int statuses[] = {TRIBO_ERR_NEGATIVE, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NOT_FINITE};
        const size_t at = spoilt % n;
        r[at * n + at] = b.inverse[0] = faults[spoilt % 3];
        want = form == 1 || form == 2 ? (spoilt % 3 ? TRIBO_ERR_NOT_FINITE : TRIBO_ERR_INDEFINITE) : statuses[spoilt % 3];
        b.wild |= form == 4;
    }
    for (size_t i = 0; i < n; i++) {
        first[i + 1] = first[i];
        for (size_t j = 0; j < n; j++) {
            if (r[i * n + j] != 0.0) {
                col[first[i + 1]] = j;
                val[first[i + 1]++] = r[i * n + j];
            }
        }
    }
    struct inertia m = {b.inverse, spoilt == 255};
    double *diagonal = calloc(n + 1, sizeof *diagonal);
    require(diagonal, "memory");
    for (size_t i = 0; i < n; i++) {
        diagonal[i] = r[i * n + i];
    }
    int status = form == 0   ? tribo_set_operator_diagonal(s->c, diagonal)
                 : form == 1 ? tribo_set_operator_dense(s->c, r)
                 : form == 2 ? tribo_set_operator_csr(s->c, first, col, val)
                 : form == 3 ? tribo_set_operator_mass(s->c, b.count, b.inverse, b.first, b.col, b.val)
                             : tribo_set_operator_callback(s->c, b.count, accelerate, &m, b.first, b.col, b.val);
    const double *again = form == 0 ? diagonal : form == 1 ? r : form == 2 ? val : b.val;
    for (unsigned k = 0; !status && form < 4 && k < spoilt % 4; k++) {
        status = tribo_update_operator(s->c, again);
    }
    if (form == 4 && n && m.fails) {
        want = TRIBO_ERR_CALLBACK;
    }
    if (!b.wild) {
        check(s, "set_operator", status, want);
    }
    if (!status) {
        memcpy(s->r, r, n * n * sizeof *r);
        s->operator= 1;
        s->wild_operator = b.wild;
        s->linear = 0;
    }
    free(r);
    free(val);
    free(first);
    free(col);
    free(diagonal);
}
