/* Outputs found in chunks of at most TRIBO_CHUNK numbers. Long ones are written to memory past the caches, which would read each
 * line before: whole lines, the rest waits for the next chunk. */
#ifndef TRIBO_STREAM_H
#define TRIBO_STREAM_H

#include "simd.h"

#if defined(TRIBO_GNU_C) && defined(__SSE2__)
#include <immintrin.h>
#define TRIBO_STREAMS
#endif

struct stream {
    double *to;  /* place of the next number; NULL: no output */
    int past;    /* 1: past the caches; 0: numbers are found in their place */
    size_t kept; /* numbers at the begin of room that wait for the rest of their line */
    double room[TRIBO_CHUNK + 2 * TRIBO_LINE];
};

static inline void tribo_stream_begin(struct stream *s, double *to, int past)
{
    s->to = to;
    s->past = past;
    s->kept = 0;
}

/* Returns room for the numbers of the next chunk. */
static inline double *tribo_stream_room(struct stream *s)
{
    return s->to && !s->past ? s->to : tribo_aligned(s->room) + s->kept;
}

/* One store writes a line of cache. */
#if defined(TRIBO_STREAMS) && defined(TRIBO_CLONES_512)
__attribute__((target("avx512f"))) static void tribo_stream_wide(double *to, const double *from, size_t n)
{
    for (size_t i = 0; i < n; i += TRIBO_LINE) {
        _mm512_stream_pd(to + i, _mm512_loadu_pd(from + i));
    }
}
#endif

/* Writes n numbers, whole lines. */
static inline void tribo_stream_lines(double *to, const double *from, size_t n)
{
#if defined(TRIBO_STREAMS) && defined(TRIBO_CLONES_512)
    if (__builtin_cpu_supports("avx512f")) {
        tribo_stream_wide(to, from, n);
        return;
    }
#endif
#if defined(TRIBO_STREAMS)
    for (size_t i = 0; i < n; i += 2) {
        _mm_stream_pd(to + i, _mm_loadu_pd(from + i));
    }
#else
    memcpy(to, from, n * sizeof *to);
#endif
}

/* Writes the n numbers in the room. */
static inline void tribo_stream_put(struct stream *s, size_t n)
{
    if (!s->to || !s->past) {
        s->to += s->to ? n : 0;
        return;
    }
    double *room = tribo_aligned(s->room), *from = room, *end = room + s->kept + n;
    while (from < end && (uintptr_t)s->to % (TRIBO_LINE * sizeof *s->to) > 0) {
        *s->to++ = *from++;
    }
    const size_t lines = (size_t)(end - from) / TRIBO_LINE * TRIBO_LINE;
    tribo_stream_lines(s->to, from, lines);
    s->to += lines;
    s->kept = (size_t)(end - from) - lines;
    memmove(room, from + lines, s->kept * sizeof *room);
}

/* Writes the rest; other threads see all numbers. */
static inline void tribo_stream_end(struct stream *s)
{
    if (s->to && s->past) {
        memcpy(s->to, tribo_aligned(s->room), s->kept * sizeof *s->to);
#if defined(TRIBO_STREAMS)
        _mm_sfence();
#endif
    }
}

#endif
