/* SPDX-License-Identifier: BSD-3-Clause */
/* An advance of the methods that take steps of one length. */
#include "dynamics/driver.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

int tribo_driver_fixed_steps(tribo_driver *drv, double *t, double t1, double *y, tribo_fixed_step *step, tribo_fixed_run *run)
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
    /* begins with the last good state, drv->state; states are written there and in y by turns */
    double *from = drv->state, *to = y;
    int status = TRIBO_OK;
    for (double k = 0.0; k < steps && !status;) {
        const size_t count = steps - k < RUN ? (size_t)(steps - k) : RUN;
        double time[RUN + 1];
        time[0] = drv->time;
        for (size_t s = 1; s <= count; s++) {
            time[s] = k + (double)s < steps ? begin + (k + (double)s) * h : t1;
        }
        size_t taken = run && !drv->seen ? run(drv, count, time, from) : 0;
        if (taken == 0) {
            status = step(drv, time[0], time[1], from, to);
            if (status) {
                break;
            }
            double *last = from;
            from = to;
            to = last;
            taken = 1;
        }
        k += (double)taken;
        drv->time = time[taken];
        drv->steps += taken;
        status = drv->seen ? tribo_driver_show(drv, drv->time, from, TRIBO_MOMENT_STEP, SIZE_MAX) : TRIBO_OK;
    }
    memcpy(from == y ? drv->state : y, from, tribo_system_size(drv->sys) * sizeof *y);
    *t = drv->time;
    return status;
}
