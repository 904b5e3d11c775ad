/* SPDX-License-Identifier: BSD-3-Clause */
#include "contacts.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "../../src/damper/output.h"

/* splitmix64, in [-1, 1] */
static double random_of(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
}

static void append(struct contacts *s, size_t i, size_t j, double value)
{
    s->col[s->first[i + 1]] = j;
    s->val[s->first[i + 1]++] = value;
}

/* Row i of R, with 1 to 5 on the diagonal. */
static void add_row(struct contacts *s, enum coupled coupled, size_t i, size_t width)
{
    const size_t n = s->n, begin = coupled == ISLANDS ? i - i % ISLAND : 0;
    const size_t end = coupled == ISLANDS ? (begin + ISLAND < n ? begin + ISLAND : n) : n;
    s->first[i + 1] = s->first[i];
    if (coupled == ALONE) {
        append(s, i, i, 1.0);
    } else if (coupled == ISLANDS || coupled == DENSE) {
        for (size_t j = begin; j < end; j++) {
            append(s, i, j, i == j ? 1.5 : 0.5);
        }
    } else {
        if (coupled == CARPET && i >= width) {
            append(s, i, i - width, -1.0);
        }
        if (i % width > 0) {
            append(s, i, i - 1, -1.0);
        }
        append(s, i, i, coupled == CARPET ? 4.5 : 2.5);
        if (i % width + 1 < width && i + 1 < n) {
            append(s, i, i + 1, -1.0);
        }
        if (coupled == CARPET && i + width < n) {
            append(s, i, i + width, -1.0);
        }
    }
}

static void create_operator(struct contacts *s, enum coupled coupled)
{
    const size_t n = s->n, widest = coupled == DENSE ? n : coupled == ISLANDS ? ISLAND : 5;
    const size_t width = coupled == CARPET ? (size_t)ceil(sqrt((double)n)) : n;
    s->first = need_memory(n + 1, sizeof *s->first);
    s->col = need_memory(n * widest, sizeof *s->col);
    s->val = need_memory(n * widest, sizeof *s->val);
    s->first[0] = 0;
    for (size_t i = 0; i < n; i++) {
        add_row(s, coupled, i, width);
    }
    if (coupled == DENSE) {
        s->dense = s->val; /* whole rows are stored the same way */
    }
}

static void set_operator(struct contacts *s)
{
    need(s->dense ? tribo_set_operator_dense(s->ctx, s->dense) : tribo_set_operator_csr(s->ctx, s->first, s->col, s->val),
         tribo_message(s->ctx));
}

/* The a for which f = stuck. */
static void find_a(struct contacts *s, int parity)
{
    for (size_t i = 0; i < s->n; i++) {
        double sum = 0.0;
        for (size_t e = s->first[i]; e < s->first[i + 1]; e++) {
            sum += s->val[e] * s->stuck[parity][s->col[e]];
        }
        s->a[parity][i] = -sum;
    }
}

/* SOME are one in so many. */
enum { SELDOM = 20 };

void contacts_create(struct contacts *s, enum coupled coupled, size_t n, size_t stride, enum change change)
{
    uint64_t state = n;
    const size_t group = coupled == ISLANDS ? ISLAND : n;
    *s = (struct contacts){.n = n, .change = change};
    create_operator(s, coupled);
    s->place = need_memory(n, sizeof *s->place);
    s->f = need_memory(n, sizeof *s->f);
    for (int parity = 0; parity < 2; parity++) {
        s->v[parity] = need_memory(n, sizeof *s->v[parity]);
        s->a[parity] = need_memory(n, sizeof *s->a[parity]);
        s->stuck[parity] = need_memory(n, sizeof *s->stuck[parity]);
    }
    for (size_t i = 0; i < n; i++) {
        const int awake = stride && i / group % stride == 0;
        const int moves = change == HALF ? i % 2 == 1 : change == SOME ? i * 7 % SELDOM == 1 : 0;
        s->v[0][i] = awake ? 0.0 : 3.0;
        s->v[1][i] = awake && !moves ? 0.0 : 3.0;
        s->stuck[0][i] = awake ? 0.1 * random_of(&state) : -1.0;
        s->stuck[1][i] = awake && !moves ? s->stuck[0][i] + 0.01 * random_of(&state) : -1.0;
        if (awake) {
            s->place[s->awake++] = i;
        }
    }
    find_a(s, 0);
    find_a(s, 1);
    need(tribo_create(&s->ctx, n), NULL);
    need(tribo_set_limit_all(s->ctx, 1.0), tribo_message(s->ctx));
    need(tribo_set_epsilon_all(s->ctx, 1.0), tribo_message(s->ctx));
    set_operator(s);
}

void contacts_destroy(struct contacts *s)
{
    tribo_destroy(s->ctx);
    free(s->first);
    free(s->col);
    free(s->val);
    free(s->place);
    free(s->f);
    for (int parity = 0; parity < 2; parity++) {
        free(s->v[parity]);
        free(s->a[parity]);
        free(s->stuck[parity]);
    }
}

static const double *velocities(const struct contacts *s, size_t call)
{
    return s->v[s->change == HALF || s->change == SOME ? call % 2 : 0];
}

void contacts_call(void *contacts)
{
    struct contacts *s = contacts;
    const size_t call = s->calls++;
    if (s->change == ONE && s->awake) {
        if (call % 2 == 0) {
            s->mover = s->place[call * 7919 % s->awake];
        }
        s->v[0][s->mover] = call % 2 ? 0.0 : 3.0;
    } else if (s->change == ANEW) {
        set_operator(s);
    }
    need(tribo_balance(s->ctx, velocities(s, call), s->a[call % 2], NULL, s->f), tribo_message(s->ctx));
}

double contacts_error(const struct contacts *s)
{
    const size_t call = s->calls - 1;
    const double *v = velocities(s, call);
    double most = 0.0;
    for (size_t i = 0; i < s->n; i++) {
        double sum = s->a[call % 2][i], size = fabs(sum);
        for (size_t e = s->first[i]; e < s->first[i + 1]; e++) {
            const double term = s->val[e] * s->f[s->col[e]];
            sum += term;
            size += fabs(term);
        }
        sum /= size;
        most = fmax(most, fabs(s->f[i]) - 1.0);
        most = fmax(most, v[i] != 0.0 ? fabs(s->f[i] + 1.0) : fabs(s->f[i]) < 1.0 ? fabs(sum) : sum * s->f[i]);
        most = s->f[i] == s->f[i] ? most : HUGE_VAL;
    }
    return most;
}

static double count_of(const struct contacts *s, int which)
{
    size_t value;
    need(tribo_get_count(s->ctx, which, &value), tribo_message(s->ctx));
    return (double)value;
}

struct counts contacts_count(struct contacts *s, size_t calls)
{
    enum { COUNTS = 5 };
    const int which[COUNTS] = {TRIBO_COUNT_SKIPPED, TRIBO_COUNT_SOLVES, TRIBO_COUNT_REUSED, TRIBO_COUNT_FACTORIZATIONS,
                               TRIBO_COUNT_UPDATES};
    double value[COUNTS];
    for (int k = 0; k < COUNTS; k++) {
        value[k] = -count_of(s, which[k]);
    }
    for (size_t k = 0; k < calls; k++) {
        contacts_call(s);
    }
    for (int k = 0; k < COUNTS; k++) {
        value[k] = (value[k] + count_of(s, which[k])) / (double)calls;
    }
    return (struct counts){value[0], value[1], value[2], value[3], value[4]};
}
