# SPDX-License-Identifier: BSD-3-Clause
# sh difference.sh MOST: what tribo changes in newmark_before.f; fails if it is more than MOST lines.
set -eu
cd "$(dirname -- "$0")"
status=0
diff newmark_before.f newmark_after.f || status=$?
[ $status = 1 ]
lines=$(diff newmark_before.f newmark_after.f | grep -c '^>')
echo "$lines lines are new or changed, $1 at most"
[ "$lines" -le "$1" ]
