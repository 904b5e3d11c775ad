/* Loops over contacts or degrees of freedom, compiled for more than one instruction set where the compiler and the system can
 * choose among them when the library is loaded. Every variant gives the same bits: nothing is reordered, and products and sums
 * are not fused. */
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

/* A cache line holds so many numbers. Vectors that begin with one are read in half the time of such as lie across two. */
enum { TRIBO_LINE = 8 };

/* How many numbers from x on the next line begins, at most TRIBO_LINE. */
static inline size_t tribo_to_line(const double *x)
{
    return TRIBO_LINE - (size_t)((uintptr_t)x / sizeof *x % TRIBO_LINE);
}

/* So many bytes will soon be read, or written: for memory that is far away, and not simply passed over. */
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
