#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# page.sh <page> <program> <form> <executable>: the program of the page, see page.awk, prints what the page shows, but for spaces.
set -eu
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
awk -v program="$2" -v form="$3" -v what=text -f "$(dirname "$0")/page.awk" "$1" | sed 's/^ *//; s/  */ /g' >"$scratch/page"
"$4" | sed 's/^ *//; s/  */ /g' >"$scratch/program"
[ -s "$scratch/page" ]
diff -u "$scratch/page" "$scratch/program"
