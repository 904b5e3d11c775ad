# SPDX-License-Identifier: BSD-3-Clause
# For scripts that start MPI programs, which source it: Open MPI is to start as many ranks as are asked for, as root in a
# container too, and not to bind them to cores that other programs are bound to. Other MPIs do not read this.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_mpi_yield_when_idle=1
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
