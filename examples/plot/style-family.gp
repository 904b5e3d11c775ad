# SPDX-License-Identifier: BSD-3-Clause
# A family of curves of tribo-damper: amplitude over frequency for several limits. Before loading it a script sets family (the
# tool's --name), wide, high, and the ranges; name of the picture.
load 'style.gp'
file = results.'/'.family.'-family.csv'
linear = results.'/'.family.'-linear.csv'
best = results.'/'.family.'-best.csv'
limits = system("awk -F, 'NR > 1 && NF && $1 != last {print $1; last = $1}' '".file."'")
count = words(limits)
# blue to red, as dark as lines on white must be
set palette defined (0 '#1d4f91', 1 '#0072b2', 2 '#2a9d8f', 3 '#8ab17d', 4 '#d9a528', 5 '#e07a1f', 6 '#c1121f', 7 '#7a0019')
unset colorbox
set logscale y
set format y '10^{%T}'
set xlabel 'frequency of the load, Hz'
set ylabel 'amplitude where the load acts, mm'
set key at graph 1.02, 1 left top Left reverse width -2 spacing 1.25 samplen 2.2 \
    title 'friction limit'."\n".'of each contact' left
set rmargin at screen 0.795
legend(x) = sprintf(x < 0.1 ? '%.3f N' : x < 1 ? '%.2f N' : '%.3g N', x)
plot linear using 1:2 with lines linecolor '#9a9a9a' dashtype (2, 3) linewidth 1.6 title 'none', \
     for [k = 1:count] file skip 1 every :::(k - 1)::(k - 1) using 2:3 with lines linewidth 1.7 \
         linecolor palette frac (count > 1 ? (k - 1.0) / (count - 1) : 0) title legend(real(word(limits, k))), \
     linear using 1:3 with lines linecolor '#404040' dashtype (2, 3) linewidth 1.6 title 'all stuck', \
     best using 2:3 with lines linecolor '#000000' linewidth 3.2 \
         title sprintf('best: %.3g N', number(family.'.band.limit'))
