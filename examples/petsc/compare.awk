# SPDX-License-Identifier: BSD-3-Clause
# awk -v tolerance=T -f compare.awk A B: whether two tables hold the same numbers in the columns that B has, to T times the
# largest of a column. Words must be the same; lines that begin with # are left out.
FNR == 1 { file++; rows[file] = 0 }
!/^#/ {
    rows[file]++
    for (i = 1; i <= NF; i++) {
        value[file, rows[file], i] = $i
        size = $i < 0 ? -$i : $i + 0
        largest[i] = size > largest[i] ? size : largest[i]
    }
    columns = NF
}
END {
    if (rows[1] != rows[2] || rows[1] == 0) {
        printf "%d lines and %d\n", rows[1], rows[2]
        exit 1
    }
    for (r = 1; r <= rows[1]; r++) {
        for (i = 1; i <= columns; i++) {
            a = value[1, r, i]
            b = value[2, r, i]
            number = a ~ /^[-+.0-9]+(e[-+0-9]+)?$/ && b ~ /^[-+.0-9]+(e[-+0-9]+)?$/
            off = a > b ? a - b : b - a
            if (number ? off > tolerance * largest[i] : a != b) {
                printf "line %d, column %d: %s and %s\n", r, i, a, b
                bad = 1
            }
            worst = number && largest[i] > 0 && off / largest[i] > worst ? off / largest[i] : worst
        }
    }
    printf "%d lines, off by %.1e at most, allowed %.1e\n", rows[1], worst, tolerance
    exit bad
}
