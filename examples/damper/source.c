#include "source.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../common/output.h"

enum { BLOCK = 1 << 16 };

struct source {
    void *file; /* FILE or gzFile */
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

#if defined(EXAMPLES_ZLIB)
#include <zlib.h>

/* A file that is cut off gives what it has, and the error with it. */
static size_t read_packed(struct source *s)
{
    const int count = gzread(s->file, s->byte, BLOCK);
    int status;
    const char *text = gzerror(s->file, &status);
    s->error = status == Z_OK || status == Z_STREAM_END ? NULL : status == Z_ERRNO ? strerror(errno) : text;
    return count > 0 ? (size_t)count : 0;
}

static void close_packed(void *file)
{
    gzclose_r(file);
}

static void open_packed(struct source *s, const char *path)
{
    s->file = gzopen(path, "rb");
    s->read = read_packed;
    s->close = close_packed;
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
