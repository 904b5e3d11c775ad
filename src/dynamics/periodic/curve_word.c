/* SPDX-License-Identifier: BSD-3-Clause */
/* Sequences of events, compared as rings: a period may begin anywhere. */
#include "curve.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Length of a phase, over that of the motion, below which it may come of rounding, as where a period begins at an event. */
#define BRIEF 1e-9

void tribo_word_free(struct word *w)
{
    free(w->letter);
    memset(w, 0, sizeof *w);
}

/* Appends a letter, turned = 1: with the other signs of slip, unless it is the last one, or with it the first one. */
static void append_letter(struct word *w, const signed char *slip, int turned)
{
    signed char *to = w->letter + w->letters * w->width;
    for (size_t i = 0; i < w->width; i++) {
        to[i] = turned && tribo_slides(slip[i]) && slip[i] != TRIBO_SLIP_PLANE ? (signed char)-slip[i] : slip[i];
    }
    w->letters += !w->letters || memcmp(to - w->width, to, w->width) != 0;
}

int tribo_word_read(struct word *w, const struct point *p, size_t width)
{
    const struct derivative *d = &p->derivative;
    double span = 0.0;
    for (size_t k = 0; k < d->steps; k++) {
        span += d->step[k].tau;
    }
    tribo_word_free(w);
    w->width = width;
    w->letter = malloc((2 * d->steps + 1) * (width + 1));
    for (int half = 0; w->letter && half <= p->odd; half++) {
        for (size_t k = 0; k < d->steps; k++) {
            if (d->step[k].slip && d->step[k].tau > BRIEF * span) {
                append_letter(w, d->step[k].slip, half);
            }
        }
    }
    if (w->letter && w->letters > 1 && memcmp(w->letter, w->letter + (w->letters - 1) * width, width) == 0) {
        w->letters--;
    }
    return w->letter != NULL;
}

/* to = the sequence of contact i alone. Returns its number of phases at rest. */
static size_t read_contact(struct word *to, const struct word *from, size_t i)
{
    to->letters = 0;
    to->width = 1;
    for (size_t k = 0; k < from->letters; k++) {
        append_letter(to, from->letter + k * from->width + i, 0);
    }
    to->letters -= to->letters > 1 && to->letter[0] == to->letter[to->letters - 1];
    size_t rests = 0;
    for (size_t k = 0; k < to->letters; k++) {
        rests += to->letter[k] == TRIBO_SLIP_STUCK;
    }
    return rests;
}

int tribo_word_equal(const struct word *a, const struct word *b)
{
    const size_t m = a->letters, width = a->width;
    for (size_t shift = 0; m == b->letters && shift < m; shift++) {
        const size_t head = (m - shift) * width;
        if (memcmp(a->letter + shift * width, b->letter, head) == 0 && memcmp(a->letter, b->letter + head, shift * width) == 0) {
            return 1;
        }
    }
    return m == 0 && b->letters == 0;
}

int tribo_word_change(const struct word *from, const struct word *to, size_t contacts, size_t *contact)
{
    int kind = TRIBO_POINT_ORDER;
    *contact = SIZE_MAX;
    struct word a = {.letter = malloc(from->letters + 1)}, b = {.letter = malloc(to->letters + 1)};
    for (size_t i = 0; a.letter && b.letter && i < from->width && *contact == SIZE_MAX; i++) {
        const size_t before = read_contact(&a, from, i), after = read_contact(&b, to, i);
        if (!tribo_word_equal(&a, &b)) {
            const int stuck = a.letters == 1 && before, sticks = b.letters == 1 && after; /* all the period */
            kind = stuck ? TRIBO_POINT_SLIDE : sticks || after > before ? TRIBO_POINT_STICK : TRIBO_POINT_GRAZE;
            kind = !stuck && !sticks && after < before ? TRIBO_POINT_SLIDE : kind;
            kind = i < contacts ? kind : TRIBO_POINT_GRAZE;
            *contact = i;
        }
    }
    free(a.letter);
    free(b.letter);
    return kind;
}

/* ------------------------------------------------------------------------------------------------------------- comparison */

int tribo_word_same(const struct derivative *a, const struct derivative *b, size_t width)
{
    int same = 1;
    for (size_t k = 0, l = 0; same && (k < a->steps || l < b->steps);) {
        if (k < a->steps && !a->step[k].slip) {
            k++; /* a jump */
        } else if (l < b->steps && !b->step[l].slip) {
            l++;
        } else {
            same = k < a->steps && l < b->steps && memcmp(a->step[k++].slip, b->step[l++].slip, width) == 0;
        }
    }
    return same;
}
