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

/* Without threads of POSIX this thread does all jobs, and shows no progress. */
#if defined(TEAM_POSIX)
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
#define BEGIN_ALONE() pthread_mutex_lock(&lock)
#define END_ALONE() pthread_mutex_unlock(&lock)
#define ON_TERMINAL() isatty(STDERR_FILENO)
#else
#define BEGIN_ALONE() (void)0
#define END_ALONE() (void)0
#define ON_TERMINAL() 0
#endif

/* ---------------------------------------------------------------------------------------------------------------- jobs */

/* Jobs to do: next to jobs - 1. */
struct queue {
    size_t next, jobs;
    job *run;
    void *data;
};

static void *work(void *data)
{
    struct queue *q = data;
    for (;;) {
        BEGIN_ALONE();
        const size_t k = q->next < q->jobs && !stop ? q->next++ : q->jobs;
        END_ALONE();
        if (k == q->jobs) {
            return NULL;
        }
        q->run(q->data, k);
    }
}

/* This thread works too, alone if no other can be created. */
void run_jobs(size_t threads, size_t jobs, job *run, void *data)
{
    struct queue q = {.jobs = jobs, .run = run, .data = data};
#if defined(TEAM_POSIX)
    enum { MOST_THREADS = 64 };
    pthread_t helper[MOST_THREADS];
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    size_t helpers = 0;
    threads = threads ? threads : cores > 1 ? (size_t)cores : 1;
    while (helpers + 1 < threads && helpers + 1 < jobs && helpers < MOST_THREADS &&
           pthread_create(&helper[helpers], NULL, work, &q) == 0) {
        helpers++;
    }
    work(&q);
    while (helpers > 0) {
        pthread_join(helper[--helpers], NULL);
    }
#else
    (void)threads;
    work(&q);
#endif
}

/* ------------------------------------------------------------------------------------------------------------- progress */

static size_t points;
static const char blank[] = "                                                                      ";

void show_point(void)
{
    BEGIN_ALONE();
    points++;
    if (ON_TERMINAL()) {
        fprintf(stderr, "\r%s\r%s: %zu points", blank, program, points);
    }
    END_ALONE();
}

void show_march(double limit, double hz, size_t periods, double change)
{
    BEGIN_ALONE();
    if (ON_TERMINAL()) {
        fprintf(stderr, "\r%s\r%s: %zu points; marching at %.4g, %.5g Hz: %zu periods, changing by %.1e", blank, program, points,
                limit, hz, periods, change);
    }
    END_ALONE();
}

void end_progress(void)
{
    if (ON_TERMINAL()) {
        fprintf(stderr, "\r%s\r", blank);
    }
}
