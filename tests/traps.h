/* SPDX-License-Identifier: BSD-3-Clause */
/* Floating-point exceptions, at which programs stop that are compiled with -ffpe-trap=invalid,zero,overflow or the like. */
#ifndef TRIBO_TESTS_TRAPS_H
#define TRIBO_TESTS_TRAPS_H

#include "support.h"

/* From here on the process stops where an exception is raised; 0 where that cannot be arranged. */
int set_traps(void);

/* What to do before and after a call. The text tells which exceptions it has raised; NULL if none. */
void expect_no_exception(void);
const char *exception_raised(void);

/* The status of a call that must raise none. */
#define quiet(call) (expect_no_exception(), quiet_status(#call, call))
int quiet_status(const char *call, int status);
#define assert_quiet(call) assert_ok(quiet(call))

#endif
