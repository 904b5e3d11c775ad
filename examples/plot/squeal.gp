# SPDX-License-Identifier: BSD-3-Clause
# Squeal: how a motion grows about the unstable sliding state, and the limit cycle in the plane of x and x'.
name = 'squeal'; wide = 1000; high = 420
load 'style.gp'
growth = results.'/squeal-growth.csv'
cycle = results.'/squeal-cycle.csv'
set multiplot
set lmargin at screen 0.09
set rmargin at screen 0.5
set xlabel 't'
set ylabel 'x'
set xrange [0:60]
plot growth using 1:2 with lines linecolor '#000000' linewidth 0.8
set lmargin at screen 0.6
set rmargin at screen 0.98
set xlabel 'x'
set ylabel "x'" offset 1, 0
set xrange [-0.2:0.35]
set yrange [-1.3:0.95]
set key at graph 0.5, 0.45 center Left reverse
# Kinds of moments: 1 sticks, 2 breaks away, 4 lifts off, 5 touches down and slides.
slides(k) = k == 2 || k == 5
plot cycle using 2:(slides(column(6)) ? column(4) : 1 / 0) with lines linestyle 12 dashtype 1 linewidth 2 title 'slips', \
     cycle using 2:(column(6) == 1 ? column(4) : 1 / 0) with lines linestyle 11 linewidth 2 title 'sticks', \
     cycle using 2:(column(6) == 4 ? column(4) : 1 / 0) with lines linestyle 13 dashtype 1 linewidth 2 title 'is open'
unset multiplot
