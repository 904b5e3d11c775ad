/* Harmonics at the time set, when they are asked for; and at times that will be set, side by side. */
#include "cos_sin.h"
#include "system.h"

#include <math.h>
#include <string.h>

/* Bases at a time are the same to the last bit whoever asks: contacts that stick have exactly no velocity. */
static int is_foreseen(const tribo_system *sys, const struct harmonic *h)
{
    return sys->foreseen && h->drives == DRIVES_LOAD;
}

/* Looked for from place k on. */
static size_t place_from(const tribo_system *sys, size_t k, double t)
{
    while (k < sys->foreseen && sys->foresight[k] < t) {
        k++;
    }
    return k < sys->foreseen && sys->foresight[k] == t ? k : FORESIGHT;
}

size_t tribo_system_place(const tribo_system *sys, double t)
{
    return place_from(sys, 0, t);
}

void tribo_harmonic_turn(const tribo_system *sys, struct harmonic *h)
{
    const double t = sys->time;
    /* times are asked for in their order, if at all */
    const size_t k = is_foreseen(sys, h) ? place_from(sys, h->next, t) : FORESIGHT;
    h->time = t;
    h->turns = 0;
    if (h->omega == 0.0) {
        h->cos_t = 1.0;
        h->sin_t = 0.0;
    } else if (k < FORESIGHT) {
        h->next = k;
        h->cos_t = h->cos_ahead[k];
        h->sin_t = h->sin_ahead[k];
    } else if (is_foreseen(sys, h)) {
        tribo_cos_sin_all(h->omega, 1, &t, &h->cos_t, &h->sin_t);
    } else {
        tribo_cos_sin(h->omega, t, sys->low, &h->cos_t, &h->sin_t);
    }
}

/* Each turn adds its rounding: so many times that is a part of what decisions allow for. */
enum { TURNS = 16 };

void tribo_harmonic_take(const tribo_system *sys, struct harmonic *h, double c, double s)
{
    if (h->drives == DRIVES_LOAD && h->turns < TURNS) {
        h->turns++;
        h->time = sys->time;
        h->cos_t = c;
        h->sin_t = s;
    }
}

void tribo_system_forget_time(tribo_system *sys)
{
    sys->time = NAN;
    sys->foreseen = 0;
    for (size_t k = 0; k < sys->harmonics; k++) {
        sys->harmonic[k].time = NAN;
    }
}

void tribo_system_foresee(tribo_system *sys, size_t count, const double *t)
{
    if (!sys->foreseen || !count) {
        tribo_system_forget_time(sys);
    }
    memcpy(sys->foresight, t, count * sizeof *t);
    sys->foreseen = count;
    for (size_t k = 0; k < sys->harmonics; k++) {
        struct harmonic *h = &sys->harmonic[k];
        h->next = 0;
        if (is_foreseen(sys, h)) {
            tribo_cos_sin_all(h->omega, count, t, h->cos_ahead, h->sin_ahead);
        }
    }
}
