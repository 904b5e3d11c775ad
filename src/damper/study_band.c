/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>

#include "output.h"
#include "study.h"
#include "team.h"

static const double LEAST_PART = 5e-4; /* tolerance of the best limit */

static void largest_amplitudes(void *data, const double *limit, double *value, size_t count)
{
    struct curve *c = run_curves(data, 0, limit, count);
    for (size_t k = 0; k < count; k++) {
        const struct sample *top = largest_of(&c[k], AMPLITUDE);
        value[k] = top ? top->motion.amplitude : HUGE_VAL;
    }
    free_curves(c, count);
}

/* Largest amplitudes over the limits may have several valleys: those within this factor of the lowest value are searched. */
static const double NEAR_LOWEST = 1.25;

/* The limit with the least value, between the neighbours of limits with low ones; 0 if the least is at an end. */
static double search_valleys(struct study *s, const double *limit, const double *value, size_t count)
{
    double least = HUGE_VAL, best = 0.0, lowest = HUGE_VAL;
    for (size_t k = 0; k < count; k++) {
        lowest = fmin(lowest, value[k]);
    }
    for (size_t k = 1; k + 1 < count; k++) {
        if (value[k] <= value[k - 1] && value[k] <= value[k + 1] && value[k] <= NEAR_LOWEST * lowest) {
            double found;
            const double there = find_least(limit[k - 1], limit[k + 1], LEAST_PART, largest_amplitudes, s, &found);
            best = found < least ? there : best;
            least = fmin(found, least);
        }
    }
    return least <= value[0] && least <= value[count - 1] ? best : 0.0;
}

void write_family(struct study *s, const struct curve *c, size_t count)
{
    write_curves(s->tables, "family", c, count, s->damper);
    printf("  %12s   points    not found  largest amplitude  at frequency\n", s->tables->limit);
    for (size_t k = 0; k < count; k++) {
        const struct sample *top = largest_of(&c[k], AMPLITUDE);
        if (top) {
            printf("  %12.5g %8zu %12zu %18.8g %13.7g\n", c[k].fixed, c[k].count, gaps_of(&c[k]), top->motion.amplitude,
                   top->motion.hz);
        }
        s->gaps += gaps_of(&c[k]);
    }
}

void study_band(struct study *s, const struct curve *c, size_t count)
{
    double *limit = need_memory(2 * count, sizeof *limit), *value = limit + count, least = HUGE_VAL, found = 0.0;
    struct curve *best = NULL;
    write_linear(s->tables, s->damper, &s->options->drive);
    for (size_t k = 0; k < count; k++) {
        const struct sample *top = largest_of(&c[k], AMPLITUDE);
        limit[k] = c[k].fixed;
        value[k] = top ? top->motion.amplitude : HUGE_VAL;
        least = fmin(least, value[k]);
    }
    if (!interrupted() && count > 1 && !s->options->follow) {
        found = least < HUGE_VAL ? search_valleys(s, limit, value, count) : 0.0;
        if (least == HUGE_VAL) {
            printf("no motion was found at any of these %ss: %s\n", s->tables->limit, first_message(c, count));
        } else if (found > 0.0 && !interrupted()) {
            best = run_curves(s, 0, &found, 1);
        } else if (!interrupted()) {
            printf("no %s within the range is better than its ends: widen --limits to find the best\n", s->tables->limit);
        }
    }
    if (s->options->follow && least == HUGE_VAL && !interrupted()) {
        snprintf(s->nothing, sizeof s->nothing, "%s", first_message(c, count));
    }
    const struct sample *top = best ? largest_of(best, AMPLITUDE) : NULL;
    const int shown = top && !interrupted();
    check_by_marching(s, best ? best : c);
    if (shown) {
        write_curves(s->tables, "best", best, 1, s->damper);
        printf("best %s of the band: %.6g, largest amplitude %.8g at %.7g Hz\n", s->tables->limit, found, top->motion.amplitude,
               top->motion.hz);
        write_result(s->tables, s->options->contacts.by_load ? "band.load" : "band.limit", found);
        write_result(s->tables, "band.amplitude", top->motion.amplitude);
        write_result(s->tables, "band.frequency", top->motion.hz);
        s->gaps += gaps_of(best);
    }
    plot_family(s->tables, limit, count, shown ? found : 0.0);
    if (best) {
        free_curves(best, 1);
    }
    free(limit);
}
