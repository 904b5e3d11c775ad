/* Sequences of calls of tribo.h, legal and illegal ones, on up to three contexts, as a string of bytes tells. After each call:
 * the status is the one that its arguments ask for, outputs are untouched on error and settings as they were, forces are finite
 * and within their limits, and solve the problem that was asked.
 *
 * As a program of its own: calls_core [-n <strings>] [-s <seed>] [<file>...] runs the strings in the files, and so many random
 * ones. With libFuzzer, in the root of the tree: clang -g -O1 -fsanitize=fuzzer,address,undefined -DTRIBO_FUZZER -Iinclude
 * tests/stress/calls_core.c $(find src/common src/core -name '*.c') -lm
 *   ./a.out /tmp/new tests/stress/corpus
 * New strings go to the first folder. */
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tribo/tribo.h"

static char current[80]; /* file or seed */

enum { SLOTS = 3, MOST = 200, BODIES = 4, STAIN = 0xA5 };

#define require(holds, ...)                                                                                                      \
    do {                                                                                                                         \
        if (!(holds)) {                                                                                                          \
            fprintf(stderr, "%s:%d: %s: %s: ", __FILE__, __LINE__, current, #holds);                                             \
            fprintf(stderr, __VA_ARGS__);                                                                                        \
            fputc('\n', stderr);                                                                                                 \
            abort();                                                                                                             \
        }                                                                                                                        \
    } while (0)

/* ------------------------------------------------------------------------------------------------------------- the string */

struct string {
    const uint8_t *byte;
    size_t size, at;
};

static unsigned take(struct string *s)
{
    return s->at < s->size ? s->byte[s->at++] : 0;
}

/* A number, mostly an ordinary one: then wild is left alone. */
static double number(struct string *s, int *wild)
{
    static const double ordinary[] = {0.0, 0.0, 1.0, -1.0, 0.5, -0.25, 2.0, -3.0, 1e-3, -1e-3, 1e-6, 100.0, -100.0, 1e3};
    static const double odd[] = {4.9406564584124654e-324, 1e-300, -1e-300, 1e-12, 1e12, -1e300, 1e300, DBL_MAX, -DBL_MAX};
    const unsigned kind = take(s);
    if (kind < 128) {
        return ordinary[kind % (sizeof ordinary / sizeof *ordinary)];
    }
    if (kind < 244) {
        const int high = (int)take(s), low = (int)take(s);
        return (256 * high + low - 32768) / 8192.0;
    }
    *wild = 1;
    return kind < 253 ? odd[kind - 244] : kind == 253 ? (double)NAN : kind == 254 ? HUGE_VAL : -HUGE_VAL;
}

/* What a call may not do with values: 0, or the status that they ask for. */
enum { FINITE, NONNEGATIVE, POSITIVE };

static int fault(const double *x, size_t n, int sign)
{
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(x[i])) {
            return TRIBO_ERR_NOT_FINITE;
        }
    }
    for (size_t i = 0; i < n; i++) {
        if (sign == NONNEGATIVE && x[i] < 0.0) {
            return TRIBO_ERR_NEGATIVE;
        }
        if (sign == POSITIVE && x[i] <= 0.0) {
            return TRIBO_ERR_NOT_POSITIVE;
        }
    }
    return TRIBO_OK;
}

/* n values; most of the time of the sign that is asked for. */
static void numbers(struct string *s, double *x, size_t n, int sign, int *wild)
{
    const int good = take(s) % 8 != 0;
    for (size_t i = 0; i < n; i++) {
        x[i] = i < 12 ? number(s, wild) : x[i % 12];
        x[i] = good && sign != FINITE && isfinite(x[i]) ? fabs(x[i]) : x[i];
        x[i] = good && sign == POSITIVE && x[i] == 0.0 ? 1.0 : x[i];
    }
}

/* --------------------------------------------------------------------------------------------------------------- contexts */

/* A context, and what it should hold. */
struct slot {
    tribo_context *c;
    size_t n;
    int law, coupling, sharing, operator, follows, wild_limit, wild_epsilon, wild_operator, linear;
    double limit[MOST], epsilon[MOST], *r;
};

static int check(const struct slot *s, const char *call, int got, int want)
{
    require(got == want, "%s: %d (%s), not %d", call, got, s->c ? tribo_message(s->c) : "", want);
    require(!got || !s->c || *tribo_message(s->c), "%s: %d without a message", call, got);
    return got;
}

static void check_settings(const struct slot *s)
{
    double x[MOST];
    int number;
    size_t n;
    tribo_get_ncontact(s->c, &n);
    require(n == s->n, "%zu contacts", n);
    tribo_get_law(s->c, &number);
    require(number == s->law, "law %d", number);
    tribo_get_coupling(s->c, &number);
    require(number == s->coupling, "coupling %d", number);
    tribo_get_sharing(s->c, &number);
    require(number == s->sharing, "sharing %d", number);
    tribo_get_limit(s->c, x);
    require(!s->n || !memcmp(x, s->limit, s->n * sizeof *x), "limits are others");
    const int status = tribo_get_epsilon(s->c, x);
    require(status == (s->follows && !s->operator&& s->n ? TRIBO_ERR_STATE : TRIBO_OK), "epsilon: %d", status);
    require(status || s->follows || !s->n || !memcmp(x, s->epsilon, s->n * sizeof *x), "epsilons are others");
}

static void drop(struct slot *s)
{
    tribo_destroy(s->c);
    free(s->r);
    memset(s, 0, sizeof *s);
}

static void create(struct slot *s, struct string *in)
{
    static const size_t sizes[] = {0, 1, 2, 3, 4, 5, 7, 9, 12, 130, 150, 200};
    const unsigned byte = take(in);
    drop(s);
    if (byte == 255) {
        require(tribo_create(&s->c, SIZE_MAX) == TRIBO_ERR_SIZE && !s->c, "create");
        return;
    }
    s->n = sizes[byte % (sizeof sizes / sizeof *sizes)];
    s->r = calloc(s->n * s->n + 1, sizeof *s->r);
    require(tribo_create(&s->c, s->n) == TRIBO_OK && s->r, "create");
    s->law = TRIBO_QUINN;
    for (size_t i = 0; i < s->n; i++) {
        s->epsilon[i] = 1e-6;
    }
}

static void clone(struct slot *to, const struct slot *from)
{
    if (to == from || !from->c) {
        return;
    }
    drop(to);
    *to = *from;
    to->linear = 0;
    to->r = malloc((from->n * from->n + 1) * sizeof *to->r);
    require(tribo_clone(from->c, &to->c) == TRIBO_OK && to->r, "clone");
    memcpy(to->r, from->r, from->n * from->n * sizeof *to->r);
}

/* --------------------------------------------------------------------------------------------------------------- settings */

static void set_number(struct slot *s, struct string *in)
{
    const int which = (int)take(in) % 3, value = (int)take(in) - 2;
    int *const setting = which == 0 ? &s->law : which == 1 ? &s->coupling : &s->sharing;
    const int most = which == 0 ? 6 : 2, legal = value >= 0 && value < most;
    const int status = which == 0   ? tribo_set_law(s->c, value)
                       : which == 1 ? tribo_set_coupling(s->c, value)
                                    : tribo_set_sharing(s->c, value);
    if (!check(s, "set_number", status, legal ? TRIBO_OK : TRIBO_ERR_RANGE)) {
        *setting = value;
        s->linear = 0;
    }
}

static void set_limit(struct slot *s, struct string *in)
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

static void set_epsilon(struct slot *s, struct string *in)
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
static void set_operator(struct slot *s, struct string *in)
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
    const int status = form == 0   ? tribo_set_operator_diagonal(s->c, diagonal)
                       : form == 1 ? tribo_set_operator_dense(s->c, r)
                       : form == 2 ? tribo_set_operator_csr(s->c, first, col, val)
                       : form == 3 ? tribo_set_operator_mass(s->c, b.count, b.inverse, b.first, b.col, b.val)
                                   : tribo_set_operator_callback(s->c, b.count, accelerate, &m, b.first, b.col, b.val);
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

/* ----------------------------------------------------------------------------------------------------------------- forces */

/* What z'' = R f + a is, and how much of it may be rounding, in units of forces. */
static double balancing(const struct slot *s, const double *a, const double *f, size_t i, double *noise)
{
    long double sum = a[i], size = fabs(a[i]);
    const double *row = s->r + i * s->n;
    for (size_t j = 0; j < s->n; j++) {
        sum += (long double)row[j] * f[j];
        size += fabsl((long double)row[j] * f[j]);
    }
    *noise = (double)((double)(s->n + 4) * DBL_EPSILON * size / row[i]);
    return (double)(f[i] - sum / row[i]);
}

static void check_bounds(const struct slot *s, const double *f)
{
    for (size_t i = 0; i < s->n; i++) {
        require(fabs(f[i]) <= s->limit[i], "|%g| > %g, contact %zu of %zu", f[i], s->limit[i], i, s->n);
    }
}

static void check_finite(const double *x, size_t n, const char *what)
{
    for (size_t i = 0; i < n; i++) {
        require(isfinite(x[i]), "%s[%zu] = %g", what, i, x[i]);
    }
}

/* f is what the law makes of the f_eq that balances the others' forces, and feq is that f_eq. */
static void check_balance(const struct slot *s, const double *v, const double *a, const double *feq, const double *f)
{
    double epsilon[MOST], law, noise;
    tribo_get_epsilon(s->c, epsilon);
    for (size_t i = 0; i < s->n; i++) {
        if (!(s->limit[i] > 0.0)) {
            require(feq[i] == 0.0 && f[i] == 0.0, "an open contact: feq %g, f %g", feq[i], f[i]);
            continue;
        }
        tribo_law_eval(s->law, v[i], feq[i], s->limit[i], epsilon[i], &law, NULL, NULL, NULL);
        require(fabs(law - f[i]) <= 1e-14 * s->limit[i], "f %.17g, but the law says %.17g", f[i], law);
        if (s->coupling == TRIBO_CONSISTENT && s->r[i * s->n + i] > 0.0) {
            const double want = balancing(s, a, f, i, &noise);
            tribo_law_eval(s->law, v[i], want, s->limit[i], epsilon[i], &law, NULL, NULL, NULL);
            require(fabs(law - f[i]) <= 1e-11 * s->limit[i] + 4.0 * noise,
                    "contact %zu of %zu, f %.17g, but f_eq %.17g asks for %.17g", i, s->n, f[i], want, law);
            require(fabs(want - feq[i]) <= 1e-11 * (s->limit[i] + fabs(want)) + 8.0 * noise, "feq %.17g, not %.17g", feq[i],
                    want);
        }
    }
}

static void check_modes(const struct slot *s, const double *f)
{
    signed char mode[MOST];
    size_t stuck = 0, counted;
    require(tribo_get_slip(s->c, mode) == TRIBO_OK, "modes");
    for (size_t i = 0; i < s->n; i++) {
        const int slides = fabs(f[i]) == s->limit[i], want = s->limit[i] == 0.0 ? 2 : !slides ? 0 : f[i] < 0.0 ? 1 : -1;
        require(mode[i] == want || s->law == TRIBO_SMOOTH, "mode %d, f %g of %g", mode[i], f[i], s->limit[i]);
        stuck += mode[i] == 0;
    }
    tribo_get_count(s->c, TRIBO_COUNT_STUCK, &counted);
    require(counted == stuck, "%zu stuck, not %zu", counted, stuck);
}

static int stained(const void *memory, size_t bytes)
{
    const unsigned char *byte = memory;
    while (bytes && byte[bytes - 1] == STAIN) {
        bytes--;
    }
    return !bytes;
}

/* Exceptions that a call on ordinary numbers must not raise. */
static void check_exceptions(int wild)
{
    const int raised = fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    require(wild || !raised, "exceptions %d", raised);
}

static int missing(const struct slot *s)
{
    return s->n && !s->operator? TRIBO_ERR_STATE : TRIBO_OK;
}

static void balance(struct slot *s, struct string *in)
{
    static double f[MOST], feq[MOST], again[MOST];
    double v[MOST], a[MOST];
    int wild = s->wild_limit | s->wild_epsilon | s->wild_operator;
    numbers(in, v, s->n, FINITE, &wild);
    numbers(in, a, s->n, FINITE, &wild);
    for (size_t i = 0; take(in) % 2 && i < s->n; i++) {
        v[i] *= s->epsilon[i];
    }
    memset(f, STAIN, sizeof f);
    memset(feq, STAIN, sizeof feq);
    tribo_context *twin;
    require(tribo_clone(s->c, &twin) == TRIBO_OK, "clone");
    const int bad = missing(s) ? missing(s) : fault(v, s->n, FINITE) ? TRIBO_ERR_NOT_FINITE : fault(a, s->n, FINITE);
    feclearexcept(FE_ALL_EXCEPT);
    const int status = tribo_balance(s->c, v, a, feq, f);
    if (bad) {
        check(s, "balance", status, bad);
        require(stained(f, sizeof f) && stained(feq, sizeof feq), "outputs");
        tribo_destroy(twin);
        return;
    }
    check_exceptions(wild);
    require(!status || (status == TRIBO_ERR_INCONSISTENT && s->coupling == TRIBO_PARTITION) ||
                (wild && status == TRIBO_ERR_NO_CONVERGENCE),
            "%d %s", status, tribo_message(s->c));
    require(tribo_balance(twin, v, a, NULL, again) == status, "a copy answers something else");
    tribo_destroy(twin);
    s->linear = 0;
    if (status == TRIBO_ERR_NO_CONVERGENCE) {
        return;
    }
    require(!memcmp(again, f, s->n * sizeof *f), "a copy finds other forces");
    check_bounds(s, f);
    check_finite(feq, s->n, "feq");
    check_modes(s, f);
    if (!wild && !status && s->law != TRIBO_QUINN_REVERSAL) {
        double residual;
        check_balance(s, v, a, feq, f);
        tribo_get_real(s->c, TRIBO_REAL_RESIDUAL, &residual);
        require(s->coupling == TRIBO_PARTITION || residual < 1e-6, "residual %g", residual);
    }
}

static void step(struct slot *s, struct string *in)
{
    static double f[MOST];
    double v[MOST], dt, a[MOST], noise;
    int wild = s->wild_limit | s->wild_operator;
    numbers(in, &dt, 1, POSITIVE, &wild);
    numbers(in, v, s->n, FINITE, &wild);
    memset(f, STAIN, sizeof f);
    const int bad_dt = fault(&dt, 1, POSITIVE), bad = bad_dt ? bad_dt : missing(s) ? missing(s) : fault(v, s->n, FINITE);
    feclearexcept(FE_ALL_EXCEPT);
    const int status = tribo_step_force(s->c, dt, v, f);
    if (bad) {
        check(s, "step_force", status, bad);
        require(stained(f, sizeof f), "outputs");
        return;
    }
    check_exceptions(wild);
    s->linear = 0;
    require(!status || (wild && status == TRIBO_ERR_NO_CONVERGENCE), "%d %s", status, tribo_message(s->c));
    if (status) {
        return;
    }
    check_bounds(s, f);
    for (size_t i = 0; i < s->n; i++) {
        a[i] = v[i] / dt;
    }
    for (size_t i = 0; i < s->n && !wild; i++) {
        if (s->r[i * s->n + i] > 0.0) {
            const double want = balancing(s, a, f, i, &noise), held = fmin(fmax(want, -s->limit[i]), s->limit[i]);
            require(fabs(held - f[i]) <= 1e-11 * s->limit[i] + 4.0 * noise, "f %.17g, not %.17g", f[i], held);
        }
    }
}

static void box(struct slot *s, struct string *in)
{
    static double f[MOST];
    double a[MOST], lower[MOST], upper[MOST], noise;
    int wild = s->wild_operator, crossed = 0;
    numbers(in, a, s->n, FINITE, &wild);
    numbers(in, lower, s->n, FINITE, &wild);
    numbers(in, upper, s->n, FINITE, &wild);
    for (size_t i = 0; take(in) % 4 && i < s->n; i++) {
        const double x = lower[i];
        lower[i] = upper[i] < x ? upper[i] : x;
        upper[i] = upper[i] < x ? x : upper[i];
    }
    for (size_t i = 0; i < s->n; i++) {
        crossed |= lower[i] > upper[i];
    }
    memset(f, STAIN, sizeof f);
    const int faults[] = {missing(s), fault(a, s->n, FINITE), fault(lower, s->n, FINITE), fault(upper, s->n, FINITE),
                          crossed ? TRIBO_ERR_RANGE : TRIBO_OK};
    int bad = TRIBO_OK;
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) {
        bad = bad ? bad : faults[k];
    }
    feclearexcept(FE_ALL_EXCEPT);
    const int status = tribo_solve_box(s->c, a, lower, upper, f);
    if (bad) {
        check(s, "solve_box", status, bad);
        require(stained(f, sizeof f), "outputs");
        return;
    }
    check_exceptions(wild);
    s->linear = 0;
    require(!status || (wild && status == TRIBO_ERR_NO_CONVERGENCE), "%d %s", status, tribo_message(s->c));
    for (size_t i = 0; i < s->n && !status; i++) {
        require(lower[i] <= f[i] && f[i] <= upper[i], "f %g out of %g to %g", f[i], lower[i], upper[i]);
        if (!wild && s->r[i * s->n + i] > 0.0) {
            const double want = balancing(s, a, f, i, &noise), held = fmin(fmax(want, lower[i]), upper[i]);
            require(fabs(held - f[i]) <= 1e-11 * (fabs(lower[i]) + fabs(upper[i])) + 4.0 * noise, "f %.17g, not %.17g", f[i],
                    held);
        }
    }
}

/* The product of the tangents with a vector is that of their matrices. */
static void tangents(struct slot *s, struct string *in)
{
    static double dv[MOST * MOST], da[MOST * MOST], f[MOST], df[MOST];
    double v[MOST], a[MOST], x[2][MOST];
    int wild = s->wild_limit | s->wild_epsilon | s->wild_operator;
    const size_t n = s->n;
    numbers(in, v, n, FINITE, &wild);
    numbers(in, a, n, FINITE, &wild);
    numbers(in, x[0], n, FINITE, &wild);
    numbers(in, x[1], n, FINITE, &wild);
    if (n > 20 || fault(v, n, FINITE) || fault(a, n, FINITE) || fault(x[0], n, FINITE) || fault(x[1], n, FINITE) || missing(s)) {
        memset(df, STAIN, sizeof df);
        if (!s->linear && n) {
            require(tribo_tangent_product(s->c, NULL, NULL, df) == TRIBO_ERR_STATE && stained(df, sizeof df), "product");
        }
        return;
    }
    feclearexcept(FE_ALL_EXCEPT);
    const int status = tribo_balance_tangent(s->c, v, a, NULL, f, dv, da);
    check_exceptions(wild);
    s->linear = !status;
    if (status) {
        require((status == TRIBO_ERR_INCONSISTENT && s->coupling == TRIBO_PARTITION) || wild, "%d %s", status,
                tribo_message(s->c));
        return;
    }
    require(tribo_tangent_product(s->c, x[0], x[1], df) == TRIBO_OK, "product");
    check_exceptions(wild);
    check_finite(dv, n * n, "df_dv");
    check_finite(da, n * n, "df_da");
    check_finite(df, n, "df");
    for (size_t i = 0; i < n && !wild; i++) {
        double sum = 0.0, size = 1e-3;
        for (size_t j = 0; j < n; j++) {
            sum += dv[i * n + j] * x[0][j] + da[i * n + j] * x[1][j];
            size += fabs(dv[i * n + j] * x[0][j]) + fabs(da[i * n + j] * x[1][j]);
        }
        require(fabs(sum - df[i]) <= 1e-6 * size, "df %.17g, not %.17g", df[i], sum);
    }
}

static void law(struct slot *s, struct string *in)
{
    static double f[MOST], d[3][MOST];
    double v[MOST], feq[MOST], epsilon[MOST];
    int wild = s->wild_limit | s->wild_epsilon | s->wild_operator;
    numbers(in, v, s->n, FINITE, &wild);
    numbers(in, feq, s->n, FINITE, &wild);
    int bad = s->follows ? missing(s) : TRIBO_OK;
    bad = bad ? bad : fault(v, s->n, FINITE);
    const int asks = s->law != TRIBO_SMOOTH && s->law != TRIBO_VELOCITY_LIMITED;
    if (!bad) {
        tribo_get_epsilon(s->c, epsilon);
        for (size_t i = 0; asks && i < s->n; i++) {
            bad = fabs(v[i]) <= (s->law == TRIBO_COULOMB ? 0.0 : epsilon[i]) && !isfinite(feq[i]) ? TRIBO_ERR_NOT_FINITE : bad;
        }
    }
    memset(f, STAIN, sizeof f);
    feclearexcept(FE_ALL_EXCEPT);
    if (check(s, "force", tribo_force_tangent(s->c, v, feq, f, d[0], d[1], d[2]), bad)) {
        require(stained(f, sizeof f), "outputs");
        return;
    }
    check_exceptions(wild);
    check_bounds(s, f);
    for (size_t k = 0; k < 3; k++) {
        check_finite(d[k], s->n, "derivatives");
    }
    for (size_t i = 0; i < s->n; i++) {
        for (int each = 0; each < tribo_law_count(); each++) {
            const int status = tribo_law_eval(each, v[i], feq[i], s->limit[i], epsilon[i], f, d[0], d[1], d[2]);
            require(status == TRIBO_OK || (status == TRIBO_ERR_NOT_FINITE && !isfinite(feq[i])), "law %d: %d", each, status);
            require(status || (fabs(*f) <= s->limit[i] && isfinite(*d[0] + *d[1] + *d[2])), "law %d: %g", each, *f);
        }
    }
    check_exceptions(wild);
    if (take(in) % 2) {
        check(s, "accept", tribo_accept(s->c, v, feq), TRIBO_OK);
        s->linear = s->linear && s->law != TRIBO_QUINN_REVERSAL;
    }
}

static void queries(struct slot *s, struct string *in)
{
    const int which = (int)take(in) - 2;
    size_t count;
    double real;
    check(s, "count", tribo_get_count(s->c, which, &count),
          which >= 0 && which <= TRIBO_COUNT_REUSED ? TRIBO_OK : TRIBO_ERR_RANGE);
    const int want = which < 0 || which > TRIBO_REAL_MAX_STEP ? TRIBO_ERR_RANGE
                     : which != TRIBO_REAL_RESIDUAL           ? missing(s)
                                                              : TRIBO_OK;
    if (!check(s, "real", tribo_get_real(s->c, which, &real), want)) {
        require(isfinite(real) || which == TRIBO_REAL_MAX_STEP, "real %d is %g", which, real);
    }
    require(tribo_set_limit(s->c, NULL) == (s->n ? TRIBO_ERR_NULL : TRIBO_OK), "NULL");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static void (*const calls[])(struct slot *, struct string *) = {
        set_number, set_limit, set_limit, set_epsilon, set_operator, balance, balance, step, box, tangents, law, queries};
    static struct slot slots[SLOTS];
    struct string in = {data, size, 0};
    while (in.at < in.size) {
        const unsigned call = take(&in), which = take(&in) % SLOTS;
        struct slot *s = &slots[which];
        if (!s->c || call % 32 == 0) {
            create(s, &in);
        } else if (call % 32 == 1) {
            clone(s, &slots[take(&in) % SLOTS]);
        } else {
            calls[call % (sizeof calls / sizeof *calls)](s, &in);
        }
        if (s->c) {
            check_settings(s);
        }
    }
    for (size_t k = 0; k < SLOTS; k++) {
        drop(&slots[k]);
    }
    return 0;
}

#if !defined(TRIBO_FUZZER)

static void run_file(const char *path)
{
    static uint8_t data[1 << 16];
    FILE *file = fopen(path, "rb");
    snprintf(current, sizeof current, "%s", path);
    require(file, "cannot be opened");
    const size_t size = fread(data, 1, sizeof data, file);
    fclose(file);
    LLVMFuzzerTestOneInput(data, size);
}

/* splitmix64 (Steele, Lea and Flood 2014) */
static void run_random(uint64_t seed)
{
    uint8_t data[600];
    const size_t size = 40 + (size_t)(seed % (sizeof data - 40));
    uint64_t state = seed * 0x632BE59BD9B4E019u + 1u;
    for (size_t i = 0; i < size; i++) {
        uint64_t z = state += 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        data[i] = (uint8_t)((z ^ (z >> 31)) >> 24);
    }
    LLVMFuzzerTestOneInput(data, size);
}

int main(int argc, char **argv)
{
    long strings = 0, seed = 0;
    int files = 0;
    for (int k = 1; k < argc; k++) {
        if (strcmp(argv[k], "-n") == 0 && k + 1 < argc) {
            strings = atol(argv[++k]);
        } else if (strcmp(argv[k], "-s") == 0 && k + 1 < argc) {
            seed = atol(argv[++k]);
        } else {
            run_file(argv[k]);
            files++;
        }
    }
    for (long k = 0; k < strings; k++) {
        snprintf(current, sizeof current, "seed %ld", seed + k);
        run_random((uint64_t)(seed + k));
    }
    printf("%d files, %ld random strings\n", files, strings);
    return files + strings > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

#endif
