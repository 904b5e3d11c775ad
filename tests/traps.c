/* SPDX-License-Identifier: BSD-3-Clause */
#include "traps.h"

#include <fenv.h>

#define TRAPS (FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW)

int set_traps(void)
{
#if defined(TRIBO_HAVE_FEENABLEEXCEPT)
    feclearexcept(FE_ALL_EXCEPT);
    return feenableexcept(TRAPS) != -1;
#else
    return 0;
#endif
}

void expect_no_exception(void)
{
    feclearexcept(FE_ALL_EXCEPT);
}

const char *exception_raised(void)
{
    const int raised = fetestexcept(TRAPS);
    return raised & FE_INVALID     ? "an invalid operation"
           : raised & FE_DIVBYZERO ? "a division by zero"
           : raised & FE_OVERFLOW  ? "an overflow"
                                   : NULL;
}

int quiet_status(const char *call, int status)
{
    const char *raised = exception_raised();
    require(!raised, "%s raises %s", call, raised);
    return status;
}
