#include "turn.h"

#include <math.h>

void tribo_turn(double angle, double *cosine, double *sine)
{
    const double c = cos(angle), s = sin(angle);
    *cosine = c;
    *sine = s;
}
