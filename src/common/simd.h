/* Loops over contacts or degrees of freedom, compiled for more than one instruction set where the compiler and the system can
 * choose among them when the library is loaded. Every variant gives the same bits: nothing is reordered, and products and sums
 * are not fused. Such functions are called by name only: in 32 bits linkers know no addresses of static ones. */
#ifndef TRIBO_SIMD_H
#define TRIBO_SIMD_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "compiler.h"

#if defined(TRIBO_CLONES_512)
#define TRIBO_SIMD __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#elif defined(TRIBO_CLONES)
#define TRIBO_SIMD __attribute__((target_clones("avx2", "default")))
#else
#define TRIBO_SIMD
#endif

/* The same for sums of four numbers at a time, of which compilers make nothing good where vectors are wider. */
#if defined(TRIBO_CLONES) || defined(TRIBO_CLONES_512)
#define TRIBO_SIMD_OF_FOUR __attribute__((target_clones("avx2", "default")))
#else
#define TRIBO_SIMD_OF_FOUR
#endif

/* Before a loop that does next to nothing with each number, where counting them would take as long; clang does so unasked. */
#if defined(TRIBO_GNU_C) && !defined(__clang__)
#define TRIBO_UNROLLED _Pragma("GCC unroll 4")
#else
#define TRIBO_UNROLLED
#endif

/* Before a loop over arrays that share no memory, where restrict on pointers of a struct is not enough. */
#if defined(TRIBO_GNU_C) && !defined(__clang__)
#define TRIBO_APART _Pragma("GCC ivdep")
#elif defined(__clang__)
#define TRIBO_APART _Pragma("clang loop vectorize(assume_safety)")
#else
#define TRIBO_APART
#endif

/* Contacts that are looked at together: few enough that in a large scene most chunks have none near stick, and all that is read
 * of them stays in the first-level cache. */
#define TRIBO_CHUNK 128

/* Where a line of cache begins, so that no vector of an array lies in two: at most TRIBO_LINE - 1 numbers on. */
enum { TRIBO_LINE = 8 };
static inline double *tribo_aligned(double *x)
{
    enum { BYTES = TRIBO_LINE * sizeof *x };
    return x ? x + (BYTES - (uintptr_t)x % BYTES) % BYTES / sizeof *x : NULL;
}

/* These bytes will soon be read, or written: for memory that is far away, and not simply passed over. */
static inline void tribo_expect(const void *from, size_t bytes, int written)
{
#if defined(TRIBO_GNU_C)
    enum { LINE = 64 };
    for (size_t i = 0; i < bytes; i += LINE) {
        if (written) {
            __builtin_prefetch((const char *)from + i, 1);
        } else {
            __builtin_prefetch((const char *)from + i, 0);
        }
    }
#else
    (void)from, (void)bytes, (void)written;
#endif
}

#endif
