/* SPDX-License-Identifier: BSD-3-Clause */
/* What calls_core.c asks for: forces, which must be within their limits and solve the problem that was asked. */
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "calls_core.h"

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
        require(mode[i] == want || s->law == TRIBO_SMOOTH || s->own, "mode %d, f %g of %g", mode[i], f[i], s->limit[i]);
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

/* Exceptions that a call on ordinary numbers must not raise; a law of the caller may. */
static void check_exceptions(const struct slot *s, int wild)
{
    const int raised = fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    require(wild || s->own || !raised, "exceptions %d", raised);
}

int missing(const struct slot *s)
{
    return s->n && !s->operator? TRIBO_ERR_STATE : TRIBO_OK;
}

void balance(struct slot *s, struct string *in)
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
    check_exceptions(s, wild);
    require(!status || (status == TRIBO_ERR_INCONSISTENT && s->coupling == TRIBO_PARTITION) ||
                (wild && status == TRIBO_ERR_NO_CONVERGENCE) || (wild && s->own && status == TRIBO_ERR_CALLBACK),
            "%d %s", status, tribo_message(s->c));
    require(tribo_balance(twin, v, a, NULL, again) == status, "a copy answers something else");
    tribo_destroy(twin);
    s->linear = 0;
    if (status == TRIBO_ERR_NO_CONVERGENCE || status == TRIBO_ERR_CALLBACK) {
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

void step(struct slot *s, struct string *in)
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
    check_exceptions(s, wild);
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

void box(struct slot *s, struct string *in)
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
    check_exceptions(s, wild);
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
void tangents(struct slot *s, struct string *in)
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
    check_exceptions(s, wild);
    s->linear = !status;
    if (status) {
        require((status == TRIBO_ERR_INCONSISTENT && s->coupling == TRIBO_PARTITION) || wild, "%d %s", status,
                tribo_message(s->c));
        return;
    }
    require(tribo_tangent_product(s->c, x[0], x[1], df) == TRIBO_OK, "product");
    check_exceptions(s, wild);
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
    require(tribo_limit_product(s->c, x[0], df) == TRIBO_OK, "limit product");
    check_exceptions(s, wild);
    check_finite(df, n, "df of limits");
}

void law(struct slot *s, struct string *in)
{
    static double f[MOST], d[3][MOST];
    double v[MOST], feq[MOST], epsilon[MOST];
    int wild = s->wild_limit | s->wild_epsilon | s->wild_operator;
    numbers(in, v, s->n, FINITE, &wild);
    numbers(in, feq, s->n, FINITE, &wild);
    if (wild && s->own) {
        return; /* the caller's law overflows */
    }
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
    check_exceptions(s, wild);
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
    check_exceptions(s, wild);
    if (take(in) % 2) {
        check(s, "accept", tribo_accept(s->c, v, feq), TRIBO_OK);
        s->linear = s->linear && s->law != TRIBO_QUINN_REVERSAL;
    }
}
