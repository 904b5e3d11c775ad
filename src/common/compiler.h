/* Whether the compiler offers what GNU C does beyond C99: attributes and built-in functions. All of it has a plain fallback,
 * which TRIBO_PLAIN_C asks for. */
#ifndef TRIBO_COMPILER_H
#define TRIBO_COMPILER_H

#if defined(__GNUC__) && !defined(TRIBO_PLAIN_C)
#define TRIBO_GNU_C
#endif

#endif
