/* SPDX-License-Identifier: BSD-3-Clause */
/* Runs code that ends its program by exit, in the process of a fuzzer: the program's end comes back here, and what the code left
 * open or allocated is released. Files are parts of the fuzzer's string. Linked with --wrap for each name in ending.c. */
#ifndef TRIBO_FUZZ_ENDING_H
#define TRIBO_FUZZ_ENDING_H

#include <stddef.h>
#include <stdint.h>

/* What a path that ends so is read from; the last part is that of all other paths. */
struct part {
    const char *ending;
    const uint8_t *byte;
    size_t size;
};

void run_to_its_end(void (*run)(void), const struct part *part, size_t parts);

#endif
