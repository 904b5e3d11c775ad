/* What the files of src/core share. */
#ifndef TRIBO_INTERNAL_H
#define TRIBO_INTERNAL_H

#include <math.h>
#include <string.h>

#include "tribo/tribo.h"

#include "law.h"
#include "solver.h"

/* R. Contacts that share no body have only the diagonal; the others stand in islands, the connected parts of R's graph,
 * each with its own dense block. */
struct op {
    double *diagonal; /* [n] R_ii, at least DBL_MIN, which is the limit R_ii -> +0 */
    size_t islands;   /* 0: R is diagonal */
    size_t *first;    /* [islands + 1] into member */
    size_t *member;   /* [n] contacts, island by island, ascending within one */
    size_t *offset;   /* [islands] into block */
    double *block;    /* row-major blocks of R */
    size_t largest;   /* size of the largest island */
    double row_sum;   /* max over i of sum_j |R_ij|/R_ii */
};

struct message;

struct tribo_context {
    size_t n;
    const struct law *law;
    int coupling;
    double step, lambda_dt; /* tribo_set_epsilon_step; step 0: epsilon was given */
    double *given;          /* [n] epsilon as given */
    double *limit, *epsilon, *slope;
    unsigned char *moving; /* [n] reversal memory */
    struct op op;
    struct solver solver;
    double *feq, *f, *column; /* [n] workspace of tribo_balance and its tangents */
    size_t *near;             /* [n] workspace: the contacts near stick of an island, by their place in it */
    int balanced;             /* f is that of a tribo_balance or tribo_step_force, and modes follow from it */
    double holds;             /* a contact holds if |f| is less than this part of the limit */
    double residual;
    size_t rank, solves, skipped, marks;
    struct message *message;
};

/* message.c: keeps the text for tribo_message and returns status. */
int tribo_fail(const tribo_context *ctx, int status, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;
struct message *tribo_message_create(void);

/* check.c: TRIBO_OK, or a failure that names the argument, the first offending contact and its value. */
int tribo_check_finite(const tribo_context *ctx, const char *name, const double *x, size_t n);
int tribo_check_nonnegative(const tribo_context *ctx, const char *name, const double *x, size_t n);
int tribo_check_positive(const tribo_context *ctx, const char *name, const double *x, size_t n);

/* operator.c */
void tribo_op_free(struct op *op);
int tribo_op_identity(struct op *op, size_t n);
int tribo_op_copy(struct op *to, const struct op *from, size_t n);

/* memcpy, but fine with NULL for no elements. */
static inline void tribo_copy(double *to, const double *from, size_t n)
{
    if (n) {
        memcpy(to, from, n * sizeof *to);
    }
}

/* context.c: 2 limit/epsilon; epsilon and slope brought up to date with limits, operator and settings; the contacts' data as
 * laws see them. */
double tribo_slope(double limit, double epsilon);
void tribo_refresh(tribo_context *ctx);
struct contacts tribo_contacts(const tribo_context *ctx);
struct contacts tribo_contacts_from(const struct contacts *c, size_t i);

/* Where |v| is at most this, the law reads f_eq. */
static inline double tribo_band(const tribo_context *ctx, size_t i)
{
    return ctx->law->sticks_in_band ? ctx->epsilon[i] : 0.0;
}

#endif
