# SPDX-License-Identifier: BSD-3-Clause
# Quinn (2004), Fig. 11: two blocks on a belt. Lines: consistent coupling; circles: the paper's partition.
name = 'fig11'; wide = 900; high = 720
load 'style.gp'
file = results.'/fig11.csv'
set multiplot layout 2, 1 margins 0.085, 0.985, 0.08, 0.94 spacing 0.1, 0.13
set xrange [0:60]
set xlabel 'time t' offset 0, 0.4
set key horizontal at graph 1, 1.02 right bottom
set label 1 'a' at graph -0.085, 1.05 left font ',14'
set ylabel 'displacement'
plot file using 1:2 with lines linestyle 11 title 'x_1', file using 1:3 with lines linestyle 12 title 'x_2', \
     file using 1:6 every 20 with points pointtype 6 pointsize 0.7 linecolor '#0072b2' title 'the same by partition', \
     file using 1:7 every 20 with points pointtype 6 pointsize 0.7 linecolor '#d55e00'
set label 1 'b'
set ylabel 'relative velocity'
plot file using 1:4 with lines linestyle 11 title 'z_1′ (belt and lower block)', \
     file using 1:5 with lines linestyle 12 title 'z_2′ (between the blocks)', \
     file using 1:8 every 20 with points pointtype 6 pointsize 0.7 linecolor '#0072b2', \
     file using 1:9 every 20 with points pointtype 6 pointsize 0.7 linecolor '#d55e00'
unset multiplot
