#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# sh tests/run.sh [--all] [--no-install] [<argument of ctest>...]
# Builds the project with everything on and runs the tests that a change can break: `sh tests/run.sh -L unit`. --all runs all tests:
# the matrix of other compilers, machines, libraries and builds, analysis of the sources, and the long suites. See README.md here.
# Complete on a bare Debian 12 machine: installs what is missing, see setup.sh; --no-install names it and stops. The status is that
# of ctest.
set -eu
CDPATH= cd -- "$(dirname -- "$0")/.."
. tests/setup.sh

preset=release
packages="gcc g++ gfortran libc6-dev make cmake pkg-config libgsl-dev liblapack-dev libsuitesparse-dev zlib1g-dev check clang valgrind"
while :; do
    case ${1-} in
    --all)
        preset=all
        packages="$packages git libclang-rt-dev clang-tidy abigail-tools gcc-multilib musl-tools gcc-mingw-w64-x86-64 wine libopenblas0-pthread
            python3-numpy libspooles-dev libarpack2-dev dpkg-dev gnuplot-nox libsundials-dev
            python3-scipy"
        ;;
    --no-install) setup_install=no ;;
    *) break ;;
    esac
    shift
done
setup $packages

echo "== Building in build/release"
cmake --preset release
cmake --build --preset release --parallel "$(getconf _NPROCESSORS_ONLN)"
echo "== Testing"
exec ctest --preset $preset --parallel 2 "$@"
