# SPDX-License-Identifier: BSD-3-Clause
# Quinn (2004), Fig. 9, from the table of the Fortran program.
name = 'fig9-fortran'; wide = 760; high = 560
load 'style.gp'
set logscale xy
set xrange [2e-4:0.045]
set yrange [0.007:0.3]
set format x '10^{%T}'
set xlabel 'time step dt'
set ylabel 'dissipation per cycle D'
set ytics (0.007, 0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.3)
set key top left
table = results.'/fig9-fortran.csv'
plot number('fortran.fig9.exact') with lines linecolor '#404040' linewidth 0.7 title 'exact', \
     for [i = 1:3] table using 1:(column(word('2 3 4', i) + 0)) every ::1 with linespoints linestyle int(word('1 2 5', i)) \
         title word('coulomb velocity-limited quinn', i)
