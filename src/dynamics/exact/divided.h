/* Divided differences of the exponential function, without loss of digits at points close to each other. */
#ifndef TRIBO_DIVIDED_H
#define TRIBO_DIVIDED_H

#include "common/imaginary.h"

/* Returns exp[0, z] = (e^z - 1)/z = the integral of e^{z s} over s from 0 to 1. */
double complex tribo_exp_1(double complex z);

/* Returns exp[0, a, b] = (exp[0, a] - exp[0, b])/(a - b). */
double complex tribo_exp_2(double complex a, double complex b);

#endif
