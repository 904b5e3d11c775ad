# SPDX-License-Identifier: BSD-3-Clause
# awk -f summary.awk results/values-*.txt expected.txt: the closing table. Exits with 1 if a value is missing or off.
BEGIN { FS = " " }
FILENAME !~ /expected.txt$/ { value[$1] = $2; next }
FNR == 1 {
    FS = "|"
    line = "%-52s %10s %17s %17s %10s %s\n"
    printf line, "quantity", "paper", "reference", "here", "rel. diff.", ""
    $0 = $0
}
/^# -- / { printf "\n%s\n", substr($0, 6); next }
/^#/ || NF < 5 { next }
{
    rows++
    reference = substr($4, 1, 1) == "@" ? value[substr($4, 2)] : $4
    if (!($1 in value) || reference == "") {
        printf line, $2, $3, $4, "missing", "", "FAILED"
        failed++
        next
    }
    here = value[$1]
    difference = reference != 0 ? here / reference - 1 : here
    size = difference < 0 ? -difference : difference
    if ($5 ~ /^</) {
        bad = !(size < substr($5, 2) + 0)
    } else {
        bad = !(size <= $5 + 0)
    }
    failed += bad
    # two digits more than what is compared
    digits = $5 > 0 ? int(3 - log($5) / log(10)) : 3
    format = "%." (digits < 4 ? 4 : digits) "g"
    if ($5 ~ /^</) {
        printf line, $2, $3, $5, sprintf("%.2g", here), "", (bad ? "FAILED" : "")
    } else {
        shown_reference = substr($4, 1, 1) == "@" ? sprintf(format, reference) : reference
        printf line, $2, $3, shown_reference, sprintf(format, here), sprintf("%.1e", difference), (bad ? "FAILED" : "")
    }
}
END {
    printf "\n%d quantities, %d off\n", rows, failed
    exit failed > 0
}
