/* Contexts by number, for Fortran: see handle.c. */
#ifndef TRIBO_HANDLE_H
#define TRIBO_HANDLE_H

#include <stdint.h>

#include "tribo/tribo.h"

/* A number for ctx, > 0; 0 if memory runs out. */
TRIBO_API int64_t tribo_handle_add(tribo_context *ctx);

/* The context of a number, NULL if it has none; any number may be asked for. */
TRIBO_API tribo_context *tribo_handle_get(int64_t number);

/* The same, and from now on the number has none. Destroys nothing. */
TRIBO_API tribo_context *tribo_handle_remove(int64_t number);

/* How many contexts have a number now. */
TRIBO_API uint32_t tribo_handle_count(void);

#endif
