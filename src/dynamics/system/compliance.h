/* Compliant contacts: v = J q' + G f' - b with a symmetric G, positive definite over the compliant contacts and zero in rows of
 * rigid ones. The forces f are part of a state. With A the compliant contacts at rest and S those that slide,
 *     f_A' = -G_AA^-1 (J_A q' - b_A),   f_S' = 0,   v_S = J_S q' - b_S + G_SA f_A'. */
#ifndef TRIBO_COMPLIANCE_H
#define TRIBO_COMPLIANCE_H

#include "numerics/definite.h"
#include "numerics/matrix.h"
#include "tribo/tribo_dynamics.h"

struct compliance {
    size_t count;            /* compliant contacts; 0: all other members are empty */
    size_t *contact;         /* [count] ascending */
    double *own;             /* [ncontact] G_ii */
    struct definite *shared; /* G, where it is not diagonal; else NULL */
    struct matrix pull;      /* [ndof][ncontact] M^-1 J' in columns of compliant contacts, else zero */
    double stiffest;         /* bound on omega^2, whichever contacts rest */
    double structure;        /* largest (M^-1 K)_dd */
    double added;            /* largest part that one compliant contact adds to omega^2 of a degree of freedom; */
    size_t tightest;         /* this contact */
};

/* A force is known to this part of the terms that it is the sum of, and may pass its limit by this many times that. */
#define TRIBO_SPRING_NOISE 2e-14
#define TRIBO_SPRING_ALLOWED 8.0

static inline int tribo_is_compliant(const struct compliance *g, size_t i)
{
    return g->count && g->own[i] > 0.0;
}

/* G_ik of compliant contacts among n contacts. */
static inline double tribo_compliance_entry(const struct compliance *g, size_t n, size_t i, size_t k)
{
    return g->shared ? g->shared->matrix[i * n + k] : i == k ? g->own[i] : 0.0;
}

/* Gives sys, whose R and M^-1 J' are those of the rigid contacts, J and G. direction: J of all contacts, taken; NULL: sys has it.
 * own [ncontact]: G_ii. g [ncontact][ncontact]: G; NULL: it is diagonal. Returns TRIBO_OK, TRIBO_ERR_MEMORY, or
 * TRIBO_ERR_INDEFINITE and a contact whose row of G depends on those before it. */
int tribo_compliance_create(tribo_system *sys, struct matrix *direction, const double *own, const double *g, size_t *where);
int tribo_compliance_copy(tribo_system *to, const tribo_system *from); /* 1, or 0 if out of memory */
void tribo_compliance_free(struct compliance *g);

/* Returns TRIBO_ERR_UNSUPPORTED if a compliant contact is so stiff beside the structure and its loads that the rounding of
 * displacements hides its force. */
int tribo_compliance_check(const tribo_system *sys);

/* force [ncontact] = f of a state y, 0 of rigid contacts; and back. */
void tribo_compliance_get(const tribo_system *sys, const double *y, double *force);
void tribo_compliance_put(const tribo_system *sys, const double *force, double *y);

/* x [ncontact][columns] = G_AA^-1 x over the compliant contacts A with slip 0; slip NULL: all of them. Other rows become 0. */
void tribo_compliance_solve(const tribo_system *sys, const signed char *slip, size_t columns, double *x);

/* x [ncontact][columns] = G f. */
void tribo_compliance_give(const tribo_system *sys, size_t columns, const double *f, double *x);

/* rate [ncontact] = f', and v [ncontact] = J q' - b in, the velocity against the bases out. Elements of rigid contacts stay. */
void tribo_compliance_rates(const tribo_system *sys, const signed char *slip, double *v, double *rate);

/* The same, without slip: a contact slides if its force in y is at its limit and v points against the force. */
void tribo_compliance_move(const tribo_system *sys, const double *y, double *v, double *rate);

/* noise [ncontact] = bounds of the rounding errors of forces, 0 of rigid contacts. */
void tribo_compliance_noise(const tribo_system *sys, const double *q, double *noise);

/* Takes forces back within limits [ncontact], as their sliders slide back. Returns the energy that this dissipates. */
double tribo_compliance_bound(const tribo_system *sys, const double *limit, double *force);

/* The same for the state y, in which energy becomes dissipated. force [ncontact] out: f. */
void tribo_compliance_enter(const tribo_system *sys, const double *limit, double *force, double *y);

/* v [n], velocities without f', becomes G f' + v with rates f' within c->lo and c->hi, in c->f; 0 where f' is not 0. */
void tribo_compliance_share(struct definite *c, double *v);

/* Perturbations v [2 ndof + count][columns] of a state whose contacts have this slip from here on: forces of contacts that slide
 * have none. work [2 ncontact][columns]. */
void tribo_compliance_perturb(const tribo_system *sys, const signed char *slip, size_t columns, double *v, double *work);

#endif
