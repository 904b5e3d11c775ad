/* SPDX-License-Identifier: BSD-3-Clause */
#include "peer_cholmod.h"

#include <stdio.h>

#include <cholmod.h>

#include "../../src/damper/output.h"
#include "contacts.h"

struct peer {
    cholmod_common common;
    cholmod_sparse *r, *permuted, *column; /* lower triangle; all of it in the factor's order; a row of that */
    cholmod_factor *l;
    cholmod_dense *rhs;
    size_t calls, mover;
};

static void check(const struct peer *p, int good)
{
    if (!good || p->common.status != CHOLMOD_OK) {
        die("CHOLMOD: status %d", p->common.status);
    }
}

/* The lower triangle of the scene's R, and all of it in the order of elimination. */
static void set_matrix(struct peer *p, const struct contacts *s, int supernodal)
{
    cholmod_triplet *t = cholmod_allocate_triplet(s->n, s->n, s->first[s->n], -1, CHOLMOD_REAL, &p->common);
    check(p, t != NULL);
    for (size_t i = 0; i < s->n; i++) {
        for (size_t e = s->first[i]; e < s->first[i + 1]; e++) {
            if (s->col[e] <= i) {
                ((int *)t->i)[t->nnz] = (int)i;
                ((int *)t->j)[t->nnz] = (int)s->col[e];
                ((double *)t->x)[t->nnz++] = s->val[e];
            }
        }
    }
    p->r = cholmod_triplet_to_sparse(t, 0, &p->common);
    cholmod_free_triplet(&t, &p->common);
    p->common.supernodal = supernodal;
    p->common.final_ll = 0;
    p->l = cholmod_analyze(p->r, &p->common);
    check(p, p->l && cholmod_factorize(p->r, p->l, &p->common));
    cholmod_sparse *all = cholmod_copy(p->r, 0, 1, &p->common);
    p->permuted = cholmod_submatrix(all, p->l->Perm, (int)s->n, p->l->Perm, (int)s->n, 1, 1, &p->common);
    p->column = cholmod_allocate_sparse(s->n, 1, 8, 1, 1, 0, CHOLMOD_REAL, &p->common);
    p->rhs = cholmod_ones(s->n, 1, CHOLMOD_REAL, &p->common);
    cholmod_free_sparse(&all, &p->common);
    check(p, p->permuted && p->column && p->rhs);
}

static void end(struct peer *p)
{
    cholmod_free_sparse(&p->r, &p->common);
    cholmod_free_sparse(&p->permuted, &p->common);
    cholmod_free_sparse(&p->column, &p->common);
    cholmod_free_factor(&p->l, &p->common);
    cholmod_free_dense(&p->rhs, &p->common);
    cholmod_finish(&p->common);
}

static void factorize(void *data)
{
    struct peer *p = data;
    check(p, cholmod_factorize(p->r, p->l, &p->common));
}

static void solve(void *data)
{
    struct peer *p = data;
    cholmod_dense *x = cholmod_solve(CHOLMOD_A, p->l, p->rhs, &p->common);
    check(p, x != NULL);
    cholmod_free_dense(&x, &p->common);
}

/* Takes a row out of the factor, or puts it back. */
static void change(void *data)
{
    struct peer *p = data;
    if (p->calls++ % 2 == 0) {
        p->mover = p->calls * 7919 % p->r->nrow;
        check(p, cholmod_rowdel(p->mover, NULL, p->l, &p->common));
        return;
    }
    const int *first = p->permuted->p, begin = first[p->mover], entries = first[p->mover + 1] - begin;
    ((int *)p->column->p)[1] = entries;
    for (int e = 0; e < entries; e++) {
        ((int *)p->column->i)[e] = ((int *)p->permuted->i)[begin + e];
        ((double *)p->column->x)[e] = ((double *)p->permuted->x)[begin + e];
    }
    check(p, cholmod_rowadd(p->mover, p->column, p->l, &p->common));
}

static void print(const char *what, struct job *job, const struct job *unit, const struct effort *effort)
{
    probe_job(job);
    const struct timing t = time_job(job, unit, effort);
    printf("| %s | %.3g us | %.3g (%.3g to %.3g) |\n", what, 1e6 * t.seconds, t.ratio, t.low, t.high);
}

void compare_cholmod(size_t n, const struct effort *effort)
{
    struct contacts same, one, some;
    struct peer simplicial = {.calls = 0}, super = {.calls = 0};
    contacts_create(&same, CARPET, n, 1, SAME);
    contacts_create(&one, CARPET, n, 1, ONE);
    contacts_create(&some, CARPET, n, 1, SOME);
    struct job unit = {contacts_call, &same, 0.0}, ours_one = {contacts_call, &one, 0.0}, ours_some = {contacts_call, &some, 0.0};
    struct job factor = {factorize, &simplicial, 0.0}, solves = {solve, &simplicial, 0.0}, row = {change, &simplicial, 0.0};
    struct job super_factor = {factorize, &super, 0.0}, super_solve = {solve, &super, 0.0};
    contacts_count(&same, 4);
    contacts_count(&one, 4);
    contacts_count(&some, 4);
    check(&simplicial, cholmod_start(&simplicial.common));
    check(&super, cholmod_start(&super.common));
    set_matrix(&simplicial, &same, CHOLMOD_SIMPLICIAL);
    set_matrix(&super, &same, CHOLMOD_SUPERNODAL);
    probe_job(&unit);
    printf("\nCarpet of %zu contacts, in terms of a call of tribo_balance with the set unchanged (which solves once, and looks "
           "at all "
           "rows twice):\n\n| what | time | ratio |\n|---|---|---|\n",
           n);
    print("tribo_balance, one change", &ours_one, &unit, effort);
    print("tribo_balance, new factor over 95 or 100% of the contacts", &ours_some, &unit, effort);
    print("CHOLMOD, simplicial, new factor", &factor, &unit, effort);
    print("CHOLMOD, supernodal, new factor", &super_factor, &unit, effort);
    print("CHOLMOD, simplicial, solution", &solves, &unit, effort);
    print("CHOLMOD, supernodal, solution", &super_solve, &unit, effort);
    print("CHOLMOD, simplicial, one row deleted or added", &row, &unit, effort);
    contacts_destroy(&same);
    contacts_destroy(&one);
    contacts_destroy(&some);
    end(&simplicial);
    end(&super);
}
