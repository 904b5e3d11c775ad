# SPDX-License-Identifier: BSD-3-Clause
# From the bench's tables, in Markdown: run times aimed at and measured, and the fastest method for each error.
# A method reaches an error if all its finer settings do, too. Times are in units of plain rk4 + Quinn at dt = 0.01.
BEGIN {
    FS = ","
    columns = split("oscillator-7a oscillator-7b chain-32 belt", column, " ")
    levels = split("1e-3 1e-4 1e-6 1e-8", level, " ")
    wanted["exact"] = "0.03 0.058 0.85 0.076"
    wanted["event"] = "0.3 0.5 5 0.6"
    wanted["fixed"] = "0.04 - 0.17 0.12"
    today["1e-3"] = "0.024 0.5 1 0.11"
    today["1e-4"] = "0.08 0.7 3.7 0.25"
    today["1e-6"] = "0.24 1.6 9.5 1.5"
    today["1e-8"] = "2.6 2.7 51 3.2"
}

FNR == 1 { next }

{
    if (!($1 in known)) {
        known[$1] = 1
        name[++systems] = $1
    }
    label = $2 " " $3 ($4 == "coulomb" ? "" : ", " $4)
    key = $1 "," label
    if (!(key in rows)) {
        method[$1, ++methods[$1]] = label
    }
    rows[key]++
    error[key, rows[key]] = $6
    seconds[key, rows[key]] = $7
    ratio[key, rows[key]] = $8
}

# Time in which a method stays below an error, in units or, with in_us = 1, in microseconds; 0 if it never does.
function time_for(system_name, label, most,    key, i, best, time) {
    key = system_name "," label
    best = 0
    for (i = rows[key]; i > 0 && error[key, i] + 0 <= most + 0; i--) {
        time = in_us ? 1e6 * seconds[key, i] : ratio[key, i]
        if (!best || time < best) {
            best = time
        }
    }
    return best
}

# Time of the fastest of the methods that match, see time_for; sets fastest = its name.
function best_for(system_name, pattern, most,    i, time, best) {
    best = 0
    fastest = ""
    for (i = 1; i <= methods[system_name]; i++) {
        if (method[system_name, i] ~ pattern) {
            time = time_for(system_name, method[system_name, i], most)
            if (time && (!best || time < best)) {
                best = time
                fastest = method[system_name, i]
            }
        }
    }
    return best
}

function number(x) { return x ? sprintf("%.2g", x) : "-" }

function wanted_row(text, list, pattern, most,    i, want, line, here) {
    split(list, want, " ")
    line = "| " text " |"
    for (i = 1; i <= columns; i++) {
        here = best_for(column[i], pattern, most)
        line = line sprintf(" %s / %s%s |", want[i], number(here), want[i] != "-" && (!here || here > want[i]) ? " *" : "")
    }
    print line
}

# A row of microseconds.
function us_row(text, pattern, most,    i, line, here) {
    line = "| " text " |"
    in_us = 1
    for (i = 1; i <= columns; i++) {
        here = best_for(column[i], pattern, most)
        line = line (here ? sprintf(here < 100 ? " %.2g |" : " %.0f |", here) : " |")
    }
    in_us = 0
    print line
}

END {
    print "\n## Run time in microseconds\n"
    print "| method, error | oscillator 7a | 7b | chain n = 32 | belt |\n|---|---|---|---|---|"
    us_row("`exact`, 1e-11", "^tribo exact$", 1e-11)
    us_row("`event`, 1e-9", "^tribo event$", 1e-9)
    us_row("`central/fixed`, 1e-3", "^tribo central/fixed$", 1e-3)
    us_row("`rk4/fixed`, Quinn\047s law, 1e-3", "^tribo rk4/fixed, quinn", 1e-3)
    us_row("SUNDIALS with events, 1e-8", "^sundials ", 1e-8)
    us_row("Siconos, 1e-3", "^siconos ", 1e-3)

    print "\n## Aim / measured; * is not reached\n"
    print "| | oscillator 7a | 7b | chain n = 32 | belt |\n|---|---|---|---|---|"
    wanted_row("exact, error <= 1e-11", wanted["exact"], "^tribo exact$", 1e-11)
    wanted_row("event, error <= 1e-9", wanted["event"], "^tribo event$", 1e-9)
    wanted_row("central, error <= 1e-3", wanted["fixed"], "^tribo central/fixed$", 1e-3)

    print "\n## Best of other tools: elsewhere / here\n"
    print "| error | oscillator 7a | 7b | chain n = 32 | belt |\n|---|---|---|---|---|"
    for (l = 1; l <= levels; l++) {
        split(today[level[l]], want, " ")
        line = "| " level[l] " |"
        for (i = 1; i <= columns; i++) {
            here = number(best_for(column[i], "^(plain|sundials|siconos) ", level[l]))
            line = line sprintf(" %s / %s %s |", want[i], here, fastest)
        }
        print line
    }

    print "\n## This library: exact, event at two errors, the fastest fixed-step method at three\n"
    print "| system | exact | event, 1e-4 | 1e-9 | fixed steps, 1e-2 | 1e-3 | 1e-4 |\n|---|---|---|---|---|---|---|"
    for (s = 1; s <= systems; s++) {
        line = "| " name[s] " | " number(best_for(name[s], "^tribo exact$", 1e-10)) " |"
        line = line " " number(best_for(name[s], "^tribo event$", 1e-4)) " |"
        line = line " " number(best_for(name[s], "^tribo event$", 1e-9)) " |"
        for (most = 1e-2; most > 0.5e-4; most /= 10) {
            line = line sprintf(" %s", number(best_for(name[s], "^tribo .*/fixed", most)))
            sub(/^tribo /, "", fastest)
            line = line " " fastest " |"
        }
        print line
    }
}
