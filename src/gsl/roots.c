#include "roots.h"

#include <math.h>

struct cubic {
    double c0, c1, c2, bend;
};

static double value(const struct cubic *p, double h)
{
    return p->c0 + h * (p->c1 + h * (0.5 * p->c2 - h * p->bend / 6.0));
}

static double slope(const struct cubic *p, double h)
{
    return p->c1 + h * (p->c2 - 0.5 * h * p->bend);
}

/* Positive on all of [0, h] if its Bernstein coefficients there are. */
static int positive(const struct cubic *p, double h)
{
    const double b1 = p->c0 + p->c1 * h / 3.0, b2 = b1 + h * (p->c1 / 3.0 + p->c2 * h / 6.0);
    return b1 >= 0.0 && b2 >= 0.0 && value(p, h) >= 0.0;
}

/* The root beyond a, from where on p is concave, and p(a) >= 0: Newton's method comes down from the right, and the chord from a to the last
 * point meets zero before p does. */
static double beyond(const struct cubic *p, double a, double longest)
{
    const double pa = value(p, a), rise = fmax(slope(p, a), 0.0);
    double right = a + fmax(sqrt(12.0 * rise / p->bend), cbrt(12.0 * pa / p->bend));
    if (!(right > a)) {
        return a;
    }
    for (int i = 0; i < 4; i++) {
        const double next = right - value(p, right) / slope(p, right);
        if (!(next > a && next < right)) {
            break;
        }
        right = next;
    }
    const double pr = value(p, right);
    const double root = pr < 0.0 ? a + (right - a) * pa / (pa - pr) : right;
    return fmin(root, longest);
}

double tribo_safe_step(double c0, double c1, double c2, double bend, double longest)
{
    const struct cubic p = {c0, c1, c2, bend};
    if (positive(&p, longest)) {
        return longest;
    }
    if (c1 < 0.0) {
        /* close to a simple root: Newton's step, shortened by what curvature can do */
        const double newton = -c0 / c1, h = newton * (1.0 + newton * (0.5 * fabs(c2) + bend * newton / 6.0) / c1);
        if (h > 0.9 * newton && h < longest && value(&p, h) >= 0.0) {
            return h;
        }
    }
    if (!(bend > 0.0)) {
        /* a parabola: its first root */
        const double square = c1 * c1 - 2.0 * c0 * c2;
        const double q = -c1 + sqrt(fmax(square, 0.0));
        return square < 0.0 ? longest : c1 < 0.0 ? fmin(2.0 * c0 / q, longest) : c2 < 0.0 ? fmin(q / -c2, longest) : longest;
    }
    const double inflection = fmax(c2, 0.0) / bend;
    if (c1 < 0.0 && inflection > 0.0) {
        /* convex so far; is there a root before its lowest point? Newton's method from the left stays short of it */
        const double square = c2 * c2 + 2.0 * bend * c1;
        const double lowest = square > 0.0 ? -2.0 * c1 / (c2 + sqrt(square)) : inflection;
        if (value(&p, lowest) <= 0.0) {
            double h = 0.0;
            for (int i = 0; i < 6; i++) {
                const double next = h - value(&p, h) / slope(&p, h);
                if (!(next > h && next < lowest)) {
                    break;
                }
                h = next;
            }
            return fmin(h, longest);
        }
    }
    return beyond(&p, inflection, longest);
}
