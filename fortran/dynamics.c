/* SPDX-License-Identifier: BSD-3-Clause */
/* Pure functions of a system for module tribo_dynamics. */
#include "dynamics.h"

size_t tribo_fortran_ndof(const struct tribo_held *held)
{
    return held ? tribo_system_ndof(held->sys) : 0;
}

size_t tribo_fortran_dimension(const struct tribo_held *held)
{
    return held ? tribo_system_dimension(held->sys) : 0;
}

size_t tribo_fortran_ncontact(const struct tribo_held *held)
{
    return held ? tribo_system_ncontact(held->sys) : 0;
}

size_t tribo_fortran_given(const struct tribo_held *held)
{
    return held ? (size_t)held->given : 0;
}
