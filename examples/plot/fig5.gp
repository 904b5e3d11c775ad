# SPDX-License-Identifier: BSD-3-Clause
# Quinn (2004), Fig. 5: the free oscillator near its rest point -0.75, and the whole motion.
name = 'fig5'; wide = 1000; high = 760
load 'style.gp'
file = results.'/fig5.csv'
set multiplot layout 2, 2 margins 0.09, 0.985, 0.08, 0.95 spacing 0.1, 0.13
set xlabel 'time t' offset 0, 0.4
set xrange [2:10]
set yrange [-0.78:-0.64]
set ylabel 'displacement x' offset 1
set title 'a  Coulomb: velocity chatters, x drifts' offset 0, -0.6
plot file using 1:2 with lines linestyle 1 dashtype 1
set title 'b  velocity-limited: creeps'
plot file using 1:5 with lines linestyle 2 dashtype 1
set title 'c  Quinn: rests (finer scale)'
set yrange [-0.7503:-0.7489]
set ytics 0.0004
set format y '%.4f'
set label 1 sprintf('x = %.7f', number('fig5.rest')) at 6, -0.75018 center
plot file using 1:8 with lines linestyle 5
unset label 1
set title 'd  the whole motion'
set xrange [0:10]
set yrange [-1.2:3]
set ytics 1
set format y '%g'
set key top right
plot file using 1:2 with lines linestyle 1 title 'Coulomb', \
     file using 1:5 with lines linestyle 2 title 'velocity-limited', \
     file using 1:8 with lines linestyle 5 title 'Quinn'
# inset of panel a
unset key
unset grid
unset title
unset ylabel
unset xlabel
set lmargin at screen 0.235
set rmargin at screen 0.475
set tmargin at screen 0.925
set bmargin at screen 0.79
set xrange [3:5]
set yrange [-0.002:0.0155]
set xtics 0.5 font ',8' offset 0, 0.6
set ytics 0.01 font ',8' offset 0.6
set label 2 'velocity' at graph 0.97, 0.86 right font ',9'
plot file using 1:3 with lines linecolor '#d55e00' linewidth 0.7
unset multiplot
