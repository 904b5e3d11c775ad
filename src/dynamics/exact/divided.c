#include "divided.h"

/* CLOSE: |z| below which series are used; TERMS: terms of a series. */
#define CLOSE 0.5
#define TERMS 18

double complex tribo_exp_1(double complex z)
{
    if (cabs(z) >= CLOSE) {
        return (cexp(z) - 1.0) / z;
    }
    const double x = creal(z), y = cimag(z);
    double re = 1.0, im = 0.0;
    for (int k = TERMS - 1; k > 1; k--) { /* sum = 1 + sum z/k */
        const double old = re;
        re = 1.0 + (x * old - y * im) / k;
        im = (x * im + y * old) / k;
    }
    return re + im * I;
}

/* Returns exp[a, b] = e^a exp[0, b - a], or with a and b exchanged if Re b >= Re a: overflows only if the result does. */
static double complex between(double complex a, double complex b)
{
    return creal(a) > creal(b) ? cexp(a) * tribo_exp_1(b - a) : cexp(b) * tribo_exp_1(a - b);
}

double complex tribo_exp_2(double complex a, double complex b)
{
    if (cabs(a) < CLOSE && cabs(b) < CLOSE) {
        /* Sum of h_k(a, b)/(k + 2)!, h_k(a, b) = sum of a^j b^(k - j) over j from 0 to k. */
        double complex products = 1.0, power = 1.0, sum = 0.0;
        double factor = 0.5;
        for (int k = 0; k < TERMS; k++) {
            sum += factor * products;
            factor /= k + 3;
            power *= b;
            products = a * products + power;
        }
        return sum;
    }
    const double complex far = cabs(a) < cabs(b) ? b : a, other = cabs(a) < cabs(b) ? a : b;
    return (between(far, other) - tribo_exp_1(other)) / far;
}
