/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts one by one, as if no two shared a body: alone.c. */
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

/* Returns the slip of a contact by its force f: it is stuck if |f| < holds limit. (The smooth law never reaches the limit; it
 * holds where |v| < epsilon.) */
static inline signed char tribo_slip_by_force(double f, double limit, double holds)
{
    const double edge = holds * limit;
    const double forth = f <= -edge ? TRIBO_SLIP_FORTH : 0.0, back = f >= edge ? -TRIBO_SLIP_BACK : 0.0;
    return (signed char)(int)(limit > 0.0 ? forth - back
                                          : TRIBO_SLIP_OPEN); /* doubles, as wide as f: vectors of them stay whole */
}

/* slip [n] by forces. */
void tribo_find_slips(size_t n, const double *f, const double *limit, double holds, signed char *slip);

/* feq [n] = -a/R_ii of the contacts of the chunk that begins with contact i; 0 for open ones. */
void tribo_find_feq(const tribo_context *ctx, size_t i, size_t n, const double *a, double *feq);

/* Returns the |v| up to which the law reads f_eq, of the n <= TRIBO_CHUNK contacts from i on: epsilon, or 0; room [n] is
 * workspace. */
const double *tribo_bands(const tribo_context *ctx, size_t i, size_t n, double *room);

/* Checks that v and a are finite; a status. *plain: |a_i| <= TRIBO_PLAIN. */
int tribo_check_motion(tribo_context *ctx, const double *v, const double *a, int *plain);

/* tribo_balance and tribo_step_force where tribo_all_alone. feq and f of the balance may be NULL. */
int tribo_balance_alone(tribo_context *ctx, const double *v, const double *a, double *feq, double *f);
int tribo_step_alone(tribo_context *ctx, double dt, const double *v, double *f);

/* The first part of a balance: last.f of contacts that need no solver, and f_eq where the law reads it, or of all such contacts if
 * wanted. Finds which contacts of groups are near stick, and lists their groups. */
void tribo_balance_each(tribo_context *ctx, const double *v, const double *a, int wanted);

/* The first part of a step: last.f = -v/(dt R_ii) within bounds. */
void tribo_step_each(tribo_context *ctx, double dt, const double *v, struct bounds b);

#endif
