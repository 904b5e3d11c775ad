# SPDX-License-Identifier: BSD-3-Clause
# Four shafts with three clutches: speeds, and the events.
name = 'clutches'; wide = 760; high = 420
load 'style.gp'
file = results.'/clutches.csv'
set xlabel 't'
set ylabel 'speed'
set xrange [0:1.5]
set yrange [0:10.5]
set key top right opaque
event(k) = number(sprintf('clutches.event%d', k))
do for [k = 1:7] { set arrow k from event(k), graph 0 to event(k), graph 1 nohead linecolor '#b0b0b0' linewidth 0.8 }
plot file using 1:2 with lines linestyle 11 title 'shaft 1', \
     file using 1:3 with lines linestyle 12 title 'shaft 2', \
     file using 1:4 with lines linestyle 13 title 'shaft 3', \
     file using 1:5 with lines linestyle 6 linewidth 1.5 title 'shaft 4'
