/* SPDX-License-Identifier: BSD-3-Clause */
/* Objects by number, for Fortran: see handle.c. */
#ifndef TRIBO_HANDLE_H
#define TRIBO_HANDLE_H

#include <stddef.h>
#include <stdint.h>

#include "tribo/tribo.h"

/* For interface.awk: a pure function of Fortran's, with which arrays may be declared. */
#define TRIBO_PURE

/* A number > 0 for object; 0 if memory or numbers run out. destroy releases the object when its number is dropped, and may be
 * NULL. */
TRIBO_API int64_t tribo_handle_add(void *object, void (*destroy)(void *));

/* The same with a number from -INT32_MAX to -1, whose opposite fits an integer of four bytes. */
TRIBO_API int64_t tribo_handle_add_short(void *object, void (*destroy)(void *));

/* The same for an object that is part of owner; destroy releases owner. */
TRIBO_API int64_t tribo_handle_add_part(void *object, void *owner, void (*destroy)(void *));

/* The owner of the object of a number; NULL if it is no part of another one, or the number has none. */
TRIBO_API TRIBO_PURE void *tribo_handle_owner(int64_t number);

/* The object of any number, NULL if it has none. */
TRIBO_API TRIBO_PURE void *tribo_handle_find(int64_t number);

/* Destroys the object of a number, if it has one. */
TRIBO_API void tribo_handle_drop(int64_t number);

/* Keeps text as the message of object, a context, if it has a number; text NULL: tribo_strerror(status). Returns status. */
TRIBO_API int tribo_handle_note(const void *object, int status, const char *text);

/* Copies the message of object to text [size], "" if there is none. */
TRIBO_API void tribo_handle_noted(const void *object, size_t size, char *text);

/* Returns the address of these three, which are the first members of what is there and stay as long as the program; equal ones
 * have one address. NULL if memory runs out. */
TRIBO_API void *tribo_handle_law(void (*law)(void), void *rpar, void *ipar);

/* Number of numbers with an object. */
TRIBO_API uint32_t tribo_handle_count(void);

#endif
