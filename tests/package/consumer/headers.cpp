/* SPDX-License-Identifier: BSD-3-Clause */
#include <cstdio>
#include <tribo/tribo_gsl.h>
#include <tribo/tribo.h>

// Calls libtribo_gsl only.
int main()
{
    tribo_system *sys = 0;
    bool ok = tribo_system_oscillator(&sys, 1.0, 0.0, 1.0) == TRIBO_OK && tribo_system_ncontact(sys) == 1;

    tribo_system_destroy(sys);
    std::puts(ok ? "one contact" : "no system");
    return ok ? 0 : 1;
}
