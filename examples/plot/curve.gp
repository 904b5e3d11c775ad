# SPDX-License-Identifier: BSD-3-Clause
# Curves that turn back: a mass with a stop over the frequency, stick-slip over the speed of a belt; stable and unstable parts.
name = 'curve'; wide = 1000; high = 420
load 'style.gp'
mass = results.'/curve-stop.csv'
block = results.'/curve-belt.csv'
points = results.'/curve-points.csv'
set multiplot
set lmargin at screen 0.08
set rmargin at screen 0.5
set xlabel 'frequency of the load'
set ylabel 'largest displacement' offset 1, 0
set xrange [0.6:1.5]
set yrange [0:3.5]
set key top left Left reverse
plot mass using (0.6 * column(1)):(column(4) == 1 ? column(2) : 1 / 0) with lines linestyle 11 linewidth 2 title 'stable', \
     mass using (0.6 * column(1)):(column(4) == 0 ? column(2) : 1 / 0) with lines linestyle 12 dashtype (6, 4) linewidth 2 title 'unstable', \
     points using (column(1) == 0 && column(2) == 1 ? 0.6 * column(3) : 1 / 0):4 with points pointtype 7 pointsize 0.8 linecolor '#000000' title 'turns back', \
     points using (column(1) == 0 && column(2) == 7 ? 0.6 * column(3) : 1 / 0):4 with points pointtype 6 pointsize 0.9 linecolor '#000000' title 'touches the stop'
set lmargin at screen 0.58
set rmargin at screen 0.98
set xlabel 'speed of the belt'
set xrange [0.9:1.5]
set yrange [0.5:2.5]
set key bottom right Left reverse
plot block using 1:(column(4) == 1 ? column(2) : 1 / 0) with lines linestyle 11 linewidth 2 title 'stick-slip', \
     block using 1:(column(4) == 0 ? column(2) : 1 / 0) with lines linestyle 12 dashtype (6, 4) linewidth 2 title 'unstable, without stick', \
     points using (column(1) == 1 && column(2) == 1 ? column(3) : 1 / 0):4 with points pointtype 7 pointsize 0.8 linecolor '#000000' title 'turns back', \
     points using (column(1) == 1 && column(2) == 9 ? column(3) : 1 / 0):4 with points pointtype 4 pointsize 0.9 linecolor '#000000' title 'state of rest'
unset multiplot
