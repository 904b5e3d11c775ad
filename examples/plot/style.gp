# SPDX-License-Identifier: BSD-3-Clause
# Common style. Before loading it a script sets name (of the picture), wide, high (pixels); run.sh has set results (a folder)
# and format.
if (format eq 'png') {
    set terminal pngcairo size wide, high font 'DejaVu Sans,11' linewidth 1.4 enhanced
} else {
    set terminal svg size wide, high dynamic font 'DejaVu Sans,13' linewidth 1.4 enhanced background 'white'
}
set output results.'/'.name.'.'.format
set datafile separator ','
set encoding utf8
set border linewidth 0.8 linecolor '#404040'
set tics nomirror
set grid linetype 1 linecolor '#e4e4e4' linewidth 0.6
set key noautotitle samplen 3 spacing 1.1

# One colour a law in all pictures (Okabe and Ito's, safe for colour-blind readers); points and dashes of the paper's three laws
# are those of the paper: proposed law triangles and solid, classical one squares and long dashes, velocity-limited one
# pentagons and short dashes.
set style line 1 linecolor '#d55e00' dashtype (14, 6) linewidth 1.4 pointtype 5 pointsize 0.9   # coulomb
set style line 2 linecolor '#009e73' dashtype (4, 4) linewidth 1.4 pointtype 15 pointsize 1.1   # velocity-limited
set style line 3 linecolor '#cc79a7' dashtype (8, 3, 2, 3) linewidth 1.1 pointtype 6 pointsize 0.9   # smooth
set style line 4 linecolor '#e69f00' dashtype (2, 3) linewidth 1.4 pointtype 4 pointsize 0.9   # karnopp
set style line 5 linecolor '#0072b2' dashtype 1 linewidth 1.6 pointtype 9 pointsize 1.2   # quinn
set style line 6 linecolor '#000000' dashtype (6, 3) linewidth 0.9 pointtype 12 pointsize 2.1   # quinn-reversal
# Blocks and contacts, where the law is the same.
set style line 11 linecolor '#0072b2' dashtype 1 linewidth 1.5
set style line 12 linecolor '#d55e00' dashtype (10, 5) linewidth 1.5
set style line 13 linecolor '#009e73' dashtype (4, 3) linewidth 1.5

laws = 'coulomb velocity-limited smooth karnopp quinn quinn-reversal'
# Quinn's law is drawn last, on top of the reversal law, which is often the same.
order = '1 2 3 4 6 5'
law(i) = word(laws, int(word(order, i)))
style(i) = int(word(order, i))

# A value that one of the programs left.
number(key) = real(system("cat '".results."'/values-*.txt | awk '$1 == \"".key."\" {print $2}'"))
