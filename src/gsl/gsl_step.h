/* Single steps of y' = f(t, y), tried by GSL's steppers. GSL calls its error handler, which ends the program, when it is out of
 * memory and when a matrix of an implicit step is singular, and it divides by zero where an estimate is; here it is kept from all
 * that. */
#ifndef TRIBO_GSL_STEP_H
#define TRIBO_GSL_STEP_H

#include "dynamics/system/system.h"

struct gsl_step_kind {
    const gsl_odeiv2_step_type *const *type;
    /* In steps of this over the rate at which a contact at rest relaxes, it goes on relaxing, and its estimate sees it stick and
     * break away. HUGE_VAL: in any */
    double stable;
    int takes_slope; /* it begins with f(t, y) */
    int newton;      /* an implicit Runge-Kutta method with GSL's Newton iteration */
    size_t matrices; /* that a step may factorize: I - h c_i A x J; 0 for explicit ones */
    const double *c;
    size_t stages;
    const double *a; /* [stages][stages] A; NULL: 1 */
};

struct gsl_step;

/* NULL if out of memory. */
struct gsl_step *tribo_gsl_step_create(const struct gsl_step_kind *kind, tribo_system *sys);
void tribo_gsl_step_destroy(struct gsl_step *g);

/* Forgets the steps before: what comes is another motion. */
void tribo_gsl_step_restart(struct gsl_step *g);

/* From (t, y), where slope is f (read if the kind takes it), over h to `to`, which may be off by error; all [dimension]. What is
 * tried from the same t again replaces what was tried before, otherwise that has been accepted. Returns a GSL status: after
 * GSL_EBADFUNC no shorter step will do either, and the system's status says why.
 * rate [ncontact] contacts at rest relax so fast */
int tribo_gsl_step_try(struct gsl_step *g, double t, double h, const double *y, const double *slope, const double *tolerance,
                       const double *rate, double *to, double *error);

/* Order of the step to come, whose error goes with the power order + 1 of h. */
double tribo_gsl_step_order(const struct gsl_step *g);

extern const struct gsl_step_kind tribo_kind_rk2, tribo_kind_rk4, tribo_kind_rkf45, tribo_kind_rkck, tribo_kind_rk8pd,
    tribo_kind_rk1imp, tribo_kind_rk2imp, tribo_kind_rk4imp, tribo_kind_bsimp, tribo_kind_msadams, tribo_kind_msbdf;

#endif
