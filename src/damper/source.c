/* SPDX-License-Identifier: BSD-3-Clause */
#include "text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(DAMPER_ZLIB)
#include <zlib.h>
#endif

enum { BLOCK = 1 << 16 };

struct source {
    FILE *file;
    size_t at, end;
    const char *error;
    unsigned char byte[BLOCK];
#if defined(DAMPER_ZLIB)
    int packed;  /* members of gzip's format, one behind the other */
    int between; /* members */
    z_stream stream;
    unsigned char unread[BLOCK];
#endif
};

static size_t read_block(struct source *s, unsigned char *byte)
{
    const size_t count = fread(byte, 1, BLOCK, s->file);
    s->error = ferror(s->file) ? strerror(errno) : s->error;
    return count;
}

#if defined(DAMPER_ZLIB)

static int refill(struct source *s)
{
    s->stream.next_in = s->unread;
    s->stream.avail_in = (uInt)read_block(s, s->unread);
    return s->stream.avail_in > 0;
}

/* Of a file that is cut off, or has other bytes behind its members, reads the bytes that are there, and sets the error. */
static size_t unpack(struct source *s)
{
    s->stream.next_out = s->byte;
    s->stream.avail_out = BLOCK;
    while (!s->error && s->stream.avail_out == BLOCK && (s->stream.avail_in > 0 || refill(s))) {
        if (s->between) {
            inflateReset(&s->stream);
        }
        const int status = inflate(&s->stream, Z_NO_FLUSH);
        if (status != Z_OK && status != Z_STREAM_END) {
            s->error = s->between ? "other bytes behind its compressed ones" : s->stream.msg ? s->stream.msg : zError(status);
        }
        s->between = status == Z_STREAM_END;
    }
    const size_t count = BLOCK - s->stream.avail_out;
    s->error = !s->error && count == 0 && !s->between ? "unexpected end of file" : s->error;
    return count;
}

#endif

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
    s->file = fopen(path, "rb");
    die_if(!s->file, "cannot open %s: %s", path, strerror(errno));
    if (ends_with(path, strlen(path), ".gz")) {
#if defined(DAMPER_ZLIB)
        const int first = getc(s->file), second = getc(s->file);
        rewind(s->file);
        s->packed = first == 0x1f && second == 0x8b;
        die_if(s->packed && inflateInit2(&s->stream, 16 + MAX_WBITS) != Z_OK, "%s: out of memory", path);
#else
        die("%s is compressed, and this program has been built without zlib (Debian: zlib1g-dev): gunzip the file, or build "
            "again",
            path);
#endif
    }
    return s;
}

void close_source(struct source *s)
{
#if defined(DAMPER_ZLIB)
    if (s->packed) {
        inflateEnd(&s->stream);
    }
#endif
    fclose(s->file);
    free(s);
}

int next_byte(struct source *s, const char **error)
{
    if (s->at == s->end) {
        s->at = 0;
#if defined(DAMPER_ZLIB)
        s->end = s->error ? 0 : s->packed ? unpack(s) : read_block(s, s->byte);
#else
        s->end = s->error ? 0 : read_block(s, s->byte);
#endif
    }
    *error = s->at < s->end ? NULL : s->error;
    return s->at < s->end ? s->byte[s->at++] : -1;
}
