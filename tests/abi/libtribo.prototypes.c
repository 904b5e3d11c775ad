/* SPDX-License-Identifier: BSD-3-Clause */
/* Written by abi.sh: the prototypes once more. With another one in the header this does not compile. */
#include "tribo/tribo.h"

TRIBO_API int tribo_version(void);
TRIBO_API const char *tribo_version_string(void);
TRIBO_API const char *tribo_strerror(int status);
TRIBO_API int tribo_law_count(void);
TRIBO_API const char *tribo_law_name(int law);
TRIBO_API const char *tribo_law_reference(int law);
TRIBO_API int tribo_law_find(const char *name, int *law);
TRIBO_API int tribo_law_eval(int law, double v, double feq, double limit, double epsilon, double *f, double *df_dv,
                             double *df_dfeq, double *df_dlimit);
TRIBO_API int tribo_elastic_force(size_t n, const double *dz, const double *stiffness, const double *limit, double *f,
                                  double *df_dz);
TRIBO_API int tribo_elastic_force_planar(size_t n, const double *dz, const double *stiffness, const double *limit, double *f,
                                         double *df_dz);
TRIBO_API int tribo_contact_force(size_t n, const double *dz, const double *depth, const double *tangential, const double *normal,
                                  const double *mu, double *f, double *df);
TRIBO_API int tribo_dahl_force(size_t n, const double *dz, const double *stiffness, const double *limit, double *f,
                               double *df_dz);
TRIBO_API int tribo_lugre_force(size_t n, double dt, const double *dz, const double *parameter, double *z, double *f,
                                double *df_dz);
TRIBO_API int tribo_bouc_wen_force(size_t n, const double *dz, const double *parameter, double *z, double *f, double *df_dz);
TRIBO_API int tribo_iwan_force(size_t n, size_t room, const double *dz, const double *parameter, double *state, double *f,
                               double *df_dz);
TRIBO_API int tribo_create(tribo_context **ctx, size_t ncontact);
TRIBO_API int tribo_clone(const tribo_context *ctx, tribo_context **copy);
TRIBO_API void tribo_destroy(tribo_context *ctx);
TRIBO_API const char *tribo_message(const tribo_context *ctx);
TRIBO_API int tribo_copy_settings(tribo_context *ctx, const tribo_context *from);
TRIBO_API int tribo_get_ncontact(const tribo_context *ctx, size_t *ncontact);
TRIBO_API int tribo_set_law(tribo_context *ctx, int law);
TRIBO_API int tribo_get_law(const tribo_context *ctx, int *law);
TRIBO_API int tribo_set_user_law(tribo_context *ctx,
                                 int (*law)(size_t first, size_t n, int derivatives, const double *v, const double *limit,
                                            const double *epsilon, double *box, void *data),
                                 void *data);
TRIBO_API int tribo_set_limit(tribo_context *ctx, const double *limit);
TRIBO_API int tribo_set_limit_all(tribo_context *ctx, double limit);
TRIBO_API int tribo_get_limit(const tribo_context *ctx, double *limit);
TRIBO_API int tribo_set_normal_load(tribo_context *ctx, const double *mu, const double *load);
TRIBO_API int tribo_set_static(tribo_context *ctx, const double *ratio, const double *velocity);
TRIBO_API int tribo_get_static(const tribo_context *ctx, double *ratio, double *velocity);
TRIBO_API int tribo_set_epsilon(tribo_context *ctx, const double *epsilon);
TRIBO_API int tribo_set_epsilon_all(tribo_context *ctx, double epsilon);
TRIBO_API int tribo_set_epsilon_step(tribo_context *ctx, double dt, double lambda_dt);
TRIBO_API int tribo_get_epsilon(const tribo_context *ctx, double *epsilon);
TRIBO_API int tribo_set_planar(tribo_context *ctx, size_t count, const size_t *first);
TRIBO_API int tribo_set_operator_diagonal(tribo_context *ctx, const double *r);
TRIBO_API int tribo_set_operator_dense(tribo_context *ctx, const double *r);
TRIBO_API int tribo_set_operator_csr(tribo_context *ctx, const size_t *rowptr, const size_t *col, const double *val);
TRIBO_API int tribo_set_operator_mass(tribo_context *ctx, size_t ndof, const double *inverse_mass, const size_t *rowptr,
                                      const size_t *col, const double *val);
TRIBO_API int tribo_set_operator_callback(tribo_context *ctx, size_t ndof,
                                          int (*apply)(size_t ndof, const double *force, double *acceleration, void *data),
                                          void *data, const size_t *rowptr, const size_t *col, const double *val);
TRIBO_API int tribo_update_operator(tribo_context *ctx, const double *val);
TRIBO_API int tribo_fix_operator(tribo_context *ctx);
TRIBO_API int tribo_set_coupling(tribo_context *ctx, int coupling);
TRIBO_API int tribo_get_coupling(const tribo_context *ctx, int *coupling);
TRIBO_API int tribo_set_sharing(tribo_context *ctx, int sharing);
TRIBO_API int tribo_get_sharing(const tribo_context *ctx, int *sharing);
TRIBO_API int tribo_force(const tribo_context *ctx, const double *v, const double *feq, double *f);
TRIBO_API int tribo_force_tangent(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv,
                                  double *df_dfeq, double *df_dlimit);
TRIBO_API int tribo_force_tangent_planar(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv,
                                         double *df_dfeq, double *df_dlimit);
TRIBO_API int tribo_balance(tribo_context *ctx, const double *v, const double *a, double *feq, double *f);
TRIBO_API int tribo_balance_tangent(tribo_context *ctx, const double *v, const double *a, double *feq, double *f, double *df_dv,
                                    double *df_da);
TRIBO_API int tribo_tangent_product(tribo_context *ctx, const double *dv, const double *da, double *df);
TRIBO_API int tribo_limit_product(tribo_context *ctx, const double *dlimit, double *df);
TRIBO_API int tribo_step_force(tribo_context *ctx, double dt, const double *vfree, double *f);
TRIBO_API int tribo_step_force_mean(tribo_context *ctx, double dt, const double *v, const double *vfree, double *f);
TRIBO_API int tribo_solve_box(tribo_context *ctx, const double *a, const double *lower, const double *upper, double *f);
TRIBO_API int tribo_accept(tribo_context *ctx, const double *v, const double *feq);
TRIBO_API int tribo_get_slip(const tribo_context *ctx, signed char *slip);
TRIBO_API int tribo_get_count(const tribo_context *ctx, int which, size_t *value);
TRIBO_API int tribo_get_real(const tribo_context *ctx, int which, double *value);
