/* SPDX-License-Identifier: BSD-3-Clause */
/* Compliant contacts: v = J q' + G f' - b. G is symmetric, positive definite over compliant contacts, 0 in rows of rigid
 * contacts. The forces f are part of the state. With the sets A of compliant contacts at rest and S of sliding contacts,
 *     f_A' = -G_AA^-1 (J_A q' - b_A + G_AS f_S'),   v_S = J_S q' - b_S + G_SA f_A' + G_SS f_S',
 * f_S' = 0 with constant limits, else by the rates of limits. */
#ifndef TRIBO_COMPLIANCE_H
#define TRIBO_COMPLIANCE_H

#include "numerics/matrix.h"
#include "tribo/tribo_dynamics.h"

struct compliance {
    size_t count;          /* number of compliant contacts; 0: all other members are empty */
    size_t *contact;       /* [count] compliant contacts, ascending */
    struct matrix g;       /* [ncontact][ncontact] G */
    struct matrix inverse; /* [ncontact][ncontact] G^-1 over the compliant contacts, else 0 */
    double *factor;     /* [ncontact][ncontact] workspace: Cholesky factor of G over a set of contacts; NULL if G is diagonal */
    double *own;        /* [ncontact] G_ii */
    tribo_context *box; /* with operator G */
    double *lo, *hi;    /* [ncontact] see tribo_compliance_share; workspace */
    double *f;          /* [ncontact] */
    struct matrix pull; /* [ndof][ncontact] M^-1 J' in columns of compliant contacts, else 0 */
    double stiffest;    /* bound of omega^2, with any contacts at rest */
    double structure;   /* largest (M^-1 K)_dd */
    double added;       /* largest contribution of one compliant contact to omega^2 of a degree of freedom */
    size_t tightest;    /* the contact of `added` */
};

/* NOISE: rounding error of a force, relative to its terms. ALLOWED: excess of a force over its limit, in rounding errors. */
#define TRIBO_SPRING_NOISE 2e-14
#define TRIBO_SPRING_ALLOWED 8.0

static inline int tribo_is_compliant(const struct compliance *g, size_t i)
{
    return g->count && g->own[i] > 0.0;
}

/* Returns G_ik. */
static inline double tribo_compliance_entry(const struct compliance *g, size_t i, size_t k)
{
    return g->count ? tribo_matrix_get(&g->g, i, k) : 0.0;
}

/* Sets G of sys; R and M^-1 J' of sys belong to the rigid contacts. own [ncontact]: G_ii. entries [ncontact][ncontact]: G; NULL:
 * diagonal. Returns TRIBO_OK, TRIBO_ERR_MEMORY, or TRIBO_ERR_INDEFINITE and *where = a contact with a row of G that depends on
 * earlier rows. */
int tribo_compliance_create(tribo_system *sys, const double *own, const double *entries, size_t *where);
void tribo_compliance_free(struct compliance *g);

/* Returns G of sys, without rows if all contacts are rigid. copy_first: sets the compliance of the model to G_ii of the first
 * contacts of a system in which G is diagonal; returns a status. */
const struct matrix *tribo_springs_matrix(const tribo_system *sys);
int tribo_springs_copy_first(tribo_model *model, const tribo_system *from);

/* Returns TRIBO_ERR_UNSUPPORTED if a compliant contact is so stiff relative to structure and loads that rounding of displacements
 * hides its force. */
int tribo_compliance_check(const tribo_system *sys);

/* get: force [ncontact] = f of a state y, 0 for rigid contacts. put: f of y = force. */
void tribo_compliance_get(const tribo_system *sys, const double *y, double *force);
void tribo_compliance_put(const tribo_system *sys, const double *force, double *y);

/* x [ncontact][columns] = G_AA^-1 x over the set A of compliant contacts with slip 0 (NULL: all); 0 in other rows. */
void tribo_compliance_solve(const tribo_system *sys, const signed char *slip, size_t columns, double *x);

/* x [ncontact][columns] = G f. */
void tribo_compliance_give(const tribo_system *sys, size_t columns, const double *f, double *x);

/* rate [ncontact][columns] = f'; 0 for rigid contacts. slide [ncontact][columns]: f' of the contacts with slip not 0, else 0;
 * NULL: 0. v [ncontact][columns]: in J q' - b; out J q' + G f' - b, unchanged for rigid contacts. */
void tribo_compliance_rates(const tribo_system *sys, const signed char *slip, const double *slide, size_t columns, double *v,
                            double *rate);

/* tribo_compliance_rates without slip: a contact slides if its force in y is at its limit and v points against the force. Limits
 * are those of the set time and motion. */
void tribo_compliance_move(const tribo_system *sys, const double *y, double *v, double *rate);

/* noise [ncontact] = TRIBO_SPRING_NOISE |G^-1| |J| |q|, bounds of rounding errors of forces; 0 for rigid contacts. */
void tribo_compliance_noise(const tribo_system *sys, const double *q, double *noise);

/* Reduces the forces in y to their limits [ncontact]; sliders slide back. Adds the energy dissipated to the energy of y. force
 * [ncontact] = f. */
void tribo_compliance_enter(const tribo_system *sys, const double *limit, double *force, double *y);

/* No force or rate of a force reaches this bound. */
#define TRIBO_UNBOUNDED 1e200

/* g->f = the forces, or rates of forces, in [g->lo, g->hi] that minimize 1/2 f'G f + v'f. v [ncontact]: displacements, or
 * velocities; in without f, out v + G f, exactly 0 where f is between its bounds. */
void tribo_compliance_share(const struct compliance *g, double *v);

/* Applies slip [ncontact] to perturbations v [2 ndof + count][columns] of a state: 0 for forces of open contacts, and of sliding
 * ones what their limits are perturbed by: by the motion, and by rise [ncontact][columns], or NULL. work [2
 * ncontact][columns]. */
void tribo_compliance_perturb(const tribo_system *sys, const signed char *slip, const double *rise, size_t columns, double *v,
                              double *work);

#endif
