/* SPDX-License-Identifier: BSD-3-Clause */
/* Shared by the tool and the larger examples: errors that end the program, files in the folder of results, and named values, from
 * which run.sh makes its closing table. */
#ifndef DAMPER_OUTPUT_H
#define DAMPER_OUTPUT_H

#include <stdio.h>

#if defined(__GNUC__)
#define PRINTF_LIKE(at) __attribute__((format(printf, at, at + 1)))
#else
#define PRINTF_LIKE(at)
#endif

/* Prints "program: ..." to stderr and exits with 1; main sets program. die_if(wrong, format, ...) does so if wrong is not 0, and
 * evaluates format and the values behind it in this case only. */
extern const char *program;
void die(const char *format, ...) PRINTF_LIKE(1);
#define die_if(wrong, ...) ((wrong) ? die(__VA_ARGS__) : (void)0)

/* Ends the program if a call of the library failed; detail is the message that belongs to it, or NULL. */
void need(int status, const char *detail);

/* calloc that ends the program instead of failing. */
void *need_memory(size_t count, size_t size);

/* Room for one element of that size more than the count that an array holds, which has grown by such calls from NULL: the array,
 * moved where that is needed. */
void *need_room(void *array, size_t count, size_t size);

/* printf into memory of its own. */
char *new_text(const char *format, ...) PRINTF_LIKE(1);

/* Creates folder/name; ends the program if it cannot. */
FILE *create_file(const char *folder, const char *name);

/* Closes a file that was written to; ends the program if it could not be written. */
void close_file(FILE *file, const char *name);

/* One line "key value", all digits. */
void write_value(FILE *file, double value, const char *key, ...) PRINTF_LIKE(3);

#endif
