/* SPDX-License-Identifier: BSD-3-Clause */
/* Allocations of the library counted, and made to fail. The linker puts these functions before malloc and its kin (--wrap), for
 * the objects that it links; the C library and GSL keep their own. */
#ifndef TRIBO_TESTS_MEMORY_H
#define TRIBO_TESTS_MEMORY_H

#include <stddef.h>

size_t memory_calls(void); /* allocations so far */
long memory_live(void);    /* blocks not freed */

/* From now on, the call-th allocation fails, and only that; 0: none. */
void memory_fail(size_t call);

/* There are no more bytes than these from now on, beside those that are allocated: allocations beyond fail. Counted are the sizes
 * asked for. */
void memory_bound(size_t bytes);
void memory_unbound(void);

/* The least bound with which an allocation that failed since would not have failed; 0: none failed. */
size_t memory_missed(void);

#endif
