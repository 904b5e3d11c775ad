#!/bin/bash -eu
# SPDX-License-Identifier: BSD-3-Clause
# OSS-Fuzz: targets that need no Fortran and no GSL, linked statically, with their corpora. $CC, $CFLAGS, $LIB_FUZZING_ENGINE and $OUT are
# given; on another machine: OUT=/tmp/out CC=clang CFLAGS="-g -O1 -fsanitize=fuzzer-no-link,address,undefined" bash build.sh
cd "$(dirname "$0")"
[ -e CMakeLists.txt ] || cd "${SRC:-../../..}${SRC:+/tribo}"
cmake -S . -B build/oss-fuzz -DCMAKE_BUILD_TYPE=Debug -DCMAKE_C_FLAGS_DEBUG="" -DBUILD_SHARED_LIBS=OFF -DTRIBO_FUZZ=ON \
    -DTRIBO_GSL=OFF -DTRIBO_FORTRAN=OFF -DTRIBO_SPARSE=OFF -DTRIBO_BUILD_EXAMPLES=OFF -DBLA_STATIC=ON
for target in core reader options; do
    corpus=tests/fuzz/corpus/$target
    [ "$target" != core ] || corpus=tests/stress/corpus
    cmake --build build/oss-fuzz --target "fuzz_$target" --parallel "$(nproc)"
    cp "build/oss-fuzz/tests/fuzz/fuzz_$target" "$OUT/$target"
    (cd "$corpus" && python3 -m zipfile -c "$OUT/${target}_seed_corpus.zip" ./*)
done
