#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# sh run.sh [BUILD]: CalculiX with tribo inside, a beam and a plate with friction contacts, beside tribo-damper's exact steady motion.
# Takes CalculiX's source package from the mirror that this machine's apt has, builds it once with cload.f in build/calculix (4
# minutes), runs a beam and a plate with several step lengths, compares, and draws build/calculix/results/beam/beam.png. Status 77:
# the source cannot be had.
# BUILD: a build folder of tribo, build/release unless given, which is configured if it is not there.
set -eu
CDPATH= cd -- "$(dirname -- "$0")/../.."
root=$PWD
build=$(mkdir -p "${1:-build/release}" && cd "${1:-build/release}" && pwd)
. tests/setup.sh
needs="gcc gfortran libc6-dev make cmake pkg-config libgsl-dev liblapack-dev libsuitesparse-dev zlib1g-dev libspooles-dev
    libarpack2-dev dpkg-dev gnuplot-nox"
# As a test it installs nothing.
if [ "${TRIBO_TEST-}" ] && [ "$(setup_missing $needs)" ]; then
    echo "missing: $(setup_missing $needs)"
    exit 77
fi
setup $needs

echo "== Building tribo in $build"
[ -f "$build/CMakeCache.txt" ] || cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DTRIBO_BUILD_TESTS=OFF
cmake --build "$build" --target tribo_fortran tribo_damper >/dev/null

work=$root/build/calculix
mkdir -p "$work/lists/partial" "$work/cache/archives/partial"
cd "$work"
if ! ls calculix-ccx-*/ccx_*/src/ccx_*.a >/dev/null 2>&1; then
    echo "== CalculiX's source"
    mirror=$(apt-get indextargets --format '$(SITE) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 2>/dev/null |
        awk '$3 == "main" && $1 ~ /debian$/ && $2 ~ /^[a-z]+$/ { print; exit }')
    echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror" >sources.list
    options="-o Dir::Etc::sourcelist=$work/sources.list -o Dir::Etc::sourceparts=/dev/null -o Dir::State::lists=$work/lists
        -o Dir::Cache=$work/cache"
    if [ -z "$mirror" ] || ! apt-get $options update >apt.txt 2>&1 || ! apt-get $options source calculix-ccx >>apt.txt 2>&1; then
        echo "the source of calculix-ccx cannot be had from this machine's mirror, '$mirror'"
        exit 77
    fi
    echo "== Building CalculiX"
    (cd calculix-ccx-*/ccx_*/src && nice -n 10 make -j"$(getconf _NPROCESSORS_ONLN)" \
        "$(sed -n 's/^\(ccx_[0-9.]*\): .*/\1/p' Makefile | head -n 1)" FFLAGS='-O2 -w -fallow-argument-mismatch' \
        CFLAGS='-O2 -w -I/usr/include/spooles -DARCH=Linux -DSPOOLES -DARPACK -DMATRIXSTORAGE') >make.txt 2>&1
fi

echo "== Linking it with cload.f and tribo"
archive=$(echo "$work"/calculix-ccx-*/ccx_*/src/ccx_*.a)
gfortran -O2 -c "$root/examples/calculix/cload.f" -o cload.o
gfortran -o ccx "${archive%.a}.o" cload.o "$archive" -L"$build/fortran" -ltribo_fortran -L"$build/src" -ltribo -lspooles -lpthread \
    -larpack -llapack -lblas -lm -fopenmp -Wl,-rpath,"$build/fortran:$build/src"

echo "== Running"
rm -rf results
mkdir results
cd results

# structure NAME DATA LENGTHS ELEMENTS MODES: a folder NAME with the mesh, the modes at the contacts and options of tribo-damper. Sets
# beforehand: places of contacts, place of the load, limit, force, hertz
structure() {
    name=$1 data=$root/examples/data/$2
    mkdir "$name"
    cd "$name"
    awk $3 $4 -f "$root/examples/calculix/mesh.awk" >mesh.inp
    contacts=$(node_at $places)
    loaded=$(node_at "$place")
    {
        printf '*INCLUDE,INPUT=mesh.inp\n*NSET,NSET=RUB\n'
        printf '%s\n' $contacts
        printf '*STEP\n*FREQUENCY\n%d\n*NODE PRINT,NSET=RUB\nU\n*END STEP\n' "$5"
    } >modes.inp
    "$work/ccx" -i modes >modes.txt
    for matrix in M K; do
        gzip -dc "$data/$matrix.mtx.gz" >$matrix.mtx 2>/dev/null || cp "$data/$matrix.mtx" $matrix.mtx
    done
    damper="$build/examples/tribo-damper --mass M.mtx --stiffness K.mtx --dofs $data/dofs.txt --load $place,z --force $force
        --drive $hertz --limits $limit --out ."
    cd ..
}

node_at() {
    for at; do
        awk -F, -v at="$at" 'NF == 4 && $2 "," $3 "," $4 == at { print $1 }' mesh.inp
    done
}

# The contacts' options for tribo-damper, with a word for each
contact_options() {
    for at in $places; do
        printf ' --contact %s,z%s' "$at" "$1"
    done
}

# run_case NAME TITLE MOST WAY INCREMENTS...: runs of CalculiX beside NAME-curve.csv of tribo-damper, in a structure's folder
run_case() {
    case=$1 title=$2 most=$3 way=$4
    shift 4
    records=
    for increments; do
        folder=$increments.$case
        mkdir "$folder"
        (cd "$folder" && awk -v contacts="$(echo $contacts)" -v loaded="$loaded" -v limit="$limit" -v force="$force" -v hertz="$hertz" \
            -v increments="$increments" -v way="$way" -f "$root/examples/calculix/deck.awk" ../modes.dat &&
            OMP_NUM_THREADS=1 "$work/ccx" -i beam >beam.txt)
        records="$records $folder/record.txt"
    done
    awk -v title="$title" -v most="$most" -v hertz="$hertz" -f "$root/examples/calculix/compare.awk" "$case-curve.csv" $records ||
        status=1
}

status=0
echo "== Beside the exact steady motion"
echo '| structure, contacts | increments a period | amplitude, mm | off by | power, mW | off by |'
echo '|---|---|---|---|---|---|'

places='100,0,5 100,20,5' place=400,20,5 limit=5 force=1 hertz=30
structure beam beam '-v length_x=400 -v length_y=20 -v length_z=5' '-v nx=8 -v ny=1' 4
cd beam
modal="--modes 4 --statics off --damping 0.05"
$damper $(contact_options '') $modal --name rigid >rigid.txt
cp rigid-curve.csv quinn-curve.csv
$damper $(contact_options :stiffness=500) $modal --name springs >springs.txt
run_case rigid 'beam, Coulomb over the step' 2e-4 1 250 500 1000 2000
run_case quinn "beam, Quinn's law" 3e-3 2 250 500 1000 2000
run_case springs 'beam, on springs' 3e-4 3 250 500 1000 2000
cd ..

places='50,0,4 50,100,4 100,0,4 100,100,4 150,0,4 150,100,4' place=300,50,4 limit=15 force=10 hertz=50
structure plate plate '-v length_x=300 -v length_y=100 -v length_z=4' '-v nx=12 -v ny=4' 8
cd plate
$damper $(contact_options '') --modes 8 --statics off --damping 0.05 --name rigid >rigid.txt
run_case rigid 'plate, Coulomb over the step' 1e-3 1 500 1000 2000
cd ../beam
gnuplot -e "set terminal pngcairo size 900,400" "$root/examples/calculix/beam.gp"
exit $status
