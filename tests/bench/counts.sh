#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Counts the instructions of the scenes of bench_counts under callgrind, and compares them with a table of earlier ones.
#   counts.sh <bench_counts> <counts.txt>              status 1 if a scene takes more than 2% more, or has no line in the table
#   counts.sh <bench_counts> <counts.txt> --refresh    writes the table
set -eu
LC_ALL=C
export LC_ALL
program=$1 table=$2 mode=${3:-}

compiled=$(gcc --version | head -n 1)
measure() {
    echo "# $compiled; instructions a unit, as callgrind counts them, with the AVX2 variants of kernels"
    for scene in $("$program" --list); do
        units=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect=counted --log-file="$log" \
            "$program" "$scene")
        echo "$scene $(sed -n 's/.*Collected : *//p' "$log") $units"
    done | awk '{ printf "%s %.2f %s\n", $1, $2 / $3, $4 }'
}

log=$(mktemp)
counts=$(mktemp)
trap 'rm -f "$log" "$counts"' EXIT
measure > "$counts"
if [ "$mode" = --refresh ]; then
    cp "$counts" "$table"
    cat "$table"
    exit
fi
[ "$(head -n 1 "$table")" = "$(head -n 1 "$counts")" ] || echo "The table is of another compiler: $(head -n 1 "$table")"
awk '
    /^#/ { next }
    NR == FNR { before[$1] = $2; next }
    !($1 in before) { printf "%-22s %12.2f a %-8s not in the table\n", $1, $2, $3; failed = 1; next }
    {
        change = $2 / before[$1] - 1
        word = change > 0.02 ? "MORE" : change < -0.02 ? "less: refresh the table" : ""
        printf "%-22s %12.2f a %-8s %+6.1f%% %s\n", $1, $2, $3, 100 * change, word
        failed = failed || change > 0.02
    }
    END { exit failed }
' "$table" "$counts"
