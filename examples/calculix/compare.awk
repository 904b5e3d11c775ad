# SPDX-License-Identifier: BSD-3-Clause
# awk -f compare.awk damper-curve.csv record.txt...: amplitude and power of the last period of each record, named
# INCREMENTS.WAY/record.txt, beside the exact ones, and the order of their errors. Status 1 if way 1 is worse than its bars.
function abs(x) { return x < 0 ? -x : x }
function finish(   off, power, rate, key) {
    if (rows == 0) {
        return
    }
    off = abs((highest - lowest) / 2 / exact_amplitude - 1)
    power = abs(30 * energy / exact_power - 1)
    key = way == 1 ? "Coulomb over the step" : "Quinn, lambda dt 0.2"
    printf "| %s | %d | %.6f | %.1e | %.4f | %.1e |\n", key, increments, (highest - lowest) / 2, off, 30 * energy, power
    if (way == 1 && increments == 1000 && !(off < 5e-4 && power < 5e-4)) {
        bad = 1
    }
    if (increments == 500) {
        coarse[way] = off
    }
    if (increments == 2000) {
        rate = log(coarse[way] / off) / log(4)
        printf "| | order | | %.2f | | |\n", rate
        done++
        if (!(rate > 1.6 && rate < 2.6)) {
            bad = 1
        }
    }
}
BEGIN {
    FS = ","
    print "| force | increments a period | amplitude, mm | off by | power, mW | off by |\n|---|---|---|---|---|---|"
}
FNR == 1 && NR > 1 {
    finish()
    rows = energy = highest = lowest = place = 0
    FS = " "
    $0 = $0
    count = split(FILENAME, part, "/")
    split(part[count - 1], name, ".")
    increments = name[1]
    way = name[2]
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
    printf "| exact | | %.6f | | %.4f | |\n", exact_amplitude, exact_power
    exit bad || done != 2
}
