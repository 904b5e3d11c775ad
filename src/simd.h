/* Loops over contacts or degrees of freedom, compiled for more than one instruction set where the compiler and the system can choose among them
 * when the library is loaded. Every variant gives the same bits: nothing is reordered, and products and sums are not fused. */
#ifndef TRIBO_SIMD_H
#define TRIBO_SIMD_H

#if defined(TRIBO_CLONES)
#define TRIBO_SIMD __attribute__((target_clones("avx2", "default")))
#else
#define TRIBO_SIMD
#endif

#endif
