# SPDX-License-Identifier: BSD-3-Clause
# Velocity and friction force of a contact over the last period: CalculiX with 250 and 1000 increments a period, and exact.
set output 'beam.png'
set multiplot layout 1,2
set grid
set key top right
set xlabel 'part of the period'
set xrange [0:1]
period = 1.0/30
first(x) = (x - 39*period)/period
set ylabel 'velocity of a contact, mm/s'
set datafile separator ','
plot '< cut -d, -f1,4 rigid-loop.csv' using ($1 <= 1 ? $1 : 1/0):2 with lines lw 3 lc rgb '#bbbbbb' title 'exact', \
     "< tr -s ' ' ',' < 250.rigid/record.txt" using (first($2)):4 with points pt 7 ps 0.4 lc rgb '#cc3311' title 'CalculiX, 250', \
     "< tr -s ' ' ',' < 1000.rigid/record.txt" using (first($2)):4 with lines lc rgb '#0077bb' title 'CalculiX, 1000'
set ylabel 'friction force, N'
set yrange [-6:9]
plot '< cut -d, -f1,5 rigid-loop.csv' using ($1 <= 1 ? $1 : 1/0):2 with lines lw 3 lc rgb '#bbbbbb' title 'exact', \
     "< tr -s ' ' ',' < 250.rigid/record.txt" using (first($2)):5 with points pt 7 ps 0.4 lc rgb '#cc3311' title 'CalculiX, 250', \
     "< tr -s ' ' ',' < 1000.rigid/record.txt" using (first($2)):5 with lines lc rgb '#0077bb' title 'CalculiX, 1000'
unset multiplot
