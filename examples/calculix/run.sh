#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# sh run.sh [BUILD]: CalculiX with tribo inside, a beam on two friction contacts, beside tribo-damper's exact steady motion.
# Takes CalculiX's source package from the mirror that this machine's apt has, builds it once with cload.f in build/calculix (4
# minutes), runs it with eight step lengths, compares, and draws build/calculix/results/beam.png. Status 77: the source cannot be had.
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
awk -v nx=8 -v ny=1 -v length_x=400 -v length_y=20 -v length_z=5 -f "$root/examples/calculix/mesh.awk" >mesh.inp
printf '*INCLUDE,INPUT=mesh.inp\n*NSET,NSET=RUB\n23,24\n*STEP\n*FREQUENCY\n4\n*NODE PRINT,NSET=RUB\nU\n*END STEP\n' >modes.inp
"$work/ccx" -i modes >modes.txt
for way in 1 2; do
    for increments in 250 500 1000 2000; do
        mkdir $increments.$way
        cd $increments.$way
        awk -v increments=$increments -v way=$way -f "$root/examples/calculix/deck.awk" ../modes.dat
        "$work/ccx" -i beam >beam.txt
        cd ..
        records="${records-} $increments.$way/record.txt"
    done
done
beam=$root/examples/data/beam
"$build/examples/tribo-damper" --mass "$beam/M.mtx" --stiffness "$beam/K.mtx" --dofs "$beam/dofs.txt" --load 400,20,5,z \
    --force 1 --contact 100,0,5,z --contact 100,20,5,z --modes 4 --statics off --damping 0.05 --drive 30 --limits 5 --out . >damper.txt
gnuplot -e "set terminal pngcairo size 900,400" "$root/examples/calculix/beam.gp"

echo "== Beside the exact steady motion"
awk -f "$root/examples/calculix/compare.awk" damper-curve.csv $records
