/* Written by abi.sh: the prototypes once more. With another one in the header this does not compile. */
#include "tribo/tribo_gsl.h"

TRIBO_API int tribo_system_oscillator(tribo_system **sys, double limit, double alpha, double omega);
TRIBO_API int tribo_system_chain(tribo_system **sys, size_t n, double limit, double alpha, double omega);
TRIBO_API int tribo_system_belt(tribo_system **sys, double kappa, double limit1, double limit2, double speed, double omega);
TRIBO_API int tribo_system_linear(tribo_system **sys, size_t ndof, size_t ncontact, const double *mass, const double *damping,
                                  const double *stiffness, const double *direction, size_t nmode, char *message, size_t size);
TRIBO_API int tribo_system_linear_sparse(tribo_system **sys, const gsl_spmatrix *mass, const gsl_spmatrix *damping,
                                         const gsl_spmatrix *stiffness, const gsl_spmatrix *direction, size_t nmode,
                                         char *message, size_t size);
TRIBO_API int tribo_system_reduced(tribo_system **sys, const gsl_spmatrix *mass, const gsl_spmatrix *stiffness,
                                   const gsl_spmatrix *direction, size_t nmode, int static_contacts, char *message, size_t size);
TRIBO_API void tribo_system_destroy(tribo_system *sys);
TRIBO_API int tribo_system_clone(const tribo_system *sys, tribo_system **copy);
TRIBO_API int tribo_system_add_load(tribo_system *sys, double omega, const double *cosine, const double *sine);
TRIBO_API int tribo_system_clear_loads(tribo_system *sys);
TRIBO_API int tribo_system_add_base_motion(tribo_system *sys, double omega, const double *cosine, const double *sine);
TRIBO_API int tribo_system_add_load_table(tribo_system *sys, size_t knots, const double *time, const double *value,
                                          const double *pattern);
TRIBO_API int tribo_system_add_limit(tribo_system *sys, double omega, const double *cosine, const double *sine);
TRIBO_API int tribo_system_set_limit_table(tribo_system *sys, size_t knots, const double *time, const double *limit);
TRIBO_API int tribo_system_set_damping_ratio(tribo_system *sys, double zeta);
TRIBO_API int tribo_system_get_frequencies(const tribo_system *sys, double *omega);
TRIBO_API int tribo_system_expand(const tribo_system *sys, const double *reduced, double *full);
TRIBO_API int tribo_system_get_truncation(const tribo_system *sys, double omega, double *error);
TRIBO_API size_t tribo_system_ndof(const tribo_system *sys);
TRIBO_API size_t tribo_system_ncontact(const tribo_system *sys);
TRIBO_API size_t tribo_system_dimension(const tribo_system *sys);
TRIBO_API tribo_context *tribo_system_context(tribo_system *sys);
TRIBO_API const gsl_odeiv2_system *tribo_system_odeiv2(tribo_system *sys);
TRIBO_API int tribo_system_contacts(tribo_system *sys, double t, const double *y, double *v, double *feq, double *f);
TRIBO_API int tribo_system_accept(tribo_system *sys, double t, const double *y);
TRIBO_API int tribo_driver_create(tribo_driver **drv, tribo_system *sys, const char *method, double dt, double abstol,
                                  double reltol);
TRIBO_API const char *tribo_driver_method(const tribo_driver *drv);
TRIBO_API int tribo_method_count(void);
TRIBO_API const char *tribo_method_name(int method);
TRIBO_API int tribo_driver_advance(tribo_driver *drv, double *t, double t1, double *y);
TRIBO_API int tribo_driver_find_periodic(tribo_driver *drv, double t, double period, double *y);
TRIBO_API int tribo_driver_get_multipliers(const tribo_driver *drv, double *re, double *im);
TRIBO_API int tribo_driver_period_extremes(tribo_driver *drv, const double *c, double *least, double *most);
TRIBO_API int tribo_driver_period_extremes_at(tribo_driver *drv, const double *c, double *least, double *most, double *at_least,
                                              double *at_most);
TRIBO_API int tribo_driver_period_harmonic(tribo_driver *drv, const double *c, size_t k, double *cosine, double *sine);
TRIBO_API int tribo_driver_period_dissipation(tribo_driver *drv, double *energy);
TRIBO_API int tribo_driver_period_stick(tribo_driver *drv, double *share);
TRIBO_API int tribo_driver_count(const tribo_driver *drv, int which, size_t *value);
TRIBO_API int tribo_driver_real(const tribo_driver *drv, int which, double *value);
TRIBO_API int tribo_driver_set_observer(tribo_driver *drv, int (*seen)(double t, const double *y, int event, void *data),
                                        void *data);
TRIBO_API int tribo_driver_set_max_step(tribo_driver *drv, double h);
TRIBO_API const char *tribo_driver_message(const tribo_driver *drv);
TRIBO_API void tribo_driver_destroy(tribo_driver *drv);
