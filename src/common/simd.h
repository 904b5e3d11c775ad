/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops compiled for several instruction sets, if compiler and system can choose one when the library is loaded. All variants
 * give the same bits: sums are not reordered, products and sums not fused. Call such functions by name only: linkers for 32 bits
 * have no addresses of static functions. */
#ifndef TRIBO_SIMD_H
#define TRIBO_SIMD_H

#include <stddef.h>
#include <stdint.h>

#include "compiler.h"

#if defined(TRIBO_CLONES_512)
#define TRIBO_SIMD __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#elif defined(TRIBO_CLONES)
#define TRIBO_SIMD __attribute__((target_clones("avx2", "default")))
#else
#define TRIBO_SIMD
#endif

/* TRIBO_SIMD for sums of four numbers at a time; compilers make slow code of these sums for wider vectors. */
#if defined(TRIBO_CLONES) || defined(TRIBO_CLONES_512)
#define TRIBO_SIMD_OF_FOUR __attribute__((target_clones("avx2", "default")))
#else
#define TRIBO_SIMD_OF_FOUR
#endif

/* Stands before a loop with a short body: GCC unrolls the loop 4 times. Clang unrolls such loops without it. */
#if defined(TRIBO_GNU_C) && !defined(__clang__)
#define TRIBO_UNROLLED _Pragma("GCC unroll 4")
#else
#define TRIBO_UNROLLED
#endif

/* Before a loop over arrays that do not overlap, where restrict on pointers in a struct has no effect. Clang compares the
 * addresses before the loop. */
#if defined(TRIBO_GNU_C) && !defined(__clang__)
#define TRIBO_APART _Pragma("GCC ivdep")
#else
#define TRIBO_APART
#endif

/* Contacts in a chunk: few enough that most chunks of a large scene have no contact near stick, and that the data of a chunk fit
 * in the first-level cache. */
#define TRIBO_CHUNK 128

/* Returns the size of the chunk that begins at i, of n contacts. */
static inline size_t tribo_chunk_from(size_t n, size_t i)
{
    return n - i < TRIBO_CHUNK ? n - i : TRIBO_CHUNK;
}

/* Returns x rounded up to the start of a cache line, by at most TRIBO_LINE - 1 numbers: no vector of the array crosses lines. */
enum { TRIBO_LINE = 8 };
static inline double *tribo_aligned(double *x)
{
    enum { BYTES = TRIBO_LINE * sizeof *x };
    return x ? x + (BYTES - (uintptr_t)x % BYTES) % BYTES / sizeof *x : NULL;
}

#endif
