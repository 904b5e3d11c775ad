/* An advance of the methods that take steps of one length. */
#include "dynamics/driver.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* Steps of one length from begin to t1. */
struct march {
    double begin, h, steps, t1;
};

/* So many steps are looked ahead. */
enum { AHEAD = FORESIGHT / 2 };

/* t [count + 1] = when the k-th step begins, it ends, and the next ones end. */
static void fixed_find_times(struct march m, double begin, double k, size_t count, double *t)
{
    t[0] = begin;
    for (size_t s = 0; s < count; s++) {
        const double number = k + (double)s;
        t[s + 1] = number < m.steps ? m.begin + number * m.h : m.t1;
    }
}

/* Steps between these times until loads have to be looked up again: from and to take each other's place after each. */
static void take_steps(tribo_driver *drv, size_t count, const double *t, double **from, double **to,
                       const struct fixed_method *method, int *status)
{
    size_t s = method->run && !drv->seen ? method->run(drv, count, t, *from) : 0;
    drv->time = t[s];
    drv->steps += s;
    for (; s < count && !*status; s++) {
        *status = method->step(drv, t[s], t[s + 1], *from, *to);
        if (!*status) {
            double *last = *from;
            *from = *to;
            *to = last;
            drv->time = t[s + 1];
            drv->steps++;
            *status = drv->seen ? tribo_driver_show(drv, drv->time, *from, TRIBO_MOMENT_STEP, SIZE_MAX) : TRIBO_OK;
        }
    }
}

/* All steps: from and to are the last good state and room for the next in turn. Returns the former. */
static double *march(tribo_driver *drv, const struct march *m, double *from, double *to, const struct fixed_method *method,
                     int *status)
{
    *status = TRIBO_OK;
    for (double k = 1.0; k <= m->steps && !*status; k += AHEAD) {
        double t[AHEAD + 1];
        const double left = m->steps - k + 1.0;
        const size_t ahead = left < AHEAD ? (size_t)left + 1 : AHEAD; /* loads at the end are asked for, too */
        fixed_find_times(*m, drv->time, k, ahead, t);
        /* The system foresees what steps between these times ask it for. */
        tribo_system *sys = drv->sys;
        double times[FORESIGHT];
        const size_t each = method->times;
        for (size_t i = 0; i < each; i++) {
            const double part = method->part[i];
            for (size_t s = 0; s < ahead; s++) {
                times[s * each + i] = t[s] + part * (t[s + 1] - t[s]);
            }
        }
        if (sys->harmonics > sys->base_harmonics + sys->limit_harmonics) {
            tribo_system_foresee(sys, each * ahead, times);
        }
        take_steps(drv, left < AHEAD ? (size_t)left : AHEAD, t, &from, &to, method, status);
    }
    return from;
}

int tribo_driver_fixed_steps(tribo_driver *drv, double *t, double t1, double *y, const struct fixed_method *method)
{
    const double begin = *t, whole = (t1 - begin) / drv->dt, resolution = DBL_EPSILON * greater(fabs(begin), fabs(t1));
    if (drv->dt < 16.0 * resolution) {
        return tribo_driver_fail(drv, TRIBO_ERR_STEP, "from t = %.17g to %.17g, dt = %g is hardly more than time resolves, %g",
                                 begin, t1, drv->dt, resolution);
    }
    /* a rest that is only rounding is spread over the steps */
    const double rest = greater(1e-6, 4.0 * resolution / drv->dt);
    const double steps = fabs(whole - round(whole)) < rest && whole > 0.5 ? round(whole) : greater(ceil(whole), 1.0);
    const double h = whole > steps ? (t1 - begin) / steps : drv->dt;
    const struct march all = {begin, h, steps, t1};
    int status;
    double *good = march(drv, &all, drv->state, y, method, &status);
    memcpy(good == y ? drv->state : y, good, tribo_system_size(drv->sys) * sizeof *y);
    *t = drv->time;
    return status;
}
