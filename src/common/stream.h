/* SPDX-License-Identifier: BSD-3-Clause */
/* Writes outputs computed in chunks of at most TRIBO_CHUNK numbers. Large outputs bypass the caches, which would read each line
 * before a write: only whole lines are written, the rest waits for the next chunk. */
#ifndef TRIBO_STREAM_H
#define TRIBO_STREAM_H

#include "simd.h"

#if defined(TRIBO_GNU_C) && defined(__SSE2__)
#include <immintrin.h>
#define TRIBO_STREAMS
#endif

struct stream {
    double *to;  /* address of the next number; NULL: no output */
    int past;    /* 1: bypasses the caches; 0: numbers are computed in place */
    size_t kept; /* numbers at the start of room, waiting for the rest of their line */
    double room[TRIBO_CHUNK + 2 * TRIBO_LINE];
};

static inline void tribo_stream_begin(struct stream *s, double *to, int past)
{
    s->to = to;
    s->past = past;
    s->kept = 0;
}

/* Returns the memory for the numbers of the next chunk. */
static inline double *tribo_stream_room(struct stream *s)
{
    return s->to && !s->past ? s->to : tribo_aligned(s->room) + s->kept;
}

/* Writes n numbers; n is a multiple of TRIBO_LINE. */
static inline void tribo_stream_lines(double *to, const double *from, size_t n)
{
#if defined(TRIBO_STREAMS)
    for (size_t i = 0; i < n; i += 2) {
        _mm_stream_pd(to + i, _mm_loadu_pd(from + i));
    }
#else
    memcpy(to, from, n * sizeof *to);
#endif
}

/* Outputs the n numbers in tribo_stream_room. */
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

/* Writes the waiting numbers; makes all numbers visible to other threads. */
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
