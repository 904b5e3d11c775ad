# SPDX-License-Identifier: BSD-3-Clause
# awk -v title=TEXT -v most=NUMBER -v hertz=F -f compare.awk damper-curve.csv record.txt...: amplitude and power of the last period of each
# record, named INCREMENTS.CASE/record.txt, beside the exact ones, and the order of their errors. Status 1 if errors of the last record
# exceed most, or the order of the amplitude from the first to the last is below 1.6.
function abs(x) { return x < 0 ? -x : x }
function finish() {
    if (rows > 0) {
        off = abs((highest - lowest) / 2 / exact_amplitude - 1)
        power = abs(hertz * energy / exact_power - 1)
        printf "| %s | %d | %.6f | %.1e | %.4f | %.1e |\n", title, increments, (highest - lowest) / 2, off, hertz * energy, power
        if (records++ == 0) {
            first_off = off
            first_increments = increments
        }
    }
}
BEGIN { FS = "," }
FNR == 1 && NR > 1 {
    finish()
    rows = energy = highest = lowest = place = 0
    FS = " "
    $0 = $0
    count = split(FILENAME, part, "/")
    increments = part[count - 1] + 0
}
NR == FNR {
    if (FNR == 2) {
        exact_amplitude = $3
        exact_power = $4
    }
    next
}
{
    if (rows++ > 0) {
        step = $1 - last
        place += (velocity + $2) / 2 * step
        for (i = 3; i < NF; i += 2) {
            energy -= step / 6 * (2 * $i * $(i + 1) + 2 * v[i] * f[i] + $i * f[i] + v[i] * $(i + 1))
        }
    }
    for (i = 3; i < NF; i += 2) {
        v[i] = $i
        f[i] = $(i + 1)
    }
    last = $1
    velocity = $2
    if (place > highest) highest = place
    if (place < lowest) lowest = place
}
END {
    finish()
    order = records > 1 ? log(first_off / off) / log(increments / first_increments) : 0
    printf "| exact | order %.2f | %.6f | | %.4f | |\n", order, exact_amplitude, exact_power
    exit !(off < most && power < most && order > 1.6)
}
