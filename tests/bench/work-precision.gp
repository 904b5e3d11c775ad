# SPDX-License-Identifier: BSD-3-Clause
# Error against run time, a picture a system. From run.sh: results (folder), format.
systems = system("cd '".results."' && ls *.csv | sed 's/.csv//'")

# Coulomb's law itself: this library's methods, solid; others', dashed. Laws with an epsilon: rk4 triangles, others circles.
curves = "'tribo,exact,coulomb' 'tribo,event,coulomb' 'tribo,central/fixed,coulomb' 'tribo,moreau/fixed,coulomb' ".\
         "'sundials,cvode-adams,coulomb' 'sundials,arkode-5,coulomb' 'siconos,moreau-jean,coulomb' 'plain,moreau,coulomb' ".\
         "'plain,rk4,quinn' 'tribo,rk4/fixed,quinn-reversal' 'tribo,rk4/fixed,velocity-limited' ".\
         "'tribo,rkf45,quinn' 'tribo,msbdf,quinn' 'tribo,rkf45,velocity-limited'"
titles = "'exact' 'event' 'central/fixed' 'moreau/fixed' 'CVODE Adams + events' 'ARKODE + events' 'Siconos' 'Moreau, by hand' ".\
         "'rk4, Quinn, by hand' 'rk4/fixed, quinn-reversal' 'rk4/fixed, velocity-limited' ".\
         "'rkf45, Quinn' 'msbdf, Quinn' 'rkf45, velocity-limited'"

do for [s in systems] {
    name = s; wide = 900; high = 500
    load '../../examples/plot/style.gp'
    set style line 1 linecolor '#000000' dashtype 1 pointtype 3 pointsize 2.2 linewidth 2.0
    set style line 2 linecolor '#0072b2' dashtype 1 pointtype 7 pointsize 0.9 linewidth 1.8
    set style line 3 linecolor '#009e73' dashtype 1 pointtype 5 pointsize 0.8 linewidth 1.5
    set style line 4 linecolor '#d55e00' dashtype 1 pointtype 13 pointsize 1.1 linewidth 1.5
    set style line 5 linecolor '#56b4e9' dashtype (6, 3) pointtype 6 pointsize 0.7 linewidth 1.1
    set style line 6 linecolor '#0072b2' dashtype (2, 3) pointtype 6 pointsize 0.7 linewidth 1.1
    set style line 7 linecolor '#d55e00' dashtype (6, 3) pointtype 12 pointsize 1.0 linewidth 1.1
    set style line 8 linecolor '#d55e00' dashtype (2, 3) pointtype 12 pointsize 1.0 linewidth 1.1
    set style line 9 linecolor '#cc79a7' dashtype 1 pointtype 9 pointsize 1.0 linewidth 1.4
    set style line 10 linecolor '#cc79a7' dashtype (6, 3) pointtype 8 pointsize 1.0 linewidth 1.1
    set style line 11 linecolor '#808080' dashtype 1 pointtype 8 pointsize 0.9 linewidth 1.1
    set style line 12 linecolor '#e69f00' dashtype 1 pointtype 6 pointsize 0.8 linewidth 1.2
    set style line 13 linecolor '#e69f00' dashtype (6, 3) pointtype 6 pointsize 0.8 linewidth 1.2
    set style line 14 linecolor '#808080' dashtype (6, 3) pointtype 6 pointsize 0.8 linewidth 1.1
    set logscale xy
    set format '10^{%T}'
    set yrange [1e-15:3]
    set xrange [0.01:300]
    set xlabel 'run time, in units of rk4 with Quinn''s law by hand at dt = '.(s eq 'beam' ? '0.25/ω_{max}' : '0.01')
    set ylabel 'error'
    set title s
    set key outside right center samplen 2 font ',10'
    # only what this system has
    table = results.'/'.s.'.csv'
    has(curve) = int(system("grep -c ',".curve.",' '".table."' || true"))
    points(curve) = "< grep ',".curve.",' '".table."'"
    shown = ''
    do for [i = 1:words(curves)] {
        if (has(word(curves, i))) { shown = shown.' '.i }
    }
    plot for [i in shown] points(word(curves, i + 0)) using 8:($6 > 2e-15 ? $6 : 2e-15) \
        with linespoints linestyle i + 0 title word(titles, i + 0)
    unset output
}
