#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# pages.sh: pages and headers keep their sizes, each public function is named in a page or an example, each path and name of code in
# src/README.md exists, and each source names its licence.
#   README.md has at most 150 lines; a comment of a header at most 12, but the one at its head, which follows that of the licence.
set -eu
CDPATH= cd -- "$(dirname -- "$0")/../.."
bad=0
lines=$(wc -l <README.md)
if [ "$lines" -gt 150 ]; then
    echo "README.md has $lines lines, more than 150"
    bad=1
fi
awk 'FNR == 1 { comments = 0 }
     /^[ \t]*\/\*/ { begin = FNR; comments++ }
     /\*\/$/ && begin { if (comments > 2 && FNR - begin >= 12) {
                            printf "%s:%d: a comment of %d lines, more than 12\n", FILENAME, begin, FNR - begin + 1
                            bad = 1
                        }
                        begin = 0 }
     END { exit bad }' include/tribo/*.h || bad=1
for name in $(sed -n 's/^TRIBO_API [^(]*\b\(tribo_[a-z0-9_]*\)(.*/\1/p' include/tribo/*.h | sort -u); do
    grep -rqw "$name" README.md include/tribo/README.md src/dynamics/README.md fortran/README.md examples || {
        echo "no page and no example names $name"
        bad=1
    }
done
for path in $(grep -o '`[A-Za-z0-9_./]*/[A-Za-z0-9_]*\.[a-z0-9]*`' src/README.md | tr -d '\140' | sort -u); do
    [ -e "src/$path" ] || [ -e "$path" ] || {
        echo "src/README.md names $path, which does not exist"
        bad=1
    }
done
for name in $(grep -o '`[a-z_]*`' src/README.md | tr -d '\140' | sort -u); do
    grep -rqw --exclude='*.md' "$name" src fortran include || [ -e "src/$name" ] || {
        echo "src/README.md names $name, which is nowhere in the sources"
        bad=1
    }
done
without=$(find include src fortran tests examples -name 'corpus*' -prune -o \( -name '*.[chf]' -o -name '*.f90' -o -name '*.cpp' -o \
    -name '*.sh' -o -name '*.awk' -o -name '*.gp' -o -name '*.py' -o -name '*.cmake' -o -name CMakeLists.txt \) \
    -exec grep -L 'SPDX-License-Identifier: BSD-3-Clause' {} +)
if [ "$without" ]; then
    printf '%s: does not name its licence (SPDX-License-Identifier)\n' $without
    bad=1
fi
exit $bad
