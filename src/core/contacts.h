/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts one by one, as if no two shared a body. */
#ifndef TRIBO_CONTACTS_H
#define TRIBO_CONTACTS_H

#include "context.h"

/* Bounds of forces; lower NULL: -upper. */
struct bounds {
    const double *lower, *upper;
};

static inline double tribo_lower(const struct bounds *b, size_t i)
{
    return b->lower ? b->lower[i] : -b->upper[i];
}

/* Returns the slip of a contact by its state did and force f: it is stuck if |f| < holds limit. (The smooth law never reaches the
 * limit; it holds where |v| < epsilon.) */
static inline signed char tribo_slip_by_force(signed char did, double f, double limit, double holds)
{
    const double edge = holds * limit;
    const double forth = f <= -edge ? TRIBO_SLIP_FORTH : 0.0, back = f >= edge ? -TRIBO_SLIP_BACK : 0.0;
    const double slip = did == STORED ? forth - back : did; /* doubles, as wide as f: vectors of them stay whole */
    return (signed char)(int)(limit > 0.0 ? slip : TRIBO_SLIP_OPEN);
}

/* ---- classify.c */

/* Sets all contacts STORED. */
void tribo_store_all(tribo_context *ctx);

/* Checks v and a, and sets deeds: contacts near stick are STORED. Returns a status; after a failure deeds are those of the last
 * call. */
int tribo_classify(tribo_context *ctx, const double *v, const double *a);

/* Sets f of STORED contacts that need no solver, and f_eq where the law reads it, or of all such contacts if wanted. */
void tribo_forces_alone(tribo_context *ctx, const double *v, const double *a, int wanted);

/* f [n] of all contacts, while limits are those of the last call. */
void tribo_forces(const tribo_context *ctx, double *f);

/* feq [n] = -a/R_ii of the contacts of the chunk that begins with contact i; 0 for open ones. */
void tribo_find_feq(const tribo_context *ctx, size_t i, size_t n, const double *a, double *feq);

/* Contacts of chunk k with |v| above this are not near stick. */
double tribo_widest_band(const tribo_context *ctx, size_t k);

/* 1 if any |v_i| <= band. */
int tribo_any_in_band(size_t n, const double *v, double band);

/* did [n] = the direction of v. */
void tribo_find_directions(size_t n, const double *v, signed char *did);

/* Returns the |v| up to which the law reads f_eq, of the n <= TRIBO_CHUNK contacts from i on: epsilon, or 0; room [n] is
 * workspace. */
const double *tribo_bands(const tribo_context *ctx, size_t i, size_t n, double *room);

/* ---- alone.c */

/* tribo_balance and tribo_step_force where tribo_all_alone. feq and f of the balance may be NULL. */
int tribo_balance_alone(tribo_context *ctx, const double *v, const double *a, double *feq, double *f);
int tribo_step_alone(tribo_context *ctx, double dt, const double *v, double *f);

/* f = -v/(dt R_ii) within bounds, of the contacts of chunk k; arrays begin with the chunk. */
void tribo_stop_alone(const tribo_context *ctx, size_t k, double dt, const double *v, struct bounds b, double *f);

#endif
