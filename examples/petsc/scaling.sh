#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# sh scaling.sh FOLDER [BLOCKS] [STEPS]: how the chain in FOLDER (build/release/examples) scales on 1 and 2 ranks, in motion. A
# line each: wall time times ranks of a block and step, the best of three runs, how much of it is tribo's, and memory of all ranks
# a block: PETSc's vectors, contacts, and the 50 MB that a rank begins with.
set -eu
. "$(dirname -- "$0")/mpi.sh"
chain=$1/petsc_chain blocks=${2-1000000} steps=${3-40}

measure() { # ranks, blocks of all, options
    ranks=$1 all=$2
    shift 2
    for run in 1 2 3; do
        mpiexec -n "$ranks" "$chain" -da_grid_x "$all" -velocity 0.1 -cycles 1 -steps 1000000000 \
            -ts_max_steps "$steps" "$@" -log_view -memory_view
    done | awk -v ranks="$ranks" -v all="$all" -v steps="$steps" '
        $1 == "Maximum" && /process memory/ { memory = $8 }
        $1 == "0:" && /Main Stage/ { rest = $4 }
        $1 == "1:" && /friction/ {
            time = rest + $3
            if (!best || time < best) {
                best = time
                share = $3 / time
            }
        }
        END { printf "%6.1f ns  tribo %4.1f%%  %3.0f B\n", 1e9 * best * ranks / steps / all, 100 * share, memory / all }'
}

for options in '' -step_form; do
    echo "${options:-rk4}"
    echo "  1 rank,  $blocks blocks:          $(measure 1 "$blocks" $options)"
    echo "  2 ranks, $blocks blocks (strong): $(measure 2 "$blocks" $options)"
    echo "  2 ranks, $((2 * blocks)) blocks (weak):   $(measure 2 $((2 * blocks)) $options)"
done
