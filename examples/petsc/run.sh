#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Runs the programs on PETSc on 1, 2 and 3 ranks (or on those given: `run.sh 4 8`), compares them with the drivers of libtribo_gsl
# in one process, and leaves tables and VTK files in build/results/petsc. Complete on a bare Debian 12 machine: installs what is
# missing. Its status is 0 only if all agree.
set -eu
CDPATH= cd -- "$(dirname -- "$0")/../.."
. tests/setup.sh

setup gcc libc6-dev make cmake pkg-config libgsl-dev libpetsc-real-dev petsc-dev mpi-default-dev mpi-default-bin

here=$PWD/examples/petsc build=build/release results=$PWD/build/results/petsc
[ $# -gt 0 ] || set -- 1 2 3

echo "== Building in $build"
[ -f $build/CMakeCache.txt ] || parts='-DTRIBO_BUILD_TESTS=OFF -DTRIBO_FORTRAN=OFF'
cmake -S . -B $build -DCMAKE_BUILD_TYPE=Release -DTRIBO_GSL=ON -DTRIBO_BUILD_EXAMPLES=ON ${parts-}
cmake --build $build --parallel "$(getconf _NPROCESSORS_ONLN)" \
    --target petsc_chain petsc_structure petsc_study petsc_single tribo_damper

rm -rf "$results"
mkdir -p "$results"
for program in petsc_chain petsc_structure petsc_study petsc_single tribo-damper; do
    ln -s "$PWD/$build/examples/$program" "$results"
done
status=0
for ranks; do
    for case in chain-rk4 chain-step structure structure-damped structure-cg copies vtk study study-marched \
        chain-fails structure-fails; do
        echo "== $case, $ranks ranks"
        sh "$here/check.sh" $case "$ranks" "$results" 'mpiexec -n' || status=1
    done
done
echo "== Tables and VTK files are in $results; $([ $status = 0 ] && echo all agree || echo "something does not agree")"
exit $status
