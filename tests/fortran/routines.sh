#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Every function of the headers has a routine of fixed form, or a reason for none, and every routine is told of and tested:
#   routines.sh <root of the sources>
# compares routines.txt with the headers, trb.f90 and trb_dynamics.f90, their table in fortran/README.md, and the tests in fixed form.
set -eu
export LC_ALL=C
cd "$1"
list=tests/fortran/routines.txt
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

routines() { grep -oh '\bTRB[A-Z0-9]\{1,3\}\b' "$@" | sort -u; }

# same <what> <what>: files of the scratch folder that must have the same lines.
same() {
    diff -u "$scratch/$1" "$scratch/$2" || {
        echo "$1 (-) and $2 (+) differ: see tests/fortran/routines.txt"
        exit 1
    }
}

grep -v '^#' "$list" >"$scratch/list"
awk '{ print $1 }' "$scratch/list" | sort >"$scratch/functions listed"
sed -n 's/^TRIBO_API [^(]*\b\(tribo_[a-z0-9_]*\)(.*/\1/p' include/tribo/tribo.h include/tribo/tribo_dynamics.h include/tribo/tribo_gsl.h | sort >"$scratch/headers"
same "functions listed" headers

awk '$2 != "-" { for (k = 2; k <= NF; k++) print $k } NF < 3 && $2 == "-" || NF < 2 { print $1, "has no routine and no reason" }' \
    "$scratch/list" | sort >"$scratch/routines listed"
sed -n 's/^subroutine \(trb[a-z0-9]*\)(.*/\1/p' fortran/trb.f90 fortran/trb_dynamics.f90 | tr a-z A-Z | sort >"$scratch/sources"
same "routines listed" sources

grep '^| *`TRB' fortran/README.md | routines >"$scratch/table of fortran README"
same sources "table of fortran README"
grep -h '^!>   TRB' fortran/trb.f90 fortran/trb_dynamics.f90 | routines >"$scratch/heads of the sources"
same sources "heads of the sources"

cat tests/fortran/*.f | grep -oi '\bCALL TRB[A-Z0-9]*' | awk '{ print $2 }' | sort -u >"$scratch/tests"
same sources tests
