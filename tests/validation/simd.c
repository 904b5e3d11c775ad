/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers that every kernel of src/common/simd.h has a part in, to the last bit: the same program with the variants for several
 * instruction sets and without any must print the same. */
#include <stdio.h>
#include <stdlib.h>

#include "../stress/structure.h"

#define CONTACTS 131 /* no multiple of any width */

static void print(const char *what, const double *x, size_t n)
{
    printf("%s", what);
    for (size_t i = 0; i < n; i++) {
        printf(" %a", x[i]);
    }
    printf("\n");
}

static void print_contacts(struct random *g, int law)
{
    double r[CONTACTS], limit[CONTACTS], epsilon[CONTACTS], v[CONTACTS], a[CONTACTS], feq[CONTACTS], f[CONTACTS], d[3][CONTACTS];
    tribo_context *c;
    for (size_t i = 0; i < CONTACTS; i++) {
        r[i] = log_uniform(g, 2.0);
        limit[i] = below(g, 9) ? log_uniform(g, 1.0) : 0.0;
        epsilon[i] = log_uniform(g, 1.0);
        v[i] = below(g, 4) ? uniform(g, -2.0, 2.0) * epsilon[i] : 0.0;
        feq[i] = uniform(g, -2.0, 2.0) * limit[i];
        a[i] = -r[i] * uniform(g, -2.0, 2.0) * limit[i];
    }
    assert_ok(tribo_create(&c, CONTACTS));
    assert_ok(tribo_set_law(c, law));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_epsilon(c, epsilon));
    assert_ok(tribo_set_operator_diagonal(c, r));
    assert_ok(tribo_force(c, v, feq, f));
    print("force", f, CONTACTS);
    assert_ok(tribo_force_tangent(c, v, feq, f, d[0], d[1], d[2]));
    print("tangent", f, CONTACTS);
    print("df", d[0], 3 * CONTACTS);
    assert_ok(tribo_balance(c, v, a, feq, f));
    print("balance", feq, CONTACTS);
    print("f", f, CONTACTS);
    assert_ok(tribo_step_force(c, 1.0, v, f));
    print("step", f, CONTACTS);
    tribo_destroy(c);
}

static void print_chain(const char *method, double tolerance)
{
    double y[67] = {0};
    tribo_system *sys;
    assert_ok(tribo_system_chain(&sys, 33, 1.0, 0.4, 1.0));
    run(sys, method, 0.01, tolerance, 10.0, y);
    print(method, y, 67);
    tribo_system_destroy(sys);
}

int main(void)
{
    static const char *const methods[] = {"exact", "event", "central/fixed", "moreau/fixed", "rk4/fixed"};
    struct random g = random_of(1);
    for (int law = 0; law < tribo_law_count(); law++) {
        for (int k = 0; k < 20; k++) {
            print_contacts(&g, law);
        }
    }
    for (size_t m = 0; m < COUNT(methods); m++) {
        print_chain(methods[m], 1e-9);
        for (int seed = 0; seed < 20; seed++) {
            const struct structure s = structure_create(seed);
            double y[MOST_STATES];
            char text[200];
            printf("%s %d", methods[m], structure_run(&s, methods[m], 0.01, 1e-9, 10.0, y, text));
            print("", y, 2 * s.ndof + 1);
        }
    }
    return EXIT_SUCCESS;
}
