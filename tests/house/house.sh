#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# house.sh <awk>: measures src by house.awk, prints each row beside its bound in bounds.txt, and fails where a row is above it.
# A change that makes a row smaller lowers the bound: `sh tests/house/house.sh awk > rows` shows the values.
set -eu
CDPATH= cd -- "$(dirname -- "$0")/../.."
find src -name '*.[ch]' | LC_ALL=C sort | xargs "$1" -f tests/house/house.awk |
  "$1" -F '\t' '
    NR == FNR { bound[$1] = $2; next }
    {
      worse = !($1 in bound) || $2 > bound[$1]
      bad += worse
      printf "%-50s %6d   at most %6s%s%s\n", $1, $2, bound[$1], $3 ? "   " $3 : "", worse ? "   <-- WORSE" : ""
      rows++
    }
    END { exit bad > 0 || rows == 0 }' tests/house/bounds.txt -
