# SPDX-License-Identifier: BSD-3-Clause
# A joint of 25 elastic contacts: its branches are the first loading doubled, small loops close.
name = 'hysteresis'; wide = 620; high = 460
load 'style.gp'
file = results.'/hysteresis.csv'
set xlabel 'displacement'
set ylabel 'force of the joint'
set xrange [-0.9:0.9]
set yrange [-0.55:0.55]
set key bottom right
branch(b) = sprintf("< awk -F, 'NR > 1 && $1 == %d' '%s'", b, file)
plot branch(0) using 2:3 with lines linestyle 11 dashtype (4, 3) title 'first loading', \
     for [b in '1 2 5'] branch(int(b)) using 2:3 with lines linestyle 11, \
     branch(3) using 2:3 with lines linestyle 12 title 'a small loop, which closes', \
     branch(4) using 2:3 with lines linestyle 12, \
     for [b = 0:3] "< awk -F, '$1 == ".b." {z = $2; f = $3} END {print z \",\" f}' '".file."'" using 1:2 with points pointtype 7 \
         pointsize 0.8 linecolor '#404040' title (b == 0 ? 'turning points' : '')
