/* The parabola with the value and two derivatives of a sample. */
#ifndef TRIBO_PARABOLA_H
#define TRIBO_PARABOLA_H

#include <math.h>

#include "common/real.h"
#include "quintic.h"

/* Its least value until a step on. */
static inline double parabola_least(const struct sample *m, double step)
{
    const double end = m->g + step * (m->d + 0.5 * step * m->e);
    const int turns = m->d < 0.0 && m->d + step * m->e > 0.0;
    return turns ? lesser(end, m->g - 0.5 * m->d * m->d / m->e) : end;
}

/* Its first zero within most; HUGE_VAL if there is none. No quotient overflows that most does not make large. */
static inline double parabola_fall(const struct sample *m, double most)
{
    double when = HUGE_VAL;
    if (m->d < 0.0 && m->g + 2.0 * most * m->d < 0.0) {
        const double line = -m->g / m->d, square = 1.0 + 2.0 * line * (m->e / m->d);
        when = square >= 0.0 ? 2.0 * line / (1.0 + sqrt(square)) : HUGE_VAL;
    } else if (m->g + most * (m->d + 0.5 * most * m->e) < 0.0) {
        const double top = -m->d / m->e;
        when = top + sqrt(greater(top * top - 2.0 * m->g / m->e, 0.0));
    }
    return when <= most ? when : HUGE_VAL;
}

#endif
