/* States, as callers and as methods order their values. */
#include "system.h"

#include <stdlib.h>
#include <string.h>

int tribo_system_set_sliders(tribo_system *sys, size_t count)
{
    sys->motion = count ? malloc(tribo_system_size(sys) * sizeof *sys->motion) : NULL;
    sys->sliders = sys->motion ? count : 0;
    return sys->sliders == count;
}

void tribo_system_read_state(const tribo_system *sys, const double *y, double *to)
{
    const size_t e = sys->sliders, n = sys->ndof - e;
    memcpy(to, y, n * sizeof *to);
    memcpy(to + n, y + 2 * n, e * sizeof *to);
    memcpy(to + n + e, y + n, n * sizeof *to);
    memset(to + 2 * n + e, 0, e * sizeof *to);
    to[2 * (n + e)] = y[2 * n + e];
}

void tribo_system_write_state(const tribo_system *sys, const double *from, double *y)
{
    const size_t e = sys->sliders, n = sys->ndof - e;
    memcpy(y, from, n * sizeof *y);
    memcpy(y + n, from + n + e, n * sizeof *y);
    memcpy(y + 2 * n, from + n, e * sizeof *y);
    y[2 * n + e] = from[2 * (n + e)];
}

size_t tribo_system_state_index(const tribo_system *sys, size_t i)
{
    const size_t e = sys->sliders, n = sys->ndof - e;
    return i < n ? i : i < n + e ? i + n : i < 2 * (n + e) ? i - e : 2 * n + e;
}
