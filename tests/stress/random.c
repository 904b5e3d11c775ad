/* Random linear structures with friction: the closed form, the event-driven series and central differences know nothing of each
 * other's integration, and have to agree. TRIBO_SEED is the first seed, TRIBO_BLOCKS how many blocks of them are run. */
#include <stdio.h>

#include "structure.h"

#define BLOCK 25
#define DURATION 20.0

static int first_seed(int block)
{
    return setting("TRIBO_SEED", 0) + BLOCK * block;
}

static void move(const struct structure *s, int seed, const char *method, double dt, double tolerance, double *y)
{
    char text[200];
    const int status = structure_run(s, method, dt, tolerance, DURATION, y, text);
    require(status == TRIBO_OK, "seed %d, %s, %s: %d: %s", seed, s->name, method, status, text);
}

static void agree(const struct structure *s, int seed, const char *method, const double *want, const double *y, double tolerance)
{
    const size_t n = 2 * s->ndof + 1;
    const double off = distance(y, want, n), size = size_of(want, n);
    require(off <= tolerance * fmax(size, 1e-6), "seed %d, %s: %s is off by %.3g of %.3g, the largest number in the state", seed,
            s->name, method, off, size);
}

/* Exact against event at 1e-12. 3000 seeds showed 6e-10 at most, mostly 1e-14: a motion that is bounded and dissipates forgets
 * errors, but a contact that only just breaks away takes the square root of what the force is off. */
TEST(exact_and_event)
{
    for (int seed = first_seed(_i); seed < first_seed(_i + 1); seed++) {
        const struct structure s = structure_create(seed);
        double exact[MOST_STATES], event[MOST_STATES];
        move(&s, seed, "exact", 1.0, 0.0, exact);
        move(&s, seed, "event", 1.0, 1e-12, event);
        agree(&s, seed, "event", exact, event, 1e-8);
    }
}

/* Against central differences at dt = 1e-3. They take a reversal without stick for a moment of stick, and the force of dampers
 * half a step late: errors of the order of dt. 1000 seeds showed 1.6e-3 at most. */
TEST(exact_and_central)
{
    for (int seed = first_seed(_i); seed < first_seed(_i + 1); seed++) {
        const struct structure s = structure_create(seed);
        double exact[MOST_STATES], central[MOST_STATES];
        move(&s, seed, "exact", 1.0, 0.0, exact);
        move(&s, seed, "central/fixed", 1e-3, 0.0, central);
        agree(&s, seed, "central/fixed", exact, central, 3e-3);
    }
}

int main(void)
{
    const int blocks = setting("TRIBO_BLOCKS", 1);
    const struct test tests[] = {{exact_and_event, blocks}, {exact_and_central, blocks}};
    return run_suite("random", tests, COUNT(tests));
}
