# Pictures of tribo-damper's tables: gnuplot o'b-plot.gp, in this folder.
set terminal svg size 900,540 dynamic font 'DejaVu Sans,13' linewidth 1.4 noenhanced background 'white'
set datafile separator ','
set encoding utf8
set border linewidth 0.8 linecolor '#404040'
set tics nomirror
set grid linetype 1 linecolor '#e4e4e4' linewidth 0.6
set key noautotitle outside right top Left reverse spacing 1.25 samplen 2.2
set palette defined (0 '#1d4f91', 1 '#0072b2', 2 '#2a9d8f', 3 '#8ab17d', 4 '#d9a528', 5 '#e07a1f', 6 '#c1121f', 7 '#7a0019')
unset colorbox

set output 'o''b-history.svg'
set xlabel 'displacement of the contact'
set ylabel 'friction force'
set key title 'limit 0.01977'
set offsets graph 0.04, graph 0.04, graph 0.08, graph 0.08
plot for [c = 1:3] 'o''b-history.csv' \
     using ($1 >= 2 ? column(12 + c) : 1 / 0):(column(3 * c + 2)) with lines \
     linecolor palette frac (3 > 1 ? (c - 1.0) / 2 : 0) title sprintf('contact %d', c)
set key title ''
unset offsets

set output 'o''b-sticking.svg'
set xlabel 'displacement of the contact'
set ylabel 'friction force'
set key title 'limit 0.05931'
set offsets graph 0.04, graph 0.04, graph 0.08, graph 0.08
plot for [c = 1:3] 'o''b-sticking.csv' \
     using ($1 >= 2 ? column(12 + c) : 1 / 0):(column(3 * c + 2)) with lines \
     linecolor palette frac (3 > 1 ? (c - 1.0) / 2 : 0) title sprintf('contact %d', c)
set key title ''
unset offsets

set output 'o''b-curve.svg'
set xlabel 'limit'
set ylabel 'amplitude where the load acts'
set logscale xy
set y2label 'mean power that friction takes'
set y2tics
set key bottom
plot 'o''b-curve.csv' using 1:3 with lines linecolor '#0072b2' title 'amplitude', \
     'o''b-curve.csv' using 1:4 axes x1y2 with lines linecolor '#d55e00' dashtype (10, 5) title 'power'
unset logscale
unset y2label
unset y2tics
set key top
