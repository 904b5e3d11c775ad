# SPDX-License-Identifier: BSD-3-Clause
# A block on a belt whose static friction is above kinetic: sticks, breaks away, sticks again.
name = 'stick-slip'; wide = 760; high = 400
load 'style.gp'
file = results.'/stick-slip.csv'
set xlabel 'time'
set xrange [0:30]
set yrange [-0.6:1.4]
set rmargin 14
set ytics 0.2
set key top right horizontal
set arrow 1 from 0, 1 to 30, 1 nohead linecolor '#808080' dashtype (4, 4)
set arrow 2 from 0, 0.6 to 30, 0.6 nohead linecolor '#808080' dashtype (4, 4)
set label 1 'static limit' at 30.4, 1 left textcolor '#606060'
set label 2 'kinetic limit' at 30.4, 0.6 left textcolor '#606060'
plot file using 1:2 with lines linestyle 11 title 'displacement', \
     file using 1:3 with lines linestyle 13 title 'velocity', \
     file using 1:4 with lines linestyle 12 title 'friction'
