# SPDX-License-Identifier: BSD-3-Clause
# Cost of a call. From run.sh: results (folder of bench_balance's tables), format, name (of the table).
wide = 760; high = 480
load '../../examples/plot/style.gp'
set style line 1 linecolor '#0072b2' dashtype 1 pointtype 7 pointsize 0.9 linewidth 1.6
set style line 2 linecolor '#d55e00' dashtype 1 pointtype 5 pointsize 0.8 linewidth 1.6
set style line 3 linecolor '#009e73' dashtype 1 pointtype 9 pointsize 1.0 linewidth 1.6
set style line 4 linecolor '#000000' dashtype 1 pointtype 3 pointsize 1.1 linewidth 1.4
set style line 5 linecolor '#0072b2' dashtype (6, 3) pointtype 6 pointsize 1.0 linewidth 1.3
set style line 6 linecolor '#d55e00' dashtype (6, 3) pointtype 4 pointsize 0.9 linewidth 1.3
set style line 7 linecolor '#009e73' dashtype (6, 3) pointtype 8 pointsize 1.1 linewidth 1.3
set style line 8 linecolor '#000000' dashtype (6, 3) pointtype 12 pointsize 1.2 linewidth 1.1
set style line 20 linecolor '#909090' dashtype (2, 3) linewidth 1.2
set logscale xy
set format '10^{%T}'
set ylabel 'time of a call, µs'
set key outside right center samplen 2 font ',10' width -2
table = results.'/'.name.'.csv'
n = int(system("cut -d, -f1 '".table."' | sed 1d | uniq | wc -l"))
curve(k) = system("cut -d, -f1 '".table."' | sed 1d | uniq | sed -n ".k."p")
rows(k) = "< grep '^".curve(k).",' '".table."'"
# a line of this slope below the end of curve k, over so many decades
last(k, column) = real(system("grep '^".curve(k).",' '".table."' | tail -1 | cut -d, -f".column))
array x_end[n]
array t_end[n]
do for [k = 1:n] {
    x_end[k] = last(k, 2)
    t_end[k] = 1e6*last(k, 4)
}
reference(x, k, slope, decades) = x > x_end[k] || x < x_end[k]/10.0**decades ? NaN : 0.4*t_end[k]*(x/x_end[k])**slope
set samples 400
set xlabel name eq 'near' ? 'contacts near stick in one dense group, s' : \
    name eq 'islands' ? 'sleeping islands of 8' : 'contacts, n'
if (name eq 'contacts') {
    set title 'A call against the number of contacts'
    plot for [k = 1:n] rows(k) using 2:($4*1e6) with linespoints linestyle k title curve(k), \
        reference(x, 4, 1, 2) linestyle 20 title 'slope 1', \
        reference(x, 5, 2, 1.5) linestyle 20 title 'slope 2'
}
if (name eq 'near') {
    set title 'A call against the number of contacts near stick'
    plot for [k = 1:n] rows(k) using 2:($4*1e6) with linespoints linestyle k title curve(k), \
        reference(x, 2, 2, 1.5) linestyle 20 title 'slope 2', \
        reference(x, 4, 3, 1) linestyle 20 title 'slope 3'
}
if (name eq 'islands') {
    set title 'A call against the number of sleeping islands'
    plot for [k = 1:n] rows(k) using 2:($4*1e6) with linespoints linestyle k title curve(k), \
        "< grep '^100 islands' '".table."' > '".results."/awake.tmp'; ".\
        "grep '^none' '".table."' | paste -d, '".results."/awake.tmp' -; rm '".results."/awake.tmp'" \
        using 2:(($4 - $17)*1e6) with linespoints linestyle 3 title 'their difference', \
        reference(x, 2, 1, 2) linestyle 20 title 'slope 1'
}
if (name eq 'sparse') {
    set title 'A call in one sparse group'
    plot for [k = 1:n] rows(k) using 2:($4*1e6) with linespoints linestyle k title curve(k), \
        reference(x, 1, 1, 2) linestyle 20 title 'slope 1'
}
