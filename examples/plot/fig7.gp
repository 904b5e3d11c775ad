# SPDX-License-Identifier: BSD-3-Clause
# Quinn (2004), Fig. 7: error of the dissipation over cycle 50 of the forced oscillator, against the time step.
name = 'fig7'; wide = 1100; high = 560
load 'style.gp'
set multiplot layout 1, 2 margins 0.075, 0.985, 0.24, 0.93 spacing 0.09, 0.1
set logscale xy
set xrange [7e-6:0.14]
set format '10^{%T}'
set xlabel 'time step dt' offset 0, 0.4
set ylabel 'relative error of D' offset 1
set title 'a  sticks and slips (α = 1.5, ω = 0.5)' offset 0, -0.6
set key at screen 0.5, 0.03 center bottom maxrows 2 width 2
set yrange [3e-12:1]
plot for [i = 1:6] results.'/fig7a-'.law(i).'.csv' using 1:(abs($3)) every ::1 with linespoints linestyle style(i) title law(i)
set title 'b  never sticks (α = 2, ω = 2)'
unset key
set yrange [5e-8:1]
plot for [i = 1:6] results.'/fig7b-'.law(i).'.csv' using 1:(abs($3)) every ::1 with linespoints linestyle style(i)
unset multiplot
