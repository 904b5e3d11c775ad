/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_SEARCH_H
#define DAMPER_SEARCH_H

#include <stddef.h>

/* value [count] out: of limit [count]. */
typedef void evaluate(void *data, const double *limit, double *value, size_t count);

/* The limit between low and high where the value is least, to that part of it, for a value that falls and then rises; *least is
 * the value. Takes the
 * values of a few limits at a time, for those to share the work. */
double find_least(double low, double high, double part, evaluate *values, void *data, double *least);

#endif
