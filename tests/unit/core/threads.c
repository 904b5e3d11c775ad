/* SPDX-License-Identifier: BSD-3-Clause */
/* What the header promises to threads: calls on a const context may share it; everything else wants a context a thread, and may
 * then run side by side. */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "problem.h"

enum { THREADS = 4, ROUNDS = 200 };

/* The work of a thread, and whether all that it saw was as it should be: assertions are for the one thread of the test. */
struct job {
    const tribo_context *shared;
    tribo_context *own;
    const struct problem *p;
    int number, good;
    double f[LARGEST], dv[LARGEST];
    double sum; /* of the forces that a context of its own finds */
};

static void run_threads(struct job *job, void *(*work)(void *))
{
    pthread_t thread[THREADS];
    for (size_t k = 0; k < THREADS; k++) {
        ck_assert_int_eq(pthread_create(&thread[k], NULL, work, &job[k]), 0);
    }
    for (size_t k = 0; k < THREADS; k++) {
        ck_assert_int_eq(pthread_join(thread[k], NULL), 0);
    }
}

#if defined(__GNUC__) && !defined(TRIBO_PLAIN_C)
#define COUNTS_CLONES 1
#else
#define COUNTS_CLONES 0 /* copies are made and destroyed by one thread at a time */
#endif

static double sum_of_balances(tribo_context *c, const struct problem *p, int number)
{
    struct random g = random_of(number);
    double a[LARGEST], f[LARGEST], feq[LARGEST], sum = 0.0;
    for (int k = 0; k < ROUNDS; k++) {
        for (size_t i = 0; i < p->n; i++) {
            a[i] = p->a[i] + uniform(&g, -1.0, 1.0);
        }
        sum += k % 2 ? tribo_balance(c, p->v, a, feq, f) : tribo_step_force(c, 0.5, a, f);
        for (size_t i = 0; i < p->n; i++) {
            sum += f[i];
        }
        sum += k % 9 ? 0.0 : tribo_set_limit(c, p->limit);
    }
    return sum;
}

/* Every call that takes a const context, good and bad ones; a copy is one of them. */
static void *share(void *data)
{
    struct job *j = data;
    const tribo_context *c = j->shared;
    const size_t n = j->p->n;
    double f[LARGEST], dv[LARGEST], x[LARGEST], bad[LARGEST] = {NAN};
    signed char slip[LARGEST];
    j->good = 1;
    for (int k = 0; k < ROUNDS; k++) {
        tribo_context *own;
        size_t count;
        int number;
        j->good &= tribo_force(c, j->p->v, j->p->a, f) == TRIBO_OK && !memcmp(f, j->f, n * sizeof *f);
        j->good &= tribo_force_tangent(c, j->p->v, j->p->a, f, dv, NULL, NULL) == TRIBO_OK && !memcmp(dv, j->dv, n * sizeof *dv);
        j->good &= tribo_force(c, bad, j->p->a, f) == TRIBO_ERR_NOT_FINITE;
        j->good &= tribo_get_limit(c, x) == TRIBO_OK && tribo_get_epsilon(c, x) == TRIBO_OK;
        j->good &= tribo_get_law(c, &number) == TRIBO_OK && tribo_get_coupling(c, &number) == TRIBO_OK;
        j->good &= tribo_get_ncontact(c, &count) == TRIBO_OK && tribo_get_sharing(c, &number) == TRIBO_OK;
        j->good &= tribo_get_slip(c, slip) == TRIBO_OK && tribo_get_count(c, TRIBO_COUNT_STUCK, &count) == TRIBO_OK;
        j->good &= tribo_get_real(c, TRIBO_REAL_MAX_RATE, x) == TRIBO_OK && tribo_get_count(c, -1, &count) == TRIBO_ERR_RANGE;
        if (COUNTS_CLONES && k % 20 == 0) {
            j->good &= tribo_clone(c, &own) == TRIBO_OK;
            j->sum = sum_of_balances(own, j->p, 7);
            tribo_destroy(own);
        }
    }
    return NULL;
}

TEST(shared_context)
{
    struct random g = random_of(_i);
    const struct recipe recipe = recipe_regular(&g, 20);
    const struct problem p = problem_create(&g, &recipe);
    static struct job job[THREADS];
    tribo_context *c = problem_context(&p, TRIBO_QUINN, _i % 2), *copy;
    assert_ok(tribo_balance(c, p.v, p.a, NULL, job[0].f));
    assert_ok(tribo_force_tangent(c, p.v, p.a, job[0].f, job[0].dv, NULL, NULL));
    assert_status(tribo_set_law(c, 999), TRIBO_ERR_RANGE);
    assert_ok(tribo_clone(c, &copy));
    const double want = sum_of_balances(copy, &p, 7);
    for (size_t k = 0; k < THREADS; k++) {
        job[k] = job[0];
        job[k].shared = c;
        job[k].p = &p;
    }
    run_threads(job, share);
    for (size_t k = 0; k < THREADS; k++) {
        ck_assert(job[k].good);
        assert_exact(COUNTS_CLONES ? job[k].sum : want, want);
    }
    ck_assert_str_eq(tribo_message(c), "law = 999 is none of the 6 laws"); /* calls on a const context leave no message */
    tribo_destroy(copy);
    tribo_destroy(c);
}

static void *work_alone(void *data)
{
    struct job *j = data;
    tribo_context *c;
    j->good = tribo_create(&c, j->p->n) == TRIBO_OK && tribo_set_limit(c, j->p->limit) == TRIBO_OK &&
              tribo_set_epsilon(c, j->p->epsilon) == TRIBO_OK && tribo_set_operator_dense(c, j->p->r) == TRIBO_OK;
    j->sum = sum_of_balances(c, j->p, j->number);
    tribo_destroy(c);
    return NULL;
}

/* Threads with contexts of their own find what one thread finds. */
TEST(own_contexts)
{
    struct random g = random_of(_i);
    const struct recipe recipe = recipe_random(&g, USUAL, 0.5);
    const struct problem p = problem_create(&g, &recipe);
    struct job job[THREADS], serial[THREADS];
    for (int k = 0; k < THREADS; k++) {
        job[k] = serial[k] = (struct job){.p = &p, .number = k};
        work_alone(&serial[k]);
    }
    run_threads(job, work_alone);
    for (size_t k = 0; k < THREADS; k++) {
        ck_assert(job[k].good);
        assert_exact(job[k].sum, serial[k].sum);
    }
}

/* Gives a clone up over and over: its last operator belongs to nobody else. */
static void *work_on_clone(void *data)
{
    struct job *j = data;
    tribo_context *c = j->own;
    j->good = 1;
    for (int k = 0; k < ROUNDS; k++) {
        tribo_context *next;
        j->good &= tribo_clone(c, &next) == TRIBO_OK;
        tribo_destroy(c);
        c = next;
    }
    j->sum = sum_of_balances(c, j->p, 7);
    j->good &= tribo_set_operator_diagonal(c, j->p->epsilon) == TRIBO_OK;
    tribo_destroy(c);
    return NULL;
}

/* An operator lives as long as any clone that has it, whoever made it and whichever thread is the last. */
TEST(clones)
{
    struct random g = random_of(_i);
    const struct recipe recipe = recipe_regular(&g, 20);
    const struct problem p = problem_create(&g, &recipe);
    struct job job[THREADS];
    tribo_context *c = problem_context(&p, TRIBO_QUINN, _i % 2), *copy;
    assert_status(tribo_set_law(c, 999), TRIBO_ERR_RANGE);
    assert_ok(tribo_clone(c, &copy));
    const double want = sum_of_balances(copy, &p, 7);
    for (size_t k = 0; k < THREADS; k++) {
        job[k] = (struct job){.p = &p};
        assert_ok(tribo_clone(c, &job[k].own));
    }
    tribo_destroy(c);
    if (COUNTS_CLONES) {
        run_threads(job, work_on_clone);
    }
    for (size_t k = 0; k < THREADS; k++) {
        if (!COUNTS_CLONES) {
            work_on_clone(&job[k]);
        }
        ck_assert(job[k].good);
        assert_exact(job[k].sum, want);
    }
    tribo_destroy(copy);
}

TEST_MAIN("threads", {shared_context, 4}, {own_contexts, 6}, {clones, 4})
