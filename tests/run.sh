#!/bin/sh
# Builds the project with everything on and runs all its tests. Arguments go to ctest: `sh tests/run.sh -L unit`.
# Complete on a bare Debian 12 machine: installs what is missing, see setup.sh. Its status is that of ctest.
set -eu
CDPATH= cd -- "$(dirname -- "$0")/.."
. tests/setup.sh

setup gcc g++ gfortran libc6-dev make cmake pkg-config libgsl-dev liblapack-dev libsuitesparse-dev zlib1g-dev check clang valgrind

echo "== Building in build/release"
cmake --preset release
cmake --build --preset release --parallel "$(getconf _NPROCESSORS_ONLN)"
echo "== Testing"
exec ctest --preset release --parallel 2 "$@"
