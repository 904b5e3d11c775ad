# SPDX-License-Identifier: BSD-3-Clause
# sh table.sh RESULTS FIGURE: relative error of D of all laws against dt, side by side, and the fitted orders.
set -eu
cd "$1"
laws='coulomb velocity-limited smooth karnopp quinn quinn-reversal'
for law in $laws; do
    set -- "$@" "$2-$law.csv"
done
figure=$2
shift 2
echo
echo "$figure: relative error of D"
awk -F, -v laws="$laws" '
    FNR == 1 { file++; next }
    { dt[FNR] = $1; error[FNR, file] = $3; if (FNR > rows) rows = FNR }
    END {
        n = split(laws, law, " ")
        printf "%12s", "dt"
        for (i = 1; i <= n; i++) printf "%17s", law[i]
        for (r = 2; r <= rows; r++) {
            printf "\n%12.4g", dt[r]
            for (i = 1; i <= n; i++) printf "%17s", (r, i) in error ? sprintf("%.2e", error[r, i]) : ""
        }
        printf "\n"
    }' "$@"
printf '%12s' order
for law in $laws; do
    awk -v key="$figure.$law.order" '$1 == key { printf "%17.2f", $2 }' "values-$figure-$law.txt"
done
printf '\n'
