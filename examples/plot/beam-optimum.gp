# SPDX-License-Identifier: BSD-3-Clause
# The beam on three contacts, at its first resonance: amplitude and dissipated power against the limit, and some by marching.
name = 'beam-optimum'; wide = 760; high = 460
load 'style.gp'
file = results.'/damper-curve.csv'
marched = results.'/damper-check.csv'
set logscale x
set logscale y
set xrange [1e-4:1]
set format x '10^{%T}'
set format y '10^{%T}'
set yrange [1e-4:100]
set xlabel 'friction limit of each contact (mu times normal load), N'
set ylabel 'amplitude of the tip, mm' textcolor '#0072b2'
set y2label 'dissipated by friction, mW' textcolor '#d55e00'
set y2range [0:30]
set y2tics 5
set ytics textcolor '#0072b2'
set y2tics textcolor '#d55e00'
best = number('damper.best.limit')
set arrow 1 from best, graph 0 to best, graph 1 nohead linecolor '#808080' dashtype (4, 4)
set label 1 sprintf("most power\n%.4f N", best) at best * 1.12, graph 0.95 left textcolor '#404040'
set key at graph 0.02, 0.79 left top Left reverse spacing 1.3
set label 2 'no friction' at 1.5e-4, 25 left textcolor '#0072b2'
set label 3 'all contacts stuck' at 0.9, 4.5e-4 right textcolor '#0072b2'
plot file using 1:3 with lines linecolor '#0072b2' title 'amplitude', \
     file using 1:4 axes x1y2 with lines linecolor '#d55e00' dashtype (10, 5) title 'power', \
     marched using 1:3 with points linecolor '#0072b2' pointtype 6 pointsize 1.1 title 'marched (midpoint rule)', \
     marched using 1:4 axes x1y2 with points linecolor '#d55e00' pointtype 4 pointsize 1.1 notitle
