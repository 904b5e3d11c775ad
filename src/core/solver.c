#include "solver.h"
#include "../real.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rounding of a sum of n terms of size 1 leaves about this; what is smaller counts as zero. */
static double resolution(size_t n)
{
    return 4.0 * (double)(n + 4) * DBL_EPSILON;
}

int tribo_solver_create(struct solver *s, size_t capacity)
{
    const size_t n = capacity + 1;
    memset(s, 0, sizeof *s);
    s->capacity = capacity;
    s->g = malloc(n * n * sizeof *s->g);
    s->factor = malloc(n * n * sizeof *s->factor);
    s->q = malloc(9 * n * sizeof *s->q);
    s->at = malloc(n * sizeof *s->at);
    s->set = malloc(n * sizeof *s->set);
    if (!s->g || !s->factor || !s->q || !s->at || !s->set) {
        tribo_solver_free(s);
        return 0;
    }
    s->lo = s->q + n;
    s->hi = s->q + 2 * n;
    s->x = s->q + 3 * n;
    s->gradient = s->q + 4 * n;
    s->noise = s->q + 5 * n;
    s->scale = s->q + 6 * n;
    s->step = s->q + 7 * n;
    s->rhs = s->q + 8 * n;
    return 1;
}

void tribo_solver_free(struct solver *s)
{
    free(s->g);
    free(s->factor);
    free(s->q);
    free(s->at);
    free(s->set);
    memset(s, 0, sizeof *s);
}

/* -------------------------------------------------------------------------------------------- the factorization */

/* Cholesky factorization with diagonal pivoting of the submatrix of G that set[0..size) names, scaled by powers of 2 to
 * a diagonal between 1/2 and 2. Orders set by pivots and finds the rank: the rows after it depend on the first ones. Row
 * k of factor then holds l_k0, l_k1, ... Returns the largest of the pivots left, which is rounding unless G is indefinite. */
static double factorize(struct solver *s, size_t n)
{
    const size_t m = s->size;
    double *l = s->factor;
    s->factorizations++;
    for (size_t i = 0; i < m; i++) {
        int e;
        frexp(s->g[s->set[i] * n + s->set[i]], &e);
        s->scale[i] = ldexp(1.0, -(e >= 0 ? e / 2 : -((1 - e) / 2)));
    }
    for (size_t i = 0; i < m; i++) {
        for (size_t j = 0; j <= i; j++) {
            l[i * m + j] = s->scale[i] * s->g[s->set[i] * n + s->set[j]] * s->scale[j];
        }
    }
    double left = 0.0;
    size_t k = 0;
    for (; k < m; k++) {
        size_t p = k;
        for (size_t i = k + 1; i < m; i++) {
            p = l[i * m + i] > l[p * m + p] ? i : p;
        }
        left = l[p * m + p];
        if (left <= resolution(m)) {
            break;
        }
        if (p != k) {
            /* symmetric exchange of rows and columns k and p in the lower triangle */
            const size_t set = s->set[k];
            const double scale = s->scale[k];
            s->set[k] = s->set[p];
            s->set[p] = set;
            s->scale[k] = s->scale[p];
            s->scale[p] = scale;
            for (size_t j = 0; j < m; j++) {
                double *a = j < k ? &l[k * m + j] : &l[j * m + k];
                double *b = j < p ? &l[p * m + j] : &l[j * m + p];
                if (j != k && j != p) {
                    const double x = *a;
                    *a = *b;
                    *b = x;
                }
            }
            const double x = l[k * m + k];
            l[k * m + k] = l[p * m + p];
            l[p * m + p] = x;
        }
        const double d = sqrt(l[k * m + k]);
        l[k * m + k] = d;
        for (size_t i = k + 1; i < m; i++) {
            l[i * m + k] /= d;
        }
        for (size_t i = k + 1; i < m; i++) {
            const double x = l[i * m + k];
            for (size_t j = k + 1; j <= i; j++) {
                l[i * m + j] -= x * l[j * m + k];
            }
        }
    }
    s->rank = k;
    return k < m ? left : 0.0;
}

/* y = L^-1 y and y = L^-T y, L being the factor of the independent rows. */
static void forward(const struct solver *s, double *y)
{
    for (size_t i = 0; i < s->rank; i++) {
        double sum = y[i];
        for (size_t j = 0; j < i; j++) {
            sum -= s->factor[i * s->size + j] * y[j];
        }
        y[i] = sum / s->factor[i * s->size + i];
    }
}

static void backward(const struct solver *s, double *y)
{
    for (size_t i = s->rank; i-- > 0;) {
        y[i] /= s->factor[i * s->size + i];
        for (size_t j = 0; j < i; j++) {
            y[j] -= s->factor[i * s->size + j] * y[i];
        }
    }
}

/* y = the null vector in which the d-th of the set's rows, a dependent one, moves by 1. */
static void null_vector(const struct solver *s, size_t d, double *y)
{
    for (size_t i = 0; i < s->size; i++) {
        y[i] = i < s->rank ? -s->factor[d * s->size + i] : 0.0;
    }
    backward(s, y);
    for (size_t i = 0; i < s->rank; i++) {
        y[i] *= s->scale[i] / s->scale[d];
    }
    y[d] = 1.0;
}

long tribo_solver_rank(struct solver *s, size_t n, size_t *where, double *value)
{
    s->size = n;
    for (size_t i = 0; i < n; i++) {
        s->set[i] = i;
    }
    factorize(s, n);
    for (size_t i = s->rank; i < n; i++) {
        for (size_t j = s->rank; j <= i; j++) {
            const double x = s->factor[i * n + j];
            if (fabs(x) > 16.0 * resolution(n)) {
                *where = s->set[i];
                *value = i == j ? x : -fabs(x);
                return -1;
            }
        }
    }
    return (long)s->rank;
}

/* ------------------------------------------------------------------------------------------------------- the box */

static void gradient(struct solver *s, size_t n)
{
    const double u = resolution(n);
    for (size_t i = 0; i < n; i++) {
        double sum = s->q[i], size = fabs(s->q[i]);
        for (size_t j = 0; j < n; j++) {
            const double x = s->g[i * n + j] * s->x[j];
            sum += x;
            size += fabs(x);
        }
        s->gradient[i] = sum;
        s->noise[i] = u * size;
    }
}

static void collect(struct solver *s, size_t n)
{
    s->size = 0;
    for (size_t i = 0; i < n; i++) {
        if (s->at[i] == 0) {
            s->set[s->size++] = i;
        }
    }
}

/* step = the move of the free x that takes their gradient to zero; dependent ones stay. */
static void newton(struct solver *s)
{
    for (size_t i = 0; i < s->rank; i++) {
        s->step[i] = -s->gradient[s->set[i]] * s->scale[i];
    }
    forward(s, s->step);
    backward(s, s->step);
    for (size_t i = 0; i < s->size; i++) {
        s->step[i] = i < s->rank ? s->step[i] * s->scale[i] : 0.0;
    }
}

static void put_at_bounds(struct solver *s, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        s->x[i] = s->at[i] < 0 ? s->lo[i] : s->at[i] > 0 ? s->hi[i] : s->x[i];
    }
}

/* Where x wants to be: one step of the primal-dual active set. Counts the changes. */
static size_t revise(struct solver *s, size_t n)
{
    size_t changes = 0;
    for (size_t i = 0; i < n; i++) {
        signed char to = s->at[i];
        if (to == 0) {
            to = s->x[i] < s->lo[i] ? -1 : s->x[i] > s->hi[i] ? 1 : 0;
        } else if (s->lo[i] < s->hi[i] && (double)to * s->gradient[i] > s->noise[i]) {
            to = 0;
        }
        changes += to != s->at[i];
        s->at[i] = to;
    }
    s->updates += changes;
    return changes;
}

/* Takes whole sets in and out of the bounds at once. Usually done in a few rounds, but it may cycle. */
static int primal_dual(struct solver *s, size_t n)
{
    for (int round = 0; round < 12; round++) {
        put_at_bounds(s, n);
        collect(s, n);
        factorize(s, n);
        if (s->rank < s->size) {
            return 0;
        }
        for (int refine = 0; refine < 2; refine++) {
            gradient(s, n);
            newton(s);
            for (size_t i = 0; i < s->size; i++) {
                s->x[s->set[i]] += s->step[i];
            }
        }
        gradient(s, n);
        if (revise(s, n) == 0) {
            return 1;
        }
    }
    return 0;
}

/* Moves x along step, at most the whole of it, or until the first bound, where that x stays. Returns 1 if it met one. */
static int move(struct solver *s, double longest)
{
    double length = longest;
    size_t hit = s->size;
    for (size_t i = 0; i < s->size; i++) {
        const size_t k = s->set[i];
        const double p = s->step[i];
        const double room = p > 0.0 ? (s->hi[k] - s->x[k]) / p : p < 0.0 ? (s->lo[k] - s->x[k]) / p : length;
        if (room < length) {
            length = greater(room, 0.0);
            hit = i;
        }
    }
    for (size_t i = 0; i < s->size; i++) {
        const size_t k = s->set[i];
        s->x[k] = lesser(greater(s->x[k] + length * s->step[i], s->lo[k]), s->hi[k]);
    }
    if (hit == s->size) {
        return 0;
    }
    const size_t k = s->set[hit];
    s->at[k] = s->step[hit] > 0.0 ? 1 : -1;
    s->x[k] = s->at[k] > 0 ? s->hi[k] : s->lo[k];
    s->updates++;
    return 1;
}

/* The index in the set of the dependent row whose gradient is farthest from zero, or size. */
static size_t worst_dependent(const struct solver *s)
{
    size_t worst = s->size;
    double most = 1.0;
    for (size_t i = s->rank; i < s->size; i++) {
        const size_t k = s->set[i];
        const double excess = fabs(s->gradient[k]) / greater(s->noise[k], DBL_MIN);
        if (excess > most) {
            most = excess;
            worst = i;
        }
    }
    return worst;
}

/* The x whose bound the gradient pulls it off hardest, or n. */
static size_t worst_bound(const struct solver *s, size_t n)
{
    size_t worst = n;
    double most = 1.0;
    for (size_t i = 0; i < n; i++) {
        const double excess = (double)s->at[i] * s->gradient[i] / greater(s->noise[i], DBL_MIN);
        if (s->lo[i] < s->hi[i] && excess > most) {
            most = excess;
            worst = i;
        }
    }
    return worst;
}

/* Primal active set: every round lowers the objective, or takes an x out of the set, so that no set comes back. */
static int active_set(struct solver *s, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        s->x[i] = lesser(greater(s->x[i], s->lo[i]), s->hi[i]);
        s->at[i] = s->x[i] <= s->lo[i] ? -1 : s->x[i] >= s->hi[i] ? 1 : 0;
    }
    for (size_t round = 0; round < 100 + 20 * n; round++) {
        collect(s, n);
        factorize(s, n);
        gradient(s, n);
        newton(s);
        if (move(s, 1.0)) {
            continue;
        }
        gradient(s, n);
        const size_t d = worst_dependent(s);
        if (d < s->size) {
            const double pull = s->gradient[s->set[d]];
            const double pivot = s->factor[d * s->size + d] / (s->scale[d] * s->scale[d]);
            null_vector(s, d, s->step);
            for (size_t i = 0; i < s->size; i++) {
                s->step[i] *= pull > 0.0 ? -1.0 : 1.0;
            }
            move(s, pivot > 0.0 ? fabs(pull) / pivot : HUGE_VAL);
            continue;
        }
        newton(s);
        if (move(s, 1.0)) {
            continue;
        }
        gradient(s, n);
        const size_t free = worst_bound(s, n);
        if (free == n) {
            return 1;
        }
        s->at[free] = 0;
        s->updates++;
    }
    return 0;
}

int tribo_solver_box(struct solver *s, size_t n)
{
    gradient(s, n);
    for (size_t i = 0; i < n; i++) {
        const double to = s->x[i] - s->gradient[i] / s->g[i * n + i];
        s->at[i] = to <= s->lo[i] ? -1 : to >= s->hi[i] ? 1 : 0;
    }
    return primal_dual(s, n) || active_set(s, n);
}

/* ------------------------------------------------------------------------------------------------ the linear system */

static double dot(const double *x, const double *y, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += x[i] * y[i];
    }
    return sum;
}

/* Takes the part of y in the null space (orthonormal rows of basis) out of it. */
static void project(const double *basis, size_t rows, size_t n, double *y)
{
    for (size_t r = 0; r < rows; r++) {
        const double part = dot(basis + r * n, y, n);
        for (size_t i = 0; i < n; i++) {
            y[i] -= part * basis[r * n + i];
        }
    }
}

void tribo_solver_prepare(struct solver *s, size_t n)
{
    memset(s->at, 0, n);
    collect(s, n);
    factorize(s, n);
    /* the basis of the null space takes the place of the dependent rows of the factor, in pivot order */
    double *basis = s->factor + s->rank * n;
    for (size_t d = s->rank; d < n; d++) {
        null_vector(s, d, s->step);
        memcpy(s->factor + d * n, s->step, n * sizeof *s->step);
    }
    for (size_t d = 0; d < n - s->rank; d++) {
        double *row = basis + d * n;
        project(basis, d, n, row);
        project(basis, d, n, row);
        const double length = sqrt(dot(row, row, n));
        for (size_t i = 0; i < n; i++) {
            row[i] /= length;
        }
    }
}

int tribo_solver_linear(struct solver *s, size_t n)
{
    const double *basis = s->factor + s->rank * n;
    memset(s->x, 0, n * sizeof *s->x);
    int consistent = 1;
    for (int refine = 0; refine < 3; refine++) {
        gradient(s, n);
        for (size_t i = 0; i < n; i++) {
            s->rhs[i] = s->gradient[s->set[i]];
        }
        project(basis, n - s->rank, n, s->rhs);
        double rounding = DBL_MIN;
        for (size_t i = 0; i < n; i++) {
            rounding = greater(rounding, 16.0 * s->noise[i]);
        }
        for (size_t i = 0; i < n; i++) {
            const size_t k = s->set[i];
            consistent &= refine > 0 || fabs(s->rhs[i] - s->gradient[k]) <= rounding;
            s->gradient[k] = s->rhs[i];
        }
        newton(s);
        project(basis, n - s->rank, n, s->step);
        for (size_t i = 0; i < n; i++) {
            s->x[s->set[i]] += s->step[i];
        }
    }
    gradient(s, n);
    return consistent;
}
