/* SPDX-License-Identifier: BSD-3-Clause */
/* What planar contacts cost: the step and the balance at rest, which are one problem, beside projected Gauss-Seidel in plain C;
 * and a balance within the band, which is the lenses'. Where Siconos is installed, a table of the step by its solvers. Then rows
 * and carpets of many contacts, beside as many scalar ones. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../src/damper/output.h"
#include "harness.h"
#include "tribo/tribo.h"

#if defined(HAVE_SICONOS)
#include "peer_tresca.h"
#endif

#define ENOUGH 1e-10 /* a sweep that moves no force by more ends Gauss-Seidel */
#define MOST_SWEEPS 20000
#define MOST 1000 /* contacts of a scene */

/* n planar contacts, limit 1, of which some would need more than their limit to hold; calls take the two pulls in turn. */
struct scene {
    const char *name;
    size_t n;
    double *r;           /* [2n][2n] */
    size_t *begin, *end; /* [2n] entries of its rows that are not 0 are there */
    double *pull[2], *v; /* [2n] */
    double *f, *plain;   /* [2n] of tribo, and of Gauss-Seidel */
    tribo_context *ctx;
    size_t calls, passes, sweeps; /* calls of tribo, and of Gauss-Seidel with the sweeps of the last */
};

static double uniform(unsigned *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (double)(*state >> 8) / 8388608.0 - 1.0;
}

/* R = J J', J of so many columns. */
static void couple(struct scene *s, size_t columns)
{
    const size_t n = 2 * s->n;
    unsigned state = 1;
    double *j = calloc(n * columns, sizeof *j);
    for (size_t k = 0; k < n * columns; k++) {
        j[k] = uniform(&state) / sqrt((double)columns);
    }
    for (size_t i = 0; i < n * n; i++) {
        for (size_t k = 0; k < columns; k++) {
            s->r[i] += j[i / n * columns + k] * j[i % n * columns + k];
        }
    }
    free(j);
}

/* Bodies in a row, a contact between each and the next. */
static void couple_row(struct scene *s)
{
    const size_t n = 2 * s->n;
    for (size_t i = 0; i < n; i++) {
        s->r[i * n + i] = 2.0;
        if (i >= 2) {
            s->r[i * n + i - 2] = s->r[(i - 2) * n + i] = -1.0;
        }
    }
}

static struct scene scene_create(const char *name, size_t n)
{
    struct scene s = {.name = name, .n = n};
    const size_t size = 2 * n;
    size_t *first = calloc(n, sizeof *first);
    unsigned state = 7;
    s.begin = calloc(2 * size, sizeof *s.begin);
    s.end = s.begin + size;
    s.r = calloc(size * size, sizeof *s.r);
    s.pull[0] = calloc(5 * size, sizeof *s.f);
    s.pull[1] = s.pull[0] + size;
    s.v = s.pull[0] + 2 * size;
    s.f = s.pull[0] + 3 * size;
    s.plain = s.pull[0] + 4 * size;
    if (strcmp(name, "row") == 0) {
        couple_row(&s);
    } else {
        couple(&s, strcmp(name, "dense") == 0 ? 2 * size : n);
    }
    for (size_t i = 0; i < size; i++) {
        s.begin[i] = strcmp(name, "row") == 0 && i > 2 ? i - 2 : 0;
        s.end[i] = strcmp(name, "row") == 0 && i + 3 < size ? i + 3 : size;
    }
    for (size_t i = 0; i < size; i++) {
        const double angle = (double)(i / 2), needed = (0.5 + 0.4 * (double)(i / 2 % 3)) * (i % 2 ? cos(angle) : sin(angle));
        const double other = needed * (1.0 + 0.01 * uniform(&state));
        for (size_t k = s.begin[i]; k < s.end[i]; k++) {
            s.pull[0][k] += s.r[k * size + i] * needed;
            s.pull[1][k] += s.r[k * size + i] * other;
        }
        s.v[i] = 0.4 * uniform(&state);
        first[i / 2] = i - i % 2;
    }
    need(tribo_create(&s.ctx, size), NULL);
    need(tribo_set_planar(s.ctx, n, first), tribo_message(s.ctx));
    need(tribo_set_limit_all(s.ctx, 1.0), tribo_message(s.ctx));
    need(tribo_set_epsilon_all(s.ctx, 1.0), tribo_message(s.ctx));
    need(tribo_set_operator_dense(s.ctx, s.r), tribo_message(s.ctx));
    free(first);
    return s;
}

static void scene_destroy(struct scene *s)
{
    tribo_destroy(s->ctx);
    free(s->begin);
    free(s->r);
    free(s->pull[0]);
}

/* --------------------------------------------------------------------------------------------------------------- jobs */

static void step(void *data)
{
    struct scene *s = data;
    need(tribo_step_force(s->ctx, 1.0, s->pull[s->calls++ % 2], s->f), tribo_message(s->ctx));
}

static void rest(void *data)
{
    static const double none[2 * MOST];
    struct scene *s = data;
    need(tribo_balance(s->ctx, none, s->pull[s->calls++ % 2], NULL, s->f), tribo_message(s->ctx));
}

static void band(void *data)
{
    struct scene *s = data;
    need(tribo_balance(s->ctx, s->v, s->pull[s->calls++ % 2], NULL, s->f), tribo_message(s->ctx));
}

/* A contact by itself: its own block's largest eigenvalue makes the step, and the disc's nearest point the force. */
static double relax(struct scene *s, const double *pull, size_t i)
{
    const size_t n = 2 * s->n;
    const double *row = s->r + i * n, half = 0.5 * (row[i] - row[n + i + 1]);
    const double largest = 0.5 * (row[i] + row[n + i + 1]) + hypot(half, row[i + 1]);
    double x[2], moved = 0.0;
    for (size_t d = 0; d < 2; d++) {
        double sum = pull[i + d];
        for (size_t k = s->begin[i + d]; k < s->end[i + d]; k++) {
            sum += row[d * n + k] * s->plain[k];
        }
        x[d] = s->plain[i + d] - sum / largest;
    }
    const double length = hypot(x[0], x[1]), part = length > 1.0 ? 1.0 / length : 1.0;
    for (size_t d = 0; d < 2; d++) {
        moved = fmax(moved, fabs(part * x[d] - s->plain[i + d]));
        s->plain[i + d] = part * x[d];
    }
    return moved;
}

/* From the last solution, as tribo does. */
static void gauss_seidel(void *data)
{
    struct scene *s = data;
    const double *pull = s->pull[s->passes++ % 2];
    double moved = 1.0;
    for (s->sweeps = 0; moved > ENOUGH && s->sweeps < MOST_SWEEPS; s->sweeps++) {
        moved = 0.0;
        for (size_t i = 0; i < s->n; i++) {
            moved = fmax(moved, relax(s, pull, 2 * i));
        }
    }
}

/* -------------------------------------------------------------------------------------------------------------- tables */

/* The largest difference of R f between the two, which have been called equally often. */
static double difference(struct scene *s)
{
    const size_t n = 2 * s->n;
    double most = 0.0;
    step(s);
    gauss_seidel(s);
    for (size_t i = 0; i < n; i++) {
        double sum = 0.0;
        for (size_t k = 0; k < n; k++) {
            sum += s->r[i * n + k] * (s->f[k] - s->plain[k]);
        }
        most = fmax(most, fabs(sum));
    }
    return most;
}

#if defined(HAVE_SICONOS)

/* A solver of Siconos at work on a scene. */
struct peer {
    struct scene *scene;
    struct tresca *tresca;
    double f[2 * MOST];
    size_t calls;
    int failed;
};

static void peer_step(void *data)
{
    struct peer *p = data;
    p->failed |= tresca_solve(p->tresca, p->scene->pull[p->calls++ % 2], p->f) != 0;
}

/* The largest difference of R f from tribo's, both at the first pull. */
static double peer_difference(struct peer *p)
{
    const struct scene *s = p->scene;
    const size_t n = 2 * s->n;
    double most = 0.0;
    need(tribo_step_force(s->ctx, 1.0, s->pull[0], p->scene->f), tribo_message(s->ctx));
    p->failed |= tresca_solve(p->tresca, s->pull[0], p->f) != 0;
    for (size_t i = 0; i < n; i++) {
        double sum = 0.0;
        for (size_t k = 0; k < n; k++) {
            sum += s->r[i * n + k] * (s->f[k] - p->f[k]);
        }
        most = fmax(most, fabs(sum));
    }
    return most;
}

/* Times of solver by solver in those of tribo, both from their last solutions. */
static void print_peers(struct scene *s, const struct effort *effort)
{
    printf("| %s | %zu |", s->name, s->n);
    for (size_t k = 0; tresca_name(k); k++) {
        if (k == 2 && (strcmp(s->name, "redundant") == 0 || s->n > 100)) {
            printf(" |"); /* Newton's matrix is singular, which it prints; or takes minutes */
            continue;
        }
        struct peer p = {.scene = s, .tresca = tresca_create(k, s->n, s->r, ENOUGH)};
        if (!p.tresca) {
            die("out of memory for Siconos");
        }
        const double apart = peer_difference(&p);
        struct job mine = {step, s, 0.0}, theirs = {peer_step, &p, 0.0};
        for (int twice = 0; twice < 2; twice++) {
            probe_job(&mine);
            probe_job(&theirs);
        }
        const struct timing t = time_job(&theirs, &mine, effort);
        printf(" %.3g us, %.2g%s, %.0e |", 1e6 * t.seconds, t.ratio, p.failed ? " (no convergence)" : "", apart);
        tresca_destroy(p.tresca);
    }
    printf("\n");
    fflush(stdout);
}

static void print_peer_head(void)
{
    printf("\n| coupling | contacts |");
    for (size_t k = 0; tresca_name(k); k++) {
        printf(" %s |", tresca_name(k));
    }
    printf("\n|---|---|---|---|---|\n");
}

#else

static void print_peers(struct scene *s, const struct effort *effort)
{
    (void)s;
    (void)effort;
}

static void print_peer_head(void)
{
}

#endif

static size_t sliding(struct scene *s)
{
    signed char slip[2 * MOST];
    size_t count = 0;
    need(tribo_get_slip(s->ctx, slip), tribo_message(s->ctx));
    for (size_t i = 0; i < s->n; i++) {
        count += slip[2 * i] == 3;
    }
    return count;
}

static void print_row(struct scene *s, const struct effort *effort)
{
    const double apart[] = {difference(s), difference(s)};
    const size_t slides = sliding(s), sweeps = s->sweeps;
    struct job job[] = {{gauss_seidel, s, 0.0}, {step, s, 0.0}, {rest, s, 0.0}, {band, s, 0.0}};
    for (size_t k = 0; k < 4; k++) {
        probe_job(&job[k]);
        probe_job(&job[k]);
    }
    printf("| %s | %zu | %zu | %zu | %.1e |", s->name, s->n, slides, sweeps, fmax(apart[0], apart[1]));
    for (size_t k = 1; k < 4; k++) {
        const struct timing t = time_job(&job[k], &job[0], effort);
        printf(" %.3g us, %.2g |", 1e6 * t.seconds, t.ratio);
    }
    printf("\n");
    fflush(stdout);
}

/* -------------------------------------------------------------------------------------------------------- many contacts */

enum { NEAR_LOADS, FAR_LOADS, LOADS };

/* Contacts in a row, or on a carpet, planar or scalar, limit 1. Calls take loads in turn: two that differ by 1%, or two of
 * which each pushes the contacts as the other does their neighbours. */
struct field {
    size_t n, *rowptr, *col; /* directions, and R */
    double *val, *pull[LOADS][2], *v, *f;
    tribo_context *ctx;
    size_t calls;
    int loads;
};

static void field_couple(struct field *s, size_t width, size_t wide)
{
    for (size_t i = 0; i < s->n; i++) {
        const size_t k = i / wide, contacts = s->n / wide, apart[4] = {width, 1, 1, width};
        const int has[4] = {k >= width, k % width > 0, k % width + 1 < width && k + 1 < contacts, k + width < contacts};
        size_t end = s->rowptr[i];
        for (size_t side = 0; side < 5; side++) {
            if (side == 2) {
                s->col[end] = i;
                s->val[end++] = width < contacts ? 4.5 : 2.0;
            }
            if (side < 4 && has[side]) {
                s->col[end] = side < 2 ? i - wide * apart[side] : i + wide * apart[side];
                s->val[end++] = -1.0;
            }
        }
        s->rowptr[i + 1] = end;
    }
}

static struct field field_create(size_t contacts, size_t width, size_t wide)
{
    struct field s = {.n = wide * contacts};
    size_t *first = calloc(contacts, sizeof *first);
    unsigned state = 7;
    s.rowptr = calloc(6 * s.n + 1, sizeof *s.rowptr);
    s.col = s.rowptr + s.n + 1;
    s.val = calloc(11 * s.n, sizeof *s.val);
    s.v = s.val + 5 * s.n;
    s.f = s.v + s.n;
    field_couple(&s, width, wide);
    for (size_t k = 0; k < LOADS * 2; k++) {
        s.pull[k / 2][k % 2] = s.f + s.n * (k + 1);
    }
    for (size_t i = 0; i < s.n; i++) {
        first[i / wide] = i - i % wide;
        s.v[i] = 0.4 * uniform(&state);
        for (size_t k = 0; k < LOADS * 2; k++) {
            const size_t contact = i / wide + (k == 3);
            const double size = 0.5 + 0.4 * (double)(contact % 3), angle = (double)contact;
            const double needed = size * (wide == 1 ? (contact % 2 ? -1.0 : 1.0) : i % 2 ? cos(angle) : sin(angle));
            for (size_t e = s.rowptr[i]; e < s.rowptr[i + 1]; e++) {
                s.pull[k / 2][k % 2][s.col[e]] += s.val[e] * needed * (k == 1 ? 1.0 + 0.01 * s.v[i] / 0.4 : 1.0);
            }
        }
    }
    need(tribo_create(&s.ctx, s.n), NULL);
    need(tribo_set_planar(s.ctx, wide == 2 ? contacts : 0, first), tribo_message(s.ctx));
    need(tribo_set_limit_all(s.ctx, 1.0), tribo_message(s.ctx));
    need(tribo_set_epsilon_all(s.ctx, 1.0), tribo_message(s.ctx));
    need(tribo_set_operator_csr(s.ctx, s.rowptr, s.col, s.val), tribo_message(s.ctx));
    free(first);
    return s;
}

static void field_destroy(struct field *s)
{
    tribo_destroy(s->ctx);
    free(s->rowptr);
    free(s->val);
}

static void field_step(void *data)
{
    struct field *s = data;
    need(tribo_step_force(s->ctx, 1.0, s->pull[s->loads][s->calls++ % 2], s->f), tribo_message(s->ctx));
}

static void field_band(void *data)
{
    struct field *s = data;
    need(tribo_balance(s->ctx, s->v, s->pull[s->loads][s->calls++ % 2], NULL, s->f), tribo_message(s->ctx));
}

static void print_field(const char *name, size_t contacts, size_t width, const struct effort *effort)
{
    struct field planar = field_create(contacts, width, 2), scalar = field_create(contacts, width, 1);
    printf("| %s | %zu |", name, contacts);
    for (int k = 0; k < 2 * LOADS; k++) {
        struct job mine = {k % 2 ? field_band : field_step, &planar, 0.0}, unit = {mine.run, &scalar, 0.0};
        planar.loads = scalar.loads = k / 2;
        for (int twice = 0; twice < 2; twice++) {
            probe_job(&mine);
            probe_job(&unit);
        }
        const struct timing t = time_job(&mine, &unit, effort);
        printf(" %.3g ms, %.2g |", 1e3 * t.seconds, t.ratio);
    }
    printf("\n");
    fflush(stdout);
    field_destroy(&planar);
    field_destroy(&scalar);
}

static void print_fields(const struct effort *effort)
{
    printf("\n| coupling | contacts | step, 1%% | balance in the band, 1%% | step, another load | balance in the band, another "
           "load |\n"
           "|---|---|---|---|---|---|\n");
    for (size_t n = 1000; n <= 100000; n *= 10) {
        print_field("row", n, n, effort);
    }
    print_field("carpet", 1000, 32, effort);
    print_field("carpet", 10000, 100, effort);
}

int main(int argc, char **argv)
{
    static const char *const name[] = {"row", "dense", "redundant"};
    const int smoke = argc > 1 && strcmp(argv[1], "--smoke") == 0;
    const struct effort effort = {5, 41, 1.0};
    int good = 1;
    if (!smoke) {
        printf("| coupling | contacts | of these slide | sweeps | difference | step | balance, at rest | balance, in the band |\n"
               "|---|---|---|---|---|---|---|---|\n");
    }
    for (size_t k = 0; k < sizeof name / sizeof *name; k++) {
        for (size_t n = 1; n <= (smoke ? 10u : k == 0 ? MOST : 100u); n *= 10) {
            struct scene s = scene_create(name[k], n);
            if (smoke) {
                const double apart = difference(&s);
                printf("%s of %zu: %.2g apart, %zu slide, %zu sweeps\n", name[k], n, apart, sliding(&s), s.sweeps);
                good = good && apart < 1e-8;
            } else {
                print_row(&s, &effort);
            }
            scene_destroy(&s);
        }
    }
    if (!smoke) {
        print_peer_head();
    }
    for (size_t k = 0; !smoke && k < sizeof name / sizeof *name; k++) {
        for (size_t n = 1; n <= (k == 0 ? MOST : 100u); n *= 10) {
            struct scene s = scene_create(name[k], n);
            print_peers(&s, &effort);
            scene_destroy(&s);
        }
    }
    if (!smoke) {
        print_fields(&effort);
    }
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
