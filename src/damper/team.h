/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_TEAM_H
#define DAMPER_TEAM_H

#include <stddef.h>

/* Jobs on several threads, with progress on a terminal, ended by Ctrl-C. */

/* Does job k of data. */
typedef void job(void *data, size_t k);

/* Runs all jobs on at most `threads` threads, 0: one a core. Results of a job must not depend on the thread, nor on the order. */
void run_jobs(size_t threads, size_t jobs, job *run, void *data);

/* To be called once: from then on the first Ctrl-C sets interrupted(), the second one ends the program. */
void watch_interrupts(void);

/* 1 after Ctrl-C: a job then keeps its results so far, and returns. */
int interrupted(void);

/* A point has been searched: shown if stderr is a terminal. */
void show_point(void);

/* A motion is being marched: periods so far, and the relative change of the last one. Shown as show_point is. */
void show_march(double limit, double hz, size_t periods, double change);

/* Removes the progress from the terminal. */
void end_progress(void);

#endif
