/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TRIBO_BENCH_BEAM_H
#define TRIBO_BENCH_BEAM_H

#include "systems.h"

/* The beam of the examples in its lowest modes, on three contacts and driven at its first resonance; limits are those at which
 * friction dissipates most, as harmonic balance has it. Ends the program if its files cannot be read. */
tribo_system *beam_create(struct model *model);

#endif
