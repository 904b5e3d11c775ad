#!/bin/sh
# pages.sh: pages and headers keep their sizes, and each public function is named in a page or an example.
#   README.md has at most 150 lines; a comment of a header at most 12, but the one at its head.
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
     /\*\/$/ && begin { if (comments > 1 && FNR - begin >= 12) {
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
exit $bad
