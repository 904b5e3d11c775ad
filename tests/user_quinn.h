/* SPDX-License-Identifier: BSD-3-Clause */
/* Quinn's law as a caller would write it, for tribo_set_user_law. */
#ifndef TRIBO_TESTS_USER_QUINN_H
#define TRIBO_TESTS_USER_QUINN_H

#include <math.h>
#include <stddef.h>

struct quinn {
    int follows; /* epsilon follows the limit */
    int calls;
};

static int quinn_box(size_t first, size_t n, int derivatives, const double *v, const double *limit, const double *epsilon,
                     double *box, void *data)
{
    struct quinn *q = data;
    double *lower = box, *upper = box + n, *shift = box + 2 * n;
    (void)first;
    q->calls++;
    for (size_t i = 0; i < n; i++) {
        const double L = limit[i], full = 2.0 * L, k = full / epsilon[i] * v[i], slide = copysign(L, -v[i]);
        const double most = k < 0.0 ? -L - k : -L, least = k > 0.0 ? L - k : L;
        const int slides = fabs(v[i]) > epsilon[i];
        lower[i] = slides ? slide : most > L ? L : most;
        upper[i] = slides ? slide : least < -L ? -L : least;
        shift[i] = slides ? 0.0 : k;
    }
    for (size_t i = 0; derivatives && i < n; i++) {
        const double L = limit[i], slope = 2.0 * L / epsilon[i], k = shift[i],
                     by_limit = q->follows ? 0.0 : 2.0 * v[i] / epsilon[i];
        const int slides = fabs(v[i]) > epsilon[i], low = k <= 0.0 && -L - k < L, high = k >= 0.0 && L - k > -L;
        const double side = v[i] > 0.0 ? -1.0 : 1.0;
        double *by_v = box + 3 * n + i, *by_l = box + 6 * n + i;
        by_v[0] = slides || !low ? 0.0 : -slope;
        by_v[n] = slides || !high ? 0.0 : -slope;
        by_v[2 * n] = slides ? 0.0 : slope;
        by_l[0] = slides ? side : k > 0.0 ? -1.0 : low ? -1.0 - by_limit : 1.0;
        by_l[n] = slides ? side : k < 0.0 ? 1.0 : high ? 1.0 - by_limit : -1.0;
        by_l[2 * n] = slides ? 0.0 : by_limit;
    }
    return 0;
}

#endif
