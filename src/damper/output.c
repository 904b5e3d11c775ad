/* SPDX-License-Identifier: BSD-3-Clause */
#include "output.h"

#include <errno.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "tribo/tribo.h"

const char *program = "example";

void die(const char *format, ...)
{
    va_list args;
    fflush(stdout);
    fprintf(stderr, "%s: ", program);
    va_start(args, format);
    vfprintf(stderr, format, args);
    va_end(args);
    fputc('\n', stderr);
    exit(EXIT_FAILURE);
}

void need(int status, const char *detail)
{
    die_if(status, "%s%s%s", tribo_strerror(status), detail && *detail ? ": " : "", detail ? detail : "");
}

void *need_memory(size_t count, size_t size)
{
    void *memory = calloc(count ? count : 1, size);
    die_if(!memory, "out of memory for %zu times %zu bytes", count, size);
    return memory;
}

/* The room is the least power of two that holds count elements: it is full if count is 0 or a power of two. */
void *need_room(void *array, size_t count, size_t size)
{
    if (count & (count - 1)) {
        return array;
    }
    const size_t room = count ? 2 * count : 1;
    void *more = room <= SIZE_MAX / size ? realloc(array, room * size) : NULL;
    die_if(!more, "out of memory for %zu times %zu bytes", room, size);
    return more;
}

char *new_text(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    const int length = vsnprintf(NULL, 0, format, args);
    va_end(args);
    char *text = need_memory((size_t)length + 1, 1);
    va_start(args, format);
    vsnprintf(text, (size_t)length + 1, format, args);
    va_end(args);
    return text;
}

FILE *create_file(const char *folder, const char *name)
{
    char *path = new_text("%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    die_if(!file, "cannot create %s: %s", path, strerror(errno));
    free(path);
    return file;
}

void close_file(FILE *file, const char *name)
{
    const int failed = ferror(file);
    errno = 0;
    die_if(fclose(file) != 0 || failed, "cannot write %s%s%s", name, errno ? ": " : "", errno ? strerror(errno) : "");
}

void write_value(FILE *file, double value, const char *key, ...)
{
    va_list args;
    va_start(args, key);
    vfprintf(file, key, args);
    va_end(args);
    fprintf(file, " %.17g\n", value);
}
