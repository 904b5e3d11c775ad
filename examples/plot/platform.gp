# SPDX-License-Identifier: BSD-3-Clause
# A blade between two platform dampers: amplitude over the frequency, and how long contacts are open, for three preloads.
name = 'platform'; wide = 760; high = 560
load 'style.gp'
file = results.'/platform.csv'
set multiplot
set lmargin at screen 0.1
set rmargin at screen 0.97
set xrange [2:8]
set tmargin at screen 0.97
set bmargin at screen 0.40
set format x ''
set ylabel 'amplitude along the platforms'
set key top right
plot for [k = 1:3] file using 1:(column(4 * k - 2)) with lines linestyle 10 + k title 'preload '.word('2 8 32', k)
set tmargin at screen 0.36
set bmargin at screen 0.09
set format x '%g'
set xlabel 'frequency of the load, rad/time'
set ytics 0.1
set ylabel 'open, part'
plot for [k = 1:3] file using 1:(column(4 * k + 1)) with lines linestyle 10 + k notitle
unset multiplot
