/* What a method of integration is, and what all of them share. */
#ifndef TRIBO_DRIVER_H
#define TRIBO_DRIVER_H

#include "system.h"

struct method {
    const char *name;
    int adaptive; /* needs tolerances */
    int (*create)(tribo_driver *drv);
    void (*destroy)(tribo_driver *drv); /* also after a create that failed */
    /* From *t to t1 > *t. continues: (t, y) is where the last advance ended. Returns a status; t and y hold the last good step.
     */
    int (*advance)(tribo_driver *drv, double *t, double t1, double *y, int continues);
    const void *with; /* the method's own */
};

struct tribo_driver {
    tribo_system *sys;
    const struct method *method;
    double dt, abstol, reltol;
    void *own;             /* the method's own */
    double *state, *slope; /* [dimension] where the last advance ended; workspace */
    double time;
    size_t steps, rejected, evaluations, jacobians, events;
    double excess, backslip; /* largest so far; NaN for methods that do not know them */
    int (*seen)(double t, const double *y, int event, void *data);
    void *data;
    char message[240];
};

/* Keeps the message and returns status. */
int tribo_driver_fail(tribo_driver *drv, int status, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* Steps of drv->dt to t1, the last one shorter where it must be. step takes y from t to next; if it fails, y is what it was
 * before. */
int tribo_driver_fixed_steps(tribo_driver *drv, double *t, double t1, double *y,
                             int (*step)(tribo_driver *, double, double, double *));

/* Tells the observer; TRIBO_OK or TRIBO_ERR_STOPPED. */
int tribo_driver_tell(tribo_driver *drv, double t, const double *y, int event);

extern const struct method tribo_method_exact, tribo_method_event, tribo_method_central_fixed, tribo_method_moreau_fixed,
    tribo_method_rk4_fixed, tribo_method_rk2, tribo_method_rk4, tribo_method_rkf45, tribo_method_rkck, tribo_method_rk8pd,
    tribo_method_rk1imp, tribo_method_rk2imp, tribo_method_rk4imp, tribo_method_bsimp, tribo_method_msadams, tribo_method_msbdf;

#endif
