/* SPDX-License-Identifier: BSD-3-Clause */
/* The command line of tribo-damper: a line a word, and behind a line "=" the file that --read or a list of contacts names. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ending.h"
#include "options.h"

enum { WORDS = 40 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int count;
static char *word[WORDS + 1];

static void read_words(void)
{
    const struct options o = read_options(count, word);
    if (!o.mass || !o.stiffness || !o.dofs || !o.contacts.count || o.limits.from < 0.0 || !o.damping.count == !o.damping_matrix) {
        abort();
    }
    for (size_t k = 0; k < o.damping.count; k++) {
        if (!(o.damping.value[k] > 0.0 && o.damping.value[k] < 1.0)) {
            abort();
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char name[] = "tribo-damper";
    static int quiet;
    if (!quiet) {
        quiet = freopen("/dev/null", "w", stdout) != NULL;
    }
    char *text = malloc(size + 1);
    if (!text) {
        return -1;
    }
    memcpy(text, data, size);
    text[size] = '\0';
    char *file = strstr(text, "\n=\n");
    const struct part part = {"", (const uint8_t *)(file ? file + 3 : text + size), file ? size - (size_t)(file + 3 - text) : 0};
    if (file) {
        *file = '\0';
    }
    word[0] = name;
    count = 1;
    for (char *at = text; at && count < WORDS; count++) {
        word[count] = at;
        at = strchr(at, '\n');
        if (at) {
            *at++ = '\0';
        }
    }
    word[count] = NULL;
    run_to_its_end(read_words, &part, 1);
    free(text);
    return 0;
}
