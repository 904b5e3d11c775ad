#ifndef DAMPER_TEAM_H
#define DAMPER_TEAM_H

#include <stddef.h>

/* Jobs for as many threads as there are cores, told about on a terminal, ended by Ctrl-C. */

/* Does job k of data. */
typedef void job(void *data, size_t k);

/* Runs all jobs, on at most that many threads, 0 for one a core; returns when they are done. What a job gives must not depend on
 * which thread it runs in, and when. */
void run_jobs(size_t threads, size_t jobs, job *run, void *data);

/* To be called once, at first: from then on Ctrl-C is remembered instead of ending the program; a second one ends it. */
void watch_interrupts(void);

/* Whether the user wants no more: a job that sees this leaves what it has, and returns. */
int interrupted(void);

/* A point has been found, or not: shown where stderr is a terminal. */
void tell_point(void);

/* A motion is being marched: periods so far, and the relative change of the last one. Shown as tell_point is. */
void tell_march(double limit, double hz, size_t periods, double change);

/* Takes what is shown away. */
void end_telling(void);

#endif
