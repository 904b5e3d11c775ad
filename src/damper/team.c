/* SPDX-License-Identifier: BSD-3-Clause */
#if defined(TEAM_POSIX)
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <unistd.h>
#endif

#include "team.h"

#include <signal.h>
#include <stdio.h>

#include "output.h"

static volatile sig_atomic_t stop;

static void on_interrupt(int number)
{
    stop = 1;
    signal(number, SIG_DFL);
}

void watch_interrupts(void)
{
    signal(SIGINT, on_interrupt);
}

int interrupted(void)
{
    return stop;
}

/* ---------------------------------------------------------------------------------------------------------------- jobs */

/* Jobs to do: next to jobs - 1. */
struct queue {
    size_t next, jobs;
    job *run;
    void *data;
};

#if defined(TEAM_POSIX)

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static void begin_alone(void)
{
    pthread_mutex_lock(&lock);
}

static void end_alone(void)
{
    pthread_mutex_unlock(&lock);
}

static int on_terminal(void)
{
    return isatty(STDERR_FILENO);
}

#else

static void begin_alone(void)
{
}

static void end_alone(void)
{
}

static int on_terminal(void)
{
    return 0;
}

#endif

static size_t take(struct queue *q)
{
    begin_alone();
    const size_t k = q->next < q->jobs && !stop ? q->next++ : q->jobs;
    end_alone();
    return k;
}

static void *work(void *data)
{
    struct queue *q = data;
    for (size_t k = take(q); k < q->jobs; k = take(q)) {
        q->run(q->data, k);
    }
    return NULL;
}

#if defined(TEAM_POSIX)

enum { MOST_THREADS = 64 };

/* This thread works too, alone if no other can be created. */
static void run_team(size_t threads, struct queue *q)
{
    pthread_t helper[MOST_THREADS];
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    size_t helpers = 0;
    threads = threads ? threads : cores > 1 ? (size_t)cores : 1;
    while (helpers + 1 < threads && helpers + 1 < q->jobs && helpers < MOST_THREADS &&
           pthread_create(&helper[helpers], NULL, work, q) == 0) {
        helpers++;
    }
    work(q);
    while (helpers > 0) {
        pthread_join(helper[--helpers], NULL);
    }
}

#else

static void run_team(size_t threads, struct queue *q)
{
    (void)threads;
    work(q);
}

#endif

void run_jobs(size_t threads, size_t jobs, job *run, void *data)
{
    struct queue q = {.jobs = jobs, .run = run, .data = data};
    run_team(threads, &q);
}

/* ------------------------------------------------------------------------------------------------------------- progress */

static size_t points;
static const char blank[] = "                                                                      ";

void show_point(void)
{
    begin_alone();
    points++;
    if (on_terminal()) {
        fprintf(stderr, "\r%s\r%s: %zu points", blank, program, points);
    }
    end_alone();
}

void show_march(double limit, double hz, size_t periods, double change)
{
    begin_alone();
    if (on_terminal()) {
        fprintf(stderr, "\r%s\r%s: %zu points; marching at %.4g, %.5g Hz: %zu periods, changing by %.1e", blank, program, points,
                limit, hz, periods, change);
    }
    end_alone();
}

void end_progress(void)
{
    if (on_terminal()) {
        fprintf(stderr, "\r%s\r", blank);
    }
}
