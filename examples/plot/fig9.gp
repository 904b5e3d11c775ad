# SPDX-License-Identifier: BSD-3-Clause
# Quinn (2004), Fig. 9: dissipation over cycle 4 of the chain, against the time step.
name = 'fig9'; wide = 760; high = 560
load 'style.gp'
set logscale xy
set xrange [7e-6:0.045]
set yrange [0.007:0.3]
set format x '10^{%T}'
set xlabel 'time step dt'
set ylabel 'dissipation per cycle D'
set ytics (0.007, 0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.3)
set key top left
plot 0.0104949600025 with lines linecolor '#404040' linewidth 0.7 title 'exact', \
     for [i = 1:6] results.'/fig9-'.law(i).'.csv' using 1:2 every ::1 with linespoints linestyle style(i) title law(i)
