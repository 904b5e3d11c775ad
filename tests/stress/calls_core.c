/* SPDX-License-Identifier: BSD-3-Clause */
/* Sequences of calls of tribo.h, legal and illegal ones, on up to three contexts, as a string of bytes tells. After each call:
 * the status is the one that its arguments ask for, outputs are untouched on error and settings as they were, forces are finite
 * and within their limits, and solve the problem that was asked.
 *
 * As a program of its own: test_stress_calls_core [-n <strings>] [-s <seed>] [<file>...] runs the strings in the files, and so
 * many random ones. As a target of libFuzzer: ../fuzz. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "calls_core.h"

char current[80];

/* ------------------------------------------------------------------------------------------------------------- the string */

unsigned take(struct string *s)
{
    return s->at < s->size ? s->byte[s->at++] : 0;
}

double number(struct string *s, int *wild)
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

int fault(const double *x, size_t n, int sign)
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

void numbers(struct string *s, double *x, size_t n, int sign, int *wild)
{
    const int good = take(s) % 8 != 0;
    for (size_t i = 0; i < n; i++) {
        x[i] = i < 12 ? number(s, wild) : x[i % 12];
        x[i] = good && sign != FINITE && isfinite(x[i]) ? fabs(x[i]) : x[i];
        x[i] = good && sign == POSITIVE && x[i] == 0.0 ? 1.0 : x[i];
    }
}

/* --------------------------------------------------------------------------------------------------------------- contexts */

int check(const struct slot *s, const char *call, int got, int want)
{
    require(got == want, "%s: %d (%s), not %d", call, got, s->c ? tribo_message(s->c) : "", want);
    const int kept = strcmp(call, "force") != 0 && strcmp(call, "count") != 0 && strcmp(call, "real") != 0;
    require(!got || !s->c || !kept || *tribo_message(s->c), "%s: %d without a message", call, got);
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
    require(number == (s->own ? TRIBO_USER_LAW : s->law), "law %d", number);
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

static void queries(struct slot *s, struct string *in)
{
    const int which = (int)take(in) - 2;
    size_t count;
    double real;
    check(s, "count", tribo_get_count(s->c, which, &count),
          which >= 0 && which <= TRIBO_COUNT_VALUES ? TRIBO_OK : TRIBO_ERR_RANGE);
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
        } else if (call >= 240) {
            elements(&in);
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
