#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# interfaces.sh <root> <folder of module files> <compiler>...: module trb_interfaces fits the calls of all programs in fixed form, and
# with it a wrong argument is an error at compile time.
set -eu
root=$1 modules=$2
shift 2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

# use <file>: the program with the module in all its units.
use() {
    awk 'pending && !/^     [^ ]/ { print "      USE TRB_INTERFACES"; pending = 0 }
         { print }
         /^      (PROGRAM|SUBROUTINE|[A-Z ]*FUNCTION) / { pending = 1 }' "$1"
}

for file in "$root"/tests/fortran/*.f "$root"/examples/legacy/*.f; do
    use "$file" >user.f
    "$@" -std=legacy -fsyntax-only -I "$root/examples/legacy/host" -I "$modules" user.f
done

# Changes of the page's program that are errors with the module, with words of the message, and none without.
awk -v program=steady -v form=f -v what=code -f "$root/tests/fortran/page.awk" "$root/fortran/README.md" >steady.f
while IFS='|' read -r change text; do
    sed "$change" steady.f >plain.f
    "$@" -std=legacy -w -fsyntax-only plain.f
    use plain.f >user.f
    if "$@" -std=legacy -fsyntax-only -I "$modules" user.f 2>errors || ! grep -q "$text" errors; then
        echo "not found with the module: $change"
        cat errors
        exit 1
    fi
done <<EOF
s/DOUBLE PRECISION XMIN/REAL XMIN/|passed REAL(4) to REAL(8)
s/DOUBLE PRECISION RM/REAL RM/|passed REAL(4) to REAL(8)
s/TRBLIM(IH, 1, FMUN/TRBLIM(IH, 1D0, FMUN/|passed REAL(8) to INTEGER(4)
s/TRBLIM(IH, 1, FMUN/TRBLIM(IH, FMUN/|Missing actual argument\|Type mismatch
s/0D0, PERIOD, Y, IERR/PERIOD, Y, IERR/|Missing actual argument\|mismatch
s/TRBDIS(IH, 1, E, IERR)/TRBDIS(IH, 1, E(1), 0)/|not definable\|INTENT = OUT\|variable definition
EOF
