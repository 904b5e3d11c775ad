#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The run scripts' setup, on machines that are made up: commands in a folder of its own in front of, or instead of, PATH.
set -eu
cd "$1"
for script in tests/*.sh tests/*/*.sh examples/*.sh .ci/run; do
    [ ! -e "$script" ] || sh -n "$script"
done

stub=$(mktemp -d)
trap 'rm -rf "$stub"' EXIT
command_stub() { # <name> <line of sh>
    printf '#!/bin/sh\n%s\n' "$2" >"$stub/$1"
    chmod +x "$stub/$1"
}
fail() {
    cat "$stub/log"
    echo "setup.sh: $*"
    exit 1
}
# try <path> <package>...: its status, and what it says in $stub/log
try() {
    path=$1
    shift
    status=0
    PATH=$path "$sh" -c '. tests/setup.sh && setup "$@" && echo went on' sh "$@" >"$stub/log" 2>&1 || status=$?
}
says() {
    grep -qF -- "$1" "$stub/log"
}
sh=$(command -v sh)

command_stub present ''
try "$stub:$PATH" present
[ $status = 0 ] && says 'went on' || fail "stops though all is there"

command_stub id 'echo 1000'
command_stub sudo 'exit 1'
command_stub apt-get "echo \"\$*\" >>'$stub/apt'"
try "$stub:$PATH" present absent-1 absent-2
[ $status = 1 ] && says 'as root' && says 'apt-get install -y --no-install-recommends absent-1 absent-2' ||
        fail "does not name what is missing"
! says 'went on' && [ ! -e "$stub/apt" ] || fail "does not stop without root"

command_stub id 'echo 0'
status=0
PATH=$stub:$PATH "$sh" -c '. tests/setup.sh && setup_install=no && setup absent && echo went on' >"$stub/log" 2>&1 || status=$?
[ $status = 1 ] && says 'Missing' && says 'absent' && ! says 'went on' && [ ! -e "$stub/apt" ] || fail "installs against the order"

try "$stub:$PATH" present absent
[ $status = 1 ] && says 'not found or too old: absent' || fail "takes apt-get's word for it"
[ "$(cut -d' ' -f1 "$stub/apt" | tr '\n' ' ')" = 'update install ' ] || fail "does not update, then install"

command_stub apt-get "[ \$1 = update ] || { : >'$stub/absent' && chmod +x '$stub/absent'; }"
try "$stub:$PATH" present absent
[ $status = 0 ] && says 'went on' || fail "does not go on after installing"
says '== Installing absent' || fail "does not name what it installs"

rm "$stub/absent"
command_stub id 'echo 1000'
command_stub sudo '[ "$1" != -n ] || shift; echo "by sudo: $1"; exec "$@"'
try "$stub:$PATH" present absent
[ $status = 0 ] && says 'went on' && says 'by sudo: env' || fail "does not install by sudo"

rm "$stub/apt-get"
for tool in grep rm; do
    ln -s "$(command -v $tool)" "$stub/$tool"
done
try "$stub" present nonsuch
[ $status = 1 ] && says "(the names are Debian's): nonsuch" || fail "does not stop without apt-get"
