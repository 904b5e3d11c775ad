/* The paper's law: Quinn (2004), Eq. 4, with half-width epsilon/2 and slope 2N/epsilon. */
#include "quinn.h"

TRIBO_LAW_LOOPS(quinn)

const struct law tribo_law_quinn = {
    .id = 4,
    .name = "quinn",
    .reference = "D. D. Quinn, J. Vib. Acoust. 126 (2004) 391, Eq. 4, doi:10.1115/1.1760564",
    .uses_feq = 1,
    .sticks_in_band = 1,
    .relaxes = 1,
    .holds = 1.0,
    .force = quinn_force_all,
    .tangent = quinn_tangent_all,
};
