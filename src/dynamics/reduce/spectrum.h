/* The fast end of what a structure does. */
#ifndef TRIBO_SPECTRUM_H
#define TRIBO_SPECTRUM_H

#include "dynamics/system/system.h"

/* A little above the highest eigenvalue of stiffness AK + damping AC, by at most a hundredth; 0 if none is positive. Damping that
 * is not symmetric is left out. A status: TRIBO_OK or TRIBO_ERR_MEMORY, with the message on the context. */
int tribo_system_highest(const tribo_system *sys, double stiffness, double damping, double *value);

/* A bound on the frequencies of structure and loads. */
int tribo_system_top_frequency(const tribo_system *sys, double *omega);

#endif
