# SPDX-License-Identifier: BSD-3-Clause
# The beam: three periods of the steady motion at the optimum and above it, with stick and slip of each contact.
name = 'damper-motion'; wide = 1100; high = 720
load 'style.gp'
colour(c) = word('#0072b2 #d55e00 #009e73', c)
where(c) = word('200 300 400', c)
file(k) = results.'/damper-'.word('history sticking', k).'.csv'
heading(k) = k == 1 ? sprintf('at the optimum, limit %.4f N', number('damper.best.limit')) \
                    : sprintf('three times the optimum, limit %.4f N', 3 * number('damper.best.limit'))
sticks(k) = int(system("awk -F, 'NR > 1 && ($6 == 0 || $9 == 0 || $12 == 0) {n++} END {print n + 0}' '".file(k)."'"))
set multiplot
set xrange [0:3]
do for [k = 1:2] {
    left = k == 1 ? 0.085 : 0.58
    unset label
    set lmargin at screen left
    set rmargin at screen left + 0.41
    set title heading(k) offset 0, -0.5
    set tmargin at screen 0.94
    set bmargin at screen 0.68
    set autoscale y
    set offsets graph 0, graph 0, graph 0.08, graph 0.08
    set ytics autofreq
    if (k == 2) { set ytics 0.001 }
    set format x ''
    unset xlabel
    unset key
    side(text) = sprintf("set label 2 '%s' at graph -0.175, graph 0.5 center rotate", text)
    eval side('tip displacement, mm')
    plot file(k) using 1:3 every 2 with lines linecolor '#000000'
    unset title
    set tmargin at screen 0.65
    set bmargin at screen 0.30
    set ytics autofreq
    eval side('contact velocity, mm/s')
    plot for [c = 1:3] file(k) using 1:(column(3 * c + 1)) every 2 with lines linestyle 10 + c
    set tmargin at screen 0.27
    set bmargin at screen 0.12
    set format x '%g'
    set xlabel 'periods of the load'
    set offsets
    set yrange [0.4:3.6]
    if (sticks(k) == 0) { set label 1 'all slip all the time' at 1.5, 2.5 center }
    eval side('contact at x =')
    set ytics ('' 1, '' 2, '' 3)
    do for [c = 1:3] { set label 2 + c where(c) at graph -0.02, first c right textcolor rgb colour(c) }
    if (k == 1) { set key at screen 0.5, 0.015 center bottom horizontal } else { unset key }
    plot for [c = 1:3] file(k) using 1:(column(3 * c + 3) == 0 ? 1 / 0 : c) \
             with lines linecolor '#c8c8c8' linewidth 3 title (c == 1 ? 'slips' : ''), \
         for [c = 1:3] file(k) using 1:(column(3 * c + 3) == 0 ? c : 1 / 0) \
             with lines linecolor rgb colour(c) linewidth 9, \
         1 / 0 with lines linecolor '#404040' linewidth 9 title 'sticks'
}
unset multiplot
