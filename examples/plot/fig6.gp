# SPDX-License-Identifier: BSD-3-Clause
# Quinn (2004), Fig. 6: force and velocity where the oscillator comes to rest, under Quinn's law.
name = 'fig6'; wide = 720; high = 440
load 'style.gp'
set xlabel 'time t'
set xrange [2.5:3.5]
set yrange [-1.3:1.5]
set key top right
plot results.'/fig5.csv' using 1:10 with lines linestyle 11 title 'friction force f', \
     results.'/fig5.csv' using 1:9 with lines linestyle 12 title 'velocity x′'
