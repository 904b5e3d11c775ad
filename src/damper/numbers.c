/* SPDX-License-Identifier: BSD-3-Clause */
#include "numbers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "lines.h"

const char *read_number(const char *origin, const char *at, char end, double *value)
{
    char *stop;
    *value = number_at(at, &stop);
    if (stop == at || *stop != end || !isfinite(*value)) {
        die("%s: expected a finite number%s%.1s at \"%s\"", origin, end ? ", then " : "", &end, at);
    }
    return end ? stop + 1 : stop;
}

double read_real(const char *origin, const char *text, double smallest, int may_equal)
{
    double value;
    read_number(origin, text, '\0', &value);
    if (value < smallest || (value == smallest && !may_equal)) {
        die("%s: must be %s %g", origin, may_equal ? "at least" : "above", smallest);
    }
    return value;
}

size_t read_whole(const char *origin, const char *text, size_t smallest)
{
    double value;
    read_number(origin, text, '\0', &value);
    if (value != floor(value) || value < (double)smallest || value > 1e6) {
        die("%s: expected a whole number from %zu to 1000000, found %s", origin, smallest, text);
    }
    return (size_t)value;
}

void add_number(struct list *list, double value)
{
    list->value = need_room(list->value, list->count, &list->room, sizeof *list->value);
    list->value[list->count++] = value;
}

void read_list(const char *origin, const char *text, struct list *list)
{
    for (int more = 1; more;) {
        double value;
        more = strchr(text, ',') != NULL;
        text = read_number(origin, text, more ? ',' : '\0', &value);
        add_number(list, value);
    }
}

struct range read_range(const char *origin, const char *text)
{
    struct range r = {.points = 1};
    if (!strchr(text, ':')) {
        r.from = r.to = read_real(origin, text, 0.0, 0);
        return r;
    }
    const char *at = read_number(origin, text, ':', &r.from);
    at = read_number(origin, at, ':', &r.to);
    r.points = read_whole(origin, at, 1);
    if (r.from <= 0.0 || r.to < r.from || (r.to == r.from) != (r.points == 1)) {
        die("%s: a range must be positive and ascend", origin);
    }
    return r;
}
