/* SPDX-License-Identifier: BSD-3-Clause */
/* TRIBO_GNU_C: defined if the compiler has GNU C's attributes and built-in functions and TRIBO_PLAIN_C is not defined. Every use
 * has a plain alternative. */
#ifndef TRIBO_COMPILER_H
#define TRIBO_COMPILER_H

#if defined(__GNUC__) && !defined(TRIBO_PLAIN_C)
#define TRIBO_GNU_C
#endif

/* Adds change to x, shared by threads, and returns the new x. */
#if defined(TRIBO_GNU_C)
#define TRIBO_SHARED_ADD(x, change) __atomic_add_fetch(&(x), (change), __ATOMIC_ACQ_REL)
#else
#define TRIBO_SHARED_ADD(x, change) ((x) += (change))
#endif

#endif
