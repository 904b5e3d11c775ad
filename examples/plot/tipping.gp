# SPDX-License-Identifier: BSD-3-Clause
# A box that falls on a rough floor, slides, tips over and comes to rest.
name = 'tipping'; wide = 760; high = 620
load 'style.gp'
file = results.'/tipping.csv'
set multiplot
set origin 0, 0.42
set size 1, 0.58
set size ratio -1
set xlabel 'x, m'
set ylabel 'height, m'
set xrange [-0.2:1.0]
set yrange [-0.03:0.72]
set key outside right title 'time, s'
at(t) = sprintf("< awk -F, 'NF == 0 {print; next} $1 + 0 == %g || $1 == \"t\"' '%s'", t, file)
shade = '#c3dcec #9cc8e3 #6fb0d6 #3c94c4 #0072b2 #00395a'
plot for [k = 0:5] at(0.15 * k) using 2:3 with lines linecolor rgb word(shade, k + 1) linewidth 1.2 title sprintf('%.2f', 0.15 * k), \
     0 with lines linecolor '#404040' linewidth 1.2 notitle
set origin 0, 0
set size 1, 0.42
set size noratio
set xlabel 'time, s'
set ylabel 'energy, J'
set y2label 'corners on the floor'
set xrange [0:1.2]
set yrange [0:*]
set y2range [-0.2:8.2]
set y2tics 2
set key inside top right notitle
plot results.'/tipping-energy.csv' using 1:2 with lines linestyle 11 title 'energy', \
     '' using 1:3 axes x1y2 with steps linestyle 12 title 'corners'
unset multiplot
