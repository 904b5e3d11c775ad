/* SPDX-License-Identifier: BSD-3-Clause */
#include <stdio.h>
#include <tribo/tribo.h>

int main(void)
{
    const double r[4] = {2, 1, 1, 2}, v[2] = {0, 0}, a[2] = {-3, 3}; /* friction balances this by -a */
    double f[2] = {0, 0};
    tribo_context *ctx = NULL;
    int ok = tribo_version() == TRIBO_VERSION && tribo_create(&ctx, 2) == TRIBO_OK && tribo_set_limit_all(ctx, 5) == TRIBO_OK &&
             tribo_set_operator_dense(ctx, r) == TRIBO_OK && tribo_balance(ctx, v, a, NULL, f) == TRIBO_OK;

    for (int i = 0; i < 2; i++) {
        ok = ok && f[i] + a[i] < 1e-12 && -f[i] - a[i] < 1e-12;
    }
    tribo_destroy(ctx);
    printf("tribo %s: f = %g %g\n", tribo_version_string(), f[0], f[1]);
    return ok ? 0 : 1;
}
