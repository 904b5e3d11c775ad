#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Runs the paper's figures and a beam with friction through the library, and leaves tables and pictures in build/results.
# Complete on a bare Debian 12 machine: installs what is missing, see tests/setup.sh. Takes a minute after the build, on two
# cores. Its status is 0 only if every quantity of the closing table is within its tolerance (expected.txt).
set -eu
CDPATH= cd -- "$(dirname -- "$0")/.."
. tests/setup.sh

setup gcc gfortran libc6-dev make cmake pkg-config libgsl-dev liblapack-dev libsuitesparse-dev zlib1g-dev gnuplot-nox

build=build/release bin=build/release/examples results=$PWD/build/results
legacy='legacy_newmark_before legacy_newmark_after legacy_newmark_implicit legacy_rk45 legacy_fric legacy_lift legacy_vfric legacy_damper legacy_hosts'
contacts='contact_whirl contact_tipping contact_liftoff contact_stick_slip contact_hysteresis contact_platform contact_squeal contact_curve'
programs="paper_oscillator paper_dissipation paper_belt paper_chain tribo_damper $contacts clutches $legacy"
cores=$(getconf _NPROCESSORS_ONLN)
begin=$(date +%s)

echo "== Building in $build"
# A folder that tests/run.sh has configured stays as it is; else only what is needed here.
[ -f $build/CMakeCache.txt ] || parts='-DTRIBO_BUILD_TESTS=OFF'
cmake -S . -B $build -DCMAKE_BUILD_TYPE=Release \
    -DTRIBO_GSL=ON -DTRIBO_FORTRAN=ON -DTRIBO_BUILD_EXAMPLES=ON -DTRIBO_BUILD_TOOLS=ON ${parts-}
cmake --build $build --parallel "$cores" --target $programs

echo "== Running, $cores at a time; tables, pictures and logs go to $results"
rm -rf "$results"
mkdir -p "$results" build/plate
cp examples/data/plate/*.txt build/plate
for matrix in K M; do
    gzip -dc examples/data/plate/$matrix.mtx.gz >build/plate/$matrix.mtx
done
# The longest first, so that no core is left waiting.
{
    echo tribo-damper build/plate/plate.txt --check 2
    echo tribo-damper examples/data/beam/family.txt --check 5
    echo tribo-damper examples/data/beam/beam.txt --check 7 --step 0.05
    echo tribo-damper examples/data/beam/backbone.txt
    for figure in fig7a fig9 fig7b; do
        for law in smooth karnopp quinn-reversal quinn velocity-limited coulomb; do
            echo paper_dissipation $figure $law
        done
    done
    printf '%s\n' paper_belt paper_oscillator 'paper_dissipation rod quinn' paper_chain $contacts clutches $legacy
} | xargs -P "$cores" -L 1 sh examples/job.sh "$bin" "$results"

echo "== Drawing"
for script in examples/plot/*.gp; do
    case $script in */style*) continue ;; esac
    for format in png svg; do
        (cd examples/plot && LC_ALL=C.UTF-8 gnuplot -e "results='$results'; format='$format'" "${script##*/}")
    done
done
ls "$results"/*.png

echo "== Tables"
for figure in fig7a fig7b fig9; do
    sh examples/table.sh "$results" $figure
done
cat "$results/log-paper_oscillator.txt" "$results/log-paper_belt.txt" "$results"/log-tribo-damper-*.txt

echo
echo "== Summary, after $(($(date +%s) - begin)) s"
status=0
awk -f examples/summary.awk "$results"/values-*.txt examples/expected.txt >"$results/summary.txt" || status=$?
cat "$results/summary.txt"
exit $status
