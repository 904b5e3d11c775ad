# SPDX-License-Identifier: BSD-3-Clause
# sh check.sh CASE RANKS PROGRAMS MPIEXEC: runs one of the PETSc programs as a test, in a folder of its own under PROGRAMS, the
# folder that they are in. MPIEXEC: how it is started, without the number of ranks ("mpiexec -n").
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
case=$1 ranks=$2 programs=$3 mpiexec=$4
beam=$here/../data/beam
work=$programs/petsc-$case-$ranks
rm -rf "$work"
mkdir -p "$work"
cd "$work"
. "$here/mpi.sh"

run() {
    program=$1
    shift
    $mpiexec "$ranks" "$programs/$program" "$@"
}

same() { # tolerance, of two files
    awk -v tolerance="$1" -f "$here/compare.awk" "$2" "$3"
}

printf '%s\n' '# row other limit' '117 0 0.02' '189 0 0.02' '261 0 0.01' '225 168 0.003' >contacts.txt
structure="-mass $beam/M.mtx -stiffness $beam/K.mtx -contacts contacts.txt -places $beam/dofs.txt -load_row 264 -load 0.1"
study="-mass $beam/M.mtx -stiffness $beam/K.mtx -contacts contacts.txt -load_row 264 -load 0.1"
short='-omega 8000 -ts_dt 2e-6 -ts_max_steps 500 -every 100'

# The same by moreau/fixed in one process: damping, steps, every.
single() {
    "$programs/petsc_single" structure $beam/M.mtx $beam/K.mtx contacts.txt 288 264 0.1 8000 "$1" 2e-6 "$2" "$3" >single.txt
}

# It must stop, all of it, and say this.
fails() {
    message=$1
    shift
    status=0
    run "$@" >out.txt 2>&1 || status=$?
    grep -F "$message" out.txt
    [ $status != 0 ]
}

case $case in
chain-rk4 | chain-step)
    method=rk4/fixed error=1.1e-4 cycles=4 options='-ts_view_solution binary:state.bin'
    [ $case = chain-rk4 ] || { method=central/fixed error=9e-4 options=-step_form; }
    alpha=0.25
    [ $ranks = 1 ] || { alpha=0.8 cycles=1; } # what moves the blocks of all ranks; messages take long where ranks wait for cores
    run petsc_chain -steps 1257 -alpha $alpha -cycles $cycles $options >out.txt
    "$programs/petsc_single" chain $method 32 1257 $cycles $alpha >single.txt
    same 1e-10 out.txt single.txt
    if [ $ranks = 1 ]; then
        tail -n 1 out.txt >last.txt
        echo 'cycle 4 dissipates 0.0104949600025' >exact.txt # Coulomb's law
        same $error last.txt exact.txt
    elif [ $case = chain-rk4 ]; then # the same bits on any number of ranks
        $mpiexec 1 "$programs/petsc_chain" -steps 1257 -alpha $alpha -cycles $cycles -ts_view_solution binary:one.bin >one.txt
        cmp state.bin one.bin
    fi
    ;;
structure)
    run petsc_structure $structure $short >out.txt
    single 0 500 100
    same 1e-9 out.txt single.txt
    ;;
structure-damped)
    run petsc_structure $structure $short -damping 1e-6 >out.txt
    single 1e-6 500 100
    same 1e-7 out.txt single.txt # the driver works with M^-1 K, whose rounding this is
    ;;
structure-cg)
    run petsc_structure $structure $short -ts_max_steps 50 -every 10 -ksp_type cg -pc_type gamg >out.txt
    single 0 50 10
    same 1e-9 out.txt single.txt
    ;;
copies)
    run petsc_structure $structure $short -copies 3 >out.txt
    grep '^# 3 islands' out.txt
    cut -d ' ' -f 1,2 out.txt >moved.txt
    run petsc_structure $structure $short | cut -d ' ' -f 1,2 >alone.txt
    same 1e-9 moved.txt alone.txt
    $mpiexec 1 "$programs/petsc_structure" $structure $short -copies 3 >one.txt
    same 1e-9 out.txt one.txt
    ;;
vtk)
    run petsc_structure $structure $short -vtk 'motion-%04d.vtk' -ts_monitor >out.txt
    grep -q '^500 TS dt 2e-06 time 0.001' out.txt
    awk '$1 == "POINTS" { points = $2 } $1 == "SCALARS" { what = $2; n = -1 } what && NF == 1 { count[what]++ }
        what == "slip" && NF == 1 && $1 != 3 { contacts++ }
        END { print points, count["friction"], count["slip"], contacts
              exit !(points == 100 && count["friction"] == 100 && count["slip"] == 100 && contacts == 4) }' motion-0005.vtk
    run petsc_chain -steps 1257 -ts_max_steps 2 -ts_monitor_solution_vtk 'chain-%04d.vts' >chain.txt
    grep -q 'chain.dissipated' chain-0002.vts
    ;;
study) # the same bits on any number of ranks, also when a run goes on from what another has left
    options="$study -omega 160,175 -omegas 4 -scale 0.1,10 -scales 5"
    $mpiexec 1 "$programs/petsc_study" $options -out one.txt | grep 'computed 20 of 20'
    if grep nan one.txt; then
        exit 1
    fi
    run petsc_study $options -out all.txt
    cmp one.txt all.txt
    head=$(head -n 1 one.txt | wc -c) line=$(sed -n 2p one.txt | wc -c)
    cp one.txt part.txt
    dd if=/dev/zero of=part.txt bs=1 seek=$((head + 2 * line + 5)) count=$((3 * line)) conv=notrunc 2>dd.txt
    cut=$((head + 17 * line - 1))
    head -c $cut part.txt >rest.txt
    run petsc_study $options -out rest.txt | grep 'computed 8 of 20' # 2 to 5, and 16 to 19
    cmp one.txt rest.txt
    run petsc_study $options -out rest.txt | grep 'computed 0 of 20'
    cmp one.txt rest.txt
    fails 'holds other results' petsc_study $options -damping 0.01 -out rest.txt
    cmp one.txt rest.txt
    ;;
study-marched) # what rk4 comes to in some 80 cycles
    printf '%s\n' '117 0 0.01' '189 0 0.01' '261 0 0.01' >contacts.txt
    "$programs/tribo-damper" --read "$beam/beam.txt" --limits 0.01:0.01:1 --method march --out . >damper.txt
    hz=$(awk -F, '$1 == 1 { print $2 }' damper-frequencies.csv)
    omega=$(awk -v hz="$hz" 'BEGIN { printf "%.12g", 8 * atan2(1, 1) * hz }')
    run petsc_study $study -omega $omega -out marched.txt
    tail -n 1 marched.txt | awk '{ print $4, $5 * $2 / (8 * atan2(1, 1)) }' >found.txt
    awk -F, 'NR == 2 { print $3, $4 }' damper-curve.csv >expected.txt
    same 1e-3 found.txt expected.txt
    ;;
chain-fails) # the first rank pulls its first block, the others wait for their neighbours
    fails 'nan is not finite (contact 0 is block 0)' petsc_chain -steps 1257 -alpha 1e308
    fails 'are not stable: less than 0.0411' petsc_chain -steps 300
    ;;
structure-fails) # the first rank has the only island, the others wait for its forces
    fails 'is not finite' petsc_structure $structure $short -load 1e307
    echo '276 0 -0.5' >>contacts.txt
    fails 'tribo on rank 0: a value is negative: limit[4] = -0.5 is negative (contacts: 0 1 2 3 4)' \
        petsc_structure $structure $short
    ;;
*)
    echo "there is no case $case"
    exit 1
    ;;
esac
