#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Builds the bench, with SUNDIALS, Siconos and CHOLMOD where they are installed (Debian: libsundials-dev, libsiconos-kernel-dev,
# g++, libsuitesparse-dev), runs it, draws a picture a system, and prints tables: run times aimed at and measured, and the fastest
# method for each error; then what a call of tribo_balance costs, a step in the plane, a steady motion, and the modes
# of large plates where CalculiX is installed, too (some minutes).
# Arguments go to the bench: `sh tests/bench/run.sh --quick`. Everything is left in build/bench/results.
set -eu
CDPATH= cd -- "$(dirname -- "$0")/../.."
. tests/setup.sh

case " $* " in *" --counts "*)
    # Instructions instead of times, which repeat: see counts.sh. `--counts --refresh` writes the table anew.
    case " $* " in *" --refresh "*) refresh=--refresh ;; *) refresh= ;; esac
    setup gcc libc6-dev gfortran make cmake pkg-config libgsl-dev liblapack-dev check valgrind
    cmake -S . -B build/counts -DCMAKE_BUILD_TYPE=Release -DTRIBO_FORTRAN=ON -DTRIBO_BUILD_EXAMPLES=OFF
    cmake --build build/counts --parallel "$(getconf _NPROCESSORS_ONLN)" --target bench_counts
    exec sh tests/bench/counts.sh build/counts/tests/bench/bench_counts tests/bench/counts.txt $refresh
    ;;
esac

setup gcc libc6-dev make cmake pkg-config libgsl-dev liblapack-dev libsuitesparse-dev zlib1g-dev check gnuplot-nox

build=build/bench results=$PWD/build/bench/results
echo "== Building in $build"
cmake -S . -B $build -DCMAKE_BUILD_TYPE=Release -DTRIBO_FORTRAN=OFF -DTRIBO_BUILD_EXAMPLES=OFF -DTRIBO_BENCH_PEERS=ON
cmake --build $build --parallel "$(getconf _NPROCESSORS_ONLN)" --target bench bench_balance bench_periodic bench_planar bench_follow \
    bench_kernels bench_modes bench_whole bench_points

echo "== Running; tables and pictures go to $results"
rm -f "$results"/*.csv
mkdir -p "$results/balance" "$results/periodic"
# One thread: times are those of one processor.
OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 $build/tests/bench/bench --out "$results" "$@"
case " $* " in *" --quick "*) quick=--quick ;; *) quick= ;; esac
OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 $build/tests/bench/bench_balance --out "$results/balance" $quick \
    > "$results/balance/tables.txt"
$build/tests/bench/bench_planar > "$results/planar.txt"
$build/tests/bench/bench_follow > "$results/follow.txt"
$build/tests/bench/bench_kernels $quick > "$results/kernels.txt"
$build/tests/bench/bench_periodic --out "$results/periodic" > "$results/periodic.txt"
$build/tests/bench/bench_points > "$results/points.txt"
sh tests/bench/modes.sh $build "$results" $quick > "$results/modes.txt"

echo "== Drawing"
for format in png svg; do
    (cd tests/bench && LC_ALL=C.UTF-8 gnuplot -e "results='$results'; format='$format'" work-precision.gp)
    for name in contacts near islands sparse; do
        (cd tests/bench && LC_ALL=C.UTF-8 gnuplot -e "results='$results/balance'; format='$format'; name='$name'" balance.gp)
    done
done

awk -f tests/bench/tables.awk "$results"/*.csv | tee "$results/tables.txt"
cat "$results/balance/tables.txt" "$results/kernels.txt" "$results/planar.txt" "$results/follow.txt" "$results/periodic.txt" "$results/points.txt" \
    "$results/modes.txt"
