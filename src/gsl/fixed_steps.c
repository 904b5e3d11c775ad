/* An advance of the methods that take steps of one length. */
#include "driver.h"
#include "../common/real.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Steps of one length from begin to t1. */
struct march {
    double begin, h, steps, t1;
};

/* Where the k-th step ends. */
static double end_of(const struct march *m, double k)
{
    return k < m->steps ? m->begin + k * m->h : m->t1;
}

/* So many steps are looked ahead. */
enum { AHEAD = FORESIGHT / 2 };

/* t [AHEAD + 1] = when the k-th step begins, it ends, and the next ones end; the system foresees them. */
static void look_ahead(tribo_driver *drv, const struct march *m, double k, const struct fixed_method *method, double *t)
{
    double times[FORESIGHT];
    size_t count = 0;
    t[0] = drv->time;
    for (size_t s = 0; s < AHEAD; s++) {
        t[s + 1] = end_of(m, k + (double)s);
        for (size_t i = 0; i < method->times; i++) {
            times[count++] = t[s] + method->part[i] * (t[s + 1] - t[s]);
        }
    }
    if (drv->sys->harmonics > drv->sys->base_harmonics + drv->sys->limit_harmonics) {
        tribo_system_foresee(drv->sys, count, times);
    }
}

/* Steps from the k-th on until loads have to be looked up again: from and to take each other's place after each. Returns how
 * many. */
static double take_steps(tribo_driver *drv, double left, const double *t, double **from, double **to,
                         const struct fixed_method *method, int *status)
{
    const size_t count = left < AHEAD ? (size_t)left : AHEAD;
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
            *status = drv->seen ? tribo_driver_show(drv, drv->time, *from, 0) : TRIBO_OK;
        }
    }
    return (double)count;
}

/* All steps: from and to are the last good state and room for the next in turn. Returns the former. */
static double *march(tribo_driver *drv, const struct march *m, double *from, double *to, const struct fixed_method *method,
                     int *status)
{
    *status = TRIBO_OK;
    for (double k = 1.0; k <= m->steps && !*status;) {
        double t[AHEAD + 1];
        look_ahead(drv, m, k, method, t);
        k += take_steps(drv, m->steps - k + 1.0, t, &from, &to, method, status);
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
    memcpy(good == y ? drv->state : y, good, tribo_system_dimension(drv->sys) * sizeof *y);
    *t = drv->time;
    return status;
}
