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
                     double *restrict box, void *data)
{
    struct quinn *q = data;
    double *lower = box, *upper = box + n, *shift = box + 2 * n, *by_v = box + 3 * n, *by_limit = box + 6 * n;
    (void)first;
    q->calls++;
    for (size_t i = 0; i < n; i++) {
        const double L = limit[i], E = epsilon[i], below = v[i] < E ? v[i] : E, near = below > -E ? below : -E;
        const double k = 2.0 * L * (near / E), least = -L - k, most = L - k;
        lower[i] = least > -L ? least : -L;
        upper[i] = most < L ? most : L;
        shift[i] = k;
    }
    for (size_t i = 0; derivatives && i < n; i++) {
        const double slope = 2.0 * limit[i] / epsilon[i], k = shift[i];
        const int near = fabs(v[i]) <= epsilon[i];
        by_v[i] = near && k <= 0.0 ? -slope : 0.0;
        by_v[n + i] = near && k >= 0.0 ? -slope : 0.0;
        by_v[2 * n + i] = near ? slope : 0.0;
    }
    for (size_t i = 0; derivatives && i < n; i++) {
        const double side = v[i] > 0.0 ? -1.0 : 1.0, turn = q->follows ? 0.0 : 2.0 * v[i] / epsilon[i];
        const int slides = fabs(v[i]) > epsilon[i];
        by_limit[i] = slides ? side : v[i] > 0.0 ? -1.0 : -1.0 - turn;
        by_limit[n + i] = slides ? side : v[i] < 0.0 ? 1.0 : 1.0 - turn;
        by_limit[2 * n + i] = slides ? 0.0 : turn;
    }
    return 0;
}

#endif
