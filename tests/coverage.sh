#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# sh tests/coverage.sh [<argument of ctest>...]: builds without optimization and with counters (preset coverage), runs the suites, and
# prints for each room of src and for fortran the lines and branches that were reached. What was not is listed by file in
# build/coverage/lines.txt and branches.txt. A line or branch counts as reached if any of the objects made of its file reaches it.
# Without running the suites again: sh tests/coverage.sh --report
set -eu
CDPATH= cd -- "$(dirname -- "$0")/.."
root=$PWD build=$PWD/build/coverage
if [ "${1-}" != --report ]; then
    cmake --preset coverage
    cmake --build --preset coverage --parallel "$(getconf _NPROCESSORS_ONLN)"
    find "$build" -name '*.gcda' -exec rm -f {} +
    ctest --preset coverage --parallel 2 "$@" || echo "== Some tests failed: what they would have reached is missing"
fi
find "$build/src" "$build/fortran" "$build/tests" -name '*.gcda' |
    grep -E '/(src|fortran)/CMakeFiles/|/src/damper/' >"$build/counters.txt"
# gcov's text: "count:line:source" of each line, and "branch n taken count" behind it; files begin with line 0, "Source:path".
# shellcheck disable=SC2046 # no blank is in a path of the build folder
(cd "$build" && gcov --branch-probabilities --branch-counts --stdout $(cat counters.txt) 2>/dev/null) |
    awk -v root="$root/" -v lines="$build/lines.txt" -v branches="$build/branches.txt" '
    function room(path, part, n) {
        n = split(path, part, "/")
        return n > 2 ? part[1] "/" part[2] : part[1]
    }
    /^ *-: *0:Source:/ {
        file = $0
        sub(/.*Source:/, "", file)
        on = index(file, root) == 1
        file = substr(file, length(root) + 1)
        on = on && file ~ /^(src|fortran)\//
        next
    }
    !on { next }
    /^branch/ {
        id = file SUBSEP at SUBSEP (++branch)
        if (!(id in taken)) { taken[id] = 0; order[++ids] = id }
        if ($0 !~ /never executed/ && $4 + 0 > 0) taken[id] = 1
        next
    }
    /^ *[-#=0-9]+\*?: *[0-9]+:/ {
        split($0, part, ":")
        at = part[2] + 0
        branch = 0
        count = part[1]
        gsub(/[ *]/, "", count)
        if (at == 0 || count == "-") next
        id = file SUBSEP at
        if (!(id in reached)) { reached[id] = 0; line[++total] = id }
        if (count !~ /^[#=]/) reached[id] = 1
    }
    END {
        printf "" >lines
        printf "" >branches
        for (k = 1; k <= total; k++) {
            split(line[k], part, SUBSEP)
            r = room(part[1])
            all[r]++; good[r] += reached[line[k]]
            if (!reached[line[k]]) print part[1] ":" part[2] | ("sort -t: -k1,1 -k2,2n >>" lines)
        }
        for (k = 1; k <= ids; k++) {
            split(order[k], part, SUBSEP)
            r = room(part[1])
            ball[r]++; bgood[r] += taken[order[k]]
            if (!taken[order[k]]) print part[1] ":" part[2] | ("sort -u -t: -k1,1 -k2,2n >>" branches)
        }
        printf "%-20s %8s %8s %10s %8s\n", "room", "lines", "reached", "branches", "reached"
        for (r in all)
            printf "%-20s %8d %7.1f%% %10d %7.1f%%\n", r, all[r], 100 * good[r] / all[r], ball[r], ball[r] ? 100 * bgood[r] / ball[r] : 100 | "sort"
    }'
