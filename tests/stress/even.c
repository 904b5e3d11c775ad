/* SPDX-License-Identifier: BSD-3-Clause */
/* Structures of small whole numbers, where everything that may coincide does: events at the same time, forces that touch their
 * limit, or stay at it for good, contacts that repeat each other, loads in resonance. TRIBO_SEED and TRIBO_BLOCKS as in random.c.
 */
#include "structure.h"

#define BLOCK 25
#define DURATION 20.0
#define AGREE 1e-10

TEST(exact_and_event)
{
    const int first = setting("TRIBO_SEED", 0) + BLOCK * _i;
    for (int seed = first; seed < first + BLOCK; seed++) {
        const struct structure s = structure_even(seed);
        const size_t n = 2 * s.ndof + 1;
        double exact[MOST_STATES], event[MOST_STATES];
        char text[200];
        int status = structure_run(&s, "exact", 1.0, 0.0, DURATION, exact, text);
        require(status == TRIBO_OK, "seed %d, %s: exact: %d %s", seed, s.name, status, text);
        status = structure_run(&s, "event", 1.0, 1e-12, DURATION, event, text);
        require(status == TRIBO_OK, "seed %d, %s: event: %d %s", seed, s.name, status, text);
        const double off = distance(exact, event, n), size = fmax(size_of(exact, n), 1.0);
        require(off <= AGREE * size, "seed %d, %s: off by %.3g of %.3g", seed, s.name, off, size);
    }
}

int main(void)
{
    const struct test tests[] = {{exact_and_event, setting("TRIBO_BLOCKS", 1)}};
    return run_suite("even", tests, COUNT(tests));
}
