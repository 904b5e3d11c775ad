# SPDX-License-Identifier: BSD-3-Clause
# A driven block whose normal load lifts off: friction within limits that open and close.
name = 'liftoff'; wide = 760; high = 420
load 'style.gp'
file = results.'/liftoff.csv'
set xlabel 'part of a period'
set xrange [0:1]
set yrange [-1.8:2.2]
set key top right horizontal maxrows 2
set style fill solid 0.5 noborder
plot file using 1:(-$5):5 with filledcurves linecolor '#cfe3f1' title 'limits of friction', \
     file using 1:4 with lines linestyle 12 dashtype 1 title 'friction', \
     file using 1:2 with lines linestyle 11 title 'displacement', \
     file using 1:3 with lines linestyle 13 title 'velocity'
