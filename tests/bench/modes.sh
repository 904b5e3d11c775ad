#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# sh tests/bench/modes.sh build results [--quick]: plates of 10,680, 41,520 and 163,680 degrees of freedom (--quick: the first
# two) that CalculiX makes of what TRIBO_PLATES/plate.py writes; 20 modes of each by bench_modes and, where python3 has scipy, by
# eigsh(sigma=0), in turn, with each BLAS that is installed; frequencies beside those that CalculiX finds. One thread each. Prints
# a table; what cannot run here is named and left out.
set -eu
CDPATH= cd -- "$(dirname -- "$0")/../.."
here=$PWD bench=$PWD/$1/tests/bench results=$2 sizes='40,12 80,24 160,48'
[ "${3-}" != --quick ] || sizes='40,12 80,24'
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1

skip() {
    echo "bench_modes: left out, $1"
    exit 0
}
command -v ccx >/dev/null || skip "there is no ccx (Debian: calculix-ccx)"
python=${TRIBO_PYTHON:-python3}
"$python" -c 'import scipy.sparse.linalg' 2>/dev/null ||
    { echo "bench_modes: $python has no scipy (Debian: python3-scipy)"; python=; }
mkdir -p "$results/plates"
cd "$results/plates"

# plate <nx> <ny> <name> <solver>: in this folder, unless it is there
plate() {
    [ ! -f "$3.sta" ] || return 0
    awk -v nx="$1" -v ny="$2" -v modes=20 -v solver="$4" -f "$here/tests/bench/plate.awk" >"$3.inp"
    ccx -i "$3" >"$3.log" 2>&1
}

# value <name> <file>
value() {
    awk -v name="$1" '$1 == name { print $2 }' "$2"
}

libraries() {
    found=
    for folder in /usr/lib/*/blas /usr/lib/*/openblas-*; do
        [ ! -d "$folder" ] || found="$found $folder"
    done
    echo "${found:-as-installed}"
}

printf '%-18s %8s %10s %8s %8s %10s %10s %8s\n' BLAS ndof 'tribo, s' MB growth 'scipy, s' MB ratio
for blas in $(libraries); do
    before=
    for size in $sizes; do
        nx=${size%,*} ny=${size#*,} name=plate$nx
        plate "$nx" "$ny" "$name" MATRIXSTORAGE
        plate "$nx" "$ny" "arpack$nx" ARPACK
        awk '/E I G E N V A L U E   O/ { on = 1 } on && NF == 5 && $1 + 0 > 0 { print $4 } /P A R T I C/ { exit }' \
            "arpack$nx.dat" >"frequencies$nx.txt"
        : >scipy.txt
        [ -z "$python" ] || LD_LIBRARY_PATH=$blas "$python" "$here/tests/bench/peer_scipy.py" "$name" 20 >scipy.txt
        LD_LIBRARY_PATH=$blas "$bench/bench_modes" "$name.mas" "$name.sti" "$name.dof" 20 "$PWD/frequencies$nx.txt" >tribo.txt
        ratio=$(cat tribo.txt scipy.txt | awk '$1 == "modes" { t[++n] = $2 } END { if (n == 2) printf "%.2f", t[1] / t[2] }')
        now="$(value ndof tribo.txt) $(value modes tribo.txt)"
        growth=$(echo "$before $now" | awk 'NF == 4 { printf "%.2f", log($4 / $2) / log($3 / $1) }')
        printf '%-18s %8s %10s %8s %8s %10s %10s %8s\n' "$(basename "$blas")" $now "$(value memory tribo.txt)" "${growth:--}" \
            "$(value modes scipy.txt | grep . || echo -)" "$(value memory scipy.txt | grep . || echo -)" "${ratio:--}"
        before=$now
        echo "    largest difference from CalculiX's 20 frequencies: $(value difference tribo.txt)"
    done
done

cd "$results/plates"
echo "moreau/fixed on the plate of 41,520 as it is, and reduced to 100 modes and static responses, 10 contacts:"
"$bench/bench_whole" plate80.mas plate80.sti plate80.dof 10 100
