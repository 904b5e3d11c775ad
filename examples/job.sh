# SPDX-License-Identifier: BSD-3-Clause
# One job of run.sh: sh job.sh BINARIES RESULTS PROGRAM [CASE LAW], or tribo-damper with a file of options and further ones. Its
# output goes to a log, and its last line to the terminal.
set -eu
bin=$1 results=$2 program=$3
shift 3
begin=$(date +%s)
printf '   started   %s\n' "$program $*"
case $program in
legacy_*) # prints its values
    log=$results/values-$program.txt
    set -- "$results" "$@"
    ;;
tribo-damper) # on one core: the other one has the next job
    log=${1##*/}
    log=$results/log-$program-${log%.txt}.txt
    set -- --threads 1 --out "$results" --read "$@"
    ;;
*)
    log=$results/log-$program${1:+-$1}${2:+-$2}.txt
    set -- "$results" "$@"
    ;;
esac
if ! "$bin/$program" "$@" >"$log" 2>&1; then
    printf '   FAILED    %s: %s\n' "$program" "$(tail -n 1 "$log")"
    exit 1
fi
printf '   %3d s     %s\n' $(($(date +%s) - begin)) "$(tail -n 1 "$log")"
