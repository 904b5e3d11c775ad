#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# sh tests/abi/baseline.sh [--refresh]: the C libraries, built with debug information, beside what 1.0.0 promises: functions, types and
# enumerators, lib*.abi in this folder, as abidw writes them. What is removed or changed is an error, what is added is none.
# --refresh writes the files anew, for another soname only. Needs abigail-tools.
set -eu
CDPATH= cd -- "$(dirname -- "$0")/../.."
cmake --preset abi >/dev/null
cmake --build --preset abi --parallel 2 >/dev/null
for library in tribo tribo_dynamics tribo_gsl; do
    file=tests/abi/lib$library.abi built=build/abi/src/lib$library.so
    if [ "${1-}" = --refresh ]; then
        abidw --headers-dir include --drop-private-types --exported-interfaces-only --no-elf-needed --no-corpus-path \
            --no-comp-dir-path --no-show-locs --no-parameter-names "$built" | sed "s,$PWD/,," >"$file"
    else
        echo "== lib$library beside $file"
        abidiff --headers-dir2 include --drop-private-types --exported-interfaces-only --no-added-syms "$file" "$built"
    fi
done
