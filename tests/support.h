/* SPDX-License-Identifier: BSD-3-Clause */
/* What the test suites share: the one comparison of floating-point numbers, random numbers, and main. */
#ifndef TRIBO_TESTS_SUPPORT_H
#define TRIBO_TESTS_SUPPORT_H

#include <check.h>
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "tribo/tribo.h"

#define PI 3.14159265358979323846
#define COUNT(array) (sizeof(array) / sizeof *(array))

/* A test of a suite; in one that runs several times, _i counts from 0, and seeds random numbers. */
#define TEST(name) START_TEST(name)

struct test {
    const TTest *test;
    int times;
};

/* main of a suite: TEST_MAIN("laws", {registry, 1}, {values, 6}) */
#define TEST_MAIN(name, ...)                                                                                                     \
    int main(void)                                                                                                               \
    {                                                                                                                            \
        const struct test tests[] = {__VA_ARGS__};                                                                               \
        return run_suite(name, tests, COUNT(tests));                                                                             \
    }
int run_suite(const char *name, const struct test *tests, size_t count);

/* As ck_assert_msg, but silent where it holds: Check writes a mark to a pipe at each assertion, which inner loops feel. */
#define require(holds, ...)                                                                                                      \
    do {                                                                                                                         \
        if (!(holds)) {                                                                                                          \
            ck_abort_msg(__VA_ARGS__);                                                                                           \
        }                                                                                                                        \
    } while (0)

/* NULL if |got - want| <= tolerance (a NaN never is, an infinity only to itself), else a text that says so. */
const char *difference(const char *what, double got, double want, double tolerance);
#define assert_close(got, want, tolerance)                                                                                       \
    do {                                                                                                                         \
        const char *off_ = difference(#got, got, want, tolerance);                                                               \
        require(!off_, "%s", off_);                                                                                              \
    } while (0)
#define assert_exact(got, want) assert_close(got, want, 0.0)

/* The same for n values. */
const char *differences(const char *what, const double *got, const double *want, size_t n, double tolerance);
#define assert_all_close(got, want, n, tolerance)                                                                                \
    do {                                                                                                                         \
        const char *off_ = differences(#got, got, want, n, tolerance);                                                           \
        require(!off_, "%s", off_);                                                                                              \
    } while (0)
#define assert_all_exact(got, want, n) assert_all_close(got, want, n, 0.0)

#define assert_status(call, want)                                                                                                \
    do {                                                                                                                         \
        const int got_ = (call);                                                                                                 \
        require(got_ == (want), "%s: %d (%s), not %d", #call, got_, tribo_strerror(got_), want);                                 \
    } while (0)
#define assert_ok(call) assert_status(call, TRIBO_OK)

/* Whether text holds part; for messages. */
#define assert_says(text, part)                                                                                                  \
    do {                                                                                                                         \
        const char *text_ = (text);                                                                                              \
        require(says(text_, part), "\"%s\" does not say \"%s\"", text_, part);                                                   \
    } while (0)
int says(const char *text, const char *part);

/* Memory that must not be written to: stained, then found as it was. */
void stain(void *memory, size_t bytes);
int stained(const void *memory, size_t bytes);

/* The number in an environment variable, or another if it is not set. */
int setting(const char *name, int otherwise);

/* TRIBO_MORE is set: the suite takes its long cases, too. */
int more(void);

/* splitmix64 (Steele, Lea and Flood 2014): the same numbers on every machine. */
struct random {
    uint64_t state;
};
struct random random_of(int seed);
double uniform(struct random *r, double lo, double hi);
double log_uniform(struct random *r, double decades); /* 10^-decades to 10^decades */
size_t below(struct random *r, size_t n);

static inline double sgn(double x)
{
    return (double)((x > 0.0) - (x < 0.0));
}

static inline double clamped(double x, double limit)
{
    return fmin(fmax(x, -limit), limit);
}

#endif
