# SPDX-License-Identifier: BSD-3-Clause
# A mass driven round on a rough plane: one planar contact, and two scalar ones in its place.
name = 'whirl'; wide = 560; high = 620
load 'style.gp'
file = results.'/whirl.csv'
set size ratio -1
set xlabel 'x'
set ylabel 'y'
set xrange [-2.1:2.1]
set yrange [-2.1:2.6]
set key top left
orbit(i, steady) = sprintf("< awk -F, 'NF == 0 {b += 0.5} int(b) == %d && $4 == \"%d\"' '%s'", i, steady, file)
plot orbit(0, 0) using 2:3 with lines linecolor '#9cc8e3' linewidth 0.8 title 'from rest', \
     orbit(1, 1) using 2:3 with lines linestyle 12 title 'two scalar contacts', \
     orbit(0, 1) using 2:3 with lines linestyle 11 title 'a planar contact'
