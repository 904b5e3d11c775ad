/* SPDX-License-Identifier: BSD-3-Clause */
#include "couplings.h"

#include <math.h>
#include <stdio.h>

#include "../../src/damper/output.h"
#include "../validation/pile.h"

static const char *const name[] = {"consistent", "partition"};

/* Two contacts as on the belt: the first below block 0, the second between the blocks. */
static int balance(int coupling, const double *r, const double *limit, const double *v, const double *a, double *feq, double *f)
{
    tribo_context *c;
    need(tribo_create(&c, 2), NULL);
    need(tribo_set_operator_dense(c, r), tribo_message(c));
    need(tribo_set_limit(c, limit), tribo_message(c));
    need(tribo_set_epsilon_all(c, 1.0), tribo_message(c));
    need(tribo_set_coupling(c, coupling), tribo_message(c));
    const int status = tribo_balance(c, v, a, feq, f);
    tribo_destroy(c);
    return status;
}

static const double belt[4] = {1.0, -1.0, -1.0, 2.0}, limits[2] = {2.0, 0.25};

/* The second contact slides slowly and cannot carry its f_eq. Just beyond epsilon it is known to carry its limit. */
static int print_jump(void)
{
    const double a[2] = {-0.5, 1.5}, step = 1e-9;
    int good = 1;
    printf("\nForce of contact 0, at rest, while |v| of contact 1, pulled harder than its limit, passes epsilon:\n\n"
           "| coupling | below | above | jump |\n|---|---|---|---|\n");
    for (int k = 0; k < 2; k++) {
        double f[2][2];
        for (int side = 0; side < 2; side++) {
            const double v[2] = {0.0, 1.0 + (side ? step : -step)};
            need(balance(k, belt, limits, v, a, NULL, f[side]), NULL);
        }
        const double jump = f[1][0] - f[0][0];
        printf("| %s | %.6f | %.6f | %.1e |\n", name[k], f[0][0], f[1][0], jump);
        good = good && (k == TRIBO_CONSISTENT) == (fabs(jump) < 1e-8);
    }
    return good;
}

/* At v = 0, where Coulomb's law is known: contact 0 is within its limit, so it rests. */
static int print_saturated(void)
{
    const double a[2] = {-0.5, 1.5}, v[2] = {0.0, 0.0};
    int good = 1;
    printf("\nBoth at rest, contact 1 saturated: acceleration of contact 0, which could hold:\n\n"
           "| coupling | f_0 | f_1 | z_0'' |\n|---|---|---|---|\n");
    for (int k = 0; k < 2; k++) {
        double f[2];
        need(balance(k, belt, limits, v, a, NULL, f), NULL);
        const double moves = belt[0] * f[0] + belt[1] * f[1] + a[0];
        printf("| %s | %.6f | %.6f | %.1e |\n", name[k], f[0], f[1], moves);
        good = good && (k == TRIBO_CONSISTENT) == (fabs(moves) < 1e-14);
    }
    return good;
}

/* Two contacts of one block with the same ground, asked for different accelerations. */
static int print_redundant(void)
{
    const double r[4] = {1.0, 1.0, 1.0, 1.0}, a[2] = {0.3, -0.1}, v[2] = {0.0, 0.0}, limit[2] = {1.0, 1.0};
    int good = 1;
    printf("\nTwo redundant contacts, a outside the range of R:\n\n| coupling | status | f_0 | f_1 |\n|---|---|---|---|\n");
    for (int k = 0; k < 2; k++) {
        double f[2];
        const int status = balance(k, r, limit, v, a, NULL, f);
        printf("| %s | %d, %s | %.6f | %.6f |\n", name[k], status, tribo_strerror(status), f[0], f[1]);
        good = good && status == (k == TRIBO_CONSISTENT ? TRIBO_OK : TRIBO_ERR_INCONSISTENT);
    }
    return good;
}

static int print_pile(void)
{
    const double ratio[] = {1.0, 1e2, 1e4, 1e6}, dt[] = {1e-2, 1e-3};
    int good = 1;
    printf(
        "\nPile of %d blocks on a belt at t = %g: error of the state, by method event at 1e-10.\n\n"
        "| ratio of masses | exact | consistent, rk4 at %g | at %g | partition, rk4 at %g | at %g |\n|---|---|---|---|---|---|\n",
        PILE_BLOCKS, PILE_TIME, dt[0], dt[1], dt[0], dt[1]);
    for (size_t k = 0; k < sizeof ratio / sizeof *ratio; k++) {
        double want[PILE_STATES], y[PILE_STATES], error = 0.0;
        need(pile_run(ratio[k], 0, "event", TRIBO_CONSISTENT, 1.0, 1e-10, want), NULL);
        need(pile_run(ratio[k], 0, "exact", TRIBO_CONSISTENT, 1.0, 0.0, y), NULL);
        printf("| %g | %.1e |", ratio[k], pile_distance(y, want));
        for (int coupling = 0; coupling < 2; coupling++) {
            for (size_t j = 0; j < sizeof dt / sizeof *dt; j++) {
                const int status = pile_run(ratio[k], 0, "rk4/fixed", coupling, dt[j], 0.0, y);
                if (status) {
                    printf(" %s |", tribo_strerror(status));
                } else {
                    printf(" %.1e |", pile_distance(y, want));
                }
                error = coupling == TRIBO_CONSISTENT ? pile_distance(y, want) : error;
                good = good && (coupling != TRIBO_CONSISTENT || status == TRIBO_OK);
            }
        }
        good = good && error < 2e-4;
        printf("\n");
    }
    return good;
}

int print_couplings(int pile)
{
    const int jump = print_jump(), saturated = print_saturated(), redundant = print_redundant();
    return jump && saturated && redundant && (!pile || print_pile());
}
