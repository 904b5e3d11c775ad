/* SPDX-License-Identifier: BSD-3-Clause */
#define _POSIX_C_SOURCE 200809L
#include "ending.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <zlib.h>

enum { MOST = 1 << 14 };

static jmp_buf end;
static const struct part *files; /* NULL: no such code runs, and calls are the fuzzer's own */
static size_t file_count;

/* What the code holds now. */
struct held {
    void *what[MOST];
    size_t count;
};
static struct held memory, streams, opened;

static void hold(struct held *h, void *what)
{
    if (what && files && h->count == MOST) {
        abort();
    }
    if (what && files) {
        h->what[h->count++] = what;
    }
}

static void let_go(struct held *h, const void *what)
{
    for (size_t i = files ? h->count : 0; i-- > 0;) {
        if (h->what[i] == what) {
            h->what[i] = h->what[--h->count];
            return;
        }
    }
}

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *at, size_t size);
void __real_free(void *at);
FILE *__real_fopen(const char *path, const char *mode);
void __real_exit(int status);
int __real_fclose(FILE *file);
int __real_inflateInit2_(z_streamp stream, int bits, const char *version, int size);
int __real_inflateEnd(z_streamp stream);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *at, size_t size);
void __wrap_free(void *at);
void __wrap_exit(int status);
FILE *__wrap_fopen(const char *path, const char *mode);
int __wrap_fclose(FILE *file);
int __wrap_inflateInit2_(z_streamp stream, int bits, const char *version, int size);
int __wrap_inflateEnd(z_streamp stream);

void *__wrap_malloc(size_t size)
{
    void *at = __real_malloc(size);
    hold(&memory, at);
    return at;
}

void *__wrap_calloc(size_t count, size_t size)
{
    void *at = __real_calloc(count, size);
    hold(&memory, at);
    return at;
}

void *__wrap_realloc(void *at, size_t size)
{
    void *moved = __real_realloc(at, size);
    if (moved) {
        let_go(&memory, at);
        hold(&memory, moved);
    }
    return moved;
}

void __wrap_free(void *at)
{
    let_go(&memory, at);
    __real_free(at);
}

void __wrap_exit(int status)
{
    if (files) {
        longjmp(end, 1);
    }
    __real_exit(status);
}

FILE *__wrap_fopen(const char *path, const char *mode)
{
    if (!files) {
        return __real_fopen(path, mode);
    }
    const size_t length = strlen(path);
    const struct part *p = &files[file_count - 1];
    for (size_t k = 0; k + 1 < file_count; k++) {
        const size_t own = strlen(files[k].ending);
        if (length >= own && strcmp(path + length - own, files[k].ending) == 0) {
            p = &files[k];
            break;
        }
    }
    FILE *file = fmemopen((void *)(uintptr_t)p->byte, p->size, "rb");
    hold(&opened, file);
    return file;
}

int __wrap_fclose(FILE *file)
{
    let_go(&opened, file);
    return __real_fclose(file);
}

int __wrap_inflateInit2_(z_streamp stream, int bits, const char *version, int size)
{
    const int status = __real_inflateInit2_(stream, bits, version, size);
    hold(&streams, stream);
    return status;
}

int __wrap_inflateEnd(z_streamp stream)
{
    let_go(&streams, stream);
    return __real_inflateEnd(stream);
}

void run_to_its_end(void (*run)(void), const struct part *part, size_t parts)
{
    files = part;
    file_count = parts;
    if (setjmp(end) == 0) {
        run();
    }
    files = NULL;
    while (opened.count) {
        __real_fclose(opened.what[--opened.count]);
    }
    while (streams.count) {
        __real_inflateEnd(streams.what[--streams.count]);
    }
    while (memory.count) {
        __real_free(memory.what[--memory.count]);
    }
}
