/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces of coupled contacts in all their bits, for comparing builds. Inputs are multiples of 1/64, the same whatever the
 * machine's arithmetic; the smooth law is left out, since it is as good as libm's tanh. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <tribo/tribo.h>

enum { N = 24 };

/* Knuth's generator (MMIX); -2 to 2 in 64ths. */
static double any(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)((int)(*state >> 56) - 128) / 64.0;
}

static void print_bits(const char *what, const double *x)
{
    printf("%s", what);
    for (int i = 0; i < N; i++) {
        uint64_t bits;
        memcpy(&bits, &x[i], sizeof bits);
        printf(" %08lx%08lx", (unsigned long)(bits >> 32), (unsigned long)(bits & 0xffffffffu));
    }
    printf("\n");
}

/* Blocks in a pile, each contact between two. */
static int set_pile(tribo_context *c)
{
    double r[N * N] = {0.0}, limit[N];
    for (int i = 0; i < N; i++) {
        r[N * i + i] = i % 7 ? 2.0 : 1.75;
        limit[i] = i % 11 ? 0.25 * (i % 5 + 1) : 0.0;
        if (i) {
            r[N * i + i - 1] = r[N * (i - 1) + i] = -0.75;
        }
    }
    return tribo_set_operator_dense(c, r) || tribo_set_limit(c, limit) || tribo_set_epsilon_step(c, 0.01, 0.7);
}

static int show_law(tribo_context *c, int law, uint64_t *state)
{
    double v[N], a[N], feq[N], f[N];
    for (int k = 0; k < 20; k++) {
        for (int i = 0; i < N; i++) {
            v[i] = i % 3 ? any(state) / 1024.0 : 0.0;
            a[i] = any(state);
        }
        if (tribo_set_law(c, law) || tribo_balance(c, v, a, feq, f)) {
            return 1;
        }
        print_bits(tribo_law_name(law), f);
        print_bits("feq", feq);
        if (tribo_step_force(c, 0.125, a, f)) {
            return 1;
        }
        print_bits("step", f);
    }
    return 0;
}

int main(void)
{
    tribo_context *c;
    uint64_t state = 1;
    int status = tribo_create(&c, N) || set_pile(c);
    for (int law = 0; !status && law < tribo_law_count(); law++) {
        status = law == TRIBO_SMOOTH ? 0 : show_law(c, law, &state);
    }
    if (status) {
        fprintf(stderr, "%s\n", tribo_message(c));
    }
    tribo_destroy(c);
    return status;
}
