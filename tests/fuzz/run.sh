#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# sh tests/fuzz/run.sh [<seconds> [<target>...]]: builds the targets of libFuzzer with sanitizers and lets each search for so many
# seconds, 300 by default. What is found, and strings that reach what others do not, go to build/fuzz/found/<target>.
# Targets: core (tribo.h), dynamics (tribo_dynamics.h, tribo_gsl.h), reader (files), options (tribo-damper's), trb (TRB routines).
set -eu
CDPATH= cd -- "$(dirname -- "$0")/../.."
. tests/setup.sh
setup gcc gfortran libc6-dev make cmake pkg-config libgsl-dev liblapack-dev libsuitesparse-dev zlib1g-dev check clang libclang-rt-dev

seconds=${1:-300}
[ $# = 0 ] || shift
[ $# != 0 ] || set -- core dynamics reader options trb
cmake --preset fuzz
for target; do
    cmake --build --preset fuzz --parallel 2 --target "fuzz_$target"
done
for target; do
    case $target in
    core) corpus=tests/stress/corpus ;;
    dynamics) corpus=tests/stress/corpus_gsl ;;
    *) corpus=tests/fuzz/corpus/$target ;;
    esac
    found=build/fuzz/found/$target
    mkdir -p "$found/strings"
    echo "== $target, $seconds s"
    build/fuzz/tests/fuzz/fuzz_$target -max_total_time="$seconds" -timeout=60 -artifact_prefix="$found/" -print_final_stats=1 \
        "$found/strings" "$corpus" 2>"$found/log" || {
        tail -40 "$found/log"
        exit 1
    }
    awk '/number_of_executed_units/ { runs = $2 } / cov: / { reached = $4 } END { print runs " strings, " reached " edges" }' "$found/log"
done
