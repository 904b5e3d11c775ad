# SPDX-License-Identifier: BSD-3-Clause
# sh check.sh RESULTS KEYS PROGRAM: runs a program of run.sh by itself, as a test. RESULTS is a folder for what it writes; its
# values are compared with those of expected.txt whose keys begin with KEYS and a point.
set -eu
cd "$(dirname -- "$0")"
results=$1 keys=$2 program=$3
rm -rf "$results"
mkdir -p "$results"
"$program" "$results" >"$results/values-printed.txt"
awk -F'|' -v keys="$keys." 'NR == 1 || index($1, keys) == 1' expected.txt >"$results/expected.txt"
awk -f summary.awk "$results"/values-*.txt "$results/expected.txt"
[ "$(wc -l <"$results/expected.txt")" -gt 1 ] || {
    echo "expected.txt has no key $keys"
    exit 1
}
