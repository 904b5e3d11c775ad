# SPDX-License-Identifier: BSD-3-Clause
# The first mode of the beam on three contacts with springs: natural frequency and damping ratio over the amplitude.
name = 'beam-backbone'; wide = 760; high = 460
load 'style.gp'
file = results.'/backbone-backbone.csv'
set logscale x
set xrange [0.03:10]
set yrange [26:43]
set y2range [0:0.14]
set xlabel 'amplitude of the tip, mm'
set ylabel 'natural frequency, Hz' textcolor '#0072b2'
set y2label 'damping ratio' textcolor '#d55e00'
set ytics textcolor '#0072b2'
set y2tics 0.02 textcolor '#d55e00'
set label 1 'all contacts stick' at 0.032, 41.9 left textcolor '#0072b2'
set label 2 'all slide' at 2.6, 26.4 center textcolor '#0072b2'
set key top right spacing 1.3
plot file using 1:2 with lines linecolor '#0072b2' title 'frequency', \
     file using 1:3 axes x1y2 with lines linecolor '#d55e00' dashtype (10, 5) title 'damping ratio'
