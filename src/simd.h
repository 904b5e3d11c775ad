/* Loops over contacts or degrees of freedom, compiled for more than one instruction set where the compiler and the system can
 * choose among them when the library is loaded. Every variant gives the same bits: nothing is reordered, and products and sums
 * are not fused. */
#ifndef TRIBO_SIMD_H
#define TRIBO_SIMD_H

#include <stddef.h>

#if defined(TRIBO_CLONES)
#define TRIBO_SIMD __attribute__((target_clones("avx2", "default")))
#else
#define TRIBO_SIMD
#endif

/* x [n] will soon be read, or written: what the memory needs to know where loops do more than pass over it. */
static inline void tribo_expect(const double *x, size_t n, int written)
{
#if defined(__GNUC__)
    enum { LINE = 8 };
    for (size_t i = 0; i < n; i += LINE) {
        if (written) {
            __builtin_prefetch(x + i, 1);
        } else {
            __builtin_prefetch(x + i, 0);
        }
    }
#else
    (void)x, (void)n, (void)written;
#endif
}

#endif
