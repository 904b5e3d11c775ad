# SPDX-License-Identifier: BSD-3-Clause
# A program of a page, or its output:
#   awk -v program=<name> -v form=<f or f90> -v what=<code or text> -f page.awk <page>
# A block ```fortran, ```f77 or ```f90 is a program in fixed form if it begins in column 7; the next block ```text is its output.
/^```/ {
    on = !on
    if (on) {
        kind = substr($0, 4)
        lines = ""
        next
    }
    if (kind ~ /^(fortran|f77|f90)$/) {
        split(tolower(lines), words, " ")
        found = words[2] "." (lines ~ /^      / ? "f" : "f90") == program "." form
        shown = 0
        if (found && what == "code") printf "%s", lines
    } else if (kind == "text" && found && !shown) {
        shown = 1
        if (what == "text") printf "%s", lines
    }
    next
}
on { lines = lines $0 "\n" }
