/* SPDX-License-Identifier: BSD-3-Clause */
#include "support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STAIN 0xA5

/* Long enough for a slow machine under valgrind; a test that hangs ends all the same. */
#define SECONDS 600.0

int run_suite(const char *name, const struct test *tests, size_t count)
{
    Suite *suite = suite_create(name);
    TCase *tcase = tcase_create(name);
    tcase_set_timeout(tcase, SECONDS);
    suite_add_tcase(suite, tcase);
    for (size_t i = 0; i < count; i++) {
        tcase_add_loop_test(tcase, tests[i].test, 0, tests[i].times);
    }
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int run = srunner_ntests_run(runner), failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return run > 0 && failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

const char *difference(const char *what, double got, double want, double tolerance)
{
    static char text[300];
    if (got == want || fabs(got - want) <= tolerance) {
        return NULL;
    }
    snprintf(text, sizeof text, "%s = %.17g, not %.17g: off by %.3g, more than %.3g", what, got, want, got - want, tolerance);
    return text;
}

const char *differences(const char *what, const double *got, const double *want, size_t n, double tolerance)
{
    size_t i = 0;
    while (i < n && !difference(what, got[i], want[i], tolerance)) {
        i++;
    }
    char name[200];
    snprintf(name, sizeof name, "[%zu] of %s", i, what);
    return i < n ? difference(name, got[i], want[i], tolerance) : NULL;
}

int says(const char *text, const char *part)
{
    return text && strstr(text, part);
}

void stain(void *memory, size_t bytes)
{
    memset(memory, STAIN, bytes);
}

int stained(const void *memory, size_t bytes)
{
    const unsigned char *byte = memory;
    size_t i = 0;
    while (i < bytes && byte[i] == STAIN) {
        i++;
    }
    return i == bytes;
}

int setting(const char *name, int otherwise)
{
    const char *text = getenv(name);
    return text ? atoi(text) : otherwise;
}

int more(void)
{
    return setting("TRIBO_MORE", 0);
}

struct random random_of(int seed)
{
    return (struct random){(uint64_t)seed * 0x632BE59BD9B4E019u + 1u};
}

static uint64_t next(struct random *r)
{
    uint64_t z = r->state += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

double uniform(struct random *r, double lo, double hi)
{
    return lo + (hi - lo) * (double)(next(r) >> 11) * 0x1p-53;
}

double log_uniform(struct random *r, double decades)
{
    return pow(10.0, uniform(r, -decades, decades));
}

size_t below(struct random *r, size_t n)
{
    return (size_t)(next(r) % n);
}
