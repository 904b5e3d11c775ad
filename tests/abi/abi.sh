#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The binary interface, in files kept beside this one.
#   abi.sh check <file> <what>...     compares <file> with what is there now
#   abi.sh refresh <file> <what>...   writes it anew
#   abi.sh no_gsl <library>           nothing that the library needs is GSL's
#   abi.sh names <file>...            a map, a header, symbols and prototypes: all must name the same functions
# <what> is one of
#   symbols <library>                 soname and exported symbols with their versions
#   constants <header> <base> <cc>... value of all enumerators and macros of <header> that the header <base> (or none) does not
#   have;
#                                     <cc> is the compiler with the flags that the headers need
#   prototypes <header>               the functions once more: a C file that only compiles if its prototypes are the header's
# To be run in the build folder.
set -eu
export LC_ALL=C
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Names of Fortran modules are the compiler's own, and no promise.
symbols() {
    objdump -p "$1" | awk '$1 == "SONAME" { print $2 }'
    nm -D --defined-only -P "$1" | awk '$2 != "A" && !/_MOD_/ { print $1 }' | sort
}

# Macros with a value, and enumerators: these survive the preprocessor. Versions may change.
constant_names() (
    header=$1
    [ "$header" != none ] || return 0
    shift
    {
        "$@" -E -dM "$header" | sed -n 's/^#define \(TRIBO_[A-Z0-9_]*\) ..*/\1/p'
        "$@" -E -P "$header" | grep -o '\bTRIBO_[A-Z0-9_]*'
    } | grep -v -e '^TRIBO_API$' -e '^TRIBO_VERSION' | sort -u
)

constants() {
    header=$1 base=$2
    shift 2
    constant_names "$header" "$@" >"$scratch/all"
    constant_names "$base" "$@" >"$scratch/base"
    {
        printf '#include <stdio.h>\n#include "%s"\nint main(void) {\n' "$header"
        comm -23 "$scratch/all" "$scratch/base" | sed 's/.*/printf("%s = %.17g\\n", "&", (double)(&));/'
        echo 'return 0; }'
    } >"$scratch/print.c"
    "$@" "$scratch/print.c" -o "$scratch/print"
    "$scratch/print"
}

prototypes() {
    printf '/* SPDX-License-Identifier: BSD-3-Clause */\n'
    printf '/* Written by abi.sh: the prototypes once more. With another one in the header this does not compile. */\n'
    printf '#include "tribo/%s"\n\n' "${1##*/}"
    awk '/^TRIBO_API / { on = 1 } on; /;$/ { on = 0 }' "$1"
}

names() {
    case $1 in
    *.map) sed -n 's/^ *\(tribo_[a-z0-9_]*\);.*/\1/p' "$1" ;;
    *.symbols) sed -e 1d -e 's/@.*//' "$1" ;;
    *) sed -n 's/^TRIBO_API [^(]*\b\(tribo_[a-z0-9_]*\)(.*/\1/p' "$1" ;;
    esac | sort -u
}

mode=$1 file=$2
shift 2
case $mode in
check)
    "$@" >"$scratch/now"
    diff -u "$file" "$scratch/now" || {
        echo "The interface is no longer that of $file. If that is meant: cmake --build $PWD --target abi-refresh"
        exit 1
    }
    ;;
refresh)
    "$@" >"$scratch/now"
    cp "$scratch/now" "$file"
    ;;
no_gsl)
    if { objdump -p "$file" | grep NEEDED; nm -D --undefined-only "$file"; } | grep -i gsl; then
        echo "$file needs GSL."
        exit 1
    fi
    ;;
names)
    names "$file" >"$scratch/first"
    for other; do
        names "$other" >"$scratch/other"
        diff -u "$scratch/first" "$scratch/other" || {
            echo "$file (-) and $other (+) name different functions."
            exit 1
        }
    done
    ;;
esac
