/* SPDX-License-Identifier: BSD-3-Clause */
/* Systems as GSL sees them. */
#ifndef TRIBO_GSL_SYSTEM_H
#define TRIBO_GSL_SYSTEM_H

/* The status for GSL of an evaluation with this status of tribo: GSL_FAILURE if a shorter step may succeed. */
int tribo_gsl_status(int status);

#endif
