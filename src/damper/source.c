/* SPDX-License-Identifier: BSD-3-Clause */
#include "source.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"

enum { BLOCK = 1 << 16 };

struct source {
    void *file; /* FILE or struct packed */
    size_t (*read)(struct source *s);
    void (*close)(void *file);
    size_t at, end;
    const char *error;
    unsigned char byte[BLOCK];
};

/* ------------------------------------------------------------------------------------------------------------- as it is */

static size_t read_plain(struct source *s)
{
    const size_t count = fread(s->byte, 1, BLOCK, s->file);
    s->error = ferror((FILE *)s->file) ? strerror(errno) : NULL;
    return count;
}

static void close_plain(void *file)
{
    fclose(file);
}

static void open_plain(struct source *s, const char *path)
{
    s->file = fopen(path, "rb");
    s->read = read_plain;
    s->close = close_plain;
}

/* ------------------------------------------------------------------------------------------------------------ compressed */

#if defined(DAMPER_ZLIB)
#include <zlib.h>

/* Members of gzip's format, one behind the other; or a file that is not compressed in spite of its name. */
struct packed {
    FILE *file;
    z_stream stream;
    int between; /* members */
    unsigned char byte[BLOCK];
};

static int refill(struct packed *p)
{
    p->stream.next_in = p->byte;
    p->stream.avail_in = (uInt)fread(p->byte, 1, BLOCK, p->file);
    return p->stream.avail_in > 0;
}

/* Of a file that is cut off, or has other bytes behind its members, reads the bytes that are there, and sets the error. */
static size_t read_packed(struct source *s)
{
    struct packed *p = s->file;
    p->stream.next_out = s->byte;
    p->stream.avail_out = BLOCK;
    while (!s->error && p->stream.avail_out == BLOCK && (p->stream.avail_in > 0 || refill(p))) {
        if (p->between) {
            inflateReset(&p->stream);
        }
        const int status = inflate(&p->stream, Z_NO_FLUSH);
        if (status != Z_OK && status != Z_STREAM_END) {
            s->error = p->between ? "other bytes behind its compressed ones" : p->stream.msg ? p->stream.msg : zError(status);
        }
        p->between = status == Z_STREAM_END;
    }
    const size_t count = BLOCK - p->stream.avail_out;
    if (!s->error && count == 0) {
        s->error = ferror(p->file) ? strerror(errno) : p->between ? NULL : "unexpected end of file";
    }
    return count;
}

static void close_packed(void *file)
{
    struct packed *p = file;
    inflateEnd(&p->stream);
    fclose(p->file);
    free(p);
}

static void open_packed(struct source *s, const char *path)
{
    open_plain(s, path);
    if (!s->file) {
        return;
    }
    const int first = getc(s->file), second = getc(s->file);
    rewind(s->file);
    if (first == 0x1f && second == 0x8b) {
        struct packed *p = need_memory(1, sizeof *p);
        memset(p, 0, sizeof *p);
        p->file = s->file;
        if (inflateInit2(&p->stream, 16 + MAX_WBITS) != Z_OK) {
            die("%s: out of memory", path);
        }
        s->file = p;
        s->read = read_packed;
        s->close = close_packed;
    }
}
#else
static void open_packed(struct source *s, const char *path)
{
    (void)s;
    die("%s is compressed, and this program has been built without zlib (Debian: zlib1g-dev): gunzip the file, or build again",
        path);
}
#endif

/* ----------------------------------------------------------------------------------------------------------------- calls */

static int ends_with(const char *path, size_t length, const char *ending)
{
    const size_t own = strlen(ending);
    return length > own && memcmp(path + length - own, ending, own) == 0;
}

int is_named(const char *path, const char *ending)
{
    const size_t length = strlen(path);
    return ends_with(path, ends_with(path, length, ".gz") ? length - 3 : length, ending);
}

struct source *open_source(const char *path)
{
    struct source *s = need_memory(1, sizeof *s);
    (ends_with(path, strlen(path), ".gz") ? open_packed : open_plain)(s, path);
    if (!s->file) {
        die("cannot open %s: %s", path, strerror(errno));
    }
    return s;
}

void close_source(struct source *s)
{
    s->close(s->file);
    free(s);
}

int next_byte(struct source *s, const char **error)
{
    if (s->at == s->end) {
        s->at = 0;
        s->end = s->error ? 0 : s->read(s);
    }
    *error = s->at < s->end ? NULL : s->error;
    return s->at < s->end ? s->byte[s->at++] : -1;
}
